//! Settings of a run: from the project file `apt-lsp.toml`, the editor or the command line.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{diagnostic::Severity, format::FormatSettings};

/// What a user can set. Every field has a default, unknown fields are errors.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Settings {
    /// Dialect name; `None` detects it.
    pub dialect: Option<String>,
    /// Unit of the program: scales the inch constants of the language (default cutter height, MAXDP).
    pub units: Units,
    /// Machine used for the tape when a command does not say which.
    pub machine: Option<String>,
    /// Folders where INCLUD and LIBRY look for files.
    pub include: Vec<String>,
    /// Severity per diagnostic code, or `off`.
    pub severity: BTreeMap<String, SeveritySetting>,
    /// The style of the formatter.
    pub format: FormatSettings,
    /// Limits on work.
    pub budget: Budget,
}

/// Unit of length of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Units {
    #[default]
    Inch,
    Mm,
}

impl Units {
    /// How many of this unit make an inch.
    pub fn per_inch(self) -> f64 {
        match self {
            Units::Inch => 1.0,
            Units::Mm => 25.4,
        }
    }
}

/// A severity, or `off`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum SeveritySetting {
    Off,
    Hint,
    Information,
    Warning,
    Error,
}

impl SeveritySetting {
    /// The severity; `None` for off.
    pub fn severity(self) -> Option<Severity> {
        match self {
            SeveritySetting::Off => None,
            SeveritySetting::Hint => Some(Severity::Hint),
            SeveritySetting::Information => Some(Severity::Information),
            SeveritySetting::Warning => Some(Severity::Warning),
            SeveritySetting::Error => Some(Severity::Error),
        }
    }
}

/// Limits on work; reaching one is a diagnostic that names the setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Budget {
    /// Statements that one loop, macro call or included file of the program executes, with all that it calls, and those
    /// that jumps outside of loops execute again. Statements that are executed once are not counted.
    pub statements: u64,
    /// Depth of macro calls.
    pub macro_depth: u32,
    /// CL points of one run, COPY included.
    pub points: u64,
}

impl Default for Budget {
    fn default() -> Self {
        Self { statements: 2_000_000, macro_depth: 50, points: 20_000_000 }
    }
}

/// Why a project file cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct SettingsError {
    /// What the TOML reader says, with line and column.
    pub message: String,
}

/// Reads a project file.
pub fn parse_project_file(text: &str) -> Result<Settings, SettingsError> {
    toml::from_str(text).map_err(|error| SettingsError { message: error.to_string() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_project_file_sets_what_it_names_and_refuses_what_it_does_not_know() {
        let settings = parse_project_file(
            "dialect = \"apt4\"\nunits = \"mm\"\n[severity]\nAPT0801 = \"off\"\n[budget]\nmacro-depth = 5\n",
        )
        .unwrap();
        assert_eq!(settings.dialect.as_deref(), Some("apt4"));
        assert_eq!(settings.units.per_inch(), 25.4);
        assert_eq!(settings.severity["APT0801"].severity(), None);
        assert_eq!(settings.budget, Budget { macro_depth: 5, ..Budget::default() });
        assert_eq!(settings.format, FormatSettings::default());
        let error = parse_project_file("dialekt = 1\n").unwrap_err();
        assert!(error.message.contains("dialekt") && error.message.contains("line 1"), "{error}");
    }

    #[test]
    fn a_project_file_sets_the_style_within_reason() {
        use apt_syntax::{Dialect, DialectName};

        use crate::format::{FormatOptions, LetterCase};
        let settings = parse_project_file(
            "[format]\nletter-case = \"words\"\nindent = 2\ncontinuation-indent = 4\nwrap = 72\nalign-comments = false\n",
        )
        .unwrap();
        let free = Dialect::named(DialectName::Free);
        let style = FormatOptions::with(&free, &settings.format);
        let expected = FormatOptions {
            letter_case: LetterCase::Words,
            indent: 2,
            continuation_indent: 4,
            wrap: Some(72),
            align_comments: false,
        };
        assert_eq!(style, expected);
        assert_eq!(FormatOptions::with(&free, &FormatSettings::default()), FormatOptions::of(&free));
        for wrong in
            ["wrap = 3", "indent = 1000", "continuation-indent = -1", "letter-case = \"LOUD\"", "tabs = 1"]
        {
            assert!(parse_project_file(&format!("[format]\n{wrong}\n")).is_err(), "{wrong}");
        }
    }
}

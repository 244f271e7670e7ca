//! Settings: of the editor (`apt.`), of the project (`apt-lsp.toml`), of the command line.
//!
//! The project wins over the editor, so that the editor and the check in CI find the same; the
//! command line wins over both, since somebody just typed it. What the settings of a program mean is
//! the language's business; here they are only found and laid over each other.

use std::path::{Path, PathBuf};

use serde_json::Value;
use thiserror::Error;

use crate::analysis::Language;

/// Settings as they were written, with keys in kebab case.
pub(crate) type Values = serde_json::Map<String, Value>;

/// The project file's name.
pub(crate) const PROJECT_FILE: &str = "apt-lsp.toml";

/// A project file larger than this is no project file (bytes).
const PROJECT_FILE_LIMIT: u64 = 1 << 20;

/// Keys of the editor's section that concern programs. The rest of the section (path of the server,
/// trace …) is the editor's own.
const PROGRAM_KEYS: [&str; 7] = ["dialect", "units", "machine", "include", "severity", "format", "budget"];

/// The key of [`Settings::motion`].
const MOTION_KEY: &str = "motion";

/// What is in force for one program.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Settings {
    /// What the language is told.
    pub program: Values,
    /// Findings of motion are shown while typing; true if nobody says otherwise.
    pub motion: Option<bool>,
    /// The project file, if there is one.
    pub project_file: Option<PathBuf>,
}

/// Why settings cannot be used.
#[derive(Debug, Error)]
pub(crate) enum SettingsError {
    /// The project file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The project file is too large to be one.
    #[error("{}: larger than {PROJECT_FILE_LIMIT} bytes", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// The project file is no TOML.
    #[error("{}: {source}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What and where.
        source: Box<toml::de::Error>,
    },
    /// The language does not know what the project file says.
    #[error("{}: {message}", path.display())]
    Unknown {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// The language does not know what the editor says.
    #[error("settings of the editor: {message}")]
    Editor {
        /// What is wrong.
        message: String,
    },
}

impl Settings {
    /// The settings of a program: those of its project over those of the editor, and what was typed
    /// over both. Levels that cannot be used are left out, and named.
    pub(crate) fn resolve(
        language: &dyn Language,
        program: Option<&Path>,
        editor: &Values,
        typed: &Values,
    ) -> (Self, Vec<SettingsError>) {
        let mut problems = Vec::new();
        let mut settings = Self::default();
        match language.check_settings(&program_part(editor)) {
            Ok(()) => settings.lay_over(editor),
            Err(message) => problems.push(SettingsError::Editor { message }),
        }
        if let Some(path) = program.and_then(project_file) {
            match read_project(language, &path) {
                Ok(values) => settings.lay_over(&values),
                Err(problem) => problems.push(problem),
            }
            settings.project_file = Some(path);
        }
        settings.lay_over(typed);
        (settings, problems)
    }

    fn lay_over(&mut self, upper: &Values) {
        if let Some(motion) = upper.get(MOTION_KEY).and_then(Value::as_bool) {
            self.motion = Some(motion);
        }
        lay_over(&mut self.program, program_part(upper));
    }
}

/// The settings of an editor: either the section itself or an object that holds it under `apt`, with
/// keys in camel case or kebab case. Anything that is no object sets nothing.
pub(crate) fn of_editor(value: &Value) -> Values {
    let section = value.get("apt").unwrap_or(value);
    let Some(section) = section.as_object() else { return Values::new() };
    let known = |key: &String| PROGRAM_KEYS.contains(&key.as_str()) || key == MOTION_KEY;
    let set = section.iter().filter(|(key, value)| known(key) && !is_unset(value));
    set.map(|(key, value)| (key.clone(), kebab_case_keys(key, value))).collect()
}

/// Editors fill in defaults where nobody has set anything; these mean that.
fn is_unset(value: &Value) -> bool {
    value.is_null() || matches!(value.as_str(), Some("" | "auto"))
}

/// `macroDepth` becomes `macro-depth`. Codes of diagnostics stay as they are.
fn kebab_case_keys(key: &str, value: &Value) -> Value {
    match value {
        Value::Object(fields) if key != "severity" => {
            let kebab = |key: &String| {
                let mut name = String::new();
                for character in key.chars() {
                    if character.is_ascii_uppercase() {
                        name.push('-');
                    }
                    name.push(character.to_ascii_lowercase());
                }
                name
            };
            fields
                .iter()
                .filter(|(_, value)| !value.is_null())
                .map(|(key, value)| (kebab(key), value.clone()))
                .collect()
        }
        other => other.clone(),
    }
}

fn program_part(values: &Values) -> Values {
    values
        .iter()
        .filter(|(key, _)| *key != MOTION_KEY)
        .map(|(key, value)| (key.clone(), value.clone()))
        .collect()
}

/// Tables are laid over each other key by key, everything else is replaced.
fn lay_over(lower: &mut Values, upper: Values) {
    for (key, value) in upper {
        match (lower.get_mut(&key), value) {
            (Some(Value::Object(below)), Value::Object(above)) => lay_over(below, above),
            (_, value) => {
                lower.insert(key, value);
            }
        }
    }
}

/// The project file in the nearest parent folder of a program.
fn project_file(program: &Path) -> Option<PathBuf> {
    program.ancestors().skip(1).map(|folder| folder.join(PROJECT_FILE)).find(|path| path.is_file())
}

fn read_project(language: &dyn Language, path: &Path) -> Result<Values, SettingsError> {
    let path = path.to_owned();
    let length = match std::fs::metadata(&path) {
        Ok(metadata) => metadata.len(),
        Err(source) => return Err(SettingsError::Unreadable { path, source }),
    };
    if length > PROJECT_FILE_LIMIT {
        return Err(SettingsError::TooLarge { path });
    }
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(source) => return Err(SettingsError::Unreadable { path, source }),
    };
    let mut values = match toml::from_str::<Values>(&text) {
        Ok(values) => values,
        Err(source) => return Err(SettingsError::Malformed { path, source: Box::new(source) }),
    };
    if let Err(message) = language.check_settings(&program_part(&values)) {
        return Err(SettingsError::Unknown { path, message });
    }
    // Include folders of a project file are relative to it.
    if let (Some(Value::Array(folders)), Some(home)) = (values.get_mut("include"), path.parent()) {
        for folder in folders {
            if let Some(relative) = folder.as_str() {
                *folder = Value::String(home.join(relative).to_string_lossy().into_owned());
            }
        }
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::analysis::fake::FakeLanguage;

    #[test]
    fn the_editor_sends_the_section_or_what_holds_it() {
        let section = json!({
            "dialect": "apt3", "units": "auto", "machine": "", "include": null, "server": { "path": "x" },
            "severity": { "APT0001": "off" }, "budget": { "macroDepth": 5 },
        });
        let values = of_editor(&section);
        let expected =
            json!({ "dialect": "apt3", "severity": { "APT0001": "off" }, "budget": { "macro-depth": 5 } });
        assert_eq!(Value::Object(values.clone()), expected);
        assert_eq!(of_editor(&json!({ "apt": section })), values);
        for nothing in [json!(null), json!({ "apt": null }), json!(7), json!([])] {
            assert_eq!(of_editor(&nothing), Values::new());
        }
    }

    #[test]
    fn tables_are_laid_over_each_other_key_by_key() {
        let mut settings = Settings::default();
        settings.lay_over(&of_editor(
            &json!({ "dialect": "free", "machine": "m", "budget": { "a": 1, "b": 2 } }),
        ));
        settings.lay_over(&of_editor(&json!({ "dialect": "apt4", "motion": false, "budget": { "b": 3 } })));
        let expected = json!({ "dialect": "apt4", "machine": "m", "budget": { "a": 1, "b": 3 } });
        assert_eq!((Value::Object(settings.program), settings.motion), (expected, Some(false)));
    }

    #[test]
    fn the_nearest_project_file_counts_and_a_broken_one_is_named() {
        let folder = std::env::temp_dir().join(format!("apt-lsp-settings-{}", std::process::id()));
        let inner = folder.join("parts/inner");
        std::fs::create_dir_all(&inner).unwrap();
        std::fs::write(folder.join(PROJECT_FILE), "dialect = \"apt3\"\n").unwrap();
        let program = inner.join("a.apt");
        let language = FakeLanguage::default();
        let editor = of_editor(&json!({ "dialect": "free" }));
        let resolve = || Settings::resolve(&language, Some(&program), &editor, &Values::new());

        let (settings, problems) = resolve();
        assert_eq!((&settings.program["dialect"], problems.len()), (&json!("apt3"), 0));
        assert_eq!(settings.project_file, Some(folder.join(PROJECT_FILE)));

        std::fs::write(inner.join(PROJECT_FILE), "dialekt = \"apt3\"\n").unwrap();
        let (settings, problems) = resolve();
        assert_eq!(settings.program["dialect"], json!("free"), "a broken file sets nothing");
        assert!(problems[0].to_string().contains("dialekt"), "{problems:?}");

        std::fs::write(inner.join(PROJECT_FILE), "dialect = \n").unwrap();
        assert!(matches!(resolve().1[..], [SettingsError::Malformed { .. }]));
        std::fs::remove_dir_all(folder).unwrap();
    }
}

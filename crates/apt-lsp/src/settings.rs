//! Settings: of the editor (`apt.`), of the project (`apt-lsp.toml`), of the command line.
//!
//! The project wins over the editor, so that the editor and the check in CI find the same; the
//! command line wins over both, since somebody just typed it. What the settings of a program mean is
//! the language's business; here they are only found and laid over each other.

use std::path::{Path, PathBuf};

use serde_json::Value;
use thiserror::Error;

use crate::analysis::{DEFINITION_ENDING, Language};

/// Settings as they were written, with keys in kebab case.
pub(crate) type Values = serde_json::Map<String, Value>;

/// The project file's name.
pub(crate) const PROJECT_FILE: &str = "apt-lsp.toml";

/// A project file larger than this is no project file (bytes).
const PROJECT_FILE_LIMIT: u64 = 1 << 20;

/// The key of [`Settings::motion`].
const MOTION_KEY: &str = "motion";

/// Keys that are settings of the server; all but the last concern programs.
const KEYS: [&str; 8] =
    ["dialect", "units", "machine", "include", "severity", "format", "budget", MOTION_KEY];

/// Keys of the editor's section that are the editor's own: the path of the server, the trace of what is said.
const KEYS_OF_THE_EDITOR: [&str; 2] = ["server", "trace"];

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
    /// Keys in the section of the editor that are no settings; the others count.
    #[error("settings of the editor: nothing known by {}; known are {}", quoted(keys), KEYS.join(", "))]
    UnknownKeys {
        /// The keys.
        keys: Vec<String>,
    },
}

fn quoted(keys: &[String]) -> String {
    keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ")
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
        let (known, unknown): (Values, Values) =
            editor.clone().into_iter().partition(|(key, _)| is_known(key));
        if !unknown.is_empty() {
            problems
                .push(SettingsError::UnknownKeys { keys: unknown.into_iter().map(|(key, _)| key).collect() });
        }
        match check(language, &known) {
            Ok(()) => settings.lay_over(&known),
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
    let own = |key: &String| KEYS_OF_THE_EDITOR.contains(&key.as_str());
    let set = section.iter().filter(|(key, value)| !own(key) && !is_unset(value));
    set.map(|(key, value)| (key.clone(), kebab_case_keys(key, value))).collect()
}

/// The settings that an editor tells when they have changed: it may tell those of all its servers. Without `apt` among them
/// tables that are not known are sections of others.
pub(crate) fn of_changed_editor(value: &Value) -> Values {
    let mut values = of_editor(value);
    if value.get("apt").is_none() {
        values.retain(|key, value| is_known(key) || !value.is_object());
    }
    values
}

fn is_known(key: &str) -> bool {
    KEYS.contains(&key)
}

/// Says what is wrong with settings, if something is.
fn check(language: &dyn Language, values: &Values) -> Result<(), String> {
    if values.get(MOTION_KEY).is_some_and(|motion| !motion.is_boolean()) {
        return Err(format!("{MOTION_KEY}: true or false is expected"));
    }
    language.check_settings(&program_part(values))
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
    if let Err(message) = check(language, &values) {
        return Err(SettingsError::Unknown { path, message });
    }
    // The definition of a machine and the include folders of a project file are relative to it.
    if let (Some(Value::String(machine)), Some(home)) = (values.get_mut("machine"), path.parent())
        && machine.ends_with(DEFINITION_ENDING)
    {
        *machine = home.join(&*machine).to_string_lossy().into_owned();
    }
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
    fn what_the_editor_sets_and_nobody_knows_is_named_and_the_rest_counts() {
        let told = |value: Value| {
            let editor = of_editor(&value);
            let (settings, problems) =
                Settings::resolve(&FakeLanguage::default(), None, &editor, &Values::new());
            let problems: Vec<String> = problems.iter().map(ToString::to_string).collect();
            (Value::Object(settings.program), problems.join("; "))
        };
        let known = "known are dialect, units, machine, include, severity, format, budget, motion";
        let (program, problems) = told(json!({ "dialect": "apt3", "dialekt": "apt4", "budgets": {} }));
        assert_eq!(program, json!({ "dialect": "apt3" }));
        assert_eq!(
            problems,
            format!("settings of the editor: nothing known by `dialekt`, `budgets`; {known}")
        );
        // What the editor has for itself, and what it has for other servers, is none of this one's business.
        let section = json!({ "dialect": "apt3", "server": { "path": "x" }, "trace": { "server": "off" } });
        let own = (json!({ "dialect": "apt3" }), String::new());
        assert_eq!(told(section.clone()), own);
        assert_eq!(told(json!({ "apt": section, "lua": { "x": 1 }, "http": 3 })), own);
        assert_eq!(told(json!({ "dialekt": null, "x": "" })).1, "");
        let all = |value: Value| Value::Object(of_changed_editor(&value));
        assert_eq!(
            all(json!({ "lua": {}, "dialect": "apt3", "x": 1 })),
            json!({ "dialect": "apt3", "x": 1 })
        );
        assert_eq!(all(json!({ "lua": {}, "apt": { "x": {} } })), json!({ "x": {} }));
        // The switch of motion is on or off, in a project file as well.
        let wrong = "settings of the editor: motion: true or false is expected";
        assert_eq!(told(json!({ "dialect": "apt3", "motion": "no" })), (json!({}), wrong.to_owned()));
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

        std::fs::write(inner.join(PROJECT_FILE), "motion = \"no\"\n").unwrap();
        assert!(resolve().1[0].to_string().ends_with("motion: true or false is expected"));

        std::fs::write(inner.join(PROJECT_FILE), "dialect = \n").unwrap();
        assert!(matches!(resolve().1[..], [SettingsError::Malformed { .. }]));
        std::fs::remove_dir_all(folder).unwrap();
    }
}

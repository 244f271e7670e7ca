//! Programs named on the command line: files, folders, standard input.

use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ropey::Rope;
use serde_json::Value;

use super::arguments::{ProgramArgument, ReadingOptions, SeverityOption};
use super::console::Console;
use crate::analysis::{Document, Language, Surroundings};
use crate::convert::{Encoding, TextIndex};
use crate::settings::{Settings, Values};
use crate::source::{self, DIALECT_KEY, ENDINGS, ProgramFile, TextForm, is_program};

/// The name that means standard input.
pub(super) const STANDARD_INPUT: &str = "-";

/// A program that has been read.
pub(super) struct Program {
    /// Its name in messages.
    pub name: String,
    /// Positions in its text, as JSON and SARIF tell them (UTF-16).
    pub index: TextIndex,
    /// Its analysis.
    pub document: Arc<dyn Document>,
    /// The settings in force.
    pub settings: Settings,
    /// The form of its bytes; none for a binary file.
    pub form: Option<TextForm>,
    /// The bytes of a binary file.
    pub tape: Option<Vec<u8>>,
}

impl Program {
    /// Reads a program and says on standard error which dialect is in force.
    pub(super) fn read(
        argument: &ProgramArgument,
        console: &Console,
        language: &dyn Language,
    ) -> Option<Self> {
        let program = Self::load(&argument.file, &argument.reading, console, language)?;
        console.note(&format!("{}: dialect {}", program.name, program.document.dialect()));
        Some(program)
    }

    /// Reads a program. What is wrong is said on standard error.
    pub(super) fn load(
        path: &Path,
        reading: &ReadingOptions,
        console: &Console,
        language: &dyn Language,
    ) -> Option<Self> {
        let from_standard_input = path.as_os_str() == STANDARD_INPUT;
        let name = if from_standard_input { "<stdin>".to_owned() } else { path.display().to_string() };
        let read = if from_standard_input { source::read_standard_input() } else { std::fs::read(path) };
        let understood =
            read.map_err(|error| error.to_string()).and_then(|bytes| ProgramFile::of_bytes(bytes, language));
        let ProgramFile { source, binary } = match understood {
            Ok(file) => file,
            Err(error) => {
                console.error(&format!("{name}: {error}"));
                return None;
            }
        };
        let (tape, binary) = binary.unzip();
        if tape.is_some() {
            console.note(&format!("{name}: a binary CL file; places are those of its text form"));
        }
        if source.form == TextForm::Latin1 {
            console.note(&format!("{name}: not UTF-8; read as Latin-1"));
        }
        let mut typed = Values::new();
        if let Some(dialect) = &reading.dialect {
            typed.insert(DIALECT_KEY.to_owned(), Value::String(dialect.clone()));
        }
        if !reading.severities.is_empty() {
            let one = |one: &SeverityOption| (one.code.clone(), Value::String(one.severity.clone()));
            let severities = reading.severities.iter().map(one).collect();
            typed.insert("severity".to_owned(), Value::Object(severities));
        }
        let unknown = reading.severities.iter().find(|one| language.title(&one.code).is_none());
        let unknown = unknown.map(|one| format!("there is no diagnostic {}", one.code));
        if let Some(message) = unknown.or_else(|| language.check_settings(&typed).err()) {
            console.error(&message);
            return None;
        }
        // Relative paths have parents too, once they are made whole.
        let whole = std::path::absolute(path).ok().filter(|_| !from_standard_input);
        let beside = whole.clone();
        let home = whole.or_else(|| Some(std::env::current_dir().ok()?.join(&name)));
        let (mut settings, problems) = Settings::resolve(language, home.as_deref(), &Values::new(), &typed);
        for problem in &problems {
            console.error(&problem.to_string());
        }
        if !problems.is_empty() {
            return None;
        }
        if binary.is_some() && reading.dialect.is_none() {
            settings.program.remove(DIALECT_KEY);
        }
        let surroundings = Surroundings { path: beside, binary, ..Surroundings::default() };
        let document = language.open(&source.text, Some(&name), &settings.program, surroundings);
        let index = TextIndex { rope: Rope::from_str(&source.text), encoding: Encoding::Utf16 };
        let form = tape.is_none().then_some(source.form);
        Some(Self { name, index, document, settings, form, tape })
    }
}

/// The dialects in force in many programs, with the names of those.
#[derive(Default)]
pub(super) struct Dialects(BTreeMap<String, Vec<String>>);

impl Dialects {
    /// Adds a program.
    pub(super) fn add(&mut self, program: &Program) {
        self.0.entry(program.document.dialect()).or_default().push(program.name.clone());
    }
}

/// Says which dialects are in force in many programs.
pub(super) fn note_dialects(dialects: &Dialects, console: &Console) {
    for (dialect, names) in &dialects.0 {
        match &names[..] {
            [name] => console.note(&format!("{name}: dialect {dialect}")),
            _ => console.note(&format!("{} programs: dialect {dialect}", names.len())),
        }
    }
}

/// The programs that paths name: files as they are, folders with everything that looks like a program,
/// in order of their names; none of them twice. The number tells how many paths could not be read.
pub(super) fn find(paths: &[PathBuf], console: &Console) -> (Vec<PathBuf>, usize) {
    let mut found = Vec::new();
    let mut unreadable = 0;
    for path in paths {
        if !path.is_dir() {
            found.push(path.clone());
            continue;
        }
        let before = found.len();
        let mut walk = ignore::WalkBuilder::new(path);
        walk.require_git(false).sort_by_file_path(Path::cmp);
        for entry in walk.build() {
            match entry {
                // A link to a file is a file of the folder; links to folders may lead in circles.
                Ok(entry) if is_program(entry.path()) && entry.path().is_file() => {
                    found.push(entry.into_path());
                }
                Ok(_) => {}
                Err(error) => {
                    console.error(&error.to_string());
                    unreadable += 1;
                }
            }
        }
        if found.len() == before {
            console.note(&format!("{}: no programs (.{})", path.display(), ENDINGS.join(", .")));
        }
    }
    let mut known = HashSet::new();
    found.retain(|path| known.insert(path.clone()));
    (found, unreadable)
}

//! Programs from files and standard input.

use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

use crate::analysis::{ClDialect, Document, Files, Language, Surroundings, TextOfBinary};
use crate::settings::Settings;

/// The text of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Source {
    /// The text, without a byte-order mark.
    pub text: String,
    /// The form of its bytes.
    pub form: TextForm,
}

/// The setting that a binary file does not heed: it says what it is, whatever the programs beside it are written in.
pub(crate) const DIALECT_KEY: &str = "dialect";

/// How a text stands in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextForm {
    /// UTF-8.
    Utf8,
    /// UTF-8 after a byte-order mark.
    MarkedUtf8,
    /// Each byte is a character.
    Latin1,
}

const BYTE_ORDER_MARK: char = '\u{feff}';

/// Endings of files that are programs when a folder is walked.
pub(crate) const ENDINGS: [&str; 11] =
    ["apt", "aptsource", "ncl", "cl", "cla", "cldata", "clf", "cls", "clsf", "cltap", "cltape"];

/// The ending behind which Creo counts the versions of a file: `op010.ncl.1`, `op010.ncl.2` …
const VERSIONED_ENDING: &str = "ncl";

impl TextForm {
    /// The bytes of a text; none if it has characters that the form cannot hold.
    pub(crate) fn encode(self, text: &str) -> Option<Vec<u8>> {
        match self {
            Self::MarkedUtf8 => Some(format!("{BYTE_ORDER_MARK}{text}").into_bytes()),
            Self::Utf8 => Some(text.as_bytes().to_vec()),
            Self::Latin1 => text.chars().map(|character| u8::try_from(character).ok()).collect(),
        }
    }
}

/// A program as it stands in a file: a text, or a binary file with the text that says the same.
pub(crate) struct ProgramFile {
    /// The text.
    pub source: Source,
    /// The bytes of a binary file, and whose it is.
    pub binary: Option<(Vec<u8>, ClDialect)>,
}

impl ProgramFile {
    /// The program that bytes are, or why a binary file cannot be read.
    pub(crate) fn of_bytes(bytes: Vec<u8>, language: &dyn Language) -> Result<Self, String> {
        Ok(match language.text_of_binary(&bytes).transpose()? {
            Some(TextOfBinary { text, system }) => {
                Self { source: Source { text, form: TextForm::Utf8 }, binary: Some((bytes, system)) }
            }
            None => Self { source: decode(bytes), binary: None },
        })
    }

    /// Reads a file.
    pub(crate) fn read(path: &Path, language: &dyn Language) -> Result<Self, String> {
        let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
        Self::of_bytes(bytes, language)
    }

    /// The analysis of a file that was read, with the settings and the open files that count for it.
    pub(crate) fn open(
        &self,
        path: &Path,
        language: &dyn Language,
        settings: &Settings,
        files: Files,
    ) -> Arc<dyn Document> {
        let mut values = settings.program.clone();
        if self.binary.is_some() {
            values.remove(DIALECT_KEY);
        }
        let binary = self.binary.as_ref().map(|(_, system)| *system);
        let surroundings = Surroundings { path: Some(path.to_owned()), files, binary };
        let name = path.file_name().and_then(|name| name.to_str());
        language.open(&self.source.text, name, &values, surroundings)
    }
}

/// The bytes of standard input, to its end.
pub(crate) fn read_standard_input() -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Any bytes are a program: what is no UTF-8 comes from the time before it.
pub(crate) fn decode(bytes: Vec<u8>) -> Source {
    match String::from_utf8(bytes) {
        Ok(text) => match text.strip_prefix(BYTE_ORDER_MARK) {
            Some(rest) => Source { text: rest.to_owned(), form: TextForm::MarkedUtf8 },
            None => Source { text, form: TextForm::Utf8 },
        },
        Err(error) => {
            let text = error.into_bytes().into_iter().map(char::from).collect();
            Source { text, form: TextForm::Latin1 }
        }
    }
}

/// Whether the name of a file looks like that of a program.
pub(crate) fn is_program(path: &Path) -> bool {
    let ending_of =
        |path: &Path| path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    let Some(ending) = ending_of(path) else { return false };
    if !ending.is_empty() && ending.bytes().all(|byte| byte.is_ascii_digit()) {
        let before = path.file_stem().map(Path::new).and_then(ending_of);
        return before.is_some_and(|before| before == VERSIONED_ENDING);
    }
    ENDINGS.contains(&ending.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_goes_back_in_the_form_in_which_it_came() {
        for bytes in [&b"PARTNO"[..], "é".as_bytes(), b"\xef\xbb\xbfP", b"\xe9\0", b""] {
            let source = decode(bytes.to_vec());
            assert_eq!(source.form.encode(&source.text).as_deref(), Some(bytes));
        }
        assert_eq!(TextForm::Latin1.encode("😀"), None);
    }

    #[test]
    fn programs_are_known_by_their_names() {
        for name in ["a.apt", "A.APT", "dir/b.cls", "x.ncl", "op010.ncl.1", "OP.NCL.12", "t.cltape"] {
            assert!(is_program(Path::new(name)), "{name}");
        }
        for name in ["apt", "a.txt", "a.1", "ncl.1", "a.apt.1", "a.ncl.1a", "a.ncl.", ".apt", ""] {
            assert!(!is_program(Path::new(name)), "{name}");
        }
    }

    #[test]
    fn any_bytes_are_a_program() {
        let text = |bytes: &[u8]| decode(bytes.to_vec());
        let source = |text: &str, form| Source { text: text.into(), form };
        assert_eq!(text("é".as_bytes()), source("é", TextForm::Utf8));
        assert_eq!(text(b"\xef\xbb\xbfPARTNO"), source("PARTNO", TextForm::MarkedUtf8));
        assert_eq!(text(b"\xe9\0"), source("é\0", TextForm::Latin1));
    }
}

//! From `vocabulary.toml` to the Rust table.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;

use super::{WordClass, WordStatus};
use crate::dialect::DialectName;

/// What is wrong with the data file.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// It is not the TOML that is expected.
    #[error("{0}")]
    Toml(#[from] toml::de::Error),
    /// A spelling occurs twice.
    #[error("the word {0} occurs twice")]
    Twice(String),
    /// A spelling is not in upper case.
    #[error("the word {0} is not in upper case")]
    Case(String),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    word: Vec<Entry>,
}

/// One word of the data file; the fields are those of [`super::Word`].
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the fields are those of Word")]
pub struct Entry {
    pub spelling: String,
    pub class: WordClass,
    pub status: WordStatus,
    pub code: Option<u16>,
    pub record: Option<(u16, u16)>,
    #[serde(default)]
    pub forms: Vec<String>,
    #[serde(default)]
    pub used_in: Vec<String>,
    /// Empty for all dialects.
    #[serde(default)]
    pub dialects: Vec<DialectName>,
    /// Dialects in which the word is no reserved one.
    #[serde(default)]
    pub soft_in: Vec<DialectName>,
    pub help: String,
}

/// The words of the data file, sorted by spelling.
///
/// # Errors
/// The text is no valid data file.
pub fn entries(toml: &str) -> Result<Vec<Entry>, GenerateError> {
    let file: File = toml::from_str(toml)?;
    let mut words = BTreeMap::new();
    for entry in file.word {
        if entry.spelling.bytes().any(|byte| byte.is_ascii_lowercase()) {
            return Err(GenerateError::Case(entry.spelling));
        }
        if let Some(double) = words.insert(entry.spelling.clone(), entry) {
            return Err(GenerateError::Twice(double.spelling));
        }
    }
    Ok(words.into_values().collect())
}

/// The source of the table of words, sorted by spelling.
///
/// # Errors
/// The text is no valid data file.
pub fn generate_rust(toml: &str) -> Result<String, GenerateError> {
    let words = entries(toml)?;
    let mut out = String::from(
        "// Made from vocabulary.toml by `cargo xtask codegen`; do not edit.\n\nuse super::{Word, WordClass, WordStatus};\nuse crate::dialect::DialectName;\n\n",
    );
    out.push_str("/// All words, sorted by spelling.\npub(super) const WORDS: &[Word] = &[\n");
    for entry in &words {
        write_entry(&mut out, entry);
    }
    out.push_str("];\n");
    Ok(out)
}

fn write_entry(out: &mut String, entry: &Entry) {
    let dialects = if entry.dialects.is_empty() { DialectName::ALL.to_vec() } else { entry.dialects.clone() };
    let names =
        |names: &[DialectName]| names.iter().map(|name| format!("DialectName::{name:?}")).collect::<Vec<_>>();
    let (dialects, soft_in) = (names(&dialects), names(&entry.soft_in));
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "    Word {{ spelling: {:?}, class: WordClass::{:?}, status: WordStatus::{:?}, code: {:?}, record: {:?}, forms: &{:?}, used_in: &{:?}, dialects: &[{}], soft_in: &[{}], help: {:?} }},",
        entry.spelling,
        entry.class,
        entry.status,
        entry.code,
        entry.record,
        entry.forms,
        entry.used_in,
        dialects.join(", "),
        soft_in.join(", "),
        entry.help,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_of_the_data_file_are_told() {
        let twice = "[[word]]\nspelling='A'\nclass='minor'\nstatus='parsed'\nhelp='x'\n[[word]]\nspelling='A'\nclass='minor'\nstatus='parsed'\nhelp='y'\n";
        assert!(matches!(generate_rust(twice), Err(GenerateError::Twice(word)) if word == "A"));
        let case = "[[word]]\nspelling='a'\nclass='minor'\nstatus='parsed'\nhelp='x'\n";
        assert!(matches!(generate_rust(case), Err(GenerateError::Case(_))));
        assert!(matches!(generate_rust("[[word]]\nspelling='A'\n"), Err(GenerateError::Toml(_))));
    }
}

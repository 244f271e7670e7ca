//! Integer codes of the words that stand on binary CL records.
//!
//! The vocabulary itself belongs to the syntax crate; whoever ties the two together fills this table from it.

use std::collections::BTreeMap;

use smol_str::SmolStr;

/// Words and their codes, both ways, separately for major words (class 2000 subclasses) and minor words.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CodeTable {
    major_codes: BTreeMap<SmolStr, u16>,
    major_words: BTreeMap<u16, SmolStr>,
    minor_codes: BTreeMap<SmolStr, u16>,
    minor_words: BTreeMap<u16, SmolStr>,
}

impl CodeTable {
    /// An empty table.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a major word. Of two words with one code the first is the one that readers get.
    pub fn major(&mut self, word: &str, code: u16) -> &mut Self {
        self.major_codes.entry(word.into()).or_insert(code);
        self.major_words.entry(code).or_insert_with(|| word.into());
        self
    }

    /// Adds a minor word. Of two words with one code the first is the one that readers get.
    pub fn minor(&mut self, word: &str, code: u16) -> &mut Self {
        self.minor_codes.entry(word.into()).or_insert(code);
        self.minor_words.entry(code).or_insert_with(|| word.into());
        self
    }

    /// Adds the words and codes of another table that this one has not.
    pub fn fill_up(&mut self, other: &Self) -> &mut Self {
        for (word, code) in &other.major_codes {
            self.major_codes.entry(word.clone()).or_insert(*code);
        }
        for (code, word) in &other.major_words {
            self.major_words.entry(*code).or_insert_with(|| word.clone());
        }
        for (word, code) in &other.minor_codes {
            self.minor_codes.entry(word.clone()).or_insert(*code);
        }
        for (code, word) in &other.minor_words {
            self.minor_words.entry(*code).or_insert_with(|| word.clone());
        }
        self
    }

    /// Subclass of a major word.
    pub fn major_code(&self, word: &str) -> Option<u16> {
        self.major_codes.get(word).copied()
    }

    /// Major word of a subclass.
    pub fn major_word(&self, code: u16) -> Option<&SmolStr> {
        self.major_words.get(&code)
    }

    /// Code of a minor word.
    pub fn minor_code(&self, word: &str) -> Option<u16> {
        self.minor_codes.get(word).copied()
    }

    /// Minor word of a code.
    pub fn minor_word(&self, code: u16) -> Option<&SmolStr> {
        self.minor_words.get(&code)
    }
}

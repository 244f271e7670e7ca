//! The vocabulary: one data file, `vocabulary.toml`, holds class, code, forms and help of every word.
//!
//! `cargo xtask codegen` turns it into the table of the module `generated`, so that a start of the program costs
//! next to nothing; a test keeps the two equal.

pub mod generate;
#[rustfmt::skip]
mod generated;

use std::sync::LazyLock;

use rustc_hash::FxHashMap;

use crate::dialect::DialectName;

/// The most characters of a spelling.
pub const LONGEST_SPELLING: usize = 16;

/// One word of the vocabulary.
#[derive(Debug, Clone, PartialEq)]
pub struct Word {
    /// The spelling, upper case.
    pub spelling: &'static str,
    /// What kind of word it is.
    pub class: WordClass,
    /// What this program does with it.
    pub status: WordStatus,
    /// The integer code: of minor words the code on CL records, of post-processor words the subclass, of types the
    /// surface number, of functions their number.
    pub code: Option<u16>,
    /// Class and subclass of the record that the statement leaves between the sections or on the CL file (language
    /// reference 3.2).
    pub record: Option<(u16, u16)>,
    /// The forms of the statement or definition, one line each.
    pub forms: &'static [&'static str],
    /// Where a minor word is used: major words and types.
    pub used_in: &'static [&'static str],
    /// The dialects that have the word.
    pub dialects: &'static [DialectName],
    /// Those among them in which it is not reserved: it is a word where no name can stand, and else a name.
    pub soft_in: &'static [DialectName],
    /// One line of help.
    pub help: &'static str,
}

impl Word {
    /// Whether a dialect has the word.
    pub fn is_in(&self, dialect: DialectName) -> bool {
        self.dialects.contains(&dialect)
    }

    /// Whether the word is reserved in a dialect: it cannot be a name there.
    pub fn is_reserved_in(&self, dialect: DialectName) -> bool {
        self.is_in(dialect) && !self.soft_in.contains(&dialect)
    }
}

/// The class of a word (language reference 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WordClass {
    /// PARTNO and its kin: the rest of the card is text.
    Text,
    /// Motion.
    Motion,
    /// Tool position: TLLFT and its kin.
    ToolPosition,
    /// Path parameter with operands: CUTTER, INTOL.
    PathParameter,
    /// Path control, may be followed by a comma and another statement.
    PathControl,
    /// Logic: IF, LOOPST, MACRO, CALL, FINI.
    Logic,
    /// Symbol and definition control: RESERV, SYN, CANON, OBTAIN, ZSURF, REFSYS.
    Declaration,
    /// Cutter-path transformation: TRACUT, INDEX, COPY.
    Transformation,
    /// Input and output: READ, PUNCH, PRINT.
    InputOutput,
    /// System flag.
    SystemFlag,
    /// Geometric type.
    GeometricType,
    /// Function.
    Function,
    /// Post-processor word with parameters.
    Postprocessor,
    /// Post-processor word without parameters.
    PostprocessorBare,
    /// Minor word.
    Minor,
}

/// What this program does with a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WordStatus {
    /// The grammar knows it; its use is reported as not available.
    Parsed,
    /// It is accepted and its form is checked; what it switched in the old processor does not exist here.
    NoEffect,
    /// The language reserves it without a public meaning: its use is reported.
    Reported,
    /// Sections 1 and 2 do what it says.
    Evaluated,
    /// The post-processor acts on it.
    OnTape,
    /// It stands on the CL file, for machine definitions and other post-processors.
    PassedThrough,
}

impl WordStatus {
    /// All statuses, in the order in which a page explains them.
    pub const ALL: [WordStatus; 6] = [
        WordStatus::Evaluated,
        WordStatus::NoEffect,
        WordStatus::Reported,
        WordStatus::OnTape,
        WordStatus::PassedThrough,
        WordStatus::Parsed,
    ];

    /// The status in words.
    pub fn as_str(self) -> &'static str {
        match self {
            WordStatus::Parsed => "parsed",
            WordStatus::NoEffect => "evaluated (no effect)",
            WordStatus::Reported => "evaluated (use reported)",
            WordStatus::Evaluated => "evaluated",
            WordStatus::OnTape => "on tape",
            WordStatus::PassedThrough => "passed through",
        }
    }
}

impl WordClass {
    /// Whether a word of this class may begin a statement.
    pub fn begins_statements(self) -> bool {
        !matches!(self, WordClass::GeometricType | WordClass::Function | WordClass::Minor)
    }

    /// Whether a word of this class, written without parameters, may be followed by a comma and another statement
    /// (language reference 2.4).
    pub fn joins_statements(self) -> bool {
        matches!(
            self,
            WordClass::PathControl
                | WordClass::PostprocessorBare
                | WordClass::SystemFlag
                | WordClass::ToolPosition
        )
    }
}

/// All words, sorted by spelling.
pub fn words() -> &'static [Word] {
    generated::WORDS
}

/// The word of a spelling (upper case), in whatever dialect it is reserved.
pub fn lookup(spelling: &str) -> Option<&'static Word> {
    BY_SPELLING.get(spelling).copied()
}

/// Every lexed word is looked up, so that a search by halves would be a fifth of the time of parsing.
static BY_SPELLING: LazyLock<FxHashMap<&'static str, &'static Word>> =
    LazyLock::new(|| words().iter().map(|word| (word.spelling, word)).collect());

/// The function that later systems know by this spelling, whether or not the dialect reserves it.
pub fn later_function(spelling: &str) -> Option<&'static Word> {
    let spelling = match spelling {
        "ACOSF" => "ARCOSF",
        "ASINF" => "ARSINF",
        other => other,
    };
    lookup(spelling).filter(|word| word.class == WordClass::Function)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    const SOURCE: &str = include_str!("../../vocabulary.toml");

    #[test]
    fn the_generated_table_is_that_of_the_data_file() {
        let made = generate::generate_rust(SOURCE).expect("the data file is valid");
        assert!(made == include_str!("generated.rs"), "run `cargo xtask codegen`");
    }

    #[test]
    fn every_word_is_found_and_explained() {
        for pair in words().windows(2) {
            assert!(pair[0].spelling < pair[1].spelling, "{} {}", pair[0].spelling, pair[1].spelling);
        }
        for word in words() {
            assert_eq!(lookup(word.spelling), Some(word));
            assert!(word.help.len() >= 12, "{} has no help", word.spelling);
            assert!(word.spelling.len() <= LONGEST_SPELLING, "{}", word.spelling);
            assert!(!word.dialects.is_empty(), "{}", word.spelling);
            assert!(word.soft_in.iter().all(|dialect| word.is_in(*dialect)), "{}", word.spelling);
            if word.class != WordClass::Minor {
                assert!(!word.forms.is_empty(), "{} has no form", word.spelling);
            }
        }
        assert_eq!(lookup("NOSUCH"), None);
        assert_eq!(lookup(""), None);
        assert_eq!(lookup("goto"), None, "spellings are upper case");
    }

    #[test]
    fn functions_of_later_systems_have_several_spellings() {
        let spelling = |name| later_function(name).map(|word| word.spelling);
        assert_eq!(spelling("ACOSF"), Some("ARCOSF"));
        assert_eq!(spelling("ASINF"), Some("ARSINF"));
        assert_eq!(spelling("MAXF"), Some("MAXF"));
        assert_eq!(spelling("POINT"), None);
        assert_eq!(spelling("NOSUCH"), None);
    }

    #[test]
    fn apt_iii_has_its_393_words() {
        let mut count = BTreeMap::new();
        for word in words().iter().filter(|word| word.is_in(DialectName::Apt3)) {
            *count.entry(word.class).or_insert(0) += 1;
        }
        assert_eq!(count.values().sum::<i32>(), 393, "{count:?}");
        assert_eq!(count[&WordClass::Text], 5);
        assert_eq!(count[&WordClass::GeometricType], 23);
        assert_eq!(count[&WordClass::Function], 15);
        assert_eq!(count[&WordClass::PostprocessorBare], 22);
    }

    #[test]
    fn no_word_of_apt_iii_is_only_parsed() {
        let of_apt_iii = words().iter().filter(|word| word.is_in(DialectName::Apt3));
        let open: Vec<&str> =
            of_apt_iii.filter(|word| word.status == WordStatus::Parsed).map(|word| word.spelling).collect();
        assert!(open.is_empty(), "{open:?}");
        // Without effect are system flags, and two words to which the motions have no public meaning; reserved without
        // a meaning are types of installations, and words of which only the name is known.
        for word in words() {
            let fits = match word.status {
                WordStatus::NoEffect => {
                    word.class == WordClass::SystemFlag || matches!(word.spelling, "DMILL" | "BEVELS")
                }
                WordStatus::Reported => {
                    let names_only = ["CLDATF", "GOMILL", "GCLEAR", "INTSEC", "FETCH"];
                    word.class == WordClass::GeometricType || names_only.contains(&word.spelling)
                }
                _ => true,
            };
            assert!(fits, "{}", word.spelling);
        }
    }

    #[test]
    fn codes_are_those_of_the_records() {
        for (spelling, code) in
            [("TANTO", 27), ("DSTAN", 27), ("FAN", 184), ("SPINDL", 1031), ("STOP", 2), ("POINT", 1)]
        {
            assert_eq!(lookup(spelling).and_then(|word| word.code), Some(code), "{spelling}");
        }
        assert_eq!(lookup("GOLFT").and_then(|word| word.record), Some((8000, 1)));
        assert_eq!(lookup("SPINDL").and_then(|word| word.record), Some((2000, 1031)));
    }
}

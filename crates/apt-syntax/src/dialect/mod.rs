//! Dialects, as data.
//!
//! A dialect is a set of switches that the lexer, the grammar and (for arithmetic) the evaluator ask. No code asks for
//! the dialect's name to decide what a text means.

mod detect;

use std::fmt;
use std::str::FromStr;

pub use detect::{
    BodyEvidence, Detection, DetectionReason, LINES_LOOKED_AT, detect, detect_with, name_in_comment,
};

use crate::vocabulary::{self, Word};

/// A named dialect.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum DialectName {
    /// APT III meaning without column limits (unless the file carries sequence fields).
    #[default]
    Free,
    /// Strict cards of APT III: columns 1-72, sequence field 73-80, names of six characters.
    Apt3,
    /// The APT4 dialect (language reference 10.4).
    Apt4,
    /// CL files written by CAM systems.
    Cl,
}

impl DialectName {
    /// All names, in the order in which they are shown.
    pub const ALL: [DialectName; 4] =
        [DialectName::Free, DialectName::Apt3, DialectName::Apt4, DialectName::Cl];

    /// The name on the command line and in project files.
    pub fn as_str(self) -> &'static str {
        match self {
            DialectName::Free => "free",
            DialectName::Apt3 => "apt3",
            DialectName::Apt4 => "apt4",
            DialectName::Cl => "cl",
        }
    }
}

impl fmt::Display for DialectName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}

/// A dialect name that does not exist.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown dialect {0:?}")]
pub struct UnknownDialect(pub String);

impl FromStr for DialectName {
    type Err = UnknownDialect;

    fn from_str(name: &str) -> Result<DialectName, UnknownDialect> {
        DialectName::ALL
            .into_iter()
            .find(|dialect| dialect.as_str().eq_ignore_ascii_case(name.trim()))
            .ok_or_else(|| UnknownDialect(name.to_owned()))
    }
}

/// When columns 73 and later are a sequence field and no part of the statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SequenceFieldRule {
    /// Always (cards).
    Always,
    /// If the file as a whole looks like it (language reference 1.11).
    WhenPresent,
    /// Never.
    Never,
}

/// How signs, `**` and chains of them are read (language reference 2.5 and 10.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SignRule {
    /// A sign binds tighter than `**` and there is only one; `**` associates to the right.
    TighterThanPower,
    /// `**` binds tighter than a sign, several signs may follow each other; `**` associates to the left.
    WeakerThanPower,
}

/// What becomes of a name with more characters than [`Dialect::name_length`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LongNames {
    /// It is an error, and what follows takes its first characters for the name (language reference 1.8).
    Refused,
    /// It is cut, with a warning (language reference 10.4).
    Cut,
    /// It is taken as it is. Only when blanks divide it, it is an error: more likely a comma is missing.
    Taken,
}

/// Where PARTNO and its kin begin a statement of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextWords {
    /// In columns 1-6 only, whatever follows (language reference 1.5).
    InColumnOne,
    /// There, and behind blanks if a blank or a slash follows (language reference 1.11 and 10.1).
    Indented,
    /// In any column, also behind the sequence numbers that CAM systems write.
    Anywhere,
}

/// The switches of a dialect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Dialect {
    /// The name under which it is shown.
    pub name: DialectName,
    /// Columns 73 and later.
    pub sequence_field: SequenceFieldRule,
    /// The most characters of a name; none for no limit.
    pub name_length: Option<u16>,
    /// What becomes of longer names.
    pub long_names: LongNames,
    /// The most significant digits of a number; none for no limit.
    pub number_digits: Option<u16>,
    /// The most elements of a statement; none for no limit.
    pub statement_elements: Option<u32>,
    /// The most nested definitions and points of a statement; none for no limit.
    pub statement_nests: Option<u32>,
    /// Tables have the sizes that they have in APT III: macro variables, synonyms, machines, points of curves and
    /// patterns (language reference 1.10).
    pub bounded_tables: bool,
    /// Where PARTNO and its kin may stand.
    pub text_words: TextWords,
    /// Blanks separate words and numbers.
    pub blanks_separate: bool,
    /// `-` and `_` may stand inside names.
    pub long_word_characters: bool,
    /// `'…'` is quoted text.
    pub quoted_text: bool,
    /// `;` separates statements on a line.
    pub semicolon_separates: bool,
    /// Signs and `**`.
    pub signs: SignRule,
    /// Parameters of a list may be expressions without parentheses.
    pub bare_expressions: bool,
    /// `P=(1,2)` defines a point.
    pub bare_points: bool,
    /// `X=Y=4` and `A(I=I+1)`.
    pub chained_assignment: bool,
    /// Functions of later systems (INTF, MAXF) are functions where no array has their name.
    pub later_functions: bool,
    /// A vocabulary word becomes a name by assignment.
    pub words_as_names: bool,
    /// `IF(a.LT.b)statement`.
    pub logical_if: bool,
    /// `.NOT.` in the condition of a logical IF.
    pub logical_not: bool,
    /// `IF(a.LT.b)THEN`, `ELSEIF(a.LT.b)THEN`, `ELSE` and `ENDIF`.
    pub structured_if: bool,
    /// `DO/label,i=first,last,step`.
    pub do_loops: bool,
    /// Macro values may be expressions, subscripted names and nested definitions.
    pub macro_value_expressions: bool,
    /// A slash may stand after OBTAIN instead of the comma.
    pub obtain_slash: bool,
    /// IF and JUMPTO also outside of loops and macros.
    pub branch_anywhere: bool,
    /// `GOTO` may be left out before a line of numbers.
    pub implicit_goto: bool,
    /// Major words that nobody knows are kept, not refused.
    pub unknown_majors: bool,
    /// Empty parameters are allowed in every list.
    pub empty_parameters: bool,
    /// Post-processor words of class [`vocabulary::WordClass::PostprocessorBare`] take no parameters.
    pub bare_words_strict: bool,
}

/// The most significant digits that it takes to write a double so that it is read again as it was.
const DIGITS_OF_A_DOUBLE: u16 = 17;

impl Dialect {
    /// The switches of a named dialect.
    pub const fn named(name: DialectName) -> Dialect {
        match name {
            DialectName::Free => Dialect {
                long_names: LongNames::Taken,
                number_digits: Some(DIGITS_OF_A_DOUBLE),
                later_functions: true,
                text_words: TextWords::Indented,
                semicolon_separates: true,
                logical_if: true,
                logical_not: true,
                structured_if: true,
                do_loops: true,
                ..Dialect::APT_III
            },
            DialectName::Apt3 => Dialect {
                name: DialectName::Apt3,
                sequence_field: SequenceFieldRule::Always,
                statement_elements: Some(600),
                statement_nests: Some(10),
                bounded_tables: true,
                ..Dialect::APT_III
            },
            DialectName::Apt4 => Dialect {
                name: DialectName::Apt4,
                obtain_slash: false,
                long_names: LongNames::Cut,
                number_digits: None,
                signs: SignRule::WeakerThanPower,
                bare_expressions: true,
                bare_points: true,
                chained_assignment: true,
                words_as_names: true,
                logical_if: true,
                do_loops: true,
                macro_value_expressions: true,
                branch_anywhere: true,
                ..Dialect::APT_III
            },
            DialectName::Cl => Dialect {
                name: DialectName::Cl,
                sequence_field: SequenceFieldRule::Never,
                name_length: None,
                number_digits: None,
                text_words: TextWords::Anywhere,
                blanks_separate: true,
                long_word_characters: true,
                quoted_text: true,
                implicit_goto: true,
                unknown_majors: true,
                empty_parameters: true,
                bare_words_strict: false,
                ..Dialect::APT_III
            },
        }
    }

    /// APT III without columns; the other dialects differ from it.
    const APT_III: Dialect = Dialect {
        name: DialectName::Free,
        sequence_field: SequenceFieldRule::WhenPresent,
        name_length: Some(6),
        long_names: LongNames::Refused,
        number_digits: Some(16),
        statement_elements: None,
        statement_nests: None,
        bounded_tables: false,
        text_words: TextWords::InColumnOne,
        blanks_separate: false,
        long_word_characters: false,
        quoted_text: false,
        semicolon_separates: false,
        signs: SignRule::TighterThanPower,
        bare_expressions: false,
        bare_points: false,
        chained_assignment: false,
        later_functions: false,
        words_as_names: false,
        logical_if: false,
        logical_not: false,
        structured_if: false,
        do_loops: false,
        macro_value_expressions: false,
        obtain_slash: true,
        branch_anywhere: false,
        implicit_goto: false,
        unknown_majors: false,
        empty_parameters: false,
        bare_words_strict: true,
    };

    /// The vocabulary word of a spelling (upper case), if it is reserved in this dialect.
    pub fn word(&self, spelling: &str) -> Option<&'static Word> {
        vocabulary::lookup(spelling).filter(|word| word.is_reserved_in(self.name))
    }
}

impl Default for Dialect {
    fn default() -> Dialect {
        Dialect::named(DialectName::default())
    }
}

impl From<DialectName> for Dialect {
    fn from(name: DialectName) -> Dialect {
        Dialect::named(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for name in DialectName::ALL {
            assert_eq!(name.as_str().parse(), Ok(name));
            assert_eq!(Dialect::named(name).name, name);
        }
        assert_eq!("APT4".parse(), Ok(DialectName::Apt4));
        assert_eq!("fortran".parse::<DialectName>(), Err(UnknownDialect("fortran".to_owned())));
    }

    #[test]
    fn a_word_is_reserved_only_in_its_dialects() {
        let free = Dialect::named(DialectName::Free);
        let apt4 = Dialect::named(DialectName::Apt4);
        assert!(free.word("POINT").is_some());
        assert!(free.word("INTF").is_none(), "INTF is an array name in APT III (error 108)");
        for spelling in ["THEN", "ELSE", "ENDIF", "DO", "UNITS"] {
            assert!(free.word(spelling).is_none(), "{spelling} stays a name of APT III");
        }
        assert!(apt4.word("INTF").is_some());
    }
}

//! How a user wants programs to look.

use apt_syntax::{Dialect, record::SEQUENCE_FIELD_COLUMN};
use serde::{Deserialize, Serialize};

/// Columns that the body of a macro or loop is moved to the right: a label of three characters with its parenthesis
/// still stands before it.
const INDENT: usize = 5;

/// The last column of the statement field of a card.
pub const LAST_STATEMENT_COLUMN: usize = SEQUENCE_FIELD_COLUMN - 1;

/// What happens to letters outside of texts and comments.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LetterCase {
    /// Words, names and exponents in upper case.
    #[default]
    Upper,
    /// Vocabulary words in upper case, names as they are.
    Words,
    /// Everything as it is.
    Keep,
}

/// The style.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct FormatOptions {
    /// Letters of words and names.
    pub letter_case: LetterCase,
    /// Columns by which the body of a macro or a loop stands to the right of its first statement.
    pub indent: usize,
    /// Columns by which a continuation record stands to the right of its statement.
    pub continuation_indent: usize,
    /// The last column that a statement may use; what is longer is continued with `$`. `None` leaves long lines as they
    /// are. Lines of a file with sequence fields end before these in any case.
    pub wrap: Option<usize>,
    /// Comments behind the statements of adjacent lines begin in the same column.
    pub align_comments: bool,
}

impl FormatOptions {
    /// The usual style of a dialect. Names in CL files are those of other systems and keep their letters.
    pub fn of(dialect: &Dialect) -> Self {
        let letter_case = if dialect.unknown_majors { LetterCase::Words } else { LetterCase::Upper };
        Self { letter_case, ..Self::default() }
    }
}

impl Default for FormatOptions {
    fn default() -> Self {
        Self {
            letter_case: LetterCase::default(),
            indent: INDENT,
            continuation_indent: INDENT,
            wrap: None,
            align_comments: true,
        }
    }
}

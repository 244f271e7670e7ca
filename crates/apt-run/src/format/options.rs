//! How a user wants programs to look.

use apt_syntax::{Dialect, record::SEQUENCE_FIELD_COLUMN};
use serde::{Deserialize, Deserializer, Serialize, de::Error};

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

/// The shortest line that `wrap` may ask for: a long name and a number still stand together.
const LEAST_WRAP: usize = 20;

/// The deepest indentation of one level that may be asked for.
const MOST_INDENT: usize = 20;

/// What a project says about the style; the rest is the usual style of the dialect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct FormatSettings {
    /// Letters of words and names.
    pub letter_case: Option<LetterCase>,
    /// See [`FormatOptions::indent`]; at most 20.
    #[serde(deserialize_with = "indent")]
    pub indent: Option<usize>,
    /// See [`FormatOptions::continuation_indent`]; at most 20.
    #[serde(deserialize_with = "indent")]
    pub continuation_indent: Option<usize>,
    /// The last column of a statement; what is longer is continued with `$`. At least 20, usually 72. Long lines stay as
    /// they are without it.
    #[serde(deserialize_with = "wrap")]
    pub wrap: Option<usize>,
    /// See [`FormatOptions::align_comments`].
    pub align_comments: Option<bool>,
}

fn indent<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<usize>, D::Error> {
    let columns = Option::<usize>::deserialize(deserializer)?;
    match columns {
        Some(columns) if columns > MOST_INDENT => {
            Err(D::Error::custom(format!("an indentation of {columns} columns; at most {MOST_INDENT}")))
        }
        columns => Ok(columns),
    }
}

fn wrap<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<usize>, D::Error> {
    let column = Option::<usize>::deserialize(deserializer)?;
    match column {
        Some(column) if column < LEAST_WRAP => {
            Err(D::Error::custom(format!("wrap at column {column}; at least {LEAST_WRAP}")))
        }
        column => Ok(column),
    }
}

impl FormatOptions {
    /// The style of a program: what its project says, and the usual style of its dialect.
    pub fn with(dialect: &Dialect, settings: &FormatSettings) -> Self {
        let usual = Self::of(dialect);
        Self {
            letter_case: settings.letter_case.unwrap_or(usual.letter_case),
            indent: settings.indent.unwrap_or(usual.indent),
            continuation_indent: settings.continuation_indent.unwrap_or(usual.continuation_indent),
            wrap: settings.wrap.or(usual.wrap),
            align_comments: settings.align_comments.unwrap_or(usual.align_comments),
        }
    }

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

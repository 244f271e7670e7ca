//! Codes and hints for the text of CL files that cannot be taken as it stands (codes 081x).

use apt_cldata::text::{ReadError, ReadErrorKind as Kind};

use super::{Text, say};
use crate::diagnostic::Severity;

/// The words and the severity of something in a CL file.
pub(super) fn word(error: &ReadError) -> (Text, Severity) {
    let mut text = say(code(&error.kind), error.kind.to_string());
    text.hint = hint(&error.kind).map(str::to_owned);
    let severity = match error.kind {
        // The path is the one that the file means.
        Kind::AxisLength { .. } => Severity::Warning,
        _ => Severity::Error,
    };
    (text, severity)
}

fn code(kind: &Kind) -> &'static str {
    match kind {
        Kind::Unreadable | Kind::UnknownUnit { .. } => "APT0810",
        Kind::Definition { .. } => "APT0811",
        Kind::NotRead { .. } => "APT0812",
        Kind::WrongCount { .. } | Kind::NotNumber { .. } => "APT0813",
        Kind::NoPosition | Kind::NoGoto => "APT0814",
        Kind::AxisLength { .. } | Kind::AxisZero => "APT0815",
        Kind::NoCircle { .. } | Kind::OffCircle { .. } => "APT0816",
    }
}

fn hint(kind: &Kind) -> Option<&'static str> {
    match kind {
        Kind::Definition { .. } => {
            Some("this is a part program: run it with the dialect `free` instead of reading it as a CL file")
        }
        Kind::NotRead { .. } => Some("the path has a gap here; write the file with plain GOTO records"),
        Kind::NoPosition => Some("begin the path with FROM or GOTO"),
        _ => None,
    }
}

//! The dialect in force and why, in words.

use apt_cldata::text::ClDialect;
use apt_run::document::{DialectReason, Document};
use apt_syntax::dialect::{DetectionReason, DialectName};

/// The dialect in force with the reason, as in `cl (the file name ends with .cls)`.
pub fn describe(document: &Document) -> String {
    let why = match document.dialect_reason() {
        DialectReason::Setting => "as set".to_owned(),
        DialectReason::Binary(ClDialect::Ncl) => "a binary file of NCL".to_owned(),
        DialectReason::Binary(_) => "a binary CLTAPE of APT III".to_owned(),
        DialectReason::Detected(DetectionReason::Comment) => "a comment in the file says so".to_owned(),
        DialectReason::Detected(DetectionReason::Extension(ending)) => {
            format!("the file name ends with .{ending}")
        }
        DialectReason::Detected(DetectionReason::Mark(mark)) => format!("the file has {mark}"),
        DialectReason::Detected(DetectionReason::SequenceFields) => {
            "columns 73 to 80 hold sequence numbers".to_owned()
        }
        DialectReason::Detected(DetectionReason::Default) => "the default".to_owned(),
    };
    format!("{} ({why})", document.dialect().as_str())
}

/// The names of all dialects, in the order in which they are shown.
pub fn names() -> Vec<&'static str> {
    DialectName::ALL.map(DialectName::as_str).to_vec()
}

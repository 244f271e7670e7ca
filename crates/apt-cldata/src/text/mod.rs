//! CL text: the recognition of dialects, a tolerant reader for all of them, and a writer that follows the description of each (`dialects`).

mod detect;
pub(crate) mod dialects;
mod number;
mod reader;
mod sheet;
mod statements;
pub(crate) mod words;
pub(crate) mod writer;

pub(crate) use detect::sign_of_remark;
pub use detect::{ClDialect, UnknownClDialect, detect};
pub use reader::{
    ClFile, ClText, ReadError, ReadErrorKind, Remark, Shortened, read_text, read_with_remarks,
    read_with_remarks_until,
};
pub use writer::{write_text, write_text_until, write_text_with_lines, write_text_with_lines_until};

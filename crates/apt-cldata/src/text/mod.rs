//! APT CL text: the writer, a tolerant reader for generic files, and the recognition of dialects.

mod detect;
mod reader;
mod statements;
mod words;
mod writer;

pub use detect::{ClDialect, detect};
pub use reader::{ReadError, ReadErrorKind, read_text};
pub use writer::{TextOptions, write_text};

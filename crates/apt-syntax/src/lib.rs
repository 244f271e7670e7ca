//! Section 1, phase 1: text to a lossless tree, typed statements, the vocabulary and the dialects.
//!
//! Nothing here knows geometry. Parsing never fails: for every input the text of the tree is the input.

pub mod dialect;
pub mod statement;
pub mod vocabulary;

pub use rowan::{TextRange, TextSize};

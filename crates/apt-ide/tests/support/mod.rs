//! Programs with places marked in their text.

#![allow(dead_code, reason = "each test file uses some of it")]

use std::sync::Arc;

use apt_ide::{Analysis, Settings};

/// A program without its mark `$0`, and where the mark stood.
pub(crate) fn marked(text: &str) -> (Analysis, usize) {
    let offset = text.find("$0").expect("a mark");
    (analysis(&text.replacen("$0", "", 1)), offset)
}

/// A program.
pub(crate) fn analysis(text: &str) -> Analysis {
    Analysis::new(text, Some("part.apt".to_owned()), &Arc::new(Settings::default()))
}

/// Nobody cancels.
pub(crate) fn never() -> bool {
    false
}

/// Nobody watches.
pub(crate) fn silent(_: usize, _: usize) {}

//! The page of each code: what it means, a wrong and a right sample. The text is in `pages.toml`.

use std::sync::LazyLock;

use serde::Deserialize;

/// The page of a diagnostic code.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Page {
    /// The code, `APTnnnn`.
    pub code: String,
    /// What it is called.
    pub title: String,
    /// What it means and what to do, a few sentences.
    pub text: String,
    /// A program that gets it.
    pub wrong: String,
    /// The same program put right.
    pub right: String,
    /// The dialect of the samples; free if not said.
    #[serde(default)]
    pub dialect: Option<String>,
    /// The first sample cannot show it by itself (budgets, files); the reason.
    #[serde(default)]
    pub not_shown: Option<String>,
}

#[derive(Deserialize)]
struct File {
    page: Vec<Page>,
}

static PAGES: LazyLock<Vec<Page>> = LazyLock::new(|| {
    // The file is part of the program and a test reads it; a reader of a broken file would see no pages.
    toml::from_str::<File>(include_str!("pages.toml")).map(|file| file.page).unwrap_or_default()
});

/// All pages, in order of their codes.
pub fn pages() -> &'static [Page] {
    &PAGES
}

/// The page of a code; letter case and the letters `APT` do not matter (`apt0101`, `101`).
pub fn explain(code: &str) -> Option<&'static Page> {
    let digits = code.trim().to_ascii_uppercase();
    let digits = digits.trim_start_matches("APT");
    let number: u16 = digits.parse().ok()?;
    let wanted = format!("APT{number:04}");
    PAGES.iter().find(|page| page.code == wanted)
}

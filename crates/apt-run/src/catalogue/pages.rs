//! The page of each code: what it means, a wrong and a right sample. The texts are in the folder `pages`, one file for
//! each group of codes.

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
    /// The machine for which samples of the tape are posted; linuxcnc-mill3 if not said.
    #[serde(default)]
    pub machine: Option<String>,
    /// The first sample cannot show it by itself (budgets, files); the reason.
    #[serde(default)]
    pub not_shown: Option<String>,
}

#[derive(Deserialize)]
struct File {
    page: Vec<Page>,
}

/// The files, in the order of their codes.
const FILES: [&str; 13] = [
    include_str!("pages/syntax.toml"),
    include_str!("pages/names.toml"),
    include_str!("pages/definitions.toml"),
    include_str!("pages/blocks.toml"),
    include_str!("pages/motion.toml"),
    include_str!("pages/sculptured.toml"),
    include_str!("pages/element.toml"),
    include_str!("pages/path.toml"),
    include_str!("pages/reading.toml"),
    include_str!("pages/tape.toml"),
    include_str!("pages/program.toml"),
    include_str!("pages/lint.toml"),
    include_str!("pages/other.toml"),
];

static PAGES: LazyLock<Vec<Page>> = LazyLock::new(|| {
    // The files are part of the program and a test reads them; a reader of a broken file would miss its pages.
    let read = |text: &&str| toml::from_str::<File>(text).map(|file| file.page).unwrap_or_default();
    FILES.iter().flat_map(read).collect()
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

//! What the oracle, corpus and end-to-end tests share: running a program and comparing reports.

pub mod oracle;
pub mod runs;
pub mod sculptured;

use std::path::{Path, PathBuf};

/// The allocator of the program `apt-lsp`, so that its memory and its silences are those that are measured.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[global_allocator]
static ALLOCATOR: tikv_jemallocator::Jemalloc = tikv_jemallocator::Jemalloc;

/// A path below the root of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// Runs the program in a file through Sections 1 to 3 and gives the JSON of `run --format json`.
pub fn run_report(path: &Path, dialect: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let file = path.file_name().and_then(|name| name.to_str()).unwrap_or("program.apt");
    run_text(&text, file, dialect)
}

/// Runs a program under the name of a file and gives the JSON of `run --format json`.
pub fn run_text(text: &str, file: &str, dialect: &str) -> serde_json::Value {
    let settings = std::sync::Arc::new(apt_run::settings::Settings {
        dialect: Some(dialect.to_owned()),
        ..Default::default()
    });
    let document = apt_run::document::Document::new(text, Some(file.to_owned()), &settings);
    let report = document.report(&|| false, &mut |_, _| {}, None);
    serde_json::to_value(report.expect("not cancelled")).expect("a report is JSON")
}

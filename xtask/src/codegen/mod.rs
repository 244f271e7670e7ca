//! Everything that is made from the vocabulary file.

mod language;
mod textmate;
mod vim;
mod words;

use std::path::PathBuf;

use crate::codegen::words::Vocabulary;
use crate::failure::{Failure, FileContext, Outcome};
use crate::layout;

/// A file made from the vocabulary.
struct Generated {
    /// Where it stands.
    path: PathBuf,
    /// What it shall say.
    text: String,
}

fn generate(source: &str) -> Outcome<Vec<Generated>> {
    let vocabulary = Vocabulary::parse(source)?;
    Ok(vec![
        Generated {
            path: layout::root().join("crates/apt-syntax/src/vocabulary/generated.rs"),
            text: apt_syntax::vocabulary::generate::generate_rust(source)
                .map_err(|fault| Failure::Vocabulary(fault.to_string()))?,
        },
        Generated {
            path: layout::vscode().join("syntaxes/apt.tmLanguage.json"),
            text: textmate::grammar(&vocabulary),
        },
        Generated { path: layout::nvim().join("syntax/apt.vim"), text: vim::syntax(&vocabulary) },
        Generated { path: layout::root().join("docs/language.md"), text: language::page(source)? },
    ])
}

/// Writes the generated files, or with `check` only compares them.
pub(crate) fn run(check: bool) -> Outcome {
    let source_file = layout::vocabulary();
    let source = std::fs::read_to_string(&source_file).on("read", &source_file)?;
    let mut stale = Vec::new();
    for file in generate(&source)? {
        let present = std::fs::read_to_string(&file.path).ok();
        if present.as_deref() == Some(file.text.as_str()) {
            continue;
        }
        let name = file.path.strip_prefix(layout::root()).unwrap_or(&file.path).display().to_string();
        if check {
            stale.push(name);
            continue;
        }
        if let Some(folder) = file.path.parent() {
            std::fs::create_dir_all(folder).on("create", folder)?;
        }
        std::fs::write(&file.path, &file.text).on("write", &file.path)?;
        println!("made {name}");
    }
    if stale.is_empty() { Ok(()) } else { Err(Failure::Stale(stale)) }
}

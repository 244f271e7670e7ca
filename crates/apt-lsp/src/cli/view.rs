//! `view`: the path as a picture.

use std::path::Path;

use super::Outcome;
use super::arguments::ViewCall;
use super::console::Console;
use super::findings::{self, Checked};
use super::program::Program;
use crate::analysis::{Language, Level, PictureKind, Product, Refusal};

/// Draws the path of a program. What keeps it from being whole is told.
pub(super) fn view(call: &ViewCall, console: &Console, language: &dyn Language) -> Outcome {
    let Some(kind) = kind_of(&call.output) else {
        console.error(&format!("{}: the name does not end with .html, .svg or .png", call.output.display()));
        return Outcome::Unusable;
    };
    let Some(program) = Program::read(&call.program, console, language) else { return Outcome::Unusable };
    let (control, bar) = console.control(&program.name);
    let found = program.document.diagnostics(Level::Motion, &control).map_err(Refusal::from);
    let both =
        found.and_then(|found| Ok((found, program.document.product(&Product::Picture(kind), &control)?)));
    bar.finish_and_clear();
    let (diagnostics, picture) = match both {
        Ok(both) => both,
        Err(refusal) => {
            console.error(&format!("{}: {refusal}", program.name));
            return Outcome::Unusable;
        }
    };
    let written = console.write(&picture, Some(&call.output));
    written.max(findings::tell(Checked { program, diagnostics }, call.deny_warnings, console))
}

fn kind_of(output: &Path) -> Option<PictureKind> {
    match output.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "html" | "htm" => Some(PictureKind::Html),
        "svg" => Some(PictureKind::Svg),
        "png" => Some(PictureKind::Png),
        _ => None,
    }
}

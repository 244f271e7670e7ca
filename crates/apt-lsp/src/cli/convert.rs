//! `convert`: the cutter locations of a program or CL file in another CL dialect.

use super::Outcome;
use super::arguments::ConvertCall;
use super::console::Console;
use super::findings::{self, Checked};
use super::program::Program;
use crate::analysis::{ConvertedFile, Language};

/// Converts a program or file. What the dialect says otherwise is told with what is found in the source.
pub(super) fn convert(call: &ConvertCall, console: &Console, language: &dyn Language) -> Outcome {
    let Some(program) = Program::read(&call.program, console, language) else { return Outcome::Unusable };
    let (control, bar) = console.control(&program.name);
    let made = program.document.convert(call.to, program.tape.as_deref(), &control);
    bar.finish_and_clear();
    let made = match made {
        Ok(made) => made,
        Err(refusal) => {
            console.error(&format!("{}: {refusal}", program.name));
            return Outcome::Unusable;
        }
    };
    console.note(&format!("{}: from {} to {}", program.name, made.from.title(), call.to.title()));
    let bytes = match made.file {
        ConvertedFile::Tape(bytes) => bytes,
        // In the form of its source: what was read as Latin-1 is written so.
        ConvertedFile::Text(text) => {
            program.form.and_then(|form| form.encode(&text)).unwrap_or_else(|| text.into_bytes())
        }
    };
    let written = console.write(&bytes, call.output.as_deref());
    let checked = Checked { program, diagnostics: made.diagnostics };
    written.max(findings::tell(checked, call.deny_warnings, console))
}

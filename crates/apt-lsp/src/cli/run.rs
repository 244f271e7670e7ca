//! `run`: a program, run to its CL points.

use std::path::Path;

use serde_json::Value;

use super::Outcome;
use super::arguments::{RunCall, RunFormat};
use super::console::Console;
use super::findings::{self, Checked};
use super::listing;
use super::program::Program;
use crate::analysis::{Control, Language, Level, Product, Refusal, RunRequest};

/// Runs a program and prints what was asked for.
pub(super) fn run(call: &RunCall, console: &Console, language: &dyn Language) -> Outcome {
    let Some(program) = Program::read(&call.program, console, language) else { return Outcome::Unusable };
    let output = call.output.as_deref();
    let format = call.format.unwrap_or_else(|| format_of(output));
    let (control, bar) = console.control(&program.name);
    let diagnostics = program.document.diagnostics(Level::Motion, &control);
    let product = product(&program, format, call.explain_motion, &control);
    bar.finish_and_clear();
    let (diagnostics, product) =
        match diagnostics.map_err(Refusal::from).and_then(|found| Ok((found, product?))) {
            Ok(both) => both,
            Err(refusal) => {
                console.error(&format!("{}: {refusal}", program.name));
                return Outcome::Unusable;
            }
        };
    let checked = [Checked { program, diagnostics }];
    let written = match (format, product) {
        (RunFormat::Sarif, _) => findings::sarif::write(&checked, output, console, language),
        (RunFormat::Github, _) => console.write(findings::github::text(&checked).as_bytes(), output),
        (_, Some(bytes)) => console.write(&bytes, output),
        (_, None) => Outcome::Clean,
    };
    if !matches!(format, RunFormat::Json | RunFormat::Sarif | RunFormat::Github) {
        let text = findings::human::text(&checked);
        if !text.is_empty() {
            console.tell(text.trim_end());
        }
    }
    written.max(findings::outcome(&checked, call.deny_warnings))
}

/// What the name of the output says.
fn format_of(output: Option<&Path>) -> RunFormat {
    let ending = output.and_then(Path::extension).and_then(|ending| ending.to_str()).unwrap_or_default();
    match ending.to_ascii_lowercase().as_str() {
        "json" => RunFormat::Json,
        "sarif" => RunFormat::Sarif,
        "cl" | "cls" | "ncl" => RunFormat::Cl,
        "cltape" => RunFormat::Cltape,
        _ => RunFormat::Human,
    }
}

/// What is written; nothing if only findings are.
fn product(
    program: &Program,
    format: RunFormat,
    story: bool,
    control: &Control,
) -> Result<Option<Vec<u8>>, Refusal> {
    match format {
        RunFormat::Human => {
            let source = program.index.rope.to_string();
            let statements = program.document.statements();
            let statements: Vec<&str> =
                statements.into_iter().filter_map(|range| source.get(range)).collect();
            Ok(Some(listing::text(&report(program, story, control)?, &statements).into_bytes()))
        }
        RunFormat::Json => Ok(Some(format!("{}\n", report(program, story, control)?).into_bytes())),
        RunFormat::Cl => program.document.product(&Product::ClText, control).map(Some),
        RunFormat::Cltape => program.document.product(&Product::Cltape, control).map(Some),
        RunFormat::Sarif | RunFormat::Github => Ok(None),
    }
}

fn report(program: &Program, story: bool, control: &Control) -> Result<Value, Refusal> {
    let request = RunRequest { story, ..RunRequest::default() };
    let mut report = program.document.run(&request, control)?;
    let name = Path::new(&program.name).file_name().and_then(|name| name.to_str());
    if let (Some(name), Some(fields)) = (name, report.as_object_mut()) {
        fields.insert("program".to_owned(), Value::String(name.to_owned()));
    }
    Ok(report)
}

//! `diff`: where the paths of two programs or CL files differ.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::Outcome;
use super::arguments::{DiffCall, DiffFormat, ProgramArgument};
use super::console::Console;
use super::findings::{self, Checked};
use super::listing::plain;
use super::program::{Program, STANDARD_INPUT};
use crate::analysis::{
    Allowance, DifferentStretch, Language, PathDifference, Statement, StretchKind, StretchSide, ToolPath,
    Units,
};

/// Compares two paths. Differences are findings, and so are errors of the programs.
pub(super) fn diff(call: &DiffCall, console: &Console, language: &dyn Language) -> Outcome {
    if [&call.first, &call.second].iter().all(|file| file.as_os_str() == STANDARD_INPUT) {
        console.error("standard input holds one program: A and B cannot both be `-`");
        return Outcome::Unusable;
    }
    let read = |file: &std::path::PathBuf| {
        let argument = ProgramArgument { file: file.clone(), reading: call.reading.clone() };
        path_of(Program::read(&argument, console, language)?, console)
    };
    let (Some((first, a)), Some((second, b))) = (read(&call.first), read(&call.second)) else {
        return Outcome::Unusable;
    };
    let allowance = Allowance { distance: call.tolerance, degrees: call.axis_tolerance };
    let (control, bar) = console.control("comparing");
    let found = language.difference([&a, &b], allowance, &control);
    bar.finish_and_clear();
    let checked = [first, second];
    let found = match found {
        Ok(found) => found,
        Err(refusal) => {
            console.error(&refusal.to_string());
            return Outcome::Unusable;
        }
    };
    note_units(&found, &checked, console);
    let written = match call.format {
        DiffFormat::Human => console.print(&text(&found, &checked)),
        DiffFormat::Json => console.print(&format!("{}\n", report(&found, &checked))),
    };
    let told = findings::human::text(&checked);
    if !told.is_empty() {
        console.tell(told.trim_end());
    }
    let differs = if found.stretches.is_empty() { Outcome::Clean } else { Outcome::Findings };
    written.max(differs).max(findings::outcome(&checked, call.deny_warnings))
}

/// Runs or reads a program to its path.
fn path_of(program: Program, console: &Console) -> Option<(Checked, ToolPath)> {
    let (control, bar) = console.control(&program.name);
    let found = program.document.tool_path(&control);
    bar.finish_and_clear();
    match found {
        Ok((path, diagnostics)) => Some((Checked { program, diagnostics }, path)),
        Err(interrupted) => {
            console.error(&format!("{}: {interrupted}", program.name));
            None
        }
    }
}

/// Says what was made of different units.
fn note_units(found: &PathDifference, [first, second]: &[Checked; 2], console: &Console) {
    match [&found.paths[0].units, &found.paths[1].units] {
        [Some(a), Some(b)] if a != b => {
            let [a, b] = [a, b].map(|units| unit_name(*units));
            console.note(&format!("{} is in {b}; compared in {a}", second.program.name));
        }
        [Some(_), None] => console.note(&format!("{} names no unit; taken as it is", second.program.name)),
        [None, Some(_)] => console.note(&format!("{} names no unit; taken as it is", first.program.name)),
        _ => {}
    }
}

fn unit_name(units: Units) -> &'static str {
    match units {
        Units::Inches => "inches",
        Units::Millimeters => "mm",
    }
}

/// The comparison for people.
fn text(found: &PathDifference, checked: &[Checked; 2]) -> String {
    let mut text = String::new();
    for (letter, (path, one)) in ["A", "B"].iter().zip(found.paths.iter().zip(checked)) {
        let [places, length] = [path.places.to_string(), plain(path.length)];
        let _ = writeln!(text, "{letter} {}: {places} places, {length} long", one.program.name);
    }
    for (index, stretch) in found.stretches.iter().enumerate() {
        let _ = writeln!(text, "\n{}. {}", index + 1, summary(stretch));
        for (letter, (side, one)) in ["A", "B"].iter().zip(stretch.sides.iter().zip(checked)) {
            let told = side.as_ref().map_or_else(|| "no path".to_owned(), |side| of_side(side, &one.program));
            let _ = writeln!(text, "   {letter} {told}");
        }
    }
    let tolerance = figures(found.tolerance);
    let farthest = found.stretches.iter().filter_map(|stretch| stretch.apart).map(|(distance, _)| distance);
    let _ = match found.stretches.len() {
        0 => writeln!(text, "no difference (tolerance {tolerance})"),
        count => {
            let plural = if count == 1 { " differs" } else { "es differ" };
            let farthest = farthest.fold(0.0, f64::max);
            writeln!(
                text,
                "\n{count} stretch{plural}, by up to {} (tolerance {tolerance})",
                figures(farthest)
            )
        }
    };
    text
}

/// A number to three figures.
fn figures(value: f64) -> String {
    let decimals = if value > 0.0 { (2.0 - value.log10().floor()).clamp(0.0, 12.0) } else { 0.0 };
    let text = format!("{value:.*}", decimals as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn place(at: &[f64; 3]) -> String {
    format!("({})", at.map(plain).join(", "))
}

fn summary(stretch: &DifferentStretch) -> String {
    let Some((apart, at)) = stretch.apart else { return "only one has a path".to_owned() };
    match stretch.kind {
        StretchKind::Places => format!("up to {} apart, at {}", figures(apart), place(&at)),
        StretchKind::Axes => format!("tool axes turned by up to {} degrees", figures(stretch.turned)),
        StretchKind::Manner => "one goes at rapid where the other feeds".to_owned(),
        StretchKind::Order => "the same places in another order".to_owned(),
    }
}

fn of_side(side: &StretchSide, program: &Program) -> String {
    let line = |statement: &Statement| program.index.position(statement.range.start).line + 1;
    let [from, to] = [line(&side.from.1), line(&side.to.1)];
    if side.length == 0.0 && side.from.0 == side.to.0 {
        return format!("stays at {} (line {to})", place(&side.to.0));
    }
    let rapid = if side.rapid_length > 0.0 {
        format!(", {} of it at rapid", figures(side.rapid_length))
    } else {
        String::new()
    };
    let [begin, end] = [place(&side.from.0), place(&side.to.0)];
    format!("from {begin} (line {from}) to {end} (line {to}), {} long{rapid}", figures(side.length))
}

/// The comparison as JSON.
fn report(found: &PathDifference, checked: &[Checked; 2]) -> Value {
    let path = |side: usize| {
        let path = &found.paths[side];
        json!({
            "file": checked[side].program.name,
            "units": path.units.map(unit_name),
            "points": path.places,
            "length": path.length,
        })
    };
    let differences: Vec<Value> =
        found.stretches.iter().map(|stretch| of_stretch(stretch, checked)).collect();
    json!({
        "a": path(0),
        "b": path(1),
        "tolerance": found.tolerance,
        "axis_tolerance": found.degrees,
        "same": differences.is_empty(),
        "differences": differences,
    })
}

fn of_stretch(stretch: &DifferentStretch, checked: &[Checked; 2]) -> Value {
    let kind = match stretch.kind {
        StretchKind::Places => "places",
        StretchKind::Axes => "axes",
        StretchKind::Manner => "manner",
        StretchKind::Order => "order",
    };
    let end = |(position, statement): &([f64; 3], Statement), program: &Program| {
        json!({
            "position": position,
            "isn": statement.isn,
            "range": program.index.range(&statement.range),
        })
    };
    let side = |side: usize| {
        let (stretch, program) = (stretch.sides[side].as_ref()?, &checked[side].program);
        Some(json!({
            "from": end(&stretch.from, program),
            "to": end(&stretch.to, program),
            "length": stretch.length,
            "rapid_length": stretch.rapid_length,
        }))
    };
    json!({
        "kind": kind,
        "apart": stretch.apart.map(|(distance, _)| distance),
        "at": stretch.apart.map(|(_, at)| at),
        "turned": stretch.turned,
        "a": side(0),
        "b": side(1),
    })
}

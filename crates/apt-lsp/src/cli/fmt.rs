//! `fmt`: programs get the style of their project.

use std::path::Path;

use super::Outcome;
use super::arguments::FmtCall;
use super::console::Console;
use super::file;
use super::program::{self, Dialects, Program, STANDARD_INPUT};
use crate::analysis::{Control, Language};

/// Statements of one file that are named if they cannot be given the style.
const MOST_NAMED: usize = 5;

/// Formats programs in place, or says which ones do not have the style.
pub(super) fn fmt(call: &FmtCall, console: &Console, language: &dyn Language) -> Outcome {
    let (files, unreadable) = program::find(&call.paths, console);
    let mut worst = if unreadable > 0 { Outcome::Unusable } else { Outcome::Clean };
    let mut dialects = Dialects::default();
    for file in &files {
        let outcome = match Program::load(file, &call.reading, console, language) {
            Some(program) => {
                dialects.add(&program);
                one(&program, file, call.check, console)
            }
            None => Outcome::Unusable,
        };
        worst = worst.max(outcome);
    }
    program::note_dialects(&dialects, console);
    worst
}

fn one(program: &Program, file: &Path, check: bool, console: &Console) -> Outcome {
    let Some(form) = program.form else {
        console.note(&format!("{}: a binary CL file has no style; it stays as it is", program.name));
        return Outcome::Clean;
    };
    let formatting = match program.document.format(None, &Control::unlimited()) {
        Ok(formatting) => formatting,
        Err(interrupted) => {
            console.error(&format!("{}: {interrupted}", program.name));
            return Outcome::Unusable;
        }
    };
    tell_kept(program, &formatting.kept, console);
    let old = program.index.rope.to_string();
    let new = formatting.applied(&old);
    let to_standard_output = file.as_os_str() == STANDARD_INPUT;
    if check {
        return match new == old {
            true => Outcome::Clean,
            false => console.print(&format!("{}\n", program.name)).max(Outcome::Findings),
        };
    }
    let Some(bytes) = form.encode(&new) else {
        console.error(&format!("{}: the formatted text cannot be written as Latin-1", program.name));
        return Outcome::Unusable;
    };
    if to_standard_output {
        return console.write(&bytes, None);
    }
    if new == old {
        return Outcome::Clean;
    }
    match file::replace(file, &bytes) {
        Ok(()) => {
            console.note(&format!("{}: formatted", program.name));
            Outcome::Clean
        }
        Err(error) => {
            console.error(&format!("{}: {error}", program.name));
            Outcome::Unusable
        }
    }
}

/// Says which statements stay as they are, and why.
fn tell_kept(program: &Program, kept: &[(std::ops::Range<usize>, String)], console: &Console) {
    for (range, reason) in kept.iter().take(MOST_NAMED) {
        let line = program.index.position(range.start).line.saturating_add(1);
        console.note(&format!("{}:{line}: left as it is: {reason}", program.name));
    }
    if let Some(others) = kept.len().checked_sub(MOST_NAMED).filter(|others| *others > 0) {
        console.note(&format!("{}: {others} more statements are left as they are", program.name));
    }
}

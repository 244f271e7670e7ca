//! `check`: findings of files and folders.

use std::path::PathBuf;

use super::Outcome;
use super::arguments::{CheckFormat, CheckOptions};
use super::console::Console;
use super::findings::{self, Checked};
use super::program::{self, Dialects, Program};
use crate::analysis::{Language, Level};

/// Checks programs and tells the findings.
pub(super) fn check(
    paths: &[PathBuf],
    options: &CheckOptions,
    console: &Console,
    language: &dyn Language,
) -> Outcome {
    let (files, unreadable) = program::find(paths, console);
    let mut worst = if unreadable > 0 { Outcome::Unusable } else { Outcome::Clean };
    let level = if options.no_motion { Level::Section1 } else { Level::Motion };
    let mut programs = Vec::new();
    let mut dialects = Dialects::default();
    for file in &files {
        match Program::load(file, &options.reading, console, language) {
            Some(program) => {
                dialects.add(&program);
                programs.push(program);
            }
            None => worst = Outcome::Unusable,
        }
    }
    program::note_dialects(&dialects, console);
    let mut checked = Vec::new();
    for program in programs {
        let (control, bar) = console.control(&program.name);
        let diagnostics = program.document.diagnostics(level, &control);
        bar.finish_and_clear();
        match diagnostics {
            Ok(diagnostics) => checked.push(Checked { program, diagnostics }),
            Err(interrupted) => {
                console.error(&format!("{}: {interrupted}", program.name));
                worst = Outcome::Unusable;
            }
        }
    }
    let written = match options.format {
        CheckFormat::Human => findings::human::print(&checked, console),
        CheckFormat::Json => console.print(&findings::json::text(&checked)),
        CheckFormat::Sarif => findings::sarif::write(&checked, None, console, language),
        CheckFormat::Github => console.print(&findings::github::text(&checked)),
    };
    worst.max(written).max(findings::outcome(&checked, options.deny_warnings))
}

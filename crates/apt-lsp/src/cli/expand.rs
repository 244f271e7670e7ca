//! `expand`: a program with macros and loops unrolled.

use tower_lsp::ls_types::Position;

use super::Outcome;
use super::arguments::ExpandCall;
use super::console::Console;
use super::findings::{self, Checked};
use super::program::Program;
use crate::analysis::{ExpandedLine, Expansion, Language, Level};
use crate::convert::Encoding;
use crate::convert::outgoing::frame_text;

/// Column at which the origin of a line begins.
const ORIGIN_COLUMN: usize = 40;

/// Prints the expansion, the origin of each statement in a remark behind it, or before one that a remark behind would be part of: what is
/// printed runs as the program does. Mistakes, which leave statements out, are told.
pub(super) fn expand(call: &ExpandCall, console: &Console, language: &dyn Language) -> Outcome {
    let Some(mut program) = Program::read(&call.program, console, language) else { return Outcome::Unusable };
    let at = match call.at {
        None => None,
        Some(place) if place.line as usize > program.index.rope.len_lines() => {
            console.error(&format!("{}: there is no line {}", program.name, place.line));
            return Outcome::Unusable;
        }
        Some(place) => {
            // People count characters.
            program.index.encoding = Encoding::Utf32;
            Some(program.index.offset(Position { line: place.line - 1, character: place.column - 1 }))
        }
    };
    let (control, bar) = console.control(&program.name);
    let expansion = program.document.expand(at, call.depth, &control);
    let both =
        expansion.and_then(|made| Ok((made, program.document.diagnostics(Level::Section1, &control)?)));
    bar.finish_and_clear();
    let (expansion, diagnostics) = match both {
        Ok(both) => both,
        Err(interrupted) => {
            console.error(&format!("{}: {interrupted}", program.name));
            return Outcome::Unusable;
        }
    };
    let written = console.print(&with_origins(&expansion));
    // Places are told as everywhere.
    program.index.encoding = Encoding::Utf16;
    written.max(findings::tell(Checked { program, diagnostics }, call.deny_warnings, console))
}

fn with_origins(expansion: &Expansion) -> String {
    let mut text = String::new();
    let mut origins = expansion.origins.iter().peekable();
    for (number, line) in expansion.text.lines().enumerate() {
        match origins.next_if(|origin| origin.line as usize == number) {
            Some(origin) if origin.room_behind => {
                text.push_str(&format!("{line:<ORIGIN_COLUMN$} $$ {}\n", origin_text(origin)));
            }
            Some(origin) => text.push_str(&format!("$$ {}\n{line}\n", origin_text(origin))),
            None => text.push_str(&format!("{line}\n")),
        }
    }
    text
}

fn origin_text(origin: &ExpandedLine) -> String {
    let frames = origin.stack.iter().map(|frame| format!(", {}", frame_text(frame)));
    format!("statement {}{}", origin.isn, frames.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::OriginFrame;

    #[test]
    fn origins_stand_behind_their_statements_or_before_them() {
        let frame = OriginFrame { kind: "macro", name: "M".into(), isn: 9, turn: 1, range: None };
        let line =
            |line, isn, stack, room_behind| ExpandedLine { line, isn, range: 0..0, stack, room_behind };
        let expansion = Expansion {
            text: "PARTNO A PLATE\nCIRCLE/0,$\n  0,1\nGOLFT/L1\n".into(),
            origins: vec![
                line(0, 1, Vec::new(), false),
                line(1, 2, Vec::new(), false),
                line(3, 4, vec![frame], true),
            ],
        };
        let text = with_origins(&expansion);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines[..2], ["$$ statement 1", "PARTNO A PLATE"]);
        assert_eq!(lines[2..5], ["$$ statement 2", "CIRCLE/0,$", "  0,1"]);
        assert_eq!(
            lines[5],
            format!("{:<40} $$ statement 4, in the macro M called at statement 9", "GOLFT/L1")
        );
    }
}

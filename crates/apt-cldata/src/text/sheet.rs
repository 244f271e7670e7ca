//! Statements on lines: separators, continuation, remarks and free text.

use std::fmt::Write as _;

use apt_geometry::{patience::Patience, pieces::Pages};

/// Fewest columns a layout may have: a number, a comma and the continuation mark always fit.
const FEWEST_COLUMNS: usize = 40;

/// How statements stand on lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Last column that a statement may use; longer ones go on after the mark.
    pub(crate) columns: usize,
    /// Between the word and its first argument.
    pub(crate) slash: &'static str,
    /// Between two arguments.
    pub(crate) comma: &'static str,
    /// What ends a line that goes on; it begins with the comma if there is one.
    pub(crate) mark: &'static str,
    /// What stands before the rest on the next line.
    pub(crate) indent: &'static str,
}

/// A text that statements are written on.
#[derive(Debug)]
pub(crate) struct Sheet {
    layout: Layout,
    text: Pages,
    /// How many lines it has.
    lines: usize,
}

impl Sheet {
    pub(crate) fn new(layout: Layout) -> Self {
        let columns = layout.columns.max(FEWEST_COLUMNS);
        Sheet { layout: Layout { columns, ..layout }, text: Pages::default(), lines: 0 }
    }

    /// `start` is the word with what stands before it. Where `row` says so, the line is broken before that argument in any case.
    pub(crate) fn statement(&mut self, start: &str, arguments: &[String], row: Option<usize>) {
        let slash = if arguments.is_empty() { "" } else { self.layout.slash };
        self.list(format!("{start}{slash}"), arguments, row);
    }

    /// Numbers without a word.
    pub(crate) fn numbers(&mut self, arguments: &[String], row: Option<usize>) {
        self.list(String::new(), arguments, row);
    }

    fn list(&mut self, mut line: String, arguments: &[String], row: Option<usize>) {
        let Layout { columns, comma, mark, indent, .. } = self.layout;
        let ends_empty = arguments.last().is_some_and(String::is_empty);
        for (at, argument) in arguments.iter().enumerate() {
            let last = at + 1 == arguments.len();
            // A comma at the very end would only end the item before it, so that an empty last one needs its own.
            let behind = if !last {
                comma
            } else if ends_empty {
                ","
            } else {
                ""
            };
            let piece = format!("{argument}{behind}");
            // A line that goes on needs room for the mark.
            let room = if last { columns } else { columns - mark.len() };
            let full = line.chars().count() + piece.chars().count() > room;
            if at > 0 && (full || row == Some(at)) {
                self.line(&format!("{}{mark}", line.trim_end()));
                line = indent.to_owned();
            }
            line.push_str(&piece);
        }
        self.line(&line);
    }

    /// A whole line as it is; line breaks in it would make statements of its tail and become blanks.
    pub(crate) fn line(&mut self, line: &str) {
        let line: String = line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        // A text in memory takes all that is written on it.
        let _ = writeln!(self.text, "{}", line.trim_end());
        self.lines += 1;
    }

    /// How many lines it has so far.
    pub(crate) fn lines(&self) -> usize {
        self.lines
    }

    /// All that was written; less where who waits gives up before the end.
    pub(crate) fn text(self, patience: Patience<'_>) -> String {
        self.text.joined(patience)
    }
}

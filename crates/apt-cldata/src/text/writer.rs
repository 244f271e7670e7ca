//! Writes records as APT CL text.

use std::fmt::Write as _;

use apt_geometry::Vec3;

use crate::record::{ClKind, ClPoint, ClRecord, ClWord, Units};

/// How CL text is laid out.
#[derive(Debug, Clone, PartialEq)]
pub struct TextOptions {
    /// Last column that a statement may use; longer ones go on after `$`.
    pub columns: usize,
    /// Whether CIRCLE records are written before the points of a motion along a circle.
    pub arcs: bool,
    /// Fixed number of decimals, or full precision (the shortest text that reads back to the same bits).
    pub decimals: Option<usize>,
}

impl Default for TextOptions {
    fn default() -> Self {
        TextOptions { columns: 72, arcs: true, decimals: None }
    }
}

/// Longest fixed notation; longer numbers are written with an exponent.
const LONGEST_FIXED: usize = 24;
/// Smaller numbers are written with an exponent as well: their zeros would hide them.
const SMALLEST_FIXED: f64 = 1e-6;
/// Fewest columns a layout may have: a number, a comma and the continuation mark always fit.
const FEWEST_COLUMNS: usize = 40;
/// Indentation of continuation lines.
const CONTINUATION_INDENT: &str = "       ";

/// Writes records as APT CL text, one statement or position per line, deterministic.
///
/// The text reads back with [`super::read_text`] to records that say the same.
pub fn write_text(records: &[ClRecord], options: &TextOptions) -> String {
    let mut writer = Writer { options, text: String::new() };
    for (at, record) in records.iter().enumerate() {
        writer.record(record, records.get(at + 1));
    }
    writer.text
}

struct Writer<'a> {
    options: &'a TextOptions,
    text: String,
}

impl Writer<'_> {
    fn record(&mut self, record: &ClRecord, next: Option<&ClRecord>) {
        match &record.kind {
            ClKind::Text { word, text, .. } => self.free_text(word, text),
            ClKind::Postprocessor { word, arguments, .. } | ClKind::Control { word, arguments, .. } => {
                let words: Vec<String> = arguments.iter().map(|argument| self.word(argument)).collect();
                self.statement(word, &words);
            }
            ClKind::Arc { center, axis, radius, .. } => {
                // Before a single point, CIRCLE would mean an arc in the sense of the axis, which nobody promised.
                let several = next.is_some_and(
                    |record| matches!(&record.kind, ClKind::Motion { points, from: false, .. } if points.len() > 1),
                );
                if self.options.arcs && several {
                    let mut words = self.numbers(center);
                    words.extend(self.numbers(axis));
                    words.push(self.number(*radius));
                    self.statement("CIRCLE", &words);
                }
            }
            ClKind::Motion { from, points, .. } => {
                for point in points {
                    self.point(if *from { "FROM" } else { "GOTO" }, point);
                }
            }
            ClKind::MultipleAxes(on) => {
                let state = if *on { "ON" } else { "OFF" };
                self.statement("MULTAX", &[state.to_owned()]);
            }
            ClKind::Units(units) => {
                let name = match units {
                    Units::Inches => "INCHES",
                    Units::Millimeters => "MM",
                };
                self.statement("UNITS", &[name.to_owned()]);
            }
            ClKind::End => self.statement("FINI", &[]),
        }
    }

    fn point(&mut self, word: &str, point: &ClPoint) {
        let mut words = self.numbers(&point.position);
        if point.with_axis {
            words.extend(self.numbers(&point.axis));
        }
        self.statement(word, &words);
    }

    /// Free text is never continued; line breaks in it would make statements of its tail and become blanks.
    fn free_text(&mut self, word: &str, text: &str) {
        let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let text = text.trim();
        self.text.push_str(word);
        if !text.is_empty() {
            self.text.push(' ');
            self.text.push_str(text);
        }
        self.text.push('\n');
    }

    fn statement(&mut self, word: &str, arguments: &[String]) {
        let limit = self.options.columns.max(FEWEST_COLUMNS);
        let mut line = word.to_owned();
        for (at, argument) in arguments.iter().enumerate() {
            let last = at + 1 == arguments.len();
            let piece =
                format!("{}{argument}{}", if at == 0 { "/" } else { "" }, if last { "" } else { "," });
            // A line that goes on needs room for the `$`.
            let room = if last { limit } else { limit - 1 };
            if at > 0 && line.len() + piece.len() > room {
                let _ = writeln!(self.text, "{line}$");
                line = CONTINUATION_INDENT.to_owned();
            }
            line.push_str(&piece);
        }
        self.text.push_str(&line);
        self.text.push('\n');
    }

    fn word(&self, word: &ClWord) -> String {
        match word {
            ClWord::Number(number) => self.number(*number),
            ClWord::Word(word) => word.to_string(),
        }
    }

    fn numbers(&self, vector: &Vec3) -> Vec<String> {
        vector.iter().map(|value| self.number(*value)).collect()
    }

    /// A number as APT reads it: always with a decimal point (an exponent needs one), never `-0.0`.
    fn number(&self, value: f64) -> String {
        let text = match self.options.decimals {
            Some(decimals) => {
                let fixed = format!("{value:.decimals$}");
                if fixed.contains('.') || !value.is_finite() { fixed } else { format!("{fixed}.") }
            }
            None => shortest(value),
        };
        let zero = text.starts_with('-')
            && !text.bytes().any(|byte| matches!(byte, b'1'..=b'9'))
            && value.is_finite();
        if zero { text.trim_start_matches('-').to_owned() } else { text }
    }
}

fn shortest(value: f64) -> String {
    if value == 0.0 || value.abs() >= SMALLEST_FIXED {
        let fixed = format!("{value}");
        let fixed = if fixed.contains('.') || !value.is_finite() { fixed } else { format!("{fixed}.0") };
        if fixed.len() <= LONGEST_FIXED {
            return fixed;
        }
    }
    let scientific = format!("{value:E}");
    match scientific.split_once('E') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.0E{exponent}"),
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_a_point_and_no_negative_zero() {
        let cases = [
            (1.0, "1.0"),
            (-0.0, "0.0"),
            (0.1, "0.1"),
            (-12.5, "-12.5"),
            (1e-17, "1.0E-17"),
            (1.5e300, "1.5E300"),
            (3.313708498984761, "3.313708498984761"),
        ];
        for (value, text) in cases {
            assert_eq!(shortest(value).replace("-0.0", "0.0"), text, "{value}");
        }
        let options = TextOptions { decimals: Some(4), ..TextOptions::default() };
        let writer = Writer { options: &options, text: String::new() };
        assert_eq!(writer.number(-0.00001), "0.0000");
        assert_eq!(writer.number(-1.5), "-1.5000");
    }

    #[test]
    fn long_statements_are_continued_before_column_72() {
        let value = 1.0 / 3.0;
        let words: Vec<ClWord> = (0..9).map(|_| ClWord::Number(value)).collect();
        let kind = ClKind::Postprocessor { word: "CLRSRF".into(), code: Some(1057), arguments: words };
        let text = write_text(&[ClRecord { isn: 1, source: 0, kind }], &TextOptions::default());
        assert!(text.lines().count() > 1);
        assert!(text.lines().all(|line| line.len() <= 72));
        assert_eq!(text.matches('$').count(), text.lines().count() - 1);
    }
}

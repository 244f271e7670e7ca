//! What a program prints and punches: PRINT, PUNCH, TITLES and REMARK (language reference 1.5, 7.9 and 10.4).
//!
//! Every line keeps the statement that made it. Numbers stay as they are until somebody asks for [`ListingEntry::lines`].

pub mod cards;

use smol_str::{SmolStr, format_smolstr};

use crate::{record::Origin, symbols::Value};

/// How far TITLES with RIGHT moves its text, in columns (language reference 1.5).
const RIGHT_SHIFT: usize = 66;

/// Numbers on one line of a listing.
const NUMBERS_PER_LINE: usize = 7;

/// Something that a statement prints or punches.
#[derive(Debug, Clone, PartialEq)]
pub struct ListingEntry {
    /// The statement that printed it.
    pub origin: Origin,
    /// What.
    pub kind: ListingKind,
}

/// What is printed or punched.
#[derive(Debug, Clone, PartialEq)]
pub enum ListingKind {
    /// PRINT/0: a new page.
    NewPage,
    /// TITLES: a heading.
    Heading(SmolStr),
    /// REMARK.
    Remark(SmolStr),
    /// PRINT: a name with its value.
    Item {
        /// How.
        format: PrintFormat,
        /// What.
        item: PrintedItem,
    },
    /// PUNCH: a card of a dump, which READ/1 takes back.
    Card(SmolStr),
}

/// How PRINT shows a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PrintFormat {
    /// PRINT/1: the bits of the numbers, in hexadecimal.
    Hexadecimal,
    /// PRINT/2: the numbers only.
    Values,
    /// PRINT/3 and PRINT/ON: name, subscript, type, count and numbers.
    Full,
}

/// A name with its value. The values are canonical forms in the reference system in force at the PRINT.
#[derive(Debug, Clone, PartialEq)]
pub struct PrintedItem {
    /// The name; `NESTED` for a definition without one.
    pub name: SmolStr,
    /// The subscript, from 1.
    pub subscript: Option<u32>,
    /// The value; none for a name without value, which is printed with a remark.
    pub value: Option<Value>,
}

/// The name under which a definition without name is printed.
pub(crate) const NESTED: SmolStr = SmolStr::new_static("NESTED");

impl ListingKind {
    /// The heading of a TITLES statement with this text: RIGHT moves what follows to the right.
    pub(crate) fn heading(text: &str) -> ListingKind {
        // Columns 7-12 hold a blank and the word; the text begins in column 13.
        let moved = text.strip_prefix(" RIGHT").map(|rest| format_smolstr!("{:RIGHT_SHIFT$}{rest}", ""));
        ListingKind::Heading(moved.unwrap_or_else(|| SmolStr::new(text)))
    }
}

impl ListingEntry {
    /// The lines as they stand on the listing; a new page is a form feed.
    pub fn lines(&self) -> Vec<String> {
        match &self.kind {
            ListingKind::NewPage => vec!["\u{c}".to_owned()],
            ListingKind::Heading(text) | ListingKind::Remark(text) | ListingKind::Card(text) => {
                vec![text.trim_end().to_owned()]
            }
            ListingKind::Item { format, item } => item.lines(*format),
        }
    }
}

impl PrintedItem {
    /// The name with its subscript.
    pub fn full_name(&self) -> SmolStr {
        match self.subscript {
            Some(subscript) => format_smolstr!("{}({subscript})", self.name),
            None => self.name.clone(),
        }
    }

    /// The lines in a format.
    fn lines(&self, format: PrintFormat) -> Vec<String> {
        let Some(value) = &self.value else { return vec![format!("{} IS NOT DEFINED", self.full_name())] };
        let values = value.canonical_values();
        let spelled = |number: &f64| match format {
            PrintFormat::Hexadecimal => cards::hexadecimal(*number),
            PrintFormat::Values | PrintFormat::Full => format!("{:.6}", clean(*number)),
        };
        let mut lines = Vec::new();
        if format == PrintFormat::Full {
            lines.push(format!("{} {} {}", self.full_name(), value.type_word(), values.len()));
        }
        for row in values.chunks(NUMBERS_PER_LINE) {
            let numbers: Vec<String> = row.iter().map(spelled).collect();
            lines.push(format!("  {}", numbers.join(" ")));
        }
        lines
    }
}

/// A number without the sign of a zero.
fn clean(number: f64) -> f64 {
    if number == 0.0 { 0.0 } else { number }
}

impl Value {
    /// The numbers: a scalar is one.
    pub fn canonical_values(&self) -> Vec<f64> {
        match self {
            Value::Scalar(number) => vec![*number],
            Value::Geometry(geometry) => geometry.canonical_values(),
        }
    }

    /// The word of its type; SCALAR for a number.
    pub fn type_word(&self) -> &'static str {
        match self {
            Value::Scalar(_) => cards::SCALAR,
            Value::Geometry(geometry) => geometry.kind().word(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use apt_geometry::{Vec3, canonical::Geometry};
    use apt_syntax::TextRange;

    use super::*;

    fn lines(kind: ListingKind) -> Vec<String> {
        ListingEntry { origin: Origin::in_program(1, TextRange::default()), kind }.lines()
    }

    fn item(format: PrintFormat, subscript: Option<u32>, value: Option<Value>) -> Vec<String> {
        let item = PrintedItem { name: "P".into(), subscript, value };
        lines(ListingKind::Item { format, item })
    }

    #[test]
    fn values_are_printed_in_each_format() {
        let point = Value::Geometry(Arc::new(Geometry::Point(Vec3::new(1.0, -0.0, 2.5))));
        assert_eq!(
            item(PrintFormat::Full, Some(2), Some(point.clone())),
            ["P(2) POINT 3", "  1.000000 0.000000 2.500000"]
        );
        assert_eq!(item(PrintFormat::Values, None, Some(Value::Scalar(7.0))), ["  7.000000"]);
        assert_eq!(item(PrintFormat::Hexadecimal, None, Some(Value::Scalar(1.0))), ["  3FF0000000000000"]);
        assert_eq!(item(PrintFormat::Full, None, None), ["P IS NOT DEFINED"]);
    }

    #[test]
    fn headings_stand_where_the_statement_says() {
        assert_eq!(lines(ListingKind::heading(" TOP  ")), [" TOP"]);
        let right = lines(ListingKind::heading(" RIGHT SIDE"));
        assert_eq!(right, [format!("{}SIDE", " ".repeat(RIGHT_SHIFT + 1))]);
        assert_eq!(lines(ListingKind::NewPage), ["\u{c}"]);
    }
}

//! The cards of a dump: PUNCH writes them, READ/1 takes them back, bit for bit (language reference 7.9).
//!
//! A card says `NAME subscript TYPE count` (subscript 0 for none); as many numbers follow as it says, in hexadecimal,
//! four on a card; the card END ends the dump. Cards have at most 68 columns, so that they stand before the sequence
//! field.

use std::sync::Arc;

use apt_geometry::canonical::{Geometry, GeometryKind, Remembering, RuledSurface};
use smol_str::SmolStr;

use crate::symbols::Value;

/// The type word of numbers.
pub(super) const SCALAR: &str = "SCALAR";
/// The last card of a dump.
pub(crate) const END_CARD: &str = "END";
/// Numbers on a card.
const NUMBERS_PER_CARD: usize = 4;
/// Most numbers that one item may have: the largest canonical form of the language has a tenth of it.
const MOST_NUMBERS: usize = 100_000;

/// An item of a dump.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Dumped {
    /// The name.
    pub(crate) name: SmolStr,
    /// The subscript, from 1.
    pub(crate) subscript: Option<u32>,
    /// The value.
    pub(crate) value: Value,
}

/// What is wrong with the cards of a dump.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CardFault {
    /// A card is no card of a dump.
    #[error("{card} is no card of a dump")]
    Format {
        /// The card.
        card: SmolStr,
    },
    /// The cards end before the dump does.
    #[error("the cards end before the dump does")]
    Missing,
}

/// The bits of a number.
pub(super) fn hexadecimal(number: f64) -> String {
    format!("{:016X}", number.to_bits())
}

/// The cards of one item, without END.
pub(crate) fn written(item: &Dumped) -> Vec<String> {
    let values = item.value.canonical_values();
    let subscript = item.subscript.unwrap_or(0);
    let mut cards = vec![format!("{} {subscript} {} {}", item.name, item.value.type_word(), values.len())];
    for row in values.chunks(NUMBERS_PER_CARD) {
        cards.push(row.iter().map(|number| hexadecimal(*number)).collect::<Vec<_>>().join(" "));
    }
    cards
}

/// The items of a dump, up to and with its END card. `next` gives one card after the other.
///
/// # Errors
/// A card that is none, or too few of them.
pub(crate) fn read(next: &mut dyn FnMut() -> Option<String>) -> Result<Vec<Dumped>, CardFault> {
    let mut items = Vec::new();
    loop {
        let card = next().ok_or(CardFault::Missing)?;
        if card.trim().eq_ignore_ascii_case(END_CARD) {
            return Ok(items);
        }
        items.push(item(&card, next)?);
    }
}

/// The item that begins with a card.
fn item(card: &str, next: &mut dyn FnMut() -> Option<String>) -> Result<Dumped, CardFault> {
    let fault = || CardFault::Format { card: SmolStr::new(card.trim()) };
    let fields: Vec<&str> = card.split_whitespace().collect();
    let [name, subscript, type_word, count] = *fields.as_slice() else { return Err(fault()) };
    let subscript: u32 = subscript.parse().map_err(|_| fault())?;
    let count: usize = count.parse().ok().filter(|count| *count <= MOST_NUMBERS).ok_or_else(fault)?;
    let mut numbers = Vec::with_capacity(count);
    while numbers.len() < count {
        let row = next().ok_or(CardFault::Missing)?;
        let before = numbers.len();
        for word in row.split_whitespace() {
            let bits = u64::from_str_radix(word, 16).ok().filter(|_| word.len() == 16);
            numbers.push(bits.map(f64::from_bits).ok_or(CardFault::Format { card: row.trim().into() })?);
        }
        if numbers.len() == before || numbers.len() > count {
            return Err(CardFault::Format { card: row.trim().into() });
        }
    }
    let type_word = type_word.to_ascii_uppercase();
    let value = match (type_word.as_str(), numbers.as_slice()) {
        (SCALAR, [number]) => Value::Scalar(*number),
        _ => Value::Geometry(Arc::new(geometry(&type_word, &numbers).ok_or_else(fault)?)),
    };
    let name = SmolStr::new(name.to_ascii_uppercase());
    Ok(Dumped { name, subscript: (subscript > 0).then_some(subscript), value })
}

/// The geometry of a type word and its numbers.
fn geometry(type_word: &str, numbers: &[f64]) -> Option<Geometry> {
    match GeometryKind::from_word(type_word)? {
        GeometryKind::RuledSurface => ruled_surface(numbers),
        kind => Geometry::from_canonical(kind, numbers).ok(),
    }
}

/// A ruled surface: its parts one after the other, each preceded by its surface code.
fn ruled_surface(numbers: &[f64]) -> Option<Geometry> {
    let mut rest = numbers;
    let mut parts = Vec::new();
    while let [code, values @ ..] = rest {
        let kind = GeometryKind::all().find(|kind| f64::from(kind.surface_code()) == *code)?;
        let count = match kind.canonical_count() {
            Some(count) => count,
            None => tabulated_count(kind, values)?,
        };
        let (own, others) = values.split_at_checked(count)?;
        parts.push(Geometry::from_canonical(kind, own).ok()?);
        rest = others;
    }
    Some(Geometry::RuledSurface(Remembering::new(RuledSurface { parts })))
}

/// How many numbers the table of a tabulated cylinder at the head of a row has: the count of points and the nine numbers
/// of its axes, seven for each interval, two for the last point.
fn tabulated_count(kind: GeometryKind, values: &[f64]) -> Option<usize> {
    const HEAD: usize = 10;
    const INTERVAL: usize = 7;
    const LAST: usize = 2;
    let points = values.first().copied().filter(|points| *points >= 2.0 && points.fract() == 0.0)?;
    if kind != GeometryKind::TabulatedCylinder || points > values.len() as f64 {
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "whole, and at most the length"
    )]
    let intervals = points as usize - 1;
    Some(HEAD + INTERVAL * intervals + LAST)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read_back(cards: &[String]) -> Result<Vec<Dumped>, CardFault> {
        let mut cards = cards.iter().cloned();
        read(&mut || cards.next())
    }

    fn dumped(name: &str, subscript: Option<u32>, value: Value) -> Dumped {
        Dumped { name: name.into(), subscript, value }
    }

    #[test]
    fn every_type_comes_back() {
        let mut items =
            vec![dumped("A", None, Value::Scalar(-0.1)), dumped("B", Some(7), Value::Scalar(1e300))];
        for kind in GeometryKind::all() {
            let Some(count) = kind.canonical_count() else { continue };
            let numbers: Vec<f64> = (0..count).map(|index| index as f64 / 3.0).collect();
            let geometry = Geometry::from_canonical(kind, &numbers).expect("as many as the type has");
            items.push(dumped("G", None, Value::Geometry(Arc::new(geometry))));
        }
        let mut tabulated = vec![3.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        tabulated.extend((0..16).map(f64::from));
        let table = Geometry::from_canonical(GeometryKind::TabulatedCylinder, &tabulated).expect("a table");
        let point = Geometry::from_canonical(GeometryKind::Point, &[1.0, 2.0, 3.0]).expect("three numbers");
        let ruled =
            Geometry::RuledSurface(Remembering::new(RuledSurface { parts: vec![table.clone(), point] }));
        items.extend([table, ruled].map(|geometry| dumped("L", None, Value::Geometry(Arc::new(geometry)))));
        let mut cards: Vec<String> = items.iter().flat_map(written).collect();
        cards.push(END_CARD.to_owned());
        assert!(cards.iter().all(|card| card.len() <= 68), "{cards:?}");
        assert_eq!(read_back(&cards), Ok(items));
    }

    #[test]
    fn faults_of_cards_are_told() {
        let read = |text: &str| read_back(&text.lines().map(str::to_owned).collect::<Vec<_>>());
        assert_eq!(read(""), Err(CardFault::Missing));
        assert_eq!(read("A 0 SCALAR 1"), Err(CardFault::Missing));
        assert_eq!(read("A 0 SCALAR 1\n3FF0000000000000"), Err(CardFault::Missing));
        for wrong in [
            "A=3",
            "A 0 SCALAR 1\n3FF\nEND",
            "A 0 SCALAR 1\n\nEND",
            "A 0 SCALAR 1\n3FF0000000000000 3FF0000000000000\nEND",
            "A 0 SCALAR 2\n3FF0000000000000 3FF0000000000000\nEND",
            "A 0 POINT 2\n3FF0000000000000 3FF0000000000000\nEND",
            "A 0 NOSUCH 1\n3FF0000000000000\nEND",
            "A -1 SCALAR 1\n3FF0000000000000\nEND",
            "A 0 RLDSRF 1\n3FF0000000000000\nEND",
            "A 0 SCALAR 99999999999",
        ] {
            assert!(matches!(read(wrong), Err(CardFault::Format { .. })), "{wrong}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn numbers_come_back_bit_for_bit(bits in any::<u64>(), subscript in 0_u32..9) {
            let item = dumped("A", (subscript > 0).then_some(subscript), Value::Scalar(f64::from_bits(bits)));
            let mut cards = written(&item);
            cards.push(END_CARD.to_owned());
            let back = read_back(&cards).expect("the cards are whole");
            prop_assert_eq!(back.len(), 1);
            prop_assert_eq!(&back[0].name, &item.name);
            prop_assert_eq!(back[0].subscript, item.subscript);
            let [number] = back[0].value.canonical_values()[..] else { panic!("one number") };
            prop_assert_eq!(number.to_bits(), bits);
        }

        #[test]
        fn no_text_makes_it_fall_over(text in "[A-Z0-9 .\n-]{0,200}") {
            let _ = read_back(&text.lines().map(str::to_owned).collect::<Vec<_>>());
        }
    }
}

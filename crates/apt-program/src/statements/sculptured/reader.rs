//! Reads operands in order and says what is missing where they fit no form.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane, Remembering},
    motion::NamedSurface,
    parametric::{SculpturedSurface, SpaceCurve},
    regional::Sense,
};
use apt_syntax::TextRange;

use super::number;
use crate::{
    expression::{Item, Operand},
    finding::{Expected, Found},
};

/// PLUS and MINUS.
pub(super) const SENSES: &[&str] = &["PLUS", "MINUS"];

/// Why operands fit no form.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Misfit {
    /// Something else should stand here.
    Operand { expected: Expected, found: Found, number: u16, range: TextRange },
    /// The form ends before this operand.
    Surplus { found: Found, range: TextRange },
    /// A value that cannot be.
    Value { value: f64, number: Option<u16>, range: TextRange },
    /// Limits in the wrong order.
    Range { low: f64, high: f64, number: Option<u16>, range: TextRange },
}

/// What reading gives.
pub(super) type Read<T> = Result<T, Misfit>;

/// A sculptured surface or a space curve with its name.
pub(super) enum Element {
    Surface(NamedSurface),
    Curve(NamedSurface),
}

/// The operands that are left.
#[derive(Clone)]
pub(super) struct Reader<'a> {
    items: &'a [Item],
    at: usize,
    whole: TextRange,
    /// The number of what fits no form.
    pub(super) number: u16,
}

impl<'a> Reader<'a> {
    pub(super) fn new(items: &'a [Item], whole: TextRange) -> Self {
        Self { items, at: 0, whole, number: number::NO_FORM }
    }

    /// The same with another number for what fits no form from here on.
    pub(super) fn numbered(mut self, number: u16) -> Self {
        self.number = number;
        self
    }

    /// The operand that comes next.
    pub(super) fn peek(&self) -> Option<&'a Item> {
        self.items.get(self.at)
    }

    /// The word that comes next, if it is one.
    pub(super) fn peek_word(&self) -> Option<&'static str> {
        self.peek().and_then(Item::word)
    }

    /// Passes over the operand that comes next.
    pub(super) fn skip(&mut self) {
        self.at += 1;
    }

    /// Whether this word comes next; it is passed over.
    pub(super) fn eat(&mut self, word: &str) -> bool {
        let is_next = self.peek_word() == Some(word);
        self.at += usize::from(is_next);
        is_next
    }

    /// What comes next does not fit.
    pub(super) fn misfit(&self, expected: Expected) -> Misfit {
        let found = self.peek().map_or(Found::Nothing, Item::found);
        let range = self.peek().map_or(self.whole, |item| item.range);
        Misfit::Operand { expected, found, number: self.number, range }
    }

    /// The value just read cannot be.
    pub(super) fn bad_value(&self, value: f64, number: Option<u16>) -> Misfit {
        let range = self.at.checked_sub(1).and_then(|at| self.items.get(at));
        Misfit::Value { value, number, range: range.map_or(self.whole, |item| item.range) }
    }

    /// One of some words.
    pub(super) fn word(&mut self, words: &'static [&'static str]) -> Read<&'static str> {
        match self.peek_word().filter(|word| words.contains(word)) {
            Some(word) => {
                self.at += 1;
                Ok(word)
            }
            None => Err(self.misfit(Expected::Words(words))),
        }
    }

    /// PLUS or MINUS.
    pub(super) fn sense(&mut self) -> Read<Sense> {
        Ok(if self.word(SENSES)? == "PLUS" { Sense::Plus } else { Sense::Minus })
    }

    /// PLUS, MINUS, or nothing where PLUS is meant.
    pub(super) fn perhaps_sense(&mut self) -> Sense {
        if self.eat("MINUS") {
            return Sense::Minus;
        }
        self.eat("PLUS");
        Sense::Plus
    }

    /// A number.
    pub(super) fn scalar(&mut self) -> Read<f64> {
        let value = self.peek().and_then(Item::scalar).ok_or_else(|| self.misfit(Expected::Scalar))?;
        self.at += 1;
        Ok(value)
    }

    /// A number that is not negative.
    pub(super) fn not_negative(&mut self, number: Option<u16>) -> Read<f64> {
        let value = self.scalar()?;
        if value < 0.0 { Err(self.bad_value(value, number)) } else { Ok(value) }
    }

    /// Two numbers, the second not below the first.
    pub(super) fn range(&mut self, number: Option<u16>) -> Read<(f64, f64)> {
        let from = self.peek().map(|item| item.range);
        let (low, high) = (self.scalar()?, self.scalar()?);
        if low <= high {
            return Ok((low, high));
        }
        let to = self.at.checked_sub(1).and_then(|at| self.items.get(at)).map(|item| item.range);
        let range = from.zip(to).map_or(self.whole, |(from, to)| from.cover(to));
        Err(Misfit::Range { low, high, number, range })
    }

    /// A vector that is not null.
    pub(super) fn vector(&mut self, number: Option<u16>) -> Read<Vec3> {
        let vector = self.peek().and_then(Item::vector).ok_or_else(|| self.misfit(Expected::Vector))?;
        self.at += 1;
        let length = vector.norm();
        if length > 0.0 && length.is_finite() { Ok(vector) } else { Err(self.bad_value(length, number)) }
    }

    /// The plane that comes next, if it is one; it is passed over.
    pub(super) fn eat_plane(&mut self) -> Option<Plane> {
        match self.peek().and_then(Item::geometry) {
            Some(Geometry::Plane(plane)) => {
                self.at += 1;
                Some(*plane)
            }
            _ => None,
        }
    }

    /// A sculptured surface.
    pub(super) fn surface(&mut self) -> Read<NamedSurface> {
        match self.element(Expected::SculpturedSurface)? {
            Element::Surface(surface) => Ok(surface),
            Element::Curve(_) => {
                self.at -= 1;
                Err(self.misfit(Expected::SculpturedSurface))
            }
        }
    }

    /// A sculptured surface or a space curve.
    pub(super) fn element(&mut self, expected: Expected) -> Read<Element> {
        let Some(Item { operand: Operand::Geometry { name, geometry }, .. }) = self.peek() else {
            return Err(self.misfit(expected));
        };
        let named = NamedSurface { name: name.to_string(), geometry: (**geometry).clone() };
        let element = match &**geometry {
            Geometry::Sculptured(_) => Element::Surface(named),
            Geometry::SpaceCurve(_) => Element::Curve(named),
            _ => return Err(self.misfit(expected)),
        };
        self.at += 1;
        Ok(element)
    }

    /// One of some words, whose absence has a number of its own.
    pub(super) fn word_or(&mut self, words: &'static [&'static str], number: u16) -> Read<&'static str> {
        let outer = std::mem::replace(&mut self.number, number);
        let word = self.word(words);
        self.number = outer;
        word
    }

    /// A point.
    pub(super) fn point(&mut self) -> Read<Vec3> {
        let point = self.peek().and_then(Item::point).ok_or_else(|| self.misfit(Expected::Point))?;
        self.at += 1;
        Ok(point)
    }

    /// A vector, perhaps null: what that means depends on the definition.
    pub(super) fn any_vector(&mut self) -> Read<Vec3> {
        let vector = self.peek().and_then(Item::vector).ok_or_else(|| self.misfit(Expected::Vector))?;
        self.at += 1;
        Ok(vector)
    }

    /// The number that comes next, if it is one.
    pub(super) fn perhaps_scalar(&mut self) -> Option<f64> {
        let value = self.peek().and_then(Item::scalar)?;
        self.at += 1;
        Some(value)
    }

    /// A whole number that is not negative.
    pub(super) fn count(&mut self) -> Read<usize> {
        let value = self.not_negative(None)?;
        if value.fract() != 0.0 {
            return Err(self.bad_value(value, None));
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative; saturates"
        )]
        Ok(value as usize)
    }

    /// All numbers that come next.
    pub(super) fn scalars(&mut self) -> Vec<f64> {
        std::iter::from_fn(|| self.perhaps_scalar()).collect()
    }

    /// All points that come next, at least one.
    pub(super) fn points(&mut self) -> Read<Vec<Vec3>> {
        let mut points = vec![self.point()?];
        while self.peek().and_then(Item::point).is_some() {
            points.push(self.point()?);
        }
        Ok(points)
    }

    /// A space curve.
    pub(super) fn curve(&mut self) -> Read<Arc<SpaceCurve>> {
        match self.peek().and_then(Item::geometry) {
            Some(Geometry::SpaceCurve(curve)) => {
                self.at += 1;
                Ok(Arc::clone(curve))
            }
            _ => Err(self.misfit(Expected::SpaceCurve)),
        }
    }

    /// All space curves that come next, at least one.
    pub(super) fn curves(&mut self) -> Read<Vec<Arc<SpaceCurve>>> {
        let mut curves = vec![self.curve()?];
        while let Some(Geometry::SpaceCurve(_)) = self.peek().and_then(Item::geometry) {
            curves.push(self.curve()?);
        }
        Ok(curves)
    }

    /// All sculptured surfaces that come next, at least one.
    pub(super) fn sculptured_surfaces(&mut self) -> Read<Vec<Remembering<SculpturedSurface>>> {
        let mut surfaces = Vec::new();
        while let Some(Geometry::Sculptured(surface)) = self.peek().and_then(Item::geometry) {
            surfaces.push(surface.clone());
            self.at += 1;
        }
        if surfaces.is_empty() { Err(self.misfit(Expected::SculpturedSurface)) } else { Ok(surfaces) }
    }

    /// The end of the statement.
    pub(super) fn end(&self) -> Read<()> {
        match self.peek() {
            Some(item) => Err(Misfit::Surplus { found: item.found(), range: item.range }),
            None => Ok(()),
        }
    }
}

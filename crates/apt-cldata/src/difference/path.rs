//! The way of a tool as one chain of places, whatever records and vectors it was written in.

use std::borrow::Cow;

use apt_geometry::{Vec3, patience::Patience};

use crate::{
    record::{ClKind, ClRecord, ClWord, POSITIONS_A_UNIT, Units, positions},
    totals::MILLIMETERS_PER_INCH,
};

/// How a tool comes to a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Manner {
    /// FROM, and the first place of all: nothing is said of the way.
    Jump,
    /// At rapid.
    Rapid,
    /// At a feed rate.
    Feed,
}

/// One place of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Tool end, in the unit of the path.
    pub position: Vec3,
    /// Unit tool axis.
    pub axis: Vec3,
    /// How the tool comes here.
    pub manner: Manner,
    /// Index of the record that leads here.
    pub record: usize,
}

/// The way of a tool. Places at which it would stand still are left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Path {
    /// The places in order.
    pub places: Vec<Place>,
    /// The unit that the records name, if they do.
    pub units: Option<Units>,
    /// For each place the length of the way up to it, without jumps.
    lengths: Vec<f64>,
}

/// A point of a path: so far along the vector from one place to the next.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(super) struct Point {
    /// Index of the place where the vector begins.
    pub vector: usize,
    /// Fraction of the vector, from 0 to 1.
    pub fraction: f64,
}

impl Path {
    /// The path of some records. Words count only for what they say about rapid moves and units.
    pub fn of(records: &[ClRecord]) -> Self {
        Self::made(records, Patience::default())
    }

    /// The same; `None` when who waits has given up before the end.
    pub fn until(records: &[ClRecord], patience: Patience<'_>) -> Option<Self> {
        let path = Self::made(records, patience);
        (!patience.was_over()).then_some(path)
    }

    /// The path up to the end, or to where who waits gives up.
    fn made(records: &[ClRecord], patience: Patience<'_>) -> Self {
        // Lists that grow are copied as a whole, which nobody can interrupt.
        let most = positions(records, patience);
        let (places, lengths) = (Vec::with_capacity(most), Vec::with_capacity(most));
        let mut path = Self { places, lengths, units: None };
        let mut rapid = false;
        for (index, record) in records.iter().enumerate() {
            if patience.ends_after(1) {
                break;
            }
            match &record.kind {
                ClKind::Units(units) => path.units = Some(*units),
                ClKind::Postprocessor { word, arguments, .. } if word == "RAPID" => {
                    rapid = !arguments.iter().any(|word| matches!(word, ClWord::Word(off) if off == "OFF"));
                }
                ClKind::Motion { from, points, .. } => {
                    let manner = match (from, rapid) {
                        (true, _) => Manner::Jump,
                        (false, true) => Manner::Rapid,
                        (false, false) => Manner::Feed,
                    };
                    for (done, point) in points.iter().enumerate() {
                        if patience.ends_among(done, POSITIONS_A_UNIT) {
                            break;
                        }
                        let place =
                            Place { position: point.position, axis: point.axis, manner, record: index };
                        path.push(place);
                    }
                    rapid &= *from;
                }
                _ => {}
            }
        }
        path
    }

    fn push(&mut self, place: Place) {
        let Some(last) = self.places.last() else {
            self.places.push(Place { manner: Manner::Jump, ..place });
            return self.lengths.push(0.0);
        };
        if last.position == place.position && last.axis == place.axis {
            return;
        }
        let length = if place.manner == Manner::Jump { 0.0 } else { (place.position - last.position).norm() };
        self.lengths.push(self.length() + length);
        self.places.push(place);
    }

    /// The same path in another unit; as it is if one of both is not known.
    #[must_use]
    pub fn in_units(mut self, units: Option<Units>) -> Self {
        let factor = match (self.units, units) {
            (Some(Units::Inches), Some(Units::Millimeters)) => MILLIMETERS_PER_INCH,
            (Some(Units::Millimeters), Some(Units::Inches)) => MILLIMETERS_PER_INCH.recip(),
            _ => return self,
        };
        self.units = units;
        self.places.iter_mut().for_each(|place| place.position *= factor);
        self.lengths.iter_mut().for_each(|length| *length *= factor);
        self
    }

    /// The same path with vectors on which the axis turns by no more than an angle, radians: the tool turns evenly along each of those that there are.
    pub(super) fn turning_by(&self, most: f64) -> Cow<'_, Self> {
        let turn =
            |pair: &[Place]| pair[0].axis.cross(&pair[1].axis).norm().atan2(pair[0].axis.dot(&pair[1].axis));
        if self.places.windows(2).all(|pair| turn(pair) <= most) {
            return Cow::Borrowed(self);
        }
        let mut turning = Self { units: self.units, ..Self::default() };
        for (at, place) in self.places.iter().enumerate() {
            if let Some(before) = at.checked_sub(1).map(|before| self.places[before]) {
                let angle = turn(&[before, *place]);
                let steps = if angle > most { (angle / most).ceil().min(MOST_STEPS) } else { 1.0 };
                for step in 1..steps as u32 {
                    let part = f64::from(step) / steps;
                    let position = before.position + (place.position - before.position) * part;
                    let axis = turned(&before.axis, &place.axis, angle, part);
                    turning.push(Place { position, axis, ..*place });
                }
            }
            turning.push(*place);
        }
        Cow::Owned(turning)
    }

    /// Length of the whole way, without jumps.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or_default()
    }

    /// Whether its places are near enough to each other, and to the origin, that distances between them are numbers.
    pub fn is_measurable(&self) -> bool {
        self.length().is_finite()
            && self.places.iter().all(|place| (place.position * 4.0).norm_squared().is_finite())
    }

    /// Number of vectors between places.
    pub fn vectors(&self) -> usize {
        self.places.len().saturating_sub(1)
    }

    /// Least and greatest coordinates; `None` without places.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let first = self.places.first()?.position;
        let widen =
            |[low, high]: [Vec3; 2], place: &Place| [low.inf(&place.position), high.sup(&place.position)];
        Some(self.places.iter().fold([first, first], widen))
    }

    /// How the tool goes along a vector.
    pub(super) fn manner(&self, vector: usize) -> Manner {
        self.places[vector + 1].manner
    }

    /// Tool end and axis at a point; the axis as it turns evenly between the places, not of unit length.
    pub(super) fn at(&self, point: Point) -> [Vec3; 2] {
        let here = &self.places[point.vector];
        let Some(next) = self.places.get(point.vector + 1) else { return [here.position, here.axis] };
        let between = |from: &Vec3, to: &Vec3| from + (to - from) * point.fraction;
        [between(&here.position, &next.position), between(&here.axis, &next.axis)]
    }

    /// Length of the way from the beginning to a point.
    pub(super) fn along(&self, point: Point) -> f64 {
        let from = self.lengths[point.vector];
        let to = self.lengths.get(point.vector + 1).copied().unwrap_or(from);
        from + (to - from) * point.fraction
    }

    /// A place as a point.
    pub(super) fn place(&self, index: usize) -> Point {
        match index < self.vectors() || index == 0 {
            true => Point { vector: index, fraction: 0.0 },
            false => Point { vector: index - 1, fraction: 1.0 },
        }
    }

    /// The last point.
    pub(super) fn end(&self) -> Point {
        self.place(self.vectors())
    }

    /// The chain of points from one to another, both among them.
    pub(super) fn stretch(&self, from: Point, to: Point) -> Vec<[Vec3; 2]> {
        let between = self.places.iter().take(to.vector + 1).skip(from.vector + 1);
        let mut chain = vec![self.at(from)];
        chain.extend(between.map(|place| [place.position, place.axis]));
        chain.push(self.at(to));
        chain
    }

    /// The record that leads on from a point, or to the last one.
    pub(super) fn record_after(&self, point: Point) -> usize {
        let next = point.vector + 1 + usize::from(point.fraction >= 1.0);
        self.places[next.min(self.places.len() - 1)].record
    }

    /// The record that leads to a point.
    pub(super) fn record_before(&self, point: Point) -> usize {
        self.places[(point.vector + usize::from(point.fraction > 0.0)).min(self.places.len() - 1)].record
    }
}

/// Steps that a vector on which the axis turns is divided into at most.
const MOST_STEPS: f64 = 10_000.0;

/// The axis that is turned evenly from one unit vector to another by part of the angle between them. Where they are opposite nothing says by
/// which way, and it stays until half way.
fn turned(from: &Vec3, to: &Vec3, angle: f64, part: f64) -> Vec3 {
    let sine = angle.sin();
    if sine.abs() < f64::EPSILON {
        return if part < 0.5 { *from } else { *to };
    }
    (from * ((1.0 - part) * angle).sin() + to * (part * angle).sin()) / sine
}

//! Polyconic surfaces as strips: cubics in place of the conics, straight from station to station (language reference 4.15).
//!
//! The places and the natural normal come from the control functions themselves; the strips serve to find the nearest
//! place. How far they are off is measured between the places they go through and counted as an error of every distance.

use std::{cmp::Ordering, collections::BinaryHeap};

use apt_geometry::{
    Vec3,
    canonical::{
        PolyConicForm,
        extent::{GREATEST_FULLNESS, LEAST_FULLNESS, POLYCONIC_ENDS_BEYOND, POLYCONIC_STATIONS_BEYOND},
    },
};

use super::{
    ruled::through,
    strip::{Cubic, Strip, Touch, lerp, place},
};

/// How far a strip may be off, relative to the size of the surface.
const ACCURACY: f64 = 1e-8;
/// How much farther off it may be than at the places looked at, which lie near its worst ones.
const ALLOWANCE: f64 = 2.0;
/// Bound of the number of strips; where more were needed they are as accurate as so many can be.
const STRIPS: usize = 4096;
/// Share of the way to the middle at which the normal is taken where a place has none.
const INWARD: f64 = 1e-5;
/// Sine of the angle between both directions on the surface, and length relative to its size, that is rounding.
const SINGULAR: f64 = 1e-11;

/// Ranges of both parameters: along the conic, from conic to conic.
type Rectangle = [[f64; 2]; 2];

/// A polyconic surface.
#[derive(Debug, Clone)]
pub(super) struct ConicStrips {
    conics: Conics,
    pub(super) strips: Vec<Strip>,
    /// The part of the surface that each strip replaces.
    ranges: Vec<Rectangle>,
    /// Greatest distance from the origin between the ends of the conics and stations 0 and 1.
    pub(super) size: f64,
    /// How far a place of a strip may be off the surface.
    pub(super) error: f64,
}

/// The surface by its parameters: `t` from 0 to 1 along the conic, straight beyond; `s` is the station, or with square
/// roots the signed root of the station.
#[derive(Debug, Clone)]
struct Conics {
    form: PolyConicForm,
}

/// A place with its derivatives by both parameters, in the coordinates of the surface.
struct Jet {
    point: Vec3,
    along: Vec3,
    across: Vec3,
}

/// A number or a vector with its derivative by `s`.
type Rate<T> = [T; 2];

fn sum(a: Rate<f64>, b: Rate<f64>) -> Rate<f64> {
    [a[0] + b[0], a[1] + b[1]]
}

impl Conics {
    /// A control function: A, B, C, D, L, H, P in this order.
    fn control(&self, function: usize, s: f64) -> Rate<f64> {
        let polynomial = self.form.polynomials.get(function).copied().unwrap_or_default();
        let by_station = |d: f64| -> Rate<f64> {
            polynomial.iter().rev().fold([0.0; 2], |[value, rate], k| [value * d + k, rate * d + value])
        };
        match self.form.roots {
            None => by_station(s),
            Some(roots) => {
                let root = roots.get(function).copied().unwrap_or(0.0);
                let [value, rate] = by_station(s * s);
                [value + root * s, 2.0 * s * rate + root]
            }
        }
    }

    /// Weight of the point where the end tangents meet.
    fn weight(&self, s: f64) -> Rate<f64> {
        let [fullness, rate] = self.control(6, s);
        let held = fullness.clamp(LEAST_FULLNESS, GREATEST_FULLNESS);
        let rate = if held == fullness { rate } else { 0.0 };
        let rest = 1.0 - held;
        [(held - 0.5) / rest, 0.5 * rate / (rest * rest)]
    }

    fn jet(&self, t: f64, s: f64) -> Jet {
        let [a, b, c, d, l, h] = std::array::from_fn(|k| self.control(k, s));
        let station = match self.form.roots {
            None => [s, 1.0],
            Some(_) => [s * s, 2.0 * s],
        };
        let x = [self.form.base + self.form.length * station[0], self.form.length * station[1]];
        let lift = |y: Rate<f64>, z: Rate<f64>| -> Rate<Vec3> {
            [Vec3::new(x[0], y[0], z[0]), Vec3::new(x[1], y[1], z[1])]
        };
        let start = lift(l, h);
        let (y, z) = (sum(l, c), sum(h, b));
        let meet = lift(y, z);
        let end = lift(sum(y, a), sum(z, d));
        let straight = |from: Rate<Vec3>, share: f64, sense: f64| {
            let way = [0, 1].map(|k| (meet[k] - from[k]) * POLYCONIC_ENDS_BEYOND);
            Jet { point: from[0] + way[0] * share, along: way[0] * sense, across: from[1] + way[1] * share }
        };
        if t < 0.0 {
            return straight(start, t, 1.0);
        }
        if t > 1.0 {
            return straight(end, 1.0 - t, -1.0);
        }
        let [w, dw] = self.weight(s);
        let r = 1.0 - t;
        let below = r * r + 2.0 * w * t * r + t * t;
        let point = (start[0] * (r * r) + meet[0] * (2.0 * w * t * r) + end[0] * (t * t)) / below;
        let along = (meet[0] * w - start[0]) * (2.0 * r) + (end[0] - meet[0] * w) * (2.0 * t)
            - point * ((w - 1.0) * 2.0 * r + (1.0 - w) * 2.0 * t);
        let across =
            start[1] * (r * r) + (meet[1] * w + (meet[0] - point) * dw) * (2.0 * t * r) + end[1] * (t * t);
        Jet { point, along: along / below, across: across / below }
    }

    /// The natural normal in the coordinates of the surface: along the conic × along growing stations.
    fn normal(&self, t: f64, s: f64, size: f64) -> Option<Vec3> {
        let jet = self.jet(t, s);
        let (along, across) = (jet.along.norm(), jet.across.norm());
        if along.min(across) <= SINGULAR * size {
            return None;
        }
        let normal = jet.along.cross(&jet.across) / (along * across);
        let sine = normal.norm();
        // Before station 0 the signed root grows while the station falls.
        let sense = if self.form.roots.is_some() && s < 0.0 { -1.0 } else { 1.0 };
        (sine > SINGULAR).then(|| normal * (sense / sine))
    }

    /// The same, from beside where the surface has none.
    fn sure_normal(&self, t: f64, s: f64, size: f64) -> Option<Vec3> {
        let toward = |x: f64| x + INWARD * (0.5 - x);
        self.normal(t, s, size).or_else(|| self.normal(toward(t), toward(s), size))
    }

    /// A place of the surface, off the conics by its thickness, in program coordinates.
    fn at(&self, t: f64, s: f64, size: f64) -> Option<Vec3> {
        let mut point = self.jet(t, s).point;
        if self.form.thickness != 0.0 {
            point += self.sure_normal(t, s, size)? * self.form.thickness;
        }
        let map = &self.form.map;
        let found = map.linear().tr_mul(&(point - map.shift()));
        found.iter().all(|x| x.is_finite()).then_some(found)
    }

    fn stations(&self) -> [f64; 4] {
        match self.form.roots {
            None => [-POLYCONIC_STATIONS_BEYOND, 0.0, 1.0, 1.0 + POLYCONIC_STATIONS_BEYOND],
            Some(_) => {
                let last = (1.0 + POLYCONIC_STATIONS_BEYOND).sqrt();
                [-last, 0.0, 1.0, last]
            }
        }
    }
}

/// A strip in place of a part of the surface, and how far it is off: along the cubics, and between them.
struct Fit {
    edges: [Cubic; 2],
    errors: [f64; 2],
}

fn inside([low, high]: [f64; 2], share: f64) -> f64 {
    low + (high - low) * share
}

fn fit(conics: &Conics, [along, across]: &Rectangle, size: f64) -> Option<Fit> {
    let at = |t: f64, s: f64| conics.at(inside(*along, t), inside(*across, s), size);
    let mut errors = [0.0f64; 2];
    let mut edges = [[Vec3::zeros(); 4]; 2];
    for (edge, s) in edges.iter_mut().zip([0.0, 1.0]) {
        *edge = through(&[at(0.0, s)?, at(1.0 / 3.0, s)?, at(2.0 / 3.0, s)?, at(1.0, s)?]);
        for t in [0.127, 0.5, 0.873] {
            errors[0] = errors[0].max((at(t, s)? - place(edge, t)).norm());
        }
    }
    for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let (first, last) = (at(t, 0.0)?, at(t, 1.0)?);
        for s in [0.25, 0.5, 0.75] {
            errors[1] = errors[1].max((at(t, s)? - lerp(&first, &last, s)).norm());
        }
    }
    errors.iter().all(|e| e.is_finite()).then_some(Fit { edges, errors })
}

/// A part of the surface with its strip, in the order of how far the strip is off; among equals the earlier first.
struct Part {
    rectangle: Rectangle,
    fit: Fit,
    off: f64,
    number: usize,
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.off.total_cmp(&other.off).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

/// The whole surface in strips that are off by `accuracy`, or by more where that would take too many.
fn cover(conics: &Conics, size: f64, accuracy: f64) -> Option<BinaryHeap<Part>> {
    let mut number = 0;
    let mut part = |rectangle: Rectangle| -> Option<Part> {
        let fit = fit(conics, &rectangle, size)?;
        let off = ALLOWANCE * (fit.errors[0] + fit.errors[1]);
        number += 1;
        Some(Part { rectangle, fit, off, number })
    };
    let mut parts = BinaryHeap::with_capacity(STRIPS);
    for across in conics.stations().windows(2) {
        for along in [[-1.0, 0.0], [0.0, 0.5], [0.5, 1.0], [1.0, 2.0]] {
            parts.push(part([along, [across[0], across[1]]])?);
        }
    }
    while parts.len() < STRIPS && parts.peek().is_some_and(|worst| worst.off > accuracy) {
        let Some(Part { rectangle: [along, across], fit, .. }) = parts.pop() else { break };
        let halves = |range: [f64; 2]| [[range[0], inside(range, 0.5)], [inside(range, 0.5), range[1]]];
        let halved = if fit.errors[0] > fit.errors[1] {
            halves(along).map(|half| [half, across])
        } else {
            halves(across).map(|half| [along, half])
        };
        for rectangle in halved {
            parts.push(part(rectangle)?);
        }
    }
    Some(parts)
}

impl ConicStrips {
    /// None if the values describe no surface.
    pub(super) fn of(values: &[f64]) -> Option<Self> {
        let conics = Conics { form: PolyConicForm::read(values)? };
        let mut size: f64 = 0.0;
        let mut extent: f64 = 0.0;
        let shift = conics.form.map.shift();
        let middle = conics.jet(0.5, 0.5).point;
        for i in 0..=8 {
            for k in 0..=8 {
                let point = conics.jet(f64::from(i) / 8.0, f64::from(k) / 8.0).point;
                size = size.max((point - shift).norm());
                extent = extent.max((point - middle).norm());
            }
        }
        size += conics.form.thickness.abs();
        if !(extent > 0.0 && size.is_finite()) {
            return None;
        }
        let mut parts = cover(&conics, extent, ACCURACY * extent)?.into_vec();
        parts.sort_by_key(|part| part.number);
        let error = parts.iter().map(|part| part.off).fold(0.0, f64::max);
        let ranges = parts.iter().map(|part| part.rectangle).collect();
        let strips = parts.iter().enumerate().map(|(k, part)| Strip::new(part.fit.edges, k)).collect();
        Some(Self { conics, strips, ranges, size, error })
    }

    /// The natural normal of the surface itself at a place of a strip.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        let [along, across] = self.ranges.get(touch.piece)?;
        let (t, s) = (inside(*along, touch.along), inside(*across, touch.across));
        let normal = self.conics.sure_normal(t, s, self.size)?;
        Some(self.conics.form.map.linear().tr_mul(&normal))
    }
}

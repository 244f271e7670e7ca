//! Polyconic surfaces as patches: cubics in place of the conics, and of their way from station to station (language
//! reference 4.15).
//!
//! The places and the natural normal come from the control functions themselves; the patches serve to find the nearest
//! place. How far they are off is measured between the places they go through and counted as an error of every distance.

use std::{cmp::Ordering, collections::BinaryHeap, sync::Arc};

use apt_geometry::{
    Vec3,
    canonical::{
        Made, PolyConicForm, Remembering,
        extent::{GREATEST_FULLNESS, LEAST_FULLNESS, POLYCONIC_ENDS_BEYOND, POLYCONIC_STATIONS_BEYOND},
    },
    patience::Patience,
};

use super::{
    models::{Models, WORK_OF_PATCH},
    patch::{Edges, Net, Patch, extent, jet, place_on, turned},
    ruled::{ERROR_BEND, divided, parts_for, through},
    strip::Touch,
    survey::Sheet,
};

/// How far a patch may be off, relative to the size of the surface, if that must be little and if nothing is asked.
const FINEST: f64 = 4e-10;
const COARSEST: f64 = 1e-7;
/// How much farther off it may be than at the places looked at, which lie near its worst ones.
const ALLOWANCE: f64 = 2.0;
/// Bound of the number of patches; where more were needed they are as accurate as so many can be.
const PATCHES: usize = 4096;
/// Sine of the angle between the normals of surface and patch above which the surface has an edge there.
const EDGE: f64 = 1e-4;
/// Share of the way to the middle at which the normal is taken where a place has none.
const INWARD: f64 = 1e-5;
/// Sine of the angle between both directions on the surface, and length relative to its size, that is rounding.
const SINGULAR: f64 = 1e-11;

/// Parameter of a patch next to its side at which a place is there.
const AT_SIDE: f64 = 1e-7;

/// Ranges of both parameters: along the conic, from conic to conic.
type Rectangle = [[f64; 2]; 2];

/// A polyconic surface.
#[derive(Debug, Clone)]
pub(super) struct ConicStrips {
    form: Arc<Form>,
    pub(super) sheet: Sheet,
    /// The part of the surface that each patch replaces.
    ranges: Arc<[Rectangle]>,
    /// Greatest distance from the origin between the ends of the conics and stations 0 and 1.
    pub(super) size: f64,
    /// How far a place of a patch may be off the surface.
    pub(super) error: f64,
}

/// The surface itself with its size, and the models made from it.
#[derive(Debug)]
struct Form {
    conics: Conics,
    /// Greatest distance from the origin, and from the middle of the surface.
    size: f64,
    extent: f64,
    models: Models<Model>,
}

/// What is the same for all motions.
#[derive(Debug)]
struct Model {
    patches: Arc<[Patch]>,
    ranges: Arc<[Rectangle]>,
    error: f64,
}

impl Made for Form {
    fn parts(&self) -> usize {
        self.models.sum(|model| model.patches.len())
    }
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

/// A conic by the ends of its curved part, the point where its tangents there meet and the weight of that.
struct Station {
    start: Rate<Vec3>,
    meet: Rate<Vec3>,
    end: Rate<Vec3>,
    weight: Rate<f64>,
}

impl Station {
    /// How much of the curve's start, of the meeting point and of its end makes a place between the ends, and their sum.
    fn shares(&self, t: f64) -> ([f64; 3], f64) {
        let r = 1.0 - t;
        let shares = [r * r, 2.0 * self.weight[0] * t * r, t * t];
        (shares, shares[0] + shares[1] + shares[2])
    }

    fn point(&self, t: f64) -> Vec3 {
        if !(0.0..=1.0).contains(&t) {
            return self.jet(t).point;
        }
        let ([first, middle, last], sum) = self.shares(t);
        (self.start[0] * first + self.meet[0] * middle + self.end[0] * last) / sum
    }

    fn jet(&self, t: f64) -> Jet {
        let Self { start, meet, end, weight: [w, dw] } = self;
        let straight = |from: &Rate<Vec3>, share: f64, sense: f64| {
            let way = [0, 1].map(|k| (meet[k] - from[k]) * POLYCONIC_ENDS_BEYOND);
            Jet { point: from[0] + way[0] * share, along: way[0] * sense, across: from[1] + way[1] * share }
        };
        if t < 0.0 {
            return straight(start, t, 1.0);
        }
        if t > 1.0 {
            return straight(end, 1.0 - t, -1.0);
        }
        let r = 1.0 - t;
        let (_, below) = self.shares(t);
        let point = self.point(t);
        let along = (meet[0] * *w - start[0]) * (2.0 * r) + (end[0] - meet[0] * *w) * (2.0 * t)
            - point * ((w - 1.0) * 2.0 * r + (1.0 - w) * 2.0 * t);
        let across =
            start[1] * (r * r) + (meet[1] * *w + (meet[0] - point) * *dw) * (2.0 * t * r) + end[1] * (t * t);
        Jet { point, along: along / below, across: across / below }
    }
}

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

    fn station(&self, s: f64) -> Station {
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
        Station { start, meet, end, weight: self.weight(s) }
    }

    fn jet(&self, t: f64, s: f64) -> Jet {
        self.station(s).jet(t)
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

    /// A place of the surface at a station, off the conics by its thickness, in program coordinates.
    fn at(&self, t: f64, (s, station): (f64, &Station), size: f64) -> Option<Vec3> {
        let mut point = station.point(t);
        if self.form.thickness != 0.0 {
            point += self.sure_normal(t, s, size)? * self.form.thickness;
        }
        let map = &self.form.map;
        let found = map.linear().tr_mul(&(point - map.shift()));
        found.iter().all(|x| x.is_finite()).then_some(found)
    }

    /// The patch of a part with what is known of it.
    fn patch(&self, part: &Part, size: f64) -> Patch {
        let mut patch = Patch::new(part.fit.net);
        let [along, across] = part.rectangle;
        let stations = self.stations();
        let sides = [along[0] <= -1.0, along[1] >= 2.0, across[0] <= stations[0], across[1] >= stations[3]];
        let normals = |at: [f64; 2]| {
            let [_, run, rise] = jet(&patch.net, at);
            let natural = self.normal(inside(along, at[0]), inside(across, at[1]), size)?;
            Some((run.cross(&rise).try_normalize(0.0)?, self.form.map.linear().tr_mul(&natural)))
        };
        let against = normals([0.5; 2]).is_some_and(|(own, natural)| own.dot(&natural) < 0.0);
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.5]];
        let is_edged = corners.into_iter().any(|at| {
            normals(at).is_none_or(|(own, natural)| {
                own.cross(&natural).norm() > EDGE || (own.dot(&natural) < 0.0) != against
            })
        });
        patch.against = against;
        patch.edges = Edges { sides, within: is_edged };
        let shortest = extent(&patch.net).into_iter().fold(f64::INFINITY, f64::min);
        patch.slack = ERROR_BEND * part.off / (shortest * shortest);
        patch
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

/// A patch in place of a part of the surface, and how far it is off: along the conics, and across.
struct Fit {
    net: Net,
    errors: [f64; 2],
}

fn inside([low, high]: [f64; 2], share: f64) -> f64 {
    low + (high - low) * share
}

fn fit(conics: &Conics, [along, across]: &Rectangle, size: f64) -> Option<Fit> {
    let thirds = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let between = [0.127, 0.5, 0.873];
    let station = |share: f64| {
        let s = inside(*across, share);
        (share, s, conics.station(s))
    };
    let (nodes, others) = (thirds.map(station), between.map(station));
    let at =
        |t: f64, (_, s, station): &(f64, f64, Station)| conics.at(inside(*along, t), (*s, station), size);
    let mut rows = [[Vec3::zeros(); 4]; 4];
    for (row, s) in rows.iter_mut().zip(&nodes) {
        *row = through(&[at(thirds[0], s)?, at(thirds[1], s)?, at(thirds[2], s)?, at(thirds[3], s)?]);
    }
    let net = turned(&turned(&rows).map(|column| through(&column)));
    let off = |t: f64, s: &(f64, f64, Station)| Some((at(t, s)? - place_on(&net, [t, s.0])).norm());
    let mut errors = [off(0.5, &others[1])?; 2];
    for (share, other) in between.iter().zip(&others) {
        for (node, at_node) in [(thirds[0], &nodes[0]), (thirds[2], &nodes[2])] {
            errors[0] = errors[0].max(off(*share, at_node)?);
            errors[1] = errors[1].max(off(1.0 - node, other)?);
        }
    }
    errors.iter().all(|e| e.is_finite()).then_some(Fit { net, errors })
}

/// A part of the surface with its patch, in the order of how far the patch is off; among equals the earlier first.
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

/// The whole surface in patches that are off by `accuracy`, or by more where that would take too many; none once `patience` is over.
fn cover(conics: &Conics, size: f64, accuracy: f64, patience: Patience<'_>) -> Option<BinaryHeap<Part>> {
    let mut number = 0;
    let mut part = |rectangle: Rectangle| -> Option<Part> {
        if patience.ends_after(WORK_OF_PATCH) {
            return None;
        }
        let fit = fit(conics, &rectangle, size)?;
        let off = ALLOWANCE * (fit.errors[0] + fit.errors[1]);
        number += 1;
        Some(Part { rectangle, fit, off, number })
    };
    let mut parts = BinaryHeap::with_capacity(PATCHES);
    for across in conics.stations().windows(2) {
        for along in [[-1.0, 0.0], [0.0, 0.5], [0.5, 1.0], [1.0, 2.0]] {
            parts.push(part([along, [across[0], across[1]]])?);
        }
    }
    while parts.len() < PATCHES && parts.peek().is_some_and(|worst| worst.off > accuracy) {
        let Some(Part { rectangle, fit, .. }) = parts.pop() else { break };
        let way = usize::from(fit.errors[0] <= fit.errors[1]);
        // What the other direction leaves, at least half.
        let left = (accuracy / ALLOWANCE - fit.errors[1 - way]).max(0.5 * accuracy / ALLOWANCE);
        let count = parts_for(left, fit.errors[way]);
        for range in divided(rectangle[way], count) {
            let mut rectangle = rectangle;
            rectangle[way] = range;
            parts.push(part(rectangle)?);
        }
    }
    Some(parts)
}

impl Form {
    /// None if the values describe no surface.
    fn of(values: &[f64]) -> Option<Self> {
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
        (extent > 0.0 && size.is_finite()).then(|| Self { conics, size, extent, models: Models::default() })
    }

    fn model(&self, accuracy: f64, patience: Patience<'_>) -> Option<Model> {
        let mut parts = cover(&self.conics, self.extent, accuracy, patience)?.into_vec();
        parts.sort_by_key(|part| part.number);
        let error = parts.iter().map(|part| part.off).fold(0.0, f64::max);
        let ranges = parts.iter().map(|part| part.rectangle).collect();
        let patches = parts.iter().map(|part| self.conics.patch(part, self.extent)).collect();
        Some(Model { patches, ranges, error })
    }
}

impl ConicStrips {
    /// The model of a surface that need not be closer to it than `accuracy`; none if the values describe no surface, and once
    /// `patience` is over.
    pub(super) fn of(values: &Remembering<Vec<f64>>, accuracy: f64, patience: Patience<'_>) -> Option<Self> {
        let form = values.made(|values| Form::of(values))?;
        let accuracy = accuracy.clamp(FINEST * form.extent, COARSEST * form.extent);
        let model = form.models.within(accuracy, |accuracy| form.model(accuracy, patience))?;
        let (patches, ranges, error) = (Arc::clone(&model.patches), Arc::clone(&model.ranges), model.error);
        let size = form.size;
        Some(Self { sheet: Sheet::new(patches, false), ranges, size, error, form })
    }

    /// The natural normal of the surface itself at a place of a patch.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        let [along, across] = self.ranges.get(touch.piece)?;
        let (t, s) = (inside(*along, touch.along), inside(*across, touch.across));
        let conics = &self.form.conics;
        let normal = conics.sure_normal(t, s, self.size)?;
        Some(conics.form.map.linear().tr_mul(&normal))
    }

    /// Whether a place is where the surface ends.
    pub(super) fn ends_at(&self, touch: &Touch) -> bool {
        let Touch { along, across, .. } = *touch;
        let at = [along <= AT_SIDE, along >= 1.0 - AT_SIDE, across <= AT_SIDE, across >= 1.0 - AT_SIDE];
        at.into_iter().zip(self.ends(touch.piece)).any(|(is_there, is_end)| is_there && is_end)
    }

    /// At which of its sides the surface ends on a patch.
    pub(super) fn ends(&self, piece: usize) -> [bool; 4] {
        self.sheet.patches.get(piece).map_or([false; 4], |patch| patch.edges.sides)
    }
}

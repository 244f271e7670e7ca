//! Ruled surfaces as patches: straight rulings between points at equal shares of two chords (language reference 4.16).
//!
//! Between the ends of the chords the parameter is the angle of an arc that is as steep over the chord there as the sections: so one
//! that starts upright, like a half circle, is smooth in it, and it spreads evenly up to the ends of others. Cubics through four places of each piece replace the curves; how far they are off
//! is measured between those places and counted as an error of every distance.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{
        Made, Remembering, RuledCurve, RuledEnd, RuledSurface,
        extent::{RULED_BEYOND, RULED_STEADY, ruled_shares},
    },
    patience::Patience,
};

use super::{
    models::{Models, WORK_OF_PATCH},
    patch::{Patch, jet},
    section::Section,
    strip::{Cubic, Touch, lerp, place},
    survey::Sheet,
};

/// Shares of a chord that are one.
const SAME_SHARE: f64 = 1e-9;
/// Angle, radians, below which an arc is as good as its chord.
const LEAST_ANGLE: f64 = 1e-3;
/// How far a cubic may be off, relative to the size of the surface, if that must be little and if nothing is asked.
const FINEST: f64 = 1e-10;
const COARSEST: f64 = 1e-7;
/// How much farther off it may be than at the places looked at, which lie near its worst ones.
const ALLOWANCE: f64 = 2.0;
/// Bounds of how often a piece is divided, in how many at once, and of the number of pieces.
const DIVISIONS: u32 = 16;
const GREATEST_DIVISION: u32 = 8;
const PIECES: usize = 4096;
/// Parameter next to the end of a piece that counts as the joint with its neighbour.
const JOINT: f64 = 1e-7;
/// Share of what a tangent is in the middle of a patch below which it has no direction but rounding.
const NO_LENGTH: f64 = 1e-9;
/// How far inside of a place where one has none the normal is taken, as a share of the way to the middle: that of an apex is the same all along a
/// ruling, and beside a corner in which the curves meet it is off by a turn as small as this.
const INSIDE: f64 = 1e-6;
/// Sine of the angle between the normals of neighbours above which the joint is an edge of the surface.
const EDGE: f64 = 1e-5;
/// What the second derivative of a cubic's error is at most, times that error, where it is the error of a cubic through
/// four places of a curve whose fourth derivative is steady.
pub(super) const ERROR_BEND: f64 = 200.0;
/// What its first derivative at an end is at most, times that error.
const ERROR_SLOPE: f64 = 10.0;

/// The parameter between the ends of the chords: an angle from the one of these, below the middle of an arc, to the other above it.
#[derive(Debug, Clone, Copy)]
struct Angular([f64; 2]);

impl Angular {
    /// The angles of an arc over the chord that has the slopes, in chords, at its ends.
    fn of(slopes: [f64; 2]) -> Self {
        Self(slopes.map(|slope| slope.atan().max(LEAST_ANGLE)))
    }

    /// The share of the chord at a parameter from 0 to 1.
    fn share(self, w: f64) -> f64 {
        let [before, after] = self.0;
        ((w * (before + after) - before).sin() + before.sin()) / (before.sin() + after.sin())
    }

    /// The parameter at a share.
    fn parameter(self, share: f64) -> f64 {
        let [before, after] = self.0;
        let sine = share.clamp(0.0, 1.0) * (before.sin() + after.sin()) - before.sin();
        (sine.clamp(-1.0, 1.0).asin() + before) / (before + after)
    }
}

/// A ruled surface.
#[derive(Debug, Clone)]
pub(super) struct RuledStrips {
    /// In the order of the share of the chord.
    pub(super) sheet: Sheet,
    /// Greatest distance from the origin of the surface between its curves.
    pub(super) size: f64,
    /// How far a place of a strip may be off the surface between the curves, and anywhere.
    pub(super) error: f64,
    pub(super) greatest_error: f64,
}

/// The curves of a surface and the models made from them.
struct Curves {
    edges: [Edge; 2],
    scale: f64,
    models: Models<Model>,
}

/// What is the same for all motions.
#[derive(Debug)]
struct Model {
    patches: Arc<[Patch]>,
    size: f64,
    error: f64,
    greatest_error: f64,
}

impl Made for Curves {
    fn parts(&self) -> usize {
        self.models.sum(|model| model.patches.len())
    }
}

/// A curve or the point that all rulings meet in.
enum Edge {
    Curve(Box<Section>),
    Apex(Vec3),
}

impl Edge {
    fn of(curve: &RuledCurve<'_>) -> Option<Self> {
        Section::of(curve).map(|s| Self::Curve(Box::new(s)))
    }

    /// How steep it is over its chord at the end with a share, in chords.
    fn steepness(&self, end: f64) -> f64 {
        match self {
            Self::Curve(section) => section.steepness(end),
            Self::Apex(_) => 0.0,
        }
    }

    fn at(&self, share: f64) -> Option<Vec3> {
        match self {
            Self::Curve(section) => section.at(share),
            Self::Apex(point) => Some(*point),
        }
    }

    /// How it runs on from a share, per share.
    fn run(&self, share: f64) -> Option<Vec3> {
        match self {
            Self::Curve(section) => section.run(share),
            Self::Apex(_) => Some(Vec3::zeros()),
        }
    }
}

/// A piece of both curves.
struct Piece {
    curves: [Cubic; 2],
    error: f64,
    /// Whether it lies between the ends of the chords, away from them.
    inner: bool,
    /// Whether a curve may bend sharply where it begins.
    is_sharp: bool,
}

/// The cubic through the places at 0, ⅓, ⅔ and 1, by control points.
pub(super) fn through(p: &[Vec3; 4]) -> Cubic {
    let first = (p[0] * -5.0 + p[1] * 18.0 - p[2] * 9.0 + p[3] * 2.0) / 6.0;
    let second = (p[0] * 2.0 - p[1] * 9.0 + p[2] * 18.0 - p[3] * 5.0) / 6.0;
    [p[0], first, second, p[3]]
}

impl Curves {
    /// None if the parts are not those of a definition or a section does not join its end points.
    fn of(surface: &RuledSurface) -> Option<Self> {
        let (first, end) = surface.curves()?;
        let edges = match &end {
            RuledEnd::Curve(second) => [Edge::of(&first)?, Edge::of(second)?],
            RuledEnd::Apex(apex) => [Edge::of(&first)?, Edge::Apex(*apex)],
        };
        let extent = edges[1].at(0.5)? - edges[0].at(0.5)?;
        let scale = (first.end - first.start).norm().max(extent.norm());
        scale.is_finite().then(|| Self { edges, scale, models: Models::default() })
    }
}

impl Model {
    /// None if a section does not go all the way or a number is not finite, and once `patience` is over.
    fn of(edges: &[Edge; 2], accuracy: f64, patience: Patience<'_>) -> Option<Self> {
        let pieces = pieces(edges, accuracy, patience)?;
        let [low, high] = ruled_shares(|share| Some([edges[0].run(share)?, edges[1].run(share)?]))?;
        let mut size: f64 = 0.0;
        let error = pieces.iter().map(|piece| piece.error).fold(0.0, f64::max);
        let mut patches = Vec::with_capacity(pieces.len());
        let mut off = Vec::with_capacity(pieces.len());
        for piece in &pieces {
            let [e, f] = &piece.curves;
            let edge = |v: f64| -> Cubic { std::array::from_fn(|i| lerp(&e[i], &f[i], v)) };
            let mut patch = Patch::straight(&[edge(low), edge(high)]);
            let along = [e, f].map(|c| (c[3] - c[0]).norm()).into_iter().fold(0.0, f64::max);
            patch.slack = ERROR_BEND * piece.error / (along * along);
            // Beyond the curves the rulings carry the error along.
            patch.shares = [low, high];
            // As far as errors are stretched; how rough this piece is among all counts from here on.
            off.push(ERROR_SLOPE * piece.error * patch.stretch([0.0, 1.0]));
            patch.roughness = if error > 0.0 { piece.error / error } else { 0.0 };
            patches.push(patch);
            if piece.inner {
                size = e.iter().chain(f).map(|p| p.norm()).fold(size, f64::max);
            }
        }
        let stretch = patches.iter().map(|patch: &Patch| patch.stretch([0.0, 1.0])).fold(0.0, f64::max);
        mark_edges(&mut patches, &off, &pieces);
        let whole = error.is_finite() && size.is_finite() && !patches.is_empty();
        whole.then(|| Self { patches: patches.into(), size, error, greatest_error: stretch * error })
    }
}

impl RuledStrips {
    /// The model of a surface that need not be closer to it than `accuracy`; none if the parts are not those of a definition or
    /// a section does not join its end points, and once `patience` is over.
    pub(super) fn of(
        surface: &Remembering<RuledSurface>,
        accuracy: f64,
        patience: Patience<'_>,
    ) -> Option<Self> {
        let curves = surface.made(Curves::of)?;
        let accuracy = accuracy.clamp(FINEST * curves.scale, COARSEST * curves.scale);
        let model =
            curves.models.within(accuracy, |accuracy| Model::of(&curves.edges, accuracy, patience))?;
        let sheet = Sheet::new(Arc::clone(&model.patches), true);
        Some(Self { sheet, size: model.size, error: model.error, greatest_error: model.greatest_error })
    }

    /// The normal at a place of a patch: where a curve or a ruling has no length, as in an apex, that beside it.
    fn normal_at(&self, piece: usize, along: f64, across: f64) -> Option<Vec3> {
        let net = &self.sheet.patches.get(piece)?.net;
        let tangents = |place: [f64; 2]| {
            let [_, run, rise] = jet(net, place);
            [run, rise]
        };
        let (here, middle) = (tangents([along, across]), tangents([0.5, 0.5]));
        let has_length = (0..2).all(|k| here[k].norm() > NO_LENGTH * middle[k].norm());
        let inside = |at: f64| at + INSIDE * (0.5 - at);
        let [run, rise] = if has_length { here } else { tangents([inside(along), inside(across)]) };
        run.cross(&rise).try_normalize(0.0)
    }

    /// Whether a place is where the surface ends: on the last rulings of its extension, or where all of them end.
    pub(super) fn ends_at(&self, touch: &Touch) -> bool {
        let Touch { along, across, .. } = *touch;
        let at = [along <= JOINT, along >= 1.0 - JOINT, across <= JOINT, across >= 1.0 - JOINT];
        at.into_iter().zip(self.ends(touch.piece)).any(|(is_there, is_end)| is_there && is_end)
    }

    /// At which of its sides the surface ends on a patch.
    pub(super) fn ends(&self, piece: usize) -> [bool; 4] {
        [piece == 0, piece + 1 == self.sheet.patches.len(), true, true]
    }

    /// The natural normal, along the first curve × along the ruling; at a joint the middle between both sides.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        let here = self.normal_at(touch.piece, touch.along, touch.across)?;
        let beside = if touch.along <= JOINT {
            touch.piece.checked_sub(1).map(|p| (p, 1.0))
        } else if touch.along >= 1.0 - JOINT {
            Some((touch.piece + 1, 0.0))
        } else {
            None
        };
        let beside = beside.and_then(|(piece, along)| self.normal_at(piece, along, touch.across));
        beside.map_or(Some(here), |n| (here + n).try_normalize(0.0))
    }
}

/// Marks the patches at edges of the surface, and those at its ends. By how much their derivatives at joints may be off is given: where
/// no curve bends sharply, that makes no edge.
fn mark_edges(patches: &mut [Patch], off: &[f64], pieces: &[Piece]) {
    let is_edge = |joint: usize| {
        let slack = if pieces[joint].is_sharp { 0.0 } else { 1.0 };
        [0.0, 0.5, 1.0].into_iter().any(|across| {
            // The normal, and by how much of a turn it may be off.
            let normal = |k: usize, along: f64| {
                let [_, run, rise] = jet(&patches[k].net, [along, across]);
                Some((run.cross(&rise).try_normalize(0.0)?, off[k] / run.norm()))
            };
            match (normal(joint - 1, 1.0), normal(joint, 0.0)) {
                (Some((a, one)), Some((b, other))) => {
                    a.cross(&b).norm() > EDGE + slack * (one + other) || a.dot(&b) < 0.0
                }
                _ => false,
            }
        })
    };
    let edges: Vec<usize> = (1..patches.len()).filter(|k| is_edge(*k)).collect();
    let last = patches.len().saturating_sub(1);
    for (k, patch) in patches.iter_mut().enumerate() {
        patch.edges.sides[0] = k == 0 || edges.contains(&k);
        patch.edges.sides[1] = k == last || edges.contains(&(k + 1));
    }
}

/// Both curves in pieces, from one end of the extensions to the other.
fn pieces(edges: &[Edge; 2], accuracy: f64, patience: Patience<'_>) -> Option<Vec<Piece>> {
    let steepest = |end: f64| edges.iter().map(|edge| edge.steepness(end)).fold(0.0, f64::max);
    let angular = Angular::of([steepest(0.0), steepest(1.0)]);
    let mut sharp = Vec::new();
    for edge in edges {
        if let Edge::Curve(section) = edge {
            sharp.extend(section.reach);
            sharp.extend(section.joints());
        }
    }
    let mut cuts = vec![-RULED_BEYOND, 0.0, 1.0, 1.0 + RULED_BEYOND];
    cuts.extend(&sharp);
    cuts.retain(|s| (-RULED_BEYOND..=1.0 + RULED_BEYOND).contains(s));
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| (*a - *b).abs() <= SAME_SHARE);
    let mut found = Vec::new();
    for pair in cuts.windows(2) {
        let first = found.len();
        divide((edges, angular), [pair[0], pair[1]], (accuracy, patience), &mut found)?;
        if let Some(piece) = found.get_mut(first) {
            piece.is_sharp = sharp.iter().any(|share| (share - pair[0]).abs() <= 2.0 * SAME_SHARE);
        }
    }
    Some(found)
}

/// A range in equal parts.
pub(super) fn divided([low, high]: [f64; 2], parts: u32) -> impl DoubleEndedIterator<Item = [f64; 2]> {
    let cut =
        move |k: u32| if k == parts { high } else { low + (high - low) * f64::from(k) / f64::from(parts) };
    (0..parts).map(move |k| [cut(k), cut(k + 1)])
}

/// In how many parts a piece is divided for cubics that are off by `error` to be off by `accuracy`: the error of a cubic falls with
/// the fourth power of the length.
pub(super) fn parts_for(accuracy: f64, error: f64) -> u32 {
    let wanted = (error / accuracy).sqrt().sqrt().ceil();
    (2..GREATEST_DIVISION).find(|parts| f64::from(*parts) >= wanted).unwrap_or(GREATEST_DIVISION)
}

fn divide(
    (edges, angular): (&[Edge; 2], Angular),
    ends: [f64; 2],
    (accuracy, patience): (f64, Patience<'_>),
    found: &mut Vec<Piece>,
) -> Option<()> {
    let inner = ends[0] >= -1e-12 && ends[1] <= 1.0 + 1e-12;
    // Beyond the ends of the chord the parameter is the share itself.
    let share = |w: f64| if inner { angular.share(w) } else { w };
    let range = if inner { ends.map(|share| angular.parameter(share)) } else { ends };
    // The last piece first, so that they come out in order.
    let mut open = vec![(range, 0)];
    while let Some(([low, high], depth)) = open.pop() {
        let at = |edge: &Edge, x: f64| edge.at(share(low + (high - low) * x));
        let mut error: f64 = 0.0;
        let mut curves = [[Vec3::zeros(); 4]; 2];
        for (edge, curve) in edges.iter().zip(&mut curves) {
            let nodes = [at(edge, 0.0)?, at(edge, 1.0 / 3.0)?, at(edge, 2.0 / 3.0)?, at(edge, 1.0)?];
            *curve = through(&nodes);
            for x in [0.127, 0.5, 0.873] {
                error = error.max(ALLOWANCE * (at(edge, x)? - place(curve, x)).norm());
            }
        }
        if !error.is_finite() || patience.ends_after(WORK_OF_PATCH) || found.len() + open.len() > PIECES {
            return None;
        }
        if error > accuracy && depth < DIVISIONS {
            let parts = parts_for(accuracy, error);
            open.extend(divided([low, high], parts).rev().map(|range| (range, depth + 1)));
        } else {
            let middle = share(0.5 * (low + high));
            let inner = (RULED_STEADY..=1.0 - RULED_STEADY).contains(&middle);
            found.push(Piece { curves, error, inner, is_sharp: false });
        }
    }
    Some(())
}

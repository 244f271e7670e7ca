//! Ruled surfaces: straight rulings between points at equal shares of two chords (language reference 4.16).
//!
//! The two curves are kept as quintic pieces that pass through their points with slope and curvature. Rulings go on
//! beyond the curves, and the curves straight beyond their ends, for [`RULED_BEYOND`] times their length, but not to where
//! neighbouring rulings meet. The nearest point is found over a tree of strips, each bounded by a box about its middle ruling.

use std::sync::{Arc, OnceLock};

mod bounds;
mod chord;
mod ends;
mod rays;
mod strip;

use self::strip::Strip;
use super::{
    Chart, Place, Surface,
    apart::Apart,
    descent::Nearness,
    part::Count,
    perpendicular,
    section_curve::{CurvePoint, SectionCurve},
    sheet::{Jet, Landing, ON_SURFACE, Rest},
};
use crate::{
    Vec3,
    canonical::{
        Made, RuledEnd, RuledSurface,
        extent::{RULED_BEYOND, ruled_shares},
    },
    patience::Patience,
};

/// Accuracy of the pieces, relative to the size of the surface.
const ACCURACY: f64 = 2e-11;
/// How much less accurate the shortest pieces, at a kink of a curve, may be.
const KINK: f64 = 5e4;
/// Bound of the halvings of a piece of the curves.
const MAX_DEPTH: u32 = 40;
/// Units of work that it takes to try a piece, or to bound a strip.
const UNITS_A_PIECE: u32 = 4;
/// Bound of the number of pieces.
const MAX_PIECES: usize = 4096;
/// Strips over the surface itself, roughly: short enough for one valley of the distance each.
const STRIPS: f64 = 48.0;
/// How much wider strips of the extensions are.
const COARSER: f64 = 8.0;
/// Step of the parameter below which its effect on the distance is far below rounding.
const RESOLUTION: f64 = 1e-13;
/// Bound of the bracketed iteration for the nearest ruling.
const MAX_ITERATIONS: u32 = 60;

/// `Σ cₖ τᵏ` with τ from 0 to 1.
type Quintic = [Vec3; 6];

/// One piece of both curves over a range of the parameter.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    from: f64,
    width: f64,
    curves: [Quintic; 2],
}

/// A ruled surface ready for distance questions: `E(t) + v·(F(t) − E(t))`.
#[derive(Debug, Clone, PartialEq)]
pub struct RuledSheet {
    pieces: Vec<Piece>,
    /// The strips of each band of shares in order, as a complete binary tree: node `k` has children `2k+1` and `2k+2`.
    bands: Arc<Vec<Vec<Strip>>>,
    /// Range of the parameter and of the share along the rulings.
    limits: [[f64; 2]; 2],
    /// Unit direction of the ruling between the beginnings of the chords.
    ruling: Vec3,
    size: f64,
    curvature: f64,
    /// Parts with bounds.
    parts: Count,
    /// The side that what is beyond the end counts for, as a tool on that side meets the surface; otherwise that of the tangent plane.
    beyond: Option<f64>,
    /// What a tool meets on either side: first that of the natural normal. Made where it is asked for.
    met: [OnceLock<Box<Surface>>; 2],
}

/// The nearest place so far.
#[derive(Clone, Copy)]
struct Nearest {
    t: f64,
    piece: usize,
    near: Nearness,
}

/// Point, first and second derivative of a quintic by the parameter itself.
fn evaluate(c: &Quintic, tau: f64, width: f64) -> [Vec3; 3] {
    let value = ((((c[5] * tau + c[4]) * tau + c[3]) * tau + c[2]) * tau + c[1]) * tau + c[0];
    let first = (((c[5] * (5.0 * tau) + c[4] * 4.0) * tau + c[3] * 3.0) * tau + c[2] * 2.0) * tau + c[1];
    let second = ((c[5] * (20.0 * tau) + c[4] * 12.0) * tau + c[3] * 6.0) * tau + c[2] * 2.0;
    [value, first / width, second / (width * width)]
}

/// The quintic with given points and derivatives at both ends.
fn through(a: &CurvePoint, b: &CurvePoint, width: f64) -> Quintic {
    let (c0, c1, c2) = (a.point, a.first * width, a.second * (0.5 * width * width));
    let rest = b.point - c0 - c1 - c2;
    let slope = b.first * width - c1 - c2 * 2.0;
    let bend = b.second * (width * width) - c2 * 2.0;
    [
        c0,
        c1,
        c2,
        rest * 10.0 - slope * 4.0 + bend * 0.5,
        rest * -15.0 + slope * 7.0 - bend,
        rest * 6.0 - slope * 3.0 + bend * 0.5,
    ]
}

/// The curves of a definition.
enum Edge {
    Curve(Box<SectionCurve>),
    Apex(Vec3),
}

impl Edge {
    fn at(&self, share: f64, inside: f64) -> CurvePoint {
        match self {
            Self::Curve(curve) => curve.at(share, inside),
            Self::Apex(point) => CurvePoint { point: *point, first: Vec3::zeros(), second: Vec3::zeros() },
        }
    }

    fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Curve(curve) => curve.reach().into_iter().chain(curve.joints()).collect(),
            Self::Apex(_) => Vec::new(),
        }
    }
}

impl Made for RuledSheet {
    fn parts(&self) -> usize {
        self.parts.get()
    }
}

impl RuledSheet {
    /// `None` if the parts are not those of a definition or a section does not join its end points.
    pub(super) fn new(surface: &RuledSurface, patience: Patience<'_>) -> Option<Self> {
        let (first, end) = surface.curves()?;
        let chord = first.end - first.start;
        let mut size = chord.norm();
        let edges = match &end {
            RuledEnd::Curve(second) => {
                size = size.max((second.start - first.start).norm()).max((second.end - first.start).norm());
                [SectionCurve::new(&first)?, SectionCurve::new(second)?].map(|c| Edge::Curve(Box::new(c)))
            }
            RuledEnd::Apex(apex) => {
                size = size.max((apex - first.start).norm());
                [Edge::Curve(Box::new(SectionCurve::new(&first)?)), Edge::Apex(*apex)]
            }
        };
        let range = [-RULED_BEYOND, 1.0 + RULED_BEYOND];
        let other = match &end {
            RuledEnd::Curve(second) => second.start,
            RuledEnd::Apex(apex) => *apex,
        };
        let ruling = (other - first.start).try_normalize(0.0)?;
        let pieces = pieces(&edges, range, ACCURACY * size, patience)?;
        // Both curves as the chord is gone along, on the side that is ahead.
        let shares = ruled_shares(|share| Some([0, 1].map(|k: usize| edges[k].at(share, 1.0).first)))?;
        let limits = [range, shares];
        let mut sheet = Self {
            pieces,
            bands: Arc::default(),
            limits,
            ruling,
            size,
            curvature: 0.0,
            parts: Count::default(),
            beyond: None,
            met: Default::default(),
        };
        sheet.grow(patience)?;
        Some(sheet)
    }

    fn jet(&self, piece: usize, t: f64, v: f64) -> Jet {
        let Some(piece) = self.pieces.get(piece) else {
            let zero = Vec3::zeros();
            return Jet { point: zero, du: zero, dv: zero, duu: zero, duv: zero, dvv: zero };
        };
        let tau = (t - piece.from) / piece.width;
        let [e, e1, e2] = evaluate(&piece.curves[0], tau, piece.width);
        let [f, f1, f2] = evaluate(&piece.curves[1], tau, piece.width);
        let (dv, duv) = (f - e, f1 - e1);
        Jet { point: e + dv * v, du: e1 + duv * v, dv, duu: e2 + (f2 - e2) * v, duv, dvv: Vec3::zeros() }
    }

    /// Cuts the surface into strips and builds their trees; `None` where who waits gives up.
    fn grow(&mut self, patience: Patience<'_>) -> Option<()> {
        let [low, high] = self.limits[1];
        let length = |piece: &Piece| {
            let chord = |c: &Quintic| (evaluate(c, 1.0, 1.0)[0] - evaluate(c, 0.0, 1.0)[0]).norm();
            chord(&piece.curves[0]).max(chord(&piece.curves[1]))
        };
        let inner: f64 =
            self.pieces.iter().filter(|p| p.from + p.width > 0.0 && p.from < 1.0).map(length).sum();
        let target = (inner / STRIPS).max(f64::MIN_POSITIVE);
        let mut ranges = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let inside = piece.from + piece.width > 0.0 && piece.from < 1.0;
            let target = if inside { target } else { COARSER * target };
            let count = (length(piece) / target).ceil().clamp(1.0, STRIPS) as u32;
            for j in 0..count {
                let at = |j: u32| piece.from + piece.width * (f64::from(j) / f64::from(count));
                ranges.push((k, [at(j), at(j + 1)]));
            }
        }
        let cuts = [low, 0.0, 1.0, high];
        let mut bands = Vec::new();
        for pair in cuts.windows(2).filter(|pair| pair[1] > pair[0]) {
            bands.push(self.tree(&ranges, [pair[0], pair[1]], patience)?);
        }
        self.curvature = self.sampled_curvature(&ranges, patience)?;
        self.bands = Arc::new(bands);
        Some(())
    }

    /// Greatest principal curvature over the surface between its curves; `None` where who waits gives up.
    fn sampled_curvature(&self, ranges: &[(usize, [f64; 2])], patience: Patience<'_>) -> Option<f64> {
        let mut greatest: f64 = 0.0;
        for &(piece, [a, b]) in ranges.iter().filter(|(_, r)| r[1] > 0.0 && r[0] < 1.0) {
            if patience.ends_after(1) {
                return None;
            }
            for v in [0.0, 0.5, 1.0] {
                for t in [a, 0.5 * (a + b), b] {
                    let jet = self.jet(piece, t, v);
                    if let Some(normal) = jet.natural(self.size) {
                        greatest = greatest.max(jet.greatest_curvature(&normal));
                    }
                }
            }
        }
        Some(greatest)
    }

    /// The share along a ruling that is nearest to a point, and whether it is at a limit.
    fn share(&self, p: &Vec3, e: &Vec3, along: &Vec3) -> (f64, bool) {
        let [low, high] = self.limits[1];
        let square = along.norm_squared();
        if square <= 0.0 {
            return (low.max(0.0), false);
        }
        let v = (p - e).dot(along) / square;
        (v.clamp(low, high), v <= low || v >= high)
    }

    /// Half the derivative of the squared distance to the ruling, its own derivative, and the squared distance.
    fn slope(&self, p: &Vec3, piece: usize, t: f64) -> (f64, f64, f64) {
        let Some(piece) = self.pieces.get(piece) else { return (0.0, 0.0, f64::INFINITY) };
        let tau = (t - piece.from) / piece.width;
        let [e, e1, e2] = evaluate(&piece.curves[0], tau, piece.width);
        let [f, f1, f2] = evaluate(&piece.curves[1], tau, piece.width);
        let (dv, duv) = (f - e, f1 - e1);
        let (v, held) = self.share(p, &e, &dv);
        let offset = e + dv * v - p;
        let du = e1 + duv * v;
        let mut bend = du.norm_squared() + offset.dot(&(e2 + (f2 - e2) * v));
        if !held {
            let mixed = du.dot(&dv) + offset.dot(&duv);
            bend -= mixed * mixed / dv.norm_squared().max(f64::MIN_POSITIVE);
        }
        (offset.dot(&du), bend, offset.norm_squared())
    }

    fn nearest(&self, p: &Vec3) -> Nearest {
        let mut best = Nearest { t: 0.0, piece: 0, near: Nearness::NONE };
        // The band between the curves first; nearer children first.
        let mut open: Vec<(f64, usize, usize)> = Vec::with_capacity(32);
        for (band, nodes) in self.bands.iter().enumerate() {
            if let Some(root) = nodes.first() {
                open.push((root.bound(p), band, 0));
            }
        }
        open.sort_by(|a, b| b.0.total_cmp(&a.0));
        while let Some((bound, band, node)) = open.pop() {
            if bound > 0.0 && bound * bound >= best.near.square {
                continue;
            }
            let Some(nodes) = self.bands.get(band) else { continue };
            let child = |k: usize| {
                nodes.get(k).filter(|strip| strip.piece != usize::MAX).map(|strip| (strip.bound(p), band, k))
            };
            match (child(2 * node + 1), child(2 * node + 2)) {
                (Some(a), Some(b)) if a.0 < b.0 => open.extend([b, a]),
                (Some(a), Some(b)) => open.extend([a, b]),
                (Some(a), None) | (None, Some(a)) => open.push(a),
                (None, None) => {
                    if let Some(strip) = nodes.get(node) {
                        self.descend(p, strip, &mut best);
                    }
                }
            }
        }
        best
    }

    /// The nearest ruling within a strip.
    fn descend(&self, p: &Vec3, strip: &Strip, best: &mut Nearest) {
        let [mut low, mut high] = strip.range;
        let size = self.size + p.norm();
        let mut take = |t: f64, (slope, _, square): (f64, f64, f64)| {
            let near = Nearness { square, slope: slope.abs() };
            if best.near.yields_to(&near, size) {
                *best = Nearest { t, piece: strip.piece, near };
            }
        };
        let (a, b) = (self.slope(p, strip.piece, low), self.slope(p, strip.piece, high));
        take(low, a);
        take(high, b);
        if !(a.0 < 0.0 && b.0 > 0.0) {
            return;
        }
        let mut t = low + (high - low) * (a.0 / (a.0 - b.0));
        let resolution = RESOLUTION * (1.0 + low.abs().max(high.abs()));
        for _ in 0..MAX_ITERATIONS {
            let told @ (slope, bend, _) = self.slope(p, strip.piece, t);
            take(t, told);
            if slope > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - slope / bend;
            let next =
                if bend > 0.0 && newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - t).abs() <= resolution {
                return;
            }
            t = next;
        }
    }

    /// The nearest point with its curvature elements.
    pub(super) fn place(&self, p: &Vec3) -> Landing {
        let nearest = self.nearest(p);
        let start = self.jet(nearest.piece, nearest.t, 0.0);
        let (v, held) = self.share(p, &start.point, &start.dv);
        let jet = self.jet(nearest.piece, nearest.t, v);
        let [low, high] = self.limits[0];
        // On the surface itself the offset is rounding and says nothing.
        let on_surface = (p - jet.point).norm() <= ON_SURFACE * self.size;
        let is_last = nearest.t <= low || nearest.t >= high;
        let rest = match (is_last, held) {
            _ if on_surface => Rest::Inside,
            (false, false) => self.crease(p, &jet),
            (true, false) => Rest::AlongV,
            (false, true) => Rest::AlongU,
            (true, true) => Rest::Corner,
        };
        let natural = self.natural(&nearest, v, &jet);
        let beyond = self.beyond.filter(|_| is_last || held);
        Landing { foot: jet.foot(p, rest, (&natural, beyond), self.size), jet, rest }
    }

    /// On a sharp bend of the curves the nearest ruling stays the same, too.
    fn crease(&self, p: &Vec3, jet: &Jet) -> Rest {
        let offset = p - jet.point;
        let speed = jet.du.norm();
        if offset.dot(&jet.du).abs() > 1e-6 * offset.norm() * speed { Rest::AlongV } else { Rest::Inside }
    }

    /// The natural normal at a place; where the rulings meet that a little way off.
    fn natural(&self, nearest: &Nearest, v: f64, jet: &Jet) -> Vec3 {
        let middle = 0.5 * (self.limits[1][0] + self.limits[1][1]);
        let inner = 0.5 * (self.limits[0][0] + self.limits[0][1]);
        jet.natural(self.size)
            .or_else(|| self.jet(nearest.piece, nearest.t, v + 1e-6 * (middle - v)).natural(1e-6 * self.size))
            .or_else(|| {
                let t = nearest.t + 1e-6 * (inner - nearest.t);
                self.jet(nearest.piece, t, v).natural(1e-6 * self.size)
            })
            .unwrap_or_else(|| jet.dv.try_normalize(0.0).map_or_else(Vec3::z, |dv| perpendicular(&dv)))
    }

    pub(super) fn place_near(&self, p: &Vec3) -> Place {
        let Nearest { t, piece, .. } = self.nearest(p);
        let start = self.jet(piece, t, 0.0);
        let (v, _) = self.share(p, &start.point, &start.dv);
        Place { piece, at: [t, v] }
    }

    /// Whether all strips are farther from a point than a distance.
    pub(super) fn keeps_off(&self, p: &Vec3, distance: f64) -> bool {
        self.bands.iter().all(|nodes| {
            let mut open = vec![0usize];
            while let Some(node) = open.pop() {
                let Some(strip) = nodes.get(node).filter(|strip| strip.piece != usize::MAX) else { continue };
                if strip.bound(p) > distance {
                    continue;
                }
                if 2 * node + 1 >= nodes.len() {
                    return false;
                }
                open.extend([2 * node + 2, 2 * node + 1]);
            }
            true
        })
    }

    /// Whether all strips keep off a body: those between the curves and the nearest first, after which others add nothing.
    pub(super) fn keeps_apart(&self, asked: &mut Apart<'_>) -> bool {
        let look = |asked: &mut Apart<'_>, band: usize, node: usize| {
            let strip = self.bands.get(band)?.get(node).filter(|strip| strip.piece != usize::MAX)?;
            Some((asked.stretch(&strip.middle, strip.radius), band, node))
        };
        let mut open: Vec<_> = (0..self.bands.len()).filter_map(|band| look(asked, band, 0)).collect();
        let is_between = |band: usize| {
            let root = self.bands.get(band).and_then(|nodes| nodes.first());
            root.is_some_and(|root| root.shares[0] >= 0.0 && root.shares[1] <= 1.0)
        };
        open.sort_by_key(|(_, band, _)| is_between(*band));
        while let Some((least, band, node)) = open.pop() {
            if asked.is_settled(least) {
                continue;
            }
            match [2 * node + 1, 2 * node + 2].map(|child| look(asked, band, child)) {
                [Some(a), Some(b)] if a.0 < b.0 => open.extend([b, a]),
                [None, None] => {
                    let strip = self.bands.get(band).and_then(|nodes| nodes.get(node));
                    if !asked.takes(least) && !strip.is_some_and(|strip| self.strip_keeps_apart(strip, asked))
                    {
                        return false;
                    }
                }
                children => open.extend(children.into_iter().flatten()),
            }
        }
        true
    }

    pub(super) fn chart(&self, place: &Place) -> Option<Chart> {
        let [t, v] = place.at;
        self.pieces.get(place.piece)?;
        Some(Chart::new(&self.jet(place.piece, t, v), 1.0, 0.0))
    }

    pub(super) fn shifted(&self, place: &Place, step: [f64; 2]) -> Option<Place> {
        let at = [place.at[0] + step[0], place.at[1] + step[1]];
        let inside = at.iter().zip(&self.limits).all(|(x, [low, high])| x > low && x < high);
        if !inside {
            return None;
        }
        let holds = |piece: &Piece| at[0] >= piece.from && at[0] <= piece.from + piece.width;
        if self.pieces.get(place.piece).is_some_and(holds) {
            return Some(Place { piece: place.piece, at });
        }
        let after = self.pieces.partition_point(|piece| piece.from <= at[0]);
        Some(Place { piece: after.checked_sub(1)?, at })
    }

    /// Unit direction of the ruling through the nearest point.
    pub fn ruling(&self, p: &Vec3) -> Option<Vec3> {
        self.place(p).jet.dv.try_normalize(0.0)
    }

    /// Greatest absolute value of a principal curvature between the two curves, 1/length.
    pub fn greatest_curvature(&self) -> f64 {
        self.curvature
    }
}

/// Both curves in pieces over a range of the parameter.
fn pieces(edges: &[Edge; 2], range: [f64; 2], accuracy: f64, patience: Patience<'_>) -> Option<Vec<Piece>> {
    let mut cuts: Vec<f64> = edges.iter().flat_map(Edge::breaks).collect();
    cuts.extend([range[0], 0.0, 0.5, 1.0, range[1]]);
    cuts.retain(|x| *x >= range[0] && *x <= range[1]);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| (*a - *b).abs() <= 1e-9);
    let mut pieces = Vec::new();
    let mut open: Vec<(f64, f64, u32)> =
        cuts.windows(2).rev().filter_map(|pair| Some((*pair.first()?, *pair.get(1)?, 0))).collect();
    while let Some((a, b, depth)) = open.pop() {
        if patience.ends_after(UNITS_A_PIECE) {
            return None;
        }
        let (width, middle) = (b - a, 0.5 * (a + b));
        let mut misfit: f64 = 0.0;
        let curves = [0, 1].map(|k: usize| {
            let edge = &edges[k];
            let curve = through(&edge.at(a, middle), &edge.at(b, middle), width);
            for tau in [0.25, 0.5, 0.75] {
                let exact = edge.at(a + width * tau, middle).point;
                let gap = (evaluate(&curve, tau, width)[0] - exact).norm();
                // Not `max`, which would lose a gap that is no number.
                misfit = if gap.is_nan() || gap > misfit { gap } else { misfit };
            }
            curve
        });
        let fits = misfit <= accuracy;
        if !fits && depth < MAX_DEPTH && width > 1e-9 {
            open.push((middle, b, depth + 1));
            open.push((a, middle, depth + 1));
        } else if misfit.is_nan() || misfit > KINK * accuracy || pieces.len() >= MAX_PIECES {
            return None;
        } else {
            pieces.push(Piece { from: a, width, curves });
        }
    }
    Some(pieces)
}

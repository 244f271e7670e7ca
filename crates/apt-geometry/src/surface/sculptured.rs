//! Sculptured surfaces: rational bicubic patches, with the straight patches beyond their outer edges that contacts are
//! solved on. The nearest point is found over a tree of balls whose leaves, parts of patches, are nearly flat.

mod bounds;
mod rays;
mod tree;

use std::sync::{Arc, OnceLock};

use self::tree::Node;
use super::{
    Chart, Crease, Place, Surface, SurfaceEdge,
    descent::{Descent, MAX_STEPS, Slopes},
    part::Count,
    perpendicular,
    sheet::{Jet, Landing, ON_SURFACE, Rest, at_limits},
};
use crate::{
    Vec3,
    canonical::Made,
    parametric::{Edge, ExtendedPatch, Flanged, Patch, PatchPoint, SculpturedSurface, Side},
    patience::Patience,
};

/// Share of an offset along a joint's own surface above which the nearest place stays on the joint.
const OFF_NORMAL: f64 = 1e-6;
/// Share of the way to the middle of a patch at which the normal is taken where a place has none.
const INWARD: f64 = 1e-5;
/// Bound of the joints that one step crosses.
const MOST_CROSSINGS: u32 = 4;
/// Places of each patch, along each parameter, where its curvature is looked at.
const SAMPLES: u32 = 4;
/// Units of work that it takes to sample a patch.
const UNITS_A_PATCH: u32 = 4;

/// A sculptured surface ready for distance questions.
#[derive(Debug, Clone, PartialEq)]
pub struct SculpturedSheet {
    pieces: Vec<ExtendedPatch>,
    /// A binary tree; the root is first.
    nodes: Vec<Node>,
    /// Direction of all rulings, if the surface may be shifted along it.
    ruling: Option<Vec3>,
    size: f64,
    curvature: f64,
    /// Parts with bounds.
    parts: Count,
    /// How many of the pieces are the surface and what goes on beyond it: not those that it is taken for behind its ends.
    own: usize,
    /// What a tool meets on either side of it, if that is more: first that of the natural normal. Made where it is asked for.
    flanged: Option<Arc<Flanged>>,
    met: [OnceLock<Option<Box<Surface>>>; 2],
}

/// The nearest place so far.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    square: f64,
    piece: usize,
    at: [f64; 2],
}

impl Made for SculpturedSheet {
    fn parts(&self) -> usize {
        let met = self.met.iter().filter_map(|met| match met.get()?.as_deref()? {
            Surface::Sculptured(sheet) => Some(sheet.parts.get()),
            _ => None,
        });
        self.parts.get() + met.sum::<usize>()
    }
}

impl From<PatchPoint> for Jet {
    fn from(at: PatchPoint) -> Self {
        let PatchPoint { position, du, dv, duu, duv, dvv } = at;
        Self { point: position, du, dv, duu, duv, dvv }
    }
}

/// The edges of a patch that parameters lie on.
fn edges_at([u, v]: [f64; 2]) -> [Option<Edge>; 2] {
    let of = |t: f64, low: Edge, high: Edge| {
        if t <= 0.0 {
            Some(low)
        } else if t >= 1.0 {
            Some(high)
        } else {
            None
        }
    };
    [of(u, Edge::LowU, Edge::HighU), of(v, Edge::LowV, Edge::HighV)]
}

impl SculpturedSheet {
    /// `None` if there are no patches, or all of it is one point.
    pub(super) fn new(
        surface: &SculpturedSurface,
        extended: &[ExtendedPatch],
        flanged: Arc<Flanged>,
        patience: Patience<'_>,
    ) -> Option<Self> {
        let size = surface.size();
        if !(surface.is_finite() && size.is_finite() && size > 0.0) {
            return None;
        }
        let mut sheet = Self::of(extended, size, patience)?;
        sheet.ruling = sheet.found_ruling();
        sheet.curvature = sheet.sampled_curvature(surface.patches.len(), patience)?;
        sheet.flanged = Some(flanged);
        Some(sheet)
    }

    fn of(pieces: &[ExtendedPatch], size: f64, patience: Patience<'_>) -> Option<Self> {
        let mut sheet = Self {
            pieces: pieces.to_vec(),
            nodes: Vec::new(),
            ruling: None,
            size,
            curvature: 0.0,
            parts: Count::default(),
            own: pieces.len(),
            flanged: None,
            met: Default::default(),
        };
        sheet.nodes = tree::grown(&sheet, patience)?;
        (!sheet.nodes.is_empty()).then_some(sheet)
    }

    /// The surface with what it is taken for behind its ends by a tool on a side; none if that is itself.
    /// None as well where who waits gives up, and then nothing is kept.
    pub(super) fn met_from(&self, side: f64, patience: Patience<'_>) -> Option<&Surface> {
        let flanged = self.flanged.as_ref()?;
        let kept = &self.met[usize::from(side < 0.0)];
        if let Some(made) = kept.get() {
            return made.as_deref();
        }
        let made = Self::of(flanged.patches(side), self.size, patience).map(|mut sheet| {
            (sheet.curvature, sheet.own, sheet.ruling) = (self.curvature, self.own, self.ruling);
            Box::new(Surface::Sculptured(Arc::new(sheet)))
        });
        if patience.was_over() { None } else { kept.get_or_init(|| made).as_deref() }
    }

    /// Greatest principal curvature at places of the definition's own patches; `None` where who waits gives up.
    fn sampled_curvature(&self, own: usize, patience: Patience<'_>) -> Option<f64> {
        let mut greatest: f64 = 0.0;
        let share = |k: u32| f64::from(k) / f64::from(SAMPLES);
        for piece in self.pieces.iter().take(own) {
            if patience.ends_after(UNITS_A_PATCH) {
                return None;
            }
            for (i, j) in (0..=SAMPLES).flat_map(|i| (0..=SAMPLES).map(move |j| (i, j))) {
                let jet = Jet::from(piece.patch.evaluate(share(i), share(j)));
                if let Some(normal) = jet.natural(piece.patch.size()) {
                    greatest = greatest.max(jet.greatest_curvature(&normal));
                }
            }
        }
        Some(greatest)
    }

    /// The direction along which all patches are the same curve, if there is one.
    fn found_ruling(&self) -> Option<Vec3> {
        let close = ON_SURFACE * 0.1 * self.size;
        // Along v; a flat patch may have both directions.
        let along = |patch: &Patch| -> Option<Vec3> {
            let points = patch.points();
            let step: [Vec3; 4] = std::array::from_fn(|j| points[0][j] - points[0][0]);
            let weights = patch.control.map(|row| row.map(|point| point.w));
            let shifted = (0..4).all(|i| {
                (0..4).all(|j| {
                    let even = (weights[i][j] - weights[i][0]).abs() <= f64::EPSILON * 4.0 * weights[i][0];
                    even && (points[i][j] - points[i][0] - step[j]).norm() <= close
                })
            });
            let way = step[3].try_normalize(close)?;
            let straight = step.iter().all(|s| s.cross(&way).norm() <= close);
            (shifted && straight).then_some(way)
        };
        let both = |patch: &Patch| [along(patch), along(&patch.swapped())];
        let first = both(&self.pieces.first()?.patch);
        first.into_iter().flatten().find(|way| {
            let agrees = |other: Vec3| other.cross(way).norm() <= ON_SURFACE;
            self.pieces.iter().all(|piece| both(&piece.patch).into_iter().flatten().any(agrees))
        })
    }

    fn jet(&self, piece: usize, [u, v]: [f64; 2]) -> Jet {
        self.pieces.get(piece).map_or_else(
            || {
                let zero = Vec3::zeros();
                Jet { point: zero, du: zero, dv: zero, duu: zero, duv: zero, dvv: zero }
            },
            |piece| piece.patch.evaluate(u, v).into(),
        )
    }

    fn nearest(&self, p: &Vec3) -> Nearest {
        let mut best = Nearest { square: f64::INFINITY, piece: 0, at: [0.5; 2] };
        let mut open: Vec<(f64, usize)> = Vec::with_capacity(32);
        open.push((0.0, 0));
        let bound = |k: usize| self.nodes.get(k).map_or(f64::INFINITY, |node| node.bound(p));
        while let Some((least, node)) = open.pop() {
            if least > 0.0 && least * least >= best.square {
                continue;
            }
            match self.nodes.get(node) {
                Some(Node::Fork { children: [a, b], .. }) => {
                    let (a, b) = ((bound(*a), *a), (bound(*b), *b));
                    // The nearer one is taken first.
                    open.extend(if a.0 < b.0 { [b, a] } else { [a, b] });
                }
                Some(Node::Leaf(leaf)) => self.descend(p, leaf, &mut best),
                None => {}
            }
        }
        best
    }

    /// Goes down to the nearest place of a leaf from its middle.
    fn descend(&self, p: &Vec3, leaf: &tree::Leaf, best: &mut Nearest) {
        let limits = [leaf.rectangle.range(0), leaf.rectangle.range(1)];
        let mut descent = Descent::new(p, limits, leaf.rectangle.middle, leaf.jet);
        for _ in 0..MAX_STEPS {
            let next = descent.next(&Slopes::at(&descent.jet, p));
            if !descent.moves(&next) || !descent.take(next, self.jet(leaf.piece, [next.x, next.y])) {
                break;
            }
        }
        if descent.square < best.square {
            *best = Nearest { square: descent.square, piece: leaf.piece, at: [descent.at.x, descent.at.y] };
        }
    }

    fn side(&self, piece: usize, edge: Edge) -> Side {
        self.pieces.get(piece).map_or(Side::End, |piece| piece.sides[edge.number()])
    }

    /// The nearest point with its curvature elements.
    pub(super) fn place(&self, p: &Vec3) -> Landing {
        let Nearest { piece, at, .. } = self.nearest(p);
        let jet = self.jet(piece, at);
        let offset = p - jet.point;
        let length = offset.norm();
        let natural = self.natural(piece, at, &jet);
        let mut facing = natural;
        let mut held = [false; 2];
        // On the surface itself the offset is rounding and says nothing.
        if length > ON_SURFACE * self.size {
            for (k, edge) in edges_at(at).into_iter().enumerate() {
                let Some(edge) = edge else { continue };
                match self.side(piece, edge) {
                    Side::End => held[k] = true,
                    side @ Side::Joint { .. } if side.is_crease() => {
                        let across = if k == 0 { jet.du } else { jet.dv };
                        if offset.dot(&across).abs() > OFF_NORMAL * length * across.norm() {
                            held[k] = true;
                            facing += self.beyond(&side, edge, at).unwrap_or(natural);
                        }
                    }
                    Side::Point | Side::Joint { .. } => {}
                }
            }
        }
        let rest = match held {
            [false, false] => Rest::Inside,
            [true, false] => Rest::AlongV,
            [false, true] => Rest::AlongU,
            [true, true] => Rest::Corner,
        };
        // At an edge of the surface the side is that of both its patches.
        let sensed = if held == [false; 2] { natural } else { facing.try_normalize(0.0).unwrap_or(natural) };
        Landing { foot: jet.foot(p, rest, (&sensed, None), self.size), jet, rest }
    }

    /// The natural normal at a place; where the patch has none that a little way inside.
    fn natural(&self, piece: usize, at: [f64; 2], jet: &Jet) -> Vec3 {
        let size = self.pieces.get(piece).map_or(self.size, |piece| piece.patch.size());
        let inner = at.map(|t| t + INWARD * (0.5 - t));
        jet.natural(size)
            .or_else(|| self.jet(piece, inner).natural(INWARD * 1e-2 * size))
            .unwrap_or_else(|| jet.du.try_normalize(0.0).map_or_else(Vec3::z, |du| perpendicular(&du)))
    }

    /// The natural normal on the other side of a joint.
    fn beyond(&self, side: &Side, own: Edge, at: [f64; 2]) -> Option<Vec3> {
        let Side::Joint { patch, edge, reversed, .. } = side else { return None };
        let there = edge.parameters(along(own, at, *reversed));
        Some(self.natural(*patch, there, &self.jet(*patch, there)))
    }

    /// Whether the nearest place lies on an edge beyond which there is no patch, or beyond the end of the surface.
    pub(super) fn ends_at(&self, p: &Vec3) -> bool {
        let Nearest { piece, at, .. } = self.nearest(p);
        let at_edges = Edge::ALL.into_iter().zip(at_limits(at, [[0.0, 1.0]; 2]));
        let mut sides = at_edges.filter(|(_, is_at)| *is_at).map(|(edge, _)| self.side(piece, edge));
        let is_own = |side: &Side| matches!(side, Side::Joint { patch, .. } if *patch < self.own);
        if piece < self.own { sides.any(|side| side == Side::End) } else { !sides.any(|side| is_own(&side)) }
    }

    pub(super) fn edge_at(&self, p: &Vec3) -> Option<SurfaceEdge> {
        let Nearest { piece, at, .. } = self.nearest(p);
        let at_edges = Edge::ALL.into_iter().zip(at_limits(at, [[0.0, 1.0]; 2]));
        let is_end = |(edge, is_at): &(Edge, bool)| *is_at && self.side(piece, *edge) == Side::End;
        let (edge, _) = at_edges.into_iter().find(is_end)?;
        let jet = self.jet(piece, at);
        let normal = self.natural(piece, at, &jet);
        SurfaceEdge::at(edge, [jet.du, jet.dv], normal)
    }

    pub(super) fn crease_at(&self, place: &Place, side: f64) -> Option<(Crease, f64)> {
        let at = edges_at(place.at);
        let beside = self.creases_beside(place, side).into_iter().flatten();
        beside.into_iter().find(|(crease, _)| at.contains(&Some(crease.edge)))
    }

    pub(super) fn creases_beside(&self, place: &Place, side: f64) -> [Option<(Crease, f64)>; 4] {
        let Place { piece, at } = *place;
        let seen = usize::from(side < 0.0);
        Edge::ALL.map(|edge| {
            let Side::Joint { stands_out, .. } = self.side(piece, edge) else { return None };
            stands_out[seen].then(|| (Crease { piece, edge }, along(edge, at, false)))
        })
    }

    pub(super) fn place_near(&self, p: &Vec3) -> Place {
        let Nearest { piece, at, .. } = self.nearest(p);
        Place { piece, at }
    }

    pub(super) fn chart(&self, place: &Place) -> Option<Chart> {
        self.pieces.get(place.piece)?;
        Some(Chart::new(&self.jet(place.piece, place.at), 1.0, 0.0))
    }

    /// The place at other parameters; over a joint by the vector that is left there.
    pub(super) fn shifted(&self, place: &Place, step: [f64; 2]) -> Option<Place> {
        let (mut piece, mut at, mut step) = (place.piece, place.at, step);
        for _ in 0..MOST_CROSSINGS {
            let wanted = [at[0] + step[0], at[1] + step[1]];
            if wanted.iter().all(|t| (0.0..=1.0).contains(t)) {
                return Some(Place { piece, at: wanted });
            }
            // The share of the step at which it comes to the first edge.
            let share = |k: usize| {
                let limit = if step[k] > 0.0 { 1.0 } else { 0.0 };
                if (0.0..=1.0).contains(&wanted[k]) { f64::INFINITY } else { (limit - at[k]) / step[k] }
            };
            let shares = [share(0), share(1)];
            let k = usize::from(shares[1] < shares[0]);
            let part = shares[k].clamp(0.0, 1.0);
            let mut edge_at = [at[0] + step[0] * part, at[1] + step[1] * part].map(|t| t.clamp(0.0, 1.0));
            edge_at[k] = if step[k] > 0.0 { 1.0 } else { 0.0 };
            let own = edges_at(edge_at)[k]?;
            let Side::Joint { patch, edge, reversed, stands_out } = self.side(piece, own) else {
                return None;
            };
            if stands_out.contains(&true) {
                return None;
            }
            let here = self.jet(piece, edge_at);
            let left = (here.du * step[0] + here.dv * step[1]) * (1.0 - part);
            at = edge.parameters(along(own, edge_at, reversed));
            let there = self.jet(patch, at);
            let [a, b, c] = [there.du.norm_squared(), there.du.dot(&there.dv), there.dv.norm_squared()];
            let determinant = a * c - b * b;
            if determinant <= 0.0 {
                return None;
            }
            let (x, y) = (left.dot(&there.du), left.dot(&there.dv));
            step = [(c * x - b * y) / determinant, (a * y - b * x) / determinant];
            piece = patch;
        }
        None
    }

    /// Direction of all rulings.
    pub(super) fn common_ruling(&self) -> Option<Vec3> {
        self.ruling
    }

    /// Greatest absolute value of a principal curvature, 1/length, looked at in places of the definition's patches.
    pub fn greatest_curvature(&self) -> f64 {
        self.curvature
    }
}

/// The parameter along an edge at a place of it, as the neighbour counts it.
fn along(own: Edge, at: [f64; 2], reversed: bool) -> f64 {
    let t = match own {
        Edge::LowU | Edge::HighU => at[1],
        Edge::LowV | Edge::HighV => at[0],
    };
    if reversed { 1.0 - t } else { t }
}

#[cfg(test)]
pub(super) mod tests;

//! A sculptured surface as a tool meets it in motions: patches turned so that `∂u × ∂v` is the natural normal, and straight
//! patches along the tangents beyond the outer edges (reference on sculptured surfaces 2.3: contacts are solved on the
//! ruled extension).

use std::{collections::VecDeque, sync::Arc};

use super::{
    basis::Homogeneous,
    patch::Patch,
    surface::SculpturedSurface,
    topology::{self, Edge, Neighbour},
};
use crate::{
    Vec3,
    canonical::{Made, Remembering},
};

/// How far the straight patches reach, in sizes of the surface.
pub const SCULPTURED_BEYOND: f64 = 0.1;
/// Length of an edge, relative to the surface, below which it is a point.
const COLLAPSED: f64 = 1e-9;
/// Length of the difference of two unit normals below which patches join smoothly.
const SMOOTH: f64 = 1e-7;
/// Parameters of edges where normals are compared and extensions are tried.
const PROBES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// Share of its length that an extension must be away from the surface: it is cut short where it comes back to another part.
const AWAY: f64 = 0.7;
/// Cosine of the angle between the normals at the beginning and at the end of an extension below which it is cut short.
const LEAST_COSINE: f64 = 0.3;
/// Share of the speed along its edge that an extension keeps to its end: rulings do not come nearer to each other.
const LEAST_SPREAD: f64 = 0.1;
/// Halvings of an extension; one that must be shorter is left out.
const MOST_HALVINGS: u32 = 7;

/// What is beyond an edge of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// The surface ends.
    End,
    /// The edge is a point.
    Point,
    /// Another patch.
    Joint {
        /// Index of the other patch.
        patch: usize,
        /// Its edge.
        edge: Edge,
        /// Whether its edge runs against this one.
        reversed: bool,
        /// Whether the surface has an edge here that stands out to the natural side, and to the other.
        stands_out: [bool; 2],
    },
}

impl Side {
    /// Whether the surface has an edge here.
    pub fn is_crease(&self) -> bool {
        matches!(self, Self::Joint { stands_out, .. } if stands_out.contains(&true))
    }
}

/// A patch and what is around it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExtendedPatch {
    /// The patch; `∂u × ∂v` is along the natural normal.
    pub patch: Patch,
    /// What is beyond its edges, by their numbers.
    pub sides: [Side; 4],
}

/// Straight patches that share rulings: how far they go, and the share of the second row of control points that keeps all weights
/// positive.
#[derive(Debug, Clone, Copy)]
struct Reach {
    steps: f64,
    share: f64,
}

/// An edge that is to go on.
#[derive(Debug, Clone, Copy)]
struct Outer {
    patch: usize,
    edge: Edge,
    chain: usize,
}

/// The patches that motions see, kept with the definition of their surface.
#[derive(Debug)]
pub struct Extended(Vec<ExtendedPatch>);

impl Made for Extended {
    fn parts(&self) -> usize {
        self.0.len()
    }
}

impl Extended {
    /// Those of a surface: first its own in their order, then the extensions. `None` if its numbers are none.
    pub fn of(surface: &Remembering<SculpturedSurface>) -> Option<Arc<Self>> {
        surface.made(|definition| definition.is_finite().then(|| Self(definition.extended())))
    }

    /// The patches.
    pub fn patches(&self) -> &[ExtendedPatch] {
        &self.0
    }
}

impl SculpturedSurface {
    /// The patches that motions see: first those of the surface in their order, then the extensions.
    pub fn extended(&self) -> Vec<ExtendedPatch> {
        let size = self.size();
        let mut patches = self.oriented();
        let around = topology::neighbours(&patches);
        let mut outer = open_edges(&patches, &around, size);
        let chains = chained(&mut outer, &around);
        let reaches: Vec<Option<Reach>> =
            (0..chains).map(|chain| self.reach(&patches, &outer, chain, size)).collect();
        let of = |patch: usize, edge: Edge| {
            let found = outer.iter().find(|one| one.patch == patch && one.edge == edge)?;
            reaches.get(found.chain).copied().flatten()
        };
        let mut added = Vec::new();
        for (index, patch) in patches.iter().enumerate() {
            let by_edge = Edge::ALL.map(|edge| of(index, edge));
            for edge in Edge::ALL {
                let Some(reach) = by_edge[edge.number()] else { continue };
                added.extend(beyond(patch, edge, &reach));
            }
            for (first, second) in
                [Edge::LowU, Edge::HighU].into_iter().flat_map(|u| [Edge::LowV, Edge::HighV].map(|v| (u, v)))
            {
                let (Some(a), Some(b)) = (by_edge[first.number()], by_edge[second.number()]) else {
                    continue;
                };
                let corner = beyond(patch, first, &a).and_then(|next_to| beyond(&next_to, second, &b));
                let joints = [joint(first)[0], joint(second)[1]];
                added.extend(corner.filter(|corner| spreads(corner, joints)));
            }
        }
        patches.extend(added);
        joined(&patches, size)
    }

    /// The patches with `∂u × ∂v` to one side, that of the sign word for the first patch of each connected part.
    fn oriented(&self) -> Vec<Patch> {
        let turn = |(patch, sense): (&Patch, f64)| if sense < 0.0 { patch.swapped() } else { *patch };
        self.patches.iter().zip(self.senses()).map(turn).collect()
    }

    /// The sign of the natural normal in `∂u × ∂v` of each patch: that of the sign word for the first patch of each connected part, from which it
    /// goes over joints to the others.
    pub fn senses(&self) -> Vec<f64> {
        let mut signs: Vec<Option<f64>> = vec![None; self.patches.len()];
        let mut open = VecDeque::new();
        for first in 0..signs.len() {
            if signs[first].is_none() {
                signs[first] = Some(self.side);
                open.push_back((first, self.side));
            }
            while let Some((index, sign)) = open.pop_front() {
                let around = self.neighbours.get(index).copied().unwrap_or_default();
                for (edge, neighbour) in Edge::ALL.into_iter().zip(around) {
                    let Some(Neighbour { patch, edge: other, reversed, .. }) = neighbour else { continue };
                    let same = (winding(edge) * winding(other) < 0.0) != reversed;
                    let sign = if same { sign } else { -sign };
                    if let Some(known @ None) = signs.get_mut(patch) {
                        *known = Some(sign);
                        open.push_back((patch, sign));
                    }
                }
            }
        }
        signs.into_iter().map(|sign| sign.unwrap_or(self.side)).collect()
    }

    /// How far the extensions of a chain of edges go: until they fold or come back to the surface.
    fn reach(&self, patches: &[Patch], outer: &[Outer], chain: usize, size: f64) -> Option<Reach> {
        let own: Vec<&Outer> = outer.iter().filter(|one| one.chain == chain).collect();
        let rows = |one: &Outer| patches.get(one.patch).map(|patch| two_rows(patch, one.edge));
        let all: Vec<_> = own.iter().filter_map(|one| rows(one)).collect();
        let ratios = all.iter().flat_map(|[edge, next]| edge.iter().zip(next).map(|(a, b)| a.w / b.w));
        let share = ratios.fold(f64::INFINITY, f64::min);
        let place = |point: &Homogeneous| point.xyz() / point.w;
        let lengths = all.iter().flat_map(|[edge, next]| {
            edge.iter().zip(next).map(|(a, b)| (place(a) - place(b)).norm() * share * b.w / a.w)
        });
        let longest = lengths.fold(0.0, f64::max);
        if !(longest > COLLAPSED * size && share.is_finite()) {
            return None;
        }
        let mut reach = Reach { steps: SCULPTURED_BEYOND * size / longest, share };
        for _ in 0..MOST_HALVINGS {
            let fits = own.iter().all(|one| {
                patches.get(one.patch).is_some_and(|patch| {
                    beyond(patch, one.edge, &reach).is_some_and(|straight| {
                        spreads(&straight, joint(one.edge)) && self.is_away(&straight, one.edge)
                    })
                })
            });
            if fits {
                return Some(reach);
            }
            reach.steps *= 0.5;
        }
        None
    }

    /// Whether the far end of an extension is not near another part of the surface.
    fn is_away(&self, straight: &Patch, edge: Edge) -> bool {
        PROBES.iter().all(|t| {
            let ([u, v], [s, w]) = (edge.parameters(*t), opposite(edge).parameters(*t));
            let far = straight.evaluate(u, v).position;
            let length = (far - straight.evaluate(s, w).position).norm();
            self.keeps_off(&far, AWAY * length)
        })
    }
}

/// Whether an edge runs about the patch as u turns to v, or against that.
fn winding(edge: Edge) -> f64 {
    match edge {
        Edge::LowV | Edge::HighU => 1.0,
        Edge::HighV | Edge::LowU => -1.0,
    }
}

pub(super) fn opposite(edge: Edge) -> Edge {
    match edge {
        Edge::LowU => Edge::HighU,
        Edge::HighU => Edge::LowU,
        Edge::LowV => Edge::HighV,
        Edge::HighV => Edge::LowV,
    }
}

/// The control points of an edge, and those next to it.
pub(super) fn two_rows(patch: &Patch, edge: Edge) -> [[Homogeneous; 4]; 2] {
    let c = &patch.control;
    match edge {
        Edge::LowU => [c[0], c[1]],
        Edge::HighU => [c[3], c[2]],
        Edge::LowV => [c.map(|row| row[0]), c.map(|row| row[1])],
        Edge::HighV => [c.map(|row| row[3]), c.map(|row| row[2])],
    }
}

/// The straight patch beyond an edge, along the tangents across it; `None` where a weight would not be positive.
fn beyond(patch: &Patch, edge: Edge, reach: &Reach) -> Option<Patch> {
    let [own, next] = two_rows(patch, edge);
    // From the edge outward; a line is a cubic with evenly spaced control points.
    let rows: [[Homogeneous; 4]; 4] = std::array::from_fn(|k| {
        let way = reach.steps * k as f64 / 3.0;
        std::array::from_fn(|i| own[i] + (own[i] - next[i] * reach.share) * way)
    });
    if rows.iter().flatten().any(|point| point.w <= 0.0 || !point.w.is_finite()) {
        return None;
    }
    Some(outward(rows, edge))
}

/// The patch of rows of control points from an edge outward, with the parameters of the patch that it joins.
pub(super) fn outward([a, b, c, d]: [[Homogeneous; 4]; 4], edge: Edge) -> Patch {
    let along_u = match edge {
        Edge::LowU | Edge::LowV => [d, c, b, a],
        Edge::HighU | Edge::HighV => [a, b, c, d],
    };
    let patch = Patch { control: along_u };
    if matches!(edge, Edge::LowV | Edge::HighV) { patch.swapped() } else { patch }
}

/// Where a straight patch beyond an edge joins: the parameter across it, by its side.
pub(super) fn joint(edge: Edge) -> [Option<f64>; 2] {
    match edge {
        Edge::LowU => [Some(1.0), None],
        Edge::HighU => [Some(0.0), None],
        Edge::LowV => [None, Some(1.0)],
        Edge::HighV => [None, Some(0.0)],
    }
}

/// Whether a straight patch keeps facing the way it does at its joint, and its rulings do not meet.
pub(super) fn spreads(straight: &Patch, joint: [Option<f64>; 2]) -> bool {
    let size = straight.size();
    let places = [0.0, 0.5, 1.0].into_iter().flat_map(|u| [0.0, 0.5, 1.0].map(|v| [u, v]));
    places.into_iter().all(|[u, v]| {
        let at = straight.evaluate(u, v);
        let near = straight.evaluate(joint[0].unwrap_or(u), joint[1].unwrap_or(v));
        let normals = [&at, &near].map(|at| at.regular_normal());
        let [Some(n), Some(m)] = normals else {
            // Rulings beside a pole have no breadth.
            return near.du.norm().min(near.dv.norm()) <= COLLAPSED * size;
        };
        let kept = |far: &Vec3, own: &Vec3, side: usize| {
            let least = if joint[side].is_some() { 0.0 } else { LEAST_SPREAD * own.norm_squared() };
            far.dot(own) > least
        };
        n.dot(&m) >= LEAST_COSINE && kept(&at.du, &near.du, 0) && kept(&at.dv, &near.dv, 1)
    })
}

/// The edges beyond which there is nothing, each in a chain of its own.
fn open_edges(patches: &[Patch], around: &[[Option<Neighbour>; 4]], size: f64) -> Vec<Outer> {
    let mut outer: Vec<Outer> = Vec::new();
    for (index, patch) in patches.iter().enumerate() {
        let known = around.get(index).copied().unwrap_or_default();
        for edge in Edge::ALL {
            if known[edge.number()].is_none() && !is_point(patch, edge, size) {
                outer.push(Outer { patch: index, edge, chain: outer.len() });
            }
        }
    }
    outer
}

fn is_point(patch: &Patch, edge: Edge, size: f64) -> bool {
    let arc = patch.edge(edge);
    let first = arc.evaluate(0.0).position;
    PROBES.iter().all(|t| (arc.evaluate(*t).position - first).norm() <= COLLAPSED * size)
}

/// Puts edges that follow each other, with a joint between their patches, into one chain; returns how many there are.
fn chained(outer: &mut [Outer], around: &[[Option<Neighbour>; 4]]) -> usize {
    let mut joints = Vec::new();
    for (k, one) in outer.iter().enumerate() {
        let beside = match one.edge {
            Edge::LowU | Edge::HighU => [Edge::LowV, Edge::HighV],
            Edge::LowV | Edge::HighV => [Edge::LowU, Edge::HighU],
        };
        for side in beside {
            let known = around.get(one.patch).and_then(|around| around[side.number()]);
            let Some(Neighbour { patch, edge, reversed, .. }) = known else { continue };
            // The corner, along the joint, and the other edge there.
            let here = matches!(one.edge, Edge::HighU | Edge::HighV);
            let there = here != reversed;
            let next = match (edge, there) {
                (Edge::LowU | Edge::HighU, false) => Edge::LowV,
                (Edge::LowU | Edge::HighU, true) => Edge::HighV,
                (Edge::LowV | Edge::HighV, false) => Edge::LowU,
                (Edge::LowV | Edge::HighV, true) => Edge::HighU,
            };
            let found = outer.iter().position(|other| other.patch == patch && other.edge == next);
            joints.extend(found.map(|other| (k, other)));
        }
    }
    // The least number spreads along each chain.
    let mut changed = true;
    while changed {
        changed = false;
        for &(a, b) in &joints {
            let (Some(one), Some(other)) = (outer.get(a), outer.get(b)) else { continue };
            let least = one.chain.min(other.chain);
            changed |= one.chain != other.chain;
            for k in [a, b] {
                if let Some(one) = outer.get_mut(k) {
                    one.chain = least;
                }
            }
        }
    }
    outer.len()
}

/// The patches with what is around them.
pub(super) fn joined(patches: &[Patch], size: f64) -> Vec<ExtendedPatch> {
    let around = topology::neighbours(patches);
    let side = |index: usize, edge: Edge| {
        let Some(patch) = patches.get(index) else { return Side::End };
        match around.get(index).and_then(|around| around[edge.number()]) {
            Some(neighbour) => {
                let stands_out = patches
                    .get(neighbour.patch)
                    .map_or([true; 2], |other| stands_out(patch, edge, other, &neighbour));
                let Neighbour { patch, edge, reversed, .. } = neighbour;
                Side::Joint { patch, edge, reversed, stands_out }
            }
            None if is_point(patch, edge, size) => Side::Point,
            None => Side::End,
        }
    };
    let sides: Vec<[Side; 4]> =
        (0..patches.len()).map(|index| Edge::ALL.map(|edge| side(index, edge))).collect();
    patches.iter().zip(sides).map(|(patch, sides)| ExtendedPatch { patch: *patch, sides }).collect()
}

/// To which sides the surface has an edge that stands out at a joint.
fn stands_out(patch: &Patch, edge: Edge, other: &Patch, joint: &Neighbour) -> [bool; 2] {
    let mut found = [false; 2];
    for t in PROBES {
        let ([u, v], [s, w]) =
            (edge.parameters(t), joint.edge.parameters(if joint.reversed { 1.0 - t } else { t }));
        let (here, there) = (patch.evaluate(u, v), other.evaluate(s, w));
        let (Some(a), Some(b)) = (here.regular_normal(), there.regular_normal()) else { continue };
        if (a - b).norm() <= SMOOTH {
            continue;
        }
        let along = match edge {
            Edge::LowU | Edge::HighU => here.dv,
            Edge::LowV | Edge::HighV => here.du,
        };
        // Out of this patch and into the other one, square to the edge. About the patch, its inside is to the left.
        let (Some(out), Some(into)) = (
            along.cross(&a).try_normalize(0.0).map(|way| way * winding(edge)),
            along.cross(&b).try_normalize(0.0).map(|way| way * winding(edge)),
        ) else {
            return [true; 2];
        };
        let turn = (into - out).dot(&(a + b));
        found = [found[0] || turn <= 0.0, found[1] || turn >= 0.0];
    }
    found
}

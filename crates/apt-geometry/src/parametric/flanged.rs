//! A sculptured surface as a tool on one side of it meets it. Where the surface, with what goes on beyond it, ends there is nothing
//! more, and on which side of nothing a place is cannot be said. So the surface is taken for the face of a body there: a flange leads away
//! from its end, square to it, on the side where the tool is not. A tool that is higher than the surface touches its end from the
//! side and is beside it, as it would be beside a sheet of metal.

use std::sync::Arc;

use super::{
    basis::{Homogeneous, direction},
    extended::{
        Extended, ExtendedPatch, SCULPTURED_BEYOND, Side, joined, joint, opposite, outward, spreads, two_rows,
    },
    patch::Patch,
    surface::SculpturedSurface,
    topology::Edge,
};
use crate::{
    Vec3,
    canonical::{Made, Remembering},
};

/// Distance, relative to the surface, within which ends of edges are one place.
const SAME_PLACE: f64 = 1e-6;
/// Share of the way to the middle of a patch at which the normal is taken where a place has none.
const INWARD: f64 = 1e-5;
/// Share of its length that the far end of a flange must be away from the surface.
const AWAY: f64 = 0.7;
/// Length of a sum of unit normals below which they are opposed.
const OPPOSED: f64 = 1e-6;
/// Parameters through which a cubic is laid.
const THIRDS: [f64; 4] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
/// Parameters of edges where that is looked at.
const PROBES: [f64; 3] = [0.0, 0.5, 1.0];
/// Halvings of the flanges' length; those that must be shorter are left out.
const MOST_HALVINGS: u32 = 7;

/// An edge at which the surface ends.
#[derive(Debug, Clone, Copy)]
struct End {
    patch: usize,
    edge: Edge,
}

/// An end of such an edge.
#[derive(Debug, Clone, Copy)]
struct Corner {
    place: Vec3,
    normal: Vec3,
    edge: usize,
    last: bool,
}

/// What a tool meets on either side of a surface: first that of the natural normal.
#[derive(Debug, PartialEq)]
pub struct Flanged([Vec<ExtendedPatch>; 2]);

impl Made for Flanged {
    fn parts(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }
}

impl Flanged {
    /// Of a surface. `None` if its numbers are none.
    pub fn of(surface: &Remembering<SculpturedSurface>) -> Option<Arc<Self>> {
        let extended = Extended::of(surface)?;
        surface.made(|definition| {
            Some(Self([1.0, -1.0].map(|side| definition.flanged(extended.patches(), side))))
        })
    }

    /// The patches met on a side, positive for that of the natural normal: first those of the surface with their extensions, then the
    /// flanges.
    pub fn patches(&self, side: f64) -> &[ExtendedPatch] {
        let [natural, other] = &self.0;
        if side > 0.0 { natural } else { other }
    }
}

impl SculpturedSurface {
    fn flanged(&self, extended: &[ExtendedPatch], side: f64) -> Vec<ExtendedPatch> {
        let size = self.size();
        let edges = ends(extended);
        let normals = normals(extended, &edges, size);
        let of = |length: f64| {
            let made = edges.iter().zip(&normals).map(move |(end, normals)| {
                let patch = extended.get(end.patch)?;
                let flange = flange(&patch.patch, end.edge, normals.map(|n| n * -side * length));
                (spreads(&flange, joint(end.edge)) && self.clears(&flange, end.edge)).then_some(flange)
            });
            made.collect::<Vec<Option<Patch>>>()
        };
        let mut length = SCULPTURED_BEYOND * size;
        let mut found = of(length);
        for _ in 0..MOST_HALVINGS {
            if found.iter().all(Option::is_some) {
                break;
            }
            length *= 0.5;
            found = of(length);
        }
        let mut patches: Vec<Patch> = extended.iter().map(|piece| piece.patch).collect();
        patches.extend(found.into_iter().flatten());
        joined(&patches, size)
    }

    /// Whether the far end of a flange is not near another part of the surface.
    fn clears(&self, flange: &Patch, edge: Edge) -> bool {
        PROBES.iter().all(|t| {
            let ([u, v], [s, w]) = (edge.parameters(*t), opposite(edge).parameters(*t));
            let far = flange.evaluate(u, v).position;
            self.keeps_off(&far, AWAY * (far - flange.evaluate(s, w).position).norm())
        })
    }
}

/// The edges at which the surface ends.
fn ends(pieces: &[ExtendedPatch]) -> Vec<End> {
    let of = |(patch, piece): (usize, &ExtendedPatch)| {
        let ended = Edge::ALL.into_iter().zip(piece.sides).filter(|(_, side)| *side == Side::End);
        ended.map(|(edge, _)| End { patch, edge }).collect::<Vec<_>>()
    };
    pieces.iter().enumerate().flat_map(of).collect()
}

/// Unit normals along each edge, at both its ends and at its thirds; where edges meet that of all their patches together, so that
/// flanges join.
fn normals(pieces: &[ExtendedPatch], edges: &[End], size: f64) -> Vec<[Vec3; 4]> {
    let patch = |end: &End| pieces.get(end.patch).map(|piece| &piece.patch);
    let along = |end: &End| {
        THIRDS.map(|t| patch(end).map_or_else(Vec3::z, |patch| normal(patch, end.edge.parameters(t))))
    };
    let own: Vec<[Vec3; 4]> = edges.iter().map(along).collect();
    // Both ends of each edge, from the first to the last along one coordinate.
    let corner = |k: usize, last: bool| {
        let [u, v] = edges[k].edge.parameters(if last { 1.0 } else { 0.0 });
        let place = patch(&edges[k]).map_or_else(Vec3::zeros, |patch| patch.evaluate(u, v).position);
        Corner { place, edge: k, last, normal: own[k][if last { 3 } else { 0 }] }
    };
    let mut corners: Vec<Corner> =
        (0..edges.len()).flat_map(|k| [false, true].map(|last| corner(k, last))).collect();
    corners.sort_by(|a, b| a.place.x.total_cmp(&b.place.x));
    let close = SAME_PLACE * size;
    let mut found = own.clone();
    for (rank, here) in corners.iter().enumerate() {
        let within = |other: &&Corner| (other.place.x - here.place.x).abs() <= close;
        let first = rank - corners[..rank].iter().rev().take_while(within).count();
        let around = corners[first..].iter().take_while(within);
        let meeting = around.filter(|other| (other.place - here.place).norm() <= close);
        let sum: Vec3 = meeting.map(|other| other.normal).sum();
        if let Some(normal) = sum.try_normalize(OPPOSED) {
            found[here.edge][if here.last { 3 } else { 0 }] = normal;
        }
    }
    found
}

/// The natural normal at a place of a patch; where it has none that a little way inside.
fn normal(patch: &Patch, at: [f64; 2]) -> Vec3 {
    let of = |[u, v]: [f64; 2]| patch.evaluate(u, v).regular_normal();
    of(at).or_else(|| of(at.map(|t| t + INWARD * (0.5 - t)))).unwrap_or_else(Vec3::z)
}

/// The patch that leads from an edge by the ways given at its ends and thirds.
fn flange(patch: &Patch, edge: Edge, [first, second, third, last]: [Vec3; 4]) -> Patch {
    let own = two_rows(patch, edge)[0];
    // The control points of the cubic through the four.
    let ways = [
        first,
        (second * 18.0 - third * 9.0 - first * 5.0 + last * 2.0) / 6.0,
        (third * 18.0 - second * 9.0 - last * 5.0 + first * 2.0) / 6.0,
        last,
    ];
    // From the edge on; a line is a cubic with evenly spaced control points.
    let row = |share: f64| -> [Homogeneous; 4] {
        std::array::from_fn(|i| own[i] + direction(&(ways[i] * (share * own[i].w))))
    };
    outward(THIRDS.map(row), edge)
}

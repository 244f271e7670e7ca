//! How far two chains are from each other: the greatest distance of a place of one from the nearest one of the other (Hausdorff).

use std::collections::BinaryHeap;

use apt_geometry::Vec3;
use rstar::RTree;

use super::rejoin::Chord;

/// A chain of tool ends with their axes.
type Chain = [[Vec3; 2]];

/// How far two stretches are from each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Apart {
    /// The greatest distance of a place of one from the nearest one of the other, in the unit of the paths, to a thousandth.
    pub distance: f64,
    /// The place that is so far away.
    pub at: Vec3,
    /// The greatest angle between the axes at places nearest to each other, radians.
    pub turned: f64,
}

/// How far is told to this fraction of itself.
const PRECISION: f64 = 1e-3;

/// How far two chains are from each other; to `close` or a thousandth.
pub(super) fn apart(chains: [&Chain; 2], close: f64) -> Apart {
    let [first, second] = [[chains[0], chains[1]], [chains[1], chains[0]]].map(|[own, other]| {
        let tree = tree_of(other);
        let (distance, at) = farthest(own, &tree, close);
        Apart { distance, at, turned: turned(own, other, &tree) }
    });
    let turned = first.turned.max(second.turned);
    if second.distance > first.distance { Apart { turned, ..second } } else { Apart { turned, ..first } }
}

fn tree_of(chain: &Chain) -> RTree<Chord> {
    let chord = |(vector, ends): (usize, &[[Vec3; 2]])| Chord { vector, ends: [ends[0][0], ends[1][0]] };
    RTree::bulk_load(chain.windows(2).enumerate().map(chord).collect())
}

/// A piece of a chain with the most that one of its places can be from the other chain.
struct Piece {
    most: f64,
    ends: [Vec3; 2],
}

impl Piece {
    /// The distance from one chord is a convex function along a straight way, nowhere above its ends; and a distance grows no faster than the way.
    fn bound(ends: &[Vec3; 2], nearest: [&Chord; 2]) -> f64 {
        let distances = |chord: &Chord| ends.map(|end| chord.distance(&end));
        let [[start, far], [near, end]] = nearest.map(distances);
        let by_length = (start + end + (ends[1] - ends[0]).norm()) / 2.0;
        by_length.min(start.max(far)).min(near.max(end))
    }
}

impl PartialEq for Piece {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Piece {}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.most.total_cmp(&other.most)
    }
}

/// The place of a chain that is farthest from another one. The piece that may be farthest is halved until none may be so by more than is told.
fn farthest(own: &Chain, other: &RTree<Chord>, close: f64) -> (f64, Vec3) {
    let nearest = |place: Vec3| other.nearest_neighbor(place.into());
    let mut best = (0.0, own.first().map_or_else(Vec3::zeros, |first| first[0]));
    let mut waiting = BinaryHeap::new();
    let mut pieces: Vec<[Vec3; 2]> = own.windows(2).map(|ends| [ends[0][0], ends[1][0]]).collect();
    loop {
        for ends in pieces.drain(..) {
            let [Some(from), Some(to)] = ends.map(nearest) else { return best };
            for (chord, end) in [(from, ends[0]), (to, ends[1])] {
                let distance = chord.distance(&end);
                if distance > best.0 {
                    best = (distance, end);
                }
            }
            waiting.push(Piece { most: Piece::bound(&ends, [from, to]), ends });
        }
        let Some(widest) = waiting.pop() else { return best };
        let is_told = widest.most <= best.0 + close.max(best.0 * PRECISION);
        let [from, to] = widest.ends;
        let middle = (from + to) / 2.0;
        if is_told || middle == from || middle == to {
            return best;
        }
        pieces.extend([[from, middle], [middle, to]]);
    }
}

/// The greatest angle between the axis at a place of a chain and that at the nearest place of another one.
fn turned(own: &Chain, other: &Chain, tree: &RTree<Chord>) -> f64 {
    let angle = |[position, axis]: &[Vec3; 2]| {
        let chord = tree.nearest_neighbor((*position).into())?;
        let [from, to] = [other[chord.vector][1], other[chord.vector + 1][1]];
        let there = from + (to - from) * chord.nearest(position);
        Some(axis.cross(&there).norm().atan2(axis.dot(&there)))
    };
    own.iter().filter_map(angle).fold(0.0, f64::max)
}

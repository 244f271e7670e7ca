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
struct Piece<'a> {
    most: f64,
    ends: [Vec3; 2],
    /// The chords of the other chain nearest to both ends.
    nearest: [&'a Chord; 2],
}

impl<'a> Piece<'a> {
    /// The distance from one chord is a convex function along a straight way, nowhere above its ends; and a distance grows no faster than the way.
    fn new(ends: [Vec3; 2], nearest: [&'a Chord; 2]) -> Self {
        let distances = |chord: &Chord| ends.map(|end| chord.distance(&end));
        let [[start, far], [near, end]] = nearest.map(distances);
        let by_length = (start + end + (ends[1] - ends[0]).norm()) / 2.0;
        let most = by_length.min(start.max(far)).min(near.max(end));
        Self { most, ends, nearest }
    }

    /// Where to divide it: where both chords are as near, so that one of them bounds either part closely; else in the middle.
    fn divide(&self) -> Option<Vec3> {
        let [from, to] = self.ends;
        let at = |part: f64| from + (to - from) * part;
        let first_is_nearer =
            |part: f64| self.nearest[0].distance(&at(part)) <= self.nearest[1].distance(&at(part));
        let mut within = [0.0, 1.0];
        if first_is_nearer(0.0) && !first_is_nearer(1.0) {
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(within[0], within[1]);
                within[usize::from(!first_is_nearer(middle))] = middle;
            }
        }
        let place = at(f64::midpoint(within[0], within[1]));
        (place != from && place != to).then_some(place)
    }
}

/// Halvings that tell a place of a piece to a millionth.
const HALVINGS: usize = 20;

impl PartialEq for Piece<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Piece<'_> {}

impl PartialOrd for Piece<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Piece<'_> {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.most.total_cmp(&other.most)
    }
}

/// The place of a chain that is farthest from another one. The piece that may be farthest is divided until none may be so by more than is told.
fn farthest(own: &Chain, other: &RTree<Chord>, close: f64) -> (f64, Vec3) {
    let nearest = |place: &Vec3| other.nearest_neighbor((*place).into()).map(|chord| (*place, chord));
    let places: Vec<(Vec3, &Chord)> = own.iter().filter_map(|[position, _]| nearest(position)).collect();
    let first = (0.0, own.first().map_or_else(Vec3::zeros, |first| first[0]));
    let farther = |best: (f64, Vec3), (place, chord): &(Vec3, &Chord)| {
        let distance = chord.distance(place);
        if distance > best.0 { (distance, *place) } else { best }
    };
    let mut best = places.iter().fold(first, farther);
    let pieces = places.windows(2).map(|ends| Piece::new([ends[0].0, ends[1].0], [ends[0].1, ends[1].1]));
    let mut waiting: BinaryHeap<Piece<'_>> = pieces.collect();
    while let Some(widest) = waiting.pop() {
        let is_told = widest.most <= best.0 + close.max(best.0 * PRECISION);
        let divided = widest.divide().filter(|_| !is_told).and_then(|place| nearest(&place));
        let Some((place, chord)) = divided else { return best };
        best = farther(best, &(place, chord));
        waiting.push(Piece::new([widest.ends[0], place], [widest.nearest[0], chord]));
        waiting.push(Piece::new([place, widest.ends[1]], [chord, widest.nearest[1]]));
    }
    best
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

//! Boxes about the intervals of a directrix, in a tree by which the nearest ones are found first.

use super::Vec2;

/// Depth of a tree of as many leaves as a number of 32 bits counts.
const DEPTH: usize = u32::BITS as usize;

/// A box with sides along the axes of the plane, by its least and greatest coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct UprightBox {
    least: Vec2,
    greatest: Vec2,
}

impl UprightBox {
    /// No place; infinitely far from all.
    pub(super) const NOWHERE: Self = Self {
        least: Vec2::new(f64::INFINITY, f64::INFINITY),
        greatest: Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The box that holds a point, too.
    pub(super) fn with(self, p: Vec2) -> Self {
        Self { least: self.least.inf(&p), greatest: self.greatest.sup(&p) }
    }

    /// The box with the quadrants towards a direction, from all of its places on.
    pub(super) fn open_towards(self, way: Vec2) -> Self {
        let [x, y] = [way.x, way.y];
        let open = |is_so: bool, limit: f64, value: f64| if is_so { limit } else { value };
        let (below, above) = (f64::NEG_INFINITY, f64::INFINITY);
        let least = Vec2::new(open(x < 0.0, below, self.least.x), open(y < 0.0, below, self.least.y));
        let greatest =
            Vec2::new(open(x > 0.0, above, self.greatest.x), open(y > 0.0, above, self.greatest.y));
        Self { least, greatest }
    }

    fn around(self, other: Self) -> Self {
        Self { least: self.least.inf(&other.least), greatest: self.greatest.sup(&other.greatest) }
    }

    /// Squared distance of a point.
    pub(super) fn square(&self, p: Vec2) -> f64 {
        let aside = |least: f64, x: f64, greatest: f64| (least - x).max(x - greatest).max(0.0);
        let x = aside(self.least.x, p.x, self.greatest.x);
        let y = aside(self.least.y, p.y, self.greatest.y);
        x * x + y * y
    }
}

/// A tree of boxes: that of node k holds those of 2k and 2k + 1, the root is 1, the leaves are the second half.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Boxes {
    nodes: Vec<UprightBox>,
}

impl Boxes {
    pub(super) fn of(leaves: impl ExactSizeIterator<Item = UprightBox>) -> Self {
        let half = leaves.len().next_power_of_two();
        let mut nodes = vec![UprightBox::NOWHERE; half];
        nodes.extend(leaves);
        nodes.resize(2 * half, UprightBox::NOWHERE);
        for k in (1..half).rev() {
            nodes[k] = nodes[2 * k].around(nodes[2 * k + 1]);
        }
        Self { nodes }
    }

    /// The number of the leaf at a node, if that is one.
    pub(super) fn leaf(&self, node: usize) -> Option<usize> {
        node.checked_sub(self.nodes.len() / 2)
    }

    /// The middle of the box of a node and half its sides, if it has ends; that of no place is infinitely far in.
    pub(super) fn extent(&self, node: usize) -> Option<[Vec2; 2]> {
        let UprightBox { least, greatest } = self.nodes.get(node)?;
        let [middle, half] = [(greatest + least) * 0.5, (greatest - least) * 0.5];
        let has_ends = middle.iter().chain(&half).all(|x| x.is_finite());
        has_ends.then_some([middle, half])
    }

    /// Tells of leaves by their number, those in nearer boxes first, while their boxes are not farther than the nearest known,
    /// of which the answer tells the squared distance.
    pub(super) fn visit(&self, p: Vec2, mut leaf: impl FnMut(usize, f64) -> f64) {
        let half = self.nodes.len() / 2;
        let mut nearest = f64::INFINITY;
        let mut open = [(0, 0.0); DEPTH];
        let mut count = 1;
        open[0] = (1, 0.0);
        while count > 0 {
            count -= 1;
            let (node, square) = open[count];
            if square > nearest {
                continue;
            }
            if node >= half {
                nearest = leaf(node - half, nearest);
                continue;
            }
            let at = |k: usize| (k, self.nodes[k].square(p));
            let (first, other) = (at(2 * node), at(2 * node + 1));
            let (near, far) = if other.1 < first.1 { (other, first) } else { (first, other) };
            // What is infinitely far is no leaf.
            for child in [far, near] {
                if child.1 <= nearest && child.1 < f64::INFINITY {
                    open[count] = child;
                    count += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_nearest_of_many_points_is_found(
            points in proptest::collection::vec([-9.0..9.0f64, -9.0..9.0f64], 1..200),
            p in [-12.0..12.0f64, -12.0..12.0f64],
        ) {
            let points: Vec<Vec2> = points.into_iter().map(Vec2::from).collect();
            let boxes = Boxes::of(points.iter().map(|q| UprightBox::NOWHERE.with(*q)));
            let p = Vec2::from(p);
            let square = |q: &Vec2| (q - p).norm_squared();
            let mut best = f64::INFINITY;
            boxes.visit(p, |k, _| {
                best = best.min(square(&points[k]));
                best
            });
            prop_assert_eq!(best, points.iter().map(square).fold(f64::INFINITY, f64::min));
        }

        #[test]
        fn along_a_row_few_are_looked_at(count in 16..400usize, x in -1.0..2.0f64) {
            let at = |k: usize| Vec2::new(k as f64, 0.0);
            let boxes = Boxes::of((0..count).map(|k| UprightBox::NOWHERE.with(at(k)).with(at(k + 1))));
            let p = Vec2::new(x * count as f64, 0.0);
            let mut looks = 0;
            boxes.visit(p, |k, nearest| {
                looks += 1;
                let near = p.x.clamp(k as f64, k as f64 + 1.0);
                nearest.min((p.x - near) * (p.x - near))
            });
            prop_assert!((1..=2).contains(&looks), "{looks}");
        }
    }
}

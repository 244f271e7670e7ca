//! The tree of a sculptured surface: balls about nearly flat parts of patches.

use super::{
    super::{
        part::{Part, Rectangle},
        sheet::Jet,
    },
    SculpturedSheet,
    bounds::Stretch,
};
use crate::{Vec3, patience::Patience};

/// Bound of the halvings of a patch: those at a pole go on to it.
const MAX_DEPTH: u32 = 12;
/// Units of work that it takes to bound a part.
const UNITS_A_PART: u32 = 8;
/// Radius, relative to the surface, below which a part is not halved.
const SMALLEST: f64 = 1e-3;
/// Chord of the greatest turn of the normal over a leaf, which then has one valley of the distance from near places.
const TURN: f64 = 0.35;

/// A node of the tree.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    /// Two nodes and a ball about both.
    Fork {
        /// Centre of the ball.
        center: Vec3,
        /// Its radius.
        radius: f64,
        /// Indices of both.
        children: [usize; 2],
    },
    /// A part of a patch.
    Leaf(Box<Leaf>),
}

/// A part of a patch with its bounds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Leaf {
    pub(super) piece: usize,
    pub(super) rectangle: Rectangle,
    pub(super) part: Part,
    /// The surface in the middle.
    pub(super) jet: Jet,
}

impl Node {
    /// No place is nearer to a point than this.
    pub(super) fn bound(&self, p: &Vec3) -> f64 {
        match self {
            Self::Fork { center, radius, .. } => (p - center).norm() - radius,
            Self::Leaf(leaf) => leaf.part.bound(p),
        }
    }

    /// A ball that holds it.
    pub(super) fn ball(&self) -> (Vec3, f64) {
        match self {
            Self::Fork { center, radius, .. } => (*center, *radius),
            Self::Leaf(leaf) => (*leaf.part.center(), leaf.part.radius()),
        }
    }
}

/// The tree over all patches of a sheet; `None` where who waits gives up.
pub(super) fn grown(sheet: &SculpturedSheet, patience: Patience<'_>) -> Option<Vec<Node>> {
    let mut leaves = Vec::new();
    for piece in 0..sheet.pieces.len() {
        let mut open = vec![(Rectangle::between([0.0, 1.0], [0.0, 1.0]), 0)];
        let stretch = Stretch { sheet, piece };
        while let Some((rectangle, depth)) = open.pop() {
            if patience.ends_after(UNITS_A_PART) {
                return None;
            }
            let part = Part::new(&stretch, rectangle);
            if depth >= MAX_DEPTH || part.radius() <= SMALLEST * sheet.size || part.turns_at_most(TURN) {
                let jet = sheet.jet(piece, rectangle.middle);
                leaves.push(Leaf { piece, rectangle, part, jet });
            } else {
                let halves = rectangle.halves(stretch.looser(&rectangle));
                open.extend(halves.map(|half| (half, depth + 1)));
            }
        }
    }
    sheet.parts.add(leaves.len());
    let mut nodes = Vec::with_capacity(2 * leaves.len());
    plant(leaves, &mut nodes);
    Some(nodes)
}

/// Adds a tree over some leaves, halved along the greatest extent of their centres; returns the index of its root.
fn plant(mut leaves: Vec<Leaf>, nodes: &mut Vec<Node>) -> usize {
    let index = nodes.len();
    if leaves.len() == 1 {
        nodes.extend(leaves.pop().map(|leaf| Node::Leaf(Box::new(leaf))));
        return index;
    }
    if leaves.is_empty() {
        return index;
    }
    let start = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
    let [low, high] = leaves.iter().fold(start, |[low, high], leaf| {
        let center = leaf.part.center();
        [low.inf(center), high.sup(center)]
    });
    let axis = (high - low).imax();
    leaves.sort_by(|a, b| a.part.center()[axis].total_cmp(&b.part.center()[axis]));
    let last = leaves.split_off(leaves.len() / 2);
    nodes.push(Node::Fork { center: Vec3::zeros(), radius: 0.0, children: [0; 2] });
    let children = [plant(leaves, nodes), plant(last, nodes)];
    let (center, radius) = match children.map(|child| nodes.get(child).map(Node::ball)) {
        [Some(a), Some(b)] => around(a, b),
        _ => (Vec3::zeros(), f64::INFINITY),
    };
    if let Some(node) = nodes.get_mut(index) {
        *node = Node::Fork { center, radius, children };
    }
    index
}

/// The smallest ball about two.
fn around((a, r): (Vec3, f64), (b, s): (Vec3, f64)) -> (Vec3, f64) {
    let apart = (b - a).norm();
    if r >= apart + s {
        return (a, r);
    }
    if s >= apart + r {
        return (b, s);
    }
    let radius = 0.5 * (apart + r + s);
    (a + (b - a) * ((radius - r) / apart), radius)
}

impl SculpturedSheet {
    /// Leaves whose bounds do not tell them from a place nearer than some distance, until one is refused.
    pub(super) fn leaves_near<'a>(
        &'a self,
        far: impl Fn(&Node) -> bool,
        mut take: impl FnMut(&'a Leaf) -> bool,
    ) -> bool {
        let mut open = vec![0usize];
        while let Some(node) = open.pop() {
            let Some(node) = self.nodes.get(node).filter(|node| !far(node)) else { continue };
            match node {
                Node::Fork { children: [a, b], .. } => open.extend([*b, *a]),
                Node::Leaf(leaf) => {
                    if !take(leaf) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// Whether all leaves are farther from a point than a distance.
    pub(in super::super) fn keeps_off(&self, p: &Vec3, distance: f64) -> bool {
        self.leaves_near(|node| node.bound(p) > distance, |_| false)
    }
}

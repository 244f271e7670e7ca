//! Boxes over the patches of a surface in a binary tree.

use apt_geometry::{Vec3, parametric::Patch};

/// A box along the axes of the coordinate system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AlignedBox {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

/// A node of the tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Node {
    pub(crate) bounds: AlignedBox,
    pub(crate) content: Content,
}

/// What a node holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Content {
    /// Two nodes by their indexes.
    Pair(usize, usize),
    /// One patch by its index.
    Patch(usize),
}

/// The tree over the patches of a surface. The root is the last node.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct PatchTree {
    nodes: Vec<Node>,
}

impl AlignedBox {
    fn empty() -> Self {
        Self { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) }
    }

    /// The box of the control points, which holds the patch: weights are positive.
    pub(crate) fn of_patch(patch: &Patch) -> Self {
        let mut bounds = Self::empty();
        for point in patch.points().iter().flatten() {
            bounds.low = bounds.low.inf(point);
            bounds.high = bounds.high.sup(point);
        }
        bounds
    }

    fn join(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    #[inline]
    pub(crate) fn center(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    #[inline]
    pub(crate) fn half(&self) -> Vec3 {
        (self.high - self.low) * 0.5
    }
}

impl PatchTree {
    /// The tree over all patches: halved at the median of the longer direction of the centres.
    pub(crate) fn new(patches: &[Patch]) -> Self {
        let boxes: Vec<_> = patches.iter().map(AlignedBox::of_patch).collect();
        let mut order: Vec<usize> = (0..patches.len()).collect();
        let mut tree = Self { nodes: Vec::with_capacity(2 * patches.len()) };
        tree.build(&boxes, &mut order);
        tree
    }

    /// Adds the subtree over `order` and gives the index of its root; the depth is the logarithm of the number.
    fn build(&mut self, boxes: &[AlignedBox], order: &mut [usize]) -> Option<usize> {
        let bounds = order
            .iter()
            .filter_map(|&index| boxes.get(index))
            .fold(AlignedBox::empty(), |sum, one| sum.join(one));
        let content = match *order {
            [] => return None,
            [index] => Content::Patch(index),
            _ => {
                let center = |index: &usize| boxes.get(*index).map_or(Vec3::zeros(), AlignedBox::center);
                let mut spread = AlignedBox::empty();
                for index in order.iter() {
                    let at = center(index);
                    spread = spread.join(&AlignedBox { low: at, high: at });
                }
                let direction = spread.half().imax();
                let by_center = |a: &usize, b: &usize| {
                    center(a)[direction].total_cmp(&center(b)[direction]).then(a.cmp(b))
                };
                order.sort_unstable_by(by_center);
                let middle = order.len() / 2;
                let (first, second) = order.split_at_mut(middle);
                match (self.build(boxes, first), self.build(boxes, second)) {
                    (Some(first), Some(second)) => Content::Pair(first, second),
                    (one, other) => return one.or(other),
                }
            }
        };
        self.nodes.push(Node { bounds, content });
        Some(self.nodes.len() - 1)
    }

    pub(crate) fn root(&self) -> Option<usize> {
        self.nodes.len().checked_sub(1)
    }

    /// The number of nodes.
    pub(crate) fn count(&self) -> usize {
        self.nodes.len()
    }

    #[inline]
    pub(crate) fn node(&self, index: usize) -> Option<&Node> {
        self.nodes.get(index)
    }

    /// The patches whose boxes `touches` accepts, in the order of the tree.
    pub(crate) fn patches_where(&self, touches: impl Fn(&AlignedBox) -> bool) -> Vec<usize> {
        let mut found = Vec::new();
        let mut open: Vec<usize> = self.root().into_iter().collect();
        while let Some(node) = open.pop().and_then(|index| self.node(index)) {
            if !touches(&node.bounds) {
                continue;
            }
            match node.content {
                Content::Patch(patch) => found.push(patch),
                Content::Pair(first, second) => open.extend([second, first]),
            }
        }
        found
    }
}

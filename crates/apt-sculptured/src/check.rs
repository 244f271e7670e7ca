//! Interference checking: the deepest point of surfaces in the tool, with proof (sculptured surfaces reference 5.4).

mod memory;
mod search;

use apt_geometry::{Vec3, canonical::Remembering, parametric::SculpturedSurface, patience::Patience};

pub use memory::Checker;

use crate::{
    bounds::PatchTree,
    tool::{Pose, Tool},
};

/// A surface made ready for checking. The preparation depends on nothing but the surface.
#[derive(Debug, Clone)]
pub struct Obstacle {
    surface: Remembering<SculpturedSurface>,
    tree: PatchTree,
    creased: bool,
}

impl Obstacle {
    /// Makes a surface ready.
    pub fn new(surface: Remembering<SculpturedSurface>) -> Self {
        let tree = PatchTree::new(&surface.patches);
        let creased = surface.neighbours.iter().flatten().flatten().any(|next| !next.smooth);
        Self { surface, tree, creased }
    }

    /// The surface.
    pub fn surface(&self) -> &Remembering<SculpturedSurface> {
        &self.surface
    }

    /// Whether patches meet at an angle somewhere.
    pub fn is_creased(&self) -> bool {
        self.creased
    }

    pub(crate) fn tree(&self) -> &PatchTree {
        &self.tree
    }
}

/// A surface point inside the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Which of the obstacles, by its index.
    pub obstacle: usize,
    /// Which of its patches, by its index.
    pub patch: usize,
    /// Local parameters.
    pub parameters: [f64; 2],
    /// The point.
    pub point: Vec3,
    /// How deep it is in the tool, stock included; program units.
    pub depth: f64,
}

/// What a check cost: counted, not timed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Cost {
    /// Boxes of the tree that were bounded.
    pub boxes: u64,
    /// Cells of patches that were bounded.
    pub cells: u64,
}

/// What is asked of a check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question<'a> {
    /// Depth up to which nothing is said (INTOL); program units.
    pub threshold: f64,
    /// How exactly the depth of a hit is wanted; program units.
    pub gap: f64,
    /// How long the search may go on: one that is given up has proven nothing.
    pub patience: Patience<'a>,
}

/// The answer of a check.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// The deepest point, if it is deeper than the threshold.
    pub worst: Option<Hit>,
    /// No point of any obstacle is deeper than this; program units.
    pub bound: f64,
    /// Whether the bound is as near as was asked.
    pub proved: bool,
    /// What it cost.
    pub cost: Cost,
}

/// Checks a tool in a pose against obstacles.
pub fn check(tool: &Tool, pose: &Pose, obstacles: &[Obstacle], question: &Question<'_>) -> Report {
    search::deepest(tool, pose, obstacles, question, &mut memory::Memory::default())
}

//! A computed cut sequence with all that is needed to judge it: the contract between engine and verifier.

use apt_geometry::{
    Vec3,
    motion::{DriveSide, Relation},
};
use serde::Serialize;

/// Where the tool is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ToolPosition {
    /// Tool end.
    pub tip: Vec3,
    /// Unit tool axis from the tip to the spindle.
    pub axis: Vec3,
}

/// A surface in the role it plays for a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Role {
    /// The surface, with the name for messages.
    pub surface: apt_geometry::motion::NamedSurface,
    /// How the tool stands to it.
    pub relation: Relation,
    /// Which side of the natural normal (the normal of the canonical form: outward for closed surfaces, the gradient
    /// for quadrics) the tool lives on: +1 or −1. For ON the side of the observer.
    pub side: f64,
    /// How deep the tool may cut into the surface, ≥ 0.
    pub inside_tolerance: f64,
    /// How much stock it may leave, ≥ 0.
    pub outside_tolerance: f64,
    /// THICK of this role.
    pub thickness: f64,
    /// The disk that takes the place of the cutter for this surface (CUTTER/OPTION); it does not count for ON.
    pub disk: Option<apt_geometry::cutter::Disk>,
}

/// What stopped a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    /// The check surface as a role; `side` is the side the tool is on at the end.
    pub role: Role,
    /// It stopped at the n-th position of this relation.
    pub occurrence: u32,
    /// Index of the check surface in the command.
    pub index: usize,
}

/// One computed motion: from `start` through `points`.
#[derive(Debug, Clone, PartialEq)]
pub struct CutSequence {
    /// Where the tool was.
    pub start: ToolPosition,
    /// The positions reached, in order.
    pub points: Vec<ToolPosition>,
    /// The cutter in force.
    pub cutter: apt_geometry::cutter::Cutter,
    /// The part surface; none where it was ignored (NOPS) or there is none (GOTO).
    pub part: Option<Role>,
    /// The drive surface.
    pub drive: Option<Role>,
    /// What stopped it; for a GO with three surfaces the third.
    pub stop: Option<Stop>,
    /// TLLFT, TLRGT or TLON, for the verifier.
    pub drive_side: DriveSide,
    /// True for a start-up motion: only its end is bound to the surfaces.
    pub start_up: bool,
    /// Sense of travel along the path at the start: unit vector, zero for start-up motions.
    pub forward: Vec3,
    /// Longest cut vector allowed (MAXDP).
    pub maximum_step: f64,
    /// The number of cut vectors that no sequence within tolerance can beat, where a bound is known.
    pub minimum: Option<u32>,
}

/// Positions that are cut with one feed.
#[derive(Debug, Clone, PartialEq)]
pub struct PocketPass {
    /// The feed as the statement gives it.
    pub feed: f64,
    /// The positions, in order; empty if there is nothing to cut with this feed.
    pub points: Vec<ToolPosition>,
}

/// A pocket: the path in the order of cutting, and what is needed to judge it.
#[derive(Debug, Clone, PartialEq)]
pub struct PocketPath {
    /// The first position with the plunge feed, the general passes, and the finishing pass along the sides.
    pub passes: [PocketPass; 3],
    /// The points of the statement, on the plane of the pocket.
    pub boundary: Vec<Vec3>,
    /// The boundary is the wall of the pocket; otherwise the tool centre runs on it.
    pub walls: bool,
    /// Unit tool axis.
    pub axis: Vec3,
    /// The cutter in force.
    pub cutter: apt_geometry::cutter::Cutter,
    /// What the tool clears around its centre on the bottom.
    pub effective_radius: f64,
    /// How far from the cleared area a point of the bottom may be: the greater of INTOL and OUTTOL of the part surface.
    pub tolerance: f64,
}

impl PocketPath {
    /// All positions in the order of cutting.
    pub fn positions(&self) -> impl DoubleEndedIterator<Item = &ToolPosition> + Clone {
        self.passes.iter().flat_map(|pass| &pass.points)
    }
}

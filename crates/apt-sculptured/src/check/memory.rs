//! What is known of the boxes of a tree from earlier poses of the same tool: consecutive poses are near to each other, and
//! where a tool has moved by no more than a way at any of its points no depth has grown by more than that.

use super::{Cost, Obstacle, Question, Report, search};
use crate::tool::{Pose, Tool};

/// Checks one tool in one pose after the other against the same obstacles. What it keeps is two numbers a box.
#[derive(Debug, Clone)]
pub struct Checker<'a> {
    tool: Tool,
    obstacles: &'a [Obstacle],
    memory: Memory,
    cost: Cost,
}

impl<'a> Checker<'a> {
    /// A checker that knows nothing yet.
    pub fn new(tool: Tool, obstacles: &'a [Obstacle]) -> Self {
        Self { tool, obstacles, memory: Memory::default(), cost: Cost::default() }
    }

    /// Checks the tool in a pose.
    pub fn check(&mut self, pose: &Pose, question: &Question<'_>) -> Report {
        if self.memory.boxes.is_empty() {
            let unknown = |one: &Obstacle| vec![Known::NOTHING; one.tree().count()];
            self.memory.boxes = self.obstacles.iter().map(unknown).collect();
        }
        self.memory.move_to(pose, self.tool.reach());
        let report = search::deepest(&self.tool, pose, self.obstacles, question, &mut self.memory);
        self.cost.boxes += report.cost.boxes;
        self.cost.cells += report.cost.cells;
        report
    }

    /// Whether there is nothing to check against.
    pub fn is_idle(&self) -> bool {
        self.obstacles.is_empty()
    }

    /// What all checks together have cost.
    pub fn cost(&self) -> Cost {
        self.cost
    }
}

/// The last bound of the depth within a box, and how far the tool had gone then.
#[derive(Debug, Clone, Copy)]
struct Known {
    bound: f64,
    gone: f64,
}

impl Known {
    /// Of a box that was never looked at.
    const NOTHING: Self = Self { bound: f64::INFINITY, gone: f64::NEG_INFINITY };
}

/// What is known of the boxes of all obstacles; of none where only one pose is checked.
#[derive(Debug, Clone, Default)]
pub(super) struct Memory {
    /// By obstacle and node.
    boxes: Vec<Vec<Known>>,
    last: Option<Pose>,
    /// How far the tool has gone: over all moves, the farthest way of any of its points.
    gone: f64,
}

/// What a box needs.
pub(super) enum Outlook {
    /// Nothing: no point in it is above the limit.
    Clear,
    /// It has to be divided, with this bound; another look at it would tell the same.
    Divide(f64),
    /// To be looked at.
    Unknown,
}

impl Memory {
    /// The tool is elsewhere now. The axis turns on the shortest way, which takes no point farther than its distance from the
    /// end times the change of the unit axis.
    fn move_to(&mut self, pose: &Pose, reach: f64) {
        if let Some(last) = self.last {
            self.gone += (pose.end - last.end).norm() + reach * (pose.axis - last.axis).norm();
        }
        self.last = Some(*pose);
    }

    /// What is known of a box where depths up to `limit` do not matter. A bound that was above by more than the tool has
    /// moved since cannot be expected to be below.
    #[inline]
    pub(super) fn outlook(&self, obstacle: usize, node: usize, limit: f64) -> Outlook {
        let Some(known) = self.boxes.get(obstacle).and_then(|boxes| boxes.get(node)) else {
            return Outlook::Unknown;
        };
        let moved = self.gone - known.gone;
        if known.bound + moved <= limit {
            Outlook::Clear
        } else if known.bound - moved > limit && moved.is_finite() {
            Outlook::Divide(known.bound + moved)
        } else {
            Outlook::Unknown
        }
    }

    /// Keeps the bound of what is in a box, for the pose where the tool is, if it is less than that of the box.
    pub(super) fn lower(&mut self, obstacle: usize, node: usize, bound: f64) {
        if let Some(known) = self.boxes.get_mut(obstacle).and_then(|boxes| boxes.get_mut(node))
            && bound < known.bound + (self.gone - known.gone)
        {
            *known = Known { bound, gone: self.gone };
        }
    }

    /// Keeps the bound of a box for the pose where the tool is.
    #[inline]
    pub(super) fn keep(&mut self, obstacle: usize, node: usize, bound: f64) {
        if let Some(known) = self.boxes.get_mut(obstacle).and_then(|boxes| boxes.get_mut(node)) {
            *known = Known { bound, gone: self.gone };
        }
    }
}

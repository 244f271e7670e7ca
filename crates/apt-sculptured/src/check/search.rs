//! Best first: the box or cell with the greatest bound is divided next.

mod bend;
mod ridge;

use std::{cmp::Ordering, collections::BinaryHeap};

use apt_geometry::{Vec3, parametric::Patch};

use super::{
    Cost, Hit, Obstacle, Question, Report,
    memory::{Memory, Outlook},
};
use crate::{
    bounds::Content,
    tool::{Pose, Tool},
};

/// Most cells of one check. A thousand times what hard cases take; a tool that fits a surface exactly over an area could
/// go on for ever.
const MOST_CELLS: u64 = 200_000;
/// What halving a cell, or a box of the tree, counts in units of work: two cells or boxes are bounded.
const WORK_OF_HALVING: u32 = 4;

/// A piece of an obstacle with the bound of its depth.
struct Open {
    bound: f64,
    /// Order of arrival: ties are settled the same way always.
    number: u64,
    piece: Piece,
}

enum Piece {
    Node { obstacle: usize, node: usize },
    Cell(Box<Cell>),
}

/// Part of a patch.
struct Cell {
    obstacle: usize,
    patch: usize,
    /// Local parameters of the low corner and of the extent.
    low: [f64; 2],
    size: [f64; 2],
    control: Patch,
    /// Whether the patch is a polynomial, all of whose weights are the same.
    polynomial: bool,
    /// Whether halving u narrows the bound more than halving v.
    along_u: bool,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.number.cmp(&self.number))
    }
}

struct Search<'a> {
    tool: &'a Tool,
    pose: &'a Pose,
    obstacles: &'a [Obstacle],
    question: &'a Question<'a>,
    memory: &'a mut Memory,
    open: BinaryHeap<Open>,
    /// How many pieces have arrived.
    arrived: u64,
    best: Option<Hit>,
    cost: Cost,
}

/// The deepest point of the obstacles in the tool.
pub(super) fn deepest(
    tool: &Tool,
    pose: &Pose,
    obstacles: &[Obstacle],
    question: &Question<'_>,
    memory: &mut Memory,
) -> Report {
    let mut search = Search {
        tool,
        pose,
        obstacles,
        question,
        memory,
        open: BinaryHeap::new(),
        arrived: 0,
        best: None,
        cost: Cost::default(),
    };
    for (index, obstacle) in obstacles.iter().enumerate() {
        if let Some(root) = obstacle.tree().root() {
            search.add_node(index, root);
        }
    }
    search.run()
}

impl Search<'_> {
    fn run(mut self) -> Report {
        loop {
            let limit = self.limit();
            let Some(top) = self.open.pop() else {
                return self.report(limit, true);
            };
            if top.bound <= limit {
                return self.report(limit, true);
            }
            if self.cost.cells >= MOST_CELLS || self.question.patience.ends_after(WORK_OF_HALVING) {
                return self.report(top.bound, false);
            }
            match top.piece {
                Piece::Node { obstacle, node } => self.divide_node(obstacle, node),
                Piece::Cell(cell) => self.divide_cell(&cell),
            }
        }
    }

    /// Pieces with a bound up to this need no work.
    #[inline]
    fn limit(&self) -> f64 {
        let threshold = self.question.threshold;
        match &self.best {
            Some(best) if best.depth > threshold => best.depth + self.question.gap,
            _ => threshold,
        }
    }

    fn report(self, bound: f64, proved: bool) -> Report {
        let worst = self.best.filter(|best| best.depth > self.question.threshold);
        Report { worst, bound, proved, cost: self.cost }
    }

    #[inline]
    fn push(&mut self, bound: f64, piece: Piece) {
        if bound > self.limit() {
            self.arrived += 1;
            let number = self.arrived;
            self.open.push(Open { bound, number, piece });
        }
    }

    fn add_node(&mut self, obstacle: usize, node: usize) {
        match self.memory.outlook(obstacle, node, self.limit()) {
            Outlook::Clear => return,
            Outlook::Divide(bound) => return self.push(bound, Piece::Node { obstacle, node }),
            Outlook::Unknown => {}
        }
        let Some(bounds) =
            self.obstacles.get(obstacle).and_then(|one| one.tree().node(node)).map(|node| node.bounds)
        else {
            return;
        };
        self.cost.boxes += 1;
        let depth = self.tool.depth(self.pose, &bounds.center());
        let bound = depth.value + depth.ascent.abs().dot(&bounds.half());
        self.memory.keep(obstacle, node, bound);
        self.push(bound, Piece::Node { obstacle, node });
    }

    fn divide_node(&mut self, obstacle: usize, node: usize) {
        let Some(one) = self.obstacles.get(obstacle) else { return };
        match one.tree().node(node).map(|node| node.content) {
            Some(Content::Pair(first, second)) => {
                self.add_node(obstacle, first);
                self.add_node(obstacle, second);
            }
            Some(Content::Patch(patch)) => {
                if let Some(&control) = one.surface().patches.get(patch) {
                    let polynomial = bend::is_polynomial(&control);
                    let (low, size) = ([0.0; 2], [1.0; 2]);
                    let whole = Cell { obstacle, patch, low, size, control, polynomial, along_u: true };
                    let bound = self.add_cell(whole);
                    self.memory.lower(obstacle, node, bound);
                }
            }
            None => {}
        }
    }

    /// Bounds a cell by the supergradient at its middle, which is a point of the surface and may be the deepest yet, and where
    /// that does not settle it by how the corner bends away or by what other faces leave. The bound.
    fn add_cell(&mut self, mut cell: Cell) -> f64 {
        self.cost.cells += 1;
        let points = cell.control.points();
        let middle = middle(&cell.control);
        let depth = self.tool.depth(self.pose, &middle);
        let middle_parameters = [cell.low[0] + 0.5 * cell.size[0], cell.low[1] + 0.5 * cell.size[1]];
        if self.best.is_none_or(|best| depth.value > best.depth) {
            self.best = Some(Hit {
                obstacle: cell.obstacle,
                patch: cell.patch,
                parameters: middle_parameters,
                point: middle,
                depth: depth.value,
            });
        }
        let steps = rises(&points, &middle, &depth.ascent, 0.0);
        cell.along_u = varies_along_u(&steps);
        let mut bound = depth.value + greatest(&steps);
        if bound > self.limit() && cell.polynomial {
            let (round, limit) = (self.tool.round(self.pose, &middle), self.limit());
            if let Some(beside) = round.and_then(|round| bend::greatest(&round, &points, &middle, limit)) {
                bound = bound.min(beside);
            }
        }
        if bound > self.limit() {
            for face in self.tool.depths_behind_faces(self.pose, &middle) {
                let beyond = rises(&points, &middle, &face.ascent, face.value - depth.value);
                bound = bound.min(depth.value + ridge::greatest_of_lesser(&steps, &beyond));
            }
        }
        self.push(bound, Piece::Cell(Box::new(cell)));
        bound
    }

    fn divide_cell(&mut self, cell: &Cell) {
        let (halves, axis) =
            if cell.along_u { (cell.control.halved_u(), 0) } else { (cell.control.halved_v(), 1) };
        let mut size = cell.size;
        size[axis] *= 0.5;
        for (number, control) in halves.into_iter().enumerate() {
            let mut low = cell.low;
            low[axis] += size[axis] * number as f64;
            self.add_cell(Cell { low, size, control, ..*cell });
        }
    }
}

/// How much a linear function with a slope rises from the middle to each control point, from `base` on.
#[inline]
fn rises(points: &[[Vec3; 4]; 4], middle: &Vec3, slope: &Vec3, base: f64) -> [[f64; 4]; 4] {
    let mut found = [[0.0; 4]; 4];
    for (row, points) in found.iter_mut().zip(points) {
        for (rise, point) in row.iter_mut().zip(points) {
            *rise = base + slope.dot(&(point - middle));
        }
    }
    found
}

#[inline]
fn greatest(steps: &[[f64; 4]; 4]) -> f64 {
    steps.iter().flatten().fold(0.0, |most: f64, &step| most.max(step))
}

/// Whether the steps of the control points differ more along u than along v: that direction makes the bound wide.
#[inline]
fn varies_along_u(steps: &[[f64; 4]; 4]) -> bool {
    let spread = |values: [f64; 4]| {
        let high = values.iter().fold(f64::NEG_INFINITY, |most, &value| most.max(value));
        let low = values.iter().fold(f64::INFINITY, |least, &value| least.min(value));
        high - low
    };
    let along_v = steps.iter().map(|row| spread(*row)).fold(0.0, f64::max);
    let column = |j: usize| std::array::from_fn(|i| steps[i][j]);
    let along_u = (0..4).map(|j| spread(column(j))).fold(0.0, f64::max);
    along_u >= along_v
}

/// The point of a patch at u = v = ½.
#[inline]
fn middle(patch: &Patch) -> Vec3 {
    const WEIGHTS: [f64; 4] = [0.125, 0.375, 0.375, 0.125];
    let mut sum = nalgebra::Vector4::zeros();
    for (row, wu) in patch.control.iter().zip(WEIGHTS) {
        for (point, wv) in row.iter().zip(WEIGHTS) {
            sum += point * (wu * wv);
        }
    }
    sum.xyz() / sum.w
}

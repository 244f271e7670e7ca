//! Proof that no point of the tool is nearer to a surface than a level, whatever the search for the contact has found.
//!
//! The boundary of the tool is covered by patches: stretches of its profile over ranges of azimuth. From the middle of a
//! patch the distance of every other point follows up to a known error: its first derivatives are those at the middle,
//! and a bound of the second ones covers the rest. The linear part is minimised over the patch in closed form, so that
//! the tool's own curvature counts in full. Patches that this does not clear are halved.

mod judge;

use std::{
    cell::Cell,
    cmp::Ordering,
    collections::BinaryHeap,
    f64::consts::{FRAC_PI_3, PI},
};

use apt_geometry::{
    Vec3,
    surface::{Bend, Foot, Region, Surface},
};

use self::judge::Judged;
use super::{
    Contact, Tool,
    empty::Empty,
    floor::{Base, Bases, Course},
    nearly_straight,
    patch::{Middle, Patch, Stretch, boundary},
};

/// Bound of the patches looked at. A proof takes some dozens; where contact is nearly flat, a few hundred.
const MAX_PATCHES: u32 = 1500;
/// How many are looked at before parts of a surface that has them are asked in their place. Many small patches are left where contact
/// lies nearly along the surface, and each takes a search for its foot; a part takes some operations.
const BEFORE_PARTS: u32 = 60;
/// How many are looked at where no size of them can be shown, and the gap, as a share of the tool's size, that distances alone do
/// not show.
const FEW_PATCHES: u32 = 300;
const HAIR: f64 = 1e-6;
/// How many are looked at before straight pieces are asked about as such, and empty balls before bends.
const MANY_PATCHES: u32 = 100;
/// Share of the coordinates that is rounding of a distance.
const ROUNDING: f64 = 1e-15;
/// Half a range of azimuth (radians) below which the ball of a corner is left for the corner itself.
const NARROW: f64 = 0.02;
/// How far (radians) from the corner's own fan a normal may point while its whole ball is looked at.
const BESIDE_FAN: f64 = 0.05;

/// How many times more leaves a proof may come to have than it was made with, counted from a least number.
const FINER: usize = 2;
const LEAST_FINE: usize = 12;

/// What a look at a patch counts beside the parts of the surface that it takes, in units of work.
const WORK_OF_PATCH: u32 = 8;

#[cfg(test)]
thread_local! {
    /// Patches that this thread has looked at.
    pub(crate) static JUDGED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// What is known about a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Certificate {
    /// No point of the tool is lower.
    Holds,
    /// This point is.
    Lower(Contact),
    /// The patches ran out.
    Undecided,
}

/// How many patches are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effort {
    /// As many as take no more than other ways to show the same.
    Few,
    /// As many as a proof may take.
    All,
}

/// A surface and the side of it that the tool is on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face<'a> {
    /// The surface.
    pub(crate) surface: &'a Surface,
    /// Side of its natural normal.
    pub(crate) side: f64,
}

/// A patch that kept a level, and why.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaf {
    patch: Patch,
    /// The position there.
    pose: Pose,
    /// No point of the patch was nearer to the surface.
    least: f64,
    ground: Option<Ground>,
}

/// A position of the tool: its end, and two directions of its frame.
#[derive(Debug, Clone, Copy)]
struct Pose {
    tip: Vec3,
    axis: Vec3,
    across: Vec3,
}

impl Pose {
    fn of(tool: &Tool, tip: &Vec3) -> Self {
        Self { tip: *tip, axis: tool.axis, across: tool.across[0] }
    }

    /// No point of the tool moves farther from this position to another one.
    fn moved(&self, tool: &Tool, tip: &Vec3) -> f64 {
        let moved = (tip - self.tip).norm();
        if self.axis == tool.axis {
            return moved;
        }
        let third = tool.across[1] - self.axis.cross(&self.across);
        let aside = (tool.across[0] - self.across).norm() + third.norm();
        moved + tool.profile.top.height * (tool.axis - self.axis).norm() + tool.radius() * aside
    }
}

/// Why a patch keeps a level.
#[derive(Debug, Clone, Copy)]
enum Ground {
    Bending(Bending),
    Empty(Empty),
}

/// A ball with how the distance bends in it, and a place in the ball to expand the distance about.
#[derive(Debug, Clone, Copy)]
struct Bending {
    base: Base,
    center: Vec3,
    radius: f64,
    course: Course,
}

impl Leaf {
    /// Of which nothing is known.
    fn new(patch: Patch) -> Self {
        let pose = Pose { tip: Vec3::zeros(), axis: Vec3::zeros(), across: Vec3::zeros() };
        Self { patch, pose, least: f64::NEG_INFINITY, ground: None }
    }
}

/// A proof of a level, kept for the next ones: leaves that cover what the level is asked of.
#[derive(Debug, Clone)]
pub(super) struct Proof {
    leaves: Vec<Leaf>,
    /// How many leaves it had when it was made.
    made: usize,
    /// How far the tool is expected to move until the next questions.
    pub(super) spread: f64,
}

impl Proof {
    /// Nothing is proven of some patches.
    pub(super) fn of(patches: Vec<Patch>) -> Self {
        Self { leaves: patches.into_iter().map(Leaf::new).collect(), made: 0, spread: 0.0 }
    }

    /// Nothing is proven of a whole tool.
    pub(super) fn of_tool(tool: &Tool) -> Self {
        Self::of(boundary(tool))
    }

    fn take(&mut self, leaves: Vec<Leaf>) {
        if self.made == 0 {
            self.made = leaves.len();
        }
        self.leaves = leaves;
    }

    /// Patches of which enough is known, and those that are open.
    fn leave(&mut self, mut leaves: Vec<Leaf>, open: BinaryHeap<Open>) {
        leaves.extend(open.into_iter().map(|open| Leaf::new(open.patch)));
        self.leaves = leaves;
    }

    /// Whether it serves a next question: not if nothing holds, nor if it has become much finer than it was made.
    pub(super) fn serves(&self) -> bool {
        !self.leaves.is_empty() && self.leaves.len() <= FINER * self.made.max(LEAST_FINE)
    }
}

/// A patch that is not cleared yet; the one that may be lowest is the greatest, among equals the one seen first.
struct Open {
    patch: Patch,
    judged: Judged,
    number: u32,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.judged.least.total_cmp(&self.judged.least).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

/// What a search knows of a pose: the tool beside a surface, the level that is asked about, and what the distance is
/// expanded about.
struct Question<'a> {
    face: Face<'a>,
    tool: &'a Tool<'a>,
    tip: &'a Vec3,
    level: f64,
    bases: Option<&'a Bases>,
    generator: Option<Vec3>,
    /// How much farther than needed a bend is asked for, so that it serves the next positions.
    spread: f64,
    /// Whether many patches have been looked at.
    are_many: Cell<bool>,
    /// Whether straight pieces are then asked about as such.
    may_be_thin: bool,
}

/// Examines whether the distance from a surface is nowhere on the patches of a proof below a level. The patch that may be
/// lowest is halved first: where the level is not kept that leads down to a lower point. `bases` are about the contact
/// found. The proof is left for the next question, unless the tool's patience ends before it.
pub(super) fn certify(
    face: Face<'_>,
    tool: &Tool,
    tip: &Vec3,
    level: f64,
    proof: &mut Proof,
    bases: Option<&Bases>,
    effort: Effort,
) -> Certificate {
    let mut open: BinaryHeap<Open> = BinaryHeap::new();
    let mut seen = 0;
    let cleared = level - ROUNDING * (tip.amax() + tool.radius() + tool.profile.top.height);
    let (generator, spread) = (face.surface.generator(), proof.spread);
    let (are_many, may_be_thin) = (Cell::new(false), nearly_straight::is_apt(face.surface));
    let question =
        Question { face, tool, tip, level: cleared, bases, generator, spread, are_many, may_be_thin };
    let pose = Pose::of(tool, tip);
    let mut leaves = std::mem::take(&mut proof.leaves);
    if leaves.is_empty() {
        // One that was given up: it covers nothing.
        return Certificate::Undecided;
    }
    let mut done = Vec::with_capacity(leaves.len());
    let mut hopeless = None;
    loop {
        while let Some(leaf) = leaves.pop() {
            if let Some(leaf) = question.still_keeps(&leaf) {
                done.push(leaf);
                continue;
            }
            seen += 1;
            if tool.patience.ends_after(WORK_OF_PATCH) {
                return Certificate::Undecided;
            }
            question.are_many.set(seen > MANY_PATCHES);
            let (judged, ground) = question.judge(&leaf);
            if judged.least >= cleared {
                done.push(Leaf { patch: leaf.patch, pose, least: judged.least, ground });
            } else if judged.sample.clearance < level {
                done.push(Leaf::new(leaf.patch));
                done.extend(leaves);
                proof.leave(done, open);
                return Certificate::Lower(judged.sample);
            } else {
                open.push(Open { patch: leaf.patch, judged, number: seen });
            }
        }
        let Some(Open { patch, judged, .. }) = open.pop() else {
            proof.take(done);
            return Certificate::Holds;
        };
        if seen > MAX_PATCHES || seen > FEW_PATCHES && *hopeless.get_or_insert_with(|| question.is_hopeless())
        {
            return Certificate::Undecided;
        }
        if effort == Effort::Few && seen > BEFORE_PARTS {
            done.push(Leaf::new(patch));
            proof.leave(done, open);
            return Certificate::Undecided;
        }
        split(&mut leaves, tool, &patch, &judged);
    }
}

impl Question<'_> {
    /// Whether even at the contact itself the distance has no bound of its bend, as far from a surface that ends in sight, and the
    /// level is so close to it that distances alone show nothing.
    fn is_hopeless(&self) -> bool {
        let size = self.tool.radius() + self.tool.profile.top.height;
        self.bases.is_some_and(|Bases { contact: Base { place, distance, .. }, .. }| {
            let foot = self.face.surface.foot(place);
            distance - self.level <= HAIR * size
                && matches!(downward_bend(self.face, self.tool, &foot, (place, 0.0)), Bend::Unbounded)
        })
    }

    /// A leaf of an earlier proof, if it is known without a new look at the surface that its patch keeps the level.
    fn still_keeps(&self, leaf: &Leaf) -> Option<Leaf> {
        if leaf.least - leaf.pose.moved(self.tool, self.tip) >= self.level {
            return Some(*leaf);
        }
        let middle = leaf.patch.middle(self.tool, self.tip, self.generator.as_ref());
        let least = match leaf.ground? {
            Ground::Empty(empty) => {
                let (base, bend) = empty.about(&middle.place)?;
                let least = self.least_about(&leaf.patch, &base, bend, &middle);
                (least >= self.level).then_some((least, Ground::Empty(empty)))
            }
            Ground::Bending(ground) => self.least_on(&leaf.patch, &ground, &middle),
        };
        let pose = Pose::of(self.tool, self.tip);
        least.map(|(least, ground)| Leaf { patch: leaf.patch, pose, least, ground: Some(ground) })
    }

    /// The least distance over a patch, if it is in the ball of a ground and that shows the level.
    fn least_on(&self, patch: &Patch, ground: &Bending, middle: &Middle) -> Option<(f64, Ground)> {
        let Bending { base, center, radius, course } = *ground;
        let within = |p: &Vec3| self.away(p, &center) <= radius;
        if self.away(&middle.place, &center) + middle.reach > radius {
            return None;
        }
        let now = self.base(middle.ball).filter(|base| within(&base.place));
        now.into_iter().chain([base]).find_map(|base| {
            let least = self.least(patch, &base, course) - middle.ball;
            let ground = Ground::Bending(Bending { base, center, radius, course });
            (least >= self.level).then_some((least, ground))
        })
    }

    /// The base for a patch with a ball about its points or without.
    fn base(&self, ball: f64) -> Option<Base> {
        self.bases.and_then(|bases| if ball > 0.0 { bases.core } else { Some(bases.contact) })
    }

    /// Distance of two places but for what lies along the generator.
    fn away(&self, a: &Vec3, b: &Vec3) -> f64 {
        let w = a - b;
        self.generator.map_or(w, |generator| w - generator * generator.dot(&w)).norm()
    }

    fn least(&self, patch: &Patch, base: &Base, course: Course) -> f64 {
        patch.least(self.tool, self.tip, base, course)
    }

    fn course(&self, bend: f64) -> Course {
        Course::along_generator(bend, self.generator)
    }
}

/// How strongly the distance bends downward within reach of a point.
pub(super) fn downward_bend(face: Face<'_>, tool: &Tool, foot: &Foot, (center, reach): (&Vec3, f64)) -> Bend {
    let distance = face.side * foot.distance;
    let region =
        Region { center: *center, radius: reach, lowest: -distance - reach, highest: reach - distance };
    face.surface.bend(-face.side, foot, &region, tool.patience)
}

/// The parts of a patch that may yet be cleared.
fn split(leaves: &mut Vec<Leaf>, tool: &Tool, patch: &Patch, judged: &Judged) {
    let Patch { stretch, azimuth, half } = *patch;
    let radius = stretch.radius();
    let whole = half >= PI;
    if let Stretch::Ball { center, arc, fan } = stretch {
        let polar = judged.sample.gradient.dot(&tool.axis).clamp(-1.0, 1.0).acos();
        let beside = polar < fan[0] - BESIDE_FAN || polar > fan[1] + BESIDE_FAN;
        if radius <= 0.0 || half <= NARROW || beside && !whole {
            leaves.push(Leaf::new(Patch {
                stretch: Stretch::Arc { center, arc, polar: fan },
                azimuth,
                half,
            }));
            return;
        }
    }
    let along = judged.length > if whole { 2.0 * radius } else { 2.0 * radius * half };
    if along || radius <= 0.0 {
        leaves.extend(stretch.halves().map(|stretch| Leaf::new(Patch { stretch, azimuth, half })));
    } else if whole {
        let turned =
            |k: f64| Leaf::new(Patch { stretch, azimuth: azimuth + 2.0 * k * FRAC_PI_3, half: FRAC_PI_3 });
        leaves.extend([turned(0.0), turned(1.0), turned(2.0)]);
    } else {
        let turned = |k: f64| Leaf::new(Patch { stretch, azimuth: azimuth + k * half, half: 0.5 * half });
        leaves.extend([turned(-0.5), turned(0.5)]);
    }
}

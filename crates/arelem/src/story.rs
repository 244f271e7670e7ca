//! The story of a computed motion, told on request: which surfaces took part and how the tool stood to them, by which route
//! the motion was computed, and why each cut vector ended where it did.
//!
//! It is read off the finished sequence, so that a motion of which nobody asks the story costs nothing more.

#[cfg(test)]
mod tests;

use apt_geometry::{
    Vec3,
    canonical::GeometryKind,
    motion::{CheckSurface, MotionCommand, Relation},
    patience::{Patience, Waiting},
    surface::Surface,
};

use crate::{
    attitude::{Attitude, Sweep},
    clearance::{Gauge, Memory, Shape, Tool},
    directed,
    error::RoleName,
    position::{self, Condition},
    section2::State,
    sequence::{CutSequence, Role, ToolPosition},
    start_up,
};

/// How a motion was computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// In closed form, in the plane across a vertical tool.
    ClosedForm,
    /// One straight move between two planes.
    Straight,
    /// By iteration from position to position.
    Iteration,
}

/// How the offset of a surface bends along the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum SurfaceShape {
    Flat,
    Convex,
    Concave,
    General,
}

/// A surface in its role. Lengths in program units.
#[derive(Debug, Clone, PartialEq)]
pub struct StorySurface {
    /// Which role.
    pub role: RoleName,
    /// The programmer's name, empty if there is none.
    pub name: String,
    /// What it is.
    pub kind: GeometryKind,
    /// The relation kept or reached.
    pub relation: Relation,
    /// +1 where the natural normal of the canonical form points to the tool, else −1.
    pub side: f64,
    /// THICK, which does not count for ON.
    pub thickness: f64,
    /// INTOL.
    pub inside: f64,
    /// OUTTOL.
    pub outside: f64,
    /// How it bends, seen from the tool.
    pub shape: SurfaceShape,
    /// Clearance at the start of the motion and at its end.
    pub clearance: [f64; 2],
}

/// Why a cut vector ends where it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VectorEnd {
    /// The start-up position is reached.
    Position,
    /// The check surface stops the motion.
    CheckSurface {
        /// Its index in the command.
        check: usize,
        /// The relation reached.
        relation: Relation,
        /// For which time.
        occurrence: u32,
    },
    /// It is as long as MAXDP allows.
    MaximumStep,
    /// Its sag fills the tolerance of a surface.
    Curvature {
        /// Which surface.
        role: RoleName,
        /// Share of the tolerance that the clearance runs through, 0 to 1.
        used: f64,
    },
    /// The path turns too much for a longer vector to be proven. Radians.
    Turn {
        /// Angle to the next vector.
        angle: f64,
    },
    /// It was shortened so that the vector to the check surface keeps the tolerance.
    BeforeStop,
    /// A longer vector could not be proven to keep the tolerance of this surface.
    Proof {
        /// Which surface.
        role: RoleName,
    },
}

/// One cut vector.
#[derive(Debug, Clone, PartialEq)]
pub struct StoryVector {
    /// Its length.
    pub length: f64,
    /// Why it ends.
    pub end: VectorEnd,
    /// Least and greatest clearance of the part and the drive surface seen on it, where they are bound to it.
    pub clearance: [Option<[f64; 2]>; 2],
}

/// The story of one motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Story {
    /// How it was computed.
    pub route: Route,
    /// True for a start-up motion.
    pub start_up: bool,
    /// Part, drive and check surface, as far as they take part.
    pub surfaces: Vec<StorySurface>,
    /// Where the tool was.
    pub start: ToolPosition,
    /// Where it is then.
    pub end: ToolPosition,
    /// The greatest angle between the tool axis on the way and that at the start, radians.
    pub turned: f64,
    /// Sense of travel at the start; none for start-up motions.
    pub forward: Option<Vec3>,
    /// Corrections that bring the tool onto its surfaces at the end, from the position before; none in closed form.
    pub corrections: Option<u32>,
    /// The cut vectors, in order.
    pub vectors: Vec<StoryVector>,
    /// The number of cut vectors that no motion can beat, where it is known.
    pub minimum: Option<u32>,
}

/// Places on a cut vector where clearances are looked at, ends included.
const SAMPLES: u32 = 9;
/// A vector this near to MAXDP is as long as allowed.
const AT_MAXIMUM: f64 = 1.0 - 1e-3;
/// Share of the band from which the sag is what ends a vector.
const FILLS: f64 = 0.5;
/// Angle between two vectors, radians, from which the turn is what ends the first (10°).
const TURNS: f64 = 0.175;

/// The story of the sequence that a command gave in a state; none for commands that are not motions along surfaces, and once `cancel`
/// says true.
pub fn tell(
    state: &State,
    command: &MotionCommand,
    sequence: &CutSequence,
    cancel: &dyn Fn() -> bool,
) -> Option<Story> {
    let waiting = Waiting::until(cancel);
    let route = match command {
        MotionCommand::Start(surfaces) => start_up::route(state, surfaces),
        MotionCommand::Offset(_) => Route::Iteration,
        MotionCommand::Drive { turn, drive, checks } => directed::route(state, *turn, drive, checks),
        _ => return None,
    };
    let end = *sequence.points.last()?;
    let teller = Teller::new(sequence, waiting.patience());
    let forward = (sequence.forward != Vec3::zeros()).then_some(sequence.forward);
    let story = Story {
        route,
        start_up: sequence.start_up,
        surfaces: teller.surfaces(&end),
        start: sequence.start,
        end,
        turned: sequence
            .points
            .iter()
            .map(|point| angle(&sequence.start.axis, &point.axis))
            .fold(0.0, f64::max),
        forward,
        corrections: if route == Route::ClosedForm { None } else { teller.corrections(&end) },
        vectors: teller.vectors(command),
        minimum: sequence.minimum,
    };
    (!waiting.has_given_up()).then_some(story)
}

/// Angle between two unit vectors, radians.
fn angle(a: &Vec3, b: &Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// A role of the sequence that can be measured.
struct Told<'a> {
    name: RoleName,
    role: &'a Role,
    gauge: Gauge,
}

struct Teller<'a> {
    sequence: &'a CutSequence,
    told: Vec<Told<'a>>,
    patience: Patience<'a>,
}

impl<'a> Teller<'a> {
    fn new(sequence: &'a CutSequence, patience: Patience<'a>) -> Self {
        let stop = sequence.stop.as_ref().map(|stop| (RoleName::Check(stop.index), &stop.role));
        let roles = [(RoleName::Part, sequence.part.as_ref()), (RoleName::Drive, sequence.drive.as_ref())];
        let roles = roles.into_iter().filter_map(|(name, role)| Some((name, role?))).chain(stop);
        let told = roles.filter_map(|(name, role)| {
            let surface = Surface::from_geometry_until(&role.surface.geometry, patience).ok()?;
            let on = role.relation == Relation::On;
            let memory = Memory::default();
            let (side, thickness, disk) = (role.side, role.thickness, role.disk);
            let gauge = Gauge { surface, on, side, thickness, disk, memory };
            Some(Told { name, role, gauge })
        });
        Self { sequence, told: told.collect(), patience }
    }

    fn tool(&self, at: &ToolPosition) -> Tool<'_> {
        Tool::awaited(self.sequence.cutter, at.axis, self.patience)
    }

    fn surfaces(&self, end: &ToolPosition) -> Vec<StorySurface> {
        let clearance =
            |told: &Told<'_>, at: &ToolPosition| told.gauge.contact(&self.tool(at), &at.tip).clearance;
        let surface = |told: &Told<'_>| StorySurface {
            role: told.name,
            name: told.role.surface.name.clone(),
            kind: told.role.surface.geometry.kind(),
            relation: told.role.relation,
            side: told.role.side,
            thickness: told.role.thickness,
            inside: told.role.inside_tolerance,
            outside: told.role.outside_tolerance,
            shape: match told.gauge.shape() {
                Shape::Flat => SurfaceShape::Flat,
                Shape::Convex => SurfaceShape::Convex,
                Shape::Concave => SurfaceShape::Concave,
                Shape::General => SurfaceShape::General,
            },
            clearance: [clearance(told, &self.sequence.start), clearance(told, end)],
        };
        self.told.iter().map(surface).collect()
    }

    /// How many corrections it takes from the position before the end onto the surfaces there.
    fn corrections(&self, end: &ToolPosition) -> Option<u32> {
        let points = &self.sequence.points;
        let before = points.len().checked_sub(2).and_then(|index| points.get(index));
        let from = before.unwrap_or(&self.sequence.start);
        let tool = self.tool(end);
        let tangent = |relation| matches!(relation, Relation::TangentToDrive | Relation::TangentToPart);
        let held: Vec<_> = self.told.iter().filter(|told| !tangent(told.role.relation)).collect();
        let conditions: Vec<Condition<'_>> = held
            .iter()
            .map(|told| Condition::Clearance(&told.gauge, told.gauge.contact(&tool, &end.tip).clearance))
            .collect();
        let attitude = Attitude::fixed(tool.clone());
        position::solve(&attitude, &conditions, &from.tip).ok().map(|solution| solution.corrections)
    }

    fn vectors(&self, command: &MotionCommand) -> Vec<StoryVector> {
        let positions: Vec<&ToolPosition> =
            std::iter::once(&self.sequence.start).chain(&self.sequence.points).collect();
        let mut vectors = Vec::with_capacity(self.sequence.points.len());
        for (index, pair) in positions.windows(2).enumerate() {
            let [from, to] = pair else { continue };
            if self.patience.is_over() {
                break;
            }
            let clearance = [RoleName::Part, RoleName::Drive].map(|role| self.seen(role, from, to));
            let length = (to.tip - from.tip).norm();
            let next = positions.get(index + 2).map(|next| next.tip - to.tip);
            let last_but_one = index + 3 == positions.len();
            let end = match next {
                None => self.stop(command),
                Some(next) => self.reason(&(to.tip - from.tip), &next, &clearance, last_but_one),
            };
            vectors.push(StoryVector { length, end, clearance });
        }
        vectors
    }

    /// What ends the motion.
    fn stop(&self, command: &MotionCommand) -> VectorEnd {
        let (Some(stop), MotionCommand::Drive { checks, .. }) = (&self.sequence.stop, command) else {
            return VectorEnd::Position;
        };
        let relation =
            checks.get(stop.index).map_or(stop.role.relation, |CheckSurface { relation, .. }| *relation);
        VectorEnd::CheckSurface { check: stop.index, relation, occurrence: stop.occurrence }
    }

    /// What ends a vector on the way.
    fn reason(
        &self,
        vector: &Vec3,
        next: &Vec3,
        clearance: &[Option<[f64; 2]>; 2],
        last_but_one: bool,
    ) -> VectorEnd {
        if vector.norm() >= self.sequence.maximum_step * AT_MAXIMUM {
            return VectorEnd::MaximumStep;
        }
        let mut most = (RoleName::Drive, 0.0);
        for (told, seen) in self.told.iter().zip(clearance) {
            let band = told.role.inside_tolerance + told.role.outside_tolerance;
            let used = seen.map_or(0.0, |[least, greatest]| (greatest - least) / band);
            if band > 0.0 && used > most.1 {
                most = (told.name, used.min(1.0));
            }
        }
        let (role, used) = most;
        if used >= FILLS {
            return VectorEnd::Curvature { role, used };
        }
        let angle = vector.cross(next).norm().atan2(vector.dot(next));
        if last_but_one {
            VectorEnd::BeforeStop
        } else if angle >= TURNS {
            VectorEnd::Turn { angle }
        } else {
            VectorEnd::Proof { role }
        }
    }

    /// Least and greatest clearance of a role on a vector; for a start-up motion there is none.
    fn seen(&self, role: RoleName, from: &ToolPosition, to: &ToolPosition) -> Option<[f64; 2]> {
        if self.sequence.start_up {
            return None;
        }
        let told = self.told.iter().find(|told| told.name == role)?;
        let tool = self.tool(from);
        let sweep = Sweep::new(&tool, (&from.tip, &from.axis), (&to.tip, &to.axis));
        let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
        for sample in 0..SAMPLES {
            let (tip, tool) = sweep.at(sweep.length * f64::from(sample) / f64::from(SAMPLES - 1));
            let clearance = told.gauge.contact(&tool, &tip).clearance;
            seen = [seen[0].min(clearance), seen[1].max(clearance)];
        }
        Some(seen)
    }
}

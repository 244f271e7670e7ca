//! Random motions on which the tool axis follows a surface, or is another one for every motion: the verifier proves the
//! bands of the turning tool, and at every position the axis is what its law says.
//!
//! Whether a refusal is right is not judged: the search for a path knows fixed axes only.

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    motion::{AxisAngle, MotionCommand, Relation, ToolAxis},
    surface::Surface,
};
use arelem::{
    MotionFailure,
    sequence::{CutSequence, Role, ToolPosition},
};

use crate::{
    case::{self, Case, Stance},
    judge::{Fault, Runner, Verdict},
    kinds::Kind,
    support::Random,
};

/// How exactly the angles hold at the positions.
const EXACT: f64 = 1e-9;
/// The same where nearest points are searched for.
const SEARCHED: f64 = 1e-8;
/// Angles to the normal, degrees.
const ANGLES: [f64; 2] = [3.0, 20.0];
/// The lead angle at most, as a share of the angle to the normal.
const LEADS: f64 = 0.8;
/// How far the next fixed axis may be from the last one, degrees.
const FARTHEST: f64 = 25.0;
/// Steps in which axis and contact are looked for together.
const ROUNDS: u32 = 100;
/// Places around the corner from which contact is looked for.
const AROUND: u32 = 8;
/// Positions of a sequence that is not proven that are shown.
const SHOWN: usize = 12;
/// Shapes that touch a surface under them at the corner: there the angles hold.
const CORNERED: [&str; 6] = ["ball", "flat", "bull nose", "tapered", "line", "needle"];

/// Sine between the other surface and the plane across a vector up to which an angle leads or lags.
const LEAST_ASIDE: f64 = 1e-3;
/// The way over which the axis comes to follow its law, as a multiple of what the turn moves the tool by at most.
const RUN_IN: f64 = 2.0;

/// A motion with the law of its axis.
#[derive(Debug)]
pub(crate) struct Turning {
    pub(crate) case: Case,
    mode: ToolAxis,
    exact: f64,
}

impl Turning {
    /// The motion that a seed stands for; None if no draw was a case.
    pub(crate) fn draw(part: Kind, drive: Kind, seed: u64) -> Option<Self> {
        let mut random = Random(seed ^ 0x5851_f42d_4c95_7f2d);
        let on_part = random.next() < 0.65;
        let mode = mode(on_part, &mut random);
        let exact = if part.is_slow() || drive.is_slow() { SEARCHED } else { EXACT };
        let stance = match mode {
            ToolAxis::Fixed(_) => Stance::Any,
            _ if on_part => Stance::Square,
            _ => Stance::SquareOn,
        };
        // Where the drive surface guides the axis, the tool end is ON it, and it is the surface under the tool.
        let case = if on_part {
            Case::draw_standing(part, drive, stance, seed)?
        } else {
            turned_round(Case::draw_standing(drive, part, stance, seed)?)
        };
        let mode = match mode {
            ToolAxis::Fixed(_) => ToolAxis::Fixed(case::near(&case.axis, FARTHEST, &mut random)),
            other => other,
        };
        Some(Self { case, mode, exact })
    }

    fn commands(&self) -> Vec<MotionCommand> {
        let mut commands = self.case.commands();
        let is_from = |c: &MotionCommand| matches!(c, MotionCommand::From { .. });
        let from = commands.iter().position(is_from).map_or(0, |at| at + 1);
        if let ToolAxis::Fixed(_) = self.mode {
            // The same again with another axis.
            let again: Vec<_> = commands[from..].to_vec();
            commands.extend([MotionCommand::MultipleAxes(Some(true)), MotionCommand::ToolAxis(self.mode)]);
            commands.extend(again);
        } else {
            commands.insert(from, MotionCommand::ToolAxis(self.mode));
        }
        commands
    }
}

fn mode(part: bool, random: &mut Random) -> ToolAxis {
    let angle = random.between(ANGLES[0], ANGLES[1]).to_radians() * random.pick(&[1.0, -1.0]);
    let lead = random.between(-LEADS, LEADS) * angle;
    let across = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
    let mode = match (random.next() * 6.0) as u32 {
        0 | 1 => return ToolAxis::Normal { part },
        2 => AxisAngle::Plain,
        3 => AxisAngle::Lead(lead),
        4 => AxisAngle::PerpendicularTo(across),
        _ if part => return ToolAxis::Fixed(Vec3::z()),
        _ => AxisAngle::Plain,
    };
    ToolAxis::AtAngle { part, angle, mode }
}

/// What was part surface is drive surface, and the other way round.
fn turned_round(case: Case) -> Case {
    Case {
        part: case.drive.clone(),
        drive: case.part.clone(),
        drive_side: apt_geometry::motion::DriveSide::On,
        passes_drive: false,
        surfaces: 3,
        ..case
    }
}

/// Runs the motion and asks the verifier and the law.
pub(crate) fn judge(turning: &Turning) -> Verdict {
    let mut runner = Runner::new(&turning.case);
    let outcome = runner.run(&turning.commands());
    if outcome == Err(MotionFailure::Cancelled) {
        return Verdict::Slow(format!("engine after {} sequences", runner.sequences.len()));
    }
    for sequence in &runner.sequences {
        match runner.fault(sequence) {
            Some(Fault::Slow(vectors)) => return Verdict::Slow(format!("verifier, {vectors} vectors")),
            Some(Fault::Wrong(words)) => {
                return Verdict::Wrong(format!("{:?}: {words} {}", turning.mode, positions(sequence)));
            }
            None => {}
        }
        if !sequence.start_up
            && CORNERED.contains(&turning.case.shape)
            && let Some(words) = misfit(turning, sequence)
        {
            return Verdict::Wrong(format!("{:?}: {words}", turning.mode));
        }
    }
    match outcome {
        Ok(()) => Verdict::Proven(runner.sequences.iter().map(|s| s.points.len()).sum()),
        Err(failure) => Verdict::Refused(format!("{failure:?}")),
    }
}

/// The first positions of a sequence, in short.
fn positions(sequence: &CutSequence) -> String {
    let all = std::iter::once(&sequence.start).chain(&sequence.points).take(SHOWN);
    let triple = |v: &Vec3| format!("({:.5} {:.5} {:.5})", v.x, v.y, v.z);
    all.map(|p| format!("{}{}", triple(&p.tip), triple(&p.axis))).collect::<Vec<_>>().join(" ")
}

/// A surface whose normal counts.
struct Guide {
    surface: Surface,
    sign: f64,
}

impl Guide {
    fn new(role: &Role, sign: f64) -> Self {
        Self { surface: Surface::from_geometry(&role.surface.geometry).expect("a surface"), sign }
    }

    /// The surface that guides the axis: on the side where the tool is, where the end is ON it where the axis is.
    fn base(role: &Role, start: &ToolPosition) -> Self {
        let natural = Self::new(role, 1.0);
        let side = natural.normal(&start.tip).dot(&start.axis).signum();
        Self { sign: if role.relation == Relation::On { side } else { role.side }, ..natural }
    }

    /// The surface towards which a positive angle tilts: to the side where the tool is, along its own normal for ON.
    fn other(role: &Role) -> Self {
        Self::new(role, if role.relation == Relation::On { 1.0 } else { role.side })
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        self.surface.foot(p).normal * self.sign
    }
}

/// Where the axis is not what its law says.
fn misfit(turning: &Turning, sequence: &CutSequence) -> Option<String> {
    let part_guides = match turning.mode {
        ToolAxis::Normal { part } | ToolAxis::AtAngle { part, .. } => part,
        _ => return None,
    };
    let (part, drive) = (sequence.part.as_ref()?, sequence.drive.as_ref()?);
    let (base, other) = if part_guides { (part, drive) } else { (drive, part) };
    let (base, other) = (Guide::base(base, &sequence.start), Guide::other(other));
    let cutter = sequence.cutter;
    let sense = sense(&turning.mode, (&base, &other), &sequence.start.tip, &sequence.forward);
    let off = |at: &ToolPosition| off(&turning.mode, (&base, &other), &cutter, (&at.tip, &at.axis), sense);
    // A tool that stands otherwise at the start may turn over a way.
    let widest = 0.5 * cutter.diameter + cutter.height;
    let run_in = RUN_IN * widest * off(&sequence.start);
    let mut runs_in = true;
    for point in &sequence.points {
        let off = off(point);
        runs_in &= (point.tip - sequence.start.tip).norm() <= run_in && off > turning.exact;
        if off > turning.exact && !runs_in {
            return Some(format!("axis off by {off:e} at {point:?}"));
        }
    }
    None
}

/// The sense that the angles have all along a motion: of the lead against the product of both normals, and of the turn about a vector,
/// towards the side of the other surface, or ahead where that lies across.
fn sense(mode: &ToolAxis, (base, other): (&Guide, &Guide), tip: &Vec3, forward: &Vec3) -> f64 {
    let (normal, aside) = (base.normal(tip), other.normal(tip));
    match mode {
        ToolAxis::AtAngle { mode: AxisAngle::Lead(_), .. } => normal.cross(&aside).dot(forward).signum(),
        ToolAxis::AtAngle { mode: AxisAngle::PerpendicularTo(vector), .. } => {
            let vector = vector.normalize();
            let turning = vector.cross(&(normal - vector * normal.dot(&vector)).normalize());
            let towards = aside.dot(&turning);
            if towards.abs() > LEAST_ASIDE { towards.signum() } else { forward.dot(&turning).signum() }
        }
        _ => 1.0,
    }
}

/// How far the axis is from what its law asks for.
fn off(
    mode: &ToolAxis,
    (base, other): (&Guide, &Guide),
    cutter: &Cutter,
    (tip, axis): (&Vec3, &Vec3),
    sense: f64,
) -> f64 {
    let ToolAxis::AtAngle { angle, mode, .. } = mode else { return (axis - base.normal(tip)).norm() };
    let aside = other.normal(tip);
    // The angles hold at the contact, which moves with the axis: both are looked for together. On a surface that bends more
    // than the corner does there may be several contacts.
    let settled = |first: Vec3| {
        let mut normal = base.normal(&first);
        let mut asked = asked((*angle, mode), &normal, &aside, sense);
        for _ in 0..ROUNDS {
            let radial =
                (normal - asked * normal.dot(&asked)).try_normalize(1e-6).unwrap_or_else(Vec3::zeros);
            let corner = asked * cutter.corner_height - radial * cutter.corner_offset.max(0.0);
            normal = base.normal(&(tip + corner));
            asked = self::asked((*angle, mode), &normal, &aside, sense);
        }
        (asked - axis).norm()
    };
    let across = apt_geometry::surface::perpendicular(axis);
    let around = (0..AROUND).map(|k| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(AROUND)).sin_cos();
        let radial = (across * cos + axis.cross(&across) * sin) * cutter.corner_offset.max(0.0);
        tip + axis * cutter.corner_height + radial
    });
    std::iter::once(*tip).chain(around).map(settled).fold(f64::INFINITY, f64::min)
}

/// The axis that the angles ask for with a normal of the guiding surface.
fn asked((angle, mode): (f64, &AxisAngle), normal: &Vec3, aside: &Vec3, sense: f64) -> Vec3 {
    let tangent = normal.cross(aside).normalize();
    let across = tangent.cross(normal);
    let (sine, cosine) = angle.sin_cos();
    match mode {
        AxisAngle::Plain => normal * cosine + across * sine,
        AxisAngle::Lead(lead) => {
            let rest = (1.0 - cosine * cosine - lead.sin().powi(2)).max(0.0).sqrt().copysign(angle);
            normal * cosine + tangent * (sense * lead.sin()) + across * rest
        }
        AxisAngle::PerpendicularTo(vector) => {
            let vector = vector.normalize();
            let flat = (normal - vector * normal.dot(&vector)).normalize();
            flat * cosine + vector.cross(&flat) * (sense * sine)
        }
    }
}

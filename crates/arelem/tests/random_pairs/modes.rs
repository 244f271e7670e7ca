//! Random motions on which the tool axis follows a surface, or is another one for every motion: the verifier proves the
//! bands of the turning tool, at every position the axis is what its law says, and what is refused is looked for with an axis
//! that stands as the law says.

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    motion::{AxisAngle, AxisTangency, DriveSide, MotionCommand, Relation, ToolAxis},
    surface::Surface,
};
use arelem::{
    MotionFailure,
    clearance::Tool,
    sequence::{CutSequence, ToolPosition},
};

use crate::{
    case::{self, Case, Placed, Stance},
    judge::{self, Fault, Runner, Verdict},
    kinds::Kind,
    search::{LEAST_FORWARD, Reader},
    stand::Stand,
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
/// Shapes that touch a surface under them at the corner: there the angles hold.
const CORNERED: [&str; 6] = ["ball", "flat", "bull nose", "tapered", "line", "needle"];

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
            turned_round(Case::draw_standing(drive, part, stance, seed)?)?
        };
        let mode = match mode {
            ToolAxis::Fixed(_) => ToolAxis::Fixed(case::near(&case.axis, FARTHEST, &mut random)),
            other => other,
        };
        Some(Self { case, mode, exact })
    }

    /// The same with an axis that lies along the drive surface.
    pub(crate) fn draw_beside(part: Kind, drive: Kind, seed: u64) -> Option<Self> {
        let mut random = Random(seed ^ 0x2545_f491_4f6c_dd1d);
        let exact = if part.is_slow() || drive.is_slow() { SEARCHED } else { EXACT };
        let case = Case::draw_standing(part, drive, Stance::Beside, seed)?;
        let mode = mode_beside(drive, &case.forward, &mut random);
        Some(Self { case, mode, exact })
    }

    fn is_fan(&self) -> bool {
        matches!(self.mode, ToolAxis::Tangent { mode: AxisTangency::Fan, .. })
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

/// The plane of an axis that lies along a surface is across a vector that is not far from the way.
fn mode_beside(drive: Kind, forward: &Vec3, random: &mut Random) -> ToolAxis {
    let height = random.between(0.0, 1.0);
    let height = random.pick(&[0.0, height]);
    let mode = match (random.next() * 4.0) as u32 {
        0 if drive == Kind::Ruled => return ToolAxis::Parallel { part: false },
        0 | 1 => AxisTangency::Across,
        2 => AxisTangency::PerpendicularTo(case::near(forward, FARTHEST, random)),
        _ => return ToolAxis::Tangent { height: 0.0, mode: AxisTangency::Fan },
    };
    ToolAxis::Tangent { height, mode }
}

/// What was part surface is drive surface, and the other way round. None where the tool comes from the other side of what is part
/// surface then.
fn turned_round(case: Case) -> Option<Case> {
    let stop = match case.stop.relation {
        Relation::TangentToDrive => Relation::TangentToPart,
        Relation::TangentToPart => Relation::TangentToDrive,
        other => other,
    };
    (!case.passes_drive).then(|| Case {
        part: case.drive.clone(),
        drive: case.part.clone(),
        stop: Placed { relation: stop, ..case.stop.clone() },
        drive_side: DriveSide::On,
        surfaces: 3,
        ..case
    })
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
                return Verdict::Wrong(format!("{:?}: {words}", turning.mode));
            }
            None => {}
        }
        let has_law =
            !matches!(turning.mode, ToolAxis::AtAngle { .. }) || CORNERED.contains(&turning.case.shape);
        if !sequence.start_up
            && has_law
            && let Some(words) = misfit(turning, sequence)
        {
            return Verdict::Wrong(format!("{:?}: {words}", turning.mode));
        }
    }
    match outcome {
        Ok(()) => Verdict::Proven(runner.sequences.iter().map(|s| s.points.len()).sum()),
        Err(failure) => refused(turning, &runner, &failure),
    }
}

/// Where the axis is not what its law says.
fn misfit(turning: &Turning, sequence: &CutSequence) -> Option<String> {
    let (part, drive) = (sequence.part.as_ref()?, sequence.drive.as_ref()?);
    let cutter = sequence.cutter;
    let begin = (&sequence.start, &sequence.forward);
    let stand = Stand::of_motion(&turning.mode, (part, drive), &cutter, begin)?;
    if turning.is_fan() {
        let band = turning.case.inside + turning.case.outside;
        return stand.off_fan(&sequence.start, &sequence.points, (turning.exact, band));
    }
    // A tool that stands otherwise at the start may turn over a way.
    let widest = 0.5 * cutter.diameter + cutter.height;
    let run_in = RUN_IN * widest * stand.off(&sequence.start);
    let mut runs_in = true;
    let band = turning.case.inside + turning.case.outside;
    for point in sequence.points.iter().filter(|point| !stand.is_about_vertex(point, band)) {
        let off = stand.off(point);
        runs_in &= (point.tip - sequence.start.tip).norm() <= run_in && off > turning.exact;
        if off > turning.exact && !runs_in {
            return Some(format!("axis off by {off:e} at {point:?}"));
        }
    }
    None
}

/// Whether a refusal is right: the search goes along with an axis that stands as its law says.
fn refused(turning: &Turning, runner: &Runner, failure: &MotionFailure) -> Verdict {
    let case = &turning.case;
    let at = ToolPosition { tip: runner.state.tip.unwrap_or(case.from), axis: runner.state.axis };
    if let ToolAxis::Fixed(axis) = turning.mode {
        return refused_with(axis, case, runner, (&at.tip, failure));
    }
    let has_started = !runner.sequences.is_empty();
    let begin = if has_started { at } else { ToolPosition { tip: case.place, axis: case.axis } };
    let forward = if has_started { case.forward } else { case.place - case.from };
    let cutter = Cutter::from_numbers(&case.cutter, 1.0).expect("a cutter");
    let stand =
        Stand::of_case(&turning.mode, (&case.part, &case.drive), &cutter, (&begin, &forward)).expect("a law");
    if turning.is_fan() {
        // Where it ends tells how it turns.
        return Verdict::NotJudged(format!("{failure:?}"));
    }
    let axis = |tip: &Vec3| stand.axis(tip);
    let start = has_started.then_some(at.tip);
    let reader = Reader::turning(case, &axis);
    if !case.is_tangent_on_one_side() || !case.is_tangent_there(&reader, &case.forward) {
        // The tangency was laid for an axis that keeps its direction.
        return Verdict::NotJudged(format!("{failure:?}"));
    }
    if let (MotionFailure::DirectionUndetermined { .. }, Some(tip)) = (failure, start)
        && let Some([_, line]) = reader.setting_out(&tip)
        && stand.leads_along(&tip, &line).is_some_and(|cosine| cosine <= LEAST_FORWARD)
    {
        // It would lag where it is to lead, along its own path.
        return Verdict::Refused(format!("{failure:?}"));
    }
    judge::told(&reader, start, failure)
}

/// The side of a surface on which a start-up from a place ends, as the middle of the tool sees it.
fn side_seen(placed: &Placed, case: &Case, (tip, axis): &(&Vec3, &Vec3)) -> f64 {
    let cutter = Cutter::from_numbers(&case.cutter, 1.0).expect("a cutter");
    let surface = Surface::from_geometry(&placed.geometry).expect("a surface");
    let seen = surface.signed_distance(&Tool::new(cutter, **axis).observer(tip)).signum();
    match placed.relation {
        Relation::On => placed.side,
        Relation::Past => -seen,
        _ => seen,
    }
}

/// The same where the axis is another one for the second motion.
fn refused_with(
    axis: Vec3,
    case: &Case,
    runner: &Runner,
    (tip, failure): (&Vec3, &MotionFailure),
) -> Verdict {
    let done = runner.sequences.len();
    if done < 2 {
        return judge::told(&Reader::new(case), (done > 0).then_some(*tip), failure);
    }
    if case.passes_drive {
        // It stands past the drive surface, and goes to the other side of it.
        return Verdict::NotJudged(format!("{failure:?}"));
    }
    let seen = |placed: &Placed| side_seen(placed, case, &(tip, &axis));
    if [&case.part, &case.drive].into_iter().any(|placed| seen(placed) != placed.side) {
        // It stands on another side with the second axis than the motion is for.
        return Verdict::NotJudged(format!("{failure:?}"));
    }
    let first = Placed { side: seen(&case.first), ..case.first.clone() };
    let second = Case { axis, from: *tip, is_certain: false, first, ..case.clone() };
    let reader = Reader::new(&second);
    if !second.is_tangent_there(&reader, &second.forward) {
        // The tangency was laid for the first axis.
        return Verdict::NotJudged(format!("{failure:?}"));
    }
    judge::told(&reader, (done > 2).then_some(*tip), failure)
}

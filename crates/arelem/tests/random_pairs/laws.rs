//! What holds of a motion whatever its surfaces: moved, mirrored and in another unit it is the same motion; backwards it
//! leads to where it came from; stopped on the way and taken up again it ends where it would have ended.

use apt_geometry::{
    Vec3,
    canonical::{Matrix, Plane},
    motion::{MotionCommand, Relation, Turn},
};
use arelem::{MotionFailure, sequence::CutSequence};
use nalgebra::{Rotation3, Unit};

use crate::{
    case::{Case, Placed, other},
    judge::{Fault, Runner},
    support::{Random, plane},
};

/// Ends of the same motion in another frame may differ by this share of the size of the coordinates, or by a band where the
/// surface is so flat that rounding decides where in the band an end lies.
const ROUNDING: f64 = 1e-6;
/// Where on the way a motion is stopped.
const MIDDLE: f64 = 0.5;
/// Vectors by which the counts of the same path may differ: one, and one more in so many.
const VECTORS_IN: usize = 10;
/// Cosine of the greatest angle between path and wall at which the end of the path counts as fixed by the wall.
const SQUARE: f64 = 0.5;

/// Cosine between a path and the tool axis above which a tool goes back by GOUP or GODOWN (8°): directions count across the axis.
const ALONG_AXIS: f64 = 0.99;

/// What is found of a motion.
pub(crate) enum Laws {
    /// It is refused, so that there is nothing to compare.
    NoMotion,
    /// Neither the motion nor what is compared with it ends within the budget.
    Slow(String),
    /// The laws that it breaks, each with evidence.
    Tried(Vec<String>),
}

/// Why a law is not obeyed.
enum Broken {
    Slow,
    Law(String),
}

impl From<MotionFailure> for Broken {
    fn from(failure: MotionFailure) -> Self {
        match failure {
            MotionFailure::Cancelled => Self::Slow,
            other => Self::Law(format!("{other:?}")),
        }
    }
}

impl From<Fault> for Broken {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Slow(_) => Self::Slow,
            Fault::Wrong(words) => Self::Law(words),
        }
    }
}

impl From<String> for Broken {
    fn from(words: String) -> Self {
        Self::Law(words)
    }
}

/// Tries the laws on a motion.
pub(crate) fn tried(case: &Case, random: &mut Random) -> Laws {
    let mut runner = Runner::new(case);
    match runner.run(&case.commands()) {
        Ok(()) => {}
        Err(MotionFailure::Cancelled) => return Laws::Slow("the motion".to_owned()),
        Err(_) => return Laws::NoMotion,
    }
    let Some(path) = runner.sequences.last() else { return Laws::NoMotion };
    let mut found = Vec::new();
    let mut all: Vec<_> = maps(random).iter().map(|(name, m)| (*name, image(case, path, m))).collect();
    all.push(("reversed", reversed(case, path)));
    all.push(("subdivided", subdivided(case, path)));
    for (name, result) in all {
        match result {
            Ok(()) => {}
            Err(Broken::Slow) => return Laws::Slow(name.to_owned()),
            Err(Broken::Law(words)) => found.push(format!("{name}: {words}")),
        }
    }
    Laws::Tried(found)
}

/// A rigid motion, a reflection and changes of unit.
fn maps(random: &mut Random) -> Vec<(&'static str, Matrix)> {
    let mut about = |low: f64, high: f64| {
        Vec3::new(random.between(low, high), random.between(low, high), random.between(low, high))
    };
    // Lines, circles and conics stay upright.
    let turn = Rotation3::from_axis_angle(&Unit::new_unchecked(Vec3::z()), about(-3.0, 3.0).x);
    let rigid = Matrix::from_parts(turn.matrix(), &about(-5.0, 5.0));
    let mirror = Plane { normal: turn * Vec3::x(), distance: 0.3 };
    vec![
        ("moved", rigid),
        ("mirrored", Matrix::reflection(&mirror)),
        ("in mm", Matrix::scaling(25.4)),
        ("in inches of mm", Matrix::scaling(1.0 / 25.4)),
        ("a thousand times", Matrix::scaling(1e3)),
        ("a thousandth", Matrix::scaling(1e-3)),
    ]
}

fn proven(runner: &Runner, sequences: &[CutSequence]) -> Result<(), Broken> {
    sequences.iter().find_map(|s| runner.fault(s)).map_or(Ok(()), |fault| Err(fault.into()))
}

fn counts_agree(a: usize, b: usize) -> bool {
    a.abs_diff(b) <= 1 + a.max(b) / VECTORS_IN
}

/// The motion under a map is the image of the motion.
fn image(case: &Case, path: &CutSequence, matrix: &Matrix) -> Result<(), Broken> {
    let mapped = case.under(matrix);
    let factor = matrix.linear().determinant().abs().cbrt();
    let mut runner = Runner::new(case);
    // How exactly the numbers of a cutter must agree is a length in inches.
    runner.state.units *= factor;
    runner.run(&mapped.commands())?;
    proven(&runner, &runner.sequences)?;
    let image = runner.sequences.last().ok_or_else(|| "no motion".to_owned())?;
    if !counts_agree(path.points.len(), image.points.len()) {
        return Err(format!("{} vectors instead of {}", image.points.len(), path.points.len()).into());
    }
    let wanted = matrix.apply_point(&end(path));
    let off = (end(image) - wanted).norm();
    let size = factor * (10.0 + end(path).norm());
    let slack = 4.0 * (mapped.inside + mapped.outside) / steepness(case, path);
    if off > (ROUNDING * size).max(slack) { Err(format!("ends {off:e} away").into()) } else { Ok(()) }
}

fn end(path: &CutSequence) -> Vec3 {
    path.points.last().map_or(path.start.tip, |p| p.tip)
}

/// How squarely the path meets what stops it: bands are passed in so much more way.
fn steepness(case: &Case, path: &CutSequence) -> f64 {
    let count = path.points.len();
    let before = if count > 1 { path.points[count - 2].tip } else { path.start.tip };
    let along = (end(path) - before).try_normalize(0.0).unwrap_or(case.forward);
    let normal = apt_geometry::surface::Surface::from_geometry(&case.stop.geometry)
        .map_or(along, |surface| surface.foot(&end(path)).normal);
    normal.dot(&along).abs().max(0.05)
}

fn wall(at: &Vec3, normal: &Vec3) -> Placed {
    let geometry = plane(normal.x, normal.y, normal.z, normal.dot(at));
    Placed { geometry, relation: Relation::On, side: 1.0, occurrence: 1, thickness: 0.0 }
}

/// The command with another motion word.
fn turned_to(command: MotionCommand, turn: Turn) -> MotionCommand {
    match command {
        MotionCommand::Drive { drive, checks, .. } => MotionCommand::Drive { turn, drive, checks },
        other => other,
    }
}

/// Back from the end to the plane of the start.
fn reversed(case: &Case, path: &CutSequence) -> Result<(), Broken> {
    let count = path.points.len();
    let before = if count > 1 { path.points[count - 2].tip } else { path.start.tip };
    let Some(back) = (before - end(path)).try_normalize(1e-9) else { return Ok(()) };
    // Where the path comes back to its first plane on the way, backwards it ends there.
    let start = path.start.tip;
    let beyond = |p: &Vec3| (p - start).dot(&path.forward) > 0.0;
    if !path.points.iter().all(|p| beyond(&p.tip)) {
        return Ok(());
    }
    let turned = Case { drive_side: other(case.drive_side), ..case.clone() };
    let mut runner = Runner::new(case);
    runner.run(&case.commands())?;
    let mut onward = turned.onward(&back, &wall(&start, &path.forward));
    let along = back.dot(&case.axis);
    if along.abs() > ALONG_AXIS {
        let turn = if along > 0.0 { Turn::Up } else { Turn::Down };
        onward = onward.into_iter().map(|command| turned_to(command, turn)).collect();
    }
    runner.run(&onward)?;
    let found = runner.sequences.last().ok_or_else(|| "no motion".to_owned())?;
    proven(&runner, std::slice::from_ref(found))?;
    let off = (end(found) - start).norm();
    let slack = 10.0 * (case.inside + case.outside);
    if off > slack {
        return Err(format!("ends {off:e} from the start").into());
    }
    let there = found.points.len();
    if there.abs_diff(count) > 2 + count / VECTORS_IN {
        return Err(format!("{there} vectors back, {count} there").into());
    }
    Ok(())
}

/// To a plane on the way, and on.
fn subdivided(case: &Case, path: &CutSequence) -> Result<(), Broken> {
    let half = (path.points.len() as f64 * MIDDLE) as usize;
    let from = if half == 0 { path.start.tip } else { path.points[half - 1].tip };
    let to = path.points[half].tip;
    let Some(along) = (to - from).try_normalize(1e-9) else { return Ok(()) };
    let middle = from + (to - from) * MIDDLE;
    // The plane must not be met before.
    let first = path.points[..half].iter().chain([&path.start]).all(|p| (p.tip - middle).dot(&along) < 0.0);
    if !first || case.stop.occurrence > 1 || along.dot(&path.forward) < SQUARE {
        return Ok(());
    }
    let mut runner = Runner::new(case);
    let mut commands = case.commands();
    let tail = case.onward(&case.forward, &wall(&middle, &along));
    commands.truncate(commands.len() - tail.len());
    commands.extend(tail);
    runner.run(&commands)?;
    runner.run(&case.onward(&along, &case.stop))?;
    let [.., first, second] = runner.sequences.as_slice() else { return Err("no motion".to_owned().into()) };
    proven(&runner, &runner.sequences[runner.sequences.len() - 2..])?;
    let off = (end(second) - end(path)).norm();
    let slack = 10.0 * (case.inside + case.outside) / steepness(case, path);
    if off > slack.max(ROUNDING * 10.0) {
        return Err(format!("ends {off:e} away").into());
    }
    let (count, parts) = (path.points.len(), first.points.len() + second.points.len());
    if parts > count + 3 + count / VECTORS_IN {
        return Err(format!("{parts} vectors instead of {count}").into());
    }
    Ok(())
}

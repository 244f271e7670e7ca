//! What holds of a motion whatever its surfaces: moved, mirrored and in another unit it is the same motion; backwards it
//! leads to where it came from; stopped on the way and taken up again it ends where it would have ended.

use apt_geometry::{
    Vec3,
    canonical::{Matrix, Plane},
    motion::Relation,
};
use arelem::sequence::CutSequence;
use nalgebra::{Rotation3, Unit};

use crate::{
    case::{Case, Placed, other},
    judge::{Runner, fault},
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

/// Laws broken by a motion that is proven, each with evidence.
pub(crate) fn broken(case: &Case, random: &mut Random) -> Vec<String> {
    let mut runner = Runner::new();
    if runner.run(&case.commands()).is_err() {
        return Vec::new();
    }
    let Some(path) = runner.sequences.last().cloned() else { return Vec::new() };
    let mut found = Vec::new();
    for (name, matrix) in maps(random) {
        found.extend(image(case, &path, &matrix).err().map(|words| format!("{name}: {words}")));
    }
    if let Some(words) = reversed(case, &path).err() {
        found.push(format!("reversed: {words}"));
    }
    if let Some(words) = subdivided(case, &path).err() {
        found.push(format!("subdivided: {words}"));
    }
    found
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

fn counts_agree(a: usize, b: usize) -> bool {
    a.abs_diff(b) <= 1 + a.max(b) / VECTORS_IN
}

/// The motion under a map is the image of the motion.
fn image(case: &Case, path: &CutSequence, matrix: &Matrix) -> Result<(), String> {
    let mapped = case.under(matrix);
    let mut runner = Runner::new();
    runner.run(&mapped.commands()).map_err(|failure| format!("{failure:?}"))?;
    if let Some(words) = runner.sequences.iter().find_map(fault) {
        return Err(words);
    }
    let image = runner.sequences.last().ok_or("no motion")?;
    if !counts_agree(path.points.len(), image.points.len()) {
        return Err(format!("{} vectors instead of {}", image.points.len(), path.points.len()));
    }
    let factor = matrix.linear().determinant().abs().cbrt();
    let wanted = matrix.apply_point(&end(path));
    let off = (end(image) - wanted).norm();
    let size = factor * (10.0 + end(path).norm());
    let slack = 4.0 * (mapped.inside + mapped.outside) / steepness(case, path);
    if off > (ROUNDING * size).max(slack) { Err(format!("ends {off:e} away")) } else { Ok(()) }
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
    Placed { geometry, relation: Relation::On, side: 1.0, occurrence: 1 }
}

/// Back from the end to the plane of the start.
fn reversed(case: &Case, path: &CutSequence) -> Result<(), String> {
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
    let mut runner = Runner::new();
    runner.run(&case.commands()).map_err(|failure| format!("{failure:?}"))?;
    let onward = turned.onward(&back, &wall(&start, &path.forward));
    runner.run(&onward).map_err(|failure| format!("{failure:?}"))?;
    let found = runner.sequences.last().ok_or("no motion")?;
    if let Some(words) = fault(found) {
        return Err(words);
    }
    let off = (end(found) - start).norm();
    let slack = 10.0 * (case.inside + case.outside);
    if off > slack {
        return Err(format!("ends {off:e} from the start"));
    }
    let there = found.points.len();
    if there.abs_diff(count) > 2 + count / VECTORS_IN {
        return Err(format!("{there} vectors back, {count} there"));
    }
    Ok(())
}

/// To a plane on the way, and on.
fn subdivided(case: &Case, path: &CutSequence) -> Result<(), String> {
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
    let mut runner = Runner::new();
    let mut commands = case.commands();
    let tail = case.onward(&case.forward, &wall(&middle, &along));
    commands.truncate(commands.len() - tail.len());
    commands.extend(tail);
    runner.run(&commands).map_err(|failure| format!("first: {failure:?}"))?;
    runner.run(&case.onward(&along, &case.stop)).map_err(|failure| format!("on: {failure:?}"))?;
    let [.., first, second] = runner.sequences.as_slice() else { return Err("no motion".to_owned()) };
    if let Some(words) = [first, second].into_iter().find_map(fault) {
        return Err(words);
    }
    let off = (end(second) - end(path)).norm();
    let slack = 10.0 * (case.inside + case.outside) / steepness(case, path);
    if off > slack.max(ROUNDING * 10.0) {
        return Err(format!("ends {off:e} away"));
    }
    let (count, parts) = (path.points.len(), first.points.len() + second.points.len());
    if parts > count + 3 + count / VECTORS_IN {
        return Err(format!("{parts} vectors instead of {count}"));
    }
    Ok(())
}

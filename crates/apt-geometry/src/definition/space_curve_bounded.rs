//! SCURV/SEG: a piece of a line or circle between its intersections with two others.

use super::{
    parametric_error::ParametricError,
    space_curve::{LineOrCircle, SegmentSide},
};
use crate::{Vec3, canonical::Plane, parametric::CurveArc};

/// Sine of the angle between lines below which they are parallel.
const PARALLEL: f64 = 1e-12;
/// Overlap of a line and a circle that just touch, as a share of the radius.
const TOUCH: f64 = 1e-9;
/// Greatest angle of one arc.
const ARC_ANGLE: f64 = 2.0 * std::f64::consts::FRAC_PI_3;

/// The arcs, in the plane that supplies z, from the first bound to the last one; on a circle counter-clockwise.
///
/// # Errors
/// A bound that does not meet the line or circle, or a plane of z that stands upright.
pub(super) fn arcs(
    base: &LineOrCircle,
    from: &(LineOrCircle, SegmentSide),
    to: &(LineOrCircle, SegmentSide),
    z_surface: &Plane,
) -> Result<Vec<CurveArc>, ParametricError> {
    let (first, last) = (meeting(base, &from.0, from.1)?, meeting(base, &to.0, to.1)?);
    let lift = |x: f64, y: f64| -> Result<Vec3, ParametricError> {
        let normal = z_surface.normal;
        if normal.z.abs() <= PARALLEL {
            return Err(ParametricError::NoIntersection);
        }
        Ok(Vec3::new(x, y, (z_surface.distance - normal.x * x - normal.y * y) / normal.z))
    };
    match base {
        LineOrCircle::Line(_) => {
            Ok(vec![CurveArc::segment(&lift(first.x, first.y)?, &lift(last.x, last.y)?)])
        }
        LineOrCircle::Circle(circle) => {
            let angle = |at: &Vec3| (at.y - circle.point.y).atan2(at.x - circle.point.x);
            let begin = angle(&first);
            let mut sweep = (angle(&last) - begin).rem_euclid(std::f64::consts::TAU);
            if sweep <= TOUCH {
                sweep = std::f64::consts::TAU;
            }
            let count = (sweep / ARC_ANGLE - TOUCH).ceil().max(1.0);
            let half = 0.5 * sweep / count;
            let (center, radius) = (circle.point, circle.radius.abs());
            let at =
                |turn: f64, reach: f64| lift(center.x + reach * turn.cos(), center.y + reach * turn.sin());
            (0..count as usize)
                .map(|index| {
                    let middle = begin + (2.0 * index as f64 + 1.0) * half;
                    let (p, q) = (at(middle - half, radius)?, at(middle + half, radius)?);
                    // An affine lift of a circle keeps its control points and weights.
                    Ok(CurveArc::conic(&p, &at(middle, radius / half.cos())?, [1.0, half.cos(), 1.0], &q))
                })
                .collect()
        }
    }
}

/// The intersection of two lines or circles in the xy-plane that lies farther to a side.
fn meeting(one: &LineOrCircle, other: &LineOrCircle, side: SegmentSide) -> Result<Vec3, ParametricError> {
    let found = match (one, other) {
        (LineOrCircle::Line(a), LineOrCircle::Line(b)) => vec![lines(a, b)?],
        (LineOrCircle::Line(line), LineOrCircle::Circle(circle))
        | (LineOrCircle::Circle(circle), LineOrCircle::Line(line)) => {
            line_circle(line, &circle.point, circle.radius.abs())?
        }
        (LineOrCircle::Circle(a), LineOrCircle::Circle(b)) => {
            let apart = Vec3::new(b.point.x - a.point.x, b.point.y - a.point.y, 0.0);
            let distance = apart.norm();
            if distance <= TOUCH * a.radius.abs() {
                return Err(ParametricError::NoIntersection);
            }
            let normal = apart / distance;
            let along = 0.5 * (distance + (a.radius * a.radius - b.radius * b.radius) / distance);
            let chord = Plane { normal, distance: normal.dot(&a.point) + along };
            line_circle(&chord, &a.point, a.radius.abs())?
        }
    };
    let key = |at: &Vec3| match side {
        SegmentSide::PositiveX => at.x,
        SegmentSide::NegativeX => -at.x,
        SegmentSide::PositiveY => at.y,
        SegmentSide::NegativeY => -at.y,
    };
    found.into_iter().max_by(|a, b| key(a).total_cmp(&key(b))).ok_or(ParametricError::NoIntersection)
}

fn lines(a: &Plane, b: &Plane) -> Result<Vec3, ParametricError> {
    let determinant = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
    if determinant.abs() <= PARALLEL {
        return Err(ParametricError::NoIntersection);
    }
    let x = (a.distance * b.normal.y - b.distance * a.normal.y) / determinant;
    let y = (a.normal.x * b.distance - b.normal.x * a.distance) / determinant;
    Ok(Vec3::new(x, y, 0.0))
}

fn line_circle(line: &Plane, center: &Vec3, radius: f64) -> Result<Vec<Vec3>, ParametricError> {
    let normal = Vec3::new(line.normal.x, line.normal.y, 0.0);
    let height = line.distance - normal.dot(center);
    let square = radius * radius - height * height;
    if square < -TOUCH * radius * radius {
        return Err(ParametricError::NoIntersection);
    }
    let foot = Vec3::new(center.x, center.y, 0.0) + normal * height;
    let along = Vec3::new(-normal.y, normal.x, 0.0) * square.max(0.0).sqrt();
    Ok(vec![foot + along, foot - along])
}

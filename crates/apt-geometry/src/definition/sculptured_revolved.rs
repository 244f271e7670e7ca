//! SSURF/REVOLV: exact surfaces of revolution.

use std::f64::consts::{FRAC_PI_3, TAU};

use nalgebra::{Rotation3, Unit, Vector4};

use super::{
    parametric_error::ParametricError,
    sculptured::{AxisInput, Turning},
    sculptured_define::{meshed, numbered},
};
use crate::{
    Vec3,
    parametric::{Patch, SculpturedSurface, SpaceCurve},
};

/// Greatest angle of a patch: three make a full turn.
const PATCH_ANGLE: f64 = 2.0 * FRAC_PI_3;
/// Share of a patch's angle by which it may exceed that: angles are decimal numbers.
const ANGLE_SLACK: f64 = 1e-9;

/// The surface: u along the profile, v along the sweep.
///
/// The angles are positions in degrees, counted from the second towards the third axis about the first one, with the
/// profile at 0; the sweep goes from the first to the second position in the sense of the word.
///
/// # Errors
/// An axis without a point or without length.
pub(super) fn surface(
    curve: &SpaceCurve,
    axis: &AxisInput,
    turning: Turning,
    angles: [f64; 2],
) -> Result<SculpturedSurface, ParametricError> {
    let (point, vector) = match axis {
        AxisInput::Points(from, to) => (*from, to - from),
        AxisInput::PointVector(point, vector) => (*point, *vector),
        AxisInput::Vector(_) => return Err(ParametricError::AxisForm),
    };
    let axis = Unit::try_new(vector, f64::MIN_POSITIVE).ok_or(ParametricError::ZeroVector)?;
    if angles.iter().any(|angle| !angle.is_finite()) {
        return Err(ParametricError::NotFinite);
    }
    let [first, last] = angles.map(f64::to_radians);
    let positive = |angle: f64| {
        let angle = angle.rem_euclid(TAU);
        // The same position again is a full turn.
        if angle <= ANGLE_SLACK || TAU - angle <= ANGLE_SLACK { TAU } else { angle }
    };
    let sweep = match turning {
        Turning::CounterClockwise => positive(last - first),
        Turning::Clockwise => -positive(first - last),
    };
    let rows = (sweep.abs() / PATCH_ANGLE - ANGLE_SLACK).ceil().max(1.0);
    let half = 0.5 * sweep / rows;
    let rows = rows as usize;
    let mut patches = Vec::with_capacity(rows * curve.arcs.len());
    for row in 0..rows {
        let middle = first + (2.0 * row as f64 + 1.0) * half;
        for arc in &curve.arcs {
            patches.push(Patch { control: arc.control.map(|at| turned(&at, &point, &axis, middle, half)) });
        }
    }
    Ok(numbered(meshed(patches, (curve.arcs.len(), rows)), curve, None))
}

/// The control points along v of the circle that a homogeneous point runs through, `half` to either side of `middle`.
fn turned(at: &Vector4<f64>, point: &Vec3, axis: &Unit<Vec3>, middle: f64, half: f64) -> [Vector4<f64>; 4] {
    let offset = at.xyz() - point * at.w;
    let along = axis.into_inner() * axis.dot(&offset);
    let radial = offset - along;
    let center = point * at.w + along;
    let ray = |angle: f64| Rotation3::from_axis_angle(axis, angle) * radial;
    let join = |place: Vec3, weight: f64| Vector4::new(place.x, place.y, place.z, weight);
    let (first, last) = (join(center + ray(middle - half), at.w), join(center + ray(middle + half), at.w));
    // The middle point is radial / cos away from the axis and has the weight cos: their product has no quotient.
    let between = join(center * half.cos() + ray(middle), at.w * half.cos());
    [first, (first + between * 2.0) / 3.0, (between * 2.0 + last) / 3.0, last]
}

//! SSURF/FROM: pieces of classic surfaces as patches (reference on sculptured surfaces 2.5).

use std::f64::consts::FRAC_PI_2;

use super::{parametric_error::ParametricError, sculptured::SurfaceRange, sculptured_define::meshed};
use crate::{
    Vec3,
    canonical::{Geometry, TabulatedCylinder},
    parametric::{CurveArc, Patch, SculpturedSurface},
};

/// Greatest angle of one arc.
const ARC_ANGLE: f64 = FRAC_PI_2;
/// Share of an arc's angle by which it may exceed that: angles are decimal numbers.
const ANGLE_SLACK: f64 = 1e-9;

/// The patches of a piece of a surface.
///
/// # Errors
/// A surface of another type, or a range that does not grow or leaves the surface.
pub(super) fn surface(
    surface: &Geometry,
    range: &SurfaceRange,
) -> Result<SculpturedSurface, ParametricError> {
    let (u, v) = (range.u, range.v);
    for [low, high] in [u, v] {
        if !(low.is_finite() && high.is_finite()) {
            return Err(ParametricError::NotFinite);
        }
        if low >= high {
            return Err(ParametricError::OutOfRange { value: high, least: low, greatest: f64::INFINITY });
        }
    }
    match surface {
        Geometry::Plane(plane) | Geometry::Line(plane) => {
            let foot = plane.normal * (plane.distance / plane.normal.norm_squared());
            let (x, y) = frame(&plane.normal)?;
            let line = |at: f64| CurveArc::segment(&(foot + x * u[0] + y * at), &(foot + x * u[1] + y * at));
            Ok(meshed(vec![Patch::between(&line(v[0]), &line(v[1]))], (1, 1)))
        }
        Geometry::Cylinder(cylinder) | Geometry::Circle(cylinder) => {
            let along = unit(&cylinder.axis)?;
            let at = |way: f64| (cylinder.point + along * way, cylinder.radius.abs());
            between_circles(&along, at(v[0]), at(v[1]), u)
        }
        Geometry::Cone(cone) => {
            let along = unit(&cone.axis)?;
            let tangent = (1.0 - cone.cosine * cone.cosine).max(0.0).sqrt() / cone.cosine;
            if v[0] < 0.0 || !tangent.is_finite() {
                return Err(ParametricError::OutOfRange { value: v[0], least: 0.0, greatest: f64::INFINITY });
            }
            let at = |way: f64| (cone.vertex + along * way, way * tangent);
            between_circles(&along, at(v[0]), at(v[1]), u)
        }
        Geometry::Sphere(sphere) => {
            if v[0] < -90.0 || v[1] > 90.0 {
                return Err(ParametricError::OutOfRange { value: v[1], least: -90.0, greatest: 90.0 });
            }
            sphere_piece(&sphere.center, sphere.radius.abs(), u, v)
        }
        Geometry::TabulatedCylinder(cylinder) => tabulated(cylinder, u, v),
        other => Err(ParametricError::NotConvertible { kind: other.kind() }),
    }
}

fn unit(vector: &Vec3) -> Result<Vec3, ParametricError> {
    vector.try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::ZeroVector)
}

/// Two unit vectors across a normal. The first is across z too where that is possible, else it is x.
fn frame(normal: &Vec3) -> Result<(Vec3, Vec3), ParametricError> {
    let normal = unit(normal)?;
    let first = Vec3::z().cross(&normal).try_normalize(ANGLE_SLACK).unwrap_or_else(Vec3::x);
    Ok((first, normal.cross(&first)))
}

/// Arcs of a circle about a centre in the frame of two vectors as long as its radius, between two angles in degrees.
fn circle(center: &Vec3, x: &Vec3, y: &Vec3, angles: [f64; 2]) -> Vec<CurveArc> {
    let [first, last] = angles.map(f64::to_radians);
    let count = ((last - first) / ARC_ANGLE - ANGLE_SLACK).ceil().max(1.0);
    let half = 0.5 * (last - first) / count;
    (0..count as usize)
        .map(|index| {
            let middle = first + (2.0 * index as f64 + 1.0) * half;
            let at = |angle: f64, reach: f64| center + (x * angle.cos() + y * angle.sin()) * reach;
            let weights = [1.0, half.cos(), 1.0];
            CurveArc::conic(
                &at(middle - half, 1.0),
                &at(middle, 1.0 / half.cos()),
                weights,
                &at(middle + half, 1.0),
            )
        })
        .collect()
}

/// A cylinder or cone between two circles (centre, radius).
fn between_circles(
    along: &Vec3,
    low: (Vec3, f64),
    high: (Vec3, f64),
    angles: [f64; 2],
) -> Result<SculpturedSurface, ParametricError> {
    let (x, y) = frame(along)?;
    let ring = |(center, radius): (Vec3, f64)| circle(&center, &(x * radius), &(y * radius), angles);
    let patches: Vec<Patch> =
        ring(low).iter().zip(&ring(high)).map(|(low, high)| Patch::between(low, high)).collect();
    let columns = patches.len();
    Ok(meshed(patches, (columns, 1)))
}

/// A piece of a sphere: circles of latitude whose centres and radii are themselves arcs of a circle.
fn sphere_piece(
    center: &Vec3,
    radius: f64,
    longitudes: [f64; 2],
    latitudes: [f64; 2],
) -> Result<SculpturedSurface, ParametricError> {
    // The unit circle along u and the meridian along v multiply, coordinate by coordinate, to a sphere about the origin.
    let around = circle(&Vec3::z(), &Vec3::x(), &Vec3::y(), longitudes);
    let meridian = Vec3::new(radius, radius, 0.0);
    let up = circle(&Vec3::zeros(), &meridian, &(Vec3::z() * radius), latitudes);
    let mut patches = Vec::with_capacity(around.len() * up.len());
    for across in &up {
        for along in &around {
            let control = along.control.map(|a| {
                across.control.map(|b| {
                    let mut point = a.component_mul(&b);
                    for axis in 0..3 {
                        point[axis] += center[axis] * point.w;
                    }
                    point
                })
            });
            patches.push(Patch { control });
        }
    }
    Ok(meshed(patches, (around.len(), up.len())))
}

/// Whole intervals of a tabulated cylinder, the first one after its straight extension being 0.
fn tabulated(
    cylinder: &TabulatedCylinder,
    intervals: [f64; 2],
    ways: [f64; 2],
) -> Result<SculpturedSurface, ParametricError> {
    // The first and the last interval are the extensions.
    let count = cylinder.intervals.len().saturating_sub(2) as f64;
    for value in intervals {
        if value < 0.0 || value > count || value.fract() != 0.0 {
            return Err(ParametricError::OutOfRange { value, least: 0.0, greatest: count });
        }
    }
    let [x, y, w] = cylinder.axes;
    let mut patches = Vec::new();
    for index in intervals[0] as usize + 1..=intervals[1] as usize {
        let Some(interval) = cylinder.intervals.get(index) else { break };
        let next = cylinder.intervals.get(index + 1).map_or(cylinder.last, |next| [next.u, next.v]);
        let chord = [next[0] - interval.u, next[1] - interval.v];
        let length = interval.length;
        let along = (x * chord[0] + y * chord[1]) / length;
        let across = (y * chord[0] - x * chord[1]) / length;
        let start = x * interval.u + y * interval.v;
        // Height s(s−L)(a(s+L)+b) with s = L t, in powers of t.
        let (a, b) = (interval.a * length.powi(3), interval.b * length.powi(2));
        let powers = [start, along * length - across * (a + b), across * b, across * a];
        let arc = CurveArc::from_power(&powers);
        patches.push(Patch::between(&arc.shifted(&(w * ways[0])), &arc.shifted(&(w * ways[1]))));
    }
    let columns = patches.len();
    Ok(meshed(patches, (columns, 1)))
}

//! The points of a pocket: projection, plane, convexity, and where the tool centre runs along the walls.

use std::f64::consts::TAU;

use apt_geometry::{Vec3, canonical::Geometry, motion::NamedSurface};

use super::{
    failure::{CornerFault, PocketFailure},
    polygon::{Polygon, Vec2},
};

/// Points nearer than this in every coordinate are the same, program units (the number of APT III).
const SAME_POINT: f64 = 5e-4;
/// Difference of two unit vectors, in every coordinate, below which they are the same direction (APT III).
const SAME_DIRECTION: f64 = 5e-4;
/// Sine of the least angle between the tool axis and the plane of the pocket, about 12 degrees (APT III).
const LEAST_SINE: f64 = 0.2;
/// Sine of the angle below which the axis is parallel to the plane that points are projected on.
const PARALLEL_SINE: f64 = 1e-9;

/// A convex pocket in its plane.
pub(super) struct Outline {
    origin: Vec3,
    across: [Vec3; 2],
    axis: Vec3,
    /// The points of the statement.
    pub(super) polygon: Polygon,
}

/// The points, moved along the tool axis to the part surface.
pub(super) fn project(points: &[Vec3], axis: &Vec3, part: &NamedSurface) -> Result<Vec<Vec3>, PocketFailure> {
    let (Geometry::Plane(plane) | Geometry::Line(plane)) = &part.geometry else {
        return Err(PocketFailure::PartNotPlane { kind: part.geometry.kind() });
    };
    let slope = plane.normal.dot(axis);
    let sine = slope.abs() / plane.normal.norm();
    if sine.is_nan() || sine < PARALLEL_SINE {
        return Err(PocketFailure::AxisInPlane { sine: if sine.is_nan() { 0.0 } else { sine } });
    }
    let on_plane = |point: &Vec3| point + axis * ((plane.distance - plane.normal.dot(point)) / slope);
    Ok(points.iter().map(on_plane).collect())
}

impl Outline {
    /// Checks the points (3501 to 3504) and the tool axis (3507).
    pub(super) fn of(points: &[Vec3], axis: &Vec3) -> Result<Self, PocketFailure> {
        let fail = |corner: usize, fault| {
            let at = points.get(corner).copied().unwrap_or_else(Vec3::zeros);
            PocketFailure::Corner { corner, at, fault }
        };
        let count = points.len();
        let before = |k: usize| (k + count - 1) % count;
        let same = |a: &Vec3, b: &Vec3, limit: f64| (a - b).amax() <= limit;
        let earlier = |k: usize| (0..k).find(|&other| same(&points[k], &points[other], SAME_POINT));
        if let Some((corner, other)) = (1..count).find_map(|k| Some((k, earlier(k)?))) {
            return Err(fail(corner, CornerFault::Duplicate { other }));
        }
        let sides: Vec<Vec3> = (0..count).map(|k| (points[k] - points[before(k)]).normalize()).collect();
        // sides[k] ends at point k.
        let after = |k: usize| sides[(k + 1) % count];
        if let Some(corner) = (0..count).find(|&k| same(&sides[k], &after(k), SAME_DIRECTION)) {
            return Err(fail(corner, CornerFault::Collinear));
        }
        let mut normals = Vec::with_capacity(count);
        for (k, side) in sides.iter().enumerate() {
            // A side that comes straight back has no normal: its three points are on a line as well.
            let across = side.cross(&after(k)).try_normalize(SAME_DIRECTION);
            normals.push(across.ok_or_else(|| fail(k, CornerFault::Collinear))?);
        }
        let Some(first) = normals.first().copied() else { return Err(fail(0, CornerFault::Collinear)) };
        let is_along = |normal: &Vec3, other: &Vec3| same(other, normal, SAME_DIRECTION);
        let is_in_plane = |other: &Vec3| is_along(&first, other) || is_along(&-first, other);
        if let Some(corner) = normals.iter().position(|other| !is_in_plane(other)) {
            return Err(fail(corner, CornerFault::NotInPlane));
        }
        // The figure turns as its corners do in sum; the first one may be against that.
        let turns = sides.iter().zip(&normals).enumerate();
        let whole: f64 =
            turns.map(|(corner, (side, other))| side.angle(&after(corner)) * other.dot(&first)).sum();
        let normal = if whole < 0.0 { -first } else { first };
        if let Some(corner) = normals.iter().position(|other| !is_along(&normal, other)) {
            return Err(fail(corner, CornerFault::Concave));
        }
        // Every corner turns the same way; more than one whole turn is a star.
        let mut turned = 0.0;
        for (corner, side) in sides.iter().enumerate() {
            turned += side.angle(&after(corner));
            if turned > 1.5 * TAU {
                return Err(fail(corner, CornerFault::Concave));
            }
        }
        let sine = normal.dot(axis).abs();
        if sine <= LEAST_SINE {
            return Err(PocketFailure::AxisInPlane { sine });
        }
        Ok(Self::in_plane(points, &normal, axis))
    }

    fn in_plane(points: &[Vec3], normal: &Vec3, axis: &Vec3) -> Self {
        // The frame looks against the tool axis; seen from there the points run clockwise if the normal points away.
        let turn = if normal.dot(axis) < 0.0 { -1.0 } else { 1.0 };
        let up = normal * turn;
        // The origin is the foot of the base origin, so that coordinates of level pockets stay as they are given.
        let origin = points.first().map_or_else(Vec3::zeros, |point| up * up.dot(point));
        let level = Vec3::x() - up * up.x;
        // With the normal along x any direction across it will do.
        let first = level.try_normalize(LEAST_SINE).unwrap_or_else(|| {
            let y = Vec3::y() - up * up.y;
            y.normalize()
        });
        let across = [first, up.cross(&first)];
        let flat = |point: &Vec3| {
            let from = point - origin;
            Vec2::new(from.dot(&across[0]), from.dot(&across[1]))
        };
        let polygon = Polygon::new(points.iter().map(flat).collect(), turn);
        Self { origin, across, axis: *axis, polygon }
    }

    /// The point of the plane in space.
    pub(super) fn in_space(&self, point: &Vec2) -> Vec3 {
        self.origin + self.across[0] * point.x + self.across[1] * point.y
    }

    /// Where the tool centre runs if the points are corners of walls parallel to the tool axis: the distance from a
    /// wall is measured across the axis, so that it is longer in a canted plane.
    pub(super) fn centers(&self, radius: f64) -> Result<Polygon, PocketFailure> {
        let distance = |(along, inward): (Vec2, Vec2)| {
            let in_space = |v: &Vec2| self.across[0] * v.x + self.across[1] * v.y;
            let wall = in_space(&along).cross(&self.axis).normalize();
            radius / wall.dot(&in_space(&inward)).abs()
        };
        let distances: Vec<f64> = self.polygon.directions().map(distance).collect();
        let inset = self.polygon.inset_each(|k| distances.get(k).copied().unwrap_or(radius));
        inset.ok_or_else(|| PocketFailure::DoesNotFit {
            radius,
            greatest: radius * self.polygon.greatest(&distances),
        })
    }
}

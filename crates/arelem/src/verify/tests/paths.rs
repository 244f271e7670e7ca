//! Valid cut sequences made from closed forms, without any engine.

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    cutter::Cutter,
    motion::{DriveSide, Relation},
};

use super::{cone, cutter, cylinder, plane, role, sphere};
use crate::sequence::{CutSequence, Role, Stop, ToolPosition};

/// Band used by every path: INTOL, OUTTOL.
pub(super) const BAND: (f64, f64) = (0.0005, 0.001);

/// A path with its name.
pub(super) struct Path {
    pub(super) name: &'static str,
    pub(super) sequence: CutSequence,
    /// The role that is curved along the path: shifting a vertex along its normal breaks it.
    pub(super) curved: Curved,
}

/// Which role bends the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Curved {
    Part,
    Drive,
    Neither,
}

fn at(tip: Vec3) -> ToolPosition {
    ToolPosition { tip, axis: Vec3::z() }
}

pub(super) fn sequence(
    tips: &[Vec3],
    cutter: Cutter,
    part: Role,
    drive: Role,
    stop: Role,
    drive_side: DriveSide,
) -> CutSequence {
    CutSequence {
        start: at(tips[0]),
        points: tips[1..].iter().map(|t| at(*t)).collect(),
        cutter,
        part: Some(part),
        drive: Some(drive),
        stop: Some(Stop { role: stop, occurrence: 1, index: 0 }),
        drive_side,
        start_up: false,
        forward: (tips[1] - tips[0]).normalize(),
        maximum_step: 10.0,
        minimum: None,
    }
}

/// Vertices on a circle at `radius` with equal steps of at most the angle whose chord dips to `inner`.
fn ring(radius: f64, inner: f64, turn: f64, place: impl Fn(f64, f64) -> Vec3) -> Vec<Vec3> {
    let step = 2.0 * (inner / radius).acos() * 0.999;
    let count = (turn.abs() / step).ceil() as usize;
    (0..=count)
        .map(|k| {
            let (s, c) = (turn * k as f64 / count as f64).sin_cos();
            place(radius * c, radius * s)
        })
        .collect()
}

/// The plane through the last position across the last vector.
pub(super) fn end_plane(tips: &[Vec3], normal: Vec3) -> Role {
    let end = tips[tips.len() - 1];
    let before = tips[tips.len() - 2];
    let side = (normal.dot(&(before - end))).signum();
    role(plane(normal.into(), normal.dot(&end)), Relation::On, side, BAND.0, BAND.1)
}

pub(super) fn floor() -> Role {
    role(plane([0.0, 0.0, 1.0], 0.0), Relation::To, 1.0, BAND.0, BAND.1)
}

/// Round a circle of radius 2.5, a quarter turn, on its outside or inside.
pub(super) fn circle(outside: bool) -> Path {
    let tool = cutter(&[0.5, 0.125]);
    let (radius, inner) =
        if outside { (2.75 + BAND.1, 2.75 - BAND.0) } else { (2.25 + BAND.0, 2.25 - BAND.1) };
    let turn = std::f64::consts::FRAC_PI_2;
    let tips = ring(radius, inner, turn, |x, y| Vec3::new(x, y, 0.0));
    let side = if outside { 1.0 } else { -1.0 };
    let drive = role(cylinder([0.0; 3], [0.0, 0.0, 1.0], 2.5), Relation::To, side, BAND.0, BAND.1);
    // Counter-clockwise: the circle is on the left, so outside is right.
    let drive_side = if outside { DriveSide::Right } else { DriveSide::Left };
    let stop = end_plane(&tips, Vec3::x());
    Path {
        name: if outside { "outside of a circle" } else { "inside of a circle" },
        sequence: sequence(&tips, tool, floor(), drive, stop, drive_side),
        curved: Curved::Drive,
    }
}

/// Ball over a sphere in a plane beside its centre.
pub(super) fn sphere_section() -> Path {
    let tool = cutter(&[0.5, 0.25]);
    let offset = 0.8f64;
    let radius = ((2.25 + BAND.1).powi(2) - offset * offset).sqrt();
    let inner = ((2.25 - BAND.0).powi(2) - offset * offset).sqrt();
    let tips = ring(radius, inner, 1.2, |a, b| {
        let (s, c) = 0.6f64.sin_cos();
        Vec3::new(-s * a + c * b, offset, c * a + s * b - 0.25)
    });
    let part = role(sphere([0.0; 3], 2.0), Relation::To, 1.0, BAND.0, BAND.1);
    let drive = role(plane([0.0, 1.0, 0.0], offset), Relation::On, 1.0, BAND.0, BAND.1);
    let stop = end_plane(&tips, Vec3::x());
    Path {
        name: "ball over a sphere",
        sequence: sequence(&tips, tool, part, drive, stop, DriveSide::On),
        curved: Curved::Part,
    }
}

/// Ball inside a bowl, in its centre plane.
pub(super) fn bowl() -> Path {
    let tool = cutter(&[0.5, 0.25]);
    let (radius, inner) = (4.75 + BAND.0, 4.75 - BAND.1);
    let tips = ring(radius, inner, 0.6, |a, b| {
        let (s, c) = 0.3f64.sin_cos();
        Vec3::new(-s * a + c * b, 0.0, 5.0 - (c * a + s * b) - 0.25)
    });
    let part = role(sphere([0.0, 0.0, 5.0], 5.0), Relation::To, -1.0, BAND.0, BAND.1);
    let drive = role(plane([0.0, 1.0, 0.0], 0.0), Relation::On, 1.0, BAND.0, BAND.1);
    let stop = end_plane(&tips, Vec3::x());
    Path {
        name: "ball in a bowl",
        sequence: sequence(&tips, tool, part, drive, stop, DriveSide::On),
        curved: Curved::Part,
    }
}

/// Round a cone at constant height with a ball (W29).
pub(super) fn round_cone() -> Path {
    let tool = cutter(&[0.5, 0.25]);
    let (sine, cosine) = 30f64.to_radians().sin_cos();
    let nominal = (2.75 * sine + 0.25) / cosine;
    let (radius, inner) = (nominal + BAND.1 / cosine, nominal - BAND.0 / cosine);
    let tips = ring(radius, inner, std::f64::consts::FRAC_PI_2, |x, y| Vec3::new(x, y, 0.0));
    let drive = role(cone([0.0, 0.0, 3.0], [0.0, 0.0, -1.0], 30.0), Relation::To, 1.0, BAND.0, BAND.1);
    let stop = end_plane(&tips, Vec3::x());
    Path {
        name: "round a cone",
        sequence: sequence(&tips, tool, floor(), drive, stop, DriveSide::Right),
        curved: Curved::Drive,
    }
}

/// Along a line until TO, ON or PAST a circle (W31).
pub(super) fn to_circle(relation: Relation, occurrence: u32) -> Path {
    let tool = cutter(&[0.5, 0.0]);
    let (x, side) = match (relation, occurrence) {
        (Relation::To, 1) => (1.775255129, 1.0),
        (Relation::On, 1) => (2.031754163, 1.0),
        (Relation::Past, 1) => (2.292893219, -1.0),
        (Relation::To, _) => (3.707106781, -1.0),
        (Relation::On, _) => (3.968245837, -1.0),
        _ => (4.224744871, 1.0),
    };
    let tips = [Vec3::new(0.0, -0.25, 0.0), Vec3::new(x, -0.25, 0.0)];
    let drive = role(plane([0.0, 1.0, 0.0], 0.0), Relation::To, -1.0, BAND.0, BAND.1);
    let check = role(cylinder([3.0, 0.0, 0.0], [0.0, 0.0, 1.0], 1.0), relation, side, BAND.0, BAND.1);
    let mut sequence = sequence(&tips, tool, floor(), drive, check, DriveSide::Right);
    if let Some(stop) = &mut sequence.stop {
        stop.occurrence = occurrence;
    }
    Path { name: "along a line to a circle", sequence, curved: Curved::Neither }
}

/// Along a line until it is tangent to a circle.
pub(super) fn tangent() -> Path {
    let tool = cutter(&[0.5, 0.0]);
    let tips = [Vec3::new(0.0, -0.25, 0.0), Vec3::new(2.0, -0.25, 0.0)];
    let drive = role(plane([0.0, 1.0, 0.0], 0.0), Relation::To, -1.0, BAND.0, BAND.1);
    let circle = cylinder([2.0, 1.0, 0.0], [0.0, 0.0, 1.0], 1.0);
    let check = role(circle, Relation::TangentToDrive, 1.0, BAND.0, BAND.1);
    let sequence = sequence(&tips, tool, floor(), drive, check, DriveSide::Right);
    Path { name: "line tangent to a circle", sequence, curved: Curved::Neither }
}

/// All curved paths and the plain ones.
pub(super) fn all() -> Vec<Path> {
    let mut paths = vec![circle(true), circle(false), sphere_section(), bowl(), round_cone(), tangent()];
    for relation in [Relation::To, Relation::On, Relation::Past] {
        paths.extend([1, 2].map(|n| to_circle(relation, n)));
    }
    paths
}

/// The same path with its surfaces written as quadrics where they can be (gradient outward).
pub(super) fn as_quadric(geometry: &Geometry) -> Geometry {
    let coefficients = match geometry {
        Geometry::Sphere(s) => {
            let c = s.center;
            [1.0, 1.0, 1.0, c.norm_squared() - s.radius * s.radius, 0.0, 0.0, 0.0, -c.x, -c.y, -c.z]
        }
        Geometry::Cylinder(c) if c.axis == Vec3::z() => {
            let p = c.point;
            [1.0, 1.0, 0.0, p.x * p.x + p.y * p.y - c.radius * c.radius, 0.0, 0.0, 0.0, -p.x, -p.y, 0.0]
        }
        other => return other.clone(),
    };
    super::quadric(coefficients)
}

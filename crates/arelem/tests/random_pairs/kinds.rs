//! Random surfaces of every kind, each with a random place on it, and how they are moved to where a tool touches them.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2, TAU};

use apt_geometry::{
    Vec3,
    canonical::{Cylinder, Geometry, Matrix, Quadric, Remembering, RuledSurface},
    surface::Surface,
};
use nalgebra::{Rotation3, Unit};

use crate::support::{Random, cone, cylinder, plane, quadric, sphere};
use crate::wave::wave;

/// The kinds of surfaces; one as part surface and one as drive surface make a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Plane,
    Line,
    Circle,
    Cylinder,
    Sphere,
    Cone,
    Quadric,
    Conic,
    Tabulated,
    Ruled,
    PolyConic,
}

impl Kind {
    pub(crate) const ALL: [Self; 11] = [
        Self::Plane,
        Self::Line,
        Self::Circle,
        Self::Cylinder,
        Self::Sphere,
        Self::Cone,
        Self::Quadric,
        Self::Conic,
        Self::Tabulated,
        Self::Ruled,
        Self::PolyConic,
    ];

    /// Lines, circles and the conics of the xy plane are cylinders along z.
    pub(crate) fn is_upright(self) -> bool {
        matches!(self, Self::Line | Self::Circle | Self::Conic)
    }

    /// Distances to these surfaces are searched for, not computed.
    pub(crate) fn is_slow(self) -> bool {
        matches!(self, Self::Tabulated | Self::Ruled | Self::PolyConic)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Line => "line",
            Self::Circle => "circle",
            Self::Cylinder => "cylinder",
            Self::Sphere => "sphere",
            Self::Cone => "cone",
            Self::Quadric => "quadric",
            Self::Conic => "conic",
            Self::Tabulated => "tabulated",
            Self::Ruled => "ruled",
            Self::PolyConic => "polyconic",
        }
    }
}

/// A surface as it was drawn, with a place near it.
struct Drawn {
    geometry: Geometry,
    near: Vec3,
}

/// A surface that goes through `place` with its natural normal times a side, which is returned, along `normal`. None where
/// the draw has no surface or no normal there.
pub(crate) fn through(
    kind: Kind,
    random: &mut Random,
    place: &Vec3,
    normal: &Vec3,
) -> Option<(Geometry, f64)> {
    let drawn = draw(kind, random);
    let foot = Surface::from_geometry(&drawn.geometry).ok()?.foot(&drawn.near);
    let side = random.pick(&[1.0, -1.0]);
    let (from, to) = (foot.normal * side, *normal);
    let spin = random.between(0.0, TAU);
    let turn = if kind.is_upright() {
        let angle = to.y.atan2(to.x) - from.y.atan2(from.x);
        Rotation3::from_axis_angle(&Vec3::z_axis(), angle)
    } else {
        let straight = Rotation3::rotation_between(&from, &to).unwrap_or_else(|| half_turn(&from));
        Rotation3::from_axis_angle(&Unit::new_normalize(to), spin) * straight
    };
    let shift = place - turn * foot.point;
    let moved = drawn.geometry.transform(&Matrix::from_parts(turn.matrix(), &shift)).ok()?;
    let surface = Surface::from_geometry(&moved).ok()?;
    let found = surface.foot(place);
    // The natural normal of some forms is turned by the motion.
    let side = found.normal.dot(normal).signum();
    let fits = found.distance.abs() < 1e-6 && (found.normal * side - normal).norm() < 1e-3;
    fits.then_some((moved, side))
}

fn half_turn(axis: &Vec3) -> Rotation3<f64> {
    let across = apt_geometry::surface::perpendicular(axis);
    Rotation3::from_axis_angle(&Unit::new_normalize(across), std::f64::consts::PI)
}

fn direction(random: &mut Random) -> Vec3 {
    loop {
        let v = Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        if (0.1..=1.0).contains(&v.norm()) {
            return v.normalize();
        }
    }
}

fn draw(kind: Kind, random: &mut Random) -> Drawn {
    match kind {
        Kind::Plane => Drawn { geometry: plane(0.0, 0.0, 1.0, 0.0), near: Vec3::zeros() },
        Kind::Line => {
            let Geometry::Plane(wall) = plane(1.0, 0.0, 0.0, 0.0) else { unreachable!("a plane") };
            Drawn { geometry: Geometry::Line(wall), near: Vec3::zeros() }
        }
        Kind::Circle => {
            let radius = random.between(1.0, 8.0);
            let circle = Cylinder { point: Vec3::zeros(), axis: Vec3::z(), radius };
            Drawn { geometry: Geometry::Circle(circle), near: Vec3::x() * radius }
        }
        Kind::Cylinder => {
            let radius = random.between(1.0, 8.0);
            Drawn { geometry: cylinder(0.0, Vec3::z(), radius), near: Vec3::x() * radius }
        }
        Kind::Sphere => {
            let radius = random.between(1.0, 8.0);
            Drawn { geometry: sphere(0.0, radius), near: direction(random) * radius }
        }
        Kind::Cone => {
            let angle = random.between(15.0, 75.0_f64).to_radians();
            let along = random.between(0.5, 6.0);
            let near = Vec3::new(angle.sin(), 0.0, angle.cos()) * along;
            Drawn { geometry: cone(0.0, Vec3::z(), angle.cos()), near }
        }
        Kind::Quadric => general(random),
        Kind::Conic => conic(random),
        Kind::Tabulated => {
            let height = random.between(0.1, 0.8);
            let geometry = wave([Vec3::x(), Vec3::y(), Vec3::z()], 0.0, height);
            let u = random.between(-3.5, 3.5);
            Drawn { geometry, near: Vec3::new(u, height * u.sin(), 0.0) }
        }
        Kind::Ruled => ruled(random),
        Kind::PolyConic => poly_conic(random),
    }
}

/// A quadric of any real type.
fn general(random: &mut Random) -> Drawn {
    let [a, b, c] = std::array::from_fn(|_| random.between(0.7, 4.0));
    let [p, q, r] = [a, b, c].map(|x: f64| 1.0 / (x * x));
    let flat = random.between(-1.5, 1.5);
    let near = direction(random) * random.between(0.5, 4.0);
    let at = |square: [f64; 3], rise: f64, constant: f64| {
        quadric([square[0], square[1], square[2], constant, 0.0, 0.0, 0.0, 0.0, 0.0, rise])
    };
    let geometry = match (random.next() * 9.0) as u32 {
        0 => at([p, q, r], 0.0, -1.0),
        1 => at([p, q, 0.0], -0.5, 0.0),
        2 => at([p, -q, 0.0], -0.5, 0.0),
        3 => at([p, q, -r], 0.0, -1.0),
        4 => at([p, q, -r], 0.0, 1.0),
        5 => at([p, q, -r], 0.0, 0.0),
        6 => at([p, q, 0.0], 0.0, -1.0),
        7 => at([p, -q, 0.0], 0.0, -1.0),
        _ => at([p, 0.0, 0.0], -0.5, 0.0),
    };
    Drawn { geometry, near: near + Vec3::z() * flat }
}

/// An ellipse, a hyperbola or a parabola in the xy plane.
fn conic(random: &mut Random) -> Drawn {
    let [p, q] = [(); 2].map(|()| random.between(0.8, 5.0).powi(-2));
    let near = Vec3::new(random.between(-4.0, 4.0), random.between(-4.0, 4.0), 0.0);
    let at = |square: [f64; 2], rise: f64, constant: f64| Quadric {
        coefficients: [square[0], square[1], 0.0, constant, 0.0, 0.0, 0.0, 0.0, rise, 0.0],
    };
    let geometry = match (random.next() * 3.0) as u32 {
        0 => Geometry::Ellipse(at([p, q], 0.0, -1.0)),
        1 => Geometry::Hyperbola(at([p, -q], 0.0, -1.0)),
        _ => Geometry::GeneralConic(at([p, 0.0], -0.5, 0.0)),
    };
    Drawn { geometry, near }
}

/// Parts that define one curve: a section of a plane or a cylinder, from one point to another.
fn section(random: &mut Random, height: f64) -> Vec<Geometry> {
    let (half, bend) = (4.0, random.between(-0.2, 0.2));
    let tilt = random.between(-0.3, 0.3);
    if random.next() < 0.5 {
        let normal = Vec3::new(-tilt, 1.0, 0.0).normalize();
        let [start, end] = [-half, half].map(|x| Vec3::new(x, tilt * x, height));
        let wall = plane(normal.x, normal.y, normal.z, 0.0);
        return vec![wall, Geometry::Point(start), Geometry::Point(end), Geometry::Vector(normal)];
    }
    // An arc about a centre on the y axis.
    let radius = 1.0 / bend.abs().max(0.02);
    let sense = bend.signum();
    let drop = (radius * radius - half * half).sqrt();
    let center = Vec3::new(0.0, -sense * drop, 0.0);
    let round = Geometry::Circle(Cylinder { point: center, axis: Vec3::z(), radius });
    let [start, end] = [-half, half].map(|x| Vec3::new(x, 0.0, height));
    vec![round, Geometry::Point(start), Geometry::Point(end), Geometry::Vector(Vec3::y() * sense)]
}

/// Between two curves four units apart, or from one to a point.
fn ruled(random: &mut Random) -> Drawn {
    let mut parts = section(random, -3.0);
    if random.next() < 0.25 {
        parts.push(Geometry::Point(Vec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 6.0)));
    } else {
        parts.extend(section(random, 3.0));
    }
    let near = Vec3::new(random.between(-2.0, 2.0), 0.0, random.between(-2.0, 2.0));
    Drawn { geometry: Geometry::RuledSurface(Remembering::new(RuledSurface { parts })), near }
}

/// A quarter of a tube about the x axis that widens, rises and fills up along its stations.
fn poly_conic(random: &mut Random) -> Drawn {
    let size = random.between(1.0, 3.0);
    let constants =
        [size * SQRT_2, size * SQRT_2, size * SQRT_2, -size * SQRT_2, -size * SQRT_2, size * SQRT_2];
    let change = random.between(0.0, 0.3);
    let mut values = vec![1.0];
    values.extend([0.0; 14]);
    values.push(6.0);
    let mut function = |constant: f64, change: f64| {
        values.push(constant);
        values.push(random.between(-change, change));
        values.extend([0.0; 6]);
    };
    for constant in constants {
        function(constant, change);
    }
    function(FRAC_1_SQRT_2, 0.3 * change);
    values.extend([0.0; 7]);
    let near = Vec3::new(random.between(1.0, 5.0), random.between(-1.0, 1.0) * size, size * 2.0);
    Drawn { geometry: Geometry::PolyConic(Remembering::new(values)), near }
}

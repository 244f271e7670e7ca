//! The usual case in one go: a convex solid touched by the corner of the tool. Two convex bodies are nearest where their
//! normals match, so that a matching pair found near a good guess needs no comparison with other parts.

use std::f64::consts::FRAC_PI_2;

use apt_geometry::{
    Vec3,
    surface::{Convexity, Foot, Surface},
};

use super::{Contact, Tool};

/// Bound of Newton's method for the azimuth; without convergence the general search takes over.
const MAX_ITERATIONS: u32 = 12;
/// An azimuth step below this (radians) ends it: the clearance errs by its square.
const ANGLE_RESOLUTION: f64 = 1e-10;
/// Largest azimuth step, radians.
const LARGEST_STEP: f64 = 0.5;

/// The contact at the tool's corner, if the solid is convex and the corner is where it touches.
pub(super) fn contact(tool: &Tool, surface: &Surface, side: f64, tip: &Vec3) -> Option<Contact> {
    let convex =
        matches!((surface.convexity(), side > 0.0), (Convexity::Convex, true) | (Convexity::Hollow, false));
    let profile = &tool.profile;
    // A barrel holds no ball of its corner.
    if !convex || profile.is_barrel() {
        return None;
    }
    let sharp = profile.arc <= 0.0;
    let fan = if sharp {
        [profile.bottom_angle().max(tool.cutter.alpha), FRAC_PI_2 - tool.cutter.beta]
    } else {
        profile.fan
    };
    let middle = tip + tool.axis * profile.center.height;
    let (point, foot, radial) = if profile.center.radius == 0.0 {
        (middle, surface.foot(&middle), None)
    } else {
        let (point, foot, radial) = facing(tool, surface, side, &middle)?;
        (point, foot, Some(radial))
    };
    let gradient = foot.normal * side;
    let clearance = side * foot.distance - profile.arc;
    // A ball must have its centre outside. Where the tool cuts in near a vertex, another way out may be shorter.
    let near_vertex = match surface {
        Surface::Cone(cone) => (foot.point - cone.vertex).norm() <= tool.radius(),
        _ => false,
    };
    let outside = (clearance > 0.0 || !near_vertex) && (sharp || side * foot.distance > 0.0);
    let polar = gradient.dot(&tool.axis).clamp(-1.0, 1.0).acos();
    let matches = polar >= fan[0] && polar <= fan[1] && radial.is_none_or(|r| gradient.dot(&r) <= 0.0);
    (outside && matches).then(|| Contact {
        clearance,
        gradient,
        tool: point - gradient * profile.arc,
        surface: foot.point,
    })
}

/// The point of the corner circle that faces the surface, by Newton's method from the azimuth seen from its centre.
fn facing(tool: &Tool, surface: &Surface, side: f64, middle: &Vec3) -> Option<(Vec3, Foot, Vec3)> {
    let radius = tool.profile.center.radius;
    let guess = surface.foot(middle).normal * -side;
    let mut radial = tool.split(&guess).2;
    for _ in 0..MAX_ITERATIONS {
        let tangent = tool.axis.cross(&radial);
        let point = middle + radial * radius;
        let (foot, hessian) = surface.foot_and_hessian(&point);
        let slope = side * foot.normal.dot(&tangent);
        let bend = side * (radius * tangent.dot(&(hessian * tangent)) - foot.normal.dot(&radial));
        if bend <= 0.0 {
            return None;
        }
        let step = (-slope / bend).clamp(-LARGEST_STEP, LARGEST_STEP);
        if step.abs() <= ANGLE_RESOLUTION {
            return Some((point, foot, radial));
        }
        let (sin, cos) = step.sin_cos();
        radial = (radial * cos + tangent * sin).normalize();
    }
    None
}

//! Clearances in closed form: planes, spheres, cones whose axis is parallel to the tool's, and cylinders of any section
//! whose generators are.

use apt_geometry::{
    Vec3,
    canonical::{Cylinder, Plane, Sphere},
    cutter::ProfilePoint,
    surface::{ConeForm, Foot, Surface},
};

use super::{Contact, Tool, dual};

/// Sine of the angle between two axes below which they are parallel.
const PARALLEL: f64 = 1e-13;
/// Sine of the angle to the plane across the tool below which a normal lies in it.
const LEVEL: f64 = 1e-9;

/// The clearance on one side, if the configuration has a closed form.
pub(super) fn contact(tool: &Tool, surface: &Surface, side: f64, tip: &Vec3) -> Option<Contact> {
    match surface {
        Surface::Plane(given) => Some(plane(tool, given, side, tip)),
        Surface::Sphere(given) => Some(sphere(tool, given, side, tip)),
        Surface::Cylinder(given) if given.axis.cross(&tool.axis).norm() <= PARALLEL => {
            Some(parallel_cylinder(tool, given, side, tip))
        }
        Surface::Cone(given) if given.axis.cross(&tool.axis).norm() <= PARALLEL => {
            Some(parallel_cone(tool, given, side, tip))
        }
        Surface::Quadric(_)
        | Surface::Tabulated(_)
        | Surface::Ruled(_)
        | Surface::PolyConic(_)
        | Surface::Sculptured(_) => Some(along_generators(tool, side, tip, &foot_along(tool, surface, tip)?)),
        _ => None,
    }
}

/// Whether the tool is seen along the generators of a surface, or the rulings of one that ends, and so is a disc there.
fn is_along(tool: &Tool, surface: &Surface) -> bool {
    let direction = match surface {
        Surface::Quadric(_) | Surface::Tabulated(_) => surface.generator(),
        Surface::Ruled(_) | Surface::PolyConic(_) | Surface::Sculptured(_) => surface.common_ruling(),
        Surface::Plane(_) | Surface::Cylinder(_) | Surface::Sphere(_) | Surface::Cone(_) => None,
    };
    direction.is_some_and(|direction| direction.cross(&tool.axis).norm() <= PARALLEL)
}

/// The foot of the tool end on a surface along which the tool is a disc.
fn foot_along(tool: &Tool, surface: &Surface, tip: &Vec3) -> Option<Foot> {
    let foot = is_along(tool, surface).then(|| surface.foot(tip))?;
    if !matches!(surface, Surface::Ruled(_) | Surface::PolyConic(_) | Surface::Sculptured(_)) {
        return Some(foot);
    }
    // Beyond the ends of the rulings the nearest point is no longer beside the tool, and what is widest of the tool may
    // be there while its end is not.
    let is_beside = |foot: &Foot| foot.normal.dot(&tool.axis).abs() <= LEVEL;
    let widest = tool.profile.support(1.0, 0.0).1.height;
    (is_beside(&foot) && (widest <= 0.0 || is_beside(&surface.foot(&(tip + tool.axis * widest)))))
        .then_some(foot)
}

/// A tool that is seen along the generators or rulings of a surface.
pub(super) struct Disc {
    /// Distance of the tool end from the surface at contact.
    pub(super) radius: f64,
    /// The foot of the tool end.
    pub(super) foot: Foot,
}

/// The tool where it is a disc seen along the generators or rulings of a surface: about the ends of one that ends it is none.
pub(super) fn disc(tool: &Tool, surface: &Surface, tip: &Vec3) -> Option<Disc> {
    let foot = foot_along(tool, surface, tip)?;
    Some(Disc { radius: tool.profile.support(1.0, 0.0).0, foot })
}

/// Whether the tool is such a disc.
pub(super) fn is_disc(tool: &Tool, surface: &Surface, tip: &Vec3) -> bool {
    match surface {
        Surface::Quadric(_) | Surface::Tabulated(_) => is_along(tool, surface),
        _ => foot_along(tool, surface, tip).is_some(),
    }
}

/// Seen along generators that are parallel to the tool, the surface is a plane curve and the tool a disc.
fn along_generators(tool: &Tool, side: f64, tip: &Vec3, foot: &Foot) -> Contact {
    let (reach, ProfilePoint { radius, height }) = tool.profile.support(1.0, 0.0);
    let gradient = foot.normal * side;
    let clearance = side * foot.distance - reach;
    let contact = tip + tool.axis * height - gradient * radius;
    Contact { clearance, gradient, tool: contact, surface: contact - gradient * clearance }
}

/// `g = n·TE − d − H(s, −c)` with `n` towards the tool.
fn plane(tool: &Tool, plane: &Plane, side: f64, tip: &Vec3) -> Contact {
    let normal = plane.normal * side;
    let (along, across, radial) = tool.split(&normal);
    let (support, point) = tool.profile.support(across, -along);
    let clearance = normal.dot(tip) - side * plane.distance - support;
    let contact = tip + tool.axis * point.height - radial * point.radius;
    Contact { clearance, gradient: normal, tool: contact, surface: contact - normal * clearance }
}

fn sphere(tool: &Tool, sphere: &Sphere, side: f64, tip: &Vec3) -> Contact {
    if side > 0.0 {
        return ball_outside(tool, &sphere.center, sphere.radius, tip);
    }
    let (along, across, radial) = tool.split(&(sphere.center - tip));
    let (distance, point) = tool.profile.greatest_distance(across, along);
    let contact = tip + tool.axis * point.height - radial * point.radius;
    let outward = (contact - sphere.center).try_normalize(0.0).unwrap_or(-tool.axis);
    Contact {
        clearance: sphere.radius - distance,
        gradient: -outward,
        tool: contact,
        surface: sphere.center + outward * sphere.radius,
    }
}

/// The tool outside a ball, or outside a point when the radius is zero.
pub(super) fn ball_outside(tool: &Tool, center: &Vec3, radius: f64, tip: &Vec3) -> Contact {
    let (along, across, radial) = tool.split(&(center - tip));
    let (distance, point) = tool.profile.distance(across, along);
    let contact = tip + tool.axis * point.height + radial * point.radius;
    let normal = if tool.profile.is_beside(distance) {
        let outward = (contact - center).try_normalize(0.0).unwrap_or(-radial);
        if distance < 0.0 { -outward } else { outward }
    } else {
        // From a place on the tool to that place no direction leads but rounding: the tool's own one does.
        let (_, [aside, up]) = tool.profile.outward(across, along);
        -(radial * aside + tool.axis * up)
    };
    Contact {
        clearance: distance - radius,
        gradient: normal,
        tool: contact,
        surface: center + normal * radius,
    }
}

fn parallel_cylinder(tool: &Tool, cylinder: &Cylinder, side: f64, tip: &Vec3) -> Contact {
    let (_, across, radial) = tool.split(&(tip - cylinder.point));
    let (reach, ProfilePoint { radius, height }) = tool.profile.support(1.0, 0.0);
    let (clearance, towards) = if side > 0.0 {
        (across - cylinder.radius - reach, -radius)
    } else {
        (cylinder.radius - across - reach, radius)
    };
    let contact = tip + tool.axis * height + radial * towards;
    let gradient = radial * side;
    Contact { clearance, gradient, tool: contact, surface: contact - gradient * clearance }
}

/// `n = −sin α T + cos α E` with E the radial direction from the cone's axis to the tool's.
fn parallel_cone(tool: &Tool, cone: &ConeForm, side: f64, tip: &Vec3) -> Contact {
    let w = tip - cone.vertex;
    let radial = tool.split(&w).2;
    let outward = radial * cone.cosine - cone.axis * cone.sine;
    let gradient = outward * side;
    let (support, point) = tool.profile.support(cone.cosine, -gradient.dot(&tool.axis));
    let clearance = gradient.dot(&w) - support;
    let contact = tip + tool.axis * point.height - radial * (side * point.radius);
    let surface = contact - gradient * clearance;
    let generator = cone.axis * cone.cosine + radial * cone.sine;
    let along_ruling = Contact { clearance, gradient, tool: contact, surface };
    // Behind the vertex it is the vertex that is near; where the tool cuts in, the way out past the vertex may be shorter.
    if side > 0.0 && (clearance < 0.0 || (surface - cone.vertex).dot(&generator) < 0.0) {
        return dual::about_vertex(tool, cone, tip, along_ruling);
    }
    along_ruling
}

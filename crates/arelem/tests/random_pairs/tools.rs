//! Random cutters of all legal shapes, and where they are touched by a plane of a given normal.

use apt_geometry::{Vec3, cutter::Cutter};

use crate::support::Random;

/// Numbers of a CUTTER statement with the name of their shape.
pub(crate) fn draw(random: &mut Random) -> (&'static str, Vec<f64>) {
    let d = random.between(0.2, 1.2);
    let h = random.between(2.0, 5.0);
    match (random.next() * 10.0) as u32 {
        0 | 1 => ("ball", vec![d, 0.5 * d]),
        2 => ("flat", vec![d]),
        3 => ("bull nose", vec![d, random.between(0.1, 0.4) * d]),
        4 => ("tapered", vec![d, 0.0, 0.5 * d, 0.0, 0.0, random.between(2.0, 15.0), h]),
        5 => ("bell", vec![0.6, 0.11, 0.2, 0.13, random.between(2.0, 12.0), random.between(2.0, 8.0), h]),
        6 => ("lens", vec![1.0, 0.1875, 0.33, 0.22, random.between(5.0, 12.0), 5.0, h]),
        7 => ("drill", vec![d, 0.0, 0.5 * d, 0.5 * d * 31f64.to_radians().tan(), 31.0, 0.0, h]),
        8 => ("line", vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, h]),
        _ => ("needle", vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-3]),
    }
}

/// What is drawn where a shape is wished for, `barrel` among them, which no draw of any shape gives; `APT_TOOLS=barrel` draws nothing else.
pub(crate) fn wished(shape: Option<&str>, random: &mut Random) -> (&'static str, Vec<f64>) {
    let is_barrel = |shape: &str| shape == "barrel";
    if shape.is_some_and(is_barrel) || std::env::var("APT_TOOLS").is_ok_and(|shape| is_barrel(&shape)) {
        return barrel(random);
    }
    draw(random)
}

/// A cutter whose corner has its centre beyond the axis: it begins somewhere on the bottom and joins the flank smoothly.
fn barrel(random: &mut Random) -> (&'static str, Vec<f64>) {
    let d = random.between(0.2, 1.2);
    let beyond = d * random.between(0.05, 2.0);
    let bottom = 0.5 * d * random.between(0.1, 0.9);
    let radius = 0.5 * d + beyond;
    let height = (radius * radius - (beyond + bottom).powi(2)).sqrt();
    let above = random.between(0.3, 2.0);
    ("barrel", vec![d, radius, -beyond, height, 0.0, 0.0, height + above])
}

/// The point of the whole tool that lies farthest in a direction, seen from the tool end (arelem reference 1.3).
pub(crate) fn support(cutter: &Cutter, axis: &Vec3, direction: &Vec3) -> Vec3 {
    let profile = cutter.profile();
    let along = direction.dot(axis);
    let across = direction - axis * along;
    let sine = across.norm();
    let radial = if sine > 0.0 { across / sine } else { Vec3::zeros() };
    let (_, point) = profile.support(sine, along);
    radial * point.radius + axis * point.height
}

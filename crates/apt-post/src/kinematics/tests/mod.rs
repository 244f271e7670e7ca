//! Numbers and laws of rotary axes.

mod dividing;
mod planning;
mod solving;

use apt_geometry::Vec3;

use super::{Carried, Kinematics, Rotary};

/// An axis that turns without end, about a place, with no preferred sign.
pub(super) fn rotary(vector: Vec3, carried: Carried, center: Vec3) -> Rotary {
    let limits = [f64::NEG_INFINITY, f64::INFINITY];
    Rotary { vector: vector.normalize(), carried, limits, center, prefer: None }
}

/// A machine of two axes with a pole of a thousandth of a degree.
pub(super) fn machine(first: Rotary, second: Rotary, pivot: f64) -> Kinematics {
    Kinematics { axes: [first, second], pivot, dead_cone: 0.001_f64.to_radians(), slides: true }
}

/// C rider and A carrier, both through (0, 0, −50).
pub(super) fn table_table() -> Kinematics {
    let center = Vec3::new(0.0, 0.0, -50.0);
    machine(rotary(Vec3::z(), Carried::Table, center), rotary(Vec3::x(), Carried::Table, center), 0.0)
}

/// C and A in the head, 200 from the tilt axis to the tool end.
pub(super) fn head_head() -> Kinematics {
    let origin = Vec3::zeros();
    machine(rotary(Vec3::z(), Carried::Head, origin), rotary(Vec3::x(), Carried::Head, origin), 200.0)
}

/// C in the table, B in the head, 200 from the tilt axis to the tool end.
pub(super) fn head_table() -> Kinematics {
    let origin = Vec3::zeros();
    machine(rotary(Vec3::z(), Carried::Table, origin), rotary(Vec3::y(), Carried::Head, origin), 200.0)
}

/// C, and B about the bisector of z and y, in the head.
pub(super) fn nutating() -> Kinematics {
    let origin = Vec3::zeros();
    let inclined = rotary(Vec3::new(0.0, 1.0, 1.0), Carried::Head, origin);
    machine(rotary(Vec3::z(), Carried::Head, origin), inclined, 150.0)
}

/// A nearest to the part, then B, in the head.
pub(super) fn a_and_b() -> Kinematics {
    let origin = Vec3::zeros();
    machine(rotary(Vec3::x(), Carried::Head, origin), rotary(Vec3::y(), Carried::Head, origin), 100.0)
}

/// A machine whose axes have limits.
pub(super) fn limited(mut kinematics: Kinematics, limits: [[f64; 2]; 2]) -> Kinematics {
    for (axis, limits) in kinematics.axes.iter_mut().zip(limits) {
        axis.limits = limits;
    }
    kinematics
}

/// The tool axis that leans by so many degrees towards an azimuth from x.
pub(super) fn leaning(tilt: f64, azimuth: f64) -> Vec3 {
    let (tilt, azimuth) = (tilt.to_radians(), azimuth.to_radians());
    Vec3::new(tilt.sin() * azimuth.cos(), tilt.sin() * azimuth.sin(), tilt.cos())
}

/// Asserts that numbers are the same to within `tolerance`.
#[track_caller]
pub(super) fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let is_near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= tolerance);
    assert!(is_near, "{found:?} instead of {expected:?}");
}

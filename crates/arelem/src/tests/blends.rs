//! Profiles whose pieces are tangent to one another: lines that go on along tabulated cylinders and back, with the tool at the very limit
//! of its band where one ends, as it is beside planes when INTOL or OUTTOL is zero.

use std::sync::Arc;

use DriveSide::{Left, Right};
use Relation::{On, To};
use Turn::Forward;
use apt_geometry::canonical::{Interval, TabulatedCylinder};

use super::*;

/// Where the tabulated cylinder ends, and its last extension.
const END: [f64; 2] = [4.0, 1.5];

/// A tabulated cylinder upright that leaves the x axis at the origin, rises in one cubic and is level again at its end, with extensions.
fn blend() -> Geometry {
    let [length, lean] = [END[0].hypot(END[1]), END[1].atan2(END[0])];
    // Both slopes over the chord are those of a level line.
    let slope = -lean.tan();
    let (a, b) = (2.0 * slope / (length * length), -3.0 * slope / length);
    let interval = |u: f64, v: f64, a: f64, b: f64, length: f64| Interval {
        u,
        v,
        a,
        b,
        length,
        maximum: 0.0,
        minimum: 0.0,
    };
    let intervals = vec![
        interval(-10.0, 0.0, 0.0, 0.0, 10.0),
        interval(0.0, 0.0, a, b, length),
        interval(END[0], END[1], 0.0, 0.0, 10.0),
    ];
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals,
        last: [END[0] + 10.0, END[1]],
    }))
}

fn axis() -> Geometry {
    line(0.0, 0.0, 1.0, 0.0)
}

/// A tool that touches the x axis from above or below, at x = −2.
fn beside(band: [f64; 2], above: bool) -> Program {
    let mut p = Program::new();
    let (y, side) = if above { (2.0, Left) } else { (-2.0, Right) };
    p.tolerance(band[0], band[1]).cutter(&[0.25]).from(-3.0, y, 0.0);
    p.go(&[(To, &axis()), (To, &ground()), (On, &x(-2.0))]).side(side).indirv(1.0, 0.0, 0.0);
    p
}

const BANDS: [[f64; 2]; 3] = [[0.0, 5e-4], [5e-4, 0.0], [2e-4, 3e-4]];

#[test]
fn a_path_goes_on_from_the_limit_of_a_band_along_what_is_tangent() {
    for (band, above) in BANDS.into_iter().flat_map(|band| [(band, true), (band, false)]) {
        for stop in [-1.0, 1e-3, 0.5, 3.5, 6.0] {
            let mut p = beside(band, above);
            p.drive(Forward, &blend(), On, &x(stop)).verified();
            let (count, least) = (p.last().points.len(), p.last().minimum.expect("a bound"));
            // The first vector begins at a limit that another one would not have led to.
            assert!(count as f64 <= 1.02 * f64::from(least) + 3.0, "{count} to {stop}, {least} at least");
        }
    }
}

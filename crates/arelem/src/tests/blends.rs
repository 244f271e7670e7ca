//! Profiles whose pieces are tangent to one another: lines that go on along tabulated cylinders and back, with the tool at the very limit
//! of its band where one ends, as it is beside planes when INTOL or OUTTOL is zero.

use std::sync::Arc;

use DriveSide::{Left, Right};
use Relation::{On, TangentToDrive as Tanto, TangentToPart as Pstan, To};
use Turn::{Back, Forward};
use apt_geometry::canonical::{Interval, Matrix, Remembering, TabulatedCylinder, matrix::CoordinatePlane};

use super::{sheets::ruled, *};
use crate::{error::MotionFailure, verify::verify};

/// Where the tabulated cylinder ends, and its last extension.
const END: [f64; 2] = [4.0, 1.5];

/// A tabulated cylinder upright that leaves the x axis at the origin, rises in one cubic and is level again at its end, with extensions.
fn blend() -> Geometry {
    blend_along([Vec3::x(), Vec3::y(), Vec3::z()], 0.0)
}

/// The same that rises from a height.
fn ramp(from: f64) -> Geometry {
    blend_along([Vec3::x(), Vec3::z(), -Vec3::y()], from)
}

fn blend_along(axes: [Vec3; 3], base: f64) -> Geometry {
    let [length, lean] = [END[0].hypot(END[1]), END[1].atan2(END[0])];
    // Both slopes over the chord are those of a level line.
    let slope = -lean.tan();
    let (a, b) = (2.0 * slope / (length * length), -3.0 * slope / length);
    let interval = |u: f64, v: f64, a: f64, b: f64, length: f64| Interval {
        u,
        v: base + v,
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
        axes,
        kind: 0.0,
        intervals,
        last: [END[0] + 10.0, base + END[1]],
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

/// A line and the extension of the tabulated cylinder in it are parallel all along: from the one onto the other the motion stops where they
/// part, and from the other onto the one where they come together.
#[test]
fn a_motion_stops_where_a_curve_leaves_its_tangent_or_comes_into_it() {
    for (band, above) in BANDS.into_iter().flat_map(|band| [(band, true), (band, false)]) {
        let off = if above { 0.125 } else { -0.125 };
        let mut p = beside(band, above);
        p.drive(Forward, &axis(), Tanto, &blend()).ends(0.0, off, 0.0, 1e-3).verified();
        p.drive(Forward, &blend(), Tanto, &upper_line()).ends(4.0, 1.5 + off, 0.0, 1e-3).verified();
        assert!(p.last().points.len() > 1);
        p.drive(Forward, &upper_line(), On, &x(6.0)).verified();
        p.drive(Back, &upper_line(), Tanto, &blend()).ends(4.0, 1.5 + off, 0.0, 1e-3).verified();
        p.drive(Forward, &blend(), Tanto, &axis()).ends(0.0, off, 0.0, 1e-3).verified();
    }
}

/// The line in which the tabulated cylinder ends.
fn upper_line() -> Geometry {
    line(0.0, END[1], 5.0, END[1])
}

/// On its way beside the line nothing tells where the tangency is.
#[test]
fn a_path_that_runs_along_the_check_surface_for_ever_is_told() {
    let mut p = beside(BANDS[0], true);
    let failure = p.attempt(&motion(Back, &axis(), &[(Tanto, 1, &blend())])).expect_err("no tangency");
    assert!(matches!(failure, MotionFailure::ParallelThroughout { check: 0 }), "{failure:?}");
}

/// As long as the slope of a curve at its end has a few decimals, it is tangent to what it was made for.
#[test]
fn a_curve_whose_slope_is_rounded_is_tangent_still() {
    for lean in [1e-5_f64, -1e-5] {
        let along = |x: f64| line(x, 0.0, x + lean.cos(), lean.sin());
        let mut p = Program::new();
        p.tolerance(0.0, 5e-4).cutter(&[0.25]).from(-3.0, 2.0, 0.0);
        p.go(&[(To, &along(0.0)), (To, &ground()), (On, &x(-2.0))]).side(Left).indirv(1.0, 0.0, 0.0);
        p.drive(Forward, &along(0.0), Tanto, &blend()).ends(0.0, 0.125, 0.0, 1e-3).verified();
        p.drive(Forward, &blend(), On, &x(1.0)).verified();
    }
}

/// Where another check surface is met before the place at which a way parallel to the first is a tangency, that stops the motion.
#[test]
fn what_is_met_before_the_end_of_the_way_stops_the_motion() {
    for (stop, check) in [(-1.0, 1), (1.0, 0)] {
        let mut p = beside(BANDS[2], true);
        p.run(&motion(Forward, &axis(), &[(Tanto, 1, &blend()), (On, 1, &x(stop))]));
        assert_eq!(p.verified().last().stop.as_ref().map(|stop| stop.index), Some(check));
    }
}

/// The same with the part surface: from the ground onto a ramp, and from that onto a plane above. A flat bottom meets the ramp with its rim,
/// and is on the plane before all of it is.
#[test]
fn a_motion_stops_where_a_ramp_leaves_the_ground_and_comes_into_a_plane() {
    let cutters = [(&[0.5, 0.25][..], 0.0), (&[0.5], 0.25), (&[0.5, 0.1], 0.15)];
    for ((cutter, rim), base) in
        cutters.into_iter().flat_map(|cutter| [0.0, 0.1, 0.3].map(|base| (cutter, base)))
    {
        let mut p = Program::new();
        p.tolerance(5e-4, 5e-4).cutter(cutter).from(-3.0, -2.0, 1.0);
        p.go(&[(To, &axis()), (To, &level(base)), (On, &x(-2.0))]).side(Right).indirv(1.0, 0.0, 0.0);
        p.drive(Forward, &axis(), Pstan, &ramp(base)).ends(-rim, -0.25, base, 2e-3).verified();
        p.run(&MotionCommand::PartSurface(named(&ramp(base))));
        let top = base + END[1];
        p.drive(Forward, &axis(), Pstan, &level(top)).ends(4.0 - rim, -0.25, top, 2e-3).verified();
        assert!(p.last().points.len() > 1);
    }
}

/// Radius of the arc of a sheet, and where on the x axis it begins; it ends in the origin.
const ARC: f64 = 6.0;
const FOOT: f64 = -3.0;

/// A polyconic surface along y in an arc that ends level in the origin, hollow on its upper side or not, and straight from there: an extension.
fn arc(up: f64) -> Geometry {
    let below = (ARC * ARC - FOOT * FOOT).sqrt();
    let (rise, slope) = (up * (ARC - below), up * FOOT / below);
    // Both tangents meet on the x axis.
    let meet = FOOT - rise / slope;
    let weight = (0.5 * (FOOT / ARC).asin()).cos();
    let fullness = (2.0 * weight + 1.0) / (2.0 * weight + 2.0);
    let mut values = vec![1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    values.extend([0.0, -4.0, 8.0]);
    for constant in [-meet, -rise, meet - FOOT, 0.0, FOOT, rise, fullness] {
        values.push(constant);
        values.extend([0.0; 7]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// The same as a wall.
fn wall(up: f64) -> Geometry {
    arc(up).transform(&Matrix::rotation(CoordinatePlane::Yz, -90.0)).expect("a rotation")
}

/// The last sequence is what the verifier accepts, too.
fn accepted(p: &mut Program) {
    p.verified();
    let evidence = verify(p.last(), &|| false).expect("evidence");
    assert!(evidence.verified, "{:?}", evidence.violations);
}

const SHEET_CUTTERS: [(&[f64], f64); 3] = [(&[0.5, 0.25], 0.0), (&[0.5], 0.25), (&[0.5, 0.1], 0.15)];

/// How far a sheet goes on straight along a plane is chance: the motion stops where the sheet comes into the plane, or leaves it, and not in the
/// middle of what is straight, nor is it led on to its end. A hollow one is left where the rim of the flat bottom comes to it.
#[test]
fn a_motion_stops_where_a_sheet_that_ends_comes_into_a_plane_or_leaves_it() {
    for (up, (cutter, rim)) in [1.0, -1.0].into_iter().flat_map(|up| SHEET_CUTTERS.map(|cutter| (up, cutter)))
    {
        for drive in [y(-0.5), line(0.0, -1.0, 2.0, 0.0), circle(0.0, 3.0, 4.0)] {
            let is_oblique = !matches!(drive, Geometry::Plane(_));
            if is_oblique && rim > 0.0 {
                continue;
            }
            for (from, ahead, part, check) in [(-2.0, 1.0, arc(up), ground()), (2.0, -1.0, ground(), arc(up))]
            {
                let mut p = Program::new();
                p.tolerance(5e-4, 5e-4).cutter(cutter).from(from, -1.0, 3.0);
                p.go(&[(On, &drive), (To, &part), (On, &x(from))])
                    .indirv(ahead, 0.0, 0.0)
                    .side(DriveSide::On);
                p.drive(Forward, &drive, Pstan, &check);
                let y = if is_oblique { -1.0 } else { -0.5 };
                p.ends(up * rim, y, 0.0, 2e-3);
                accepted(&mut p);
            }
        }
    }
}

/// The same beside a wall, on a plane and over a cylinder, on which the path bends where wall and line are one.
#[test]
fn a_motion_stops_where_a_wall_that_ends_comes_into_a_line_or_leaves_it() {
    for (up, floor) in [1.0, -1.0]
        .into_iter()
        .flat_map(|up| [level(1.0), cylinder(v(0.0, 0.0, -9.0), Vec3::y(), 10.0)].map(|floor| (up, floor)))
    {
        for (from, ahead, drive, check) in [(-2.0, 1.0, wall(up), axis()), (2.0, -1.0, axis(), wall(up))] {
            let mut p = Program::new();
            p.tolerance(5e-4, 5e-4).cutter(&[0.5, 0.25]).from(from, 3.0, 3.0);
            p.go(&[(To, &drive), (To, &floor), (On, &x(from))]).indirv(ahead, 0.0, 0.0);
            p.side(if ahead > 0.0 { Left } else { Right });
            p.drive(Forward, &drive, Tanto, &check).ends(0.0, 0.25, 1.0, 1e-3);
            accepted(&mut p);
        }
    }
}

/// A ruled surface on the curve of a tabulated cylinder that is level beyond both its ends.
#[test]
fn a_ruled_ramp_comes_into_its_planes_where_its_curve_does() {
    let sheet = ruled([-4.0, 4.0].map(|y| (ramp(0.0), v(0.0, y, 0.0), v(END[0], y, END[1]), Vec3::z())));
    for (ahead, check, end) in [(-1.0, ground(), [0.0, 0.0]), (1.0, level(END[1]), END)] {
        let mut p = Program::new();
        p.tolerance(5e-4, 5e-4).cutter(&[0.5, 0.25]).from(2.0, -0.5, 4.0);
        p.go(&[(On, &y(-0.5)), (To, &sheet), (On, &x(2.0))]).indirv(ahead, 0.0, 0.0).side(DriveSide::On);
        p.drive(Forward, &y(-0.5), Pstan, &check).ends(end[0], -0.5, end[1], 1e-3);
        accepted(&mut p);
    }
}

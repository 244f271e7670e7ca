//! Ruled and polyconic surfaces in all roles: against their own formulas, and against surfaces that they are equal to.

use DriveSide::{Left, On as TlOn};
use Relation::{On, Past, To};
use Turn::{Forward, Right as GoRgt};
use apt_geometry::{
    canonical::{Matrix, Remembering, RuledSurface, matrix::CoordinatePlane},
    motion::Delta,
    surface::Surface,
};

use super::*;

pub(crate) fn ruled(curves: [(Geometry, Vec3, Vec3, Vec3); 2]) -> Geometry {
    let parts = curves.into_iter().flat_map(|(surface, start, end, across)| {
        [surface, Geometry::Point(start), Geometry::Point(end), Geometry::Vector(across)]
    });
    Geometry::RuledSurface(Remembering::new(RuledSurface { parts: parts.collect() }))
}

/// The twisted strip of the corpus program rldsrf-ps, its upper curve in a plane -x + 6z = `upper`.
pub(super) fn twisted_to(upper: f64) -> Geometry {
    let upper = plane(-1.0, 0.0, 6.0, upper);
    ruled([
        (level(0.0), v(0.0, 0.0, 0.0), v(6.0, 0.0, 0.0), Vec3::z()),
        (upper, v(0.0, 4.0, 1.0), v(6.0, 4.0, 2.0), v(-1.0, 0.0, 6.0)),
    ])
}

fn twisted() -> Geometry {
    twisted_to(6.0)
}

/// The part of a circular wall of radius 6 about (3, −6) with |x − 3| ≤ 4, between two heights.
pub(super) fn round_wall() -> Geometry {
    let wall = circle(3.0, -6.0, 6.0);
    let far = 20f64.sqrt() - 6.0;
    ruled([0.0, 4.0].map(|z| (wall.clone(), v(-1.0, far, z), v(7.0, far, z), Vec3::y())))
}

/// A quarter of a tube of radius 2 about the x axis from x = 0 to 6, its natural normal outward.
fn tube() -> Geometry {
    let mut values = vec![1.0];
    values.extend([0.0; 12]);
    values.extend([0.0, 0.0, 6.0]);
    let root = std::f64::consts::SQRT_2;
    // From y = −√2, z = √2 over the top to y = √2: a quarter turn.
    for constant in [root, root, root, -root, -root, root, std::f64::consts::FRAC_1_SQRT_2] {
        values.push(constant);
        values.extend([0.0; 7]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// Distance of a point from the twisted strip by its formula, searched for on finer and finer grids.
fn from_twisted(p: &Vec3) -> f64 {
    let place = |t: f64, s: f64| v(6.0 * t, 4.0 * s, s * (1.0 + t));
    let (mut center, mut half, mut best) = ([0.5, 0.5], 0.5, f64::INFINITY);
    for _ in 0..12 {
        let from = center;
        for i in -8..=8 {
            for j in -8..=8 {
                let at = [from[0] + half * f64::from(i) / 8.0, from[1] + half * f64::from(j) / 8.0];
                let distance = (place(at[0], at[1]) - p).norm();
                if distance < best {
                    (best, center) = (distance, at);
                }
            }
        }
        half *= 0.25;
    }
    best
}

#[test]
fn a_ball_follows_a_ruled_part_surface() {
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(1.0, 2.0, 4.0);
    p.go(&[(On, &y(2.0)), (To, &twisted()), (On, &x(1.0))]).ends(1.0, 2.0, 0.593_804_424, 0.00101);
    p.side(TlOn).drive(GoRgt, &y(2.0), On, &x(5.0)).ends(5.0, 2.0, 0.941_663_102, 0.00101);
    // The line half way between the curves is straight.
    assert_eq!(p.last().points.len(), 1);
    // Across the twist the way is curved.
    let slanted = plane(3.0, -2.0, 0.0, 0.0);
    let mut p = Program::new();
    p.tolerance(0.0, 1e-4).cutter(&[1.0, 0.5]).from(0.8, 1.2, 4.0);
    p.go(&[(On, &slanted), (To, &twisted()), (On, &x(0.8))]).indirv(1.0, 1.0, 0.0);
    p.side(TlOn).drive(Forward, &slanted, On, &x(2.3));
    let sequence = p.last().clone();
    assert!(sequence.points.len() > 2, "{}", sequence.points.len());
    let mut from = sequence.start.tip;
    for point in &sequence.points {
        for k in 0..=16 {
            let tip = from + (point.tip - from) * (f64::from(k) / 16.0);
            let gap = from_twisted(&(tip + Vec3::z() * 0.5)) - 0.5;
            assert!((-1e-7..=1e-4 + 1e-7).contains(&gap), "{gap:e} at {tip}");
        }
        from = point.tip;
    }
}

/// Runs the same program with two equal surfaces; the ends agree within the band, the vectors to one.
fn same(band: f64, first: &Geometry, second: &Geometry, program: impl Fn(&mut Program, &Geometry)) {
    let [a, b] = [first, second].map(|geometry| {
        let mut p = Program::new();
        p.tolerance(0.0, band);
        program(&mut p, geometry);
        (p.tip(), p.last().points.len())
    });
    assert!((a.0 - b.0).norm() <= 1.5 * band, "{} beside {}", a.0, b.0);
    assert!(a.1.abs_diff(b.1) <= 1, "{} beside {} vectors", a.1, b.1);
}

#[test]
fn a_ruled_wall_is_driven_along_like_the_circle_it_lies_on() {
    for relation in [To, On] {
        same(0.001, &round_wall(), &circle(3.0, -6.0, 6.0), |p, wall| {
            p.cutter(&[0.5]).from(1.0, 3.0, 1.0);
            p.go(&[(relation, wall), (To, &level(1.0)), (On, &x(1.0))]);
            p.side(if relation == On { TlOn } else { Left }).indirv(1.0, 0.0, 0.0);
            p.drive(Forward, wall, On, &x(5.0));
        });
    }
}

#[test]
fn a_ruled_wall_stops_motions_like_the_circle_it_lies_on() {
    for (relation, tilt) in [(To, 0.0), (On, 0.0), (Past, 0.0), (To, 0.3)] {
        same(0.001, &round_wall(), &circle(3.0, -6.0, 6.0), |p, wall| {
            p.cutter(&[0.5]);
            let floor = plane(0.0, tilt, 1.0, 1.0);
            p.from(2.0, 3.0, 3.0).go(&[(On, &x(2.0)), (To, &floor), (On, &y(2.0))]).side(TlOn);
            p.indirv(0.0, -1.0, 0.0).drive(Forward, &x(2.0), relation, wall);
        });
    }
}

#[test]
fn a_polyconic_part_surface_is_followed_like_the_cylinder_it_lies_on() {
    let cylinder = cylinder(Vec3::zeros(), Vec3::x(), 2.0);
    for numbers in [vec![0.5, 0.25], vec![0.5, 0.1]] {
        for drive in [plane(1.0, 0.0, 0.0, 3.0), plane(1.0, 1.0, 0.0, 3.0)] {
            same(0.001, &tube(), &cylinder, |p, roof| {
                p.cutter(&numbers).from(3.0, 0.0, 4.0).go(&[(On, &drive), (To, roof), (On, &y(-0.5))]);
                p.side(TlOn).indirv(0.0, 1.0, 0.0).drive(Forward, &drive, On, &y(0.7));
            });
        }
    }
}

#[test]
fn a_polyconic_wall_drives_and_stops_like_the_circle_it_lies_on() {
    // About the z axis, facing y.
    let turn = Matrix::rotation(CoordinatePlane::Zx, -90.0);
    let upright = tube().transform(&turn).expect("a rotation");
    let facing = {
        let surface = apt_geometry::surface::Surface::from_geometry(&upright).expect("a surface");
        surface.foot(&v(-5.0, 0.0, 3.0)).point
    };
    assert!((facing.norm_squared() - 13.0).abs() < 1e-6 || facing.xy().norm() - 2.0 < 1e-9, "{facing}");
    let out = facing.xy().normalize();
    let (away, along) = (v(out.x, out.y, 0.0), v(-out.y, out.x, 0.0));
    let across = |d: f64| plane(along.x, along.y, 0.0, d);
    let height = level(facing.z);
    same(0.001, &upright, &circle(0.0, 0.0, 2.0), |p, wall| {
        let from = away * 4.0 - along * 0.7;
        p.cutter(&[0.5]).from(from.x, from.y, facing.z);
        p.go(&[(To, wall), (To, &height), (On, &across(-0.7))]);
        p.indirv(along.x, along.y, 0.0).side(if along.cross(&away).z > 0.0 {
            Left
        } else {
            DriveSide::Right
        });
        p.drive(Forward, wall, On, &across(0.9));
    });
    for relation in [To, On, Past] {
        same(0.001, &upright, &circle(0.0, 0.0, 2.0), |p, wall| {
            let from = away * 4.0 + along * 0.2;
            let lane = across(0.2);
            p.cutter(&[0.5]).from(from.x, from.y, facing.z + 1.0);
            p.go(&[(On, &lane), (To, &height), (On, &plane(away.x, away.y, 0.0, 3.5))]).side(TlOn);
            p.indirv(-away.x, -away.y, 0.0).drive(Forward, &lane, relation, wall);
        });
    }
}

#[test]
fn upright_cylinders_of_any_section_are_met_by_discs() {
    // A slight lean takes the general way to the same clearance.
    let leaning = v(1e-9, 2e-9, 1.0).normalize();
    let numbers = [1.0, 0.1, 0.41, 0.12, 5.0, 3.0, 2.0];
    let cutter = apt_geometry::cutter::Cutter::from_numbers(&numbers, 1.0).expect("a cutter");
    let [upright, general] = [Vec3::z(), leaning].map(|axis| Tool::new(cutter, axis));
    let elliptic = quadric([1.0 / 16.0, 0.25, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    for (geometry, side) in [(elliptic.clone(), 1.0), (elliptic, -1.0), (super::economy::table(), 1.0)] {
        let surface = apt_geometry::surface::Surface::from_geometry(&geometry).expect("a surface");
        let gauge = Gauge { surface, on: false, side, thickness: 0.0, disk: None, memory: Memory::default() };
        for k in 0..12 {
            let angle = 0.5 * f64::from(k);
            let out = if side > 0.0 { 5.0 } else { 0.8 };
            let tip = v(out * angle.cos(), out * angle.sin(), 0.3);
            let (a, b) = (gauge.contact(&upright, &tip), gauge.contact(&general, &tip));
            assert!((a.clearance - b.clearance).abs() < 1e-7, "{} {} at {tip}", a.clearance, b.clearance);
            assert!((a.gradient - b.gradient).norm() < 1e-5, "{} {} at {tip}", a.gradient, b.gradient);
        }
    }
}

#[test]
fn a_ruled_wall_has_two_sides() {
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).from(1.0, 1.0, 0.0);
    let wall = round_wall();
    p.go(&[(To, &wall), (To, &level(0.0)), (On, &x(1.0))]);
    let start = p.tip();
    assert!((start - v(3.0, -6.0, 0.0)).norm() > 6.24, "outside of the round wall: {start}");
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.5]).from(1.0, -2.0, 0.0);
    p.go(&[(To, &wall), (To, &level(0.0)), (On, &x(1.0))]);
    assert!(((p.tip() - v(3.0, -6.0, 0.0)).norm() - 5.75).abs() < 0.0011, "inside: {}", p.tip());
    p.side(DriveSide::Right).drive(GoRgt, &wall, On, &x(4.5)).verified();
    assert!(((p.tip() - v(3.0, -6.0, 0.0)).norm() - 5.75).abs() < 0.0011, "inside: {}", p.tip());
}

/// A start-up onto a ramp that rises to its end, past that: the tool touches the end, where it would do on either side, and who looks
/// from the tool sees the ramp from below. It goes back over the ramp, where it came from, until it is told to be elsewhere.
#[test]
fn a_tool_past_the_end_of_a_surface_stays_on_the_side_that_it_came_to() {
    let slope = || plane(-3.0, 0.0, 4.0, 0.0);
    let across = v(-3.0, 0.0, 4.0);
    let ramp = ruled([
        (slope(), v(0.0, -1.0, 0.0), v(4.0, -1.0, 3.0), across),
        (slope(), v(0.0, 3.0, 0.0), v(4.0, 3.0, 3.0), across),
    ]);
    let surface = Surface::from_geometry(&ramp).expect("a surface");
    let (mut before, mut beyond) = (4.0, 400.0);
    for _ in 0..60 {
        let middle = 0.5 * (before + beyond);
        *(if surface.ends_at(&v(middle, 1.0, 0.75 * middle)) { &mut beyond } else { &mut before }) = middle;
    }
    let end = v(before, 1.0, 0.75 * before);
    let mut program = Program::new();
    program.cutter(&[0.5, 0.25]).tolerance(0.0, 0.001).side(TlOn).from(end.x - 1.0, 1.0, end.z + 2.0);
    program.go(&[(On, &y(1.0)), (To, &ramp), (On, &x(end.x + 0.15))]);
    program.ends(end.x + 0.15, 1.0, end.z - 0.05, 0.002);
    assert!(program.state.side_of_part.is_some());
    program.indirv(-1.0, 0.0, 0.0).drive(Forward, &y(1.0), On, &x(2.0));
    program.ends(2.0, 1.0, 1.5625, 0.002).verified();
    program.run(&MotionCommand::GoDelta { delta: Delta::Vector(Vec3::z(), None), name: String::new() });
    assert_eq!(program.state.side_of_part, None);
}

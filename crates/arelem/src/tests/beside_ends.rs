//! Tools that are higher than the sculptured surface beside them, and so touch the end of it.

use apt_geometry::{
    cutter::Cutter,
    parametric::{Extended, Patch},
    surface::Surface,
};

use DriveSide::On as TlOn;
use Relation::{On, Past, To};

use super::{sculptured::made, *};
use crate::verify::verify;

/// A tool with a round end, one with a flat one, and one with a corner and a conical flank; all of them higher than the walls.
const TOOLS: [[f64; 7]; 3] = [
    [0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 12.0],
    [0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 12.0],
    [0.5, 0.1, 0.15, 0.1, 0.0, 0.0, 12.0],
];

/// A wall from z 0 to 4.5 over a curve; `off` tells how far its four rows of control points are from that along y.
fn wall(off: [f64; 4]) -> Geometry {
    let along = [0.3, 1.4, 1.1, 0.4];
    made(vec![Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| v(2.0 * i as f64, along[i] + off[j], 1.5 * j as f64))
    }))])
}

/// Walls that lean to either side, that are hollow and that bulge, as seen from greater y.
fn walls() -> [(&'static str, Geometry); 4] {
    [
        ("leaning over", wall([0.0, 0.25, 0.5, 0.75])),
        ("leaning back", wall([0.0, -0.25, -0.5, -0.75])),
        ("hollow", wall([0.45, 0.05, 0.05, 0.45])),
        ("bulging", wall([-0.45, -0.05, -0.05, -0.45])),
    ]
}

/// Least signed distance of a dense set of places of a surface, with what goes on beyond its edges, from a tool.
fn sampled(wall: &Geometry, tool: &Tool, tip: &Vec3) -> f64 {
    let Geometry::Sculptured(definition) = wall else { panic!("a sculptured surface") };
    const COUNT: u32 = 160;
    let share = |k: u32| f64::from(k) / f64::from(COUNT);
    let mut least = f64::INFINITY;
    for piece in Extended::of(definition).expect("patches").patches() {
        for (i, j) in (0..=COUNT).flat_map(|i| (0..=COUNT).map(move |j| (i, j))) {
            let place = piece.patch.evaluate(share(i), share(j)).position;
            let (along, across, _) = tool.split(&(place - tip));
            least = least.min(tool.profile.distance(across, along).0);
        }
    }
    least
}

#[test]
fn the_clearance_beside_a_wall_is_that_of_its_nearest_place() {
    for (name, geometry) in walls() {
        let surface = Surface::from_geometry(&geometry).expect("a surface");
        let side = surface.signed_distance(&v(3.0, 5.0, 2.0)).signum();
        for numbers in TOOLS {
            let tool = Tool::new(Cutter::from_numbers(&numbers, 1.0).expect("a cutter"), Vec3::z());
            let gauge = Gauge {
                surface: surface.clone(),
                on: false,
                side,
                thickness: 0.0,
                disk: None,
                memory: Memory::default(),
            };
            for (x, y) in [(1.0, 4.0), (2.0, 3.0), (3.0, 2.9), (4.5, 2.8)] {
                let tip = v(x, y, 1.2);
                let (contact, missed) = gauge.contact_within(&tool, &tip, crate::clearance::Enough::ALL);
                let dense = sampled(&geometry, &tool, &tip);
                assert!(
                    contact.clearance > 0.0 && missed < 1e-6,
                    "{name} {numbers:?} at {tip}: {contact:?}, {missed}"
                );
                // Samples are nowhere nearer, and beside the nearest place hardly farther.
                let over = dense - contact.clearance;
                assert!((-1e-9..2e-3).contains(&over), "{name} {numbers:?} at {tip}: {contact:?}, {dense}");
            }
        }
    }
}

#[test]
fn the_end_of_a_wall_is_as_deep_in_a_tool_as_the_tool_must_be_moved_to_be_clear() {
    let geometry = wall([0.0, 0.25, 0.5, 0.75]);
    let surface = Surface::from_geometry(&geometry).expect("a surface");
    let side = surface.signed_distance(&v(3.0, 5.0, 2.0)).signum();
    let tool = Tool::new(Cutter::from_numbers(&TOOLS[0], 1.0).expect("a cutter"), Vec3::z());
    let gauge = Gauge { surface, on: false, side, thickness: 0.0, disk: None, memory: Memory::default() };
    let clear = gauge.contact(&tool, &v(2.0, 3.0, 1.2));
    for depth in [1e-4, 1e-3, 1e-2] {
        let tip = v(2.0, 3.0, 1.2) - clear.gradient * (clear.clearance + depth);
        let (contact, missed) = gauge.contact_within(&tool, &tip, crate::clearance::Enough::ALL);
        // The nearest place of the curve wanders a little on the way.
        assert!((contact.clearance + depth).abs() < 0.02 * depth + 1e-9, "{contact:?} {depth}");
        assert!(missed < 1e-6, "{missed}");
        let out = tip + contact.gradient * -contact.clearance;
        assert!(gauge.contact(&tool, &out).clearance.abs() < 1e-3 * depth, "{depth}");
    }
}

/// A wall whose straight lines are along the tool ends like any other: what is above the end is beside it, and the tool a disc only where all of
/// what may touch is beside the wall.
#[test]
fn a_tool_that_overhangs_the_end_of_an_upright_wall_touches_that_end() {
    let geometry = wall([0.0; 4]);
    let end = top(&geometry);
    for (numbers, side) in TOOLS.into_iter().flat_map(|tool| [(tool, 1.0), (tool, -1.0)]) {
        let cutter = Cutter::from_numbers(&numbers, 1.0).expect("a cutter");
        let tool = Tool::new(cutter, Vec3::z());
        let role = Role { side, ..touched(&geometry) };
        for below in [3.0, 0.2, 0.1, 0.02, -0.1] {
            // Over the ball's side the end is within the tool as seen from above.
            for out in [0.3, 0.24] {
                let foot = gauge(&role).surface.foot(&v(3.0, 1.0, end - 3.0));
                let tip = foot.point + foot.normal * (side * out) + Vec3::z() * (3.0 - below);
                let dense = sampled(&geometry, &tool, &tip);
                if dense <= 0.0 {
                    continue;
                }
                let engine = gauge(&role).contact(&tool, &tip).clearance;
                let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: Vec3::z() });
                let over = dense - engine;
                assert!((-1e-9..2e-3).contains(&over), "{numbers:?} {side} {below} {out}: {engine}, {dense}");
                assert!(
                    (engine - verifier).abs() < 1e-7,
                    "{numbers:?} {side} {below} {out}: {engine}, {verifier}"
                );
            }
        }
    }
}

/// How high up a wall goes on beyond its patches.
fn top(wall: &Geometry) -> f64 {
    let Geometry::Sculptured(definition) = wall else { panic!("a sculptured surface") };
    let extended = Extended::of(definition).expect("patches");
    let corners = |piece: &apt_geometry::parametric::ExtendedPatch| {
        [0.0, 1.0].map(|v| piece.patch.evaluate(0.5, v).position.z).into_iter().fold(f64::MIN, f64::max)
    };
    extended.patches().iter().map(corners).fold(f64::MIN, f64::max)
}

#[test]
fn a_motion_begins_where_a_tool_overhangs_the_end_of_an_upright_wall() {
    let wall = wall([0.0; 4]);
    let low = level(top(&wall) - 0.1);
    for (from, side) in [(5.0, DriveSide::Left), (-4.0, DriveSide::Right)] {
        let mut p = Program::new();
        p.tolerance(0.002, 0.002).cutter(&TOOLS[0]).from(1.5, from, 6.0);
        p.go(&[(To, &wall), (To, &low), (On, &x(1.5))]);
        p.indirv(1.0, 0.0, 0.0).side(side).drive(Turn::Forward, &wall, On, &x(4.0));
        proven(&format!("from {from}"), &p);
    }
}

fn proven(name: &str, p: &Program) {
    for sequence in &p.sequences {
        let evidence = verify(sequence, &|| false).expect("a verdict");
        assert!(evidence.verified, "{name}: {:?}", evidence.violations);
    }
}

#[test]
fn a_high_tool_goes_along_walls_on_both_sides() {
    for (name, wall) in walls() {
        for (from, side) in [(5.0, DriveSide::Left), (-4.0, DriveSide::Right)] {
            let mut p = Program::new();
            p.tolerance(0.002, 0.002).cutter(&TOOLS[0]).from(1.5, from, 2.0);
            p.go(&[(To, &wall), (To, &level(1.2)), (On, &x(1.5))]);
            p.indirv(1.0, 0.0, 0.0).side(side).drive(Turn::Forward, &wall, On, &x(4.0));
            proven(&format!("{name} from {from}"), &p);
            let count = p.sequences[1].points.len();
            assert!(count <= 30, "{name} from {from}: {count} cut vectors");
        }
    }
}

#[test]
fn a_high_tool_goes_up_to_a_wall_and_past_it() {
    for (name, wall) in walls() {
        for (relation, beyond) in [(To, false), (Past, true)] {
            let mut p = Program::new();
            p.tolerance(0.002, 0.002).cutter(&TOOLS[0]).from(3.0, 5.0, 2.0);
            p.go(&[(On, &x(3.0)), (To, &level(1.2)), (On, &y(5.0))]);
            p.indirv(0.0, -1.0, 0.0).side(TlOn).drive(Turn::Forward, &x(3.0), relation, &wall);
            proven(name, &p);
            let surface = Surface::from_geometry(&wall).expect("a surface");
            let sides = [p.tip(), v(3.0, 5.0, 1.2)].map(|place| surface.signed_distance(&place) > 0.0);
            assert_eq!(sides[0] != sides[1], beyond, "{name} {relation:?}: {}", p.tip());
        }
    }
}

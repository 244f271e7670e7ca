use apt_geometry::{
    Vec3,
    canonical::{Geometry, Quadric},
    cutter::Cutter,
    surface::Surface,
};

use super::{Condition, solve};
use crate::{
    attitude::Attitude,
    clearance::{Gauge, Memory, Tool},
    tests::plane,
};

fn gauge(geometry: &Geometry, on: bool) -> Gauge {
    Gauge {
        surface: Surface::from_geometry(geometry).expect("a surface"),
        on,
        side: 1.0,
        thickness: 0.0,
        disk: None,
        memory: Memory::default(),
    }
}

/// A ball that is wider than the bottom of the trough `z = 5 x²` lies on both walls; shortest corrections lead it from one to the other.
#[test]
fn a_tool_between_two_walls_is_led_to_both_at_once() {
    let mut coefficients = [0.0; 10];
    (coefficients[0], coefficients[9]) = (-5.0, 0.5);
    let trough = gauge(&Geometry::Quadric(Quadric { coefficients }), false);
    let across = gauge(&plane(0.0, 1.0, 0.0, 0.0), true);
    let tool = Tool::new(Cutter::from_numbers(&[0.5, 0.25], 1.0).expect("cutter"), Vec3::z());
    let conditions = [Condition::Clearance(&trough, 0.0), Condition::Clearance(&across, 0.0)];
    let solution =
        solve(&Attitude::fixed(tool), &conditions, &Vec3::new(0.02, 0.0, -0.1)).expect("a position");
    // The circle of radius r about (0, c) touches the parabola from within at c = k r² + 1 / (4 k).
    let bottom = 5.0 * 0.0625 + 0.05 - 0.25;
    let away = (solution.tip - Vec3::new(0.0, 0.0, bottom)).norm();
    // A contact may be nearer by 1e-9 of the tool's size than the one that is found.
    assert!(away < 1e-8, "{away} away, {:?}", solution.tip);
    assert!(solution.corrections <= 12, "{} corrections", solution.corrections);
}

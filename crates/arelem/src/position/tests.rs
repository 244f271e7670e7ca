use apt_geometry::{
    Vec3,
    canonical::{Geometry, Quadric},
    cutter::Cutter,
    surface::Surface,
};

use super::{Condition, solve};
use crate::{
    attitude::Attitude,
    clearance::{Gauge, LOOKS_EVERYWHERE, Memory, Tool},
    tests::plane,
    verify::tests::lofts,
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

/// Past the end of a ruled surface a ball touches that end, where it is followed; all is looked at where the corrections begin and where they have led.
#[test]
fn a_contact_at_the_end_of_a_surface_is_followed() {
    let roof = gauge(&lofts::roof(), false);
    // The end is at x = 18.
    let (past, across) = (plane(1.0, 0.0, 0.0, 18.1), plane(0.0, 1.0, 0.0, 0.4));
    let [past, across] = [past, across].map(|plane| gauge(&plane, true));
    let (radius, tool) =
        (0.25, Tool::new(Cutter::from_numbers(&[0.5, 0.25], 1.0).expect("cutter"), Vec3::z()));
    let end = roof.surface.foot(&Vec3::new(18.0, 0.4, 6.0)).point;
    let start = Vec3::new(18.1, 0.4, end.z + 0.1);
    let conditions = [
        Condition::Passing(&roof, 0.0),
        Condition::Clearance(&past, 0.0),
        Condition::Clearance(&across, 0.0),
    ];
    let before = LOOKS_EVERYWHERE.get();
    let solution = solve(&Attitude::fixed(tool), &conditions, &start).expect("a position");
    let looks = LOOKS_EVERYWHERE.get() - before;
    let middle = solution.tip + Vec3::z() * radius;
    let away = roof.surface.foot(&middle).distance.abs();
    assert!((away - radius).abs() < 1e-9, "{away}");
    assert!(solution.corrections >= 2 && looks <= 2, "{looks} looks, {} corrections", solution.corrections);
}

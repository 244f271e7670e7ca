//! Solutions and frames against the numbers of known machines and against closed forms.

use apt_geometry::Vec3;
use proptest::prelude::*;

use super::{super::angle_between, *};
use crate::kinematics::Angles;

/// Degrees and lengths of the numbers below, which have four decimals.
const FOUR_DECIMALS: f64 = 6e-5;

/// Asserts the solution nearest to all zero, and the words at a place.
#[track_caller]
fn assert_stands(kinematics: &Kinematics, place: [f64; 3], axis: Vec3, angles: Angles, words: [f64; 3]) {
    let found = kinematics.solutions(&axis, angles);
    assert!(!found.is_empty());
    assert_near(&found[0], &angles, FOUR_DECIMALS);
    let frame = kinematics.frame(found[0]);
    let word = frame.place(Vec3::from(place));
    assert_near(word.as_slice(), &words, FOUR_DECIMALS);
    assert_near(frame.part(word).as_slice(), &place, 1e-9);
    assert!(angle_between(&kinematics.axis(found[0]), &axis) < 1e-6);
}

#[test]
fn a_table_on_a_table_stands_where_it_was_seen_to_stand() {
    let machine = table_table();
    let forward = leaning(30.0, -90.0);
    assert_stands(&machine, [40.0, 20.0, 10.0], forward, [0.0, 30.0], [40.0, 47.3205, -8.0385]);
    assert_stands(&machine, [40.0, 20.0, 10.0], forward, [180.0, -30.0], [-40.0, -47.3205, -8.0385]);
    let right = leaning(30.0, 0.0);
    assert_stands(&machine, [60.0, 20.0, 10.0], right, [90.0, 30.0], [20.0, -21.9615, 31.9615]);
    assert_stands(&machine, [60.0, 20.0, 10.0], right, [-90.0, -30.0], [-20.0, 21.9615, 31.9615]);
    let between = leaning(30.0, 45.0);
    assert_stands(&machine, [60.0, 40.0, 10.0], between, [135.0, 30.0], [-14.1421, -31.2372, 37.3169]);
}

#[test]
fn heads_stand_where_their_pivot_takes_them() {
    assert_stands(&head_head(), [10.0, 0.0, 0.0], leaning(30.0, 0.0), [90.0, 30.0], [110.0, 0.0, -26.7949]);
    assert_stands(
        &head_table(),
        [50.0, 0.0, 20.0],
        leaning(30.0, 90.0),
        [90.0, 30.0],
        [100.0, -50.0, -6.7949],
    );
}

#[test]
fn the_axis_of_the_tool_in_the_words_is_the_one_of_the_head() {
    assert_near(table_table().frame([70.0, 20.0]).spindle.as_slice(), &[0.0, 0.0, 1.0], 0.0);
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    assert_near(head_table().frame([70.0, 30.0]).spindle.as_slice(), &[sine, 0.0, cosine], 1e-15);
    let head = head_head();
    assert_near(head.frame([70.0, 30.0]).spindle.as_slice(), head.axis([70.0, 30.0]).as_slice(), 1e-15);
    let mut led = table_table();
    led.slides = false;
    let frame = led.frame([70.0, 20.0]);
    assert_near(frame.spindle.as_slice(), led.axis([70.0, 20.0]).as_slice(), 0.0);
    assert_eq!(frame.place(Vec3::new(1.0, 2.0, 3.0)), Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn a_nutating_head_reaches_the_horizontal_with_one_solution_and_nothing_below() {
    let machine = nutating();
    let level = machine.solutions(&leaning(90.0, 10.0), [0.0, 0.0]);
    // Half a turn of the inclined axis leads there from both sides.
    assert!(level.iter().all(|angles| (angles[1].abs() - 180.0).abs() < 1e-6), "{level:?}");
    assert!(!level.is_empty());
    assert!(machine.solutions(&leaning(90.1, 10.0), [0.0, 0.0]).is_empty());
    // Within the decimals of CL data it is still reached.
    assert!(!machine.solutions(&Vec3::new(0.866025, 0.5, -0.0000004), [0.0, 0.0]).is_empty());
    assert_eq!(machine.solutions(&leaning(50.0, 10.0), [0.0, 0.0]).len(), 2);
}

#[test]
fn on_the_pole_the_first_angle_stays() {
    let machine = table_table();
    assert_eq!(machine.solutions(&Vec3::z(), [77.0, 12.0]), [[77.0, 0.0]]);
    // Half the dead cone off it is still the pole, and twice as far it is not.
    assert_eq!(machine.solutions(&leaning(0.0005, 33.0), [77.0, 12.0]), [[77.0, 0.0]]);
    assert_near(&machine.nearest(&leaning(0.002, 33.0), [77.0, 12.0]).unwrap(), &[123.0, 0.002], 1e-9);
    assert_eq!(machine.nearest(&Vec3::x(), [90.0, 90.0]), Some([90.0, 90.0]));
    let found = a_and_b().solutions(&Vec3::x(), [-13.0, 80.0]);
    assert_eq!(found.len(), 1);
    assert_near(&found[0], &[-13.0, 90.0], 1e-12);
    let kept = limited(machine, [[-60.0, 60.0], [-90.0, 90.0]]);
    assert_eq!(kept.nearest(&Vec3::z(), [77.0, 12.0]), Some([60.0, 0.0]));
}

#[test]
fn a_turn_beside_the_last_angle_is_taken() {
    let machine = table_table();
    let right = leaning(30.0, 0.0);
    assert_near(&machine.nearest(&right, [1100.0, 30.0]).unwrap(), &[1170.0, 30.0], 1e-9);
    assert_near(&machine.nearest(&right, [-700.0, 30.0]).unwrap(), &[-630.0, 30.0], 1e-9);
    // Half a turn away, both ways are as far.
    let both: Vec<Angles> =
        machine.solutions(&right, [270.0, 30.0]).into_iter().filter(|angles| angles[1] > 0.0).collect();
    assert_eq!(both.len(), 2);
    assert_near(&[both[0][0], both[1][0]], &[450.0, 90.0], 1e-9);
}

#[test]
fn limits_exclude_solutions_and_lead_to_other_turns() {
    let right = leaning(30.0, 0.0);
    let up = limited(table_table(), [[-360.0, 360.0], [-5.0, 110.0]]);
    assert_near(&up.nearest(&right, [350.0, 0.0]).unwrap(), &[90.0, 30.0], 1e-9);
    assert_eq!(up.solutions(&right, [0.0, 0.0]).len(), 1);
    let narrow = limited(table_table(), [[0.0, 360.0], [-110.0, 110.0]]);
    // −90 is only there as 270.
    assert_near(&narrow.nearest(&right, [0.0, -30.0]).unwrap(), &[90.0, 30.0], 1e-9);
    assert_near(&narrow.nearest(&right, [200.0, -30.0]).unwrap(), &[270.0, -30.0], 1e-9);
    let shut = limited(table_table(), [[0.0, 45.0], [-110.0, 110.0]]);
    assert!(shut.solutions(&right, [0.0, 0.0]).is_empty());
    // An angle that only rounding takes beyond a limit is at it.
    let just = limited(table_table(), [[0.0, 90.0], [0.0, 30.0 - 1e-10]]);
    let [first, second] = just.nearest(&right, [0.0, 0.0]).unwrap();
    assert!(first <= 90.0 && second <= 30.0 - 1e-10);
}

#[test]
fn of_solutions_that_are_as_near_the_preferred_sign_is_taken() {
    let mut machine = table_table();
    let right = leaning(30.0, 0.0);
    assert_near(&machine.nearest(&right, [0.0, 0.0]).unwrap(), &[90.0, 30.0], 1e-9);
    machine.axes[1].prefer = Some(-1.0);
    assert_near(&machine.nearest(&right, [0.0, 0.0]).unwrap(), &[-90.0, -30.0], 1e-9);
    // What is nearer is taken before.
    assert_near(&machine.nearest(&right, [10.0, 10.0]).unwrap(), &[90.0, 30.0], 1e-9);
}

#[test]
fn an_axis_with_six_decimals_is_no_unit_vector_and_reached() {
    for scale in [1.0 - 5e-7, 1.0 + 5e-7] {
        let found = table_table().nearest(&(leaning(0.1, 0.0) * scale), [90.0, 0.0]).unwrap();
        assert_near(&found, &[90.0, 0.1], 1e-9);
    }
}

#[test]
fn a_machine_with_one_rotary_axis_reaches_one_cone() {
    let held = |carried| Rotary { limits: [0.0, 0.0], ..rotary(Vec3::y(), carried, Vec3::zeros()) };
    let tilting = machine(rotary(Vec3::x(), Carried::Head, Vec3::zeros()), held(Carried::Head), 100.0);
    assert_near(&tilting.nearest(&leaning(25.0, -90.0), [0.0, 0.0]).unwrap(), &[25.0, 0.0], 1e-9);
    assert!(tilting.solutions(&leaning(25.0, -80.0), [0.0, 0.0]).is_empty());
    assert!(tilting.solutions(&Vec3::x(), [0.0, 0.0]).is_empty());
    let turning = machine(rotary(Vec3::z(), Carried::Table, Vec3::zeros()), held(Carried::Table), 0.0);
    assert_eq!(turning.solutions(&Vec3::z(), [40.0, 0.0]), [[40.0, 0.0]]);
    assert!(turning.solutions(&leaning(1.0, 0.0), [40.0, 0.0]).is_empty());
}

/// A tool axis anywhere on the sphere.
fn any_axis() -> impl Strategy<Value = Vec3> {
    (0.0..180.0, -180.0..180.0_f64).prop_map(|(tilt, azimuth)| leaning(tilt, azimuth))
}

/// A unit vector of a rotary axis.
fn any_vector() -> impl Strategy<Value = Vec3> {
    any_axis()
}

proptest! {
    #[test]
    fn angles_of_a_solution_point_along_the_axis(
        n1 in any_vector(), n2 in any_vector(), tool in (-180.0..180.0_f64, -180.0..180.0_f64),
    ) {
        prop_assume!(n1.cross(&n2).norm() > 0.1 && n2.cross(&Vec3::z()).norm() > 0.1);
        let origin = Vec3::zeros();
        let kinematics = machine(rotary(n1, Carried::Table, origin), rotary(n2, Carried::Head, origin), 10.0);
        let axis = kinematics.axis([tool.0, tool.1]);
        prop_assume!(kinematics.pole(&axis).is_none());
        let found = kinematics.solutions(&axis, [0.0, 0.0]);
        prop_assert!(!found.is_empty());
        for angles in &found {
            prop_assert!(angle_between(&kinematics.axis(*angles), &axis) <= 2e-6);
            prop_assert!(angles.iter().all(|angle| angle.abs() <= 180.0 + 1e-6));
        }
        // The angles that it was made from are among them.
        let is_there = |angles: &Angles| (0..2).all(|which| {
            let apart = (angles[which] - [tool.0, tool.1][which]).rem_euclid(360.0);
            apart.min(360.0 - apart) < 1e-2
        });
        prop_assert!(found.iter().any(is_there), "{found:?}");
    }

    #[test]
    fn closed_forms_are_among_the_solutions(axis in any_axis()) {
        prop_assume!(axis.xy().norm() > 1e-4 && axis.yz().norm() > 1e-4);
        let tilt = axis.z.acos().to_degrees();
        let around = |y: f64, x: f64| y.atan2(x).to_degrees();
        let forms = [
            (table_table(), [around(axis.x, -axis.y), tilt]),
            (head_head(), [around(axis.x, -axis.y), tilt]),
            (head_table(), [around(axis.y, axis.x), tilt]),
            (a_and_b(), [around(-axis.y, axis.z), axis.x.asin().to_degrees()]),
        ];
        for (kinematics, [first, second]) in forms {
            let is_a_and_b = kinematics == a_and_b();
            let other = [
                if first > 0.0 { first - 180.0 } else { first + 180.0 },
                if is_a_and_b { 180.0 - second } else { -second },
            ];
            for form in [[first, second], other] {
                let found = kinematics.nearest(&axis, form);
                prop_assert!(found.is_some_and(|found| super::super::solve::farther(found, form) < 1e-3), "{found:?} {form:?}");
            }
        }
    }

    #[test]
    fn frames_are_the_linear_formulas(
        place in (-99.0..99.0_f64, -99.0..99.0_f64, -99.0..99.0_f64), angles in (-180.0..180.0_f64, -180.0..180.0_f64),
        center in (-50.0..50.0_f64, -50.0..50.0_f64, -50.0..50.0_f64), other in (-50.0..50.0_f64, -50.0..50.0_f64, -50.0..50.0_f64),
    ) {
        let vector = |(x, y, z): (f64, f64, f64)| Vec3::new(x, y, z);
        let (place, center, other) = (vector(place), vector(center), vector(other));
        let about_z = |p: Vec3, degrees: f64| {
            let (s, c) = degrees.to_radians().sin_cos();
            Vec3::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z)
        };
        let about_x = |p: Vec3, degrees: f64| {
            let (s, c) = degrees.to_radians().sin_cos();
            Vec3::new(p.x, c * p.y - s * p.z, s * p.y + c * p.z)
        };
        let (c, tilt): (f64, f64) = angles;
        let mut tables = table_table();
        tables.axes[0].center = center;
        tables.axes[1].center = other;
        let turned = about_z(place - center, -c) + center;
        let expected = about_x(turned - other, -tilt) + other;
        assert_near(tables.frame([c, tilt]).place(place).as_slice(), expected.as_slice(), 1e-9);

        let heads = head_head();
        let expected = place + (heads.axis([c, tilt]) - Vec3::z()) * 200.0;
        assert_near(heads.frame([c, tilt]).place(place).as_slice(), expected.as_slice(), 1e-9);

        let mut both = head_table();
        both.axes[0].center = center;
        let (sine, cosine) = tilt.to_radians().sin_cos();
        let expected = turned + Vec3::new(sine, 0.0, cosine - 1.0) * 200.0;
        let frame = both.frame([c, tilt]);
        assert_near(frame.place(place).as_slice(), expected.as_slice(), 1e-9);
        assert_near(frame.part(expected).as_slice(), place.as_slice(), 1e-9);
    }
}

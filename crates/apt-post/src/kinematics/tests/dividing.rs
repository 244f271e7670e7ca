//! Into how many parts moves are divided, and what is kept between them.

use super::{
    super::{
        angle_between,
        divide::{Course, Stand, Tolerances, TooMany, divide},
        plan::plan,
    },
    *,
};
use apt_geometry::patience::{Patience, Waiting};
use proptest::prelude::*;

use crate::kinematics::Angles;

/// A stand with the angles that are nearest to others.
fn stand(kinematics: &Kinematics, tip: [f64; 3], axis: Vec3, near: Angles) -> Stand {
    Stand { tip: Vec3::from(tip), axis, angles: kinematics.nearest(&axis, near).unwrap() }
}

/// What [`divide`] gives for nobody who waits, and an axis that may turn by some degrees off.
fn divided(
    kinematics: &Kinematics,
    from: &Stand,
    to: &Stand,
    tip: f64,
    axis: f64,
) -> Result<Vec<Stand>, TooMany> {
    let tolerances = Tolerances { tip, axis: axis.to_radians(), most: 10_000 };
    divide(kinematics, from, to, &tolerances, Patience::default())
}

/// The farthest that the tool end and the tool axis are off between positions, measured densely.
fn farthest_off(kinematics: &Kinematics, from: &Stand, stands: &[Stand]) -> (f64, f64) {
    const TIMES: i32 = 200;
    let mut last = *from;
    let mut off = (0.0_f64, 0.0_f64);
    for stand in stands {
        let words = [&last, stand].map(|end| kinematics.frame(end.angles).place(end.tip));
        for index in 0..=TIMES {
            let time = f64::from(index) / f64::from(TIMES);
            let angles = [0, 1].map(|which| last.angles[which] * (1.0 - time) + stand.angles[which] * time);
            let tip = kinematics.frame(angles).part(words[0].lerp(&words[1], time));
            off.0 = off.0.max((tip - last.tip.lerp(&stand.tip, time)).norm());
            let axis = last.axis.slerp(&stand.axis, time);
            off.1 = off.1.max(angle_between(&axis, &kinematics.axis(angles)));
        }
        last = *stand;
    }
    off
}

/// The move of 20 across which the table turns by a quarter.
fn quarter(kinematics: &Kinematics) -> (Stand, Stand) {
    let from = stand(kinematics, [40.0, 20.0, 10.0], leaning(30.0, -90.0), [0.0, 30.0]);
    (from, stand(kinematics, [60.0, 20.0, 10.0], leaning(30.0, 0.0), [90.0, 30.0]))
}

/// How far the tool end is off at some times between two stands, and how far at most.
fn off_at(kinematics: &Kinematics, from: &Stand, to: &Stand, times: &[f64]) -> f64 {
    let words = [from, to].map(|end| kinematics.frame(end.angles).place(end.tip));
    let off = |time: &f64| {
        let angles = [0, 1].map(|which| from.angles[which] * (1.0 - time) + to.angles[which] * time);
        let tip = kinematics.frame(angles).part(words[0].lerp(&words[1], *time));
        (tip - from.tip.lerp(&to.tip, *time)).norm()
    };
    times.iter().map(off).fold(0.0, f64::max)
}

/// Parts when whatever is off at a quarter, the half or three quarters is halved, as a simple post-processor does.
fn halved(kinematics: &Kinematics, from: &Stand, to: &Stand, tip: f64) -> usize {
    if off_at(kinematics, from, to, &[0.25, 0.5, 0.75]) <= tip {
        return 1;
    }
    let middle = from.tip.lerp(&to.tip, 0.5);
    let axis = from.axis.slerp(&to.axis, 0.5);
    let middle = stand(kinematics, middle.into(), axis, from.angles);
    halved(kinematics, from, &middle, tip) + halved(kinematics, &middle, to, tip)
}

#[test]
fn a_quarter_turn_needs_fewer_parts_than_halving() {
    let kinematics = table_table();
    let (from, to) = quarter(&kinematics);
    assert_near(&[off_at(&kinematics, &from, &to, &[0.5])], &[19.535], 5e-4);
    for (tip, parts, halves) in [(1.0, 5, 8), (0.1, 15, 21), (0.02, 34, 51), (0.01, 48, 64)] {
        assert_eq!(halved(&kinematics, &from, &to, tip), halves);
        let stands = divided(&kinematics, &from, &to, tip, 90.0).unwrap();
        assert_eq!(stands.len(), parts, "for {tip}");
        let (off, _) = farthest_off(&kinematics, &from, &stands);
        assert!(off <= tip && off > 0.98 * tip, "{off} for {tip}");
        assert_eq!(stands[parts - 1], to);
    }
}

#[test]
fn what_does_not_turn_is_one_part() {
    let kinematics = table_table();
    let from = stand(&kinematics, [0.0, 0.0, 0.0], leaning(30.0, 20.0), [0.0, 0.0]);
    let to = Stand { tip: Vec3::new(500.0, 20.0, -3.0), ..from };
    assert_eq!(divided(&kinematics, &from, &to, 1e-6, 1e-6), Ok(vec![to]));
    assert_eq!(divided(&kinematics, &from, &from, 1e-6, 1e-6), Ok(vec![from]));
}

#[test]
fn only_the_axis_counts_where_the_control_leads_the_tool_end() {
    let mut led = table_table();
    led.slides = false;
    let (from, to) = quarter(&led);
    assert_eq!(divided(&led, &from, &to, 1e-9, 90.0).unwrap().len(), 1);
    let parts = divided(&led, &from, &to, 1e-9, 0.1).unwrap();
    assert!((5..20).contains(&parts.len()), "{}", parts.len());
    let (_, off) = farthest_off(&led, &from, &parts);
    assert!(off.to_degrees() <= 0.1, "{off}");
    // And with slides the stricter of both.
    assert_eq!(divided(&table_table(), &from, &to, 100.0, 0.1).unwrap().len(), parts.len());
}

#[test]
fn the_short_rest_of_a_move_is_shared_by_the_last_two_parts() {
    let kinematics = table_table();
    let (from, to) = quarter(&kinematics);
    for tip in [3.0, 0.5, 0.3, 0.2, 0.05, 0.03] {
        let stands = divided(&kinematics, &from, &to, tip, 90.0).unwrap();
        let mut xs = vec![from.tip.x];
        xs.extend(stands.iter().map(|stand| stand.tip.x));
        let parts: Vec<f64> = xs.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let [.., before, last] = parts[..] else { panic!("one part") };
        assert!(last > 0.8 * before, "{parts:?}");
    }
}

#[test]
fn through_the_pole_the_tilt_goes_on() {
    let kinematics = table_table();
    let from = stand(&kinematics, [0.0, 0.0, 0.0], leaning(30.0, -90.0), [0.0, 0.0]);
    let to = Stand { tip: Vec3::new(0.0, 50.0, 0.0), axis: leaning(30.0, 90.0), angles: [0.0, -30.0] };
    let stands = divided(&kinematics, &from, &to, 0.01, 0.01).unwrap();
    assert!(stands.len() > 5);
    assert!(stands.iter().all(|stand| stand.angles[0].abs() < 1e-9));
    let (tip, axis) = farthest_off(&kinematics, &from, &stands);
    assert!(tip <= 0.01 && axis.to_degrees() <= 0.01);
}

#[test]
fn on_the_pole_the_table_turns_where_the_rest_of_the_way_needs_it() {
    let kinematics = table_table();
    let from = Stand { tip: Vec3::new(40.0, 20.0, 10.0), axis: Vec3::z(), angles: [0.0, 0.0] };
    let to = stand(&kinematics, [60.0, 20.0, 10.0], leaning(30.0, 0.0), [90.0, 30.0]);
    let stands = divided(&kinematics, &from, &to, 0.1, 1.0).unwrap();
    let turned = stands.iter().position(|stand| (stand.angles[0] - 90.0).abs() < 1e-9).unwrap();
    assert!(turned > 3 && stands[..=turned].iter().all(|stand| (stand.tip - from.tip).norm() < 1e-12));
    assert!(stands[turned..].iter().all(|stand| (stand.angles[0] - 90.0).abs() < 1e-9));
    assert!(farthest_off(&kinematics, &from, &stands).0 <= 0.1);
    // The same the other way round.
    let back = divided(&kinematics, &to, &from, 0.1, 1.0).unwrap();
    assert_eq!((back.len(), back[back.len() - 1]), (stands.len(), from));
    assert!(farthest_off(&kinematics, &to, &back).0 <= 0.1);
    // And in the middle, as the tilt has no room on the other side.
    let opposite = stand(&kinematics, [20.0, 20.0, 10.0], leaning(30.0, 180.0), [-90.0, 30.0]);
    let through = divided(&kinematics, &opposite, &to, 0.1, 1.0).unwrap();
    let (tip, axis) = farthest_off(&kinematics, &opposite, &through);
    assert!(tip <= 0.1 && axis.to_degrees() <= 1.0, "{tip} {axis}");
    let at_rest = through.iter().filter(|stand| (stand.tip.x - 40.0).abs() < 1e-9).count();
    assert!(at_rest > 6, "{at_rest}");
    // In line with the first rotary axis nothing is off.
    let above = Stand { tip: Vec3::new(0.0, 0.0, 10.0), ..from };
    let turned = Stand { angles: [90.0, 0.0], ..above };
    assert_eq!(divided(&kinematics, &above, &turned, 0.1, 1.0), Ok(vec![turned]));
}

#[test]
fn where_only_angles_differ_they_turn_evenly() {
    let kinematics = table_table();
    let from = Stand { tip: Vec3::new(40.0, 20.0, 10.0), axis: Vec3::z(), angles: [0.0, 0.0] };
    let to = Stand { tip: Vec3::new(50.0, 20.0, 10.0), angles: [180.0, 0.0], ..from };
    let stands = divided(&kinematics, &from, &to, 0.1, 1.0).unwrap();
    assert!(stands.len() > 10);
    for stand in &stands {
        assert_near(&[stand.angles[0], stand.angles[1]], &[(stand.tip.x - 40.0) * 18.0, 0.0], 1e-9);
    }
    assert!(farthest_off(&kinematics, &from, &stands).0 <= 0.1);
}

#[test]
fn in_the_dead_cone_the_ends_may_be_off_by_as_much() {
    let mut kinematics = table_table();
    kinematics.dead_cone = 0.5_f64.to_radians();
    for (from, to) in [(0.4, 30.0), (-0.4, 30.0), (-20.0, 30.0), (-20.0, -0.3), (-0.4, 0.4)] {
        let [from, to] = [(from, 40.0), (to, 60.0)]
            .map(|(tilt, x)| stand(&kinematics, [x, 20.0, 10.0], leaning(tilt, 5.0), [0.0, 0.0]));
        let stands = divided(&kinematics, &from, &to, 0.1, 0.1).unwrap();
        let (tip, axis) = farthest_off(&kinematics, &from, &stands);
        assert!(tip <= 0.1 && axis.to_degrees() <= 0.6, "{tip} {axis}");
    }
}

#[test]
fn at_a_limit_the_great_circle_may_lead_beyond_it_by_the_tolerance() {
    let kinematics = limited(table_table(), [[-360.0, 360.0], [-110.0, 110.0]]);
    let from = stand(&kinematics, [40.0, 20.0, 10.0], leaning(110.0, -90.0), [0.0, 110.0]);
    let to = stand(&kinematics, [60.0, 20.0, 10.0], leaning(110.0, -70.0), [20.0, 110.0]);
    let middle = from.axis.slerp(&to.axis, 0.5);
    let beyond = middle.z.acos().to_degrees() - 110.0;
    assert!((0.2..0.4).contains(&beyond), "{beyond}");
    let stands = divided(&kinematics, &from, &to, 0.01, 0.5).unwrap();
    assert!(stands.len() > 10 && stands.iter().all(|stand| stand.angles[1] <= 110.0));
    let (tip, axis) = farthest_off(&kinematics, &from, &stands);
    assert!(tip <= 0.01 && axis.to_degrees() <= 0.5, "{tip} {axis}");
    assert_eq!(divided(&kinematics, &from, &to, 0.01, 0.2), Err(TooMany));
}

#[test]
fn close_to_the_pole_the_table_turns_far_in_small_parts() {
    let kinematics = table_table();
    let from = stand(&kinematics, [40.0, 20.0, 10.0], leaning(1.0, -90.0), [0.0, 0.0]);
    let to = stand(&kinematics, [45.0, 20.0, 10.0], leaning(1.0, 0.0), [90.0, 0.0]);
    assert_near(&to.angles, &[90.0, 1.0], 1e-9);
    assert_near(&[angle_between(&from.axis, &to.axis).to_degrees()], &[1.414], 1e-3);
    let stands = divided(&kinematics, &from, &to, 0.01, 0.1).unwrap();
    let (tip, axis) = farthest_off(&kinematics, &from, &stands);
    assert!(tip <= 0.01 && axis.to_degrees() <= 0.1);
    assert!((20..80).contains(&stands.len()), "{}", stands.len());
}

#[test]
fn what_cannot_be_divided_is_told() {
    let kinematics = table_table();
    let (from, to) = quarter(&kinematics);
    let few = |most| {
        let tolerances = Tolerances { tip: 0.01, axis: 1.0, most };
        divide(&kinematics, &from, &to, &tolerances, Patience::default()).map(|stands| stands.len())
    };
    assert_eq!((few(47), few(48)), (Err(TooMany), Ok(48)));
    // Angles of another turn are not come to without the pole.
    let another = Stand { angles: [450.0, 30.0], ..to };
    for most in [10_000, usize::MAX] {
        let tolerances = Tolerances { tip: 0.1, axis: 1.0, most };
        assert_eq!(divide(&kinematics, &from, &another, &tolerances, Patience::default()), Err(TooMany));
    }
    // Nor may the tool leave its axis for a whole turn where both ends have the same.
    assert_eq!(divided(&kinematics, &to, &another, 0.1, 1.0), Err(TooMany));
    // Neither are opposite axes by one great circle, nor what is beyond the machine.
    let opposite = Stand { axis: -from.axis, angles: [0.0, -150.0], ..from };
    assert_eq!(divided(&kinematics, &from, &opposite, 0.1, 1.0), Err(TooMany));
    let low = [80.0, -80.0].map(|tilt| stand(&nutating(), [0.0; 3], leaning(tilt, 0.0), [0.0, 0.0]));
    let below = Stand { axis: -Vec3::z(), ..low[1] };
    assert_eq!(divided(&nutating(), &low[0], &below, 0.1, 1.0), Err(TooMany));
    for tolerance in [0.0, -1.0, f64::NAN] {
        assert_eq!(divided(&kinematics, &from, &to, tolerance, 1.0), Err(TooMany));
    }
    let waiting = Waiting::until(&|| true);
    let tolerances = Tolerances { tip: 1e-9, axis: 1e-9, most: usize::MAX };
    assert_eq!(divide(&kinematics, &from, &to, &tolerances, waiting.patience()), Err(TooMany));
}

proptest! {
    #[test]
    fn how_fast_the_tool_bends_off_its_way_is_bounded(
        vectors in [(0.0..180.0, -180.0..180.0_f64), (0.0..180.0, -180.0..180.0_f64)], tables in 0..3_usize,
        from in [-180.0..180.0_f64, -180.0..180.0_f64], turns in [-90.0..90.0_f64, -90.0..90.0_f64],
        tips in [[-90.0..90.0_f64, -90.0..90.0_f64, -90.0..90.0_f64], [-90.0..90.0_f64, -90.0..90.0_f64, -90.0..90.0_f64]],
        time in 0.01..0.99_f64,
    ) {
        // Small enough for what is left out, large enough for what rounding leaves.
        const STEP: f64 = 1e-4;
        let carried = |which: usize| if which < tables { Carried::Table } else { Carried::Head };
        let [first, second] = [0, 1].map(|which| {
            let (tilt, azimuth) = vectors[which];
            rotary(leaning(tilt, azimuth), carried(which), Vec3::new(tilt, azimuth, 3.0))
        });
        let kinematics = machine(first, second, 70.0);
        let at = |tip: [f64; 3], angles: Angles| Stand { tip: Vec3::from(tip), axis: kinematics.axis(angles), angles };
        let (start, end) = (at(tips[0], from), at(tips[1], [from[0] + turns[0], from[1] + turns[1]]));
        let course = Course::new(&kinematics, &start, &end, angle_between(&start.axis, &end.axis));
        let bent = |off: &dyn Fn(f64) -> Vec3| {
            (off(time + STEP) + off(time - STEP) - off(time) * 2.0).norm() / (STEP * STEP)
        };
        let bend = course.bend();
        let (tip, axis) = (bent(&|time| course.tip_off(time)), bent(&|time| course.axis_off(time)));
        prop_assert!(tip <= bend.tip * (1.0 + 1e-3) + 1e-3, "{tip} {}", bend.tip);
        prop_assert!(axis <= bend.axis * (1.0 + 1e-3) + 1e-5, "{axis} {}", bend.axis);
    }

    #[test]
    fn between_positions_the_tolerances_are_kept(
        from in (0.5..80.0_f64, -180.0..180.0_f64), to in (0.5..80.0_f64, -180.0..180.0_f64),
        tips in [-90.0..90.0_f64, -90.0..90.0_f64, -90.0..90.0_f64], which in 0..5_usize,
        tip in 0.01..2.0_f64, axis in 0.01..2.0_f64,
    ) {
        let kinematics = [table_table(), head_head(), head_table(), nutating(), a_and_b()][which];
        let start = stand(&kinematics, tips, leaning(from.0, from.1), [0.0, 0.0]);
        let axis_of_end = leaning(to.0, to.1);
        let axes = [start.axis, axis_of_end];
        let angles = plan(&kinematics, &axes, start.angles, Patience::default()).unwrap();
        let start = Stand { angles: angles[0], ..start };
        let end = Stand { tip: Vec3::from(tips) * 0.3, axis: axis_of_end, angles: angles[1] };
        let stands = divided(&kinematics, &start, &end, tip, axis).unwrap();
        let (tip_off, axis_off) = farthest_off(&kinematics, &start, &stands);
        prop_assert!(tip_off <= tip * (1.0 + 1e-9), "{tip_off}");
        prop_assert!(axis_off.to_degrees() <= axis * 1.001, "{}", axis_off.to_degrees());
        prop_assert_eq!(stands[stands.len() - 1], end);
        // Two of the parts, without those that share the rest, are never one.
        for (index, pair) in stands.windows(2).enumerate().take(stands.len().saturating_sub(2)) {
            let before = if index == 0 { start } else { stands[index - 1] };
            let (tip_off, axis_off) = farthest_off(&kinematics, &before, &pair[1..]);
            prop_assert!(tip_off > tip || axis_off.to_degrees() > axis, "{tip_off} {axis_off}");
        }
    }
}

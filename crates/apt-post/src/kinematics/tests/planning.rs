//! Which beginning leads through a whole stretch.

use apt_geometry::{
    Vec3,
    patience::{Patience, Waiting},
};
use proptest::prelude::*;

use super::{
    super::{
        angle_between,
        plan::{Unplanned, plan},
    },
    *,
};
use crate::kinematics::Angles;

/// Axes that lean alike, from one azimuth to another in steps of ten degrees.
fn around(tilt: f64, from: i32, to: i32) -> Vec<Vec3> {
    let step = if to < from { -10 } else { 10 };
    (0..=(to - from) / step).map(|index| leaning(tilt, f64::from(from + step * index))).collect()
}

/// What [`plan`] gives for nobody who waits.
fn planned(kinematics: &Kinematics, axes: &[Vec3], here: Angles) -> Result<Vec<Angles>, Unplanned> {
    plan(kinematics, axes, here, Patience::default())
}

#[test]
fn a_table_without_end_follows_three_turns() {
    for kinematics in [table_table(), head_head(), nutating()] {
        let angles = planned(&kinematics, &around(30.0, 0, 1080), [0.0, 0.0]).unwrap();
        for pair in angles.windows(2) {
            assert_near(&[pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]], &[10.0, 0.0], 1e-9);
        }
        assert_near(&[angles[108][0] - angles[0][0]], &[1080.0], 1e-9);
    }
}

#[test]
fn the_other_side_is_begun_with_where_a_limit_ends_the_first() {
    let kinematics = limited(table_table(), [[-180.0, 180.0], [-110.0, 110.0]]);
    let back = around(30.0, 0, 80);
    assert_near(&planned(&kinematics, &back, [90.0, 30.0]).unwrap()[8], &[170.0, 30.0], 1e-9);
    let farther = around(30.0, 0, 150);
    let angles = planned(&kinematics, &farther, [90.0, 30.0]).unwrap();
    assert_near(&angles[0], &[-90.0, -30.0], 1e-9);
    assert_near(&angles[15], &[60.0, -30.0], 1e-9);
}

#[test]
fn another_whole_turn_is_begun_with_where_a_limit_ends_the_nearest() {
    let kinematics = limited(table_table(), [[-360.0, 360.0], [-5.0, 110.0]]);
    let angles = planned(&kinematics, &around(30.0, 0, 500), [0.0, 0.0]).unwrap();
    assert_near(&angles[0], &[-270.0, 30.0], 1e-9);
    assert_near(&angles[50], &[230.0, 30.0], 1e-9);
    // So far around leads no turn: it ends where the best one does.
    let far = planned(&kinematics, &around(30.0, 0, 700), [0.0, 0.0]);
    let Err(Unplanned::Limit { at: 64, which: 0, angle }) = far else { panic!("{far:?}") };
    assert_near(&[angle], &[370.0], 1e-9);
}

#[test]
fn another_whole_turn_of_the_tilt_is_begun_with_where_a_limit_ends_the_nearest() {
    // From −80 the tilt goes down to −120, and there is room only a turn above.
    let axes: Vec<Vec3> = [80.0, 100.0, 120.0].map(|tilt| leaning(tilt, 90.0)).to_vec();
    let kinematics = limited(table_table(), [[-10.0, 10.0], [-100.0, 300.0]]);
    let angles = planned(&kinematics, &axes, [0.0, -80.0]).unwrap();
    assert_near(&angles[0], &[0.0, 280.0], 1e-9);
    assert_near(&angles[2], &[0.0, 240.0], 1e-9);
}

#[test]
fn through_the_pole_the_tilt_goes_on_and_the_table_rests() {
    let axes: Vec<Vec3> = (-3..=3).map(|step| leaning(f64::from(10 * step), 40.0)).collect();
    for axes in [axes.clone(), vec![axes[0], axes[6]]] {
        let angles = planned(&table_table(), &axes, [-50.0, 20.0]).unwrap();
        assert_near(&angles[0], &[-50.0, 30.0], 1e-9);
        assert_near(&angles[axes.len() - 1], &[-50.0, -30.0], 1e-9);
        assert!(angles.iter().all(|angles| (angles[0] + 50.0).abs() < 1e-9), "{angles:?}");
    }
    // Without room on the other side the table turns there.
    let up = limited(table_table(), [[-360.0, 360.0], [-5.0, 110.0]]);
    let angles = planned(&up, &axes, [-50.0, 20.0]).unwrap();
    assert_near(&angles[3], &[-50.0, 0.0], 1e-9);
    assert_near(&angles[4], &[130.0, 10.0], 1e-9);
}

#[test]
fn beside_the_pole_the_side_is_kept() {
    // The other side were nearer by 18 degrees, and the tool would not get there without the pole.
    let angles = planned(&table_table(), &[leaning(1.0, 0.0), leaning(1.0, 100.0)], [90.0, 0.0]).unwrap();
    assert_near(&angles[0], &[90.0, 1.0], 1e-9);
    assert_near(&angles[1], &[190.0, 1.0], 1e-9);
}

#[test]
fn an_inclined_axis_turns_the_table_more_than_the_azimuth() {
    // From near the pole around it to a far lean: the inclined axis itself changes the azimuth as far.
    let kinematics = nutating();
    let ends = [leaning(2.0, 0.0), leaning(85.0, 179.0), leaning(2.0, 0.0), leaning(85.0, -179.0)];
    for pair in ends.chunks(2) {
        let fine: Vec<Vec3> =
            (0..=20_000).map(|step| pair[0].slerp(&pair[1], f64::from(step) / 20_000.0)).collect();
        for here in kinematics.solutions(&pair[0], [0.0, 0.0]) {
            let many = planned(&kinematics, &fine, here).unwrap();
            let one = planned(&kinematics, pair, here).unwrap();
            assert_near(&many[20_000], &one[1], 1e-6);
        }
    }
}

#[test]
fn first_positions_on_the_pole_look_ahead() {
    let axes = [Vec3::z(), Vec3::z(), leaning(30.0, 0.0)];
    let angles = planned(&head_head(), &axes, [0.0, 0.0]).unwrap();
    for (found, expected) in angles.iter().zip([[90.0, 0.0], [90.0, 0.0], [90.0, 30.0]]) {
        assert_near(found, &expected, 1e-9);
    }
    // Later ones keep theirs.
    let axes = [leaning(30.0, 0.0), Vec3::z(), leaning(30.0, 30.0)];
    let angles = planned(&head_head(), &axes, [0.0, 0.0]).unwrap();
    assert_near(&angles[1], &[90.0, 0.0], 1e-9);
    assert_near(&angles[2], &[120.0, 30.0], 1e-9);
    // And a stretch on the pole turns nothing.
    assert_eq!(planned(&head_head(), &[Vec3::z(); 3], [17.0, 0.0]), Ok(vec![[17.0, 0.0]; 3]));
    assert_eq!(planned(&head_head(), &[], [17.0, 0.0]), Ok(vec![]));
}

#[test]
fn of_two_beginnings_that_lead_to_the_end_the_preferred_one_is_taken() {
    let mut kinematics = table_table();
    let axes = around(20.0, 0, 50);
    assert_near(&planned(&kinematics, &axes, [-80.0, -20.0]).unwrap()[0], &[-90.0, -20.0], 1e-9);
    kinematics.axes[1].prefer = Some(1.0);
    assert_near(&planned(&kinematics, &axes, [-80.0, -20.0]).unwrap()[0], &[90.0, 20.0], 1e-9);
    kinematics.axes[1].prefer = None;
    kinematics.axes[0].prefer = Some(1.0);
    assert_near(&planned(&kinematics, &axes, [-480.0, -20.0]).unwrap()[0], &[90.0, 20.0], 1e-9);
}

#[test]
fn what_cannot_be_followed_is_told_with_its_place() {
    let axes = [leaning(10.0, 0.0), leaning(50.0, 0.0), leaning(70.0, 0.0)];
    let kinematics = limited(table_table(), [[-360.0, 360.0], [-45.0, 60.0]]);
    let Err(Unplanned::Limit { at: 2, which: 1, angle }) = planned(&kinematics, &axes, [-90.0, -10.0]) else {
        panic!("no limit")
    };
    assert_near(&[angle], &[70.0], 1e-9);
    let below = [leaning(10.0, 0.0), leaning(95.0, 0.0)];
    assert_eq!(planned(&nutating(), &below, [0.0, 0.0]), Err(Unplanned::Unreachable { at: 1 }));
    assert_eq!(planned(&nutating(), &below[1..], [0.0, 0.0]), Err(Unplanned::Unreachable { at: 0 }));
    let held = limited(table_table(), [[-360.0, 360.0], [0.0, 0.0]]);
    assert_eq!(planned(&held, &below, [0.0, 0.0]), Err(Unplanned::Unreachable { at: 0 }));
    let first_beyond = planned(&kinematics, &axes[2..], [0.0, 0.0]);
    assert!(matches!(first_beyond, Err(Unplanned::Limit { at: 0, which: 1, .. })), "{first_beyond:?}");
}

#[test]
fn who_gives_up_is_not_kept_waiting() {
    let waiting = Waiting::until(&|| true);
    let axes = around(30.0, 0, 36_000);
    let Err(Unplanned::Unreachable { at }) = plan(&table_table(), &axes, [0.0, 0.0], waiting.patience())
    else {
        panic!("it went on")
    };
    assert!(at < 300, "{at}");
}

/// Axes each of which is some degrees from the one before.
fn any_way() -> impl Strategy<Value = Vec<Vec3>> {
    let step = (-0.1..0.1_f64, -0.1..0.1_f64, -0.1..0.1_f64);
    proptest::collection::vec(step, 2..60).prop_map(|steps| {
        let mut axis = leaning(20.0, 0.0);
        let mut go_on = |(x, y, z): (f64, f64, f64)| {
            axis = (axis + Vec3::new(x, y, z + 0.03)).normalize();
            axis
        };
        steps.into_iter().map(&mut go_on).collect()
    })
}

/// How many axes each beginning within the limits leads to, by trying all of them.
fn all_reached(kinematics: &Kinematics, axes: &[Vec3]) -> Vec<usize> {
    let free = limited(*kinematics, [[f64::NEG_INFINITY, f64::INFINITY]; 2]);
    let mut all = Vec::new();
    for [first, second] in free.solutions(&axes[0], [0.0, 0.0]) {
        for turns in 0..49 {
            let (i, j) = (turns % 7 - 3, turns / 7 - 3);
            let begun = [first + 360.0 * f64::from(i), second + 360.0 * f64::from(j)];
            let Ok(mut angles) = kinematics.limited(begun) else { continue };
            let mut reached = 1;
            for pair in axes.windows(2) {
                let Ok(next) = kinematics.follow(&pair[0], angles, &pair[1]) else { break };
                angles = next;
                reached += 1;
            }
            all.push(reached);
        }
    }
    all
}

proptest! {
    #[test]
    fn no_beginning_leads_farther_than_the_plan(
        axes in any_way(), here in (-400.0..400.0_f64, -90.0..90.0_f64), which in 0..4_usize,
        first in (-400.0..0.0_f64, 0.0..400.0_f64), second in (-120.0..0.0_f64, 0.0..300.0_f64),
    ) {
        let kinematics = [table_table(), head_table(), nutating(), a_and_b()][which];
        let kinematics = limited(kinematics, [[first.0, first.1], [second.0, second.1]]);
        let farthest = all_reached(&kinematics, &axes).into_iter().max().unwrap_or(0);
        match planned(&kinematics, &axes, [here.0, here.1]) {
            Ok(angles) => prop_assert_eq!(angles.len(), axes.len()),
            Err(Unplanned::Unreachable { at } | Unplanned::Limit { at, .. }) => {
                prop_assert!(at < axes.len() && farthest <= at, "{farthest} {at}");
            }
        }
    }

    #[test]
    fn what_is_planned_points_along_its_axes_within_the_limits(axes in any_way(), here in -400.0..400.0_f64) {
        let limits = [[-360.0, 360.0], [-110.0, 110.0]];
        for kinematics in [table_table(), head_table(), a_and_b()] {
            let kinematics = limited(kinematics, limits);
            let Ok(angles) = planned(&kinematics, &axes, [here, 0.0]) else { continue };
            prop_assert_eq!(angles.len(), axes.len());
            for (angles, axis) in angles.iter().zip(&axes) {
                prop_assert!(angle_between(&kinematics.axis(*angles), axis) < 2e-5);
                prop_assert!((0..2).all(|which| (limits[which][0]..=limits[which][1]).contains(&angles[which])));
            }
        }
    }

    #[test]
    fn great_circles_are_followed_alike_in_one_step_and_in_many(
        from in (1.0..80.0_f64, -180.0..180.0_f64), to in (1.0..80.0_f64, -180.0..180.0_f64),
    ) {
        let (from, to) = (leaning(from.0, from.1), leaning(to.0, to.1));
        for kinematics in [table_table(), head_table(), nutating(), a_and_b()] {
            // Nearer to the pole small steps turn half around as well.
            prop_assume!(kinematics.pole_between(&from, &to).is_none());
            let steps = 200;
            let fine: Vec<Vec3> =
                (0..=steps).map(|step| from.lerp(&to, f64::from(step) / f64::from(steps)).normalize()).collect();
            let many = planned(&kinematics, &fine, [0.0, 0.0]);
            let one = planned(&kinematics, &[from, to], [0.0, 0.0]);
            let (Ok(many), Ok(one)) = (many, one) else { panic!("unlimited") };
            assert_near(&many[steps as usize], &one[1], 1e-6);
        }
    }
}

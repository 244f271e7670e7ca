//! Check surfaces that the tool hardly comes to or hardly is in: what is delivered is proven, on the exact route as on the general one.

use apt_geometry::{
    canonical::Geometry,
    motion::{DriveSide, MotionCommand, Relation, Turn},
};

use crate::{
    error::MotionFailure,
    tests::{Program, circle, motion, plane},
    verify::verify,
};

/// INTOL and OUTTOL.
const BAND: [f64; 2] = [0.02, 0.01];
/// Depths of check surfaces under the path, from beside it to where it goes through beyond doubt: farther than all bands together.
const DEPTHS: std::ops::RangeInclusive<i32> = -80..=80;
const DEPTH_STEP: f64 = 0.001;

/// A flat cutter of radius one on z = 0 that goes along a drive surface in the direction of x, to a check surface or past it.
fn along(
    force: bool,
    (from, side): ([f64; 2], DriveSide),
    drive: (Relation, &Geometry),
    (relation, occurrence, stop): (Relation, u32, &Geometry),
) -> Option<f64> {
    let mut p = Program::new();
    p.tolerance(BAND[0], BAND[1]).cutter(&[2.0]).from(from[0], from[1], 0.0);
    p.run(&MotionCommand::ForceIteration(force));
    p.go(&[drive, (Relation::To, &plane(0.0, 0.0, 1.0, 0.0)), (Relation::On, &plane(1.0, 0.0, 0.0, 0.0))]);
    p.side(side).indirv(1.0, 0.0, 0.0);
    match p.cut(&motion(Turn::Forward, drive.1, &[(relation, occurrence, stop)])) {
        Ok(sequence) => {
            let evidence = verify(&sequence, &|| false).expect("evidence");
            assert!(evidence.verified, "{force} {relation:?} {stop:?}: {evidence:?}");
            Some(sequence.points.last()?.tip.x)
        }
        Err(MotionFailure::NeverMet { .. } | MotionFailure::NoneAhead { .. }) => None,
        Err(failure) => panic!("{force} {relation:?} {stop:?}: {failure:?}"),
    }
}

fn depths() -> impl Iterator<Item = f64> {
    DEPTHS.map(|k| DEPTH_STEP * f64::from(k))
}

#[test]
fn past_a_circle_beside_a_line_is_so_beyond_doubt() {
    let sum = 2.0 * (BAND[0] + BAND[1]);
    for (force, relation) in [false, true].into_iter().flat_map(|f| [(f, Relation::To), (f, Relation::Past)])
    {
        for depth in depths() {
            let drive = plane(0.0, 1.0, 0.0, depth - 2.0);
            let end = along(
                force,
                ([0.0, 0.0], DriveSide::On),
                (Relation::On, &drive),
                (relation, 1, &circle(5.0, 0.0, 1.0)),
            );
            let sense = if relation == Relation::Past { 1.0 } else { -1.0 };
            let way = (4.0 - (2.0 - depth).powi(2)).max(0.0).sqrt();
            match end {
                Some(end) => {
                    assert!(depth > -sum && (sense * (end - 5.0) - way).abs() < 0.4, "{depth}: {end}");
                }
                None => assert!(depth < sum, "{depth} {relation:?} {force}"),
            }
        }
    }
}

/// About a circle the vectors run elsewhere in the band of the drive surface: where they may touch a line or be past it, they decide.
#[test]
fn past_a_line_beside_a_circle_is_so_on_the_vectors() {
    let sum = 2.0 * (BAND[0] + BAND[1]);
    for (force, relation) in [false, true].into_iter().flat_map(|f| [(f, Relation::To), (f, Relation::Past)])
    {
        for depth in depths() {
            let end = along(
                force,
                ([0.0, -15.0], DriveSide::Right),
                (Relation::To, &circle(0.0, 0.0, 10.0)),
                (relation, 1, &plane(1.0, 0.0, 0.0, 12.0 - depth)),
            );
            match end {
                Some(end) => assert!(depth > -sum && (end - 11.0 + depth).abs() < sum, "{depth}: {end}"),
                None => assert!(depth < sum, "{depth} {relation:?} {force}"),
            }
        }
    }
}

/// The path comes to the second position on its way back, or a turn later.
#[test]
fn second_positions_beside_a_circle_are_so_on_the_vectors() {
    let mut found = 0;
    for (relation, reach) in [(Relation::To, 12.0), (Relation::On, 11.0)] {
        for depth in depths() {
            for force in [false, true] {
                let end = along(
                    force,
                    ([0.0, -15.0], DriveSide::Right),
                    (Relation::To, &circle(0.0, 0.0, 10.0)),
                    (relation, 2, &plane(1.0, 0.0, 0.0, reach - depth)),
                );
                found += usize::from(end.is_some());
                assert!(end.is_some() || depth < 2.0 * (BAND[0] + BAND[1]), "{depth} {relation:?} {force}");
            }
        }
    }
    assert!(found > 0);
}

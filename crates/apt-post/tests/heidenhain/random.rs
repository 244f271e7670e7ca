//! Random programs, whose tapes the reader follows back to the places of the program.

use std::f64::consts::TAU;

use apt_cldata::text::read_text;
use apt_geometry::Vec3;
use apt_post::{PostOptions, machine, post};
use proptest::prelude::*;

use super::{
    MILL, MILL5,
    reader::{Place, Step, read},
};

/// How far the last decimals may take a place on an arc, of its ends, its centre and its angle.
const ROUNDED: f64 = 3e-3;
const LAST_DECIMAL: f64 = 1e-3;
/// How far a tool may lean out of the plane in which it turns, and by how much of a unit angles with three decimals may turn it.
const ASIDE_DEGREES: f64 = 0.1 + 2e-3;
const TURNED: f64 = 3e-5;
/// A way of the program that is told to go nowhere.
const STAYS: f64 = 6e-4;

/// A statement or some that belong together.
#[derive(Debug, Clone)]
enum Move {
    Straight {
        by: [i32; 3],
        rapid: bool,
    },
    Feed(u32),
    /// So many times the same angle round a centre that is so far in some direction.
    Arc {
        toward: f64,
        radius: f64,
        degrees: f64,
        rise: i32,
        times: u32,
    },
}

fn any_move() -> impl Strategy<Value = Move> {
    let step = || -400_000_i32..400_000;
    prop_oneof![
        3 => (step(), step(), -30_000_i32..30_000, any::<bool>())
            .prop_map(|(x, y, z, rapid)| Move::Straight { by: [x, y, z], rapid }),
        1 => (1_u32..4).prop_map(|feed| Move::Feed(feed * 100)),
        4 => (0.0..TAU, 2.0..60.0_f64, prop_oneof![20.0..350.0_f64, Just(360.0)], any::<bool>(),
              prop_oneof![Just(0), -30_000..30_000_i32], prop_oneof![3 => Just(1_u32), 1 => 2_u32..20])
            .prop_map(|(toward, radius, degrees, back, rise, times)| {
                let degrees = if back { -degrees } else { degrees };
                Move::Arc { toward, radius, degrees, rise, times }
            }),
    ]
}

/// A way of the program.
#[derive(Debug, Clone, Copy)]
struct Way {
    to: [f64; 3],
    feed: Option<f64>,
    /// Centre and signed angle.
    arc: Option<([f64; 2], f64)>,
}

/// The text of a program, and its ways.
fn program(moves: &[Move]) -> (String, Vec<Way>) {
    let mut text = "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/500\nRAPID\nGOTO/0,0,0\n".to_owned();
    let mut ways = Vec::new();
    let (mut here, mut feed) = ([0.0_f64; 3], 500.0);
    for one in moves {
        match one {
            Move::Feed(value) => {
                feed = f64::from(*value);
                text += &format!("FEDRAT/{value}\n");
            }
            Move::Straight { by, rapid } => {
                for axis in 0..3 {
                    here[axis] = as_written(here[axis] + f64::from(by[axis]) / 1e4);
                }
                if *rapid {
                    text += "RAPID\n";
                }
                text += &format!("GOTO/{:.6},{:.6},{:.6}\n", here[0], here[1], here[2]);
                ways.push(Way { to: here, feed: (!rapid).then_some(feed), arc: None });
            }
            Move::Arc { toward, radius, degrees, rise, times } => {
                let center = [here[0] + radius * toward.cos(), here[1] + radius * toward.sin()];
                for _ in 0..*times {
                    let axis = degrees.signum();
                    text += &format!(
                        "MOVARC/{:.9},{:.9},{:.6},0,0,{axis},{radius:.9},ANGLE,{:.9}\n",
                        center[0],
                        center[1],
                        here[2],
                        degrees.abs()
                    );
                    let (sine, cosine) = degrees.to_radians().sin_cos();
                    let (u, v) = (here[0] - center[0], here[1] - center[1]);
                    here = [
                        center[0] + u * cosine - v * sine,
                        center[1] + u * sine + v * cosine,
                        here[2] + f64::from(*rise) / 1e4,
                    ]
                    .map(as_written);
                    text += &format!("GOTO/{:.6},{:.6},{:.6}\n", here[0], here[1], here[2]);
                    ways.push(Way { to: here, feed: Some(feed), arc: Some((center, degrees.to_radians())) });
                }
            }
        }
    }
    (text + "FINI\n", ways)
}

/// A coordinate as the text of a program has it.
fn as_written(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

fn is_near(place: &[f64], to: &[f64], within: f64) -> bool {
    place.iter().zip(to).all(|(a, b)| (a - b).abs() <= within)
}

/// How far an arc may be off its own: its centre is as far from both ends, of which the last decimals turn the line between
/// them, and the centre with it.
fn unsure_of(sweep: f64) -> f64 {
    let chord = (sweep / 2.0).sin().abs();
    if chord < 1e-9 { ROUNDED } else { ROUNDED + LAST_DECIMAL / chord }
}

/// Follows the steps of a tape along the ways of a program.
fn follow(steps: &[Step], ways: &[Way]) -> Result<(), TestCaseError> {
    let mut steps = steps.iter();
    let mut here = [0.0; 3];
    // A helix of the tape, and the angle on it up to where it has been followed.
    let mut helix: Option<(&Step, f64)> = None;
    for way in ways {
        let stays = way.arc.is_none() && (0..3).all(|axis| (way.to[axis] - here[axis]).abs() < STAYS);
        here = way.to;
        if stays {
            continue;
        }
        let (step, done) = match helix.take() {
            Some(waiting) => waiting,
            None => (
                steps
                    .next()
                    .ok_or_else(|| TestCaseError::fail(format!("nothing on the tape for {way:?}")))?,
                0.0,
            ),
        };
        prop_assert_eq!(step.feed, way.feed, "{:?} {:?}", step, way);
        match (way.arc, step.arc) {
            (None, None) => prop_assert!(is_near(&step.end[..3], &way.to, ROUNDED), "{:?} {:?}", step, way),
            (Some((center, sweep)), Some(arc)) => {
                prop_assert!(is_near(&arc.center, &center, unsure_of(sweep)), "{:?} {:?}", step, way);
                let angle = done + sweep;
                prop_assert!(
                    is_near(&step.after(angle)[..3], &way.to, unsure_of(sweep)),
                    "{:?} {:?}",
                    step,
                    way
                );
                let unsure = ROUNDED / (step.start[0] - center[0]).hypot(step.start[1] - center[1]);
                prop_assert!(
                    angle.abs() <= arc.sweep.abs() + unsure && angle * arc.sweep > 0.0,
                    "{:?} {:?}",
                    step,
                    way
                );
                if (angle - arc.sweep).abs() > unsure {
                    helix = Some((step, angle));
                }
            }
            _ => prop_assert!(false, "{:?} {:?}", step, way),
        }
    }
    prop_assert!(helix.is_none());
    prop_assert_eq!(steps.next(), None);
    Ok(())
}

/// Where the angles of many helices lead is off the places of the program by what one of them is.
#[test]
fn the_last_decimals_of_many_helices_do_not_add_up() {
    let helix = |at: u32| Move::Arc {
        toward: f64::from(at) * 0.7,
        radius: 7.0 + f64::from(at % 5),
        degrees: if at.is_multiple_of(3) { -100.0 } else { 130.0 },
        rise: 500,
        times: 1,
    };
    let (text, ways) = program(&(0..300).map(helix).collect::<Vec<Move>>());
    let (records, _) = read_text(&text);
    let tape = post(&records, &machine(MILL).unwrap(), &PostOptions::default());
    assert_eq!(tape.text().matches(" CP ").count(), 300);
    follow(&read(&tape.text()), &ways).unwrap();
}

/// A position of a tool that may lean.
#[derive(Debug, Clone, Copy)]
struct Position {
    rapid: bool,
    tip: Vec3,
    axis: Vec3,
}

fn any_position() -> impl Strategy<Value = Position> {
    let step = || -2_000_000_i32..2_000_000;
    (step(), step(), step(), 0.0..TAU, prop_oneof![Just(0.0), 1.0..60.0_f64], any::<bool>()).prop_map(
        |(x, y, z, round, lean, rapid)| {
            let lean = lean.to_radians();
            let axis = Vec3::new(lean.sin() * round.cos(), lean.sin() * round.sin(), lean.cos());
            Position { rapid, tip: Vec3::new(f64::from(x), f64::from(y), f64::from(z)) / 1e4, axis }
        },
    )
}

/// The tool end of a place of heidenhain-mill5 on the part, and the direction of the tool: tilted by B, then turned by C.
fn on_part([x, y, z, b, c]: Place) -> (Vec3, Vec3) {
    let (b, c) = (b.to_radians(), c.to_radians());
    (Vec3::new(x, y, z), Vec3::new(b.sin() * c.cos(), b.sin() * c.sin(), b.cos()))
}

/// Follows the steps of a tape along positions: each is come to, and between two cuts the tool end stays on its straight way and
/// the tool by its great circle.
fn follow_leaning(steps: &[Step], positions: &[Position]) -> Result<(), TestCaseError> {
    let mut at = 0;
    for step in steps {
        let (tip, axis) = on_part(step.end);
        if let (Some(goal), Some(_)) = (positions.get(at), step.feed) {
            prop_assert!(!goal.rapid && at > 0, "{:?} {:?}", step, goal);
            let start = positions[at - 1];
            let way = goal.tip - start.tip;
            let along = ((tip - start.tip).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
            let off = (tip - start.tip - way * along).norm();
            prop_assert!(off <= ROUNDED, "{} {:?} {:?}", off, step, goal);
            let across = start.axis.cross(&goal.axis);
            if across.norm() > 1e-6 {
                let aside = axis.dot(&across.normalize()).asin().to_degrees();
                prop_assert!(aside.abs() <= ASIDE_DEGREES, "{} {:?} {:?}", aside, step, goal);
            }
        }
        let is_there =
            |goal: &Position| (goal.tip - tip).norm() <= ROUNDED && (goal.axis - axis).norm() <= TURNED;
        while positions.get(at).is_some_and(is_there) {
            at += 1;
        }
    }
    prop_assert_eq!(at, positions.len());
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() })]

    #[test]
    fn a_tape_leads_along_its_program(moves in prop::collection::vec(any_move(), 1..12)) {
        let (text, ways) = program(&moves);
        let (records, errors) = read_text(&text);
        prop_assert!(errors.is_empty(), "{:?}", errors);
        let tape = post(&records, &machine(MILL).unwrap(), &PostOptions::default());
        prop_assert!(tape.is_ok(), "{:?}", tape.findings);
        follow(&read(&tape.text()), &ways).map_err(|error| TestCaseError::fail(format!("{error}\n{text}\n{}", tape.text())))?;
    }

    #[test]
    fn a_tape_leads_a_tool_that_leans_along_its_program(positions in prop::collection::vec(any_position(), 1..8)) {
        let mut positions = positions;
        positions[0].rapid = true;
        let mut text =
            "UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/500\nRAPID\nGOTO/0,0,300,0,0,1\n".to_owned();
        for Position { rapid, tip, axis } in &positions {
            if *rapid {
                text += "RAPID\n";
            }
            text += &format!("GOTO/{:.4},{:.4},{:.4},{:.9},{:.9},{:.9}\n", tip.x, tip.y, tip.z, axis.x, axis.y, axis.z);
        }
        let (records, errors) = read_text(&(text.clone() + "FINI\n"));
        prop_assert!(errors.is_empty(), "{:?}", errors);
        let tape = post(&records, &machine(MILL5).unwrap(), &PostOptions::default());
        prop_assert!(tape.is_ok(), "{:?}", tape.findings);
        follow_leaning(&read(&tape.text()), &positions)
            .map_err(|error| TestCaseError::fail(format!("{error}\n{text}\n{}", tape.text())))?;
    }
}

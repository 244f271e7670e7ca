use std::f64::consts::PI;

use proptest::prelude::*;

use super::*;
use crate::{record::Units, text::read_text};

fn path(text: &str) -> Path {
    let (records, errors) = read_text(text);
    assert_eq!(errors, vec![], "{text}");
    Path::of(&records)
}

fn compared(a: &str, b: &str, distance: f64) -> Vec<Stretch> {
    difference(&path(a), &path(b), distance).stretches
}

fn difference(a: &Path, b: &Path, distance: f64) -> Difference {
    let tolerance = Tolerance { distance, angle: 1e-4 };
    let found = compare([a, b], tolerance, &|| false).expect("nobody gives up");
    let back = compare([b, a], tolerance, &|| false).expect("nobody gives up");
    assert_eq!(found.stretches.is_empty(), back.stretches.is_empty(), "the other way round");
    found
}

/// The distances of the stretches, and their kinds.
fn told(stretches: &[Stretch]) -> Vec<(StretchKind, f64)> {
    let rounded = |value: f64| (value * 1e4).round() / 1e4;
    stretches
        .iter()
        .map(|one| (one.kind, rounded(one.apart.map_or(f64::NAN, |apart| apart.distance))))
        .collect()
}

const SQUARE: &str =
    "FROM/0,0,5\nRAPID\nGOTO/0,0,0\nGOTO/10,0,0\nGOTO/10,10,0\nGOTO/0,10,0\nGOTO/0,0,0\nRAPID\nGOTO/0,0,5\n";

#[test]
fn a_path_divided_otherwise_is_the_same() {
    let divided = "FROM/0,0,5\nRAPID\nGOTO/0,0,2\nRAPID\nGOTO/0,0,0\nGOTO/2,0,0\nGOTO/3,.0004,0\nGOTO/10,0,0\nGOTO/10,10,0\n\
        GODLTA/-4,0,0\nGODLTA/-6,0,0\nGOTO/0,0,0\nRAPID\nGOTO/0,0,5\n";
    assert_eq!(compared(SQUARE, divided, 0.001), vec![]);
    // A tenth of that leaves out nothing but the way around.
    let found = compared(SQUARE, divided, 0.0001);
    assert_eq!(told(&found), vec![(StretchKind::Places, 0.0004)]);
    let [Some(a), Some(b)] = found[0].sides else { panic!("both have places") };
    assert!(
        (a.from.0 - Vec3::new(2.0, 0.0, 0.0)).norm() < 0.3
            && (b.to.0 - Vec3::new(10.0, 0.0, 0.0)).norm() < 2.0,
        "{a:?} {b:?}"
    );
}

#[test]
fn a_stretch_that_differs_is_told_with_its_place() {
    let notched =
        SQUARE.replace("GOTO/10,10,0\n", "GOTO/10,4,0\nGOTO/9,4,0\nGOTO/9,6,0\nGOTO/10,6,0\nGOTO/10,10,0\n");
    let found = compared(SQUARE, &notched, 0.001);
    assert_eq!(told(&found), vec![(StretchKind::Places, 1.0)]);
    let apart = found[0].apart.expect("both have places");
    assert!((apart.at.x - 9.0).abs() < 1e-9, "{:?}", apart.at);
    let [Some(a), Some(b)] = found[0].sides else { panic!("both have places") };
    assert!((a.length - 2.0).abs() < 0.01 && (b.length - 4.0).abs() < 0.01, "{a:?} {b:?}");
    assert!((a.from.0 - Vec3::new(10.0, 4.0, 0.0)).norm() < 0.01, "{a:?}");
    assert!((a.to.0 - Vec3::new(10.0, 6.0, 0.0)).norm() < 0.01, "{a:?}");
}

#[test]
fn what_only_one_path_has_is_told() {
    let longer = format!("{SQUARE}GOTO/0,0,8\n");
    let found = compared(SQUARE, &longer, 0.001);
    assert_eq!(told(&found), vec![(StretchKind::Places, 3.0)]);
    let [Some(a), Some(b)] = found[0].sides else { panic!("both have places") };
    assert_eq!((a.length, b.length), (0.0, 3.0));
    // A path without any place is different as a whole.
    let found = compared("FINI\n", SQUARE, 0.001);
    assert_eq!((found.len(), found[0].sides[0], found[0].apart), (1, None, None));
    assert_eq!(compared("FINI\n", "PPRINT NOTHING\n", 0.001), vec![]);
    assert_eq!(compared("FROM/1,2,3\n", "FROM/1,2,3\n", 0.001), vec![]);
    assert_eq!(told(&compared("FROM/1,2,3\n", "FROM/1,2,4\n", 0.001)), vec![(StretchKind::Places, 1.0)]);
}

#[test]
fn rapid_and_feed_are_two_manners() {
    let fed = SQUARE.replacen("RAPID\nGOTO/0,0,0", "GOTO/0,0,0", 1);
    let found = compared(SQUARE, &fed, 0.001);
    assert_eq!(told(&found), vec![(StretchKind::Manner, 0.0)]);
    let [Some(a), Some(b)] = found[0].sides else { panic!("both have places") };
    assert_eq!((a.rapid, b.rapid), (5.0, 0.0));
    // Where the manner changes a little earlier, but within the tolerance, the paths are the same.
    let earlier = SQUARE.replacen("GOTO/0,0,0\nGOTO/10", "GOTO/0,0,.0005\nGOTO/0,0,0\nGOTO/10", 1);
    assert_eq!(compared(SQUARE, &earlier, 0.001), vec![]);
}

#[test]
fn the_other_way_round_is_another_order() {
    let turned = "FROM/0,0,5\nRAPID\nGOTO/0,0,0\nGOTO/0,10,0\nGOTO/10,10,0\nGOTO/10,0,0\nGOTO/0,0,0\nRAPID\nGOTO/0,0,5\n";
    assert_eq!(told(&compared(SQUARE, turned, 0.001)), vec![(StretchKind::Order, 0.0)]);
    let twice = SQUARE.replace("GOTO/10,10,0\n", "GOTO/10,10,0\nGOTO/10,0,0\nGOTO/10,10,0\n");
    // One tool waits in the corner, while the other one goes back and comes again.
    assert_eq!(told(&compared(SQUARE, &twice, 0.001)), vec![(StretchKind::Places, 10.0)]);
}

#[test]
fn axes_are_compared() {
    let five_axis =
        |tilt: &str| format!("MULTAX/ON\nFROM/0,0,0,0,0,1\nGOTO/10,0,0,{tilt}\nGOTO/20,0,0,0,0,1\n");
    let found = compared(&five_axis("0,0,1"), &five_axis("0,.6,.8"), 0.001);
    assert_eq!(told(&found), vec![(StretchKind::Axes, 0.0)]);
    assert!((found[0].apart.expect("places").turned - 0.6_f64.asin()).abs() < 1e-9);
    // Axes that turn evenly do so in the middle of a vector, too.
    let halved = "MULTAX/ON\nFROM/0,0,0,0,0,1\nGOTO/5,0,0,0,.316227766,.948683298\nGOTO/10,0,0,0,.6,.8\nGOTO/20,0,0,0,0,1\n";
    assert_eq!(compared(&five_axis("0,.6,.8"), halved, 0.001).len(), 0);
}

#[test]
fn zigzags_with_other_passes_differ_all_over() {
    let zigzag = |step: f64, passes: usize| {
        let mut text = "FROM/0,0,0\n".to_owned();
        for pass in 0..passes {
            let [from, to] = if pass % 2 == 0 { [0.0, 10.0] } else { [10.0, 0.0] };
            let y = step * pass as f64;
            text.push_str(&format!("GOTO/{from:?},{y:?},0\nGOTO/{to:?},{y:?},0\n"));
        }
        text
    };
    let found = compared(&zigzag(1.0, 11), &zigzag(2.0, 6), 0.01);
    assert!(!found.is_empty());
    assert!(found.iter().all(|one| one.kind == StretchKind::Places), "{:?}", told(&found));
    let farthest = found.iter().filter_map(|one| one.apart).map(|apart| apart.distance).fold(0.0, f64::max);
    assert!((0.99..=1.01).contains(&farthest), "{farthest}");
    assert_eq!(compared(&zigzag(1.0, 11), &zigzag(1.0, 11), 0.01), vec![]);
}

#[test]
fn units_are_made_alike() {
    let inches = path("UNITS/INCHES\nFROM/0,0,0\nGOTO/1,2,3\n");
    let metric = path("UNITS/MM\nFROM/0,0,0\nGOTO/25.4,50.8,76.2\n").in_units(inches.units);
    assert_eq!(metric.units, Some(Units::Inches));
    assert!((metric.length() - inches.length()).abs() < 1e-12);
    assert_eq!(difference(&inches, &metric, 1e-9).stretches, vec![]);
    // Nothing is made of a path whose unit nobody knows.
    assert_eq!(path("FROM/0,0,0\nGOTO/1,2,3\n").in_units(Some(Units::Inches)).length(), 14.0_f64.sqrt());
}

#[test]
fn who_gives_up_gets_no_answer() {
    let [a, b] = [path(SQUARE), path(&SQUARE.replace("10,10", "9,9"))];
    let tolerance = Tolerance::of([&a, &b]);
    assert!((tolerance.distance - 15.0e-6).abs() < 1e-9);
    assert_eq!(compare([&a, &b], tolerance, &|| true), None);
}

/// The work grows as the paths do: each vector of one is held against a few of the other.
#[test]
fn long_paths_are_compared_in_little_work() {
    let circle = |vectors: usize, wobble: f64| {
        let mut text = String::new();
        for at in 0..=vectors {
            let angle = 20.0 * PI * at as f64 / vectors as f64;
            let radius = 10.0 + wobble * (7.0 * angle).sin();
            text.push_str(&format!(
                "GOTO/{:?},{:?},{:?}\n",
                radius * angle.cos(),
                radius * angle.sin(),
                angle / 100.0
            ));
        }
        path(&text)
    };
    let asked = std::cell::Cell::new(0_usize);
    let count = || {
        asked.set(asked.get() + 1);
        false
    };
    let tolerance = Tolerance { distance: 0.001, angle: 1e-3 };
    let found = compare([&circle(20_000, 0.0), &circle(30_000, 0.0)], tolerance, &count).expect("an answer");
    assert_eq!(found.stretches, vec![]);
    assert!(asked.get() <= 20_001, "{}", asked.get());
    asked.set(0);
    let found = compare([&circle(4_000, 0.0), &circle(6_000, 0.01)], tolerance, &count).expect("an answer");
    assert!(found.stretches.len() > 100);
    assert!(asked.get() <= 40_000, "{}", asked.get());
}

/// The greatest distance between neighbouring places of [`densely`].
const SPACING: f64 = 0.05;

/// The places of a path, and others between them.
fn densely(path: &Path) -> Vec<Vec3> {
    let mut dense = vec![path.places[0].position];
    for pair in path.places.windows(2) {
        let along = pair[1].position - pair[0].position;
        let count = (along.norm() / SPACING).ceil().max(1.0);
        dense.extend((1..=count as u32).map(|step| pair[0].position + along * (f64::from(step) / count)));
    }
    dense
}

/// The Fréchet distance of two rows of places, by the table of all pairs.
fn discrete_frechet(a: &[Vec3], b: &[Vec3]) -> f64 {
    let mut row: Vec<f64> = Vec::new();
    for (i, here) in a.iter().enumerate() {
        let mut next: Vec<f64> = Vec::with_capacity(b.len());
        for (j, there) in b.iter().enumerate() {
            let before = match (i, j) {
                (0, 0) => 0.0,
                (0, _) => next[j - 1],
                (_, 0) => row[0],
                _ => row[j - 1].min(row[j]).min(next[j - 1]),
            };
            next.push(before.max((here - there).norm()));
        }
        row = next;
    }
    row.last().copied().unwrap_or_default()
}

fn chains() -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec([-10.0..10.0, -10.0..10.0, -1.0..1.0], 2..20)
}

fn text_of(chain: &[[f64; 3]]) -> String {
    chain.iter().map(|[x, y, z]| format!("GOTO/{x:?},{y:?},{z:?}\n")).collect()
}

proptest! {
    /// However vectors are divided, and whatever is moved by less than the tolerance, the path is the same.
    #[test]
    fn dividing_and_rounding_make_no_difference(
        chain in chains(),
        cuts in prop::collection::vec((0usize..19, 0.01..0.99), 0..10),
        by in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        let mut divided: Vec<[f64; 3]> = Vec::new();
        for (at, place) in chain.iter().enumerate() {
            if let Some(last) = at.checked_sub(1).map(|before| chain[before]) {
                let mut here: Vec<f64> = cuts.iter().filter(|cut| cut.0 == at).map(|cut| cut.1).collect();
                here.sort_by(f64::total_cmp);
                divided.extend(here.iter().map(|part| [0, 1, 2].map(|k| last[k] + (place[k] - last[k]) * part)));
            }
            divided.push(*place);
        }
        let moved: Vec<[f64; 3]> =
            divided.iter().map(|place| [0, 1, 2].map(|k| place[k] + 0.005 * by[k])).collect();
        let [a, b, c] = [&chain, &divided, &moved].map(|chain| path(&text_of(chain)));
        prop_assert_eq!(difference(&a, &b, 1e-9).stretches, vec![]);
        prop_assert_eq!(difference(&a, &c, 0.01).stretches, vec![]);
    }

    /// Two paths are the same from their Fréchet distance on, which places close together tell to what is between them.
    #[test]
    fn paths_are_the_same_from_their_frechet_distance_on(
        chain in prop::collection::vec([-3.0..3.0, -3.0..3.0, -1.0..1.0], 2..6),
        by in prop::collection::vec([-1.0..1.0, -1.0..1.0, -1.0..1.0], 2..6),
    ) {
        let other: Vec<[f64; 3]> =
            by.iter().enumerate().map(|(at, by)| [0, 1, 2].map(|k| chain[at % chain.len()][k] + by[k])).collect();
        let [a, b] = [&chain, &other].map(|chain| path(&text_of(chain)));
        let [dense_a, dense_b] = [&a, &b].map(densely);
        let between = 2.0 * SPACING;
        let frechet = discrete_frechet(&dense_a, &dense_b);
        prop_assert_eq!(difference(&a, &b, frechet + between).stretches, vec![]);
        if frechet > 2.0 * between {
            prop_assert_ne!(difference(&a, &b, frechet - between).stretches, vec![]);
        }
    }

    /// A place that is moved away by more than the tolerance is told, as far as it was moved.
    #[test]
    fn what_is_moved_is_told(chain in chains(), at in 0usize..20, by in 0.2_f64..3.0) {
        let mut moved = chain.clone();
        let at = at % chain.len();
        moved[at][2] += 2.0 + by;
        let [a, b] = [&chain, &moved].map(|chain| path(&text_of(chain)));
        let found = difference(&a, &b, 0.001).stretches;
        let farthest = found.iter().filter_map(|one| one.apart).map(|apart| apart.distance).fold(0.0, f64::max);
        prop_assert!(farthest > by * 0.99 && farthest <= (2.0 + by) * 1.01, "{} for {}", farthest, by);
    }
}

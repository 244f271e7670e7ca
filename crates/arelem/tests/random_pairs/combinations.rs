//! Every kind of surface in every role, with every relation, THICK on each role, and every shape of tool: for each
//! combination a motion is drawn that has a path, and it is delivered and proven.
//!
//! The test command leaves the surfaces to which distances are searched for to `curved_pairs`; `APT_CASES` takes them in.

use std::{fmt::Write as _, time::Instant};

use apt_geometry::motion::{DriveSide, Relation};

use crate::{
    case::{Case, Wish},
    judge::{Verdict, judge},
    kinds::Kind,
    number,
};

/// Motions drawn of one combination at most until one is proven.
const DRAWS: u64 = 12;
/// No stock, stock that is left, and a cut beyond the surface.
const STOCK: [f64; 3] = [0.0, 0.07, -0.03];
/// Shapes of tools by their names; the last two have no width.
const SHAPES: [&str; 10] =
    ["ball", "flat", "bull nose", "barrel", "tapered", "bell", "lens", "drill", "line", "needle"];

/// What is combined.
struct Row {
    name: String,
    part: Kind,
    drive: Kind,
    wish: Wish,
}

impl Row {
    /// Distances to one of the surfaces are searched for.
    fn is_slow(&self) -> bool {
        let others = [self.wish.stop.map(|stop| stop.0), self.wish.first.map(|first| first.0)];
        [Some(self.part), Some(self.drive)].into_iter().chain(others).flatten().any(Kind::is_slow)
    }
}

/// Judges motions of a row until one is proven. What is delivered must be proven, and what is refused must have no path.
fn settle(row: &Row, number: u64, refusals: &mut Vec<String>, faults: &mut String) {
    let mut refused = Vec::new();
    for draw in 0..DRAWS {
        // Seeds that follow one another by the generator's own step would draw the same motions.
        let seed = (number * DRAWS + draw + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let Some(case) = Case::wished(row.part, row.drive, &row.wish, seed) else { continue };
        match judge(&case).0 {
            Verdict::Proven(_) => {
                if !refused.is_empty() {
                    refusals.push(format!("{}: {refused:?}", row.name));
                }
                return;
            }
            Verdict::Refused(words) | Verdict::NotJudged(words) => refused.push(words),
            fault => {
                let _ = writeln!(faults, "{}, draw {draw}, {}: {fault:?}", row.name, case.shape);
            }
        }
    }
    let _ = writeln!(faults, "{}: none is proven, rightly refused are {refused:?}", row.name);
}

#[expect(clippy::print_stdout, reason = "the table tells what was refused on the way")]
fn all_are_proven(rows: &[Row]) {
    let (mut faults, mut refusals) = (String::new(), Vec::new());
    let all = number("APT_CASES").is_some();
    let mut run = 0;
    for (number, row) in (0..).zip(rows).filter(|(_, row)| all || !row.is_slow()) {
        let began = Instant::now();
        settle(row, number, &mut refusals, &mut faults);
        run += 1;
        if all {
            println!("{} {:.1} s", row.name, began.elapsed().as_secs_f64());
        }
    }
    println!("{run} combinations; rightly refused on the way were\n{}", refusals.join("\n"));
    assert!(faults.is_empty(), "\n{faults}");
}

fn each_kind(mut rows: impl FnMut(Kind) -> Vec<Row>) -> Vec<Row> {
    Kind::ALL.into_iter().flat_map(&mut rows).collect()
}

#[test]
fn part_surfaces_of_every_kind_held_to_and_on_with_stock() {
    let of = |kind: Kind, on: bool, stock: f64| Row {
        name: format!("part {} {} thick {stock}", kind.name(), if on { "TLONPS" } else { "TLOFPS" }),
        part: kind,
        drive: Kind::Plane,
        wish: Wish { part_on: Some(on), thickness: Some([stock, 0.0, 0.0]), ..Wish::wide() },
    };
    all_are_proven(&each_kind(|kind| {
        STOCK.map(|stock| of(kind, false, stock)).into_iter().chain([of(kind, true, STOCK[1])]).collect()
    }));
}

#[test]
fn drive_surfaces_of_every_kind_on_each_side_and_on_with_stock() {
    let of = |kind: Kind, side: DriveSide, stock: f64| Row {
        name: format!("drive {} {side:?} thick {stock}", kind.name()),
        part: Kind::Plane,
        drive: kind,
        wish: Wish { drive: Some(side), thickness: Some([0.0, stock, 0.0]), ..Wish::wide() },
    };
    all_are_proven(&each_kind(|kind| {
        let sides = [DriveSide::Left, DriveSide::Right].into_iter();
        sides
            .flat_map(|side| STOCK.map(|stock| of(kind, side, stock)))
            .chain([of(kind, DriveSide::On, STOCK[1])])
            .collect()
    }));
}

#[test]
fn check_surfaces_of_every_kind_with_every_relation_count_and_stock() {
    let of = |kind: Kind, relation: Relation, count: u32, stock: f64| Row {
        name: format!("check {} {relation:?} {count} thick {stock}", kind.name()),
        part: Kind::Plane,
        drive: Kind::Sphere,
        wish: Wish {
            stop: Some((kind, relation, count)),
            thickness: Some([0.0, 0.0, stock]),
            part_on: Some(false),
            ..Wish::wide()
        },
    };
    all_are_proven(&each_kind(|kind| {
        let mut rows = vec![of(kind, Relation::On, 1, STOCK[1])];
        for relation in [Relation::To, Relation::Past] {
            rows.extend(STOCK.map(|stock| of(kind, relation, 1, stock)));
        }
        rows.extend([Relation::To, Relation::On, Relation::Past].map(|relation| of(kind, relation, 2, 0.0)));
        rows.push(of(kind, Relation::TangentToDrive, 1, 0.0));
        // A plane is nowhere tangent to the plane that the part surface is.
        rows.extend((kind != Kind::Plane).then(|| of(kind, Relation::TangentToPart, 1, 0.0)));
        rows
    }));
}

#[test]
fn start_ups_with_every_kind_in_each_place_and_every_relation() {
    let third = |kind: Kind, relation: Relation, stock: f64| Row {
        name: format!("third of a start-up {} {relation:?} thick {stock}", kind.name()),
        part: Kind::Plane,
        drive: Kind::Plane,
        wish: Wish {
            first: Some((kind, relation)),
            thickness: Some([0.0, 0.0, stock]),
            surfaces: Some(3),
            ..Wish::wide()
        },
    };
    let first = |kind: Kind, surfaces: usize, side: DriveSide, passes: bool| Row {
        name: format!("start-up with {surfaces}, {} {side:?}, past {passes}", kind.name()),
        part: Kind::Plane,
        drive: kind,
        wish: Wish {
            drive: Some(side),
            surfaces: Some(surfaces),
            passes_drive: Some(passes),
            ..Wish::wide()
        },
    };
    all_are_proven(&each_kind(|kind| {
        let mut rows = vec![third(kind, Relation::On, 0.0)];
        for relation in [Relation::To, Relation::Past] {
            rows.extend([0.0, STOCK[1]].map(|stock| third(kind, relation, stock)));
        }
        for surfaces in [1, 2] {
            rows.push(first(kind, surfaces, DriveSide::On, false));
            rows.extend([false, true].map(|passes| first(kind, surfaces, DriveSide::Left, passes)));
        }
        rows
    }));
}

#[test]
fn tools_of_every_shape_on_every_kind_of_part_and_drive_surface() {
    let of = |shape: &'static str, part: Kind, drive: Kind| Row {
        name: format!("{shape} on {} along {}", part.name(), drive.name()),
        part,
        drive,
        wish: Wish { shape: Some(shape), ..Wish::default() },
    };
    all_are_proven(&each_kind(|kind| {
        let shapes = SHAPES.into_iter();
        shapes.flat_map(|shape| [of(shape, kind, Kind::Plane), of(shape, Kind::Plane, kind)]).collect()
    }));
}

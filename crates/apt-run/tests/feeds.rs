//! FEDRAT with a distance: what stands on the CL file before and after check surfaces (language reference 8.3).

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::sync::Arc;

use apt_cldata::record::{ClKind, ClWord};
use apt_run::{document::Document, settings::Settings};

/// Feed rates and the places of the tool end, in their order; the circles are left out.
#[derive(Debug, PartialEq)]
enum Item {
    Feed(Vec<f64>),
    At(f64, f64),
}
use Item::{At, Feed};

/// A tool below the x axis on its way along it, a line across it at 9, and one above at 8.
const SQUARE: &str =
    "CUTTER/1\nLX=LINE/XAXIS\nLY=LINE/9,0,9,1\nLZ=LINE/0,8,1,8\nFROM/0,-3,0\nGO/LX\nINDIRV/1,0,0\n";

/// What the statements behind the start leave on the CL file.
fn path(before: &str, statements: &str) -> Vec<Item> {
    let text = format!("{before}{statements}FINI\n");
    let settings = Settings { dialect: Some("apt3".to_owned()), ..Settings::default() };
    let document = Document::new(&text, Some("feeds.apt".to_owned()), &Arc::new(settings));
    let run = document.run(&|| false, &mut |_, _| {}).unwrap();
    let begin = before.lines().count() as u32;
    let mut items = Vec::new();
    for record in run.records.iter().filter(|record| record.isn > begin) {
        match &record.kind {
            ClKind::Postprocessor { arguments, .. } => items.push(Feed(
                arguments
                    .iter()
                    .filter_map(|word| if let ClWord::Number(n) = word { Some(*n) } else { None })
                    .collect(),
            )),
            ClKind::Motion { points, .. } => {
                let round = |x: f64| (x * 1e6).round() / 1e6;
                items.extend(points.iter().map(|at| At(round(at.position.x), round(at.position.y))));
            }
            _ => {}
        }
    }
    items
}

#[test]
fn every_check_surface_has_its_slower_end() {
    let found = path(SQUARE, "FEDRAT/20,2,5\nTLRGT,GOFWD/LX,PAST,LY\nGOLFT/LY,PAST,LZ\n");
    let feed = |feed| Feed(vec![feed]);
    assert_eq!(
        found,
        [
            feed(20.0),
            At(7.5, -0.5),
            feed(5.0),
            At(9.5, -0.5),
            feed(20.0),
            At(9.5, 6.5),
            feed(5.0),
            At(9.5, 8.5),
            feed(20.0)
        ]
    );
}

#[test]
fn two_numbers_are_for_the_next_check_surface() {
    let found =
        path(SQUARE, "FEDRAT/20\nFEDRAT/2,5\nGOTO/1,-.5,0\nTLRGT,GOFWD/LX,PAST,LY\nGOLFT/LY,PAST,LZ\n");
    let feed = |feed| Feed(vec![feed]);
    assert_eq!(
        found,
        [feed(20.0), At(1.0, -0.5), At(7.5, -0.5), feed(5.0), At(9.5, -0.5), feed(20.0), At(9.5, 8.5)]
    );
}

#[test]
fn a_new_basic_feed_ends_the_reduction() {
    let motions = "TLRGT,GOFWD/LX,PAST,LY,33\nGOLFT/LY,PAST,LZ\n";
    let found = path(SQUARE, &format!("FEDRAT/20,2,5\n{motions}"));
    assert_eq!(found, [Feed(vec![20.0]), Feed(vec![33.0]), At(9.5, -0.5), At(9.5, 8.5)]);
    let found = path(SQUARE, "FEDRAT/20,2,5\nFEDRAT/30,IPM\nTLRGT,GOFWD/LX,PAST,LY\n");
    assert_eq!(found, [Feed(vec![20.0]), Feed(vec![30.0]), At(9.5, -0.5)]);
}

#[test]
fn a_motion_that_is_shorter_is_slow_as_a_whole() {
    let motions = "TLRGT,GOFWD/LX,PAST,LY\n";
    let slow = [Feed(vec![20.0]), Feed(vec![5.0]), At(9.5, -0.5), Feed(vec![20.0])];
    for distance in ["9.5", "50"] {
        assert_eq!(path(SQUARE, &format!("FEDRAT/20,{distance},5\n{motions}")), slow, "{distance}");
    }
    // Without output there are no feed rates either, and without a basic one there is nothing to go back to.
    assert_eq!(path(SQUARE, &format!("DNTCUT\nFEDRAT/2,5\n{motions}")), []);
    let found = path(SQUARE, &format!("FEDRAT/2,5\n{motions}"));
    assert_eq!(found, [At(7.5, -0.5), Feed(vec![5.0]), At(9.5, -0.5)]);
}

/// Where the path bends the distance is that along it, and the place where the feed changes is on the arc.
#[test]
fn around_a_circle_the_place_is_on_the_arc() {
    let start =
        "CUTTER/1\nC=CIRCLE/0,0,5\nLY=LINE/YAXIS\nFROM/9,0,0\nGO/TO,C,(PLANE/0,0,1,0)\nINDIRV/0,1,0\n";
    let found = path(start, "FEDRAT/20,2,5\nTLRGT,GOFWD/C,ON,LY\n");
    let places: Vec<_> =
        found.iter().filter_map(|item| if let At(x, y) = item { Some((*x, *y)) } else { None }).collect();
    let change = found.iter().rposition(|item| *item == Feed(vec![5.0])).unwrap();
    let (At(x, y), At(u, w)) = (&found[change - 1], &found[change - 2]) else { panic!("{found:?}") };
    assert!((x.hypot(*y) - u.hypot(*w)).abs() < 2e-6, "{x}, {y} is not as far out as {u}, {w}");
    let rest = 5.5 * x.atan2(*y);
    assert!((rest - 2.0).abs() < 1e-3, "{rest} before the end");
    let (x, y) = places.last().unwrap();
    assert!(x.abs() < 1e-5 && (y - 5.5).abs() < 1e-3, "{x}, {y}");
}

//! POCKET with everything that can be wrong with it: each mistake has its number (language reference 9.3).

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::sync::Arc;

use apt_run::{
    document::{Document, Level},
    settings::Settings,
};

const SQUARE: &str = "0,0,0,4,0,0,4,4,0,0,4,0";

/// The numbers that a pocket with a cutter, its eight numbers and its points is given.
fn numbers(before: &str, cutter: &str, numbers: &str, points: &str) -> Vec<Option<u16>> {
    let text = format!("{before}CUTTER/{cutter}\nFROM/0,0,1\nPOCKET/{numbers},{points}\nFINI\n");
    let document = Document::new(&text, Some("pocket.apt".to_owned()), &Arc::new(Settings::default()));
    let found = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    found.iter().map(|one| one.wording.apt3).collect()
}

#[test]
fn every_mistake_of_a_pocket_has_its_number() {
    const GOOD: &str = ".2,1,.5,10,20,20,0,0";
    let square = |wanted: &str| numbers("", ".5", wanted, SQUARE);
    assert_eq!(square(GOOD), []);
    assert_eq!(square("-.2,1,.5,10,20,20,0,0"), [Some(3511)]);
    assert_eq!(square(".2,-1,.5,10,20,20,0,0"), [Some(3512)]);
    assert_eq!(square(".2,1,-.5,10,20,20,0,0"), [Some(3513)]);
    for feeds in ["-10,20,20", "10,-20,20", "10,20,-20"] {
        assert_eq!(square(&format!(".2,1,.5,{feeds},0,0")), [Some(3514)], "{feeds}");
    }
    assert_eq!(square(".2,1,.5,10,20,20,2,0"), [Some(3515)]);
    assert_eq!(square(".2,1,.5,10,20,20,0,5"), [Some(3516)]);
    let figure = |points: &str| numbers("", ".5", GOOD, points);
    assert_eq!(figure("0,0,0,4,0,0,4,0,0,4,4,0,0,4,0"), [Some(3501)], "a point twice");
    assert_eq!(figure("0,0,0,4,0,0,0,0,0,0,4,0"), [Some(3501)], "there and back again");
    assert_eq!(figure("0,0,0,2,0,0,4,0,0,4,4,0,0,4,0"), [Some(3502)], "a point on a side");
    assert_eq!(figure("0,0,0,4,0,0,4,4,1,0,4,0"), [Some(3503)], "not in a plane");
    assert_eq!(figure("0,0,0,4,0,0,1,1,0,0,4,0"), [Some(3504)], "an inward corner");
    assert_eq!(figure("0,0,0,4,0,0"), [Some(377)], "two points");
    assert_eq!(numbers("", "0", GOOD, SQUARE), [Some(3510)]);
    assert_eq!(numbers("", "9", ".2,1,.5,10,20,20,0,1", SQUARE), [Some(3518)]);
    assert_eq!(numbers("MULTAX\nTLAXIS/1,0,.1\n", ".5", GOOD, SQUARE), [Some(3507)]);
    let sphere = "SP=SPHERE/0,0,0,9\nPSIS/SP\n";
    assert_eq!(numbers(sphere, ".5", ".2,1,.5,10,20,20,0,2", SQUARE), [Some(3519)]);
}

#[test]
fn an_island_is_no_part_of_the_statement() {
    // A second figure would be more points: then the whole is no convex figure, and nothing is cut.
    let points = format!("{SQUARE},1,1,0,2,1,0,2,2,0,1,2,0");
    let found = numbers("", ".5", ".2,1,.5,10,20,20,0,0", &points);
    assert_eq!(found.first(), Some(&Some(3504)), "{found:?}");
}

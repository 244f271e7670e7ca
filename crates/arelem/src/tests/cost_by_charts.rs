//! What a cut vector takes over surfaces with charts, counted in the questions that its proofs ask: what takes little is asked first, and what has
//! been told once is not asked again.

use std::{cell::Cell, thread::LocalKey};

use super::*;
use crate::{
    clearance::{CERTIFIED, CONTACTS_ASKED, LOOKS, PARTS_ASKED, STEADY_ASKED},
    verify::tests::lofts,
};

/// A corner that touches neither of its slanted lines, a bull nose and a ball.
const SEVEN_NUMBERS: &[f64] = &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0];
const BULL_NOSE: &[f64] = &[0.5, 0.1];
const BALL: &[f64] = &[0.5, 0.25];

/// Asks counted in a pass in the plane y = .4 over a part surface, for each cut vector.
fn each(part: &Geometry, cutter: &[f64], counter: &'static LocalKey<Cell<u64>>) -> f64 {
    let (drive, end) = (plane(0.0, 1.0, 0.0, 0.4), plane(1.0, 0.0, 0.0, 1.2));
    let mut p = Program::new();
    p.tolerance(0.0, 1e-5).cutter(cutter);
    p.run(&MotionCommand::MaximumPoints(100_000));
    p.from(-1.5, 0.4, 6.0);
    p.go(&[(Relation::On, &drive), (Relation::To, part), (Relation::On, &plane(1.0, 0.0, 0.0, -1.2))]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::On);
    let check = CheckSurface { relation: Relation::On, occurrence: 1, surface: named(&end), label: None };
    let before = counter.get();
    p.run(&MotionCommand::Drive { turn: Turn::Forward, drive: named(&drive), checks: vec![check] });
    let vectors = p.last().points.len();
    assert!(vectors > 50, "{vectors} vectors");
    (counter.get() - before) as f64 / vectors as f64
}

/// The most asks counted for each cut vector over a ruled and over a polyconic surface, with each of some cutters.
fn most(cutters: &[&[f64]], counter: &'static LocalKey<Cell<u64>>) -> f64 {
    let parts = [lofts::roof(), lofts::vault()];
    let all = parts.iter().flat_map(|part| cutters.iter().map(|cutter| each(part, cutter, counter)));
    all.fold(0.0, f64::max)
}

/// Where a path begins to bend the other way a clearance keeps its chord, which the contacts at its ends show: some hundred parts of the surface need
/// not be looked at.
#[test]
fn parts_are_hardly_asked_where_contacts_tell() {
    let asked = most(&[SEVEN_NUMBERS], &PARTS_ASKED);
    assert!(asked <= 0.03, "{asked} questions a vector");
}

/// Where a vector goes from limit to limit of the band its contacts tell nothing of its halves: that is found out once, not for each of them.
#[test]
fn contacts_are_not_asked_again_where_they_tell_nothing() {
    let asked = most(&[SEVEN_NUMBERS, BULL_NOSE, BALL], &CONTACTS_ASKED);
    assert!(asked <= 2.0, "{asked} questions a vector");
}

/// One bound serves all pieces of a vector that are in the ball which tells it.
#[test]
fn a_steady_ball_is_asked_about_vectors_not_about_their_pieces() {
    let asked = most(&[SEVEN_NUMBERS, BULL_NOSE, BALL], &STEADY_ASKED);
    assert!(asked <= 4.0, "{asked} questions a vector");
}

/// A contact that was proven where a vector was led to need not be proven for that vector.
#[test]
fn ends_of_vectors_are_proven_once() {
    let proven = most(&[SEVEN_NUMBERS, BULL_NOSE, BALL], &CERTIFIED);
    assert!(proven <= 0.3, "{proven} proofs a vector");
}

/// What few parts of the surface did not show is gone on with, not begun anew.
#[test]
fn an_end_of_the_tool_is_shown_to_be_far_at_one_go() {
    let looks = most(&[SEVEN_NUMBERS], &LOOKS);
    assert!(looks <= 32.0, "{looks} places a vector");
}

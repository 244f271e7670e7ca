//! Contact from the last one near by against the search that looks everywhere.

use std::sync::Arc;

use apt_geometry::canonical::{Interval, TabulatedCylinder};

use super::*;
use crate::{
    clearance::{
        Face,
        certify::{self, Effort, JUDGED, Proof},
        floor::Bases,
        search,
    },
    tests::{cylinder, sheets::ruled},
    verify::tests::{BARRELS, lofts},
};

/// A wave of three cubics along a direction, its joints without corners.
fn wave(axes: [Vec3; 3]) -> Geometry {
    let row = |u: f64, a: f64, b: f64| Interval { u, v: 0.0, a, b, length: 0.0, maximum: 0.0, minimum: 0.0 };
    Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes,
        kind: 0.0,
        intervals: vec![row(-3.0, 0.0, -0.2), row(-1.0, 0.0, 0.2), row(1.0, 0.0, -0.2)],
        last: [3.0, 0.0],
    }))
}

fn charted() -> Vec<Geometry> {
    vec![
        wave([Vec3::x(), Vec3::z(), -Vec3::y()]),
        wave([v(1.0, 0.3, 0.0).normalize(), Vec3::z(), v(0.3, -1.0, 0.0).normalize()]),
        lofts::roof(),
        lofts::vault(),
    ]
}

/// A lens, over which contact wanders on its arc.
const LENS: [f64; 7] = [0.5, 0.6, -0.02, 0.595, 0.0, 0.0, 2.0];

/// The side of a surface that its upper side is.
fn upper(surface: &Surface) -> f64 {
    surface.foot(&v(0.0, 0.0, 9.0)).distance.signum()
}

/// What a gauge that remembers finds on a pass over a surface, and one that does not.
fn pass(geometry: &Geometry, on: bool, tool: &Tool, from: &Vec3, step: &Vec3, count: u32) -> (u32, u32) {
    let surface = Surface::from_geometry(geometry).expect("surface");
    let side = upper(&surface);
    let known = Gauge { on, ..gauge(geometry, side) };
    let (mut proven, mut seen) = (0, 0);
    for k in 0..count {
        let mut tip = from + step * f64::from(k);
        // Down to the surface, so that contact is near.
        tip.z -= known.contact(tool, &tip).clearance * 0.99;
        let (found, missed) = known.contact_within(tool, &tip, Enough::ALL);
        let fresh = Gauge { on, ..gauge(geometry, side) }.contact(tool, &tip);
        let size = 1e-8 * (tool.radius() + tool.profile.top.height);
        assert!(
            (found.clearance - fresh.clearance).abs() <= size,
            "{} near the last contact, {} everywhere, at {tip}",
            found.clearance,
            fresh.clearance
        );
        let gap = (found.tool - found.surface).dot(&found.gradient);
        assert!((gap - found.clearance).abs() < 1e-9, "gap {gap}");
        seen += 1;
        proven += u32::from(missed < 1e-10);
    }
    (proven, seen)
}

#[test]
fn passes_over_sheets_find_what_a_complete_search_finds() {
    // With the tenths of the positions that are to be proven without a search: less where a flat tool jumps from one side of its
    // edge to the other, none where a tool is so large that the surface turns away or ends beside it.
    let cutters: [(&[f64], u32); 8] = [
        (&[0.5, 0.25], 7),
        (&[0.5, 0.1], 7),
        (&[0.6], 4),
        (&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0], 7),
        (&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0], 0),
        (&LENS, 7),
        (&BARRELS[0], 0),
        (&BARRELS[1], 0),
    ];
    let mut few = Vec::new();
    for (which, geometry) in charted().iter().enumerate() {
        for (numbers, tenths) in cutters {
            for axis in [Vec3::z(), v(0.2, -0.1, 1.0).normalize()] {
                let cutter = Cutter::from_numbers(numbers, 1.0).expect("cutter");
                let tool = Tool::new(cutter, axis);
                let (proven, seen) =
                    pass(geometry, false, &tool, &v(-1.1, 0.3, 4.0), &v(0.011, 0.002, 0.0), 200);
                if proven * 10 < seen * tenths {
                    few.push(format!("{which} {numbers:?} {} {proven} of {seen}", axis.z));
                }
            }
        }
    }
    assert!(few.is_empty(), "{few:#?}");
}

/// A tool that lies beside a surface touches it with its flank, far from its ends: these are shown to be far by themselves, and a ball
/// holds what is about the contact, or no more than the front of it.
#[test]
fn passes_of_flanks_find_what_a_complete_search_finds() {
    // With the tenths of the positions that are to be proven without a search: a slender cone and a large tool may need it.
    let cutters: [(&[f64], u32); 4] = [
        (&[0.5, 0.1, 0.15, 0.1, 0.0, 0.0, 5.0], 5),
        (&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0], 5),
        (&[0.5, 0.1, 0.1661, 0.1, 0.0, 10.0, 4.0], 0),
        (&[1.2, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0], 0),
    ];
    let mut few = Vec::new();
    for (which, geometry) in charted().iter().enumerate().skip(2) {
        for (numbers, tenths) in cutters {
            for axis in [v(1.0, 0.1, 0.0).normalize(), v(0.1, 1.0, 0.05).normalize()] {
                let tool = Tool::new(Cutter::from_numbers(numbers, 1.0).expect("cutter"), axis);
                let from = v(-0.4, 0.3, 4.0) - axis * 2.5;
                let (proven, seen) = pass(geometry, false, &tool, &from, &v(0.007, 0.002, 0.0), 60);
                if proven * 10 < seen * tenths {
                    few.push(format!("{which} {numbers:?} {} {proven} of {seen}", axis.x));
                }
            }
        }
    }
    assert!(few.is_empty(), "{few:#?}");
}

#[test]
fn tool_ends_on_sheets_have_the_feet_that_a_complete_search_finds() {
    let tool = tool(&[0.5, 0.1]);
    for geometry in charted() {
        pass(&geometry, true, &tool, &v(-1.1, 0.3, 3.0), &v(0.011, 0.002, 0.0), 200);
    }
}

#[test]
fn what_is_remembered_changes_no_clearance() {
    let tool = tool(&[0.5, 0.1]);
    for geometry in charted() {
        let side = upper(&Surface::from_geometry(&geometry).expect("surface"));
        let tip = |k: u32| v(-0.8 + 0.01 * f64::from(k), 0.2, 3.0);
        let (ahead, back) = (gauge(&geometry, side), gauge(&geometry, side));
        let forward: Vec<f64> = (0..150).map(|k| ahead.contact(&tool, &tip(k)).clearance).collect();
        let mut backward: Vec<f64> = (0..150).rev().map(|k| back.contact(&tool, &tip(k)).clearance).collect();
        backward.reverse();
        for (a, b) in forward.iter().zip(&backward) {
            assert!((a - b).abs() < 1e-8, "{a} forward, {b} backward");
        }
    }
}

/// The flank above the corner is far away: the sizes of the surface's parts tell that, without patches of the tool.
#[test]
fn the_flank_above_the_corner_takes_hardly_any_patches() {
    let numbers = [0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0];
    let tool = Tool::new(Cutter::from_numbers(&numbers, 1.0).expect("cutter"), Vec3::z());
    for geometry in [lofts::roof(), lofts::vault()] {
        let side = upper(&Surface::from_geometry(&geometry).expect("surface"));
        let known = gauge(&geometry, side);
        let mut tip = v(-1.1, 0.3, 4.0);
        for _ in 0..10 {
            tip.z -= known.contact(&tool, &tip).clearance * 0.99;
        }
        let before = JUDGED.get();
        for _ in 0..200 {
            tip += v(0.011, 0.002, 0.0);
            tip.z -= known.contact(&tool, &tip).clearance * 0.99;
        }
        assert!(JUDGED.get() - before <= 100, "{} patches", JUDGED.get() - before);
    }
}

/// Where no ball about the whole tool proves contact, the patches that did so in the last position do so again: at most three
/// fifths as many are looked at as where every position is the first. Positions in which contact jumps stay open, few of them.
#[test]
fn a_proof_serves_many_positions() {
    let cutters: [&[f64]; 2] =
        [&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0], &[0.6, 0.11, 0.2, 0.13, 11.0, 4.3, 3.0]];
    let (mut remembering, mut anew, mut positions, mut open) = (0, 0, 0, 0);
    let judged = |look: &dyn Fn() -> (Contact, f64)| {
        let before = JUDGED.get();
        let (contact, missed) = look();
        (contact.clearance, missed < 1e-7, JUDGED.get() - before)
    };
    for geometry in &charted() {
        for numbers in cutters {
            let cutter = Cutter::from_numbers(numbers, 1.0).expect("cutter");
            let tool = Tool::new(cutter, v(0.2, -0.1, 1.0).normalize());
            let side = upper(&Surface::from_geometry(geometry).expect("surface"));
            let known = gauge(geometry, side);
            let mut tip = v(-1.1, 0.3, 4.0);
            for _ in 0..100 {
                tip += v(0.011, 0.002, 0.0);
                let (clearance, is_proven, count) =
                    judged(&|| known.contact_within(&tool, &tip, Enough::ALL));
                positions += 1;
                open += u32::from(!is_proven);
                remembering += count;
                anew += judged(&|| gauge(geometry, side).contact_within(&tool, &tip, Enough::ALL)).2;
                tip.z -= clearance * 0.99;
            }
        }
    }
    assert!(open * 100 <= positions, "{open} of {positions} not proven");
    assert!(remembering * 5 < anew * 3, "{remembering} patches looked at, {anew} anew");
}

/// Where a flank lies nearly along a ruled surface small patches are left all along it: parts of the surface show the contact after few of
/// them.
#[test]
fn a_flank_nearly_along_a_surface_takes_few_patches() {
    let cutter = Cutter::from_numbers(&[1.0], 3.0).expect("cutter");
    let surface = Surface::from_geometry(&lofts::vault()).expect("surface");
    let side = upper(&surface);
    let face = Face { surface: &surface, side };
    let (mut by_patches, mut by_parts) = (0, 0);
    for k in 0..4 {
        let tool = Tool::new(cutter, v(0.15 * f64::from(k), 1.0, 0.02).normalize());
        let mut tip = v(-0.5, -1.5, 6.0);
        for _ in 0..8 {
            tip.z -= search::found(&tool, face, &tip).clearance * 0.9;
        }
        let start = JUDGED.get();
        let (contact, missed) = search::contact(&tool, face, &tip, (None, None), Enough::ALL);
        assert!(missed < 1e-7, "not proven at {tip}");
        let middle = JUDGED.get();
        let bases = Bases::about(&tool, &tip, (&surface, side), &contact.tool);
        let mut proof = Proof::of_tool(&tool);
        let level = contact.clearance - missed;
        certify::certify(face, &tool, &tip, level, &mut proof, Some(&bases), Effort::All);
        by_parts += middle - start;
        by_patches += JUDGED.get() - middle;
    }
    assert!(by_patches > 2 * by_parts, "{by_parts} patches looked at before parts, {by_patches} without");
}

/// Where a surface ends beside the tool, no ball that holds all of that is steady; one that holds what is near the contact is, and the
/// rest of the tool is shown to be far.
#[test]
fn contact_with_a_surface_as_wide_as_the_tool_is_followed() {
    let axis = v(0.2, -0.1, 1.0).normalize();
    let mut few = Vec::new();
    for (which, geometry) in charted().iter().enumerate().skip(2) {
        for numbers in [[2.4, 1.2], [3.6, 1.8]] {
            let tool = Tool::new(Cutter::from_numbers(&numbers, 1.0).expect("cutter"), axis);
            let (proven, seen) = pass(geometry, false, &tool, &v(-0.8, 0.3, 4.0), &v(0.007, 0.002, 0.0), 60);
            if proven * 10 < seen * 8 {
                few.push(format!("{which} {numbers:?} {proven} of {seen}"));
            }
        }
    }
    assert!(few.is_empty(), "{few:#?}");
}

#[test]
fn contact_inside_a_tool_that_is_a_line_is_followed() {
    let axis = v(1.0, 0.1, 0.0).normalize();
    let tool =
        Tool::new(Cutter::from_numbers(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0], 1.0).expect("cutter"), axis);
    for geometry in [lofts::roof(), lofts::vault()] {
        let from = v(-0.4, 0.3, 4.0) - axis * 2.5;
        let (proven, seen) = pass(&geometry, false, &tool, &from, &v(0.007, 0.002, 0.0), 60);
        assert!(proven * 10 >= seen * 5, "{proven} of {seen}");
    }
}

/// Between two contacts the clearance is nowhere above what the chord between their places tells, where the surface is straight, twisted or round,
/// and where the tool touches it with the edge of its open top from below. Between places near by that is hardly more than at both.
#[test]
fn places_of_the_surface_between_two_contacts_bound_the_clearance_from_above() {
    let tool = tool(&[1.0, 0.1, 0.4, 0.1, 0.0, 0.0, 2.0]);
    let mut close = Vec::new();
    for (geometry, [below, height]) in [lofts::roof(), lofts::vault()]
        .iter()
        .flat_map(|geometry| [(geometry, [1.0, 0.0]), (geometry, [-1.0, -1.5])])
    {
        let surface = Surface::from_geometry(geometry).expect("surface");
        let gauge = gauge(geometry, upper(&surface) * below);
        for (x, y, way) in
            [(-0.8, -0.5, v(0.6, 0.2, 0.0)), (0.2, -0.6, v(0.0, 0.7, 0.0)), (0.4, 0.1, v(0.02, 0.03, 0.0))]
        {
            for sink in [-0.02, 0.03] {
                let over = |tip: Vec3| {
                    let contact = gauge.contact(&tool, &tip);
                    tip - tool.axis * ((contact.clearance - sink) / contact.gradient.dot(&tool.axis))
                };
                let from = v(x, y, height);
                let (from, to) = (over(from), over(from + way));
                let [first, last] = [from, to].map(|tip| gauge.contact(&tool, &tip));
                let Some(most) = gauge.at_most_along_surface(&tool, [(&from, &first), (&to, &last)]) else {
                    continue;
                };
                let highest = first.clearance.max(last.clearance).max(0.0);
                close.push(most <= highest + 0.05 * way.norm());
                for k in 0..=40 {
                    let tip = from + (to - from) * (f64::from(k) / 40.0);
                    let clearance = gauge.contact(&tool, &tip).clearance;
                    assert!(clearance <= most + 1e-9, "{clearance} above {most}");
                }
            }
        }
    }
    let count = close.iter().filter(|is_close| **is_close).count();
    assert!(close.len() >= 24 && count >= 12, "{count} of {}", close.len());
}

/// Where the flank of a tool touches a bulge, up to which height it may come into contact is asked for: what is below costs nothing.
#[test]
fn how_high_a_tool_may_touch_is_told_without_what_is_below() {
    let radius = 4.0_f64;
    let drop = (radius * radius - 1.0).sqrt() - radius;
    let edge = |x: f64| {
        let bulge = cylinder(v(0.0, -radius, 0.0), Vec3::x(), radius);
        (bulge, v(x, drop, -1.0), v(x, drop, 1.0), Vec3::y())
    };
    let bulge = ruled([edge(-1.0), edge(1.0)]);
    let side = gauge(&bulge, 1.0).surface.signed_distance(&v(0.0, 1.0, 0.0)).signum();
    let gauge = gauge(&bulge, side);
    let (tool, tip) = (tool(&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]), v(0.0, 0.251, -2.0));
    let contact = gauge.contact(&tool, &tip);
    let around = Around::new(&gauge, &tool, &tip, 0.0);
    let level = contact.clearance + 1e-3;
    let counted = |height: &dyn Fn() -> f64| {
        let before = LOOKS.get();
        (height(), LOOKS.get() - before)
    };
    let (both, alone) = (counted(&|| around.within(level)[1]), counted(&|| around.height_within(level)));
    assert!(around.within(level)[0] > 0.0 && both.0 < 4.0, "{:?}", around.within(level));
    assert_eq!(both.0, alone.0);
    assert!(alone.1 > 0 && 3 * alone.1 <= 2 * both.1, "{} looks, {} for both", alone.1, both.1);
}

//! Clearances that are searched for: how closely the place that is found tells the direction, and what is read once.

use apt_geometry::Vec3;

use super::{
    super::{
        clearance::{Clearance, Surface},
        patch::{jet, sides},
        ruling_clearance::{Ruled, searched},
        span::{Readings, Span},
        strip::{place, tangent},
        tool::{Profile, Tool, WORK},
    },
    cutter,
    poly_conics::{ALONG_X, LOFT, poly_conic},
};
use crate::sequence::ToolPosition;

/// Parts of the surface that one search may look at.
const FEW: u64 = 1_000;
/// How far from the end of the surface tools pass it: less than what tells a direction from a surface known so closely, and more.
const BESIDE: [f64; 2] = [2e-5, 2e-4];
/// Length of a tool that is a line.
const LENGTH: f64 = 0.2;

fn line() -> Profile {
    Profile::of(&cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, LENGTH])).expect("a line")
}

/// A line across the end of a patch, which it passes in its own middle.
struct Passing {
    position: ToolPosition,
    /// The direction from the end to the line.
    away: Vec3,
}

/// Lines across a side at which a surface ends, at a parameter of each of the patches there.
fn passing_ends(surface: &Ruled, parameter: f64, beside: f64) -> Vec<Passing> {
    let Ruled::Conics(strips) = surface else { panic!("{surface:?}") };
    let ends = strips.sheet.patches.iter().flat_map(|patch| {
        let sides = sides(&patch.net).into_iter().enumerate();
        sides.filter(|(k, _)| patch.edges.sides[*k]).map(|(k, curve)| (patch.net, k, curve))
    });
    ends.map(|(net, k, curve)| {
        let at = [[0.0, parameter], [1.0, parameter], [parameter, 0.0], [parameter, 1.0]][k];
        let [_, run, rise] = jet(&net, at);
        let along = tangent(&curve, parameter).normalize();
        let axis = (run.cross(&rise).normalize() + along * 0.3).normalize();
        let away = along.cross(&axis).normalize();
        let out = [-run, run, -rise, rise][k];
        let away = away * away.dot(&out).signum();
        let tip = place(&curve, parameter) + away * beside - axis * (0.5 * LENGTH);
        Passing { position: ToolPosition { tip, axis }, away }
    })
    .collect()
}

/// Where a line all but touches an end, a place that is as near to within what a search need tell may be as far to the side as makes
/// another direction.
#[test]
fn a_line_that_all_but_touches_an_end_is_told_the_direction_away_from_it() {
    let surface = Surface::of(&poly_conic(ALONG_X, 0.0, 0.0, 4.0, &LOFT)).expect("a surface");
    let Surface::Ruled(surface) = &surface else { panic!("{surface:?}") };
    let profile = line();
    for (beside, is_told) in BESIDE.into_iter().zip([false, true]) {
        let lines = passing_ends(surface, 0.37, beside);
        assert!(lines.len() > 20, "{}", lines.len());
        let (mut worst, mut most) = (0.0f64, 0);
        for Passing { position: ToolPosition { tip, axis }, away } in &lines {
            WORK.set(0);
            let found = searched(surface, 1.0, tip, &Tool::new(&profile, *axis)).expect("a clearance");
            assert!((found.value - beside).abs() <= found.error, "{beside}: {found:?}");
            worst = worst.max((found.normal - away).norm());
            most = most.max(WORK.get());
        }
        assert!((worst < 1e-5 || !is_told) && most < FEW, "{beside}: {worst} {most}");
    }
}

/// What decides only by its error is asked for more closely, and is known where it was read before.
#[test]
fn what_was_read_for_a_bound_is_not_read_again_for_a_closer_one() {
    let surface = Surface::of(&poly_conic(ALONG_X, 0.0, 0.0, 4.0, &LOFT)).expect("a surface");
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    let profile = line();
    let clearance = Clearance::new(&surface, &profile, 1.0);
    let [from, last] = [0.4, 0.6].map(|t| passing_ends(ruled, t, BESIDE[0]).swap_remove(0).position);
    let to = ToolPosition { tip: last.tip, ..from };
    let ends = [from, to].map(|end| clearance.at(&end.tip, &end.axis).expect("a clearance"));
    let span = Span {
        clearance: &clearance,
        from,
        to,
        ends,
        beyond: [-1.0, 1.0],
        band: [-1e-9, 1e-9],
        read: &Readings::default(),
        is_looked_at: true,
    };
    let ask = || {
        WORK.set(0);
        let found = span.extremes(span.at_ends().expect("slopes"), 1e-8).expect("extremes");
        (found, WORK.get())
    };
    let [(first, most), (second, again)] = [ask(), ask()];
    assert!(most > 0 && again == 0, "{most} {again}");
    assert_eq!(first, second);
}

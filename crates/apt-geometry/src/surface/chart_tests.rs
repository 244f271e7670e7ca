//! Charts of tabulated, ruled and polyconic surfaces against feet and distances found by complete search.

use std::sync::Arc;

use nalgebra::SymmetricEigen;
use proptest::prelude::*;

use super::{
    sheet_bend_tests::{COUNT, THICK, made, places},
    *,
};
use crate::canonical::{Interval, TabulatedCylinder};

#[test]
fn charts_are_about_the_nearest_places() {
    let mut inside = 0;
    for which in 0..COUNT {
        let surface = made(which);
        for near in places(60) {
            let p = surface.foot(&near).point + Vec3::new(0.02, -0.01, 0.03);
            let foot = surface.foot(&p);
            let chart = surface.place(&p).and_then(|place| surface.chart(&place)).expect("a chart");
            let Some(normal) = chart.first[0].cross(&chart.first[1]).try_normalize(1e-9) else { continue };
            let normal = normal * chart.sense;
            let offset = p - chart.point;
            if (offset - normal * offset.dot(&normal)).norm() > 1e-9 {
                continue;
            }
            inside += 1;
            assert!((offset.dot(&normal) - chart.thickness - foot.distance).abs() < 1e-10, "{which} at {p}");
            assert!((normal - foot.normal).norm() < 1e-7, "{which} at {p}: {normal} {}", foot.normal);
        }
    }
    assert!(inside >= 300, "only {inside} places off the edges");
}

#[test]
fn charts_have_the_derivatives_of_their_points() {
    let step = 1e-4;
    let mut seen = 0;
    for which in 0..COUNT {
        let surface = made(which);
        for near in places(40) {
            let Some(place) = surface.place(&near) else { continue };
            for side in 0..2 {
                let way = |k: f64| if side == 0 { [k * step, 0.0] } else { [0.0, k * step] };
                let at = |k: f64| {
                    // Neighbouring pieces may follow each other at different speeds.
                    surface.shifted(&place, way(k)).filter(|there| there.piece == place.piece)
                };
                let (Some(before), Some(after)) = (at(-1.0), at(1.0)) else { continue };
                let [before, here, after] =
                    [before, place, after].map(|p| surface.chart(&p).expect("a chart"));
                let first = (after.point - before.point) / (2.0 * step);
                let second = (after.first[side] - before.first[side]) / (2.0 * step);
                let mixed = (after.first[1 - side] - before.first[1 - side]) / (2.0 * step);
                let size = 1.0 + here.first[side].norm() + here.second[2 * side].norm();
                assert!(
                    (first - here.first[side]).norm() < 1e-5 * size,
                    "{which}: {first} {}",
                    here.first[side]
                );
                assert!((second - here.second[2 * side]).norm() < 1e-3 * size, "{which} {side}: {second}");
                assert!((mixed - here.second[1]).norm() < 1e-3 * size, "{which} {side}: {mixed}");
                seen += 1;
            }
        }
    }
    assert!(seen >= 300, "only {seen}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    /// In a steady ball the distance falls below its tangents by no more than the bend says, and a normal that leads from a
    /// place of the ball to a point of it leads to the point from its nearest place.
    #[test]
    fn steady_balls_are_steady(
        which in 0usize..COUNT, natural in prop::bool::ANY, near in prop::array::uniform3(-1.0..6.0f64),
        off in 0.0..0.4f64, radius in 0.01..0.7f64, depth in 0.05..1.0f64,
        ends in prop::collection::vec(prop::array::uniform6(-1.0..1.0f64), 40),
    ) {
        let surface = made(which);
        let side = if natural { 1.0 } else { -1.0 };
        let foot = surface.foot(&Vec3::from(near));
        let center = foot.point + foot.normal * (side * off);
        let Some(steady) = surface.steady(side, &center, [radius, depth], Patience::default()) else { return Ok(()) };
        let inside = |p: &Vec3| (p - center).norm() <= radius;
        for e in ends {
            let (p, q) = (center + Vec3::new(e[0], e[1], e[2]) * radius, center + Vec3::new(e[3], e[4], e[5]) * radius);
            let (at, other) = (surface.foot(&p), surface.foot(&q));
            let [d, there] = [&at, &other].map(|foot| side * foot.distance);
            let deep = |d: f64| d >= 0.0 && d <= depth;
            if !(inside(&p) && inside(&q) && deep(d) && deep(there)) {
                continue;
            }
            let x = q - p;
            let least = d + side * at.normal.dot(&x) - 0.5 * steady.bend(d) * x.norm_squared();
            // On the way the points must be in the ball and no deeper, too.
            let deepest = (1..20).map(|k| side * surface.signed_distance(&(p + x * (f64::from(k) / 20.0))));
            if deepest.clone().all(deep) {
                prop_assert!(there >= least - 1e-9, "{which}: {there} below {least}");
                if let Some(bend) = steady.upward_bend(d.min(there).min(deepest.clone().fold(f64::INFINITY, f64::min))) {
                    let middle = side * surface.signed_distance(&((p + q) * 0.5));
                    let sag = 0.5 * (d + there) - middle;
                    prop_assert!(sag <= bend * x.norm_squared() / 8.0 + 1e-9, "{which}: {sag} with {bend}");
                }
            }
            let share = e[0].abs() * depth;
            let reached = at.point + at.normal * (side * share);
            if inside(&at.point) && inside(&reached) {
                let found = surface.foot(&reached);
                prop_assert!((side * found.distance - share).abs() < 1e-8, "{which}: {} of {share}", found.distance);
            }
        }
    }

    /// Whatever keeps off is farther away.
    #[test]
    fn nothing_that_keeps_off_is_nearer(
        which in 0usize..COUNT, p in prop::array::uniform3(-2.0..7.0f64), distance in 0.0..3.0f64,
    ) {
        let (surface, p) = (made(which), Vec3::from(p));
        if surface.keeps_off(&p, distance) {
            let found = surface.foot(&p).distance.abs();
            prop_assert!(found > distance * (1.0 - 1e-9), "{which}: {found} within {distance}");
        }
    }
}

/// How far a point is from all that is within a radius of a straight stretch, and the way there.
fn away_from_stretch(p: &Vec3, [from, to]: &[Vec3; 2], radius: f64) -> (f64, Vec3) {
    let along = to - from;
    let share = ((p - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    let way = p - (from + along * share);
    let distance = way.norm() - radius;
    if distance > 0.0 { (distance, way.normalize()) } else { (0.0, Vec3::zeros()) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    /// No place of a surface is nearer to a convex body than is said to be kept.
    #[test]
    fn nothing_is_nearer_to_a_body_than_what_is_kept(
        which in 0usize..COUNT, near in prop::array::uniform3(-1.0..6.0f64), off in 0.05..2.0f64,
        way in prop::array::uniform3(-2.0..2.0f64), radius in 0.01..0.5f64, wanted in 0.001..0.5f64,
        asides in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 60), is_within in any::<bool>(),
        is_beside in any::<bool>(), is_turning in any::<bool>(),
    ) {
        let surface = made(which);
        let foot = surface.foot(&Vec3::from(near));
        let from = foot.point + foot.normal * (off + radius);
        let ends = [from, from + Vec3::from(way)];
        let away = |p: &Vec3| away_from_stretch(p, &ends, radius);
        // The plane across the normal at the foot, on which the body stands.
        let outward = -foot.normal;
        let reach = |outward: &Vec3| {
            ends.iter().map(|end| outward.dot(end) + radius).fold(f64::NEG_INFINITY, f64::max)
        };
        let within = is_within.then(|| HalfSpace { outward, level: reach(&outward) });
        // Any half-space that holds it will do, and so one that faces the part.
        let facing = |out: &Vec3, normal: &Vec3| {
            let outward = if out.dot(normal) < 0.0 { -normal } else { *normal };
            HalfSpace { outward, level: reach(&outward) }
        };
        let beside = is_beside.then_some(&facing as &Beside<'_>);
        // Its own tangent planes are those of a body that turns by nothing.
        let still = |p: &Vec3| [away(p); 2];
        let at_ends = is_turning.then_some(&still as &AtEnds<'_>);
        let body = Body { away: &away, within, beside, at_ends };
        let Some(kept) = surface.keeps_off_body(body, wanted, Limit { looks: 600, enough: f64::INFINITY, patience: Patience::default() }) else { return Ok(()) };
        prop_assert!(kept >= wanted);
        for (k, aside) in asides.iter().enumerate() {
            let share = k as f64 / asides.len() as f64;
            let place = surface.foot(&(ends[0] + (ends[1] - ends[0]) * share + Vec3::from(*aside) * 0.5)).point;
            prop_assert!(away(&place).0 >= kept - 1e-9, "{which}: {} within {kept}", away(&place).0);
        }
    }
}

#[test]
fn bodies_off_a_surface_are_known_to_keep_most_of_their_distance() {
    let mut kept = 0;
    let mut asked = 0;
    for which in 0..COUNT {
        let surface = made(which);
        for near in places(60) {
            let foot = surface.foot(&near);
            let from = foot.point + foot.normal * 0.5;
            let ends = [from, from + foot.normal * 0.2];
            let distance =
                surface.foot(&ends[0]).distance.abs().min(surface.foot(&ends[1]).distance.abs()) - 0.1;
            if distance > 0.2 {
                asked += 1;
                let away = |p: &Vec3| away_from_stretch(p, &ends, 0.1);
                kept += usize::from(
                    surface
                        .keeps_apart(&away, [0.8 * distance, f64::INFINITY], Patience::default())
                        .is_some(),
                );
            }
        }
    }
    assert!(asked >= 100 && kept * 10 >= asked * 8, "{kept} of {asked}");
}

#[test]
fn steady_balls_are_found_and_far_points_keep_off() {
    for which in 0..COUNT {
        let surface = made(which);
        // Not along the straight lines of the tabulated cylinder, which go on for ever.
        let away = if surface.generator().is_some() { Vec3::y() } else { Vec3::z() };
        let (mut balls, mut off) = (0, 0);
        for near in places(200) {
            let foot = surface.foot(&near);
            let found = [1.0, -1.0].map(|side| {
                surface
                    .steady(
                        side,
                        &(foot.point + foot.normal * (side * 0.02)),
                        [0.03, 0.05],
                        Patience::default(),
                    )
                    .is_some()
            });
            balls += usize::from(found.contains(&true));
            off += usize::from(surface.keeps_off(&(near + away * 40.0), 20.0));
        }
        // Off a thick surface the ends of its conics are within reach nearly everywhere.
        assert!(
            balls >= 100 || which == THICK && balls >= 10,
            "{which}: only {balls} of 200 balls are steady"
        );
        assert!(off >= 190, "{which}: only {off} of 200 keep off");
    }
}

/// A slot with a round ground.
fn slot() -> Surface {
    let row =
        |u: f64, v: f64, a: f64, b: f64| Interval { u, v, a, b, length: 0.0, maximum: 0.0, minimum: 0.0 };
    let geometry = Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: vec![row(-1.0, 9.0, 0.0, 0.0), row(-1.0, 1.0, 0.0, 0.5), row(1.0, 1.0, 0.0, 0.0)],
        last: [1.0, 9.0],
    }));
    Surface::from_geometry(&geometry).expect("a surface")
}

#[test]
fn there_is_no_steady_ball_and_no_bound_between_the_walls_of_a_slot() {
    let slot = slot();
    let middle = Vec3::new(0.0, 5.0, 0.0);
    let side = slot.foot(&middle).distance.signum();
    assert!((slot.foot(&middle).distance.abs() - 1.0).abs() < 1e-12);
    assert_eq!(slot.steady(side, &middle, [0.3, 1.2], Patience::default()), None);
    // The distance taken negative bends without bound where the nearest wall changes.
    let region = Region { center: middle, radius: 0.3, lowest: -1.0, highest: -0.6 };
    assert_eq!(slot.bend(-side, &slot.foot(&middle), &region, Patience::default()), Bend::Unbounded);
    let beside = Vec3::new(0.6, 5.0, 0.0);
    assert!(slot.steady(side, &beside, [0.2, 0.6], Patience::default()).is_some());
    let region = Region { center: beside, radius: 0.2, lowest: -0.6, highest: 0.0 };
    assert_eq!(slot.bend(-side, &slot.foot(&beside), &region, Patience::default()), Bend::AtMost(0.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]
    /// In each direction the surface bends towards a side no more than a cylinder with the curvature that was asked for.
    #[test]
    fn no_place_within_reach_bends_more_than_the_cylinder_across_a_direction(
        which in 0usize..COUNT, natural in prop::bool::ANY, near in prop::array::uniform3(-1.0..6.0f64), reach in 0.05..1.0f64,
        alongs in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 12),
        ways in prop::collection::vec(prop::array::uniform6(-1.0..1.0f64), 40),
    ) {
        let surface = made(which);
        let side = if natural { 1.0 } else { -1.0 };
        let foot = surface.foot(&Vec3::from(near));
        let center = foot.point - foot.normal * surface.stock(1.0);
        let forms = surface.forms(side, &center, reach, Patience::default());
        prop_assert!(forms.as_ref().is_none_or(|forms| !forms.is_empty()));
        for along in alongs.into_iter().filter_map(|along| Vec3::from(along).try_normalize(0.1)) {
            let curvatures: Option<Vec<f64>> =
                forms.iter().flatten().map(|form| form.curvature_across(&along, 0.0)).collect();
            let by_forms = curvatures.and_then(|all| all.into_iter().reduce(f64::max)).map(|across| (0.0, across));
            let lengthwise = [0.0, 0.1].map(|first| {
                let least = std::array::from_fn(|k| first + 0.05 * k as f64);
                let asked = Lengthwise { along, least, enough: 0.2, most: 5.0 };
                surface.curvature_across(side, &center, reach, asked, Patience::default())
            });
            for ((least, curvature), e) in
                [by_forms, lengthwise[0], lengthwise[1]].into_iter().flatten().flat_map(|one| ways.iter().map(move |e| (one, e)))
            {
                let foot = surface.foot(&(center + Vec3::new(e[0], e[1], e[2]) * reach));
                let place = foot.point - foot.normal * surface.stock(1.0);
                if (place - center).norm() > reach {
                    continue;
                }
                let way = Vec3::new(e[3], e[4], e[5]);
                let bend = -side * way.dot(&(surface.foot_and_hessian(&place).1 * way));
                let across = way.norm_squared() - way.dot(&along).powi(2);
                let most = curvature * across + least * way.norm_squared();
                prop_assert!(bend <= most + 1e-6, "{which}: {bend} with {curvature} and {least}");
            }
        }
    }
}

/// The direction of the ruling at the foot of a point of a ruled surface.
fn ruling_at(surface: &Surface, near: &Vec3) -> Option<Vec3> {
    let chart = surface.place(near).and_then(|place| surface.chart(&place))?;
    matches!(surface, Surface::Ruled(_)).then_some(chart.first[1])?.try_normalize(0.0)
}

/// Steps in which a stretch is gone along.
const STRETCH: i32 = 20;

/// How much the distance from a surface bends downward along a stretch of a line at most, and the greatest distance; None where the
/// nearest place jumps or is farther from that of the middle than a reach.
fn bends_along(
    surface: &Surface,
    side: f64,
    (middle, along): (&Vec3, &Vec3),
    (half, reach): (f64, f64),
) -> Option<[f64; 2]> {
    let center = surface.foot(middle).point;
    let mut last: Option<Vec3> = None;
    let mut greatest = [f64::NEG_INFINITY; 2];
    for k in -STRETCH..=STRETCH {
        let (foot, hessian) =
            surface.foot_and_hessian(&(middle + along * (half * f64::from(k) / f64::from(STRETCH))));
        let step = last.map_or(0.0, |last| (foot.point - last).norm());
        if step > 4.0 * half / f64::from(STRETCH) || (foot.point - center).norm() > reach {
            return None;
        }
        last = Some(foot.point);
        let found = [-side * along.dot(&(hessian * along)), side * foot.distance];
        greatest = [0, 1].map(|k: usize| greatest[k].max(found[k]));
    }
    Some(greatest)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]
    /// Nor do distances bend more along a line near the rulings, in the tangent planes or not, where it is told that they bend little.
    #[test]
    fn distances_bend_no_more_along_rulings_than_is_told(
        which in 0usize..COUNT, natural in prop::bool::ANY, near in prop::array::uniform3(-1.0..6.0f64), half in 0.005..0.5f64,
        off in prop::array::uniform3(-0.2..0.2f64), leaning in 0.0..1.0f64, distance in 0.0..0.5f64, beside in 0.02..1.0f64,
    ) {
        let surface = made(which);
        let side = if natural { 1.0 } else { -1.0 };
        let foot = surface.foot(&Vec3::from(near));
        let Some(ruling) = ruling_at(surface, &foot.point) else { return Ok(()) };
        let along = (ruling + Vec3::from(off) * leaning).normalize();
        let middle = foot.point + foot.normal * (side * distance);
        let reach = 2.0 * half;
        let Some([bend, depth]) = bends_along(surface, side, (&middle, &along), (half, reach)) else { return Ok(()) };
        // The least that is told, roughly.
        let told = (0..30).map(|k| 1e-6 * 1.6f64.powi(k)).find(|enough| {
            let asked = Lying { along, half, depth, enough: *enough, beside: beside * half };
            surface.bends_little_along(side, &foot.point, reach, asked, Patience::default())
        });
        if let Some(told) = told {
            prop_assert!(bend <= told + 1e-6, "{which}: {bend} with {told}");
        }
    }
}

/// Of a short stretch it is told almost as closely as it is.
#[test]
fn it_is_told_closely_how_distances_bend_along_rulings() {
    let half = 1e-3;
    let (mut told, mut close) = (0, 0);
    for which in 0..COUNT {
        let surface = made(which);
        for (near, side) in places(60).flat_map(|near| [(near, 1.0), (near, -1.0)]) {
            let foot = surface.foot(&near);
            let Some(ruling) = ruling_at(surface, &foot.point) else { continue };
            let along = (ruling + Vec3::new(0.01, -0.02, 0.015)).normalize();
            let middle = foot.point + foot.normal * (side * 0.2);
            let Some([bend, depth]) = bends_along(surface, side, (&middle, &along), (half, 2.0 * half))
            else {
                continue;
            };
            let within = |enough: f64| {
                let asked = Lying { along, half, depth, enough, beside: 0.25 * half };
                surface.bends_little_along(side, &foot.point, 2.0 * half, asked, Patience::default())
            };
            assert!(!within(bend - 1e-6), "{which}: less than {bend}");
            told += 1;
            close += u32::from(within(bend + 1e-3));
        }
    }
    assert!(told >= 100 && 10 * close >= 9 * told, "{close} of {told}");
}

#[test]
fn cylinders_across_a_direction_are_found_where_surfaces_bend_away_along_it() {
    let mut found = [0; COUNT];
    for (which, found) in found.iter_mut().enumerate() {
        let surface = made(which);
        for near in places(40) {
            for side in [1.0, -1.0] {
                let foot = surface.foot(&near);
                let hessian = surface.foot_and_hessian(&foot.point).1 * side;
                let eigen = SymmetricEigen::new(hessian);
                let (away, most) = eigen.eigenvalues.argmax();
                if !(0.05..10.0).contains(&most) {
                    continue;
                }
                let along: Vec3 = eigen.eigenvectors.column(away).into();
                let Some(forms) = surface.forms(
                    side,
                    &(foot.point - foot.normal * surface.stock(1.0)),
                    0.02,
                    Patience::default(),
                ) else {
                    continue;
                };
                let curvatures: Option<Vec<f64>> =
                    forms.iter().map(|form| form.curvature_across(&along, 0.0)).collect();
                let Some(curvature) = curvatures.and_then(|all| all.into_iter().reduce(f64::max)) else {
                    continue;
                };
                *found += usize::from(curvature <= 0.5 * most + 2.0 * (-eigen.eigenvalues.min()).max(0.0));
            }
        }
    }
    assert!(found.iter().filter(|found| **found > 10).count() >= 9, "{found:?}");
}

/// The chord between two places of a line at which a surface ends is off the line by no more than that sags.
#[test]
fn chords_of_end_lines_are_as_near_as_they_sag() {
    let (mut seen, mut straight) = (0, 0);
    for which in 0..COUNT {
        let made = made(which);
        let surface = made.met_from(1.0, Patience::default());
        let Some(place) = surface.place(&Vec3::new(1.0, 1.0, 1.0)) else { continue };
        for (line, _) in surface.creases_beside(&place, 1.0).into_iter().flatten() {
            for (from, to) in [(0.1, 0.15), (0.42, 0.5), (0.55, 0.52), (0.3, 0.8)] {
                let Some(sag) = surface.crease_sag(&line, [from, to]) else { continue };
                let at =
                    |share: f64| surface.on_crease(&line, from + (to - from) * share).expect("a place")[0];
                let [first, last] = [at(0.0), at(1.0)];
                seen += 1;
                straight += u32::from(sag == 0.0);
                for k in 0..=16 {
                    let share = f64::from(k) / 16.0;
                    let off = (at(share) - (first + (last - first) * share)).norm();
                    assert!(off <= sag + 1e-12, "{which}: {off} beyond {sag} on {line:?} at {share}");
                }
            }
        }
    }
    assert!(seen >= 20 && straight >= 4 && straight < seen, "{straight} of {seen}");
}

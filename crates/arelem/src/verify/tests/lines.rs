//! Tools without a body: how deep they are under a surface is asked of places all along them.

use apt_geometry::{
    Vec3,
    canonical::{
        Geometry, PolyConicForm, Remembering,
        extent::{POLYCONIC_ENDS_BEYOND, POLYCONIC_STATIONS_BEYOND},
    },
};
use proptest::prelude::*;

use super::{
    super::{
        clearance::Surface,
        ruling_clearance::searched,
        tool::{Profile, Tool, WORK},
    },
    clearances::direction,
    cutter, plane,
    poly_conics::poly_conic,
    ruled, section, tabulated,
};

/// How deep the lines of these tests may be.
const ALLOWED: f64 = 1e-3;
/// Places along a line at which it is asked how deep it is, and along an end of a surface at which it is asked how far the line is away.
const PLACES: usize = 600;
/// Parts of a surface that may be looked at for one line.
const FEW: u64 = 40_000;

pub(super) fn line(length: f64) -> Profile {
    Profile::of(&cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, length])).expect("a line")
}

/// How deep a line is under a surface at its deepest place, and the way out there.
fn deepest(surface: &Surface, tip: &Vec3, axis: &Vec3, length: f64) -> (f64, Vec3) {
    let at = |height: f64| surface.point_distance(&(tip + axis * height)).expect("a distance");
    let step = length / PLACES as f64;
    let heights = (0..=PLACES).map(|k| step * k as f64);
    let (_, best) =
        heights.map(|height| (at(height).0, height)).min_by(|a, b| a.0.total_cmp(&b.0)).expect("places");
    // Between its neighbours it is closed in.
    let [mut low, mut high] = [(best - step).max(0.0), (best + step).min(length)];
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if at(low + third).0 <= at(high - third).0 {
            high -= third;
        } else {
            low += third;
        }
    }
    let (value, out) =
        [low, best, high].map(at).into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("three");
    (-value, out)
}

/// A polyconic surface with hills and hollows, of length 6, about the origin.
fn hilly() -> Geometry {
    let functions = [
        [1.756_532_165_193_433_8, -0.168_822_345_429_936_1, 0.0],
        [1.756_532_165_193_433_8, -0.177_267_819_962_476_84, 0.0],
        [1.756_532_165_193_433_8, 0.050_652_032_619_696_044, 0.0],
        [-1.756_532_165_193_433_8, 0.104_466_245_780_734_52, 0.0],
        [-1.756_532_165_193_433_8, -0.119_039_710_615_717_1, 0.0],
        [1.756_532_165_193_433_8, 0.174_068_714_080_994_86, 0.0],
        [std::f64::consts::FRAC_1_SQRT_2, 0.035_437_069_575_486_986, 0.0],
    ];
    let rows = [
        [0.113_031_029_199_314_26, 0.762_275_210_171_107_6, 0.637_307_218_221_116_7],
        [-0.240_106_748_706_478_52, -0.601_452_008_609_020_4, 0.761_973_904_123_874_2],
        [0.964_143_524_411_043_2, -0.239_148_458_700_383_5, 0.115_044_682_786_659_58],
    ];
    let shifts = [-0.494_352_008_553_731_07, -2.441_295_547_196_870_3, 2.502_818_043_432_096_6];
    let Geometry::PolyConic(values) = poly_conic(rows, 0.0, 0.0, 6.0, &functions) else {
        panic!("a polyconic surface")
    };
    let mut values = values.to_vec();
    for (row, shift) in shifts.into_iter().enumerate() {
        values[4 + 4 * row] = shift;
    }
    Geometry::PolyConic(Remembering::new(values))
}

/// The place of a polyconic surface at a station, and a share of the way along the conic there, which goes on straight at both ends.
fn place_of_conic(form: &PolyConicForm, station: f64, share: f64) -> Vec3 {
    let [a, b, c, d, l, h, fullness] = form.controls(station).expect("a conic");
    let x = form.base + form.length * station;
    let [start, meet, end] =
        [[l, h], [l + c, h + b], [l + c + a, h + b + d]].map(|[y, z]| Vec3::new(x, y, z));
    let weight = (2.0 * fullness - 1.0) / (2.0 * (1.0 - fullness));
    let rest = 1.0 - share;
    let [first, middle, last] = [rest * rest, 2.0 * weight * share * rest, share * share];
    let place = if share < 0.0 {
        start + (meet - start) * (POLYCONIC_ENDS_BEYOND * share)
    } else if rest < 0.0 {
        end + (meet - end) * (POLYCONIC_ENDS_BEYOND * rest)
    } else {
        (start * first + meet * middle + end * last) / (first + middle + last)
    };
    form.map.inverse().expect("a rigid motion").apply_point(&place)
}

/// How far a line is from where a polyconic surface ends along its stations; nothing else of these tests ends near a line.
fn way_to_end(geometry: &Geometry, tip: &Vec3, axis: &Vec3, length: f64) -> f64 {
    let Geometry::PolyConic(values) = geometry else { return f64::INFINITY };
    let form = PolyConicForm::read(values).expect("a form");
    let way = |station: f64, share: f64| {
        let from = place_of_conic(&form, station, share) - tip;
        (from - axis * axis.dot(&from).clamp(0.0, length)).norm()
    };
    let step = 3.0 / PLACES as f64;
    let to_end = |station: f64| {
        let shares = (0..=PLACES).map(|k| step * k as f64 - 1.0);
        let best = shares.min_by(|a, b| way(station, *a).total_cmp(&way(station, *b))).expect("places");
        let [mut low, mut high] = [best - step, best + step];
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if way(station, low + third) <= way(station, high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        way(station, low)
    };
    let ends = [-POLYCONIC_STATIONS_BEYOND, 1.0 + POLYCONIC_STATIONS_BEYOND];
    ends.map(to_end).into_iter().fold(f64::INFINITY, f64::min)
}

/// A line that is in a bulge of the surface with its middle and under it with its top is as deep as either, whichever is deeper: the two are
/// judged each for itself, as closely as one of them alone.
#[test]
fn a_line_that_is_deep_at_two_places_is_as_deep_as_its_deeper_part() {
    let surface = Surface::of(&hilly()).expect("a surface");
    let Surface::Ruled(hills) = &surface else { panic!("{surface:?}") };
    let length = 4.574_456_8;
    let [whole, half] = [line(length), line(0.5 * length)];
    let from = Vec3::new(-1.107_812_5, -0.938_842_9, -0.729_536_4);
    let mut both = 0;
    for k in 0..32 {
        let tip = from + Vec3::new(6e-4, -2e-4, 0.0) * (f64::from(k) / 32.0);
        let at = |profile: &Profile, tip: &Vec3| {
            let mut tool = Tool::new(profile, Vec3::z());
            tool.depth = 5e-4;
            searched(hills, 1.0, tip, &tool).expect("a clearance")
        };
        let found = at(&whole, &tip);
        let halves = [tip, tip + Vec3::z() * (0.5 * length)].map(|tip| at(&half, &tip));
        let deepest = halves[0].value.min(halves[1].value);
        let error = found.error.max(halves[0].error).max(halves[1].error);
        assert!(error < 2e-8 && (found.value - deepest).abs() <= 2.0 * error, "{k}: {found:?} {halves:?}");
        both += usize::from(halves.iter().all(|half| half.value < -1e-6));
    }
    assert!(both > 16, "{both}");
}

/// A line just inside of the end of a surface comes out over that end sooner than through the surface, under which it is by its deepest place.
#[test]
fn a_line_at_an_end_is_as_deep_as_it_is_over_it() {
    let geometry = hilly();
    let surface = Surface::of(&geometry).expect("a surface");
    let Surface::Ruled(hills) = &surface else { panic!("{surface:?}") };
    let (axis, length) = (Vec3::z(), 1.583_636_278_350_575);
    let tip = Vec3::new(-1.268_606_282_340_864, -0.758_283_156_186_876, -0.445_994_876_275_682_3);
    let (depth, _) = deepest(&surface, &tip, &axis, length);
    let over = way_to_end(&geometry, &tip, &axis, length);
    assert!((depth - 1e-6).abs() < 1e-12 && over < 0.76 * depth, "{depth} {over}");
    let profile = line(length);
    let mut tool = Tool::new(&profile, axis);
    tool.depth = ALLOWED;
    let found = searched(hills, 1.0, &tip, &tool).expect("a clearance");
    assert!(found.error < 1e-8 && (found.value + over).abs() <= found.error, "{found:?} {over}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_line_is_as_deep_as_its_deepest_place(
        which in 0usize..3,
        place in (-0.6..0.6f64, -0.6..0.6f64, -0.6..0.6f64),
        axis in direction(),
        length in 0.3..2.0f64,
        depth in 1e-6..9e-4f64,
    ) {
        let twisted = || ruled(
            section(plane([0.0, 0.0, 1.0], 0.0), [[-3.0, -2.0, 0.0], [3.0, -2.0, 0.0]], [0.0, 0.0, 1.0]),
            section(plane([-1.0, 0.0, 3.0], 0.0), [[-3.0, 2.0, -1.0], [3.0, 2.0, 1.0]], [-1.0, 0.0, 3.0]),
        );
        let waves = || tabulated(
            [Vec3::x(), Vec3::z(), -Vec3::y()],
            &[[-2.0, 0.0, 0.9], [-1.0, 0.3, -0.6], [0.0, -0.2, 0.2], [1.0, 0.3, 0.1], [2.0, -0.1, -0.8]],
        );
        let geometry = [hilly, twisted, waves][which]();
        let surface = Surface::of(&geometry).expect("a surface");
        let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
        let axis = Vec3::from(axis).normalize();
        let mut tip = Vec3::from([place.0, place.1, place.2]) - axis * (0.5 * length);
        for _ in 0..40 {
            let (least, out) = deepest(&surface, &tip, &axis, length);
            tip += out * (least - depth);
        }
        let (depth, _) = deepest(&surface, &tip, &axis, length);
        // What is under the surface by more comes out over the end of it by less.
        let past_end = way_to_end(&geometry, &tip, &axis, length);
        let is_through = depth < past_end;
        let depth = depth.min(past_end);
        prop_assume!(depth > 0.0 && depth < ALLOWED);
        let profile = line(length);
        let mut tool = Tool::new(&profile, axis);
        tool.depth = ALLOWED;
        WORK.set(0);
        let found = searched(ruled, 1.0, &tip, &tool).expect("a clearance");
        let error = found.error + 1e-9;
        prop_assert!((found.value + depth).abs() <= error, "{:?} {}", found, depth);
        prop_assert!(error < 2e-8 && WORK.get() < FEW, "{:?} {}", found, WORK.get());
        // The place that is told is one of the line, and at the surface where that is led out.
        prop_assert!(found.place.is_some() || !is_through, "{:?}", found);
        if let Some(place) = found.place {
            let height = axis.dot(&place);
            prop_assert!((place - axis * height).norm() < 1e-12 && (-1e-9..=length + 1e-9).contains(&height), "{height}");
            let (left, _) = surface.point_distance(&(tip + place - found.normal * found.value)).expect("a distance");
            prop_assert!(left.abs() < 2e-8, "{left} {:?}", found);
        }
    }
}

/// Seen along the rulings a line is straight, and touches waves with a place between its ends: that is told, and not one beside an end.
#[test]
fn a_line_across_rulings_touches_where_it_is_seen_to() {
    let waves = tabulated(
        [Vec3::x(), Vec3::z(), -Vec3::y()],
        &[[-2.0, 0.0, 0.9], [-1.0, 0.3, -0.6], [0.0, -0.2, 0.2], [1.0, 0.3, 0.1], [2.0, -0.1, -0.8]],
    );
    let surface = Surface::of(&waves).expect("a surface");
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    let axis = Vec3::from([0.5901727520218889, -0.8494300250500171, 0.24828331345508783]).normalize();
    let profile = line(1.4396860198722006);
    let mut tool = Tool::new(&profile, axis);
    tool.depth = ALLOWED;
    let tip = Vec3::new(0.04954742267749695, 0.5748333916344147, -0.06707247991107577);
    for depth in [1e-6, -1e-3] {
        let tip = tip + Vec3::z() * (1e-6 - depth);
        let found = searched(ruled, 1.0, &tip, &tool).expect("a clearance");
        let place = found.place.expect("a place");
        let (left, _) =
            surface.point_distance(&(tip + place - found.normal * found.value)).expect("a distance");
        assert!(left.abs() < 2e-8, "{left} {found:?}");
    }
}

//! Tools that all but touch surfaces of patches, and tools that are a little too deep in them.

use apt_geometry::{Vec3, patience::Patience};

use super::{
    super::{
        clearance::{Reading, Surface},
        ruling_clearance::{searched, searched_point},
        tool::{Profile, Tool, WORK},
    },
    cutter, cylinder,
    lofts::{roof, vault},
    plane, ruled, section, tabulated,
};

const UP: [f64; 3] = [0.0, 0.0, 1.0];
/// Parts of surfaces that one search may look at: it gives up after some ten times as many.
const FEW: u64 = 4_000;
/// How deep the tools of these tests may be.
const ALLOWED: f64 = 1e-3;

fn line(length: f64) -> Profile {
    Profile::of(&cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, length])).unwrap()
}

/// What is found without what was known, in few looks.
fn searched_in_few(surface: &Surface, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Reading {
    let Surface::Ruled(ruled) = surface else { panic!("{surface:?}") };
    WORK.set(0);
    let found = searched(ruled, side, tip, tool).expect("there is a distance");
    assert!(WORK.get() < FEW, "{}: {found:?}", WORK.get());
    found
}

/// No place of a hill is deep in a line that goes through it, and neither end of the line is under it.
#[test]
fn a_line_through_a_hill_is_as_deep_as_the_hill_is_high_over_it() {
    let hill =
        tabulated([Vec3::x(), Vec3::y(), Vec3::z()], &[[-2.0, 0.0, 0.0], [0.0, 0.3, 0.0], [2.0, 0.0, 0.0]]);
    let surface = Surface::of(&hill).unwrap();
    for (depth, rise) in [(1e-5, 0.0), (4e-4, 0.0), (1e-5, 0.3), (9e-4, -0.5), (9.99e-4, 0.0), (1e-3, 0.3)] {
        let profile = line(2.0);
        let mut tool = Tool::new(&profile, Vec3::new(1.0, 0.0, rise).normalize());
        tool.depth = ALLOWED;
        let tip = Vec3::new(0.0, 0.3 - depth, 0.0) - tool.axis;
        let found = searched_in_few(&surface, 1.0, &tip, &tool);
        assert!((found.value + depth).abs() <= found.error && found.error < 1e-8, "{depth}: {found:?}");
        assert!((found.normal - Vec3::y()).norm() < 1e-3, "{found:?}");
    }
}

/// A line nearly along a ruling is about as near to the surface all along.
#[test]
fn a_line_along_a_ruling_is_measured_in_few_looks() {
    let floor = plane(UP, 0.0);
    let slope = plane([-1.0, 0.0, 6.0], 6.0);
    let twisted = ruled(
        section(floor, [[0.0; 3], [6.0, 0.0, 0.0]], UP),
        section(slope, [[0.0, 4.0, 1.0], [6.0, 4.0, 2.0]], [-1.0, 0.0, 6.0]),
    );
    let surface = Surface::of(&twisted).unwrap();
    let [foot, along] = [Vec3::new(3.0, 0.5, 0.1875), Vec3::new(0.0, 4.0, 1.5).normalize()];
    let profile = line(3.0);
    for (above, turn) in [(2e-5, 1e-4), (1e-7, 1e-4), (3e-6, -2e-3)] {
        let tool = Tool::new(&profile, (along + Vec3::x() * turn).normalize());
        let tip = foot + Vec3::z() * above;
        let found = searched_in_few(&surface, 1.0, &tip, &tool);
        assert!(found.error < 1e-8 && found.value < above, "{above} {turn}: {found:?}");
        let places = (0..=300).map(|k| {
            let place = tip + tool.axis * (0.01 * f64::from(k));
            surface.point_distance(&place).expect("a distance").0
        });
        let least = places.fold(f64::INFINITY, f64::min);
        assert!((found.value - least).abs() < 1e-7, "{above} {turn}: {found:?} {least}");
    }
}

/// Two places that are close say by their difference where the one leads from the other, rounded; over a long tool that is more than
/// they are apart.
#[test]
fn a_tool_that_all_but_touches_is_measured_to_rounding() {
    for (geometry, side, numbers) in [
        (roof(), 1.0, &[0.5, 0.0][..]),
        (roof(), 1.0, &[0.5, 0.1]),
        (vault(), -1.0, &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]),
        (vault(), -1.0, &[0.5, 0.0]),
    ] {
        let surface = Surface::of(&geometry).unwrap();
        let profile = Profile::of(&cutter(numbers)).unwrap();
        let tool = Tool::new(&profile, Vec3::new(0.02, 0.05, 1.0).normalize());
        let mut tip = Vec3::new(-0.6, 0.4, 5.0);
        let Surface::Ruled(ruled) = &surface else { panic!("{geometry:?}") };
        for _ in 0..60 {
            tip.z -= searched(ruled, side, &tip, &tool).unwrap().value - 2e-6;
        }
        let found = searched_in_few(&surface, side, &tip, &tool);
        assert!((found.value - 2e-6).abs() < 1e-7 && found.error < 2e-8, "{numbers:?}: {found:?}");
    }
}

/// Under a vault a flat tool is too deep on both sides: it would have to be led out farther than it is deep at either.
#[test]
fn a_tool_too_deep_at_two_places_is_as_deep_as_the_deeper() {
    let wall = || cylinder([0.0; 3], UP, 2.0);
    let curve = |z: f64| section(wall(), [[-2.0, 0.0, z], [2.0, 0.0, z]], [0.0, 1.0, 0.0]);
    let surface = Surface::of(&ruled(curve(-1.0), curve(1.0))).unwrap();
    let Surface::Ruled(vault) = &surface else { panic!("{surface:?}") };
    let profile = Profile::of(&cutter(&[2.0, 0.0])).unwrap();
    let mut tool = Tool::new(&profile, -Vec3::y());
    tool.depth = ALLOWED;
    for (depth, aside) in [(1e-4, 0.0), (4e-4, 1e-4), (9e-4, -2e-5)] {
        let tip = Vec3::new(aside, ((2.0 + depth) * (2.0 + depth) - 1.0_f64).sqrt(), 0.1);
        let deepest = (1.0 + aside.abs()).hypot(tip.y) - 2.0;
        let followed = vault.followed(1.0, &tip, &tool).expect("it is shown");
        for found in [followed, searched(vault, 1.0, &tip, &tool).expect("a clearance")] {
            let error = found.error + 2.0 * vault.error() + 1e-9;
            assert!((found.value + deepest).abs() <= error && error < 1e-7, "{found:?} {deepest}");
        }
    }
}

/// Close above a surface that is not known closely the nearest place found is beside the nearest, by more than the point is above it.
#[test]
fn the_direction_to_a_surface_close_by_is_its_normal() {
    let wall = || cylinder([0.0; 3], UP, 2.0);
    let curve = |z: f64| section(wall(), [[-2.0, 0.0, z], [2.0, 0.0, z]], [0.0, 1.0, 0.0]);
    let surface = Surface::within(&ruled(curve(-1.0), curve(1.0)), 1e-7, Patience::default()).unwrap();
    let Surface::Ruled(vault) = &surface else { panic!("{surface:?}") };
    for k in 0..40 {
        let (sine, cosine) = (0.4 + 0.05 * f64::from(k)).sin_cos();
        let normal = Vec3::new(cosine, sine, 0.0);
        let place = normal * (2.0 - 2.5e-5) + Vec3::z() * (0.02 * f64::from(k) - 0.3);
        let found = searched_point(vault, &place).expect("a distance");
        assert!((found.value.abs() - 2.5e-5).abs() < 1e-6, "{k}: {found:?}");
        assert!(found.normal.cross(&normal).norm() < 1e-4, "{k}: {found:?}");
    }
}

/// In a groove a ball touches both walls: what is deep in it at both is as deep as at the deeper.
#[test]
fn a_ball_too_deep_in_both_walls_of_a_groove_is_as_deep_as_in_the_deeper() {
    let groove =
        tabulated([Vec3::x(), Vec3::y(), Vec3::z()], &[[-2.0, 2.0, -2.0], [0.0, 0.0, 0.0], [2.0, 2.0, 2.0]]);
    let surface = Surface::of(&groove).unwrap();
    let Surface::Ruled(ruling) = &surface else { panic!("{surface:?}") };
    for (radius, depth, aside) in [(2.2, 1e-4, 0.0), (2.2, 4e-4, 1e-4), (3.0, 4e-4, 0.0), (3.0, 9e-4, -2e-5)]
    {
        let profile = Profile::of(&cutter(&[2.0 * radius, radius])).unwrap();
        let mut tool = Tool::new(&profile, Vec3::new(0.3, 1.0, 0.2).normalize());
        tool.depth = ALLOWED;
        let mut center = Vec3::new(aside, 4.0, 0.1);
        let apart = |center: &Vec3| surface.point_distance(center).expect("a distance").0;
        for _ in 0..100 {
            center.y -= apart(&center) - radius + depth;
        }
        assert!((apart(&center) - radius + depth).abs() < 1e-12);
        let found = searched(ruling, 1.0, &(center - tool.axis * radius), &tool).expect("a clearance");
        assert!((found.value + depth).abs() <= found.error && found.error < 1e-8, "{depth}: {found:?}");
    }
}

/// No place of the walls is deep in a line across a groove, and no one way leads both its ends out.
#[test]
fn a_line_too_long_for_a_groove_is_as_deep_as_its_deeper_end() {
    let groove =
        tabulated([Vec3::x(), Vec3::y(), Vec3::z()], &[[-2.0, 2.0, -2.0], [0.0, 0.0, 0.0], [2.0, 2.0, 2.0]]);
    let surface = Surface::of(&groove).unwrap();
    let Surface::Ruled(ruling) = &surface else { panic!("{surface:?}") };
    let profile = line(2.0);
    let mut tool = Tool::new(&profile, Vec3::x());
    tool.depth = ALLOWED;
    let depths =
        |tip: &Vec3| [*tip, tip + tool.axis * 2.0].map(|end| -surface.point_distance(&end).unwrap().0);
    for (depth, aside) in [(1e-5, 0.0), (4e-4, 1e-4), (9e-4, -2e-5)] {
        let mut tip = Vec3::new(aside - 1.0, 1.5, 0.1);
        for _ in 0..100 {
            let [first, last] = depths(&tip);
            tip.y += first.max(last) - depth;
        }
        let [first, last] = depths(&tip);
        assert!((first.max(last) - depth).abs() < 1e-12 && first.min(last) > 0.0, "{first} {last}");
        let found = searched(ruling, 1.0, &tip, &tool).expect("a clearance");
        assert!((found.value + depth).abs() <= found.error && found.error < 1e-8, "{depth}: {found:?}");
    }
}

/// Beside an edge of the tool that is a little under the surface, places are as near to one face as to the other.
#[test]
fn an_edge_under_a_surface_is_measured_in_few_looks() {
    let surface = Surface::of(&roof()).unwrap();
    let Surface::Ruled(ruled) = &surface else { panic!("{surface:?}") };
    for numbers in [&[0.5, 0.0][..], &[0.5, 0.0, 0.25, 0.0, 0.0, 7.0, 4.0]] {
        let profile = Profile::of(&cutter(numbers)).unwrap();
        for lean in [0.1, 0.3, 0.6] {
            let mut tool = Tool::new(&profile, Vec3::new(0.3 * lean, lean, 1.0).normalize());
            tool.depth = ALLOWED;
            let mut tip = Vec3::new(-0.6, 0.4, 5.0);
            for _ in 0..60 {
                tip.z -= searched(ruled, 1.0, &tip, &tool).unwrap().value;
            }
            for depth in [8e-4, 1e-6] {
                let found = searched_in_few(&surface, 1.0, &(tip - Vec3::z() * depth), &tool);
                assert!(found.value < -0.5 * depth && found.value > -depth - 1e-7, "{depth}: {found:?}");
                assert!(found.error < 1e-6, "{numbers:?} {lean} {depth}: {found:?}");
            }
        }
    }
}

/// The rim of a flat tool is deepest in a slope where its edge is deepest at several azimuths. What leads it out at one of them that is not the
/// deepest leaves another a little in: it is told as deep as the deepest, and not as the first longer way tried that frees it.
#[test]
fn a_rim_that_must_be_moved_a_little_farther_than_it_is_deep_is_not_told_to_be_much_deeper() {
    let axes = [
        Vec3::new(0.7055810531607777, 0.5693120190786929, -0.42194691888088226),
        Vec3::new(0.3283818745943668, 0.264961406229208, 0.9066205367445248),
        Vec3::new(0.6279496172929938, -0.7782539933348126, 0.0),
    ];
    let nodes = [
        [-1.1098573062753856, 0.6932076328304493, -0.20251370535022767],
        [-0.6098573062753856, 0.6502871704721032, 0.03442355331760414],
        [-0.10985730627538537, 0.7262146940103751, 0.2629327255698933],
        [0.39014269372461474, 0.9024004976181377, 0.4270667965032868],
        [0.8901426937246149, 1.1357081518774947, 0.48664002117744426],
        [1.390142693724615, 1.3690158061368518, 0.4270667965032866],
        [1.890142693724615, 1.5452016097446144, 0.26293272556989344],
    ];
    let surface = Surface::of(&tabulated(axes, &nodes)).unwrap();
    let Surface::Ruled(slope) = &surface else { panic!("{surface:?}") };
    let profile = Profile::of(&cutter(&[0.8639665251625519, 0.0])).unwrap();
    let tool = Tool::new(&profile, Vec3::z());
    let tip = Vec3::new(-0.1383974178039228, 1.8798373433853528, 0.6573351911792578);
    let found = searched(slope, 1.0, &tip, &tool).expect("a clearance");
    let rim = least_over(&surface, tip, [[0.5 * 0.8639665251625519, 0.0]; 2], [1, 1440]);
    assert!((found.value - rim).abs() < 2e-7 && found.error < 1e-8, "{rim} {found:?}");
}

/// The least distance from a surface of places all over a straight part of a tool that stands along z, between two distances from its axis
/// and heights, in so many rows and turns.
fn least_over(surface: &Surface, tip: Vec3, [first, last]: [[f64; 2]; 2], [rows, turns]: [u32; 2]) -> f64 {
    let places = (0..=rows).flat_map(|k| {
        let [radius, height] =
            [0, 1].map(|i| first[i] + f64::from(k) / f64::from(rows) * (last[i] - first[i]));
        (0..turns).map(move |turn| {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(turn) / f64::from(turns)).sin_cos();
            tip + Vec3::new(radius * cosine, radius * sine, height)
        })
    });
    places.map(|place| surface.point_distance(&place).expect("a distance").0).fold(f64::INFINITY, f64::min)
}

/// Where the top of a hill is a little inside of the rim of a flat tool, the rim is as deep on both sides of where it is outermost, and the
/// hill is not as deep in the tool: it is nearer to the flank.
#[test]
fn a_rim_across_the_top_of_a_hill_is_as_deep_as_the_top_is_high_over_it() {
    let hill = tabulated(
        [Vec3::y(), Vec3::z(), Vec3::x()],
        &[[-2.0, -0.3, 0.3], [0.0, 0.0, 0.0], [2.0, -0.3, -0.3]],
    );
    let surface = Surface::of(&hill).unwrap();
    let profile = Profile::of(&cutter(&[1.6, 0.0])).unwrap();
    let mut tool = Tool::new(&profile, Vec3::z());
    tool.depth = 0.06;
    for (depth, inside) in [(0.05, 0.02), (0.05, 0.001), (0.02, 0.01), (0.05, 0.04)] {
        let tip = Vec3::new(0.3, inside - 0.8, -depth);
        let least = least_over(&surface, tip, [[0.0, 0.0], [0.8, 0.0]], [50, 720]);
        assert!((least + depth).abs() < 1e-6, "{least}");
        let found = searched_in_few(&surface, 1.0, &tip, &tool);
        assert!((found.value + depth).abs() <= found.error && found.error < 1e-8, "{depth}: {found:?}");
    }
}

/// Where a ridge along a wall is a little above the rim of a flat tool, the flank is deeper there than the rim, and the ridge is not as deep in
/// the tool: it is nearer to the flat.
#[test]
fn a_flank_across_a_ridge_close_above_its_rim_is_as_deep_as_it_is_there() {
    let ridge = tabulated(
        [Vec3::z(), Vec3::x(), Vec3::y()],
        &[[-2.0, -0.3, 0.3], [0.0, 0.0, 0.0], [2.0, -0.3, -0.3]],
    );
    let surface = Surface::of(&ridge).unwrap();
    for (numbers, flank) in [
        (&[1.6, 0.0][..], [[0.8, 0.0], [0.8, 1.0]]),
        (&[1.6, 0.0, 0.8, 0.0, 0.0, 5.0, 5.0], [[0.8, 0.0], [0.8 + 5f64.to_radians().tan(), 1.0]]),
    ] {
        let profile = Profile::of(&cutter(numbers)).unwrap();
        let mut tool = Tool::new(&profile, Vec3::z());
        tool.depth = 0.06;
        for (depth, above) in [(0.05, 0.02), (0.05, 0.001), (0.02, 0.01), (0.05, 0.04)] {
            let tip = Vec3::new(0.8 - depth, 0.3, -above);
            let least = least_over(&surface, tip, flank, [200, 360]);
            let found = searched_in_few(&surface, 1.0, &tip, &tool);
            assert!((found.value - least).abs() < 1e-6 && found.error < 1e-8, "{least}: {found:?}");
        }
    }
}

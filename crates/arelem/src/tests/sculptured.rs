//! Sculptured surfaces in all roles: against dense samples of their patches, and against surfaces that they are equal to.

use DriveSide::{Left, On as TlOn, Right};
use Relation::{On, Past, To};
use Turn::{Forward, Left as GoLft, Right as GoRgt};
use apt_geometry::{
    canonical::Remembering,
    parametric::{Mesh, Patch, SculpturedSurface},
};
use nalgebra::Vector4;

use super::*;
use crate::{
    section2::StartUpRule,
    verify::{WORK, verify},
};

pub(super) fn made(patches: Vec<Patch>) -> Geometry {
    let surface = SculpturedSurface::assembled(patches, None, Vec::new(), 1.0, Mesh::default());
    Geometry::Sculptured(Remembering::new(surface))
}

/// A hill over the rectangle from 0 to 6 and 0 to 4.5: the patch of the corpus.
pub(super) fn hill() -> Patch {
    let heights = [[0.0, 0.5, 0.8, 0.2], [0.3, 1.4, 1.1, 0.4], [0.2, 1.2, 1.6, 0.5], [0.1, 0.6, 0.7, 0.0]];
    Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| v(2.0 * i as f64, 1.5 * j as f64, heights[j][i]))
    }))
}

/// A hollow of the same outline.
fn dale() -> Patch {
    let turned = hill().points().map(|row| row.map(|p| v(p.x, p.y, 1.5 - p.z)));
    Patch::from_points(&turned)
}

/// A wall of straight lines along z over a cubic through the plane.
fn wall(places: [[f64; 2]; 4]) -> Patch {
    Patch::from_points(&places.map(|[x, y]| std::array::from_fn(|j| v(x, y, 4.0 * j as f64 - 6.0))))
}

/// A quarter of a circle about the origin from an azimuth in degrees, in homogeneous coordinates.
fn quarter(from: f64) -> [[f64; 3]; 4] {
    let w = std::f64::consts::FRAC_1_SQRT_2;
    let at = |degrees: f64| {
        let (s, c) = degrees.to_radians().sin_cos();
        [c, s]
    };
    let ([a, b], [c, d], [m, n]) = (at(from), at(from + 90.0), at(from + 45.0));
    let (third, two) = ((1.0 + 2.0 * w) / 3.0, 2.0 / 3.0);
    [
        [a, b, 1.0],
        [a / 3.0 + two * m, b / 3.0 + two * n, third],
        [c / 3.0 + two * m, d / 3.0 + two * n, third],
        [c, d, 1.0],
    ]
}

/// A quarter of a cylinder about the z axis.
fn round_wall(radius: f64, from: f64) -> Patch {
    let control = quarter(from).map(|[x, y, w]| {
        std::array::from_fn(|j| Vector4::new(radius * x, radius * y, w * (4.0 * j as f64 - 6.0), w))
    });
    Patch { control }
}

/// An eighth of a sphere about the origin: x, y and z positive.
fn eighth(radius: f64) -> Patch {
    let control = quarter(0.0).map(|[r, z, w]| {
        quarter(0.0).map(|[x, y, weight]| {
            Vector4::new(radius * r * x, radius * r * y, radius * z * weight, w * weight)
        })
    });
    Patch { control }
}

/// Least distance of the tool from a patch where that is below it: by dense samples of the patch, seen along a tool with
/// its axis along z.
fn sampled(patch: &Patch, cutter: &[f64], tip: &Vec3) -> f64 {
    let [diameter, corner] = [cutter[0], cutter[1]];
    let reach = 0.5 * diameter - corner;
    let count = 400;
    let mut least = f64::INFINITY;
    for i in 0..=count {
        for j in 0..=count {
            let share = |k: i32| f64::from(k) / f64::from(count);
            let w = patch.evaluate(share(i), share(j)).position - tip;
            // The corner circle, and below its middle the flat.
            let out = (w.xy().norm() - reach).max(0.0);
            least = least.min(out.hypot(w.z - corner) - corner);
        }
    }
    least
}

fn proven(p: &Program) {
    for sequence in &p.sequences {
        let evidence = verify(sequence, &|| false).expect("a verdict");
        assert!(evidence.verified, "{:?}", evidence.violations);
    }
}

#[test]
fn tools_of_all_shapes_pass_over_a_hill_and_a_dale() {
    let shapes = [[0.5, 0.25], [0.5, 0.0], [0.5, 0.1]];
    for (k, ground) in [hill(), dale()].into_iter().enumerate() {
        for cutter in shapes {
            let part = made(vec![ground]);
            let mut p = Program::new();
            p.tolerance(0.001, 0.001).cutter(&cutter).from(1.0, 2.0, 6.0);
            p.go(&[(On, &y(2.0)), (To, &part), (On, &x(1.0))]);
            p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0));
            p.drive(GoLft, &x(5.0), On, &y(3.0)).verified();
            proven(&p);
            let most = if k == 0 { 16 } else { 20 };
            assert!(p.sequences[1].points.len() <= most, "{}", p.sequences[1].points.len());
            // Beside a sharp edge samples are off by a share of their distance.
            if cutter[1] > 0.0 {
                for sequence in &p.sequences {
                    for point in &sequence.points {
                        let gap = sampled(&ground, &cutter, &point.tip);
                        assert!((-0.0011..=0.0015).contains(&gap), "{gap} at {}", point.tip);
                    }
                }
            }
        }
    }
}

#[test]
fn a_patch_in_many_pieces_is_the_same_surface() {
    let mut pieces = vec![hill()];
    for _ in 0..2 {
        pieces = pieces.iter().flat_map(|patch| patch.cut_u(0.45)).flat_map(|p| p.cut_v(0.55)).collect();
    }
    assert_eq!(pieces.len(), 16);
    let [one, many] = [vec![hill()], pieces].map(|patches| {
        let part = made(patches);
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5, 0.1]).from(1.0, 2.0, 6.0);
        p.go(&[(On, &y(2.0)), (To, &part), (On, &x(1.0))]);
        p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0));
        proven(&p);
        p.last().clone()
    });
    assert_eq!(one.points.len(), many.points.len());
    for (a, b) in one.points.iter().zip(&many.points) {
        assert!((a.tip - b.tip).norm() < 1e-6, "{} {}", a.tip, b.tip);
    }
}

/// Runs the same program with two equal surfaces; the ends agree within the band, the vectors to one.
fn same(band: f64, first: &Geometry, second: &Geometry, program: impl Fn(&mut Program, &Geometry)) {
    let [a, b] = [first, second].map(|geometry| {
        let mut p = Program::new();
        p.tolerance(0.0, band);
        program(&mut p, geometry);
        proven(&p);
        (p.tip(), p.last().points.len())
    });
    assert!((a.0 - b.0).norm() <= 1.5 * band, "{} beside {}", a.0, b.0);
    assert!(a.1.abs_diff(b.1) <= 1, "{} beside {} vectors", a.1, b.1);
}

#[test]
fn a_round_wall_is_a_circle_as_drive_and_check_surface() {
    let arc = made([0.0, 90.0].map(|from| round_wall(3.0, from)).to_vec());
    for side in [Left, Right] {
        same(0.001, &circle(0.0, 0.0, 3.0), &arc, |p, wall| {
            // From the side of x to that of y, outside and inside.
            let out = if side == Right { 4.0 } else { 2.0 };
            p.cutter(&[0.5, 0.1]).from(out, 1.0, 1.0);
            p.go(&[(To, wall), (To, &level(0.0)), (On, &y(1.0))]).indirv(0.0, 1.0, 0.0);
            p.side(side).drive(Forward, wall, On, &x(0.5));
        });
    }
    for relation in [To, On, Past] {
        same(0.001, &circle(0.0, 0.0, 3.0), &arc, |p, wall| {
            p.cutter(&[0.5]).from(0.5, 6.0, 0.0).go(&[(On, &x(0.5)), (To, &level(0.0)), (On, &y(6.0))]);
            p.indirv(0.0, -1.0, 0.0).side(TlOn).drive(Forward, &x(0.5), relation, wall);
        });
    }
}

#[test]
fn an_eighth_of_a_sphere_is_a_sphere() {
    same(0.001, &sphere(0.0, 0.0, 0.0, 5.0), &made(vec![eighth(5.0)]), |p, part| {
        p.cutter(&[1.0, 0.2]).from(4.0, 2.0, 8.0).go(&[(On, &y(2.0)), (To, part), (On, &x(3.0))]);
        p.indirv(-1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(1.0));
    });
}

#[test]
fn three_sculptured_surfaces_are_met_at_once() {
    let part = made(vec![hill()]);
    let first = made(vec![wall([[1.0, 0.0], [1.2, 1.3], [1.8, 2.6], [2.0, 4.0]])]);
    let second = made(vec![wall([[0.0, 1.0], [2.0, 1.3], [4.0, 1.1], [6.0, 1.5]])]);
    for relations in [[To, To, To], [On, To, Past], [Past, On, To]] {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(3.0, 3.0, 6.0);
        p.go(&[(relations[0], &first), (relations[1], &part), (relations[2], &second)]).verified();
        proven(&p);
    }
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(3.0, 3.0, 6.0);
    p.go(&[(To, &first), (To, &part), (To, &second)]);
    p.indirv(1.0, 3.0, 0.0).side(Right).drive(Forward, &first, On, &y(3.0));
    p.verified();
    proven(&p);
}

#[test]
fn stock_and_the_tool_end_on_a_hill() {
    let part = made(vec![hill()]);
    let mut p = Program::new();
    p.run(&MotionCommand::Thickness(PerRole { part: 0.3, drive: 0.0, check: [0.0; 2] }));
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(1.0, 2.0, 6.0);
    p.go(&[(On, &y(2.0)), (To, &part), (On, &x(1.0))]);
    p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0));
    for sequence in &p.sequences {
        for point in &sequence.points {
            let gap = sampled(&hill(), &[0.5, 0.25], &point.tip);
            assert!((gap - 0.3).abs() < 0.0015, "{gap}");
        }
    }
    proven(&p);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.0]).from(1.0, 2.0, 6.0);
    p.go(&[(On, &y(2.0)), (On, &part), (On, &x(1.0))]).part_side(PartSide::On);
    p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0));
    let end = hill().evaluate(5.0 / 6.0, 2.0 / 4.5).position;
    p.ends(end.x, end.y, end.z, 0.001).verified();
    proven(&p);
}

/// Distances of parts of surfaces that the verifier may take where it need not search.
const FOLLOWED: u64 = 2000;

#[test]
fn tools_that_band_or_stock_lets_deep_into_a_surface_are_followed_without_a_search() {
    let mut wide = Program::new();
    wide.tolerance(0.05, 0.02).cutter(&[0.5, 0.0]).from(1.0, 2.0, 6.0);
    wide.go(&[(On, &y(2.0)), (To, &made(vec![hill()])), (On, &x(1.0))]);
    wide.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0)).verified();
    // More than all of the tool is behind the wall.
    let bent = made(vec![wall([[0.0, 1.0], [2.0, 1.5], [4.0, 1.5], [6.0, 1.0]])]);
    let mut behind = Program::new();
    behind.run(&MotionCommand::Thickness(PerRole { part: 0.0, drive: -0.1, check: [0.0; 2] }));
    behind.tolerance(0.002, 0.002).cutter(&[0.125, 0.0]).from(1.0, 4.0, 0.5);
    behind.go(&[(To, &bent), (To, &level(0.0)), (On, &x(1.0))]);
    behind.indirv(1.0, 0.0, 0.0).side(Left).drive(Forward, &bent, On, &x(5.0)).verified();
    for (name, program) in [("band", wide), ("stock", behind)] {
        let before = WORK.get();
        proven(&program);
        let cells = WORK.get() - before;
        assert!(cells <= FOLLOWED, "{name}: {cells}");
    }
}

/// Two flat patches that meet over x = 3.
fn ridge() -> Geometry {
    let half = |from: f64, rise: f64, height: f64| {
        Patch::from_points(&std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                v(from + i as f64, 1.5 * j as f64, height + rise * i as f64 - 0.05 * j as f64)
            })
        }))
    };
    made(vec![half(0.0, 0.2, 0.3), half(3.0, -0.2, 0.9)])
}

#[test]
fn a_ball_passes_over_a_ridge() {
    let mut p = Program::new();
    p.tolerance(0.002, 0.002).cutter(&[0.5, 0.25]).from(1.0, 2.0, 6.0);
    p.go(&[(On, &y(2.0)), (To, &ridge()), (On, &x(1.0))]);
    p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0)).verified();
    // One vector up, a few about the ridge, one down.
    let count = p.sequences.last().map(|sequence| sequence.points.len());
    assert!(count.is_some_and(|count| count < 10), "{count:?}");
    proven(&p);
}

#[test]
fn a_motion_goes_on_beyond_the_edge_along_the_tangents() {
    let part = made(vec![hill()]);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(4.0, 2.0, 6.0);
    p.go(&[(On, &y(2.0)), (To, &part), (On, &x(4.0))]);
    p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(6.4)).verified();
    proven(&p);
    let edge = hill().evaluate(1.0, 2.0 / 4.5);
    let beyond = edge.position + edge.du * (0.4 / edge.du.x);
    assert!((p.tip().z - beyond.z).abs() < 0.05, "{} {}", p.tip(), beyond);
}

#[test]
fn the_place_in_the_band_is_that_of_the_dialect() {
    let run = |rule: StartUpRule| {
        let mut p = Program::new();
        p.state.start_up = rule;
        p.tolerance(0.002, 0.002).cutter(&[0.5, 0.25]).from(3.0, 5.0, 0.0);
        let flat = made(vec![wall([[0.0, 1.0], [2.0, 1.0], [4.0, 1.0], [6.0, 1.0]])]);
        p.go(&[(To, &flat), (To, &level(0.0)), (On, &x(3.0))]);
        let start = p.tip().y - 1.25;
        p.run(&MotionCommand::From { position: v(3.0, 5.0, 0.0), axis: None, name: String::new() });
        p.go(&[(On, &x(3.0)), (To, &level(0.0)), (On, &y(5.0))]);
        p.indirv(0.0, -1.0, 0.0).side(TlOn).drive(Forward, &x(3.0), To, &flat).verified();
        proven(&p);
        [start, p.tip().y - 1.25]
    };
    let [start, stop] = run(StartUpRule::Apt4);
    assert!((start - 0.001).abs() < 1e-9 && (stop + 0.001).abs() < 1e-9, "{start} {stop}");
    let [start, stop] = run(StartUpRule::Apt3);
    assert!(start.abs() < 1e-9 && stop.abs() < 1e-9, "{start} {stop}");
}

#[test]
fn stock_counts_for_on_in_apt4() {
    for (rule, moved) in [(StartUpRule::Apt4, 0.1), (StartUpRule::Apt3, 0.0)] {
        let mut p = Program::new();
        p.state.start_up = rule;
        p.run(&MotionCommand::Thickness(PerRole::all(0.1)));
        p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(1.0, 2.0, 6.0);
        p.go(&[(On, &y(2.0)), (To, &level(0.0)), (On, &x(0.0))]).ends(moved, 2.0 - moved, 0.1, 1e-9);
        p.indirv(1.0, 0.0, 0.0).side(TlOn).drive(Forward, &y(2.0), On, &x(5.0));
        p.ends(5.0 - moved, 2.0 - moved, 0.1, 1e-9);
        p.drive(GoRgt, &x(5.0), On, &circle(5.0, -4.0, 2.0)).verified();
        let down = if moved > 0.0 { 2.1_f64 * 2.1 - 0.01 } else { 4.0 };
        p.ends(5.0 - moved, down.sqrt() - 4.0, 0.1, 0.0011);
        proven(&p);
    }
}

/// A wall across the path whose straight continuation, twisted as it is at its corner, is higher than it and ends beside the path.
fn twisted_wall() -> Geometry {
    let rows = [
        [
            [5.086886178336, -0.067498044108, -0.029817293227],
            [5.010975590432, 0.696572816104, -0.076683919703],
            [4.85952042559, 1.357755869049, 0.148942141275],
            [4.799538143442, 1.91530473761, -0.083042070863],
        ],
        [
            [4.886278435588, 0.054975868, 0.637605619478],
            [4.932962218087, 0.645856143338, 0.653909501666],
            [4.910357620453, 1.285559254178, 0.681576604303],
            [5.197913398077, 2.049440818791, 0.705650036374],
        ],
        [
            [4.971341948886, -0.016852575726, 1.334352262612],
            [4.792444884369, 0.68690678254, 1.302521106019],
            [5.107815839906, 1.329956562215, 1.339361846933],
            [4.940949903874, 1.997926476996, 1.370494695432],
        ],
        [
            [5.063862303818, 0.041822935341, 1.936885155271],
            [4.862019130901, 0.729914398933, 1.946620051268],
            [4.809739840324, 1.311793171018, 2.055456507505],
            [5.340333054814, 1.963904060601, 2.10744594404],
        ],
    ];
    made(vec![Patch::from_points(&std::array::from_fn(|i| std::array::from_fn(|j| Vec3::from(rows[j][i]))))])
}

/// The tool passes the corner of what goes on beyond the wall .036 away, on the way from one side of it to the other: what leads away from that
/// end, square to it, is met from the one side only and is no surface to be past of.
#[test]
fn a_tool_that_passes_beside_a_corner_does_not_meet_the_surface() {
    let (path, wall) = (line(0.0, 3.14661, 6.02287, 2.72858), twisted_wall());
    for relation in [To, Past] {
        let mut p = Program::new();
        p.tolerance(0.005, 0.006).cutter(&[0.4329, 0.18788, 0.05242, 0.19175, 3.78236, 8.28166, 10.8745]);
        p.from(0.0, 3.14661, 0.3).go(&[(On, &path), (To, &level(0.3)), (On, &x(0.0))]);
        p.indirv(1.0, 0.0, 0.0).side(TlOn);
        let failure = p.attempt(&motion(Forward, &path, &[(relation, 1, &wall)]));
        assert!(failure.is_err(), "{relation:?} at {}", p.tip());
    }
}

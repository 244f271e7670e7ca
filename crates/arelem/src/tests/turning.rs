//! Motions on which the tool axis follows a surface: the axis is what the law says, and the independent verifier agrees.

use apt_geometry::{
    canonical::Remembering,
    motion::{AxisAngle, ToolAxis},
    surface::Surface,
};
use proptest::prelude::*;

use super::*;
use crate::{
    attitude::Attitude,
    error::AxisFailure,
    position::{self, Condition},
    verify::verify,
};

fn program(cutter: &[f64], mode: ToolAxis) -> Program {
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(cutter).from(-2.0, 0.0, 7.0).run(&MotionCommand::ToolAxis(mode));
    p
}

fn over_the_ball(cutter: &[f64], mode: ToolAxis) -> Program {
    let (ball, middle) = (sphere(0.0, 0.0, 0.0, 5.0), plane(0.0, 1.0, 0.0, 0.0));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let mut p = program(cutter, mode);
    p.go(&[(Relation::On, &middle), (Relation::To, &ball), (Relation::On, &x(-1.0))]);
    p.drive(Turn::Forward, &middle, Relation::On, &x(2.0));
    p
}

pub(super) fn proven(p: &Program) {
    for sequence in &p.sequences {
        let evidence = verify(sequence, &|| false).expect("a judgement");
        assert!(evidence.verified, "{:?}", evidence.violations);
    }
}

#[test]
fn a_tool_normal_to_a_ball_keeps_its_band() {
    for cutter in [&[0.5][..], &[0.5, 0.25], &[0.75, 0.2]] {
        let p = over_the_ball(cutter, ToolAxis::Normal { part: true });
        for point in p.sequences.iter().flat_map(|sequence| &sequence.points) {
            assert!((point.axis - point.tip.normalize()).norm() < 1e-12, "{point:?}");
        }
        assert!(p.last().points.len() > 3);
        proven(&p);
    }
}

#[test]
fn angle_and_lead_hold_at_the_contact_of_a_ball_end() {
    let (angle, lead) = (10f64.to_radians(), 5f64.to_radians());
    let mode = ToolAxis::AtAngle { part: true, angle, mode: AxisAngle::Lead(lead) };
    let p = over_the_ball(&[0.5, 0.25], mode);
    for point in &p.last().points {
        let normal = (point.tip + point.axis * 0.25).normalize();
        assert!((normal.dot(&point.axis) - angle.cos()).abs() < 1e-10, "{point:?}");
        let ahead = Vec3::y().cross(&normal).normalize();
        assert!((ahead.dot(&point.axis) - lead.sin()).abs() < 1e-3, "{point:?}");
        assert!(point.axis.y > 0.0);
    }
    proven(&p);
}

#[test]
fn angles_that_exclude_each_other_are_named() {
    let mode = ToolAxis::AtAngle { part: true, angle: 0.0, mode: AxisAngle::Lead(0.1) };
    let mut p = program(&[0.5], mode);
    let (middle, ball) = (plane(0.0, 1.0, 0.0, 0.0), sphere(0.0, 0.0, 0.0, 5.0));
    let failure = p.attempt(&start(&[(Relation::On, &middle), (Relation::To, &ball)])).expect_err("no axis");
    let MotionFailure::AxisUndetermined { cause: AxisFailure::ImpossibleAngles { .. }, .. } = failure else {
        panic!("{failure:?}")
    };
    assert_eq!(failure.apt3(), Some(859));
}

#[path = "../../tests/support/wave.rs"]
mod wave;

/// A tabulated cylinder whose rulings lie across the x axis.
pub(super) fn waves_across() -> Geometry {
    wave::wave([Vec3::x(), Vec3::z(), -Vec3::y()], 0.0, 0.3)
}

/// Radius of the ball end of the random motions.
const BALL: f64 = 0.25;

/// Part surfaces under a tool that comes from above, without undercuts around the origin.
pub(super) fn part_surface(kind: usize, shape: f64, turn: f64) -> Geometry {
    let along = v(turn.cos(), turn.sin(), 0.0);
    match kind {
        0 => sphere(0.0, 0.0, 0.0, 3.0 + 4.0 * shape),
        1 => cylinder(v(0.0, 0.0, 0.0), along, 3.0 + 4.0 * shape),
        2 => cone(v(-6.0 * along.x, -6.0 * along.y, 6.0), v(along.x, along.y, -0.8 - shape), 40.0),
        3 => quadric([1.0 / 16.0, 1.0 / 25.0, 1.0 / (4.0 + shape), -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        4 => quadric([0.05 * shape, -0.06, 0.0, 0.0, 0.0, 0.0, 0.03, 0.0, 0.0, 0.5]),
        5 => wave::wave([along, Vec3::z(), along.cross(&Vec3::z())], 0.0, 0.1 + 0.3 * shape),
        6 => twisted_strip(shape),
        _ => tube(2.0 + shape),
    }
}

/// A strip whose rulings turn from one curve to the other.
fn twisted_strip(shape: f64) -> Geometry {
    let upper = plane(-shape, 0.0, 6.0, 3.0 + shape);
    let edge = |y: f64, z: [f64; 2], surface: Geometry, across: Vec3| {
        [
            surface,
            Geometry::Point(v(-3.0, y, z[0])),
            Geometry::Point(v(3.0, y, z[1])),
            Geometry::Vector(across),
        ]
    };
    let ends = [-3.0, 3.0].map(|x| (3.0 + shape + shape * x) / 6.0);
    let parts = [
        edge(-3.0, [0.0; 2], plane(0.0, 0.0, 1.0, 0.0), Vec3::z()),
        edge(3.0, ends, upper, v(-shape, 0.0, 6.0)),
    ];
    let surface = apt_geometry::canonical::RuledSurface { parts: parts.concat() };
    Geometry::RuledSurface(Remembering::new(surface))
}

/// The upper quarter of a tube about the x axis from −3 to 3, as a polyconic.
fn tube(radius: f64) -> Geometry {
    let mut values = vec![1.0];
    values.extend([0.0; 12]);
    values.extend([0.0, -3.0, 3.0]);
    let side = radius * std::f64::consts::FRAC_1_SQRT_2;
    for constant in [side, side, side, -side, -side, side, std::f64::consts::FRAC_1_SQRT_2] {
        values.push(constant);
        values.extend([0.0; 7]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// Axis modes by number, with angles in degrees.
fn axis_mode(kind: usize, angle: f64, lead: f64) -> ToolAxis {
    let radians = angle.to_radians();
    match kind {
        0 => ToolAxis::Normal { part: true },
        1 => ToolAxis::AtAngle { part: true, angle: radians, mode: AxisAngle::Plain },
        2 => {
            let mode = AxisAngle::PerpendicularTo(v(0.1, 1.0, 0.2));
            ToolAxis::AtAngle { part: true, angle: radians, mode }
        }
        _ => {
            let lead = lead * angle.abs().to_radians();
            ToolAxis::AtAngle { part: true, angle: radians, mode: AxisAngle::Lead(lead) }
        }
    }
}

/// What the angle conditions ask of an axis, and how far it is from that.
fn misfit(surface: &Surface, drive: &Vec3, mode: &ToolAxis, tip: &Vec3, axis: &Vec3, ahead: &Vec3) -> f64 {
    let above = |p: &Vec3| {
        let normal = surface.foot(p).normal;
        if normal.z < 0.0 { -normal } else { normal }
    };
    let normal = above(&(tip + axis * BALL));
    match mode {
        ToolAxis::AtAngle { angle, mode: AxisAngle::Plain, .. } => (normal.dot(axis) - angle.cos()).abs(),
        ToolAxis::AtAngle { angle, mode: AxisAngle::Lead(lead), .. } => {
            let tangent = normal.cross(drive).normalize();
            let tangent = if tangent.dot(ahead) < 0.0 { -tangent } else { tangent };
            (normal.dot(axis) - angle.cos()).abs().max((tangent.dot(axis) - lead.sin()).abs())
        }
        ToolAxis::AtAngle { angle, mode: AxisAngle::PerpendicularTo(vector), .. } => {
            let vector = vector.normalize();
            let flat = (normal - vector * normal.dot(&vector)).normalize();
            vector.dot(axis).abs().max((flat.dot(axis) - angle.cos()).abs())
        }
        _ => (axis - above(tip)).norm(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// At every position the angles are those asked for; between two of them they are off by no more than the axis turns;
    /// and the verifier proves the bands of the turning tool.
    #[test]
    fn the_axis_keeps_its_angles_and_the_tool_its_bands(
        kind in 0usize..5,
        modes in 0usize..4,
        shape in 0.1..1.0f64,
        turn in -0.5..0.5f64,
        slant in -0.4..0.4f64,
        angle in prop_oneof![-25.0..-3.0f64, 3.0..25.0f64],
        lead in -0.8..0.8f64,
    ) {
        let (part, mode) = (part_surface(kind, shape, turn), axis_mode(modes, angle, lead));
        over_a_surface(&part, mode, slant, [-1.0, 1.2], 1e-9)?;
    }
}

/// One motion over a part surface in a slanted drive plane, from one x to another: angles and bands are held. How exact the
/// angles are depends on the surface.
fn over_a_surface(
    part: &Geometry,
    mode: ToolAxis,
    slant: f64,
    [begin, end]: [f64; 2],
    exact: f64,
) -> Result<(), TestCaseError> {
    let normal = v(-slant.sin(), slant.cos(), 0.0);
    let drive = plane(normal.x, normal.y, normal.z, 0.0);
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[2.0 * BALL, BALL]).from(begin - 2.0, 0.0, 9.0);
    p.run(&MotionCommand::ToolAxis(mode));
    p.go(&[(Relation::On, &drive), (Relation::To, part), (Relation::On, &x(begin))]);
    p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(end));
    let surface = Surface::from_geometry(part).expect("a surface");
    let sequence = p.last();
    let mut from = sequence.start;
    for to in &sequence.points {
        let ahead = to.tip - from.tip;
        // GO comes from elsewhere: its end leads another way than the motion behind it.
        let ends = if from.tip == sequence.start.tip { vec![to] } else { vec![&from, to] };
        for end in ends {
            let off = misfit(&surface, &normal, &mode, &end.tip, &end.axis, &ahead);
            prop_assert!(off <= exact, "{:e} at {:?}", off, end);
        }
        let middle = (from.axis + to.axis).normalize();
        let off = misfit(&surface, &normal, &mode, &((from.tip + to.tip) * 0.5), &middle, &ahead);
        let turned = (to.axis - from.axis).norm();
        prop_assert!(off <= turned + 1e-3, "{:e} between, {:e} turned", off, turned);
        from = *to;
    }
    for sequence in &p.sequences {
        let evidence = verify(sequence, &|| false).expect("a judgement");
        prop_assert!(evidence.verified, "{:?}", evidence.violations);
    }
    Ok(())
}

#[test]
fn angles_hold_over_tabulated_ruled_and_polyconic_surfaces() {
    for kind in 5..8 {
        let (part, mode) = (part_surface(kind, 0.5, 0.2), axis_mode(1, 10.0, 0.0));
        over_a_surface(&part, mode, 0.1, [-0.2, 0.1], 1e-8).expect("angles and bands");
    }
}

#[test]
fn the_axis_turns_over_the_vertex_of_a_cone_in_its_band() {
    // In a plane through the axis of the cone, or past it by less and more than the band; up one side and down the other.
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let hill = cone(v(0.0, 0.0, 3.0), v(0.0, 0.0, -1.0), 60.0);
    for (aside, band, cutter) in [
        (0.0, [0.001, 0.001], &[0.5][..]),
        (0.0, [0.002, 0.0], &[0.5]),
        (0.0, [0.0, 0.002], &[0.5, 0.25]),
        (0.0005, [0.001, 0.001], &[0.5]),
        (0.01, [0.001, 0.001], &[0.5, 0.1]),
    ] {
        let middle = plane(0.0, 1.0, 0.0, aside);
        let mut p = program(cutter, ToolAxis::Normal { part: true });
        p.tolerance(band[0], band[1]);
        p.go(&[(Relation::On, &middle), (Relation::To, &hill), (Relation::On, &x(-1.0))]);
        p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &middle, Relation::On, &x(1.0));
        assert!(p.last().points.len() <= 12, "{} vectors", p.last().points.len());
        let (from, to) = (p.last().start, p.last().points[p.last().points.len() - 1]);
        assert!((from.axis.dot(&to.axis) - 0.5).abs() < 1e-3, "{from:?} {to:?}");
        proven(&p);
    }
}

/// A motion whose lead angle changes its sense turns the tool over a way; where the path comes round again, farther away from its
/// beginning than that, the axis keeps its law.
#[test]
fn an_axis_that_is_turned_at_the_beginning_keeps_its_law_where_the_path_comes_round() {
    let (ground, round) = (ground(), circle(0.0, 4.0, 4.0));
    let (angle, lead) = (12f64.to_radians(), 9f64.to_radians());
    let mode = ToolAxis::AtAngle { part: true, angle, mode: AxisAngle::Lead(lead) };
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[1.0, 0.05]).from(-3.0, 0.0, 7.0).run(&MotionCommand::ToolAxis(mode));
    p.go(&[(Relation::On, &round), (Relation::To, &ground), (Relation::On, &x(-0.5))]);
    p.side(DriveSide::On).indirv(-1.0, 0.0, 0.0).drive(Turn::Forward, &round, Relation::On, &x(3.0));
    let way = &p.last().points;
    assert!(way.iter().any(|point| point.tip.x < -3.9) && p.tip().y > 6.0);
    let off = |at: &ToolPosition| {
        let outward = v(at.tip.x, at.tip.y - 4.0, 0.0).normalize();
        let ahead = outward.cross(&Vec3::z());
        (at.axis.z - angle.cos()).abs().max((ahead.dot(&at.axis) - lead.sin()).abs())
    };
    let turned = way.iter().position(|at| off(at) < 1e-9).expect("it comes to its law");
    assert!(turned > 0 && (way[turned].tip - p.last().start.tip).norm() < 2.0);
    assert!(way[turned..].iter().all(|at| off(at) < 1e-9));
    proven(&p);
}

/// A tool that its first vector turns may come past the check surface by the turn alone, before it is where the motion ends: then it
/// turns over a way, and the motion ends where it is past first.
#[test]
fn a_tool_that_turns_ends_where_it_is_past_the_check_surface_first() {
    let ball = sphere(-0.5858991493893734, 0.8535416991194105, 2.8729941612545753, 3.627872927977972);
    let drive = cylinder(
        v(-1.4952873023039848, 3.8657913373650246, -3.3450402214150268),
        v(0.9964806210222339, 0.06942782116212992, -0.04696966655004395),
        5.781173321117146,
    );
    let first = plane(-0.9902589533122751, -0.012739640138831344, 0.13865391070579455, 0.9676699402234666);
    let check = plane(-0.9907533105068378, -0.09366801862508925, 0.09815385884717687, 0.62960100787479);
    let mode = AxisAngle::Lead(-0.1342937257640657);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.2569590644137996, 0.08861393863057561]);
    p.run(&MotionCommand::From {
        position: v(-0.6476925739791911, -1.4238664167906536, -0.6089063539537972),
        axis: Some(v(0.08373586247729502, -0.8500949540322091, 0.519929682230357)),
        name: String::new(),
    });
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: false, angle: -0.1760417264894469, mode }));
    p.go(&[(Relation::On, &drive), (Relation::To, &ball), (Relation::On, &first)]);
    p.side(DriveSide::On).indirv(0.9902589533122752, 0.012739640138831304, -0.13865391070579464);
    p.drive(Turn::Forward, &drive, Relation::Past, &check);
    proven(&p);
}

/// Where the axis has no direction a correction has none either, and there are no coordinates to look at.
#[test]
fn no_position_is_looked_for_where_there_are_no_coordinates() {
    let surface = Surface::from_geometry(&waves_across()).expect("a surface");
    let gauge =
        Gauge { surface, on: false, side: 1.0, thickness: 0.0, disk: None, memory: Memory::default() };
    let attitude = Attitude::fixed(Tool::new(Cutter::from_numbers(&[0.5], 1.0).expect("cutter"), Vec3::z()));
    let conditions = [Condition::Clearance(&gauge, 0.0), Condition::Plane(Vec3::y(), 0.0)];
    for start in [Vec3::repeat(f64::NAN), v(f64::INFINITY, 0.0, 0.0)] {
        assert!(position::solve(&attitude, &conditions, &start).is_err());
    }
}

/// The clearance of a plane beside the tool bends because that turns, not by itself: vertices lie at the limit away from which the
/// vectors sag, so that all of the band serves them.
#[test]
fn a_tool_that_turns_beside_a_plane_takes_few_vectors() {
    let under = cone(v(2.14, 2.17, 1.91), v(-0.355, -0.322, -0.878), 61.4);
    let beside = plane(0.035, 1.0, 0.0, -0.607);
    let first = plane(-1.0, 0.035, 0.0, 0.147);
    let check = cylinder(v(2.71, 1.13, 3.46), v(-0.29, 0.952, 0.095), 4.2);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[1.0, 0.1875, 0.33, 0.22, 9.5, 5.0, 2.4]).from(-0.185, 0.88, 2.29);
    p.run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: true }));
    p.go(&[(Relation::To, &beside), (Relation::On, &under), (Relation::On, &first)]);
    p.side(DriveSide::Right).part_side(PartSide::On).indirv(-1.0, 0.035, 0.0);
    p.drive(Turn::Forward, &beside, Relation::On, &check);
    assert!(p.last().points.len() <= 5, "{} vectors", p.last().points.len());
    proven(&p);
}

/// A flat cutter leans by little across a direction: where on its rim contact is turns far with a small turn of the normal, so that each
/// normal leads farther from the axis that is looked for.
#[test]
fn a_flat_tool_that_leans_by_little_across_a_direction_finds_its_axis() {
    let beside = plane(0.1, 1.0, 0.0, 0.0);
    for (kind, diameter) in [(1, 1.0), (1, 3.0), (2, 1.0), (2, 3.0)] {
        for degrees in [-3.0, 3.0, 6.0] {
            let mode = AxisAngle::PerpendicularTo(v(0.2, 1.0, 0.1));
            let mode = ToolAxis::AtAngle { part: true, angle: f64::to_radians(degrees), mode };
            let under = part_surface(kind, 0.3, 0.9);
            let mut p = program(&[diameter], mode);
            p.go(&[(Relation::On, &beside), (Relation::To, &under), (Relation::On, &x(-1.0))]);
            p.drive(Turn::Forward, &beside, Relation::On, &x(1.0));
            proven(&p);
        }
    }
}

/// Tool ends of the motions round three leaning walls on a cylinder, with the tool at 85° to each wall, where all of it is turned about
/// the vertical.
fn round_leaning_walls(turn: f64) -> Vec<Vec<Vec3>> {
    let (sine, cosine) = turn.sin_cos();
    let turned = |x: f64, y: f64, z: f64| v(cosine * x - sine * y, sine * x + cosine * y, z);
    let wall = |x, y, z, distance| {
        let normal = turned(x, y, z);
        plane(normal.x, normal.y, normal.z, distance)
    };
    let walls = [
        wall(-0.380825798563, -0.869812776222, -0.313683671029, -2.294204802958),
        wall(0.931215114389, -0.006533551527, -0.364411475447, -3.050868594258),
        wall(-0.432702301652, 0.894529603340, 0.112185145601, -2.542390702683),
    ];
    let beside = wall(-0.916047968087, 0.401068722495, 0.0, -0.415054501693);
    let under = cylinder(v(0.0, 0.0, -25.0), turned(1.0, 0.3, 0.0).normalize(), 25.0);
    let (from, ahead) =
        (turned(1.008345230583, 1.268206841831, 1.5), turned(-0.916047968087, 0.401068722495, 0.0));
    let mut p = Program::new();
    p.tolerance(0.0005, 0.001).cutter(&[0.5, 0.125, 0.125, 0.125, 0.0, 0.0, 2.0]);
    p.from(from.x, from.y, from.z);
    p.go(&[(Relation::To, &walls[0]), (Relation::To, &under), (Relation::On, &beside)]);
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle {
        part: false,
        angle: 85f64.to_radians(),
        mode: AxisAngle::Plain,
    }));
    p.side(DriveSide::Left).indirv(ahead.x, ahead.y, ahead.z);
    let turns = [Turn::Forward, Turn::Left, Turn::Left, Turn::Left];
    let motions = turns.iter().enumerate().map(|(k, turn)| {
        p.drive(*turn, &walls[k % 3], Relation::To, &walls[(k + 1) % 3]);
        let path = p.last();
        std::iter::once(path.start.tip).chain(path.points.iter().map(|point| point.tip)).collect()
    });
    motions.collect()
}

/// How a clearance bends along a vector on which the tool turns is read between its ends: where it leads from one limit of its band to the other, the
/// ends and the extremes, which are the same, tell nothing but rounding, and by that each pose would have vectors of its own.
#[test]
fn a_tool_that_turns_takes_as_many_vectors_however_its_surfaces_lie() {
    let numbers = |turn| round_leaning_walls(turn).iter().map(Vec::len).collect::<Vec<usize>>();
    let first = numbers(0.0);
    for k in 1..12 {
        let numbers = numbers(0.5 * f64::from(k));
        let differ = first.iter().zip(&numbers).any(|(a, b)| a.abs_diff(*b) > 1);
        assert!(!differ, "{first:?} {numbers:?}");
    }
}

/// INTOL and OUTTOL of the motions round leaning walls.
const BAND: f64 = 0.0005 + 0.001;

/// Where the path kinks because the tool comes to touch with another place, vectors of a twentieth of what was left each led up to the kink, the last
/// of no length that the verifier takes for one.
#[test]
fn vectors_of_a_turning_tool_do_not_creep_up_to_a_kink() {
    for k in 0..12 {
        for tips in round_leaning_walls(0.5 * f64::from(k)) {
            let creeping = tips.windows(2).filter(|pair| (pair[1] - pair[0]).norm() < 0.1 * BAND).count();
            assert_eq!(creeping, 0, "{tips:?}");
        }
    }
}

/// Leaning by a degree over a saddle, where the normal under the tool end leads to no axis, it stands to the normal at the place of its rim that is
/// nearest; a tool that is too wide for the saddle comes to where its contact leaps, and is told that.
#[test]
fn a_flat_tool_that_leans_by_a_degree_over_a_saddle_finds_its_axis() {
    let beside = plane(0.1, 1.0, 0.0, 0.0);
    let begun = |diameter, degrees, shape| {
        let mode = AxisAngle::PerpendicularTo(v(0.2, 1.0, 0.1));
        let mode = ToolAxis::AtAngle { part: true, angle: f64::to_radians(degrees), mode };
        let mut p = program(&[diameter], mode);
        p.go(&[
            (Relation::On, &beside),
            (Relation::To, &part_surface(4, shape, 0.0)),
            (Relation::On, &x(-1.0)),
        ]);
        p
    };
    for shape in [0.6, 0.9] {
        let mut p = begun(0.5, 1.0, shape);
        p.drive(Turn::Forward, &beside, Relation::On, &x(1.0));
        proven(&p);
    }
    let onward = motion(Turn::Forward, &beside, &[(Relation::On, 1, &x(1.0))]);
    let failure = begun(3.0, 3.0, 0.9).attempt(&onward).expect_err("too wide a tool");
    let MotionFailure::AxisUndetermined { cause: AxisFailure::Leaps { angle }, .. } = failure else {
        panic!("{failure:?}")
    };
    assert!(angle > 0.05, "{angle}");
}

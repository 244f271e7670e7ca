//! Every axis mode with drive surfaces of every kind, on part and on drive surface: at every position the axis is what its
//! law says, and the independent verifier proves the bands of the turning tool.

use apt_geometry::{
    canonical::{Remembering, RuledSurface},
    motion::{AxisAngle, AxisTangency, ToolAxis},
    surface::Surface,
};
use proptest::prelude::*;

use super::*;
use crate::verify::verify;

/// Radius of the ball end.
const BALL: f64 = 0.25;
/// How exactly the angles hold at the positions.
const EXACT: f64 = 1e-9;

/// Cosine of the angle between the move of a start-up and the motion behind it that is small enough.
const AHEAD: f64 = 0.5;

fn surface(geometry: &Geometry) -> Surface {
    Surface::from_geometry(geometry).expect("a surface")
}

fn proven(p: &Program) -> Result<(), TestCaseError> {
    for sequence in &p.sequences {
        let evidence = verify(sequence, &|| false).expect("a judgement");
        prop_assert!(evidence.verified, "{:?}", evidence.violations);
    }
    Ok(())
}

/// A round hill under a tool that comes from above.
fn hill(kind: usize, shape: f64, turn: f64) -> Geometry {
    let along = v(turn.cos(), turn.sin(), 0.0);
    match kind {
        0 => plane(0.1 * shape, -0.1 * turn, 1.0, 4.0),
        1 => sphere(0.0, 0.0, 0.0, 3.0 + 4.0 * shape),
        2 => cylinder(v(0.0, 0.0, 0.0), along, 3.0 + 4.0 * shape),
        _ => cone(v(-6.0 * along.x, -6.0 * along.y, 6.0), v(along.x, along.y, -0.8 - shape), 40.0),
    }
}

/// A wall that passes the origin at the height of the hills, or a little beside it for a tool TO it.
fn wall(kind: usize, slant: f64, relation: Relation) -> Geometry {
    let beside = if relation == Relation::On { 0.0 } else { 0.8 };
    let normal = v(-slant.sin(), slant.cos(), 0.0);
    let away = |radius: f64| normal * (radius + beside);
    match kind {
        0 => plane(normal.x, normal.y, normal.z, beside),
        1 => cylinder(away(12.0), Vec3::z(), 12.0),
        2 => cone(away(12.0) + Vec3::z() * 30.0, -Vec3::z(), 25f64.atan2(50.0).to_degrees()),
        _ => sphere(away(20.0).x, away(20.0).y, 3.0, 20.0),
    }
}

/// The angle conditions of an axis that stands on a surface: what is left of them.
fn misfit(mode: &ToolAxis, base: &Surface, other: &Surface, tip: &Vec3, axis: &Vec3, ahead: &Vec3) -> f64 {
    let facing = |p: &Vec3| {
        let normal = base.foot(p).normal;
        if normal.dot(axis) < 0.0 { -normal } else { normal }
    };
    let normal = facing(&(tip + axis * BALL));
    match mode {
        ToolAxis::AtAngle { angle, mode: AxisAngle::Plain, .. } => {
            let aside = other.foot(tip).normal;
            // In the plane of both normals.
            let across = normal.cross(&aside).normalize();
            (normal.dot(axis) - angle.cos()).abs().max(across.dot(axis).abs())
        }
        ToolAxis::AtAngle { angle, mode: AxisAngle::Lead(lead), .. } => {
            let tangent = normal.cross(&other.foot(tip).normal).normalize();
            let tangent = if tangent.dot(ahead) < 0.0 { -tangent } else { tangent };
            (normal.dot(axis) - angle.cos()).abs().max((tangent.dot(axis) - lead.sin()).abs())
        }
        ToolAxis::AtAngle { angle, mode: AxisAngle::PerpendicularTo(vector), .. } => {
            let vector = vector.normalize();
            let flat = (normal - vector * normal.dot(&vector)).normalize();
            vector.dot(axis).abs().max((flat.dot(axis) - angle.cos()).abs())
        }
        _ => (axis - facing(tip)).norm(),
    }
}

fn axis_mode(part: bool, kind: usize, angle: f64, lead: f64, across: Vec3) -> ToolAxis {
    let radians = angle.to_radians();
    let mode = match kind {
        0 => return ToolAxis::Normal { part },
        1 => AxisAngle::Plain,
        2 => AxisAngle::PerpendicularTo(across),
        _ => AxisAngle::Lead(lead * angle.abs().to_radians()),
    };
    ToolAxis::AtAngle { part, angle: radians, mode }
}

/// The last motion of a program holds its angles at every position but its start, where the move before it ended.
fn holds(p: &Program, mode: &ToolAxis, base: &Geometry, other: &Geometry) -> Result<(), TestCaseError> {
    let (base, other) = (surface(base), surface(other));
    let mut from = p.last().start.tip;
    for point in &p.last().points {
        let off = misfit(mode, &base, &other, &point.tip, &point.axis, &(point.tip - from));
        prop_assert!(off <= EXACT, "{:e} at {:?}", off, point);
        from = point.tip;
    }
    proven(p)
}

/// Seen from where the tool comes from the axis would tilt the other way than from where the start-up ends.
#[test]
fn a_start_up_tilts_the_axis_as_the_motion_behind_it() {
    let (part, drive) = (hill(3, 0.1, 0.0), wall(1, 0.0, Relation::To));
    let mode = axis_mode(true, 2, -19.657_173_566_075_166, 0.0, v(0.1, 1.0, 0.2));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[2.0 * BALL, BALL]).from(-3.0, 0.0, 9.0);
    p.run(&MotionCommand::ToolAxis(mode));
    p.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &x(-1.0))]);
    p.side(DriveSide::Right).indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(0.8));
    holds(&p, &mode, &part, &drive).expect("its angles");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// On the part surface, along drive surfaces that are curved too, ON them and TO them.
    #[test]
    fn axes_that_follow_the_part_surface_along_any_drive_surface(
        (hills, walls, modes) in (0usize..4, 0usize..4, 0usize..4),
        on in any::<bool>(),
        (shape, turn, slant) in (0.1..1.0f64, -0.5..0.5f64, -0.3..0.3f64),
        angle in prop_oneof![-20.0..-3.0f64, 3.0..20.0f64],
        lead in -0.8..0.8f64,
    ) {
        let relation = if on { Relation::On } else { Relation::To };
        let (part, drive) = (hill(hills, shape, turn), wall(walls, slant, relation));
        let mode = axis_mode(true, modes, angle, lead, v(0.1, 1.0, 0.2));
        let x = |d: f64| plane(1.0, 0.0, 0.0, d);
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[2.0 * BALL, BALL]).from(-3.0, 0.0, 9.0);
        p.run(&MotionCommand::ToolAxis(mode));
        let from = p.tip();
        p.go(&[(relation, &drive), (Relation::To, &part), (Relation::On, &x(-1.0))]);
        // GO takes the sense of a lead angle from its own move: where that changes the first positions are on the way to it.
        let (way, normal) = (p.tip() - from, surface(&part).foot(&p.tip()).normal);
        let along = way - normal * normal.dot(&way);
        prop_assume!(modes != 3 || along.x > AHEAD * along.norm());
        p.side(if on { DriveSide::On } else { DriveSide::Right });
        p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(0.8));
        holds(&p, &mode, &part, &drive)?;
    }

    /// On the drive surface, with the tool end ON a level part surface.
    #[test]
    fn axes_that_follow_the_drive_surface(
        (walls, modes) in (0usize..4, 0usize..4),
        slant in -0.3..0.3f64,
        angle in 20.0..60.0f64,
        lead in -0.5..0.5f64,
    ) {
        let (floor, drive) = (plane(0.0, 0.0, 1.0, 4.0), wall(walls, slant, Relation::To));
        let mode = axis_mode(false, modes, angle, lead, v(1.0, 0.1, 0.2));
        let x = |d: f64| plane(1.0, 0.0, 0.0, d);
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[2.0 * BALL, BALL]).from(-3.0, -3.0, 4.0);
        p.run(&MotionCommand::ToolAxis(mode)).part_side(PartSide::On);
        p.go(&[(Relation::To, &drive), (Relation::On, &floor), (Relation::On, &x(-1.0))]);
        p.side(DriveSide::Right).indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(0.8));
        holds(&p, &mode, &drive, &floor)?;
    }

    /// Along the drive surface: PERPTO, TANDS and FAN.
    #[test]
    fn axes_along_any_drive_surface(
        (walls, modes) in (0usize..4, 0usize..3),
        (slant, height) in (-0.3..0.3f64, prop_oneof![Just(0.0), 0.2..1.0f64]),
    ) {
        let (floor, drive) = (plane(0.0, 0.0, 1.0, 4.0), wall(walls, slant, Relation::To));
        let across = v(1.0, 0.2, 0.1).normalize();
        let mode = [AxisTangency::Across, AxisTangency::PerpendicularTo(across), AxisTangency::Fan][modes];
        let x = |d: f64| plane(1.0, 0.0, 0.0, d);
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[2.0 * BALL, BALL]).from(-3.0, -3.0, 4.0);
        p.run(&MotionCommand::ToolAxis(ToolAxis::Tangent { height, mode })).part_side(PartSide::On);
        p.go(&[(Relation::To, &drive), (Relation::On, &floor), (Relation::On, &x(-1.0))]);
        p.side(DriveSide::Right).indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(0.8));
        let (hill, last) = (surface(&drive), p.last().points.len() - 1);
        for (index, point) in p.last().points.iter().enumerate() {
            let normal = hill.foot(&(point.tip + point.axis * height)).normal;
            let plane = match mode {
                AxisTangency::PerpendicularTo(vector) => vector,
                _ => normal.cross(&Vec3::z()).normalize(),
            };
            let off = point.axis.dot(&normal).abs().max(point.axis.dot(&plane).abs());
            prop_assert!(mode == AxisTangency::Fan && index < last || off <= EXACT, "{:e} at {:?}", off, point);
        }
        proven(&p)?;
    }
}

/// PARLEL on the part and on the drive surface: along the rulings of a wall between two arcs.
#[test]
fn axes_along_the_rulings_of_either_surface() {
    for (part, lower, upper, height, floor) in [(true, 6.0, 5.0, 4.0, 0.3), (false, 7.0, 4.8, 3.5, 0.2)] {
        // Arcs about (3, −6), cut off at x=−1 and x=7.
        let arc = |radius: f64, z: f64| {
            let far = (radius * radius - 16.0f64).sqrt() - 6.0;
            let [first, second] = [-1.0, 7.0].map(|x| Geometry::Point(v(x, far, z)));
            [circle(3.0, -6.0, radius), first, second, Geometry::Vector(Vec3::y())]
        };
        let parts = [arc(lower, 0.0), arc(upper, height)].concat();
        let wall = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
        let Surface::Ruled(sheet) = surface(&wall) else { panic!("not ruled") };
        let level = plane(0.0, 0.0, 1.0, floor);
        let x = |d: f64| plane(1.0, 0.0, 0.0, d);
        let mut p = Program::new();
        p.tolerance(0.01, 0.01).cutter(&[0.5]).from(1.0, 5.0, 0.5);
        p.run(&MotionCommand::ToolAxis(ToolAxis::Parallel { part }));
        if part {
            p.go(&[(Relation::On, &level), (Relation::To, &wall), (Relation::On, &x(2.0))]);
            p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &level, Relation::On, &x(2.4));
        } else {
            p.part_side(PartSide::On);
            p.go(&[(Relation::To, &wall), (Relation::On, &level), (Relation::On, &x(2.0))]);
            p.side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
            p.drive(Turn::Forward, &wall, Relation::On, &x(2.4));
        }
        for point in &p.last().points {
            let ruling = sheet.ruling(&point.tip).expect("a ruling");
            assert!(point.axis.z > 0.5 && point.axis.cross(&ruling).norm() <= EXACT, "{point:?}");
        }
        proven(&p).expect("in its bands");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// A motion that goes back along the way of its start-up leads the other way: the tool turns to that over several vectors
    /// where one cannot turn it, and keeps its bands.
    #[test]
    fn a_lead_angle_whose_sense_changes_is_turned_to_on_the_way(
        (hills, walls, shape) in (0usize..3, 0usize..4, 0.1..1.0f64),
        (angle, lead) in (prop_oneof![-12.0..-4.0f64, 4.0..12.0f64], 0.3..0.8f64),
        corner in prop_oneof![Just(0.0), Just(0.05), Just(BALL)],
        on in any::<bool>(),
    ) {
        let relation = if on { Relation::On } else { Relation::To };
        let (part, drive) = (hill(hills, shape, 0.2), wall(walls, 0.1, relation));
        let mode = axis_mode(true, 3, angle, lead, Vec3::zeros());
        let x = |d: f64| plane(1.0, 0.0, 0.0, d);
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[2.0 * BALL, corner]).from(-3.0, 0.0, 9.0);
        p.run(&MotionCommand::ToolAxis(mode)).run(&MotionCommand::GougeCheck(true));
        p.go(&[(relation, &drive), (Relation::To, &part), (Relation::On, &x(-0.5))]);
        let side = if on { DriveSide::On } else { DriveSide::Left };
        p.side(side).indirv(-1.0, 0.0, 0.0).drive(Turn::Forward, &drive, Relation::On, &x(-2.0));
        proven(&p)?;
        // What a vector tried in vain would have cut is nothing to the path that was found.
        let in_vain = |told: &MotionWarning| matches!(told, MotionWarning::Gouge { ahead: true, .. });
        prop_assert!(!p.warnings.iter().any(in_vain), "{:?}", p.warnings);
        let CutSequence { start, points, .. } = p.last();
        let (last, before) = points.split_last().expect("a path");
        if corner >= BALL {
            let ahead = last.tip - before.last().unwrap_or(start).tip;
            let off = misfit(&mode, &surface(&part), &surface(&drive), &last.tip, &last.axis, &ahead);
            prop_assert!(off <= EXACT, "{off:e}");
        }
    }
}

/// Round a corner the tool leads on in another direction, to which several vectors turn it. The long one behind them sets out as the law wants.
#[test]
fn a_tool_that_turns_on_the_way_follows_its_law_from_there_on() {
    let [first, second, third] = [(0.0, 0.0, 5.0, 0.0), (5.0, 0.0, 5.0, 5.0), (0.0, 5.0, 5.0, 5.0)]
        .map(|(x, y, to_x, to_y)| line(x, y, to_x, to_y));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(-1.0, -1.0, 2.0);
    p.run(&MotionCommand::ToolAxis(axis_mode(true, 3, 10.0, 0.5, Vec3::zeros())));
    p.go(&[(Relation::On, &first), (Relation::To, &ground()), (Relation::On, &line(0.0, 0.0, 0.0, 1.0))]);
    p.side(DriveSide::On).drive(Turn::Right, &first, Relation::On, &second);
    p.drive(Turn::Left, &second, Relation::On, &third);
    proven(&p).expect("its bands");
    let points = &p.last().points;
    let [.., from, to] = &points[..] else { panic!("{points:?}") };
    assert!((to.tip - from.tip).norm() > 4.0, "{points:?}");
    assert!((to.axis - from.axis).norm() <= EXACT, "{points:?}");
}

/// A line has no rim that a turn would move, and a point has nothing.
#[test]
fn tools_without_a_rim_follow_a_lead_angle_whose_sense_changes() {
    let (part, drive) = (hill(0, 0.5, 0.2), wall(0, 0.1, Relation::On));
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    for height in [0.0, 3.0] {
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height]).from(-3.0, 0.0, 9.0);
        p.run(&MotionCommand::ToolAxis(axis_mode(true, 3, 10.0, 0.8, Vec3::zeros())));
        p.go(&[(Relation::On, &drive), (Relation::To, &part), (Relation::On, &x(-0.5))]);
        p.side(DriveSide::On).indirv(-1.0, 0.0, 0.0);
        p.drive(Turn::Forward, &drive, Relation::On, &x(-2.0));
        proven(&p).expect("its bands");
    }
}

/// The tool is to lead along its surfaces in the direction asked for, and the turning of it leads its line of motion 5° beside square to that, and against where it
/// leads: it would lag. No direction is told by that.
#[test]
fn a_direction_is_undetermined_along_whose_line_a_tool_would_lag_that_is_to_lead() {
    let under = quadric([
        0.2216731664572739,
        0.12816411144646148,
        -0.13104751448141272,
        -0.4778112625387658,
        0.0007424099110358122,
        0.12253920069838753,
        -0.11847747798715931,
        0.2230450026647083,
        0.042694259346444614,
        -0.4604954946220663,
    ]);
    let beside = quadric([
        0.008710283615910808,
        0.10507919081536486,
        0.08734415231259045,
        2.290414925587066,
        0.0378454651935523,
        -0.00842948804169592,
        0.022810634156882503,
        0.1626224446298148,
        0.31851337150705306,
        -0.29926478782731514,
    ]);
    let first = plane(0.8672342947798907, -0.2910083658670396, 0.40400347641204876, 0.2174969836634931);
    let asked = v(-0.8672342947798907, 0.29100836586703954, -0.40400347641204876);
    let axis = v(-0.46260021604512136, -0.1708573689574018, 0.8699475843911295);
    let mode = AxisAngle::Lead(0.009901841825494771);
    let mut p = Program::new();
    p.tolerance(2e-5, 3e-5).cutter(&[1.1263232259125482, 0.5631616129562741]);
    let position = v(0.4317465188731032, 1.19646663796058, 0.9262679058735014);
    p.run(&MotionCommand::From { position, axis: Some(axis), name: String::new() });
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: -0.11818544282816922, mode }));
    p.part_side(PartSide::Offset);
    p.go(&[(Relation::To, &beside), (Relation::To, &under), (Relation::On, &first)]);
    p.side(DriveSide::Right).indirv(asked.x, asked.y, asked.z);
    let stop = plane(0.0, 1.0, 0.0, 1.0);
    let failure = p.attempt(&motion(Turn::Forward, &beside, &[(Relation::On, 1, &stop)]));
    assert!(matches!(failure, Err(MotionFailure::DirectionUndetermined { .. })), "{failure:?}");
}

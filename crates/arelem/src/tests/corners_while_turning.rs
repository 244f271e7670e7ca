//! Corners that turn the path by more than a right angle while the axis follows a surface.

use std::cell::Cell;

use apt_geometry::{
    canonical::{Cone, Cylinder, Plane, Remembering, RuledSurface},
    motion::{AxisAngle, AxisTangency, ToolAxis},
};

use super::*;
use crate::{
    attitude::NORMALS,
    clearance::EVALUATIONS,
    error::AxisFailure,
    verify::{Rule, WORK},
};

/// Slope of the legs of both corners, in which a path turns by 127°.
const STEEP: f64 = 2.0;
/// Where motions begin and end, by x.
const AWAY: f64 = 1.0;

fn is_proven(program: &Program) {
    for sequence in &program.sequences {
        let evidence = crate::verify::verify(sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{evidence:?}");
    }
}

/// Along the walls y = s·|x| on a dome, with the axis normal to that or at angles to it across a vector: the walls do not tell it, so that it does not
/// jump in their corner.
#[test]
fn a_tool_normal_to_its_part_surface_goes_on_along_the_other_leg_of_a_corner() {
    let walls = quadric([-STEEP * STEEP, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let dome = sphere(0.0, 0.0, -20.0, 20.0);
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let tilt = 8f64.to_radians();
    for mode in [
        ToolAxis::Normal { part: true },
        ToolAxis::AtAngle { part: true, angle: tilt, mode: AxisAngle::PerpendicularTo(Vec3::x()) },
    ] {
        for cutter in [&[1.0, 0.5][..], &[1.0], &[1.0, 0.2]] {
            let mut program = Program::new();
            program.cutter(cutter).tolerance(0.001, 0.001).from(-2.0, 6.0, 3.0);
            program.run(&MotionCommand::ToolAxis(mode));
            program.go(&[(Relation::To, &walls), (Relation::To, &dome), (Relation::On, &x(-AWAY))]);
            program.side(DriveSide::Left).indirv(1.0, -STEEP, 0.0);
            program.drive(Turn::Forward, &walls, Relation::On, &x(AWAY));
            let mut path = program.last().clone();
            let sharp = path.points.windows(3).position(|at| {
                let [before, beyond] = [at[1].tip - at[0].tip, at[2].tip - at[1].tip];
                before.dot(&beyond) < -0.2 * before.norm() * beyond.norm()
            });
            assert!(program.tip().y > 1.0);
            is_proven(&program);
            // Back along the leg that it came along is another hand.
            let corner = sharp.expect("a corner") + 1;
            let back: Vec<_> = path.points[..corner].iter().rev().copied().collect();
            path.points.truncate(corner + 1);
            path.points.extend(back);
            let evidence = crate::verify::verify(&path, &|| false).expect("evidence");
            assert!(
                evidence.violations.iter().any(|violation| violation.rule == Rule::Progress),
                "{evidence:?}"
            );
        }
    }
}

/// How far the bottom of the trough is above the edge of a sharp one: less than the band, as a tool end ON an edge has no normal.
const ROUNDED: f64 = 0.0008;

/// Through the trough z² = s²x² + h² with the flank along a cone.
#[test]
fn a_tool_along_its_drive_surface_goes_down_one_face_of_a_trough_and_up_the_other() {
    let trough = quadric([-STEEP * STEEP, 0.0, 1.0, -ROUNDED * ROUNDED, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let wall = cone(v(0.0, 0.0, 40.0), v(0.0, 0.0, -1.0), 20.0);
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    for part_side in [PartSide::Offset, PartSide::On] {
        let mut program = Program::new();
        program.cutter(&[1.0, 0.5]).tolerance(0.001, 0.001).from(-AWAY, -16.0, 6.0);
        let mode = AxisTangency::PerpendicularTo(Vec3::x());
        program.run(&MotionCommand::ToolAxis(ToolAxis::Tangent { height: 0.0, mode })).part_side(part_side);
        let relation = if part_side == PartSide::On { Relation::On } else { Relation::To };
        program.go(&[(Relation::To, &wall), (relation, &trough), (Relation::On, &x(-AWAY))]);
        program.side(DriveSide::Right).indirv(1.0, 0.0, -STEEP);
        program.drive(Turn::Forward, &wall, Relation::On, &x(AWAY));
        let lowest = program.last().points.iter().map(|p| p.tip.z).fold(f64::INFINITY, f64::min);
        assert!(program.tip().z > lowest + 1.0);
        is_proven(&program);
    }
}

/// An angle to the part surface is told in the plane of the normals of both surfaces, which jumps in a corner of the walls: on the spot the tool
/// cannot turn.
#[test]
fn an_axis_that_a_corner_tells_ends_the_motion_there() {
    let walls = quadric([-STEEP * STEEP, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let dome = sphere(0.0, 0.0, -20.0, 20.0);
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    let angle = 8f64.to_radians();
    let mut program = Program::new();
    program.cutter(&[1.0, 0.5]).tolerance(0.001, 0.001).from(-2.0, 6.0, 3.0);
    program.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle, mode: AxisAngle::Plain }));
    program.go(&[(Relation::To, &walls), (Relation::To, &dome), (Relation::On, &x(-AWAY))]);
    program.side(DriveSide::Left).indirv(1.0, -STEEP, 0.0);
    let failure = program.attempt(&motion(Turn::Forward, &walls, &[(Relation::On, 1, &x(AWAY))]));
    let Err(MotionFailure::AxisUndetermined { cause: AxisFailure::Leaps { angle: leap }, .. }) = failure
    else {
        panic!("{failure:?}")
    };
    assert!(leap > angle, "{leap}");
}

/// Radius of a hollow cylinder about the x axis, and how far a plane across which a flank comes to lie leans against that.
const HOLLOW: f64 = 2.0;
const LEAN: f64 = 60.0;
/// Corner radius and height of a tool that stands in the hollow, which is higher than its middle.
const CORNER: f64 = 0.5;
const HEIGHT: f64 = 6.0;

/// A tool that stands across a hollow cylinder, its end at (x, s), s along the arc, touches a plane with its corner on one side of s = 0 and with the top
/// of its flank on the other, which goes against its end: x = −1.30 s, x = 3.46 s in the beginning. In between the whole flank lies along the plane.
fn from_corner_to_top(mode: ToolAxis) -> Result<Program, MotionFailure> {
    let hollow = cylinder(Vec3::zeros(), Vec3::x(), HOLLOW);
    let (normal, across) = LEAN.to_radians().sin_cos();
    let wall = plane(across, 0.0, normal, -CORNER);
    let mut program = Program::new();
    program.cutter(&[2.0 * CORNER, CORNER, 0.0, CORNER, 0.0, 0.0, HEIGHT]).tolerance(0.001, 0.001);
    program.run(&MotionCommand::ToolAxis(ToolAxis::Fixed(v(0.0, -0.95, 0.3)))).from(0.9, 1.8, -0.5);
    program.run(&MotionCommand::ToolAxis(mode));
    program.go(&[(Relation::On, &hollow), (Relation::To, &wall), (Relation::On, &level(-0.6))]);
    program.side(DriveSide::On).indirv(-1.3, 0.0, 1.0);
    program.attempt(&motion(Turn::Forward, &hollow, &[(Relation::On, 1, &level(0.2))]))?;
    Ok(program)
}

/// Where a flank comes to lie along a plane a turning tool goes on by its top, away from there and by more than a right angle. The normal is the same
/// all along the flank.
#[test]
fn a_turning_tool_goes_on_by_its_top_where_its_flank_comes_to_lie_along_a_plane() {
    let program = from_corner_to_top(ToolAxis::Normal { part: false }).expect("a path");
    let mut path = program.last().clone();
    let sharp = path.points.windows(3).position(|at| {
        let [before, beyond] = [at[1].tip - at[0].tip, at[2].tip - at[1].tip];
        before.dot(&beyond) < -0.2 * before.norm() * beyond.norm()
    });
    let corner = sharp.expect("a corner") + 1;
    // By the bands, and how steep the legs are.
    assert!((path.points[corner].tip - v(0.0, HOLLOW, 0.0)).norm() < 0.01, "{:?}", path.points[corner]);
    let end = v((HEIGHT - HOLLOW) * LEAN.to_radians().tan() * 0.1, HOLLOW * 0.99f64.sqrt(), 0.2);
    assert!((program.tip() - end).norm() < 0.01, "{:?}", program.tip());
    is_proven(&program);
    // Back along the leg that it came along is another way.
    let back: Vec<_> = path.points[..corner].iter().rev().copied().collect();
    path.points.truncate(corner + 1);
    path.points.extend(back);
    let evidence = crate::verify::verify(&path, &|| false).expect("evidence");
    assert!(evidence.violations.iter().any(|violation| violation.rule == Rule::Progress), "{evidence:?}");
}

/// Beyond such a corner a tool that leads would lag: on the spot it cannot turn.
#[test]
fn a_tool_that_leads_does_not_go_on_against_its_lead() {
    let mode = AxisAngle::Lead(4f64.to_radians());
    let outcome = from_corner_to_top(ToolAxis::AtAngle { part: false, angle: 6f64.to_radians(), mode });
    let failure = outcome.map(|program| program.tip());
    assert!(matches!(failure, Err(MotionFailure::NoAdmissibleVector { .. })), "{failure:?}");
}

/// The corner of a tool whose end is ON a ruled surface, which is where the normal is taken that its axis stands to, comes to where that surface ends, 30
/// units along its extension: beyond, the normal turns within the band, and with it the gradients of clearances do, though the tool touches its drive
/// surface where it did. That is no corner to go back from along the same leg, and the end of the surface is what is told.
#[test]
fn a_path_does_not_go_back_where_its_axis_begins_to_turn_fast() {
    let (mut program, command) = along_a_sheet_that_ends();
    let failure = program.attempt(&command);
    let Err(MotionFailure::AxisUndetermined { cause: AxisFailure::SurfaceEnds { place }, tip }) = failure
    else {
        panic!("{failure:?}");
    };
    assert!((tip.x - 30.45).abs() < 0.02 && (place - tip).norm() < 0.1, "{tip:?} {place:?}");
}

/// Normals of surfaces from which axes are made between two questions whether to go on; each is looked for in some ten microseconds.
const NORMALS_BETWEEN_QUESTIONS: u64 = 100;

#[test]
fn the_axis_asks_often_whether_to_go_on() {
    let (program, command) = along_a_sheet_that_ends();
    let (last, longest) = (Cell::new(NORMALS.get()), Cell::new(0));
    let (asked, limit) = (Cell::new(0), Cell::new(u64::MAX));
    let ask = || {
        longest.set(longest.get().max(NORMALS.get() - last.replace(NORMALS.get())));
        asked.set(asked.get() + 1);
        asked.get() > limit.get()
    };
    execute(&program.state, &command, &ask);
    let longest = longest.get().max(NORMALS.get() - last.get());
    assert!(longest > 0 && longest <= NORMALS_BETWEEN_QUESTIONS, "{longest} normals");
    // What is known of the surface by now is not looked for again.
    asked.set(0);
    execute(&program.state, &command, &ask);
    let all = asked.get();
    for share in [1, all / 3, all / 2, all - 1] {
        asked.set(0);
        limit.set(share);
        let execution = execute(&program.state, &command, &ask);
        assert_eq!(execution.failure, Some(MotionFailure::Cancelled));
        assert_eq!(asked.get(), share + 1, "asked again after the answer");
        let after = NORMALS.get() - last.get();
        assert!(after <= NORMALS_BETWEEN_QUESTIONS, "{after} normals after {share}");
    }
}

/// A motion whose tool end is ON the extension of a ruled surface, beside which its corner comes to the end of that surface.
fn along_a_sheet_that_ends() -> (Program, MotionCommand) {
    let circle = Cylinder {
        point: v(-14.35630129524699, -3.8933251741697523, 12.96210742102925),
        axis: v(0.30491161405061046, 0.8326588237325535, 0.4622858324428429),
        radius: 19.164468276593364,
    };
    let point = |x, y, z| Geometry::Point(v(x, y, z));
    let parts = vec![
        Geometry::Circle(circle),
        point(-4.385084028151377, -1.9716528773345738, -3.565410424083006),
        point(0.6473007203135145, -6.295879547938617, 0.9040601759606537),
        Geometry::Vector(v(0.7150716073289143, 0.12045083475071192, -0.6885958123601245)),
        plane(0.7243104535446746, 0.11243146261906363, -0.6802452007175396, -0.9132377760310463),
        point(-2.5132439109207763, 3.0314371880600257, -0.8324970811519339),
        point(2.4343999716902394, -1.3070637285425752, 3.718576822343696),
        Geometry::Vector(v(0.7243104535446745, 0.11243146261906352, -0.6802452007175398)),
    ];
    let sheet = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    let wall = plane(0.3789386585744906, -0.906776108424816, 0.1848312263328682, 0.6878285780227179);
    let onward = v(0.5590835195209517, 0.38347688614362285, 0.735099378311298);
    let across = |d: f64| plane(onward.x, onward.y, onward.z, d);
    let mut program = Program::new();
    program.cutter(&[0.22128125553126526, 0.030438584899399036]).tolerance(0.0005, 0.0);
    let stock = 0.1592625149369374;
    let all = PerRole { part: stock, drive: stock, check: [stock; 2] };
    program.run(&MotionCommand::Thickness(all)).run(&MotionCommand::MaximumStep(10.0));
    program.from(-1.4604665056778339, -0.7439687138009958, 0.007747177000470007).part_side(PartSide::On);
    let mode = AxisAngle::PerpendicularTo(v(0.3115195945495952, -0.6949686250170459, -0.19548094539225258));
    let angle = -0.055215330133156645;
    program.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle, mode }));
    program.go(&[
        (Relation::To, &wall),
        (Relation::On, &sheet),
        (Relation::On, &across(-0.5297451722314743)),
    ]);
    program.side(DriveSide::Left).indirv(onward.x, onward.y, onward.z);
    (program, motion(Turn::Forward, &wall, &[(Relation::On, 1, &across(100.0))]))
}

/// How far from the place where its flank comes to lie along the wall the tool begins.
const BEFORE: [f64; 4] = [0.1, 0.08, 0.05, 0.03];
/// Radius of a wall so flat that contact goes along all of the flank while the tool end goes no farther than it can in its bands.
const FLAT: f64 = 1000.0;

/// Where the wall bulges, contact goes along the flank steadily, and the path turns by as much within a few bands: bit by bit, so that no vector leads back
/// against the one before, as one that went across the bands would make the next.
#[test]
fn vectors_of_a_turning_tool_lead_round_a_tight_bend_bit_by_bit() {
    let hollow = cylinder(Vec3::zeros(), Vec3::x(), HOLLOW);
    let (normal, across) = LEAN.to_radians().sin_cos();
    let outward = v(across, 0.0, normal);
    let wall = cylinder(-outward * (CORNER + FLAT) - Vec3::y(), outward.cross(&Vec3::y()), FLAT);
    for before in BEFORE {
        let mut program = Program::new();
        program.cutter(&[2.0 * CORNER, CORNER, 0.0, CORNER, 0.0, 0.0, HEIGHT]).tolerance(0.001, 0.001);
        program.run(&MotionCommand::ToolAxis(ToolAxis::Fixed(v(0.0, -0.95, 0.3)))).from(0.9, 1.8, -0.5);
        program.run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: false }));
        program.go(&[(Relation::On, &hollow), (Relation::To, &wall), (Relation::On, &level(-before))]);
        program.side(DriveSide::On).indirv(-1.3, 0.0, 1.0);
        program.drive(Turn::Forward, &hollow, Relation::On, &level(0.2));
        is_proven(&program);
    }
}

/// A line normal to a sphere whose centre is in its drive plane: it comes to touch that with its other end as it goes round. With the law of the axis the
/// gradient of the clearance turns by more than a right angle there while the plane has one normal: the tool is not in a corner, out of which it would go
/// back to where it began.
#[test]
fn a_gradient_that_turns_with_the_law_of_the_axis_tells_no_corner() {
    let outside = sphere(-0.1335107481581279, 0.6096472502428263, 3.164274942020075, 3.030406441596082);
    let beside = plane(0.43876264838657986, 0.5049118141524532, 0.7433380108067078, 2.763119484936581);
    let first = plane(0.5793948010125889, -0.7912605674094979, 0.1954696370856149, 0.22052948627351238);
    let check = quadric([
        0.28753182140552225,
        -0.2794978358567462,
        -0.35616470316855015,
        2.147421129961299,
        -0.7280348945758788,
        0.1198941911343126,
        -0.3844596219707854,
        -1.27249221974237,
        3.1054715548727003,
        0.47385469037019434,
    ]);
    let stock = 0.16175507422664262;
    let mut p = Program::new();
    p.tolerance(0.00002, 0.00003).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.7199976851995995]);
    p.run(&MotionCommand::Thickness(PerRole { part: stock, drive: stock, check: [stock; 2] }));
    p.run(&MotionCommand::MaximumStep(10.0));
    let position = v(1.9250841122325824, 0.977551414152843, 1.2814275556843038);
    let axis = v(-0.6868689852805826, -0.3449214032095981, 0.639718862210225);
    p.run(&MotionCommand::From { position, axis: Some(axis), name: String::new() });
    p.run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: true }));
    p.go(&[(Relation::To, &beside), (Relation::To, &outside), (Relation::Past, &first)]);
    p.side(DriveSide::Right).indirv(0.5793948010125889, -0.791260567409498, 0.195469637085615);
    p.drive(Turn::Forward, &beside, Relation::On, &check);
    is_proven(&p);
}

/// A ball on a polyconic, at an angle to it, whose shank goes along a circle: where the surface goes over into its extension the axis begins to turn
/// faster, and from one vector to the next the gradient of the clearance turns by nearly a right angle while the tool touches where it did. What goes on on
/// the hand of the path from there does not lead away from a place that it touched before, but back.
#[test]
fn a_path_ends_where_the_law_of_its_axis_turns_it_back() {
    let mut values = vec![
        1.0,
        0.9101502007826511,
        0.41427759691319405,
        0.0008274727354061695,
        1.1539621038437857,
        0.395620713155481,
        -0.8697510268438704,
        0.2949871228145078,
        0.6331533200126733,
        0.12292625162123644,
        -0.26815522370422296,
        -0.9555008700480029,
        4.363892168491371,
        0.0,
        0.0,
        6.0,
    ];
    let side = 2.5614133632851703;
    for line in [
        [side, -0.0022457159087851952],
        [side, 0.15696353386444656],
        [side, 0.09670923697600681],
        [-side, 0.1335337472543292],
        [-side, 0.14117131036612124],
        [side, 0.12876675262614823],
        [std::f64::consts::FRAC_1_SQRT_2, -0.03981770054133942],
    ] {
        values.extend(line);
        values.extend([0.0; 6]);
    }
    values.extend([0.0; 7]);
    let sheet = Geometry::PolyConic(Remembering::new(values));
    let wall = circle(0.5566318166924328, 6.035369418816494, 4.709816517579615);
    let onward = v(-0.9689958578670285, 0.24707696662485892, 0.0);
    let stop = cone(v(-3.5, -2.437, 0.279), v(0.958173, 0.284423, 0.031752), 58.963);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.29295114369048486, 0.14647557184524243]);
    p.from(-0.5159759515979716, 1.8287754218638521, 0.3787919499296404);
    let mode = AxisAngle::Plain;
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: 0.08582967140840325, mode }));
    let first = plane(onward.x, onward.y, 0.0, 0.7223896911808979);
    p.go(&[(Relation::To, &wall), (Relation::To, &sheet), (Relation::On, &first)]);
    p.side(DriveSide::Right).indirv(onward.x, onward.y, onward.z);
    let failure = p.attempt(&motion(Turn::Forward, &wall, &[(Relation::To, 1, &stop)]));
    let Err(MotionFailure::NoAdmissibleVector { tip, .. }) = failure else { panic!("{failure:?}") };
    assert!((tip - v(-1.258, 3.315, 0.758)).norm() < 0.01, "{tip:?}");
}

/// A line that is normal to a cone would turn by 139° after a vector as long as its bands: its motion is refused, where there was a path that began
/// in the direction asked for and went the other way.
#[test]
fn a_tool_that_turns_does_not_go_back_before_it_sets_out() {
    let part = Geometry::Line(Plane {
        normal: v(-0.5343743460793172, -0.8452479270913961, 0.0),
        distance: 0.6357116044667622,
    });
    let drive = Geometry::Cone(Cone {
        vertex: v(5.5231110458188954, -1.300375238999532, -0.3543687250096894),
        axis: v(-0.8982866073943273, -0.0897600995187893, 0.4301445053820479),
        cosine: 0.9027600481244357,
    });
    let forward = v(0.8452479270913962, -0.5343743460793171, 0.0);
    let first = plane(forward.x, forward.y, forward.z, 2.011661965962806);
    let stop = cylinder(v(6.31214668561854, -4.829916063429603, 0.0), Vec3::z(), 5.229032495953291);
    let mut program = Program::new();
    program.cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.993760007057072]).tolerance(0.001, 0.001);
    program.run(&MotionCommand::Thickness(PerRole::all(0.0737156786884105)));
    let position = v(0.9969314197742892, -2.071934757457862, 0.4856907693641207);
    program.run(&MotionCommand::From { position, axis: Some(Vec3::z()), name: String::new() });
    program.part_side(PartSide::Offset);
    program.run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: false }));
    program.go(&[(Relation::On, &drive), (Relation::To, &part), (Relation::Past, &first)]);
    program.side(DriveSide::On).indirv(forward.x, forward.y, forward.z);
    let failure = program.attempt(&motion(Turn::Forward, &drive, &[(Relation::Past, 1, &stop)]));
    assert!(matches!(failure, Err(MotionFailure::NoAdmissibleVector { .. })), "{failure:?}");
}

/// A ball that stands on a ruled surface and goes along a plane to where the surface ends, beyond which its axis is not determined.
fn to_where_the_axis_ends() -> (Program, MotionCommand) {
    let axis = v(0.04171936257435866, -0.9770723689353888, -0.20877998143829954);
    let circle = |point: Vec3, radius: f64| Geometry::Circle(Cylinder { point, axis, radius });
    let upward = Geometry::Vector(v(0.00548946338230551, -0.2087346000748351, 0.9779569175190558));
    let point = |x, y, z| Geometry::Point(v(x, y, z));
    let parts = vec![
        circle(v(-2.1076819847381736, 5.901501986919063, -20.322628724632793), 21.642321872459874),
        point(1.8803750231496013, 4.560829362846245, 1.1177092915472269),
        point(-6.112539281220391, 4.225262728549096, 1.090951919777607),
        upward.clone(),
        circle(v(-2.2645174864687627, 11.86510779888122, -48.26313094647003), 49.99999999999999),
        point(2.1306911985957533, -1.301604850766088, -0.13497059708257003),
        point(-5.862223105774239, -1.637171485063237, -0.16172796885218993),
        upward,
    ];
    let part = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    let drive = plane(0.6916356938893817, -0.6653545424661483, -0.2809686810977619, -3.294905573691028);
    let first = plane(-0.7177314459422703, -0.6766026442483131, -0.16453094937369256, 0.08442735827099151);
    let axis = v(-0.9022344294936404, 0.3480446790501688, -0.2546329429220621);
    let stop =
        cylinder(v(-2.6249706537942354, -3.40758155461904, 3.9098534283035007), axis, 4.471901089701513);
    let mut program = Program::new();
    program.cutter(&[0.9573456923828947, 0.47867284619144734]).tolerance(0.0, 0.001);
    program.run(&MotionCommand::MaximumStep(10.0));
    let position = v(-1.5303513365738508, 0.6572782522829063, 1.3718859814188582);
    let axis = Some(v(0.006919387102020796, -0.2432049274500964, 0.9699502489025537));
    program.run(&MotionCommand::From { position, axis, name: String::new() });
    program.part_side(PartSide::Offset).run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: true }));
    program.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::To, &first)]);
    program.side(DriveSide::Right).indirv(0.7177314459422705, 0.676602644248313, 0.16453094937369264);
    (program, motion(Turn::Forward, &drive, &[(Relation::To, 1, &stop)]))
}

/// Clearances that are computed until a motion is refused whose axis ends with the surface that tells it. Vectors of all lengths are tried there, over a
/// thousand of which find a place at the far end of the surface alone: each is looked for again in some tens of clearances, not in more than a hundred.
const UNTIL_THE_AXIS_ENDS: u64 = 80_000;

#[test]
fn a_motion_whose_axis_ends_with_its_surface_is_refused_soon() {
    let (mut program, command) = to_where_the_axis_ends();
    let before = EVALUATIONS.get();
    let failure = program.attempt(&command);
    let computed = EVALUATIONS.get() - before;
    let Err(MotionFailure::AxisUndetermined { cause: AxisFailure::SurfaceEnds { .. }, .. }) = failure else {
        panic!("{failure:?}");
    };
    assert!(computed <= UNTIL_THE_AXIS_ENDS, "{computed} clearances");
}

/// Pieces of work that the verifier may take where the tool comes into a neck and goes back: 820 if it goes on with what takes long where that has shown
/// the last clearance, 67,729 if it searches for the nearest place each time before that.
const WORK_IN_NECK: u64 = 2_000;

/// A drill whose axis lies along a ruled surface comes into a neck of that, over a cylinder. At the last place on the first wall both walls are equally near: the
/// one that is read there is the second wall, which is no reason to take the gradient of that for what the law of the axis makes of the first one.
#[test]
fn a_tool_along_both_walls_of_a_neck_goes_back_along_the_other_one() {
    let part = cylinder(
        v(-1.531788579375378, -0.6329986257844216, -1.6872435554358627),
        v(-0.9958054004224391, -0.05017928807721081, 0.07650910754655225),
        2.1880998726623577,
    );
    let circle = Geometry::Circle(Cylinder {
        point: v(-7.664941349578762, -2.0410522293493774, 1.1634558856667963),
        axis: v(0.2556453100626782, -0.48058824811180395, 0.8388566094510935),
        radius: 7.020967751152781,
    });
    let point = |x, y, z| Geometry::Point(v(x, y, z));
    let parts = vec![
        circle,
        point(-2.6726760017977735, 3.381825183951302, -0.8274422584846908),
        point(-3.047470561494381, -3.6008016274697083, -4.713629573893751),
        Geometry::Vector(v(0.9656348257297104, 0.08488583345269805, -0.2456497071380152)),
        point(0.4034280283362528, -4.136726829266003, 4.656547066069777),
    ];
    let drive = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    let cutter =
        [0.4368422156446608, 0.0, 0.2184211078223304, 0.13124064205481095, 31.0, 0.0, 4.670490640758515];
    let mut p = Program::new();
    p.cutter(&cutter).tolerance(2e-5, 3e-5);
    p.run(&MotionCommand::Thickness(PerRole::all(0.18843201169594356)));
    let axis = Some(v(0.227, -0.473, 0.851));
    let position = v(-1.4, -1.785, 0.42);
    p.run(&MotionCommand::From { position, axis, name: String::new() }).part_side(PartSide::Offset);
    let height = 0.3788663583511529;
    p.run(&MotionCommand::ToolAxis(ToolAxis::Tangent { height, mode: AxisTangency::Across }));
    let first = plane(0.986, 0.166, -0.012, -1.6);
    p.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &first)]);
    p.side(DriveSide::Right).indirv(0.986, 0.166, -0.012);
    p.drive(Turn::Forward, &drive, Relation::On, &plane(0.0, 0.0, 1.0, 0.391));
    assert!((p.tip() - v(-1.295, -1.761, 0.391)).norm() < 0.001, "{:?}", p.tip());
    let before = WORK.get();
    is_proven(&p);
    let work = WORK.get() - before;
    assert!(work <= WORK_IN_NECK, "{work}");
}

/// A ball ON a cone, normal to that, comes with its flank into a neck of what its drive surface leaves it on the cone: narrower than its bands by little, so that a
/// vector leads through to the far wall, along which the path leads back into the neck. There is one contact, which goes along the flank steadily.
#[test]
fn a_tool_that_turns_does_not_go_through_a_neck_to_its_far_wall() {
    let part = Geometry::Cone(Cone {
        vertex: v(1.95487, -4.54162, 3.98643),
        axis: v(-0.41314, 0.90684, 0.08339).normalize(),
        cosine: 0.63082,
    });
    let drive = quadric([
        0.349002, 0.351932, 0.033942, 2.391555, 0.036336, -0.013821, 0.313057, 0.69705, 0.248178, -0.285997,
    ]);
    let mut p = Program::new();
    p.cutter(&[0.52207, 0.261035]).tolerance(0.001, 0.001);
    p.run(&MotionCommand::Thickness(PerRole::all(0.04983)));
    let axis = Some(v(-0.44417, 0.5914, 0.67302));
    p.run(&MotionCommand::From { position: v(1.8674, -0.9933, 1.2921), axis, name: String::new() });
    p.part_side(PartSide::On).run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: true }));
    let first = plane(0.46866, -0.48685, 0.73711, 3.09969);
    p.go(&[(Relation::To, &drive), (Relation::On, &part), (Relation::To, &first)]);
    p.side(DriveSide::Left).indirv(0.46866, -0.48685, 0.73711);
    p.drive(Turn::Forward, &drive, Relation::On, &level(9.0));
    assert!((p.tip() - v(1.3, -1.0, 9.0)).norm() < 0.1, "{:?}", p.tip());
    is_proven(&p);
}

/// A lens normal to its part surface touches its drive surface below, too, where it touches it with its top, and the path turns by 70°. It comes there at the outer limit
/// of its band, out of which the other leg leads: a vector across the band goes before, which tells nothing of where the path comes from.
#[test]
fn a_tool_that_turns_goes_on_out_of_the_limit_of_its_band_in_a_corner() {
    let head = [
        1.0,
        -0.8436888674072904,
        0.5329245222458513,
        -0.06465716203201743,
        1.0550475228721494,
        0.5284026939164295,
        0.8031349758204339,
        -0.2752540711338729,
        0.9802851941849464,
        -0.09476121609004269,
        -0.2663938141228921,
        -0.9591947913339571,
        6.216320082821893,
        0.0,
        0.0,
        6.0,
    ];
    const ROOT: f64 = 3.921723388575551;
    let polynomials = [
        [ROOT, 0.08521630430336413],
        [ROOT, 0.047492969003795515],
        [ROOT, -0.0901601308515448],
        [-ROOT, -0.03788416296033188],
        [-ROOT, 0.029172634838350947],
        [ROOT, 0.028742064932283873],
        [std::f64::consts::FRAC_1_SQRT_2, 0.003432674923117836],
    ];
    let part = super::beyond_ends::poly_conic(&head, polynomials);
    let drive = quadric([
        0.06993443404759773,
        -0.07766284881307076,
        0.005672044516577492,
        1.7328896481270828,
        0.040404595932008236,
        0.02328795214471728,
        0.06901166879483372,
        -0.5242344001507473,
        -0.0996421253015718,
        -0.2244953349070268,
    ]);
    let forward = v(-0.28857903255450285, 0.9562910897260579, -0.047217514551865285);
    let across = |d: f64| plane(forward.x, forward.y, forward.z, d);
    let mut p = Program::new();
    p.cutter(&[1.0, 0.1875, 0.33, 0.22, 6.600892741427102, 5.0, 4.87054589897936]).tolerance(0.001, 0.001);
    let axis = Some(v(-0.07224207880777103, 0.027427612917605027, 0.9970099338016517));
    let position = v(-1.7756073340590843, 2.221524357060035, 0.7818331044905764);
    p.run(&MotionCommand::From { position, axis, name: String::new() });
    p.run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: true })).part_side(PartSide::Offset);
    p.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &across(2.011545252208288))]);
    p.side(DriveSide::Left).indirv(forward.x, forward.y, forward.z);
    p.drive(Turn::Forward, &drive, Relation::On, &across(3.6));
    is_proven(&p);
}

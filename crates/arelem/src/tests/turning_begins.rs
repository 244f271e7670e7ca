//! Where motions begin and end on which the tool axis follows a surface.

use apt_geometry::motion::{AxisAngle, AxisTangency, Delta, ToolAxis};

use super::{turning::proven, *};
use crate::error::Iteration;

fn from(p: &mut Program, position: Vec3, axis: Vec3) {
    p.run(&MotionCommand::From { position, axis: Some(axis), name: String::new() });
}

fn along(p: &mut Program, mode: ToolAxis) {
    p.run(&MotionCommand::ToolAxis(mode));
}

/// What Newton's method and stages do not reach from the start is looked for from places all about, with a tool that turns, too.
#[test]
fn a_position_of_a_tool_that_turns_is_looked_for_all_about() {
    let under = cone(v(2.0045, 3.1579, -0.2887), v(-0.1092, -0.5341, -0.8384), 31.638);
    let beside = quadric([
        0.36853, 0.048695, -0.047037, -0.63292, -0.021936, 0.175615, -0.163765, 0.46393, -0.864212, 0.456155,
    ]);
    let first = plane(-0.69767, -0.47007, -0.54064, 0.13218);
    let mode = AxisAngle::Lead(-0.0557);
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.47866]);
    from(&mut p, v(-0.1762, 1.4315, -1.7272), v(-0.4925, -0.2333, 0.8384));
    along(&mut p, ToolAxis::AtAngle { part: true, angle: 0.27, mode });
    p.go(&[(Relation::To, &beside), (Relation::To, &under), (Relation::Past, &first)]);
    proven(&p);
}

/// To which side an angle about a vector turns the axis is judged where the tool stands in the end: there the motion judges it again.
#[test]
fn the_sense_of_an_angle_is_judged_where_the_start_up_ends() {
    let bowl = sphere(-3.243305698686835, -0.9759428411007164, 4.698820214620849, 3.9623942652541038);
    let through = plane(0.8048105912811022, -0.2023787976224974, 0.5579630224617355, 0.28750092558654355);
    let first = plane(0.16250949001375228, 0.9792854790504659, 0.1207916229561042, -1.5299733680293546);
    let mode = AxisAngle::PerpendicularTo(v(0.7733885830151002, -0.5326568585955873, -0.3366373071518196));
    let mut p = Program::new();
    p.tolerance(0.0, 0.0001).cutter(&[0.7871787556606091, 0.39358937783030457]);
    from(
        &mut p,
        v(-0.6332934049214634, -1.129445196600587, 1.7265006029075272),
        v(-0.5708507491606128, -0.006540091266317751, 0.8210278006188313),
    );
    along(&mut p, ToolAxis::AtAngle { part: true, angle: -0.2891594364248293, mode });
    p.go(&[(Relation::On, &through), (Relation::To, &bowl), (Relation::To, &first)]);
    let ToolPosition { tip, axis } = p.last().points[0];
    let inward =
        v(-3.243305698686835, -0.9759428411007164, 4.698820214620849) - (tip + axis * 0.39358937783030457);
    let across = Vec3::new(0.7733885830151002, -0.5326568585955873, -0.3366373071518196).normalize();
    let flat = (inward - across * inward.dot(&across)).normalize();
    let towards =
        across.cross(&flat).dot(&v(0.8048105912811022, -0.2023787976224974, 0.5579630224617355)).signum();
    // A negative angle leads away from the side to which the normal of the plane points.
    let turned = axis.dot(&across.cross(&flat)) * towards;
    assert!((turned - (-0.2891594364248293f64).sin()).abs() < 1e-6, "{turned} at {tip:?} {axis:?}");
    proven(&p);
}

/// Where the tool would come to stand with its present axis the angle is judged to turn it away from the cone, in which it finds no place then. Tilted to the other
/// side it does, and there it is judged so.
#[test]
fn a_tool_without_a_place_is_tilted_to_the_other_side() {
    let under = quadric([0.04335, -0.15037, 0.0, -0.49648, 0.0, 0.0, -0.04154, 0.15066, -0.08259, 0.0]);
    let inside = cone(v(-1.1062, -1.4947, 2.5864), v(0.79274, 0.56836, 0.22029), 37.168);
    let first = plane(0.3833, 0.80209, -0.45797, -1.0318);
    let mode = AxisAngle::PerpendicularTo(v(-0.10255, -0.67615, -0.90104));
    let angle = -0.23774;
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.4473]);
    from(&mut p, v(2.0767, 0.0672, 2.222), v(0.90227, -0.43118, 0.0));
    along(&mut p, ToolAxis::AtAngle { part: true, angle, mode });
    p.go(&[(Relation::To, &inside), (Relation::On, &under), (Relation::On, &first)]);
    proven(&p);
}

/// Tilted to either side it would be judged to tilt to the other one where it comes to stand, and there is a place with one of them alone.
#[test]
fn a_tool_starts_up_at_the_one_place_that_it_has_however_it_is_tilted_there() {
    let under = cylinder(v(-3.02411, -2.40481, 1.71868), v(-0.08567, 0.15345, -0.98444), 2.40975);
    let above = sphere(-0.49493, -1.66426, 4.98212, 3.47366);
    let first = plane(0.281, -0.95971, 0.0, 1.23039);
    let stop = cone(v(-5.6655, -1.36745, 6.42149), v(0.33262, 0.93903, 0.08712), 59.6142);
    let mode = AxisAngle::Lead(-0.03855);
    let mut p = Program::new();
    p.tolerance(2e-5, 3e-5).cutter(&[0.5015, 0.13935]);
    from(&mut p, v(-0.16086, -1.56996, 1.77915), Vec3::z());
    p.part_side(PartSide::On);
    along(&mut p, ToolAxis::AtAngle { part: false, angle: 0.06488, mode });
    p.go(&[(Relation::On, &above), (Relation::On, &under), (Relation::To, &first)]);
    p.side(DriveSide::On).indirv(-0.281, 0.95971, 0.0);
    p.drive(Turn::Forward, &above, Relation::To, &stop);
    proven(&p);
}

/// A start-up that goes straight at both surfaces leads in no direction along them: TLLFT and TLRGT tell where ahead is.
#[test]
fn the_side_of_the_tool_tells_where_a_lead_angle_leads() {
    let (ground, wall) = (plane(0.0, 0.0, 1.0, 0.0), plane(0.3, 1.0, 0.0, 1.0));
    let lead = 8f64.to_radians();
    let mode = ToolAxis::AtAngle { part: true, angle: 20f64.to_radians(), mode: AxisAngle::Lead(lead) };
    // The tool comes to stand on the side of the wall to which y falls: that is to its right on the way towards x.
    let ahead = v(1.0, -0.3, 0.0).normalize();
    for (side, sense) in [(DriveSide::Right, 1.0), (DriveSide::Left, -1.0)] {
        for start_y in [0.5, -1.7] {
            let mut p = Program::new();
            p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(-2.0, start_y, 5.0).side(side);
            along(&mut p, mode);
            p.go(&[(Relation::To, &wall), (Relation::To, &ground)]);
            let axis = p.last().points[0].axis;
            assert!((axis.dot(&ahead) - sense * lead.sin()).abs() < 1e-9, "{side:?}: {axis:?}");
            proven(&p);
        }
    }
}

/// The last vector turns the tool past the check surface by more than the band: a shorter one does not.
#[test]
fn a_last_vector_that_turns_past_the_check_surface_is_made_shorter() {
    let under = sphere(2.855566662609784, 2.6672771101236776, -3.3020914601848834, 3.662119877238961);
    let beside = sphere(4.669242943977835, -0.826551788583846, 0.6445081439609215, 4.202474088821485);
    let check = quadric([
        -0.5504520033835406,
        0.49646342087886974,
        0.0,
        -2.8638066331879877,
        0.0,
        0.0,
        -0.003876440838087621,
        1.0241023154993663,
        -0.13634808888738228,
        0.0,
    ]);
    let mut p = Program::new();
    p.tolerance(0.00002, 0.00003).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.074627733375481]);
    from(
        &mut p,
        v(1.0963848695938319, 1.4497223665037524, -0.17377610206415683),
        v(-0.4066428732761628, -0.2752208784459985, 0.871145821135084),
    );
    along(&mut p, ToolAxis::Normal { part: true });
    p.go(&[(Relation::To, &beside), (Relation::To, &under)]);
    p.side(DriveSide::Left).indirv(0.46578462914243635, 0.7578471749719099, 0.4568504554465703);
    p.run(&motion(Turn::Forward, &beside, &[(Relation::Past, 2, &check)]));
    proven(&p);
}

/// A tool that turns is led aside from the line of motion of one that does not, here by more than a right angle: the direction asked for
/// tells which way its own line leads.
#[test]
fn a_motion_goes_along_the_line_of_the_turning_tool() {
    let under = quadric([
        0.16453255774755998,
        0.3479284684928868,
        -0.6606304229633305,
        -0.5932255905444932,
        0.4343626851395216,
        0.11302835605140071,
        -0.3046636756790664,
        -0.2790388169030514,
        -0.05696288045497863,
        0.7835360792951901,
    ]);
    let through = quadric([
        0.697950816163661,
        0.41250696444814106,
        0.0,
        3.1234567028706737,
        0.0,
        0.0,
        -0.20560432748309596,
        -0.7321091838619642,
        1.3023769614336946,
        0.0,
    ]);
    let first = plane(0.7633596853232165, -0.30548167127656495, 0.5691774234255224, 1.9465032139246934);
    let check = quadric([
        0.2630667705367127,
        0.23897572157109404,
        0.20809155790225156,
        -3.754637361912372,
        0.3003047625572681,
        0.11705283253464442,
        0.35016778880585425,
        0.40879994608330783,
        -0.738469522744355,
        0.3200455451811559,
    ]);
    let mode = AxisAngle::Plain;
    let mut p = Program::new();
    p.tolerance(0.01, 0.005).cutter(&[0.23486590330520712]);
    from(
        &mut p,
        v(0.24381236897848762, -1.377839021006954, 2.037720249907877),
        v(-0.3715351482823049, -0.9284188890747784, 0.0),
    );
    along(&mut p, ToolAxis::AtAngle { part: false, angle: 0.24268566165159655, mode });
    p.go(&[(Relation::On, &through), (Relation::To, &under), (Relation::On, &first)]);
    p.side(DriveSide::On).indirv(0.7633596853232167, -0.3054816712765648, 0.5691774234255224);
    p.drive(Turn::Forward, &through, Relation::On, &check);
    proven(&p);
}

/// Where the tool touches two surfaces with one normal they are tangent, however it turns on its way.
#[test]
fn surfaces_are_tangent_to_a_tool_that_turns() {
    let rolls = cylinder(v(0.0, 0.0, 0.0), v(1.0, -1.0, 0.0), 5.0);
    let (wall, round) = (plane(0.0, 1.0, 0.0, 0.5), cylinder(v(1.5, 1.5, 0.0), Vec3::z(), 1.0));
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5, 0.25]).from(-2.0, -1.0, 7.0);
    along(&mut p, ToolAxis::Normal { part: true });
    p.go(&[(Relation::To, &wall), (Relation::To, &rolls), (Relation::On, &x(-1.0))]);
    p.side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &wall, Relation::TangentToDrive, &round);
    proven(&p);
    let end = p.last().points.last().expect("a path");
    // It leans to the wall, so that its top touches both.
    let top = end.tip + end.axis * p.last().cutter.height;
    assert!((top.x - 1.5).abs() < 0.01, "{end:?}");
}

/// A tool that stands nearly where its motion ends, with another axis than the last one, does not go back to where it would be at rest on
/// all three surfaces.
#[test]
fn a_motion_that_begins_where_it_ends_does_not_lead_back() {
    let under = quadric([
        0.06080881052224199,
        0.0953689093867015,
        -0.009393482647261787,
        0.7092039882464511,
        -0.040660235717927255,
        0.08360315020248243,
        -0.010076204725353883,
        0.13021433276433708,
        -0.08456902820454418,
        0.48127351310221655,
    ]);
    let beside = plane(-0.49667235254881387, 0.867938116580685, 0.0, 1.0478760598918138);
    let check = cone(
        v(-3.0636503288682553, 2.639558211353319, -3.6484345337861486),
        v(0.8391666541760114, -0.09836877723626238, 0.5349045804478414),
        0.8608141635281971f64.acos().to_degrees(),
    );
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.001]);
    from(&mut p, v(-0.7393000414913327, -0.2636691703315487, -0.35740671177648364), Vec3::z());
    let leaning = v(0.22704057863294977, 0.024328247552203128, 0.9735813843870753);
    for axis in [Vec3::z(), leaning] {
        p.run(&MotionCommand::MultipleAxes(Some(true)));
        along(&mut p, ToolAxis::Fixed(axis));
        p.run(&MotionCommand::PartSurface(NamedSurface { name: String::new(), geometry: under.clone() }));
        p.go(&[(Relation::Past, &beside)]);
        p.side(DriveSide::Left).indirv(0.867938116580685, 0.49667235254881387, 0.0);
        p.drive(Turn::Forward, &beside, Relation::To, &check);
    }
    proven(&p);
}

/// On which side of the drive surface a tool sets out is judged along its own way, which leads aside from that of one that keeps its axis.
#[test]
fn a_tool_that_turns_sets_out_on_its_side_along_its_own_way() {
    let under = Geometry::Circle(apt_geometry::canonical::Cylinder {
        point: v(6.523006419871945, -2.667256594494342, 0.32221582365887524),
        axis: Vec3::z(),
        radius: 5.684912734090713,
    });
    let beside = quadric([
        -0.029934767058678147,
        -0.11790831962167314,
        0.2677255122851713,
        0.04872940268746184,
        0.10464624900684438,
        0.20101747777881535,
        -0.18300312135983182,
        -0.001056993369048076,
        0.9814262296820068,
        -1.2642567243112377,
    ]);
    let first = plane(-0.44239106726779354, -0.7251195880761965, -0.5277231533577712, -1.1216805193115942);
    let mode = AxisAngle::PerpendicularTo(v(0.7548907932041227, 0.6736214674332239, -0.801756523769394));
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.3074574705672753, 0.15372873528363765]);
    from(
        &mut p,
        v(2.4433023353416736, -0.8222116823750495, 0.9259576390973798),
        v(0.8536679554732166, -0.52081764735671, 0.0),
    );
    along(&mut p, ToolAxis::AtAngle { part: true, angle: 0.3443361133256503, mode });
    p.go(&[(Relation::To, &beside), (Relation::To, &under), (Relation::On, &first)]);
    p.side(DriveSide::Left).indirv(0.44239106726779326, 0.7251195880761965, 0.5277231533577714);
    let check = cone(
        v(-0.3461729521372876, 1.4878774403433859, 2.2029754487179685),
        v(0.9354255273774135, -0.06224104636743197, -0.34800163056769623),
        0.9408333443581138f64.acos().to_degrees(),
    );
    p.drive(Turn::Forward, &beside, Relation::Past, &check);
    proven(&p);
}

/// A flank that turns as it passes over the vertex of a pointed cone cuts it off: the place of the tool that is across the vertex from the
/// flank is beside the cone, another one shows that the tool touches it.
#[test]
fn a_tool_that_turns_cuts_the_vertex_of_a_cone_off() {
    let under = cone(
        v(0.8990446581236853, -0.6222196885820392, -0.8278574844021687),
        v(-0.26918916813477095, 0.8860703522573977, -0.3773811370608779),
        20.954_953,
    );
    let beside = Geometry::GeneralConic(Quadric {
        coefficients: [
            0.054961038349246455,
            0.10196640713774714,
            0.0,
            0.7094074039403793,
            0.0,
            0.0,
            -0.074861068740919,
            -0.5934067244794899,
            -0.03660949301048111,
            0.0,
        ],
    });
    let check = plane(0.04469635731605225, -0.9985379350789879, -0.03040111594771851, 0.9218816147000888);
    let across = v(-0.029826884932960714, -0.9889098593788477, 0.14549105456523348);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[
        0.3243518201807389,
        0.0,
        0.16217591009036944,
        0.0,
        0.0,
        4.551907553539284,
        4.406024637239078,
    ]);
    from(&mut p, v(2.1777222063979877, 0.591045313235529, -0.7694598298543578), Vec3::z());
    along(
        &mut p,
        ToolAxis::Tangent { height: 0.36036189430559595, mode: AxisTangency::PerpendicularTo(across) },
    );
    p.go(&[(Relation::To, &beside), (Relation::To, &under)]);
    p.side(DriveSide::Left).indirv(0.1014338080128154, -0.9942568953022319, -0.0341234338246557);
    p.run(&motion(Turn::Forward, &beside, &[(Relation::Past, 1, &check)]));
    proven(&p);
}

/// A start-up plane that the turning tool touches with the edge at its end or with that at its top, either way with too much of it where the
/// others are in the middle of their bands: in the bands there is a position, away from both edges.
#[test]
fn a_tool_that_just_fits_before_a_plane_with_either_end_starts_up() {
    let inside = cone(
        v(2.378244699690608, 3.426918750701597, -0.2703661031833047),
        v(-0.5689669941158946, -0.8211974725078046, -0.043718082683453986),
        22.050_577,
    );
    let through = cylinder(
        v(3.044047171029749, 1.9584202762697545, 0.13805893400332536),
        v(-0.17672688271885237, -0.6626106688698491, 0.7278150248684953),
        4.152024177844269,
    );
    let before = plane(-0.5676675773624443, 0.6925988034895058, 0.4450397948682326, -0.5898503288379341);
    let mut p = Program::new();
    p.tolerance(0.00002, 0.00003).cutter(&[
        0.5593694112501204,
        0.0,
        0.2796847056250602,
        0.16805152535441467,
        31.0,
        0.0,
        3.835184285987133,
    ]);
    from(
        &mut p,
        v(0.4037114752621356, 0.4971009428513178, -1.1344280790324026),
        v(0.029631175896626182, -0.5230443518941269, 0.851790232021145),
    );
    along(&mut p, ToolAxis::Normal { part: true });
    p.go(&[(Relation::On, &through), (Relation::To, &inside), (Relation::To, &before)]);
    proven(&p);
}

/// The direction asked for is square to the line of motion of a tool that keeps its axis, within two degrees, and plainly along that of the tool
/// that turns, whose top moves the more the axis leans.
#[test]
fn a_direction_square_to_the_line_of_a_standing_tool_tells_the_way_of_one_that_turns() {
    let under = plane(-0.2771449100529829, 0.12728297119717094, -0.9523600916013566, 0.03915432951576159);
    let beside = Geometry::Cylinder(Cylinder {
        point: v(3.9030569477006987, -2.5632506164079314, 1.520595151961117),
        axis: v(-0.2854015661730676, -0.7025956508401342, 0.6518476029306914),
        radius: 1.2009516657048602,
    });
    let first = plane(-0.5904749099084426, -0.8044893998514243, 0.06431318912409696, 0.054467903297393074);
    let check = Geometry::Cylinder(Cylinder {
        point: v(5.927721051428652, 4.233038936551539, -1.3960519106043248),
        axis: v(0.028390882985061316, -0.23702368095432913, -0.9710889415651838),
        radius: 5.03500704915614,
    });
    let across = v(0.5251227368305799, 0.7913505811425291, -0.31306607767202005);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[
        0.8139832180798747,
        0.0,
        0.40699160903993736,
        0.2445452301467596,
        31.0,
        0.0,
        2.842937163597618,
    ]);
    from(
        &mut p,
        v(1.2475666744005245, -0.9520719013232368, 0.11736433076906887),
        v(0.2771449100529829, -0.12728297119717089, 0.9523600916013565),
    );
    let mode = AxisTangency::PerpendicularTo(across);
    along(&mut p, ToolAxis::Tangent { height: 0.0, mode });
    p.go(&[(Relation::To, &beside), (Relation::To, &under), (Relation::On, &first)]);
    p.side(DriveSide::Left).indirv(0.5904749099084425, 0.8044893998514242, -0.064313189124097);
    p.drive(Turn::Forward, &beside, Relation::To, &check);
    proven(&p);
}

/// In a corner between walls that lean over the tool it touches the second one at its top: the turn to that wall moves it there by three times as
/// much as its rim, and as long as it turns over a short way its path is a small ring about the place where it begins.
#[test]
fn a_tool_turns_from_one_wall_that_leans_over_it_to_the_next() {
    let (degrees, lean) = (60.0f64, 0.15);
    let (s, c) = degrees.to_radians().sin_cos();
    let first = plane(0.0, 1.0, -lean, 0.0);
    let second = plane(-s, c, -lean, -5.0 * s);
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(1.0, 2.0, 3.0);
    along(&mut p, ToolAxis::Tangent { height: 0.0, mode: AxisTangency::Across });
    p.go(&[(Relation::To, &first), (Relation::To, &ground()), (Relation::On, &x(1.0))]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::Left);
    p.drive(Turn::Forward, &first, Relation::To, &second);
    p.drive(Turn::Left, &second, Relation::On, &plane(c, s, 0.0, 5.0 * c + 6.0));
    proven(&p);
    let ToolPosition { axis, .. } = *p.last().points.last().expect("a position");
    let wanted = v(-s * lean, c * lean, 1.0).normalize();
    assert!((axis - wanted).norm() < 1e-6, "{degrees}: {axis:?}, not {wanted:?}");
}

/// A line whose path is stuck where its first vector turns it, and over ways twice and four times as long as the turn moves its top by, is not turned over
/// one that is longer than the whole motion: its axis would never come to what the angles ask for.
#[test]
fn a_motion_does_not_end_before_the_tool_has_turned_to_its_law() {
    let inside = cylinder(
        v(-3.723810601194795, -2.11639391131639, 0.5277609835461439),
        v(0.44612131669164934, -0.8285288393699624, 0.33840173333712736),
        3.9627167661351934,
    );
    let beside = quadric([
        -0.8369100660129569,
        -0.1588411788966017,
        -0.6392120440608295,
        -0.7736139038241909,
        0.4639013649845452,
        -0.8644869433007294,
        0.5962575458563693,
        -1.2195773479629612,
        1.3656409796742734,
        -1.431198341849646,
    ]);
    let first = plane(0.0782356587835402, -0.9337727252549413, -0.34921007898493656, 1.683645878089568);
    let check = quadric([
        0.18966939335012784,
        0.08265827250089623,
        0.0,
        -0.07538196501745853,
        0.0,
        0.0,
        -0.019886179808828668,
        0.06113104345732671,
        0.2636128246798335,
        0.0,
    ]);
    let (angle, lead) = (0.19681158188589584f64, -0.13545866279160107f64);
    let mode = ToolAxis::AtAngle { part: true, angle, mode: AxisAngle::Lead(lead) };
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.695762185770322]);
    from(
        &mut p,
        v(-1.215679377546171, -1.0754255458390265, -0.8461404070064801),
        v(-0.8367254632996675, -0.25194219863461326, 0.48622590183279424),
    );
    along(&mut p, mode);
    let delta = Delta::Vector(v(0.29463547780255706, 0.05644450570776686, -0.08492120072743528), None);
    p.run(&MotionCommand::GoDelta { delta, name: String::new() });
    p.run(&MotionCommand::MaximumStep(10.0));
    p.go(&[(Relation::To, &beside), (Relation::To, &inside), (Relation::To, &first)]);
    p.side(DriveSide::Right).indirv(-0.07823565878354032, 0.9337727252549413, 0.3492100789849365);
    let failure = p
        .attempt(&motion(Turn::Forward, &beside, &[(Relation::To, 1, &check)]))
        .expect_err("no way on which the tool can turn");
    assert!(
        matches!(failure, MotionFailure::IterationLimit { iteration: Iteration::StepLength, .. }),
        "{failure:?}"
    );
}

/// A ball on a long shank that is through its check surface with the axis that it has, and clear of it with the one that a lead angle asks for: its first
/// vector, as long as MAXDP allows, would turn it out of the surface beyond where the tool that leads comes to it. It turns over a shorter way.
#[test]
fn a_turn_out_of_the_check_surface_does_not_lead_past_where_the_motion_stops() {
    let across = v(0.13151014039434267, -0.9913148253574443, 0.0);
    let under = plane(across.x, across.y, 0.0, -2.082068195370417);
    let beside = plane(0.6180885138109987, 0.7861085097458944, 0.0, 0.6984989367409518);
    let check = quadric([
        0.08258197137363649,
        0.08896968293732799,
        0.0077162050781681936,
        -1.2606723750804263,
        -0.010504358928435644,
        0.021245848576404318,
        0.013483704535462916,
        0.09916395478155207,
        -0.0658725171658136,
        -0.48718665785033194,
    ]);
    let mode = AxisAngle::Lead(-0.11597151091804242);
    let mut p = Program::new();
    p.tolerance(0.0, 0.001).cutter(&[0.2953243045440494, 0.1476621522720247]);
    p.run(&MotionCommand::MaximumStep(10.0));
    from(&mut p, v(-2.1107742249664367, 0.37044587547427843, 0.0652579185459004), across);
    along(&mut p, ToolAxis::AtAngle { part: true, angle: 0.29941376057032976, mode });
    p.run(&MotionCommand::PartSurface(named(&under)));
    p.go(&[(Relation::To, &beside)]);
    p.side(DriveSide::Right).indirv(0.0, 0.0, -1.0).drive(Turn::Forward, &beside, Relation::To, &check);
    proven(&p);
    let end = p.tip();
    assert!((-1.0..-0.2).contains(&end.z), "{end:?}");
}

/// A flat cutter that leans as a sphere tells, with its bottom on one side and its top on the other hardly as long as a start-up plane leaves room for: as
/// near to that as its axis lets it come, 2.4e-5 too deep, there is a position in the bands of a twentieth of a thousandth.
#[test]
fn a_tool_that_its_axis_keeps_from_a_plane_starts_up_within_the_band_of_that() {
    let under = plane(0.5801632476504096, -0.81450021858544, 0.0, 0.8425600728610894);
    let through = sphere(-0.33049354476077575, -0.8316342025904024, -1.7990139085238201, 1.2912381859247988);
    let first = plane(0.13426383932411814, 0.09563526600345804, -0.9863199872994541, 1.1384476731495596);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[1.0241447873281158]);
    let axis = v(0.5842694119715595, -0.811511168980921, -0.00888126419083611);
    from(&mut p, v(1.9403582328301223, -0.6906204394845391, -0.8690781279505521), axis);
    along(&mut p, ToolAxis::Tangent { height: 0.27038662239243005, mode: AxisTangency::Across });
    p.go(&[(Relation::On, &through), (Relation::To, &under), (Relation::Past, &first)]);
    proven(&p);
}

/// Where the line of a tool that turns first lies across the direction asked for, it is not led along its wall with that on its other side.
#[test]
fn a_tool_that_turns_first_keeps_its_drive_surface_on_the_side_that_is_told() {
    let under = sphere(2.109647547158402, 2.676990143388069, 6.865558600621865, 5.842202273540962);
    let beside = cone(
        v(2.531539687390538, 3.314554100823363, 5.215002527799508),
        v(-0.763393800886735, -0.6024993134169456, -0.2328615084117877),
        0.9331550287237954f64.acos().to_degrees(),
    );
    let check = quadric([
        0.20666796662842954,
        0.13569474027655384,
        0.4339925003579399,
        1.7531253223820666,
        -0.2850901602733428,
        0.09660971393477383,
        0.10156979626312539,
        -0.38226686654416475,
        -0.07943013716890238,
        -0.8854623952803515,
    ]);
    let mut p = Program::new();
    p.tolerance(0.0, 0.0001).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.647914351967745]);
    from(
        &mut p,
        v(2.0504323011831507, 1.3969612404035816, 0.8750967182150708),
        v(0.08176385402553156, 0.1294501196592348, 0.9882091573624996),
    );
    let mode = AxisAngle::Lead(0.07742032468033302);
    along(&mut p, ToolAxis::AtAngle { part: true, angle: -0.30201798768207316, mode });
    p.run(&MotionCommand::PartSurface(named(&under))).go(&[(Relation::To, &beside)]);
    p.side(DriveSide::Left).indirv(-0.251835364324169, -0.9566700348051262, 0.14615537547990415);
    let outcome = p.attempt(&motion(Turn::Forward, &beside, &[(Relation::To, 1, &check)]));
    assert!(matches!(outcome, Err(MotionFailure::NoAdmissibleVector { .. })), "{outcome:?}");
}

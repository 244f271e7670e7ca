//! Motions at whose beginning the tool turns to its law over so short a way that it would go round about the place where it
//! began, as often as NUMPTS lets it.

use apt_geometry::motion::{AxisAngle, ToolAxis};

use super::{turning::proven, *};
use crate::clearance::JUDGED;

/// A start-up with an upright tool, and a motion with its axis at an angle to the part surface, in several bands.
fn leads_out(
    cutter: &[f64],
    part: &Geometry,
    place: Vec3,
    (mode, ahead): (ToolAxis, Vec3),
    walls: [&Geometry; 2],
) {
    let [wall, check] = walls;
    for (inside, outside) in [
        (0.001, 0.001),
        (0.002, 0.001),
        (0.001, 0.002),
        (0.0, 0.002),
        (0.002, 0.0),
        (0.003, 0.0),
        (0.0005, 0.0005),
    ] {
        let mut p = Program::new();
        p.tolerance(inside, outside).cutter(cutter).from(place.x, place.y, place.z);
        p.run(&MotionCommand::MultipleAxes(None));
        p.go(&[(Relation::To, wall), (Relation::To, part)]);
        p.run(&MotionCommand::ToolAxis(mode));
        p.side(DriveSide::Right).indirv(ahead.x, ahead.y, ahead.z);
        p.drive(Turn::Forward, wall, Relation::To, check);
        proven(&p);
        let count = p.last().points.len();
        assert!(count < 60, "{count} vectors from {inside} inside to {outside} outside");
    }
}

#[test]
fn a_flat_tool_that_turns_through_the_floor_does_not_go_round_on_its_rim() {
    let floor = plane(-0.21242623939135, 0.15773387165329, 0.96436254518273, -0.19041692435313);
    let wall = plane(0.79906449646592, -0.60109654748196, 0.01337426980932, 6.18233289343896);
    let check = plane(0.22125675991287, 0.97521558959691, 0.0, 13.64976513088494);
    let mode = AxisAngle::Lead(-1.02013275830953f64.to_radians());
    let axis = ToolAxis::AtAngle { part: true, angle: 3.94977184034723f64.to_radians(), mode };
    let (place, ahead) = (v(10.2908840634388, -5.32640433656661, 8.24336834313124), v(0.60115, 0.79914, 0.0));
    leads_out(&[4.48673668626248, 0.78503725497092], &floor, place, (axis, ahead), [&wall, &check]);
}

#[test]
fn a_ball_that_turns_out_from_under_a_leaning_wall_does_not_go_round() {
    let ball = sphere(-0.85764663344714, -6.47192513514756, -93.19214728021103, 93.19214728021103);
    let wall = plane(0.81268888919169, -0.57906266315972, -0.0649861640562, -0.86029836945708);
    let check = plane(0.86558669391269, 0.50075909908988, 0.0, 8.65438285183973);
    let axis =
        ToolAxis::AtAngle { part: true, angle: 6.73166947025627f64.to_radians(), mode: AxisAngle::Plain };
    let (place, ahead) = (v(-0.95693284363318, -9.39082394879633, 8.5438982041032), v(0.58029, 0.81441, 0.0));
    leads_out(&[5.0877964082064, 2.5438982041032], &ball, place, (axis, ahead), [&wall, &check]);
}

/// A ball between two hollow walls has no vector that turns it to its law, nor does any way over which it turns lead on from rings, none of which comes by
/// where the motion began: they are known by coming by another place of them, long before NUMPTS ends them.
#[test]
fn a_ring_that_does_not_come_by_its_beginning_is_known() {
    let part = Geometry::Ellipse(Quadric {
        coefficients: [
            0.10263239893938525,
            0.11405222097328417,
            0.0,
            -0.7100472125010168,
            0.0,
            0.0,
            0.05302915276296229,
            -0.08880412299778531,
            0.09000859984426257,
            0.0,
        ],
    });
    let drive = cylinder(v(-1.9386431902287073, 5.713785108059961, 0.0), Vec3::z(), 7.973649782007439);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.7242105779376009, 0.36210528896880045]);
    p.run(&MotionCommand::From {
        position: v(-1.1297070615906304, -0.18212986010127064, -0.9951309565212969),
        axis: Some(v(0.9573255113971181, 0.28901187731345307, 0.0)),
        name: String::new(),
    });
    let mode = AxisAngle::Lead(-0.12054945666084964);
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: 0.23082206781400508, mode }));
    p.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &level(-0.6657554385397013))]);
    p.side(DriveSide::Left).indirv(0.0, 0.0, -1.0);
    let before = JUDGED.get();
    let failure = p.attempt(&motion(Turn::Forward, &drive, &[(Relation::On, 1, &level(-3.1))])).unwrap_err();
    let judged = JUDGED.get() - before;
    assert!(matches!(failure, MotionFailure::NoAdmissibleVector { .. }), "{failure:?}");
    assert!(judged < 20_000, "{judged} vectors judged");
}

/// A taper ON a cone that leads otherwise where the motion begins than it is to: on ways as short as it takes to turn it goes round and back along its wall, to the check
/// surface on the wrong side of where it began. Over a longer way it comes to that as it is told.
#[test]
fn a_motion_does_not_end_on_the_way_back_of_a_ring() {
    let part = Geometry::Cone(Cone {
        vertex: v(3.8110975551403605, 2.5359790738576153, -1.1167751881603079),
        axis: v(-0.6928859530496179, -0.6163268213390302, 0.3742329560108917),
        cosine: 0.9242573692576926,
    });
    let upward = v(0.49634131858422786, 0.44704167837956243, 0.7441767486677168);
    let drive =
        cylinder(v(-4.433592693078462, 5.144409508893719, 1.295031181864735), upward, 6.283278920094478);
    let forward = v(-0.8282937627671392, -0.5595524968093206, -0.028817457825240013);
    let first = plane(-forward.x, -forward.y, -forward.z, -0.4455099071759528);
    let stop = circle(1.424367338396239, 0.24094898435339607, 1.9910125763839273);
    let mut p = Program::new();
    p.cutter(&[
        0.4404963520216581,
        0.0,
        0.22024817601082905,
        0.0,
        0.0,
        7.548723664649711,
        3.3901287311555417,
    ]);
    p.tolerance(0.0005, 0.0).run(&MotionCommand::Thickness(PerRole::all(0.08165518803440562)));
    let position = v(-5.492354871902694e-5, -1.5521629035918187, -0.14954401230476103);
    let axis = Some(v(-0.09462093991382936, 0.08900084993891791, 0.9915269670765258));
    p.run(&MotionCommand::From { position, axis, name: String::new() }).part_side(PartSide::On);
    let mode = AxisAngle::Lead(-0.049440945417280405);
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: -0.10178205680357472, mode }));
    p.go(&[(Relation::To, &drive), (Relation::On, &part), (Relation::On, &first)]);
    p.side(DriveSide::Left).indirv(forward.x, forward.y, forward.z);
    p.drive(Turn::Forward, &drive, Relation::Past, &stop);
    let path = p.last();
    let mut from = path.start.tip;
    for to in &path.points {
        assert!((to.tip - from).dot(&forward) > 0.0, "{path:?}");
        from = to.tip;
    }
    proven(&p);
}

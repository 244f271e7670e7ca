//! Motions beside the vertex of a double cone, whose two halves are both near: each is a convex body of its own.

use super::{refused::Found, *};

/// Clearances that are far more than such a motion takes, where the path turns from one half to the other in very
/// short vectors.
const AMPLE: u64 = 100_000;

fn is_delivered(motion: &Found) {
    let sequences = motion.run(AMPLE).expect("a path");
    assert_eq!(sequences.len(), 2);
}

/// A double cone that is not round.
const DOUBLE_CONE: [f64; 10] = [
    0.245414826579,
    0.04772340143786691,
    0.28644977251447895,
    2.6485131223127976,
    0.22730383904615914,
    0.0996981828677703,
    -0.005613546785801607,
    0.202565373851894,
    0.6852422339778307,
    0.8650631556868731,
];

/// Stock keeps the rim of a flat cutter .17 from the vertex. It goes along one half to where it touches the other.
#[test]
fn a_rim_comes_from_one_half_of_a_double_cone_to_the_other() {
    let motion = Found {
        cutter: &[0.97877571561787],
        axis: v(0.0, 0.0, 1.0),
        from: v(0.6575331233787957, -0.26719083963716944, -1.2735441603726645),
        band: [2e-5, 3e-5],
        thickness: 0.16625729849249019,
        drive_side: DriveSide::On,
        forward: v(0.03590732184369054, 0.5221976231395327, -0.8520682523280844),
        part: (Relation::To, quadric(DOUBLE_CONE)),
        drive: (
            Relation::On,
            Geometry::Line(Plane {
                normal: v(-0.997644248348417, 0.06859995435364433, 0.0),
                distance: -0.1418806084591761,
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.03590732184369048, -0.5221976231395328, 0.8520682523280846),
                distance: -1.4184304125111922,
            }),
        ),
        stop: (
            Relation::To,
            Geometry::Cylinder(Cylinder {
                point: v(2.2534181874524384, 6.5841865342419394, -8.197038695789622),
                axis: v(0.9179403911711949, -0.38771362435326345, -0.0840451292302563),
                radius: 7.927693588174024,
            }),
        ),
    };
    is_delivered(&motion);
}

/// The same with the round corner of a lens cutter, which the verifier took half a minute for.
#[test]
fn a_lens_cutter_comes_from_one_half_of_a_double_cone_to_the_other() {
    let motion = Found {
        cutter: &[1.0, 0.1875, 0.33, 0.22, 7.011712254515407, 5.0, 4.882547144601999],
        axis: v(0.0, 0.0, 1.0),
        from: v(-1.2499277612468966, -0.22817244792398497, 1.4475848386941195),
        band: [2e-5, 3e-5],
        thickness: 0.08906982474295565,
        drive_side: DriveSide::Left,
        forward: v(0.7575232731284699, 0.6528081576303483, -0.0),
        part: (
            Relation::To,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.03125372959710779,
                    0.28297337658613586,
                    0.9472228725161376,
                    0.7347044457530242,
                    -0.0696996454103021,
                    -0.2951878949608905,
                    -0.09404240211204555,
                    0.2621246171516074,
                    0.13665539951088845,
                    -0.829003740261199,
                ],
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(-1.4268103764479143, -2.30940767246088, 8.911158884276473),
                axis: v(0.6903054662201998, -0.2835925957251609, -0.6656227181792838),
                cosine: 0.7464290271534676,
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.7575232731284699, -0.6528081576303484, 5.885422613690406e-17),
                distance: 1.0794461126862547,
            }),
        ),
        stop: (
            Relation::To,
            Geometry::Cylinder(Cylinder {
                point: v(-4.036920909600535, -2.9134686759805346, 4.545463711033705),
                axis: v(0.6408968342598765, -0.7166116101841951, -0.2751709432060072),
                radius: 7.123154113109574,
            }),
        ),
    };
    is_delivered(&motion);
}

/// Where the flat cutter is about as near to one half as to the other, the contact is found and proven all the same, whatever was
/// known before, and both measures tell the same.
#[test]
fn the_nearer_of_both_halves_is_found_by_both_measures() {
    let halves = quadric(DOUBLE_CONE);
    let role = Role {
        surface: named(&halves),
        relation: Relation::To,
        side: 1.0,
        inside_tolerance: 1.0,
        outside_tolerance: 1.0,
        thickness: 0.16625729849249019,
        disk: None,
    };
    let cutter = Cutter::from_numbers(&[0.97877571561787], 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    let along = v(0.028318108918086067, 0.4118282403016168, -0.9108213794138658);
    let from = v(0.16471189880282575, 0.32716158818868435, -2.799987407072549);
    let known = gauge(&role);
    for k in -20..24 {
        let tip = from + along * (1e-4 * f64::from(k));
        let at = ToolPosition { tip, axis: Vec3::z() };
        let verifier = read_by_verifier(&role, cutter, at);
        for gauge in [&gauge(&role), &known] {
            let (contact, missed) = gauge.contact_within(&tool, &tip, crate::clearance::Enough::ALL);
            assert!((contact.clearance - verifier).abs() < 1e-9, "{k}: {}, {verifier}", contact.clearance);
            assert!(missed < 1e-8, "{k}: {missed}");
        }
    }
}

/// A ball in a hollow cone, with its end on a plane so far beside the vertex, from so far before the bend of its path there to half a unit beyond.
fn beside_hollow_vertex(degrees: f64, band: [f64; 2], back: f64, aside: f64) -> Program {
    let radius = 0.25;
    // The end is in the origin where the ball touches all around.
    let vertex = v(0.0, 0.0, radius - radius / degrees.to_radians().sin());
    let around = cone(vertex, Vec3::z(), degrees);
    let height = back.hypot(aside) / degrees.to_radians().tan();
    let mut p = Program::new();
    p.cutter(&[2.0 * radius, radius]).tolerance(band[0], band[1]).from(-back, aside, height + 0.01);
    p.go(&[(Relation::On, &y(aside)), (Relation::To, &around), (Relation::On, &x(-back))]);
    p.side(DriveSide::On).indirv(1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &y(aside), Relation::On, &x(0.5));
    p
}

/// The path turns by up to 130° within thousandths of where it begins. It sets out along the leg beyond, on the same hand as along the one on which it is.
#[test]
fn a_path_that_begins_in_a_tight_bend_goes_on_along_its_other_leg() {
    for band in [[0.001, 0.001], [0.02, 0.0], [0.0, 0.005]] {
        for aside in [0.0002, 0.0005, 0.001, 0.003] {
            for back in [-0.001, 0.0005, 0.001, 0.003, 0.008] {
                for degrees in (25..=60).step_by(5) {
                    let p = beside_hollow_vertex(f64::from(degrees), band, back, aside);
                    let evidence = crate::verify::verify(p.last(), &|| false).expect("evidence");
                    assert!(evidence.verified, "{degrees} {band:?} {back} {aside}: {evidence:?}");
                    assert!(
                        p.last().points.len() <= 4,
                        "{degrees} {band:?} {back} {aside}: too many vectors"
                    );
                }
            }
        }
    }
}

/// OUTTOL of motions to the vertex of a double cone, at which a line has room within the bands.
const ROOM: [f64; 3] = [0.0001, 0.0002, 0.0005];

/// A line comes along one half to the vertex of a double cone. A vector may lead through between both halves, along the one that it came along, but not to where it
/// touches the other one on the side on which the path would lead back between them.
#[test]
fn a_line_does_not_go_over_to_the_far_side_of_a_vertex() {
    let circle = Geometry::Circle(Cylinder {
        point: v(-5.473810895079573, -0.12561754112751777, 0.5290975733407559),
        axis: Vec3::z(),
        radius: 6.489609615074528,
    });
    let halves = quadric([
        0.06360716809982382,
        0.017941084687075913,
        0.020792750223062303,
        -0.010928173286468001,
        -0.08529634436706643,
        -0.08164547725747308,
        -0.06465403128843632,
        0.1614927534237177,
        -0.017955342750191658,
        0.19174821276626303,
    ]);
    let forward = v(-0.14706244549036745, 0.9784004692704921, -0.14527614689849694);
    let first = plane(-forward.x, -forward.y, -forward.z, -0.6052224984061589);
    let upward = v(0.41989206735702095, 0.2197186539859122, 0.8805761550605752);
    let stop =
        cylinder(v(0.5711347998316549, 4.495742217125812, -0.1453345033895691), upward, 1.6451672376657884);
    for outside in ROOM {
        let mut p = Program::new();
        p.cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.1523111156921084]).tolerance(0.0005, outside);
        let axis = Some(v(-0.9984264591964864, -0.04249667681125511, -0.03658740270047517));
        let position = v(0.9286343751681008, 0.7099925738457538, 1.3186912154636108);
        p.run(&MotionCommand::From { position, axis, name: String::new() }).part_side(PartSide::Offset);
        p.go(&[(Relation::To, &halves), (Relation::To, &circle), (Relation::Past, &first)]);
        p.side(DriveSide::Right).indirv(forward.x, forward.y, forward.z);
        p.drive(Turn::Forward, &halves, Relation::On, &stop);
        let evidence = crate::verify::verify(p.last(), &|| false).expect("evidence");
        assert!(evidence.verified, "{outside}: {evidence:?}");
    }
}

//! TANTO and PSTAN where the path runs parallel to a check surface that is not tangent there.

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric},
    motion::{DriveSide, MotionCommand, Relation, Turn},
};

use super::{
    Program, circle, cylinder, ground, line, motion, named, plane, quadric,
    refused::{AMPLE, Found},
    sheets::ruled,
    sphere, v, x, y,
};
use crate::{error::MotionFailure, sequence::Stop, verify::Rule, verify::verify};

/// Along a wall to a ball in front of it whose middle is so far below the tool: the rim of the tool touches it.
fn to_a_ball(below: f64) -> (Program, Result<(), MotionFailure>) {
    let wall = line(-5.0, 0.0, 5.0, 0.0);
    let mut program = Program::new();
    program.cutter(&[1.0, 0.0]).tolerance(0.001, 0.001).from(-3.0, -2.0, 0.0).indirv(0.0, 1.0, 0.0);
    program.go(&[(Relation::To, &wall), (Relation::To, &ground())]);
    program.side(DriveSide::Right).indirv(1.0, 0.0, 0.0);
    let ball = sphere(2.0, (1.0 - below * below).sqrt(), -below, 1.0);
    let outcome =
        program.attempt(&motion(Turn::Forward, &wall, &[(Relation::TangentToDrive, 1, &ball)])).map(|_| ());
    (program, outcome)
}

/// Where the path is parallel to the ball, tool and ball touch, however far below its middle is; but wall and ball are tangent
/// only as far as the bands allow, by a thousandth each way.
#[test]
fn surfaces_that_lean_to_each_other_across_the_path_are_not_tangent() {
    for below in [0.0, 0.02, 0.05] {
        let (mut program, outcome) = to_a_ball(below);
        outcome.expect("a tangency");
        program.verified();
        assert!((program.tip().x - 2.0).abs() < 1e-6, "{below}: {:?}", program.tip());
        let evidence = verify(program.last(), &|| false).expect("evidence");
        assert!(evidence.verified, "{below}: {evidence:?}");
    }
    for below in [0.12_f64, 0.3] {
        let missed = 0.5 * below * below;
        match to_a_ball(below).1 {
            Err(MotionFailure::NotTangent { gap, .. }) => {
                assert!((gap - missed).abs() < 0.1 * missed, "{gap} for {missed}");
            }
            other => panic!("{below}: {other:?}"),
        }
    }
}

/// The verifier tells the same of a path that ends there.
#[test]
fn a_path_to_such_a_place_is_not_accepted() {
    for (below, is_tangent) in [(0.05, true), (0.12_f64, false), (0.3, false)] {
        let (program, _) = to_a_ball(0.0);
        let mut sequence = program.last().clone();
        let ball = sphere(2.0, (1.0 - below * below).sqrt(), -below, 1.0);
        let Some(Stop { role, .. }) = &mut sequence.stop else { panic!("a stop") };
        role.surface.geometry = ball;
        let violations = verify(&sequence, &|| false).expect("evidence").violations;
        let leans = violations.iter().any(|violation| violation.rule == Rule::Tangency);
        assert_eq!(leans, !is_tangent, "{below}: {violations:?}");
    }
}

/// A flat bottom is tangent to a bar below it as long as it is above the line on which bar and part surface touch. From either
/// side the motion ends in the middle of that way, where APT III stops with the tool end.
#[test]
fn a_flat_bottom_that_is_tangent_along_a_way_stops_in_the_middle_of_it() {
    let (wall, bar) = (line(0.0, 0.0, 8.0, 0.0), cylinder(v(4.0, 0.0, -2.0), v(0.0, 1.0, 0.0), 2.0));
    for (from, ahead) in [(-1.0, 1.0), (9.0, -1.0)] {
        let mut program = Program::new();
        program.cutter(&[0.5]).tolerance(0.001, 0.001).from(from, -2.0, 0.0).indirv(0.0, 1.0, 0.0);
        program.go(&[(Relation::To, &wall), (Relation::To, &ground())]);
        let side = if ahead > 0.0 { DriveSide::Right } else { DriveSide::Left };
        program.side(side).indirv(ahead, 0.0, 0.0);
        program
            .run(&motion(Turn::Forward, &wall, &[(Relation::TangentToPart, 1, &bar)]))
            .ends(4.0, -0.25, 0.0, 1e-9)
            .verified();
    }
}

/// The flank of a drill goes through one side of a double cone, beside its vertex, where the cone is tangent to the drive surface: the
/// clearance falls to nothing, and grows on.
#[test]
fn a_path_that_goes_through_the_surface_to_which_it_is_tangent_stops_there() {
    let double_cone = [
        -0.9793149044995352,
        -0.20337514965515952,
        0.09499370686026659,
        0.44472761246647496,
        0.36341834964994446,
        0.7002030042396395,
        -0.8223082119835796,
        0.09742164682714609,
        -0.00912948323667126,
        0.436245346220967,
    ];
    let hollow = [
        0.5435652679807044,
        0.2162131758766806,
        0.001344775162413118,
        0.5617482825063519,
        0.017051630675845027,
        -0.027036513671900853,
        -0.34282061327517493,
        0.1736123499168878,
        -0.3357773146927068,
        0.44861223353160856,
    ];
    let motion = Found {
        cutter: &[
            0.6997793114894189,
            0.0,
            0.3498896557447094,
            0.2102349151421061,
            31.0,
            0.0,
            3.071617613670131,
        ],
        axis: Vec3::z(),
        from: v(-0.6246575369567703, 0.639849032749579, -0.5144338532961925),
        band: [2e-5, 3e-5],
        thickness: 0.030806573680048924,
        drive_side: DriveSide::Right,
        forward: v(0.6329635701834135, -0.7661423990452165, -0.11127867363473973),
        part: (Relation::On, quadric(hollow)),
        drive: (
            Relation::Past,
            Geometry::Circle(Cylinder {
                point: v(-5.297381751341178, -3.7769826138527627, -0.209864685982917),
                axis: Vec3::z(),
                radius: 6.8105342930192245,
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-0.6329635701834135, 0.7661423990452167, 0.1112786736347398),
                distance: 1.5486891041257935,
            }),
        ),
        stop: (Relation::TangentToDrive, quadric(double_cone)),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a tangency");
    let end = sequences.last().and_then(|sequence| sequence.points.last()).expect("an end").tip;
    let place = v(-0.34042372330058956, 0.3183054874036313, -0.4200996011250231);
    assert!((end - place).norm() < 1e-3, "{end:?}");
}

/// A circle that is deeper in the wall than its band by what is rounding far away, where the motion begins, and is none where it ends. The next
/// motion goes along the circle.
#[test]
fn a_tangency_is_in_the_bands_by_the_coordinates_where_it_is() {
    let (wall, deeper) = (y(0.0), 3e-10);
    let circle = circle(0.0, -50.0, 50.0 + deeper);
    for force in [false, true] {
        let mut p = Program::new();
        p.tolerance(0.0, 0.001).cutter(&[2.0]).run(&MotionCommand::ForceIteration(force));
        p.from(-400.0, 1.0, 0.0).run(&MotionCommand::PartSurface(named(&ground())));
        p.indirv(1.0, 0.0, 0.0).side(DriveSide::Left).drive(
            Turn::Forward,
            &wall,
            Relation::TangentToDrive,
            &circle,
        );
        assert!((p.tip().y - 1.0 - deeper).abs() < 1e-5, "{}", p.tip());
        p.drive(Turn::Forward, &circle, Relation::On, &x(10.0)).verified();
    }
}

/// A tool that goes ON a line, an arc and another line, tangent to each other but for less than the bands, over flat and round part surfaces: ON
/// has no side, so that bands hold on either of both, whichever way the surfaces look.
#[test]
fn a_tool_goes_on_a_contour_from_one_surface_to_the_next() {
    for ((inside, outside), off) in
        [(0.0, 0.001), (0.001, 0.0), (0.0005, 0.001)].into_iter().flat_map(|band| OFF.map(|off| (band, off)))
    {
        for (part, bow, sense) in [ground(), sphere(0.0, 0.0, -30.0, 30.0), quadric(SADDLE)]
            .iter()
            .flat_map(|part| [1.0, -1.0].map(|bow| (part, bow)))
            .flat_map(|(part, bow)| [1.0, -1.0].map(|sense| (part, bow, sense)))
        {
            let first = plane(0.0, sense, 0.0, 0.0);
            let arc = circle(1.0, bow * (2.0 + off), 2.0);
            let last = plane(sense, 0.0, 0.0, sense * (3.0 + off));
            let mut p = Program::new();
            p.tolerance(inside, outside).cutter(&[0.5, 0.25]).from(-2.0, 0.0, 3.0);
            p.go(&[(Relation::On, &first), (Relation::To, part), (Relation::On, &x(-2.0))]);
            p.indirv(1.0, 0.0, 0.0).side(DriveSide::On);
            p.drive(Turn::Forward, &first, Relation::TangentToDrive, &arc);
            p.drive(Turn::Forward, &arc, Relation::TangentToDrive, &last);
            let end = y(bow * 4.0);
            p.drive(Turn::Forward, &last, Relation::On, &end).verified();
            let tip = p.tip();
            assert!((tip.x - 3.0).abs() < 0.002 && (tip.y - bow * 4.0).abs() < 0.002, "{tip}");
            for sequence in &p.sequences {
                let evidence = verify(sequence, &|| false).expect("evidence");
                assert!(evidence.verified, "{inside} {outside} {off} {bow} {sense}: {evidence:?}");
            }
        }
    }
}

/// How far the nearest parallel place is from being a tangency is told, too, if the tool has not yet come there when the look ahead finds that nothing
/// stops it.
#[test]
fn the_gap_at_a_parallel_place_that_is_far_ahead_is_told() {
    let (hole, missed) = (circle(0.0, 0.0, 0.8), 5e-4);
    for degrees in [30.0_f64, 170.0, 300.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut p = Program::new();
        p.tolerance(0.0, 1e-4).cutter(&[1.0]).from(0.25 * cos, 0.25 * sin, 1.0);
        let radial = plane(-sin, cos, 0.0, 0.0);
        p.go(&[
            (Relation::To, &hole),
            (Relation::To, &sphere(0.0, 0.0, -30.0, 30.0)),
            (Relation::On, &radial),
        ]);
        p.side(DriveSide::Left).indirv(sin, -cos, 0.0);
        match p.attempt(&motion(Turn::Forward, &hole, &[(Relation::TangentToDrive, 1, &x(0.8 + missed))])) {
            Err(MotionFailure::NotTangent { gap, .. }) => {
                // Less or more by what the band leaves.
                assert!((gap - missed).abs() <= 1.5e-4, "{degrees}: {gap}");
            }
            other => panic!("{degrees}: {other:?}"),
        }
    }
}

/// How far apart surfaces are that are to be tangent.
const OFF: [f64; 5] = [0.0, 5e-10, -5e-10, 2e-4, -2e-4];
/// z = −.02 x² + .015 y², without a plane.
const SADDLE: [f64; 10] = [0.02, -0.015, 0.0, 0.0, 0.0, 0.0, 0.004, 0.0, 0.0, 0.5];

/// Far down two surfaces lean together until they all but touch, and the line in both comes up again: on a bend of a hundredth, where
/// both bands hold as far as half a unit aside. A vector is not against the path there for leading aside by a right angle and a little more.
#[test]
fn a_path_that_comes_back_where_its_surfaces_all_but_touch_is_proven() {
    let motion = Found {
        cutter: &[0.8615900508486447, 0.43079502542432235],
        axis: v(0.6, 0.0, 0.8),
        from: v(1.7472019280972708, 0.6805935501633713, -10508.772691028187),
        band: [0.0005, 0.0],
        thickness: 0.18018827883018035,
        drive_side: DriveSide::On,
        forward: v(0.0, 0.0, -1.0),
        part: (
            Relation::On,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.07514059483581147,
                    0.1512758177717788,
                    -0.00013167259161777495,
                    2.3553602131741727,
                    0.12375680763497621,
                    -0.026753699414510397,
                    -0.189654225540564,
                    0.22782714388762826,
                    -0.5439830376384773,
                    -0.7292668085672586,
                ],
            }),
        ),
        drive: (
            Relation::On,
            Geometry::Hyperbola(Quadric {
                coefficients: [
                    -0.14893392340368408,
                    -0.3714763998319384,
                    0.0,
                    -0.3920572626519241,
                    0.0,
                    0.0,
                    0.28301224101930256,
                    -0.16087601724552508,
                    0.6662802904095738,
                    0.0,
                ],
            }),
        ),
        first: (Relation::On, Geometry::Plane(Plane { normal: v(1.0, 0.0, 0.0), distance: 0.75 })),
        stop: (Relation::On, Geometry::Plane(Plane { normal: v(1.0, 0.0, 0.0), distance: 0.75 })),
    };
    let path = &motion.run_from_there(AMPLE).expect("a path")[0];
    let deepest = path.points.iter().map(|point| point.tip.z).fold(f64::INFINITY, f64::min);
    let last = path.points.last().expect("a vertex").tip;
    assert!(last.z > deepest + 1.0, "{path:?}");
}

/// A bell in a hollow cone comes back from a corner before it comes to its tangency: into the corner one vector leads in the place of two.
#[test]
fn fewer_vectors_lead_to_a_tangency() {
    let across = v(0.23294346823084977, -0.9538925610104234, -0.18927842628667074);
    let point = v(-6.283196467135157, 0.11733443487412576, 2.9799359372897407);
    let motion = Found {
        cutter: &[0.6, 0.11, 0.2, 0.13, 9.163208393958554, 3.6602650274620134, 3.3510470592665538],
        axis: v(0.09242606528100263, 0.03646138510438561, 0.9950517523490633),
        from: v(-3.135546776278291, 2.826080450946606, -2.199922216787687),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(0.5222059872024714, -0.6762409022970021, 0.5196144233856764),
        part: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(-2.690607186807475, -2.6654259523242816, 1.309908766504694),
                axis: v(0.24145619642109184, 0.9267720730783796, -0.2877367369173804),
                cosine: 0.8997570446879427,
            }),
        ),
        drive: (
            Relation::To,
            ruled([
                (
                    plane(0.959993603505892, 0.2566543973501626, -0.11198572028878095, -2.987322903913245),
                    v(-3.1881380182028245, 3.2577699301464094, 6.812045102755973),
                    v(-4.435807977486298, 4.50719215437975, -1.0200737597232425),
                    v(0.9599936035058919, 0.25665439735016277, -0.11198572028878098),
                ),
                (
                    Geometry::Circle(Cylinder { point, axis: across, radius: 5.2240139794442175 }),
                    v(-1.4706036064767278, -2.374421098991371, 5.610606265251572),
                    v(-3.358020770442197, -1.30732754860755, -2.0899760376588903),
                    v(0.9434382452640139, 0.2688809624473629, -0.19397758995960918),
                ),
            ]),
        ),
        first: (Relation::On, x(0.0)),
        stop: (
            Relation::TangentToPart,
            cylinder(
                v(-0.5871207356008467, 5.538035346853281, 6.145520375271122),
                v(-0.9903935263763594, 0.12242832640797277, 0.06428038429211912),
                6.24715871322197,
            ),
        ),
    };
    let path = &motion.run_from_there(AMPLE).expect("a tangency")[0];
    assert_eq!((path.points.len(), path.minimum), (6, Some(4)));
}

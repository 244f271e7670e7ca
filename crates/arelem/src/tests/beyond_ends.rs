//! Tools that are beside the end of a polyconic surface: what of a tool is beyond the end is not behind the surface.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use apt_geometry::{
    canonical::{Remembering, extent},
    surface::Surface,
};

use super::{
    refused::{AMPLE, Found},
    sheets::ruled,
    *,
};
use crate::verify::tests::point_distance;

/// A polyconic surface by its rigid motion and length, and by the first two coefficients of its polynomials.
pub(super) fn poly_conic(head: &[f64; 16], polynomials: [[f64; 2]; 7]) -> Geometry {
    let mut values = head.to_vec();
    for polynomial in polynomials {
        values.extend(polynomial);
        values.extend([0.0; 6]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// One that ends beside a high tool, and bends away from there.
fn shell() -> Geometry {
    let round = 3.7566821282280904;
    poly_conic(
        &[
            1.0,
            0.02921619329367398,
            -0.24394551279046692,
            -0.9693487508832015,
            9.40006974169691,
            -0.39930594928453156,
            -0.8918719709010567,
            0.2124126794403858,
            0.46924527912735325,
            -0.9163521009499601,
            0.3808608332586341,
            -0.12346599845355442,
            4.161005051339264,
            0.0,
            0.0,
            6.000000000000002,
        ],
        [
            [round, 0.06527544631681893],
            [round, 0.05877881076108642],
            [round, -0.022059215187959145],
            [-round, 0.021520112426968555],
            [-round, 0.07768809582069268],
            [round, -0.027445536843174627],
            [std::f64::consts::FRAC_1_SQRT_2, 0.010604308951770676],
        ],
    )
}

const BALL: [f64; 2] = [0.5929879662113318, 0.2964939831056659];

fn leaning() -> Vec3 {
    v(0.10245858125864422, 0.2714036991444637, 0.9569964844330241)
}

/// In front of the surface, into it, and out of it on the other side: in each place some of the tool is beyond the end, as much as 1.4
/// behind the tangent plane there.
#[test]
fn what_of_a_tool_is_beyond_the_end_of_a_surface_is_not_behind_it() {
    let cutter = Cutter::from_numbers(&BALL, 1.0).expect("a cutter");
    let tool = Tool::new(cutter, leaning());
    for (side, tip, least) in [
        (1.0, v(-1.2043, -0.3235, 0.5394), 0.0888),
        (1.0, v(-1.2446, -0.2798, 0.5313), 0.0414),
        (-1.0, v(-2.0505, 0.5949, 0.3723), 0.0158),
        (-1.0, v(-2.2116, 0.7700, 0.3410), 0.2285),
    ] {
        let role = Role { side, ..touched(&shell()) };
        let engine = gauge(&role).contact(&tool, &tip).clearance;
        let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: leaning() });
        assert!((engine - least).abs() < 1e-3, "{tip:?}: {engine}, not {least}");
        assert!((engine - verifier).abs() < 1e-7, "{tip:?}: {engine}, {verifier}");
    }
}

/// A wall along the tool is a line seen from above, and the tool a disc, only where what is widest of the tool is beside it: the end of
/// a ball was, and its middle over the wall.
#[test]
fn a_ball_whose_end_is_beside_a_wall_touches_the_edge_of_that_below_its_middle() {
    let (radius, height, out) = (0.25, 2.0, 0.26);
    let along = |z: f64| (level(z), v(0.0, 0.0, z), v(6.0, 0.0, z), Vec3::z());
    let wall = ruled([along(0.0), along(height)]);
    let edge = height * (1.0 + extent::RULED_BEYOND);
    let cutter = Cutter::from_numbers(&[2.0 * radius, radius], 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    for below in [0.4, 0.2, 0.1, 0.05] {
        let tip = v(3.0, -out, edge - below);
        let middle_over = (radius - below).max(0.0);
        let nearest = out.hypot(middle_over) - radius;
        let role = touched(&wall);
        let engine = gauge(&role).contact(&tool, &tip).clearance;
        let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: Vec3::z() });
        assert!((verifier - nearest).abs() < 1e-9, "{below}: {verifier}, not {nearest}");
        assert!((engine - nearest).abs() < 1e-9, "{below}: {engine}, not {nearest}");
    }
}

/// A look ahead goes by contacts without a proof. With a tool a little in the surface they were those of points of the tool with the
/// surface, and no position was found past the end.
#[test]
fn contact_with_the_end_of_a_surface_is_found_without_a_proof() {
    let tool = Tool::new(Cutter::from_numbers(&BALL, 1.0).expect("a cutter"), leaning());
    for (side, tip) in [(1.0, v(-1.2446, -0.2798, 0.5313)), (-1.0, v(-2.0505, 0.5949, 0.3723))] {
        let role = Role { side, ..touched(&shell()) };
        let at_first = gauge(&role).contact(&tool, &tip);
        for clearance in [1e-3, 0.0, -5e-4, -5e-3] {
            let tip = tip + at_first.gradient * (clearance - at_first.clearance);
            let proven = gauge(&role).contact(&tool, &tip);
            let passing = gauge(&role).contact_passing(&tool, &tip);
            let [found, shown] = [&passing, &proven].map(|contact| contact.clearance);
            assert!((found - shown).abs() < 1e-8, "{clearance}: {found}, {shown}");
            let [found, shown] = [&passing, &proven].map(|contact| contact.gradient);
            assert!((found - shown).norm() < 1e-6, "{clearance}: {found}, {shown}");
        }
    }
}

/// Along the bottom of the tool the surface ends; there the tool leaves it.
#[test]
fn a_tool_stops_past_the_end_of_a_surface() {
    let shell = poly_conic(
        &[
            1.0,
            0.1067837976965222,
            0.9933257382086963,
            -0.04360273341955679,
            -3.566774551432878,
            0.9688570008067338,
            -0.09409930228474059,
            0.2290446098411962,
            -0.660100445639172,
            0.22341291936074112,
            -0.06670306680860841,
            -0.97243887640357,
            5.887452076245796,
            0.0,
            0.0,
            6.0,
        ],
        [
            [2.5109117315275205, 0.013756258257117376],
            [2.5109117315275205, 0.19994449471771247],
            [2.5109117315275205, 0.1277166586958392],
            [-2.5109117315275205, 0.19121505942924644],
            [-2.5109117315275205, 0.1459023899621198],
            [2.5109117315275205, 0.1257150966789542],
            [std::f64::consts::FRAC_1_SQRT_2, 0.041825560037774365],
        ],
    );
    let hyperbola = [
        0.14294803237427778,
        0.02951607723704615,
        0.0,
        -1.2930157370646356,
        0.0,
        0.0,
        0.14722873629732014,
        -0.6492494555830008,
        -0.03948967521443064,
        0.0,
    ];
    let motion = Found {
        cutter: &[1.0805933554767073],
        axis: v(-0.24258331945227707, 0.9685677973732086, -0.05504321043621701),
        from: v(1.2822935592512699, 1.8201369572770538, 0.7486995480952237),
        band: [2e-5, 3e-5],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: Vec3::z(),
        part: (
            Relation::To,
            Geometry::Line(Plane {
                normal: v(0.44573115311138706, 0.8951668778199925, 0.0),
                distance: 1.849041234808372,
            }),
        ),
        drive: (Relation::To, Geometry::Hyperbola(Quadric { coefficients: hyperbola })),
        first: (Relation::On, level(0.7486995480952237)),
        stop: (Relation::Past, shell),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    let end = sequences.last().and_then(|sequence| sequence.points.last()).expect("an end").tip;
    assert!((end.z - 3.513).abs() < 1e-3, "{end:?}");
}

/// One that a ball cutter on the side of its natural normal touches with its shank at the end.
fn leaning_wall() -> Geometry {
    let round = 3.63070224545673;
    poly_conic(
        &[
            1.0,
            0.3567432677634518,
            -0.37075211386877877,
            0.8574830091420388,
            4.343594585195163,
            -0.5153508954152167,
            0.6874784914484833,
            0.5116510318473438,
            0.15396380541528118,
            -0.7791968271882198,
            -0.624432697620448,
            0.05418588969706064,
            2.7555242961285704,
            0.0,
            0.0,
            5.999999999999999,
        ],
        [
            [round, 0.02885595822079567],
            [round, 0.01662820664897074],
            [round, 0.13769813185976754],
            [-round, -0.12972126135004988],
            [-round, -0.07267447430726173],
            [round, -0.015300871969653683],
            [std::f64::consts::FRAC_1_SQRT_2, 0.01553791939147553],
        ],
    )
}

const SLENDER_BALL: [f64; 2] = [0.3376421318773318, 0.1688210659386659];

/// Where that cutter touches the end.
fn beside_the_wall() -> Vec3 {
    v(-1.1260934396603965, -1.5680898274479713, -0.539050953153846)
}

/// As deep as the end is in it the tool comes out past the end, though some of it is under the surface by more.
#[test]
fn a_tool_is_as_deep_in_a_surface_as_the_end_of_that_is_in_the_tool() {
    let cutter = Cutter::from_numbers(&SLENDER_BALL, 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    let role = touched(&leaning_wall());
    let touch = gauge(&role).contact(&tool, &beside_the_wall());
    for depth in [1e-4, 3e-4, 1e-3] {
        let tip = beside_the_wall() - touch.gradient * (depth + touch.clearance);
        let engine = gauge(&role).contact(&tool, &tip).clearance;
        let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: Vec3::z() });
        // The shank is round, and so is the end.
        let bent = depth * depth / SLENDER_BALL[1];
        assert!((engine + depth).abs() < bent, "{engine}, not {depth} deep");
        assert!((engine - verifier).abs() < 1e-7, "{engine}, {verifier}");
    }
}

/// On the other side of the end no place of the surface is in the tool either, but the tool is behind the surface there: also where it is
/// asked after a contact at the end.
#[test]
fn a_tool_that_touches_the_end_from_behind_is_not_clear() {
    let tool = Tool::new(Cutter::from_numbers(&SLENDER_BALL, 1.0).expect("a cutter"), Vec3::z());
    let role = touched(&leaning_wall());
    let known = gauge(&role);
    let touch = known.contact(&tool, &beside_the_wall());
    for way in [1.9, 2.0, 2.1] {
        let behind = beside_the_wall() - touch.gradient * (way * tool.radius());
        let (after, afresh) = (known.contact(&tool, &behind), gauge(&role).contact(&tool, &behind));
        for found in [after, afresh] {
            assert!(found.clearance < -tool.radius(), "{found:?}");
        }
        known.contact(&tool, &beside_the_wall());
    }
}

/// The shank goes along the end, not over it.
#[test]
fn a_tool_goes_along_the_end_of_a_surface() {
    let (across, ahead) = (v(0.201, -0.6908, 0.695).normalize(), v(0.1943, -0.6677, -0.719));
    let motion = Found {
        cutter: &SLENDER_BALL,
        axis: Vec3::z(),
        from: beside_the_wall(),
        band: [5e-4, 0.0],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: ahead,
        part: (
            Relation::On,
            Geometry::Plane(Plane { normal: across, distance: across.dot(&beside_the_wall()) }),
        ),
        drive: (Relation::To, leaning_wall()),
        first: (Relation::On, level(0.0)),
        stop: (Relation::On, Geometry::Plane(Plane { normal: Vec3::y(), distance: -1.7 })),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    let end = sequences.last().and_then(|sequence| sequence.points.last()).expect("an end").tip;
    assert!((end.y + 1.7).abs() < 1e-9, "{end:?}");
}

/// Contact goes along the end with the tool: on the way between two places the clearance is no greater than at both, but for how the end
/// bends.
#[test]
fn the_clearance_along_an_end_is_no_greater_than_at_both_places() {
    let tool = Tool::new(Cutter::from_numbers(&SLENDER_BALL, 1.0).expect("a cutter"), Vec3::z());
    let gauge = gauge(&touched(&leaning_wall()));
    let way = v(0.1943, -0.6677, 0.0) * 0.3;
    let tips = [beside_the_wall(), beside_the_wall() + way];
    let contacts = tips.map(|tip| gauge.contact(&tool, &tip));
    assert!(contacts.iter().all(|contact| gauge.surface.ends_at(&contact.surface)), "{contacts:?}");
    let most =
        gauge.at_most_between(&tool, [(&tips[0], &contacts[0]), (&tips[1], &contacts[1])]).expect("a bound");
    let greatest = contacts[0].clearance.max(contacts[1].clearance);
    assert!(most < greatest + 2e-3, "{most} beyond {greatest}");
    for k in 0..=20 {
        let clearance = gauge.contact(&tool, &(tips[0] + way * (f64::from(k) / 20.0))).clearance;
        assert!(clearance <= most + 1e-9, "{clearance} beyond {most}");
    }
}

/// A plane that rises with y and ends at y −16 with its extension.
fn ramp() -> Geometry {
    ruled([0.0, 4.0].map(|at| (level(at), v(0.0, at, at), v(6.0, at, at), Vec3::z())))
}

/// A tool that is a line.
const LINE: [f64; 7] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 12.0];

/// No place of it is beside the end by less than it is behind that; its own places are under the surface by much more.
#[test]
fn a_line_behind_the_end_comes_out_past_it() {
    let cutter = Cutter::from_numbers(&LINE, 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    let role = touched(&ramp());
    for depth in [1e-4, 1e-3, 1e-2] {
        let tip = v(3.0, depth - 16.0, -20.0);
        let (contact, missed) = gauge(&role).contact_within(&tool, &tip, crate::clearance::Enough::ALL);
        assert!((contact.clearance + depth).abs() < 1e-9, "{contact:?}, not {depth} deep");
        assert!((contact.gradient + Vec3::y()).norm() < 1e-6 && missed < 1e-6, "{contact:?}");
        let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: Vec3::z() });
        assert!((contact.clearance - verifier).abs() < 1e-7, "{contact:?}, {verifier}");
        assert_eq!(
            gauge(&role).certify(&tool, (&tip, None), -1.01 * depth),
            crate::clearance::Certificate::Holds
        );
        assert_ne!(
            gauge(&role).certify(&tool, (&tip, None), -0.99 * depth),
            crate::clearance::Certificate::Holds
        );
        // On the way along the end it is as deep.
        let there = tip + Vec3::x();
        let ends = [&tip, &there].map(|tip| (tip, gauge(&role).contact(&tool, tip)));
        let most = gauge(&role).at_most_between(&tool, [(ends[0].0, &ends[0].1), (ends[1].0, &ends[1].1)]);
        assert!(most.is_some_and(|most| (most + depth).abs() < 1e-9), "{most:?}");
    }
}

/// The way out past the end, where a contact is followed along that, does not tell how deep one end of the line is in the surface far from there.
#[test]
fn a_line_in_a_surface_by_little_does_not_come_out_past_a_far_end() {
    let tool = Tool::new(Cutter::from_numbers(&LINE, 1.0).expect("a cutter"), Vec3::z());
    let follows = gauge(&touched(&ramp()));
    let behind = follows.contact(&tool, &v(3.0, 1e-3 - 16.0, -20.0));
    assert!((behind.clearance + 1e-3).abs() < 1e-9, "{behind:?}");
    for away in [0.5, 4.0, 15.0] {
        let depth = 0.2;
        let tip = v(3.0, away - 16.0, away - 16.0 - depth * SQRT_2);
        let contact = follows.contact(&tool, &tip);
        assert!((contact.clearance + depth).abs() < 1e-9, "{contact:?}, {away} from the end");
    }
}

/// A line that is in a shell with both of its ends, each by little and square to another place, comes out of both at once.
#[test]
fn a_line_in_a_shell_with_both_ends_does_not_come_out_past_a_far_end() {
    let round = 2.607513185241407;
    let shell = poly_conic(
        &[
            1.0,
            0.6220678848344942,
            -0.7658166626698659,
            -0.16296130164774436,
            6.886871993940173,
            -0.4382968173755692,
            -0.16813598752065295,
            -0.882964432793814,
            -2.1820420734403103,
            0.6487892157981555,
            0.6206892369597232,
            -0.44024700406291356,
            3.14693551007748,
            0.0,
            0.0,
            6.0,
        ],
        [
            [round, -0.1521267590360992],
            [round, -0.0587568023399605],
            [round, -0.00202812237500985],
            [-round, 0.03482436444849929],
            [-round, 0.11630967423657385],
            [round, -0.010581183766829289],
            [FRAC_1_SQRT_2, -0.017372844922333597],
        ],
    );
    let cutter = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.066952297436383];
    let cutter = Cutter::from_numbers(&cutter, 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    let role = touched(&shell);
    let from = v(-1.9400816756053312, 1.6036672311742735, -1.600113328921861);
    for k in 0..=24 {
        let tip = from + v(0.00278, 0.0084, 0.018) * (f64::from(k) / 24.0);
        let contact = gauge(&role).contact(&tool, &tip);
        let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: Vec3::z() });
        assert!((contact.clearance - verifier).abs() < 1e-6, "{k}: {contact:?}, {verifier}");
    }
}

/// Where neighbouring rulings meet not far beyond a curve the extension ends before that: for the verifier where it does for
/// the engine.
#[test]
fn an_extension_ends_where_the_verifier_ends_it() {
    let floor = plane(0.078, 0.92, 0.385, -1.405);
    let wall = cylinder(v(1.52, 1.45, 3.93), v(0.48, -0.373, 0.794).normalize(), 5.99);
    let askew = ruled([
        (floor, v(-3.06, -1.84, 1.37), v(4.07, -0.84, -2.47), v(0.078, 0.92, 0.385)),
        (wall, v(-0.1, -4.79, 5.75), v(6.87, -2.38, 2.67), v(0.095, -0.877, -0.47)),
    ]);
    let surface = Surface::from_geometry(&askew).expect("a surface");
    for place in [[-15.6, -43.0, -36.7], [0.0, 30.0, 4.0], [0.0, -40.0, 4.0], [2.0, 20.0, -60.0]] {
        let place = Vec3::from(place);
        let (foot, verifier) = (surface.foot(&place), point_distance(&askew, &place));
        assert!((verifier - foot.distance).abs() < 1e-6, "{place:?}: {verifier} {foot:?}");
    }
}

/// Where a motion begins beside the end of its drive surface, the verifier reads that; the tool goes along the surface itself, on the side that is
/// told.
#[test]
fn a_motion_that_sets_out_beside_an_end_is_on_its_side() {
    let floor = ruled([
        (
            plane(-0.7327336369817372, 0.13545165880664603, 0.6668989918736148, 0.37576560748260746),
            v(1.7227439731703238, 3.857041651347502, 1.6728700873222317),
            v(0.8283733584268888, -4.105220103409818, 2.3073981558010646),
            v(-0.7327336369817371, 0.1354516588066461, 0.6668989918736148),
        ),
        (
            plane(-0.7237346718310218, 0.20088991083936442, 0.6601904032266718, 0.36577314224244767),
            v(-2.105394906861798, 3.9445875278241784, -2.9543022391418967),
            v(-3.399761820942799, -3.9964122469860204, -1.9568801019412738),
            v(-0.7237346718310217, 0.20088991083936442, 0.6601904032266718),
        ),
    ]);
    let wall = poly_conic(
        &[
            1.0,
            0.3879389757410836,
            -0.9119723681890166,
            -0.13345317815876676,
            5.780734857095357,
            -0.26635577772637825,
            0.027686462898558393,
            -0.9634770674198441,
            4.543516309506439,
            0.8823593093364714,
            0.4093163317434126,
            -0.23216845133519215,
            2.1398437321667507,
            0.0,
            0.0,
            5.999999999999998,
        ],
        [
            [2.3065744057644366, -0.012892324164869292],
            [2.3065744057644366, -0.06341955682009702],
            [2.3065744057644366, -0.1414584421877306],
            [-2.3065744057644366, -0.14089466935052544],
            [-2.3065744057644366, 0.07909158807781712],
            [2.3065744057644366, -0.10294451661509182],
            [FRAC_1_SQRT_2, 0.00526576034882701],
        ],
    );
    let motion = Found {
        cutter: &[0.6, 0.11, 0.2, 0.13, 11.411956326090987, 4.534640888054588, 4.33128295784365],
        axis: Vec3::z(),
        from: v(-4.983175306051367, -3.736239583802104, -3.625328533310076),
        band: [0.001, 0.001],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.3131643582616037, 0.7839426502356623, -0.5360615690907937),
        part: (Relation::On, floor),
        drive: (Relation::To, wall),
        first: (Relation::On, level(0.0)),
        stop: (
            Relation::On,
            plane(-0.36379621691795827, 0.7647538401175832, -0.531793076846241, 1.6740256173009858),
        ),
    };
    assert_eq!(motion.run_from_there(AMPLE).expect("a path").len(), 1);
}

/// A surface between two arcs that a line crosses far from where it ends.
fn between_arcs() -> Geometry {
    let axis = v(0.5624568783050846, -0.5604645610397418, -0.6078829952102862);
    let across = v(-0.5797670680194672, -0.7915137580756433, 0.19332903976661864);
    ruled([
        (
            cylinder(v(7.8439486919853145, 13.346994726352623, -6.2077037082516675), axis, 16.26354261023611),
            v(-5.340861179663028, 3.5257527381268616, -4.41694613332383),
            v(-0.6248465443173941, 1.576222389014002, 1.7441038889608187),
            across,
        ),
        (
            cylinder(
                v(-3.8284596700087103, -2.5884944002654398, -2.315424162093687),
                axis,
                5.923493140985826,
            ),
            v(-1.9661199098325208, 0.16296537188841054, -8.064244104585548),
            v(2.7498947255131134, -1.7865649772244492, -1.903194082300899),
            -across,
        ),
    ])
}

/// The way past the end of the surface is no depth where it is longer than the tool, which comes out by its own length.
#[test]
fn no_tool_is_deeper_than_it_is_long() {
    let height = 3.733023160776108;
    let line = Cutter::from_numbers(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height], 1.0).expect("a cutter");
    let role = Role { side: -1.0, ..touched(&between_arcs()) };
    let tip = v(-3.9957529145737833, 2.439610777961711, -0.40912511299533777);
    let contact = gauge(&role).contact(&Tool::new(line, Vec3::z()), &tip);
    assert!(contact.clearance < 0.0 && contact.clearance >= -height, "{contact:?}");
}

/// A wall whose end, which leans, comes to be beside the flank of a ball-ended tool: contact leaves the wall for the end, and what is found
/// from the contact before is not far from there.
#[test]
fn contact_that_leaves_a_surface_over_its_end_is_not_followed_far_away() {
    let round = 1.5488995304303261;
    let wall = poly_conic(
        &[
            1.0,
            0.008786561050093128,
            0.5064150028134305,
            0.8622451166984858,
            3.1062984857391793,
            0.1381790580872694,
            -0.8546210471621286,
            0.5005291336711793,
            -1.2922755395616086,
            0.9903682871795865,
            0.1147462882753924,
            -0.07748512809560626,
            3.9140498645279296,
            0.0,
            0.0,
            5.999999999999998,
        ],
        [
            [round, 0.1731712184014962],
            [round, -0.00819668105456106],
            [round, 0.2694457094123509],
            [-round, 0.12250877261644308],
            [-round, -0.19116937741550954],
            [round, -0.0032046258205974945],
            [FRAC_1_SQRT_2, -0.04015146312149453],
        ],
    );
    let cutter = Cutter::from_numbers(&[0.8535051011690147, 0.42675255058450734], 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    let known = gauge(&Role { side: -1.0, ..touched(&wall) });
    let way = v(0.01596, 0.97584, 0.21789);
    let before = v(-1.0494, 0.1128, 0.25555);
    for back in [0.06, 0.02, 1e-3, 0.0] {
        known.contact(&tool, &(before - way * back));
    }
    let step = 3e-4;
    let (followed, _) = known.contact_followed(&tool, &(before + way * step));
    let fresh = gauge(&Role { side: -1.0, ..touched(&wall) }).contact(&tool, &(before + way * step));
    assert!(known.surface.ends_at(&fresh.tool), "{fresh:?}");
    assert!((followed.clearance - fresh.clearance).abs() < step, "{followed:?}, not {fresh:?}");
}

//! What a cut vector takes over surfaces with charts, counted in the questions that its proofs ask: what takes little is asked first, and what has
//! been told once is not asked again.

use std::{cell::Cell, thread::LocalKey};

use super::{
    beyond_ends::poly_conic,
    refused::{AMPLE, Found},
    *,
};
use crate::{
    clearance::{CERTIFIED, CONTACTS_ASKED, JUDGED, LOOKS, PARTS_ASKED, STEADY_ASKED},
    verify::tests::lofts,
};

/// A corner that touches neither of its slanted lines, a bull nose and a ball.
const SEVEN_NUMBERS: &[f64] = &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0];
const BULL_NOSE: &[f64] = &[0.5, 0.1];
const BALL: &[f64] = &[0.5, 0.25];
/// A flat bottom with a slanted flank.
const TAPERED: &[f64] = &[0.6, 0.0, 0.3, 0.0, 0.0, 8.0, 4.0];

/// Asks counted in a pass in the plane y = .4 over a part surface, for each cut vector.
fn each(part: &Geometry, cutter: &[f64], counter: &'static LocalKey<Cell<u64>>) -> f64 {
    each_within(1e-5, part, cutter, counter)
}

/// The same with an OUTTOL.
fn each_within(outside: f64, part: &Geometry, cutter: &[f64], counter: &'static LocalKey<Cell<u64>>) -> f64 {
    let (drive, end) = (plane(0.0, 1.0, 0.0, 0.4), plane(1.0, 0.0, 0.0, 1.2));
    let mut p = Program::new();
    p.tolerance(0.0, outside).cutter(cutter);
    p.run(&MotionCommand::MaximumPoints(100_000));
    p.from(-1.5, 0.4, 6.0);
    p.go(&[(Relation::On, &drive), (Relation::To, part), (Relation::On, &plane(1.0, 0.0, 0.0, -1.2))]);
    p.indirv(1.0, 0.0, 0.0).side(DriveSide::On);
    let check = CheckSurface { relation: Relation::On, occurrence: 1, surface: named(&end), label: None };
    let before = counter.get();
    p.run(&MotionCommand::Drive { turn: Turn::Forward, drive: named(&drive), checks: vec![check] });
    let vectors = p.last().points.len();
    assert!(vectors > 10, "{vectors} vectors");
    (counter.get() - before) as f64 / vectors as f64
}

/// The most asks counted for each cut vector over a ruled and over a polyconic surface, with each of some cutters.
fn most(cutters: &[&[f64]], counter: &'static LocalKey<Cell<u64>>) -> f64 {
    let parts = [lofts::roof(), lofts::vault()];
    let all = parts.iter().flat_map(|part| cutters.iter().map(|cutter| each(part, cutter, counter)));
    all.fold(0.0, f64::max)
}

/// Where a path begins to bend the other way a clearance keeps its chord, which the contacts at its ends show: some hundred parts of the surface need
/// not be looked at.
#[test]
fn parts_are_hardly_asked_where_contacts_tell() {
    let asked = most(&[SEVEN_NUMBERS], &PARTS_ASKED);
    assert!(asked <= 0.03, "{asked} questions a vector");
}

/// Where a vector goes from limit to limit of the band its contacts tell nothing of its halves: that is found out once, not for each of them.
#[test]
fn contacts_are_not_asked_again_where_they_tell_nothing() {
    let asked = most(&[SEVEN_NUMBERS, BULL_NOSE, BALL], &CONTACTS_ASKED);
    assert!(asked <= 2.0, "{asked} questions a vector");
}

/// One bound serves all pieces of a vector that are in the ball which tells it.
#[test]
fn a_steady_ball_is_asked_about_vectors_not_about_their_pieces() {
    let asked = most(&[SEVEN_NUMBERS, BULL_NOSE, BALL], &STEADY_ASKED);
    assert!(asked <= 4.0, "{asked} questions a vector");
}

/// A contact that was proven where a vector was led to need not be proven for that vector.
#[test]
fn ends_of_vectors_are_proven_once() {
    let proven = most(&[SEVEN_NUMBERS, BULL_NOSE, BALL], &CERTIFIED);
    assert!(proven <= 0.3, "{proven} proofs a vector");
}

/// A contact as closely as its own search tells it serves at a vertex, which lies so far inside the band: a slanted flank along a hollow, of which
/// a closer level takes many patches, is hardly ever proven anew.
#[test]
fn contacts_at_vertices_serve_as_they_were_found() {
    for outside in [1e-4, 3e-5] {
        let proven = each_within(outside, &lofts::vault(), TAPERED, &CERTIFIED);
        assert!(proven <= 0.75, "{proven} proofs a vector, OUTTOL {outside}");
    }
}

/// What few parts of the surface did not show is gone on with, not begun anew.
#[test]
fn an_end_of_the_tool_is_shown_to_be_far_at_one_go() {
    let looks = most(&[SEVEN_NUMBERS], &LOOKS);
    assert!(looks <= 32.0, "{looks} places a vector");
}

/// How far a check surface is from the tool, or how deep that is in it, far ahead on the way, is told no closer than steps along the way need it.
#[test]
fn a_check_surface_that_is_far_away_is_told_roughly() {
    let half = 2.230589996226933;
    let check = poly_conic(
        &[
            1.0,
            -0.4234538900267423,
            0.0186521955664635,
            -0.9057256199433522,
            -0.12597172654702096,
            0.9026792025904371,
            0.09314899526380079,
            -0.42011132083298747,
            -2.3840425045136397,
            0.07653143296654412,
            -0.9954774534271957,
            -0.05628125341703535,
            4.069319130195766,
            0.0,
            0.0,
            6.0,
        ],
        [
            [half, -0.04368564537964755],
            [half, -0.01948333243348371],
            [half, -0.040755361983603425],
            [-half, 0.025057488755130176],
            [-half, -0.02307274798232348],
            [half, -0.02523778792233706],
            [std::f64::consts::FRAC_1_SQRT_2, -0.011025401950677768],
        ],
    );
    let forward = v(-0.40980249293299637, 0.8837471163049693, 0.22594900134444607);
    let motion = Found {
        cutter: &[1.0347901910875301],
        axis: v(0.9613492514255069, -0.11861478321735552, -0.2484716281306929),
        from: v(-0.5292560346570911, 0.8997397133820318, -1.8273345122508637),
        band: [0.0005, 0.0],
        thickness: 0.0,
        drive_side: DriveSide::On,
        forward,
        part: (
            Relation::To,
            cylinder(v(2.3471696987363866, 1.9701600519770954, 0.0), Vec3::z(), 4.012174480526263),
        ),
        drive: (
            Relation::On,
            quadric([
                0.0945042820422351,
                0.08823338072027023,
                0.7642091592046729,
                7.637023494423502,
                -0.09710970419622213,
                0.14251874727001118,
                -0.01738570119856992,
                0.5971911134470131,
                -0.39156641931218594,
                2.5234100399893276,
            ]),
        ),
        first: (Relation::On, Geometry::Plane(Plane { normal: -forward, distance: -0.7315580390476326 })),
        stop: (Relation::Past, check),
    };
    let before = JUDGED.get();
    motion.run(AMPLE).expect("a path");
    let looked = JUDGED.get() - before;
    assert!(looked < 20_000, "{looked} patches of the tool looked at");
}

/// The bottom of a flat cutter lies along the crest of a polyconic, as near to it at both ends of a diameter. About its edge parts of the surface are
/// halved across the crest: how far they go along that is due to how they bend across it, and halves of the other side tell nothing more.
#[test]
fn parts_tell_that_a_flat_bottom_is_above_a_crest() {
    let motion = Found {
        cutter: &[0.9744679023728002],
        axis: Vec3::z(),
        from: v(-1.813124409816394, 1.4750456932466949, 0.21761951869529406),
        band: [2e-5, 3e-5],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.20460877218562903, 0.9788438334814648, 0.0),
        part: (
            Relation::To,
            poly_conic(
                &[
                    1.0,
                    -0.9990420255701976,
                    0.04375694243566355,
                    -0.0006009436567275022,
                    2.6781560747676108,
                    -0.04272373812129863,
                    -0.9782406023366842,
                    -0.20302710691162257,
                    0.5455411401146533,
                    -0.009471712914738698,
                    -0.2028069375752288,
                    0.9791729330030614,
                    3.516409214874722,
                    0.0,
                    0.0,
                    6.0,
                ],
                [
                    [1.9496175956945139, 0.039478151077648564],
                    [1.9496175956945139, -0.011278630969965654],
                    [1.9496175956945139, 0.023637334930777847],
                    [-1.9496175956945139, -0.01066716207408494],
                    [-1.9496175956945139, -0.038829196223069934],
                    [1.9496175956945139, 0.011037229779460943],
                    [std::f64::consts::FRAC_1_SQRT_2, -0.0010477658028172857],
                ],
            ),
        ),
        drive: (
            Relation::To,
            poly_conic(
                &[
                    1.0,
                    0.1102472011989009,
                    -0.6843263948821597,
                    0.720793271261182,
                    3.2358452313339754,
                    -0.3225593117826847,
                    0.661325283654242,
                    0.67720333695421,
                    -0.03391058586756612,
                    -0.940106932752913,
                    -0.30715835405735475,
                    -0.1478265893629657,
                    4.13966402632298,
                    0.0,
                    0.0,
                    6.0,
                ],
                [
                    [2.9841510549152557, -0.13920235961229735],
                    [2.9841510549152557, -0.1465795182073944],
                    [2.9841510549152557, 0.03390606697607068],
                    [-2.9841510549152557, -0.14847186585441544],
                    [-2.9841510549152557, -0.1968134698989348],
                    [2.9841510549152557, 0.015292548533720085],
                    [std::f64::consts::FRAC_1_SQRT_2, 0.0021588045615972135],
                ],
            ),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.204608772185629, 0.9788438334814648, 6.648398847735393e-17),
                distance: 1.4541487502560784,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Circle(Cylinder {
                point: v(-2.3543329324299025, 8.63673509411986, -0.5736770252172754),
                axis: Vec3::z(),
                radius: 7.10999088448813,
            }),
        ),
    };
    let sequences = motion.run(AMPLE).expect("a path");
    let vectors = sequences.last().map(|sequence| sequence.points.len());
    assert_eq!(vectors, Some(7));
}

//! Paths that come to the end of a surface that does not go on: what is told, and how soon.

use std::sync::Arc;

use DriveSide::On as TlOn;
use Relation::{On, Past, To};
use Turn::Forward;
use apt_geometry::canonical::{Cylinder, Remembering, TabulatedCylinder};

use super::{
    beyond_ends::poly_conic,
    closed_paths::table_through,
    economy::tabulated,
    refused::{AMPLE, Found},
    sculptured::{hill, made},
    sheets::{round_wall, ruled},
    *,
};
use crate::{
    clearance::EVALUATIONS,
    error::RoleName,
    section2::Execution,
    verify::{tests::lofts, verify},
};

/// Clearances until it is known that the path comes to the end. Most of them are spent where the extension begins.
const SOON: u64 = 10_000;

const BALL: &[f64] = &[0.5, 0.25];

/// Surfaces with ends, with the place where a pass along x begins.
fn passes() -> [(&'static str, Geometry, Vec3); 3] {
    [
        ("ruled", lofts::roof(), v(4.0, 0.4, 6.0)),
        ("polyconic", lofts::vault(), v(-1.0, 0.4, 6.0)),
        ("patch", made(vec![hill()]), v(1.0, 2.0, 6.0)),
    ]
}

/// A tool on a part surface, ready to go along x.
fn on_part(part: &Geometry, at: Vec3, cutter: &[f64]) -> (Program, Geometry) {
    let drive = y(at.y);
    let mut p = Program::new();
    p.tolerance(0.002, 0.002).cutter(cutter).from(at.x, at.y, at.z);
    p.run(&MotionCommand::MaximumPoints(1000));
    p.go(&[(On, &drive), (To, part), (On, &x(at.x))]).indirv(1.0, 0.0, 0.0).side(TlOn);
    (p, drive)
}

#[test]
fn a_part_surface_that_ends_before_the_check_surface_is_told_soon() {
    for (name, part, at) in passes() {
        let (mut p, drive) = on_part(&part, at, BALL);
        let before = EVALUATIONS.get();
        let failure = p.attempt(&motion(Forward, &drive, &[(On, 1, &x(500.0))])).expect_err("no way there");
        let cost = EVALUATIONS.get() - before;
        let MotionFailure::SurfaceEnds { role: RoleName::Part, tip, place, remaining } = failure else {
            panic!("{name}: {failure:?}");
        };
        let remaining = remaining.expect("a check surface that is crossed");
        assert!((remaining - (500.0 - tip.x)).abs() < 1e-6, "{name}: {remaining} at {tip}");
        // Where the tool is told to be it touches the end.
        let between = (place - tip - v(0.0, 0.0, BALL[1])).norm() - BALL[1];
        assert!(between.abs() <= 0.004, "{name}: {between} between {place} and the ball on {tip}");
        assert!(cost <= SOON, "{name}: {cost} clearances");
    }
}

#[test]
fn a_check_surface_a_little_before_the_end_is_met() {
    // The extension of the ruled surface ends at 18, and the ball touches it there at 18.23.
    let (mut p, drive) = on_part(&lofts::roof(), v(4.0, 0.4, 6.0), BALL);
    p.drive(Forward, &drive, On, &x(17.9)).verified();
    assert!((p.tip().x - 17.9).abs() < 1e-9);
}

#[test]
fn a_drive_surface_that_ends_is_told() {
    // Beside a wall that is straight along x and ends with its extension.
    let wall = round_wall();
    let mut p = Program::new();
    p.tolerance(0.001, 0.001).cutter(&[0.5]).from(3.0, 3.0, 1.0);
    p.go(&[(To, &wall), (To, &level(1.0)), (On, &x(3.0))]).side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
    let failure = p.attempt(&motion(Forward, &wall, &[(On, 1, &x(900.0))])).expect_err("no way there");
    assert!(matches!(failure, MotionFailure::SurfaceEnds { role: RoleName::Drive, .. }), "{failure:?}");
}

/// The top of a tool that is a line, under a plane that rises with y and ends at y 20, goes up past the end; the side of the tool then goes along that.
#[test]
fn a_line_whose_top_passes_the_end_goes_along_it() {
    let ramp = ruled([0.0, 4.0].map(|at| (level(at), v(-30.0, at, at), v(30.0, at, at), Vec3::z())));
    // The way of the top up the ramp is along (.8, 1, 1), that beside the end along (1, 0, .3).
    let floor = plane(0.3, 0.76, -1.0, 10.0);
    let mut p = Program::new();
    p.tolerance(0.002, 0.002).cutter(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 12.0]).from(-3.5, 5.0, -8.0);
    p.go(&[(To, &ramp), (To, &floor), (On, &x(-3.0))]).side(DriveSide::Left).indirv(1.0, 1.0, 0.0);
    p.drive(Forward, &ramp, On, &x(15.0)).verified();
    assert!((p.tip() - v(15.0, 20.0, 9.7)).norm() < 0.01, "{:?}", p.tip());
}

/// A quarter of a tube in a frame, which becomes wider or narrower by some slopes, as random motions drew it.
fn bent_tube(frame: [[f64; 4]; 3], root: f64, slopes: [f64; 7]) -> Geometry {
    let mut values = vec![1.0];
    values.extend(frame.concat());
    values.extend([0.0, 0.0, 6.0]);
    let constants = [root, root, root, -root, -root, root, std::f64::consts::FRAC_1_SQRT_2];
    for (constant, slope) in constants.into_iter().zip(slopes) {
        values.extend([constant, slope]);
        values.extend([0.0; 6]);
    }
    values.extend([0.0; 7]);
    Geometry::PolyConic(Remembering::new(values))
}

/// The outcome of a motion and how many clearances it takes; it is given up after so many.
pub(super) fn limited(p: &Program, motion: &MotionCommand, most: u64) -> (Execution, u64) {
    let before = EVALUATIONS.get();
    let taken = || EVALUATIONS.get() - before;
    let execution = execute(&p.state, motion, &|| taken() > most);
    (execution, taken())
}

/// Clearances until it is known that the path comes to the end: proofs beside the end take ten times as many.
const FEW: u64 = 6_000;

/// A ball that is held a little inside a surface has no place beside the end of that: the path turns away there. The end is looked for
/// where it is within sight of the tool, and known from what is just ahead.
#[test]
fn the_end_is_told_where_a_path_turns_away_beside_it() {
    let part = bent_tube(
        [
            [-0.7203098736145479, 0.31826242407683, 0.6163300377185381, 3.2769407274546487],
            [0.6649305279844482, 0.5698429247456475, 0.48285239366875826, 1.5632895124873518],
            [-0.19753753202180826, 0.7576200040508871, -0.6220858867826983, 2.4879464171815577],
        ],
        1.882338027343659,
        [
            0.22766491999288646,
            -0.13346673001331158,
            -0.1601852499202981,
            -0.05606693729027007,
            0.11917647553657851,
            -0.1686325335037907,
            0.005467286334565918,
        ],
    );
    let drive = plane(-0.9678283625021933, -0.02744948661376305, -0.2501095488400315, 0.1826977983457426);
    let first = plane(0.2332050278409635, -0.4710612262623264, -0.8507154260397121, 2.0420985820674877);
    let check = quadric([
        -0.11687352401546064,
        -0.10625833217570983,
        0.320680502367368,
        1.430974971838379,
        0.038575827015484815,
        0.09748639918028584,
        -0.11573944626939493,
        -0.4959262240460561,
        0.26818543390337624,
        -0.22882470333471683,
    ]);
    let axis = Some(v(0.270099827140038, -0.12480775439553388, 0.9547089126124599));
    let position = v(0.8990415489750634, -1.5005022122426463, -1.2475519542193017);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.27585590266142807, 0.13792795133071403]);
    p.run(&MotionCommand::From { position, axis, name: String::new() });
    p.go(&[(To, &drive), (To, &part), (To, &first)]).side(DriveSide::Left);
    p.indirv(0.2332050278409635, -0.47106122626232655, -0.8507154260397121);
    let (execution, taken) = limited(&p, &motion(Forward, &drive, &[(Past, 1, &check)]), FEW);
    let failure = execution.failure.expect("no way there");
    assert!(matches!(failure, MotionFailure::SurfaceEnds { role: RoleName::Part, .. }), "{failure:?}");
    assert!(taken <= FEW, "{taken} clearances");
}

/// The path of a bull nose in a hollow cylinder turns by more than a right angle where its flank comes to touch the cylinder. From the
/// vertex before that place a vector is found that leads there again, as long as one that would lead past it.
#[test]
fn a_vector_that_leads_to_a_vertex_again_does_not_spare_it() {
    let part = cylinder(
        v(-2.058840957235211, 2.7779792801222922, 1.2970464638532913),
        v(-0.2672455156396869, -0.9013104175424039, 0.34090961500083194),
        4.753828630690314,
    );
    let drive = bent_tube(
        [
            [-0.834816230924717, 0.16909682301197387, -0.5239161431297062, 5.544740764604678],
            [0.38569322992639965, -0.49943098478005177, -0.77576376805737, -2.226667760832782],
            [-0.3928391438917348, -0.8496910943918881, 0.3517135924833214, 6.1288225238283385],
        ],
        3.1787119852786665,
        [
            -0.02587088487042502,
            0.06638216425775362,
            0.14841800026993235,
            -0.18782704613055676,
            -0.19202864738287634,
            0.20020831195414102,
            -0.015374425082568699,
        ],
    );
    let first = plane(-0.5014350604196356, -0.3461225627517319, -0.7929451757442817, -0.8783495880284138);
    let axis = Some(v(-0.11190010355835574, 0.7004013759419494, 0.7049228889759882));
    let position = v(0.9089051103650092, 1.0855200263320435, 0.1405218317763555);
    let mut p = Program::new();
    p.tolerance(0.01, 0.005).cutter(&[0.24955940158870277, 0.03304866052981005]);
    p.run(&MotionCommand::From { position, axis, name: String::new() });
    p.go(&[(To, &drive), (To, &part), (On, &first)]).side(DriveSide::Right);
    p.indirv(0.5014350604196357, 0.3461225627517318, 0.7929451757442817);
    let (execution, taken) = limited(&p, &motion(Forward, &drive, &[(On, 1, &y(4.5))]), FEW);
    let Some(Output::Sequence(sequence)) = execution.output else {
        panic!("{:?} after {taken} clearances", execution.failure);
    };
    assert!(verify(&sequence, &|| false).expect("evidence").verified);
}

/// Questions of a motion beside an end: searches for a bound of how the clearance bends take seven times as many.
const FEWER: u64 = 15_000;

/// A flat cutter beside the end of a polyconic surface, within sight of which nothing is steady: parts of the surface show that vectors keep
/// the band, and not boxes of the tool.
#[test]
fn vectors_beside_the_end_are_proven_by_parts_of_the_surface() {
    let part = bent_tube(
        [
            [0.11445380397654385, -0.7851836295316635, 0.6085942775534302, 4.798563334730471],
            [-0.6398109404940856, -0.5269089292765575, -0.5594720195619307, 0.9793943721885351],
            [0.7599620300905647, -0.32535157624347655, -0.5626758077761229, 4.655280633970737],
        ],
        2.0742487532358806,
        [
            -0.02036718176571903,
            0.018359398615602526,
            0.04755213265210719,
            -0.01649244768957768,
            -0.02007079539469409,
            -0.03657078776688745,
            0.012324192808660013,
        ],
    );
    let drive = quadric([
        -0.5014949066457334,
        0.9330832296501397,
        -0.022288515765792806,
        9.204488618683262,
        0.08223900463676395,
        -0.11980765486853856,
        0.022280444747880688,
        0.17354510309725013,
        -3.1041332584068595,
        -0.21351462389926787,
    ]);
    let check = sphere(2.5861781436047018, 2.7813476061772957, 3.5922114884102267, 3.1692271377837224);
    let forward = v(0.6752997040828881, 0.3736562177465167, 0.635886263890746);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.0).cutter(&[0.9940641117502527]);
    let stock = 0.04566266908037695;
    p.run(&MotionCommand::Thickness(PerRole { part: stock, drive: stock, check: [stock; 2] }));
    p.from(-1.4131429690392063, 1.6195763568089125, 1.3861194276529698).side(DriveSide::On);
    p.go(&[(On, &drive), (To, &part)]).indirv(forward.x, forward.y, forward.z);
    let (execution, taken) = limited(&p, &motion(Forward, &drive, &[(On, 2, &check)]), FEWER);
    let failure = execution.failure.expect("no way there");
    assert!(matches!(failure, MotionFailure::SurfaceEnds { role: RoleName::Part, .. }), "{failure:?}");
    assert!(taken <= FEWER, "{taken} clearances");
}

/// A hook whose end points back to its long side. The extension would divide what is inside the hook.
#[test]
fn an_extension_that_would_come_back_to_its_curve_ends() {
    let hook = table_through(
        &[[0.0, 0.0, 0.0], [6.0, 0.0, 0.0], [8.0, 2.0, 90.0], [6.0, 4.0, 180.0], [5.0, 3.5, 240.0]],
        1.0,
    );
    let begun = || {
        let mut p = Program::new();
        p.tolerance(0.0, 0.001).cutter(&[0.5]).from(1.0, 2.0, 0.0);
        p.go(&[(To, &hook), (On, &ground()), (On, &x(1.0))]).side(DriveSide::Left).indirv(1.0, 0.0, 0.0);
        p
    };
    let mut p = begun();
    p.drive(Forward, &hook, On, &y(2.0)).ends(7.75, 2.0, 0.0, 0.01).verified();
    p.drive(Forward, &hook, On, &x(6.0)).ends(6.0, 3.75, 0.0, 0.01).verified();
    let failure = begun().attempt(&motion(Forward, &hook, &[(On, 1, &y(9.0))])).expect_err("no way there");
    let MotionFailure::SurfaceEnds { role: RoleName::Drive, place, .. } = failure else {
        panic!("{failure:?}");
    };
    let (sine, cosine) = 240f64.to_radians().sin_cos();
    assert!((place - v(5.0 + cosine, 3.5 + sine, place.z)).norm() < 1e-4, "{place}");
}

/// A vertex is put on the way where the last one does not see the stop. It was moved back all the way, for the vector that then leads beyond the stop
/// keeps its bands, and the last one still did not see the stop.
#[test]
fn a_vertex_before_a_stop_that_is_not_seen_from_the_last_one_stays() {
    let directrix = [
        [-8.0, -2.267_069_237_861_485_4, 0.0, 0.0],
        [
            1.586_497_875_248_584_8,
            -2.267_069_237_861_485_4,
            -0.087_945_175_931_947_82,
            0.250_038_041_732_284_14,
        ],
        [
            2.086_497_875_248_584_8,
            -1.991_272_848_831_993_5,
            -0.055_966_659_462_644_265,
            0.101_833_458_076_451_39,
        ],
        [
            2.586_497_875_248_584_8,
            -1.626_059_493_044_701_7,
            -0.055_966_659_462_644_265,
            0.002_126_433_332_556_439_5,
        ],
        [3.086_497_875_248_584_8, -1.260_846_137_257_409_8, 0.0, 0.0],
    ];
    let Geometry::TabulatedCylinder(cylinder) = tabulated(&directrix, [13.0, 5.0]) else {
        panic!("a tabulated cylinder");
    };
    let axes = [
        v(0.859_466_418_138_815_4, 0.420_488_386_970_572_06, -0.290_700_864_316_777_83),
        v(-0.335_329_438_007_256_45, 0.034_528_507_877_844_74, -0.941_467_976_167_786_2),
        v(-0.385_838_883_599_583_1, 0.906_640_666_728_895_4, 0.170_678_227_480_868_75),
    ];
    let part = Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder { axes, ..(*cylinder).clone() }));
    let height = 4.190_707_209_422_287;
    let drive = poly_conic(
        &[
            1.0,
            0.247_898_301_007_098_42,
            0.846_047_218_361_783_1,
            -0.471_964_550_215_461_6,
            3.811_959_930_525_844,
            0.467_639_915_842_813_6,
            0.322_153_742_535_410_24,
            0.823_122_029_398_408_8,
            -0.462_096_867_408_721_13,
            0.848_445_249_540_782_3,
            -0.424_760_015_152_930_2,
            -0.315_784_084_556_144_3,
            4.827_788_602_552_411,
            0.0,
            0.0,
            6.0,
        ],
        [
            [height, 0.001_738_584_987_589_254_8],
            [height, 0.107_449_481_893_595_27],
            [height, 0.098_508_266_320_903_04],
            [-height, 0.061_926_904_387_932_19],
            [-height, 0.007_367_583_615_209_061],
            [height, 0.006_786_162_260_312_145],
            [std::f64::consts::FRAC_1_SQRT_2, 0.025_652_320_015_988_016],
        ],
    );
    let motion = Found {
        cutter: &[0.558_874_620_090_225_7, 0.279_437_310_045_112_85],
        axis: v(-0.087_738_298_793_661_16, -0.212_415_576_410_018_62, 0.973_232_558_961_738_2),
        from: v(2.351_620_421_272_832, 1.490_918_851_012_551, 1.166_056_439_246_920_2),
        band: [0.0, 1e-4],
        thickness: 0.0,
        drive_side: TlOn,
        forward: v(0.327, 0.936, -0.131),
        part: (On, part),
        drive: (On, drive),
        first: (On, level(0.0)),
        stop: (
            Past,
            Geometry::Circle(Cylinder {
                point: v(3.027_908_337_290_21, 3.631_060_876_390_784, 6.426_141_956_815_416),
                axis: Vec3::z(),
                radius: 3.243_227_019_004_417_7,
            }),
        ),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    let vectors = sequences.last().expect("a motion").points.len();
    assert!(vectors <= 5, "{vectors} vectors");
}

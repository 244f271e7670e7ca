//! Random motions around tight bends, past surfaces that the tool touches with another part than before, and from where two
//! sides of the drive surface would do.

use apt_geometry::canonical::{Cone, Cylinder, Remembering, RuledSurface};

use super::{
    ends::limited,
    refused::{AMPLE, Found, turns_sharply},
    sheets::ruled,
    *,
};
use crate::verify::verify;

fn is_delivered(motion: &Found) {
    let sequences = motion.run(AMPLE).expect("a path");
    assert_eq!(sequences.len(), 2);
}

/// From the middle of the band to its limit no vector leads past a tight bend.
#[test]
fn a_lens_cutter_gets_round_a_bend_on_a_level() {
    let motion = Found {
        cutter: &[1.0, 0.1875, 0.33, 0.22, 6.830430776130537, 5.0, 2.034399071486589],
        axis: v(0.2743201268978522, -0.4872554137301453, 0.829054057205808),
        from: v(1.932271361599631, 0.4145999562787791, 0.8219560846834704),
        band: [0.0005, 0.0],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.3124654224835965, -0.40196832278195155, 0.8606897392394152),
        part: (
            Relation::To,
            Geometry::Circle(Cylinder {
                point: v(-1.59808647051409, 3.254229077714206, 1.768602533874725),
                axis: v(0.0, 0.0, 1.0),
                radius: 3.1274786869036406,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Quadric(Quadric {
                coefficients: [
                    -0.32563496407754033,
                    -1.5979370693976251,
                    0.5405306654814732,
                    10.361018480962038,
                    -0.2429751588003326,
                    0.03439024072734293,
                    0.732635689228503,
                    -0.19438940933484966,
                    -0.14905490689037984,
                    -2.1764779195575326,
                ],
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-0.3124654224835963, -0.4019683227819517, 0.8606897392394152),
                distance: 0.1752717512392228,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Line(Plane {
                normal: v(-0.6137244583180014, -0.789520290595673, 0.0),
                distance: -0.926333311478422,
            }),
        ),
    };
    is_delivered(&motion);
}

/// Where the path turns tightly a vector has ended at the limit of the band on whose side the next one sags. None leads from there to the other
/// limit, and on a level there is room for short ones only.
#[test]
fn a_flat_cutter_at_the_wrong_limit_of_the_band_goes_inward() {
    let arc = cylinder(
        v(-0.16784421715820463, -5.627465421248393, -2.139722101997199),
        v(-0.4210040575800915, -0.060749608888469975, 0.9050221370336733),
        6.001186332945495,
    );
    let across = v(-0.2970871075594128, -0.9334849106193136, -0.2008610767870022);
    let straight = plane(across.x, across.y, across.z, 1.3085019874749997);
    let strip = ruled([
        (
            arc,
            v(5.407615636870052, -1.9254347245986538, -2.6124308282907087),
            v(-1.7251599220327152, -0.2361933592346952, -5.817111223566135),
            v(0.16676471872772985, 0.9755629036197576, 0.14306134931786774),
        ),
        (
            straight,
            v(2.78160606070646, -2.874839561585584, 2.731928323542074),
            v(-4.151199036830222, -0.015783828909404773, -0.30120473099483713),
            across,
        ),
    ]);
    let drive = quadric([
        0.0818756258577166,
        0.03540271348983006,
        0.28709656661784333,
        0.7168895638265679,
        0.053692961099671144,
        -0.0931103495296875,
        -0.05361597660838097,
        0.13999418496545446,
        0.5090553741455424,
        0.09173060440588161,
    ]);
    let stop = sphere(6.78592700572511, -2.2981127687979046, 0.9212183933850553, 7.496005740708918);
    let mut p = Program::new();
    p.tolerance(0.01, 0.005).cutter(&[1.161920615897211]);
    p.from(1.5688812861380392, 0.29341443102352693, 0.4775323033163531);
    p.go(&[(Relation::To, &drive), (Relation::To, &strip)]).side(DriveSide::Right);
    p.indirv(-0.6567028252775652, 0.4523552052616749, -0.6034203903955615);
    p.run(&MotionCommand::MaximumStep(10.0));
    p.drive(Turn::Forward, &drive, Relation::To, &stop).verified();
    let count = p.last().points.len();
    assert!(count <= 14, "{count} vectors");
}

/// Soon after the tangency another part of the tool goes into the check surface: seen from a long way off the slope never
/// changes its sign.
#[test]
fn a_tangency_before_another_part_of_the_tool_goes_in_is_found() {
    let motion = Found {
        cutter: &[1.1988762989249946, 0.27112178854404073],
        axis: v(-0.7056769743592767, -0.42867928863854393, -0.5641401203171857),
        from: v(-0.9093753963857598, -0.24706690499676182, 0.21624345220152297),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.0, -0.0, -1.0),
        part: (
            Relation::On,
            Geometry::Circle(Cylinder {
                point: v(-5.7883313183606955, -3.1028754097733353, -0.17075435283552487),
                axis: v(0.0, 0.0, 1.0),
                radius: 6.162183207271337,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Circle(Cylinder {
                point: v(1.1677872574744166, 5.82115365050019, -0.48356212690098815),
                axis: v(0.0, 0.0, 1.0),
                radius: 5.460679063586384,
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-1.0353013404798411e-16, -6.541490021871942e-17, -1.0),
                distance: 1.287233399500737,
            }),
        ),
        stop: (
            Relation::TangentToDrive,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.269021652314857,
                    0.1572437768631698,
                    -0.11374335774073532,
                    -0.2809322780309085,
                    -0.09765473298566306,
                    -0.02059741758635271,
                    0.03421590029239295,
                    0.9419670957276968,
                    -0.23739547161191726,
                    -0.6216648499864745,
                ],
            }),
        ),
    };
    is_delivered(&motion);
}

/// The way along the second wall leads back by a little more than a right angle, which no vector of no length hides.
#[test]
fn no_vector_without_length_hides_how_a_path_turns() {
    let motion = Found {
        cutter: &[
            0.4561163986690853,
            0.0,
            0.22805819933454266,
            0.13703119082646406,
            31.0,
            0.0,
            3.383459357964606,
        ],
        axis: v(0.0, 0.0, 1.0),
        from: v(0.9654196526501286, 0.6771124957312995, -0.7289830957873278),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.7762758596403075, -0.6275689700396138, 0.059606858524164676),
        part: (
            Relation::To,
            Geometry::Cylinder(Cylinder {
                point: v(0.5338335702710564, 0.9906171185574818, 5.447393476837533),
                axis: v(-0.903956204955161, -0.4259754026324791, 0.03752513657750371),
                radius: 7.052714395473617,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-0.6286868189333942, 0.7776585907063649, 1.0747943122258738e-16),
                distance: -0.39822515626262345,
            }),
        ),
        first: (
            Relation::Past,
            Geometry::Plane(Plane {
                normal: v(0.7762758596403075, 0.627568970039614, -0.059606858524164516),
                distance: 0.9308653633524715,
            }),
        ),
        stop: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(-1.1589031707657842, 1.0357325050624733, -1.7429690108773908),
                axis: v(0.536670246430031, -0.17508090496061965, 0.8254282060330264),
                cosine: 0.9148348435652561,
            }),
        ),
    };
    turns_sharply(&motion);
}

/// A tool as thin as the band is in tolerance on both sides of its drive surface, and TLLFT tells on which it shall be.
#[test]
fn between_two_sides_in_tolerance_the_side_told_decides() {
    let motion = Found {
        cutter: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.001],
        axis: v(-0.43924035818181206, 0.7445882733595628, 0.5026491926977885),
        from: v(-1.5016167626767303, 1.0035319184745939, -1.0225488086906962),
        band: [2e-5, 3e-5],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.49345443711927284, -0.5648523234098581, -0.6613959262240634),
        part: (
            Relation::On,
            Geometry::Line(Plane {
                normal: v(0.753099326907141, -0.6579068352069397, 0.0),
                distance: -1.2412152318353291,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.3923668527200942,
                    0.08789169196752522,
                    0.048186262042478334,
                    -1.1020732843873766,
                    0.06394805163639186,
                    0.0735193509388986,
                    0.06844865232520157,
                    0.6357418575400853,
                    0.40923722502367643,
                    -0.28380084884241247,
                ],
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.49345443711927295, -0.5648523234098581, -0.6613959262240634),
                distance: -0.24504616781103195,
            }),
        ),
        stop: (
            Relation::TangentToDrive,
            Geometry::Cone(Cone {
                vertex: v(-1.3783432363238641, -0.8777565096610384, -3.403276115001089),
                axis: v(-0.1228783286344567, 0.10174787583265149, 0.987192122190785),
                cosine: 0.6910350613384698,
            }),
        ),
    };
    is_delivered(&motion);
}

/// The path meets its stop on a kink, right behind a place where it turns: neither is found by following slopes.
#[test]
fn a_lens_cutter_stops_on_a_kink() {
    let motion = Found {
        cutter: &[1.0, 0.1875, 0.33, 0.22, 8.867206503621937, 5.0, 2.5665999423951833],
        axis: v(0.44043501321344997, -0.026224198619435764, 0.8974014099289329),
        from: v(0.5681609920134517, -1.090967461681523, 1.354272019146752),
        band: [0.001, 0.001],
        thickness: 0.061657537307898344,
        drive_side: DriveSide::Right,
        forward: v(-0.6582224827054662, -0.5744169935957502, 0.48660896079857824),
        part: (
            Relation::To,
            Geometry::Sphere(Sphere {
                center: v(2.7250043427322876, 2.0225366960243587, 7.492993426787426),
                radius: 7.736484929979694,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Hyperbola(Quadric {
                coefficients: [
                    0.5588948215754924,
                    0.22597735546073242,
                    0.0,
                    2.9054311368818864,
                    0.0,
                    0.0,
                    -0.5125559641761737,
                    -1.8198740852893016,
                    0.9667362629398542,
                    0.0,
                ],
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.6582224827054661, -0.5744169935957502, 0.48660896079857835),
                distance: 0.5762378765440257,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.13984855105821933,
                    0.14236822221865994,
                    0.042222927589588705,
                    -0.44539691324839414,
                    -0.09758172902929371,
                    0.017562477013940387,
                    0.20678290173143293,
                    -0.135723177743098,
                    0.2024649604667238,
                    0.05173595427198133,
                ],
            }),
        ),
    };
    is_delivered(&motion);
}

/// A flat bottom lies on a ruling of a cone, along which no bend of the clearance has a bound near the vertex.
#[test]
fn a_flat_cutter_goes_along_a_ruling_of_a_cone() {
    let motion = Found {
        cutter: &[1.1210241276703612],
        axis: v(0.0, 0.0, 1.0),
        from: v(-1.547930607334039, -1.5970102085779296, 1.8629244281812245),
        band: [0.001, 0.001],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(0.926025364234117, -0.37746128913449006, 0.0),
        part: (
            Relation::To,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.17438285248871851,
                    0.20312921419567492,
                    -0.14067084979744748,
                    -1.0008515973768741,
                    0.010863527193828618,
                    -0.1039450150433783,
                    0.009482537987498573,
                    0.36942939486572157,
                    0.17973514729605244,
                    0.5631456713598391,
                ],
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(0.3774612891344901, 0.926025364234117, 7.140313134131847e-17),
                distance: -0.7163963688057049,
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-0.926025364234117, 0.37746128913448995, 5.304659199275757e-17),
                distance: 0.14724984732465649,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Sphere(Sphere {
                center: v(0.39151049561122575, -1.7421794450228687, 1.3540223760455137),
                radius: 1.0994168506722175,
            }),
        ),
    };
    is_delivered(&motion);
}

/// Beside the vertex of a hollow cone the path turns smoothly by 106° within a few widths of the bands: no vector that leads past the
/// bend from before it, however well it keeps the bands.
#[test]
fn a_tight_bend_is_not_left_out_before_the_end() {
    let motion = Found {
        cutter: &[
            0.37701668373671865,
            0.0,
            0.18850834186835932,
            0.0,
            0.0,
            5.558446825561225,
            4.0148644956192765,
        ],
        axis: v(0.0, 0.0, 1.0),
        from: v(-0.2824675831546037, 2.547259492061339, 2.22998330062625),
        band: [0.01, 0.005],
        thickness: 0.08475043104265333,
        drive_side: DriveSide::Right,
        forward: v(-0.7071736411662053, 0.0015787576757876742, -0.7070381522689793),
        part: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(-1.1930424796563566, 1.0394691334774415, 0.8727549121253729),
                axis: v(0.0502332189908144, 0.70040104938901, 0.7119796301331902),
                cosine: 0.5910037954416876,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Line(Plane {
                normal: v(0.002232483861994045, 0.999997508004798, 0.0),
                distance: 0.5970273534942839,
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-0.7071736411662054, 0.0015787576757877967, -0.7070381522689791),
                distance: -0.09303545659658985,
            }),
        ),
        stop: (Relation::On, circle(-6.5726727866282175, 1.7253217334457278, 5.134832072283215)),
    };
    is_delivered(&motion);
}

/// A tapered tool comes to touch a second wall, along which the path goes on by 108°: a vector may set out onward, into the wall that is to be
/// left, and come back from there.
#[test]
fn no_vector_round_a_corner_leads_into_the_wall_that_is_left() {
    let motion = Found {
        cutter: &[
            0.8555870912639161,
            0.0,
            0.42779354563195804,
            0.0,
            0.0,
            11.804692004856864,
            3.2805463009647333,
        ],
        axis: v(0.0, 0.0, 1.0),
        from: v(-0.9428548685789957, 1.0079600124577526, 1.1882847556047145),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::On,
        forward: v(-0.7600240391526114, -0.12412229226066236, 0.6379319058285989),
        part: (
            Relation::To,
            quadric([
                0.10179588747911555,
                0.20403845213968966,
                0.45340562281635716,
                1.1372929822936715,
                0.4567288950739785,
                -0.04137516840226272,
                -0.1413486988172346,
                0.5350819477678618,
                -0.34308642387774796,
                -0.8089007563312961,
            ]),
        ),
        drive: (
            Relation::On,
            Geometry::Cylinder(Cylinder {
                point: v(-1.3403260751406623, -4.257678143063907, 0.021696042204175647),
                axis: v(0.4241741401807861, -0.23089147522581666, 0.8756514292056726),
                radius: 5.911956098255567,
            }),
        ),
        first: (
            Relation::On,
            plane(0.7600240391526116, 0.12412229226066222, -0.6379319058285987, -1.5609934057874328),
        ),
        stop: (Relation::On, level(-7.0)),
    };
    turns_sharply(&motion);
}

/// Clearances: more than a path takes that goes on, where two vertices that take turns take them for ever.
const MOST_TAKEN: u64 = 6_000;

/// The path of a bull nose along a cone over a ruled surface turns by more than a right angle. Two vertices there take turns in sparing each
/// other, where vectors that end nearer than is of use count.
#[test]
fn a_vector_that_ends_nearer_than_is_of_use_spares_no_vertex() {
    let arc = Cylinder {
        point: v(-5.231147834218437, -3.4474985765119084, 0.5887712394955513),
        axis: v(-0.22367706901417267, 0.6202981883160509, 0.7517969981112284),
        radius: 7.541308585198577,
    };
    let parts = vec![
        Geometry::Circle(arc),
        Geometry::Point(v(1.5918751748671105, -1.2266498880946277, -3.204054000063243)),
        Geometry::Point(v(1.7475865762526066, -7.373398741250831, 1.9138784433851332)),
        Geometry::Vector(v(0.9744689448176795, 0.15772843656204794, 0.15978740840757874)),
        Geometry::Point(v(-1.0817486452104588, 0.819386675980093, 6.283638693941539)),
    ];
    let part = Geometry::RuledSurface(Remembering::new(RuledSurface { parts }));
    let drive = Geometry::Cone(Cone {
        vertex: v(-1.0366337649854276, -2.2104312163748125, -2.015946193288439),
        axis: v(0.12565204483084674, 0.6967139611341875, 0.7062586070204999),
        cosine: 0.5629295162951071,
    });
    let first = plane(0.16840509491356653, -0.37268170510602866, 0.9125503113179108, 0.4491931435694896);
    let axis = Some(v(-0.46574889394095675, -0.2613070139674189, 0.8454564520093312));
    let position = v(0.07267956947794077, -1.8105935248511564, -0.15609830511681583);
    let mut p = Program::new();
    p.tolerance(2e-5, 3e-5).cutter(&[0.9434443952440172, 0.1133681143422038]);
    p.run(&MotionCommand::From { position, axis, name: String::new() });
    p.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &first)]).side(DriveSide::Left);
    p.indirv(0.1684050949135663, -0.37268170510602866, 0.9125503113179109);
    let onward = motion(Turn::Forward, &drive, &[(Relation::On, 1, &x(0.6))]);
    let (execution, taken) = limited(&p, &onward, MOST_TAKEN);
    let Some(Output::Sequence(sequence)) = execution.output else {
        panic!("{:?} after {taken} clearances", execution.failure);
    };
    assert!(verify(&sequence, &|| false).expect("evidence").verified);
}

/// A tool that begins beside the very limit of its band, as after a tangency where INTOL is zero, leaves it nowhere, by as little as a proof leaves
/// open.
#[test]
fn a_vector_from_the_limit_of_the_band_does_not_leave_it() {
    let drive = circle(-2.541890174, 1.098333649, 0.493498904);
    let part = quadric([0.02, -0.015, 0.0, 0.0, 0.0, 0.0, 0.002, 0.0, 0.0, 0.25]);
    let mut p = Program::new();
    p.tolerance(0.0, 0.002).cutter(&[0.4, 0.06]).from(
        -2.6970254270692147,
        1.7742580411751216,
        -0.122618700735408,
    );
    p.run(&MotionCommand::PartSurface(named(&part)));
    p.side(DriveSide::Right).indirv(-1.0, -0.22, 0.0);
    p.drive(Turn::Forward, &drive, Relation::On, &y(0.8)).verified();
    let evidence = verify(p.last(), &|| false).expect("evidence");
    let least = evidence.drive.expect("a drive surface").min;
    assert!(least >= -1e-11, "{least}");
}

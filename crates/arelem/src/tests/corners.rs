//! Motions that begin in a corner, where the tool touches a surface at two places at once, or turn in one by nearly a right angle.

use super::{
    refused::{AMPLE, Found, turns_sharply},
    *,
};

fn is_delivered(motion: &Found) {
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    assert_eq!(sequences.len(), 1);
}

/// Two upright walls that cross, in one of the four corners between them: the motion takes the wall that leads more in the direction
/// asked for and away from the other.
#[test]
fn a_motion_out_of_a_corner_goes_along_the_wall_that_leads_in_its_direction() {
    // The planes x = 0 and y = 0, turned about z.
    for turn in [0.0_f64, 0.4, 1.1, 2.3] {
        let (sine, cosine) = turn.sin_cos();
        let at = |x: f64, y: f64| v(cosine * x - sine * y, sine * x + cosine * y, 0.0);
        let (a, c) = (-sine * cosine, 0.5 * (cosine * cosine - sine * sine));
        let walls = quadric([a, -a, 0.0, 0.0, 0.0, 0.0, c, 0.0, 0.0, 0.0]);
        for (ahead, goal) in [
            ([1.0, 0.3], [2.0, 0.5]),
            ([0.3, 1.0], [0.5, 2.0]),
            ([1.0, -0.4], [2.0, 0.5]),
            ([-0.4, 1.0], [0.5, 2.0]),
        ] {
            let [forward, goal] = [at(ahead[0], ahead[1]), at(goal[0], goal[1])];
            let from = at(0.5, 0.5);
            let along = (goal - from).normalize();
            let check = plane(along.x, along.y, 0.0, along.dot(&goal));
            let mut program = Program::new();
            program.cutter(&[1.0]).tolerance(0.001, 0.001).from(from.x, from.y, 0.0);
            program.run(&MotionCommand::PartSurface(named(&ground())));
            // Left or right is as the motion goes.
            let side =
                if along.cross(&(at(1.0, 1.0) - along)).z > 0.0 { DriveSide::Left } else { DriveSide::Right };
            program.side(side).indirv(forward.x, forward.y, 0.0);
            program.drive(Turn::Forward, &walls, Relation::On, &check).verified();
            program.ends(goal.x, goal.y, 0.0, 0.002);
            let evidence = crate::verify::verify(program.last(), &|| false).expect("evidence");
            assert!(evidence.verified, "{turn} {ahead:?}: {evidence:?}");
        }
    }
}

/// Slope of the legs of a corner y = s·|x| into which a path goes, and in which it turns by 127°, more than a right angle.
const STEEP: f64 = 2.0;

/// A tool of radius 0.5 in a corner of walls as steep or on its left leg, going along them in a direction, to where x is a half.
fn along_walls(steep: f64, in_corner: bool, ahead: [f64; 2]) -> Program {
    let walls = quadric([-steep * steep, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let length = steep.hypot(1.0);
    let along_normal = 0.5 / length;
    let from = if in_corner {
        v(0.0, 0.5 * length, 0.0)
    } else {
        v(-1.0 + along_normal * steep, steep + along_normal, 0.0)
    };
    let mut program = Program::new();
    program.cutter(&[1.0]).tolerance(0.001, 0.001).from(from.x, from.y, 0.0);
    program.run(&MotionCommand::PartSurface(named(&ground())));
    program.side(DriveSide::Left).indirv(ahead[0], ahead[1], 0.0);
    program.drive(Turn::Forward, &walls, Relation::On, &plane(1.0, 0.0, 0.0, 0.5)).verified();
    let foot = 0.5 + along_normal * steep;
    program.ends(0.5, foot * steep + along_normal, 0.0, 0.005);
    program
}

/// The path goes on along the other leg, though that leads back rather than on: the tool keeps to its side of both.
#[test]
fn a_path_goes_on_along_the_other_leg_of_a_corner_that_turns_it_by_more_than_a_right_angle() {
    let program = along_walls(STEEP, false, [1.0, -STEEP]);
    let points = &program.last().points;
    let lowest = points.iter().map(|point| point.tip.y).fold(f64::INFINITY, f64::min);
    assert!((lowest - 0.5 * STEEP.hypot(1.0)).abs() < 0.005, "{lowest}");
    assert!(points.len() <= 4, "{} vectors", points.len());
}

/// Neither on nor back leads the other leg of a corner that turns the path by a right angle, or by some degrees more or less.
#[test]
fn a_path_turns_by_about_a_right_angle() {
    for steep in [0.9, 0.93, 0.96, 0.98, 0.99, 0.999, 1.0, 1.001, 1.01, 1.02] {
        let program = along_walls(steep, false, [1.0, -steep]);
        let points = &program.last().points;
        assert!(points.len() <= 4, "{steep}: {} vectors", points.len());
    }
}

/// A drill between two leaning walls, the first of which it touches with its top, goes along that towards the other by so much, then turns.
fn between_leaning_walls(back: f64, band: [f64; 2]) -> Result<CutSequence, MotionFailure> {
    let drill = [0.34831118696644797, 0.0, 0.17415559348322399, 0.10464323770744212, 31.0, 0.0, 4.5];
    let [part, first, second] =
        [v(-0.0061, 0.8981, 0.4398), v(0.1117, 0.9509, -0.2885), v(0.8541, 0.3943, 0.3393)]
            .map(|n| n.normalize());
    // The surfaces touch a tool whose end is in the origin.
    let corner = |normal: &Vec3, height: f64| {
        let aside = v(-normal.x, -normal.y, 0.0).normalize() * (0.5 * drill[0]);
        normal.dot(&(aside + Vec3::z() * height))
    };
    let [to_part, to_first, to_second] =
        [corner(&part, drill[3]), corner(&first, drill[6]), corner(&second, drill[3])];
    let product = |k: usize, l: usize| 0.5 * (first[k] * second[l] + first[l] * second[k]);
    let along = |k: usize| -0.5 * (first[k] * to_second + second[k] * to_first);
    let walls = quadric([
        product(0, 0),
        product(1, 1),
        product(2, 2),
        to_first * to_second,
        product(1, 2),
        product(0, 2),
        product(0, 1),
        along(0),
        along(1),
        along(2),
    ]);
    let way = first.cross(&part).normalize();
    let way = -way * way.dot(&second).signum();
    let onward = part.cross(&second).normalize();
    let onward = onward * onward.dot(&first).signum();
    let from = -way * back;
    let mut program = Program::new();
    program.cutter(&drill).tolerance(band[0], band[1]).from(from.x, from.y, from.z);
    program.run(&MotionCommand::PartSurface(named(&plane(part.x, part.y, part.z, to_part))));
    let side = if part.cross(&way).dot(&first) > 0.0 { DriveSide::Right } else { DriveSide::Left };
    program.side(side).indirv(way.x, way.y, way.z);
    let check = plane(onward.x, onward.y, onward.z, 0.7);
    let command = motion(Turn::Forward, &walls, &[(Relation::On, 1, &check)]);
    program.cut(&command)
}

/// The vector that leads into the corner goes from one limit of a wide band to the other, so that the other leg leads against it, though not
/// against the way along the first wall.
#[test]
fn a_path_goes_on_from_a_corner_that_it_comes_to_across_its_band() {
    for back in [0.43, 0.4645030883977572, 0.5] {
        let sequence = between_leaning_walls(back, [0.01, 0.005]).expect("a path");
        assert!(sequence.points.len() <= 3, "{back}: {} vectors", sequence.points.len());
        let evidence = crate::verify::verify(&sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{back}: {evidence:?}");
    }
}

/// The direction asked for is square to one leg, or against its way into the corner: the other leg is meant.
#[test]
fn a_direction_that_leads_out_of_a_steep_corner_is_followed() {
    for ahead in [[1.0, 1.0], [STEEP, 1.0], [1.0, 0.45], [0.2, 1.0], [1.0, STEEP]] {
        along_walls(STEEP, true, ahead);
    }
}

/// It stands in the hollow of its drive surface and touches it with its corner and its top.
#[test]
fn a_bull_nose_leaves_a_corner_of_a_hollow_cylinder_along_its_other_side() {
    let motion = Found {
        cutter: &[0.7800536784839662, 0.09391975733580687],
        axis: v(-0.11927238064794078, -0.010606524274105737, 0.9928049158104504),
        from: v(0.9984818405508801, 1.7884727915159324, -0.8701700145194773),
        band: [0.0005, 0.0],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.7436386748858599, 0.07524653379220118, -0.6643338621252582),
        part: (
            Relation::To,
            Geometry::Cylinder(Cylinder {
                point: v(4.785535299052525, -0.3753247844761387, -2.3258905429239745),
                axis: v(0.8100623654377005, 0.2947491960317172, 0.5068746152059044),
                radius: 4.00618397151849,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Cylinder(Cylinder {
                point: v(1.3639680859392258, 2.1719804504801252, 5.69953225405755),
                axis: v(-0.16627536942034493, 0.0014326411721152911, -0.9860783179156714),
                radius: 1.1887764179152944,
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(0.7436386748858598, -0.07524653379220131, 0.6643338621252582),
                distance: 1.7689389459649008,
            }),
        ),
        stop: (
            Relation::To,
            Geometry::GeneralConic(Quadric {
                coefficients: [
                    0.0031420533074492172,
                    0.061649972214367105,
                    0.0,
                    -0.07862704944936237,
                    0.0,
                    0.0,
                    -0.013917884145957838,
                    -0.4999935936826879,
                    -0.055766153243905985,
                    0.0,
                ],
            }),
        ),
    };
    is_delivered(&motion);
}

/// Its end touches one side of the cone and its top the other, against which the line of motion along the one would lead it.
#[test]
fn a_ball_cutter_leaves_the_bottom_of_a_hollow_cone() {
    let motion = Found {
        cutter: &[0.3526659099965966, 0.1763329549982983],
        axis: v(-0.5660005284799845, 0.42423129179077135, -0.7068742553141342),
        from: v(-0.1308792229655256, -0.29182038536809857, -0.8675093810335415),
        band: [0.001, 0.001],
        thickness: 0.07024320983080139,
        drive_side: DriveSide::Left,
        forward: v(0.8334201439517545, 0.47756727006350747, 0.2781013596146659),
        part: (
            Relation::To,
            Geometry::Ellipse(Quadric {
                coefficients: [
                    0.13212890154235143,
                    0.07580273547718222,
                    0.0,
                    -0.1167536180731591,
                    0.0,
                    0.0,
                    -0.030518289627333727,
                    0.3100512366691414,
                    -0.17507378461585957,
                    0.0,
                ],
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(-2.1408858010990133, -2.4306513136644137, 1.0037127528053091),
                axis: v(0.26729563632455194, 0.5655644528047543, -0.7801858064112112),
                cosine: 0.9113166304215633,
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(0.8334201439517545, 0.4775672700635075, 0.278101359614666),
                distance: -2.3372774020631626,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Hyperbola(Quadric {
                coefficients: [
                    0.08188476301611969,
                    -0.43354856113260004,
                    0.0,
                    0.5533427614608608,
                    0.0,
                    0.0,
                    -0.07794339342566085,
                    0.3608409503957899,
                    -0.2068315698187335,
                    0.0,
                ],
            }),
        ),
    };
    is_delivered(&motion);
}

/// Both walls that it touches lead away from each other, one of them by 56° from where it is to go.
#[test]
fn a_drill_takes_the_wall_that_leads_in_its_direction() {
    let motion = Found {
        cutter: &[
            1.1238105787516637,
            0.0,
            0.5619052893758318,
            0.33762676000922276,
            31.0,
            0.0,
            3.649602713613346,
        ],
        axis: v(0.0, 0.0, 1.0),
        from: v(0.09160541250234411, 1.6420010122954827, 1.8616655915378895),
        band: [0.001, 0.001],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.791717007063346, 0.5677129366770632, -0.22557970266884053),
        part: (
            Relation::To,
            Geometry::Sphere(Sphere {
                center: v(-1.0386637495457234, 2.5975250935135312, 8.161096671318722),
                radius: 6.470463342298668,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Quadric(Quadric {
                coefficients: [
                    -0.23788586494771152,
                    0.1820624225382661,
                    0.047789835449899884,
                    -1.8421844136597323,
                    -0.21008422434542573,
                    -0.21390090179092563,
                    -0.1589826508183592,
                    1.1454860622272927,
                    0.9645554787155997,
                    0.09265999581955886,
                ],
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(0.7917170070633459, -0.5677129366770634, 0.22557970266884067),
                distance: 0.9146997225966481,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Sphere(Sphere {
                center: v(-5.517031788467824, 4.291853071423976, -1.00282410735033),
                radius: 5.116851777380605,
            }),
        ),
    };
    is_delivered(&motion);
}

/// By more than that from the vector, and by 85° from the path at the end of it.
#[test]
fn a_path_turns_by_nearly_a_right_angle_at_the_end_of_a_long_vector() {
    let motion = Found {
        cutter: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.211037175266056],
        axis: v(-0.3252387767942736, 0.3204385048829988, 0.8896847209307986),
        from: v(-0.682044066297497, -2.084713470718187, 1.9238272798079943),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.3427178739488312, -0.9388922734279345, -0.03202745343167286),
        part: (
            Relation::To,
            Geometry::Sphere(Sphere {
                center: v(-4.571165826479774, -0.0907727140807757, 8.356851676927405),
                radius: 7.770951984032344,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Ellipse(Quadric {
                coefficients: [
                    0.2209695748822944,
                    0.11993207903569789,
                    0.0,
                    -0.7521471253576547,
                    0.0,
                    0.0,
                    -0.112447810870458,
                    0.18739052301771342,
                    -0.17004112681930447,
                    0.0,
                ],
            }),
        ),
        first: (
            Relation::Past,
            Geometry::Plane(Plane {
                normal: v(-0.3427178739488312, -0.9388922734279345, -0.03202745343167289),
                distance: 1.3050680819427884,
            }),
        ),
        stop: (
            Relation::Past,
            Geometry::Sphere(Sphere {
                center: v(0.49945732690363354, 0.7590001926363046, 5.165078687765392),
                radius: 5.049536099640626,
            }),
        ),
    };
    is_delivered(&motion);
}

/// A drill comes to a second wall of a hollow cylinder whose normal is no more than 29° off the first one: the path turns back there on the same
/// hand, and leaves the first one for good.
#[test]
fn a_path_turns_back_at_a_wall_that_leads_nearly_as_the_one_it_follows() {
    turns_sharply(&Found {
        cutter: &[
            0.7918153029275952,
            0.0,
            0.3959076514637976,
            0.23788531653628503,
            31.0,
            0.0,
            2.935502570974566,
        ],
        axis: Vec3::z(),
        from: v(-31.72932, 18.88887, -8.41726),
        band: [0.0, 1e-4],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.71, 0.54, 0.45),
        part: (
            Relation::To,
            Geometry::Cylinder(Cylinder {
                point: v(-0.13496993179232075, -1.0407919902321896, 6.486933378184856),
                axis: v(-0.8537377134395682, 0.3988648985101645, -0.3347218388265906),
                radius: 5.274078585233665,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(4.684823933889515, -4.109552691704335, 5.307368418436364),
                axis: v(-0.9478635457151164, 0.2520084685072516, -0.1950549422726766),
                cosine: 0.9578990169699616,
            }),
        ),
        first: (Relation::On, plane(-0.71, 0.54, 0.45, 28.94)),
        stop: (Relation::On, plane(0.7348, -0.4094, 0.5399, -34.9)),
    });
}

/// The legs of a wedge lie so near to each other that its walls, which the tool touches with either end, hardly lead out of the way: the path goes on along
/// the second wall all the same, not back along the first one.
#[test]
fn a_path_goes_on_along_the_second_wall_of_a_narrow_wedge() {
    let part = Cylinder {
        point: v(1.0745626479693733, -5.526176601892004, -1.9549970615224568),
        axis: Vec3::z(),
        radius: 5.735895176247769,
    };
    let drive = Cone {
        vertex: v(4.631953942339921, 1.5160070722084114, -3.176560899546045),
        axis: v(-0.8314734417216468, 0.12157307176914522, -0.5420995332336798),
        cosine: 0.5267792880295258,
    };
    let motion = Found {
        cutter: &[
            0.6356648243768328,
            0.0,
            0.3178324121884164,
            0.0,
            0.0,
            14.040644674086582,
            4.393232149355843,
        ],
        axis: v(-0.5729472487170439, -0.8190844375821711, 0.0288467380871471),
        from: v(6.544664990266997, -5.097217966438834, -164.5102027037552),
        band: [2e-5, 3e-5],
        thickness: 0.0,
        drive_side: DriveSide::On,
        forward: -Vec3::z(),
        part: (Relation::To, Geometry::Circle(part)),
        drive: (Relation::On, Geometry::Cone(drive)),
        first: (Relation::On, Geometry::Cone(drive)),
        stop: (Relation::On, plane(0.0, 0.0, 1.0, -163.0)),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    let end = sequences[0].points.last().expect("a position").tip;
    assert!(end.y < -5.14, "{end}");
}

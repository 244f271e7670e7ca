//! Random motions that end where the path does, or turn there, and what is told about it.

use apt_geometry::{
    canonical::{Remembering, RuledSurface},
    cutter::Cutter,
};

use super::*;
use crate::{clearance::EVALUATIONS, error::RoleName, verify::verify};

/// A start-up and a directed motion.
pub(super) struct Found {
    pub(super) cutter: &'static [f64],
    pub(super) axis: Vec3,
    pub(super) from: Vec3,
    /// INTOL and OUTTOL.
    pub(super) band: [f64; 2],
    pub(super) thickness: f64,
    pub(super) drive_side: DriveSide,
    pub(super) forward: Vec3,
    pub(super) part: (Relation, Geometry),
    pub(super) drive: (Relation, Geometry),
    pub(super) first: (Relation, Geometry),
    pub(super) stop: (Relation, Geometry),
}

impl Found {
    /// Runs both, taking at most so many clearances; what they found is proven.
    pub(super) fn run(&self, most: u64) -> Result<Vec<CutSequence>, MotionFailure> {
        let [part, drive, first] =
            [&self.part, &self.drive, &self.first].map(|(relation, surface)| (*relation, surface));
        self.run_after(&start(&[drive, part, first]), most)
    }

    /// The same without a start-up, from where the tool is.
    pub(super) fn run_from_there(&self, most: u64) -> Result<Vec<CutSequence>, MotionFailure> {
        self.run_after(&MotionCommand::PartSurface(named(&self.part.1)), most)
    }

    fn run_after(&self, begin: &MotionCommand, most: u64) -> Result<Vec<CutSequence>, MotionFailure> {
        let ahead = Some(Direction::Vector(self.forward));
        let [part, drive, stop] =
            [&self.part, &self.drive, &self.stop].map(|(relation, surface)| (*relation, surface));
        let commands = [
            MotionCommand::Cutter(self.cutter.to_vec()),
            MotionCommand::InsideTolerance(PerRole::all(self.band[0])),
            MotionCommand::OutsideTolerance(PerRole::all(self.band[1])),
            MotionCommand::Thickness(PerRole::all(self.thickness)),
            MotionCommand::PartSide(if part.0 == Relation::On { PartSide::On } else { PartSide::Offset }),
            MotionCommand::MaximumStep(10.0),
            MotionCommand::MaximumPoints(1500),
            MotionCommand::From { position: self.from, axis: Some(self.axis), name: String::new() },
            begin.clone(),
            MotionCommand::DriveSide(self.drive_side),
            MotionCommand::Direction([ahead, None, None]),
            motion(Turn::Forward, drive.1, &[(stop.0, 1, stop.1)]),
        ];
        let before = EVALUATIONS.get();
        let spent = || EVALUATIONS.get() - before > most;
        let mut state = State::new(1.0);
        let mut sequences = Vec::new();
        for command in &commands {
            let execution = execute(&state, command, &spent);
            state = execution.state;
            if let Some(failure) = execution.failure {
                return Err(failure);
            }
            if let Some(Output::Sequence(sequence)) = execution.output {
                let evidence = verify(&sequence, &|| false).expect("evidence");
                assert!(evidence.verified, "{evidence:?}");
                sequences.push(sequence);
            }
        }
        Ok(sequences)
    }
}

/// More clearances than any of these motions needs.
pub(super) const AMPLE: u64 = 50_000;

/// The motion goes on from a corner of its part surface by more than a right angle.
pub(super) fn turns_sharply(motion: &Found) {
    let sequences = motion.run(AMPLE).expect("a path");
    let path = &sequences[1];
    let tips: Vec<Vec3> = [path.start.tip].into_iter().chain(path.points.iter().map(|p| p.tip)).collect();
    let turns = tips.windows(3).any(|at| (at[1] - at[0]).dot(&(at[2] - at[1])) < 0.0);
    assert!(turns, "{tips:?}");
}

/// Its end touches one wall, then its shank the other, and the way along that wall leads away from the first one, against the way until then.
#[test]
fn a_ball_cutter_that_lies_across_a_hollow_cylinder_goes_on_along_its_other_wall() {
    let part = Geometry::Ellipse(Quadric {
        coefficients: [
            0.08993875338833873,
            0.09697819719383527,
            0.0,
            0.40908312280705683,
            0.0,
            0.0,
            -0.010654530733057749,
            -0.11385923486863764,
            -0.3344702964321053,
            0.0,
        ],
    });
    let drive = Geometry::Sphere(Sphere {
        center: v(-2.833153384380343, 1.8982225094385798, -5.14141965309226),
        radius: 7.087251577006694,
    });
    let motion = Found {
        cutter: &[0.7659524331191407, 0.38297621655957037],
        axis: v(-0.2925123745516589, 0.9459075545547606, -0.1403403326573745),
        from: v(0.7972180822494815, 1.287651878704031, 0.17207748472717954),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.8117789464284786, 0.12705107546912783, 0.569976285785301),
        part: (Relation::To, part),
        drive: (Relation::To, drive),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.8117789464284787, 0.12705107546912786, 0.5699762857853011),
                distance: -0.49575257652258403,
            }),
        ),
        stop: (
            Relation::Past,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.08280748333809697,
                    0.017694854094106406,
                    0.11384437344540137,
                    0.02150312081886452,
                    -0.04488038466814519,
                    -0.0030401139255012994,
                    0.0008072484545385565,
                    0.2885076799798757,
                    0.019802285240807547,
                    -0.05367473764578081,
                ],
            }),
        ),
    };
    turns_sharply(&motion);
}

/// The same with a flat cutter along a hollow cone.
#[test]
fn a_flat_cutter_that_leans_in_a_hollow_cylinder_goes_on_along_its_other_wall() {
    let part = Geometry::Circle(Cylinder {
        point: v(1.6691746439091308, 1.0544464952541002, -0.786633375219504),
        axis: v(0.0, 0.0, 1.0),
        radius: 2.822530737917733,
    });
    let drive = Geometry::Cone(Cone {
        vertex: v(-0.25657765617754547, -0.22541540282291628, 0.7507825083163797),
        axis: v(-0.26888991764169795, 0.23544823665512177, -0.9339498594928075),
        cosine: 0.5479868478559156,
    });
    let motion = Found {
        cutter: &[0.7013812468619891],
        axis: v(0.9169756586669205, 0.15801591654638333, -0.3663149076005147),
        from: v(-0.041968308896993316, 0.507035852677432, -1.2226762575659251),
        band: [0.001, 0.001],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(0.026439008433103508, -0.9392041776425804, 0.34233973116160327),
        part: (Relation::To, part),
        drive: (Relation::To, drive),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(0.026439008433103508, -0.9392041776425804, 0.34233973116160327),
                distance: -1.008499851064969,
            }),
        ),
        stop: (
            Relation::Past,
            Geometry::Cylinder(Cylinder {
                point: v(4.025675255187121, -4.55022260167686, 1.0748215302051451),
                axis: v(-0.3480913881966068, -0.4614869546505911, -0.81600378439728),
                radius: 6.852050178876079,
            }),
        ),
    };
    turns_sharply(&motion);
}

/// The same with a tapered one whose end is on the drive surface.
#[test]
fn a_tapered_tool_that_lies_across_a_hollow_cylinder_goes_on_along_its_other_wall() {
    let part = Geometry::Circle(Cylinder {
        point: v(1.5561240421288838, 0.2714733427062874, -2.026735291973663),
        axis: v(0.0, 0.0, 1.0),
        radius: 2.6394492273198127,
    });
    let drive = Geometry::Cylinder(Cylinder {
        point: v(-2.6782719951385268, 1.7504619140295699, -5.262570638664751),
        axis: v(-0.5854468739132258, -0.8001503785143145, -0.13042748785678093),
        radius: 4.248717274375101,
    });
    let motion = Found {
        cutter: &[
            0.3565450764054637,
            0.0,
            0.17827253820273184,
            0.0,
            0.0,
            14.009751277796518,
            3.6300934448475353,
        ],
        axis: v(0.8677055179280312, 0.44041207837362034, -0.23048716966433372),
        from: v(-0.33602123705888204, -0.7309648142077111, -1.3446521609616595),
        band: [0.01, 0.005],
        thickness: 0.14458833454033673,
        drive_side: DriveSide::On,
        forward: v(-0.09758924730023891, 0.8410008684989092, 0.5321596358194157),
        part: (Relation::To, part),
        drive: (Relation::On, drive),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.09758924730023892, 0.8410008684989093, 0.5321596358194158),
                distance: -1.0670171365017742,
            }),
        ),
        stop: (
            Relation::Past,
            Geometry::Sphere(Sphere {
                center: v(0.38853317226964235, 8.02683895935386, 0.21969122602797597),
                radius: 7.012504146120578,
            }),
        ),
    };
    turns_sharply(&motion);
}

/// MAXDP far below the band on a saddle: the end at rest in the band lies farther across the path than one vector may go.
#[test]
fn a_longest_vector_far_below_the_band_ends_where_the_path_is() {
    let part = quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5]);
    let drive = plane(0.0, 1.0, 0.0, 0.3);
    let wall = |x: f64| plane(1.0, 0.0, 0.0, x);
    let mut p = Program::new();
    p.tolerance(0.0, 0.05).cutter(&[0.5, 0.25]).run(&MotionCommand::MaximumPoints(1000));
    p.from(-1.5, 0.3, 6.0);
    p.go(&[(Relation::On, &drive), (Relation::To, &part), (Relation::On, &wall(-1.2))]);
    p.run(&MotionCommand::MaximumStep(0.004));
    p.indirv(1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &drive, Relation::On, &wall(-0.9)).verified();
    for sequence in &p.sequences {
        assert!(verify(sequence, &|| false).is_ok_and(|evidence| evidence.verified));
    }
    assert!((p.tip().x + 0.9).abs() < 1e-9);
}

/// The top edge of a tapered tool is wider than its flat bottom, on which nothing is looked for beyond its edge.
#[test]
fn no_contact_with_the_bottom_lies_beyond_its_edge() {
    let cutter =
        Cutter::from_numbers(&[0.3860014724, 0.0, 0.1930007362, 0.0, 0.0, 12.6092980263, 2.40689816], 1.0);
    let (cutter, axis) = (
        cutter.expect("a cutter"),
        v(0.8869204544580213, 0.41769317288408786, -0.19724228955779413).normalize(),
    );
    let geometry = quadric([
        0.22474609577302357,
        0.21254830467134764,
        0.09802944802802933,
        0.9378839075214218,
        0.006744956230221784,
        -0.06823286406198292,
        -0.0014769373775230536,
        -0.3310506660625299,
        -0.024167699863006507,
        0.43379528896509223,
    ]);
    let role = touched(&geometry);
    let tool = Tool::new(cutter, axis);
    let (from, to) = (v(-0.601614, -2.097499, -6.646959), v(-0.450553, -2.722510, -5.295171));
    for k in 0..=40 {
        let tip = from + (to - from) * (f64::from(k) / 40.0);
        let place = crate::sequence::ToolPosition { tip, axis };
        let read = read_by_verifier(&role, cutter, place);
        let found = gauge(&role).contact(&tool, &tip).clearance;
        assert!((found - read).abs() < 1e-9, "{k}: {found} {read}");
    }
}

/// A path past a cylinder on one long vector: at its ends the slope has the same sign.
#[test]
fn a_tangency_in_the_middle_of_a_long_vector_is_found() {
    let part = Geometry::Circle(Cylinder {
        point: v(-6.6626390663628, -3.866091234851262, 1.8218956848225423),
        axis: v(0.0, 0.0, 1.0),
        radius: 5.732800945814817,
    });
    let drive = Geometry::Cone(Cone {
        vertex: v(-4.833716067916479, -3.3929622262979553, -0.5348639913930977),
        axis: v(0.13402613066804875, -0.2307041891081761, 0.9637492274581029),
        cosine: 0.4729186847050721,
    });
    let motion = Found {
        cutter: &[
            0.23344982068792736,
            0.0,
            0.11672491034396368,
            0.0,
            0.0,
            10.641139425576606,
            2.5813384034641165,
        ],
        axis: v(-0.9887391803590723, 0.08350201779374462, 0.1241863367977457),
        from: v(-1.6493119724813738, -2.362472248972289, 1.9679280885433923),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(0.34246447167583466, -0.6974007852055019, -0.6295635237484308),
        part: (Relation::To, part),
        drive: (Relation::To, drive),
        first: (
            Relation::Past,
            Geometry::Plane(Plane {
                normal: v(0.34246447167583477, -0.6974007852055017, -0.6295635237484308),
                distance: -2.1042100735655573,
            }),
        ),
        stop: (
            Relation::TangentToDrive,
            Geometry::Cylinder(Cylinder {
                point: v(-3.9897371847887326, -2.8026116557150793, 3.9029717877212375),
                axis: v(-0.8255798675205225, 0.40239638769479197, 0.3955945266494208),
                radius: 2.9768545007743104,
            }),
        ),
    };
    let sequences = motion.run(AMPLE).expect("a path");
    assert_eq!(sequences.len(), 2);
}

/// In the narrow end of an ellipse along a cone the tool turns on the spot, bit by bit, until it goes back along the other side of the end.
#[test]
fn a_path_that_turns_back_on_the_spot_goes_on_along_the_other_wall() {
    let motion = Found {
        cutter: &[0.5538439700773867, 0.16915670338002262],
        axis: v(0.0, 0.0, 1.0),
        from: v(-0.5480962021314171, 0.271825259760935, -1.1335367908447467),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.05353183534880281, 0.9985661433296188, 0.0),
        part: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(-3.498318622976069, -4.82462733654642, -1.641608164714932),
                axis: v(0.262856422431742, 0.42727819968396497, -0.8650663796849439),
                cosine: 0.501657411725158,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Ellipse(Quadric {
                coefficients: [
                    1.4195902078603821,
                    0.09792183230487649,
                    0.0,
                    -0.4945833383185727,
                    0.0,
                    0.0,
                    0.2397719454565712,
                    0.48793474421754335,
                    0.22166975978727618,
                    0.0,
                ],
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(0.05353183534880286, -0.9985661433296188, -1.0378514116909118e-17),
                distance: 0.294976424727361,
            }),
        ),
        stop: (
            Relation::To,
            Geometry::Circle(Cylinder {
                point: v(-0.7916550680906114, 0.6981867802635764, -1.4724514613349104),
                axis: v(0.0, 0.0, 1.0),
                radius: 1.244218724186388,
            }),
        ),
    };
    let sequences = motion.run(AMPLE).expect("a path");
    let path: Vec<Vec3> = sequences[1].points.iter().map(|point| point.tip).collect();
    let corner = v(-0.6147, 1.4463, -1.6583);
    let turn = path.iter().position(|tip| (tip - corner).norm() < 1e-3).expect("the corner is on the path");
    let (before, beyond) = (path[turn] - path[turn - 1], path[turn + 1] - path[turn]);
    assert!(before.dot(&beyond) < 0.0, "{path:?}");
}

/// A start aside of the drive surface by more than MAXDP: no vector leads back into the band.
#[test]
fn a_way_back_into_the_bands_that_maxdp_does_not_allow_is_told() {
    let ball = sphere(0.0, 0.0, 0.0, 5.0);
    for step in [0.2, 0.24, 0.249, 0.2499, 0.3] {
        let mut p = Program::new();
        p.tolerance(0.01, 0.01)
            .cutter(&[0.5, 0.25])
            .run(&MotionCommand::MaximumStep(step))
            .from(-3.0, 0.0, 7.0);
        p.go(&[
            (Relation::On, &plane(0.0, 1.0, 0.0, 1.0)),
            (Relation::To, &ball),
            (Relation::On, &plane(1.0, 0.0, 0.0, -1.0)),
        ]);
        p.tolerance(0.3, 0.01).side(DriveSide::Left);
        let command =
            motion(Turn::Right, &plane(0.0, 1.0, 0.0, 1.0), &[(Relation::On, 1, &plane(1.0, 0.0, 0.0, 1.0))]);
        match p.attempt(&command) {
            Ok(_) => _ = p.verified(),
            Err(failure) => {
                assert!(matches!(failure, MotionFailure::NoAdmissibleVector { .. }), "{failure:?}");
            }
        }
    }
}

/// Beside a wall of rulings that touches the line from both sides in turn corrections to one place of a vector lead far back along the path,
/// into the band of the check surface: the motion led there, against its direction.
#[test]
fn a_position_far_along_the_path_is_not_next_to_a_place_of_it() {
    let floor = RuledSurface {
        parts: vec![
            Geometry::Plane(Plane {
                normal: v(-0.5130572280621063, 0.04455211814051614, -0.857197404045545),
                distance: -0.34337791495918396,
            }),
            Geometry::Point(v(0.2760546602361189, 4.7926317520213715, 0.48444847154809545)),
            Geometry::Point(v(-5.502924961196748, -0.21312277757980058, 3.683163593028847)),
            Geometry::Vector(v(-0.5130572280621063, 0.04455211814051611, -0.8571974040455451)),
            Geometry::Plane(Plane {
                normal: v(-0.6719496895572603, -0.10880022943023872, -0.7325613454038024),
                distance: -0.019544626079062724,
            }),
            Geometry::Point(v(2.573305500848547, -0.10141911723583186, -2.318649207721929)),
            Geometry::Point(v(-1.7935724854186006, -4.8679465169701235, 2.3948421654543797)),
            Geometry::Vector(v(-0.6719496895572602, -0.10880022943023859, -0.7325613454038025)),
        ],
    };
    let arc = |point, radius| {
        let axis = v(-0.19166538589377907, -0.41803382090664143, -0.8879820406001367);
        Geometry::Circle(Cylinder { point, axis, radius })
    };
    let across = v(0.7228319550069443, -0.672148370822923, 0.16040739515661098);
    let wall = RuledSurface {
        parts: vec![
            arc(v(-8.137365045638436, 10.695622211517634, -0.4169474829571562), 13.437036094231267),
            Geometry::Point(v(4.365662328868199, 5.771968863894891, 2.580698790780787)),
            Geometry::Point(v(-0.9456288567989692, 0.8830308708937327, 6.028665037953754)),
            Geometry::Vector(across),
            arc(v(13.522868455401401, -9.445837443829443, 4.389787485410949), 17.59854695048061),
            Geometry::Point(v(3.2156700135055245, 3.263765938455042, -2.7471934528200332)),
            Geometry::Point(v(-2.095621172161644, -1.6251720545461161, 0.7007727943529334)),
            Geometry::Vector(-across),
        ],
    };
    let motion = Found {
        cutter: &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 3.8967772508241594],
        axis: v(0.0, 0.0, 1.0),
        from: v(-0.2777050379971634, 0.5830542508941794, 0.4502625065760658),
        band: [0.01, 0.005],
        thickness: 0.034982228299922744,
        drive_side: DriveSide::Left,
        forward: v(-0.6141358977865509, -0.6241045542620281, 0.483043454036469),
        part: (Relation::To, Geometry::RuledSurface(Remembering::new(floor))),
        drive: (Relation::To, Geometry::RuledSurface(Remembering::new(wall))),
        first: (Relation::On, level(0.0)),
        stop: (
            Relation::To,
            Geometry::Ellipse(Quadric {
                coefficients: [
                    0.5405146895041177,
                    0.13154858515602458,
                    0.0,
                    -0.00990980856512702,
                    0.0,
                    0.0,
                    0.1491785327811344,
                    0.5290710877537427,
                    -0.060565223922065425,
                    0.0,
                ],
            }),
        ),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    let end = sequences[0].points.last().expect("an end").tip;
    assert!((end - motion.from).dot(&motion.forward) > 0.0, "the motion led back, to {end:?}");
}

/// A tool that goes deeper into its check surface than its radius would stop TO it beyond where it stops PAST it: that is told before anything
/// moves. Of the surfaces that it keeps to it may be deeper.
#[test]
fn an_undercut_of_a_check_surface_deeper_than_the_radius_is_told() {
    let (wall, floor, stop) =
        (plane(0.0, 1.0, 0.0, 0.0), plane(0.0, 0.0, 1.0, 0.0), plane(1.0, 0.0, 0.0, 5.0));
    let outcome = |relation, others: f64, check: f64| {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(0.0, -2.0, 3.0);
        p.run(&MotionCommand::Thickness(PerRole { part: others, drive: others, check: [check; 2] }));
        p.go(&[(Relation::To, &wall), (Relation::To, &floor)]);
        p.part_side(PartSide::Offset).side(DriveSide::Right);
        p.attempt(&motion(Turn::Right, &wall, &[(relation, 1, &stop)])).map(|_| p.tip().x)
    };
    let told = MotionFailure::UndercutTooDeep { role: RoleName::Check(0), thickness: -0.3, radius: 0.25 };
    for (relation, radius) in [(Relation::To, -0.25), (Relation::Past, 0.25)] {
        assert_eq!(outcome(relation, 0.0, -0.3), Err(told.clone()), "{relation:?}");
        let stopped = outcome(relation, -0.2, -0.2).expect("a path");
        let undercut = 0.2_f64.copysign(radius);
        assert!((stopped - 5.0 - radius + undercut).abs() < 1e-3, "{relation:?} {stopped}");
    }
}

/// Where one surface is both drive and part surface, or is followed and to stop at.
#[test]
fn a_surface_in_two_roles_is_told() {
    let (ring, floor, across) = (circle(0.0, 0.0, 2.0), plane(0.0, 0.0, 1.0, 0.0), plane(1.0, 0.0, 0.0, 0.0));
    let warnings = |part: &Geometry, check: &Geometry| {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(5.0, 0.0, 0.0);
        p.go(&[(Relation::To, &ring), (Relation::To, &floor)]);
        p.run(&MotionCommand::PartSurface(named(part))).part_side(PartSide::Offset).side(DriveSide::Right);
        let _ = p.attempt(&motion(Turn::Right, &ring, &[(Relation::On, 1, check)]));
        p.warnings
    };
    let twice = |roles| [MotionWarning::SurfaceTwice { roles, start_up: false }];
    assert_eq!(warnings(&floor, &across), []);
    assert_eq!(warnings(&ring, &across), twice([RoleName::Part, RoleName::Drive]));
    assert_eq!(warnings(&floor, &ring), twice([RoleName::Drive, RoleName::Check(0)]));
}

/// A start-up that names one surface twice tells the tool no more than the other surfaces do.
#[test]
fn a_surface_named_twice_by_a_start_up_is_told() {
    let [ring, floor, across] = [circle(0.0, 0.0, 2.0), plane(0.0, 0.0, 1.0, 0.0), plane(1.0, 0.0, 0.0, 0.0)];
    let warnings = |surfaces: &[(Relation, &Geometry)]| {
        let mut p = Program::new();
        p.cutter(&[0.5]).from(5.0, 0.5, 1.0).indirv(-1.0, 0.0, 0.0);
        let _ = p.attempt(&start(surfaces));
        p.warnings
    };
    let twice = |one, other| [MotionWarning::SurfaceTwice { roles: [one, other], start_up: true }];
    let [to, on] = [Relation::To, Relation::On];
    assert_eq!(warnings(&[(to, &ring), (to, &floor), (on, &across)]), []);
    assert_eq!(warnings(&[(to, &ring), (to, &ring)]), twice(RoleName::Drive, RoleName::Part));
    assert_eq!(
        warnings(&[(to, &ring), (on, &floor), (to, &ring)]),
        twice(RoleName::Drive, RoleName::Check(0))
    );
    assert_eq!(
        warnings(&[(to, &ring), (to, &floor), (on, &floor)]),
        twice(RoleName::Part, RoleName::Check(0))
    );
}

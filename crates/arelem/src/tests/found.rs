//! Motions in which the random motions once found a fault.

use std::sync::Arc;

use apt_geometry::{canonical::TabulatedCylinder, cutter::Cutter};
use proptest::prelude::*;

use super::{
    refused::{AMPLE, Found},
    *,
};
use crate::{clearance::EVALUATIONS, sequence::ToolPosition, verify::verify};

/// Runs commands and has every sequence proven by sampling and by the verifier.
fn proven(program: &mut Program, commands: &[MotionCommand]) {
    for command in commands {
        program.run(command);
    }
    for sequence in &program.sequences {
        let evidence = verify(sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{evidence:?}");
        assert_in_tolerance(sequence);
    }
}

/// Clearances of a tool outside a surface, from the engine and from the verifier.
fn outside(geometry: &Geometry, cutter: Cutter, place: ToolPosition) -> [f64; 2] {
    let role = touched(geometry);
    let engine = gauge(&role).contact(&Tool::new(cutter, place.axis), &place.tip).clearance;
    [engine, read_by_verifier(&role, cutter, place)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    /// Every tangent plane bounds the clearance of a tool outside a cone from below, however near to each other those two
    /// are which touch the flank of the tool along its whole length.
    #[test]
    fn no_plane_tangent_to_a_cone_leaves_more_than_the_clearance(
        degrees in 10.0..80.0f64, lean in prop::array::uniform2(-1.5..1.5f64), which in 0usize..4,
        sector in -0.6..0.6f64, ahead in -1.0..3.0f64, depth in -0.02..0.02f64,
    ) {
        let numbers: [&[f64]; 4] = [
            &[0.8844, 0.0, 0.4422, 0.2657, 31.0, 0.0, 3.7726],
            &[0.5],
            &[0.4, 0.0, 0.2, 0.0, 0.0, 8.0, 3.0],
            &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0],
        ];
        let cutter = Cutter::from_numbers(numbers[which], 1.0).expect("a cutter");
        let axis = v(lean[0], lean[1], 1.0).normalize();
        let tool = Tool::new(cutter, axis);
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let geometry = cone(Vec3::zeros(), -Vec3::z(), degrees);
        let normal = |angle: f64| v(angle.cos() * cosine, angle.sin() * cosine, sine);
        let left = |tip: &Vec3, angle: f64| {
            let n = normal(angle);
            let (along, across, _) = tool.split(&n);
            n.dot(tip) - tool.profile.support(across, -along).0
        };
        // Near the planes that the flank of the tool can lie on.
        let facing = lean[1].atan2(lean[0]) + std::f64::consts::FRAC_PI_2 + sector;
        let generator = v(facing.cos() * sine, facing.sin() * sine, -cosine);
        let tip = generator * ahead;
        let tip = tip + normal(facing) * (depth - left(&tip, facing));
        let greatest = (0..20_000)
            .map(|k| left(&tip, std::f64::consts::TAU * f64::from(k) / 20_000.0))
            .fold(f64::NEG_INFINITY, f64::max);
        for clearance in outside(&geometry, cutter, ToolPosition { tip, axis }) {
            prop_assert!(clearance >= greatest - 1e-12, "{clearance} {greatest}");
        }
    }
}

/// The greatest distance at which a plane through the vertex of a cone, which leaves the cone on one side, has the tool on the
/// other: among so many of these planes.
fn greatest_about_vertex(tool: &Tool, sine: f64, tip: &Vec3) -> f64 {
    let mut greatest = f64::NEG_INFINITY;
    for row in 0..=100 {
        let polar = sine.acos() * f64::from(row) / 100.0;
        for column in 0..400 {
            let (s, c) = (std::f64::consts::TAU * f64::from(column) / 400.0).sin_cos();
            let normal = v(polar.sin() * c, polar.sin() * s, polar.cos());
            let (along, across, _) = tool.split(&normal);
            greatest = greatest.max(normal.dot(tip) - tool.profile.support(across, -along).0);
        }
    }
    greatest
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]
    /// Whichever end of the tool the vertex of a cone pokes into, all planes that leave the cone on one side count, and no
    /// other ones.
    #[test]
    fn either_end_of_the_tool_is_measured_against_the_vertex_of_a_cone(
        degrees in 20.0..85.0f64, upside_down: bool, parallel: bool, which in 0usize..4,
        lean in prop::array::uniform2(-0.2..0.2f64), about in 0.0..6.3f64, out in 0.0..1.1f64, depth in -0.05..0.02f64,
    ) {
        let numbers: [&[f64]; 4] =
            [&[1.0, 0.5], &[0.5], &[0.6, 0.1], &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]];
        let cutter = Cutter::from_numbers(numbers[which], 1.0).expect("a cutter");
        let sense = if upside_down { -1.0 } else { 1.0 };
        let axis = v(lean[0], lean[1], 1.0).normalize();
        let axis = if parallel { Vec3::z() } else { axis } * sense;
        let tool = Tool::new(cutter, axis);
        let sine = degrees.to_radians().sin();
        let geometry = cone(Vec3::zeros(), -Vec3::z(), degrees);
        // That end of the tool which is below comes down on the vertex.
        let end = if upside_down { tool.profile.top.height } else { 0.0 };
        let out = out * tool.radius();
        let tip = v(out * about.cos(), out * about.sin(), depth) - axis * end;
        let greatest = greatest_about_vertex(&tool, sine, &tip);
        let [engine, _] = outside(&geometry, cutter, ToolPosition { tip, axis });
        // Neighbouring planes are 1° apart, and what they touch is not farther from the vertex than that end is wide.
        let spacing = 0.016 * 2.0 * tool.radius();
        prop_assert!(engine >= greatest - 1e-12 && engine <= greatest + spacing, "{engine} {greatest}");
    }
}

/// A drill along a cone past its vertex: two planes tangent to the cone, 19° apart, touch the flank of the drill along its
/// whole length, and one of them is the clearance.
#[test]
fn a_drill_passes_the_vertex_of_a_cone() {
    let part = Geometry::Hyperbola(Quadric {
        coefficients: [
            0.07274261771128547,
            -0.06956315942470848,
            0.0,
            -0.5550884899371203,
            0.0,
            0.0,
            0.002231886536947203,
            -0.22023533788837232,
            -0.13105261021221443,
            0.0,
        ],
    });
    let drive = Geometry::Cone(Cone {
        vertex: v(0.49415490247587607, 0.41257809925150524, 0.6986597706118892),
        axis: v(-0.13451435698309713, 0.2857749578480342, -0.9488090225289693),
        cosine: 0.4773341581357904,
    });
    let forward = v(-0.20048836044701732, 0.7549417448947716, 0.624393609144508);
    let first = Geometry::Plane(Plane { normal: forward, distance: -0.7846698388628192 });
    let stop = quadric([
        0.12612125748981895,
        0.5479106385346321,
        0.5040120530690814,
        2.5806445654722148,
        0.15559470561902497,
        0.06887196534673373,
        0.07610869277271223,
        -0.1527457237253949,
        -0.835639300160445,
        -1.2576573123499746,
    ]);
    let mut program = Program::new();
    let drill =
        [0.8844008956193401, 0.0, 0.44220044780967005, 0.26570083480518275, 31.0, 0.0, 3.7726040579003244];
    program.tolerance(0.001, 0.001).cutter(&drill).part_side(PartSide::Offset);
    let axis = v(0.700328072880832, 0.46747389101454895, 0.5394522699504914);
    let position = v(-0.34367752431162096, -1.1279433173126625, -0.07924665882035954);
    let commands = [
        MotionCommand::MaximumStep(10.0),
        MotionCommand::From { position, axis: Some(axis), name: String::new() },
        start(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &first)]),
        MotionCommand::DriveSide(DriveSide::Left),
        MotionCommand::Direction([Some(Direction::Vector(forward)), None, None]),
        motion(Turn::Forward, &drive, &[(Relation::Past, 1, &stop)]),
    ];
    proven(&mut program, &commands);
}

/// A tapered tool along a quadric that it touches at many places in turn: a vector that leaves the band is refused without
/// a look at each of them. In a corner of the part surface the path goes on, by more than a right angle.
#[test]
fn a_refused_vector_is_not_looked_at_in_full() {
    let part = cylinder(
        v(-0.02393729740386008, 1.904729646343306, -0.6621311819675073),
        v(0.883359421242827, -0.465064821357597, -0.05823096115610914),
        2.1759724640537748,
    );
    let drive = quadric([
        -0.12965525394616864,
        0.09333213822222539,
        0.07875072961869502,
        0.9401421290291097,
        -0.01934398732717536,
        0.019073390984080507,
        -0.04136036043681648,
        0.1811041466495679,
        -0.27515096832916286,
        -0.054510444527340614,
    ]);
    let forward = v(0.5101290440834747, 0.8572334348160595, -0.07013698465104552);
    let first = plane(forward.x, forward.y, forward.z, 1.6670267110349115);
    let stop = plane(0.6657384335185813, 0.6675261162298478, 0.3334684727036748, 5.767582181830138);
    let mut program = Program::new();
    program.tolerance(0.01, 0.005).part_side(PartSide::Offset);
    program.cutter(&[
        0.8986549495735254,
        0.0,
        0.4493274747867627,
        0.0,
        0.0,
        3.03950760023086,
        4.51907387104421,
    ]);
    program.run(&MotionCommand::Thickness(PerRole::all(0.020833878154289033)));
    program.run(&MotionCommand::MaximumStep(10.0));
    let axis = v(0.08266568898929015, 0.03230162705506617, 0.9960537077655609);
    let position = v(0.4699269514807328, 1.6543139293681843, 2.2747193817349025);
    program.run(&MotionCommand::From { position, axis: Some(axis), name: String::new() });
    program.go(&[(Relation::To, &drive), (Relation::To, &part), (Relation::On, &first)]);
    program.side(DriveSide::Right).indirv(forward.x, forward.y, forward.z);
    let before = EVALUATIONS.get();
    let outcome = program.attempt(&motion(Turn::Forward, &drive, &[(Relation::To, 1, &stop)]));
    let count = EVALUATIONS.get() - before;
    assert!(outcome.is_ok() && count < 6_500, "{count} clearances: {outcome:?}");
    for sequence in &program.sequences {
        assert!(verify(sequence, &|| false).is_ok_and(|evidence| evidence.verified));
    }
}

/// What was read before changes what a clearance costs, never what it is: also where contact goes from the corner of the
/// tool into its flat bottom.
#[test]
fn remembered_contacts_change_no_clearance() {
    let coefficients = [
        0.1297279357339584,
        0.12476985557554342,
        0.010160598964577099,
        2.333897378778821,
        -0.03558560739798311,
        -0.013772976651118755,
        0.05215052975278034,
        0.03901630241961035,
        -0.21962231325793002,
        0.5845250478487963,
    ];
    // A dome that the bottom of the tool touches.
    let geometry = Geometry::Quadric(Quadric { coefficients });
    let role = |thickness| Role {
        surface: named(&geometry),
        relation: Relation::To,
        side: 1.0,
        inside_tolerance: 0.0,
        outside_tolerance: 1e-4,
        thickness,
        disk: None,
    };
    let tool = Tool::new(Cutter::from_numbers(&[0.555_143_27, 0.082_817_995], 1.0).unwrap(), Vec3::z());
    let end = v(-1.1945026, 1.7694686, -1.6608008);
    let mut worst = 0.0_f64;
    for from in
        [v(-1.391_426_8, 2.377_159_6, -0.894_264_7), v(-1.19448, 1.76945, -1.65821), v(-1.0, 1.5, -1.2)]
    {
        let remembering = gauge(&role(0.0599));
        for k in 0..=200 {
            let tip = from + (end - from) * (f64::from(k) / 200.0);
            let fresh = gauge(&role(0.0599)).contact(&tool, &tip).clearance;
            let known = remembering.contact(&tool, &tip).clearance;
            worst = worst.max((fresh - known).abs());
        }
    }
    assert!(worst < 1e-9, "{worst}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    /// The same on all kinds of quadrics, from both sides, for tools of all shapes.
    #[test]
    fn remembered_contacts_change_no_clearance_of_any_quadric(
        which in 0usize..8, side in prop::bool::ANY, shape in 0usize..5, lean in prop::array::uniform2(-0.8..0.8f64),
        from in prop::array::uniform3(-2.0..2.0f64), way in prop::array::uniform3(-0.3..0.3f64),
    ) {
        let quadric = |coefficients| Geometry::Quadric(Quadric { coefficients });
        let geometry = match which {
            0 => quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5]),
            1 => quadric([1.0, 0.6, 0.3, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, -1.5]),
            2 => quadric([0.3, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.05, -0.5, 0.0]),
            3 => quadric([1.0, 0.8, -0.7, -1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0]),
            4 => quadric([1.0, 0.8, -0.7, 1.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0]),
            5 => cylinder(Vec3::zeros(), v(0.3, 1.0, 0.2).normalize(), 1.2),
            6 => cone(Vec3::zeros(), -Vec3::z(), 35.0),
            _ => quadric([0.13, 0.12, 0.01, 2.3, -0.036, -0.014, 0.05, 0.04, -0.22, 0.58]),
        };
        let numbers: [&[f64]; 5] = [
            &[0.5],
            &[0.5, 0.25],
            &[0.55, 0.083],
            &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0],
            &[0.8844, 0.0, 0.4422, 0.2657, 31.0, 0.0, 3.7726],
        ];
        let axis = v(lean[0], lean[1], 1.0).normalize();
        let tool = Tool::new(Cutter::from_numbers(numbers[shape], 1.0).unwrap(), axis);
        let role = Role {
            surface: named(&geometry),
            relation: Relation::To,
            side: if side { 1.0 } else { -1.0 },
            inside_tolerance: 0.0,
            outside_tolerance: 1e-4,
            thickness: 0.0,
            disk: None,
        };
        let remembering = gauge(&role);
        for k in 0..12 {
            let tip = Vec3::from(from) + Vec3::from(way) * f64::from(k);
            let fresh = gauge(&role).contact(&tool, &tip).clearance;
            let known = remembering.contact(&tool, &tip).clearance;
            // How deep a tool is that is deep inside, nobody asks.
            let deep = fresh.max(known) < -0.1;
            prop_assert!(deep || (fresh - known).abs() < 1e-7, "step {k}: {fresh} fresh, {known} remembered");
        }
    }
}

/// Below an ellipsoid that comes down into the top of the tool its rim touches, and nothing touches the disc within it: the
/// clearance is no convex function of the way then, and vectors that are straight bulge to the other side.
#[test]
fn a_tool_below_a_solid_touches_it_with_the_rim_of_its_top() {
    let ellipsoid = quadric([1.0 / 9.0, 0.25, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let (along, wall) = (plane(0.0, 1.0, 0.0, 0.1), |x: f64| plane(1.0, 0.0, 0.0, x));
    for numbers in [&[1.0][..], &[1.0, 0.2], &[0.8, 0.0, 0.4, 0.0, 0.0, 8.0, 3.0]] {
        let mut p = Program::new();
        p.tolerance(0.0, 1e-3).cutter(numbers).from(1.3, 0.1, -7.0);
        p.go(&[(Relation::On, &along), (Relation::To, &ellipsoid), (Relation::On, &wall(1.2))]);
        p.indirv(-1.0, 0.0, 0.0).side(DriveSide::On);
        proven(&mut p, &[motion(Turn::Forward, &along, &[(Relation::On, 1, &wall(-1.2))])]);
        let lowest = p.last().points.iter().map(|p| p.tip.z).fold(f64::INFINITY, f64::min);
        // The lowest place of the solid is above the rim's plane where the tool is below it.
        let height = p.last().cutter.height;
        assert!(p.last().points.iter().any(|p| p.tip.x.abs() < 0.2 && p.tip.z + height > -1.0), "{lowest}");
    }
}

/// The rim of a tapered tool has two troughs beside each other over a saddle, nearer than a sixteenth of a turn. Sampled
/// densely, tool and saddle are .000523 apart.
#[test]
fn the_lower_of_two_troughs_of_a_rim_over_a_saddle_is_found_by_both_measures() {
    let saddle = Geometry::Quadric(Quadric {
        coefficients: [
            0.08286997289585409,
            1.8289915321988661,
            0.25177052927917065,
            0.053336330392411535,
            0.03202643329150941,
            0.21937752095907884,
            -0.3697779115062204,
            -0.38772700935639565,
            0.4688068556355823,
            -0.13116692436717486,
        ],
    });
    let numbers =
        [0.9785620180984842, 0.0, 0.4892810090492421, 0.0, 0.0, 13.662865877415665, 3.77044132300706];
    let cutter = Cutter::from_numbers(&numbers, 1.0).expect("a cutter");
    let ends = [
        v(-0.5684715817269849, -1.8529413846412177, -2.403250451733217),
        v(-0.558358212123991, -1.84290992278095, -2.4218787316546155),
    ];
    for share in 0..=64 {
        let tip = ends[0].lerp(&ends[1], f64::from(share) / 64.0);
        let [engine, verifier] = outside(&saddle, cutter, ToolPosition { tip, axis: Vec3::z() });
        assert!((engine - verifier).abs() < 1e-9 && engine < 0.000_98, "{share}: {engine:e}, {verifier:e}");
    }
}

/// The flank of a bell has two troughs beside each other over a hyperboloid, nearer than a sixteenth of a turn.
#[test]
fn the_lower_of_two_troughs_of_a_flank_is_found_by_both_measures() {
    let surface = Geometry::Quadric(Quadric {
        coefficients: [
            0.1852532284562447,
            1.0892371150203712,
            0.16298235302763742,
            1.7874930071453683,
            -0.05803327269809824,
            0.006159222839704108,
            0.5332487437727983,
            -0.5257773672327355,
            -0.42859155681236405,
            -0.5511870463812865,
        ],
    });
    let numbers = [0.6, 0.11, 0.2, 0.13, 8.852994872936975, 3.291762228402378, 2.3522839411302594];
    let cutter = Cutter::from_numbers(&numbers, 1.0).expect("a cutter");
    let ends = [
        v(-2.4794610988147054, 1.351351329673124, 2.02577224781508),
        v(-2.4972714181783884, 1.355950105266015, 2.0417754404780024),
    ];
    for share in 0..=12 {
        let tip = ends[0].lerp(&ends[1], f64::from(share) / 12.0);
        let [engine, verifier] = outside(&surface, cutter, ToolPosition { tip, axis: Vec3::z() });
        assert!((engine - verifier).abs() < 1e-9 && engine < 0.0, "{share}: {engine:e}, {verifier:e}");
    }
}

/// The tool begins out of the band of the check surface by less than the inner half of the band is wide: it was taken to stand in
/// its position already, and the one ahead was passed.
#[test]
fn a_position_just_ahead_is_met_where_the_band_is_wider_inside() {
    let wall = line(-5.0, 0.0, 5.0, 0.0);
    for ahead in [0.0045, 0.006, 0.0085] {
        let mut program = Program::new();
        program.cutter(&[1.0, 0.0]).tolerance(0.01, 0.002).from(0.0, -2.0, 0.0).indirv(0.0, 1.0, 0.0);
        program.side(DriveSide::Right);
        program.go(&[(Relation::To, &wall), (Relation::To, &ground())]);
        let begin = program.tip().x;
        let at = begin + 0.5 + ahead;
        program.indirv(1.0, 0.0, 0.0);
        let command = motion(Turn::Forward, &wall, &[(Relation::To, 1, &line(at, -5.0, at, 5.0))]);
        proven(&mut program, &[command]);
        let moved = program.tip().x - begin;
        assert!(moved > 0.0 && moved < ahead + 0.01, "{moved} for {ahead}");
    }
}

/// A drill that goes down along a parabolic cylinder comes to touch its other wall, where the path turns by 86° and goes on: by
/// more than a right angle from the vector that leads there, which is not as steep as the path is at its end.
#[test]
fn a_path_goes_on_that_turns_by_nearly_a_right_angle_at_the_end_of_a_bend() {
    let part = quadric([
        1.326591241302483,
        0.0004414523102535849,
        0.0990530340318532,
        0.5410965913710717,
        -0.0066126538326899105,
        0.3624953618614909,
        -0.024199726614884558,
        0.6586013538655042,
        -0.052567415575559766,
        -0.336450712355607,
    ]);
    let drive = quadric([
        0.40955792984015815,
        0.431372499487939,
        0.170499713412052,
        1.3549621168475037,
        -0.14144099044441974,
        -0.09881716593955288,
        0.09948110556694889,
        0.10800973964864452,
        0.9320181528578912,
        -0.4747809090592097,
    ]);
    let forward = v(-0.04936218541625304, -0.9946182353592369, 0.09109303234501137);
    let first = plane(-forward.x, -forward.y, -forward.z, -1.6814509696265385);
    let point = v(0.23297865418987218, -9.387405563123291, 3.4706458855985374);
    let axis = v(0.7107927172797054, 0.09216649425064725, 0.6973371138837214);
    let stop = cylinder(point, axis, 7.107058496570897);
    let drill =
        [1.0300866667559876, 0.0, 0.5150433333779938, 0.30946925611951953, 31.0, 0.0, 3.155120027592868];
    let mut program = Program::new();
    program.tolerance(0.001, 0.001).cutter(&drill).part_side(PartSide::Offset);
    program.from(-0.010939363967459061, -1.4766597570378783, 1.4214766310676594);
    program.run(&MotionCommand::MaximumStep(10.0));
    program.go(&[(Relation::On, &drive), (Relation::To, &part), (Relation::On, &first)]);
    program.side(DriveSide::On).indirv(forward.x, forward.y, forward.z);
    proven(&mut program, &[motion(Turn::Forward, &drive, &[(Relation::Past, 1, &stop)])]);
}

/// Where the tool comes to the check surface no contact with that is known yet, and its top comes to it first: followed from a guess, which is seen from
/// the corner, it came to a far bend of the surface, and from there the end of the motion to a position far away.
#[test]
fn a_motion_ends_at_that_bend_of_a_check_surface_that_it_comes_to() {
    let Geometry::TabulatedCylinder(flat) = economy::tabulated(
        &[
            [-13.118225868134777, 7.7664266326948335, 0.0, 0.0],
            [-3.76551031178896, 4.227117134771977, 0.06699608414260312, -0.17792399211704227],
            [-3.26551031178896, 3.992052967284876, 0.055104331710272, -0.06810802196626375],
            [-2.76551031178896, 3.7072664218730322, 0.060425403925013915, 0.024913815382996064],
            [-2.26551031178896, 3.4424831771312654, 0.07235214301161222, 0.12913274747150114],
            [-1.7655103117889597, 3.2625314060108574, 0.03248941812227351, 0.253210252791247],
            [-1.2655103117889597, 3.2114695781195097, -0.052686106875373416, 0.29971199953727196],
            [-0.7655103117889597, 3.3017994097685293, -0.07079339453839081, 0.2118892151465962],
            [-0.2655103117889597, 3.511405007807222, -0.057089325740700136, 0.0968217452296517],
            [0.23448968821104033, 3.788967611584922, -0.057089325740700136, 0.001122126757142348],
            [0.7344896882110403, 4.066530215362621, -0.07079339453839081, -0.09674575433807223],
            [1.2344896882110403, 4.276135813401314, -0.052686106875373416, -0.21940352051991846],
            [1.7344896882110403, 4.366465645050334, 0.03248941812227351, -0.3021978507921528],
            [2.23448968821104, 4.315403817158986, 0.07235214301161222, -0.24447585579814346],
            [2.73448968821104, 4.135452046038578, 0.060425403925013915, -0.12747677643968366],
            [3.23448968821104, 3.8706688012968113, 0.055104331710272, -0.027015692197817777],
            [3.73448968821104, 3.5858822558849677, 0.06699608414260312, 0.06687818039484572],
            [4.23448968821104, 3.3508180883978658, 0.0, 0.0],
        ],
        [13.587205244556857, -0.18849140952498988],
    ) else {
        panic!("a tabulated cylinder")
    };
    let axes = [
        v(0.7367354463838752, 0.2981544627448041, -0.6068976836229558),
        v(0.6185909511575403, 0.06527268934554722, 0.7829972612797631),
        v(0.27306797173517416, -0.9522832521739302, -0.13634694877950604),
    ];
    let part = Cylinder {
        point: v(-6.224008957406003, 4.576356292271045, 2.8783979178569563),
        axis: v(0.40577066939126527, 0.9117379747734202, -0.06390640983365052),
        radius: 7.943168489365155,
    };
    let drive =
        Plane { normal: v(0.3434501803487914, -0.9391708969183312, 0.0), distance: -1.5273927172237292 };
    let motion = Found {
        cutter: &[0.3312820966351972],
        axis: Vec3::z(),
        from: v(-0.6789954017498324, 1.5543844865129934, -1.7306319285834497),
        band: [0.01, 0.005],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(0.6878463472942435, 0.2515420279798221, 0.6808773829947395),
        part: (Relation::To, Geometry::Cylinder(part)),
        drive: (Relation::To, Geometry::Line(drive)),
        first: (Relation::To, Geometry::Line(drive)),
        stop: (
            Relation::To,
            Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder { axes, ..(*flat).clone() })),
        ),
    };
    let sequences = motion.run_from_there(AMPLE).expect("a path");
    let end = sequences[0].points.last().expect("a position").tip;
    assert!((end - v(-0.077, 1.774, -1.037)).norm() < 0.01, "{end}");
}

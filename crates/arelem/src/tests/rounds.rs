//! Round a pocket or a boss whose walls are ruled between two polygons, one turned against the other, with the flank of the tool along them.

use apt_geometry::{
    canonical::{Remembering, RuledSurface},
    motion::{AxisAngle, AxisTangency, ToolAxis},
};

use super::{turning::proven, *};

/// Radius of the lower polygon, and heights of both.
const RADIUS: f64 = 5.0;
const HEIGHTS: [f64; 2] = [-0.5, 2.0];

/// Walls of so many corners: the upper polygon is by so much wider, and turned by an angle.
struct Walls {
    corners: u32,
    wider: f64,
    twist: f64,
}

impl Walls {
    fn corner(&self, k: u32, upper: bool) -> Vec3 {
        let [radius, twist] = if upper { [RADIUS + self.wider, self.twist] } else { [RADIUS, 0.0] };
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(self.corners) + twist).sin_cos();
        v(radius * cos, radius * sin, HEIGHTS[usize::from(upper)])
    }

    fn edge(&self, k: u32) -> Vec3 {
        self.corner(k + 1, false) - self.corner(k, false)
    }

    /// The wall from corner k on, its edges cut out of upright planes.
    fn wall(&self, k: u32) -> Geometry {
        let edge = |upper: bool| {
            let [from, to] = [self.corner(k, upper), self.corner(k + 1, upper)];
            let normal = (to - from).cross(&Vec3::z()).normalize();
            let upright = plane(normal.x, normal.y, normal.z, normal.dot(&from));
            [upright, Geometry::Point(from), Geometry::Point(to), Geometry::Vector(normal)]
        };
        let parts = [edge(false), edge(true)].concat();
        Geometry::RuledSurface(Remembering::new(RuledSurface { parts }))
    }

    /// Beside the middle of the first wall, inside or outside of it, the tool sets out for the next one.
    fn begin(&self, axis: ToolAxis, cutter: &[f64], inside: bool) -> Program {
        let middle = 0.5 * (self.corner(0, false) + self.corner(1, false));
        let away = middle * if inside { 0.5 } else { 1.6 };
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(cutter).from(away.x, away.y, 3.0);
        p.run(&MotionCommand::ToolAxis(axis));
        let towards = middle - Vec3::new(away.x, away.y, middle.z);
        p.indirv(towards.x, towards.y, 0.0);
        p.go(&[(Relation::To, &self.wall(0)), (Relation::To, &ground())]);
        let along = self.edge(0);
        p.indirv(along.x, along.y, 0.0).side(if inside { DriveSide::Left } else { DriveSide::Right });
        p
    }
}

/// An axis along the drive surface.
fn along(mode: AxisTangency) -> ToolAxis {
    ToolAxis::Tangent { height: 0.0, mode }
}

/// While the tool turns over too short a way from the axis along one wall to that along the next the places at which it touches both are a ring about
/// where it begins, which may be wider than that way: over a longer one the tool gets on.
#[test]
fn a_tool_gets_on_from_a_corner_of_twisted_walls_where_short_turns_lead_in_a_ring() {
    for (wider, twist, inside) in [(0.5, -0.1, false), (-0.5, -0.1, true)] {
        let walls = Walls { corners: 4, wider, twist };
        let relation = if inside { Relation::To } else { Relation::Past };
        let mut p = walls.begin(along(AxisTangency::Across), &[0.5], inside);
        p.drive(Turn::Forward, &walls.wall(0), relation, &walls.wall(1));
        p.drive(Turn::Left, &walls.wall(1), relation, &walls.wall(2));
        proven(&p);
        let way = p.tip() - p.last().start.tip;
        assert!(way.dot(&walls.edge(1)) > 0.8 * way.norm() * walls.edge(1).norm(), "{way:?}");
    }
}

/// The last vector of a motion may be short and lead across the band of its wall: what is left of it is told from where the path leads.
#[test]
fn a_turn_is_told_from_the_path_and_not_from_a_last_vector_across_its_bands() {
    let walls = Walls { corners: 6, wider: -0.5, twist: -0.1 };
    let mut p = walls.begin(along(AxisTangency::Fan), &[0.5], true);
    p.drive(Turn::Forward, &walls.wall(0), Relation::To, &walls.wall(1));
    for k in 1..4 {
        p.drive(Turn::Left, &walls.wall(k), Relation::To, &walls.wall(k + 1));
        let way = p.tip() - p.last().start.tip;
        assert!(way.dot(&walls.edge(k)) > 0.8 * way.norm() * walls.edge(k).norm(), "{k}: {way:?}");
    }
    proven(&p);
}

/// The tool comes to PAST out of the wall, and not from the side on which it stands there; where it turns over too short a way it goes round in a ring, on
/// which it may come through the next wall, far from the corner of both.
#[test]
fn a_tool_comes_past_a_wall_out_of_it() {
    let walls = Walls { corners: 6, wider: -0.784, twist: -0.135 };
    let mode = AxisAngle::Lead(5f64.to_radians());
    let axis = ToolAxis::AtAngle { part: false, angle: std::f64::consts::FRAC_PI_2, mode };
    let mut p = walls.begin(axis, &[1.0, 0.5], false);
    p.drive(Turn::Forward, &walls.wall(0), Relation::Past, &walls.wall(1));
    proven(&p);
    let way = p.tip() - p.last().start.tip;
    assert!(way.dot(&walls.edge(0)) > 0.8 * way.norm() * walls.edge(0).norm(), "{way:?}");
}

/// Over too short a way to turn on the tool may come round a part of that ring and leave it along the wall by which it came, with the wall on its other side:
/// it is told to go on, wherever and whichever way the same part lies.
#[test]
fn a_tool_that_has_turned_goes_on_in_the_direction_that_it_is_told() {
    let shift = v(3.0, -7.0, 2.0);
    for k in 0..24 {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 24.0).sin_cos();
        let turned = |x: f64, y: f64, z: f64| v(x * cos - y * sin, x * sin + y * cos, z);
        let leaning = |x: f64, y: f64, z: f64, distance: f64| {
            let normal = turned(x, y, z).normalize();
            plane(normal.x, normal.y, normal.z, distance + normal.dot(&shift))
        };
        let wall = leaning(-0.489000495299, -0.855526285158, 0.170156666049, -4.020054761846);
        let next = leaning(0.518029497996, -0.838267348884, 0.170156666049, -4.056086860296);
        let across = leaning(-0.868187036845, 0.496237109711, 0.0, -1.295228184801);
        let below = v(0.0, 0.0, -30.0) + shift;
        let dome = sphere(below.x, below.y, below.z, 30.0);
        let start = turned(3.694783602814, 3.854075009065, 1.5) + shift;
        let along = turned(-0.868187036845, 0.496237109711, 0.0);
        let mut p = Program::new();
        p.tolerance(0.0005, 0.001)
            .cutter(&[1.0, 0.5, 0.0, 0.5, 0.0, 0.0, 2.0])
            .from(start.x, start.y, start.z);
        p.go(&[(Relation::To, &wall), (Relation::To, &dome), (Relation::On, &across)]);
        p.run(&MotionCommand::ToolAxis(ToolAxis::Normal { part: true }));
        p.indirv(along.x, along.y, 0.0).side(DriveSide::Right);
        p.drive(Turn::Forward, &wall, Relation::Past, &next);
        proven(&p);
        let way = p.tip() - p.last().start.tip;
        assert!(way.dot(&along) > 0.8 * way.norm(), "{k}: {way:?}");
    }
}

/// Where such a path never meets the check surface, because it leads away from that, a longer way to turn on is tried, too.
#[test]
fn a_path_that_leads_away_from_its_check_surface_while_the_tool_turns_is_not_the_last_one() {
    let walls = [
        plane(-0.470728581556, -0.880193935194, -0.060607251668, -3.204061954962),
        plane(0.998040282975, 0.015567742431, -0.060607251668, -2.138856362102),
        plane(-0.607822174959, 0.791756884829, -0.060607251668, -3.524151620929),
    ];
    let leaning = plane(0.098413566261, -0.147620349392, 0.98413566261, 0.0);
    let across = plane(-0.881814983763, 0.471595519923, 0.0, -0.547835693056);
    let mut p = Program::new();
    p.tolerance(0.0005, 0.001).cutter(&[0.5, 0.125, 0.125, 0.125, 0.0, 0.0, 2.0]);
    p.from(2.39775001819, 3.321779224187, 1.5);
    p.go(&[(Relation::To, &walls[0]), (Relation::To, &leaning), (Relation::On, &across)]);
    p.run(&MotionCommand::ToolAxis(along(AxisTangency::Across)));
    p.indirv(-0.881814983763, 0.471595519923, 0.0).side(DriveSide::Right);
    p.drive(Turn::Forward, &walls[0], Relation::Past, &walls[1]);
    p.drive(Turn::Left, &walls[1], Relation::Past, &walls[2]);
    proven(&p);
    let way = p.tip() - p.last().start.tip;
    assert!(-way.y > 0.8 * way.norm(), "{way:?}");
}

/// While it turns the tool may also be led to and fro, over a way on which it need not.
#[test]
fn a_tool_that_turns_first_is_not_led_to_and_fro() {
    let wall = plane(-0.698638431376, -0.712234980283, -0.068012315542, -3.613743370714);
    let next = plane(0.851479335172, -0.484356832249, 0.200951239928, -4.024046002022);
    let level = plane(0.0, 0.0, 1.0, 0.0);
    let across = plane(-0.713888001046, 0.700259896012, 0.0, 0.850121116975);
    let mode = AxisAngle::PerpendicularTo(v(0.3, 1.0, 0.1));
    let mut p = Program::new();
    p.tolerance(0.0005, 0.001).cutter(&[0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 2.0]);
    p.from(1.334320537014, 2.574296412184, 1.5);
    p.go(&[(Relation::To, &wall), (Relation::To, &level), (Relation::On, &across)]);
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: 0.0, mode }));
    p.indirv(-0.713888001046, 0.700259896012, 0.0).side(DriveSide::Left);
    p.drive(Turn::Forward, &wall, Relation::To, &next);
    proven(&p);
}

/// What is TO a plane with the end of the tool where the motion begins is past it with the top once the tool has turned: the position TO the plane of the
/// turned tool lies behind it. On the way on which it turns its top comes to the plane.
#[test]
fn a_tool_that_turns_into_its_check_surface_is_not_led_back_out_of_it() {
    let axis = v(-0.3523779749805632, 0.6613623173836145, 0.6621402025957741);
    let drive = plane(0.35237797498056295, -0.6613623173836146, -0.662140202595774, -0.19996488285639932);
    let part = Geometry::Cylinder(Cylinder {
        point: v(-0.6044097581933685, 4.087342857742092, 0.3510493466874762),
        axis: Vec3::z(),
        radius: 4.6060438545714355,
    });
    let first = plane(0.8604999712943388, -0.049187086805150625, 0.5070704387893905, -1.133616156129477);
    let stop = plane(-0.8646336386038405, 0.10028421894514385, -0.49229233837756003, -1.9467081491178362);
    let forward = v(0.8604999712943385, -0.0491870868051506, 0.5070704387893906);
    let mode = AxisAngle::PerpendicularTo(v(0.21139156574522722, 0.9897418122562385, -0.5230670841321201));
    let mut p = Program::new();
    p.tolerance(0.01, 0.005).cutter(&[
        0.3703432059363659,
        0.0,
        0.18517160296818294,
        0.0,
        0.0,
        4.625898441040087,
        4.160749850698393,
    ]);
    p.run(&MotionCommand::Thickness(PerRole::all(0.06865329046964261)));
    p.run(&MotionCommand::MaximumStep(10.0));
    let position = v(-1.491647956590274, 0.11465855191291141, 0.7120348639532934);
    p.run(&MotionCommand::From { position, axis: Some(axis), name: String::new() });
    p.run(&MotionCommand::PartSide(PartSide::On));
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: false, angle: 0.3278934283198456, mode }));
    p.go(&[(Relation::On, &drive), (Relation::On, &part), (Relation::To, &first)]);
    p.indirv(forward.x, forward.y, forward.z).side(DriveSide::On);
    p.drive(Turn::Forward, &drive, Relation::To, &stop);
    proven(&p);
    let way = p.tip() - p.last().start.tip;
    assert!(way.dot(&forward) > 0.0, "{way:?}");
}

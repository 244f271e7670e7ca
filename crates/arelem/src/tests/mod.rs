//! Motion programs as hand-built commands: worked cases, the shapes of the oracle corpus, and properties.

mod along_ends;
mod axis_modes;
mod barrels;
mod behind_ends;
mod bends;
mod beside_ends;
mod beyond_ends;
mod blends;
mod closed_paths;
mod corners;
mod corners_while_turning;
mod corpus_plane;
mod corpus_space;
mod cost;
mod cost_by_charts;
mod disk;
pub(crate) mod economy;
mod ends;
mod fewest;
mod found;
mod frugal;
mod gouges;
mod hollow;
mod past_ends;
mod properties;
#[path = "../../tests/support/random.rs"]
pub(crate) mod random;
mod refused;
mod rounds;
mod sculptured;
mod sharp_corners;
pub(crate) mod sheets;
mod spared;
mod spared_at_stops;
mod tangencies;
mod troughs;
mod turning;
mod turning_begins;
mod turning_rings;
mod unsettled;
mod vertices;
mod walls;
mod worked;

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere},
    cutter::Cutter,
    motion::{
        CheckSurface, Direction, DriveSide, MotionCommand, NamedSurface, PartSide, PerRole, Relation,
        StartSurface, Turn,
    },
};

use crate::{
    clearance::{Gauge, Memory, Tool},
    error::{MotionFailure, MotionWarning},
    section2::{Output, State, execute},
    sequence::{CutSequence, Role, ToolPosition},
};

pub(crate) fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

pub(crate) fn plane(a: f64, b: f64, c: f64, d: f64) -> Geometry {
    Geometry::Plane(Plane { normal: v(a, b, c), distance: d })
}

/// The planes across the axes, at a distance from the origin.
pub(crate) fn x(d: f64) -> Geometry {
    plane(1.0, 0.0, 0.0, d)
}

pub(crate) fn y(d: f64) -> Geometry {
    plane(0.0, 1.0, 0.0, d)
}

pub(crate) fn level(d: f64) -> Geometry {
    plane(0.0, 0.0, 1.0, d)
}

pub(crate) fn ground() -> Geometry {
    level(0.0)
}

pub(crate) fn line(x1: f64, y1: f64, x2: f64, y2: f64) -> Geometry {
    let normal = v(y1 - y2, x2 - x1, 0.0).normalize();
    Geometry::Line(Plane { normal, distance: normal.dot(&v(x1, y1, 0.0)) })
}

pub(crate) fn circle(x: f64, y: f64, radius: f64) -> Geometry {
    Geometry::Circle(Cylinder { point: v(x, y, 0.0), axis: Vec3::z(), radius })
}

pub(crate) fn cylinder(point: Vec3, axis: Vec3, radius: f64) -> Geometry {
    Geometry::Cylinder(Cylinder { point, axis: axis.normalize(), radius })
}

pub(crate) fn sphere(x: f64, y: f64, z: f64, radius: f64) -> Geometry {
    Geometry::Sphere(Sphere { center: v(x, y, z), radius })
}

pub(crate) fn cone(vertex: Vec3, axis: Vec3, degrees: f64) -> Geometry {
    Geometry::Cone(Cone { vertex, axis: axis.normalize(), cosine: degrees.to_radians().cos() })
}

pub(crate) fn quadric(coefficients: [f64; 10]) -> Geometry {
    Geometry::Quadric(Quadric { coefficients })
}

pub(crate) fn named(geometry: &Geometry) -> NamedSurface {
    NamedSurface { name: String::new(), geometry: geometry.clone() }
}

/// A part program in the making: every command is executed at once.
pub(crate) struct Program {
    pub(crate) state: State,
    pub(crate) warnings: Vec<MotionWarning>,
    pub(crate) sequences: Vec<CutSequence>,
}

impl Program {
    pub(crate) fn new() -> Self {
        Self { state: State::new(1.0), warnings: Vec::new(), sequences: Vec::new() }
    }

    pub(crate) fn attempt(&mut self, command: &MotionCommand) -> Result<Option<Output>, MotionFailure> {
        let execution = execute(&self.state, command, &|| false);
        self.state = execution.state;
        self.warnings.extend(execution.warnings);
        if let Some(Output::Sequence(sequence)) = &execution.output {
            self.sequences.push(sequence.clone());
        }
        match execution.failure {
            Some(failure) => Err(failure),
            None => Ok(execution.output),
        }
    }

    /// The cut vectors of a motion that is to have some.
    pub(crate) fn cut(&mut self, command: &MotionCommand) -> Result<CutSequence, MotionFailure> {
        match self.attempt(command)? {
            Some(Output::Sequence(sequence)) => Ok(sequence),
            other => panic!("no sequence: {other:?}"),
        }
    }

    pub(crate) fn run(&mut self, command: &MotionCommand) -> &mut Self {
        if let Err(failure) = self.attempt(command) {
            panic!("{command:?} failed: {failure:?}");
        }
        self
    }

    pub(crate) fn cutter(&mut self, numbers: &[f64]) -> &mut Self {
        self.run(&MotionCommand::Cutter(numbers.to_vec()))
    }

    pub(crate) fn tolerance(&mut self, inside: f64, outside: f64) -> &mut Self {
        self.run(&MotionCommand::InsideTolerance(PerRole::all(inside)))
            .run(&MotionCommand::OutsideTolerance(PerRole::all(outside)))
    }

    pub(crate) fn from(&mut self, x: f64, y: f64, z: f64) -> &mut Self {
        self.run(&MotionCommand::From { position: v(x, y, z), axis: None, name: String::new() })
    }

    pub(crate) fn indirv(&mut self, x: f64, y: f64, z: f64) -> &mut Self {
        self.run(&MotionCommand::Direction([Some(Direction::Vector(v(x, y, z))), None, None]))
    }

    pub(crate) fn side(&mut self, side: DriveSide) -> &mut Self {
        self.run(&MotionCommand::DriveSide(side))
    }

    pub(crate) fn part_side(&mut self, side: PartSide) -> &mut Self {
        self.run(&MotionCommand::PartSide(side))
    }

    pub(crate) fn go(&mut self, surfaces: &[(Relation, &Geometry)]) -> &mut Self {
        let command = start(surfaces);
        self.run(&command)
    }

    pub(crate) fn drive(
        &mut self,
        turn: Turn,
        drive: &Geometry,
        relation: Relation,
        check: &Geometry,
    ) -> &mut Self {
        let command = motion(turn, drive, &[(relation, 1, check)]);
        self.run(&command)
    }

    pub(crate) fn tip(&self) -> Vec3 {
        self.state.tip.expect("a position")
    }

    pub(crate) fn last(&self) -> &CutSequence {
        self.sequences.last().expect("a sequence")
    }

    /// The present position is that one, within a tolerance.
    pub(crate) fn ends(&mut self, x: f64, y: f64, z: f64, tolerance: f64) -> &mut Self {
        let off = (self.tip() - v(x, y, z)).amax();
        assert!(off <= tolerance, "at {:?}, expected {:?}, off by {off:e}", self.tip(), (x, y, z));
        self
    }

    /// Every cut vector of every sequence keeps its bands; every end keeps its check surface.
    pub(crate) fn verified(&mut self) -> &mut Self {
        for sequence in &self.sequences {
            assert_in_tolerance(sequence);
        }
        self
    }
}

pub(crate) fn start(surfaces: &[(Relation, &Geometry)]) -> MotionCommand {
    MotionCommand::Start(
        surfaces
            .iter()
            .map(|(relation, geometry)| StartSurface { relation: *relation, surface: named(geometry) })
            .collect(),
    )
}

pub(crate) fn motion(turn: Turn, drive: &Geometry, checks: &[(Relation, u32, &Geometry)]) -> MotionCommand {
    let checks = checks
        .iter()
        .map(|(relation, occurrence, geometry)| CheckSurface {
            relation: *relation,
            occurrence: *occurrence,
            surface: named(geometry),
            label: None,
        })
        .collect();
    MotionCommand::Drive { turn, drive: named(drive), checks }
}

/// A surface that a tool is TO on the side of its natural normal, with ample tolerances.
fn touched(geometry: &Geometry) -> Role {
    Role {
        surface: named(geometry),
        relation: Relation::To,
        side: 1.0,
        inside_tolerance: 1.0,
        outside_tolerance: 1.0,
        thickness: 0.0,
        disk: None,
    }
}

fn gauge(role: &Role) -> Gauge {
    Gauge {
        surface: apt_geometry::surface::Surface::from_geometry(&role.surface.geometry).expect("surface"),
        on: role.relation == Relation::On,
        side: role.side,
        thickness: role.thickness,
        disk: role.disk,
        memory: Memory::default(),
    }
}

/// The clearance that the verifier reads of a tool in a position.
fn read_by_verifier(role: &Role, cutter: Cutter, place: ToolPosition) -> f64 {
    let alone = CutSequence {
        start: place,
        points: vec![place],
        cutter,
        part: Some(role.clone()),
        drive: None,
        stop: None,
        drive_side: DriveSide::On,
        start_up: true,
        forward: Vec3::zeros(),
        maximum_step: 1.0,
        minimum: None,
    };
    crate::verify::verify(&alone, &|| false).expect("evidence").part.expect("an extent").min
}

/// Samples per cut vector of the check.
const SAMPLES: u32 = 48;

/// Least and greatest clearance of a role over a sequence, by dense sampling.
pub(crate) fn sampled_extent(sequence: &CutSequence, role: &Role) -> (f64, f64) {
    let tool = Tool::new(sequence.cutter, sequence.start.axis);
    let gauge = gauge(role);
    let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
    let mut take = |tip: &Vec3| {
        let clearance = gauge.contact(&tool, tip).clearance;
        least = least.min(clearance);
        greatest = greatest.max(clearance);
    };
    let mut from = sequence.start.tip;
    for point in &sequence.points {
        if sequence.start_up {
            take(&point.tip);
        } else {
            for k in 0..=SAMPLES {
                take(&(from + (point.tip - from) * (f64::from(k) / f64::from(SAMPLES))));
            }
        }
        from = point.tip;
    }
    (least, greatest)
}

pub(crate) fn assert_in_tolerance(sequence: &CutSequence) {
    for role in [&sequence.part, &sequence.drive].into_iter().flatten() {
        let (least, greatest) = sampled_extent(sequence, role);
        assert!(
            least >= -role.inside_tolerance - 1e-10 && greatest <= role.outside_tolerance + 1e-10,
            "{:?} {:?}: [{least}, {greatest}] not in [-{}, {}]",
            role.surface.geometry,
            role.relation,
            role.inside_tolerance,
            role.outside_tolerance,
        );
    }
    if let (Some(stop), Some(last)) = (&sequence.stop, sequence.points.last())
        && matches!(stop.role.relation, Relation::To | Relation::On | Relation::Past)
    {
        let tool = Tool::new(sequence.cutter, sequence.start.axis);
        let clearance = gauge(&stop.role).contact(&tool, &last.tip).clearance;
        assert!(
            clearance >= -stop.role.inside_tolerance - 1e-10
                && clearance <= stop.role.outside_tolerance + 1e-10,
            "stop {:?} {:?} at {clearance}",
            stop.role.surface.geometry,
            stop.role.relation,
        );
    }
    if !sequence.start_up {
        let mut from = sequence.start.tip;
        for point in &sequence.points {
            assert!((point.tip - from).norm() > 0.0, "a cut vector without length");
            from = point.tip;
        }
    }
}

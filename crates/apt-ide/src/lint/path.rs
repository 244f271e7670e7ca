//! Lints of the path: what holds when the tool moves.

use std::collections::BTreeMap;

use apt_geometry::{
    canonical::GeometryKind,
    motion::{CheckSurface, DriveSide, MotionCommand, PartSide, PerRole, Relation},
};
use apt_program::{Origin, Program, Record, RecordKind, record::PostArgument};
use apt_run::diagnostic::absolute_range;
use apt_syntax::{SyntaxTree, dialect::DialectName};

use super::{
    CUTTER_AND_TOOL, DIRECTION_WITHOUT_EFFECT, FEED_MISSING, LOOSE_TOLERANCE, Lint, THICKNESS_WITHOUT_EFFECT,
    TOLERANCE_MISSING,
};
use crate::Severity;

/// A tolerance above this part of the cutter's diameter leaves marks that the eye sees.
const LOOSE_PART_OF_DIAMETER: f64 = 0.25;

pub(super) fn lints(tree: &SyntaxTree, program: &Program) -> Vec<Lint> {
    if tree.dialect().name == DialectName::Cl {
        // A CL file gives points; there are no surfaces to hold tolerances of.
        return Vec::new();
    }
    let mut walk = Walk::new(tree);
    for record in program.records() {
        walk.record(record);
    }
    walk.close_thickness();
    walk.lints
}

/// THICK with what the motions since have made of it.
struct Thickness {
    origin: Origin,
    values: PerRole,
    motions: u32,
    felt: bool,
}

/// What holds at a place of the path.
struct Walk<'a> {
    tree: &'a SyntaxTree,
    lints: Vec<Lint>,
    machine: bool,
    feed: bool,
    output: bool,
    inside: Option<(Origin, PerRole)>,
    outside: Option<(Origin, PerRole)>,
    diameter: Option<f64>,
    cutter: Option<(Origin, Vec<f64>)>,
    tool: Option<i64>,
    cutters: BTreeMap<i64, Vec<f64>>,
    part: Option<GeometryKind>,
    drive_side: DriveSide,
    part_side: PartSide,
    thickness: Option<Thickness>,
    direction: Option<(Origin, [bool; 3])>,
}

impl<'a> Walk<'a> {
    fn new(tree: &'a SyntaxTree) -> Self {
        Walk {
            tree,
            lints: Vec::new(),
            machine: false,
            feed: false,
            output: true,
            inside: None,
            outside: None,
            diameter: None,
            cutter: None,
            tool: None,
            cutters: BTreeMap::new(),
            part: None,
            drive_side: DriveSide::On,
            part_side: PartSide::Offset,
            thickness: None,
            direction: None,
        }
    }

    fn add(&mut self, code: &'static str, severity: Severity, origin: &Origin, message: String, hint: &str) {
        let range = absolute_range(self.tree, origin);
        let statement = (origin.isn.max(1) - 1) as usize;
        let hint = Some(hint.to_owned());
        self.lints.push(Lint { code, severity, statement, range, message, hint, fix: Vec::new() });
    }

    fn record(&mut self, record: &Record) {
        match &record.kind {
            RecordKind::Motion(command) => self.command(&record.origin, command),
            RecordKind::Postprocessor { word, arguments, .. } => match word.as_str() {
                "MACHIN" => self.machine = true,
                // A cycle brings its own feed.
                "FEDRAT" | "CYCLE" => self.feed = true,
                "LOADTL" | "TURRET" => self.tool = tool_number(arguments),
                _ => {}
            },
            _ => {}
        }
    }

    fn command(&mut self, origin: &Origin, command: &MotionCommand) {
        match command {
            MotionCommand::InsideTolerance(values) => self.inside = Some((origin.clone(), *values)),
            MotionCommand::OutsideTolerance(values) => self.outside = Some((origin.clone(), *values)),
            MotionCommand::Cutter(numbers) => {
                self.diameter = numbers.first().copied();
                self.cutter = Some((origin.clone(), numbers.clone()));
            }
            MotionCommand::DriveSide(side) => self.drive_side = *side,
            MotionCommand::PartSide(side) => self.part_side = *side,
            MotionCommand::PartSurface(surface) => self.part = Some(surface.geometry.kind()),
            MotionCommand::AutomaticPartSurface => self.part = Some(GeometryKind::Plane),
            MotionCommand::Output(on) => self.output = *on,
            MotionCommand::Thickness(values) => {
                self.close_thickness();
                self.thickness =
                    Some(Thickness { origin: origin.clone(), values: *values, motions: 0, felt: false });
            }
            MotionCommand::Direction(roles) => {
                let given = [roles[0].is_some(), roles[1].is_some(), roles[2].is_some()];
                self.replaced_direction(given);
                self.direction = Some((origin.clone(), given));
            }
            MotionCommand::Start(surfaces) | MotionCommand::Offset(surfaces) => {
                self.moved();
                if let Some(part) = surfaces.get(1) {
                    self.part = Some(part.surface.geometry.kind());
                }
                if let Some(thickness) = &mut self.thickness {
                    let values = [thickness.values.drive, thickness.values.part, thickness.values.check[0]];
                    thickness.motions += 1;
                    thickness.felt |= surfaces
                        .iter()
                        .zip(values)
                        .any(|(surface, value)| value != 0.0 && surface.relation != Relation::On);
                }
            }
            MotionCommand::Drive { checks, .. } => {
                self.moved();
                self.along_surfaces(origin, checks);
            }
            // What these make of the values of before is their own affair.
            MotionCommand::Pocket(_) => {
                self.moved();
                if let Some(thickness) = &mut self.thickness {
                    thickness.felt = true;
                }
            }
            MotionCommand::From { .. } | MotionCommand::GoTo { .. } | MotionCommand::GoDelta(_) => {
                self.moved();
            }
            _ => {}
        }
    }

    /// The tool moves: directions have been used, and the cutter in force belongs to the tool.
    fn moved(&mut self) {
        self.direction = None;
        let (Some(tool), Some((origin, numbers))) = (self.tool, self.cutter.clone()) else { return };
        let first = self.cutters.entry(tool).or_insert_with(|| numbers.clone());
        if *first != numbers {
            let message = format!("tool {tool} has been in use with another CUTTER before");
            let hint = "load the tool that this cutter is, or give it the dimensions of before";
            self.add(CUTTER_AND_TOOL, Severity::Information, &origin, message, hint);
        }
    }

    fn along_surfaces(&mut self, origin: &Origin, checks: &[CheckSurface]) {
        self.loose_tolerance();
        let curved = !matches!(self.part, None | Some(GeometryKind::Plane | GeometryKind::Line));
        if curved && self.inside.is_none() && self.outside.is_none() {
            let message =
                "the tool moves along a curved part surface with the tolerances of the start".to_owned();
            let hint = "give INTOL and OUTTOL before the first motion";
            self.add(TOLERANCE_MISSING, Severity::Information, origin, message, hint);
            // Told once.
            self.inside = Some((origin.clone(), PerRole::all(0.0)));
        }
        if self.machine && self.output && !self.feed {
            let message = "the tool cuts before any feed rate has been given".to_owned();
            self.add(FEED_MISSING, Severity::Warning, origin, message, "give FEDRAT before this motion");
            self.feed = true;
        }
        let Some(thickness) = &mut self.thickness else { return };
        thickness.motions += 1;
        let [first, second] = thickness.values.check;
        let check = checks
            .iter()
            .zip([first, second])
            .any(|(check, value)| value != 0.0 && check.relation != Relation::On);
        thickness.felt |= check
            || (thickness.values.drive != 0.0 && self.drive_side != DriveSide::On)
            || (thickness.values.part != 0.0 && self.part_side != PartSide::On);
    }

    fn loose_tolerance(&mut self) {
        let Some(diameter) = self.diameter.filter(|diameter| *diameter > 0.0) else { return };
        for (word, given) in [("INTOL", self.inside.clone()), ("OUTTOL", self.outside.clone())] {
            let Some((origin, values)) = given else { continue };
            let largest = values.part.max(values.drive).max(values.check[0]).max(values.check[1]);
            if largest > LOOSE_PART_OF_DIAMETER * diameter {
                let message =
                    format!("{word} {largest} is more than a quarter of the cutter's diameter {diameter}");
                let hint = "is the unit of the program another one?";
                self.add(LOOSE_TOLERANCE, Severity::Warning, &origin, message, hint);
            }
        }
    }

    /// A direction that stands before another one for the same surfaces serves no motion.
    fn replaced_direction(&mut self, given: [bool; 3]) {
        let Some((origin, before)) = self.direction.take() else { return };
        if before.iter().zip(given).all(|(before, now)| !before || now) {
            let message = "the next statement gives another direction before the tool moves".to_owned();
            self.add(DIRECTION_WITHOUT_EFFECT, Severity::Warning, &origin, message, "remove one of the two");
        }
    }

    fn close_thickness(&mut self) {
        let Some(thickness) = self.thickness.take() else { return };
        let values = thickness.values;
        let nothing =
            [values.part, values.drive, values.check[0], values.check[1]].iter().all(|value| *value == 0.0);
        if nothing || thickness.felt || thickness.motions == 0 {
            return;
        }
        let message = "no motion feels this THICK: the tool is ON the surfaces".to_owned();
        let hint = "THICK works where the tool is beside, short of or behind a surface";
        self.add(THICKNESS_WITHOUT_EFFECT, Severity::Warning, &thickness.origin, message, hint);
    }
}

/// The first number of a LOADTL, if it is a whole one.
fn tool_number(arguments: &[PostArgument]) -> Option<i64> {
    let number = arguments.iter().find_map(|argument| match argument {
        PostArgument::Number(number) => Some(*number),
        _ => None,
    })?;
    let whole = number.fract() == 0.0 && number.abs() < f64::from(i32::MAX);
    whole.then_some(number as i64)
}

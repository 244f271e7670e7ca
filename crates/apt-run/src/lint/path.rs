//! Lints of the path: what holds when the tool moves.
//!
//! Statements of included files are not judged here: another program may need them as they are.

use std::collections::BTreeMap;

use apt_geometry::{
    canonical::GeometryKind,
    motion::{CheckSurface, DriveSide, MotionCommand, PartSide, PerRole, Relation, StartSurface, Turn},
    patience::Patience,
    regional::RegionalCommand,
};
use apt_program::{Origin, Program, Record, RecordKind, record::PostArgument};
use apt_syntax::SyntaxTree;
use arelem::section2::{StartUpRule, State};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::{Lint, LintKind};
use crate::{
    Cancelled,
    diagnostic::{Fix, statement_range},
    fix::{inserting, removal, rewriting, written},
    go_on,
    pipeline::start_up_rule,
    settings::Units,
};

/// A tolerance above this part of the cutter's diameter leaves marks that the eye sees.
const LOOSE_PART_OF_DIAMETER: f64 = 0.25;

pub(super) fn lints(
    tree: &SyntaxTree,
    program: &Program,
    units: Units,
    patience: Patience<'_>,
) -> Result<Vec<Lint>, Cancelled> {
    let mut walk = Walk { rule: start_up_rule(tree.dialect().name), ..Walk::default() };
    for record in program.records() {
        go_on(patience, 1)?;
        walk.record(record);
    }
    walk.close_thickness();
    walk.feed_for_the_first_cut();
    let Walk { lints, effective, .. } = walk;
    let mut told = FxHashSet::default();
    let kept = lints
        .into_iter()
        .filter(|lint| lint.origin.source.is_none())
        // What has an effect the next time it is executed is needed.
        .filter(|lint| !needs_no_effect(&lint.kind) || !effective.contains(&place(&lint.origin)))
        .filter(|lint| told.insert((place(&lint.origin), std::mem::discriminant(&lint.kind))))
        .map(|lint| go_on(patience, 1).map(|()| with_fixes(tree, lint, units)));
    kept.collect()
}

/// A statement part of the program.
type Place = (u32, u32);

fn place(origin: &Origin) -> Place {
    (origin.isn, u32::from(origin.range.start()))
}

/// Whether a finding says that a statement serves nothing.
fn needs_no_effect(kind: &LintKind) -> bool {
    matches!(
        kind,
        LintKind::ThicknessUnfelt { .. } | LintKind::DirectionReplaced | LintKind::ModeReplaced { .. }
    )
}

/// The lint with what cures it.
fn with_fixes(tree: &SyntaxTree, mut lint: Lint, units: Units) -> Lint {
    let fixes = match &lint.kind {
        LintKind::SideContradicted { said, stands, .. } => other_side(tree, &lint, *said, *stands),
        LintKind::DirectionReplaced => {
            removal(tree, &lint.origin, "Remove the direction that another one replaces")
        }
        LintKind::ModeReplaced { .. } => {
            removal(tree, &lint.origin, "Remove the statement that another one replaces")
        }
        LintKind::ThicknessUnfelt { hides: false } => {
            removal(tree, &lint.origin, "Remove the THICK that no motion feels")
        }
        LintKind::ThicknessUnfelt { hides: true } => {
            let title = "Write THICK/0, which ends the one before".to_owned();
            rewriting(tree, &lint.origin, title, "THICK/0".to_owned())
        }
        LintKind::ToleranceMissing => {
            let assumed = State::new(units.per_inch());
            let statements =
                [format!("INTOL/{}", assumed.inside.part), format!("OUTTOL/{}", assumed.outside.part)];
            let title = "Give the tolerances that hold where the program gives none".to_owned();
            inserting(tree, &lint.origin, &statements, title)
        }
        LintKind::LooseTolerance { diameter, .. } => default_tolerance(tree, &lint.origin, *diameter, units),
        LintKind::FeedMissing { later } => later.as_ref().and_then(|feed| {
            let title = format!("Give the feed of later before the first cut: {feed}");
            inserting(tree, &lint.origin, &[feed.to_string()], title)
        }),
        LintKind::ToolWithTwoCutters { tool } => lint.other.as_ref().and_then(|first| {
            let text = written(tree, first)?;
            rewriting(tree, &lint.origin, format!("Write {text}, as tool {tool} had before"), text)
        }),
        _ => None,
    };
    lint.fixes.extend(fixes);
    lint
}

/// The statement of a loose tolerance with the one that the processor has by itself, where that is narrow for the cutter.
fn default_tolerance(tree: &SyntaxTree, origin: &Origin, diameter: f64, units: Units) -> Option<Fix> {
    let value = State::new(units.per_inch()).outside.part;
    let text = written(tree, origin)?;
    let word = text.split('/').next().map(str::trim).filter(|word| !word.contains([',', '=', ' ']))?;
    let narrow = value <= LOOSE_PART_OF_DIAMETER * diameter;
    let statement = format!("{word}/{value}");
    let title = format!("Write {statement}, the tolerance of a program that gives none");
    narrow.then(|| rewriting(tree, origin, title, statement)).flatten()
}

/// The other side word, where the statement that says the wrong one is known.
fn other_side(tree: &SyntaxTree, lint: &Lint, said: DriveSide, stands: DriveSide) -> Option<Fix> {
    let statement = lint.other.as_ref().filter(|other| other.source.is_none())?;
    let range = statement_range(tree, statement.isn, statement.range);
    let text = tree.slice(apt_syntax::TextRange::new(
        u32::try_from(range.start).unwrap_or(u32::MAX).into(),
        u32::try_from(range.end).unwrap_or(u32::MAX).into(),
    ));
    text.eq_ignore_ascii_case(side_word(said)).then(|| {
        let word = side_word(stands);
        let title = format!("Replace {} by {word}", side_word(said));
        Fix { title, edits: vec![(range, word.to_owned())], preferred: false }
    })
}

/// The word that says a side.
pub(crate) fn side_word(side: DriveSide) -> &'static str {
    match side {
        DriveSide::Left => "TLLFT",
        DriveSide::Right => "TLRGT",
        DriveSide::On => "TLON",
    }
}

/// THICK with what the motions since have made of it.
struct Thickness {
    origin: Origin,
    values: PerRole,
    motions: u32,
    felt: bool,
    /// The one before was not zero and would hold without this one.
    hides: bool,
}

/// A motion that has ended at a check surface, where the tool stands now.
struct Stop {
    surface: SmolStr,
    relation: Relation,
}

/// What a modal statement sets, for the finding that it serves nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Mode {
    InsideTolerance,
    OutsideTolerance,
    Cutter,
    DriveSide,
    PartSide,
    MaximumStep,
    ToolAxis,
    Output,
}

impl Mode {
    fn is_side(self) -> bool {
        matches!(self, Mode::DriveSide | Mode::PartSide)
    }

    fn words(self) -> &'static str {
        match self {
            Mode::InsideTolerance => "inside tolerance",
            Mode::OutsideTolerance => "outside tolerance",
            Mode::Cutter => "cutter",
            Mode::DriveSide => "side of the drive surface",
            Mode::PartSide => "side of the part surface",
            Mode::MaximumStep => "longest step",
            Mode::ToolAxis => "tool axis",
            Mode::Output => "choice between CUT and DNTCUT",
        }
    }
}

/// What holds at a place of the path.
#[derive(Default)]
struct Walk {
    rule: StartUpRule,
    lints: Vec<Lint>,
    /// Statements that had an effect at least once.
    effective: FxHashSet<Place>,
    machine: bool,
    feed: bool,
    /// The FEDRAT that comes after a cut without feed.
    later_feed: Option<SmolStr>,
    no_output: bool,
    inside: Option<(Origin, PerRole)>,
    outside: Option<(Origin, PerRole)>,
    tolerance_told: bool,
    feed_told: bool,
    diameter: Option<f64>,
    cutter: Option<(Origin, Vec<f64>)>,
    tool: Option<i64>,
    cutters: BTreeMap<i64, (Origin, Vec<f64>)>,
    part: Option<GeometryKind>,
    drive_side: Option<(Origin, DriveSide)>,
    part_side: Option<PartSide>,
    thickness: Option<Thickness>,
    direction: Option<(Origin, [bool; 3])>,
    surface_vectors: bool,
    stop: Option<Stop>,
    /// Modal statements since the last motion.
    waiting: BTreeMap<Mode, Origin>,
}

impl Walk {
    fn add(&mut self, kind: LintKind, origin: &Origin, other: Option<&Origin>) {
        self.lints.push(Lint { kind, origin: origin.clone(), other: other.cloned(), fixes: Vec::new() });
    }

    fn record(&mut self, record: &Record) {
        match &record.kind {
            RecordKind::Motion(command) => self.command(&record.origin, command),
            RecordKind::Postprocessor { word, arguments, .. } => match word.as_str() {
                "MACHIN" => self.machine = true,
                "FEDRAT" => {
                    let first = self.feed_told && self.later_feed.is_none();
                    if first {
                        self.later_feed = feed_statement(arguments);
                    }
                    self.feed = true;
                }
                // A cycle brings its own feed.
                "CYCLE" => self.feed = true,
                "LOADTL" | "TURRET" => self.tool = tool_number(arguments),
                _ => {}
            },
            RecordKind::Regional(milling) => self.region(&record.origin, &milling.command),
            // Where the tool goes after these is not known here.
            RecordKind::Transfer(_) | RecordKind::Gap => self.stop = None,
            _ => {}
        }
    }

    fn command(&mut self, origin: &Origin, command: &MotionCommand) {
        match command {
            MotionCommand::InsideTolerance(values) => {
                self.sets(Mode::InsideTolerance, origin);
                self.inside = Some((origin.clone(), *values));
            }
            MotionCommand::OutsideTolerance(values) => {
                self.sets(Mode::OutsideTolerance, origin);
                self.outside = Some((origin.clone(), *values));
            }
            MotionCommand::Cutter(numbers) => {
                self.sets(Mode::Cutter, origin);
                self.diameter = numbers.first().copied();
                self.cutter = Some((origin.clone(), numbers.clone()));
            }
            MotionCommand::DriveSide(side) => {
                self.sets(Mode::DriveSide, origin);
                self.drive_side = Some((origin.clone(), *side));
            }
            MotionCommand::PartSide(side) => {
                self.sets(Mode::PartSide, origin);
                self.part_side = Some(*side);
            }
            MotionCommand::MaximumStep(_) => self.sets(Mode::MaximumStep, origin),
            MotionCommand::ToolAxis(_) => self.sets(Mode::ToolAxis, origin),
            MotionCommand::PartSurface(surface) => self.part = Some(surface.geometry.kind()),
            MotionCommand::AutomaticPartSurface => self.part = Some(GeometryKind::Plane),
            MotionCommand::Output(on) => self.output(origin, *on),
            MotionCommand::Thickness(values) => {
                let hides = self.thickness.as_ref().is_some_and(|before| !is_zero(&before.values));
                self.close_thickness();
                let origin = origin.clone();
                self.thickness = Some(Thickness { origin, values: *values, motions: 0, felt: false, hides });
            }
            MotionCommand::Direction(roles) => {
                let given = roles.map(|role| role.is_some());
                self.replaced_direction(given, origin);
                self.direction = Some((origin.clone(), given));
            }
            MotionCommand::SurfaceVectors(_) => self.surface_vectors = true,
            MotionCommand::Start(surfaces) | MotionCommand::Offset(surfaces) => {
                self.started(surfaces);
            }
            MotionCommand::Drive { turn, drive, checks } => {
                self.side(origin, *turn, &drive.name);
                let stop = self.stop_of(checks);
                self.moved();
                self.along_surfaces(origin, drive.geometry.kind(), checks);
                self.stop = stop;
            }
            // What these make of the values of before is their own affair.
            MotionCommand::Pocket(_) => {
                self.moved();
                if let Some(thickness) = &mut self.thickness {
                    thickness.felt = true;
                }
            }
            MotionCommand::From { .. } | MotionCommand::GoTo { .. } | MotionCommand::GoDelta { .. } => {
                self.moved();
            }
            _ => {}
        }
    }

    /// CUT or DNTCUT.
    fn output(&mut self, origin: &Origin, on: bool) {
        if on && self.no_output {
            // The place where the tool is now is put out, which is an effect of both statements.
            self.effective.extend(self.waiting.remove(&Mode::Output).iter().map(place));
            self.effective.insert(place(origin));
        } else {
            self.sets(Mode::Output, origin);
        }
        self.no_output = !on;
    }

    /// A start-up to these surfaces.
    fn started(&mut self, surfaces: &[StartSurface]) {
        self.moved();
        if let Some(part) = surfaces.get(1) {
            self.part = Some(part.surface.geometry.kind());
        }
        let rule = self.rule;
        if let Some(thickness) = &mut self.thickness {
            let values = [thickness.values.drive, thickness.values.part, thickness.values.check[0]];
            thickness.motions += 1;
            thickness.felt |= surfaces.iter().zip(values).any(|(start, value)| {
                let on = start.relation == Relation::On;
                value != 0.0 && (!on || rule.on_takes_stock(start.surface.geometry.kind()))
            });
        }
    }

    /// A modal statement: the one before it for the same mode has served nothing if no motion came between.
    fn sets(&mut self, mode: Mode, origin: &Origin) {
        let Some(before) = self.waiting.insert(mode, origin.clone()) else { return };
        // TOLER sets two modes; the other one may still serve.
        let serves = self.waiting.values().any(|other| *other == before);
        let plain = before.frame.is_none() && origin.frame.is_none();
        // Two sides in one statement are an error of their own.
        let is_error = mode.is_side() && before.isn == origin.isn;
        if plain && !is_error && !serves && place(&before) != place(origin) {
            self.add(LintKind::ModeReplaced { mode: mode.words() }, &before, Some(origin));
        }
    }

    /// The tool moves: directions have been used, and the cutter in force belongs to the tool.
    fn moved(&mut self) {
        let waiting = std::mem::take(&mut self.waiting);
        self.effective.extend(waiting.values().map(place));
        if let Some((origin, _)) = self.direction.take() {
            self.effective.insert(place(&origin));
        }
        self.surface_vectors = false;
        self.stop = None;
        let (Some(tool), Some(cutter)) = (self.tool, &self.cutter) else { return };
        let first = self.cutters.entry(tool).or_insert_with(|| cutter.clone());
        if first.1 != cutter.1 {
            let (first, origin) = (first.0.clone(), cutter.0.clone());
            self.add(LintKind::ToolWithTwoCutters { tool }, &origin, Some(&first));
        }
    }

    /// Where a motion leaves the tool, if that is sure: one named surface, met for the first time, no direction given
    /// for its side.
    fn stop_of(&self, checks: &[CheckSurface]) -> Option<Stop> {
        let [check] = checks else { return None };
        let sure = check.occurrence == 1
            && !check.surface.name.is_empty()
            && !self.surface_vectors
            && self.diameter.is_some_and(|diameter| diameter > 0.0)
            && matches!(check.relation, Relation::To | Relation::On | Relation::Past);
        sure.then(|| Stop { surface: check.surface.name.as_str().into(), relation: check.relation })
    }

    /// A turn onto the surface at which the tool has stopped: short of it, a turn to the left leaves it on the right hand
    /// and so the tool on its left; past it, the other way round.
    fn side(&mut self, origin: &Origin, turn: Turn, drive: &str) {
        let Some(stop) = self.stop.as_ref().filter(|stop| stop.surface == drive) else { return };
        let Some((statement, said)) = self.drive_side.clone() else { return };
        let stands = match (stop.relation, turn) {
            (Relation::On, Turn::Left | Turn::Right) => DriveSide::On,
            (Relation::To, Turn::Left) | (Relation::Past, Turn::Right) => DriveSide::Left,
            (Relation::To, Turn::Right) | (Relation::Past, Turn::Left) => DriveSide::Right,
            _ => return,
        };
        if stands != said {
            let kind = LintKind::SideContradicted { surface: drive.into(), said, stands };
            self.add(kind, origin, Some(&statement));
        }
    }

    /// Regional milling: the surface is curved, and ZIGZAG and PICKFD bring their own feeds.
    fn region(&mut self, origin: &Origin, command: &RegionalCommand) {
        if let RegionalCommand::Zigzag(region) | RegionalCommand::Pickfeed { region, .. } = command {
            self.feed |= region.feed.cutting > 0.0;
        }
        self.cuts(origin, true);
        self.moved();
    }

    /// What a cut needs: tolerances on what is curved, and a feed.
    fn cuts(&mut self, origin: &Origin, curved: bool) {
        self.loose_tolerance();
        if curved && self.inside.is_none() && self.outside.is_none() && !self.tolerance_told {
            self.add(LintKind::ToleranceMissing, origin, None);
            self.tolerance_told = true;
        }
        if self.machine && !self.no_output && !self.feed {
            self.add(LintKind::FeedMissing { later: None }, origin, None);
            self.feed = true;
            self.feed_told = true;
        }
    }

    fn along_surfaces(&mut self, origin: &Origin, drive: GeometryKind, checks: &[CheckSurface]) {
        let curved = !matches!(self.part, None | Some(GeometryKind::Plane | GeometryKind::Line));
        self.cuts(origin, curved);
        let drive_side = self.drive_side.as_ref().map_or(DriveSide::On, |(_, side)| *side);
        let part_side = self.part_side.unwrap_or(PartSide::Offset);
        let rule = self.rule;
        let feels = |value: f64, on: bool, kind: Option<GeometryKind>| {
            value != 0.0 && (!on || kind.is_some_and(|kind| rule.on_takes_stock(kind)))
        };
        let part = self.part;
        let Some(thickness) = &mut self.thickness else { return };
        thickness.motions += 1;
        let check = checks.iter().zip(thickness.values.check).any(|(check, value)| {
            feels(value, check.relation == Relation::On, Some(check.surface.geometry.kind()))
        });
        thickness.felt |= check
            || feels(thickness.values.drive, drive_side == DriveSide::On, Some(drive))
            || feels(thickness.values.part, part_side == PartSide::On, part);
    }

    fn loose_tolerance(&mut self) {
        let Some(diameter) = self.diameter.filter(|diameter| *diameter > 0.0) else { return };
        for (word, given) in [("INTOL", self.inside.clone()), ("OUTTOL", self.outside.clone())] {
            let Some((origin, values)) = given else { continue };
            let value = values.part.max(values.drive).max(values.check[0]).max(values.check[1]);
            if value > LOOSE_PART_OF_DIAMETER * diameter {
                self.add(LintKind::LooseTolerance { word, value, diameter }, &origin, None);
            }
        }
    }

    /// A direction that stands before another one for the same surfaces serves no motion.
    fn replaced_direction(&mut self, given: [bool; 3], now: &Origin) {
        let Some((origin, before)) = self.direction.take() else { return };
        if before.iter().zip(given).all(|(before, now)| !before || now) {
            self.add(LintKind::DirectionReplaced, &origin, Some(now));
        }
    }

    /// The feed that comes after the cut that has none.
    fn feed_for_the_first_cut(&mut self) {
        let found = self.later_feed.take();
        let told = self.lints.iter_mut().find_map(|lint| match &mut lint.kind {
            LintKind::FeedMissing { later } => Some(later),
            _ => None,
        });
        if let Some(later) = told {
            *later = found;
        }
    }

    fn close_thickness(&mut self) {
        let Some(thickness) = self.thickness.take() else { return };
        if is_zero(&thickness.values) || thickness.felt {
            self.effective.insert(place(&thickness.origin));
        } else if thickness.motions > 0 {
            self.add(LintKind::ThicknessUnfelt { hides: thickness.hides }, &thickness.origin, None);
        }
    }
}

/// Whether a THICK leaves no stock anywhere.
fn is_zero(values: &PerRole) -> bool {
    [values.part, values.drive, values.check[0], values.check[1]].iter().all(|value| *value == 0.0)
}

/// A FEDRAT as it would be written, with numbers and words alone.
fn feed_statement(arguments: &[PostArgument]) -> Option<SmolStr> {
    let parts: Option<Vec<String>> = arguments
        .iter()
        .map(|argument| match argument {
            PostArgument::Number(value) => Some(value.to_string()),
            PostArgument::Word(word, _) => Some(word.to_string()),
            _ => None,
        })
        .collect();
    let parts = parts.filter(|parts| !parts.is_empty())?;
    Some(format!("FEDRAT/{}", parts.join(",")).into())
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

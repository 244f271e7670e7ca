//! SMIL: the commands of regional milling (sculptured surfaces reference 1.5). Each record carries the conditions it
//! depends on.

use apt_geometry::{
    canonical::Plane,
    regional::{
        FeedDirection, Guide, ParameterRange, Pass, Region, RegionalCommand, RegionalMilling, Retract, Sense,
    },
};
use smol_str::SmolStr;

use super::{
    number,
    reader::{Misfit, Read, Reader},
    state::{Block, RegionalState},
};
use crate::{
    evaluator::Evaluator,
    finding::{ConditionBlock, Expected, FindingKind, Found, SculpturedFinding},
    record::RecordKind,
    statements::Major,
};

/// The words after SMIL; CUT is an older spelling of PATH.
const COMMANDS: &[&str] = &["POSN", "PATH", "ZIGZAG", "PICKFD", "CUT"];

/// What a SMIL says, before the conditions are looked at.
enum Statement {
    Position { start: [f64; 2], retract: Retract },
    Path(Pass),
    Region { word: &'static str, pass: Pass, stepover_sense: Sense },
}

impl Statement {
    /// The blocks that the command needs, in their order.
    fn needs(&self) -> &'static [ConditionBlock] {
        use ConditionBlock::{Axis, Clearance, Feed, Guide, Part, Stepover};
        match self {
            Statement::Position { .. } | Statement::Path(_) => &[Guide, Part, Axis],
            Statement::Region { word: "PICKFD", .. } => &[Guide, Part, Axis, Feed, Clearance, Stepover],
            Statement::Region { .. } => &[Guide, Part, Axis, Feed, Stepover],
        }
    }
}

impl Evaluator<'_> {
    /// SMIL.
    pub(crate) fn regional_milling(&mut self, major: Major<'_>) {
        if self.pending.is_some() {
            self.break_pending(FindingKind::ImpliedCheckBroken { word: major.name() }, major.range);
        }
        let Some(items) = self.regional_operands(major, number::NO_FORM) else { return };
        let mut reader = Reader::new(&items, major.range);
        let (word, statement) = match statement(&mut reader) {
            Ok(read) => read,
            Err(misfit) => return self.misfit(major, misfit),
        };
        if word == "CUT" {
            let finding = FindingKind::Sculptured(SculpturedFinding::OlderSpelling {
                word: SmolStr::new_static("CUT"),
                present: SmolStr::new_static("PATH"),
            });
            self.report(finding, items.first().map_or(major.range, |item| item.range));
        }
        let state = std::sync::Arc::clone(&self.state.regional);
        let missing: Vec<_> =
            statement.needs().iter().copied().filter(|block| !state.valid_blocks().contains(block)).collect();
        if !missing.is_empty() {
            let spoiled = missing.iter().copied().filter(|block| state.is_spoiled(*block)).collect();
            let (word, valid) = (SmolStr::new_static(word), state.valid_blocks());
            return self.report(
                FindingKind::Sculptured(SculpturedFinding::ConditionMissing {
                    word,
                    missing,
                    spoiled,
                    valid,
                }),
                major.range,
            );
        }
        let Some(milling) = milling(&state, &statement) else { return };
        if let Some(misfit) = unfit(&milling, &items, major) {
            return self.misfit(major, misfit);
        }
        if state.avoidance.enabled && !state.checked.part && state.checked.named.is_empty() {
            self.report(FindingKind::Sculptured(SculpturedFinding::AvoidanceWithoutCheck), major.range);
        }
        self.emit(RecordKind::Regional(Box::new(milling)), major.range);
    }
}

/// The command with its conditions; `None` if one of them is missing, which has been looked at before.
fn milling(state: &RegionalState, statement: &Statement) -> Option<RegionalMilling> {
    let command = match *statement {
        Statement::Position { start, retract } => RegionalCommand::Position { start, retract },
        Statement::Path(pass) => RegionalCommand::Path(pass),
        Statement::Region { word, pass, stepover_sense } => {
            let (feed, stepover) = (*state.feed.get()?, *state.stepover.get()?);
            let region = Region { pass, stepover_sense, feed, stepover };
            match word {
                "PICKFD" => RegionalCommand::Pickfeed { region, clearance: *clearance(&state.clearance)? },
                _ => RegionalCommand::Zigzag(region),
            }
        }
    };
    Some(RegionalMilling {
        command,
        guide: state.guide.get()?.clone(),
        part: state.part.get()?.clone(),
        axis: *state.axis.get()?,
        checked: state.checked.clone(),
        avoidance: state.avoidance,
        check_chords: state.check_chords,
        list_avoidance: state.list_avoidance,
    })
}

fn clearance(block: &Block<Plane>) -> Option<&Plane> {
    block.get()
}

/// Why the command cannot be carried out with this guide.
fn unfit(milling: &RegionalMilling, items: &[crate::expression::Item], major: Major<'_>) -> Option<Misfit> {
    let range_of = |index: usize| items.get(index).map_or(major.range, |item| item.range);
    let start = match milling.command {
        RegionalCommand::Position { start, .. } => start,
        RegionalCommand::Path(pass) => pass.start,
        RegionalCommand::Zigzag(region) | RegionalCommand::Pickfeed { region, .. } => region.pass.start,
    };
    // SMIL/…,DS,PARAM,u,v: the parameters are the fourth and fifth operand.
    let outside = |range: &ParameterRange, value: f64, index: usize| {
        (!range.admits(value)).then(|| Misfit::Value {
            value,
            number: Some(number::COMMAND_VALUE),
            range: range_of(index),
        })
    };
    match &milling.guide.guide {
        Guide::Surface { u, v, .. } => outside(u, start[0], 3).or_else(|| outside(v, start[1], 4)),
        Guide::Curve { u, .. } => match milling.command {
            // There is nothing across a curve to step to.
            RegionalCommand::Zigzag(_) | RegionalCommand::Pickfeed { .. } => Some(Misfit::Operand {
                expected: Expected::GuideSurface,
                found: Found::Geometry(apt_geometry::canonical::GeometryKind::SpaceCurve),
                number: number::COMMAND_GEOMETRY,
                range: range_of(0),
            }),
            RegionalCommand::Path(pass) if pass.direction == FeedDirection::CrossSpline => {
                Some(Misfit::Operand {
                    expected: Expected::Words(&["TANSPL"]),
                    found: Found::Word(SmolStr::new_static("CRSSPL")),
                    number: number::COMMAND_WORD,
                    range: range_of(5),
                })
            }
            _ => outside(u, start[0], 3),
        },
    }
}

/// Reads what follows SMIL.
fn statement(reader: &mut Reader<'_>) -> Read<(&'static str, Statement)> {
    let word = reader.word(COMMANDS)?;
    reader.word(&["DS"])?;
    reader.word(&["PARAM"])?;
    let start = [reader.scalar()?, reader.scalar()?];
    let statement = match word {
        "POSN" => {
            reader.word(&["INCR"])?;
            Statement::Position { start, retract: retract(reader)? }
        }
        "PATH" | "CUT" => {
            let pass = pass(reader, start)?;
            Statement::Path(Pass { skip: skip(reader)?, ..pass })
        }
        word => {
            let pass = pass(reader, start)?;
            reader.word(&["STEPOV"])?;
            let stepover_sense = reader.sense()?;
            Statement::Region { word, pass: Pass { skip: skip(reader)?, ..pass }, stepover_sense }
        }
    };
    reader.end()?;
    Ok((word, statement))
}

/// `{TANSPL|CRSSPL},{PLUS|MINUS}`.
fn pass(reader: &mut Reader<'_>, start: [f64; 2]) -> Read<Pass> {
    let direction = match reader.word(&["TANSPL", "CRSSPL"])? {
        "TANSPL" => FeedDirection::Spline,
        _ => FeedDirection::CrossSpline,
    };
    Ok(Pass { start, direction, sense: reader.sense()?, skip: false })
}

/// A number above zero leaves the first point out; nothing keeps it.
fn skip(reader: &mut Reader<'_>) -> Read<bool> {
    match reader.peek() {
        Some(item) if item.scalar().is_some() => Ok(reader.scalar()? > 0.0),
        _ => Ok(false),
    }
}

/// A distance, a vector or a plane.
fn retract(reader: &mut Reader<'_>) -> Read<Retract> {
    if let Some(plane) = reader.eat_plane() {
        return Ok(Retract::Plane(plane));
    }
    match reader.peek() {
        Some(item) if item.scalar().is_some() => Ok(Retract::Distance(reader.scalar()?)),
        // A null vector stays at the contact.
        Some(item) if item.vector().is_some() => {
            reader.skip();
            Ok(Retract::Vector(item.vector().unwrap_or_default()))
        }
        Some(item) if item.geometry().is_some() => {
            Err(reader.clone().numbered(number::COMMAND_OPERAND).misfit(Expected::DistanceVectorOrPlane))
        }
        _ => Err(reader.misfit(Expected::DistanceVectorOrPlane)),
    }
}

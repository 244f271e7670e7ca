//! The conditions of regional milling at a SMIL, in a hover: what each block holds, or which are missing.

use std::path::Path;

use apt_geometry::regional::{
    AvoidanceControl, AxisCondition, AxisReference, Guide, GuideCondition, GuideContact, LiftDirection,
    ParameterRange, PartCondition, PartRelation, Projection, Region, RegionalCommand, RegionalMilling, Sense,
    StepoverRule,
};
use apt_program::{
    Origin,
    finding::{ConditionBlock, FindingKind, SculpturedFinding},
    record::RecordKind,
};
use apt_run::{Waiting, go_on};

use super::{
    canonical::{plane, triple},
    number,
};
use crate::{Analysis, Cancel, Cancelled};

impl Analysis {
    /// The conditions in force at the SMIL with this number, of the program or of an included file; empty if there is none.
    pub(super) fn conditions_markdown(
        &self,
        isn: u32,
        file: Option<&Path>,
        cancel: Cancel<'_>,
    ) -> Result<String, Cancelled> {
        let program = self.program(cancel)?;
        let here = |origin: &Origin| {
            origin.isn == isn && origin.source.as_ref().map(|source| source.path.as_path()) == file
        };
        let waiting = Waiting::until(cancel);
        for record in program.records() {
            go_on(waiting.patience(), 1)?;
            if let RecordKind::Regional(milling) = &record.kind
                && here(&record.origin)
            {
                return Ok(table(milling));
            }
        }
        for finding in program.findings() {
            go_on(waiting.patience(), 1)?;
            if let FindingKind::Sculptured(SculpturedFinding::ConditionMissing {
                missing,
                spoiled,
                valid,
                ..
            }) = &finding.kind
                && here(&finding.origin)
            {
                return Ok(blocks(missing, spoiled, valid));
            }
        }
        Ok(String::new())
    }
}

/// Which blocks are valid and which are not.
fn blocks(missing: &[ConditionBlock], spoiled: &[ConditionBlock], valid: &[ConditionBlock]) -> String {
    let mut text = "| condition | |\n|---|---|\n".to_owned();
    for block in ConditionBlock::ALL {
        let state = if valid.contains(&block) {
            "valid"
        } else if spoiled.contains(&block) {
            "**has a mistake**"
        } else if missing.contains(&block) {
            "**missing**"
        } else {
            continue;
        };
        text.push_str(&format!("| `{}` | {state} |\n", block.statement()));
    }
    text.push('\n');
    text
}

/// The conditions of a command.
fn table(milling: &RegionalMilling) -> String {
    let mut rows = vec![
        (ConditionBlock::Guide.statement(), guide(&milling.guide)),
        (ConditionBlock::Part.statement(), part(&milling.part)),
        (ConditionBlock::Axis.statement(), axis(&milling.axis)),
    ];
    match &milling.command {
        RegionalCommand::Zigzag(passes) => rows.extend(region(passes)),
        RegionalCommand::Pickfeed { region: passes, clearance } => {
            rows.extend(region(passes));
            rows.push((ConditionBlock::Clearance.statement(), plane(clearance)));
        }
        RegionalCommand::Position { .. } | RegionalCommand::Path(_) => {}
    }
    let mut checked: Vec<&str> = if milling.checked.part { vec!["PS"] } else { Vec::new() };
    checked.extend(milling.checked.named.iter().map(|surface| named(&surface.name)));
    if !checked.is_empty() {
        rows.push(("CHKSRF", checked.join(", ")));
    }
    if milling.avoidance.enabled {
        rows.push(("AVCTRL", avoidance(&milling.avoidance)));
    }
    if milling.check_chords {
        rows.push(("GOUGCK", "ON".to_owned()));
    }
    let lines: Vec<String> = rows.iter().map(|(name, value)| format!("| `{name}` | {value} |\n")).collect();
    format!("| condition | in force |\n|---|---|\n{}\n", lines.concat())
}

fn named(name: &str) -> &str {
    if name.is_empty() { "a nested surface" } else { name }
}

fn sign(sense: Sense) -> &'static str {
    match sense {
        Sense::Plus => "PLUS",
        Sense::Minus => "MINUS",
    }
}

fn range(name: &str, range: &ParameterRange) -> String {
    format!("{name} {} … {}", number(range.low), number(range.high))
}

fn guide(condition: &GuideCondition) -> String {
    let element = match &condition.guide {
        Guide::Surface { surface, u, v } => {
            format!("{}, {}, {}", named(&surface.name), range("u", u), range("v", v))
        }
        Guide::Curve { curve, u } => format!("curve {}, {}", named(&curve.name), range("u", u)),
    };
    let contact = match condition.contact {
        GuideContact::At => "the contact",
        GuideContact::On => "the tool end",
    };
    let projection = match &condition.projection {
        Projection::Normal => "its normal".to_owned(),
        Projection::CrossDirection => "its cross direction".to_owned(),
        Projection::Vector(vector) => triple(vector),
    };
    format!("{element}; {contact} along {projection}")
}

fn part(condition: &PartCondition) -> String {
    let relation = match condition.relation {
        PartRelation::To => "TO",
        PartRelation::On => "ON",
    };
    let (name, side) = (named(&condition.surface.name), sign(condition.side));
    format!("{relation} {name}, {side}, stock {}", number(condition.thickness))
}

fn axis(condition: &AxisCondition) -> String {
    match condition {
        AxisCondition::Fixed(vector) => format!("fixed, {}", triple(vector)),
        AxisCondition::GuideNormal(sense) => format!("normal of the guide, {}", sign(*sense)),
        AxisCondition::AtAngle { reference, across, lead } => {
            let reference = match reference {
                AxisReference::Guide => "guide",
                AxisReference::Part => "part",
            };
            format!(
                "from the normal of the {reference} {}° across and {}° to the feed",
                number(across.to_degrees()),
                number(lead.to_degrees())
            )
        }
    }
}

fn region(region: &Region) -> [(&'static str, String); 2] {
    let feed = &region.feed;
    let feeds = format!(
        "cutting {}, step over {}, plunge {}, rapid {}",
        number(feed.cutting),
        number(feed.stepover),
        number(feed.plunge),
        number(feed.rapid)
    );
    let step = match region.stepover.rule() {
        StepoverRule::Scallop { height, limit } => {
            let limit = limit.map(|limit| format!(", at most {} apart", number(limit))).unwrap_or_default();
            format!("scallops of {}{limit}", number(height))
        }
        StepoverRule::Distance(distance) => format!("{} apart", number(distance)),
        StepoverRule::Parameter(step) => format!("{} of the parameter apart", number(step)),
    };
    let passes =
        region.stepover.passes.map(|passes| format!(", at most {passes} passes")).unwrap_or_default();
    let stepover = format!("{step}, lift {}{passes}", number(region.stepover.lift));
    [(ConditionBlock::Feed.statement(), feeds), (ConditionBlock::Stepover.statement(), stepover)]
}

fn avoidance(control: &AvoidanceControl) -> String {
    let tilt = control.tilt.map(|tilt| {
        format!(
            "tilt {}° … {}° and {}° more, then ",
            number(tilt.least.to_degrees()),
            number(tilt.greatest.to_degrees()),
            number(tilt.constant.to_degrees())
        )
    });
    let direction = match control.lift {
        LiftDirection::PartNormal => "the normal of the part",
        LiftDirection::Axis => "the tool axis",
    };
    let limit = control.limit.map_or("MAXDP".to_owned(), number);
    format!("{}lift along {direction}, at most {limit}", tilt.unwrap_or_default())
}

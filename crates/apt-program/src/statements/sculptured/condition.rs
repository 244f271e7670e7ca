//! SCON: the conditions of regional milling (sculptured surfaces reference 1.4). A block is valid after a statement without
//! mistake only.

use std::sync::Arc;

use apt_geometry::{
    motion::NamedSurface,
    regional::{
        AxisCondition, AxisReference, FeedCondition, Guide, GuideCondition, GuideContact, ParameterRange,
        PartCondition, PartRelation, Projection, StepoverCondition,
    },
};
use apt_syntax::statement::Argument;

use super::{
    number,
    reader::{Element, Misfit, Read, Reader},
    state::{Block, RegionalState},
};
use crate::{
    evaluator::Evaluator,
    expression::Item,
    finding::{Expected, FindingKind, SculpturedFinding},
    statements::Major,
};

/// The words after SCON.
const BLOCKS: &[&str] = &["INIT", "DS", "PS", "AXIS", "FEED", "STEPOV"];
/// The words after SCON/INIT.
const INITIAL: &[&str] = &["ALL", "DS", "PS", "FEED", "STEPOV", "AXIS"];
/// How far ATANGL may turn the axis from the normal, degrees; beyond it the axis would point into the part.
const LARGEST_ANGLE: f64 = 90.0;
/// From this angle on an axis turned to the feed is doubtful, degrees (sculptured surfaces reference 1.4).
const DOUBTFUL_LEAD: f64 = 80.0;

/// What one SCON changes.
enum Change {
    Forget(Vec<&'static str>),
    Guide(GuideCondition),
    Part(PartCondition),
    Axis(AxisCondition),
    Feed(FeedCondition),
    Clearance(apt_geometry::canonical::Plane),
    Stepover(StepoverCondition),
}

impl Evaluator<'_> {
    /// SCON.
    pub(crate) fn condition_statement(&mut self, major: Major<'_>) {
        let word = match major.arguments.first() {
            Some(Argument::Word(word)) => word.word.spelling,
            _ => "",
        };
        let items = self.regional_operands(major, number::NO_FORM);
        let read = items.as_deref().map(|items| change(&mut Reader::new(items, major.range)));
        let with_plane =
            items.as_deref().and_then(|items| items.get(1)).is_some_and(|item| item.scalar().is_none());
        let change = match read {
            Some(Ok(change)) => change,
            Some(Err(misfit)) => {
                self.misfit(major, misfit);
                return self.regional_mut().spoil(word, with_plane);
            }
            None => return self.regional_mut().spoil(word, with_plane),
        };
        self.report_doubtful_condition(major, &change);
        let state = self.regional_mut();
        match change {
            Change::Forget(words) => words.into_iter().for_each(|word| state.forget(word)),
            Change::Guide(guide) => state.guide = Block::valid(guide),
            Change::Part(part) => state.part = Block::valid(part),
            Change::Axis(axis) => state.axis = Block::valid(axis),
            Change::Feed(feed) => state.feed = Block::valid(feed),
            Change::Clearance(plane) => state.clearance = Block::valid(plane),
            Change::Stepover(stepover) => state.stepover = Block::valid(stepover),
        }
    }

    /// The modal state, to be changed.
    pub(in crate::statements) fn regional_mut(&mut self) -> &mut RegionalState {
        Arc::make_mut(&mut self.state.regional)
    }

    /// Warns of conditions that are taken although they can hardly be meant.
    fn report_doubtful_condition(&mut self, major: Major<'_>, change: &Change) {
        match change {
            Change::Guide(GuideCondition { guide, .. }) => {
                if let Some(finding) = beyond(guide) {
                    self.report(finding, major.range);
                }
            }
            Change::Axis(AxisCondition::AtAngle { lead, .. }) if lead.to_degrees().abs() >= DOUBTFUL_LEAD => {
                let value = lead.to_degrees();
                self.report(FindingKind::Doubtful { statement: major.name(), value }, major.range);
            }
            _ => {}
        }
    }
}

/// A finding if the range reaches beyond the guide element.
fn beyond(guide: &Guide) -> Option<FindingKind> {
    use apt_geometry::canonical::Geometry;
    let outside = |name: &str, parameter, range: &ParameterRange, extent: f64| {
        let is_outside = range.low < 0.0 || range.high > extent;
        let (low, high) = (range.low, range.high);
        is_outside.then(|| {
            FindingKind::Sculptured(SculpturedFinding::GuideBeyond {
                name: name.into(),
                parameter,
                low,
                high,
                extent,
            })
        })
    };
    match guide {
        Guide::Surface { surface: NamedSurface { name, geometry: Geometry::Sculptured(surface) }, u, v } => {
            let [along, across] = surface.extent();
            outside(name, 'u', u, along).or_else(|| outside(name, 'v', v, across))
        }
        Guide::Curve { curve: NamedSurface { name, geometry: Geometry::SpaceCurve(curve) }, u } => {
            outside(name, 'u', u, curve.count() as f64)
        }
        _ => None,
    }
}

/// Reads what follows SCON.
fn change(reader: &mut Reader<'_>) -> Read<Change> {
    let change = match reader.word(BLOCKS)? {
        "INIT" => Change::Forget(initial(reader)?),
        "DS" => Change::Guide(guide(reader)?),
        "PS" => Change::Part(part(reader)?),
        "AXIS" => Change::Axis(axis(reader)?),
        "FEED" => match reader.eat_plane() {
            Some(plane) => Change::Clearance(plane),
            None => Change::Feed(feed(reader)?),
        },
        _ => Change::Stepover(stepover(reader)?),
    };
    reader.end()?;
    Ok(change)
}

/// The words after INIT; more than one is an extension.
fn initial(reader: &mut Reader<'_>) -> Read<Vec<&'static str>> {
    let mut words = vec![reader.word(INITIAL)?];
    *reader = reader.clone().numbered(number::CONDITION_WORD);
    while reader.peek().is_some() {
        words.push(reader.word(INITIAL)?);
    }
    Ok(words)
}

/// `ssurf,PARAM,ulo,uhi,vlo,vhi,{AT|ON},{NORMAL|v}` or `scurv,PARAM,ulo,uhi,{AT|ON},{CRSSPL|v}`.
fn guide(reader: &mut Reader<'_>) -> Read<GuideCondition> {
    let element = reader.element(Expected::SculpturedElement)?;
    reader.word(&["PARAM"])?;
    let mut range = || {
        let (low, high) = reader.range(Some(number::CONDITION_VALUE))?;
        Ok::<_, Misfit>(ParameterRange { low, high })
    };
    let u = range()?;
    let (guide, word) = match element {
        Element::Surface(surface) => (Guide::Surface { surface, u, v: range()? }, "NORMAL"),
        Element::Curve(curve) => (Guide::Curve { curve, u }, "CRSSPL"),
    };
    let contact = match reader.word(&["AT", "ON"])? {
        "AT" => GuideContact::At,
        _ => GuideContact::On,
    };
    let projection = if reader.eat(word) {
        if word == "NORMAL" { Projection::Normal } else { Projection::CrossDirection }
    } else {
        Projection::Vector(reader.vector(Some(number::CONDITION_VALUE))?)
    };
    Ok(GuideCondition { guide, contact, projection })
}

/// `{TO|ON},ssurf,{PLUS|MINUS},thick`.
fn part(reader: &mut Reader<'_>) -> Read<PartCondition> {
    let relation = match reader.word(&["TO", "ON"])? {
        "TO" => PartRelation::To,
        _ => PartRelation::On,
    };
    let surface = reader.surface()?;
    let side = reader.sense()?;
    *reader = reader.clone().numbered(number::CONDITION_WORD);
    let thickness = reader.scalar()?;
    Ok(PartCondition { relation, surface, side, thickness })
}

/// `v[,PLUS|MINUS]`, `NORMDS[,PLUS|MINUS]`, `ATANGL,{DS|PS},alpha,CUTANG,beta`.
fn axis(reader: &mut Reader<'_>) -> Read<AxisCondition> {
    if reader.eat("NORMDS") {
        return Ok(AxisCondition::GuideNormal(reader.perhaps_sense()));
    }
    if !reader.eat("ATANGL") {
        if reader.peek_word().is_some() {
            return Err(reader.misfit(Expected::Vector));
        }
        let vector = reader.vector(Some(number::CONDITION_VALUE))?;
        return Ok(AxisCondition::Fixed(vector * reader.perhaps_sense().sign()));
    }
    let reference = match reader.word(&["DS", "PS"])? {
        "DS" => AxisReference::Guide,
        _ => AxisReference::Part,
    };
    let across = angle(reader)?;
    reader.word(&["CUTANG"])?;
    if matches!(reader.peek_word(), Some("LEAD" | "LAG")) {
        // Translated and then refused by the public system: the sign of the angle says it.
        return Err(reader.clone().numbered(number::CONDITION_WORD).misfit(Expected::Scalar));
    }
    let lead = angle(reader)?;
    Ok(AxisCondition::AtAngle { reference, across, lead })
}

/// An angle in degrees, at most a quarter turn either way, as radians.
fn angle(reader: &mut Reader<'_>) -> Read<f64> {
    let degrees = reader.scalar()?;
    if degrees.abs() > LARGEST_ANGLE {
        return Err(reader.bad_value(degrees, Some(number::CONDITION_VALUE)));
    }
    Ok(degrees.to_radians())
}

/// Four feed rates.
fn feed(reader: &mut Reader<'_>) -> Read<FeedCondition> {
    if reader.peek().is_some_and(|item: &Item| item.scalar().is_none()) {
        return Err(reader.clone().numbered(number::CONDITION_OPERAND).misfit(Expected::FeedsOrPlane));
    }
    let value = Some(number::CONDITION_VALUE);
    Ok(FeedCondition {
        cutting: reader.not_negative(value)?,
        stepover: reader.not_negative(value)?,
        plunge: reader.not_negative(value)?,
        rapid: reader.not_negative(value)?,
    })
}

/// `h,smax,lift,npath`.
fn stepover(reader: &mut Reader<'_>) -> Read<StepoverCondition> {
    let value = Some(number::CONDITION_VALUE);
    let scallop = reader.not_negative(value)?;
    let greatest = reader.scalar()?;
    let lift = reader.not_negative(value)?;
    let passes = reader.scalar()?.trunc();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive; saturates")]
    let passes = (passes >= 1.0).then_some(passes as u32);
    Ok(StepoverCondition { scallop, greatest, lift, passes })
}

//! GO and OFFSET: start-up motions (language reference 6.4).

use apt_geometry::motion::{MotionCommand, Relation, StartSurface};
use smol_str::SmolStr;

use super::{super::Major, relation_of};
use crate::{
    evaluator::Evaluator,
    expression::Operand,
    finding::{Expected, FindingKind},
};

/// Most surfaces of a GO statement.
const GO_SURFACES: usize = 3;
/// APT4: a modifier that GO does not take.
const APT4_START_RELATION: u16 = 2006;
/// Most surfaces of an OFFSET statement.
const OFFSET_SURFACES: usize = 2;

impl Evaluator<'_> {
    /// GO and OFFSET with their surfaces and a trailing feed rate.
    pub(crate) fn start_up(&mut self, major: Major<'_>) {
        if self.pending.is_some() {
            self.break_pending(FindingKind::ImpliedCheckBroken { word: major.name() }, major.range);
        }
        let is_go = major.spelling() == "GO";
        let Some(items) = self.operands_of(major, "1 to 3 surfaces", 129) else { return };
        let mut surfaces: Vec<StartSurface> = Vec::new();
        let mut relation: Option<Relation> = None;
        let mut feed = None;
        for (index, item) in items.iter().enumerate() {
            match &item.operand {
                Operand::Word(word) => {
                    let found = relation_of(word.spelling).filter(|_| relation.is_none());
                    let Some(found) =
                        found.filter(|found| self.start_relation(*found, surfaces.len(), is_go))
                    else {
                        let word = SmolStr::new_static(word.spelling);
                        let finding = FindingKind::RelationNotHere { word };
                        return self.report_apt4(finding, APT4_START_RELATION, item.range);
                    };
                    relation = Some(found);
                }
                Operand::Scalar(rate)
                    if index + 1 == items.len() && !surfaces.is_empty() && relation.is_none() =>
                {
                    feed = Some((*rate, item.range));
                }
                _ => {
                    let Some(surface) = self.surface_operand(major, item) else { return };
                    let relation = relation.take().unwrap_or(Relation::To);
                    surfaces.push(StartSurface { relation, surface });
                }
            }
        }
        if relation.is_some() {
            return self.wrong_operand(
                major,
                Expected::Surface,
                crate::finding::Found::Nothing,
                129,
                major.range,
            );
        }
        let limit = if is_go { GO_SURFACES } else { OFFSET_SURFACES };
        if surfaces.is_empty() || surfaces.len() > limit {
            return self.report(FindingKind::SurfaceCount { found: surfaces.len(), limit }, major.range);
        }
        if let Some((rate, range)) = feed {
            self.feed(rate, range);
        }
        let command = if is_go { MotionCommand::Start(surfaces) } else { MotionCommand::Offset(surfaces) };
        self.motion(command, major.range);
    }

    /// TO, ON and PAST stand with any surface, TANTO with the third of a GO only.
    fn start_relation(&self, relation: Relation, before: usize, is_go: bool) -> bool {
        match relation {
            Relation::To | Relation::On | Relation::Past => true,
            // APT4 refuses TANTO in every place.
            Relation::TangentToDrive => is_go && before == 2 && !self.is_apt4(),
            Relation::TangentToPart => false,
        }
    }
}

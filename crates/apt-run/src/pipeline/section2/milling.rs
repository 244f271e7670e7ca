//! SMIL on its way through Section 2: the modal data go in, locations, feed rates and findings come out.

use apt_cldata::record::ClWord;
use apt_geometry::regional::RegionalMilling;
use apt_program::record::Origin;
use apt_sculptured::{
    error::MillingError,
    mill::{Encounter, Milled, Move, Remedy, Setting, mill},
};
use arelem::{section2::Restart, sequence::ToolPosition};

use super::Section2;
use crate::{
    Cancelled,
    pipeline::{Interference, Milling, Outcome, RunFinding, RunFindingKind},
};

impl Section2<'_> {
    /// Carries out a SMIL. It says itself where the tool goes, so that it ends a restart.
    pub(super) fn mill(
        &mut self,
        command: &RegionalMilling,
        origin: &Origin,
        source: u32,
    ) -> Result<(), Cancelled> {
        let setting = Setting {
            cutter: self.state.cutter,
            inside: self.state.inside.part,
            outside: self.state.outside.part,
            maximum_step: self.state.maximum_step,
        };
        let cancel = self.cancel;
        let compute = || {
            let milled = mill(command, &setting, &cancel);
            (milled.failure != Some(MillingError::Cancelled)).then_some(milled)
        };
        let milled = self.memo.get_or_mill(&setting, command, compute).ok_or(Cancelled)?;
        self.end_of_skipping();
        for part in &milled.moves {
            match part {
                Move::Feed(feed) => {
                    if self.output_on {
                        self.feed(origin.isn, source, vec![ClWord::Number(*feed)]);
                    }
                }
                Move::Locations(poses) => {
                    let positions: Vec<ToolPosition> =
                        poses.iter().map(|pose| ToolPosition { tip: pose.end, axis: pose.axis }).collect();
                    self.positions(origin.isn, source, false, "SMIL", &positions);
                }
            }
        }
        self.arrive(&milled);
        self.findings(&milled, command.list_avoidance, origin);
        self.output.milled.push(Milling { origin: origin.clone(), milled });
        Ok(())
    }

    /// The tool is where the last location left it.
    fn arrive(&mut self, milled: &Milled) {
        let mut last = milled.locations().rev();
        if let Some(pose) = last.next() {
            self.state.previous = last.next().map(|pose| pose.end).or(self.state.tip).unwrap_or(pose.end);
            self.state.forward = (pose.end - self.state.previous).try_normalize(0.0).or(self.state.forward);
            self.state.tip = Some(pose.end);
            self.state.axis = pose.axis;
            self.state.restart = Restart::Running;
            self.tool = Some(ToolPosition { tip: pose.end, axis: pose.axis });
            self.before = None;
        }
    }

    /// What there is to tell: interferences of one kind together, with the worst of them; each avoidance by itself where
    /// PRINT/AVPRT asks for that.
    fn findings(&mut self, milled: &Milled, each: bool, origin: &Origin) {
        let mut tell = |kind| self.output.findings.push(RunFinding { kind, origin: origin.clone() });
        for outcome in [Outcome::Told, Outcome::Failed, Outcome::Avoided] {
            if each && outcome != Outcome::Told {
                for worst in milled.encounters.iter().filter(|one| outcome_of(one) == outcome) {
                    let worst = worst.clone();
                    tell(RunFindingKind::Interference(Box::new(Interference { outcome, count: 1, worst })));
                }
                continue;
            }
            let of_kind = || milled.encounters.iter().filter(|one| outcome_of(one) == outcome);
            let deepest = |a: &&Encounter, b: &&Encounter| a.hit.depth.total_cmp(&b.hit.depth);
            if let Some(worst) = of_kind().max_by(deepest) {
                tell(RunFindingKind::Interference(Box::new(Interference {
                    outcome,
                    count: of_kind().count(),
                    worst: worst.clone(),
                })));
            }
        }
        if milled.unproved > 0 {
            tell(RunFindingKind::InterferenceNotProven { locations: milled.unproved });
        }
        if let Some(error) = &milled.failure {
            tell(RunFindingKind::Milling(error.clone()));
        }
    }
}

fn outcome_of(encounter: &Encounter) -> Outcome {
    match encounter.remedy {
        Remedy::None => Outcome::Told,
        Remedy::Avoided { .. } => Outcome::Avoided,
        Remedy::Failed(_) => Outcome::Failed,
    }
}

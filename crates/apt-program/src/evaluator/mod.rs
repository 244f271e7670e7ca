//! The evaluator: the state of Section 1, what a stretch of the program leaves behind, and the place it stands at.

mod conditional;
mod context;
mod include;
mod output;
mod state;
mod step;
mod trace;

pub(crate) use context::{Budget, DataCards, Here, PendingDrive, Region};
pub(crate) use output::{Output, same_place_and_kind};
pub(crate) use state::{State, Synonym};
pub(crate) use step::{StepEnd, TopLevel};
pub(crate) use trace::{RegionLabels, Trace, TracedLine, assigned_names};

use apt_syntax::{
    TextRange,
    dialect::{Dialect, DialectName},
};

use crate::{
    finding::{Finding, FindingKind, RelatedKind, Severity},
    listing::{ListingEntry, ListingKind},
    options::{APT3_MACRO_DEPTH, Options},
    record::{Origin, Record, RecordKind},
};

/// Where control goes after a statement.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Flow {
    /// To the next statement.
    Next,
    /// To a label.
    Jump(apt_syntax::statement::Name),
    /// Out of this loop or macro, because of too many jumps after an error.
    Leave,
    /// Out of everything to the top level: a budget is exhausted or the work is cancelled.
    Abort,
    /// The program has ended.
    End,
}

/// Evaluates statements. Everything that later statements depend on is in `state`, everything produced in `output`.
pub(crate) struct Evaluator<'a> {
    /// The dialect of the program.
    pub(crate) dialect: Dialect,
    /// Its name, which decides the meaning where dialects differ.
    pub(crate) dialect_name: DialectName,
    /// Budgets.
    pub(crate) options: &'a Options,
    /// Asks whether to stop.
    pub(crate) cancel: &'a dyn Fn() -> bool,
    /// What later statements depend on.
    pub(crate) state: State,
    /// What this stretch of the program leaves behind.
    pub(crate) output: Output,
    /// The statement being executed.
    pub(crate) here: Here,
    /// A motion statement that waits for the drive surface of the next one.
    pub(crate) pending: Option<PendingDrive>,
    /// The records behind this top-level step.
    pub(crate) cards: DataCards,
    /// What is left of the budgets of this top-level step.
    pub(crate) budget: Budget,
    /// Errors reported so far, to notice errors inside a region.
    pub(crate) errors: u64,
    /// Values asked for that an error elsewhere has made unknown.
    pub(crate) unknown_values: u64,
    /// How many definitions are around the operand being evaluated.
    pub(crate) definition_depth: u32,
    /// Set once the work is cancelled.
    pub(crate) cancelled: bool,
    /// Set once a file was asked for: its content is not part of any state.
    pub(crate) asked_for_files: bool,
    /// Collects executed statements for an expansion.
    pub(crate) trace: Option<Trace>,
}

impl<'a> Evaluator<'a> {
    /// An evaluator that goes on from `state`.
    pub(crate) fn new(
        dialect: Dialect,
        options: &'a Options,
        cancel: &'a dyn Fn() -> bool,
        state: State,
    ) -> Self {
        Self {
            dialect,
            dialect_name: dialect.name,
            options,
            cancel,
            state,
            output: Output::default(),
            here: Here::default(),
            pending: None,
            cards: DataCards::default(),
            budget: Budget::new(options.statement_budget),
            errors: 0,
            unknown_values: 0,
            definition_depth: 0,
            cancelled: false,
            asked_for_files: false,
            trace: None,
        }
    }

    /// Whether the dialect is APT4.
    pub(crate) fn is_apt4(&self) -> bool {
        self.dialect_name == DialectName::Apt4
    }

    /// Whether the program is a CL file of a CAM system.
    pub(crate) fn is_cl(&self) -> bool {
        self.dialect_name == DialectName::Cl
    }

    /// How deep macro calls may nest.
    pub(crate) fn macro_depth(&self) -> u32 {
        match self.dialect_name {
            DialectName::Apt3 => self.options.macro_depth.min(APT3_MACRO_DEPTH),
            _ => self.options.macro_depth,
        }
    }

    /// The origin of `range` in the statement being executed.
    pub(crate) fn origin(&self, range: TextRange) -> Origin {
        let (frame, source) = (self.here.frame.clone(), self.here.source.clone());
        Origin { isn: self.here.isn, range, frame, source }
    }

    /// Reports a finding at `range` of the statement being executed.
    pub(crate) fn report(&mut self, kind: FindingKind, range: TextRange) {
        self.report_related(kind, range, Vec::new());
    }

    /// Reports a finding with other places that matter.
    pub(crate) fn report_related(
        &mut self,
        kind: FindingKind,
        range: TextRange,
        related: Vec<(RelatedKind, Origin)>,
    ) {
        let mut finding = self.finding(kind, range);
        finding.related = related;
        self.add(finding);
    }

    /// A finding at `range` of the statement being executed.
    pub(crate) fn finding(&self, kind: FindingKind, range: TextRange) -> Finding {
        Finding::new(kind, self.dialect_name, self.origin(range))
    }

    /// Reports a finding that has another number in APT4 where it is found.
    pub(crate) fn report_apt4(&mut self, kind: FindingKind, number: u16, range: TextRange) {
        let mut finding = self.finding(kind, range);
        if self.is_apt4() {
            finding.number = Some(number);
        }
        self.add(finding);
    }

    /// Reports a finding at another statement, which is not executed now.
    pub(crate) fn report_at(&mut self, isn: u32, kind: FindingKind, range: TextRange) {
        let here = std::mem::replace(&mut self.here.isn, isn);
        self.report(kind, range);
        self.here.isn = here;
    }

    /// Adds a finding, and counts it if it is an error.
    pub(crate) fn add(&mut self, finding: Finding) {
        if finding.severity == Severity::Error {
            self.errors += 1;
        }
        self.output.add_finding(finding);
    }

    /// Writes a record that comes from `range` of the statement being executed.
    pub(crate) fn emit(&mut self, kind: RecordKind, range: TextRange) {
        let record = Record { origin: self.origin(range), label: self.here.label.clone(), kind };
        self.output.records.push(record);
    }

    /// Writes to the listing.
    pub(crate) fn list(&mut self, kind: ListingKind, range: TextRange) {
        let entry = ListingEntry { origin: self.origin(range), kind };
        self.output.listing.push(entry);
    }

    /// Asks whether the work is to stop.
    pub(crate) fn is_cancelled(&mut self) -> bool {
        self.cancelled = self.cancelled || (self.cancel)();
        self.cancelled
    }
}

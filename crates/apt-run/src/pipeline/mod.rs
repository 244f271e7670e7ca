//! Runs the sections in order over an evaluated program: motion, edit, totals.

mod earlier;
mod section2;

use std::sync::Arc;

pub(crate) use section2::start_up_rule;

use apt_cldata::{
    edit::EditError,
    record::{ClPoint, ClRecord},
    totals::{Totals, totals},
};
use apt_geometry::patience::Aside;
use apt_program::{Origin, Program};
use apt_sculptured::{
    error::MillingError,
    mill::{Encounter, Milled},
};
use apt_syntax::{SyntaxTree, dialect::DialectName};
use arelem::{
    cure::Remedy,
    error::{MotionFailure, MotionWarning},
};
use smol_str::SmolStr;

use crate::{
    Cancel, Cancelled, Waiting,
    memo::{ComputedMotion, MotionMemo},
    settings::Settings,
};

/// A motion statement that Section 2 has computed.
#[derive(Debug, Clone)]
pub struct Motion {
    /// Where it comes from.
    pub origin: Origin,
    /// The computed sequence with its evidence, shared with the memo.
    pub computed: Arc<ComputedMotion>,
}

/// A SMIL that Section 2 has carried out.
#[derive(Debug, Clone)]
pub struct Milling {
    /// Where it comes from.
    pub origin: Origin,
    /// The path with its interferences, shared with the memo.
    pub milled: Arc<Milled>,
}

/// Positions that DNTCUT/PRINT keeps from the path and lists, as they are before TRACUT and COPY.
#[derive(Debug, Clone)]
pub struct Suppressed {
    /// The statement that makes them.
    pub origin: Origin,
    /// The name that would stand with them on the CL file.
    pub name: SmolStr,
    /// The positions.
    pub points: Vec<ClPoint>,
}

/// What became of interferences.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// AVCTRL is off: they are told.
    Told,
    /// The tool was tilted or lifted.
    Avoided,
    /// No remedy was found.
    Failed,
}

/// The interferences of a SMIL that had the same outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct Interference {
    /// What became of them.
    pub outcome: Outcome,
    /// How many there are.
    pub count: usize,
    /// The deepest of them.
    pub worst: Encounter,
}

/// What went wrong, or is worth saying, after Section 1.
#[derive(Debug, Clone, PartialEq)]
pub struct RunFinding {
    /// What.
    pub kind: RunFindingKind,
    /// The statement concerned.
    pub origin: Origin,
}

/// The kinds of findings of Sections 2 and 3.
#[derive(Debug, Clone, PartialEq)]
pub enum RunFindingKind {
    /// The engine could not carry out a command.
    Failure {
        /// Why.
        failure: MotionFailure,
        /// What was found to cure it, the likeliest first.
        remedies: Vec<Remedy>,
        /// The directed motion before, where one of the remedies changes that.
        earlier: Option<Origin>,
    },
    /// The engine did, with a doubt.
    Warning(MotionWarning),
    /// The independent verifier did not confirm a computed motion.
    Unverified(arelem::verify::Evidence),
    /// The verifier could not judge a computed motion.
    NotJudged(arelem::verify::VerifyError),
    /// Motion statements were passed over after a failure, up to the next restart point.
    Skipped {
        /// How many.
        statements: u32,
        /// ISN of the last of them.
        last: u32,
    },
    /// FINI came while a transfer to this label was pending (APT III 9).
    TransferPending {
        /// The label.
        label: String,
    },
    /// The path has more positions than the budget allows; it ends before this statement.
    TooManyPoints {
        /// How many are allowed.
        limit: u64,
    },
    /// The tool turns on a motion whose positions are put out without axis.
    AxisNotPutOut {
        /// By how much at most, radians.
        angle: f64,
    },
    /// TRACUT, INDEX or COPY.
    Edit(EditError),
    /// A SMIL ended before its end.
    Milling(MillingError),
    /// A checked surface reaches into the tool of a SMIL.
    Interference(Box<Interference>),
    /// Checks of a SMIL ended without proof.
    InterferenceNotProven {
        /// At how many locations.
        locations: u32,
    },
}

/// What a run gives.
#[derive(Debug, Clone)]
pub struct RunResult {
    /// The final CL records, after TRACUT and COPY.
    pub records: Vec<ClRecord>,
    /// Where records come from; [`ClRecord::source`] is an index into it.
    pub origins: Vec<Origin>,
    /// The motions, in order of execution.
    pub motions: Vec<Motion>,
    /// The paths of regional milling, in order of execution.
    pub milled: Vec<Milling>,
    /// What DNTCUT/PRINT lists, in order of execution.
    pub suppressed: Vec<Suppressed>,
    /// What is to be said about them.
    pub findings: Vec<RunFinding>,
}

impl RunResult {
    /// Lengths, time and box of the final path.
    pub fn totals(&self) -> Totals {
        totals(&self.records)
    }
}

/// Records whose origins are looked up between two questions whether to go on, some nanoseconds each.
const ORIGINS_A_QUESTION: usize = 4096;

/// Runs Sections 2 and 3 over a program; nothing comes out of them if the program says PTONLY/1. `progress` gets the
/// number of records done and to do.
///
/// # Errors
///
/// [`Cancelled`] when `cancel` said so before the end.
pub fn run(
    tree: &SyntaxTree,
    program: &Program,
    settings: &Settings,
    memo: &MotionMemo,
    cancel: Cancel<'_>,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<RunResult, Cancelled> {
    memo.begin_run();
    if program.skips_motion() {
        let (records, origins) = (Vec::new(), Vec::new());
        let (motions, milled, findings) = (Vec::new(), Vec::new(), Vec::new());
        let suppressed = Vec::new();
        return Ok(RunResult { records, origins, motions, milled, suppressed, findings });
    }
    let total = program.record_count();
    let mut section2 = section2::Section2::new(total, settings, tree.dialect().name, memo, cancel);
    for (done, record) in program.records().enumerate() {
        if done % 64 == 0 {
            if cancel() {
                return Err(Cancelled);
            }
            progress(done, total);
        }
        section2.record(record)?;
    }
    let output = section2.finish();
    let waiting = Waiting::until(&cancel);
    let indexes = match tree.dialect().name {
        DialectName::Apt3 => apt_cldata::edit::MAXIMUM_INDEXES,
        _ => usize::MAX,
    };
    let limits = apt_cldata::edit::EditLimits { indexes, points: settings.budget.points };
    let unpaired = match tree.dialect().name {
        DialectName::Cl => apt_cldata::edit::copies_without_index(&output.items, waiting.patience()),
        _ => Vec::new(),
    };
    let edited = apt_cldata::edit::edit_until(output.items.taken(), &limits, &cancel);
    let (records, mut edit_errors) = edited.ok_or(Cancelled)?;
    let mut records = Aside::from(records);
    edit_errors.extend(unpaired);
    let mut findings = output.findings;
    findings.extend(edit_errors.into_iter().map(|error| {
        let origin = output.origins.get(error.source as usize).cloned();
        let origin =
            origin.unwrap_or_else(|| Origin::in_program(tree.statement_count() as u32, Default::default()));
        RunFinding { kind: RunFindingKind::Edit(error), origin }
    }));
    for (done, record) in records.iter_mut().enumerate() {
        if (done + 1) % ORIGINS_A_QUESTION == 0 && cancel() {
            return Err(Cancelled);
        }
        // What an included file does is done by the statement of the program that includes or calls it.
        if let Some(origin) = output.origins.get(record.source as usize).filter(|one| one.source.is_some()) {
            record.isn = origin.place_in_program().0;
        }
    }
    Ok(RunResult {
        records: records.taken(),
        origins: output.origins.taken(),
        motions: output.motions,
        milled: output.milled,
        suppressed: output.suppressed,
        findings,
    })
}

//! Section 1, phase 2: evaluates a part program to records, symbols and findings.
//!
//! Evaluation is a fold over statements with cheap checkpoints. Every record and every finding carries its origin:
//! where in the source it comes from and through which macro calls and loop turns.
//!
//! The way of a statement: [`evaluator`] takes it from the tree and opens macros and loops ([`macros`], [`blocks`]),
//! [`statements`] does what it says with operands from [`expression`], names live in [`symbols`]. [`fold`] cuts the
//! program into chunks with checkpoints, so that an edit costs what it touches. [`mod@expand`] shows what was executed.

mod blocks;
mod evaluator;
pub mod expand;
mod expression;
pub mod finding;
pub mod fold;
pub mod listing;
mod macros;
pub mod options;
pub mod record;
mod statements;
pub mod symbols;

use apt_syntax::SyntaxTree;

pub use expand::{ExpandedLine, Expansion, expand, expand_with_remarks, remarks_of};
pub use finding::{
    ControlFinding, Expected, Finding, FindingKind, Found, RelatedKind, SculpturedFinding, Severity,
};
pub use fold::{Program, Statistics};
pub use listing::{ListingEntry, ListingKind, PrintFormat, PrintedItem};
pub use options::{IncludeFailure, IncludeResolver, Options};
pub use record::{Frame, FrameKind, Origin, Record, RecordKind, SourceFile};
pub use symbols::{DefinitionEvent, Value};

/// Evaluates a program from its first statement. `cancel` is asked often; once it says yes, the program returned is
/// not complete.
pub fn evaluate(tree: &SyntaxTree, options: &Options, cancel: &dyn Fn() -> bool) -> Program {
    Program::evaluate(tree, options, cancel)
}

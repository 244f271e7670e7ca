//! Section 4: a data-driven post-processor from CL records to the control tape.
//!
//! Everything that depends on a machine stands in its definition file (`machines/*.toml`): number formats, modal
//! groups, codes, templates of blocks, cycles. [`post`] turns records into a [`Tape`], whose every block is tied to
//! the statement it comes from. [`punch`] makes the image of a punched tape.

mod arc;
mod control;
mod engine;
pub mod finding;
mod form;
pub mod format;
mod kinematics;
pub mod machine;
pub mod punch;
mod tape;
mod template;
mod words;

pub use engine::{Cancelled, post, post_until};
pub use finding::{PostFinding, PostFindingKind, Severity};
pub use form::{Treatment, treatment};
pub use machine::{
    LinearAxis, MachineDefinition, MachineError, MachineInfo, definition_file, machine, machines,
};
pub use tape::{Block, CARD_TEXT, PostOptions, Tape};

//! Section 1, phase 2: evaluates a part program to records, symbols and findings.
//!
//! Evaluation is a fold over statements with cheap checkpoints. Every record and every finding carries its origin:
//! where in the source it comes from and through which macro calls and loop turns.

pub mod record;

//! Arithmetic: expressions, references, functions, conditions and the operands of statements.

mod arithmetic;
mod condition;
mod function;
mod measure;
mod operand;
mod reference;

pub(crate) use operand::{Item, Items, Operand, element_of};
pub(crate) use reference::Resolved;

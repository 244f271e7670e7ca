//! The symbol table: one table for scalars, geometry, arrays, macros and labels (language reference 1.8).

mod array;
mod similar;
mod system;

use std::sync::Arc;

use apt_geometry::{canonical::Geometry, patience::Patience, pieces::sorted};
use smol_str::SmolStr;

pub(crate) use array::{Array, ArrayElement};
pub use similar::similar_names;
pub(crate) use system::{ReferenceSystem, Stored};

use crate::{finding::Found, macros::MacroDefinition, record::Origin};

/// The value of a name, as programs and people see it.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Scalar(f64),
    /// A canonical form, in the coordinates of the reference system in which it was defined.
    Geometry(Arc<Geometry>),
}

/// One definition: a name got a value here.
#[derive(Debug, Clone, PartialEq)]
pub struct DefinitionEvent {
    /// The name.
    pub name: SmolStr,
    /// The subscript, from 1.
    pub subscript: Option<u32>,
    /// The value it got.
    pub value: Value,
    /// The target in the source.
    pub origin: Origin,
}

/// What a name means.
#[derive(Debug, Clone)]
pub(crate) enum Meaning {
    /// A number.
    Scalar(f64),
    /// Geometry.
    Geometry(Stored),
    /// A reserved array.
    Array(Array),
    /// A macro.
    Macro(Arc<MacroDefinition>),
    /// A statement label of the top level.
    Label,
    /// Its definition failed; uses are passed over in silence.
    Poisoned,
}

/// A name with its meaning and the place of its last definition.
#[derive(Debug, Clone)]
pub(crate) struct Symbol {
    /// What it means.
    pub(crate) meaning: Meaning,
    /// Where it got this meaning.
    pub(crate) origin: Origin,
}

/// The table. Persistent, so that a checkpoint costs little: the copies of its nodes that checkpoints keep are small,
/// because symbols stand outside of them. Ordered, because programs number their names: those that are defined between
/// two checkpoints are mostly neighbours and share the nodes that are copied for them.
pub(crate) type SymbolTable = imbl::OrdMap<SmolStr, Arc<Symbol>>;

impl Meaning {
    /// What the name is, as evidence of a finding.
    pub(crate) fn found(&self) -> Found {
        match self {
            Meaning::Scalar(_) => Found::Scalar,
            Meaning::Geometry(stored) => Found::Geometry(stored.geometry.kind()),
            Meaning::Array(_) => Found::Array,
            Meaning::Macro(_) => Found::Macro,
            Meaning::Label => Found::Label,
            Meaning::Poisoned => Found::Nothing,
        }
    }

    /// Whether both mean the same; places are compared by the caller.
    pub(crate) fn same(&self, other: &Meaning) -> bool {
        match (self, other) {
            (Meaning::Scalar(left), Meaning::Scalar(right)) => left.to_bits() == right.to_bits(),
            (Meaning::Geometry(left), Meaning::Geometry(right)) => left == right,
            (Meaning::Array(left), Meaning::Array(right)) => left == right,
            (Meaning::Macro(left), Meaning::Macro(right)) => left.same_text(right),
            (Meaning::Label, Meaning::Label) | (Meaning::Poisoned, Meaning::Poisoned) => true,
            _ => false,
        }
    }
}

/// All names with values, sorted; elements of arrays as `NAME(3)`. Geometry is in the coordinates of `system`, or, if
/// it cannot be carried there, of the system in which it was defined. Those before the place where who waits gives up.
pub(crate) fn values_of(
    table: &SymbolTable,
    system: Option<&Arc<ReferenceSystem>>,
    patience: Patience<'_>,
) -> Vec<(SmolStr, Value)> {
    let seen = |stored: &Stored| {
        Value::Geometry(stored.seen_from(system).unwrap_or_else(|| Arc::clone(&stored.geometry)))
    };
    let mut values = Vec::with_capacity(table.len());
    for (name, symbol) in table {
        if patience.ends_after(1) {
            break;
        }
        match &symbol.meaning {
            Meaning::Scalar(number) => values.push((name.clone(), Value::Scalar(*number))),
            Meaning::Geometry(stored) => values.push((name.clone(), seen(stored))),
            Meaning::Array(array) => {
                let stem = name.trim_end_matches(ARRAY_KEY_SUFFIX);
                for (subscript, element) in array.elements() {
                    if patience.ends_after(1) {
                        break;
                    }
                    let value = match element {
                        ArrayElement::Scalar(number) => Value::Scalar(*number),
                        ArrayElement::Geometry(stored) => seen(stored),
                        ArrayElement::Poisoned => continue,
                    };
                    values.push((smol_str::format_smolstr!("{stem}({subscript})"), value));
                }
            }
            Meaning::Macro(_) | Meaning::Label | Meaning::Poisoned => {}
        }
    }
    sorted(values, |left, right| natural_order(&left.0, &right.0), patience)
}

/// What is appended to the name of an array where arrays and simple names of one stem are distinct (APT4).
pub(crate) const ARRAY_KEY_SUFFIX: &str = "()";

/// Orders `A(2)` before `A(10)`.
fn natural_order(left: &str, right: &str) -> std::cmp::Ordering {
    fn split(name: &str) -> (&str, u32) {
        match name.split_once('(') {
            Some((stem, rest)) => (stem, rest.trim_end_matches(')').parse().unwrap_or(0)),
            None => (name, 0),
        }
    }
    split(left).cmp(&split(right))
}

//! Names and subscripts: what a reference stands for.

use apt_syntax::{
    statement::{Argument, Expression, Reference, WordUse},
    vocabulary,
};
use smol_str::{SmolStr, format_smolstr};

use super::operand::element_of;
use crate::{
    evaluator::Evaluator,
    finding::{FindingKind, RelatedKind},
    symbols::{ARRAY_KEY_SUFFIX, ArrayElement, Meaning, Stored, Symbol, similar_names},
};

/// APT4: a subscript on a name that is defined but not reserved.
const APT4_UNRESERVED: u16 = 1013;
/// APT4: an element of an array of which none is defined.
const APT4_EMPTY_ARRAY: u16 = 1014;
/// APT4: a name without value makes a statement that it does not understand.
const APT4_UNDEFINED: u16 = 1007;
/// APT4: no form of a definition, or one of its parameters is not defined.
const APT4_UNDEFINED_PARAMETER: u16 = 2001;

/// What a reference stands for.
#[derive(Debug, Clone)]
pub(crate) enum Resolved {
    /// A number.
    Scalar(f64),
    /// Geometry, with its name as `NAME` or `NAME(3)`.
    Geometry {
        /// The name.
        name: SmolStr,
        /// The geometry.
        stored: Stored,
    },
}

impl Evaluator<'_> {
    /// What a reference stands for; nothing if it has no value, which has been reported unless its definition failed.
    pub(crate) fn resolve(&mut self, reference: &Reference) -> Option<Resolved> {
        match &reference.subscript {
            Some(subscript) => {
                if let Some(function) = self.later_function(reference) {
                    let argument = Argument::Expression((**subscript).clone());
                    let value = self.function(&function, &[argument], reference.range);
                    return value.map(Resolved::Scalar);
                }
                let subscript = self.scalar(subscript);
                let index = self.element_index(reference, subscript?)?;
                self.resolve_element(reference, index)
            }
            None => self.resolve_name(reference),
        }
    }

    /// The function of later systems that this is, in a dialect that has them, unless an array has its name.
    fn later_function(&self, reference: &Reference) -> Option<WordUse> {
        if !self.dialect.later_functions || self.look_up(&reference.name.text).is_some() {
            return None;
        }
        let word = vocabulary::later_function(&reference.name.text)?;
        Some(WordUse { word, range: reference.name.range })
    }

    /// A name without subscript.
    fn resolve_name(&mut self, reference: &Reference) -> Option<Resolved> {
        let name = &reference.name.text;
        self.mark_used(name);
        // In APT4 an array has a key of its own: it is a value without its subscript neither there nor here.
        let Some(symbol) = self.look_up(name).or_else(|| self.look_up(&self.array_key(name))) else {
            self.report_undefined(name.clone(), reference, APT4_UNDEFINED);
            return None;
        };
        let origin = symbol.origin.clone();
        let kind = match &symbol.meaning {
            Meaning::Scalar(value) => return Some(Resolved::Scalar(*value)),
            Meaning::Geometry(stored) => {
                return Some(Resolved::Geometry { name: name.clone(), stored: stored.clone() });
            }
            Meaning::Poisoned => {
                self.unknown_values += 1;
                return None;
            }
            Meaning::Array(array) => {
                FindingKind::SubscriptMissing { name: name.clone(), extent: array.extent }
            }
            Meaning::Macro(_) => FindingKind::MacroAsValue { name: name.clone() },
            Meaning::Label => FindingKind::LabelAsValue { name: name.clone() },
        };
        self.report_related(kind, reference.range, vec![(RelatedKind::Definition, origin)]);
        None
    }

    /// An element of an array.
    fn resolve_element(&mut self, reference: &Reference, index: u32) -> Option<Resolved> {
        let key = self.array_key(&reference.name.text);
        let name = format_smolstr!("{}({index})", reference.name.text);
        let element = match self.look_up(&key).map(|symbol| &symbol.meaning) {
            Some(Meaning::Array(array)) => array.get(index).cloned(),
            _ => None,
        };
        match element {
            Some(ArrayElement::Scalar(value)) => Some(Resolved::Scalar(value)),
            Some(ArrayElement::Geometry(stored)) => Some(Resolved::Geometry { name, stored }),
            Some(ArrayElement::Poisoned) => {
                self.unknown_values += 1;
                None
            }
            None => {
                let number = if self.array_is_empty(&key) { APT4_EMPTY_ARRAY } else { APT4_UNDEFINED };
                self.report_undefined(name, reference, number);
                None
            }
        }
    }

    /// Whether no element of a reserved array is defined.
    fn array_is_empty(&self, key: &str) -> bool {
        let meaning = self.look_up(key).map(|symbol| &symbol.meaning);
        matches!(meaning, Some(Meaning::Array(array)) if array.holds_geometry.is_none())
    }

    /// The key of an array in the symbol table: in APT4 `P1` and `P1(1)` are distinct.
    pub(crate) fn array_key(&self, name: &SmolStr) -> SmolStr {
        if self.is_apt4() { format_smolstr!("{name}{ARRAY_KEY_SUFFIX}") } else { name.clone() }
    }

    /// The subscript as an index of this array: truncated, and inside the reserved range.
    pub(crate) fn element_index(&mut self, reference: &Reference, subscript: f64) -> Option<u32> {
        let extent = self.array_extent(reference)?;
        let whole = subscript.trunc();
        if let Some(index) = element_of(whole, extent) {
            return Some(index);
        }
        let name = reference.name.text.clone();
        let related = self.reservation(&name);
        self.report_related(
            FindingKind::SubscriptRange { name, subscript, extent },
            reference.range,
            related,
        );
        None
    }

    /// The extent of a reserved array, or a finding that the name is not reserved.
    pub(crate) fn array_extent(&mut self, reference: &Reference) -> Option<u32> {
        let key = self.array_key(&reference.name.text);
        self.mark_used(&key);
        match self.look_up(&key).map(|symbol| &symbol.meaning) {
            Some(Meaning::Array(array)) => Some(array.extent),
            Some(Meaning::Poisoned) => {
                self.unknown_values += 1;
                None
            }
            Some(_) | None => {
                let name = reference.name.text.clone();
                let related = self.definition_of(&name);
                let exists = !related.is_empty();
                let mut finding = self.finding(FindingKind::NotReserved { name }, reference.range);
                finding.related = related;
                if exists && self.is_apt4() {
                    finding.number = Some(APT4_UNRESERVED);
                }
                self.add(finding);
                None
            }
        }
    }

    /// The RESERV of an array, as a related place.
    fn reservation(&self, name: &SmolStr) -> Vec<(RelatedKind, crate::record::Origin)> {
        let key = self.array_key(name);
        let symbol = self.look_up(&key);
        symbol.map(|symbol| (RelatedKind::Reservation, symbol.origin.clone())).into_iter().collect()
    }

    /// The definition of a name, as a related place.
    pub(crate) fn definition_of(&self, name: &str) -> Vec<(RelatedKind, crate::record::Origin)> {
        let symbol = self.look_up(name);
        symbol.map(|symbol| (RelatedKind::Definition, symbol.origin.clone())).into_iter().collect()
    }

    /// Words among some and defined names that are spelt like a name, best first.
    pub(crate) fn names_like<'a>(
        &'a mut self,
        name: &str,
        words: impl Iterator<Item = &'a str>,
    ) -> Vec<SmolStr> {
        self.output.looked_at_all = true;
        let names = self.state.symbols.keys().map(|key| key.trim_end_matches(ARRAY_KEY_SUFFIX));
        similar_names(name, words.chain(names))
    }

    /// Reports an undefined name with names like it; once for each place.
    fn report_undefined(&mut self, name: SmolStr, reference: &Reference, apt4_number: u16) {
        if self.output.has_name_finding_at(self.here.isn, reference.range) {
            self.errors += 1;
            return;
        }
        let similar = self.names_like(&name, std::iter::empty());
        let mut finding = self.finding(FindingKind::Undefined { name, similar }, reference.range);
        if self.is_apt4() {
            let in_definition = self.definition_depth > 0 && apt4_number == APT4_UNDEFINED;
            finding.number = Some(if in_definition { APT4_UNDEFINED_PARAMETER } else { apt4_number });
        }
        self.add(finding);
    }

    /// The meaning of a name. That somebody asked is noted: after an edit, what follows from the answer is evaluated again
    /// if the answer is another one.
    pub(crate) fn look_up(&self, name: &str) -> Option<&Symbol> {
        let mut looked_up = self.output.looked_up.borrow_mut();
        if !looked_up.contains(name) {
            looked_up.insert(SmolStr::new(name));
        }
        drop(looked_up);
        self.state.symbol(name)
    }

    /// Notes that a name was used.
    pub(crate) fn mark_used(&mut self, name: &SmolStr) {
        if !self.output.used.contains(name) {
            self.output.used.insert(name.clone());
        }
    }

    /// Whether an expression is a plain reference, perhaps in parentheses.
    pub(crate) fn plain_reference(expression: &Expression) -> Option<&Reference> {
        match expression {
            Expression::Reference(reference) => Some(reference),
            Expression::Parenthesised { inner, .. } => Self::plain_reference(inner),
            _ => None,
        }
    }
}

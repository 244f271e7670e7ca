//! ZSURF, REFSYS, CANON, RESERV, SYN, OBTAIN (language reference 7).

use std::sync::Arc;

use apt_geometry::canonical::{Geometry, GeometryKind, Plane};
use apt_syntax::{
    TextRange,
    statement::{Argument, Expression, Name, Reference, WordUse},
};
use smol_str::SmolStr;

use super::Major;
use crate::{
    evaluator::{Evaluator, Region, Synonym},
    expression::{Item, Operand},
    finding::{Expected, FindingKind, Found, SynonymFault},
    symbols::{Array, Meaning, ReferenceSystem},
};

/// Most synonyms (language reference 1.10).
const MOST_SYNONYMS: usize = 50;
/// Most elements that one array may have; far above what the limits of APT III allow.
const LARGEST_EXTENT: f64 = 1_000_000.0;

impl Evaluator<'_> {
    /// ZSURF/plane, ZSURF/a,b,c,d or ZSURF/NOMORE.
    pub(crate) fn z_surface(&mut self, major: Major<'_>) {
        let Some(items) = self.operands_of(major, "a plane", 129) else { return };
        let plane = match items.as_slice() {
            [item] if item.word() == Some("NOMORE") => Some(Plane::horizontal()),
            [item] => match item.geometry() {
                Some(Geometry::Plane(plane)) => Some(*plane),
                _ => {
                    let number = if item.scalar().is_some() { 1000 } else { 26 };
                    return self.wrong_operand(major, Expected::Plane, item.found(), number, item.range);
                }
            },
            _ => {
                let Some(numbers) = self.scalars_of(major, &items, 26) else { return };
                let [a, b, c, d] = *numbers.as_slice() else {
                    return self.wrong_count(major, numbers.len(), "a plane or 4 numbers", 1000);
                };
                Plane::from_equation(a, b, c, d)
            }
        };
        match plane.filter(|plane| plane.z_over(0.0, 0.0).is_some_and(f64::is_finite)) {
            Some(plane) => self.state.z_surface = plane,
            None => self.report(FindingKind::VerticalZSurface, major.range),
        }
    }

    /// REFSYS/matrix or REFSYS/NOMORE.
    pub(crate) fn reference_system(&mut self, major: Major<'_>) {
        let Some(items) = self.operands(major.arguments) else { return };
        let item = match items.as_slice() {
            [item] => item,
            _ => {
                let found = items.first().map_or(Found::Nothing, Item::found);
                return self.report(FindingKind::ReferenceSystem { found }, major.range);
            }
        };
        match &item.operand {
            Operand::Word(word) if word.spelling == "NOMORE" => self.state.system = None,
            Operand::Geometry { name, geometry } => match (&**geometry, name.is_empty()) {
                (Geometry::Matrix(matrix), false) => match ReferenceSystem::new(name.clone(), *matrix) {
                    Some(system) => self.state.system = Some(Arc::new(system)),
                    None => self.report(FindingKind::SingularMatrix, item.range),
                },
                _ => self.report(FindingKind::ReferenceSystem { found: item.found() }, item.range),
            },
            _ => self.report(FindingKind::ReferenceSystem { found: item.found() }, item.range),
        }
    }

    /// CANON/ON and CANON/OFF.
    pub(crate) fn canon_switch(&mut self, major: Major<'_>) {
        let Some(items) = self.operands(major.arguments) else { return };
        match items.as_slice() {
            [item] if item.word() == Some("ON") => self.state.canon = true,
            [item] if item.word() == Some("OFF") => self.state.canon = false,
            _ => {
                let found = items.first().map_or(Found::Nothing, Item::found);
                self.wrong_operand(major, Expected::OnOrOff, found, 132, major.range);
            }
        }
    }

    /// RESERV: pairs of name and extent; the first pair fixes the order.
    pub(crate) fn reserve(&mut self, major: Major<'_>) {
        if self.here.region != Region::Top {
            return self.report(FindingKind::ReserveInRegion, major.word.range);
        }
        if major.arguments.is_empty() {
            return self.report(FindingKind::ReserveForm, major.range);
        }
        let name_first = plain_name(&major.arguments[0]).is_some();
        if !name_first && self.is_apt4() {
            // APT4 knows one order only.
            return self.report(FindingKind::ReserveForm, major.arguments[0].range());
        }
        for pair in major.arguments.chunks(2) {
            let [first, second] = pair else {
                return self.report(FindingKind::ReserveForm, major.range);
            };
            let (name, extent) = if name_first { (first, second) } else { (second, first) };
            match (plain_name(name), plain_extent(extent)) {
                (Some(name), Some(extent)) => self.reserve_array(name, extent),
                _ => self.report(FindingKind::ReserveForm, first.range().cover(second.range())),
            }
        }
    }

    /// Declares one array.
    fn reserve_array(&mut self, name: &Name, extent: f64) {
        if !(1.0..=LARGEST_EXTENT).contains(&extent) {
            return self.report(FindingKind::ReserveExtent { extent }, name.range);
        }
        let key = self.array_key(&name.text);
        if self.look_up(&key).is_some() {
            let related = self.definition_of(&key);
            let finding = FindingKind::ReserveUsed { name: name.text.clone() };
            return self.report_related(finding, name.range, related);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "range checked above")]
        let array = Array::new(extent as u32);
        let origin = self.origin(name.range);
        self.set_symbol(key, Meaning::Array(array), origin);
    }

    /// SYN: pairs of a new spelling and a vocabulary word; the first pair fixes the order.
    pub(crate) fn synonyms(&mut self, major: Major<'_>) {
        if self.here.region != Region::Top {
            return self.report(FindingKind::SynonymInRegion, major.word.range);
        }
        if major.arguments.is_empty() || !major.arguments.len().is_multiple_of(2) {
            return self.report(FindingKind::SynonymPairs { found: major.arguments.len() }, major.range);
        }
        let new_first = plain_name(&major.arguments[0]).is_some();
        for pair in major.arguments.chunks(2) {
            let [first, second] = pair else { continue };
            let (new, old) = if new_first { (first, second) } else { (second, first) };
            let fault = self.synonym_fault(new, old);
            let (Some(new), Argument::Word(old), None) = (plain_name(new), old, fault) else {
                let fault = fault.unwrap_or(SynonymFault::NotNew);
                let (first_text, second_text) = (spelled(first), spelled(second));
                let finding = FindingKind::SynonymKind { first: first_text, second: second_text, fault };
                self.report(finding, first.range().cover(second.range()));
                continue;
            };
            if self.dialect.bounded_tables && self.state.synonyms.len() >= MOST_SYNONYMS {
                return self.report(FindingKind::SynonymCount { limit: MOST_SYNONYMS }, major.range);
            }
            let word = Synonym::Word(SmolStr::new_static(old.word.spelling));
            self.state.synonyms.insert(new.text.clone(), word);
        }
    }

    /// What is wrong with a pair of SYN.
    fn synonym_fault(&self, new: &Argument, old: &Argument) -> Option<SynonymFault> {
        let is_item =
            |argument: &Argument| matches!(argument, Argument::Word(_)) || plain_name(argument).is_some();
        let is_renamed = |old: &Argument| matches!(old, Argument::Word(old) if old.word.spelling != "SYN");
        match plain_name(new) {
            _ if !is_item(new) || !is_item(old) => Some(SynonymFault::NoSymbol),
            None => Some(SynonymFault::NotNew),
            Some(name) if self.look_up(&name.text).is_some() => Some(SynonymFault::NotNew),
            Some(_) => (!is_renamed(old)).then_some(SynonymFault::NotWord),
        }
    }

    /// OBTAIN,type/surface,names.
    pub(crate) fn obtain(
        &mut self,
        word: &WordUse,
        kind: &WordUse,
        arguments: &[Argument],
        range: TextRange,
    ) {
        let mut items = Vec::with_capacity(1);
        let Some(first) = arguments.first() else {
            let finding = FindingKind::Operand {
                statement: SmolStr::new_static(word.word.spelling),
                expected: Expected::Surface,
                found: Found::Nothing,
                number: 152,
            };
            return self.report(finding, range);
        };
        let source = self.operand(first, &mut items).and(items.first());
        let targets = &arguments[1..];
        let Some(values) = source.and_then(|item| self.obtain_values(kind, item, first.range())) else {
            for target in targets {
                if let Argument::Expression(Expression::Reference(reference)) = target
                    && self.look_up(&reference.name.text).is_none()
                    && reference.subscript.is_none()
                {
                    self.assign_scalar(reference, None);
                }
            }
            return;
        };
        if targets.len() > values.len() {
            let obtained = GeometryKind::from_word(kind.word.spelling).unwrap_or(GeometryKind::Point);
            let finding =
                FindingKind::ObtainCount { kind: obtained, available: values.len(), wanted: targets.len() };
            self.report(finding, range);
        }
        for (target, value) in targets.iter().zip(values) {
            match target {
                Argument::Empty(_) => {}
                Argument::Expression(Expression::Reference(reference)) => self.obtain_into(reference, value),
                other => {
                    let finding = FindingKind::Operand {
                        statement: SmolStr::new_static(word.word.spelling),
                        expected: Expected::Name,
                        found: Found::Scalar,
                        number: 153,
                    };
                    self.report(finding, other.range());
                }
            }
        }
    }

    /// Assigns one obtained value; a name that holds geometry is a redefinition.
    fn obtain_into(&mut self, reference: &Reference, value: f64) {
        if reference.subscript.is_none()
            && let Found::Geometry(kind) = self.found_name(&reference.name.text)
        {
            let name = reference.name.text.clone();
            let related = self.definition_of(&name);
            return self.report_related(FindingKind::Redefined { name, kind }, reference.range, related);
        }
        self.assign_scalar(reference, Some(value));
    }

    /// The canonical values, if the type is the one said.
    fn obtain_values(&mut self, kind: &WordUse, item: &Item, range: TextRange) -> Option<Vec<f64>> {
        let expected = GeometryKind::from_word(kind.word.spelling);
        let (Some(geometry), Some(expected)) = (item.geometry(), expected) else {
            let finding = FindingKind::Operand {
                statement: SmolStr::new_static("OBTAIN"),
                expected: Expected::Surface,
                found: item.found(),
                number: 152,
            };
            self.report(finding, range);
            return None;
        };
        let found = geometry.kind();
        if found != expected {
            self.report(FindingKind::ObtainType { name: item.name(), expected, found }, range);
            return None;
        }
        let is_large = matches!(
            found,
            GeometryKind::TabulatedCylinder
                | GeometryKind::RuledSurface
                | GeometryKind::PolyConic
                | GeometryKind::Pattern
                | GeometryKind::Mesh
                | GeometryKind::ElementSurface
                | GeometryKind::Sculptured
                | GeometryKind::SpaceCurve
        );
        if is_large {
            self.report(FindingKind::ObtainLarge { kind: found }, range);
            return None;
        }
        Some(geometry.canonical_values())
    }
}

/// A plain name.
fn plain_name(argument: &Argument) -> Option<&Name> {
    match argument {
        Argument::Expression(Expression::Reference(reference)) if reference.subscript.is_none() => {
            Some(&reference.name)
        }
        _ => None,
    }
}

/// A plain number.
fn plain_extent(argument: &Argument) -> Option<f64> {
    match argument {
        Argument::Expression(Expression::Number { value, .. }) => Some(*value),
        _ => None,
    }
}

/// The spelling of an operand of SYN.
fn spelled(argument: &Argument) -> SmolStr {
    match argument {
        Argument::Word(word) => SmolStr::new_static(word.word.spelling),
        other => plain_name(other).map_or_else(SmolStr::default, |name| name.text.clone()),
    }
}

//! Assignments and definitions: what gives a name its meaning.

use std::sync::Arc;

use apt_geometry::{
    canonical::{Geometry, GeometryKind, RuledSurface, TabulatedCylinder},
    definition::{self, Argument, DefinitionContext, DefinitionError, Modifier, RuledFault},
};
use apt_syntax::{
    TextRange,
    statement::{Definition, Expression, Name, Reference},
};
use smol_str::SmolStr;

use super::sculptured::asks_parametric;
use crate::{
    evaluator::{Evaluator, Synonym},
    expression::{Item, Operand, Resolved},
    finding::{FindingKind, Found, RelatedKind},
    listing::NESTED,
    record::Origin,
    symbols::{ArrayElement, DefinitionEvent, Meaning, Stored, Symbol, Value},
};

/// Least corner of a TABCYL that is told, in degrees: FOURPT leaves smaller ones at most of its points.
const LEAST_CORNER: f64 = 1.0;
/// Least jump of curvature of a spline that is told, times the shorter chord: half a radian of turn over a chord. The
/// fairing of APT III leaves much less.
const LEAST_CURVATURE_JUMP: f64 = 0.5;

/// Parameters of one curve of a RLDSRF: surface, two end points, and the point or vector across.
const CURVE_PARAMETERS: usize = 4;

/// Most points of a TABCYL and of a PATERN where tables are bounded, and the APT III numbers of more (language
/// reference 1.10).
const MOST_CURVE_POINTS: usize = 139;
const MOST_PATTERN_POINTS: usize = 330;
const CURVE_OVERFLOW: u16 = 1001;
const PATTERN_OVERFLOW: u16 = 802;

/// A target with its subscript evaluated.
struct Target<'a> {
    reference: &'a Reference,
    index: Option<u32>,
}

impl Evaluator<'_> {
    /// `target = expression`.
    pub(crate) fn assignment(&mut self, target: &Reference, value: &Expression) {
        if self.is_apt4() && self.copy_geometry(target, value).is_some() {
            return;
        }
        let number = self.scalar(value);
        self.assign_scalar(target, number);
    }

    /// `Q=P` copies geometry in APT4.
    fn copy_geometry(&mut self, target: &Reference, value: &Expression) -> Option<()> {
        let source = Self::plain_reference(value)?;
        let is_geometry = match self.look_up(&source.name.text).map(|symbol| &symbol.meaning) {
            Some(Meaning::Geometry(_)) => true,
            _ => source.subscript.is_some() && self.holds_geometry(source),
        };
        if !is_geometry {
            return None;
        }
        if let Some(Resolved::Geometry { stored, .. }) = self.resolve(source) {
            self.define_stored(target, Some(stored), false);
        }
        Some(())
    }

    /// Whether a reference names an array of geometry.
    fn holds_geometry(&self, reference: &Reference) -> bool {
        let key = self.array_key(&reference.name.text);
        matches!(
            self.look_up(&key).map(|symbol| &symbol.meaning),
            Some(Meaning::Array(array)) if array.holds_geometry == Some(true)
        )
    }

    /// Gives a name a number, or poisons it when there is none.
    pub(crate) fn assign_scalar(&mut self, target: &Reference, number: Option<f64>) {
        let Some(target) = self.target(target) else { return };
        if let Some(index) = target.index {
            self.assign_element(&target, index, number.map_or(ArrayElement::Poisoned, ArrayElement::Scalar));
            return;
        }
        let name = &target.reference.name.text;
        if let Some(symbol) = self.look_up(name) {
            let finding = match &symbol.meaning {
                Meaning::Scalar(_) | Meaning::Poisoned => None,
                Meaning::Geometry(stored) => {
                    Some(FindingKind::GeometryToScalar { name: name.clone(), kind: stored.geometry.kind() })
                }
                Meaning::Array(array) => {
                    Some(FindingKind::SubscriptMissing { name: name.clone(), extent: array.extent })
                }
                other => Some(FindingKind::NotAssignable { name: name.clone(), found: other.found() }),
            };
            if let Some(finding) = finding {
                let related = vec![(RelatedKind::Definition, symbol.origin.clone())];
                self.report_related(finding, target.reference.range, related);
                return;
            }
        }
        let origin = self.origin(target.reference.range);
        match number {
            Some(value) => {
                self.log(name.clone(), None, Value::Scalar(value), &origin);
                self.set_symbol(name.clone(), Meaning::Scalar(value), origin);
            }
            None => self.set_symbol(name.clone(), Meaning::Poisoned, origin),
        }
    }

    /// `target = TYPE/…`.
    pub(crate) fn definition(&mut self, target: &Reference, definition: &Definition) {
        let geometry = self.define(definition, Some(target));
        let stored = geometry.map(|geometry| Stored { geometry, system: self.state.system.clone() });
        self.define_stored(target, stored, has_canon(definition));
    }

    /// `(TYPE/…)` or `(name=TYPE/…)`.
    pub(crate) fn nested_definition(
        &mut self,
        target: Option<&Reference>,
        definition: &Definition,
        range: TextRange,
    ) -> Option<Operand> {
        let geometry = self.define(definition, target);
        if let Some(target) = target {
            let stored =
                geometry.clone().map(|geometry| Stored { geometry, system: self.state.system.clone() });
            self.define_stored(target, stored, has_canon(definition));
        }
        let geometry = geometry?;
        if target.is_none() && matches!(*geometry, Geometry::Pattern(_)) {
            self.report(FindingKind::UnnamedPattern, range);
            return None;
        }
        let name = match target {
            Some(target) => target.name.text.clone(),
            None => {
                let stored = Stored { geometry: Arc::clone(&geometry), system: self.state.system.clone() };
                self.list_definition(&NESTED, None, &stored, range);
                SmolStr::default()
            }
        };
        Some(Operand::Geometry { name, geometry })
    }

    /// Evaluates a definition. Mistakes are reported at the definition.
    fn define(&mut self, definition: &Definition, target: Option<&Reference>) -> Option<Arc<Geometry>> {
        let word = definition.kind.word.spelling;
        if has_canon(definition) {
            self.refuse_inclusive(&definition.arguments)?;
        }
        self.definition_depth += 1;
        let items = self.operands(&definition.arguments);
        self.definition_depth -= 1;
        let Some(kind) = GeometryKind::from_word(word) else {
            let finding = FindingKind::UnknownType { word: SmolStr::new_static(word) };
            self.report(finding, definition.kind.range);
            return None;
        };
        let items = items?;
        if items.is_empty() {
            self.report(
                FindingKind::OperandCount {
                    statement: SmolStr::new_static(word),
                    found: 0,
                    expected: SmolStr::new_static("at least 1"),
                    number: 129,
                },
                definition.range,
            );
            return None;
        }
        if self.is_apt4() && has_canon(definition) {
            self.refuse_skipped(kind, &items, definition.range)?;
        }
        if asks_parametric(kind, &items) {
            return self.intersection(kind, &items, definition.range).map(Arc::new);
        }
        if matches!(kind, GeometryKind::SpaceCurve | GeometryKind::Sculptured) && !has_canon(definition) {
            return self.parametric_definition(kind, &items, definition.range).map(Arc::new);
        }
        let arguments = self.definition_arguments(kind, &items)?;
        let context = DefinitionContext { z_surface: self.state.z_surface };
        match definition::define(kind, &arguments, &context) {
            Ok(Geometry::Line(line)) if self.is_apt4() && is_line_by_two_points(&arguments) => {
                // The normal of APT4 points to the left of the way from the first to the second point.
                Some(Arc::new(Geometry::Line(line.reversed())))
            }
            Ok(geometry) => {
                if let Some(error) = self.beyond_storage(&geometry) {
                    self.report(FindingKind::Definition { kind, error }, definition.range);
                    return None;
                }
                if let Geometry::TabulatedCylinder(curve) = &geometry {
                    self.report_joints(curve, &arguments, definition.range);
                }
                if let Geometry::RuledSurface(surface) = &geometry {
                    self.report_ruled_faults(surface, &items, definition.range);
                }
                self.report_doubtful_geometry(&geometry, &arguments, definition.range);
                Some(Arc::new(geometry))
            }
            Err(error) => {
                let range = target.map_or(definition.range, |target| definition.range.cover(target.range));
                self.report(FindingKind::Definition { kind, error }, range);
                None
            }
        }
    }

    /// The error of a curve or pattern with more points than APT III stores, where tables are bounded.
    fn beyond_storage(&self, geometry: &Geometry) -> Option<DefinitionError> {
        let (points, most, number) = match geometry {
            // Beside the intervals between the points there are the two extensions.
            Geometry::TabulatedCylinder(curve) => {
                (curve.intervals.len().saturating_sub(1), MOST_CURVE_POINTS, CURVE_OVERFLOW)
            }
            Geometry::Pattern(pattern) => (pattern.points.len(), MOST_PATTERN_POINTS, PATTERN_OVERFLOW),
            _ => return None,
        };
        let beyond = self.dialect.bounded_tables && points > most;
        beyond.then_some(DefinitionError::Special { number, position: None })
    }

    /// Warns of corners in a curve, and of a spline without continuous curvature.
    fn report_joints(&mut self, curve: &TabulatedCylinder, arguments: &[Argument], range: TextRange) {
        let joints = curve.joints();
        let corners: Vec<_> = joints.iter().filter(|joint| joint.corner > LEAST_CORNER).collect();
        if let Some(worst) = corners.iter().max_by(|a, b| a.corner.total_cmp(&b.corner)) {
            let (point, degrees, others) = (worst.point, worst.corner, corners.len() - 1);
            return self.report(FindingKind::Corner { point, degrees, others }, range);
        }
        if !arguments.contains(&Argument::Modifier(Modifier::Spline)) {
            return;
        }
        // At the end points the curve goes over into its straight extensions, at the last inner point APT III leaves a
        // jump (language reference 4.14), and a given slope may be met by a jump only: the other points are left.
        let inner = joints.get(1..joints.len().saturating_sub(2)).unwrap_or_default();
        let free = !arguments
            .iter()
            .any(|argument| matches!(argument, Argument::Modifier(Modifier::Slope | Modifier::Normal)));
        let worst =
            inner.iter().max_by(|a, b| (a.curvature_jump * a.chord).total_cmp(&(b.curvature_jump * b.chord)));
        if let Some(worst) =
            worst.filter(|joint| free && joint.curvature_jump * joint.chord > LEAST_CURVATURE_JUMP)
        {
            let (point, jump) = (worst.point, worst.curvature_jump);
            self.report(FindingKind::CurvatureJump { point, jump }, range);
        }
    }

    /// Warns of curves of a ruled surface that are not where their points are, each at its own parameters.
    fn report_ruled_faults(&mut self, surface: &RuledSurface, items: &[Item], range: TextRange) {
        for fault in definition::ruled_faults(surface) {
            let (RuledFault::NotMet { curve } | RuledFault::OffSurface { curve, .. }) = fault;
            let of_curve = items.chunks(CURVE_PARAMETERS).nth(curve.saturating_sub(1)).unwrap_or_default();
            let place = of_curve.first().zip(of_curve.last());
            let place = place.map_or(range, |(first, last)| first.range.cover(last.range));
            self.report(FindingKind::RuledCurve { fault }, place);
        }
    }

    /// APT4 wants all numbers after CANON; nothing if one is skipped.
    fn refuse_skipped(&mut self, kind: GeometryKind, items: &[Item], range: TextRange) -> Option<()> {
        let given = items.iter().filter(|item| item.scalar().is_some()).count();
        let skipped = items.iter().filter(|item| matches!(item.operand, Operand::Empty)).count();
        if skipped == 0 {
            return Some(());
        }
        let error = DefinitionError::CanonicalCount { expected: given + skipped, found: given };
        self.report(FindingKind::Definition { kind, error }, range);
        None
    }

    /// Operands as arguments of a definition.
    fn definition_arguments(
        &mut self,
        kind: GeometryKind,
        items: &[Item],
    ) -> Option<Vec<definition::Argument>> {
        let mut arguments = Vec::with_capacity(items.len());
        for item in items {
            arguments.push(match &item.operand {
                Operand::Scalar(value) => definition::Argument::Scalar(*value),
                Operand::Geometry { geometry, .. } => definition::Argument::Geometry((**geometry).clone()),
                Operand::Empty => definition::Argument::Empty,
                Operand::Word(word) => match Modifier::from_word(word.spelling) {
                    Some(modifier) => definition::Argument::Modifier(modifier),
                    None => {
                        return self.unknown_modifier(kind, SmolStr::new_static(word.spelling), item.range);
                    }
                },
                Operand::Text(text) => return self.unknown_modifier(kind, text.clone(), item.range),
            });
        }
        Some(arguments)
    }

    /// Reports a word that no definition knows.
    fn unknown_modifier<T>(&mut self, kind: GeometryKind, word: SmolStr, range: TextRange) -> Option<T> {
        self.report(FindingKind::DefinitionWord { kind, word }, range);
        None
    }

    /// Gives a name geometry, or poisons it when there is none; `canon` allows a redefinition.
    pub(super) fn define_stored(&mut self, target: &Reference, stored: Option<Stored>, canon: bool) {
        let Some(target) = self.target(target) else { return };
        let canon = canon || self.state.canon;
        if let Some(index) = target.index {
            if self.may_redefine_element(&target, index, stored.as_ref(), canon) {
                let element = stored.map_or(ArrayElement::Poisoned, ArrayElement::Geometry);
                self.assign_element(&target, index, element);
            }
            return;
        }
        let name = target.reference.name.text.clone();
        let range = target.reference.range;
        let existing = self.look_up(&name).cloned();
        if let Some(symbol) = &existing
            && !self.may_redefine(&name, symbol, stored.as_ref(), canon, range)
        {
            return;
        }
        let origin = self.origin(range);
        match stored {
            Some(stored) => {
                self.log(name.clone(), None, Value::Geometry(Arc::clone(&stored.geometry)), &origin);
                self.list_definition(&name, None, &stored, range);
                self.set_symbol(name, Meaning::Geometry(stored), origin);
            }
            None if existing.is_none() => self.set_symbol(name, Meaning::Poisoned, origin),
            None => {}
        }
    }

    /// Whether this name may get this geometry; if not, it has been reported.
    fn may_redefine(
        &mut self,
        name: &SmolStr,
        symbol: &Symbol,
        stored: Option<&Stored>,
        canon: bool,
        range: TextRange,
    ) -> bool {
        let finding = match &symbol.meaning {
            Meaning::Poisoned => return true,
            Meaning::Geometry(old) => {
                let old = old.geometry.kind();
                match stored.map(|stored| stored.geometry.kind()) {
                    None => return true,
                    Some(new) if new == old && canon => return true,
                    Some(new) if canon => FindingKind::RedefinedAsOtherKind { name: name.clone(), old, new },
                    Some(_) => FindingKind::Redefined { name: name.clone(), kind: old },
                }
            }
            Meaning::Scalar(_) => FindingKind::ScalarToGeometry { name: name.clone() },
            Meaning::Array(array) => {
                FindingKind::SubscriptMissing { name: name.clone(), extent: array.extent }
            }
            other => FindingKind::NotAssignable { name: name.clone(), found: other.found() },
        };
        let related = vec![(RelatedKind::Definition, symbol.origin.clone())];
        let warns_only = self.is_apt4() && matches!(finding, FindingKind::Redefined { .. });
        // APT4 looks at the order of the text: a statement that a loop executes again is no redefinition.
        if !warns_only || symbol.origin.isn < self.here.isn {
            self.report_related(finding, range, related);
        }
        warns_only
    }

    /// The same for an element of an array.
    fn may_redefine_element(
        &mut self,
        target: &Target<'_>,
        index: u32,
        stored: Option<&Stored>,
        canon: bool,
    ) -> bool {
        let key = self.array_key(&target.reference.name.text);
        let Some(symbol) = self.look_up(&key).cloned() else { return false };
        let Meaning::Array(array) = &symbol.meaning else { return false };
        let Some(ArrayElement::Geometry(old)) = array.get(index) else { return true };
        let name = smol_str::format_smolstr!("{}({index})", target.reference.name.text);
        let element = Symbol { meaning: Meaning::Geometry(old.clone()), origin: symbol.origin.clone() };
        self.may_redefine(&name, &element, stored, canon, target.reference.range)
    }

    /// Defines an element of an array, unless it holds the other sort.
    fn assign_element(&mut self, target: &Target<'_>, index: u32, element: ArrayElement) {
        let name = &target.reference.name.text;
        let key = self.array_key(name);
        let Some(symbol) = self.look_up(&key) else { return };
        let Meaning::Array(array) = &symbol.meaning else { return };
        let reserved = symbol.origin.clone();
        let is_geometry = matches!(element, ArrayElement::Geometry(_));
        let clash = array.holds_geometry.is_some_and(|holds| holds != is_geometry)
            && !matches!(element, ArrayElement::Poisoned);
        if clash {
            let finding = FindingKind::MixedArray { name: name.clone(), holds_geometry: !is_geometry };
            let related = vec![(RelatedKind::Reservation, reserved)];
            self.report_related(finding, target.reference.range, related);
            return;
        }
        let mut array = array.clone();
        if let ArrayElement::Geometry(stored) = &element {
            self.list_definition(name, Some(index), stored, target.reference.range);
        }
        let origin = self.origin(target.reference.range);
        let value = match &element {
            ArrayElement::Scalar(number) => Some(Value::Scalar(*number)),
            ArrayElement::Geometry(stored) => Some(Value::Geometry(Arc::clone(&stored.geometry))),
            ArrayElement::Poisoned => None,
        };
        if let Some(value) = value {
            self.log(name.clone(), Some(index), value, &origin);
        }
        array.set(index, element);
        self.set_symbol(key, Meaning::Array(array), reserved);
    }

    /// A target with its subscript evaluated and checked.
    fn target<'b>(&mut self, reference: &'b Reference) -> Option<Target<'b>> {
        let index = match &reference.subscript {
            None => None,
            Some(subscript) => {
                let number = self.scalar(subscript);
                let was_used = self.output.used.contains(&reference.name.text);
                let index = self.element_index(reference, number?)?;
                if !was_used {
                    self.output.used.remove(&reference.name.text);
                }
                Some(index)
            }
        };
        self.claim_word(&reference.name);
        Some(Target { reference, index })
    }

    /// A vocabulary word that is assigned to becomes a name from here on, where the dialect says so.
    fn claim_word(&mut self, name: &Name) {
        if !self.dialect.words_as_names || self.state.synonyms.contains_key(&name.text) {
            return;
        }
        if apt_syntax::vocabulary::lookup(&name.text).is_some() {
            self.report(FindingKind::WordBecomesName { name: name.text.clone() }, name.range);
            self.state.synonyms.insert(name.text.clone(), Synonym::Name);
        }
    }

    /// Sets the meaning of a name.
    pub(crate) fn set_symbol(&mut self, name: SmolStr, meaning: Meaning, origin: Origin) {
        if !self.output.touched.contains(&name) {
            self.output.touched.insert(name.clone());
        }
        self.state.symbols.insert(name, Arc::new(Symbol { meaning, origin }));
    }

    /// Writes a definition to the log.
    fn log(&mut self, name: SmolStr, subscript: Option<u32>, value: Value, origin: &Origin) {
        self.output.definitions.push(DefinitionEvent { name, subscript, value, origin: origin.clone() });
    }

    /// What a name is, as evidence.
    pub(crate) fn found_name(&self, name: &str) -> Found {
        self.look_up(name).map_or(Found::Nothing, |symbol| symbol.meaning.found())
    }
}

/// Whether CANON stands among the parameters, which allows a redefinition.
fn has_canon(definition: &Definition) -> bool {
    use apt_syntax::statement::Argument;
    definition
        .arguments
        .iter()
        .any(|argument| matches!(argument, Argument::Word(word) if word.word.spelling == "CANON"))
}

/// Whether these are the arguments of a LINE by two points: four numbers, or two points.
fn is_line_by_two_points(arguments: &[definition::Argument]) -> bool {
    use definition::Argument as Given;
    matches!(
        arguments,
        [Given::Scalar(_), Given::Scalar(_), Given::Scalar(_), Given::Scalar(_)]
            | [Given::Geometry(Geometry::Point(_)), Given::Geometry(Geometry::Point(_))]
    )
}

//! CALL: binds the variables and executes the body.

use std::sync::Arc;

use apt_syntax::{
    TextRange,
    statement::{Element, ElementKind, MacroParameter, Name, WordUse},
};
use smol_str::SmolStr;

use super::MacroDefinition;
use crate::{
    blocks::{Activation, Bindings},
    evaluator::{Evaluator, Flow, Region},
    finding::{ControlFinding, FindingKind, RelatedKind},
    record::FrameKind,
    symbols::{Meaning, similar_names},
};

impl Evaluator<'_> {
    /// CALL of a macro, or of an installation routine.
    pub(crate) fn call(
        &mut self,
        name: &Name,
        arguments: &[MacroParameter],
        section: Option<&WordUse>,
        range: TextRange,
    ) -> Flow {
        if section.is_some() {
            self.report(
                FindingKind::Control(ControlFinding::RoutineNotAvailable { name: name.text.clone() }),
                name.range,
            );
            return Flow::Next;
        }
        self.mark_used(&name.text);
        let definition = match self.look_up(&name.text) {
            Some(symbol) => match &symbol.meaning {
                Meaning::Macro(definition) => Some((Arc::clone(definition), symbol.origin.clone())),
                Meaning::Poisoned => {
                    self.gap(range);
                    return Flow::Next;
                }
                _ => None,
            },
            None => None,
        };
        let Some((definition, origin)) = definition else {
            self.report_unknown_macro(name);
            self.gap(range);
            return Flow::Next;
        };
        if self.is_first_call_in_segment(&definition, &name.text) {
            let related = vec![(RelatedKind::Macro, origin)];
            self.report_related(
                FindingKind::Control(ControlFinding::SystemMacroInSegment { name: name.text.clone() }),
                name.range,
                related,
            );
            if definition.body.moves() {
                self.gap(range);
            }
            return Flow::Next;
        }
        let Some(bindings) = self.bind(&definition, name, arguments, &origin) else {
            if definition.body.moves() {
                self.gap(range);
            }
            return Flow::Next;
        };
        let limit = self.macro_depth();
        if self.here.depth >= limit {
            let related = vec![(RelatedKind::Macro, origin)];
            self.report_related(
                FindingKind::Control(ControlFinding::MacroDepth { name: name.text.clone(), limit }),
                range,
                related,
            );
            return Flow::Abort;
        }
        let frame = self.frame(FrameKind::Macro, name.text.clone(), range);
        self.run_block(&Activation { block: &definition.body, bindings, region: Region::Macro, frame })
    }

    /// Whether a macro of the library is called for the first time, and that in a segment of the library: there the library
    /// of the cards is being read already.
    fn is_first_call_in_segment(&mut self, definition: &MacroDefinition, name: &SmolStr) -> bool {
        let Some(library) = definition.body.source.as_ref().filter(|_| self.dialect.bounded_tables) else {
            return false;
        };
        if self.state.library_calls.contains(name) {
            return false;
        }
        let segment = self.here.source.as_ref().filter(|_| self.here.region == Region::Top);
        if segment.is_some_and(|segment| segment != library) {
            return true;
        }
        self.state.library_calls.insert(name.clone());
        false
    }

    /// Reports a CALL of something that is not a macro.
    fn report_unknown_macro(&mut self, name: &Name) {
        let related = self.definition_of(&name.text);
        self.output.looked_at_all = true;
        let macros = self
            .state
            .symbols
            .iter()
            .filter(|(_, symbol)| matches!(symbol.meaning, Meaning::Macro(_)))
            .map(|(name, _)| name.as_str());
        let similar = similar_names(&name.text, macros);
        self.report_related(
            FindingKind::Control(ControlFinding::UnknownMacro { name: name.text.clone(), similar }),
            name.range,
            related,
        );
    }

    /// The values of the variables; nothing if one is missing or unknown.
    fn bind(
        &mut self,
        definition: &MacroDefinition,
        name: &Name,
        arguments: &[MacroParameter],
        origin: &crate::record::Origin,
    ) -> Option<Bindings> {
        let mut bindings = Bindings::default();
        let mut sound = true;
        for argument in arguments {
            if !definition.variables.iter().any(|variable| variable.name == argument.name.text) {
                let known = definition.variables.iter().map(|variable| variable.name.clone()).collect();
                let finding = FindingKind::Control(ControlFinding::UnknownMacroVariable {
                    name: name.text.clone(),
                    parameter: argument.name.text.clone(),
                    known,
                });
                let related = vec![(RelatedKind::Macro, origin.clone())];
                self.report_related(finding, argument.name.range, related);
                sound = false;
                continue;
            }
            match &argument.value {
                Some(value) => {
                    self.mark_elements_used(value);
                    bindings.bind(argument.name.text.clone(), value.clone());
                }
                None => {
                    let parameter = argument.name.text.clone();
                    self.report(
                        FindingKind::Control(ControlFinding::MacroValueMissing { parameter }),
                        argument.range,
                    );
                    sound = false;
                }
            }
        }
        for variable in &definition.variables {
            if arguments.iter().any(|argument| argument.name.text == variable.name) {
                continue;
            }
            match &variable.default {
                Some(value) => {
                    self.mark_elements_used(value);
                    bindings.bind(variable.name.clone(), value.clone());
                }
                None => {
                    let finding = FindingKind::Control(ControlFinding::MacroVariableMissing {
                        name: name.text.clone(),
                        parameter: variable.name.clone(),
                    });
                    self.report_related(finding, name.range, vec![(RelatedKind::Macro, origin.clone())]);
                    sound = false;
                }
            }
        }
        sound.then_some(bindings)
    }

    /// Names handed to a macro count as used: the body decides what becomes of them.
    fn mark_elements_used(&mut self, value: &[Element]) {
        for element in value.iter().filter(|element| element.kind == ElementKind::Name) {
            self.mark_used(&element.text);
            let key: SmolStr = self.array_key(&element.text);
            self.mark_used(&key);
        }
    }
}

//! The macro header: variables, defaults, the name.

use apt_syntax::statement::{MacroParameter, Name};

use super::{MacroDefinition, MacroVariable};
use crate::{
    blocks::Block,
    evaluator::Evaluator,
    finding::{ControlFinding, FindingKind},
    symbols::Meaning,
};

/// Most macro variables where tables are bounded (language reference 1.10).
const MOST_VARIABLES: usize = 50;

impl Evaluator<'_> {
    /// Defines a macro with this body. The statement being executed is its header.
    pub(crate) fn define_macro(&mut self, name: &Name, parameters: &[MacroParameter], body: Block) {
        if self.dialect.bounded_tables && parameters.len() > MOST_VARIABLES {
            let finding = FindingKind::Control(ControlFinding::MacroVariableCount {
                found: parameters.len(),
                limit: MOST_VARIABLES,
            });
            self.report(finding, name.range);
        }
        let mut variables: Vec<MacroVariable> = Vec::with_capacity(parameters.len());
        for parameter in parameters {
            let text = parameter.name.text.clone();
            if variables.iter().any(|other| other.name == text) {
                self.report(
                    FindingKind::Control(ControlFinding::MacroVariableTwice { name: text.clone() }),
                    parameter.name.range,
                );
            }
            variables.push(MacroVariable { name: text, default: parameter.value.clone() });
        }
        self.report_body_mistakes(&body, &variables);
        if self.look_up(&name.text).is_some() {
            let related = self.definition_of(&name.text);
            let finding = FindingKind::Control(ControlFinding::MacroNameUsed { name: name.text.clone() });
            return self.report_related(finding, name.range, related);
        }
        let origin = self.origin(name.range);
        let meaning = Meaning::Macro(std::sync::Arc::new(MacroDefinition { variables, body }));
        self.set_symbol(name.text.clone(), meaning, origin);
    }

    /// Syntax errors and misplaced statements of the body that no variable or synonym can mend are reported at once,
    /// called or not.
    fn report_body_mistakes(&mut self, body: &Block, variables: &[MacroVariable]) {
        let header = self.here.isn;
        for (index, statement) in body.statements.iter().enumerate() {
            let may_change = statement.elements.iter().any(|element| {
                self.state.synonyms.contains_key(&element.text)
                    || variables.iter().any(|variable| variable.name == element.text)
            });
            if may_change {
                continue;
            }
            self.here.isn = body.isn(index);
            for error in &statement.errors {
                self.report(FindingKind::Syntax(error.kind.clone()), error.range);
            }
            for part in &statement.statement.parts {
                self.refuse_in_macro(part);
            }
        }
        self.here.isn = header;
    }
}

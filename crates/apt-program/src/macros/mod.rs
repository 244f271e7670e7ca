//! MACRO, TERMAC and CALL (language reference 7.2).

mod call;
mod define;

use apt_syntax::statement::Element;
use smol_str::SmolStr;

use crate::blocks::Block;

/// A macro variable with its default.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MacroVariable {
    /// The name.
    pub(crate) name: SmolStr,
    /// The default, as elements.
    pub(crate) default: Option<Vec<Element>>,
}

/// A macro: its text, unparsed in effect, since variables are replaced by token.
#[derive(Debug, Clone)]
pub(crate) struct MacroDefinition {
    /// Its variables.
    pub(crate) variables: Vec<MacroVariable>,
    /// Its body up to and with TERMAC.
    pub(crate) body: Block,
}

impl MacroDefinition {
    /// Whether both have the same text at the same place.
    pub(crate) fn same_text(&self, other: &MacroDefinition) -> bool {
        self.variables == other.variables
            && self.body.first_isn == other.body.first_isn
            && self.body.source == other.body.source
            && self.body.hashes == other.body.hashes
    }
}

//! Signature help: the forms of the word whose parameters the cursor is in, and which of them is being typed.

use std::ops::Range;

use apt_program::symbols::Value;
use apt_syntax::{
    statement::{Body, Element, ElementKind},
    vocabulary::Word,
};

use crate::{
    Analysis,
    context::{Context, Opener, typed_parameter},
    forms::{Atom, Form, Typed, ValueKind, forms_of},
};

/// One form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    /// The form: `GOTO/x,y[,z]`.
    pub label: String,
    /// Its parameters: bytes of the label.
    pub parameters: Vec<Range<usize>>,
    /// What the word or macro does, Markdown.
    pub documentation: String,
}

/// The forms at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SignatureHelp {
    /// All of them.
    pub signatures: Vec<Signature>,
    /// The one that what is typed fits best.
    pub active: usize,
    /// The parameter of it that is being typed, if the form has one there.
    pub parameter: Option<usize>,
}

impl Analysis {
    /// The forms of the statement, definition, function or macro whose parameters an offset is in. Types of names are
    /// those of the last evaluation, so that typing never waits for one.
    pub fn signature_help(&self, offset: usize) -> Option<SignatureHelp> {
        let (view, relative) = self.statement_at(offset)?;
        let parsed = view.parsed();
        let commented = |range: &apt_syntax::TextRange| range.start() < relative && relative <= range.end();
        if parsed.comments.iter().any(commented) {
            return None;
        }
        let before: Vec<&Element> =
            parsed.elements.iter().filter(|element| element.range.start() < relative).collect();
        if before.last().is_some_and(|element| element.kind == ElementKind::Text) {
            return None;
        }
        let context = Context::innermost(&before)?;
        match context.opener {
            Opener::Word(word) => self.word_signatures(word, &context),
            Opener::Call(name) => self.macro_signature(name, &context),
        }
    }

    /// What is known of a name's value without any work.
    pub(crate) fn value_kind(&self, name: &str) -> ValueKind {
        let Some(program) = self.known_program() else { return ValueKind::Unknown };
        match program.definitions().filter(|event| event.name == name).last().map(|event| &event.value) {
            Some(Value::Geometry(geometry)) => ValueKind::Geometry(geometry.kind()),
            Some(Value::Scalar(_)) => ValueKind::Scalar,
            None => ValueKind::Unknown,
        }
    }

    fn word_signatures(&self, word: &'static Word, context: &Context<'_>) -> Option<SignatureHelp> {
        let dialect = self.document().dialect();
        let forms: Vec<&Form> = forms_of(word).iter().filter(|form| form.is_of(dialect)).collect();
        let kind_of = |name: &str| self.value_kind(name);
        let typed = context.typed(&kind_of);
        let begun = typed_parameter(context.begun(), &kind_of);
        let prefix = match context.begun() {
            [one] if matches!(one.kind, ElementKind::Name | ElementKind::Word) => one.text.as_str(),
            _ => "",
        };
        let fit = |form: &Form| {
            let matched = form.matched(&typed);
            let going = matched.next.iter().map(|&index| form.likeness(index, begun, prefix)).max();
            let going = going.unwrap_or_default();
            let goes_on = matched.all && (begun.is_none() || going > 0 || matched.more);
            (goes_on, matched.fits - matched.dotted, going)
        };
        // Of forms that fit equally well the first is the most usual one.
        let active = (0..forms.len()).max_by_key(|&index| (fit(forms[index]), std::cmp::Reverse(index)))?;
        let form = forms.get(active)?;
        let matched = form.matched(&typed);
        let likeness = |index: &usize| form.likeness(*index, begun, prefix);
        let parameter = matched.next.iter().copied().rev().max_by_key(likeness).filter(|_| matched.all);
        let signature = |form: &&Form| Signature {
            label: form.text.to_owned(),
            parameters: form.parameters.iter().map(|parameter| parameter.range.clone()).collect(),
            documentation: word.help.to_owned(),
        };
        Some(SignatureHelp { signatures: forms.iter().map(signature).collect(), active, parameter })
    }

    fn macro_signature(&self, name: &str, context: &Context<'_>) -> Option<SignatureHelp> {
        let variables = self.macro_variables(name)?;
        let mut label = format!("CALL/{name}");
        let mut parameters = Vec::new();
        for (variable, default) in &variables {
            label.push(',');
            let start = label.len();
            label.push_str(variable);
            if let Some(default) = default {
                label.push('=');
                label.push_str(default);
            }
            parameters.push(start..label.len());
        }
        let named = |parameter: &&[&Element]| parameter.first().map(|element| element.text.clone());
        let position = |wanted: &str| variables.iter().position(|(name, _)| name == wanted);
        let begun = context.begun();
        let at_name = begun.get(1).is_some_and(|element| element.kind == ElementKind::Equals);
        let being_typed = begun.first().filter(|_| at_name).and_then(|element| position(&element.text));
        let prefix = begun.first().map_or("", |element| element.text.as_str());
        let given: Vec<_> = context.parameters.iter().rev().skip(1).filter_map(named).collect();
        let open = |(name, _): &(String, Option<String>)| {
            name.starts_with(prefix) && !given.iter().any(|given| given == name)
        };
        let parameter = being_typed.or_else(|| variables.iter().position(open));
        let needed = variables.iter().filter(|(_, default)| default.is_none()).count();
        let documentation =
            format!("macro `{name}`; {needed} of {} variables must be given", variables.len());
        let signature = Signature { label, parameters, documentation };
        Some(SignatureHelp { signatures: vec![signature], active: 0, parameter })
    }

    /// The variables of a macro with their defaults as written.
    pub(crate) fn macro_variables(&self, name: &str) -> Option<Vec<(String, Option<String>)>> {
        let file = self.files().iter().find(|file| file.regions.iter().any(|region| region.name == name))?;
        let region = file.regions.iter().rfind(|region| region.name == name)?;
        let view = file.tree.statement(region.first);
        let parsed = view.parsed();
        let header = parsed.statement.parts.iter().find_map(|part| match &part.body {
            Body::Macro { parameters, .. } => Some(parameters),
            _ => None,
        })?;
        let spelled = |elements: &[Element]| elements.iter().map(|element| element.text.as_str()).collect();
        let variable = |parameter: &apt_syntax::statement::MacroParameter| {
            (parameter.name.text.to_string(), parameter.value.as_deref().map(spelled))
        };
        Some(header.iter().map(variable).collect())
    }
}

impl Form {
    /// How well what is begun can be the parameter with this index: 0 not at all, 1 as a value or a whole word, 2 as the
    /// beginning of a word.
    fn likeness(&self, index: usize, begun: Option<Typed<'_>>, prefix: &str) -> u8 {
        let Some(parameter) = self.parameters.get(index) else { return 0 };
        match (begun, parameter.atom) {
            (None, _) => 1,
            (Some(Typed::Word(_)), atom) => u8::from(begun.is_some_and(|typed| atom.takes(typed))),
            (Some(typed), Atom::Word(word)) => {
                let unknown = typed == Typed::Value(ValueKind::Unknown);
                if unknown && !prefix.is_empty() && word.starts_with(prefix) { 2 } else { 0 }
            }
            (Some(typed), atom) => u8::from(atom.takes(typed)),
        }
    }
}

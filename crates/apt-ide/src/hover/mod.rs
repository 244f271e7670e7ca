//! Hovers: a word's help, a name's value with the meaning of each number, a motion's result.

mod canonical;
mod expanded;
mod label;
mod motion;
mod regional;
mod valueless;

use std::ops::Range;

use apt_geometry::patience::Waiting;
use apt_program::symbols::{DefinitionEvent, Value};
use apt_run::go_on;
use apt_syntax::{
    ParsedStatement, TextSize,
    statement::{Body, Element, ElementKind},
    vocabulary::{Word, WordClass, lookup},
};

pub use canonical::{CanonicalForm, number};

use crate::{
    Analysis, Cancel, Cancelled, absolute,
    context::{Context, Opener},
    forms::{Form, Typed, forms_of},
    navigation::{Spot, statement_at},
};

/// A hover.
#[derive(Debug, Clone, PartialEq)]
pub struct Hover {
    /// What it is about, bytes of the text.
    pub range: Range<usize>,
    /// The text, Markdown.
    pub markdown: String,
}

impl Analysis {
    /// What is to be said about the place at an offset.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the answer was found.
    pub fn hover(&self, offset: usize, cancel: Cancel<'_>) -> Result<Option<Hover>, Cancelled> {
        self.hover_at(Spot { file: None, offset }, cancel)
    }

    /// What is to be said about a place in one of the files of the program; the range is one of that file.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the answer was found.
    pub fn hover_at(&self, spot: Spot<'_>, cancel: Cancel<'_>) -> Result<Option<Hover>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let files = self.with_files(waiting.patience())?;
        let Some(file) = files.iter().find(|file| file.is(spot.file)) else { return Ok(None) };
        let Some((view, relative)) = statement_at(&file.tree, spot.offset) else { return Ok(None) };
        let parsed = view.parsed();
        let Some(element) = element_at(&parsed.elements, relative) else { return Ok(None) };
        let range = absolute(&view, element.range);
        let markdown = match element.kind {
            ElementKind::Word => match lookup(&element.text) {
                Some(word) if matches!(word.class, WordClass::Motion) => {
                    let result = self.motion_markdown(view.isn(), spot.file, cancel)?;
                    let conditions = self.conditions_markdown(view.isn(), spot.file, cancel)?;
                    format!("{result}{conditions}{}", word_markdown(word))
                }
                Some(word) if word.class == WordClass::Minor => {
                    let before: Vec<&Element> = parsed
                        .elements
                        .iter()
                        .filter(|one| one.range.end() <= element.range.start())
                        .collect();
                    let here = self.modifier_markdown(word, &before);
                    format!("{}{here}{}", word_markdown(word), self.steps_markdown(word, &before))
                }
                Some(word) if matches!(word.spelling, "CALL" | "LOOPST") && spot.file.is_none() => {
                    format!("{}{}", word_markdown(word), self.expansion_markdown(spot.offset, cancel)?)
                }
                Some(word) => word_markdown(word),
                None => return Ok(None),
            },
            ElementKind::Number if self.name_at_spot(spot).is_some_and(|at| at.label) => {
                match self.name_markdown(spot, view.isn(), cancel)? {
                    Some(markdown) => markdown,
                    None => return Ok(None),
                }
            }
            // What is spelt like a name and is none, as the unit after UNITS.
            ElementKind::Name if self.name_at_spot(spot).is_none() => match lookup(&element.text) {
                Some(word) => word_markdown(word),
                None => return Ok(None),
            },
            ElementKind::Name => match self.name_markdown(spot, view.isn(), cancel)? {
                Some(markdown) if spot.file.is_none() && is_called(&parsed, element) => {
                    markdown + &self.expansion_markdown(spot.offset, cancel)?
                }
                Some(markdown) => markdown,
                None => return Ok(None),
            },
            _ => return Ok(None),
        };
        Ok(Some(Hover { range, markdown }))
    }

    /// What a modifier is a part of: the forms that go on with it behind `before`.
    fn modifier_markdown(&self, word: &'static Word, before: &[&Element]) -> String {
        let Some(context) = Context::innermost(before) else { return String::new() };
        let Opener::Word(opener) = context.opener else { return String::new() };
        let typed = context.typed(&|name: &str| self.value_kind(name));
        let fits = |form: &&Form| {
            let matched = form.matched(&typed);
            let goes_on = |index: &usize| {
                form.parameters.get(*index).is_some_and(|one| one.atom.takes(Typed::Word(word.spelling)))
            };
            matched.all && matched.next.iter().any(goes_on)
        };
        let forms: Vec<&str> = forms_of(opener).iter().filter(fits).map(|form| form.text).collect();
        if forms.is_empty() {
            return String::new();
        }
        format!("\n\nhere in {}:\n```apt\n{}\n```", opener.spelling, forms.join("\n"))
    }

    /// What a drill does between its steps by this type of CYCLE: two systems mean the opposite by the same words.
    fn steps_markdown(&self, word: &Word, before: &[&Element]) -> &'static str {
        if !before.iter().any(|element| element.text == "CYCLE") {
            return "";
        }
        let breaks_chips = match word.spelling {
            "BRKCHP" => true,
            "DEEP" => self.deep_breaks_chips(),
            "THRU" => false,
            _ => return "",
        };
        match breaks_chips {
            true => "\n\nIn this file it breaks chips: the drill is lifted a little between its steps.",
            false => "\n\nIn this file it withdraws the drill from the hole between its steps.",
        }
    }

    /// The canonical form of the name at an offset.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the answer was found.
    pub fn canonical_form(
        &self,
        offset: usize,
        cancel: Cancel<'_>,
    ) -> Result<Option<CanonicalForm>, Cancelled> {
        let Some((view, _)) = self.statement_at(offset) else { return Ok(None) };
        let Some(at) = self.name_at(offset) else { return Ok(None) };
        let subscript = self.subscript_at(Spot { file: None, offset }, view.isn(), cancel)?;
        Ok(self
            .value_at(&at.name, subscript, view.isn(), cancel)?
            .map(|(name, value)| CanonicalForm::new(&name, &value)))
    }

    /// The subscript behind the name at a place, if it is a number or a name with a value.
    fn subscript_at(&self, spot: Spot<'_>, isn: u32, cancel: Cancel<'_>) -> Result<Option<u32>, Cancelled> {
        let file = self.files().iter().find(|file| file.is(spot.file));
        let Some((view, relative)) = file.and_then(|file| statement_at(&file.tree, spot.offset)) else {
            return Ok(None);
        };
        let parsed = view.parsed();
        let inside = |element: &Element| element.range.contains_inclusive(relative);
        let at = parsed.elements.iter().position(|one| one.kind == ElementKind::Name && inside(one));
        let Some([_, open, index, close]) = at.and_then(|at| parsed.elements.get(at..at + 4)) else {
            return Ok(None);
        };
        if open.kind != ElementKind::LeftParenthesis || close.kind != ElementKind::RightParenthesis {
            return Ok(None);
        }
        let value = match index.kind {
            ElementKind::Number => index.text.parse().ok(),
            ElementKind::Name => match self.value_at(&index.text, None, isn, cancel)? {
                Some((_, Value::Scalar(value))) => Some(value),
                _ => None,
            },
            _ => None,
        };
        Ok(value.filter(|value| (1.0..=f64::from(u32::MAX)).contains(value)).map(|value: f64| value as u32))
    }

    /// The value of a name, or of the element of an array with a subscript, at a statement: the last one given up to it,
    /// else the first one given after it.
    fn value_at(
        &self,
        name: &str,
        subscript: Option<u32>,
        isn: u32,
        cancel: Cancel<'_>,
    ) -> Result<Option<(String, Value)>, Cancelled> {
        let program = self.program(cancel)?;
        let mut found = None;
        let wanted = |event: &&DefinitionEvent| {
            event.name == name && (subscript.is_none() || event.subscript == subscript)
        };
        let waiting = Waiting::until(cancel);
        for event in program.definitions() {
            go_on(waiting.patience(), 1)?;
            if !wanted(&event) {
                continue;
            }
            // What an included file defines, the statement that includes it does.
            if event.origin.place_in_program().0 > isn && found.is_some() {
                break;
            }
            let title = match event.subscript {
                Some(subscript) => format!("{name}({subscript})"),
                None => name.to_owned(),
            };
            found = Some((title, event.value.clone()));
        }
        Ok(found)
    }

    fn name_markdown(
        &self,
        spot: Spot<'_>,
        isn: u32,
        cancel: Cancel<'_>,
    ) -> Result<Option<String>, Cancelled> {
        let Some(at) = self.name_at_spot(spot) else { return Ok(None) };
        // In an included file every value counts that the program gives.
        let until = if spot.file.is_none() { isn } else { u32::MAX };
        let subscript = self.subscript_at(spot, until, cancel)?;
        if at.label {
            return Ok(Some(self.label_markdown(spot, &at, cancel)?));
        }
        if at.scope.statements.is_none()
            && let Some((name, value)) = self.value_at(&at.name, subscript, until, cancel)?
        {
            let mut markdown = CanonicalForm::new(&name, &value).markdown();
            if spot.file.is_none() {
                markdown.push_str(&self.turns_markdown(&at.name, isn, cancel)?);
            }
            return Ok(Some(markdown));
        }
        for file in self.files() {
            let Some(region) = file.regions.iter().find(|region| region.name == at.name) else { continue };
            let count = region.last.saturating_sub(region.first + 1);
            let header = format!("{}=MACRO/{}", region.name, region.variables.join(","));
            let plural = if count == 1 { "" } else { "s" };
            let from = file.source.as_ref().map(|source| format!(" of `{}`", source.path.display()));
            let from = from.unwrap_or_default();
            return Ok(Some(format!("```apt\n{header}\n```\nmacro of {count} statement{plural}{from}")));
        }
        let regions = self.files().get(at.scope.file).map_or(&[][..], |file| &file.regions);
        let local = regions.iter().rfind(|region| {
            region.variables.contains(&at.name) && at.scope.statements == Some((region.first, region.last))
        });
        match local {
            Some(region) => Ok(Some(format!(
                "variable `{}` of macro `{}`{}",
                at.name,
                region.name,
                self.calls_markdown(region, &at.name, cancel)?
            ))),
            None => self.valueless_markdown(spot, &at, cancel),
        }
    }

    /// How a name changed, if its statement was executed several times in a loop or in calls of a macro.
    fn turns_markdown(&self, name: &str, isn: u32, cancel: Cancel<'_>) -> Result<String, Cancelled> {
        let program = self.program(cancel)?;
        let waiting = Waiting::until(cancel);
        let (mut count, mut first) = (0_usize, None);
        for event in program.definitions() {
            go_on(waiting.patience(), 1)?;
            if event.name == name && event.origin.isn == isn && event.origin.source.is_none() {
                count += 1;
                first = first.or(Some(event));
            }
        }
        Ok(match first {
            Some(first) if count > 1 => {
                let form = CanonicalForm::new(name, &first.value);
                format!("\n\nthe last of {count} times; the first: {}", form.text)
            }
            _ => String::new(),
        })
    }

    /// What the calls of a macro give to a variable, in the order of the text.
    fn calls_markdown(
        &self,
        region: &crate::regions::Region,
        variable: &str,
        cancel: Cancel<'_>,
    ) -> Result<String, Cancelled> {
        /// More of them would not be read.
        const GREATEST_CALLS: usize = 8;
        let tree = self.document().tree();
        let mut text = String::new();
        let mut calls = 0;
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        for index in crate::search::statements_with(tree, &region.name, patience)? {
            go_on(patience, 1)?;
            let view = tree.statement(index);
            for part in &view.parsed().statement.parts {
                let Body::Call { name, arguments, .. } = &part.body else { continue };
                if name.text != region.name {
                    continue;
                }
                calls += 1;
                let given = arguments.iter().find(|argument| argument.name.text == variable);
                let value = given.and_then(|argument| {
                    let range = usize::from(argument.name.range.end())..usize::from(part.range.end());
                    let rest = view.text().get(range)?.trim_start().strip_prefix('=')?;
                    Some(first_argument(rest).to_owned())
                });
                if calls <= GREATEST_CALLS {
                    let value = value.as_deref().unwrap_or("(default)");
                    text.push_str(&format!("\n- `{value}` at statement {}", view.isn()));
                }
            }
        }
        Ok(match calls {
            0 => ", which is never called".to_owned(),
            _ if calls > GREATEST_CALLS => format!(":\n{text}\n- … {} more calls", calls - GREATEST_CALLS),
            _ => format!(":\n{text}"),
        })
    }
}

/// The element at an offset; at the border of two the one that begins there, unless it is punctuation.
pub(crate) fn element_at(elements: &[Element], offset: TextSize) -> Option<&Element> {
    let speaks = |element: &&Element| {
        matches!(element.kind, ElementKind::Word | ElementKind::Name | ElementKind::Number)
    };
    let inside = elements.iter().find(|element| element.range.contains(offset)).filter(speaks);
    inside.or_else(|| elements.iter().filter(speaks).find(|element| element.range.contains_inclusive(offset)))
}

/// Whether a name is that of the macro which its statement calls.
fn is_called(parsed: &ParsedStatement, element: &Element) -> bool {
    let calls = |body: &Body| matches!(body, Body::Call { name, .. } if name.range == element.range);
    parsed.statement.parts.iter().any(|part| calls(&part.body))
}

/// A word's page: forms and help.
pub fn word_markdown(word: &Word) -> String {
    let mut text = String::new();
    if !word.forms.is_empty() {
        text.push_str(&format!("```apt\n{}\n```\n", word.forms.join("\n")));
    } else {
        text.push_str(&format!("**{}** ", word.spelling));
    }
    text.push_str(word.help);
    if let Some(code) = word.code {
        text.push_str(&format!("\n\n{} {code}", class_title(word.class)));
    }
    text
}

fn class_title(class: WordClass) -> &'static str {
    match class {
        WordClass::Text => "text word, code",
        WordClass::Motion => "motion, code",
        WordClass::ToolPosition => "tool position, code",
        WordClass::PathParameter => "path parameter, code",
        WordClass::PathControl => "path control, code",
        WordClass::Logic => "logic, code",
        WordClass::Declaration => "declaration, code",
        WordClass::Transformation => "transformation of the path, code",
        WordClass::InputOutput => "input and output, code",
        WordClass::SystemFlag => "system flag, code",
        WordClass::GeometricType => "geometric type, number",
        WordClass::Function => "function, code",
        WordClass::Postprocessor | WordClass::PostprocessorBare => "post-processor word, code",
        WordClass::Minor => "modifier, code",
    }
}

/// What stands before the next comma outside of parentheses.
fn first_argument(text: &str) -> &str {
    let mut depth = 0_i32;
    let end = text.find(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    });
    text[..end.unwrap_or(text.len())].trim()
}

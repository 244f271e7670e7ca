//! Words of the language that a name is spelled like which stands in the place of one.

use apt_program::{Finding, FindingKind, symbols::similar_names};
use apt_syntax::{
    SyntaxTree,
    dialect::Dialect,
    error::SyntaxErrorKind,
    statement::{Element, ElementKind},
    vocabulary::{self, Word, WordClass},
};
use smol_str::SmolStr;

use super::Here;

/// A name shorter than this resembles too many words of the language.
const SHORTEST_MISSPELT_WORD: usize = 4;

/// Words of the language that are spelled like a name which stands in the place of one; none for other errors.
pub(crate) fn words_like(dialect: Dialect, error: &SyntaxErrorKind) -> Vec<SmolStr> {
    let (name, begins) = match error {
        SyntaxErrorKind::NameWithoutEquals { name, .. } => (name, true),
        SyntaxErrorKind::ListWithoutWord { name, .. } => (name, false),
        _ => return Vec::new(),
    };
    if name.chars().count() < SHORTEST_MISSPELT_WORD {
        return Vec::new();
    }
    let fits = |class: WordClass| match begins {
        true => class.begins_statements(),
        false => class == WordClass::GeometricType,
    };
    let words = vocabulary::words().iter().filter(|word| fits(word.class) && word.is_in(dialect.name));
    similar_names(name, words.map(|word| word.spelling))
}

/// What an undefined name is spelled like, best first: words that fit its place, and defined names; none for other findings.
pub(crate) fn operands_like(tree: &SyntaxTree, finding: &Finding) -> Option<Vec<SmolStr>> {
    let FindingKind::Undefined { name, similar } = &finding.kind else { return None };
    Some(Here::of(tree, &finding.origin)?.words_or_names_like(name, similar))
}

/// Where a name stands that could be a misspelt word.
enum Place<'a> {
    /// Where a type of geometry would begin a definition.
    Type,
    /// Among the operands of a word.
    OperandOf(&'a str),
}

impl Here<'_> {
    /// Words that fit the place of the finding and defined names that are spelled like a name, best first.
    pub(super) fn words_or_names_like(&self, name: &str, names: &[SmolStr]) -> Vec<SmolStr> {
        if name.chars().count() < SHORTEST_MISSPELT_WORD {
            return names.to_vec();
        }
        let Some(place) = self.place(name) else { return names.to_vec() };
        let dialect = self.tree.dialect();
        let fits = |word: &&Word| {
            word.is_in(dialect.name)
                && match place {
                    Place::Type => word.class == WordClass::GeometricType,
                    Place::OperandOf(head) => word.used_in.contains(&head),
                }
        };
        let words = vocabulary::words().iter().filter(fits).map(|word| word.spelling);
        similar_names(name, words.chain(names.iter().map(SmolStr::as_str)))
    }

    /// The place of the finding, if a word could stand where the name does.
    fn place(&self, name: &str) -> Option<Place<'_>> {
        let elements = &self.parsed.elements;
        let here = self.origin.range;
        let at = elements.iter().position(|one| one.text == name && here.contains_range(one.range))?;
        let kind = |index: Option<usize>| index.and_then(|index| elements.get(index)).map(|one| one.kind);
        let is_operand = || {
            let before = kind(at.checked_sub(2));
            matches!(before, Some(ElementKind::Comma | ElementKind::Slash | ElementKind::LeftParenthesis))
        };
        match (kind(at.checked_sub(1)), kind(Some(at + 1))) {
            (Some(ElementKind::LeftParenthesis), Some(ElementKind::Slash)) if is_operand() => {
                Some(Place::Type)
            }
            (
                Some(ElementKind::Slash | ElementKind::Comma),
                Some(ElementKind::Comma | ElementKind::RightParenthesis) | None,
            ) => head_of_list(elements.get(..at)?).map(Place::OperandOf),
            _ => None,
        }
    }
}

/// The word in front of the slash that the list at the end of some elements follows.
fn head_of_list(before: &[Element]) -> Option<&str> {
    let mut closed = 0_usize;
    for (index, element) in before.iter().enumerate().rev() {
        match element.kind {
            ElementKind::RightParenthesis => closed += 1,
            ElementKind::LeftParenthesis => closed = closed.checked_sub(1)?,
            ElementKind::Slash if closed == 0 => {
                let head = before.get(index.checked_sub(1)?)?;
                return (head.kind == ElementKind::Word).then_some(&*head.text);
            }
            _ => {}
        }
    }
    None
}

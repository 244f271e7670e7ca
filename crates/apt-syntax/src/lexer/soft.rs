//! Words that are words only where they stand: `THEN`, `ELSE`, `ENDIF` and `DO` are names of APT III everywhere else, so
//! no program that uses them as names is refused.

use smol_str::SmolStr;

use super::Lexer;
use crate::dialect::Dialect;
use crate::error::SyntaxErrorKind;
use crate::statement::{Element, ElementKind};

/// The word behind the condition of an IF over several statements.
const THEN: &str = "THEN";

impl Lexer<'_> {
    /// Makes words of the names that stand where these words do, and tells of statements that run into one of them.
    pub(super) fn soft_words(&mut self) {
        let dialect = &self.layout.dialect;
        if !dialect.structured_if && !dialect.do_loops {
            return;
        }
        let elements = &self.lexed.elements;
        let first = if is_kind(elements, 1, ElementKind::RightParenthesis) { 2 } else { 0 };
        let word = soft_word(elements, first, dialect);
        let conditional = elements.get(first).is_some_and(|one| matches!(one.text.as_str(), "IF" | "ELSEIF"));
        let behind = behind_parenthesis(elements, first + 1).filter(|_| conditional);
        let ends_on_then = |behind: usize| {
            elements.get(behind).is_some_and(|one| one.text == THEN) && elements.len() == behind + 1
        };
        let then = behind.filter(|behind| ends_on_then(*behind));
        if let Some(word) = word {
            self.promote(first, word);
        }
        if !dialect.structured_if {
            return;
        }
        if let Some(then) = then {
            return self.promote(then, THEN);
        }
        match behind {
            Some(behind) => self.refuse_run_on(behind, &[THEN]),
            None => self.refuse_run_on(first, &["ELSE", "ENDIF"]),
        }
    }

    fn promote(&mut self, index: usize, word: &'static str) {
        if let Some(element) = self.lexed.elements.get_mut(index)
            && element.kind == ElementKind::Name
        {
            element.kind = ElementKind::Word;
            element.text = SmolStr::new_static(word);
        }
    }

    /// `THEN A=1` is the assignment `THENA=1`, since blanks mean nothing: nobody means that.
    fn refuse_run_on(&mut self, index: usize, words: &[&'static str]) {
        let Some(element) = self.lexed.elements.get(index).filter(|one| one.kind == ElementKind::Name) else {
            return;
        };
        let range = element.range;
        let Some(start) = self.characters.iter().position(|one| one.offset == u32::from(range.start()))
        else {
            return;
        };
        let length =
            self.characters.iter().skip(start).take_while(|one| one.end() <= range.end().into()).count();
        let pieces = self.pieces_of(start, start + length);
        let Some(word) = words.iter().find(|word| pieces.first().is_some_and(|piece| piece == *word)) else {
            return;
        };
        // The name may be too long as well: that is no news.
        self.lexed.errors.retain(|error| error.range != range);
        self.lexed.errors.push(crate::error::SyntaxError::new(
            SyntaxErrorKind::RunsOnAfterWord { word: SmolStr::new_static(word) },
            range,
        ));
        if let Some(element) = self.lexed.elements.get_mut(index) {
            element.kind = ElementKind::Bad;
        }
    }
}

/// The word that a name is at the start of a statement, if it is one there.
fn soft_word(elements: &[Element], first: usize, dialect: &Dialect) -> Option<&'static str> {
    let element = elements.get(first).filter(|one| one.kind == ElementKind::Name)?;
    let next = elements.get(first + 1).map(|next| next.kind);
    // A name begins a statement only before these.
    let may_be_name = match next {
        Some(ElementKind::Equals | ElementKind::RightParenthesis) => true,
        Some(ElementKind::LeftParenthesis) => {
            let behind = behind_parenthesis(elements, first + 1);
            element.text != "ELSEIF" || behind.is_some_and(|at| is_kind(elements, at, ElementKind::Equals))
        }
        _ => false,
    };
    let words: &[&str] = match (dialect.structured_if, dialect.do_loops) {
        (true, true) => &["THEN", "ELSE", "ELSEIF", "ENDIF", "DO", "CONTIN"],
        (true, false) => &["THEN", "ELSE", "ELSEIF", "ENDIF"],
        (false, _) => &["DO", "CONTIN"],
    };
    words.iter().find(|word| !may_be_name && element.text == **word).copied()
}

/// The element behind the parenthesis that opens at an index; the number of elements if it is never closed.
fn behind_parenthesis(elements: &[Element], open: usize) -> Option<usize> {
    if !is_kind(elements, open, ElementKind::LeftParenthesis) {
        return None;
    }
    let mut depth = 0_u32;
    for (index, element) in elements.iter().enumerate().skip(open) {
        match element.kind {
            ElementKind::LeftParenthesis => depth += 1,
            ElementKind::RightParenthesis if depth <= 1 => return Some(index + 1),
            ElementKind::RightParenthesis => depth -= 1,
            _ => {}
        }
    }
    Some(elements.len())
}

fn is_kind(elements: &[Element], index: usize, kind: ElementKind) -> bool {
    elements.get(index).is_some_and(|element| element.kind == kind)
}

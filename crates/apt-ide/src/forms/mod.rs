//! The forms of words as the vocabulary writes them, read so that what is typed can be laid beside them.
//!
//! `GOTO/x,y[,z]`: capitals stand for themselves, small letters for a value, brackets hold what can be left out, braces
//! and bars what is one of several, and dots what goes on in the same way.

mod matching;

use std::{ops::Range, sync::OnceLock};

use apt_geometry::canonical::GeometryKind;
use apt_syntax::{
    dialect::DialectName,
    vocabulary::{Word, lookup, words},
};
use rustc_hash::FxHashMap;

pub(crate) use matching::{Typed, ValueKind};

/// What stands for one parameter in a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Atom {
    /// A vocabulary word, which stands for itself.
    Word(&'static str),
    /// A name for a value: `x`, `point`, `ds`.
    Placeholder(&'static str),
    /// A number that stands for itself.
    Number(&'static str),
}

/// An atom with its place in the form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Parameter {
    /// What stands there.
    pub(crate) atom: Atom,
    /// Where: bytes of the form.
    pub(crate) range: Range<usize>,
}

/// One step of a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// The parameter with this index.
    Parameter(usize),
    /// A comma.
    Comma,
    /// It goes on here, or there.
    Split(usize, usize),
    /// It goes on there.
    Jump(usize),
    /// What came before goes on: anything, as often as one likes. The parameter is the one before the dots.
    More(Option<usize>),
}

/// A form of a word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Form {
    /// As the vocabulary has it.
    pub(crate) text: &'static str,
    /// Its parameters in order.
    pub(crate) parameters: Vec<Parameter>,
    steps: Vec<Step>,
}

/// The forms of a word that begin with it and a slash or parenthesis.
pub(crate) fn forms_of(word: &Word) -> &'static [Form] {
    static FORMS: OnceLock<FxHashMap<&'static str, Vec<Form>>> = OnceLock::new();
    let forms = FORMS.get_or_init(|| {
        let read = |word: &'static Word| -> Vec<Form> {
            word.forms.iter().filter_map(|text| Form::read(word.spelling, text)).collect()
        };
        words().iter().map(|word| (word.spelling, read(word))).collect()
    });
    forms.get(word.spelling).map_or(&[], Vec::as_slice)
}

impl Form {
    /// Reads a form; nothing if the word has no parameters in it, or it describes another word.
    fn read(word: &str, text: &'static str) -> Option<Self> {
        let text = text.split(';').next().unwrap_or(text).trim_end();
        let rest = text.strip_prefix(word)?;
        let open = rest.chars().next().filter(|first| matches!(first, '/' | '(' | ',' | '['))?;
        let start = word.len() + usize::from(open != '[');
        let end = if open == '(' { text.rfind(')')? } else { text.len() };
        let mut reader = Reader { text, at: start, end, parameters: Vec::new(), steps: Vec::new() };
        reader.alternatives(None);
        Some(Self { text, parameters: reader.parameters, steps: reader.steps })
    }

    /// Whether a dialect has the form: those of sculptured surfaces hold words that only APT4 has. CL files are not asked:
    /// their words take what other systems write.
    pub(crate) fn is_of(&self, dialect: DialectName) -> bool {
        let foreign = |parameter: &Parameter| match parameter.atom {
            Atom::Word(word) => lookup(word).is_some_and(|word| word.dialects == [DialectName::Apt4]),
            Atom::Placeholder(name) => matches!(name, "ssurf" | "scurv"),
            Atom::Number(_) => false,
        };
        matches!(dialect, DialectName::Apt4 | DialectName::Cl) || !self.parameters.iter().any(foreign)
    }

    /// The form as a snippet: what can be left out left out, of several the first, values as places to fill in.
    pub(crate) fn snippet(&self, word: &str) -> Option<String> {
        let rest = self.text.strip_prefix(word)?;
        let open = rest.chars().next().filter(|first| matches!(first, '/' | '('))?;
        let mut text = format!("{word}{open}");
        let (mut at, mut place, mut steps) = (0, 0, 0);
        // Each step of the first way is taken once; dots and brackets are passed over.
        while let Some(step) = self.steps.get(at).filter(|_| steps < self.steps.len()) {
            steps += 1;
            match *step {
                Step::Parameter(index) => {
                    match self.parameters.get(index)?.atom {
                        Atom::Word(spelling) => text.push_str(spelling),
                        Atom::Number(number) => text.push_str(number),
                        Atom::Placeholder(name) => {
                            place += 1;
                            text.push_str(&format!("${{{place}:{name}}}"));
                        }
                    }
                    at += 1;
                }
                Step::Comma => {
                    text.push(',');
                    at += 1;
                }
                Step::Split(first, other) => {
                    // An optional part can be passed over: its second way begins where it ends.
                    at = if self.is_optional(first, other) { other } else { first };
                }
                Step::Jump(to) => at = to,
                Step::More(_) => at += 1,
            }
        }
        let mut text = text.trim_end_matches([',', '/']).to_owned();
        if open == '(' {
            text.push(')');
        }
        text.push_str("$0");
        Some(text)
    }

    /// Whether the first way of a split leads on to the second, so that it can be passed over.
    fn is_optional(&self, first: usize, other: usize) -> bool {
        other > first && !matches!(self.steps.get(other.wrapping_sub(1)), Some(Step::Jump(to)) if *to > other)
    }
}

/// Which geometry can stand for a placeholder; nothing for numbers, `Some(&[])` for names of anything.
pub(crate) fn kinds_of(placeholder: &str) -> Option<&'static [GeometryKind]> {
    use GeometryKind as Kind;
    const SURFACES: &[GeometryKind] = &[
        Kind::Line,
        Kind::Circle,
        Kind::Plane,
        Kind::Cylinder,
        Kind::Ellipse,
        Kind::Hyperbola,
        Kind::Cone,
        Kind::GeneralConic,
        Kind::LoftConic,
        Kind::Sphere,
        Kind::Quadric,
        Kind::PolyConic,
        Kind::TabulatedCylinder,
        Kind::RuledSurface,
        Kind::Sculptured,
    ];
    let stem = placeholder.trim_end_matches(|c: char| c.is_ascii_digit());
    Some(match stem {
        "point" | "pt" | "pa" => &[Kind::Point],
        "line" => &[Kind::Line],
        "circle" => &[Kind::Circle],
        "plane" => &[Kind::Plane],
        "vector" => &[Kind::Vector],
        "matrix" => &[Kind::Matrix],
        "pattern" => &[Kind::Pattern],
        "tabcyl" => &[Kind::TabulatedCylinder],
        "ssurf" => &[Kind::Sculptured],
        "scurv" => &[Kind::SpaceCurve],
        "conic" => &[Kind::Ellipse, Kind::Hyperbola, Kind::GeneralConic, Kind::LoftConic],
        "ds" | "ps" | "cs" | "surface" => SURFACES,
        "geometry" | "name" | "names" | "list" | "value" | "values" | "variable" | "macro" | "routine"
        | "file" | "text" | "new" | "old" | "type" | "definitions" | "statement" | "label" | "mod"
        | "modifier" | "pairs" | "prog" | "segment" | "system" | "axis" | "expression" | "option"
        | "operation" | "aid" | "in" | "tool" => &[],
        _ => return None,
    })
}

/// Reads the text of a form into steps.
struct Reader {
    text: &'static str,
    at: usize,
    end: usize,
    parameters: Vec<Parameter>,
    steps: Vec<Step>,
}

impl Reader {
    fn peek(&self) -> Option<char> {
        self.text.get(self.at..self.end)?.chars().next()
    }

    /// Sequences divided by bars, up to `close`. In braces without a bar commas divide as well.
    fn alternatives(&mut self, close: Option<char>) {
        let commas_divide = close == Some('}') && !self.has_bar();
        let comma_first = close == Some(']') && self.peek() == Some(',');
        let mut ends = Vec::new();
        loop {
            let split = self.steps.len();
            self.steps.push(Step::Jump(split + 1));
            if comma_first && !ends.is_empty() && self.peek() != Some(',') {
                self.steps.push(Step::Comma);
            }
            self.sequence(commas_divide);
            let divided = match self.peek() {
                Some('|') => true,
                Some(',') => commas_divide,
                _ => false,
            };
            if !divided {
                break;
            }
            self.at += 1;
            ends.push(self.steps.len());
            self.steps.push(Step::Jump(0));
            let next = self.steps.len();
            if let Some(step) = self.steps.get_mut(split) {
                *step = Step::Split(split + 1, next);
            }
        }
        if close.is_some() && self.peek() == close {
            self.at += 1;
        }
        let after = self.steps.len();
        for end in ends {
            if let Some(step) = self.steps.get_mut(end) {
                *step = Step::Jump(after);
            }
        }
    }

    /// Whether the braces that have been opened hold a bar of their own.
    fn has_bar(&self) -> bool {
        let mut depth = 0_u32;
        for character in self.text.get(self.at..self.end).unwrap_or("").chars() {
            match character {
                '{' | '[' => depth += 1,
                '}' | ']' if depth == 0 => return false,
                '}' | ']' => depth -= 1,
                '|' if depth == 0 => return true,
                _ => {}
            }
        }
        false
    }

    /// Items up to a bar, a closing bracket or the end.
    fn sequence(&mut self, commas_divide: bool) {
        while let Some(character) = self.peek() {
            match character {
                '|' | ']' | '}' => return,
                ',' if commas_divide => return,
                ',' => {
                    self.at += 1;
                    self.steps.push(Step::Comma);
                }
                '[' => {
                    self.at += 1;
                    let split = self.steps.len();
                    self.steps.push(Step::Jump(split + 1));
                    self.alternatives(Some(']'));
                    let next = self.steps.len();
                    if let Some(step) = self.steps.get_mut(split) {
                        *step = Step::Split(split + 1, next);
                    }
                }
                '{' => {
                    self.at += 1;
                    self.alternatives(Some('}'));
                }
                '.' if self.text.get(self.at..self.end).is_some_and(|rest| rest.starts_with("...")) => {
                    while self.peek() == Some('.') {
                        self.at += 1;
                    }
                    let between = self.steps.last() == Some(&Step::Comma) && self.peek() == Some(',');
                    if between {
                        // Dots for nothing: the comma before them is the one behind them.
                        let behind = self.steps.len() + 5;
                        self.steps.push(Step::Split(behind - 4, behind));
                    }
                    let here = self.steps.len();
                    self.steps.push(Step::Split(here + 1, here + 3));
                    self.steps.push(Step::More(self.parameters.len().checked_sub(1)));
                    self.steps.push(Step::Jump(here));
                }
                _ => self.atom(),
            }
        }
    }

    /// A word, a number or a placeholder; other characters are passed over.
    fn atom(&mut self) {
        let start = self.at;
        let rest = self.text.get(start..self.end).unwrap_or("");
        // Dots belong to a relation, `a.EQ.b`, and to a range, `1..3`.
        let belongs = |at: usize, c: char| match c {
            '.' => rest.len() > at + 1 && !rest.get(at..).is_some_and(|rest| rest.starts_with("...")),
            c => c.is_ascii_alphanumeric() || matches!(c, '=' | '-'),
        };
        let length = rest.char_indices().find(|&(at, c)| !belongs(at, c)).map_or(rest.len(), |(at, _)| at);
        if length == 0 {
            self.at += self.peek().map_or(1, char::len_utf8);
            return;
        }
        self.at += length;
        let text = rest.get(..length).unwrap_or("");
        let atom = if text.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.') {
            Atom::Number(text)
        } else if text.bytes().any(|byte| byte.is_ascii_lowercase()) {
            Atom::Placeholder(text)
        } else {
            Atom::Word(text)
        };
        self.steps.push(Step::Parameter(self.parameters.len()));
        self.parameters.push(Parameter { atom, range: start..self.at });
    }
}

#[cfg(test)]
mod tests {
    use apt_syntax::{
        dialect::DialectName,
        vocabulary::{WordClass, lookup},
    };
    use expect_test::expect;

    use super::*;

    #[test]
    fn every_form_of_the_vocabulary_is_read() {
        let mut without = Vec::new();
        for word in words() {
            for text in word.forms {
                match Form::read(word.spelling, text) {
                    None => {
                        // Words without parameters, words before text, and words whose form is another word's.
                        let own = text.starts_with(&format!("{}/", word.spelling))
                            || text.starts_with(&format!("{}(", word.spelling));
                        without.extend(own.then_some(*text));
                    }
                    Some(form) => {
                        assert!(!form.steps.is_empty(), "{text}");
                        for parameter in &form.parameters {
                            let name = match parameter.atom {
                                Atom::Word(name) | Atom::Placeholder(name) | Atom::Number(name) => name,
                            };
                            assert_eq!(&form.text[parameter.range.clone()], name, "{text}");
                        }
                        for step in &form.steps {
                            if let Step::Split(a, b) = step {
                                assert!(*a <= form.steps.len() && *b <= form.steps.len(), "{text}");
                            }
                        }
                    }
                }
            }
        }
        assert!(without.is_empty(), "{without:?}");
    }

    #[test]
    fn every_word_in_a_form_is_one_of_the_vocabulary() {
        // Words of later systems take words that only these reserve.
        for word in words().iter().filter(|word| word.is_in(DialectName::Apt3)) {
            for form in forms_of(word) {
                for parameter in &form.parameters {
                    if let Atom::Word(name) = parameter.atom {
                        assert!(lookup(name).is_some(), "{name} in {}", form.text);
                    }
                }
            }
        }
    }

    #[test]
    fn snippets_ask_for_what_must_be_given() {
        let mut all = String::new();
        for name in
            ["GOLFT", "GOTO", "CIRCLE", "LINE", "SPINDL", "SINF", "INTOL", "POINT", "PLANE", "GO", "POCKET"]
        {
            let word = lookup(name).unwrap();
            let form = forms_of(word).first().unwrap();
            all.push_str(&format!("{}\n", form.snippet(name).unwrap()));
        }
        expect![[r#"
            GOLFT/${1:ds}$0
            GOTO/${1:point}$0
            CIRCLE/${1:x},${2:y},${3:r}$0
            LINE/${1:x1},${2:y1},${3:x2},${4:y2}$0
            SPINDL/${1:rpm}$0
            SINF(${1:x})$0
            INTOL/${1:ps}$0
            POINT/${1:x},${2:y}$0
            PLANE/${1:a},${2:b},${3:c},${4:d}$0
            GO/${1:ds}$0
            POCKET/${1:re},${2:c},${3:f},${4:f1},${5:f2},${6:f3},${7:o},${8:p},${9:point},${10:point},${11:point}$0
        "#]].assert_eq(&all);
        for word in words().iter().filter(|word| word.class != WordClass::Text) {
            for form in forms_of(word) {
                let Some(snippet) = form.snippet(word.spelling) else { continue };
                assert!(snippet.starts_with(word.spelling) && snippet.ends_with("$0"), "{snippet}");
                assert!(!snippet.contains(['[', '|']) && !snippet.contains("..."), "{snippet}");
            }
        }
    }
}

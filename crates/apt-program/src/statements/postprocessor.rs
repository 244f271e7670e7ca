//! Post-processor statements and texts: opaque, but the kind of each parameter is checked (language reference 8).

use apt_geometry::canonical::{Geometry, GeometryKind};
use apt_syntax::{
    TextRange,
    dialect::DialectName,
    statement::{Argument, Expression, Name, WordUse},
    vocabulary::{self, Word, WordClass},
};
use smol_str::SmolStr;

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Items, Operand},
    finding::FindingKind,
    listing::ListingKind,
    record::{PostArgument, RecordKind},
};

/// Most MACHIN statements (language reference 1.10).
const MOST_MACHINES: u32 = 9;

/// Subclass of a word that has none: those of later dialects.
const NO_CODE: u16 = 0;

/// The integer code of a minor word; zero for a word without one.
pub(crate) fn minor_code(word: &str) -> u16 {
    vocabulary::lookup(word).and_then(|word| word.code).unwrap_or(NO_CODE)
}

/// APT III: a statement with a wrong number of operands.
const WRONG_FORM: u16 = 129;

/// What a word of CL files for arcs and curves should have after it, if it has something else.
fn curve_form(word: &str, items: &[Item]) -> Option<&'static str> {
    let words = items.iter().map_while(Item::word).count();
    let numbers = items.iter().skip(words).map_while(Item::scalar).count();
    let whole = words + numbers == items.len();
    let first = items.first();
    let (fits, expected) = match word {
        "ARCDAT" => (whole && (words, numbers) == (0, 7), "7 numbers: centre, axis and radius"),
        "ARCMOV" => {
            let direction = matches!(first.and_then(Item::word), Some("CLW" | "CCLW"));
            let fits = whole && words == 1 && direction && matches!(numbers, 3 | 4);
            (fits, "CLW or CCLW, a point and perhaps an angle")
        }
        "MOVNRB" => {
            let switch = matches!(first.and_then(Item::word), Some("ON" | "OFF" | "NEXT"));
            let part = first.and_then(Item::scalar).is_some_and(|part| matches!(part, 1.0 | 2.0 | 3.0));
            (switch || part, "ON, OFF, NEXT, 1, 2 or 3 first")
        }
        _ => return None,
    };
    (!fits).then_some(expected)
}

/// What geometry a post-processor word takes: none, any surface, or one type.
enum TakesGeometry {
    No,
    AnySurface,
    Only(GeometryKind),
}

/// The words that take geometry (language reference 3.5).
fn takes_geometry(word: &str) -> TakesGeometry {
    match word {
        "CLEARP" => TakesGeometry::Only(GeometryKind::Plane),
        "CLRSRF" => TakesGeometry::AnySurface,
        "TRANS" | "ORIGIN" | "TRACUT" | "COPY" => TakesGeometry::Only(GeometryKind::Matrix),
        _ => TakesGeometry::No,
    }
}

impl Evaluator<'_> {
    /// PARTNO, PPRINT and INSERT leave records, REMARK and TITLES stand on the listing only.
    pub(crate) fn text_statement(&mut self, word: &WordUse, text: &SmolStr, range: TextRange) {
        let spelling = word.word.spelling;
        match spelling {
            "REMARK" => return self.list(ListingKind::Remark(text.clone()), range),
            "TITLES" => return self.list(ListingKind::heading(text), range),
            _ => {}
        }
        let code = word.word.code.unwrap_or(NO_CODE);
        self.emit(RecordKind::Text { word: SmolStr::new_static(spelling), code, text: text.clone() }, range);
    }

    /// A post-processor word with its parameters.
    pub(crate) fn postprocessor(&mut self, major: Major<'_>) {
        let bare = major.word.word.class == WordClass::PostprocessorBare && self.dialect.bare_words_strict;
        if bare && (major.slash || !major.arguments.is_empty()) {
            return self.report(FindingKind::PostBare { word: major.name() }, major.range);
        }
        let takes_any_word = self.is_apt4() && major.spelling() == "UNITS";
        let Some(items) = self.post_operands(Some(major), major.arguments, takes_any_word) else { return };
        if let Some(expected) = curve_form(major.spelling(), &items) {
            return self.wrong_count(major, items.len(), expected, WRONG_FORM);
        }
        self.emit_post(major, &items, Vec::with_capacity(items.len()));
    }

    /// A word that nobody knows, in a CL file: its parameters go through as they are.
    pub(crate) fn unknown_word(&mut self, name: &Name, arguments: &[Argument], range: TextRange) {
        let Some(items) = self.post_operands(None, arguments, true) else { return };
        let arguments = items
            .into_iter()
            .map(|item| match item.operand {
                Operand::Scalar(value) => PostArgument::Number(value),
                Operand::Word(word) => {
                    PostArgument::Word(SmolStr::new_static(word.spelling), word.code.unwrap_or(NO_CODE))
                }
                Operand::Text(text) => PostArgument::Text(text),
                Operand::Empty => PostArgument::Text(SmolStr::default()),
                Operand::Geometry { geometry, .. } => PostArgument::Geometry((*geometry).clone()),
            })
            .collect();
        self.emit(RecordKind::Postprocessor { word: name.text.clone(), code: NO_CODE, arguments }, range);
    }

    /// Operands; in CL files, and after UNITS in APT4, a name without value is text. A name without value that later
    /// systems use as a word of this statement is that word (CYCLE/DRILL,DEPTH,2), but not on cards.
    fn post_operands(
        &mut self,
        major: Option<Major<'_>>,
        arguments: &[Argument],
        takes_any_word: bool,
    ) -> Option<Items> {
        let takes_any_word = takes_any_word || self.is_cl();
        let mut items = Vec::with_capacity(arguments.len());
        let mut complete = true;
        for argument in arguments {
            if let Some(word) = major.and_then(|major| self.later_word(major, argument)) {
                items.push(Item { operand: Operand::Word(word), range: argument.range() });
                continue;
            }
            if takes_any_word
                && let Argument::Expression(Expression::Reference(reference)) = argument
                && self.look_up(&reference.name.text).is_none()
            {
                let operand = Operand::Text(reference.name.text.clone());
                items.push(Item { operand, range: reference.range });
                continue;
            }
            complete &= self.operand(argument, &mut items).is_some();
        }
        complete.then_some(items)
    }

    /// The word of later systems that a name without value stands for in a statement.
    fn later_word(&self, major: Major<'_>, argument: &Argument) -> Option<&'static Word> {
        let Argument::Expression(Expression::Reference(reference)) = argument else { return None };
        let name = &reference.name.text;
        if self.dialect_name != DialectName::Free || reference.subscript.is_some() {
            return None;
        }
        let word = vocabulary::lookup(name).filter(|word| word.class == WordClass::Minor)?;
        (word.used_in.contains(&major.spelling()) && self.look_up(name).is_none()).then_some(word)
    }

    /// Checks the operands and writes the record.
    fn emit_post(&mut self, major: Major<'_>, items: &[Item], mut arguments: Vec<PostArgument>) {
        let mut sound = true;
        for item in items {
            let argument = match &item.operand {
                Operand::Scalar(value) => PostArgument::Number(*value),
                Operand::Word(word) => {
                    PostArgument::Word(SmolStr::new_static(word.spelling), word.code.unwrap_or(NO_CODE))
                }
                Operand::Text(text) => PostArgument::Text(text.clone()),
                Operand::Empty => PostArgument::Text(SmolStr::default()),
                Operand::Geometry { geometry, .. } => match self.post_geometry(major, geometry, item.range) {
                    Some(argument) => argument,
                    None => {
                        sound = false;
                        continue;
                    }
                },
            };
            arguments.push(argument);
        }
        if sound {
            let code = major.word.word.code.unwrap_or(NO_CODE);
            self.emit(RecordKind::Postprocessor { word: major.name(), code, arguments }, major.range);
        }
    }

    /// Geometry, where the word takes it.
    fn post_geometry(
        &mut self,
        major: Major<'_>,
        geometry: &Geometry,
        range: TextRange,
    ) -> Option<PostArgument> {
        let kind = geometry.kind();
        let takes = takes_geometry(major.spelling());
        let fits = match takes {
            TakesGeometry::No => false,
            TakesGeometry::AnySurface => kind.is_surface(),
            TakesGeometry::Only(only) => kind == only,
        };
        if fits {
            return Some(PostArgument::Geometry(geometry.clone()));
        }
        let other_type = !matches!(takes, TakesGeometry::No);
        self.report(FindingKind::PostGeometry { word: major.name(), kind, other_type }, range);
        None
    }

    /// MACHIN/name,n,...: the name is taken as it stands.
    pub(crate) fn machine(&mut self, major: Major<'_>) {
        let name = match major.arguments.first() {
            Some(Argument::Expression(Expression::Reference(reference))) if reference.subscript.is_none() => {
                reference.name.text.clone()
            }
            Some(Argument::Word(word)) if self.is_cl() => SmolStr::new_static(word.word.spelling),
            Some(Argument::Text { text, .. }) => text.clone(),
            _ => return self.report(FindingKind::MachineName, major.range),
        };
        self.state.machines += 1;
        if self.dialect.bounded_tables && self.state.machines > MOST_MACHINES {
            return self.report(FindingKind::MachineCount { limit: MOST_MACHINES }, major.range);
        }
        let Some(items) = self.post_operands(Some(major), &major.arguments[1..], false) else { return };
        self.emit_post(major, &items, vec![PostArgument::Text(name)]);
    }
}

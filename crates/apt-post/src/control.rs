//! What the control holds, and the building of blocks.

use std::collections::BTreeMap;

use apt_cldata::record::Units;
use apt_geometry::pieces::Pieces;

use crate::{
    finding::{PostFinding, PostFindingKind},
    format::FormatError,
    machine::MachineDefinition,
    tape::Block,
    template::{Piece, pieces},
};

/// What is written for a character of a remark that the control lacks.
pub(crate) const REPLACEMENT: char = '?';
/// What stands before a line that goes on with the block of the one before it.
const CONTINUED: &str = "    ";
/// The registers of a feed per minute, per revolution, and of an inverse time.
pub(crate) const FEEDS: [&str; 3] = ["F", "FR", "FI"];

/// A number for a placeholder.
#[derive(Debug, Clone, Copy)]
struct Number {
    value: f64,
    /// Written even when the control holds it already.
    force: bool,
}

/// Values for the placeholders of a template.
#[derive(Debug, Clone, Default)]
pub(crate) struct Values {
    numbers: BTreeMap<&'static str, Number>,
    texts: BTreeMap<&'static str, String>,
}

impl Values {
    pub(crate) fn number(mut self, name: &'static str, value: f64) -> Self {
        self.numbers.insert(name, Number { value, force: false });
        self
    }

    pub(crate) fn words(mut self, words: &[Word]) -> Self {
        let numbers = words.iter().map(|word| {
            let Word { register, value, force } = *word;
            (register, Number { value, force })
        });
        self.numbers.extend(numbers);
        self
    }

    pub(crate) fn optional(self, name: &'static str, value: Option<f64>) -> Self {
        match value {
            Some(value) => self.number(name, value),
            None => self,
        }
    }

    pub(crate) fn text(mut self, name: &'static str, text: impl Into<String>) -> Self {
        self.texts.insert(name, text.into());
        self
    }
}

/// One word of a motion block.
pub(crate) struct Word {
    /// Register.
    pub(crate) register: &'static str,
    /// Value.
    pub(crate) value: f64,
    /// Written even when the control holds it already.
    pub(crate) force: bool,
}

/// What a template comes to.
#[derive(Debug, Default)]
struct Filled {
    words: Vec<String>,
    placeholders: usize,
    /// How many placeholders have a text, and how many a number to write.
    texts: usize,
    numbers: usize,
}

/// The tape so far and the state of the control behind it.
pub(crate) struct Control<'a> {
    pub(crate) machine: &'a MachineDefinition,
    pub(crate) units: Units,
    pub(crate) blocks: Pieces<Block>,
    pub(crate) findings: Pieces<PostFinding>,
    /// Statement and origin that everything made now belongs to.
    pub(crate) place: (u32, u32),
    /// Text of the modal registers.
    held: BTreeMap<String, String>,
    /// Code in force in each modal group.
    modes: BTreeMap<&'a str, &'a str>,
    /// Level of the optional blocks that are being made.
    pub(crate) skip: Option<u32>,
    pub(crate) numbering: Numbering,
    /// Whether the block goes on on the next line.
    goes_on: bool,
}

/// Sequence numbering in force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Numbering {
    pub(crate) on: bool,
    pub(crate) next: u32,
    pub(crate) step: u32,
    pub(crate) every: u32,
    pub(crate) count: u32,
}

impl<'a> Control<'a> {
    pub(crate) fn new(machine: &'a MachineDefinition, units: Units) -> Self {
        let sequence = machine.block.sequence;
        Control {
            machine,
            units,
            blocks: Pieces::default(),
            findings: Pieces::default(),
            place: (0, u32::MAX),
            held: BTreeMap::new(),
            modes: BTreeMap::new(),
            skip: None,
            numbering: Numbering {
                on: sequence.on,
                next: sequence.start,
                step: sequence.step,
                every: sequence.every.max(1),
                count: 0,
            },
            goes_on: false,
        }
    }

    pub(crate) fn find(&mut self, kind: PostFindingKind) {
        let (isn, source) = self.place;
        self.findings.push(PostFinding { isn, source, block: self.blocks.len(), kind });
    }

    /// The text of a register with its number, and what the control reads; a finding when it cannot be written.
    pub(crate) fn number_text(&mut self, register: &str, value: f64) -> Option<String> {
        let definition = self.machine.registers.get(register)?;
        match definition.format(self.units == Units::Inches).text(value) {
            Ok(text) => Some(format!("{}{text}", definition.address)),
            Err(FormatError::NotFinite) => {
                self.find(PostFindingKind::NotFinite);
                None
            }
            Err(FormatError::TooManyDigits) => {
                self.find(PostFindingKind::DigitLimit { axis: register.into(), value });
                None
            }
        }
    }

    /// The value that the control reads for a register; the value itself when it cannot be written.
    pub(crate) fn rounded(&self, register: &str, value: f64) -> f64 {
        let definition = self.machine.registers.get(register);
        definition
            .and_then(|definition| definition.format(self.units == Units::Inches).rounded(value).ok())
            .unwrap_or(value)
    }

    /// The largest number that a register takes.
    pub(crate) fn greatest(&self, register: &str) -> f64 {
        let definition = self.machine.registers.get(register);
        definition
            .map_or(f64::INFINITY, |definition| definition.format(self.units == Units::Inches).greatest())
    }

    /// Whether writing a value would change what the control holds.
    pub(crate) fn changes(&self, register: &str, value: f64) -> bool {
        let Some(definition) = self.machine.registers.get(register) else { return false };
        let text = definition.format(self.units == Units::Inches).text(value);
        match (text, self.held.get(register)) {
            (Ok(text), Some(held)) => *held != format!("{}{text}", definition.address),
            _ => true,
        }
    }

    /// The word of a register under its modal rule.
    fn register_word(&mut self, register: &str, value: f64, force: bool) -> Option<String> {
        // The computed planes of a cycle are written as Z.
        let register = if matches!(register, "ZR" | "ZI") { "Z" } else { register };
        let text = self.number_text(register, value)?;
        let modal = self.machine.registers.get(register).is_some_and(|definition| definition.modal);
        if modal {
            let same = self.held.get(register) == Some(&text);
            if FEEDS.contains(&register) {
                // A feed takes the place of one that another register told.
                self.forget(&FEEDS);
            }
            self.held.insert(register.to_owned(), text.clone());
            if same && !force {
                return None;
            }
        }
        Some(text)
    }

    /// Notes what the control holds in a register by other words than its own.
    pub(crate) fn hold(&mut self, register: &str, value: f64) {
        let definition = self.machine.registers.get(register).filter(|definition| definition.modal);
        let Some(definition) = definition else { return };
        match definition.format(self.units == Units::Inches).text(value) {
            Ok(text) => self.held.insert(register.to_owned(), format!("{}{text}", definition.address)),
            Err(_) => self.held.remove(register),
        };
    }

    /// Takes a register out of what the control is known to hold.
    pub(crate) fn forget(&mut self, registers: &[&str]) {
        for register in registers {
            self.held.remove(*register);
        }
    }

    /// Forgets everything: the next block carries all that it needs.
    pub(crate) fn forget_all(&mut self) {
        self.held.clear();
        self.modes.clear();
    }

    /// Notes that a code is in force, and says whether it was not before. Codes without group always count as new; a control
    /// for which a code is empty knows nothing else.
    pub(crate) fn set_mode(&mut self, code: &str) -> bool {
        if code.is_empty() {
            return false;
        }
        let machine = self.machine;
        for (group, codes) in &machine.groups {
            if let Some(code) = codes.iter().find(|known| *known == code) {
                return self.modes.insert(group, code) != Some(code.as_str());
            }
        }
        true
    }

    /// A block of motion: codes that are not in force yet, then words in the order of the machine. Nothing is made
    /// when neither a word nor a forced code remains.
    pub(crate) fn motion(&mut self, before: &[String], codes: &[&str], words: &[Word]) -> bool {
        let mut texts: Vec<(usize, String)> = Vec::new();
        for word in words {
            if let Some(text) = self.register_word(word.register, word.value, word.force) {
                let order = self.machine.block.order.iter().position(|register| register == word.register);
                texts.push((order.unwrap_or(usize::MAX), text));
            }
        }
        if texts.is_empty() {
            return false;
        }
        texts.sort_by_key(|(order, _)| *order);
        let mut all: Vec<String> = before.to_vec();
        for code in codes {
            if self.set_mode(code) {
                all.push((*code).to_owned());
            }
        }
        all.extend(texts.into_iter().map(|(_, text)| text));
        let separator = if self.machine.block.spaces { " " } else { "" };
        self.push_block(&all.join(separator));
        true
    }

    /// A block from a template; nothing when it has placeholders and none of them has something to write.
    pub(crate) fn template(&mut self, template: &str, values: &Values) {
        let filled = self.filled(template, values);
        if filled.placeholders == 0 || filled.texts + filled.numbers > 0 {
            self.push_words(&filled.words);
        }
    }

    /// A block of motion from a template; nothing when no register has something to write. Whether there is one.
    pub(crate) fn motion_template(&mut self, template: &str, values: &Values) -> bool {
        let filled = self.filled(template, values);
        if filled.numbers > 0 {
            self.push_words(&filled.words);
        }
        filled.numbers > 0
    }

    /// The words of a template that have something to write.
    fn filled(&mut self, template: &str, values: &Values) -> Filled {
        let mut filled = Filled::default();
        for word in template.split_whitespace() {
            let mut text = String::new();
            let mut complete = true;
            for piece in pieces(word) {
                match piece {
                    Piece::Literal(literal) => text.push_str(literal),
                    Piece::Placeholder { name, force } => {
                        filled.placeholders += 1;
                        let named = values.texts.contains_key(name);
                        match self.placeholder(name, force, values) {
                            Some(value) => {
                                *if named { &mut filled.texts } else { &mut filled.numbers } += 1;
                                text.push_str(&value);
                            }
                            None => complete = false,
                        }
                    }
                }
            }
            if complete && !text.is_empty() {
                filled.words.push(text);
            }
        }
        filled
    }

    /// A block of words, of which some may be codes.
    fn push_words(&mut self, words: &[String]) {
        if words.is_empty() {
            return;
        }
        for word in words {
            self.set_mode(word);
        }
        let separator = if self.machine.block.spaces { " " } else { "" };
        self.push_block(&words.join(separator));
    }

    fn placeholder(&mut self, name: &str, force: bool, values: &Values) -> Option<String> {
        if let Some(text) = values.texts.get(name) {
            return Some(text.clone()).filter(|text| !text.is_empty());
        }
        let number = values.numbers.get(name)?;
        self.register_word(name, number.value, force || number.force)
    }

    pub(crate) fn templates(&mut self, templates: &[String], values: &Values) {
        for template in templates {
            self.template(template, values);
        }
    }

    /// A block of one code; none where the control has no word for it.
    pub(crate) fn code(&mut self, code: &str) {
        if code.is_empty() {
            return;
        }
        for word in code.split_whitespace() {
            self.set_mode(word);
        }
        self.push_block(code);
    }

    /// A code of a function of the machine that no motion goes with, as the control takes it.
    pub(crate) fn function(&mut self, code: &str) {
        let machine = self.machine;
        if machine.templates.function.is_empty() {
            return self.code(code);
        }
        self.template(&machine.templates.function, &Values::default().text("code", code));
    }

    /// A comment or message; characters that would end it are replaced, others that the control lacks reported.
    pub(crate) fn remark(&mut self, template: &str, text: &str) {
        let mut clean = String::new();
        for character in text.trim().chars() {
            match character {
                '(' => clean.push('['),
                ')' => clean.push(']'),
                ' '..='~' => clean.push(character),
                _ => {
                    self.find(PostFindingKind::Character { character });
                    clean.push(REPLACEMENT);
                }
            }
        }
        let continuation = self.machine.block.continuation.as_str();
        if let Some(before) = clean.strip_suffix(continuation).filter(|_| !continuation.is_empty()) {
            // A remark is a line.
            clean = format!("{before}{REPLACEMENT}");
            for character in continuation.chars() {
                self.find(PostFindingKind::Character { character });
            }
        }
        // Not through `template`, which would close up runs of blanks in the text.
        self.push_block(&template.replace("{text}", &clean));
    }

    /// The mark of a block that may be skipped.
    fn skip_mark(&self) -> String {
        match self.skip {
            None => String::new(),
            Some(level) if level > 1 => format!("{}{level}", self.machine.block.skip),
            Some(_) => self.machine.block.skip.clone(),
        }
    }

    /// The sequence number of the next block, which may be none.
    fn sequence_number(&mut self, plain: bool) -> String {
        let layout = &self.machine.block;
        let mut text = String::new();
        if layout.sequence.every_line || self.numbering.on && !plain {
            if self.numbering.count.is_multiple_of(self.numbering.every) {
                let number = self.numbering.next;
                if let Some(word) = self.number_text("N", f64::from(number)) {
                    text.push_str(&word);
                    if layout.spaces {
                        text.push(' ');
                    }
                }
                let after = number.saturating_add(self.numbering.step);
                self.numbering.next = if after > layout.sequence.max { layout.sequence.start } else { after };
            }
            self.numbering.count = self.numbering.count.wrapping_add(1);
        }
        text
    }

    /// Appends a block, with skip mark and sequence number where they belong.
    pub(crate) fn push_block(&mut self, text: &str) {
        let layout = &self.machine.block;
        let plain = text.is_empty() || text.starts_with(['%', 'O', '(', ';']);
        let goes_on = !layout.continuation.is_empty() && text.ends_with(&layout.continuation);
        let mut block = String::new();
        if std::mem::replace(&mut self.goes_on, goes_on) {
            block.push_str(CONTINUED);
        } else {
            let mark = if plain { String::new() } else { self.skip_mark() };
            let number = self.sequence_number(plain);
            match layout.skip_behind_number {
                true => block.extend([number, mark]),
                false => block.extend([mark, number]),
            }
        }
        block.push_str(text);
        if block.len() > self.machine.max_block {
            self.find(PostFindingKind::BlockTooLong { length: block.len(), limit: self.machine.max_block });
        }
        let (isn, source) = self.place;
        self.blocks.push(Block { text: block, isn, source });
    }
}

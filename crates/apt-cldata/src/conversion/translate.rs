//! What a file says, in the words of another system.

use std::collections::VecDeque;

use apt_geometry::patience::Patience;
use smol_str::{SmolStr, format_smolstr};

use super::{
    ConversionNoteKind as Kind, Item, Notes, QUOTATION, What, cycle,
    words::{
        self, FEED_UNITS, Tool, calls_tool, cutter_of_tool_data, numbers, states_cutter, tool_data_of_cutter,
        tool_word, value_and_unit, word,
    },
};
use crate::{
    record::{ClKind, ClRecord, ClWord, Units, ends_before, looked_through},
    text::{
        ClDialect, ClFile, Remark,
        dialects::{CutterForm, Form, nx::END_OF_PATH},
        sign_of_remark,
        words::{Shape, TOOL_PATH, shape},
        writer::statement_text,
    },
};

/// Name of an operation or tool that nothing names.
const NO_NAME: &str = "NONE";
/// Operation, its end, unit and part number, which the file may not have.
const MOST_ADDED: usize = 4;
/// Words that stand before the unit where it is added.
const HEAD: [&str; 2] = ["MACHIN", "MODE"];

/// Merges records and remarks and translates them. What the target has no words for becomes a remark.
/// They are fewer where who waits gives up before the end.
pub(super) fn translate(
    file: ClFile<'_>,
    from: &Form,
    to: &Form,
    notes: &mut Notes,
    patience: Patience<'_>,
) -> VecDeque<Item> {
    // A list that grows is copied as a whole, which nobody can interrupt. What is added to it is little, and stands near its ends.
    let items = VecDeque::with_capacity(file.records.len() + file.remarks.len() + MOST_ADDED);
    let mut translator = Translator { from, to, notes, items, place: (0, 0), patience };
    let mut remarks = file.remarks.iter().peekable();
    for record in file.records {
        if ends_before(record.position_count(), patience) {
            break;
        }
        while let Some(remark) = remarks.next_if(|remark| remark.line < record.source) {
            translator.remark(remark);
        }
        translator.record(record);
    }
    for remark in remarks.take_while(|_| !patience.ends_after(1)) {
        translator.remark(remark);
    }
    translator.ending();
    translator.units();
    translator.part_number();
    translator.items
}

struct Translator<'a> {
    from: &'a Form,
    to: &'a Form,
    notes: &'a mut Notes,
    items: VecDeque<Item>,
    /// Statement number and source of the record that is being translated.
    place: (u32, u32),
    patience: Patience<'a>,
}

impl Translator<'_> {
    fn push(&mut self, what: What) {
        let (isn, source) = self.place;
        self.items.push_back(Item { isn, source, what });
    }

    fn statement(&mut self, word: &str, arguments: Vec<ClWord>) {
        let kind = ClKind::Postprocessor { word: word.into(), code: None, arguments };
        self.push(What::Record(kind));
    }

    /// What there is, until who waits gives up.
    fn looked_through(&self) -> impl Iterator<Item = &Item> {
        looked_through(self.items.iter(), self.patience)
    }

    fn is_translation(&self) -> bool {
        self.from.dialect != self.to.dialect
    }

    fn record(&mut self, record: &ClRecord) {
        self.place = (record.isn, record.source);
        if !self.is_translation() {
            return self.push(What::Record(record.kind.clone()));
        }
        match &record.kind {
            // Where operations end, the file does not.
            ClKind::End if self.to.operations => {}
            ClKind::Postprocessor { word, arguments, .. } => {
                self.postprocessor(word, arguments, &record.kind);
            }
            ClKind::Control { word, arguments, .. } if word == "CUTTER" => {
                self.cutter(arguments, &record.kind);
            }
            kind => self.push(What::Record(kind.clone())),
        }
    }

    fn postprocessor(&mut self, name: &SmolStr, arguments: &[ClWord], kind: &ClKind) {
        let (from, to) = (self.from, self.to);
        if let Some(calls) = calls_tool(name, arguments) {
            return self.tool(calls, arguments, kind);
        }
        match name.as_str() {
            "FEDRAT" => {
                let ordered = value_and_unit(arguments, &FEED_UNITS, to.feed_value_first);
                self.statement(name, ordered);
            }
            "SPINDL" => {
                let ordered = value_and_unit(arguments, &["RPM", "SFM", "SMM"], to.speed_value_first);
                self.statement(name, ordered);
            }
            "CYCLE" => match cycle::translate(arguments, from, to) {
                Some(translated) => {
                    if let Some(word) = cycle::other_meaning(arguments, from, to) {
                        self.notes.add(self.place, Kind::OtherCycle { word });
                    }
                    self.statement(name, translated);
                }
                None => {
                    self.notes.add(self.place, Kind::Untranslated { word: name.clone() });
                    self.push(What::Record(kind.clone()));
                }
            },
            "TLDATA" if states_cutter(to) || to.cutter == CutterForm::Pseudo => {
                match cutter_of_tool_data(arguments) {
                    Some(cutter) => self.cutter(&cutter, kind),
                    None => self.quoted(name, arguments),
                }
            }
            _ if to.is_strange(name) => self.quoted(name, arguments),
            _ => self.push(What::Record(kind.clone())),
        }
    }

    fn tool(&mut self, calls: bool, arguments: &[ClWord], kind: &ClKind) {
        let name = tool_word(self.to, calls);
        let Some(tool) = Tool::read(arguments, self.from) else {
            self.notes.add(self.place, Kind::Untranslated { word: name.into() });
            return self.push(What::Record(kind.clone()));
        };
        let (list, left) = tool.write(self.to);
        self.statement(name, list);
        if let Some(ClWord::Word(what)) = left.first() {
            self.notes.add(self.place, Kind::AsRemark { word: format_smolstr!("{what} of {name}") });
            let of_tool = if calls { "LOADTL" } else { "SELCTL" };
            self.push(What::Remark(format!("{QUOTATION}{}", statement_text(of_tool, &left))));
        }
    }

    /// The cutter in the form of the target. `kind` is what says it in the source.
    fn cutter(&mut self, arguments: &[ClWord], kind: &ClKind) {
        match self.to.cutter {
            CutterForm::Statement => {
                let code = [6000, 6];
                let kind = ClKind::Control { word: "CUTTER".into(), code, arguments: arguments.to_vec() };
                self.push(What::Record(kind));
            }
            CutterForm::Pseudo => {
                let list: Vec<String> = arguments.iter().map(|one| self.to.size_text(one)).collect();
                self.push(What::Remark(format!("-> CUTTER / {}", list.join(", "))));
            }
            CutterForm::ToolData => match (tool_data_of_cutter(arguments), kind) {
                (Some(list), _) => self.statement("TLDATA", list),
                (None, ClKind::Control { word, .. }) => self.quoted(word, arguments),
                (None, _) => self.push(What::Record(kind.clone())),
            },
        }
    }

    /// A statement that the target does not have.
    fn quoted(&mut self, name: &str, arguments: &[ClWord]) {
        self.notes.add(self.place, Kind::AsRemark { word: name.into() });
        self.push(What::Remark(format!("{QUOTATION}{}", statement_text(name, arguments))));
    }

    fn remark(&mut self, remark: &Remark) {
        self.place = (0, remark.line);
        let text = remark.text.as_str();
        if !self.is_translation() {
            return self.push(What::Remark(text.to_owned()));
        }
        if let Some(inner) = text.strip_prefix(QUOTATION) {
            return self.quotation(inner, text);
        }
        match sign_of_remark(text) {
            Some(ClDialect::Creo) if self.pseudo_cutter(text) => {}
            Some(dialect) if dialect != self.to.dialect => {
                self.push(What::Remark(format!("{QUOTATION}{text}")));
            }
            _ => self.push(What::Remark(text.to_owned())),
        }
    }

    /// What was quoted from the target's own dialect is itself again.
    fn quotation(&mut self, inner: &str, whole: &str) {
        if sign_of_remark(inner) == Some(self.to.dialect) {
            return self.push(What::Remark(inner.to_owned()));
        }
        match shape(inner) {
            Shape::Major { word, arguments } if self.to.own.contains(&word.as_str()) => {
                self.statement(&word, arguments);
            }
            _ => self.push(What::Remark(whole.to_owned())),
        }
    }

    /// `$$-> CUTTER / d` is a cutter; whether it was one.
    fn pseudo_cutter(&mut self, text: &str) -> bool {
        let Some(Shape::Major { word, arguments }) = text.strip_prefix("->").map(shape) else { return false };
        if word != "CUTTER" || arguments.is_empty() || numbers(&arguments).is_none() {
            return false;
        }
        let kind = ClKind::Control { word, code: [6000, 6], arguments: arguments.clone() };
        self.cutter(&arguments, &kind);
        true
    }

    /// Operations begin and end, and so does the file.
    fn ending(&mut self) {
        let is_end = |item: &Item| matches!(item.what, What::Record(ClKind::End));
        if !self.to.operations {
            if self.from.operations && !self.looked_through().any(is_end) {
                self.push(What::Record(ClKind::End));
            }
            return;
        }
        if !self.is_translation() {
            return;
        }
        let opens = |item: &Item| is_statement(item, TOOL_PATH);
        if !self.looked_through().any(opens) {
            let name = self.part_name();
            let arguments = [name.as_str(), "TOOL", NO_NAME].map(word).into();
            let kind = ClKind::Postprocessor { word: TOOL_PATH.into(), code: None, arguments };
            self.items.push_front(Item { isn: 0, source: 0, what: What::Record(kind) });
        }
        let last = looked_through(self.items.iter().rev(), self.patience)
            .find(|item| opens(item) || is_statement(item, END_OF_PATH));
        if last.is_some_and(opens) {
            self.statement(END_OF_PATH, Vec::new());
        }
    }

    /// The text of PARTNO as the name of an operation: without what separates names.
    fn part_name(&self) -> String {
        let text = self.looked_through().find_map(|item| match &item.what {
            What::Record(ClKind::Text { word, text, .. }) if word == "PARTNO" => Some(text.trim()),
            _ => None,
        });
        let name: String = text
            .unwrap_or_default()
            .chars()
            .map(|c| if c.is_alphanumeric() || matches!(c, '-' | '.') { c } else { '_' })
            .collect();
        if name.is_empty() { NO_NAME.to_owned() } else { name }
    }

    /// PARTNO, where the target is known by it: without a text if nothing names the part.
    fn part_number(&mut self) {
        let named =
            |item: &Item| matches!(&item.what, What::Record(ClKind::Text { word, .. }) if word == "PARTNO");
        if self.to.part_number && self.is_translation() && !self.looked_through().any(named) {
            let kind = ClKind::Text { word: "PARTNO".into(), code: None, text: SmolStr::default() };
            self.items.push_front(Item { isn: 0, source: 0, what: What::Record(kind) });
        }
    }

    /// The unit of length that all feed rates name.
    fn units_of_feeds(&self) -> Option<Units> {
        let mut found = self.looked_through().flat_map(units_of_feed);
        found.next().filter(|units| found.all(|other| other == *units))
    }

    /// The unit, where the target is to tell it. If no record does, the feed rates may: all of them in one.
    fn units(&mut self) {
        let told = |item: &Item| matches!(item.what, What::Record(ClKind::Units(_)));
        if !self.to.tells_units || !self.is_translation() || self.looked_through().any(told) {
            return;
        }
        let place = self.items.front().map_or((1, 0), |item| (item.isn.max(1), item.source));
        let Some(units) = self.units_of_feeds() else {
            return self.notes.add(place, Kind::NoUnits);
        };
        self.notes.add(place, Kind::UnitsAdded { units });
        let head = |item: &Item| match &item.what {
            What::Remark(_) | What::Record(ClKind::Text { .. }) => true,
            What::Record(ClKind::Postprocessor { word, .. }) => HEAD.contains(&word.as_str()),
            What::Record(_) => false,
        };
        let at = self.looked_through().position(|item| !head(item)).unwrap_or(self.items.len());
        let (isn, source) = place;
        self.items.insert(at, Item { isn, source, what: What::Record(ClKind::Units(units)) });
    }
}

fn is_statement(item: &Item, name: &str) -> bool {
    matches!(&item.what, What::Record(ClKind::Postprocessor { word, .. }) if word == name)
}

/// The units of length that FEDRAT and CYCLE name.
fn units_of_feed(item: &Item) -> Vec<Units> {
    let What::Record(ClKind::Postprocessor { word, arguments, .. }) = &item.what else { return Vec::new() };
    if word != "FEDRAT" && word != "CYCLE" {
        return Vec::new();
    }
    let unit = |argument: &ClWord| match argument {
        one if words::is_word(one, &["IPM", "IPR"]) => Some(Units::Inches),
        one if words::is_word(one, &["MMPM", "MMPR"]) => Some(Units::Millimeters),
        _ => None,
    };
    arguments.iter().filter_map(unit).collect()
}

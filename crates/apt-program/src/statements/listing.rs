//! PRINT, PUNCH and READ/1 (language reference 7.9): what the program lists, and dumps that another program takes back.

use apt_geometry::patience::Waiting;
use apt_syntax::{
    TextRange,
    statement::{Argument, Expression, Name, Reference},
    vocabulary::WordClass,
};
use smol_str::{SmolStr, format_smolstr};

use super::{Major, segment};
use crate::{
    evaluator::{Evaluator, Flow},
    expression::{Operand, element_of},
    finding::{Expected, FindingKind, Found},
    listing::{
        ListingKind, NESTED, PrintFormat, PrintedItem,
        cards::{self, Dumped},
    },
    symbols::{ArrayElement, Meaning, Stored, Value, values_of},
};

/// APT III: a bad READ, PUNCH or PRINT form; an unnamed item in PUNCH; a subscript on a data card out of range.
const LISTING_FORM: u16 = 326;
const UNNAMED: u16 = 2005;
const CARD_SUBSCRIPT: u16 = 2004;

/// First numbers that PRINT takes in APT4 (language reference 10.4).
const APT4_PRINT_NUMBERS: [f64; 3] = [0.0, 2.0, 3.0];

/// What a PUNCH dumps.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sort {
    All,
    Scalars,
    Surfaces,
}

impl Sort {
    /// Whether a value is of this sort.
    fn takes(self, value: &Value) -> bool {
        match value {
            Value::Scalar(_) => self != Sort::Surfaces,
            Value::Geometry(_) => self != Sort::Scalars,
        }
    }
}

/// Items of a list that are printed or punched between two questions, each in about a microsecond.
const ITEMS_BETWEEN_QUESTIONS: usize = 256;

impl Evaluator<'_> {
    /// PRINT, PUNCH and READ; names count as used.
    pub(crate) fn listing(&mut self, major: Major<'_>) -> Flow {
        match (major.spelling(), segment(major.arguments)) {
            ("READ", Some((name, rest))) => return self.read_segment(major, name, rest),
            ("READ", None) if self.is_apt4() => return self.read_library(major),
            ("READ", None) => self.read_dump(major),
            ("PUNCH", _) => self.punch(major),
            _ => self.print(major),
        }
        Flow::Next
    }

    /// READ/1,names in APT4: surfaces from a library, which is the folders that INCLUD searches (language reference
    /// 10.4): a file of its name holds the definition of each. A name that has a value already is not read again.
    fn read_library(&mut self, major: Major<'_>) -> Flow {
        if self.listing_number(major, &[1.0]).is_none() {
            return Flow::Next;
        }
        let names = major.arguments.get(1..).unwrap_or_default();
        if names.is_empty() {
            self.wrong_count(major, 1, "1 and the names of surfaces", LISTING_FORM);
        }
        for argument in names {
            let Argument::Expression(Expression::Reference(reference)) = argument else {
                self.wrong_operand(major, Expected::Name, Found::Nothing, LISTING_FORM, argument.range());
                continue;
            };
            let name = &reference.name.text;
            if self.look_up(name).is_some() {
                continue;
            }
            match self.include_file(name, reference.range) {
                Flow::Next => {}
                other => return other,
            }
        }
        Flow::Next
    }

    /// The number that PRINT, PUNCH and READ begin with; nothing if it is none that they take, which is reported.
    fn listing_number(&mut self, major: Major<'_>, allowed: &[f64]) -> Option<f64> {
        let first = match major.arguments.first() {
            Some(Argument::Expression(number @ Expression::Number { .. })) => Some(number),
            // APT4 takes a number as it is written only.
            Some(Argument::Expression(number)) if !self.is_apt4() => Some(number),
            _ => None,
        };
        let Some(first) = first else {
            let found = if major.arguments.is_empty() { Found::Nothing } else { Found::Text };
            self.wrong_operand(major, Expected::Integer, found, LISTING_FORM, major.range);
            return None;
        };
        let value = self.scalar(first)?;
        if allowed.contains(&value) {
            return Some(value);
        }
        let finding =
            FindingKind::OperandRange { statement: major.name(), value, number: Some(LISTING_FORM) };
        self.report(finding, first.range());
        None
    }

    /// PRINT/0 to PRINT/4 with their lists, PRINT/ON and PRINT/OFF.
    fn print(&mut self, major: Major<'_>) {
        if let [Argument::Word(switch), ..] = major.arguments
            && matches!(switch.word.spelling, "ON" | "OFF")
        {
            self.state.print_all = switch.word.spelling == "ON";
            return;
        }
        if self.is_apt4() && (self.print_avoidance(major) || Self::is_part_switch(major.arguments)) {
            return;
        }
        if self.is_apt4() && self.refuse_part_switch(major) {
            return;
        }
        let allowed: &[f64] = if self.is_apt4() { &APT4_PRINT_NUMBERS } else { &[0.0, 1.0, 2.0, 3.0, 4.0] };
        let number = self.listing_number(major, allowed);
        let items = self.listed(major.arguments.get(1..).unwrap_or_default());
        let format = match number {
            None => return,
            Some(0.0) => return self.list(ListingKind::NewPage, major.range),
            Some(_) if self.lacks_list(major) => return,
            Some(1.0) => PrintFormat::Hexadecimal,
            Some(2.0) => PrintFormat::Values,
            Some(_) => PrintFormat::Full,
        };
        for (done, item) in items.iter().enumerate() {
            if self.is_given_up_among(done) {
                return;
            }
            self.list(ListingKind::Item { format, item: item.clone() }, major.range);
        }
        if number == Some(4.0) {
            self.punch_items(major, &items, Sort::All);
        }
    }

    /// A part of PRINT without ON or OFF behind it, or with more; whether it was one, which is told.
    fn refuse_part_switch(&mut self, major: Major<'_>) -> bool {
        let [Argument::Word(part), rest @ ..] = major.arguments else { return false };
        if part.word.class != WordClass::SystemFlag {
            return false;
        }
        let statement = format_smolstr!("{}/{}", major.spelling(), part.word.spelling);
        let found = |argument: &Argument| match argument {
            Argument::Word(word) => Found::Word(SmolStr::new_static(word.word.spelling)),
            _ => Found::Scalar,
        };
        let mut tell = |expected, found, range| {
            let finding =
                FindingKind::Operand { statement: statement.clone(), expected, found, number: LISTING_FORM };
            self.report(finding, range);
        };
        match rest {
            [] => tell(Expected::OnOrOff, Found::Nothing, major.range),
            [Argument::Word(switch), more, ..] if matches!(switch.word.spelling, "ON" | "OFF") => {
                tell(Expected::Nothing, found(more), more.range());
            }
            [other, ..] => tell(Expected::OnOrOff, found(other), other.range()),
        }
        true
    }

    /// PUNCH/1, PUNCH/2 and PUNCH/3 with a list or ALL.
    fn punch(&mut self, major: Major<'_>) {
        let sort = match self.listing_number(major, &[1.0, 2.0, 3.0]) {
            Some(1.0) => Sort::All,
            Some(2.0) => Sort::Scalars,
            Some(_) => Sort::Surfaces,
            None => return,
        };
        if self.lacks_list(major) {
            return;
        }
        let items = self.listed(major.arguments.get(1..).unwrap_or_default());
        self.punch_items(major, &items, sort);
    }

    /// Whether nothing follows the number, which APT III does not take; what APT4 does with it is not known.
    fn lacks_list(&mut self, major: Major<'_>) -> bool {
        let lacks = major.arguments.len() == 1 && !self.is_apt4();
        if lacks {
            self.wrong_operand(major, Expected::Name, Found::Nothing, LISTING_FORM, major.range);
        }
        lacks
    }

    /// The cards of the items with a value of this sort, and the END card.
    fn punch_items(&mut self, major: Major<'_>, items: &[PrintedItem], sort: Sort) {
        for (done, item) in items.iter().enumerate() {
            if self.is_given_up_among(done) {
                return;
            }
            let Some(value) = item.value.clone().filter(|value| sort.takes(value)) else { continue };
            if item.name == NESTED {
                let found = Found::Geometry(match &value {
                    Value::Geometry(geometry) => geometry.kind(),
                    Value::Scalar(_) => continue,
                });
                self.wrong_operand(major, Expected::Name, found, UNNAMED, major.range);
                continue;
            }
            let dumped = Dumped { name: item.name.clone(), subscript: item.subscript, value };
            for card in cards::written(&dumped) {
                self.list(ListingKind::Card(card.into()), major.range);
            }
        }
        self.list(ListingKind::Card(SmolStr::new_static(cards::END_CARD)), major.range);
    }

    /// Asks once in so many items that are listed one after the other, of which so many are done.
    fn is_given_up_among(&mut self, done: usize) -> bool {
        done % ITEMS_BETWEEN_QUESTIONS == ITEMS_BETWEEN_QUESTIONS - 1 && self.is_cancelled()
    }

    // What a list names.

    /// The items of a list, with their values in the reference system in force.
    fn listed(&mut self, arguments: &[Argument]) -> Vec<PrintedItem> {
        let mut items = Vec::new();
        for argument in arguments {
            match argument {
                Argument::Word(word) if word.word.spelling == "ALL" => {
                    self.output.lists_all = true;
                    let waiting = Waiting::until(self.cancel);
                    let patience = waiting.patience();
                    let all = values_of(&self.state.symbols, self.state.system.as_ref(), patience);
                    items.reserve(all.len());
                    for (name, value) in all.into_iter().take_while(|_| !patience.ends_after(1)) {
                        items.push(named_item(&name, value));
                    }
                    self.cancelled |= waiting.has_given_up();
                }
                Argument::Expression(Expression::Reference(reference)) => {
                    self.listed_reference(reference, &mut items);
                }
                Argument::Inclusive { name, first, last, step, range } => {
                    let key = self.array_key(&name.text);
                    self.mark_used(&key);
                    let bounds = (first.as_ref(), last.as_ref(), step.as_ref());
                    let Some((extent, subscripts)) = self.inclusive_subscripts(name, bounds, *range) else {
                        continue;
                    };
                    for subscript in subscripts {
                        match element_of(subscript, extent) {
                            Some(index) => items.push(self.listed_element(&name.text, index)),
                            None => {
                                let name = name.text.clone();
                                self.report(FindingKind::SubscriptRange { name, subscript, extent }, *range);
                            }
                        }
                    }
                }
                Argument::Empty(_) | Argument::Word(_) | Argument::Text { .. } => {}
                other => self.listed_nest(other, &mut items),
            }
        }
        items
    }

    /// A name or an element of an array. A name without value is listed as such; an array with all its elements.
    fn listed_reference(&mut self, reference: &Reference, items: &mut Vec<PrintedItem>) {
        let name = &reference.name.text;
        let key = self.array_key(name);
        self.mark_used(name);
        self.mark_used(&key);
        let extent = match self.look_up(&key).map(|symbol| &symbol.meaning) {
            Some(Meaning::Array(array)) => Some(array.extent),
            _ => None,
        };
        match (&reference.subscript, extent) {
            (Some(subscript), Some(_)) => {
                let subscript = self.scalar(subscript);
                if let Some(index) = subscript.and_then(|at| self.element_index(reference, at)) {
                    let element = self.listed_element(name, index);
                    if element.value.is_none() && !self.is_poisoned_element(&key, index) {
                        self.report_unlisted(element.full_name(), reference.range);
                    }
                    items.push(element);
                }
            }
            (None, Some(extent)) if self.simple_value(name).is_none() => {
                let elements = (1..=extent).map(|index| self.listed_element(name, index));
                items.extend(elements.filter(|element| element.value.is_some()));
            }
            (Some(subscript), None) => {
                // Perhaps a function of later systems; a name that is not reserved has no value to list.
                self.report_unlisted(name.clone(), reference.range);
                let Expression::Number { value, .. } = **subscript else {
                    let _ = self.scalar(subscript);
                    return items.push(PrintedItem { name: name.clone(), subscript: None, value: None });
                };
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
                let subscript = Some(value as u32);
                items.push(PrintedItem { name: name.clone(), subscript, value: None });
            }
            (None, _) => {
                let value = self.simple_value(name);
                let poisoned =
                    matches!(self.look_up(name).map(|symbol| &symbol.meaning), Some(Meaning::Poisoned));
                if value.is_none() && !poisoned {
                    self.report_unlisted(name.clone(), reference.range);
                }
                items.push(PrintedItem { name: name.clone(), subscript: None, value });
            }
        }
    }

    /// Tells a name in a list that has no value. APT III prints a remark; a misspelt name is told in the editor, too.
    fn report_unlisted(&mut self, name: SmolStr, range: TextRange) {
        let similar = self.names_like(&name, std::iter::empty());
        self.report(FindingKind::ListedUndefined { name, similar }, range);
    }

    /// Whether an element of an array has lost its value by a mistake that has been told.
    fn is_poisoned_element(&self, key: &str, index: u32) -> bool {
        let meaning = self.look_up(key).map(|symbol| &symbol.meaning);
        matches!(meaning, Some(Meaning::Array(array)) if matches!(array.get(index), Some(ArrayElement::Poisoned)))
    }

    /// The value of a name without subscript.
    fn simple_value(&self, name: &str) -> Option<Value> {
        match &self.look_up(name)?.meaning {
            Meaning::Scalar(number) => Some(Value::Scalar(*number)),
            Meaning::Geometry(stored) => Some(self.shown(stored)),
            _ => None,
        }
    }

    /// An element of an array, perhaps without value.
    fn listed_element(&self, name: &SmolStr, index: u32) -> PrintedItem {
        let element = match self.look_up(&self.array_key(name)).map(|symbol| &symbol.meaning) {
            Some(Meaning::Array(array)) => array.get(index),
            _ => None,
        };
        let value = match element {
            Some(ArrayElement::Scalar(number)) => Some(Value::Scalar(*number)),
            Some(ArrayElement::Geometry(stored)) => Some(self.shown(stored)),
            Some(ArrayElement::Poisoned) | None => None,
        };
        PrintedItem { name: name.clone(), subscript: Some(index), value }
    }

    /// Geometry as a list shows it: in the reference system in force, if it can be carried there.
    fn shown(&self, stored: &Stored) -> Value {
        let seen = stored.seen_from(self.state.system.as_ref());
        Value::Geometry(seen.unwrap_or_else(|| stored.geometry.clone()))
    }

    /// A nested definition, a nested point or an expression.
    fn listed_nest(&mut self, argument: &Argument, items: &mut Vec<PrintedItem>) {
        let mut operands = Vec::new();
        if self.operand(argument, &mut operands).is_none() {
            return;
        }
        for item in operands {
            let (name, value) = match item.operand {
                Operand::Scalar(number) => (SmolStr::default(), Value::Scalar(number)),
                Operand::Geometry { name, geometry } => (name, Value::Geometry(geometry)),
                _ => continue,
            };
            let name = if name.is_empty() { NESTED } else { name };
            items.push(PrintedItem { name, subscript: None, value: Some(value) });
        }
    }

    /// PRINT/ON: lists what is being defined.
    pub(super) fn list_definition(
        &mut self,
        name: &SmolStr,
        subscript: Option<u32>,
        stored: &Stored,
        range: TextRange,
    ) {
        if !self.state.print_all || stored.geometry.kind().canonical_count().is_none() {
            return;
        }
        let value = Some(Value::Geometry(stored.geometry.clone()));
        let item = PrintedItem { name: name.clone(), subscript, value };
        self.list(ListingKind::Item { format: PrintFormat::Full, item }, range);
    }

    // READ/1.

    /// READ/1[,names]: takes back the dump on the cards that follow; the names replace those of the dump in order.
    fn read_dump(&mut self, major: Major<'_>) {
        if self.listing_number(major, &[1.0]).is_none() {
            return;
        }
        let mut names = Vec::new();
        for argument in major.arguments.get(1..).unwrap_or_default() {
            match argument {
                Argument::Expression(Expression::Reference(reference)) if reference.subscript.is_none() => {
                    names.push(reference.name.text.clone());
                }
                other => {
                    return self.wrong_operand(
                        major,
                        Expected::Name,
                        Found::Scalar,
                        LISTING_FORM,
                        other.range(),
                    );
                }
            }
        }
        let from = self.cards.next;
        let read = cards::read(&mut || self.cards.card());
        match read {
            Ok(items) => self.take_dump(&items, &names, major.range),
            Err(fault) => {
                // What follows is no dump: it is part of the program.
                self.cards.next = from;
                self.report(FindingKind::Cards { fault }, major.range);
            }
        }
    }

    /// Gives the names of a dump their values.
    fn take_dump(&mut self, items: &[Dumped], names: &[SmolStr], range: TextRange) {
        let mut known: Vec<SmolStr> = Vec::new();
        for item in items {
            let position = known.iter().position(|name| *name == item.name).unwrap_or_else(|| {
                known.push(item.name.clone());
                known.len() - 1
            });
            let text = names.get(position).unwrap_or(&item.name).clone();
            self.take_item(text, item, range);
        }
    }

    /// One item of a dump.
    fn take_item(&mut self, text: SmolStr, item: &Dumped, range: TextRange) {
        let is_scalar = matches!(item.value, Value::Scalar(_));
        let changes = match self.look_up(&text).map(|symbol| &symbol.meaning) {
            Some(Meaning::Scalar(_)) => !is_scalar,
            Some(Meaning::Geometry(_)) => is_scalar,
            _ => false,
        };
        if changes {
            return self.report(FindingKind::CardSort { name: text }, range);
        }
        let subscript = item.subscript.map(f64::from);
        let reference = Reference {
            name: Name { text, range },
            subscript: subscript.map(|value| Box::new(Expression::Number { value, range })),
            range,
        };
        if let Some(subscript) = item.subscript
            && let Some(extent) = self.array_extent(&reference)
            && subscript > extent
        {
            let name = reference.name.text;
            let mut finding = self.finding(
                FindingKind::SubscriptRange { name, subscript: f64::from(subscript), extent },
                range,
            );
            finding.number = Some(CARD_SUBSCRIPT);
            return self.add(finding);
        }
        match &item.value {
            Value::Scalar(number) => self.assign_scalar(&reference, Some(*number)),
            Value::Geometry(geometry) => {
                let stored = Stored { geometry: geometry.clone(), system: self.state.system.clone() };
                self.define_stored(&reference, Some(stored), true);
            }
        }
    }
}

/// An item by its full name, such as `A(3)`.
fn named_item(full: &SmolStr, value: Value) -> PrintedItem {
    let split = full.split_once('(').and_then(|(name, rest)| {
        let subscript: u32 = rest.trim_end_matches(')').parse().ok()?;
        Some((SmolStr::new(name), subscript))
    });
    match split {
        Some((name, subscript)) => PrintedItem { name, subscript: Some(subscript), value: Some(value) },
        None => PrintedItem { name: full.clone(), subscript: None, value: Some(value) },
    }
}

//! Writes CL text as the description of a system says it.

use std::{collections::VecDeque, mem::take};

use apt_geometry::{Vec3, patience::Patience};

use super::{
    detect::{ClDialect, is_title},
    dialects::{Axes, COUNTING, Circles, Form, TextForm},
    number::{Field, shortest},
    sheet::Sheet,
    statements::is_displayed,
    words::{TOOL_PATH, number},
};
use crate::{
    arc::{PathArc, Tolerance, path_arc, reads_as_circle},
    conversion::{ConversionNoteKind as Kind, Item, Notes, QUOTATION, What, same_axis, unit_word},
    geometry::SpaceCircle,
    record::{ClKind, ClPoint, ClRecord, ClWord, ends_before},
};

mod arc;

/// Writes records as APT CL text, one statement or position per line, deterministic.
///
/// The text reads back with [`super::read_text`] to records that say the same; a tool axis that a record does not tell, as that of a position
/// which COPY has turned without MULTAX, is not told. A circle that the tool does not go about (a drive surface
/// that it only touches with a tilted axis) stands in a remark: in text, a CIRCLE is the way of the tool or one about the same axis.
pub fn write_text(records: &[ClRecord]) -> String {
    written(records, Patience::default()).0
}

/// The same; `None` when who waits has given up before the end.
pub fn write_text_until(records: &[ClRecord], patience: Patience<'_>) -> Option<String> {
    let (text, _) = written(records, patience);
    (!patience.was_over()).then_some(text)
}

/// The same, with the zero-based line on which each record begins.
pub fn write_text_with_lines(records: &[ClRecord]) -> (String, Vec<u32>) {
    written(records, Patience::default())
}

/// The same; `None` when who waits has given up before the end.
pub fn write_text_with_lines_until(
    records: &[ClRecord],
    patience: Patience<'_>,
) -> Option<(String, Vec<u32>)> {
    let written = written(records, patience);
    (!patience.was_over()).then_some(written)
}

/// The text up to the end, or to where who waits gives up.
fn written(records: &[ClRecord], patience: Patience<'_>) -> (String, Vec<u32>) {
    let mut notes = Notes::default();
    let mut writer = Writer { as_recorded: true, ..Writer::new(Form::of(ClDialect::Generic), &mut notes) };
    let mut lines = Vec::with_capacity(records.len());
    for record in records {
        if ends_before(record.position_count(), patience) {
            break;
        }
        lines.push(u32::try_from(writer.sheet.lines()).unwrap_or(u32::MAX));
        writer.begin((record.isn, record.source));
        writer.record(&record.kind);
    }
    (writer.sheet.text(patience), lines)
}

/// Writes items in a form; less where who waits gives up before the end.
pub(crate) fn write(
    items: &VecDeque<Item>,
    form: &Form,
    notes: &mut Notes,
    patience: Patience<'_>,
) -> String {
    let mut writer = Writer::new(form, notes);
    writer.title(items);
    for item in items {
        if ends_before(item.position_count(), patience) {
            break;
        }
        writer.item(item);
    }
    writer.sheet.text(patience)
}

/// A statement as one line of APT CL text.
pub(crate) fn statement_text(word: &str, arguments: &[ClWord]) -> String {
    let list: Vec<String> = arguments
        .iter()
        .map(|argument| match argument {
            ClWord::Number(number) => shortest(*number),
            ClWord::Word(text) => spelled(text, word == TOOL_PATH),
        })
        .collect();
    if list.is_empty() { word.to_owned() } else { format!("{word}/{}", list.join(",")) }
}

/// A word; in quotation marks where it would not be read as it stands. Names of operations are not quoted.
fn spelled(text: &str, name: bool) -> String {
    let upper = text.to_ascii_uppercase() == text;
    let plain = text.trim() == text && !text.contains([',', '$']) && upper && number(text).is_none();
    if name || plain || text.contains('\'') { text.to_owned() } else { format!("'{text}'") }
}

impl Form {
    /// A parameter of CUTTER and its kin.
    pub(crate) fn size_text(&self, argument: &ClWord) -> String {
        match argument {
            ClWord::Number(value) => self.size.text(*value).trim().to_owned(),
            ClWord::Word(text) => spelled(text, false),
        }
    }
}

struct Writer<'a> {
    form: &'a Form,
    notes: &'a mut Notes,
    sheet: Sheet,
    /// Statement number and source of what is being written.
    place: (u32, u32),
    /// Nothing of it has been written yet.
    fresh: bool,
    /// The circle along which the next motion goes.
    circle: Option<SpaceCircle>,
    /// Where the tool is.
    at: Option<ClPoint>,
    tolerance: Tolerance,
    /// MULTAX as it has been written.
    multax: bool,
    /// MULTAX as the source says it.
    source_multax: bool,
    /// The tool axis that a reader has; none has been written yet where it is the one that counts without words.
    axis: Vec3,
    axis_told: bool,
    rapid: bool,
    /// No tool axis is told but those that the records tell.
    as_recorded: bool,
}

impl<'a> Writer<'a> {
    fn new(form: &'a Form, notes: &'a mut Notes) -> Self {
        Writer {
            form,
            notes,
            sheet: Sheet::new(form.layout),
            place: (0, 0),
            fresh: true,
            circle: None,
            at: None,
            tolerance: Tolerance::default(),
            multax: false,
            source_multax: false,
            axis: Vec3::z(),
            axis_told: false,
            rapid: false,
            as_recorded: false,
        }
    }
}

impl Writer<'_> {
    fn begin(&mut self, place: (u32, u32)) {
        self.place = place;
        self.fresh = true;
    }

    /// The remark by which the system is recognised, if none of those that there are is one.
    fn title(&mut self, items: &VecDeque<Item>) {
        let sign = |item: &Item| match &item.what {
            What::Remark(text) => is_title(text, self.form.dialect),
            What::Record(_) => false,
        };
        if let Some(title) = self.form.title
            && !items.iter().take(TITLE_LINES).any(sign)
        {
            self.remark(title);
        }
    }

    fn item(&mut self, item: &Item) {
        self.begin((item.isn, item.source));
        match &item.what {
            What::Remark(text) => self.remark(text),
            What::Record(kind) => self.record(kind),
        }
    }

    fn record(&mut self, kind: &ClKind) {
        self.tolerance.take(kind);
        match kind {
            ClKind::Text { word, text, .. } => self.text(word, text),
            ClKind::Postprocessor { word, arguments, .. } => {
                if word == "RAPID" {
                    let off = ClWord::Word("OFF".into());
                    self.rapid = !arguments.contains(&off);
                }
                self.words(word, arguments, self.form.value);
            }
            ClKind::Control { word, arguments, .. } => self.words(word, arguments, self.form.size),
            ClKind::Arc { center, axis, radius, .. } => {
                self.circle = Some(SpaceCircle { center: *center, axis: *axis, radius: *radius });
            }
            ClKind::Motion { from, points, .. } => self.motion(*from, points),
            ClKind::MultipleAxes(on) => {
                self.source_multax = *on;
                self.multiple_axes(*on);
            }
            ClKind::Units(units) => self.statement("UNITS", &[unit_word(*units).to_owned()]),
            ClKind::End => self.statement("FINI", &[]),
        }
    }

    fn multiple_axes(&mut self, on: bool) {
        self.multax = on;
        let words = if on { self.form.multax } else { &["OFF"] };
        let words: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        self.statement("MULTAX", &words);
    }

    fn motion(&mut self, from: bool, points: &[ClPoint]) {
        let circle = self.circle.take();
        let along = circle.is_some_and(|circle| !from && self.along(&circle, points));
        if !along {
            for (index, point) in points.iter().enumerate() {
                if index > 0 && self.rapid && !from {
                    // It counts for one position.
                    self.statement("RAPID", &[]);
                }
                let bare = index > 0 && !self.rapid && !from;
                self.position(if from { "FROM" } else { self.form.goto }, point, bare);
            }
        }
        self.at = points.last().copied().or(self.at);
        self.rapid &= from;
    }

    /// MULTAX before positions whose tool axis would be lost.
    fn prepare_axis(&mut self, points: &[ClPoint]) {
        if self.as_recorded {
            return;
        }
        let lost = |point: &ClPoint| {
            let told = point.with_axis && self.form.axes == Axes::WhereTold;
            !told && !same_axis(&point.axis, &self.axis)
        };
        if self.form.axes != Axes::WhereChanged && !self.multax && points.iter().any(lost) {
            self.notes.add(self.place, Kind::AxisTold);
            self.multiple_axes(true);
        }
    }

    /// One position: a statement, or numbers alone where it goes on with the record.
    fn position(&mut self, word: &str, point: &ClPoint, goes_on: bool) {
        self.prepare_axis(std::slice::from_ref(point));
        let told = match self.form.axes {
            _ if self.as_recorded => point.with_axis,
            Axes::UnderMultax => self.multax,
            Axes::WhereTold => self.multax || point.with_axis,
            Axes::WhereChanged => {
                let again = point.with_axis && !(self.source_multax && self.axis_told);
                again || !same_axis(&point.axis, &self.axis)
            }
        };
        let mut words = self.fields(&point.position, self.form.position);
        let mut row = None;
        if told {
            row = self.form.axis_row.then_some(words.len());
            words.extend(self.fields(&point.axis, self.form.axis));
            (self.axis, self.axis_told) = (point.axis, true);
        }
        if goes_on && self.form.bare_rows {
            return self.sheet.numbers(&words, row);
        }
        let start = self.start(word);
        self.sheet.statement(&start, &words, row);
    }

    fn fields(&self, vector: &Vec3, field: Field) -> Vec<String> {
        vector.iter().map(|value| field.text(*value)).collect()
    }

    /// A word with the number of its statement, where the form has it; what goes on with a record has none.
    fn start(&mut self, word: &str) -> String {
        match (self.form.numbered, take(&mut self.fresh)) {
            (false, _) => word.to_owned(),
            (true, true) => format!("N{:<5}, {word}", self.place.0.max(1)),
            (true, false) => format!("{}{word}", self.form.layout.indent),
        }
    }

    fn statement(&mut self, word: &str, arguments: &[String]) {
        let start = self.start(word);
        self.sheet.statement(&start, arguments, None);
        // Whatever follows is a statement of its own.
        self.fresh = true;
    }

    fn words(&mut self, word: &str, arguments: &[ClWord], field: Field) {
        let counts = self.form.counts && COUNTING.contains(&word);
        let list: Vec<String> = arguments
            .iter()
            .map(|argument| match argument {
                ClWord::Number(value) if counts && value.fract() == 0.0 => format!("{value:.0}"),
                ClWord::Number(value) => field.text(*value),
                ClWord::Word(text) => spelled(text, word == TOOL_PATH),
            })
            .collect();
        self.statement(word, &list);
    }

    /// Free text is never continued by `$`, which would be part of it.
    fn text(&mut self, word: &str, text: &str) {
        let text = text.trim();
        let known = self.form.texts.iter().find(|(known, _)| *known == word).map(|(_, form)| *form);
        let quoted = text.len() > 1 && text.starts_with('\'') && text.ends_with('\'');
        // A displayed text that looks like a switch.
        let quoted_once = word == "DISPLY" && !is_displayed(&format!("/{text}"));
        // Without the slash it would be no text.
        let usual = if word == "DISPLY" { TextForm::Slash } else { TextForm::Blank };
        let behind = match known.unwrap_or(usual) {
            TextForm::Quoted => format!("/'{text}'"),
            _ if quoted_once => format!("/'{text}'"),
            // A reader takes one pair of quotation marks and one slash off.
            _ if quoted => format!("/ '{text}'"),
            TextForm::Blank if text.starts_with('/') => format!(" / {text}"),
            TextForm::Blank => format!(" {text}"),
            TextForm::Slash => format!("{}{text}", self.form.layout.slash),
        };
        let start = self.start(word);
        let line = format!("{start}{behind}");
        if self.form.numbered {
            self.rows_of_text(&line);
        } else {
            self.sheet.line(&line);
        }
        self.fresh = true;
    }

    /// Rows of PostWorks: a text that is longer goes on in the next one after `~`.
    fn rows_of_text(&mut self, line: &str) {
        let room = self.form.layout.columns - 1;
        let mut rest = line;
        while rest.chars().count() > room {
            let within = rest.char_indices().nth(room).map_or(rest.len(), |(at, _)| at);
            // Blanks at the end of the row count, those at the beginning of the next one would, too.
            let Some(blank) = rest[..within].rfind(' ').filter(|at| *at > 0) else { break };
            self.sheet.line(&format!("{}~", &rest[..=blank]));
            rest = &rest[blank + 1..];
        }
        self.sheet.line(rest);
    }

    /// A remark; the pseudo statements of Creo are lists and go on in the next line.
    fn remark(&mut self, text: &str) {
        match text.strip_prefix("->").and_then(|pseudo| pseudo.split_once('/')) {
            Some((word, list)) if self.form.dialect == ClDialect::Creo && !list.trim().is_empty() => {
                let list: Vec<String> = list.split(',').map(|one| one.trim().to_owned()).collect();
                self.sheet.statement(&format!("$$->{}", word.trim_end()), &list, None);
            }
            _ => self.sheet.line(&format!("$${text}")),
        }
    }

    /// A statement that the form has no use for here.
    fn quoted(&mut self, text: &str) {
        self.sheet.line(&format!("$${QUOTATION}{text}"));
    }

    /// Writes a motion along a circle; whether the form could say it so.
    fn along(&mut self, circle: &SpaceCircle, points: &[ClPoint]) -> bool {
        let tolerance = self.tolerance.width();
        let start = self.at;
        let arc = start.and_then(|start| path_arc(circle, &start, points, tolerance));
        let written = match (self.form.circles, arc, start) {
            _ if self.rapid => false,
            (Circles::AsRecorded, _, start) => {
                let start = start.map(|start| start.position);
                let told = reads_as_circle(circle, start.as_ref(), points, tolerance);
                if told {
                    self.circle_before(circle, points);
                }
                told
            }
            (Circles::BeforePositions, Some(arc), _) => {
                self.circle_before(&arc.circle, points);
                true
            }
            (_, Some(arc), Some(start)) => {
                self.by_end(&arc, &start, points);
                true
            }
            _ => false,
        };
        if !written {
            self.notes.add(self.place, Kind::PositionsAlone);
            let numbers = circle.center.iter().chain(circle.axis.iter()).chain([&circle.radius]);
            let list: Vec<ClWord> = numbers.map(|number| ClWord::Number(*number)).collect();
            self.quoted(&statement_text("CIRCLE", &list));
        }
        written
    }

    fn by_end(&mut self, arc: &PathArc, start: &ClPoint, points: &[ClPoint]) {
        if let Some(misfit) = arc.misfit(start, points) {
            self.notes.add(self.place, Kind::WithoutPositions { misfit });
        }
        self.arc_by_end(arc, start, points);
    }
}

/// Lines among which a title is looked for: detection looks at no more.
const TITLE_LINES: usize = 50;

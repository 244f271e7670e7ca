//! A tolerant reader for the CL text of all systems.

mod arc;
mod driven;

use apt_geometry::{Vec3, patience::Patience, pieces::Pieces};
use smol_str::SmolStr;

use self::{
    arc::{Direction, PendingArc},
    driven::driven,
};
use super::{
    detect::{ClDialect, detect},
    statements::{Statement, statements},
    words::{Shape, joined, shape},
};
use crate::{
    arc::Tolerance,
    geometry::SpaceCircle,
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
};

/// Deviation from unit length above which a tool axis is reported.
const AXIS_LENGTH_TOLERANCE: f64 = 1e-4;

/// Something in CL text that could not be taken as it stands.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("line {}: {kind}", line + 1)]
pub struct ReadError {
    /// Statement number.
    pub isn: u32,
    /// Zero-based line.
    pub line: u32,
    /// What is wrong.
    pub kind: ReadErrorKind,
}

/// What is wrong with a CL statement.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReadErrorKind {
    /// No statement can be made of the line.
    #[error("not a CL statement")]
    Unreadable,
    /// A definition: the file is a part program.
    #[error("{name} is defined, which CL text cannot do")]
    Definition {
        /// The name.
        name: SmolStr,
    },
    /// A statement that moves the tool in a way that this reader does not know; the path has a gap.
    #[error("{word} is not read")]
    NotRead {
        /// The word.
        word: SmolStr,
    },
    /// A number of coordinates that makes no position.
    #[error("{word} with {count} values")]
    WrongCount {
        /// The word.
        word: SmolStr,
        /// How many there are.
        count: usize,
    },
    /// Something that is no number stands where a number must.
    #[error("{word}: argument {position} is no number")]
    NotNumber {
        /// The word.
        word: SmolStr,
        /// Which argument, from 1.
        position: usize,
    },
    /// An increment without a position before it.
    #[error("GODLTA without a position before it")]
    NoPosition,
    /// Numbers alone without a GOTO before them.
    #[error("positions without GOTO")]
    NoGoto,
    /// A tool axis that is not a unit vector; it has been normalised.
    #[error("the tool axis has length {length}")]
    AxisLength {
        /// Its length.
        length: f64,
    },
    /// A tool axis without direction; the previous axis stays.
    #[error("the tool axis has length zero")]
    AxisZero,
    /// A CIRCLE with an axis or radius that makes no circle.
    #[error("{word} describes no circle")]
    NoCircle {
        /// The word.
        word: SmolStr,
    },
    /// Start or end of an arc off its circle; the arc is read as a straight line.
    #[error("the arc ends {distance} off its circle")]
    OffCircle {
        /// Distance from the circle.
        distance: f64,
    },
    /// A unit that is not known.
    #[error("unit {unit} is not known")]
    UnknownUnit {
        /// As it is written.
        unit: SmolStr,
    },
}

/// Reads generic CL text. Everything that can be read is, with one error for each statement that cannot.
///
/// The record's `isn` is the statement's number (blank lines and remarks count, continuation lines do not), its
/// `source` the zero-based line. Arcs without inner points (`CIRCLE/` before a single GOTO, `MOVARC/`) become a
/// circle record and points on the arc, the form in which APT III writes them; so do ARCMOV along the circle of ARCDAT, CW and CCW.
/// MOVNRB passes through, and its chords are the path. Post-processor words have no code.
/// A circle that CATIA states as the drive surface of one GOFWD, with INDIRV before it, becomes the same.
pub fn read_text(text: &str) -> (Vec<ClRecord>, Vec<ReadError>) {
    let (read, errors) = read_with_remarks(text);
    (read.records, errors)
}

/// The same with the remarks of the text.
pub fn read_with_remarks(text: &str) -> (ClText, Vec<ReadError>) {
    read(text, Patience::default())
}

/// The same; `None` when who waits has given up before the end.
pub fn read_with_remarks_until(text: &str, patience: Patience<'_>) -> Option<(ClText, Vec<ReadError>)> {
    let read = read(text, patience);
    (!patience.was_over()).then_some(read)
}

/// What the text says up to its end, or to where who waits gives up.
fn read(text: &str, patience: Patience<'_>) -> (ClText, Vec<ReadError>) {
    let circles_before_end = detect(text) == Some(ClDialect::Nx);
    let mut reader = Reader { circles_before_end, ..Reader::default() };
    for statement in statements(text).take_while(|_| !patience.ends_after(1)) {
        reader.statement(&statement);
    }
    reader.end_arc();
    reader.end_nurbs();
    let Reader { records, remarks, shortened, errors, .. } = reader;
    (ClText { records: records.joined(patience), remarks, shortened }, errors)
}

/// What CL text says.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ClText {
    /// The records; `source` is the zero-based line of each.
    pub records: Vec<ClRecord>,
    /// What only people read, in order of the lines.
    pub remarks: Vec<Remark>,
    /// Statements of which the records do not hold all, in order of the lines.
    pub shortened: Vec<Shortened>,
}

/// The same, of records that something else holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClFile<'a> {
    /// As [`ClText::records`].
    pub records: &'a [ClRecord],
    /// As [`ClText::remarks`].
    pub remarks: &'a [Remark],
    /// As [`ClText::shortened`].
    pub shortened: &'a [Shortened],
}

impl<'a> From<&'a ClText> for ClFile<'a> {
    fn from(text: &'a ClText) -> Self {
        Self { records: &text.records, remarks: &text.remarks, shortened: &text.shortened }
    }
}

/// A statement of which a part is not kept: the tolerances and the cutter that NX writes behind the radius of a CIRCLE.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shortened {
    /// Zero-based line of the statement.
    pub line: u32,
    /// Its word.
    pub word: SmolStr,
}

/// A remark of CL text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// Zero-based line of the statement that it stands at.
    pub line: u32,
    /// What stands behind the `$$`, with the blanks at its beginning; rows that go on are joined.
    pub text: String,
}

#[derive(Default)]
struct Reader {
    records: Pieces<ClRecord>,
    errors: Vec<ReadError>,
    isn: u32,
    line: u32,
    position: Option<Vec3>,
    axis: Option<Vec3>,
    multax: bool,
    arc: Option<PendingArc>,
    /// What ARCDAT said last.
    arc_data: Option<SpaceCircle>,
    nurbs: Option<NurbsCurve>,
    /// What INDIRV or INDIRP said last.
    direction: Option<Direction>,
    /// A CIRCLE has one position behind it, its end.
    circles_before_end: bool,
    tolerance: Tolerance,
    remarks: Vec<Remark>,
    shortened: Vec<Shortened>,
}

/// A MOVNRB that is not off yet.
struct NurbsCurve {
    isn: u32,
    line: u32,
    /// A position has come since MOVNRB/ON.
    moved: bool,
}

impl Reader {
    fn statement(&mut self, statement: &Statement) {
        (self.isn, self.line) = (statement.number, statement.line);
        let remark = |text: &String| Remark { line: statement.line, text: text.clone() };
        self.remarks.extend(statement.remarks.iter().map(remark));
        if let Some((word, text)) = &statement.free {
            self.end_arc();
            return self.push(ClKind::Text { word: (*word).into(), code: None, text: text.as_str().into() });
        }
        let told = self.errors.len();
        let mut text = statement.text.as_str();
        loop {
            if let Some(driven) = driven(text) {
                self.end_arc();
                return self.driven_arc(driven);
            }
            let Some((word, behind)) = joined(text) else { break };
            self.major(&word, Vec::new());
            if self.errors.len() > told {
                return;
            }
            text = behind;
        }
        match shape(text) {
            Shape::Blank => {}
            Shape::Numbers(numbers) => self.more_positions(&numbers),
            Shape::Major { word, arguments } => self.major(&word, arguments),
            Shape::Definition(name) => self.error(ReadErrorKind::Definition { name }),
            Shape::Unreadable => self.error(ReadErrorKind::Unreadable),
        }
    }

    fn push(&mut self, kind: ClKind) {
        self.records.push(ClRecord { isn: self.isn, source: self.line, kind });
    }

    fn error(&mut self, kind: ReadErrorKind) {
        self.errors.push(ReadError { isn: self.isn, line: self.line, kind });
    }

    fn major(&mut self, word: &SmolStr, arguments: Vec<ClWord>) {
        match word.as_str() {
            "FROM" | "GOTO" => return self.absolute(word, &arguments),
            "GODLTA" => return self.increment(word, &arguments),
            _ => self.end_arc(),
        }
        match word.as_str() {
            "CIRCLE" | "MOVARC" => self.circle(word, &arguments),
            "ARCDAT" => self.arc_data = self.circle_of(word, &arguments),
            "ARCMOV" => self.arc_move(word, &arguments),
            "CW" | "CCW" => self.worded_arc(word, &arguments),
            "MOVNRB" => self.nurbs_curve(word, arguments),
            "MULTAX" => {
                self.multax =
                    !arguments.iter().any(|argument| matches!(argument, ClWord::Word(off) if off == "OFF"));
                self.push(ClKind::MultipleAxes(self.multax));
            }
            "UNITS" => self.units(&arguments),
            "FINI" => self.push(ClKind::End),
            "CUT" | "DNTCUT" => self.control(word, 1, Vec::new()),
            "2DCALC" | "3DCALC" => self.control(word, 2, Vec::new()),
            "TOLER" => self.control(word, 3, arguments),
            "INTOL" => self.control(word, 4, arguments),
            "OUTTOL" => self.control(word, 5, arguments),
            "CUTTER" => self.control(word, 6, arguments),
            "INDIRV" | "INDIRP" => self.indirection(word, &arguments),
            // The part surface of a circle that stands in the statement itself says nothing more about it.
            "AUTOPS" | "PSIS" => {}
            "TLON" | "TLLFT" | "TLRGT" | "GOFWD" | "GOLFT" | "GORGT" | "GOBACK" | "GOUP" | "GODOWN"
            | "GO" => {
                self.error(ReadErrorKind::NotRead { word: word.clone() });
            }
            _ => self.push(ClKind::Postprocessor { word: word.clone(), code: None, arguments }),
        }
    }

    fn control(&mut self, word: &SmolStr, subclass: u16, arguments: Vec<ClWord>) {
        let kind = ClKind::Control { word: word.clone(), code: [6000, subclass], arguments };
        self.tolerance.take(&kind);
        self.push(kind);
    }

    fn units(&mut self, arguments: &[ClWord]) {
        let unit = match arguments.first() {
            Some(ClWord::Word(word)) => word.clone(),
            _ => SmolStr::default(),
        };
        match unit.as_str() {
            "MM" => self.push(ClKind::Units(Units::Millimeters)),
            "INCH" | "INCHES" | "IN" => self.push(ClKind::Units(Units::Inches)),
            _ => self.error(ReadErrorKind::UnknownUnit { unit }),
        }
    }

    fn numbers(&mut self, word: &SmolStr, arguments: &[ClWord]) -> Option<Vec<f64>> {
        let mut numbers = Vec::with_capacity(arguments.len());
        for (at, argument) in arguments.iter().enumerate() {
            match argument {
                ClWord::Number(number) => numbers.push(*number),
                ClWord::Word(_) => {
                    self.error(ReadErrorKind::NotNumber { word: word.clone(), position: at + 1 });
                    return None;
                }
            }
        }
        Some(numbers)
    }

    fn absolute(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some(numbers) = self.numbers(word, arguments) else { return };
        let Some(point) = self.point(word, &numbers) else { return };
        self.position = Some(point.position);
        if word == "FROM" {
            self.end_arc();
            self.push(ClKind::Motion { from: true, surface: SmolStr::default(), points: vec![point] });
        } else {
            self.goto(point, true);
        }
    }

    /// A position from three numbers, or from six with a tool axis.
    fn point(&mut self, word: &SmolStr, numbers: &[f64]) -> Option<ClPoint> {
        match *numbers {
            [x, y, z] => Some(self.at(Vec3::new(x, y, z), false)),
            [x, y, z, i, j, k] => {
                self.take_axis(Vec3::new(i, j, k));
                Some(self.at(Vec3::new(x, y, z), true))
            }
            _ => {
                self.error(ReadErrorKind::WrongCount { word: word.clone(), count: numbers.len() });
                None
            }
        }
    }

    fn at(&self, position: Vec3, with_axis: bool) -> ClPoint {
        ClPoint { position, axis: self.axis.unwrap_or_else(Vec3::z), with_axis: with_axis || self.multax }
    }

    fn take_axis(&mut self, axis: Vec3) {
        let length = axis.norm();
        if !(length > 0.0 && length.is_finite()) {
            return self.error(ReadErrorKind::AxisZero);
        }
        if (length - 1.0).abs() > AXIS_LENGTH_TOLERANCE {
            self.error(ReadErrorKind::AxisLength { length });
        }
        // Dividing a unit vector by a length one rounding away from 1 would change numbers that are right.
        self.axis = Some(if (length - 1.0).abs() <= f64::EPSILON * 4.0 { axis } else { axis / length });
    }

    fn increment(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some(numbers) = self.numbers(word, arguments) else { return };
        let Some(start) = self.position else { return self.error(ReadErrorKind::NoPosition) };
        let (by, with_axis) = match *numbers {
            [distance] => (self.axis.unwrap_or_else(Vec3::z) * distance, false),
            [x, y, z] => (Vec3::new(x, y, z), false),
            [x, y, z, i, j, k] => {
                self.take_axis(Vec3::new(i, j, k));
                (Vec3::new(x, y, z), true)
            }
            _ => return self.error(ReadErrorKind::WrongCount { word: word.clone(), count: numbers.len() }),
        };
        let point = self.at(start + by, with_axis);
        self.position = Some(point.position);
        self.goto(point, true);
    }

    fn more_positions(&mut self, numbers: &[f64]) {
        let word = SmolStr::new_static("GOTO");
        let moving = self.arc.as_ref().is_some_and(|arc| !arc.points.is_empty())
            || matches!(self.records.last(), Some(ClRecord { kind: ClKind::Motion { from: false, .. }, .. }));
        if !moving {
            return self.error(ReadErrorKind::NoGoto);
        }
        let Some(point) = self.point(&word, numbers) else { return };
        self.position = Some(point.position);
        self.goto(point, false);
    }

    /// One more position; `fresh` for a statement of its own.
    fn goto(&mut self, point: ClPoint, fresh: bool) {
        if let Some(curve) = &mut self.nurbs {
            curve.moved = true;
        }
        if self.arc.is_some() {
            if self.goes_on_arc(point) {
                return;
            }
            self.end_arc();
        } else if !fresh
            && let Some(ClRecord { kind: ClKind::Motion { from: false, points, .. }, .. }) =
                self.records.last_mut()
        {
            return points.push(point);
        }
        self.push(ClKind::Motion { from: false, surface: SmolStr::default(), points: vec![point] });
    }

    /// MOVNRB: the curve is data for a control that knows it; the positions between ON and OFF are its chords, and those
    /// are the path here.
    fn nurbs_curve(&mut self, word: &SmolStr, arguments: Vec<ClWord>) {
        match arguments.first() {
            Some(ClWord::Word(switch)) if switch == "ON" => {
                self.end_nurbs();
                self.nurbs = Some(NurbsCurve { isn: self.isn, line: self.line, moved: false });
            }
            Some(ClWord::Word(switch)) if switch == "OFF" => self.end_nurbs(),
            Some(ClWord::Word(switch)) if switch == "NEXT" => {}
            Some(ClWord::Number(1.0 | 2.0 | 3.0)) => {}
            Some(ClWord::Word(other)) => return self.error(ReadErrorKind::NotRead { word: other.clone() }),
            _ => {
                return self.error(ReadErrorKind::WrongCount { word: word.clone(), count: arguments.len() });
            }
        }
        self.push(ClKind::Postprocessor { word: word.clone(), code: None, arguments });
    }

    /// A curve without chords has no path here.
    fn end_nurbs(&mut self) {
        if let Some(curve) = self.nurbs.take().filter(|curve| !curve.moved) {
            let kind = ReadErrorKind::NotRead { word: SmolStr::new_static("MOVNRB") };
            self.errors.push(ReadError { isn: curve.isn, line: curve.line, kind });
        }
    }
}

//! A tolerant reader for generic APT CL text.

use apt_geometry::Vec3;
use smol_str::SmolStr;

use super::{
    statements::{Statement, statements},
    words::{Shape, shape},
};
use crate::{
    geometry::SpaceCircle,
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
};

/// Deviation from unit length above which a tool axis is reported.
const AXIS_LENGTH_TOLERANCE: f64 = 1e-4;
/// Distance from a CIRCLE, relative to its radius, within which a point belongs to it.
const ON_CIRCLE_FRACTION: f64 = 1e-3;
/// Distance, relative to the radius, within which start and end of an arc are one point.
const SAME_POINT_FRACTION: f64 = 1e-6;
/// Arguments of `CIRCLE/` and `MOVARC/` up to the radius.
const CIRCLE_ARGUMENTS: usize = 7;

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
pub fn read_text(text: &str) -> (Vec<ClRecord>, Vec<ReadError>) {
    let mut reader = Reader::default();
    for statement in statements(text) {
        reader.statement(&statement);
    }
    reader.end_arc();
    reader.end_nurbs();
    (reader.records, reader.errors)
}

#[derive(Default)]
struct Reader {
    records: Vec<ClRecord>,
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
}

/// A MOVNRB that is not off yet.
struct NurbsCurve {
    isn: u32,
    line: u32,
    /// A position has come since MOVNRB/ON.
    moved: bool,
}

/// A circle whose points are still coming in.
struct PendingArc {
    circle: SpaceCircle,
    start: Option<Vec3>,
    /// Signed sweep, where the file says it.
    sweep: Option<f64>,
    points: Vec<ClPoint>,
    isn: u32,
    line: u32,
}

impl Reader {
    fn statement(&mut self, statement: &Statement) {
        (self.isn, self.line) = (statement.number, statement.line);
        if let Some((word, text)) = &statement.free {
            self.end_arc();
            return self.push(ClKind::Text { word: (*word).into(), code: None, text: text.as_str().into() });
        }
        match shape(&statement.text) {
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
            "CUT" => self.control(word, 1, vec![ClWord::Number(0.0)]),
            "DNTCUT" => self.control(word, 1, vec![ClWord::Number(1.0)]),
            "TOLER" => self.control(word, 3, arguments),
            "INTOL" => self.control(word, 4, arguments),
            "OUTTOL" => self.control(word, 5, arguments),
            "CUTTER" => self.control(word, 6, arguments),
            "INDIRV" | "INDIRP" | "TLON" | "TLLFT" | "TLRGT" | "GOFWD" | "GOLFT" | "GORGT" | "GOBACK"
            | "GOUP" | "GODOWN" | "GO" | "AUTOPS" | "PSIS" => {
                self.error(ReadErrorKind::NotRead { word: word.clone() });
            }
            _ => self.push(ClKind::Postprocessor { word: word.clone(), code: None, arguments }),
        }
    }

    fn control(&mut self, word: &SmolStr, subclass: u16, arguments: Vec<ClWord>) {
        self.push(ClKind::Control { word: word.clone(), code: [6000, subclass], arguments });
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
        if let Some(arc) = &mut self.arc {
            let distance = arc.circle.deviation(&point.position);
            let belongs = distance.abs() <= arc.circle.radius * ON_CIRCLE_FRACTION;
            if belongs && (arc.sweep.is_none() || arc.points.is_empty()) {
                arc.points.push(point);
                return;
            }
            if arc.points.is_empty() {
                self.error(ReadErrorKind::OffCircle { distance });
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

    /// Centre, axis and radius at the head of a list of arguments.
    fn circle_of(&mut self, word: &SmolStr, arguments: &[ClWord]) -> Option<SpaceCircle> {
        let Some(head) = arguments.get(..CIRCLE_ARGUMENTS) else {
            self.error(ReadErrorKind::WrongCount { word: word.clone(), count: arguments.len() });
            return None;
        };
        let numbers = self.numbers(word, head)?;
        let [x, y, z, i, j, k, radius] = numbers[..] else { return None };
        self.circle_about(word, Vec3::new(x, y, z), Vec3::new(i, j, k), radius)
    }

    fn circle_about(&mut self, word: &SmolStr, center: Vec3, axis: Vec3, radius: f64) -> Option<SpaceCircle> {
        let length = axis.norm();
        if !(length > 0.0 && length.is_finite() && radius > 0.0) {
            self.error(ReadErrorKind::NoCircle { word: word.clone() });
            return None;
        }
        Some(SpaceCircle { center, axis: axis / length, radius })
    }

    fn circle(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some(circle) = self.circle_of(word, arguments) else { return };
        let mut sweep = None;
        let mut rest = arguments.get(CIRCLE_ARGUMENTS..).unwrap_or_default().iter();
        while let Some(argument) = rest.next() {
            match argument {
                ClWord::Word(name) if name == "ANGLE" => match rest.next() {
                    Some(ClWord::Number(degrees)) => sweep = Some(degrees.to_radians()),
                    _ => return self.error(ReadErrorKind::NotNumber { word: word.clone(), position: 9 }),
                },
                ClWord::Word(name) => self.error(ReadErrorKind::NotRead { word: name.clone() }),
                // Tolerances and cutter of the long form.
                ClWord::Number(_) => {}
            }
        }
        self.begin_arc(circle, sweep);
    }

    fn begin_arc(&mut self, circle: SpaceCircle, sweep: Option<f64>) {
        let (start, points) = (self.position, Vec::new());
        self.arc = Some(PendingArc { circle, start, sweep, points, isn: self.isn, line: self.line });
    }

    /// `ARCMOV/CLW|CCLW,x,y,z[,a]`: from the present position to the point along the circle of ARCDAT, through `a` degrees
    /// where that is said.
    fn arc_move(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some((ClWord::Word(direction), rest)) = arguments.split_first() else {
            return self.error(ReadErrorKind::WrongCount { word: word.clone(), count: arguments.len() });
        };
        let clockwise = match direction.as_str() {
            "CLW" => true,
            "CCLW" => false,
            _ => return self.error(ReadErrorKind::NotRead { word: direction.clone() }),
        };
        let Some(numbers) = self.numbers(word, rest) else { return };
        let (end, degrees) = match numbers[..] {
            [x, y, z] => (Vec3::new(x, y, z), None),
            [x, y, z, degrees] => (Vec3::new(x, y, z), Some(degrees)),
            _ => return self.error(ReadErrorKind::WrongCount { word: word.clone(), count: arguments.len() }),
        };
        let Some(circle) = self.arc_data else {
            return self.error(ReadErrorKind::NoCircle { word: word.clone() });
        };
        self.turn(circle, clockwise, degrees, end);
    }

    /// `CW/` and `CCW/i,j,k,start,centre,end,radius`.
    fn worded_arc(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some(numbers) = self.numbers(word, arguments) else { return };
        let [i, j, k, x, y, z, cx, cy, cz, ex, ey, ez, radius] = numbers[..] else {
            return self.error(ReadErrorKind::WrongCount { word: word.clone(), count: numbers.len() });
        };
        let (center, axis) = (Vec3::new(cx, cy, cz), Vec3::new(i, j, k));
        let Some(circle) = self.circle_about(word, center, axis, radius) else { return };
        let start = Vec3::new(x, y, z);
        let away = self.position.map_or(f64::INFINITY, |position| (position - start).norm());
        if away > circle.radius * ON_CIRCLE_FRACTION {
            let point = self.at(start, false);
            self.position = Some(start);
            self.goto(point, true);
        }
        self.turn(circle, word == "CW", None, Vec3::new(ex, ey, ez));
    }

    /// An arc to a point; clockwise as seen against the axis.
    fn turn(&mut self, circle: SpaceCircle, clockwise: bool, degrees: Option<f64>, end: Vec3) {
        let axis = if clockwise { -circle.axis } else { circle.axis };
        self.begin_arc(SpaceCircle { axis, ..circle }, degrees.map(|degrees| degrees.abs().to_radians()));
        let point = self.at(end, false);
        self.position = Some(end);
        self.goto(point, true);
        self.end_arc();
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

    /// Turns a pending circle and its points into records.
    fn end_arc(&mut self) {
        let Some(mut arc) = self.arc.take() else { return };
        let (isn, source) = (arc.isn, arc.line);
        let Some(last) = arc.points.last().copied() else { return };
        if arc.points.len() == 1 {
            let off = arc.start.map(|start| arc.circle.deviation(&start));
            match (arc.start, off) {
                (Some(start), Some(off)) if off.abs() <= arc.circle.radius * ON_CIRCLE_FRACTION => {
                    let same = arc.circle.radius * SAME_POINT_FRACTION;
                    let sweep =
                        arc.sweep.unwrap_or_else(|| arc.circle.positive_sweep(&start, &last.position, same));
                    let positions = arc.circle.sample(&start, &last.position, sweep);
                    arc.points = positions.into_iter().map(|position| ClPoint { position, ..last }).collect();
                }
                (_, off) => {
                    let kind = off
                        .map_or(ReadErrorKind::NoPosition, |distance| ReadErrorKind::OffCircle { distance });
                    self.errors.push(ReadError { isn, line: source, kind });
                    let kind =
                        ClKind::Motion { from: false, surface: SmolStr::default(), points: arc.points };
                    return self.records.push(ClRecord { isn, source, kind });
                }
            }
        }
        let SpaceCircle { center, axis, radius } = arc.circle;
        let circle = ClKind::Arc { surface: SmolStr::default(), center, axis, radius };
        self.records.push(ClRecord { isn, source, kind: circle });
        let motion = ClKind::Motion { from: false, surface: SmolStr::default(), points: arc.points };
        self.records.push(ClRecord { isn, source, kind: motion });
    }
}

//! Section 3: VTLAXS, a tool axis whose tilt changes evenly along a path that was computed with a vertical tool
//! (language reference 6.11).
//!
//! Between `VTLAXS/ON,side,alpha,d,r,cutter` and `VTLAXS/OFF,side,beta` the tilt goes from alpha, at the last position
//! before, to beta, at the last position, in proportion to the length of the path. The tool tilts across the direction
//! in which it arrives. Its end is moved so that two things stay where the vertical tool had them: the height of its
//! lowest point, and the line in which the side of the cutter that cuts the wall meets that height. With ZSMALL a flat
//! tool that leans away from the wall keeps its edge on that line and reaches below it.

use std::{collections::BTreeSet, f64::consts::PI};

use apt_geometry::{Vec3, patience::Patience};

use crate::{
    corner::{self, Corner},
    edit::{EditError, EditErrorKind, EditItem},
    record::{ClKind, ClPoint, ClRecord, ClWord, Units, looked_through},
};

/// Largest tilt, degrees.
pub const LARGEST_TILT: f64 = 80.0;
/// Length of an inch in millimeters.
const INCH: f64 = 25.4;
/// A tool position: end and axis.
pub(crate) type Pose = (Vec3, Vec3);
/// Relative difference below which the corner radius is the radius of the cutter.
const RADIUS_FRACTION: f64 = 1e-12;

/// What is wrong with a VTLAXS or WCORN, or with what stands in its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TiltError {
    /// VTLAXS/OFF without an ON before it.
    #[error("VTLAXS/OFF without VTLAXS/ON before it")]
    NotOn,
    /// The program ends without VTLAXS/OFF.
    #[error("VTLAXS/ON without VTLAXS/OFF after it")]
    NotOff,
    /// A second VTLAXS/ON.
    #[error("VTLAXS/ON while it is on")]
    OnTwice,
    /// FROM in the range.
    #[error("FROM between VTLAXS/ON and VTLAXS/OFF")]
    From,
    /// No position before VTLAXS/ON.
    #[error("no motion before VTLAXS/ON")]
    NoMotionBefore,
    /// The positions have no tool axis.
    #[error("VTLAXS without MULTAX")]
    NoAxes,
    /// A tilt beyond the largest.
    #[error("a tilt of {degrees} degrees, at most {LARGEST_TILT} are possible")]
    TooFar {
        /// The tilt.
        degrees: f64,
    },
    /// A corner radius that the cutter cannot have.
    #[error("corner radius {corner} above the radius {radius} of the cutter")]
    CornerRadius {
        /// Corner radius.
        corner: f64,
        /// Radius of the cutter.
        radius: f64,
    },
    /// ZSMALL with a corner radius.
    #[error("ZSMALL with a corner radius of {corner}")]
    RoundedEdge {
        /// Corner radius.
        corner: f64,
    },
    /// Nothing moves in the range.
    #[error("no motion between VTLAXS/ON and VTLAXS/OFF")]
    NoMotion,
    /// A second WCORN in the range.
    #[error("a second WCORN between VTLAXS/ON and VTLAXS/OFF")]
    CornerTwice,
    /// WCORN right after VTLAXS/ON.
    #[error("no motion between VTLAXS/ON and WCORN")]
    NoMotionBeforeCorner,
    /// WCORN right before VTLAXS/OFF.
    #[error("no motion between WCORN and VTLAXS/OFF")]
    NoMotionAfterCorner,
    /// WCORN outside of the range.
    #[error("WCORN outside of VTLAXS/ON and VTLAXS/OFF")]
    CornerOutside,
    /// The path turns towards the wall, or not at all.
    #[error("WCORN where the walls make no inside corner")]
    CornerOpen,
    /// No starting position settles.
    #[error("no starting position for WCORN")]
    NoStartOfCorner,
    /// Neither starting nor ending position settle.
    #[error("no starting and ending position for WCORN")]
    NoWayThroughCorner,
    /// No ending position settles.
    #[error("no ending position for WCORN")]
    NoEndOfCorner,
    /// The path before the corner is too short.
    #[error("the path before WCORN is {length} long, and {wanted} are needed")]
    ShortBeforeCorner {
        /// Length that is needed.
        wanted: f64,
        /// Length of the path.
        length: f64,
    },
    /// The path behind the corner is too short.
    #[error("the path behind WCORN is {length} long, and {wanted} are needed")]
    ShortAfterCorner {
        /// Length that is needed.
        wanted: f64,
        /// Length of the path.
        length: f64,
    },
    /// With ZSMALL the tool leans over one wall and away from the other.
    #[error("WCORN with ZSMALL leans over one wall and away from the other")]
    CornerBothSides,
    /// More steps than [`corner::MOST_STEPS`].
    #[error("WCORN with {steps} steps, at most {} are possible", corner::MOST_STEPS)]
    CornerSteps {
        /// Steps that are asked for.
        steps: f64,
    },
    /// A copied INDEX between the last motion and VTLAXS/ON.
    #[error("INDEX between the last motion and VTLAXS/ON")]
    IndexBefore,
    /// TRACUT in the range.
    #[error("TRACUT between VTLAXS/ON and VTLAXS/OFF")]
    Transform,
    /// COPY in the range.
    #[error("COPY between VTLAXS/ON and VTLAXS/OFF")]
    Copy,
    /// INDEX in the range.
    #[error("INDEX between VTLAXS/ON and VTLAXS/OFF")]
    Index,
    /// A cut vector along the tool: there is no side to tilt to.
    #[error("a cut vector along z")]
    Vertical,
    /// Parameters missing or of the wrong kind.
    #[error("the parameters of {0} are incomplete")]
    Form(&'static str),
    /// A word that the statement does not take there.
    #[error("a word that {0} does not take")]
    Modifier(&'static str),
}

impl TiltError {
    /// The number of the APT III edit phase message, where there is one.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            TiltError::NotOn | TiltError::NotOff => 15,
            TiltError::OnTwice => 16,
            TiltError::From => 17,
            TiltError::NoMotionBefore => 18,
            TiltError::NoAxes => 19,
            TiltError::TooFar { .. } => 20,
            TiltError::CornerRadius { .. } => 21,
            TiltError::RoundedEdge { .. } => 22,
            TiltError::NoMotion => 23,
            TiltError::CornerTwice => 24,
            TiltError::CornerOpen => 25,
            TiltError::NoStartOfCorner => 26,
            TiltError::NoWayThroughCorner => 27,
            TiltError::NoEndOfCorner => 28,
            TiltError::NoMotionBeforeCorner | TiltError::ShortBeforeCorner { .. } => 29,
            TiltError::NoMotionAfterCorner | TiltError::ShortAfterCorner { .. } => 30,
            TiltError::IndexBefore => 31,
            TiltError::Transform => 32,
            TiltError::Copy => 33,
            TiltError::Vertical => 37,
            TiltError::Index => 39,
            TiltError::CornerBothSides => 41,
            TiltError::Modifier(_) => 14,
            TiltError::CornerOutside | TiltError::CornerSteps { .. } | TiltError::Form(_) => return None,
        })
    }
}

/// Tilts the axes of all ranges of VTLAXS. A range with a mistake stays as it is. Less where who waits gives up.
pub(crate) fn tilt(items: Vec<EditItem>, patience: Patience<'_>) -> (Vec<EditItem>, Vec<EditError>) {
    let is_tilting = |item: &EditItem| {
        matches!(item, EditItem::Record(ClRecord { kind: ClKind::Postprocessor { word, .. }, .. })
            if word == "VTLAXS" || word == "WCORN")
    };
    if !looked_through(items.iter(), patience).any(is_tilting) {
        return (items, Vec::new());
    }
    let copied = looked_through(items.iter(), patience).filter_map(|item| match item {
        EditItem::Copy { number, .. } => Some(*number),
        _ => None,
    });
    let mut tilter = Tilter { copied: copied.collect(), ..Tilter::default() };
    for (at, item) in looked_through(items.iter().enumerate(), patience) {
        tilter.item(at, item);
    }
    tilter.end();
    (tilter.applied(items, patience), tilter.errors)
}

/// A position of the path with its place in the stream.
#[derive(Debug, Clone)]
struct PathPoint {
    item: usize,
    index: usize,
    position: Vec3,
    /// What stands in its place with a tilted tool, once known: in a corner none or several positions.
    tilted: Option<Vec<Pose>>,
}

/// The statement VTLAXS/ON.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Order {
    /// Tilt at the start, degrees, to the left positive.
    pub start: f64,
    /// Radius of the cutter and of its corner.
    pub radius: f64,
    corner: f64,
    /// 1 with the cutter on the right of the wall, -1 on its left.
    pub side: f64,
    /// ZSMALL.
    pub below: bool,
}

/// A range that is open.
#[derive(Debug, Clone, Copy)]
struct Range {
    order: Order,
    /// Item, statement and origin of VTLAXS/ON.
    item: usize,
    place: (u32, u32),
    /// Number of positions before it, at least one.
    before: usize,
    /// WCORN, the number of positions when it came, and its place.
    corner: Option<(Corner, usize, (u32, u32))>,
}

/// Where the stream is with respect to VTLAXS.
#[derive(Debug, Clone, Copy, Default)]
enum State {
    #[default]
    Off,
    On(Range),
    /// In a range with a mistake that has been told.
    Broken,
}

#[derive(Default)]
struct Tilter {
    points: Vec<PathPoint>,
    state: State,
    /// The numbers that COPY statements name.
    copied: BTreeSet<i64>,
    /// Whether an INDEX that is copied came after the last position.
    indexed: bool,
    /// Whether lengths are in millimeters.
    millimeters: bool,
    /// Items from VTLAXS/ON to VTLAXS/OFF: circles in them are none any more.
    ranges: Vec<std::ops::Range<usize>>,
    errors: Vec<EditError>,
}

impl Tilter {
    fn item(&mut self, at: usize, item: &EditItem) {
        match item {
            EditItem::Record(record) => self.record(at, record),
            EditItem::Transform { isn, source, .. } => self.not_inside(*isn, *source, TiltError::Transform),
            EditItem::Copy { isn, source, .. } => self.not_inside(*isn, *source, TiltError::Copy),
            EditItem::Index { number, end, isn, source } => {
                self.indexed |= !end && self.copied.contains(number);
                self.not_inside(*isn, *source, TiltError::Index);
            }
        }
    }

    fn error(&mut self, (isn, source): (u32, u32), error: TiltError) {
        self.errors.push(EditError { isn, source, kind: EditErrorKind::Tilt(error) });
    }

    /// Reports a statement that cannot stand in a range.
    fn not_inside(&mut self, isn: u32, source: u32, error: TiltError) {
        if matches!(self.state, State::On(_)) {
            self.error((isn, source), error);
            self.state = State::Broken;
        }
    }

    fn record(&mut self, at: usize, record: &ClRecord) {
        let place = (record.isn, record.source);
        match &record.kind {
            ClKind::Motion { from, points, .. } => {
                if *from {
                    self.not_inside(record.isn, record.source, TiltError::From);
                }
                if let State::On(range) = self.state
                    && points.iter().any(|point| !point.with_axis)
                {
                    self.error(range.place, TiltError::NoAxes);
                    self.state = State::Broken;
                }
                let point = |(index, point): (usize, &ClPoint)| PathPoint {
                    item: at,
                    index,
                    position: point.position,
                    tilted: None,
                };
                self.points.extend(points.iter().enumerate().map(point));
                self.indexed = false;
            }
            ClKind::Postprocessor { word, arguments, .. } if word == "VTLAXS" => match arguments.first() {
                Some(ClWord::Word(word)) if word == "ON" => self.switch_on(at, place, arguments),
                Some(ClWord::Word(word)) if word == "OFF" => self.switch_off(at, place, arguments),
                Some(ClWord::Word(_)) => self.error(place, TiltError::Modifier("VTLAXS")),
                _ => self.error(place, TiltError::Form("VTLAXS")),
            },
            ClKind::Postprocessor { word, arguments, .. } if word == "WCORN" => self.corner(place, arguments),
            ClKind::Units(units) => self.millimeters = *units == Units::Millimeters,
            _ => {}
        }
    }

    fn switch_on(&mut self, at: usize, place: (u32, u32), arguments: &[ClWord]) {
        let order = match (self.state, order(arguments)) {
            (State::On(_), _) => Err(TiltError::OnTwice),
            (State::Off | State::Broken, order) => order,
        };
        let order = match order {
            Ok(_) if self.points.is_empty() => Err(TiltError::NoMotionBefore),
            Ok(_) if self.indexed => Err(TiltError::IndexBefore),
            order => order,
        };
        self.state = match order {
            Ok(order) => State::On(Range { order, item: at, place, before: self.points.len(), corner: None }),
            Err(error) => {
                self.error(place, error);
                State::Broken
            }
        };
    }

    fn corner(&mut self, place: (u32, u32), arguments: &[ClWord]) {
        let count = self.points.len();
        let State::On(range) = &mut self.state else {
            if matches!(self.state, State::Off) {
                self.error(place, TiltError::CornerOutside);
            }
            return;
        };
        let error = if range.corner.is_some() {
            TiltError::CornerTwice
        } else if range.before == count {
            TiltError::NoMotionBeforeCorner
        } else {
            match cleaned(&range.order, arguments) {
                Ok(corner) => {
                    range.corner = Some((corner, count, place));
                    return;
                }
                Err(error) => error,
            }
        };
        self.error(place, error);
        self.state = State::Broken;
    }

    fn switch_off(&mut self, at: usize, place: (u32, u32), arguments: &[ClWord]) {
        let range = match std::mem::take(&mut self.state) {
            State::Off => return self.error(place, TiltError::NotOn),
            State::Broken => return,
            State::On(range) => range,
        };
        let [_, ClWord::Word(side), ClWord::Number(end)] = arguments else {
            return self.error(place, TiltError::Form("VTLAXS"));
        };
        if !matches!(side.as_str(), "RIGHT" | "LEFT") {
            return self.error(place, TiltError::Modifier("VTLAXS"));
        }
        let end = if side == "RIGHT" { -end } else { *end };
        let first = range.before.saturating_sub(1);
        let path: Vec<Vec3> = self.points.iter().skip(first).map(|point| point.position).collect();
        let tilted = match range.corner {
            None => tilted(&range.order, path, end).map_err(|error| (place, error)),
            Some((_, count, _)) if count == self.points.len() => Err((place, TiltError::NoMotionAfterCorner)),
            Some((corner, count, corner_place)) => {
                let inch = if self.millimeters { INCH } else { 1.0 };
                let at = count.saturating_sub(range.before);
                corner::tilted(&range.order, &corner, &path, at, end, inch)
                    .map_err(|error| (corner_place, error))
            }
        };
        match tilted {
            Ok(poses) => {
                for (point, poses) in self.points.iter_mut().skip(first).zip(poses) {
                    // The last position of a range before becomes the first of this one.
                    let mut before = point.tilted.take().unwrap_or_default();
                    before.pop();
                    before.extend(poses);
                    point.tilted = Some(before);
                }
                self.ranges.push(range.item..at);
            }
            Err((place, error)) => self.error(place, error),
        }
    }

    fn end(&mut self) {
        if let State::On(range) = self.state {
            self.error(range.place, TiltError::NotOff);
        }
    }

    /// The stream with the tilted positions. The last position before a range gets a record of its own, since it
    /// leaves the circle of its record.
    fn applied(&self, items: Vec<EditItem>, patience: Patience<'_>) -> Vec<EditItem> {
        let tilted = self.points.iter().filter_map(|point| Some((point, point.tilted.as_ref()?)));
        let mut tilted = tilted.peekable();
        let mut result = Vec::with_capacity(items.len() + self.ranges.len());
        let mut ranges = self.ranges.iter().peekable();
        for (at, item) in looked_through(items.into_iter().enumerate(), patience) {
            while ranges.next_if(|range| range.end < at).is_some() {}
            let inside = ranges.peek().is_some_and(|range| range.contains(&at));
            let EditItem::Record(mut record) = item else {
                result.push(item);
                continue;
            };
            match &mut record.kind {
                ClKind::Arc { .. } if inside => continue,
                ClKind::Motion { from, surface, points } => {
                    let first = tilted.peek().filter(|(point, _)| point.item == at);
                    let Some(first) = first.map(|(point, _)| point.index) else {
                        result.push(EditItem::Record(record));
                        continue;
                    };
                    let mut poses = Vec::new();
                    for (index, point) in points.split_off(first.min(points.len())).into_iter().enumerate() {
                        let place = (at, first + index);
                        match tilted.next_if(|(point, _)| (point.item, point.index) == place) {
                            Some((_, tilted)) => poses.extend(tilted.iter().copied().map(pose_point)),
                            None => poses.push(point),
                        }
                    }
                    let kind = ClKind::Motion { from: *from, surface: surface.clone(), points: poses };
                    let rest = ClRecord { isn: record.isn, source: record.source, kind };
                    if first > 0 {
                        result.push(EditItem::Record(record));
                    }
                    // A record inside of a corner may have lost all its positions.
                    if !matches!(&rest.kind, ClKind::Motion { points, .. } if points.is_empty()) {
                        result.push(EditItem::Record(rest));
                    }
                    continue;
                }
                _ => {}
            }
            result.push(EditItem::Record(record));
        }
        result
    }
}

fn pose_point((position, axis): Pose) -> ClPoint {
    ClPoint { position, axis, with_axis: true }
}

/// The positions of a range without corner from the one before it to its last.
fn tilted(order: &Order, path: Vec<Vec3>, end: f64) -> Result<Vec<Vec<Pose>>, TiltError> {
    let length: f64 = path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let first = path.windows(2).map(|pair| pair[1] - pair[0]).find(|step| step.norm() > 0.0);
    let Some(mut direction) = first.filter(|_| length > 0.0) else { return Err(TiltError::NoMotion) };
    let mut travelled = 0.0;
    let mut tilted = Vec::with_capacity(path.len());
    let mut before: Option<Vec3> = None;
    for position in path {
        let step = before.map_or_else(Vec3::zeros, |before| position - before);
        travelled += step.norm();
        // A position that repeats the one before keeps its direction.
        if step.norm() > 0.0 {
            direction = step;
        }
        let degrees = order.start + (end - order.start) * (travelled / length);
        tilted.push(vec![order.tilted(position, direction, degrees)?]);
        before = Some(position);
    }
    Ok(tilted)
}

/// Reads `side,alpha,side,beta,h[,n]` of WCORN.
fn cleaned(order: &Order, arguments: &[ClWord]) -> Result<Corner, TiltError> {
    let [
        ClWord::Word(first),
        ClWord::Number(alpha),
        ClWord::Word(second),
        ClWord::Number(beta),
        ClWord::Number(height),
        rest @ ..,
    ] = arguments
    else {
        return Err(TiltError::Form("WCORN"));
    };
    let steps = match rest {
        [] => None,
        [ClWord::Number(steps)] => Some(*steps),
        _ => return Err(TiltError::Form("WCORN")),
    };
    if ![first, second].into_iter().all(|word| matches!(word.as_str(), "RIGHT" | "LEFT")) {
        return Err(TiltError::Modifier("WCORN"));
    }
    let incoming = if first == "RIGHT" { -alpha } else { *alpha };
    let outgoing = if second == "RIGHT" { -beta.abs() } else { beta.abs() };
    // Only a tool that leans away from a wall reaches below: it has to do so at both walls or at none.
    let over = |tilt: f64| tilt * order.side >= 0.0;
    let one_upright = (incoming == 0.0 && over(outgoing)) || (outgoing == 0.0 && over(incoming));
    if order.below && first != second && !one_upright {
        return Err(TiltError::CornerBothSides);
    }
    Ok(Corner { incoming, outgoing, height: *height, steps: Corner::steps(steps)? })
}

/// Reads `ON,side,alpha,d,r,side[,ZSMALL]`.
fn order(arguments: &[ClWord]) -> Result<Order, TiltError> {
    let [
        _,
        ClWord::Word(tilt),
        ClWord::Number(start),
        ClWord::Number(diameter),
        ClWord::Number(corner),
        ClWord::Word(cutter),
        rest @ ..,
    ] = arguments
    else {
        return Err(TiltError::Form("VTLAXS"));
    };
    let below = match rest {
        [] => false,
        [ClWord::Word(word)] if word == "ZSMALL" => true,
        [ClWord::Word(_)] => return Err(TiltError::Modifier("VTLAXS")),
        _ => return Err(TiltError::Form("VTLAXS")),
    };
    let right_or_left = |word: &str| matches!(word, "RIGHT" | "LEFT");
    if !right_or_left(tilt) || !right_or_left(cutter) {
        return Err(TiltError::Modifier("VTLAXS"));
    }
    let (radius, corner) = (diameter.abs() / 2.0, *corner);
    if corner > radius * (1.0 + RADIUS_FRACTION) {
        return Err(TiltError::CornerRadius { corner, radius });
    }
    if below && corner != 0.0 {
        return Err(TiltError::RoundedEdge { corner });
    }
    let start = if tilt == "RIGHT" { -start } else { *start };
    let side = if cutter == "RIGHT" { 1.0 } else { -1.0 };
    Ok(Order { start, radius, corner, side, below })
}

impl Order {
    /// Where the tool stands, end and axis, that stood vertically at a position and arrived in a direction, tilted by
    /// some degrees to the left.
    pub(crate) fn tilted(&self, position: Vec3, direction: Vec3, degrees: f64) -> Result<Pose, TiltError> {
        let wall = self.wall(direction)?;
        let (sine, cosine) = self.lean(degrees)?;
        let across = wall * cosine - Vec3::z() * sine;
        let axis = (direction.cross(&across) * self.side).try_normalize(0.0).ok_or(TiltError::Vertical)?;
        let lift = self.corner * (1.0 - cosine) + (self.radius - self.corner) * sine.abs();
        let lift = if self.below && sine < 0.0 { -lift } else { lift };
        let shift = self.radius - (self.radius - sine * lift) / cosine;
        Ok((position + wall * shift + Vec3::z() * lift, axis))
    }

    /// Where the axis of the tilted tool meets the height of the vertical one.
    pub(crate) fn foot(&self, position: Vec3, direction: Vec3, degrees: f64) -> Result<Vec3, TiltError> {
        let (_, cosine) = self.lean(degrees)?;
        Ok(position - self.wall(direction)? * (self.radius / cosine - self.radius))
    }

    /// How far above the height of its lowest point the end of the tool lies, or below with `below`.
    pub(crate) fn lift(&self, axis: &Vec3, below: bool) -> f64 {
        let lift = self.corner * (1.0 - axis.z) + (self.radius - self.corner) * axis.x.hypot(axis.y);
        if below { -lift } else { lift }
    }

    /// Level unit direction from the cutter towards the wall.
    pub(crate) fn wall(&self, direction: Vec3) -> Result<Vec3, TiltError> {
        let wall = (Vec3::z() * self.side).cross(&direction);
        wall.try_normalize(direction.norm() * f64::EPSILON).ok_or(TiltError::Vertical)
    }

    /// Sine and cosine of how far the axis leans over the wall.
    fn lean(&self, degrees: f64) -> Result<(f64, f64), TiltError> {
        if degrees.is_nan() || degrees.abs() > LARGEST_TILT {
            return Err(TiltError::TooFar { degrees });
        }
        let angle = degrees * PI / 180.0;
        Ok((self.side * angle.sin(), angle.cos()))
    }
}

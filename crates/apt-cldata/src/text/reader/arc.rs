//! Circles in CL text: what states them, and the points that belong to them.

use std::f64::consts::TAU;

use apt_geometry::Vec3;
use smol_str::SmolStr;

use super::{ReadError, ReadErrorKind, Reader, Shortened, driven::Driven};
use crate::{
    arc::{ON_CIRCLE_FRACTION, slack},
    geometry::SpaceCircle,
    record::{ClKind, ClPoint, ClRecord, ClWord},
};

/// Distance, relative to the radius, within which start and end of an arc are one point.
const SAME_POINT_FRACTION: f64 = 1e-6;
/// Arguments of `CIRCLE/` and `MOVARC/` up to the radius.
const CIRCLE_ARGUMENTS: usize = 7;

/// A circle whose points are still coming in.
pub(super) struct PendingArc {
    circle: SpaceCircle,
    /// How far the points lie off it: tools that go about a drive surface keep their distance from it.
    away: f64,
    start: Option<Vec3>,
    /// Signed sweep, where the file says it.
    sweep: Option<f64>,
    /// How many full turns it makes before the one that ends it.
    turns_before: f64,
    pub(super) points: Vec<ClPoint>,
    isn: u32,
    line: u32,
}

/// Which way a motion sets out.
#[derive(Debug, Clone, Copy)]
pub(super) enum Direction {
    /// `INDIRV`.
    Along(Vec3),
    /// `INDIRP`.
    Towards(Vec3),
}

impl Reader {
    /// Whether the next position lies on the pending circle; then it is taken.
    pub(super) fn goes_on_arc(&mut self, point: ClPoint) -> bool {
        let tolerance = self.tolerance.width();
        let Some(arc) = &mut self.arc else { return false };
        let distance = arc.circle.deviation(&point.position);
        let slack = slack(&arc.circle, tolerance);
        let alone = self.circles_before_end || arc.sweep.is_some();
        if arc.points.is_empty() && !alone && distance.abs() > slack {
            // Not on the circle, but perhaps about its axis, as the place before.
            let start = arc.start.map(|start| arc.circle.deviation(&start));
            let concentric = start.is_some_and(|start| (start - distance).abs() <= slack);
            if concentric && arc.circle.radius + distance > slack {
                arc.away = distance;
            }
        }
        let belongs = (distance - arc.away).abs() <= slack
            && arc.points.last().is_none_or(|last| {
                // A move along the axis keeps the distance from it and is none along the circle.
                let turned = arc.circle.in_plane(&point.position) - arc.circle.in_plane(&last.position);
                !alone && turned.norm() > arc.circle.radius * SAME_POINT_FRACTION
            });
        if belongs {
            arc.points.push(point);
            return true;
        }
        if arc.points.is_empty() {
            self.error(ReadErrorKind::OffCircle { distance });
        }
        false
    }

    /// Centre, axis and radius at the head of a list of arguments.
    pub(super) fn circle_of(&mut self, word: &SmolStr, arguments: &[ClWord]) -> Option<SpaceCircle> {
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

    pub(super) fn circle(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some(circle) = self.circle_of(word, arguments) else { return };
        let (mut sweep, mut turns_before) = (None, 0.0);
        let mut rest = arguments.get(CIRCLE_ARGUMENTS..).unwrap_or_default().iter();
        while let Some(argument) = rest.next() {
            match argument {
                ClWord::Word(name) if name == "ANGLE" => match rest.next() {
                    Some(ClWord::Number(degrees)) => sweep = Some(degrees.to_radians()),
                    _ => return self.error(ReadErrorKind::NotNumber { word: word.clone(), position: 9 }),
                },
                // How often it goes round: the last time it comes to its end.
                ClWord::Word(name) if name == "TIMES" => match rest.next() {
                    Some(ClWord::Number(times)) if *times >= 1.0 && times.fract() == 0.0 => {
                        turns_before = *times - 1.0;
                    }
                    _ => return self.error(ReadErrorKind::NotRead { word: name.clone() }),
                },
                ClWord::Word(name) => self.error(ReadErrorKind::NotRead { word: name.clone() }),
                // Tolerances and cutter of the long form.
                ClWord::Number(_) => {
                    let line = self.line;
                    if self.shortened.last().is_none_or(|last| last.line != line) {
                        self.shortened.push(Shortened { line, word: word.clone() });
                    }
                }
            }
        }
        self.begin_arc(circle, sweep, turns_before);
    }

    fn begin_arc(&mut self, circle: SpaceCircle, sweep: Option<f64>, turns_before: f64) {
        let (start, points) = (self.position, Vec::new());
        let (isn, line) = (self.isn, self.line);
        self.arc = Some(PendingArc { circle, away: 0.0, start, sweep, turns_before, points, isn, line });
    }

    /// `ARCMOV/CLW|CCLW,x,y,z[,a]`: from the present position to the point along the circle of ARCDAT, through `a` degrees
    /// where that is said.
    pub(super) fn arc_move(&mut self, word: &SmolStr, arguments: &[ClWord]) {
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
    pub(super) fn worded_arc(&mut self, word: &SmolStr, arguments: &[ClWord]) {
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
        self.begin_arc(
            SpaceCircle { axis, ..circle },
            degrees.map(|degrees| degrees.abs().to_radians()),
            0.0,
        );
        let point = self.at(end, false);
        self.position = Some(end);
        self.goto(point, true);
        self.end_arc();
    }

    /// `INDIRV/i,j,k` or `INDIRP/x,y,z`.
    pub(super) fn indirection(&mut self, word: &SmolStr, arguments: &[ClWord]) {
        let Some(numbers) = self.numbers(word, arguments) else { return };
        let [x, y, z] = numbers[..] else {
            return self.error(ReadErrorKind::WrongCount { word: word.clone(), count: numbers.len() });
        };
        let vector = Vec3::new(x, y, z);
        self.direction =
            Some(if word == "INDIRV" { Direction::Along(vector) } else { Direction::Towards(vector) });
    }

    /// A circle as the drive surface of one GOFWD: the tool sets out as the direction says and ends at the place that the check surface
    /// names.
    pub(super) fn driven_arc(&mut self, driven: Driven) {
        let word = SmolStr::new_static("GOFWD");
        let (Some(start), Some(direction)) = (self.position, self.direction.take()) else {
            return self.error(ReadErrorKind::NotRead { word });
        };
        let Some(circle) = self.circle_about(&word, driven.center, driven.axis, driven.radius) else {
            return;
        };
        let along = match direction {
            Direction::Along(vector) => vector,
            Direction::Towards(place) => place - start,
        };
        let counterclockwise = circle.axis.dot(&(start - circle.center).cross(&along)) > 0.0;
        let axis = if counterclockwise { circle.axis } else { -circle.axis };
        let circle = SpaceCircle { axis, ..circle };
        let end = driven.end(&circle, &start, slack(&circle, self.tolerance.width()));
        self.turn(circle, false, None, end);
    }

    /// Turns a pending circle and its points into records.
    pub(super) fn end_arc(&mut self) {
        let Some(mut arc) = self.arc.take() else { return };
        let (isn, source) = (arc.isn, arc.line);
        let Some(last) = arc.points.last().copied() else { return };
        if arc.points.len() == 1 {
            let slack = slack(&arc.circle, self.tolerance.width());
            let off = arc.start.map(|start| arc.circle.deviation(&start));
            match (arc.start, off) {
                (Some(start), Some(off)) if off.abs() <= slack && arc.away == 0.0 => {
                    let same = arc.circle.radius * SAME_POINT_FRACTION;
                    let sweep = arc.sweep.unwrap_or_else(|| {
                        arc.circle.positive_sweep(&start, &last.position, same) + arc.turns_before * TAU
                    });
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

//! How a directrix goes on straight beyond its ends: not at all where they are one place; up to where both ways meet, in a corner; no
//! farther than it is defined, where it would come back to itself; else for ever.

use super::{Cubic, ON_CURVE, Vec2};

/// Farthest that both ways are followed to where they meet, in lengths of the curve: of lines that are as good as parallel it is
/// rounding where they meet.
const FARTHEST_MEETING: f64 = 1e4;
/// Distance of both ends, in lengths of the curve, below which they are one place: points are written with a few decimals.
const ONE_PLACE: f64 = 1e-7;
/// How near an end, in lengths of the curve, a crossing of the way on from there is that end: twice the same root has half the digits.
const AT_END: f64 = 1e-6;

/// What is beyond the ends of a directrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// Both ways end where they meet: the curve is closed.
    Meeting(Vec2),
    /// At the first and at the last end: whether it goes on for ever, or ends.
    Apart([bool; 2]),
}

/// A way on from an end.
struct Way {
    from: Vec2,
    /// Unit.
    along: Vec2,
}

impl Way {
    /// Whether it comes back to the curve before a distance.
    fn comes_back(&self, intervals: &[Cubic], size: f64, before: f64) -> bool {
        let mut crossings = Vec::new();
        for interval in intervals {
            interval.ray_roots(self.from, self.along, &mut crossings);
        }
        crossings.into_iter().any(|distance| distance > AT_END * size && distance < before - AT_END * size)
    }
}

/// How far it is on both ways to where they meet; `None` if that is behind an end or too far, and if the ways do not come to one place: of
/// parallel ones it is rounding where they meet, which tells of each way by itself.
fn meeting([head, tail]: [&Way; 2], size: f64) -> Option<[f64; 2]> {
    let turn = head.along.perp(&tail.along);
    let between = tail.from - head.from;
    let distances = [between.perp(&tail.along) / turn, between.perp(&head.along) / turn];
    let is_ahead = |distance: f64| distance >= -ON_CURVE * size && distance <= FARTHEST_MEETING * size;
    let apart = (between + tail.along * distances[1] - head.along * distances[0]).norm();
    (distances.into_iter().all(is_ahead) && apart <= ONE_PLACE * size).then_some(distances)
}

impl Beyond {
    /// What is beyond the ends of intervals that follow each other.
    pub(super) fn of(intervals: &[Cubic]) -> Self {
        let ([first, ..], [.., last]) = (intervals, intervals) else { return Self::Apart([true; 2]) };
        let size: f64 = intervals.iter().map(|interval| interval.length).sum();
        let ways = [
            Way { from: first.start, along: -first.direction(0.0) },
            Way { from: last.start + last.along * last.length, along: last.direction(last.length) },
        ];
        if let Some(distances) = meeting([&ways[0], &ways[1]], size)
            && !ways.iter().zip(distances).any(|(way, distance)| way.comes_back(intervals, size, distance))
        {
            return Self::Meeting(ways[0].from + ways[0].along * distances[0]);
        }
        Self::Apart(ways.map(|way| !way.comes_back(intervals, size, f64::INFINITY)))
    }
}

/// Intervals of a curve that ends where it begins, without the straight extensions of both ends.
pub(super) fn without_extensions(mut intervals: Vec<Cubic>) -> (Vec<Cubic>, bool) {
    let size: f64 = intervals.iter().map(|interval| interval.length).sum();
    let end = |interval: &Cubic| interval.start + interval.along * interval.length;
    let is_closed = |inner: &[Cubic]| {
        let ([first, ..], [.., last]) = (inner, inner) else { return false };
        inner.len() > 1 && (end(last) - first.start).norm() <= ONE_PLACE * size
    };
    if is_closed(&intervals) {
        return (intervals, true);
    }
    let count = intervals.len();
    let inner = 1..count.saturating_sub(1);
    let are_extensions = count > 3 && intervals[0].straight() && intervals[count - 1].straight();
    if are_extensions && is_closed(&intervals[inner.clone()]) {
        return (intervals.drain(inner).collect(), true);
    }
    (intervals, false)
}

/// The intervals with their straight extensions drawn out to the meeting point of both, by which they are closed.
pub(super) fn closed_at(meeting: Vec2, mut intervals: Vec<Cubic>) -> Option<Vec<Cubic>> {
    let size: f64 = intervals.iter().map(|interval| interval.length).sum();
    let end = |interval: &Cubic| interval.start + interval.along * interval.length;
    let is_apart = |place: Vec2| (place - meeting).norm() > ON_CURVE * size;
    let drawn_out =
        |interval: &Cubic| interval.straight() && is_apart(end(interval)) && is_apart(interval.start);
    let last = intervals.last()?.clone();
    if drawn_out(&last) {
        *intervals.last_mut()? = Cubic::new(last.start, meeting, 0.0, 0.0)?;
    } else if is_apart(end(&last)) {
        intervals.push(Cubic::new(end(&last), meeting, 0.0, 0.0)?);
    }
    let first = intervals.first()?.clone();
    if drawn_out(&first) {
        *intervals.first_mut()? = Cubic::new(meeting, end(&first), 0.0, 0.0)?;
    } else if is_apart(first.start) {
        intervals.insert(0, Cubic::new(meeting, first.start, 0.0, 0.0)?);
    }
    Some(intervals)
}

//! What a directrix is taken for beyond its ends: the tangents drawn out for ever, or up to where they meet; nothing where they
//! would come back to the curve.

use std::ops::Range;

use super::super::{directrix::Piece, shadow::Flat};

/// Farthest meeting point of the tangents that is told from that of parallel lines, in lengths of the curve.
const FARTHEST: f64 = 1e4;
/// Length, in those of the curve, below which two places are one, and within which a crossing of a tangent is the end it is drawn from.
const SAME: f64 = 1e-12;
const AT_END: f64 = 1e-6;
/// Length, in those of the curve, below which a curve that is given with a few decimals ends where it begins.
const LOOP: f64 = 1e-7;
/// Parts of the curve that are looked at for a crossing; a curve that runs along the tangent for longer counts as one that crosses it.
const PARTS: usize = 4_000;

/// What comes after the first and the last end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    /// The curve ends where it begins.
    Nothing,
    /// Straight pieces up to this place close the curve.
    Meeting(Flat),
    /// Whether the tangent goes on for ever.
    Tangents([bool; 2]),
}

/// A tangent drawn out from an end.
struct Ray {
    start: Flat,
    /// Unit.
    along: Flat,
}

impl Ray {
    fn new(end: Flat, inner: Flat) -> Option<Self> {
        Some(Self { start: end, along: (end - inner).try_normalize(0.0)? })
    }

    /// Whether a piece of the curve crosses it between two distances from its start.
    fn is_crossed(&self, curve: &[Piece], [from, to]: [f64; 2]) -> bool {
        let mut open: Vec<Piece> = curve.to_vec();
        let mut looks = 0;
        while let Some(piece) = open.pop() {
            looks += 1;
            if looks > PARTS {
                return true;
            }
            let away = piece.control().map(|p| p - self.start);
            let [ahead, aside] = [away.map(|x| x.dot(&self.along)), away.map(|x| self.along.perp(&x))];
            let is_off = aside.iter().all(|x| *x > 0.0) || aside.iter().all(|x| *x < 0.0);
            let is_out = ahead.iter().all(|x| *x <= from) || ahead.iter().all(|x| *x >= to);
            if is_off || is_out {
                continue;
            }
            // Ends on both sides, and all of it within the distances.
            let is_across = aside[0] * aside[3] <= 0.0 && ahead.iter().all(|x| *x > from && *x < to);
            if is_across {
                return true;
            }
            open.extend(piece.halves());
        }
        false
    }
}

fn lengths(curve: &[Piece]) -> f64 {
    curve.iter().map(|piece| (piece.control()[3] - piece.control()[0]).norm()).sum()
}

fn is_loop(curve: &[Piece], length: f64) -> bool {
    let ([first, .., last], true) = (curve, length > 0.0) else { return false };
    (last.control()[3] - first.control()[0]).norm() <= LOOP * length
}

/// The pieces of a curve that are a loop, where only straight extensions lead off it.
pub(super) fn loop_within(curve: &[Piece]) -> Option<Range<usize>> {
    let inner = 1..curve.len().checked_sub(1)?;
    let is_straight = |piece: &Piece| {
        let [a, b, c, d] = piece.control();
        let aside = |p: &Flat| (p - a).perp(&(d - a)).abs();
        aside(b).max(aside(c)) <= SAME * (d - a).norm_squared()
    };
    let length = lengths(curve);
    let are_extensions = is_straight(curve.first()?) && is_straight(curve.last()?);
    let is_wanted = !is_loop(curve, length) && are_extensions && is_loop(curve.get(inner.clone())?, length);
    is_wanted.then_some(inner)
}

impl Beyond {
    /// Of pieces that follow each other; `None` if they have no tangents.
    pub(super) fn of(curve: &[Piece]) -> Option<Self> {
        let (first, last) = (curve.first()?.control(), curve.last()?.control());
        let length = lengths(curve);
        if is_loop(curve, length) {
            return Some(Self::Nothing);
        }
        let [before, after] = [Ray::new(first[0], first[1])?, Ray::new(last[3], last[2])?];
        // Where before.start + x·before.along and after.start + y·after.along meet.
        let between = after.start - before.start;
        let turn = before.along.perp(&after.along);
        let far = [between.perp(&after.along) / turn, between.perp(&before.along) / turn];
        // Of lines that are parallel, or one, rounding alone is told, of each for itself.
        let apart = (between + after.along * far[1] - before.along * far[0]).norm();
        let ends = [before, after];
        let crossed = |to: [f64; 2]| {
            [0, 1].map(|k: usize| ends[k].is_crossed(curve, [AT_END * length, to[k] - AT_END * length]))
        };
        let is_told =
            far.iter().all(|x| *x >= -SAME * length && *x <= FARTHEST * length) && apart <= AT_END * length;
        if is_told && crossed(far) == [false; 2] {
            return Some(Self::Meeting(ends[0].start + ends[0].along * far[0]));
        }
        Some(Self::Tangents(crossed([f64::INFINITY; 2]).map(|is| !is)))
    }
}

/// The straight pieces that lead from a closed curve's last end to its first, without those of no length.
pub(super) fn closing(meeting: Flat, curve: &[Piece]) -> Option<[Option<[Flat; 2]>; 2]> {
    let (first, last) = (curve.first()?.control()[0], curve.last()?.control()[3]);
    let length = lengths(curve);
    let leg = |from: Flat, to: Flat| ((to - from).norm() > SAME * length).then_some([from, to]);
    Some([leg(meeting, first), leg(last, meeting)])
}

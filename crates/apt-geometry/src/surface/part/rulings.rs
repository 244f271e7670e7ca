//! Parts whose lines of one parameter are straight, as those of a ruled surface: along these nothing bends, which a form with one error for
//! all directions does not tell.
//!
//! With a unit ruling r and `p = n × r` across it in the tangent plane, the form S of a surface has no term for r alone, the mixed term m
//! and the term k for p. The distance at a depth d bends by `S (1 − d S)⁻¹`, which grows with S and with d. As
//! `2 (m − m₀) x y ≤ |m − m₀| (ε x² + y²/ε)`, S is over a part at most the form with `ε |m − m₀|` for r alone, the mixed term m₀ of the
//! middle, and the greatest k, raised by `|m − m₀|/ε`, for p.
//!
//! With `N = S (1 − d S)⁻¹` the nearest place of a point that goes along t goes along `t + d N t`, as far as that lies in the tangent
//! plane. Where that leads aside from a ruling by no more than a share of the way of the point, on all parts beside the ruling, it does
//! not leave these.

use super::{
    Enclosure, Part, Survey,
    form::{Form, Forms, Taken},
};
use crate::{Vec3, patience::Patience, surface::interval::Interval};

/// The question whether distances on one side of a ruled surface bend little along a stretch of a line that lies nearly along its rulings.
#[derive(Debug, Clone, Copy)]
pub struct Lying {
    /// Unit direction of the line.
    pub along: Vec3,
    /// Half the stretch.
    pub half: f64,
    /// No point of it is farther from the surface.
    pub depth: f64,
    /// How much the distances may bend downward, per unit of length squared.
    pub enough: f64,
    /// How far the nearest places may be from the ruling through that of the middle: where they may be farther nothing is told.
    pub beside: f64,
}

/// The rulings of a part, seen along the natural normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Rulings {
    /// The ruling in the middle and the direction across it.
    along: Vec3,
    across: Vec3,
    /// No other ruling differs from that by a longer vector, and no normal from that in the middle.
    turn: f64,
    spread: f64,
    /// The mixed term in the middle, and how far others are from it.
    mixed: f64,
    off: f64,
    /// The term across the rulings in the middle, and how far others are from it.
    bend: f64,
    error: f64,
}

/// How the tangent plane of a part turns.
pub(super) struct Turning {
    /// Unit normal in the middle.
    pub(super) normal: Vec3,
    /// No normal differs from that by a longer vector.
    pub(super) spread: f64,
    /// Change of the frame of the tangent plane, relative to that in the middle; less than one.
    pub(super) change: f64,
}

impl Rulings {
    /// None if the lines of the second parameter are not straight.
    pub(super) fn of(enclosure: &Enclosure, half: [f64; 2], turning: &Turning, form: &Form) -> Option<Self> {
        let Enclosure { jet, duv, dvv, .. } = enclosure;
        let Turning { normal, spread, change } = *turning;
        let length = jet.dv.norm();
        let area = jet.du.cross(&jet.dv).norm();
        let shortest = length - half[0] * duv.length();
        if dvv.length() > 0.0 || area <= 0.0 || change >= 1.0 || shortest <= 0.0 {
            return None;
        }
        let along = jet.dv / length;
        let turn = half[0] * duv.across(&along) / shortest;
        let out = duv.dot(&normal) + Interval::about(0.0, spread * duv.length());
        let stretch = Interval::about(1.0, change);
        let mixed = -jet.duv.dot(&normal) / area;
        let off = (out / (stretch * stretch * area.into()) + mixed.into()).magnitude();
        let across = normal.cross(&along);
        let (bend, error) = form.about_direction(&across, spread + turn);
        Some(Self { along, across, turn, spread, mixed, off, bend, error })
    }

    /// How far the parts of a unit vector along a ruling and across it may be from those in the middle: where a ruling turns in the tangent
    /// plane, so does the direction across it; where that tilts, what of the vector is across the ruling counts.
    fn apart(&self, along: &Vec3) -> [f64; 2] {
        let aside = (1.0 - self.along.dot(along).powi(2)).max(0.0).sqrt();
        [self.turn * (aside + self.turn), self.turn + self.spread * (aside + self.turn)]
    }

    /// How fast at most the nearest place of a point that goes along a unit direction goes aside from a line, on a side of the part.
    fn leads_aside(&self, side: f64, (along, line): (&Vec3, &Vec3), depth: f64) -> f64 {
        let across = self.across.dot(along).abs() + self.apart(along)[1];
        let mixed = self.mixed.abs() + self.off;
        let room = 1.0 - depth * (side * self.bend + self.error).max(0.0) - (depth * mixed).powi(2);
        if room <= 0.0 {
            return f64::INFINITY;
        }
        let bend = self.bend.abs() + self.error + depth * mixed * mixed;
        let onward = 1.0 + depth * mixed * (depth * mixed + across) / room;
        onward * ((self.along - line).norm() + self.turn) + across + depth * (mixed + bend * across) / room
    }

    /// How much distances at a depth bend downward along a unit direction at most, on a side of the part, and in its middle.
    fn bend_along(&self, side: f64, along: &Vec3, depth: f64) -> [f64; 2] {
        let [a, b] = [self.along, self.across].map(|way| way.dot(along));
        let (mixed, bend) = (side * self.mixed, side * self.bend);
        let middle = bend_of([0.0, mixed, bend], depth);
        let exact = middle.map_or(f64::INFINITY, |[aa, ab, bb]| aa * a * a + 2.0 * ab * a * b + bb * b * b);
        // How far both parts of the direction may be from those in the middle.
        let [da, db] = self.apart(along);
        let most = bend + self.error;
        let room = 1.0 - depth * most;
        if room <= 0.0 {
            return [f64::INFINITY, exact];
        }
        let share = (b.abs() + db + depth * mixed.abs() / room).max(2.0 * depth * self.off / room);
        let raised = if self.off > 0.0 { [self.off * share, self.off / share] } else { [0.0; 2] };
        let Some([aa, ab, bb]) = bend_of([raised[0], mixed, most + raised[1]], depth) else {
            return [f64::INFINITY, exact];
        };
        let (x, y) = (Interval::about(a, da), Interval::about(b, db));
        let all = x * x * aa.into() + x * y * (2.0 * ab).into() + y * y * bb.into();
        [if all.high.is_nan() { f64::INFINITY } else { all.high }, exact]
    }
}

/// How far a point is from a straight piece.
pub(super) fn distance_from([from, to]: &[Vec3; 2], point: &Vec3) -> f64 {
    let way = to - from;
    let square = way.norm_squared();
    let share = if square > 0.0 { (point - from).dot(&way) / square } else { 0.0 };
    (point - from - way * share.clamp(0.0, 1.0)).norm()
}

/// The terms of `S (1 − d S)⁻¹` from those of S: along, mixed, across. None where d is too deep.
fn bend_of([aa, ab, bb]: [f64; 3], depth: f64) -> Option<[f64; 3]> {
    let (left, right) = (1.0 - depth * aa, 1.0 - depth * bb);
    let room = left * right - depth * depth * ab * ab;
    let square = depth * ab * ab;
    (left > 0.0 && room > 0.0).then(|| [aa * right + square, ab, bb * left + square].map(|x| x / room))
}

/// The question about a line along rulings.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct OnRulings {
    asked: Lying,
    /// Direction of the ruling, and the ends of its piece beside which nearest places may be.
    ruling: Vec3,
    ends: [Vec3; 2],
}

impl OnRulings {
    /// Whether a part is nowhere beside the piece of the ruling.
    pub(super) fn is_off(&self, part: &Part) -> bool {
        part.is_off(&self.ends, self.asked.beside)
    }

    /// What the rulings of a part tell, about the place in its middle.
    pub(super) fn take(&self, rulings: Option<&Rulings>, place: &Vec3, side: f64, is_fine: bool) -> Taken {
        let Lying { along, half, depth, enough, beside } = &self.asked;
        let Some(rulings) = rulings else { return if is_fine { Taken::Nothing } else { Taken::Halves } };
        let [most, middle] = rulings.bend_along(side, along, *depth);
        let stays = || half * rulings.leads_aside(side, (along, &self.ruling), *depth) <= *beside;
        // More at a place that counts is more than enough.
        let is_more = || middle > *enough && distance_from(&self.ends, place) <= *beside;
        if most <= *enough && stays() {
            Taken::Whole
        } else if is_fine || is_more() {
            Taken::Nothing
        } else {
            Taken::Halves
        }
    }
}

impl<'a> Survey<'a> {
    /// Asks whether distances bend little along a line that lies along all parts beside a piece of a ruling.
    pub(in super::super) fn on_rulings(
        (center, ruling): (&Vec3, &Vec3),
        reach: f64,
        side: f64,
        asked: Lying,
        patience: Patience<'a>,
    ) -> Self {
        let ends = [center - ruling * reach, center + ruling * reach];
        let forms = Forms::OnRulings(OnRulings { asked, ruling: *ruling, ends });
        Self::about_forms(center, reach + asked.beside, side, forms, patience)
    }

    /// Whether they do.
    pub(in super::super) fn bends_little(&self) -> bool {
        matches!(self.forms, Forms::OnRulings(_)) && !self.jumps
    }
}

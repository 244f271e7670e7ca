//! Parts whose lines of one parameter are straight, as those of a ruled surface: along these nothing bends, which a form with one error for
//! all directions does not tell.
//!
//! With a unit ruling r and p across it in the tangent plane the form of a vector w is `2 m α β + k β²`, α and β being its parts along
//! them. Let t be a unit vector with a part of length c in the tangent plane, and s the sine of the angle of that to r. The part of w in
//! the tangent plane is off that of t by at most `σ/c`, σ being the part of w across t, so that `|β| ≤ σ/c + s`. So the form is at most
//! `2 m s + k s² + 2 (m + k s) σ/c + k σ²/c²`, and with `2 x σ ≤ x²/λ + λ σ²` at most `μ + b σ²`: a bend μ along t, and b across.

use super::{Enclosure, Survey, form::Forms, form::Taken};
use crate::{Vec3, patience::Patience};

/// How many times what it is in the middle of some part the bend along a line may be told to be.
const LOOSE: f64 = 1.5;
/// A bend along a line, as a share of that across it, of no account.
const FAINT: f64 = 1e-7;

/// The rulings of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Rulings {
    /// Unit direction in the middle, and the sine of the angle that others are at most off it.
    along: Vec3,
    turn: f64,
    /// Greatest mixed term of the form along a ruling and across it, in the part and in its middle.
    mixed: f64,
    in_the_middle: f64,
    /// Unit normal in the middle; no other differs from it by a longer vector.
    normal: Vec3,
    spread: f64,
    /// Greatest curvature seen from the natural side, and from the other.
    curvature: [f64; 2],
}

/// How the tangent plane of a part turns.
pub(super) struct Turning {
    /// Unit normal in the middle.
    pub(super) normal: Vec3,
    /// No normal differs from that by a longer vector.
    pub(super) spread: f64,
    /// Change of the frame of the tangent plane, relative to that in the middle.
    pub(super) change: f64,
    /// Greatest curvature seen from the natural side, and from the other.
    pub(super) curvature: [f64; 2],
}

impl Rulings {
    /// None if the lines of the second parameter are not straight.
    pub(super) fn of(enclosure: &Enclosure, half: [f64; 2], turning: &Turning) -> Option<Self> {
        let Enclosure { jet, duv, dvv, .. } = enclosure;
        let length = jet.dv.norm();
        let area = jet.du.cross(&jet.dv).norm();
        let left = 1.0 - turning.change;
        let shortest = length - half[0] * duv.length();
        if dvv.length() > 0.0 || area <= 0.0 || left <= 0.0 || shortest <= 0.0 {
            return None;
        }
        let along = jet.dv / length;
        let turn = half[0] * duv.across(&along) / shortest;
        let mixed =
            (duv.dot(&turning.normal).magnitude() + turning.spread * duv.length()) / (area * left * left);
        let in_the_middle = jet.duv.dot(&turning.normal).abs() / area;
        let Turning { normal, spread, curvature, .. } = *turning;
        Some(Self { along, turn, mixed, in_the_middle, normal, spread, curvature })
    }

    /// How much the part, and its middle, bends to a side at most along a unit direction, given how much it may bend across.
    fn bend_along(&self, side: f64, along: &Vec3, across: f64) -> [f64; 2] {
        self.beside(side, along).map(|beside| {
            let spare = across * beside.within - beside.curvature;
            let bend = beside.own + beside.lean * beside.lean / spare;
            if spare > 0.0 && bend.is_finite() { bend } else { f64::INFINITY }
        })
    }

    /// The curvature across a unit direction with which the part bends to a side by no more than so much along it.
    pub(super) fn curvature_across(&self, side: f64, along: &Vec3, least: f64) -> f64 {
        let [beside, _] = self.beside(side, along);
        let spare = least - beside.own;
        let needed = (beside.curvature + beside.lean * beside.lean / spare) / beside.within;
        if spare > 0.0 && needed.is_finite() { needed } else { f64::INFINITY }
    }

    /// The same part, and its middle, beside a unit direction.
    fn beside(&self, side: f64, along: &Vec3) -> [Beside; 2] {
        let curvature = self.curvature[usize::from(side > 0.0)].max(0.0);
        let off = self.along.cross(along);
        let (leaning, aside) = (self.normal.dot(along).abs(), self.normal.dot(&off).abs());
        let beside = |leaning: f64, aside: f64, mixed: f64| {
            let within = (1.0 - leaning * leaning).max(0.0);
            let sine = aside / within.sqrt();
            let own = 2.0 * mixed * sine + curvature * sine * sine;
            Beside { within, curvature, own, lean: mixed + curvature * sine }
        };
        let aside_at_most = aside + self.spread * off.norm() + self.turn;
        [beside(leaning + self.spread, aside_at_most, self.mixed), beside(leaning, aside, self.in_the_middle)]
    }
}

/// How a part bends beside a direction t: `own + 2 lean σ/c + curvature σ²/c²` at most for a unit vector of which σ is across t.
struct Beside {
    /// `c²`: the part of t within the tangent plane, squared.
    within: f64,
    curvature: f64,
    own: f64,
    lean: f64,
}

/// The question how much a surface bends to a side along a unit direction that its rulings nearly have, given how much it may bend across;
/// with what has been found.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct OnRulings {
    along: Vec3,
    across: f64,
    /// The greatest bend, and that in the middle of parts.
    found: f64,
    least: f64,
}

impl OnRulings {
    pub(super) fn turned(self, turned: impl Fn(&Vec3) -> Vec3) -> Self {
        Self { along: turned(&self.along), ..self }
    }

    pub(super) fn take(&mut self, rulings: Option<&Rulings>, side: f64, is_fine: bool) -> Taken {
        let unknown = [f64::INFINITY, 0.0];
        let [most, least] =
            rulings.map_or(unknown, |rulings| rulings.bend_along(side, &self.along, self.across));
        self.least = self.least.max(least);
        if most > self.found.max(LOOSE * self.least).max(FAINT * self.across) && !is_fine {
            return Taken::Halves;
        }
        self.found = self.found.max(most);
        if most.is_finite() { Taken::Whole } else { Taken::Nothing }
    }
}

impl<'a> Survey<'a> {
    /// Asks how much all parts within reach of a point bend towards a side along a unit direction, given a curvature that they may have
    /// across it.
    pub(in super::super) fn on_rulings(
        center: &Vec3,
        reach: f64,
        side: f64,
        (along, across): (&Vec3, f64),
        patience: Patience<'a>,
    ) -> Self {
        let asked = OnRulings { along: *along, across, found: 0.0, least: 0.0 };
        Self::about_forms(center, reach, side, Forms::OnRulings(asked), patience)
    }

    /// The greatest bend along the direction.
    pub(in super::super) fn bend_on_rulings(&self) -> Option<f64> {
        match self.forms {
            Forms::OnRulings(asked) if !self.jumps => Some(asked.found),
            _ => None,
        }
    }
}

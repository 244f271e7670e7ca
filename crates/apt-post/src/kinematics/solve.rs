//! Angles that point the tool along an axis, for any two rotary axes.
//!
//! With the axes n₁ and n₂ and the tool direction e at zero, z = R(n₂, θ₂) e is where the second axis alone takes the tool. The
//! first one keeps n₁·z = n₁·u, the second one n₂·z = n₂·e: two planes, whose line meets the unit sphere on both sides of the
//! plane of n₁ and n₂. Each *side* is one solution; they are one at a *fold*, in that plane.

use apt_geometry::Vec3;

use super::{Angles, Kinematics, angle_between};

/// Radians by which directions may differ through rounding alone.
pub(super) const ROUNDING: f64 = 1e-9;
/// Radians by which a tool axis may miss what was asked for: the axes of CL data have six decimals.
pub(super) const REACHED: f64 = 1e-6;
/// Square of the part of a unit vector off the plane of both rotary axes that rounding leaves at a fold.
pub(super) const FOLD: f64 = 1e-15;
/// Degrees of a whole turn.
pub(super) const TURN: f64 = 360.0;
/// Degrees by which ways may differ that count as equally far.
pub(super) const EQUALLY_FAR: f64 = 1e-6;

impl Kinematics {
    /// All angles within the limits that point along `axis`: the whole turns within half a turn of `near`, or where the limits
    /// exclude those the ones nearest to it. On the pole the first angle of `near` is kept. Nearest first, by the sum of both
    /// turns, then those of the preferred sign. Empty: unreachable.
    pub(crate) fn solutions(&self, axis: &Vec3, near: Angles) -> Vec<Angles> {
        let turned = |which: usize, angle: f64| self.turns(which, angle, near[which]);
        self.chosen(axis, near, turned)
    }

    /// The first of the solutions.
    pub(crate) fn nearest(&self, axis: &Vec3, near: Angles) -> Option<Angles> {
        self.solutions(axis, near).first().copied()
    }

    /// Solutions in the whole turns that `turned` names, in their order.
    pub(super) fn chosen(
        &self,
        axis: &Vec3,
        near: Angles,
        turned: impl Fn(usize, f64) -> Vec<f64>,
    ) -> Vec<Angles> {
        let mut all: Vec<Angles> = Vec::new();
        for branch in self.branches(axis, near) {
            let seconds = turned(1, branch[1]);
            let firsts = turned(0, branch[0]);
            let pairs = seconds.iter().flat_map(|second| firsts.iter().map(|first| [*first, *second]));
            all.extend(pairs.filter(|angles| self.reaches(*angles, axis)));
        }
        all.sort_by_key(|angles| self.order(*angles, near));
        all.dedup_by(|a, b| farther(*a, *b) <= EQUALLY_FAR);
        all
    }

    /// Whether the angles point along the axis.
    pub(super) fn reaches(&self, angles: Angles, axis: &Vec3) -> bool {
        angle_between(&self.axis(angles), axis) <= self.dead_cone.max(REACHED)
    }

    /// What solutions are sorted by: how far both axes turn, how many of them are against their preferred sign, and where
    /// these say nothing the angle of the second axis and of the first one, the positive before the negative.
    fn order(&self, angles: Angles, near: Angles) -> (i64, usize, i64, i64) {
        let far = Kinematics::steps_between(angles, near);
        (far, self.against(angles), -steps(angles[1]), -steps(angles[0]))
    }

    /// How far both axes turn between two pairs of angles, in whole steps of what counts as equally far.
    pub(super) fn steps_between(a: Angles, b: Angles) -> i64 {
        steps((a[0] - b[0]).abs() + (a[1] - b[1]).abs())
    }

    /// How many of the axes stand against their preferred sign.
    pub(super) fn against(&self, angles: Angles) -> usize {
        let is_against = |(rotary, angle): (&super::Rotary, f64)| {
            rotary.prefer.is_some_and(|sign| sign * angle < -EQUALLY_FAR)
        };
        self.axes.iter().zip(angles).filter(|pair| is_against(*pair)).count()
    }

    /// The direction of the first rotary axis that a tool axis is along, where it is.
    pub(super) fn pole(&self, axis: &Vec3) -> Option<Vec3> {
        let first = self.axes[0].vector;
        let cone = self.dead_cone.max(ROUNDING);
        [first, -first].into_iter().find(|pole| angle_between(pole, axis) <= cone)
    }

    /// Whether the second axis has only one angle to choose: where it is held, along the first one or along the tool.
    pub(super) fn second_is_kept(&self) -> bool {
        let [first, second] = &self.axes;
        second.is_held()
            || first.vector.cross(&second.vector).norm() <= ROUNDING
            || second.vector.cross(&Vec3::z()).norm() <= ROUNDING
    }

    /// Where the second axis alone has to take the tool so that the first one takes it on to the unit vector `axis`: one or both
    /// sides. Nothing where there is no such place.
    fn places(&self, axis: &Vec3, near: Angles) -> [Option<Vec3>; 2] {
        let [first, second] = &self.axes;
        if self.second_is_kept() {
            return [Some(second.turn(second.held_within(near[1])) * Vec3::z()), None];
        }
        let (n1, n2) = (first.vector, second.vector);
        let (along, across) = (n1.dot(&n2), n1.cross(&n2));
        let (on_first, on_second) = (n1.dot(axis), n2.z);
        let square = across.norm_squared();
        let foot = (n1 * (on_first - along * on_second) + n2 * (on_second - along * on_first)) / square;
        let off = 1.0 - foot.norm_squared();
        if off > FOLD {
            let off = across * (off / square).sqrt();
            return [Some(foot + off), Some(foot - off)];
        }
        // Beyond the fold it is the nearest there is, and whether that will do is found out from the angles.
        [foot.try_normalize(0.0), None]
    }

    /// Angles that point along an axis, less whole turns and without regard to limits.
    pub(super) fn branches(&self, axis: &Vec3, near: Angles) -> impl Iterator<Item = Angles> + use<'_> {
        let [first, second] = &self.axes;
        let pole = self.pole(axis);
        let axis = pole.or_else(|| axis.try_normalize(0.0)).unwrap_or(*axis);
        let is_kept = self.second_is_kept();
        let branch = move |place: Vec3| {
            let angle = if is_kept { None } else { turn_between(&second.vector, &Vec3::z(), &place) };
            let angle = angle.unwrap_or(second.held_within(near[1]));
            let turned = second.turn(angle) * Vec3::z();
            let on_pole = if pole.is_some() { None } else { turn_between(&first.vector, &turned, &axis) };
            [on_pole.unwrap_or(first.held_within(near[0])), angle]
        };
        self.places(&axis, near).into_iter().flatten().map(branch)
    }

    /// The angle, where it is within the limits of an axis or only rounding takes it beyond.
    pub(super) fn within(&self, which: usize, angle: f64) -> Option<f64> {
        let held = self.axes[which].held_within(angle);
        ((held - angle).abs() <= REACHED.to_degrees()).then_some(held)
    }

    /// The angle and whole turns more or less within the limits: those within half a turn of `near`, else the nearest.
    pub(super) fn turns(&self, which: usize, angle: f64, near: f64) -> Vec<f64> {
        let nearest = nearest_turn(angle, near);
        let other = nearest + TURN.copysign(near - nearest);
        let is_as_near = (other - near).abs() <= TURN / 2.0 + EQUALLY_FAR;
        let beside = [Some(nearest), is_as_near.then_some(other)];
        let found: Vec<f64> =
            beside.into_iter().flatten().filter_map(|angle| self.within(which, angle)).collect();
        if !found.is_empty() {
            return found;
        }
        let [least, greatest] = self.axes[which].limits;
        let turns = if nearest < least {
            ((least - REACHED.to_degrees() - nearest) / TURN).ceil()
        } else {
            ((greatest + REACHED.to_degrees() - nearest) / TURN).floor()
        };
        self.within(which, nearest + TURN * turns).into_iter().collect()
    }
}

/// An angle in whole steps, so that angles which only rounding tells apart stand together.
fn steps(degrees: f64) -> i64 {
    (degrees / EQUALLY_FAR).round() as i64
}

/// The farther of both turns between two pairs of angles, degrees.
pub(super) fn farther(a: Angles, b: Angles) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

/// The angle and whole turns more or less that is nearest to `near`.
pub(super) fn nearest_turn(angle: f64, near: f64) -> f64 {
    angle + TURN * ((near - angle) / TURN).round()
}

/// The turn about a unit vector that takes one direction over to another, degrees; none where one of them is along it.
pub(super) fn turn_between(unit: &Vec3, from: &Vec3, to: &Vec3) -> Option<f64> {
    let off_from = from - unit * unit.dot(from);
    let off_to = to - unit * unit.dot(to);
    (off_from.norm() > ROUNDING && off_to.norm() > ROUNDING)
        .then(|| unit.dot(&off_from.cross(&off_to)).atan2(off_from.dot(&off_to)).to_degrees())
}

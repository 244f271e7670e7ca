//! Angles that follow a tool axis without leaving their side, and where that ends.

use apt_geometry::Vec3;

use super::{
    Angles, Kinematics, angle_between,
    solve::{EQUALLY_FAR, FOLD, ROUNDING, TURN, nearest_turn, turn_between},
};

/// Whole turns to either side among which a beginning may be looked for. A second rotary axis leads to no tool axis that it would
/// not lead to within one turn, and a limit leaves part of another.
const TURNS_BESIDE: i32 = 1;

/// Why angles cannot follow a tool axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Blocked {
    /// No angles point there.
    Unreachable,
    /// They would be beyond a limit of this axis.
    Limit {
        /// Index of the rotary axis.
        which: usize,
        /// The angle that it would need, degrees.
        angle: f64,
    },
}

impl Kinematics {
    /// Solutions by a whole turn of the second axis beside those of [`Kinematics::solutions`] that are within the limits, and those.
    pub(super) fn beginnings(&self, axis: &Vec3, near: Angles) -> Vec<Angles> {
        let turned = |which: usize, angle: f64| {
            let nearest = self.turns(which, angle, near[which]);
            if which == 0 {
                return nearest;
            }
            let mut all: Vec<f64> = Vec::new();
            for angle in nearest {
                for turns in -TURNS_BESIDE..=TURNS_BESIDE {
                    let beside = self.within(which, angle + TURN * f64::from(turns));
                    all.extend(beside.filter(|beside| !all.contains(beside)));
                }
            }
            all
        };
        self.chosen(axis, near, turned)
    }

    /// The angles at `to` when the tool axis turns there evenly, as [`Kinematics::followed`], where no limit excludes them.
    pub(super) fn follow(&self, from: &Vec3, angles: Angles, to: &Vec3) -> Result<Angles, Blocked> {
        self.limited(self.followed(from, angles, to)?)
    }

    /// The angles at `to` when the tool axis turns there evenly from `from`, where the machine stands at `angles`.
    ///
    /// The side is kept, whatever the limits: between the sides the machine changes only at a fold or on the pole, where a solution
    /// is taken that is nearest within the limits. Both angles are followed continuously, however far the first one has to turn.
    pub(super) fn followed(&self, from: &Vec3, angles: Angles, to: &Vec3) -> Result<Angles, Blocked> {
        if let Some(led) = self.led_to_pole(from, angles, to) {
            return Ok(led);
        }
        let side = self.side(angles[1]);
        if self.pole(to).is_some() || self.meets_pole(from, to) || (side == 0.0 && !self.second_is_kept()) {
            return self.nearest(to, angles).ok_or_else(|| self.blocked(to, angles));
        }
        let same_side = |branch: &Angles| self.second_is_kept() || self.side(branch[1]) * side >= 0.0;
        let Some(branch) = self.branches(to, angles).find(same_side) else {
            return Err(Blocked::Unreachable);
        };
        let second = nearest_turn(branch[1], angles[1]);
        // Of the way of the first axis the great circle makes less than half a turn of azimuth, and what the second axis changes of
        // it on one side is less than half a turn, too.
        let azimuth = turn_between(&self.axes[0].vector, from, to).unwrap_or(0.0);
        let first = nearest_turn(branch[0], angles[0] + azimuth);
        if self.reaches([first, second], to) { Ok([first, second]) } else { Err(Blocked::Unreachable) }
    }

    /// The angles to which those at `from` lead where the tool axis comes to the pole. Its first angle is free there, and yet it comes to it with a
    /// certain one: that of the way of the tool as the second axis leaves the pole for the same side. Two axes square to each other keep the first one
    /// all the way.
    fn led_to_pole(&self, from: &Vec3, angles: Angles, to: &Vec3) -> Option<Angles> {
        let side = self.side(angles[1]);
        if self.pole(to).is_none() || self.pole(from).is_some() || side == 0.0 || self.second_is_kept() {
            return None;
        }
        let first = &self.axes[0].vector;
        let leaves = first.cross(&self.axes[1].vector) * side;
        let turned = nearest_turn(turn_between(first, &leaves, from)?, angles[0]);
        let turned = if (turned - angles[0]).abs() <= EQUALLY_FAR { angles[0] } else { turned };
        let second = nearest_turn(self.branches(to, angles).next()?[1], angles[1]);
        let led = [turned, second];
        self.reaches(led, to).then_some(led)
    }

    /// The angles, if no limit excludes them.
    pub(super) fn limited(&self, angles: Angles) -> Result<Angles, Blocked> {
        let mut held = angles;
        for which in [0, 1] {
            let angle = angles[which];
            let beyond = if self.axes[which].is_held() {
                // It is no limit that stops what has no way at all.
                Blocked::Unreachable
            } else {
                Blocked::Limit { which, angle }
            };
            held[which] = self.within(which, angle).ok_or(beyond)?;
        }
        Ok(held)
    }

    /// Why no solution within the limits points along an axis.
    pub(super) fn blocked(&self, axis: &Vec3, near: Angles) -> Blocked {
        let free = self.without_limit(0).without_limit(1);
        match free.nearest(axis, near).map(|angles| self.limited(angles)) {
            Some(Err(blocked)) => blocked,
            _ => Blocked::Unreachable,
        }
    }

    /// The same machine with an axis that turns without end; one that is held stays so.
    pub(super) fn without_limit(&self, which: usize) -> Kinematics {
        let mut free = *self;
        if !free.axes[which].is_held() {
            free.axes[which].limits = [f64::NEG_INFINITY, f64::INFINITY];
        }
        free
    }

    /// On which side of the plane of both rotary axes the second one alone takes the tool; 0 at a fold.
    fn side(&self, second: f64) -> f64 {
        let across = self.axes[0].vector.cross(&self.axes[1].vector);
        let off = across.dot(&(self.axes[1].turn(second) * Vec3::z()));
        if off * off <= FOLD * across.norm_squared() { 0.0 } else { off.signum() }
    }

    /// Whether the tool axis comes to the pole between two axes; opposite ones are joined by great circles through it, too.
    fn meets_pole(&self, from: &Vec3, to: &Vec3) -> bool {
        self.pole_between(from, to).is_some() || angle_between(from, to) >= std::f64::consts::PI - ROUNDING
    }

    /// The axis of the great circle between two axes that is nearest to the first rotary axis, where it is along it.
    pub(super) fn pole_between(&self, from: &Vec3, to: &Vec3) -> Option<Vec3> {
        if let Some(end) = [from, to].into_iter().find(|end| self.pole(end).is_some()) {
            return Some(*end);
        }
        let normal = from.cross(to).try_normalize(ROUNDING)?;
        let first = self.axes[0].vector;
        let nearest = (first - normal * normal.dot(&first)).try_normalize(ROUNDING)?;
        let is_between =
            |place: &Vec3| normal.dot(&from.cross(place)) >= 0.0 && normal.dot(&place.cross(to)) >= 0.0;
        [nearest, -nearest].into_iter().find(|place| is_between(place) && self.pole(place).is_some())
    }
}

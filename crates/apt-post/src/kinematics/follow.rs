//! Angles that follow a tool axis without leaving their side, and where that ends.

use apt_geometry::Vec3;

use super::{
    Angles, Kinematics,
    solve::{FOLD, ROUNDING, TURN, nearest_turn, turn_between},
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
    /// Solutions from which a stretch may begin: those of [`Kinematics::solutions`], and those by a whole turn of the second axis
    /// beside them that are within the limits.
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

    /// The angles at `to` when the tool axis turns there evenly from `from`, where the machine stands at `angles`.
    ///
    /// The side is kept: between the sides the machine changes only at a fold or on the pole, where a solution is taken that is
    /// nearest within the limits. Both angles are followed continuously, however far the first one has to turn.
    pub(super) fn follow(&self, from: &Vec3, angles: Angles, to: &Vec3) -> Result<Angles, Blocked> {
        let side = self.side(angles[1]);
        if self.pole(to).is_some() || self.meets_pole(from, to) || (side == 0.0 && !self.second_is_kept()) {
            return self.nearest(to, angles).ok_or_else(|| self.blocked(to, angles));
        }
        let same_side = |branch: &Angles| self.second_is_kept() || self.side(branch[1]) * side >= 0.0;
        let Some(branch) = self.branches(to, angles).into_iter().find(same_side) else {
            return Err(Blocked::Unreachable);
        };
        let second = nearest_turn(branch[1], angles[1]);
        let turned = self.azimuth_change(from, to)
            - (self.azimuth_off_second(second) - self.azimuth_off_second(angles[1])).to_degrees();
        let first = nearest_turn(branch[0], angles[0] + turned);
        if !self.reaches([first, second], to) {
            return Err(Blocked::Unreachable);
        }
        self.limited([first, second])
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

    /// Azimuth about the first axis, from the second one, to which the second one takes the tool; radians within half a turn of
    /// 0, and between them without a leap on one side.
    fn azimuth_off_second(&self, second: f64) -> f64 {
        let [first, other] = &self.axes;
        let place = other.turn(second) * Vec3::z();
        let across = first.vector.cross(&other.vector);
        across.dot(&place).atan2(across.cross(&first.vector).dot(&place))
    }

    /// How far the great circle between two axes turns about the first rotary axis, degrees; less than half a turn as it does not
    /// meet the pole.
    fn azimuth_change(&self, from: &Vec3, to: &Vec3) -> f64 {
        turn_between(&self.axes[0].vector, from, to).unwrap_or(0.0)
    }

    /// Whether the great circle between two axes comes so near to the first rotary axis that it is along it.
    pub(super) fn meets_pole(&self, from: &Vec3, to: &Vec3) -> bool {
        if self.pole(from).is_some() || self.pole(to).is_some() {
            return true;
        }
        let across = from.cross(to);
        let Some(normal) = across.try_normalize(ROUNDING) else {
            // As good as one axis, or opposite ones, which all great circles join.
            return from.dot(to) < 0.0;
        };
        let first = self.axes[0].vector;
        let nearest = first - normal * normal.dot(&first);
        let is_between =
            |place: &Vec3| normal.dot(&from.cross(place)) >= 0.0 && normal.dot(&place.cross(to)) >= 0.0;
        [nearest, -nearest].iter().any(|place| is_between(place) && self.pole(place).is_some())
    }
}

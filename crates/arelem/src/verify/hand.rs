//! On which hand a path keeps part and drive surface: what tells forward from back in a corner that turns it by more than a right angle.

use apt_geometry::Vec3;

/// Sine between part and drive normal below which they do not tell a hand: where surfaces are nearly tangent paths cross, and what goes
/// straight on there changes it.
const TELLING_SINE: f64 = 0.1;
/// Cosine between normals at both ends of a vector above which the tool touches at the same place (30°).
const SAME_CONTACT_COSINE: f64 = 0.87;

/// Share of the way out of a surface in which a vector sets out that it is off it at least in between, where one and the same contact is read at
/// both ends: what bends evenly is off by a quarter.
const OFF_IN_BETWEEN: f64 = 0.25;

/// Whether a vector leaves the place of contact with one of these normals for good, so that what is read at its end is another one: it sets out too
/// steeply to come back to it within the band.
pub(super) fn leaves(normals: &[Vec3; 2], motion: &Vec3, bands: [f64; 2]) -> bool {
    (0..2).any(|k| OFF_IN_BETWEEN * normals[k].dot(motion) > bands[k])
}

/// The sign of part normal × drive normal · direction. The tool keeps to one side of each surface, so that its path is an edge of what it may
/// reach, and the sign stays along an edge. Where a normal a gives way to b at a second place of contact the path comes along s·p×a to b,
/// b·(s·p×a) < 0, which says the same as a·(s·p×b) > 0: along s·p×b it leaves the first place, whatever angle that turns it by.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hand {
    sign: Option<f64>,
    /// Part and drive normal where the path was seen last.
    normals: Option<[Vec3; 2]>,
    /// The same before a corner, while vectors lead straight on in that, within the bands.
    left: Option<[Vec3; 2]>,
    /// The sign along a whole vector, at both its ends: what a direction or a corner tells is none before.
    shown: Option<f64>,
}

/// Where a contact leaps beside a vertex.
#[derive(Debug, Clone, Copy)]
pub(super) enum Leap {
    /// Before it.
    Behind,
    /// On the vector that leads on.
    Ahead,
}

/// Part normal × drive normal, if it tells.
fn across(normals: &[Vec3; 2]) -> Option<Vec3> {
    Some(normals[0].cross(&normals[1])).filter(|across| across.norm() >= TELLING_SINE)
}

/// Whether both are normals at one place of contact, or at places next to each other.
fn is_same(a: &[Vec3; 2], b: &[Vec3; 2]) -> bool {
    (0..2).all(|k| a[k].dot(&b[k]) >= SAME_CONTACT_COSINE)
}

/// The sign that normals tell with a motion.
pub(super) fn sign_along(normals: &[Vec3; 2], motion: &Vec3) -> Option<f64> {
    let along = across(normals)?.dot(motion);
    (along != 0.0).then(|| along.signum())
}

impl Hand {
    /// The hand of a motion that sets out in a direction, if that is more along the path than across it.
    pub(super) fn setting_out(normals: &[Vec3; 2], forward: &Vec3) -> Self {
        let along = across(normals).map(|across| across.normalize().dot(forward));
        let sign = along.filter(|along| 2.0 * along * along > forward.norm_squared()).map(f64::signum);
        Self { sign, ..Self::default() }
    }

    /// Goes on to a vertex, where the path is taken to go on along a direction; on the vector that leads there it may have kept the hand all the same.
    pub(super) fn follow(&mut self, normals: [Vec3; 2], along: &Vec3, keeps: impl FnOnce(&Self) -> bool) {
        let now = sign_along(&normals, along);
        let is_contrary = now.is_some() && self.sign.is_some() && now != self.sign;
        let is_next = self.normals.is_none_or(|before| is_same(&before, &normals));
        let is_kept = is_contrary && (self.left.is_some() || !is_next || keeps(self));
        if !is_kept {
            self.sign = now;
        }
        self.left = self.left.or(self.normals).filter(|_| is_kept);
        self.normals = Some(normals);
    }

    /// Whether vectors have led straight on beyond a corner.
    pub(super) fn is_beyond_corner(&self) -> bool {
        self.left.is_some()
    }

    /// Part and drive normal of the walls before a corner, while vectors lead straight on in that.
    pub(super) fn walls_of_corner(&self) -> Option<&[Vec3; 2]> {
        self.left.as_ref()
    }

    /// Goes on along a vector with the normals at both ends: the cosine between it and the path on the hand that whole vectors have shown, where both
    /// tell that it leads against that.
    pub(super) fn against(&mut self, ends: &[[Vec3; 2]; 2], direction: &Vec3) -> Option<f64> {
        let cosines = ends.each_ref().map(|normals| self.along(normals).map(|along| along.dot(direction)));
        let [Some(begin), Some(end)] = cosines else { return None };
        if begin > 0.0 && end > 0.0 {
            self.shown = self.sign;
        }
        Some(begin.max(end)).filter(|cosine| *cosine < 0.0 && self.shown.is_some() && self.shown == self.sign)
    }

    /// Whether it is the hand that normals tell with a motion.
    pub(super) fn is_told_by(&self, normals: &[Vec3; 2], motion: &Vec3) -> bool {
        self.sign.is_some() && self.sign == sign_along(normals, motion)
    }

    /// The direction of the path on the same hand along normals.
    fn along(&self, normals: &[Vec3; 2]) -> Option<Vec3> {
        Some(across(normals)?.normalize() * self.sign?)
    }

    /// The direction in which the path goes on from a corner, with the normals of what it follows. The tool touches with the normals `there`,
    /// and another contact is read at the vertex before, `self`, or at the end of the vector that leads on, which may leave that there. `None` where
    /// there is no other one.
    pub(super) fn beyond_corner(
        &self,
        there: &[Vec3; 2],
        at_end: &[Vec3; 2],
        leaves: bool,
    ) -> Option<(Vec3, [Vec3; 2])> {
        let followed = match self.normals {
            // What ends where the tool touches as before the corner leads back from it.
            Some(before) if !is_same(&before, there) => Some(there).filter(|_| !is_same(&before, at_end)),
            _ => Some(at_end).filter(|at_end| leaves || !is_same(there, at_end)),
        }?;
        Some((self.along(followed)?, *followed))
    }

    /// The same where it is known that a contact leaps, be it to a place next to it. On the vector that leads on it leaps to what that ends at; before
    /// it, to what is touched `there`, and what ends more nearly as the tool touched before that leads back from it.
    pub(super) fn beyond_leap(
        &self,
        there: &[Vec3; 2],
        at_end: &[Vec3; 2],
        leap: Leap,
    ) -> Option<(Vec3, [Vec3; 2])> {
        let likeness = |normals: &[Vec3; 2]| normals[0].dot(&at_end[0]) + normals[1].dot(&at_end[1]);
        let followed = match leap {
            Leap::Ahead => at_end,
            Leap::Behind => {
                let before = self.left.or(self.normals)?;
                Some(there).filter(|there| likeness(there) > likeness(&before))?
            }
        };
        Some((self.along(followed)?, *followed))
    }
}

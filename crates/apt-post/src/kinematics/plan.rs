//! With which angles a stretch of positions begins, so that it can be followed to its end.

use apt_geometry::{Vec3, patience::Patience};

use super::{
    Angles, Kinematics,
    follow::Blocked,
    solve::{REACHED, TURN},
};

/// Why a stretch cannot be followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Unplanned {
    /// No angles point there.
    Unreachable {
        /// Index of the axis, the farthest that any beginning comes to.
        at: usize,
    },
    /// The angles would be reached only beyond a limit, from where the machine is.
    Limit {
        /// Index of the axis, the farthest that any beginning comes to.
        at: usize,
        /// Index of the rotary axis.
        which: usize,
        /// The angle that it would need, degrees.
        angle: f64,
    },
}

/// Angles for a stretch of positions that are cut one after the other, without a rapid between them, from where the machine stands.
///
/// Of the solutions for the first position, and their whole turns, it takes the one from which the whole stretch can be followed
/// within the limits, then the preferred sign, then the least turning. From one position to the next the tool axis turns along the
/// great circle and the angles follow it without leaving their side; on the pole, where sides meet, they go on with the
/// solution that is nearest. First positions on the pole take the first angle that the first leaning position needs; later
/// ones keep theirs.
///
/// # Errors
///
/// [`Unplanned`] where no beginning leads to the end. Where who waits has given up it is told of the position that was come to,
/// and means nothing.
pub(crate) fn plan(
    kinematics: &Kinematics,
    axes: &[Vec3],
    here: Angles,
    patience: Patience<'_>,
) -> Result<Vec<Angles>, Unplanned> {
    let first_leaning = axes.iter().position(|axis| kinematics.pole(axis).is_none()).unwrap_or(0);
    let Some(leaning) = axes.get(first_leaning) else { return Ok(Vec::new()) };
    let here = [0, 1].map(|which| kinematics.axes[which].held_within(here[which]));
    let stretch = Stretch { kinematics, axes, first_leaning, here, patience };
    // By whole turns of the first axis the whole way moves along: which turn will do is found out from where it leads to.
    let free = kinematics.without_limit(0);
    let mut best: Option<Walk> = None;
    let mut walk_from = |beginnings: Vec<Angles>| {
        for beginning in beginnings {
            let walk = stretch.walk_within_limits(&free, beginning);
            if best.as_ref().is_none_or(|best| stretch.is_better(&walk, best)) {
                best = Some(walk);
            }
        }
        best.as_ref().is_some_and(|best| best.end.is_none())
    };
    if !walk_from(free.solutions(leaning, here)) {
        walk_from(free.beginnings(leaning, here));
    }
    match best {
        None => Err(unplanned(kinematics.blocked(leaning, here), first_leaning)),
        Some(Walk { angles, end: None }) => Ok(angles),
        Some(Walk { angles, end: Some(blocked) }) => Err(unplanned(blocked, angles.len())),
    }
}

/// What stops at a position.
fn unplanned(blocked: Blocked, at: usize) -> Unplanned {
    match blocked {
        Blocked::Unreachable => Unplanned::Unreachable { at },
        Blocked::Limit { which, angle } => Unplanned::Limit { at, which, angle },
    }
}

/// What is planned.
struct Stretch<'a> {
    kinematics: &'a Kinematics,
    axes: &'a [Vec3],
    /// Index of the first axis off the pole; 0 where there is none.
    first_leaning: usize,
    /// Where the machine stands.
    here: Angles,
    patience: Patience<'a>,
}

/// Angles as far as a beginning leads.
struct Walk {
    angles: Vec<Angles>,
    /// What stops it before the end.
    end: Option<Blocked>,
}

impl Stretch<'_> {
    /// The way from a beginning of the machine whose first axis is free, moved by whole turns to where it stays within the limits;
    /// where no turn does that, it begins with the one that leads farthest, and sides are chosen anew with regard to the limit.
    fn walk_within_limits(&self, free: &Kinematics, beginning: Angles) -> Walk {
        let mut walk = self.walk(free, beginning);
        let (reached, shift) = self.farthest_shift(&walk.angles);
        if walk.end.is_none() && reached == walk.angles.len() {
            for angles in &mut walk.angles {
                angles[0] = self.kinematics.axes[0].held_within(angles[0] + shift);
            }
            return walk;
        }
        self.walk(self.kinematics, [beginning[0] + shift, beginning[1]])
    }

    /// The way of a machine that begins the leaning positions with these angles.
    fn walk(&self, kinematics: &Kinematics, beginning: Angles) -> Walk {
        let mut angles: Vec<Angles> = Vec::with_capacity(self.axes.len());
        let beginning = match kinematics.limited(beginning) {
            Ok(angles) => angles,
            Err(blocked) => return Walk { angles, end: Some(blocked) },
        };
        let leaning = self.axes.get(self.first_leaning).copied().unwrap_or_else(Vec3::z);
        for axis in &self.axes[..self.first_leaning] {
            // As the way that leaves the pole wants it.
            let led = kinematics.follow(&leaning, beginning, axis).ok();
            match led.or_else(|| kinematics.nearest(axis, beginning)) {
                Some(on_pole) => angles.push(on_pole),
                None => return Walk { angles, end: Some(kinematics.blocked(axis, beginning)) },
            }
        }
        angles.push(beginning);
        let mut last = beginning;
        for ends in self.axes[self.first_leaning..].windows(2) {
            if self.patience.ends_after(1) {
                return Walk { angles, end: Some(Blocked::Unreachable) };
            }
            match kinematics.follow(&ends[0], last, &ends[1]) {
                Ok(next) => last = next,
                Err(blocked) => return Walk { angles, end: Some(blocked) },
            }
            angles.push(last);
        }
        Walk { angles, end: None }
    }

    /// How many positions of a way can be within the limits of the first axis at once, and the whole turns that take them there,
    /// degrees: those to the preferred sign, then the least turning.
    fn farthest_shift(&self, angles: &[Angles]) -> (usize, f64) {
        let beyond = REACHED.to_degrees();
        let [lowest, highest] = self.kinematics.axes[0].limits;
        let (mut least, mut greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut reached = 0;
        let mut turns = None;
        for [first, _] in angles {
            least = least.min(*first);
            greatest = greatest.max(*first);
            let from = ((lowest - beyond - least) / TURN).ceil();
            let to = ((highest + beyond - greatest) / TURN).floor();
            if from > to {
                break;
            }
            turns = Some((from, to));
            reached += 1;
        }
        let (Some((from, to)), Some([start, _])) = (turns, angles.first()) else { return (0, 0.0) };
        let least_turning = ((self.here[0] - start) / TURN).round();
        let positive = (-start / TURN).ceil();
        let choices = [least_turning, positive, positive - 1.0].map(|turns| TURN * turns.max(from).min(to));
        let order = |shift: &f64| {
            let begun = [start + shift, 0.0];
            (self.kinematics.against(begun), (begun[0] - self.here[0]).abs())
        };
        let better = |a: f64, b: f64| if order(&b) < order(&a) { b } else { a };
        (reached, choices.into_iter().reduce(better).unwrap_or(0.0))
    }

    /// Whether a way is better than one that was found before it.
    fn is_better(&self, walk: &Walk, before: &Walk) -> bool {
        if walk.end.is_some() || before.end.is_some() {
            // One that ends is only better than one that ends earlier.
            return before.end.is_some() && (walk.end.is_none() || walk.angles.len() > before.angles.len());
        }
        self.order(walk) < self.order(before)
    }

    /// What complete ways are sorted by.
    fn order(&self, walk: &Walk) -> (usize, i64) {
        let against =
            walk.angles.get(self.first_leaning).map_or(0, |angles| self.kinematics.against(*angles));
        (against, walk.angles.first().map_or(0, |angles| Kinematics::steps_between(*angles, self.here)))
    }
}

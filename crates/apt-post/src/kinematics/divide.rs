//! Into how many parts a straight move is divided while the tool axis turns.
//!
//! Between two positions of the tape slides and angles move evenly, and the tool end leaves its straight way. Parts are as long as
//! the tolerance allows, found one after the other, the longest first.
//!
//! What is assured: how far the tool end and the tool axis are off is measured at evenly spread times. Between two of them, h apart,
//! it exceeds the greater of both by no more than h²/8 times a bound of its second derivative, which [`Course`] finds from the
//! rates of the angles and the distances from their axes. A part is taken only where measure and excess together keep the
//! tolerance; where they do not and no measure breaks it, times are spread twice as dense.

use apt_geometry::{Vec3, patience::Patience};

use super::{
    Angles, Carried, Kinematics, Rotary, angle_between,
    solve::{EQUALLY_FAR, REACHED, ROUNDING, farther},
};

/// Parts of a part between which it is measured at first: the quarters.
const FIRST_MEASURES: u32 = 4;
/// The most of them: the excess that is not measured is then 1/256 of what it is at quarters, and a part that is not known to keep
/// the tolerance so is as good as at its end.
const MOST_MEASURES: u32 = 64;
/// Fraction of its length to which the longest part is found.
const LENGTH_FOUND: f64 = 0.01;
/// Fraction of a tolerance that a part aims at: it grows with the square of the length, which is so found half as closely.
const AIM: f64 = 1.0 - LENGTH_FOUND;
/// Lengths that are tried for a part: halved so many times one is as short as rounding.
const MOST_TRIALS: u32 = 50;
/// How many times the length of the part before it the rest of a move may be that is tried as a whole first.
const REST_TRIED: f64 = 2.0;
/// At how many times a move that cannot be divided is looked at for the angles that it would need: within three degrees of a great circle.
const LOOKED_AT: u32 = 64;

/// What a divided move has to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Tolerances {
    /// How far the tool end may be from its place on the straight way at the same time, tape units.
    pub tip: f64,
    /// How far the tool axis may be from that of the great circle at the same time, radians.
    pub axis: f64,
    /// The most positions that a move is divided to.
    pub most: usize,
}

/// Where the machine stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stand {
    /// The tool end in the part, tape units.
    pub tip: Vec3,
    /// The tool axis in the part, a unit vector.
    pub axis: Vec3,
    /// The angles of the rotary axes.
    pub angles: Angles,
}

/// A move needs more positions than are allowed, or no number of them keeps the tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooMany;

/// Positions to which a straight move of the tool end whose axis turns evenly along the great circle is divided, the end included.
///
/// Between them, with all slides and angles moving evenly, the tool end stays within `tolerances.tip` of its place at the same time and
/// the tool axis within `tolerances.axis` of that of the great circle. What the angles of positions themselves are off it comes on top:
/// those that were told for the ends, and those in the dead cone. Where the control leads the tool end, only the axis counts.
///
/// Angles go on along the great circle from those before. Where it meets the pole and the first angle is there another one than
/// the rest of the way needs, the machine turns there, at rest in the part. Where both ends have the same axis, the angles
/// themselves turn evenly.
///
/// # Errors
///
/// [`TooMany`]; so it is where no great circle joins opposite axes, where the angles of the end cannot be followed to, and where
/// who waits has given up.
pub(crate) fn divide(
    kinematics: &Kinematics,
    from: &Stand,
    to: &Stand,
    tolerances: &Tolerances,
    patience: Patience<'_>,
) -> Result<Vec<Stand>, TooMany> {
    let mut stands = Vec::new();
    for leg in legs(kinematics, from, to)? {
        let off = |stand: &Stand| angle_between(&kinematics.axis(stand.angles), &stand.axis);
        let most_off = off(&leg.from).max(off(&leg.to)).max(kinematics.dead_cone);
        Divider { kinematics, leg, tolerances, most_off, patience }.divide(&mut stands)?;
    }
    Ok(stands)
}

/// Which axis would have to turn beyond its end on a move both ends of which it reaches, and the farthest angle at evenly spread times.
pub(crate) fn beyond(kinematics: &Kinematics, from: &Stand, to: &Stand) -> Option<(usize, f64)> {
    let free = kinematics.without_limit(0).without_limit(1);
    let mut farthest = None;
    let mut most = REACHED.to_degrees();
    for leg in legs(&free, from, to).ok()? {
        let mut last = leg.from;
        for place in 1..=LOOKED_AT {
            let time = f64::from(place) / f64::from(LOOKED_AT);
            let axis = leg.axis(time);
            let angles = match leg.turns {
                Turns::Angles => between(leg.from.angles, leg.to.angles, time),
                Turns::Axis { .. } => free.followed(&last.axis, last.angles, &axis).ok()?,
            };
            for (which, angle) in angles.into_iter().enumerate() {
                let off = (angle - kinematics.axes[which].held_within(angle)).abs();
                if off > most {
                    (most, farthest) = (off, Some((which, angle)));
                }
            }
            last = Stand { tip: leg.tip(time), axis, angles };
        }
    }
    farthest
}

/// The parts of a move before, on and behind the pole, where the machine has to turn there; else the move itself.
fn legs(kinematics: &Kinematics, from: &Stand, to: &Stand) -> Result<Vec<Leg>, TooMany> {
    let turned = angle_between(&from.axis, &to.axis);
    let pole = kinematics.pole(&from.axis);
    if turned <= ROUNDING || (pole.is_some() && pole == kinematics.pole(&to.axis)) {
        return Ok(vec![Leg { from: *from, to: *to, turns: Turns::Angles }]);
    }
    let Some(across) = from.axis.cross(&to.axis).try_normalize(ROUNDING) else { return Err(TooMany) };
    let whole = Leg { from: *from, to: *to, turns: Turns::Axis { across: across.cross(&from.axis), turned } };
    let Some(axis) = kinematics.pole_between(&from.axis, &to.axis) else { return Ok(vec![whole]) };
    let time = (angle_between(&from.axis, &axis) / turned).min(1.0);
    let on_pole = |stand: &Stand| {
        let angles = kinematics.follow(&stand.axis, stand.angles, &axis).map_err(|_| TooMany)?;
        Ok(Stand { tip: whole.tip(time), axis, angles })
    };
    let (before, behind) = (on_pole(from)?, on_pole(to)?);
    if farther(before.angles, behind.angles) <= EQUALLY_FAR {
        return Ok(vec![whole]);
    }
    let mut all = Vec::new();
    if time > 0.0 {
        all.push(Leg { to: before, turns: whole.turns.until(time), ..whole });
    }
    all.push(Leg { from: before, to: behind, turns: Turns::Angles });
    if time < 1.0 {
        let left = Turns::Axis { across: across.cross(&axis), turned: turned * (1.0 - time) };
        all.push(Leg { from: behind, to: *to, turns: left });
    }
    Ok(all)
}

/// What turns evenly on a leg.
#[derive(Clone, Copy)]
enum Turns {
    /// The angles; the axis stays.
    Angles,
    /// The tool axis, by so many radians towards a direction across it.
    Axis { across: Vec3, turned: f64 },
}

impl Turns {
    /// The same up to a time.
    fn until(self, time: f64) -> Turns {
        match self {
            Turns::Angles => Turns::Angles,
            Turns::Axis { across, turned } => Turns::Axis { across, turned: turned * time },
        }
    }

    /// Radians by which the axis turns in all.
    fn turned(self) -> f64 {
        match self {
            Turns::Angles => 0.0,
            Turns::Axis { turned, .. } => turned,
        }
    }
}

/// A move on which angles are followed without a turn on the pole.
#[derive(Clone, Copy)]
struct Leg {
    from: Stand,
    to: Stand,
    turns: Turns,
}

impl Leg {
    /// The place of the tool end at a time from 0 to 1.
    fn tip(&self, time: f64) -> Vec3 {
        self.from.tip.lerp(&self.to.tip, time)
    }

    /// The tool axis then.
    fn axis(&self, time: f64) -> Vec3 {
        match self.turns {
            Turns::Angles => self.from.axis,
            Turns::Axis { across, turned } => {
                let (sine, cosine) = (turned * time).sin_cos();
                self.from.axis * cosine + across * sine
            }
        }
    }

    /// Where the machine stands then, coming from an earlier stand; nowhere where angles cannot follow.
    fn stand(&self, kinematics: &Kinematics, last: &Stand, time: f64) -> Option<Stand> {
        if time >= 1.0 {
            return Some(self.to);
        }
        let axis = self.axis(time);
        let angles = match self.turns {
            Turns::Angles => between(self.from.angles, self.to.angles, time),
            Turns::Axis { .. } => {
                // Where both ends are near a limit the great circle may lead beyond it, and at the limit is near enough.
                let angles = kinematics.followed(&last.axis, last.angles, &axis).ok()?;
                [0, 1].map(|which| kinematics.axes[which].held_within(angles[which]))
            }
        };
        Some(Stand { tip: self.tip(time), axis, angles })
    }
}

/// Angles that turn evenly, at a time from 0 to 1.
fn between(from: Angles, to: Angles, time: f64) -> Angles {
    [0, 1].map(|which| from[which] + (to[which] - from[which]) * time)
}

/// Divides a leg.
struct Divider<'a> {
    kinematics: &'a Kinematics,
    leg: Leg,
    tolerances: &'a Tolerances,
    /// Radians by which positions may themselves be off their axis: by the angles that were told for the ends, and in the dead cone.
    most_off: f64,
    patience: Patience<'a>,
}

impl Divider<'_> {
    /// Appends the positions of the leg.
    fn divide(&self, stands: &mut Vec<Stand>) -> Result<(), TooMany> {
        let mut parts = vec![(0.0, self.leg.from)];
        let (mut time, mut last) = (0.0, self.leg.from);
        let mut length = 1.0;
        while time < 1.0 {
            if stands.len() + parts.len() > self.tolerances.most {
                return Err(TooMany);
            }
            (time, last) = self.longest(&last, time, &mut length)?;
            parts.push((time, last));
        }
        self.even_out(&mut parts);
        stands.extend(parts.into_iter().skip(1).map(|(_, stand)| stand));
        Ok(())
    }

    /// The farthest time and stand to which the tolerances are kept from a stand at a time. `length` is that of the part before it,
    /// and then of this one.
    fn longest(&self, last: &Stand, time: f64, length: &mut f64) -> Result<(f64, Stand), TooMany> {
        let rest = 1.0 - time;
        let mut kept: Option<(f64, Stand)> = None;
        let (mut least, mut broken) = (0.0, f64::INFINITY);
        // All that is left is tried first where it is not far longer than the part before.
        let mut tried = if *length * REST_TRIED >= rest { rest } else { *length };
        for _ in 0..MOST_TRIALS {
            if self.patience.ends_after(1) {
                return Err(TooMany);
            }
            let end = if tried >= rest { 1.0 } else { time + tried };
            if end <= time {
                // As short as rounding: nothing keeps the tolerances.
                break;
            }
            let stand = self.leg.stand(self.kinematics, last, end);
            let (share, is_kept) = stand.map_or((f64::INFINITY, false), |to| self.measure(last, &to, tried));
            if is_kept {
                (least, kept) = (tried, stand.map(|stand| (end, stand)));
            } else {
                broken = tried;
            }
            if least >= rest
                || broken - least <= LENGTH_FOUND * least
                || (is_kept && share >= AIM - LENGTH_FOUND)
            {
                break;
            }
            let aimed = tried * (AIM / share).sqrt();
            let is_between =
                aimed > least * (1.0 + LENGTH_FOUND / 2.0) && aimed < broken * (1.0 - LENGTH_FOUND / 2.0);
            tried = match (is_between, broken.is_finite()) {
                (true, true) => aimed,
                (false, true) => (least + broken) / 2.0,
                (_, false) => aimed.min(rest),
            };
        }
        *length = least;
        kept.ok_or(TooMany)
    }

    /// Puts the last division into the middle of the last two parts where the last part is a short rest, if the tolerances are
    /// kept so.
    fn even_out(&self, parts: &mut [(f64, Stand)]) {
        let [.., (first, from), (divided, stand), (last, to)] = parts else { return };
        let half = (*last - *first) / 2.0;
        let middle = *first + half;
        if *divided <= middle {
            return;
        }
        let Some(between) = self.leg.stand(self.kinematics, from, middle) else { return };
        if self.keeps(from, &between, half) && self.keeps(&between, to, half) {
            (*divided, *stand) = (middle, between);
        }
    }

    /// Whether the tool is known to keep the tolerances between two stands, which are so far apart in time.
    fn keeps(&self, from: &Stand, to: &Stand, length: f64) -> bool {
        self.measure(from, to, length).1
    }

    /// The share of the tolerances that the tool was measured to need between two stands, and whether it is known to keep them.
    fn measure(&self, from: &Stand, to: &Stand, length: f64) -> (f64, bool) {
        let course = Course::new(self.kinematics, from, to, self.leg.turns.turned() * length);
        let ends = course.off(0.0).worse(&course.off(1.0));
        let allowed =
            Deviation { tip: self.tolerances.tip, axis: self.tolerances.axis + ends.axis.min(self.most_off) };
        let bend = course.bend();
        let mut worst = ends;
        let mut measures = FIRST_MEASURES;
        let mut step = 1;
        while measures <= MOST_MEASURES {
            for index in (1..measures).step_by(step) {
                worst = worst.worse(&course.off(f64::from(index) / f64::from(measures)));
            }
            if !worst.is_within(&allowed) {
                break;
            }
            let excess = 1.0 / (8.0 * f64::from(measures).powi(2));
            let most =
                Deviation { tip: worst.tip + bend.tip * excess, axis: worst.axis + bend.axis * excess };
            if most.is_within(&allowed) {
                return (worst.share(&allowed), true);
            }
            // The even ones are known.
            measures *= 2;
            step = 2;
        }
        (worst.share(&allowed), false)
    }
}

/// How far the tool is off, or how fast that bends.
#[derive(Clone, Copy)]
pub(super) struct Deviation {
    /// Of the tool end, tape units.
    pub(super) tip: f64,
    /// Of the tool axis, as the chord between unit vectors, which is as good as the angle in radians.
    pub(super) axis: f64,
}

impl Deviation {
    /// The greater of both.
    fn worse(&self, other: &Deviation) -> Deviation {
        Deviation { tip: self.tip.max(other.tip), axis: self.axis.max(other.axis) }
    }

    /// The greater share of what is allowed.
    fn share(&self, allowed: &Deviation) -> f64 {
        (self.tip / allowed.tip).max(self.axis / allowed.axis)
    }

    /// Whether nothing is off farther; what is no number is.
    fn is_within(&self, allowed: &Deviation) -> bool {
        self.tip <= allowed.tip && self.axis <= allowed.axis
    }
}

/// What the machine does between two stands: slides and angles move evenly.
pub(super) struct Course<'a> {
    kinematics: &'a Kinematics,
    from: &'a Stand,
    to: &'a Stand,
    /// Words of both stands.
    words: [Vec3; 2],
    /// Radians between both axes along the great circle.
    turned: f64,
}

impl<'a> Course<'a> {
    pub(super) fn new(kinematics: &'a Kinematics, from: &'a Stand, to: &'a Stand, turned: f64) -> Self {
        let words = [from, to].map(|stand| kinematics.frame(stand.angles).place(stand.tip));
        Self { kinematics, from, to, words, turned }
    }

    /// How far the tool is off at a time from 0 to 1.
    fn off(&self, time: f64) -> Deviation {
        Deviation { tip: self.tip_off(time).norm(), axis: self.axis_off(time).norm() }
    }

    /// From the place on the straight way to the tool end.
    pub(super) fn tip_off(&self, time: f64) -> Vec3 {
        if !self.kinematics.slides {
            return Vec3::zeros();
        }
        let frame = self.kinematics.frame(between(self.from.angles, self.to.angles, time));
        frame.part(self.words[0].lerp(&self.words[1], time)) - self.from.tip.lerp(&self.to.tip, time)
    }

    /// From the axis of the great circle to that of the tool.
    pub(super) fn axis_off(&self, time: f64) -> Vec3 {
        self.kinematics.axis(between(self.from.angles, self.to.angles, time)) - self.ideal_axis(time)
    }

    /// The axis of the great circle.
    fn ideal_axis(&self, time: f64) -> Vec3 {
        let sine = self.turned.sin();
        if sine <= ROUNDING {
            return self.from.axis.lerp(&self.to.axis, time);
        }
        let weights = [(self.turned * (1.0 - time)).sin() / sine, (self.turned * time).sin() / sine];
        self.from.axis * weights[0] + self.to.axis * weights[1]
    }

    /// Bounds of the second derivatives of both deviations.
    pub(super) fn bend(&self) -> Deviation {
        let [first, second] = &self.kinematics.axes;
        let turn = |which: usize| [self.from.angles[which], self.to.angles[which]];
        let still = Moving { ends: [Vec3::z(); 2], rate: 0.0, bend: 0.0 };
        let axis = still.turned(second, &Vec3::zeros(), turn(1)).turned(first, &Vec3::zeros(), turn(0));
        let axis = axis.bend + self.turned * self.turned;
        if !self.kinematics.slides {
            return Deviation { tip: 0.0, axis };
        }
        let mut spindle = still;
        for which in [1, 0] {
            let rotary = &self.kinematics.axes[which];
            if rotary.carried == Carried::Head {
                spindle = spindle.turned(rotary, &Vec3::zeros(), turn(which));
            }
        }
        let mut tip = Moving::evenly(self.words).less_pivot(&spindle, self.kinematics.pivot);
        for which in [1, 0] {
            let rotary = &self.kinematics.axes[which];
            if rotary.carried == Carried::Table {
                tip = tip.turned(rotary, &rotary.center, turn(which));
            }
        }
        Deviation { tip: tip.bend, axis }
    }
}

/// A place that moves in the time from 0 to 1, with bounds of its first and second derivative.
#[derive(Clone, Copy)]
struct Moving {
    ends: [Vec3; 2],
    rate: f64,
    bend: f64,
}

impl Moving {
    /// A place that moves evenly.
    fn evenly(ends: [Vec3; 2]) -> Moving {
        Moving { ends, rate: (ends[1] - ends[0]).norm(), bend: 0.0 }
    }

    /// The place while a rotary axis turns it evenly about a center by angles of both ends.
    ///
    /// With the rate ω of the turn and r the distance from the axis, the rate is at most ωr more and the bend ω²r and twice ω
    /// times the rate.
    fn turned(&self, rotary: &Rotary, center: &Vec3, degrees: [f64; 2]) -> Moving {
        let omega = (degrees[1] - degrees[0]).abs().to_radians();
        let distance = |place: &Vec3| rotary.vector.cross(&(place - center)).norm();
        // At any time one of the ends is not farther than half of it.
        let far = distance(&self.ends[0]).max(distance(&self.ends[1])) + self.rate / 2.0;
        let turned = |which: usize| rotary.turn(degrees[which]) * (self.ends[which] - center) + center;
        Moving {
            ends: [turned(0), turned(1)],
            rate: self.rate + omega * far,
            bend: self.bend + 2.0 * omega * self.rate + omega * omega * far,
        }
    }

    /// The place less the way that a pivot takes the tool end along the direction of the spindle.
    fn less_pivot(&self, spindle: &Moving, pivot: f64) -> Moving {
        let end = |which: usize| self.ends[which] - (spindle.ends[which] - Vec3::z()) * pivot;
        let pivot = pivot.abs();
        Moving {
            ends: [end(0), end(1)],
            rate: self.rate + spindle.rate * pivot,
            bend: self.bend + spindle.bend * pivot,
        }
    }
}

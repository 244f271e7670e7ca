//! Section 3: WCORN, the inside corner between two walls inside of VTLAXS (language reference 6.11).
//!
//! The tool that stood vertically in the corner leans over the first wall by one angle and over the second by another.
//! Along the line in which both leaning walls meet it can stand only in the corner itself, so that its axis turns on
//! the way into the corner and on the way out: from a starting position on the path, in equal steps of foot and axis,
//! to the corner, and from there to an ending position. Where the line leans back over the path, starting (or ending)
//! position lie as far from the corner as the tool needs to stay clear of the other wall up to the height of the walls.

use apt_geometry::Vec3;

use crate::tilt::{Order, Pose, TiltError};

/// Steps into the corner, and out of it, where WCORN does not say how many.
const STEPS: u32 = 6;
/// Fewest steps; smaller numbers count as this one.
const FEWEST_STEPS: u32 = 3;
/// Most steps that a WCORN may ask for.
pub(crate) const MOST_STEPS: u32 = 10_000;
/// How far beyond the shortest distance starting and ending position may lie, inches.
const MARGIN: f64 = 0.1;
/// A step smaller than this in each component (inches; for the axis a number) is not made.
const SMALLEST_STEP: f64 = 5e-4;
/// Smallest sine of the turn between the walls, away from the wall.
const SMALLEST_TURN: f64 = 0.01;
/// Cosine between path and line of the corner below which the line does not lean over the path.
const SMALLEST_LEAN: f64 = 0.002;
/// Most trials for starting and ending position, each with the direction that the one before has given.
const MOST_TRIALS: usize = 50;
/// Relative difference of lengths along the path below which a position is the one wanted.
const LENGTH_FRACTION: f64 = 1e-12;
/// Smallest vertical component of the axis in the corner.
const SMALLEST_RISE: f64 = 1e-6;

/// The statement WCORN.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// Tilt over the first and over the second wall, degrees, to the left positive.
    pub incoming: f64,
    pub outgoing: f64,
    /// Height of the walls.
    pub height: f64,
    /// Steps into the corner, and out of it.
    pub steps: u32,
}

impl Corner {
    /// Takes over the last parameter of WCORN.
    pub(crate) fn steps(asked: Option<f64>) -> Result<u32, TiltError> {
        let Some(asked) = asked else { return Ok(STEPS) };
        let steps = asked.abs().trunc();
        if steps > f64::from(MOST_STEPS) || steps.is_nan() {
            return Err(TiltError::CornerSteps { steps: asked });
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "range checked above")]
        Ok((steps as u32).max(FEWEST_STEPS))
    }
}

/// The tilted positions of a path with a corner at one of its positions. There is one list for each position: what
/// stands in its place.
///
/// `order` is VTLAXS/ON, `end` the tilt of VTLAXS/OFF in degrees, `inch` the length of an inch.
pub(crate) fn tilted(
    order: &Order,
    corner: &Corner,
    path: &[Vec3],
    at: usize,
    end: f64,
    inch: f64,
) -> Result<Vec<Vec<Pose>>, TiltError> {
    let back = Leg::new(path.iter().take(at + 1).rev().copied());
    let ahead = Leg::new(path.iter().skip(at).copied());
    let Some(begin) = back.first() else { return Err(TiltError::NoMotionBeforeCorner) };
    let Some(finish) = ahead.first() else { return Err(TiltError::NoMotionAfterCorner) };
    let (begin, finish, walls) = settled(order, corner, (&back, begin), (&ahead, finish), inch)?;
    let (entering, leaving) = walls.turns(order, corner, back.at(begin), ahead.at(finish), inch)?;

    let mut result: Vec<Vec<Pose>> = Vec::with_capacity(path.len());
    let mut entering = Some(entering);
    let path = path.iter().copied().zip(arrivals(path)).enumerate();
    for (index, (position, arrival)) in path.clone().take(at + 1) {
        let length = back.lengths.get(at - index).copied().unwrap_or(0.0);
        if length > begin * (1.0 + LENGTH_FRACTION) {
            let travelled = (back.total() - length) / (back.total() - begin);
            let degrees = order.start + (corner.incoming - order.start) * travelled;
            result.push(vec![order.tilted(position, arrival, degrees)?]);
        } else {
            result.push(entering.take().unwrap_or_default());
        }
    }
    let mut leaving = Some(leaving);
    for (index, (position, arrival)) in path.skip(at + 1) {
        let length = ahead.lengths.get(index - at).copied().unwrap_or(0.0);
        let mut poses = Vec::new();
        if length >= finish * (1.0 - LENGTH_FRACTION) {
            poses = leaving.take().unwrap_or_default();
        }
        if length > finish * (1.0 + LENGTH_FRACTION) {
            let travelled = (length - finish) / (ahead.total() - finish);
            let degrees = corner.outgoing + (end - corner.outgoing) * travelled;
            poses.push(order.tilted(position, arrival, degrees)?);
        }
        result.push(poses);
    }
    Ok(result)
}

/// The directions in which a path arrives at its positions; at the first ones, in which it leaves. A position that
/// repeats the one before keeps its direction.
fn arrivals(path: &[Vec3]) -> Vec<Vec3> {
    let steps = || path.windows(2).map(|pair| pair[1] - pair[0]);
    let mut direction = steps().find(|step| step.norm() > 0.0).unwrap_or_else(Vec3::zeros);
    let mut arrivals = vec![direction];
    for step in steps() {
        if step.norm() > 0.0 {
            direction = step;
        }
        arrivals.push(direction);
    }
    arrivals
}

/// The path from the corner in one sense.
struct Leg {
    positions: Vec<Vec3>,
    /// Lengths along the path from the corner.
    lengths: Vec<f64>,
}

impl Leg {
    fn new(positions: impl Iterator<Item = Vec3>) -> Self {
        let positions: Vec<Vec3> = positions.collect();
        let mut length = 0.0;
        let mut lengths = vec![0.0];
        for pair in positions.windows(2) {
            length += (pair[1] - pair[0]).norm();
            lengths.push(length);
        }
        Leg { positions, lengths }
    }

    fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Length to the first position that is not the corner itself.
    fn first(&self) -> Option<f64> {
        self.lengths.iter().copied().find(|length| *length > 0.0)
    }

    /// The position at a length.
    fn at(&self, length: f64) -> Vec3 {
        let spans = self.lengths.windows(2).zip(self.positions.windows(2));
        for (lengths, positions) in spans {
            if length <= lengths[1] && lengths[1] > lengths[0] {
                let part = (length - lengths[0]) / (lengths[1] - lengths[0]);
                return positions[0] + (positions[1] - positions[0]) * part;
            }
        }
        self.positions.last().copied().unwrap_or_else(Vec3::zeros)
    }

    /// Unit direction from the corner to the position at a length; none where the path comes back to the corner.
    fn direction(&self, length: f64) -> Option<Vec3> {
        let length = if length > 0.0 { length } else { self.first()? };
        let corner = self.positions.first()?;
        (self.at(length) - corner).try_normalize(length * LENGTH_FRACTION)
    }

    /// A length that is not below the one wanted: the present one if it will do, the next position, or a place between
    /// two; none if the path is shorter.
    fn settle(&self, present: f64, wanted: f64, margin: f64) -> Option<f64> {
        let wanted = wanted.max(0.0);
        let will_do = |length: &f64| *length >= wanted && *length <= wanted + margin;
        if will_do(&present) {
            return Some(present);
        }
        if let Some(length) = self.lengths.iter().copied().find(will_do) {
            return Some(length);
        }
        (wanted <= self.total()).then(|| (wanted + margin / 2.0).min(self.total()))
    }
}

/// Finds starting and ending position as lengths from the corner. Along a curve each changes the direction of the walls,
/// and with it what is wanted.
fn settled(
    order: &Order,
    corner: &Corner,
    (back, mut begin): (&Leg, f64),
    (ahead, mut finish): (&Leg, f64),
    inch: f64,
) -> Result<(f64, f64, Walls), TiltError> {
    let margin = MARGIN * inch;
    let (mut starts, mut ends) = (false, false);
    for _ in 0..MOST_TRIALS {
        let incoming = back.direction(begin).ok_or(TiltError::NoStartOfCorner)?;
        let outgoing = ahead.direction(finish).ok_or(TiltError::NoEndOfCorner)?;
        let walls = Walls::new(order, corner, -incoming, outgoing)?;
        let wanted = |length: Option<f64>| length.map(|length| length + margin);
        let new_begin = match wanted(walls.clearing(order, corner, Sense::Back)) {
            None => 0.0,
            Some(wanted) => back
                .settle(begin, wanted, margin)
                .ok_or(TiltError::ShortBeforeCorner { wanted, length: back.total() })?,
        };
        let new_finish = match wanted(walls.clearing(order, corner, Sense::Ahead)) {
            None => 0.0,
            Some(wanted) => ahead
                .settle(finish, wanted, margin)
                .ok_or(TiltError::ShortAfterCorner { wanted, length: ahead.total() })?,
        };
        // At the corner itself the direction is that of the first position, with which the search has begun.
        let stays = |old: f64, new: f64, leg: &Leg| old == new || (new == 0.0 && Some(old) == leg.first());
        starts = stays(begin, new_begin, back);
        ends = stays(finish, new_finish, ahead);
        (begin, finish) = (new_begin, new_finish);
        if starts && ends {
            return Ok((begin, finish, walls));
        }
    }
    Err(match (starts, ends) {
        (false, true) => TiltError::NoStartOfCorner,
        (true, false) => TiltError::NoEndOfCorner,
        _ => TiltError::NoWayThroughCorner,
    })
}

/// Which of the two ways from the corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sense {
    Back,
    Ahead,
}

/// The two leaning walls and the line in which they meet.
struct Walls {
    /// Unit directions of the path into the corner and out of it.
    incoming: Vec3,
    outgoing: Vec3,
    /// Axes of the tool along the two walls.
    first_axis: Vec3,
    second_axis: Vec3,
    /// Unit direction of the line, upwards.
    line: Vec3,
}

impl Walls {
    fn new(order: &Order, corner: &Corner, incoming: Vec3, outgoing: Vec3) -> Result<Self, TiltError> {
        let wall = order.wall(incoming)?;
        if -wall.dot(&outgoing) <= SMALLEST_TURN {
            return Err(TiltError::CornerOpen);
        }
        let (_, first_axis) = order.tilted(Vec3::zeros(), incoming, corner.incoming)?;
        let (_, second_axis) = order.tilted(Vec3::zeros(), outgoing, corner.outgoing)?;
        let line = incoming.cross(&first_axis).cross(&outgoing.cross(&second_axis));
        let line = line.try_normalize(0.0).ok_or(TiltError::Vertical)?;
        let line = if line.z < 0.0 { -line } else { line };
        if line.z < SMALLEST_RISE {
            return Err(TiltError::Vertical);
        }
        Ok(Walls { incoming, outgoing, first_axis, second_axis, line })
    }

    /// How far from the corner the tool has to stand that leans over one wall, so as not to touch the other; none where
    /// the line of the corner leans away from the path.
    fn clearing(&self, order: &Order, corner: &Corner, sense: Sense) -> Option<f64> {
        let (away, other, axis) = match sense {
            Sense::Back => (-self.incoming, self.outgoing, self.first_axis),
            Sense::Ahead => (self.outgoing, -self.incoming, self.second_axis),
        };
        let lean = away.dot(&self.line);
        if lean <= SMALLEST_LEAN {
            return None;
        }
        let leaning = corner.height / self.line.z * lean;
        // The other wall as the leaning tool sees it, along its axis.
        let seen = (other - axis * axis.dot(&other)).try_normalize(0.0)?;
        let stand_off = |other: Vec3| {
            let half = other.dot(&away).clamp(-1.0, 1.0).acos() / 2.0;
            order.radius * half.cos() / half.sin()
        };
        Some(leaning + stand_off(seen) - stand_off(other))
    }

    /// The positions from a starting position to the corner, both included, and from there to an ending position.
    fn turns(
        &self,
        order: &Order,
        corner: &Corner,
        begin: Vec3,
        finish: Vec3,
        inch: f64,
    ) -> Result<(Vec<Pose>, Vec<Pose>), TiltError> {
        let first = order.foot(begin, self.incoming, corner.incoming)?;
        let second = order.foot(finish, self.outgoing, corner.outgoing)?;
        // Where the lines of both feet meet, at the height of the first.
        let across = self.incoming.x * self.outgoing.y - self.incoming.y * self.outgoing.x;
        let apart = second - first;
        let along = (apart.x * self.outgoing.y - apart.y * self.outgoing.x) / across;
        let meeting =
            Vec3::new(first.x + along * self.incoming.x, first.y + along * self.incoming.y, first.z);
        if !meeting.iter().all(|value| value.is_finite()) {
            return Err(TiltError::Vertical);
        }
        let away = |degrees: f64| degrees * order.side < 0.0;
        let below = order.below && (away(corner.incoming) || away(corner.outgoing));
        let pose =
            |foot: Vec3, axis: Vec3| -> Pose { (foot + axis * (order.lift(&axis, below) / axis.z), axis) };
        let between = |from: (Vec3, Vec3), to: (Vec3, Vec3), part: f64| -> Result<Pose, TiltError> {
            let axis = (from.1 + (to.1 - from.1) * part).try_normalize(0.0).ok_or(TiltError::Vertical)?;
            Ok(pose(from.0 + (to.0 - from.0) * part, axis))
        };
        let (start, turn, stop) =
            ((first, self.first_axis), (meeting, self.line), (second, self.second_axis));
        let steps = |from: (Vec3, Vec3), to: (Vec3, Vec3)| {
            let change = ((to.0 - from.0).amax() / inch).max((to.1 - from.1).amax());
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "steps are few")]
            let steps = (change / SMALLEST_STEP).min(f64::from(corner.steps)) as u32;
            steps
        };
        let mut entering = Vec::new();
        let count = steps(start, turn);
        for step in 0..count {
            entering.push(between(start, turn, f64::from(step) / f64::from(count))?);
        }
        entering.push(pose(turn.0, turn.1));
        let count = steps(turn, stop);
        let parts = (1..=count).map(|step| f64::from(step) / f64::from(count));
        let leaving = parts.map(|part| between(turn, stop, part)).collect::<Result<_, _>>()?;
        Ok((entering, leaving))
    }
}

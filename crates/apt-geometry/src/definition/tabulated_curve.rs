//! The directrix of a tabulated cylinder: from points and tangents in the (u,v) plane to cubics over chords.
//!
//! Slopes are kept as directions, so that vertical tangents are nothing special; a slope relative to a chord is local
//! and finite as long as the curve does not stand on its chord.

use super::circle::three_point_tangents;
use super::solve::{coincidence, roots};
use super::tabulated_newton::{self, STEEPEST};
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::Interval;

/// Length of the straight extensions at both ends, in part-program units (APT III).
const EXTENSION: f64 = 10.0;
/// Part of the way to their meeting point to which extensions that would meet are shortened (APT III).
const SHORTENED: f64 = 0.99;
/// Jump of curvature, per part-program unit, that the spline leaves at most (APT III; it stops here, and a TABCYL is
/// to have the numbers that it has there).
const CURVATURE_JUMP: f64 = 1e-3;
/// Newton steps on one point before the next one is taken (APT III).
const NEWTON_STEPS: usize = 5;
/// Cosine of the angle to the chord below which a tangent stands on it.
const UPRIGHT: f64 = 1e-9;
/// Height of a cubic term over its chord, relative to the chord, that is rounding.
const FLAT: f64 = 1e-14;
/// Most points that a TABCYL takes; APT III had room for 139, the bound here only keeps the spline's work finite.
const MOST_POINTS: usize = 2_000;

/// One data point in the (u,v) plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    pub(super) place: [f64; 2],
    /// Direction of the curve, of any length and either sense.
    pub(super) tangent: Option<[f64; 2]>,
}

/// The finished directrix, extensions included.
pub(super) struct Curve {
    pub(super) intervals: Vec<Interval>,
    pub(super) last: [f64; 2],
}

/// A chord between neighbouring points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chord {
    pub(super) start: Vec3,
    pub(super) along: Vec3,
    pub(super) length: f64,
}

impl Chord {
    fn left(&self) -> Vec3 {
        Vec3::new(-self.along.y, self.along.x, 0.0)
    }

    /// Slope of a direction in the system of the chord.
    fn slope(&self, direction: &Vec3) -> Result<f64, Impossible> {
        let forward = self.along.dot(direction);
        if forward.abs() <= UPRIGHT {
            return Err(Impossible::Singular);
        }
        Ok(self.left().dot(direction) / forward)
    }

    /// The unit direction with a slope in the system of the chord.
    fn direction(&self, slope: f64) -> Vec3 {
        (self.along + self.left() * slope) / slope.hypot(1.0)
    }

    /// The place in the system of the chord.
    fn local(&self, place: &Vec3) -> (f64, f64) {
        let from_start = place - self.start;
        (self.along.dot(&from_start), self.left().dot(&from_start))
    }
}

/// The curve through `samples` by one of FOURPT, TWOPT, SPLINE, PTSLOP, PTNORM.
///
/// # Errors
/// Too few or too many points (APT III 1001), neighbouring points that coincide, or a tangent that stands on a chord.
pub(super) fn build(samples: &[Sample], option: Modifier) -> Result<Curve, DefinitionError> {
    let all_tangents = samples.iter().all(|sample| sample.tangent.is_some());
    let least = match option {
        Modifier::FourPoint => 4,
        _ if all_tangents => 2,
        _ => 3,
    };
    if samples.len() < least || samples.len() > MOST_POINTS {
        return Err(DefinitionError::Special { number: 1001, position: None });
    }
    let places: Vec<Vec3> =
        samples.iter().map(|sample| Vec3::new(sample.place[0], sample.place[1], 0.0)).collect();
    let chords = chords(&places)?;
    let (cubics, ends) = match option {
        Modifier::FourPoint => four_point(&places, &chords)?,
        _ => {
            let given: Vec<Option<Vec3>> = samples.iter().map(tangent).collect();
            let mut directions = circle_tangents(&places, &given)?;
            if option == Modifier::Spline {
                directions = spline_tangents(&chords, &given, &directions);
            }
            from_tangents(&chords, &directions)?
        }
    };
    Ok(with_extensions(&places, &chords, &cubics, ends))
}

fn tangent(sample: &Sample) -> Option<Vec3> {
    sample.tangent.and_then(|[u, v]| Vec3::new(u, v, 0.0).try_normalize(0.0))
}

fn chords(places: &[Vec3]) -> Result<Vec<Chord>, Impossible> {
    places
        .windows(2)
        .map(|pair| {
            let across = pair[1] - pair[0];
            let length = across.norm();
            if length <= coincidence(pair[0].amax().max(pair[1].amax())) {
                return Err(Impossible::Coincident { distance: length });
            }
            Ok(Chord { start: pair[0], along: across / length, length })
        })
        .collect()
}

/// The given tangents; where none is given, that of the circle through three neighbours.
fn circle_tangents(places: &[Vec3], given: &[Option<Vec3>]) -> Result<Vec<Vec3>, Impossible> {
    let last = places.len() - 1;
    (0..=last)
        .map(|index| {
            if let Some(direction) = given[index] {
                return Ok(direction);
            }
            let tangents = if index == 0 {
                three_point_tangents(&places[0], &places[1], &places[2]).map(|found| found.1)
            } else if index == last {
                three_point_tangents(&places[last], &places[last - 1], &places[last - 2])
                    .map(|found| -found.1)
            } else {
                three_point_tangents(&places[index - 1], &places[index], &places[index + 1])
                    .map(|found| found.0)
            };
            tangents.ok_or(Impossible::Singular)
        })
        .collect()
}

/// A cubic over its chord, as in [`Interval`].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cubic {
    a: f64,
    b: f64,
}

impl Cubic {
    /// Slope over the chord at `s`.
    fn slope(&self, s: f64, length: f64) -> f64 {
        3.0 * self.a * s * s + 2.0 * self.b * s - (self.a * length + self.b) * length
    }

    fn height(&self, s: f64, length: f64) -> f64 {
        s * (s - length) * (self.a * (s + length) + self.b)
    }

    /// Terms that are rounding are dropped, so that straight intervals are straight.
    fn cleaned(self, length: f64) -> Cubic {
        let keep = |value: f64, scale: f64| if (value * scale).abs() <= FLAT { 0.0 } else { value };
        Cubic { a: keep(self.a, length * length), b: keep(self.b, length) }
    }

    /// Greatest and least height over the chord, divided by its length. Rounding is no bump: the signs of both matter.
    fn extremes(&self, length: f64) -> (f64, f64) {
        let turns = roots(&[-(self.a * length + self.b) * length, 2.0 * self.b, 3.0 * self.a], 0.0, length);
        turns
            .iter()
            .map(|s| self.height(*s, length) / length)
            .filter(|height| height.abs() > FLAT)
            .fold((0.0, 0.0), |(most, least), height| (f64::max(most, height), f64::min(least, height)))
    }
}

type Cubics = (Vec<Cubic>, [Vec3; 2]);

fn from_tangents(chords: &[Chord], directions: &[Vec3]) -> Result<Cubics, Impossible> {
    let mut cubics = Vec::with_capacity(chords.len());
    for (chord, ends) in chords.iter().zip(directions.windows(2)) {
        let (start, end) = (chord.slope(&ends[0])?, chord.slope(&ends[1])?);
        let length = chord.length;
        cubics.push(Cubic { a: (start + end) / (length * length), b: -(2.0 * start + end) / length });
    }
    Ok((cubics, [directions[0], directions[directions.len() - 1]]))
}

/// Each interval takes the cubic through its ends and their outer neighbours; the end intervals through the four
/// outermost points. Divided by `u(u−L)` the height of a cubic over its chord is linear in u.
fn four_point(places: &[Vec3], chords: &[Chord]) -> Result<Cubics, Impossible> {
    let last = places.len() - 1;
    let mut cubics = Vec::with_capacity(chords.len());
    for (index, chord) in chords.iter().enumerate() {
        let first = index.clamp(1, last - 2) - 1;
        let outer = (first..first + 4).filter(|place| *place != index && *place != index + 1);
        let mut stations = Vec::with_capacity(2);
        for place in outer {
            let (u, v) = chord.local(&places[place]);
            let divisor = u * (u - chord.length);
            if divisor.abs() <= UPRIGHT * chord.length * chord.length {
                return Err(Impossible::Singular);
            }
            stations.push((u, v / divisor));
        }
        let [(u1, q1), (u2, q2)] = [stations[0], stations[1]];
        if (u2 - u1).abs() <= UPRIGHT * chord.length {
            return Err(Impossible::Singular);
        }
        let a = (q2 - q1) / (u2 - u1);
        cubics.push(Cubic { a, b: q1 - a * (u1 + chord.length) });
    }
    let end = chords.len() - 1;
    let ends = [
        chords[0].direction(cubics[0].slope(0.0, chords[0].length)),
        chords[end].direction(cubics[end].slope(chords[end].length, chords[end].length)),
    ];
    Ok((cubics, ends))
}

/// The tangents of a spline: those of APT III, unless its turns ran away on data that swing from side to side.
fn spline_tangents(chords: &[Chord], given: &[Option<Vec3>], start: &[Vec3]) -> Vec<Vec3> {
    let mut relaxed = start.to_vec();
    let converged = relax(chords, given, &mut relaxed).unwrap_or(false);
    let runaway = (0..relaxed.len()).any(|point| ran_away(chords, &relaxed, point));
    if converged && !runaway {
        return relaxed;
    }
    // Where there is no such curve, one without corners is left; the jumps of curvature show in the finished curve.
    let otherwise = if runaway { start.to_vec() } else { relaxed };
    tabulated_newton::continuous(chords, given, start).unwrap_or(otherwise)
}

/// Whether the tangent at a point stands on one of its chords, or runs with the one and against the other.
fn ran_away(chords: &[Chord], directions: &[Vec3], point: usize) -> bool {
    let Some(direction) = directions.get(point) else { return false };
    let around = [point.checked_sub(1), Some(point)];
    let along: Vec<f64> =
        around.iter().flatten().filter_map(|chord| Some(chords.get(*chord)?.along.dot(direction))).collect();
    along.iter().any(|cosine| cosine.abs() < STEEPEST.cos() || cosine.signum() != along[0].signum())
}

/// Turns the tangents at the inner points until the curvature is continuous to within [`CURVATURE_JUMP`]: always at
/// the point with the greatest jump. A free end follows its neighbour, so that the end interval is a parabola. The
/// order of the steps, the limits, and the jump at the last inner point, which is not renewed when the free end behind
/// it follows, are those of APT III (APREPB), because they show in the sixth digit. Points with a given tangent keep
/// it.
///
/// Says whether all jumps became small enough.
fn relax(chords: &[Chord], given: &[Option<Vec3>], directions: &mut [Vec3]) -> Result<bool, Impossible> {
    let last = chords.len();
    let inner: Vec<usize> = (1..last).filter(|index| given[*index].is_none()).collect();
    let follow_start = |directions: &mut [Vec3]| -> Result<(), Impossible> {
        if given[0].is_none() {
            directions[0] = chords[0].direction(-chords[0].slope(&directions[1])?);
        }
        Ok(())
    };
    let follow_end = |directions: &mut [Vec3]| -> Result<(), Impossible> {
        if given[last].is_none() {
            let chord = &chords[last - 1];
            directions[last] = chord.direction(-chord.slope(&directions[last - 1])?);
        }
        Ok(())
    };
    follow_start(directions)?;
    follow_end(directions)?;
    let mut jumps = vec![0.0; last + 1];
    for index in &inner {
        jumps[*index] = jump(chords, directions, *index)?;
    }
    // APT III allows as many turns as it keeps numbers for the points, four times.
    let most_turns = 4 * (7 * directions.len() + 6);
    for _ in 0..most_turns {
        let Some(worst) = worst(&inner, &jumps) else { return Ok(true) };
        turn(chords, directions, &mut jumps, worst)?;
        if worst > 1 {
            jumps[worst - 1] = jump(chords, directions, worst - 1)?;
        } else if given[0].is_none() {
            follow_start(directions)?;
            jumps[worst] = jump(chords, directions, worst)?;
        }
        if worst + 1 < last {
            jumps[worst + 1] = jump(chords, directions, worst + 1)?;
        } else {
            follow_end(directions)?;
        }
    }
    Ok(worst(&inner, &jumps).is_none())
}

/// The inner point with the greatest jump, if that is too great; of equal ones the first.
fn worst(inner: &[usize], jumps: &[f64]) -> Option<usize> {
    let mut found = None;
    let mut most = CURVATURE_JUMP;
    for index in inner {
        if jumps[*index].abs() > most {
            most = jumps[*index].abs();
            found = Some(*index);
        }
    }
    found
}

/// Jump of curvature at an inner point: curvature after it less curvature before it.
fn jump(chords: &[Chord], directions: &[Vec3], index: usize) -> Result<f64, Impossible> {
    let (before, after) = (&chords[index - 1], &chords[index]);
    let start = before.slope(&directions[index - 1])?;
    let end = before.slope(&directions[index])?;
    let curvature_before = (2.0 * start + 4.0 * end) / (before.length * (1.0 + end * end).powf(1.5));
    let start = after.slope(&directions[index])?;
    let end = after.slope(&directions[index + 1])?;
    let curvature_after = -(4.0 * start + 2.0 * end) / (after.length * (1.0 + start * start).powf(1.5));
    Ok(curvature_after - curvature_before)
}

/// Turns the tangent at one inner point by Newton steps with the derivative of the unrolled curve.
fn turn(
    chords: &[Chord],
    directions: &mut [Vec3],
    jumps: &mut [f64],
    index: usize,
) -> Result<(), Impossible> {
    let (before, after) = (&chords[index - 1], &chords[index]);
    let derivative = -4.0 * (before.length + after.length) / (before.length * after.length);
    for _ in 0..NEWTON_STEPS {
        let slope = after.slope(&directions[index])? - jumps[index] / derivative;
        directions[index] = after.direction(slope);
        jumps[index] = jump(chords, directions, index)?;
        if jumps[index].abs() <= CURVATURE_JUMP {
            break;
        }
    }
    Ok(())
}

fn with_extensions(places: &[Vec3], chords: &[Chord], cubics: &[Cubic], ends: [Vec3; 2]) -> Curve {
    let last = places.len() - 1;
    let mut head = outward(&places[0], &places[1], &ends[0]);
    let mut tail = outward(&places[last], &places[last - 1], &ends[1]);
    shorten(&places[0], &places[last], &mut head, &mut tail);
    let straight = |from: &Vec3, to: &Vec3| Interval {
        u: from.x,
        v: from.y,
        a: 0.0,
        b: 0.0,
        length: (to - from).norm(),
        maximum: 0.0,
        minimum: 0.0,
    };
    let mut intervals = vec![straight(&head, &places[0])];
    for (chord, cubic) in chords.iter().zip(cubics) {
        let Cubic { a, b } = cubic.cleaned(chord.length);
        let (maximum, minimum) = Cubic { a, b }.extremes(chord.length);
        let (u, v) = (chord.start.x, chord.start.y);
        intervals.push(Interval { u, v, a, b, length: chord.length, maximum, minimum });
    }
    intervals.push(straight(&places[last], &tail));
    Curve { intervals, last: [tail.x, tail.y] }
}

/// The far end of the extension at `end`, away from the neighbour.
fn outward(end: &Vec3, neighbour: &Vec3, direction: &Vec3) -> Vec3 {
    let sense = if direction.dot(&(neighbour - end)) > 0.0 { -1.0 } else { 1.0 };
    end + direction * (sense * EXTENSION)
}

/// Extensions that would cross end shortly before their meeting point.
fn shorten(first: &Vec3, last: &Vec3, head: &mut Vec3, tail: &mut Vec3) {
    let (from_first, from_last) = (*head - first, *tail - last);
    let cross = |a: &Vec3, b: &Vec3| a.x * b.y - a.y * b.x;
    let turn = cross(&from_first, &from_last);
    if turn.abs() <= UPRIGHT * EXTENSION * EXTENSION {
        return;
    }
    let between = last - first;
    let (of_head, of_tail) = (cross(&between, &from_last) / turn, cross(&between, &from_first) / turn);
    // Both meet ahead, and at least one of them within its length.
    if of_head >= 0.0 && of_tail >= 0.0 && (of_head < 1.0 || of_tail < 1.0) {
        *head = first + from_first * (of_head * SHORTENED);
        *tail = last + from_last * (of_tail * SHORTENED);
    }
}

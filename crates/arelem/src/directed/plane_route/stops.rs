//! Where the path of the exact route stops: the crossings and tangencies with the check surface, counted from its start.

use apt_geometry::motion::{CheckSurface, Relation};

use super::{Candidate, Prepared, START_ANGLE, Track, TrackCurve};
use crate::{
    error::{Course, MotionFailure},
    plane_curve::Curve,
    position,
};

/// The stop asked for; `None` where the vectors decide which one that is.
pub(super) fn choose(
    prepared: &Prepared,
    check: &CheckSurface,
    track: &Track,
    stop: &Curve,
) -> Result<Option<Candidate>, MotionFailure> {
    match check.relation {
        Relation::To | Relation::Past | Relation::On => {
            Crossings::new(prepared, check, track, stop).asked_for()
        }
        Relation::TangentToDrive | Relation::TangentToPart => {
            tangency(prepared, check, track, stop).map(Some)
        }
    }
}

/// The places of a path at which the tool is TO, ON or PAST a line or circle.
struct Crossings<'a> {
    prepared: &'a Prepared<'a>,
    check: &'a CheckSurface,
    track: &'a Track,
    stop: &'a Curve,
    /// Distance from the curve at which the tool is there; none where its end is.
    reach: f64,
}

impl<'a> Crossings<'a> {
    fn new(prepared: &'a Prepared<'a>, check: &'a CheckSurface, track: &'a Track, stop: &'a Curve) -> Self {
        let reach = if check.relation == Relation::On { 0.0 } else { prepared.tool.radius() };
        Crossings { prepared, check, track, stop, reach }
    }

    fn is_on(&self) -> bool {
        self.check.relation == Relation::On
    }

    /// Signed distance of the tool from the curve: with ON by side, else below zero in it.
    fn value(&self, x: f64) -> f64 {
        let distance = self.stop.signed_distance(&self.track.at(x), &self.track.axis);
        if self.is_on() { distance } else { distance.abs() - self.reach }
    }

    fn is_there(&self, value: f64) -> bool {
        self.prepared.checks[0].is_there(value, self.prepared.size)
    }

    /// All of one turn, in the order of the path.
    fn all(&self) -> Vec<Candidate> {
        // A tool without width is TO and PAST a line at the same place.
        let levels: &[f64] = if self.is_on() { &[0.0] } else { &[self.reach, -self.reach] };
        let at = |level: f64| {
            let places = self.track.crossings(self.stop, level).into_iter();
            places.map(move |x| Candidate { x, level })
        };
        let mut all: Vec<Candidate> = levels.iter().flat_map(|level| at(*level)).collect();
        all.sort_by(|a, b| a.x.total_cmp(&b.x));
        all
    }

    /// The one that the statement counts to; `None` where the vectors decide which one that is.
    fn asked_for(&self) -> Result<Option<Candidate>, MotionFailure> {
        let all = self.all();
        if all.is_empty() {
            return Err(self.never_met());
        }
        let start = self.value(0.0);
        let mut remaining = self.check.occurrence.max(1);
        let mut leaving = self.is_there(start);
        let mut clear = !leaving && start > 0.0;
        let mut previous: Option<Candidate> = None;
        let mut touched = None;
        for candidate in turns(self.track, &all, self.check.occurrence) {
            // Already there at the start: only the next position counts.
            if leaving && (1..=3).all(|k| self.is_there(self.value(candidate.x * f64::from(k) / 4.0))) {
                previous = Some(candidate);
                continue;
            }
            // Lines and circles are symmetric: between two positions the tool is the farthest in, or out again, half way.
            let from = previous.replace(candidate);
            let between = self.value(0.5 * (from.map_or(0.0, |from| from.x) + candidate.x));
            if std::mem::take(&mut leaving) {
                clear = between > 0.0;
            }
            let was_clear = clear;
            clear = !was_clear;
            if !self.is_asked(was_clear) {
                continue;
            }
            match self.touch(from, candidate, between) {
                Touch::Unsure => return Ok(None),
                Touch::Only => {
                    touched.get_or_insert((between.abs(), candidate.x));
                    continue;
                }
                Touch::No => {}
            }
            remaining -= 1;
            if remaining == 0 {
                return Ok(Some(candidate));
            }
        }
        Err(match touched {
            Some((depth, x)) => self.missed((depth, x), true, true, Course::Analytic),
            None => MotionFailure::NoneAhead { check: 0, relation: self.check.relation, found: all.len() },
        })
    }

    /// Whether a place is the kind that the statement asks for: TO comes out of the clear, PAST out of the curve.
    fn is_asked(&self, was_clear: bool) -> bool {
        match self.check.relation {
            Relation::To => was_clear,
            Relation::Past => !was_clear,
            _ => true,
        }
    }

    /// Whether between a place and the one before it, on the same side of the curve, the tool only touches that.
    fn touch(&self, from: Option<Candidate>, to: Candidate, between: f64) -> Touch {
        if !from.is_some_and(|from| self.is_on() || from.level * to.level > 0.0) {
            return Touch::No;
        }
        let limit = self.prepared.checks[0].touch_limit();
        // Vectors about a circle run elsewhere in the band of the drive surface.
        let unsure = if self.track.closed() { self.prepared.drive.band() } else { 0.0 };
        if (between.abs() - limit).abs() < unsure {
            Touch::Unsure
        } else if between.abs() <= limit {
            Touch::Only
        } else {
            Touch::No
        }
    }

    /// Why no place of the path is there.
    fn never_met(&self) -> MotionFailure {
        let (x, nearest) = self.track.nearest(self.stop, &|x| self.value(x).abs());
        let is_there = self.is_there(self.value(0.0));
        self.missed((nearest, x), is_there, false, self.track.never_meets(self.stop))
    }

    fn missed(
        &self,
        (nearest, x): (f64, f64),
        is_there: bool,
        is_touched: bool,
        course: Course,
    ) -> MotionFailure {
        MotionFailure::NeverMet {
            check: 0,
            relation: self.check.relation,
            nearest,
            at: self.track.at(x),
            is_there,
            is_touched,
            turns_back: None,
            course,
        }
    }
}

/// Whether the tool goes through the check surface between two places, or only touches it.
enum Touch {
    No,
    Only,
    /// The vectors decide.
    Unsure,
}

/// The candidates ahead, repeated over as many turns as the count can need.
fn turns(track: &Track, all: &[Candidate], occurrence: u32) -> Vec<Candidate> {
    if !track.closed() {
        return all.iter().copied().filter(|c| c.x >= 0.0).collect();
    }
    let count = occurrence.clamp(1, MAXIMUM_TURNS) + 1;
    (0..count)
        .flat_map(|turn| {
            let offset = f64::from(turn) * std::f64::consts::TAU;
            all.iter().map(move |c| Candidate { x: c.x + offset, level: c.level })
        })
        .collect()
}

/// Turns about a circle that a count of intersections can ask for.
const MAXIMUM_TURNS: u32 = 1000;

fn tangency(
    prepared: &Prepared,
    check: &CheckSurface,
    track: &Track,
    stop: &Curve,
) -> Result<Candidate, MotionFailure> {
    let places: Vec<f64> = match (&track.curve, stop) {
        (TrackCurve::Line { .. }, Curve::Line { .. }) => {
            return Err(MotionFailure::TangentLines { check: 0 });
        }
        (TrackCurve::Line { direction }, Curve::Circle { center, .. }) => {
            vec![(center - track.from).dot(direction)]
        }
        (TrackCurve::Circle { center, .. }, _) => match stop.parallel_directions(center, &track.axis) {
            Some(towards) => vec![track.angle(&towards, 0.0), track.angle(&towards, std::f64::consts::PI)],
            None => Vec::new(),
        },
    };
    let working = &prepared.checks[0];
    let reach = if working.gauge.on { 0.0 } else { prepared.tool.radius() };
    let mut nearest = f64::INFINITY;
    let mut tangent: Vec<Candidate> = Vec::new();
    for x in places {
        let distance = stop.signed_distance(&track.at(x), &track.axis);
        let gap = distance.abs() - reach;
        // What is rounding far away, where the path begins, may be none here, where the next one does.
        if working.is_there(gap, position::size(&prepared.tool, &track.at(x))) {
            tangent.push(Candidate { x, level: distance.signum() * reach });
        } else if gap.abs() < nearest.abs() {
            nearest = gap;
        }
    }
    if tangent.is_empty() {
        return Err(MotionFailure::NotTangent { check: 0, gap: nearest });
    }
    let found = tangent.len();
    tangent.sort_by(|a, b| a.x.total_cmp(&b.x));
    let start = if track.closed() { START_ANGLE } else { START_ANGLE * prepared.size };
    let wanted = check.occurrence.max(1) as usize - 1;
    turns(track, &tangent, check.occurrence)
        .into_iter()
        .filter(|c| c.x > start)
        .nth(wanted)
        .ok_or(MotionFailure::NoneAhead { check: 0, relation: check.relation, found })
}

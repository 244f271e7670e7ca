//! POSN, PATH, ZIGZAG and PICKFD (sculptured surfaces reference 4.5).

use apt_geometry::{
    Vec3,
    canonical::Plane,
    regional::{FeedDirection, ParameterRange, Pass, Region, RegionalCommand, Retract, Sense},
};

use super::{
    Job, Milled, Sink,
    station::{Course, Station},
};
use crate::{error::MillingError, tool::Pose};

/// A rest of the range across the passes, as a share of it, that is no pass of its own.
const REST: f64 = 1e-9;
/// Sine of the angle between a direction and a plane below which the one does not lead to the other.
const ALONG_PLANE: f64 = 1e-9;

/// Carries out the command.
pub(super) fn run(job: &Job<'_>, milled: &mut Milled) -> Result<(), MillingError> {
    let mut sink = Sink::new(milled, job);
    match &job.command.command {
        RegionalCommand::Position { start, retract } => job.position(*start, retract, &mut sink),
        RegionalCommand::Path(pass) => {
            let lane = job.lane(pass)?;
            let first = job.first_station(pass.start, &lane.course)?;
            sink.milled.passes = 1;
            if !pass.skip {
                job.put(&first, &lane.course, &mut sink)?;
            }
            job.pass(first, &lane.course, lane.limit(pass.sense), &mut sink)?;
            Ok(())
        }
        RegionalCommand::Zigzag(region) => job.zigzag(region, &mut sink),
        RegionalCommand::Pickfeed { region, clearance } => job.pickfeed(region, clearance, &mut sink),
    }
}

/// The passes of a command: how they run and between what limits.
struct Lane {
    course: Course,
    range: ParameterRange,
}

impl Lane {
    fn limit(&self, sense: Sense) -> f64 {
        match sense {
            Sense::Plus => self.range.high,
            Sense::Minus => self.range.low,
        }
    }
}

fn opposite(sense: Sense) -> Sense {
    match sense {
        Sense::Plus => Sense::Minus,
        Sense::Minus => Sense::Plus,
    }
}

fn other(direction: FeedDirection) -> FeedDirection {
    match direction {
        FeedDirection::Spline => FeedDirection::CrossSpline,
        FeedDirection::CrossSpline => FeedDirection::Spline,
    }
}

fn component(parameters: [f64; 2], direction: FeedDirection) -> f64 {
    match direction {
        FeedDirection::Spline => parameters[0],
        FeedDirection::CrossSpline => parameters[1],
    }
}

/// The pose slid along `direction` to a plane.
fn to_plane(pose: &Pose, direction: &Vec3, plane: &Plane) -> Result<Pose, MillingError> {
    let slope = plane.normal.dot(direction);
    if slope.abs() <= ALONG_PLANE {
        return Err(MillingError::PlaneNotReached);
    }
    let way = (plane.distance - plane.normal.dot(&pose.end)) / slope;
    Ok(Pose { end: pose.end + direction * way, axis: pose.axis })
}

impl Job<'_> {
    fn lane(&self, pass: &Pass) -> Result<Lane, MillingError> {
        let outside = || MillingError::OutsideRange { parameters: pass.start };
        for direction in [FeedDirection::Spline, FeedDirection::CrossSpline] {
            let range = self.guide.range(direction);
            if range.is_some_and(|range| !range.admits(component(pass.start, direction))) {
                return Err(outside());
            }
        }
        // A guide curve has one direction, whatever the word says.
        let direction =
            if self.guide.range(pass.direction).is_some() { pass.direction } else { FeedDirection::Spline };
        let range = self.guide.range(direction).ok_or_else(outside)?;
        let course = Course { direction, sign: pass.sense.sign(), stock: self.thickness() };
        Ok(Lane { course, range })
    }

    /// Where a command begins. Its axis may depend on the part, and then the very first drop has a vertical one, as in the
    /// public system. Where no step could lead from there to where the next locations are, it is settled as those are.
    fn first_station(&self, parameters: [f64; 2], course: &Course) -> Result<Station, MillingError> {
        let failed = |cause| MillingError::NoFirstContact { parameters, cause };
        let first = self.station(parameters, course, None).map_err(failed)?;
        if !self.command.axis.follows_part() {
            return Ok(first);
        }
        let out_of_reach = |settled: &Station| {
            let away = (settled.center - first.center).norm();
            away > self.greatest_move(&first, settled, course.stock)
        };
        Ok(self.station(parameters, course, Some(&first)).ok().filter(out_of_reach).unwrap_or(first))
    }

    fn position(&self, start: [f64; 2], retract: &Retract, sink: &mut Sink<'_>) -> Result<(), MillingError> {
        let pass = Pass { start, direction: FeedDirection::Spline, sense: Sense::Plus, skip: false };
        let course = self.lane(&pass)?.course;
        let station = self.first_station(start, &course)?;
        let Pose { end, axis } = station.pose;
        let back = -station.guide.projection;
        let pose = match retract {
            Retract::Distance(distance) => Pose { end: end + back * *distance, axis },
            Retract::Vector(vector) => Pose { end: end + vector, axis },
            Retract::Plane(plane) => to_plane(&station.pose, &back, plane)?,
        };
        self.put_free(pose, sink)
    }

    fn zigzag(&self, region: &Region, sink: &mut Sink<'_>) -> Result<(), MillingError> {
        let lane = self.lane(&region.pass)?;
        let mut sense = region.pass.sense;
        let mut first = self.first_station(region.pass.start, &lane.course)?;
        if !region.pass.skip {
            self.put(&first, &lane.course, sink)?;
        }
        loop {
            sink.milled.passes += 1;
            let course = Course { sign: sense.sign(), ..lane.course };
            let stations = self.pass(first, &course, lane.limit(sense), sink)?;
            let last = stations.last().copied().unwrap_or(first);
            let Some(across) = self.next_pass(region, &course, &stations, sink.milled.passes)? else {
                return Ok(());
            };
            sense = opposite(sense);
            let next = Course { sign: sense.sign(), ..lane.course };
            first = self.step_over(&last, across, region, &next, sink)?;
            sink.feed(region.feed.cutting);
        }
    }

    fn pickfeed(&self, region: &Region, clearance: &Plane, sink: &mut Sink<'_>) -> Result<(), MillingError> {
        let lane = self.lane(&region.pass)?;
        let course = lane.course;
        let mut first = self.first_station(region.pass.start, &course)?;
        let mut skip = region.pass.skip;
        loop {
            sink.milled.passes += 1;
            if !skip {
                self.put(&first, &course, sink)?;
            }
            skip = false;
            let stations = self.pass(first, &course, lane.limit(region.pass.sense), sink)?;
            let last = stations.last().copied().unwrap_or(first);
            let Some(across) = self.next_pass(region, &course, &stations, sink.milled.passes)? else {
                return Ok(());
            };
            sink.feed(region.feed.rapid);
            for from in [&last, &first] {
                self.put_free(to_plane(&from.pose, &from.pose.axis, clearance)?, sink)?;
            }
            sink.feed(region.feed.plunge);
            self.put(&first, &course, sink)?;
            first = self.step_over(&first, across, region, &course, sink)?;
            sink.feed(region.feed.cutting);
        }
    }

    /// The parameter across of the next pass; `None` after the last one, which is exactly at the end of the range.
    fn next_pass(
        &self,
        region: &Region,
        course: &Course,
        stations: &[Station],
        passes: u32,
    ) -> Result<Option<f64>, MillingError> {
        let direction = other(course.direction);
        let range = self.guide.range(direction).ok_or(MillingError::CurveHasOnePass)?;
        let sign = region.stepover_sense.sign();
        let limit = if sign > 0.0 { range.high } else { range.low };
        let Some(now) = stations.first().map(|station| component(station.parameters, direction)) else {
            return Ok(None);
        };
        let room = (limit - now) * sign;
        let rest = REST * (range.high - range.low).abs();
        if room <= rest || region.stepover.passes.is_some_and(|most| passes >= most) {
            return Ok(None);
        }
        let step = self.stepover(stations, &region.stepover, course.direction, sign, room);
        Ok(Some(if step >= room - rest { limit } else { now + sign * step }))
    }

    /// Goes from a station to the parameter `across` of the next pass, lifted if the condition says so, and plunges. The
    /// station there, which has been put out.
    fn step_over(
        &self,
        from: &Station,
        across: f64,
        region: &Region,
        next: &Course,
        sink: &mut Sink<'_>,
    ) -> Result<Station, MillingError> {
        let direction = other(next.direction);
        let (lift, sign) = (region.stepover.lift, region.stepover_sense.sign());
        let course = Course { direction, sign, stock: self.thickness() + lift };
        sink.feed(region.feed.stepover);
        let failed = |parameters| move |cause| MillingError::NoFirstContact { parameters, cause };
        let start = self.station(from.parameters, &course, Some(from)).map_err(failed(from.parameters))?;
        if lift != 0.0 {
            self.put(&start, &course, sink)?;
        }
        let stations = self.pass(start, &course, across, sink)?;
        let last = stations.last().copied().unwrap_or(start);
        let arrived = self.station(last.parameters, next, Some(&last)).map_err(failed(last.parameters))?;
        if lift != 0.0 {
            sink.feed(region.feed.plunge);
            self.put(&arrived, next, sink)?;
        }
        Ok(arrived)
    }
}

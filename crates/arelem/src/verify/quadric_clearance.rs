//! Clearance of the whole tool to a quadric, from exact point distances.
//!
//! The tool's boundary is taken apart into edge circles, the corner torus (a circle of balls) and straight patches. The
//! candidate of each part is a stationary point; the least is the clearance. Where the solid is convex the tangent
//! plane at the contact proves the minimum at once (distance is a convex function); inside a convex hollow distance is
//! concave, so only edges matter and the corners of a circumscribed polygon bound what lies between samples.

mod bodies;
mod bulge;
mod hollow;
mod planes;
mod tangents;

use apt_geometry::Vec3;

use self::{bodies::Body, bulge::Bulge};
use super::{
    circle_contact,
    clearance::{Reading, Shape},
    quadric::{PointDistance, PrincipalQuadric},
    tool::{Meridian, Tool, perpendicular},
};

/// Azimuths sampled on a circle before local minima are closed in.
const AZIMUTHS: usize = 16;
/// Halvings of a sector between two azimuths where the surface is a saddle and a circle may have two troughs beside each
/// other: two that are farther apart than a 512th of a turn are told apart.
const SECTOR_HALVINGS: u32 = 5;
/// Steps of a safeguarded secant search; bisection alone reaches round-off in fewer.
const STEPS: usize = 100;
/// Shortest part of a straight piece between two readings where the surface is a saddle.
const LINE_PIECES: f64 = 16.0;
/// Width of the azimuth, radians, at which a trough has closed in: the distance is then off by its square.
const AZIMUTH_WIDTH: f64 = 1e-7;
/// The same where the normal at the contact proves it: the proof is off by the width times the length of the patch.
const PROVING_WIDTH: f64 = 1e-9;
/// Rounding of a distance, relative to the coordinates that it is read at: values that are closer do not tell which place is nearer.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Parts of a patch that are looked at or left out as a whole.
const PATCH_PIECES: u32 = 16;

/// A point of the tool with its distance on the tool's side.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    value: f64,
    point: Vec3,
    normal: Vec3,
}

struct Search<'a> {
    quadric: &'a PrincipalQuadric,
    side: f64,
    tip: Vec3,
    tool: &'a Tool<'a>,
    across: [Vec3; 2],
    /// How distance varies over places on a side.
    shape: Shape,
    /// A solid may reach into the top of the tool.
    open_top: bool,
    /// Of two convex bodies the one that is looked at.
    body: Option<Body>,
    best: Option<Candidate>,
    /// Greatest amount by which the true minimum could be below the best candidate.
    gap: f64,
}

/// Whether a convex solid may reach into the top of a tool on a straight move: its lowest place along the axis comes over the
/// disc there, and not as deep as the middle of the tool. Nothing touches that disc (arelem reference 1.3), and where it is
/// what is nearest of the tool as a closed body, the clearance of the others is no convex function of the way.
fn may_reach_into_top(quadric: &PrincipalQuadric, side: f64, ends: [&Vec3; 2], tool: &Tool<'_>) -> bool {
    let (up, tip) = (quadric.turned_in(&tool.axis), quadric.turned_in(ends[0]));
    let lowest = quadric.farthest(side, &-up, &tip);
    lowest.is_some_and(|lowest| is_over_top(&quadric.turned_out(&lowest), ends, tool))
}

/// The same by the lowest place of the solid.
pub(super) fn is_over_top(lowest: &Vec3, ends: [&Vec3; 2], tool: &Tool<'_>) -> bool {
    let Some(radius) = tool.profile.open_top() else { return false };
    let away = lowest - ends[0];
    let height = away.dot(&tool.axis);
    let way = ends[1] - ends[0];
    let climb = way.dot(&tool.axis);
    let across = (way - tool.axis * climb).norm();
    (away - tool.axis * height).norm() <= radius + across
        && height - climb.min(0.0) >= 0.5 * tool.profile.top_height()
}

/// How the clearance of a tool varies along a straight move. Distance is concave inside each of two
/// convex bodies, and not in both together: a tool that has parts in one and in the other is deep in what lies between.
pub(super) fn shape(quadric: &PrincipalQuadric, side: f64, ends: [&Vec3; 2], tool: &Tool<'_>) -> Shape {
    let shape = quadric.convexity.shape(side);
    if shape == Shape::Convex && may_reach_into_top(quadric, side, ends, tool) {
        return Shape::Free;
    }
    match quadric.mirror() {
        Some((normal, distance)) if shape == Shape::Concave => {
            let heights = ends.map(|tip| normal.dot(tip) - distance);
            let low = heights[0].min(heights[1]) - tool.support(&-normal).0;
            let high = heights[0].max(heights[1]) + tool.support(&normal).0;
            if low < 0.0 && high > 0.0 { Shape::Free } else { shape }
        }
        _ => shape,
    }
}

/// The clearance; None where the quadric has no distance.
pub(super) fn at(quadric: &PrincipalQuadric, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
    if quadric.is_ruled_along(&tool.axis) {
        // Seen along the rulings the tool is a disc: exact.
        let PointDistance { distance, normal } = quadric.distance(tip)?;
        let value = side * distance - tool.profile.widest();
        return Some(Reading::new(value, normal * side, 0.0));
    }
    let along = shape(quadric, side, [tip, tip], tool);
    let convex = quadric.convexity.shape(side) == Shape::Convex;
    // Distance from a convex solid is a convex function of the place, also where that of the whole tool is not.
    let shape = if convex { Shape::Convex } else { along };
    let shown = circle_contact::at(quadric, shape, side, tip, tool);
    let open_top = convex && along != shape;
    let shown = shown.or_else(|| open_top.then(|| circle_contact::at(quadric, along, side, tip, tool))?);
    if shown.is_some() {
        return shown;
    }
    if let Some(pair) = quadric.pair(side) {
        return bodies::at(quadric, pair, side, tip, tool);
    }
    let mut search = Search { shape, open_top, ..Search::of(quadric, side, tip, tool) };
    search.run()?;
    let best = search.best?;
    Some(Reading::new(best.value, best.normal, search.gap))
}

impl<'a> Search<'a> {
    fn of(quadric: &'a PrincipalQuadric, side: f64, tip: &Vec3, tool: &'a Tool<'a>) -> Self {
        let first = perpendicular(&tool.axis);
        Self {
            quadric,
            side,
            tip: *tip,
            tool,
            across: [first, tool.axis.cross(&first)],
            shape: Shape::Free,
            open_top: false,
            body: None,
            best: None,
            gap: 0.0,
        }
    }
}

impl Search<'_> {
    fn radial(&self, phi: f64) -> Vec3 {
        let (s, c) = phi.sin_cos();
        self.across[0] * c + self.across[1] * s
    }

    fn radial_rate(&self, phi: f64) -> Vec3 {
        let (s, c) = phi.sin_cos();
        self.across[1] * c - self.across[0] * s
    }

    fn place(&self, p: Meridian, phi: f64) -> Vec3 {
        self.tip + self.radial(phi) * p[0] + self.tool.axis * p[1]
    }

    /// Distance of a point on the tool's side and its gradient; None when the search is given up, too.
    fn distance(&self, x: &Vec3) -> Option<(f64, Vec3)> {
        if self.tool.patience.ends_after(1) {
            return None;
        }
        if let Some(body) = &self.body {
            return body.distance(self.quadric, self.side, x);
        }
        let d = self.quadric.distance(x)?;
        Some((self.side * d.distance, d.normal * self.side))
    }

    fn offer(&mut self, candidate: Candidate) {
        if self.best.is_none_or(|b| candidate.value < b.value) {
            self.best = Some(candidate);
        }
    }

    fn best_value(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |b| b.value)
    }

    fn run(&mut self) -> Option<()> {
        self.gap = 0.0;
        let bulge = Bulge::of(self.tool.profile);
        let corner = self.tool.profile.corner().filter(|_| bulge.is_none());
        if let Some((center, radius)) = corner {
            self.circle(center, radius)?;
        }
        if let Some(bulge) = &bulge {
            self.bulge(bulge)?;
        }
        if self.proven() {
            return Some(());
        }
        let mut done: Vec<Meridian> = Vec::with_capacity(4);
        for edge in std::iter::once([0.0; 2]).chain(self.tool.profile.edges()) {
            if done.contains(&edge) {
                continue;
            }
            done.push(edge);
            self.circle(edge, 0.0)?;
            if self.proven() {
                return Some(());
            }
        }
        if self.shape == Shape::Concave {
            if let Some((center, radius)) = corner {
                self.prove_circle(center, radius)?;
            }
            if let Some(bulge) = &bulge {
                self.prove_bulge(bulge)?;
            }
            for edge in done {
                self.prove_circle(edge, 0.0)?;
            }
        } else {
            for (a, b) in self.tool.profile.lines() {
                if a != b {
                    self.near_patches(a, b)?;
                    if self.proven() {
                        return Some(());
                    }
                }
            }
            if self.shape == Shape::Convex {
                let open = self.nearest_by_tangents()?;
                if self.open_top {
                    // Of the arc of the corner no more is told than its contacts.
                    self.gap = open;
                } else if !self.proven() {
                    self.turn_planes();
                }
            }
        }
        Some(())
    }

    /// Whether the tangent plane at the best contact proves that nothing of the tool is nearer (convex solids).
    fn proven(&mut self) -> bool {
        let (Shape::Convex, Some(best)) = (self.shape, self.best) else { return false };
        let least = best.normal.dot(&(self.tip - best.point)) - self.tool.support(&-best.normal).0;
        let scale = self.tool.profile.reach();
        let gap = (-least).max(0.0);
        // What the tangent plane misses at an open top is the disc that nothing touches.
        self.gap = if self.open_top { 0.0 } else { gap };
        gap <= 1e-11 * scale
    }

    /// Candidates on the circle through a meridian point, with a ball of `radius` round each of its points; of the balls of
    /// the corner only contacts count whose normal is in the fan of the arc.
    fn circle(&mut self, p: Meridian, radius: f64) -> Option<()> {
        let middle = self.place([0.0, p[1]], 0.0);
        let (at_axis, _) = self.distance(&middle)?;
        if p[0] <= 0.0 {
            return self.accept(p, 0.0, radius);
        }
        if at_axis - p[0] - radius >= self.best_value() {
            return Some(());
        }
        let step = std::f64::consts::TAU / AZIMUTHS as f64;
        let mut samples = [(0.0, 0.0); AZIMUTHS];
        for (k, sample) in samples.iter_mut().enumerate() {
            *sample = self.on_circle(p, step * k as f64)?;
        }
        for k in 0..AZIMUTHS {
            let (from, to) = (samples[k], samples[(k + 1) % AZIMUTHS]);
            let phi = step * k as f64;
            if from.1 <= 0.0 && to.1 >= 0.0 {
                // A function with slopes ≥ from.1 on the left and ≤ to.1 on the right of the trough.
                let floor = from.0.min(to.0) + step * from.1.min(-to.1);
                if floor - radius < self.best_value() || radius > 0.0 {
                    let trough = self.trough(p, [phi, phi + step], [from.1, to.1])?;
                    self.accept(p, trough, radius)?;
                }
            }
        }
        if self.shape == Shape::Free { self.lower_troughs(p, radius, &samples) } else { Some(()) }
    }

    /// Looks for more troughs of a circle than its samples show, in those sectors that could hold a lower place: distance
    /// changes no faster than the place moves.
    fn lower_troughs(&mut self, p: Meridian, radius: f64, samples: &[(f64, f64)]) -> Option<()> {
        let step = std::f64::consts::TAU / samples.len() as f64;
        let finest = step / f64::from(1u32 << SECTOR_HALVINGS);
        for (k, (from, to)) in samples.iter().zip(samples.iter().cycle().skip(1)).enumerate() {
            let mut open = vec![(step * k as f64, step, *from, *to)];
            while let Some((phi, width, from, to)) = open.pop() {
                if 0.5 * (from.0 + to.0 - p[0] * width) - radius >= self.best_value() {
                    continue;
                }
                if width > 1.5 * finest {
                    let half = 0.5 * width;
                    let middle = self.on_circle(p, phi + half)?;
                    open.extend([(phi + half, half, middle, to), (phi, half, from, middle)]);
                } else if from.1 <= 0.0 && to.1 >= 0.0 {
                    let trough = self.trough(p, [phi, phi + width], [from.1, to.1])?;
                    self.accept(p, trough, radius)?;
                }
            }
        }
        Some(())
    }

    fn on_circle(&self, p: Meridian, phi: f64) -> Option<(f64, f64)> {
        let (value, normal) = self.distance(&self.place(p, phi))?;
        Some((value, p[0] * normal.dot(&self.radial_rate(phi))))
    }

    /// The azimuth in a sector at which the derivative turns from − to +.
    fn trough(&self, p: Meridian, ends: [f64; 2], rates: [f64; 2]) -> Option<f64> {
        let ([mut a, mut b], [mut rate_a, mut rate_b]) = (ends, rates);
        for turn in 0..STEPS {
            let secant = a - rate_a * (b - a) / (rate_b - rate_a);
            let phi = if turn % 2 == 1 || !(secant > a && secant < b) { 0.5 * (a + b) } else { secant };
            let (_, rate) = self.on_circle(p, phi)?;
            if rate.abs() <= 1e-13 * p[0] || b - a <= 1e-12 {
                return Some(phi);
            }
            if rate < 0.0 {
                (a, rate_a) = (phi, rate);
            } else {
                (b, rate_b) = (phi, rate);
            }
        }
        Some(0.5 * (a + b))
    }

    fn accept(&mut self, p: Meridian, phi: f64, radius: f64) -> Option<()> {
        let center = self.place(p, phi);
        let (value, normal) = self.distance(&center)?;
        if radius > 0.0 {
            let height = -normal.dot(&self.tool.axis);
            let across = -normal + self.tool.axis * (-height);
            let outward = if p[0] > 0.0 { across.dot(&self.radial(phi)) } else { across.norm() };
            if outward < -1e-9 || !self.tool.profile.fan_holds([outward.max(0.0), height]) {
                return Some(());
            }
        }
        self.offer(Candidate { value: value - radius, point: center - normal * radius, normal });
        Some(())
    }

    /// Searches those parts of a patch that could be nearer than the best contact: a part lies in a ball round a point of
    /// the axis, whose distance is a bound.
    fn near_patches(&mut self, a: Meridian, b: Meridian) -> Option<()> {
        let at = |t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        let mut open: Option<(Meridian, Meridian)> = None;
        for k in 0..PATCH_PIECES {
            let ends = [k, k + 1].map(|i| at(f64::from(i) / f64::from(PATCH_PIECES)));
            let (middle, _) = self.distance(&self.place([0.0, 0.5 * (ends[0][1] + ends[1][1])], 0.0))?;
            let ball = ends[0][0].max(ends[1][0]).hypot(0.5 * (ends[1][1] - ends[0][1]));
            if middle - ball < self.best_value() {
                open = Some((open.map_or(ends[0], |o| o.0), ends[1]));
            } else if let Some((first, last)) = open.take() {
                self.patch(first, last)?;
            }
        }
        match open {
            Some((first, last)) => self.patch(first, last),
            None => Some(()),
        }
    }

    /// Candidates on the patch swept by a straight piece of the meridian: every trough over the azimuth that could hold
    /// the nearest place is closed in.
    fn patch(&mut self, a: Meridian, b: Meridian) -> Option<()> {
        let step = std::f64::consts::TAU / AZIMUTHS as f64;
        let mut lines = [OnLine { t: 0.0, value: 0.0, rate: 0.0, normal: Vec3::zeros() }; AZIMUTHS];
        for (k, line) in lines.iter_mut().enumerate() {
            let phi = step * k as f64;
            *line = self.on_line(a, b, phi)?;
            self.offer_on_line(a, b, phi, line.t)?;
        }
        // Between two samples the place moves no farther than half a step at the wider end.
        let reach = 0.5 * step * a[0].max(b[0]);
        for k in 0..AZIMUTHS {
            let (before, here, after) =
                (lines[(k + AZIMUTHS - 1) % AZIMUTHS], lines[k], lines[(k + 1) % AZIMUTHS]);
            let trough = here.value <= before.value && here.value <= after.value;
            if trough && here.value - reach < self.best_value() {
                let phi = step * k as f64;
                self.close_in(a, b, phi - step, phi + step)?;
            }
        }
        if self.shape == Shape::Free { self.lower_lines(a, b, &lines) } else { Some(()) }
    }

    /// Looks for more troughs of a patch than its samples show, as [`Search::lower_troughs`] does for a circle.
    fn lower_lines(&mut self, a: Meridian, b: Meridian, lines: &[OnLine]) -> Option<()> {
        let step = std::f64::consts::TAU / lines.len() as f64;
        let finest = step / f64::from(1u32 << SECTOR_HALVINGS);
        let widest = a[0].max(b[0]);
        for (k, (from, to)) in lines.iter().zip(lines.iter().cycle().skip(1)).enumerate() {
            let mut open = vec![(step * k as f64, step, *from, *to)];
            while let Some((phi, width, from, to)) = open.pop() {
                if 0.5 * (from.value + to.value - widest * width) >= self.best_value() {
                    continue;
                }
                // The least distance of a line changes with the azimuth as that of its nearest place does.
                let slope = |line: &OnLine, phi: f64| line.normal.dot(&self.radial_rate(phi));
                if width > 1.5 * finest {
                    let half = 0.5 * width;
                    let middle = self.on_line(a, b, phi + half)?;
                    self.offer_on_line(a, b, phi + half, middle.t)?;
                    open.extend([(phi + half, half, middle, to), (phi, half, from, middle)]);
                } else if slope(&from, phi) <= 0.0 && slope(&to, phi + width) >= 0.0 {
                    self.close_in(a, b, phi, phi + width)?;
                }
            }
        }
        Some(())
    }

    /// Golden section over the azimuth for the least distance on a patch.
    fn close_in(&mut self, a: Meridian, b: Meridian, mut low: f64, mut high: f64) -> Option<()> {
        let width = if self.shape == Shape::Convex { PROVING_WIDTH } else { AZIMUTH_WIDTH };
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let mut inner = [high - golden * (high - low), low + golden * (high - low)];
        let mut lines = [self.on_line(a, b, inner[0])?, self.on_line(a, b, inner[1])?];
        for _ in 0..STEPS {
            // What is left between the limits cannot be nearer than the best place, or lies on an edge, which is a circle
            // of its own.
            let left = high - low;
            let least = lines[0].value.min(lines[1].value);
            let hopeless = least - left * a[0].max(b[0]) >= self.best_value();
            let edge = lines[0].t == lines[1].t && lines.iter().all(|l| l.is_steady_end(2.0 * left * length));
            if hopeless || edge {
                return Some(());
            }
            if high - low <= width {
                break;
            }
            if lines[0].is_no_farther_than(&lines[1]) {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                lines = [self.on_line(a, b, inner[0])?, lines[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                lines = [lines[1], self.on_line(a, b, inner[1])?];
            }
        }
        let phi = 0.5 * (low + high);
        let line = self.on_line(a, b, phi)?;
        self.offer_on_line(a, b, phi, line.t)
    }

    fn offer_on_line(&mut self, a: Meridian, b: Meridian, phi: f64, t: f64) -> Option<()> {
        let (start, end) = (self.place(a, phi), self.place(b, phi));
        self.offer_point(&(start + (end - start) * t))
    }

    fn offer_point(&mut self, point: &Vec3) -> Option<()> {
        let (value, normal) = self.distance(point)?;
        self.offer(Candidate { value, point: *point, normal });
        Some(())
    }

    /// The least distance on the straight line of the patch at one azimuth.
    fn on_line(&self, a: Meridian, b: Meridian, phi: f64) -> Option<OnLine> {
        let (start, end) = (self.place(a, phi), self.place(b, phi));
        let line = Line { search: self, start, along: end - start };
        let (first, last) = (line.read(0.0)?, line.read(1.0)?);
        let mut best = if first.value <= last.value { first } else { last };
        if self.shape == Shape::Convex {
            line.trough(first, last, &mut best)?;
            return Some(best);
        }
        // Nothing is known between the ends but that distance changes no faster than the point moves.
        let length = line.along.norm();
        let mut from = first;
        while from.t < 1.0 {
            let clear = (from.value - best.value.min(self.best_value())) / length;
            let t = (from.t + clear.max(1.0 / LINE_PIECES)).min(1.0);
            let to = if t < 1.0 { line.read(t)? } else { last };
            if to.value < best.value {
                best = to;
            }
            line.trough(from, to, &mut best)?;
            from = to;
        }
        Some(best)
    }
}

/// Distance on a straight piece of the tool.
#[derive(Debug, Clone, Copy)]
struct OnLine {
    t: f64,
    value: f64,
    rate: f64,
    /// Gradient of the distance there.
    normal: Vec3,
}

impl OnLine {
    /// Whether it is no farther than that of another line. Lines out of one point of the tool that is nearest on each of them are as far; the
    /// one along which distance rises less is that beside which a nearer place may be.
    fn is_no_farther_than(&self, other: &Self) -> bool {
        self.value < other.value || self.value == other.value && self.rate <= other.rate
    }

    /// Whether it is at an end of its line towards which the distance falls by more than `rate`, so that it stays there
    /// when the azimuth changes a little.
    fn is_steady_end(&self, rate: f64) -> bool {
        (self.t <= 0.0 && self.rate > rate) || (self.t >= 1.0 && self.rate < -rate)
    }
}

struct Line<'a> {
    search: &'a Search<'a>,
    start: Vec3,
    along: Vec3,
}

impl Line<'_> {
    fn read(&self, t: f64) -> Option<OnLine> {
        let (value, normal) = self.search.distance(&(self.start + self.along * t))?;
        Some(OnLine { t, value, rate: normal.dot(&self.along), normal })
    }

    /// Lowers `best` to the least value between two readings, if the slope changes from − to + between them. The values about the trough
    /// differ by rounding alone, over a way on which the normal still turns: its place is where the slope vanishes.
    fn trough(&self, mut low: OnLine, mut high: OnLine, best: &mut OnLine) -> Option<()> {
        if low.rate >= 0.0 || high.rate <= 0.0 {
            return Some(());
        }
        let mut flattest = if -low.rate < high.rate { low } else { high };
        for turn in 0..STEPS {
            let secant = low.t - low.rate * (high.t - low.t) / (high.rate - low.rate);
            let t = if turn % 2 == 1 || !(secant > low.t && secant < high.t) {
                0.5 * (low.t + high.t)
            } else {
                secant
            };
            let middle = self.read(t)?;
            if middle.value < best.value {
                *best = middle;
            }
            if middle.rate.abs() < flattest.rate.abs() {
                flattest = middle;
            }
            if high.t - low.t <= 1e-11 || middle.rate.abs() <= 1e-12 * self.along.norm() {
                break;
            }
            if middle.rate < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let rounding = ROUNDING * (self.start.norm() + self.along.norm());
        if flattest.value <= best.value + rounding {
            *best = flattest;
        }
        Some(())
    }
}

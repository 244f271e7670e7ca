//! Cylinders and cones as one-parameter families of tangent planes.
//!
//! The tangent planes of a cylinder or cone have the normals `n(φ) = −sin α·T + cos α·E(φ)`, E turning about the axis T
//! (α = 0 for a cylinder). For a tool outside, every tangent plane gives a lower bound of the clearance and the best
//! one gives the clearance; for a tool inside every plane gives an upper bound. One angle is all there is to search.

use apt_geometry::Vec3;

use super::{
    circle_contact,
    clearance::{Reading, Shape},
    quadric::{Convexity, PrincipalQuadric},
    tool::{Tool, TurningSupport, perpendicular},
};

/// Directions looked at before the search closes in.
const SECTORS: usize = 16;
/// Bisection of one sector to round-off.
const BISECTIONS: usize = 100;
/// Steps of Newton's method towards the best plane; the greatest, radians; and the last, of which only the square counts.
const STEPS: usize = 12;
const LARGEST_TURN: f64 = 1.0;
const LAST_TURN: f64 = 1e-6;
/// Rounding of a clearance, relative to the distances that go into it.
const ROUNDING: f64 = 1e-14;
/// Arcs looked at by the branch and bound of the hollow case; what is left then goes into the error term.
const ARC_BUDGET: usize = 600;

/// A cylinder (sine 0) or one nappe of a cone (radius 0).
#[derive(Debug, Clone)]
pub(super) struct Pencil {
    /// A point of the axis; the vertex of a cone.
    pub(super) origin: Vec3,
    /// Unit axis, into the solid for a cone.
    pub(super) axis: Vec3,
    /// Sine of the half angle.
    pub(super) sine: f64,
    /// Cosine of the half angle.
    pub(super) cosine: f64,
    /// Radius of a cylinder.
    pub(super) radius: f64,
    /// Unit vectors that complete the axis to a frame.
    frame: [Vec3; 2],
    /// The quadric about the origin that this is, both nappes of a cone.
    form: PrincipalQuadric,
}

/// A value with the unit normal it belongs to and a bound of its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub(super) value: f64,
    pub(super) normal: Vec3,
    pub(super) error: f64,
}

impl Pencil {
    pub(super) fn new(origin: Vec3, axis: Vec3, cosine: f64, radius: f64) -> Self {
        let first = perpendicular(&axis);
        let frame = [first, axis.cross(&first)];
        let sine = if radius > 0.0 { 0.0 } else { (1.0 - cosine * cosine).max(0.0).sqrt() };
        // Scaled so that half the gradient on a cylinder is a half; on a cone any scale will do.
        let squares = if radius > 0.0 { [0.5 / radius, 0.0] } else { [cosine * cosine, sine * sine] };
        let form = PrincipalQuadric::round(&frame, &axis, squares, radius, Convexity::Inner);
        Self { origin, axis, sine, cosine, radius, frame, form }
    }

    fn radial(&self, phi: f64) -> Vec3 {
        let (s, c) = phi.sin_cos();
        self.frame[0] * c + self.frame[1] * s
    }

    fn normal(&self, phi: f64) -> Vec3 {
        self.radial(phi) * self.cosine - self.axis * self.sine
    }

    fn normal_rate(&self, phi: f64) -> Vec3 {
        let (s, c) = phi.sin_cos();
        (self.frame[1] * c - self.frame[0] * s) * self.cosine
    }

    /// Signed distance of a point (outside positive) and its unit gradient.
    pub(super) fn point_distance(&self, x: &Vec3) -> (f64, Vec3) {
        let w = x - self.origin;
        let along = w.dot(&self.axis);
        let radial = w - self.axis * along;
        let rho = radial.norm();
        let out = if rho > 1e-14 * w.norm() { radial / rho } else { self.frame[0] };
        // Behind the planes of the vertex fan the vertex is the nearest point.
        if self.sine > 0.0 && along * self.cosine + rho * self.sine < 0.0 {
            let size = w.norm();
            return (size, if size > 0.0 { w / size } else { -self.axis });
        }
        (rho * self.cosine - along * self.sine - self.radius, out * self.cosine - self.axis * self.sine)
    }

    /// Greatest curvature of the surface nearer to a tool than `reach`; None at the vertex of a cone.
    pub(super) fn curvature(&self, tip: &Vec3, tool: &Tool<'_>, reach: f64) -> Option<f64> {
        if self.sine <= 0.0 {
            return Some(1.0 / self.radius);
        }
        // Least distance of its places from the vertex along the axis.
        let along = self.axis.dot(&(tip - self.origin)) - tool.support(&-self.axis).0 - reach;
        (along > 0.0).then(|| self.cosine * self.cosine / (self.sine * along))
    }

    /// Clearance of a tool outside: the greatest distance that a tangent plane, or one through the vertex, leaves.
    pub(super) fn outside(&self, tip: &Vec3, tool: &Tool<'_>) -> Found {
        let w = tip - self.origin;
        if self.sine <= 0.0 && tool.axis.cross(&self.axis).norm() <= 1e-14 {
            let (distance, normal) = self.point_distance(tip);
            return Found { value: distance - tool.profile.widest(), normal, error: 0.0 };
        }
        let found = self.touched(&w, tool).or_else(|| self.by_circle(Shape::Convex, 1.0, &w, tool));
        if let Some(found) = found {
            return found;
        }
        // The plane at φ and how it changes with φ.
        let plane = |phi: f64| {
            let n = self.normal(phi);
            let (reach, p) = tool.support(&-n);
            (n.dot(&w) - self.radius - reach, self.normal_rate(phi).dot(&(w + p)))
        };
        let mut best = self.search(&plane, &w, &self.knees(&w, tool));
        self.raise_by_vertex(&w, tool, &mut best);
        best
    }

    /// The clearance of a tool outside by the tangent plane that leaves most, found by Newton's method: the plane is a bound from
    /// below, and the place of the tool that is nearest to it one from above. None where the two do not agree.
    fn touched(&self, w: &Vec3, tool: &Tool<'_>) -> Option<Found> {
        let across = |v: &Vec3| v - self.axis * v.dot(&self.axis);
        let mut radial = across(&(w + tool.axis * tool.profile.edges()[1][1])).try_normalize(0.0)?;
        for _ in 0..STEPS {
            let round = self.axis.cross(&radial);
            let n = radial * self.cosine - self.axis * self.sine;
            let TurningSupport { value: reach, center, ball, swing } = tool.turning_support(&-n, &round);
            // All by the angle of the plane about the axis.
            let place = w + center - n * ball;
            let rate = self.cosine * round.dot(&place);
            let bend = -self.cosine * (radial.dot(&place) + self.cosine * swing);
            let turn = -rate / bend;
            if !(bend < 0.0 && turn.abs() <= LARGEST_TURN) {
                return None;
            }
            if turn.abs() <= LAST_TURN {
                let value = n.dot(w) - self.radius - reach;
                let gap = self.point_distance(&(place + self.origin)).0 - value;
                let slack = ROUNDING * (w.norm() + self.radius + tool.profile.reach());
                let normal = (n + round * (self.cosine * turn)).try_normalize(0.0)?;
                return (gap.abs() <= slack + place.norm() * turn * turn).then_some(Found {
                    value,
                    normal,
                    error: gap.max(slack),
                });
            }
            radial = (radial + round * turn).try_normalize(0.0)?;
        }
        None
    }

    /// The clearance of a tool that touches with its corner or an edge, on this nappe of a cone.
    fn by_circle(&self, shape: Shape, side: f64, w: &Vec3, tool: &Tool<'_>) -> Option<Found> {
        let Reading { value, normal, error, .. } = circle_contact::at(&self.form, shape, side, w, tool)?;
        let ours = self.sine <= 0.0 || side * normal.dot(&self.axis) < 0.0;
        ours.then_some(Found { value, normal, error })
    }

    /// Where `plane` for a tool outside may bend sharply: the angles at which it lies on a straight part of the tool, those at
    /// which it is most nearly square to the tool axis, and those at which it touches the side of the tool that is turned to the
    /// origin. The parts between are smooth. A rim above a vertex has a crest at each of the last, which may be close together.
    fn knees(&self, w: &Vec3, tool: &Tool<'_>) -> Vec<f64> {
        let (fixed, first, second) = (
            -self.sine * self.axis.dot(&tool.axis),
            self.cosine * self.frame[0].dot(&tool.axis),
            self.cosine * self.frame[1].dot(&tool.axis),
        );
        let swing = first.hypot(second);
        let toward = second.atan2(first);
        let mut knees = vec![toward, toward + std::f64::consts::PI];
        let aside = tool.axis.cross(w);
        let [first, second] = self.frame.map(|e| self.cosine * e.dot(&aside));
        let turn = (self.sine * self.axis.dot(&aside) / first.hypot(second)).acos();
        if turn.is_finite() {
            let facing = second.atan2(first);
            knees.extend([facing + turn, facing - turn]);
        }
        for (a, b) in tool.profile.closed_lines() {
            let [out, up] = [b[0] - a[0], b[1] - a[1]];
            // n·axis = −(outward normal of the straight part)·axis
            let turn = ((out / out.hypot(up) - fixed) / swing).acos();
            if turn.is_finite() {
                knees.extend([toward + turn, toward - turn]);
            }
        }
        knees
    }

    /// The greatest value of `plane` (value and derivative): each sector in which it rises first and falls last is
    /// bisected. Sectors end at the given angles, too; at a sharp crest either derivative will do.
    fn search(&self, plane: &dyn Fn(f64) -> (f64, f64), w: &Vec3, knees: &[f64]) -> Found {
        let turn = std::f64::consts::TAU;
        let step = turn / SECTORS as f64;
        // Start the sectors at the side the tool end is on, where the answer mostly is.
        let first = w.dot(&self.frame[1]).atan2(w.dot(&self.frame[0])) - 0.5 * step;
        let mut angles: Vec<f64> = (0..SECTORS).map(|k| first + step * k as f64).collect();
        angles.extend(knees.iter().map(|phi| first + (phi - first).rem_euclid(turn)));
        angles.sort_by(f64::total_cmp);
        let mut samples: Vec<(f64, f64, f64)> = angles
            .into_iter()
            .map(|phi| {
                let (value, rate) = plane(phi);
                (phi, value, rate)
            })
            .collect();
        samples.extend(samples.first().map(|&(phi, value, rate)| (phi + turn, value, rate)));
        let scale = w.norm() + self.radius;
        let mut best = Found { value: f64::NEG_INFINITY, normal: self.axis, error: 0.0 };
        for pair in samples.windows(2) {
            let &[(phi, value, rate), (next, _, next_rate)] = pair else { continue };
            self.keep(&mut best, phi, value, 0.0);
            if rate > 0.0 && next_rate < 0.0 {
                let (phi, value, width) = crest(plane, [phi, next], [rate, next_rate]);
                self.keep(&mut best, phi, value, width * scale);
            }
        }
        best
    }

    fn keep(&self, best: &mut Found, phi: f64, value: f64, error: f64) {
        if value > best.value {
            *best = Found { value, normal: self.normal(phi), error };
        }
    }

    /// Clearance of a tool inside: the least distance that a tangent plane leaves; what sticks out through the vertex of a
    /// cone is measured from the vertex. Branch and bound on arcs of planes ([`Family`]).
    pub(super) fn inside(&self, tip: &Vec3, tool: &Tool<'_>) -> Found {
        let w = tip - self.origin;
        if self.sine <= 0.0 && tool.axis.cross(&self.axis).norm() <= 1e-14 {
            let (distance, normal) = self.point_distance(tip);
            return Found { value: -distance - tool.profile.widest(), normal: -normal, error: 0.0 };
        }
        let back = -self.axis;
        if (self.sine <= 0.0 || back.dot(&w) + tool.support(&back).0 < 0.0)
            && let Some(found) = self.by_circle(Shape::Concave, -1.0, &w, tool)
        {
            return found;
        }
        let plane = |phi: f64| {
            let n = self.normal(phi);
            let (reach, p) = tool.support(&n);
            (n.dot(&w) + reach, self.normal_rate(phi).dot(&(w + p)))
        };
        let mut best = self.search(&plane, &w, &[]);
        let scale = w.norm() + tool.profile.reach() + self.radius;
        let family = Family { pencil: self, w: &w, tool };
        let error = self.prove_crest(&family, &plane, &mut best, 1e-12 * scale);
        self.raise_by_poking(&w, tool, &mut best);
        Found { value: self.radius - best.value, normal: -best.normal, error: best.error + error }
    }

    /// Raises `best` to the global crest; gives how much above it the planes between the sampled ones could still reach.
    fn prove_crest(
        &self,
        family: &Family<'_>,
        plane: &dyn Fn(f64) -> (f64, f64),
        best: &mut Found,
        slack: f64,
    ) -> f64 {
        let step = std::f64::consts::TAU / SECTORS as f64;
        let mut arcs: Vec<(f64, f64, f64, f64)> = Vec::with_capacity(2 * SECTORS);
        for k in 0..SECTORS {
            let phi = step * k as f64;
            arcs.push((phi, plane(phi).0, step, plane(phi + step).0));
        }
        let ahead = family.ahead(family.tool.support(&self.axis).0);
        let mut highest = f64::NEG_INFINITY;
        let mut budget = ARC_BUDGET;
        while let Some((phi, f1, width, f2)) = arcs.pop() {
            let mut bound = arc_bound(f1, f2, width, ahead);
            if bound - best.value > slack {
                bound = bound.min(family.by_circles([phi, phi + width]));
            }
            if bound - best.value <= slack {
                continue;
            }
            if budget == 0 {
                highest = highest.max(bound);
                continue;
            }
            budget -= 1;
            let half = 0.5 * width;
            let middle = plane(phi + half).0;
            self.keep(best, phi + half, middle, best.error);
            arcs.push((phi, f1, half, middle));
            arcs.push((phi + half, middle, half, f2));
        }
        (highest - best.value).max(slack)
    }
}

/// How far a tool goes in the directions of the normals: `f(φ) = max n(φ)·(p − V)` over its points p. On an arc of planes
/// `f(φ) ≤ λ₁f(φ₁) + λ₂f(φ₂) + (λ₁+λ₂−1)·sin α·max T·(p − V)`, because E(φ) = λ₁E₁ + λ₂E₂.
struct Family<'a> {
    pencil: &'a Pencil,
    /// The tool end from the origin of the pencil.
    w: &'a Vec3,
    tool: &'a Tool<'a>,
}

impl Family<'_> {
    /// `sin α·max T·(p − V)` for points that go so far along the axis from the tool end.
    fn ahead(&self, reach: f64) -> f64 {
        self.pencil.sine * (self.pencil.axis.dot(self.w) + reach)
    }

    /// An upper bound on an arc by the circles about the tool axis, and the balls on them, in whose hull the tool is. By a middle
    /// alone it is exact, and what a circle or a ball adds to that hardly changes where the axes are about parallel.
    fn by_circles(&self, ends: [f64; 2]) -> f64 {
        let Self { pencil, w, tool } = *self;
        let normals = ends.map(|phi| pencil.normal(phi));
        let width = ends[1] - ends[0];
        let leans = normals.map(|n| n.dot(&tool.axis));
        // A sinusoid, which between two places is beyond them by no more than an eighth of its second derivative.
        let swing = pencil.cosine * pencil.axis.cross(&tool.axis).norm();
        let least = leans[0].abs().min(leans[1].abs()) - 0.125 * swing * width * width;
        let least = if leans[0] * leans[1] > 0.0 { least.max(0.0) } else { 0.0 };
        let widest = (1.0 - least * least).max(0.0).sqrt();
        let edges = tool.profile.edges().map(|edge| (edge, 0.0));
        let circles = edges.into_iter().chain([([0.0; 2], 0.0)]).chain(tool.profile.corner());
        // One ball of a barrel's corner holds all of it: one at the azimuth to which the planes lead.
        let facing = normals[0] + normals[1];
        let facing = (facing - tool.axis * tool.axis.dot(&facing)).try_normalize(0.0);
        let bound = |([radius, height], ball): ([f64; 2], f64)| {
            let (aside, radius) = match facing {
                Some(facing) if radius < 0.0 => (facing * radius, 0.0),
                _ => (Vec3::zeros(), radius.abs()),
            };
            let middle = aside + tool.axis * height;
            let middles = normals.map(|n| n.dot(&(w + middle)));
            arc_bound(middles[0], middles[1], width, self.ahead(pencil.axis.dot(&middle)))
                + radius * widest
                + ball
        };
        circles.map(bound).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Upper bound of the family between two planes `width` apart with the values `f1`, `f2`, by `ahead`.
fn arc_bound(f1: f64, f2: f64, width: f64, ahead: f64) -> f64 {
    // λ₁ = sin(width−x)/sin width, λ₂ = sin x/sin width: the greatest value of λ₁(f1 + a) + λ₂(f2 + a) − a over 0 ≤ x ≤ width.
    let (f1, f2) = (f1 + ahead, f2 + ahead);
    let (s, c) = width.sin_cos();
    let quarter = (f2 - f1 * c) / s;
    let x = quarter.atan2(f1);
    let top = if (0.0..=width).contains(&x) { f1.hypot(quarter) } else { f1.max(f2) };
    top - ahead
}

/// The zero of the derivative in a sector over which it changes from + to −: angle, value, width left.
fn crest(plane: &dyn Fn(f64) -> (f64, f64), ends: [f64; 2], rates: [f64; 2]) -> (f64, f64, f64) {
    let ([mut a, mut b], [mut rate_a, mut rate_b]) = (ends, rates);
    let mut best = (a, f64::NEG_INFINITY);
    for turn in 0..BISECTIONS {
        // Secant and bisection by turns: fast where the tool is smooth, safe at its edges.
        let secant = a - rate_a * (b - a) / (rate_b - rate_a);
        let phi = if turn % 2 == 1 || !(secant > a && secant < b) { 0.5 * (a + b) } else { secant };
        let (value, rate) = plane(phi);
        if value > best.1 {
            best = (phi, value);
        }
        let done = rate == 0.0 || b - a <= 1e-14 || phi <= a || phi >= b;
        if rate > 0.0 {
            (a, rate_a) = (phi, rate);
        } else {
            (b, rate_b) = (phi, rate);
        }
        if done || rate.abs() <= 1e-13 * (rates[0] - rates[1]) {
            return (best.0, best.1, 0.0);
        }
    }
    (best.0, best.1, b - a)
}

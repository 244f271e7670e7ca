//! A tool outside a plane, sphere, cylinder or cone whose axis turns: proven by supporting planes. Every normal `n` of the solid
//! bounds the clearance from below, by `n·(TE − origin) − level − H(n)` with the tool's support `H`; every point of the tool
//! bounds it from above, by its own distance. Between two samples the normal is taken to turn evenly from that of the one
//! contact to that of the other, which keeps it a normal of the solid, over the vertex of a cone too.

use apt_geometry::{Vec3, surface::Surface};

use super::{Extremes, course::lowest, second_derivative};
use crate::{
    attitude::Sweep,
    clearance::{Contact, Gauge, Tool},
    role::Working,
};

/// Pieces into which a vector is cut at first.
const PIECES: usize = 4;
/// How often a place under the vertex of a cone is looked for nearer to that.
const MOST_HALVINGS: u32 = 8;
/// Bound of the samples on one vector.
const MAX_SAMPLES: usize = 600;

/// The solid as the set of its supporting planes: `n·x ≤ n·origin + level`.
struct Solid {
    origin: Vec3,
    level: f64,
    /// Direction that is across all normals.
    across: Option<Vec3>,
    /// Direction that makes with every normal an angle with at least this cosine and at most this sine.
    within: Option<(Vec3, f64, f64)>,
}

impl Solid {
    /// The solid that the tool stands outside of; `None` where it is not one of these.
    fn new(gauge: &Gauge) -> Option<Self> {
        let round = |origin, level| Self { origin, level, across: None, within: None };
        match &gauge.surface {
            Surface::Plane(plane) => Some(round(plane.normal * plane.distance, 0.0)),
            _ if gauge.side < 0.0 => None,
            Surface::Sphere(sphere) => Some(round(sphere.center, sphere.radius)),
            Surface::Cylinder(cylinder) => {
                Some(Self { across: Some(cylinder.axis), ..round(cylinder.point, cylinder.radius) })
            }
            Surface::Cone(cone) => {
                Some(Self { within: Some((-cone.axis, cone.sine, cone.cosine)), ..round(cone.vertex, 0.0) })
            }
            _ => None,
        }
    }

    /// The normal of the solid nearest to a direction.
    fn normal(&self, direction: &Vec3) -> Option<Vec3> {
        let flat = |axis: &Vec3| (direction - axis * direction.dot(axis)).try_normalize(0.0);
        if let Some(axis) = &self.across {
            return flat(axis);
        }
        match &self.within {
            Some((axis, cosine, sine)) if direction.dot(axis) < *cosine => {
                Some(axis * *cosine + flat(axis)? * *sine)
            }
            _ => direction.try_normalize(0.0),
        }
    }

    /// From the origin to a place, as far as normals tell them apart.
    fn way(&self, place: &Vec3) -> Vec3 {
        let way = place - self.origin;
        self.across.map_or(way, |axis| way - axis * way.dot(&axis))
    }
}

/// A place on the vector.
#[derive(Clone, Copy)]
struct Sample {
    x: f64,
    /// Normal of the solid at the contact.
    normal: Vec3,
    /// Product of the normal and the way from the solid's origin.
    height: f64,
    distance: f64,
    /// Lower bound of the clearance.
    value: f64,
    /// Tool end, contact point of the tool, and a place of the tool that is no higher than a contact should be.
    tip: Vec3,
    contact: Vec3,
    witness: Vec3,
}

struct Turning<'a> {
    sweep: &'a Sweep<'a>,
    role: &'a Working,
    solid: Solid,
    size: f64,
    /// Greatest distance of a point of the tool from its end.
    reach: f64,
}

/// Extremes over the move of a turning tool; `None` where the role's surface is of another kind, or where supporting planes
/// decide nothing.
pub(super) fn extremes(sweep: &Sweep<'_>, role: &Working, ends: Extremes, size: f64) -> Option<Extremes> {
    if role.gauge.on || role.gauge.disk.is_some() {
        return None;
    }
    let reach = sweep.at(0.0).1.reach();
    let turning = Turning { sweep, role, solid: Solid::new(&role.gauge)?, size, reach };
    turning.extremes(ends)
}

impl Turning<'_> {
    fn extremes(&self, ends: Extremes) -> Option<Extremes> {
        let Extremes { mut least, mut greatest, .. } = ends;
        let mut open = Vec::with_capacity(PIECES);
        let mut from = self.sample(0.0)?;
        for k in 1..=PIECES {
            let to = self.sample(self.sweep.length * k as f64 / PIECES as f64)?;
            open.push((from, to));
            from = to;
        }
        let half = PIECES / 2;
        let turning_bend =
            second_derivative([open[0].0, open[half].0, from].map(|sample| (sample.x, sample.value)));
        let ends = Extremes { turning_bend: Some(turning_bend), ..ends };
        let values = open.iter().flat_map(|(a, b)| [a.value, b.value]);
        (least, greatest) = values.fold((least, greatest), |(low, high), v| (low.min(v), high.max(v)));
        let mut count = PIECES + 1;
        while let Some((a, b)) = open.pop() {
            if !self.role.holds(least, self.size) || !self.role.holds(greatest, self.size) {
                return Some(Extremes { least, greatest, proven: false, ..ends });
            }
            if self.holds_between(&a, &b) {
                continue;
            }
            let x = 0.5 * (a.x + b.x);
            count += 1;
            if count > MAX_SAMPLES || x <= a.x || x >= b.x {
                return None;
            }
            let middle = self.sample(x)?;
            (least, greatest) = (least.min(middle.value), greatest.max(middle.value));
            open.push((a, middle));
            open.push((middle, b));
        }
        Some(Extremes { least, greatest, ..ends })
    }

    fn sample(&self, x: f64) -> Option<Sample> {
        let (tip, tool) = self.sweep.at(x);
        let contact = self.role.gauge.contact(&tool, &tip);
        let normal = self.solid.normal(&contact.gradient)?;
        let way = self.solid.way(&tip);
        let (along, across, _) = tool.split(&normal);
        let (support, _) = tool.profile.support(across, -along);
        let height = normal.dot(&way);
        let value = height - self.solid.level - support - self.role.gauge.thickness;
        let witness = self.witness(&tool, &tip, &contact);
        Some(Sample { x, normal, height, distance: way.norm(), value, tip, contact: contact.tool, witness })
    }

    /// A place of the tool within the solid, if it is in contact there. The contact is, but where a tool cuts the vertex of a cone off:
    /// there it is across the vertex from the tool's face, beside the cone that is more pointed. Down the axis both are.
    fn witness(&self, tool: &Tool<'_>, tip: &Vec3, contact: &Contact) -> Vec3 {
        let Surface::Cone(cone) = &self.role.gauge.surface else { return contact.tool };
        let depth = -(contact.clearance + self.role.gauge.thickness);
        if depth <= 0.0 || self.distance(&contact.tool) <= 0.0 {
            return contact.tool;
        }
        let mut down = depth;
        for _ in 0..MOST_HALVINGS {
            let place = cone.vertex + cone.axis * down;
            let (along, across, _) = tool.split(&(place - tip));
            if tool.profile.distance(across, along).0 <= 0.0 {
                return place;
            }
            down *= 0.5;
        }
        contact.tool
    }

    /// The distance of a place from the solid.
    fn distance(&self, place: &Vec3) -> f64 {
        let Working { gauge, .. } = self.role;
        gauge.side * gauge.surface.signed_distance(place) - gauge.thickness
    }

    /// Whether the bounds on a stretch are in the band.
    fn holds_between(&self, a: &Sample, b: &Sample) -> bool {
        let length = b.x - a.x;
        let turn = a.normal.cross(&b.normal);
        let angle = turn.norm().atan2(a.normal.dot(&b.normal));
        let turn = turn.try_normalize(0.0).map_or_else(Vec3::zeros, |about| about * (angle / length));
        let bend = self.bend_with_tool(a, b, &turn).min(self.bend_of_points(a, b, turn.norm()));
        let low = lowest((a.value, b.value), bend, length);
        let rate = self.sweep.rate().norm();
        self.role.holds(low, self.size) && self.role.holds(self.highest(a, b, rate), self.size)
    }

    /// Bound of the second derivative of what the planes say: of the tool end's height above them, and of the support, which does not
    /// change where the normal turns along with the tool.
    fn bend_with_tool(&self, a: &Sample, b: &Sample, turn: &Vec3) -> f64 {
        let (rate, swing) = (turn.norm(), self.sweep.rate());
        // The tool end moves by the way, the normal turns: nowhere is it lower than this.
        let lowest_height =
            a.height.min(b.height) - 0.5 * (b.x - a.x) * (1.0 + rate * a.distance.max(b.distance));
        2.0 * rate - rate * rate * lowest_height + self.reach * (turn - swing).norm() * (rate + swing.norm())
    }

    /// The same from the points of the tool, none of which is lower than the lowest: as the normal turns, their heights bend down, by as much as
    /// they are high. However far it turns about an edge that passes over the vertex of a cone, they do so little. The lowest they come to
    /// follows from that bound itself.
    fn bend_of_points(&self, a: &Sample, b: &Sample, rate: f64) -> f64 {
        let (length, swing) = (b.x - a.x, self.sweep.rate().norm());
        let angle = rate * length;
        let left = 1.0 - angle * angle / 8.0;
        if left <= 0.0 {
            return f64::INFINITY;
        }
        let moved = 2.0 * rate * (1.0 + swing * self.reach) + swing * swing * self.reach;
        let ends = a.value.min(b.value) + self.role.gauge.thickness + self.solid.level;
        let lowest = ((ends - moved * length * length / 8.0) / left).min(ends);
        (moved - rate * rate * lowest).max(0.0)
    }

    /// The least over some points of the tool of the greatest distance that they have on a stretch: distances are convex,
    /// and the points leave the straight line by no more than the tool turns. One of them goes within the tool from the witness at
    /// the one end to that at the other.
    fn highest(&self, a: &Sample, b: &Sample, rate: f64) -> f64 {
        let length = b.x - a.x;
        let course = |from: &Vec3, to: &Vec3, within: f64| {
            let arm = (from - a.tip).norm() + within;
            let bend = rate * rate * arm * length + 2.0 * rate * within;
            self.distance(from).max(self.distance(to)) + bend * length / 8.0
        };
        let ahead = self.sweep.carried(&a.contact, a.x, b.x);
        let behind = self.sweep.carried(&b.contact, b.x, a.x);
        let within = (self.sweep.carried(&a.witness, a.x, b.x) - b.witness).norm();
        course(&a.tip, &b.tip, 0.0)
            .min(course(&a.contact, &ahead, 0.0))
            .min(course(&behind, &b.contact, 0.0))
            .min(course(&a.witness, &b.witness, within))
    }
}

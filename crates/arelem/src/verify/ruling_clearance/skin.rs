//! Places of the tool under the surface that no place of the surface is as deep in the tool for: on the tool's edges, and on its faces by
//! an edge, from which the surface is not far.

use apt_geometry::Vec3;

use super::{AT_EDGE, Bodies, Deepest, point::seen_from};
use crate::verify::{
    clearance::Reading,
    tool::{Meridian, Tool},
};

/// Azimuths at which an edge of the tool is looked at before its deepest places are closed in.
const AZIMUTHS: usize = 24;
/// The angle between two of them.
pub(super) const SECTOR: f64 = std::f64::consts::TAU / AZIMUTHS as f64;
/// Steps of the secant that closes them in.
const CLOSING_STEPS: usize = 40;
/// Sine of the slope of an edge or face, or width in radians or tool units, at which it has closed in.
const LEVEL: f64 = 1e-10;
/// How far beside a level place, as a share of the way to the next, it is looked whether that is deepest there or least deep.
const BESIDE: f64 = 1e-2;
/// How often what is deepest of a face is closed in along the meridian and round the axis.
const FACE_TURNS: usize = 8;

/// A place on a way along the tool's skin.
#[derive(Clone, Copy)]
struct Looked {
    /// Where it is on the way: azimuth, or length along the meridian.
    at: f64,
    /// Sine of the slope at which the way gets deeper.
    rate: f64,
    found: Deepest,
}

/// Closes in on the deepest place between two of a way, where that gets deeper from either towards the other.
fn peak(
    read: impl Fn(f64) -> Option<Looked>,
    [mut low, mut high]: [Looked; 2],
    deepest: &mut Deepest,
) -> Option<()> {
    if low.rate < -LEVEL || high.rate > LEVEL {
        return Some(());
    }
    // A way that is level where it is least deep gets deeper on both sides.
    let beside = BESIDE * (high.at - low.at);
    if low.rate <= LEVEL {
        low = read(low.at + beside)?;
    }
    if high.rate >= -LEVEL {
        high = read(high.at - beside)?;
    }
    if low.rate <= LEVEL || high.rate >= -LEVEL {
        return Some(());
    }
    for turn in 0..CLOSING_STEPS {
        let secant = low.at - low.rate * (high.at - low.at) / (high.rate - low.rate);
        let is_between = secant > low.at && secant < high.at;
        let next = read(if turn % 3 == 2 || !is_between { 0.5 * (low.at + high.at) } else { secant })?;
        deepest.offer(&next);
        if next.rate.abs() <= LEVEL || high.at - low.at <= LEVEL {
            break;
        }
        if next.rate > 0.0 {
            low = next;
        } else {
            high = next;
        }
    }
    Some(())
}

impl Deepest {
    /// Takes a place that is deeper.
    fn offer(&mut self, looked: &Looked) {
        if looked.found.depth > self.depth {
            *self = looked.found;
        }
    }
}

impl Bodies<'_> {
    /// Places of the meridian that can be under the surface without the surface being as deep in the tool.
    pub(super) fn edges(&self) -> Vec<Meridian> {
        let mut edges: Vec<Meridian> = vec![[0.0; 2]];
        for edge in self.tool.profile.edges() {
            if !edges.contains(&edge) {
                edges.push(edge);
            }
        }
        edges
    }

    /// How deep a place is under the surface. What is beyond the end is not under it.
    pub(super) fn depth(&self, x: &Vec3) -> Option<Deepest> {
        let (Reading { value, normal, .. }, is_beyond) = seen_from(self.surface, x, self.tool.patience)?;
        let side = if is_beyond { value.signum() } else { self.side };
        Some(Deepest { depth: -side * value, out: normal * side, place: *x })
    }

    /// The place of an edge circle at an azimuth.
    fn on_circle(&self, circle: &Circle, p: Meridian, phi: f64) -> Option<Looked> {
        let found = self.depth(&circle.place(p, phi))?;
        Some(Looked { at: phi, rate: -found.out.dot(&circle.radial_rate(phi)), found })
    }

    /// Deepest place of an edge circle under the surface, if it is deeper than `deepest`.
    pub(super) fn edge(&self, circle: &Circle, p: Meridian, deepest: &mut Deepest) -> Option<()> {
        if p[0] <= 0.0 {
            return self.deepest_near(circle, p, [0.0, 0.0], deepest);
        }
        let read = |phi: f64| self.on_circle(circle, p, phi);
        let before = deepest.depth;
        let mut looks: Vec<Option<Looked>> = Vec::with_capacity(AZIMUTHS + 1);
        let mut known = f64::INFINITY;
        for k in 0..AZIMUTHS {
            // Depth changes no faster than the place moves; between two samples lies half a step more.
            known += SECTOR * p[0];
            if known + 0.5 * SECTOR * p[0] <= before {
                looks.push(None);
                continue;
            }
            let looked = read(SECTOR * k as f64)?;
            known = looked.found.depth;
            deepest.offer(&looked);
            looks.push(Some(looked));
        }
        let round = looks[0].map(|first| Looked { at: std::f64::consts::TAU, ..first });
        looks.push(round);
        // The edge may be deepest at several places, as across a ridge that it is on both sides of.
        for (k, pair) in looks.windows(2).enumerate() {
            // Half of what is between is nearer to either, and not deeper by one that was left out.
            let most = match pair {
                [Some(low), Some(high)] => 0.5 * (low.found.depth + high.found.depth + SECTOR * p[0]),
                [Some(one), None] | [None, Some(one)] => one.found.depth + 0.5 * SECTOR * p[0],
                _ => continue,
            };
            if most > deepest.depth {
                let end = |one: Option<Looked>, k: usize| one.map_or_else(|| read(SECTOR * k as f64), Some);
                peak(read, [end(pair[0], k)?, end(pair[1], k + 1)?], deepest)?;
            }
        }
        Some(())
    }

    /// Closes in on the deepest places of an edge circle between two azimuths and the middle between them.
    pub(super) fn deepest_near(
        &self,
        circle: &Circle,
        p: Meridian,
        [low, high]: [f64; 2],
        deepest: &mut Deepest,
    ) -> Option<()> {
        let read = |phi: f64| self.on_circle(circle, p, phi);
        let middle = read(0.5 * (low + high))?;
        deepest.offer(&middle);
        // The places of the range are not farther from its middle than half its arc.
        if p[0] <= 0.0 || middle.found.depth + 0.5 * (high - low) * p[0] <= deepest.depth {
            return Some(());
        }
        if middle.rate <= LEVEL {
            peak(read, [read(low)?, middle], deepest)?;
        }
        if middle.rate >= -LEVEL {
            peak(read, [middle, read(high)?], deepest)?;
        }
        Some(())
    }

    /// Closes in, from the deepest place known, on what is deepest of the faces that this is on. Where they are as far from their edge
    /// as they are deep, the surface is not as deep in the tool as they are under it: it is nearer to the face across the edge.
    pub(super) fn faces_by(&self, tip: &Vec3, deepest: &mut Deepest) -> Option<()> {
        for _ in 0..FACE_TURNS {
            let before = deepest.depth;
            let (circle, at) = self.circle_at(tip, deepest);
            for line in self.tool.profile.lines() {
                self.deepest_along(&circle, at, line, deepest)?;
            }
            if deepest.depth <= before + self.resolution {
                break;
            }
            let (circle, at) = self.circle_at(tip, deepest);
            self.deepest_near(&circle, at, [-0.5 * SECTOR, 0.5 * SECTOR], deepest)?;
        }
        Some(())
    }

    /// The circle that the deepest place is on, from its azimuth on, and where it is on the meridian. On the axis that is the azimuth in
    /// which it gets deeper.
    fn circle_at(&self, tip: &Vec3, deepest: &Deepest) -> (Circle, Meridian) {
        let (at, mut radial) = self.tool.split(&(deepest.place - tip));
        let across = self.tool.axis * self.tool.axis.dot(&deepest.out) - deepest.out;
        if at[0] <= self.close() && across.norm() > LEVEL {
            radial = across.normalize();
        }
        (Circle::of(tip, self.tool, radial), at)
    }

    /// The same along a straight part of the meridian, if the place is on it.
    fn deepest_along(
        &self,
        circle: &Circle,
        at: Meridian,
        (first, last): (Meridian, Meridian),
        deepest: &mut Deepest,
    ) -> Option<()> {
        let way = [last[0] - first[0], last[1] - first[1]];
        let length = way[0].hypot(way[1]);
        if length <= 0.0 {
            return Some(());
        }
        let [out, up] = way.map(|x| x / length);
        let from = [at[0] - first[0], at[1] - first[1]];
        let along = (from[0] * out + from[1] * up).clamp(0.0, length);
        if (from[0] - along * out).hypot(from[1] - along * up) > self.close() {
            return Some(());
        }
        let run = circle.across[0] * out + circle.axis * up;
        let read = |at: f64| {
            let found = self.depth(&circle.place([first[0] + at * out, first[1] + at * up], 0.0))?;
            Some(Looked { at, rate: -found.out.dot(&run), found })
        };
        // Farther from the edge the surface is as deep in the tool as the face is under it.
        let far = AT_EDGE * deepest.depth.max(0.0);
        // The way out of the deepest place known may be that of a place of the surface, square to the face.
        let here = read(along)?;
        deepest.offer(&here);
        if here.rate > LEVEL {
            let there = read((along + far).min(length))?;
            deepest.offer(&there);
            peak(read, [here, there], deepest)
        } else if here.rate < -LEVEL {
            let there = read((along - far).max(0.0))?;
            deepest.offer(&there);
            peak(read, [there, here], deepest)
        } else {
            Some(())
        }
    }
}

/// The edge circles of a tool in a place.
pub(super) struct Circle {
    tip: Vec3,
    axis: Vec3,
    across: [Vec3; 2],
}

impl Circle {
    pub(super) fn of(tip: &Vec3, tool: &Tool<'_>, first: Vec3) -> Self {
        Self { tip: *tip, axis: tool.axis, across: [first, tool.axis.cross(&first)] }
    }

    pub(super) fn place(&self, p: Meridian, phi: f64) -> Vec3 {
        let (s, c) = phi.sin_cos();
        self.tip + (self.across[0] * c + self.across[1] * s) * p[0] + self.axis * p[1]
    }

    fn radial_rate(&self, phi: f64) -> Vec3 {
        let (s, c) = phi.sin_cos();
        self.across[1] * c - self.across[0] * s
    }
}

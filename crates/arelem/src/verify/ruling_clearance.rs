//! Clearance of the whole tool to a ruled surface.
//!
//! Clear of the surface it is the least distance of a place of the surface. In violation it is the least translation
//! that frees the tool (arelem reference 5.2): not less than the depth of any place of the surface in the tool, and of
//! any place of the tool under the surface; and not more than a translation after which the tool is clear.

use apt_geometry::Vec3;

use super::{
    clearance::Reading,
    ruling::Ruling,
    strip::{Touch, nearest},
    tool::{Meridian, Profile, Tool, perpendicular},
};

/// Accuracy of a distance, relative to the size of surface and tool.
const RESOLUTION: f64 = 2e-11;
/// Sine of the angle to the rulings below which the tool is a disc seen along them.
const PARALLEL: f64 = 1e-13;
/// Azimuths at which an edge of the tool is looked at before its deepest place is closed in.
const AZIMUTHS: usize = 24;
/// Steps of the golden section that closes it in.
const GOLDEN_STEPS: usize = 32;
/// Depth, relative to the radius of the tool, up to which it is proven; deeper is no question of tolerance.
const PROVEN_DEPTH: f64 = 0.1;
/// Translations tried in the proof of a depth, each four times longer.
const PROOF_STEPS: usize = 14;

fn resolution(ruling: &Ruling, tip: &Vec3, reach: f64) -> f64 {
    RESOLUTION * (ruling.size.max(tip.norm()) + reach)
}

/// Signed distance of a point along the natural normal and that distance's unit gradient; None beyond the end of a curve.
pub(super) fn point_distance(ruling: &Ruling, x: &Vec3) -> Option<(f64, Vec3)> {
    let profile = Profile::tool_end();
    let tool = Tool { profile: &profile, axis: ruling.axis };
    let touch = nearest(&ruling.strips(x, 0.0), x, &tool, resolution(ruling, x, 0.0), 0.0)?;
    let natural = ruling.natural(&touch)?;
    let height = natural.dot(&(x - touch.point));
    let away = x - touch.point;
    // At a joint the point is in the fan of its normals.
    let size = away.norm();
    if size > 1e-6 * (1.0 + ruling.size) && height.abs() < size * (1.0 - 1e-9) {
        return Some((size.copysign(height), away * (height.signum() / size)));
    }
    Some((height, natural))
}

struct Bodies<'a> {
    ruling: &'a Ruling,
    side: f64,
    tool: &'a Tool<'a>,
    reach: f64,
    resolution: f64,
    /// Depth up to which a violation is measured exactly.
    deep: f64,
}

/// The clearance; None beyond the end of a curve.
pub(super) fn at(ruling: &Ruling, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
    if tool.axis.cross(&ruling.axis).norm() <= PARALLEL {
        let (distance, normal) = point_distance(ruling, tip)?;
        let error = resolution(ruling, tip, 0.0);
        return Some(Reading {
            value: side * distance - tool.profile.widest(),
            normal: normal * side,
            error,
        });
    }
    let reach = tool.profile.reach();
    let deep = PROVEN_DEPTH * tool.profile.widest();
    let bodies = Bodies { ruling, side, tool, reach, resolution: resolution(ruling, tip, reach), deep };
    let touch = bodies.touch(tip)?;
    let clear = bodies.is_on_side(&touch)?;
    if touch.value >= 0.0 && clear {
        return Some(Reading { value: touch.value, normal: -touch.outward, error: touch.gap });
    }
    bodies.violation(tip, &touch)
}

impl Bodies<'_> {
    fn touch(&self, tip: &Vec3) -> Option<Touch> {
        nearest(&self.ruling.strips(tip, 2.0 * self.reach), tip, self.tool, self.resolution, self.deep)
    }

    /// Whether the tool is on its side of the surface where it is nearest.
    fn is_on_side(&self, touch: &Touch) -> Option<bool> {
        Some(self.side * touch.outward.dot(&self.ruling.natural(touch)?) <= 0.0)
    }

    fn violation(&self, tip: &Vec3, touch: &Touch) -> Option<Reading> {
        let mut deepest = (-touch.value, -touch.outward);
        for p in self.edges() {
            self.edge(tip, p, &mut deepest)?;
        }
        let (depth, normal) = deepest;
        let error = if depth <= self.deep { self.unproven(tip, depth, &normal)? } else { 0.0 };
        Some(Reading { value: -depth, normal, error })
    }

    /// Places of the meridian that can be under the surface without the surface being as deep in the tool.
    fn edges(&self) -> Vec<Meridian> {
        let mut edges: Vec<Meridian> = vec![[0.0; 2]];
        for edge in self.tool.profile.edges() {
            if !edges.contains(&edge) {
                edges.push(edge);
            }
        }
        edges
    }

    /// Deepest place of an edge circle under the surface, if it is deeper than `deepest`.
    fn edge(&self, tip: &Vec3, p: Meridian, deepest: &mut (f64, Vec3)) -> Option<()> {
        let first = perpendicular(&self.tool.axis);
        let second = self.tool.axis.cross(&first);
        let place = |phi: f64| {
            let (s, c) = phi.sin_cos();
            tip + (first * c + second * s) * p[0] + self.tool.axis * p[1]
        };
        let depth = |x: &Vec3| -> Option<(f64, Vec3)> {
            let (distance, normal) = point_distance(self.ruling, x)?;
            Some((-self.side * distance, normal * self.side))
        };
        if p[0] <= 0.0 {
            let found = depth(&place(0.0))?;
            if found.0 > deepest.0 {
                *deepest = found;
            }
            return Some(());
        }
        let step = std::f64::consts::TAU / AZIMUTHS as f64;
        let mut best: Option<(f64, f64)> = None;
        let mut known = f64::INFINITY;
        for k in 0..AZIMUTHS {
            let phi = step * k as f64;
            // Depth changes no faster than the place moves; between two samples lies half a step more.
            known += step * p[0];
            if known + 0.5 * step * p[0] <= deepest.0 {
                continue;
            }
            known = depth(&place(phi))?.0;
            if best.is_none_or(|b| known > b.1) {
                best = Some((phi, known));
            }
        }
        let Some((middle, value)) = best else { return Some(()) };
        if value + step * p[0] <= deepest.0 {
            return Some(());
        }
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let (mut low, mut high) = (middle - step, middle + step);
        let mut inner = [high - golden * (high - low), low + golden * (high - low)];
        let mut depths = [depth(&place(inner[0]))?.0, depth(&place(inner[1]))?.0];
        for _ in 0..GOLDEN_STEPS {
            if depths[0] >= depths[1] {
                high = inner[1];
                inner = [high - golden * (high - low), inner[0]];
                depths = [depth(&place(inner[0]))?.0, depths[0]];
            } else {
                low = inner[0];
                inner = [inner[1], low + golden * (high - low)];
                depths = [depths[1], depth(&place(inner[1]))?.0];
            }
        }
        let found = depth(&place(0.5 * (low + high)))?;
        if found.0 > deepest.0 {
            *deepest = found;
        }
        Some(())
    }

    /// How much farther than `depth` the tool must be moved along `normal` until it is clear for certain.
    fn unproven(&self, tip: &Vec3, depth: f64, normal: &Vec3) -> Option<f64> {
        let mut more = 4.0 * self.resolution;
        for _ in 0..PROOF_STEPS {
            let touch = self.touch(&(tip + normal * (depth + more)))?;
            if touch.value >= touch.gap && self.is_on_side(&touch)? {
                return Some(more);
            }
            more *= 4.0;
        }
        Some(more)
    }
}

//! Lower bounds for the number of cut vectors (arelem reference 5.6): chords of a ring, where the configuration confines
//! the tool end to one; elsewhere the integral of √(κ/8τ) along the path, κ being how the clearance bends.

use apt_geometry::{Vec3, surface::Surface};

use crate::{clearance::Shape, directed::Prepared, role::Working, sequence::CutSequence};

/// Sine below which directions are parallel or a plane contains one.
const PARALLEL: f64 = 1e-9;

/// Difference of cosines above which the tool does not touch the side of a cone but its vertex.
const SLANT: f64 = 1e-6;

/// A ring about an axis that the tool end cannot leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// A point of the axis.
    pub center: Vec3,
    /// Unit axis.
    pub axis: Vec3,
    /// Inner radius.
    pub inner: f64,
    /// Outer radius.
    pub outer: f64,
}

impl Ring {
    /// Length of the longest chord in the ring, tangent to the inner circle between two points of the outer one
    /// (Galbiati & Trumpy, DELTA).
    pub fn longest_chord(&self) -> f64 {
        2.0 * ((self.outer - self.inner) * (self.outer + self.inner)).max(0.0).sqrt()
    }

    /// Least number of chords that turn by `angle` (radians) between the radii `start` and `end`, all inside the ring.
    pub fn least_chords(&self, angle: f64, start: f64, end: f64) -> u32 {
        let half = |r: f64| (self.inner / r.clamp(self.inner, self.outer)).clamp(0.0, 1.0).acos();
        let free = half(start) + half(end);
        if angle <= free {
            return 1;
        }
        let chords = (angle - free) / (2.0 * half(self.outer));
        // A turn that just fits must not count one more for rounding.
        let count = (chords * (1.0 - 1e-12)).ceil();
        if count < f64::from(u32::MAX - 1) { 1 + count as u32 } else { u32::MAX }
    }

    fn flat(&self, p: &Vec3) -> Vec3 {
        let w = p - self.center;
        w - self.axis * w.dot(&self.axis)
    }

    /// The bound for a path of positions: its turning angle about the axis decides.
    fn of_path(&self, path: &[Vec3]) -> u32 {
        let mut angle = 0.0;
        for pair in path.windows(2) {
            let (a, b) = (self.flat(&pair[0]), self.flat(&pair[1]));
            angle += a.cross(&b).norm().atan2(a.dot(&b));
        }
        match (path.first(), path.last()) {
            (Some(first), Some(last)) => {
                self.least_chords(angle, self.flat(first).norm(), self.flat(last).norm())
            }
            _ => 1,
        }
    }
}

/// The number of cut vectors that no sequence within tolerance can beat.
pub(crate) fn minimum(sequence: &CutSequence, prepared: &Prepared) -> u32 {
    if prepared.part.shape == Shape::Flat && prepared.drive.shape == Shape::Flat {
        return 1;
    }
    let mut path = Vec::with_capacity(sequence.points.len() + 1);
    path.push(sequence.start.tip);
    path.extend(sequence.points.iter().map(|p| p.tip));
    let part = least(prepared, &prepared.part, &prepared.drive, &path);
    let drive = least(prepared, &prepared.drive, &prepared.part, &path);
    // The straight way from start to end at MAXDP a vector.
    let straight = match (path.first(), path.last()) {
        (Some(first), Some(last)) => (last - first).norm(),
        _ => 0.0,
    };
    part.max(drive).max(whole(straight / sequence.maximum_step * (1.0 - 1e-9)))
}

/// The least number of vectors that one role asks for.
fn least(prepared: &Prepared, role: &Working, other: &Working, path: &[Vec3]) -> u32 {
    if role.shape == Shape::Flat {
        return 1;
    }
    match ring(prepared, role, other) {
        Some(ring) => ring.of_path(path),
        None => {
            let share: f64 = path.windows(2).map(|pair| share(prepared, role, &pair[0], &pair[1])).sum();
            whole(share * (1.0 - SAMPLED)).saturating_sub(1).max(1)
        }
    }
}

/// Part of the integral that sampling the bend at the ends and in the middle of each vector may add.
const SAMPLED: f64 = 0.01;

/// What one vector of the path adds to the integral of √(κ/8τ). It keeps the band, so that it counts for one at most:
/// where contact jumps the slope turns without need of another vector.
fn share(prepared: &Prepared, role: &Working, from: &Vec3, to: &Vec3) -> f64 {
    let length = (to - from).norm();
    if length <= 0.0 {
        return 0.0;
    }
    let direction = (to - from) / length;
    let slope = |tip: &Vec3| role.gauge.contact(&prepared.tool, tip).gradient.dot(&direction);
    let half = 0.5 * length;
    let slopes = [from, &(0.5 * (from + to)), to].map(slope);
    let of_half = |a: f64, b: f64| half * ((b - a).abs() / half / (8.0 * role.band())).sqrt();
    (of_half(slopes[0], slopes[1]) + of_half(slopes[1], slopes[2])).min(1.0)
}

/// The next whole number.
fn whole(x: f64) -> u32 {
    let up = x.ceil();
    if up < f64::from(u32::MAX) { up.max(0.0) as u32 } else { u32::MAX }
}

/// The ring to which one role confines the tool end, given the other.
fn ring(prepared: &Prepared, role: &Working, other: &Working) -> Option<Ring> {
    if role.gauge.disk.is_some() {
        return None;
    }
    let tool = &prepared.tool;
    let axis = tool.axis;
    let on = role.gauge.on;
    let is_ball = tool.profile.center.radius.abs() <= PARALLEL * tool.radius() && tool.profile.arc > 0.0;
    // The point that stays at a constant distance from the surface: tool end, ball centre, or axis.
    let rise = if on { 0.0 } else { tool.profile.arc };
    let thickness = role.gauge.thickness;
    match &role.gauge.surface {
        Surface::Cylinder(cylinder) => {
            let parallel = cylinder.axis.cross(&axis).norm() <= PARALLEL;
            let reach = if on {
                0.0
            } else if parallel {
                tool.radius()
            } else if is_ball {
                tool.profile.arc
            } else {
                return None;
            };
            let lift = if parallel || on { Vec3::zeros() } else { axis * rise };
            let (inner, outer) = radii(role, cylinder.radius, reach + thickness);
            Some(Ring { center: cylinder.point - lift, axis: cylinder.axis, inner, outer })
        }
        Surface::Sphere(sphere) if on || is_ball => {
            let Surface::Plane(plane) = &other.gauge.surface else { return None };
            let reach = if on { 0.0 } else { tool.profile.arc };
            let (inner, outer) = radii(role, sphere.radius, reach + thickness);
            let center = sphere.center - axis * rise;
            // The path keeps its plane exactly; straying in the plane's own band could gain a little.
            let away = plane.normal.dot(&(prepared.tip - center));
            let section = |r: f64| (r * r - away * away).max(0.0).sqrt();
            Some(Ring { center, axis: plane.normal, inner: section(inner), outer: section(outer) })
        }
        Surface::Cone(cone) => {
            let Surface::Plane(plane) = &other.gauge.surface else { return None };
            let square = |n: &Vec3| n.cross(&cone.axis).norm() <= PARALLEL;
            if !(square(&plane.normal) && square(&axis)) {
                return None;
            }
            // At one height the clearance changes with the distance from the axis, by the cosine of the half angle.
            let contact = role.gauge.contact(&prepared.tool, &prepared.tip);
            let w = prepared.tip - cone.vertex;
            let radial = w - cone.axis * w.dot(&cone.axis);
            let distance = radial.norm();
            let rate = contact.gradient.dot(&radial) / distance;
            if (rate.abs() - cone.cosine).abs() > SLANT {
                return None;
            }
            let nominal = distance - contact.clearance / rate;
            let limits = [nominal - role.inside / rate, nominal + role.outside / rate];
            let (inner, outer) = (limits[0].min(limits[1]).max(0.0), limits[0].max(limits[1]).max(0.0));
            Some(Ring { center: cone.vertex, axis: cone.axis, inner, outer })
        }
        _ => None,
    }
}

/// Inner and outer radius of the path about a round surface.
fn radii(role: &Working, radius: f64, reach: f64) -> (f64, f64) {
    if role.gauge.side > 0.0 {
        ((radius + reach - role.inside).max(0.0), radius + reach + role.outside)
    } else {
        ((radius - reach - role.outside).max(0.0), (radius - reach + role.inside).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn ring(inner: f64, outer: f64) -> Ring {
        Ring { center: Vec3::zeros(), axis: Vec3::z(), inner, outer }
    }

    #[test]
    fn w27_quarter_circle() {
        let band = ring(2.5, 2.501);
        assert_eq!(band.least_chords(FRAC_PI_2, 2.501, 2.501), 28);
        assert_eq!(band.least_chords(FRAC_PI_2, 2.5009, 2.5009), 28);
    }

    #[test]
    fn w28_sphere_section() {
        let radius = |r: f64| (r * r - 0.64f64).sqrt();
        let (inner, outer) = (radius(2.25), radius(2.251));
        assert!((inner - 2.102974084).abs() < 1e-9 && (outer - 2.104043963).abs() < 1e-9);
        assert_eq!(ring(inner, outer).least_chords(1.2, outer, outer), 19);
    }

    #[test]
    fn w29_cone_at_constant_height() {
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let path = (2.75 * sin + 0.0) / cos + 0.25 / cos;
        let (inner, outer) = (path, path + 0.001 / cos);
        assert!((inner - 1.876388375).abs() < 1e-9 && (outer - 1.877543075).abs() < 1e-9, "{inner} {outer}");
        assert_eq!(ring(inner, outer).least_chords(FRAC_PI_2, outer, outer), 23);
    }

    #[test]
    fn w30_oblique_cylinder_section() {
        // Ball .25 on a cylinder of radius 1 in a plane at 45°, y ±.9: the angle counts about the cylinder's axis.
        let angle = 2.0 * (0.9f64 / 1.2505).asin();
        assert_eq!(ring(1.25, 1.251).least_chords(angle, 1.251, 1.251), 21);
    }

    #[test]
    fn straight_moves_need_one_vector() {
        assert_eq!(ring(2.0, 2.1).least_chords(0.0, 2.05, 2.05), 1);
    }
}

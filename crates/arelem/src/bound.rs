//! Lower bounds for the number of cut vectors (arelem reference 5.6): chords of a ring, where the configuration confines
//! the tool end to one; elsewhere the longest stretches of the path that a straight line keeps the bands along, which on a steady bend
//! is the integral of √(κ/8τ), κ being how the clearance bends.

mod filled;
mod readings;

use std::collections::VecDeque;

use apt_geometry::{Vec3, patience::Patience, surface::Surface};

use self::filled::{Filled, Limits, WIDER, WIDER_ROUGHLY};
pub(crate) use self::readings::{Piece, Reading, Readings};
use crate::{
    clearance::{Shape, Tool},
    directed::{Prepared, is_tangent},
    position,
    role::Working,
    sequence::CutSequence,
};

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

    /// Least number of chords that turn by `angle` (radians) between the radii `start` and `end`, all inside the ring but for what the first
    /// and the last lead to from outside of it.
    pub fn least_chords(&self, angle: f64, start: f64, end: f64) -> u32 {
        let half = |r: f64| (self.inner / r.max(self.inner)).clamp(0.0, 1.0).acos();
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

    /// Whether the positions of a path are in the ring, or no farther from it than it is wide: a tool that touches with another part, as with its top
    /// inside a cylinder that lies, is not confined to it.
    fn holds(&self, path: &[Vec3]) -> bool {
        let wide = self.outer - self.inner;
        path.iter().map(|p| self.flat(p).norm()).all(|r| r >= self.inner - wide && r <= self.outer + wide)
    }

    /// The bound for a path of positions, whose turning angle about the axis decides, and all others from where it begins. They may end at any
    /// radius, and a way before its end.
    fn of_path(&self, path: &[Vec3], earlier: f64) -> u32 {
        let mut angle = 0.0;
        for pair in path.windows(2) {
            let (a, b) = (self.flat(&pair[0]), self.flat(&pair[1]));
            angle += a.cross(&b).norm().atan2(a.dot(&b));
        }
        // No way turns by more than it does on the inner circle.
        let less = if earlier > 0.0 { earlier / self.inner } else { 0.0 };
        let start = path.first().map(|first| self.flat(first).norm());
        start.map_or(1, |start| self.least_chords((angle - less).max(0.0), start, self.outer))
    }
}

/// What is known of the bend along the beginning of a path from how its vectors were proven.
#[derive(Debug, Clone)]
pub(crate) struct Bent {
    /// The position that the path has come to.
    to: Vec3,
    /// What is filled until there.
    filled: Filled,
}

impl Bent {
    /// The beginning of a path.
    pub(crate) fn none(from: &Vec3) -> Self {
        Self { to: *from, filled: Filled::default() }
    }
}

/// A vector of a path, and how the clearances from part and drive surface run along it.
#[derive(Debug, Clone)]
struct Vector {
    to: Vec3,
    readings: [Readings; 2],
}

/// The bend along a path that grows vector by vector, the last of which may be taken back.
#[derive(Debug, Clone)]
pub(crate) struct Record {
    /// What is not taken back any more.
    settled: Bent,
    /// The vectors since then.
    recent: VecDeque<Vector>,
    limits: Limits,
}

/// How many of the last vectors may be taken back.
const KEPT: usize = 3;

impl Record {
    /// A path that begins at a position, and MAXDP.
    pub(crate) fn new(from: &Vec3, roles: [&Working; 2], maximum_step: f64) -> Self {
        let limits = Limits::new(roles, maximum_step, WIDER);
        Self { settled: Bent::none(from), recent: VecDeque::with_capacity(KEPT), limits }
    }

    /// A vector from one position to the next, and what has been read of both clearances along it.
    pub(crate) fn add(&mut self, (from, to): (&Vec3, &Vec3), readings: &[Readings; 2]) {
        let leads_there = |vector: &Vector| vector.to == *from;
        if !self.recent.back().is_some_and(leads_there) {
            // What led on from there has been taken back.
            if let Some(known) = self.recent.iter().rposition(leads_there) {
                self.recent.truncate(known + 1);
            } else if self.settled.to == *from {
                self.recent.clear();
            }
        }
        if self.recent.len() >= KEPT
            && let Some(Vector { to, readings: [part, drive] }) = self.recent.front()
        {
            self.settled.filled.add([part, drive], &self.limits);
            self.settled.to = *to;
            self.recent.pop_front();
        }
        self.recent.push_back(Vector { to: *to, readings: *readings });
    }

    /// What is known of a path with these positions.
    pub(crate) fn along(&self, points: &[Vec3]) -> Bent {
        let mut bent = self.settled.clone();
        let is_known = |tip: &Vec3| self.recent.iter().rposition(|vector| vector.to == *tip);
        let latest = points.iter().rev().take(KEPT + 1).find_map(is_known);
        for Vector { to, readings: [part, drive] } in self.recent.iter().take(latest.map_or(0, |k| k + 1)) {
            bent.filled.add([part, drive], &self.limits);
            bent.to = *to;
        }
        bent
    }
}

/// The number of cut vectors that no sequence within tolerance can beat.
pub(crate) fn minimum(sequence: &CutSequence, prepared: &Prepared, bent: &Bent) -> u32 {
    let mut path = Vec::with_capacity(sequence.points.len() + 1);
    path.push(sequence.start.tip);
    path.extend(sequence.points.iter().map(|p| p.tip));
    let (part, drive) = (&prepared.part, &prepared.drive);
    let earlier = earlier_end(sequence, prepared);
    // Where it is not known how far before its end another path may end that is taken to be the end of all.
    let on_rings = on_rings(prepared, &path, earlier.unwrap_or(0.0));
    // Between two planes MAXDP does not count (language reference 6.8).
    let planar = part.shape == Shape::Flat && drive.shape == Shape::Flat;
    let maximum_step = if planar { f64::INFINITY } else { sequence.maximum_step };
    // The straight way from start to end at MAXDP a vector.
    let straight = match (path.first(), path.last()) {
        (Some(first), Some(last)) => (last - first).norm(),
        _ => 0.0,
    };
    on_rings
        .max(bends(prepared, &path, bent, (maximum_step, earlier)))
        .max(whole(straight / maximum_step * (1.0 - 1e-9)))
}

/// The bound of the rings that confine the tool end along a path, which another one may end before by a way.
fn on_rings(prepared: &Prepared, path: &[Vec3], earlier: f64) -> u32 {
    let (part, drive) = (&prepared.part, &prepared.drive);
    let rings = [ring(prepared, part, drive), ring(prepared, drive, part)];
    let holding = rings.iter().flatten().filter(|ring| ring.holds(path));
    holding.map(|ring| ring.of_path(path, earlier)).max().unwrap_or(1)
}

/// The least number of vectors that the bends along a path and MAXDP ask for; what is filled is known to a position. Another sequence may end a
/// way before the end of the path: where it is not known to be a short one, a vector less is asked for.
fn bends(
    prepared: &Prepared,
    path: &[Vec3],
    bent: &Bent,
    (maximum_step, earlier): (f64, Option<f64>),
) -> u32 {
    let limits = Limits::new([&prepared.part, &prepared.drive], maximum_step, WIDER);
    let filled = to_end(prepared, path, bent.clone(), maximum_step).filled;
    let least = earlier.and_then(|earlier| filled.least(earlier));
    whole(least.unwrap_or_else(|| filled.count(&limits).ceil() - 1.0)).max(1)
}

/// How far before the end of a sequence along its path another one may end: in the bands of part, drive and check surface all, as the tangent
/// planes of the clearances tell. `None` where the path does not go through the check surface, and where there are several of them.
fn earlier_end(sequence: &CutSequence, prepared: &Prepared) -> Option<f64> {
    let (stop, end) = (sequence.stop.as_ref()?, sequence.points.last()?.tip);
    let [check] = &prepared.checks[..] else { return None };
    if is_tangent(stop.role.relation) {
        return None;
    }
    let mut check = check.clone();
    check.set_side(stop.role.side);
    let [part, drive, at_check] = [&prepared.part, &prepared.drive, &check]
        .map(|role| (role, role.gauge.contact(&prepared.tool, &end)));
    let along = part.1.gradient.cross(&drive.1.gradient).try_normalize(PARALLEL)?;
    let before = sequence.points.iter().rev().nth(1).map_or(sequence.start.tip, |point| point.tip);
    let forward = along * (end - before).dot(&along).signum();
    let rate = at_check.1.gradient.dot(&forward);
    let limits = |role: &Working| [-role.inside, role.outside];
    let mut earlier: f64 = 0.0;
    for (in_part, in_drive) in limits(part.0).into_iter().flat_map(|p| limits(drive.0).map(|d| (p, d))) {
        let left = [part.1.clearance - in_part, drive.1.clearance - in_drive];
        let aside = position::correction_of_two(left, [part.1.gradient, drive.1.gradient]);
        for in_check in limits(&check) {
            let rest = in_check - at_check.1.clearance - at_check.1.gradient.dot(&aside);
            earlier = earlier.max(-rest / rate);
        }
    }
    earlier.is_finite().then_some(EARLIER * earlier)
}

/// How many times as far as tangent planes tell another sequence is taken to end before a path, for what bends.
const EARLIER: f64 = 2.0;

/// What is known of the bend along all of a path, of whose beginning it is known: vertices that are moved later do not change how the
/// path bends.
pub(crate) fn to_end(prepared: &Prepared, path: &[Vec3], mut bent: Bent, maximum_step: f64) -> Bent {
    let roles = [&prepared.part, &prepared.drive];
    let limits = Limits::new(roles, maximum_step, WIDER);
    // The end of a motion may leave out that position, or come before it.
    let met = path.iter().rposition(|tip| *tip == bent.to).unwrap_or(path.len().saturating_sub(2));
    let begin = bent.to;
    let rest = std::iter::once(&begin).chain(path.get(met + 1..).unwrap_or_default());
    for (from, to) in rest.clone().zip(rest.skip(1)).filter(|(from, to)| from != to) {
        let [part, drive] = roles.map(|role| read(&prepared.tool, role, [from, to]));
        bent.filled.add([&part, &drive], &limits);
        bent.to = *to;
    }
    bent
}

/// How many vectors a path needs that begins and ends where it does.
pub(crate) fn needed(prepared: &Prepared, path: &[Vec3], bent: Bent, maximum_step: f64) -> u32 {
    let limits = Limits::new([&prepared.part, &prepared.drive], maximum_step, WIDER);
    let bends = to_end(prepared, path, bent, maximum_step).filled.count(&limits);
    whole(bends).max(on_rings(prepared, path, 0.0))
}

/// What each of the vectors between positions fills of one; `None` when it is given up.
pub(crate) fn fills(
    prepared: &Prepared,
    path: &[Vec3],
    maximum_step: f64,
    patience: Patience<'_>,
) -> Option<Vec<f64>> {
    let roles = [&prepared.part, &prepared.drive];
    let limits = Limits::new(roles, maximum_step, WIDER_ROUGHLY);
    let (mut filled, mut before) = (Filled::default(), 0.0);
    let of_vector = |pair: &[Vec3]| {
        let [part, drive] = roles.map(|role| read(&prepared.tool, role, [&pair[0], &pair[1]]));
        filled.add([&part, &drive], &limits);
        let now = filled.count(&limits);
        (!patience.is_over()).then(|| now - std::mem::replace(&mut before, now))
    };
    path.windows(2).map(of_vector).collect()
}

/// The clearance of a role along a vector, at its ends and in its middle.
pub(crate) fn read(tool: &Tool<'_>, role: &Working, [from, to]: [&Vec3; 2]) -> Readings {
    let length = (to - from).norm();
    let direction = (to - from) / length;
    let reading = |x: f64| {
        let contact = role.gauge.contact(tool, &(from + direction * x));
        Reading { x, value: contact.clearance, slope: contact.gradient.dot(&direction) }
    };
    if role.shape == Shape::Flat {
        let level = |x: f64| Reading { x, ..Reading::default() };
        return Readings::at_ends(level(0.0), level(length));
    }
    Readings::at_ends(reading(0.0), reading(length)).with(reading(0.5 * length))
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

    /// A ball on an oblique cylinder begins outside of the ring, where the tool touches with its flank: the first chord turns by more than others.
    #[test]
    fn a_chord_from_outside_of_the_ring_turns_by_more_than_one_in_it() {
        let band = ring(7.284_098_888_810_774, 7.286_098_888_810_774);
        assert_eq!(band.least_chords(0.095_438_483_947, 7.287_494_34, band.outer), 2);
        assert_eq!(band.least_chords(0.095_438_483_947, band.outer, band.outer), 3);
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
    fn a_path_outside_of_a_ring_is_not_bound_by_it() {
        let band = ring(5.0372, 5.0377);
        assert!(band.holds(&[Vec3::new(5.0375, 0.0, 1.0), Vec3::new(0.0, 5.0377, 2.0)]));
        assert!(!band.holds(&[Vec3::new(2.709, 0.0, 1.0), Vec3::new(0.0, 2.709, 2.0)]));
    }

    #[test]
    fn straight_moves_need_one_vector() {
        assert_eq!(ring(2.0, 2.1).least_chords(0.0, 2.05, 2.05), 1);
    }
}

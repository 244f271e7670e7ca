//! Lower bounds for the number of cut vectors (arelem reference 5.6): chords of a ring, where the configuration confines
//! the tool end to one; elsewhere what the integral of √(κ/8τ) along the path fills, κ being how the clearance bends.

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

/// How many vectors a path fills, each as long as both bands and MAXDP allow: none can be longer, whatever was before it, so that no
/// sequence has fewer.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Filled {
    /// Vectors that are full.
    vectors: f64,
    /// Since then the integrals of √(κ/8τ) for part and drive surface, and the length in that of the longest vector; where one of
    /// these is one, a vector is full.
    since: Shares,
}

/// Share of a vector from which on one more is needed to come to a corner: the others may go beyond it by a tenth of their length, and the next
/// one may begin as much before it (`directed::march::step::at_corner`).
const NO_REST: f64 = 0.25;

/// What a stretch of a path fills of a vector, as [`Filled`] has it.
type Shares = [f64; 3];

impl Filled {
    /// Adds a stretch, which fills evenly along it, and no more than a vector.
    fn add(&mut self, shares: Shares) {
        let mut ahead = 1.0;
        loop {
            let all = self.since.iter().zip(shares);
            // What does not fill leaves room for ever; 0/0 is no number that a minimum takes.
            let room = all.map(|(since, share)| (1.0 - since) / share).fold(f64::INFINITY, f64::min);
            if room >= ahead {
                self.since.iter_mut().zip(shares).for_each(|(since, share)| *since += share * ahead);
                return;
            }
            self.vectors += 1.0;
            self.since = Shares::default();
            ahead -= room;
        }
    }

    /// Ends a stretch at a corner of the path, next to which every sequence has a vertex: the vector that leads there is full if it is no
    /// rest that another one could have taken along.
    fn end_at_corner(&mut self) {
        if self.since.into_iter().fold(0.0, f64::max) >= NO_REST {
            self.vectors += 1.0;
            self.since = Shares::default();
        }
    }

    /// All vectors, the last of which need not be full.
    fn count(&self) -> f64 {
        self.vectors + self.since.into_iter().fold(0.0, f64::max)
    }
}

/// What is known of the bend along the beginning of a path from how its vectors were proven.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bent {
    /// The position that the path has come to.
    pub(crate) to: Vec3,
    /// What is filled until there.
    filled: Filled,
}

impl Bent {
    /// The beginning of a path.
    pub(crate) fn none(from: &Vec3) -> Self {
        Self { to: *from, filled: Filled::default() }
    }
}

/// The bend along a path that grows vector by vector, the last of which may be taken back.
#[derive(Debug)]
pub(crate) struct Record {
    /// The last positions, the latest at the end.
    last: Vec<Bent>,
    /// MAXDP.
    maximum_step: f64,
}

/// How many of the last positions are kept.
const KEPT: usize = 4;

impl Record {
    /// A path that begins at a position, and MAXDP.
    pub(crate) fn new(from: &Vec3, maximum_step: f64) -> Self {
        Self { last: vec![Bent::none(from)], maximum_step }
    }

    /// A vector from one position to the next, along which the slopes of both clearances have this [`turning`], and whether it ends where
    /// the path turns on the spot.
    pub(crate) fn add(
        &mut self,
        (from, to): (&Vec3, &Vec3),
        roles: [&Working; 2],
        turning: [f64; 2],
        is_at_corner: bool,
    ) {
        if let Some(known) = self.last.iter().rposition(|bent| bent.to == *from) {
            // What led on from there has been taken back.
            self.last.truncate(known + 1);
        }
        let mut filled = self.last.last().map_or(Filled::default(), |bent| bent.filled);
        filled.add(shares(roles, turning, (to - from).norm(), self.maximum_step));
        if is_at_corner {
            filled.end_at_corner();
        }
        if self.last.len() >= KEPT {
            self.last.remove(0);
        }
        self.last.push(Bent { to: *to, filled });
    }

    /// What is known of a path with these positions.
    pub(crate) fn along(&self, from: &Vec3, points: &[Vec3]) -> Bent {
        let known = |tip: &Vec3| self.last.iter().find(|bent| bent.to == *tip);
        let latest = points.iter().rev().take(KEPT).find_map(known).or(self.last.first());
        latest.copied().unwrap_or(Bent::none(from))
    }
}

/// Integral of √|κ| over a stretch of a length over which a slope changes.
pub(crate) fn turning(length: f64, slopes: [f64; 2]) -> f64 {
    ((slopes[1] - slopes[0]).abs() * length).sqrt()
}

/// What a vector of a length fills. It keeps the bands, so that it counts for one at most: where contact jumps the slope turns
/// without need of another vector.
fn shares(roles: [&Working; 2], turning: [f64; 2], length: f64, maximum_step: f64) -> Shares {
    let bands = roles.map(Working::band);
    let [part, drive] = [0, 1].map(|k: usize| (turning[k] / (8.0 * bands[k]).sqrt()).min(1.0));
    // The way beside one vector, from its one end to the other within the bands, may be longer by that.
    let longest = maximum_step + 2.0 * (bands[0] + bands[1]);
    [part, drive, (length / longest).min(1.0)]
}

/// The number of cut vectors that no sequence within tolerance can beat.
pub(crate) fn minimum(sequence: &CutSequence, prepared: &Prepared, bent: &Bent) -> u32 {
    let mut path = Vec::with_capacity(sequence.points.len() + 1);
    path.push(sequence.start.tip);
    path.extend(sequence.points.iter().map(|p| p.tip));
    let (part, drive) = (&prepared.part, &prepared.drive);
    let rings = [ring(prepared, part, drive), ring(prepared, drive, part)];
    let on_rings = rings.iter().flatten().map(|ring| ring.of_path(&path)).max().unwrap_or(1);
    // Between two planes MAXDP does not count (language reference 6.8).
    let planar = part.shape == Shape::Flat && drive.shape == Shape::Flat;
    let maximum_step = if planar { f64::INFINITY } else { sequence.maximum_step };
    // The straight way from start to end at MAXDP a vector.
    let straight = match (path.first(), path.last()) {
        (Some(first), Some(last)) => (last - first).norm(),
        _ => 0.0,
    };
    on_rings
        .max(bends(prepared, &path, bent, maximum_step))
        .max(whole(straight / maximum_step * (1.0 - 1e-9)))
}

/// The least number of vectors that the bends along a path and MAXDP ask for; what is filled is known to a position.
fn bends(prepared: &Prepared, path: &[Vec3], bent: &Bent, maximum_step: f64) -> u32 {
    let mut filled = bent.filled;
    // The end of a motion may leave out that position, or come before it.
    let met = path.iter().rposition(|tip| *tip == bent.to).unwrap_or(path.len().saturating_sub(2));
    let rest = std::iter::once(&bent.to).chain(&path[met + 1..]);
    for (from, to) in rest.clone().zip(rest.skip(1)) {
        let roles = [&prepared.part, &prepared.drive];
        let turning = roles.map(|role| turn(prepared, role, from, to));
        filled.add(shares(roles, turning, (to - from).norm(), maximum_step));
    }
    whole(filled.count() * (1.0 - SAMPLED)).saturating_sub(1).max(1)
}

/// Part of the integral that sampling the bend at the ends and in the middle of each vector may add.
const SAMPLED: f64 = 0.01;

/// The turning of the slope along a vector.
fn turn(prepared: &Prepared, role: &Working, from: &Vec3, to: &Vec3) -> f64 {
    let length = (to - from).norm();
    if length <= 0.0 || role.shape == Shape::Flat {
        return 0.0;
    }
    let direction = (to - from) / length;
    let slope = |tip: &Vec3| role.gauge.contact(&prepared.tool, tip).gradient.dot(&direction);
    let half = 0.5 * length;
    let slopes = [from, &(0.5 * (from + to)), to].map(slope);
    turning(half, [slopes[0], slopes[1]]) + turning(half, [slopes[1], slopes[2]])
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

    fn filled(shares: &[Shares]) -> Filled {
        let mut filled = Filled::default();
        shares.iter().for_each(|share| filled.add(*share));
        filled
    }

    /// What one role alone fills is the integral, in pieces of whatever size.
    #[test]
    fn one_bend_fills_its_integral() {
        for pieces in [1, 3, 7, 64] {
            let share = 0.7 / f64::from(pieces);
            let along: Vec<_> = (0..10 * pieces).map(|_| [0.0, share, 0.0]).collect();
            assert!((filled(&along).count() - 7.0).abs() < 1e-9, "{pieces}: {}", filled(&along).count());
        }
        assert_eq!(filled(&[Shares::default(); 5]).count(), 0.0);
    }

    /// Where the surfaces bend in turn a vector is full before the greater of both integrals is.
    #[test]
    fn bends_in_turn_fill_more_vectors_than_either_alone() {
        let along: Vec<_> = (0..40).flat_map(|_| [[0.6, 0.0, 0.0], [0.0, 0.0, 0.6]]).collect();
        let count = filled(&along).count();
        assert!(count > 1.1 * 24.0 && count < 48.0, "{count}");
        let alike: Vec<_> = (0..40).map(|_| [0.5, 0.75, 0.2]).collect();
        assert!((filled(&alike).count() - 30.0).abs() < 1e-9);
    }

    /// Before a corner and beyond it there are whole vectors, but for what those to it may be longer.
    #[test]
    fn a_corner_ends_a_vector() {
        let mut filled = Filled::default();
        for (share, count) in [(2.4, 3.0), (1.2, 4.2), (0.0, 4.2), (0.1, 5.0), (0.1, 5.1)] {
            (0..24).for_each(|_| filled.add([share / 24.0, 0.0, 0.0]));
            filled.end_at_corner();
            assert!((filled.count() - count).abs() < 1e-9, "{share}: {}", filled.count());
        }
    }

    /// Each piece keeps both bands, so that there cannot be a need for more than the pieces are.
    #[test]
    fn no_more_vectors_are_filled_than_there_are() {
        let along: Vec<_> = (0..200).map(|k| [37, 61, 83].map(|x| f64::from(k * x % 100) / 99.0)).collect();
        for pieces in 1..along.len() {
            assert!(filled(&along[..pieces]).count() <= pieces as f64 + 1e-9);
        }
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

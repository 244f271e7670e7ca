//! Proof that no point of the tool is nearer to a surface than a level, whatever the search for the contact has found.
//!
//! The boundary of the tool is covered by patches: stretches of its profile over ranges of azimuth. From the middle of a
//! patch the distance of every other point follows up to a known error: its first derivatives are those at the middle,
//! and a bound of the second ones covers the rest. The linear part is minimised over the patch in closed form, so that
//! the tool's own curvature counts in full. Patches that this does not clear are halved.

use std::{
    cmp::Ordering,
    collections::BinaryHeap,
    f64::consts::{FRAC_PI_2, FRAC_PI_3, PI},
};

use apt_geometry::{
    Vec3,
    cutter::ProfilePoint,
    surface::{Bend, Foot, Region, Surface},
};

use super::{Contact, Tool};

/// Bound of the patches looked at. A proof takes some dozens; where contact is nearly flat, a few hundred.
const MAX_PATCHES: u32 = 1500;
/// Share of the coordinates that is rounding of a distance.
const ROUNDING: f64 = 1e-15;
/// Half a range of azimuth (radians) below which the ball of a corner is left for the corner itself.
const NARROW: f64 = 0.02;
/// How far (radians) from the corner's own fan a normal may point while its whole ball is looked at.
const BESIDE_FAN: f64 = 0.05;

/// What is known about a level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Certificate {
    /// No point of the tool is lower.
    Holds,
    /// This point is.
    Lower(Contact),
    /// The patches ran out.
    Undecided,
}

/// A stretch of the profile.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stretch {
    /// A straight line between two points (radius, height).
    Line([[f64; 2]; 2]),
    /// Part of the corner: centre, radius, polar angles from straight down.
    Arc { center: [f64; 2], arc: f64, polar: [f64; 2] },
    /// The whole balls about the points of the circle on which the corner's centre turns.
    Ball { center: [f64; 2], arc: f64, fan: [f64; 2] },
}

/// A stretch over a range of azimuth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch {
    stretch: Stretch,
    azimuth: f64,
    /// Half the range, π for a whole turn.
    half: f64,
}

/// What is known of the distance over a patch.
struct Judged {
    /// No point of the patch is nearer to the surface.
    least: f64,
    /// A point of the tool with its distance.
    sample: Contact,
    /// Length of the patch along the profile, as far as the surface tells it from nothing.
    length: f64,
}

/// A surface and the side of it that the tool is on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face<'a> {
    /// The surface.
    pub(crate) surface: &'a Surface,
    /// Side of its natural normal.
    pub(crate) side: f64,
}

/// A patch that is not cleared yet; the one that may be lowest is the greatest, among equals the one seen first.
struct Open {
    patch: Patch,
    judged: Judged,
    number: u32,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.judged.least.total_cmp(&self.judged.least).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

/// Examines whether the distance from a surface is nowhere on some patches of the tool below a level. The patch that may be
/// lowest is halved first: where the level is not kept that leads down to a lower point.
pub(super) fn certify(
    face: Face<'_>,
    tool: &Tool,
    tip: &Vec3,
    level: f64,
    mut patches: Vec<Patch>,
) -> Certificate {
    let mut open: BinaryHeap<Open> = BinaryHeap::new();
    let mut seen = 0;
    let cleared = level - ROUNDING * (tip.amax() + tool.radius() + tool.profile.top.height);
    loop {
        for patch in patches.drain(..) {
            seen += 1;
            let judged = judge(face, tool, tip, &patch);
            if judged.least >= cleared {
                continue;
            }
            if judged.sample.clearance < level {
                return Certificate::Lower(judged.sample);
            }
            open.push(Open { patch, judged, number: seen });
        }
        let Some(Open { patch, judged, .. }) = open.pop() else { return Certificate::Holds };
        if seen > MAX_PATCHES {
            return Certificate::Undecided;
        }
        split(&mut patches, tool, &patch, &judged);
    }
}

/// The patches that may hold points nearer than a far level. They are as large as the proof of the near level allows.
pub(super) fn outline(face: Face<'_>, tool: &Tool, tip: &Vec3, [near, far]: [f64; 2]) -> Option<Vec<Patch>> {
    let (mut patches, mut found) = (boundary(tool), Vec::new());
    let mut seen = 0;
    while let Some(patch) = patches.pop() {
        seen += 1;
        if seen > MAX_PATCHES {
            return None;
        }
        let judged = judge(face, tool, tip, &patch);
        if judged.least >= far {
            continue;
        }
        // Patches as small as the distance that counts are not worth halving.
        let small = patch.extent(judged.length) <= 0.25 * (far - near);
        if small || judged.least >= near && patch.half < PI {
            found.push(patch);
        } else {
            split(&mut patches, tool, &patch, &judged);
        }
    }
    Some(found)
}

impl Patch {
    /// Its greater dimension, its length along the profile being given.
    fn extent(&self, length: f64) -> f64 {
        length.max(2.0 * self.stretch.radius() * self.half.min(FRAC_PI_2))
    }
}

/// The whole boundary, the parts that matter most last, because the last is looked at first.
pub(super) fn boundary(tool: &Tool) -> Vec<Patch> {
    let profile = &tool.profile;
    let (lower, upper, top) = (profile.lower, profile.upper, profile.top);
    let whole = |stretch| Patch { stretch, azimuth: 0.0, half: PI };
    let mut patches = Vec::with_capacity(32);
    let round = profile.arc > 0.0;
    let mut line = |from: ProfilePoint, to: ProfilePoint| {
        // The ends of the corner belong to it.
        if from != to || !round {
            patches.push(whole(Stretch::Line([[from.radius, from.height], [to.radius, to.height]])));
        }
    };
    line(upper, top);
    line(ProfilePoint { radius: 0.0, height: 0.0 }, lower);
    if round {
        let center = [profile.center.radius, profile.center.height];
        patches.push(whole(Stretch::Ball { center, arc: profile.arc, fan: profile.fan }));
    }
    patches
}

/// The flank above a height.
pub(super) fn flank_from(tool: &Tool, height: f64) -> Patch {
    let (upper, top) = (tool.profile.upper, tool.profile.top);
    let share = ((height - upper.height) / (top.height - upper.height)).clamp(0.0, 1.0);
    let radius = upper.radius + share * (top.radius - upper.radius);
    let stretch = Stretch::Line([[radius, height], [top.radius, top.height]]);
    Patch { stretch, azimuth: 0.0, half: PI }
}

impl Stretch {
    /// Greatest distance from the axis.
    fn radius(&self) -> f64 {
        match *self {
            Self::Line([a, b]) => a[0].max(b[0]),
            Self::Arc { center, arc, polar } => {
                let at = |angle: f64| center[0] + arc * angle.sin();
                let top = if polar[0] < FRAC_PI_2 && polar[1] > FRAC_PI_2 { center[0] + arc } else { 0.0 };
                at(polar[0]).max(at(polar[1])).max(top)
            }
            Self::Ball { center, .. } => center[0],
        }
    }

    /// Length along the profile.
    fn length(&self) -> f64 {
        match *self {
            Self::Line([a, b]) => (b[0] - a[0]).hypot(b[1] - a[1]),
            Self::Arc { arc, polar, .. } => arc * (polar[1] - polar[0]),
            Self::Ball { .. } => 0.0,
        }
    }

    /// Both halves.
    fn halves(&self) -> [Self; 2] {
        match *self {
            Self::Line([a, b]) => {
                let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                [Self::Line([a, middle]), Self::Line([middle, b])]
            }
            Self::Arc { center, arc, polar: [a, b] } => {
                let middle = 0.5 * (a + b);
                [Self::Arc { center, arc, polar: [a, middle] }, Self::Arc { center, arc, polar: [middle, b] }]
            }
            Self::Ball { .. } => [*self, *self],
        }
    }
}

/// The distance over a patch from its middle.
fn judge(face: Face<'_>, tool: &Tool, tip: &Vec3, patch: &Patch) -> Judged {
    let (sin, cos) = patch.azimuth.sin_cos();
    let radial = tool.across[0] * cos + tool.across[1] * sin;
    let place = |p: [f64; 2]| tip + tool.axis * p[1] + radial * p[0];
    let radius = patch.stretch.radius();
    let round = patch.half >= PI && radius > 0.0;
    let (middle, ball) = match patch.stretch {
        Stretch::Line([a, b]) if round => ([0.0, 0.5 * (a[1] + b[1])], 0.0),
        Stretch::Line([a, b]) => ([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], 0.0),
        Stretch::Arc { center, arc, polar } => {
            let angle = 0.5 * (polar[0] + polar[1]);
            let outward = if round { 0.0 } else { center[0] + arc * angle.sin() };
            ([outward, center[1] - arc * angle.cos()], 0.0)
        }
        Stretch::Ball { center, arc, .. } if round => ([0.0, center[1]], arc),
        Stretch::Ball { center, arc, .. } => (center, arc),
    };
    let p = place(middle);
    let foot = face.surface.foot(&p);
    let distance = face.side * foot.distance;
    let normal = foot.normal * face.side;
    let sample = sample(tool, patch, &p, &foot, face.side);
    if round {
        // From a point of the axis: nothing is farther from it than this.
        let reach = radius.hypot(0.5 * patch.stretch.length());
        return Judged { least: distance - reach - ball, sample, length: patch.stretch.length() };
    }
    let chord = if patch.half >= PI { 0.0 } else { 2.0 * radius * (0.5 * patch.half).sin() };
    let half = 0.5 * patch.stretch.length();
    // Along a generator of the surface nothing changes.
    let half = match (patch.stretch, face.surface.generator()) {
        (Stretch::Line([a, b]), Some(generator)) => {
            let way = tool.axis * (b[1] - a[1]) + radial * (b[0] - a[0]);
            0.5 * way.cross(&generator).norm()
        }
        _ => half,
    };
    let reach = chord + half;
    let length = 2.0 * half;
    let farthest = distance - reach - ball;
    if reach == 0.0 {
        return Judged { least: farthest, sample, length };
    }
    let bend = match downward_bend(face, &foot, &p, reach) {
        Bend::AtMost(bend) => bend,
        Bend::Unbounded => return Judged { least: farthest, sample, length },
    };
    let tangent = tool.axis.cross(&radial);
    // Of |a + b|² ≤ 2a² + 2b² one part goes to each direction; alone, a part needs no factor.
    let share = if chord > 0.0 && half > 0.0 { 2.0 } else { 1.0 };
    let around = least_on_arc(
        -radius * normal.dot(&radial) - share * bend * radius * radius,
        radius * normal.dot(&tangent),
        patch.half.min(FRAC_PI_2),
    );
    let around = if chord > 0.0 { around } else { 0.0 };
    let along = match patch.stretch {
        Stretch::Line([a, b]) => {
            let way = tool.axis * (b[1] - a[1]) + radial * (b[0] - a[0]);
            -0.5 * normal.dot(&way).abs() - 0.5 * share * bend * half * half
        }
        Stretch::Arc { arc, polar, .. } => {
            let (sin, cos) = (0.5 * (polar[0] + polar[1])).sin_cos();
            let outward = radial * sin - tool.axis * cos;
            let onward = radial * cos + tool.axis * sin;
            least_on_arc(
                -arc * normal.dot(&outward) - share * bend * arc * arc,
                arc * normal.dot(&onward),
                0.5 * (polar[1] - polar[0]),
            )
        }
        Stretch::Ball { .. } => 0.0,
    };
    Judged { least: farthest.max(distance + around + along - ball), sample, length }
}

/// A point of the tool near the middle of a patch: of a ball, its point towards the surface if it belongs to the tool.
fn sample(tool: &Tool, patch: &Patch, p: &Vec3, foot: &Foot, side: f64) -> Contact {
    let (clearance, gradient) = (side * foot.distance, foot.normal * side);
    if let Stretch::Ball { arc, fan, .. } = patch.stretch
        && clearance >= arc
        && patch.half < PI
    {
        let polar = gradient.dot(&tool.axis).clamp(-1.0, 1.0).acos();
        if polar >= fan[0] && polar <= fan[1] {
            return Contact {
                clearance: clearance - arc,
                gradient,
                tool: p - gradient * arc,
                surface: foot.point,
            };
        }
    }
    Contact { clearance, gradient, tool: *p, surface: foot.point }
}

/// How strongly the distance bends downward within reach of a point.
fn downward_bend(face: Face<'_>, foot: &Foot, center: &Vec3, reach: f64) -> Bend {
    let distance = face.side * foot.distance;
    let region =
        Region { center: *center, radius: reach, lowest: -distance - reach, highest: reach - distance };
    face.surface.bend(-face.side, foot, &region)
}

/// Lower bound of `a (1 − cos ψ) + b sin ψ` for |ψ| up to `half`, at most a right angle.
fn least_on_arc(a: f64, b: f64, half: f64) -> f64 {
    let by_ends = a.min(0.0) * (1.0 - half.cos()) - b.abs() * half.sin();
    if a > 0.0 { by_ends.max(a - a.hypot(b)) } else { by_ends }
}

/// The parts of a patch that may yet be cleared.
fn split(patches: &mut Vec<Patch>, tool: &Tool, patch: &Patch, judged: &Judged) {
    let Patch { stretch, azimuth, half } = *patch;
    let radius = stretch.radius();
    let whole = half >= PI;
    if let Stretch::Ball { center, arc, fan } = stretch {
        let polar = judged.sample.gradient.dot(&tool.axis).clamp(-1.0, 1.0).acos();
        let beside = polar < fan[0] - BESIDE_FAN || polar > fan[1] + BESIDE_FAN;
        if radius <= 0.0 || half <= NARROW || beside && !whole {
            patches.push(Patch { stretch: Stretch::Arc { center, arc, polar: fan }, azimuth, half });
            return;
        }
    }
    let along = judged.length > if whole { 2.0 * radius } else { 2.0 * radius * half };
    if along || radius <= 0.0 {
        patches.extend(stretch.halves().map(|stretch| Patch { stretch, azimuth, half }));
    } else if whole {
        let turned = |k: f64| Patch { stretch, azimuth: azimuth + 2.0 * k * FRAC_PI_3, half: FRAC_PI_3 };
        patches.extend([turned(0.0), turned(1.0), turned(2.0)]);
    } else {
        let turned = |k: f64| Patch { stretch, azimuth: azimuth + k * half, half: 0.5 * half };
        patches.extend([turned(-0.5), turned(0.5)]);
    }
}

//! Patches of the tool's boundary: stretches of its profile over ranges of azimuth.

use std::f64::consts::{FRAC_PI_2, PI};

use apt_geometry::{Vec3, cutter::ProfilePoint};

use super::{
    Tool,
    floor::{self, Base, Course},
};

/// Half the greatest range of normals (radians) over which the corner is taken for the triangle about it.
const WIDEST: f64 = 1.2;

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
    pub(super) stretch: Stretch,
    pub(super) azimuth: f64,
    /// Half the range, π for a whole turn.
    pub(super) half: f64,
}

/// Where a patch is judged from.
pub(super) struct Middle {
    /// The place, on the axis for a whole turn.
    pub(super) place: Vec3,
    /// Radius of the ball about it.
    pub(super) ball: f64,
    /// No point of the patch, but for balls, is farther from the place; what lies along a generator does not count.
    pub(super) reach: f64,
    /// Length of the patch along the profile, as far as the surface tells it from nothing.
    pub(super) length: f64,
    /// Whether the patch is a whole turn about the axis.
    pub(super) round: bool,
}

impl Patch {
    /// Its middle with the tool end at a place, beside a surface with a generator or without.
    pub(super) fn middle(&self, tool: &Tool, tip: &Vec3, generator: Option<&Vec3>) -> Middle {
        let (sin, cos) = self.azimuth.sin_cos();
        let radial = tool.across[0] * cos + tool.across[1] * sin;
        let radius = self.stretch.radius();
        let round = self.half >= PI && radius > 0.0;
        let ([outward, height], ball) = self.stretch.middle(round);
        let place = tip + tool.axis * height + radial * outward;
        let half = 0.5 * self.stretch.length();
        // Along a generator of the surface nothing changes.
        let half = match (self.stretch, generator) {
            (Stretch::Line([a, b]), Some(generator)) if !round => {
                let way = tool.axis * (b[1] - a[1]) + radial * (b[0] - a[0]);
                0.5 * way.cross(generator).norm()
            }
            _ => half,
        };
        let reach = if round { radius.hypot(half) } else { self.chord() + half };
        Middle { place, ball, reach, length: 2.0 * half, round }
    }

    /// No point of it is farther from that of the same height in its middle.
    pub(super) fn chord(&self) -> f64 {
        if self.half >= PI { 0.0 } else { 2.0 * self.stretch.radius() * (0.5 * self.half).sin() }
    }

    /// No point of it, but for balls about its points, is nearer to the surface, as seen from a base.
    pub(super) fn least(&self, tool: &Tool, tip: &Vec3, base: &Base, course: Course) -> f64 {
        let Self { azimuth, half, .. } = *self;
        let at = |[radius, height]: [f64; 2]| {
            base.least(tool, tip, course, floor::Arc { radius, height, azimuth, half })
        };
        match self.stretch {
            Stretch::Line([a, b]) => at(a).min(at(b)),
            Stretch::Ball { center, .. } => at(center),
            Stretch::Arc { center, arc, polar: [first, last] } => {
                // The arc lies in the triangle of its ends and the place where its tangents meet.
                let half = 0.5 * (last - first);
                if half > WIDEST {
                    return f64::NEG_INFINITY;
                }
                let place = |angle: f64, radius: f64| {
                    let (sin, cos) = angle.sin_cos();
                    [center[0] + radius * sin, center[1] - radius * cos]
                };
                let meet = place(0.5 * (first + last), arc / half.cos());
                at(place(first, arc)).min(at(place(last, arc))).min(at(meet))
            }
        }
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
        let (arc, fan) = (profile.arc, profile.fan);
        patches.push(whole(match profile.is_barrel() {
            true => Stretch::Arc { center, arc, polar: fan },
            false => Stretch::Ball { center, arc, fan },
        }));
    }
    patches
}

/// The flank between two heights.
pub(super) fn flank_between(tool: &Tool, heights: [f64; 2]) -> Patch {
    let (upper, top) = (tool.profile.upper, tool.profile.top);
    let ends = heights.map(|height| {
        let share = ((height - upper.height) / (top.height - upper.height)).clamp(0.0, 1.0);
        [upper.radius + share * (top.radius - upper.radius), height]
    });
    Patch { stretch: Stretch::Line(ends), azimuth: 0.0, half: PI }
}

impl Stretch {
    /// The point (radius, height) from which it is judged, on the axis for a whole turn; and the radius of the ball about it.
    pub(super) fn middle(&self, round: bool) -> ([f64; 2], f64) {
        let (at, ball) = match *self {
            Self::Line([a, b]) => ([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], 0.0),
            Self::Arc { center, arc, polar } => {
                let angle = 0.5 * (polar[0] + polar[1]);
                ([center[0] + arc * angle.sin(), center[1] - arc * angle.cos()], 0.0)
            }
            Self::Ball { center, arc, .. } => (center, arc),
        };
        (if round { [0.0, at[1]] } else { at }, ball)
    }

    /// Greatest distance from the axis.
    pub(super) fn radius(&self) -> f64 {
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
    pub(super) fn length(&self) -> f64 {
        match *self {
            Self::Line([a, b]) => (b[0] - a[0]).hypot(b[1] - a[1]),
            Self::Arc { arc, polar, .. } => arc * (polar[1] - polar[0]),
            Self::Ball { .. } => 0.0,
        }
    }

    /// Both halves.
    pub(super) fn halves(&self) -> [Self; 2] {
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

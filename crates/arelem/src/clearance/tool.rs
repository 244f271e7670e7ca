//! The cutter as a convex body of revolution with a fixed axis, and the pieces of its boundary where contact happens.

use apt_geometry::{
    Vec3,
    cutter::{Cutter, Profile},
    patience::Patience,
    surface::{Surface, perpendicular},
};

/// How often the observer of a side looks from another place, and how far apart, relative to the tool, places are one.
const MOST_GLANCES: u32 = 32;
const SAME_GLANCE: f64 = 1e-6;
/// Parts of the axis between the places from which it is looked how deep a surface is in the tool.
const DEPTHS: u32 = 4;
/// Halvings of the way between these with which the deepest place is closed in on.
const DEPTH_HALVINGS: u32 = 10;
/// Tangent of the angle to the axis below which rounding may leave something of the axis in what is across it, and sine of the angle of a
/// direction to the axis below which that is all there is.
const NEAR_AXIS: f64 = 1e-6;
const ALONG_AXIS: f64 = 1e-3;

/// A piece of the tool's boundary, for surfaces without closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Piece {
    /// A circle about the axis carrying a ball: an edge (`ball` zero) or the corner torus. `fan` limits the polar
    /// angle of the contact normal from straight down; outside it the neighbouring pieces are in contact.
    Ring { radius: f64, height: f64, ball: f64, fan: Option<[f64; 2]> },
    /// The flat bottom.
    Disc { radius: f64 },
    /// A conical or cylindrical patch between two circles.
    Frustum { radius: [f64; 2], height: [f64; 2] },
    /// The corner of a barrel: the arc about a centre (radius, height) beyond the axis, turned about that, between two polar angles of its
    /// normals from straight down. It is no circle of balls that the tool holds.
    Bulge { center: [f64; 2], arc: f64, fan: [f64; 2] },
}

/// A piece of the profile that is turned about the axis, followed upwards by a share of its length.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Curve {
    /// Straight, by the radii and heights of its ends.
    Line { radius: [f64; 2], height: [f64; 2] },
    /// An arc about a centre, between two polar angles of its normals.
    Arc { center: [f64; 2], arc: f64, fan: [f64; 2] },
}

/// A place of such a piece (radius, height), and its first and second derivatives by the share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spot {
    pub(crate) place: [f64; 2],
    pub(crate) way: [f64; 2],
    pub(crate) bend: [f64; 2],
}

impl Piece {
    /// What is turned about the axis for a patch with two sides.
    pub(crate) fn curve(&self) -> Option<Curve> {
        match *self {
            Self::Frustum { radius, height } => Some(Curve::Line { radius, height }),
            Self::Bulge { center, arc, fan } => Some(Curve::Arc { center, arc, fan }),
            Self::Ring { .. } | Self::Disc { .. } => None,
        }
    }
}

impl Curve {
    /// The place at a share of its length, which may be beyond its ends.
    pub(crate) fn at(&self, share: f64) -> Spot {
        match *self {
            Self::Line { radius, height } => {
                let way = [radius[1] - radius[0], height[1] - height[0]];
                Spot { place: [radius[0] + share * way[0], height[0] + share * way[1]], way, bend: [0.0; 2] }
            }
            Self::Arc { center, arc, fan: [first, last] } => {
                let turn = last - first;
                let (sin, cos) = (first + share * turn).sin_cos();
                let (speed, bend) = (arc * turn, arc * turn * turn);
                Spot {
                    place: [center[0] + arc * sin, center[1] - arc * cos],
                    way: [speed * cos, speed * sin],
                    bend: [-bend * sin, bend * cos],
                }
            }
        }
    }

    /// Its length.
    pub(crate) fn length(&self) -> f64 {
        match *self {
            Self::Line { radius, height } => (radius[1] - radius[0]).hypot(height[1] - height[0]),
            Self::Arc { arc, fan, .. } => arc * (fan[1] - fan[0]),
        }
    }

    /// The share at which it is seen from a place (radius, height): at its height of a straight one, from the centre of an arc.
    pub(crate) fn share_at(&self, [across, along]: [f64; 2]) -> f64 {
        let share = match *self {
            Self::Line { height: [low, high], .. } if high > low => (along - low) / (high - low),
            Self::Line { .. } => 0.0,
            Self::Arc { center, fan: [first, last], .. } => {
                ((across - center[0]).atan2(center[1] - along) - first) / (last - first)
            }
        };
        share.clamp(0.0, 1.0)
    }
}

/// A circle about the axis carrying balls; without radius one ball about a point of the axis.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Circle {
    /// Its radius.
    pub(crate) radius: f64,
    /// Height above the tool end.
    pub(crate) height: f64,
    /// Radius of the balls, zero for an edge.
    pub(crate) ball: f64,
}

/// The cutter with its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool<'a> {
    /// The seven numbers.
    pub cutter: Cutter,
    /// Unit axis from the tip to the spindle.
    pub axis: Vec3,
    pub(crate) profile: Profile,
    /// Greatest distance of the body from its axis.
    widest: f64,
    pub(crate) across: [Vec3; 2],
    pub(crate) pieces: Vec<Piece>,
    /// Who waits while it is measured: what is given up is measured no better than it is found without proof.
    pub(crate) patience: Patience<'a>,
}

impl<'a> Tool<'a> {
    /// A cutter with a fixed unit axis, for which one waits without end.
    pub fn new(cutter: Cutter, axis: Vec3) -> Self {
        Self::awaited(cutter, axis, Patience::default())
    }

    /// The same for which somebody waits.
    pub(crate) fn awaited(cutter: Cutter, axis: Vec3, patience: Patience<'a>) -> Self {
        let profile = cutter.profile();
        let x = perpendicular(&axis);
        let widest = profile.greatest_radius();
        let across = [x, axis.cross(&x)];
        Self { cutter, axis, profile, widest, across, pieces: pieces(&profile), patience }
    }

    /// The same cutter with another unit axis.
    pub(crate) fn turned(&self, axis: Vec3) -> Self {
        let x = perpendicular(&axis);
        Self { axis, across: [x, axis.cross(&x)], ..self.clone() }
    }

    /// Whether it has exactly this axis.
    #[inline]
    pub(crate) fn has_axis(&self, axis: &Vec3) -> bool {
        are_same(&self.axis, axis)
    }

    /// Radius of a ball that the body holds: one in the cone on its widest circle to the end of the axis that is farther from that.
    pub(crate) fn held_ball(&self) -> f64 {
        let (radius, height) = (self.widest, 0.5 * self.profile.top.height);
        if radius > 0.0 { radius * height / (radius + radius.hypot(height)) } else { 0.0 }
    }

    /// Greatest distance of the body from its axis.
    pub fn radius(&self) -> f64 {
        self.widest
    }

    /// A distance from the tool end beyond which there is no point of the body.
    pub(crate) fn reach(&self) -> f64 {
        self.cutter.height + self.radius()
    }

    /// The point half way up the tool, from which sides are judged.
    pub fn observer(&self, tip: &Vec3) -> Vec3 {
        tip + self.axis * (0.5 * self.cutter.height)
    }

    /// Signed distance of the observer from a surface. One who sees nothing but the end of it, beyond which there are no sides, goes
    /// along the tool to the place nearest to what is seen.
    pub(crate) fn observed(&self, surface: &Surface, tip: &Vec3) -> f64 {
        let mut observer = self.observer(tip);
        for _ in 0..MOST_GLANCES {
            if !surface.ends_at(&observer) {
                break;
            }
            let seen = surface.foot(&observer).point;
            let height = (seen - tip).dot(&self.axis).clamp(0.0, self.cutter.height);
            let next = tip + self.axis * height;
            if (next - observer).norm() <= SAME_GLANCE * self.cutter.height {
                break;
            }
            observer = next;
        }
        surface.signed_distance(&observer)
    }

    /// How deep in the tool the deepest is of the points of a surface that are nearest to places along the axis; negative where all of them are out of
    /// it. Unless some places show that it is as deep as is enough, the deepest is closed in on.
    pub(crate) fn depth_of(&self, surface: &Surface, tip: &Vec3, enough: f64) -> f64 {
        let depth = |height: f64| {
            let (along, across, _) = self.split(&(surface.foot(&(tip + self.axis * height)).point - tip));
            (-self.profile.distance(across, along).0, height)
        };
        let deeper = |a: (f64, f64), b: (f64, f64)| if b.0 > a.0 { b } else { a };
        let mut step = self.cutter.height / f64::from(DEPTHS);
        let tried = (0..=DEPTHS).map(|k| depth(step * f64::from(k)));
        let mut deepest = tried.fold((f64::NEG_INFINITY, 0.0), deeper);
        for _ in 0..DEPTH_HALVINGS {
            if deepest.0 >= enough {
                break;
            }
            step *= 0.5;
            let beside =
                [deepest.1 - step, deepest.1 + step].map(|height| height.clamp(0.0, self.cutter.height));
            deepest = beside.map(depth).into_iter().fold(deepest, deeper);
        }
        deepest.0
    }

    /// Component of a vector along the axis, length of the rest and its unit direction, which is square to the axis even where the rest is
    /// rounding.
    pub(crate) fn split(&self, w: &Vec3) -> (f64, f64, Vec3) {
        let along = w.dot(&self.axis);
        let radial = w - self.axis * along;
        let across = radial.norm();
        if across > NEAR_AXIS * along.abs() {
            return (along, across, radial / across);
        }
        let direction = radial.try_normalize(0.0).map(|radial| radial - self.axis * radial.dot(&self.axis));
        let square = direction.and_then(|direction| direction.try_normalize(ALONG_AXIS));
        (along, across, square.unwrap_or(self.across[0]))
    }
}

/// Whether two vectors are the same, number by number.
#[inline]
pub(super) fn are_same(a: &Vec3, b: &Vec3) -> bool {
    a.x == b.x && a.y == b.y && a.z == b.z
}

fn pieces(profile: &Profile) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(6);
    let edge = |radius, height| Piece::Ring { radius, height, ball: 0.0, fan: None };
    let (lower, upper, top) = (profile.lower, profile.upper, profile.top);
    if lower.height > 0.0 {
        pieces.push(edge(0.0, 0.0));
        pieces.push(edge(lower.radius, lower.height));
        pieces.push(Piece::Frustum { radius: [0.0, lower.radius], height: [0.0, lower.height] });
    } else {
        pieces.push(edge(lower.radius, 0.0));
        if lower.radius > 0.0 {
            pieces.push(Piece::Disc { radius: lower.radius });
        }
    }
    if profile.arc > 0.0 {
        let center = profile.center;
        pieces.push(if profile.is_barrel() {
            let center = [center.radius, center.height];
            Piece::Bulge { center, arc: profile.arc, fan: profile.fan }
        } else {
            let fan = Some(profile.fan);
            Piece::Ring { radius: center.radius, height: center.height, ball: profile.arc, fan }
        });
        pieces.push(edge(upper.radius, upper.height));
    }
    if top.height > upper.height {
        pieces.push(edge(top.radius, top.height));
        pieces
            .push(Piece::Frustum { radius: [upper.radius, top.radius], height: [upper.height, top.height] });
    }
    // Patches are looked into last: the edges tell where.
    pieces.sort_by_key(|piece| !matches!(piece, Piece::Ring { .. }));
    pieces
}

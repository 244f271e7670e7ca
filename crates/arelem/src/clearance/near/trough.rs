//! Contact along a straight piece of the tool: there no ball about the tool proves it, because it would have to touch the piece
//! where it bends and the piece does not, but a cylinder along the piece may.
//!
//! Where a surface bends at all places about towards the tool no more than a cylinder along a direction t, with a curvature b
//! (see [`Form::curvature_across`]), the distance from it falls at a vector w from a place with distance d below its tangent by no
//! more than `b′ (w² − (t·w)²)/2`. Its second derivatives are `−S (1 − d S)⁻¹` with the form S at the foot, which grows with S; so
//! `b′ = b/(1 − d b)` serves as far as d on the way.

use apt_geometry::{
    Vec3,
    surface::{Form, Steady},
};

use super::{Circle, Held, Pose};
use crate::clearance::{Contact, Tool, waves::length};

/// How far the tool may move in a ball of forms, in radii of the tool.
const EASE: f64 = 0.5;

/// Lengths of the difference of directions that a curvature is found for at once, and which share of it that is let to cost.
const TURNS: [f64; 3] = [0.05, 0.01, 0.002];
const MARGIN: f64 = 0.1;
/// How many of them are kept.
const MOST_ACROSS: usize = 6;

/// How the surface bends about a contact of the tool.
#[derive(Debug, Clone)]
pub(super) struct Bends {
    center: Vec3,
    radius: f64,
    forms: Vec<Form>,
}

/// The curvature of cylinders along a direction and all near by that bend as much as the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Across {
    along: Vec3,
    curvature: f64,
    /// No longer difference of directions.
    turn: f64,
}

/// The last curvatures, the one that was asked for last first: contacts along a vector are asked about in turn.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Acrosses([Option<Across>; MOST_ACROSS]);

impl Acrosses {
    /// That for a direction, made if it is not known.
    fn about(&mut self, along: &Vec3, make: impl FnOnce() -> Option<Across>) -> Option<f64> {
        let serves =
            |known: &Option<Across>| known.is_some_and(|known| (known.along - along).norm() <= known.turn);
        if let Some(known) = self.0.iter().position(serves) {
            self.0[..=known].rotate_right(1);
        } else {
            self.0.rotate_right(1);
            self.0[0] = make();
        }
        self.0[0].map(|known| known.curvature)
    }
}

/// A bound of how the distance falls below its tangent: as from a cylinder.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trough {
    along: Vec3,
    bend: f64,
}

/// What is known of a contact: the steady ball that it and the tool are in, the level that is asked about, how far the tool end
/// strays, what of the tool is held in the ball, and whether the contact is on its flank.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grounds {
    pub(super) steady: Steady,
    pub(super) level: f64,
    pub(super) stray: f64,
    pub(super) held: Held,
    pub(super) is_flank: bool,
}

/// How far the bottom of a tool and its corner, or what is held of its flank, are from a contact at most, and how far from the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    farthest: f64,
    deepest: f64,
}

impl Grounds {
    /// What of the tool is held about a contact on its flank.
    fn flank(&self) -> Option<Held> {
        self.is_flank.then_some(self.held)
    }
}

impl Bends {
    /// About the bottom and the corner of a tool in a steady ball, or its flank.
    pub(super) fn about(
        pose: &Pose<'_>,
        contact: &Contact,
        grounds: &Grounds,
        extent: Extent,
    ) -> Option<Self> {
        let (center, reach) = pose.feet(contact, grounds, extent)?;
        let radius = reach + EASE * pose.scale();
        let forms = pose.surface.forms(pose.side, &center, radius, pose.tool.patience)?;
        Some(Self { center, radius, forms })
    }

    /// Whether these parts of the tool, given a contact in a steady ball here or elsewhere, are where the forms are known.
    pub(super) fn hold(&self, pose: &Pose<'_>, contact: &Contact, grounds: &Grounds, extent: Extent) -> bool {
        let feet = pose.feet(contact, grounds, extent);
        feet.is_some_and(|(center, reach)| (center - self.center).norm() + reach <= self.radius)
    }

    /// What cylinders along a direction bend as much as the surface: with a margin for those near by, where it has one.
    ///
    /// `t tᵀ` differs from that of another unit vector by no more than both differ.
    fn across(&self, along: &Vec3) -> Option<Across> {
        let curvature = |margin: f64| {
            let mut all = self.forms.iter().map(|form| form.curvature_across(along, margin));
            all.try_fold(0.0, |most: f64, one| one.map(|one| most.max(one)))
        };
        let exact = curvature(0.0)?;
        let wide = exact * (1.0 + MARGIN);
        let serves = |turn: &f64| curvature(wide * turn).is_some_and(|curvature| curvature <= wide);
        let turn = TURNS.into_iter().find(serves);
        let (curvature, turn) = turn.map_or((exact, 0.0), |turn| (wide, turn));
        Some(Across { along: *along, curvature, turn })
    }

    /// The bound from a contact along the bottom's straight piece, wherever the tool end strays by no more than a distance.
    pub(super) fn trough(
        &self,
        pose: &Pose<'_>,
        contact: &Contact,
        grounds: &Grounds,
        extent: Extent,
        known: &mut Acrosses,
    ) -> Option<Trough> {
        let Tool { axis, profile, across, .. } = pose.tool;
        let gradient = &contact.gradient;
        let [c, s] = pose.facing(gradient);
        let radial = across[0] * c + across[1] * s;
        let [wider, higher] = match grounds.is_flank {
            true => [profile.top.radius - profile.upper.radius, profile.top.height - profile.upper.height],
            false => [profile.lower.radius, profile.lower.height],
        };
        let way = radial * wider + axis * higher;
        let along = (way - gradient * gradient.dot(&way)).try_normalize(0.0)?;
        let curvature = known.about(&along, || self.across(&along))?;
        let left = 1.0 - (extent.deepest + pose.stock()) * curvature;
        (left > 0.0).then(|| Trough { along, bend: curvature / left })
    }
}

impl Pose<'_> {
    /// The circles, or circles of balls, that hold the bottom of the tool and its corner, or what of the tool is held about a contact on its flank.
    pub(super) fn rims(&self, held: Option<Held>) -> impl Iterator<Item = Circle> + use<> {
        let profile = &self.tool.profile;
        let circle = |radius: f64, height: f64| Circle { radius, height, ball: 0.0 };
        let upper = circle(profile.upper.radius, profile.upper.height);
        // The arc of a barrel is held by its ends and the place where the tangents there meet.
        let corner = match profile.arc > 0.0 {
            true if profile.is_barrel() => {
                let beyond = profile.beyond_corner();
                [circle(beyond.radius, beyond.height), upper]
            }
            true => [Circle { ball: profile.arc, ..circle(profile.center.radius, profile.center.height) }; 2],
            false => [upper; 2],
        };
        let lower = circle(profile.lower.radius, profile.lower.height);
        let bottom = [circle(0.0, 0.0), lower, corner[0], corner[1]];
        let on_flank = |height: f64| circle(self.flank_radius(height), height);
        let low = held.map(|held| held.heights()[0]).filter(|low| *low > profile.upper.height);
        let bottom = if low.is_some() { [None; 4] } else { bottom.map(Some) };
        let flank =
            [low.map(on_flank), held.map(|held| on_flank(held.heights()[1].max(profile.upper.height)))];
        bottom.into_iter().chain(flank).flatten()
    }

    /// How far these parts of the tool are, as long as none is nearer than the level: the distance rises above its tangent at the
    /// contact by no more than it may bend.
    pub(super) fn extent(&self, contact: &Contact, grounds: &Grounds) -> Option<Extent> {
        let Contact { clearance, tool: point, gradient, .. } = contact;
        let aside = length(self.tool.across.map(|across| gradient.dot(&across)));
        let (along, beside, _) = self.tool.split(&(point - self.tip));
        let rising = gradient.dot(&(self.tip - point));
        let lift = gradient.dot(&self.tool.axis);
        let (mut highest, mut farthest) = (f64::NEG_INFINITY, 0.0_f64);
        for Circle { radius, height, ball } in self.rims(grounds.flank()) {
            highest = highest.max(rising + lift * height + radius * aside + ball);
            farthest = farthest.max(length([height - along, beside + radius]) + ball);
        }
        if grounds.held.cap.is_some() {
            farthest = farthest.min(self.farthest_from(&grounds.held, point));
        }
        let farthest = farthest + grounds.stray;
        // Beside an edge that stands out there is no bound, but the distance rises by no more than the way.
        let bend = grounds.steady.upward_bend(grounds.level.min(*clearance)).unwrap_or(f64::INFINITY);
        let by_bend = highest + grounds.stray + 0.5 * bend * farthest * farthest;
        let deepest = clearance + by_bend.min(farthest);
        deepest.is_finite().then_some(Extent { farthest, deepest: deepest.max(0.0) })
    }

    /// The place of the charts' surface at a contact, and how far from there the feet of these parts of the tool are at most, and those
    /// of all places on the ways to them.
    ///
    /// A foot moves by `(1 − d S)⁻¹` of the way of its point at most, at a distance d where the surface has the form S.
    fn feet(
        &self,
        contact: &Contact,
        grounds: &Grounds,
        Extent { farthest, deepest }: Extent,
    ) -> Option<(Vec3, f64)> {
        let stock = self.surface.stock(self.side);
        let ahead = 1.0 + (deepest + stock).max(0.0) * grounds.steady.bend(deepest);
        let level = grounds.level.min(contact.clearance);
        let behind = match -(level + stock) {
            depth if depth > 0.0 => 1.0 + depth * grounds.steady.upward_bend(level)?,
            _ => 1.0,
        };
        let reach = farthest * ahead.max(behind);
        reach.is_finite().then(|| (contact.surface - contact.gradient * stock, reach))
    }

    /// What the surface of the charts is farther away.
    fn stock(&self) -> f64 {
        self.surface.stock(self.side).max(0.0)
    }

    /// Whether the bottom of the tool and its corner, or what of the tool is held about a contact on its flank, keep a level, in this
    /// position, by a contact on an edge or inside a straight piece.
    ///
    /// The bound is a concave function of the place, so that between circles on a straight line it is least at one of them, and so it is
    /// between two positions of the tool.
    pub(super) fn lies_in(&self, trough: &Trough, contact: &Contact, held: Option<Held>, level: f64) -> bool {
        let profile = &self.tool.profile;
        let edge = |radius: f64, height: f64| self.trough_floor(contact, trough, [radius, height]) >= level;
        let flank = |held: Held| {
            let ends = held.heights().map(|height| height.max(profile.upper.height));
            ends.into_iter().all(|height| edge(self.flank_radius(height), height))
        };
        if !held.is_none_or(flank) {
            return false;
        }
        held.is_some_and(|held| held.heights()[0] > profile.upper.height)
            || edge(0.0, 0.0)
                && edge(profile.lower.radius, profile.lower.height)
                && (profile.arc <= 0.0 || self.arcs_keep(&edge))
    }

    /// Lower bound of the distance of an edge of the tool.
    ///
    /// With a number τ `(t·w)² ≥ 2τ (t·w) − τ²`; it is that of the point of the circle which faces the surface.
    fn trough_floor(&self, contact: &Contact, trough: &Trough, [radius, height]: [f64; 2]) -> f64 {
        let Contact { clearance, tool: point, gradient, .. } = contact;
        let Trough { along, bend } = trough;
        let w = self.tip + self.tool.axis * height - point;
        let [c, s] = self.facing(gradient);
        let nearest = w + (self.tool.across[0] * c + self.tool.across[1] * s) * radius;
        let way = along.dot(&nearest);
        let slope = gradient + along * (bend * way);
        let middle =
            clearance + slope.dot(&w) - 0.5 * bend * (w.norm_squared() + radius * radius + way * way);
        let turning = slope - w * *bend;
        middle - radius * length(self.tool.across.map(|across| turning.dot(&across)))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use apt_geometry::{cutter::Cutter, surface::Surface};

    use super::*;
    use crate::{
        clearance::{memory::Memory, near},
        tests::v,
        verify::tests::lofts,
    };

    /// The floors of the edges of the bottom by a trough, and how far they are below the least distance of places on them.
    fn margins(surface: &Surface, tool: &Tool, tip: &Vec3) -> Vec<f64> {
        let side = surface.foot(&v(0.0, 0.0, 9.0)).distance.signum();
        let pose = Pose { tool, surface, side, tip };
        let memory = Memory::default();
        near::contact(tool, surface, side, tip, &memory);
        let known = memory.near.borrow();
        let Some(known) = known.at(&pose, 0.0).and_then(|place| known.places.get(place)) else {
            return Vec::new();
        };
        let Some(contact) = known.touch(&pose).map(|touch| touch.contact) else { return Vec::new() };
        let (Ok(zone), Ok(bends)) = (&known.zone, &known.bends) else { return Vec::new() };
        let grounds = Grounds {
            steady: zone.steady,
            level: contact.clearance,
            stray: 0.0,
            held: zone.held,
            is_flank: false,
        };
        let Some(extent) = pose.extent(&contact, &grounds) else { return Vec::new() };
        let Some(trough) = bends.trough(&pose, &contact, &grounds, extent, &mut Acrosses::default()) else {
            return Vec::new();
        };
        if !bends.hold(&pose, &contact, &grounds, extent) {
            return Vec::new();
        }
        let profile = &tool.profile;
        let edges = [
            [0.0; 2],
            [profile.lower.radius, profile.lower.height],
            [profile.upper.radius, profile.upper.height],
        ];
        edges
            .map(|[radius, height]| {
                let places = (0..64).map(|k| {
                    let (sin, cos) = (TAU * f64::from(k) / 64.0).sin_cos();
                    let aside = tool.across[0] * cos + tool.across[1] * sin;
                    side * surface.signed_distance(&(tip + tool.axis * height + aside * radius))
                });
                let least = places.fold(f64::INFINITY, f64::min);
                least - pose.trough_floor(&contact, &trough, [radius, height])
            })
            .to_vec()
    }

    #[test]
    fn no_edge_is_nearer_than_its_floor_over_a_cylinder_and_the_bottoms_own_are_close() {
        let cutter = Cutter::from_numbers(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0], 1.0).expect("cutter");
        let (mut seen, mut close) = (0, 0);
        for geometry in [lofts::roof(), lofts::vault()] {
            let surface = Surface::from_geometry(&geometry).expect("surface");
            for axis in [Vec3::z(), v(0.05, -0.1, 1.0).normalize()] {
                let tool = Tool::new(cutter, axis);
                for k in 0..60 {
                    let mut tip = v(-0.9 + 0.03 * f64::from(k), 0.3, 4.0);
                    // Down to the surface by its own distance below the tool end.
                    for _ in 0..20 {
                        tip.z -= surface.signed_distance(&tip).abs() - 0.05;
                    }
                    let margins = margins(&surface, &tool, &tip);
                    seen += margins.len();
                    close += margins.iter().filter(|margin| **margin < 0.01).count();
                    for margin in margins {
                        assert!(margin > -1e-9, "{margin} at {tip}");
                    }
                }
            }
        }
        assert!(seen >= 60 && close >= 20, "{seen} edges, {close} close");
    }
}

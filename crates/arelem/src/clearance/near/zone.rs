//! What proves a contact: balls about the tool in which the distance is bounded by its tangent, and balls along the flank
//! that keep off the surface.

use apt_geometry::{Vec3, cutter::Profile, surface::Steady};

use super::{
    AHEAD, BALLS, BESIDE, Cap, Circle, DEEPER, FLANK_BALLS, Held, MAX_ARCS, MAX_COVER, POINT_BALLS, Pose,
    SHORTEST, Size, Touch, WIDEST_ARC, Zone,
};
use crate::clearance::{Contact, waves::length};

/// How far from the surface what is held about a contact is expected to be, in depths of it behind the contact.
const SUNK: f64 = 1.5;
/// Share of how far a contact was before what is held no more that another one is to be there.
const AMID: f64 = 0.75;
/// Angle (radians) between an arc and a straight piece below which they are tangent.
const TANGENT: f64 = 1e-9;

impl Pose<'_> {
    /// A steady ball about the tool at a contact.
    pub(super) fn zone(&self, found: &Touch, last: Option<&Zone>) -> Option<Zone> {
        let (scale, surface, side) = (self.scale(), self.surface, self.side);
        if found.start.piece.is_none() {
            let center = found.contact.surface + found.contact.gradient * found.contact.clearance.max(0.0);
            return POINT_BALLS.iter().find_map(|share| {
                let radius = share * scale;
                let depth = found.contact.clearance.max(0.0) + radius;
                let steady = surface.steady(side, &center, [radius, depth], self.tool.patience)?;
                let held = Held::POINT;
                Some(Zone { center, radius, depth, held, size: 0, steady, tip: *self.tip, deepest: 0.0 })
            });
        }
        // What was too large near by is so again, but perhaps for the one size next to that.
        let first = last.as_ref().map_or(0, |last| last.size.saturating_sub(1));
        let on_flank = self.on_flank(&found.contact).is_some();
        let sizes = if on_flank { FLANK_BALLS } else { BALLS };
        sizes.iter().enumerate().skip(first).find_map(|(size, Size { ease, beyond, depth })| {
            let held = self.held(&found.contact, beyond * scale, depth * scale);
            let (middle, half) = (self.middle(&held), self.half(&held));
            let away = (middle - found.contact.surface).norm();
            let (radius, depth) = match held.cap {
                Some(_) => (
                    half + ease * scale,
                    found.contact.clearance.max(0.0) + SUNK * depth * scale + 2.0 * ease * scale,
                ),
                None => (half.max(away) + ease * scale, DEEPER * (away + half)),
            };
            // Ahead on the way from the last one, as far as the tool and the contact remain in it.
            let way = last.as_ref().map_or(Vec3::zeros(), |last| self.middle(&last.held) - last.center);
            let ahead = way.try_normalize(0.0).map_or(Vec3::zeros(), |way| way * (AHEAD * ease * scale));
            let center = middle + ahead;
            let steady = surface.steady(side, &center, [radius, depth], self.tool.patience)?;
            let deepest = match held.cap {
                Some(cap) => self.deepest_in(&held, &cap, &found.contact, &steady)?,
                None => 0.0,
            };
            (deepest <= depth).then_some(Zone {
                center,
                radius,
                depth,
                held,
                size,
                steady,
                tip: *self.tip,
                deepest,
            })
        })
    }

    /// No place of a cap is farther from the surface, by how the distance falls and rises from a contact in a steady ball.
    fn deepest_in(&self, held: &Held, cap: &Cap, contact: &Contact, steady: &Steady) -> Option<f64> {
        let farthest = self.farthest_from(held, &contact.tool);
        let (clearance, sag) = (contact.clearance, 0.5 * farthest * farthest);
        let nearest = clearance - self.ahead(held, contact) - steady.bend(clearance) * sag;
        let behind = self.in_front_of(&cap.rest, &contact.tool);
        Some(clearance + behind + steady.upward_bend(nearest)? * sag)
    }

    /// A height of the flank, not below another one, above which balls that cover it keep off the surface by a level. That part is
    /// on the right side if it reaches down to what is.
    pub(super) fn off_above(&self, from: f64, level: f64) -> f64 {
        let mut high = self.tool.profile.top.height;
        let mut length = high - from;
        for _ in 0..MAX_COVER {
            let middle = self.tip + self.tool.axis * (high - 0.5 * length);
            if self.surface.keeps_off(&middle, self.tool.radius().hypot(0.5 * length) + level.max(0.0)) {
                high -= length;
                length = (2.0 * length).min(high - from);
                if high <= from || length <= 0.0 {
                    return from;
                }
            } else {
                length *= 0.5;
                if length < SHORTEST * self.scale() {
                    break;
                }
            }
        }
        high
    }

    /// Whether balls that cover the flank above a height keep off the surface by a level.
    pub(super) fn is_off(&self, from: f64, level: f64) -> bool {
        self.off_above(from, level) <= from
    }

    /// Whether what of the tool a zone holds, and the contact, are in its ball.
    pub(super) fn is_in(&self, zone: &Zone, found: &Touch) -> bool {
        let Contact { clearance, surface, tool, gradient } = found.contact;
        let base = tool + gradient * zone.held.ball(found.circle.ball);
        (zone.center - surface).norm() <= zone.radius
            && (zone.center - base).norm() <= zone.radius
            && match found.start.piece {
                None => clearance <= zone.depth,
                Some(_) => self.is_amid(zone, &found.contact) && self.stays_in(zone, &surface, 0.0),
            }
    }

    /// Whether a zone holds enough of the tool about a contact.
    fn is_amid(&self, zone: &Zone, contact: &Contact) -> bool {
        let Held { low, top, cap, .. } = zone.held;
        let left = BESIDE * FLANK_BALLS.get(zone.size).map_or(0.0, |size| size.beyond) * self.scale();
        cap.is_none_or(|cap| self.in_front_of(&cap.rest, &contact.tool) >= AMID * cap.rest.depth)
            && self.on_flank(contact).map_or(low <= 0.0, |height| {
                (low <= 0.0 || height - left >= low)
                    && (top >= self.tool.profile.top.height || height + left <= top)
            })
    }

    /// Whether what of the tool a zone holds is in its ball wherever it moves by no more than a distance, given some point of the
    /// surface.
    pub(super) fn stays_in(&self, zone: &Zone, surface: &Vec3, spread: f64) -> bool {
        let Held { low, above, radius, cap, .. } = zone.held;
        let (middle, half) = (self.middle(&zone.held), self.half(&zone.held));
        if let Some(cap) = &cap {
            let moved = (self.tip - zone.tip).norm() + self.turned(cap);
            return zone.deepest + moved + spread <= zone.depth
                && (middle - zone.center).norm() + half + spread <= zone.radius;
        }
        // No point is farther from the surface than from that point of it.
        if (middle - surface).norm() + half + spread > zone.depth {
            return false;
        }
        let axis = &self.tool.axis;
        let w = zone.center - self.tip;
        let along = w.dot(axis);
        let (wide, room) = ((w - axis * along).norm() + radius, zone.radius - spread);
        let inside = |height: f64| {
            let away = height - along;
            away * away + wide * wide <= room * room
        };
        room >= wide && inside(low) && inside(above)
    }

    /// Whether the bottom of the tool and its corner, if the zone holds them, keep a level, by a contact in this position or another one, on a ball or an
    /// edge: bounds that touch the distance at the contact are nowhere less on circles, and between circles on a straight line they
    /// are least at one of them.
    ///
    /// Over a straight way of the tool each of these bounds is a concave function, so that what holds at both its ends by the same
    /// contact holds all along it.
    pub(super) fn bottom_keeps(&self, contact: &Contact, ball: f64, zone: &Zone, level: f64) -> bool {
        if zone.held.heights()[0] > self.tool.profile.upper.height {
            return true;
        }
        let profile = &self.tool.profile;
        let edge = |radius: f64, height: f64| self.edge_floor(contact, zone, [radius, height]) >= level;
        let corner =
            Circle { radius: profile.center.radius, height: profile.center.height, ball: profile.arc };
        let corner = || {
            if profile.is_barrel() {
                return self.barrel_floor(contact, zone) >= level || self.arcs_keep(&edge);
            }
            self.corner_floor(contact, ball, zone, corner) >= level
                || corner_stands_out(profile) && self.arcs_keep(&edge)
        };
        (profile.arc <= 0.0 || corner())
            && edge(profile.lower.radius, profile.lower.height)
            && (profile.lower.height <= 0.0 || edge(0.0, 0.0))
    }

    /// The same of the flank between the heights of a zone.
    pub(super) fn flank_keeps(&self, contact: &Contact, zone: &Zone, level: f64) -> bool {
        let profile = &self.tool.profile;
        if profile.top.height <= profile.upper.height {
            return true;
        }
        let edge = |radius: f64, height: f64| self.edge_floor(contact, zone, [radius, height]) >= level;
        let ends = zone.held.heights().map(|height| height.max(profile.upper.height));
        ends.into_iter().all(|height| edge(self.flank_radius(height), height))
    }

    /// Lower bound of the distance of an edge by a contact.
    fn edge_floor(&self, contact: &Contact, zone: &Zone, [radius, height]: [f64; 2]) -> f64 {
        let base = (contact.tool, contact.clearance);
        contact.clearance + self.rise(base, &contact.gradient, zone, Circle { radius, height, ball: 0.0 })
    }

    /// The same of the balls of the corner, from the centre of that in contact if it is held.
    ///
    /// From a contact itself the bound of the distance at `W + a u`, with a centre at W and a unit vector u, is least against
    /// `n − bW`, which is `√(1 − 2bQ)` long if `Q = n·W − bW²/2` is the bound at W: it grows with Q, so that the least Q counts.
    fn corner_floor(&self, contact: &Contact, ball: f64, zone: &Zone, corner: Circle) -> f64 {
        let Contact { clearance, tool: point, gradient, .. } = contact;
        if zone.held.cap.is_none() {
            let base = (point + gradient * ball, clearance + ball);
            return base.1 + self.rise(base, gradient, zone, corner) - corner.ball;
        }
        let bend = zone.steady.bend(*clearance);
        let rise = self.rise((*point, *clearance), gradient, zone, corner);
        let slope = (1.0 - 2.0 * bend * rise).max(0.0).sqrt();
        clearance + rise - corner.ball * (slope + 0.5 * bend * corner.ball)
    }

    /// The same of the corner of a barrel, by the one ball at the azimuth of the contact, which holds all of it: as of a ball of a corner
    /// that is seen from the contact itself.
    fn barrel_floor(&self, contact: &Contact, zone: &Zone) -> f64 {
        let Contact { clearance, tool: point, gradient, .. } = contact;
        let (center, ball) = (self.tool.profile.center, self.tool.profile.arc);
        let [c, s] = self.facing(gradient);
        let aside = (self.tool.across[0] * c + self.tool.across[1] * s) * center.radius;
        let w = self.tip + self.tool.axis * center.height + aside - point;
        let bend = zone.steady.bend(*clearance);
        let rise = gradient.dot(&w) - 0.5 * bend * w.norm_squared();
        let slope = (1.0 - 2.0 * bend * rise).max(0.0).sqrt();
        clearance + rise - ball * (slope + 0.5 * bend * ball)
    }

    /// Whether the corner keeps what its circles keep, also where its whole balls stand out from the tool: stretches of its arc lie in the
    /// triangles of their ends and of the place where the tangents there meet, and what is nowhere less on circles is between
    /// them least at one of them.
    pub(super) fn arcs_keep(&self, edge: &dyn Fn(f64, f64) -> bool) -> bool {
        let profile = &self.tool.profile;
        let keeps = |polar: f64, away: f64| {
            let (sin, cos) = polar.sin_cos();
            edge(profile.center.radius + away * sin, profile.center.height - away * cos)
        };
        let mut open = vec![profile.fan];
        for _ in 0..MAX_ARCS {
            let Some([from, to]) = open.pop() else { return true };
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            if !keeps(from, profile.arc) || !keeps(to, profile.arc) {
                return false;
            }
            if half > WIDEST_ARC || !keeps(middle, profile.arc / half.cos()) {
                open.extend([[middle, to], [from, middle]]);
            }
        }
        open.is_empty()
    }

    /// Lower bound of how much farther the places of a circle are than a place on the normal of a contact with its distance.
    fn rise(&self, (place, distance): (Vec3, f64), normal: &Vec3, zone: &Zone, circle: Circle) -> f64 {
        let bend = zone.steady.bend(distance);
        let w = self.tip + self.tool.axis * circle.height - place;
        let middle = normal.dot(&w) - 0.5 * bend * (w.norm_squared() + circle.radius * circle.radius);
        let slope = normal - w * bend;
        let across = length(self.tool.across.map(|across| slope.dot(&across)));
        middle - circle.radius * across
    }
}

/// Whether balls of the corner stand out from the tool: its arc is not tangent to both straight pieces.
fn corner_stands_out(profile: &Profile) -> bool {
    let Profile { lower, upper, top, fan: [first, last], .. } = profile;
    // Angles of outward normals from straight down.
    let bottom = lower.height.atan2(lower.radius);
    let flank = (top.height - upper.height).atan2(top.radius - upper.radius);
    first - bottom > TANGENT || flank - last > TANGENT
}

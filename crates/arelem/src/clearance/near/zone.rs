//! What proves a contact: balls about the tool in which the distance is bounded by its tangent, and balls along the flank
//! that keep off the surface.

use apt_geometry::{Vec3, cutter::Profile};

use super::{
    AHEAD, BALLS, Circle, DEEPER, MAX_ARCS, MAX_COVER, POINT_BALLS, Pose, SHORTEST, Touch, WIDEST_ARC, Zone,
};
use crate::clearance::{Contact, Tool, waves::length};

/// Angle (radians) between an arc and a straight piece below which they are tangent.
const TANGENT: f64 = 1e-9;

impl Pose<'_> {
    /// A steady ball about the tool at a contact.
    pub(super) fn zone(&self, found: &Touch, last: Option<&Zone>) -> Option<Zone> {
        let Tool { axis, profile, .. } = self.tool;
        let (scale, surface, side) = (self.scale(), self.surface, self.side);
        if found.start.piece.is_none() {
            let center = found.contact.surface + found.contact.gradient * found.contact.clearance.max(0.0);
            return POINT_BALLS.iter().find_map(|share| {
                let radius = share * scale;
                let depth = found.contact.clearance.max(0.0) + radius;
                let steady = surface.steady(side, &center, [radius, depth])?;
                Some(Zone { center, radius, depth, top: 0.0, size: 0, steady })
            });
        }
        // What was too large near by is so again, but perhaps for the one size next to that.
        let first = last.as_ref().map_or(0, |last| last.size.saturating_sub(1));
        BALLS.iter().enumerate().skip(first).find_map(|(size, [ease, above])| {
            let top = profile.top.height.min(profile.upper.height + above * scale);
            let middle = self.tip + axis * (0.5 * top);
            let [width, height] = self.holder(top);
            let half = width.hypot(height - 0.5 * top);
            let away = (middle - found.contact.surface).norm();
            let (radius, depth) = (half.max(away) + ease * scale, DEEPER * (away + half));
            // Ahead on the way from the last one, as far as the tool and the contact remain in it.
            let way =
                last.as_ref().map_or(Vec3::zeros(), |last| self.tip + axis * (0.5 * last.top) - last.center);
            let ahead = way.try_normalize(0.0).map_or(Vec3::zeros(), |way| way * (AHEAD * ease * scale));
            let center = middle + ahead;
            let steady = surface.steady(side, &center, [radius, depth])?;
            Some(Zone { center, radius, depth, top, size, steady })
        })
    }

    /// Radius and height of a cylinder about the axis, from the tool end, that holds the tool up to a height on its flank, and the
    /// centres of its corner.
    fn holder(&self, top: f64) -> [f64; 2] {
        let Profile { lower, upper, center, arc, top: end, .. } = &self.tool.profile;
        let rise = (top - upper.height) / (end.height - upper.height);
        let flank = if rise > 0.0 { upper.radius + rise.min(1.0) * (end.radius - upper.radius) } else { 0.0 };
        let [beside, above] = if *arc > 0.0 { [center.radius + arc, center.height] } else { [0.0; 2] };
        let width = lower.radius.max(upper.radius).max(flank).max(beside).min(self.tool.radius());
        [width.max(center.radius), top.max(above)]
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

    /// A distance of all of the surface from the tool above a height on its flank, if it is known not to be below a given one.
    pub(super) fn apart_above(&self, from: f64, distance: f64) -> Option<f64> {
        let Tool { axis, profile, .. } = self.tool;
        let (upper, top) = (profile.upper, profile.top);
        let share = (from - upper.height) / (top.height - upper.height);
        let start = [upper.radius + share * (top.radius - upper.radius), from];
        let end = [top.radius, top.height];
        let sides = [[[0.0, from], start], [start, end], [end, [0.0, top.height]]];
        let away = |p: &Vec3| {
            let (along, across, radial) = self.tool.split(&(p - self.tip));
            let outside = sides.map(|side| beyond(side, [across, along]));
            let nearest = outside.into_iter().flatten().min_by(|a, b| length(*a).total_cmp(&length(*b)));
            let [wide, high] = nearest.unwrap_or([0.0; 2]);
            let distance = length([wide, high]);
            let outward =
                if distance > 0.0 { (radial * wide + axis * high) / distance } else { Vec3::zeros() };
            (distance, outward)
        };
        self.surface.keeps_apart(&away, distance)
    }

    /// Whether balls that cover the flank above a height keep off the surface by a level.
    pub(super) fn is_off(&self, from: f64, level: f64) -> bool {
        self.off_above(from, level) <= from
    }

    /// Whether the tool up to the top of a zone, and the contact, are in its ball.
    pub(super) fn is_in(&self, zone: &Zone, found: &Touch) -> bool {
        let Contact { clearance, surface, .. } = found.contact;
        (zone.center - surface).norm() <= zone.radius
            && match found.start.piece {
                None => (zone.center - self.tip).norm() <= zone.radius && clearance <= zone.depth,
                Some(_) => self.stays_in(zone, &surface, 0.0),
            }
    }

    /// Whether the tool up to the top of a zone is in its ball wherever it moves by no more than a distance, given some point
    /// of the surface.
    pub(super) fn stays_in(&self, zone: &Zone, surface: &Vec3, spread: f64) -> bool {
        let (along, across, _) = self.tool.split(&(zone.center - self.tip));
        let [width, height] = self.holder(zone.top);
        let wide = across + width;
        // No point is farther from the surface than from that point of it.
        let middle = self.tip + self.tool.axis * (0.5 * zone.top);
        let deepest = (middle - surface).norm() + width.hypot(height - 0.5 * zone.top);
        deepest + spread <= zone.depth
            && along.hypot(wide) + spread <= zone.radius
            && (along - height).hypot(wide) + spread <= zone.radius
    }

    /// Whether the bottom of the tool and its corner keep a level, by a contact in this position or another one, on a ball or an
    /// edge: bounds that touch the distance at the contact are nowhere less on circles, and between circles on a straight line they
    /// are least at one of them.
    ///
    /// Over a straight way of the tool each of these bounds is a concave function, so that what holds at both its ends by the same
    /// contact holds all along it.
    pub(super) fn bottom_keeps(&self, contact: &Contact, ball: f64, zone: &Zone, level: f64) -> bool {
        let profile = &self.tool.profile;
        let edge = |radius: f64, height: f64| self.edge_floor(contact, zone, [radius, height]) >= level;
        let corner =
            Circle { radius: profile.center.radius, height: profile.center.height, ball: profile.arc };
        let from_corner = (contact.tool + contact.gradient * ball, contact.clearance + ball);
        let corner = || {
            self.floor(from_corner, &contact.gradient, zone, corner) >= level
                || corner_stands_out(profile) && self.arcs_keep(&edge)
        };
        (profile.arc <= 0.0 || corner())
            && edge(profile.lower.radius, profile.lower.height)
            && (profile.lower.height <= 0.0 || edge(0.0, 0.0))
    }

    /// The same of the flank up to the top of a zone.
    pub(super) fn flank_keeps(&self, contact: &Contact, zone: &Zone, level: f64) -> bool {
        let profile = &self.tool.profile;
        if profile.top.height <= profile.upper.height {
            return true;
        }
        let edge = |radius: f64, height: f64| self.edge_floor(contact, zone, [radius, height]) >= level;
        let rise = (zone.top - profile.upper.height) / (profile.top.height - profile.upper.height);
        let radius = profile.upper.radius + rise * (profile.top.radius - profile.upper.radius);
        edge(profile.upper.radius, profile.upper.height) && edge(radius, zone.top)
    }

    /// Lower bound of the distance of an edge by a contact.
    fn edge_floor(&self, contact: &Contact, zone: &Zone, [radius, height]: [f64; 2]) -> f64 {
        let base = (contact.tool, contact.clearance);
        self.floor(base, &contact.gradient, zone, Circle { radius, height, ball: 0.0 })
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

    /// Lower bound of the distance of a circle of balls, from a place on the normal of a contact with its distance.
    fn floor(&self, (place, distance): (Vec3, f64), normal: &Vec3, zone: &Zone, circle: Circle) -> f64 {
        let bend = zone.steady.bend(distance);
        let w = self.tip + self.tool.axis * circle.height - place;
        let middle =
            distance + normal.dot(&w) - 0.5 * bend * (w.norm_squared() + circle.radius * circle.radius);
        let slope = normal - w * bend;
        let across = length(self.tool.across.map(|across| slope.dot(&across)));
        middle - circle.radius * across - circle.ball
    }
}

/// The way to a place (radius, height) from the nearest one of a side of a convex outline that is followed upwards, if the place is
/// beyond that side.
fn beyond([from, to]: [[f64; 2]; 2], place: [f64; 2]) -> Option<[f64; 2]> {
    let way = [to[0] - from[0], to[1] - from[1]];
    let w = [place[0] - from[0], place[1] - from[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    if way[1] * w[0] - way[0] * w[1] <= 0.0 {
        return None;
    }
    let share = if square > 0.0 { ((w[0] * way[0] + w[1] * way[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    Some([w[0] - share * way[0], w[1] - share * way[1]])
}

/// Whether balls of the corner stand out from the tool: its arc is not tangent to both straight pieces.
fn corner_stands_out(profile: &Profile) -> bool {
    let Profile { lower, upper, top, fan: [first, last], .. } = profile;
    // Angles of outward normals from straight down.
    let bottom = lower.height.atan2(lower.radius);
    let flank = (top.height - upper.height).atan2(top.radius - upper.radius);
    first - bottom > TANGENT || flank - last > TANGENT
}

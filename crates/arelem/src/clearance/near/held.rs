//! Which part of the tool a ball about a contact is to hold, and how far what is beyond keeps off the surface.

use std::{
    cell::{Cell, OnceCell},
    f64::consts::TAU,
};

use apt_geometry::{Vec3, cutter::Profile, surface::perpendicular};

use super::{Circle, End, Pose};
use crate::clearance::{
    Contact, Tool,
    crease::{Closeness, nearest_on_way},
    waves::length,
};

/// How many parts of a surface are looked at before it is looked whether one of its places comes near to an end of the tool, and where, as shares
/// of that end, places nearest to its axis are.
const FEW_LOOKS: u32 = 40;
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];
/// A bound of a distance that tells nothing.
const NOTHING: (f64, Vec3) = (f64::MIN, Vec3::new(0.0, 0.0, 0.0));
/// Share of the flank's height up to which a contact counts as one on its lower edge.
const NEAR_EDGE: f64 = 1e-6;

/// Heights of planes in front of which a part of the tool is held, as shares of how deep that is, from where all of it is shown to be
/// far behind: what is shown about one contact serves others near by.
const BEHIND: f64 = 0.54;
/// Multipliers of a plane's normal by which the extent of what lies in front of it is bounded: the best one for a ball of radius r to a
/// depth δ is about `√(r/2δ)`.
const MULTIPLIERS: [f64; 8] = [0.0, 0.5, 1.0, 1.5, 2.2, 3.2, 4.5, 6.5];
/// Share of a distance by which that from what a body goes through may be told too small.
const CLOSE: f64 = 0.02;
/// Directions all around in a plane in which an extent is bounded.
const AROUND: usize = 8;

/// A part of the tool, and a cylinder along the axis that holds it; from the tool end on also the centres of its corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    /// 0 if the bottom is held, or else a height of the flank. The cylinder begins there.
    pub(super) low: f64,
    pub(super) top: f64,
    pub(super) radius: f64,
    /// The height at which it ends.
    pub(super) above: f64,
    /// No place of it is farther from its middle between both heights.
    pub(super) half: f64,
    /// What alone of it is held, if not all.
    pub(super) cap: Option<Cap>,
}

/// What of a part of the tool lies in front of a plane that the tool takes along, and a ball that holds it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cap {
    pub(super) rest: Rest,
    /// Middle of the ball from the tool end.
    middle: Vec3,
    radius: f64,
    /// Heights between which it lies.
    heights: [f64; 2],
}

/// What of a part of the tool does not lie in front of such a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rest {
    /// The heights between which the part is: from the tool end on, or from a height of the flank.
    heights: [f64; 2],
    /// The axis of the tool for which the plane is told.
    axis: Vec3,
    /// Unit normal of the plane, to the front.
    front: Vec3,
    /// How far the plane is before the tool end.
    level: f64,
    /// How far contact was before the plane.
    pub(super) depth: f64,
}

impl Rest {
    /// The part of the tool behind a plane nearer to the contact.
    pub(super) fn wider(self) -> Self {
        Self { level: self.level + BEHIND * self.depth, ..self }
    }
}

impl Held {
    /// The tool end.
    pub(super) const POINT: Self = Self { low: 0.0, top: 0.0, radius: 0.0, above: 0.0, half: 0.0, cap: None };

    /// Radius of the ball of the corner whose centre is held with a contact on it.
    pub(super) fn ball(&self, ball: f64) -> f64 {
        if self.cap.is_some() { 0.0 } else { ball }
    }

    /// Heights between which what is held lies.
    pub(super) fn heights(&self) -> [f64; 2] {
        self.cap.map_or([self.low, self.top], |cap| cap.heights)
    }
}

#[cfg(test)]
thread_local! {
    /// Places whose distance from an end of a tool this thread has computed.
    pub(crate) static LOOKS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

impl Pose<'_> {
    /// The height of a contact on the flank above its lower edge.
    pub(super) fn on_flank(&self, contact: &Contact) -> Option<f64> {
        let Profile { upper, top, .. } = &self.tool.profile;
        let height = self.tool.axis.dot(&(contact.tool - self.tip));
        (height > upper.height + NEAR_EDGE * (top.height - upper.height)).then_some(height)
    }

    /// What of the tool a ball is to hold: up to so far above the corner, or so far to either side of a contact on the flank, with all
    /// that is below if that comes down to the corner; and of that what is no deeper behind the contact than so much.
    pub(super) fn held(&self, contact: &Contact, beyond: f64, depth: f64) -> Held {
        let Profile { upper, top, .. } = &self.tool.profile;
        let [low, high] = match self.on_flank(contact) {
            Some(height) => [height - beyond, height + beyond],
            None => [0.0, upper.height + beyond],
        };
        let low = if low > upper.height { low } else { 0.0 };
        let part = self.part([low, high.min(top.height)]);
        Held { cap: self.cap(&part, contact, depth), ..part }
    }

    /// Radius of the flank, or of its cone, at a height.
    pub(super) fn flank_radius(&self, height: f64) -> f64 {
        let Profile { upper, top, .. } = &self.tool.profile;
        let rise = (height - upper.height) / (top.height - upper.height);
        upper.radius + rise * (top.radius - upper.radius)
    }

    /// The part between two heights.
    fn part(&self, [low, top]: [f64; 2]) -> Held {
        let Profile { lower, upper, center, arc, top: end, .. } = &self.tool.profile;
        let radii = [low, top].map(|height| self.flank_radius(height));
        let (radius, above) = if low > 0.0 {
            (radii[0].max(radii[1]), top)
        } else {
            let flank = if end.height > upper.height { radii[1] } else { 0.0 };
            let has_balls = *arc > 0.0 && center.radius >= 0.0;
            let [beside, above] = if has_balls { [center.radius + arc, center.height] } else { [0.0; 2] };
            let width = lower.radius.max(upper.radius).max(flank).max(beside).min(self.tool.radius());
            (width.max(center.radius), top.max(above))
        };
        let middle = 0.5 * (low + top);
        let half = length([radius, (above - middle).max(middle - low)]);
        Held { low, top, radius, above, half, cap: None }
    }

    /// What of a part is no deeper behind a contact than so much, unless that is all of it.
    fn cap(&self, part: &Held, contact: &Contact, depth: f64) -> Option<Cap> {
        let (axis, front) = (self.tool.axis, -contact.gradient);
        let level = front.dot(&(contact.tool - self.tip)) - depth;
        if level <= -self.support(part, &-front) {
            return None;
        }
        let rest = Rest { heights: [part.low, part.top], axis, front, level, depth };
        let most = |way: &Vec3| {
            let bound =
                |multiplier: f64| self.support(part, &(way + front * multiplier)) - multiplier * level;
            MULTIPLIERS.into_iter().map(bound).fold(f64::INFINITY, f64::min)
        };
        let x = perpendicular(&front);
        let frame = [x, front.cross(&x)];
        let turn = |k: usize| {
            let (sin, cos) = (TAU * k as f64 / AROUND as f64).sin_cos();
            frame[0] * cos + frame[1] * sin
        };
        let extents: [f64; AROUND] = std::array::from_fn(|k| most(&turn(k)));
        let across = [0, AROUND / 4].map(|k| 0.5 * (extents[k] - extents[k + AROUND / 2]));
        let aside = frame[0] * across[0] + frame[1] * across[1];
        // Between two directions nothing is farther than where both extents end.
        let (sin, cos) = (TAU / AROUND as f64).sin_cos();
        let left: [f64; AROUND] = std::array::from_fn(|k| (extents[k] - aside.dot(&turn(k))).max(0.0));
        let corner = |k: usize| {
            let (a, b) = (left[k], left[(k + 1) % AROUND]);
            (a * a + b * b - 2.0 * a * b * cos).max(0.0).sqrt() / sin
        };
        let wide = (0..AROUND).map(corner).fold(0.0, f64::max);
        let nearest = self.support(part, &front);
        let middle = front * (0.5 * (level + nearest)) + aside;
        let radius = length([wide, 0.5 * (nearest - level)]);
        let heights = [(-most(&-axis)).max(part.low), most(&axis).min(part.top)];
        Some(Cap { rest, middle, radius, heights })
    }

    /// No place of a part is farther from the tool end along a vector, times its length.
    fn support(&self, part: &Held, way: &Vec3) -> f64 {
        let (along, across, _) = self.tool.split(way);
        let reach = |circle: Circle| {
            circle.radius * across + circle.height * along + circle.ball * length([along, across])
        };
        self.rims(Some(*part)).map(reach).fold(f64::NEG_INFINITY, f64::max)
    }

    /// How far a part reaches beyond the tangent plane of a contact.
    pub(super) fn ahead(&self, part: &Held, contact: &Contact) -> f64 {
        let front = -contact.gradient;
        let all = Held { cap: None, ..*part };
        (self.support(&all, &front) - front.dot(&(contact.tool - self.tip))).max(0.0)
    }

    /// A vector that the tool takes along when its axis turns.
    fn carried(&self, from: &Vec3, way: &Vec3) -> Vec3 {
        let to = &self.tool.axis;
        if from == to {
            return *way;
        }
        let (about, cosine) = (from.cross(to), from.dot(to));
        way * cosine + about.cross(way) + about * (about.dot(way) / (1.0 + cosine))
    }

    /// No place of the tool moves farther while its axis turns from where a cap is told to where it is.
    pub(super) fn turned(&self, cap: &Cap) -> f64 {
        let profile = &self.tool.profile;
        profile.top.height.hypot(self.tool.radius()) * (self.tool.axis - cap.rest.axis).norm()
    }

    /// How far a point is in front of the plane before which a part is held.
    pub(super) fn in_front_of(&self, rest: &Rest, point: &Vec3) -> f64 {
        self.carried(&rest.axis, &rest.front).dot(&(point - self.tip)) - rest.level
    }

    /// Whether all that is behind one plane is behind another one.
    pub(super) fn is_behind(&self, one: &Rest, other: &Rest) -> bool {
        let [from, to] = [other, one].map(|rest| self.carried(&rest.axis, &rest.front));
        let within = one.heights[0] >= other.heights[0] && one.heights[1] <= other.heights[1];
        let part = self.part(one.heights);
        let aside = (from - to).dot(&(self.middle(&part) - self.tip)) + (from - to).norm() * part.half;
        within && one.level + aside <= other.level
    }

    /// The middle of the cylinder or the ball that holds a part.
    pub(super) fn middle(&self, held: &Held) -> Vec3 {
        self.tip
            + match &held.cap {
                Some(cap) => self.carried(&cap.rest.axis, &cap.middle),
                None => self.tool.axis * (0.5 * (held.low + held.top)),
            }
    }

    /// No place that is held is farther from its middle.
    pub(super) fn half(&self, held: &Held) -> f64 {
        held.cap.map_or(held.half, |cap| cap.radius)
    }

    /// No place that is held is farther from a point.
    pub(super) fn farthest_from(&self, held: &Held, point: &Vec3) -> f64 {
        if let Some(cap) = &held.cap {
            return (self.middle(held) - point).norm() + cap.radius;
        }
        let (along, across, _) = self.tool.split(&(point - self.tip));
        length([across + held.radius, (held.above - along).max(along - held.low)])
    }

    /// A distance of all of the surface from an end of the tool, if it is known not to be below a given one.
    pub(super) fn apart_of(&self, end: End, distance: f64) -> Option<f64> {
        // What comes near cannot be told from what takes many looks but by the place that does: it is looked for once few have not
        // done, and nothing is told of any place from there on.
        let (looks, comes_near) = (Cell::new(0), OnceCell::new());
        let is_vain = || {
            looks.set(looks.get() + 1);
            looks.get() > FEW_LOOKS && *comes_near.get_or_init(|| self.comes_near(end, distance))
        };
        let away = |place: &Vec3| if is_vain() { NOTHING } else { self.away_from(end, &(place - self.tip)) };
        self.surface.keeps_apart(&away, [distance, distance + self.scale()], self.tool.patience)
    }

    /// Whether one of some places of the surface is nearer to an end of the tool than a distance: those nearest to places of its axis.
    fn comes_near(&self, end: End, distance: f64) -> bool {
        let [low, high] = match end {
            End::Above(from) => [from, self.tool.profile.top.height],
            End::Below(to) => [0.0, to],
            End::Behind(_) => return false,
        };
        PLACES.into_iter().any(|share| {
            let place = self.tip + self.tool.axis * (low + share * (high - low));
            let foot = self.surface.foot(&place).point;
            self.away_from(end, &(foot - self.tip)).0 < distance
        })
    }

    /// Whether all of the surface keeps a distance from an end of the tool while that moves straight to another place.
    pub(super) fn is_apart_on_way(&self, end: End, to: &Vec3, distance: f64) -> bool {
        let (body, way) = (|place: &Vec3| self.away_from(end, place), to - self.tip);
        let close = Closeness { length: CLOSE * distance.abs(), wanted: distance };
        let away = |place: &Vec3| nearest_on_way(&body, &(place - self.tip), &way, close);
        self.surface.keeps_apart(&away, [distance; 2], self.tool.patience).is_some()
    }

    /// No place of an end of the tool is nearer to one from the tool end than this, and the direction in which that grows. What is below a
    /// height of the flank lies in the cone of that.
    fn away_from(&self, end: End, place: &Vec3) -> (f64, Vec3) {
        #[cfg(test)]
        LOOKS.set(LOOKS.get() + 1);
        let Tool { axis, profile, .. } = self.tool;
        let (along, across, radial) = self.tool.split(place);
        let from_flank = |[low, high]: [f64; 2]| {
            let [start, end] = [low, high].map(|height| [self.flank_radius(height).max(0.0), height]);
            let sides = [[[0.0, low], start], [start, end], [end, [0.0, high]]];
            let outside = sides.map(|side| beyond(side, [across, along]));
            let nearest = outside.into_iter().flatten().min_by(|a, b| length(*a).total_cmp(&length(*b)));
            let [wide, high] = nearest.unwrap_or([0.0; 2]);
            let distance = length([wide, high]);
            let outward =
                if distance > 0.0 { (radial * wide + axis * high) / distance } else { Vec3::zeros() };
            (distance, outward)
        };
        match end {
            End::Above(from) => from_flank([from, profile.top.height]),
            End::Below(to) => from_flank([0.0, to]),
            End::Behind(rest) => {
                let (distance, outward) = if rest.heights[0] > 0.0 {
                    from_flank(rest.heights)
                } else {
                    let (distance, [wide, high]) = profile.outward(across, along);
                    (distance.max(0.0), radial * wide + axis * high)
                };
                // Nothing is nearer to what a part has behind a plane than to the part and to all that is behind the plane.
                let ahead = self.in_front_of(&rest, &(self.tip + place));
                let is_ahead = ahead > distance;
                if is_ahead { (ahead, self.carried(&rest.axis, &rest.front)) } else { (distance, outward) }
            }
        }
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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use apt_geometry::{cutter::Cutter, surface::Surface};

    use super::*;
    use crate::{tests::v, verify::tests::lofts};

    fn tool() -> Tool<'static> {
        let cutter = Cutter::from_numbers(&[0.5, 0.1, 0.1661, 0.1, 0.0, 10.0, 4.0], 1.0).expect("cutter");
        Tool::new(cutter, v(0.2, -0.3, 1.0).normalize())
    }

    fn contact(tool: Vec3, gradient: Vec3) -> Contact {
        Contact { clearance: 0.0, gradient, tool, surface: tool }
    }

    /// Places of the tool between two heights.
    fn places(pose: &Pose<'_>, [low, top]: [f64; 2]) -> Vec<Vec3> {
        let [x, y] = pose.tool.across;
        let profile = &pose.tool.profile;
        let radius = |height: f64| match height >= profile.upper.height {
            true => pose.flank_radius(height),
            false => {
                let down = profile.center.height - height;
                profile.center.radius + (profile.arc * profile.arc - down * down).max(0.0).sqrt()
            }
        };
        let low = low.max(profile.lower.height);
        let heights = (0..=40).map(|k| low + (top - low) * f64::from(k) / 40.0);
        heights
            .flat_map(|height| {
                (0..200).map(move |k| {
                    let (sin, cos) = (TAU * f64::from(k) / 200.0).sin_cos();
                    pose.tool.axis * height + (x * cos + y * sin) * radius(height)
                })
            })
            .collect()
    }

    /// What is held about a contact lies in the ball of its cap, and the rest is the body whose distance is measured.
    #[test]
    fn what_is_held_lies_in_its_ball_and_the_rest_in_the_ends() {
        let (tool, tip) = (tool(), v(0.3, 0.1, -0.2));
        let surface = Surface::from_geometry(&lofts::roof()).expect("surface");
        let pose = Pose { tool: &tool, surface: &surface, side: 1.0, tip: &tip };
        let radial = tool.across[0] * 0.6 + tool.across[1] * 0.8;
        let lower = (radial - tool.axis).normalize();
        let corner = &tool.profile.center;
        let on_corner = tip + radial * corner.radius + tool.axis * corner.height + lower * tool.profile.arc;
        for (touched, beyond) in [
            (contact(tip + tool.axis * 2.0 + radial * pose.flank_radius(2.0), -radial), 0.5),
            (contact(on_corner, -lower), 0.3),
        ] {
            let held = pose.held(&touched, beyond, 0.05);
            let cap = held.cap.expect("a cap");
            let (middle, [low, top]) = (pose.middle(&held), held.heights());
            assert!(cap.radius < held.half && pose.in_front_of(&cap.rest, &touched.tool) > 0.0499);
            let part = places(&pose, cap.rest.heights);
            let (front, rest): (Vec<Vec3>, Vec<Vec3>) =
                part.into_iter().partition(|place| pose.in_front_of(&cap.rest, &(tip + place)) > 0.0);
            assert!(front.len() > 20 && rest.len() > 20);
            for place in front {
                assert!((tip + place - middle).norm() <= cap.radius * (1.0 + 1e-12));
                let height = place.dot(&tool.axis);
                assert!(height >= low - 1e-12 && height <= top + 1e-12);
            }
            let away = |p: &Vec3| pose.away_from(End::Behind(cap.rest), p);
            assert!(rest.iter().all(|place| away(place).0 < 1e-9));
            // Farther than any of its places it says nothing is, and nowhere is the distance below its tangent.
            for k in 0..400 {
                let mut share = 0.37 * f64::from(k);
                let mut next = || {
                    share = (share * 7.13 + 0.29).fract();
                    2.0 * share - 1.0
                };
                let p = v(next(), next(), 2.0 + next()) * 1.5;
                let (distance, outward) = away(&p);
                let nearest = rest.iter().map(|place| (p - place).norm()).fold(f64::INFINITY, f64::min);
                assert!(distance <= nearest + 1e-12, "{distance} beyond {nearest}");
                if distance > 0.0 {
                    let q = p + v(next(), next(), next());
                    assert!(distance + outward.dot(&(q - p)) <= away(&q).0 + 1e-12);
                }
            }
        }
    }

    /// A cap and the plane behind it go along with a tool that turns.
    #[test]
    fn a_cap_is_taken_along_by_a_tool_that_turns() {
        let (tool, tip) = (tool(), v(0.3, 0.1, -0.2));
        let surface = Surface::from_geometry(&lofts::roof()).expect("surface");
        let pose = Pose { tool: &tool, surface: &surface, side: 1.0, tip: &tip };
        let radial = tool.across[0] * 0.6 + tool.across[1] * 0.8;
        let touched = contact(tip + tool.axis * 2.0 + radial * pose.flank_radius(2.0), -radial);
        let held = pose.held(&touched, 0.5, 0.05);
        let cap = held.cap.expect("a cap");
        let other = tool.turned(v(0.3, -0.2, 1.0).normalize());
        let turned = Pose { tool: &other, ..pose };
        for place in places(&turned, held.heights()) {
            if turned.in_front_of(&cap.rest, &(tip + place)) > 0.0 {
                assert!((tip + place - turned.middle(&held)).norm() <= cap.radius * (1.0 + 1e-9));
            }
        }
        let moved = (turned.middle(&held) - pose.middle(&held)).norm();
        assert!(moved > 0.0 && moved <= turned.turned(&cap));
    }

    #[test]
    fn all_below_a_height_lies_in_the_cone_of_the_flank() {
        let (tool, tip) = (tool(), v(0.0, 0.0, 2.9));
        let surface = Surface::from_geometry(&lofts::roof()).expect("surface");
        let pose = Pose { tool: &tool, surface: &surface, side: 1.0, tip: &tip };
        let least = |low: f64, top: f64| {
            places(&pose, [low, top])
                .iter()
                .map(|place| surface.signed_distance(&(tip + place)).abs())
                .fold(f64::INFINITY, f64::min)
        };
        for (end, least) in [(End::Above(1.0), least(1.0, 4.0)), (End::Below(1.0), least(0.2, 1.0))] {
            if let Some(apart) = pose.apart_of(end, 0.01) {
                assert!(apart <= least + 1e-12, "{apart} beyond {least}");
            }
        }
    }
}

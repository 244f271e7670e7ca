//! Which part of the tool a ball about a contact is to hold, and how far what is beyond keeps off the surface.

use apt_geometry::{Vec3, cutter::Profile};

use super::{BACK, End, FRONT, Pose};
use crate::clearance::{Contact, Tool, waves::length};

/// Share of the flank's height up to which a contact counts as one on its lower edge.
const NEAR_EDGE: f64 = 1e-6;

/// A part of the tool, and a cylinder along the axis that holds it; from the tool end on also the centres of its corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    /// 0 if the bottom is held, or else a height of the flank. The cylinder begins there.
    pub(super) low: f64,
    pub(super) top: f64,
    /// The unit direction to which the front of the flank looks that alone is held.
    pub(super) front: Option<Vec3>,
    /// How far the cylinder's axis is beside that of the tool.
    pub(super) aside: Vec3,
    pub(super) radius: f64,
    /// The height at which it ends.
    pub(super) above: f64,
    /// No place of it is farther from its middle between both heights.
    pub(super) half: f64,
}

impl Held {
    /// The tool end.
    pub(super) const POINT: Self = Self {
        low: 0.0,
        top: 0.0,
        front: None,
        aside: Vec3::new(0.0, 0.0, 0.0),
        radius: 0.0,
        above: 0.0,
        half: 0.0,
    };
}

impl Pose<'_> {
    /// The height of a contact on the flank above its lower edge.
    pub(super) fn on_flank(&self, contact: &Contact) -> Option<f64> {
        let Profile { upper, top, .. } = &self.tool.profile;
        let height = self.tool.axis.dot(&(contact.tool - self.tip));
        (height > upper.height + NEAR_EDGE * (top.height - upper.height)).then_some(height)
    }

    /// What of the tool a ball is to hold: up to so far above the corner, or so far to either side of a contact on the flank, with all
    /// that is below if that comes down to the corner.
    pub(super) fn held(&self, contact: &Contact, beyond: f64, in_front: bool) -> Held {
        let Profile { upper, top, .. } = &self.tool.profile;
        let [low, high] = match self.on_flank(contact) {
            Some(height) => [height - beyond, height + beyond],
            None => [0.0, upper.height + beyond],
        };
        let low = if low > upper.height { low } else { 0.0 };
        let [c, s] = self.facing(&contact.gradient);
        let front = (in_front && low > 0.0).then(|| self.tool.across[0] * c + self.tool.across[1] * s);
        self.part([low, high.min(top.height)], front)
    }

    /// Radius of the flank, or of its cone, at a height.
    pub(super) fn flank_radius(&self, height: f64) -> f64 {
        let Profile { upper, top, .. } = &self.tool.profile;
        let rise = (height - upper.height) / (top.height - upper.height);
        upper.radius + rise * (top.radius - upper.radius)
    }

    /// The part between two heights, all of it or what looks to a direction.
    ///
    /// The front of a circle lies within the circle about its chord; that of a lesser circle is off it by the difference of radii.
    fn part(&self, [low, top]: [f64; 2], front: Option<Vec3>) -> Held {
        let Profile { lower, upper, center, arc, top: end, .. } = &self.tool.profile;
        let radii = [low, top].map(|height| self.flank_radius(height));
        let (wide, narrow) = (radii[0].max(radii[1]), radii[0].min(radii[1]));
        let (radius, above) = if front.is_some() {
            (FRONT[1] * wide + (wide - narrow), top)
        } else if low > 0.0 {
            (wide, top)
        } else {
            let flank = if end.height > upper.height { radii[1] } else { 0.0 };
            let [beside, above] = if *arc > 0.0 { [center.radius + arc, center.height] } else { [0.0; 2] };
            let width = lower.radius.max(upper.radius).max(flank).max(beside).min(self.tool.radius());
            (width.max(center.radius), top.max(above))
        };
        let middle = 0.5 * (low + top);
        let half = length([radius, (above - middle).max(middle - low)]);
        let aside = front.map_or(Vec3::zeros(), |front| front * (FRONT[0] * wide));
        Held { low, top, front, aside, radius, above, half }
    }

    /// The middle of the cylinder that holds a part.
    pub(super) fn middle(&self, held: &Held) -> Vec3 {
        self.tip + held.aside + self.tool.axis * (0.5 * (held.low + held.top))
    }

    /// No place of that cylinder is farther from a point.
    pub(super) fn farthest_from(&self, held: &Held, point: &Vec3) -> f64 {
        let (along, across, _) = self.tool.split(&(point - self.tip - held.aside));
        length([across + held.radius, (held.above - along).max(along - held.low)])
    }

    /// A distance of all of the surface from an end of the tool, if it is known not to be below a given one. What is below a height
    /// of the flank lies in the cone of that.
    pub(super) fn apart_of(&self, end: End, distance: f64) -> Option<f64> {
        let Tool { axis, profile, .. } = self.tool;
        let [low, high] = match end {
            End::Above(from) => [from, profile.top.height],
            End::Below(to) => [0.0, to],
            End::Behind(heights, front) => {
                let radius = heights.map(|height| self.flank_radius(height)).into_iter().fold(0.0, f64::max);
                let away = |p: &Vec3| self.away_behind(&(p - self.tip), heights, &front, radius);
                return self.surface.keeps_apart(&away, distance);
            }
        };
        let [start, end] = [low, high].map(|height| [self.flank_radius(height).max(0.0), height]);
        let sides = [[[0.0, low], start], [start, end], [end, [0.0, high]]];
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

    /// Distance, and the way there, of a place, from the tool end, from what is behind in a cylinder between two heights.
    fn away_behind(&self, p: &Vec3, [low, top]: [f64; 2], front: &Vec3, radius: f64) -> (f64, Vec3) {
        let axis = &self.tool.axis;
        let (height, ahead) = (p.dot(axis), p.dot(front));
        let beside = axis.cross(front);
        let aside = p.dot(&beside);
        let [chord, half] = BACK.map(|share| share * radius);
        let size = length([ahead, aside]);
        let round = [ahead, aside].map(|x| x * (radius / size).min(1.0));
        // On the circle, or else on its chord.
        let [x, y] = if round[0] <= chord { round } else { [chord, aside.clamp(-half, half)] };
        let way = front * (ahead - x) + beside * (aside - y) + axis * (height - height.clamp(low, top));
        let distance = way.norm();
        (distance, if distance > 0.0 { way / distance } else { way })
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
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, TAU};

    use apt_geometry::{cutter::Cutter, surface::Surface};

    use super::*;
    use crate::{tests::v, verify::tests::lofts};

    fn tool() -> Tool {
        let cutter = Cutter::from_numbers(&[0.5, 0.1, 0.1661, 0.1, 0.0, 10.0, 4.0], 1.0).expect("cutter");
        Tool::new(cutter, v(0.2, -0.3, 1.0).normalize())
    }

    fn contact(tool: Vec3, gradient: Vec3) -> Contact {
        Contact { clearance: 0.0, gradient, tool, surface: tool }
    }

    /// Places of the flank between two heights, all around or beyond an angle from a direction.
    fn places(pose: &Pose<'_>, [low, top]: [f64; 2], front: &Vec3, angles: [f64; 2]) -> Vec<Vec3> {
        let axis = pose.tool.axis;
        let beside = axis.cross(front);
        let mut found = Vec::new();
        for k in 0..=200 {
            let angle = angles[0] + (angles[1] - angles[0]) * f64::from(k) / 200.0;
            for height in [low, 0.5 * (low + top), top] {
                let (sin, cos) = angle.sin_cos();
                found.push(axis * height + (front * cos + beside * sin) * pose.flank_radius(height));
            }
        }
        found
    }

    #[test]
    fn what_is_held_lies_in_its_cylinder_and_the_rest_in_the_ends() {
        let (tool, tip) = (tool(), v(0.3, 0.1, -0.2));
        let surface = Surface::from_geometry(&lofts::roof()).expect("surface");
        let pose = Pose { tool: &tool, surface: &surface, side: 1.0, tip: &tip };
        let gradient = tool.across[0] * -0.6 + tool.across[1] * -0.8;
        let touched = contact(tip + tool.axis * 2.0 - gradient * pose.flank_radius(2.0), gradient);
        let held = pose.held(&touched, 0.5, true);
        let front = held.front.expect("a front");
        assert!((front + gradient).norm() < 1e-12 && (held.low - 1.5).abs() < 1e-12);
        let heights = [held.low, held.top];
        for place in places(&pose, heights, &front, [-FRAC_PI_2 / 2.0, FRAC_PI_2 / 2.0]) {
            let from = pose.middle(&held);
            assert!((tip + place - from).norm() <= held.half * (1.0 + 1e-12));
            assert!((tip + place - tip).norm() <= pose.farthest_from(&held, &tip) * (1.0 + 1e-12));
        }
        // What is not in front is within the body whose distance is measured, and the distance never grows faster than the way.
        let radius = pose.flank_radius(held.top);
        let away = |p: &Vec3| pose.away_behind(p, heights, &front, radius);
        let inside = places(&pose, heights, &front, [FRAC_PI_6, TAU - FRAC_PI_6]);
        assert!(inside.iter().all(|place| away(place).0 < 1e-12));
        for k in 0..400 {
            let mut share = 0.37 * f64::from(k);
            let mut next = || {
                share = (share * 7.13 + 0.29).fract();
                2.0 * share - 1.0
            };
            let p = v(next(), next(), 2.0 + next()) * 1.5;
            let (distance, outward) = away(&p);
            let nearest = inside.iter().map(|place| (p - place).norm()).fold(f64::INFINITY, f64::min);
            assert!(distance <= nearest + 1e-12, "{distance} beyond {nearest}");
            if distance > 0.0 {
                // The tangent at p is nowhere above the distance.
                let q = p + v(next(), next(), next());
                assert!(distance + outward.dot(&(q - p)) <= away(&q).0 + 1e-12);
                assert!(away(&(p - outward * distance)).0 < 1e-9);
            }
        }
    }

    #[test]
    fn all_below_a_height_lies_in_the_cone_of_the_flank() {
        let (tool, tip) = (tool(), v(0.0, 0.0, 2.9));
        let surface = Surface::from_geometry(&lofts::roof()).expect("surface");
        let pose = Pose { tool: &tool, surface: &surface, side: 1.0, tip: &tip };
        let least = |low: f64, top: f64| {
            places(&pose, [low, top], &tool.across[0], [0.0, TAU])
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

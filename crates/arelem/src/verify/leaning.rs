//! Half-spaces that lean: what shows a part of a surface to be no nearer to a tool than a contact on it, by second derivatives.
//!
//! A place is at least as far from a tool as it is above any plane that has the tool on its other side. One plane for all
//! places, that of the contact, does where the surface bends away. Where it is hollow, each place has a plane of its own,
//! which leans towards it the more the farther it is from the contact: by `Md` where the place is `d` from the contact. The place
//! of the tool that such a plane touches moves with it, on an edge or an arc of the meridian, and costs as much as the tool
//! bends there.

use apt_geometry::Vec3;

use super::{
    patch::{Net, reached},
    tool::{Meridian, Tool, perpendicular},
    trough::{Rise, Way, meeting},
};

/// Share of the greatest lean of a plane, at which it would touch the tool elsewhere, that is used.
const SHARE_OF_LEAN: f64 = 0.5;
/// How much wider than the reach of a part, relative to it, the piece of the tool is that is looked at, for rounding.
const WIDER: f64 = 1e-9;

/// A circle of the tool about its axis, or a ring whose section is a circle about such a place of the meridian; if that is beyond the axis,
/// as for a barrel, the one ball about it at the azimuth of the contact, which holds all of the corner.
#[derive(Debug, Clone, Copy)]
struct Knot {
    at: Meridian,
    radius: f64,
}

/// How planes lean at places that are apart from the contact along the meridian and across it, per unit of length.
#[derive(Debug, Clone, Copy)]
struct Lean {
    along: f64,
    across: f64,
}

/// A tool at a part of a surface, about a place of the part.
struct Leaning<'a> {
    tool: &'a Tool<'a>,
    /// The place of the surface from the tool end, and the unit normal there away from the tool.
    from: Vec3,
    outward: Vec3,
    /// The direction from the axis that the normal leans to and its part along it, not negative.
    radial: Vec3,
    lean: f64,
    /// Unit, in the tangent plane: in the plane of the axis, and across that.
    along: Vec3,
    across: Vec3,
    /// How far the part goes both ways, and towards the tool.
    reach: [f64; 2],
    greatest_rise: f64,
    rise: Rise,
    ways: [Way; 2],
    least: f64,
}

fn dot(a: Meridian, b: Meridian) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Whether no place of a part, as far as it reaches from a place of its surface, is nearer than `least`, not negative, to a tool with
/// its end at `tip`. The normal there, unit, leads towards the tool, and the part rises over the tangent plane as is given.
pub(super) fn keeps_apart(
    tool: &Tool<'_>,
    tip: &Vec3,
    (net, rise): (&Net, Rise),
    (at, place, normal): ([f64; 2], &Vec3, &Vec3),
    least: f64,
) -> bool {
    let net = reached(net, at);
    let (from, outward) = (place - tip, -normal);
    let flat = outward - tool.axis * tool.axis.dot(&outward);
    let radial = flat.try_normalize(f64::EPSILON).unwrap_or_else(|| perpendicular(&tool.axis));
    let across = tool.axis.cross(&radial);
    let along = across.cross(&outward);
    let (mut reach, mut greatest_rise, mut far) = ([0.0f64; 2], 0.0f64, 0.0f64);
    for p in net.as_flattened().iter() {
        let d = p - place;
        reach = [reach[0].max(along.dot(&d).abs()), reach[1].max(across.dot(&d).abs())];
        greatest_rise = greatest_rise.max(normal.dot(&d));
        far = far.max(d.norm_squared());
    }
    let ways = [rise.way(&along), rise.way(&across)];
    let lean = flat.norm();
    let leaning =
        Leaning { tool, from, outward, radial, lean, along, across, reach, greatest_rise, rise, ways, least };
    // The tool's place nearest to one of the part is no farther from that nearest to the contact than the one is from the other.
    let (apart, nearest) = tool.signed_distance(&from);
    let far = (far.sqrt() + 2.0 * (-apart).max(0.0)) * (1.0 + WIDER);
    let knots = leaning.knots(&nearest, far);
    leaning.leans(&knots).into_iter().any(|lean| knots.iter().all(|knot| leaning.holds(knot, lean)))
}

impl Leaning<'_> {
    /// What of the tool may be nearest to a place of the part: no farther along from a place of the tool.
    fn knots(&self, near: &Vec3, far: f64) -> Vec<Knot> {
        let axis = &self.tool.axis;
        let height = axis.dot(near);
        let middle = [(near - axis * height).norm(), height];
        let way = [self.along.dot(&self.radial), self.along.dot(axis)];
        let beside = |p: Meridian| dot(way, [p[0] - middle[0], p[1] - middle[1]]);
        let mut found = Vec::with_capacity(8);
        let mut offer = |at: Meridian, radius: f64| found.push(Knot { at, radius });
        for (a, b) in self.tool.profile.closed_lines() {
            let (first, last) = (beside(a), beside(b));
            if first.min(last) > far || first.max(last) < -far {
                continue;
            }
            for (own, other, p, q) in [(first, last, a, b), (last, first, b, a)] {
                let share = ((own.clamp(-far, far) - own) / (other - own)).clamp(0.0, 1.0);
                let share = if share.is_finite() { share } else { 0.0 };
                offer([p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])], 0.0);
            }
        }
        if let Some((center, radius)) = self.tool.profile.corner()
            && beside(center).abs() - radius <= far
        {
            let [lower, upper, _] = self.tool.profile.edges();
            match meeting([lower, upper], center, radius) {
                Some(beyond) if !self.tool.profile.fan_holds([self.lean, axis.dot(&self.outward)]) => {
                    [lower, beyond, upper].into_iter().for_each(|p| offer(p, 0.0));
                }
                _ => offer(center, radius),
            }
        }
        found
    }

    /// From a knot to the contact.
    fn to_contact(&self, knot: &Knot) -> Vec3 {
        self.from - self.radial * knot.at[0] - self.tool.axis * knot.at[1]
    }

    /// How far the contact is above the plane along the surface that a knot stands under.
    fn above(&self, knot: &Knot) -> f64 {
        self.outward.dot(&self.to_contact(knot)) - knot.radius
    }

    /// The leans to be tried: none, across alone, and both ways, as little as bends a plane about what it touches.
    fn leans(&self, knots: &[Knot]) -> Vec<Lean> {
        let mut leans = vec![Lean { along: 0.0, across: 0.0 }];
        let touched = knots.iter().min_by(|a, b| self.above(a).total_cmp(&self.above(b)));
        let Some(touched) = touched else { return leans };
        let bend = |knot: &Knot, lean: f64| {
            let round = if knot.at[0] > 0.0 { knot.at[0] / lean } else { 0.0 };
            round + knot.radius + self.least
        };
        // Farther along than this, a plane would touch another place of the tool or one on its other side.
        let mut most = 1.0 / (touched.radius + self.least);
        let steep = self.along.dot(&self.radial).abs();
        most = most.min(SHARE_OF_LEAN * self.lean / (self.reach[0] * steep));
        for knot in knots {
            let apart = self.along.dot(&self.to_contact(knot)).abs();
            let room = (self.above(knot) - self.least).max(0.0);
            if (knot.at, knot.radius) != (touched.at, touched.radius) {
                most = most.min(SHARE_OF_LEAN * room / (apart * self.reach[0]));
            }
        }
        // Leaning so much bends a plane twice as much as the part.
        for along in [0.0, most.min(self.rise.greatest().max(0.0))] {
            let lean = self.lean - along * self.reach[0] * steep;
            let all = knots.iter().map(|knot| bend(knot, lean)).fold(0.0, f64::max);
            leans.extend([bend(touched, lean), all].map(|bend| Lean { along, across: 1.0 / bend }));
        }
        leans.retain(|lean| lean.along.is_finite() && lean.across.is_finite());
        leans
    }

    /// Whether planes that lean so, under which a knot of the tool stands, have all places of the part above them by `least`.
    fn holds(&self, knot: &Knot, Lean { along, across }: Lean) -> bool {
        let apart = self.to_contact(knot);
        let steep = self.along.dot(&self.radial).abs();
        let lean = self.lean - along * self.reach[0] * steep;
        let is_level = along == 0.0 && across == 0.0;
        if knot.at[0] > 0.0 && lean <= 0.0 && !is_level {
            return false;
        }
        let room = self.above(knot)
            - self.least
            - along * self.along.dot(&apart).abs() * self.reach[0]
            - across * self.across.dot(&apart).abs() * self.reach[1];
        let round = if knot.at[0] > 0.0 && !is_level { knot.at[0] / lean } else { 0.0 };
        let thick = knot.radius + self.least;
        let bends = [(2.0 - thick * along) * along, (2.0 - (round + thick) * across) * across];
        if room >= 0.0 && bends.iter().all(|bend| *bend >= 0.0) {
            let [first, last] = &self.ways;
            if self.rise.is_below(&[(first, bends[0]), (last, bends[1])]) {
                return true;
            }
        }
        let lost = |k: usize| 0.5 * (-bends[k]).max(0.0) * self.reach[k] * self.reach[k];
        room - self.greatest_rise - lost(0) - lost(1) >= 0.0
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{super::patch::jet, *};
    use crate::verify::{
        tests::{BARRELS, cutter},
        tool::Profile,
    };

    const TOOLS: [&[f64]; 9] = [
        &[0.5, 0.25],
        &[0.5, 0.0],
        &[0.5, 0.1],
        &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0],
        &[0.5, 0.0, 0.25, 0.0, 20.0, 0.0, 3.0],
        &[0.5, 0.0, 0.25, 0.0, 0.0, 10.0, 2.0],
        &BARRELS[0],
        &BARRELS[1],
        &BARRELS[3],
    ];

    /// A patch about the origin with bends along x and y, and its place, its derivatives and its normal there.
    fn patch(side: f64, bends: [f64; 3], bumps: &[f64]) -> Net {
        let [p, q, twist] = bends;
        std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                // Control points of the forms, by their blossoms.
                let [x, y] = [i, j].map(|k| side * (k as f64 / 3.0 - 0.5));
                let square = |k: usize| side * side * ([0.0, 0.0, 1.0, 3.0][k] / 3.0 - k as f64 / 3.0 + 0.25);
                let z = 0.5 * p * square(i) + 0.5 * q * square(j) + twist * x * y;
                let k = 3 * (4 * j + i);
                Vec3::new(x + bumps[k], y + bumps[k + 1], z + bumps[k + 2])
            })
        })
    }

    /// The tool end that has a place of the tool, of the meridian that is lowest in a direction, a distance above a place.
    fn above(tool: &Tool<'_>, place: &Vec3, normal: &Vec3, distance: f64) -> Vec3 {
        place + normal * distance - tool.support(&-normal).1
    }

    fn keeps(
        tool: &Tool<'_>,
        tip: &Vec3,
        net: &Net,
        (at, place, normal): ([f64; 2], &Vec3, &Vec3),
        least: f64,
    ) -> bool {
        let rise = Rise::of(net, at, normal);
        rise.is_some_and(|rise| keeps_apart(tool, tip, (net, rise), (at, place, normal), least))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn nothing_of_a_part_that_is_kept_apart_is_nearer(
            tool in 0usize..TOOLS.len(), side in 0.01..0.6f64,
            bends in prop::array::uniform3(-1.0..1.0f64), flat in 0.0..1.0f64,
            bumps in prop::collection::vec(-1e-4..1e-4f64, 48), [u, v] in [-0.2..1.2f64, -0.2..1.2f64],
            lean in prop::array::uniform2(-0.6..0.6f64), shift in prop::array::uniform3(-1.0..1.0f64),
            shifted in prop::sample::select(vec![0.0, 0.0, 1e-3, 0.1]),
            distance in prop::sample::select(vec![0.0, 1e-3, 0.2]),
        ) {
            let profile = Profile::of(&cutter(TOOLS[tool])).unwrap();
            let tool = Tool::new(&profile, Vec3::new(lean[0], lean[1], 1.0).normalize());
            let net = patch(side, bends.map(|bend| bend * flat), &bumps);
            let [place, along, across] = jet(&net, [u, v]);
            let normal = along.cross(&across).normalize();
            let tip = above(&tool, &place, &normal, distance) + Vec3::from(shift) * shifted;
            let least = (distance - 1e-9).max(0.0);
            if !keeps(&tool, &tip, &net, ([u, v], &place, &normal), least) {
                return Ok(());
            }
            let inside = [u, v].iter().all(|x| (0.0..=1.0).contains(x));
            let [low, high] = if inside { [0.0, 1.0] } else { [-0.25, 1.25] };
            for (i, j) in (0..=40).flat_map(|i| (0..=40).map(move |j| (i, j))) {
                let at = [i, j].map(|k| low + (high - low) * f64::from(k) / 40.0);
                let apart = tool.distance(&(jet(&net, at)[0] - tip));
                prop_assert!(apart >= least - 1e-12, "{apart} {least} at {at:?}");
            }
        }
    }

    /// Whether a part so wide below a tool that touches it in its middle is kept apart.
    fn is_kept(tool: &[f64], axis: [f64; 3], side: f64, bends: [f64; 3]) -> bool {
        let profile = Profile::of(&cutter(tool)).unwrap();
        let tool = Tool::new(&profile, Vec3::from(axis).normalize());
        let net = patch(side, bends, &[0.0; 48]);
        let [place, along, across] = jet(&net, [0.5; 2]);
        let normal = along.cross(&across).normalize();
        let tip = above(&tool, &place, &normal, 1e-3);
        keeps(&tool, &tip, &net, ([0.5; 2], &place, &normal), 1e-3 - 1e-9)
    }

    #[test]
    fn tools_over_hollow_places_are_kept_apart() {
        // A flat bottom at an angle over what is hollow both ways, the less so the way the rim goes.
        assert!(is_kept(&[0.5, 0.0], [0.1, 0.0, 1.0], 0.02, [0.6, 0.3, 0.0]));
        assert!(is_kept(&[0.5, 0.0], [0.02, 0.0, 1.0], 0.01, [0.3, 0.05, 0.0]));
        // The same over a saddle whose lines are askew.
        assert!(is_kept(&[0.5, 0.0], [0.1, 0.0, 1.0], 0.02, [0.3, -0.5, 0.2]));
        // Inside a flat bottom, and along a slanted one and a flank.
        assert!(is_kept(&[0.5, 0.0], [0.0, 0.0, 1.0], 0.5, [-0.3, -0.1, 0.1]));
        let slanted = [0.5, 0.0, 0.25, 0.0, 20.0, 0.0, 3.0];
        let lean = 20.0f64.to_radians();
        assert!(is_kept(&slanted, [lean.sin(), 0.0, lean.cos()], 0.1, [-0.2, 0.5, 0.0]));
        assert!(is_kept(&[0.5, 0.25], [1.0, 0.0, 0.1], 0.1, [-0.2, 0.5, 0.0]));
    }

    #[test]
    fn tools_that_bend_less_than_what_is_below_them_are_not_kept_apart() {
        // The rim goes along with a curvature of the sine of the lean over the radius, .398, across.
        assert!(!is_kept(&[0.5, 0.0], [0.1, 0.0, 1.0], 0.02, [0.3, 0.45, 0.0]));
        assert!(!is_kept(&[0.5, 0.0], [0.0, 0.0, 1.0], 0.01, [-0.3, 0.01, 0.0]));
        assert!(!is_kept(&[0.5, 0.25], [0.0, 0.0, 1.0], 0.01, [4.1, 0.0, 0.0]));
    }
}

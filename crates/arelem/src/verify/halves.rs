//! A tool beside one of the two convex bodies that a quadric may be: both nappes of a cone, both sheets of a hyperboloid or of a
//! hyperbolic cylinder.
//!
//! A plane that has a body behind it bounds the clearance from that body, and the bound is linear in the place of the tool. Where
//! such planes show that a tool touches one body at both ends of a move and is all along it farther from the other than it is at
//! the ends from the first, its clearance is that from a convex body, which rises between the ends to neither more than they have
//! nor to more than the other body leaves.

use apt_geometry::Vec3;

use super::{
    clearance::Reading,
    quadric::{Pair, PrincipalQuadric},
    quadric_clearance::is_over_top,
    tool::Tool,
};

/// What the plane at a contact may miss of the clearance, relative to the tool: as little as its normal is known. It counts as an
/// error of the clearance.
const MISSED: f64 = 1e-9;

/// Shares of the one of two normals with which planes between the tool and a body are tried.
const SHARES: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.0];
/// From the best of them on, a plane is turned by so much, radians, in each of so many directions, as long as one of them is better,
/// and by less where none is.
const TURN: f64 = 0.2;
const LEAST_TURN: f64 = 1e-5;
const WAYS: u32 = 6;
/// Bound of the planes that are tried.
const MOST_PLANES: u32 = 400;

/// Where the tool is at an end of a move, and the reading there, stock left out.
pub(super) type End<'a> = (&'a Vec3, &'a Reading);

/// Where the clearance of a tool is on a straight move that from one of two convex bodies, of which none reaches into its top: what the
/// planes at both ends miss of it.
pub(super) fn beside_one(
    quadric: &PrincipalQuadric,
    side: f64,
    [from, to]: [End<'_>; 2],
    tool: &Tool<'_>,
) -> Option<f64> {
    let pair = quadric.pair(side)?;
    let beside = Beside { quadric, pair, tool };
    let bodies = [from, to].map(|(_, reading)| pair.body_with(&quadric.turned_in(&reading.normal)));
    let missed = [from, to].map(|(tip, reading)| {
        reading.value - reading.error - beside.above(&quadric.turned_in(&reading.normal), [tip, tip])
    });
    let missed = missed[0].max(missed[1]).max(0.0);
    let most = from.1.value.max(to.1.value);
    let is_beside = bodies[0] == bodies[1]
        && missed <= MISSED * tool.profile.reach()
        && beside.is_clear_of(-bodies[0], [from.0, to.0], most)
        && !beside.may_reach_into_top(bodies[0], [from.0, to.0]);
    is_beside.then_some(missed)
}

struct Beside<'a> {
    quadric: &'a PrincipalQuadric,
    pair: Pair,
    tool: &'a Tool<'a>,
}

impl Beside<'_> {
    /// Least distance of the tool at both ends of a move from the plane with about this normal that has a body behind it; as far in
    /// as one likes where there is none.
    fn above(&self, normal: &Vec3, ends: [&Vec3; 2]) -> f64 {
        let Some((normal, behind)) = self.pair.plane(normal) else { return f64::NEG_INFINITY };
        let normal = self.quadric.turned_out(&normal);
        let (support, _) = self.tool.support(&-normal);
        let above = ends.map(|tip| normal.dot(tip) - support - behind);
        above[0].min(above[1])
    }

    /// Whether the tool keeps a distance from a body on a move: by the plane across the way from the tip of the body to the tool, by
    /// the one between both bodies, by some in between, or by one that is found from these.
    fn is_clear_of(&self, body: f64, ends: [&Vec3; 2], distance: f64) -> bool {
        let tip = self.quadric.turned_out(&self.pair.tip(body));
        let middle = 0.5 * (ends[0] + ends[1]);
        let away = tip - middle;
        let (_, nearest) = self.tool.signed_distance(&away);
        let way = self.quadric.turned_in(&(nearest - away)).try_normalize(0.0);
        let (across, between) = (way.unwrap_or_else(Vec3::zeros), self.pair.outward(body));
        let spare = |normal: &Vec3| {
            let above = self.above(normal, ends) - distance;
            if self.pair.body_with(normal) == body { above } else { f64::NEG_INFINITY }
        };
        let mut best = (f64::NEG_INFINITY, between);
        for share in SHARES {
            let normal = across * share + between * (1.0 - share);
            let found = spare(&normal);
            if found > best.0 {
                best = (found, normal);
            }
        }
        let (mut turn, mut tried) = (TURN, 0);
        while best.0 < 0.0 && turn >= LEAST_TURN && tried < MOST_PLANES {
            let Some(normal) = best.1.try_normalize(0.0) else { return false };
            let aside = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
            let other = normal.cross(&aside);
            let about = |k: u32| {
                let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / f64::from(WAYS)).sin_cos();
                normal + (aside * cosine + other * sine) * turn
            };
            tried += WAYS;
            let found = (0..WAYS).map(|k| (spare(&about(k)), about(k))).max_by(|a, b| a.0.total_cmp(&b.0));
            match found {
                Some(found) if found.0 > best.0 => best = found,
                _ => turn *= 0.5,
            }
        }
        best.0 >= 0.0
    }

    /// Whether the lowest place of a body along the tool axis comes over the disc at the top: nothing touches that disc.
    fn may_reach_into_top(&self, body: f64, ends: [&Vec3; 2]) -> bool {
        let down = self.quadric.turned_in(&-self.tool.axis);
        let lowest = self.pair.farthest(body, &down, &self.quadric.turned_in(ends[0]));
        lowest.is_some_and(|lowest| is_over_top(&self.quadric.turned_out(&lowest), ends, self.tool))
    }
}

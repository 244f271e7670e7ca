//! Clearance beside two convex bodies: both nappes of a cone, both sheets of a hyperboloid or of a hyperbolic cylinder.
//!
//! Where the bodies come near to each other a tool may touch both at places that are as near to each other as one likes, and the distance has
//! a ridge between them that no step in azimuth is short enough for. The clearance is the lesser of those from each body for itself. Each is
//! a convex function of the place, so that the tangent plane at the contact proves it.

use apt_geometry::Vec3;

use super::{Search, Shape, is_over_top};
use crate::verify::{
    clearance::Reading,
    quadric::{Pair, PrincipalQuadric},
    tool::Tool,
};

/// One of two bodies, by the sign of its outward normals along the axis of the pair.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    pair: Pair,
    sign: f64,
}

impl Body {
    /// Distance of a point from the body, negative within, and its gradient.
    pub(super) fn distance(&self, quadric: &PrincipalQuadric, side: f64, x: &Vec3) -> Option<(f64, Vec3)> {
        let found = quadric.distance_from_body((&self.pair, self.sign), side, x)?;
        Some((found.distance, found.normal))
    }

    /// A plane near a unit normal, in principal axes, that has it behind: the normal and the level. None where all of that normal's planes
    /// cut it.
    pub(super) fn plane(&self, normal: &Vec3) -> Option<(Vec3, f64)> {
        (self.pair.body_with(normal) == self.sign).then(|| self.pair.plane(normal))?
    }

    /// Whether it may reach into the top of a tool, where nothing touches.
    fn may_reach_into_top(&self, quadric: &PrincipalQuadric, tip: &Vec3, tool: &Tool<'_>) -> bool {
        let down = quadric.turned_in(&-tool.axis);
        let lowest = self.pair.farthest(self.sign, &down, &quadric.turned_in(tip));
        lowest.is_some_and(|lowest| is_over_top(&quadric.turned_out(&lowest), [tip, tip], tool))
    }
}

/// The clearance of a tool that two bodies leave.
pub(super) fn at(
    quadric: &PrincipalQuadric,
    pair: Pair,
    side: f64,
    tip: &Vec3,
    tool: &Tool<'_>,
) -> Option<Reading> {
    let beside = |sign: f64| {
        let body = Body { pair, sign };
        let open_top = body.may_reach_into_top(quadric, tip, tool);
        let mut search = Search {
            shape: Shape::Convex,
            open_top,
            body: Some(body),
            ..Search::of(quadric, side, tip, tool)
        };
        search.run()?;
        search.best.map(|best| Reading::new(best.value, best.normal, search.gap))
    };
    let [one, other] = [beside(1.0)?, beside(-1.0)?];
    let least = (one.value - one.error).min(other.value - other.error);
    let nearer = if one.value <= other.value { one } else { other };
    Some(Reading { error: nearer.value - least, ..nearer })
}

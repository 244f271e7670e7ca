//! Signed distances of points from a surface, and whether they are beyond where it ends.

use apt_geometry::{Vec3, patience::Patience};

use super::{Ruled, SURE_DISTANCE, resolution};
use crate::verify::{
    clearance::Reading,
    tool::{Profile, Tool},
};

/// Cosine between the direction to the nearest place and the surface's normal there below which that is where the surface ends.
const PAST_END: f64 = 0.5;

/// Signed distance of a point along the natural normal; None beyond the end of a curve.
pub(in crate::verify) fn point(surface: &Ruled, x: &Vec3, patience: Patience<'_>) -> Option<Reading> {
    Some(seen_from(surface, x, patience)?.0)
}

/// The same, and whether the point is beyond the end of the surface, where the sign says nothing.
pub(super) fn seen_from(surface: &Ruled, x: &Vec3, patience: Patience<'_>) -> Option<(Reading, bool)> {
    let profile = Profile::tool_end();
    let axis = surface.axis().unwrap_or_else(Vec3::z);
    let tool = Tool { profile: &profile, axis, patience, depth: 0.0 };
    if let Some(found) = surface.followed(1.0, x, &tool) {
        return Some((found, false));
    }
    from_nearest(surface, x, &tool)
}

/// The same by the nearest place, for the tool end.
fn from_nearest(surface: &Ruled, x: &Vec3, tool: &Tool<'_>) -> Option<(Reading, bool)> {
    let touch = surface.nearest(x, tool, resolution(surface, x, 0.0), f64::INFINITY)?;
    let natural = surface.natural(&touch)?;
    let error = surface.error_near(x, tool, touch.value + touch.gap);
    let height = natural.dot(&(x - touch.point));
    let away = x - touch.point;
    // At a joint the point is in the fan of its normals. A place that is as near as the nearest, to within the gap, may be beside it by
    // as much as says nothing of directions; far away it says more than a normal that is taken as much beside.
    let size = away.norm();
    let beside = away.norm_squared() - height * height;
    let is_in_fan = size > SURE_DISTANCE * surface.size() || beside > touch.gap * (2.0 * size + touch.gap);
    if size > 1e-6 * (1.0 + surface.size()) && height.abs() < size * (1.0 - 1e-9) && is_in_fan {
        let side = surface.facing(&touch)?.dot(&away);
        let normal = away * (side.signum() / size);
        // Of patches that go on behind the ends of a sculptured surface it is not known where they end; about an edge the directions
        // of both sides are not as far from that of a place.
        let is_past = matches!(surface, Ruled::Sculptured(_)) && height.abs() < PAST_END * size;
        let is_beyond = is_past || surface.ends_at(&touch);
        return Some((Reading::new(size.copysign(side), normal, error), is_beyond));
    }
    Some((Reading::new(height, natural, error), false))
}

/// The signed distance of a point without regard to what was found before.
#[cfg(test)]
pub(in crate::verify) fn searched_point(surface: &Ruled, x: &Vec3) -> Option<Reading> {
    let profile = Profile::tool_end();
    Some(from_nearest(surface, x, &Tool::new(&profile, Vec3::z()))?.0)
}

//! Whether a convex solid reaches into the top of the tool. Nothing touches the disc there (arelem reference 1.3): where it
//! would be nearest of the tool as a closed body, the tool without it is not convex, and its clearance not either.

use apt_geometry::{Vec3, surface::Surface};

use super::{Contact, Tool};

/// Rounding of the direction in which a solid has no end, as a sine.
const NEARLY_LEVEL: f64 = 1e-9;

/// Share of the tool's height by which a place is above its top, or below, by rounding.
const AT_TOP: f64 = 1e-9;

/// Whether a place, from the tool end, is above the top of a tool. Over the disc there it is farther from the tool than from the tool
/// with the disc, and how far is no convex function of the place.
pub(super) fn is_above_top(tool: &Tool, from_tip: &Vec3) -> bool {
    let top = tool.profile.top;
    top.height > 0.0 && top.radius > 0.0 && tool.axis.dot(from_tip) > top.height * (1.0 + AT_TOP)
}

/// How far places over the disc at the top of a tool, from the tool end and within a distance of a way, are at most from the tool without the disc: from
/// the edge of the top, of which none is farther inward than the middle of the way is; zero if there are none. `None` for a tool that is a disc
/// alone and may be entered from above.
pub(super) fn at_most_over_top(tool: &Tool, ends: [&Vec3; 2], beside: f64) -> Option<f64> {
    let (top, lower) = (tool.profile.top, tool.profile.lower);
    let [from, to] = ends.map(|end| tool.split(end));
    let above = from.0.max(to.0) + beside - top.height.max(lower.height);
    if above <= 0.0 || tool.radius() <= 0.0 {
        return Some(0.0);
    }
    if top.height <= 0.0 {
        return None;
    }
    let [start, end] = [from, to].map(|(_, across, radial)| radial * across);
    let way = end - start;
    let share = if way == Vec3::zeros() { 0.0 } else { -start.dot(&way) / way.norm_squared() };
    let nearest = (start + way * share.clamp(0.0, 1.0)).norm();
    let inward = top.radius - nearest + beside;
    Some(if inward > 0.0 { above.hypot(inward) } else { 0.0 })
}

/// Whether a tool with its end at a place touches with the edge of its top what is above it.
pub(super) fn touches_from_below(tool: &Tool, tip: &Vec3, contact: &Contact) -> bool {
    let top = tool.profile.top;
    let is_at_top = tool.axis.dot(&(contact.tool - tip)) >= top.height * (1.0 - AT_TOP);
    top.height > 0.0 && top.radius > 0.0 && is_at_top && tool.axis.dot(&contact.gradient) < -NEARLY_LEVEL
}

/// Whether on the straight way of the tool end between two places the lowest point of a convex quadric, along the tool's
/// axis, may come over the disc at the top, and not as low as the middle of the tool. The other solids are measured with the
/// disc, in closed form.
pub(super) fn is_entered(tool: &Tool, surface: &Surface, side: f64, [from, to]: [&Vec3; 2]) -> bool {
    let top = tool.profile.top;
    if !(matches!(surface, Surface::Quadric(_)) && top.height > 0.0 && top.radius > 0.0) {
        return false;
    }
    let Some(lowest) = lowest(surface, side, &tool.axis, from) else { return false };
    let (height, across, _) = tool.split(&(lowest - from));
    let (climb, aside, _) = tool.split(&(to - from));
    across <= top.radius + aside && height - climb.min(0.0) >= 0.5 * top.height
}

/// The lowest point along a direction of the convex solid on the other side of a quadric; where it has many, one beside the
/// given place. `None` if there is none.
fn lowest(surface: &Surface, side: f64, up: &Vec3, beside: &Vec3) -> Option<Vec3> {
    let form = surface.principal_quadric()?;
    let (down, beside) = (-form.direction_to_principal(up), form.to_principal(beside));
    let origin = form.stationary(&Vec3::zeros(), 0.0);
    let (square, linear, constant) = (form.squares() * side, origin.gradient * side, origin.value * side);
    // The outward gradient, square · y + linear, is a multiple of the direction.
    let steepest = (0..3).filter(|i| square[*i] == 0.0).fold(None, |most: Option<usize>, i| match most {
        Some(j) if linear[j].abs() >= linear[i].abs() => most,
        _ => Some(i),
    });
    let open = steepest.filter(|i| linear[*i] != 0.0);
    let multiple = match open {
        Some(i) => linear[i] / down[i],
        None => {
            let round = (0..3).filter(|i| square[*i] != 0.0);
            let sums = round.fold([-constant, 0.0], |[level, spread], i| {
                [level + linear[i] * linear[i] / square[i], spread + down[i] * down[i] / square[i]]
            });
            (sums[0] / sums[1]).sqrt()
        }
    };
    let is_level =
        |i: usize| (multiple * down[i] - linear[i]).abs() <= NEARLY_LEVEL * (linear[i].abs() + multiple);
    if !(multiple > 0.0 && multiple.is_finite() && (0..3).all(|i| square[i] != 0.0 || is_level(i))) {
        return None;
    }
    let mut y = beside;
    for i in (0..3).filter(|i| square[*i] != 0.0) {
        y[i] = (multiple * down[i] - linear[i]) / square[i];
    }
    if let Some(i) = open {
        let left = form.stationary(&y, 0.0).value * side;
        y[i] -= left / (2.0 * linear[i]);
    }
    Some(form.from_principal(&y))
}

#[cfg(test)]
mod tests {
    use apt_geometry::{
        canonical::{Geometry, Quadric},
        cutter::Cutter,
    };

    use super::*;

    fn quadric(coefficients: [f64; 10]) -> Surface {
        Surface::from_geometry(&Geometry::Quadric(Quadric { coefficients })).expect("a surface")
    }

    #[test]
    fn a_solid_enters_the_top_where_its_lowest_point_is_over_the_disc() {
        let tool = Tool::new(Cutter::from_numbers(&[1.0, 0.25], 1.0).expect("a cutter"), Vec3::z());
        let height = tool.profile.top.height;
        // An ellipsoid of the semiaxes 3, 2 and 1 about (0.1, 0, 0), and a bowl z ≥ x² + y².
        let ellipsoid =
            quadric([1.0 / 9.0, 0.25, 1.0, 0.01 / 9.0 - 1.0, 0.0, 0.0, 0.0, -0.1 / 9.0, 0.0, 0.0]);
        let bowl = quadric([1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.5]);
        let is = |surface: &Surface, from: [f64; 3], to: [f64; 3]| {
            is_entered(&tool, surface, 1.0, [&Vec3::from(from), &Vec3::from(to)])
        };
        for (surface, lowest) in [(&ellipsoid, -1.0), (&bowl, 0.0)] {
            let below = lowest - height;
            assert!(is(surface, [0.0, 0.0, below], [0.0, 0.0, below]));
            assert!(is(surface, [0.9, 0.0, below], [0.2, 0.0, below]), "it comes over the disc on the way");
            assert!(!is(surface, [0.9, 0.0, below], [0.9, 0.1, below]), "beside the disc");
            assert!(!is(surface, [0.1, 0.0, 1.0], [0.0, 0.0, 1.0]), "the tool is above");
        }
    }
}

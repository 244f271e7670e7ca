//! Troughs: cylinders that hold a tool which touches a bent surface with a straight piece of its meridian.
//!
//! No ball touches such a tool there and holds it, but a cylinder along the straight piece does; and where the surface bends
//! away along that direction, none of it is inside the cylinder, though across it the surface may be hollow.

use apt_geometry::Vec3;
use nalgebra::{Matrix2, Vector2};

use super::{
    circle_contact::{least_of, multiplier_of_circle_until},
    patch::{Net, differences, reached, turned},
    tool::{Meridian, Tool, perpendicular},
};

/// Least value of a form, relative to its greatest, that is positive for certain.
const POSITIVE: f64 = 1e-9;

/// How a patch rises over its tangent plane at a place, relative to how far it goes across directions.
///
/// From the place to another, a and b away in the parameters, it goes by `aU + bV` with U and V among the convex hulls of the
/// differences of its control points, and rises by half of `a²·n·Uu + 2ab·n·Uv + b²·n·Vv` with those of the second ones.
pub(super) struct Rise {
    /// The greatest form of the second differences along the normal, the parameters measured by the lengths they stand for.
    pub(super) greatest: Matrix2<f64>,
    /// The greatest of those with both parameters the same, and by how much the mixed one may be more or less.
    own: [f64; 2],
    twist: f64,
    /// The differences both ways, and those lengths.
    differences: [[[Vec3; 3]; 4]; 2],
    lengths: [f64; 2],
}

/// What way across a direction there is in both parameters, and how far that may be from everywhere the same.
pub(super) struct Way {
    across: Vector2<f64>,
    off: [f64; 2],
    spread: f64,
}

/// The middle of an interval that holds some numbers, and half of its length.
fn interval(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let (low, high) = numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    [0.5 * (low + high), 0.5 * (high - low)]
}

impl Rise {
    /// Over the tangent plane at a place with its unit normal. None where the parameters do not spread.
    pub(super) fn of(net: &Net, at: [f64; 2], normal: &Vec3) -> Option<Self> {
        let net = reached(net, at);
        let (along_all, across_all) = (differences(&net), differences(&turned(&net)));
        let length = |all: &[[Vec3; 3]; 4]| (all.iter().flatten().sum::<Vec3>() / 12.0).norm();
        let (u, v) = (length(&along_all), length(&across_all));
        // The differences count thirds of the first derivatives, and so ninths of the mixed and two thirds of the others.
        let bend = |all: &[[Vec3; 3]; 4], size: f64| {
            let second = all.iter().flat_map(|d| [d[1] - d[0], d[2] - d[1]]);
            interval(second.map(|d| normal.dot(&d))).map(|x| x * (2.0 / 3.0) / (size * size))
        };
        let ([uu, more_u], [vv, more_v]) = (bend(&along_all, u), bend(&across_all, v));
        let twists =
            along_all.windows(2).flat_map(|rows| (0..3).map(move |i| normal.dot(&(rows[1][i] - rows[0][i]))));
        let [uv, more] = interval(twists).map(|x| x / (u * v));
        // 2ab·x is not more than (a² + b²)·|x|.
        let greatest = Matrix2::new(uu + more_u + more, uv, uv, vv + more_v + more);
        let is_finite = greatest.iter().all(|x| x.is_finite());
        let (own, twist) = ([uu + more_u, vv + more_v], more);
        is_finite.then_some(Self {
            greatest,
            own,
            twist,
            differences: [along_all, across_all],
            lengths: [u, v],
        })
    }

    /// The way across a unit direction in the tangent plane.
    pub(super) fn way(&self, across: &Vec3) -> Way {
        let [(way_u, off_u), (way_v, off_v)] = [0, 1].map(|k| {
            let all = self.differences[k].iter().flatten().map(|d| across.dot(d));
            let [way, off] = interval(all).map(|x| x / self.lengths[k]);
            (way, off)
        });
        Way { across: Vector2::new(way_u, way_v), off: [off_u, off_v], spread: off_u.hypot(off_v) }
    }

    /// The greatest curvature with which it rises along its parameters.
    pub(super) fn greatest(&self) -> f64 {
        self.greatest.symmetric_eigenvalues().max()
    }

    /// The way in the parameters, about as long as one in space, in which it rises most, if it does.
    pub(super) fn hollow_way(&self) -> Option<[f64; 2]> {
        let form = self.greatest.symmetric_eigen();
        let greatest = form.eigenvalues.imax();
        let way = form.eigenvectors.column(greatest);
        // The differences count thirds of the derivatives.
        let [u, v] = self.lengths.map(|length| 3.0 * length);
        (form.eigenvalues[greatest] > 0.0).then(|| [way[0] / u, way[1] / v])
    }

    /// Whether it rises nowhere by more than half of the sum of curvatures, not negative, times the squares of the ways across:
    /// whether it stays below a surface of such curvatures that touches it at the place.
    pub(super) fn is_below(&self, curvatures: &[(&Way, f64)]) -> bool {
        let mut rest = self.greatest;
        for (way, curvature) in curvatures {
            rest -= way.least() * *curvature;
        }
        rest.trace() <= 0.0 && rest.determinant() >= 0.0
    }

    /// How far it rises at most, anywhere on the patch seen from the place at these parameters, beyond half of a curvature times the
    /// square of the way across. A twisted surface rises beyond a cylinder along any direction, by the square of how far it goes along
    /// that.
    pub(super) fn beyond(&self, (way, curvature): (&Way, f64), at: [f64; 2]) -> f64 {
        // The differences count thirds of the derivatives.
        let reach = [0, 1].map(|k| 3.0 * self.lengths[k] * at[k].abs().max((1.0 - at[k]).abs()));
        let own =
            [0, 1].map(|k| self.own[k] - curvature * (way.across[k].abs() - way.off[k]).max(0.0).powi(2));
        let ends = |k: usize| [way.across[k] - way.off[k], way.across[k] + way.off[k]];
        let products = ends(0).into_iter().flat_map(|x| ends(1).map(|y| x * y));
        let mixed = products.map(|product| (self.greatest.m12 - curvature * product).abs());
        let mixed = mixed.fold(0.0, f64::max) + self.twist;
        let anywhere: f64 = (0..2).map(|k| own[k].max(0.0) * reach[k] * reach[k]).sum();
        // Where it falls with the one parameter it is highest where that is level.
        let level = |k: usize| {
            let other = own[1 - k];
            let rises = if other < 0.0 { own[k] - mixed * mixed / other } else { f64::INFINITY };
            rises.max(0.0) * reach[k] * reach[k]
        };
        let found = (anywhere + 2.0 * mixed * reach[0] * reach[1]).min(level(0)).min(level(1));
        0.5 * found
    }
}

impl Way {
    /// A form that the square of the way across is not less than.
    fn least(&self) -> Matrix2<f64> {
        // (x·T)² with a T that is off by δ is not less than (1 − ε)(x·T)² − (1/ε − 1)δ²·|x|².
        let size = self.across.norm();
        let share = self.spread / size;
        if share.is_nan() || share >= 1.0 {
            return Matrix2::zeros();
        }
        let lost = (1.0 - share) * self.spread * size;
        self.across * self.across.transpose() * (1.0 - share) - Matrix2::identity() * lost
    }
}

/// The direction of the straight piece of the meridian that is nearest to a place of the tool (from its end), where it faces
/// against a normal. None where the tool has no straight piece, or all of it that faces so is level.
pub(super) fn straight_direction(tool: &Tool<'_>, place: &Vec3, normal: &Vec3) -> Option<Vec3> {
    let facing = (tool.axis * tool.axis.dot(normal) - normal).try_normalize(0.0)?;
    let at = [facing.dot(place), tool.axis.dot(place)];
    let (a, b) = nearest_piece(tool, at)?;
    let way = facing * (b[0] - a[0]) + tool.axis * (b[1] - a[1]);
    (way - normal * normal.dot(&way)).try_normalize(0.0)
}

/// The straight piece of the meridian that is nearest to a place of its plane, by its ends. None where the tool has none.
pub(super) fn nearest_piece(tool: &Tool<'_>, at: Meridian) -> Option<(Meridian, Meridian)> {
    let from = |(a, b): &(Meridian, Meridian)| {
        let way = [b[0] - a[0], b[1] - a[1]];
        let square = way[0] * way[0] + way[1] * way[1];
        let share = (((at[0] - a[0]) * way[0] + (at[1] - a[1]) * way[1]) / square).clamp(0.0, 1.0);
        (at[0] - a[0] - share * way[0]).hypot(at[1] - a[1] - share * way[1])
    };
    let pieces = tool.profile.lines().into_iter().filter(|(a, b)| a != b);
    pieces.min_by(|x, y| from(x).total_cmp(&from(y)))
}

/// Whether it is shown that no place of a tool is farther from the line through a place (from the tool end) in a unit direction than a
/// limit.
pub(super) fn is_within_of_line(tool: &Tool<'_>, center: &Vec3, along: &Vec3, limit: f64) -> bool {
    let across = |w: Vec3| w - along * along.dot(&w);
    let first = perpendicular(&tool.axis);
    let frame = [first, tool.axis.cross(&first)];
    let lean = Vector2::new(frame[0].dot(along), frame[1].dot(along));
    // The square of the distance on a circle, turned about: a form in the plane of the circle.
    let form = lean * lean.transpose() - Matrix2::identity();
    let is_within = |[rho, height]: Meridian, limit: f64| {
        let middle = across(tool.axis * height - center);
        let room = limit * limit - middle.norm_squared();
        if limit < 0.0 || rho <= 0.0 {
            return limit >= 0.0 && room >= 0.0;
        }
        let pull = -Vector2::new(frame[0].dot(&middle), frame[1].dot(&middle));
        stands_out_by_at_most(&form, &pull, rho, room)
    };
    let [lower, upper, top] = tool.profile.edges();
    let both_ends = || is_within(lower, limit) && is_within(upper, limit);
    // One ball of a barrel's corner holds all of it: the one whose centre is nearest to the line.
    let is_within_ball = |[rho, height]: Meridian, limit: f64| {
        let middle = across(tool.axis * height - center);
        let towards = -(middle - tool.axis * tool.axis.dot(&middle));
        let aside = towards.try_normalize(0.0).unwrap_or(first) * rho.abs();
        limit >= 0.0 && (middle + across(aside)).norm() <= limit
    };
    let corner = || match tool.profile.corner() {
        // The balls of the corner hold its arc, and so do its ends with where its tangents there meet.
        Some((center, radius)) => {
            let limit_of_centers = limit - radius;
            let balls = match center[0] < 0.0 {
                true => is_within_ball(center, limit_of_centers),
                false => is_within(center, limit_of_centers),
            };
            balls
                || both_ends() && meeting([lower, upper], center, radius).is_some_and(|p| is_within(p, limit))
        }
        None => both_ends(),
    };
    corner() && is_within([0.0; 2], limit) && is_within(top, limit)
}

/// Whether it is shown that `−(wᵀHw + 2g·w)` is at most a limit on a circle about the origin; the least of the two values of H is −1.
fn stands_out_by_at_most(form: &Matrix2<f64>, g: &Vector2<f64>, radius: f64, limit: f64) -> bool {
    // Every multiplier for which the form is positive gives a bound, and the place that it belongs to, drawn out or in to the circle,
    // a value.
    let bound = |mu: f64| mu * radius * radius - least_of(form, mu, g);
    let mut verdict = None;
    let best = multiplier_of_circle_until(form, g, radius, |mu, place| {
        if bound(mu) <= limit {
            verdict = Some(true);
        } else {
            let w = place * (-radius / place.norm());
            verdict = (-(form * w + g * 2.0).dot(&w) > limit).then_some(false);
        }
        verdict.is_some()
    });
    verdict.unwrap_or_else(|| bound(best).min(bound(best.max(1.0 + POSITIVE))) <= limit)
}

/// A place that makes with the ends of an arc a triangle beyond the arc: where its tangents there meet, or a little beyond where
/// rounded numbers let an end stand off the circle.
pub(super) fn meeting(ends: [Meridian; 2], center: Meridian, radius: f64) -> Option<Meridian> {
    let [first, last] = ends.map(|p| Vector2::new(p[0] - center[0], p[1] - center[1]));
    let beyond = first.norm().max(last.norm()).max(radius);
    let (first, last) = (first.try_normalize(0.0)?, last.try_normalize(0.0)?);
    let place = (first + last) * (beyond / (1.0 + first.dot(&last)));
    place.iter().all(|x| x.is_finite()).then(|| [center[0] + place.x, center[1] + place.y])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{super::patch::jet, *};
    use crate::verify::{
        tests::{BARRELS, clearances::samples, cutter},
        tool::Profile,
    };

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        /// A patch that bends away along about x and is hollow across it.
        #[test]
        fn no_place_of_a_patch_is_in_a_cylinder_that_it_is_below(
            bumps in proptest::collection::vec(-1e-3..1e-3f64, 48), bends in (-1.0..0.0f64, -0.5..0.5f64),
            places in proptest::collection::vec([-0.2..1.2f64, -0.2..1.2f64], 16), turn in -0.5..0.5f64,
            [u, v] in [-0.2..1.2f64, -0.2..1.2f64], curvature in 0.0..3.0f64,
        ) {
            let net: Net = std::array::from_fn(|j| std::array::from_fn(|i| {
                let k = 3 * (4 * j + i);
                let [x, y] = [i, j].map(|k| k as f64 / 3.0);
                let z = bends.0 * x * x + bends.1 * y * y;
                Vec3::new(x + bumps[k], 0.8 * y + bumps[k + 1], z + bumps[k + 2])
            }));
            let [touch, along, across] = jet(&net, [u, v]);
            let normal = along.cross(&across).normalize();
            let straight = (along + across * turn).normalize();
            let side = normal.cross(&straight);
            let Some(rise) = Rise::of(&net, [u, v], &normal) else { return Ok(()) };
            prop_assume!(rise.is_below(&[(&rise.way(&side), curvature)]));
            let is_inside = [u, v].iter().all(|x| (0.0..=1.0).contains(x));
            for at in places {
                let at = if is_inside { at.map(|x| x.clamp(0.0, 1.0)) } else { at };
                let apart = jet(&net, at)[0] - touch;
                let room = 0.5 * curvature * side.dot(&apart).powi(2);
                prop_assert!(normal.dot(&apart) <= room + 1e-12, "{} {room}", normal.dot(&apart));
            }
        }

        /// A twisted patch, seen from a direction that need not be square to it.
        #[test]
        fn no_place_of_a_patch_rises_farther_over_a_cylinder_than_it_does_at_most(
            bumps in proptest::collection::vec(-1e-3..1e-3f64, 48), twist in -0.5..0.5f64,
            bends in (-1.0..1.0f64, -0.2..0.2f64), tilt in prop::array::uniform2(-0.1..0.1f64),
            places in proptest::collection::vec([0.0..1.0f64, 0.0..1.0f64], 32), turn in -0.5..0.5f64,
            [u, v] in [0.0..1.0f64, 0.0..1.0f64], curvature in 0.0..3.0f64,
        ) {
            let net: Net = std::array::from_fn(|j| std::array::from_fn(|i| {
                let k = 3 * (4 * j + i);
                let [x, y] = [i, j].map(|k| k as f64 / 3.0);
                let z = bends.0 * x * x + bends.1 * y * y + twist * x * y;
                Vec3::new(x + bumps[k], 0.8 * y + bumps[k + 1], z + bumps[k + 2])
            }));
            let [touch, by_u, by_v] = jet(&net, [u, v]);
            let normal = (by_u.cross(&by_v).normalize() + Vec3::new(tilt[0], tilt[1], 0.0)).normalize();
            let along = by_v + by_u * turn;
            let side = normal.cross(&(along - normal * normal.dot(&along))).normalize();
            let Some(rise) = Rise::of(&net, [u, v], &normal) else { return Ok(()) };
            let most = rise.beyond((&rise.way(&side), curvature), [u, v]);
            for at in places {
                let apart = jet(&net, at)[0] - touch;
                let level = normal.dot(&by_u) * (at[0] - u) + normal.dot(&by_v) * (at[1] - v);
                let room = level + 0.5 * curvature * side.dot(&apart).powi(2);
                prop_assert!(normal.dot(&apart) <= room + most + 1e-12, "{} {room} {most}", normal.dot(&apart));
            }
        }

        #[test]
        fn no_place_of_a_tool_is_farther_from_a_line_than_it_is_within_and_one_is_as_far(
            tool in 0usize..6, center in prop::array::uniform3(-6.0..6.0f64), along in prop::array::uniform3(-1.0..1.0f64),
            lean in prop::array::uniform2(-0.5..0.5f64), share in 0.0..1.0f64,
        ) {
            prop_assume!(Vec3::from(along).norm() > 0.1);
            let (found, is_within) = from_line(tool, center, along, lean);
            prop_assert!(!is_within(found * (1.0 - 1e-9)), "{found}");
            prop_assert!(!is_within(found * share), "{found} {share}");
            // Beside the line a whole ball of the corner may stand out of the tool.
            prop_assert!(is_within(found + 0.12), "{found}");
            prop_assert!(is_within(found + 0.12 + 8.0 * share), "{found} {share}");
        }
    }

    /// Greatest distance of sampled places of a tool from a line, and whether it is within a distance of that.
    fn from_line(
        tool: usize,
        center: [f64; 3],
        along: [f64; 3],
        lean: [f64; 2],
    ) -> (f64, impl Fn(f64) -> bool) {
        let (center, along) = (Vec3::from(center), Vec3::from(along).normalize());
        let tools: [&[f64]; 6] = [
            &[0.5, 0.25],
            &[0.5, 0.0],
            &[0.5, 0.1],
            &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0],
            &BARRELS[0],
            &BARRELS[1],
        ];
        let cutter = cutter(tools[tool]);
        let profile = Profile::of(&cutter).unwrap();
        let axis = Vec3::new(lean[0], lean[1], 1.0).normalize();
        let apart = |x: &Vec3| (x - center).cross(&along).norm();
        let found = samples(&cutter, Vec3::zeros(), axis).iter().map(apart).fold(0.0, f64::max);
        (found, move |limit| is_within_of_line(&Tool::new(&profile, axis), &center, &along, limit))
    }

    #[test]
    fn a_circle_whose_best_multiplier_leaves_nothing_has_a_bound() {
        let center = [0.7428797089516813, -2.104753444745214, 3.866597629602039];
        let along = [0.6924128563884951, -0.6987785676831421, 0.28328497887246323];
        let (found, is_within) = from_line(0, center, along, [-0.38750552498363805, -0.043242945435448835]);
        assert!(is_within(found + 0.12) && !is_within(found * (1.0 - 1e-9)), "{found}");
    }
}

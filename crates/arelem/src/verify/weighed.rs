//! A bound of a patch's distance by several half-spaces that hold the tool, weighed together.
//!
//! A place stands no deeper under the tool's boundary than under any of its tangent planes, and so than under any mean of them. Beside
//! an edge of the tool, and in its middle, a place is as near to one face as to another, and each of them alone rises or falls
//! along the patch; the mean of them that does neither bounds the patch as closely as one face does elsewhere.

use apt_geometry::Vec3;

use super::{patch::Net, tool::Tool};

/// Heights of the control points of a patch over a face of the tool, and how these change along and across in its middle.
struct Face {
    heights: [f64; 16],
    slopes: [f64; 2],
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The least of the control points' mean heights over faces with weights that have the sum one.
fn least<const N: usize>(faces: [&Face; N], weights: [f64; N]) -> f64 {
    let mut least = f64::INFINITY;
    for k in 0..16 {
        let mut height = 0.0;
        for (face, weight) in faces.iter().zip(weights) {
            height += weight * face.heights[k];
        }
        least = least.min(height);
    }
    least
}

/// The bound by the mean of two faces that changes least.
fn of_two(a: &Face, b: &Face) -> Option<f64> {
    let turn = [b.slopes[0] - a.slopes[0], b.slopes[1] - a.slopes[1]];
    let square = turn[0] * turn[0] + turn[1] * turn[1];
    let share = -(a.slopes[0] * turn[0] + a.slopes[1] * turn[1]) / square;
    (share > 0.0 && share < 1.0).then(|| least([a, b], [1.0 - share, share]))
}

/// The bound by the mean of three faces that does not change.
fn of_three(a: &Face, b: &Face, c: &Face) -> Option<f64> {
    let shares = [cross(b.slopes, c.slopes), cross(c.slopes, a.slopes), cross(a.slopes, b.slopes)];
    let sum: f64 = shares.iter().sum();
    let weights = shares.map(|share| share / sum);
    weights.iter().all(|weight| *weight > 0.0).then(|| least([a, b, c], weights))
}

/// No place of a patch is nearer to the tool with its end at `tip` than this; its middle and the derivatives there are given. A bound
/// of `enough` need not be made closer.
pub(super) fn lower_bound(
    net: &Net,
    [middle, run, rise]: [&Vec3; 3],
    (tip, tool): (&Vec3, &Tool<'_>),
    enough: f64,
) -> f64 {
    let face = |outward: Vec3| {
        let base = outward.dot(tip) + tool.support(&outward).0;
        let mut heights = [0.0; 16];
        for (height, place) in heights.iter_mut().zip(net.as_flattened().iter()) {
            *height = outward.dot(place) - base;
        }
        Face { heights, slopes: [outward.dot(run), outward.dot(rise)] }
    };
    let faces: Vec<Face> = tool.faces_about(&(middle - tip)).map(face).collect();
    let mut lower = f64::NEG_INFINITY;
    for (i, a) in faces.iter().enumerate() {
        for (j, b) in faces.iter().enumerate().skip(i + 1) {
            lower = of_two(a, b).map_or(lower, |bound| lower.max(bound));
            for c in &faces[j + 1..] {
                lower = of_three(a, b, c).map_or(lower, |bound| lower.max(bound));
            }
            if lower >= enough {
                return lower;
            }
        }
    }
    lower
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;
    use proptest::prelude::*;

    use super::{
        super::{patch::jet, tool::Profile},
        *,
    };

    /// Radius and height of the tool.
    const RADIUS: f64 = 0.25;
    const HEIGHT: f64 = 2.0;

    fn tool_profile(corner_radius: f64, [alpha, beta]: [f64; 2]) -> Profile {
        let cutter = Cutter {
            diameter: 2.0 * RADIUS,
            corner_radius,
            corner_offset: RADIUS - corner_radius,
            corner_height: corner_radius,
            alpha,
            beta,
            height: HEIGHT,
        };
        Profile::of(&cutter).unwrap()
    }

    /// A patch about a place, with a direction along it and one across.
    fn net_about(place: &Vec3, along: &Vec3, across: &Vec3, bumps: &[f64]) -> Net {
        std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let [u, v] = [i, j].map(|k| k as f64 / 3.0 - 0.5);
                place + along * u + across * v + along.cross(across) * bumps[4 * j + i]
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn no_place_of_the_patch_is_nearer(
            kind in 0..4usize,
            place in [-0.4..0.4f64, -0.4..0.4f64, -0.3..2.3f64],
            along in [-0.5..0.5f64, -0.5..0.5f64, -0.5..0.5f64],
            across in [-0.5..0.5f64, -0.5..0.5f64, -0.5..0.5f64],
            bumps in proptest::collection::vec(-0.1..0.1f64, 16),
            size in 0.001..1.0f64,
        ) {
            let profile = match kind {
                0 => tool_profile(0.0, [0.0; 2]),
                1 => tool_profile(0.0, [0.3, 0.2]),
                2 => tool_profile(0.1, [0.0; 2]),
                _ => tool_profile(0.25, [0.0; 2]),
            };
            let tool = Tool::new(&profile, Vec3::z());
            let tip = Vec3::new(0.03, -0.02, 0.01);
            let [place, along, across] = [place, along, across].map(Vec3::from);
            let net = net_about(&place, &(along * size), &(across * size), &bumps);
            let [middle, run, rise] = jet(&net, [0.5; 2]);
            let lower = lower_bound(&net, [&middle, &run, &rise], (&tip, &tool), f64::INFINITY);
            for j in 0..=8 {
                for i in 0..=8 {
                    let [u, v] = [i, j].map(|k| f64::from(k) / 8.0);
                    let distance = tool.distance(&(jet(&net, [u, v])[0] - tip));
                    prop_assert!(distance >= lower - 1e-12, "{distance} under {lower} at {u} {v}");
                }
            }
        }

        /// Across an edge, with neither face along it, the bound is as close as the patch is flat.
        #[test]
        fn a_plane_patch_over_an_edge_is_bounded_closely(
            depth in 1e-6..1e-2f64, lean in 0.2..1.3f64, azimuth in 0.0..6.2f64, size in 1e-4..0.1f64,
        ) {
            let profile = tool_profile(0.0, [0.0; 2]);
            let tool = Tool::new(&profile, Vec3::z());
            let (s, c) = azimuth.sin_cos();
            let (out, round) = (Vec3::new(c, s, 0.0), Vec3::new(-s, c, 0.0));
            let across = out * lean.cos() + Vec3::z() * lean.sin();
            // As deep under the flank as over the bottom.
            let place = out * (RADIUS - depth) + Vec3::z() * depth;
            let net = net_about(&place, &(round * size), &(across * size), &[0.0; 16]);
            let [middle, run, rise] = jet(&net, [0.5; 2]);
            let lower = lower_bound(&net, [&middle, &run, &rise], (&Vec3::zeros(), &tool), f64::INFINITY);
            prop_assert!((lower + depth).abs() < 1e-12, "{lower} of {depth}");
        }
    }
}

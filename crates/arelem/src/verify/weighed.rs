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
        for (height, place) in heights.iter_mut().zip(net.iter().flatten()) {
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

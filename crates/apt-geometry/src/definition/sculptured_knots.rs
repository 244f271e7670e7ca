//! NURBS: B-splines of degree up to three as Bézier arcs and patches, by knot insertion and degree raising, both exact.

use nalgebra::Vector4;

use super::parametric_error::ParametricError;
use crate::{
    Vec3,
    parametric::{CurveArc, Patch},
};

/// Greatest degree of an arc.
const GREATEST_DEGREE: usize = 3;

type Row = Vec<Vector4<f64>>;

/// The arcs of a NURBS curve.
///
/// # Errors
/// A degree other than 1 to 3, knots that do not fit or do not grow, weights that are not positive.
pub(super) fn curve(
    degree: usize,
    knots: &[f64],
    points: &[Vec3],
    weights: &[f64],
) -> Result<Vec<CurveArc>, ParametricError> {
    let row = homogeneous(points, weights)?;
    Ok(spans(degree, knots, &row)?.into_iter().map(|control| CurveArc { control }).collect())
}

/// The patches of a NURBS surface with the number of columns and rows; points along u run fastest.
///
/// # Errors
/// As for a curve.
pub(super) fn surface(
    degrees: [usize; 2],
    knots: &[Vec<f64>; 2],
    points: &[Vec3],
    weights: &[f64],
) -> Result<(Vec<Patch>, (usize, usize)), ParametricError> {
    let count = |side: usize| knots[side].len().saturating_sub(degrees[side] + 1);
    let (columns, rows) = (count(0), count(1));
    if columns == 0 || columns.saturating_mul(rows) != points.len() {
        return Err(ParametricError::Knots { degree: degrees[0], points: points.len() });
    }
    let net = homogeneous(points, weights)?;
    // Along u in every row; then along v through what that gave, four control points per column of patches.
    let mut along_u = Vec::with_capacity(rows);
    for row in net.chunks(columns) {
        along_u.push(spans(degrees[0], &knots[0], row)?);
    }
    let columns = along_u.first().map_or(0, Vec::len);
    let mut strips = Vec::with_capacity(columns);
    for column in 0..columns {
        let mut strip = Vec::with_capacity(4);
        for point in 0..4 {
            let line: Row =
                along_u.iter().filter_map(|row| row.get(column).map(|span| span[point])).collect();
            strip.push(spans(degrees[1], &knots[1], &line)?);
        }
        strips.push(strip);
    }
    let rows = strips.first().and_then(|strip| strip.first()).map_or(0, Vec::len);
    let mut patches = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for strip in &strips {
            let mut control = [[Vector4::zeros(); 4]; 4];
            for (place, line) in control.iter_mut().zip(strip) {
                if let Some(span) = line.get(row) {
                    *place = *span;
                }
            }
            patches.push(Patch { control });
        }
    }
    Ok((patches, (columns, rows)))
}

fn homogeneous(points: &[Vec3], weights: &[f64]) -> Result<Row, ParametricError> {
    if !weights.is_empty() && weights.len() != points.len() {
        return Err(ParametricError::TooFew { least: points.len(), found: weights.len() });
    }
    let weight = |index: usize| weights.get(index).copied().unwrap_or(1.0);
    points
        .iter()
        .enumerate()
        .map(|(index, point)| {
            let weight = weight(index);
            if weight > 0.0 && weight.is_finite() {
                Ok(Vector4::new(point.x * weight, point.y * weight, point.z * weight, weight))
            } else {
                Err(ParametricError::Weight { weight })
            }
        })
        .collect()
}

/// The Bézier spans of a B-spline, raised to degree three.
fn spans(
    degree: usize,
    knots: &[f64],
    points: &[Vector4<f64>],
) -> Result<Vec<[Vector4<f64>; 4]>, ParametricError> {
    let fault = ParametricError::Knots { degree, points: points.len() };
    let sorted = knots.windows(2).all(|pair| pair[0] <= pair[1]);
    let fits = (1..=GREATEST_DEGREE).contains(&degree)
        && points.len() > degree
        && knots.len() == points.len() + degree + 1
        && knots.iter().all(|knot| knot.is_finite());
    if !(sorted && fits) {
        return Err(fault);
    }
    let (first, last) = (knots[degree], knots[points.len()]);
    let mut bounds: Vec<f64> = knots[degree..=points.len()].to_vec();
    bounds.dedup();
    if first >= last || bounds.len() < 2 {
        return Err(fault);
    }
    // Blossoms: the control points of the span from a to b are the values of the polar form at (a…a, b…b).
    bounds
        .windows(2)
        .map(|ends| {
            let control: Vec<Vector4<f64>> = (0..=degree)
                .map(|upper| {
                    let mut places = [ends[0]; GREATEST_DEGREE];
                    for place in places.iter_mut().take(upper) {
                        *place = ends[1];
                    }
                    blossom(degree, knots, points, ends, &places[..degree])
                })
                .collect();
            raised(&control).ok_or(fault.clone())
        })
        .collect()
}

/// The polar form of the span from `ends[0]` to `ends[1]` at as many places as the degree (de Boor).
fn blossom(
    degree: usize,
    knots: &[f64],
    points: &[Vector4<f64>],
    ends: &[f64],
    places: &[f64],
) -> Vector4<f64> {
    // The last knot index with a knot not above the start of the span.
    let span = knots.partition_point(|knot| *knot <= ends[0]).saturating_sub(1).min(points.len() - 1);
    let mut work: Vec<Vector4<f64>> = (0..=degree).map(|offset| points[span + offset - degree]).collect();
    for (level, place) in places.iter().enumerate() {
        for offset in (level + 1..=degree).rev() {
            let low = knots[span + offset - degree];
            let high = knots[span + offset - level];
            let share = if high > low { (place - low) / (high - low) } else { 0.0 };
            work[offset] = work[offset - 1] * (1.0 - share) + work[offset] * share;
        }
    }
    work[degree]
}

/// Control points raised to degree three.
fn raised(control: &[Vector4<f64>]) -> Option<[Vector4<f64>; 4]> {
    match control {
        [a, b] => Some([*a, (a * 2.0 + b) / 3.0, (a + b * 2.0) / 3.0, *b]),
        [a, b, c] => Some([*a, (a + b * 2.0) / 3.0, (b * 2.0 + c) / 3.0, *c]),
        [a, b, c, d] => Some([*a, *b, *c, *d]),
        _ => None,
    }
}

//! The 79 values of a polyconic surface with their meaning (language reference 4.15, 5; the evaluation is that of the
//! published APT III processor).
//!
//! In its own coordinates `x' = T x` the surface is a family of conics in the planes `x' = base + length·d`. Each conic
//! starts at (L, H), ends at (L+A+C, H+B+D), and its tangents there meet in (L+C, H+B); P tells how full it is: it goes
//! through the point that divides the way from the end of one tangent to the other so that `u = 1−P, w = P`. All seven
//! are functions `k√d + Σ kᵢ dⁱ` of the station d, which runs from 0 to 1.

use super::{Matrix, TransformError};
use crate::{Vec3, canonical::GeometryKind};

/// Number of canonical values.
const VALUES: usize = 79;
/// Control functions: A, B, C, D, L, H, P.
const FUNCTIONS: usize = 7;
/// Coefficients of each polynomial.
const TERMS: usize = 8;
/// Index of the first value of the matrix, and what follows it: thickness, base, length, polynomials, square roots.
const MATRIX: usize = 1;
const THICKNESS: usize = 13;
const BASE: usize = 14;
const LENGTH: usize = 15;
const POLYNOMIALS: usize = 16;
const ROOTS: usize = POLYNOMIALS + FUNCTIONS * TERMS;
/// Departure of the matrix from a rigid motion that is rounding of the values.
const RIGID: f64 = 1e-6;

/// A polyconic surface by the meaning of its values.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyConicForm {
    /// From part-program coordinates to those of the surface: a rigid motion.
    pub map: Matrix,
    /// The surface lies at this distance from the conics, along their natural normal.
    pub thickness: f64,
    /// `x'` of station 0.
    pub base: f64,
    /// Length from station 0 to 1.
    pub length: f64,
    /// Coefficients of `1, d, …, d⁷` of A, B, C, D, L, H, P.
    pub polynomials: [[f64; TERMS]; FUNCTIONS],
    /// Coefficients of `√d`, if the form has such terms.
    pub roots: Option<[f64; FUNCTIONS]>,
}

impl PolyConicForm {
    /// Reads the values; `None` if there are not 79 finite ones, the length is 0 or the matrix is no rigid motion.
    pub fn read(values: &[f64]) -> Option<Self> {
        if values.len() != VALUES || !values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let value = |k: usize| values.get(k).copied().unwrap_or(0.0);
        let row = |i: usize| -> [f64; 4] { std::array::from_fn(|j| value(MATRIX + 4 * i + j)) };
        // A first row of zeros says that there is no matrix.
        let absent = (0..3).all(|j| value(MATRIX + j) == 0.0);
        let map = if absent { Matrix::identity() } else { Matrix { rows: [row(0), row(1), row(2)] } };
        let scale = map.uniform_scale(RIGID)?;
        let length = value(LENGTH);
        if (scale - 1.0).abs() > RIGID || length == 0.0 {
            return None;
        }
        let polynomials =
            std::array::from_fn(|f| std::array::from_fn(|i| value(POLYNOMIALS + TERMS * f + i)));
        // The first value is 2 where square roots count.
        let with_roots = (value(0).abs() - 2.0).abs() < 0.5;
        Some(Self {
            map,
            thickness: value(THICKNESS),
            base: value(BASE),
            length,
            polynomials,
            roots: with_roots.then(|| std::array::from_fn(|f| value(ROOTS + f))),
        })
    }

    /// A, B, C, D, L, H, P at a station; `None` for square roots before station 0.
    pub fn controls(&self, station: f64) -> Option<[f64; FUNCTIONS]> {
        let root = match self.roots {
            Some(_) if station < 0.0 => return None,
            Some(_) => station.sqrt(),
            None => 0.0,
        };
        let roots = self.roots.unwrap_or([0.0; FUNCTIONS]);
        Some(std::array::from_fn(|f| {
            let polynomial =
                self.polynomials.get(f).map_or(0.0, |p| p.iter().rev().fold(0.0, |s, k| s * station + k));
            polynomial + roots.get(f).map_or(0.0, |k| k * root)
        }))
    }
}

/// The canonical values of the image under `x' = M x`, which must keep shapes.
pub(super) fn image(values: &[f64], matrix: &Matrix) -> Result<Vec<f64>, TransformError> {
    let kind = GeometryKind::PolyConic;
    let inverse = matrix.inverse().ok_or(TransformError::Singular)?;
    let scale = matrix.uniform_scale(RIGID).ok_or_else(|| {
        let [least, .., greatest] = sorted_scales(matrix);
        TransformError::Distorted { kind, distortion: (greatest - least) / greatest }
    })?;
    let form = PolyConicForm::read(values).ok_or(TransformError::NotMoved { kind })?;
    let map = Matrix::scaling(scale).multiply(&form.map).multiply(&inverse);
    let mut moved = values.to_vec();
    let entries = map.rows.iter().flatten().copied();
    for (value, entry) in moved.iter_mut().skip(MATRIX).zip(entries) {
        *value = entry;
    }
    // Lengths grow; P, the last function of both groups, is a ratio.
    let lengths = (THICKNESS..=LENGTH).chain(POLYNOMIALS..ROOTS - TERMS).chain(ROOTS..VALUES - 1);
    for k in lengths {
        if let Some(value) = moved.get_mut(k) {
            *value *= scale;
        }
    }
    Ok(moved)
}

/// Lengths of the images of the coordinate directions in order.
fn sorted_scales(matrix: &Matrix) -> [f64; 3] {
    let mut scales = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| matrix.apply_vector(&axis).norm());
    scales.sort_by(f64::total_cmp);
    scales
}

//! Affine maps in the twelve-number form of the language.

use nalgebra::{Matrix3, Matrix4};

use super::{Matrix, Plane};
use crate::Vec3;

/// Least pivot of a matrix that counts as invertible, relative to the length of its longest row.
const SINGULAR_PIVOT: f64 = 1e-12;

/// A coordinate plane, as the words XYPLAN, YZPLAN, ZXPLAN and XYROT, YZROT, ZXROT name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CoordinatePlane {
    /// The xy-plane; rotation takes x to y.
    Xy,
    /// The yz-plane; rotation takes y to z.
    Yz,
    /// The zx-plane; rotation takes z to x.
    Zx,
}

impl CoordinatePlane {
    /// Indices of the first axis, the second axis and the axis across the plane.
    pub fn axes(self) -> [usize; 3] {
        match self {
            CoordinatePlane::Xy => [0, 1, 2],
            CoordinatePlane::Yz => [1, 2, 0],
            CoordinatePlane::Zx => [2, 0, 1],
        }
    }
}

impl Matrix {
    /// The map that changes nothing.
    pub fn identity() -> Matrix {
        Matrix::scaling(1.0)
    }

    /// The shift by `by`.
    pub fn translation(by: Vec3) -> Matrix {
        Matrix::from_parts(&Matrix3::identity(), &by)
    }

    /// The scaling of all three coordinates about the origin.
    pub fn scaling(factor: f64) -> Matrix {
        Matrix::from_parts(&(Matrix3::identity() * factor), &Vec3::zeros())
    }

    /// The rotation by `degrees` that takes the first axis of the plane towards the second one; exact at multiples of
    /// 90 degrees.
    pub fn rotation(plane: CoordinatePlane, degrees: f64) -> Matrix {
        let (sine, cosine) = sine_cosine_degrees(degrees);
        let [first, second, _] = plane.axes();
        let mut linear = Matrix3::identity();
        linear[(first, first)] = cosine;
        linear[(first, second)] = -sine;
        linear[(second, first)] = sine;
        linear[(second, second)] = cosine;
        Matrix::from_parts(&linear, &Vec3::zeros())
    }

    /// The reflection in a plane, whose normal is taken as a unit vector.
    pub fn reflection(plane: &Plane) -> Matrix {
        let normal = plane.normal;
        let linear = Matrix3::identity() - normal * normal.transpose() * 2.0;
        Matrix::from_parts(&linear, &(normal * (2.0 * plane.distance)))
    }

    /// `x' = linear x + shift`.
    pub fn from_parts(linear: &Matrix3<f64>, shift: &Vec3) -> Matrix {
        let row = |index: usize| [linear[(index, 0)], linear[(index, 1)], linear[(index, 2)], shift[index]];
        Matrix { rows: [row(0), row(1), row(2)] }
    }

    /// The linear part.
    pub fn linear(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.rows[row][column])
    }

    /// The shift, the fourth column.
    pub fn shift(&self) -> Vec3 {
        Vec3::new(self.rows[0][3], self.rows[1][3], self.rows[2][3])
    }

    /// The map as a 4×4 matrix with the last row 0 0 0 1.
    pub fn to_homogeneous(&self) -> Matrix4<f64> {
        Matrix4::from_fn(|row, column| match self.rows.get(row) {
            Some(numbers) => numbers[column],
            None => f64::from(u8::from(column == 3)),
        })
    }

    /// The product `self · after_this`: the right factor acts first.
    pub fn multiply(&self, first: &Matrix) -> Matrix {
        let linear = self.linear();
        Matrix::from_parts(&(linear * first.linear()), &(linear * first.shift() + self.shift()))
    }

    /// The map back; `None` when the matrix is singular.
    pub fn inverse(&self) -> Option<Matrix> {
        let linear = self.linear();
        let size = linear.amax();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        // Scaled to entries of at most one, the determinant is a volume relative to the size of the map.
        let scaled = linear / size;
        if scaled.determinant().abs() <= SINGULAR_PIVOT {
            return None;
        }
        let back = scaled.try_inverse()? / size;
        Some(Matrix::from_parts(&back, &(-(back * self.shift()))))
    }

    /// `M x` for a place.
    pub fn apply_point(&self, point: &Vec3) -> Vec3 {
        self.linear() * point + self.shift()
    }

    /// `M x` for a direction: the shift does not act.
    pub fn apply_vector(&self, vector: &Vec3) -> Vec3 {
        self.linear() * vector
    }

    /// The factor by which the map scales all lengths, when it scales them all alike to within `fraction`.
    pub fn uniform_scale(&self, fraction: f64) -> Option<f64> {
        let linear = self.linear();
        let gram = linear.transpose() * linear;
        let mean = gram.trace() / 3.0;
        let off = (gram - Matrix3::identity() * mean).amax();
        (mean > 0.0 && off <= fraction * mean).then(|| mean.sqrt())
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90 degrees.
pub fn sine_cosine_degrees(degrees: f64) -> (f64, f64) {
    let turns = (degrees / 90.0).round();
    let (sine, cosine) = (degrees - turns * 90.0).to_radians().sin_cos();
    match turns.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_exact_at_quarter_turns() {
        for (degrees, expected) in [
            (0.0, (0.0, 1.0)),
            (90.0, (1.0, 0.0)),
            (180.0, (0.0, -1.0)),
            (-90.0, (-1.0, 0.0)),
            (720.0, (0.0, 1.0)),
        ] {
            let (sine, cosine) = sine_cosine_degrees(degrees);
            assert_eq!((sine.abs() * sine.signum(), cosine), expected, "{degrees}");
        }
        let (sine, cosine) = sine_cosine_degrees(30.0);
        assert!((sine - 0.5).abs() < 1e-15 && (cosine - 0.75f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn rotations_turn_the_named_axes() {
        let turned = |plane| Matrix::rotation(plane, 90.0);
        assert_eq!(turned(CoordinatePlane::Xy).apply_vector(&Vec3::x()), Vec3::y());
        assert_eq!(turned(CoordinatePlane::Yz).apply_vector(&Vec3::y()), Vec3::z());
        assert_eq!(turned(CoordinatePlane::Zx).apply_vector(&Vec3::z()), Vec3::x());
    }

    #[test]
    fn the_right_factor_of_a_product_acts_first() {
        let shift = Matrix::translation(Vec3::new(5.0, 0.0, 0.0));
        let turn = Matrix::rotation(CoordinatePlane::Xy, 90.0);
        assert_eq!(shift.multiply(&turn).shift(), Vec3::new(5.0, 0.0, 0.0));
        assert_eq!(turn.multiply(&shift).shift(), Vec3::new(0.0, 5.0, 0.0));
    }

    #[test]
    fn the_inverse_undoes_the_map() {
        let map = Matrix::translation(Vec3::new(5.0, 1.0, -2.0))
            .multiply(&Matrix::rotation(CoordinatePlane::Xy, 33.0))
            .multiply(&Matrix::scaling(1e-4));
        let back = map.inverse().expect("invertible");
        let point = Vec3::new(3.0, -4.0, 7.0);
        assert!((back.apply_point(&map.apply_point(&point)) - point).norm() < 1e-9);
        assert!((map.uniform_scale(1e-9).expect("uniform") - 1e-4).abs() < 1e-16);
        assert_eq!(
            Matrix { rows: [[1.0, 2.0, 3.0, 0.0], [2.0, 4.0, 6.0, 0.0], [0.0, 0.0, 1.0, 0.0]] }.inverse(),
            None
        );
        assert_eq!(Matrix::scaling(0.0).inverse(), None);
    }
}

//! Curvature of a surface at a point, positive where it is concave seen from the tool (sculptured surfaces reference 2.2).

use apt_geometry::{Vec3, parametric::PatchPoint};

/// Both fundamental forms at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curvature {
    /// First form: E, F, G.
    first: [f64; 3],
    /// Second form with the normal towards the tool: L, M, N.
    second: [f64; 3],
    along_u: Vec3,
    along_v: Vec3,
}

impl Curvature {
    /// The forms at a point, with the unit normal towards the tool.
    pub fn new(at: &PatchPoint, normal: &Vec3) -> Self {
        Self {
            first: [at.du.norm_squared(), at.du.dot(&at.dv), at.dv.norm_squared()],
            second: [normal.dot(&at.duu), normal.dot(&at.duv), normal.dot(&at.dvv)],
            along_u: at.du,
            along_v: at.dv,
        }
    }

    /// EG − F²; zero where the parameters give no tangent plane.
    fn determinant(&self) -> f64 {
        let [e, f, g] = self.first;
        (e * g - f * f).max(0.0)
    }

    /// The curvature of the normal section along a direction, which is taken into the tangent plane; zero where there is
    /// no such section.
    pub fn along(&self, direction: &Vec3) -> f64 {
        let [e, f, g] = self.first;
        let determinant = self.determinant();
        if determinant <= f64::MIN_POSITIVE {
            return 0.0;
        }
        let (a, b) = (direction.dot(&self.along_u), direction.dot(&self.along_v));
        let (s, t) = ((g * a - f * b) / determinant, (e * b - f * a) / determinant);
        let length = e * s * s + 2.0 * f * s * t + g * t * t;
        let [l, m, n] = self.second;
        if length > 0.0 { (l * s * s + 2.0 * m * s * t + n * t * t) / length } else { 0.0 }
    }

    /// The principal curvatures, the greater first.
    pub fn principal(&self) -> [f64; 2] {
        let ([e, f, g], [l, m, n]) = (self.first, self.second);
        let determinant = self.determinant();
        if determinant <= f64::MIN_POSITIVE {
            return [0.0; 2];
        }
        let mean = (e * n - 2.0 * f * m + g * l) / (2.0 * determinant);
        let product = (l * n - m * m) / determinant;
        let root = (mean * mean - product).max(0.0).sqrt();
        // The root of the greater size first, the other from the product: no digits are lost.
        let strong = if mean >= 0.0 { mean + root } else { mean - root };
        let weak = if strong == 0.0 { 0.0 } else { product / strong };
        [strong.max(weak), strong.min(weak)]
    }

    /// How the unit normal changes with u and with v.
    pub fn normal_derivatives(&self) -> [Vec3; 2] {
        let ([e, f, g], [l, m, n]) = (self.first, self.second);
        let determinant = self.determinant();
        if determinant <= f64::MIN_POSITIVE {
            return [Vec3::zeros(); 2];
        }
        let by_u = self.along_u * (f * m - g * l) + self.along_v * (f * l - e * m);
        let by_v = self.along_u * (f * n - g * m) + self.along_v * (f * m - e * n);
        [by_u / determinant, by_v / determinant]
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::parametric::Patch;

    use super::*;

    /// z = 0.1 x² − 0.05 y², with x and y sheared in the parameters.
    fn saddle() -> Patch {
        let mut c = [[Vec3::zeros(); 4]; 4];
        c[1][0] = Vec3::new(1.0, 0.0, 0.0);
        c[0][1] = Vec3::new(0.5, 1.0, 0.0);
        c[2][0] = Vec3::new(0.0, 0.0, 0.1);
        c[1][1] = Vec3::new(0.0, 0.0, 0.1);
        c[0][2] = Vec3::new(0.0, 0.0, 0.025 - 0.05);
        Patch::from_power(&c)
    }

    #[test]
    fn a_saddle_is_concave_one_way_and_convex_the_other() {
        let curvature = Curvature::new(&saddle().evaluate(0.0, 0.0), &Vec3::z());
        let [k1, k2] = curvature.principal();
        assert!((k1 - 0.2).abs() < 1e-12 && (k2 + 0.1).abs() < 1e-12, "{k1} {k2}");
        assert!((curvature.along(&Vec3::x()) - 0.2).abs() < 1e-12);
        assert!((curvature.along(&Vec3::new(0.0, 3.0, 1.0)) + 0.1).abs() < 1e-12);
        let below = Curvature::new(&saddle().evaluate(0.0, 0.0), &-Vec3::z());
        assert!((below.along(&Vec3::x()) + 0.2).abs() < 1e-12);
    }

    #[test]
    fn the_normal_turns_as_its_derivatives_say() {
        let (patch, h) = (saddle(), 1e-6);
        let normal = |u: f64, v: f64| patch.evaluate(u, v).regular_normal().unwrap();
        let (u, v) = (0.4, 0.7);
        let [by_u, by_v] = Curvature::new(&patch.evaluate(u, v), &normal(u, v)).normal_derivatives();
        let differences =
            [normal(u + h, v) - normal(u - h, v), normal(u, v + h) - normal(u, v - h)].map(|d| d / (2.0 * h));
        assert!((by_u - differences[0]).norm() < 1e-8 && (by_v - differences[1]).norm() < 1e-8);
    }
}

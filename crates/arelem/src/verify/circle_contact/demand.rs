//! What is asked of all points of the tool: a bound of their squared distances, seen from the tool.
//!
//! Circles and straight pieces about the tool axis ask the same quadratic function again and again. So it is told once by height over
//! the tool end and place across the axis, where it is a polynomial of few numbers.

use apt_geometry::Vec3;
use nalgebra::{Matrix2, Vector2};

use super::{DefiniteForm, Place, Touch, multiplier_of_circle};
use crate::verify::tool::Meridian;

/// A quadratic function below what is asked about, about the tool end, and how little it may be.
pub(super) struct Demand {
    pub(super) least: f64,
    /// Its value at the tool end, and half its gradient there: across the axis, and along.
    at_tip: f64,
    across: Vector2<f64>,
    along: f64,
    /// Its form for two directions across the axis, for one and the axis, and for the axis.
    pub(super) form: Matrix2<f64>,
    pub(super) twist: Vector2<f64>,
    pub(super) upright: f64,
}

impl Place<'_> {
    /// For a distance to keep, the bound of squared distances; for a depth allowed, F itself with the tool moved out by it.
    pub(super) fn demand(&self, distance: f64, touch: &Touch) -> Option<Demand> {
        let kept = distance.max(0.0);
        let lower = self.quadric.lower(self.side, kept / touch.steepness)?;
        let tip: Vec3 = self.tip + touch.normal * (kept - distance);
        let (slope, axis, [u, v]) = (lower.slope(&tip), &self.axis, &self.across);
        let uv = lower.form(u, v);
        Some(Demand {
            least: kept * touch.steepness,
            at_tip: lower.at(&tip),
            across: Vector2::new(slope.dot(u), slope.dot(v)),
            along: slope.dot(axis),
            form: Matrix2::new(lower.form(u, u), uv, uv, lower.form(v, v)),
            twist: Vector2::new(lower.form(u, axis), lower.form(v, axis)),
            upright: lower.form(axis, axis),
        })
    }
}

impl Demand {
    /// The value on the axis, at a height over the tool end.
    pub(super) fn on_axis(&self, height: f64) -> f64 {
        self.at_tip + height * (2.0 * self.along + height * self.upright)
    }

    /// Half the gradient there, across the axis.
    pub(super) fn slope_across(&self, height: f64) -> Vector2<f64> {
        self.across + self.twist * height
    }

    /// The same along it.
    pub(super) fn slope_along(&self, height: f64) -> f64 {
        self.along + self.upright * height
    }

    /// The form applied to a direction across the axis.
    pub(super) fn formed(&self, v: &Vector2<f64>) -> Vector2<f64> {
        let form = &self.form;
        Vector2::new(form.m11 * v.x + form.m12 * v.y, form.m12 * v.x + form.m22 * v.y)
    }

    /// The value at a place of the meridian, or of its other half beyond the axis, at an azimuth.
    pub(super) fn at(&self, [rho, height]: Meridian, azimuth: &Vector2<f64>) -> f64 {
        let place = azimuth * rho;
        self.on_axis(height) + (self.formed(&place) + self.slope_across(height) * 2.0).dot(&place)
    }

    /// A lower bound on the piece between two circles, with the multiplier for the distance from the axis of the circle `at` of
    /// 0 … 1: that of its place that faces the contact, or without one that of its lowest place. The least value over the places
    /// at each height, wherever they are, is a quadratic function of the height, lowest at an end or where it is level.
    pub(super) fn between(&self, [a, b]: [Meridian; 2], facing: Option<&Vector2<f64>>, at: f64) -> f64 {
        let (spread, rise) = (b[0] - a[0], b[1] - a[1]);
        let rho = a[0] + spread * at;
        if rho <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let (form, g, cross) = (self.form, self.slope_across(a[1]), self.twist * rise);
        let pull = g + cross * at;
        let mu = match facing {
            Some(facing) => -(self.formed(facing) * rho + pull).dot(facing) / rho,
            None => multiplier_of_circle(&form, &pull, rho),
        };
        let Some(held) = DefiniteForm::of(&form, mu) else { return f64::NEG_INFINITY };
        let (of_g, of_cross) = (held.solved(&g), held.solved(&cross));
        let first = self.on_axis(a[1]) - mu * a[0] * a[0] - g.dot(&of_g);
        let climb = rise * self.slope_along(a[1]) - mu * a[0] * spread - g.dot(&of_cross);
        let bend = rise * rise * self.upright - mu * spread * spread - cross.dot(&of_cross);
        let ends = first.min(first + 2.0 * climb + bend);
        let level = -climb / bend;
        let is_level = bend > 0.0 && level > 0.0 && level < 1.0;
        let least = if is_level { ends.min(first + climb * level) } else { ends };
        least - held.rounding(of_g.norm() + of_cross.norm())
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::canonical::Quadric;
    use proptest::prelude::*;

    use super::*;
    use crate::verify::{
        quadric::PrincipalQuadric,
        tests::cutter,
        tool::{Profile, Tool, perpendicular},
    };

    proptest! {
        /// What is told by height and place across the axis is the function itself.
        #[test]
        fn a_demand_is_the_bound_seen_from_the_tool(
            lean in prop::array::uniform2(-1.0..1.0f64), tip in prop::array::uniform3(-2.0..2.0f64),
            normal in prop::array::uniform3(-1.0..1.0f64), distance in -0.1..0.5f64,
            (rho, height, azimuth) in (0.0..1.0f64, 0.0..4.0f64, 0.0..std::f64::consts::TAU),
        ) {
            let saddle = Quadric { coefficients: [0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5] };
            let quadric = PrincipalQuadric::of(&saddle).unwrap();
            let profile = Profile::of(&cutter(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0])).unwrap();
            let tool = Tool::new(&profile, Vec3::new(lean[0], lean[1], 1.0).normalize());
            let first = perpendicular(&tool.axis);
            let across = [first, tool.axis.cross(&first)].map(|v| quadric.turned_in(&v));
            let axis = quadric.turned_in(&tool.axis);
            let place = Place { quadric: &quadric, side: 1.0, tool: &tool, tip: Vec3::from(tip), axis, across };
            let touch = Touch {
                distance,
                normal: Vec3::from(normal).try_normalize(1e-3).unwrap_or_else(Vec3::z),
                steepness: 0.5,
                foot: Vec3::zeros(),
                meridian: [0.0; 2],
            };
            let demand = place.demand(distance, &touch).unwrap();
            let kept = distance.max(0.0);
            let lower = quadric.lower(1.0, kept / touch.steepness).unwrap();
            let end = place.tip + touch.normal * (kept - distance);
            let x = end + place.on_circle(azimuth)[0] * rho + axis * height;
            let (sin, cos) = azimuth.sin_cos();
            let told = demand.at([rho, height], &Vector2::new(cos, sin));
            prop_assert!((told - lower.at(&x)).abs() <= 1e-12 * (1.0 + lower.at(&x).abs()), "{told}");
        }
    }
}

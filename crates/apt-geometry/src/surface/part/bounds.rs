//! Curvatures and normals over a rectangle of parameters, from the second derivatives over it.

use super::{
    Enclosure,
    form::{Bent, Form},
    rulings::{Rulings, Turning},
};
use crate::{
    Vec3,
    surface::interval::{Box3, Interval},
};

/// Change of the tangent plane over a part, relative to its frame, above which nothing is said of its curvature.
const STEADY: f64 = 0.4;
/// Excess of a bound over the curvature in the middle, as a share of the greatest curvature there, that is close enough.
pub(super) const CLOSE: f64 = 0.15;

/// The same for bounds that serve pieces of all of it.
const EVEN: f64 = 1.0;

/// Greatest eigenvalue of a symmetric matrix.
fn greatest(xx: f64, xy: f64, yy: f64) -> f64 {
    0.5 * (xx + yy) + (0.5 * (xx - yy)).hypot(xy)
}

/// Curvatures and normals over a rectangle.
pub(super) struct Bounds {
    pub(super) curvature: [f64; 2],
    pub(super) least: [f64; 2],
    pub(super) close: f64,
    pub(super) normal: Option<Vec3>,
    pub(super) spread: f64,
    /// How much each side of the rectangle changes the frame and the curvature.
    pub(super) loose: [f64; 2],
    pub(super) bent: Option<Bent>,
}

impl Bounds {
    /// Whether the bound of the curvature is not far above that in the middle, or of no account.
    pub(super) fn is_even(&self, of_no_account: f64) -> bool {
        let greatest = self.least[0].abs().max(self.least[1].abs());
        let excess = [0, 1].map(|k: usize| self.curvature[k] - self.least[k]);
        self.normal.is_some() && excess.iter().all(|excess| *excess <= (EVEN * greatest).max(of_no_account))
    }

    /// In an orthonormal frame of the tangent plane in the middle all other frames differ by little, and second derivatives
    /// become curvatures up to that.
    pub(super) fn of(enclosure: &Enclosure, half: [f64; 2]) -> Self {
        let Enclosure { jet, duu, duv, dvv, .. } = enclosure;
        let unknown = Self {
            curvature: [f64::INFINITY; 2],
            least: [f64::INFINITY; 2],
            close: 0.0,
            normal: None,
            spread: 2.0,
            loose: [half[0] * jet.du.norm(), half[1] * jet.dv.norm()],
            bent: None,
        };
        let Some(normal) = jet.du.cross(&jet.dv).try_normalize(0.0) else { return unknown };
        let Some(x) = jet.du.try_normalize(0.0) else { return unknown };
        let y = normal.cross(&x);
        let (a, b, c) = (jet.du.norm(), jet.dv.dot(&x), jet.dv.dot(&y));
        // Second derivatives by the coordinates of the frame.
        let xx = duu.scaled(1.0 / (a * a));
        let xy = duv.plus(&duu.scaled(-b / a)).scaled(1.0 / (a * c));
        let yy = dvv.plus(&duv.scaled(-2.0 * b / a)).plus(&duu.scaled(b * b / (a * a))).scaled(1.0 / (c * c));
        let changed = |[uu, uv, vv]: [f64; 3], [hu, hv]: [f64; 2]| {
            let (u, v) = (uu * hu + uv * hv, uv * hu + vv * hv);
            (u / a).hypot(v / c.abs() + u * b.abs() / (a * c.abs()))
        };
        let lengths = [duu, duv, dvv].map(Box3::length);
        let loose = [changed(lengths, [half[0], 0.0]), changed(lengths, [0.0, half[1]])];
        let change = changed(lengths, half);
        // Only what stands out of the tangent plane in the middle turns it.
        let tilt = changed([duu, duv, dvv].map(|bend| bend.dot(&normal).magnitude()), half);
        let bends = [xx.dot(&normal), xy.dot(&normal), yy.dot(&normal)];
        let [p, q, r] = bends.map(Interval::middle);
        let center = |d: &Vec3, e: &Vec3, f: &Vec3| {
            let (l, m, n) = (d.dot(&normal), e.dot(&normal), f.dot(&normal));
            [l / (a * a), (m - l * b / a) / (a * c), (n - 2.0 * m * b / a + l * b * b / (a * a)) / (c * c)]
        };
        let [l, m, n] = center(&jet.duu, &jet.duv, &jet.dvv);
        let least = [greatest(-l, -m, -n), greatest(l, m, n)];
        let close = CLOSE * least[0].abs().max(least[1].abs());
        if change.is_nan() || change > STEADY {
            return Self { least, close, normal: Some(normal), loose, ..unknown };
        }
        // Bound of the tangent of the angle between the tangent planes, and the chord of an angle with that sine.
        let sine = tilt / (1.0 - change);
        let spread = 2.0 * (0.5 * sine.asin()).sin();
        let size = greatest(xx.length(), xy.length(), yy.length());
        let [dp, dq, dr] = bends.map(Interval::radius);
        let error = greatest(dp, dq, dr) + spread * size;
        let curvature = [greatest(-p, -q, -r), greatest(p, q, r)].map(|bend| {
            let most = bend + error;
            let stretch = if most > 0.0 { 1.0 - change } else { 1.0 + change };
            most / (stretch * stretch)
        });
        let form = Form::about([x, y], [p, q, r], error, change);
        let rulings = Rulings::of(enclosure, half, &Turning { normal, spread, change }, &form);
        let bent = Some(Bent { form, rulings });
        Self { curvature, least, close, normal: Some(normal), spread, loose, bent }
    }
}

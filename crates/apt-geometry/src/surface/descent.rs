//! The way down to the nearest place of a patch: Newton's method over two parameters within limits, damped so that no
//! step leads away. Polyconic and sculptured surfaces share it.

use nalgebra::{Matrix2, Vector2};

use super::sheet::Jet;
use crate::Vec3;

/// Step of the parameters below which its effect on the distance is far below rounding.
const RESOLUTION: f64 = 1e-13;
/// Bound of the steps from one start.
pub(super) const MAX_STEPS: u32 = 40;
/// The first damping, how it falls after a step that helps and grows after one that does not, and where it ends: such a
/// step moves no digit of a parameter.
const FIRST_DAMPING: f64 = 1e-3;
const EASED: f64 = 0.2;
const RAISED: f64 = 4.0;
const MAX_DAMPING: f64 = 1e12;
/// Bend, relative to the metric, below which one parameter alone has no minimum to go to.
const FLAT: f64 = 1e-9;
/// Determinant of the second derivatives, relative to the metric, below which they are singular.
const SINGULAR: f64 = 1e-14;

/// Rounding of a point of a surface and of its way from another one, relative to the coordinates of both.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// How near a place of a surface is to a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearness {
    /// The squared distance.
    pub(super) square: f64,
    /// How steeply that changes along the surface from there, in one measure for all places that are compared.
    pub(super) slope: f64,
}

impl Nearness {
    /// That of no place.
    pub(super) const NONE: Self = Self { square: f64::INFINITY, slope: f64::INFINITY };

    /// Whether another place counts as nearer, for coordinates of a size. As near but for rounding the one where the slope is less counts: about the nearest
    /// place distance is level, and does not tell to within more than the root of its rounding where that is.
    pub(super) fn yields_to(&self, other: &Self, size: f64) -> bool {
        match self.is_farther(other, size) {
            Some(is_farther) => is_farther,
            None => other.slope < self.slope,
        }
    }

    /// Whether it is farther than another place; `None` where only rounding tells.
    fn is_farther(&self, other: &Self, size: f64) -> Option<bool> {
        let of_points = ROUNDING * size;
        let rounding = (2.0 * self.square.min(other.square).sqrt() + of_points) * of_points;
        let is_told = (self.square - other.square).abs() > rounding;
        is_told.then_some(other.square < self.square)
    }
}

/// Half the gradient of the squared distance from a point and half its second derivatives (uu, uv, vv).
pub(super) struct Slopes {
    pub(super) gradient: Vector2<f64>,
    pub(super) bends: [f64; 3],
}

impl Slopes {
    pub(super) fn at(jet: &Jet, p: &Vec3) -> Self {
        let offset = jet.point - p;
        let along = jet.du.norm_squared() + offset.dot(&jet.duu);
        let mixed = jet.du.dot(&jet.dv) + offset.dot(&jet.duv);
        let across = jet.dv.norm_squared() + offset.dot(&jet.dvv);
        Self {
            gradient: Vector2::new(offset.dot(&jet.du), offset.dot(&jet.dv)),
            bends: [along, mixed, across],
        }
    }
}

/// A place on the way down.
pub(super) struct Descent<'a> {
    p: &'a Vec3,
    limits: [[f64; 2]; 2],
    /// The parameters, the surface there and its squared distance.
    pub(super) at: Vector2<f64>,
    pub(super) jet: Jet,
    pub(super) square: f64,
    damping: f64,
}

impl<'a> Descent<'a> {
    /// Begins at a place `at` of the surface, `jet`; the parameters stay within `limits`.
    pub(super) fn new(p: &'a Vec3, limits: [[f64; 2]; 2], at: [f64; 2], jet: Jet) -> Self {
        let square = (jet.point - p).norm_squared();
        Self { p, limits, at: Vector2::from(at), jet, square, damping: 0.0 }
    }

    /// Where the next step leads.
    pub(super) fn next(&self, Slopes { gradient, bends }: &Slopes) -> Vector2<f64> {
        // A parameter held at its limit does not move.
        let held = [0, 1].map(|k: usize| {
            let [low, high] = self.limits[k];
            (self.at[k] <= low && gradient[k] > 0.0) || (self.at[k] >= high && gradient[k] < 0.0)
        });
        let metric = Vector2::new(self.jet.du.norm_squared(), self.jet.dv.norm_squared());
        let step = step(*bends, gradient, held, &metric, self.damping);
        Vector2::from_fn(|k, _| (self.at[k] + step[k]).clamp(self.limits[k][0], self.limits[k][1]))
    }

    /// Whether a step moves the place at all.
    pub(super) fn moves(&self, next: &Vector2<f64>) -> bool {
        (next - self.at).norm() > RESOLUTION
    }

    /// Takes a step to `next`, where the surface is `there`, if it does not lead away, else damps the next one; whether the
    /// way goes on.
    pub(super) fn take(&mut self, next: Vector2<f64>, there: Jet) -> bool {
        let reached = (there.point - self.p).norm_squared();
        if reached > self.square {
            self.damping = if self.damping > 0.0 { RAISED * self.damping } else { FIRST_DAMPING };
            return self.damping <= MAX_DAMPING;
        }
        let settled = self.square - reached <= 0.0;
        (self.at, self.jet, self.square) = (next, there, reached);
        self.damping *= EASED;
        !settled
    }
}

/// Step of Newton's method, damped; where the second derivatives are no minimum's the metric takes their place.
fn step(
    [a, mixed, b]: [f64; 3],
    gradient: &Vector2<f64>,
    held: [bool; 2],
    metric: &Vector2<f64>,
    damping: f64,
) -> Vector2<f64> {
    let tiny = f64::MIN_POSITIVE;
    let single = |g: f64, bend: f64, m: f64| {
        let bend = if bend > FLAT * m { bend } else { m };
        -g / (bend + damping * m).max(tiny)
    };
    match held {
        [true, true] => Vector2::zeros(),
        [true, false] => Vector2::new(0.0, single(gradient.y, b, metric.y)),
        [false, true] => Vector2::new(single(gradient.x, a, metric.x), 0.0),
        [false, false] => {
            let (x, y) = (a + damping * metric.x, b + damping * metric.y);
            let determinant = x * y - mixed * mixed;
            if x > 0.0 && determinant > SINGULAR * metric.x * metric.y {
                let inverse = Matrix2::new(y, -mixed, -mixed, x) / determinant;
                -(inverse * gradient)
            } else {
                Vector2::new(single(gradient.x, a, metric.x), single(gradient.y, b, metric.y))
            }
        }
    }
}

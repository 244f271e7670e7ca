//! Contact inside the flat bottom, a flank, or the corner of a barrel: Newton's method for the two coordinates on the patch and the
//! multiplier of the nearest point at once.

use apt_geometry::Vec3;

use super::{Posed, ROUNDING, Start, Touch};
use crate::clearance::{
    tool::{self, Piece},
    waves::turned,
};

/// Bound of Newton's method: without convergence the general search takes over.
const MAX_ITERATIONS: u32 = 16;
/// A last step below this, in shares of the patch and of the radii of curvature, ends it: the normal then lies across the
/// straight line of the profile up to rounding.
const NEARLY: f64 = 1e-8;
/// Largest step of a coordinate, in radians or shares of the patch.
const LARGEST_STEP: f64 = 0.5;
/// Distance from a patch, in shares of it, from which no search comes back.
const FAR_OFF: f64 = 1.0;

/// Share of the squared bends of the distance that is rounding of their product.
const FLAT: f64 = 1e-9;

/// A place on a patch with the directions in which it is varied.
struct Spot {
    place: Vec3,
    /// Derivatives of the place by both coordinates.
    by: [Vec3; 2],
    /// Tangents along which the slope is to vanish.
    along: [Vec3; 2],
    /// Derivatives of these by the first coordinate.
    turning: [Vec3; 2],
    /// Derivative of the second one by the second coordinate.
    curving: Vec3,
}

/// Coordinates on a patch.
#[derive(Clone, Copy)]
enum Coordinates {
    /// On the flat bottom, from its middle, in radii of it.
    Flat([f64; 2]),
    /// Cosine and sine of the azimuth, and share of the straight line, or of the arc of a barrel, from its lower end.
    Line([f64; 2], f64),
}

impl Posed<'_> {
    /// The contact inside a patch from where it was last, seen from the tool end in the frame of the part.
    pub(super) fn touch_patch(&self, piece: &Piece, last: &Vec3, start: &Start) -> Option<Touch> {
        let [x, y] = [0, 1].map(|k| last.dot(&self.tool.across[k]));
        let mut at = match *piece {
            Piece::Disc { radius } if radius > 0.0 => Coordinates::Flat([x / radius, y / radius]),
            Piece::Frustum { height: [low, high], .. } if high <= low => return None,
            _ => {
                let share = piece.curve()?.share_at([x.hypot(y), last.dot(&self.tool.axis)]);
                Coordinates::Line(start.direction, share)
            }
        };
        let squares = *self.form.squares();
        let first = || self.spot(piece, at).map_or(self.tip, |spot| spot.place);
        let mut multiplier = self.first_multiplier(start, first);
        for _ in 0..MAX_ITERATIONS {
            let spot = self.spot(piece, at)?;
            let here = self.stationary(&spot.place, multiplier);
            if here.stretch.min() <= 0.0 {
                return None;
            }
            let (g, k) = (here.gradient, here.stretch);
            let bent = squares.component_mul(&k);
            // Slopes along both tangents and F, each with its derivatives by the coordinates and the multiplier.
            let row = |i: usize| {
                let by = |j: usize| bent.component_mul(&spot.by[j]).dot(&spot.along[i]);
                let turning = g.dot(&spot.turning[i]);
                let curving = if i == 1 { g.dot(&spot.curving) } else { 0.0 };
                Vec3::new(by(0) + turning, by(1) + curving, -bent.component_mul(&g).dot(&spot.along[i]))
            };
            let kg = k.component_mul(&g);
            let rows =
                [row(0), row(1), Vec3::new(kg.dot(&spot.by[0]), kg.dot(&spot.by[1]), -kg.dot(&g)) * 2.0];
            let left = [g.dot(&spot.along[0]), g.dot(&spot.along[1]), here.value];
            let [a, b, c] = [rows[1].cross(&rows[2]), rows[2].cross(&rows[0]), rows[0].cross(&rows[1])];
            let step = -(a * left[0] + b * left[1] + c * left[2]) / rows[0].dot(&a);
            if !step.iter().all(|x| x.is_finite()) {
                return None;
            }
            // Second derivatives of the distance, which is to be a least one.
            let bend = |i: usize, j: usize| self.side * (rows[i][j] - rows[i].z * rows[2][j] / rows[2].z);
            let (trace, mixed) = (bend(0, 0) + bend(1, 1), bend(0, 1) * bend(1, 0));
            let is_least = trace > 0.0 && bend(0, 0) * bend(1, 1) - mixed >= -FLAT * trace * trace;
            let near =
                step.x.abs() <= NEARLY && step.y.abs() <= NEARLY && step.z.abs() * bent.amax() <= NEARLY;
            let [p, q] = [step.x, step.y].map(|x| x.clamp(-LARGEST_STEP, LARGEST_STEP));
            at = match at {
                Coordinates::Flat([x, y]) => Coordinates::Flat([x + p, y + q]),
                Coordinates::Line(direction, share) => Coordinates::Line(turned(direction, p), share + q),
            };
            multiplier = self.limited(multiplier, multiplier + step.z);
            let is_far_off = match at {
                Coordinates::Flat([x, y]) => x.hypot(y) > 1.0 + FAR_OFF,
                Coordinates::Line(_, share) => !(-FAR_OFF..=1.0 + FAR_OFF).contains(&share),
            };
            if is_far_off || near && !is_least {
                return None;
            }
            if near {
                let place = self.spot(piece, at)?.place;
                let direction = match at {
                    Coordinates::Flat([x, y]) if x.hypot(y) <= 1.0 => start.direction,
                    Coordinates::Line(direction, share) if (-ROUNDING..=1.0).contains(&share) => direction,
                    _ => return None,
                };
                return Some(self.made(place, direction, multiplier, 0.0));
            }
        }
        None
    }

    fn spot(&self, piece: &Piece, at: Coordinates) -> Option<Spot> {
        match (piece, at) {
            (Piece::Disc { radius }, Coordinates::Flat([x, y])) => {
                let [u, v] = self.across.map(|w| w * *radius);
                let place = self.tip + u * x + v * y;
                let (along, turning) = (self.across, [Vec3::zeros(); 2]);
                Some(Spot { place, by: [u, v], along, turning, curving: Vec3::zeros() })
            }
            (piece, Coordinates::Line(direction, share)) => {
                let tool::Spot { place: [rho, height], way: [spread, rise], bend: [widening, climbing] } =
                    piece.curve()?.at(share);
                let (radial, tangent) = (self.radial(direction), self.radial([-direction[1], direction[0]]));
                let line = self.axis * rise + radial * spread;
                let place = self.tip + self.axis * height + radial * rho;
                let (by, along) = ([tangent * rho, line], [tangent, line]);
                let curving = radial * widening + self.axis * climbing;
                Some(Spot { place, by, along, turning: [-radial, tangent * spread], curving })
            }
            _ => None,
        }
    }
}

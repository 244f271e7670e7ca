//! Surfaces ruled by straight lines over piecewise cubic curves: the tabulated cylinder.

use apt_geometry::{Vec3, canonical::TabulatedCylinder};

use super::strip::{Cubic, Strip, Touch, tangent};

/// Cosine that two axes of a frame may have to each other: canonical forms are written with a few decimals.
const SKEW: f64 = 1e-5;
/// Parameter next to the end of a piece that counts as the joint with its neighbour.
const JOINT: f64 = 1e-7;

/// A tabulated cylinder: its directrix as cubics in the plane through the origin across the rulings.
#[derive(Debug, Clone)]
pub(super) struct Ruling {
    curve: Vec<Cubic>,
    /// Unit direction of the rulings.
    pub(super) axis: Vec3,
    /// Whether the end tangents meet when drawn out; then the curve ends where the definition ends it.
    closed: bool,
    /// Greatest distance of the curve from the origin.
    pub(super) size: f64,
}

fn cross(a: &Vec3, b: &Vec3, axis: &Vec3) -> f64 {
    axis.dot(&a.cross(b))
}

impl Ruling {
    /// None if the canonical form describes no curve.
    pub(super) fn of(surface: &TabulatedCylinder) -> Option<Self> {
        let axes = surface.axes;
        let unit = axes.iter().all(|a| a.iter().all(|x| x.is_finite()) && (a.norm() - 1.0).abs() <= SKEW);
        let square = (0..3).all(|i| axes[i].dot(&axes[(i + 1) % 3]).abs() <= SKEW);
        if !unit || !square {
            return None;
        }
        let axis = axes[2] / axes[2].norm();
        let along = axes[0] - axis * axis.dot(&axes[0]);
        let frame = [along / along.norm(), axis.cross(&along) / along.norm()];
        let mut curve = Vec::with_capacity(surface.intervals.len() + 2);
        for (k, interval) in surface.intervals.iter().enumerate() {
            let end = surface.intervals.get(k + 1).map_or(surface.last, |next| [next.u, next.v]);
            curve.push(cubic(&frame, [interval.u, interval.v], end, interval.a, interval.b)?);
        }
        let (first, last) = (curve.first()?, curve.last()?);
        let (start, end) = (first[0], last[3]);
        let (back, ahead) = (first[0] - first[1], last[3] - last[2]);
        // Where start + x·back and end + y·ahead meet.
        let turn = cross(&back, &ahead, &axis);
        let x = cross(&(end - start), &ahead, &axis) / turn;
        let y = cross(&(end - start), &back, &axis) / turn;
        let closed = x.is_finite() && y.is_finite() && x > 0.0 && y > 0.0;
        let size = curve.iter().flatten().map(|p| p.norm()).fold(0.0, f64::max);
        Some(Self { curve, axis, closed, size })
    }

    /// The pieces of the directrix in the plane through the origin.
    pub(super) fn pieces(&self) -> &[Cubic] {
        &self.curve
    }

    /// The surface as far as a tool of a certain reach can be concerned with it.
    pub(super) fn strips(&self, tip: &Vec3, reach: f64) -> Vec<Strip> {
        let height = self.axis * self.axis.dot(tip);
        let flat = tip - height;
        let raise = [height - self.axis * reach, height + self.axis * reach];
        let lift = |c: &Cubic| raise.map(|r| c.map(|p| p + r));
        let mut strips: Vec<Strip> =
            self.curve.iter().enumerate().map(|(piece, c)| Strip::new(lift(c), piece)).collect();
        if self.closed {
            return strips;
        }
        let last = self.curve.len() - 1;
        for (piece, end, before) in [(0, 0, 1), (last, 3, 2)] {
            let (from, inner) = (self.curve[piece][end], self.curve[piece][before]);
            let out = from - inner;
            let length = 2.0 * ((from - flat).norm() + reach) + out.norm();
            let step = out * (length / (3.0 * out.norm()));
            let ray = [from, from + step, from + step * 2.0, from + step * 3.0];
            let ray = if end == 0 { [ray[3], ray[2], ray[1], ray[0]] } else { ray };
            strips.push(Strip::new(lift(&ray), if end == 0 { self.curve.len() } else { last + 2 }));
        }
        strips
    }

    fn normal_at(&self, piece: usize, along: f64) -> Vec3 {
        let last = self.curve.len() - 1;
        let run = match piece {
            p if p <= last => tangent(&self.curve[p], along),
            p if p == last + 1 => self.curve[0][1] - self.curve[0][0],
            _ => self.curve[last][3] - self.curve[last][2],
        };
        let normal = self.axis.cross(&run);
        let size = normal.norm();
        if size > 0.0 { normal / size } else { normal }
    }

    /// The natural normal (−sin φ, cos φ) at a place; at a joint the middle between both sides. None at an end.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        let last = self.curve.len() - 1;
        let here = self.normal_at(touch.piece, touch.along);
        let (at_start, at_end) = (touch.along <= JOINT, touch.along >= 1.0 - JOINT);
        if touch.piece > last || !(at_start || at_end) {
            return Some(here);
        }
        let ends = (at_start && touch.piece == 0) || (at_end && touch.piece == last);
        if ends {
            return (!self.closed).then_some(here);
        }
        let beside = if at_start {
            self.normal_at(touch.piece - 1, 1.0)
        } else {
            self.normal_at(touch.piece + 1, 0.0)
        };
        let sum = here + beside;
        let size = sum.norm();
        Some(if size > 0.0 { sum / size } else { here })
    }
}

/// The cubic `v = s(s−L)(a(s+L)+b)` over the chord between two points, by its control points.
fn cubic(frame: &[Vec3; 2], start: [f64; 2], end: [f64; 2], a: f64, b: f64) -> Option<Cubic> {
    let lift = |p: [f64; 2]| frame[0] * p[0] + frame[1] * p[1];
    let (first, last) = (lift(start), lift(end));
    let chord = last - first;
    let length = chord.norm();
    if !(length > 0.0 && length.is_finite() && a.is_finite() && b.is_finite()) {
        return None;
    }
    let up = frame[0].cross(&frame[1]).cross(&(chord / length));
    let slopes = [-length * (a * length + b), length * (2.0 * a * length + b)];
    let third = length / 3.0;
    Some([
        first,
        first + chord / 3.0 + up * (slopes[0] * third),
        last - chord / 3.0 - up * (slopes[1] * third),
        last,
    ])
}

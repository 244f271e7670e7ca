//! The curves of ruled surfaces: the section of a surface with the plane of a chord, as a height over the chord
//! (language reference 4.16). Derived here from canonical forms alone.
//!
//! Along the direction across the chord a surface of second degree is met at the roots of `Aλ² + 2Bλ + C`, where A is the
//! same all along the chord: so one sign of the root is one branch of the section, and no step can change over to the other.

use apt_geometry::{
    Vec3,
    canonical::{
        Cone, Cylinder, Geometry, Quadric, RuledCurve,
        extent::{SECTION_BEYOND, SECTION_STEEP_BEYOND},
    },
};
use nalgebra::Matrix3;

use super::{
    ruling::Ruling,
    strip::{Cubic, place, tangent},
};

/// Size of the leading coefficient, relative to the others, below which the equation is linear.
const LINEAR: f64 = 1e-13;
/// How negative a discriminant may be for rounding, relative to its terms: at the ends of a half circle it vanishes.
const ROUNDING: f64 = 1e-9;
/// Steps in which a section is followed beyond each of its ends.
const STEPS: u32 = 32;
/// Share of the chord over which the slope at an upright end is measured, and by which slopes are taken inside.
const SLOPE_STEP: f64 = 1e-6;
const INSIDE: f64 = 1e-12;
/// Slope, in chords, above which an end is upright.
const UPRIGHT: f64 = 100.0;

/// Heights noted over the chord to tell the branches of a tabulated cylinder apart.
const NOTES: usize = 64;

/// What the lines across the chord are cut with.
#[derive(Debug, Clone)]
enum Cut {
    /// `x·Mx + 2 m·x + constant = 0`.
    /// On a cone only the nappe ahead of the vertex counts.
    Second { matrix: Matrix3<f64>, linear: Vec3, constant: f64, branch: f64, nappe: Option<[Vec3; 2]> },
    /// A curve in a plane with straight rulings through it; heights noted over the chord.
    Ruled { curve: Vec<Cubic>, axis: Vec3, notes: Vec<f64> },
}

/// Where a line across the chord meets the section.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    /// Height over the chord.
    height: f64,
    /// How it changes with the share of the chord.
    slope: f64,
}

/// A section curve over its chord, followed beyond its ends as long as it is not steep, and straight from there on.
#[derive(Debug, Clone)]
pub(super) struct Section {
    cut: Cut,
    start: Vec3,
    chord: Vec3,
    across: Vec3,
    /// First and last share of the chord up to which the surface itself is followed.
    pub(super) reach: [f64; 2],
}

fn second(matrix: Matrix3<f64>, linear: Vec3, constant: f64) -> Cut {
    Cut::Second { matrix, linear, constant, branch: 1.0, nappe: None }
}

fn round(c: &Cylinder) -> Option<Cut> {
    let axis = c.axis.try_normalize(0.0)?;
    let matrix = Matrix3::identity() - axis * axis.transpose();
    let linear = -(matrix * c.point);
    Some(second(matrix, linear, -linear.dot(&c.point) - c.radius * c.radius))
}

fn pointed(c: &Cone) -> Option<Cut> {
    let axis = c.axis.try_normalize(0.0)?;
    let matrix = axis * axis.transpose() - Matrix3::identity() * (c.cosine * c.cosine);
    let linear = -(matrix * c.vertex);
    let constant = -linear.dot(&c.vertex);
    Some(Cut::Second { matrix, linear, constant, branch: 1.0, nappe: Some([c.vertex, axis]) })
}

fn general(q: &Quadric) -> Cut {
    let [a, b, c, d, f, g, h, p, qq, r] = q.coefficients;
    second(Matrix3::new(a, h, g, h, b, f, g, f, c), Vec3::new(p, qq, r), d)
}

impl Cut {
    fn of(surface: &Geometry) -> Option<Self> {
        Some(match surface {
            Geometry::Line(p) | Geometry::Plane(p) => second(Matrix3::zeros(), p.normal * 0.5, -p.distance),
            Geometry::Circle(c) | Geometry::Cylinder(c) => round(c)?,
            Geometry::Cone(c) => pointed(c)?,
            Geometry::Sphere(s) => {
                second(Matrix3::identity(), -s.center, s.center.norm_squared() - s.radius * s.radius)
            }
            Geometry::Ellipse(q)
            | Geometry::Hyperbola(q)
            | Geometry::GeneralConic(q)
            | Geometry::LoftConic(q)
            | Geometry::Quadric(q) => general(q),
            Geometry::TabulatedCylinder(form) => {
                let ruling = Ruling::of(form)?;
                let curve = ruling.pieces().to_vec();
                Self::Ruled { curve, axis: ruling.axis, notes: Vec::new() }
            }
            _ => return None,
        })
    }
}

impl Section {
    /// None if the section does not reach from one end of the chord to the other, or the surface has no sections.
    pub(super) fn of(curve: &RuledCurve<'_>) -> Option<Self> {
        let across = curve.across.try_normalize(0.0)?;
        let chord = curve.end - curve.start;
        let cut = Cut::of(curve.surface)?;
        let mut section = Self { cut, start: curve.start, chord, across, reach: [0.0, 1.0] };
        section.choose()?;
        // The end points need not lie on the surface: the curve is what the direction across finds from the chord.
        section.height(0.0).zip(section.height(1.0))?;
        section.reach = [section.follow(0.0, -1.0), section.follow(1.0, 1.0)];
        Some(section)
    }

    /// Chooses the branch that the middle of the chord finds along the direction across, or behind if there is none.
    fn choose(&mut self) -> Option<()> {
        match self.cut.clone() {
            Cut::Second { .. } => {
                let heights = [1.0, -1.0].map(|b| (b, self.root(0.5, b)));
                let found = heights.into_iter().filter_map(|(b, found)| Some((b, found?.height)));
                // Ahead before behind, near before far.
                let key = |h: f64| (h < 0.0, h.abs());
                let best = found.min_by(|x, y| {
                    let (x, y) = (key(x.1), key(y.1));
                    x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
                })?;
                if let Cut::Second { branch, .. } = &mut self.cut {
                    *branch = best.0;
                }
            }
            Cut::Ruled { .. } => {
                let key = |h: f64| (h < 0.0, h.abs());
                let heights = self.crossings(0.5).into_iter().map(|crossing| crossing.height);
                let first = heights.min_by(|x, y| {
                    let (x, y) = (key(*x), key(*y));
                    x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
                })?;
                let share = |k: usize| k as f64 / NOTES as f64;
                let mut all = vec![first; NOTES + 1];
                let mut near = first;
                for k in (0..NOTES / 2).rev() {
                    near = nearest(self.crossings(share(k)), near)?.height;
                    all[k] = near;
                }
                near = first;
                for (k, note) in all.iter_mut().enumerate().skip(NOTES / 2 + 1) {
                    near = nearest(self.crossings(share(k)), near)?.height;
                    *note = near;
                }
                if let Cut::Ruled { notes, .. } = &mut self.cut {
                    *notes = all;
                }
            }
        }
        Some(())
    }

    /// How far beyond an end the section is followed.
    fn follow(&self, end: f64, sense: f64) -> f64 {
        let mut reached = end;
        for k in 1..=STEPS {
            let share = end + sense * SECTION_BEYOND * f64::from(k) / f64::from(STEPS);
            match self.crossing(share) {
                Some(found) if found.slope.abs() <= SECTION_STEEP_BEYOND * self.chord.norm() => {
                    reached = share;
                }
                _ => break,
            }
        }
        reached
    }

    fn root(&self, share: f64, branch: f64) -> Option<Crossing> {
        let Cut::Second { matrix, linear, constant, nappe, .. } = &self.cut else { return None };
        let x = self.start + self.chord * share;
        let v = &self.across;
        let mx = matrix * x;
        let a = v.dot(&(matrix * v));
        let b = v.dot(&(mx + linear));
        let c = x.dot(&mx) + 2.0 * linear.dot(&x) + constant;
        let size = matrix.amax();
        let root = if a.abs() <= LINEAR * size || size <= 0.0 {
            -c / (2.0 * b)
        } else {
            let discriminant = b * b - a * c;
            if discriminant < -ROUNDING * (b * b + (a * c).abs() + a * a * self.chord.norm_squared()) {
                return None;
            }
            let far = branch * discriminant.max(0.0).sqrt();
            if b * far <= 0.0 { (far - b) / a } else { -c / (b + far) }
        };
        let ahead = nappe.is_none_or(|[vertex, axis]| axis.dot(&(x + v * root - vertex)) >= 0.0);
        let chord = &self.chord;
        let slope = -(v.dot(&(matrix * chord)) * root + chord.dot(&(mx + linear))) / (a * root + b);
        (ahead && root.is_finite()).then_some(Crossing { height: root, slope })
    }

    /// Where the line across the chord meets the curve of a tabulated cylinder.
    fn crossings(&self, share: f64) -> Vec<Crossing> {
        let Cut::Ruled { curve, axis, .. } = &self.cut else { return Vec::new() };
        let flat = |x: Vec3| x - axis * axis.dot(&x);
        let (x, v) = (flat(self.start + self.chord * share), flat(self.across));
        let chord = flat(self.chord);
        let square = v.norm_squared();
        let side = axis.cross(&v);
        let mut found = Vec::new();
        for piece in curve {
            let off = |t: f64| side.dot(&(place(piece, t) - x));
            // A cubic has at most three roots; its control polygon is cut finely enough to tell them apart.
            let steps = 12;
            let mut before = (0.0, off(0.0));
            for k in 1..=steps {
                let t = f64::from(k) / f64::from(steps);
                let here = (t, off(t));
                if (before.1 <= 0.0) != (here.1 <= 0.0) {
                    let t = bisect(&off, before, here);
                    let run = tangent(piece, t);
                    let slope = v.dot(&(run * (side.dot(&chord) / side.dot(&run)) - chord)) / square;
                    found.push(Crossing { height: v.dot(&(place(piece, t) - x)) / square, slope });
                }
                before = here;
            }
        }
        found.retain(|crossing| crossing.height.is_finite());
        found
    }

    /// Where it is over a share of the chord; None where it is not.
    fn crossing(&self, share: f64) -> Option<Crossing> {
        match &self.cut {
            Cut::Second { branch, .. } => self.root(share, *branch),
            Cut::Ruled { notes, .. } => {
                let at = (share * NOTES as f64).clamp(0.0, NOTES as f64);
                let k = (at as usize).min(NOTES - 1);
                let (a, b) = (*notes.get(k)?, *notes.get(k + 1)?);
                nearest(self.crossings(share), a + (b - a) * (at - k as f64))
            }
        }
    }

    fn height(&self, share: f64) -> Option<f64> {
        self.crossing(share).map(|found| found.height)
    }

    /// How the height changes on the side of a share that is inside; at an upright end over a little way.
    fn slope(&self, share: f64, inward: f64) -> Option<f64> {
        let found = self.crossing(share + inward * INSIDE)?.slope;
        if found.abs() <= UPRIGHT * self.chord.norm() {
            return Some(found);
        }
        let step = inward * SLOPE_STEP;
        Some((self.height(share + step)? - self.height(share)?) / step)
    }

    /// How steep it is at a share, in chords; without bound where it stands upright over its chord.
    pub(super) fn steepness(&self, share: f64) -> f64 {
        let slope = self.crossing(share).map_or(f64::INFINITY, |found| found.slope.abs());
        if slope.is_nan() { f64::INFINITY } else { slope / self.chord.norm() }
    }

    /// How it runs on from a share of the chord, per share.
    pub(super) fn run(&self, share: f64) -> Option<Vec3> {
        let held = share.clamp(self.reach[0], self.reach[1]);
        let inward = if held < self.reach[1] { 1.0 } else { -1.0 };
        let run = self.chord + self.across * self.slope(held, inward)?;
        Some(if held == share { run } else { run * self.straight(&run) })
    }

    /// How much of its slope a section keeps where it goes on straight.
    fn straight(&self, run: &Vec3) -> f64 {
        let longest = (1.0 + SECTION_STEEP_BEYOND) * self.chord.norm();
        (longest / run.norm()).min(1.0)
    }

    /// The place at a share of the chord.
    pub(super) fn at(&self, share: f64) -> Option<Vec3> {
        let held = share.clamp(self.reach[0], self.reach[1]);
        let place = self.start + self.chord * held + self.across * self.height(held)?;
        if held == share {
            return Some(place);
        }
        let slope = self.slope(held, if share < held { 1.0 } else { -1.0 })?;
        let run = self.chord + self.across * slope;
        Some(place + run * self.straight(&run) * (share - held))
    }

    /// Shares of the chord at which the section may bend sharply.
    pub(super) fn joints(&self) -> Vec<f64> {
        let Cut::Ruled { curve, axis, .. } = &self.cut else { return Vec::new() };
        let normal = self.chord.cross(&self.across);
        let along = normal.dot(axis);
        let flat = self.across.cross(&normal);
        let share = |joint: &Vec3| {
            let place = joint + axis * (normal.dot(&(self.start - joint)) / along);
            flat.dot(&(place - self.start)) / flat.dot(&self.chord)
        };
        curve.iter().map(|piece| share(&piece[0])).filter(|s| s.is_finite()).collect()
    }
}

fn nearest(crossings: Vec<Crossing>, to: f64) -> Option<Crossing> {
    crossings.into_iter().min_by(|x, y| (x.height - to).abs().total_cmp(&(y.height - to).abs()))
}

/// The zero between two places of opposite sign.
fn bisect(off: &dyn Fn(f64) -> f64, mut low: (f64, f64), mut high: (f64, f64)) -> f64 {
    for turn in 0..100 {
        let secant = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
        let middle = 0.5 * (low.0 + high.0);
        let t = if turn % 3 == 2 || !(secant > low.0 && secant < high.0) { middle } else { secant };
        let value = off(t);
        if value == 0.0 || high.0 - low.0 <= 4.0 * f64::EPSILON {
            return t;
        }
        if (value <= 0.0) == (low.1 <= 0.0) {
            low = (t, value);
        } else {
            high = (t, value);
        }
    }
    0.5 * (low.0 + high.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::tests::{quadric, sphere, tabulated};

    /// On both branches of a section and on a tabulated curve.
    #[test]
    fn slopes_are_those_of_the_heights() {
        let ball = sphere([0.0, 0.3, -1.0], 4.0);
        let saddle = quadric([0.2, -0.15, 0.1, 0.3, 0.05, -0.1, 0.02, 0.1, -0.2, 0.6]);
        let wave = tabulated(
            [Vec3::x(), Vec3::y(), Vec3::z()],
            &[[-3.0, 0.4, 0.2], [-1.0, 0.1, -0.3], [1.0, 0.3, 0.4], [3.0, 0.2, 0.0]],
        );
        for (surface, across) in [
            (&ball, Vec3::new(0.1, 0.2, 1.0)),
            (&ball, Vec3::new(0.0, 0.0, -1.0)),
            (&saddle, Vec3::new(0.0, 0.3, 1.0)),
            (&wave, Vec3::new(0.0, 1.0, 0.2)),
        ] {
            let [start, end] = [Vec3::new(-1.6, 0.1, 0.2), Vec3::new(1.7, 0.2, 0.1)];
            let section =
                Section::of(&RuledCurve { surface, start, end, across }).expect("it joins the ends");
            for k in 1..=9 {
                let share = f64::from(k) / 10.0 + 0.013;
                let found = section.crossing(share).expect("it goes from end to end");
                let [before, after] =
                    [-1e-5, 1e-5].map(|step| section.height(share + step).expect("and beside"));
                let slope = (after - before) / 2e-5;
                assert!(
                    (found.slope - slope).abs() <= 1e-6 * (1.0 + slope.abs()),
                    "{share}: {found:?} {slope}"
                );
            }
        }
    }
}

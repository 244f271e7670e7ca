//! From part-program coordinates to a flat view, and boxes.

/// A point in part-program coordinates.
pub(super) type Point = [f64; 3];

/// An axis-parallel box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Bounds {
    /// The least box of points; None without points.
    pub(super) fn of(points: impl Iterator<Item = Point>) -> Option<Self> {
        points.fold(None, |all: Option<Self>, p| {
            let mut b = all.unwrap_or(Self { low: p, high: p });
            for (i, x) in p.into_iter().enumerate() {
                b.low[i] = b.low[i].min(x);
                b.high[i] = b.high[i].max(x);
            }
            Some(b)
        })
    }

    /// Length of the diagonal.
    pub(super) fn diagonal(&self) -> f64 {
        (0..3).map(|i| (self.high[i] - self.low[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// The box with a margin on every side.
    pub(super) fn grown(&self, by: f64) -> Self {
        Self { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }

    /// The eight corners.
    pub(super) fn corners(&self) -> [Point; 8] {
        std::array::from_fn(|k| [0, 1, 2].map(|i| if k >> i & 1 == 0 { self.low[i] } else { self.high[i] }))
    }

    /// The part of a segment inside the box.
    pub(super) fn clip(&self, a: Point, b: Point) -> Option<(Point, Point)> {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for i in 0..3 {
            let step = b[i] - a[i];
            let (to_low, to_high) = (self.low[i] - a[i], self.high[i] - a[i]);
            if step == 0.0 {
                if to_low > 0.0 || to_high < 0.0 {
                    return None;
                }
                continue;
            }
            let (enter, leave) =
                if step > 0.0 { (to_low / step, to_high / step) } else { (to_high / step, to_low / step) };
            first = first.max(enter);
            last = last.min(leave);
        }
        let at = |t: f64| [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]));
        (first < last).then(|| (at(first), at(last)))
    }
}

/// A view from infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// Its name.
    pub(super) name: &'static str,
    /// What is to the right, in part-program coordinates.
    pub(super) right: Point,
    /// What is up.
    pub(super) up: Point,
    /// The names of the axes to the right and up, for views along an axis.
    pub(super) axes: Option<[&'static str; 2]>,
}

/// 1/√2, 1/√6, 2/√6: the isometric directions.
const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
const SIXTH: f64 = 0.408_248_290_463_863;

/// The four views in the order of the drawing.
pub(super) const VIEWS: [View; 4] = [
    View { name: "Top", right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0], axes: Some(["X", "Y"]) },
    View { name: "Isometric", right: [HALF, HALF, 0.0], up: [-SIXTH, SIXTH, 2.0 * SIXTH], axes: None },
    View { name: "Front", right: [1.0, 0.0, 0.0], up: [0.0, 0.0, 1.0], axes: Some(["X", "Z"]) },
    View { name: "Right side", right: [0.0, 1.0, 0.0], up: [0.0, 0.0, 1.0], axes: Some(["Y", "Z"]) },
];

impl View {
    /// Right and up of a point.
    pub(super) fn flat(&self, p: Point) -> [f64; 2] {
        let dot = |a: Point| a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
        [dot(self.right), dot(self.up)]
    }
}

/// The next step of the series 1, 2, 5, 10 … at or above a positive length.
pub(super) fn round_step(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let digit = length / power;
    // The quotient of two equal powers may come out a hair above.
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| digit <= f * (1.0 + 1e-9)).unwrap_or(10.0);
    factor * power
}

/// A number of a scale with the digits its step needs.
pub(super) fn label(value: f64, step: f64) -> String {
    let digits = (-step.log10()).ceil().clamp(0.0, 9.0) as usize;
    let text = format!("{:.digits$}", if value.abs() < 1e-6 * step { 0.0 } else { value });
    if value.abs() >= 1e7 { format!("{value:.3e}") } else { text }
}

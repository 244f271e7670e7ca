//! Polyconic surfaces: conics in parallel planes whose control points and fullness follow polynomials of the station
//! (language reference 4.15).
//!
//! With square roots of the station the surface is followed by the signed root, so that it goes smoothly round a nose at
//! station 0. Each conic goes on straight beyond its ends, the family by [`POLYCONIC_STATIONS_BEYOND`] beyond its own. The nearest
//! point is found over a tree of cells, each bounded by a ball.

use nalgebra::{Matrix2, Matrix3, Vector2};

use super::{
    Foot, perpendicular,
    sheet::{Jet, ON_SURFACE, Rest},
};
use crate::{
    Vec3,
    canonical::{
        PolyConicForm,
        extent::{GREATEST_FULLNESS, LEAST_FULLNESS, POLYCONIC_ENDS_BEYOND, POLYCONIC_STATIONS_BEYOND},
    },
};

/// Cells along the stations and over a conic; each straight end has [`END_CELLS`] more.
const STATION_CELLS: usize = 24;
const CONIC_CELLS: usize = 12;
const END_CELLS: usize = 4;
/// Samples to each side of a cell for its radius.
const SAMPLES: u32 = 4;
/// Share by which a radius is enlarged for what lies between the samples.
const ENLARGED: f64 = 0.12;
/// First step, in halves of a cell, beyond which the nearest place is that of another cell.
const STRAYING: f64 = 6.0;
/// Distance of two places, in halves of a cell, at which they belong to one valley of the distance.
const SAME: f64 = 0.5;
/// Step of the parameters below which its effect on the distance is far below rounding.
const RESOLUTION: f64 = 1e-13;
/// Bound of the damped iteration for the nearest point.
const MAX_ITERATIONS: u32 = 40;
/// Distance from the surface, relative to its size, at which a crossing is looked for, and length of its longest step.
const CLOSE: f64 = 1e-4;
const NEAR: f64 = 1e-2;
/// Bound of the steps along a ray.
const MAX_STEPS: u32 = 4000;

/// A function of the parameter with two derivatives.
type Course = [f64; 3];

/// A rectangle of parameters and a ball that holds its part of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    center: Vec3,
    radius: f64,
    /// Middle of the rectangle, conic parameter and station parameter.
    middle: [f64; 2],
    /// Half its sides.
    half: [f64; 2],
}

/// A polyconic surface ready for distance questions.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyConicSheet {
    form: PolyConicForm,
    /// How many terms of each polynomial are not zero at the end.
    terms: [usize; 7],
    /// Ranges of the conic parameter and of the station parameter.
    limits: [[f64; 2]; 2],
    /// A complete binary tree: node `k` has children `2k+1` and `2k+2`; empty nodes have a radius below zero.
    cells: Vec<Cell>,
    size: f64,
    curvature: f64,
}

/// A point of a section plane with derivatives by the station parameter.
#[derive(Clone, Copy)]
struct Control([Vector2<f64>; 3]);

impl Control {
    fn of(y: Course, z: Course) -> Self {
        Self(std::array::from_fn(|k| Vector2::new(y[k], z[k])))
    }
}

impl PolyConicSheet {
    /// `None` if the values do not describe a surface.
    pub(super) fn new(values: &[f64]) -> Option<Self> {
        let form = PolyConicForm::read(values)?;
        let last = 1.0 + POLYCONIC_STATIONS_BEYOND;
        let stations = if form.roots.is_some() {
            [-last.sqrt(), last.sqrt()]
        } else {
            [-POLYCONIC_STATIONS_BEYOND, last]
        };
        let limits = [[-1.0, 2.0], stations];
        let terms = form.polynomials.map(|p| p.iter().rposition(|k| *k != 0.0).map_or(0, |last| last + 1));
        let mut sheet = Self { form, terms, limits, cells: Vec::new(), size: 0.0, curvature: 0.0 };
        sheet.grow();
        let finite = sheet.cells.iter().all(|c| c.center.iter().all(|x| x.is_finite()) && !c.radius.is_nan());
        (finite && sheet.size > 0.0).then_some(sheet)
    }

    /// A control function by the station parameter.
    fn course(&self, function: usize, s: f64) -> Course {
        let coefficients = self.form.polynomials.get(function).copied().unwrap_or_default();
        let terms = self.terms.get(function).copied().unwrap_or(0);
        let by_station = |d: f64| {
            let mut course = [0.0; 3];
            for k in coefficients.iter().take(terms).rev() {
                course[2] = course[2] * d + 2.0 * course[1];
                course[1] = course[1] * d + course[0];
                course[0] = course[0] * d + k;
            }
            course
        };
        match self.form.roots.as_ref().and_then(|roots| roots.get(function)) {
            None => by_station(s),
            Some(root) => {
                let [p, p1, p2] = by_station(s * s);
                [p + root * s, 2.0 * s * p1 + root, 2.0 * p1 + 4.0 * s * s * p2]
            }
        }
    }

    /// Weight of the middle control point of the conic, with derivatives.
    fn weight(&self, s: f64) -> Course {
        let [p, p1, p2] = self.course(6, s);
        let held = p.clamp(LEAST_FULLNESS, GREATEST_FULLNESS);
        let (p1, p2) = if held == p { (p1, p2) } else { (0.0, 0.0) };
        let rest = 1.0 - held;
        let slope = 0.5 / (rest * rest);
        [(2.0 * held - 1.0) / (2.0 * rest), slope * p1, slope * p2 + p1 * p1 / (rest * rest * rest)]
    }

    /// The three control points of the conic of a station.
    fn controls(&self, s: f64) -> [Control; 3] {
        let [a, b, c, d, l, h] = std::array::from_fn(|k| self.course(k, s));
        let sum = |x: Course, y: Course| -> Course { std::array::from_fn(|k| x[k] + y[k]) };
        let (y1, z1) = (sum(l, c), sum(h, b));
        [Control::of(l, h), Control::of(y1, z1), Control::of(sum(y1, a), sum(z1, d))]
    }

    /// The place of parameters in the surface's own coordinates: `u` runs along the conic, `v` along the stations.
    fn jet(&self, t: f64, s: f64) -> Jet {
        let [p0, p1, p2] = self.controls(s);
        let [flat, dt, ds, dtt, dts, dss] = if t < 0.0 {
            straight(&p0, &p1, t, 1.0)
        } else if t > 1.0 {
            straight(&p2, &p1, 1.0 - t, -1.0)
        } else {
            conic(&[p0, p1, p2], &self.weight(s), t)
        };
        let station: Course = match self.form.roots {
            Some(_) => [s * s, 2.0 * s, 2.0],
            None => [s, 1.0, 0.0],
        };
        let lift = |x: f64, flat: Vector2<f64>| Vec3::new(x, flat.x, flat.y);
        let length = self.form.length;
        // Before the nose the station falls with the parameter; the natural normal follows the station.
        let turned = if self.form.roots.is_some() && s < 0.0 { -1.0 } else { 1.0 };
        Jet {
            point: lift(self.form.base + length * station[0], flat),
            du: lift(0.0, dt),
            dv: lift(length * station[1], ds) * turned,
            duu: lift(0.0, dtt),
            duv: lift(0.0, dts) * turned,
            dvv: lift(length * station[2], dss),
        }
    }

    fn cell(&self, t: [f64; 2], s: [f64; 2]) -> Cell {
        let middle = [0.5 * (t[0] + t[1]), 0.5 * (s[0] + s[1])];
        let center = self.jet(middle[0], middle[1]).point;
        let mut radius: f64 = 0.0;
        for i in 0..=SAMPLES {
            for j in 0..=SAMPLES {
                let at = |range: [f64; 2], k: u32| {
                    range[0] + (range[1] - range[0]) * f64::from(k) / f64::from(SAMPLES)
                };
                radius = radius.max((self.jet(at(t, i), at(s, j)).point - center).norm());
            }
        }
        Cell {
            center,
            radius: radius * (1.0 + ENLARGED),
            middle,
            half: [0.5 * (t[1] - t[0]), 0.5 * (s[1] - s[0])],
        }
    }

    /// Cuts the surface into cells and builds the tree over them.
    fn grow(&mut self) {
        let even = |from: f64, to: f64, count: usize| -> Vec<[f64; 2]> {
            let at = |k: usize| from + (to - from) * k as f64 / count as f64;
            (0..count).map(|k| [at(k), at(k + 1)]).collect()
        };
        let [low, high] = self.limits[1];
        let mut conic = even(-1.0, 0.0, END_CELLS);
        conic.extend(even(0.0, 1.0, CONIC_CELLS));
        conic.extend(even(1.0, 2.0, END_CELLS));
        let stations = even(low, high, STATION_CELLS);
        let cells = halved(&conic, &stations);
        let leaves = cells.len().next_power_of_two();
        let empty = Cell { center: Vec3::zeros(), radius: -1.0, middle: [0.0; 2], half: [0.0; 2] };
        let mut nodes = vec![empty; leaves - 1];
        nodes.extend(cells.iter().map(|&(i, j)| self.cell(conic[i], stations[j])));
        nodes.resize(2 * leaves - 1, empty);
        for node in (0..leaves - 1).rev() {
            if let (Some(a), Some(b)) = (nodes.get(2 * node + 1), nodes.get(2 * node + 2)) {
                nodes[node] = joined(a, b);
            }
        }
        self.size = nodes.first().map_or(0.0, |root| root.radius + root.center.norm());
        for i in 0..=8 {
            for j in 0..=8 {
                let s = low + (high - low) * f64::from(j) / 8.0;
                let jet = self.jet(f64::from(i) / 8.0, s);
                if let Some(normal) = jet.natural(self.size) {
                    self.curvature = self.curvature.max(jet.greatest_curvature(&normal));
                }
            }
        }
        self.cells = nodes;
    }

    /// The nearest place to a point in the surface's own coordinates: squared distance and parameters.
    fn nearest(&self, p: &Vec3) -> (f64, [f64; 2]) {
        let mut best = (f64::INFINITY, [0.5, 0.5]);
        let mut open: Vec<(f64, usize)> = Vec::with_capacity(32);
        open.push((0.0, 0));
        let bound = |k: usize| {
            self.cells.get(k).filter(|c| c.radius >= 0.0).map(|c| ((p - c.center).norm() - c.radius, k))
        };
        while let Some((least, node)) = open.pop() {
            if least > 0.0 && least * least >= best.0 {
                continue;
            }
            match (bound(2 * node + 1), bound(2 * node + 2)) {
                (Some(a), Some(b)) if a.0 < b.0 => open.extend([b, a]),
                (Some(a), Some(b)) => open.extend([a, b]),
                (Some(a), None) | (None, Some(a)) => open.push(a),
                (None, None) => {
                    if let Some(cell) = self.cells.get(node) {
                        self.descend(p, cell, &mut best);
                    }
                }
            }
        }
        best
    }

    /// Half the gradient of the squared distance at parameters and half its second derivatives: tt, ts, ss.
    fn slopes(&self, p: &Vec3, q: &Vector2<f64>, jet: &Jet) -> (Vector2<f64>, [f64; 3]) {
        let offset = jet.point - p;
        let turned = if self.form.roots.is_some() && q.y < 0.0 { -1.0 } else { 1.0 };
        let gradient = Vector2::new(offset.dot(&jet.du), offset.dot(&jet.dv) * turned);
        let along = jet.du.norm_squared() + offset.dot(&jet.duu);
        let across = jet.dv.norm_squared() + offset.dot(&jet.dvv);
        (gradient, [along, (jet.du.dot(&jet.dv) + offset.dot(&jet.duv)) * turned, across])
    }

    /// Goes down to the nearest place from the middle of a cell, by Newton's method damped so that every step descends.
    fn descend(&self, p: &Vec3, cell: &Cell, best: &mut (f64, [f64; 2])) {
        let [[t0, t1], [s0, s1]] = self.limits;
        let mut q = Vector2::from(cell.middle);
        let mut jet = self.jet(q.x, q.y);
        let mut square = (jet.point - p).norm_squared();
        let mut damping = 0.0;
        for turn in 0..MAX_ITERATIONS {
            let (gradient, bends) = self.slopes(p, &q, &jet);
            // A parameter held at its limit does not move.
            let held = [
                (q.x <= t0 && gradient.x > 0.0) || (q.x >= t1 && gradient.x < 0.0),
                (q.y <= s0 && gradient.y > 0.0) || (q.y >= s1 && gradient.y < 0.0),
            ];
            let metric = Vector2::new(jet.du.norm_squared(), jet.dv.norm_squared());
            let step = descent(bends, &gradient, held, &metric, damping);
            let next = Vector2::new((q.x + step.x).clamp(t0, t1), (q.y + step.y).clamp(s0, s1));
            // From the middle of its cell a nearest place is not many cells away: another cell has that one.
            let strays = |moved: f64, half: f64| moved.abs() > STRAYING * half;
            let moved = next - q;
            if turn == 0
                && best.0 < square
                && (strays(moved.x, cell.half[0]) || strays(moved.y, cell.half[1]))
            {
                return;
            }
            // A step to where the nearest place so far is leads to that place again.
            let known = |k: usize| (next[k] - best.1[k]).abs() <= SAME * cell.half[k];
            if turn == 0 && best.0 < square && known(0) && known(1) {
                return;
            }
            if moved.norm() <= RESOLUTION {
                break;
            }
            let there = self.jet(next.x, next.y);
            let reached = (there.point - p).norm_squared();
            if reached <= square {
                let settled = square - reached <= 0.0;
                (q, jet, square, damping) = (next, there, reached, 0.2 * damping);
                if settled {
                    break;
                }
            } else {
                damping = if damping > 0.0 { 4.0 * damping } else { 1e-3 };
                if damping > 1e12 {
                    break;
                }
            }
        }
        if square < best.0 {
            *best = (square, [q.x, q.y]);
        }
    }

    /// Foot on the conics themselves in the surface's own coordinates.
    fn place(&self, p: &Vec3) -> (Foot, Jet, Rest) {
        let (_, [t, s]) = self.nearest(p);
        let jet = self.jet(t, s);
        let [[t0, t1], [s0, s1]] = self.limits;
        // On the surface itself the offset is rounding and says nothing.
        let on_surface = (p - jet.point).norm() <= ON_SURFACE * self.size;
        let rest = match (t <= t0 || t >= t1, s <= s0 || s >= s1) {
            _ if on_surface => Rest::Inside,
            (false, false) => Rest::Inside,
            (true, false) => Rest::AlongV,
            (false, true) => Rest::AlongU,
            (true, true) => Rest::Corner,
        };
        let inner = [t + 1e-5 * (0.5 - t), if s.abs() < 1e-5 { 1e-5 } else { s }];
        let natural = jet
            .natural(self.size)
            .or_else(|| self.jet(inner[0], inner[1]).natural(1e-7 * self.size))
            .unwrap_or_else(|| jet.du.try_normalize(0.0).map_or_else(Vec3::x, |du| perpendicular(&du)));
        (jet.foot(p, rest, &natural, self.size), jet, rest)
    }

    /// From the surface's own coordinates, with its thickness.
    fn outside(&self, p: &Vec3, own: &Foot) -> Foot {
        let normal = self.form.map.linear().tr_mul(&own.normal);
        let distance = own.distance - self.form.thickness;
        Foot { distance, point: p - normal * distance, normal }
    }

    pub(super) fn foot(&self, p: &Vec3) -> Foot {
        self.outside(p, &self.place(&self.form.map.apply_point(p)).0)
    }

    pub(super) fn foot_and_hessian(&self, p: &Vec3) -> (Foot, Matrix3<f64>) {
        let (own, jet, rest) = self.place(&self.form.map.apply_point(p));
        let linear = self.form.map.linear();
        let hessian = linear.tr_mul(&(jet.hessian(&own, rest) * linear));
        (self.outside(p, &own), hessian)
    }

    /// Greatest absolute value of a principal curvature of the conics' surface, 1/length.
    pub fn greatest_curvature(&self) -> f64 {
        self.curvature
    }

    /// Parameters of the crossings of a ray with the surface, in units of |direction|: from foot to foot, never farther
    /// than the surface is away.
    pub(super) fn ray_roots(&self, from: &Vec3, direction: &Vec3) -> Vec<f64> {
        let mut roots = Vec::new();
        let (length, Some(root)) = (direction.norm(), self.cells.first()) else { return roots };
        if length <= 0.0 {
            return roots;
        }
        let unit = direction / length;
        let start = self.form.map.apply_point(from);
        let ahead = self.form.map.apply_vector(&unit);
        let w = root.center - start;
        let (along, reach) = (w.dot(&ahead), root.radius + self.form.thickness.abs());
        let half = reach * reach - (w - ahead * along).norm_squared();
        if half < 0.0 {
            return roots;
        }
        let (mut x, last) = (along - half.sqrt(), along + half.sqrt());
        let near = CLOSE * self.size;
        for _ in 0..MAX_STEPS {
            if x > last {
                break;
            }
            let distance = self.foot(&(from + unit * x)).distance.abs();
            if distance > near {
                x += distance;
            } else {
                if let Some(found) = self.settle(from, &unit, x) {
                    roots.push(found);
                }
                x += near;
            }
        }
        roots.sort_by(f64::total_cmp);
        roots.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * self.size);
        roots.iter().map(|root| root / length).collect()
    }

    /// Newton's method for the crossing near a place on a ray.
    fn settle(&self, from: &Vec3, unit: &Vec3, start: f64) -> Option<f64> {
        let mut x = start;
        for _ in 0..MAX_ITERATIONS {
            let foot = self.foot(&(from + unit * x));
            let slope = foot.normal.dot(unit);
            if foot.distance.abs() <= 1e-14 * self.size {
                return Some(x);
            }
            let step = foot.distance / slope;
            if step.is_nan() || step.abs() > NEAR * self.size {
                return None;
            }
            x -= step;
            if step.abs() <= 1e-14 * (self.size + x.abs()) {
                return Some(x);
            }
        }
        None
    }
}

/// A straight end: from a control point away from where the end tangents meet. `x` is negative; it grows with the
/// parameter in the given sense.
fn straight(end: &Control, meet: &Control, x: f64, sense: f64) -> [Vector2<f64>; 6] {
    let way: [Vector2<f64>; 3] = std::array::from_fn(|k| (meet.0[k] - end.0[k]) * POLYCONIC_ENDS_BEYOND);
    let at = |k: usize| end.0[k] + way[k] * x;
    [at(0), way[0] * sense, at(1), Vector2::zeros(), way[1] * sense, at(2)]
}

/// The rational conic with its derivatives: value, t, s, tt, ts, ss.
fn conic(controls: &[Control; 3], weight: &Course, t: f64) -> [Vector2<f64>; 6] {
    let r = 1.0 - t;
    // Basis by t: value, first, second derivative.
    let basis = [[r * r, 2.0 * t * r, t * t], [-2.0 * r, 2.0 - 4.0 * t, 2.0 * t], [2.0, -4.0, 2.0]];
    // Weighted middle point with derivatives by s.
    let [w, w1, w2] = *weight;
    let [p, p1, p2] = controls[1].0;
    let middle = [p * w, p1 * w + p * w1, p2 * w + p1 * (2.0 * w1) + p * w2];
    let numerator = |i: usize, k: usize| {
        controls[0].0[k] * basis[i][0] + middle[k] * basis[i][1] + controls[2].0[k] * basis[i][2]
    };
    let denominator = |i: usize, k: usize| {
        let ends = if k == 0 { basis[i][0] + basis[i][2] } else { 0.0 };
        ends + weight[k] * basis[i][1]
    };
    let d = denominator(0, 0);
    let (dt, ds) = (denominator(1, 0), denominator(0, 1));
    let value = numerator(0, 0) / d;
    let by_t = (numerator(1, 0) - value * dt) / d;
    let by_s = (numerator(0, 1) - value * ds) / d;
    let tt = (numerator(2, 0) - value * denominator(2, 0) - by_t * (2.0 * dt)) / d;
    let ts = (numerator(1, 1) - value * denominator(1, 1) - by_t * ds - by_s * dt) / d;
    let ss = (numerator(0, 2) - value * denominator(0, 2) - by_s * (2.0 * ds)) / d;
    [value, by_t, by_s, tt, ts, ss]
}

/// Step of Newton's method, damped; where the second derivatives are no minimum's the metric takes their place.
fn descent(
    [a, mixed, b]: [f64; 3],
    gradient: &Vector2<f64>,
    held: [bool; 2],
    metric: &Vector2<f64>,
    damping: f64,
) -> Vector2<f64> {
    let tiny = f64::MIN_POSITIVE;
    let single = |g: f64, bend: f64, m: f64| {
        let bend = if bend > 1e-9 * m { bend } else { m };
        -g / (bend + damping * m).max(tiny)
    };
    match held {
        [true, true] => Vector2::zeros(),
        [true, false] => Vector2::new(0.0, single(gradient.y, b, metric.y)),
        [false, true] => Vector2::new(single(gradient.x, a, metric.x), 0.0),
        [false, false] => {
            let (x, y) = (a + damping * metric.x, b + damping * metric.y);
            let determinant = x * y - mixed * mixed;
            if x > 0.0 && determinant > 1e-14 * metric.x * metric.y {
                let inverse = Matrix2::new(y, -mixed, -mixed, x) / determinant;
                -(inverse * gradient)
            } else {
                Vector2::new(single(gradient.x, a, metric.x), single(gradient.y, b, metric.y))
            }
        }
    }
}

/// Index pairs of a grid, ordered by halving the longer side, so that neighbours in the list are neighbours in the grid.
fn halved(rows: &[[f64; 2]], columns: &[[f64; 2]]) -> Vec<(usize, usize)> {
    let mut cells = Vec::with_capacity(rows.len() * columns.len());
    let mut open = vec![(0, rows.len(), 0, columns.len())];
    while let Some((i, m, j, n)) = open.pop() {
        if m == 1 && n == 1 {
            cells.push((i, j));
        } else if m >= n {
            open.extend([(i + m / 2, m - m / 2, j, n), (i, m / 2, j, n)]);
        } else {
            open.extend([(i, m, j + n / 2, n - n / 2), (i, m, j, n / 2)]);
        }
    }
    cells
}

/// The smallest ball about two.
fn joined(a: &Cell, b: &Cell) -> Cell {
    let apart = (b.center - a.center).norm();
    if b.radius < 0.0 || a.radius >= apart + b.radius {
        return *a;
    }
    if a.radius < 0.0 || b.radius >= apart + a.radius {
        return *b;
    }
    let radius = 0.5 * (apart + a.radius + b.radius);
    let center = a.center + (b.center - a.center) * ((radius - a.radius) / apart);
    Cell { center, radius, ..*a }
}

//! Polyconic surfaces: conics in parallel planes whose control points and fullness follow polynomials of the station
//! (language reference 4.15).
//!
//! With square roots of the station the surface is followed by the signed root, so that it goes smoothly round a nose at
//! station 0. Each conic goes on straight beyond its ends, the family by [`POLYCONIC_STATIONS_BEYOND`] beyond its own. The nearest
//! point is found over a tree of cells, each bounded by a ball.

mod bounds;
mod chord;
mod ends;
mod section;
mod tree;

use std::sync::{Arc, OnceLock};

use nalgebra::Matrix3;

use self::{
    section::{Control, Flat, controls, section, weight},
    tree::{halved, joined},
};
use super::{
    Chart, Foot, Place, Surface,
    apart::{Apart, AtEnds, Beside, Body, HalfSpace, Limit, Nearer},
    descent::{Descent, MAX_STEPS, Slopes},
    part::{Count, Part, Rectangle, Summary},
    perpendicular,
    sheet::{Jet, Landing, ON_SURFACE, Rest, at_limits},
};
use crate::{
    Vec3,
    canonical::{
        Made, PolyConicForm,
        extent::{GREATEST_FULLNESS, LEAST_FULLNESS, POLYCONIC_STATIONS_BEYOND},
    },
    patience::Patience,
};

/// Cells along the stations and over a conic; each straight end has [`END_CELLS`] more.
const STATION_CELLS: usize = 24;
const CONIC_CELLS: usize = 12;
const END_CELLS: usize = 4;
/// Units of work that it takes to bound a cell.
const UNITS_A_CELL: u32 = 8;
/// First step, in halves of a cell, beyond which the nearest place is that of another cell.
const STRAYING: f64 = 6.0;
/// Distance of two places, in halves of a cell, at which they belong to one valley of the distance.
const SAME: f64 = 0.5;
/// Bound of the iteration for a crossing.
const MAX_ITERATIONS: u32 = 40;
/// Distance from the surface, relative to its size, at which a crossing is looked for, and length of its longest step.
const CLOSE: f64 = 1e-4;
const NEAR: f64 = 1e-2;
/// Bound of the steps along a ray.
const MAX_STRIDES: u32 = 4000;

/// A function of the parameter with two derivatives.
type Course<T = f64> = [T; 3];

/// A rectangle of parameters and a ball that holds its part of the surface.
#[derive(Debug, Clone, PartialEq)]
struct Cell {
    center: Vec3,
    radius: f64,
    /// Middle of the rectangle, conic parameter and station parameter.
    middle: [f64; 2],
    /// Half its sides.
    half: [f64; 2],
    /// The curvature of a leaf.
    part: Option<Box<Part>>,
    /// That of all leaves below.
    summary: Option<Summary>,
}

/// A polyconic surface ready for distance questions.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyConicSheet {
    form: PolyConicForm,
    /// The form's rigid motion: its linear part, what it adds, and −1 if it mirrors.
    linear: Matrix3<f64>,
    origin: Vec3,
    sense: f64,
    /// How many terms of each polynomial are not zero at the end.
    terms: [usize; 7],
    /// Ranges of the conic parameter and of the station parameter.
    limits: [[f64; 2]; 2],
    /// A complete binary tree: node `k` has children `2k+1` and `2k+2`; empty nodes have a radius below zero.
    cells: Arc<Vec<Cell>>,
    size: f64,
    curvature: f64,
    /// Parts with bounds.
    parts: Count,
    /// The side that what is beyond the end counts for, as a tool on that side meets the surface; otherwise that of the tangent plane.
    beyond: Option<f64>,
    /// What a tool meets on either side: first that of the natural normal. Made where it is asked for.
    met: [OnceLock<Box<Surface>>; 2],
}

impl Made for PolyConicSheet {
    fn parts(&self) -> usize {
        self.parts.get()
    }
}

impl PolyConicSheet {
    /// `None` if the values do not describe a surface.
    pub(super) fn new(values: &[f64], patience: Patience<'_>) -> Option<Self> {
        let form = PolyConicForm::read(values)?;
        let last = 1.0 + POLYCONIC_STATIONS_BEYOND;
        let stations = if form.roots.is_some() {
            [-last.sqrt(), last.sqrt()]
        } else {
            [-POLYCONIC_STATIONS_BEYOND, last]
        };
        let limits = [[-1.0, 2.0], stations];
        let terms = form.polynomials.map(|p| p.iter().rposition(|k| *k != 0.0).map_or(0, |last| last + 1));
        let (linear, origin) = (form.map.linear(), form.map.apply_point(&Vec3::zeros()));
        let sense = linear.determinant().signum();
        let cells = Arc::default();
        let mut sheet = Self {
            form,
            linear,
            origin,
            sense,
            terms,
            limits,
            cells,
            size: 0.0,
            curvature: 0.0,
            parts: Count::default(),
            beyond: None,
            met: Default::default(),
        };
        sheet.grow(patience)?;
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
        weight(if held == p { [p, p1, p2] } else { [held, 0.0, 0.0] })
    }

    /// The place of parameters in the surface's own coordinates: `u` runs along the conic, `v` along the stations.
    fn jet(&self, t: f64, s: f64) -> Jet {
        let controls = controls(std::array::from_fn(|k| self.course(k, s)));
        let [flat, dt, ds, dtt, dts, dss] = section(&controls, &self.weight(s), t, [t < 0.0, t > 1.0]);
        let station = self.station(s);
        let lift = |x: f64, flat: Flat<f64>| Vec3::new(x, flat[0], flat[1]);
        let length = self.form.length;
        let turned = self.turned(s);
        Jet {
            point: lift(self.form.base + length * station[0], flat),
            du: lift(0.0, dt),
            dv: lift(length * station[1], ds) * turned,
            duu: lift(0.0, dtt),
            duv: lift(0.0, dts) * turned,
            dvv: lift(length * station[2], dss),
        }
    }

    /// The station of a station parameter.
    fn station(&self, s: f64) -> Course {
        match self.form.roots {
            Some(_) => [s * s, 2.0 * s, 2.0],
            None => [s, 1.0, 0.0],
        }
    }

    /// Before the nose the station falls with the parameter; the natural normal follows the station.
    fn turned(&self, s: f64) -> f64 {
        if self.form.roots.is_some() && s < 0.0 { -1.0 } else { 1.0 }
    }

    fn cell(&self, t: [f64; 2], s: [f64; 2]) -> Cell {
        let rectangle = Rectangle::between(t, s);
        let part = Part::new(self, rectangle);
        let Rectangle { middle, half } = rectangle;
        let (center, radius, summary) = (*part.center(), part.radius(), Some(Summary::of(&part)));
        Cell { center, radius, middle, half, part: Some(Box::new(part)), summary }
    }

    /// Cuts the surface into cells and builds the tree over them.
    fn grow(&mut self, patience: Patience<'_>) -> Option<()> {
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
        let empty = Cell {
            center: Vec3::zeros(),
            radius: -1.0,
            middle: [0.0; 2],
            half: [0.0; 2],
            part: None,
            summary: None,
        };
        let mut nodes = vec![empty.clone(); leaves - 1];
        for &(i, j) in &cells {
            if patience.ends_after(UNITS_A_CELL) {
                return None;
            }
            nodes.push(self.cell(conic[i], stations[j]));
        }
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
        self.cells = Arc::new(nodes);
        Some(())
    }

    /// The nearest place to a point in the surface's own coordinates: squared distance and parameters.
    fn nearest(&self, p: &Vec3) -> (f64, [f64; 2]) {
        let mut best = (f64::INFINITY, [0.5, 0.5]);
        let mut open: Vec<(f64, usize)> = Vec::with_capacity(32);
        open.push((0.0, 0));
        let bound = |k: usize| {
            let cell = self.cells.get(k).filter(|c| c.radius >= 0.0)?;
            let ball = || (p - cell.center).norm() - cell.radius;
            Some((cell.part.as_ref().map_or_else(ball, |part| part.bound(p)), k))
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

    /// Half the gradient of the squared distance at parameters and half its second derivatives.
    fn slopes(&self, p: &Vec3, descent: &Descent<'_>) -> Slopes {
        let mut slopes = Slopes::at(&descent.jet, p);
        if self.form.roots.is_some() && descent.at.y < 0.0 {
            slopes.gradient.y = -slopes.gradient.y;
            slopes.bends[1] = -slopes.bends[1];
        }
        slopes
    }

    /// Goes down to the nearest place from the middle of a cell.
    fn descend(&self, p: &Vec3, cell: &Cell, best: &mut (f64, [f64; 2])) {
        let mut descent = Descent::new(p, self.limits, cell.middle, self.jet(cell.middle[0], cell.middle[1]));
        for turn in 0..MAX_STEPS {
            let next = descent.next(&self.slopes(p, &descent));
            // From the middle of its cell a nearest place is not many cells away: another cell has that one.
            let strays = |k: usize| (next[k] - descent.at[k]).abs() > STRAYING * cell.half[k];
            // A step to where the nearest place so far is leads to that place again.
            let known = |k: usize| (next[k] - best.1[k]).abs() <= SAME * cell.half[k];
            if turn == 0 && best.0 < descent.square && (strays(0) || strays(1) || (known(0) && known(1))) {
                return;
            }
            if !descent.moves(&next) || !descent.take(next, self.jet(next.x, next.y)) {
                break;
            }
        }
        if descent.square < best.0 {
            *best = (descent.square, [descent.at.x, descent.at.y]);
        }
    }

    /// Foot on the conics themselves in the surface's own coordinates.
    fn place(&self, p: &Vec3) -> Landing {
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
        Landing { foot: jet.foot(p, rest, (&natural, self.beyond), self.size), jet, rest }
    }

    /// From the surface's own coordinates, with its thickness.
    fn outside(&self, p: &Vec3, own: &Foot) -> Foot {
        let normal = self.form.map.linear().tr_mul(&own.normal);
        let distance = own.distance - self.form.thickness;
        Foot { distance, point: p - normal * distance, normal }
    }

    pub(super) fn foot(&self, p: &Vec3) -> Foot {
        self.outside(p, &self.place(&self.form.map.apply_point(p)).foot)
    }

    pub(super) fn foot_and_hessian(&self, p: &Vec3) -> (Foot, Matrix3<f64>) {
        let (own, hessian) = self.place(&self.form.map.apply_point(p)).with_hessian();
        let linear = self.form.map.linear();
        let hessian = linear.tr_mul(&(hessian * linear));
        (self.outside(p, &own), hessian)
    }

    /// The surface as a tool on a side meets it: what is beyond the end is not behind it.
    pub(super) fn met_from(&self, side: f64) -> &Surface {
        self.met[usize::from(side < 0.0)].get_or_init(|| {
            let sheet = Self { beyond: Some(side), met: Default::default(), ..self.clone() };
            Box::new(Surface::PolyConic(Arc::new(sheet)))
        })
    }

    /// Whether the nearest place lies at an end of a conic or of the stations.
    pub(super) fn ends_at(&self, p: &Vec3) -> bool {
        let (_, at) = self.nearest(&self.form.map.apply_point(p));
        at_limits(at, self.limits).contains(&true)
    }

    pub(super) fn place_near(&self, p: &Vec3) -> Place {
        let (_, at) = self.nearest(&self.form.map.apply_point(p));
        Place { piece: 0, at }
    }

    /// Whether all cells are farther from a point than a distance.
    pub(super) fn keeps_off(&self, p: &Vec3, distance: f64) -> bool {
        let own = self.form.map.apply_point(p);
        let distance = distance + self.form.thickness.abs();
        let mut open = vec![0usize];
        while let Some(node) = open.pop() {
            let Some(cell) = self.cells.get(node).filter(|cell| cell.radius >= 0.0) else { continue };
            if (own - cell.center).norm() - cell.radius > distance {
                continue;
            }
            if 2 * node + 1 >= self.cells.len() {
                return false;
            }
            open.extend([2 * node + 2, 2 * node + 1]);
        }
        true
    }

    /// A distance from a body, not below the one wanted, that all cells keep: the nearest first, after which others add nothing.
    pub(super) fn keeps_apart(
        &self,
        body: Body<'_>,
        wanted: f64,
        limit: Limit<'_>,
    ) -> Result<f64, Option<Nearer>> {
        let own = |p: &Vec3| {
            let (distance, outward) = (body.away)(&self.linear.tr_mul(&(p - self.origin)));
            (distance, self.linear * outward)
        };
        let in_frame = |HalfSpace { outward, level }: HalfSpace| {
            let outward = self.linear * outward;
            HalfSpace { outward, level: level + outward.dot(&self.origin) }
        };
        let within = body.within.map(in_frame);
        let beside = body.beside.map(|beside| {
            move |out: &Vec3, normal: &Vec3| {
                in_frame(beside(&self.linear.tr_mul(out), &self.linear.tr_mul(normal)))
            }
        });
        let beside = beside.as_ref().map(|beside| beside as &Beside<'_>);
        let at_ends = body.at_ends.map(|at_ends| {
            move |p: &Vec3| {
                at_ends(&self.linear.tr_mul(&(p - self.origin)))
                    .map(|(distance, outward)| (distance, self.linear * outward))
            }
        });
        let at_ends = at_ends.as_ref().map(|at_ends| at_ends as &AtEnds<'_>);
        let stock = self.form.thickness.abs();
        let limit = Limit { enough: limit.enough + stock, ..limit };
        let mut asked = Apart::new(Body { away: &own, within, beside, at_ends }, wanted + stock, limit);
        let look = |asked: &mut Apart<'_>, node: usize| {
            let cell = self.cells.get(node).filter(|cell| cell.radius >= 0.0)?;
            Some((asked.ball(&cell.center, cell.radius), node))
        };
        let mut open: Vec<_> = look(&mut asked, 0).into_iter().collect();
        while let Some((least, node)) = open.pop() {
            if asked.is_settled(least) {
                continue;
            }
            match [2 * node + 1, 2 * node + 2].map(|child| look(&mut asked, child)) {
                [Some(a), Some(b)] if a.0 < b.0 => open.extend([b, a]),
                [None, None] => {
                    let part = self.cells.get(node).and_then(|cell| cell.part.as_ref());
                    if !part.is_some_and(|part| part.keeps_apart(self, &mut asked, 0)) {
                        let in_place = |near: Nearer| Nearer {
                            place: self.linear.tr_mul(&(near.place - self.origin)),
                            ..near
                        };
                        return Err(asked.nearer(stock).map(in_place));
                    }
                }
                children => open.extend(children.into_iter().flatten()),
            }
        }
        asked.kept().map(|kept| kept - stock).ok_or(None)
    }

    pub(super) fn chart(&self, place: &Place) -> Option<Chart> {
        let own = self.jet(place.at[0], place.at[1]);
        let back = |v: &Vec3| self.linear.tr_mul(v);
        let point = back(&(own.point - self.origin));
        let jet = Jet {
            point,
            du: back(&own.du),
            dv: back(&own.dv),
            duu: back(&own.duu),
            duv: back(&own.duv),
            dvv: back(&own.dvv),
        };
        Some(Chart::new(&jet, self.sense, self.form.thickness))
    }

    pub(super) fn shifted(&self, place: &Place, step: [f64; 2]) -> Option<Place> {
        let at = [place.at[0] + step[0], place.at[1] + step[1]];
        let inside = at.iter().zip(&self.limits).all(|(x, [low, high])| x > low && x < high);
        // Beyond the nose the natural normal is the opposite one.
        let over = self.form.roots.is_some() && (at[1] < 0.0) != (place.at[1] < 0.0);
        (inside && !over).then_some(Place { piece: 0, at })
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
        for _ in 0..MAX_STRIDES {
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

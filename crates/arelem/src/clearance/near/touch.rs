//! Newton's method for the stationary distance of a piece of the tool: of a circle, of the flat bottom, and of a slanted piece.

use apt_geometry::{Vec3, surface::Chart};

use super::{Circle, Pose, Start, Touch};
use crate::clearance::{
    Contact, Tool,
    tool::{Curve, Piece, Spot},
    waves::{length, turned},
};

/// Bound of Newton's method: without convergence the general search takes over.
const MAX_ITERATIONS: u32 = 12;
/// A step below this share of the sizes is the last one: what is left is of the order of its square.
const NEARLY: f64 = 1e-7;
/// Largest azimuth step, radians.
const LARGEST_STEP: f64 = 0.5;
/// Share of the greatest possible bend of the distance along a circle that is rounding.
const NO_BEND: f64 = 1e-12;
/// The same on the flat bottom: below it a bend is too weak to be followed.
const FLAT: f64 = 1e-9;
/// Distance from the axis, in radii of a flat bottom, beyond which contact is not looked for on it.
const BESIDE: f64 = 3.0;

/// Shares of the length of a slanted piece beyond its ends to which contact is followed: enough to tell that it is not on the piece.
const BEYOND: f64 = 0.1;

/// How the nearest place of a surface follows a motion of a point.
struct Follow {
    first: [Vec3; 2],
    /// Inverse of half the second derivatives of the squared distance by the place.
    inverse: [f64; 3],
}

impl Follow {
    /// For a point at an offset from a place that is its nearest one, or nearly; `None` if it is not the nearest around.
    fn new(chart: &Chart, offset: &Vec3) -> Option<Self> {
        let ([u, v], [uu, uv, vv]) = (chart.first, chart.second);
        let a = u.norm_squared() - offset.dot(&uu);
        let b = u.dot(&v) - offset.dot(&uv);
        let c = v.norm_squared() - offset.dot(&vv);
        let determinant = a * c - b * b;
        let inverse = [c, -b, a].map(|x| x / determinant);
        (determinant > 0.0 && a > 0.0).then_some(Self { first: [u, v], inverse })
    }

    fn step(&self, way: &Vec3) -> [f64; 2] {
        let [x, y] = self.first.map(|first| first.dot(way));
        let [xx, xy, yy] = self.inverse;
        [xx * x + xy * y, xy * x + yy * y]
    }
}

/// A normal of any length to a side, and how it changes with the place.
fn normal_changes(chart: &Chart, side: f64) -> (Vec3, [Vec3; 2]) {
    let ([u, v], [uu, uv, vv]) = (chart.first, chart.second);
    let sense = chart.sense * side;
    (u.cross(&v) * sense, [uu.cross(&v) + u.cross(&uv), uv.cross(&v) + u.cross(&vv)].map(|c| c * sense))
}

/// Newton's step to the least value of a function of two coordinates, along the directions in which it bends. `scale` is a
/// bend that is not small. `None` where the function bends downward.
fn valley([xx, xy, yy]: [f64; 3], slope: [f64; 2], scale: f64) -> Option<[f64; 2]> {
    let (mean, half) = (0.5 * (xx + yy), length([0.5 * (xx - yy), xy]));
    // The direction of the greater bend.
    let (sin, cos) = (0.5 * xy.atan2(0.5 * (xx - yy))).sin_cos();
    let mut step = [0.0; 2];
    for (bend, [x, y]) in [(mean + half, [cos, sin]), (mean - half, [-sin, cos])] {
        let fall = slope[0] * x + slope[1] * y;
        if bend > FLAT * scale {
            step = [step[0] - fall / bend * x, step[1] - fall / bend * y];
        } else if bend < -FLAT * scale {
            return None;
        }
    }
    Some(step)
}

impl Pose<'_> {
    /// The stationary distance of a piece of the tool near a start.
    pub(super) fn touch(&self, start: &Start) -> Option<Touch> {
        let piece = start.piece.and_then(|piece| self.tool.pieces.get(piece));
        if let Some(Piece::Disc { radius }) = piece {
            return self.touch_bottom(start, *radius);
        }
        if let Some(curve) = piece.and_then(Piece::curve) {
            return self.touch_slant(start, &curve);
        }
        let circle = self.circle(start.piece)?;
        let Tool { axis, across, .. } = self.tool;
        let base = self.tip + axis * circle.height;
        let radial = |[c, s]: [f64; 2]| across[0] * c + across[1] * s;
        let Start { mut direction, mut place, .. } = *start;
        let resolution = NEARLY * self.scale();
        for _ in 0..MAX_ITERATIONS {
            let outward = radial(direction) * circle.radius;
            let onward = radial([-direction[1], direction[0]]) * circle.radius;
            let center = base + outward;
            let chart = self.surface.chart(&place)?;
            let offset = center - chart.point;
            let follow = Follow::new(&chart, &offset)?;
            let mut step = follow.step(&offset);
            let mut turn = 0.0;
            if circle.radius > 0.0 {
                let (normal, change) = normal_changes(&chart, self.side);
                let along = |x: [f64; 2]| change[0].dot(&onward) * x[0] + change[1].dot(&onward) * x[1];
                let drift = follow.step(&onward);
                let bend = along(drift) - normal.dot(&outward);
                let slope = normal.dot(&onward) + along(step);
                if bend > NO_BEND * normal.norm() * circle.radius {
                    turn = (-slope / bend).clamp(-LARGEST_STEP, LARGEST_STEP);
                    step = [step[0] + drift[0] * turn, step[1] + drift[1] * turn];
                    direction = turned(direction, turn);
                } else if slope.abs() > NEARLY * normal.norm() * circle.radius {
                    // On a hill: the valley is where the tool faces the surface.
                    direction = self.facing(&normal);
                    let way = follow.step(&(radial(direction) * circle.radius - outward));
                    step = [step[0] + way[0], step[1] + way[1]];
                    turn = 1.0;
                }
            }
            let last = place;
            place = self.surface.shifted(&last, step)?;
            let moved =
                (chart.first[0] * step[0] + chart.first[1] * step[1]).norm() + turn.abs() * circle.radius;
            if moved <= resolution {
                let start = Start { direction, place, ..*start };
                let chart = self.surface.chart_beside(&place, (&last, &chart), step)?;
                return self.made(circle, base + radial(direction) * circle.radius, start, &chart);
            }
            if moved.is_nan() {
                return None;
            }
        }
        None
    }

    /// The place of the flat bottom, or of its plane beside it, where the distance is stationary.
    fn touch_bottom(&self, start: &Start, radius: f64) -> Option<Touch> {
        let [x, y] = &self.tool.across;
        let Start { direction: mut at, mut place, .. } = *start;
        let resolution = NEARLY * self.scale();
        for _ in 0..MAX_ITERATIONS {
            let chart = self.surface.chart(&place)?;
            let offset = self.tip + x * at[0] + y * at[1] - chart.point;
            let follow = Follow::new(&chart, &offset)?;
            let (normal, change) = normal_changes(&chart, self.side);
            let rest = follow.step(&offset);
            let drift = [follow.step(x), follow.step(y)];
            let along = |way: &Vec3, by: [f64; 2]| change[0].dot(way) * by[0] + change[1].dot(way) * by[1];
            let slope = [normal.dot(x) + along(x, rest), normal.dot(y) + along(y, rest)];
            let mixed = 0.5 * (along(x, drift[1]) + along(y, drift[0]));
            let bends = [along(x, drift[0]), mixed, along(y, drift[1])];
            let step = valley(bends, slope, normal.norm() / radius)?;
            let share = (radius / length(step)).min(1.0);
            let step = if share.is_nan() { step } else { step.map(|s| s * share) };
            at = [at[0] + step[0], at[1] + step[1]];
            let by: [f64; 2] =
                std::array::from_fn(|k| rest[k] + drift[0][k] * step[0] + drift[1][k] * step[1]);
            place = self.surface.shifted(&place, by)?;
            let moved = (chart.first[0] * by[0] + chart.first[1] * by[1]).norm() + length(step);
            if moved <= resolution || length(at) > BESIDE * radius {
                let center = self.tip + x * at[0] + y * at[1];
                let start = Start { direction: at, place, ..*start };
                let chart = self.surface.chart(&place)?;
                return self.made(Circle::POINT, center, start, &chart);
            }
            if moved.is_nan() {
                return None;
            }
        }
        None
    }

    /// The place of a slanted piece between two circles, or of its cone beyond them, or of the corner of a barrel, where the distance is
    /// stationary.
    fn touch_slant(&self, start: &Start, curve: &Curve) -> Option<Touch> {
        let Tool { axis, across, .. } = self.tool;
        let length_of_slant = curve.length();
        let radial = |[c, s]: [f64; 2]| across[0] * c + across[1] * s;
        let Start { mut direction, mut place, mut rise, .. } = *start;
        // A tool without width has no sides to go around.
        let is_line = matches!(curve, Curve::Line { radius, .. } if *radius == [0.0; 2]);
        let resolution = NEARLY * self.scale();
        for _ in 0..MAX_ITERATIONS {
            let (outward, onward) = (radial(direction), radial([-direction[1], direction[0]]));
            let Spot { place: [wide, high], way, bend } = curve.at(rise);
            let [widening, climb] = way.map(|x| x / length_of_slant);
            let upward = axis * climb + outward * widening;
            let curving = outward * bend[0] + axis * bend[1];
            let center = self.tip + axis * high + outward * wide;
            let chart = self.surface.chart(&place)?;
            let offset = center - chart.point;
            let follow = Follow::new(&chart, &offset)?;
            let (normal, change) = normal_changes(&chart, self.side);
            let rest = follow.step(&offset);
            // Along the slant, and around it by the length of the arc.
            let ways = [upward, onward];
            let drift = ways.map(|way| follow.step(&way));
            let along = |way: &Vec3, by: [f64; 2]| change[0].dot(way) * by[0] + change[1].dot(way) * by[1];
            let slope = ways.map(|way| normal.dot(&way) + along(&way, rest));
            let scale = normal.norm() / length_of_slant;
            let rising =
                along(&upward, drift[0]) + normal.dot(&curving) / (length_of_slant * length_of_slant);
            let step = if is_line {
                valley([rising, 0.0, scale], [slope[0], 0.0], scale)?
            } else {
                let turning = normal.dot(&onward) * widening / wide;
                let mixed = 0.5 * (along(&upward, drift[1]) + along(&onward, drift[0])) + turning;
                let around = along(&onward, drift[1]) - normal.dot(&outward) / wide;
                valley([rising, mixed, around], slope, scale)?
            };
            let share = (length_of_slant / step[0].abs()).min(LARGEST_STEP * wide / step[1].abs()).min(1.0);
            let step = if share.is_nan() { step } else { step.map(|s| s * share) };
            rise += step[0] / length_of_slant;
            if !is_line {
                direction = turned(direction, step[1] / wide);
            }
            let by: [f64; 2] =
                std::array::from_fn(|k| rest[k] + drift[0][k] * step[0] + drift[1][k] * step[1]);
            let last = place;
            place = self.surface.shifted(&last, by)?;
            let moved = (chart.first[0] * by[0] + chart.first[1] * by[1]).norm() + length(step);
            let beyond =
                !(-BEYOND..=1.0 + BEYOND).contains(&rise) || !is_line && curve.at(rise).place[0] <= 0.0;
            if moved <= resolution || beyond {
                let start = Start { piece: start.piece, direction, rise, place };
                let chart = self.surface.chart_beside(&place, (&last, &chart), by)?;
                let end = rise.clamp(-BEYOND, 1.0 + BEYOND);
                let [wide, high] = curve.at(end).place;
                let center = self.tip + axis * high + radial(direction) * wide.max(0.0);
                return self.made(Circle::POINT, center, start, &chart);
            }
            if moved.is_nan() {
                return None;
            }
        }
        None
    }

    fn made(&self, circle: Circle, center: Vec3, start: Start, chart: &Chart) -> Option<Touch> {
        let normal = chart.first[0].cross(&chart.first[1]).try_normalize(0.0)? * chart.sense;
        let distance = (center - chart.point).dot(&normal) - chart.thickness;
        let gradient = normal * self.side;
        let contact = Contact {
            clearance: self.side * distance - circle.ball,
            gradient,
            tool: center - gradient * circle.ball,
            surface: center - normal * distance,
        };
        Some(Touch { contact, center, circle, start })
    }
}

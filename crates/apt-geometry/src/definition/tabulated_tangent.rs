//! Lines, points and circles on a tabulated cylinder, as curves of the xy-plane.

use super::Impossible;
use super::choice::Toward;
use super::solve::{bisect, coincidence, roots};
use crate::Vec3;
use crate::canonical::{Interval, Plane, TabulatedCylinder};

/// z component of the rulings below which the section with the xy-plane is no curve.
const LYING: f64 = 1e-9;
/// Parts of an interval in which a rolling circle is looked for; a cubic over its chord turns at most twice.
const ROLLING_PARTS: u32 = 64;
/// Part of a stretch over which a slope is measured: the cube root of the rounding, for a central difference.
const SLOPE_FRACTION: f64 = 6e-6;

/// One interval as a cubic of the xy-plane: coefficients of the powers of the distance along the chord.
struct Piece {
    powers: [Vec3; 4],
    length: f64,
}

impl Piece {
    fn place(&self, s: f64) -> Vec3 {
        self.powers.iter().rev().fold(Vec3::zeros(), |sum, power| sum * s + power)
    }

    fn direction(&self, s: f64) -> Vec3 {
        self.powers[1] + self.powers[2] * (2.0 * s) + self.powers[3] * (3.0 * s * s)
    }

    /// Stations where `product(P(s) − from, P'(s))` is zero, for a product that is linear in both.
    fn stations(&self, from: &Vec3, product: impl Fn(&Vec3, &Vec3) -> f64) -> Vec<f64> {
        let mut places = self.powers;
        places[0] -= from;
        let derivative = [self.powers[1], self.powers[2] * 2.0, self.powers[3] * 3.0];
        let mut coefficients = [0.0; 6];
        for (i, place) in places.iter().enumerate() {
            for (j, direction) in derivative.iter().enumerate() {
                coefficients[i + j] += product(place, direction);
            }
        }
        roots(&coefficients, 0.0, self.length)
    }
}

/// The intervals seen along the rulings in the xy-plane.
fn pieces(surface: &TabulatedCylinder) -> Result<Vec<Piece>, Impossible> {
    let [u_axis, v_axis, w_axis] = &surface.axes;
    if w_axis.z.abs() <= LYING {
        return Err(Impossible::Parallel);
    }
    let along_rulings = |axis: &Vec3| axis - w_axis * (axis.z / w_axis.z);
    let (u_axis, v_axis) = (along_rulings(u_axis), along_rulings(v_axis));
    let ends = surface.intervals.iter().skip(1).map(|next| [next.u, next.v]).chain([surface.last]);
    Ok(surface
        .intervals
        .iter()
        .zip(ends)
        .filter(|(interval, _)| interval.length > 0.0)
        .map(|(interval, end)| piece(interval, end, &u_axis, &v_axis))
        .collect())
}

fn piece(interval: &Interval, end: [f64; 2], u_axis: &Vec3, v_axis: &Vec3) -> Piece {
    let Interval { u, v, a, b, length, .. } = *interval;
    let (du, dv) = ((end[0] - u) / length, (end[1] - v) / length);
    let start = u_axis * u + v_axis * v;
    let chord = u_axis * du + v_axis * dv;
    let rise = v_axis * du - u_axis * dv;
    Piece { powers: [start, chord - rise * ((a * length + b) * length), rise * b, rise * a], length }
}

/// A station of the curve: place and direction.
struct Station {
    place: Vec3,
    direction: Vec3,
}

/// Of the stations that `find` gives on every piece the one nearest to a point.
fn nearest(
    surface: &TabulatedCylinder,
    near: &Vec3,
    find: impl Fn(&Piece) -> Vec<f64>,
) -> Result<Station, Impossible> {
    let mut best: Option<(f64, Station)> = None;
    for piece in &pieces(surface)? {
        for s in find(piece) {
            let place = piece.place(s);
            let distance = (place - near).norm();
            if best.as_ref().is_none_or(|(least, _)| distance < *least) {
                best = Some((distance, Station { place, direction: piece.direction(s) }));
            }
        }
    }
    best.map(|(_, station)| station).ok_or(Impossible::NotReal)
}

/// The intersection with a line of the xy-plane that is nearest to a point.
pub(super) fn intersection(
    surface: &TabulatedCylinder,
    line: &Plane,
    near: &Vec3,
) -> Result<Vec3, Impossible> {
    let find = |piece: &Piece| {
        let mut coefficients = piece.powers.map(|power| line.normal.dot(&power));
        coefficients[0] -= line.distance;
        roots(&coefficients, 0.0, piece.length)
    };
    Ok(nearest(surface, near, find)?.place)
}

/// The line through `from` that touches the curve near a point. Its normal is to the right of the way from the point
/// of contact to `from`.
pub(super) fn tangent_line(
    surface: &TabulatedCylinder,
    from: &Vec3,
    near: &Vec3,
) -> Result<Plane, Impossible> {
    let cross = |a: &Vec3, b: &Vec3| a.x * b.y - a.y * b.x;
    let contact = nearest(surface, near, |piece| piece.stations(from, cross))?;
    line_from(&contact, from, contact.direction)
}

/// The line through `from` that crosses the curve at a right angle near a point. Its normal is to the right of the way
/// from the foot to `from`.
pub(super) fn normal_line(
    surface: &TabulatedCylinder,
    from: &Vec3,
    near: &Vec3,
) -> Result<Plane, Impossible> {
    let foot = nearest(surface, near, |piece| piece.stations(from, |a, b| a.x * b.x + a.y * b.y))?;
    let across = Vec3::new(-foot.direction.y, foot.direction.x, 0.0);
    line_from(&foot, from, across)
}

/// The line through a station and a point, or along `otherwise` where the two coincide.
fn line_from(station: &Station, point: &Vec3, otherwise: Vec3) -> Result<Plane, Impossible> {
    let way = point - station.place;
    let along = if way.norm() <= coincidence(point.amax()) { otherwise } else { way };
    Plane::through(*point, Vec3::new(along.y, -along.x, 0.0)).ok_or(Impossible::ZeroLength)
}

/// The centre, on `centers`, of a circle that touches the curve near a point from the named side.
pub(super) fn rolling_center(
    surface: &TabulatedCylinder,
    centers: &Plane,
    side: Toward,
    near: &Vec3,
    radius: f64,
) -> Result<Vec3, Impossible> {
    let mut best: Option<(f64, Vec3)> = None;
    for piece in &pieces(surface)? {
        for sense in [1.0, -1.0] {
            let offset = |s: f64| {
                let direction = piece.direction(s);
                let normal = Vec3::new(-direction.y, direction.x, 0.0);
                normal.try_normalize(0.0).unwrap_or_else(Vec3::zeros) * (sense * radius)
            };
            let center = |s: f64| piece.place(s) + offset(s);
            let gap = |s: f64| centers.signed_distance(&center(s));
            let station = |part: u32| piece.length * f64::from(part) / f64::from(ROLLING_PARTS);
            for part in 0..ROLLING_PARTS {
                for s in crossings(gap, station(part), station(part + 1)) {
                    let distance = (piece.place(s) - near).norm();
                    if side.component(&offset(s)) > 0.0 && best.is_none_or(|(least, _)| distance < least) {
                        best = Some((distance, center(s)));
                    }
                }
            }
        }
    }
    best.map(|(_, center)| center).ok_or(Impossible::NotReal)
}

/// Where a smooth function is zero in a short stretch: at a change of sign, or at two that lie on both sides of a
/// turning point.
fn crossings(function: impl Fn(f64) -> f64, left: f64, right: f64) -> Vec<f64> {
    let (at_left, at_right) = (function(left), function(right));
    if at_left == 0.0 {
        return vec![left];
    }
    if at_left.signum() != at_right.signum() {
        return vec![bisect(function, left, right)];
    }
    let reach = (right - left) * SLOPE_FRACTION;
    let slope = |s: f64| function(s + reach) - function(s - reach);
    // Only a function that comes nearer to zero from both ends can get there.
    if at_left * slope(left) >= 0.0 || at_right * slope(right) <= 0.0 {
        return Vec::new();
    }
    let turning = bisect(slope, left, right);
    if function(turning).signum() == at_left.signum() {
        return Vec::new();
    }
    vec![bisect(&function, left, turning), bisect(&function, turning, right)]
}

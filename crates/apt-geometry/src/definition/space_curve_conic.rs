//! CURSEG: the conic arc through points with directions, up to five conditions.
//!
//! Two conditions make a line, three a circle, four the ellipse of least eccentricity, five the conic. The arc is one
//! rational cubic; where it turns by two thirds of a turn or more the weights of one would not be positive, and it is kept
//! as its two parts, which count as one arc and have its parameter.

use nalgebra::{DMatrix, Matrix2, Matrix3, Vector2, Vector4, Vector6};

use super::{parametric_error::ParametricError, space_curve::ParametricNode};
use crate::{
    Vec3,
    parametric::{CurveArc, SpaceCurve},
};

/// Most conditions of a conic.
const MOST_CONDITIONS: usize = 5;
/// How far data may be off their plane, and points off a line that still are on it, as a share of their extent.
const OFF_PLANE: f64 = 1e-6;
/// Sine of the angle between end tangents below which they are parallel: the arc is half an ellipse.
const PARALLEL: f64 = 1e-9;
/// Least weight of a control point, as a share of the greatest, of an arc that is not halved.
const LEAST_WEIGHT: f64 = 1e-3;
/// Ratio of singular values below which conditions do not determine the conic.
const DEPENDENT: f64 = 1e-12;

/// A place of the plane of the curve, in shares of the extent from the first point.
type Place = Vector2<f64>;
/// `A x² + B xy + C y² + D x + E y + F`.
type Conic = Vector6<f64>;

/// A place times its weight, and the weight.
type Weighted = (Place, f64);

/// The plane of a curve.
struct Frame {
    origin: Vec3,
    axes: [Vec3; 2],
    extent: f64,
}

/// A condition: a place and, where given, the direction there (its sign may be unknown).
struct Condition {
    place: Place,
    direction: Option<Place>,
    /// Whether the direction came as TANSPL, so that its sense counts.
    sense: bool,
}

/// The curve of CURSEG.
///
/// # Errors
/// Too few or too many conditions, points on a line or off a plane, or data that no conic arc takes in their order.
pub(super) fn curve(nodes: &[ParametricNode]) -> Result<SpaceCurve, ParametricError> {
    let (Some(first), Some(last)) = (nodes.first(), nodes.last()) else {
        return Err(ParametricError::TooFew { least: 2, found: 0 });
    };
    if nodes.len() < 2 {
        return Err(ParametricError::TooFew { least: 2, found: nodes.len() });
    }
    let given = |node: &ParametricNode| usize::from(node.tangent.is_some() || node.normal.is_some());
    let conditions = nodes.len() + nodes.iter().map(given).sum::<usize>();
    if conditions > MOST_CONDITIONS {
        return Err(ParametricError::TooManyConditions { greatest: MOST_CONDITIONS, found: conditions });
    }
    let extent = nodes.iter().map(|node| (node.point - first.point).norm()).fold(0.0, f64::max);
    for (one, a) in nodes.iter().enumerate() {
        for (other, b) in nodes.iter().enumerate().skip(one + 1) {
            if (a.point - b.point).norm() <= DEPENDENT * extent || extent == 0.0 {
                return Err(ParametricError::Coincident { first: one + 1, second: other + 1 });
            }
        }
    }
    if conditions == 2 {
        return Ok(SpaceCurve::of_arcs(vec![CurveArc::segment(&first.point, &last.point)]));
    }
    let frame = Frame::of(nodes, extent)?;
    let data: Vec<Condition> = nodes.iter().map(|node| frame.condition(node)).collect();
    let conic = match conditions {
        3 => circle(&data)?,
        4 => least_eccentric(&data)?,
        _ => unique(&data)?,
    };
    let piece = piece(&conic, &data)?;
    if piece.is_short() {
        return Ok(SpaceCurve::of_arcs(vec![lifted(piece.control(), &frame)]));
    }
    let crown = piece.crown();
    let curve = SpaceCurve::of_arcs(piece.cut(crown).map(|part| lifted(part, &frame)).to_vec());
    Ok(SpaceCurve { breaks: vec![0.0, crown, 1.0], ..curve })
}

impl Frame {
    /// The plane of the data.
    fn of(nodes: &[ParametricNode], extent: f64) -> Result<Frame, ParametricError> {
        let origin = nodes.first().map_or_else(Vec3::zeros, |node| node.point);
        let mut vectors = Vec::new();
        for node in nodes {
            if node.point != origin {
                vectors.push((node.point - origin) / extent);
            }
            for vector in [node.tangent, node.normal].into_iter().flatten() {
                vectors.push(vector.try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::ZeroVector)?);
            }
        }
        let mut normal = Vec3::zeros();
        for (index, a) in vectors.iter().enumerate() {
            for b in vectors.iter().skip(index + 1) {
                let cross = a.cross(b);
                if cross.norm() > normal.norm() {
                    normal = cross;
                }
            }
        }
        if normal.norm() <= OFF_PLANE {
            return Err(ParametricError::Collinear);
        }
        let normal = normal.normalize();
        let distance = vectors.iter().map(|vector| vector.dot(&normal).abs()).fold(0.0, f64::max);
        if distance > OFF_PLANE {
            return Err(ParametricError::NotPlanar { distance: distance * extent });
        }
        let chord = nodes.last().map_or_else(Vec3::zeros, |node| node.point - origin);
        let first = (chord - normal * normal.dot(&chord)).normalize();
        Ok(Frame { origin, axes: [first, normal.cross(&first)], extent })
    }

    fn flat(&self, vector: &Vec3) -> Place {
        Place::new(self.axes[0].dot(vector), self.axes[1].dot(vector))
    }

    fn condition(&self, node: &ParametricNode) -> Condition {
        let place = self.flat(&(node.point - self.origin)) / self.extent;
        let tangent = node.tangent.map(|vector| self.flat(&vector).normalize());
        // A principal normal lies in the plane, the tangent across it.
        let across = node.normal.map(|vector| {
            let normal = self.flat(&vector).normalize();
            Place::new(-normal.y, normal.x)
        });
        Condition { place, direction: tangent.or(across), sense: tangent.is_some() }
    }

    /// The homogeneous point in space of a place that is multiplied by a weight already.
    fn homogeneous(&self, place: &Place, weight: f64) -> Vector4<f64> {
        let lifted = self.origin * weight + (self.axes[0] * place.x + self.axes[1] * place.y) * self.extent;
        lifted.push(weight)
    }
}

/// The row that a place puts on the conic.
fn place_row(p: &Place) -> [f64; 6] {
    [p.x * p.x, p.x * p.y, p.y * p.y, p.x, p.y, 1.0]
}

/// The row that a direction at a place puts on the conic.
fn direction_row(p: &Place, d: &Place) -> [f64; 6] {
    [2.0 * p.x * d.x, p.x * d.y + p.y * d.x, 2.0 * p.y * d.y, d.x, d.y, 0.0]
}

/// The conics that satisfy the data and further rows: a basis, the best satisfied one first.
fn family(data: &[Condition], more: &[[f64; 6]], dimension: usize) -> Result<Vec<Conic>, ParametricError> {
    let mut rows: Vec<[f64; 6]> = more.to_vec();
    for condition in data {
        rows.push(place_row(&condition.place));
        rows.extend(condition.direction.map(|direction| direction_row(&condition.place, &direction)));
    }
    // Six rows, so that the decomposition has all six right vectors.
    let system = DMatrix::from_fn(6, 6, |row, column| rows.get(row).map_or(0.0, |values| values[column]));
    let decomposed = system.svd(false, true);
    let right = decomposed.v_t.ok_or(ParametricError::NotFinite)?;
    let values = &decomposed.singular_values;
    let mut order: Vec<usize> = (0..6).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    // The next singular value must be a true one, or the data leave more conics than asked for.
    let greatest = values.max();
    if order.get(dimension).is_none_or(|next| values[*next] <= DEPENDENT * greatest) {
        return Err(ParametricError::Collinear);
    }
    Ok(order.iter().take(dimension).map(|index| Conic::from_fn(|axis, _| right[(*index, axis)])).collect())
}

/// The circle of three conditions: `A = C`, `B = 0`.
fn circle(data: &[Condition]) -> Result<Conic, ParametricError> {
    let round = [[1.0, 0.0, -1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]];
    let conic = single(family(data, &round, 1)?)?;
    if conic[0].abs() <= OFF_PLANE * conic.norm() {
        return Err(ParametricError::Collinear);
    }
    Ok(conic)
}

fn unique(data: &[Condition]) -> Result<Conic, ParametricError> {
    single(family(data, &[], 1)?)
}

fn single(family: Vec<Conic>) -> Result<Conic, ParametricError> {
    family.into_iter().next().ok_or(ParametricError::NoConicArc)
}

/// Of the conics `P + kQ` the one with the greatest `det / trace²` of its quadratic part, which is the least eccentric
/// ellipse. The condition is linear in k.
fn least_eccentric(data: &[Condition]) -> Result<Conic, ParametricError> {
    let family = family(data, &[], 2)?;
    let [p, q] = family.as_slice() else { return Err(ParametricError::NoConicArc) };
    let determinant = |a: &Conic, b: &Conic| 0.5 * (a[0] * b[2] + a[2] * b[0]) - 0.25 * a[1] * b[1];
    let (d0, d1, d2) = (determinant(p, p), 2.0 * determinant(p, q), determinant(q, q));
    let (t0, t1) = (p[0] + p[2], q[0] + q[2]);
    let (above, below) = (2.0 * t1 * d0 - d1 * t0, 2.0 * d2 * t0 - d1 * t1);
    // The ratio above/below may be infinite: then it is Q alone.
    let conic = p * below + q * above;
    let elliptic = determinant(&conic, &conic) > DEPENDENT * (conic[0] + conic[2]).powi(2);
    if elliptic { Ok(conic.normalize()) } else { Err(ParametricError::NoConicArc) }
}

/// The quadratic form of two places with third coordinates.
fn polar(conic: &Conic, a: &Place, a_weight: f64, b: &Place, b_weight: f64) -> f64 {
    conic[0] * a.x * b.x
        + 0.5 * conic[1] * (a.x * b.y + a.y * b.x)
        + conic[2] * a.y * b.y
        + 0.5 * conic[3] * (a.x * b_weight + b.x * a_weight)
        + 0.5 * conic[4] * (a.y * b_weight + b.y * a_weight)
        + conic[5] * a_weight * b_weight
}

/// The direction of the conic at a place on it.
fn tangent(conic: &Conic, p: &Place) -> Place {
    let gradient = Place::new(
        2.0 * conic[0] * p.x + conic[1] * p.y + conic[3],
        conic[1] * p.x + 2.0 * conic[2] * p.y + conic[4],
    );
    Place::new(-gradient.y, gradient.x)
}

/// A conic arc `(1−t)²P + 2t(1−t)M + t²Q` over weights `(1−t)² + 2t(1−t)w + t²`.
struct Piece {
    first: Place,
    last: Place,
    /// The middle control point times its weight: a direction where the weight is 0 (half an ellipse).
    middle: Place,
    /// Weight of the middle: below 0 where the arc turns by more than half a turn.
    weight: f64,
}

impl Piece {
    /// Both pieces of a conic between two of its places: inside the triangle of its tangents, and around.
    fn both(conic: &Conic, first: Place, last: Place) -> Result<[Piece; 2], ParametricError> {
        let unit = |place: &Place| {
            tangent(conic, place).try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::NoConicArc)
        };
        let (a, b) = (unit(&first)?, unit(&last)?);
        let center = (first + last) * 0.5;
        let level = polar(conic, &center, 1.0, &center, 1.0);
        let real = |square: f64| {
            (square > 0.0 && square.is_finite()).then(|| square.sqrt()).ok_or(ParametricError::NoConicArc)
        };
        if a.perp(&b).abs() <= PARALLEL {
            // Half an ellipse: by the crown on either side.
            let reach = real(-level / polar(conic, &a, 0.0, &a, 0.0))?;
            return Ok([a * reach, -a * reach].map(|middle| Piece { first, last, middle, weight: 0.0 }));
        }
        let system = Matrix2::from_columns(&[a, -b]);
        let way = system.try_inverse().ok_or(ParametricError::NoConicArc)? * (last - first);
        let meeting = first + a * way.x;
        let weight = real(-level / polar(conic, &meeting, 1.0, &meeting, 1.0))?;
        Ok([weight, -weight].map(|weight| Piece { first, last, middle: meeting * weight, weight }))
    }

    /// The parameter of a place of the conic, if it is on this piece.
    fn parameter(&self, place: &Place) -> Option<f64> {
        // Shares a, b, c of first, middle and last with a(1) + b w + c = 1; on the conic b² = 4ac.
        let system = Matrix3::from_columns(&[
            self.first.push(1.0),
            self.middle.push(self.weight),
            self.last.push(1.0),
        ]);
        let shares = system.try_inverse()? * place.push(1.0);
        let inside = shares.iter().all(|share| *share >= -DEPENDENT);
        let (before, after) = (shares.x.max(0.0).sqrt(), shares.z.max(0.0).sqrt());
        inside.then(|| after / (before + after))
    }

    /// The derivative at the start, up to its length.
    fn way(&self) -> Place {
        self.middle - self.first * self.weight
    }

    /// The derivative at the end, up to its length.
    fn last_way(&self) -> Place {
        self.last * self.weight - self.middle
    }

    /// Square root of the weight of the end that makes the end derivatives equally long.
    fn balance(&self) -> f64 {
        (self.last_way().norm() / self.way().norm()).sqrt()
    }

    /// Whether one cubic with positive weights holds it.
    fn is_short(&self) -> bool {
        let balance = self.balance();
        let least = (1.0 + 2.0 * balance * self.weight).min(balance * balance + 2.0 * balance * self.weight);
        least > LEAST_WEIGHT * (balance * balance).max(1.0)
    }

    /// Control points times their weights, and the weights.
    fn control(&self) -> [Weighted; 3] {
        let balance = self.balance();
        let square = balance * balance;
        [(self.first, 1.0), (self.middle * balance, self.weight * balance), (self.last * square, square)]
    }

    /// The parameter at which both parts have positive weights: the crown seen from both ends.
    fn crown(&self) -> f64 {
        1.0 / (1.0 + self.balance())
    }

    /// The parts before and after a parameter.
    fn cut(&self, t: f64) -> [[Weighted; 3]; 2] {
        let between = |a: Weighted, b: Weighted| (a.0 * (1.0 - t) + b.0 * t, a.1 * (1.0 - t) + b.1 * t);
        let [first, middle, last] = self.control();
        let (before, after) = (between(first, middle), between(middle, last));
        let at = between(before, after);
        [[first, before, at], [at, after, last]]
    }
}

/// The arc in space of control points in the plane.
fn lifted(control: [Weighted; 3], frame: &Frame) -> CurveArc {
    let [first, middle, last] = control.map(|(place, weight)| frame.homogeneous(&place, weight));
    CurveArc { control: [first, (first + middle * 2.0) / 3.0, (middle * 2.0 + last) / 3.0, last] }
}

/// The piece of the conic from the first to the last place that takes the inner places in order; without such places the one
/// that runs in the sense of the first tangent, or where there is none of the last one.
fn piece(conic: &Conic, data: &[Condition]) -> Result<Piece, ParametricError> {
    let (Some(start), Some(end)) = (data.first(), data.last()) else {
        return Err(ParametricError::TooFew { least: 2, found: data.len() });
    };
    let inner = data.get(1..data.len() - 1).unwrap_or_default();
    for piece in Piece::both(conic, start.place, end.place)? {
        // A weight of −1 or less runs through infinity.
        if piece.weight <= DEPENDENT - 1.0 {
            continue;
        }
        let mut reached = 0.0;
        let in_order = inner.iter().all(|condition| {
            let before = reached;
            reached = piece.parameter(&condition.place).unwrap_or(f64::NEG_INFINITY);
            reached > before
        });
        let along = |condition: &Condition, way: Place| match condition.direction {
            Some(direction) if condition.sense => Some(direction.dot(&way) > 0.0),
            _ => None,
        };
        let sense = || along(start, piece.way()).or_else(|| along(end, piece.last_way())).unwrap_or(true);
        if in_order && (!inner.is_empty() || sense()) {
            return Ok(piece);
        }
    }
    Err(ParametricError::NoConicArc)
}

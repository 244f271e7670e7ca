//! SSURF/SMESH: a bicubic mesh through rows of points.
//!
//! Rows and columns are splines like those of SCURV. The derivatives of a column of patches along u are as long as the
//! mean chord of all rows there, so that neighbouring columns have one tangent plane along their common edge; a mesh of
//! one column keeps the chord of each row. The same holds along v. Free meshes have no twists (found from the public system's
//! results).

use super::{
    parametric_error::ParametricError,
    sculptured::MeshRestriction,
    sculptured_define::meshed,
    space_curve::ParametricNode,
    spline::{self, Condition},
};
use crate::{
    Vec3,
    canonical::matrix::CoordinatePlane,
    parametric::{Patch, SculpturedSurface},
};

/// How far points of a row may be off its line in the plane of the heights, as a share of its length.
const STRAIGHT: f64 = 1e-6;

/// Points with unit derivatives along both directions, by row and column.
struct Net {
    points: Vec<Vec<Vec3>>,
    along: Vec<Vec<Vec3>>,
    across: Vec<Vec<Vec3>>,
}

/// The surface.
///
/// # Errors
/// Fewer than two rows or points, rows of different lengths, points that coincide, rows that are not straight in their
/// plane.
pub(super) fn surface(
    restriction: MeshRestriction,
    rows: &[Vec<ParametricNode>],
) -> Result<SculpturedSurface, ParametricError> {
    let net = Net::of(rows)?;
    let (count_u, count_v) = (net.points[0].len() - 1, net.points.len() - 1);
    let mut patches = Vec::with_capacity(count_u * count_v);
    match restriction {
        MeshRestriction::Free => {
            let pace_u = paces(&net.points);
            let pace_v = paces(&exchanged(&net.points));
            for row in 0..count_v {
                for column in 0..count_u {
                    let pace = |line: usize, at: usize, whole: bool| {
                        if whole { pace_v[line][at] } else { pace_u[line][at] }
                    };
                    patches.push(net.patch(row, column, pace, |_| Vec3::zeros()));
                }
            }
        }
        MeshRestriction::Height(plane) => {
            net.check_straight(plane)?;
            let [x, y, _] = plane.axes();
            let flat: Vec<Vec<Vec3>> = net
                .points
                .iter()
                .map(|row| row.iter().map(|point| Vec3::new(point[x], point[y], 0.0)).collect())
                .collect();
            let turned = exchanged(&flat);
            for row in 0..count_v {
                for column in 0..count_u {
                    let pace = |line: usize, at: usize, whole: bool| {
                        let lines = if whole { &turned } else { &flat };
                        (lines[line][at + 1] - lines[line][at]).norm()
                    };
                    let full = net.patch(row, column, pace, |[du, dv]| {
                        half_twist(du, count_v) + half_twist(dv, count_u)
                    });
                    patches.push(net.heights(row, column, &full, [x, y]));
                }
            }
        }
    }
    Ok(meshed(patches, (count_u, count_v)))
}

/// The mixed derivative of a height field: half the change of one derivative across a mesh of one span, none across
/// several (found from the public system's results).
fn half_twist(change: Vec3, spans: usize) -> Vec3 {
    if spans == 1 { change * 0.5 } else { Vec3::zeros() }
}

/// For each line the lengths of its derivatives over each span: the mean over all lines, or its own chord where there is
/// one span.
fn paces(lines: &[Vec<Vec3>]) -> Vec<Vec<f64>> {
    let chords: Vec<Vec<f64>> =
        lines.iter().map(|line| line.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect()).collect();
    let spans = chords.first().map_or(0, Vec::len);
    if spans == 1 {
        return chords;
    }
    let mean = |span: usize| chords.iter().map(|line| line[span]).sum::<f64>() / chords.len() as f64;
    let means: Vec<f64> = (0..spans).map(mean).collect();
    vec![means; lines.len()]
}

fn exchanged<T: Clone>(rows: &[Vec<T>]) -> Vec<Vec<T>> {
    let count = rows.first().map_or(0, Vec::len);
    (0..count).map(|column| rows.iter().map(|row| row[column].clone()).collect()).collect()
}

impl Net {
    fn of(rows: &[Vec<ParametricNode>]) -> Result<Net, ParametricError> {
        let expected = rows.first().map_or(0, Vec::len);
        if rows.len() < 2 || expected < 2 {
            return Err(ParametricError::TooFew { least: 2, found: rows.len().min(expected) });
        }
        let lengths = rows.iter().enumerate().map(|(index, row)| (index + 1, row.len()));
        let others: Vec<_> = lengths.filter(|(_, length)| *length != expected).collect();
        if !others.is_empty() {
            return Err(ParametricError::RowLength { expected, rows: others });
        }
        let points = faired(rows)?;
        let along = points
            .iter()
            .zip(rows)
            .map(|(line, nodes)| units(line, nodes, |node| node.tangent))
            .collect::<Result<Vec<_>, _>>()?;
        let across = exchanged(&points)
            .iter()
            .zip(&exchanged(rows))
            .map(|(line, nodes)| units(line, nodes, |node| node.cross))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Net { points, along, across: exchanged(&across) })
    }

    /// The patch of a row and column with derivatives as long as `pace` says: of a line, at a span, of the columns
    /// instead of the rows. `twist` gives the mixed derivative from the changes of both derivatives across the patch.
    fn patch(
        &self,
        row: usize,
        column: usize,
        pace: impl Fn(usize, usize, bool) -> f64,
        twist: impl Fn([Vec3; 2]) -> Vec3,
    ) -> Patch {
        let along = |i: usize, j: usize| self.along[row + j][column + i] * pace(row + j, column, false);
        let across = |i: usize, j: usize| self.across[row + j][column + i] * pace(column + i, row, true);
        Patch::from_hermite(&std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let changes = [along(i, 1) - along(i, 0), across(1, j) - across(0, j)];
                [self.points[row + j][column + i], along(i, j), across(i, j), twist(changes)]
            })
        }))
    }

    /// The patch whose coordinates in the plane are bilinear, with the heights of another one.
    fn heights(&self, row: usize, column: usize, full: &Patch, [x, y]: [usize; 2]) -> Patch {
        let corner = |i: usize, j: usize| self.points[row + j][column + i];
        let mut patch = *full;
        for (i, line) in patch.control.iter_mut().enumerate() {
            for (j, point) in line.iter_mut().enumerate() {
                let (u, v) = (i as f64 / 3.0, j as f64 / 3.0);
                let place = (corner(0, 0) * (1.0 - u) + corner(1, 0) * u) * (1.0 - v)
                    + (corner(0, 1) * (1.0 - u) + corner(1, 1) * u) * v;
                (point[x], point[y]) = (place[x], place[y]);
            }
        }
        patch
    }

    /// Rows of a height field are straight in its plane.
    fn check_straight(&self, plane: CoordinatePlane) -> Result<(), ParametricError> {
        let [x, y, _] = plane.axes();
        for (index, row) in self.points.iter().enumerate() {
            let flat = |point: &Vec3| Vec3::new(point[x], point[y], 0.0);
            let (Some(first), Some(last)) = (row.first(), row.last()) else { continue };
            let chord = flat(last) - flat(first);
            let off = row.iter().map(|point| chord.cross(&(flat(point) - flat(first))).norm());
            if off.fold(0.0, f64::max) > STRAIGHT * chord.norm_squared() {
                return Err(ParametricError::RowNotStraight { row: index + 1 });
            }
        }
        Ok(())
    }
}

/// The unit directions of a spline through a line of nodes.
fn units(
    points: &[Vec3],
    nodes: &[ParametricNode],
    given: impl Fn(&ParametricNode) -> Option<Vec3>,
) -> Result<Vec<Vec3>, ParametricError> {
    let conditions: Vec<Condition> =
        nodes.iter().map(|node| Condition { direction: given(node), across: node.normal }).collect();
    let directions = spline::directions(points, &conditions)?;
    Ok(directions
        .iter()
        .map(|way| way.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vec3::zeros))
        .collect())
}

/// The points after fairing along the rows and then along the columns; no point moves farther than its limit in all.
fn faired(rows: &[Vec<ParametricNode>]) -> Result<Vec<Vec<Vec3>>, ParametricError> {
    let moved = |lines: &[Vec<ParametricNode>]| {
        lines.iter().map(|line| spline::faired(line, None, None)).collect::<Result<Vec<_>, _>>()
    };
    let along = moved(rows)?;
    let mut nodes = rows.to_vec();
    for (line, points) in nodes.iter_mut().zip(&along) {
        for (node, point) in line.iter_mut().zip(points) {
            node.point = *point;
        }
    }
    let mut points = exchanged(&moved(&exchanged(&nodes))?);
    for (line, nodes) in points.iter_mut().zip(rows) {
        for (point, node) in line.iter_mut().zip(nodes) {
            let by = *point - node.point;
            let limit = node.limit.unwrap_or(f64::INFINITY);
            if by.norm() > limit {
                *point = node.point + by * (limit / by.norm());
            }
        }
    }
    Ok(points)
}

//! SSURF/GENCUR: a surface through curves, whose segments of flow correspond.
//!
//! Two curves without cross directions make a ruled surface. Otherwise the ends of the segments are joined by splines
//! across, and between them the derivatives across have a direction and a length that blend from one spline to the next.
//! Segments may hold several arcs and run with a flow: such strips are cut into columns of patches, each within a share of
//! the size of the surface from the exact one; segments keep their whole parameters. Cross curves of several arcs, conics
//! and such with a flow cut what lies between two curves into rows of patches in the same way.

use std::sync::Arc;

use super::{
    parametric_error::ParametricError,
    sculptured_strip::{Pull, RowPart, Strand, Strip, blend, cut},
    spline::{self, Condition},
};
use crate::{
    Vec3,
    parametric::{
        Flow, FlowKind, FlowRange, FlowSegment, Mesh, SculpturedSurface, SegmentMeasure, SpaceCurve,
    },
};

/// Distance of a cross curve's end from the curve it should meet, as a share of the size of all curves.
const GAP: f64 = 1e-6;

/// The surface.
///
/// # Errors
/// Fewer than two curves, curves without segments or with different numbers of them, cross curves that do not meet them.
pub(super) fn surface(
    curves: &[Arc<SpaceCurve>],
    cross: &[Arc<SpaceCurve>],
) -> Result<SculpturedSurface, ParametricError> {
    if curves.len() < 2 {
        return Err(ParametricError::TooFew { least: 2, found: curves.len() });
    }
    let mut strands = Vec::with_capacity(curves.len());
    for (index, curve) in curves.iter().enumerate() {
        let flow = curve.flow.as_ref().ok_or(ParametricError::NoFlow { curve: index + 1 })?;
        strands.push(Strand { curve, flow });
    }
    let segments = strands[0].flow.segments.len();
    if let Some(index) = strands.iter().position(|strand| strand.flow.segments.len() != segments) {
        let found = strands[index].flow.segments.len();
        return Err(ParametricError::SegmentCount { curve: index + 1, expected: segments, found });
    }
    let size = curves.iter().map(|curve| curve.size()).fold(0.0, f64::max)
        + (strands[0].boundary(0) - strands[strands.len() - 1].boundary(0)).norm();
    let ties = Ties::of(&strands, segments)?;
    let rims = rims(cross, &strands, segments, size)?;
    let parts = row_parts(rims.as_deref(), curves.len() - 1, size);
    let strip = |segment| Strip { strands: &strands, segment, ties: &ties, rows: &parts, pulls: None };
    let lack = |rim: &Rim| {
        let (segment, local) = if rim.end < segments { (rim.end, 0.0) } else { (rim.end - 1, 1.0) };
        strip(segment).lack(rim, local)
    };
    let pulls: Option<Vec<Pull>> = rims.map(|rims| rims.iter().map(lack).collect());
    let mut columns = Vec::new();
    for segment in 0..segments {
        columns.extend(Strip { pulls: pulls.as_deref(), ..strip(segment) }.columns(size));
    }
    let rows = parts.len();
    let mut breaks = vec![0.0];
    breaks.extend(columns.iter().map(|column| column.end));
    let patches = (0..rows).flat_map(|row| columns.iter().map(move |column| column.patches[row])).collect();
    let grid = Some((columns.len(), rows));
    // Columns of whole segments need no list of their ends.
    let breaks = if columns.len() == segments { Vec::new() } else { breaks };
    let mesh = Mesh { splines: curves.len(), cross_splines: segments + 1 };
    let surface = SculpturedSurface::assembled(patches, grid, breaks, 1.0, mesh);
    if rows == curves.len() - 1 {
        return Ok(surface);
    }
    let mut row_breaks = vec![0.0];
    row_breaks.extend(parts.iter().map(|part| part.row as f64 + part.to));
    Ok(surface.with_row_breaks(row_breaks))
}

/// The rows of patches: all that lies between two curves, or where cross curves are not one cubic there, parts of it over
/// which they are close to cubics.
fn row_parts(rims: Option<&[Rim]>, rows: usize, size: f64) -> Vec<RowPart> {
    let Some(rims) = rims else {
        return (0..rows).map(|row| RowPart { row, from: 0.0, to: 1.0 }).collect();
    };
    let strands: Vec<Strand<'_>> =
        rims.iter().map(|rim| Strand { curve: &rim.curve, flow: &rim.flow }).collect();
    let mut parts = Vec::with_capacity(rows);
    for row in 0..rows {
        cut(
            strands.iter().flat_map(|strand| strand.joints(row)),
            &mut |from, to| strands.iter().all(|strand| strand.is_close_to_cubic(row, [from, to], size)),
            &mut |from, to| parts.push(RowPart { row, from, to }),
        );
    }
    parts
}

/// The derivatives across at the ends of the segments: for each row of patches and each end, unit directions and lengths at
/// its lower and its upper curve. None where the surface is ruled.
pub(super) struct Ties(Option<Vec<Vec<Tie>>>);

/// Direction and length at the lower and the upper curve of a row.
type Tie = [(Vec3, f64); 2];

impl Ties {
    fn of(strands: &[Strand<'_>], segments: usize) -> Result<Ties, ParametricError> {
        let mut given = false;
        let mut ties = vec![Vec::with_capacity(segments + 1); strands.len() - 1];
        for end in 0..=segments {
            let points: Vec<Vec3> = strands.iter().map(|strand| strand.boundary(end)).collect();
            let conditions: Vec<Condition> = strands
                .iter()
                .map(|strand| Condition { direction: strand.cross(end), across: None })
                .collect();
            given |= conditions.iter().any(|condition| condition.direction.is_some());
            let ways = spline::directions(&points, &conditions)?;
            for (row, tie) in ties.iter_mut().enumerate() {
                let chord = points[row + 1] - points[row];
                let lengths = spline::bending_lengths(&chord, &ways[row], &ways[row + 1]);
                let split = |vector: &Vec3| {
                    (vector.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vec3::zeros), vector.norm())
                };
                tie.push(lengths.map(|vector| split(&vector)));
            }
        }
        Ok(Ties((strands.len() > 2 || given).then_some(ties)))
    }

    /// The derivatives across of a row at the lower and the upper curve, `local` along a segment; none of a ruled surface.
    pub(super) fn across(&self, row: usize, segment: usize, local: f64) -> Option<[Vec3; 2]> {
        let ends = self.0.as_ref()?.get(row)?;
        let (before, after) = (ends.get(segment)?, ends.get(segment + 1)?);
        let share = blend(local);
        Some(std::array::from_fn(|side| {
            let ((a, short), (b, long)) = (before[side], after[side]);
            (a * (1.0 - share) + b * share) * (short * (1.0 - share) + long * share)
        }))
    }

    /// Whether the surface is ruled between each pair of curves.
    pub(super) fn is_ruled(&self) -> bool {
        self.0.is_none()
    }
}

/// A curve after CROSS.
pub(super) struct Rim {
    pub(super) curve: SpaceCurve,
    /// A flow with a segment for each row.
    pub(super) flow: Flow,
    /// The end of segments of the surface that it belongs to.
    pub(super) end: usize,
}

fn rims(
    cross: &[Arc<SpaceCurve>],
    strands: &[Strand<'_>],
    segments: usize,
    size: f64,
) -> Result<Option<Vec<Rim>>, ParametricError> {
    if cross.is_empty() {
        return Ok(None);
    }
    // At the first and the last end, or at every end of the segments.
    let ends: Vec<usize> = match cross.len() {
        2 => vec![0, segments],
        count if count == segments + 1 => (0..=segments).collect(),
        found => return Err(ParametricError::SegmentCount { curve: 1, expected: 2, found }),
    };
    let rows = strands.len() - 1;
    let mut rims = Vec::with_capacity(cross.len());
    for (index, (curve, end)) in cross.iter().zip(ends).enumerate() {
        let flow = match &curve.flow {
            Some(flow) if flow.segments.len() == rows => flow.clone(),
            _ => by_joints(curve, strands, end, GAP * size)
                .unwrap_or_else(|| Flow::even(curve, rows, SegmentMeasure::Param)),
        };
        let rim = Strand { curve, flow: &flow };
        for (row, strand) in strands.iter().enumerate() {
            let gap = (rim.boundary(row) - strand.boundary(end)).norm();
            if gap > GAP * size {
                return Err(ParametricError::CrossGap { curve: index + 1, gap });
            }
        }
        rims.push(Rim { curve: SpaceCurve::clone(curve), flow, end });
    }
    Ok(Some(rims))
}

/// A flow along a cross curve whose segments end at the joints of its arcs that meet the curves in order; `None` where the
/// curves meet it elsewhere.
fn by_joints(curve: &SpaceCurve, strands: &[Strand<'_>], end: usize, gap: f64) -> Option<Flow> {
    let mut joints = Vec::with_capacity(strands.len());
    let mut next = 0;
    for strand in strands {
        let place = strand.boundary(end);
        let joint = (next..=curve.arcs.len()).find(|joint| {
            let at = curve.evaluate_global(*joint as f64);
            at.is_some_and(|at| (at.position - place).norm() <= gap)
        })?;
        joints.push(joint);
        next = joint + 1;
    }
    let segments = joints.windows(2).map(|pair| FlowSegment {
        measure: SegmentMeasure::Param,
        first: pair[0] as f64,
        last: pair[1] as f64,
    });
    let ranges = vec![FlowRange { kind: FlowKind::Param, first: 0, last: curve.arcs.len() }];
    Some(Flow { ranges, segments: segments.collect() })
}

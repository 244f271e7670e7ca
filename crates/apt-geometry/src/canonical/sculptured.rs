//! Rows of numbers of sculptured surfaces and space curves: heads that give the counts, then control points.

use nalgebra::Vector4;

use super::{GeometryKind, values::CanonicalError, values::count};
use crate::{
    Vec3,
    parametric::{
        CurveArc, Edge, Flow, FlowKind, FlowRange, FlowSegment, Mesh, Neighbour, Patch, SculpturedSurface,
        SegmentMeasure, SpaceCurve,
    },
};

/// Numbers before the breaks and patches of a surface: patches, columns and rows of the grid (0 without one), side, splines
/// and cross splines, breaks. Those of the rows follow those of the columns, which then are given too.
const SURFACE_HEAD: usize = 7;
/// Numbers of a patch: 16 control points of four coordinates, and four words of neighbours.
const PATCH_VALUES: usize = 68;
/// Numbers before the arcs of a curve: arcs, ranges and segments of the flow.
const CURVE_HEAD: usize = 3;
/// Numbers of an arc: four control points of four coordinates.
const ARC_VALUES: usize = 16;
/// Numbers of an end of arcs: whether there is a cross direction, and its components. Where two arcs are one as the language
/// numbers them, the first is minus the share of it that lies before.
const CROSS_VALUES: usize = 4;
/// Numbers of a range of the flow: kind, tolerance, point, direction, first and last arc.
const RANGE_VALUES: usize = 10;
/// Numbers of a segment: measure, first and last parameter.
const SEGMENT_VALUES: usize = 3;
/// A word of a neighbour: `4·patch + edge`, then two bits for an edge that runs the other way and a smooth joint, each a
/// multiple of this so that every patch number fits in a number without rounding.
const NEIGHBOUR_BIT: f64 = (1u64 << 40) as f64;

/// The row of a surface (reference on sculptured surfaces 2.4, with the head reduced to what cannot be recomputed).
pub(super) fn surface_values(surface: &SculpturedSurface) -> Vec<f64> {
    let (columns, rows) = surface.grid.unwrap_or((0, 0));
    let Mesh { splines, cross_splines } = surface.mesh;
    let mut values: Vec<f64> =
        [surface.patches.len(), columns, rows].iter().map(|&number| number as f64).collect();
    values.push(surface.side);
    let mut breaks = surface.breaks.clone();
    if !surface.row_breaks.is_empty() {
        if breaks.is_empty() {
            breaks.extend((0..=columns).map(|column| column as f64));
        }
        breaks.extend(&surface.row_breaks);
    }
    values.extend([splines as f64, cross_splines as f64, breaks.len() as f64]);
    values.extend(breaks);
    for (index, patch) in surface.patches.iter().enumerate() {
        values.extend(patch.control.iter().flatten().flat_map(|point| point.iter().copied()));
        let neighbours = surface.neighbours.get(index).copied().unwrap_or_default();
        values.extend(neighbours.iter().map(neighbour_word));
    }
    values
}

/// The surface of a row.
///
/// # Errors
/// A count that is none, or another number of values than the head promises.
pub(super) fn surface_from(values: &[f64]) -> Result<SculpturedSurface, CanonicalError> {
    let kind = GeometryKind::Sculptured;
    let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
    let head = |position: usize| count(kind, values, position);
    let (patches, columns, rows) = (head(0)?, head(1)?, head(2)?);
    let mesh = Mesh { splines: head(4)?, cross_splines: head(5)? };
    let breaks = head(6)?;
    let patch_first = SURFACE_HEAD + breaks;
    let expected = patch_first + PATCH_VALUES.saturating_mul(patches);
    if values.len() != expected {
        return Err(CanonicalError::Count { kind, expected, found: values.len() });
    }
    if patches == 0 {
        return Err(CanonicalError::Value { kind, position: 0, value: 0.0 });
    }
    let grid = (columns > 0).then_some((columns, rows));
    if grid.is_some() && columns.saturating_mul(rows) != patches {
        return Err(CanonicalError::Value { kind, position: 1, value: columns as f64 });
    }
    let whole = if columns > 0 { columns } else { patches };
    let mut ends: Vec<f64> = (SURFACE_HEAD..patch_first).map(at).collect();
    let both = grid.is_some() && breaks == columns + rows + 2;
    let row_ends = if both { ends.split_off(whole + 1) } else { Vec::new() };
    let counted = ends.is_empty() || ends.len() == whole + 1;
    if !(counted && are_breaks(&ends, whole) && are_breaks(&row_ends, rows)) {
        return Err(CanonicalError::Value { kind, position: 6, value: breaks as f64 });
    }
    if both && ends.iter().enumerate().all(|(column, end)| *end == column as f64) {
        ends.clear();
    }
    finite(kind, values)?;
    if at(3).abs() != 1.0 {
        return Err(CanonicalError::Value { kind, position: 3, value: at(3) });
    }
    let patch = |index: usize| {
        let first = patch_first + PATCH_VALUES * index;
        let control = std::array::from_fn(|i| {
            std::array::from_fn(|j| Vector4::from_fn(|axis, _| at(first + 16 * i + 4 * j + axis)))
        });
        Patch { control }
    };
    let weights = |index: usize| (0..16).map(move |point| patch_first + PATCH_VALUES * index + 4 * point + 3);
    if let Some(position) = (0..patches).flat_map(weights).find(|&position| at(position) <= 0.0) {
        return Err(CanonicalError::Value { kind, position, value: at(position) });
    }
    let mut neighbours = Vec::with_capacity(patches);
    for index in 0..patches {
        let mut own = [None; 4];
        for (edge, place) in own.iter_mut().enumerate() {
            let position = patch_first + PATCH_VALUES * index + 64 + edge;
            *place = neighbour_from(at(position), patches).ok_or(CanonicalError::Value {
                kind,
                position,
                value: at(position),
            })?;
        }
        neighbours.push(own);
    }
    Ok(SculpturedSurface {
        patches: (0..patches).map(patch).collect(),
        grid,
        breaks: ends,
        row_breaks: row_ends,
        neighbours,
        side: at(3),
        mesh,
    })
}

/// Whether values can be the ends of so many columns or rows: they grow from 0 to a whole number.
fn are_breaks(ends: &[f64], count: usize) -> bool {
    let last = ends.last().copied().unwrap_or(0.0);
    ends.first().is_none_or(|first| *first == 0.0)
        && ends.windows(2).all(|pair| pair[0] < pair[1])
        && last.fract() == 0.0
        && last <= count as f64
}

/// Every number of these forms is finite: what is made of them is measured and searched.
fn finite(kind: GeometryKind, values: &[f64]) -> Result<(), CanonicalError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(position) => Err(CanonicalError::Value {
            kind,
            position,
            value: values.get(position).copied().unwrap_or(f64::NAN),
        }),
        None => Ok(()),
    }
}

fn neighbour_word(neighbour: &Option<Neighbour>) -> f64 {
    neighbour.map_or(-1.0, |neighbour| {
        let bits = f64::from(u8::from(neighbour.reversed) + 2 * u8::from(neighbour.smooth));
        (4 * neighbour.patch + neighbour.edge.number()) as f64 + bits * NEIGHBOUR_BIT
    })
}

/// The neighbour of a word; `None` if the word is none of a surface with so many patches.
fn neighbour_from(word: f64, patches: usize) -> Option<Option<Neighbour>> {
    if word == -1.0 {
        return Some(None);
    }
    if !(0.0..4.0 * NEIGHBOUR_BIT).contains(&word) || word.fract() != 0.0 {
        return None;
    }
    let (bits, number) = ((word / NEIGHBOUR_BIT) as u8, (word % NEIGHBOUR_BIT) as usize);
    let (patch, edge) = (number / 4, *Edge::ALL.get(number % 4)?);
    let neighbour = Neighbour { patch, edge, reversed: bits & 1 != 0, smooth: bits & 2 != 0 };
    (patch < patches).then_some(Some(neighbour))
}

/// The row of a curve.
pub(super) fn curve_values(curve: &SpaceCurve) -> Vec<f64> {
    let (ranges, segments) =
        curve.flow.as_ref().map_or((&[][..], &[][..]), |flow| (&flow.ranges[..], &flow.segments[..]));
    let mut values: Vec<f64> =
        [curve.arcs.len(), ranges.len(), segments.len()].iter().map(|&number| number as f64).collect();
    values.extend(
        curve.arcs.iter().flat_map(|arc| arc.control).flat_map(|point| [point.x, point.y, point.z, point.w]),
    );
    for index in 0..=curve.arcs.len() {
        let cross = curve.cross.get(index).copied().flatten();
        let vector = cross.unwrap_or_else(Vec3::zeros);
        let end = curve.numbered(index as f64);
        // Inside of an arc as the language numbers them there is no cross direction of its own.
        let given = if end.fract() > 0.0 { -end.fract() } else { f64::from(u8::from(cross.is_some())) };
        values.extend([given, vector.x, vector.y, vector.z]);
    }
    for range in ranges {
        let (kind, tolerance, point, direction) = match range.kind {
            FlowKind::Arc { tolerance } => (1.0, tolerance, Vec3::zeros(), Vec3::zeros()),
            FlowKind::Param => (2.0, 0.0, Vec3::zeros(), Vec3::zeros()),
            FlowKind::Chord { direction } => (3.0, 0.0, Vec3::zeros(), direction),
            FlowKind::Angle { center, axis } => (4.0, 0.0, center, axis),
        };
        values.extend([kind, tolerance, point.x, point.y, point.z, direction.x, direction.y, direction.z]);
        values.extend([range.first as f64, range.last as f64]);
    }
    for segment in segments {
        let measure = match segment.measure {
            SegmentMeasure::Length => 1.0,
            SegmentMeasure::Param => 2.0,
        };
        values.extend([measure, segment.first, segment.last]);
    }
    values
}

/// Where arcs end as the language numbers them, from the first values of the ends: negative shares lie inside of an arc.
fn breaks(firsts: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut whole = 0.0;
    let mut breaks = Vec::new();
    for first in firsts {
        if first > -1.0 && first < 0.0 {
            breaks.push(whole - 1.0 - first);
        } else {
            breaks.push(whole);
            whole += 1.0;
        }
    }
    let plain = breaks.iter().all(|end: &f64| end.fract() == 0.0);
    if plain { Vec::new() } else { breaks }
}

/// The curve of a row.
///
/// # Errors
/// A count or a code that is none, or another number of values than the head promises.
pub(super) fn curve_from(values: &[f64]) -> Result<SpaceCurve, CanonicalError> {
    let kind = GeometryKind::SpaceCurve;
    let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
    let head = |position: usize| count(kind, values, position);
    let (arcs, ranges, segments) = (head(0)?, head(1)?, head(2)?);
    if arcs == 0 {
        return Err(CanonicalError::Value { kind, position: 0, value: 0.0 });
    }
    let cross_first = CURVE_HEAD + ARC_VALUES * arcs;
    let range_first = cross_first + CROSS_VALUES * (arcs + 1);
    let segment_first = range_first + RANGE_VALUES * ranges;
    let expected = segment_first + SEGMENT_VALUES * segments;
    if values.len() != expected {
        return Err(CanonicalError::Count { kind, expected, found: values.len() });
    }
    finite(kind, values)?;
    let control = |index: usize| {
        let first = CURVE_HEAD + ARC_VALUES * index;
        std::array::from_fn(|point| Vector4::from_fn(|axis, _| at(first + 4 * point + axis)))
    };
    let mut weights = (0..4 * arcs).map(|point| CURVE_HEAD + 4 * point + 3);
    if let Some(position) = weights.find(|&position| at(position) <= 0.0) {
        return Err(CanonicalError::Value { kind, position, value: at(position) });
    }
    let vector = |first: usize| Vec3::new(at(first), at(first + 1), at(first + 2));
    let cross = |index: usize| {
        let first = cross_first + CROSS_VALUES * index;
        (at(first) == 1.0).then(|| vector(first + 1))
    };
    let range = |index: usize| -> Result<FlowRange, CanonicalError> {
        let first = range_first + RANGE_VALUES * index;
        let flow = match count(kind, values, first)? {
            1 => FlowKind::Arc { tolerance: at(first + 1) },
            2 => FlowKind::Param,
            3 => FlowKind::Chord { direction: vector(first + 5) },
            4 => FlowKind::Angle { center: vector(first + 2), axis: vector(first + 5) },
            other => return Err(CanonicalError::Value { kind, position: first, value: other as f64 }),
        };
        let (begin, end) = (head(first + 8)?, head(first + 9)?);
        if begin >= end || end > arcs {
            return Err(CanonicalError::Value { kind, position: first + 9, value: end as f64 });
        }
        Ok(FlowRange { kind: flow, first: begin, last: end })
    };
    let segment = |index: usize| -> Result<FlowSegment, CanonicalError> {
        let first = segment_first + SEGMENT_VALUES * index;
        let measure = match count(kind, values, first)? {
            1 => SegmentMeasure::Length,
            2 => SegmentMeasure::Param,
            other => return Err(CanonicalError::Value { kind, position: first, value: other as f64 }),
        };
        let (begin, end) = (at(first + 1), at(first + 2));
        if begin < 0.0 || begin >= end || end > arcs as f64 {
            return Err(CanonicalError::Value { kind, position: first + 2, value: end });
        }
        Ok(FlowSegment { measure, first: begin, last: end })
    };
    let ranges = (0..ranges).map(range).collect::<Result<Vec<_>, _>>()?;
    let segments = (0..segments).map(segment).collect::<Result<Vec<_>, _>>()?;
    Ok(SpaceCurve {
        arcs: (0..arcs).map(|index| CurveArc { control: control(index) }).collect(),
        breaks: breaks((0..=arcs).map(|index| at(cross_first + CROSS_VALUES * index))),
        cross: (0..=arcs).map(cross).collect(),
        flow: (!segments.is_empty()).then_some(Flow { ranges, segments }),
    })
}

//! SCURV: from typed arguments to a curve.

use std::sync::Arc;

use super::{
    parametric_error::ParametricError,
    sculptured_knots,
    space_curve::{
        CurveShape, Defined, FlowInput, FlowMeasure, ParametricNode, SegmentInput, SpaceCurveDefinition,
    },
    space_curve_bounded, space_curve_conic,
    spline::{self, Condition},
};
use crate::{
    Vec3,
    canonical::Matrix,
    parametric::{Flow, FlowKind, FlowRange, FlowSegment, SpaceCurve},
};

/// Most points of a spline.
const MOST_POINTS: usize = 10_000;
/// Distance of ends that should meet, as a share of the extent of the curves, above which there is a gap.
const GAP: f64 = 1e-6;
/// Factor of the tolerance of FLOW,ARC where none is given.
const FLOW_TOLERANCE: f64 = 0.005;
/// Length of the difference of two unit vectors below which they are one direction.
const PARALLEL: f64 = 1e-9;

impl SpaceCurveDefinition {
    /// A definition without FLOW and TRFORM.
    pub fn plain(shape: CurveShape) -> SpaceCurveDefinition {
        SpaceCurveDefinition { shape, flow: Vec::new(), segments: Vec::new(), matrix: None }
    }

    /// The curve, in the coordinates of the arguments.
    ///
    /// # Errors
    /// [`ParametricError`] says what cannot be made.
    pub fn define(&self) -> Result<Defined<SpaceCurve>, ParametricError> {
        let mut warnings = Vec::new();
        let mut curve = shape(&self.shape, &mut warnings)?;
        if !self.flow.is_empty() || !self.segments.is_empty() {
            curve.flow = Some(flow(&curve, &self.flow, &self.segments)?);
        }
        if let Some(matrix) = &self.matrix {
            curve = moved(&curve, matrix)?;
        }
        if !curve.is_finite() {
            return Err(ParametricError::NotFinite);
        }
        Ok(Defined { geometry: curve, warnings })
    }
}

fn moved(curve: &SpaceCurve, matrix: &Matrix) -> Result<SpaceCurve, ParametricError> {
    matrix.inverse().ok_or(ParametricError::SingularMatrix)?;
    Ok(curve.transformed(matrix))
}

fn shape(shape: &CurveShape, warnings: &mut Vec<ParametricError>) -> Result<SpaceCurve, ParametricError> {
    match shape {
        CurveShape::Conic { nodes } => Ok(with_cross(space_curve_conic::curve(nodes)?, nodes)),
        CurveShape::Spline { weight, limit, nodes } => spline_curve(nodes, *weight, *limit),
        CurveShape::Combined { curves } => combined(curves, warnings),
        CurveShape::Bounded { base, from, to, z_surface } => {
            space_curve_bounded::arcs(base, from, to, z_surface).map(SpaceCurve::of_arcs)
        }
        CurveShape::BSpline { degree, knots, points, weights } => {
            sculptured_knots::curve(*degree, knots, points, weights).map(SpaceCurve::of_arcs)
        }
    }
}

/// A curve whose ends have the cross directions of the first and the last point.
fn with_cross(mut curve: SpaceCurve, nodes: &[ParametricNode]) -> SpaceCurve {
    if let (Some(first), Some(last)) = (nodes.first(), nodes.last()) {
        let count = curve.cross.len();
        curve.cross[0] = first.cross;
        curve.cross[count - 1] = last.cross;
    }
    curve
}

fn spline_curve(
    nodes: &[ParametricNode],
    weight: Option<f64>,
    limit: Option<f64>,
) -> Result<SpaceCurve, ParametricError> {
    if nodes.len() < 2 {
        return Err(ParametricError::TooFew { least: 2, found: nodes.len() });
    }
    if nodes.len() > MOST_POINTS {
        let (value, greatest) = (nodes.len() as f64, MOST_POINTS as f64);
        return Err(ParametricError::OutOfRange { value, least: 2.0, greatest });
    }
    let points = spline::faired(nodes, weight, limit)?;
    let conditions: Vec<Condition> =
        nodes.iter().map(|node| Condition { direction: node.tangent, across: node.normal }).collect();
    let directions = spline::directions(&points, &conditions)?;
    let arcs = points
        .windows(2)
        .zip(directions.windows(2))
        .map(|(ends, ways)| spline::bending_arc(&ends[0], &ends[1], &ways[0], &ways[1]))
        .collect();
    let cross = nodes.iter().map(|node| node.cross).collect();
    Ok(SpaceCurve { cross, ..SpaceCurve::of_arcs(arcs) })
}

fn combined(
    curves: &[Arc<SpaceCurve>],
    warnings: &mut Vec<ParametricError>,
) -> Result<SpaceCurve, ParametricError> {
    if curves.is_empty() {
        return Err(ParametricError::TooFew { least: 1, found: 0 });
    }
    let mut joined = SpaceCurve { arcs: Vec::new(), breaks: Vec::new(), cross: Vec::new(), flow: None };
    let mut breaks = vec![0.0];
    for (index, curve) in curves.iter().enumerate() {
        if let (Some(before), Some(after)) = (joined.arcs.last(), curve.arcs.first()) {
            let gap = (before.evaluate(1.0).position - after.evaluate(0.0).position).norm();
            if gap > GAP * (curve.size() + joined.size()) {
                warnings.push(ParametricError::Gap { curve: index + 1, gap });
            }
        }
        joined.arcs.extend(curve.arcs.iter().copied());
        let before = breaks.last().copied().unwrap_or(0.0);
        breaks.extend((1..=curve.arcs.len()).map(|end| before + curve.numbered(end as f64)));
        let mut cross = curve.cross.iter().copied();
        if index > 0 {
            // The joint belongs to both: the earlier curve's direction counts, if it has one.
            let second = cross.next().flatten();
            if let Some(joint) = joined.cross.last_mut() {
                *joint = joint.or(second);
            }
        }
        joined.cross.extend(cross);
    }
    if curves.iter().any(|curve| !curve.breaks.is_empty()) {
        joined.breaks = breaks;
    }
    // A single curve keeps its flow: it is a copy.
    if let [single] = curves {
        joined.flow.clone_from(&single.flow);
    }
    Ok(joined)
}

fn flow(
    curve: &SpaceCurve,
    ranges: &[FlowInput],
    segments: &[SegmentInput],
) -> Result<Flow, ParametricError> {
    if segments.is_empty() {
        return Err(ParametricError::FlowWithoutSegments);
    }
    if ranges.is_empty() {
        return Err(ParametricError::SegmentsWithoutFlow);
    }
    let count = curve.count() as f64;
    let mut built = Vec::with_capacity(ranges.len());
    let mut before = None;
    for (index, range) in ranges.iter().enumerate() {
        ordered(index + 1, range.first, range.last, before, count)?;
        for value in [range.first, range.last] {
            if value.fract() != 0.0 {
                return Err(ParametricError::OutOfRange { value, least: 0.0, greatest: count });
            }
        }
        before = Some(range.last);
        let [first, last] = [range.first, range.last].map(|end| curve.unnumbered(end));
        let kind = flow_kind(curve, &range.measure, first)?;
        built.push(FlowRange { kind, first: first.round() as usize, last: last.round() as usize });
    }
    let (low, high) = (ranges.first().map_or(0.0, |range| range.first), before.unwrap_or(count));
    let mut before = None;
    let mut cut = Vec::with_capacity(segments.len());
    for (index, segment) in segments.iter().enumerate() {
        ordered(index + 1, segment.first, segment.last, before, count)?;
        for value in [segment.first, segment.last] {
            if value < low || value > high {
                return Err(ParametricError::OutOfRange { value, least: low, greatest: high });
            }
        }
        before = Some(segment.last);
        let [first, last] = [segment.first, segment.last].map(|end| curve.unnumbered(end));
        cut.push(FlowSegment { measure: segment.measure, first, last });
    }
    let flow = Flow { ranges: built, segments: cut };
    flow.check(curve).map_err(|range| ParametricError::FlowNotMonotone { number: range + 1 })?;
    Ok(flow)
}

/// A range must grow, stay on the curve and begin where the one before it ended.
fn ordered(
    number: usize,
    first: f64,
    last: f64,
    before: Option<f64>,
    count: f64,
) -> Result<(), ParametricError> {
    for value in [first, last] {
        if !(0.0..=count).contains(&value) {
            return Err(ParametricError::OutOfRange { value, least: 0.0, greatest: count });
        }
    }
    if first >= last || before.is_some_and(|before| before != first) {
        return Err(ParametricError::RangeOrder { number });
    }
    Ok(())
}

fn flow_kind(curve: &SpaceCurve, measure: &FlowMeasure, first: f64) -> Result<FlowKind, ParametricError> {
    Ok(match measure {
        FlowMeasure::Arc(tolerance) => FlowKind::Arc { tolerance: tolerance.unwrap_or(FLOW_TOLERANCE) },
        FlowMeasure::Param => FlowKind::Param,
        FlowMeasure::Chord(vector) => FlowKind::Chord { direction: unit(vector)? },
        FlowMeasure::Angle(center, reference) => {
            let axis = match reference {
                Some(vector) => unit(vector)?,
                None => turning_axis(curve, center, first)?,
            };
            FlowKind::Angle { center: *center, axis }
        }
    })
}

/// The axis about which a curve turns round a point: across the first ray and a later one, along z where these are in a
/// plane that contains z.
fn turning_axis(curve: &SpaceCurve, center: &Vec3, first: f64) -> Result<Vec3, ParametricError> {
    let ray = |parameter: f64| {
        let at = curve.evaluate_global(parameter).ok_or(ParametricError::NotFinite)?;
        unit(&(at.position - center))
    };
    let start = ray(first)?;
    // A quarter of an arc on, so that less than half a turn lies between.
    let axis = start.cross(&ray(first + 0.25)?);
    if axis.norm() <= PARALLEL {
        return Err(ParametricError::ZeroVector);
    }
    let axis = axis.normalize();
    Ok(axis)
}

fn unit(vector: &Vec3) -> Result<Vec3, ParametricError> {
    vector.try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::ZeroVector)
}

//! SCURV: the forms of space curves read into typed definitions (sculptured surfaces reference 1.2).

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Matrix},
    definition::{
        CurveShape, FlowInput, FlowMeasure, LineOrCircle, ParametricNode, SegmentInput, SegmentSide,
        SpaceCurveDefinition,
    },
    parametric::SegmentMeasure,
};

use super::reader::{Misfit, Read, Reader};
use crate::{expression::Item, finding::Expected};

/// The words after SCURV.
const SHAPES: &[&str] = &["SPLINE", "CURSEG", "COMBIN", "SEG", "NURBS", "CANON"];
/// What picks an intersection of SEG.
const SIDES: &[&str] = &["POSX", "NEGX", "POSY", "NEGY"];
/// What a flow measures.
const MEASURES: &[&str] = &["ARC", "PARAM", "CHORD", "ANGLE"];
/// What segments are laid out by.
const LAYOUTS: &[&str] = &["LENGTH", "PARAM"];

/// The qualifiers behind points of CURSEG.
const OF_CONICS: &[&str] = &["TANSPL", "NORMAL", "CRSSPL"];
/// The qualifiers behind points of SPLINE, in curves and meshes.
const OF_SPLINES: &[&str] = &["TANSPL", "NORMAL", "CRSSPL", "WEIGHT", "LIMIT"];
/// What stands before the first point of SPLINE for all of them.
const OF_ALL: &[&str] = &["WEIGHT", "LIMIT"];

/// Reads what follows SCURV.
pub(super) fn definition(
    reader: &mut Reader<'_>,
    z_surface: apt_geometry::canonical::Plane,
) -> Read<SpaceCurveDefinition> {
    let shape = match reader.word(SHAPES)? {
        "SPLINE" => spline(reader)?,
        "CURSEG" => CurveShape::Conic { nodes: nodes(reader, OF_CONICS)? },
        "COMBIN" => CurveShape::Combined { curves: reader.curves()? },
        "SEG" => bounded(reader, z_surface)?,
        "NURBS" => nurbs(reader)?,
        // Canonical numbers are taken where all types take them.
        _ => return Err(reader.misfit(Expected::Words(SHAPES))),
    };
    let flow = flow(reader)?;
    let segments = segments(reader)?;
    let matrix = transformation(reader)?;
    reader.end()?;
    Ok(SpaceCurveDefinition { shape, flow, segments, matrix })
}

/// `[TRFORM,matrix]`
pub(super) fn transformation(reader: &mut Reader<'_>) -> Read<Option<Matrix>> {
    if !reader.eat("TRFORM") {
        return Ok(None);
    }
    match reader.peek().and_then(Item::geometry) {
        Some(Geometry::Matrix(matrix)) => {
            reader.skip();
            Ok(Some(*matrix))
        }
        _ => Err(reader.misfit(Expected::Matrix)),
    }
}

/// `[WEIGHT,w][,LIMIT,l],p1[,…],…`: before the first point for all points.
fn spline(reader: &mut Reader<'_>) -> Read<CurveShape> {
    let [weight, limit] = fairing(reader)?;
    Ok(CurveShape::Spline { weight, limit, nodes: nodes(reader, OF_SPLINES)? })
}

/// A row of a mesh, which is written like a spline.
pub(super) fn row(reader: &mut Reader<'_>) -> Read<Vec<ParametricNode>> {
    let [weight, limit] = fairing(reader)?;
    let mut nodes = nodes(reader, OF_SPLINES)?;
    for node in &mut nodes {
        node.weight = node.weight.or(weight);
        node.limit = node.limit.or(limit);
    }
    Ok(nodes)
}

/// `[WEIGHT,w][,LIMIT,l],` in any order: weight and limit of all points.
fn fairing(reader: &mut Reader<'_>) -> Read<[Option<f64>; 2]> {
    let (mut weight, mut limit) = (None, None);
    while let Some(word) = reader.peek_word().filter(|word| OF_ALL.contains(word)) {
        let value = if word == "WEIGHT" { &mut weight } else { &mut limit };
        if value.is_some() {
            break;
        }
        reader.skip();
        *value = Some(reader.scalar()?);
    }
    Ok([weight, limit])
}

/// Points with their qualifiers, at least one.
fn nodes(reader: &mut Reader<'_>, qualifiers: &[&str]) -> Read<Vec<ParametricNode>> {
    let mut nodes = vec![node(reader, qualifiers)?];
    while reader.peek().and_then(Item::point).is_some() {
        nodes.push(node(reader, qualifiers)?);
    }
    match reader.peek() {
        // A number or other geometry where the next point should be.
        Some(item) if item.word().is_none() => Err(reader.misfit(Expected::Point)),
        _ => Ok(nodes),
    }
}

/// One point with its qualifiers, each once and in any order.
fn node(reader: &mut Reader<'_>, qualifiers: &[&str]) -> Read<ParametricNode> {
    let mut node = ParametricNode::plain(reader.point()?);
    while let Some(word) = reader.peek_word().filter(|word| qualifiers.contains(word)) {
        let again = match word {
            "TANSPL" => node.tangent.is_some(),
            "NORMAL" => node.normal.is_some(),
            "CRSSPL" => node.cross.is_some(),
            "WEIGHT" => node.weight.is_some(),
            _ => node.limit.is_some(),
        };
        if again {
            break;
        }
        reader.skip();
        match word {
            "TANSPL" => node.tangent = Some(reader.any_vector()?),
            "NORMAL" => node.normal = Some(reader.any_vector()?),
            "CRSSPL" => node.cross = Some(reader.any_vector()?),
            "WEIGHT" => node.weight = Some(reader.scalar()?),
            _ => node.limit = Some(reader.scalar()?),
        }
    }
    Ok(node)
}

/// `line-or-circle,b1,side,b2,side`
fn bounded(reader: &mut Reader<'_>, z_surface: apt_geometry::canonical::Plane) -> Read<CurveShape> {
    let base = line_or_circle(reader)?;
    let mut bound = || {
        let line = line_or_circle(reader)?;
        let side = match reader.word(SIDES)? {
            "POSX" => SegmentSide::PositiveX,
            "NEGX" => SegmentSide::NegativeX,
            "POSY" => SegmentSide::PositiveY,
            _ => SegmentSide::NegativeY,
        };
        Ok::<_, Misfit>((line, side))
    };
    let (from, to) = (bound()?, bound()?);
    Ok(CurveShape::Bounded { base, from, to, z_surface })
}

fn line_or_circle(reader: &mut Reader<'_>) -> Read<LineOrCircle> {
    let found = match reader.peek().and_then(Item::geometry) {
        Some(Geometry::Line(line)) => LineOrCircle::Line(*line),
        Some(Geometry::Circle(circle)) => LineOrCircle::Circle(*circle),
        _ => return Err(reader.misfit(Expected::LineOrCircle)),
    };
    reader.skip();
    Ok(found)
}

/// `DEGREE,k,KNOTS,t,…,PTS,p,…[,WEIGHT,w,…]`
fn nurbs(reader: &mut Reader<'_>) -> Read<CurveShape> {
    reader.word(&["DEGREE"])?;
    let degree = reader.count()?;
    reader.word(&["KNOTS"])?;
    let knots = reader.scalars();
    reader.word(&["PTS"])?;
    let points = reader.points()?;
    let weights = weights(reader, points.len());
    Ok(CurveShape::BSpline { degree, knots, points, weights })
}

/// `[WEIGHT,w,…]`; all 1 where none are given.
pub(super) fn weights(reader: &mut Reader<'_>, count: usize) -> Vec<f64> {
    if reader.eat("WEIGHT") { reader.scalars() } else { vec![1.0; count] }
}

/// `[FLOW,kind,n1,n2[,data][,kind,…]…]`
fn flow(reader: &mut Reader<'_>) -> Read<Vec<FlowInput>> {
    let mut ranges = Vec::new();
    if !reader.eat("FLOW") {
        return Ok(ranges);
    }
    loop {
        let word = reader.word(MEASURES)?;
        let (first, last) = (reader.scalar()?, reader.scalar()?);
        let measure = match word {
            "ARC" => FlowMeasure::Arc(reader.perhaps_scalar()),
            "PARAM" => FlowMeasure::Param,
            "CHORD" => FlowMeasure::Chord(chord(reader)?),
            _ => {
                let center = reader.point()?;
                let reference = reader.peek().and_then(Item::vector);
                if reference.is_some() {
                    reader.skip();
                }
                FlowMeasure::Angle(center, reference)
            }
        };
        ranges.push(FlowInput { measure, first, last });
        if reader.peek_word().is_none_or(|word| !MEASURES.contains(&word)) {
            return Ok(ranges);
        }
    }
}

/// A vector, or two points with their difference.
fn chord(reader: &mut Reader<'_>) -> Read<Vec3> {
    if reader.peek().and_then(Item::point).is_none() {
        return reader.any_vector();
    }
    let (from, to) = (reader.point()?, reader.point()?);
    Ok(to - from)
}

/// `[SEG,{LENGTH|PARAM},n1,n2[,{LENGTH|PARAM},…]…]`
fn segments(reader: &mut Reader<'_>) -> Read<Vec<SegmentInput>> {
    let mut segments = Vec::new();
    if !reader.eat("SEG") {
        return Ok(segments);
    }
    loop {
        let measure = match reader.word(LAYOUTS)? {
            "LENGTH" => SegmentMeasure::Length,
            _ => SegmentMeasure::Param,
        };
        let (first, last) = (reader.scalar()?, reader.scalar()?);
        segments.push(SegmentInput { measure, first, last });
        if reader.peek_word().is_none_or(|word| !LAYOUTS.contains(&word)) {
            return Ok(segments);
        }
    }
}

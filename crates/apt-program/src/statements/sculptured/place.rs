//! POINT/INTOF and VECTOR/INTOF of space curves and sculptured surfaces, and what PARMF and NUMF ask of them (sculptured
//! surfaces reference 1.3).

use std::sync::Arc;

use apt_geometry::{
    canonical::{Geometry, GeometryKind, Remembering},
    definition::{CurveParameter, ParametricDirection, ParametricError, ParametricPlace, ParametricQuery},
    parametric::{SculpturedSurface, SpaceCurve},
};
use apt_syntax::{TextRange, statement::Argument};
use smol_str::SmolStr;

use super::reader::{Read, Reader};
use crate::{evaluator::Evaluator, expression::Item, finding::Expected};

/// What VECTOR/INTOF takes of the place.
const DIRECTIONS: &[&str] = &["TANSPL", "CRSSPL", "NORMAL", "BINORM"];

/// What stands behind INTOF.
struct Question {
    query: ParametricQuery,
    /// The direction of a VECTOR, and whether it is made unit.
    direction: Option<(ParametricDirection, bool)>,
}

/// Whether these are the operands of an intersection with a space curve or a sculptured surface.
pub(in crate::statements) fn asks_parametric(kind: GeometryKind, items: &[Item]) -> bool {
    let parametric =
        |item: &Item| matches!(item.geometry(), Some(Geometry::Sculptured(_) | Geometry::SpaceCurve(_)));
    matches!(kind, GeometryKind::Point | GeometryKind::Vector)
        && items.first().and_then(Item::word) == Some("INTOF")
        && items.iter().any(parametric)
}

impl Evaluator<'_> {
    /// The point or vector of an INTOF; its parameters are kept for PARMF.
    pub(in crate::statements) fn intersection(
        &mut self,
        kind: GeometryKind,
        items: &[Item],
        range: TextRange,
    ) -> Option<Geometry> {
        let mut reader = Reader::new(items, range);
        reader.skip();
        let question = match question(&mut reader, kind) {
            Ok(question) => question,
            Err(misfit) => {
                self.misfit_of(SmolStr::new_static(kind.word()), misfit);
                return None;
            }
        };
        match answer(&question) {
            Ok((place, geometry)) => {
                self.state.intersection = Some(Arc::new(place));
                Some(geometry)
            }
            Err(error) => {
                let statement = SmolStr::new_static(kind.word());
                self.report_parametric(statement, error, range);
                None
            }
        }
    }

    /// PARMF: a parameter of the last INTOF. Before any, APT4 goes on with 0 and does not look at the arguments.
    pub(crate) fn intersection_parameter(&mut self, arguments: &[Argument], range: TextRange) -> Option<f64> {
        let statement = SmolStr::new_static("PARMF");
        let Some(place) = self.state.intersection.clone() else {
            let error = ParametricError::NoPlaceYet;
            self.report_parametric(statement, error, range);
            return Some(0.0);
        };
        let items = self.operands(arguments)?;
        match parameter(&mut Reader::new(&items, range), &place) {
            Ok(Some(value)) => Some(value),
            Ok(None) => {
                let error = ParametricError::NoPlaceYet;
                self.report_parametric(statement, error, range);
                None
            }
            Err(misfit) => {
                self.misfit_of(statement, misfit);
                None
            }
        }
    }

    /// NUMF of a space curve or a sculptured surface.
    pub(crate) fn parametric_count(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        match count(&mut Reader::new(items, range)) {
            Ok(count) => Some(count),
            Err(misfit) => {
                self.misfit_of(SmolStr::new_static("NUMF"), misfit);
                None
            }
        }
    }
}

/// The place and what the definition makes of it.
fn answer(question: &Question) -> Result<(ParametricPlace, Geometry), ParametricError> {
    let place = question.query.find()?;
    let geometry = match question.direction {
        Some((direction, unit)) => Geometry::Vector(question.query.direction(direction, unit)?),
        None => {
            let (ParametricPlace::Surface { position, .. } | ParametricPlace::Curve { position, .. }) =
                &place;
            Geometry::Point(*position)
        }
    };
    Ok((place, geometry))
}

/// Reads what stands behind INTOF.
fn question(reader: &mut Reader<'_>, kind: GeometryKind) -> Read<Question> {
    let query = match reader.peek().and_then(Item::geometry) {
        Some(Geometry::Sculptured(surface)) => {
            reader.skip();
            surface_query(reader, surface.clone())?
        }
        Some(Geometry::SpaceCurve(curve)) => {
            reader.skip();
            curve_query(reader, Arc::clone(curve))?
        }
        Some(Geometry::Line(plane) | Geometry::Plane(plane)) => {
            let plane = *plane;
            reader.skip();
            ParametricQuery::CurvePlane { curve: reader.curve()?, plane, near: reader.point()? }
        }
        _ => return Err(reader.misfit(Expected::SculpturedElement)),
    };
    let direction = if kind == GeometryKind::Vector { Some(direction(reader)?) } else { None };
    reader.end()?;
    Ok(Question { query, direction })
}

/// `{TANSPL|CRSSPL|NORMAL|BINORM}[,UNIT]`
fn direction(reader: &mut Reader<'_>) -> Read<(ParametricDirection, bool)> {
    let direction = match reader.word(DIRECTIONS)? {
        "TANSPL" => ParametricDirection::Tangent,
        "CRSSPL" => ParametricDirection::Cross,
        "NORMAL" => ParametricDirection::Normal,
        _ => ParametricDirection::Binormal,
    };
    Ok((direction, reader.eat("UNIT")))
}

/// `PARAM,u,v,k`, `p`, `p,q`, `p,v` or `p,v,q`
fn surface_query(reader: &mut Reader<'_>, surface: Remembering<SculpturedSurface>) -> Read<ParametricQuery> {
    if reader.eat("PARAM") {
        let (u, v, patch) = (reader.scalar()?, reader.scalar()?, reader.scalar()?);
        return Ok(ParametricQuery::SurfaceParameters { surface, u, v, patch });
    }
    let point = reader.point()?;
    if let Some(through) = reader.peek().and_then(Item::point) {
        reader.skip();
        let direction = through - point;
        return Ok(ParametricQuery::SurfaceLine { surface, point, direction, near: point });
    }
    let Some(direction) = reader.peek().and_then(Item::vector) else {
        return Ok(ParametricQuery::SurfaceNearest { surface, point });
    };
    reader.skip();
    let near = reader.peek().and_then(Item::point);
    if near.is_some() {
        reader.skip();
    }
    Ok(ParametricQuery::SurfaceLine { surface, point, direction, near: near.unwrap_or(point) })
}

/// `{PARAM|FLOW},u[,k]`; without k the parameter is global.
fn curve_query(reader: &mut Reader<'_>, curve: Arc<SpaceCurve>) -> Read<ParametricQuery> {
    let kind = match reader.word(&["PARAM", "FLOW"])? {
        "FLOW" => CurveParameter::Flow,
        _ => CurveParameter::Param,
    };
    let value = reader.scalar()?;
    let number = reader.perhaps_scalar().unwrap_or(0.0);
    Ok(ParametricQuery::CurveParameter { curve, kind, value, number })
}

/// What PARMF asks for; nothing if the last INTOF has no such parameter.
fn parameter(reader: &mut Reader<'_>, place: &ParametricPlace) -> Read<Option<f64>> {
    let value = match reader.peek().and_then(Item::geometry) {
        Some(Geometry::SpaceCurve(_)) => {
            reader.skip();
            let by_flow = reader.peek().is_some() && reader.word(&["PARAM", "FLOW"])? == "FLOW";
            curve_parameter(place, by_flow)
        }
        Some(Geometry::Sculptured(_)) => {
            reader.skip();
            let word = match reader.peek() {
                None => "UPARAM",
                Some(_) => reader.word(&["UPARAM", "VPARAM", "PATCH"])?,
            };
            surface_parameter(place, word)
        }
        _ => {
            let word = reader.word(&["UVAL", "VVAL", "PVAL", "TVAL", "SVAL"])?;
            match word {
                "TVAL" | "SVAL" => local_curve_parameter(place, word),
                word => surface_parameter(place, word),
            }
        }
    };
    reader.end()?;
    Ok(value)
}

/// A parameter of a place on a surface.
fn surface_parameter(place: &ParametricPlace, word: &str) -> Option<f64> {
    let ParametricPlace::Surface { patch, local, global, .. } = place else { return None };
    Some(match word {
        "UVAL" => local[0],
        "VVAL" => local[1],
        "UPARAM" => global[0],
        "VPARAM" => global[1],
        _ => *patch as f64,
    })
}

/// TVAL and SVAL.
fn local_curve_parameter(place: &ParametricPlace, word: &str) -> Option<f64> {
    let ParametricPlace::Curve { arc, local, .. } = place else { return None };
    Some(if word == "TVAL" { *local } else { *arc as f64 })
}

/// The global parameter of a place on a curve.
fn curve_parameter(place: &ParametricPlace, by_flow: bool) -> Option<f64> {
    let ParametricPlace::Curve { global, flow, .. } = place else { return None };
    if by_flow { *flow } else { Some(*global) }
}

/// What NUMF counts.
fn count(reader: &mut Reader<'_>) -> Read<f64> {
    let (geometry, words): (_, &'static [&'static str]) = match reader.peek().and_then(Item::geometry) {
        Some(geometry @ Geometry::SpaceCurve(_)) => (geometry, &["ARC", "SEG"]),
        Some(geometry @ Geometry::Sculptured(_)) => (geometry, &["PATCH", "SPLINE", "CRSSPL"]),
        _ => return Err(reader.misfit(Expected::SculpturedElement)),
    };
    reader.skip();
    let word = match reader.peek() {
        None => "",
        Some(_) => reader.word(words)?,
    };
    reader.end()?;
    let count = match geometry {
        Geometry::SpaceCurve(curve) if word == "SEG" => {
            curve.flow.as_ref().map_or(0, |flow| flow.segments.len())
        }
        Geometry::SpaceCurve(curve) => curve.count(),
        Geometry::Sculptured(surface) => match word {
            "SPLINE" => surface.mesh.splines,
            "CRSSPL" => surface.mesh.cross_splines,
            _ => surface.count(),
        },
        _ => 0,
    };
    Ok(count as f64)
}

//! What INTOF, PARMF and NUMF ask of parametric geometry, as typed arguments.

use std::sync::Arc;

use super::parametric_error::ParametricError;
use crate::{
    Vec3,
    canonical::{Plane, Remembering},
    parametric::{SculpturedSurface, SpaceCurve},
};

/// A parameter that lies outside its range by less than this belongs to its end: operands are decimal numbers.
const PARAMETER_SLACK: f64 = 1e-12;

/// PARAM or FLOW.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveParameter {
    /// PARAM: the parameter of the arcs.
    Param,
    /// FLOW: that of the segments of the flow.
    Flow,
}

/// Where INTOF looks.
#[derive(Debug, Clone, PartialEq)]
pub enum ParametricQuery {
    /// `s,PARAM,u,v,k`.
    SurfaceParameters {
        /// The surface.
        surface: Remembering<SculpturedSurface>,
        /// u, local to the patch or global.
        u: f64,
        /// v likewise.
        v: f64,
        /// Patch number from 1, 0 for global parameters, −1 for the last patch.
        patch: f64,
    },
    /// `c,{PARAM|FLOW},u[,k]`.
    CurveParameter {
        /// The curve.
        curve: Arc<SpaceCurve>,
        /// Which parameter.
        kind: CurveParameter,
        /// Its value, local to the arc or segment or global.
        value: f64,
        /// Arc or segment number from 1, 0 for global, −1 for the last one.
        number: f64,
    },
    /// `s,p`: the place nearest to a point.
    SurfaceNearest {
        /// The surface.
        surface: Remembering<SculpturedSurface>,
        /// The point.
        point: Vec3,
    },
    /// `s,p,q`, `s,p,v` and `s,p,v,q`: on a line.
    SurfaceLine {
        /// The surface.
        surface: Remembering<SculpturedSurface>,
        /// A point of the line.
        point: Vec3,
        /// Its direction, of any length.
        direction: Vec3,
        /// Of several places the one nearest to this point is meant.
        near: Vec3,
    },
    /// `{line|plane},c,p`: a curve and a plane (a line is one that contains the z direction).
    CurvePlane {
        /// The curve.
        curve: Arc<SpaceCurve>,
        /// The plane.
        plane: Plane,
        /// Of several places the one nearest to this point is meant.
        near: Vec3,
    },
}

/// What VECTOR/INTOF takes of the place found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParametricDirection {
    /// TANSPL: the derivative along the spline.
    Tangent,
    /// CRSSPL: the derivative across.
    Cross,
    /// NORMAL.
    Normal,
    /// BINORM.
    Binormal,
}

/// A place on parametric geometry, with the parameters that PARMF gives. Numbers count from 1.
#[derive(Debug, Clone, PartialEq)]
pub enum ParametricPlace {
    /// On a surface.
    Surface {
        /// The place.
        position: Vec3,
        /// Number of the patch.
        patch: usize,
        /// Local parameters.
        local: [f64; 2],
        /// Global parameters.
        global: [f64; 2],
    },
    /// On a curve.
    Curve {
        /// The place.
        position: Vec3,
        /// Number of the arc.
        arc: usize,
        /// Local parameter of the arc.
        local: f64,
        /// Global parameter of the arcs.
        global: f64,
        /// Global parameter of the flow, where the curve has one and the place is on it.
        flow: Option<f64>,
    },
}

/// What NUMF counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParametricCount {
    /// ARC: arcs of a curve.
    Arcs,
    /// SEG: segments of the flow of a curve.
    Segments,
    /// PATCH: patches of a surface.
    Patches,
    /// SPLINE: splines of a surface.
    Splines,
    /// CRSSPL: cross splines of a surface.
    CrossSplines,
}

/// A number of a part that is a whole number.
fn part(number: f64, count: usize) -> Result<i64, ParametricError> {
    let fault = ParametricError::NoSuchPart { number, count };
    if number.fract() != 0.0 || number < -1.0 || number > count as f64 {
        return Err(fault);
    }
    Ok(number as i64)
}

fn inside(value: f64, greatest: f64) -> Result<(), ParametricError> {
    if value >= -PARAMETER_SLACK && value <= greatest + PARAMETER_SLACK * greatest.max(1.0) {
        Ok(())
    } else {
        Err(ParametricError::OutOfRange { value, least: 0.0, greatest })
    }
}

impl ParametricQuery {
    /// The place that the question means.
    ///
    /// # Errors
    /// Parameters or numbers outside the geometry, or no such place.
    pub fn find(&self) -> Result<ParametricPlace, ParametricError> {
        match self {
            ParametricQuery::SurfaceParameters { surface, u, v, patch } => {
                let number = part(*patch, surface.count())?;
                let [u, v] = if number == 0 {
                    let [width, height] = surface.extent();
                    inside(*u, width)?;
                    inside(*v, height)?;
                    [*u, *v]
                } else {
                    inside(*u, 1.0)?;
                    inside(*v, 1.0)?;
                    let number = if number < 0 { surface.count() } else { number as usize };
                    let place = surface.unnumbered(number, u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
                    return surface_place(surface, place, Some((number, [*u, *v])));
                };
                surface_place(surface, [u, v], None)
            }
            ParametricQuery::CurveParameter { curve, kind, value, number } => {
                curve_parameter(curve, *kind, *value, *number)
            }
            ParametricQuery::SurfaceNearest { surface, point } => {
                let found = surface.nearest(point).map_err(|miss| ParametricError::NoPlace { miss })?;
                surface_place(surface, surface.globally(found.patch, found.local[0], found.local[1]), None)
            }
            ParametricQuery::SurfaceLine { surface, point, direction, near } => {
                if direction.norm() <= f64::MIN_POSITIVE {
                    return Err(ParametricError::ZeroVector);
                }
                let found = surface
                    .pierced(point, direction, near)
                    .map_err(|miss| ParametricError::NoPlace { miss })?;
                surface_place(surface, surface.globally(found.patch, found.local[0], found.local[1]), None)
            }
            ParametricQuery::CurvePlane { curve, plane, near } => {
                if plane.normal.norm() <= f64::MIN_POSITIVE {
                    return Err(ParametricError::ZeroVector);
                }
                let (arc, local) =
                    curve.crossed(plane, near).map_err(|miss| ParametricError::NoPlace { miss })?;
                curve_place(curve, arc, local)
            }
        }
    }

    /// A direction at the place that the question means: not of unit length unless `unit` asks for it.
    ///
    /// NORMAL of a surface is `∂u × ∂v` without the sign word. NORMAL of a curve is its cross direction × its tangent,
    /// BINORM its first × its second derivative.
    ///
    /// # Errors
    /// The place does not exist, or the geometry has no such direction there.
    pub fn direction(&self, kind: ParametricDirection, unit: bool) -> Result<Vec3, ParametricError> {
        let vector = match (self, self.find()?) {
            (
                ParametricQuery::SurfaceParameters { surface, .. }
                | ParametricQuery::SurfaceNearest { surface, .. }
                | ParametricQuery::SurfaceLine { surface, .. },
                ParametricPlace::Surface { global: [u, v], .. },
            ) => {
                let at = surface.evaluate_global(u, v).ok_or(ParametricError::NoDirection)?;
                match kind {
                    ParametricDirection::Tangent => at.du,
                    ParametricDirection::Cross => at.dv,
                    ParametricDirection::Normal if at.regular_normal().is_some() => at.du.cross(&at.dv),
                    ParametricDirection::Normal => {
                        surface.normal_global(u, v).ok_or(ParametricError::NoDirection)?.direction
                    }
                    ParametricDirection::Binormal => return Err(ParametricError::NoDirection),
                }
            }
            (
                ParametricQuery::CurveParameter { curve, .. } | ParametricQuery::CurvePlane { curve, .. },
                ParametricPlace::Curve { arc, local, global, .. },
            ) => {
                let (index, t) = curve.within(arc, local).ok_or(ParametricError::NoDirection)?;
                let mut at = curve.arcs.get(index).ok_or(ParametricError::NoDirection)?.evaluate(t);
                let rate = curve.rate(index);
                if rate != 1.0 {
                    (at.first, at.second) = (at.first * rate, at.second * (rate * rate));
                }
                let cross = curve.cross_at(curve.unnumbered(global));
                match kind {
                    ParametricDirection::Tangent => at.first,
                    ParametricDirection::Cross => cross,
                    ParametricDirection::Normal => cross.cross(&at.first),
                    ParametricDirection::Binormal => at.frame().binormal * at.first.cross(&at.second).norm(),
                }
            }
            _ => return Err(ParametricError::NoDirection),
        };
        let direction = vector.try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::NoDirection)?;
        Ok(if unit { direction } else { vector })
    }
}

fn surface_place(
    surface: &SculpturedSurface,
    [u, v]: [f64; 2],
    numbered: Option<(usize, [f64; 2])>,
) -> Result<ParametricPlace, ParametricError> {
    let at = surface.evaluate_global(u, v).ok_or(ParametricError::NoDirection)?;
    let (patch, local) = numbered.or_else(|| surface.numbered(u, v)).ok_or(ParametricError::NoDirection)?;
    Ok(ParametricPlace::Surface { position: at.position, patch, local, global: [u, v] })
}

fn curve_parameter(
    curve: &SpaceCurve,
    kind: CurveParameter,
    value: f64,
    number: f64,
) -> Result<ParametricPlace, ParametricError> {
    match kind {
        CurveParameter::Param => {
            let count = curve.count();
            let number = part(number, count)?;
            let found = if number == 0 {
                inside(value, count as f64)?;
                curve.locate(curve.unnumbered(value))
            } else {
                inside(value, 1.0)?;
                curve.within(if number < 0 { count } else { number as usize }, value)
            };
            let (arc, local) = found.ok_or(ParametricError::NoDirection)?;
            curve_place(curve, arc, local)
        }
        CurveParameter::Flow => {
            let flow = curve.flow.as_ref().ok_or(ParametricError::NoFlow { curve: 1 })?;
            let count = flow.segments.len();
            let number = part(number, count)?;
            let (segment, local) = if number == 0 {
                inside(value, count as f64)?;
                let value = value.clamp(0.0, count as f64);
                let segment = (value as usize).min(count - 1);
                (segment, value - segment as f64)
            } else {
                inside(value, 1.0)?;
                (if number < 0 { count } else { number as usize } - 1, value)
            };
            let parameter = flow.arc_parameter(curve, segment, local).ok_or(ParametricError::NoDirection)?;
            let (arc, local) = curve.locate(parameter).ok_or(ParametricError::NoDirection)?;
            curve_place(curve, arc, local)
        }
    }
}

/// The place of an arc (index).
fn curve_place(curve: &SpaceCurve, arc: usize, local: f64) -> Result<ParametricPlace, ParametricError> {
    let at = curve.arcs.get(arc).ok_or(ParametricError::NoDirection)?.evaluate(local);
    let parameter = arc as f64 + local;
    let flow = curve.flow.as_ref().and_then(|flow| flow.flow_parameter(curve, parameter));
    let (global, start) = (curve.numbered(parameter), curve.numbered(arc as f64).floor());
    // Where each arc is one of the language the local parameter stays what it was.
    let local = if curve.breaks.is_empty() { local } else { global - start };
    Ok(ParametricPlace::Curve { position: at.position, arc: start as usize + 1, local, global, flow })
}

impl ParametricPlace {
    /// The place.
    pub fn position(&self) -> Vec3 {
        match self {
            ParametricPlace::Surface { position, .. } | ParametricPlace::Curve { position, .. } => *position,
        }
    }
}

impl ParametricCount {
    /// What NUMF gives of a curve; `None` if curves have no such number.
    pub fn of_curve(self, curve: &SpaceCurve) -> Option<usize> {
        match self {
            ParametricCount::Arcs => Some(curve.count()),
            ParametricCount::Segments => Some(curve.flow.as_ref().map_or(0, |flow| flow.segments.len())),
            _ => None,
        }
    }

    /// What NUMF gives of a surface; `None` if surfaces have no such number.
    pub fn of_surface(self, surface: &SculpturedSurface) -> Option<usize> {
        match self {
            ParametricCount::Patches => Some(surface.count()),
            ParametricCount::Splines => Some(surface.mesh.splines),
            ParametricCount::CrossSplines => Some(surface.mesh.cross_splines),
            _ => None,
        }
    }
}

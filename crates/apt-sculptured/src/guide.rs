//! The guide element: where the projection starts, and the directions that tool axes refer to.

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    parametric::{SculpturedSurface, SpaceCurve},
    regional::{FeedDirection, Guide, GuideCondition, ParameterRange, Projection},
};

/// Why a guide gives no point.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GuideError {
    /// The element is no space curve or sculptured surface.
    #[error("the guide element is no space curve or sculptured surface")]
    NotParametric,
    /// The parameters lie outside of the element.
    #[error("the guide element has no point at {u}, {v}")]
    Outside {
        /// Along the splines.
        u: f64,
        /// Across them.
        v: f64,
    },
    /// The element has no normal, tangent or cross direction there.
    #[error("the guide element has no {what} at {u}, {v}")]
    NoDirection {
        /// What is missing.
        what: GuideDirection,
        /// Along the splines.
        u: f64,
        /// Across them.
        v: f64,
    },
}

/// A direction that a guide may lack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum GuideDirection {
    Normal,
    Tangent,
    CrossDirection,
}

impl std::fmt::Display for GuideDirection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Normal => "normal",
            Self::Tangent => "tangent",
            Self::CrossDirection => "cross direction (CRSSPL)",
        })
    }
}

/// A point of the guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GuidePoint {
    /// The point.
    pub position: Vec3,
    /// Derivative by the running parameter; null on an edge that is one point.
    pub along: Vec3,
    /// Unit direction in which the running parameter grows; on an edge that is one point its limit from inside the surface.
    pub forward: Vec3,
    /// Derivative by the other parameter; the cross direction of a curve, null if it has none.
    pub across: Vec3,
    /// The unit direction of that, on an edge of a surface that is one point its limit from inside; null if there is none.
    pub sideways: Vec3,
    /// Unit normal of a surface, cross direction of a curve; null if there is none.
    pub normal: Vec3,
    /// Unit direction of the projection to the part surface.
    pub projection: Vec3,
}

/// The part of a range that is on an element whose parameter begins at 0.
fn within(range: ParameterRange, extent: f64) -> ParameterRange {
    let on_it = |limit: f64| limit.max(0.0).min(extent);
    ParameterRange { low: on_it(range.low), high: on_it(range.high) }
}

/// The guide element of a SMIL.
#[derive(Debug, Clone)]
pub struct GuideElement<'a> {
    element: Element<'a>,
    projection: Projection,
}

#[derive(Debug, Clone, Copy)]
enum Element<'a> {
    Surface { surface: &'a SculpturedSurface, u: ParameterRange, v: ParameterRange },
    Curve { curve: &'a SpaceCurve, u: ParameterRange },
}

impl<'a> GuideElement<'a> {
    /// The element of SCON/DS. Of a range that reaches beyond the element, of which Section 1 warns, the part on it counts.
    ///
    /// # Errors
    /// [`GuideError::NotParametric`].
    pub fn new(condition: &'a GuideCondition) -> Result<Self, GuideError> {
        let element = match &condition.guide {
            Guide::Surface { surface, u, v } => match &surface.geometry {
                Geometry::Sculptured(surface) => {
                    let [width, height] = surface.extent();
                    Element::Surface { surface, u: within(*u, width), v: within(*v, height) }
                }
                _ => return Err(GuideError::NotParametric),
            },
            Guide::Curve { curve, u } => match &curve.geometry {
                Geometry::SpaceCurve(curve) => Element::Curve { curve, u: within(*u, curve.count() as f64) },
                _ => return Err(GuideError::NotParametric),
            },
        };
        Ok(Self { element, projection: condition.projection })
    }

    /// The surface, if it is one.
    pub fn surface(&self) -> Option<&'a SculpturedSurface> {
        match self.element {
            Element::Surface { surface, .. } => Some(surface),
            Element::Curve { .. } => None,
        }
    }

    /// The range of a parameter; a curve has none across.
    pub fn range(&self, direction: FeedDirection) -> Option<ParameterRange> {
        match (self.element, direction) {
            (Element::Surface { u, .. } | Element::Curve { u, .. }, FeedDirection::Spline) => Some(u),
            (Element::Surface { v, .. }, FeedDirection::CrossSpline) => Some(v),
            (Element::Curve { .. }, FeedDirection::CrossSpline) => None,
        }
    }

    /// The next place after `parameter` where a pass has to stop because arcs of a curve meet.
    pub fn junction(&self, parameter: f64, sign: f64) -> Option<f64> {
        match self.element {
            Element::Surface { .. } => None,
            Element::Curve { .. } => {
                Some(if sign > 0.0 { parameter.floor() + 1.0 } else { parameter.ceil() - 1.0 })
            }
        }
    }

    /// The point at global parameters.
    ///
    /// # Errors
    /// [`GuideError`] outside of the element and where a direction that is needed does not exist.
    pub fn at(&self, [u, v]: [f64; 2], direction: FeedDirection) -> Result<GuidePoint, GuideError> {
        let missing = |what| GuideError::NoDirection { what, u, v };
        let mut point = match self.element {
            Element::Surface { surface, .. } => {
                let at = surface.evaluate_global(u, v).ok_or(GuideError::Outside { u, v })?;
                let normal = surface.normal_global(u, v).map_or(Vec3::zeros(), |normal| normal.direction);
                let [by_u, by_v] = surface.tangents_global(u, v).ok_or(GuideError::Outside { u, v })?;
                let ([along, across], [forward, sideways]) = match direction {
                    FeedDirection::Spline => ([at.du, at.dv], [by_u, by_v]),
                    FeedDirection::CrossSpline => ([at.dv, at.du], [by_v, by_u]),
                };
                let (position, projection) = (at.position, Vec3::zeros());
                GuidePoint { position, along, forward, across, sideways, normal, projection }
            }
            Element::Curve { curve, .. } => {
                let parameter = curve.unnumbered(u);
                let (arc, _) = curve.locate(parameter).ok_or(GuideError::Outside { u, v })?;
                let at = curve.evaluate_global(parameter).ok_or(GuideError::Outside { u, v })?;
                let across = curve.given_cross_at(parameter).unwrap_or_else(Vec3::zeros);
                let unit = |way: Vec3| way.try_normalize(f64::MIN_POSITIVE).unwrap_or_else(Vec3::zeros);
                let along = at.first * curve.rate(arc);
                let (forward, sideways, normal) = (unit(along), unit(across), unit(across));
                let (position, projection) = (at.position, Vec3::zeros());
                GuidePoint { position, along, forward, across, sideways, normal, projection }
            }
        };
        if point.forward == Vec3::zeros() {
            return Err(missing(GuideDirection::Tangent));
        }
        let (towards, what) = match self.projection {
            Projection::Vector(vector) => (vector, GuideDirection::Normal),
            Projection::Normal => (-point.normal, GuideDirection::Normal),
            Projection::CrossDirection => (point.across, GuideDirection::CrossDirection),
        };
        point.projection = towards.try_normalize(0.0).ok_or(missing(what))?;
        Ok(point)
    }
}

//! Geometric definitions: from the parameters of `TYPE/…` to a canonical form.
//!
//! A definition is matched by the kinds of its parameters, as APT III does (language reference 4.0): the list of
//! formats of the type is searched for the same length and kinds, then the directional words are checked.

mod canon;
mod choice;
mod circle;
mod conic;
mod format;
mod given;
mod line;
mod matrix;
mod modifier;
mod parametric_error;
mod pattern;
mod plane;
mod plane_conic_points;
mod point;
mod round;
mod ruled;
mod ruled_fit;
mod sculptured;
mod sculptured_convert;
mod sculptured_define;
mod sculptured_knots;
mod sculptured_loft;
mod sculptured_mesh;
mod sculptured_patch;
mod sculptured_query;
mod sculptured_revolved;
mod sculptured_strip;
mod solve;
mod space_curve;
mod space_curve_bounded;
mod space_curve_conic;
mod space_curve_define;
mod spline;
mod tabulated;
mod tabulated_curve;
mod tabulated_newton;
mod tabulated_tangent;
mod vector;

pub use format::{ArgumentKind, Format, Parameter, first_mismatch, formats, matching_format, type_of_next};
pub use modifier::Modifier;
pub use parametric_error::ParametricError;
pub use ruled_fit::{RuledFault, ruled_faults};
pub use sculptured::{
    AxisInput, CurveProduct, MeshRestriction, PatchForm, SculpturedDefinition, SurfaceRange, SurfaceShape,
    Turning,
};
pub use sculptured_query::{
    CurveParameter, ParametricCount, ParametricDirection, ParametricPlace, ParametricQuery,
};
pub use space_curve::{
    CurveShape, Defined, FlowInput, FlowMeasure, LineOrCircle, ParametricNode, SegmentInput, SegmentSide,
    SpaceCurveDefinition,
};

use crate::canonical::{CanonicalError, Geometry, GeometryKind};

/// One parameter of a definition, already evaluated.
#[derive(Debug, Clone, PartialEq)]
pub enum Argument {
    /// A number; angles are in degrees as the language has them.
    Scalar(f64),
    /// A modifier word.
    Modifier(Modifier),
    /// A geometric entity, in the coordinates of the reference system in force.
    Geometry(Geometry),
    /// An empty position (only CANON takes it).
    Empty,
}

/// What a definition needs from the statements before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefinitionContext {
    /// The plane that supplies z (ZSURF), in the coordinates of the arguments.
    pub z_surface: crate::canonical::Plane,
}

/// Why a definition gives no geometry. Positions are indices into the argument list.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DefinitionError {
    /// No format of this type has these parameters (APT III 1000).
    #[error("no format of {kind:?} takes these parameters")]
    UnknownFormat {
        /// The type.
        kind: crate::canonical::GeometryKind,
    },
    /// The format exists but not with this modifier (APT III 1003).
    #[error("modifier {} cannot stand here", found.word())]
    WrongModifier {
        /// Index of the modifier.
        position: usize,
        /// The modifier found.
        found: Modifier,
        /// What could stand there.
        expected: Vec<Modifier>,
    },
    /// The geometry asked for does not exist (APT III 1005).
    #[error("impossible: {reason:?}")]
    Impossible {
        /// The evidence.
        reason: Impossible,
    },
    /// CANON with the wrong number of values (APT III 84).
    #[error("CANON takes {expected} values, not {found}")]
    CanonicalCount {
        /// How many the type has.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// CANON copy of another type (APT III 80).
    #[error("CANON copies {expected:?}, not {found:?}")]
    CanonicalKind {
        /// The type defined.
        expected: crate::canonical::GeometryKind,
        /// The type of the surface copied.
        found: crate::canonical::GeometryKind,
    },
    /// A parameter is NaN or infinite.
    #[error("parameter {position} is not a finite number")]
    NotFinite {
        /// Index of the parameter.
        position: usize,
    },
    /// A limit or rule of a special form is broken; the APT III number tells which.
    #[error("APT III diagnostic {number}")]
    Special {
        /// The APT III number.
        number: u16,
        /// Index of the parameter concerned.
        position: Option<usize>,
    },
}

/// Why geometry cannot exist; numbers are in the program's unit.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "the variants speak for themselves; fields are distances and radii")]
pub enum Impossible {
    Coincident { distance: f64 },
    Collinear,
    Parallel,
    ZeroVector,
    ZeroLength,
    NotPositive { value: f64 },
    NoIntersection { gap: f64 },
    InsideCircle { distance: f64, radius: f64 },
    CirclesTooNear { distance: f64, needed: f64 },
    RadiusTooSmall { radius: f64, least: f64 },
    RadiusTooLarge { radius: f64, greatest: f64 },
    Singular,
    NotReal,
    VerticalZSurface,
    AngleOutOfRange { degrees: f64 },
    Undecided { word: Modifier },
}

impl Argument {
    /// The kind by which formats are matched.
    pub fn kind(&self) -> ArgumentKind {
        match self {
            Argument::Scalar(_) => ArgumentKind::Scalar,
            Argument::Modifier(modifier) => ArgumentKind::Modifier(*modifier),
            Argument::Geometry(geometry) => ArgumentKind::Geometry(geometry.kind()),
            Argument::Empty => ArgumentKind::Empty,
        }
    }
}

impl DefinitionContext {
    /// The context of a program without ZSURF: z is 0.
    pub fn standard() -> DefinitionContext {
        DefinitionContext { z_surface: crate::canonical::Plane::horizontal() }
    }
}

impl DefinitionError {
    /// The APT III diagnostic number, if the case has one.
    pub fn apt3(&self) -> Option<u16> {
        match self {
            DefinitionError::UnknownFormat { kind: GeometryKind::Pattern } => Some(800),
            DefinitionError::UnknownFormat { kind: GeometryKind::RuledSurface } => Some(1002),
            DefinitionError::UnknownFormat { .. } => Some(1000),
            DefinitionError::WrongModifier { .. } => Some(1003),
            DefinitionError::Impossible { .. } => Some(1005),
            DefinitionError::CanonicalCount { .. } => Some(84),
            DefinitionError::CanonicalKind { .. } => Some(80),
            DefinitionError::NotFinite { .. } => None,
            DefinitionError::Special { number, .. } => Some(*number),
        }
    }
}

impl From<Impossible> for DefinitionError {
    fn from(reason: Impossible) -> Self {
        DefinitionError::Impossible { reason }
    }
}

impl From<CanonicalError> for DefinitionError {
    fn from(error: CanonicalError) -> Self {
        match error {
            CanonicalError::Count { expected, found, .. } => {
                DefinitionError::CanonicalCount { expected, found }
            }
            CanonicalError::NoRow { kind } => DefinitionError::UnknownFormat { kind },
            // The values of a CANON list follow the word CANON.
            CanonicalError::Value { position, .. } => {
                DefinitionError::Special { number: 83, position: Some(position + 1) }
            }
        }
    }
}

/// The geometry that `TYPE/arguments` defines.
///
/// `kind` is the type word; arguments are evaluated, angles in degrees, geometry in the reference system in force.
/// The result is in that system too.
///
/// # Errors
/// No format of the type takes these arguments, a directional word is not one of the format's, the geometry does not
/// exist, or a number is NaN or infinite. See [`DefinitionError`].
pub fn define(
    kind: GeometryKind,
    arguments: &[Argument],
    context: &DefinitionContext,
) -> Result<Geometry, DefinitionError> {
    if let Some(position) = arguments.iter().position(|argument| !is_finite(argument)) {
        return Err(DefinitionError::NotFinite { position });
    }
    if arguments.contains(&Argument::Modifier(Modifier::Canon)) {
        return canon::define(kind, arguments);
    }
    let format = format::find(kind, arguments)?;
    let geometry = (format.build)(&given::Given { kind, arguments, context })?;
    // Numbers near the limits of f64 overflow inside constructions: nothing of the kind may leave here.
    if geometry.canonical_values().iter().all(|value| value.is_finite()) {
        Ok(geometry)
    } else {
        Err(Impossible::Singular.into())
    }
}

/// The word that should choose between two solutions of a definition and does not: both are equally far its way, and one is
/// taken by the rule of APT III.
pub fn idle_selector(kind: GeometryKind, arguments: &[Argument]) -> Option<Modifier> {
    if kind == GeometryKind::Point { point::idle_selector(arguments) } else { None }
}

fn is_finite(argument: &Argument) -> bool {
    match argument {
        Argument::Scalar(value) => value.is_finite(),
        Argument::Geometry(geometry) => geometry.canonical_values().iter().all(|value| value.is_finite()),
        Argument::Modifier(_) | Argument::Empty => true,
    }
}

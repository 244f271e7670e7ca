//! Geometric definitions: from the parameters of `TYPE/…` to a canonical form.
//!
//! A definition is matched by the kinds of its parameters, as APT III does (language reference 4.0): the list of
//! formats of the type is searched for the same length and kinds, then the directional words are checked.

mod modifier;

pub use modifier::Modifier;

use crate::canonical::Geometry;

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
    /// The plane that supplies z (ZSURF), in the coordinates of the reference system in force.
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
    RadiusTooSmall { radius: f64, least: f64 },
    RadiusTooLarge { radius: f64, greatest: f64 },
    Singular,
    NotReal,
    VerticalZSurface,
    AngleOutOfRange { degrees: f64 },
}

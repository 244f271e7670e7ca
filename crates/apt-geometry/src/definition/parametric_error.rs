//! Why parametric geometry cannot be made or asked.

/// Why a space curve, a sculptured surface or a place on one does not exist. Numbers of the language's own diagnostics are
/// given by [`ParametricError::number`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParametricError {
    /// Too few points, curves or surfaces.
    #[error("{found} given where at least {least} are needed")]
    TooFew {
        /// The least number.
        least: usize,
        /// How many were given.
        found: usize,
    },
    /// More conditions than a conic takes.
    #[error("a conic takes up to {greatest} conditions, not {found}")]
    TooManyConditions {
        /// The greatest number.
        greatest: usize,
        /// How many were given.
        found: usize,
    },
    /// Points that must not coincide do.
    #[error("points {first} and {second} coincide")]
    Coincident {
        /// Number of one point, from 1.
        first: usize,
        /// Number of the other.
        second: usize,
    },
    /// The points of a circle lie on a line.
    #[error("the points lie on a line")]
    Collinear,
    /// The data of a conic do not lie in a plane.
    #[error("the data are {distance} off their plane")]
    NotPlanar {
        /// How far, in units of the program.
        distance: f64,
    },
    /// No conic arc runs through the data in their order.
    #[error("no conic arc runs through the data in their order")]
    NoConicArc,
    /// A vector without length or direction.
    #[error("the vector has no length")]
    ZeroVector,
    /// A number that is NaN or infinite.
    #[error("a number is not finite")]
    NotFinite,
    /// A number outside its range.
    #[error("{value} is not between {least} and {greatest}")]
    OutOfRange {
        /// The number.
        value: f64,
        /// The least value.
        least: f64,
        /// The greatest value.
        greatest: f64,
    },
    /// A curve of GENCUR without FLOW and SEG.
    #[error("curve {curve} has no segments of flow")]
    NoFlow {
        /// Number of the curve, from 1.
        curve: usize,
    },
    /// Curves with different numbers of segments.
    #[error("curve {curve} has {found} segments, the first one {expected}")]
    SegmentCount {
        /// Number of the curve, from 1.
        curve: usize,
        /// Segments of the first curve.
        expected: usize,
        /// Its segments.
        found: usize,
    },
    /// FLOW without SEG.
    #[error("the flow has no segments")]
    FlowWithoutSegments,
    /// SEG without FLOW.
    #[error("segments without flow")]
    SegmentsWithoutFlow,
    /// Ranges of FLOW or SEG that overlap, have gaps or run backwards.
    #[error("range {number} does not follow the one before it")]
    RangeOrder {
        /// Number of the range, from 1.
        number: usize,
    },
    /// The quantity that a flow measures does not grow along the curve.
    #[error("the flow of range {number} does not grow all along")]
    FlowNotMonotone {
        /// Number of the range, from 1.
        number: usize,
    },
    /// A point and a vector where a vector or two points are taken.
    #[error("AXIS takes a vector or two points here")]
    AxisForm,
    /// Rows of SMESH with different numbers of points.
    #[error("rows and their numbers of points {rows:?}, the first one {expected}")]
    RowLength {
        /// Points of the first row.
        expected: usize,
        /// The rows with another number, from 1, and their points.
        rows: Vec<(usize, usize)>,
    },
    /// A row of SMESH whose points do not lie on a line in the plane of the heights.
    #[error("row {row} is not straight in its plane")]
    RowNotStraight {
        /// Number of the row, from 1.
        row: usize,
    },
    /// Curves of COMBIN whose ends do not meet (a warning: the curve is made).
    #[error("curve {curve} begins {gap} from the end of the one before")]
    Gap {
        /// Number of the curve, from 1.
        curve: usize,
        /// The gap in units of the program.
        gap: f64,
    },
    /// A surface of COMBIN that touches none of those that belong together with the first one (a warning: the surface is made).
    #[error("surface {surface} does not touch the others")]
    Apart {
        /// Number of the surface, from 1.
        surface: usize,
    },
    /// The ends of the curves after CROSS do not meet the first and last curve.
    #[error("cross curve {curve} ends {gap} from the boundary curves")]
    CrossGap {
        /// Number of the curve, from 1.
        curve: usize,
        /// The gap in units of the program.
        gap: f64,
    },
    /// More than one patch of points on it (a warning: the patches are made).
    #[error("{patches} patches of points do not know of each other")]
    LoosePatches {
        /// How many.
        patches: usize,
    },
    /// Sign words of the patches of one surface that tell different sides of it.
    #[error("the sign words of the patches tell different sides of the surface")]
    MixedSigns,
    /// Knots that are not those of a B-spline.
    #[error("the knots are not those of {points} points of degree {degree}")]
    Knots {
        /// The degree.
        degree: usize,
        /// The control points.
        points: usize,
    },
    /// A weight that is zero or negative.
    #[error("weight {weight} is not positive")]
    Weight {
        /// The weight.
        weight: f64,
    },
    /// The matrix of TRFORM is singular.
    #[error("the matrix is singular")]
    SingularMatrix,
    /// Two lines or circles that do not meet.
    #[error("the bounds do not meet the curve")]
    NoIntersection,
    /// A surface that has no form in patches here.
    #[error("a {kind:?} cannot be taken over as patches")]
    NotConvertible {
        /// Its type.
        kind: crate::canonical::GeometryKind,
    },
    /// A patch, arc or segment number that the geometry does not have.
    #[error("there is no number {number}: there are {count}")]
    NoSuchPart {
        /// The number asked for.
        number: f64,
        /// How many there are.
        count: usize,
    },
    /// No place satisfies the question.
    #[error("there is no such place; the nearest miss is {miss}")]
    NoPlace {
        /// How far the geometry stays from the line or plane.
        miss: f64,
    },
    /// A direction that the geometry does not have at the place.
    #[error("there is no such direction here")]
    NoDirection,
    /// PARMF before any INTOF (42 of the language).
    #[error("no INTOF came before")]
    NoPlaceYet,
}

impl ParametricError {
    /// The diagnostic number of the language, where it is known.
    pub fn number(&self) -> Option<u16> {
        match self {
            ParametricError::NoFlow { .. } => Some(5029),
            ParametricError::AxisForm => Some(5007),
            ParametricError::FlowWithoutSegments => Some(5515),
            ParametricError::SegmentsWithoutFlow => Some(1007),
            ParametricError::RowNotStraight { .. } => Some(5300),
            ParametricError::Gap { .. } => Some(5129),
            ParametricError::LoosePatches { .. } => Some(1215),
            ParametricError::NoPlaceYet => Some(42),
            _ => None,
        }
    }
}

//! What is wrong with space curves, sculptured surfaces and regional milling.

use apt_geometry::definition::ParametricError;
use smol_str::SmolStr;

use super::ConditionBlock;

/// What is wrong with space curves, sculptured surfaces and regional milling.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SculpturedFinding {
    /// A space curve, a sculptured surface, or a place on one that does not exist.
    #[error("{statement}: {error}")]
    Parametric {
        /// The type or function.
        statement: SmolStr,
        /// Why not.
        error: ParametricError,
    },
    /// One that exists although something is doubtful about it.
    #[error("{statement}: {error}")]
    ParametricDoubt {
        /// The type.
        statement: SmolStr,
        /// What.
        error: ParametricError,
    },

    // Regional milling of sculptured surfaces.
    /// A command without one of the conditions that it needs.
    #[error("SMIL/{word} without {missing:?}")]
    ConditionMissing {
        /// The command.
        word: SmolStr,
        /// The blocks that it needs and that are not valid.
        missing: Vec<ConditionBlock>,
        /// Those of them whose last statement has a mistake.
        spoiled: Vec<ConditionBlock>,
        /// The blocks that are valid.
        valid: Vec<ConditionBlock>,
    },
    /// Limits in the wrong order.
    #[error("{statement}: {low} is above {high}")]
    RangeReversed {
        /// The word of the statement.
        statement: SmolStr,
        /// What should be the lower limit.
        low: f64,
        /// What should be the upper limit.
        high: f64,
    },
    /// The range of SCON/DS reaches beyond the guide element.
    #[error("the range {low} to {high} of {parameter} reaches beyond {name}")]
    GuideBeyond {
        /// The guide element, empty for a nest.
        name: SmolStr,
        /// `u` or `v`.
        parameter: char,
        /// Lower limit of the range.
        low: f64,
        /// Upper limit of the range.
        high: f64,
        /// The greatest parameter of the element; the least is 0.
        extent: f64,
    },
    /// AVCTRL is on and no surface is checked.
    #[error("avoidance without a check")]
    AvoidanceWithoutCheck,
    /// A lift of AVCTRL without LIMIT.
    #[error("a lift without limit")]
    LiftWithoutLimit,
    /// A spelling that the public system does not take.
    #[error("{word} is now {present}")]
    OlderSpelling {
        /// The word.
        word: SmolStr,
        /// What the public system calls it.
        present: SmolStr,
    },
    /// A word of which only the name is public.
    #[error("only the name of {word} is known")]
    NameOnly {
        /// The word.
        word: SmolStr,
    },
}

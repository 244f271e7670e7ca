//! Regional milling as plain data: what SCON, SMIL, CHKSRF, AVCTRL and PRINT/AVPRT say, with geometry in place of names.
//!
//! The conditions are modal: Section 1 keeps them and puts those that a command needs next to it, so that a
//! [`RegionalMilling`] says all that the language can say about one SMIL. What else takes part (the cutter, INTOL, OUTTOL,
//! THICK, MAXDP, the present position) are the modal data of Section 2.
//!
//! Lengths are in program units, angles in radians, parameters are global: the number of the patch in its direction, from
//! 0, plus the local parameter. Geometry is in the base coordinate system.

use serde::{Deserialize, Serialize};

use crate::{Vec3, canonical::Plane, motion::NamedSurface};

/// PLUS or MINUS.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum Sense {
    Plus,
    Minus,
}

impl Sense {
    /// `+1.0` or `-1.0`.
    pub fn sign(self) -> f64 {
        match self {
            Sense::Plus => 1.0,
            Sense::Minus => -1.0,
        }
    }
}

/// The part of one parameter that is milled.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ParameterRange {
    /// Least value, global.
    pub low: f64,
    /// Greatest value, global; not below `low`.
    pub high: f64,
}

/// How far a starting parameter may lie outside of its range (CAM-I SSV3).
const RANGE_SLACK: f64 = 1e-14;

impl ParameterRange {
    /// Whether a pass may start at this parameter.
    pub fn admits(&self, parameter: f64) -> bool {
        parameter >= self.low - RANGE_SLACK && parameter <= self.high + RANGE_SLACK
    }
}

/// The guide element of SCON/DS with the range to be milled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Guide {
    /// A sculptured surface.
    Surface {
        /// The surface.
        surface: NamedSurface,
        /// Range along the splines (TANSPL).
        u: ParameterRange,
        /// Range across them (CRSSPL).
        v: ParameterRange,
    },
    /// A space curve.
    Curve {
        /// The curve.
        curve: NamedSurface,
        /// Range along it.
        u: ParameterRange,
    },
}

/// What stands on the projection line through the point of the guide: the point of contact (AT) or the tool end (ON).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum GuideContact {
    At,
    On,
}

/// Direction of the projection from the guide to the part surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Projection {
    /// Along the normal of the guide surface, against it (NORMAL).
    Normal,
    /// Along the cross direction of the guide curve (CRSSPL).
    CrossDirection,
    /// Along a vector, not necessarily unit, never null.
    Vector(Vec3),
}

/// SCON/DS.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GuideCondition {
    /// The guide element and its range.
    pub guide: Guide,
    /// What the guide point locates.
    pub contact: GuideContact,
    /// How it is projected.
    pub projection: Projection,
}

/// How the tool stands to the part surface: TO (tangent) or ON (tool end on it).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum PartRelation {
    To,
    On,
}

/// SCON/PS.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartCondition {
    /// TO or ON.
    pub relation: PartRelation,
    /// The part surface.
    pub surface: NamedSurface,
    /// PLUS: the cross product of the derivatives along u and v points to the tool.
    pub side: Sense,
    /// Stock that stays, to the tool side; program units.
    pub thickness: f64,
}

/// The surface whose normal an axis refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum AxisReference {
    Guide,
    Part,
}

/// SCON/AXIS.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum AxisCondition {
    /// A fixed axis, not necessarily unit, never null; MINUS has been applied.
    Fixed(Vec3),
    /// Along the normal of the guide surface, or the axis of a guide curve (NORMDS); MINUS turns it round.
    GuideNormal(Sense),
    /// ATANGL: turned out of the normal.
    AtAngle {
        /// Whose normal.
        reference: AxisReference,
        /// Turn towards the cross-feed direction; radians, at most a quarter turn either way.
        across: f64,
        /// Turn towards the feed; radians, negative for LAG.
        lead: f64,
    },
}

impl AxisCondition {
    /// Whether the axis depends on the part surface at the contact.
    pub fn follows_part(&self) -> bool {
        matches!(self, Self::AtAngle { reference: AxisReference::Part, .. })
    }
}

/// SCON/FEED with four numbers; 0 writes no feed rate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FeedCondition {
    /// While cutting.
    pub cutting: f64,
    /// During the step over.
    pub stepover: f64,
    /// While plunging.
    pub plunge: f64,
    /// While retracting and above the work.
    pub rapid: f64,
}

/// SCON/STEPOV.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StepoverCondition {
    /// Scallop height, not negative; program units.
    pub scallop: f64,
    /// Greatest step; negative for a fixed step of the parameter.
    pub greatest: f64,
    /// Lift during the step over, not negative; program units.
    pub lift: f64,
    /// Greatest number of passes; `None` for no limit.
    pub passes: Option<u32>,
}

/// What settles the distance of two passes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum StepoverRule {
    /// From the scallop height, not more than the limit where there is one.
    Scallop {
        /// Height of what stays between two passes; program units.
        height: f64,
        /// Greatest distance on the surface; program units.
        limit: Option<f64>,
    },
    /// This distance on the surface; program units.
    Distance(f64),
    /// This much of the global parameter across the passes.
    Parameter(f64),
}

/// Without scallop height and step a pass is one patch from the next.
const DEFAULT_PARAMETER_STEP: f64 = 1.0;

impl StepoverCondition {
    /// What settles the distance of two passes (sculptured surfaces reference 1.4).
    pub fn rule(&self) -> StepoverRule {
        if self.greatest < 0.0 {
            StepoverRule::Parameter(-self.greatest)
        } else if self.scallop > 0.0 {
            let limit = (self.greatest > 0.0).then_some(self.greatest);
            StepoverRule::Scallop { height: self.scallop, limit }
        } else if self.greatest > 0.0 {
            StepoverRule::Distance(self.greatest)
        } else {
            StepoverRule::Parameter(DEFAULT_PARAMETER_STEP)
        }
    }
}

/// How SMIL/POSN backs off from the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Retract {
    /// This far against the projection; program units.
    Distance(f64),
    /// By this vector.
    Vector(Vec3),
    /// To this plane, against the projection.
    Plane(Plane),
}

/// The direction of a pass: along the splines of the guide (TANSPL) or across them (CRSSPL).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum FeedDirection {
    /// u runs.
    Spline,
    /// v runs.
    CrossSpline,
}

/// One pass of SMIL/PATH, or the first one of ZIGZAG and PICKFD.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Global parameters of the first point; the second one has no meaning for a guide curve.
    pub start: [f64; 2],
    /// Which parameter runs.
    pub direction: FeedDirection,
    /// Whether it grows.
    pub sense: Sense,
    /// Whether the first point is left out.
    pub skip: bool,
}

/// What ZIGZAG and PICKFD need besides the first pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// The first pass.
    pub pass: Pass,
    /// Whether the parameter across the passes grows.
    pub stepover_sense: Sense,
    /// The feed rates.
    pub feed: FeedCondition,
    /// The distance of the passes.
    pub stepover: StepoverCondition,
}

/// SMIL.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum RegionalCommand {
    /// POSN: one location, backed off.
    Position {
        /// Global parameters of the guide point.
        start: [f64; 2],
        /// How far the tool backs off.
        retract: Retract,
    },
    /// PATH: one pass.
    Path(Pass),
    /// ZIGZAG: passes in turn forwards and backwards.
    Zigzag(Region),
    /// PICKFD: passes one way, with a travel above the work between them.
    Pickfeed {
        /// The passes.
        region: Region,
        /// The plane of the travel.
        clearance: Plane,
    },
}

/// The surfaces that CHKSRF has switched on.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CheckedSurfaces {
    /// CHKSRF/PS,ON.
    pub part: bool,
    /// Surfaces switched on by name, in the order of the program. They are obstacles, never in contact.
    pub named: Vec<NamedSurface>,
}

/// The tilt that AVCTRL/CUTANG allows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TiltControl {
    /// Added to the computed tilt; radians, not negative.
    pub constant: f64,
    /// Least admissible tilt; radians. Where it is not negative, the range bounds the absolute value of the tilt.
    pub least: f64,
    /// Greatest admissible tilt; radians, not below `least`.
    pub greatest: f64,
}

/// Direction in which the tool is lifted off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum LiftDirection {
    /// Along the normal of the part surface at the contact (NORMPS).
    PartNormal,
    /// Along the tool axis (AXIS).
    #[default]
    Axis,
}

/// AVCTRL: how the tool gets out of an interference.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct AvoidanceControl {
    /// Whether the tool avoids at all.
    pub enabled: bool,
    /// The tilt, if the axis may turn.
    pub tilt: Option<TiltControl>,
    /// The lift that follows where no tilt helps.
    pub lift: LiftDirection,
    /// Greatest lift; program units. `None` stands for the greatest step (MAXDP).
    pub limit: Option<f64>,
}

/// One SMIL with all the conditions that it depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegionalMilling {
    /// What is to be done.
    pub command: RegionalCommand,
    /// SCON/DS.
    pub guide: GuideCondition,
    /// SCON/PS.
    pub part: PartCondition,
    /// SCON/AXIS.
    pub axis: AxisCondition,
    /// CHKSRF.
    pub checked: CheckedSurfaces,
    /// AVCTRL.
    pub avoidance: AvoidanceControl,
    /// GOUGCK: whether the chord between two locations is checked.
    pub check_chords: bool,
    /// PRINT/AVPRT: whether each avoidance is listed.
    pub list_avoidance: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_of_the_step_over_follows_the_signs() {
        let rule =
            |scallop, greatest| StepoverCondition { scallop, greatest, lift: 0.0, passes: None }.rule();
        assert_eq!(rule(0.02, 1.0), StepoverRule::Scallop { height: 0.02, limit: Some(1.0) });
        assert_eq!(rule(0.02, 0.0), StepoverRule::Scallop { height: 0.02, limit: None });
        assert_eq!(rule(0.0, 0.6), StepoverRule::Distance(0.6));
        assert_eq!(rule(0.0, -0.3), StepoverRule::Parameter(0.3));
        assert_eq!(rule(0.02, -0.3), StepoverRule::Parameter(0.3));
        assert_eq!(rule(0.0, 0.0), StepoverRule::Parameter(1.0));
    }

    #[test]
    fn a_range_admits_its_ends_and_nothing_beyond() {
        let range = ParameterRange { low: 0.2, high: 1.8 };
        assert!(range.admits(0.2) && range.admits(1.8) && range.admits(1.0));
        assert!(!range.admits(0.1999) && !range.admits(1.8001) && !range.admits(f64::NAN));
    }
}

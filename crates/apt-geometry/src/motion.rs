//! Motion commands as plain data: what Section 1 hands to Section 2 (the PROTAP records of classes 3000 to 12000,
//! Trumpy 1970), with surfaces in place of names.
//!
//! Surfaces are [`Geometry`] values in the base coordinate system: REFSYS has been applied.

use serde::{Deserialize, Serialize};

use crate::{Vec3, canonical::Geometry, cutter::Disk};

/// How the tool stands to a surface: TO, ON, PAST, TANTO (tangent to the drive surface; also DSTAN) or PSTAN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum Relation {
    To,
    On,
    Past,
    TangentToDrive,
    TangentToPart,
}

/// GOLFT, GORGT, GOFWD, GOBACK, GOUP, GODOWN.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum Turn {
    Left,
    Right,
    Forward,
    Back,
    Up,
    Down,
}

/// TLLFT, TLRGT, TLON (and TLNDON): where the tool is, seen along the motion with the tool axis up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum DriveSide {
    Left,
    Right,
    On,
}

/// TLOFPS (tangent to the part surface) or TLONPS (tool end on it).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the language's own")]
pub enum PartSide {
    Offset,
    On,
}

/// One number per role, in the order of INTOL, OUTTOL, TOLER and THICK: part, drive, first and second check surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PerRole {
    /// Part surface.
    pub part: f64,
    /// Drive surface.
    pub drive: f64,
    /// First and second check surface.
    pub check: [f64; 2],
}

impl PerRole {
    /// The same value for every role.
    pub fn all(value: f64) -> Self {
        Self { part: value, drive: value, check: [value; 2] }
    }
}

/// A surface with the name the programmer gave it, for messages and CL records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NamedSurface {
    /// The name, empty for a nested definition without one; a subscripted name as `NAME(3)`.
    pub name: String,
    /// The surface.
    pub geometry: Geometry,
}

/// One surface of a GO statement with the relation to reach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StartSurface {
    /// TO, ON or PAST; TANTO for the third surface only.
    pub relation: Relation,
    /// The surface.
    pub surface: NamedSurface,
}

/// A check surface of a directed motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckSurface {
    /// The relation that stops the motion.
    pub relation: Relation,
    /// Stop at the n-th position with this relation (INTOF); 1 if not said.
    pub occurrence: u32,
    /// The surface.
    pub surface: NamedSurface,
    /// Where processing goes on when this surface is reached first.
    pub label: Option<String>,
}

/// GODLTA in its forms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Delta {
    /// Along the tool axis; positive withdraws.
    AlongAxis(f64),
    /// An increment, with a new tool axis if given.
    Vector(Vec3, Option<Vec3>),
}

/// Forward direction given by the programmer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Direction {
    /// INDIRP: towards this point.
    Point(Vec3),
    /// INDIRV: along this vector.
    Vector(Vec3),
}

/// The angle of an ATANGL tool axis and what settles the rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum AxisAngle {
    /// Only the angle to the surface normal.
    Plain,
    /// The axis stays in planes perpendicular to this vector (four axes).
    PerpendicularTo(Vec3),
    /// Lead (positive) or lag angle to the direction of motion, radians (CUTANG, five axes).
    Lead(f64),
}

/// What settles an axis that lies along the drive surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum AxisTangency {
    /// The plane across the line of motion (TANDS).
    Across,
    /// The plane perpendicular to this vector (PERPTO).
    PerpendicularTo(Vec3),
    /// The axis turns evenly from the present one to the one that TANDS gives at the end of the motion (FAN).
    Fan,
}

/// TLAXIS in its forms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum ToolAxis {
    /// Fixed direction; a unit vector from the tip to the spindle.
    Fixed(Vec3),
    /// Keep the present axis (TLAXIS/1).
    Keep,
    /// Along the part (true) or drive (false) surface normal.
    Normal {
        /// Part surface if true, else drive surface.
        part: bool,
    },
    /// Along the rulings of the part (true) or drive (false) surface.
    Parallel {
        /// Part surface if true, else drive surface.
        part: bool,
    },
    /// At an angle (radians) to the part or drive surface normal.
    AtAngle {
        /// Part surface if true, else drive surface.
        part: bool,
        /// Angle to the normal, radians.
        angle: f64,
        /// What settles the remaining freedom.
        mode: AxisAngle,
    },
    /// Along the drive surface.
    Tangent {
        /// Height above the tool end at which the axis is parallel to the surface, in program units.
        height: f64,
        /// What settles the remaining freedom.
        mode: AxisTangency,
    },
}

/// The disk of CUTTER/OPTION and the surface for which it takes the place of the cutter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RoleDisk {
    /// Part surface if true (`OPTION,1`), else drive surface (`OPTION,2`).
    pub part: bool,
    /// The disk.
    pub disk: Disk,
}

/// POCKET, as the statement gives it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pocket {
    /// Effective cutter radius, offset factor, finishing factor, plunge, general and finish feed, in this order.
    pub numbers: [f64; 6],
    /// Keep the offsets at sharp corners (`o = 1`) instead of reducing them.
    pub keep_offsets: bool,
    /// 0 tool centres, 1 corners, 2 and 3 the same projected along the tool axis on the part surface.
    pub point_kind: u8,
    /// The corners or tool centres.
    pub points: Vec<Vec3>,
}

/// One command to Section 2.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum MotionCommand {
    /// FROM: where the tool is, without motion.
    From {
        /// Tool end.
        position: Vec3,
        /// New tool axis (not necessarily unit).
        axis: Option<Vec3>,
        /// Point name for the CL record.
        name: String,
    },
    /// GOTO a point.
    GoTo {
        /// Tool end.
        position: Vec3,
        /// New tool axis (not necessarily unit).
        axis: Option<Vec3>,
        /// Point name for the CL record.
        name: String,
    },
    /// GODLTA.
    GoDelta {
        /// How far, and along what.
        delta: Delta,
        /// Name of the vector or point for the CL record; empty where there is none.
        name: String,
    },
    /// INDIRV and INDIRP, for drive, part and check surface; one-shot.
    Direction([Option<Direction>; 3]),
    /// SRFVCT for drive, part and check surface: from the TO side to the PAST side; one-shot.
    SurfaceVectors([Option<Vec3>; 3]),
    /// GO with one to three surfaces in the order drive, part, check.
    Start(Vec<StartSurface>),
    /// OFFSET with a drive and perhaps a part surface.
    Offset(Vec<StartSurface>),
    /// GOLFT and its kin. Implied check surfaces have been filled in.
    Drive {
        /// Which way.
        turn: Turn,
        /// The drive surface.
        drive: NamedSurface,
        /// One check surface, or two with labels.
        checks: Vec<CheckSurface>,
    },
    /// POCKET.
    Pocket(Pocket),
    /// TLLFT, TLRGT, TLON; modal.
    DriveSide(DriveSide),
    /// TLOFPS, TLONPS; modal.
    PartSide(PartSide),
    /// PSIS; modal.
    PartSurface(NamedSurface),
    /// AUTOPS: the plane through the tool end normal to z.
    AutomaticPartSurface,
    /// NOPS: the next one-surface GO ignores the part surface.
    NoPartSurface,
    /// CUTTER with one, two or seven numbers, angles in degrees as the statement gives them.
    Cutter(Vec<f64>),
    /// CUTTER/OPTION: a disk in place of the cutter for one surface (`None`: OFF). The last one holds.
    Disk(Option<RoleDisk>),
    /// INTOL.
    InsideTolerance(PerRole),
    /// OUTTOL.
    OutsideTolerance(PerRole),
    /// THICK.
    Thickness(PerRole),
    /// MAXDP.
    MaximumStep(f64),
    /// NUMPTS.
    MaximumPoints(u32),
    /// TLAXIS.
    ToolAxis(ToolAxis),
    /// MULTAX: on for good (`None`), ON or OFF. It changes what CL points carry, not how they are computed.
    MultipleAxes(Option<bool>),
    /// GOUGCK.
    GougeCheck(bool),
    /// 3DCALC (true), 2DCALC and NDTEST (false).
    ForceIteration(bool),
    /// CUT (true), DNTCUT (false).
    Output(bool),
}

//! Why a motion cannot be computed, and what is doubtful about one that can: data with evidence, no sentences.

use apt_geometry::{
    Vec3,
    canonical::GeometryKind,
    cutter::{CutterError, CutterWarning},
    motion::{DriveSide, Relation},
};

use crate::pocket::PocketFailure;

/// Which surface of a motion is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RoleName {
    /// Part surface.
    Part,
    /// Drive surface.
    Drive,
    /// Check surface with its index in the command.
    Check(usize),
}

/// A loop that ended at its bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say which loop it is")]
pub enum Iteration {
    StartUp,
    TwoSurfaces,
    ThreeSurfaces,
    StepLength,
    Stop,
    FinalVector,
}

/// How it is known that a path never meets its check surface. Lengths in program units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// The positions are the solutions of an equation that has none.
    Analytic,
    /// Path and check surface are parallel lines (715).
    Parallel,
    /// Path and check surface are circles about one axis (717).
    Concentric,
    /// The path closes on itself and meets nothing in a turn of this length.
    Closed {
        /// Length of a turn.
        length: f64,
    },
    /// The path leaves everything behind that has an extent.
    Away {
        /// How far it was followed.
        travelled: f64,
    },
}

/// A place at which a path turns by more than a right angle, because the tool comes to a second wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnsBack {
    /// Tool end.
    pub at: Vec3,
    /// Unit direction between both walls, half way from that of the path to the one opposite to where it goes from there.
    pub onward: Vec3,
}

/// Where the tool and a surface come nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPoints {
    /// Tool end.
    pub tip: Vec3,
    /// Point of the tool.
    pub tool: Vec3,
    /// Point of the surface.
    pub surface: Vec3,
}

/// Why a law gives no tool axis. Angles in radians.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AxisFailure {
    /// PARLEL with a surface that has no rulings (852).
    #[error("the controlling surface is not ruled")]
    NotRuled,
    /// The two angles of ATANGL with CUTANG exclude each other (859).
    #[error("angles {alpha} to the normal and {beta} to the direction of motion exclude each other")]
    ImpossibleAngles {
        /// Angle to the normal.
        alpha: f64,
        /// Lead angle.
        beta: f64,
    },
    /// The plane across the vector of ATANGL is tangent to the controlling surface (854).
    #[error("the plane of the axis is tangent to the controlling surface")]
    NoPlane,
    /// The normal does not give a direction (855).
    #[error("no normal")]
    NoNormal,
    /// The sign of an angle cannot be told: the two surfaces are tangent, or nothing is ahead (861).
    #[error("the sign of the angle cannot be resolved")]
    SignUnresolved,
    /// In the vertex of a hollow cone the normal jumps: the axis would have to turn on the spot (855).
    #[error("the axis would turn in the vertex of a hollow cone")]
    Vertex,
    /// A surface that the mode needs takes no part in the motion (850).
    #[error("a surface that the axis depends on takes no part")]
    NoSurface,
    /// The contact moves more than the axis that follows it: the surface is too hollow for the tool (855).
    #[error("the axis does not settle; it still changes by {change}")]
    NotSettled {
        /// Last change of the unit axis.
        change: f64,
    },
    /// The axis would have to turn on the spot from one place of contact to another (855).
    #[error("the axis leaps by {angle} radians")]
    Leaps {
        /// By how much.
        angle: f64,
    },
    /// The normal that the axis stands to comes to the end of the surface, over which it turns (855).
    #[error("the controlling surface ends at {place:?}")]
    SurfaceEnds {
        /// The place of the surface where it ends.
        place: Vec3,
    },
}

impl AxisFailure {
    /// The APT III diagnostic number.
    pub fn apt3(&self) -> u16 {
        match self {
            Self::NotRuled => 852,
            Self::ImpossibleAngles { .. } => 859,
            Self::NoPlane => 854,
            Self::NoNormal
            | Self::Vertex
            | Self::NotSettled { .. }
            | Self::Leaps { .. }
            | Self::SurfaceEnds { .. } => 855,
            Self::SignUnresolved => 861,
            Self::NoSurface => 850,
        }
    }
}

/// Why a command to Section 2 gives no motion. Lengths in program units, angles in radians.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MotionFailure {
    /// The command was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// A number of the command is NaN or infinite.
    #[error("the command holds a number that is not finite")]
    NotFinite,
    /// The cutter's numbers make no cutter (401 to 417).
    #[error(transparent)]
    Cutter(#[from] CutterError),
    /// No cutter before a start-up motion (311) or a directed motion (312).
    #[error("no cutter")]
    NoCutter {
        /// True for a start-up motion.
        start_up: bool,
    },
    /// No position: neither FROM nor GOTO came before.
    #[error("the tool has no position")]
    NoPosition,
    /// TLAXIS or an axis of FROM and GOTO has no length (3).
    #[error("tool axis of zero length")]
    ZeroAxis,
    /// INDIRP (6), INDIRV (7) or SRFVCT (8) of zero length.
    #[error("direction of zero length: APT III {number}")]
    ZeroDirection {
        /// The APT III number.
        number: u16,
    },
    /// The axis mode gives no axis here (852 to 861).
    #[error("no tool axis: {cause}")]
    AxisUndetermined {
        /// Why.
        cause: AxisFailure,
        /// Tool end.
        tip: Vec3,
    },
    /// POCKET gives no path (3501 to 3519).
    #[error(transparent)]
    Pocket(#[from] PocketFailure),
    /// This kind of geometry cannot be a surface here.
    #[error("{kind:?} cannot be a {role:?} surface")]
    SurfaceUnsupported {
        /// In which role.
        role: RoleName,
        /// What it is.
        kind: GeometryKind,
    },
    /// The canonical form is degenerate (zero radius, zero normal, no real points).
    #[error("degenerate {kind:?} as {role:?} surface")]
    SurfaceDegenerate {
        /// In which role.
        role: RoleName,
        /// What it is.
        kind: GeometryKind,
    },
    /// GO with a wrong number of surfaces or OFFSET with more than two (129).
    #[error("{found} surfaces")]
    SurfaceCount {
        /// How many.
        found: usize,
    },
    /// GO with several surfaces while NOPS is in force (601).
    #[error("NOPS before a GO with {found} surfaces")]
    NoPartWithSeveral {
        /// How many surfaces.
        found: usize,
    },
    /// INTOL and OUTTOL of a role are both zero, negative or not finite.
    #[error("no tolerance for the {role:?} surface")]
    NoTolerance {
        /// Which role.
        role: RoleName,
        /// INTOL.
        inside: f64,
        /// OUTTOL.
        outside: f64,
    },
    /// THICK leaves less than nothing of a check surface, by more than the tool is wide: TO and PAST would be exchanged.
    #[error("THICK {thickness} for the {role:?} surface, with a tool of radius {radius}")]
    UndercutTooDeep {
        /// Which role.
        role: RoleName,
        /// THICK, below zero.
        thickness: f64,
        /// Greatest radius of the tool.
        radius: f64,
    },
    /// The tool stands on the surface, so that the side is not known (40).
    #[error("tool on the surface, side unknown")]
    SideUnknown {
        /// Which role.
        role: RoleName,
        /// Distance of the observer from the surface.
        distance: f64,
    },
    /// The direction given does not meet the surface (34).
    #[error("the direction misses the surface")]
    NotReachedAlong {
        /// Which role.
        role: RoleName,
        /// Where the ray began.
        from: Vec3,
        /// Its unit direction.
        direction: Vec3,
    },
    /// Along INDIRV or INDIRP the tool comes to no position at the drive surface (714), or only behind it or in another
    /// relation (724).
    #[error("no position {relation:?} the drive surface along the direction, {found} elsewhere")]
    NoPositionAlong {
        /// The relation asked for.
        relation: Relation,
        /// Where the tool stands.
        from: Vec3,
        /// Unit direction across the tool axis.
        direction: Vec3,
        /// Positions on the whole line, ahead and behind, with either relation.
        found: usize,
        /// Radii of the tool and of the circle that it stands in and does not fit into.
        narrow: Option<[f64; 2]>,
    },
    /// Drive, part and check surface of a start-up are planes and two of them are parallel (602).
    #[error("{:?} and {:?} surface are parallel planes, {apart} apart", roles[0], roles[1])]
    ParallelPlanes {
        /// Which two.
        roles: [RoleName; 2],
        /// Distance between them.
        apart: f64,
    },
    /// OFFSET without a direction (33).
    #[error("OFFSET without direction")]
    OffsetWithoutDirection,
    /// The part surface is not reached along the tool axis (36).
    #[error("part surface not reached along the tool axis")]
    PartNotReached,
    /// Start-up does not converge (602): what is left at the best position found.
    #[error("start-up does not converge: {residual} left")]
    StartUpDiverges {
        /// Greatest distance of a surface from its relation.
        residual: f64,
        /// The role it belongs to.
        role: RoleName,
        /// The best position.
        tip: Vec3,
        /// Iterations made.
        iterations: u32,
    },
    /// Every position found at start-up is one at which the tool touches the end of a surface from behind (602).
    #[error("the tool would touch the end of the {role:?} surface from behind")]
    BehindEnd {
        /// Whose surface it is.
        role: RoleName,
        /// The tool end there.
        tip: Vec3,
        /// The place of the surface where it ends.
        place: Vec3,
    },
    /// Several positions are equally near: which of them is meant is not known.
    #[error("start-up with two answers: {} and {}", places[0], places[1])]
    StartUpAmbiguous {
        /// Two of them.
        places: [Vec3; 2],
    },
    /// The tool is out of tolerance of the part (502) or drive surface (503) at the start of a cut.
    #[error("{role:?} surface out of tolerance at the start: {clearance} not in [-{inside}, {outside}]")]
    OutOfToleranceAtStart {
        /// Part or drive surface.
        role: RoleName,
        /// Signed clearance on the nearer side.
        clearance: f64,
        /// INTOL.
        inside: f64,
        /// OUTTOL.
        outside: f64,
        /// Where tool and surface come nearest.
        contact: ContactPoints,
    },
    /// No forward direction is defined (504).
    #[error("no forward direction")]
    NoForwardDirection,
    /// The turn does not settle the direction along the path (505).
    #[error("direction within {angle} of a right angle to the path")]
    DirectionUndetermined {
        /// How far from the right angle, radians.
        angle: f64,
        /// Unit tangent of the path.
        tangent: Vec3,
        /// The direction asked for.
        wanted: Vec3,
    },
    /// Part and drive surface are tangent, so that there is no path (802).
    #[error("part and drive surface are tangent")]
    TangentSurfaces {
        /// Where.
        tip: Vec3,
    },
    /// The check surface is never met (714, and 715 and 717 as the course says): how near the path comes.
    #[error("check surface never met; nearest {nearest}")]
    NeverMet {
        /// Which check surface.
        check: usize,
        /// The relation asked for.
        relation: Relation,
        /// Least distance from the relation seen on the way.
        nearest: f64,
        /// Where.
        at: Vec3,
        /// The tool stands in the band of the check surface there, but the motion begins so, or the tool leaves the surface.
        is_there: bool,
        /// The tool only touches the check surface there: it is in it, or out of it again, by no more than `nearest`.
        is_touched: bool,
        /// Where the path turns by more than a right angle first, because the tool comes to a second wall.
        turns_back: Option<TurnsBack>,
        /// How that is known.
        course: Course,
    },
    /// There are stopping positions, but none ahead with the relation and count asked for (724).
    #[error("no stopping position ahead; {found} elsewhere")]
    NoneAhead {
        /// Which check surface.
        check: usize,
        /// The relation asked for.
        relation: Relation,
        /// Positions met with any relation.
        found: usize,
    },
    /// TANTO: drive and check surface are not tangent (721).
    #[error("not tangent: gap {gap}")]
    NotTangent {
        /// Which check surface.
        check: usize,
        /// Distance between tool and check surface at the nearest parallel position.
        gap: f64,
    },
    /// TANTO between two lines (720).
    #[error("TANTO between two lines")]
    TangentLines {
        /// Which check surface.
        check: usize,
    },
    /// TANTO: the path runs along the check surface from its beginning to its end (720).
    #[error("the path runs along the check surface throughout")]
    ParallelThroughout {
        /// Which check surface.
        check: usize,
    },
    /// The tool is larger than the circle it runs in (705).
    #[error("tool radius {tool} in a circle of radius {circle}")]
    ToolTooLarge {
        /// Tool radius.
        tool: f64,
        /// Circle radius.
        circle: f64,
    },
    /// The path comes to the end of a surface that does not go on, before it meets a check surface (801).
    #[error("the path comes to the end of the {role:?} surface")]
    SurfaceEnds {
        /// Part or drive surface.
        role: RoleName,
        /// Tool end where it is over the end.
        tip: Vec3,
        /// The place of the surface where it ends.
        place: Vec3,
        /// How far the nearest check surface still is there, unless a tangency is asked for.
        remaining: Option<f64>,
    },
    /// More cut vectors than NUMPTS allows (803).
    #[error("more than {limit} cut vectors")]
    TooManyPoints {
        /// NUMPTS.
        limit: u32,
        /// MAXDP.
        maximum_step: f64,
        /// Distance of the check surface at the last point.
        remaining: f64,
        /// The last point.
        at: Vec3,
    },
    /// A bounded iteration ended at its bound (801, 802, 804).
    #[error("iteration limit: {iteration:?}")]
    IterationLimit {
        /// Which one.
        iteration: Iteration,
        /// Its bound.
        limit: u32,
        /// Where the tool was.
        tip: Vec3,
    },
    /// Cut vectors that are a small share of the tolerance follow each other (801).
    #[error("no progress: {vectors} vectors of {length}")]
    NoProgress {
        /// How many.
        vectors: u32,
        /// None of them is longer.
        length: f64,
        /// Where it ends.
        tip: Vec3,
    },
    /// No cut vector from here stays in tolerance (801).
    #[error("no admissible cut vector")]
    NoAdmissibleVector {
        /// The role that prevents it.
        role: RoleName,
        /// Least or greatest clearance on the shortest vector tried.
        clearance: f64,
        /// Where.
        tip: Vec3,
    },
}

impl MotionFailure {
    /// The APT III diagnostic number.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            Self::Cancelled
            | Self::NotFinite
            | Self::NoTolerance { .. }
            | Self::UndercutTooDeep { .. }
            | Self::StartUpAmbiguous { .. } => return None,
            Self::NoPosition => 307,
            Self::Cutter(error) => return error.apt3(),
            Self::AxisUndetermined { cause, .. } => cause.apt3(),
            Self::Pocket(failure) => return failure.apt3(),
            Self::NoCutter { start_up: true } => 311,
            Self::NoCutter { start_up: false } => 312,
            Self::ZeroAxis => 3,
            Self::ZeroDirection { number } => *number,
            Self::SurfaceUnsupported { .. } => 1201,
            Self::SurfaceDegenerate { .. } => 1402,
            Self::SurfaceCount { .. } => 129,
            Self::NoPartWithSeveral { .. } => 601,
            Self::SideUnknown { .. } => 40,
            Self::NotReachedAlong { .. } => 34,
            Self::OffsetWithoutDirection => 33,
            Self::PartNotReached => 36,
            Self::StartUpDiverges { .. } | Self::BehindEnd { .. } => 602,
            Self::OutOfToleranceAtStart { role: RoleName::Part, .. } => 502,
            Self::OutOfToleranceAtStart { .. } => 503,
            Self::NoForwardDirection => 504,
            Self::DirectionUndetermined { .. } => 505,
            Self::TangentSurfaces { .. } => 802,
            Self::NeverMet { course: Course::Parallel, .. } => 715,
            Self::NeverMet { course: Course::Concentric, .. } => 717,
            Self::NeverMet { .. } => 714,
            Self::NoneAhead { .. } => 724,
            Self::NoPositionAlong { found: 0, .. } => 714,
            Self::NoPositionAlong { .. } => 724,
            Self::ParallelPlanes { .. } => 602,
            Self::NotTangent { .. } => 721,
            Self::TangentLines { .. } | Self::ParallelThroughout { .. } => 720,
            Self::ToolTooLarge { .. } => 705,
            Self::TooManyPoints { .. } => 803,
            Self::IterationLimit { iteration, .. } => match iteration {
                Iteration::StartUp => 602,
                Iteration::TwoSurfaces | Iteration::ThreeSurfaces => 802,
                Iteration::StepLength | Iteration::FinalVector => 801,
                Iteration::Stop => 804,
            },
            Self::NoAdmissibleVector { .. } | Self::NoProgress { .. } | Self::SurfaceEnds { .. } => 801,
        })
    }
}

/// What is doubtful about a command that was carried out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionWarning {
    /// The tool is on the other side of the drive surface than TLLFT or TLRGT says (1601).
    WrongSideOfDrive {
        /// Sine of the angle between the drive normal and the direction of motion, about the tool axis.
        sine: f64,
        /// Where the tool is.
        side: DriveSide,
    },
    /// Doubtful cutter (415, 416).
    Cutter(CutterWarning),
    /// AUTOPS with an inclined tool (3520).
    AutomaticPartWithTiltedAxis {
        /// Angle of the tool axis from z, radians.
        tilt: f64,
    },
    /// GOUGCK/ON: the tool cuts deeper than INTOL into a surface at another place than the one it follows, or would do so a
    /// little ahead of where the path ends.
    Gouge {
        /// Part, drive or check surface.
        role: RoleName,
        /// How deep, THICK included.
        depth: f64,
        /// Tool end, the deepest point of the tool, and the point of the surface next to it.
        contact: ContactPoints,
        /// The tool end is ON the surface, so that the rest of the tool is not kept out of it.
        on: bool,
        /// True where the motion failed, and this is what lies ahead.
        ahead: bool,
    },
    /// A surface of a motion that failed ends beside the tool: what lies beyond its end is not part of it.
    EndsBesideTool {
        /// Part, drive or check surface.
        role: RoleName,
        /// The place of its end next to the tool axis.
        place: Vec3,
    },
    /// A directed motion or a start-up names one surface in two roles.
    SurfaceTwice {
        /// Both of them.
        roles: [RoleName; 2],
        /// True for a start-up.
        start_up: bool,
    },
    /// A directed motion turns from a direction that nobody gave: that from the origin to the place of FROM.
    DirectionFromOrigin {
        /// The direction.
        direction: Vec3,
    },
    /// A negative THICK of a surface that the tool follows is deeper than the tool is wide.
    DeepUndercut {
        /// Part or drive surface.
        role: RoleName,
        /// THICK, below zero.
        thickness: f64,
        /// Greatest radius of the cutter.
        radius: f64,
    },
    /// A negative tolerance was given; it is taken as zero.
    NegativeTolerance {
        /// The value.
        value: f64,
    },
}

impl MotionWarning {
    /// Whether it doubts what the motion was given and not how it goes: another way of going leaves it as it is.
    pub(crate) fn is_of_the_given(&self) -> bool {
        matches!(self, Self::DirectionFromOrigin { .. } | Self::DeepUndercut { .. })
    }

    /// The APT III diagnostic number.
    pub fn apt3(&self) -> Option<u16> {
        match self {
            Self::WrongSideOfDrive { .. } => Some(1601),
            Self::Cutter(warning) => warning.apt3(),
            Self::AutomaticPartWithTiltedAxis { .. } => Some(3520),
            Self::Gouge { .. }
            | Self::EndsBesideTool { .. }
            | Self::SurfaceTwice { .. }
            | Self::DirectionFromOrigin { .. }
            | Self::DeepUndercut { .. }
            | Self::NegativeTolerance { .. } => None,
        }
    }
}

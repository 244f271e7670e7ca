//! The modal state of Section 2.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, GeometryKind, Plane},
    cutter::Cutter,
    motion::{Direction, DriveSide, NamedSurface, PartSide, PerRole, RoleDisk, ToolAxis},
};

use super::Restart;
use crate::sequence::ToolPosition;

/// Default OUTTOL, inches.
const DEFAULT_OUTSIDE_INCHES: f64 = 0.0005;
/// Default MAXDP, inches.
const DEFAULT_STEP_INCHES: f64 = 10.0;
/// Default NUMPTS.
const DEFAULT_POINTS: u32 = 400;
/// As many positions as a motion needs: of one that only finds a place for another one, and has no cut vectors.
pub(crate) const ANY_NUMBER_OF_POINTS: u32 = u32::MAX;
/// A motion with |cos| > .997 to the tool axis (4.4°) says nothing about the forward direction.
const ALONG_AXIS_COSINE: f64 = 0.997;
/// The same limit as a sine.
pub(super) const ALONG_AXIS_SINE: f64 = 0.0774;

/// How a start-up motion finds its position where the dialects of APT differ; after a failure APT4 goes on from where the
/// tool is, and APT III waits until it is placed anew.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StartUpRule {
    /// APT III: before the general route comes one in closed form, which goes along the direction given (or across the
    /// drive surface) first and then along the tool axis to the part plane; a direction that misses is error 714.
    #[default]
    Apt3,
    /// APT4: the general route alone, which takes the shortest corrections; where a direction misses its surface, the tool
    /// moves along it by the greatest distance from the surfaces, and starts up from where the search in the direction's
    /// plane leaves it.
    Apt4,
}

impl StartUpRule {
    /// Whether stock moves a surface of this type that the tool is ON. In APT4 it does where what lies at a distance from the
    /// surface is a surface of the same type; other surfaces are measured without stock.
    pub fn on_takes_stock(self, kind: GeometryKind) -> bool {
        use GeometryKind as Kind;
        let moves = matches!(kind, Kind::Plane | Kind::Line | Kind::Circle | Kind::Cylinder | Kind::Sphere);
        self == Self::Apt4 && moves
    }
}

/// Everything that a command can depend on besides its own contents. Plain data: compare or hash it as it is.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Program units per inch: 1 for inches, 25.4 for millimetres. Scales the defaults.
    pub units: f64,
    /// The rule of the dialect for start-up motions.
    pub start_up: StartUpRule,
    /// Tool end, once a FROM or GOTO gave it.
    pub tip: Option<Vec3>,
    /// Previous tool end, for the direction of the last motion; the origin after FROM.
    pub previous: Vec3,
    /// Unit tool axis from the tip to the spindle.
    pub axis: Vec3,
    /// How the axis is controlled.
    pub axis_mode: ToolAxis,
    /// Direction of the last motion that was not along the axis.
    pub forward: Option<Vec3>,
    /// The previous tool end is the origin, which FROM takes for it, so that the direction from there is undefined by the
    /// language, and yet carried out (language reference 6.2).
    pub is_placed: bool,
    /// Modal part surface.
    pub part: NamedSurface,
    /// TLOFPS or TLONPS.
    pub part_side: PartSide,
    /// Which side of the part surface the last motion left the tool on, if it has not been moved since.
    pub side_of_part: Option<f64>,
    /// TLLFT, TLRGT, TLON.
    pub drive_side: DriveSide,
    /// The cutter, once defined.
    pub cutter: Option<Cutter>,
    /// CUTTER/OPTION.
    pub disk: Option<RoleDisk>,
    /// INTOL.
    pub inside: PerRole,
    /// OUTTOL.
    pub outside: PerRole,
    /// THICK.
    pub thickness: PerRole,
    /// Part and drive surface: that they are undercut deeper than the cutter's radius has been told since THICK or the
    /// cutter changed.
    pub undercut_told: [bool; 2],
    /// MAXDP.
    pub maximum_step: f64,
    /// NUMPTS.
    pub maximum_points: u32,
    /// CL points carry the tool axis.
    pub multiple_axes: bool,
    /// MULTAX without ON or OFF was given: later forms are ignored.
    pub multiple_axes_locked: bool,
    /// GOUGCK/ON.
    pub gouge_check: bool,
    /// 3DCALC.
    pub force_iteration: bool,
    /// CUT (true) or DNTCUT.
    pub output: bool,
    /// INDIRV and INDIRP for drive, part and check surface; for the next motion only.
    pub directions: [Option<Direction>; 3],
    /// SRFVCT for drive, part and check surface; for the next start-up only.
    pub surface_vectors: [Option<Vec3>; 3],
    /// NOPS; for the next start-up only.
    pub no_part: bool,
    /// Restart mode.
    pub restart: Restart,
}

impl State {
    /// How far the cut vectors that are left after so many can reach; zero where their number has no limit, so that none
    /// has to be reached.
    pub(crate) fn reach_after(&self, points: usize) -> f64 {
        match self.maximum_points {
            ANY_NUMBER_OF_POINTS => 0.0,
            limit => (limit as usize).saturating_sub(points) as f64 * self.maximum_step,
        }
    }

    /// The state at the start of a program.
    pub fn new(units: f64) -> Self {
        let plane = Plane { normal: Vec3::z(), distance: 0.0 };
        Self {
            units,
            start_up: StartUpRule::default(),
            tip: None,
            previous: Vec3::zeros(),
            axis: Vec3::z(),
            axis_mode: ToolAxis::Fixed(Vec3::z()),
            forward: None,
            is_placed: false,
            part: NamedSurface { name: String::new(), geometry: Geometry::Plane(plane) },
            part_side: PartSide::Offset,
            side_of_part: None,
            drive_side: DriveSide::On,
            cutter: None,
            disk: None,
            inside: PerRole::all(0.0),
            outside: PerRole::all(DEFAULT_OUTSIDE_INCHES * units),
            thickness: PerRole::all(0.0),
            undercut_told: [false; 2],
            maximum_step: DEFAULT_STEP_INCHES * units,
            maximum_points: DEFAULT_POINTS,
            multiple_axes: false,
            multiple_axes_locked: false,
            gouge_check: false,
            force_iteration: false,
            output: true,
            directions: [None; 3],
            surface_vectors: [None; 3],
            no_part: false,
            restart: Restart::Running,
        }
    }

    /// Where the tool is, if it is anywhere.
    pub fn position(&self) -> Option<ToolPosition> {
        self.tip.map(|tip| ToolPosition { tip, axis: self.axis })
    }

    /// Moves the tool end and remembers the direction of the move.
    pub(super) fn move_to(&mut self, previous: Vec3, tip: Vec3) {
        self.previous = previous;
        self.is_placed = false;
        self.tip = Some(tip);
        if let Some(direction) = (tip - previous).try_normalize(0.0)
            && direction.dot(&self.axis).abs() <= ALONG_AXIS_COSINE
        {
            self.forward = Some(direction);
        }
    }

    /// Places the tool end without a motion: the origin is the previous position, as APT III has it.
    pub(super) fn place(&mut self, tip: Vec3) {
        self.forward = None;
        self.move_to(Vec3::zeros(), tip);
        self.is_placed = true;
    }

    /// Forgets what applies to the next motion or start-up only.
    pub(super) fn clear_one_shot(&mut self) {
        self.directions = [None; 3];
        self.surface_vectors = [None; 3];
        self.no_part = false;
    }
}

//! Machine definitions: what a control and its machine want, as data.

mod bundled;
mod check;
mod rotary;

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize};

use crate::format::{NumberFormat, Sign, Style};

pub use bundled::{definition_file, machine, machines};
pub use rotary::{Carried, Coordinates, KinematicRules, Preference, RotaryAxis};
pub(crate) use rotary::{ROTARY_NAMES, VECTOR_REGISTERS};

/// Version of the definition format that this program reads.
const SCHEMA: u32 = 1;

/// What a user needs to choose a machine.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MachineInfo {
    /// Name by which it is asked for.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Its control.
    pub control: String,
}

/// Why a definition cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MachineError {
    /// The text is not a definition; the message names line and key.
    #[error("{message}")]
    Syntax {
        /// Zero-based line, where known.
        line: Option<usize>,
        /// What the parser says.
        message: String,
    },
    /// A format version that this program does not read.
    #[error("schema {found}, this program reads {SCHEMA}")]
    Schema {
        /// What the file says.
        found: u32,
    },
    /// A template or order names a register that is not defined.
    #[error("{place}: register {register} is not defined")]
    UnknownRegister {
        /// Where it is named.
        place: String,
        /// The register.
        register: String,
    },
    /// A template of motion does not name a register without which it tells no motion.
    #[error("{place} does not name {register}")]
    TemplateLacks {
        /// The template.
        place: String,
        /// The register.
        register: String,
    },
    /// A register that every mill needs is missing.
    #[error("register {register} is missing")]
    MissingRegister {
        /// The register.
        register: String,
    },
    /// A code that this machine needs is missing.
    #[error("{code} is missing")]
    MissingCode {
        /// The code.
        code: String,
    },
    /// A number that has to be above zero, or a direction without a length.
    #[error("{place} is not a number that can be used here")]
    NotPositive {
        /// Where it stands.
        place: String,
    },
    /// A chain of no axes, or of more than two.
    #[error("kinematics.chain has {axes} axes, one or two are possible")]
    ChainLength {
        /// How many there are.
        axes: usize,
    },
    /// A chain names an axis that is not there, or that is not called A, B or C.
    #[error(
        "kinematics names the rotary axis {axis}, which is not defined under rotary, where A, B and C may be"
    )]
    UnknownRotaryAxis {
        /// The name.
        axis: String,
    },
    /// A rotary axis that no chain names.
    #[error("rotary.{axis} is not in kinematics.chain")]
    NotInChain {
        /// Its name.
        axis: String,
    },
    /// Two rotary axes about the same direction.
    #[error("the rotary axes {first} and {second} are parallel")]
    ParallelAxes {
        /// The one next to the part.
        first: String,
        /// The other one.
        second: String,
    },
    /// An axis that has limits and is told from 0 to 360.
    #[error("rotary.{axis} has limits, and wraps: only an axis without end does")]
    WrapsWithinLimits {
        /// The axis.
        axis: String,
    },
    /// The head is nearer to the part than the table.
    #[error("kinematics.chain begins at the part: {table} of the table stands before {head} of the head")]
    TableBehindHead {
        /// The axis of the table.
        table: String,
        /// That of the head.
        head: String,
    },
    /// Limits in the wrong order.
    #[error("{place}: {least} is not less than {greatest}")]
    Limits {
        /// Where they stand.
        place: String,
        /// Lower limit.
        least: String,
        /// Upper limit.
        greatest: String,
    },
    /// No bundled machine has this name.
    #[error("no machine is called {name}")]
    UnknownMachine {
        /// The name asked for.
        name: String,
    },
}

/// A machine and its control.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineDefinition {
    /// Version of the format.
    pub schema: u32,
    /// Name by which it is asked for.
    pub id: String,
    /// Names by which the MACHIN of a program asks for it, in upper case; six letters where cards are to hold them.
    #[serde(default)]
    pub machin: Vec<String>,
    /// What it is.
    pub title: String,
    /// Its control.
    pub control: String,
    /// Unit of the tape.
    pub units: OutputUnits,
    /// Most characters in a block.
    pub max_block: usize,
    /// The axis that moves apart in a rapid: first when it goes up, last when it goes down. Not stated for a control whose
    /// rapids are straight lines.
    #[serde(default)]
    pub rapid_axis: Option<LinearAxis>,
    /// Axes by name.
    pub axes: BTreeMap<String, Axis>,
    /// Rotary axes by name: A, B or C.
    #[serde(default)]
    pub rotary: BTreeMap<String, RotaryAxis>,
    /// How they go together; none for a machine whose tool always stands upright.
    #[serde(default)]
    pub kinematics: Option<KinematicRules>,
    /// Registers by name. `FR` and `FI` are those of feeds per revolution and of inverse times, where these have other digits than a feed per minute, `F`.
    pub registers: BTreeMap<String, Register>,
    /// Layout of blocks.
    pub block: BlockLayout,
    /// Modal groups: codes of which one is in force.
    pub groups: BTreeMap<String, Vec<String>>,
    /// Codes.
    pub codes: Codes,
    /// Arcs.
    pub arc: ArcRules,
    /// Templates of blocks.
    pub templates: Templates,
    /// Cycles by name.
    #[serde(default)]
    pub cycles: BTreeMap<String, CycleTemplate>,
    /// Which cycle a word of CYCLE means.
    #[serde(default)]
    pub cycle_words: BTreeMap<String, String>,
    /// Words of a site, as templates; they go before the built-in meaning.
    #[serde(default)]
    pub words: BTreeMap<String, String>,
    /// Ranges.
    #[serde(default)]
    pub limits: Limits,
    /// What has to stand before what.
    #[serde(default)]
    pub rules: OrderRules,
}

/// What has to stand before what; otherwise there is a warning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrderRules {
    /// Coolant is switched on only while the spindle turns.
    #[serde(default)]
    pub coolant_after_spindle: bool,
}

/// Unit of the tape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum OutputUnits {
    /// That of the program.
    Program,
    /// Millimetres.
    Mm,
    /// Inches.
    Inch,
}

/// One of the axes of every mill.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub enum LinearAxis {
    X,
    Y,
    Z,
}

impl LinearAxis {
    /// Its coordinate.
    pub(crate) fn index(self) -> usize {
        match self {
            LinearAxis::X => 0,
            LinearAxis::Y => 1,
            LinearAxis::Z => 2,
        }
    }
}

/// A linear axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Travel in millimetres, seen from the work origin.
    pub limits_mm: [f64; 2],
    /// How fast it goes at feed rate, where blocks on which rotary axes turn have to keep to that.
    #[serde(default)]
    pub most_mm_per_minute: Option<f64>,
}

/// A word address and the format of its number.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Register {
    /// What is written before the number.
    pub address: String,
    /// How the number is written.
    pub style: Style,
    /// Digits before the point.
    pub left: u8,
    /// Decimals; those of metric tapes where `right_inch` stands too.
    #[serde(default)]
    pub right: u8,
    /// Decimals of inch tapes.
    #[serde(default)]
    pub right_inch: Option<u8>,
    /// Digits before the point that are written at least.
    #[serde(default)]
    pub least_left: u8,
    /// Sign.
    #[serde(default)]
    pub sign: Sign,
    /// Whether it is written only when it changes.
    #[serde(default)]
    pub modal: bool,
}

impl Register {
    /// The format on an inch or a metric tape.
    pub fn format(&self, inch: bool) -> NumberFormat {
        let right = if inch { self.right_inch.unwrap_or(self.right) } else { self.right };
        NumberFormat {
            style: self.style,
            left: self.left,
            right,
            least_left: self.least_left,
            sign: self.sign,
        }
    }
}

/// Layout of blocks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockLayout {
    /// Registers in the order in which they are written.
    pub order: Vec<String>,
    /// Whether words are separated by a blank.
    pub spaces: bool,
    /// A comment, with `{text}`.
    pub comment: String,
    /// What makes a block optional.
    pub skip: String,
    /// How many levels of optional blocks the control tells apart, at most 9; the number of a level above the first is
    /// written behind the mark.
    #[serde(default = "one_level")]
    pub skip_levels: u32,
    /// Whether that stands behind the sequence number.
    #[serde(default)]
    pub skip_behind_number: bool,
    /// What ends a line whose block goes on on the next one, which has no number then; empty where a line is a block.
    #[serde(default)]
    pub continuation: String,
    /// Sequence numbers.
    pub sequence: Sequence,
}

/// A control that knows optional blocks, but no levels.
fn one_level() -> u32 {
    1
}

/// Sequence numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sequence {
    /// Whether blocks are numbered from the start.
    pub on: bool,
    /// First number.
    pub start: u32,
    /// Step.
    pub step: u32,
    /// Every how many blocks.
    pub every: u32,
    /// Largest number; after it the start comes again.
    pub max: u32,
    /// Whether every line has its number, remarks and the frame of the program too, and no statement changes that.
    #[serde(default)]
    pub every_line: bool,
}

/// Codes; what a control lacks is left out.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Codes {
    pub rapid: String,
    pub linear: String,
    pub clockwise: String,
    pub counterclockwise: String,
    pub plane_xy: String,
    pub plane_zx: String,
    pub plane_yz: String,
    pub inch: String,
    pub millimeter: String,
    pub feed_per_minute: String,
    pub feed_per_revolution: Option<String>,
    pub feed_inverse: Option<String>,
    pub spindle_clockwise: String,
    pub spindle_counterclockwise: String,
    pub spindle_off: String,
    pub spindle_orient: Option<String>,
    pub coolant_flood: String,
    pub coolant_mist: Option<String>,
    pub coolant_air: Option<String>,
    pub coolant_through: Option<String>,
    pub coolant_off: String,
    pub compensation_left: Option<String>,
    pub compensation_right: Option<String>,
    pub compensation_off: Option<String>,
    pub length_offset_off: Option<String>,
    pub stop: String,
    pub optional_stop: String,
    pub cycle_off: Option<String>,
    pub retract_initial: Option<String>,
    pub retract_plane: Option<String>,
    /// The work offsets, of which the first is in force before the first motion; none where the blocks of the start
    /// see to it.
    #[serde(default)]
    pub work_offsets: Vec<String>,
}

/// Arcs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcRules {
    /// How the centre is given.
    pub center: ArcCenter,
    /// Planes in which the control makes arcs: `xy`, `zx`, `yz`.
    pub planes: Vec<ArcPlane>,
    /// Smallest radius, millimetres.
    pub min_radius_mm: f64,
    /// Largest radius, millimetres.
    pub max_radius_mm: f64,
    /// Most degrees in one block.
    pub split_degrees: f64,
    /// Whether the third axis may move along.
    pub helix: bool,
    /// How far points may be off an arc, millimetres, besides INTOL and OUTTOL.
    pub tolerance_mm: f64,
    /// Whether runs of points without a circle record are fitted.
    pub fit_points: bool,
    /// Fewest points of such a run, start included.
    pub fit_least_points: usize,
    /// Most degrees of a helix in one block, for a control that is told its angle (template `helix`): turns that go on are
    /// one helix.
    #[serde(default)]
    pub helix_degrees: Option<f64>,
}

/// How an arc's centre is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ArcCenter {
    /// From the start.
    Incremental,
    /// In coordinates.
    Absolute,
    /// Not at all: `R` is the radius of an arc of up to half a turn. What is longer is divided, and so is what comes so near to half a turn that the
    /// last decimal of the radius moves its middle by more than the tolerance.
    Radius,
}

/// A plane of arcs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum ArcPlane {
    Xy,
    Zx,
    Yz,
}

/// Templates of blocks: `{X}` is a register under its modal rule, `{!X}` forces it, other names are texts, as
/// `{work_offset}` in that of the first motion of a tool; a word whose placeholder has no value disappears.
///
/// `linear`, `rapid`, `arc` and `helix` are there for controls whose blocks of motion are more than codes and words in one order;
/// without them they are that. Texts in them are `{compensation}`, the code in force, `{codes}`, what comes into force with the block, and `{turn}`,
/// the code of the sense of an arc.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(missing_docs, reason = "the names say it")]
pub struct Templates {
    pub program_start: Vec<String>,
    pub program_end: Vec<String>,
    pub trailer: Vec<String>,
    pub tool_change: Vec<String>,
    pub tool_select: String,
    pub length_offset: String,
    pub first_xy: String,
    pub first_z: String,
    pub spindle_on: String,
    /// Told before `spindle_on` where the speed changes; empty where that tells it.
    #[serde(default)]
    pub spindle_speed: String,
    /// One block, or a list of them.
    #[serde(deserialize_with = "one_or_more")]
    pub dwell: Vec<String>,
    pub message: String,
    pub home: Vec<String>,
    /// A code of a function that no motion goes with, `{code}`.
    #[serde(default)]
    pub function: String,
    #[serde(default)]
    pub linear: String,
    #[serde(default)]
    pub rapid: String,
    #[serde(default)]
    pub arc: String,
    /// The centre of an arc, before it where it is another one.
    #[serde(default)]
    pub arc_center: String,
    /// By the angle `{PA}` and by how far the third axis goes, `{IZ}` in the plane XY.
    #[serde(default)]
    pub helix: String,
    /// The control is told to follow the tool end, and that it is not to any more.
    #[serde(default)]
    pub follow_on: Vec<String>,
    #[serde(default)]
    pub follow_off: Vec<String>,
    /// The spindle stopped at the angle `{R}`, in degrees; empty where the control has one angle for it.
    #[serde(default)]
    pub spindle_orient: String,
    /// Milliseconds instead of seconds in `{P}`.
    #[serde(default)]
    pub dwell_in_milliseconds: bool,
}

/// One block or a list of them.
fn one_or_more<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<String>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Blocks {
        One(String),
        More(Vec<String>),
    }
    Ok(match Blocks::deserialize(deserializer)? {
        Blocks::One(block) => vec![block],
        Blocks::More(blocks) => blocks,
    })
}

/// How a cycle is written. `{L}` is how often it is made at a place, where that is more than once. `{ZT}` is the top of a hole, and from there count
/// the clearance `{RC}`, the depth `{DP}` and the height `{RB}` to which the tool goes back; `{CB}` is how far it goes back to break a chip, and `{FQ}` the
/// feed in a register of its own.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleTemplate {
    /// Block before the first hole.
    #[serde(default)]
    pub pre: Option<String>,
    /// Blocks that define it, before the first hole and wherever a parameter changes, for a control that is told at every hole to make it.
    #[serde(default)]
    pub define: Vec<String>,
    /// Block at the first hole, and wherever a parameter changes.
    #[serde(default)]
    pub on: Option<String>,
    /// Block at the other holes.
    #[serde(default)]
    pub next: Option<String>,
    /// Blocks at every hole, for a cycle that is not modal. `{ZR}` and `{ZI}` are Z at the clearance and the initial
    /// plane.
    #[serde(default)]
    pub each: Vec<String>,
}

/// Ranges; outside them there is a warning.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Millimetres per minute.
    #[serde(default)]
    pub feed_mm: Option<[f64; 2]>,
    /// Revolutions per minute.
    #[serde(default)]
    pub spindle: Option<[f64; 2]>,
    /// First and last tool number of the magazine; 0 empties the spindle everywhere.
    #[serde(default)]
    pub tools: Option<[u32; 2]>,
}

/// The registers of the centre of an arc by coordinate.
pub(crate) const CENTERS: [&str; 3] = ["I", "J", "K"];
/// The register of the angle of a helix, and those of how far its axis goes by coordinate, all from where it starts.
pub(crate) const HELIX_ANGLE: &str = "PA";
pub(crate) const RISES: [&str; 3] = ["IX", "IY", "IZ"];
/// The register of the radius of an arc, and of the plane to which a cycle goes back.
pub(crate) const RADIUS: &str = "R";

impl MachineDefinition {
    /// Reads a definition file.
    ///
    /// # Errors
    /// Text that is no definition, with line and key, and definitions that contradict themselves.
    pub fn from_toml(text: &str) -> Result<MachineDefinition, MachineError> {
        let machine: MachineDefinition = toml::from_str(text).map_err(|error| {
            let line = error.span().map(|span| text[..span.start.min(text.len())].matches('\n').count());
            MachineError::Syntax { line, message: error.to_string() }
        })?;
        machine.validate()?;
        Ok(machine)
    }

    /// What a user needs to choose it.
    pub fn info(&self) -> MachineInfo {
        MachineInfo { name: self.id.clone(), title: self.title.clone(), control: self.control.clone() }
    }
}

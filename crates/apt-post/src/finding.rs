//! What the post-processor has to say about a program.

use smol_str::SmolStr;

use crate::punch::Code;

/// A finding with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct PostFinding {
    /// Number of the source statement.
    pub isn: u32,
    /// Origin, as in [`apt_cldata::record::ClRecord::source`].
    pub source: u32,
    /// Index of the block that was made next.
    pub block: usize,
    /// What it is.
    pub kind: PostFindingKind,
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The tape says what the program says; the reader may want to know.
    Information,
    /// The tape runs, but perhaps not as meant.
    Warning,
    /// The tape is not what the program asks for.
    Error,
}

/// What was found. Lengths are in the unit of the tape.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the fields are the evidence that the messages name")]
pub enum PostFindingKind {
    #[error("cutting without a feed rate")]
    NoFeed,
    #[error("feed rate {value} is not positive")]
    FeedNotPositive { value: f64 },
    #[error("feed rate {value} is outside {least} to {greatest}")]
    FeedOutOfRange { value: f64, least: f64, greatest: f64 },
    #[error("feed per revolution while the spindle speed is unknown")]
    FeedPerRevolutionWithoutSpindle,
    #[error("FEDRAT/{word} in a program of the other unit; converted")]
    UnitMismatch { word: SmolStr },
    #[error("the unit of the program changes after its first motion; ignored")]
    UnitsChanged,
    #[error("cutting with the spindle off")]
    SpindleOff,
    #[error("spindle speed {value} is outside {least} to {greatest}")]
    SpindleOutOfRange { value: f64, least: f64, greatest: f64 },
    #[error("SPINDL without a speed, now or before")]
    NoSpindleSpeed,
    #[error("surface speed needs a cutter diameter")]
    NoCutterDiameter,
    #[error("{axis} {value} is outside the travel {least} to {greatest}")]
    AxisLimit { axis: SmolStr, value: f64, least: f64, greatest: f64 },
    #[error("{axis} {value} has more digits than the control takes")]
    DigitLimit { axis: SmolStr, value: f64 },
    #[error("a coordinate is not finite")]
    NotFinite,
    #[error("the tool axis {i} {j} {k} is not the spindle's; {motions} motions are left out from here on")]
    ToolAxis { i: f64, j: f64, k: f64, motions: u32 },
    #[error("{word} is not known here; it stands on the CL file and nothing is made of it")]
    UnknownWord { word: SmolStr },
    #[error("{word} is not supported by this machine; nothing is made of it")]
    NotSupported { word: SmolStr },
    #[error("{word}: {argument} is not known; the statement is left out")]
    UnknownArgument { word: SmolStr, argument: SmolStr },
    #[error("{word}: {argument} has no effect here")]
    ArgumentNotUsed { word: SmolStr, argument: SmolStr },
    #[error("{word}: {argument} is given twice; the last one counts")]
    ArgumentRepeated { word: SmolStr, argument: SmolStr },
    #[error("{word}: {first} and {second} exclude each other")]
    ArgumentConflict { word: SmolStr, first: SmolStr, second: SmolStr },
    #[error("{word}: {missing} is missing; the statement is left out")]
    MissingArgument { word: SmolStr, missing: SmolStr },
    #[error("{word}: {argument} {value} is out of range")]
    BadValue { word: SmolStr, argument: SmolStr, value: f64 },
    #[error("the machine definition has no {name}; {word} is left out")]
    NoCode { word: SmolStr, name: SmolStr },
    #[error("tool {number} is loaded already")]
    SameTool { number: u32 },
    #[error("tool {number} is outside the magazine, which holds {least} to {greatest}")]
    ToolOutsideMagazine { number: u32, least: u32, greatest: u32 },
    #[error("the tool is changed while {what} is on")]
    ToolChangeWhile { what: SmolStr },
    #[error("a cycle needs a position before it")]
    CycleWithoutPosition,
    #[error("CYCLE/{cycle} has no code on this machine; expanded into moves")]
    CycleExpanded { cycle: SmolStr },
    #[error("CYCLE/{cycle} cannot be expanded; the hole is left out")]
    CycleNotPossible { cycle: SmolStr },
    #[error(
        "CYCLE/{cycle} has no code on this machine and is not made of moves either; the statement is left out"
    )]
    CycleHasNoCode { cycle: SmolStr },
    #[error("CYCLE/{cycle} while the spindle turns the other way")]
    TapDirection { cycle: SmolStr },
    #[error("the feed {feed} of a tap does not fit pitch {pitch} at {speed} rpm")]
    TapFeed { feed: f64, pitch: f64, speed: f64 },
    #[error("STEP {step} is not less than the depth {depth}: one pass")]
    StepNotLessThanDepth { step: f64, depth: f64 },
    #[error("a cycle without points")]
    CycleWithoutPoints,
    #[error("{holes} {} of a CYCLE that cannot be made {} left out", if *holes == 1 { "hole" } else { "holes" }, if *holes == 1 { "is" } else { "are" })]
    HolesLeftOut { holes: usize },
    #[error("CYCLE/{cycle} is still on at {word}; it is ended")]
    CycleLeftOn { cycle: SmolStr, word: SmolStr },
    #[error("a circle off tolerance by {deviation}: made of chords")]
    ArcAsChords { deviation: f64 },
    #[error("a circle in a plane in which the control makes no arc here: made of chords")]
    ArcNotInPlane,
    #[error("cutter compensation begins or ends on an arc; a straight block is used")]
    CompensationOnArc,
    #[error("cutter compensation is never used by a motion in its plane")]
    CompensationUnused,
    #[error("cutter compensation is still on at {word}")]
    CompensationLeftOn { word: SmolStr },
    #[error("{word} without a clearance plane")]
    NoClearance { word: SmolStr },
    #[error("PLUNGE without a RETRCT before it")]
    NoRetract,
    #[error("motion after END")]
    MotionAfterEnd,
    #[error("statements after FINI; nothing is made of them")]
    AfterFini,
    #[error("no FINI")]
    NoFini,
    #[error("RAPID without a motion after it")]
    RapidUnused,
    #[error("{word} a second time")]
    Repeated { word: SmolStr },
    #[error("{character:?} is not in the character set of the control")]
    Character { character: char },
    #[error("{character:?} is not in the {} code of punched tape", code.name())]
    NotInTapeCode { character: char, code: Code },
    #[error("the block has {length} characters, {limit} are allowed")]
    BlockTooLong { length: usize, limit: usize },
    #[error("a circle while CYCLE/{cycle} is on: each of its points becomes a hole")]
    CycleOnArc { cycle: SmolStr },
    #[error("the tool cuts before the first tool is loaded, by statement {isn}")]
    CuttingBeforeTool { isn: u32 },
    #[error("{word}: an offset while no tool is loaded")]
    OffsetWithoutTool { word: SmolStr },
    #[error("COOLNT while the spindle is off")]
    CoolantBeforeSpindle,
    #[error("{word}/OFF while nothing is on")]
    NothingOn { word: SmolStr },
    #[error("{word}: {argument} {value} is outside {least} to {greatest}")]
    ArgumentOutOfRange { word: SmolStr, argument: SmolStr, value: f64, least: f64, greatest: f64 },
    #[error("OPSKIP level {level}, the control knows {levels}; the plain mark is used")]
    SkipLevel { level: u32, levels: u32 },
    #[error("{word} writes {code} of the group {group}, which the post-processor keeps itself")]
    FunctionInGroup { word: SmolStr, code: SmolStr, group: SmolStr },
    #[error("{word} writes {code}, which {owner} stands for")]
    FunctionOfWord { word: SmolStr, code: SmolStr, owner: SmolStr },
    #[error("{word} has {length} characters of text, a card holds {limit}")]
    TextTooLong { word: SmolStr, length: usize, limit: usize },
    #[error(
        "no angles of the rotary axes point the tool along {i} {j} {k}; {positions} positions are left out from here on"
    )]
    AxisUnreachable { i: f64, j: f64, k: f64, positions: u32 },
    #[error(
        "{axis} {angle} is outside {least} to {greatest}; {positions} positions are left out from here on"
    )]
    RotaryLimit { axis: SmolStr, angle: f64, least: f64, greatest: f64, positions: u32 },
    #[error("{axis} is turned from {from} back to {to}, with the tool off the part")]
    RotaryTurnedBack { axis: SmolStr, from: f64, to: f64 },
    #[error("{axis} turns by {degrees} degrees where the tool turns by {turned}")]
    RotarySwing { axis: SmolStr, degrees: f64, turned: f64 },
    #[error("more than {most} blocks would be needed to keep the tool on its way; the motion is left out")]
    TooManyParts { most: usize },
    #[error("the head leans while the length of the tool is unknown")]
    NoToolLength,
    #[error("cutter compensation while rotary axes turn")]
    CompensationTurns,
    #[error("the machine turns between two holes of a cycle")]
    CycleTurns,
    #[error("{word}: a tool that lies does not come to the clearance plane")]
    ClearanceNotReached { word: SmolStr },
    #[error("{word} turns an axis that this machine does not have; nothing is made of it")]
    NoRotaryAxis { word: SmolStr },
}

impl PostFindingKind {
    /// How bad it is.
    pub fn severity(&self) -> Severity {
        use PostFindingKind as Kind;
        match self {
            Kind::ArcAsChords { .. }
            | Kind::ArcNotInPlane
            | Kind::CycleExpanded { .. }
            | Kind::UnknownWord { .. }
            | Kind::NothingOn { .. }
            | Kind::SameTool { .. } => Severity::Information,
            Kind::SpindleOff
            | Kind::FeedOutOfRange { .. }
            | Kind::UnitMismatch { .. }
            | Kind::SpindleOutOfRange { .. }
            | Kind::AxisLimit { .. }
            | Kind::ArgumentNotUsed { .. }
            | Kind::ArgumentRepeated { .. }
            | Kind::ArgumentConflict { .. }
            | Kind::ToolOutsideMagazine { .. }
            | Kind::CycleLeftOn { .. }
            | Kind::CompensationLeftOn { .. }
            | Kind::NotSupported { .. }
            | Kind::ToolChangeWhile { .. }
            | Kind::TapFeed { .. }
            | Kind::TapDirection { .. }
            | Kind::StepNotLessThanDepth { .. }
            | Kind::CycleWithoutPoints
            | Kind::CompensationOnArc
            | Kind::CompensationUnused
            | Kind::NoFini
            | Kind::RapidUnused
            | Kind::Repeated { .. }
            | Kind::Character { .. }
            | Kind::CuttingBeforeTool { .. }
            | Kind::CycleOnArc { .. }
            | Kind::OffsetWithoutTool { .. }
            | Kind::CoolantBeforeSpindle
            | Kind::ArgumentOutOfRange { .. }
            | Kind::SkipLevel { .. }
            | Kind::FunctionInGroup { .. }
            | Kind::FunctionOfWord { .. }
            | Kind::TextTooLong { .. }
            | Kind::NoRotaryAxis { .. }
            | Kind::RotaryTurnedBack { .. }
            | Kind::RotarySwing { .. }
            | Kind::CycleTurns
            | Kind::AfterFini
            | Kind::MotionAfterEnd => Severity::Warning,
            _ => Severity::Error,
        }
    }
}

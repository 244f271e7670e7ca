//! The kinds of findings.

use apt_geometry::{
    canonical::GeometryKind,
    definition::{DefinitionError, RuledFault},
};
use apt_syntax::error::SyntaxErrorKind;
use smol_str::SmolStr;

use super::{ControlFinding, Expected, Found, SculpturedFinding, SynonymFault};
use crate::listing::cards::CardFault;

/// The kinds of findings. [`FindingKind::apt3`] gives the APT III number where one exists.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FindingKind {
    /// A syntax error of the statement.
    #[error("syntax: {0:?}")]
    Syntax(SyntaxErrorKind),

    // Names.
    /// A name without a value.
    #[error("{name} is not defined")]
    Undefined {
        /// The name.
        name: SmolStr,
        /// Defined names of similar spelling, best first.
        similar: Vec<SmolStr>,
    },
    /// A name without a value in the list of a PRINT or PUNCH: it is listed as such, and the program goes on.
    #[error("{name} has no value to list")]
    ListedUndefined {
        /// The name, with its subscript.
        name: SmolStr,
        /// Defined names of similar spelling, best first.
        similar: Vec<SmolStr>,
    },
    /// A name without a value where a statement takes words, one of which may be meant.
    #[error("{name} is not defined, and no word of {statement}")]
    UndefinedOption {
        /// The word of the statement.
        statement: SmolStr,
        /// The name.
        name: SmolStr,
        /// Words of the statement of similar spelling, best first.
        similar: Vec<SmolStr>,
    },
    /// A label where a value is needed.
    #[error("{name} is a label")]
    LabelAsValue {
        /// The label.
        name: SmolStr,
    },
    /// A macro name where a value is needed.
    #[error("{name} is a macro")]
    MacroAsValue {
        /// The macro.
        name: SmolStr,
    },
    /// Geometry where a number is needed.
    #[error("{name} is a {kind:?}, not a number")]
    GeometryAsScalar {
        /// The name, empty for a nest.
        name: SmolStr,
        /// Its type.
        kind: GeometryKind,
    },
    /// Geometry defined a second time without CANON/ON.
    #[error("{name} is already defined")]
    Redefined {
        /// The name.
        name: SmolStr,
        /// Its type.
        kind: GeometryKind,
    },
    /// Geometry redefined as another type.
    #[error("{name} is a {old:?} and cannot become a {new:?}")]
    RedefinedAsOtherKind {
        /// The name.
        name: SmolStr,
        /// The type it has.
        old: GeometryKind,
        /// The type it should get.
        new: GeometryKind,
    },
    /// A number assigned to a name that holds geometry.
    #[error("{name} holds a {kind:?}")]
    GeometryToScalar {
        /// The name.
        name: SmolStr,
        /// The type it has.
        kind: GeometryKind,
    },
    /// Geometry assigned to a name that holds a number.
    #[error("{name} holds a number")]
    ScalarToGeometry {
        /// The name.
        name: SmolStr,
    },
    /// The target of an assignment is a label, macro or something else that takes no value.
    #[error("{name} cannot be assigned: {found:?}")]
    NotAssignable {
        /// The name.
        name: SmolStr,
        /// What it is.
        found: Found,
    },
    /// A name that nobody reads, in a program that moves the tool.
    #[error("{name} is never used")]
    Unused {
        /// The name.
        name: SmolStr,
    },
    /// A vocabulary word has become a name (dialects that allow it).
    #[error("the word {name} becomes a name")]
    WordBecomesName {
        /// The word.
        name: SmolStr,
    },

    // Arrays and subscripts.
    /// Subscript outside the reserved range.
    #[error("subscript {subscript} of {name} is outside 1..{extent}")]
    SubscriptRange {
        /// The array.
        name: SmolStr,
        /// The subscript as computed.
        subscript: f64,
        /// The reserved extent.
        extent: u32,
    },
    /// A reserved name without subscript.
    #[error("{name} needs a subscript")]
    SubscriptMissing {
        /// The array.
        name: SmolStr,
        /// The reserved extent.
        extent: u32,
    },
    /// A subscript on a name that is not reserved; also an unknown function.
    #[error("{name} is not reserved")]
    NotReserved {
        /// The name.
        name: SmolStr,
    },
    /// Scalars and geometry in one array.
    #[error("{name} holds numbers or geometry, not both")]
    MixedArray {
        /// The array.
        name: SmolStr,
        /// True if it holds geometry so far.
        holds_geometry: bool,
    },
    /// Inclusive subscripts with a bad range or step.
    #[error("inclusive subscript of {name} is badly formed")]
    InclusiveForm {
        /// The array.
        name: SmolStr,
    },
    /// Inclusive subscripts where they are not taken.
    #[error("inclusive subscripts cannot stand here")]
    InclusiveNotHere {
        /// The array.
        name: SmolStr,
    },
    /// RESERV inside a loop or macro.
    #[error("RESERV inside a loop or macro")]
    ReserveInRegion,
    /// RESERV with something that is neither name nor number, or pairs in mixed order.
    #[error("RESERV takes pairs of name and number")]
    ReserveForm,
    /// RESERV extent not usable.
    #[error("extent {extent} cannot be reserved")]
    ReserveExtent {
        /// The extent.
        extent: f64,
    },
    /// RESERV of a name in use.
    #[error("{name} is already in use")]
    ReserveUsed {
        /// The name.
        name: SmolStr,
    },

    // Arithmetic.
    /// Division by zero.
    #[error("division by zero")]
    DivisionByZero,
    /// Negative base with a fractional exponent.
    #[error("{base} ** {exponent} is not real")]
    NegativePower {
        /// The base.
        base: f64,
        /// The exponent.
        exponent: f64,
    },
    /// A result that is infinite or not a number.
    #[error("the result is not a finite number")]
    NotFinite,
    /// A function with a wrong number of arguments.
    #[error("{function} takes {expected} arguments, not {found}")]
    FunctionCount {
        /// The function.
        function: SmolStr,
        /// How many it takes; the least number for MINF and MAXF.
        expected: usize,
        /// How many it got.
        found: usize,
    },
    /// A function argument of the wrong kind.
    #[error("{function} cannot take {found:?}")]
    FunctionKind {
        /// The function.
        function: SmolStr,
        /// What it got.
        found: Found,
    },
    /// Two arguments of a function that must be of one type.
    #[error("{function} cannot take a {first:?} with a {second:?}")]
    FunctionMixed {
        /// The function.
        function: SmolStr,
        /// The type of the first.
        first: GeometryKind,
        /// The type of the second.
        second: GeometryKind,
    },
    /// A function argument outside the domain.
    #[error("{function}({value}) does not exist")]
    FunctionDomain {
        /// The function.
        function: SmolStr,
        /// The argument.
        value: f64,
    },
    /// SQRTF of a negative number: the root of the absolute value is used.
    #[error("square root of {value}")]
    NegativeRoot {
        /// The argument.
        value: f64,
    },
    /// DISTF of lines or planes that are not parallel.
    #[error("DISTF of surfaces that are not parallel")]
    NotParallel {
        /// Sine of the angle between them.
        sine: f64,
    },
    /// ANGLF of a point at the centre.
    #[error("ANGLF of the centre")]
    AngleOfCenter,

    // Definitions.
    /// The definition gives no geometry.
    #[error("{kind:?}: {error}")]
    Definition {
        /// The type defined.
        kind: GeometryKind,
        /// Why not.
        error: DefinitionError,
    },
    /// The directrix of a TABCYL has a corner.
    #[error("a corner of {degrees} degrees at point {point}")]
    Corner {
        /// Number of the data point, from 1.
        point: usize,
        /// The turn.
        degrees: f64,
        /// How many other corners there are.
        others: usize,
    },
    /// A SPLINE whose curvature is not continuous: there is no such curve through the points.
    #[error("the curvature of the spline jumps by {jump} at point {point}")]
    CurvatureJump {
        /// Number of the data point, from 1.
        point: usize,
        /// The jump, one over part-program units.
        jump: f64,
    },
    /// A curve of a RLDSRF that its surface does not have, or that runs past its end points.
    #[error("a curve of the ruled surface: {fault:?}")]
    RuledCurve {
        /// What is wrong with it.
        fault: RuledFault,
    },
    /// A word that no definition knows.
    #[error("{word} cannot stand in a definition of {kind:?}")]
    DefinitionWord {
        /// The type defined.
        kind: GeometryKind,
        /// The word.
        word: SmolStr,
    },
    /// A geometric type that this version does not define.
    #[error("{word} cannot be defined")]
    UnknownType {
        /// The type word.
        word: SmolStr,
    },
    /// Geometry that cannot be taken into another reference system.
    #[error("a {kind:?} cannot be carried into this reference system")]
    Untransformable {
        /// Its type.
        kind: GeometryKind,
    },
    /// A nested PATERN without name.
    #[error("a nested pattern needs a name")]
    UnnamedPattern,
    /// A point in the plane needs z, and the ZSURF plane is vertical.
    #[error("the ZSURF plane is vertical")]
    VerticalZSurface,
    /// CANON/ON or OFF expected, OBTAIN and the like: an operand of the wrong kind.
    #[error("{statement} wants {expected:?}, not {found:?}")]
    Operand {
        /// The word of the statement.
        statement: SmolStr,
        /// What it wants there.
        expected: Expected,
        /// What stands there.
        found: Found,
        /// The APT III number of this mistake.
        number: u16,
    },
    /// A statement with a wrong number of operands.
    #[error("{statement} cannot take {found} operands")]
    OperandCount {
        /// The word of the statement.
        statement: SmolStr,
        /// How many there are.
        found: usize,
        /// What would be right, for people: `1, 2 or 7`.
        expected: SmolStr,
        /// The APT III number of this mistake.
        number: u16,
    },
    /// A value outside what a statement takes.
    #[error("{statement}: {value} is out of range")]
    OperandRange {
        /// The word of the statement.
        statement: SmolStr,
        /// The value.
        value: f64,
        /// The APT III number of this mistake, if it has one.
        number: Option<u16>,
    },
    /// A value that is accepted although it is doubtful.
    #[error("{statement}: {value} is doubtful")]
    Doubtful {
        /// The word of the statement.
        statement: SmolStr,
        /// The value.
        value: f64,
    },
    /// A word that should choose between two solutions and does not: both lie equally far its way.
    #[error("{word} does not choose between two solutions")]
    IdleSelector {
        /// The word.
        word: SmolStr,
    },
    /// Canonical values whose direction has another length than 1; they are stored as they are given.
    #[error("the direction of the {kind:?} has length {length}, not 1")]
    NotNormalised {
        /// The type.
        kind: GeometryKind,
        /// The length of the normal or of the axis.
        length: f64,
        /// All canonical values of the same surface with a direction of length 1; none if the direction is zero.
        normalised: Vec<f64>,
    },
    /// OBTAIN of another type than said.
    #[error("{name} is a {found:?}, not a {expected:?}")]
    ObtainType {
        /// The surface.
        name: SmolStr,
        /// The type said.
        expected: GeometryKind,
        /// The type it has.
        found: GeometryKind,
    },
    /// OBTAIN with more names than values.
    #[error("a {kind:?} has {available} values, {wanted} are wanted")]
    ObtainCount {
        /// The type.
        kind: GeometryKind,
        /// How many it has.
        available: usize,
        /// How many are wanted.
        wanted: usize,
    },
    /// OBTAIN of a type without numbers to obtain.
    #[error("nothing can be obtained from a {kind:?}")]
    ObtainLarge {
        /// The type.
        kind: GeometryKind,
    },
    /// REFSYS with something that is not a matrix.
    #[error("REFSYS wants a matrix, not {found:?}")]
    ReferenceSystem {
        /// What it got.
        found: Found,
    },
    /// REFSYS with a matrix that has no inverse.
    #[error("the matrix has no inverse")]
    SingularMatrix,

    // Labels, loops, macros.
    /// Labels, jumps, loops and macros.
    #[error(transparent)]
    Control(#[from] ControlFinding),

    // Dumps.
    /// READ/1 whose cards are no dump.
    #[error("{fault}")]
    Cards {
        /// What is wrong with them.
        fault: CardFault,
    },
    /// READ/1 of a number for a name that holds geometry, or the reverse.
    #[error("the dump makes another sort of {name}")]
    CardSort {
        /// The name.
        name: SmolStr,
    },

    // Synonyms.
    /// SYN with an odd number of operands.
    #[error("SYN takes pairs")]
    SynonymPairs {
        /// How many operands.
        found: usize,
    },
    /// SYN in a loop or macro.
    #[error("SYN in a loop or macro")]
    SynonymInRegion,
    /// More synonyms than APT III takes.
    #[error("more than {limit} synonyms")]
    SynonymCount {
        /// The limit.
        limit: usize,
    },
    /// A pair of SYN without a vocabulary word, or with two, or in mixed order.
    #[error("SYN {first},{second}")]
    SynonymKind {
        /// First operand.
        first: SmolStr,
        /// Second operand.
        second: SmolStr,
        /// What is wrong with them.
        fault: SynonymFault,
    },

    // Motion.
    /// A modifier before the drive surface.
    #[error("{word} before the drive surface")]
    ModifierOnDrive {
        /// The modifier.
        word: SmolStr,
    },
    /// GOUP or GODOWN with an implied check surface.
    #[error("an implied check surface with GOUP or GODOWN")]
    ImpliedCheckVertical,
    /// Another motion while an implied check surface waits.
    #[error("{word} while a check surface is waited for")]
    ImpliedCheckBroken {
        /// The statement that came instead.
        word: SmolStr,
    },
    /// FINI while an implied check surface waits.
    #[error("FINI while a check surface is waited for")]
    ImpliedCheckOpen,
    /// Two check surfaces need labels, and none takes two.
    #[error("check surfaces and labels do not match")]
    CheckLabels,
    /// The label of a check surface is an expression, or a name with a value.
    #[error("the label of a check surface is computed")]
    CheckLabelComputed,
    /// An inclusion of too many surfaces in a GO, OFFSET or directed motion.
    #[error("{found} surfaces, at most {limit}")]
    SurfaceCount {
        /// How many.
        found: usize,
        /// The limit.
        limit: usize,
    },
    /// TANTO on a surface where only TO, ON, PAST can stand.
    #[error("{word} cannot stand here")]
    RelationNotHere {
        /// The word.
        word: SmolStr,
    },
    /// A GOTO pattern list that breaks a rule; the APT III number tells which.
    #[error("pattern operand {value:?}: APT III {number}")]
    PatternList {
        /// The APT III number.
        number: u16,
        /// The number or word concerned.
        value: Option<f64>,
        /// How many points the pattern has.
        points: usize,
    },
    /// POCKET without its eight numbers.
    #[error("POCKET wants eight numbers first")]
    PocketNumbers,
    /// POCKET points incomplete.
    #[error("POCKET wants 3 to 20 points")]
    PocketPoints {
        /// How many coordinates and points could be read.
        found: usize,
    },

    /// TLAXIS in a form that APT III accepts and does not document: it is taken as in later systems.
    #[error("TLAXIS/{word} is not documented")]
    AxisUndocumented {
        /// The word after TLAXIS.
        word: SmolStr,
    },
    /// An axis that the statement gives is not used, since MULTAX is off.
    #[error("{word} gives an axis while MULTAX is off")]
    AxisDropped {
        /// GOTO, FROM or GODLTA.
        word: SmolStr,
    },

    // Sculptured surfaces.
    /// Space curves, sculptured surfaces and regional milling.
    #[error(transparent)]
    Sculptured(#[from] SculpturedFinding),

    // Post-processor words.
    /// Geometry in a post-processor statement.
    #[error("{word} cannot take a {kind:?}")]
    PostGeometry {
        /// The word.
        word: SmolStr,
        /// The type.
        kind: GeometryKind,
        /// True if the word takes another type of surface.
        other_type: bool,
    },
    /// Parameters on a word that takes none.
    #[error("{word} takes no parameters")]
    PostBare {
        /// The word.
        word: SmolStr,
    },
    /// MACHIN without a name.
    #[error("MACHIN wants a name first")]
    MachineName,
    /// Too many MACHIN statements.
    #[error("more than {limit} MACHIN statements")]
    MachineCount {
        /// The limit.
        limit: u32,
    },
    /// TRACUT with something else than a matrix or NOMORE.
    #[error("TRACUT wants a matrix or NOMORE")]
    TransformForm {
        /// What it got.
        found: Found,
    },
    /// COPY or INDEX with a wrong number of parameters.
    #[error("COPY has a wrong number of parameters")]
    CopyCount {
        /// How many.
        found: usize,
        /// How many the option takes.
        expected: usize,
    },
    /// COPY with an unknown option.
    #[error("COPY wants SAME, TRANSL, XYROT or MODIFY")]
    CopyOption {
        /// What it got.
        found: Found,
    },
    /// PTONLY/1: no motion is computed.
    #[error("no motion is computed")]
    MotionSkipped,
    /// PTONLY/2 and PTONLY/3: they go on from the files of an earlier run.
    #[error("PTONLY/{number} goes on from an earlier run")]
    RestartNotAvailable {
        /// 2 or 3.
        number: u8,
    },
    /// A word that is not yet implemented in the processor and has no effect.
    #[error("{word} has no effect")]
    NoEffect {
        /// The word.
        word: SmolStr,
    },

    // Program.
    /// The program does not end with FINI.
    #[error("no FINI")]
    EndMissing,
    /// Statements after FINI are not executed.
    #[error("statements after FINI")]
    AfterEnd,
    /// A statement that can never be reached (dialects with free jumps).
    #[error("never reached")]
    Unreachable,
}

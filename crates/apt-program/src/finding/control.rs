//! What is wrong with labels, jumps, loops, conditions and macros.

use smol_str::SmolStr;

/// What is wrong with labels, jumps, loops, conditions and macros.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ControlFinding {
    /// A label twice.
    #[error("label {name} stands twice")]
    DuplicateLabel {
        /// The label.
        name: SmolStr,
    },
    /// A label that is the name of something else.
    #[error("{name} is already the name of something else")]
    LabelIsName {
        /// The label.
        name: SmolStr,
    },
    /// A label that does not exist in this loop, macro or program.
    #[error("label {name} does not exist here")]
    UnknownLabel {
        /// The label.
        name: SmolStr,
        /// Labels of the region with similar spelling.
        similar: Vec<SmolStr>,
    },
    /// IF or JUMPTO outside loops and macros.
    #[error("a jump outside a loop or macro")]
    JumpOutsideRegion,
    /// TRANTO or a check-surface label leads to a statement that is not there.
    #[error("nothing carries the label {name}")]
    UnknownTransfer {
        /// The label.
        name: SmolStr,
    },
    /// LOOPST in a loop.
    #[error("LOOPST inside a loop")]
    NestedLoop,
    /// LOOPND without LOOPST.
    #[error("LOOPND without LOOPST")]
    LoopEndAlone,
    /// LOOPST or LOOPND in a macro.
    #[error("LOOPST or LOOPND in a macro")]
    LoopInMacro,
    /// A loop that the program ends in.
    #[error("the loop is never closed")]
    LoopNotClosed,
    /// MACRO inside a loop or macro.
    #[error("MACRO inside a loop or another macro")]
    MacroInRegion,
    /// A macro that the program ends in.
    #[error("the macro {name} is never closed")]
    MacroNotClosed {
        /// The macro.
        name: SmolStr,
    },
    /// TERMAC without MACRO.
    #[error("TERMAC without MACRO")]
    MacroEndAlone,
    /// FINI inside a loop or macro.
    #[error("FINI inside a loop or macro")]
    EndInRegion,
    /// A macro name in use.
    #[error("{name} is already in use")]
    MacroNameUsed {
        /// The macro.
        name: SmolStr,
    },
    /// Too many macro variables.
    #[error("{found} macro variables, at most {limit}")]
    MacroVariableCount {
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
    /// A macro variable twice in the header.
    #[error("macro variable {name} stands twice")]
    MacroVariableTwice {
        /// The variable.
        name: SmolStr,
    },
    /// CALL of something that is not a macro.
    #[error("{name} is not a macro")]
    UnknownMacro {
        /// The name.
        name: SmolStr,
        /// Macros of similar spelling.
        similar: Vec<SmolStr>,
    },
    /// CALL names a variable that the macro has not.
    #[error("macro {name} has no variable {parameter}")]
    UnknownMacroVariable {
        /// The macro.
        name: SmolStr,
        /// The variable.
        parameter: SmolStr,
        /// The variables it has.
        known: Vec<SmolStr>,
    },
    /// CALL leaves out a variable without default.
    #[error("macro variable {parameter} of {name} has no value")]
    MacroVariableMissing {
        /// The macro.
        name: SmolStr,
        /// The variable.
        parameter: SmolStr,
    },
    /// A positional or empty value in a CALL.
    #[error("macro value without `=`")]
    MacroValueMissing {
        /// The item.
        parameter: SmolStr,
    },
    /// Macro calls nested too deep.
    #[error("macro calls nested deeper than {limit}")]
    MacroDepth {
        /// The macro called.
        name: SmolStr,
        /// The limit.
        limit: u32,
    },
    /// A routine of an installation that is not available.
    #[error("the routine {name} is not available")]
    RoutineNotAvailable {
        /// The routine.
        name: SmolStr,
    },
    /// A loop or macro that executes too many statements.
    #[error("{statements} statements executed without end")]
    Endless {
        /// How many statements were executed.
        statements: u64,
        /// Names whose values changed in the last turn; empty when nothing did.
        changing: Vec<SmolStr>,
        /// Names in the conditions of the loop whose values did not.
        unchanged: Vec<SmolStr>,
    },
    /// A DO loop in another one that ends behind it.
    #[error("the DO loop to {label} ends behind the one to {outer} around it")]
    LoopsCross {
        /// The label of the inner loop.
        label: SmolStr,
        /// The label of the loop around it.
        outer: SmolStr,
    },
    /// A DO loop that begins and ends in different branches of an IF.
    #[error("the DO loop to {label} begins and ends in different branches")]
    LoopCrossesBranch {
        /// The label of the loop.
        label: SmolStr,
    },
    /// ELSE, ELSEIF or ENDIF without an IF.
    #[error("{word} without an IF")]
    ClauseWithoutIf {
        /// The word.
        word: SmolStr,
    },
    /// ELSE or ELSEIF behind the ELSE of the same IF.
    #[error("{word} behind ELSE")]
    ClauseAfterElse {
        /// The word.
        word: SmolStr,
    },
    /// An IF over several statements without ENDIF.
    #[error("IF without ENDIF")]
    BranchNotClosed,
    /// A jump into a branch of an IF from outside.
    #[error("a jump to {name} inside of an IF")]
    JumpIntoBranch {
        /// The label.
        name: SmolStr,
    },
    /// A DO loop whose index never changes.
    #[error("a DO loop with step zero")]
    ZeroStep,
    /// A dialect feature that has no meaning in this dialect.
    #[error("{word} does not exist in this dialect")]
    NotInDialect {
        /// The word.
        word: SmolStr,
    },
    /// READ/2 in a loop or macro.
    #[error("READ/2 in a loop or macro")]
    SegmentInRegion,
    /// READ/2 in a block of statements that a READ/2 has put in.
    #[error("READ/2 in a block of statements from the library")]
    SegmentInSegment,
    /// The first CALL of a macro of the library in a block of statements that a READ/2 has put in.
    #[error("the first CALL of {name} in a block of statements from the library")]
    SystemMacroInSegment {
        /// The macro.
        name: SmolStr,
    },
    /// INCLUD of a file that cannot be found.
    #[error("{name} cannot be included")]
    IncludeNotFound {
        /// The file.
        name: SmolStr,
        /// The folders that were searched, in their order; empty where nothing can be included.
        searched: Vec<SmolStr>,
    },
    /// INCLUD of a file that cannot be read.
    #[error("{path} cannot be read: {reason}")]
    IncludeUnreadable {
        /// The file.
        path: SmolStr,
        /// Why.
        reason: SmolStr,
    },
    /// A file that includes itself, perhaps through others.
    #[error("{name} includes itself")]
    IncludeCycle {
        /// The file.
        name: SmolStr,
        /// The names by which the files were included, from the first inclusion of the file to the one that closes
        /// the circle.
        through: Vec<SmolStr>,
    },
}

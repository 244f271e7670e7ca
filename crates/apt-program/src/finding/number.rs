//! Numbers and severities of findings, as the dialects have them.

use apt_geometry::definition::DefinitionError;
use apt_syntax::{dialect::DialectName, error::SyntaxErrorKind};

use super::{ControlFinding, FindingKind, Found, SculpturedFinding, Severity, SynonymFault};
use crate::listing::cards::CardFault;

impl FindingKind {
    /// The diagnostic number in a dialect: that of APT4, or that of APT III for all others.
    pub fn number(&self, dialect: DialectName) -> Option<u16> {
        if dialect == DialectName::Apt4 { self.apt4() } else { self.apt3() }
    }

    /// The APT III diagnostic number, where one exists.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            Self::Syntax(kind) => return kind.apt3(),
            Self::Undefined { .. } | Self::UndefinedOption { .. } => 101,
            Self::LabelAsValue { .. } => 251,
            Self::MacroAsValue { .. } => 211,
            Self::GeometryAsScalar { .. } => 83,
            Self::Redefined { .. } | Self::ScalarToGeometry { .. } => 1002,
            Self::RedefinedAsOtherKind { .. } => 1006,
            Self::GeometryToScalar { .. } => 108,
            Self::NotAssignable { found: Found::Label, .. } => 251,
            Self::NotAssignable { found: Found::Macro, .. } => 211,
            Self::NotAssignable { .. } => 5,
            Self::SubscriptRange { .. } => 104,
            Self::SubscriptMissing { .. } => 105,
            Self::NotReserved { .. } => 108,
            Self::MixedArray { .. } => 106,
            Self::InclusiveForm { .. } => 109,
            Self::InclusiveNotHere { .. } => 103,
            Self::ReserveInRegion => 252,
            Self::ReserveForm | Self::ReserveExtent { .. } => 255,
            Self::ReserveUsed { .. } => 256,
            Self::DivisionByZero => 63,
            Self::NegativePower { .. } => 68,
            // The count of DOTF is checked with the kinds of its arguments.
            Self::FunctionCount { function, .. } if function != "DOTF" => 65,
            Self::FunctionCount { .. } | Self::FunctionKind { .. } => 66,
            Self::FunctionMixed { .. } => 80,
            Self::FunctionDomain { .. } | Self::NotParallel { .. } | Self::AngleOfCenter => 66,
            Self::NegativeRoot { .. } => 67,
            Self::Definition { error, .. } => return error.apt3(),
            Self::DefinitionWord { .. } | Self::UnknownType { .. } => 1000,
            Self::UnnamedPattern => 820,
            Self::VerticalZSurface => 1005,
            Self::Operand { number, .. } | Self::OperandCount { number, .. } => *number,
            Self::OperandRange { number, .. } => return *number,
            Self::ObtainType { .. } => 153,
            Self::ObtainCount { .. } => 154,
            Self::ObtainLarge { .. } => 157,
            Self::ReferenceSystem { .. } | Self::SingularMatrix => 651,
            Self::Control(ControlFinding::DuplicateLabel { .. }) => 6,
            Self::Control(ControlFinding::LabelIsName { .. }) => 3,
            Self::Control(ControlFinding::UnknownLabel { .. })
            | Self::Control(ControlFinding::JumpIntoBranch { .. }) => 406,
            Self::Control(ControlFinding::JumpOutsideRegion) => 407,
            Self::Control(ControlFinding::UnknownTransfer { .. }) => 456,
            Self::Control(ControlFinding::NestedLoop) => 206,
            Self::Control(ControlFinding::LoopEndAlone) => 208,
            Self::Control(ControlFinding::LoopInMacro) => 210,
            Self::Control(ControlFinding::LoopNotClosed) => 212,
            Self::Control(ControlFinding::MacroInRegion) => 201,
            Self::Control(ControlFinding::MacroNotClosed { .. })
            | Self::Control(ControlFinding::EndInRegion) => 16,
            Self::Control(ControlFinding::MacroEndAlone) => 209,
            Self::Control(ControlFinding::MacroNameUsed { .. }) => 202,
            Self::Control(ControlFinding::MacroVariableCount { .. }) => 205,
            Self::Control(ControlFinding::UnknownMacro { .. }) => 233,
            Self::Control(ControlFinding::UnknownMacroVariable { .. }) => 228,
            Self::Control(ControlFinding::MacroVariableMissing { .. }) => 230,
            Self::Control(ControlFinding::MacroValueMissing { .. }) => 229,
            Self::Control(ControlFinding::MacroDepth { .. }) => 231,
            Self::SynonymPairs { .. } => 351,
            Self::SynonymInRegion => 353,
            Self::SynonymCount { .. } => 354,
            Self::SynonymKind { fault: SynonymFault::NoSymbol, .. } => 19,
            Self::SynonymKind { fault: SynonymFault::NotNew, .. } => 355,
            Self::SynonymKind { fault: SynonymFault::NotWord, .. } => 356,
            Self::ModifierOnDrive { .. } => 135,
            Self::ImpliedCheckVertical => 136,
            Self::ImpliedCheckBroken { .. } => 137,
            Self::ImpliedCheckOpen => 650,
            Self::CheckLabels => 132,
            Self::CheckLabelComputed => 453,
            Self::SurfaceCount { .. } => 129,
            Self::RelationNotHere { .. } => 133,
            Self::PatternList { number, .. } => *number,
            Self::PocketNumbers => 376,
            Self::PocketPoints { .. } => 377,
            Self::PostGeometry { other_type: false, .. } => 501,
            Self::PostGeometry { .. } => 502,
            Self::PostBare { .. } => 505,
            Self::MachineName => 503,
            Self::MachineCount { .. } => 504,
            Self::TransformForm { .. } => 506,
            Self::CopyCount { .. } => 507,
            Self::CopyOption { .. } => 503,
            Self::Control(ControlFinding::IncludeNotFound { .. })
            | Self::Control(ControlFinding::IncludeUnreadable { .. })
            | Self::Control(ControlFinding::IncludeCycle { .. }) => 31,
            Self::Cards { fault: CardFault::Format { .. } } => 2000,
            Self::Cards { fault: CardFault::Missing } => 2002,
            Self::CardSort { .. } => 2001,
            Self::Control(ControlFinding::SegmentInRegion) => 37,
            Self::Control(ControlFinding::SegmentInSegment) => 30,
            Self::Control(ControlFinding::SystemMacroInSegment { .. }) => 38,
            Self::EndMissing => 23,
            Self::Sculptured(SculpturedFinding::Parametric { .. })
            | Self::Sculptured(SculpturedFinding::ParametricDoubt { .. })
            | Self::Sculptured(SculpturedFinding::ConditionMissing { .. })
            | Self::Sculptured(SculpturedFinding::RangeReversed { .. })
            | Self::Sculptured(SculpturedFinding::GuideBeyond { .. })
            | Self::Sculptured(SculpturedFinding::AvoidanceWithoutCheck)
            | Self::Sculptured(SculpturedFinding::LiftWithoutLimit)
            | Self::Sculptured(SculpturedFinding::OlderSpelling { .. })
            | Self::Sculptured(SculpturedFinding::NameOnly { .. })
            | Self::Unused { .. }
            | Self::WordBecomesName { .. }
            | Self::NotFinite
            | Self::Untransformable { .. }
            | Self::Doubtful { .. }
            | Self::NotNormalised { .. }
            | Self::IdleSelector { .. }
            | Self::Corner { .. }
            | Self::CurvatureJump { .. }
            | Self::RuledCurve { .. }
            | Self::Control(ControlFinding::MacroVariableTwice { .. })
            | Self::Control(ControlFinding::RoutineNotAvailable { .. })
            | Self::Control(ControlFinding::Endless { .. })
            | Self::Control(ControlFinding::LoopsCross { .. })
            | Self::Control(ControlFinding::LoopCrossesBranch { .. })
            | Self::Control(ControlFinding::ClauseWithoutIf { .. })
            | Self::Control(ControlFinding::ClauseAfterElse { .. })
            | Self::Control(ControlFinding::BranchNotClosed)
            | Self::Control(ControlFinding::ZeroStep)
            | Self::Control(ControlFinding::NotInDialect { .. })
            | Self::AxisDropped { .. }
            | Self::AxisUndocumented { .. }
            | Self::NoEffect { .. }
            | Self::MotionSkipped
            | Self::RestartNotAvailable { .. }
            | Self::AfterEnd
            | Self::ListedUndefined { .. }
            | Self::Unreachable => return None,
        })
    }

    /// The APT4 diagnostic number, where one is known (language reference 10.4). 1007 is its general number for a
    /// statement that it does not understand, 2001 for operands that fit no form.
    pub fn apt4(&self) -> Option<u16> {
        Some(match self {
            Self::Syntax(kind) => return syntax_number(kind),
            Self::Undefined { .. }
            | Self::UndefinedOption { .. }
            | Self::LabelAsValue { .. }
            | Self::MacroAsValue { .. }
            | Self::GeometryAsScalar { .. }
            | Self::NotAssignable { .. }
            | Self::Control(ControlFinding::LabelIsName { .. })
            | Self::Control(ControlFinding::NotInDialect { .. })
            | Self::Control(ControlFinding::IncludeNotFound { .. })
            | Self::Control(ControlFinding::IncludeUnreadable { .. })
            | Self::Control(ControlFinding::IncludeCycle { .. })
            | Self::InclusiveForm { .. }
            | Self::SynonymPairs { .. } => 1007,
            Self::Redefined { .. } => 50,
            Self::ScalarToGeometry { .. } | Self::RedefinedAsOtherKind { .. } => 1001,
            Self::GeometryToScalar { .. } | Self::SubscriptMissing { .. } | Self::MixedArray { .. } => 1012,
            Self::NotReserved { .. } => 1111,
            Self::ReserveForm | Self::ReserveExtent { .. } => 2027,
            Self::FunctionDomain { function, value } => return domain_number(function, *value),
            Self::FunctionKind { function, .. } => return argument_number(function),
            Self::AngleOfCenter => 80,
            Self::NegativeRoot { .. } => 20,
            Self::NotParallel { .. } => 62,
            Self::Definition { error, .. } => match error {
                DefinitionError::UnknownFormat { .. } | DefinitionError::WrongModifier { .. } => 2001,
                DefinitionError::CanonicalCount { .. } => 2032,
                _ => return None,
            },
            Self::DefinitionWord { .. } | Self::UnknownType { .. } => 2001,
            Self::Operand { statement, found, .. } => match (statement.as_str(), found) {
                ("PRINT" | "PUNCH", _) => 2031,
                ("ZSURF", Found::Scalar) => 2029,
                _ => 2001,
            },
            Self::OperandCount { .. } => 2001,
            Self::OperandRange { statement, .. } if statement == "PRINT" => 2031,
            Self::ObtainType { .. } => 1050,
            Self::Control(ControlFinding::DuplicateLabel { .. }) => 1003,
            Self::Control(ControlFinding::UnknownMacro { .. }) => 72,
            Self::Control(ControlFinding::UnknownMacroVariable { .. }) => 1020,
            Self::Control(ControlFinding::MacroVariableMissing { .. })
            | Self::Control(ControlFinding::MacroValueMissing { .. }) => 2055,
            Self::AxisDropped { .. } => 22300,
            Self::Sculptured(SculpturedFinding::Parametric { error, .. })
            | Self::Sculptured(SculpturedFinding::ParametricDoubt { error, .. }) => return error.number(),
            Self::Sculptured(SculpturedFinding::ConditionMissing { .. }) => 3565,
            Self::Sculptured(SculpturedFinding::RangeReversed { .. }) => 3523,
            Self::Sculptured(SculpturedFinding::NameOnly { .. }) => 1007,
            Self::Unreachable => 1009,
            _ => return None,
        })
    }

    /// How bad this is unless the project says otherwise.
    pub fn severity(&self) -> Severity {
        match self {
            Self::AxisUndocumented { .. } => Severity::Information,
            Self::Unused { .. } | Self::AfterEnd | Self::WordBecomesName { .. } => Severity::Hint,
            Self::MotionSkipped => Severity::Information,
            Self::EndMissing
            | Self::ListedUndefined { .. }
            | Self::Doubtful { .. }
            | Self::NotNormalised { .. }
            | Self::IdleSelector { .. }
            | Self::Corner { .. }
            | Self::CurvatureJump { .. }
            | Self::RuledCurve { .. }
            | Self::NoEffect { .. }
            | Self::RestartNotAvailable { .. }
            | Self::Control(ControlFinding::MacroVariableTwice { .. })
            | Self::Control(ControlFinding::RoutineNotAvailable { .. })
            | Self::AxisDropped { .. }
            | Self::Sculptured(SculpturedFinding::ParametricDoubt { .. })
            | Self::Sculptured(SculpturedFinding::GuideBeyond { .. })
            | Self::Sculptured(SculpturedFinding::AvoidanceWithoutCheck)
            | Self::Sculptured(SculpturedFinding::LiftWithoutLimit)
            | Self::Sculptured(SculpturedFinding::OlderSpelling { .. })
            | Self::Unreachable => Severity::Warning,
            Self::Syntax(kind) if kind.is_warning() => Severity::Warning,
            _ => Severity::Error,
        }
    }

    /// How bad this is in a dialect: APT4 goes on after a name that is too long, after a redefinition and after a
    /// PRINT that it does not know; APT III does not take a program that ends without FINI.
    pub fn severity_in(&self, dialect: DialectName) -> Severity {
        if matches!(self, Self::EndMissing) && dialect == DialectName::Apt3 {
            return Severity::Error;
        }
        let mild = match self {
            Self::Syntax(SyntaxErrorKind::NameTooLong { .. }) | Self::Redefined { .. } => true,
            Self::Operand { statement, .. } | Self::OperandRange { statement, .. } => {
                matches!(statement.as_str(), "PRINT" | "PUNCH")
            }
            _ => false,
        };
        if mild && dialect == DialectName::Apt4 { Severity::Warning } else { self.severity() }
    }
}

/// The APT4 number of a syntax error.
fn syntax_number(kind: &SyntaxErrorKind) -> Option<u16> {
    match kind {
        SyntaxErrorKind::NameTooLong { .. } => Some(16),
        SyntaxErrorKind::MissingParameters => Some(2001),
        SyntaxErrorKind::UnknownFunction(_) => Some(1111),
        SyntaxErrorKind::TooManyElements { .. } => Some(1028),
        SyntaxErrorKind::RunsIntoSequenceField => None,
        _ => Some(1007),
    }
}

/// The APT4 number of a function argument outside the domain.
fn domain_number(function: &str, value: f64) -> Option<u16> {
    match function {
        "LOGF" | "LOG10F" if value == 0.0 => Some(37),
        "LOG10F" => Some(36),
        "LOGF" | "SQRTF" => Some(20),
        "ANGLF" | "ANGLB" => Some(80),
        "ARSINF" | "ARCOSF" | "ARSINB" | "ARCOSB" => Some(38),
        "CANF" if value < 1.0 => Some(41),
        "CANF" => Some(40),
        _ => None,
    }
}

/// The APT4 number of an argument that a function does not take; most functions take what comes.
fn argument_number(function: &str) -> Option<u16> {
    match function {
        "ANGLF" | "ANGLB" => Some(80),
        "DISTF" => Some(61),
        "SPATF" => Some(54),
        "NUMF" => Some(36),
        "CANF" => Some(39),
        _ => None,
    }
}

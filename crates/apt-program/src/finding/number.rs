//! APT III numbers and severities of findings.

use apt_geometry::definition::DefinitionError;

use super::{FindingKind, Found, Severity};

impl FindingKind {
    /// The APT III diagnostic number, where one exists.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            Self::Syntax(kind) => return kind.apt3(),
            Self::Undefined { .. } => 101,
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
            Self::FunctionCount { .. } => 65,
            Self::FunctionKind { .. } => 66,
            Self::FunctionDomain { .. } | Self::NotParallel { .. } | Self::AngleOfCenter => 66,
            Self::NegativeRoot { .. } => 67,
            Self::Definition { error, .. } => return definition_number(error),
            Self::DefinitionWord { .. } | Self::UnknownType { .. } => 1000,
            Self::UnnamedPattern => 820,
            Self::VerticalZSurface => 1005,
            Self::Operand { number, .. } | Self::OperandCount { number, .. } => *number,
            Self::OperandRange { number, .. } => return *number,
            Self::ObtainType { .. } => 153,
            Self::ObtainCount { .. } => 154,
            Self::ObtainLarge { .. } => 157,
            Self::ReferenceSystem { .. } | Self::SingularMatrix => 651,
            Self::DuplicateLabel { .. } => 6,
            Self::LabelIsName { .. } => 3,
            Self::UnknownLabel { .. } => 406,
            Self::JumpOutsideRegion => 407,
            Self::UnknownTransfer { .. } => 456,
            Self::NestedLoop => 206,
            Self::LoopEndAlone => 208,
            Self::LoopInMacro => 210,
            Self::LoopNotClosed => 212,
            Self::MacroInRegion => 201,
            Self::MacroNotClosed { .. } | Self::EndInRegion => 16,
            Self::MacroEndAlone => 209,
            Self::MacroNameUsed { .. } => 202,
            Self::MacroVariableCount { .. } => 205,
            Self::UnknownMacro { .. } => 233,
            Self::UnknownMacroVariable { .. } => 228,
            Self::MacroVariableMissing { .. } => 230,
            Self::MacroValueMissing { .. } => 229,
            Self::MacroDepth { .. } => 231,
            Self::SynonymPairs { .. } => 351,
            Self::SynonymInRegion => 353,
            Self::SynonymCount { .. } => 354,
            Self::SynonymKind { .. } => 355,
            Self::ModifierOnDrive { .. } => 135,
            Self::ImpliedCheckVertical => 136,
            Self::ImpliedCheckBroken { .. } => 137,
            Self::ImpliedCheckOpen => 650,
            Self::CheckLabels => 132,
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
            Self::IncludeNotFound { .. } => 31,
            Self::EndMissing => 23,
            Self::Unused { .. }
            | Self::WordBecomesName { .. }
            | Self::NotFinite
            | Self::Untransformable { .. }
            | Self::Doubtful { .. }
            | Self::MacroVariableTwice { .. }
            | Self::RoutineNotAvailable { .. }
            | Self::Endless { .. }
            | Self::ZeroStep
            | Self::NotInDialect { .. }
            | Self::NoEffect { .. }
            | Self::AfterEnd
            | Self::Unreachable => return None,
        })
    }

    /// How bad this is unless the project says otherwise.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Unused { .. } | Self::AfterEnd => Severity::Hint,
            Self::EndMissing
            | Self::Doubtful { .. }
            | Self::NoEffect { .. }
            | Self::WordBecomesName { .. }
            | Self::MacroVariableTwice { .. }
            | Self::RoutineNotAvailable { .. }
            | Self::Unreachable => Severity::Warning,
            _ => Severity::Error,
        }
    }
}

/// The APT III number of a definition error (language reference 4.0 and 9.2).
fn definition_number(error: &DefinitionError) -> Option<u16> {
    match error {
        DefinitionError::UnknownFormat { .. } => Some(1000),
        DefinitionError::WrongModifier { .. } => Some(1003),
        DefinitionError::Impossible { .. } => Some(1005),
        DefinitionError::CanonicalCount { .. } => Some(84),
        DefinitionError::CanonicalKind { .. } => Some(80),
        DefinitionError::NotFinite { .. } => None,
        DefinitionError::Special { number, .. } => Some(*number),
    }
}

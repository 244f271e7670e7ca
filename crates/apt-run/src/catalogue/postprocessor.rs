//! Codes and hints for findings of the post-processor (codes 082x to 089x).

use apt_post::{PostFindingKind as Kind, Severity as PostSeverity};

use super::{Text, say};
use crate::diagnostic::Severity;

/// The words and the severity of a finding of Section 4.
pub(super) fn word(kind: &Kind) -> (Text, Severity) {
    let severity = match kind.severity() {
        PostSeverity::Information => Severity::Information,
        PostSeverity::Warning => Severity::Warning,
        PostSeverity::Error => Severity::Error,
    };
    let mut text = say(code(kind), kind.to_string());
    text.hint = hint(kind).map(str::to_owned);
    (text, severity)
}

fn code(kind: &Kind) -> &'static str {
    match kind {
        Kind::NoFeed => "APT0820",
        Kind::FeedNotPositive { .. } => "APT0821",
        Kind::FeedOutOfRange { .. } => "APT0822",
        Kind::FeedPerRevolutionWithoutSpindle => "APT0823",
        Kind::UnitMismatch { .. } => "APT0824",
        Kind::UnitsChanged => "APT0825",
        Kind::SpindleOff => "APT0830",
        Kind::SpindleOutOfRange { .. } => "APT0831",
        Kind::NoSpindleSpeed => "APT0832",
        Kind::NoCutterDiameter => "APT0833",
        Kind::AxisLimit { .. } => "APT0840",
        Kind::DigitLimit { .. } => "APT0841",
        Kind::NotFinite => "APT0842",
        Kind::ToolAxis { .. } => "APT0843",
        Kind::UnknownWord { .. } => "APT0850",
        Kind::NotSupported { .. } => "APT0851",
        Kind::UnknownArgument { .. } => "APT0852",
        Kind::ArgumentNotUsed { .. } => "APT0853",
        Kind::MissingArgument { .. } => "APT0854",
        Kind::BadValue { .. } => "APT0855",
        Kind::NoCode { .. } => "APT0856",
        Kind::Repeated { .. } => "APT0857",
        Kind::SameTool { .. } => "APT0860",
        Kind::ToolChangeWhile { .. } => "APT0861",
        Kind::CycleWithoutPosition => "APT0865",
        Kind::CycleExpanded { .. } => "APT0866",
        Kind::CycleNotPossible { .. } => "APT0867",
        Kind::TapFeed { .. } => "APT0868",
        Kind::StepNotLessThanDepth { .. } => "APT0869",
        Kind::CycleWithoutPoints => "APT0870",
        Kind::ArcAsChords { .. } => "APT0875",
        Kind::ArcNotInPlane => "APT0876",
        Kind::CompensationOnArc => "APT0877",
        Kind::CompensationUnused => "APT0878",
        Kind::NoClearance => "APT0880",
        Kind::NoRetract => "APT0881",
        Kind::MotionAfterEnd => "APT0885",
        Kind::NoFini => "APT0886",
        Kind::RapidUnused => "APT0887",
        Kind::Character { .. } => "APT0890",
        Kind::BlockTooLong { .. } => "APT0891",
    }
}

fn hint(kind: &Kind) -> Option<&'static str> {
    Some(match kind {
        Kind::NoFeed => "give FEDRAT before the first cut, or RAPID before a move in the air",
        Kind::SpindleOff => "give SPINDL with a speed and CLW or CCLW before the cut",
        Kind::UnitMismatch { .. } => "the feed word and the unit of the program disagree",
        Kind::UnknownWord { .. } => "check the spelling; the machine's definition lists the words it knows",
        Kind::ToolAxis { .. } => "this machine has a fixed spindle; choose one with rotary axes",
        Kind::AxisLimit { .. } => "shift the part by ORIGIN or TRANS, or choose a larger machine",
        Kind::CycleWithoutPosition => "give a GOTO before CYCLE",
        Kind::NoClearance => "give CLEARP first",
        _ => return None,
    })
}

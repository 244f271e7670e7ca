//! Codes and hints for findings of the post-processor (codes 082x to 089x).

use apt_post::{PostFindingKind as Kind, Severity as PostSeverity};

use super::{Text, number, say};
use crate::diagnostic::Severity;

/// The words and the severity of a finding of Section 4.
pub(super) fn word(kind: &Kind) -> (Text, Severity) {
    let severity = match kind.severity() {
        PostSeverity::Information => Severity::Information,
        PostSeverity::Warning => Severity::Warning,
        PostSeverity::Error => Severity::Error,
    };
    let mut text = say(code(kind), measured(kind).unwrap_or_else(|| kind.to_string()));
    text.hint = hint(kind).map(str::to_owned);
    (text, severity)
}

/// Messages with measured values, which are rounded for people.
fn measured(kind: &Kind) -> Option<String> {
    let outside = |what: &str, value: f64, least: f64, greatest: f64| {
        format!("{what} {} is outside {} to {}", number(value), number(least), number(greatest))
    };
    Some(match kind {
        Kind::FeedNotPositive { value } => format!("the feed rate {} is not positive", number(*value)),
        Kind::FeedOutOfRange { value, least, greatest } => {
            outside("the feed rate", *value, *least, *greatest)
        }
        Kind::SpindleOutOfRange { value, least, greatest } => {
            outside("the spindle speed", *value, *least, *greatest)
        }
        Kind::AxisLimit { axis, value, least, greatest } => {
            format!("{}, the travel of the machine", outside(axis, *value, *least, *greatest))
        }
        Kind::DigitLimit { axis, value } => {
            format!("{axis} {} has more digits than the control takes", number(*value))
        }
        Kind::ToolAxis { i, j, k, motions } => format!(
            "the tool axis ({}, {}, {}) is not that of the spindle; {}",
            number(*i),
            number(*j),
            number(*k),
            match motions {
                1 => "the motion is left out".to_owned(),
                more => format!("{more} motions are left out, of which this is the first"),
            }
        ),
        Kind::AxisUnreachable { i, j, k, positions } => format!(
            "no angles of the rotary axes point the tool along ({}, {}, {}); {}",
            number(*i),
            number(*j),
            number(*k),
            positions_left_out(*positions)
        ),
        Kind::RotaryLimit { axis, angle, least, greatest, positions } => {
            format!("{}; {}", outside(axis, *angle, *least, *greatest), positions_left_out(*positions))
        }
        Kind::RotaryTurnedBack { axis, from, to } => format!(
            "{axis} is at its end in the cut: the tool goes off the part while it turns from {} back to {}",
            number(*from),
            number(*to)
        ),
        Kind::RotarySwing { axis, degrees, turned } => format!(
            "{axis} turns by {} degrees where the tool turns by {}",
            number(tenths(*degrees)),
            number(tenths(*turned))
        ),
        Kind::BadValue { word, argument, value } => {
            format!("{word}: {argument} {} is out of range; the statement is left out", number(*value))
        }
        Kind::TapFeed { feed, pitch, speed } => format!(
            "the feed {} of the tap does not fit the pitch {} at {} turns per minute",
            number(*feed),
            number(*pitch),
            number(*speed)
        ),
        Kind::StepNotLessThanDepth { step, depth } => format!(
            "STEP {} is not less than the depth {}, so the hole is drilled in one pass",
            number(*step),
            number(*depth)
        ),
        Kind::ArcAsChords { deviation } if deviation.is_finite() => {
            format!("the circle is made of chords: an arc would be {} off", number(*deviation))
        }
        Kind::ArcAsChords { .. } => "the circle is made of chords: the control has no such arc".to_owned(),
        Kind::ArgumentOutOfRange { word, argument, value, least, greatest } => {
            outside(&format!("{word}: the {argument}"), *value, *least, *greatest)
        }
        _ => return None,
    })
}

/// Degrees as precise as anybody wants to read them.
fn tenths(degrees: f64) -> f64 {
    (degrees * 10.0).round() / 10.0
}

fn positions_left_out(positions: u32) -> String {
    match positions {
        1 => "the position is left out".to_owned(),
        more => format!("{more} positions are left out, of which this is the first"),
    }
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
        Kind::CoolantBeforeSpindle => "APT0834",
        Kind::AxisLimit { .. } => "APT0840",
        Kind::DigitLimit { .. } => "APT0841",
        Kind::NotFinite => "APT0842",
        Kind::ToolAxis { .. } => "APT0843",
        Kind::AxisUnreachable { .. } => "APT0844",
        Kind::RotaryLimit { .. } => "APT0845",
        Kind::RotaryTurnedBack { .. } => "APT0846",
        Kind::RotarySwing { .. } => "APT0847",
        Kind::TooManyParts { .. } => "APT0848",
        Kind::NoToolLength => "APT0849",
        Kind::CompensationTurns => "APT0874",
        Kind::CycleTurns => "APT0884",
        Kind::ClearanceNotReached { .. } => "APT0899",
        Kind::UnknownWord { .. } => "APT0850",
        Kind::NotSupported { .. } => "APT0851",
        Kind::UnknownArgument { .. } => "APT0852",
        Kind::ArgumentNotUsed { .. } => "APT0853",
        Kind::MissingArgument { .. } => "APT0854",
        Kind::BadValue { .. } => "APT0855",
        Kind::NoCode { .. } => "APT0856",
        Kind::Repeated { .. } => "APT0857",
        Kind::ArgumentRepeated { .. } => "APT0858",
        Kind::ArgumentConflict { .. } => "APT0859",
        Kind::SameTool { .. } => "APT0860",
        Kind::ToolChangeWhile { .. } => "APT0861",
        Kind::ToolOutsideMagazine { .. } => "APT0862",
        Kind::CuttingBeforeTool { .. } => "APT0863",
        Kind::OffsetWithoutTool { .. } => "APT0864",
        Kind::CycleWithoutPosition => "APT0865",
        Kind::CycleExpanded { .. } => "APT0866",
        Kind::CycleNotPossible { .. } => "APT0867",
        Kind::TapFeed { .. } => "APT0868",
        Kind::StepNotLessThanDepth { .. } => "APT0869",
        Kind::CycleWithoutPoints => "APT0870",
        Kind::CycleLeftOn { .. } => "APT0871",
        Kind::HolesLeftOut { .. } => "APT0895",
        Kind::CycleHasNoCode { .. } => "APT0896",
        Kind::TapDirection { .. } => "APT0897",
        Kind::NothingOn { .. } => "APT0872",
        Kind::CycleOnArc { .. } => "APT0873",
        Kind::ArcAsChords { .. } => "APT0875",
        Kind::ArcNotInPlane => "APT0876",
        Kind::CompensationOnArc => "APT0877",
        Kind::CompensationUnused => "APT0878",
        Kind::CompensationLeftOn { .. } => "APT0879",
        Kind::NoClearance { .. } => "APT0880",
        Kind::NoRetract => "APT0881",
        Kind::ArgumentOutOfRange { .. } => "APT0882",
        Kind::SkipLevel { .. } => "APT0883",
        Kind::MotionAfterEnd => "APT0885",
        Kind::AfterFini => "APT0902",
        Kind::NoFini => "APT0886",
        Kind::RapidUnused => "APT0887",
        Kind::FunctionInGroup { .. } => "APT0888",
        Kind::FunctionOfWord { .. } => "APT0889",
        Kind::Character { .. } => "APT0890",
        Kind::BlockTooLong { .. } => "APT0891",
        Kind::TextTooLong { .. } => "APT0892",
        Kind::NoRotaryAxis { .. } => "APT0893",
        Kind::NotInTapeCode { .. } => "APT0898",
    }
}

fn hint(kind: &Kind) -> Option<&'static str> {
    Some(match kind {
        Kind::NoFeed => "give FEDRAT before the first cut, or RAPID before a move in the air",
        Kind::SpindleOff => "give SPINDL with a speed and CLW or CCLW before the cut",
        Kind::UnitMismatch { .. } => "the feed word and the unit of the program disagree",
        Kind::UnknownWord { .. } => "check the spelling; the machine's definition lists the words it knows",
        Kind::ArgumentRepeated { .. } => "remove the one that is not meant",
        Kind::ArgumentConflict { .. } => "remove one of them",
        Kind::ToolOutsideMagazine { .. } => {
            "check the number, or the magazine in the definition of the machine"
        }
        Kind::CycleLeftOn { .. } => "give CYCLE/OFF after the last hole",
        Kind::CompensationLeftOn { .. } => "give CUTCOM/OFF before the tool leaves the contour",
        Kind::ToolAxis { .. } => {
            "this machine has a fixed spindle; choose one with rotary axes, as linuxcnc-mill5"
        }
        Kind::AxisLimit { .. } => "shift the part by ORIGIN or TRANS, or choose a larger machine",
        Kind::CycleWithoutPosition => "give a GOTO before CYCLE",
        Kind::NoClearance { .. } => "give CLEARP first",
        Kind::FeedNotPositive { .. } => "give a feed rate above zero; a pause is made by DELAY",
        Kind::FeedOutOfRange { .. } => "check the unit of the rate: IPM, MMPM, IPR or MMPR",
        Kind::FeedPerRevolutionWithoutSpindle => "give SPINDL with a speed before",
        Kind::UnitsChanged => "give UNITS once, before the first motion",
        Kind::SpindleOutOfRange { .. } => "the nearest speed of the machine is used",
        Kind::NoSpindleSpeed => "give the speed, as in SPINDL/1000,CLW",
        Kind::NoCutterDiameter => "give CUTTER before, or the diameter after DIAMTR",
        Kind::NotSupported { .. } => "choose another machine, or remove the word",
        Kind::NoCode { .. } => "add the code to the definition of the machine",
        Kind::ToolChangeWhile { .. } => "it is switched off first; SPINDL/OFF before the change says so",
        Kind::TapFeed { .. } => "pitch times speed is used; correct FEDRAT or TPI",
        Kind::CycleHasNoCode { .. } => {
            "give the moves by GOTO and FEDRAT, or add the cycle to the definition of the machine"
        }
        Kind::TapDirection { .. } => "TAP wants SPINDL with CLW, REVERS with CCLW",
        Kind::StepNotLessThanDepth { .. } => "use a smaller STEP, or the plain cycle",
        Kind::HolesLeftOut { .. } => "correct the CYCLE, or give the holes by GOTO and FEDRAT",
        Kind::CycleWithoutPoints => "give the positions of the holes after CYCLE",
        Kind::ArcAsChords { .. } | Kind::ArcNotInPlane => "the points keep the tolerance of the program",
        Kind::CompensationOnArc => "let the path enter and leave the contour by a line",
        Kind::CompensationUnused => "give CUTCOM before the motion that approaches or leaves the contour",
        Kind::NoRetract => "give RETRCT before, or a GOTO down to the part",
        Kind::AfterFini => "move FINI to the end, or remove what is left over",
        Kind::MotionAfterEnd => "move END to the end; STOP waits for the operator",
        Kind::NoFini => "check whether the file is complete",
        Kind::RapidUnused => "RAPID holds for the next motion only",
        Kind::Character { .. } => "it is written as a question mark; use the characters of ASCII",
        Kind::NotInTapeCode { .. } => {
            "write it with letters, digits, blanks and + - . , /, or leave out --punch: the tape is then text"
        }
        Kind::CuttingBeforeTool { .. } => "load the tool before the first cut",
        Kind::OffsetWithoutTool { .. } => "give LOADTL before",
        Kind::CoolantBeforeSpindle => "give SPINDL before COOLNT",
        Kind::NothingOn { .. } => "remove it, or give the cycle that it is meant to end",
        Kind::CycleOnArc { .. } => "give CYCLE/OFF before the circle",
        Kind::SkipLevel { .. } => "leave out the level",
        Kind::FunctionInGroup { .. } => {
            "let the words of the program bring the code, or add a word to the machine"
        }
        Kind::FunctionOfWord { .. } => "use the word, so that its state is known",
        Kind::TextTooLong { .. } => "shorten it, or divide it into two statements",
        Kind::AxisUnreachable { .. } => {
            "choose a machine whose rotary axes reach it, or lay the part otherwise"
        }
        Kind::RotaryLimit { .. } => {
            "give a RAPID off the part before, on which the axis can turn back, or retract_mm in the definition of the machine"
        }
        Kind::RotaryTurnedBack { .. } => "look at the place on the part, or divide the cut by a RAPID",
        Kind::RotarySwing { .. } => {
            "the tool is nearly along a rotary axis: tilt it, or lay the part otherwise"
        }
        Kind::TooManyParts { .. } => {
            "give a larger tolerance_mm or most_parts in the definition of the machine"
        }
        Kind::NoToolLength => "give LENGTH in LOADTL",
        Kind::CompensationTurns => "give CUTCOM/OFF before the motion on which the tool turns",
        Kind::CycleTurns => "give a RAPID off the part before the hole",
        Kind::ClearanceNotReached { .. } => "give the way out by RAPID and GOTO",
        Kind::NoRotaryAxis { .. } => "choose a machine with the axis, or remove the statement",
        _ => return None,
    })
}

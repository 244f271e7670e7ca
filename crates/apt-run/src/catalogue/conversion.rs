//! Codes and hints for what another CL dialect says otherwise (codes 0817 to 0819).

use apt_cldata::conversion::{ConversionNote, ConversionNoteKind as Kind};

use super::{Text, number, say};
use crate::diagnostic::Severity;

/// The words and the severity of what a conversion tells.
pub(super) fn word(note: &ConversionNote) -> (Text, Severity) {
    let message = match &note.kind {
        Kind::WithoutPositions { misfit } => format!(
            "an arc is written by its end alone, up to {} from the positions and chords of the source",
            number(*misfit)
        ),
        kind => kind.to_string(),
    };
    let message = match note.times {
        1 => message,
        2 => format!("{message} (and at another place)"),
        times => format!("{message} (and at {} other places)", times - 1),
    };
    let mut text = say(code(&note.kind), message);
    text.hint = hint(&note.kind).map(str::to_owned);
    (text, severity(&note.kind))
}

fn code(kind: &Kind) -> &'static str {
    match kind {
        Kind::AsRemark { .. }
        | Kind::LeftOut { .. }
        | Kind::RemarkLeftOut
        | Kind::Untranslated { .. }
        | Kind::Shortened { .. }
        | Kind::OtherCycle { .. } => "APT0817",
        Kind::PositionsAlone | Kind::WithoutPositions { .. } => "APT0818",
        Kind::AxisTold | Kind::UnitsAdded { .. } | Kind::NoUnits => "APT0819",
    }
}

fn severity(kind: &Kind) -> Severity {
    match kind {
        Kind::AsRemark { .. }
        | Kind::LeftOut { .. }
        | Kind::Untranslated { .. }
        | Kind::OtherCycle { .. }
        | Kind::NoUnits => Severity::Warning,
        Kind::RemarkLeftOut
        | Kind::Shortened { .. }
        | Kind::PositionsAlone
        | Kind::WithoutPositions { .. }
        | Kind::AxisTold
        | Kind::UnitsAdded { .. } => Severity::Information,
    }
}

fn hint(kind: &Kind) -> Option<&'static str> {
    Some(match kind {
        Kind::AsRemark { .. } => {
            "the remark begins with `$$ |`; converted back it is the statement again, and no post-processor sees it before"
        }
        Kind::LeftOut { .. } => "a text dialect, such as `cl`, keeps it",
        Kind::Untranslated { .. } => "compare its parameters with those that the post-processor takes",
        Kind::OtherCycle { .. } => {
            "in NCL, DEEP breaks chips and THRU withdraws the drill; in Creo and HSM, BRKCHP breaks chips and DEEP withdraws it"
        }
        Kind::NoUnits => "put UNITS/MM or UNITS/INCHES into the source",
        Kind::PositionsAlone => {
            "its positions are not about one axis at one distance, or the tool axis turns on the way"
        }
        _ => return None,
    })
}

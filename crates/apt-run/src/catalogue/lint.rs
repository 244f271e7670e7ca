//! Words for lints and for the comments that allow findings (codes 095x and 096x).

use apt_geometry::motion::DriveSide;

use super::{Text, number, say};
use crate::{
    allow::Idle,
    diagnostic::Severity,
    lint::{LintKind as Kind, side_word},
};

/// The words and the severity of a lint. What is a matter of taste is a hint.
pub(super) fn word(kind: &Kind) -> (Text, Severity) {
    match kind {
        Kind::PastLastColumn { and_others } => {
            let more = if *and_others { "; further lines like this are not told" } else { "" };
            let message =
                format!("this stands behind column 72, where processors that read cards cut it off{more}");
            (say("APT0951", message).hint("continue the statement with $ on the next line"), Severity::Hint)
        }
        Kind::BlanksInside { pieces, read_as } => (
            say("APT0952", format!("{} is read as one, {read_as}", pieces.join(" ")))
                .hint("blanks mean nothing: write a comma, or close the gap"),
            Severity::Warning,
        ),
        Kind::LooseTolerance { word, value, diameter } => {
            let (value, diameter) = (number(*value), number(*diameter));
            let message =
                format!("{word} {value} is more than a quarter of the cutter's diameter {diameter}");
            (say("APT0953", message).hint("is the unit of the program another one?"), Severity::Warning)
        }
        Kind::ToleranceMissing => (
            say("APT0954", "the tool moves along a curved part surface with the tolerances of the start")
                .hint("give INTOL and OUTTOL before the first motion"),
            Severity::Hint,
        ),
        Kind::FeedMissing { .. } => (
            say("APT0955", "the tool cuts before any feed rate has been given")
                .hint("give FEDRAT before this motion"),
            Severity::Warning,
        ),
        Kind::ThicknessUnfelt { .. } => (
            say("APT0956", "no motion feels this THICK: the tool is ON the surfaces")
                .hint("THICK works where the tool is beside, short of or behind a surface"),
            Severity::Warning,
        ),
        Kind::DirectionReplaced => (
            say("APT0957", "the next statement gives another direction before the tool moves")
                .hint("remove one of the two"),
            Severity::Warning,
        ),
        Kind::ToolWithTwoCutters { tool } => (
            say("APT0958", format!("tool {tool} has been in use with another CUTTER before"))
                .hint("load the tool that this cutter is, or give it the dimensions of before"),
            Severity::Information,
        ),
        Kind::SideContradicted { surface, said, stands } => {
            (side(surface, *said, *stands), Severity::Warning)
        }
        Kind::Overwritten { name } => (
            say("APT0961", format!("this value of {name} is overwritten before anything reads it"))
                .hint("remove one of the two statements, or give the second value another name"),
            Severity::Hint,
        ),
        Kind::ModeReplaced { mode } => (
            say("APT0962", format!("this {mode} serves nothing: another one comes before the tool moves"))
                .hint("remove the statement that serves nothing"),
            Severity::Hint,
        ),
    }
}

fn side(surface: &str, said: DriveSide, stands: DriveSide) -> Text {
    let place = match stands {
        DriveSide::Left => "left of",
        DriveSide::Right => "right of",
        DriveSide::On => "on",
    };
    let (said, stands) = (side_word(said), side_word(stands));
    say("APT0959", format!("the tool stands {place} {surface} when it turns onto it, and {said} is in force"))
        .hint(format!("write {stands}, or stop the motion before on the other side of {surface}"))
}

/// The words for a comment that allows nothing.
pub(super) fn idle(reason: Idle, code: &str) -> Text {
    match reason {
        Idle::UnknownCode => say("APT0960", format!("there is no diagnostic {code}"))
            .hint("the code of a finding stands beside it"),
        Idle::Error => say("APT0960", format!("{code} is an error here, and errors cannot be allowed"))
            .hint("the setting severity can make it milder for a whole project"),
        Idle::NothingFound => say("APT0960", format!("this allows {code}, but nothing of the kind is found"))
            .hint("remove the comment"),
    }
}

//! Words for the path transformations (codes 071x and 072x).

use apt_cldata::edit::EditErrorKind;

use super::MORE_POINTS;
use crate::catalogue::{Text, say, tilt};

/// The words for a mistake in TRACUT, INDEX, COPY and VTLAXS.
pub(super) fn text(kind: &EditErrorKind) -> Text {
    match kind {
        EditErrorKind::NestedTooDeep { number, depth } => {
            say("APT0710", format!("INDEX {number} is nested {depth} deep")).hint("three levels are possible")
        }
        EditErrorKind::CopyWithoutIndex { number } => {
            say("APT0711", format!("there is no INDEX/{number} before this COPY"))
        }
        EditErrorKind::EndWithoutIndex { number } => say("APT0712", format!("INDEX/{number} is not open")),
        EditErrorKind::Overlap { number, open } => {
            say("APT0713", format!("the range of INDEX/{number} overlaps that of INDEX/{open}"))
                .hint("ranges must lie inside each other or apart")
        }
        EditErrorKind::IndexReused { number } => say("APT0714", format!("INDEX/{number} was given before"))
            .hint("every INDEX of a program needs a number of its own"),
        EditErrorKind::TooManyIndexes { limit } => {
            say("APT0715", format!("a program can have {limit} INDEX statements"))
        }
        EditErrorKind::TooManyCopies { number } => {
            say("APT0715", format!("too many COPY statements name INDEX/{number}"))
        }
        EditErrorKind::ZeroCount { number } => say("APT0716", format!("COPY/{number} makes no copy")),
        EditErrorKind::TooManyRecords { number, limit } => {
            say("APT0717", format!("COPY/{number} would make more than {limit} records"))
        }
        EditErrorKind::TooManyPoints { number, limit } => {
            say("APT0717", format!("COPY/{number} would give the path more than {limit} positions"))
                .hint(MORE_POINTS)
        }
        EditErrorKind::AxisVanishes { .. } => {
            say("APT0718", "the transformation leaves the tool axis without direction")
        }
        EditErrorKind::Tilt(error) => tilt::word(error),
        EditErrorKind::NotFinite { .. } => {
            say("APT0719", "the transformation gives a position that is not a number")
        }
    }
}

//! Words for mistakes around VTLAXS and WCORN (codes 072x).

use apt_cldata::tilt::{LARGEST_TILT, TiltError};

use super::{Text, number, say};

/// The words of a mistake.
pub(super) fn word(error: &TiltError) -> Text {
    match error {
        TiltError::NotOn => say("APT0720", "VTLAXS/OFF ends nothing: VTLAXS is not on"),
        TiltError::NotOff => {
            say("APT0720", "VTLAXS/OFF is missing: the tilt at the end is not known, and nothing is tilted")
        }
        TiltError::OnTwice => say("APT0720", "VTLAXS is on already").hint("give VTLAXS/OFF first"),
        TiltError::CornerOutside => say("APT0720", "WCORN stands outside of VTLAXS/ON and VTLAXS/OFF"),
        TiltError::CornerTwice => say("APT0720", "a second WCORN while VTLAXS is on")
            .hint("give VTLAXS/OFF and VTLAXS/ON between two corners"),
        TiltError::From => inside("FROM"),
        TiltError::Transform => inside("TRACUT"),
        TiltError::Copy => inside("COPY"),
        TiltError::Index => inside("INDEX"),
        TiltError::IndexBefore => say("APT0721", "INDEX stands between the last motion and VTLAXS/ON")
            .hint("VTLAXS tilts the tool at the last position already: give INDEX before it"),
        TiltError::NoMotionBefore => still("before VTLAXS/ON", "it tilts the tool from the last position on"),
        TiltError::NoMotion => still("while VTLAXS is on", "give the path that is cut with a tilted tool"),
        TiltError::NoMotionBeforeCorner => {
            still("between VTLAXS/ON and WCORN", "give the wall before the corner")
        }
        TiltError::NoMotionAfterCorner => {
            still("between WCORN and VTLAXS/OFF", "give the wall behind the corner")
        }
        TiltError::NoAxes => {
            say("APT0723", "VTLAXS tilts the tool axis, which is not put out").hint("give MULTAX before")
        }
        TiltError::TooFar { degrees } => say(
            "APT0724",
            format!("a tilt of {} degrees, at most {LARGEST_TILT} are possible", number(degrees.abs())),
        ),
        TiltError::CornerRadius { corner, radius } => say(
            "APT0724",
            format!("the corner radius {} is above the cutter radius {}", number(*corner), number(*radius)),
        )
        .hint("the diameter comes first, then the corner radius"),
        TiltError::RoundedEdge { corner } => say(
            "APT0724",
            format!("ZSMALL is for a cutter with a sharp edge, and its corner radius is {}", number(*corner)),
        ),
        TiltError::Vertical => {
            say("APT0725", "a cut vector runs along z, so that there is no side to tilt to")
                .hint("VTLAXS is for paths of constant height")
        }
        TiltError::Form(word) => {
            say("APT0726", format!("the parameters of {word} are not those of its form"))
                .hint("VTLAXS/ON,LEFT,alpha,d,r,RIGHT and VTLAXS/OFF,LEFT,beta")
        }
        TiltError::CornerNotMade => {
            say("APT0727", "the corner of WCORN is not computed, and the path is not tilted")
                .hint("end VTLAXS at the corner, clean it out by GOTO with axes, and begin again behind it")
        }
    }
}

fn inside(word: &str) -> Text {
    say("APT0721", format!("{word} stands while VTLAXS is on, and the path is not tilted"))
        .hint(format!("give {word} before VTLAXS/ON or after VTLAXS/OFF"))
}

fn still(place: &str, hint: &str) -> Text {
    say("APT0722", format!("there is no motion {place}")).hint(hint)
}

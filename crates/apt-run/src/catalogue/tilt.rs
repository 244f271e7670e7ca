//! Words for mistakes around VTLAXS and WCORN, and for axes that are not put out (codes 072x).

use apt_cldata::tilt::{LARGEST_TILT, TiltError};

use super::{Text, number, say};

/// The words for a motion on which the tool turns by an angle, in radians, and whose positions are put out without axis.
pub(super) fn not_put_out(angle: f64) -> Text {
    let degrees = number(angle.to_degrees());
    say("APT0728", format!("the tool turns by {degrees}° on this motion, and its axis is not put out"))
        .hint("give MULTAX before, or an axis that stays")
}

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
        TiltError::Form(word) | TiltError::Modifier(word) => {
            let form = match *word {
                "WCORN" => "WCORN/LEFT,alpha,LEFT,beta,h,n",
                _ => "VTLAXS/ON,LEFT,alpha,d,r,RIGHT and VTLAXS/OFF,LEFT,beta",
            };
            say("APT0726", format!("the parameters of {word} are not those of its form")).hint(form)
        }
        TiltError::CornerOpen => corner("the walls make no inside corner: the path turns towards its wall"),
        TiltError::NoStartOfCorner => corner("no starting position is found before the corner"),
        TiltError::NoWayThroughCorner => {
            corner("no starting and ending position are found before and behind the corner")
        }
        TiltError::NoEndOfCorner => corner("no ending position is found behind the corner"),
        TiltError::CornerBothSides => {
            corner("with ZSMALL the tool cannot lean over one wall and away from the other")
        }
        TiltError::ShortBeforeCorner { wanted, length } => short("VTLAXS/ON and WCORN", *wanted, *length),
        TiltError::ShortAfterCorner { wanted, length } => short("WCORN and VTLAXS/OFF", *wanted, *length),
        TiltError::CornerSteps { steps } => {
            say("APT0726", format!("WCORN with {} steps into the corner, which is too many", number(*steps)))
        }
    }
}

fn corner(what: &str) -> Text {
    say("APT0727", format!("{what}, and the path is not tilted"))
}

fn short(place: &str, wanted: f64, length: f64) -> Text {
    let (wanted, length) = (number(wanted), number(length));
    say("APT0722", format!("the path between {place} is {length} long, and the corner takes {wanted} of it"))
}

fn inside(word: &str) -> Text {
    say("APT0721", format!("{word} stands while VTLAXS is on, and the path is not tilted"))
        .hint(format!("give {word} before VTLAXS/ON or after VTLAXS/OFF"))
}

fn still(place: &str, hint: &str) -> Text {
    say("APT0722", format!("there is no motion {place}")).hint(hint)
}

//! Words for regional milling and interference checking (codes 063x).

use apt_geometry::regional::LiftDirection;
use apt_sculptured::{
    error::{MillingError as Error, Reduction, StationError},
    mill::{NotAvoided, Remedy},
};

use super::{Text, motion::place, number, say};
use crate::{
    diagnostic::Severity,
    pipeline::{Interference, Outcome},
};

/// Why a SMIL ended.
pub(super) fn failure(error: &Error) -> (Text, Severity, Option<u16>) {
    (failure_text(error), Severity::Error, error.number())
}

/// Checks without proof.
pub(super) fn not_proven(locations: u32) -> (Text, Severity, Option<u16>) {
    let text = say(
        "APT0639",
        format!("at {locations} locations nothing was proven: the tool fits the surface too closely"),
    )
    .hint("interference of the size of INTOL may be there; use another cutter or a larger INTOL");
    (text, Severity::Warning, None)
}

fn failure_text(error: &Error) -> Text {
    match error {
        Error::NoFirstContact { parameters: [u, v], cause } => say(
            "APT0630",
            format!(
                "the tool does not reach the part surface from the guide at {}, {}: {}",
                number(*u),
                number(*v),
                station(cause)
            ),
        )
        .hint("look at the projection of SCON/DS, and at the side that SCON/PS says"),
        Error::TooManyReductions { parameters: [u, v], reductions, cause } => say(
            "APT0631",
            format!(
                "the path ends after the guide parameters {}, {}: the step was shortened {reductions} times; {}",
                number(*u),
                number(*v),
                reduction(cause)
            ),
        )
        .hint("use a smaller cutter, or end the range of SCON/DS before this place"),
        Error::TooManyLocations { most } => {
            say("APT0632", format!("more than {most} locations in one SMIL"))
                .hint("larger tolerances or a larger step over need fewer")
        }
        Error::TooLong { most } => {
            say("APT0633", format!("the path of one SMIL is longer than {}", number(*most)))
                .hint("look at the range of SCON/DS and at the step over")
        }
        Error::NoCutter => say("APT0634", "no cutter has been defined").hint("write CUTTER/diameter,radius before SMIL"),
        Error::OutsideRange { parameters: [u, v] } => say(
            "APT0635",
            format!("the start {}, {} lies outside of the range of SCON/DS", number(*u), number(*v)),
        ),
        Error::NotSculptured { name } => {
            let name = if name.is_empty() { "the surface" } else { name.as_str() };
            say("APT0635", format!("{name} is no sculptured surface"))
        }
        Error::Guide(error) => say("APT0635", error.to_string()),
        Error::PlaneNotReached => {
            say("APT0635", "the tool runs along the plane that it should back off to")
                .hint("take a plane across the direction in which the tool backs off")
        }
        Error::CurveHasOnePass => say("APT0635", "along a guide curve there is one pass only").hint("write SMIL/PATH"),
        Error::Cancelled => say("APT0635", "the path was given up"),
    }
}

fn station(cause: &StationError) -> String {
    match cause {
        StationError::Guide(error) => error.to_string(),
        StationError::Contact(none) if none.distance.is_finite() => {
            format!("the nearest place stays {} from the projection line", number(none.distance))
        }
        StationError::Contact(_) => "there is no surface on the projection line".to_owned(),
        StationError::Tool(none) => format!(
            "the surface leans {} degrees from the tool axis, the tool touches up to {}",
            number(none.polar.to_degrees()),
            number(none.greatest.to_degrees())
        ),
        StationError::NoAxis => "the tool axis has no direction there".to_owned(),
    }
}

fn reduction(cause: &Reduction) -> String {
    match cause {
        Reduction::Station(cause) => station(cause),
        Reduction::Misfit { radius, tool } => format!(
            "the surface is concave with the radius {}, the tool has {}",
            number(*radius),
            number(*tool)
        ),
        Reduction::TooFar { moved, allowed } => format!(
            "the tool would jump by {}, where {} keep the tolerance",
            number(*moved),
            number(*allowed)
        ),
        Reduction::Chord { deviation } => {
            format!("the way between two locations is {} from the surface", number(*deviation))
        }
    }
}

/// Interferences with the same outcome.
pub(super) fn interference(found: &Interference) -> (Text, Severity, Option<u16>) {
    let worst = &found.worst;
    let where_ = match found.count {
        1 => "at one location".to_owned(),
        count => format!("at {count} locations"),
    };
    let surface = if worst.surface.is_empty() { "the surface" } else { worst.surface.as_str() };
    let [u, v] = worst.hit.parameters;
    let depth = format!(
        "{surface} reaches into the tool {where_}, {} deep at most: patch {}, {}, {}, tool end {}",
        number(worst.hit.depth),
        worst.hit.patch + 1,
        number(u),
        number(v),
        place(&worst.pose.end)
    );
    match found.outcome {
        Outcome::Told => {
            let text = say("APT0636", depth).hint("AVCTRL lets the tool tilt or lift out of it");
            (text, Severity::Warning, None)
        }
        Outcome::Avoided => (
            say("APT0637", format!("{depth}; avoided{}", remedy(&worst.remedy))),
            Severity::Information,
            None,
        ),
        Outcome::Failed => {
            let text = say("APT0638", format!("{depth}; not avoided{}", remedy(&worst.remedy)))
                .hint("a larger RANGE or LIMIT of AVCTRL, or a smaller cutter");
            (text, Severity::Warning, Some(3555))
        }
    }
}

fn remedy(remedy: &Remedy) -> String {
    match remedy {
        Remedy::None => String::new(),
        Remedy::Avoided { tilt, pitch, lift, along, pose } => {
            let mut text = String::new();
            if *tilt != 0.0 {
                let how = if *pitch { "pitching" } else { "rolling" };
                text.push_str(&format!(" by {how} {} degrees", number(tilt.to_degrees())));
            }
            if *lift != 0.0 {
                let along = match along {
                    LiftDirection::Axis => "the tool axis",
                    LiftDirection::PartNormal => "the normal of the part surface",
                };
                let and = if text.is_empty() { "" } else { " and" };
                text.push_str(&format!("{and} by lifting {} along {along}", number(*lift)));
            }
            text.push_str(&format!(": tool end {}, axis {}", place(&pose.end), place(&pose.axis)));
            text
        }
        Remedy::Failed(NotAvoided::Limit { limit, needed }) => {
            format!(": a lift of {} is allowed, {} at least would be needed", number(*limit), number(*needed))
        }
        Remedy::Failed(NotAvoided::StillInside { depth }) => {
            format!(": {} are left after all remedies", number(*depth))
        }
    }
}

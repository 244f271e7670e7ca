//! Words for POCKET (codes 067x).

use arelem::pocket::{CornerFault, PocketFailure as Failure};

use super::{Text, a_kind, number, say};

/// Why a pocket has no path.
pub(super) fn text(failure: &Failure) -> Text {
    match failure {
        Failure::Corner { corner, fault, .. } => {
            let point = corner + 1;
            let what = match fault {
                CornerFault::Duplicate { other } => {
                    format!("points {} and {point} of the pocket are the same", other + 1)
                }
                CornerFault::Collinear => {
                    format!("point {point} of the pocket is on the line through its neighbours")
                }
                CornerFault::NotInPlane => {
                    format!("the sides at point {point} are not in the plane of the pocket")
                }
                CornerFault::Concave => format!("the pocket is not convex at point {point}"),
            };
            say("APT0670", what)
                .hint("POCKET clears a convex figure in a plane; every point must be a corner")
        }
        Failure::AxisInPlane { sine } => {
            let degrees = number(sine.clamp(0.0, 1.0).asin().to_degrees());
            say("APT0671", format!("the tool axis is only {degrees} degrees from the plane of the pocket"))
                .hint("more than 12 degrees are needed")
        }
        Failure::CutterRadius { .. } => {
            say("APT0672", "POCKET needs a cutter with a radius").hint("give CUTTER/diameter before")
        }
        Failure::NegativeEffectiveRadius { value } => negative("effective radius", *value),
        Failure::NegativeOffset { value, finish: false } => negative("offset factor", *value),
        Failure::NegativeOffset { value, finish: true } => negative("finishing offset factor", *value),
        Failure::NegativeFeed { value } => negative("feed", *value),
        Failure::PointKind { kind } => say("APT0673", format!("the kind of points is {kind}, not 0 to 3")),
        Failure::DoesNotFit { radius, greatest } => say(
            "APT0674",
            format!("the cutter does not fit into the pocket: its radius is {}", number(*radius)),
        )
        .hint(format!("the greatest radius that fits is {}", number(*greatest))),
        Failure::PartNotPlane { kind } => {
            let what = format!("points cannot be projected on {} as part surface", a_kind(*kind));
            say("APT0675", what).hint("give a plane by PSIS")
        }
        Failure::NoOffset => say("APT0676", "the offset between the passes of the pocket is zero")
            .hint("the second number is the offset in cutter radii"),
        Failure::TooManyPasses { limit, offset } => say(
            "APT0676",
            format!("the pocket needs more than {limit} passes at an offset of {}", number(*offset)),
        )
        .hint("the second number is the offset in cutter radii"),
    }
}

fn negative(what: &str, value: f64) -> Text {
    say("APT0673", format!("the {what} of a pocket cannot be {}", number(value)))
}

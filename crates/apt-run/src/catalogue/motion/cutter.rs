//! Words for cutters that there are not.

use apt_geometry::cutter::CutterError;

use crate::catalogue::{Text, number, say};

/// Why there is no such cutter.
pub(super) fn text(error: &CutterError) -> Text {
    let why = match error {
        CutterError::Count { found } => {
            return say("APT0650", format!("CUTTER takes 1, 2 or 7 numbers, not {found}"));
        }
        CutterError::NotFinite { position } => format!("number {position} is too large, or not a number"),
        CutterError::Diameter { diameter } => format!("the diameter {} is negative", number(*diameter)),
        CutterError::Height { height } => format!("the height {} is negative", number(*height)),
        CutterError::Angles { .. } => "its two angles add up to 90° or more".to_owned(),
        CutterError::Alpha { .. } => "the angle of the lower line is negative".to_owned(),
        CutterError::HeightBelowLine { height, least } => {
            format!(
                "the height {} is less than the end of the lower line at {}",
                number(*height),
                number(*least)
            )
        }
        CutterError::Beta { .. } => "the angle of the upper line is negative".to_owned(),
        CutterError::CornerRadius { radius } => format!("the corner radius {} is negative", number(*radius)),
        CutterError::CornerBelowLine { height, least } => {
            format!(
                "the corner centre at height {} is below the corner at {}",
                number(*height),
                number(*least)
            )
        }
        CutterError::ArcAtTip { .. } => "the corner arc does not fit the tip".to_owned(),
        CutterError::ArcMissesLowerLine { distance, radius, .. } => format!(
            "the corner arc of radius {} does not meet the lower line, which is {} from its centre",
            number(*radius),
            number(*distance)
        ),
        CutterError::ArcMissesUpperLine { distance, radius, .. } => format!(
            "the corner arc of radius {} does not meet the upper line, which is {} from its centre",
            number(*radius),
            number(*distance)
        ),
        CutterError::ArcAtTop { reached, height } => {
            format!("the corner arc reaches {} and the cutter ends at {}", number(*reached), number(*height))
        }
        CutterError::CornerTooNear { distance, radius } => format!(
            "the corner radius {} reaches beyond the corner, which is {} from its centre",
            number(*radius),
            number(*distance)
        ),
    };
    say("APT0651", format!("there is no such cutter: {why}"))
        .hint("CUTTER/d,r is enough for most tools; the corner must touch both lines")
}

//! Words for what a motion is warned of.

use apt_geometry::cutter::CutterWarning;
use arelem::error::{MotionWarning as Warning, RoleName};

use super::{place, role};
use crate::catalogue::{Text, number, remedy, say};

/// What is to be known of a motion that is made all the same.
pub(super) fn text(warning: &Warning) -> Text {
    match warning {
        Warning::WrongSideOfDrive { side, .. } => {
            let word = remedy::drive_side_word(*side);
            say("APT0660", "the tool is on the other side of the drive surface than TLLFT or TLRGT says")
                .hint(format!(
                    "seen along the motion it is where {word} says; or the direction word is wrong"
                ))
        }
        Warning::Cutter(CutterWarning::ArcReachesAxis) => {
            say("APT0661", "the corner arc of the cutter reaches the tool axis")
        }
        Warning::Cutter(CutterWarning::ArcReachesTop) => {
            say("APT0662", "the corner arc of the cutter reaches its top")
        }
        Warning::AutomaticPartWithTiltedAxis { tilt } => say(
            "APT0663",
            format!(
                "AUTOPS makes a horizontal part surface, and the tool axis is tilted by {}°",
                number(tilt.to_degrees())
            ),
        )
        .hint("give the part surface by PSIS"),
        Warning::Gouge { role: name, depth, contact, on, ahead } => say(
            "APT0665",
            format!(
                "{} {} deep into the {} at {}",
                if *ahead { "going on, the tool would cut" } else { "the tool cuts" },
                number(*depth),
                role(*name),
                place(&contact.surface)
            ),
        )
        .hint(if *on {
            format!(
                "with the tool end at {}, which is ON the surface whatever the rest of the tool cuts; TLOFPS keeps all of it out",
                place(&contact.tip)
            )
        } else {
            format!(
                "the tool end would be at {}; take a smaller tool, or stop before the narrow place",
                place(&contact.tip)
            )
        }),
        Warning::EndsBesideTool { role: name, place: end } => say(
            "APT0666",
            format!("the {} ends at {}, beside the tool", role(*name), place(end)),
        )
        .hint(
            "beyond its end a surface has no sides: one that reaches farther, or a shorter tool, settles it",
        ),
        Warning::SurfaceTwice { roles: [one, other], start_up } => say(
            "APT0667",
            format!("one surface is the {} and the {} of this motion", role(*one), role(*other)),
        )
        .hint(match other {
            _ if *start_up => {
                "the tool is as free as if it were named once, or asked for two things that exclude each other: name another surface, or leave it out"
            }
            RoleName::Check(_) => "a surface that the tool follows stops it nowhere: name another one to stop at",
            _ => "only the direction asked for leads the tool then: name another drive surface, or another part surface by PSIS",
        }),
        Warning::DirectionFromOrigin { direction } => say(
            "APT0668",
            format!(
                "FROM leaves the forward direction undefined; that from the origin to the tool is taken, {}",
                place(direction)
            ),
        )
        .hint("give INDIRV or INDIRP before the motion, or bring the tool there by GO, GOTO or GODLTA"),
        Warning::DeepUndercut { role: name, thickness, radius } => say(
            "APT0669",
            format!(
                "THICK {} for the {} is more than the radius of the cutter, {}",
                number(*thickness),
                role(*name),
                number(*radius)
            ),
        )
        .hint("no point of the tool's round is left on its side; values of THICK are for part, drive and check surface in this order"),
        Warning::NegativeTolerance { value } => {
            say("APT0664", format!("the tolerance {} is negative and is taken as zero", number(*value)))
        }
    }
}

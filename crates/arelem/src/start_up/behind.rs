//! Positions of a start-up at which the tool touches the end of a surface from behind. It is in the band there by its distance alone: a little
//! deeper it is in the surface by all of what is behind that, and a motion that began so would be at its end.

use apt_geometry::Vec3;

use super::StartUp;
use crate::{directed::end_from_behind, error::MotionFailure};

/// What is told of a position behind the end of a surface, which is no position on the side of it on which the tool is to stand.
pub(super) fn failure(work: &StartUp<'_>, tip: &Vec3) -> Option<MotionFailure> {
    let tool = work.attitude.tool_at(tip).ok()?;
    work.roles.iter().find_map(|role| {
        let place = end_from_behind(role, &tool, tip)?;
        Some(MotionFailure::BehindEnd { role: role.name, tip: *tip, place })
    })
}

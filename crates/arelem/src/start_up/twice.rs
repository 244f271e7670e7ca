//! What is told of a start-up that names one surface twice.

use apt_geometry::motion::StartSurface;

use super::NAMES;
use crate::error::MotionWarning;

/// A warning for each surface that is one of those named before it: it leaves the tool as free as it was, or asks for what contradicts the
/// first relation, and where the tool goes is not what three surfaces would tell.
pub(crate) fn named(surfaces: &[StartSurface]) -> impl Iterator<Item = MotionWarning> {
    let named = surfaces.iter().zip(NAMES).enumerate();
    named.filter_map(|(index, (again, role))| {
        let is_it = |known: &StartSurface| known.surface.geometry == again.surface.geometry;
        let first = surfaces.iter().zip(NAMES).take(index).find(|(known, _)| is_it(known));
        first.map(|(_, first)| MotionWarning::SurfaceTwice { roles: [first, role], start_up: true })
    })
}

//! Where a motion leads at its end, which is what the direction word of the next one is told from.

use apt_geometry::Vec3;

use super::{Prepared, prepare::TANGENT_SINE};

/// A last vector so many times as long as both bands together leads off its path by a sixteenth of a radian at most.
const TELLING: f64 = 16.0;

/// The direction of the path at its end, where its last vector is too short to tell: one that is short against the bands may lead across them
/// (AREPRE takes the last move, whatever its length). None where the last vector tells, or the surfaces are tangent there.
pub(super) fn at_end(prepared: &Prepared, points: &[Vec3]) -> Option<Vec3> {
    let (end, before) = points.split_last()?;
    let telling = TELLING * (prepared.part.band() + prepared.drive.band());
    let way_from = |place: &Vec3| end - place;
    if way_from(before.last().unwrap_or(&prepared.tip)).norm() >= telling {
        return None;
    }
    let is_away = |place: &&Vec3| way_from(place).norm() >= telling;
    let way = way_from(before.iter().rev().find(is_away).unwrap_or(&prepared.tip));
    let posture = prepared.attitude.posture(end).ok()?;
    let [part, drive] =
        [&prepared.part, &prepared.drive].map(|role| posture.contact(&role.gauge, end).gradient);
    let along = part.cross(&drive).try_normalize(TANGENT_SINE)?;
    Some(if along.dot(&way) < 0.0 { -along } else { along })
}

//! The gouge check of a cut vector (GOUGCK, sculptured surfaces reference 3.40): both bands, three places.

use super::{
    Job,
    station::{Course, Station},
};
use crate::{error::Reduction, tool::Pose};

/// Where the chord is looked at.
const SHARES: [f64; 3] = [0.25, 0.5, 0.75];
/// Share of the admissible step that is tried next: deviations grow with the square of the step.
const CAUTION: f64 = 0.95;
/// How a step shrinks at most.
const LEAST_FACTOR: f64 = 0.1;
/// Excess over a tolerance that is rounding, as a share of the band.
const SLACK: f64 = 1e-6;

impl Job<'_> {
    /// Whether the tool stays in the band on its way between two stations. At each place the tool is held against the
    /// tangent plane of the contact that belongs there: what it lacks to the plane is its distance from the surface, and
    /// what it reaches through is the gouge.
    pub(super) fn chord(
        &self,
        last: &Station,
        next: &Station,
        course: &Course,
    ) -> Result<(), (Reduction, f64)> {
        let chord = next.pose.end - last.pose.end;
        let square = chord.norm_squared();
        if square == 0.0 {
            return Ok(());
        }
        let (inside, outside) = (self.setting.inside, self.setting.outside);
        for share in SHARES {
            let parameters =
                [0, 1].map(|k| last.parameters[k] + share * (next.parameters[k] - last.parameters[k]));
            let between = self
                .station(parameters, course, Some(last))
                .map_err(|cause| (Reduction::Station(cause), CAUTION * 0.5))?;
            let along = ((between.pose.end - last.pose.end).dot(&chord) / square).clamp(0.0, 1.0);
            let axis = last.pose.axis * (1.0 - along) + next.pose.axis * along;
            let pose = Pose {
                end: last.pose.end + chord * along,
                axis: axis.try_normalize(0.0).unwrap_or(last.pose.axis),
            };
            let deviation = self.clearance(&pose, &between) - course.stock;
            let slack = SLACK * (inside + outside);
            let tolerance = if deviation < -inside - slack {
                inside
            } else if deviation > outside + slack {
                outside
            } else {
                continue;
            };
            // The station itself stands at its offset in the band: the chord has what is left to it.
            let bow = (deviation - (between.offset - course.stock)).abs().max(f64::MIN_POSITIVE);
            let room = (tolerance + deviation.signum() * (course.stock - between.offset)).max(0.0);
            let factor = CAUTION * (room / bow).sqrt();
            return Err((Reduction::Chord { deviation }, factor.clamp(LEAST_FACTOR, CAUTION)));
        }
        Ok(())
    }

    /// Distance of the tool, or of its end where that runs on the surface, from the tangent plane of a station.
    fn clearance(&self, pose: &Pose, at: &Station) -> f64 {
        let (point, normal) = (&at.contact.at.position, &at.contact.normal);
        match self.command.part.relation {
            apt_geometry::regional::PartRelation::To => self.tool.gap_to_plane(pose, point, normal),
            apt_geometry::regional::PartRelation::On => (pose.end - point).dot(normal),
        }
    }
}

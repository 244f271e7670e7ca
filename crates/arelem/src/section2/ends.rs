//! What a failure may be owed to: a surface that ends beside the tool. What lies beyond its end is not part of it, and on which side
//! of it the tool is there says nothing.

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    motion::{DriveSide, MotionCommand, NamedSurface, PartSide, Relation},
    surface::Surface,
};

use super::State;
use crate::error::{MotionFailure, MotionWarning, RoleName};

/// Places along the tool axis from which ends are looked for.
const PLACES: u32 = 32;
/// How far from the axis an end is beside the tool, in radii and in heights of it.
const BESIDE: [f64; 2] = [3.0, 0.25];

/// The surfaces of a failed motion that end beside the tool where it failed.
pub(super) fn beside(state: &State, command: &MotionCommand, failure: &MotionFailure) -> Vec<MotionWarning> {
    let (Some(tip), Some(cutter)) = (place(failure), &state.cutter) else { return Vec::new() };
    let ends = |(role, named, on): (RoleName, &NamedSurface, bool)| {
        let surface = Surface::from_geometry(&named.geometry).ok().filter(Surface::has_ends)?;
        let place = end_beside(&surface, cutter, (&tip, &state.axis), on)?;
        Some(MotionWarning::EndsBesideTool { role, place })
    };
    surfaces(state, command).into_iter().filter_map(ends).collect()
}

/// Where a motion failed, if the end of a surface may be the reason.
fn place(failure: &MotionFailure) -> Option<Vec3> {
    match failure {
        MotionFailure::StartUpDiverges { tip, .. }
        | MotionFailure::IterationLimit { tip, .. }
        | MotionFailure::NoAdmissibleVector { tip, .. }
        | MotionFailure::NoProgress { tip, .. } => Some(*tip),
        MotionFailure::NeverMet { at, .. } => Some(*at),
        _ => None,
    }
}

/// The surfaces of a motion in their roles, and which of them the tool end is on.
fn surfaces<'a>(state: &'a State, command: &'a MotionCommand) -> Vec<(RoleName, &'a NamedSurface, bool)> {
    let part = (RoleName::Part, &state.part, state.part_side == PartSide::On);
    match command {
        MotionCommand::Start(starts) => {
            let names = [RoleName::Drive, RoleName::Part, RoleName::Check(0)];
            let given = starts.iter().zip(names);
            let mut all: Vec<_> =
                given.map(|(start, name)| (name, &start.surface, start.relation == Relation::On)).collect();
            if starts.len() == 1 && !state.no_part {
                all.push(part);
            }
            all
        }
        MotionCommand::Drive { drive, checks, .. } => {
            let checks = checks.iter().enumerate();
            let drive = (RoleName::Drive, drive, state.drive_side == DriveSide::On);
            let met =
                checks.map(|(k, check)| (RoleName::Check(k), &check.surface, check.relation == Relation::On));
            [part, drive].into_iter().chain(met).collect()
        }
        _ => Vec::new(),
    }
}

/// The end of a surface that is nearest to the axis of a tool, if one is beside it; for a tool end on it within reach of the tool.
fn end_beside(surface: &Surface, cutter: &Cutter, (tip, axis): (&Vec3, &Vec3), on: bool) -> Option<Vec3> {
    let [radii, share] = BESIDE;
    let wide = (radii * cutter.profile().greatest_radius()).max(share * cutter.height);
    let (heights, within) = if on { (0.0, cutter.height + wide) } else { (cutter.height, wide) };
    let places = (0..=PLACES).map(|k| tip + axis * (heights * f64::from(k) / f64::from(PLACES)));
    let ended = places.filter(|p| surface.ends_at(p)).map(|p| surface.foot(&p));
    let nearest = ended.min_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()))?;
    (nearest.distance.abs() <= within).then_some(nearest.point)
}

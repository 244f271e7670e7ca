//! Directed motions (AREPRE, ARLM2, ARLM3): from the tool's position along the drive and part surface until a check
//! surface stops it.

mod march;
mod plane_route;
mod prepare;
mod proof;
mod stop;

use apt_geometry::motion::{CheckSurface, NamedSurface, Relation, Turn};

pub(crate) use self::prepare::Prepared;
use crate::{
    bound,
    error::{MotionFailure, MotionWarning},
    role::Working,
    section2::State,
    sequence::{CutSequence, Stop, ToolPosition},
};

/// Where a motion ended, and by what.
pub(crate) struct Path {
    pub(crate) points: Vec<apt_geometry::Vec3>,
    pub(crate) check: usize,
    pub(crate) check_side: f64,
}

/// Computes one directed motion.
pub(crate) fn run(
    state: &State,
    turn: Turn,
    drive: &NamedSurface,
    checks: &[CheckSurface],
    warnings: &mut Vec<MotionWarning>,
    cancel: &dyn Fn() -> bool,
) -> Result<CutSequence, MotionFailure> {
    if checks.is_empty() {
        return Err(MotionFailure::SurfaceCount { found: 1 });
    }
    let prepared = prepare::prepare(state, turn, drive, checks, warnings)?;
    let path = match plane_route::run(state, &prepared, checks, cancel)? {
        Some(path) => path,
        None => march::run(state, &prepared, checks, cancel)?,
    };
    Ok(sequence(state, &prepared, checks, path))
}

fn sequence(state: &State, prepared: &Prepared, checks: &[CheckSurface], path: Path) -> CutSequence {
    let axis = prepared.tool.axis;
    let at = |tip| ToolPosition { tip, axis };
    let stop = checks.get(path.check).zip(prepared.checks.get(path.check)).map(|(check, working)| {
        let mut role = Working::role(working);
        role.side = path.check_side;
        Stop { role, occurrence: check.occurrence.max(1), index: path.check }
    });
    let mut sequence = CutSequence {
        start: at(prepared.tip),
        points: path.points.into_iter().map(at).collect(),
        cutter: prepared.tool.cutter,
        part: Some(prepared.part.role()),
        drive: Some(prepared.drive.role()),
        stop,
        drive_side: prepared.drive_side,
        start_up: false,
        forward: prepared.tangent,
        maximum_step: state.maximum_step,
        minimum: None,
    };
    sequence.minimum = bound::minimum(&sequence, prepared);
    sequence
}

/// True for the relations that stop at a tangency.
pub(crate) fn is_tangent(relation: Relation) -> bool {
    matches!(relation, Relation::TangentToDrive | Relation::TangentToPart)
}

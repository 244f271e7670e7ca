//! Directed motions (AREPRE, ARLM2, ARLM3): from the tool's position along the drive and part surface until a check
//! surface stops it.

mod fan;
mod gouge;
mod heading;
mod march;
mod neck;
mod plane_route;
mod prepare;
mod proof;
mod run_in;
mod stop;

use apt_geometry::{
    Vec3,
    motion::{AxisTangency, CheckSurface, NamedSurface, Relation, ToolAxis, Turn},
    patience::Patience,
};

#[cfg(test)]
pub(crate) use self::march::TRIED;
pub(crate) use self::{march::end_from_behind, prepare::Prepared};
use crate::{
    bound::{self, Bent},
    clearance::Shape,
    error::{MotionFailure, MotionWarning},
    role::Working,
    section2::State,
    sequence::{CutSequence, Stop, ToolPosition},
    story::Route,
};

/// Where a motion ended, and by what.
pub(crate) struct Path {
    pub(crate) points: Vec<Vec3>,
    pub(crate) check: usize,
    pub(crate) check_side: f64,
    pub(crate) bent: Bent,
}

/// Why a path was not found, and what GOUGCK/ON tells about the place.
pub(crate) struct Stuck {
    pub(crate) failure: Box<MotionFailure>,
    pub(crate) gouges: Vec<MotionWarning>,
}

impl From<MotionFailure> for Stuck {
    fn from(failure: MotionFailure) -> Self {
        Self { failure: Box::new(failure), gouges: Vec::new() }
    }
}

/// A directed motion.
pub(crate) struct Directed {
    pub(crate) sequence: CutSequence,
    /// Unit direction of its path at the end, where the last vector does not tell it.
    pub(crate) heading: Option<Vec3>,
}

/// Computes one directed motion.
pub(crate) fn run(
    state: &State,
    turn: Turn,
    drive: &NamedSurface,
    checks: &[CheckSurface],
    warnings: &mut Vec<MotionWarning>,
    patience: Patience<'_>,
) -> Result<Directed, MotionFailure> {
    if checks.is_empty() {
        return Err(MotionFailure::SurfaceCount { found: 1 });
    }
    let prepared = prepare::prepare(state, turn, drive, checks, warnings, patience)?;
    let path = |prepared: &Prepared| follow(state, prepared, checks, patience);
    let found = match state.axis_mode {
        ToolAxis::Tangent { mode: AxisTangency::Fan, .. } => fan::follow(prepared, &path),
        _ => run_in::follow(prepared, &path),
    };
    let (prepared, path) = found.map_err(|Stuck { failure, gouges }| {
        warnings.extend(gouges);
        *failure
    })?;
    let heading = heading::at_end(&prepared, &path.points);
    let sequence = sequence(state, &prepared, checks, path)?;
    if state.gouge_check {
        warnings.extend(gouge::along(&prepared, &sequence));
    }
    Ok(Directed { sequence, heading })
}

/// The path of a motion whose axis is settled.
fn follow(
    state: &State,
    prepared: &Prepared,
    checks: &[CheckSurface],
    patience: Patience<'_>,
) -> Result<Path, Stuck> {
    let path = plane_route::run(state, prepared, checks, patience).transpose();
    path.unwrap_or_else(|| march::run(state, prepared, checks, patience)).map_err(|failure| {
        let gouges = if state.gouge_check { gouge::where_stuck(prepared, &failure) } else { Vec::new() };
        Stuck { failure: Box::new(failure), gouges }
    })
}

/// By which route a directed motion is computed.
pub(crate) fn route(state: &State, turn: Turn, drive: &NamedSurface, checks: &[CheckSurface]) -> Route {
    let Ok(prepared) = prepare::prepare(state, turn, drive, checks, &mut Vec::new(), Patience::default())
    else {
        return Route::Iteration;
    };
    let flat = [&prepared.part, &prepared.drive].iter().all(|role| role.shape == Shape::Flat);
    if matches!(plane_route::run(state, &prepared, checks, Patience::default()), Ok(Some(_))) {
        Route::ClosedForm
    } else if flat && !prepared.attitude.turns() {
        Route::Straight
    } else {
        Route::Iteration
    }
}

fn sequence(
    state: &State,
    prepared: &Prepared,
    checks: &[CheckSurface],
    path: Path,
) -> Result<CutSequence, MotionFailure> {
    let at = |tip: Vec3| -> Result<ToolPosition, MotionFailure> {
        Ok(ToolPosition { tip, axis: prepared.attitude.tool_at(&tip)?.axis })
    };
    let stop = checks.get(path.check).zip(prepared.checks.get(path.check)).map(|(check, working)| {
        let mut role = Working::role(working);
        role.side = path.check_side;
        Stop { role, occurrence: check.occurrence.max(1), index: path.check }
    });
    let mut sequence = CutSequence {
        start: ToolPosition { tip: prepared.tip, axis: prepared.tool.axis },
        points: path.points.into_iter().map(at).collect::<Result<_, _>>()?,
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
    if !prepared.attitude.turns() {
        sequence.minimum = Some(bound::minimum(&sequence, prepared, &path.bent));
    }
    Ok(sequence)
}

/// True for the relations that stop at a tangency.
pub(crate) fn is_tangent(relation: Relation) -> bool {
    matches!(relation, Relation::TangentToDrive | Relation::TangentToPart)
}

//! One check surface as it is watched along a path: on which side of its relation the tool is, since when, and how far it has been there.

use apt_geometry::{Vec3, motion::Relation};

use crate::role::Working;

/// Where the tool stands to a check surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Status {
    /// In the band since the start: no position yet.
    Touching,
    /// Clear of it; for ON: on the positive side.
    Clear,
    /// Cutting into it; for ON: on the negative side.
    Inside,
}

/// One check surface being watched.
#[derive(Debug, Clone, Copy)]
pub(super) struct Watch {
    pub(super) status: Status,
    /// How far the function has been from zero since that began and where, and the side on which the tool was clear then, before or after.
    pub(super) farthest: f64,
    pub(super) farthest_at: Vec3,
    pub(super) clear_on: f64,
    pub(super) count: u32,
    /// It was asked of a place whether it is a position before which the tool is no farther in the check surface, or out of it, than vectors may be elsewhere
    /// in their bands.
    pub(super) is_shallow: bool,
    /// A position and the radius around it in which nothing happens.
    pub(super) quiet: (Vec3, f64),
    /// In its band the path was still coming nearer at the end of the last vector.
    pub(super) falling: bool,
}

/// What was before the function changes its sign.
#[derive(Debug, Clone, Copy)]
pub(super) struct Before {
    /// How far the tool was in the check surface, or out of it.
    pub(super) depth: f64,
    /// Where that was.
    pub(super) place: Vec3,
    /// Whether it comes out of the surface now.
    pub(super) comes_out: bool,
}

impl Watch {
    /// How far the tool was in the check surface, or out of it, both from where motions end and from where the tool just touches, if what changes its sign
    /// does so back again on the side from which it came; for ON how far the tool end was beyond it.
    pub(super) fn depth(&self, working: &Working, (label, side): (Relation, f64)) -> Option<f64> {
        let rest = match label {
            Relation::On => 0.0,
            Relation::Past => working.rest(),
            _ => -working.rest(),
        };
        let comes_back = working.gauge.on || side == self.clear_on;
        comes_back.then(|| (self.farthest - rest.max(0.0)).max(0.0))
    }

    /// Notes the next sample, the first one after a change or one more.
    pub(super) fn go_on(&mut self, changes: bool, (value, side): (f64, f64), tip: &Vec3) {
        if changes {
            (self.farthest, self.clear_on) = (0.0, side);
        }
        if value.abs() >= self.farthest {
            (self.farthest, self.farthest_at) = (value.abs(), *tip);
        }
    }
}

/// Follows the sign; the relation that is reached when it changes.
pub(super) fn transition(status: &mut Status, value: f64, band: f64, on: bool) -> Option<Relation> {
    let now = if value > 0.0 { Status::Clear } else { Status::Inside };
    match (*status, now) {
        (Status::Touching, _) if value.abs() <= band => None,
        (Status::Touching, _) => {
            *status = now;
            None
        }
        (Status::Clear, Status::Inside) => {
            *status = now;
            Some(if on { Relation::On } else { Relation::To })
        }
        (Status::Inside, Status::Clear) => {
            *status = now;
            Some(if on { Relation::On } else { Relation::Past })
        }
        _ => None,
    }
}

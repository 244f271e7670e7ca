//! Paths that come to the end of a surface that does not go on. Vectors are proven from what lies within reach of the tool,
//! so that they become shorter and shorter there; it is told before.

use apt_geometry::Vec3;

use super::{March, Vertex};
use crate::{
    directed::Prepared,
    error::{MotionFailure, RoleName},
};

/// How many times the bands ahead of a place without a way on, or with a very short one, it is looked whether a surface ends.
const AHEAD: f64 = 16.0;
/// Length of such a vector, times the bands.
const CREEPING: f64 = 0.1;
/// Ratio of a vector to the one before below which the way on may be the way to the end of a surface.
const SHRINKING: f64 = 0.5;

/// Where a surface that the tool is guided by ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SurfaceEnd {
    pub(super) role: RoleName,
    pub(super) tip: Vec3,
    pub(super) axis: Vec3,
    pub(super) place: Vec3,
}

impl SurfaceEnd {
    /// The surface whose end the tool touches at a position, if one does.
    pub(super) fn at(prepared: &Prepared, vertex: &Vertex) -> Option<Self> {
        let Vertex { tip, axis, .. } = *vertex;
        let touches = [(&prepared.part, &vertex.part), (&prepared.drive, &vertex.drive)];
        let (role, contact) = touches.into_iter().find(|(r, c)| r.gauge.surface.ends_at(&c.tool))?;
        Some(Self { role: role.name, tip, axis, place: role.gauge.surface.foot(&contact.tool).point })
    }
}

impl March<'_> {
    /// Where vectors become shorter: ends a motion whose path comes to the end of a surface before it meets a check surface.
    /// `here` and `next` are the ends of the last vector.
    pub(super) fn look_for_end(
        &mut self,
        here: &Vertex,
        next: &Vertex,
        cancel: &dyn Fn() -> bool,
    ) -> Result<(), MotionFailure> {
        if !self.has_ends() {
            return Ok(());
        }
        let Prepared { part, drive, .. } = self.prepared;
        let length = (next.tip - here.tip).norm();
        if length <= CREEPING * (part.band() + drive.band())
            && let Some(failure) = self.without_surface(here)
        {
            return Err(failure);
        }
        let earlier = match self.points.len() {
            ..2 => return Ok(()),
            2 => self.prepared.tip,
            count => self.points[count - 3],
        };
        let shrinks = length < SHRINKING * (here.tip - earlier).norm();
        if !shrinks || self.ahead > 0.0 || self.points.len() < self.look_for_end {
            return Ok(());
        }
        self.look_for_end = 2 * self.points.len();
        self.judge_outlook(next, cancel)
    }

    /// Where no vector goes on because a surface ends within reach of the tool: that.
    pub(super) fn without_surface(&self, here: &Vertex) -> Option<MotionFailure> {
        if !self.has_ends() {
            return None;
        }
        let Prepared { tool, part, drive, .. } = self.prepared;
        [AHEAD * (part.band() + drive.band()), tool.radius()].into_iter().find_map(|reach| {
            let ahead = Vertex::at(self.prepared, here.tip + here.tangent * reach, &here.tangent).ok()?;
            SurfaceEnd::at(self.prepared, &ahead).map(|end| self.surface_ends(&end))
        })
    }

    fn has_ends(&self) -> bool {
        let Prepared { part, drive, .. } = self.prepared;
        [part, drive].into_iter().any(|role| role.gauge.surface.has_ends())
    }

    /// The evidence.
    pub(super) fn surface_ends(&self, SurfaceEnd { role, tip, axis, place }: &SurfaceEnd) -> MotionFailure {
        let remaining = Some(self.watcher.remaining(tip, axis)).filter(|distance| distance.is_finite());
        MotionFailure::SurfaceEnds { role: *role, tip: *tip, place: *place, remaining }
    }
}

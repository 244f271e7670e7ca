//! The tool axis along a path: fixed, or a function of the tool end that follows the part or drive surface (TLAXIS with
//! NORMPS, NORMDS, PARLEL and ATANGL, language reference 6.9; PERPTO, TANDS and FAN as later systems have them).
//!
//! The axis depends on the position alone. That makes every clearance a function of the tool end again; its gradient gets
//! a share from the turning tool: a point of the tool at `q` from the tool end moves by `(A × dA) × q`.

use std::borrow::Cow;

use apt_geometry::Vec3;
use nalgebra::{Matrix3, Rotation3};

pub(crate) use self::law::Law;
#[cfg(test)]
pub(crate) use self::law::NORMALS;
use self::{law::Standing, run_in::RunIn};
use crate::{
    clearance::{Contact, Gauge, Tool},
    error::{AxisFailure, MotionFailure},
};

mod law;
mod run_in;
#[cfg(test)]
mod tests;

/// Step of the derivative of the axis, relative to the size of the coordinates.
const DERIVATIVE_STEP: f64 = 1e-5;

/// How the axis is controlled during one motion.
#[derive(Debug, Clone)]
pub(crate) struct Attitude<'a> {
    /// The tool at the start of the motion, all along it if there is no law.
    tool: Tool<'a>,
    law: Option<Law>,
    /// How the axis comes to follow the law, unless the first vector turns it.
    run_in: Option<RunIn>,
}

/// The tool at a position, and how fast its axis turns when the position changes.
pub(crate) struct Posture<'a> {
    pub(crate) tool: Cow<'a, Tool<'a>>,
    rate: Option<Matrix3<f64>>,
}

impl<'a> Attitude<'a> {
    pub(crate) fn fixed(tool: Tool<'a>) -> Self {
        Self { tool, law: None, run_in: None }
    }

    /// An axis that follows a law.
    pub(crate) fn following(tool: &Tool<'a>, law: Law) -> Self {
        Self { tool: tool.clone(), law: Some(law), run_in: None }
    }

    /// The same surfaces with an axis that turns evenly from one position to another, each an axis and a tool end. A fixed
    /// axis stays as it is.
    pub(crate) fn fanned(&self, from: (&Vec3, &Vec3), to: (&Vec3, &Vec3)) -> Result<Self, AxisFailure> {
        let law = self.law.as_ref().map(|law| law.fan(from, to)).transpose()?;
        Ok(Self { tool: self.tool.clone(), law, run_in: None })
    }

    /// The axis with the angle of its law to the other side; none where that hangs on no place.
    pub(crate) fn to_other_side(&self) -> Option<Self> {
        let law = self.law.as_ref()?.to_other_side()?;
        Some(Self { law: Some(law), ..self.clone() })
    }

    /// The same law, to which the axis turns up to a distance from the place where the tool begins.
    pub(crate) fn running_in(&self, origin: &Vec3, length: f64) -> Self {
        Self { run_in: Some(RunIn::new(&self.tool.axis, origin, length)), ..self.clone() }
    }

    /// How far a vector from a position may lead while the axis turns to its law on the way; infinite where it follows the law.
    pub(crate) fn way_to_law(&self, tip: &Vec3) -> f64 {
        self.run_in.as_ref().map_or(f64::INFINITY, |run_in| run_in.way_left(tip))
    }

    /// That the surface which tells the axis ends where it does, if a tool stands to the end of it at a position.
    pub(crate) fn end_of_law(&self, tip: &Vec3) -> Option<MotionFailure> {
        let place = self.law.as_ref()?.end_at(&self.tool, tip)?;
        Some(undetermined(AxisFailure::SurfaceEnds { place }, tip))
    }

    /// The cutter, whatever its axis.
    pub(crate) fn tool(&self) -> &Tool<'a> {
        &self.tool
    }

    /// Whether the axis would have to jump where the path turns from one direction to another, because it leads in the direction of motion.
    pub(crate) fn jumps_between(&self, tip: &Vec3, before: &Vec3, beyond: &Vec3) -> bool {
        self.law.as_ref().is_some_and(|law| law.jumps_between(tip, before, beyond))
    }

    /// The cosine between a line of motion and the direction in which the axis leads, or against which it lags; none where it does neither.
    pub(crate) fn leads_along(&self, tip: &Vec3, line: &Vec3) -> Option<f64> {
        self.law.as_ref().and_then(|law| law.leads_along(tip, line))
    }

    /// True if the axis changes along the path.
    pub(crate) fn turns(&self) -> bool {
        self.law.is_some()
    }

    /// The tool at a position.
    pub(crate) fn tool_at(&self, tip: &Vec3) -> Result<Cow<'_, Tool<'_>>, MotionFailure> {
        match &self.law {
            None => Ok(Cow::Borrowed(&self.tool)),
            Some(law) => self
                .axis(law, tip)
                .map(|axis| Cow::Owned(self.tool.turned(axis)))
                .map_err(|cause| undetermined(cause, tip)),
        }
    }

    fn axis(&self, law: &Law, tip: &Vec3) -> Result<Vec3, AxisFailure> {
        self.brought_in(law.axis(&self.tool, tip)?, tip)
    }

    /// The axis at a place where the law has one.
    fn brought_in(&self, axis: Vec3, tip: &Vec3) -> Result<Vec3, AxisFailure> {
        self.run_in.as_ref().map_or(Ok(axis), |run_in| run_in.axis(&axis, tip))
    }

    /// The tool at a position with the rate of its axis.
    pub(crate) fn posture(&self, tip: &Vec3) -> Result<Posture<'_>, MotionFailure> {
        let Some(law) = &self.law else { return Ok(Posture { tool: Cow::Borrowed(&self.tool), rate: None }) };
        let standing = law.standing(&self.tool, tip).map_err(|cause| undetermined(cause, tip))?;
        let axis = self.brought_in(standing.axis, tip).map_err(|cause| undetermined(cause, tip))?;
        Ok(Posture { tool: Cow::Owned(self.tool.turned(axis)), rate: self.rate(law, tip, &standing) })
    }

    /// Derivatives of the axis by the coordinates of the tool end, as columns; `None` at the brink of the law's domain.
    fn rate(&self, law: &Law, tip: &Vec3, standing: &Standing) -> Option<Matrix3<f64>> {
        if self.run_in.is_none()
            && let Some(rate) = law.rate(&self.tool, tip, standing)
        {
            return Some(rate);
        }
        self.rate_by_differences(law, tip)
    }

    fn rate_by_differences(&self, law: &Law, tip: &Vec3) -> Option<Matrix3<f64>> {
        let step = DERIVATIVE_STEP * crate::position::size(&self.tool, tip);
        let mut columns = [Vec3::zeros(); 3];
        for (k, column) in columns.iter_mut().enumerate() {
            let mut reach = Vec3::zeros();
            reach[k] = step;
            let ahead = self.axis(law, &(tip + reach)).ok()?;
            let behind = self.axis(law, &(tip - reach)).ok()?;
            *column = (ahead - behind) / (2.0 * step);
        }
        Some(Matrix3::from_columns(&columns))
    }
}

impl Posture<'_> {
    /// The contact with a surface; the gradient takes the turning of the axis into account and is then no unit vector.
    pub(crate) fn contact(&self, gauge: &Gauge, tip: &Vec3) -> Contact {
        let mut contact = gauge.contact(&self.tool, tip);
        self.follow_law(gauge, tip, &mut contact);
        contact
    }

    /// The same as it is found without proof, for a place that is only passed through.
    pub(crate) fn contact_passing(&self, gauge: &Gauge, tip: &Vec3) -> Contact {
        let mut contact = gauge.contact_passing(&self.tool, tip);
        self.follow_law(gauge, tip, &mut contact);
        contact
    }

    /// [`Gauge::contact_passing_followed`] with the gradient of the law.
    pub(crate) fn contact_passing_followed(&self, gauge: &Gauge, tip: &Vec3) -> (Contact, bool) {
        let mut found = gauge.contact_passing_followed(&self.tool, tip);
        self.follow_law(gauge, tip, &mut found.0);
        found
    }

    /// The contact where the last one leads, and whether it is known to be the nearest.
    pub(crate) fn contact_followed(&self, gauge: &Gauge, tip: &Vec3) -> (Contact, bool) {
        let mut found = gauge.contact_followed(&self.tool, tip);
        self.follow_law(gauge, tip, &mut found.0);
        found
    }

    /// Lets the gradient of what a tool that keeps its axis touches follow the law of the axis.
    pub(crate) fn follow_law(&self, gauge: &Gauge, tip: &Vec3, contact: &mut Contact) {
        if let Some(rate) = &self.rate
            && !gauge.on
        {
            let arm = contact.tool - tip;
            contact.gradient += rate.transpose() * arm.cross(&contact.gradient).cross(&self.tool.axis);
        }
    }
}

fn undetermined(cause: AxisFailure, tip: &Vec3) -> MotionFailure {
    MotionFailure::AxisUndetermined { cause, tip: *tip }
}

/// A straight move of the tool end during which the axis turns evenly in the plane of its ends: what a machine does
/// between two positions, and what the verifier assumes.
pub(crate) struct Sweep<'a> {
    tool: &'a Tool<'a>,
    from: Vec3,
    /// Unit direction; zero for a move without length.
    pub(crate) direction: Vec3,
    pub(crate) length: f64,
    axis: Vec3,
    /// Whether it begins with the axis that the tool was given.
    is_as_given: bool,
    /// Unit vector about which the axis turns, and by which angle.
    turn: Option<(Vec3, f64)>,
}

/// Sine between two axes below which the tool does not turn.
const NO_TURN: f64 = 1e-14;

impl<'a> Sweep<'a> {
    /// From one tool end and axis to another.
    pub(crate) fn new(tool: &'a Tool<'a>, from: (&Vec3, &Vec3), to: (&Vec3, &Vec3)) -> Self {
        let delta = to.0 - from.0;
        let length = delta.norm();
        let direction = if length > 0.0 { delta / length } else { Vec3::zeros() };
        let normal = from.1.cross(to.1);
        let sine = normal.norm();
        let turn = (sine > NO_TURN).then(|| (normal / sine, sine.atan2(from.1.dot(to.1))));
        let is_as_given = tool.has_axis(from.1);
        Self { tool, from: *from.0, direction, length, axis: *from.1, is_as_given, turn }
    }

    /// The tool, with the axis that it was given.
    pub(crate) fn tool(&self) -> &Tool<'a> {
        self.tool
    }

    pub(crate) fn turns(&self) -> bool {
        self.turn.is_some()
    }

    /// The tool end and the tool at a distance from the start.
    pub(crate) fn at(&self, x: f64) -> (Vec3, Cow<'_, Tool<'_>>) {
        let tip = self.from + self.direction * x;
        match self.turn {
            None if self.is_as_given => (tip, Cow::Borrowed(self.tool)),
            None => (tip, Cow::Owned(self.tool.turned(self.axis))),
            Some((about, angle)) => {
                let share = if self.length > 0.0 { x / self.length } else { 1.0 };
                let (sin, cos) = (angle * share).sin_cos();
                let axis = (self.axis * cos + about.cross(&self.axis) * sin).normalize();
                (tip, Cow::Owned(self.tool.turned(axis)))
            }
        }
    }

    /// The vector about which the tool turns, by its length per unit of distance.
    pub(crate) fn rate(&self) -> Vec3 {
        match self.turn {
            Some((about, angle)) if self.length > 0.0 => about * (angle / self.length),
            _ => Vec3::zeros(),
        }
    }

    /// Where a point of the tool comes to be, from one distance from the start to another.
    pub(crate) fn carried(&self, point: &Vec3, from: f64, to: f64) -> Vec3 {
        let arm = point - self.from - self.direction * from;
        let turned = Rotation3::from_scaled_axis(self.rate() * (to - from)) * arm;
        self.from + self.direction * to + turned
    }

    /// How fast a clearance changes per unit of distance.
    pub(crate) fn slope(&self, contact: &Contact, tip: &Vec3) -> f64 {
        let straight = contact.gradient.dot(&self.direction);
        match self.turn {
            Some((about, angle)) if self.length > 0.0 => {
                straight + about.dot(&(contact.tool - tip).cross(&contact.gradient)) * angle / self.length
            }
            _ => straight,
        }
    }

    /// Greatest acceleration of a point within `reach` of the tool end, per square of the distance of the tool end.
    pub(crate) fn swing(&self, reach: f64) -> f64 {
        match self.turn {
            Some((_, angle)) if self.length > 0.0 => {
                let rate = angle / self.length;
                rate * rate * reach
            }
            _ => 0.0,
        }
    }

    /// Greatest distance that a point within `reach` of the tool end moves per unit of distance of the tool end.
    pub(crate) fn stretch(&self, reach: f64) -> f64 {
        match self.turn {
            Some((_, angle)) if self.length > 0.0 => 1.0 + angle * reach / self.length,
            _ => 1.0,
        }
    }
}

//! A tool location for a point of the guide: contact, axis, tool end (TULPOS, sculptured surfaces reference 3.38).

use apt_geometry::{
    Vec3,
    regional::{AxisCondition, AxisReference, FeedDirection, GuideContact, PartRelation},
};

use super::{Job, step::Band};
use crate::{
    contact::{Contact, Place, RollingBall},
    error::StationError,
    guide::GuidePoint,
    tool::Pose,
};

/// A direction and a sense along the guide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Course {
    pub(super) direction: FeedDirection,
    /// +1 where the running parameter grows.
    pub(super) sign: f64,
    /// Stock under the tool: THICK, and the lift of a step over.
    pub(super) stock: f64,
}

/// A tool location with what led to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Station {
    /// Global parameters of the guide.
    pub(super) parameters: [f64; 2],
    pub(super) guide: GuidePoint,
    pub(super) contact: Contact,
    pub(super) pose: Pose,
    /// Where the ball of the corner stands, tolerance not counted.
    pub(super) center: Vec3,
    /// Curvature of the part surface along the path, positive where concave.
    pub(super) curvature: f64,
    /// Stock and tolerance between surface and tool.
    pub(super) offset: f64,
    /// Unit direction across the axis from the contact to it.
    pub(super) sideways: Vec3,
}

impl Station {
    /// The value of the running parameter.
    pub(super) fn running(&self, direction: FeedDirection) -> f64 {
        match direction {
            FeedDirection::Spline => self.parameters[0],
            FeedDirection::CrossSpline => self.parameters[1],
        }
    }
}

impl Job<'_> {
    /// Radius of the ball that rolls down to the part surface.
    pub(super) fn ball_radius(&self, stock: f64) -> f64 {
        match (self.command.guide.contact, self.command.part.relation) {
            (GuideContact::At, _) => 0.0,
            (GuideContact::On, PartRelation::On) => stock,
            (GuideContact::On, PartRelation::To) => self.tool.corner_radius() + stock,
        }
    }

    /// The tool location at global parameters of the guide. The search of the contact starts at that of `from`.
    pub(super) fn station(
        &self,
        parameters: [f64; 2],
        course: &Course,
        from: Option<&Station>,
    ) -> Result<Station, StationError> {
        let guide = self.guide.at(parameters, course.direction)?;
        let forward = guide.forward * course.sign;
        let (contact, axis) = self.contact_and_axis(parameters, &guide, &forward, course.stock, from)?;
        let curvature = match contact.on_crease {
            true => -1.0 / (EDGE_RADIUS * (self.tool.corner_radius() + course.stock)),
            false => contact.curvature().along(&guide.forward),
        };
        let band = Band::new(self.setting.inside, self.setting.outside);
        let offset = course.stock + band.offset(curvature, self.setting.maximum_step.min(self.size));
        let sideways = from.map_or(-forward, |from| from.sideways);
        let end = match self.command.part.relation {
            PartRelation::To => {
                self.tool.end_at_contact(&contact.at.position, &contact.normal, &axis, offset, &sideways)?
            }
            PartRelation::On => contact.at.position + contact.normal * offset,
        };
        let across = contact.normal - axis * contact.normal.dot(&axis);
        Ok(Station {
            parameters,
            guide,
            contact,
            pose: Pose { end, axis },
            center: contact.at.position + contact.normal * (self.tool.corner_radius() + course.stock),
            curvature,
            offset,
            sideways: across.try_normalize(SIDEWAYS_SINE).unwrap_or(sideways),
        })
    }

    /// The contact and the axis there. What stands on the projection line is the tool end under the centre of the corner
    /// (ON) or the contact (AT), so that the one takes part in the other.
    fn contact_and_axis(
        &self,
        parameters: [f64; 2],
        guide: &GuidePoint,
        forward: &Vec3,
        stock: f64,
        from: Option<&Station>,
    ) -> Result<(Contact, Vec3), StationError> {
        let drop = match (self.command.guide.contact, self.command.part.relation) {
            (GuideContact::On, PartRelation::To) => self.tool.corner_height(),
            _ => 0.0,
        };
        let ball = |axis: &Vec3| RollingBall {
            radius: self.ball_radius(stock),
            origin: guide.position,
            direction: guide.projection,
            side: self.command.part.side.sign(),
            shift: -axis * drop,
            patience: self.waiting.patience(),
        };
        let AxisCondition::AtAngle { reference: AxisReference::Part, .. } = self.command.axis else {
            let contact = self.contact(&ball(&self.axis_of_drop(guide)?), parameters, from)?;
            return Ok((contact, self.axis(guide, &contact.normal, forward)?));
        };
        // The axis depends on the normal at the contact. The first drop of all is one with a vertical axis, as in the public
        // system; after it both are found together.
        let Some(from) = from else {
            let contact = self.contact(&ball(&Vec3::z()), parameters, None)?;
            return Ok((contact, self.axis(guide, &contact.normal, forward)?));
        };
        let (mut axis, mut place) = (from.pose.axis, from.contact.place);
        for _ in 0..MOST_ROUNDS {
            let contact = ball(&axis).contact_on(&self.part, place)?;
            let next = self.axis(guide, &contact.normal, forward)?;
            if (next - axis).norm() <= AXIS_SETTLED {
                return Ok((contact, next));
            }
            (axis, place) = (next, contact.place);
        }
        Err(StationError::NoAxis)
    }

    /// The axis that stands on the guide alone, before the lead.
    fn axis_of_drop(&self, guide: &GuidePoint) -> Result<Vec3, StationError> {
        let axis = match self.command.axis {
            AxisCondition::Fixed(vector) => vector,
            AxisCondition::GuideNormal(sense) => guide.normal * sense.sign(),
            AxisCondition::AtAngle { across, .. } => leaning(guide, across),
        };
        axis.try_normalize(0.0).ok_or(StationError::NoAxis)
    }

    fn contact(
        &self,
        ball: &RollingBall,
        parameters: [f64; 2],
        from: Option<&Station>,
    ) -> Result<Contact, StationError> {
        let surface = self.part.surface();
        if let Some(from) = from {
            return Ok(ball.contact_on(&self.part, from.contact.place)?);
        }
        if self.part_is_guide
            && let Some((patch, u, v)) = surface.locate(parameters[0], parameters[1])
            && let Ok(contact) = ball.contact_on(&self.part, Place { patch, parameters: [u, v] })
        {
            return Ok(contact);
        }
        Ok(ball.first_contact(&self.part)?)
    }

    /// The unit tool axis (SCON/AXIS).
    fn axis(&self, guide: &GuidePoint, normal: &Vec3, forward: &Vec3) -> Result<Vec3, StationError> {
        let axis = match self.command.axis {
            AxisCondition::Fixed(vector) => vector,
            AxisCondition::GuideNormal(sense) => guide.normal * sense.sign(),
            AxisCondition::AtAngle { reference: AxisReference::Guide, across: alpha, lead } => {
                leaning(guide, alpha) * lead.cos() + forward * lead.sin()
            }
            AxisCondition::AtAngle { reference: AxisReference::Part, across: alpha, lead } => {
                // The sense of the pitch is that of the public system: it follows the projection.
                let pitch = normal.cross(&forward.cross(&guide.projection));
                let pitch = pitch.try_normalize(0.0).ok_or(StationError::NoAxis)?;
                let roll = normal.cross(&pitch);
                let sense = if roll.dot(&guide.sideways) < 0.0 { -1.0 } else { 1.0 };
                normal * (alpha.cos() * lead.cos())
                    + pitch * lead.sin()
                    + roll * (sense * alpha.sin() * lead.cos())
            }
        };
        axis.try_normalize(0.0).ok_or(StationError::NoAxis)
    }
}

/// The normal of the guide turned towards the cross direction.
fn leaning(guide: &GuidePoint, angle: f64) -> Vec3 {
    guide.normal * angle.cos() + guide.sideways * angle.sin()
}

/// Radius of an edge on which the ball turns, as a share of that of the ball.
const EDGE_RADIUS: f64 = 1e-6;
/// Most rounds in which contact and axis settle.
const MOST_ROUNDS: usize = 40;
/// Change of the unit axis that is none: angles of one part in a hundred million move no tool by any tolerance.
const AXIS_SETTLED: f64 = 1e-9;
/// Sine of the angle between normal and axis below which the last side of the contact is kept.
const SIDEWAYS_SINE: f64 = 1e-9;

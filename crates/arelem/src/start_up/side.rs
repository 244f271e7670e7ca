//! Which side of each surface the tool ends on: that of the observer half way up the tool for TO and ON, the other one
//! for PAST; SRFVCT decides where it is given. For TANTO it is the side on which the tangency is found.

use apt_geometry::{Vec3, motion::Relation};

use super::StartUp;
use crate::{
    directed::is_tangent,
    error::{MotionFailure, RoleName},
    position,
};

/// An observer nearer to the surface than this, relative to the size of the coordinates, does not tell the side.
const UNDECIDED: f64 = 1e-9;

/// Sets the side of every role, seen from `tip` (the start itself if none).
pub(super) fn assign(work: &mut StartUp<'_>, tip: Option<Vec3>) -> Result<(), MotionFailure> {
    let tip = tip.unwrap_or(work.tip);
    let size = position::size(&work.tool, &tip);
    let vectors = work.state.surface_vectors;
    for role in &mut work.roles {
        let given = match role.name {
            RoleName::Drive => vectors[0],
            RoleName::Part => vectors[1],
            RoleName::Check(_) => vectors[2],
        };
        let past = if role.relation == Relation::Past { -1.0 } else { 1.0 };
        let towards_past = given.map(|v| role.gauge.surface.foot(&tip).normal.dot(&v) / v.norm());
        let side = match towards_past {
            // The vector points from the TO side to the PAST side.
            Some(cosine) if cosine.abs() > UNDECIDED => -cosine.signum() * past,
            _ => {
                let distance = work.tool.observed(&role.gauge.surface, &tip);
                if distance.abs() > UNDECIDED * size {
                    distance.signum() * past
                } else if role.relation == Relation::On || is_tangent(role.relation) {
                    1.0
                } else {
                    return Err(MotionFailure::SideUnknown { role: role.name, distance });
                }
            }
        };
        role.set_side(side);
        role.look_from(&tip);
    }
    Ok(())
}

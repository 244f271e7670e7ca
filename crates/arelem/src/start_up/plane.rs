//! The two-dimensional start-up route: exact positions in closed form for a vertical tool, a drive surface that is a
//! vertical plane or circle, and a part surface that is a plane.

use apt_geometry::{Vec3, motion::Relation, surface::Surface};

use super::{StartUp, directed::unit_direction, side};
use crate::{
    error::{MotionFailure, RoleName},
    plane_curve::Curve,
    role::Working,
};

/// |cos| between part plane normal and tool axis above which the part plane fixes the height.
const LEAST_PART_COSINE: f64 = 0.02;
/// |cos| of the tool axis to z above which the tool is vertical.
const VERTICAL: f64 = 0.99995;

/// The end position, or `None` if the route does not apply.
pub(super) fn solve(work: &mut StartUp<'_>) -> Result<Option<Vec3>, MotionFailure> {
    let Some(curve) = eligible(work) else { return Ok(None) };
    let direction = match &work.state.directions[0] {
        Some(direction) => Some(unit_direction(direction, &work.tip)?),
        None => None,
    };
    side::assign(work, None).or_else(|error| match error {
        // The direction tells the side of the drive surface, as far as the tool is not on it.
        MotionFailure::SideUnknown { role: RoleName::Drive, .. } if direction.is_some() => Ok(()),
        other => Err(other),
    })?;
    let tip = match direction {
        Some(direction) => along(work, &curve, &direction)?,
        None => match nearest(work, &curve)? {
            Nearest::One(tip) => tip,
            Nearest::Several(places) => {
                let places = places.map(|place| on_part(work, &place));
                return Err(MotionFailure::StartUpAmbiguous { places });
            }
        },
    };
    Ok(Some(on_part(work, &tip)))
}

/// The nearest positions to the drive surface.
enum Nearest {
    One(Vec3),
    /// Around the centre of a circle: two of them.
    Several([Vec3; 2]),
}

/// True if the route applies.
pub(super) fn applies(work: &StartUp<'_>) -> bool {
    eligible(work).is_some()
}

fn eligible(work: &StartUp<'_>) -> Option<Curve> {
    if work.roles.len() != 2 && !(work.roles.len() == 1 && work.state.no_part) {
        return None;
    }
    let state = work.state;
    let axis = work.tool.axis;
    let plain = axis.z.abs() >= VERTICAL
        && work.roles.iter().all(|role| role.gauge.disk.is_none())
        && !super::is_following(work)
        && work.tool.cutter.beta == 0.0
        && !state.force_iteration
        && state.surface_vectors.iter().all(Option::is_none)
        && state.directions[1..].iter().all(Option::is_none);
    if !plain {
        return None;
    }
    if let Some(part) = work.roles.get(1) {
        let Surface::Plane(plane) = &part.gauge.surface else { return None };
        let cosine = plane.normal.dot(&axis).abs();
        if cosine <= LEAST_PART_COSINE || part.gauge.thickness != 0.0 || part.relation == Relation::Past {
            return None;
        }
    }
    Curve::of(&work.roles[0].gauge.surface, &axis)
}

/// Signed distance from the drive surface at which the tool end stands.
fn stand_off(work: &StartUp<'_>, drive: &Working) -> f64 {
    if drive.gauge.on { 0.0 } else { drive.gauge.side * (work.tool.radius() + drive.gauge.thickness) }
}

fn nearest(work: &StartUp<'_>, curve: &Curve) -> Result<Nearest, MotionFailure> {
    let drive = &work.roles[0];
    let off = stand_off(work, drive);
    match curve {
        Curve::Line { normal, distance } => {
            Ok(Nearest::One(work.tip - normal * (normal.dot(&work.tip) - distance - off)))
        }
        Curve::Circle { center, radius } => {
            let wanted = radius + off;
            if wanted < 0.0 {
                return Err(MotionFailure::ToolTooLarge { tool: work.tool.radius(), circle: *radius });
            }
            let (_, across, radial) = work.tool.split(&(work.tip - center));
            if across <= 1e-12 * radius {
                return Ok(Nearest::Several([wanted, -wanted].map(|way| work.tip + radial * way)));
            }
            Ok(Nearest::One(work.tip + radial * (wanted - across)))
        }
    }
}

/// The first position along the direction with the relation asked for: over it, where a part surface fixes the height.
fn along(work: &mut StartUp<'_>, curve: &Curve, direction: &Vec3) -> Result<Vec3, MotionFailure> {
    let axis = work.tool.axis;
    let flat = direction - axis * direction.dot(&axis);
    let Some(flat) = flat.try_normalize(1e-9) else {
        return Err(MotionFailure::NotReachedAlong {
            role: RoleName::Drive,
            from: work.tip,
            direction: *direction,
        });
    };
    // Without a part surface that fixes the height (NOPS) the tool moves exactly along the direction, up or down as that leads.
    let way = if work.roles.len() == 1 { direction / direction.dot(&flat) } else { flat };
    let relation = work.roles[0].relation;
    let reach = work.tool.radius() + work.roles[0].gauge.thickness;
    let levels: &[f64] = if relation == Relation::On { &[0.0] } else { &[reach, -reach] };
    let mut candidates: Vec<(f64, f64)> = Vec::new();
    for &level in levels {
        candidates
            .extend(curve.line_crossings(&work.tip, &flat, level, &axis).into_iter().map(|x| (x, level)));
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    if candidates.is_empty() {
        let (from, narrow) = (work.tip, None);
        return Err(MotionFailure::NoPositionAlong { relation, from, direction: flat, found: 0, narrow });
    }
    let found = candidates.len();
    let start = curve.signed_distance(&work.tip, &axis);
    let clear = start.abs() > reach;
    let mut label = if clear { Relation::To } else { Relation::Past };
    for (x, level) in candidates.into_iter().filter(|(x, _)| *x > 0.0) {
        if relation == Relation::On || label == relation {
            if level != 0.0 {
                work.roles[0].set_side(level.signum());
            }
            return Ok(work.tip + way * x);
        }
        label = if label == Relation::To { Relation::Past } else { Relation::To };
    }
    let narrow = match curve {
        Curve::Circle { radius, .. } if start < 0.0 && reach > *radius => Some([work.tool.radius(), *radius]),
        _ => None,
    };
    Err(MotionFailure::NoPositionAlong { relation, from: work.tip, direction: flat, found, narrow })
}

/// Along the tool axis to the part plane, if there is one.
fn on_part(work: &StartUp<'_>, tip: &Vec3) -> Vec3 {
    let Some(part) = work.roles.get(1) else { return *tip };
    let contact = part.gauge.contact(&work.tool, tip);
    let cosine = contact.gradient.dot(&work.tool.axis);
    tip - work.tool.axis * (contact.clearance / cosine)
}

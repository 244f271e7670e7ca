//! What two measures of clearance say all along a cut vector that is not proven: those of engine and verifier, each place
//! read by itself.

use apt_geometry::{
    motion::{DriveSide, Relation},
    surface::Surface,
};
use arelem::{
    clearance::{Gauge, Memory, Tool},
    sequence::{CutSequence, Role, ToolPosition},
    verify::{Rule, Violation, verify},
};

/// Places on a vector.
const PLACES: u32 = 64;

/// Least and greatest clearance on the vector of a violation, by the engine and by the verifier, and where they differ most.
pub(crate) fn told(sequence: &CutSequence, violation: &Violation) -> Option<String> {
    let role = match violation.rule {
        Rule::PartBand => sequence.part.as_ref()?,
        Rule::DriveBand => sequence.drive.as_ref()?,
        _ => return None,
    };
    let ends = |k: usize| if k == 0 { Some(&sequence.start) } else { sequence.points.get(k - 1) };
    let (from, to) = (ends(violation.vector)?, ends(violation.vector + 1)?);
    let gauge = gauge(role)?;
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let mut apart = (0.0, 0.0);
    for k in 0..=PLACES {
        let share = f64::from(k) / f64::from(PLACES);
        let tip = from.tip.lerp(&to.tip, share);
        let axis = from.axis.lerp(&to.axis, share).normalize();
        let tool = Tool::new(sequence.cutter, axis);
        let read = [
            Gauge { memory: Memory::default(), ..gauge.clone() }.contact(&tool, &tip).clearance,
            verified(sequence, role, &ToolPosition { tip, axis })?,
        ];
        for (range, value) in ranges.iter_mut().zip(read) {
            *range = [range[0].min(value), range[1].max(value)];
        }
        if (read[0] - read[1]).abs() > f64::abs(apart.0) {
            apart = (read[0] - read[1], share);
        }
    }
    Some(format!(
        "engine {:?}, verifier {:?}, apart by {:e} at {} of the vector, band {:?} on {} side {}",
        ranges[0],
        ranges[1],
        apart.0,
        apart.1,
        [-role.inside_tolerance, role.outside_tolerance],
        gauge.on,
        role.side
    ))
}

fn gauge(role: &Role) -> Option<Gauge> {
    let on = role.relation == Relation::On;
    Some(Gauge {
        surface: Surface::from_geometry(&role.surface.geometry).ok()?,
        on,
        side: role.side,
        thickness: if on { 0.0 } else { role.thickness },
        disk: role.disk,
        memory: Memory::default(),
    })
}

/// The clearance that the verifier reads at one place.
fn verified(sequence: &CutSequence, role: &Role, place: &ToolPosition) -> Option<f64> {
    let alone = CutSequence {
        start: *place,
        points: vec![*place],
        cutter: sequence.cutter,
        part: Some(role.clone()),
        drive: None,
        stop: None,
        drive_side: DriveSide::On,
        start_up: true,
        forward: sequence.forward,
        maximum_step: sequence.maximum_step,
        minimum: None,
    };
    Some(verify(&alone, &|| false).ok()?.part?.min)
}

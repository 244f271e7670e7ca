//! Before a directed motion (AREPRE): start check, forward direction, turn, line of motion and its sense.

use apt_geometry::{
    Vec3,
    motion::{CheckSurface, DriveSide, NamedSurface, PartSide, Relation, Turn},
    patience::Patience,
};

use crate::{
    attitude::{Attitude, Law},
    clearance::{Contact, Shape, Tool},
    error::{ContactPoints, MotionFailure, MotionWarning, RoleName},
    position,
    role::Working,
    section2::{State, required_position},
};

/// A motion within this angle of a right angle to the direction asked for has no sense (2°).
pub(super) const UNDETERMINED: f64 = 0.0349;
/// Sine between part and drive normal below which there is no line of motion.
pub(super) const TANGENT_SINE: f64 = 1e-6;
/// Sine to the tool axis up to which the last move is parallel to it and says nothing about the forward direction. Positions
/// are good to some 1e-9 of the size of what is machined, and moves are rarely shorter than a thousandth of that.
const PARALLEL_SINE: f64 = 1e-6;
/// Distance between unit axes below which they are the same.
const SAME_AXIS: f64 = 1e-12;
/// How many times the width of the bands ahead of the start it is looked for another contact.
const CORNER_AHEAD: f64 = 0.25;
/// Sine between the normals of two contacts above which they are not the same one.
const OTHER_CONTACT_SINE: f64 = 0.05;
/// Sine below which the side of the drive surface is not judged.
const SIDE_SINE: f64 = 0.05;

/// Part, drive and the first check surface: others are ways to go on.
const TOLD_ROLES: usize = 3;

/// A directed motion ready to go.
#[derive(Debug, Clone)]
pub(crate) struct Prepared<'a> {
    /// The tool as it stands at the start.
    pub(crate) tool: Tool<'a>,
    /// How its axis goes on from there.
    pub(crate) attitude: Attitude<'a>,
    pub(crate) tip: Vec3,
    pub(crate) part: Working,
    pub(crate) drive: Working,
    /// The check surfaces; their sides are settled when they are met.
    pub(crate) checks: Vec<Working>,
    /// Unit tangent of the path in the sense of motion.
    pub(crate) tangent: Vec3,
    /// Unit gradients of the clearances from part and drive surface between which a tool that keeps its axis sets out: in a corner those of the places
    /// that it touches along the path, not of those that it leaves.
    pub(super) followed: [Vec3; 2],
    /// The same line for a tool that keeps its axis, and the direction asked for.
    standing: Vec3,
    wanted: Vec3,
    /// Size of the coordinates, for rounding.
    pub(crate) size: f64,
    /// Where the tool is along the drive surface: what the program says, unless it is plainly on the other side.
    pub(crate) drive_side: DriveSide,
    /// A place to end at, if the tool is in all bands there.
    pub(super) aim: Option<Vec3>,
}

pub(super) fn prepare<'a>(
    state: &State,
    turn: Turn,
    drive: &NamedSurface,
    checks: &[CheckSurface],
    warnings: &mut Vec<MotionWarning>,
    patience: Patience<'a>,
) -> Result<Prepared<'a>, MotionFailure> {
    let cutter = state.cutter.ok_or(MotionFailure::NoCutter { start_up: false })?;
    let position = required_position(state)?;
    let (tool, tip) = (Tool::awaited(cutter, position.axis, patience), position.tip);
    let size = position::size(&tool, &tip);
    let [mut part, mut drive] = with_bands(state, drive, patience)?;
    let part_contact = start_check(&tool, &mut part, (&tip, state.side_of_part), size)?;
    // A direction that is not defined is the plainer mistake: it is named before a drive surface out of reach.
    let checked = start_check(&tool, &mut drive, (&tip, None), size);
    let drive_contact =
        checked.as_ref().map_or_else(|_| drive.gauge.contact(&tool, &tip), |contact| *contact);
    let wanted = turned(state, &tip, turn, warnings)?;
    let contacts = [part_contact, drive_contact];
    let corner = Corner { tool: &tool, tip, roles: [&part, &drive], contacts, size };
    let (mut tangent, mut followed) = corner.line(state, &wanted)?;
    checked?;
    if let Some((other, contact, along)) = corner.on_the_told_side(state, (&tangent, &followed[1]), &wanted) {
        (drive, tangent, followed) = (other, along, [part_contact, contact]);
    }
    let contacts = [part_contact, followed[1]];
    let corner = Corner { tool: &tool, tip, roles: [&part, &drive], contacts, size };
    if let Some(out) = corner.way_out(&tangent, &wanted) {
        (tangent, followed) = out;
    }
    let attitude = attitude(state, &tool, (&part, &drive), &tip, &wanted)?;
    let standing = tangent;
    tangent = line_of_turning(&attitude, [&part, &drive], &tip, (&standing, &wanted)).unwrap_or(standing);
    leads_along(&attitude, &tip, (&tangent, &wanted))?;
    let drive_side = judge_side(state, &tool, &followed[1], &tangent, warnings);
    let checks = working_checks(state, checks, patience)?;
    warn_of_surface_twice([&part, &drive].into_iter().chain(&checks), warnings);
    if attitude.turns() {
        part.turn_freely(&tip);
        drive.turn_freely(&tip);
    }
    Ok(Prepared {
        tool,
        attitude,
        tip,
        part,
        drive,
        checks,
        tangent,
        followed: followed.map(|contact| contact.gradient),
        standing,
        wanted,
        size,
        drive_side,
        aim: None,
    })
}

/// Part and drive surface, with their bands.
fn with_bands(
    state: &State,
    drive: &NamedSurface,
    patience: Patience<'_>,
) -> Result<[Working; 2], MotionFailure> {
    let part_on = state.part_side == PartSide::On;
    let drive_on = state.drive_side == DriveSide::On;
    let relation = |on: bool| if on { Relation::On } else { Relation::To };
    let part = Working::new(state, RoleName::Part, &state.part, relation(part_on), part_on, patience)?;
    let drive = Working::new(state, RoleName::Drive, drive, relation(drive_on), drive_on, patience)?;
    for role in [&part, &drive] {
        has_band(role)?;
    }
    Ok([part, drive])
}

/// Without a tolerance no cut vector is in it.
fn has_band(role: &Working) -> Result<(), MotionFailure> {
    let Working { name, inside, outside, .. } = *role;
    if role.band() > 0.0 { Ok(()) } else { Err(MotionFailure::NoTolerance { role: name, inside, outside }) }
}

/// The check surfaces at work.
fn working_checks(
    state: &State,
    checks: &[CheckSurface],
    patience: Patience<'_>,
) -> Result<Vec<Working>, MotionFailure> {
    let working = |(index, check): (usize, &CheckSurface)| {
        let relation = check.relation;
        let on = relation == Relation::On || (super::is_tangent(relation) && tangent_on(check, state));
        Working::new(state, RoleName::Check(index), &check.surface, relation, on, patience)
    };
    checks.iter().enumerate().map(working).collect()
}

impl<'a> Prepared<'a> {
    /// The same motion, to end at a place if it can.
    pub(super) fn aimed_at(self, place: Vec3) -> Self {
        Self { aim: Some(place), ..self }
    }

    /// On which hands a tool that keeps its axis has part and drive surface where it sets out: positive if the line of motion leads along the cross product of
    /// their gradients.
    pub(super) fn hand(&self) -> f64 {
        let [part, drive] = &self.followed;
        part.cross(drive).dot(&self.standing)
    }

    /// The same motion with another way of the axis.
    pub(super) fn with(&self, attitude: Attitude<'a>) -> Self {
        let lines = (&self.standing, &self.wanted);
        let line = line_of_turning(&attitude, [&self.part, &self.drive], &self.tip, lines);
        let tangent = line.unwrap_or(self.standing);
        // The way on which the tool turns leads its line aside; where that comes to lie across the direction asked for, the side of the drive surface
        // tells more of its sense.
        let is_against = misplaced(self.drive_side, &self.tool, &self.followed[1], &tangent)
            .is_some_and(|(sine, _)| sine.abs() > tangent.dot(&self.wanted).abs());
        Self { tangent: if is_against { -tangent } else { tangent }, attitude, ..self.clone() }
    }
}

/// The axis along the motion: fixed if it is everywhere what it is now.
fn attitude<'a>(
    state: &State,
    tool: &Tool<'a>,
    (part, drive): (&Working, &Working),
    tip: &Vec3,
    wanted: &Vec3,
) -> Result<Attitude<'a>, MotionFailure> {
    let law = Law::new(&state.axis_mode, Some(part), Some(drive), (tool, tip, wanted))
        .map_err(|cause| MotionFailure::AxisUndetermined { cause, tip: *tip })?;
    let Some(law) = law else { return Ok(Attitude::fixed(tool.clone())) };
    let constant = law.is_constant();
    let axis = law.axis(tool, tip).map_err(|cause| MotionFailure::AxisUndetermined { cause, tip: *tip })?;
    if constant && (axis - tool.axis).norm() <= SAME_AXIS {
        return Ok(Attitude::fixed(tool.clone()));
    }
    Ok(Attitude::following(tool, law))
}

/// At a tangency the tool stands to the check surface as it does to the surface it is tangent to.
fn tangent_on(check: &CheckSurface, state: &State) -> bool {
    match check.relation {
        Relation::TangentToPart => state.part_side == PartSide::On,
        _ => state.drive_side == DriveSide::On,
    }
}

/// Operation 1: the tool must be within the band of the surface, on one side or the other; the side is the one where it
/// is, when both would do that where the last motion left it, or that of the observer.
fn start_check(
    tool: &Tool,
    role: &mut Working,
    (tip, last): (&Vec3, Option<f64>),
    size: f64,
) -> Result<Contact, MotionFailure> {
    let observed = || if tool.observed(&role.gauge.surface, tip) < 0.0 { -1.0 } else { 1.0 };
    let preferred = last.unwrap_or_else(observed);
    let mut nearest: Option<(f64, Contact)> = None;
    for side in [preferred, -preferred] {
        role.set_side(side);
        let contact = role.gauge.contact(tool, tip);
        if role.holds(contact.clearance, size) {
            role.look_from(tip);
            return Ok(contact);
        }
        let excess = role.beyond(contact.clearance);
        if nearest.is_none_or(|(least, _)| excess < least) {
            nearest = Some((excess, contact));
        }
    }
    role.set_side(preferred);
    let contact = nearest.map_or_else(|| role.gauge.contact(tool, tip), |(_, contact)| contact);
    Err(MotionFailure::OutOfToleranceAtStart {
        role: role.name,
        clearance: contact.clearance,
        inside: role.inside,
        outside: role.outside,
        contact: ContactPoints { tip: *tip, tool: contact.tool, surface: contact.surface },
    })
}

/// Operations 2 and 3: the direction asked for, from the last move and the motion word.
fn turned(
    state: &State,
    tip: &Vec3,
    turn: Turn,
    warnings: &mut Vec<MotionWarning>,
) -> Result<Vec3, MotionFailure> {
    let axis = state.axis;
    match turn {
        Turn::Up => return Ok(axis),
        Turn::Down => return Ok(-axis),
        _ => {}
    }
    let last = (tip - state.previous).try_normalize(0.0);
    let forward = match last {
        // A steep one says it by what it moves sideways, as when the last vector is short and crosses the band.
        Some(direction) if direction.cross(&axis).norm() > PARALLEL_SINE => {
            if state.is_placed {
                warnings.push(MotionWarning::DirectionFromOrigin { direction });
            }
            direction
        }
        // Programs that come to their first surface along the axis are written for the direction that FROM gave.
        _ => state.forward.ok_or(MotionFailure::NoForwardDirection)?,
    };
    let right = forward.cross(&axis).try_normalize(1e-9).ok_or(MotionFailure::NoForwardDirection)?;
    let forward = axis.cross(&right);
    Ok(match turn {
        Turn::Back => -forward,
        Turn::Right => right,
        Turn::Left => -right,
        _ => forward,
    })
}

/// Operations 4 and 5: the common tangent of part and drive surface, in the sense asked for.
fn line_of_motion(part: &Contact, drive: &Contact, wanted: &Vec3, tip: &Vec3) -> Result<Vec3, MotionFailure> {
    let cross = part.gradient.cross(&drive.gradient);
    let tangent = if cross.norm() > TANGENT_SINE {
        cross.normalize()
    } else {
        // Tangent surfaces: the direction asked for, as far as it lies in both.
        let flat = wanted - part.gradient * wanted.dot(&part.gradient);
        flat.try_normalize(UNDETERMINED).ok_or(MotionFailure::TangentSurfaces { tip: *tip })?
    };
    let cosine = tangent.dot(wanted);
    if cosine.abs() <= UNDETERMINED {
        let angle = cosine.clamp(-1.0, 1.0).asin().abs();
        return Err(MotionFailure::DirectionUndetermined { angle, tangent, wanted: *wanted });
    }
    Ok(if cosine > 0.0 { tangent } else { -tangent })
}

/// The line of motion of a tool that turns on its way, which leads that aside: in the direction asked for, or where it goes across that
/// in the sense of the line of a tool that keeps its axis. None where that does not turn, or has no line.
fn line_of_turning(
    attitude: &Attitude<'_>,
    roles: [&Working; 2],
    tip: &Vec3,
    (standing, wanted): (&Vec3, &Vec3),
) -> Option<Vec3> {
    if !attitude.turns() {
        return None;
    }
    let posture = attitude.posture(tip).ok()?;
    let [part, drive] = roles.map(|role| posture.contact(&role.gauge, tip).gradient);
    let along = part.cross(&drive).try_normalize(TANGENT_SINE)?;
    let [asked, standing] = [wanted, standing].map(|direction| along.dot(direction));
    let sense = if asked.abs() > UNDETERMINED { asked } else { standing };
    Some(if sense < 0.0 { -along } else { along })
}

/// An axis with a lead angle leads along the surfaces that guide it in the sense of the direction asked for. Where the turning of the tool leads its line of
/// motion square to that, or against it, it would lag along its path: no direction is told.
fn leads_along(
    attitude: &Attitude<'_>,
    tip: &Vec3,
    (tangent, wanted): (&Vec3, &Vec3),
) -> Result<(), MotionFailure> {
    if attitude.leads_along(tip, tangent).is_none_or(|cosine| cosine > UNDETERMINED) {
        return Ok(());
    }
    let angle = tangent.dot(wanted).clamp(-1.0, 1.0).asin().abs();
    Err(MotionFailure::DirectionUndetermined { angle, tangent: *tangent, wanted: *wanted })
}

/// The line of motion of a tool that turns on its way, where the direction asked for tells its sense: that of a tool which keeps its axis may be
/// square to this one. None where the tool does not turn, or has no line with a sense.
fn own_line(
    state: &State,
    tool: &Tool<'_>,
    (part, drive): (&Working, &Working),
    (tip, wanted): (&Vec3, &Vec3),
) -> Option<Vec3> {
    let attitude = attitude(state, tool, (part, drive), tip, wanted).ok()?;
    let line = line_of_turning(&attitude, [part, drive], tip, (&Vec3::zeros(), wanted))?;
    (line.dot(wanted) > UNDETERMINED).then_some(line)
}

/// Where a motion begins.
struct Corner<'a> {
    tool: &'a Tool<'a>,
    tip: Vec3,
    roles: [&'a Working; 2],
    contacts: [Contact; 2],
    size: f64,
}

impl Corner<'_> {
    /// The line of motion in the sense asked for, and the contacts with part and drive surface along which it leads.
    fn line(&self, state: &State, wanted: &Vec3) -> Result<(Vec3, [Contact; 2]), MotionFailure> {
        let [part, drive] = &self.contacts;
        let failure = match line_of_motion(part, drive, wanted, &self.tip) {
            Ok(along) => return Ok((along, self.contacts)),
            Err(failure) => failure,
        };
        self.decided(wanted, failure).or_else(|failure| {
            let [part, drive] = self.roles;
            let along = own_line(state, self.tool, (part, drive), (&self.tip, wanted)).ok_or(failure)?;
            Ok((along, self.contacts))
        })
    }

    /// Where a line of motion has the tool on the side of the drive surface that TLLFT or TLRGT does not tell, and it is in tolerance on the other one too:
    /// the surface with the tool there, the contact with it, and the line of motion.
    fn on_the_told_side(
        &self,
        state: &State,
        (tangent, contact): (&Vec3, &Contact),
        wanted: &Vec3,
    ) -> Option<(Working, Contact, Vec3)> {
        let Self { tool, tip, roles: [_, drive], contacts: [part, _], size } = *self;
        misplaced(state.drive_side, tool, &contact.gradient, tangent)?;
        let (other, contact) = on_the_other_side(tool, drive, &tip, size)?;
        let along = line_of_motion(&part, &contact, wanted, &tip).ok()?;
        let is_told = misplaced(state.drive_side, tool, &contact.gradient, &along).is_none();
        is_told.then_some((other, contact, along))
    }

    /// Where the direction asked for is square to the line of motion that is measured: the one along another contact, which it decides.
    fn decided(&self, wanted: &Vec3, failure: MotionFailure) -> Result<(Vec3, [Contact; 2]), MotionFailure> {
        let MotionFailure::DirectionUndetermined { tangent, .. } = failure else { return Err(failure) };
        [tangent, -tangent].iter().find_map(|along| self.way_out(along, wanted)).ok_or(failure)
    }

    /// Where the tool touches a surface at two places: the line of motion along the other one than that which is measured, if this
    /// one leads it against the other, or less than the other in the direction asked for; and the contacts with part and drive surface
    /// there. The line of motion must lead away from the one that is measured.
    fn way_out(&self, tangent: &Vec3, wanted: &Vec3) -> Option<(Vec3, [Contact; 2])> {
        if self.roles.iter().all(|role| role.shape == Shape::Flat) {
            return None;
        }
        [tangent, wanted].into_iter().find_map(|ahead| self.way_out_seen(ahead, tangent, wanted))
    }

    /// The same with the other contact that is measured a little ahead.
    fn way_out_seen(&self, ahead: &Vec3, tangent: &Vec3, wanted: &Vec3) -> Option<(Vec3, [Contact; 2])> {
        let bands = self.roles[0].band() + self.roles[1].band();
        let step = ahead * (CORNER_AHEAD * bands);
        let others = self.roles.map(|role| role.gauge.contact(self.tool, &(self.tip + step)));
        let is_other =
            |k: usize| self.contacts[k].gradient.cross(&others[k].gradient).norm() > OTHER_CONTACT_SINE;
        let is_blocked = |k: usize| others[k].gradient.dot(tangent) < 0.0;
        // Another place whose clearance is in the band is touched, too.
        let touches_both = |k: usize| {
            let there = others[k].clearance - others[k].gradient.dot(&step);
            self.roles[k].holds(there, self.size)
        };
        [[true, false], [false, true], [true, true]].into_iter().find_map(|turns| {
            let turning = || (0..2).filter(|k| turns[*k]);
            if !turning().all(is_other) {
                return None;
            }
            let [part, drive] = [0, 1].map(|k| if turns[k] { &others[k] } else { &self.contacts[k] });
            let along = line_of_motion(part, drive, wanted, &self.tip).ok()?;
            let is_better = || along.dot(wanted) > tangent.dot(wanted);
            let leaves = turning().all(|k| self.contacts[k].gradient.dot(&along) >= 0.0);
            (leaves && turning().all(touches_both) && (turning().all(is_blocked) || is_better()))
                .then_some((along, [*part, *drive]))
        })
    }
}

/// A surface that is followed leads along no other one where it is both, and along itself a tool meets no surface.
fn warn_of_surface_twice<'a>(roles: impl Iterator<Item = &'a Working>, warnings: &mut Vec<MotionWarning>) {
    let roles: Vec<&Working> = roles.take(TOLD_ROLES).collect();
    for (index, role) in roles.iter().enumerate() {
        let first = roles.iter().take(index).find(|first| first.named.geometry == role.named.geometry);
        warnings.extend(
            first
                .map(|first| MotionWarning::SurfaceTwice { roles: [first.name, role.name], start_up: false }),
        );
    }
}

/// Warning 1601: the tool is not where TLLFT or TLRGT says. The motion keeps the side where it is.
fn judge_side(
    state: &State,
    tool: &Tool,
    drive: &Contact,
    tangent: &Vec3,
    warnings: &mut Vec<MotionWarning>,
) -> DriveSide {
    let Some((sine, side)) = misplaced(state.drive_side, tool, &drive.gradient, tangent) else {
        return state.drive_side;
    };
    warnings.push(MotionWarning::WrongSideOfDrive { sine, side });
    side
}

/// Where the tool is not on the side of the drive surface that is told: by which sine, and on which side it is. The drive surface leads away from itself
/// along its `gradient`.
fn misplaced(told: DriveSide, tool: &Tool, gradient: &Vec3, tangent: &Vec3) -> Option<(f64, DriveSide)> {
    // From the surface to the tool, seen with the axis up: positive when the tool is to the left.
    let sine = tangent.cross(gradient).dot(&tool.axis);
    match told {
        DriveSide::Left => (sine < -SIDE_SINE).then_some((sine, DriveSide::Right)),
        DriveSide::Right => (sine > SIDE_SINE).then_some((sine, DriveSide::Left)),
        DriveSide::On => None,
    }
}

/// The surface with the tool on its other side, if the tool is in tolerance there too.
fn on_the_other_side(tool: &Tool, role: &Working, tip: &Vec3, size: f64) -> Option<(Working, Contact)> {
    let mut other = role.clone();
    other.set_side(-role.gauge.side);
    let contact = other.gauge.contact(tool, tip);
    other.look_from(tip);
    other.holds(contact.clearance, size).then_some((other, contact))
}

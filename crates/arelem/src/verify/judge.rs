//! The rules, one after the other.

mod band;
mod corner;

use std::cell::RefCell;

use apt_geometry::{
    Vec3,
    motion::{DriveSide, Relation},
    patience::{Patience, Waiting},
};

use crate::sequence::{CutSequence, Role, ToolPosition};

use super::{
    Evidence, Extent, Rule, VerifyError, Violation,
    clearance::{Clearance, Reading, Surface},
    hand::{self, Hand},
    span::{Extremes, between},
    stop,
    tool::Profile,
};

/// Round-off allowed on every band, relative to the size of the geometry (arelem reference 1.7: no other slack).
const ROUND_OFF: f64 = 1e-9;
/// How far the model of a surface may be off it, relative to the band: less by far than what sequences leave of it, at first and
/// where it would decide.
const MODEL_SHARES: [f64; 3] = [4e-4, 1e-5, 0.0];
/// Sine of the angle between part and drive surface below which they give no direction of travel by themselves: a place elsewhere in
/// the bands tells another.
const PARALLEL: f64 = 1e-3;
/// The same below which they give none at all, as far as rounding leaves normals true.
const ALL_BUT_PARALLEL: f64 = 1e-6;
/// Cosine of the angle between a vector and the path at its end below which that may go on either way.
const NEARLY_SQUARE: f64 = 0.1;
/// Sine below which a surface is neither left nor right of the motion (3°).
const ACROSS: f64 = 0.05;
/// Sine of the angle that two normals may differ by at an exact tangency.
const TANGENT: f64 = 1e-6;
/// Share of a vector over which it is looked how its turning changes a clearance.
const TURNING_STEP: f64 = 1e-5;
/// How much a clearance may change along a line of motion, relative to the way of the tool end.
const STEADY: f64 = 1e-3;
/// Step of the curvature estimate at a tangency, relative to the size of the geometry.
const CURVATURE_STEP: f64 = 1e-4;

/// A role made ready for measuring.
struct Bound<'a> {
    role: &'a Role,
    surface: Surface,
    profile: Profile,
    /// How far the profile is above the tool end.
    raise: f64,
    on: bool,
    intol: f64,
    outtol: f64,
    /// The normal at each position, where the bands of whole vectors are judged: a position ends one vector and
    /// begins the next.
    normals: RefCell<Vec<Vec3>>,
    /// Who waits for the proof.
    patience: Patience<'a>,
}

impl<'a> Bound<'a> {
    fn of(
        role: &'a Role,
        profile: &Profile,
        on: bool,
        (model_share, patience): (f64, Patience<'a>),
    ) -> Result<Self, VerifyError> {
        let numbers = [role.side, role.inside_tolerance, role.outside_tolerance, role.thickness];
        if !numbers.iter().all(|x| x.is_finite()) {
            return Err(VerifyError::NotFinite);
        }
        let (profile, raise) = match role.disk {
            _ if on => (Profile::tool_end(), 0.0),
            None => (profile.clone(), 0.0),
            Some(disk) if disk.height.is_finite() => (Profile::disk(disk.radius)?, disk.height),
            Some(_) => return Err(VerifyError::NotFinite),
        };
        let wider = role.inside_tolerance.max(role.outside_tolerance);
        let [intol, outtol] = if on { [wider; 2] } else { [role.inside_tolerance, role.outside_tolerance] };
        Ok(Self {
            role,
            surface: Surface::within(&role.surface.geometry, model_share * (intol + outtol), patience)?,
            profile,
            raise,
            on,
            intol,
            outtol,
            normals: RefCell::default(),
            patience,
        })
    }

    /// Reads the clearance at the next position.
    fn read(&self, place: &ToolPosition) -> Result<Reading, VerifyError> {
        let mut normals = self.normals.borrow_mut();
        let lost = VerifyError::NoDistance { vector: normals.len().saturating_sub(1) };
        let reading = self.clearance().at(&place.tip, &place.axis).ok_or(lost)?;
        normals.push(reading.normal);
        Ok(reading)
    }

    /// The normal at a position that was read.
    fn normal_at(&self, index: usize) -> Result<Vec3, VerifyError> {
        self.normals.borrow().get(index).copied().ok_or(VerifyError::NoDistance { vector: index })
    }

    fn clearance(&self) -> Clearance<'_> {
        Clearance {
            surface: &self.surface,
            profile: &self.profile,
            raise: self.raise,
            side: if self.role.side < 0.0 { -1.0 } else { 1.0 },
            thickness: if self.on { 0.0 } else { self.role.thickness },
            allowed: self.intol,
            patience: self.patience,
        }
    }

    fn extent(&self, found: &Extremes) -> Extent {
        Extent { min: found.min, max: found.max, intol: self.intol, outtol: self.outtol }
    }

    /// The measured clearance that is farthest out of the band, and how far out it is; the error term counts against it.
    fn excess(&self, found: &Extremes, guard: f64) -> Option<(f64, f64)> {
        let below = -self.intol - guard - found.low;
        let above = found.high - self.outtol - guard;
        if below <= 0.0 && above <= 0.0 {
            None
        } else if below > above {
            Some((found.min, below))
        } else {
            Some((found.max, above))
        }
    }

    fn normal(&self, place: &ToolPosition) -> Option<Vec3> {
        self.clearance().at(&place.tip, &place.axis).map(|r| r.normal)
    }

    fn at_point(&self, place: &ToolPosition, vector: usize) -> Result<Extremes, VerifyError> {
        let reading =
            self.clearance().at(&place.tip, &place.axis).ok_or(VerifyError::NoDistance { vector })?;
        Ok(Extremes::within(reading.error, reading.value, reading.value))
    }
}

/// Collects broken promises: each rule once, at its worst place.
#[derive(Default)]
struct Findings {
    worst: Vec<(Violation, f64)>,
}

impl Findings {
    fn add(&mut self, rule: Rule, vector: usize, value: f64, badness: f64) {
        let violation = Violation { rule, vector, value };
        match self.worst.iter_mut().find(|(v, _)| v.rule == rule) {
            Some(known) if known.1 < badness => *known = (violation, badness),
            Some(_) => {}
            None => self.worst.push((violation, badness)),
        }
    }
}

struct Judge<'a> {
    sequence: &'a CutSequence,
    positions: Vec<ToolPosition>,
    profile: Profile,
    size: f64,
    findings: Findings,
    patience: Patience<'a>,
}

/// Judges a sequence: bands over the whole of every cut vector, stop condition, side, progress and step length.
///
/// Start-up motions are bound at their end only. `cancel` is asked before every reading of a clearance, and during long ones.
///
/// # Errors
/// See [`VerifyError`]; an error means that the sequence could not be judged, not that it is wrong.
pub fn verify<'a>(sequence: &'a CutSequence, cancel: &'a dyn Fn() -> bool) -> Result<Evidence, VerifyError> {
    // A reading that is given up is missing like one that does not exist: what is to be said of it is settled here.
    let waiting = Waiting::until(cancel);
    let evidence = settled(sequence, waiting.patience());
    if waiting.has_given_up() { Err(VerifyError::Cancelled) } else { evidence }
}

/// No inaccuracy of a model decides that could be less.
fn settled(sequence: &CutSequence, patience: Patience<'_>) -> Result<Evidence, VerifyError> {
    let [first, finer @ ..] = MODEL_SHARES;
    let (mut evidence, mut is_rough) = judged(sequence, first, patience)?;
    for share in finer {
        if evidence.verified || !is_rough {
            break;
        }
        (evidence, is_rough) = judged(sequence, share, patience)?;
    }
    Ok(evidence)
}

/// The judgement with models of surfaces that may be off by a share of the bands, and whether there are such models.
fn judged(
    sequence: &CutSequence,
    model_share: f64,
    patience: Patience<'_>,
) -> Result<(Evidence, bool), VerifyError> {
    let profile = match (&sequence.part, &sequence.drive, &sequence.stop) {
        // Point to point motion needs no cutter.
        (None, None, None) => Profile::tool_end(),
        _ => Profile::of(&sequence.cutter)?,
    };
    let positions = positions(sequence)?;
    let mut size = positions.iter().map(|p| p.tip.amax()).fold(profile.widest(), f64::max);
    let how = (model_share, patience);
    let of = |r| Bound::of(r, &profile, r.relation == Relation::On, how);
    let part = sequence.part.as_ref().map(of).transpose()?;
    let drive = sequence.drive.as_ref().map(of).transpose()?;
    let check = match &sequence.stop {
        Some(stop) => Some(Bound::of(&stop.role, &profile, stop_is_on(sequence, &stop.role), how)?),
        None => None,
    };
    let mut is_rough = false;
    for bound in [&part, &drive, &check].into_iter().flatten() {
        size = size.max(bound.surface.size());
        is_rough |= bound.surface.error() > 0.0;
    }
    let mut judge = Judge { sequence, positions, profile, size, findings: Findings::default(), patience };
    judge.run(part.as_ref(), drive.as_ref(), check.as_ref()).map(|evidence| (evidence, is_rough))
}

/// Tangent check surfaces stand to the tool as the surface they are tangent to.
fn stop_is_on(sequence: &CutSequence, role: &Role) -> bool {
    let other = match role.relation {
        Relation::On => return true,
        Relation::To | Relation::Past => return false,
        Relation::TangentToDrive => &sequence.drive,
        Relation::TangentToPart => &sequence.part,
    };
    other.as_ref().is_some_and(|r| r.relation == Relation::On)
}

/// At which share of a vector a wall that is read with a normal where it begins is another one: at the end where the tool goes away from it, and
/// where the tool would be out of the band where it goes towards it.
fn share_of_other(normal: &Vec3, motion: &Vec3, band: f64) -> Option<f64> {
    let away = normal.dot(motion);
    let share = if away > 0.0 { 1.0 } else { band / away.abs() };
    (share <= 1.0).then_some(share)
}

/// How fast a clearance changes because the tool turns as it does where a vector begins, relative to the way of the tool end.
fn turning(bound: &Bound<'_>, from: &ToolPosition, to: &ToolPosition) -> Option<f64> {
    let step = TURNING_STEP * (to.tip - from.tip).norm();
    let turned = ToolPosition { tip: from.tip, ..between(from, to, TURNING_STEP)? };
    let value = |place: &ToolPosition| bound.clearance().at(&place.tip, &place.axis).map(|r| r.value);
    Some((value(&turned)? - value(from)?) / step)
}

/// True if a tool that goes along a direction and turns about the same line as on a vector, as fast or faster or slower, keeps its clearances:
/// a path may set out in that direction, whatever it does after it. Of each role the normal and [`turning`].
fn is_line_of_motion(direction: &Vec3, roles: &[(Vec3, f64)]) -> bool {
    let square: f64 = roles.iter().map(|(_, turning)| turning * turning).sum();
    let against: f64 = roles.iter().map(|(normal, turning)| -normal.dot(direction) * turning).sum();
    let speed = if square > 0.0 { (against / square).max(0.0) } else { 0.0 };
    roles.iter().all(|(normal, turning)| (normal.dot(direction) + speed * turning).abs() <= STEADY)
}

/// All positions with unit axes.
fn positions(sequence: &CutSequence) -> Result<Vec<ToolPosition>, VerifyError> {
    if sequence.points.is_empty() {
        return Err(VerifyError::Empty);
    }
    std::iter::once(&sequence.start)
        .chain(&sequence.points)
        .map(|p| {
            let length = p.axis.norm();
            let usable = p.tip.iter().all(|x| x.is_finite()) && length.is_finite() && length > 0.0;
            // An axis that is already unit stays as it is, so that equal axes compare equal.
            let axis = if (length - 1.0).abs() <= 4.0 * f64::EPSILON { p.axis } else { p.axis / length };
            usable.then_some(ToolPosition { tip: p.tip, axis }).ok_or(VerifyError::NotFinite)
        })
        .collect()
}

/// How a vector goes on from the last one.
struct Leads {
    /// Cosine of the angle between both.
    sine: f64,
    /// The direction of the vector, that of the last one, and that in which the path comes to where the vector begins.
    direction: Vec3,
    heading: Vec3,
    arriving: Vec3,
}

impl Judge<'_> {
    fn guard(&self) -> f64 {
        ROUND_OFF * self.size
    }

    fn last_vector(&self) -> usize {
        self.positions.len().saturating_sub(2)
    }

    fn run(
        &mut self,
        part: Option<&Bound<'_>>,
        drive: Option<&Bound<'_>>,
        check: Option<&Bound<'_>>,
    ) -> Result<Evidence, VerifyError> {
        let start_up = self.sequence.start_up;
        let part_extent = part.map(|b| self.band(b, Rule::PartBand, start_up)).transpose()?;
        let drive_extent = drive.map(|b| self.band(b, Rule::DriveBand, start_up)).transpose()?;
        let check_extent = check.map(|b| self.band(b, Rule::CheckBand, true)).transpose()?;
        if let (Some(check), Some(stop)) = (check, &self.sequence.stop) {
            match stop.role.relation {
                Relation::TangentToDrive => self.tangency(check, drive),
                Relation::TangentToPart => self.tangency(check, part),
                _ if start_up => {}
                _ => self.stop_event(check, stop.occurrence)?,
            }
        }
        if !start_up && (part.is_some() || drive.is_some()) {
            if let Some(drive) = drive {
                self.side(drive, part)?;
            }
            self.progress(part, drive)?;
            self.step_length(part, drive);
        }
        let violations: Vec<Violation> =
            std::mem::take(&mut self.findings.worst).into_iter().map(|(v, _)| v).collect();
        Ok(Evidence {
            part: part_extent,
            drive: drive_extent,
            check: check_extent,
            verified: violations.is_empty(),
            violations,
        })
    }

    fn stop_event(&mut self, check: &Bound<'_>, occurrence: u32) -> Result<(), VerifyError> {
        let vector = self.last_vector();
        let profile = if check.on { Profile::tool_end() } else { self.profile.clone() };
        let verdict = stop::replay(
            self.sequence,
            (check.role, occurrence),
            (&check.surface, &profile),
            self.guard(),
            self.patience,
        )
        .ok_or(VerifyError::NoDistance { vector })?;
        if let Err(wrong) = verdict {
            self.findings.add(Rule::StopEvent, vector, f64::from(wrong.found), 1.0);
        }
        Ok(())
    }

    /// At a tangency the two normals agree up to the angle that the bands leave: √(2τκ) for the sum κ of the curvatures in the
    /// direction in which they differ, which is along the path as well as across it.
    fn tangency(&mut self, check: &Bound<'_>, mate: Option<&Bound<'_>>) {
        let vector = self.last_vector();
        let end = self.positions[vector + 1];
        let Some(mate) = mate else {
            self.findings.add(Rule::Tangency, vector, 1.0, 1.0);
            return;
        };
        let (Some(n), Some(m)) = (check.normal(&end), mate.normal(&end)) else {
            self.findings.add(Rule::Tangency, vector, 1.0, 1.0);
            return;
        };
        // Where they differ, by how much of a turn.
        let lean = n * n.dot(&m).signum() - m * n.dot(&m).abs();
        let angle = lean.norm();
        if angle <= TANGENT {
            return;
        }
        let (step, way) = (CURVATURE_STEP * self.size, lean / angle);
        let curvature = |b: &Bound<'_>| {
            let ahead = b.normal(&ToolPosition { tip: end.tip + way * step, ..end });
            let behind = b.normal(&ToolPosition { tip: end.tip - way * step, ..end });
            match (ahead, behind) {
                (Some(x), Some(y)) => (x - y).norm() / (2.0 * step),
                _ => 0.0,
            }
        };
        let bands = check.intol + check.outtol + mate.intol + mate.outtol;
        let limit = (2.0 * bands * (curvature(check) + curvature(mate))).sqrt() + TANGENT;
        if angle > limit {
            self.findings.add(Rule::Tangency, vector, angle, angle - limit);
        }
    }

    /// The tool sets out left or right of the drive surface, as TLLFT and TLRGT promise. From there on it is the side of the
    /// surface that is kept, which the band holds it to: where the path turns over, along the tool axis, left becomes right.
    fn side(&mut self, drive: &Bound<'_>, part: Option<&Bound<'_>>) -> Result<(), VerifyError> {
        let wanted = match self.sequence.drive_side {
            DriveSide::On => return Ok(()),
            _ if drive.on => return Ok(()),
            DriveSide::Left => 1.0,
            DriveSide::Right => -1.0,
        };
        for (vector, pair) in self.positions.windows(2).enumerate() {
            let (from, to) = (pair[0], pair[1]);
            let motion = to.tip - from.tip;
            let length = motion.norm();
            if length <= self.guard() {
                continue;
            }
            let across = |place: &ToolPosition, normal: &Vec3, onward: Vec3| {
                wanted * normal.dot(&place.axis.cross(&onward))
            };
            let sine_at = |place: &ToolPosition, normal: &Vec3| {
                // Along the path, from which a long vector may lead away in a curve's chord.
                let travel = part.and_then(|p| p.normal(place)).map_or(Vec3::zeros(), |n| n.cross(normal));
                let chord = across(place, normal, motion / length);
                if travel.norm() <= PARALLEL {
                    return chord;
                }
                let sine = across(place, normal, travel * (travel.dot(&motion).signum() / travel.norm()));
                // A tool that turns is led aside by that, with the path.
                if from.axis == to.axis { sine } else { sine.max(chord) }
            };
            let normal = drive.normal(&from).ok_or(VerifyError::NoDistance { vector })?;
            let mut sine = sine_at(&from, &normal);
            // In a corner the tool goes away from the one wall that is read there, along the other. A place that it goes towards does not count
            // where it would be out of the band.
            let other = share_of_other(&normal, &motion, drive.intol + drive.outtol)
                .filter(|share| sine < -ACROSS && (*share == 1.0 || from.axis == to.axis))
                .map(|share| ToolPosition { tip: from.tip + motion * share, axis: to.axis });
            if let Some((place, normal)) = other.and_then(|place| Some((place, drive.normal(&place)?))) {
                sine = sine.max(sine_at(&place, &normal));
            }
            // The path of a tool that turns may turn over along its first vector, and sets out to where it is told if it can go that way.
            let forward = self.sequence.forward;
            if sine < -ACROSS && from.axis != to.axis && forward.dot(&motion) > 0.0 {
                let turned = |bound: &Bound<'_>| Some((bound.normal(&from)?, turning(bound, &from, &to)?));
                let roles = part.into_iter().chain([drive]).map(turned).collect::<Option<Vec<_>>>();
                if roles.is_some_and(|roles| is_line_of_motion(&forward, &roles)) {
                    sine = sine.max(across(&from, &normal, forward));
                }
            }
            if sine < -ACROSS {
                self.findings.add(Rule::Side, vector, sine, -sine);
            }
            break;
        }
        Ok(())
    }

    /// Every vector goes forward along the intersection of the offset surfaces.
    fn progress(&mut self, part: Option<&Bound<'_>>, drive: Option<&Bound<'_>>) -> Result<(), VerifyError> {
        let mut heading = self.sequence.forward;
        // The direction in which the path comes to the vertex, if it runs along an arc over the vector that leads there.
        let mut arriving = heading;
        let mut hand = Hand::default();
        let single = self.positions.len() == 2;
        for vector in 0..self.positions.len() - 1 {
            let (from, to) = (self.positions[vector], self.positions[vector + 1]);
            let motion = to.tip - from.tip;
            let length = motion.norm();
            if length <= self.guard() {
                if !single {
                    self.findings.add(Rule::Progress, vector, 0.0, 0.0);
                }
                continue;
            }
            let direction = motion / length;
            let mut sine = if heading.norm() > 0.0 { direction.dot(&heading) } else { 1.0 };
            let mut begins = direction;
            if let (Some(part), Some(drive)) = (part, drive) {
                let leads = Leads { sine, direction, heading, arriving };
                (sine, begins) = self.along_path(&mut hand, [part, drive], vector, &leads)?;
            }
            if sine <= 0.0 {
                self.findings.add(Rule::Progress, vector, sine, -sine);
            }
            heading = direction;
            arriving = direction * (2.0 * direction.dot(&begins)) - begins;
        }
        Ok(())
    }

    /// The cosine between a vector and the path where it begins, and the direction of that there: along both surfaces, on the hand that is kept.
    fn along_path(
        &self,
        hand: &mut Hand,
        roles: [&Bound<'_>; 2],
        vector: usize,
        leads: &Leads,
    ) -> Result<(f64, Vec3), VerifyError> {
        let Leads { mut sine, direction, heading, arriving } = *leads;
        let [part, drive] = roles;
        let normals = [part.normal_at(vector)?, drive.normal_at(vector)?];
        if vector == 0 {
            *hand = Hand::setting_out(&normals, &heading);
        }
        let travel = normals[0].cross(&normals[1]);
        let angle = travel.norm();
        let turned = travel.dot(&heading);
        // A vector to where the path turns by about a right angle does not tell which way it goes on.
        let onward = if turned.abs() < NEARLY_SQUARE * angle { travel.dot(&arriving) } else { turned };
        let along = travel * (onward.signum() / angle);
        if angle > ALL_BUT_PARALLEL && angle <= PARALLEL {
            // The bands are wide across the path there: either what it leads along or the last vector tells.
            sine = sine.max(direction.dot(&along));
        }
        let is_told = angle > PARALLEL && heading.norm() > 0.0;
        if !is_told {
            return Ok((sine, direction));
        }
        // In a corner the tool goes away from the wall that is read there, along another.
        let leaves = normals.iter().any(|normal| normal.dot(&direction) > ACROSS);
        // The path of a turning tool is no line across both normals: the axis leads it aside.
        let turns = self.positions[vector].axis != self.positions[vector + 1].axis;
        let told = if turns || leaves { sine } else { f64::NEG_INFINITY };
        let at_end = [part.normal_at(vector + 1)?, drive.normal_at(vector + 1)?];
        let (sine, begins, followed) =
            self.out_of_corner(hand, roles, vector, ([normals, at_end], &direction), along, told);
        hand.follow(followed, &begins, |hand| self.keeps_hand_before(hand, roles, vector));
        let cosine = self.crosses_over(hand, roles, vector, &[normals, at_end]);
        Ok((cosine.map_or(sine, |cosine| sine.min(cosine)), begins))
    }

    /// The same before the hand is looked at, with the normals that the path keeps to: where the vector does not go along the path that the normals
    /// where it begins tell, in the sense that is told there, along another wall of the corner.
    fn out_of_corner(
        &self,
        hand: &Hand,
        roles: [&Bound<'_>; 2],
        vector: usize,
        ([normals, at_end], direction): ([[Vec3; 2]; 2], &Vec3),
        along: Vec3,
        told: f64,
    ) -> (f64, Vec3, [Vec3; 2]) {
        let (from, to) = (self.positions[vector], self.positions[vector + 1]);
        let mut found = (direction.dot(&along).max(told), along, normals);
        let bands = roles.map(|bound| bound.intol + bound.outtol);
        let is_left = from.axis == to.axis && hand::leaves(&normals, &(to.tip - from.tip), bands);
        if found.0 <= 0.0
            && let Some((along, normals)) = hand.beyond_corner(&normals, &at_end, is_left)
        {
            found = (direction.dot(&along), along, normals);
        }
        if found.0 <= 0.0
            && let Some(leap) = self.leap_beside(hand, roles, vector)
            && let Some((along, normals)) = hand.beyond_leap(&normals, &at_end, leap)
        {
            found = (direction.dot(&along), along, normals);
        }
        if found.0 <= 0.0 && self.goes_round(roles, vector) {
            (found.0, found.1) = (1.0, *direction);
        }
        found
    }

    /// No vector is longer than MAXDP, which does not count where part and drive surface are both planes (language
    /// reference 6.8).
    fn step_length(&mut self, part: Option<&Bound<'_>>, drive: Option<&Bound<'_>>) {
        let planar = |b: Option<&Bound<'_>>| b.is_none_or(|b| matches!(b.surface, Surface::Plane(..)));
        let limit = self.sequence.maximum_step;
        if (planar(part) && planar(drive)) || !limit.is_finite() {
            return;
        }
        for vector in 0..self.positions.len() - 1 {
            let length = (self.positions[vector + 1].tip - self.positions[vector].tip).norm();
            if length > limit + self.guard() {
                self.findings.add(Rule::StepLength, vector, length, length - limit);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_that_the_tool_goes_along_is_no_other_one() {
        let share = |away: f64| share_of_other(&Vec3::z(), &Vec3::new(1.0, 0.0, away), 0.25);
        assert_eq!([0.5, -0.5, -1.0].map(share), [Some(1.0), Some(0.5), Some(0.25)]);
        assert_eq!([0.0, -0.0, -0.1].map(share), [None; 3]);
    }
}

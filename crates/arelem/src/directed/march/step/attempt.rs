//! Tries a vector of about a length: where it ends on the path, and what its proof says.

use apt_geometry::{Vec3, surface::Surface};

use super::{
    CORNER_BANDS, GREATEST_GROWTH, Stepper, Trial, Tried, along_arc,
    sag::{growth, sagging},
};
use crate::{
    clearance::{Contact, Shape},
    directed::{
        Prepared,
        march::{Vertex, tangent},
    },
    position::{self, Condition, Solution},
    role::{Bend, Working},
};

/// Bound of the corrections for the end of a vector: far above what a vector that leads on needs.
const CORRECTIONS: u32 = 20;
/// Bound of the trials that shorten a vector which the way back into the bands makes longer than is allowed.
const MOST_SHORTENINGS: u32 = 12;
/// Share of the length asked for below which a vector falls short of it.
const FALLS_SHORT: f64 = 0.7;
/// How many times as far away as it is looked for a position is to which the contacts that were found last have led astray.
const ASTRAY: f64 = 2.0;
/// How many times as far the nearest contacts may lead on the way before looking for it with them is in vain.
const STRAYS: f64 = 2.0;
/// Bound of the ends looked for along vectors that fell short.
const MOST_SHORT: u32 = 2;
/// Cosine between the directions at both ends below which the vector is shortened (60°).
pub(super) const LEAST_TURN_COSINE: f64 = 0.5;
/// Cosine of the angle between a vector and the path at its end below which that may go on either way.
const NEARLY_SQUARE: f64 = 0.1;
/// Share of a vector's length by which its end may be expected aside of its tangent.
const FAR_ASIDE: f64 = 0.25;

/// Cosines that a vector has at least: with the path at its beginning, and of the directions of the path at both ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeastCosines {
    pub(super) forward: f64,
    pub(super) between: f64,
    /// With the path at its end, of a tool that turns.
    pub(super) arriving: f64,
}

impl LeastCosines {
    /// Of vectors that follow the path.
    pub(super) const ALONG: Self =
        Self { forward: LEAST_TURN_COSINE, between: LEAST_TURN_COSINE, arriving: LEAST_TURN_COSINE };
    /// Of vectors that round a corner.
    pub(super) const ROUND_CORNER: Self = Self { between: 0.0, arriving: -1.0, ..Self::ALONG };
}

/// What a vector is to end with: clearances, from second derivatives of them along the path, and the bends that tell the limits.
pub(super) type Aim<'a> = ([f64; 2], &'a [f64; 2], &'a [Bend; 2]);

impl Stepper<'_> {
    /// Tries a vector of about this length; `None` if there is no position ahead or it is too long.
    pub(super) fn attempt(&self, here: &Vertex, length: f64, cap: f64, aim: Aim<'_>) -> Option<Trial> {
        let vertex = self.reached(here, length, cap, aim)?;
        self.judge(here, vertex, aim.2, self.least_cosines(here, &vertex))
    }

    /// What is asked of a vector: only one that is short may round a corner.
    pub(super) fn least_cosines(&self, here: &Vertex, vertex: &Vertex) -> LeastCosines {
        let is_short = (vertex.tip - here.tip).norm() <= self.corner();
        if is_short { LeastCosines::ROUND_CORNER } else { LeastCosines::ALONG }
    }

    /// The position to which a vector of about this length leads.
    pub(super) fn reached(&self, here: &Vertex, length: f64, cap: f64, aim: Aim<'_>) -> Option<Vertex> {
        let (targets, curvature, _) = aim;
        let mut attempted = length;
        let mut start = ahead(here, attempted, targets, curvature);
        let (mut short, mut falls): (Option<Vertex>, _) = (None, 0);
        for _ in 0..MOST_SHORTENINGS {
            let Some(vertex) = self.meet(here, &start, targets) else { break };
            let chord = vertex.tip - here.tip;
            let reached = chord.norm();
            if reached > cap * (1.0 + 1e-9) {
                // The correction made it longer than allowed: try again a little shorter.
                attempted *= (cap / reached) * (1.0 - 1e-6);
                if attempted < 0.5 * length {
                    break;
                }
                start = ahead(here, attempted, targets, curvature);
                continue;
            }
            let is_farther = short.is_none_or(|short| (short.tip - here.tip).norm() < reached);
            if is_farther {
                short = Some(vertex);
            }
            if reached >= FALLS_SHORT * attempted || falls >= MOST_SHORT || !is_farther {
                break;
            }
            // The path bends away from where it was looked for.
            falls += 1;
            start = here.tip + chord * (attempted / reached);
        }
        short
    }

    /// The position to which a vector of about this length leads, even where that does not lead on.
    pub(super) fn beyond(
        &self,
        here: &Vertex,
        length: f64,
        targets: [f64; 2],
        curvature: &[f64; 2],
    ) -> Option<Vertex> {
        self.meet(here, &ahead(here, length, targets, curvature), targets)
    }

    /// The position with these clearances that is found from a place.
    ///
    /// On the way the contacts that were found last are followed. Where these were at the end of a surface far ahead they lead there from anywhere: what
    /// is found much farther away than it is looked for is looked for again with those that are the nearest, no farther away.
    pub(super) fn meet(&self, here: &Vertex, start: &Vec3, targets: [f64; 2]) -> Option<Vertex> {
        let Prepared { attitude, part, drive, .. } = self.prepared;
        let conditions =
            [Condition::Clearance(&part.gauge, targets[0]), Condition::Clearance(&drive.gauge, targets[1])];
        let off = |found: &Solution| (found.tip - start).norm();
        let followed = position::try_within(attitude, &conditions, start, CORRECTIONS).ok()?;
        let is_far = self.roles().iter().any(|role| role.gauge.surface.has_ends())
            && (followed.tip - here.tip).norm() > ASTRAY * (start - here.tip).norm();
        let farthest = STRAYS * ASTRAY * (start - here.tip).norm();
        let again = || position::solve_proven_near(attitude, &conditions, start, CORRECTIONS, farthest).ok();
        let nearer = is_far.then(again).flatten().filter(|found| off(found) < off(&followed));
        let Solution { tip, contacts: [Some(part), Some(drive), _], .. } = &nearer.unwrap_or(followed) else {
            return None;
        };
        let axis = attitude.tool_at(tip).ok()?.axis;
        let tangent = tangent(part, drive, &here.tangent);
        Some(Vertex { tip: *tip, axis, part: *part, drive: *drive, tangent })
    }

    /// How long a vector may be that rounds a corner. The path has one over the vertex of a cone, and, while the axis stands
    /// still, wherever the tool comes to touch a surface at a second place.
    fn corner(&self) -> f64 {
        let turns = self.prepared.attitude.turns();
        let may_turn = |role: &&Working| match role.gauge.surface {
            Surface::Cone(_) => true,
            _ => !turns && role.shape != Shape::Flat,
        };
        CORNER_BANDS * self.roles().into_iter().filter(may_turn).map(Working::band).sum::<f64>()
    }

    /// True if a vector of a tool that turns leads back from where the last one came, or across the path at its end, so that the next one would. The
    /// line of motion of such a tool hangs on the law of its axis: nobody who reads the positions alone can tell that it bends so.
    fn turns_back(&self, (chord, to): (&Vec3, &Vertex), arriving: f64) -> bool {
        self.prepared.attitude.turns()
            && (chord.dot(&self.last) < 0.0 || chord.dot(&to.tangent) < arriving * chord.norm())
    }

    /// What there is to say of the vector to a position; `None` if it does not lead on, or if the cosine between the directions of the
    /// path at its ends is less than allowed.
    pub(super) fn judge(
        &self,
        here: &Vertex,
        mut vertex: Vertex,
        bends: &[Bend; 2],
        least: LeastCosines,
    ) -> Option<Trial> {
        let chord = vertex.tip - here.tip;
        let reached = chord.norm();
        let forward = chord.dot(&here.tangent) > least.forward * reached;
        if !forward
            || self.turns_back((&chord, &vertex), least.arriving)
            || self.kinks_back(here, &chord)
            || self.changes_hand(&chord, &vertex)
            || self.goes_through_neck(here, &chord, &vertex)
            || reached <= self.least_vector(&vertex.tip)
            || vertex.tangent.dot(&here.tangent) < least.between
        {
            return None;
        }
        vertex.tangent = tangent(&vertex.part, &vertex.drive, &chord);
        // Where the path turns by about a right angle at the end of a bend the vector does not tell which way it goes on.
        if vertex.tangent.dot(&chord) < NEARLY_SQUARE * reached {
            vertex.tangent = tangent(&vertex.part, &vertex.drive, &along_arc(here, &chord));
        }
        let direction = chord / reached;
        let turn = |a: &Contact, b: &Contact| (b.gradient - a.gradient).dot(&direction) / reached;
        let mut curvature = [turn(&here.part, &vertex.part), turn(&here.drive, &vertex.drive)];
        let extremes = self.extremes(here, &vertex);
        let ends =
            [(here.part.clearance, vertex.part.clearance), (here.drive.clearance, vertex.drive.clearance)];
        for k in 0..2 {
            if self.is_turned(k) {
                let role = self.roles()[k];
                let sagging = sagging(role, &extremes[k], ends[k], reached);
                curvature[k] = sagging.or(extremes[k].turning_bend).unwrap_or(curvature[k]);
            }
        }
        let course = self.course(here, &vertex, &direction, &curvature);
        let mut trial = Trial(Box::new(Tried {
            vertex,
            length: reached,
            curvature,
            bends: *bends,
            at_start: course.at_start,
            at_end: course.at_end,
            next_curvature: course.next_curvature,
            growth: GREATEST_GROWTH,
            is_at_corner: false,
            proven: extremes.iter().all(|e| e.proven),
            open: [!extremes[0].proven, !extremes[1].proven],
            unproven: None,
            readings: [extremes[0].readings, extremes[1].readings],
            culprit: 0,
            worst: 0.0,
        }));
        for (k, role) in self.roles().iter().enumerate() {
            let growth = growth(role, &extremes[k], ends[k]);
            if growth < trial.growth {
                let deep = extremes[k].least < -role.inside;
                trial.worst = if deep { extremes[k].least } else { extremes[k].greatest };
                (trial.growth, trial.culprit) = (growth, k);
            }
        }
        Some(trial)
    }
}

/// About where the path is at a distance along its tangent, as far as clearances bend as is known. Where that leads far aside
/// it is not trusted.
fn ahead(here: &Vertex, length: f64, targets: [f64; 2], curvature: &[f64; 2]) -> Vec3 {
    let along = here.tangent * length;
    let contacts = [&here.part, &here.drive];
    let mut residual = [0.0; 2];
    for (k, contact) in contacts.iter().enumerate() {
        let bent = contact.gradient.dot(&along) + 0.5 * curvature[k] * length * length;
        residual[k] = contact.clearance + bent - targets[k];
    }
    let aside = position::correction_of_two(residual, contacts.map(|contact| contact.gradient));
    let trusted = aside.norm() <= FAR_ASIDE * length;
    if !trusted {
        return here.tip + along;
    }
    // No longer than asked for: an arc sags a little more than the parabola that the length is predicted for.
    let way = along + aside;
    here.tip + way * (length * length / way.norm_squared())
}

//! On which hand a path keeps part and drive surface, through corners that turn it by about a right angle or more, too.

use std::iter::zip;

use apt_geometry::{Vec3, motion::Relation};

use super::{
    Places, Stepper,
    corner::{SAME_TANGENT_COSINE, SecondPlace},
    exhaustive::LEAST_ONWARD,
};
use crate::{
    clearance::Contact,
    directed::{
        Prepared,
        march::{SAME_LINE, Vertex},
    },
    error::MotionFailure,
    role::Working,
};

/// Sine between the gradients of both clearances below which they do not tell a hand: where surfaces are nearly tangent paths cross, and what
/// goes straight on there changes it.
const TELLING_SINE: f64 = 0.1;
/// Cosine between the gradients at both ends of a vector above which the tool touches at the same place (30°).
pub(super) const SAME_CONTACT_COSINE: f64 = 0.87;
/// Halvings of a vector for the place on it where the contact leaps.
const LEAP_HALVINGS: u32 = 30;
/// Sine between two lines of motion below which they are one, for the path bends on its way between the places at which they are measured (3°).
const SAME_LINE_SINE: f64 = 0.05;

/// The sign of the triple product of the gradients of both clearances and the direction of the path. The tool keeps to one side of each
/// surface, so its path is an edge of what it may reach, and along an edge this sign stays: where the gradient a of one clearance gives
/// way to b at a second place of contact, and p is that of the other one, the path comes along s·p×a and goes on along s·p×b. It comes to b,
/// b·(s·p×a) < 0, which says the same as a·(s·p×b) > 0: it leads away from a, by whatever angle it turns.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hand {
    sign: Option<f64>,
    /// Whether the tool has come to touch one of both surfaces at another place on the last vector, where the tangent leads back.
    is_beyond_corner: bool,
    /// Where the last vector begins, and the sign there.
    before: Option<(Option<f64>, Vertex)>,
}

/// Directions of the gradients of both clearances, which are no unit vectors where the axis turns; zero where a clearance has none.
fn gradients(vertex: &Vertex) -> [Vec3; 2] {
    [vertex.part.gradient, vertex.drive.gradient]
        .map(|gradient| gradient.try_normalize(0.0).unwrap_or_default())
}

/// Whether the tool touches one of both surfaces at a vertex about as at the one before.
fn touches_as_before(prepared: &Prepared<'_>, [from, to]: [&Vertex; 2], role: usize) -> bool {
    gradients(from)[role].dot(&gradients(to)[role]) >= SAME_CONTACT_COSINE
        || is_turned_by_law(prepared, [from, to], role)
}

/// Whether it is the law of the axis that turns the gradient of a clearance from one vertex to another, and no other place of contact: the contact at the first
/// one has about that gradient if the axis turns as it does at the second one.
fn is_turned_by_law(prepared: &Prepared<'_>, [from, to]: [&Vertex; 2], role: usize) -> bool {
    if !prepared.attitude.turns() {
        return false;
    }
    let gauge = [&prepared.part.gauge, &prepared.drive.gauge][role];
    let read = gauge.contact(&prepared.tool.turned(from.axis), &from.tip);
    let moved = Contact { tool: read.tool + (to.tip - from.tip), ..read };
    let has_gradient_of = |vertex: &Vertex, mut contact: Contact| {
        let Ok(posture) = prepared.attitude.posture(&vertex.tip) else { return false };
        posture.follow_law(gauge, &vertex.tip, &mut contact);
        let gradient = contact.gradient.try_normalize(0.0);
        gradient.is_some_and(|gradient| gradient.dot(&gradients(vertex)[role]) >= SAME_CONTACT_COSINE)
    };
    // Of two places that are equally near the one that is read need not be the one that the path has followed.
    has_gradient_of(from, read) && has_gradient_of(to, moved)
}

/// Whether the hand stays between two vertices though the tangent at the second one tells the other: the vector leads along on it at both ends, or the
/// contact leaps where it changes, in a corner. However near to each other the gradients are on either side of that, the path has two directions
/// there. Where surfaces come to be tangent and part again the hand changes as well, but the gradients go over into each other, and in between
/// they do not tell it. A tool that turns has no contact but with its axis.
fn stays_between(prepared: &Prepared<'_>, [from, to]: [&Vertex; 2], sign: Option<f64>) -> bool {
    let chord = to.tip - from.tip;
    let at = |share: f64| Vertex::at(prepared, from.tip + chord * share, &chord).ok();
    let is_known = sign.is_some() && !prepared.attitude.turns();
    let Some(mut ends) = is_known.then(|| Some([at(0.0)?, at(1.0)?])).flatten() else { return false };
    let [before, beyond] = [0, 1].map(|k: usize| Hand::sign_at(&ends[k]));
    if before != sign || beyond.is_none() || before == beyond {
        return before == sign && beyond == sign;
    }
    let mut shares = [0.0, 1.0];
    for _ in 0..LEAP_HALVINGS {
        let share = 0.5 * (shares[0] + shares[1]);
        let Some(middle) = at(share) else { return false };
        let side = match Hand::sign_at(&middle) {
            None => return false,
            middle => usize::from(middle == beyond),
        };
        (shares[side], ends[side]) = (share, middle);
    }
    ends[0].tangent.dot(&ends[1].tangent).abs() < SAME_LINE
}

/// The sign that two gradients tell with a direction of the path along both.
fn sign_of([part, drive]: [&Vec3; 2], tangent: &Vec3) -> Option<f64> {
    let across = part.cross(drive);
    let along = across.dot(tangent);
    let is_told = across.norm() >= TELLING_SINE && along.abs() >= SAME_LINE * across.norm();
    is_told.then(|| along.signum())
}

impl Hand {
    /// That of the beginning of a motion, where the path may set out along other contacts than those that are measured there. One of a tool that turns is
    /// told by its own line.
    pub(super) fn setting_out(prepared: &Prepared<'_>) -> Self {
        let [part, drive] = &prepared.followed;
        let sign = sign_of([part, drive], &prepared.tangent).filter(|_| !prepared.attitude.turns());
        Self { sign, ..Self::default() }
    }

    /// The sign at a vertex, by its tangent. Where a path begins in a corner or before a tight bend its tangent is that of the leg beyond: held against
    /// the contacts of the one that it leaves it tells the other hand, if the path turns by more than a right angle.
    fn sign_at(vertex: &Vertex) -> Option<f64> {
        let [part, drive] = gradients(vertex);
        sign_of([&part, &drive], &vertex.tangent)
    }

    /// Goes on along a vector.
    pub(super) fn follow(&mut self, prepared: &Prepared<'_>, [from, to]: [&Vertex; 2]) {
        self.before = Some((self.or_at(from).sign, *from));
        self.arrive(prepared, to);
    }

    /// Comes to the end of the last vector, which may have been moved since. Where the tool touches at another place there the tangent, which only
    /// goes on within a right angle, does not tell. What goes on along the line that it came along is no corner, though: a tool that turns may touch a
    /// plane with either end there, whose gradients are opposite.
    pub(super) fn arrive(&mut self, prepared: &Prepared<'_>, to: &Vertex) {
        let Some((before, from)) = self.before else { return };
        let same = [0, 1].map(|role| touches_as_before(prepared, [&from, to], role));
        let now = Self::sign_at(to);
        let may_stay = same == [true; 2] && now.is_some() && before != now;
        if may_stay && stays_between(prepared, [&from, to], before) {
            (self.sign, self.is_beyond_corner) = (before, true);
            return;
        }
        let is_kept = same.contains(&false) && before.is_some() && now.is_some();
        (self.sign, self.is_beyond_corner) = (if is_kept { before } else { now }, false);
        if !is_kept || before == now {
            return;
        }
        let Some(left) = (0..2).find(|role| !same[*role] && same[1 - role]) else { return };
        let Some(along) = self.along(&to.part, &to.drive) else { return };
        // Square to both of its gradients is the line that it came along, whatever angle they make; the walls of a neck are all but one line, and the
        // contact leaps between them.
        let (gradient, other) = (gradients(&from)[left], gradients(to)[1 - left]);
        let is_one_line = gradient.dot(&along).abs() <= SAME_LINE_SINE * gradient.cross(&other).norm();
        if is_one_line && !stays_between(prepared, [&from, to], before) {
            self.sign = now;
        } else {
            self.is_beyond_corner = true;
        }
    }

    /// The same, or the sign at a vertex where none is known.
    pub(super) fn or_at(self, vertex: &Vertex) -> Self {
        if self.sign.is_some() { self } else { Self { sign: Self::sign_at(vertex), ..self } }
    }

    /// Whether a direction leads along the surfaces on this hand: onward then, whatever angle it makes with the vector that led there. In a wide
    /// band that may lead from one limit to the other, across the path.
    pub(super) fn leads_along(self, at: &Vertex, direction: &Vec3) -> bool {
        self.along(&at.part, &at.drive).is_some_and(|along| along.dot(direction) > 0.0)
    }

    /// The direction of the path along two contacts, where a hand is known.
    pub(super) fn along(self, part: &Contact, drive: &Contact) -> Option<Vec3> {
        let [part, drive] = [part, drive].map(|contact| contact.gradient.try_normalize(0.0));
        let (sign, across) = (self.sign?, part?.cross(&drive?));
        (across.norm() >= TELLING_SINE).then(|| across.normalize() * sign)
    }
}

impl Stepper<'_> {
    /// The next vertex along the second contact of a corner of one of both surfaces that turns it by about a right angle or more: where it goes on
    /// on the same hand. Two such corners are not as near as the tool may round one. Errors: cancelled.
    pub(super) fn around_sharply(
        &mut self,
        seconds: &[SecondPlace],
        here: &mut Vertex,
        cap: f64,
    ) -> Result<Option<Vertex>, MotionFailure> {
        if self.has_turned_near(here) {
            return Ok(None);
        }
        for direction in self.sharp_directions(seconds, here) {
            if self.turns_before_it_sets_out(here, &direction) {
                continue;
            }
            let known = (self.last, self.came, self.arrived, self.turned);
            (self.last, self.came, self.arrived, self.turned) = (Vec3::zeros(), None, None, None);
            let turned = Vertex { tangent: direction, ..*here };
            self.kept_hand = Some(self.hand.or_at(here));
            let found = self.in_any_place(&turned, cap);
            self.kept_hand = None;
            let next = found?;
            let onward = (self.last, self.came, self.arrived);
            (self.last, self.came, self.arrived, self.turned) = known;
            if let Some(next) = next {
                let straight = self.straight_from(here, seconds, cap)?;
                self.straight = straight.map(|straight| Box::new([*here, straight]));
                (self.last, self.came, self.arrived) = onward;
                (self.turned, self.turned_sharply) = (Some((here.tip, direction)), Some(here.tip));
                *here = turned;
                return Ok(Some(next));
            }
        }
        Ok(None)
    }

    /// The next vertex from where the last vector has ended beyond a corner: its tangent there goes on within a right angle, and leads back into the
    /// place that it has left. Errors: cancelled.
    pub(super) fn beyond_sharply(
        &mut self,
        here: &mut Vertex,
        cap: f64,
    ) -> Result<Option<Vertex>, MotionFailure> {
        if !self.hand.is_beyond_corner {
            return Ok(None);
        }
        self.around_sharply(&[], here, cap)
    }

    /// The hand that vectors keep from where the last one has ended beyond a corner, if that is as near to the last sharp one as the tool may round one:
    /// it turns no second time there, and along its tangent would go back along a leg.
    pub(super) fn hand_between_corners(&self, here: &Vertex) -> Option<Hand> {
        (self.hand.is_beyond_corner && self.has_turned_near(here)).then(|| self.hand.or_at(here))
    }

    /// Whether a tool that turns would go back on a direction, against the one asked for, from where it has hardly set out: no farther from where the motion
    /// began than it may round a corner, and by so little that between both legs it is still in its bands, so that no place tells a corner.
    fn turns_before_it_sets_out(&self, here: &Vertex, direction: &Vec3) -> bool {
        let Prepared { attitude, tip, tangent, part, drive, .. } = self.prepared;
        let leg = tip - here.tip;
        if !attitude.turns() || leg.norm() > self.rounding() || direction.dot(tangent) >= 0.0 {
            return false;
        }
        let within = here.tip + (leg + direction * leg.norm()) * 0.5;
        let is_clear = |(role, contact): (&Working, &Contact)| {
            !role.gauge.on && contact.clearance > role.outside + role.band()
        };
        let tells_corner =
            |place: Vertex| [(part, &place.part), (drive, &place.drive)].into_iter().any(is_clear);
        !Vertex::at(self.prepared, within, direction).is_ok_and(tells_corner)
    }

    /// Whether the path has turned sharply as near to a vertex as the tool may round a corner.
    fn has_turned_near(&self, here: &Vertex) -> bool {
        self.turned_sharply.is_some_and(|at| (here.tip - at).norm() <= self.rounding())
    }

    /// The end of the longest vector straight on into a corner, wherever in the bands it ends. Errors: cancelled.
    fn straight_from(
        &self,
        here: &Vertex,
        seconds: &[SecondPlace],
        cap: f64,
    ) -> Result<Option<Vertex>, MotionFailure> {
        // Beyond the corner the tangent does not lead into it.
        if seconds.is_empty() {
            return Ok(None);
        }
        let found = self.longest_of_all(here, &[here.tangent], cap)?;
        Ok(found.map(|(_, trial)| trial.vertex))
    }

    /// True if a vector would leave the hand that is to be kept on it: it leads back along where the path came from.
    pub(super) fn changes_hand(&self, chord: &Vec3, to: &Vertex) -> bool {
        let along = self.kept_hand.and_then(|hand| hand.along(&to.part, &to.drive));
        along.is_some_and(|along| along.dot(chord) <= 0.0)
    }

    /// True if a vector leads through a neck to the far side of it, where the tool touches the wall that is not the one that it came along: along that the path
    /// leads back on its hand, as beyond a corner, but in a corner the tool comes to the second wall, b·(s·p×a) < 0, and here it goes away from it.
    pub(super) fn goes_through_neck(&self, here: &Vertex, chord: &Vec3, to: &Vertex) -> bool {
        let leads_back =
            self.hand.or_at(here).along(&to.part, &to.drive).is_some_and(|along| along.dot(chord) < 0.0);
        leads_back
            && (0..2).any(|role| {
                !touches_as_before(self.prepared, [here, to], role) && gradients(to)[role].dot(chord) > 0.0
            })
    }

    /// Directions on the same hand that are against that of the path, or so nearly square to it that no vector along them plainly leads onward:
    /// along what is measured here, if the vector that led here ended beyond the corner, and along each second contact with one of both surfaces, unless
    /// the tool is on that, to neither side of it: what it comes next to may as well be the other way of a crossing. A gradient that the law of the axis turns
    /// ahead tells no second contact. Where the tool leads in the direction of motion it cannot turn to lead against it on the spot.
    fn sharp_directions(&self, seconds: &[SecondPlace], here: &Vertex) -> Vec<Vec3> {
        let hand = self.hand.or_at(here);
        let own = hand.is_beyond_corner.then(|| hand.along(&here.part, &here.drive)).flatten();
        let is_on = self.roles().map(|role| role.relation == Relation::On);
        let onward = seconds.iter().filter_map(|SecondPlace { ahead, others }| {
            let (role, left, part, drive) = match others {
                _ if zip(others, is_on).any(|(other, on)| *other && on) => return None,
                [true, false] => (0, &here.part, &ahead.part, &here.drive),
                [false, true] => (1, &here.drive, &here.part, &ahead.drive),
                _ => return None,
            };
            if is_turned_by_law(self.prepared, [here, ahead], role) {
                return None;
            }
            hand.along(part, drive).filter(|along| left.gradient.dot(along) >= 0.0)
        });
        let mut found: Vec<Vec3> = Vec::new();
        for along in own.into_iter().chain(onward) {
            let is_known = found.iter().any(|known| known.dot(&along) > SAME_TANGENT_COSINE);
            let jumps = self.prepared.attitude.jumps_between(&here.tip, &here.tangent, &along);
            if along.dot(&here.tangent) < LEAST_ONWARD && !is_known && !jumps {
                found.push(along);
            }
        }
        found
    }

    /// A vector that goes on along the tangent of a vertex, wherever in the bands it ends. Errors: cancelled.
    pub(super) fn in_any_place(&mut self, here: &Vertex, cap: f64) -> Result<Option<Vertex>, MotionFailure> {
        for places in [Places::Limits, Places::Level] {
            self.trend.forget();
            match self.onward(here, cap, places) {
                Ok(next) if next.tangent.dot(&here.tangent) >= 0.0 => return Ok(Some(next)),
                Err(MotionFailure::Cancelled) => return Err(MotionFailure::Cancelled),
                _ => {}
            }
        }
        self.trend.forget();
        let Some((_, found)) = self.longest_of_all(here, &[here.tangent], cap)? else { return Ok(None) };
        self.follow(&here.tip, &found);
        self.trend.forget();
        let next = found.vertex;
        self.latest = Some(found);
        Ok(Some(next))
    }
}

//! A vector into a corner that turns the path by more than vectors turn it elsewhere. About the place where the tool touches a surface at two
//! places at once, each clearance in its band, the bands make a parallelogram, and it belongs to both legs: whatever is in the band of one
//! wall and no deeper in the other one is convex where both are straight, so that from any place of it all of each leg is seen. One vertex
//! there does for the corner, however the path turns; short of it and beyond there is none that does.

use apt_geometry::{Vec3, motion::Relation};

use super::{
    CORNER_BANDS, Stepper, Trial,
    attempt::{LEAST_TURN_COSINE, LeastCosines},
    hand::{Hand, SAME_CONTACT_COSINE},
};
use crate::{
    clearance::Contact,
    directed::march::Vertex,
    position,
    role::{Bend, GUARD, Working},
};

/// Share of the bands that a vector sags at least which is as long as its bend lets it be; one that sags less and is not as long as
/// is allowed ends where something is in its way.
const SAGS: f64 = 0.5;
/// How many times the length of such a vector a corner is looked for ahead of it: the ladder of lengths goes by quarters.
const LOOKED_AHEAD: f64 = 4.0;
/// How many times that way is halved to come near to the corner.
const MOST_HALVED: u32 = 8;
/// Distance from a corner, in bands, at which the contacts along its legs are measured, where neither is in the other's way.
const BESIDE: f64 = 4.0;
/// Bound of the corrections for the corner, and the last of them as a share of the bands at most.
const CORRECTIONS: u32 = 6;
const SETTLED: f64 = 1e-3;
/// By how much of the band the tool is nearer to the second wall than to the first one, so that that is what it touches.
const NEARER: f64 = 0.05;
/// How many bands a vector is long that is to lead on.
const WAY_ON: f64 = 4.0;
/// Rounding of the cosine of the angle by which a corner turns the path.
const ROUNDING: f64 = 1e-9;
/// Share by which a vector into the corner is to be longer than the one that is known.
const LONGER: f64 = 1e-3;

/// What is touched in a corner ahead: part and drive surface along the first leg, and the one that turns along the second.
struct Ahead {
    role: usize,
    before: [Contact; 2],
    beyond: Contact,
    /// About where it is.
    at: Vec3,
    hand: Hand,
}

impl Ahead {
    /// The contacts along the second leg.
    fn contacts_beyond(&self) -> [Contact; 2] {
        let mut contacts = self.before;
        contacts[self.role] = self.beyond;
        contacts
    }

    /// The directions of both legs.
    fn legs(&self) -> Option<[Vec3; 2]> {
        let [part, drive] = self.before;
        let [part_beyond, drive_beyond] = self.contacts_beyond();
        Some([self.hand.along(&part, &drive)?, self.hand.along(&part_beyond, &drive_beyond)?])
    }
}

/// Where in the bands a vertex in a corner is: from the surface that turns, along both legs, and from the other one.
#[derive(Clone, Copy)]
struct Place {
    first: f64,
    second: f64,
    other: f64,
}

impl Stepper<'_> {
    /// The vector into a sharp corner ahead of the vector found last, or of a place without a way on, if it leads farther.
    pub(super) fn towards_sharp_corner(
        &mut self,
        here: &Vertex,
        cap: f64,
        known: Option<&Trial>,
    ) -> Option<Trial> {
        if !self.may_have_corners() || known.is_some_and(|known| !self.is_hindered(known, cap)) {
            return None;
        }
        let (from, reach, least) = match known {
            // One that ends beyond the corner, within the bands there, is not worth more than the corner: nothing, where it goes on into a narrow wedge from which the path
            // turns back.
            Some(known) if is_elsewhere(here, &known.vertex) => {
                let spared = if self.goes_against_hand(here, known) { known.length } else { self.bands() };
                (*here, LOOKED_AHEAD * known.length, known.length - spared)
            }
            Some(known) => (known.vertex, LOOKED_AHEAD * known.length, known.length * (1.0 + LONGER)),
            None => (*here, CORNER_BANDS * self.bands(), 0.0),
        };
        let least = least.max(self.least_vector(&here.tip));
        let ahead = self.sharp_corner_ahead(&from, reach.min(cap))?;
        let bends = self.bends_of_legs(here, &ahead);
        self.places_in(here, &ahead, &bends)
            .into_iter()
            .find_map(|place| {
                let (ahead, vertex) = self.vertex_in(&ahead, place)?;
                let [first, _] = ahead.legs()?;
                let mut trial = self.judge(
                    here,
                    Vertex { tangent: first, ..vertex },
                    &bends[0],
                    LeastCosines::ROUND_CORNER,
                )?;
                trial.vertex.tangent = vertex.tangent;
                let fits = trial.proven && trial.length >= least && trial.length <= cap * (1.0 + 1e-9);
                let leads_on = || {
                    let length = (WAY_ON * self.bands()).min(cap);
                    self.leads_on(
                        &trial.vertex,
                        length,
                        cap,
                        (self.targets_of(&bends[1], &vertex), &bends[1]),
                    )
                };
                if !fits || !leads_on() {
                    return None;
                }
                trial.is_at_corner = true;
                Some((trial, self.straight_through(&ahead, place, &vertex)))
            })
            .map(|(trial, straight)| {
                self.beyond_corner = straight.map(|straight| (trial.vertex.tip, Box::new(straight)));
                trial
            })
    }

    /// Whether the path leads back on its hand from where a vector ends, against the direction in which it would go on.
    fn goes_against_hand(&self, here: &Vertex, found: &Trial) -> bool {
        let Vertex { part, drive, tangent, .. } = &found.vertex;
        self.hand.or_at(here).along(part, drive).is_some_and(|along| along.dot(tangent) < 0.0)
    }

    /// True if nothing of what bends along a vector keeps it from being longer.
    fn is_hindered(&self, found: &Trial, cap: f64) -> bool {
        let sags = |(role, bend): (&Working, f64)| {
            bend.abs() * found.length * found.length / 8.0 > SAGS * role.band()
        };
        !found.is_at_corner
            && found.length < cap * (1.0 - 1e-6)
            && !self.roles().into_iter().zip(found.curvature).any(sags)
    }

    /// The corner that is ahead of a place within a distance, if it turns the path so much.
    fn sharp_corner_ahead(&self, from: &Vertex, reach: f64) -> Option<Ahead> {
        let is_other = |at: &Vertex| [differs(&from.part, &at.part), differs(&from.drive, &at.drive)];
        let mut way = reach.max(BESIDE * self.bands());
        let mut found: Option<(Vertex, usize)> = None;
        for _ in 0..MOST_HALVED {
            let at = Vertex::at(self.prepared, from.tip + from.tangent * way, &from.tangent).ok()?;
            match is_other(&at) {
                [true, false] => found = Some((at, 0)),
                [false, true] => found = Some((at, 1)),
                [true, true] => found = None,
                [false, false] if found.is_some() => break,
                [false, false] => {}
            }
            way *= 0.5;
        }
        let (at, role) = found?;
        // Where both walls are nearly one line they meet far from where lines along them do that are told from far away.
        self.sharp_corner_between([from, &at], role).or_else(|| {
            let [before, beyond] = self.about_leap([from, &at], role)?;
            self.sharp_corner_between([&before, &beyond], role)
        })
    }

    /// Places nearer to where the contact with the surface of a role leaps, on the way between two places that are touched elsewhere, and no nearer than the legs beside
    /// the corner are measured.
    fn about_leap(&self, [from, at]: [&Vertex; 2], role: usize) -> Option<[Vertex; 2]> {
        let mut ends = [*from, *at];
        for _ in 0..MOST_HALVED {
            if (ends[1].tip - ends[0].tip).norm() <= BESIDE * self.bands() {
                break;
            }
            let middle = 0.5 * (ends[0].tip + ends[1].tip);
            let middle = Vertex::at(self.prepared, middle, &from.tangent).ok()?;
            let is_beyond = differs(&[from.part, from.drive][role], &[middle.part, middle.drive][role]);
            ends[usize::from(is_beyond)] = middle;
        }
        Some(ends)
    }

    /// The corner between two places that touch the surface of a role elsewhere, if it turns the path so much.
    fn sharp_corner_between(&self, [from, at]: [&Vertex; 2], role: usize) -> Option<Ahead> {
        let before = [from.part, from.drive];
        let beyond = [at.part, at.drive][role];
        let hand = self.hand.or_at(from);
        let ahead = Ahead { role, before, beyond, at: at.tip, hand };
        let middle = |role: &Working| 0.5 * (role.outside - role.inside);
        let [this, other] = self.roles_by(role);
        // On a surface the tool keeps to neither side of it, as in `sharp_directions`.
        if this.relation == Relation::On {
            return None;
        }
        let place =
            Place { first: middle(this), second: middle(this) - NEARER * this.band(), other: middle(other) };
        let start = meeting(&ahead, [from.tip, at.tip, from.tip], place);
        let (ahead, _) = self.vertex_in(&Ahead { at: start, ..ahead }, place)?;
        let [first, second] = ahead.legs()?;
        let is_sharp = first.dot(&second) <= LEAST_TURN_COSINE + ROUNDING;
        (first.dot(&from.tangent) > 0.0 && is_sharp).then_some(ahead)
    }

    /// The role that turns and the other one.
    fn roles_by(&self, role: usize) -> [&Working; 2] {
        let [part, drive] = self.roles();
        if role == 0 { [part, drive] } else { [drive, part] }
    }

    /// The vertex at a place in the bands of a corner, on the second leg as it is there, with what is touched, by Newton's method on all three
    /// contacts.
    fn vertex_in(&self, ahead: &Ahead, place: Place) -> Option<(Ahead, Vertex)> {
        let beside = BESIDE * self.bands();
        let mut ahead = Ahead { ..*ahead };
        for _ in 0..CORRECTIONS {
            let [first, second] = ahead.legs()?;
            let tips = [ahead.at - first * beside, ahead.at + second * beside, ahead.at];
            let before = Vertex::at(self.prepared, tips[0], &first).ok()?;
            let beyond = Vertex::at(self.prepared, tips[1], &second).ok()?;
            let there = Vertex::at(self.prepared, tips[2], &second).ok()?;
            let pick = |vertex: &Vertex, role: usize| [vertex.part, vertex.drive][role];
            let role = ahead.role;
            let (a, b, p) = (pick(&before, role), pick(&beyond, role), pick(&there, 1 - role));
            if differs(&a, &ahead.before[role])
                || differs(&b, &ahead.beyond)
                || differs(&p, &ahead.before[1 - role])
            {
                return None;
            }
            (ahead.before[role], ahead.before[1 - role], ahead.beyond) = (a, p, b);
            let at = meeting(&ahead, tips, place);
            let moved = (at - ahead.at).norm();
            ahead.at = at;
            if moved <= SETTLED * self.bands() {
                let [_, second] = ahead.legs()?;
                let vertex = Vertex::at(self.prepared, at, &second).ok()?;
                let is_touched = !differs(&pick(&vertex, role), &b);
                return is_touched.then_some((ahead, vertex));
            }
        }
        None
    }

    /// How the clearances bend along both legs.
    fn bends_of_legs(&self, here: &Vertex, ahead: &Ahead) -> [[Bend; 2]; 2] {
        let Some([_, second]) = ahead.legs() else { return [[Bend::Straight; 2]; 2] };
        let rate = |from: &[Contact; 2], to: &[Contact; 2], way: Vec3| {
            [0, 1].map(|k: usize| {
                (to[k].gradient - from[k].gradient).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)
            })
        };
        let until = rate(&[here.part, here.drive], &ahead.before, ahead.at - here.tip);
        let beside = second * (BESIDE * self.bands());
        let far = Vertex::at(self.prepared, ahead.at + beside * 2.0, &second);
        let onward =
            far.map_or([0.0; 2], |far| rate(&ahead.contacts_beyond(), &[far.part, far.drive], beside));
        [self.bends(&until), self.bends(&onward)]
    }

    fn targets_of(&self, bends: &[Bend; 2], from: &Vertex) -> [f64; 2] {
        self.targets(from, bends, super::Places::Limits)
    }

    /// The places in the bands of a corner that are tried: at the limits opposite to the sags of both legs, then where the first leg is kept
    /// on its level, and as far into the second one as that may be. From within these bands little but that leads onward.
    fn places_in(&self, here: &Vertex, ahead: &Ahead, [until, onward]: &[[Bend; 2]; 2]) -> [Place; 4] {
        let k = ahead.role;
        let [role, other] = self.roles_by(k);
        let held = [here.part.clearance, here.drive.clearance];
        let [deepest, highest] = [GUARD * role.band() - role.inside, role.outside - GUARD * role.band()];
        let level = held[k].min(highest).max(deepest);
        let middle = 0.5 * (role.outside - role.inside);
        let other = other.vertex(until[1 - k]);
        let limits = [role.vertex(until[k]), role.vertex(onward[k])];
        [limits, [level, middle], [level, deepest], [middle, deepest]].map(|[first, second]| {
            let nearer = NEARER * role.band();
            let first = first.min(highest).max(deepest + nearer);
            Place { first, second: second.min(first - nearer).max(deepest), other }
        })
    }

    /// Where the path turns back: how far a vector leads straight on into the corner.
    fn straight_through(&self, ahead: &Ahead, place: Place, vertex: &Vertex) -> Option<[Vertex; 2]> {
        let [first, second] = ahead.legs()?;
        if first.dot(&second) > 0.0 {
            return None;
        }
        let [role, _] = self.roles_by(ahead.role);
        let (_, end) = self.vertex_in(ahead, Place { second: GUARD * role.band() - role.inside, ..place })?;
        let [from, to] = [*vertex, end].map(|vertex| Vertex { tangent: first, ..vertex });
        self.proven(&from, &to).then_some([from, to])
    }
}

/// Whether the tool touches one of both surfaces at another place at a vertex than at another one.
pub(super) fn is_elsewhere(one: &Vertex, other: &Vertex) -> bool {
    differs(&one.part, &other.part) || differs(&one.drive, &other.drive)
}

/// Whether two contacts are at different places of a surface.
fn differs(a: &Contact, b: &Contact) -> bool {
    a.gradient.dot(&b.gradient) < SAME_CONTACT_COSINE
}

/// Where three clearances are as wanted that are known, with their gradients, at a place each: from the surface that turns, before and beyond, and from
/// the other one.
fn meeting(ahead: &Ahead, tips: [Vec3; 3], place: Place) -> Vec3 {
    let contacts = [ahead.before[ahead.role], ahead.beyond, ahead.before[1 - ahead.role]];
    let wanted = [place.first, place.second, place.other];
    let residual = [0, 1, 2]
        .map(|k: usize| contacts[k].clearance + contacts[k].gradient.dot(&(tips[2] - tips[k])) - wanted[k]);
    tips[2] + position::correction_of_three(residual, contacts.map(|contact| contact.gradient))
}

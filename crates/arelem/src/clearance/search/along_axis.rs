//! A flank that lies along a surface, as that of a tool whose axis goes along the rulings of a wall.
//!
//! Balls about the axis that touch the flank hold the tool, and their distances are those of places of one line, less the radii: a proof
//! for the line takes far fewer looks than one for the boundary. At a contact whose normal leans by ε from that of the flank the ball
//! there reaches over the flank's end by about ε²/2 of its radius; so the short piece of flank about it, as long as ε radii, is left to
//! patches.

use std::cell::{Cell, RefCell};

use apt_geometry::{
    Vec3,
    surface::{Bend, Foot, Lying, Surface},
};

use super::{super::nearly_straight, Certificate, Search};
use crate::clearance::{
    Contact, Tool,
    certify::{Effort, Face, Proof, certify, downward_bend},
    floor::{Base, Bases, Course},
    patch::{boundary, flank_between},
};

/// How far (radians) the normal of a contact may lean from that of the flank.
const LEANING: f64 = 0.2;
/// The same of a contact with the corner where the flank begins: one that leans more is told by patches in few looks.
const LEANING_AT_CORNER: f64 = 1e-4;
/// Bound of the stretches of the axis that are looked at.
const MOST_STRETCHES: u32 = 200;
/// How much shorter than where it was told a stretch is before it is told anew how it bends.
const FINER: f64 = 1.0 / 32.0;
/// Length of the piece of flank that is left to patches: in radii for each radian that the contact leans, and at least as a share of the
/// flank.
const LEFT: f64 = 2.0;
const LEAST_LEFT: f64 = 1.0 / 1024.0;
/// How far the nearest places of a stretch may be beside the ruling through that of its middle, as shares of half the stretch.
const BESIDE: [f64; 2] = [1.0 / 64.0, 1.0 / 4.0];
/// Bound of the pieces that are left: more lie along the surface.
const MOST_LEFT: usize = 4;
/// How much farther than asked it is told how distances bend, and how many such answers are kept.
const WIDER: f64 = 1.25;
const MOST_KEPT: usize = 32;
/// For how many contacts balls are not asked at most.
const LONGEST_PAUSE: u32 = 16;
/// How much larger a ball without a close bound may be than one that is held to have none either.
const SAME: f64 = 1.5;
/// How far, relative to its radius, a ball may fail to hold what is below it: rounding.
const ROUNDING: f64 = 1e-12;

/// The balls about the axis that touch the flank.
struct Core {
    /// Sine and cosine of the angle between flank and axis.
    lean: [f64; 2],
    /// Height of a centre, the radius there, and heights of the first and the last centre.
    height: f64,
    radius: f64,
    range: [f64; 2],
    /// Whether the first ball holds all of the tool below the flank.
    holds_end: bool,
}

impl Core {
    /// None if the tool has no flank with a body.
    fn of(tool: &Tool) -> Option<Self> {
        let profile = &tool.profile;
        let (upper, top) = (profile.upper, profile.top);
        let (out, up) = (top.radius - upper.radius, top.height - upper.height);
        let length = out.hypot(up);
        if up <= 0.0 || upper.radius <= 0.0 {
            return None;
        }
        let [sine, cosine] = [out / length, up / length];
        // The centre whose ball touches the flank where that begins.
        let height = upper.height + upper.radius * sine / cosine;
        let radius = upper.radius / cosine;
        let range = [height, top.height + top.radius * sine / cosine];
        let away = |radius: f64, at: f64| radius.hypot(at - height);
        let (lower, center) = (profile.lower, profile.center);
        let corner = if profile.is_barrel() {
            let beyond = profile.beyond_corner();
            away(beyond.radius, beyond.height)
        } else if profile.arc > 0.0 {
            away(center.radius, center.height) + profile.arc
        } else {
            0.0
        };
        let below = [away(0.0, 0.0), away(lower.radius, lower.height), corner];
        let holds_end = below.into_iter().all(|reach| reach <= radius * (1.0 + ROUNDING));
        Some(Self { lean: [sine, cosine], height, radius, range, holds_end })
    }

    fn radius_at(&self, height: f64) -> f64 {
        self.radius + (height - self.height) * self.lean[0]
    }

    /// Height at which the ball about a height touches the flank.
    fn touched_at(&self, height: f64) -> f64 {
        height - self.radius_at(height) * self.lean[0]
    }
}

impl Search<'_> {
    /// What balls about the axis, and patches where these do not, show of a level for a contact on the flank; they are not asked for some
    /// contacts after they have been in vain.
    pub(super) fn certified_along_axis(&self, level: f64, courses: &Courses) -> Certificate {
        if !self.surface.has_charts() || !courses.is_worthwhile() {
            return Certificate::Undecided;
        }
        let found = self.by_balls(level, courses);
        courses.note(found != Certificate::Undecided);
        found
    }

    fn by_balls(&self, level: f64, courses: &Courses) -> Certificate {
        let (Some(core), Some(contact)) = (Core::of(self.tool), self.best.contact) else {
            return Certificate::Undecided;
        };
        let leaning = (contact.gradient.dot(&self.tool.axis) - core.lean[0]).abs();
        let height = (contact.tool - self.tip).dot(&self.tool.axis);
        let size = self.tool.profile.top.height;
        let is_on_flank = height >= self.tool.profile.upper.height - ROUNDING * size;
        if leaning > if is_on_flank { LEANING } else { LEANING_AT_CORNER } {
            return Certificate::Undecided;
        }
        let [first, last] = core.range;
        let least = (LEFT * leaning * self.tool.radius()).max(LEAST_LEFT * (last - first));
        let left = match self.left_of_axis(&core, (level, least), courses) {
            Left::Pieces(left) => left,
            Left::Lower(point) => return Certificate::Lower(point),
            Left::Much => return Certificate::Undecided,
        };
        let ends_in = left.iter().any(|[from, _]| *from <= first);
        let mut patches: Vec<_> = Vec::with_capacity(8);
        if !core.holds_end || ends_in {
            // Of the boundary the flank is the first.
            patches.extend(boundary(self.tool).into_iter().skip(1));
        }
        patches.extend(left.iter().map(|ends| flank_between(self.tool, ends.map(|t| core.touched_at(t)))));
        if patches.is_empty() {
            return Certificate::Holds;
        }
        let Self { tool, surface, side, tip, .. } = *self;
        let bases = Bases::about(tool, tip, (surface, side), &contact.tool);
        let face = Face { surface, side };
        certify(face, tool, tip, level, &mut Proof::of(patches), Some(&bases), Effort::All)
    }

    /// The pieces of the axis of whose balls a level is not shown, none longer than `least`.
    fn left_of_axis(&self, core: &Core, (level, least): (f64, f64), courses: &Courses) -> Left {
        let mut open = vec![(core.range, Known::NOTHING)];
        let mut left: Vec<[f64; 2]> = Vec::new();
        let mut looks = 0;
        while let Some(([from, to], mut known)) = open.pop() {
            looks += 1;
            if looks > MOST_STRETCHES || self.is_given_up() {
                return Left::Much;
            }
            let middle = 0.5 * (from + to);
            let ball = self.ball(core, middle);
            if self.is_above(core, &ball, (0.5 * (to - from), level), (&mut known, courses)) {
                continue;
            }
            if let Some(point) = self.lower_on_flank(core, &ball, level) {
                return Left::Lower(point);
            }
            if to - from > least {
                open.extend([([middle, to], known), ([from, middle], known)]);
                continue;
            }
            match left.last_mut() {
                Some(before) if before[1] >= from => before[1] = to,
                _ => left.push([from, to]),
            }
            if left.len() > MOST_LEFT {
                return Left::Much;
            }
        }
        Left::Pieces(left)
    }

    /// The ball about a height of the axis.
    fn ball(&self, core: &Core, height: f64) -> Ball {
        let place = self.tip + self.tool.axis * height;
        let foot = self.surface.foot(&place);
        let base = Base { place, distance: self.side * foot.distance, gradient: foot.normal * self.side };
        Ball { height, base, foot, clearance: base.distance - core.radius_at(height) }
    }

    /// The point of the flank where a ball that is below a level touches it, if that is lower.
    fn lower_on_flank(&self, core: &Core, ball: &Ball, level: f64) -> Option<Contact> {
        if ball.clearance >= level {
            return None;
        }
        let Self { tool, surface, side, tip, .. } = *self;
        let radius = core.radius_at(ball.height) * core.lean[1];
        let outward = tool.split(&ball.base.gradient).2;
        let point = tip + tool.axis * core.touched_at(ball.height) - outward * radius;
        let foot = surface.foot(&point);
        let gradient = foot.normal * side;
        let contact = Contact { clearance: side * foot.distance, gradient, tool: point, surface: foot.point };
        (contact.clearance < level).then_some(contact)
    }

    /// Whether the balls of a stretch of the axis about the middle one keep a level, and what is known of it then.
    fn is_above(
        &self,
        core: &Core,
        Ball { height, base, foot, clearance }: &Ball,
        (half, level): (f64, f64),
        (known, courses): (&mut Known, &Courses),
    ) -> bool {
        let margin = clearance - level;
        let slope = base.gradient.dot(&self.tool.axis) - core.lean[0];
        if margin >= half * (1.0 + core.lean[0].abs()) {
            return true;
        }
        let room = margin - slope.abs() * half;
        if room <= 0.0 {
            return false;
        }
        let is_shown = |known: &Known| 0.5 * known.bend * half * half <= room;
        if is_shown(known) {
            return true;
        }
        // A shorter stretch may bend less, but not much: it is cut instead.
        if !known.is_close || half <= FINER * known.half {
            *known = self.known_along_axis(base, foot, half, courses);
        }
        let smallest = core.radius_at(height - half).min(core.radius_at(height + half));
        let may_lie = known.is_close && level + smallest > 0.0;
        is_shown(known)
            || may_lie && self.bends_little(base, foot, half, (known.bend, 2.0 * room / (half * half)))
    }

    /// How the distance bends at most downward along the axis within reach of a place of it.
    fn known_along_axis(&self, base: &Base, foot: &Foot, half: f64, courses: &Courses) -> Known {
        let Self { tool, surface, side, .. } = *self;
        // Of a ruled surface it is asked how it bends along the axis, not more closely here.
        let is_apt = nearly_straight::is_apt(surface) && !matches!(surface, Surface::Ruled(_));
        let known = |course: Option<Course>| {
            let bend = course.map_or(f64::INFINITY, |course| course.bend_along(&tool.axis));
            let is_close = course.is_some_and(|course| course.straight.is_some() || !is_apt);
            Known { bend, half, is_close }
        };
        if let Some(course) = courses.about(side, &base.place, half) {
            return known(course);
        }
        // More than is asked, for the next positions.
        let reach = WIDER * half;
        let keep =
            |course: Option<Course>| courses.keep(Kept { side, center: base.place, radius: reach, course });
        let face = Face { surface, side };
        let Bend::AtMost(bend) = downward_bend(face, tool, foot, (&base.place, reach)) else {
            keep(None);
            return known(None);
        };
        let along = tool.axis - base.gradient * base.gradient.dot(&tool.axis);
        let course = along
            .try_normalize(0.0)
            .filter(|_| is_apt)
            .and_then(|along| Course::nearly_straight(face, tool, &along, base, [reach, bend]))
            .unwrap_or_else(|| Course::along_generator(bend, None));
        keep(Some(course));
        known(Some(course))
    }

    /// Whether the distance from a ruled surface bends downward along the axis by no more than is enough within a stretch of it about a
    /// place, in a ball about which distances bend by no more than `bend`, and nearest places do not jump: so that these are no farther apart than
    /// places times `1 + d bend`, d being the greatest distance.
    fn bends_little(&self, base: &Base, foot: &Foot, half: f64, (bend, enough): (f64, f64)) -> bool {
        let Self { tool, surface, side, .. } = *self;
        let slope = base.gradient.dot(&tool.axis).abs();
        // No farther than from the nearest place of the middle.
        let depth = (base.distance * base.distance + half * (half + 2.0 * base.distance * slope)).sqrt();
        let reach = half * (1.0 + depth * bend);
        BESIDE.into_iter().any(|share| {
            let asked = Lying { along: tool.axis, half, depth, enough, beside: share * half };
            surface.bends_little_along(side, &foot.point, reach, asked, tool.patience)
        })
    }
}

/// What balls about the axis leave of a flank.
enum Left {
    /// Pieces of the axis.
    Pieces(Vec<[f64; 2]>),
    /// A point of the flank that is lower.
    Lower(Contact),
    /// Too much.
    Much,
}

/// A ball about a height of the axis, with what the surface tells of that place.
struct Ball {
    height: f64,
    base: Base,
    foot: Foot,
    clearance: f64,
}

/// How the distance bends along a stretch of the axis.
#[derive(Debug, Clone, Copy)]
struct Known {
    bend: f64,
    /// Half the stretch.
    half: f64,
    /// Whether a shorter stretch would not be told of much less.
    is_close: bool,
}

impl Known {
    const NOTHING: Self = Self { bend: f64::INFINITY, half: f64::INFINITY, is_close: false };
}

/// How distances from a surface bend in a ball.
#[derive(Debug, Clone, Copy)]
struct Kept {
    side: f64,
    center: Vec3,
    radius: f64,
    /// None where there is no bound.
    course: Option<Course>,
}

/// How distances from a surface bend in some balls, the last ones in turn.
#[derive(Debug, Clone, Default)]
pub(in crate::clearance) struct Courses {
    kept: RefCell<(usize, Vec<Kept>)>,
    /// For how many contacts balls are not asked, and for how many when that is in vain again.
    pause: Cell<[u32; 2]>,
}

impl Courses {
    /// What is known of a ball: one that is almost where there was no close bound has none either.
    fn about(&self, side: f64, center: &Vec3, radius: f64) -> Option<Option<Course>> {
        let kept = self.kept.try_borrow().ok()?;
        let holds = |kept: &&Kept| kept.side == side && (center - kept.center).norm() + radius <= kept.radius;
        let is_close = |kept: &Kept| kept.course.is_some_and(|course| course.straight.is_some());
        let far = |kept: &Kept| if is_close(kept) { FINER.recip() } else { SAME };
        let tells = |kept: &&Kept| holds(kept) && kept.radius <= far(kept) * radius;
        let tightest = kept.1.iter().filter(tells).min_by(|a, b| a.radius.total_cmp(&b.radius));
        tightest.map(|kept| kept.course)
    }

    /// Whether balls are asked about a contact.
    fn is_worthwhile(&self) -> bool {
        let [pause, next] = self.pause.get();
        self.pause.set([pause.saturating_sub(1), next]);
        pause == 0
    }

    /// Notes whether they showed anything.
    fn note(&self, is_shown: bool) {
        let next = (2 * self.pause.get()[1]).clamp(1, LONGEST_PAUSE);
        self.pause.set(if is_shown { [0; 2] } else { [next; 2] });
    }

    fn keep(&self, new: Kept) {
        let Ok(mut all) = self.kept.try_borrow_mut() else { return };
        let (next, kept) = &mut *all;
        match kept.get_mut(*next) {
            Some(place) => *place = new,
            None => kept.push(new),
        }
        *next = (*next + 1) % MOST_KEPT;
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::{cutter::Cutter, surface::Surface};

    use super::{super::Best, *};
    use crate::{clearance::Enough, tests::v, verify::tests::lofts};

    /// What balls show of the level of a contact holds for all of the flank, and they show it of most tools that lie along a surface.
    #[test]
    fn no_place_of_a_flank_is_below_a_level_that_is_shown() {
        let (mut shown, mut lower, mut left) = (0, 0, 0);
        for (geometry, numbers) in [lofts::roof(), lofts::vault()]
            .iter()
            .flat_map(|geometry| TOOLS.map(|numbers| (geometry, numbers)))
        {
            let surface = Surface::from_geometry(geometry).expect("a surface");
            let cutter = Cutter::from_numbers(numbers, 1.0).expect("a cutter");
            let side = surface.foot(&v(0.0, 0.0, 9.0)).distance.signum();
            for k in 0..60 {
                let turn = 0.1 * f64::from(k);
                let foot = surface.foot(&v(0.4 * turn.cos(), 0.4 * turn.sin(), 2.0));
                let normal = foot.normal * side;
                let across = v(turn.sin(), turn.cos(), 0.0);
                let lying = (across - normal * normal.dot(&across)).normalize();
                let tool = Tool::new(cutter, (lying + normal * (0.02 * f64::from(k % 5))).normalize());
                let tip = foot.point + normal * 0.6 - tool.axis * 0.5;
                let face = Face { surface: &surface, side };
                let contact = super::super::contact(&tool, face, &tip, (None, None), Enough::ALL).0;
                let best = Best { value: contact.clearance, contact: Some(contact), piece: 0 };
                let search = Search { tool: &tool, surface: &surface, side, tip: &tip, best, piece: 0 };
                let least = least_of_flank(&search);
                for (level, is_level) in [(contact.clearance - 1e-7, true), (contact.clearance + 1e-3, false)]
                {
                    match search.certified_along_axis(level, &Courses::default()) {
                        Certificate::Holds => {
                            assert!(is_level && least >= level, "{k}, {numbers:?}: {least} below {level}");
                            shown += 1;
                        }
                        Certificate::Lower(point) => {
                            let own = side * surface.foot(&point.tool).distance;
                            assert!(own < level && !is_level, "{k}, {numbers:?}: {own} not below {level}");
                            lower += 1;
                        }
                        Certificate::Undecided => left += 1,
                    }
                }
            }
        }
        assert!(shown > 100 && lower > 100 && left < 300, "{shown} shown, {lower} lower, {left} left");
    }

    const TOOLS: [&[f64]; 4] = [
        &[0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 2.0],
        &[0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 2.0],
        &[0.6, 0.1, 0.2, 0.1, 0.0, 0.0, 2.0],
        &[0.5, 0.0, 0.25, 0.0, 0.0, 6.0, 2.0],
    ];

    fn least_of_flank(search: &Search<'_>) -> f64 {
        let (upper, top) = (search.tool.profile.upper, search.tool.profile.top);
        let mut least = f64::INFINITY;
        for i in 0..=40 {
            let share = f64::from(i) / 40.0;
            let radius = upper.radius + share * (top.radius - upper.radius);
            let height = upper.height + share * (top.height - upper.height);
            for k in 0..72 {
                let point = search.point(radius, height, f64::from(k) * std::f64::consts::TAU / 72.0);
                least = least.min(search.side * search.surface.signed_distance(&point));
            }
        }
        least
    }
}

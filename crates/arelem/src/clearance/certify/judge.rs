//! What is known of the distance over one patch: from its middle, from the base, by an empty ball above it, and by how it bends along a
//! straight piece.

use std::f64::consts::{FRAC_PI_2, PI};

use apt_geometry::{
    Vec3,
    surface::{Bend, Foot},
};

#[cfg(test)]
use super::JUDGED;
use super::{Bending, Ground, Leaf, Question, downward_bend};
use crate::clearance::{
    Contact, Tool,
    empty::Empty,
    floor::{Base, Course},
    nearly_straight,
    patch::{Middle, Patch, Stretch},
};

/// How many times as far off a surface as a patch needs it the middle of an empty ball is looked for.
const AFAR: f64 = 2.0;
/// Distance of a base from the middle of a patch, in reaches of the patch, up to which it is tried.
const BESIDE: f64 = 3.0;

/// What is known of the distance over a patch.
pub(super) struct Judged {
    /// No point of the patch is nearer to the surface.
    pub(super) least: f64,
    /// A point of the tool with its distance.
    pub(super) sample: Contact,
    /// Length of the patch along the profile, as far as the surface tells it from nothing.
    pub(super) length: f64,
}

/// A patch that is looked at, with the place of the surface nearest to its middle.
struct Look<'a> {
    question: &'a Question<'a>,
    patch: &'a Patch,
    middle: Middle,
    foot: Foot,
    /// The distance in the middle.
    own: Base,
    /// What is known of the bend from before.
    before: Option<Bending>,
}

impl Look<'_> {
    /// How strongly the distance bends downward within a distance of the middle.
    fn bend_within(&self, radius: f64) -> Bend {
        let Self { question, middle, foot, before, .. } = self;
        let known =
            before.filter(|ground| question.away(&middle.place, &ground.center) + radius <= ground.radius);
        known.map_or_else(
            || downward_bend(question.face, question.tool, foot, (&middle.place, radius)),
            |ground| Bend::AtMost(ground.course.bend),
        )
    }

    /// The least distance for a bend, from the base for the patch or its own middle.
    fn least_from(&self, base: &Base, bend: f64, is_own: bool) -> f64 {
        let Self { question, patch, middle, .. } = self;
        if is_own {
            question.least_about(patch, base, bend, middle)
        } else {
            question.least(patch, base, question.course(bend)) - middle.ball
        }
    }

    /// The bend about the middle, and the ground on which that or the bend about the base for the patch shows the most.
    fn judge_bends(&self, judged: &mut Judged) -> (Bend, Option<Bending>) {
        let Self { question, middle: Middle { place, ball, reach, round, .. }, own, .. } = *self;
        let bend = if round { Bend::Unbounded } else { self.bend_within(reach) };
        let mut ground = None;
        if let Bend::AtMost(bend) = bend {
            judged.least = judged.least.max(self.least_from(&own, bend, true));
            ground = Some(Bending { base: own, center: place, radius: reach, course: question.course(bend) });
        }
        let tried = round || ground.is_some();
        if judged.least < question.level
            && let Some(base) = question.base(ball).filter(|_| tried)
        {
            let away = question.away(&base.place, &place);
            let bend = match bend {
                Bend::AtMost(bend) if away <= reach => Bend::AtMost(bend),
                _ if away <= BESIDE * reach => self.bend_within(away.max(reach)),
                _ => Bend::Unbounded,
            };
            if let Bend::AtMost(bend) = bend {
                judged.least = judged.least.max(self.least_from(&base, bend, false));
                let (radius, course) = (away.max(reach), question.course(bend));
                ground = Some(Bending { base, center: place, radius, course });
            }
        }
        (bend, ground)
    }

    /// More ground for the next positions, if it bears as well.
    fn widened(&self, ground: Bending) -> Bending {
        let Self { question, middle, foot, .. } = self;
        let radius = ground.radius + question.spread;
        match downward_bend(question.face, question.tool, foot, (&middle.place, radius)) {
            Bend::AtMost(bend) if self.least_from(&ground.base, bend, false) >= question.level => {
                Bending { radius, course: question.course(bend), ..ground }
            }
            _ => ground,
        }
    }
}

impl Question<'_> {
    /// The distance over a patch from its middle, and from the base, as far as the level needs it; and on what ground.
    pub(super) fn judge(&self, leaf: &Leaf) -> (Judged, Option<Ground>) {
        #[cfg(test)]
        JUDGED.set(JUDGED.get() + 1);
        let Self { face, tool, tip, level, .. } = *self;
        let patch = &leaf.patch;
        let middle = patch.middle(tool, tip, self.generator.as_ref());
        let Middle { place, ball, reach, length, .. } = middle;
        let foot = face.surface.foot(&place);
        let distance = face.side * foot.distance;
        let sample = sample(tool, patch, &place, &foot, face.side);
        let mut judged = Judged { least: distance - reach - ball, sample, length };
        if judged.least >= level || reach == 0.0 {
            return (judged, None);
        }
        let own = Base { place, distance, gradient: foot.normal * face.side };
        // Where a bend takes a search through parts of the surface, a foot is found sooner; but what it shows serves fewer positions.
        let is_empty_first = self.are_many.get() && face.surface.has_charts();
        if is_empty_first && let Some(empty) = self.judge_empty(patch, &own, &middle, &mut judged) {
            return (judged, Some(empty));
        }
        let before = match leaf.ground {
            Some(Ground::Bending(ground)) => Some(ground),
            _ => None,
        };
        let look = Look { question: self, patch, middle, foot, own, before };
        let (bend, ground) = look.judge_bends(&mut judged);
        if judged.least < level
            && !is_empty_first
            && let Some(empty) = self.judge_empty(patch, &own, &look.middle, &mut judged)
        {
            return (judged, Some(empty));
        }
        if self.are_many.get()
            && self.may_be_thin
            && judged.least < level
            && let Bend::AtMost(bend) = bend
            && let Some(straight) = self.judge_straight(patch, &own, [reach, bend], &mut judged)
        {
            return (judged, Some(straight));
        }
        let ground = ground.filter(|_| judged.least >= level && self.spread > 0.0);
        (judged, ground.map(|ground| Ground::Bending(look.widened(ground))))
    }

    /// The same by an empty ball above the middle of a patch, if that shows the level.
    fn judge_empty(&self, patch: &Patch, own: &Base, middle: &Middle, judged: &mut Judged) -> Option<Ground> {
        let room = own.distance - middle.ball - self.level;
        if room <= 0.0 {
            return None;
        }
        let size = self.tool.radius() + self.tool.profile.top.height;
        let height = (AFAR * middle.reach * middle.reach / room).clamp(middle.reach, size.max(middle.reach));
        if self.least_about(patch, own, height.recip(), middle) < self.level {
            return None;
        }
        let empty = Empty::above(self.face, own, height);
        let (base, bend) = empty.about(&own.place)?;
        let least = self.least_about(patch, &base, bend, middle);
        (least >= self.level).then(|| {
            judged.least = judged.least.max(least);
            Ground::Empty(empty)
        })
    }

    /// The least distance over a patch for a bend downward about a base in its middle.
    pub(super) fn least_about(&self, patch: &Patch, base: &Base, bend: f64, middle: &Middle) -> f64 {
        match patch.stretch {
            Stretch::Arc { .. } if !middle.round => {
                base.distance + least_from_middle(self.tool, patch, base, bend, middle.length > 0.0)
            }
            _ => self.least(patch, base, self.course(bend)) - middle.ball,
        }
    }

    /// The same by how the distance bends along a straight piece and across it; that counts for how it is halved, too.
    fn judge_straight(
        &self,
        patch: &Patch,
        own: &Base,
        within: [f64; 2],
        judged: &mut Judged,
    ) -> Option<Ground> {
        let along = nearly_straight::direction(self.tool, patch, &own.gradient)?;
        let course = Course::nearly_straight(self.face, self.tool, &along, own, within)?;
        judged.length *= course.share_of_length();
        let is_within = |base: &Base| self.away(&base.place, &own.place) <= within[0];
        let bases = std::iter::once(*own).chain(self.base(0.0).filter(is_within));
        bases.into_iter().find_map(|base| {
            judged.least = judged.least.max(self.least(patch, &base, course));
            let ground = Bending { base, center: own.place, radius: within[0], course };
            (judged.least >= self.level).then_some(Ground::Bending(ground))
        })
    }
}

/// How much lower than in its middle the distance is on part of the corner.
fn least_from_middle(tool: &Tool, patch: &Patch, own: &Base, bend: f64, long: bool) -> f64 {
    let Stretch::Arc { arc, polar, .. } = patch.stretch else { return f64::NEG_INFINITY };
    let (sin, cos) = patch.azimuth.sin_cos();
    let radial = tool.across[0] * cos + tool.across[1] * sin;
    let tangent = tool.axis.cross(&radial);
    let (radius, normal, chord) = (patch.stretch.radius(), &own.gradient, patch.chord());
    // Of |a + b|² ≤ 2a² + 2b² one part goes to each direction; alone, a part needs no factor.
    let share = if chord > 0.0 && long { 2.0 } else { 1.0 };
    let around = least_on_arc(
        -radius * normal.dot(&radial) - share * bend * radius * radius,
        radius * normal.dot(&tangent),
        patch.half.min(FRAC_PI_2),
    );
    let around = if chord > 0.0 { around } else { 0.0 };
    let (sin, cos) = (0.5 * (polar[0] + polar[1])).sin_cos();
    let outward = radial * sin - tool.axis * cos;
    let onward = radial * cos + tool.axis * sin;
    let along = least_on_arc(
        -arc * normal.dot(&outward) - share * bend * arc * arc,
        arc * normal.dot(&onward),
        0.5 * (polar[1] - polar[0]),
    );
    around + along
}

/// A point of the tool near the middle of a patch: of a ball, its point towards the surface if it belongs to the tool.
fn sample(tool: &Tool, patch: &Patch, p: &Vec3, foot: &Foot, side: f64) -> Contact {
    let (clearance, gradient) = (side * foot.distance, foot.normal * side);
    if let Stretch::Ball { arc, fan, .. } = patch.stretch
        && clearance >= arc
        && patch.half < PI
    {
        let polar = gradient.dot(&tool.axis).clamp(-1.0, 1.0).acos();
        if polar >= fan[0] && polar <= fan[1] {
            return Contact {
                clearance: clearance - arc,
                gradient,
                tool: p - gradient * arc,
                surface: foot.point,
            };
        }
    }
    Contact { clearance, gradient, tool: *p, surface: foot.point }
}

/// Lower bound of `a (1 − cos ψ) + b sin ψ` for |ψ| up to `half`, at most a right angle.
fn least_on_arc(a: f64, b: f64, half: f64) -> f64 {
    let by_ends = a.min(0.0) * (1.0 - half.cos()) - b.abs() * half.sin();
    if a > 0.0 { by_ends.max(a - a.hypot(b)) } else { by_ends }
}

//! The clearance of a tool to a surface of patches from the contact before: the contact is followed by Newton's method,
//! and shown to be the nearest place by balls.
//!
//! Where a ball that touches the surface at the contact, on the tool's side, has no place of a patch inside, and the tool
//! lies in a smaller one about the same centre, nothing of the patch is nearer than the difference of the radii. The same
//! holds for half-spaces, and for cylinders along a straight piece of the tool ([`super::trough`]). What cannot be shown is left to
//! the general search.

mod apart;

use std::cell::Cell;

use apt_geometry::Vec3;
use nalgebra::{Matrix2, Vector2};

use super::{
    clearance::Reading,
    leaning::keeps_apart,
    patch::{held, jet, place_on},
    survey::{Accuracy, Part, Sheet, nearest_by, nearest_to, work_of_pass},
    tool::{Profile, Tool},
    trough::{Rise, is_within_of_line, straight_direction},
};

/// What the proof that a part is not nearer counts in units of work.
const WORK_OF_PROOF: u32 = 16;
/// Steps of Newton's method, the last of them, and the greatest, in parameters.
const STEPS: usize = 14;
const LAST_STEP: f64 = 1e-7;
const GREATEST_STEP: f64 = 0.5;
/// How much nearer a step must lead for the derivatives of before to serve the next.
const GOOD_STEP: f64 = 0.2;
/// Halvings of a step that leads farther from the contact.
const SHORTENINGS: usize = 5;
/// Step of the derivatives, in parameters.
const DIFFERENCE: f64 = 1e-6;
/// How far beyond the side of a part, in parameters, a contact still counts as its own.
const AT_SIDE: f64 = 1e-7;
/// The same where the part beside it leads back.
const AT_JOINT: f64 = 1e-3;
/// Parts that the contact is followed through.
const HOPS: usize = 24;
/// Places that are looked at on each side of a contact, a radius of the tool far and again as far.
const SEEN_EACH_WAY: u32 = 4;
/// How far beside a contact, relative to the step from the one to the other of these, it is seen to be a saddle.
const CLOSE: f64 = 0.125;
/// Halvings of the steps about the nearest of these.
const NEARINGS: u32 = 6;
/// How far beyond the nearest of all a contact is followed from, in radii of the tool.
const ONWARD: f64 = 0.125;
/// Places nearer than a contact from which another is followed.
const LEAPS: usize = 4;
/// Parts and halves of parts that one reading may look at on their own: far more than it takes, but where the tool touches along a
/// whole line.
const LOOKS: u32 = 2000;
/// Halvings of a part whose distance is not shown at once.
const HALVINGS: u32 = 18;
/// Radii of the balls tried, in radii of the tool, before that of the surface itself.
pub(super) const BALLS: [f64; 4] = [2.0, 4.0, 16.0, 64.0];
/// Share of the radius of the tool behind the deepest place that is meant at which it is met by Newton's method, and of the radius
/// of curvature.
const BEHIND: f64 = 0.5;
/// Depth, relative to the radius of the tool, beyond what is meant, down to which contacts are followed.
const DEEPEST: f64 = 0.1;

/// An end past which a tool comes out by less than a place of it is deep is no farther from that than so many times its depth: one for the way
/// out, and from there no farther than the place across from it is, which is as deep as that away from where the way began.
const WAYS_PAST_END: f64 = 3.0;

/// A contact: a place of a part and the tool's place straight across from it.
#[derive(Debug, Clone, Copy)]
struct Contact {
    at: [f64; 2],
    place: Vec3,
    /// Unit, towards the tool.
    normal: Vec3,
    /// The tool's place, from its end.
    opposite: Vec3,
    /// From the one to the other along the normal.
    value: f64,
}

/// What holds the tool, at least the part of it below some height: all places outside are as far from it as `least`.
#[derive(Debug, Clone, Copy)]
enum Guard {
    /// Outward normal, and height of its plane.
    Level(Vec3, f64),
    /// Centre and radius.
    Ball(Vec3, f64),
    /// A place of the axis of a cylinder, its direction, and the radius.
    Trough(Vec3, Vec3, f64),
}

impl Guard {
    /// How far outside a part is at least.
    fn outside(&self, part: &Part) -> f64 {
        let points = part.net.as_flattened().iter();
        match self {
            Self::Level(outward, height) => {
                points.map(|p| outward.dot(p)).fold(f64::INFINITY, f64::min) - height
            }
            Self::Ball(center, radius) => beyond(part, center, None, *radius),
            Self::Trough(center, along, radius) => beyond(part, center, Some(along), *radius),
        }
    }
}

/// How far a part is beyond a ball, or beyond a cylinder along a direction, at least.
fn beyond(part: &Part, center: &Vec3, along: Option<&Vec3>, radius: f64) -> f64 {
    let onward = |from: Vec3| along.map_or(Vec3::zeros(), |along| along * along.dot(&from));
    let over = |place: &Vec3| {
        let from = place - center;
        let away = from - onward(from);
        let heights = part.net.as_flattened().iter().map(|p| away.dot(&(p - center)));
        heights.fold(f64::INFINITY, f64::min) / away.norm() - radius
    };
    // Its middle is known; its nearest place has to be found.
    let found = over(&part.center);
    if found >= 0.0 { found } else { found.max(over(&part.near(&(center + onward(part.center - center))))) }
}

/// What is shown of all parts: the bounds of the one in contact, how far up they hold, the distance wanted, and the contact.
#[derive(Clone, Copy)]
struct Shown<'a> {
    guards: [&'a Guard; 2],
    below: f64,
    least: f64,
    place: &'a Vec3,
}

impl Contact {
    /// How far the tool's place is from straight across.
    fn beside(&self, tip: &Vec3) -> f64 {
        let apart = tip + self.opposite - self.place;
        (apart - self.normal * self.normal.dot(&apart)).norm()
    }
}

/// A tool in a position and what is near it.
pub(super) struct Following<'a> {
    pub(super) sheet: &'a Sheet,
    pub(super) parts: &'a [Part],
    /// All that is no farther from the tool is among them.
    pub(super) margin: f64,
    /// The way of the tool since the survey.
    pub(super) way: f64,
    pub(super) side: f64,
    pub(super) tip: &'a Vec3,
    pub(super) tool: &'a Tool<'a>,
    pub(super) size: f64,
    pub(super) tolerance: f64,
    pub(super) kept: Kept<'a>,
    /// Where the tool was and how far it has been led out from there, if it is too deep.
    pub(super) led: Option<(&'a Vec3, f64)>,
}

/// How an attempt at a reading is made.
#[derive(Clone, Copy)]
pub(super) struct Manner {
    /// Whether half-spaces that lean are tried too, and contacts followed from places that are nearer.
    pub(super) is_thorough: bool,
    /// Where the tool is only a piece of that for which distances of parts are kept: no clearance greater than this need be shown.
    pub(super) piece: Option<f64>,
}

/// What one attempt at a reading keeps.
#[derive(Clone, Copy)]
pub(super) struct Kept<'a> {
    pub(super) manner: Manner,
    /// The part and the place of a contact where the bounds of the part are too loose to show it.
    pub(super) loose: &'a Cell<Option<(usize, [f64; 2])>>,
    /// A place that is nearer than the contact followed.
    pub(super) nearer: &'a Cell<Option<Vec3>>,
    /// Parts and halves of parts that were looked at on their own.
    pub(super) looks: &'a Cell<u32>,
}

impl Following<'_> {
    /// The clearance, from the contact found last to that of now.
    pub(super) fn reading(&self, last: &mut Option<(usize, [f64; 2])>) -> Option<Reading> {
        if self.tool.profile.is_point() {
            return self.point(last);
        }
        let mut found = self.settled(self.side, last).or_else(|| {
            // A contact that is far from where it was may not be found from there.
            let is_anew = last.take().is_some() && self.kept.loose.get().is_none() && self.nearer().is_none();
            if is_anew { self.settled(self.side, last) } else { None }
        });
        for _ in 0..LEAPS {
            if found.is_some() {
                break;
            }
            let Some(nearer) = self.nearer() else { break };
            self.kept.nearer.set(None);
            self.kept.loose.set(None);
            *last = Some(self.about(&nearer)?);
            found = self.settled(self.side, last);
        }
        found
    }

    /// The place that is nearer than the contact, where that is followed.
    fn nearer(&self) -> Option<Vec3> {
        self.kept.nearer.get().filter(|_| self.kept.manner.is_thorough)
    }

    /// A point is measured from the side that it is on.
    fn point(&self, last: &mut Option<(usize, [f64; 2])>) -> Option<Reading> {
        let met = self.contact(1.0, last).or_else(|| {
            // It may be far from where it was.
            last.take()?;
            self.contact(1.0, last)
        });
        let (_, contact) = met?;
        let sense = if contact.value < 0.0 { -1.0 } else { 1.0 };
        let found = self.settled(sense, last)?;
        let turn = sense * self.side;
        Some(Reading::new(turn * found.value, found.normal * turn, found.error))
    }

    /// The clearance on a side, where it is shown.
    fn settled(&self, side: f64, last: &mut Option<(usize, [f64; 2])>) -> Option<Reading> {
        let (index, contact) = self.contact(side, last)?;
        let widest = self.tool.profile.widest();
        if contact.value < -DEEPEST * widest - self.tool.depth - self.tolerance {
            return None;
        }
        let part = self.parts.get(index)?;
        let behind = part.hollow(-side)?;
        // The surface's place in the tool, or the tool's under the surface, is as deep as that.
        let own = jet(&part.net, contact.at.map(|x| x.clamp(0.0, 1.0)))[0];
        let mut value = self.tool.distance(&(own - self.tip));
        // A point is its own place under the surface: what is nearer beyond the end of a part says nothing of it.
        let is_under = contact.value < 0.0 && !self.tool.profile.is_point();
        if value > contact.value + self.tolerance && is_under && -contact.value * behind <= BEHIND {
            let profile = Profile::tool_end();
            let point = self.tool.with(&profile);
            let place = self.tip + contact.opposite;
            if self.may_come_out_past_end(&place, -contact.value) {
                return None;
            }
            let accuracy = Accuracy { rounding: self.tolerance, error: 0.0 };
            let (under, _) = self.sheet.at(side, &place, &point, (self.size, true), accuracy)?;
            value = value.min(under.value + under.error);
        }
        if (value - contact.value).abs() > 2.0 * self.tolerance {
            self.kept.nearer.set(Some(own));
            return None;
        }
        // A tool that is too deep is looked at where it has been led out.
        let enough = self.kept.manner.piece.unwrap_or(f64::INFINITY);
        let least = value.min(contact.value).min(enough) - self.tolerance;
        let error = value - least;
        let depth = (-least).max(0.0);
        let out = self.tip + contact.normal * depth;
        let led = Following { tip: &out, led: (depth > 0.0).then_some((self.tip, depth)), ..*self };
        let least = least.max(0.0);
        let Some((guard, below)) = led.guard(part, side, &contact, least) else {
            self.kept.loose.set(Some((index, contact.at)));
            if self.kept.manner.is_thorough {
                self.kept.nearer.set(self.downhill(part, &contact));
            }
            return None;
        };
        let outward = -contact.normal;
        let level = Guard::Level(outward, outward.dot(&out) + self.tool.support(&outward).0 + least);
        let led_by = (out - self.tip).norm();
        if self.tool.patience.ends_after(work_of_pass(self.parts)) {
            return None;
        }
        for (k, other) in self.parts.iter().enumerate() {
            if k == index || other.far.get() - self.way - led_by >= least {
                continue;
            }
            let far = led.far(other, [&level, &guard], below, least);
            if far < least {
                let shown = Shown { guards: [&level, &guard], below, least, place: &contact.place };
                led.show(other, k, side, &shown, HALVINGS)?;
            } else if self.kept.manner.piece.is_none() {
                other.far.set(far - led_by + self.way);
            }
        }
        Some(Reading { place: Some(contact.opposite), ..Reading::new(value, contact.normal, error) })
    }

    /// Whether the surface may end so near to a place of the tool under it that the tool comes out past the end by less than the place is deep:
    /// the end is then no farther from that than the way there, and from there to the place across from it, are.
    fn may_come_out_past_end(&self, place: &Vec3, depth: f64) -> bool {
        let reach = WAYS_PAST_END * depth;
        !self.sheet.is_body()
            && (reach > self.margin || self.parts.iter().any(|part| part.may_end_within(reach, place)))
    }

    /// A bound of the distance of a part, where both have all outside as far as `least`; the second of them holds the tool up
    /// to a height.
    fn far(&self, part: &Part, [level, guard]: [&Guard; 2], below: f64, least: f64) -> f64 {
        let from = part.center - self.tip;
        let far = self.tool.distance(&from) - part.radius;
        if far >= least {
            return far;
        }
        let far = level.outside(part) + least;
        let above = below - self.tool.axis.dot(&from) - part.radius;
        if far >= least || above < least {
            return far;
        }
        far.max((guard.outside(part) + least).min(above))
    }

    /// Whether the place of a part about nearest to a place is nearer to the tool than `least`; if so it is kept.
    fn is_nearer(&self, index: usize, place: &Vec3, least: f64) -> bool {
        let Some(part) = self.parts.get(index) else { return false };
        let at = part.nearest_parameters(place);
        let own = jet(&part.net, at)[0];
        let is_nearer = self.tool.distance(&(own - self.tip)) < least;
        if is_nearer {
            self.kept.nearer.set(Some(own));
        }
        is_nearer
    }

    /// Shows that a part is no nearer than is wanted, from its own contact; in halves if need be.
    fn show(&self, part: &Part, index: usize, side: f64, shown: &Shown<'_>, halvings: u32) -> Option<()> {
        let Shown { guards, below, least, place } = *shown;
        self.kept.looks.set(self.kept.looks.get() + 1);
        if self.tool.patience.ends_after(WORK_OF_PROOF) {
            return None;
        }
        if self.is_above(part, side, least) || self.is_left_behind(part, side, shown) {
            return Some(());
        }
        let from = part.center - self.tip;
        let apart = self.tool.distance(&from);
        if apart < least && self.is_nearer(index, &part.center, least) {
            return None;
        }
        if let Some(contact) = self.solve(part, side, part.nearest_parameters(place)) {
            if self.guard(part, side, &contact, least).is_some()
                || self.is_beside_straight(part, contact.at, least)
            {
                return Some(());
            }
            if contact.value < least && self.is_nearer(index, &contact.place, least) {
                return None;
            }
        }
        if halvings == 0 || self.kept.looks.get() >= LOOKS {
            return None;
        }
        // The nearer first, where a place nearer than the contact would be.
        let [first, last] = part.halves().0;
        let apart = |half: &Part| self.tool.distance(&(half.center - self.tip));
        for half in if apart(&last) < apart(&first) { [last, first] } else { [first, last] } {
            if self.far(&half, guards, below, least) < least {
                self.show(&half, index, side, shown, halvings - 1)?;
            }
        }
        Some(())
    }

    /// Whether a tool that is too deep leaves a part as far behind as is wanted where it is led out across that instead, no farther than
    /// at the deepest contact: what is deep at two places is not as deep as both together.
    fn is_left_behind(&self, part: &Part, side: f64, shown: &Shown<'_>) -> bool {
        let Some((tip, depth)) = self.led else { return false };
        let own = Following { tip, led: None, ..*self };
        let Some(contact) = own.solve(part, side, part.nearest_parameters(shown.place)) else { return false };
        if contact.value >= shown.least {
            return false;
        }
        let out = tip + contact.normal * depth;
        let led = Following { tip: &out, ..own };
        let contact = led.solve(part, side, contact.at);
        contact.is_some_and(|contact| led.guard(part, side, &contact, shown.least).is_some())
    }

    /// A half-space or ball at a contact that has no place of its part inside and keeps the tool as far away as `least`, and
    /// the height up to which it holds the tool, which is enough for the part.
    fn guard(&self, part: &Part, side: f64, contact: &Contact, least: f64) -> Option<(Guard, f64)> {
        let hollow = part.hollow(side)?;
        let outward = -contact.normal;
        let height = outward.dot(&contact.place);
        if hollow <= 0.0 && height - outward.dot(self.tip) - self.tool.support(&outward).0 >= least {
            return Some((Guard::Level(outward, height), f64::INFINITY));
        }
        let (tool, widest) = (self.tool, self.tool.profile.widest());
        // The part of the tool that is high above the surface's part is farther than the contact anyway.
        let top = tool.axis.dot(&(part.center - self.tip)) + part.radius + least;
        let below = top.max(tool.profile.edges()[1][1]) + widest;
        let low = (below < tool.profile.top_height()).then(|| tool.profile.below(below));
        let limit = 1.0 / hollow;
        let radii = BALLS.map(|k| k * widest.max(contact.value.abs()));
        let tried = radii.into_iter().filter(|r| *r > 0.0 && *r < limit);
        let greatest = limit.min(1e4 * (widest + contact.value.abs() + part.radius));
        for radius in tried.chain([greatest]) {
            let center = contact.place + contact.normal * radius;
            let from = center - self.tip;
            if radius - tool.farthest(&from).0 >= least {
                return Some((Guard::Ball(center, radius), f64::INFINITY));
            }
            if let Some(low) = &low
                && radius - tool.with(low).farthest(&from).0 >= least
            {
                return Some((Guard::Ball(center, radius), below));
            }
        }
        let rise = Rise::of(&part.net, contact.at, &contact.normal)?;
        if let Some(along) = straight_direction(tool, &contact.opposite, &contact.normal) {
            let way = rise.way(&contact.normal.cross(&along));
            for radius in radii.into_iter().filter(|r| *r > 0.0 && rise.is_below(&[(&way, 1.0 / r)])) {
                let center = contact.place + contact.normal * radius;
                let from = center - self.tip;
                let low = low.as_ref().map_or(*tool, |low| tool.with(low));
                if is_within_of_line(&low, &from, &along, radius - least) {
                    let below = if low.profile == tool.profile { f64::INFINITY } else { below };
                    return Some((Guard::Trough(center, along, radius), below));
                }
            }
        }
        if !self.kept.manner.is_thorough {
            return None;
        }
        let around = (contact.at, &contact.place, &contact.normal);
        keeps_apart(tool, self.tip, (&part.net, rise), around, least).then(|| {
            // Of the tool this says no more than its tangent plane.
            let tangent = outward.dot(self.tip) + tool.support(&outward).0 + least;
            (Guard::Level(outward, tangent), f64::INFINITY)
        })
    }

    /// A place nearer than a contact that is only stationary, a saddle of the distance: the nearest that is seen on the line in which
    /// the surface bends towards the tool most.
    fn downhill(&self, part: &Part, contact: &Contact) -> Option<Vec3> {
        let [u, v] = Rise::of(&part.net, contact.at, &contact.normal)?.hollow_way()?;
        let apart = |place: &Vec3| self.tool.distance(&(place - self.tip));
        let least = contact.value - self.tolerance;
        let step = self.tool.profile.widest() / f64::from(SEEN_EACH_WAY);
        let beside = |way: f64| place_on(&part.net, [contact.at[0] + way * u, contact.at[1] + way * v]);
        let close = CLOSE * step;
        if apart(&beside(close)).min(apart(&beside(-close))) >= least {
            return None;
        }
        let direction = (beside(close) - contact.place).try_normalize(0.0)?;
        let both = [direction, -direction].into_iter();
        let places = both.flat_map(|way| (1..=2 * SEEN_EACH_WAY).map(move |k| way * (step * f64::from(k))));
        let seen = places.filter_map(|way| self.seen(&(contact.place + way)));
        let (nearest, place) = seen.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (nearest < least).then_some(place)
    }

    /// From where a contact is followed that is near a place: somewhat beyond where the surface is nearest to the tool there, on the
    /// side away from the tool axis, where no straight piece of the tool leads back to a saddle. All of this is told in widths of the tool,
    /// so that for one without width nothing is beside the place.
    fn about(&self, place: &Vec3) -> Option<(usize, [f64; 2])> {
        let widest = self.tool.profile.widest();
        if widest <= 0.0 {
            return self.seen_at(place);
        }
        let mut best = self.seen(place)?;
        let from = best.1 - self.tip;
        let radial = (from - self.tool.axis * self.tool.axis.dot(&from)).try_normalize(0.0)?;
        let around = self.tool.axis.cross(&radial);
        let mut step = widest / f64::from(SEEN_EACH_WAY);
        for _ in 0..NEARINGS {
            step *= 0.5;
            for way in [radial, around, -radial, -around] {
                if let Some(seen) = self.seen(&(best.1 + way * step)).filter(|seen| seen.0 < best.0) {
                    best = seen;
                }
            }
        }
        self.seen_at(&(best.1 + radial * (widest * ONWARD)))
    }

    /// How far the surface is from the tool at its place about nearest to a place, and that place of it.
    fn seen(&self, place: &Vec3) -> Option<(f64, Vec3)> {
        let (index, at) = self.seen_at(place)?;
        let own = jet(&self.parts.get(index)?.net, at)[0];
        Some((self.tool.distance(&(own - self.tip)), own))
    }

    /// The part and its place nearest to a place.
    fn seen_at(&self, place: &Vec3) -> Option<(usize, [f64; 2])> {
        let index = self.nearest_to(place, self.tool.profile.widest())?;
        Some((index, self.parts.get(index)?.nearest_parameters(place)))
    }

    /// Follows the contact from part to part.
    fn contact(&self, side: f64, last: &mut Option<(usize, [f64; 2])>) -> Option<(usize, Contact)> {
        let (mut index, mut from) = match *last {
            Some(last) => last,
            None => {
                let apart = |part: &Part| self.tool.distance(&(part.center - self.tip));
                (nearest_by(self.parts, apart)?, [0.5; 2])
            }
        };
        let mut before = None;
        for _ in 0..HOPS {
            let part = self.parts.get(index)?;
            let contact = self.solve(part, side, from)?;
            if contact.at.iter().all(|x| (-AT_SIDE..=1.0 + AT_SIDE).contains(x)) {
                *last = Some((index, contact.at));
                return Some((index, contact));
            }
            // Where its own polynomial leads is near another part.
            let next = self.nearest_to(&contact.place, part.radius)?;
            // Between two parts of which each leads a little into the other the contact is where they join.
            let joins =
                before == Some(next) && contact.at.iter().all(|x| (-AT_JOINT..=1.0 + AT_JOINT).contains(x));
            if next == index || joins {
                *last = Some((index, contact.at));
                return Some((index, contact));
            }
            before = Some(index);
            (index, from) = (next, self.parts.get(next)?.nearest_parameters(&contact.place));
        }
        None
    }

    /// The part nearest to a place, if one is as near as `close`. None once the tool's patience is over.
    fn nearest_to(&self, place: &Vec3, close: f64) -> Option<usize> {
        let is_over = self.tool.patience.ends_after(work_of_pass(self.parts));
        if is_over { None } else { nearest_to(self.parts, place, close) }
    }

    /// The contact with the surface that a part belongs to, near the part.
    fn solve(&self, part: &Part, side: f64, from: [f64; 2]) -> Option<Contact> {
        let widest = self.tool.profile.widest();
        let behind = part.hollow(-side)?;
        let offset = (BEHIND * widest + self.tool.depth).min(BEHIND / behind);
        let sense = part.sense(side);
        // The tool's place nearest to a place straight behind that of the surface, and how far it is beside.
        let beside = |at: [f64; 2]| -> Option<(Vector2<f64>, Contact)> {
            let [place, along, across] = jet(&part.net, at);
            let normal = along.cross(&across).try_normalize(0.0)? * sense;
            let opposite = self.tool.signed_distance(&(place - normal * offset - self.tip)).1;
            let apart = self.tip + opposite - place;
            let value = normal.dot(&apart);
            let contact = Contact { at, place, normal, opposite, value };
            Some((Vector2::new(apart.dot(&along), apart.dot(&across)), contact))
        };
        let mut at = held(from);
        let (mut off, mut contact) = beside(at)?;
        let mut known: Option<Matrix2<f64>> = None;
        for _ in 0..STEPS {
            let [u, v] = at;
            let matrix = match known {
                Some(matrix) => matrix,
                None => {
                    let (by_u, by_v) = (beside([u + DIFFERENCE, v])?.0, beside([u, v + DIFFERENCE])?.0);
                    Matrix2::from_columns(&[by_u - off, by_v - off]) / DIFFERENCE
                }
            };
            let ([a, b, c, d], off_before) = ([matrix.m11, matrix.m12, matrix.m21, matrix.m22], off);
            let area = a * d - b * c;
            let mut step = [(b * off[1] - d * off[0]) / area, (c * off[0] - a * off[1]) / area];
            if !step.iter().all(|x| x.is_finite()) {
                return None;
            }
            let size = step[0].abs().max(step[1].abs());
            step = step.map(|x| x * (GREATEST_STEP / size).min(1.0));
            let before = contact.beside(self.tip);
            // Where the nearest place of the tool goes over to another of its parts the whole step may lead too far.
            for _ in 0..SHORTENINGS {
                at = held([u + step[0], v + step[1]]);
                (off, contact) = beside(at)?;
                if contact.beside(self.tip) <= before {
                    break;
                }
                step = step.map(|x| 0.5 * x);
            }
            let left = at[0] != u + step[0] && at[0] == u || at[1] != v + step[1] && at[1] == v;
            if size <= LAST_STEP || left || at == [u, v] {
                break;
            }
            // Good derivatives are made better by what the step has shown (Broyden).
            let way = Vector2::new(at[0] - u, at[1] - v);
            let is_good = off.norm() <= GOOD_STEP * off_before.norm();
            known = is_good
                .then(|| matrix + (off - off_before - matrix * way) * way.transpose() / way.norm_squared());
        }
        Some(contact)
    }
}

//! How far all of a surface keeps off a convex body, from the sizes of its parts.
//!
//! The distance from a convex body is a convex function: nowhere is it below its tangent at a place. So what is known of how far
//! a part of a surface reaches, in which directions, from a place tells how near to the body it comes at most.

use super::{Surface, part::Extent};
use crate::{Vec3, patience::Patience};

/// Bound of the nodes and parts that one question looks at: what takes more is too close.
const MOST_LOOKS: u32 = 600;
/// Places of a straight stretch that are tried for the one nearest to a body.
const PLACES: u32 = 3;

/// How far a point is from a convex body, and the unit direction from the body to it; no direction within.
pub type Away<'a> = dyn Fn(&Vec3) -> (f64, Vec3) + 'a;

/// A half-space, on the inner side of the plane at `level` along a unit normal outward.
#[derive(Debug, Clone, Copy)]
pub struct HalfSpace {
    /// Unit normal, outward.
    pub outward: Vec3,
    /// How far the plane is along it.
    pub level: f64,
}

/// A half-space that holds a convex body, from the direction out of the body at a place beside it, and a normal of the surface there.
pub type Beside<'a> = dyn Fn(&Vec3, &Vec3) -> HalfSpace + 'a;

/// How far a point is beyond a half-space at the beginning of a body's way and one at the end of it, with their outward unit normals: what is beyond both by a
/// distance is as far from the body, wherever that is on its way.
pub type AtEnds<'a> = dyn Fn(&Vec3) -> [(f64, Vec3); 2] + 'a;

/// A convex body.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    /// How far points are from it.
    pub away: &'a Away<'a>,
    /// One that holds it: where the body lies along a plane part of a surface, that tells more than the distances of points.
    pub within: Option<HalfSpace>,
    /// Those that hold it and face parts of a surface: about a sharp edge of the body the distances of points bend without bound.
    pub beside: Option<&'a Beside<'a>>,
    /// Those of one that turns on its way, in place of the distances of points: the convex hull of the way is much wider than that.
    pub at_ends: Option<&'a AtEnds<'a>>,
}

impl<'a> Body<'a> {
    /// One of which only the distances of points are known.
    pub fn new(away: &'a Away<'a>) -> Self {
        Self { away, within: None, beside: None, at_ends: None }
    }
}

/// A place of a surface that is nearer to a body than wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearer {
    /// The place, on the surface without its own thickness.
    pub place: Vec3,
    /// By how much the surface is thicker there: what keeps off it is farther from the place than wanted by as much.
    pub stock: f64,
}

/// How many nodes and parts a question looks at, and how long.
#[derive(Debug, Clone, Copy)]
pub struct Limit<'a> {
    /// What takes more is too close.
    pub looks: u32,
    /// A distance beyond which none is told: where a distance is to be decided on and not told, the one wanted.
    pub enough: f64,
    /// Who waits for it.
    pub patience: Patience<'a>,
}

/// The question how far a surface keeps off a body.
pub(super) struct Apart<'a> {
    away: &'a Away<'a>,
    within: Option<HalfSpace>,
    beside: Option<&'a Beside<'a>>,
    at_ends: Option<&'a AtEnds<'a>>,
    /// Less is none.
    wanted: f64,
    /// What the parts looked at so far keep.
    least: f64,
    looks: u32,
    limit: Limit<'a>,
    /// The place of the body nearest to what was looked at last.
    nearest: Vec3,
    /// The middle of a part that is nearer than wanted.
    too_near: Option<Vec3>,
}

impl<'a> Apart<'a> {
    pub(super) fn new(body: Body<'a>, wanted: f64, limit: Limit<'a>) -> Self {
        let Body { away, within, beside, at_ends } = body;
        Self {
            away,
            within,
            beside,
            at_ends,
            wanted,
            least: limit.enough.max(wanted),
            looks: 0,
            limit,
            nearest: Vec3::zeros(),
            too_near: None,
        }
    }

    /// The distance that is wanted.
    pub(super) fn wanted(&self) -> f64 {
        self.wanted
    }

    /// How far a place is from the body, and the direction in which that grows.
    pub(super) fn at(&mut self, place: &Vec3) -> (f64, Vec3) {
        self.look();
        (self.away)(place)
    }

    /// Counts a look; a question that is given up has had all of them.
    fn look(&mut self) {
        self.looks += 1;
        if self.limit.patience.ends_after(1) {
            self.looks = self.limit.looks + 1;
        }
    }

    /// Whether there may be more of them.
    pub(super) fn may_look(&self) -> bool {
        self.looks <= self.limit.looks
    }

    /// The distance that all parts keep, unless they were too many to look at.
    pub(super) fn kept(&self) -> Option<f64> {
        self.may_look().then_some(self.least)
    }

    /// The place that was found nearer than wanted, if one was, of a surface of some thickness of its own.
    pub(super) fn nearer(&self, stock: f64) -> Option<Nearer> {
        self.too_near.map(|place| Nearer { place, stock })
    }

    /// Whether a part that keeps a distance adds nothing to what is known.
    pub(super) fn is_settled(&self, distance: f64) -> bool {
        distance >= self.least
    }

    /// Takes what a part keeps, if that is not less than wanted.
    pub(super) fn takes(&mut self, distance: f64) -> bool {
        let takes = distance >= self.wanted;
        if takes {
            self.least = self.least.min(distance);
        }
        takes
    }

    /// What all within a ball keeps.
    pub(super) fn ball(&mut self, center: &Vec3, radius: f64) -> f64 {
        self.look();
        (self.away)(center).0 - radius
    }

    /// What all within a radius of a straight stretch keeps, from its beginning and the way along it.
    pub(super) fn stretch(&mut self, [start, along]: &[Vec3; 2], radius: f64) -> f64 {
        let square = along.norm_squared();
        let shares = |place: &Vec3| {
            let share = (place - start).dot(along) / square;
            if square > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 }
        };
        let (mut share, mut most) = (shares(&self.nearest), f64::NEG_INFINITY);
        for _ in 0..PLACES {
            self.look();
            let place = start + along * share;
            let (distance, outward) = (self.away)(&place);
            let slope = outward.dot(along);
            let least = distance - (slope * share).max(-slope * (1.0 - share));
            most = most.max(least - radius);
            self.nearest = place - outward * distance;
            if self.is_settled(most) || distance <= 0.0 {
                break;
            }
            let next = shares(&self.nearest);
            if next == share {
                break;
            }
            share = next;
        }
        most
    }

    /// How far the distance is above its tangent at a place, at that end of a way to both sides of it which the tangent says is nearer.
    pub(super) fn above_tangent(&self, place: &Vec3, (distance, outward): (f64, Vec3), way: &Vec3) -> f64 {
        let rise = outward.dot(way);
        let nearer = place - way * rise.signum();
        let there = match self.at_ends {
            Some(at_ends) => {
                at_ends(&nearer).map(|(distance, _)| distance).into_iter().fold(f64::INFINITY, f64::min)
            }
            None => (self.away)(&nearer).0,
        };
        there - (distance - rise.abs())
    }

    /// What a part of a surface keeps, and how far its middle is, with the direction to it.
    fn part(&mut self, part: &Extent) -> (f64, (f64, Vec3)) {
        self.look();
        if let Some(at_ends) = self.at_ends {
            let [first, last] = at_ends(part.center());
            let least = [first, last].map(|(distance, outward)| distance - part.reach_along(&outward));
            return (least[0].min(least[1]), if first.0 <= last.0 { first } else { last });
        }
        let (distance, outward) = (self.away)(part.center());
        let by_point = distance - part.reach_along(&outward);
        let is_wanted = |least: &f64| *least >= self.wanted;
        let by_plane = |HalfSpace { outward, level }: HalfSpace| {
            outward.dot(part.center()) - level - part.reach_along(&outward)
        };
        let within = || self.within.map_or(f64::NEG_INFINITY, by_plane);
        let beside = || {
            let facing = self.beside.zip(part.normal()).map(|(beside, normal)| beside(&outward, &normal));
            facing.map_or(f64::NEG_INFINITY, by_plane)
        };
        let least = Some(by_point).filter(is_wanted).or_else(|| Some(within()).filter(is_wanted));
        (least.or_else(|| Some(beside()).filter(is_wanted)).unwrap_or(by_point), (distance, outward))
    }

    /// Whether a part keeps what is wanted; its halves where need be, by the tangent of the distance in the middle.
    pub(super) fn takes_part(
        &mut self,
        part: &Extent,
        halves: &mut dyn FnMut(&mut Self, (f64, Vec3)) -> bool,
    ) -> bool {
        let (least, middle) = self.part(part);
        if self.is_settled(least) || self.takes(least) {
            return true;
        }
        if middle.0 < self.wanted {
            self.too_near = Some(*part.center());
            return false;
        }
        self.may_look() && halves(self, middle)
    }
}

impl Surface {
    /// A distance from a convex body, not below the one wanted, that all of the surface is known to keep; `None` for surfaces
    /// of which that is not known, and where some place may be nearer. It is not told beyond one that is enough.
    pub fn keeps_apart(
        &self,
        away: &Away<'_>,
        [wanted, enough]: [f64; 2],
        patience: Patience<'_>,
    ) -> Option<f64> {
        let limit = Limit { looks: MOST_LOOKS, enough, patience };
        self.keeps_off_body(Body::new(away), wanted, limit)
    }

    /// The same within a limit.
    pub fn keeps_off_body(&self, body: Body<'_>, wanted: f64, limit: Limit<'_>) -> Option<f64> {
        self.keeps_off_or_nears(body, wanted, limit).ok()
    }

    /// The same; where it is not known, a place that is nearer than wanted, if one was found: another body that is as near to it need not be asked about.
    pub fn keeps_off_or_nears(
        &self,
        body: Body<'_>,
        wanted: f64,
        limit: Limit<'_>,
    ) -> Result<f64, Option<Nearer>> {
        let mut asked = Apart::new(body, wanted, limit);
        let keeps = match self {
            Self::Ruled(sheet) => sheet.keeps_apart(&mut asked),
            Self::PolyConic(sheet) => return sheet.keeps_apart(body, wanted, limit),
            Self::Sculptured(sheet) => sheet.keeps_apart(&mut asked),
            Self::Tabulated(curve) => curve.keeps_apart(&mut asked),
            _ => false,
        };
        asked.kept().filter(|_| keeps).ok_or_else(|| asked.nearer(0.0))
    }
}

//! How a clearance bends along a vector, as closely as the way that the tool goes tells.
//!
//! A contact on the way is a place of the surface and one of the tool straight across, and what goes along with both, on the surface straight
//! below the place of the tool, is no nearer than the clearance. So the slope of that grows by no more than the surface falls away
//! from the tool in the direction of the way, which may be none at all where it falls away across that.
//!
//! A tool too deep by d is at the boundary of the surface's body less the tool, whose normals turn at that by no more than the surface's,
//! by a symmetric A. At the depth d they turn by `A(1 − dA)⁻¹ = A + dA²(1 − dA)⁻¹`, which grows with A: the first is how the surface
//! falls, the second no more than dK²/(1 − dH) for its greatest curvatures K both ways and H away from the tool.

use std::{cmp::Ordering, collections::BinaryHeap};

use apt_geometry::Vec3;

use super::{Part, Sheet, WORK_OF_BENDS, ball, extent, halves_across, halves_along, jet, work_of_pass};
use crate::verify::{
    patch::{Net, along::Falling},
    span::DEEPEST,
    tool::{Profile, Tool},
};

/// Halvings of parts for one bound.
const HALVINGS: usize = 64;
/// How many times as much as in its middle a part may be told to fall away for halves of it to tell hardly less.
const CLOSE: f64 = 1.1;

/// How many times as far as it goes a place of a straight tool is taken along that at most.
const SLIDES: f64 = 16.0;

/// A straight way of a tool, on which its axis turns evenly, as seen from its middle.
#[derive(Clone, Copy)]
pub(in crate::verify) struct Passage<'a> {
    /// The tool and its end half way, and how high above the end of the whole tool that is.
    pub(in crate::verify) tool: &'a Tool<'a>,
    pub(in crate::verify) tip: Vec3,
    pub(in crate::verify) raise: f64,
    /// All the way of the end of the whole tool.
    pub(in crate::verify) way: Vec3,
    /// The angle through which the axis turns, along the line that it turns about.
    pub(in crate::verify) round: Vec3,
    /// The clearance on it, without thickness, is between these.
    pub(in crate::verify) values: [f64; 2],
}

/// Places of the tool that may touch a piece of a surface, as they go half way.
struct Going {
    /// By the parameter of the way from 0 to 1, and how far any goes beside that.
    way: Vec3,
    beside: f64,
    /// How high up they are at most, down or up.
    height: f64,
}

/// What a surface may bend more than its patches, how deep a tool may be in it, in radii of its curvature, and how much faster slopes grow at
/// that depth, by the square of a way.
#[derive(Clone, Copy)]
struct Deep {
    slack: f64,
    deepest: f64,
    more: f64,
}

/// A piece of a part, and how fast the slope of a clearance grows there at most, by the parameter of the way from 0 to 1.
struct Piece<'a> {
    net: Net,
    part: &'a Part,
    rate: f64,
    /// Whether halves of it may tell less.
    is_loose: bool,
}

impl Ord for Piece<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rate.total_cmp(&other.rate)
    }
}

impl PartialOrd for Piece<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Piece<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece<'_> {}

impl Passage<'_> {
    fn turn(&self) -> f64 {
        self.round.norm()
    }

    /// How far its places go beside its end.
    fn swing(&self) -> f64 {
        self.turn() * (self.tool.profile.reach() + self.raise.abs())
    }

    fn travel(&self) -> f64 {
        self.way.norm() + self.swing()
    }

    /// How far it is from the surface, or in it, at most.
    fn clearance(&self) -> f64 {
        self.values[0].abs().max(self.values[1].abs())
    }

    /// What may touch a piece: it is as high up as that, but for what it goes and how far it is away.
    fn going(&self, net: &Net) -> Going {
        let (center, radius) = ball(net);
        let middle = self.tool.axis.dot(&(center - self.tip)) + self.raise;
        let off = radius + self.clearance() + 0.5 * self.travel();
        let (turn, height) = (self.turn(), middle.abs() + off);
        let way = self.way + self.round.cross(&self.tool.axis) * middle;
        // Before and after, the axis leans by half of the turn.
        let beside = turn * (off + self.tool.profile.widest() + 0.5 * turn * height);
        Going { way, beside, height }
    }

    /// No contact on the way is farther from the tool half way.
    fn reach(&self) -> f64 {
        self.clearance() + 0.5 * self.travel()
    }

    /// Whether a contact on the way may be on a piece of a surface: one is as far from a place of the tool on the way, at most, as the clearance is
    /// great, and so no farther beyond a plane that has the tool all the way on its other side.
    fn may_touch(&self, net: &Net) -> bool {
        let (center, radius) = ball(net);
        let from = center - self.tip;
        let (distance, nearest) = self.tool.signed_distance(&from);
        if distance - radius > self.reach() {
            return false;
        }
        let is_beyond = |outward: &Vec3| {
            let aside = 0.5 * (outward.dot(&self.way).abs() + self.swing());
            let level = outward.dot(&self.tip) + self.tool.support(outward).0 + aside + self.clearance();
            net.as_flattened().iter().all(|p| outward.dot(p) > level)
        };
        let [_, along, across] = jet(net, [0.5; 2]);
        let normal = along.cross(&across).try_normalize(0.0);
        let away = (from - nearest).try_normalize(0.0);
        let both = normal.into_iter().flat_map(|normal| [normal, -normal]);
        !both.chain(away.map(|away| away * distance.signum())).any(|outward| is_beyond(&outward))
    }

    /// A piece of a part; None where nothing bounds how it bends.
    fn piece<'a>(&self, part: &'a Part, net: Net, side: f64) -> Option<Piece<'a>> {
        let bends = part.bends()?;
        let sense = part.sense(side);
        let behind = usize::from(sense > 0.0);
        let hill = bends.hollow[behind] + part.slack;
        let depth = (-self.values[0]).max(0.0);
        let deepest = hill * depth;
        if deepest > DEEPEST {
            return None;
        }
        let square = self.travel() * self.travel();
        let anyhow = hill * square / (1.0 - deepest) + self.turn() * self.swing();
        let Some(falling) = Falling::of(&net, sense) else {
            return Some(Piece { net, part, rate: anyhow, is_loose: true });
        };
        let going = self.going(&net);
        let curvature = bends.hollow[0].max(bends.hollow[1]) + part.slack;
        let more = depth * curvature * curvature / (1.0 - deepest);
        let deep = Deep { slack: part.slack, deepest, more };
        let own = || self.along(&falling, &going, deep).unwrap_or([anyhow; 2]);
        let [most, middle] = match self.along_line(&falling, &going, deep) {
            Some(slid) if self.may_end_touch(&net) => {
                let own = own();
                [0, 1].map(|k: usize| own[k].max(slid[k]))
            }
            Some(slid) => slid,
            None => own(),
        };
        let rate = most.min(anyhow);
        Some(Piece { net, part, rate, is_loose: rate > CLOSE * middle })
    }

    /// How fast the slope grows where the tool touches a piece, at most and about in its middle.
    fn along(&self, falling: &Falling, going: &Going, deep: Deep) -> Option<[f64; 2]> {
        let below = (deep.slack + deep.more) * (going.way.norm() + going.beside).powi(2);
        // A place that goes round is drawn to the line about which it does: along the axis as far as it is high up, and across it.
        let turn = self.turn();
        let upright = (falling.across(&self.tool.axis) + 0.5 * turn).min(1.0);
        let drawn = turn * turn * (going.height * upright + self.tool.profile.widest());
        let most = falling.along(&going.way, going.beside)?.max(0.0);
        let middle = falling.in_middle(&going.way, &going.way).max(0.0);
        Some([most, middle].map(|fall| fall + below + drawn))
    }

    /// The same where the tool is a straight line that touches between its ends: what goes along with a contact may go along that, too, any way,
    /// which takes it to where the surface falls away less. The normal is across the line, so that it is not drawn along that where it turns; but it
    /// goes round faster the farther up it is taken. The boundary of the surface's body less a line turns about one direction only: at a depth
    /// a bend towards a tool that does not turn is none still.
    fn along_line(&self, falling: &Falling, going: &Going, deep: Deep) -> Option<[f64; 2]> {
        let profile = self.tool.profile;
        if profile.widest() > 0.0 || profile.is_point() {
            return None;
        }
        let axis = &self.tool.axis;
        let (own, mixed) = (falling.in_middle(axis, axis), falling.in_middle(&going.way, axis));
        let farthest = SLIDES * self.travel();
        let best =
            if own > 0.0 { (-mixed / own).clamp(-farthest, farthest) } else { -farthest * mixed.signum() };
        let round = falling.across(&self.round.cross(axis)) + 0.5 * self.turn() * self.turn();
        let slid = |length: f64| {
            let way = going.way + axis * length;
            // Along the axis of then, which leans by half of the turn.
            let beside = going.beside + 0.5 * self.turn() * length.abs();
            let square = (way.norm() + beside).powi(2);
            let most = falling.along(&way, beside)?.max(0.0);
            let middle = falling.in_middle(&way, &way).max(0.0);
            Some([most, middle].map(|fall| {
                if self.turn() > 0.0 {
                    fall + (deep.slack + deep.more) * square + 2.0 * length.abs() * round
                } else {
                    (fall + deep.slack * square) / (1.0 - deep.deepest)
                }
            }))
        };
        let tried = [0.0, 0.5 * best, best].into_iter().filter_map(slid);
        tried.min_by(|a, b| a[0].total_cmp(&b[0]))
    }

    /// Whether a contact on the way may be one of an end of a tool that is a straight line with a piece of a surface.
    fn may_end_touch(&self, net: &Net) -> bool {
        let end = Profile::tool_end();
        let tool = self.tool.with(&end);
        [0.0, self.tool.profile.top_height()].into_iter().any(|height| {
            let tip = self.tip + self.tool.axis * height;
            let raise = self.raise + height;
            Passage { tool: &tool, tip, raise, ..*self }.may_touch(net)
        })
    }
}

impl Sheet {
    /// How fast the slope of the clearance on a side can grow on a passage, by its parameter from 0 to 1, as closely as is enough; None where
    /// that is not known. Growth at places where the surface ends is not told.
    pub(in crate::verify) fn bend_on(
        &self,
        side: f64,
        passage: &Passage<'_>,
        size: f64,
        is_enough: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        let Passage { tool, tip, .. } = passage;
        let reach = passage.reach();
        let slot = usize::from(tool.profile.is_point());
        let near = self.near.borrow();
        let known = near[slot].as_ref().filter(|near| near.holds_within(reach, tip, tool));
        let seen;
        let parts = match known {
            Some(near) => &near.parts,
            None => {
                seen = self.survey(tip, tool, reach, size)?.0;
                &seen
            }
        };
        if tool.patience.ends_after(work_of_pass(parts)) {
            return None;
        }
        let mut open = BinaryHeap::new();
        for part in parts.iter().filter(|part| passage.may_touch(&part.net)) {
            if tool.patience.ends_after(WORK_OF_BENDS) || part.bend_at_edges(reach, tip, tool) != Some(0.0) {
                return None;
            }
            open.push(passage.piece(part, part.net, side)?);
        }
        for _ in 0..HALVINGS {
            let Some(greatest) = open.peek().filter(|piece| piece.is_loose && !is_enough(piece.rate)) else {
                break;
            };
            if tool.patience.ends_after(WORK_OF_BENDS) {
                return None;
            }
            let [along, across] = extent(&greatest.net);
            let (part, net) = (greatest.part, greatest.net);
            let halves = if along >= across { halves_along(&net) } else { halves_across(&net) };
            open.pop();
            for half in halves {
                if passage.may_touch(&half) {
                    open.push(passage.piece(part, half, side)?);
                }
            }
        }
        Some(open.peek().map_or(0.0, |piece| piece.rate))
    }
}

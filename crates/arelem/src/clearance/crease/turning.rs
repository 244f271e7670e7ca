//! How far a surface keeps off a tool that turns evenly from one axis to another on its way.
//!
//! Every point of the tool goes on a chord from its first place to its last one, but for how far it swings out: at most an eighth of its
//! acceleration, the square of the angle by its arm. All chords lie in the convex hull of the first and the last position; but where the tool
//! leans on its way the hull of a long flank is wider than that by a quarter of the angle times its length, which may be much more than a band. So parts of
//! the surface are held against tangent planes that turn along with the tool.

use apt_geometry::{
    Vec3,
    surface::{Body, Limit, Nearer, Surface},
};

use super::{CLOSE, HALVED, MOST_LOOKS, MOST_POSITIONS, ROUGHLY, Tool, least_off, share_between};

#[cfg(test)]
thread_local! {
    /// Places of surfaces that this thread has held against tools that turn.
    pub(crate) static PLACES_ASKED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
    /// Positions between both ends that it has looked at for them.
    pub(crate) static POSITIONS_ASKED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// The way of a tool that turns, given with its ends, and the direction that leads it off the surface.
pub(in crate::clearance) struct Turning<'a> {
    pub(in crate::clearance) poses: [(&'a Tool<'a>, &'a Vec3); 2],
    pub(in crate::clearance) away: &'a Vec3,
}

impl Turning<'_> {
    /// Whether no place of a surface is nearer than a level: a tool that may be deeper in is moved out by as much, and must then be clear. Otherwise a
    /// place that is nearer, where one was found that is not one of those that are likely to be, which are looked at first.
    pub(in crate::clearance) fn clears(
        &self,
        surface: &Surface,
        level: f64,
        likely: impl Iterator<Item = Nearer>,
    ) -> Result<(), Option<Nearer>> {
        let Self { poses: [first, last], away } = *self;
        let hull = Hull::new([first, last], away * (-level).max(0.0));
        let wanted = level.max(least_off(first.0)) + hull.swing();
        for near in likely {
            let both = hull.turned_along(&near.place).map(|(distance, _)| distance);
            if both[0].min(both[1]) < wanted + near.stock {
                return Err(None);
            }
        }
        let distance = |place: &Vec3| hull.away(place);
        let at_ends = |place: &Vec3| hull.turned_along(place);
        let body = Body { at_ends: Some(&at_ends), ..Body::new(&distance) };
        let limit = Limit { looks: MOST_LOOKS, enough: wanted, patience: first.0.patience };
        surface.keeps_off_or_nears(body, wanted, limit).map(|_| ())
    }
}

/// Two positions of a tool and all between.
struct Hull<'a> {
    tool: &'a Tool<'a>,
    axes: [Vec3; 2],
    tips: [Vec3; 2],
    /// Angle between the axes.
    angle: f64,
    /// No point of the tool is farther from its end.
    reach: f64,
    /// Differences of distances below this are none.
    close: f64,
}

/// A direction out of a tool between both positions: away from its axis, and along it.
struct Out {
    axis: Vec3,
    radial: Vec3,
    wide: f64,
    high: f64,
}

impl Out {
    /// As a unit direction.
    fn straight(&self) -> Vec3 {
        (self.radial * self.wide + self.axis * self.high).try_normalize(0.0).unwrap_or(self.axis)
    }

    /// As one that makes the same angle with another axis.
    fn about(&self, axis: &Vec3) -> Option<Vec3> {
        let radial = (self.radial - axis * self.radial.dot(axis)).try_normalize(0.0)?;
        (radial * self.wide + axis * self.high).try_normalize(0.0)
    }
}

impl<'a> Hull<'a> {
    /// Both positions, moved out.
    fn new([first, last]: [(&'a Tool<'a>, &Vec3); 2], out: Vec3) -> Self {
        let axes = [first.0.axis, last.0.axis];
        let reach = first.0.reach();
        Self {
            tool: first.0,
            axes,
            tips: [first.1 + out, last.1 + out],
            angle: axes[0].cross(&axes[1]).norm().atan2(axes[0].dot(&axes[1])),
            reach,
            close: CLOSE * (reach + (last.1 - first.1).norm()),
        }
    }

    /// How far a point of the tool swings off its chord at most.
    fn swing(&self) -> f64 {
        self.angle * self.angle * self.reach / 8.0
    }

    /// A bound from below of the distance of a place from the convex hull, and the direction in which it grows: with any direction the farther of the
    /// tangent planes of both positions bounds it. The direction is that out of a position between them, best of one for which the planes are one.
    fn away(&self, place: &Vec3) -> (f64, Vec3) {
        let mut best = (f64::NEG_INFINITY, Vec3::zeros());
        self.between(place, |out| {
            let out = out.straight();
            let both = [0, 1].map(|k| self.beyond(k, &out, place));
            if both[0].min(both[1]) > best.0 {
                best = (both[0].min(both[1]), out);
            }
            both
        });
        best
    }

    /// The same from the chords of the tool's points alone, by tangent planes that turn along with the tool: how far the place is beyond that of the first
    /// position and that of the last one, and their normals.
    ///
    /// Between both the normal is `m = (1 − s) n₀ + s n₁`, no longer than one, and a point of the tool is at `(1 − s) x₀ + s x₁`. A place is farther
    /// from it along m than `(1 − s) n₀·(p − x₀) + s n₁·(p − x₁) + s (1 − s) (n₁ − n₀)·(x₁ − x₀)`, and the point moves as the tool end does but for
    /// what the angle takes it along.
    fn turned_along(&self, place: &Vec3) -> [(f64, Vec3); 2] {
        let nothing = [(f64::NEG_INFINITY, Vec3::zeros()); 2];
        let mut best = (f64::NEG_INFINITY, nothing);
        let way = self.tips[1] - self.tips[0];
        self.between(place, |out| {
            let [Some(first), Some(last)] = self.axes.each_ref().map(|axis| out.about(axis)) else {
                return [f64::NEG_INFINITY; 2];
            };
            let turn = last - first;
            let lost = 0.25 * (turn.norm() * self.angle * self.reach - turn.dot(&way)).max(0.0);
            let both =
                [(self.beyond(0, &first, place) - lost, first), (self.beyond(1, &last, place) - lost, last)];
            if both[0].0.min(both[1].0) > best.0 {
                best = (both[0].0.min(both[1].0), both);
            }
            both.map(|(distance, _)| distance)
        });
        best.1
    }

    /// Closes in the position between both from which a place is as far beyond what is told of the first one as of the last one.
    fn between(&self, place: &Vec3, mut beyond: impl FnMut(&Out) -> [f64; 2]) {
        #[cfg(test)]
        PLACES_ASKED.set(PLACES_ASKED.get() + 1);
        let way = self.tips[1] - self.tips[0];
        let square = way.norm_squared();
        let mut share =
            if square > 0.0 { ((place - self.tips[0]).dot(&way) / square).clamp(0.0, 1.0) } else { 0.5 };
        // Positions beside which that one is, and by how much less far the place is beyond the last one there.
        let mut beside: [Option<(f64, f64)>; 2] = [None; 2];
        let mut best = f64::NEG_INFINITY;
        for turn in 0..MOST_POSITIONS {
            let [start, end] = beyond(&self.out_of(share, place));
            best = start.min(end).max(best);
            if (start - end).abs() <= self.close + ROUGHLY * best.max(0.0) {
                break;
            }
            // The place lies ahead where the last position reaches farther.
            beside[usize::from(end >= start)] = Some((share, start - end));
            let [low, high] = [(0, 0.0), (1, 1.0)]
                .map(|(k, limit): (usize, f64)| beside[k].map_or(limit, |(share, _)| share));
            if high <= low {
                break;
            }
            share = share_between(beside, turn % HALVED == HALVED - 1);
        }
    }

    /// How far a place is beyond the tangent plane of one of the positions across a unit direction.
    fn beyond(&self, k: usize, out: &Vec3, place: &Vec3) -> f64 {
        let along = out.dot(&self.axes[k]);
        let across = (out - self.axes[k] * along).norm();
        out.dot(&(place - self.tips[k])) - self.tool.profile.support(across, along).0
    }

    /// The direction out of a position between both to a place.
    fn out_of(&self, share: f64, place: &Vec3) -> Out {
        #[cfg(test)]
        POSITIONS_ASKED.set(POSITIONS_ASKED.get() + 1);
        let between = |ends: &[Vec3; 2]| ends[0] * (1.0 - share) + ends[1] * share;
        let axis = between(&self.axes).try_normalize(0.0).unwrap_or(self.axes[0]);
        let from_tip = place - between(&self.tips);
        let along = from_tip.dot(&axis);
        let radial = from_tip - axis * along;
        let across = radial.norm();
        let radial = if across > 0.0 { radial / across } else { self.tool.across[0] };
        let (_, [wide, high]) = self.tool.profile.outward(across, along);
        Out { axis, radial, wide, high }
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;

    use super::*;
    use crate::{
        attitude::Sweep,
        clearance::{Gauge, Memory, crease::outward},
        tests::{cylinder, level, sheets::ruled, v},
    };

    /// Positions that are looked at for each place in the mean; halves alone take twice as many.
    const MOST_EACH: f64 = 6.0;

    /// A long flank leans towards a wall and away from it, about a place of which it stays off by as much: the wall is as far as its edges come.
    #[test]
    fn a_flank_that_leans_beside_a_wall_keeps_off_it() {
        let edge = |z: f64| (level(z), v(0.0, 0.0, z), v(2.0, 0.0, z), Vec3::z());
        let wall = Surface::from_geometry(&ruled([edge(0.0), edge(1.0)])).expect("a wall");
        let [bottom, top] = [-1e3, 1e3].map(|z| wall.foot(&v(1.0, 0.0, z)).point.z);
        let (middle, half) = (0.5 * (bottom + top), 0.5 * (top - bottom));
        // Ten times as high as the wall, and three times as far off it as the lean brings its edges nearer.
        let [radius, height, lean] = [0.25, 20.0 * half, 1e-3];
        let off = 3.0 * half * lean;
        let numbers = [2.0 * radius, 0.0, 0.0, 0.0, 0.0, 0.0, height];
        let cutter = Cutter::from_numbers(&numbers, 1.0).expect("cutter");
        let tool = Tool::new(cutter, Vec3::z());
        let leaning = |x: f64, lean: f64| {
            let axis = v(0.0, lean.sin(), lean.cos());
            (tool.turned(axis), v(x, radius + off, middle) - axis * (0.5 * height))
        };
        let [first, last] = [leaning(0.9, -lean), leaning(1.1, lean)];
        let least = off - half * lean;
        let way = Turning { poses: [(&first.0, &first.1), (&last.0, &last.1)], away: &Vec3::y() };
        let clears = |level: f64| way.clears(&wall, level, std::iter::empty()).is_ok();
        let asked = || [PLACES_ASKED.get(), POSITIONS_ASKED.get()].map(|count| count as f64);
        let before = asked();
        assert!(clears(0.95 * least));
        let [places, positions] = [0, 1].map(|k: usize| asked()[k] - before[k]);
        assert!(positions <= MOST_EACH * places, "{positions} positions for {places} places");
        assert!(!clears(1.05 * least));
    }

    /// Along a ridge the tool is nearer to that on its way than at both ends: what is in the way once is asked about first from then on, and so is what
    /// the tool touches at the ends.
    #[test]
    fn what_was_in_the_way_of_a_tool_that_turns_is_asked_about_first() {
        let radius = 4.0_f64;
        let drop = (radius * radius - 1.0).sqrt() - radius;
        let edge = |z: f64| {
            (cylinder(v(0.0, -radius, 0.0), Vec3::z(), radius), v(-1.0, drop, z), v(1.0, drop, z), Vec3::y())
        };
        let surface = Surface::from_geometry(&ruled([edge(-1.0), edge(1.0)])).expect("a ridge");
        let side = surface.signed_distance(&v(0.0, 1.0, 0.0)).signum();
        let memory = Memory::default();
        let gauge = Gauge { surface, on: false, side, thickness: 0.0, disk: None, memory };
        let cutter = Cutter::from_numbers(&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], 1.0).expect("cutter");
        let tool = Tool::new(cutter, Vec3::z());
        let leaning = |x: f64, lean: f64| (tool.turned(v(lean.sin(), 0.0, lean.cos())), v(x, 0.26, -0.5));
        let ask = |half: f64, level: f64| {
            let [(first, from), (last, to)] = [-1.0, 1.0].map(|sense| leaning(sense * half, 0.01 * sense));
            let contacts = [gauge.contact(&first, &from), gauge.contact(&last, &to)];
            let before = PLACES_ASKED.get();
            let [a, b] = &contacts;
            let clears = gauge.is_clear_while_turning([&first, &last], [(&from, a), (&to, b)], level);
            (clears, PLACES_ASKED.get() - before, a.clearance.min(b.clearance))
        };
        let (clears, places, at_ends) = ask(0.1, 0.0105);
        assert!(!clears && at_ends > 0.0105 && places > 2, "{places} places, {at_ends} off at the ends");
        // Again, and on a part of the way: what is touched at both ends, and what was in the way.
        for half in [0.1, 0.08] {
            let (clears, places, at_ends) = ask(half, 0.0105);
            assert!(!clears && at_ends > 0.0105 && places <= 3, "{places} places");
        }
        let (clears, places, at_ends) = ask(0.1, 0.013);
        assert!(!clears && at_ends < 0.013 && places == 1, "{places} places");
        assert!(ask(0.1, 0.0095).0);
    }

    /// A tool that turns is nowhere nearer to a place than the hull of its ends, less how far it swings out, nor nearer than planes that turn along
    /// with it; and no distance is below what either tells of it from another place.
    #[test]
    fn a_tool_that_turns_stays_in_the_hull_of_its_ends() {
        let cutter = Cutter::from_numbers(&[0.5, 0.1, 0.1661, 0.1, 0.0, 10.0, 1.0], 1.0).expect("cutter");
        let first = Tool::new(cutter, v(0.1, -0.1, 1.0).normalize());
        let last = first.turned(v(-0.2, 0.1, 1.0).normalize());
        let tips = [v(0.0, 0.1, -0.2), v(0.4, 0.0, -0.1)];
        let hull = Hull::new([(&first, &tips[0]), (&last, &tips[1])], Vec3::zeros());
        let sweep = Sweep::new(&first, (&tips[0], &first.axis), (&tips[1], &last.axis));
        let swing = hull.swing();
        let mut share = 0.3;
        let mut next = || {
            share = (share * 7.13_f64 + 0.29).fract();
            2.0 * share - 1.0
        };
        for _ in 0..300 {
            let place = v(next(), next(), next());
            let nearest = |place: &Vec3| {
                let at = |k: u32| {
                    let (tip, tool) = sweep.at(sweep.length * f64::from(k) / 40.0);
                    outward(&tool, &(place - tip)).0
                };
                (0..=40).map(at).fold(f64::INFINITY, f64::min).max(0.0)
            };
            let other = place + v(next(), next(), next());
            let way = other - place;
            let (distance, out) = hull.away(&place);
            assert!(distance <= nearest(&place) + swing + 1e-12, "{distance} at {place}");
            assert!(distance + out.dot(&way) <= nearest(&other) + swing + 1e-12);
            let both = hull.turned_along(&place);
            let lesser = |way: &Vec3| {
                both.map(|(distance, out)| distance + out.dot(way)).into_iter().fold(f64::INFINITY, f64::min)
            };
            assert!(lesser(&Vec3::zeros()) <= nearest(&place) + swing + 1e-12, "{both:?} at {place}");
            assert!(lesser(&way) <= nearest(&other) + swing + 1e-12);
        }
    }
}

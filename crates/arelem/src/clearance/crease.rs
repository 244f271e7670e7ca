//! Contact with a line on which a surface has an edge, as where it ends beside a tool: Newton's method along the line, and a proof that
//! no other place of the surface is nearer to the tool.
//!
//! The distance from the tool is a convex function of the place, and so is that from all that the tool goes through on a straight
//! way. Nowhere is it below its tangent, so that few parts of the surface need be looked at.

use apt_geometry::{
    Vec3,
    surface::{Away, Body, Chart, Crease, HalfSpace, Limit, Surface},
};

mod turning;

pub(super) use self::turning::Turning;
use super::{Contact, Memory, Tool, search::MISSED};

/// Bound of the steps along a line.
const MAX_STEPS: u32 = 40;
/// The first of them, in parameters.
const FIRST: f64 = 1e-3;
/// How many times as long as an end of a line is deep a way is that leads all of it out, where it is in with both.
const AMPLE: f64 = 2.0;
/// Bound of the lines that follow each other, and how far over the end of one, in its own length, another is looked for.
const MOST_LINES: u32 = 4;
const BEYOND: f64 = 1e-6;
/// A step below this, in parameters, ends them.
const SAME: f64 = 1e-13;
/// Bound of the positions of the tool on its way from which one that is nearest to a place is closed in.
const MOST_POSITIONS: u32 = 24;
/// Of so many positions of a body one is half way between two, where the others follow its slope.
const HALVED: u32 = 3;
/// How close a distance is told, as a share of what it is above the one to be decided on.
const SHARE_ABOVE: f64 = 0.01;
/// How much farther, relative to the size of the tool, the way may be than the tangents at its ends tell.
const CLOSE: f64 = 1e-12;
/// Share of a distance by which a bound of it may be too low: what is far away need not be known well.
const ROUGHLY: f64 = 1e-2;
/// Length of the difference of two unit directions that is rounding: that of Newton's method at an edge.
const SQUARE: f64 = 1e-5;
/// How far off, in reaches of the tool, a line must be: what goes through it is no nearer than nothing. Half of what is left open of a contact.
const NOT_THROUGH: f64 = 0.5 * MISSED;
/// Bound of the parts of a surface that one proof looks at: a look takes up to a microsecond, and beside the vertex of a cone of rulings all of its
/// strips come near.
const MOST_LOOKS: u32 = 32_000;

/// A place of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    crease: Crease,
    at: f64,
}

/// How the distance from the tool changes along a line at one of its places, by its parameter, and the direction out of the tool there.
#[derive(Debug, Clone, Copy)]
struct Slope {
    slope: f64,
    out: Vec3,
}

/// A tool in a place beside a surface, on a side of it.
#[derive(Clone, Copy)]
pub(super) struct Beside<'a> {
    pub(super) tool: &'a Tool<'a>,
    pub(super) surface: &'a Surface,
    pub(super) side: f64,
    pub(super) tip: &'a Vec3,
}

/// Signed distance of a point from a tool, and a unit direction in which it grows at least as fast as straight on.
pub(super) fn outward(tool: &Tool, from_tip: &Vec3) -> (f64, Vec3) {
    let (along, across, radial) = tool.split(from_tip);
    let (distance, [wide, high]) = tool.profile.outward(across, along);
    (distance, radial * wide + tool.axis * high)
}

impl Beside<'_> {
    /// The line that a place of the surface lies on, if it is one.
    pub(super) fn spot(&self, surface: &Vec3) -> Option<Spot> {
        let (crease, at) = self.surface.crease_at(&self.surface.place(surface)?, self.side)?;
        Some(Spot { crease, at })
    }

    /// The contact at an edge beside a place of the surface that is nearest to the tool, if there are edges.
    pub(super) fn nearest_beside(&self, surface: &Vec3) -> Option<Contact> {
        let place = self.surface.place(surface)?;
        let spots = self.surface.creases_beside(&place, self.side).into_iter().flatten();
        let touches = spots.filter_map(|(crease, at)| Some(self.touch(&Spot { crease, at })?.1));
        touches.min_by(|a, b| a.clearance.total_cmp(&b.clearance))
    }

    /// The place of a line and of those that it goes on with, found from one near by, that is nearest to the tool: the contact there.
    pub(super) fn touch(&self, spot: &Spot) -> Option<(Spot, Contact)> {
        let mut spot = *spot;
        for _ in 0..MOST_LINES {
            let (found, sides) = self.lowest(&spot)?;
            let slope = sides[1].slope;
            let leaves = found.at <= 0.0 && slope > 0.0 || found.at >= 1.0 && slope < 0.0;
            let [point, way] = self.surface.on_crease(&found.crease, found.at)?;
            // Over the end of the line the nearest place on the surface tells what goes on.
            let beyond = point + way * (BEYOND * (found.at - 0.5).signum());
            match self.spot(&beyond).filter(|next| leaves && next.crease != found.crease) {
                Some(next) => spot = next,
                None => {
                    let (clearance, out) = self.apart(&point, &sides);
                    let tool = point - out * clearance;
                    return Some((found, Contact { clearance, gradient: -out, tool, surface: point }));
                }
            }
        }
        None
    }

    /// Distance of the place of a line that is nearest to the tool, and the direction out of it. Where the end of a ruled or polyconic surface is deep
    /// below an edge of the tool, so that it comes out on one side of it before and on another behind, it comes out over that edge, square
    /// to both. Sculptured surfaces, which end in faces, are not looked at so: a motion onto what is tangent to them would end before.
    fn apart(&self, point: &Vec3, [before, behind]: &[Slope; 2]) -> (f64, Vec3) {
        let (clearance, out) = outward(self.tool, &(point - self.tip));
        let turn = behind.slope - before.slope;
        let may_cross = clearance < 0.0 && matches!(self.surface, Surface::Ruled(_) | Surface::PolyConic(_));
        let crosses = may_cross && before.slope < 0.0 && behind.slope > 0.0;
        let over = (before.out * behind.slope - behind.out * before.slope) / turn;
        match over.try_normalize(0.0).filter(|_| crosses) {
            Some(over_edge) => (clearance / over.norm(), over_edge),
            None => (clearance, out),
        }
    }

    /// The place of one line that is nearest to the tool, and how the distance changes just before it and just behind; the last one is that
    /// there.
    fn lowest(&self, spot: &Spot) -> Option<(Spot, [Slope; 2])> {
        let look = |at: f64| {
            let [point, way] = self.surface.on_crease(&spot.crease, at)?;
            let out = outward(self.tool, &(point - self.tip)).1;
            Some(Slope { slope: out.dot(&way), out })
        };
        let (mut low, mut high) = (0.0, 1.0);
        let mut at = spot.at.clamp(0.0, 1.0);
        let mut here = look(at)?;
        let mut sides = [here; 2];
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..MAX_STEPS {
            if here.slope > 0.0 {
                (high, sides[1]) = (at, here);
            } else {
                (low, sides[0]) = (at, here);
            }
            let Slope { slope, .. } = here;
            let secant = before.map(|(t, s)| at - slope * (at - t) / (slope - s));
            let next = match secant.filter(|next| *next >= low && *next <= high) {
                Some(next) => next,
                // The line is followed from near by.
                None if before.is_none() => (at - FIRST * slope.signum()).clamp(low, high),
                None => 0.5 * (low + high),
            };
            before = Some((at, slope));
            if (next - at).abs() <= SAME || slope == 0.0 {
                break;
            }
            at = next;
            here = look(at)?;
        }
        Some((Spot { at, ..*spot }, sides))
    }

    /// The contact at an edge where the last one was, if that is shown, and how much nearer to the surface another point of the tool may
    /// be.
    pub(super) fn followed(&self, memory: &Memory) -> Option<(Contact, f64)> {
        let (spot, touch) = self.touch(&memory.crease(self.side)?)?;
        let slack = MISSED * (self.tool.radius() + self.tool.profile.top.height);
        let off = self.leading_off(touch);
        let shown = off.filter(|contact| {
            self.clears(contact, contact.clearance - slack) && !self.has_shorter_way(contact, slack)
        });
        memory.remember_crease(self.side, shown.map(|_| spot));
        shown.map(|contact| (contact, slack))
    }

    /// The contact at an edge, found from a place of it near by, if the tool comes off the surface over it: another may be nearer.
    pub(super) fn along(&self, spot: &Spot) -> Option<Contact> {
        self.leading_off(self.touch(spot)?.1)
    }

    /// Whether a tool that is a line, behind an end by a contact, is in the surface with its own ends by less: any way out that is
    /// shorter tells. The other end may be in by as much, or the surface bend under it, so that one twice as long is looked at, too.
    pub(super) fn has_shorter_way(&self, contact: &Contact, slack: f64) -> bool {
        let Self { tool, surface, side, tip } = *self;
        if tool.radius() > 0.0 || contact.clearance >= 0.0 {
            return false;
        }
        let ends = [*tip, tip + tool.axis * tool.profile.top.height];
        ends.iter().any(|end| {
            let foot = surface.foot(end);
            let (clearance, gradient) = (side * foot.distance, foot.normal * side);
            let way = Contact { clearance, gradient, tool: *end, surface: foot.point };
            let is_way_out = |level: f64| level > contact.clearance && self.clears(&way, level - slack);
            clearance < 0.0 && [1.0, AMPLE].into_iter().any(|times| is_way_out(times * clearance))
        })
    }

    /// A bound from above of the clearance while the tool end goes straight from here to another place, by the contacts at both, if these
    /// are on one line at which the surface ends. The distance of a place from the tool is a convex function of both, so that it is nowhere
    /// greater than at the ends for a place that goes along the chord; and the line is no farther off that than it sags. A tool that is a
    /// line and behind the end is as far behind the chord as its way in between says.
    pub(super) fn at_most_along(&self, to: &Vec3, [first, last]: [&Contact; 2]) -> Option<f64> {
        let Spot { crease, at } = self.spot(&first.surface)?;
        let Spot { crease: other, at: there } = self.spot(&last.surface)?;
        if crease != other {
            return None;
        }
        let [start, end] =
            [self.surface.on_crease(&crease, at)?[0], self.surface.on_crease(&crease, there)?[0]];
        let chord = self.tool.split(&(end - start)).2;
        let value = |place: &Vec3, tip: &Vec3, contact: &Contact| {
            let from_tip = place - tip;
            if self.tool.radius() > 0.0 || contact.clearance >= 0.0 {
                return outward(self.tool, &from_tip).0;
            }
            let (_, across, radial) = self.tool.split(&from_tip);
            -across * (radial - chord * chord.dot(&radial)).norm()
        };
        let most = value(&start, self.tip, first).max(value(&end, to, last));
        Some(most + self.surface.crease_sag(&crease, [at, there])?)
    }

    /// Whether the surface has an edge within a radius of the tool of one of its places.
    pub(super) fn has_edge_by(&self, surface: &Vec3) -> bool {
        let Some(place) = self.surface.place(surface) else { return false };
        let beside = self.surface.creases_beside(&place, self.side).into_iter().flatten();
        let mut edges = beside.filter_map(|(crease, at)| self.surface.on_crease(&crease, at));
        edges.any(|[point, _]| (point - surface).norm() <= self.tool.radius())
    }

    /// Whether a tool that is moved away from a contact comes off the surface on its own side of it. How far places of the surface are from
    /// the tool does not tell.
    pub(super) fn is_off_own_side(&self, contact: &Contact) -> bool {
        let end = self.surface.edge_at(&contact.surface);
        end.is_none_or(|end| self.side * end.normal.dot(&contact.gradient) >= 0.0)
    }

    /// The contact with an edge over which the tool comes off the surface on its own side. Within a tool that is a line there is no edge: it is
    /// behind it by as much as it is away from it. A way out that is longer than the tool is no depth of it: drawn back along its axis it is out of
    /// all that it is in by less.
    pub(super) fn leading_off(&self, touch: Contact) -> Option<Contact> {
        let behind = (self.tool.radius() <= 0.0).then(|| touch.seen_from_behind());
        let out = [Some(touch), behind].into_iter().flatten().find(|contact| self.is_off_own_side(contact));
        out.filter(|contact| -contact.clearance <= self.tool.reach())
    }

    /// Whether a contact is the nearest: no place of the surface is nearer to the tool than a level.
    pub(super) fn clears(&self, contact: &Contact, level: f64) -> bool {
        let normal = square_to(self.surface, self.side, contact);
        clears(self.surface, self.tool, [self.tip, self.tip], [&contact.gradient, &normal], level)
    }
}

/// The direction from the surface that a contact leads off it in: square to its tangent plane there, if it is that but for rounding. Along
/// a plane wall the rounding of the gradient at its end would tell of places far from there.
pub(super) fn square_to(surface: &Surface, side: f64, contact: &Contact) -> Vec3 {
    let chart = surface.place(&contact.surface).and_then(|place| surface.chart(&place));
    let normal = chart.and_then(|Chart { first: [du, dv], sense, .. }| {
        Some(du.cross(&dv).try_normalize(0.0)? * (sense * side))
    });
    let is_that = |normal: &Vec3| (normal - contact.gradient).norm() <= SQUARE;
    normal.filter(is_that).unwrap_or(contact.gradient)
}

/// Whether no place of a surface is nearer to a tool than a level, wherever that is on a straight way of its end; `away` leads it off
/// the surface. One that may be deeper in is moved out by as much, and must then be clear. A second direction is that of a plane between
/// both, where there is one.
pub(super) fn clears(
    surface: &Surface,
    tool: &Tool,
    [from, to]: [&Vec3; 2],
    [away, normal]: [&Vec3; 2],
    level: f64,
) -> bool {
    let start = from + away * (-level).max(0.0);
    let way = to - from;
    let wanted = level.max(least_off(tool));
    let close = Closeness { length: CLOSE * (tool.reach() + way.norm()), wanted };
    let body = |place: &Vec3| outward(tool, place);
    let distance = |place: &Vec3| nearest_on_way(&body, &(place - start), &way, close);
    let tips = [&start, &(start + way)];
    let beside = |out: &Vec3, square: &Vec3| facing(tool, tips, &across_edge(tool, out, square, &-normal));
    let within = Some(facing(tool, tips, &-normal));
    let body = Body { within, beside: Some(&beside), ..Body::new(&distance) };
    let limit = Limit { looks: MOST_LOOKS, enough: wanted, patience: tool.patience };
    surface.keeps_off_body(body, wanted, limit).is_some()
}

/// The distance from which on a place of a surface is out of a tool for certain: a line has no inside.
fn least_off(tool: &Tool) -> f64 {
    if tool.radius() > 0.0 { 0.0 } else { NOT_THROUGH * tool.reach() }
}

/// The half-space across a unit direction that holds a tool in some places of its end.
fn facing(tool: &Tool, tips: [&Vec3; 2], outward: &Vec3) -> HalfSpace {
    let along = outward.dot(&tool.axis);
    let across = (outward - tool.axis * along).norm();
    let reach = tool.profile.support(across, along).0;
    let level = tips.into_iter().map(|tip| outward.dot(tip) + reach).fold(f64::NEG_INFINITY, f64::max);
    HalfSpace { outward: *outward, level }
}

/// The normal of a part of a surface, turned into the plane through the tool's axis in which the way `out` of the tool at its nearest place lies: at a
/// sharp edge there the tool is on one side of the plane across it, if the surface is. It points as `outward` does.
fn across_edge(tool: &Tool, out: &Vec3, normal: &Vec3, outward: &Vec3) -> Vec3 {
    let around = tool.axis.cross(out);
    let square = around.norm_squared();
    let along_edge = if square > 0.0 { around * (around.dot(normal) / square) } else { Vec3::zeros() };
    let across = (normal - along_edge).try_normalize(0.0).unwrap_or(*outward);
    if across.dot(outward) < 0.0 { -across } else { across }
}

/// How close the least distance of a place from a body on its way is told: to a length, and to a share of what it is above a distance on which
/// it is to be decided.
#[derive(Debug, Clone, Copy)]
pub(super) struct Closeness {
    pub(super) length: f64,
    pub(super) wanted: f64,
}

impl Closeness {
    fn is_met(&self, found: &Position) -> bool {
        found.lost <= self.length.max(SHARE_ABOVE * (found.bound - self.wanted))
    }
}

/// What a body in one position of its way tells of all.
#[derive(Clone, Copy)]
struct Position {
    share: f64,
    /// The bound, and the direction in which it grows.
    bound: f64,
    out: Vec3,
    /// How fast the distance grows in that direction over the whole way, and by how much it may fall along it.
    slope: f64,
    lost: f64,
}

/// A bound from below of the distance of a place from a convex body on its way, given from the body's place at the beginning, and the
/// direction in which it grows: with any position of the body the tangent plane there bounds the distances from all others.
pub(super) fn nearest_on_way(body: &Away<'_>, place: &Vec3, way: &Vec3, close: Closeness) -> (f64, Vec3) {
    let square = way.norm_squared();
    let at = |share: f64| {
        let (distance, out) = body(&(place - way * share));
        let slope = out.dot(way);
        // Along the way the distance falls by no more than this.
        let lost = ((1.0 - share) * slope).max(-share * slope);
        Position { share, bound: distance - lost, out, slope, lost }
    };
    let mut last = at(if square > 0.0 { (place.dot(way) / square).clamp(0.0, 1.0) } else { 0.0 });
    let mut best = last;
    // Positions beside which the nearest one is: from one it is ahead, from the other behind.
    let mut beside: [Option<Position>; 2] = [None; 2];
    for turn in 0..MOST_POSITIONS {
        if close.is_met(&last) {
            break;
        }
        // The distance falls along the way where the place lies ahead.
        beside[usize::from(last.slope <= 0.0)] = Some(last);
        let slopes = beside.map(|known| known.map(|known| (known.share, known.slope)));
        last = at(share_between(slopes, turn % HALVED == HALVED - 1));
        if last.bound > best.bound {
            best = last;
        }
    }
    (best.bound, best.out)
}

/// Between two shares of a way, with what vanishes at the one that is looked for, where that would if it changed evenly, or the middle: it jumps where another
/// piece is nearest.
fn share_between([ahead, behind]: [Option<(f64, f64)>; 2], is_halved: bool) -> f64 {
    let (low, high) = (ahead.map_or(0.0, |(share, _)| share), behind.map_or(1.0, |(share, _)| share));
    let level = match (ahead, behind) {
        (Some((_, a)), Some((_, b))) if !is_halved => low + (high - low) * a / (a - b),
        _ => f64::NAN,
    };
    if level > low && level < high { level } else { 0.5 * (low + high) }
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;

    use super::*;
    use crate::tests::{level, sheets::ruled, v};

    /// No place of a sheet is inside of a line that goes through it, which is as deep in the sheet as its end is under it.
    #[test]
    fn a_line_is_not_clear_of_a_sheet_that_it_goes_through() {
        let edge = |z: f64| (level(z), v(0.0, 0.0, z), v(2.0, 0.0, z), Vec3::z());
        let sheet = Surface::from_geometry(&ruled([edge(0.0), edge(1.0)])).expect("a sheet");
        let cutter = Cutter::from_numbers(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0], 1.0).expect("a cutter");
        let out = Vec3::y();
        let depth = 0.3;
        for axis in [out, v(0.4, 1.0, 0.1).normalize()] {
            let tool = Tool::new(cutter, axis);
            let tip = v(1.0, -depth, 0.5);
            let is_clear = |level: f64| clears(&sheet, &tool, [&tip, &tip], [&out, &out], level);
            assert!(is_clear(-depth - 1e-6));
            assert!(!is_clear(-depth + 1e-6));
            assert!(!is_clear(-0.1));
        }
    }

    /// What is well above the distance to be decided on is told from few positions, and within a hundredth of that; what is not, from some more.
    #[test]
    fn few_positions_tell_where_a_tool_is_nearest_on_its_way() {
        let cutter = Cutter::from_numbers(&[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0], 1.0).expect("a cutter");
        let tool = Tool::new(cutter, v(0.1, -0.2, 1.0).normalize());
        let looks = std::cell::Cell::new(0);
        let body = |place: &Vec3| {
            looks.set(looks.get() + 1);
            outward(&tool, place)
        };
        let way = v(0.02, 0.005, -0.001);
        let mut most = [0; 2];
        for k in 0..200 {
            let (sine, cosine) = (0.7 * f64::from(k)).sin_cos();
            let place = v(0.4 * cosine, 0.4 * sine, 0.003 * f64::from(k) - 0.2);
            let on_way = |k: u32| outward(&tool, &(place - way * (f64::from(k) / 1000.0))).0;
            let nearest = (0..=1000).map(on_way).fold(f64::INFINITY, f64::min);
            for (most, wanted) in most.iter_mut().zip([nearest - 0.01, nearest]) {
                looks.set(0);
                let close = Closeness { length: 1e-12, wanted };
                let (found, _) = nearest_on_way(&body, &place, &way, close);
                assert!(found <= nearest + 1e-12, "{k}: {found} above {nearest}");
                assert!(found >= nearest - 0.011 * (nearest - wanted) - 1e-6, "{k}: {found}, not {nearest}");
                *most = looks.get().max(*most);
            }
        }
        assert!(most[0] <= 4 && most[1] <= 20, "{most:?} positions");
    }
}

//! How strongly the clearance can bend upward while the tool moves: a bound over all points of the tool that may come
//! into contact on the way.
//!
//! For every single point of the tool the distance to the surface bends by no more than the surface's bound. The
//! clearance, the least of these functions, then bends by no more either, whatever jumps contact makes.

use std::f64::consts::FRAC_PI_2;

use apt_geometry::{
    Vec3,
    surface::{Bend, Region, Surface},
};

use super::{Gauge, Tool, closed_form, near, tool::Circle};

/// Bound of the boxes into which the tool is cut.
const MAX_BOXES: u32 = 600;
/// The same where some box has no bound yet.
const MAX_BOXES_UNBOUNDED: u32 = 2400;
/// The same on a sculptured surface, where each box asks many patches: none has a bound where a path leaves the surface.
const MAX_BOXES_UNBOUNDED_BY_PATCH: u32 = 96;
/// Boxes that are looked at between two questions whether to give up.
const BOXES_A_QUESTION: u32 = 8;
/// A box is small enough when its bound exceeds that of its centre by this factor at most.
const CLOSE: f64 = 1.25;

/// The same for surfaces whose bounds over large boxes are near enough.
const CLOSE_BY_CHART: f64 = 1.5;

/// Bound of the cuts about a place that told last that there is no bound: to a part in thirty thousand along each edge.
const MOST_CUTS: u32 = 45;
/// Half of the edge of a box that is not halved any more, relative to how far the points of the tool stray.
const SMALL: f64 = 0.5;

/// Angle, radians, and share of a length that are rounding.
const ROUNDING: f64 = 1e-9;

#[cfg(test)]
thread_local! {
    /// Boxes of the tool that this thread has looked at.
    pub(crate) static BOXES: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// A box of points in the frame of the tool: across, across, along the axis.
#[derive(Debug, Clone, Copy)]
struct Cell {
    middle: [f64; 3],
    half: [f64; 3],
    /// Radius of balls about the points, which then count in place of them.
    ball: f64,
}

/// The middle of the box that told last that there is no bound, or none of use, in the frame of the tool: mostly it does so again.
pub(crate) type Witness = std::cell::Cell<Option<[f64; 3]>>;

#[cfg(test)]
thread_local! {
    /// Bounds that this thread has asked steady balls for.
    pub(crate) static STEADY_ASKED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// The bound of [`upward_bend`] where the tool is in a ball in which nearest places do not jump: that takes no search.
pub(crate) fn steady_bend(
    gauge: &Gauge,
    tool: &Tool,
    tip: &Vec3,
    spread: f64,
    range: [f64; 2],
) -> Option<f64> {
    #[cfg(test)]
    STEADY_ASKED.set(STEADY_ASKED.get() + 1);
    if gauge.on {
        return None;
    }
    match disc_bend(gauge, tool, tip, spread, range) {
        Some(Bend::AtMost(bend)) => return Some(bend),
        Some(Bend::Unbounded) => return None,
        None => {}
    }
    let (tool, tip) = &gauge.body(tool, tip);
    near::Around::new(gauge, tool, tip, spread).upward_bend(spread, range)
}

/// The bound of [`upward_bend`] where the tool is a disc seen along the surface: all of it is as near as its end, less its radius, so that
/// it bends as the distance of that.
fn disc_bend(gauge: &Gauge, tool: &Tool, tip: &Vec3, spread: f64, range: [f64; 2]) -> Option<Bend> {
    let surface = gauge.met(tool);
    let (tool, tip) = &gauge.body(tool, tip);
    let closed_form::Disc { radius, foot } = closed_form::disc(tool, surface, tip)?;
    let [lowest, highest] = range.map(|distance| distance + radius);
    let region = Region { center: *tip, radius: spread, lowest, highest };
    Some(surface.bend(gauge.side, &foot, &region, tool.patience))
}

/// Bound of the second derivative along any direction of the distances of all points of the tool that come within
/// `range` (lowest, highest distance from the surface on the gauge's side, THICK included) while no point of the tool
/// strays farther than `spread` from its place for the given tool end. There is none once the tool's patience is over, asked once in
/// [`BOXES_A_QUESTION`] boxes; `None` where it is greater than what `is_of_use` takes, as places of the tool that are likely to be in
/// contact mostly tell at once. Boxes about the witness are looked at first, then those about these places.
pub(crate) fn upward_bend(
    gauge: &Gauge,
    tool: &Tool,
    (tip, likely, witness): (&Vec3, &[Vec3], &Witness),
    spread: f64,
    range: [f64; 2],
    is_of_use: &dyn Fn(f64) -> bool,
) -> Option<Bend> {
    if gauge.on {
        let region = Region { center: *tip, radius: spread, lowest: range[0], highest: range[1] };
        let foot = gauge.surface.foot(tip);
        return Some(gauge.surface.bend(gauge.side, &foot, &region, tool.patience));
    }
    if let Some(bend) = disc_bend(gauge, tool, tip, spread, range) {
        return Some(bend);
    }
    let touch = || gauge.contact(tool, tip).tool;
    let surface = gauge.met(tool);
    let (tool, tip) = &gauge.body(tool, tip);
    let corner = corner(tool);
    let within = Within { surface, side: gauge.side, tool, tip, corner: corner.as_ref(), spread, range };
    // Of what is known to be far away nothing comes within range.
    let near = near::Around::new(gauge, tool, tip, spread);
    let mut cells = boxes(tool, corner.as_ref(), near.within(range[1] + spread));
    let feet = near.feet();
    // What a surface of lines in one direction says of a place is told without a search of its parts.
    if surface.generator().is_some()
        && likely
            .iter()
            .filter_map(|place| within.bend_at(place))
            .any(|least| matches!(least, Bend::AtMost(bend) if !is_of_use(bend)))
    {
        return None;
    }
    let in_frame: Vec<[f64; 3]> = likely.iter().map(|place| frame_of(tool, &(place - tip))).collect();
    if let Some(place) = witness.take() {
        cut_down(&mut cells, &place, spread);
    }
    let mut bounds =
        Bounds { greatest: 0.0, needed: 0.0, seen: 0, is_probed: false, within, feet, is_of_use };
    while let Some(cell) = cells.pop() {
        match bounds.look(&cell, || if likely.is_empty() { vec![touch()] } else { with_middles(likely) }) {
            Look::Closed => {}
            Look::Open => cells.extend(cell.halves_towards(&in_frame)),
            Look::Unbounded => return Some(Bend::Unbounded),
            Look::Witnessed(found) => {
                witness.set(Some(cell.middle));
                return found;
            }
        }
    }
    Some(Bend::AtMost(bounds.greatest))
}

/// The bounds of the boxes that have been looked at.
struct Bounds<'a> {
    within: Within<'a>,
    feet: near::Feet<'a>,
    is_of_use: &'a dyn Fn(f64) -> bool,
    /// The bound of all of them, and what it is at least.
    greatest: f64,
    needed: f64,
    seen: u32,
    is_probed: bool,
}

/// What a look at a box leads to.
enum Look {
    /// Nothing more is asked of it.
    Closed,
    /// Its halves are looked at.
    Open,
    /// There is no bound.
    Unbounded,
    /// That is the bound of all, and the box tells it.
    Witnessed(Option<Bend>),
}

impl Bounds<'_> {
    /// Looks at a box; `probes` are places of the tool that are likely to be in contact.
    fn look(&mut self, cell: &Cell, probes: impl FnOnce() -> Vec<Vec3>) -> Look {
        let Within { surface, side, tool, tip, corner, spread, range } = self.within;
        self.seen += 1;
        #[cfg(test)]
        BOXES.set(BOXES.get() + 1);
        if self.seen.is_multiple_of(BOXES_A_QUESTION) && tool.patience.is_over() {
            return Look::Unbounded;
        }
        if cell.beside(tool.radius()) || corner.is_some_and(|corner| cell.is_held(tool, corner)) {
            return Look::Closed;
        }
        let [lowest, highest] = range.map(|distance| distance + cell.ball);
        let center = cell.center(tool, tip);
        let reach = Vec3::from(cell.half).norm() + spread;
        let foot = match self.feet.foot(&center) {
            Some(foot) => foot,
            None if surface.keeps_off(&center, reach + highest.max(-lowest)) => return Look::Closed,
            None => surface.foot(&center),
        };
        let distance = side * foot.distance;
        let is_out_of = |reach: f64| distance - reach > highest || distance + reach < lowest;
        if is_out_of(reach) {
            return Look::Closed;
        }
        let bend_within = |radius: f64| {
            let region = Region { center, radius, lowest, highest };
            surface.bend(side, &foot, &region, tool.patience)
        };
        let found = bend_within(reach);
        let is_small = cell.is_small(spread);
        if let Bend::AtMost(bound) = found
            && (is_small || self.is_close(bound))
        {
            self.greatest = self.greatest.max(bound);
            return Look::Closed;
        }
        let at_best = bend_within(spread);
        // Every box about a place in contact has it within its reach, and no better bound.
        let is_met = !is_out_of(spread);
        match at_best {
            Bend::AtMost(least) if is_met && !(self.is_of_use)(least) => return Look::Witnessed(None),
            Bend::AtMost(least) => self.needed = self.needed.max(least),
            Bend::Unbounded if is_met => return Look::Witnessed(Some(at_best)),
            Bend::Unbounded => {}
        }
        // Where the surface ends within reach of a place in contact no box helps.
        let is_first = found == Bend::Unbounded && !std::mem::replace(&mut self.is_probed, true);
        if is_first && probes().iter().any(|place| self.within.bend_at(place) == Some(Bend::Unbounded)) {
            return Look::Unbounded;
        }
        self.settle(found, is_small)
    }

    /// Whether a bound is near enough to what the bound of all is at least.
    fn is_close(&self, bound: f64) -> bool {
        let close = if self.within.surface.has_charts() { CLOSE_BY_CHART } else { CLOSE };
        bound <= self.greatest.max(close * self.needed)
    }

    /// Whether a box with such a bound is halved.
    fn settle(&mut self, found: Bend, is_small: bool) -> Look {
        let limit = match (found, self.within.surface) {
            (Bend::Unbounded, Surface::Sculptured(_)) => MAX_BOXES_UNBOUNDED_BY_PATCH,
            (Bend::Unbounded, _) => MAX_BOXES_UNBOUNDED,
            _ => MAX_BOXES,
        };
        let is_last = is_small || self.seen >= limit;
        match found {
            Bend::AtMost(bound) if is_last || self.is_close(bound) => {
                self.greatest = self.greatest.max(bound);
                Look::Closed
            }
            Bend::Unbounded if is_last => Look::Witnessed(Some(found)),
            _ => Look::Open,
        }
    }
}

/// A tool beside a surface, whose points stray no farther from their places than a spread, and count within a range of distances.
#[derive(Clone, Copy)]
struct Within<'a> {
    surface: &'a Surface,
    side: f64,
    tool: &'a Tool<'a>,
    tip: &'a Vec3,
    corner: Option<&'a Circle>,
    spread: f64,
    range: [f64; 2],
}

impl Within<'_> {
    /// What a bound for all of the tool is at least, for a point of it, if that counts; what a round corner holds counts with the centre of its
    /// ball there.
    fn bend_at(&self, place: &Vec3) -> Option<Bend> {
        let Self { surface, side, tool, tip, spread, range, .. } = *self;
        let mut foot = surface.foot(place);
        let (mut center, mut ball) = (*place, 0.0);
        if let Some(corner) = self.corner.filter(|_| is_at_corner(tool, &(place - tip))) {
            let (_, _, radial) = tool.split(&(place - tip));
            ball = corner.ball;
            center = tip + tool.axis * corner.height + radial * corner.radius;
            foot = surface.foot(&center);
        }
        let distance = side * foot.distance;
        let [lowest, highest] = range.map(|distance| distance + ball);
        if distance - spread > highest || distance + spread < lowest {
            return None;
        }
        let region = Region { center, radius: spread, lowest, highest };
        Some(surface.bend(side, &foot, &region, tool.patience))
    }
}

/// A place, from the tool end, in the frame of the tool.
fn frame_of(tool: &Tool, place: &Vec3) -> [f64; 3] {
    [tool.across[0].dot(place), tool.across[1].dot(place), tool.axis.dot(place)]
}

/// Places of a convex tool, and those half way from each to the next: contact goes from one to the other, if it does not jump.
fn with_middles(places: &[Vec3]) -> Vec<Vec3> {
    let middles = places.windows(2).map(|pair| (pair[0] + pair[1]) * 0.5);
    places.iter().copied().chain(middles).collect()
}

/// The balls of a round corner, if they are all in the tool and hold what of it is neither above the corner nor nearer to the
/// axis: the distances of that part, less than those of their centres by the radius of the balls, bend as these do, so that
/// neither an edge of the surface nor a sharp bend of it lets them bend without bound.
fn corner(tool: &Tool) -> Option<Circle> {
    let profile = &tool.profile;
    let (center, ball) = (profile.center, profile.arc);
    // Its arc touches both lines.
    let normals = [tool.cutter.alpha, FRAC_PI_2 - tool.cutter.beta];
    let touches = profile.fan.iter().zip(normals).all(|(end, normal)| (end - normal).abs() <= ROUNDING);
    let inside = center.height + ball <= profile.top.height * (1.0 + ROUNDING);
    let within = profile.lower.radius - center.radius;
    let holds = within.hypot(profile.upper.height - center.height) <= ball * (1.0 + ROUNDING);
    (ball > 0.0 && !profile.is_barrel() && touches && inside && holds).then_some(Circle {
        radius: center.radius,
        height: center.height,
        ball,
    })
}

/// Whether the balls of a round corner are all in the tool.
pub(super) fn holds_balls(tool: &Tool) -> bool {
    corner(tool).is_some()
}

/// Whether a place of the tool, from its end, is neither above a round corner nor nearer to the axis.
fn is_at_corner(tool: &Tool, place: &Vec3) -> bool {
    let (along, across, _) = tool.split(place);
    let (lower, upper) = (tool.profile.lower, tool.profile.upper);
    across >= lower.radius * (1.0 - ROUNDING) && along <= upper.height * (1.0 + ROUNDING)
}

/// Boxes that hold the tool from its end or a height of its flank up to another height, with the centres of its corner in place
/// of what its balls hold.
fn boxes(tool: &Tool, corner: Option<&Circle>, [low, height]: [f64; 2]) -> Vec<Cell> {
    let between = |radius: f64, [low, high]: [f64; 2], ball: f64| Cell {
        middle: [0.0, 0.0, 0.5 * (low + high)],
        half: [radius, radius, 0.5 * (high - low)],
        ball,
    };
    let Some(corner) = corner.filter(|_| low <= 0.0) else {
        return vec![between(tool.radius(), [low, height], 0.0)];
    };
    let (lower, upper) = (tool.profile.lower, tool.profile.upper);
    let mut cells = vec![between(corner.radius, [corner.height; 2], corner.ball)];
    if lower.radius > 0.0 {
        cells.push(between(lower.radius, [0.0, upper.height], 0.0));
    }
    if height > upper.height {
        cells.push(between(tool.radius(), [upper.height, height], 0.0));
    }
    cells
}

/// Cuts the box that holds a place into one about it that is halved no more, which is looked at first, and those left over.
fn cut_down(cells: &mut Vec<Cell>, place: &[f64; 3], spread: f64) {
    let Some(index) = cells.iter().position(|cell| cell.square_from(place) == 0.0) else { return };
    let mut cell = cells.remove(index);
    for _ in 0..MOST_CUTS {
        if cell.is_small(spread) {
            break;
        }
        let [other, near] = cell.halves_towards(&[*place]);
        cells.push(other);
        cell = near;
    }
    cells.push(cell);
}

impl Cell {
    /// Whether no place of the box counts: none of the circle of centres, or the balls of the corner hold what of the tool is in it.
    fn is_held(&self, tool: &Tool, corner: &Circle) -> bool {
        let near = |k: usize| (self.middle[k].abs() - self.half[k]).max(0.0);
        let far = |k: usize| self.middle[k].abs() + self.half[k];
        if self.ball > 0.0 {
            return near(0).hypot(near(1)) > corner.radius || far(0).hypot(far(1)) < corner.radius;
        }
        let (lower, upper) = (tool.profile.lower, tool.profile.upper);
        near(0).hypot(near(1)) >= lower.radius && self.middle[2] + self.half[2] <= upper.height
    }

    /// True if the box lies farther from the axis than any point of the tool.
    fn beside(&self, radius: f64) -> bool {
        let near = |k: usize| (self.middle[k].abs() - self.half[k]).max(0.0);
        near(0).hypot(near(1)) > radius
    }

    /// Its middle in space.
    fn center(&self, tool: &Tool, tip: &Vec3) -> Vec3 {
        let [x, y, z] = self.middle;
        tip + tool.across[0] * x + tool.across[1] * y + tool.axis * z
    }

    /// Whether it is halved no more where places stray so far.
    fn is_small(&self, spread: f64) -> bool {
        self.half.iter().all(|half| *half <= SMALL * spread)
    }

    /// Both halves along the longest edge, last that which is nearer to one of these places: it is looked at first. What touches bends the
    /// clearance most, or has no bound.
    fn halves_towards(&self, places: &[[f64; 3]]) -> [Self; 2] {
        let halves = self.halves();
        let [low, high] = halves
            .map(|half| places.iter().map(|place| half.square_from(place)).fold(f64::INFINITY, f64::min));
        if low < high { [halves[1], halves[0]] } else { halves }
    }

    /// The squared distance from a place; zero from one inside.
    fn square_from(&self, place: &[f64; 3]) -> f64 {
        (0..3).map(|k| ((place[k] - self.middle[k]).abs() - self.half[k]).max(0.0).powi(2)).sum()
    }

    /// Both halves along the longest edge.
    fn halves(&self) -> [Self; 2] {
        let mut k = 0;
        for other in 1..3 {
            if self.half[other] > self.half[k] {
                k = other;
            }
        }
        let (mut low, mut high) = (*self, *self);
        low.half[k] *= 0.5;
        high.half[k] *= 0.5;
        low.middle[k] -= low.half[k];
        high.middle[k] += high.half[k];
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(cell: &Cell) -> f64 {
        cell.half.iter().product()
    }

    /// What is cut about a place is cut into boxes that hold all that was there, and the one about the place is looked at first.
    #[test]
    fn a_small_box_about_a_place_is_cut_out_and_nothing_is_lost() {
        let whole = Cell { middle: [0.0, 0.0, 1.5], half: [0.5, 0.5, 1.5], ball: 0.0 };
        let aside = Cell { middle: [0.0, 0.0, 3.5], half: [0.5; 3], ball: 0.1 };
        let (place, spread) = ([0.31, -0.2, 2.9], 0.01);
        let mut cells = vec![whole, aside];
        cut_down(&mut cells, &place, spread);
        let first = cells.last().expect("boxes");
        assert!(first.square_from(&place) == 0.0 && first.is_small(spread), "{first:?}");
        assert!(!cells.iter().rev().skip(1).any(|cell| cell.square_from(&place) == 0.0), "{cells:?}");
        assert!((cells.iter().map(volume).sum::<f64>() - volume(&whole) - volume(&aside)).abs() < 1e-12);
        // Of what is in no box nothing is cut, and points that do not stray end it, too.
        let mut same = vec![whole];
        cut_down(&mut same, &[2.0, 0.0, 0.0], spread);
        assert_eq!(same.len(), 1);
        cut_down(&mut same, &place, 0.0);
        assert_eq!(same.len(), 1 + MOST_CUTS as usize);
    }

    #[test]
    fn the_half_that_is_nearer_to_a_place_is_looked_at_first() {
        let whole = Cell { middle: [0.0; 3], half: [1.0, 2.0, 1.0], ball: 0.0 };
        for (y, expected) in [(-3.0, -1.0), (0.4, 1.0)] {
            let [_, first] = whole.halves_towards(&[[0.0, y, 0.0], [0.0, 9.0, 0.0]]);
            assert_eq!(first.middle[1], expected);
        }
    }
}

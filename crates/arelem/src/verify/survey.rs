//! What of a surface of patches is near a tool: one survey serves until the tool has moved by its margin.

mod closer;
mod nearest;

use std::{
    cell::{Cell, OnceCell, RefCell},
    sync::Arc,
};

use apt_geometry::Vec3;

pub(super) use self::closer::Passage;
use self::nearest::near;
pub(super) use self::nearest::{nearest_by, nearest_to};
use super::{
    clearance::Reading,
    followed::{Following, Kept, Manner},
    patch::{
        Bends, Edges, Net, Patch, ball, ball_of_curve, between_across, extent, halves, halves_across,
        halves_along, jet, sides,
    },
    span::Bend,
    strip::Cubic,
    tool::{Profile, Tool},
};

/// Parts of a survey from which on they are not halved.
const PARTS: usize = 6_000;
/// Product of size and curvature above which a part is halved.
const BENT: f64 = 0.25;
/// The same of a part that is nearly plane: it is bent little across its length, by which its size is measured.
const PLAINLY_BENT: f64 = 1.0;
/// How far the control points of a part may be from those of a parallelogram, relative to its shorter side, for its parameters to
/// spread evenly.
const PLAIN: f64 = 0.05;
/// Size below which a part is not halved: in radii of the tool, and for a tool without body relative to the surface.
const SMALLEST_RADII: f64 = 0.25;
const SMALLEST: f64 = 0.01;
/// Greatest size of a part, in radii of the tool.
const PART_RADII: f64 = 2.0;
/// Margin of a survey: in radii of the tool, and for a tool without body relative to the surface.
const MARGIN_RADII: f64 = 1.0;
const POINT_MARGIN: f64 = 0.05;
/// Share of it where the tool was not seen near before: that may be for one reading alone.
const FIRST_MARGIN: f64 = 0.125;
/// Distance from which on no survey is made, in radii of the tool, and for a tool without body relative to the surface: so far away very
/// much is about as near, and a search for the one place that is nearest looks at less.
const FAR_RADII: f64 = 32.0;
const POINT_FAR: f64 = 1.0;
/// Halvings of an edge that tell whether it is near.
const EDGE_HALVINGS: u32 = 6;
/// What a part counts in units of work, and how it bends, also at its edges.
const WORK_OF_PART: u32 = 2;
const WORK_OF_BENDS: u32 = 24;
/// How many parts are one unit of work where hardly more than their distances is asked.
const PARTS_A_UNIT: usize = 16;
/// Halvings for one reading of the part that the contact is on, and product of its size and curvature below which none helps.
const DIVISIONS: usize = 12;
const TIGHT: f64 = 0.01;
/// Pieces of a tool that is a straight line, of all sizes, that one reading may look at.
const PIECES: u32 = 63;
/// Accuracy of a distance, relative to how far the patches may be off the surface.
const WARM_RESOLUTION_OF_ERROR: f64 = 0.25;
/// Steps between tool and surface to a place that is near.
const APPROACHES: u32 = 6;

/// A surface in patches, with what was seen of it last.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    pub(super) patches: Arc<[Patch]>,
    /// Whether it ends at both sides of all patches, across.
    ends_across: bool,
    /// Whether it is all of what a tool on a side meets, so that the sign of the distance does not change beyond an end.
    is_body: bool,
    /// For tools with a body, and for points.
    near: RefCell<[Option<Near>; 2]>,
}

/// What a distance need not be closer than.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accuracy {
    pub(super) rounding: f64,
    /// How far the patches may be off the surface between the curves.
    pub(super) error: f64,
}

/// A part of a patch.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) net: Net,
    pub(super) center: Vec3,
    pub(super) radius: f64,
    /// Found when they are asked for.
    bends: OnceCell<Option<Bends>>,
    /// Curvature that the surface may have more.
    pub(super) slack: f64,
    pub(super) against: bool,
    pub(super) edges: Edges,
    /// The way of the tool at which it may come as near as that way: its distance is at least this less the way so far.
    pub(super) far: Cell<f64>,
}

/// All parts near a tool in one position.
#[derive(Debug, Clone)]
struct Near {
    profile: Profile,
    tip: Vec3,
    axis: Vec3,
    /// Where the tool was last, and its way until then.
    here: [Vec3; 2],
    way: f64,
    /// How far the tool may move until there may be others.
    margin: f64,
    /// No other part was nearer.
    bound: f64,
    /// How far the parts may be off the surface, relative to its patches between the curves.
    stretch: f64,
    parts: Vec<Part>,
    /// The contact found last.
    last: Option<(usize, [f64; 2])>,
    /// Whether what takes long has shown the clearance that was asked for last.
    is_shown_at_length: bool,
}

impl Sheet {
    /// Of patches that other surveys are made of too; where it ends their sides tell, and perhaps all their sides across.
    pub(super) fn new(patches: Arc<[Patch]>, ends_across: bool) -> Self {
        Self { patches, ends_across, is_body: false, near: RefCell::new([None, None]) }
    }

    /// The same as all of what a tool on a side meets.
    pub(super) fn of_body(patches: Arc<[Patch]>) -> Self {
        Self { is_body: true, ..Self::new(patches, false) }
    }

    /// Whether it is all of what a tool on a side meets: nothing comes out past its ends.
    pub(super) fn is_body(&self) -> bool {
        self.is_body
    }

    /// The parts nearer to the tool than `bound` and how far they may be off the surface, relative to its patches between the
    /// curves; where there are very many they are not halved further. None once the tool's patience is over.
    fn survey(&self, tip: &Vec3, tool: &Tool<'_>, bound: f64, size: f64) -> Option<(Vec<Part>, f64)> {
        let widest = tool.profile.widest();
        let [smallest, greatest] = if widest > 0.0 {
            [SMALLEST_RADII * widest, PART_RADII * widest]
        } else {
            [SMALLEST * size, f64::INFINITY]
        };
        let (middle, girth) = tool.ball_about(tip);
        let mut parts = Vec::new();
        let mut stretch: f64 = 0.0;
        let mut open: Vec<(Net, Edges)> = Vec::new();
        for patch in self.patches.iter() {
            let Some(range) = patch.within(&middle, bound + girth) else { continue };
            let mut edges = patch.edges;
            edges.sides[2] = (edges.sides[2] || self.ends_across) && range[0] <= 0.0;
            edges.sides[3] = (edges.sides[3] || self.ends_across) && range[1] >= 1.0;
            open.push((between_across(&patch.net, range), edges));
            while let Some((net, edges)) = open.pop() {
                if tool.patience.ends_after(WORK_OF_PART) {
                    return None;
                }
                let (center, radius) = ball(&net);
                let far = tool.distance(&(center - tip)) - radius;
                if far > bound {
                    continue;
                }
                let (far, slack, against) = (Cell::new(far), patch.slack, patch.against);
                let part = Part { net, center, radius, bends: OnceCell::new(), slack, against, edges, far };
                let is_flat = || radius <= greatest && (part.is_plain() || part.bend_at_most(BENT));
                if radius <= smallest || parts.len() >= PARTS || is_flat() {
                    stretch = stretch.max(patch.stretch(patch.range_in(&center, radius)));
                    parts.push(part);
                } else {
                    let [along, across] = extent(&part.net);
                    let is_along = along >= across;
                    let halves = if is_along { halves_along(&part.net) } else { halves_across(&part.net) };
                    open.extend(halves.into_iter().zip(edges.halves(is_along)));
                }
            }
        }
        Some((parts, stretch))
    }

    /// How far patches may be off the surface where they are nearer to a tool than `reach`, relative to those between the curves.
    pub(super) fn stretch(&self, tip: &Vec3, tool: &Tool<'_>, reach: f64) -> f64 {
        let (middle, girth) = tool.ball_about(tip);
        let near =
            self.patches.iter().filter_map(|patch| Some((patch, patch.within(&middle, reach + girth)?)));
        near.map(|(patch, range)| patch.stretch(range)).fold(0.0, f64::max)
    }

    /// The clearance on a side where balls show it, and how far the parts near the tool may be off the surface; by what takes long
    /// only if it is asked for.
    pub(super) fn at(
        &self,
        side: f64,
        tip: &Vec3,
        tool: &Tool<'_>,
        (size, is_thorough): (f64, bool),
        accuracy: Accuracy,
    ) -> Option<(Reading, f64)> {
        let slot = usize::from(tool.profile.is_point());
        let mut near = self.take(slot, tip, tool, size)?;
        let off = near.stretch * accuracy.error;
        let tolerance = accuracy.rounding.max(WARM_RESOLUTION_OF_ERROR * off);
        let asked = Asked { sheet: self, side, size, tolerance };
        let mut found = near.shown(&asked, tip, tool, Manner { is_thorough: false, piece: None });
        // What takes long is tried where the rest does not show it, if it is asked for or mostly does.
        let is_at_length = found.is_none();
        if is_at_length && (is_thorough || near.is_shown_at_length) {
            found = near.shown(&asked, tip, tool, Manner { is_thorough: true, piece: None });
        }
        if is_at_length && (is_thorough || near.is_shown_at_length) {
            found = found.or_else(|| near.shown_in_pieces(&asked, tip, tool));
        }
        near.is_shown_at_length = is_at_length && found.is_some();
        self.near.borrow_mut()[slot] = Some(near);
        found.map(|reading| (reading, off))
    }

    /// Notes a place to follow the next contact from, if it is among what was surveyed last.
    pub(super) fn look_at(&self, place: &Vec3, tool: &Tool<'_>) -> bool {
        let mut near = self.near.borrow_mut();
        let Some(near) = near[usize::from(tool.profile.is_point())].as_mut() else { return false };
        near.last = nearest_to(&near.parts, place, f64::INFINITY)
            .and_then(|k| Some((k, near.parts.get(k)?.nearest_parameters(place))));
        near.last.is_some()
    }

    /// A bound from above of the distance: that of a place about as near as any, where tool and surface lead in turns, from patch to
    /// patch.
    fn upper(&self, tip: &Vec3, tool: &Tool<'_>) -> Option<f64> {
        let mut from = tip + tool.axis * (0.5 * tool.profile.top_height());
        let mut least = f64::INFINITY;
        for _ in 0..APPROACHES {
            let remote = self.patches.iter().map(|patch| (patch.remoteness(&from), patch));
            let (_, patch) = remote.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let place = near(&patch.net, &from).1;
            let (distance, beside) = tool.signed_distance(&(place - tip));
            least = least.min(distance);
            from = tip + beside;
        }
        least.is_finite().then_some(least)
    }

    /// What is near the tool, from before or seen now; nothing where the tool is far from the surface.
    fn take(&self, slot: usize, tip: &Vec3, tool: &Tool<'_>, size: f64) -> Option<Near> {
        let known = self.near.borrow_mut()[slot].take().filter(|near| near.profile == *tool.profile);
        let moved = known.as_ref().map_or(f64::INFINITY, |near| near.moved(tip, tool));
        let known = match known {
            Some(mut near) if moved <= near.margin => {
                near.way += near.since(tip, tool);
                near.here = [*tip, tool.axis];
                return Some(near);
            }
            other => other,
        };
        let widest = tool.profile.widest();
        let [wide, far] = if widest > 0.0 {
            [MARGIN_RADII * widest, FAR_RADII * widest]
        } else {
            [POINT_MARGIN * size, POINT_FAR * size]
        };
        let known = known.filter(|_| moved <= 4.0 * wide);
        let margin = if known.is_some() { wide } else { FIRST_MARGIN * wide };
        let is_shown_at_length = known.as_ref().is_some_and(|near| near.is_shown_at_length);
        // The contact of before is a bound for now, unless the tool went far.
        let before = known.and_then(|near| {
            let (k, at) = near.last?;
            Some(jet(&near.parts.get(k)?.net, at.map(|x| x.clamp(0.0, 1.0)))[0])
        });
        let upper = match before {
            Some(place) => tool.distance(&(place - tip)),
            None => self.upper(tip, tool)?,
        };
        if upper > far {
            return None;
        }
        let bound = upper.max(0.0) + 2.0 * margin;
        let (parts, stretch) = self.survey(tip, tool, bound, size)?;
        let last = before.and_then(|place| {
            let apart = |part: &Part| (part.center - place).norm() / part.radius;
            nearest_by(&parts, apart).map(|k| (k, [0.5; 2]))
        });
        Some(Near {
            profile: tool.profile.clone(),
            tip: *tip,
            axis: tool.axis,
            here: [*tip, tool.axis],
            way: 0.0,
            margin,
            bound,
            stretch,
            parts,
            last,
            is_shown_at_length,
        })
    }

    /// How the slope of the clearance on a side can grow where the tool and all of it move no farther than `travel` from a
    /// position; None where that is not known. The clearances at the ends are without thickness.
    pub(super) fn bend(
        &self,
        side: f64,
        tip: &Vec3,
        tool: &Tool<'_>,
        values: [f64; 2],
        travel: f64,
        size: f64,
    ) -> Option<Bend> {
        let [first, last] = values;
        let depth = (0.5 * travel - first.min(last)).max(0.0);
        // No contact on the way is farther from where the tool was.
        let reach = first.abs().max(last.abs()) + 1.5 * travel;
        let slot = usize::from(tool.profile.is_point());
        let near = self.near.borrow();
        let known = near[slot].as_ref().filter(|near| near.holds_within(reach, tip, tool));
        let seen;
        // What is known of their distances, and the way since.
        let (parts, since) = match known {
            Some(near) => (&near.parts, near.way + near.since(tip, tool)),
            None => {
                seen = self.survey(tip, tool, reach, size)?.0;
                (&seen, 0.0)
            }
        };
        let mut rate: f64 = 0.0;
        if tool.patience.ends_after(work_of_pass(parts)) {
            return None;
        }
        for part in parts {
            if part.far.get() - since > reach || tool.distance(&(part.center - tip)) - part.radius > reach {
                continue;
            }
            if tool.patience.ends_after(WORK_OF_BENDS) {
                return None;
            }
            let at_edges = part.bend_at_edges(reach, tip, tool);
            rate = rate.max(at_edges.filter(|found| self.is_body || *found <= 0.0)?);
            // Behind the surface.
            let behind = usize::from((side > 0.0) != part.against);
            rate = rate.max(part.bends()?.hollow[behind] + part.slack);
        }
        Bend::over(rate, depth)
    }
}

/// What a pass over parts counts in units of work.
pub(super) fn work_of_pass(parts: &[Part]) -> u32 {
    (parts.len() / PARTS_A_UNIT) as u32 + 1
}

/// What is asked of a survey.
struct Asked<'a> {
    sheet: &'a Sheet,
    side: f64,
    size: f64,
    tolerance: f64,
}

impl Near {
    /// The clearance where balls show it.
    fn shown(&mut self, asked: &Asked<'_>, tip: &Vec3, tool: &Tool<'_>, manner: Manner) -> Option<Reading> {
        let Asked { sheet, side, size, tolerance } = *asked;
        let (loose, nearer, looks) = (&Cell::new(None), &Cell::new(None), &Cell::new(0));
        for _ in 0..DIVISIONS {
            let (parts, margin, way) = (&self.parts, self.margin, self.way);
            let kept = Kept { manner, loose, nearer, looks };
            let following =
                Following { sheet, parts, margin, way, side, tip, tool, size, tolerance, kept, led: None };
            let found = following.reading(&mut self.last);
            if found.is_some() {
                return found;
            }
            let is_divided = loose.take().is_some_and(|at| self.divide(at));
            if !is_divided {
                break;
            }
            nearer.set(None);
        }
        None
    }

    /// The clearance of a tool that is a straight line by its pieces: no ball holds a long line beside a surface that is hollow along
    /// it.
    fn shown_in_pieces(&mut self, asked: &Asked<'_>, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
        let length = tool.profile.top_height();
        if tool.profile.widest() > 0.0 || length <= 0.0 {
            return None;
        }
        // Over a hollow one of the ends is nearest.
        let end = Profile::tool_end();
        let accuracy = Accuracy { rounding: asked.tolerance, error: 0.0 };
        let at_end =
            |place: Vec3| asked.sheet.at(asked.side, &place, &tool.with(&end), (asked.size, true), accuracy);
        let ends = [at_end(*tip)?.0, at_end(tip + tool.axis * length)?.0];
        let mut best = if ends[0].value <= ends[1].value { ends[0] } else { ends[1] };
        let mut least = ends.map(|end| end.value - end.error).into_iter().fold(f64::INFINITY, f64::min);
        // From its end up: one that is off the surface is on its side if the end of the one below is.
        let mut is_clear = ends[0].value - ends[0].error > 0.0;
        let mut open = vec![[0.0, length]];
        for _ in 0..PIECES {
            let Some([low, high]) = open.pop() else {
                return Some(Reading { error: best.value - least, ..best });
            };
            let profile = tool.profile.below(high - low);
            let (piece, from) = (tool.with(&profile), tip + tool.axis * low);
            let manner = Manner { is_thorough: true, piece: Some(best.value) };
            let enough = best.value - asked.tolerance;
            if is_clear && self.keeps_off(asked, &from, &piece, enough) {
                least = least.min(enough);
                continue;
            }
            match self.shown(asked, &from, &piece, manner) {
                Some(reading) => {
                    is_clear = reading.value - reading.error > 0.0;
                    least = least.min(reading.value - reading.error);
                    if reading.value < best.value {
                        let place = reading.place.map(|place| place + tool.axis * low);
                        best = Reading { place, ..reading };
                    }
                }
                None => open.extend([[0.5 * (low + high), high], [low, 0.5 * (low + high)]]),
            }
        }
        None
    }

    /// Whether no part is nearer to a piece of the tool than a distance, as far as balls and half-spaces tell that hold the parts: most of a
    /// long line is far from what it touches, where contacts need not be known. Which side it is on that does not tell.
    fn keeps_off(&self, asked: &Asked<'_>, tip: &Vec3, piece: &Tool<'_>, least: f64) -> bool {
        let Asked { sheet, side, size, tolerance } = *asked;
        let (loose, nearer, looks) = (&Cell::new(None), &Cell::new(None), &Cell::new(0));
        let manner = Manner { is_thorough: false, piece: Some(least) };
        let kept = Kept { manner, loose, nearer, looks };
        let (parts, margin, way) = (&self.parts, self.margin, self.way);
        let following =
            Following { sheet, parts, margin, way, side, tip, tool: piece, size, tolerance, kept, led: None };
        following.keeps_off(least)
    }

    /// Halves a part about a place of it, so that the bounds of its bends are closer there; not where they are close anyway.
    fn divide(&mut self, (index, at): (usize, [f64; 2])) -> bool {
        let Some(part) = self.parts.get(index).filter(|_| self.parts.len() < PARTS) else { return false };
        if part.bends().is_none() || part.bend_at_most(TIGHT) {
            return false;
        }
        let ([first, last], way) = part.halves();
        let is_last = at[way] >= 0.5;
        let mut at = at;
        at[way] = 2.0 * at[way] - if is_last { 1.0 } else { 0.0 };
        let (here, beside) = if is_last { (last, first) } else { (first, last) };
        if let Some(place) = self.parts.get_mut(index) {
            *place = here;
        }
        self.parts.push(beside);
        self.last = Some((index, at));
        true
    }

    /// Whether it tells all that is within reach of a tool.
    fn holds_within(&self, reach: f64, tip: &Vec3, tool: &Tool<'_>) -> bool {
        self.profile == *tool.profile && self.moved(tip, tool) + reach <= self.bound
    }

    /// No place of the tool is farther from where it was.
    fn moved(&self, tip: &Vec3, tool: &Tool<'_>) -> f64 {
        (tip - self.tip).norm() + (tool.axis - self.axis).norm() * tool.profile.reach()
    }

    /// The same from where it was last.
    fn since(&self, tip: &Vec3, tool: &Tool<'_>) -> f64 {
        let [last, axis] = self.here;
        (tip - last).norm() + (tool.axis - axis).norm() * tool.profile.reach()
    }
}

impl Part {
    fn bends(&self) -> Option<Bends> {
        *self.bends.get_or_init(|| Bends::of(&self.net))
    }

    /// Whether the product of its size and curvature is known to be no more.
    fn bend_at_most(&self, most: f64) -> bool {
        self.bends().is_some_and(|b| b.hollow[0].max(b.hollow[1]) * self.radius <= most)
    }

    /// Whether its control points are so near to those of a parallelogram that its bends, which cost more, need not be found to
    /// say that they are little.
    fn is_plain(&self) -> bool {
        let [first, .., last] = &self.net;
        let (corner, across) = (first[0], last[0] - first[0]);
        let along = first[3] - corner;
        let shortest = along.norm().min(across.norm());
        let twist = last[3] - last[0] - along;
        let mut most: f64 = 0.0;
        for (j, row) in self.net.iter().enumerate() {
            let v = j as f64 / 3.0;
            let (start, way) = (corner + across * v, along + twist * v);
            for (i, place) in row.iter().enumerate() {
                most = most.max((place - start - way * (i as f64 / 3.0)).norm_squared());
            }
        }
        let most = most.sqrt();
        // The control points of a bend stand out by a ninth of its curvature times the square of its length.
        let (room, bend) = (PLAIN * shortest, 9.0 * most / (shortest * shortest));
        most <= room && twist.norm() <= room && bend * self.radius <= PLAINLY_BENT
    }

    /// Its halves, and which of its parameters they share out.
    pub(super) fn halves(&self) -> ([Self; 2], usize) {
        let [along, across] = extent(&self.net);
        let is_along = along >= across;
        let [first, last] = if is_along { halves_along(&self.net) } else { halves_across(&self.net) };
        let edges = self.edges.halves(is_along);
        let half = |net: Net, edges: Edges| {
            let (center, radius) = ball(&net);
            Self { net, center, radius, bends: OnceCell::new(), edges, ..self.clone() }
        };
        ([half(first, edges[0]), half(last, edges[1])], usize::from(!is_along))
    }

    /// How the clearance may bend where the tool is nearer than `reach` to a place at which the surface ends or bends sharply: as the tool is
    /// round there, zero without such a place; none where that is not known.
    fn bend_at_edges(&self, reach: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<f64> {
        if self.edges.sides == [false; 4] {
            return (!self.edges.within).then_some(0.0);
        }
        let apart = |place: &Vec3| tool.distance(&(place - tip));
        let mut open: Vec<(Cubic, u32)> = Vec::new();
        let edges = sides(&self.net).into_iter().zip(self.edges.sides);
        open.extend(edges.filter(|(_, is_edge)| *is_edge).map(|(curve, _)| (curve, EDGE_HALVINGS)));
        let mut rate: f64 = 0.0;
        while let Some((curve, halvings)) = open.pop() {
            let (center, radius) = ball_of_curve(&curve);
            if apart(&center) - radius > reach {
                continue;
            }
            if let Some(round) = tool.roundness_at(&(center - tip), radius, reach) {
                rate = rate.max(round);
                continue;
            }
            let is_met = apart(&curve[0]) <= reach;
            if halvings == 0 || is_met && tool.roundness_at(&(curve[0] - tip), 0.0, reach).is_none() {
                return None;
            }
            open.extend(halves(&curve).map(|half| (half, halvings - 1)));
        }
        (!self.edges.within).then_some(rate)
    }

    /// Whether it may have an end, or a sharp bend, as near to a place as `reach`.
    pub(super) fn may_end_within(&self, reach: f64, place: &Vec3) -> bool {
        let is_near = |center: &Vec3, radius: f64| (center - place).norm() - radius <= reach;
        if !is_near(&self.center, self.radius) {
            return false;
        }
        let mut open: Vec<(Cubic, u32)> = Vec::new();
        let edges = sides(&self.net).into_iter().zip(self.edges.sides);
        open.extend(edges.filter(|(_, is_edge)| *is_edge).map(|(curve, _)| (curve, EDGE_HALVINGS)));
        while let Some((curve, halvings)) = open.pop() {
            let (center, radius) = ball_of_curve(&curve);
            if !is_near(&center, radius) {
                continue;
            }
            if halvings == 0 || is_near(&curve[0], 0.0) {
                return true;
            }
            open.extend(halves(&curve).map(|half| (half, halvings - 1)));
        }
        self.edges.within
    }

    /// About its place nearest to a point.
    pub(super) fn near(&self, x: &Vec3) -> Vec3 {
        near(&self.net, x).1
    }

    /// About the parameters of that place.
    pub(super) fn nearest_parameters(&self, x: &Vec3) -> [f64; 2] {
        near(&self.net, x).0
    }

    /// Curvature of the balls on a side of the surface that hold no place of the part.
    pub(super) fn hollow(&self, side: f64) -> Option<f64> {
        self.bends().map(|b| b.hollow[usize::from(self.sense(side) < 0.0)])
    }

    /// The side of the surface as one of along × across.
    pub(super) fn sense(&self, side: f64) -> f64 {
        if self.against { -side } else { side }
    }
}

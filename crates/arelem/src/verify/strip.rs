//! Patches of surface, cubic both ways, and their nearest point to the tool.
//!
//! The distance of a point to a convex tool is a convex function, so at any place of a patch a half-space that holds the
//! tool bounds the distance of every other place: by the least height of the control points over it. That makes a
//! branch and bound whose gap shrinks with the square of the cell.

use std::{cmp::Ordering, collections::BinaryHeap};

use apt_geometry::Vec3;

use super::{
    patch::{Net, Patch, halves_across, halves_along, jet},
    tool::Tool,
    weighed::lower_bound,
};

/// Cells that one search may look at; what is left then goes into the gap.
const CELL_BUDGET: usize = 20_000;
/// Share of its distance by which another place may be nearer, or deeper, than one that is about the nearest.
const ABOUT: f64 = 0.01;
/// What a cell counts in units of work.
const WORK_OF_CELL: u32 = 2;
/// Distance from the tool's boundary, relative to the tool, below which the difference of two points is no direction: rounded, it
/// would say less of what is as far away as the tool is long than a distance need be close.
const SURE_DIRECTION: f64 = 1e-4;
/// Steps of Newton's method from a place to the nearest about it, their derivatives' step and the last of them, in parameters.
const SETTLING_STEPS: usize = 12;
const DIFFERENCE: f64 = 1e-7;
const LAST_STEP: f64 = 1e-7;
/// Halvings of a step that does not lead nearer.
const SHORTENINGS: usize = 4;
/// What a step counts in units of work.
const WORK_OF_STEP: u32 = 4;

/// Control points of a cubic.
pub(super) type Cubic = [Vec3; 4];

/// The place of a patch that is nearest to the tool, or deepest in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// Distance to the tool; negative inside.
    pub(super) value: f64,
    /// How much less the true least value could be.
    pub(super) gap: f64,
    /// Unit normal of the tool there, outward.
    pub(super) outward: Vec3,
    /// The place.
    pub(super) point: Vec3,
    /// The patch, or piece of a curve, and the parameter 0 … 1 along it.
    pub(super) piece: usize,
    pub(super) along: f64,
    /// Parameter 0 … 1 across it.
    pub(super) across: f64,
}

impl Touch {
    /// The place of the tool straight across.
    pub(super) fn opposite(&self) -> Vec3 {
        self.point - self.outward * self.value
    }
}

/// A part of a patch.
#[derive(Debug, Clone)]
struct Cell {
    net: Net,
    piece: usize,
    /// First parameter and width, along the piece.
    along: [f64; 2],
    /// The same across.
    across: [f64; 2],
    /// No place of the cell is nearer.
    lower: f64,
    /// The direction to halve it in.
    halve_along: bool,
}

/// That of which less is known is the greater: it is looked at first.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        other.lower.total_cmp(&self.lower)
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

pub(super) fn lerp(a: &Vec3, b: &Vec3, t: f64) -> Vec3 {
    a + (b - a) * t
}

/// The place of a cubic at a parameter.
pub(super) fn place(c: &Cubic, t: f64) -> Vec3 {
    let (ab, bc, cd) = (lerp(&c[0], &c[1], t), lerp(&c[1], &c[2], t), lerp(&c[2], &c[3], t));
    lerp(&lerp(&ab, &bc, t), &lerp(&bc, &cd, t), t)
}

/// A third of the derivative of a cubic at a parameter.
pub(super) fn tangent(c: &Cubic, t: f64) -> Vec3 {
    let (ab, bc, cd) = (c[1] - c[0], c[2] - c[1], c[3] - c[2]);
    lerp(&lerp(&ab, &bc, t), &lerp(&bc, &cd, t), t)
}

/// How far the middle of a cell is from a tool, the direction in which that is left behind fastest, how far any of its places is
/// at least, and how much that bound varies along and across.
#[derive(Clone, Copy)]
struct Seen {
    value: f64,
    outward: Vec3,
    lower: f64,
    spread: [f64; 2],
}

impl Seen {
    /// Of two tools that which is farther away; either bounds how far places are from the farther.
    fn farther(self, other: Self) -> Self {
        let lower = self.lower.max(other.lower);
        if self.value >= other.value { Self { lower, ..self } } else { Self { lower, ..other } }
    }
}

/// A place of a patch with its parameters, how far from the tool it is, in which direction, and how fast half the square of that grows by
/// both parameters; less than that falls in the tool.
struct Across {
    at: [f64; 2],
    point: Vec3,
    value: f64,
    outward: Vec3,
    slopes: [f64; 2],
}

struct Search<'a> {
    /// Where the tool end is, in one place or several: what counts of a place is its greatest distance.
    tips: &'a [Vec3],
    tool: &'a Tool<'a>,
    resolution: f64,
    /// By what share of its distance another place may be nearer than the best, where that is more than the resolution.
    about: f64,
    sure: f64,
    best: Option<Touch>,
    /// Whether that has been led to the nearest place about it.
    is_settled: bool,
}

impl Search<'_> {
    /// By how much nearer than one at a distance of `value` another place may be.
    fn open(&self, value: f64) -> f64 {
        self.resolution.max(self.about * value.abs())
    }

    /// No place as far away as that is looked for where one at a distance of `value` is known.
    fn enough(&self, value: f64) -> f64 {
        value - self.open(value)
    }

    /// Distance of a place from the tool with its end at `tip`, and the direction in which that is left behind fastest.
    fn measure(&self, tip: &Vec3, x: &Vec3, surface_normal: &Vec3) -> (f64, Vec3) {
        let w = x - tip;
        let (distance, q) = self.tool.signed_distance(&w);
        let away = w - q;
        let size = away.norm();
        (distance, if size > 0.0 { away * (distance.signum() / size) } else { *surface_normal })
    }

    /// The least height of a patch over the half-space with an outward normal that holds the tool, and how much the height
    /// varies along and across.
    fn bound(&self, tip: &Vec3, net: &Net, outward: &Vec3) -> (f64, [f64; 2]) {
        let mut lower = f64::INFINITY;
        let mut spread = [0.0f64; 2];
        let (mut lowest, mut highest) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        for row in net {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (i, place) in row.iter().enumerate() {
                let height = outward.dot(place);
                (low, high) = (low.min(height), high.max(height));
                (lowest[i], highest[i]) = (lowest[i].min(height), highest[i].max(height));
            }
            lower = lower.min(low);
            spread[0] = spread[0].max(high - low);
        }
        for (low, high) in lowest.into_iter().zip(highest) {
            spread[1] = spread[1].max(high - low);
        }
        (lower - outward.dot(tip) - self.tool.support(outward).0, spread)
    }

    fn cell(&mut self, net: Net, piece: usize, along: [f64; 2], across: [f64; 2]) -> Cell {
        super::tool::count_work();
        let jet @ [x, run, rise] = jet(&net, [0.5; 2]);
        let normal = run.cross(&rise);
        let size = normal.norm();
        let normal = if size > 0.0 { normal / size } else { self.tool.axis };
        let mut seen: Option<Seen> = None;
        for tip in self.tips {
            let other = self.seen(tip, (&net, &jet), &normal);
            seen = Some(seen.map_or(other, |seen| seen.farther(other)));
        }
        let seen = seen.unwrap_or(Seen {
            value: f64::INFINITY,
            outward: normal,
            lower: f64::INFINITY,
            spread: [0.0; 2],
        });
        let Seen { value, outward, lower, spread } = seen;
        if self.best.is_none_or(|b| value < b.value) {
            let [along, across] = [along, across].map(|range| range[0] + 0.5 * range[1]);
            self.is_settled = false;
            self.best = Some(Touch { value, gap: 0.0, outward, point: x, piece, along, across });
        }
        Cell { net, piece, along, across, lower, halve_along: spread[0] >= spread[1] }
    }

    /// How far a cell is from the tool with its end at `tip`; its middle, the derivatives there and its normal are given.
    fn seen(&self, tip: &Vec3, (net, jet): (&Net, &[Vec3; 3]), normal: &Vec3) -> Seen {
        let [x, run, rise] = jet;
        let (value, mut outward) = self.measure(tip, x, normal);
        let (mut lower, spread) = self.bound(tip, net, &outward);
        if self.best.is_none_or(|b| lower < b.value) {
            if value.abs() <= self.sure {
                let w = x - tip;
                let height = |n: &Vec3| n.dot(&w) - self.tool.support(n).0;
                for level in self.tool.outward_at(&w) {
                    lower = lower.max(self.bound(tip, net, &level).0);
                    if height(&level) >= height(&outward) {
                        outward = level;
                    }
                }
            }
            let enough = self.enough(self.best.map_or(value, |b| b.value.min(value)));
            lower = self.closer(tip, (net, [x, run, rise]), [&outward, normal], lower, enough);
        }
        Seen { value, outward, lower, spread }
    }

    /// A closer bound of a cell's distance than that by the half-space with an outward normal where its middle is nearest; its
    /// middle, the derivatives there and its normal are given. A bound of `enough` need not be made closer.
    fn closer(
        &self,
        tip: &Vec3,
        (net, jet): (&Net, [&Vec3; 3]),
        [outward, normal]: [&Vec3; 2],
        mut lower: f64,
        enough: f64,
    ) -> f64 {
        // Beside the place that is nearest so far the plane across from it to the tool says most: close to an edge the tool is in another
        // direction from each place.
        if lower < enough
            && let Some(best) = &self.best
        {
            lower = lower.max(self.bound(tip, net, &best.outward).0);
        }
        // At a sharp edge of the tool the nearest place says little about the places beside it, but the half-space
        // along the surface does.
        let towards = if normal.dot(outward) < 0.0 { -normal } else { *normal };
        for level in [towards, -towards] {
            if lower < enough {
                lower = lower.max(self.bound(tip, net, &level).0);
            }
        }
        // Along a straight flank, or a tool that is a line, the surface says which of its normals is across it.
        if lower < enough
            && let Some(level) = self.tool.turned_to(outward, &towards)
        {
            lower = lower.max(self.bound(tip, net, &level).0);
        }
        // Beside the contact on an edge the surface turns along the edge: of its normals the part that the tool, a body
        // of revolution, can have where it is nearest.
        if lower < enough
            && let Some(level) = self.tool.without_azimuth(&(jet[0] - tip), normal)
        {
            let level = if level.dot(outward) < 0.0 { -level } else { level };
            lower = lower.max(self.bound(tip, net, &level).0);
        }
        // Beside an edge of the tool, or in its middle, several of its faces are as near; of what is outside one says all.
        if lower < enough.min(0.0) {
            lower = lower.max(lower_bound(net, jet, (tip, self.tool), enough));
        }
        lower
    }

    fn whole(&mut self, patch: &Patch, index: usize) -> Cell {
        self.cell(patch.net, index, [0.0, 1.0], [0.0, 1.0])
    }

    /// Halves cells, always the one that may hold the nearest place, until none could hold a place that is nearer than the best and looked
    /// for, or one deeper than `deep` is found; what the budget leaves unseen stays open. None when it is given up.
    fn close_in(&mut self, open: &mut BinaryHeap<Cell>, deep: f64, budget: &mut usize) -> Option<()> {
        while let Some(cell) = open.peek() {
            let best = self.best.map_or(f64::INFINITY, |b| b.value);
            if best < -deep || cell.lower >= self.enough(best) {
                open.clear();
                break;
            }
            if *budget == 0 {
                break;
            }
            *budget -= 1;
            if self.tool.patience.ends_after(WORK_OF_CELL) {
                return None;
            }
            if let Some(cell) = open.pop() {
                open.extend(self.split(&cell));
            }
        }
        Some(())
    }

    /// Leads the place found to the nearest about it on its patch, by Newton's method: among places that are as near to within the resolution
    /// another may be as far to the side as makes another direction, and what is left of a cell shows itself sooner by the true one. What
    /// does not lead nearer is dropped. None when it is given up.
    fn settle(&mut self, patches: &[Patch]) -> Option<()> {
        let [tip] = self.tips else { return Some(()) };
        if self.is_settled {
            return Some(());
        }
        self.is_settled = true;
        let mut best = self.best?;
        let net = &patches.get(best.piece)?.net;
        let mut here = self.across(tip, net, [best.along, best.across]);
        for _ in 0..SETTLING_STEPS {
            if self.tool.patience.ends_after(WORK_OF_STEP) {
                return None;
            }
            let Some(step) = self.step_to_nearest(tip, net, &here) else { break };
            let mut nearer = None;
            let mut share = 1.0;
            for _ in 0..=SHORTENINGS {
                let at = [0, 1].map(|k: usize| (here.at[k] + share * step[k]).clamp(0.0, 1.0));
                let there = self.across(tip, net, at);
                if there.value < here.value {
                    nearer = Some(there);
                    break;
                }
                share *= 0.5;
            }
            let Some(nearer) = nearer else { break };
            let way = (nearer.at[0] - here.at[0]).abs().max((nearer.at[1] - here.at[1]).abs());
            here = nearer;
            if way <= LAST_STEP {
                break;
            }
        }
        if here.value < best.value {
            let [along, across] = here.at;
            let Across { value, outward, point, .. } = here;
            best = Touch { value, outward, point, along, across, ..best };
            self.best = Some(best);
        }
        Some(())
    }

    /// A place of a patch as the tool sees it.
    fn across(&self, tip: &Vec3, net: &Net, at: [f64; 2]) -> Across {
        super::tool::count_work();
        let [point, run, rise] = jet(net, at);
        let normal = run.cross(&rise).try_normalize(0.0).unwrap_or(self.tool.axis);
        let (value, outward) = self.measure(tip, &point, &normal);
        // The way from the tool, not its direction: that varies evenly also where the tool is a line close by.
        let away = outward * value.abs();
        Across { at, point, value, outward, slopes: [away.dot(&run), away.dot(&rise)] }
    }

    /// The step by both parameters to where the way to the tool is square to the patch, or to the side of it that it leads out over; none
    /// where its derivatives tell none that leads nearer.
    fn step_to_nearest(&self, tip: &Vec3, net: &Net, here: &Across) -> Option<[f64; 2]> {
        let is_held = [0, 1].map(|k: usize| {
            (here.at[k] <= 0.0 && here.slopes[k] >= 0.0) || (here.at[k] >= 1.0 && here.slopes[k] <= 0.0)
        });
        let rates = |k: usize| -> [f64; 2] {
            let mut at = here.at;
            at[k] += if at[k] < 0.5 { DIFFERENCE } else { -DIFFERENCE };
            let by = at[k] - here.at[k];
            let there = self.across(tip, net, at);
            [0, 1].map(|j: usize| (there.slopes[j] - here.slopes[j]) / by)
        };
        let alone = |k: usize| {
            let rate = rates(k)[k];
            (rate > 0.0).then(|| -here.slopes[k] / rate)
        };
        let step = match is_held {
            [true, true] => return None,
            [true, false] => [0.0, alone(1)?],
            [false, true] => [alone(0)?, 0.0],
            [false, false] => {
                let ([a, c], [b, d]) = (rates(0), rates(1));
                let area = a * d - b * c;
                let [p, q] = here.slopes;
                [(b * q - d * p) / area, (c * p - a * q) / area]
            }
        };
        let leads_nearer = step[0] * here.slopes[0] + step[1] * here.slopes[1] < 0.0;
        (leads_nearer && step.iter().all(|x| x.is_finite())).then_some(step)
    }

    fn split(&mut self, cell: &Cell) -> [Cell; 2] {
        let (piece, along, across) = (cell.piece, cell.along, cell.across);
        let parts = |range: [f64; 2]| {
            let half = 0.5 * range[1];
            [[range[0], half], [range[0] + half, half]]
        };
        if cell.halve_along {
            let ([a, b], [first, last]) = (halves_along(&cell.net), parts(along));
            [self.cell(a, piece, first, across), self.cell(b, piece, last, across)]
        } else {
            let ([a, b], [first, last]) = (halves_across(&cell.net), parts(across));
            [self.cell(a, piece, along, first), self.cell(b, piece, along, last)]
        }
    }
}

/// The place of the patches nearest to a tool with its end at `tip`, to within `resolution`; None without patches or where
/// a number is not finite or the search is given up. A place deeper in the tool than `deep` ends the search.
pub(super) fn nearest(
    patches: &[Patch],
    tip: &Vec3,
    tool: &Tool<'_>,
    resolution: f64,
    deep: f64,
) -> Option<Touch> {
    let sure = SURE_DIRECTION * tool.profile.reach() + resolution;
    let search = Search { tips: &[*tip], tool, resolution, about: 0.0, sure, best: None, is_settled: false };
    search.nearest(patches, deep, &mut { CELL_BUDGET })
}

/// The same where the tool end is in several places, and what counts is the greatest distance of a place from the tool in all of them. The
/// place told is about the nearest: to within a share of its distance, or the resolution. The budget of cells is what is left of one for
/// several searches; what it leaves unseen goes into the gap.
pub(super) fn nearest_to_all(
    patches: &[Patch],
    tips: &[Vec3],
    tool: &Tool<'_>,
    resolution: f64,
    deep: f64,
    budget: &mut usize,
) -> Option<Touch> {
    let sure = SURE_DIRECTION * tool.profile.reach() + resolution;
    let about = ABOUT;
    Search { tips, tool, resolution, about, sure, best: None, is_settled: false }
        .nearest(patches, deep, budget)
}

impl Search<'_> {
    /// The place of the patches that is looked for, which a place deeper in the tool than `deep` ends. What the budget of cells leaves
    /// unseen goes into the gap.
    fn nearest(mut self, patches: &[Patch], deep: f64, budget: &mut usize) -> Option<Touch> {
        let Self { tips, tool, .. } = self;
        let search = &mut self;
        let middle = tips.first()? + tool.axis * (0.5 * tool.profile.reach());
        let first = patches
            .iter()
            .enumerate()
            .map(|(k, patch)| (patch.remoteness(&middle), k))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|f| f.1)?;
        // The nearest patch first: what it gives leaves out most of the others at once.
        let mut open = BinaryHeap::with_capacity(32);
        open.push(search.whole(patches.get(first)?, first));
        search.settle(patches)?;
        search.close_in(&mut open, deep, budget)?;
        search.settle(patches)?;
        let outward = search.best?.outward;
        // The greatest distances are from where that is least.
        let level = |tip: &Vec3| outward.dot(tip) + tool.support(&outward).0;
        let tip = tips.iter().min_by(|a, b| level(a).total_cmp(&level(b)))?;
        let base = level(tip);
        for (k, patch) in patches.iter().enumerate().filter(|(k, _)| *k != first) {
            let enough = search.enough(search.best?.value);
            let [a, b] = patch.spine.map(|end| outward.dot(&end) - base - patch.girth);
            if a.min(b) < enough && search.bound(tip, &patch.net, &outward).0 < enough {
                let cell = search.whole(patch, k);
                open.push(cell);
            }
        }
        search.close_in(&mut open, deep, budget)?;
        search.settle(patches)?;
        let mut touch = search.best?;
        let lowest = open.peek().map_or(f64::INFINITY, |cell| cell.lower);
        touch.gap = search.open(touch.value).max(touch.value - lowest);
        (touch.value.is_finite() && touch.gap.is_finite()).then_some(touch)
    }
}

//! Strips of surface, cubic one way and straight the other, and their nearest point to the tool.
//!
//! The distance of a point to a convex tool is a convex function, so at any place of a strip a half-space that holds the
//! tool bounds the distance of every other place: by the least height of the control points over it. That makes a
//! branch and bound whose gap shrinks with the square of the cell.

use apt_geometry::Vec3;

use super::tool::Tool;

/// Cells that one search may look at; what is left then goes into the gap.
const CELL_BUDGET: usize = 20_000;
/// Distance from the tool's boundary, relative to the tool, below which the difference of two points is no direction.
const SURE_DIRECTION: f64 = 1e-8;

/// How far a place on the tool's boundary is moved off it to find the boundary's normal, relative to the tool.
const NUDGE: f64 = 1e-3;

/// Control points of a cubic.
pub(super) type Cubic = [Vec3; 4];

/// Two cubics with the same parameter, joined by straight lines.
#[derive(Debug, Clone)]
pub(super) struct Strip {
    edges: [Cubic; 2],
    /// Index of the curve piece it was made of.
    piece: usize,
    /// The ends of its middle ruling, and how far the control points of the edges are from them at most.
    middle: [Vec3; 2],
    radius: f64,
}

impl Strip {
    pub(super) fn new(edges: [Cubic; 2], piece: usize) -> Self {
        let middle = [place(&edges[0], 0.5), place(&edges[1], 0.5)];
        let far = |k: usize| edges[k].iter().map(|p| (p - middle[k]).norm()).fold(0.0, f64::max);
        let radius = far(0).max(far(1));
        Self { edges, piece, middle, radius }
    }

    /// Its two cubics.
    pub(super) fn edges(&self) -> &[Cubic; 2] {
        &self.edges
    }

    /// Squared distance of a point to the middle ruling.
    fn remoteness(&self, x: &Vec3) -> f64 {
        let [a, b] = self.middle;
        let along = b - a;
        let square = along.norm_squared();
        let t = if square > 0.0 { ((x - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
        (x - a - along * t).norm_squared()
    }
}

/// The place of a strip that is nearest to the tool, or deepest in it.
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
    /// Piece of the curve, and the parameter 0 … 1 on it.
    pub(super) piece: usize,
    pub(super) along: f64,
    /// Parameter 0 … 1 from the first edge to the second.
    pub(super) across: f64,
}

/// A part of a strip.
#[derive(Debug, Clone)]
struct Cell {
    edges: [Cubic; 2],
    piece: usize,
    /// First parameter and width, along the piece.
    along: [f64; 2],
    /// The same from edge to edge.
    across: [f64; 2],
    /// No place of the cell is nearer.
    lower: f64,
    /// The direction to halve it in.
    halve_along: bool,
    /// Distance of its middle.
    value: f64,
}

pub(super) fn lerp(a: &Vec3, b: &Vec3, t: f64) -> Vec3 {
    a + (b - a) * t
}

/// The two halves of a cubic.
fn halves(c: &Cubic) -> [Cubic; 2] {
    let middle = |a: &Vec3, b: &Vec3| (a + b) * 0.5;
    let (ab, bc, cd) = (middle(&c[0], &c[1]), middle(&c[1], &c[2]), middle(&c[2], &c[3]));
    let (abc, bcd) = (middle(&ab, &bc), middle(&bc, &cd));
    let all = middle(&abc, &bcd);
    [[c[0], ab, abc, all], [all, bcd, cd, c[3]]]
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

struct Search<'a> {
    tip: Vec3,
    tool: &'a Tool<'a>,
    sure: f64,
    best: Option<Touch>,
}

impl Search<'_> {
    /// Distance of a place, and the direction in which the tool is left behind fastest.
    fn measure(&self, x: &Vec3, surface_normal: &Vec3) -> (f64, Vec3) {
        let w = x - self.tip;
        let (distance, q) = self.tool.signed_distance(&w);
        let away = w - q;
        let size = away.norm();
        (distance, if size > 0.0 { away * (distance.signum() / size) } else { *surface_normal })
    }

    /// Normals of half-spaces that hold the tool, for a place so near to its boundary that the difference of two points is
    /// no direction: where a place a little off it is projected to, on both sides of the surface.
    fn beside(&self, x: &Vec3, surface_normal: &Vec3) -> [Vec3; 2] {
        let nudge = NUDGE * self.tool.profile.reach();
        [nudge, -nudge].map(|sense| {
            let off = x - self.tip + surface_normal * sense;
            let (beyond, q) = self.tool.signed_distance(&off);
            let size = (off - q).norm();
            if beyond > 0.0 && size > 0.0 { (off - q) / size } else { *surface_normal * sense.signum() }
        })
    }

    /// The least height of a patch over the half-space with an outward normal that holds the tool, and how much the height
    /// varies along and across.
    fn bound(&self, edges: &[Cubic; 2], outward: &Vec3) -> (f64, [f64; 2]) {
        let base = outward.dot(&self.tip) + self.tool.support(outward).0;
        let heights = edges.map(|e| e.map(|p| outward.dot(&p) - base));
        let mut lower = f64::INFINITY;
        let mut spread = [0.0f64; 2];
        for edge in &heights {
            let (low, high) =
                edge.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
            lower = lower.min(low);
            spread[0] = spread[0].max(high - low);
        }
        for (first, second) in heights[0].iter().zip(&heights[1]) {
            spread[1] = spread[1].max((first - second).abs());
        }
        (lower, spread)
    }

    fn cell(&mut self, edges: [Cubic; 2], piece: usize, along: [f64; 2], across: [f64; 2]) -> Cell {
        let middles = [place(&edges[0], 0.5), place(&edges[1], 0.5)];
        let x = (middles[0] + middles[1]) * 0.5;
        let run = tangent(&edges[0], 0.5) + tangent(&edges[1], 0.5);
        let normal = run.cross(&(middles[1] - middles[0]));
        let size = normal.norm();
        let normal = if size > 0.0 { normal / size } else { self.tool.axis };
        let (value, mut outward) = self.measure(&x, &normal);
        let (mut lower, spread) = self.bound(&edges, &outward);
        if self.best.is_none_or(|b| lower < b.value) {
            if value.abs() <= self.sure {
                let height = |n: &Vec3| n.dot(&(x - self.tip)) - self.tool.support(n).0;
                for level in self.beside(&x, &normal) {
                    lower = lower.max(self.bound(&edges, &level).0);
                    if height(&level) >= height(&outward) {
                        outward = level;
                    }
                }
            }
            // At a sharp edge of the tool the nearest place says little about the places beside it, but the half-space
            // along the surface does.
            for level in [normal, -normal] {
                lower = lower.max(self.bound(&edges, &level).0);
            }
            // Beside the contact on an edge the surface turns along the edge: of its normals the part that the tool, a body
            // of revolution, can have where it is nearest.
            let level = self.tool.without_azimuth(&(x - self.tip), &normal);
            if let Some(level) = level {
                let level = if level.dot(&outward) < 0.0 { -level } else { level };
                lower = lower.max(self.bound(&edges, &level).0);
            }
        }
        if self.best.is_none_or(|b| value < b.value) {
            let [along, across] = [along, across].map(|range| range[0] + 0.5 * range[1]);
            self.best = Some(Touch { value, gap: 0.0, outward, point: x, piece, along, across });
        }
        Cell { edges, piece, along, across, lower, halve_along: spread[0] >= spread[1], value }
    }

    fn whole(&mut self, strip: &Strip) -> Cell {
        self.cell(strip.edges, strip.piece, [0.0, 1.0], [0.0, 1.0])
    }

    /// Halves cells until none could hold a place nearer than the best by more than `resolution`, or one deeper than `deep`
    /// is found; `lowest` tells what the budget left unseen.
    fn close_in(
        &mut self,
        open: &mut Vec<Cell>,
        [resolution, deep]: [f64; 2],
        budget: &mut usize,
        lowest: &mut f64,
    ) {
        while let Some(cell) = open.pop() {
            let best = self.best.map_or(f64::INFINITY, |b| b.value);
            if best < -deep {
                open.clear();
                return;
            }
            if cell.lower >= best - resolution {
                continue;
            }
            if *budget == 0 {
                *lowest = lowest.min(cell.lower);
            } else {
                *budget -= 1;
                let [first, second] = self.split(&cell);
                if first.value < second.value {
                    open.extend([second, first]);
                } else {
                    open.extend([first, second]);
                }
            }
        }
    }

    fn split(&mut self, cell: &Cell) -> [Cell; 2] {
        let [a, b] = &cell.edges;
        let (piece, along, across) = (cell.piece, cell.along, cell.across);
        let parts = |range: [f64; 2]| {
            let half = 0.5 * range[1];
            [[range[0], half], [range[0] + half, half]]
        };
        if cell.halve_along {
            let ([a0, a1], [b0, b1]) = (halves(a), halves(b));
            let [first, last] = parts(along);
            [self.cell([a0, b0], piece, first, across), self.cell([a1, b1], piece, last, across)]
        } else {
            let middle: Cubic = std::array::from_fn(|i| (a[i] + b[i]) * 0.5);
            let [first, last] = parts(across);
            [self.cell([*a, middle], piece, along, first), self.cell([middle, *b], piece, along, last)]
        }
    }
}

/// The place of the strips nearest to a tool with its end at `tip`, to within `resolution`; None without strips or where
/// a number is not finite. A place deeper in the tool than `deep` ends the search.
pub(super) fn nearest(
    strips: &[Strip],
    tip: &Vec3,
    tool: &Tool<'_>,
    resolution: f64,
    deep: f64,
) -> Option<Touch> {
    let mut search =
        Search { tip: *tip, tool, sure: SURE_DIRECTION * tool.profile.reach() + resolution, best: None };
    let middle = tip + tool.axis * (0.5 * tool.profile.reach());
    let first = strips
        .iter()
        .enumerate()
        .map(|(k, s)| (s.remoteness(&middle), k))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map(|f| f.1)?;
    // The nearest strip first: what it gives leaves out most of the others at once.
    let mut lowest = f64::INFINITY;
    let mut budget = CELL_BUDGET;
    let mut open = Vec::with_capacity(32);
    open.push(search.whole(strips.get(first)?));
    search.close_in(&mut open, [resolution, deep], &mut budget, &mut lowest);
    let found = search.best?;
    let base = found.outward.dot(tip) + tool.support(&found.outward).0;
    for (_, strip) in strips.iter().enumerate().filter(|(k, _)| *k != first) {
        let best = search.best?.value;
        let [a, b] = strip.middle.map(|m| found.outward.dot(&m) - base - strip.radius);
        if a.min(b) < best - resolution && search.bound(&strip.edges, &found.outward).0 < best - resolution {
            let cell = search.whole(strip);
            open.push(cell);
        }
    }
    // The nearest last, because it is taken first.
    open.sort_by(|a, b| b.value.total_cmp(&a.value));
    search.close_in(&mut open, [resolution, deep], &mut budget, &mut lowest);
    let mut touch = search.best?;
    touch.gap = resolution.max(touch.value - lowest);
    (touch.value.is_finite() && touch.gap.is_finite()).then_some(touch)
}

//! Plane curves of cubics and their nearest place to the shadow of the tool: a tabulated cylinder seen along its rulings.
//!
//! At any place of the curve a half-plane that holds the shadow bounds the distance of every other place, by the least
//! height of the control points over it. Parts whose bound is below the best place found are halved; the gap shrinks with
//! the square of the part.

use super::shadow::{Distance, Flat, Level, Shadow, left};

/// Parts that one search may look at; what is left then goes into the gap.
const PART_BUDGET: usize = 4_000;
/// What a part counts in units of work.
const WORK_OF_PART: u32 = 2;
/// Steps by which a nearest place is closed in.
const CLOSING_STEPS: usize = 24;
/// Sine of the angle to the curve below which a nearest place has been found.
const SQUARE: f64 = 1e-10;
/// Share of the resolution to which a distance is found.
const FINER: f64 = 0.25;

/// A cubic in the plane, by its control points, in a circle.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    control: [Flat; 4],
    /// Number by which the caller knows it.
    index: usize,
    center: Flat,
    radius: f64,
}

impl Piece {
    pub(super) fn new(control: [Flat; 4], index: usize) -> Self {
        let center = (control[0] + control[3]) * 0.5;
        let radius = control.iter().map(|p| (p - center).norm()).fold(0.0, f64::max);
        Self { control, index, center, radius }
    }

    pub(super) fn control(&self) -> &[Flat; 4] {
        &self.control
    }

    /// No place is less above a half-plane.
    pub(super) fn least_above(&self, level: &Level) -> f64 {
        least_above(level, &self.control)
    }

    /// Unit, to the left of it at a parameter.
    pub(super) fn left_at(&self, t: f64) -> Option<Flat> {
        left(&at(&self.control, t)[1]).try_normalize(0.0)
    }

    /// Both halves, known by the same number.
    pub(super) fn halves(&self) -> [Self; 2] {
        halves(&self.control).map(|control| Self::new(control, self.index))
    }

    /// A place in its middle.
    pub(super) fn middle(&self) -> &Flat {
        &self.center
    }

    /// Distance of a point to its chord.
    fn remoteness(&self, x: &Flat) -> f64 {
        let along = self.control[3] - self.control[0];
        let square = along.norm_squared();
        let from = x - self.control[0];
        let t = if square > 0.0 { (from.dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
        (from - along * t).norm()
    }
}

fn lerp(a: &Flat, b: &Flat, t: f64) -> Flat {
    a + (b - a) * t
}

/// The place at a parameter and a third of the derivative.
fn at(c: &[Flat; 4], t: f64) -> [Flat; 2] {
    let (ab, bc, cd) = (lerp(&c[0], &c[1], t), lerp(&c[1], &c[2], t), lerp(&c[2], &c[3], t));
    let (abc, bcd) = (lerp(&ab, &bc, t), lerp(&bc, &cd, t));
    [lerp(&abc, &bcd, t), bcd - abc]
}

fn halves(c: &[Flat; 4]) -> [[Flat; 4]; 2] {
    let middle = |a: &Flat, b: &Flat| (a + b) * 0.5;
    let (ab, bc, cd) = (middle(&c[0], &c[1]), middle(&c[1], &c[2]), middle(&c[2], &c[3]));
    let (abc, bcd) = (middle(&ab, &bc), middle(&bc, &cd));
    let all = middle(&abc, &bcd);
    [[c[0], ab, abc, all], [all, bcd, cd, c[3]]]
}

/// Control values of a third of the derivative of half the squared distance between a point and a cubic.
fn growth(c: &[Flat; 4], x: &Flat) -> [f64; 6] {
    let away = c.map(|p| p - x);
    let edges = [c[1] - c[0], c[2] - c[1], c[3] - c[2]];
    let product = |i: usize, j: usize| away[i].dot(&edges[j]);
    [
        product(0, 0),
        (2.0 * product(0, 1) + 3.0 * product(1, 0)) / 5.0,
        (product(0, 2) + 6.0 * product(1, 1) + 3.0 * product(2, 0)) / 10.0,
        (3.0 * product(1, 2) + 6.0 * product(2, 1) + product(3, 0)) / 10.0,
        (3.0 * product(2, 2) + 2.0 * product(3, 1)) / 5.0,
        product(3, 2),
    ]
}

/// The parameters at one of which a cubic is nearest to a point, and how much nearer it could be at most; None where its
/// distance may rise and fall more than once. A polynomial has no more roots than its control values change their sign.
fn nearest_to_point(c: &[Flat; 4], x: &Flat, resolution: f64) -> Option<([f64; 2], f64)> {
    let growth = growth(c, x);
    let signs = growth.iter().filter(|g| **g != 0.0).map(|g| *g > 0.0);
    let first = signs.clone().next();
    let changes = signs.clone().zip(signs.skip(1)).filter(|(a, b)| a != b).count();
    match (changes, first) {
        (0, Some(false)) => Some(([1.0; 2], 0.0)),
        (0, _) => Some(([0.0; 2], 0.0)),
        (1, Some(true)) => Some(([0.0, 1.0], 0.0)),
        (1, _) => {
            let fastest =
                [c[1] - c[0], c[2] - c[1], c[3] - c[2]].iter().map(|e| 3.0 * e.norm()).fold(0.0, f64::max);
            let [low, high] = turning_point(c, x, resolution / fastest)?;
            Some(([0.5 * (low + high); 2], fastest * (high - low)))
        }
        _ => None,
    }
}

/// Parameters, not farther apart than `width`, between which the distance of a cubic from a point stops falling; it falls at
/// the beginning and rises at the end. None if Newton's method does not close in on them.
fn turning_point(c: &[Flat; 4], x: &Flat, width: f64) -> Option<[f64; 2]> {
    let [mut low, mut high] = [0.0, 1.0];
    // Its middle is where the chord is nearest.
    let chord = c[3] - c[0];
    let mut t = ((x - c[0]).dot(&chord) / chord.norm_squared()).clamp(0.0, 1.0);
    for _ in 0..CLOSING_STEPS {
        let [place, run] = at(c, t);
        let away = place - x;
        let slope = away.dot(&run);
        if slope < 0.0 {
            low = t;
        } else {
            high = t;
        }
        if high - low <= width {
            return Some([low, high]);
        }
        let growth = 3.0 * run.norm_squared() + away.dot(&second(c, t));
        let step = -slope / growth;
        // A little farther than to the root, so that it is between both.
        let next = t + step + (0.25 * width).copysign(step);
        t = if growth > 0.0 && next > low && next < high { next } else { 0.5 * (low + high) };
    }
    None
}

/// A third of the second derivative of a cubic.
fn second(c: &[Flat; 4], t: f64) -> Flat {
    lerp(&(c[2] - c[1] * 2.0 + c[0]), &(c[3] - c[2] * 2.0 + c[1]), t) * 2.0
}

/// The place of the curve nearest to the shadow, or deepest in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    /// Distance to the shadow; negative inside.
    pub(super) value: f64,
    /// How much more or less the true least value could be.
    pub(super) gap: f64,
    /// The half-plane of the shadow that the place stands out of.
    pub(super) level: Level,
    /// Index of the piece, the parameter 0 … 1 on it, and the place.
    pub(super) piece: usize,
    pub(super) along: f64,
    pub(super) place: Flat,
}

/// A part of a piece.
struct Part {
    control: [Flat; 4],
    piece: usize,
    start: f64,
    width: f64,
    /// No place of the part is nearer.
    lower: f64,
    /// About the distance of its middle.
    middle: f64,
}

struct Search<'a> {
    pieces: [&'a [Piece]; 2],
    shadow: &'a Shadow<'a>,
    resolution: f64,
    best: Option<Nearest>,
}

fn least_above(level: &Level, control: &[Flat; 4]) -> f64 {
    control.iter().map(|p| level.above(p)).fold(f64::INFINITY, f64::min)
}

impl<'a> Search<'a> {
    fn piece(&self, k: usize) -> Option<&'a Piece> {
        let [first, more] = self.pieces;
        first.get(k).or_else(|| more.get(k - first.len()))
    }

    fn best_value(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |b| b.value)
    }

    /// Whether no place of a piece can be nearer than the best, by what little work shows it.
    fn is_far(&self, piece: &Piece) -> bool {
        let Some(best) = &self.best else { return false };
        let enough = best.value - self.resolution;
        if best.level.above(&piece.center) - piece.radius >= enough {
            return true;
        }
        let away = self.shadow.direction_to(&piece.center);
        away.is_some_and(|n| self.shadow.level(n).above(&piece.center) - piece.radius >= enough)
    }

    fn distance(&self, place: &Flat) -> Distance {
        self.shadow.distance(place, FINER * self.resolution)
    }

    /// Keeps a place of a piece if it is the nearest so far.
    fn offer(
        &mut self,
        piece: usize,
        along: f64,
        place: Flat,
        Distance { value, gap, level }: Distance,
    ) -> bool {
        let better = value < self.best_value();
        if better {
            self.best = Some(Nearest { value, gap, level, piece, along, place });
        }
        better
    }

    fn consider(&mut self, piece: usize, along: f64) -> bool {
        let Some(whole) = self.piece(piece) else { return false };
        let [place, _] = at(&whole.control, along);
        let found = self.distance(&place);
        self.offer(piece, along, place, found)
    }

    /// Looks for the nearest place beside the best.
    fn close_in_from(&mut self, piece: usize, t: f64, width: f64) {
        if let Some(near) = self.closed_in(piece, t, width) {
            self.consider(piece, near);
        }
    }

    /// The parameter near `t` at which the shadow's place straight across from the curve is its support there.
    fn closed_in(&self, piece: usize, t: f64, width: f64) -> Option<f64> {
        let control = &self.piece(piece)?.control;
        let outward = self.best.as_ref()?.level.normal;
        // How far the support is behind along the curve, in thirds of the parameter.
        let behind = |t: f64| {
            let [place, run] = at(control, t);
            let size = run.norm();
            let across = left(&run) / size;
            let across = if across.dot(&outward) < 0.0 { -across } else { across };
            let off = (place - self.shadow.level(across).support).dot(&run) / size;
            (off, off / (3.0 * size))
        };
        let (mut near, mut here) = (t, behind(t));
        let mut bracket: Option<f64> = None;
        let mut step = -here.1.clamp(-width, width);
        for _ in 0..CLOSING_STEPS {
            if !step.is_finite() || here.0.abs() <= SQUARE * self.shadow.reach() {
                break;
            }
            let next = (near + step).clamp(0.0, 1.0);
            if next == near {
                break;
            }
            let there = behind(next);
            if (there.0 < 0.0) != (here.0 < 0.0) {
                bracket = Some(near);
            }
            let secant = next - there.0 * (next - near) / (there.0 - here.0);
            (near, here) = (next, there);
            let newton = next - there.1;
            let wanted = if secant.is_finite() && (secant - next).abs() <= width { secant } else { newton };
            step = match bracket {
                Some(other) if (wanted < near.min(other)) || (wanted > near.max(other)) => {
                    0.5 * (other - near)
                }
                _ => wanted - near,
            };
        }
        Some(near)
    }

    /// A part along which the distance from a disc falls, then rises, at most once each, or the other way round: it is nearest
    /// where it turns, or at an end.
    fn part_about_disc(
        &mut self,
        control: [Flat; 4],
        piece: usize,
        [start, width]: [f64; 2],
    ) -> Option<Part> {
        self.shadow.disc()?;
        let (nearest, gap) = nearest_to_point(&control, &self.shadow.middle, FINER * self.resolution)?;
        let mut value = f64::INFINITY;
        for t in nearest {
            let [place, _] = at(&control, t);
            let found = self.distance(&place);
            value = value.min(found.value);
            self.offer(piece, start + width * t, place, found);
        }
        Some(Part { control, piece, start, width, lower: value - gap, middle: value })
    }

    fn part(&mut self, control: [Flat; 4], piece: usize, [start, width]: [f64; 2]) -> Part {
        super::tool::count_work();
        if let Some(part) = self.part_about_disc(control, piece, [start, width]) {
            return part;
        }
        let best = self.best_value();
        let mut lower = self.best.as_ref().map_or(f64::NEG_INFINITY, |b| least_above(&b.level, &control));
        let mut middle = f64::INFINITY;
        if lower < best - self.resolution {
            let [place, run] = at(&control, 0.5);
            let across = left(&run).try_normalize(0.0).unwrap_or_else(Flat::x);
            let levels = [across, -across].map(|n| self.shadow.level(n));
            let facing =
                if levels[0].above(&place) >= levels[1].above(&place) { levels[0] } else { levels[1] };
            middle = facing.above(&place);
            lower = lower.max(least_above(&facing, &control));
            if lower < best - self.resolution
                && let Some(away) = self.shadow.direction_to(&place)
            {
                let away = self.shadow.level(away);
                middle = middle.max(away.above(&place));
                lower = lower.max(least_above(&away, &control));
            }
            // Where these half-planes do not even show the middle to be farther than the best place, its own does, or it is
            // nearer.
            if lower < best - self.resolution && middle < best - self.resolution {
                let own = self.distance(&place);
                middle = own.value;
                lower = lower.max(least_above(&own.level, &control));
                let t = start + 0.5 * width;
                if self.offer(piece, t, place, own) {
                    self.close_in_from(piece, t, 0.5 * width);
                }
            }
        }
        Part { control, piece, start, width, lower, middle }
    }

    /// Halves parts until none could hold a place nearer than the best, or one deeper than `deep` is found; gives the least
    /// bound of those that the budget left unseen.
    fn close_in(&mut self, piece: usize, deep: f64, budget: &mut usize) -> Option<f64> {
        let control = self.piece(piece)?.control;
        let mut lowest = f64::INFINITY;
        let mut open = Vec::with_capacity(32);
        open.push(self.part(control, piece, [0.0, 1.0]));
        while let Some(part) = open.pop() {
            let best = self.best_value();
            if best < -deep {
                break;
            }
            if part.lower >= best - self.resolution {
                continue;
            }
            if *budget == 0 {
                lowest = lowest.min(part.lower);
                continue;
            }
            *budget -= 1;
            if self.shadow.patience().ends_after(WORK_OF_PART) {
                return None;
            }
            let [first, last] = halves(&part.control);
            let half = 0.5 * part.width;
            let first = self.part(first, part.piece, [part.start, half]);
            let last = self.part(last, part.piece, [part.start + half, half]);
            // The nearer one is taken first.
            if first.middle < last.middle {
                open.extend([last, first]);
            } else {
                open.extend([first, last]);
            }
        }
        Some(lowest)
    }
}

/// The place of a curve, in two lists of pieces, nearest to the shadow, to within `resolution`; None without pieces or where
/// a number is not finite. A place deeper in the shadow than `deep` ends the search.
pub(super) fn nearest(
    pieces: [&[Piece]; 2],
    shadow: &Shadow<'_>,
    resolution: f64,
    deep: f64,
) -> Option<Nearest> {
    let mut search = Search { pieces, shadow, resolution, best: None };
    let all = || pieces.into_iter().flatten();
    let remote = all().map(|piece| piece.remoteness(&shadow.middle)).enumerate();
    let first = remote.min_by(|a, b| a.1.total_cmp(&b.1))?.0;
    let mut lowest = f64::INFINITY;
    let mut budget = PART_BUDGET;
    if shadow.disc().is_none() && search.consider(first, 0.5) {
        search.close_in_from(first, 0.5, 0.5);
    }
    for piece in std::iter::once(first).chain((0..all().count()).filter(|k| *k != first)) {
        if search.best_value() < -deep {
            break;
        }
        if !search.is_far(search.piece(piece)?) {
            lowest = lowest.min(search.close_in(piece, deep, &mut budget)?);
        }
    }
    let mut found = search.best?;
    found.piece = search.piece(found.piece)?.index;
    found.gap = (found.gap + resolution).max(found.value - lowest);
    (found.value.is_finite() && found.gap.is_finite()).then_some(found)
}

#[cfg(test)]
mod tests {
    use apt_geometry::{Vec3, cutter::Cutter};
    use proptest::prelude::*;

    use super::{
        super::tool::{Profile, Tool, WORK},
        *,
    };

    /// A cubic with unit chords from node to node and slopes at them.
    fn curve(slopes: &[f64]) -> Vec<Piece> {
        let node = |k: usize| Flat::new(k as f64, 0.0);
        let pieces = slopes.windows(2).enumerate().map(|(k, s)| {
            let third = |slope: f64| Flat::new(1.0, slope) / 3.0;
            let ends = [node(k), node(k + 1)];
            Piece::new([ends[0], ends[0] + third(s[0]), ends[1] - third(s[1]), ends[1]], k)
        });
        pieces.collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        #[test]
        fn no_place_of_the_curve_is_nearer(
            slopes in proptest::collection::vec(-2.0..2.0f64, 3..7),
            [diameter, share] in [0.05..1.5f64, 0.0..1.0f64],
            lean in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64],
            at_place in [-0.5..5.0f64, -1.5..1.5f64],
            (point, is_upright) in (any::<bool>(), any::<bool>()),
        ) {
            let radius = 0.5 * diameter * share;
            let cutter = Cutter {
                diameter,
                corner_radius: radius,
                corner_offset: 0.5 * diameter - radius,
                corner_height: radius,
                alpha: 0.0,
                beta: 0.0,
                height: 2.0,
            };
            let profile = if point { Profile::tool_end() } else { Profile::of(&cutter).unwrap() };
            let axis = Vec3::new(lean[0], lean[1], lean[2] + 0.01).normalize();
            let axis = if is_upright { Vec3::z() } else { axis };
            let tool = Tool::new(&profile, axis);
            let frame = [Vec3::x(), Vec3::y()];
            let shadow = Shadow::new(&tool, &frame, &Vec3::new(at_place[0], at_place[1], 0.3));
            let pieces = curve(&slopes);
            let (first, last) = pieces.split_at(1);
            let resolution = 1e-10;
            let found = nearest([first, last], &shadow, resolution, f64::INFINITY).unwrap();
            let own = shadow.distance(&found.place, resolution);
            prop_assert!((own.value - found.value).abs() <= 2.0 * resolution, "{own:?} {found:?}");
            // Deep inside, two sides of the shadow can be equally near: the gap says how much that leaves open.
            let shallow = found.value > -0.1 * profile.widest();
            prop_assert!(found.gap <= if shallow { 1e-9 } else { 1e-3 }, "{found:?}");
            for piece in &pieces {
                for k in 0..=200 {
                    let [x, _] = at(&piece.control, f64::from(k) / 200.0);
                    let there = shadow.distance(&x, resolution);
                    prop_assert!(there.value + there.gap >= found.value - found.gap, "{x} {there:?} {found:?}");
                }
            }
        }
    }

    #[test]
    fn a_disc_is_told_from_a_curve_in_few_parts() {
        let size = [0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 1.0];
        let [diameter, corner_radius, corner_offset, corner_height, alpha, beta, height] = size;
        let cutter = Cutter { diameter, corner_radius, corner_offset, corner_height, alpha, beta, height };
        let profile = Profile::of(&cutter).unwrap();
        let tool = Tool::new(&profile, Vec3::z());
        let frame = [Vec3::x(), Vec3::y()];
        let shadow = Shadow::new(&tool, &frame, &Vec3::new(1.3, 0.9, 0.3));
        let pieces = curve(&[0.5, -0.4, 0.6, 0.2, -0.7]);
        WORK.set(0);
        let found = nearest([&pieces, &[]], &shadow, 1e-10, f64::INFINITY).unwrap();
        assert!(found.gap <= 1e-9, "{found:?}");
        // One look at each piece that is not far; halves of halves took twenty or more.
        assert!(WORK.get() <= 2, "{}", WORK.get());
    }
}

//! How far a tabulated cylinder keeps off a convex body. Seen along its generators it is a curve, and the distance of a generator from the body
//! is a convex function of where it crosses the plane of that curve: nowhere below its tangent.

use super::{super::apart::Apart, Cubic, DirectrixCurve, Vec2};
use crate::Vec3;

/// Bound of the places of a generator, or of an extension, that are looked at for the one nearest to a body.
const MOST_PLACES: u32 = 40;
/// First way along a generator, in lengths of the curve, and how much longer the next ones are, until the distance grows.
const FIRST_WAY: f64 = 1e-3;
const LONGER: f64 = 4.0;
/// Share of what is left above the distance wanted that a distance may be told too small, and the share of the length of the curve that is
/// rounding.
const ROUGHLY: f64 = 1e-2;
const ROUNDING: f64 = 1e-15;
/// Bound of the halvings of an interval: a share of this size is a place.
const DEEPEST: u32 = 48;

/// What is known of the distance of a generator from a body: it is not above the one looked at, and at no other place of the curve is it below a
/// tangent.
#[derive(Debug, Clone, Copy)]
struct Tangent {
    most: f64,
    least: f64,
    slope: Vec2,
}

/// A part of a curve.
#[derive(Debug, Clone, Copy)]
enum Portion {
    /// All intervals of a node of the tree.
    Node(usize),
    /// A stretch of an interval, that many times halved.
    Stretch { interval: usize, ends: [f64; 2], depth: u32 },
}

/// A convex function of one number at a place: its value, a derivative there, and what else is known of it.
#[derive(Debug, Clone, Copy)]
struct Look<T> {
    at: f64,
    value: f64,
    slope: f64,
    known: T,
}

/// Two places of a convex function between which, or at which, it is least.
#[derive(Debug, Clone, Copy)]
struct Bracket<T> {
    low: Look<T>,
    high: Look<T>,
}

impl<T> Bracket<T> {
    /// The share of the higher place with which the slopes of both even out, and the value there of both tangents: the function is nowhere less.
    fn floor(&self) -> (f64, f64) {
        let Self { low, high } = self;
        let rise = high.slope - low.slope;
        let share = if rise > 0.0 { (-low.slope / rise).clamp(0.0, 1.0) } else { 0.0 };
        let width = high.at - low.at;
        let least = low.value * (1.0 - share) + high.value * share + width * (1.0 - share) * low.slope;
        // Evened out, both tangents are level; what rounding leaves of their slope counts over the width.
        let tilt = low.slope * (1.0 - share) + high.slope * share;
        (share, least - tilt.abs() * width)
    }

    /// Where to look next: where straight slopes cross zero, or in the middle where that has closed in little.
    fn next(&self, last_width: f64) -> f64 {
        let Self { low, high } = self;
        let (width, rise) = (high.at - low.at, high.slope - low.slope);
        let secant = low.at - low.slope * width / rise;
        let is_inside = secant > low.at && secant < high.at;
        if is_inside && width < 0.5 * last_width { secant } else { low.at + 0.5 * width }
    }
}

/// Closes in where a convex function is least, from one of its places and a first way from there; `None` if it does not grow to either side.
fn closed_in<T: Copy>(
    from: f64,
    way: f64,
    mut look: impl FnMut(f64) -> Look<T>,
    is_close: impl Fn(&Bracket<T>) -> bool,
) -> Option<Bracket<T>> {
    let first = look(from);
    let mut bracket = Bracket { low: first, high: first };
    if first.slope == 0.0 {
        return Some(bracket);
    }
    let sense = -first.slope.signum();
    let mut step = way;
    let mut width = f64::INFINITY;
    for _ in 0..MOST_PLACES {
        let is_open = bracket.low.slope * bracket.high.slope > 0.0;
        if !is_open && is_close(&bracket) {
            return Some(bracket);
        }
        let at = if is_open {
            let ahead = if sense > 0.0 { bracket.high.at } else { bracket.low.at };
            let next = ahead + sense * step;
            step *= LONGER;
            next
        } else {
            bracket.next(width)
        };
        width = bracket.high.at - bracket.low.at;
        let found = look(at);
        match (is_open, found.slope > 0.0) {
            (true, is_beyond) if is_beyond == (sense > 0.0) || found.slope == 0.0 => {
                let end = if sense > 0.0 { &mut bracket.high } else { &mut bracket.low };
                *end = found;
            }
            // Nearer, and not there yet.
            (true, _) => bracket = Bracket { low: found, high: found },
            (false, true) => bracket.high = found,
            (false, false) => bracket.low = found,
        }
    }
    (bracket.low.slope * bracket.high.slope <= 0.0).then_some(bracket)
}

/// A curve whose generators are asked how far they are from a body.
struct Generators<'a, 'b> {
    curve: &'a DirectrixCurve,
    asked: &'a mut Apart<'b>,
    /// How far along the generators the place is that was nearest to the body last.
    along: f64,
    size: f64,
}

impl Generators<'_, '_> {
    /// What is known of the generator through a place of the plane; `None` if the place nearest to the body was not closed in.
    fn tangent(&mut self, flat: Vec2) -> Option<Tangent> {
        let Self { curve, asked, along, size } = self;
        let base = curve.lift(flat);
        let generator = curve.axes[2];
        let wanted = asked.wanted();
        let close = ROUNDING * *size;
        let look = |at: f64| -> Look<Vec3> {
            let (value, outward) = asked.at(&(base + generator * at));
            Look { at, value, slope: outward.dot(&generator), known: outward }
        };
        let is_close = |bracket: &Bracket<Vec3>| {
            let least = bracket.floor().1;
            let most = bracket.low.value.min(bracket.high.value);
            most - least <= close + ROUGHLY * (least - wanted).abs() || most < wanted
        };
        let bracket = closed_in(*along, FIRST_WAY * *size, look, is_close)?;
        let (share, least) = bracket.floor();
        let Bracket { low, high } = bracket;
        *along = low.at + share * (high.at - low.at);
        let outward = low.known * (1.0 - share) + high.known * share;
        let slope = curve.flat(&outward);
        Some(Tangent { most: low.value.min(high.value), least, slope })
    }

    /// What a part keeps, and a distance that some place of it has; infinite where none of its places is known.
    fn look(&mut self, portion: Portion) -> [f64; 2] {
        let [nothing, unknown] = [f64::NEG_INFINITY, f64::INFINITY];
        match portion {
            Portion::Node(node) => {
                let Some([middle, half]) = self.curve.boxes.extent(node) else { return [nothing, unknown] };
                let Some(Tangent { least, slope, .. }) = self.tangent(middle) else {
                    return [nothing, unknown];
                };
                [least - slope.x.abs() * half.x - slope.y.abs() * half.y, unknown]
            }
            Portion::Stretch { interval, ends: [from, to], .. } => {
                let Some(interval) = self.curve.intervals.get(interval) else { return [nothing, unknown] };
                let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
                let [height, rise, _] = interval.height(middle);
                let across = interval.normal_axis();
                let place = interval.start + interval.along * middle + across * height;
                let Some(Tangent { most, least, slope }) = self.tangent(place) else {
                    return [nothing, unknown];
                };
                let turn = interval.bend_range([from, to]);
                let beyond = turn.map(|bend| 0.5 * bend * half * half * slope.dot(&across));
                let along = half * slope.dot(&(interval.along + across * rise)).abs();
                [least - along + beyond[0].min(beyond[1]), most]
            }
        }
    }

    /// What a straight extension keeps, from where it begins on its unit way.
    fn ray(&mut self, begin: Vec2, way: Vec2) -> Option<f64> {
        let first = self.tangent(begin)?;
        if first.slope.dot(&way) >= 0.0 {
            return Some(first.least);
        }
        let (wanted, size) = (self.asked.wanted(), self.size);
        let mut is_lost = false;
        let look = |at: f64| -> Look<()> {
            let Some(Tangent { least, slope, .. }) = self.tangent(begin + way * at) else {
                is_lost = true;
                return Look { at, value: f64::NEG_INFINITY, slope: 0.0, known: () };
            };
            Look { at, value: least, slope: slope.dot(&way), known: () }
        };
        let is_close = |bracket: &Bracket<()>| {
            let least = bracket.floor().1;
            let most = bracket.low.value.min(bracket.high.value);
            most - least <= ROUNDING * size + ROUGHLY * (least - wanted).abs() || most < wanted
        };
        let bracket = closed_in(0.0, size, look, is_close)?;
        (!is_lost).then(|| bracket.floor().1)
    }

    /// Whether the extensions of an interval keep what is wanted.
    fn extensions_keep(&mut self, interval: &Cubic) -> bool {
        interval.ways_on().into_iter().flatten().all(|[begin, way]| {
            self.ray(begin, way).is_some_and(|least| self.asked.is_settled(least) || self.asked.takes(least))
        })
    }

    /// Whether all parts keep what is wanted, the nearest first.
    fn keep_apart(&mut self) -> bool {
        let mut open = vec![(self.look(Portion::Node(1)), Portion::Node(1))];
        while let Some(([least, most], portion)) = open.pop() {
            if self.asked.is_settled(least) {
                continue;
            }
            if most < self.asked.wanted() || !self.asked.may_look() {
                return false;
            }
            let parts = match portion {
                Portion::Node(node) => match self.curve.boxes.leaf(node) {
                    Some(interval) => {
                        let Some(own) = self.curve.intervals.get(interval) else { continue };
                        if !self.extensions_keep(own) {
                            return false;
                        }
                        [Some(Portion::Stretch { interval, ends: [0.0, own.length], depth: 0 }), None]
                    }
                    None => [2 * node, 2 * node + 1].map(|child| Some(Portion::Node(child))),
                },
                Portion::Stretch { .. } if self.asked.takes(least) => continue,
                Portion::Stretch { depth: DEEPEST, .. } => return false,
                Portion::Stretch { interval, ends: [from, to], depth } => {
                    let middle = 0.5 * (from + to);
                    let half = |ends| Some(Portion::Stretch { interval, ends, depth: depth + 1 });
                    [half([from, middle]), half([middle, to])]
                }
            };
            let mut parts = parts.map(|part| part.map(|part| (self.look(part), part)));
            if let [Some(a), Some(b)] = &parts
                && a.0[0] < b.0[0]
            {
                parts.reverse();
            }
            open.extend(parts.into_iter().flatten());
        }
        true
    }
}

impl DirectrixCurve {
    /// Whether all generators keep off a body.
    pub(in super::super) fn keeps_apart(&self, asked: &mut Apart<'_>) -> bool {
        let size = self.size();
        Generators { curve: self, asked, along: 0.0, size }.keep_apart()
    }
}

#[cfg(test)]
mod tests {
    use super::{super::tests as curves, *};
    use crate::{
        Vec3,
        patience::Patience,
        surface::{Body, Limit, Surface},
    };

    /// How far a place is from all that is within a radius of a straight stretch, and the way there.
    fn away_from(place: &Vec3, [from, to]: &[Vec3; 2], radius: f64) -> (f64, Vec3) {
        let along = to - from;
        let share = ((place - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let way = place - (from + along * share);
        let distance = way.norm() - radius;
        (distance, way.normalize())
    }

    /// Whether a slanted cylinder that touches the curve at a place on its outer side but for a gap keeps a distance, and after how many
    /// looks that is told.
    fn keeps(curve: &DirectrixCurve, (interval, s): (usize, f64), gap: f64, wanted: f64) -> (bool, u32) {
        let own = &curve.intervals[interval];
        let [height, slope, _] = own.height(s);
        let across = own.normal_axis();
        let place = curve.lift(own.start + own.along * s + across * height) + curve.axes[2] * 700.0;
        let normal = -curve.lift((across - own.along * slope).normalize());
        let radius = 0.1;
        // Slanted in the tangent plane, so that it touches at one place where the curve bends away.
        let along = (curve.axes[2] * 0.8 + curve.axes[2].cross(&normal) * 0.6) * 0.4;
        let middle = place + normal * (radius + gap);
        let ends = [middle - along, middle + along];
        let looks = std::cell::Cell::new(0);
        let away = |place: &Vec3| {
            looks.set(looks.get() + 1);
            away_from(place, &ends, radius)
        };
        let limit = Limit { looks: 5000, enough: wanted, patience: Patience::default() };
        let surface = Surface::Tabulated(Box::new(curve.clone()));
        let keeps = surface.keeps_off_body(Body::new(&away), wanted, limit).is_some();
        (keeps, looks.get())
    }

    /// A cylinder beside a drop, far along its generators, is told to be off it by all but a billionth of what it is, and by no more.
    #[test]
    fn how_far_a_slanted_cylinder_is_off_a_curve_is_told_closely() {
        let curve = DirectrixCurve::new(&curves::drop_shape()).expect("a curve");
        for (interval, share) in [(1, 0.3), (1, 0.8), (2, 0.5)] {
            let s = share * curve.intervals[interval].length;
            for gap in [0.0, 1e-3, 0.05] {
                let (is_kept, looks) = keeps(&curve, (interval, s), gap, gap - 1e-9);
                assert!(is_kept && looks <= 900, "{looks} looks, {gap} off {interval}, {share}");
                assert!(!keeps(&curve, (interval, s), gap, gap + 1e-9).0, "{gap} off {interval}, {share}");
            }
        }
    }

    /// The straight extensions of an open curve are part of it.
    #[test]
    fn a_body_beside_an_extension_far_away_is_near() {
        let mut points = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [3.0, 1.0]];
        points[0][1] = -0.5;
        let curve = DirectrixCurve::new(&curves::curve(&points, 0.1)).expect("a curve");
        let Some(ways) = curve.intervals.last().map(Cubic::ways_on) else { panic!("intervals") };
        let [begin, way] = ways[1].expect("an extension");
        let beside = curve.lift(begin + way * 400.0 + Vec2::new(-way.y, way.x) * 0.5);
        let away = |place: &Vec3| {
            let from = place - beside;
            (from.norm() - 0.1, from.normalize())
        };
        let surface = Surface::Tabulated(Box::new(curve));
        let patience = Patience::default();
        assert!(surface.keeps_apart(&away, [0.399, 0.399], patience).is_some());
        assert!(surface.keeps_apart(&away, [0.401, 0.401], patience).is_none());
    }
}

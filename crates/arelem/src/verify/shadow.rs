//! The tool seen along a direction: a convex figure in the plane across it, and how far a point is from that.
//!
//! Every half-plane that holds the figure bounds the distance of a point from below, every two places of it bound what the
//! half-planes between theirs can give from above. The arc of directions with the greatest bound is divided until both agree.

use apt_geometry::{Vec3, patience::Patience};
use nalgebra::Vector2;

use super::tool::{Tool, TurningSupport};

/// Arcs of directions looked at for one distance; what is left then is the gap. So many may be as good as each other, to a part of 1e-9 of the tool, about a
/// place to which the rim bends.
const ARCS: usize = 256;
/// Steps of Newton's method towards the best direction, and the greatest of them, radians.
const STEPS: usize = 6;
const LARGEST_TURN: f64 = 1.0;
/// Sine of an axis to the direction along which it is seen below which it is rounding.
const UPRIGHT: f64 = 1e-15;
/// Two places nearer than this, relative to their distance from the point, are one.
const SAME: f64 = 1e-15;

/// A place or direction in the plane of the figure.
pub(super) type Flat = Vector2<f64>;

/// A tool seen along a direction.
pub(super) struct Shadow<'a> {
    tool: &'a Tool<'a>,
    frame: &'a [Vec3; 2],
    tip: Flat,
    /// A place in the middle of it.
    pub(super) middle: Flat,
    /// From that along the axis up and down, as far as the tool is about the same all round.
    spine: Flat,
    /// Its radius where it is a disc about its middle: a tool that is seen along its axis, or its end alone.
    disc: Option<f64>,
}

/// A half-plane that holds the figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Level {
    /// Outward, unit.
    pub(super) normal: Flat,
    /// The figure has no place with a greater product with the normal.
    pub(super) height: f64,
    /// The place of the figure that has it.
    pub(super) support: Flat,
}

impl Level {
    /// How far a place stands out of the half-plane.
    pub(super) fn above(&self, x: &Flat) -> f64 {
        self.normal.dot(x) - self.height
    }
}

/// How far a point is from the figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Distance {
    /// Negative inside; not more than the true distance.
    pub(super) value: f64,
    /// How much more the true distance may be.
    pub(super) gap: f64,
    /// The half-plane that shows it.
    pub(super) level: Level,
}

/// Directions between those of two half-planes.
#[derive(Debug, Clone, Copy)]
struct Arc {
    ends: [Level; 2],
    /// No direction of the arc gives more, and the one that might.
    bound: f64,
    best: Flat,
}

/// A quarter turn to the left.
pub(super) fn left(v: &Flat) -> Flat {
    Flat::new(-v.y, v.x)
}

/// Greatest product with `d` between two directions, and the direction that has it.
fn greatest(from: &Flat, to: &Flat, d: &Flat) -> (f64, Flat) {
    if from.perp(d) > 0.0 && d.perp(to) > 0.0 {
        let size = d.norm();
        return (size, d / size);
    }
    let (first, last) = (from.dot(d), to.dot(d));
    if first >= last { (first, *from) } else { (last, *to) }
}

impl Arc {
    fn new(ends: [Level; 2], x: &Flat) -> Self {
        let [first, last] = &ends;
        let (a, b) = (first.normal, last.normal);
        let (to_first, to_last) = (x - first.support, x - last.support);
        let apart = first.support - last.support;
        let cross = left(&apart);
        let cross = if cross.dot(&(a + b)) < 0.0 { -cross } else { cross };
        let size = cross.norm();
        let (bound, best) = if size > SAME * (to_first.norm() + to_last.norm())
            && a.perp(&cross) >= 0.0
            && cross.perp(&b) >= 0.0
        {
            // Up to the direction in which both places are equally high the first one counts, then the last.
            let cross = cross / size;
            let (one, other) = (greatest(&a, &cross, &to_first), greatest(&cross, &b, &to_last));
            if one.0 >= other.0 { one } else { other }
        } else {
            let (one, other) = (greatest(&a, &b, &to_first), greatest(&a, &b, &to_last));
            if one.0 <= other.0 { one } else { other }
        };
        Self { ends, bound, best }
    }
}

impl<'a> Shadow<'a> {
    /// Who is asked while it is measured.
    pub(super) fn patience(&self) -> Patience<'a> {
        self.tool.patience
    }

    /// The tool with its end at `tip`, seen along the direction across both unit vectors of `frame`.
    pub(super) fn new(tool: &'a Tool<'a>, frame: &'a [Vec3; 2], tip: &Vec3) -> Self {
        let flat = |v: &Vec3| Flat::new(frame[0].dot(v), frame[1].dot(v));
        let tip = flat(tip);
        let (half, axis) = (0.5 * tool.profile.top_height(), flat(&tool.axis));
        let spine = axis * (half - tool.profile.widest()).max(0.0);
        let leans = axis.norm() > UPRIGHT;
        let disc = (!leans || tool.profile.is_point()).then(|| tool.profile.widest());
        Self { tool, frame, tip, middle: tip + axis * half, spine, disc }
    }

    /// The radius of the figure about its middle, where it is a disc.
    pub(super) fn disc(&self) -> Option<f64> {
        self.disc
    }

    /// About the direction in which a point is away from the figure.
    pub(super) fn direction_to(&self, x: &Flat) -> Option<Flat> {
        let from = x - self.middle;
        let square = self.spine.norm_squared();
        let t = if square > 0.0 { (from.dot(&self.spine) / square).clamp(-1.0, 1.0) } else { 0.0 };
        (from - self.spine * t).try_normalize(0.0)
    }

    /// Greatest distance of a place of the tool from its end.
    pub(super) fn reach(&self) -> f64 {
        self.tool.profile.reach()
    }

    /// The half-plane with an outward unit normal.
    pub(super) fn level(&self, normal: Flat) -> Level {
        if let Some(radius) = self.disc {
            let height = self.middle.dot(&normal) + radius;
            return Level { normal, height, support: self.middle + normal * radius };
        }
        let [u, v] = self.frame;
        let (height, place) = self.tool.support(&(u * normal.x + v * normal.y));
        let support = self.tip + Flat::new(u.dot(&place), v.dot(&place));
        Level { normal, height: self.tip.dot(&normal) + height, support }
    }

    /// The distance of a point that is nearest to the corner or to an edge of the tool, by Newton's method from a direction on:
    /// the tool holds a ball about a place, perhaps without radius, and no point is farther from the tool than from the ball.
    fn to_ball(&self, x: &Flat, first: Flat, tolerance: f64) -> Option<Distance> {
        let [u, v] = self.frame;
        let lifted = |n: &Flat| u * n.x + v * n.y;
        let mut normal = first;
        for _ in 0..STEPS {
            let across = left(&normal);
            let TurningSupport { value, center, ball, swing } =
                self.tool.turning_support(&lifted(&normal), &lifted(&across));
            let center = self.tip + Flat::new(u.dot(&center), v.dot(&center));
            let away = x - center;
            let ahead = normal.dot(&away);
            let gap = away.norm() - ahead;
            if gap <= tolerance {
                let height = self.tip.dot(&normal) + value;
                let level = Level { normal, height, support: center + normal * ball };
                return Some(Distance { value: level.above(x), gap: gap.max(0.0), level });
            }
            let turn = across.dot(&away) / (ahead + swing - ball);
            // Where the height of the point is no concave function of the direction: straight away from the ball.
            let is_good = ahead + swing > ball && turn.abs() <= LARGEST_TURN;
            normal = if is_good { normal + across * turn } else { away }.try_normalize(0.0)?;
        }
        None
    }

    /// The distance of a point, to within `tolerance` if the budget allows.
    pub(super) fn distance(&self, x: &Flat, tolerance: f64) -> Distance {
        let first = self.direction_to(x).unwrap_or_else(Flat::x);
        if self.disc.is_some() {
            let level = self.level(first);
            return Distance { value: level.above(x), gap: 0.0, level };
        }
        if let Some(found) = self.to_ball(x, first, tolerance) {
            return found;
        }
        let across = left(&first);
        let levels = [first, across, -first, -across].map(|n| self.level(n));
        let mut best = levels[0];
        for level in &levels {
            if level.above(x) > best.above(x) {
                best = *level;
            }
        }
        let quarter = |k: usize| Arc::new([levels[k], levels[(k + 1) % 4]], x);
        let mut arcs: Vec<Arc> = (0..4).map(quarter).collect();
        loop {
            let value = best.above(x);
            let Some(open) = arcs.iter_mut().max_by(|a, b| a.bound.total_cmp(&b.bound)) else {
                return Distance { value, gap: 0.0, level: best };
            };
            let gap = (open.bound - value).max(0.0);
            let known = open.ends.iter().any(|end| end.normal == open.best);
            if gap <= tolerance || known {
                return Distance { value, gap, level: best };
            }
            let middle = self.level(open.best);
            if middle.above(x) > value {
                best = middle;
            }
            let [from, to] = open.ends;
            *open = Arc::new([from, middle], x);
            if arcs.len() >= ARCS {
                return Distance { value: best.above(x), gap, level: best };
            }
            arcs.push(Arc::new([middle, to], x));
        }
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;
    use proptest::prelude::*;

    use super::{super::tool::Profile, *};
    use crate::verify::tests::BARRELS;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]
        #[test]
        fn a_distance_is_that_of_the_best_of_many_half_planes(
            [diameter, share, height] in [0.1..2.0f64, 0.0..1.0f64, 1.0..3.0f64],
            (cut, angles) in ([0.0..0.3f64, 0.0..0.3f64], [0.0..0.3f64, 0.0..0.3f64]),
            (lean, is_upright) in ([-1.0..1.0f64, -1.0..1.0f64], any::<bool>()),
            (at, is_inside) in ([-3.0..3.0f64, -3.0..3.0f64], any::<bool>()),
        ) {
            // Lines that touch the circle of the corner and lines that cut it.
            let radius = 0.5 * diameter * share;
            let [low, side] = cut.map(|by| radius * (1.0 - by));
            let [alpha, beta] = angles.map(|angle| if cut[0] < 0.1 { 0.0 } else { angle });
            let offset = 0.5 * diameter - side;
            let cutter = Cutter {
                diameter,
                corner_radius: radius,
                corner_offset: offset,
                corner_height: offset * alpha.tan() + low / alpha.cos(),
                alpha,
                beta,
                height,
            };
            let barrel = (share < 0.2).then(|| crate::verify::tests::cutter(&BARRELS[(share * 25.0) as usize]));
            let Ok(profile) = Profile::of(&barrel.unwrap_or(cutter)) else { return Ok(()) };
            let tool = Tool::new(&profile, Vec3::new(lean[0], lean[1], 1.0).normalize());
            // Upright on what it is seen on it is a disc.
            let turned = tool.axis.cross(&Vec3::x()).normalize();
            let frame = if is_upright { [turned, tool.axis.cross(&turned)] } else { [Vec3::x(), Vec3::z()] };
            let shadow = Shadow::new(&tool, &frame, &Vec3::new(0.1, 0.2, 0.3));
            // Anywhere, and a little inside.
            let inside = shadow.level(Flat::new(at[0], at[1]).normalize());
            let x = if is_inside { inside.support - inside.normal * (0.02 * at[0].abs()) } else { Flat::new(at[0], at[1]) };
            let found = shadow.distance(&x, 1e-10);
            let count = 20_000;
            let turn = std::f64::consts::TAU / f64::from(count);
            let tried = (0..count).map(|k| {
                let (s, c) = (turn * f64::from(k)).sin_cos();
                shadow.level(Flat::new(c, s)).above(&x)
            });
            let most = tried.fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(found.gap <= 1e-10, "{found:?}");
            prop_assert!(most <= found.value + found.gap + 1e-12 && found.value <= most + 1e-2, "{most} {found:?}");
            prop_assert!((found.level.above(&x) - found.value).abs() < 1e-12);
        }
    }

    /// From the tip of the evolute of the figure all its places about there are as near, to the fourth order of the angle: over so many arcs it is
    /// that they are told from each other.
    #[test]
    fn a_distance_from_where_the_rim_bends_to_is_closed_in() {
        let [alpha, beta] = [0.22768269504135877_f64, 0.21917471953489606];
        let [diameter, radius, offset] = [0.6805591924718866, 0.12214110219818396, 0.2328298044631856];
        let low = radius * (1.0 - 0.2606961736383478);
        let corner_height = offset * alpha.tan() + low / alpha.cos();
        let cutter = Cutter {
            diameter,
            corner_radius: radius,
            corner_offset: offset,
            corner_height,
            alpha,
            beta,
            height: 1.8125617598774324,
        };
        let profile = Profile::of(&cutter).unwrap();
        let axis = Vec3::new(-0.7908460369037865, -0.3254544225393191, 1.0).normalize();
        let tool = Tool::new(&profile, axis);
        let frame = [Vec3::x(), Vec3::z()];
        let shadow = Shadow::new(&tool, &frame, &Vec3::new(0.1, 0.2, 0.3));
        let inside = shadow.level(Flat::new(-2.2245527424926874, -1.9299535916035582).normalize());
        let place = inside.support - inside.normal * 0.04449105484985375;
        let found = shadow.distance(&place, 1e-10);
        assert!(found.gap <= 1e-10, "{found:?}");
    }
}

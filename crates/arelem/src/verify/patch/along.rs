//! How a patch bends below a place of a tool that goes along it: in the direction in which that goes, not in all.

use apt_geometry::Vec3;

use super::{Most, Net, differences, turned};

/// Numbers between two.
#[derive(Debug, Clone, Copy)]
struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    fn about(middle: f64, off: f64) -> Self {
        Self { low: middle - off, high: middle + off }
    }

    fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    fn times(self, other: Self) -> Self {
        let all =
            [self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high];
        Self {
            low: all.into_iter().fold(f64::INFINITY, f64::min),
            high: all.into_iter().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    fn square(self) -> Self {
        let found = self.times(self);
        if self.low <= 0.0 && self.high >= 0.0 { Self { low: 0.0, ..found } } else { found }
    }
}

/// The first derivatives of a patch in one of its parameters: their mean, and how far they are off it.
struct Run {
    mean: Vec3,
    /// From the mean to each of the control points of the derivative, whose convex hull holds it.
    off: [[Vec3; 3]; 4],
    farthest: f64,
}

impl Run {
    /// Thirds of the derivative.
    fn of(along: &[[Vec3; 3]; 4]) -> Self {
        let mean = along.as_flattened().iter().sum::<Vec3>() / 12.0;
        let off = along.map(|row| row.map(|d| d - mean));
        let farthest = off.as_flattened().iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt();
        Self { mean, off, farthest }
    }

    /// How far off the mean it is in a direction at most.
    fn most(&self, direction: &Vec3) -> f64 {
        self.off.as_flattened().iter().map(|d| direction.dot(d).abs()).fold(0.0, f64::max)
    }
}

/// A patch as it falls away from the planes that touch it, towards one side of it.
///
/// What goes by `w` and is kept on the patch straight below goes there by `aU + bV = w − n(n·w)`, with `n` the normal at a place, and the derivatives
/// `U` and `V` there, and the patch falls by half of `a²·n·Uu + 2ab·n·Uv + b²·n·Vv`. With the means `u` and `v` of the derivatives and the
/// vectors `p` and `q` in their plane for which `p·u = q·v = 1` and `p·v = q·u = 0`,
///
/// ```text
/// a(1 + p·(U − u)) + b p·(V − v) = p·w − (p·n)(n·w),
/// a q·(U − u) + b(1 + q·(V − v)) = q·w − (q·n)(n·w).
/// ```
///
/// So `a` is no farther from `p·w`, and `b` from `q·w`, than what is not 1 there, and the last products, make them.
pub(in crate::verify) struct Falling {
    normal: Vec3,
    /// How far any normal of the patch is from that.
    turn: f64,
    /// `p` and `q`.
    duals: [Vec3; 2],
    /// How far the derivatives may be off their means, by either.
    off: [[f64; 2]; 2],
    /// How much either and the normal of a place may be of one direction.
    leans: [f64; 2],
    /// The second derivatives, towards the side to which it falls.
    bends: [Interval; 3],
}

impl Falling {
    /// Towards −`sense` times along × across. None where the patch turns too much for a bound.
    pub(in crate::verify) fn of(net: &Net, sense: f64) -> Option<Self> {
        let (along, across) = (differences(net), differences(&turned(net)));
        let (u, v) = (Run::of(&along), Run::of(&across));
        let normal = u.mean.cross(&v.mean);
        let area = normal.norm();
        if area <= 0.0 {
            return None;
        }
        let normal = normal / area;
        let duals @ [p, q] = [v.mean.cross(&normal) / area, normal.cross(&u.mean) / area];
        // The product of the derivatives is no farther off that of the means; and a unit vector is from another no farther than twice the sine of
        // the angle between them, if that is not obtuse.
        let product = u.farthest * v.mean.norm() + u.mean.norm() * v.farthest + u.farthest * v.farthest;
        let turn = (2.0 * product / area).min(2.0);
        // The normal at a place is square to the derivatives there: so it leans to their means by no more than they are off these along it.
        let lean = |run: &Run| run.most(&normal) + turn.min(1.0) * run.farthest;
        let (lean_u, lean_v) = (lean(&u), lean(&v));
        let leans = duals.map(|own| own.dot(&p).abs() * lean_u + own.dot(&q).abs() * lean_v);
        let off = duals.map(|own| [u.most(&own), v.most(&own)]);
        let away = normal * -sense;
        // The differences count thirds of the first derivative, and so ninths of the mixed and two thirds of the others.
        let own_bends = |all: &[[Vec3; 3]; 4]| {
            let rows = all.iter().flat_map(|[first, second, third]| [second - first, third - second]);
            heights(&away, turn, rows.map(|bend| bend * (2.0 / 3.0)))
        };
        let rows = along.iter().zip(&along[1..]);
        let twists = rows.flat_map(|(row, next)| row.iter().zip(next).map(|(here, beyond)| beyond - here));
        let bends = [own_bends(&along), heights(&away, turn, twists), own_bends(&across)];
        Some(Self { normal, turn, duals, off, leans, bends })
    }

    /// How fast the slope grows with which it falls away along a way, or as much beside that as `beside`.
    pub(in crate::verify) fn along(&self, way: &Vec3, beside: f64) -> Option<f64> {
        let through = self.across(way) + beside;
        let shares = self.duals.map(|own| own.dot(way));
        let missed = [0, 1].map(|k: usize| {
            let [by_u, by_v] = self.off[k];
            let off = shares[0].abs() * by_u + shares[1].abs() * by_v;
            off + self.leans[k] * through + self.duals[k].norm() * beside
        });
        let [[uu, uv], [vu, vv]] = self.off;
        let left = (1.0 - uu) * (1.0 - vv) - uv * vu;
        if !(uu < 1.0 && vv < 1.0 && left > 0.0) {
            return None;
        }
        let by_u = Interval::about(shares[0], ((1.0 - vv) * missed[0] + uv * missed[1]) / left);
        let by_v = Interval::about(shares[1], (vu * missed[0] + (1.0 - uu) * missed[1]) / left);
        let [first, twist, last] = self.bends;
        let most = by_u.square().times(first).high
            + 2.0 * by_u.times(by_v).times(twist).high
            + by_v.square().times(last).high;
        most.is_finite().then_some(most)
    }

    /// How much of a vector is along a normal of the patch at most.
    pub(in crate::verify) fn across(&self, vector: &Vec3) -> f64 {
        self.normal.dot(vector).abs() + self.turn * vector.norm()
    }

    /// About the same as along a way, in the middle, as a form of two ways.
    pub(in crate::verify) fn in_middle(&self, one: &Vec3, other: &Vec3) -> f64 {
        let [[a, b], [c, d]] = [one, other].map(|way| self.duals.map(|own| own.dot(way)));
        let [first, twist, last] = self.bends.map(Interval::middle);
        a * c * first + (a * d + b * c) * twist + b * d * last
    }
}

/// Between which heights vectors are over a plane that may lean by a sine.
fn heights(normal: &Vec3, turn: f64, vectors: impl Iterator<Item = Vec3>) -> Interval {
    let mut most = Most::NONE;
    vectors.for_each(|vector| most.take(normal, &vector));
    let [over, under] = most.tilted(turn);
    Interval { low: -under, high: over }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{super::tests::bumps, *};
    use crate::verify::patch::jet;

    /// How fast the slope grows with which a patch falls away at a place below what goes by a way, by differences of its normal.
    fn measured(net: &Net, at: [f64; 2], sense: f64, way: &Vec3) -> f64 {
        let normal = |at: [f64; 2]| {
            let [_, along, across] = jet(net, at);
            along.cross(&across).normalize()
        };
        let ([_, along, across], own) = (jet(net, at), normal(at));
        let flat = way - own * own.dot(way);
        let (a, b, c) = (along.norm_squared(), along.dot(&across), across.norm_squared());
        let (p, q) = (along.dot(&flat), across.dot(&flat));
        let area = a * c - b * b;
        let step = [(c * p - b * q) / area, (a * q - b * p) / area].map(|x| 1e-5 * x);
        let [before, after] = [-1.0, 1.0].map(|s| normal([at[0] + s * step[0], at[1] + s * step[1]]));
        // Where it falls away the normal turns along with the way.
        sense * (after - before).dot(&flat) / 2e-5
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn nowhere_a_patch_falls_away_faster_than_its_bound(
            net in bumps(), flat in 0.0..1.0f64, skew in -2.0..2.0f64,
            [u, v] in [0.0..1.0f64, 0.0..1.0f64], way in prop::array::uniform3(-1.0..1.0f64),
            off in prop::array::uniform3(-1.0..1.0f64), beside in prop::sample::select(vec![0.0, 0.1]),
            sense in prop::sample::select(vec![-1.0, 1.0]),
        ) {
            let net = net.map(|row| row.map(|p| Vec3::new(p.x + skew * p.y, p.y, p.z * flat)));
            let way = Vec3::from(way);
            let Some(most) = Falling::of(&net, sense).and_then(|f| f.along(&way, beside)) else { return Ok(()) };
            let off = Vec3::from(off);
            let found = measured(&net, [u, v], sense, &(way + off * (beside / off.norm().max(1.0))));
            prop_assert!(found <= most + 1e-5, "{found} {most}");
        }
    }

    /// On a saddle there is a bound to tell: along its hollow it falls away nowhere, on a small part of it, and along its ridge as it bends.
    #[test]
    fn a_saddle_falls_away_along_its_ridge_alone() {
        // z = y² − x², its control points by the squares'.
        let part = |size: f64| -> Net {
            let square = |k: usize| size * size * ([0.0, 0.0, 1.0, 3.0][k] / 3.0 - k as f64 / 3.0 + 0.25);
            let place = |k: usize| size * (k as f64 / 3.0 - 0.5);
            std::array::from_fn(|j| {
                std::array::from_fn(|i| Vec3::new(place(i), place(j), square(j) - square(i)))
            })
        };
        let falls = |size: f64, way: Vec3| {
            Falling::of(&part(size), 1.0).and_then(|falling| falling.along(&way, 0.0)).expect("a bound")
        };
        assert!(falls(0.05, Vec3::y()) < 0.0);
        let ridge = falls(0.01, Vec3::x());
        assert!((1.99..2.1).contains(&ridge), "{ridge}");
    }
}

//! Patches of surface that are cubic both ways, and bounds of how they bend.

pub(super) mod along;

use apt_geometry::Vec3;

use super::strip::{Cubic, lerp};

/// Share of a patch by which its cubics are followed beyond each of its sides.
const BEYOND: f64 = 0.25;
/// Least share of the way between two places of a patch, as its mean tangents lead, that is progress in space.
const PROGRESS: f64 = 0.3;

/// Control points: cubics along the patch, in the order across it.
pub(super) type Net = [Cubic; 4];

/// A patch of a surface.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    pub(super) net: Net,
    /// Whether its normal, along × across, is against the natural one.
    pub(super) against: bool,
    /// Where the surface ends or bends sharply on it.
    pub(super) edges: Edges,
    /// How much more than the patch, in curvature, the surface that it stands for may bend.
    pub(super) slack: f64,
    /// The shares of the way from one curve to another at which its sides across lie: beyond the curves it may be farther off the
    /// surface, as the shares grow.
    pub(super) shares: [f64; 2],
    /// How far it may be off between the curves, relative to the one that may be farthest off.
    pub(super) roughness: f64,
    /// The ends of its middle line across, and how far its control points are from that at most.
    pub(super) spine: [Vec3; 2],
    pub(super) girth: f64,
}

/// Where a surface ends or bends sharply on a patch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Edges {
    /// At its sides: the first and the last along it, the first and the last across it.
    pub(super) sides: [bool; 4],
    /// Perhaps anywhere on it.
    pub(super) within: bool,
}

impl Edges {
    /// Those of the halves of a patch, cut along it or across it.
    pub(super) fn halves(self, is_along: bool) -> [Self; 2] {
        let cut = if is_along { [1, 0] } else { [3, 2] };
        cut.map(|side| {
            let mut half = self;
            half.sides[side] = false;
            half
        })
    }
}

/// The sides of a patch in the order of [`Edges::sides`].
pub(super) fn sides(net: &Net) -> [Cubic; 4] {
    [net.map(|row| row[0]), net.map(|row| row[3]), net[0], net[3]]
}

/// The four weights of a cubic's control points and their derivatives.
#[inline]
fn weights(t: f64) -> [[f64; 4]; 2] {
    let r = 1.0 - t;
    [
        [r * r * r, 3.0 * t * r * r, 3.0 * t * t * r, t * t * t],
        [-3.0 * r * r, 3.0 * r * (r - 2.0 * t), 3.0 * t * (2.0 * r - t), 3.0 * t * t],
    ]
}

#[inline]
fn mixed(points: &Cubic, weights: &[f64; 4]) -> Vec3 {
    points[0] * weights[0] + points[1] * weights[1] + points[2] * weights[2] + points[3] * weights[3]
}

/// A place with its derivatives along and across.
pub(super) fn jet(net: &Net, [along, across]: [f64; 2]) -> [Vec3; 3] {
    let ([u, du], [v, dv]) = (weights(along), weights(across));
    let [first, second, third, last] = net;
    let mixed_rows = |w: &[f64; 4]| [mixed(first, w), mixed(second, w), mixed(third, w), mixed(last, w)];
    let (rows, rates) = (mixed_rows(&u), mixed_rows(&du));
    [mixed(&rows, &v), mixed(&rates, &v), mixed(&rows, &dv)]
}

/// A place.
pub(super) fn place_on(net: &Net, [along, across]: [f64; 2]) -> Vec3 {
    let ([u, _], [v, _]) = (weights(along), weights(across));
    let [first, second, third, last] = net;
    mixed(&[mixed(first, &u), mixed(second, &u), mixed(third, &u), mixed(last, &u)], &v)
}

/// Rows and columns changed.
#[inline]
pub(super) fn turned([a, b, c, d]: &Net) -> Net {
    [[a[0], b[0], c[0], d[0]], [a[1], b[1], c[1], d[1]], [a[2], b[2], c[2], d[2]], [a[3], b[3], c[3], d[3]]]
}

/// The two halves of a cubic.
#[inline]
pub(super) fn halves(c: &Cubic) -> [Cubic; 2] {
    let middle = |a: &Vec3, b: &Vec3| (a + b) * 0.5;
    let (ab, bc, cd) = (middle(&c[0], &c[1]), middle(&c[1], &c[2]), middle(&c[2], &c[3]));
    let (abc, bcd) = (middle(&ab, &bc), middle(&bc, &cd));
    let all = middle(&abc, &bcd);
    [[c[0], ab, abc, all], [all, bcd, cd, c[3]]]
}

/// A ball that holds a cubic: its centre and radius.
pub(super) fn ball_of_curve(curve: &Cubic) -> (Vec3, f64) {
    let center = curve.iter().sum::<Vec3>() / 4.0;
    let radius = curve.iter().map(|p| (p - center).norm_squared()).fold(0.0, f64::max).sqrt();
    (center, radius)
}

/// Halves of a patch along it.
pub(super) fn halves_along(net: &Net) -> [Net; 2] {
    let [[a, b], [c, d], [e, f], [g, h]] =
        [halves(&net[0]), halves(&net[1]), halves(&net[2]), halves(&net[3])];
    [[a, c, e, g], [b, d, f, h]]
}

/// Halves of a patch across it.
pub(super) fn halves_across(net: &Net) -> [Net; 2] {
    let [first, last] = halves_along(&turned(net));
    [turned(&first), turned(&last)]
}

/// The ball about the middle of the control points that holds a patch.
pub(super) fn ball(net: &Net) -> (Vec3, f64) {
    let mut center = Vec3::zeros();
    for [a, b, c, d] in net {
        center += (a + b) + (c + d);
    }
    center /= 16.0;
    let mut farthest: f64 = 0.0;
    for place in net.as_flattened() {
        farthest = farthest.max((place - center).norm_squared());
    }
    (center, farthest.sqrt())
}

/// Lengths of a patch along and across.
pub(super) fn extent(net: &Net) -> [f64; 2] {
    let across = [0, 3].map(|i| (net[3][i] - net[0][i]).norm());
    let along = [0, 3].map(|j| (net[j][3] - net[j][0]).norm());
    [along[0].max(along[1]), across[0].max(across[1])]
}

impl Patch {
    pub(super) fn new(net: Net) -> Self {
        let spine = [0.0, 1.0].map(|across| jet(&net, [0.5, across])[0]);
        let off = |j: usize| {
            let middle = lerp(&spine[0], &spine[1], j as f64 / 3.0);
            net[j].iter().map(|p| (p - middle).norm()).fold(0.0, f64::max)
        };
        let girth = (0..4).map(off).fold(0.0, f64::max);
        let (against, edges, slack) = (false, Edges::default(), 0.0);
        Self { net, against, edges, slack, shares: [0.0, 1.0], roughness: 1.0, spine, girth }
    }

    /// How far it may be off the surface between two parameters across it, relative to what one of all patches may be off between
    /// the curves.
    pub(super) fn stretch(&self, range: [f64; 2]) -> f64 {
        let [low, high] = self.shares;
        let at = |across: f64| low + (high - low) * across;
        range.map(|across| at(across).abs() + (1.0 - at(across)).abs()).into_iter().fold(0.0, f64::max)
            * self.roughness
    }

    /// Distance of a point to its spine.
    pub(super) fn remoteness(&self, x: &Vec3) -> f64 {
        let [a, b] = self.spine;
        let along = b - a;
        let square = along.norm_squared();
        let t = if square > 0.0 { ((x - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
        (x - a - along * t).norm()
    }

    /// The parameters across it between which it may be as near to a point as a distance.
    pub(super) fn within(&self, x: &Vec3, distance: f64) -> Option<[f64; 2]> {
        // The control points of a row stand about the place of the spine with its parameter, and so does the row itself.
        let [a, b] = self.spine;
        let (way, from, reach) = (b - a, a - x, distance + self.girth);
        let (square, along) = (way.norm_squared(), way.dot(&from));
        let room = reach * reach - from.norm_squared();
        if reach < 0.0 {
            return None;
        }
        if square <= 0.0 {
            return (room >= 0.0).then_some([0.0, 1.0]);
        }
        let discriminant = along * along + square * room;
        if discriminant <= 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let [low, high] = [(-along - root) / square, (-along + root) / square];
        (low < 1.0 && high > 0.0).then_some([low.max(0.0), high.min(1.0)])
    }

    /// The parameters across it between which its places in a ball are.
    pub(super) fn range_in(&self, center: &Vec3, radius: f64) -> [f64; 2] {
        let [a, b] = self.spine;
        let way = b - a;
        let square = way.norm_squared();
        if square <= 0.0 {
            return [0.0, 1.0];
        }
        let (middle, room) = (way.dot(&(center - a)) / square, (radius + self.girth) / square.sqrt());
        [middle - room, middle + room].map(|across| across.clamp(0.0, 1.0))
    }

    /// Between two cubics with straight lines across.
    pub(super) fn straight([first, last]: &[Cubic; 2]) -> Self {
        let row = |t: f64| std::array::from_fn(|i| lerp(&first[i], &last[i], t));
        Self::new([*first, row(1.0 / 3.0), row(2.0 / 3.0), *last])
    }
}

/// The weights with which the blossom of a cubic at three parameters goes through its control points.
const fn blossom(x: f64, y: f64, z: f64) -> [f64; 4] {
    let (p, q, r) = (1.0 - x, 1.0 - y, 1.0 - z);
    [p * q * r, x * q * r + p * y * r + p * q * z, x * y * r + x * q * z + p * y * z, x * y * z]
}

/// The weights of the control points of a cubic in those of the same cubic from one parameter to another.
const fn weights_between([low, high]: [f64; 2]) -> [[f64; 4]; 4] {
    [blossom(low, low, low), blossom(low, low, high), blossom(low, high, high), blossom(high, high, high)]
}

/// Those of a cubic from −[`BEYOND`] to 1 + [`BEYOND`].
const STRETCHED: [[f64; 4]; 4] = weights_between([-BEYOND, 1.0 + BEYOND]);

/// The patch with other control points across, by their weights in its own.
fn mixed_across(net: &Net, weights: &[[f64; 4]; 4]) -> Net {
    let [first, second, third, last] = net;
    let mut mixed = *net;
    for (row, [a, b, c, d]) in mixed.iter_mut().zip(weights) {
        for (i, place) in row.iter_mut().enumerate() {
            *place = first[i] * *a + second[i] * *b + third[i] * *c + last[i] * *d;
        }
    }
    mixed
}

/// The part of a patch between two parameters across it.
pub(super) fn between_across(net: &Net, range: [f64; 2]) -> Net {
    mixed_across(net, &weights_between(range))
}

/// Parameters of a patch and a little beyond, where its bounds still hold.
pub(super) fn held(parameters: [f64; 2]) -> [f64; 2] {
    parameters.map(|x| x.clamp(-BEYOND, 1.0 + BEYOND))
}

/// The same patch with what is a little beyond its sides.
fn stretched_net(net: &Net) -> Net {
    let mut wide = mixed_across(net, &STRETCHED);
    for row in &mut wide {
        let within = *row;
        for (place, weights) in row.iter_mut().zip(&STRETCHED) {
            *place = mixed(&within, weights);
        }
    }
    wide
}

/// A patch as far as it reaches from a place on it, or a little beyond its sides, to all of its places.
pub(super) fn reached(net: &Net, at: [f64; 2]) -> Net {
    if at.iter().all(|x| (0.0..=1.0).contains(x)) { *net } else { stretched_net(net) }
}

/// Thirds of the derivative along a patch, by control points.
pub(super) fn differences(net: &Net) -> [[Vec3; 3]; 4] {
    net.map(|row| [row[1] - row[0], row[2] - row[1], row[3] - row[2]])
}

/// How much a patch, with what is a little beyond its sides, can bend.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bends {
    /// Curvature of balls on the side that along × across points to, and on the other, that touch the patch anywhere and
    /// have no place of it inside.
    pub(super) hollow: [f64; 2],
}

impl Bends {
    /// None where the patch turns too much for a bound, or its parameters do not spread.
    ///
    /// From one place to another, a and b away in the parameters, a patch goes by `aU + bV` with U and V among the convex
    /// hulls of the differences of its control points, and leaves the tangent plane by half of `a²·n·Uu + 2ab·n·Uv + b²·n·Vv`. The way as the means of
    /// both lead is the measure: however skew they are, no more of it is lost than U and V are off them.
    pub(super) fn of(net: &Net) -> Option<Self> {
        let wide = stretched_net(net);
        let (along, across) = (differences(&wide), differences(&turned(&wide)));
        let spread = |all: &[[Vec3; 3]; 4]| {
            let mut mean = Vec3::zeros();
            for [first, second, third] in all {
                mean += (first + second) + third;
            }
            mean /= 12.0;
            let off = all.as_flattened().iter().map(|d| (d - mean).norm_squared()).fold(0.0, f64::max).sqrt();
            (mean, off)
        };
        let ((u, off_u), (v, off_v)) = (spread(&along), spread(&across));
        let (size_u, size_v) = (u.norm(), v.norm());
        let normal = u.cross(&v);
        let area = normal.norm();
        let cosine = u.dot(&v).abs() / (size_u * size_v);
        let off = (off_u / size_u).hypot(off_v / size_v);
        let progress = 1.0 - off / (1.0 - cosine).max(0.0).sqrt();
        if !(area > 0.0 && progress > PROGRESS) {
            return None;
        }
        let normal = normal / area;
        let turn = 2.0 * (off_u * size_v + size_u * off_v + off_u * off_v) / area;
        // Greatest product of a second derivative with any normal of the patch, to both sides. The differences count
        // thirds of the first derivative, and so ninths of the mixed and two thirds of the others.
        let bends = |all: &[[Vec3; 3]; 4]| {
            let mut most = Most::NONE;
            for [first, second, third] in all {
                most.take(&normal, &(second - first));
                most.take(&normal, &(third - second));
            }
            most.tilted(turn).map(|x| x * (2.0 / 3.0))
        };
        let (uu, vv) = (bends(&along), bends(&across));
        let mut twists = Most::NONE;
        for (row, next) in along.iter().zip(&along[1..]) {
            for (here, beyond) in row.iter().zip(next) {
                twists.take(&normal, &(beyond - here));
            }
        }
        let uv = twists.tilted(turn);
        let twist = uv[0].max(uv[1]).max(0.0) / (size_u * size_v);
        let hollow = [0, 1].map(|side| {
            let (l, k) = (uu[side] / (size_u * size_u), vv[side] / (size_v * size_v));
            greatest_bend([l, k], twist, cosine).max(0.0) / (progress * progress)
        });
        hollow.iter().all(|h| h.is_finite()).then_some(Self { hollow })
    }
}

/// The greatest value of the form `l·a² ± 2·twist·a·b + k·b²` for a unit vector of two that make an angle with that cosine, a along the one and b
/// along the other.
fn greatest_bend([l, k]: [f64; 2], twist: f64, cosine: f64) -> f64 {
    let square_of_sine = 1.0 - cosine * cosine;
    let greatest = |twist: f64| {
        let across = 2.0 * twist - cosine * (l + k);
        let spread = (square_of_sine.sqrt() * (l - k)).hypot(across);
        0.5 * (l + k - 2.0 * twist * cosine + spread) / square_of_sine
    };
    greatest(twist).max(greatest(-twist))
}

/// The greatest heights of vectors over a plane and under it, and their greatest length squared.
struct Most {
    over: f64,
    under: f64,
    square: f64,
}

impl Most {
    const NONE: Self = Self { over: f64::NEG_INFINITY, under: f64::NEG_INFINITY, square: 0.0 };

    fn take(&mut self, normal: &Vec3, vector: &Vec3) {
        let height = normal.dot(vector);
        self.over = self.over.max(height);
        self.under = self.under.max(-height);
        self.square = self.square.max(vector.norm_squared());
    }

    /// Both heights where the plane may lean by a sine.
    fn tilted(&self, turn: f64) -> [f64; 2] {
        let tilt = turn * self.square.sqrt();
        [self.over + tilt, self.under + tilt]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    pub(super) fn bumps() -> impl Strategy<Value = Net> {
        proptest::collection::vec(-0.2..0.2f64, 48).prop_map(|r| {
            std::array::from_fn(|j| {
                std::array::from_fn(|i| {
                    let k = 3 * (4 * j + i);
                    Vec3::new(i as f64 / 3.0 + 0.2 * r[k], 0.7 * j as f64 / 3.0 + 0.2 * r[k + 1], r[k + 2])
                })
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn balls_that_touch_a_patch_hold_no_place_of_it(
            net in bumps(),
            flat in 0.05..1.0f64, skew in -3.0..3.0f64,
            [u, v, s, t] in [-0.25..1.25f64, -0.25..1.25f64, -0.25..1.25f64, -0.25..1.25f64],
        ) {
            let net = net.map(|row| row.map(|p| Vec3::new(p.x + skew * p.y, p.y, p.z * flat)));
            let Some(bends) = Bends::of(&net) else { return Ok(()) };
            let [touch, along, across] = jet(&net, [u, v]);
            let [other, ..] = jet(&net, [s, t]);
            let normal = along.cross(&across).normalize();
            for (side, hollow) in [1.0, -1.0].into_iter().zip(bends.hollow) {
                let rise = side * normal.dot(&(other - touch));
                let room = 0.5 * hollow * (other - touch).norm_squared();
                prop_assert!(rise <= room + 1e-12, "{rise} {room}");
            }
        }

        #[test]
        fn a_bend_is_the_greatest_of_all_directions(
            [l, k] in [-2.0..2.0f64, -2.0..2.0f64], twist in 0.0..2.0f64, cosine in 0.0..0.99f64,
        ) {
            let greatest = greatest_bend([l, k], twist, cosine);
            let sampled = (0..2000).map(|n| {
                let (b, a) = (f64::from(n) * std::f64::consts::PI / 2000.0).sin_cos();
                (l * a * a + 2.0 * twist * (a * b).abs() + k * b * b) / (1.0 + 2.0 * cosine * a * b)
            });
            let sampled = sampled.fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(sampled <= greatest + 1e-9 && sampled >= greatest - 1e-3 * greatest.abs().max(1.0), "{sampled} {greatest}");
        }

        #[test]
        fn nothing_near_a_point_is_outside_its_range_across(
            net in bumps(), [u, v] in [0.0..1.0f64, 0.0..1.0f64],
            point in prop::array::uniform3(-1.0..1.5f64), distance in 0.0..1.0f64,
        ) {
            let patch = Patch::new(net);
            let (place, point) = (jet(&net, [u, v])[0], Vec3::from(point));
            let range = patch.within(&point, distance);
            if (place - point).norm() < distance - 1e-9 {
                let [low, high] = range.expect("a place is near");
                prop_assert!(v >= low - 1e-12 && v <= high + 1e-12, "{v} of {low} to {high}");
            }
            let [low, high] = patch.range_in(&(place + point * distance), point.norm() * distance);
            prop_assert!(v >= low - 1e-12 && v <= high + 1e-12, "{v} of {low} to {high}");
            if let Some([low, high]) = range.filter(|[low, high]| low < high) {
                let part = between_across(&net, [low, high]);
                let same = jet(&net, [u, low + (high - low) * v])[0];
                prop_assert!((jet(&part, [u, v])[0] - same).norm() < 1e-12);
            }
        }

        #[test]
        fn halves_are_parts(net in bumps(), [u, v] in [0.0..1.0f64, 0.0..1.0f64]) {
            let [first, last] = halves_along(&net);
            let whole = jet(&net, [u, v])[0];
            let part = if u < 0.5 { jet(&first, [2.0 * u, v])[0] } else { jet(&last, [2.0 * u - 1.0, v])[0] };
            prop_assert!((whole - part).norm() < 1e-12);
            let [first, last] = halves_across(&net);
            let part = if v < 0.5 { jet(&first, [u, 2.0 * v])[0] } else { jet(&last, [u, 2.0 * v - 1.0])[0] };
            prop_assert!((whole - part).norm() < 1e-12);
        }

        /// A trough z = y²/10 along x, whichever way its rulings lean: its curvature is 1/5 at most, and two and a half times that is as close as control points tell.
        #[test]
        fn a_skew_patch_bends_as_much_as_one_that_is_not(skew in -3.0..3.0f64) {
            let net: Net = std::array::from_fn(|j| {
                let y = j as f64 / 3.0;
                // Control points of the square.
                let square = [0.0, 0.0, 1.0 / 3.0, 1.0][j];
                std::array::from_fn(|i| Vec3::new(i as f64 / 3.0 + skew * y, y, 0.1 * square))
            });
            let bends = Bends::of(&net).expect("a bound");
            prop_assert!(bends.hollow.iter().all(|hollow| *hollow < 0.5), "{bends:?}");
        }

        #[test]
        fn derivatives_are_those_of_the_place(net in bumps(), [u, v] in [0.0..1.0f64, 0.0..1.0f64]) {
            let h = 1e-5;
            let at = |u: f64, v: f64| jet(&net, [u, v])[0];
            let [_, along, across] = jet(&net, [u, v]);
            prop_assert!(((at(u + h, v) - at(u - h, v)) / (2.0 * h) - along).norm() < 1e-8);
            prop_assert!(((at(u, v + h) - at(u, v - h)) / (2.0 * h) - across).norm() < 1e-8);
        }
    }
}

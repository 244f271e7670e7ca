//! The bound of second order: within a cell the depth is a parabola of both parameters but for rests of third order. Planes
//! of support alone do not see that the corner of the tool bends away from the surface, and a cell beside the contact is
//! shown clear by them only once it is small.

use apt_geometry::{Vec3, parametric::Patch};

use crate::tool::Round;

/// Values at the control points.
pub(super) type Net = [[f64; 4]; 4];

/// What the four weights of a cubic give at its middle, of the value and of the derivatives by a parameter from −1 to 1.
const VALUE: [f64; 4] = [0.125, 0.375, 0.375, 0.125];
const SLOPE: [f64; 4] = [-0.375, -0.375, 0.375, 0.375];
const BEND: [f64; 4] = [0.75, -0.75, -0.75, 0.75];
/// The parameter and its square as cubics, by their control values.
const LINE: [f64; 4] = [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0];
const SQUARE: [f64; 4] = [1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0];
/// Determinant of the second derivatives, as a share of their product, below which a parabola is hardly bent one way: rounding
/// would tell where it is level.
const NEARLY_A_TROUGH: f64 = 1e-6;
/// Difference of weights, relative to the weight, that is rounding: in what is as good as a polynomial.
const SAME_WEIGHT: f64 = f64::EPSILON;

/// Whether the control points are those of polynomials.
pub(super) fn is_polynomial(control: &Patch) -> bool {
    let weight = control.control[0][0].w;
    control.control.iter().flatten().all(|point| (point.w - weight).abs() <= SAME_WEIGHT * weight)
}

/// A parabola of two parameters from −1 to 1, null at their middle.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Parabola {
    slope: [f64; 2],
    /// Second derivatives: by the first, by both, by the second.
    bend: [f64; 3],
}

impl Parabola {
    /// That of the derivatives at the middle of a cubic.
    #[inline]
    fn of(net: &Net) -> Self {
        let (values, slopes, bends) = (across(net, &VALUE), across(net, &SLOPE), across(net, &BEND));
        Self {
            slope: [dot(&values, &SLOPE), dot(&slopes, &VALUE)],
            bend: [dot(&values, &BEND), dot(&slopes, &SLOPE), dot(&bends, &VALUE)],
        }
    }

    /// Its values at the control points of a cubic.
    #[inline]
    fn net(&self) -> Net {
        let mut net = [[0.0; 4]; 4];
        for i in 0..4 {
            let first = self.slope[0] * LINE[i] + 0.5 * self.bend[0] * SQUARE[i];
            let slope = self.slope[1] + self.bend[1] * LINE[i];
            for j in 0..4 {
                net[i][j] = first + slope * LINE[j] + 0.5 * self.bend[2] * SQUARE[j];
            }
        }
        net
    }

    /// So many times as much.
    #[inline]
    fn times(&self, factor: f64) -> Self {
        Self { slope: self.slope.map(|slope| factor * slope), bend: self.bend.map(|bend| factor * bend) }
    }

    /// The least value for parameters from −1 to 1: inside where it is convex and level there, else on one of the sides.
    #[inline]
    fn least(&self) -> f64 {
        let ([a, b], [aa, ab, bb]) = (self.slope, self.bend);
        let side = |s: f64| a * s + 0.5 * aa + least_along(b + ab * s, bb);
        let other = |t: f64| b * t + 0.5 * bb + least_along(a + ab * t, aa);
        let on_sides = || side(-1.0).min(side(1.0)).min(other(-1.0)).min(other(1.0));
        if aa <= 0.0 || bb <= 0.0 {
            return on_sides();
        }
        let determinant = aa * bb - ab * ab;
        if determinant <= NEARLY_A_TROUGH * aa * bb {
            // From the least place inside the trough leads to a side, by a diagonal of the square at most, and rises by half
            // its bend, which is no more than twice the determinant over the sum.
            return on_sides() - 8.0 * NEARLY_A_TROUGH * aa * bb / (aa + bb);
        }
        let (s, t) = ((ab * b - bb * a) / determinant, (ab * a - aa * b) / determinant);
        if s.abs() <= 1.0 && t.abs() <= 1.0 { 0.5 * (a * s + b * t) } else { on_sides() }
    }

    /// With `times` the square of a linear function on top.
    #[inline]
    fn with_square(mut self, times: f64, slope: [f64; 2]) -> Self {
        let [a, b] = slope;
        for (bend, square) in self.bend.iter_mut().zip([a * a, a * b, b * b]) {
            *bend += 2.0 * times * square;
        }
        self
    }
}

/// The least of `slope t + bend t²/2` for t from −1 to 1.
#[inline]
fn least_along(slope: f64, bend: f64) -> f64 {
    if bend > slope.abs() { -0.5 * slope * slope / bend } else { 0.5 * bend - slope.abs() }
}

#[inline]
fn less(a: &Net, b: &Net) -> Net {
    let mut found = *a;
    for (value, b) in found.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
        *value -= b;
    }
    found
}

/// What weights give of each row.
#[inline]
fn across(net: &Net, weights: &[f64; 4]) -> [f64; 4] {
    let [a, b, c, d] = net;
    [dot(a, weights), dot(b, weights), dot(c, weights), dot(d, weights)]
}

/// The lesser of two numbers, neither of which is none: in one instruction.
#[inline]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

#[inline]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// The greatest depth in a cell whose control points are `points`, where the corner of a tool is what is nearest to all of
/// them; `None` where something else may be. Where it is found to be above `limit`, it is not told how far.
///
/// Relative to the centre of the arc in the plane through the axis and the middle, with the steps from the middle along the
/// normal, across it and out of that plane, the square of the distance is that of the middle, twice the step along the normal
/// as often as the middle is away, and the squares of the steps; that of the step out of the plane counts as much as the ring
/// of centres bends away from it.
pub(super) fn greatest(round: &Round, points: &[[Vec3; 4]; 4], middle: &Vec3, limit: f64) -> Option<f64> {
    let mut steps = [[[0.0; 4]; 4]; 3];
    let mut reach = Reach::default();
    for (i, row) in points.iter().enumerate() {
        for (j, point) in row.iter().enumerate() {
            let step = point - middle;
            let [normal, across, out] =
                [step.dot(&round.normal), step.dot(&round.across), step.dot(&round.out)];
            (steps[0][i][j], steps[1][i][j], steps[2][i][j]) = (normal, across, out);
            reach.widen(round, normal, across, out);
        }
    }
    let times = [1.0, 1.0, reach.bend(round)?];
    let bent = Parabola::of(&steps[0]);
    let slopes = [bent.slope, straight(&steps[1]), straight(&steps[2])];
    let mut parabola = bent.times(2.0 * round.distance);
    for (slope, times) in slopes.iter().zip(times) {
        parabola = parabola.with_square(times, *slope);
    }
    let square = round.distance * round.distance + parabola.least();
    let needed = (round.depth + round.distance - limit).max(0.0);
    if square < needed * needed {
        return Some(f64::INFINITY);
    }
    let mut rest = less(&steps[0], &bent.net());
    rest.as_flattened_mut().iter_mut().for_each(|rest| *rest *= 2.0 * round.distance);
    // (l + r)² ≥ l² + 2 l r: what is left out is of fourth order.
    let mut products = [[[0.0; 4]; 4]; 2];
    for ((steps, slope), times) in steps.iter().zip(&slopes).zip(times) {
        let bends = less(steps, &Parabola { slope: *slope, bend: [0.0; 3] }.net());
        for (product, slope) in products.iter_mut().zip(slope) {
            let factor = 2.0 * times * slope;
            for (value, bend) in product.as_flattened_mut().iter_mut().zip(bends.as_flattened()) {
                *value += factor * bend;
            }
        }
    }
    let square = square + least_of_fourth(&rest, &products);
    Some(round.depth + round.distance - square.max(0.0).sqrt())
}

/// The least control value of `first + s second + t third` as a polynomial of fourth degree.
#[inline]
fn least_of_fourth(first: &Net, [second, third]: &[Net; 2]) -> f64 {
    // Along t first: all as often as it takes, the third times t.
    let (mut even, mut odd) = ([[0.0; 5]; 4], [[0.0; 5]; 4]);
    for i in 0..4 {
        let (first, second, third) = (raised(&first[i]), raised(&second[i]), multiplied(&third[i]));
        for j in 0..5 {
            even[i][j] = first[j] + third[j];
        }
        odd[i] = second;
    }
    let mut least = f64::INFINITY;
    for j in 0..5 {
        let column = |rows: &[[f64; 5]; 4]| [rows[0][j], rows[1][j], rows[2][j], rows[3][j]];
        let (even, odd) = (raised(&column(&even)), multiplied(&column(&odd)));
        for i in 0..5 {
            let here = even[i] + odd[i];
            if here < least {
                least = here;
            }
        }
    }
    least
}

/// A cubic as a polynomial of fourth degree, by control values.
#[inline]
fn raised(f: &[f64; 4]) -> [f64; 5] {
    [f[0], 0.25 * f[0] + 0.75 * f[1], 0.5 * (f[1] + f[2]), 0.75 * f[2] + 0.25 * f[3], f[3]]
}

/// A cubic times its parameter from −1 to 1.
#[inline]
fn multiplied(f: &[f64; 4]) -> [f64; 5] {
    [-f[0], 0.25 * f[0] - 0.75 * f[1], 0.5 * (f[1] - f[2]), 0.75 * f[2] - 0.25 * f[3], f[3]]
}

/// The slopes of a cubic at the middle.
#[inline]
fn straight(net: &Net) -> [f64; 2] {
    [dot(&across(net, &VALUE), &SLOPE), dot(&across(net, &SLOPE), &VALUE)]
}

/// How far the control points reach about the ring of the arc's centres.
struct Reach {
    /// Least distance outward of the ring, in the plane of the middle.
    outward: f64,
    /// Greatest distance from the axis.
    radius: f64,
    /// Least values of what is positive within the fan of the arc's normals, at its first and at its last.
    fan: [f64; 2],
}

impl Default for Reach {
    fn default() -> Self {
        Self { outward: f64::INFINITY, radius: 0.0, fan: [f64::INFINITY; 2] }
    }
}

impl Reach {
    /// Takes a control point in. All of this is linear, or bends so that its extreme is at a control point.
    #[inline]
    fn widen(&mut self, round: &Round, normal: f64, across: f64, out: f64) {
        // The normal is (sine, −cosine) of the polar angle in that plane, what is across it (cosine, sine).
        let ([sine, cosine], along) = (round.polar, round.distance + normal);
        let outward = along * sine + across * cosine;
        let height = across * sine - along * cosine;
        let inner = round.ring + outward;
        let radius = (inner * inner + out * out).sqrt();
        self.outward = lesser(self.outward, outward);
        self.radius = -lesser(-self.radius, -radius);
        let [[first_sine, first_cosine], [last_sine, last_cosine]] = round.fan;
        // The distance from the axis is no less than its part in the plane, and no more than that at a control point.
        let measure = |by_radius: f64, by_height: f64| {
            let from_axis = if by_radius >= 0.0 { inner } else { radius };
            by_radius * (from_axis - round.ring) + by_height * height
        };
        // On the axis a ball has no inner side.
        let first = measure(first_cosine, first_sine);
        let on_axis =
            if round.is_sphere() && first_cosine >= 0.0 { first_sine * height } else { f64::NEG_INFINITY };
        self.fan[0] = lesser(self.fan[0], first.max(on_axis));
        self.fan[1] = lesser(self.fan[1], measure(-last_cosine, -last_sine));
    }

    /// As how many times its square a step out of the plane counts; `None` where some place may not be beside the arc.
    ///
    /// The distance from the axis is greater than in the plane by the square over twice the greatest one at least, and the
    /// square of how far outward of the ring that is by so much more.
    #[inline]
    fn bend(&self, round: &Round) -> Option<f64> {
        let beside = self.fan.iter().all(|&least| least >= 0.0);
        if !beside || round.is_sphere() {
            return beside.then_some(1.0);
        }
        (self.outward >= 0.0 && self.radius > 0.0).then(|| self.outward / self.radius)
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;
    use proptest::prelude::*;

    use super::*;
    use crate::tool::{Pose, Tool};

    /// A patch over a square about a place, bent by second derivatives and a little more by random heights.
    fn patch(size: f64, at: &[f64; 2], bends: &[f64; 3], heights: &[f64]) -> Patch {
        let line = |k: usize| 0.5 * size * LINE[k];
        let square = |k: usize| 0.25 * size * size * SQUARE[k];
        let height = |i: usize, j: usize| {
            let parabola = 0.5 * (bends[0] * square(i) + bends[2] * square(j)) + bends[1] * line(i) * line(j);
            parabola + heights[4 * i + j] * size.powi(3)
        };
        let points =
            |i: usize| std::array::from_fn(|j| Vec3::new(at[0] + line(i), at[1] + line(j), height(i, j)));
        Patch::from_points(&std::array::from_fn(points))
    }

    #[test]
    fn a_parabola_is_least_inside_or_on_a_side() {
        let inside = Parabola { slope: [0.5, -0.25], bend: [1.0, 0.0, 1.0] };
        assert!((inside.least() + 0.125 + 0.03125).abs() < 1e-12);
        let saddle = Parabola { slope: [0.0, 0.5], bend: [-1.0, 0.0, 1.0] };
        assert!((saddle.least() + 0.5 + 0.125).abs() < 1e-12);
        let trough = Parabola { slope: [0.0; 2], bend: [1.0, 1.0, 1.0] };
        assert!(trough.least() <= 0.0 && trough.least() > -1e-5);
    }

    #[test]
    fn a_cell_about_a_contact_is_told_to_fourth_order() {
        let tool = Tool::new(&Cutter::from_numbers(&[4.0, 2.0], 1.0).unwrap(), 0.0);
        let pose = Pose { end: Vec3::zeros(), axis: Vec3::z() };
        // Half as bent as the ball, and off the middle of the cell.
        let bent = |x: f64| Vec3::new(x, 0.0, 0.125 * x * x);
        let net = std::array::from_fn(|i| {
            let (low, high) = (0.1, 0.9);
            let along = low + (high - low) * i as f64 / 3.0;
            let square =
                [low * low, low * (2.0 * high + low) / 3.0, high * (2.0 * low + high) / 3.0, high * high][i];
            std::array::from_fn(|j| Vec3::new(along, 0.2 * j as f64 - 0.3, 0.125 * square))
        });
        let middle = bent(0.5);
        let round = tool.round(&pose, &middle).unwrap();
        let told = greatest(&round, &net, &middle, f64::INFINITY).unwrap();
        let deepest = tool.depth(&pose, &bent(0.1)).value;
        assert!(told >= deepest - 1e-12 && told <= deepest + 2e-4, "{told} for {deepest}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]

        #[test]
        fn no_point_of_a_cell_is_deeper(
            size in 0.05..1.5f64, offset in prop::array::uniform2(-0.7..0.7f64),
            bends in prop::array::uniform3(-0.5..1.0f64), heights in prop::collection::vec(-0.05..0.05f64, 16),
            numbers in prop::sample::select(vec![
                vec![4.0, 2.0], vec![6.0, 1.0], vec![6.0, 0.5], vec![1.0, 3.0, -2.5, 1.5, 0.0, 0.0, 3.0],
                vec![4.0, 0.75, 1.32, 0.88, 10.0, 5.0, 8.0], vec![8.0, 1.5, 2.64, 1.76, 10.0, 5.0, 16.0],
            ]),
            lean in prop::array::uniform2(-2.0..2.0f64),
        ) {
            let tool = Tool::new(&Cutter::from_numbers(&numbers, 1.0).unwrap(), 0.05);
            let axis = Vec3::new(lean[0], lean[1], 1.0).normalize();
            // In contact with the plane that a patch bends away from.
            let end = tool.end_at_contact(&Vec3::zeros(), &Vec3::z(), &axis, 0.0, &Vec3::x()).unwrap();
            let pose = Pose { end, axis };
            let patch = patch(size, &offset, &bends, &heights);
            let (points, middle) = (patch.points(), patch.evaluate(0.5, 0.5).position);
            let places = (0..=24).flat_map(|i| (0..=24).map(move |j| (f64::from(i) / 24.0, f64::from(j) / 24.0)));
            let deepest = places.map(|(u, v)| tool.depth(&pose, &patch.evaluate(u, v).position).value);
            let deepest = deepest.fold(f64::NEG_INFINITY, f64::max);
            let round = tool.round(&pose, &middle);
            if let Some(told) = round.and_then(|round| greatest(&round, &points, &middle, f64::INFINITY)) {
                prop_assert!(told >= deepest - 1e-9, "{told} for {deepest}");
            }
        }
    }
}

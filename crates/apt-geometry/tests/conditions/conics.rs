//! ELLIPS, HYPERB, GCONIC, LCONIC and QADRIC.

use apt_geometry::Vec3;
use apt_geometry::canonical::{Geometry, GeometryKind};
use apt_geometry::definition::{Impossible, Modifier};
use proptest::prelude::*;

use crate::figure::{
    Figure, Part, Setting, Turns, Verdict, direction, narrow, near_flat_setting, near_setting, point,
    quadric, travel, unit,
};

/// Fails when a place is not on a conic: its distance, by the gradient, is more than the tolerance of the figure and
/// more than the coefficients themselves are known for.
fn on_conic(setting: &Setting, conic: &Geometry, place: &Vec3) -> Verdict {
    let conic = quadric(conic);
    let (value, size) = conic.value_with_size(place);
    let steep = conic.gradient(place).norm();
    let known = 16.0 * f64::EPSILON * size / steep;
    let error = value.abs() / steep;
    let reach = (place - setting.at).norm().max(setting.size);
    prop_assert!(
        error <= 1e-10 * reach + known,
        "off the conic by {error:e}, coefficients known to {known:e}"
    );
    Ok(())
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn ellipses_and_hyperbolas(
        setting in near_flat_setting(), at in unit(), a in 0.01..1.0f64, thin in narrow(), turn in -360.0..360.0f64, hyperbola in any::<bool>(),
        stations in prop::collection::vec(-2.0..2.0f64, 1..6), travel in travel(),
    ) {
        let (center, a) = (setting.flat(at), setting.length(a));
        let b = a * thin.abs();
        let kind = if hyperbola { GeometryKind::Hyperbola } else { GeometryKind::Ellipse };
        let parts = vec![Part::Word(Modifier::Center), point(center), Part::Length(a), Part::Length(b), Part::Heading(turn)];
        let far = 1.0 + (setting.at.norm() + setting.size) / b;
        Figure::flat(kind, setting, Turns::Flat, parts).condition(far.powi(2)).hold(travel, |_| false, |conic| {
            for station in &stations {
                let (u, v) = if hyperbola { (a * station.cosh(), b * station.sinh()) } else { (a * station.cos(), b * station.sin()) };
                on_conic(&setting, conic, &(center + direction(turn) * u + direction(turn + 90.0) * v))?;
            }
            Ok(())
        })?;
    }

    /// The six numbers are the equation.
    #[test]
    fn general_conics(numbers in [-1e3..1e3f64, -1e3..1e3, -1e3..1e3, -1e3..1e3, -1e3..1e3, -1e3..1e3], at in unit()) {
        let [a, b, c, d, e, f] = numbers;
        let setting = Setting { at: Vec3::zeros(), size: 1.0 };
        let parts = numbers.map(Part::Number).to_vec();
        let conic = quadric(&Figure::flat(GeometryKind::GeneralConic, setting, Turns::None, parts).define().expect("a conic"));
        let [x, y, _] = at.map(|value| value * 10.0);
        let expected = a * x * x + b * x * y + c * y * y + d * x + e * y + f;
        prop_assert!((conic.value(&Vec3::new(x, y, 7.0)) - expected).abs() <= 1e-10 * 1e6);
    }

    /// y = px + q ± √(rx² + sx + t) and the same with x and y exchanged.
    #[test]
    fn conics_by_a_root(numbers in [-3.0..3.0f64, -3.0..3.0, -3.0..3.0, -3.0..3.0, 0.1..3.0], x in -2.0..2.0f64, plus in any::<bool>(), exchanged in any::<bool>()) {
        let [p, q, r, s, t] = numbers;
        let inside = r * x * x + s * x + t;
        prop_assume!(inside > 1e-3);
        let y = p * x + q + if plus { inside.sqrt() } else { -inside.sqrt() };
        let mut parts = numbers.map(Part::Number).to_vec();
        let place = if exchanged { Vec3::new(y, x, 0.0) } else { Vec3::new(x, y, 0.0) };
        if exchanged { parts.push(Part::Word(Modifier::FunctionOfY)); }
        let setting = Setting { at: Vec3::zeros(), size: 1.0 };
        let conic = Figure::flat(GeometryKind::GeneralConic, setting, Turns::None, parts).define().expect("a conic");
        on_conic(&setting, &conic, &place)?;
    }

    #[test]
    fn quadrics(numbers in prop::collection::vec(-1e3..1e3f64, 10), at in unit()) {
        let setting = Setting { at: Vec3::zeros(), size: 1.0 };
        let parts = numbers.iter().copied().map(Part::Number).collect();
        let found = quadric(&Figure::space(GeometryKind::Quadric, setting, Turns::None, parts).define().expect("a quadric"));
        let [x, y, z] = at.map(|value| value * 10.0);
        let terms = [x * x, y * y, z * z, y * z, x * z, x * y, x, y, z, 1.0];
        let expected: f64 = terms.iter().zip(&numbers).map(|(term, number)| term * number).sum();
        prop_assert!((found.value(&Vec3::new(x, y, z)) - expected).abs() <= 1e-10 * 1e6);
        // The gradient is the derivative.
        let step = 1e-4;
        for axis in 0..3 {
            let mut ahead = Vec3::new(x, y, z);
            let mut behind = ahead;
            ahead[axis] += step;
            behind[axis] -= step;
            let slope = (found.value(&ahead) - found.value(&behind)) / (2.0 * step);
            prop_assert!((slope - found.gradient(&Vec3::new(x, y, z))[axis]).abs() < 1e-4 * 1e4);
        }
    }

    /// Quadrics move with their equation.
    #[test]
    fn quadrics_move(setting in near_setting(), numbers in prop::collection::vec(-1.0..1.0f64, 10), travel in travel(), at in unit()) {
        let parts = numbers.iter().copied().map(Part::Number).collect();
        let figure = Figure::space(GeometryKind::Quadric, setting, Turns::None, parts);
        let found = figure.define().expect("a quadric");
        let place = Vec3::from(at) * setting.size;
        for matrix in travel.matrices(setting.size) {
            let Geometry::Quadric(moved) = found.transform(&matrix).expect("a similarity") else { panic!("no quadric") };
            let image = matrix.apply_point(&place);
            let (before, size) = quadric(&found).value_with_size(&place);
            let (after, other) = moved.value_with_size(&image);
            prop_assert!((before - after).abs() <= 1e-12 * (size + other), "{before} became {after}");
        }
    }

    /// Five points of an ellipse or hyperbola, or any five, named or by coordinates.
    #[test]
    fn five_points(setting in near_flat_setting(), places in [unit(), unit(), unit(), unit(), unit()], close in narrow(), named in any::<bool>(), travel in travel()) {
        let mut points = places.map(|at| setting.flat(at));
        points[1] = points[0] + (points[1] - points[0]) * close;
        let mut parts = vec![Part::Word(Modifier::FivePoints)];
        parts.extend(points.map(|place| if named { point(place) } else { Part::Place(place, 2) }));
        let condition = degeneracy(&points, setting.size);
        prop_assume!(condition < 1e6);
        Figure::flat(GeometryKind::LoftConic, setting, Turns::Flat, parts).condition(condition * far(&setting)).hold(
            travel,
            |reason| matches!(reason, Impossible::Collinear | Impossible::Coincident { .. }) && condition > 1e3,
            |conic| points.iter().try_for_each(|place| on_conic(&setting, conic, place)),
        )?;
    }

    #[test]
    fn points_and_slopes(setting in near_flat_setting(), places in [unit(), unit(), unit(), unit()], angles in [-80.0..80.0f64, -80.0..80.0], two in any::<bool>(), named in any::<bool>()) {
        let points = places.map(|at| setting.flat(at));
        let slopes = angles.map(|angle| angle.to_radians().tan());
        let place = |place: Vec3| if named { point(place) } else { Part::Place(place, 2) };
        let (parts, count) = if two {
            (vec![
                Part::Word(Modifier::ThreePointsTwoSlopes), place(points[0]), Part::Number(slopes[0]), place(points[1]), Part::Number(slopes[1]), place(points[2]),
            ], 3)
        } else {
            (vec![
                Part::Word(Modifier::FourPointsOneSlope), place(points[0]), Part::Number(slopes[0]), place(points[1]), place(points[2]), place(points[3]),
            ], 4)
        };
        let condition = degeneracy(&points[..count], setting.size);
        prop_assume!(condition < 1e3);
        let figure = Figure::flat(GeometryKind::LoftConic, setting, Turns::None, parts);
        let conic = match figure.define() {
            Ok(conic) => conic,
            Err(other) => return Err(TestCaseError::fail(format!("{other:?}"))),
        };
        points[..count].iter().try_for_each(|place| on_conic(&setting, &conic, place))?;
        for (place, angle) in points.iter().zip(angles).take(if two { 2 } else { 1 }) {
            let gradient = quadric(&conic).gradient(place);
            prop_assume!(gradient.norm() > 0.0);
            let (_, size) = quadric(&conic).value_with_size(place);
            let known = 64.0 * f64::EPSILON * size / (gradient.norm() * setting.size);
            prop_assert!(gradient.normalize().dot(&direction(angle)).abs() <= 1e-10 + known, "the slope is missed");
        }
    }
}

/// One over how far points are from having three in line or two in one place.
fn degeneracy(points: &[Vec3], size: f64) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in points.iter().enumerate() {
        for (j, b) in points.iter().enumerate().skip(i + 1) {
            least = least.min((b - a).norm() / size);
            for c in points.iter().skip(j + 1) {
                least = least.min((b - a).cross(&(c - a)).norm() / (size * size));
            }
        }
    }
    least.recip().powi(2)
}

/// Whether points lie on a line is a matter of their distances from each other, not from the origin.
#[test]
fn conics_through_near_points_far_away() {
    let round = [(5.0, 0.0), (4.0, 3.0), (0.0, 5.0), (-3.0, 4.0), (3.0, -4.0)];
    for (x, y) in [(0.0, 0.0), (2e4, -1e4), (-3e5, 2e5)] {
        let setting = Setting { at: Vec3::new(x, y, 0.0), size: 5.0 };
        let points = round.map(|(along, across)| Vec3::new(x + along, y + across, 0.0));
        let place = |index: usize| Part::Place(points[index], 2);
        let parts = [
            vec![Part::Word(Modifier::FivePoints), place(0), place(1), place(2), place(3), place(4)],
            vec![
                Part::Word(Modifier::FourPointsOneSlope),
                place(2),
                Part::Number(0.0),
                place(0),
                place(1),
                place(3),
            ],
            vec![
                Part::Word(Modifier::ThreePointsTwoSlopes),
                place(2),
                Part::Number(0.0),
                place(4),
                Part::Number(0.75),
                place(0),
            ],
        ];
        for parts in parts {
            let figure = Figure::flat(GeometryKind::LoftConic, setting, Turns::None, parts);
            let conic = figure.define().unwrap_or_else(|reason| panic!("at {x}, {y}: {reason:?}"));
            for point in &points {
                on_conic(&setting, &conic, point).expect("a circle through the points");
            }
        }
    }
}

fn far(setting: &Setting) -> f64 {
    1.0 + (setting.at.norm() / setting.size).powi(2)
}

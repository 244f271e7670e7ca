//! The plane constructions that several definitions share: intersections of lines and circles, and roots.

use super::Impossible;
use super::choice::Toward;
use crate::Vec3;
use crate::canonical::Plane;

/// Distance, in part-program units, below which points coincide and curves touch (APT III).
const COINCIDENCE: f64 = 1e-5;
/// The same as a fraction of the size of small figures: a part program in metres must not lose its features.
const COINCIDENCE_FRACTION: f64 = 1e-3;
/// Sine of the angle below which directions count as parallel (APT III's last pivot).
pub(super) const PARALLEL_SINE: f64 = 1e-5;
/// Bisections that exhaust the digits of an interval of f64 numbers.
const BISECTIONS: usize = 200;
/// A polynomial that comes this near to zero, relative to the sum of the magnitudes of its terms, touches zero.
const TOUCH: f64 = 1e-13;

/// The distance below which two places of a figure of this size are one.
pub(super) fn coincidence(size: f64) -> f64 {
    COINCIDENCE.min(COINCIDENCE_FRACTION * size.abs())
}

/// Fails when two places coincide, measured by their own distance from the origin.
pub(super) fn distinct(a: &Vec3, b: &Vec3) -> Result<(), Impossible> {
    let distance = (b - a).norm();
    if distance <= coincidence(a.amax().max(b.amax())) {
        Err(Impossible::Coincident { distance })
    } else {
        Ok(())
    }
}

/// A quarter turn counter-clockwise in the xy-plane.
pub(super) fn turned_left(vector: &Vec3) -> Vec3 {
    Vec3::new(-vector.y, vector.x, 0.0)
}

/// The place where two lines of the xy-plane meet.
pub(super) fn meet(a: &Plane, b: &Plane) -> Result<Vec3, Impossible> {
    let sine = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
    if sine.abs() <= PARALLEL_SINE {
        return Err(Impossible::Parallel);
    }
    let solve = |of_a: f64, of_b: f64| {
        Vec3::new(of_a * b.normal.y - of_b * a.normal.y, a.normal.x * of_b - b.normal.x * of_a, 0.0) / sine
    };
    // Far from the origin the digits of the distances cancel: solved again for what the first place is off.
    let place = solve(a.distance, b.distance);
    Ok(place - solve(a.signed_distance(&place), b.signed_distance(&place)))
}

/// Half the chord at distance `offset` from the centre of a circle; zero where they touch.
pub(super) fn half_chord(radius: f64, offset: f64) -> Result<f64, Impossible> {
    let gap = offset.abs() - radius;
    if gap.abs() <= coincidence(radius) {
        return Ok(0.0);
    }
    if gap > 0.0 {
        return Err(Impossible::NoIntersection { gap });
    }
    Ok(((radius - offset) * (radius + offset)).sqrt())
}

/// Of the two places `middle ± half·direction` the one that goes farther `toward`.
pub(super) fn select(middle: Vec3, half: f64, direction: Vec3, toward: Toward) -> Result<Vec3, Impossible> {
    if half == 0.0 {
        return Ok(middle);
    }
    Ok(middle + toward.orient(direction)? * half)
}

/// The intersection of a line with a circle that goes farther `toward`.
pub(super) fn line_circle(
    line: &Plane,
    center: &Vec3,
    radius: f64,
    toward: Toward,
) -> Result<Vec3, Impossible> {
    let offset = -line.signed_distance(center);
    let half = half_chord(radius, offset)?;
    select(center + line.normal * offset, half, line.line_direction(), toward)
}

/// The intersection of two circles that goes farther `toward`.
pub(super) fn circle_circle(
    centers: [&Vec3; 2],
    radii: [f64; 2],
    toward: Toward,
) -> Result<Vec3, Impossible> {
    let between = centers[1] - centers[0];
    let distance = between.norm();
    let size = radii[0].max(radii[1]);
    if distance <= coincidence(size) {
        return Err(Impossible::Coincident { distance });
    }
    let apart = distance - (radii[0] + radii[1]);
    let inside = (radii[0] - radii[1]).abs() - distance;
    let tolerance = coincidence(size);
    if apart > tolerance || inside > tolerance {
        return Err(Impossible::NoIntersection { gap: apart.max(inside) });
    }
    let along = between / distance;
    // (r₁² − r₂² + s²) / 2s, with the difference of squares factored so that like radii do not cancel.
    let ahead = 0.5 * (distance + (radii[0] - radii[1]) * (radii[0] + radii[1]) / distance);
    if apart.abs() <= tolerance || inside.abs() <= tolerance {
        return Ok(centers[0] + along * radii[0] * ahead.signum());
    }
    let half = ((radii[0] - ahead) * (radii[0] + ahead)).max(0.0).sqrt();
    select(centers[0] + along * ahead, half, turned_left(&along), toward)
}

/// The real roots of a polynomial (lowest power first) in `[low, high]`, ascending. Roots that only touch zero are
/// found to within rounding.
pub(super) fn roots(coefficients: &[f64], low: f64, high: f64) -> Vec<f64> {
    let degree = coefficients.iter().rposition(|value| *value != 0.0).unwrap_or(0);
    if degree == 0 || low.is_nan() || high.is_nan() || low > high {
        return Vec::new();
    }
    let coefficients = &coefficients[..=degree];
    let derivative: Vec<f64> =
        coefficients.iter().enumerate().skip(1).map(|(power, value)| power as f64 * value).collect();
    // Between turning points the polynomial is monotone, so a change of sign is one root.
    let mut stations = vec![low];
    stations.extend(roots(&derivative, low, high));
    stations.push(high);
    let mut found: Vec<f64> = Vec::new();
    for station in &stations {
        let (value, size) = evaluate(coefficients, *station);
        if value.abs() <= TOUCH * size {
            found.push(*station);
        }
    }
    for pair in stations.windows(2) {
        let [left, right] = [pair[0], pair[1]];
        let ((at_left, left_size), (at_right, right_size)) =
            (evaluate(coefficients, left), evaluate(coefficients, right));
        let touches = at_left.abs() <= TOUCH * left_size || at_right.abs() <= TOUCH * right_size;
        if !touches && at_left.signum() != at_right.signum() {
            found.push(bisect(|place| evaluate(coefficients, place).0, left, right));
        }
    }
    found.sort_by(f64::total_cmp);
    found.dedup();
    found
}

/// Value of a polynomial and the sum of the magnitudes of its terms.
fn evaluate(coefficients: &[f64], place: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, size), coefficient| {
        (value * place + coefficient, size * place.abs() + coefficient.abs())
    })
}

/// The place where a function changes sign between `left` and `right`.
pub(super) fn bisect(function: impl Fn(f64) -> f64, left: f64, right: f64) -> f64 {
    let (mut low, mut high) = (left, right);
    let sign = function(low).signum();
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if function(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn roots_of_known_polynomials() {
        // (x-1)(x-2)(x-3)
        let found = roots(&[-6.0, 11.0, -6.0, 1.0], 0.0, 2.5);
        assert_eq!(found.len(), 2);
        assert!((found[0] - 1.0).abs() < 1e-12 && (found[1] - 2.0).abs() < 1e-12);
        // (x-1)² touches.
        let found = roots(&[1.0, -2.0, 1.0], 0.0, 2.0);
        assert_eq!(found.len(), 1);
        assert!((found[0] - 1.0).abs() < 1e-7);
        assert_eq!(roots(&[1.0, 0.0, 1.0], -5.0, 5.0), Vec::<f64>::new());
        assert_eq!(roots(&[0.0, 0.0], -5.0, 5.0), Vec::<f64>::new());
        assert_eq!(roots(&[-2.0, 1.0], f64::NAN, 5.0), Vec::<f64>::new());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn all_separated_roots_are_found(first in -5.0..-2.0f64, second in -1.0..1.0f64, third in 2.0..5.0f64, scale in 0.1..10.0f64) {
            let coefficients = [
                -scale * first * second * third,
                scale * (first * second + second * third + first * third),
                -scale * (first + second + third),
                scale,
            ];
            let found = roots(&coefficients, -6.0, 6.0);
            prop_assert_eq!(found.len(), 3);
            for (root, expected) in found.iter().zip([first, second, third]) {
                prop_assert!((root - expected).abs() < 1e-9);
            }
        }

        #[test]
        fn circle_intersections_lie_on_both(
            center in [-9.0..9.0f64, -9.0..9.0], radius in 0.5..5.0f64, angle in 0.1..3.0f64, turn in -3.0..3.0f64, other in 0.5..5.0f64,
        ) {
            let first = Vec3::new(center[0], center[1], 0.0);
            let common = first + Vec3::new(turn.cos(), turn.sin(), 0.0) * radius;
            let second = common + Vec3::new((turn + angle).cos(), (turn + angle).sin(), 0.0) * other;
            for word in super::super::choice::X_OR_Y {
                let toward = Toward::from_word(*word).expect("a sense");
                if let Ok(point) = circle_circle([&first, &second], [radius, other], toward) {
                    prop_assert!(((point - first).norm() - radius).abs() < 2e-5);
                    prop_assert!(((point - second).norm() - other).abs() < 2e-5);
                    prop_assert!(toward.component(&(point - common)) > -1e-5);
                }
            }
        }
    }
}

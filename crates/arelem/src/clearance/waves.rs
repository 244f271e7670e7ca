//! A quadratic function on a circle: a constant and two waves. Its least value is found by Newton's method and proven
//! in closed form.

/// Bound of Newton's method; what it leaves is part of the bound.
const MAX_ITERATIONS: u32 = 10;
/// An azimuth step below this (radians) ends it: the value errs by its square.
const ANGLE_RESOLUTION: f64 = 1e-9;
/// Largest step where the function does not bend upward, radians.
const DOWNHILL: f64 = 0.7;

/// `constant + a₁ cos φ + b₁ sin φ + a₂ cos 2φ + b₂ sin 2φ`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Waves {
    pub(super) constant: f64,
    /// a₁ and b₁.
    pub(super) first: [f64; 2],
    /// a₂ and b₂.
    pub(super) second: [f64; 2],
}

/// Length of a vector in the plane, for sizes that are far from overflow.
pub(super) fn length([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

/// A unit vector turned by an angle, the angle being off by its cube.
pub(super) fn turned([c, s]: [f64; 2], angle: f64) -> [f64; 2] {
    // A rotation by twice the angle whose tangent this is.
    let t = 0.5 * angle;
    let (cos, sin) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
    let next = [c * cos - s * sin, s * cos + c * sin];
    // One step towards length 1 keeps rounding from adding up.
    let k = 1.5 - 0.5 * (next[0] * next[0] + next[1] * next[1]);
    [next[0] * k, next[1] * k]
}

impl Waves {
    /// A lower bound that takes no search: both waves at their lowest.
    pub(super) fn coarse_floor(&self) -> f64 {
        self.constant - length(self.first) - length(self.second)
    }

    /// A lower bound that is exact, up to rounding, wherever the valley near a direction (cosine, sine, of any length) or
    /// the one that is lower is the lowest.
    pub(super) fn floor(&self, towards: [f64; 2]) -> f64 {
        let size = length(towards);
        let start = if size > 0.0 { towards.map(|x| x / size) } else { [1.0, 0.0] };
        let (floor, other) = self.valley(start);
        match other {
            None => floor,
            Some(start) => floor.max(self.valley(start).0),
        }
    }

    /// The bound from the valley downhill from a direction; if that is not the lowest, a direction near a lower one.
    ///
    /// About a valley at φ₀, with ψ = φ − φ₀, the function rises by
    /// `(1 − cos ψ)·(K + L cos ψ + M sin ψ)` and a remainder of the slope that is left.
    fn valley(&self, mut direction: [f64; 2]) -> (f64, Option<[f64; 2]>) {
        let [a1, b1] = self.first;
        let [a2, b2] = self.second;
        let mut seen = [0.0; 4];
        for _ in 0..MAX_ITERATIONS {
            let [c, s] = direction;
            let (s2, c2) = (2.0 * s * c, c * c - s * s);
            // The waves as seen from here.
            seen = [a1 * c + b1 * s, b1 * c - a1 * s, a2 * c2 + b2 * s2, b2 * c2 - a2 * s2];
            let slope = seen[1] + 2.0 * seen[3];
            let bend = -seen[0] - 4.0 * seen[2];
            let step = if bend > 0.0 {
                (-slope / bend).clamp(-DOWNHILL, DOWNHILL)
            } else {
                -DOWNHILL.copysign(slope)
            };
            if bend > 0.0 && step.abs() <= ANGLE_RESOLUTION {
                break;
            }
            direction = turned(direction, step);
        }
        let [cosine1, sine1, cosine2, sine2] = seen;
        let here = self.constant + cosine1 + cosine2;
        let left = (sine1 + 2.0 * sine2).abs();
        let (level, along, across) = (-cosine1 - 2.0 * cosine2, -2.0 * cosine2, sine1);
        let tilt = length([along, across]);
        let least = level - tilt;
        let floor = (here - left + 2.0 * least.min(0.0)).max(self.coarse_floor());
        if least >= 0.0 || tilt <= 0.0 {
            return (floor, None);
        }
        let (cos, sin) = (-along / tilt, -across / tilt);
        let [c, s] = direction;
        (floor, Some([c * cos - s * sin, s * cos + c * sin]))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// From wherever the search starts, the bound is below the function, and not far below.
        #[test]
        fn floors_are_the_least_values(
            first in prop::array::uniform2(-2.0..2.0f64), second in prop::array::uniform2(-1.5..1.5f64),
            start in 0.0..std::f64::consts::TAU,
        ) {
            let waves = Waves { constant: 0.3, first, second };
            let at = |x: f64| {
                0.3 + first[0] * x.cos() + first[1] * x.sin() + second[0] * (2.0 * x).cos() + second[1] * (2.0 * x).sin()
            };
            let least = (0..4000).map(|k| at(f64::from(k) * std::f64::consts::TAU / 4000.0)).fold(f64::INFINITY, f64::min);
            let floor = waves.floor([start.cos(), start.sin()]);
            prop_assert!(floor <= least + 1e-12, "{floor} above {least}");
            prop_assert!(waves.coarse_floor() <= least + 1e-12);
            // The lower of at most two valleys, but for starts on a crest.
            prop_assert!(floor >= least - 1e-4 * 4.0 || floor >= waves.coarse_floor());
        }
    }

    /// Newton's method does not come to the valley from there within its bound.
    #[test]
    fn a_search_that_ends_early_is_no_worse_than_none() {
        let (first, second) =
            ([0.9443235081984734, -0.8270099798133431], [0.49046878746631795, 0.34494331003618867]);
        let waves = Waves { constant: 0.3, first, second };
        let start: f64 = 6.175408838975481;
        assert!(waves.floor([start.cos(), start.sin()]) >= waves.coarse_floor());
    }

    #[test]
    fn the_deeper_of_two_valleys_is_found_from_the_other() {
        // Valleys at 90° and, deeper, at 270°.
        let waves = Waves { constant: 0.0, first: [0.0, 0.1], second: [1.0, 0.0] };
        for start in [[0.0, 1.0], [0.1, -1.0], [0.01, 1.0]] {
            assert!((waves.floor(start) + 1.1).abs() < 1e-9, "{}", waves.floor(start));
        }
    }
}

//! The bound where two faces of the tool are equally near: there the depth has a ridge, which one plane of support bounds
//! only as well as the cell is small, two of them as well as its square.

/// Most mixtures that are looked at: each is where the lines of the best two on either side meet, and few lead to the least.
const MOST_MIXTURES: usize = 30;
/// How much lower the least may be, relative to the values, where no more mixtures are looked at.
const NO_LOWER: f64 = 1e-12;

/// The greatest value over a hull that the lesser of two linear functions reaches; they are given by their values at the
/// control points. By duality the least, over all mixtures of the two, of the mixture's greatest value.
pub(super) fn greatest_of_lesser(first: &[[f64; 4]; 4], second: &[[f64; 4]; 4]) -> f64 {
    let (first, second) = (first.as_flattened(), second.as_flattened());
    // The greatest value of a mixture, and how that control point's value changes with the share.
    let mixture = |share: f64| {
        let mut most = (f64::NEG_INFINITY, 0.0);
        for (a, b) in first.iter().zip(second) {
            let value = a + share * (b - a);
            if value > most.0 {
                most = (value, b - a);
            }
        }
        most
    };
    let (mut low, mut high) = (0.0, 1.0);
    let (mut at_low, mut at_high) = (mixture(low), mixture(high));
    let mut best = at_low.0.min(at_high.0);
    if at_low.1 >= 0.0 || at_high.1 <= 0.0 {
        return best;
    }
    // The greatest value is convex in the share: no less than both lines, and least where they meet if it is no greater there.
    for _ in 0..MOST_MIXTURES {
        let (from_low, from_high) = (at_low.0 - at_low.1 * low, at_high.0 - at_high.1 * high);
        let share = ((from_low - from_high) / (at_high.1 - at_low.1)).clamp(low, high);
        let least = from_low + at_low.1 * share;
        let here = mixture(share);
        best = best.min(here.0);
        if here.1 == 0.0 || here.0 - least <= NO_LOWER * (at_low.0.abs() + at_high.0.abs()) {
            break;
        }
        if here.1 < 0.0 {
            (low, at_low) = (share, here);
        } else {
            (high, at_high) = (share, here);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn opposite_slopes_meet_in_the_middle() {
        let rising = std::array::from_fn(|i| [i as f64 - 1.5; 4]);
        let falling = std::array::from_fn(|i| [1.5 - i as f64; 4]);
        assert!(greatest_of_lesser(&rising, &falling).abs() < 1e-7);
        assert_eq!(greatest_of_lesser(&rising, &rising), 1.5);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn it_bounds_the_lesser_everywhere_in_the_hull(
            a in prop::collection::vec(-1.0..1.0f64, 16), b in prop::collection::vec(-1.0..1.0f64, 16),
            weights in prop::collection::vec(0.0..1.0f64, 16),
        ) {
            let net = |values: &[f64]| std::array::from_fn(|i| std::array::from_fn(|j| values[4 * i + j]));
            let bound = greatest_of_lesser(&net(&a), &net(&b));
            let total: f64 = weights.iter().sum::<f64>() + 1e-12;
            let mix = |values: &[f64]| values.iter().zip(&weights).map(|(v, w)| v * w).sum::<f64>() / total;
            prop_assert!(mix(&a).min(mix(&b)) <= bound + 1e-9);
        }
    }
}

//! The bound where two faces of the tool are equally near: there the depth has a ridge, which one plane of support bounds
//! only as well as the cell is small, two of them as well as its square.

/// Most halvings of the share of the second function: beyond that the share does not change.
const MOST_HALVINGS: usize = 30;

/// The greatest value over a hull that the lesser of two linear functions reaches; they are given by their values at the
/// control points. By duality the least, over all mixtures of the two, of the mixture's greatest value.
pub(super) fn greatest_of_lesser(first: &[[f64; 4]; 4], second: &[[f64; 4]; 4]) -> f64 {
    let pairs = || first.iter().flatten().zip(second.iter().flatten());
    // The greatest value of a mixture, and how that control point's value changes with the share.
    let mixture = |share: f64| {
        let mut most = (f64::NEG_INFINITY, 0.0);
        for (a, b) in pairs() {
            let value = a + share * (b - a);
            if value > most.0 {
                most = (value, b - a);
            }
        }
        most
    };
    let (mut low, mut high) = (0.0, 1.0);
    let (at_low, at_high) = (mixture(low), mixture(high));
    let mut best = at_low.0.min(at_high.0);
    if at_low.1 >= 0.0 || at_high.1 <= 0.0 {
        return best;
    }
    for _ in 0..MOST_HALVINGS {
        let share = 0.5 * (low + high);
        let (value, slope) = mixture(share);
        best = best.min(value);
        if slope == 0.0 {
            break;
        }
        if slope < 0.0 {
            low = share;
        } else {
            high = share;
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

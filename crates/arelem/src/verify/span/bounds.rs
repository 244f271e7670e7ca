//! What the readings at both ends of a piece of a vector and a bound of the bend say of the clearance between.

use super::{Bend, Extremes, Sample};

/// Where the parabolas from two samples with a second derivative of `rate` meet, if that is between them.
pub(super) fn crest([a, b]: [Sample; 2], rate: f64) -> Option<f64> {
    let width = b.t - a.t;
    let at = (b.value - a.value - b.slope * width + 0.5 * rate * width * width)
        / (a.slope - b.slope + rate * width);
    (at > 0.0 && at < width).then_some(a.t + at)
}

/// What a function between two samples can be whose second derivative is at most `rate` and whose slope increases suddenly
/// by at most `jumps`: not below its chord less the bulge of a parabola, nor below what leads to either end, nor above what
/// leads on from either end.
///
/// If its slope increases at one corner alone, which a tool that does not turn comes to and leaves once, it is below what leads on from the one
/// end up to there, below what leads to the other end from there on, and nowhere above both beside the corner: the distance from a place is
/// convex on a straight way, and of two sides of the corner each goes on as if there were none.
pub(super) fn bounds([a, b]: [Sample; 2], bend: &Bend, is_left_once: bool) -> Extremes {
    let Bend { rate, jumps, .. } = *bend;
    let width = b.t - a.t;
    let (least, most) = (a.value.min(b.value), a.value.max(b.value));
    let rise = (b.value - a.value) / width;
    let low = if rise.abs() < 0.5 * rate * width {
        let at = 0.5 * width - rise / rate;
        a.value + rise * at - 0.5 * rate * at * (width - at)
    } else {
        least
    };
    // From the one end on it is not below a parabola that has the slope of the other end there.
    let from = |value: f64, slope: f64, slack: f64| {
        if slack.is_infinite() {
            return f64::NEG_INFINITY;
        }
        let first = slope - slack * rate - jumps - rate * width;
        let at = -first / rate;
        if first >= 0.0 {
            value
        } else if at < width {
            value + 0.5 * first * at
        } else {
            value + first * width + 0.5 * rate * width * width
        }
    };
    let low = low - 0.25 * jumps * width;
    let low = low.max(from(a.value, b.slope, b.slack)).max(from(b.value, -a.slope, a.slack)).min(least);
    let high = crest([a, b], rate).map_or(most, |t| {
        let at = t - a.t;
        most.max(a.value + a.slope * at + 0.5 * rate * at * at)
    });
    let high = high + jumps * width;
    let led = |value: f64, slope: f64| value + slope * width + 0.5 * rate * width * width;
    let from_either = most.max(led(a.value, a.slope)).max(led(b.value, -b.slope));
    let high = if is_left_once { high.min(from_either) } else { high };
    let error = a.error.max(b.error);
    Extremes { min: least, max: most, low: low - error, high: high + error }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn sample(t: f64, value: f64) -> Sample {
        Sample { t, value, slope: 0.0, slack: 0.0, error: 0.0 }
    }

    proptest! {
        /// The greater of two parabolas is what a corner leaves of the distances from both of its sides.
        #[test]
        fn nothing_beside_one_corner_is_above_what_leads_on_from_either_end(
            sides in proptest::array::uniform2((-0.1..0.1f64, -1.0..1.0f64, -3.0..0.5f64)),
            width in 0.01..1.0f64,
        ) {
            let rate = 0.5;
            let at = |t: f64| {
                let side = |(value, slope, bend): (f64, f64, f64)| (value + (slope + 0.5 * bend * t) * t, slope + bend * t);
                let [one, other] = sides.map(side);
                if one.0 > other.0 { one } else { other }
            };
            let ends = [0.0, width].map(|t| Sample { slope: at(t).1, ..sample(t, at(t).0) });
            // Parabolas that meet twice have two corners, unless both are between the ends or neither.
            let [one, other] = sides.map(|(value, slope, bend)| move |t: f64| value + (slope + 0.5 * bend * t) * t);
            let signs = (0..=200).map(|k| one(width * f64::from(k) / 200.0) > other(width * f64::from(k) / 200.0));
            let changes = signs.clone().zip(signs.skip(1)).filter(|(a, b)| a != b).count();
            prop_assume!(changes <= 1);
            let bend = Bend { rate, jumps: 2.0 * (1.0 + 3.0), corners: 1 };
            let found = bounds(ends, &bend, true);
            for k in 0..=200 {
                let value = at(width * f64::from(k) / 200.0).0;
                prop_assert!(value <= found.high + 1e-12 && value >= found.low - 1e-12, "{value} {found:?}");
            }
        }
    }

    /// Where contact goes over from one place to another, the parabolas of both meet, and nothing between the samples is above that.
    #[test]
    fn the_crest_is_where_two_parabolas_meet() {
        let [rate, kink] = [0.8, 0.37];
        let rising = |t: f64| Sample { slope: 0.5 + rate * t, ..sample(t, 0.5 * t + 0.5 * rate * t * t) };
        let top = rising(kink).value;
        let falling = |t: f64| Sample {
            slope: -0.9 + rate * (t - kink),
            ..sample(t, top - 0.9 * (t - kink) + 0.5 * rate * (t - kink).powi(2))
        };
        let ends = [rising(0.0), falling(1.0)];
        let found = crest(ends, rate).unwrap();
        assert!((found - kink).abs() < 1e-12, "{found}");
        let bend = Bend { rate, jumps: 0.0, corners: 0 };
        assert!((bounds(ends, &bend, false).high - top).abs() < 1e-12);
    }
}

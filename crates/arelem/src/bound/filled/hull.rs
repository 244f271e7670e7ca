//! Hulls of points that a straight line is to pass above or below.

/// A place along a stretch and how far the path is there from a straight line.
pub(super) type Point = [f64; 2];

/// Where two parts of a hull are farthest apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Widest {
    pub(super) height: f64,
    /// A corner of one of them, and on which side that is: 1 above, −1 below.
    pub(super) corner: Point,
    pub(super) side: f64,
    /// The end of the part across from it.
    pub(super) across: Point,
}

#[cfg(test)]
thread_local! {
    /// Points that this thread has laid to hulls.
    pub(super) static LAID: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Points for which there is room in a hull that begins: of a stretch there are hardly more.
const ROOM: usize = 64;

/// The upper or lower part of the hull of points in order of their places.
pub(super) fn chain<'a>(points: impl IntoIterator<Item = &'a Point>, side: f64) -> Vec<Point> {
    let mut hull = Vec::with_capacity(ROOM);
    lengthen(&mut hull, points, side);
    hull
}

/// Lengthens such a part by points beyond its last one: what those before them hide stays hidden.
pub(super) fn lengthen<'a>(hull: &mut Vec<Point>, points: impl IntoIterator<Item = &'a Point>, side: f64) {
    for point in points {
        #[cfg(test)]
        LAID.set(LAID.get() + 1);
        while let [.., a, b] = hull[..]
            && side * ((b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])) >= 0.0
        {
            hull.pop();
        }
        hull.push(*point);
    }
}

/// The greatest height of the upper part above the lower one where there are both, which is twice what the nearest line is away from the
/// farthest of the points.
pub(super) fn widest(upper: &[Point], lower: &[Point]) -> Option<Widest> {
    let begin = upper.first()?[0].max(lower.first()?[0]);
    let from_above = apart(upper, lower, 1.0, begin);
    let from_below = apart(lower, upper, -1.0, begin);
    from_above.into_iter().chain(from_below).max_by(|a, b| a.height.total_cmp(&b.height))
}

/// The corner of one part that is farthest from the other.
fn apart(corners: &[Point], other: &[Point], side: f64, begin: f64) -> Option<Widest> {
    let mut next = 1;
    let away = |corner: &Point| {
        while next + 1 < other.len() && other[next][0] < corner[0] {
            next += 1;
        }
        let (a, b) = (*other.get(next - 1)?, *other.get(next)?);
        let along = if b[0] > a[0] { (corner[0] - a[0]) / (b[0] - a[0]) } else { 0.0 };
        let height = side * (corner[1] - a[1] - along * (b[1] - a[1]));
        Some(Widest { height, corner: *corner, side, across: b })
    };
    let beyond = corners.iter().filter(|corner| corner[0] >= begin);
    beyond.filter_map(away).max_by(|a, b| a.height.total_cmp(&b.height))
}

/// How many times as wide as it is a band about a line is to be which begins at a place of it, no less than `rooms` from its lower and its upper
/// limit: the line is to pass from there below all of the upper points, and above the lower ones, that many times the rooms away.
pub(super) fn widest_from(upper: &[Point], lower: &[Point], rooms: [f64; 2]) -> Option<Widest> {
    let ahead = |points: &[Point]| points.iter().copied().filter(|point| point[0] > 0.0).collect::<Vec<_>>();
    let (upper, lower) = (ahead(upper), ahead(lower));
    let pairs = upper.iter().flat_map(|high| lower.iter().map(move |low| (high, low)));
    let needed = |(high, low): (&Point, &Point)| {
        let steeper = high[1] / high[0] - low[1] / low[0];
        let free = rooms[1] / high[0] + rooms[0] / low[0];
        // The corner is the contact that comes first.
        let (corner, side, across) = if high[0] < low[0] { (*high, 1.0, *low) } else { (*low, -1.0, *high) };
        (free > 0.0).then_some(Widest { height: steeper / free, corner, side, across })
    };
    pairs.filter_map(needed).max_by(|a, b| a.height.total_cmp(&b.height))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn height(points: &[Point]) -> f64 {
        widest(&chain(points, 1.0), &chain(points, -1.0)).map_or(0.0, |widest| widest.height)
    }

    #[test]
    fn the_height_of_a_hull_is_that_of_its_highest_place() {
        assert_eq!(height(&[[0.0, 0.0], [1.0, 5.0]]), 0.0);
        assert_eq!(height(&[[0.0, 0.0], [1.0, 2.0], [2.0, 0.0]]), 2.0);
        assert_eq!(height(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]), 0.0);
        // A corner below and one above, at different places.
        assert!((height(&[[0.0, 0.0], [1.0, -1.0], [3.0, 1.0], [4.0, 0.0]]) - 4.0 / 3.0).abs() < 1e-12);
    }

    /// A hull that is lengthened is that of all points, wherever it was left and taken up again.
    #[test]
    fn a_hull_may_be_lengthened_bit_by_bit() {
        let wave = |k: u32| [0.1 * f64::from(k), (0.37 * f64::from(k * k % 101)).sin()];
        let points: Vec<Point> = (0..40).map(wave).collect();
        for side in [1.0, -1.0] {
            for left in 0..=points.len() {
                let mut hull = chain(&points[..left], side);
                lengthen(&mut hull, &points[left..], side);
                assert_eq!(hull, chain(&points, side), "{left}");
            }
        }
    }

    /// From the middle of a band about a parabola a line leads √½ of half as far as one from its limit, and as far again.
    #[test]
    fn a_line_from_the_middle_of_the_band_comes_less_far() {
        let points: Vec<Point> = (0..=1000).map(|k| 0.001 * f64::from(k)).map(|x| [x, x * x]).collect();
        let (upper, lower) = (chain(&points, 1.0), chain(&points, -1.0));
        for (below, above) in [(1.0, 0.0), (0.5, 0.5), (0.0, 1.0)] {
            // y = x² with a band of ¼ fills one vector from the limit.
            let found = widest_from(&upper, &lower, [below * 0.25, above * 0.25]).expect("a pair").height;
            let reach = 0.5 * (below.sqrt() + 1.0);
            assert!((found * reach * reach - 1.0).abs() < 2e-3, "{below}: {found}");
        }
    }
}

//! Compares what the interpreter does with the positions of a CL file.

use super::Call;

/// How far the interpreter's numbers, printed with four decimals, may be from those of the CL file.
pub(crate) const TOLERANCE: f64 = 1.0e-4;

/// Whether two positions agree in every coordinate.
pub(crate) fn near(a: [f64; 3], b: [f64; 3], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// Follows the canonical moves along the CL positions. Every straight move must end at the next position (one after
/// a tool change may come in two parts), every arc at a later one with those between on its circle.
pub(crate) fn follow(calls: &[Call], path: &[(bool, [f64; 3])], on_arc: f64) -> (usize, usize) {
    let (mut at, mut arcs, mut straight) = (0, 0, 0);
    let mut here: Option<[f64; 3]> = None;
    let skip = |at: &mut usize, here: Option<[f64; 3]>| {
        while here.is_some_and(|here| path.get(*at).is_some_and(|(_, next)| near(here, *next, TOLERANCE))) {
            *at += 1;
        }
    };
    for call in calls {
        match call {
            Call::Traverse(end) | Call::Feed(end) => {
                skip(&mut at, here);
                let (rapid, next) =
                    path.get(at).unwrap_or_else(|| panic!("{call:?} after the last position"));
                assert_eq!(*rapid, matches!(call, Call::Traverse(_)), "{call:?} at position {at}");
                let approach = *rapid && near([end[0], end[1], 0.0], [next[0], next[1], 0.0], TOLERANCE);
                if near(*end, *next, TOLERANCE) {
                    at += 1;
                    straight += 1;
                } else {
                    assert!(approach, "{call:?} is not at {next:?}");
                }
                here = Some(*end);
            }
            Call::Arc { end, center, turns, axis } => {
                skip(&mut at, here);
                let start = here.expect("an arc needs a start");
                let later = (at..path.len()).find(|index| {
                    // A full turn comes back to where it began, so the first position off the start decides.
                    *index > at && near(path[*index].1, *end, TOLERANCE)
                });
                let last = later.unwrap_or_else(|| panic!("{call:?} ends at no position"));
                let radius = |point: [f64; 3]| {
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    (point[u] - center[u]).hypot(point[v] - center[v])
                };
                for (_, point) in &path[at..=last] {
                    assert!((radius(*point) - radius(start)).abs() <= on_arc, "{point:?} is off {call:?}");
                }
                assert_eq!(turns.abs(), 1);
                (at, here) = (last + 1, Some(*end));
                arcs += 1;
            }
            _ => {}
        }
    }
    skip(&mut at, here);
    assert_eq!(at, path.len(), "positions without a move");
    (straight, arcs)
}

//! The tree of cells of a polyconic surface: their order, and the balls of its inner nodes.

use super::Cell;
use crate::Vec3;

/// Index pairs of a grid, ordered by halving the longer side, so that neighbours in the list are neighbours in the grid.
pub(super) fn halved(rows: &[[f64; 2]], columns: &[[f64; 2]]) -> Vec<(usize, usize)> {
    let mut cells = Vec::with_capacity(rows.len() * columns.len());
    let mut open = vec![(0, rows.len(), 0, columns.len())];
    while let Some((i, m, j, n)) = open.pop() {
        if m == 1 && n == 1 {
            cells.push((i, j));
        } else if m >= n {
            open.extend([(i + m / 2, m - m / 2, j, n), (i, m / 2, j, n)]);
        } else {
            open.extend([(i, m, j + n / 2, n - n / 2), (i, m, j, n / 2)]);
        }
    }
    cells
}

/// The smallest ball about two, with the bounds of both.
pub(super) fn joined(a: &Cell, b: &Cell) -> Cell {
    let summary = match (&a.summary, &b.summary) {
        (Some(one), Some(other)) => Some(one.and(other)),
        (one, other) => one.or(*other),
    };
    let apart = (b.center - a.center).norm();
    let about = |center: Vec3, radius: f64| Cell {
        center,
        radius,
        middle: a.middle,
        half: a.half,
        part: None,
        summary,
    };
    if b.radius < 0.0 || a.radius >= apart + b.radius {
        return about(a.center, a.radius);
    }
    if a.radius < 0.0 || b.radius >= apart + a.radius {
        return about(b.center, b.radius);
    }
    let radius = 0.5 * (apart + a.radius + b.radius);
    about(a.center + (b.center - a.center) * ((radius - a.radius) / apart), radius)
}

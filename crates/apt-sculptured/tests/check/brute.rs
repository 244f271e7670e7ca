//! An independent checker: the surface as a function on a grid, the six best cells refined by nested grids (reference
//! 5.1). It shares no evaluation with the crate.

use apt_geometry::Vec3;

use crate::surfaces::{Function, TestSurface};

/// A simple cutter in a pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mill {
    pub(crate) radius: f64,
    pub(crate) corner: f64,
    pub(crate) length: f64,
    pub(crate) end: Vec3,
    pub(crate) axis: Vec3,
}

impl Mill {
    /// Reference 3.A.
    pub(crate) fn depth(&self, point: Vec3) -> f64 {
        let offset = point - self.end;
        let h = offset.dot(&self.axis);
        let rho = (offset - self.axis * h).norm();
        let e = self.radius - self.corner;
        if rho > e && h < self.corner {
            let depth = self.corner - (rho - e).hypot(self.corner - h);
            // The top of a short tool is nearer than its corner.
            if depth > 0.0 { depth.min(self.length - h) } else { depth }
        } else if rho <= self.radius && (0.0..=self.length).contains(&h) {
            (self.radius - rho).min(h).min(self.length - h)
        } else {
            -(rho - self.radius).max(0.0).hypot((-h).max(h - self.length).max(0.0))
        }
    }
}

const BEST_CELLS: usize = 6;
const NESTED: i32 = 6;
const SHRINK: f64 = 0.55;
const LEVELS: usize = 40;

/// The greatest depth, and where.
pub(crate) fn deepest(surface: &TestSurface, mill: &Mill) -> (f64, Vec3) {
    let each = surface.pieces.iter().map(|piece| deepest_of(piece, mill));
    each.fold((f64::NEG_INFINITY, Vec3::zeros()), |best, one| if one.0 > best.0 { one } else { best })
}

fn deepest_of(piece: &Function, mill: &Mill) -> (f64, Vec3) {
    let depth = |u: f64, v: f64| mill.depth((piece.at)(u, v));
    let step = [0, 1].map(|k| (piece.high[k] - piece.low[k]) / piece.cells[k] as f64);
    let mut starts = Vec::new();
    for i in 0..=piece.cells[0] {
        for j in 0..=piece.cells[1] {
            let (u, v) = (piece.low[0] + step[0] * i as f64, piece.low[1] + step[1] * j as f64);
            starts.push((depth(u, v), u, v));
        }
    }
    starts.sort_by(|a, b| b.0.total_cmp(&a.0));
    starts.truncate(BEST_CELLS);
    let mut best = starts[0];
    for mut center in starts {
        let mut half = step;
        for _ in 0..LEVELS {
            let (_, u, v) = center;
            for i in -NESTED..=NESTED {
                for j in -NESTED..=NESTED {
                    let shift = |k: usize, n: i32| half[k] * f64::from(n) / f64::from(NESTED);
                    let at_u = (u + shift(0, i)).clamp(piece.low[0], piece.high[0]);
                    let at_v = (v + shift(1, j)).clamp(piece.low[1], piece.high[1]);
                    let value = depth(at_u, at_v);
                    if value > center.0 {
                        center = (value, at_u, at_v);
                    }
                }
            }
            half = half.map(|size| size * SHRINK);
        }
        if center.0 > best.0 {
            best = center;
        }
    }
    (best.0, (piece.at)(best.1, best.2))
}

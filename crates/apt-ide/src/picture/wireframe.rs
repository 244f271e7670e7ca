//! Surfaces as a few lines inside the box of the path.

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Sphere, TabulatedCylinder},
    parametric::{SculpturedSurface, SpaceCurve},
};

use super::projection::{Bounds, Point};

/// Pieces of a full circle.
const ARC_PIECES: usize = 96;
/// Straight lines along a cylinder or cone.
const RULINGS: usize = 12;
/// Cells along each side of a section of a quadric.
const CELLS: usize = 56;
/// Pieces per interval of a tabulated cylinder.
const CUBIC_PIECES: usize = 8;

/// Lines along each parameter of a patch besides its edges: one in the middle.
const PATCH_LINES: [f64; 3] = [0.0, 0.5, 1.0];

/// Lines of a surface, each a polyline inside the box. Geometry that is no surface has none.
pub(super) fn lines(geometry: &Geometry, bounds: &Bounds) -> Vec<Vec<Point>> {
    let raw = match geometry {
        Geometry::Plane(p) | Geometry::Line(p) => plane(p, bounds),
        Geometry::Circle(c) | Geometry::Cylinder(c) => cylinder(c, bounds),
        Geometry::Sphere(s) => sphere(s),
        Geometry::Cone(c) => cone(c, bounds),
        Geometry::Ellipse(q)
        | Geometry::Hyperbola(q)
        | Geometry::GeneralConic(q)
        | Geometry::LoftConic(q)
        | Geometry::Quadric(q) => quadric(q, bounds),
        Geometry::TabulatedCylinder(t) => tabulated(t, bounds),
        Geometry::Sculptured(surface) => sculptured(surface),
        Geometry::SpaceCurve(curve) => space_curve(curve),
        _ => Vec::new(),
    };
    raw.iter().flat_map(|line| clip(line, bounds)).collect()
}

/// The pieces of a polyline inside the box.
fn clip(line: &[Point], bounds: &Bounds) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    for pair in line.windows(2) {
        if !pair.iter().flatten().all(|x| x.is_finite()) {
            continue;
        }
        let Some((a, b)) = bounds.clip(pair[0], pair[1]) else { continue };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&a) => piece.push(b),
            _ => pieces.push(vec![a, b]),
        }
    }
    pieces
}

fn point(v: Vec3) -> Point {
    v.into()
}

/// Two unit vectors that complete a direction to a frame; None without a direction.
fn frame(axis: &Vec3) -> Option<(Vec3, Vec3, Vec3)> {
    let axis = axis.try_normalize(f64::MIN_POSITIVE)?;
    let helper = if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let first = axis.cross(&helper).try_normalize(f64::MIN_POSITIVE)?;
    Some((axis, first, axis.cross(&first)))
}

fn circle(center: Vec3, a: Vec3, b: Vec3, radius: f64) -> Vec<Point> {
    (0..=ARC_PIECES)
        .map(|k| {
            let (s, c) = (std::f64::consts::TAU * k as f64 / ARC_PIECES as f64).sin_cos();
            point(center + (a * c + b * s) * radius)
        })
        .collect()
}

/// Where along a direction from a point the box begins and ends.
fn reach(bounds: &Bounds, origin: &Vec3, axis: &Vec3) -> (f64, f64) {
    bounds
        .corners()
        .iter()
        .map(|c| (Vec3::from(*c) - origin).dot(axis))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// The section of the box with the plane: each edge of the box that crosses it gives a corner.
fn plane(plane: &Plane, bounds: &Bounds) -> Vec<Vec<Point>> {
    let size = plane.normal.norm();
    let Some((normal, a, b)) = frame(&plane.normal) else { return Vec::new() };
    let corners = bounds.corners();
    let height = corners.map(|c| normal.dot(&Vec3::from(c)) - plane.distance / size);
    let mut section: Vec<Vec3> = Vec::new();
    for i in 0..8usize {
        for bit in 0..3 {
            let j = i | 1 << bit;
            if j == i || (height[i] > 0.0) == (height[j] > 0.0) {
                continue;
            }
            let t = height[i] / (height[i] - height[j]);
            section.push(Vec3::from(corners[i]) * (1.0 - t) + Vec3::from(corners[j]) * t);
        }
    }
    if section.len() < 3 {
        return Vec::new();
    }
    let middle = section.iter().sum::<Vec3>() / section.len() as f64;
    let turn = |p: &Vec3| (p - middle).dot(&b).atan2((p - middle).dot(&a));
    section.sort_by(|p, q| turn(p).total_cmp(&turn(q)));
    section.push(section[0]);
    vec![section.into_iter().map(point).collect()]
}

fn cylinder(cylinder: &Cylinder, bounds: &Bounds) -> Vec<Vec<Point>> {
    let Some((axis, a, b)) = frame(&cylinder.axis) else { return Vec::new() };
    let (low, high) = reach(bounds, &cylinder.point, &axis);
    let mut lines: Vec<Vec<Point>> = [low, 0.5 * (low + high), high]
        .iter()
        .map(|t| circle(cylinder.point + axis * *t, a, b, cylinder.radius))
        .collect();
    for k in 0..RULINGS {
        let (s, c) = (std::f64::consts::TAU * k as f64 / RULINGS as f64).sin_cos();
        let foot = cylinder.point + (a * c + b * s) * cylinder.radius;
        lines.push(vec![point(foot + axis * low), point(foot + axis * high)]);
    }
    lines
}

fn sphere(sphere: &Sphere) -> Vec<Vec<Point>> {
    let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
    let mut lines =
        vec![circle(sphere.center, y, z, sphere.radius), circle(sphere.center, z, x, sphere.radius)];
    for latitude in [-60f64, -30.0, 0.0, 30.0, 60.0] {
        let (s, c) = latitude.to_radians().sin_cos();
        lines.push(circle(sphere.center + z * (s * sphere.radius), x, y, c * sphere.radius));
    }
    for longitude in [45f64, 135.0] {
        let (s, c) = longitude.to_radians().sin_cos();
        lines.push(circle(sphere.center, x * c + y * s, z, sphere.radius));
    }
    lines
}

fn cone(cone: &Cone, bounds: &Bounds) -> Vec<Vec<Point>> {
    let Some((axis, a, b)) = frame(&cone.axis) else { return Vec::new() };
    let cosine = cone.cosine.clamp(-1.0, 1.0);
    if cosine <= 0.0 {
        return Vec::new();
    }
    let slope = (1.0 - cosine * cosine).sqrt() / cosine;
    let (low, high) = reach(bounds, &cone.vertex, &axis);
    if high <= 0.0 {
        return Vec::new();
    }
    let low = low.max(0.0);
    let mut lines: Vec<Vec<Point>> = (1..=4)
        .map(|k| low + (high - low) * f64::from(k) / 4.0)
        .map(|t| circle(cone.vertex + axis * t, a, b, slope * t))
        .collect();
    for k in 0..RULINGS {
        let (s, c) = (std::f64::consts::TAU * k as f64 / RULINGS as f64).sin_cos();
        let along = axis + (a * c + b * s) * slope;
        lines.push(vec![point(cone.vertex + along * low), point(cone.vertex + along * high)]);
    }
    lines
}

/// Sections with three planes across each axis, by marching squares.
fn quadric(quadric: &Quadric, bounds: &Bounds) -> Vec<Vec<Point>> {
    let [a, b, c, d, f, g, h, p, q, r] = quadric.coefficients;
    let value = |[x, y, z]: Point| {
        a * x * x
            + b * y * y
            + c * z * z
            + d
            + 2.0 * (f * y * z + g * x * z + h * x * y + p * x + q * y + r * z)
    };
    let mut lines = Vec::new();
    for across in 0..3 {
        let (u, v) = ((across + 1) % 3, (across + 2) % 3);
        for share in [0.0, 0.5, 1.0] {
            let level = bounds.low[across] + share * (bounds.high[across] - bounds.low[across]);
            let place = |i: f64, j: f64| {
                let mut x = [0.0; 3];
                x[across] = level;
                x[u] = bounds.low[u] + (bounds.high[u] - bounds.low[u]) * i / CELLS as f64;
                x[v] = bounds.low[v] + (bounds.high[v] - bounds.low[v]) * j / CELLS as f64;
                x
            };
            lines.extend(contour(&value, &place));
        }
    }
    lines
}

/// The zero lines of a function on a grid of cells, as single pieces.
fn contour(value: &dyn Fn(Point) -> f64, place: &dyn Fn(f64, f64) -> Point) -> Vec<Vec<Point>> {
    let side = CELLS + 1;
    let grid: Vec<f64> =
        (0..side * side).map(|k| value(place((k % side) as f64, (k / side) as f64))).collect();
    let mut lines = Vec::new();
    for j in 0..CELLS {
        for i in 0..CELLS {
            let corner = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let mut hits = Vec::with_capacity(4);
            for k in 0..4 {
                let (from, to) = (corner[k], corner[(k + 1) % 4]);
                let (x, y) = (grid[from.0 + side * from.1], grid[to.0 + side * to.1]);
                if (x > 0.0) != (y > 0.0) {
                    let t = x / (x - y);
                    let mix = |p: usize, q: usize| p as f64 + t * (q as f64 - p as f64);
                    hits.push(place(mix(from.0, to.0), mix(from.1, to.1)));
                }
            }
            lines.extend(hits.chunks_exact(2).map(<[Point]>::to_vec));
        }
    }
    lines
}

fn tabulated(table: &TabulatedCylinder, bounds: &Bounds) -> Vec<Vec<Point>> {
    let [u_axis, v_axis, w_axis] = table.axes;
    let (low, high) = reach(bounds, &Vec3::zeros(), &w_axis);
    let mut curve: Vec<[f64; 2]> = Vec::new();
    let ends = table.intervals.iter().skip(1).map(|i| [i.u, i.v]).chain(std::iter::once(table.last));
    for (interval, end) in table.intervals.iter().zip(ends) {
        let length = interval.length;
        if length <= 0.0 {
            continue;
        }
        let along = [(end[0] - interval.u) / length, (end[1] - interval.v) / length];
        for k in 0..=CUBIC_PIECES {
            let s = length * k as f64 / CUBIC_PIECES as f64;
            let rise = s * (s - length) * (interval.a * (s + length) + interval.b);
            curve.push([
                interval.u + along[0] * s - along[1] * rise,
                interval.v + along[1] * s + along[0] * rise,
            ]);
        }
    }
    let lift = |uv: &[f64; 2], w: f64| point(u_axis * uv[0] + v_axis * uv[1] + w_axis * w);
    let mut lines: Vec<Vec<Point>> =
        [low, high].iter().map(|w| curve.iter().map(|uv| lift(uv, *w)).collect()).collect();
    lines.extend(curve.iter().step_by(CUBIC_PIECES + 1).map(|uv| vec![lift(uv, low), lift(uv, high)]));
    lines
}

/// The edges and middle lines of each patch. An edge that two patches share is drawn once.
fn sculptured(surface: &SculpturedSurface) -> Vec<Vec<Point>> {
    let mut lines = Vec::new();
    for (index, patch) in surface.patches.iter().enumerate() {
        // Edges are numbered u=0, u=1, v=0, v=1.
        let drawn = |edge: usize| {
            let neighbour =
                surface.neighbours.get(index).and_then(|edges| edges.get(edge).copied().flatten());
            neighbour.is_some_and(|neighbour| neighbour.patch < index)
        };
        let share = |k: usize| k as f64 / CUBIC_PIECES as f64;
        for (number, at) in PATCH_LINES.into_iter().enumerate() {
            let last = number + 1 == PATCH_LINES.len();
            let edges = if number == 0 {
                Some([0, 2])
            } else if last {
                Some([1, 3])
            } else {
                None
            };
            if !edges.is_some_and(|[u, _]| drawn(u)) {
                lines
                    .push((0..=CUBIC_PIECES).map(|k| point(patch.evaluate(at, share(k)).position)).collect());
            }
            if !edges.is_some_and(|[_, v]| drawn(v)) {
                lines
                    .push((0..=CUBIC_PIECES).map(|k| point(patch.evaluate(share(k), at).position)).collect());
            }
        }
    }
    lines
}

fn space_curve(curve: &SpaceCurve) -> Vec<Vec<Point>> {
    let along = |arc: &apt_geometry::parametric::CurveArc| -> Vec<Point> {
        (0..=CUBIC_PIECES).map(|k| point(arc.evaluate(k as f64 / CUBIC_PIECES as f64).position)).collect()
    };
    curve.arcs.iter().map(along).collect()
}

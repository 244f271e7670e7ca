//! A tabulated cylinder for tests and benchmarks.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Interval, TabulatedCylinder},
};

/// v = offset + height·sin u between −4 and 4.
pub(crate) fn wave(axes: [Vec3; 3], offset: f64, height: f64) -> Geometry {
    let node = |k: i32| {
        let u = 0.5 * f64::from(k);
        [u, offset + height * u.sin(), height * u.cos()]
    };
    let nodes: Vec<[f64; 3]> = (-8..=8).map(node).collect();
    let straight =
        |u: f64, v: f64| Interval { u, v, a: 0.0, b: 0.0, length: 10.0, maximum: 0.0, minimum: 0.0 };
    let ray = |n: [f64; 3], sense: f64| {
        let reach = sense * 10.0 / n[2].hypot(1.0);
        [n[0] + reach, n[1] + n[2] * reach]
    };
    let first = ray(nodes[0], -1.0);
    let mut intervals = vec![straight(first[0], first[1])];
    for pair in nodes.windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        let turn = (q[1] - p[1]).atan2(q[0] - p[0]);
        let [s1, s2] = [p[2], q[2]].map(|s| (s.atan() - turn).tan());
        let (a, b) = ((s1 + s2) / (length * length), -(2.0 * s1 + s2) / length);
        intervals.push(Interval { u: p[0], v: p[1], a, b, length, maximum: 0.0, minimum: 0.0 });
    }
    let last = nodes[nodes.len() - 1];
    intervals.push(straight(last[0], last[1]));
    let surface = TabulatedCylinder { axes, kind: 0.0, intervals, last: ray(last, 1.0) };
    Geometry::TabulatedCylinder(Arc::new(surface))
}

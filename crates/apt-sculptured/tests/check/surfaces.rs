//! The fifteen test surfaces of the reference (5.3), each twice: as patches and as a function.

use std::f64::consts::PI;

use apt_geometry::{
    Vec3,
    canonical::Remembering,
    parametric::{Mesh, Patch, SculpturedSurface},
};
use nalgebra::Vector4;

/// A surface as a function of two parameters over a rectangle.
pub(crate) struct Function {
    pub(crate) low: [f64; 2],
    pub(crate) high: [f64; 2],
    /// Grid of the first search, cells in each direction.
    pub(crate) cells: [usize; 2],
    pub(crate) at: Box<dyn Fn(f64, f64) -> Vec3>,
}

pub(crate) struct TestSurface {
    pub(crate) patches: Remembering<SculpturedSurface>,
    pub(crate) pieces: Vec<Function>,
}

/// A homogeneous cubic in a half-plane: (w·radius, w·height, w).
type Profile = [[f64; 3]; 4];

pub(crate) fn surface(patches: Vec<Patch>, grid: Option<(usize, usize)>) -> Remembering<SculpturedSurface> {
    Remembering::new(SculpturedSurface::assembled(patches, grid, Vec::new(), 1.0, Mesh::default()))
}

/// The patch of a polynomial `Σ c[i][j] uⁱ vʲ`.
fn power(coefficients: [[[f64; 3]; 4]; 4]) -> Patch {
    Patch::from_power(&coefficients.map(|row| row.map(Vec3::from)))
}

/// z(x, y) of second degree over a rectangle: `c + ax x² + ay y² + axy x y`.
fn height_field(low: [f64; 2], high: [f64; 2], c: f64, ax: f64, ay: f64, axy: f64) -> TestSurface {
    let [x0, y0] = low;
    let (dx, dy) = (high[0] - x0, high[1] - y0);
    let mut p = [[[0.0; 3]; 4]; 4];
    p[0][0] = [x0, y0, c + ax * x0 * x0 + ay * y0 * y0 + axy * x0 * y0];
    p[1][0] = [dx, 0.0, 2.0 * ax * x0 * dx + axy * y0 * dx];
    p[0][1] = [0.0, dy, 2.0 * ay * y0 * dy + axy * x0 * dy];
    p[1][1] = [0.0, 0.0, axy * dx * dy];
    p[2][0] = [0.0, 0.0, ax * dx * dx];
    p[0][2] = [0.0, 0.0, ay * dy * dy];
    let at = move |x: f64, y: f64| Vec3::new(x, y, c + ax * x * x + ay * y * y + axy * x * y);
    TestSurface {
        patches: surface(vec![power(p)], Some((1, 1))),
        pieces: vec![Function { low, high, cells: [120, 120], at: Box::new(at) }],
    }
}

/// A circular arc about (cr, cz) from angle `from` to `to` (from the radial direction, less than a half turn).
fn arc(cr: f64, cz: f64, radius: f64, from: f64, to: f64) -> Profile {
    let half = 0.5 * (to - from);
    let weight = half.cos();
    let point = |angle: f64, r: f64| [cr + r * angle.cos(), cz + r * angle.sin()];
    let (p, t, q) = (point(from, radius), point(from + half, radius / weight), point(to, radius));
    let homogeneous = |p: [f64; 2], w: f64| [w * p[0], w * p[1], w];
    let (p, t, q) = (homogeneous(p, 1.0), homogeneous(t, weight), homogeneous(q, 1.0));
    let raised = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| (a[k] + 2.0 * b[k]) / 3.0);
    [p, raised(p, t), raised(q, t), q]
}

fn line(a: [f64; 2], b: [f64; 2]) -> Profile {
    std::array::from_fn(|k| {
        let t = k as f64 / 3.0;
        [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), 1.0]
    })
}

/// Profile (radius, height) turned about z between two angles in equal parts of at most a quarter turn.
fn revolved(profiles: &[Profile], from: f64, to: f64) -> Vec<Patch> {
    let parts = ((to - from) / (0.5 * PI) - 1e-9).ceil() as usize;
    let mut patches = Vec::new();
    for part in 0..parts {
        let step = (to - from) / parts as f64;
        let circle = arc(0.0, 0.0, 1.0, from + step * part as f64, from + step * (part + 1) as f64);
        for profile in profiles {
            let control = profile.map(|[wr, wz, w]| {
                circle.map(|[wx, wy, wc]| Vector4::new(wr * wx, wr * wy, wz * wc, w * wc))
            });
            patches.push(Patch { control });
        }
    }
    patches
}

/// Profile (x, z) moved along y.
fn extruded(profiles: &[Profile], from: f64, to: f64) -> Vec<Patch> {
    let rail = line([from, 0.0], [to, 0.0]);
    let along = |profile: &Profile| Patch {
        control: profile.map(|[wx, wz, w]| rail.map(|[y, ..]| Vector4::new(wx, w * y, wz, w))),
    };
    profiles.iter().map(along).collect()
}

fn flat(corner: [f64; 3], along_u: [f64; 3], along_v: [f64; 3]) -> (Patch, Function) {
    let mut p = [[[0.0; 3]; 4]; 4];
    (p[0][0], p[1][0], p[0][1]) = (corner, along_u, along_v);
    let at = move |u: f64, v: f64| Vec3::from(corner) + Vec3::from(along_u) * u + Vec3::from(along_v) * v;
    (power(p), Function { low: [0.0; 2], high: [1.0; 2], cells: [80, 80], at: Box::new(at) })
}

fn flats(pieces: Vec<(Patch, Function)>) -> TestSurface {
    let (patches, pieces): (Vec<_>, Vec<_>) = pieces.into_iter().unzip();
    TestSurface { patches: surface(patches, None), pieces }
}

fn revolved_function(
    radius_height: impl Fn(f64) -> [f64; 2] + 'static,
    low: f64,
    high: f64,
    turn: [f64; 2],
) -> Function {
    let at = move |s: f64, angle: f64| {
        let [r, z] = radius_height(s);
        Vec3::new(r * angle.cos(), r * angle.sin(), z)
    };
    Function { low: [low, turn[0]], high: [high, turn[1]], cells: [80, 160], at: Box::new(at) }
}

pub(crate) fn t01() -> TestSurface {
    height_field([-10.0; 2], [10.0; 2], 0.0, 0.0, 0.0, 0.0)
}

pub(crate) fn t02() -> TestSurface {
    let end = (6.0f64 / 8.0).asin();
    let patches = revolved(&[arc(0.0, 8.0, 8.0, -0.5 * PI, -0.5 * PI + end)], 0.0, 2.0 * PI);
    let sphere = move |s: f64| [8.0 * s.sin(), 8.0 - 8.0 * s.cos()];
    TestSurface {
        patches: surface(patches, None),
        pieces: vec![revolved_function(sphere, 0.0, end, [0.0, 2.0 * PI])],
    }
}

pub(crate) fn t03() -> TestSurface {
    height_field([-6.0, -10.0], [6.0, 10.0], 0.0, 1.0 / 6.0, 0.0, 0.0)
}

pub(crate) fn t04() -> TestSurface {
    height_field([-10.0; 2], [10.0; 2], 0.0, 0.05, -0.05, 0.0)
}

pub(crate) fn t05() -> TestSurface {
    height_field([-10.0; 2], [10.0; 2], 0.0, 0.025, 0.025, 0.0)
}

pub(crate) fn t06() -> TestSurface {
    flats(vec![
        flat([-20.0, -20.0, 0.0], [24.0, 0.0, 0.0], [0.0, 40.0, 0.0]),
        flat([4.0, -20.0, 0.0], [0.0, 0.0, 3.0], [0.0, 40.0, 0.0]),
        flat([4.0, -20.0, 3.0], [16.0, 0.0, 0.0], [0.0, 40.0, 0.0]),
    ])
}

pub(crate) fn t07() -> TestSurface {
    let root = 2.0f64.sqrt();
    let (foot, rise) = (2.0 - 2.0 * root, 8.0);
    let profiles = [
        line([-rise, rise + foot], [-root, root + foot]),
        arc(0.0, 2.0, 2.0, -0.75 * PI, -0.25 * PI),
        line([root, root + foot], [rise, rise + foot]),
    ];
    let at = move |x: f64, y: f64| {
        let z = if x.abs() <= root { 2.0 - (4.0 - x * x).sqrt() } else { x.abs() + foot };
        Vec3::new(x, y, z)
    };
    TestSurface {
        patches: surface(extruded(&profiles, -10.0, 10.0), None),
        pieces: vec![Function { low: [-8.0, -10.0], high: [8.0, 10.0], cells: [160, 80], at: Box::new(at) }],
    }
}

pub(crate) fn t08() -> TestSurface {
    let profiles = [
        line([25.0, 0.0], [13.0, 0.0]),
        arc(13.0, 3.0, 3.0, -0.5 * PI, -PI),
        line([10.0, 3.0], [10.0, 20.0]),
    ];
    let turn = [0.0, 2.0 * PI];
    TestSurface {
        patches: surface(revolved(&profiles, 0.0, 2.0 * PI), None),
        pieces: vec![
            revolved_function(|s| [13.0 + 12.0 * s, 0.0], 0.0, 1.0, turn),
            revolved_function(|s| [13.0 - 3.0 * s.sin(), 3.0 - 3.0 * s.cos()], 0.0, 0.5 * PI, turn),
            revolved_function(|s| [10.0, 3.0 + 17.0 * s], 0.0, 1.0, turn),
        ],
    }
}

pub(crate) fn t09() -> TestSurface {
    height_field([-20.0; 2], [20.0; 2], 0.0, 0.0, 0.0, 0.02)
}

/// The bumps about the pit, as Hermite patches of a quarter unit: they differ from the sine by 2e-7 at most.
pub(crate) fn t10() -> TestSurface {
    const CELL: f64 = 0.25;
    let k = PI / 10.0;
    let data = move |x: f64, y: f64| {
        let ((sx, cx), (sy, cy)) = ((k * x).sin_cos(), (k * y).sin_cos());
        [
            Vec3::new(x, y, 2.0 * sx * sy),
            Vec3::new(CELL, 0.0, 2.0 * k * CELL * cx * sy),
            Vec3::new(0.0, CELL, 2.0 * k * CELL * sx * cy),
            Vec3::new(0.0, 0.0, 2.0 * k * k * CELL * CELL * cx * cy),
        ]
    };
    let (low, high) = ([8.0, 0.0], [22.0, 12.0]);
    let (columns, rows) = (56, 48);
    let mut patches = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let corner =
                |a: usize, b: usize| data(low[0] + CELL * (i + a) as f64, low[1] + CELL * (j + b) as f64);
            let corners = [[corner(0, 0), corner(0, 1)], [corner(1, 0), corner(1, 1)]];
            patches.push(Patch::from_hermite(&corners));
        }
    }
    let at = move |x: f64, y: f64| Vec3::new(x, y, 2.0 * (k * x).sin() * (k * y).sin());
    TestSurface {
        patches: surface(patches, Some((columns, rows))),
        pieces: vec![Function { low, high, cells: [120, 120], at: Box::new(at) }],
    }
}

pub(crate) fn t11() -> TestSurface {
    let profile = arc(0.0, 20.0, 20.0, -0.5 * PI - 0.9, -0.5 * PI + 0.9);
    let at = |u: f64, v: f64| Vec3::new(20.0 * u.sin(), v, 20.0 - 20.0 * u.cos());
    TestSurface {
        patches: surface(extruded(&[profile], -20.0, 20.0), None),
        pieces: vec![Function { low: [-0.9, -20.0], high: [0.9, 20.0], cells: [150, 150], at: Box::new(at) }],
    }
}

pub(crate) fn t12() -> TestSurface {
    flats(vec![flat([4.0, -2.0, 12.0], [0.0, 4.0, 0.0], [0.0, 0.0, 16.0])])
}

pub(crate) fn t13() -> TestSurface {
    // v = 90° is the pole (0, 0, −6).
    let patches = revolved(&[arc(0.0, 0.0, 6.0, 0.0, -0.5 * PI)], 0.0, 0.5 * PI);
    let bowl = |v: f64| [6.0 * v.cos(), -6.0 * v.sin()];
    TestSurface {
        patches: surface(patches, None),
        pieces: vec![revolved_function(bowl, 0.0, 0.5 * PI, [0.0, 0.5 * PI])],
    }
}

/// A uniform bicubic B-spline over a square of control points.
pub(crate) fn spline(count: usize, control: impl Fn(f64, f64) -> Vec3 + 'static) -> TestSurface {
    let spans = count - 3;
    let point = move |i: usize, j: usize| control(i as f64, j as f64);
    let mut patches = Vec::new();
    for j in 0..spans {
        for i in 0..spans {
            let net: [[Vec3; 4]; 4] = std::array::from_fn(|a| std::array::from_fn(|b| point(i + a, j + b)));
            patches.push(Patch::from_uniform(&net));
        }
    }
    let basis = |t: f64| {
        let s = 1.0 - t;
        let (t2, t3) = (t * t, t * t * t);
        [
            s * s * s / 6.0,
            (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0,
            (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0,
            t3 / 6.0,
        ]
    };
    let at = move |u: f64, v: f64| {
        let (i, j) = ((u.floor() as usize).min(spans - 1), (v.floor() as usize).min(spans - 1));
        let (bu, bv) = (basis(u - i as f64), basis(v - j as f64));
        let mut sum = Vec3::zeros();
        for (a, wu) in bu.iter().enumerate() {
            for (b, wv) in bv.iter().enumerate() {
                sum += point(i + a, j + b) * (wu * wv);
            }
        }
        sum
    };
    let extent = spans as f64;
    TestSurface {
        patches: surface(patches, Some((spans, spans))),
        pieces: vec![Function { low: [0.0; 2], high: [extent; 2], cells: [8 * spans; 2], at: Box::new(at) }],
    }
}

pub(crate) fn t14() -> TestSurface {
    spline(13, |i, j| Vec3::new(5.0 * i, 5.0 * j, 3.0 * (0.9 * i).sin() * (0.7 * j).cos()))
}

pub(crate) fn t15() -> TestSurface {
    spline(33, |i, j| {
        Vec3::new(
            2.0 * i,
            2.0 * j,
            3.0 * (0.45 * i).sin() * (0.35 * j).cos() + 0.5 * (1.7 * i + 0.3 * j).sin(),
        )
    })
}

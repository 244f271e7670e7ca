//! Laws of arcs, patches and surfaces: what holds of all of them.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{
        Cone, Cylinder, Geometry, GeometryKind, Interval, Matrix, Plane, Remembering, Sphere,
        TabulatedCylinder, matrix::CoordinatePlane,
    },
    definition::{
        CurveShape, FlowInput, FlowMeasure, MeshRestriction, ParametricError, ParametricNode,
        SculpturedDefinition, SegmentInput, SpaceCurveDefinition, SurfaceRange, SurfaceShape,
    },
    parametric::{CurveArc, Mesh, Patch, SculpturedSurface, SegmentMeasure, SpaceCurve},
};
use proptest::prelude::*;

/// The sheets T14 and T15 of the reference: uniform B-splines over control points.
fn sheet(count: usize, pitch: f64, height: impl Fn(f64, f64) -> f64) -> SculpturedSurface {
    let control =
        |i: usize, j: usize| Vec3::new(pitch * i as f64, pitch * j as f64, height(i as f64, j as f64));
    let patches = (0..count * count)
        .map(|index| {
            let (column, row) = (index % count, index / count);
            Patch::from_uniform(&std::array::from_fn(|i| {
                std::array::from_fn(|j| control(column + i, row + j))
            }))
        })
        .collect();
    SculpturedSurface::assembled(patches, Some((count, count)), Vec::new(), 1.0, Mesh::default())
}

#[test]
fn the_sheets_of_the_reference_evaluate_as_it_says() {
    let ten = sheet(10, 5.0, |i, j| 3.0 * (0.9 * i).sin() * (0.7 * j).cos());
    let thirty =
        sheet(30, 2.0, |i, j| 3.0 * (0.45 * i).sin() * (0.35 * j).cos() + 0.5 * (1.7 * i + 0.3 * j).sin());
    type Row = ([f64; 2], [f64; 3], [f64; 3], [f64; 2]);
    let rows: [(&SculpturedSurface, Row); 6] = [
        (&ten, ([0.5, 0.5], [7.5, 7.5, 1.169739], [-0.045554, 0.274554, 0.960492], [-0.014242, -0.041015])),
        (
            &ten,
            ([3.25, 7.75], [21.25, 43.75, -1.503304], [0.313928, 0.032436, 0.948893], [0.043969, 0.024712]),
        ),
        (
            &ten,
            ([9.5, 9.75], [52.5, 53.75, -0.019629], [0.139181, -0.007967, 0.990235], [0.057040, -0.055945]),
        ),
        (
            &thirty,
            ([0.5, 0.5], [3.0, 3.0, 1.578012], [-0.163536, 0.192997, 0.967475], [-0.017022, -0.127462]),
        ),
        (
            &thirty,
            ([3.25, 7.75], [8.5, 17.5, -2.788250], [0.012906, 0.078290, 0.996847], [0.206619, 0.080067]),
        ),
        (
            &thirty,
            ([29.5, 29.75], [61.0, 61.5, -0.890729], [0.098821, -0.397, 0.912483], [0.220320, -0.005098]),
        ),
    ];
    for (surface, ([u, v], place, normal, curvatures)) in rows {
        let at = surface.evaluate_global(u, v).expect("inside");
        assert!((at.position - Vec3::from(place)).norm() < 1e-6);
        let found = at.curvatures().expect("regular");
        assert!((found.normal - Vec3::from(normal)).norm() < 1e-6);
        assert!((found.greatest - curvatures[0]).abs() < 1e-6 && (found.least - curvatures[1]).abs() < 1e-6);
    }
    assert!(thirty.neighbours.iter().flatten().flatten().all(|beyond| beyond.smooth && !beyond.reversed));
    assert_eq!(thirty.neighbours.iter().flatten().flatten().count(), 4 * 900 - 120);
}

fn patch_of(numbers: &[f64], weights: &[f64]) -> Patch {
    let mut patch = Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let at = 3 * (4 * i + j);
            Vec3::new(i as f64 + 0.2 * numbers[at], j as f64 + 0.2 * numbers[at + 1], numbers[at + 2])
        })
    }));
    for (point, weight) in patch.control.iter_mut().flatten().zip(weights) {
        *point *= *weight;
    }
    patch
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn derivatives_agree_with_differences(
        numbers in proptest::collection::vec(-1.0..1.0f64, 48), weights in proptest::collection::vec(0.5..2.0f64, 16),
        u in 0.01..0.99f64, v in 0.01..0.99f64,
    ) {
        let patch = patch_of(&numbers, &weights);
        let (h, at) = (1e-5, patch.evaluate(u, v));
        let around = |du: f64, dv: f64| patch.evaluate(u + du * h, v + dv * h);
        let slope = |f: &dyn Fn(f64) -> Vec3| (f(1.0) - f(-1.0)) / (2.0 * h);
        for (found, expected) in [
            (at.du, slope(&|s| around(s, 0.0).position)), (at.dv, slope(&|s| around(0.0, s).position)),
            (at.duu, slope(&|s| around(s, 0.0).du)), (at.duv, slope(&|s| around(0.0, s).du)),
            (at.dvv, slope(&|s| around(0.0, s).dv)),
        ] {
            prop_assert!((found - expected).norm() < 1e-6, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn halves_are_the_same_surface(
        numbers in proptest::collection::vec(-1.0..1.0f64, 48), weights in proptest::collection::vec(0.5..2.0f64, 16),
        u in 0.0..1.0f64, v in 0.0..1.0f64, cut in 0.1..0.9f64,
    ) {
        let patch = patch_of(&numbers, &weights);
        let [low, high] = patch.cut_u(cut);
        prop_assert!((low.evaluate(u, v).position - patch.evaluate(u * cut, v).position).norm() < 1e-12);
        let there = patch.evaluate(cut + u * (1.0 - cut), v).position;
        prop_assert!((high.evaluate(u, v).position - there).norm() < 1e-12);
        let [low, high] = patch.halved_v();
        prop_assert!((low.evaluate(u, v).position - patch.evaluate(u, v * 0.5).position).norm() < 1e-12);
        prop_assert!((high.evaluate(u, v).position - patch.evaluate(u, 0.5 + v * 0.5).position).norm() < 1e-12);
        // The hull holds the patch.
        let surface = SculpturedSurface::assembled(vec![patch], Some((1, 1)), Vec::new(), 1.0, Mesh::default());
        let [least, most] = surface.bounds();
        let place = patch.evaluate(u, v).position;
        prop_assert!((0..3).all(|axis| place[axis] >= least[axis] - 1e-12 && place[axis] <= most[axis] + 1e-12));
    }

    #[test]
    fn affine_maps_commute_with_evaluation_and_rigid_ones_keep_curvature(
        numbers in proptest::collection::vec(-1.0..1.0f64, 48), weights in proptest::collection::vec(0.5..2.0f64, 16),
        u in 0.0..1.0f64, v in 0.0..1.0f64, turn in -180.0..180.0f64, scale in 0.1..30.0f64,
        shift in [-1e3..1e3f64, -1e3..1e3, -1e3..1e3],
    ) {
        let patch = patch_of(&numbers, &weights);
        let matrix = Matrix::translation(Vec3::from(shift))
            .multiply(&Matrix::rotation(CoordinatePlane::Yz, turn))
            .multiply(&Matrix::scaling(scale));
        let moved = patch.transformed(&matrix);
        let (at, there) = (patch.evaluate(u, v), moved.evaluate(u, v));
        prop_assert!((matrix.apply_point(&at.position) - there.position).norm() < 1e-9);
        if let (Some(a), Some(b)) = (at.curvatures(), there.curvatures()) {
            let size = a.greatest.abs().max(a.least.abs()).max(1e-3);
            prop_assert!((a.greatest - b.greatest * scale).abs() < 1e-6 * size);
            prop_assert!((a.least - b.least * scale).abs() < 1e-6 * size);
            prop_assert!((matrix.apply_vector(&a.normal) / scale - b.normal).norm() < 1e-7);
        }
    }

    #[test]
    fn no_place_is_nearer_than_the_nearest(
        numbers in proptest::collection::vec(-1.0..1.0f64, 48), weights in proptest::collection::vec(0.5..2.0f64, 16),
        point in [-2.0..5.0f64, -2.0..5.0, -4.0..4.0],
    ) {
        let patch = patch_of(&numbers, &weights);
        let surface = SculpturedSurface::assembled(vec![patch], Some((1, 1)), Vec::new(), 1.0, Mesh::default());
        let point = Vec3::from(point);
        let found = surface.nearest(&point).expect("a place");
        let distance = (found.position - point).norm();
        for index in 0..=40 * 41 {
            let (u, v) = (f64::from(index % 41) / 40.0, f64::from(index / 41) / 40.0);
            prop_assert!((patch.evaluate(u, v).position - point).norm() >= distance - 1e-9);
        }
    }

    #[test]
    fn lines_through_places_of_a_surface_find_them(
        numbers in proptest::collection::vec(-1.0..1.0f64, 48), weights in proptest::collection::vec(0.5..2.0f64, 16),
        u in 0.02..0.98f64, v in 0.02..0.98f64, way in [-0.5..0.5f64, -0.5..0.5, 1.0..2.0],
    ) {
        let patch = patch_of(&numbers, &weights);
        let surface = SculpturedSurface::assembled(vec![patch], Some((1, 1)), Vec::new(), 1.0, Mesh::default());
        let (at, way) = (patch.evaluate(u, v), Vec3::from(way));
        let steep = at.regular_normal().is_some_and(|normal| normal.dot(&way.normalize()).abs() > 0.1);
        prop_assume!(steep);
        let found = surface.pierced(&(at.position + way * 3.0), &way, &at.position).expect("it meets");
        prop_assert!((found.position - at.position).norm() < 1e-8);
    }

    /// A spline is the same curve in any rigid frame and at any scale.
    #[test]
    fn splines_move_and_scale_with_their_points(
        points in proptest::collection::vec([-9.0..9.0f64, -9.0..9.0, -9.0..9.0], 2..7),
        turn in -180.0..180.0f64, scale in 0.01..100.0f64, shift in [-99.0..99.0f64, -99.0..99.0, -99.0..99.0],
        t in 0.0..1.0f64,
    ) {
        let points: Vec<Vec3> = points.into_iter().map(Vec3::from).collect();
        prop_assume!(points.windows(2).all(|pair| (pair[1] - pair[0]).norm() > 0.1));
        let spline = |points: &[Vec3]| {
            let nodes = points.iter().copied().map(ParametricNode::plain).collect();
            SpaceCurveDefinition::plain(CurveShape::Spline { weight: None, limit: None, nodes }).define()
        };
        let matrix = Matrix::translation(Vec3::from(shift))
            .multiply(&Matrix::rotation(CoordinatePlane::Zx, turn))
            .multiply(&Matrix::scaling(scale));
        let moved: Vec<Vec3> = points.iter().map(|point| matrix.apply_point(point)).collect();
        match (spline(&points), spline(&moved)) {
            (Ok(a), Ok(b)) => {
                let parameter = t * (points.len() - 1) as f64;
                let at = |curve: &SpaceCurve| curve.evaluate_global(parameter).expect("inside").position;
                let (a, b) = (matrix.apply_point(&at(&a.geometry)), at(&b.geometry));
                prop_assert!((a - b).norm() < 1e-7 * scale.max(1.0), "{a:?} {b:?}");
            }
            (a, b) => prop_assert_eq!(a.is_err(), b.is_err()),
        }
    }

    /// Whatever the numbers: a definition gives a finite curve or says why not.
    #[test]
    fn wild_data_never_give_wild_curves(
        points in proptest::collection::vec(
            prop_oneof![
                [-2.0..2.0f64, -2.0..2.0, -2.0..2.0], Just([0.0, 0.0, 0.0]), Just([1e200, -1e200, 0.0]),
                Just([1e-200, 0.0, 0.0]),
            ], 0..6),
        tangents in proptest::collection::vec(proptest::option::of(Just([0.0, 0.0, 0.0]).boxed()
            .prop_union([-1.0..1.0f64, -1.0..1.0, -1.0..1.0].boxed())), 6),
        weight in proptest::option::of(-0.5..1.5f64),
    ) {
        let nodes: Vec<ParametricNode> = points.iter().zip(&tangents).map(|(point, tangent)| ParametricNode {
            tangent: tangent.map(Vec3::from), ..ParametricNode::plain(Vec3::from(*point))
        }).collect();
        for shape in [
            CurveShape::Conic { nodes: nodes.clone() },
            CurveShape::Spline { weight, limit: None, nodes: nodes.clone() },
        ] {
            if let Ok(made) = SpaceCurveDefinition::plain(shape).define() {
                prop_assert!(made.geometry.is_finite());
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    /// Whatever the numbers: a mesh is finite, meets its neighbours and holds its points, or says why not.
    #[test]
    fn wild_meshes_never_give_wild_surfaces(
        heights in proptest::collection::vec(prop_oneof![-2.0..2.0f64, Just(0.0), Just(1e150)], 12),
        tangent in proptest::option::of([-1.0..1.0f64, -1.0..1.0, -1.0..1.0]), collapse: bool, over in 0..2usize,
    ) {
        let mut rows: Vec<Vec<ParametricNode>> = (0..3)
            .map(|row| (0..4).map(|column| {
                let point = Vec3::new(f64::from(column), f64::from(row), heights[(4 * row + column) as usize]);
                ParametricNode::plain(point)
            }).collect())
            .collect();
        rows[1][2].tangent = tangent.map(Vec3::from);
        if collapse {
            let first = rows[0][0].point;
            rows[0].iter_mut().for_each(|node| node.point = first);
        }
        let restriction =
            [MeshRestriction::Free, MeshRestriction::Height(CoordinatePlane::Xy)][over];
        let shape = SurfaceShape::Mesh { restriction, rows: rows.clone() };
        if let Ok(made) = SculpturedDefinition::plain(shape).define() {
            let surface = made.geometry;
            prop_assert!(surface.is_finite());
            for (row, line) in rows.iter().enumerate() {
                for (column, node) in line.iter().enumerate() {
                    let found = surface.evaluate_global(column as f64, row as f64).expect("inside").position;
                    prop_assert!((found - node.point).norm() <= 1e-9 * node.point.norm().max(1.0));
                }
            }
        }
    }

    /// Rows of numbers of any kind are a curve or surface that can be used, or an error.
    #[test]
    fn wild_rows_are_refused_or_usable(
        arcs in 0..3usize, ranges in 0..2usize, segments in 0..3usize,
        numbers in proptest::collection::vec(
            prop_oneof![0.0..3.0f64, Just(0.0), Just(1.0), Just(2.0), Just(-1.0), Just(1e300), Just(f64::NAN)], 80),
    ) {
        let count = 16 * arcs + 4 * (arcs + 1) + 10 * ranges + 3 * segments;
        let mut row = vec![arcs as f64, ranges as f64, segments as f64];
        row.extend(numbers.iter().copied().cycle().take(count));
        if let Ok(Geometry::SpaceCurve(curve)) = Geometry::from_canonical(GeometryKind::SpaceCurve, &row) {
            let _ = loft(vec![curve.clone(), curve.clone()], vec![curve.clone(), curve.clone()]);
            prop_assert!(curve.locate(0.5).is_some());
        }
    }
}

fn flowing(shape: CurveShape, arcs: f64, measure: SegmentMeasure) -> Arc<SpaceCurve> {
    let mut definition = SpaceCurveDefinition::plain(shape);
    definition.flow = vec![FlowInput { measure: FlowMeasure::Arc(None), first: 0.0, last: arcs }];
    definition.segments = vec![SegmentInput { measure, first: 0.0, last: arcs }];
    Arc::new(definition.define().expect("a curve").geometry)
}

fn nodes(points: &[[f64; 3]]) -> Vec<ParametricNode> {
    points.iter().map(|point| ParametricNode::plain(Vec3::from(*point))).collect()
}

fn loft(
    curves: Vec<Arc<SpaceCurve>>,
    cross: Vec<Arc<SpaceCurve>>,
) -> Result<SculpturedSurface, ParametricError> {
    SculpturedDefinition::plain(SurfaceShape::Curves { curves, cross }).define().map(|made| made.geometry)
}

#[test]
fn lofts_of_arcs_and_of_lengths_are_close_to_exact() {
    let arc = |z: f64, r: f64| {
        let s = 0.5f64.sqrt() * r;
        CurveShape::Conic { nodes: nodes(&[[r, 0., z], [s, s, z], [0., r, z]]) }
    };
    // Between arcs of the same weights: exact, one patch.
    let made = loft(
        vec![
            flowing(arc(0.0, 5.0), 1.0, SegmentMeasure::Param),
            flowing(arc(4.0, 3.0), 1.0, SegmentMeasure::Param),
        ],
        vec![],
    );
    let cone = made.expect("a cone");
    assert_eq!(cone.patches.len(), 1);
    for index in 0..=20 {
        let t = f64::from(index) / 20.0;
        let place = cone.evaluate_global(t, 0.3).expect("inside").position;
        assert!((place.x.hypot(place.y) - (5.0 - 2.0 * 0.3)).abs() < 1e-12);
    }
    // By length along both: as even as the angle, in several columns of one patch.
    let made = loft(
        vec![
            flowing(arc(0.0, 5.0), 1.0, SegmentMeasure::Length),
            flowing(arc(4.0, 3.0), 1.0, SegmentMeasure::Length),
        ],
        vec![],
    );
    let even = made.expect("a cone");
    assert!(even.count() == 1 && even.patches.len() > 1);
    for index in 0..=20 {
        let t = f64::from(index) / 20.0;
        let place = even.evaluate_global(t, 0.3).expect("inside").position;
        let angle = t * std::f64::consts::FRAC_PI_2;
        assert!((place - Vec3::new(4.4 * angle.cos(), 4.4 * angle.sin(), 1.2)).norm() < 1e-6);
        let (patch, u, v) = even.locate(t, 0.3).expect("inside");
        let back = even.globally(patch, u, v);
        assert!((back[0] - t).abs() < 1e-12 && (back[1] - 0.3).abs() < 1e-12);
    }
    let derivative = even.evaluate_global(0.4, 0.0).expect("inside").du.norm();
    assert!((derivative - 5.0 * std::f64::consts::FRAC_PI_2).abs() < 1e-3);
}

#[test]
fn b_splines_are_taken_over_exactly() {
    let s = 0.5f64.sqrt();
    let circle = CurveShape::BSpline {
        degree: 2,
        knots: vec![0., 0., 0., 1., 1., 2., 2., 2.],
        points: [[1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [-1., 1., 0.], [-1., 0., 0.]]
            .map(Vec3::from)
            .to_vec(),
        weights: vec![1.0, s, 1.0, s, 1.0],
    };
    let made = SpaceCurveDefinition::plain(circle).define().expect("half a circle").geometry;
    assert_eq!(made.arcs.len(), 2);
    for index in 0..=20 {
        let place = made.evaluate_global(f64::from(index) / 10.0).expect("inside").position;
        assert!((place.norm() - 1.0).abs() < 1e-14);
    }
    // Uneven knots: the spline is twice continuously differentiable by its own parameter.
    let knots = vec![0., 0., 0., 0., 1., 3., 3.5, 3.5, 3.5, 3.5];
    let points: Vec<Vec3> =
        (0..6).map(|i| Vec3::new(f64::from(i), f64::from(i * i % 5), f64::from(i % 2))).collect();
    let shape = CurveShape::BSpline { degree: 3, knots, points: points.clone(), weights: vec![] };
    let made = SpaceCurveDefinition::plain(shape).define().expect("a curve").geometry;
    let widths = [1.0, 2.0, 0.5];
    for joint in 0..2 {
        let (a, b) = (made.arcs[joint].evaluate(1.0), made.arcs[joint + 1].evaluate(0.0));
        let (p, q) = (widths[joint], widths[joint + 1]);
        assert!((a.position - b.position).norm() < 1e-12);
        assert!((a.first / p - b.first / q).norm() < 1e-12);
        assert!((a.second / (p * p) - b.second / (q * q)).norm() < 1e-11);
    }
    assert!((made.arcs[0].evaluate(0.0).position - points[0]).norm() < 1e-14);
    let flat: Vec<Vec3> =
        (0..9).map(|i| Vec3::new(f64::from(i % 3), f64::from(i / 3), f64::from(i % 2))).collect();
    let shape = SurfaceShape::BSpline {
        degrees: [2, 1],
        knots: [vec![0., 0., 0., 1., 1., 1.], vec![0., 0., 1., 2., 2.]],
        points: flat,
        weights: vec![],
    };
    let made = SculpturedDefinition::plain(shape).define().expect("a surface").geometry;
    assert_eq!((made.grid, made.patches.len()), (Some((1, 2)), 2));
    // The quadratic of 0, 1, 0 at the middle is a half; the rows are linear.
    assert!(
        (made.evaluate_global(0.5, 0.0).expect("inside").position - Vec3::new(1.0, 0.0, 0.5)).norm() < 1e-14
    );
    assert!(
        (made.evaluate_global(0.5, 0.5).expect("inside").position - Vec3::new(1.0, 0.5, 0.5)).norm() < 1e-14
    );
    let wrong = CurveShape::BSpline {
        degree: 3,
        knots: vec![0.0; 4],
        points: vec![Vec3::zeros(); 2],
        weights: vec![],
    };
    assert!(matches!(SpaceCurveDefinition::plain(wrong).define(), Err(ParametricError::Knots { .. })));
}

#[test]
fn classic_surfaces_are_taken_over_exactly() {
    let taken = |surface: Geometry, u: [f64; 2], v: [f64; 2]| {
        let shape = SurfaceShape::Converted { surface, range: SurfaceRange { u, v } };
        SculpturedDefinition::plain(shape).define().map(|made| made.geometry)
    };
    let plane = Plane { normal: Vec3::new(0.6, 0.0, 0.8), distance: 2.0 };
    let cylinder = Cylinder { point: Vec3::new(1.0, 2.0, 3.0), axis: Vec3::new(0.0, 0.6, 0.8), radius: 2.5 };
    let sphere = Sphere { center: Vec3::new(-1.0, 4.0, 2.0), radius: 3.0 };
    let cone = Cone { vertex: Vec3::new(1.0, 1.0, 1.0), axis: Vec3::x(), cosine: 0.8 };
    let on = |geometry: &Geometry, place: &Vec3| match geometry {
        Geometry::Plane(plane) => plane.normal.dot(place) - plane.distance,
        Geometry::Cylinder(one) => (place - one.point).cross(&one.axis).norm() - one.radius,
        Geometry::Sphere(one) => (place - one.center).norm() - one.radius,
        Geometry::Cone(one) => {
            let ray = place - one.vertex;
            ray.dot(&one.axis) - ray.norm() * one.cosine
        }
        other => panic!("{other:?}"),
    };
    for (geometry, u, v, patches) in [
        (Geometry::Plane(plane), [-3.0, 5.0], [0.0, 2.0], 1),
        (Geometry::Cylinder(cylinder), [10.0, 280.0], [-1.0, 4.0], 3),
        (Geometry::Sphere(sphere), [0.0, 360.0], [-90.0, 90.0], 8),
        (Geometry::Cone(cone), [0.0, 90.0], [0.0, 7.0], 1),
    ] {
        let made = taken(geometry.clone(), u, v).expect("a piece");
        assert_eq!(made.count(), patches);
        let [width, height] = made.extent();
        for index in 0..=11 * 11 {
            let (s, t) =
                (f64::from(index % 11) / 10.0 * width, f64::from(index / 11).min(10.0) / 10.0 * height);
            let place = made.evaluate_global(s, t).expect("inside").position;
            assert!(on(&geometry, &place).abs() < 1e-12, "{geometry:?} {}", on(&geometry, &place));
        }
        // Collapsed edges and corners have normals too, the limits from inside.
        for (s, t) in [(0.3, 0.0), (0.3, height), (0.0, 0.0), (width, height)] {
            let normal = made.normal_global(s, t).expect("inside");
            assert!((normal.direction.norm() - 1.0).abs() < 1e-9);
        }
    }
    let round = taken(Geometry::Sphere(sphere), [0.0, 360.0], [-90.0, 90.0]).expect("a sphere");
    assert!((round.area() / (36.0 * std::f64::consts::PI) - 1.0).abs() < 1e-6, "{}", round.area());
    let [least, greatest] = round.curvature_range().expect("curvatures");
    assert!((least.curvature + 1.0 / 3.0).abs() < 1e-8 && (greatest.curvature + 1.0 / 3.0).abs() < 1e-8);
    let interval = |u: f64| Interval { u, v: 0.5, a: 0.1, b: 0.2, length: 2.0, maximum: 0.0, minimum: -0.3 };
    let table = TabulatedCylinder {
        axes: [Vec3::x(), Vec3::y(), Vec3::z()],
        kind: 0.0,
        intervals: vec![interval(-2.0), interval(0.0), interval(2.0)],
        last: [4.0, 0.5],
    };
    let made = taken(Geometry::TabulatedCylinder(Arc::new(table)), [0.0, 1.0], [-1.0, 3.0]).expect("a piece");
    let place = made.evaluate_global(0.25, 0.5).expect("inside").position;
    let s = 0.5;
    assert!((place - Vec3::new(0.5, 0.5 + s * (s - 2.0) * (0.1 * (s + 2.0) + 0.2), 1.0)).norm() < 1e-12);
    let fault = taken(Geometry::Point(Vec3::zeros()), [0.0, 1.0], [0.0, 1.0]);
    assert_eq!(fault, Err(ParametricError::NotConvertible { kind: GeometryKind::Point }));
}

#[test]
fn surfaces_join_and_tell_which_lie_apart() {
    let sheet = |x: f64, y: f64, length: f64| {
        let points = std::array::from_fn(|i| {
            let x = x + length * i as f64 / 3.0;
            std::array::from_fn(|j| Vec3::new(x, y + j as f64, 0.01 * x * (y + j as f64)))
        });
        let patches = vec![Patch::from_points(&points)];
        Remembering::new(SculpturedSurface::assembled(
            patches,
            Some((1, 1)),
            Vec::new(),
            1.0,
            Mesh::default(),
        ))
    };
    let apart = |surfaces: Vec<Remembering<SculpturedSurface>>| {
        let made =
            SculpturedDefinition::plain(SurfaceShape::Combined { surfaces }).define().expect("a surface");
        made.warnings
    };
    assert_eq!(apart(vec![sheet(0.0, 0.0, 3.0), sheet(0.0, -3.0, 3.0)]), []);
    // A part of an edge is enough, and so is a neighbour that comes later.
    assert_eq!(apart(vec![sheet(0.0, 0.0, 3.0), sheet(1.0, -3.0, 1.0)]), []);
    assert_eq!(apart(vec![sheet(0.0, 0.0, 3.0), sheet(0.0, -6.0, 3.0), sheet(0.0, -3.0, 3.0)]), []);
    let far = [sheet(0.0, 0.0, 3.0), sheet(9.0, 0.0, 3.0), sheet(9.0, -3.0, 3.0)];
    assert_eq!(apart(far.to_vec()), [ParametricError::Apart { surface: 2 }]);
}

#[test]
fn curves_join_and_tell_their_gaps() {
    let line = |from: [f64; 3], to: [f64; 3]| {
        Arc::new(SpaceCurve::of_arcs(vec![CurveArc::segment(&Vec3::from(from), &Vec3::from(to))]))
    };
    let joined = |curves: Vec<Arc<SpaceCurve>>| {
        SpaceCurveDefinition::plain(CurveShape::Combined { curves }).define().expect("a curve")
    };
    let made = joined(vec![line([0., 0., 0.], [4., 0., 0.]), line([4., 0., 0.], [4., 3., 0.])]);
    assert!(made.warnings.is_empty() && made.geometry.arcs.len() == 2 && made.geometry.cross.len() == 3);
    let made = joined(vec![line([0., 0., 0.], [4., 0., 0.]), line([4.5, 0., 0.], [4., 3., 0.])]);
    assert_eq!(made.warnings, vec![ParametricError::Gap { curve: 2, gap: 0.5 }]);
    assert_eq!(made.warnings[0].number(), Some(5129));
    let mut definition =
        SpaceCurveDefinition::plain(CurveShape::Combined { curves: vec![line([0., 0., 0.], [1., 0., 0.])] });
    definition.matrix = Some(Matrix::scaling(0.0));
    assert_eq!(definition.define(), Err(ParametricError::SingularMatrix));
    definition.matrix = Some(Matrix::translation(Vec3::z()));
    let moved = definition.define().expect("a copy").geometry;
    assert_eq!(moved.evaluate_global(1.0).expect("inside").position, Vec3::new(1.0, 0.0, 1.0));
    // The same point twice is a curve without extent.
    let null = CurveShape::Spline { weight: None, limit: None, nodes: nodes(&[[1., 2., 3.], [1., 2., 3.]]) };
    let null = SpaceCurveDefinition::plain(null).define().expect("a null curve").geometry;
    assert_eq!(null.evaluate_global(0.5).expect("inside").position, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn canonical_rows_come_back_unchanged() {
    let shape = CurveShape::Spline {
        weight: None,
        limit: None,
        nodes: nodes(&[[0., 0., 0.], [3., 2., 0.], [7., 2., 1.]]),
    };
    let mut definition = SpaceCurveDefinition::plain(shape);
    definition.flow = vec![FlowInput { measure: FlowMeasure::Chord(Vec3::x()), first: 0.0, last: 2.0 }];
    definition.segments = vec![SegmentInput { measure: SegmentMeasure::Length, first: 0.0, last: 1.5 }];
    let curve = Arc::new(definition.define().expect("a curve").geometry);
    let lofted =
        loft(vec![curve.clone(), Arc::new(curve.transformed(&Matrix::translation(Vec3::z())))], vec![]);
    // An arc of two parts after a plain one.
    let around = [[5., 0., 0.], [0., 5., 0.], [0., -5., 0.]];
    let wide = SpaceCurveDefinition::plain(CurveShape::Conic { nodes: nodes(&around) });
    let line = CurveShape::Conic { nodes: nodes(&[[9., 0., 0.], [5., 0., 0.]]) };
    let curves = [SpaceCurveDefinition::plain(line), wide]
        .map(|definition| Arc::new(definition.define().expect("a curve").geometry));
    let joined = SpaceCurveDefinition::plain(CurveShape::Combined { curves: curves.to_vec() });
    let joined = joined.define().expect("a curve").geometry;
    assert_eq!((joined.arcs.len(), joined.count()), (3, 2));
    for geometry in [
        Geometry::SpaceCurve(curve),
        Geometry::SpaceCurve(Arc::new(joined)),
        Geometry::Sculptured(Remembering::new(lofted.expect("a surface"))),
    ] {
        let values = geometry.canonical_values();
        assert_eq!(Geometry::from_canonical(geometry.kind(), &values), Ok(geometry.clone()));
        assert!(Geometry::from_canonical(geometry.kind(), &values[1..]).is_err());
        assert!(Geometry::from_canonical(geometry.kind(), &[]).is_err());
    }
}

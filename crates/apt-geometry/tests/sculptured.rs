//! Space curves and sculptured surfaces against numbers of the public system and closed forms.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Remembering, matrix::CoordinatePlane},
    definition::{
        AxisInput, CurveParameter, CurveProduct, CurveShape, FlowInput, FlowMeasure, LineOrCircle,
        MeshRestriction, ParametricCount, ParametricDirection, ParametricError, ParametricNode,
        ParametricPlace, ParametricQuery, PatchForm, SculpturedDefinition, SegmentInput, SegmentSide,
        SpaceCurveDefinition, SurfaceShape, Turning,
    },
    parametric::{SculpturedSurface, SegmentMeasure, SpaceCurve},
};

fn v(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

fn nodes(points: &[[f64; 3]]) -> Vec<ParametricNode> {
    points.iter().map(|point| ParametricNode::plain(Vec3::from(*point))).collect()
}

fn tangent(node: &mut ParametricNode, x: f64, y: f64, z: f64) {
    node.tangent = Some(v(x, y, z));
}

fn curve(shape: CurveShape) -> SpaceCurve {
    SpaceCurveDefinition::plain(shape).define().expect("a curve").geometry
}

fn spline(points: &[[f64; 3]]) -> SpaceCurve {
    curve(CurveShape::Spline { weight: None, limit: None, nodes: nodes(points) })
}

fn conic(nodes: Vec<ParametricNode>) -> SpaceCurve {
    curve(CurveShape::Conic { nodes })
}

fn surface(shape: SurfaceShape) -> SculpturedSurface {
    SculpturedDefinition::plain(shape).define().expect("a surface").geometry
}

#[track_caller]
fn near(found: Vec3, expected: [f64; 3], tolerance: f64) {
    let expected = Vec3::from(expected);
    assert!((found - expected).norm() <= tolerance, "{found:?} is not {expected:?}");
}

fn at(curve: &SpaceCurve, parameter: f64) -> Vec3 {
    curve.evaluate_global(parameter).expect("on the curve").position
}

fn on(surface: &SculpturedSurface, u: f64, v: f64) -> Vec3 {
    surface.evaluate_global(u, v).expect("on the surface").position
}

fn normal(surface: &SculpturedSurface, u: f64, v: f64) -> Vec3 {
    surface.normal_global(u, v).expect("on the surface").direction
}

/// Digits of symbols in listings.
const SYMBOL: f64 = 1e-6;
/// Digits of samples of curves.
const SAMPLE: f64 = 1e-4;

#[test]
fn free_splines_have_the_shape_of_the_public_system() {
    let four = spline(&[[0., 0., 0.], [2., 1., 0.], [5., 1., 1.], [8., 0., 0.]]);
    near(at(&four, 0.5), [0.976835, 0.594563, -0.09084], SYMBOL);
    near(at(&four, 1.5), [3.488631, 1.180947, 0.544338], SYMBOL);
    near(at(&four, 2.5), [6.554019, 0.596239, 0.775408], SYMBOL);
    let frame = four.evaluate_global(1.5).expect("inside").frame();
    near(frame.tangent, [0.921849, -0.017345, 0.387161], SYMBOL);
    near(frame.binormal, [0.379527, 0.242613, -0.892803], SYMBOL);
    let three = spline(&[[2., 0., 0.], [3., 0., 1.], [4., 0., 0.]]);
    near(at(&three, 0.5), [2.460526, 0.0, 0.697368], SYMBOL);
    let flat = spline(&[[1., 1., 4.], [3., 2.5, 4.], [5., 2., 4.]]);
    near(flat.evaluate_global(0.0).expect("inside").frame().tangent, [0.5344, 0.8453, 0.0], SAMPLE);
    near(flat.evaluate_global(2.0).expect("inside").frame().tangent, [0.8693, -0.4943, 0.0], SAMPLE);
}

#[test]
fn given_tangents_are_kept_and_normals_crossed() {
    let mut data = nodes(&[[0., 0., 0.], [2., 1., 0.], [5., 1., 1.], [8., 0., 0.]]);
    tangent(&mut data[0], 0., 1., 0.);
    tangent(&mut data[3], 1., -1., 0.);
    let made = curve(CurveShape::Spline { weight: None, limit: None, nodes: data });
    near(at(&made, 0.25), [0.1735, 0.3331, -0.0238], SAMPLE);
    near(at(&made, 1.5), [3.5501, 1.0698, 0.5806], SAMPLE);
    near(at(&made, 2.75), [7.4104, 0.4289, 0.1508], SAMPLE);
    let mut bent = nodes(&[[0., 0., 0.], [2., 2., 0.], [4., 1., 0.]]);
    bent[1].normal = Some(v(0.0, -1.0, 0.0));
    let made = curve(CurveShape::Spline { weight: None, limit: None, nodes: bent });
    near(made.evaluate_global(1.0).expect("inside").frame().tangent, [1.0, 0.0, 0.0], 1e-12);
}

#[test]
fn splines_run_along_their_tangents_however_these_point() {
    // Across the chord, back from it, and back at both ends: the bending alone would make the derivative vanish or turn
    // it about.
    for (first, last) in [([0., 1., 0.], None), ([-1., 2., 1.], None), ([-3., 1., 0.5], Some([-1., -1., 2.]))]
    {
        let mut data = nodes(&[[0., 0., 0.], [4., 0., 0.], [8., 1., 0.]]);
        data[0].tangent = Some(Vec3::from(first));
        data[2].tangent = last.map(Vec3::from);
        let made = curve(CurveShape::Spline { weight: None, limit: None, nodes: data });
        near(
            made.evaluate_global(0.0).expect("inside").frame().tangent,
            Vec3::from(first).normalize().into(),
            1e-12,
        );
        if let Some(last) = last {
            let found = made.evaluate_global(2.0).expect("inside").frame().tangent;
            near(found, Vec3::from(last).normalize().into(), 1e-12);
        }
    }
    // Where a free direction points back from one of its chords, both arcs still have it: there is no cusp.
    let sharp = spline(&[[0., 0., 0.], [1., 0., 0.], [-9., 1., 0.], [-10., 5., 1.]]);
    let ways = |arc: usize, t: f64| sharp.arcs[arc].evaluate(t).first.normalize();
    near(ways(0, 1.0), ways(1, 0.0).into(), 1e-12);
}

#[test]
fn a_tangent_at_the_end_tells_the_sense_of_a_circle() {
    // From (3,0) to (0,3): the quarter that arrives along −x, and the three quarters that arrive along +x.
    for (way, middle) in [(-1.0, [1.0, 1.0]), (1.0, [-1.0, -1.0])] {
        let mut data = nodes(&[[3., 0., 0.], [0., 3., 0.]]);
        tangent(&mut data[1], way, 0., 0.);
        let made = conic(data);
        let end = made.arcs.len() as f64;
        near(made.evaluate_global(end).expect("inside").frame().tangent, [way, 0.0, 0.0], 1e-12);
        let half = 3.0 / 2f64.sqrt();
        near(at(&made, 0.5 * end), [middle[0] * half, middle[1] * half, 0.0], 1e-9);
    }
}

#[test]
fn fairing_moves_points_by_their_limit_at_most() {
    let data = nodes(&[[0., 0., 0.], [1., 0.3, 0.], [2., -0.2, 0.], [3., 0.4, 0.], [4., 0., 0.]]);
    let made = curve(CurveShape::Spline { weight: Some(0.01), limit: Some(0.05), nodes: data });
    let expected = [
        (0.0, [0.0169, 0.0470, 0.0]),
        (0.5, [0.5148, 0.2337, 0.0]),
        (1.0, [0.9928, 0.2505, 0.0]),
        (1.5, [1.5224, 0.0110, 0.0]),
        (2.25, [2.2381, -0.0770, 0.0]),
        (3.75, [3.7483, 0.1957, 0.0]),
        (4.0, [3.9991, 0.0500, 0.0]),
    ];
    for (parameter, place) in expected {
        near(at(&made, parameter), place, SAMPLE);
    }
}

#[test]
fn conic_arcs_are_exact_and_paced_like_the_public_system() {
    let circle = conic(nodes(&[[5., 0., 1.], [3., 4., 1.], [-4., 3., 1.]]));
    near(at(&circle, 0.25), [4.2435, 2.6443, 1.0], SAMPLE);
    near(at(&circle, 0.5), [1.581139, 4.743416, 1.0], SYMBOL);
    for step in 0..=20 {
        let place = at(&circle, f64::from(step) / 20.0) - v(0.0, 0.0, 1.0);
        assert!((place.norm() - 5.0).abs() < 1e-12);
    }
    let mut quarter = nodes(&[[4., 0., 0.], [0., 2., 0.]]);
    tangent(&mut quarter[0], 0., 1., 0.);
    tangent(&mut quarter[1], -1., 0., 0.);
    let ellipse = conic(quarter);
    near(at(&ellipse, 0.25), [3.5294, 0.9412, 0.0], SAMPLE);
    near(at(&ellipse, 0.75), [1.12, 1.92, 0.0], SAMPLE);
    let parabola =
        conic(nodes(&[[-2., 1., 0.], [-1., 0.25, 0.], [0., 0., 0.], [1., 0.25, 0.], [2., 1., 0.]]));
    near(at(&parabola, 0.25), [-1.0, 0.25, 0.0], 1e-9);
    let mut bound = nodes(&[[3., 0., 0.], [0., 3., 0.]]);
    bound[0].normal = Some(v(-1.0, 0.0, 0.0));
    near(at(&conic(bound), 0.25), [2.7894, 1.1043, 0.0], SAMPLE);
    let line = conic(nodes(&[[1., 2., 3.], [5., 4., -1.]]));
    near(line.evaluate_global(0.25).expect("inside").first, [4.0, 2.0, -4.0], 1e-12);
}

#[test]
fn long_conic_arcs_take_two_pieces_and_bad_data_are_told() {
    // Half a circle is one arc, three quarters are two.
    let half = conic(nodes(&[[4., 0., 0.], [5., 0., 1.], [6., 0., 0.]]));
    assert_eq!(half.arcs.len(), 1);
    near(at(&half, 0.25), [4.2, 0.0, 0.6], 1e-12);
    let wide = conic(nodes(&[[5., 0., 0.], [-5., 0., 0.], [-3., -4., 0.]]));
    assert_eq!(wide.arcs.len(), 1);
    for step in 0..=40 {
        assert!((at(&wide, f64::from(step) / 40.0).norm() - 5.0).abs() < 1e-12);
    }
    let turn = std::f64::consts::FRAC_PI_4;
    let middle = [5.0 * (3.0 * turn).cos(), 5.0 * (3.0 * turn).sin(), 0.0];
    let made = conic(nodes(&[[5., 0., 0.], middle, [0., -5., 0.]]));
    assert_eq!(made.arcs.len(), 2);
    for step in 0..=40 {
        assert!((at(&made, f64::from(step) / 20.0).norm() - 5.0).abs() < 1e-12);
    }
    near(at(&made, 1.0), middle, 1e-12);
    let refused = |data: Vec<ParametricNode>| {
        SpaceCurveDefinition::plain(CurveShape::Conic { nodes: data }).define().expect_err("no conic")
    };
    assert_eq!(refused(nodes(&[[0., 0., 0.], [1., 0., 0.], [2., 0., 0.]])), ParametricError::Collinear);
    let off = [[0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [3., 5., 0.2]];
    assert!(matches!(refused(nodes(&off)), ParametricError::NotPlanar { .. }));
    let six = [[0., 0., 0.], [1., 0., 0.], [2., 1., 0.], [3., 5., 0.], [4., 9., 0.], [5., 20., 0.]];
    let expected = ParametricError::TooManyConditions { greatest: 5, found: 6 };
    assert_eq!(refused(nodes(&six)), expected);
    let disordered = [[5., 0., 0.], [-4., 3., 0.], [3., 4., 0.], [0., 5., 0.]];
    assert_eq!(refused(nodes(&disordered)), ParametricError::NoConicArc);
}

#[test]
fn pieces_of_lines_and_circles() {
    use apt_geometry::canonical::{Cylinder, Plane};
    let line = |x: f64, y: f64, distance: f64| LineOrCircle::Line(Plane { normal: v(x, y, 0.0), distance });
    let bounded = |base, from, to| {
        let z_surface = Plane { normal: Vec3::z(), distance: 1.0 };
        let east = SegmentSide::PositiveX;
        curve(CurveShape::Bounded { base, from: (from, east), to: (to, east), z_surface })
    };
    let flat = bounded(line(0., 1., 0.), line(1., 0., 0.), line(1., 0., 6.));
    near(at(&flat, 0.5), [3.0, 0.0, 1.0], SYMBOL);
    let circle = LineOrCircle::Circle(Cylinder::circle(0.0, 0.0, 5.0));
    let round = bounded(circle, line(0., 1., 0.), line(0., 1., 3.));
    near(at(&round, 0.25), [4.9363, 0.7957, 1.0], SAMPLE);
    near(at(&round, 1.0), [4.0, 3.0, 1.0], 1e-12);
}

fn flowing(points: &[[f64; 3]], measure: FlowMeasure, segments: &[(SegmentMeasure, f64, f64)]) -> SpaceCurve {
    let mut definition =
        SpaceCurveDefinition::plain(CurveShape::Spline { weight: None, limit: None, nodes: nodes(points) });
    definition.flow = vec![FlowInput { measure, first: 0.0, last: points.len() as f64 - 1.0 }];
    definition.segments =
        segments.iter().map(|&(measure, first, last)| SegmentInput { measure, first, last }).collect();
    definition.define().expect("a flowing curve").geometry
}

const ARCH: [[f64; 3]; 4] = [[0., 0., 0.], [3., 2., 0.], [7., 2., 0.], [9., 0., 0.]];

#[test]
fn flow_measures_length_chord_and_parameter() {
    let flow_at = |curve: &SpaceCurve, segment: usize, local: f64| {
        let flow = curve.flow.as_ref().expect("a flow");
        at(curve, flow.arc_parameter(curve, segment, local).expect("a segment"))
    };
    let length = (SegmentMeasure::Length, 0.0, 3.0);
    let chord = flowing(&ARCH, FlowMeasure::Chord(Vec3::x()), &[length]);
    for (local, x) in [(0.0, 0.0), (0.25, 2.25), (0.5, 4.5), (0.75, 6.75), (1.0, 9.0)] {
        assert!((flow_at(&chord, 0, local).x - x).abs() < 1e-12);
    }
    let two = [(SegmentMeasure::Param, 0.0, 1.0), (SegmentMeasure::Param, 1.0, 3.0)];
    let param = flowing(&ARCH, FlowMeasure::Param, &two);
    near(flow_at(&param, 1, 0.5), [7.0, 2.0, 0.0], 1e-12);
    near(flow_at(&param, 1, 0.25), [5.074807, 2.398933, 0.0], SYMBOL);
    let arcs = [(SegmentMeasure::Length, 0.0, 1.0), (SegmentMeasure::Length, 1.0, 3.0)];
    let arc = flowing(&ARCH, FlowMeasure::Arc(None), &arcs);
    let flow = arc.flow.as_ref().expect("a flow");
    // The public system's lengths carry its flow tolerance.
    for (index, listed) in [3.6406, 4.1167, 2.8655].into_iter().enumerate() {
        assert!((flow.amount(&arc, index as f64, index as f64 + 1.0) / listed - 1.0).abs() < 0.005);
    }
    let middle = flow.arc_parameter(&arc, 1, 0.5).expect("a segment");
    let (before, after) = (flow.amount(&arc, 1.0, middle), flow.amount(&arc, middle, 3.0));
    assert!((before - after).abs() < 1e-9);
    assert!((flow.flow_parameter(&arc, middle).expect("inside") - 1.5).abs() < 1e-9);
    near(flow_at(&arc, 1, 0.5), [6.418239, 2.22864, 0.0], 0.005 * 7.0);
}

#[test]
fn flow_moves_with_its_curve() {
    use apt_geometry::canonical::Matrix;
    let matrix = Matrix::translation(v(3.0, -7.0, 2.0))
        .multiply(&Matrix::rotation(CoordinatePlane::Xy, 70.0))
        .multiply(&Matrix::rotation(CoordinatePlane::Yz, -25.0))
        .multiply(&Matrix::scaling(2.5));
    let whole = [(SegmentMeasure::Length, 0.0, 3.0)];
    let about = FlowMeasure::Angle(v(4.5, -3.0, 0.0), None);
    for measure in [FlowMeasure::Chord(Vec3::x()), FlowMeasure::Arc(None), FlowMeasure::Param, about] {
        let curve = flowing(&ARCH, measure, &whole);
        let moved = curve.transformed(&matrix);
        for local in [0.2, 0.5, 0.9] {
            let place = |curve: &SpaceCurve| {
                let flow = curve.flow.as_ref().expect("a flow");
                at(curve, flow.arc_parameter(curve, 0, local).expect("a segment"))
            };
            near(place(&moved), matrix.apply_point(&place(&curve)).into(), 1e-9);
        }
        let bent = at(
            &curve,
            curve.flow.as_ref().and_then(|flow| flow.arc_parameter(&curve, 0, 0.5)).expect("inside"),
        );
        if let FlowMeasure::Angle(center, _) = measure {
            let angle = |place: Vec3| (place.y - center.y).atan2(place.x - center.x);
            let middle = 0.5 * (angle(Vec3::from(ARCH[0])) + angle(Vec3::from(ARCH[3])));
            assert!((angle(bent) - middle).abs() < 1e-12);
        }
    }
}

#[test]
fn faults_of_flow_are_told() {
    let spline = CurveShape::Spline { weight: None, limit: None, nodes: nodes(&ARCH) };
    let mut definition = SpaceCurveDefinition::plain(spline);
    definition.flow = vec![FlowInput { measure: FlowMeasure::Param, first: 0.0, last: 3.0 }];
    let fault = definition.define().expect_err("no segments");
    assert_eq!((fault.clone(), fault.number()), (ParametricError::FlowWithoutSegments, Some(5515)));
    definition.segments = vec![SegmentInput { measure: SegmentMeasure::Param, first: 0.0, last: 4.0 }];
    assert!(matches!(definition.define(), Err(ParametricError::OutOfRange { .. })));
    definition.segments[0].last = 3.0;
    definition.flow[0].measure = FlowMeasure::Chord(Vec3::y());
    assert_eq!(definition.define(), Err(ParametricError::FlowNotMonotone { number: 1 }));
    definition.flow.clear();
    assert_eq!(definition.define(), Err(ParametricError::SegmentsWithoutFlow));
}

const ROWS: [[[f64; 3]; 4]; 3] = [
    [[0., 0., 0.], [2., 0., 1.], [4., 0., 1.2], [6., 0., 0.5]],
    [[0., 2., 0.4], [2., 2., 1.5], [4., 2., 1.8], [6., 2., 0.9]],
    [[0., 4., 0.2], [2., 4., 1.1], [4., 4., 1.4], [6., 4., 0.7]],
];

fn mesh(restriction: MeshRestriction) -> SculpturedSurface {
    let rows = ROWS.iter().map(|row| nodes(row)).collect();
    surface(SurfaceShape::Mesh { restriction, rows })
}

#[test]
fn free_meshes_have_the_shape_of_the_public_system() {
    let made = mesh(MeshRestriction::Free);
    assert_eq!((made.count(), made.mesh.splines, made.mesh.cross_splines), (6, 3, 4));
    near(on(&made, 2.229655, 1.490239), [4.488032, 2.999342, 1.626044], 3.0 * SYMBOL);
    near(normal(&made, 0.0, 0.0), [-0.57775, -0.27277, 0.76929], 1e-5);
    near(normal(&made, 1.0, 1.0), [-0.33511, -0.02128, 0.94194], 1e-5);
    near(normal(&made, 3.0, 2.0), [0.5197, 0.20377, 0.82969], 1e-5);
    let inner = made.neighbours[0][1].expect("a patch beyond");
    assert_eq!((inner.patch, inner.smooth, inner.reversed), (1, true, false));
    assert!(made.neighbours[0][0].is_none());
    let two = [
        nodes(&[[0., 0., 0.], [2., 0., 1.], [4., 0., 0.]]),
        nodes(&[[0., 3., 1.], [2., 4., 2.], [4., 3., 1.]]),
    ];
    let mut rows = two.to_vec();
    tangent(&mut rows[0][0], 1., 0., 1.);
    rows[0][0].cross = Some(v(0.0, 1.0, 0.5));
    let made = surface(SurfaceShape::Mesh { restriction: MeshRestriction::Free, rows });
    near(on(&made, 0.25, 0.25), [0.428961, 0.794024, 0.698854], SYMBOL);
    near(on(&made, 0.75, 0.3), [1.432622, 1.161784, 1.232114], SYMBOL);
    near(normal(&made, 0.5, 0.5), [-0.355942, -0.232907, 0.905019], SYMBOL);
}

#[test]
fn meshes_keep_given_normals_and_heights_over_planes() {
    let mut rows: Vec<_> = ROWS.iter().map(|row| nodes(row)).collect();
    rows[1][1].normal = Some(Vec3::z());
    let made = surface(SurfaceShape::Mesh { restriction: MeshRestriction::Free, rows });
    near(normal(&made, 1.0, 1.0), [0.0, 0.0, 1.0], 1e-9);
    near(normal(&made, 2.0, 1.0), [0.02914, -0.04407, 0.9986], 1e-5);
    let made = mesh(MeshRestriction::Height(CoordinatePlane::Xy));
    near(on(&made, 1.5, 1.0), [3.0, 2.0, 1.763154], SYMBOL);
    near(on(&made, 2.25, 1.75), [4.5, 3.5, 1.486069], SYMBOL);
    near(normal(&made, 0.5, 0.5), [-0.492261, -0.193462, 0.848676], SYMBOL);
    let rows = vec![
        nodes(&[[0., 0., 0.], [2., 1., 0.], [4., 0.5, 0.]]),
        nodes(&[[0., 0.2, 3.], [2., 1.5, 3.], [4., 0.1, 3.]]),
    ];
    let height = MeshRestriction::Height(CoordinatePlane::Zx);
    let made = surface(SurfaceShape::Mesh { restriction: height, rows });
    near(on(&made, 1.25, 0.25), [2.5, 1.084032, 0.75], SYMBOL);
    near(normal(&made, 0.5, 0.5), [0.551319, -0.826429, 0.114296], SYMBOL);
    let bent = vec![
        nodes(&[[0., 0., 0.], [1., 0., 0.2], [2., 0., 0.]]),
        nodes(&[[0., 2., 0.1], [1., 2., 0.4], [2., 2., 0.1]]),
    ];
    let fault = SculpturedDefinition::plain(SurfaceShape::Mesh { restriction: height, rows: bent }).define();
    assert_eq!(fault.expect_err("not straight").number(), Some(5300));
}

#[test]
fn lofts_through_segments() {
    let rows = [
        [[0., 0., 0.], [3., 0., 1.], [6., 0., 0.]],
        [[0., 4., 1.], [3., 5., 3.], [6., 4., 1.]],
        [[0., 8., 0.], [3., 8., 1.], [6., 8., 0.]],
    ];
    let param = |first, last| (SegmentMeasure::Param, first, last);
    let whole = |points: &[[f64; 3]]| Arc::new(flowing(points, FlowMeasure::Param, &[param(0.0, 2.0)]));
    let made =
        surface(SurfaceShape::Curves { curves: vec![whole(&rows[0]), whole(&rows[1])], cross: vec![] });
    assert_eq!((made.count(), made.patches.len(), made.mesh.cross_splines), (1, 2, 2));
    near(on(&made, 0.5, 0.3), [3.0, 1.5, 1.6], SYMBOL);
    near(normal(&made, 0.0, 1.0), [-0.7494, -0.16059, 0.64235], 1e-5);
    let halves = |points: &[[f64; 3]]| {
        Arc::new(flowing(points, FlowMeasure::Param, &[param(0.0, 1.0), param(1.0, 2.0)]))
    };
    let curves = rows.iter().map(|row| halves(row)).collect();
    let made = surface(SurfaceShape::Curves { curves, cross: vec![] });
    assert_eq!(made.count(), 4);
    near(on(&made, 0.5, 0.5), [1.421267, 2.278422, 2.000363], SYMBOL);
    near(on(&made, 1.5, 1.5), [4.578733, 6.422434, 1.813976], SYMBOL);
    near(normal(&made, 0.5, 0.5), [-0.540448, -0.31045, 0.782008], 2.0 * SYMBOL);
    near(normal(&made, 1.5, 1.5), [0.495706, 0.438844, 0.749461], 2.0 * SYMBOL);
    near(normal(&made, 0.0, 0.0), [-0.51215, -0.38411, 0.76822], 1e-5);
    assert_eq!(made.numbered(1.5, 1.5), Some((4, [0.5, 0.5])));
    let bare = Arc::new(spline(&rows[0]));
    let fault =
        SculpturedDefinition::plain(SurfaceShape::Curves { curves: vec![bare.clone(), bare], cross: vec![] });
    assert_eq!(fault.define().expect_err("no flow").number(), Some(5029));
}

#[test]
fn surfaces_of_revolution_are_exact() {
    let line = Arc::new(conic(nodes(&[[0., 2., 0.], [6., 4., 0.]])));
    let revolved = |curve: &Arc<SpaceCurve>, axis: Vec3, turning, from, to| {
        surface(SurfaceShape::Revolved {
            curve: curve.clone(),
            axis: AxisInput::PointVector(Vec3::zeros(), axis),
            turning,
            angles: [from, to],
        })
    };
    let cone = revolved(&line, Vec3::x(), Turning::CounterClockwise, 0.0, 90.0);
    near(on(&cone, 0.25, 0.25), [1.5, 2.324471, 0.920237], SYMBOL);
    near(normal(&cone, 0.75, 0.3), [0.316228, -0.851325, -0.418623], SYMBOL);
    let arc = Arc::new(conic(nodes(&[[4., 0., 0.], [5., 0., 1.], [6., 0., 0.]])));
    let torus = revolved(&arc, Vec3::z(), Turning::CounterClockwise, 0.0, 90.0);
    assert_eq!(torus.count(), 1);
    near(on(&torus, 0.75, 0.3), [5.204779, 2.559351, 0.6], SYMBOL);
    near(normal(&torus, 0.25, 0.25), [-0.743831, -0.294476, 0.6], SYMBOL);
    let back = revolved(&arc, Vec3::z(), Turning::Clockwise, 0.0, 90.0);
    assert_eq!((back.count(), back.mesh.splines, back.mesh.cross_splines), (3, 4, 2));
    near(on(&back, 0.25, 0.25), [3.905111, -1.545998, 0.6], SYMBOL);
    near(normal(&back, 0.75, 0.3), [-0.717901, 0.353014, -0.6], SYMBOL);
    let full = revolved(&arc, Vec3::z(), Turning::CounterClockwise, 0.0, 360.0);
    assert_eq!(full.count(), 3);
    assert!(full.neighbours[2][3].is_some_and(|beyond| beyond.patch == 0), "it closes");
    let through = revolved(&arc, Vec3::z(), Turning::CounterClockwise, 270.0, 90.0);
    near(on(&through, 0.0, 0.0), [0.0, -4.0, 0.0], 1e-12);
    near(on(&through, 0.0, 1.0), [4.0, 0.0, 0.0], 1e-12);
    for made in [&torus, &back, &full] {
        let [u, v] = made.extent();
        for i in 0..=10 {
            for j in 0..=10 {
                let place = on(made, u * f64::from(i) / 10.0, v * f64::from(j) / 10.0);
                let off = (place.x.hypot(place.y) - 5.0).hypot(place.z) - 1.0;
                assert!(off.abs() < 1e-12, "{off}");
            }
        }
    }
}

#[test]
fn products_rulings_and_patches() {
    let along = Arc::new(spline(&[[2., 0., 0.], [3., 0., 1.], [4., 0., 0.]]));
    let across = Arc::new(spline(&[[2., 0., 0.], [2., 2., 1.], [2., 4., 0.]]));
    let product =
        |product| surface(SurfaceShape::Product { product, profile: along.clone(), control: across.clone() });
    let moved = product(CurveProduct::Translate);
    near(on(&moved, 0.5, 0.5), [4.460526, 0.946429, 1.411654], SYMBOL);
    near(normal(&moved, 0.5, 0.5), [-0.689886, -0.337162, 0.640608], SYMBOL);
    let turned = product(CurveProduct::Turn(CoordinatePlane::Xy));
    near(on(&turned, 0.5, 0.5), [4.921053, 2.328712, 1.411654], SYMBOL);
    near(normal(&turned, 0.5, 0.5), [-0.393139, -0.192329, 0.899139], SYMBOL);
    let scaled = product(CurveProduct::Scale);
    let expected = at(&along, 0.7).component_mul(&at(&across, 1.2));
    near(on(&scaled, 0.7, 1.2), expected.into(), 1e-12);
    let bent = Arc::new(spline(&[[0., 0., 0.], [3., 1., 0.], [6., 0., 0.]]));
    let wall = surface(SurfaceShape::Ruled { curve: bent.clone(), axis: AxisInput::Vector(Vec3::z()) });
    near(on(&wall, 2.0, 1.0), [6.0, 0.0, 10.0], 1e-12);
    near(normal(&wall, 2.0, 0.0), [-0.5547, -0.83205, 0.0], 1e-5);
    let placed = AxisInput::PointVector(Vec3::zeros(), Vec3::z());
    let fault = SculpturedDefinition::plain(SurfaceShape::Ruled { curve: bent, axis: placed }).define();
    assert_eq!(fault.expect_err("a point and a vector").number(), Some(5007));
}

#[test]
fn patches_by_tangents_and_by_points_on_them() {
    let data = [
        [0., 0., 0.],
        [4., 0., 1.],
        [4., 0., 2.],
        [4., 0., -1.],
        [0., 3., 1.],
        [4., 3., 2.],
        [4., 0., 1.],
        [4., 0., -2.],
        [0., 3., 1.],
        [0., 3., 1.],
        [0., 0., 0.],
        [0., 0., 0.],
        [0., 3., 0.5],
        [0., 3., 1.5],
        [0., 0., 0.],
        [0., 0., 0.5],
    ]
    .map(Vec3::from);
    let made = surface(SurfaceShape::Patches { form: PatchForm::PointsVectors, patches: vec![(1.0, data)] });
    near(on(&made, 0.75, 0.3), [3.0, 0.9, 1.381148], SYMBOL);
    near(normal(&made, 0.25, 0.25), [-0.389845, -0.293636, 0.872811], SYMBOL);
    let points: [Vec3; 16] = std::array::from_fn(|index| {
        let (i, j) = ((index % 4) as f64, (index / 4) as f64);
        v(i * 2.0, j * 1.5, (0.8 * i).sin() + j * j * 0.1)
    });
    let made = surface(SurfaceShape::Patches { form: PatchForm::PointsOn, patches: vec![(-1.0, points)] });
    assert_eq!(made.side, -1.0);
    for (index, point) in points.iter().enumerate() {
        let (u, v) = ((index % 4) as f64 / 3.0, (index / 4) as f64 / 3.0);
        near(on(&made, u, v), (*point).into(), 1e-12);
    }
    let twice =
        SurfaceShape::Patches { form: PatchForm::PointsOn, patches: vec![(1.0, points), (1.0, points)] };
    let warnings = SculpturedDefinition::plain(twice).define().expect("two patches").warnings;
    assert_eq!(warnings, vec![ParametricError::LoosePatches { patches: 2 }]);
}

fn found(query: &ParametricQuery) -> (Vec3, usize, [f64; 2]) {
    match query.find().expect("a place") {
        ParametricPlace::Surface { position, patch, local, .. } => (position, patch, local),
        ParametricPlace::Curve { position, arc, local, .. } => (position, arc, [local, 0.0]),
    }
}

#[test]
fn places_by_lines_planes_and_points() {
    let made = Remembering::new(mesh(MeshRestriction::Free));
    let line = |point: Vec3| ParametricQuery::SurfaceLine {
        surface: made.clone(),
        point,
        direction: -Vec3::z(),
        near: point,
    };
    let (place, patch, local) = found(&line(v(4.5, 3.0, 6.0)));
    // The public system stops a few thousandths from the line.
    near(place, [4.5, 3.0, 1.626], 0.02);
    assert!((place.x - 4.5).abs() < 1e-11 && (place.y - 3.0).abs() < 1e-11);
    assert_eq!(patch, 6);
    assert!((local[0] - 0.229655).abs() < 0.01 && (local[1] - 0.490239).abs() < 0.01);
    let (place, ..) = found(&line(v(1.0, 1.0, 6.0)));
    near(place, [1.0, 1.0, 0.929505], 2e-4);
    let normal = line(v(1.0, 1.0, 6.0)).direction(ParametricDirection::Normal, false).expect("a normal");
    near(normal, [-2.206755, -0.904379, 4.099653], 2e-3);
    let missed = line(v(7.0, 1.0, 6.0)).find().expect_err("beside the surface");
    assert!(matches!(missed, ParametricError::NoPlace { miss } if miss.is_finite()));
    let nearest = ParametricQuery::SurfaceNearest { surface: made.clone(), point: v(3.0, 2.0, 6.0) };
    let (place, _, _) = found(&nearest);
    let normal = nearest.direction(ParametricDirection::Normal, true).expect("a normal");
    near((v(3.0, 2.0, 6.0) - place).normalize(), normal.into(), 1e-9);
    let curve = Arc::new(spline(&ROWS[0]));
    let plane = apt_geometry::canonical::Plane { normal: Vec3::x(), distance: 3.5 };
    let query = ParametricQuery::CurvePlane { curve, plane, near: v(4.0, 0.0, 1.2) };
    let (place, arc, local) = found(&query);
    near(place, [3.5, 0.0, 1.227021], SYMBOL);
    assert!(arc == 2 && (local[0] - 0.75074).abs() < SYMBOL);
}

#[test]
fn places_by_parameters_and_directions() {
    let points = [[0., 0., 0.], [2., 1., 0.], [5., 1., 1.], [8., 0., 0.]];
    let curve = Arc::new(spline(&points));
    let query = |value, number| ParametricQuery::CurveParameter {
        curve: curve.clone(),
        kind: CurveParameter::Param,
        value,
        number,
    };
    near(found(&query(0.5, -1.0)).0, [6.554019, 0.596239, 0.775408], SYMBOL);
    near(found(&query(1.5, 0.0)).0, [3.488631, 1.180947, 0.544338], SYMBOL);
    let direction = |kind| query(1.5, 0.0).direction(kind, true).expect("a direction");
    near(direction(ParametricDirection::Normal), [0.356128, -0.356128, -0.863913], SYMBOL);
    near(direction(ParametricDirection::Binormal), [0.379527, 0.242613, -0.892803], SYMBOL);
    let fault = query(0.5, 4.0).find();
    assert_eq!(fault, Err(ParametricError::NoSuchPart { number: 4.0, count: 3 }));
    assert!(matches!(query(3.5, 0.0).find(), Err(ParametricError::OutOfRange { .. })));
    let made = Remembering::new(mesh(MeshRestriction::Free));
    let place =
        |u, v, patch| found(&ParametricQuery::SurfaceParameters { surface: made.clone(), u, v, patch });
    assert_eq!(place(0.5, 0.25, 6.0), place(2.5, 1.25, 0.0));
    assert_eq!(place(0.5, 0.25, 6.0).0, place(0.5, 0.25, -1.0).0);
    let counted = [ParametricCount::Patches, ParametricCount::Splines, ParametricCount::CrossSplines];
    assert_eq!(counted.map(|count| count.of_surface(&made)), [Some(6), Some(3), Some(4)]);
    assert_eq!(ParametricCount::Arcs.of_curve(&curve), Some(3));
}

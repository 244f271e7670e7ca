//! GENCUR with CROSS: what lies between the curves follows the cross curves at its sides.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Remembering},
    definition::{
        CurveShape, FlowInput, FlowMeasure, ParametricError, ParametricNode, SculpturedDefinition,
        SegmentInput, SpaceCurveDefinition, SurfaceShape,
    },
    parametric::{SculpturedSurface, SegmentMeasure, SpaceCurve},
};

/// How far the patches may be from the exact surface: they are fitted to a share of 2e-8 of surfaces ten units large.
const CLOSE: f64 = 1e-6;

fn nodes(points: &[[f64; 3]]) -> Vec<ParametricNode> {
    points.iter().map(|point| ParametricNode::plain(Vec3::from(*point))).collect()
}

fn spline(nodes: Vec<ParametricNode>) -> SpaceCurveDefinition {
    SpaceCurveDefinition::plain(CurveShape::Spline { weight: None, limit: None, nodes })
}

fn made(definition: &SpaceCurveDefinition) -> Arc<SpaceCurve> {
    Arc::new(definition.define().expect("a curve").geometry)
}

/// The definition with one flow over all arcs, cut at the given parameters.
fn flowing(
    mut definition: SpaceCurveDefinition,
    measure: FlowMeasure,
    by: SegmentMeasure,
    cuts: &[f64],
) -> Arc<SpaceCurve> {
    let (first, last) = (cuts[0], cuts[cuts.len() - 1]);
    definition.flow = vec![FlowInput { measure, first, last }];
    definition.segments =
        cuts.windows(2).map(|pair| SegmentInput { measure: by, first: pair[0], last: pair[1] }).collect();
    made(&definition)
}

/// A line along x, 6 long, with one segment.
fn along(y: f64, z: f64) -> Arc<SpaceCurve> {
    let line = spline(nodes(&[[0., y, z], [6., y, z]]));
    flowing(line, FlowMeasure::Param, SegmentMeasure::Param, &[0.0, 1.0])
}

fn loft(
    curves: Vec<Arc<SpaceCurve>>,
    cross: Vec<Arc<SpaceCurve>>,
) -> Result<SculpturedSurface, ParametricError> {
    let shape = SurfaceShape::Curves { curves, cross };
    SculpturedDefinition::plain(shape).define().map(|defined| defined.geometry)
}

fn on(surface: &SculpturedSurface, u: f64, v: f64) -> Vec3 {
    surface.evaluate_global(u, v).expect("inside").position
}

fn at(curve: &SpaceCurve, parameter: f64) -> Vec3 {
    curve.evaluate_global(parameter).expect("inside").position
}

/// Asserts that the sides of a surface over one segment are the cross curves, whose parameter at v is told, and that its
/// curves are still on it.
#[track_caller]
fn has_sides(
    surface: &SculpturedSurface,
    [west, east]: [&SpaceCurve; 2],
    curves: &[Arc<SpaceCurve>],
    parameter: impl Fn(f64) -> f64,
) {
    let rows = (curves.len() - 1) as f64;
    for index in 0..=40 {
        let (t, v) = (f64::from(index) / 40.0, rows * f64::from(index) / 40.0);
        assert!((on(surface, 0.0, v) - at(west, parameter(v))).norm() < CLOSE, "west at {v}");
        assert!((on(surface, 1.0, v) - at(east, parameter(v))).norm() < CLOSE, "east at {v}");
        for (row, curve) in curves.iter().enumerate() {
            assert!((on(surface, t, row as f64) - at(curve, t)).norm() < CLOSE, "curve {row} at {t}");
        }
        // Derivatives by the global parameters are those of the places.
        if index > 0 && index < 40 {
            const STEP: f64 = 1e-5;
            let slope = (on(surface, 0.4, v + STEP) - on(surface, 0.4, v - STEP)) / (2.0 * STEP);
            let found = surface.evaluate_global(0.4, v).expect("inside").dv;
            // A joint of arcs turns within the step.
            let joint = surface.row_breaks.iter().any(|end| (end - v).abs() < 2.0 * STEP);
            assert!(joint || (found - slope).norm() < 1e-4 * (1.0 + slope.norm()), "slope at {v}");
        }
    }
    assert_eq!(surface.count(), curves.len() - 1);
    let geometry = Geometry::Sculptured(Remembering::new(surface.clone()));
    let values = geometry.canonical_values();
    let back = Geometry::from_canonical(geometry.kind(), &values);
    assert!(back == Ok(geometry.clone()), "{} numbers", values.len());
    for (patch, [u, v]) in (0..surface.patches.len()).map(|patch| (patch, [0.3, 0.7])) {
        let global = surface.globally(patch, u, v);
        let (found, u_back, v_back) = surface.locate(global[0], global[1]).expect("inside");
        assert!(found == patch && (u - u_back).abs() < 1e-9 && (v - v_back).abs() < 1e-9);
    }
}

#[test]
fn cross_curves_of_one_cubic_and_cross_directions_shape_the_sides() {
    let (low, high) = (along(0.0, 0.0), along(4.0, 1.0));
    let one = |x: f64, z: f64| {
        let mut data = nodes(&[[x, 0., 0.], [x, 4., 1.]]);
        data[0].tangent = Some(Vec3::new(0.0, 1.0, z));
        made(&spline(data))
    };
    let (west, east) = (one(0.0, 2.0), one(6.0, -1.0));
    let fault = loft(vec![low.clone(), high.clone()], vec![west.clone()]);
    assert!(matches!(fault, Err(ParametricError::SegmentCount { .. })));
    let curves = vec![low.clone(), high.clone()];
    let surface = loft(curves.clone(), vec![west.clone(), east.clone()]).expect("a patch");
    assert_eq!(surface.patches.len(), 1);
    has_sides(&surface, [&west, &east], &curves, |v| v);
    let apart = loft(vec![low, high], vec![one(0.5, 2.0), east]);
    assert!(matches!(apart, Err(ParametricError::CrossGap { curve: 1, .. })));
    let mut data = nodes(&[[0., 0., 0.], [6., 0., 0.]]);
    data[0].cross = Some(Vec3::z());
    let lifted = flowing(spline(data), FlowMeasure::Param, SegmentMeasure::Param, &[0.0, 1.0]);
    let surface = loft(vec![lifted, along(4.0, 1.0)], vec![]).expect("a patch");
    let way = surface.evaluate_global(0.0, 0.0).expect("inside").dv.normalize();
    assert!((way - Vec3::z()).norm() < 1e-9);
}

#[test]
fn cross_curves_of_several_arcs_make_rows_of_patches() {
    let curves = vec![along(0.0, 0.0), along(4.0, 1.0)];
    let side = |x: f64, z: f64| made(&spline(nodes(&[[x, 0., 0.], [x, 2., z], [x, 4., 1.]])));
    let (west, east) = (side(0.0, 2.0), side(6.0, -1.0));
    let surface = loft(curves.clone(), vec![west.clone(), east.clone()]).expect("a surface");
    // The arcs are cubics, so that two patches are exact.
    assert_eq!((surface.grid, surface.row_breaks.as_slice()), (Some((1, 2)), [0.0, 0.5, 1.0].as_slice()));
    has_sides(&surface, [&west, &east], &curves, |v| 2.0 * v);
}

#[test]
fn cross_curves_meet_curves_whose_segment_has_several_arcs() {
    let bent = |y: f64, z: f64| {
        let curve = spline(nodes(&[[0., y, 0.], [2., y, z], [6., y, 0.]]));
        flowing(curve, FlowMeasure::Param, SegmentMeasure::Param, &[0.0, 2.0])
    };
    let curves = [bent(0.0, 1.0), bent(4.0, -0.5)];
    let side = |x: f64, z: f64| made(&spline(nodes(&[[x, 0., 0.], [x, 2., z], [x, 4., 0.]])));
    let (west, east) = (side(0.0, 2.0), side(6.0, -1.0));
    let surface = loft(curves.to_vec(), vec![west.clone(), east.clone()]).expect("a surface");
    for index in 0..=20 {
        let t = f64::from(index) / 20.0;
        assert!((on(&surface, 0.0, t) - at(&west, 2.0 * t)).norm() < CLOSE, "west at {t}");
        assert!((on(&surface, 1.0, t) - at(&east, 2.0 * t)).norm() < CLOSE, "east at {t}");
        for (row, curve) in curves.iter().enumerate() {
            assert!((on(&surface, t, row as f64) - at(curve, 2.0 * t)).norm() < CLOSE, "curve {row} at {t}");
        }
    }
}

#[test]
fn cross_curves_may_be_conics_and_run_by_their_lengths() {
    let curves = vec![along(0.0, 0.0), along(4.0, 0.0)];
    let arc = |x: f64, z: f64| {
        made(&SpaceCurveDefinition::plain(CurveShape::Conic {
            nodes: nodes(&[[x, 0., 0.], [x, 1., z], [x, 4., 0.]]),
        }))
    };
    let (west, east) = (arc(0.0, 1.0), arc(6.0, -0.5));
    let surface = loft(curves.clone(), vec![west.clone(), east.clone()]).expect("a surface");
    has_sides(&surface, [&west, &east], &curves, |v| v);
    // By length: the half of the length is at the half of v.
    let even = |x: f64| {
        let data = spline(nodes(&[[x, 0., 0.], [x, 1., 1.], [x, 4., 0.]]));
        flowing(data, FlowMeasure::Arc(None), SegmentMeasure::Length, &[0.0, 2.0])
    };
    let (west, east) = (even(0.0), even(6.0));
    let surface = loft(curves, vec![west.clone(), east]).expect("a surface");
    let length = |from: f64, to: f64| {
        let step = (to - from) / 2000.0;
        let places: Vec<Vec3> = (0..=2000).map(|index| at(&west, from + step * f64::from(index))).collect();
        places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>()
    };
    let half = on(&surface, 0.0, 0.5);
    let before = (0..=4000).map(|index| f64::from(index) / 2000.0).find(|t| at(&west, *t).y >= half.y);
    let share = length(0.0, before.expect("on the curve")) / length(0.0, 2.0);
    assert!((share - 0.5).abs() < 1e-3, "{share}");
}

#[test]
fn cross_curves_meet_the_curves_at_their_joints() {
    // Three arcs for two rows: the second curve is met at the second joint, not half way.
    let curves = vec![along(0.0, 0.0), along(4.0, 1.0), along(8.0, 0.0)];
    let side = |x: f64, z: f64| made(&spline(nodes(&[[x, 0., 0.], [x, 2., z], [x, 4., 1.], [x, 8., 0.]])));
    let (west, east) = (side(0.0, 1.5), side(6.0, -1.0));
    let surface = loft(curves.clone(), vec![west.clone(), east.clone()]).expect("a surface");
    has_sides(&surface, [&west, &east], &curves, |v| if v <= 1.0 { 2.0 * v } else { 1.0 + v });
}

//! The tool inside hollow surfaces: great radii with fine tolerances, and other units.

use super::*;

/// Part program units in an inch, to change the unit by.
const INCH: f64 = 25.4;

/// Hollow surfaces that pass through the origin, open upwards there with a radius of curvature across x.
fn trough(which: usize, radius: f64) -> Geometry {
    let lean = 10f64.to_radians();
    match which {
        0 => sphere(0.0, 0.0, radius, radius),
        1 => cylinder(v(0.0, 0.0, radius), v(0.1, 1.0, 0.05), radius),
        2 => cone(v(0.0, -radius / lean.tan(), radius), Vec3::y(), 10.0),
        _ => quadric([1.0, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -radius]),
    }
}

/// A pass through a trough in the plane of x and z from −`reach` to `reach`.
fn pass(which: usize, [radius, reach, band]: [f64; 3], cutter: &[f64], scale: f64) -> Program {
    // Angles stay: the fifth and sixth number.
    let numbers: Vec<f64> =
        cutter.iter().enumerate().map(|(k, x)| if k == 4 || k == 5 { *x } else { x * scale }).collect();
    let [radius, reach, band] = [radius, reach, band].map(|x| x * scale);
    let part = trough(which, radius);
    let drive = plane(0.0, 1.0, 0.0, 0.0);
    let wall = |x: f64| plane(1.0, 0.0, 0.0, x);
    let mut p = Program::new();
    p.tolerance(0.0, band).cutter(&numbers);
    p.run(&MotionCommand::MaximumPoints(5000)).run(&MotionCommand::MaximumStep(1e4 * scale));
    p.from(-reach, 0.0, 0.55 * reach * reach / radius + scale);
    p.go(&[(Relation::On, &drive), (Relation::To, &part), (Relation::On, &wall(-reach))]);
    p.indirv(1.0, 0.0, 0.0);
    p.drive(Turn::Forward, &drive, Relation::On, &wall(reach));
    p
}

const CUTTERS: [[f64; 7]; 3] = [
    [0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 5.0],
    [0.5, 0.1, 0.15, 0.1, 0.0, 0.0, 5.0],
    [1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0],
];

#[test]
fn great_hollow_surfaces_are_followed_with_few_vectors() {
    for [radius, reach, band] in [[5000.0, 2000.0, 0.01], [1e5, 500.0, 1e-4]] {
        for which in 0..4 {
            for cutter in &CUTTERS {
                let p = pass(which, [radius, reach, band], cutter, 1.0);
                let evidence = crate::verify::verify(p.last(), &|| false).expect("evidence");
                assert!(evidence.verified, "surface {which}, radius {radius}, {cutter:?}: {evidence:?}");
                // Flatter than a circle everywhere; an ellipse of a slanted section is longer by less than this.
                let fewest = 2.0 * (reach / radius).asin() / (8.0 * band / radius).sqrt();
                let vectors = p.last().points.len() as f64;
                assert!(vectors <= (1.01 * fewest).ceil() + 2.0, "surface {which}: {vectors} of {fewest}");
            }
        }
    }
}

#[test]
fn another_unit_changes_nothing_but_the_scale_in_hollow_surfaces() {
    for which in 0..4 {
        for cutter in &CUTTERS {
            let sizes = [6.0, 1.5, 1e-3];
            let (inch, metric) = (pass(which, sizes, cutter, 1.0), pass(which, sizes, cutter, INCH));
            let (a, b) = (&inch.last().points, &metric.last().points);
            assert_eq!(a.len(), b.len(), "surface {which}, {cutter:?}");
            for (p, q) in a.iter().zip(b) {
                let off = (p.tip - q.tip / INCH).norm();
                assert!(off < 1e-7, "surface {which}, {cutter:?}: {off}");
            }
        }
    }
}

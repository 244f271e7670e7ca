//! Tools that come out of a surface over its end, where the sides end.

use std::f64::consts::FRAC_1_SQRT_2;

use super::{
    beyond_ends::poly_conic,
    refused::{AMPLE, Found},
    *,
};
/// A shell out of whose end a ball comes nearer than it is deep to one side.
fn notched() -> Geometry {
    let round = 3.8313491425923307;
    poly_conic(
        &[
            1.0,
            0.8083444898536412,
            0.07601789862373409,
            0.5837811788779153,
            3.030588200867794,
            -0.1039366944279275,
            -0.9576233198035297,
            0.26861634522095296,
            -2.5233408158053763,
            0.5794621206555718,
            -0.2778108285457899,
            -0.7661884848182263,
            8.887525920649262,
            0.0,
            0.0,
            6.000000000000002,
        ],
        [
            [round, -0.02102103323733104],
            [round, -0.022507190287668993],
            [round, 0.04921272982150751],
            [-round, -0.01670138130385584],
            [-round, -0.039338838103981734],
            [round, -0.009476608803161335],
            [FRAC_1_SQRT_2, 0.0098924549563323],
        ],
    )
}

const NOTCHING: [f64; 2] = [0.5394677967344361, 0.26973389836721806];

fn notching() -> Vec3 {
    v(0.19162958889756695, -0.9406139145387464, 0.28022056390465966)
}

/// The sides end with the surface, and what is deep to one of them comes out over the end sooner than that way.
#[test]
fn a_tool_comes_out_past_an_end_nearer_than_it_is_deep() {
    let motion = Found {
        cutter: &NOTCHING,
        axis: notching(),
        from: v(-1.2271173866194576, -0.3952325501330755, 1.59132149820218),
        band: [0.0, 0.001],
        thickness: 0.0,
        drive_side: DriveSide::Left,
        forward: v(-0.21913185131387095, -0.0016760745025818282, 0.9756938159658579),
        part: (
            Relation::To,
            Geometry::Circle(Cylinder {
                point: v(-0.40994312520042414, 4.778066563779829, 2.039170223189331),
                axis: Vec3::z(),
                radius: 4.692500799602418,
            }),
        ),
        drive: (
            Relation::To,
            Geometry::Cone(Cone {
                vertex: v(1.2976238475973005, -7.565302438440127, 4.420935307871121),
                axis: v(0.6290487640457928, 0.7765748669978909, -0.035058927531637876),
                cosine: 0.6385023462125614,
            }),
        ),
        first: (
            Relation::On,
            Geometry::Plane(Plane {
                normal: v(-0.21913185131387083, -0.0016760745025818124, 0.9756938159658579),
                distance: 2.0085826337285924,
            }),
        ),
        stop: (Relation::Past, notched()),
    };
    let sequences = motion.run(AMPLE).expect("a path");
    let end = sequences.last().and_then(|sequence| sequence.points.last()).expect("an end").tip;
    assert!((end.z - 6.5807).abs() < 2e-3, "{end:?}");
}

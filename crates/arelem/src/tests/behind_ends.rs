//! Tools that touch the end of a surface from its other side.

use super::{
    beyond_ends::poly_conic,
    refused::{AMPLE, Found},
    *,
};
use crate::error::RoleName;

/// The shank of a flat cutter goes along the end of its part surface, twelve degrees behind that, until its rim touches it there: deep in the
/// surface where the end is in it by anything, and clear of it where it is not, it has no position on its own side, and is told that the
/// surface ends.
#[test]
fn a_tool_that_touches_an_end_from_behind_comes_to_the_end_of_the_surface() {
    let motion = Found {
        cutter: &[0.6874959426402791],
        axis: v(0.0, 0.0, 1.0),
        from: v(-0.010917623245770891, -1.4099595787773644, -0.060509826366908465),
        band: [2e-5, 3e-5],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(0.986309711207955, 0.16314475547076046, 0.024019624045066655),
        part: (
            Relation::To,
            poly_conic(
                &[
                    1.0,
                    0.06074701123021701,
                    0.9377665629707602,
                    0.3419117927194133,
                    1.5845747401244463,
                    0.9491829024060814,
                    -0.16024766354935868,
                    0.2708735943331095,
                    -0.14353506111097958,
                    0.3088067654805545,
                    0.3080820665033566,
                    -0.899846554637211,
                    1.9718961874949823,
                    0.0,
                    0.0,
                    6.0,
                ],
                [
                    [1.7935670533617123, -0.0008369574946645447],
                    [1.7935670533617123, -0.07550771671126688],
                    [1.7935670533617123, 0.0884593832837957],
                    [-1.7935670533617123, 0.03964379213039275],
                    [-1.7935670533617123, 0.019341908649737102],
                    [1.7935670533617123, -0.06922575119284086],
                    [std::f64::consts::FRAC_1_SQRT_2, 0.01933200583152565],
                ],
            ),
        ),
        drive: (
            Relation::To,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.2705666116190472,
                    0.23063361927341086,
                    0.018772969780832108,
                    1.4665888265762734,
                    -0.174673141774656,
                    -0.10253668174139084,
                    0.1244181705732568,
                    0.658573197106176,
                    0.7101908787727873,
                    -0.19631065771687167,
                ],
            }),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(0.986309711207955, 0.16314475547076046, 0.024019624045066683),
                distance: -1.3125305741545585,
            }),
        ),
        stop: (
            Relation::On,
            Geometry::Cone(Cone {
                vertex: v(2.2047762226755676, -1.800830428402998, -1.1354292335555622),
                axis: v(-0.8817647467786209, 0.421755278702477, -0.21121888226441907),
                cosine: 0.5404455972633413,
            }),
        ),
    };
    let refused = motion.run(AMPLE);
    let Err(MotionFailure::SurfaceEnds { role: RoleName::Part, place, .. }) = refused else {
        panic!("{refused:?}")
    };
    assert!((place - v(-1.5555, 5.6991, 1.9464)).norm() < 1e-3, "{place:?}");
}

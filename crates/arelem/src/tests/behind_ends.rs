//! Tools that touch the end of a surface from its other side, on their way or at start-up.

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
    // It does not begin there with a start-up.
    let refused = motion.run(AMPLE);
    assert!(matches!(refused, Err(MotionFailure::BehindEnd { role: RoleName::Part, .. })), "{refused:?}");
    let from_there = Found { from: v(-2.0195223368791213, 6.000927902011693, 1.8307030572545202), ..motion };
    let refused = from_there.run_from_there(AMPLE);
    let Err(MotionFailure::SurfaceEnds { role: RoleName::Part, place, .. }) = refused else {
        panic!("{refused:?}")
    };
    assert!((place - v(-1.5555, 5.6991, 1.9464)).norm() < 1e-3, "{place:?}");
}

/// The flank of a flat cutter would touch the end of its part surface, nine degrees behind that, beside drive surface and stop: by the last digits of
/// its place it is in its bands there or .127 deep. It is no position.
#[test]
fn a_start_up_does_not_end_behind_the_end_of_a_surface() {
    let motion = Found {
        cutter: &[1.0103652086988513],
        axis: v(0.0, 0.0, 1.0),
        from: v(-0.08863105093977516, 1.3421682004206077, 0.1363776835232771),
        band: [0.001, 0.001],
        thickness: 0.0,
        drive_side: DriveSide::Right,
        forward: v(-0.8969961496240828, 0.4178688115740608, -0.14416505774025837),
        part: (
            Relation::To,
            poly_conic(
                &[
                    1.0,
                    -0.09723047415747818,
                    -0.9917316274657542,
                    -0.08375329234865021,
                    4.303222944945446,
                    0.9936890958516129,
                    -0.1014615510802386,
                    0.047828176193496295,
                    -1.5724834367229128,
                    -0.055930453964865665,
                    -0.07857437709914497,
                    0.9953380589441785,
                    6.209131380109185,
                    0.0,
                    0.0,
                    6.0,
                ],
                [
                    [4.068162234509305, 0.1992707747450141],
                    [4.068162234509305, -0.03811338651955015],
                    [4.068162234509305, 0.12385368080764458],
                    [-4.068162234509305, 0.10241076461177617],
                    [-4.068162234509305, 0.010087605384450915],
                    [4.068162234509305, 0.10254154210889133],
                    [std::f64::consts::FRAC_1_SQRT_2, -0.07412943047013025],
                ],
            ),
        ),
        drive: (
            Relation::To,
            poly_conic(
                &[
                    1.0,
                    -0.875507413894356,
                    0.4128852559499754,
                    0.25102297431737264,
                    4.689168853268331,
                    -0.34734240866441,
                    -0.17660938049261984,
                    -0.9209573159844159,
                    0.4275632027172491,
                    -0.3359166851456219,
                    -0.8934958825541035,
                    0.2980353812882637,
                    3.6871714156945004,
                    0.0,
                    0.0,
                    6.0,
                ],
                [
                    [2.972528781791158, 0.0009275566172942673],
                    [2.972528781791158, 0.01792680346681874],
                    [2.972528781791158, -0.09343703451866542],
                    [-2.972528781791158, -0.13858714773258712],
                    [-2.972528781791158, 0.13659284158483917],
                    [2.972528781791158, -0.18339057431688946],
                    [std::f64::consts::FRAC_1_SQRT_2, 0.047671740043607906],
                ],
            ),
        ),
        first: (
            Relation::To,
            Geometry::Plane(Plane {
                normal: v(-0.8969961496240829, 0.4178688115740608, -0.1441650577402584),
                distance: -1.380143335830057,
            }),
        ),
        stop: (
            Relation::Past,
            Geometry::Quadric(Quadric {
                coefficients: [
                    0.004979173768902296,
                    0.027630702444329743,
                    0.0,
                    -1.0856285883185002,
                    0.0,
                    0.0,
                    -0.06359027877468897,
                    -0.28215429307705275,
                    0.05235908366863293,
                    0.0,
                ],
            }),
        ),
    };
    let refused = motion.run(AMPLE);
    let Err(MotionFailure::BehindEnd { role: RoleName::Part, place, .. }) = refused else {
        panic!("{refused:?}")
    };
    assert!((place - v(2.9384, 5.5469, 0.1965)).norm() < 1e-3, "{place:?}");
}

/// A lens whose tip is under a surface beside the end of that, and the end in it beside its tip: it comes out past the end on the side where its
/// face leans away, by less than the tip is under the surface, from where the end is over the tip on.
#[test]
fn a_tip_beside_an_end_comes_out_past_it() {
    let part = poly_conic(
        &[
            1.0,
            -0.7997551575522218,
            0.5858991161064593,
            0.13082015790500556,
            2.564854465382458,
            -0.51193485423348,
            -0.7794273261449344,
            0.361131206460344,
            0.369944953755211,
            0.31355126054533144,
            0.22184514645181672,
            0.923293202621034,
            6.317280305257186,
            0.0,
            0.0,
            5.999999999999998,
        ],
        [
            [3.7480198487174663, -0.05862841481711932],
            [3.7480198487174663, 0.002931416624613963],
            [3.7480198487174663, 0.004291278808250156],
            [-3.7480198487174663, -0.05349293242252971],
            [-3.7480198487174663, 0.06391852004855922],
            [3.7480198487174663, -0.04537327422098356],
            [std::f64::consts::FRAC_1_SQRT_2, -0.017164378732116896],
        ],
    );
    let lens = [1.0, 0.1875, 0.33, 0.22, 9.185408478776981, 5.0, 4.976140436179929];
    let cutter = Cutter::from_numbers(&lens, 1.0).expect("a cutter");
    let tool = Tool::new(cutter, Vec3::z());
    let role = Role { side: -1.0, ..touched(&part) };
    let [from, to] = [
        v(-5.033357102365004, 1.607056216599384, -0.2623153094952222),
        v(-5.009825518770112, 1.669141425313496, -0.2707849395193834),
    ];
    for k in 0..=200 {
        let tip = from.lerp(&to, 0.13 + 2e-4 * f64::from(k));
        let engine = gauge(&role).contact(&tool, &tip).clearance;
        let verifier = read_by_verifier(&role, cutter, ToolPosition { tip, axis: Vec3::z() });
        assert!((engine - verifier).abs() < 2e-7, "{k}: {engine}, {verifier}");
    }
}

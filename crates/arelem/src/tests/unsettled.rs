//! Axes that do not settle: the normal at the contact moves with the axis that stands to it, and at some places back and forth.

use apt_geometry::{
    canonical::Remembering,
    motion::{AxisAngle, ToolAxis},
    parametric::{Mesh, Patch, SculpturedSurface},
};

use super::*;
use crate::{attitude::NORMALS, section2::StartUpRule};

/// A wavy patchwork of two by two patches: the cubic B-spline over a net of five by five points about the unit grid.
fn waves() -> Geometry {
    const NET: [[[f64; 3]; 5]; 5] = [
        [
            [0.010608715196, -0.046024853353, -0.082193125179],
            [0.919094268192, -0.057812750829, 0.09567680889],
            [2.004134386299, -0.012534298229, 0.072788174071],
            [3.078184629697, 0.017319323076, 0.20745895613],
            [4.071700670011, 0.010260887833, -0.042491490237],
        ],
        [
            [-0.077536303658, 0.977072885967, -0.096297590128],
            [0.895592205401, 0.955952528281, -0.089544920738],
            [1.933636168801, 1.027132457094, 0.093862279443],
            [3.020035824011, 1.022848800928, -0.058881816334],
            [4.004088174603, 1.030473814741, -0.047521018467],
        ],
        [
            [-0.092716225771, 1.971103757395, -0.062230028081],
            [1.004672294503, 1.999536253832, -0.235484472152],
            [1.953235982025, 1.975986958075, 0.089400754076],
            [2.972688252265, 2.053977632592, -0.045923676579],
            [3.963219882723, 1.949676905784, -0.068955889894],
        ],
        [
            [-0.045391461989, 2.970880117747, 0.259696567245],
            [1.044614485795, 2.981036658409, 0.093457414194],
            [1.947205256645, 2.947374857506, 0.065233240079],
            [2.959778717567, 2.959047716963, -0.054290858512],
            [4.044250261086, 2.960199493136, -0.05106638575],
        ],
        [
            [-0.017337146879, 3.979525559089, 0.082878558891],
            [0.898168959126, 3.987489894578, 0.13318957819],
            [2.012031059873, 4.038920838796, -0.061826513116],
            [2.991650328584, 3.953167438773, -0.001602237636],
            [3.862078954794, 3.972937204405, -0.030855980418],
        ],
    ];
    // Two cubic segments over the knots 0, 1 and 2, of which the ends count four times.
    let split = |[a, b, c, d, e]: [Vec3; 5]| {
        let (first, last) = (0.5 * (b + c), 0.5 * (c + d));
        let middle = 0.5 * (first + last);
        [[a, b, first, middle], [middle, last, d, e]]
    };
    let rows = NET.map(|row| split(row.map(Vec3::from)));
    let patches = [0, 1].into_iter().flat_map(|half| {
        let columns: [[[Vec3; 4]; 2]; 4] =
            std::array::from_fn(|k| split(std::array::from_fn(|row| rows[row][half][k])));
        [0, 1].map(|other| Patch::from_points(&columns.map(|column| column[other])))
    });
    let patches = patches.collect();
    let surface = SculpturedSurface::assembled(patches, Some((2, 2)), Vec::new(), 1.0, Mesh::default());
    Geometry::Sculptured(Remembering::new(surface))
}

/// Normals of which a start-up that finds no position makes axes: some four thousand places are tried, with a hundred for each in the mean.
const MOST_NORMALS: u64 = 600_000;

/// A ball six times as wide as the waves below it, with its axis at an angle to them: as it turns by a little its contact leaps from one
/// wave to another, and no axis settles.
#[test]
fn a_place_at_which_no_axis_settles_is_soon_known_for_one() {
    let (along, first) = (plane(0.0, 1.0, 0.0, 1.405727625476), plane(1.0, 0.0, 0.0, 0.8));
    let mut p = Program::new();
    p.state.start_up = StartUpRule::Apt4;
    let ball = 11.644563320168;
    p.tolerance(0.002165, 0.00619).cutter(&[2.0 * ball, ball, 0.0, ball, 0.0, 0.0, 215.977544025918]);
    p.from(-11.044563320168, 1.405727625476, 3.0);
    p.run(&MotionCommand::Thickness(PerRole { part: 0.0, drive: 0.1, check: [0.0; 2] }));
    let mode = AxisAngle::Plain;
    p.run(&MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, angle: 8.07394f64.to_radians(), mode }));
    p.indirv(1.0, 0.0, -0.5);
    let before = NORMALS.get();
    let command = start(&[(Relation::On, &along), (Relation::To, &waves()), (Relation::On, &first)]);
    let failure = p.attempt(&command).err();
    let normals = NORMALS.get() - before;
    assert!(matches!(failure, Some(MotionFailure::StartUpDiverges { .. })), "{failure:?}");
    assert!(normals <= MOST_NORMALS, "{normals} normals");
}

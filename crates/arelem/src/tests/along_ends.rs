//! Tools that go along the end of a surface, which they touch with two places one after the other.

use apt_geometry::canonical::{Remembering, RuledSurface};

use super::{beyond_ends::poly_conic, *};

/// A bull nose comes to the end of its drive surface with its flank, told by which its path would lead over that; but there it touches the end with the edge
/// of its top, too, and goes on along it by that.
#[test]
fn a_tool_goes_along_an_end_by_the_place_that_touches_it_next() {
    let part = Geometry::RuledSurface(Remembering::new(RuledSurface {
        parts: vec![
            Geometry::Circle(Cylinder {
                point: v(-6.163004806538245, -4.994706171123353, -5.930373359495489),
                axis: v(0.8645978214523096, -0.41997505449495676, -0.2758469879151814),
                radius: 7.517514305407565,
            }),
            Geometry::Point(v(-5.423722156454099, -0.8828322188134374, 1.002084725167352)),
            Geometry::Point(v(-5.709728060475724, 3.0865998230681053, -5.937786303010974)),
            Geometry::Vector(v(0.5011910732167746, 0.7598864049091631, 0.4139808688358017)),
            Geometry::Circle(Cylinder {
                point: v(-4.697722456114995, -2.7731020824998827, -4.720058785006614),
                axis: v(0.8645978214523096, -0.41997505449495676, -0.2758469879151814),
                radius: 5.276658229739698,
            }),
            Geometry::Point(v(-0.23613522774024132, -3.4026825457831777, -0.652997202323736)),
            Geometry::Point(v(-0.5221411317618663, 0.566749496098365, -7.592868230502061)),
            Geometry::Vector(v(0.5011910732167746, 0.7598864049091631, 0.4139808688358017)),
        ],
    }));
    let drive = poly_conic(
        &[
            1.0,
            0.6654960532561518,
            -0.1378113004138991,
            -0.7335687074696648,
            2.0033771588060683,
            -0.5929818045982488,
            0.499265038062853,
            -0.6317491600180423,
            1.2289014149166544,
            0.45330738193403514,
            0.8554194685920632,
            0.2505393187461459,
            5.335501060834215,
            0.0,
            0.0,
            6.0,
        ],
        [
            [4.029073523840519, 0.0819413459047001],
            [4.029073523840519, 0.08195468488397166],
            [4.029073523840519, 0.0837400002385643],
            [-4.029073523840519, 0.04038914259203168],
            [-4.029073523840519, -0.04366088242810378],
            [4.029073523840519, 0.018975096250817503],
            [0.7071067811865476, -0.005890529680399159],
        ],
    );
    let stop = cylinder(
        v(-5.482410319602025, -0.9230093834392222, 0.954946409868914),
        v(0.4223308959814577, -0.3178108552227861, 0.8489009804459295),
        3.4108958966903784,
    );
    let mut p = Program::new();
    p.cutter(&[0.9013349321372794, 0.2884494953454137])
        .tolerance(0.001, 0.001)
        .run(&MotionCommand::MaximumStep(10.0));
    p.run(&MotionCommand::From {
        position: v(-0.5741594963120217, -0.2886570935576741, -0.836309149869533),
        axis: Some(v(0.4898089094893754, -0.08363775051106193, 0.8678087109923928)),
        name: String::new(),
    });
    p.run(&MotionCommand::PartSurface(named(&part))).go(&[(Relation::To, &drive)]);
    let forward = v(-0.9070230638685834, 0.15871930142607757, 0.3900222365010301);
    p.side(DriveSide::Left).indirv(forward.x, forward.y, forward.z);
    p.drive(Turn::Forward, &drive, Relation::To, &stop).verified();
}

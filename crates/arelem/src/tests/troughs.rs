//! Motions over a part surface whose corner, a trough across the way, turns the path by more than a right angle.

use super::*;

/// Slope of both faces of the trough z = s·|x|; a path across it turns by 127°.
const STEEP: f64 = 2.0;
/// Where motions begin and end, by x.
const AWAY: f64 = 2.0;

fn trough() -> Geometry {
    quadric([-STEEP * STEEP, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
}

/// A cutter beside the faces: its numbers, and how far the middle and the radius of what touches them are from axis and end.
struct Shape {
    numbers: &'static [f64],
    offset: f64,
    radius: f64,
}

const CUTTERS: [Shape; 3] = [
    Shape { numbers: &[1.0, 0.5], offset: 0.0, radius: 0.5 },
    Shape { numbers: &[1.0], offset: 0.5, radius: 0.0 },
    Shape { numbers: &[1.0, 0.2], offset: 0.3, radius: 0.2 },
];

impl Shape {
    /// The height of the tool end so far from the middle of the trough, with a stock on its faces.
    fn height(&self, x: f64, stock: f64) -> f64 {
        STEEP * (x.abs() + self.offset) + (self.radius + stock) * STEEP.hypot(1.0) - self.radius
    }
}

fn lowest(program: &Program) -> f64 {
    program.last().points.iter().map(|point| point.tip.z).fold(f64::INFINITY, f64::min)
}

fn is_verified(program: &mut Program) {
    program.verified();
    for sequence in &program.sequences {
        let evidence = crate::verify::verify(sequence, &|| false).expect("evidence");
        assert!(evidence.verified, "{evidence:?}");
    }
}

/// A tool in front of the trough or in its bottom.
fn set_out(shape: &Shape, stock: f64, (x, y): (f64, f64)) -> Program {
    let mut program = Program::new();
    program.cutter(shape.numbers).tolerance(0.001, 0.001).from(x, y, shape.height(x, stock));
    program.run(&MotionCommand::Thickness(PerRole { part: stock, ..PerRole::all(0.0) }));
    program.run(&MotionCommand::PartSurface(named(&trough())));
    program
}

#[test]
fn a_path_goes_down_one_face_of_a_trough_and_up_the_other() {
    for shape in &CUTTERS {
        for (drive_side, beside) in [(DriveSide::On, 0.0), (DriveSide::Left, 0.5), (DriveSide::Right, -0.5)] {
            for stock in [0.0, 0.1] {
                let mut program = set_out(shape, stock, (-AWAY, beside));
                program.side(drive_side).indirv(1.0, 0.0, -STEEP);
                program.drive(Turn::Forward, &y(0.0), Relation::On, &plane(1.0, 0.0, 0.0, AWAY));
                program.ends(AWAY, beside, shape.height(AWAY, stock), 0.005);
                let (low, points) = (lowest(&program), program.last().points.len());
                assert!((low - shape.height(0.0, stock)).abs() < 0.005, "{low}");
                assert!(points <= 4, "{points} vectors");
                is_verified(&mut program);
            }
        }
    }
}

/// How far the bottom of the rounded trough is above the edge of the sharp one: less than the band.
const ROUNDED: f64 = 0.0008;

#[test]
fn a_tool_end_on_a_trough_goes_through_its_bottom() {
    // The hyperbola z² = s²x² + h² over y.
    let rounded = quadric([-STEEP * STEEP, 0.0, 1.0, -ROUNDED * ROUNDED, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let mut program = Program::new();
    program.cutter(&[1.0, 0.5]).tolerance(0.001, 0.001).from(-AWAY, 0.0, AWAY * STEEP);
    program.run(&MotionCommand::PartSurface(named(&rounded))).part_side(PartSide::On);
    program.side(DriveSide::On).indirv(1.0, 0.0, -STEEP);
    program.drive(Turn::Forward, &y(0.0), Relation::On, &plane(1.0, 0.0, 0.0, AWAY));
    program.ends(AWAY, 0.0, AWAY * STEEP, 0.005);
    assert!(lowest(&program).abs() < 0.005);
    is_verified(&mut program);
}

/// To the bottom, and on from there: up the other face, along the bottom to the left, and back.
#[test]
fn a_motion_out_of_the_bottom_of_a_trough_goes_where_it_is_told() {
    let x = |d: f64| plane(1.0, 0.0, 0.0, d);
    for shape in &CUTTERS {
        let down = || {
            let mut program = set_out(shape, 0.0, (-AWAY, 0.0));
            program.side(DriveSide::On).indirv(1.0, 0.0, -STEEP);
            program.drive(Turn::Forward, &y(0.0), Relation::On, &x(0.0));
            program.ends(0.0, 0.0, shape.height(0.0, 0.0), 0.005);
            program
        };
        let mut program = down();
        program.drive(Turn::Forward, &y(0.0), Relation::On, &x(AWAY));
        program.ends(AWAY, 0.0, shape.height(AWAY, 0.0), 0.005);
        is_verified(&mut program);
        let mut program = down();
        program.drive(Turn::Left, &x(0.0), Relation::On, &y(1.0));
        program.ends(0.0, 1.0, shape.height(0.0, 0.0), 0.005);
        is_verified(&mut program);
        let mut program = down();
        program.drive(Turn::Back, &y(0.0), Relation::On, &x(-AWAY));
        program.ends(-AWAY, 0.0, shape.height(AWAY, 0.0), 0.005);
        is_verified(&mut program);
        for ahead in [[1.0, STEEP], [1.0, 1.0], [0.2, 1.0], [1.0, 0.0]] {
            let mut program = down();
            program.indirv(ahead[0], 0.0, ahead[1]);
            program.drive(Turn::Forward, &y(0.0), Relation::On, &x(AWAY));
            program.ends(AWAY, 0.0, shape.height(AWAY, 0.0), 0.005);
            is_verified(&mut program);
        }
    }
}

/// From a trough the tool goes on to a check surface on either side of it.
#[test]
fn a_motion_over_a_trough_ends_at_every_kind_of_check_surface() {
    for shape in &CUTTERS {
        for relation in [Relation::To, Relation::On, Relation::Past] {
            let mut program = set_out(shape, 0.0, (-AWAY, 0.0));
            program.side(DriveSide::On).indirv(1.0, 0.0, -STEEP);
            program.drive(Turn::Forward, &y(0.0), relation, &plane(1.0, 0.0, 0.0, AWAY));
            let stop = match relation {
                Relation::To => AWAY - 0.5,
                Relation::Past => AWAY + 0.5,
                _ => AWAY,
            };
            program.ends(stop, 0.0, shape.height(stop, 0.0), 0.005);
            is_verified(&mut program);
        }
    }
}

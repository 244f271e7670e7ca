//! Where the tool end is on the part while the slides and tables of linuxcnc-mill5 move, computed from its joints alone.

use apt_geometry::Vec3;

/// The place through which both tables of the machine turn, millimetres.
const CENTER: Vec3 = Vec3::new(0.0, 0.0, -50.0);
/// What the last decimals of lengths, and of angles at the distances of these parts from the axes, may come to, millimetres.
pub(crate) const ROUNDED: f64 = 4e-4;
/// The same where the interpreter prints inches with four decimals.
const ROUNDED_INCHES: f64 = 2e-4;
const MILLIMETERS_PER_INCH: f64 = 25.4;

/// How far the tool end may leave its way on a rapid, millimetres.
const RAPID: f64 = 1.0;

/// A move of the joints: X, Y, Z, and A, C in degrees.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Move {
    pub(crate) rapid: bool,
    arc: bool,
    pub(crate) to: [f64; 5],
}

/// A position of the program.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Goal {
    pub(crate) rapid: bool,
    pub(crate) tip: Vec3,
    /// Direction of the tool, of unit length.
    pub(crate) axis: Vec3,
}

/// The moves that the interpreter makes of a tape up to the way home.
pub(crate) fn moves(tape: &str, tools: &[u32]) -> Vec<Move> {
    let output = super::run(tape, tools);
    assert!(output.contains("PROGRAM_END"), "{output}\n{tape}");
    let home = output.find("STOP_SPINDLE_TURNING(0)\n").map_or(0, |at| at + 1);
    let home = output[home..].find("STOP_SPINDLE_TURNING").map_or(output.len(), |at| home + at);
    let mut found = Vec::new();
    let mut plane = 2;
    for line in output[..home].lines() {
        plane = match line.split("SELECT_PLANE(CANON_PLANE_").nth(1) {
            Some("XY)") => 2,
            Some("XZ)") => 1,
            Some("YZ)") => 0,
            _ => plane,
        };
        let (rapid, arc) = (line.contains("STRAIGHT_TRAVERSE("), line.contains("ARC_FEED("));
        if !rapid && !arc && !line.contains("STRAIGHT_FEED(") {
            continue;
        }
        let numbers: Vec<f64> =
            line.split(['(', ',', ')']).skip(1).filter_map(|text| text.trim().parse().ok()).collect();
        let to = match numbers[..] {
            // An arc tells its end in its plane, its centre and its turns, and then across.
            [u, v, _, _, _, w, a, _, c] => {
                let mut to = [0.0, 0.0, 0.0, a, c];
                (to[(plane + 1) % 3], to[(plane + 2) % 3], to[plane]) = (u, v, w);
                to
            }
            [x, y, z, a, _, c] => [x, y, z, a, c],
            _ => panic!("{line}"),
        };
        found.push(Move { rapid, arc, to });
    }
    found
}

fn about_x(place: Vec3, degrees: f64) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vec3::new(place.x, place.y * cosine - place.z * sine, place.y * sine + place.z * cosine)
}

fn about_z(place: Vec3, degrees: f64) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vec3::new(place.x * cosine - place.y * sine, place.x * sine + place.y * cosine, place.z)
}

/// Tool end and direction of the tool on the part; `unit` is a millimetre.
pub(crate) fn on_part([x, y, z, a, c]: [f64; 5], unit: f64) -> (Vec3, Vec3) {
    let center = CENTER * unit;
    let place = about_z(about_x(Vec3::new(x, y, z) - center, a), c) + center;
    (place, about_z(about_x(Vec3::z(), a), c))
}

/// Follows the joints along the path: every position is come to, and between two cuts the tool end stays within `tip` millimetres of its straight
/// way and the tool within `axis` degrees of its great circle; on rapids behind the first position the tool end within `RAPID`. Arcs end at positions,
/// which those between are on.
pub(crate) fn follow_turning(moves: &[Move], path: &[Goal], inches: bool, tip: f64, axis: f64) {
    let (unit, rounded) =
        if inches { (MILLIMETERS_PER_INCH.recip(), ROUNDED_INCHES) } else { (1.0, ROUNDED) };
    let is_at = |joints: [f64; 5], goal: &Goal| {
        let (end, stands) = on_part(joints, unit);
        (end - goal.tip).norm() <= rounded && (stands - goal.axis).norm() <= 1e-5
    };
    let mut here = [0.0; 5];
    let mut at = 0;
    for step in moves {
        if step.arc {
            let ahead = path[at..].iter().position(|goal| is_at(step.to, goal));
            at += ahead.unwrap_or_else(|| panic!("{step:?} ends at no position")) + 1;
        } else if let Some(goal) = path.get(at) {
            let (tip, axis) = if step.rapid { (RAPID, 90.0) } else { (tip, axis) };
            // From where FROM says the tool stands nobody knows how it comes.
            if let Some(start) = at.checked_sub(1).map(|before| &path[before]) {
                assert_eq!(goal.rapid, step.rapid, "{step:?} on the way to {goal:?}");
                for share in [0.25, 0.5, 0.75, 1.0] {
                    let joints =
                        std::array::from_fn(|index| here[index] + (step.to[index] - here[index]) * share);
                    keeps(on_part(joints, unit), start, goal, (tip * unit + rounded, axis));
                }
            }
        }
        while path.get(at).is_some_and(|goal| is_at(step.to, goal)) {
            at += 1;
        }
        here = step.to;
    }
    assert_eq!(at, path.len(), "positions without a move: {moves:?}");
}

/// A tool between two positions of a cut.
fn keeps((place, stands): (Vec3, Vec3), start: &Goal, goal: &Goal, (tip, axis): (f64, f64)) {
    let way = goal.tip - start.tip;
    let square = way.norm_squared();
    let along = if square > 0.0 { ((place - start.tip).dot(&way) / square).clamp(0.0, 1.0) } else { 0.0 };
    let off = (place - (start.tip + way * along)).norm();
    assert!(off <= tip, "{off} off between {start:?} and {goal:?}");
    let across = start.axis.cross(&goal.axis);
    if across.norm() > 1e-6 {
        let aside = stands.dot(&across.normalize()).asin().to_degrees();
        assert!(aside.abs() <= axis + 1e-3, "{aside} degrees aside between {start:?} and {goal:?}");
    }
}

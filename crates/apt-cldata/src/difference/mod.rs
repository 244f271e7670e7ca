//! Where two paths differ, whatever records and vectors they were written in.
//!
//! Two tools, one on each path, go on without turning back. As long as they can keep within the tolerance of each other, in the same
//! manner (rapid or feed), the paths are the same (`together`). Where they part it is looked for where they come together again, with as little as
//! can be left out (`rejoin`), and how far they are from each other between (`apart`).

mod apart;
mod path;
mod rejoin;
#[cfg(test)]
mod tests;
mod together;

use apt_geometry::Vec3;

pub use self::{
    apart::Apart,
    path::{Manner, Path, Place},
};
use self::{
    apart::apart,
    path::Point,
    rejoin::Rejoining,
    together::{Run, together},
};

/// How far from each other two tools may be that are on the same path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Between the tool ends, in the unit of the paths; more than zero.
    pub distance: f64,
    /// Between the axes, radians.
    pub angle: f64,
}

/// The fraction of the extent of both paths that is no difference where no tolerance is told: what rounding leaves of seven figures.
const ROUNDING: f64 = 1e-6;

impl Tolerance {
    /// The tolerance for paths of which nothing else is told: a millionth of what they extend over, and of a half turn.
    pub fn of(paths: [&Path; 2]) -> Self {
        let bounds = paths.iter().filter_map(|path| path.bounds());
        let all = bounds.reduce(|[low, high], [lower, higher]| [low.inf(&lower), high.sup(&higher)]);
        let extent = all.map_or(0.0, |[low, high]| (high - low).norm());
        let distance = if extent > 0.0 { extent * ROUNDING } else { ROUNDING };
        Self { distance, angle: std::f64::consts::PI * ROUNDING }
    }

    /// The distance between the tips of unit vectors that are so far turned from each other.
    fn axis_chord(self) -> f64 {
        2.0 * (self.angle / 2.0).sin()
    }

    /// The turn on a vector, radians, over which the straight way between the tips of both axes is nearer to the vertex than their length by no more
    /// than a quarter of the tolerance: 1 − cos(φ/2) is φ²/8.
    fn straight_turn(self) -> f64 {
        (2.0 * self.angle).sqrt()
    }
}

/// What two paths have in common and where they differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The stretches that differ, in order.
    pub stretches: Vec<Stretch>,
    /// The tolerance that they were held to.
    pub tolerance: Tolerance,
}

/// Stretches of both paths, from where they part to where they are together again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// That of either path; `None` for a path without places.
    pub sides: [Option<Side>; 2],
    /// How far the stretches are from each other; `None` if one has no place.
    pub apart: Option<Apart>,
    /// In what they differ.
    pub kind: StretchKind,
}

/// A stretch of one path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Where it begins, and the index of the record that leads on from there.
    pub from: (Vec3, usize),
    /// Where it ends, and the index of the record that leads there.
    pub to: (Vec3, usize),
    /// Its length; zero where the tool stays while the other one goes somewhere.
    pub length: f64,
    /// How much of it is at rapid.
    pub rapid: f64,
}

/// In what two stretches differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StretchKind {
    /// One goes where the other does not.
    Places,
    /// The axes differ.
    Axes,
    /// One goes at rapid where the other feeds.
    Manner,
    /// Both go to the same places, in another order or more than once.
    Order,
}

/// Compares two paths in the same unit. `None` if whoever waits has given up.
pub fn compare(paths: [&Path; 2], tolerance: Tolerance, cancel: &dyn Fn() -> bool) -> Option<Difference> {
    let turning = paths.map(|path| path.turning_by(tolerance.straight_turn()));
    let paths = turning.each_ref().map(AsRef::as_ref);
    let mut stretches = Vec::new();
    let ends = paths.map(Path::end);
    if paths.iter().any(|path| path.vectors() == 0) {
        if !is_same_place(paths, tolerance) {
            let begin = Point { vector: 0, fraction: 0.0 };
            stretches.push(Stretch::between(paths, [[begin; 2], ends], tolerance));
        }
        return Some(Difference { stretches, tolerance });
    }
    let begin = [Point { vector: 0, fraction: 0.0 }; 2];
    let mut run = if is_near(paths, begin, tolerance) {
        together(paths, begin, tolerance, cancel)?
    } else {
        Run { ends: begin, is_complete: false }
    };
    let rejoining = (!run.is_complete).then(|| Rejoining::new(paths, tolerance));
    while let (Some(rejoining), false) = (&rejoining, run.is_complete) {
        let next = rejoining.after(run.ends, cancel)?;
        let until = next.map_or(ends, |(from, _)| from);
        stretches.push(Stretch::between(paths, [run.ends, until], tolerance));
        run = next.map_or(Run { ends, is_complete: true }, |(_, run)| run);
    }
    Some(Difference { stretches, tolerance })
}

/// True if neither path goes anywhere, and both are at the same place or none.
fn is_same_place(paths: [&Path; 2], tolerance: Tolerance) -> bool {
    match paths.map(|path| path.places.len()) {
        [0, 0] => true,
        [1, 1] => is_near(paths, [Point { vector: 0, fraction: 0.0 }; 2], tolerance),
        _ => false,
    }
}

fn is_near([a, b]: [&Path; 2], [first, second]: [Point; 2], tolerance: Tolerance) -> bool {
    let ([here, axis], [there, other]) = (a.at(first), b.at(second));
    (here - there).norm() <= tolerance.distance && (axis - other).norm() <= tolerance.axis_chord()
}

impl Stretch {
    /// What lies between two points on each path.
    fn between(paths: [&Path; 2], [from, to]: [[Point; 2]; 2], tolerance: Tolerance) -> Self {
        let sides = [0, 1].map(|side| Side::between(paths[side], from[side], to[side]));
        let [Some(first), Some(second)] = sides else {
            return Self { sides, apart: None, kind: StretchKind::Places };
        };
        let chains = [0, 1].map(|side| paths[side].stretch(from[side], to[side]));
        let apart = apart([&chains[0], &chains[1]], tolerance.distance * CLOSE);
        let kind = if apart.distance > tolerance.distance {
            StretchKind::Places
        } else if apart.turned > tolerance.angle {
            StretchKind::Axes
        } else if (first.rapid - second.rapid).abs() > tolerance.distance {
            StretchKind::Manner
        } else {
            StretchKind::Order
        };
        Self { sides, apart: Some(apart), kind }
    }
}

/// To how much of the tolerance distances are told.
const CLOSE: f64 = 0.1;

impl Side {
    fn between(path: &Path, from: Point, to: Point) -> Option<Self> {
        if path.places.is_empty() {
            return None;
        }
        let rapid_of = |vector: usize| {
            let [begin, end] =
                [(vector, 0.0), (vector, 1.0)].map(|(vector, fraction)| Point { vector, fraction });
            let is_rapid = vector < path.vectors() && path.manner(vector) == Manner::Rapid;
            let [begin, end] = [if begin < from { from } else { begin }, if to < end { to } else { end }];
            if is_rapid { path.along(end) - path.along(begin) } else { 0.0 }
        };
        Some(Self {
            from: (path.at(from)[0], path.record_after(from)),
            to: (path.at(to)[0], path.record_before(to)),
            length: path.along(to) - path.along(from),
            rapid: (from.vector..=to.vector).map(rapid_of).sum(),
        })
    }
}

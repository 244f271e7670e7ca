//! Where the paths of two programs or CL files differ.

use std::ops::Range;

use apt_cldata::difference::{Difference, Path, Side, Tolerance, compare};
use apt_geometry::patience::{Waiting, put_away};
use apt_program::Origin;
use apt_run::{
    diagnostic::{Diagnostic, absolute_range},
    go_on,
};
use apt_syntax::dialect::DialectName;

pub use apt_cldata::{difference::StretchKind, record::Units};

use crate::{Analysis, Cancel, Cancelled};

/// Why two paths cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum DifferenceError {
    /// Places so far away that no distance between them is a number.
    #[error("a place of the path is too far away to be measured")]
    TooFar,
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The way of the tool of a program, with the statements that lead it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ToolPath {
    path: Path,
    /// For each CL record its statement.
    statements: Vec<Statement>,
}

/// A statement of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Statement {
    /// Its number.
    pub isn: u32,
    /// Where it stands in the text, bytes.
    pub range: Range<usize>,
}

/// How far two tools on one path may be from each other, as far as it is told.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Allowance {
    /// Between the tool ends, in the unit of the first path, above zero. If it is not told, a millionth of what both paths extend over.
    pub distance: Option<f64>,
    /// Between the axes, degrees, above zero. If it is not told, a millionth of a half turn.
    pub degrees: Option<f64>,
}

/// Where two paths differ. Lengths and places are in the unit of the first one, if both are known.
#[derive(Debug, Clone, PartialEq)]
pub struct PathDifference {
    /// What is compared.
    pub paths: [Compared; 2],
    /// The distance between tool ends that is no difference.
    pub tolerance: f64,
    /// The angle between axes that is no difference, degrees.
    pub degrees: f64,
    /// Where they differ, in order.
    pub stretches: Vec<DifferentStretch>,
}

/// A path that is compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The unit that the program names, if it does.
    pub units: Option<Units>,
    /// Places of the tool.
    pub places: usize,
    /// Length of the way.
    pub length: f64,
}

/// Stretches of both paths that differ.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferentStretch {
    /// In what.
    pub kind: StretchKind,
    /// How far the places of one are from the other at most, and the place that is so far; `None` if there is no other path.
    pub apart: Option<(f64, [f64; 3])>,
    /// The greatest angle between the axes at places nearest to each other, degrees.
    pub turned: f64,
    /// The stretch of either path; `None` for one without places.
    pub sides: [Option<StretchSide>; 2],
}

/// A stretch of one path.
#[derive(Debug, Clone, PartialEq)]
pub struct StretchSide {
    /// The place where it begins, and the statement that leads on from there.
    pub from: ([f64; 3], Statement),
    /// The place where it ends, and the statement that leads there.
    pub to: ([f64; 3], Statement),
    /// Its length.
    pub length: f64,
    /// How much of that is at rapid.
    pub rapid_length: f64,
}

impl Analysis {
    /// The way of the tool, and what was found in the program or file. The text of a CL file (dialect `cl`) is read as it stands; any
    /// other program is run.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn tool_path(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<(ToolPath, Vec<Diagnostic>), Cancelled> {
        let source = match self.document().dialect() {
            DialectName::Cl => self.read_cutter_locations(cancel)?,
            _ => self.run_to_cutter_locations(cancel, progress)?,
        };
        let tree = self.document().tree();
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let (records, origins) = (source.records.list(), source.records.origins());
        let mut statements = Vec::with_capacity(records.len());
        for record in records {
            go_on(patience, 1)?;
            statements.push(match origins.get(record.source as usize) {
                Some(origin) => {
                    Statement { isn: origin.place_in_program().0, range: absolute_range(tree, origin) }
                }
                None => {
                    let origin = Origin::in_program(record.isn, Default::default());
                    Statement { isn: record.isn, range: absolute_range(tree, &origin) }
                }
            });
        }
        let path = Path::until(records, patience).ok_or(Cancelled)?;
        put_away(source.records, statements.len());
        Ok((ToolPath { path, statements }, source.diagnostics))
    }
}

/// Compares two paths, whatever records and vectors they are written in (`apt_cldata::difference`).
///
/// # Errors
///
/// [`DifferenceError`] when `cancel` said so before the end, or a place is too far away.
pub fn difference(
    [a, b]: [&ToolPath; 2],
    allowance: Allowance,
    cancel: Cancel<'_>,
) -> Result<PathDifference, DifferenceError> {
    let second = b.path.clone().in_units(a.path.units);
    let paths = [&a.path, &second];
    if !paths.iter().all(|path| path.is_measurable()) {
        return Err(DifferenceError::TooFar);
    }
    let of_paths = Tolerance::of(paths);
    let tolerance = Tolerance {
        distance: allowance.distance.unwrap_or(of_paths.distance),
        angle: allowance.degrees.map_or(of_paths.angle, f64::to_radians),
    };
    let found = compare(paths, tolerance, cancel).ok_or(Cancelled)?;
    Ok(told([a, b], paths, &found))
}

fn told(programs: [&ToolPath; 2], paths: [&Path; 2], found: &Difference) -> PathDifference {
    let compared = |side: usize| Compared {
        units: programs[side].path.units,
        places: paths[side].places.len(),
        length: paths[side].length(),
    };
    let stretch_side = |program: &ToolPath, side: Side| {
        let place = |(position, record): (apt_geometry::Vec3, usize)| {
            (position.into(), program.statements[record].clone())
        };
        StretchSide {
            from: place(side.from),
            to: place(side.to),
            length: side.length,
            rapid_length: side.rapid,
        }
    };
    let stretches = found.stretches.iter().map(|stretch| DifferentStretch {
        kind: stretch.kind,
        apart: stretch.apart.map(|apart| (apart.distance, apart.at.into())),
        turned: stretch.apart.map_or(0.0, |apart| apart.turned.to_degrees()),
        sides: [0, 1].map(|side| stretch.sides[side].map(|one| stretch_side(programs[side], one))),
    });
    PathDifference {
        paths: [compared(0), compared(1)],
        tolerance: found.tolerance.distance,
        degrees: found.tolerance.angle.to_degrees(),
        stretches: stretches.collect(),
    }
}

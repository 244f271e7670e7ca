//! SSURF/PATCH: sixteen data per patch, rows of four along u.

use super::{parametric_error::ParametricError, sculptured::PatchForm};
use crate::{
    Vec3,
    parametric::{Mesh, Patch, SculpturedSurface},
};

/// The surface of the patches in the order of the statement.
///
/// # Errors
/// No patch, or sign words that tell different sides of the surface.
pub(super) fn surface(
    form: PatchForm,
    patches: &[(f64, [Vec3; 16])],
    warnings: &mut Vec<ParametricError>,
) -> Result<SculpturedSurface, ParametricError> {
    let Some((side, _)) = patches.first() else {
        return Err(ParametricError::TooFew { least: 1, found: 0 });
    };
    if form == PatchForm::PointsOn && patches.len() > 1 {
        warnings.push(ParametricError::LoosePatches { patches: patches.len() });
    }
    let made: Vec<Patch> = patches.iter().map(|(_, data)| patch(form, data)).collect();
    let grid = (made.len() == 1).then_some((1, 1));
    let side = if *side < 0.0 { -1.0 } else { 1.0 };
    let surface = SculpturedSurface::assembled(made, grid, Vec::new(), side, Mesh::default());
    one_sided(surface, patches.iter().map(|(sign, _)| *sign))
}

/// The surface, where the signs of its patches that differ tell one side of it: that of one whose parameters run about it the other way has the
/// other sign.
///
/// # Errors
/// [`ParametricError::MixedSigns`] where they do not.
pub(super) fn one_sided(
    surface: SculpturedSurface,
    signs: impl Iterator<Item = f64> + Clone,
) -> Result<SculpturedSurface, ParametricError> {
    let differ = signs.clone().any(|sign| sign * surface.side < 0.0);
    let agree = || surface.senses().into_iter().zip(signs).all(|(sense, sign)| sense * sign > 0.0);
    if differ && !agree() { Err(ParametricError::MixedSigns) } else { Ok(surface) }
}

fn patch(form: PatchForm, data: &[Vec3; 16]) -> Patch {
    let at = |i: usize, j: usize| data[4 * j + i];
    match form {
        PatchForm::Polygon => Patch::from_points(&std::array::from_fn(|i| std::array::from_fn(|j| at(i, j)))),
        PatchForm::PointsVectors => Patch::from_hermite(&std::array::from_fn(|i| {
            std::array::from_fn(|j| [at(i, j), at(i + 2, j), at(i, j + 2), at(i + 2, j + 2)])
        })),
        PatchForm::PointsOn => {
            // Points at thirds of both parameters.
            let along_u: [[Vec3; 4]; 4] =
                std::array::from_fn(|j| through_thirds(&std::array::from_fn(|i| at(i, j))));
            let rows: [[Vec3; 4]; 4] =
                std::array::from_fn(|i| through_thirds(&std::array::from_fn(|j| along_u[j][i])));
            Patch::from_points(&rows)
        }
    }
}

/// Control points of the cubic through four points at the parameters 0, 1/3, 2/3 and 1.
fn through_thirds(p: &[Vec3; 4]) -> [Vec3; 4] {
    let inner = |a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3| (b * 18.0 - a * 5.0 - c * 9.0 + d * 2.0) / 6.0;
    [p[0], inner(&p[0], &p[1], &p[2], &p[3]), inner(&p[3], &p[2], &p[1], &p[0]), p[3]]
}

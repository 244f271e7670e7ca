//! SSURF: from typed arguments to a surface.

use super::{
    parametric_error::ParametricError,
    sculptured::{AxisInput, CurveProduct, SculpturedDefinition, SurfaceShape},
    sculptured_convert, sculptured_knots, sculptured_loft, sculptured_mesh, sculptured_patch,
    sculptured_revolved,
    space_curve::Defined,
};
use crate::{
    Vec3,
    canonical::Remembering,
    parametric::{CurveArc, Mesh, Patch, SculpturedSurface, SpaceCurve},
};

/// How far RULED reaches to either side of its curve, in units of the program, whatever the length of its vector.
const RULED_REACH: f64 = 10.0;

impl SculpturedDefinition {
    /// A definition without TRFORM.
    pub fn plain(shape: SurfaceShape) -> SculpturedDefinition {
        SculpturedDefinition { shape, matrix: None }
    }

    /// The surface, in the coordinates of the arguments.
    ///
    /// # Errors
    /// [`ParametricError`] says what cannot be made.
    pub fn define(&self) -> Result<Defined<SculpturedSurface>, ParametricError> {
        let mut warnings = Vec::new();
        let mut surface = shape(&self.shape, &mut warnings)?;
        if let Some(matrix) = &self.matrix {
            matrix.inverse().ok_or(ParametricError::SingularMatrix)?;
            surface = surface.transformed(matrix);
        }
        if !surface.is_finite() {
            return Err(ParametricError::NotFinite);
        }
        Ok(Defined { geometry: surface, warnings })
    }
}

fn shape(
    shape: &SurfaceShape,
    warnings: &mut Vec<ParametricError>,
) -> Result<SculpturedSurface, ParametricError> {
    match shape {
        SurfaceShape::Curves { curves, cross } => sculptured_loft::surface(curves, cross),
        SurfaceShape::Ruled { curve, axis } => ruled(curve, axis),
        SurfaceShape::Revolved { curve, axis, turning, angles } => {
            sculptured_revolved::surface(curve, axis, *turning, *angles)
        }
        SurfaceShape::Mesh { restriction, rows } => sculptured_mesh::surface(*restriction, rows),
        SurfaceShape::Product { product, profile, control } => Ok(multiplied(*product, profile, control)),
        SurfaceShape::Patches { form, patches } => sculptured_patch::surface(*form, patches, warnings),
        SurfaceShape::Combined { surfaces } => combined(surfaces, warnings),
        SurfaceShape::BSpline { degrees, knots, points, weights } => {
            let (patches, grid) = sculptured_knots::surface(*degrees, knots, points, weights)?;
            Ok(meshed(patches, grid))
        }
        SurfaceShape::Converted { surface, range } => sculptured_convert::surface(surface, range),
    }
}

/// A grid of patches whose edges are splines.
pub(super) fn meshed(patches: Vec<Patch>, (columns, rows): (usize, usize)) -> SculpturedSurface {
    let mesh = Mesh { splines: rows + 1, cross_splines: columns + 1 };
    SculpturedSurface::assembled(patches, Some((columns, rows)), Vec::new(), 1.0, mesh)
}

/// The direction of an axis that has no place.
fn axis_vector(axis: &AxisInput) -> Result<Vec3, ParametricError> {
    let vector = match axis {
        AxisInput::Vector(vector) => *vector,
        AxisInput::Points(from, to) => to - from,
        AxisInput::PointVector(..) => return Err(ParametricError::AxisForm),
    };
    vector.try_normalize(f64::MIN_POSITIVE).ok_or(ParametricError::ZeroVector)
}

fn ruled(curve: &SpaceCurve, axis: &AxisInput) -> Result<SculpturedSurface, ParametricError> {
    let reach = axis_vector(axis)? * RULED_REACH;
    let patch = |arc: &CurveArc| Patch::between(&arc.shifted(&-reach), &arc.shifted(&reach));
    let patches: Vec<Patch> = curve.arcs.iter().map(patch).collect();
    let columns = patches.len();
    Ok(numbered(meshed(patches, (columns, 1)), curve, None))
}

/// A surface whose columns are the arcs of a curve, and whose rows may be those of another one: with patches as the language
/// numbers the arcs.
pub(super) fn numbered(
    mut surface: SculpturedSurface,
    along: &SpaceCurve,
    across: Option<&SpaceCurve>,
) -> SculpturedSurface {
    surface.breaks.clone_from(&along.breaks);
    surface.mesh.cross_splines = along.count() + 1;
    if let Some(across) = across {
        surface.row_breaks.clone_from(&across.breaks);
        surface.mesh.splines = across.count() + 1;
    }
    surface
}

fn multiplied(product: CurveProduct, profile: &SpaceCurve, control: &SpaceCurve) -> SculpturedSurface {
    let mut patches = Vec::with_capacity(profile.arcs.len() * control.arcs.len());
    for across in &control.arcs {
        for along in &profile.arcs {
            let net = along.control.map(|a| {
                across.control.map(|b| {
                    let mut point = match product {
                        CurveProduct::Scale => a.component_mul(&b),
                        CurveProduct::Translate | CurveProduct::Turn(_) => a * b.w + b * a.w,
                    };
                    point.w = a.w * b.w;
                    if let CurveProduct::Turn(plane) = product {
                        let [x, y, _] = plane.axes();
                        (point[x], point[y]) = (a[x] * b[x] - a[y] * b[y], a[x] * b[y] + a[y] * b[x]);
                    }
                    point
                })
            });
            patches.push(Patch { control: net });
        }
    }
    numbered(meshed(patches, (profile.arcs.len(), control.arcs.len())), profile, Some(control))
}

fn combined(
    surfaces: &[Remembering<SculpturedSurface>],
    warnings: &mut Vec<ParametricError>,
) -> Result<SculpturedSurface, ParametricError> {
    match surfaces {
        [] => Err(ParametricError::TooFew { least: 1, found: 0 }),
        // A copy keeps its grid.
        [single] => Ok(SculpturedSurface::clone(single)),
        [first, ..] => {
            let patches: Vec<Patch> =
                surfaces.iter().flat_map(|surface| surface.patches.iter().copied()).collect();
            let mut breaks = vec![0.0];
            for surface in surfaces {
                let before = breaks.last().copied().unwrap_or(0.0);
                let ends = surface.flat_breaks();
                breaks.extend(ends.iter().skip(1).map(|end| before + end));
            }
            warnings.extend(apart(surfaces).map(|index| ParametricError::Apart { surface: index + 1 }));
            let whole = SculpturedSurface::assembled(patches, None, breaks, first.side, Mesh::default());
            if surfaces.iter().all(|surface| surface.side == first.side) {
                return Ok(whole);
            }
            let signs: Vec<f64> = surfaces.iter().flat_map(|surface| surface.senses()).collect();
            sculptured_patch::one_sided(whole, signs.into_iter())
        }
    }
}

/// Of each group of surfaces that hang together without the first one, the first.
fn apart(surfaces: &[Remembering<SculpturedSurface>]) -> impl Iterator<Item = usize> {
    // Each surface has the least number of its group.
    let mut groups: Vec<usize> = (0..surfaces.len()).collect();
    for (index, surface) in surfaces.iter().enumerate() {
        for (before, other) in surfaces.iter().enumerate().take(index) {
            let (one, another) = (groups[before].min(groups[index]), groups[before].max(groups[index]));
            if one != another && surface.touches(other) {
                groups.iter_mut().filter(|group| **group == another).for_each(|group| *group = one);
            }
        }
    }
    groups.into_iter().enumerate().skip(1).filter(|(index, group)| index == group).map(|(index, _)| index)
}

//! SSURF: the forms of sculptured surfaces read into typed definitions (sculptured surfaces reference 1.3).

use apt_geometry::{
    Vec3,
    canonical::matrix::CoordinatePlane,
    definition::{
        AxisInput, CurveProduct, MeshRestriction, PatchForm, SculpturedDefinition, SurfaceRange,
        SurfaceShape, Turning,
    },
    regional::Sense,
};

use super::{
    curve::{row, transformation, weights},
    reader::{Read, Reader, SENSES},
};
use crate::{expression::Item, finding::Expected};

/// The words after SSURF.
const SHAPES: &[&str] = &[
    "GENCUR", "RULED", "REVOLV", "SMESH", "GMESH", "TRANSL", "SCALE", "XYROT", "YZROT", "ZXROT", "PATCH",
    "COMBIN", "NURBS", "FROM", "CANON",
];
/// The words after SMESH.
const RESTRICTIONS: &[&str] = &["XYZ", "XYPLAN", "YZPLAN", "ZXPLAN"];
/// Data of one patch.
const PATCH_DATA: usize = 16;
/// Numbers of what the public system says where a word of a form is missing.
const TURNING_MISSING: u16 = 1224;
const RESTRICTION_MISSING: u16 = 1225;
const CROSS_MISSING: u16 = 1233;
/// The number of a form that no public release has.
const NOT_RELEASED: u16 = 1007;

/// Reads what follows SSURF.
pub(super) fn definition(reader: &mut Reader<'_>) -> Read<SculpturedDefinition> {
    if reader.peek_word() == Some("FETCH") {
        return Err(reader.clone().numbered(NOT_RELEASED).misfit(Expected::Words(SHAPES)));
    }
    let shape = match reader.word(SHAPES)? {
        "GENCUR" => through_curves(reader)?,
        "RULED" => SurfaceShape::Ruled { curve: reader.curve()?, axis: axis(reader)? },
        "REVOLV" => revolved(reader)?,
        "SMESH" | "GMESH" => mesh(reader)?,
        "PATCH" => patches(reader)?,
        "COMBIN" => SurfaceShape::Combined { surfaces: reader.sculptured_surfaces()? },
        "NURBS" => nurbs(reader)?,
        "FROM" => converted(reader)?,
        "CANON" => return Err(reader.misfit(Expected::Words(SHAPES))),
        word => product(reader, word)?,
    };
    let matrix = transformation(reader)?;
    reader.end()?;
    Ok(SculpturedDefinition { shape, matrix })
}

/// `c1,c2,…[,CROSS,d1,d2,…]`
fn through_curves(reader: &mut Reader<'_>) -> Read<SurfaceShape> {
    let curves = reader.curves()?;
    let cross = if reader.eat("CROSS") { reader.curves()? } else { Vec::new() };
    Ok(SurfaceShape::Curves { curves, cross })
}

/// `AXIS,{v|p1,p2|p,v}`
fn axis(reader: &mut Reader<'_>) -> Read<AxisInput> {
    reader.word(&["AXIS"])?;
    if reader.peek().and_then(Item::point).is_none() {
        return Ok(AxisInput::Vector(reader.any_vector()?));
    }
    let point = reader.point()?;
    match reader.peek().and_then(Item::point) {
        Some(other) => {
            reader.skip();
            Ok(AxisInput::Points(point, other))
        }
        None => Ok(AxisInput::PointVector(point, reader.any_vector()?)),
    }
}

/// `c,AXIS,p,{p2|v},{CLW|CCLW},a1,a2`
fn revolved(reader: &mut Reader<'_>) -> Read<SurfaceShape> {
    let curve = reader.curve()?;
    let axis = axis(reader)?;
    let turning = match reader.word_or(&["CLW", "CCLW"], TURNING_MISSING)? {
        "CLW" => Turning::Clockwise,
        _ => Turning::CounterClockwise,
    };
    let angles = [reader.scalar()?, reader.scalar()?];
    Ok(SurfaceShape::Revolved { curve, axis, turning, angles })
}

/// `{XYZ|…},SPLINE,p11,…,SPLINE,p21,…`
fn mesh(reader: &mut Reader<'_>) -> Read<SurfaceShape> {
    let restriction = match reader.word_or(RESTRICTIONS, RESTRICTION_MISSING)? {
        "XYPLAN" => MeshRestriction::Height(CoordinatePlane::Xy),
        "YZPLAN" => MeshRestriction::Height(CoordinatePlane::Yz),
        "ZXPLAN" => MeshRestriction::Height(CoordinatePlane::Zx),
        _ => MeshRestriction::Free,
    };
    let mut rows = Vec::new();
    reader.word(&["SPLINE"])?;
    loop {
        rows.push(row(reader)?);
        if !reader.eat("SPLINE") {
            return Ok(SurfaceShape::Mesh { restriction, rows });
        }
    }
}

/// `c1,CROSS,c2`
fn product(reader: &mut Reader<'_>, word: &str) -> Read<SurfaceShape> {
    let product = match word {
        "TRANSL" => CurveProduct::Translate,
        "SCALE" => CurveProduct::Scale,
        "XYROT" => CurveProduct::Turn(CoordinatePlane::Xy),
        "YZROT" => CurveProduct::Turn(CoordinatePlane::Yz),
        _ => CurveProduct::Turn(CoordinatePlane::Zx),
    };
    let profile = reader.curve()?;
    reader.word_or(&["CROSS"], CROSS_MISSING)?;
    Ok(SurfaceShape::Product { product, profile, control: reader.curve()? })
}

/// `{POLYGN|PNTVEC|PNTSON},{PLUS|MINUS},q1,…,q16[,{PLUS|MINUS},…]`
fn patches(reader: &mut Reader<'_>) -> Read<SurfaceShape> {
    let form = match reader.word(&["POLYGN", "PNTVEC", "PNTSON"])? {
        "POLYGN" => PatchForm::Polygon,
        "PNTVEC" => PatchForm::PointsVectors,
        _ => PatchForm::PointsOn,
    };
    let mut patches = Vec::new();
    loop {
        let sign = if reader.sense()? == Sense::Plus { 1.0 } else { -1.0 };
        let mut data = [Vec3::zeros(); PATCH_DATA];
        for (index, datum) in data.iter_mut().enumerate() {
            *datum = match form {
                PatchForm::PointsVectors if !is_corner(index) => reader.any_vector()?,
                _ => reader.point()?,
            };
        }
        patches.push((sign, data));
        if reader.peek_word().is_none_or(|word| !SENSES.contains(&word)) {
            return Ok(SurfaceShape::Patches { form, patches });
        }
    }
}

/// Whether a datum of PNTVEC is a corner of the patch: the first two of the first two rows of four.
fn is_corner(index: usize) -> bool {
    index % 4 < 2 && index / 4 < 2
}

/// `DEGREE,ku,kv,KNOTS,u-knots,KNOTS,v-knots,PTS,p,…[,WEIGHT,w,…]`
fn nurbs(reader: &mut Reader<'_>) -> Read<SurfaceShape> {
    reader.word(&["DEGREE"])?;
    let degrees = [reader.count()?, reader.count()?];
    reader.word(&["KNOTS"])?;
    let along = reader.scalars();
    reader.word(&["KNOTS"])?;
    let across = reader.scalars();
    reader.word(&["PTS"])?;
    let points = reader.points()?;
    let weights = weights(reader, points.len());
    Ok(SurfaceShape::BSpline { degrees, knots: [along, across], points, weights })
}

/// `surface,u1,u2,v1,v2`
fn converted(reader: &mut Reader<'_>) -> Read<SurfaceShape> {
    let Some(surface) =
        reader.peek().and_then(Item::geometry).filter(|geometry| geometry.kind().is_surface())
    else {
        return Err(reader.misfit(Expected::Surface));
    };
    let surface = surface.clone();
    reader.skip();
    let u = [reader.scalar()?, reader.scalar()?];
    let v = [reader.scalar()?, reader.scalar()?];
    Ok(SurfaceShape::Converted { surface, range: SurfaceRange { u, v } })
}

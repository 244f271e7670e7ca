//! Whether a path comes to the end of a surface where a motion is told that it does: by how near the end itself is to the tool.

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    motion::Relation,
    patience::Patience,
    surface::{Crease, Surface, SurfaceEdge},
};
use arelem::{MotionFailure, error::RoleName};

use crate::case::{self, Placed};

/// Places of a line at which a surface ends, evenly spread, between two of which the nearest one is closed in.
const PLACES: u32 = 128;
/// Steps of that, each to two thirds of the range.
const THIRDS: u32 = 60;

/// What a motion is told of the end of one of its surfaces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ToldEnd {
    pub(crate) role: RoleName,
    pub(crate) tip: Vec3,
}

impl ToldEnd {
    pub(crate) fn of(failure: &MotionFailure) -> Option<Self> {
        match failure {
            MotionFailure::SurfaceEnds { role, tip, .. } => Some(Self { role: *role, tip: *tip }),
            _ => None,
        }
    }
}

/// Whether a tool touches the end of a surface, which is no farther than the first distance from it, and a path leads out over that end or down
/// behind it, and not along it, or touches it from behind, so that it is on no side of the surface, by more than contact
/// turns on a tool that is led along the tangents of the end until it is the second distance, its band, off that; where all rulings meet nothing leads along it, nor does anything where the tool is ON the surface. Surfaces of which the end is not known have none.
pub(crate) fn is_over(
    placed: &Placed,
    (cutter, axis): (&Cutter, &Vec3),
    tip: &Vec3,
    [near, band]: [f64; 2],
    path: &Vec3,
) -> bool {
    let Some(Touch { edge, off_tool }) = touched(placed, (cutter, axis), tip, near) else { return false };
    let Some(edge) = edge.filter(|_| placed.relation != Relation::On) else { return true };
    let SurfaceEdge { outward, normal, along } = edge;
    let [out, behind] = [outward.dot(path), -placed.side * normal.dot(path)].map(|way| way.max(0.0));
    out.hypot(behind) > along.dot(path).abs() || is_behind(placed, cutter, &edge, &off_tool, band)
}

/// Whether a tool touches the end of a surface, no farther than the first distance from it, from behind, so that it is on no side of the surface there, with
/// the second distance, its band, as [`is_over`].
pub(crate) fn is_from_behind(
    placed: &Placed,
    (cutter, axis): (&Cutter, &Vec3),
    tip: &Vec3,
    [near, band]: [f64; 2],
) -> bool {
    let Some(Touch { edge: Some(edge), off_tool }) = touched(placed, (cutter, axis), tip, near) else {
        return false;
    };
    placed.relation != Relation::On && is_behind(placed, cutter, &edge, &off_tool, band)
}

fn is_behind(placed: &Placed, cutter: &Cutter, edge: &SurfaceEdge, off_tool: &Vec3, band: f64) -> bool {
    let turned = (2.0 * band / cutter.profile().greatest_radius()).sqrt();
    placed.side * edge.normal.dot(off_tool) > turned
}

/// Where a tool touches the end of a surface.
struct Touch {
    /// That end, where not all rulings meet.
    edge: Option<SurfaceEdge>,
    /// The direction out of the tool.
    off_tool: Vec3,
}

/// The place of the end of a surface nearest to a tool, if it is no farther from that than so much.
fn touched(placed: &Placed, (cutter, axis): (&Cutter, &Vec3), tip: &Vec3, near: f64) -> Option<Touch> {
    let surface = Surface::from_geometry(&case::surface(placed).geometry).ok()?;
    let met = surface.met_from(placed.side, Patience::default());
    let lines = met.creases_beside(&met.place(tip)?, placed.side).into_iter().flatten();
    let nearest = lines.filter_map(|(line, _)| nearest_on(met, &line, (cutter, axis), tip));
    let (distance, off_tool, place) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (distance <= near).then(|| Touch { edge: surface.edge_at(&place), off_tool })
}

/// How far the place of a line nearest to a tool is from it, the direction out of the tool there, and the place.
fn nearest_on(
    surface: &Surface,
    line: &Crease,
    (cutter, axis): (&Cutter, &Vec3),
    tip: &Vec3,
) -> Option<(f64, Vec3, Vec3)> {
    let profile = cutter.profile();
    let look = |at: f64| {
        let [place, _] = surface.on_crease(line, at)?;
        let from_tip = place - tip;
        let height = axis.dot(&from_tip);
        let across = from_tip - axis * height;
        let (distance, [wide, high]) = profile.outward(across.norm(), height);
        let radial = across.try_normalize(0.0).unwrap_or_default();
        Some((distance, radial * wide + axis * high, place))
    };
    let share = |k: u32| f64::from(k) / f64::from(PLACES);
    let distances: Option<Vec<f64>> = (0..=PLACES).map(|k| Some(look(share(k))?.0)).collect();
    let (rank, _) = distances?.into_iter().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let rank = u32::try_from(rank).ok()?;
    let (mut low, mut high) = (share(rank.saturating_sub(1)), share((rank + 1).min(PLACES)));
    for _ in 0..THIRDS {
        let [first, second] = [1.0, 2.0].map(|third| low + (high - low) * third / 3.0);
        if look(first)?.0 <= look(second)?.0 {
            high = second;
        } else {
            low = first;
        }
    }
    look(0.5 * (low + high))
}

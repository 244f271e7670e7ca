//! Clearance of the whole tool to a surface of straight rulings, or to patches in place of another surface.
//!
//! Clear of the surface it is the least distance of a place of the surface. In violation it is the least translation
//! that frees the tool (arelem reference 5.2): not less than the depth of any place of the surface in the tool, and of
//! any place of the tool under the surface; and not more than a translation after which the tool is clear.

mod past_end;
mod point;
mod skin;
mod way_out;

use apt_geometry::{Vec3, patience::Patience};

pub(super) use self::point::point;
#[cfg(test)]
pub(super) use self::point::searched_point;
use self::skin::{Circle, SECTOR};
use super::{
    clearance::Reading,
    poly_conic::ConicStrips,
    ruled::RuledStrips,
    ruling::Ruling,
    sculptured::SculpturedStrips,
    span::Bend,
    strip::{Touch, nearest},
    survey::{Accuracy, Passage, Sheet},
    tool::{Tool, perpendicular},
};

/// Accuracy of a distance, relative to the size of surface and tool.
const RESOLUTION: f64 = 2e-11;
/// The same, relative to how far the patches may be off the surface.
const RESOLUTION_OF_ERROR: f64 = 0.05;
/// Sine of the angle to the rulings below which the tool is a disc seen along them.
const PARALLEL: f64 = 1e-13;
/// Sine of the angle to the tool axis at which a normal is square to it.
const UPRIGHT: f64 = 1e-9;
/// Distance, relative to the tool, or to the surface for a point, from which on the difference of two places is a direction.
const SURE_DISTANCE: f64 = 1e-3;
/// The same relative to how exactly both places are known, where they differ across an edge of the surface.
const SURE_DIRECTION: f64 = 1e3;
/// Parameter next to the end of a piece at which the surface may have an edge.
const JOINT: f64 = 1e-7;
/// Depth, relative to the radius of the tool, up to which it is proven beyond what is meant; deeper is no question of
/// tolerance.
const PROVEN_DEPTH: f64 = 0.1;
/// Translations tried in the proof of a depth, each so many times longer.
const PROOF_STEPS: usize = 14;
const FARTHER: f64 = 4.0;
/// How far from an edge of the tool, in depths, the place is that is deepest there.
const AT_EDGE: f64 = 8.0;
/// Directions in which a tool without a body is led out, each normal to the place that held it in the last.
const DIRECTIONS: usize = 6;
/// The same for a depth that need not be the greatest yet.
const QUICK_PROOF_STEPS: usize = 2;

/// A surface made of straight rulings.
#[derive(Debug, Clone)]
pub(super) enum Ruled {
    /// A tabulated cylinder: all rulings parallel.
    Parallel(Ruling),
    /// Rulings between two curves, or to a point.
    Joining(Box<RuledStrips>),
    /// A polyconic surface, its conics joined by straight lines.
    Conics(Box<ConicStrips>),
    /// A sculptured surface.
    Sculptured(Box<SculpturedStrips>),
}

impl Ruled {
    /// The surface as a tool on a side of it meets it: where a sculptured surface ends it is taken for the face of a body.
    pub(super) fn met_from(&self, side: f64, patience: Patience<'_>) -> &Self {
        match self {
            Self::Sculptured(surface) => surface.met_from(side, patience).unwrap_or(self),
            _ => self,
        }
    }

    /// Greatest distance of its curves from the origin.
    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Parallel(ruling) => ruling.size,
            Self::Joining(surface) => surface.size,
            Self::Conics(surface) => surface.size,
            Self::Sculptured(surface) => surface.size,
        }
    }

    /// The place nearest to a tool, to within `resolution`; one deeper in it than `deep` ends the search.
    fn nearest(&self, tip: &Vec3, tool: &Tool<'_>, resolution: f64, deep: f64) -> Option<Touch> {
        match self {
            Self::Parallel(ruling) => ruling.nearest(tip, tool, resolution, deep),
            Self::Joining(surface) => nearest(&surface.sheet.patches, tip, tool, resolution, deep),
            Self::Conics(surface) => nearest(&surface.sheet.patches, tip, tool, resolution, deep),
            Self::Sculptured(surface) => nearest(&surface.sheet.patches, tip, tool, resolution, deep),
        }
    }

    /// How the slope of the clearance can grow from a position on, where no place of the tool moves farther than `travel`;
    /// `to` is the end of a straight move. None where that is not known. The clearances are without thickness.
    pub(super) fn bend(
        &self,
        side: f64,
        [from, to]: [&Vec3; 2],
        tool: &Tool<'_>,
        ends: [&Reading; 2],
        thickness: f64,
        travel: f64,
    ) -> Option<Bend> {
        let values = ends.map(|end| end.value + thickness);
        match self {
            Self::Parallel(ruling) => ruling.bend(side, [from, to], values, &ends[0].normal, tool, travel),
            Self::Joining(surface) => surface.sheet.bend(side, from, tool, values, travel, surface.size),
            Self::Conics(surface) => surface.sheet.bend(side, from, tool, values, travel, surface.size),
            Self::Sculptured(surface) => surface.sheet.bend(side, from, tool, values, travel, surface.size),
        }
    }

    /// The same by the way of the tool, as closely as is enough, where the surface is of patches.
    pub(super) fn bend_on(
        &self,
        side: f64,
        passage: &Passage<'_>,
        is_enough: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        self.sheet()?.bend_on(side, passage, self.size(), is_enough)
    }

    fn sheet(&self) -> Option<&Sheet> {
        match self {
            Self::Parallel(_) => None,
            Self::Joining(surface) => Some(&surface.sheet),
            Self::Conics(surface) => Some(&surface.sheet),
            Self::Sculptured(surface) => Some(&surface.sheet),
        }
    }

    /// The clearance by the contact of before, if it is shown.
    pub(super) fn followed(&self, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
        self.shown(side, tip, tool, true)
    }

    /// The same, perhaps only by what shows it fast.
    fn shown(&self, side: f64, tip: &Vec3, tool: &Tool<'_>, is_thorough: bool) -> Option<Reading> {
        let (size, error) = (self.size(), self.error());
        let rounding = rounding(self, tip, tool.profile.reach());
        let (mut reading, off) =
            self.sheet()?.at(side, tip, tool, (size, is_thorough), Accuracy { rounding, error })?;
        reading.error += off;
        Some(reading)
    }

    fn natural(&self, touch: &Touch) -> Option<Vec3> {
        match self {
            Self::Parallel(ruling) => ruling.natural(touch),
            Self::Joining(surface) => surface.natural(touch),
            Self::Conics(surface) => surface.natural(touch),
            Self::Sculptured(surface) => surface.natural(touch),
        }
    }

    /// A direction to the natural side at a place: the natural normal, at an edge of a sculptured surface that of all faces there.
    fn facing(&self, touch: &Touch) -> Option<Vec3> {
        match self {
            Self::Sculptured(surface) => surface.facing(touch, JOINT),
            _ => self.natural(touch),
        }
    }

    /// The common direction of all rulings.
    fn axis(&self) -> Option<Vec3> {
        match self {
            Self::Parallel(ruling) => Some(ruling.axis),
            Self::Joining(_) | Self::Conics(_) | Self::Sculptured(_) => None,
        }
    }

    /// Whether the surface may have an edge at a place.
    fn may_have_edge(&self, touch: &Touch) -> bool {
        let is_at_joint = touch.along <= JOINT || touch.along >= 1.0 - JOINT;
        match self {
            Self::Parallel(_) => is_at_joint,
            Self::Joining(surface) => is_at_joint || surface.ends_at(touch),
            Self::Conics(surface) => surface.ends_at(touch),
            Self::Sculptured(surface) => surface.is_sharp(touch, JOINT),
        }
    }

    /// Whether the surface ends at a place, so that what is beyond is on neither side of it.
    fn ends_at(&self, touch: &Touch) -> bool {
        match self {
            Self::Joining(surface) => surface.ends_at(touch),
            Self::Conics(surface) => surface.ends_at(touch),
            Self::Parallel(_) | Self::Sculptured(_) => false,
        }
    }

    /// At which of its sides the surface ends on a patch.
    fn ends(&self, piece: usize) -> [bool; 4] {
        match self {
            Self::Joining(surface) => surface.ends(piece),
            Self::Conics(surface) => surface.ends(piece),
            Self::Parallel(_) | Self::Sculptured(_) => [false; 4],
        }
    }

    /// How far the patches may be off the surface, also where they go on beyond its curves, as far as that matters to a tool that
    /// is as far away as `value`.
    fn error_near(&self, tip: &Vec3, tool: &Tool<'_>, value: f64) -> f64 {
        match self {
            Self::Joining(surface) => {
                let reach = value.max(0.0) + 2.0 * surface.greatest_error;
                surface.error * surface.sheet.stretch(tip, tool, reach).max(1.0)
            }
            _ => self.error(),
        }
    }

    /// How far the patches may be off the surface between its curves.
    pub(super) fn error(&self) -> f64 {
        match self {
            Self::Parallel(_) => 0.0,
            Self::Joining(surface) => surface.error,
            Self::Conics(surface) => surface.error,
            Self::Sculptured(surface) => surface.error,
        }
    }
}

fn rounding(surface: &Ruled, tip: &Vec3, reach: f64) -> f64 {
    RESOLUTION * (surface.size().max(tip.norm()) + reach)
}

fn resolution(surface: &Ruled, tip: &Vec3, reach: f64) -> f64 {
    rounding(surface, tip, reach).max(RESOLUTION_OF_ERROR * surface.error())
}

fn point_distance(surface: &Ruled, x: &Vec3, patience: Patience<'_>) -> Option<(f64, Vec3)> {
    point(surface, x, patience).map(|found| (found.value, found.normal))
}

struct Bodies<'a> {
    surface: &'a Ruled,
    side: f64,
    tool: &'a Tool<'a>,
    reach: f64,
    resolution: f64,
    /// Depth up to which a violation is measured exactly.
    deep: f64,
}

/// The clearance; None beyond the end of a curve.
pub(super) fn at(surface: &Ruled, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
    if let Some(axis) = surface.axis()
        && tool.axis.cross(&axis).norm() <= PARALLEL
    {
        let (distance, normal) = point_distance(surface, tip, tool.patience)?;
        let error = resolution(surface, tip, 0.0);
        let value = side * distance - tool.profile.widest();
        return Some(Reading::new(value, normal * side, error));
    }
    if let Some(found) = beside(surface, side, tip, tool) {
        return Some(found);
    }
    // The nearest place is found sooner than what takes long shows anything from a contact that was another.
    if let Some(found) = surface.shown(side, tip, tool, false) {
        return Some(found);
    }
    let bodies = Bodies::of(surface, side, tool, tip);
    let touch = bodies.touch(tip)?;
    // From the nearest place, now that it is known, the contact may be followed.
    let known = surface.sheet().is_some_and(|sheet| sheet.look_at(&touch.point, tool));
    let found = known.then(|| surface.followed(side, tip, tool)).flatten();
    found.or_else(|| bodies.settled(tip, &touch))
}

/// The clearance of a tool that stands along the straight lines of a sculptured surface: where both ends of the tool are beside
/// it, all of the tool is, and it is a disc.
fn beside(surface: &Ruled, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
    let Ruled::Sculptured(strips) = surface else { return None };
    if tool.axis.cross(&strips.ruling?).norm() > PARALLEL {
        return None;
    }
    let top = tip + tool.axis * tool.profile.top_height();
    let (distance, normal) = point_distance(surface, tip, tool.patience)?;
    let (above, other) = point_distance(surface, &top, tool.patience)?;
    let error = resolution(surface, tip, tool.profile.reach());
    let level = [normal, other].iter().all(|n| n.dot(&tool.axis).abs() <= UPRIGHT);
    let value = side * distance - tool.profile.widest();
    let error = error + surface.error();
    (level && (above - distance).abs() <= 2.0 * error).then_some(Reading::new(value, normal * side, error))
}

/// The clearance without regard to what was found before.
#[cfg(test)]
pub(super) fn searched(surface: &Ruled, side: f64, tip: &Vec3, tool: &Tool<'_>) -> Option<Reading> {
    let bodies = Bodies::of(surface, side, tool, tip);
    bodies.settled(tip, &bodies.touch(tip)?)
}

impl<'a> Bodies<'a> {
    fn of(surface: &'a Ruled, side: f64, tool: &'a Tool<'a>, tip: &Vec3) -> Self {
        let reach = tool.profile.reach();
        let deep = PROVEN_DEPTH * tool.profile.widest() + tool.depth;
        Self { surface, side, tool, reach, resolution: resolution(surface, tip, reach), deep }
    }

    /// The clearance by the nearest place.
    fn settled(&self, tip: &Vec3, touch: &Touch) -> Option<Reading> {
        let clear = self.is_on_side(touch)?;
        // A tool without a body is nowhere deep in the surface: where it is not clear for certain, its places are looked at.
        let mut reading = if touch.value > touch.gap && clear {
            Reading {
                place: Some(touch.opposite() - tip),
                ..Reading::new(touch.value, self.away(touch)?, touch.gap)
            }
        } else {
            self.violation(tip, touch)?
        };
        reading.error += self.surface.error_near(tip, self.tool, reading.value + reading.error);
        Some(reading)
    }

    fn touch(&self, tip: &Vec3) -> Option<Touch> {
        self.surface.nearest(tip, self.tool, self.resolution, self.deep)
    }

    /// The direction that leads the tool away. Next to a sharp edge of the tool the difference of two places says little;
    /// the surface's own normal does, but where the surface has an edge; where tool and edge all but touch, that of either face.
    fn away(&self, touch: &Touch) -> Option<Vec3> {
        let normal = self.surface.natural(touch)? * self.side;
        let far = touch.value.abs() > SURE_DISTANCE * self.reach;
        let is_told = touch.value.abs() > SURE_DIRECTION * self.resolution;
        Some(if far || is_told && self.surface.may_have_edge(touch) { -touch.outward } else { normal })
    }

    /// Whether the tool is on its side of the surface where it is nearest.
    fn is_on_side(&self, touch: &Touch) -> Option<bool> {
        Some(
            self.surface.ends_at(touch) || self.side * touch.outward.dot(&self.surface.facing(touch)?) <= 0.0,
        )
    }

    fn violation(&self, tip: &Vec3, touch: &Touch) -> Option<Reading> {
        if self.tool.profile.widest() <= 0.0
            && let Some(found) = self.led_out_in_parts(tip, touch)?
        {
            return Some(found);
        }
        // What of the tool is under the surface by more comes out past the end by less.
        match self.past_end(tip, touch, || self.depth_of_violation(tip, touch))? {
            Some(found) => Some(found),
            None => self.depth_of_violation(tip, touch),
        }
    }

    /// The clearance of a tool that the surface is in, without regard to where that ends.
    fn depth_of_violation(&self, tip: &Vec3, touch: &Touch) -> Option<Reading> {
        let mut deepest = Deepest { depth: -touch.value, out: self.away(touch)?, place: touch.opposite() };
        let depth_of = |found: &Deepest, error: f64| Reading {
            place: Some(found.place - tip),
            ..Reading::new(-found.depth, found.out, error)
        };
        // Each depth found is a lower bound; the first that also frees the tool is the answer. First that of the surface in
        // the tool, then that of the tool's edges under the surface near there, then all round.
        // No place is deep in a tool without a body.
        let shallow = touch.value <= touch.gap && deepest.depth <= self.deep;
        // Under an edge the surface is less deep in the tool than the edge is under the surface.
        let under_edge = shallow && self.is_at_edge(tip, touch);
        if under_edge {
            self.deepest_beside(tip, touch, &mut deepest)?;
        }
        if shallow && let Some(error) = self.unproven(tip, &deepest, QUICK_PROOF_STEPS)? {
            return Some(depth_of(&deepest, error));
        }
        // Deeper than that is no question of tolerance.
        let top = tip + self.tool.axis * self.reach;
        for place in [*tip, (tip + top) * 0.5] {
            let depth = self.depth(&place)?;
            if depth.depth > deepest.depth && self.tool.distance(&(place - tip)) <= 0.0 {
                deepest = depth;
            }
        }
        if deepest.depth > self.deep {
            return Some(depth_of(&deepest, 0.0));
        }
        if shallow && !under_edge {
            self.deepest_beside(tip, touch, &mut deepest)?;
            if let Some(error) = self.unproven(tip, &deepest, QUICK_PROOF_STEPS)? {
                return Some(depth_of(&deepest, error));
            }
        }
        let circle = Circle::of(tip, self.tool, perpendicular(&self.tool.axis));
        for p in self.edges() {
            self.edge(&circle, p, &mut deepest)?;
        }
        self.faces_by(tip, &mut deepest)?;
        if deepest.depth > self.deep {
            return Some(depth_of(&deepest, 0.0));
        }
        // Of a tool without a body that says nothing: no place of the surface is deep in it.
        let has_body = self.tool.profile.widest() > 0.0;
        if has_body
            && shallow
            && let Ruled::Parallel(ruling) = self.surface
        {
            let ways = [deepest.depth + self.close(), self.resolution];
            if ruling.is_left_behind(self.side, tip, self.tool, ways)? {
                return Some(depth_of(&deepest, self.close()));
            }
        }
        if has_body && shallow && self.is_left_behind(tip, &deepest)? {
            return Some(depth_of(&deepest, 4.0 * self.close()));
        }
        let error = self.unproven(tip, &deepest, PROOF_STEPS)?.unwrap_or(self.reach);
        Some(depth_of(&deepest, error))
    }

    /// Looks for deeper places of the tool's edges on the side of it where it is nearest.
    fn deepest_beside(&self, tip: &Vec3, touch: &Touch, deepest: &mut Deepest) -> Option<()> {
        let Some(circle) = self.circle_beside(tip, touch) else { return Some(()) };
        for p in self.edges() {
            self.deepest_near(&circle, p, [-0.5 * SECTOR, 0.5 * SECTOR], deepest)?;
        }
        Some(())
    }

    /// Whether the place that is deepest in the tool is by an edge of it, as far as it is deep.
    fn is_at_edge(&self, tip: &Vec3, touch: &Touch) -> bool {
        let Some(circle) = self.circle_beside(tip, touch) else { return false };
        let close = AT_EDGE * touch.value.abs();
        self.tool.profile.edges().iter().any(|p| (circle.place(*p, 0.0) - touch.point).norm() <= close)
    }

    /// The edge circles, from the azimuth of the nearest place on; None where that is on the axis.
    fn circle_beside(&self, tip: &Vec3, touch: &Touch) -> Option<Circle> {
        let contact = touch.point - tip;
        let across = contact - self.tool.axis * self.tool.axis.dot(&contact);
        let size = across.norm();
        (size > 0.0).then(|| Circle::of(tip, self.tool, across / size))
    }
}

/// A place of the tool under the surface, or across from one of the surface in the tool.
#[derive(Debug, Clone, Copy)]
struct Deepest {
    depth: f64,
    /// Unit direction out.
    out: Vec3,
    place: Vec3,
}

//! Parts of parametric surfaces with bounds that hold over all of them: of their extent, their curvature and the turn of
//! their normal. Parts are halved where a question needs closer bounds; what was found stays with them.

mod body;
mod bounds;
mod extent;
mod form;
mod kept;
mod rulings;

use self::{
    bounds::{Bounds, CLOSE},
    form::Bent,
};
pub(super) use self::{
    extent::Extent,
    form::{Forms, leading},
    kept::{Count, Later},
};
pub use self::{
    form::{Form, LENGTHWISE, Lengthwise},
    rulings::Lying,
};
use super::{
    bend::{Bend, parallel_bend},
    chart::Facing,
    interval::{Box3, Interval},
    sheet::Jet,
};
use crate::{Vec3, patience::Patience};

/// Sag of a part, relative to its radius, that no bound needs to tell from flat.
pub(super) const FLAT: f64 = 1e-5;
/// Size of a part, as a share of the reach of a question, from which on it is not halved.
pub(super) const FINE: f64 = 0.125;
/// Curvature times reach that is of no account for a sheet that is asked about as a whole.
const FAINT: f64 = 0.1;
/// Cosine of the angle of normals that a sheet that is asked about as a whole needs no closer bound of, and size of a part, as a
/// share of the reach, from which on it is not halved for one: what a part turns counts for all of it.
const UPRIGHT: f64 = 0.9;
const SMALL: f64 = 0.25;
/// Cosine of the angle between normals up to which a sheet counts as one that faces one way.
pub(super) const LEAST_COSINE: f64 = 0.5;
/// Bound of the halvings of a part.
const MAX_DEPTH: u32 = 24;
/// Bound of the parts that one question looks at.
const MAX_PARTS: u32 = 3000;

/// What the bounds of a part that are not known yet count in units of work.
const WORK_OF_PART: u32 = 16;
/// How many nodes above parts are one unit of work.
const NODES_A_UNIT: u32 = 8;

/// Parts of a surface that are kept, some 160 MB of them: those beyond are made for each question that needs them.
const MOST_KEPT: usize = 400_000;

/// A rectangle of parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rectangle {
    pub(super) middle: [f64; 2],
    /// Half its sides.
    pub(super) half: [f64; 2],
}

impl Rectangle {
    pub(super) fn between(u: [f64; 2], v: [f64; 2]) -> Self {
        let of = |f: fn([f64; 2]) -> f64| [f(u), f(v)];
        Self { middle: of(|r| 0.5 * (r[0] + r[1])), half: of(|r| 0.5 * (r[1] - r[0])) }
    }

    /// Both halves of one side.
    pub(super) fn halves(&self, side: usize) -> [Self; 2] {
        [-0.5, 0.5].map(|sense| {
            let mut part = *self;
            part.half[side] *= 0.5;
            part.middle[side] += sense * self.half[side];
            part
        })
    }

    /// First and last parameter of a side.
    pub(super) fn range(&self, side: usize) -> [f64; 2] {
        [self.middle[side] - self.half[side], self.middle[side] + self.half[side]]
    }
}

/// The partial derivatives in the middle of a rectangle, and the second ones over all of it.
#[derive(Debug, Clone)]
pub(super) struct Enclosure {
    pub(super) jet: Jet,
    pub(super) duu: Box3,
    pub(super) duv: Box3,
    pub(super) dvv: Box3,
    /// No place of the rectangle is farther from that in its middle; infinite if that is best told by the derivatives.
    pub(super) reach: f64,
    /// Whether there is an edge or a crease that stands out to the natural side, or to the other.
    pub(super) sharp: [bool; 2],
    /// Whether the surface ends in the rectangle, or its natural normal turns over.
    pub(super) ends: bool,
    /// Whether an edge or a crease may lie anywhere in it, not at its sides alone, so that the derivatives do not tell how far its
    /// places are from those of the middle.
    pub(super) split: bool,
}

impl Enclosure {
    /// The second derivative of curves over the rectangle along which both parameters change evenly, by this from their beginning to their end.
    pub(super) fn bent(&self, [u, v]: [f64; 2]) -> Box3 {
        self.duu.scaled(u * u).plus(&self.duv.scaled(2.0 * u * v)).plus(&self.dvv.scaled(v * v))
    }

    /// Where nothing is known but the middle.
    pub(super) fn unknown(jet: Jet) -> Self {
        let all = Box3([Interval::about(0.0, f64::INFINITY); 3]);
        Self {
            jet,
            duu: all,
            duv: all,
            dvv: all,
            reach: f64::INFINITY,
            sharp: [true; 2],
            ends: true,
            split: true,
        }
    }
}

/// A surface whose derivatives can be enclosed.
pub(super) trait Enclose {
    fn enclose(&self, rectangle: &Rectangle) -> Enclosure;

    /// The place in the middle of a rectangle with its derivatives.
    fn middle_of(&self, rectangle: &Rectangle) -> Jet;

    /// The number of parts that were made.
    fn parts(&self) -> &Count;

    /// Whether a rectangle has a side that is one point, about which the parameters say nothing of curvature and normals.
    fn has_pole(&self, _: &Rectangle) -> bool {
        false
    }

    /// Bounds over such a rectangle.
    fn cap(&self, _: &Rectangle) -> Option<Cap> {
        None
    }
}

/// Bounds about a pole.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cap {
    /// Greatest curvature seen from the natural side, and from the other.
    pub(super) curvature: [f64; 2],
    /// No natural normal differs from that in the middle by a longer vector.
    pub(super) spread: f64,
}

/// Bounds over a part of a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    rectangle: Rectangle,
    extent: Extent,
    /// Greatest curvature seen from the natural side (positive where the surface curves away from it), and from the other.
    curvature: [f64; 2],
    /// The same in the middle.
    least: [f64; 2],
    /// Excess of the bounds that is close enough.
    close: f64,
    /// No natural normal differs from that in the middle by a longer vector.
    spread: f64,
    /// Whether the surface ends here.
    ends: bool,
    /// Whether no place bends much more than the middle, so that the bounds of how the part bends serve pieces that are cut from it.
    is_even: bool,
    /// The side to halve, if that is not a matter of trial.
    halved: Option<usize>,
    halves: Later<Box<[Part; 2]>>,
    /// Those of each side, where it counts how far they are from a body and not how the surface bends.
    shorter: [Later<Box<[Part; 2]>>; 2],
    /// The forms of all its places, where it is smooth and does not end.
    form: Later<Option<Box<Bent>>>,
}

/// Bounds over one or several parts as wholes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Summary {
    /// Greatest curvature seen from the natural side, and from the other.
    curvature: [f64; 2],
    /// A unit vector near all natural normals, if every part has some.
    normal: Option<Vec3>,
    /// No natural normal differs from that by a longer vector.
    spread: f64,
    /// Whether the surface ends here.
    ends: bool,
}

impl Summary {
    /// That of a part.
    pub(super) fn of(part: &Part) -> Self {
        let Part { curvature, extent, spread, ends, .. } = part;
        Self { curvature: *curvature, normal: extent.normal, spread: *spread, ends: *ends }
    }

    /// Those of two places as one.
    pub(super) fn and(&self, other: &Self) -> Self {
        let middle = self.normal.zip(other.normal).and_then(|(a, b)| (a + b).try_normalize(0.0));
        let spread = |one: &Self, middle: &Vec3| {
            one.normal.map_or(f64::INFINITY, |normal| one.spread + (normal - middle).norm())
        };
        Self {
            curvature: [0, 1].map(|k: usize| self.curvature[k].max(other.curvature[k])),
            normal: middle,
            spread: middle.map_or(f64::INFINITY, |n| spread(self, &n).max(spread(other, &n))),
            ends: self.ends || other.ends,
        }
    }

    /// Greatest curvature seen from a side.
    pub(super) fn curvature(&self, side: f64) -> f64 {
        if side > 0.0 { self.curvature[0] } else { self.curvature[1] }
    }
}

/// What is asked of a surface about the places of a ball, and what has been found.
#[derive(Debug)]
pub(super) struct Survey<'a> {
    center: Vec3,
    radius: f64,
    /// How far from the centre the nearest places of the surface can be.
    reach: f64,
    /// The side of the natural normal that it is seen from.
    side: f64,
    normal: Vec3,
    seen: u32,
    nodes: u32,
    /// Greatest curvature within reach.
    curvature: f64,
    /// The same as seen from the other side, if that is asked too; it need not be close.
    behind: f64,
    /// Least cosine between the normal asked about and those within reach that may be seen from the other side.
    cosine: f64,
    /// Whether the signed distance may jump from one side to the other.
    jumps: bool,
    /// Least cosine that is taken for facing one way.
    least_cosine: f64,
    /// Whether parts that cannot be beyond the ball count like the others.
    strict: bool,
    /// A curvature up to which bounds are close enough.
    enough: f64,
    /// What is asked of the forms of all parts within reach, if that is and nothing else.
    forms: Forms,
    /// How long parts may be looked at; of a survey that is given up nothing is known.
    patience: Patience<'a>,
}

impl<'a> Survey<'a> {
    /// Asks about the surface within reach of the points of a ball, as seen from a side; `normal` is that at the foot of its
    /// centre.
    pub(super) fn new(
        center: &Vec3,
        [radius, reach]: [f64; 2],
        (side, normal): (f64, &Vec3),
        patience: Patience<'a>,
    ) -> Self {
        Self {
            center: *center,
            radius,
            reach,
            side,
            normal: *normal,
            seen: 0,
            nodes: 0,
            curvature: f64::NEG_INFINITY,
            behind: f64::NEG_INFINITY,
            cosine: 1.0,
            jumps: false,
            least_cosine: LEAST_COSINE,
            strict: false,
            enough: f64::NEG_INFINITY,
            forms: Forms::NotAsked,
            patience,
        }
    }

    /// Asks about all of the surface within reach of a point, which must face one way: the normals have at least a cosine
    /// to the given one.
    pub(super) fn of_sheet(
        center: &Vec3,
        reach: f64,
        seen: (f64, &Vec3),
        least_cosine: f64,
        patience: Patience<'a>,
    ) -> Self {
        let enough = FAINT / reach;
        Self { least_cosine, strict: true, enough, ..Self::new(center, [0.0, reach], seen, patience) }
    }

    /// The same question in the coordinates of a surface.
    pub(super) fn within(self, center: Vec3, turned: impl Fn(&Vec3) -> Vec3) -> Self {
        let normal = turned(&self.normal);
        let forms = self.forms.turned(turned);
        Self { center, normal, forms, ..self }
    }

    /// What was found of a sheet, unless the surface ends or turns away within reach.
    pub(super) fn facing(&self) -> Option<Facing> {
        let (seen, behind) = (self.curvature, self.behind);
        let curvature = if self.side > 0.0 { [seen, behind] } else { [behind, seen] };
        (!self.jumps).then_some(Facing { curvature, cosine: self.cosine })
    }

    pub(super) fn center(&self) -> &Vec3 {
        &self.center
    }

    pub(super) fn reach(&self) -> f64 {
        self.reach
    }

    pub(super) fn side(&self) -> f64 {
        self.side
    }

    /// Whether parts with such bounds as wholes add nothing to what has been found.
    pub(super) fn is_settled_by(&self, parts: &Summary) -> bool {
        self.jumps || self.has(parts, self.cosine_of(parts))
    }

    /// Least cosine between the normals of parts and the one asked about.
    fn cosine_of(&self, parts: &Summary) -> f64 {
        parts.normal.map_or(-1.0, |normal| normal.dot(&self.normal) - parts.spread)
    }

    /// Whether what has been found is no less than parts with normals of at least a cosine.
    fn has(&self, parts: &Summary, cosine: f64) -> bool {
        matches!(self.forms, Forms::NotAsked)
            && parts.curvature(self.side) <= self.curvature
            && cosine >= self.cosine
            && !parts.ends
            && cosine >= self.least_cosine
            && (!self.strict || parts.curvature(-self.side) <= self.behind)
    }

    /// Bound of the second derivatives of the distance over places at least `nearest` from the surface (negative: so far
    /// beyond it).
    ///
    /// Beyond the surface the nearest place must not jump. It does not while all normals within reach, and on the paths between
    /// feet, point the same way within an angle and no place is so far beyond as two feet of one place need: see
    /// [`Surface::steady`](super::Surface::steady). Before the surface a jump of the nearest place lets the slope only
    /// fall, but to places that face the other way.
    pub(super) fn bend(&self, nearest: f64) -> Bend {
        let far = if nearest > 0.0 { 1.0 / nearest } else { f64::INFINITY };
        let beyond = nearest.min(0.0);
        let facing = Facing { curvature: [self.curvature; 2], cosine: self.cosine };
        let alone =
            self.cosine >= LEAST_COSINE && 1.0 + beyond * self.curvature.max(0.0) * facing.lean() > 0.0;
        if self.jumps || beyond < 0.0 && !alone {
            return Bend::Unbounded;
        }
        let near = if self.curvature.is_finite() { parallel_bend(self.curvature, nearest) } else { far };
        let least = if self.curvature == f64::NEG_INFINITY { 0.0 } else { near.min(far) };
        if least.is_finite() { Bend::AtMost(least) } else { Bend::Unbounded }
    }

    /// How far from the feet of a point at a depth beyond the surface the path between them can reach, if the surface faces
    /// one way.
    pub(super) fn beside(&self, depth: f64) -> Option<f64> {
        let cosine = self.cosine;
        let faces = !self.jumps && cosine >= LEAST_COSINE;
        faces.then(|| 2.0 * depth * (1.0 - cosine * cosine).max(0.0) / cosine)
    }

    /// Counts a part; whether the survey is given up with it.
    fn is_given_up(&mut self) -> bool {
        self.seen += 1;
        self.counts(1);
        self.jumps
    }

    /// Counts work; a survey that is given up with it tells no more than one of a surface that ends.
    fn counts(&mut self, work: u32) {
        self.jumps |= self.patience.ends_after(work);
    }

    /// Counts a node above the parts.
    pub(super) fn counts_node(&mut self) {
        self.nodes += 1;
        if self.nodes.is_multiple_of(NODES_A_UNIT) {
            self.counts(1);
        }
    }

    /// Counts the bounds of a part that are made.
    pub(super) fn counts_part(&mut self) {
        self.counts(WORK_OF_PART);
    }

    /// Whether a part faces the ball, so that no point of it can be beyond that part.
    fn faced_by(&self, part: &Part) -> bool {
        let height = part
            .extent
            .normal
            .map_or(f64::NEG_INFINITY, |n| self.side * n.dot(&(self.center - part.extent.center)));
        height > self.radius + part.extent.sag + self.reach * part.spread
    }
}

impl Part {
    pub(super) fn new(sheet: &impl Enclose, rectangle: Rectangle) -> Self {
        let enclosure = sheet.enclose(&rectangle);
        let [hu, hv] = rectangle.half;
        let Enclosure { jet, sharp, ends, split, .. } = &enclosure;
        let mut bounds = Bounds::of(&enclosure, rectangle.half);
        let extent = Extent::of_part(&enclosure, rectangle.half, bounds.normal);
        let is_even = !split && bounds.is_even(FLAT / extent.radius);
        if let Some(Cap { curvature, spread }) = sheet.cap(&rectangle) {
            bounds = Bounds { curvature, least: curvature, spread, ..bounds };
        }
        for (curvature, sharp) in bounds.curvature.iter_mut().zip(sharp) {
            if *sharp || curvature.is_nan() {
                *curvature = f64::INFINITY;
            }
        }
        // What stands out sharply is told from the rest by its place; and about a pole narrow parts have no closer bounds than wide ones
        // that reach as far from it.
        let lengths = [jet.du.norm() * hu, jet.dv.norm() * hv];
        let by_place = sharp.contains(&true) || sheet.has_pole(&rectangle);
        let tried = !by_place && bounds.curvature.iter().all(|k| k.is_finite());
        let sizes = if by_place { lengths } else { bounds.loose };
        Self {
            rectangle,
            extent,
            curvature: bounds.curvature,
            least: bounds.least,
            close: bounds.close.max(FLAT / extent.radius),
            spread: bounds.spread,
            ends: *ends,
            is_even,
            halved: (!tried).then_some(usize::from(sizes[1] > sizes[0])),
            halves: Later::new(),
            shorter: [Later::new(), Later::new()],
            form: Later::new(),
        }
    }

    /// Both halves: of the side whose halves have the closer bounds.
    fn halved(&self, sheet: &impl Enclose) -> [Self; 2] {
        sheet.parts().add(2);
        let cut = |side: usize| self.rectangle.halves(side).map(|half| Self::new(sheet, half));
        if let Some(side) = self.halved {
            return cut(side);
        }
        let [first, second] = [0, 1].map(cut);
        let excess = |parts: &[Self; 2]| {
            let of = |part: &Self| (part.curvature[0] - part.least[0]).max(part.curvature[1] - part.least[1]);
            of(&parts[0]).max(of(&parts[1]))
        };
        if excess(&first) <= excess(&second) { first } else { second }
    }

    pub(super) fn center(&self) -> &Vec3 {
        &self.extent.center
    }

    pub(super) fn radius(&self) -> f64 {
        self.extent.radius
    }

    /// Whether no natural normal differs from that in the middle by a longer vector.
    pub(super) fn turns_at_most(&self, chord: f64) -> bool {
        self.spread <= chord
    }

    /// No place of the part is nearer to a point than this.
    pub(super) fn bound(&self, p: &Vec3) -> f64 {
        self.extent.bound(p)
    }

    /// Whether it is known, from its size and the planes that it lies between, that no place of the part is within a distance of a straight
    /// piece.
    pub(super) fn is_off(&self, ends: &[Vec3; 2], distance: f64) -> bool {
        self.extent.is_off(ends, distance)
    }

    /// Adds what this part means for a question.
    pub(super) fn survey(&self, sheet: &impl Enclose, survey: &mut Survey<'_>) {
        self.survey_within(sheet, survey, 0);
    }

    fn survey_within(&self, sheet: &impl Enclose, survey: &mut Survey<'_>, depth: u32) {
        if survey.jumps {
            return;
        }
        if !matches!(survey.forms, Forms::NotAsked) {
            return self.survey_forms(sheet, survey, depth);
        }
        if survey.is_given_up() {
            return;
        }
        if (self.extent.center - survey.center).norm() > survey.reach + self.extent.radius {
            return;
        }
        let [seen, behind] = if survey.side > 0.0 { [0, 1] } else { [1, 0] };
        let bound = self.curvature[seen];
        let faced = !survey.strict && survey.faced_by(self);
        let all = Summary { ends: self.ends && !faced, ..Summary::of(self) };
        let cosine = if faced { 1.0 } else { survey.cosine_of(&all) };
        if survey.has(&all, cosine) {
            return;
        }
        let jumps = all.ends || cosine < survey.least_cosine;
        let is_close = |side: usize, known: f64| {
            self.curvature[side] <= (self.least[side] + self.close).max(survey.enough).max(known)
        };
        let upright = cosine >= survey.cosine.min(UPRIGHT) || self.extent.radius <= SMALL * survey.reach;
        let whole = !survey.strict || upright && is_close(behind, survey.behind);
        let close = is_close(seen, f64::NEG_INFINITY) && !jumps && whole;
        let fine =
            self.extent.radius <= FINE * survey.reach || depth >= MAX_DEPTH || survey.seen >= MAX_PARTS;
        if close || fine {
            survey.curvature = survey.curvature.max(bound);
            survey.behind = survey.behind.max(self.curvature[behind]);
            survey.cosine = survey.cosine.min(cosine);
            survey.jumps |= jumps;
        } else {
            self.survey_halves(sheet, survey, depth);
        }
    }

    fn survey_halves(&self, sheet: &impl Enclose, survey: &mut Survey<'_>, depth: u32) {
        if self.halves.made().is_none() {
            survey.counts(2 * WORK_OF_PART);
        }
        self.for_halves(sheet, |half| half.survey_within(sheet, survey, depth + 1));
    }

    fn for_halves(&self, sheet: &impl Enclose, look: impl FnMut(&Self)) {
        match self.halves.made() {
            None if sheet.parts().get() >= MOST_KEPT => self.halved(sheet).iter().rev().for_each(look),
            _ => self.halves.get(|| Box::new(self.halved(sheet))).iter().rev().for_each(look),
        }
    }
}

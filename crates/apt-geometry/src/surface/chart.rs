//! Tabulated cylinders, ruled and polyconic surfaces about one of their places: parameters to begin a search for contact
//! with, derivatives by them, and balls about which it is known that such a search finds the nearest place.

use super::{
    Surface,
    bend::parallel_bend,
    part::{Form, Lengthwise, Lying, Survey, leading},
    sheet::Jet,
};
use crate::{Vec3, patience::Patience};

/// Cosine of the angle to the middle normal up to which normals may turn within a steady ball.
const STEADY_COSINE: f64 = 0.5;
/// How much farther than the places of a ball the paths between them are expected to reach at first; and how much less the
/// cosine is expected to be over them where that is not far enough.
const WIDER: f64 = 1.25;
const STEEPER: f64 = 0.1;
/// How often a wider region is looked at if the paths reach out of one, and how much wider than they are foreseen to reach.
const WIDENINGS: u32 = 3;
const FURTHER: f64 = 1.02;
/// Bound of the trials in which that is foreseen.
const MOST_FORESEEN: u32 = 16;

/// A place of a tabulated cylinder, ruled, polyconic or sculptured surface by its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    pub(super) piece: usize,
    pub(super) at: [f64; 2],
}

/// A surface about one of its places: the point with its derivatives by both parameters, in program coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chart {
    /// The point.
    pub point: Vec3,
    /// First derivatives.
    pub first: [Vec3; 2],
    /// Second derivatives: by the first parameter twice, by both, by the second twice.
    pub second: [Vec3; 3],
    /// Makes `first[0] × first[1]` point to the natural side: 1 or −1.
    pub sense: f64,
    /// How far the surface that distances are measured from is off this one, along the natural normal.
    pub thickness: f64,
}

impl Chart {
    pub(super) fn new(jet: &Jet, sense: f64, thickness: f64) -> Self {
        Self {
            point: jet.point,
            first: [jet.du, jet.dv],
            second: [jet.duu, jet.duv, jet.dvv],
            sense,
            thickness,
        }
    }
}

/// What is known of the distance over a ball in which each point has one nearest place of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steady {
    /// Greatest curvature towards the points of the ball, not negative.
    hollow: f64,
    /// Greatest curvature away from them, not negative; infinite over an edge.
    round: f64,
    /// Greatest distance from the surface for which this is known.
    depth: f64,
    /// What the surface of the charts is farther away.
    stock: f64,
    /// Depth beyond the surface up to which points of the ball have one nearest place, too.
    pub beyond: f64,
}

impl Steady {
    /// How strongly the distance may fall below its tangent in the ball, from a place at a given distance: at a vector x from
    /// there it is at least `distance + n·x − bend·x²/2`, n being its gradient there.
    ///
    /// The second derivative along a line is at least `−(1 − d′²) κ/(1 − dκ)`. So `r = 1/κ − d` has `(r²)″ ≤ 2`: the
    /// surface is nowhere nearer than a sphere of curvature κ that touches it at the foot.
    pub fn bend(&self, distance: f64) -> f64 {
        parallel_bend(self.hollow, -(distance + self.stock))
    }

    /// Greatest second derivative along any line of the distance of points in the ball that are at least `nearest` from the
    /// surface (negative: no deeper beyond it), if there is a bound.
    ///
    /// With one nearest place for each point it is at most `κ/(1 + dκ)` at a distance d, κ being the greatest curvature
    /// away from the point at that place.
    pub fn upward_bend(&self, nearest: f64) -> Option<f64> {
        let bend = parallel_bend(self.round, nearest + self.stock);
        (-nearest <= self.beyond.min(self.depth) && bend.is_finite()).then_some(bend)
    }
}

/// What a search over the surface near a ball found.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facing {
    /// Greatest curvature as seen from the natural side and from the other.
    pub(super) curvature: [f64; 2],
    /// Least cosine between a normal there and a given one.
    pub(super) cosine: f64,
}

impl Facing {
    /// How much less deep than the shortest radius of curvature points with one nearest place are: see [`Surface::steady`].
    pub(super) fn lean(&self) -> f64 {
        let cosine = self.cosine;
        (1.0 + (1.0 - cosine * cosine).max(0.0) / cosine) / cosine
    }
}

impl Surface {
    /// Whether places have charts.
    pub fn has_charts(&self) -> bool {
        matches!(self, Self::Tabulated(_) | Self::Ruled(_) | Self::PolyConic(_) | Self::Sculptured(_))
    }

    /// The nearest place, for the kinds of surface that have charts.
    pub fn place(&self, p: &Vec3) -> Option<Place> {
        match self {
            Self::Tabulated(curve) => Some(curve.place_near(p)),
            Self::Ruled(sheet) => Some(sheet.place_near(p)),
            Self::PolyConic(sheet) => Some(sheet.place_near(p)),
            Self::Sculptured(sheet) => Some(sheet.place_near(p)),
            _ => None,
        }
    }

    /// The surface about a place.
    pub fn chart(&self, place: &Place) -> Option<Chart> {
        match self {
            Self::Tabulated(curve) => curve.chart(place),
            Self::Ruled(sheet) => sheet.chart(place),
            Self::PolyConic(sheet) => sheet.chart(place),
            Self::Sculptured(sheet) => sheet.chart(place),
            _ => None,
        }
    }

    /// The chart of a place at a step from that of another chart so short that third derivatives change nothing.
    pub fn chart_beside(
        &self,
        place: &Place,
        (last, chart): (&Place, &Chart),
        [u, v]: [f64; 2],
    ) -> Option<Chart> {
        if place.piece != last.piece {
            return self.chart(place);
        }
        let ([du, dv], [duu, duv, dvv]) = (chart.first, chart.second);
        let (along, across) = (duu * u + duv * v, duv * u + dvv * v);
        let point = chart.point + (du + along * 0.5) * u + (dv + across * 0.5) * v;
        Some(Chart { point, first: [du + along, dv + across], ..*chart })
    }

    /// The place at other parameters; `None` beyond the end of the surface and where its natural side turns over.
    pub fn shifted(&self, place: &Place, step: [f64; 2]) -> Option<Place> {
        match self {
            Self::Tabulated(curve) => curve.shifted(place, step),
            Self::Ruled(sheet) => sheet.shifted(place, step),
            Self::PolyConic(sheet) => sheet.shifted(place, step),
            Self::Sculptured(sheet) => sheet.shifted(place, step),
            _ => None,
        }
    }

    /// Bounds over the points of a ball that are at most `depth` from the surface on one side, if each of them has one
    /// nearest place that never jumps, and no other place within the ball whose normal leads to it. The centre must be on
    /// that side. The surface must not cut through itself.
    ///
    /// Two nearest places `p = c₁ + d n₁ = c₂ + d n₂` are no more than `2d√(1 − c²)` apart if all normals about keep a cosine
    /// `c` to the middle one. The sheet about each of them goes on over both, as seen along the middle normal; were one
    /// of two sheets above the other, the way from the lower place to p would cross it. So both are on one sheet,
    /// and the path between them that is straight as seen along the middle normal leads through a place where distance
    /// bends downward; none does up to a depth of `c/(κ (1 + (1 − c²)/c))`. As no part of the path is steeper than the normals let
    /// it be, it is nowhere farther from the straight line between its ends than half its length times that slope.
    pub fn steady(
        &self,
        side: f64,
        center: &Vec3,
        [radius, depth]: [f64; 2],
        patience: Patience<'_>,
    ) -> Option<Steady> {
        if !self.has_charts() {
            return None;
        }
        let stock = self.stock(side);
        let foot = self.foot(center);
        if side * foot.distance + stock < 0.0 {
            return None;
        }
        let far = (depth + stock).max(0.0);
        let reach = radius + far;
        let asked = Asked { surface: self, side, center, normal: &foot.normal, reach, far, patience };
        let (near, path) = asked.sheet()?;
        let lean = path.lean();
        let [natural, other] = path.curvature;
        let (against, along) = if side > 0.0 { (other, natural) } else { (natural, other) };
        if far * against.max(0.0) * lean >= 1.0 {
            return None;
        }
        let [natural, other] = near.curvature;
        let (hollow, round) = if side > 0.0 { (other, natural) } else { (natural, other) };
        let (hollow, round) = (hollow.max(0.0), round.max(0.0));
        let beyond = if along > 0.0 { 0.5 / (along * lean) } else { f64::INFINITY };
        let beyond = (beyond + stock).max(0.0);
        hollow.is_finite().then_some(Steady { hollow, round, depth, stock, beyond })
    }

    /// How far the line of the chord between the places of a ruled or polyconic surface that are nearest to two points is from a curve on it at most:
    /// beside each place of the chord is one of the surface. Along a ruling it is on the surface. `None` for other kinds of surface, and where there is
    /// a corner between both.
    pub fn strays_between(&self, ends: [&Vec3; 2]) -> Option<f64> {
        match self {
            Self::Ruled(sheet) => {
                let [from, to] = ends.map(|end| sheet.place_near(end));
                sheet.strays([&from, &to])
            }
            Self::PolyConic(sheet) => {
                let [from, to] = ends.map(|end| sheet.place_near(end));
                sheet.strays([&from, &to])
            }
            _ => None,
        }
    }

    /// How the surface of the charts bends towards a side at all places within reach of a point; `None` for other kinds of
    /// surface, and where it ends or has an edge or no tangent plane there.
    pub fn forms(&self, side: f64, center: &Vec3, reach: f64, patience: Patience<'_>) -> Option<Vec<Form>> {
        let asked = Survey::of_forms(center, reach, side, patience);
        let forms = match self {
            Self::Tabulated(curve) => curve.forms(side, center, reach),
            Self::Ruled(sheet) => sheet.survey(asked).forms(),
            Self::PolyConic(sheet) => sheet.forms(asked),
            Self::Sculptured(sheet) => sheet.survey(asked).forms(),
            _ => None,
        };
        leading(forms?, patience)
    }

    /// How much the surface of the charts bends away from a side at most along a unit direction, at all places within reach of a point;
    /// closely where that is more than enough. `None` for other kinds of surface, and where it ends or has an edge or no tangent plane
    /// there.
    pub fn bend_along(
        &self,
        side: f64,
        center: &Vec3,
        reach: f64,
        (along, enough): (&Vec3, f64),
        patience: Patience<'_>,
    ) -> Option<f64> {
        let asked = Survey::of_bend_along(center, reach, side, (*along, enough), patience);
        let survey = match self {
            Self::Tabulated(curve) => {
                let forms = curve.forms(side, center, reach)?;
                return Some(
                    forms.iter().map(|form| form.bend_away(along)).fold(f64::NEG_INFINITY, f64::max),
                );
            }
            Self::Ruled(sheet) => sheet.survey(asked),
            Self::PolyConic(sheet) => sheet.survey(asked),
            Self::Sculptured(sheet) => sheet.survey(asked),
            _ => return None,
        };
        survey.bend_along()
    }

    /// The curvature of a cylinder along a line that bends as much as a ruled, polyconic or sculptured surface towards a side at all places
    /// within reach of a point, after the least bend along the line with which there is one; `None` where there is none as asked for, and
    /// where the surface ends or has an edge there.
    pub fn curvature_across(
        &self,
        side: f64,
        center: &Vec3,
        reach: f64,
        asked: Lengthwise,
        patience: Patience<'_>,
    ) -> Option<(f64, f64)> {
        let asked = Survey::of_lengthwise(center, reach, side, asked, patience);
        let survey = match self {
            Self::Ruled(sheet) => sheet.survey(asked),
            Self::PolyConic(sheet) => sheet.survey(asked),
            Self::Sculptured(sheet) => sheet.survey(asked),
            _ => return None,
        };
        survey.curvature_across()
    }

    /// Whether distances from a ruled surface, on a side of it, bend downward along a line by no more than is asked, at all points of a
    /// stretch whose middle has its nearest place at a foot, if no nearest place jumps and none is farther away from the foot than a reach.
    /// Not for other kinds of surface, nor where it ends or has an edge there.
    pub fn bends_little_along(
        &self,
        side: f64,
        foot: &Vec3,
        reach: f64,
        asked: Lying,
        patience: Patience<'_>,
    ) -> bool {
        let Self::Ruled(sheet) = self else { return false };
        let Some(ruling) = sheet.ruling(foot) else { return false };
        sheet.survey(Survey::on_rulings((foot, &ruling), reach, side, asked, patience)).bends_little()
    }

    /// How much farther the surface of the charts is, from a point on a side, than the one that distances are measured from.
    pub fn stock(&self, side: f64) -> f64 {
        match self {
            Self::PolyConic(sheet) => side * sheet.thickness(),
            _ => 0.0,
        }
    }

    /// Whether all of the surface is known, from the sizes of its parts, to be farther from a point than a distance. For
    /// surfaces without charts that is not known.
    pub fn keeps_off(&self, p: &Vec3, distance: f64) -> bool {
        match self {
            Self::Tabulated(curve) => curve.keeps_off(p, distance),
            Self::Ruled(sheet) => sheet.keeps_off(p, distance),
            Self::PolyConic(sheet) => sheet.keeps_off(p, distance),
            Self::Sculptured(sheet) => sheet.keeps_off(p, distance),
            _ => false,
        }
    }

    /// Curvature and normals within reach of a point, given a normal; `None` if the surface ends there or turns away. The
    /// curvature towards the points on a side is the close one.
    fn facing(
        &self,
        side: f64,
        center: &Vec3,
        reach: f64,
        normal: &Vec3,
        patience: Patience<'_>,
    ) -> Option<Facing> {
        let asked = || Survey::of_sheet(center, reach, (-side, normal), STEADY_COSINE, patience);
        match self {
            Self::Tabulated(curve) => curve.facing(center, reach, normal, STEADY_COSINE),
            Self::Ruled(sheet) => sheet.survey(asked()).facing(),
            Self::PolyConic(sheet) => sheet.survey(asked()).facing(),
            Self::Sculptured(sheet) => sheet.survey(asked()).facing(),
            _ => None,
        }
    }
}

/// A ball about a place that is to be steady.
struct Asked<'a> {
    surface: &'a Surface,
    side: f64,
    center: &'a Vec3,
    /// The normal at the foot of the centre.
    normal: &'a Vec3,
    /// How far from the centre the nearest places of the surface can be, and how far from the points that they belong to.
    reach: f64,
    far: f64,
    patience: Patience<'a>,
}

impl Asked<'_> {
    fn facing(&self, within: f64) -> Option<Facing> {
        self.surface.facing(self.side, self.center, within, self.normal, self.patience)
    }

    /// How far from the centre the paths between two feet of one point can reach, given what the normals at the feet and on the paths
    /// keep as cosine.
    fn wide(&self, near: f64, path: f64) -> f64 {
        let sine = |cosine: f64| (1.0 - cosine * cosine).max(0.0).sqrt();
        self.reach + self.far * sine(near) * sine(path) / path
    }

    /// What is known about the feet, and about the paths between them.
    fn sheet(&self) -> Option<(Facing, Facing)> {
        if matches!(self.surface, Surface::Tabulated(_)) {
            // The stretch of the curve between the places is among those looked at.
            let near = self.facing(self.reach)?;
            return Some((near, near));
        }
        let first = WIDER * self.reach;
        let about = self.facing(first);
        match about.filter(|path| self.wide(path.cosine, path.cosine) <= first) {
            Some(path) => Some((path, path)),
            None => {
                let near = self.facing(self.reach)?;
                Some((near, self.paths(&near, about.map(|about| (first, about)))?))
            }
        }
    }

    /// What is known of the paths between feet, given what is about these and, if that is known, what is about them within a wider
    /// reach.
    fn paths(&self, near: &Facing, known: Option<(f64, Facing)>) -> Option<Facing> {
        let mut inner = (self.reach, near.cosine);
        let (mut within, mut path) = match known {
            Some(known) => known,
            None => {
                let within = self.wide(near.cosine, (near.cosine - STEEPER).max(STEADY_COSINE));
                (within, self.facing(within)?)
            }
        };
        for _ in 0..WIDENINGS {
            if self.wide(near.cosine, path.cosine) <= within {
                return Some(path);
            }
            let next = self.foreseen(near.cosine, [inner, (within, path.cosine)])?;
            inner = (within, path.cosine);
            (within, path) = (next, self.facing(next)?);
        }
        (self.wide(near.cosine, path.cosine) <= within).then_some(path)
    }

    /// How far the paths will reach if the cosine goes on to fall as it does between two reaches; `None` if they lead away.
    fn foreseen(&self, near: f64, [inner, outer]: [(f64, f64); 2]) -> Option<f64> {
        let slope = ((outer.1 - inner.1) / (outer.0 - inner.0)).min(0.0);
        let mut within = outer.0;
        for _ in 0..MOST_FORESEEN {
            let cosine = outer.1 + slope * (within - outer.0);
            if cosine < STEADY_COSINE {
                return None;
            }
            let needed = self.wide(near, cosine);
            if needed <= within {
                break;
            }
            within = FURTHER * needed;
        }
        Some(within)
    }
}

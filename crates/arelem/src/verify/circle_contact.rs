//! A tool that touches a quadric (or cylinder or cone) with its corner or an edge: the usual case, in which one contact
//! and one bound settle the clearance.
//!
//! The contact is a place of a circle of the tool with its foot on the surface, both found by Newton's method from the
//! azimuth that faces the surface. It counts only if it is shown to be the nearest. For a convex solid the tangent plane
//! shows it. For any other the multipliers do, of the contact's foot and of the circle: with them the squared distance has a
//! lower bound that is the least value of one quadratic function, on a straight piece between two heights.

mod demand;
mod piece;

use apt_geometry::Vec3;
use nalgebra::{Matrix2, Vector2};

use self::{demand::Demand, piece::Part};
use super::{
    clearance::{Reading, Shape},
    quadric::PrincipalQuadric,
    tool::{Meridian, Tool, count_work, perpendicular},
};

/// Steps of Newton's method before the general search is asked.
const STEPS: usize = 14;
/// Last step, radians and relative to the radii of curvature, after which only the square of it is left.
const LAST_STEP: f64 = 1e-6;
/// Share of the size of the tool by which a bound may miss the contact: it counts as error.
const SLACK: f64 = 1e-10;
/// The same for tangent planes, which are exact.
const PLANE_SLACK: f64 = 1e-12;
/// Stretches of a straight piece or of the arc of the corner that are looked at, and for a contact that is only expected to be the
/// nearest: one that is not would take them all.
const STRETCHES: usize = 60;
const FIRST_STRETCHES: usize = 8;
/// Rounding of the fan of the corner arc, as a sine.
const NEARLY_IN_FAN: f64 = 1e-9;
/// Share of the size of the tool by which it may go farther towards the surface than the place that touches, which is found by its
/// azimuth: rounding, and the square of the last step.
const FOREMOST: f64 = 1e-9;
/// Least determinant of a form of two directions, relative to its size, that is not rounding of its products.
const DEFINITE: f64 = 1e-14;
/// Rounding of a form of two directions, relative to its size.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Looks along the surface beside the place that touches, until that is known about.
const GLANCES: usize = 2;

/// One position of the tool in the principal axes of the surface.
pub(super) struct Place<'a> {
    pub(super) quadric: &'a PrincipalQuadric,
    pub(super) side: f64,
    tool: &'a Tool<'a>,
    pub(super) tip: Vec3,
    pub(super) axis: Vec3,
    pub(super) across: [Vec3; 2],
}

/// A place of the tool and its foot, in principal axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    pub(super) distance: f64,
    /// Towards the tool.
    pub(super) normal: Vec3,
    /// Half the gradient of F at the foot.
    pub(super) steepness: f64,
    pub(super) foot: Vec3,
    /// Where on the meridian of the tool, a ball's centre for the corner.
    pub(super) meridian: Meridian,
}

/// A circle of the tool, with the radius of the ball about it.
type Circle = (Meridian, f64);

/// The clearance, if one circle of the tool is in contact and that is proven.
pub(super) fn at(
    quadric: &PrincipalQuadric,
    shape: Shape,
    side: f64,
    tip: &Vec3,
    tool: &Tool<'_>,
) -> Option<Reading> {
    let first = perpendicular(&tool.axis);
    let place = Place {
        quadric,
        side,
        tool,
        tip: quadric.turned_in(tip),
        axis: quadric.turned_in(&tool.axis),
        across: [quadric.turned_in(&first), quadric.turned_in(&tool.axis.cross(&first))],
    };
    let mut search = Search::of(&place, shape == Shape::Convex);
    search
        .on_bulge()
        .or_else(|| search.on_expected_circles())
        .or_else(|| search.on_nearest())
        .or_else(|| search.on_straight_pieces())
}

/// The parts of a tool, looked at for the one in contact.
struct Search<'a> {
    place: &'a Place<'a>,
    /// Whether the surface is the boundary of a convex solid that the tool is outside of, so that a tangent plane proves a contact.
    is_convex: bool,
    /// By how much a proof may miss the contact.
    error: f64,
    /// The circle of the corner, about which its balls are; or its arc, where that bulges.
    corner: Option<Circle>,
    bulge: Option<Part>,
    /// The circle that is expected to touch, once it has been asked for.
    expected: Option<Circle>,
    /// The straight pieces, from one edge to the next.
    pieces: [[Meridian; 2]; 2],
    /// The nearest place of the tool that is not shown to be the contact, with the ball about it.
    nearest: Option<(Touch, f64)>,
}

impl<'a> Search<'a> {
    fn of(place: &'a Place<'a>, is_convex: bool) -> Self {
        let profile = place.tool.profile;
        let (corner, bulge) = match profile.corner() {
            // Beyond the axis the centres of the corner are no places that the tool is about.
            Some((center, radius)) if center[0] < 0.0 => (None, Part::arc(profile, center, radius)),
            corner => (corner, None),
        };
        let [lower, upper, top] = profile.edges();
        let error = if is_convex { PLANE_SLACK } else { SLACK } * profile.reach();
        let pieces = [[[0.0; 2], lower], [upper, top]];
        Self { place, is_convex, error, corner, bulge, expected: None, pieces, nearest: None }
    }

    /// The clearance by a contact, if no point of the tool is shown to be nearer, by a tangent plane or so many stretches of the tool.
    fn proven(&self, touch: &Touch, ball: f64, stretches: usize) -> Option<Reading> {
        let Self { place, error, .. } = *self;
        let value = touch.distance - ball;
        let holds = if self.is_convex {
            place.is_beyond_plane(touch, value - error)
        } else {
            place.keeps(value - error, touch, stretches)
        };
        holds.then(|| Reading::new(value, place.quadric.turned_out(&touch.normal), error))
    }

    /// The arc of a corner that bulges.
    fn on_bulge(&mut self) -> Option<Reading> {
        let touch = self.place.touch_piece(self.bulge?)?;
        let reading = self.proven(&touch, 0.0, STRETCHES);
        self.nearest = Some((touch, 0.0));
        reading
    }

    /// The circles of the corner, the tool end and the edges, the expected one first.
    fn on_expected_circles(&mut self) -> Option<Reading> {
        let [lower, ..] = self.place.tool.profile.edges();
        self.expected = self.place.expected();
        let expected = self.expected;
        // The tool end is in contact only where the bottom rises from it.
        let tip = (lower[1] > 0.0).then_some(([0.0; 2], 0.0));
        let [first, second, third] = self.place.tool.profile.edges().map(|p| Some((p, 0.0)));
        let all = [self.corner, tip, first, second, third];
        let others = all.iter().flatten().filter(|circle| Some(**circle) != expected);
        let mut done: Option<Meridian> = None;
        for &circle in expected.iter().filter(|circle| all.contains(&Some(**circle))).chain(others) {
            if done == Some(circle.0) {
                continue;
            }
            done = Some(circle.0);
            if let Some(reading) = self.on_circle(circle) {
                return Some(reading);
            }
        }
        None
    }

    /// One circle, if it is worth a trial: else it may be the nearest.
    fn on_circle(&mut self, circle: Circle) -> Option<Reading> {
        let (p, ball) = circle;
        let touch = self.place.touch(p, ball)?;
        // A tangent plane is quickly tried. A place from which the tool goes on towards the surface is not the nearest.
        let may_be_nearest = self.is_convex || ball > 0.0 || self.place.is_foremost(&touch);
        // The corner is the nearest so mostly that it is worth the longer trial, and so is what is expected.
        let is_expected = Some(circle) == self.expected;
        if may_be_nearest
            && (self.is_convex || is_expected || Some(circle) == self.corner)
            && let Some(reading) =
                self.proven(&touch, ball, if is_expected { FIRST_STRETCHES } else { STRETCHES })
        {
            return Some(reading);
        }
        // Where the tangent plane there cuts the tool, a straight piece beside it touches.
        if self.is_convex && is_expected {
            let beside = self.pieces.iter().filter(|[a, b]| a != b && (*a == p || *b == p));
            let mut straight = beside.filter_map(|ends| self.place.touch_straight(*ends, &-touch.normal));
            if let Some(reading) = straight.find_map(|touch| self.proven(&touch, 0.0, STRETCHES)) {
                return Some(reading);
            }
        }
        let distance = touch.distance - ball;
        if may_be_nearest && self.nearest.is_none_or(|(near, about)| distance < near.distance - about) {
            self.nearest = Some((touch, ball));
        }
        None
    }

    /// The nearest of the places that were looked at, which has not been tried as long as it may be.
    fn on_nearest(&self) -> Option<Reading> {
        let is_untried = |ball: f64| !self.is_convex && (ball <= 0.0 || self.expected == self.corner);
        let (touch, ball) = self.nearest.filter(|(_, ball)| is_untried(*ball))?;
        self.proven(&touch, ball, STRETCHES)
    }

    /// The straight pieces.
    fn on_straight_pieces(&self) -> Option<Reading> {
        self.pieces.into_iter().filter(|[a, b]| a != b).find_map(|ends| {
            let near = self.nearest.filter(|_| self.is_convex);
            let straight = near.and_then(|(near, _)| self.place.touch_straight(ends, &-near.normal));
            let shown = straight.and_then(|touch| self.proven(&touch, 0.0, STRETCHES));
            shown.or_else(|| self.proven(&self.place.touch_piece(Part::Line(ends))?, 0.0, STRETCHES))
        })
    }
}

impl Place<'_> {
    pub(super) fn on_circle(&self, phi: f64) -> [Vec3; 2] {
        let (s, c) = phi.sin_cos();
        [self.across[0] * c + self.across[1] * s, self.across[1] * c - self.across[0] * s]
    }

    /// The circle of the tool, with the ball about it, that is expected to touch: the one that goes farthest towards the surface by the
    /// normal of that beside it.
    fn expected(&self) -> Option<Circle> {
        let mut at = self.tip + self.axis * self.tool.profile.edges()[0][1];
        let mut found = None;
        for _ in 0..GLANCES {
            let towards = (self.quadric.slope(&at) * -self.side).try_normalize(0.0)?;
            let height = towards.dot(&self.axis);
            let across = towards - self.axis * height;
            let out = across.norm();
            let (_, place, is_round) = self.tool.profile.support_on([out, height]);
            found = Some(if is_round { self.tool.profile.corner()? } else { (place, 0.0) });
            at = self.tip + across * (place[0] / out.max(f64::MIN_POSITIVE)) + self.axis * place[1];
        }
        found
    }

    /// Whether nothing of the tool goes farther towards the surface than the place that touches.
    fn is_foremost(&self, touch: &Touch) -> bool {
        let height = -touch.normal.dot(&self.axis);
        let towards = [(1.0 - height * height).max(0.0).sqrt(), height];
        let reach = towards[0] * touch.meridian[0] + towards[1] * touch.meridian[1];
        self.tool.profile.support(towards).0 - reach <= FOREMOST * self.tool.profile.reach()
    }

    /// The contact with a ball about a circle near the azimuth that faces the surface.
    fn touch(&self, [rho, height]: Meridian, ball: f64) -> Option<Touch> {
        count_work();
        let center = self.tip + self.axis * height;
        let facing = self.quadric.slope(&center) * -self.side;
        let mut phi = facing.dot(&self.across[1]).atan2(facing.dot(&self.across[0]));
        let mut lambda = None;
        for _ in 0..STEPS {
            let [out, round] = self.on_circle(phi);
            let p = center + out * rho;
            let multiplier = match lambda {
                Some(known) => known,
                None => self.quadric.first_multiplier(&p)?,
            };
            let k = self.quadric.shrink(multiplier);
            if k.min() <= 0.0 {
                return None;
            }
            let foot = self.quadric.foot(&p, multiplier);
            let g = self.quadric.slope(&foot);
            let value = self.quadric.value(&foot);
            let along = round * rho;
            // Both equations, slope along the circle and F, with their derivatives.
            let curved = self.quadric.squares().component_mul(&k);
            let matrix = Matrix2::new(
                curved.component_mul(&along).dot(&along) - rho * g.dot(&out),
                -curved.component_mul(&g).dot(&along),
                2.0 * k.component_mul(&g).dot(&along),
                -2.0 * k.component_mul(&g).dot(&g),
            );
            if rho <= 0.0 {
                let grow = -value / matrix[(1, 1)];
                let next = multiplier + grow;
                if grow.abs() * curved.amax() <= LAST_STEP {
                    return self.finished([rho, height], &p, next, ball);
                }
                lambda = Some(next);
                continue;
            }
            let step = matrix.try_inverse()? * Vector2::new(-g.dot(&along), -value);
            if !(step.x.is_finite() && step.y.is_finite()) {
                return None;
            }
            phi += step.x.clamp(-0.5, 0.5);
            lambda = Some(multiplier + step.y);
            if step.x.abs() <= LAST_STEP && step.y.abs() * curved.amax() <= LAST_STEP {
                let p = center + self.on_circle(phi)[0] * rho;
                return self.finished([rho, height], &p, multiplier + step.y, ball);
            }
        }
        None
    }

    fn finished(&self, meridian: Meridian, p: &Vec3, multiplier: f64, ball: f64) -> Option<Touch> {
        if self.quadric.shrink(multiplier).min() <= 0.0 {
            return None;
        }
        let foot = self.quadric.foot(p, multiplier);
        let g = self.quadric.slope(&foot);
        let steepness = g.norm();
        let normal = g * (self.side / steepness);
        let distance = self.side * (multiplier * steepness + 0.5 * self.quadric.value(&foot) / steepness);
        if !distance.is_finite() || ball > 0.0 && !self.in_fan(distance, &normal) {
            return None;
        }
        Some(Touch { distance, normal, steepness, foot, meridian })
    }

    /// Whether a ball of the corner has this contact normal on its arc.
    fn in_fan(&self, distance: f64, normal: &Vec3) -> bool {
        let height = -normal.dot(&self.axis);
        let outward = (1.0 - height * height).max(0.0).sqrt();
        let turned = |by: f64| [(outward - by * height).max(0.0), height + by * outward];
        distance > 0.0
            && [-NEARLY_IN_FAN, NEARLY_IN_FAN].iter().any(|by| self.tool.profile.fan_holds(turned(*by)))
    }

    /// Whether the whole tool is at least this far beyond the tangent plane at the foot.
    fn is_beyond_plane(&self, touch: &Touch, least: f64) -> bool {
        let n = self.quadric.turned_out(&touch.normal);
        let reach = self.tool.support(&-n).0;
        touch.normal.dot(&(self.tip - touch.foot)) - reach >= least
    }

    /// Whether every point of the tool keeps a distance from the surface.
    fn keeps(&self, least: f64, touch: &Touch, stretches: usize) -> bool {
        let profile = self.tool.profile;
        let Some(sharp) = self.demand(least, touch) else { return false };
        let [lower, upper, top] = profile.edges();
        let corner = match profile.corner() {
            // The balls of the corner hold the ends of its arc; of a barrel each one holds all of it.
            Some((center, radius)) => {
                let balls = (least + radius > 0.0).then(|| self.demand(least + radius, touch)).flatten();
                let keeps = |demand: &Demand| match center[0] < 0.0 {
                    true => demand.at(center, &self.facing(touch)) >= demand.least,
                    false => self.circle(demand, center, touch) >= demand.least,
                };
                balls.as_ref().is_some_and(keeps) || self.arcs(&sharp, touch, stretches)
            }
            None => self.circle(&sharp, lower, touch) >= sharp.least,
        };
        corner
            && (lower == [0.0; 2]
                || if lower[1] > 0.0 {
                    self.piece(&sharp, [[0.0; 2], lower], touch, stretches)
                } else {
                    self.disc(&sharp, lower, touch)
                })
            && (upper == top || self.piece(&sharp, [upper, top], touch, stretches))
    }

    /// Whether the arc of the corner keeps a distance, where its whole balls stand out from the tool: the straight pieces
    /// along the tangents at both ends of a stretch of it are outside of the arc. A stretch that ends at the contact touches
    /// with that end alone.
    fn arcs(&self, demand: &Demand, touch: &Touch, stretches: usize) -> bool {
        let Some((center, radius)) = self.tool.profile.corner() else { return true };
        let [lower, upper, _] = self.tool.profile.edges();
        let angle = |p: Meridian| (p[0] - center[0]).atan2(center[1] - p[1]);
        let at = |angle: f64, away: f64| [center[0] + away * angle.sin(), center[1] - away * angle.cos()];
        let facing = self.facing(touch);
        let keeps = |ends: [Meridian; 2]| self.best_between(demand, ends, touch, &facing) >= demand.least;
        let [first, last] = [angle(lower), angle(upper)];
        let height = -touch.normal.dot(&self.axis);
        let contact = (1.0 - height * height).max(0.0).sqrt().atan2(-height);
        let mut open = if contact > first && contact < last {
            vec![[contact, last], [first, contact]]
        } else {
            vec![[first, last]]
        };
        for _ in 0..stretches {
            let Some([from, to]) = open.pop() else { return true };
            let half = 0.5 * (to - from);
            let middle = from + half;
            let meeting = at(middle, radius / half.cos());
            if !(keeps([at(from, radius), meeting]) && keeps([meeting, at(to, radius)])) {
                open.extend([[middle, to], [from, middle]]);
            }
        }
        open.is_empty()
    }

    /// Azimuth of a circle that faces the contact.
    fn facing(&self, touch: &Touch) -> Vector2<f64> {
        let n = Vector2::new(-touch.normal.dot(&self.across[0]), -touch.normal.dot(&self.across[1]));
        n.try_normalize(0.0).unwrap_or_else(Vector2::x)
    }

    /// Lower bound over a circle: with the multiplier of the circle at the place that faces the contact.
    fn circle(&self, demand: &Demand, [rho, height]: Meridian, touch: &Touch) -> f64 {
        let middle = demand.on_axis(height);
        if rho <= 0.0 {
            return middle;
        }
        let (g, form) = (demand.slope_across(height), demand.form);
        let mut place = self.facing(touch) * rho;
        let mut best = f64::NEG_INFINITY;
        // One step of Newton's method along the circle, in case that the nearest place is turned away a little.
        for _ in 0..3 {
            let pull = demand.formed(&place) + g;
            let mu = -pull.dot(&place) / (rho * rho);
            best = best.max(middle + least_of(&form, mu, &g) - mu * rho * rho);
            if best >= demand.least {
                break;
            }
            let round = Vector2::new(-place.y, place.x);
            let bend = round.dot(&demand.formed(&round)) - pull.dot(&place);
            if bend <= 0.0 {
                break;
            }
            place = (place - round * (pull.dot(&round) / bend)).try_normalize(0.0).map_or(place, |d| d * rho);
        }
        best
    }

    /// Whether nothing within a circle is lower than demanded, if nothing on it is.
    fn disc(&self, demand: &Demand, [rho, height]: Meridian, touch: &Touch) -> bool {
        let (middle, g, form) = (demand.on_axis(height), demand.slope_across(height), demand.form);
        let place = self.facing(touch) * rho;
        let mu = (-(demand.formed(&place) + g).dot(&place) / (rho * rho)).max(0.0);
        let bowl = form.m11 * form.m22 > form.m12 * form.m12 && form.trace() > 0.0;
        // Not bowl-shaped, it is lowest on the circle.
        !bowl || middle + least_of(&form, mu, &g) - mu * rho * rho >= demand.least
    }

    /// Whether nothing on the piece between two circles is lower than demanded, with multipliers for the distance from the axis.
    fn piece(&self, demand: &Demand, ends: [Meridian; 2], touch: &Touch, stretches: usize) -> bool {
        let facing = self.facing(touch);
        let mut open = vec![ends];
        for _ in 0..stretches {
            let Some([a, b]) = open.pop() else { return true };
            let keeps = self.best_between(demand, [a, b], touch, &facing) >= demand.least;
            if !(keeps || a[0] <= 0.0 && self.rises_from_apex(demand, [a, b])) {
                let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                open.extend([[middle, b], [a, middle]]);
            }
        }
        open.is_empty()
    }

    /// Whether the bound rises, or falls by too little, along every straight line of a piece that begins on the axis.
    fn rises_from_apex(&self, demand: &Demand, [a, b]: [Meridian; 2]) -> bool {
        let (spread, rise) = (b[0] - a[0], b[1] - a[1]);
        let form = &demand.form;
        let least_slope = rise * demand.slope_along(a[1]) - spread * demand.slope_across(a[1]).norm();
        let least_form = 0.5 * form.trace() - (0.5 * (form.m11 - form.m22)).hypot(form.m12);
        let bend = rise * rise * demand.upright - 2.0 * (rise * spread).abs() * demand.twist.norm()
            + spread * spread * least_form;
        demand.on_axis(a[1]) + (2.0 * least_slope + bend.min(0.0)).min(0.0) >= demand.least
    }

    /// The best of the bounds with the multipliers of the place nearest to the contact, of either end and of the middle.
    fn best_between(
        &self,
        demand: &Demand,
        ends: [Meridian; 2],
        touch: &Touch,
        facing: &Vector2<f64>,
    ) -> f64 {
        let [a, b] = ends;
        let way = [b[0] - a[0], b[1] - a[1]];
        let from = [touch.meridian[0] - a[0], touch.meridian[1] - a[1]];
        let contact = (from[0] * way[0] + from[1] * way[1]) / (way[0] * way[0] + way[1] * way[1]);
        let mut best = f64::NEG_INFINITY;
        for at in [contact.clamp(0.0, 1.0), 0.0, 1.0, 0.5] {
            best = best.max(demand.between(ends, Some(facing), at));
            if best >= demand.least {
                return best;
            }
        }
        // Another side of the tool may be lower.
        for at in [0.0, 1.0, 0.5] {
            if best >= demand.least {
                break;
            }
            best = best.max(demand.between(ends, None, at));
        }
        best
    }
}

/// The multiplier with which `wᵀ(H + μ)w + 2g·w` is least at the place of a circle about the origin where it is least of all on
/// the circle, or one a little greater: from where that place is within the circle, Newton's method on the reciprocal of its radius
/// never leaves that side.
pub(super) fn multiplier_of_circle(form: &Matrix2<f64>, g: &Vector2<f64>, radius: f64) -> f64 {
    multiplier_of_circle_until(form, g, radius, |_, _| false)
}

/// The same, or the first multiplier on the way there that is enough, as told by it and the place of which it is the multiplier.
pub(super) fn multiplier_of_circle_until(
    form: &Matrix2<f64>,
    g: &Vector2<f64>,
    radius: f64,
    mut is_enough: impl FnMut(f64, &Vector2<f64>) -> bool,
) -> f64 {
    let (mean, half) = (0.5 * form.trace(), (0.5 * (form.m11 - form.m22)).hypot(form.m12));
    // Between the multiplier that makes the form just positive and one that is enough for any form so.
    let (mut low, mut high) = (half - mean, half - mean + g.norm() / radius);
    let mut mu = high;
    for _ in 0..STEPS {
        let held = form + Matrix2::identity() * mu;
        let Some(inverse) = held.try_inverse() else { break };
        let place = inverse * g;
        if is_enough(mu, &place) {
            return mu;
        }
        let size = place.norm();
        let step = size * size / place.dot(&(inverse * place)) * (size - radius) / radius;
        if !step.is_finite() {
            break;
        }
        if size > radius {
            low = mu;
        } else {
            high = mu;
        }
        let next = mu + step;
        if step.abs() <= LAST_STEP * next.abs() {
            return next;
        }
        mu = if next > low && next < high { next } else { 0.5 * (low + high) };
    }
    mu
}

/// Least value of `wᵀ(H + μ)w + 2g·w`, or by as much less as rounding makes of it; −∞ if there is none.
pub(super) fn least_of(form: &Matrix2<f64>, mu: f64, g: &Vector2<f64>) -> f64 {
    let Some(held) = DefiniteForm::of(form, mu) else { return f64::NEG_INFINITY };
    let place = held.solved(g);
    -g.dot(&place) - held.rounding(place.norm())
}

/// A form with a multiplier that makes it positive definite, beyond rounding: by a determinant that is rounding any bound would hold.
pub(super) struct DefiniteForm {
    first: f64,
    both: f64,
    last: f64,
    determinant: f64,
}

impl DefiniteForm {
    pub(super) fn of(form: &Matrix2<f64>, mu: f64) -> Option<Self> {
        let (first, both, last) = (form.m11 + mu, form.m12, form.m22 + mu);
        let determinant = first * last - both * both;
        let trace = first + last;
        // Before the multiplier was added the form may have been larger.
        let size = trace.max(form.m11.abs() + form.m22.abs() + mu.abs());
        (trace > 0.0 && determinant > DEFINITE * trace * size).then_some(Self {
            first,
            both,
            last,
            determinant,
        })
    }

    /// The place at which the form is level with a slope.
    pub(super) fn solved(&self, slope: &Vector2<f64>) -> Vector2<f64> {
        let Self { first, both, last, determinant } = *self;
        Vector2::new(last * slope.x - both * slope.y, first * slope.y - both * slope.x) / determinant
    }

    /// How much rounding of the form is at a place so far out.
    pub(super) fn rounding(&self, out: f64) -> f64 {
        ROUNDING * (self.first + self.last) * out * out
    }
}

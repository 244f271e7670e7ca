//! Lower bounds of quadratic functions over the parts of a tool, at one position of it or on a straight way of it: what shows that no point of the
//! tool is nearer to a quadric than a level.

use apt_geometry::{Vec3, cutter::ProfilePoint, surface::QuadraticFunction};

use super::{Posed, ROUNDING};
use crate::clearance::{
    Contact,
    cover::holds_balls,
    waves::{Waves, length},
};

/// Bound of the parts of the corner's arc that are looked at.
const MAX_ARCS: u32 = 60;
/// The same on a way: a shorter one is told by fewer.
const MAX_ARCS_ON_WAY: u32 = 12;
/// Bound of the parts into which a flank of the tool is cut.
const MAX_PARTS: u32 = 200;
/// How often a way is halved beside its beginning, where the contact is.
const MOST_HALVINGS: u32 = 3;

#[cfg(test)]
thread_local! {
    /// Bounds over circles of the tool that this thread has computed.
    pub(crate) static FLOORS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// A quadratic function with its values on the directions of the tool.
pub(super) struct Bound {
    function: QuadraticFunction,
    /// The form of the squares for both directions across the axis, and for both together.
    across: [f64; 3],
    /// The tool end from which circles are measured.
    tip: Vec3,
    /// The way from there on which the function is asked for.
    way: Option<Vec3>,
    /// What the function must not be below.
    target: f64,
    /// Half its second derivative along the way, where that is not negative: it is the same for all points of the tool.
    bow: f64,
}

/// How a function bends along the straight lines of patches of the tool.
#[derive(Clone, Copy)]
pub(super) struct Slants {
    /// The form of the squares for the axis, the greatest one for the axis together with a unit vector across it, and the greatest one for a
    /// unit vector across it.
    upright: f64,
    tilt: f64,
    sideways: f64,
}

impl Slants {
    /// Half the second derivative along a line, at most, that rises and goes away from the axis by so much.
    fn bend(&self, rise: f64, spread: f64) -> f64 {
        rise * rise * self.upright + 2.0 * (rise * spread).abs() * self.tilt + spread * spread * self.sideways
    }
}

/// What a function is nowhere below on a part of the tool, at both ends of the way.
pub(super) type Floor = [f64; 2];

/// A circle of the tool, and the floor of a function on it.
pub(super) type Circled = (ProfilePoint, Floor);

impl Bound {
    /// Whether the function is nowhere below its target on the way of a part of the tool. Along the way of each point it is a parabola, so that it is
    /// nowhere below that through its floors at both ends.
    pub(super) fn keeps(&self, [here, there]: Floor) -> bool {
        least_between(here, there, self.bow) >= self.target
    }

    /// The same on a piece of the way, from a share of it and as long as another one.
    fn on_piece(&self, from: f64, length: f64) -> Self {
        let way = self.way.unwrap_or_else(Vec3::zeros);
        let (tip, bow) = (self.tip + way * from, self.bow * length * length);
        Self { tip, way: Some(way * length), bow, ..*self }
    }

    /// What serves all along the way if the function is nowhere below it at both ends.
    fn ample(&self) -> f64 {
        self.target + 0.25 * self.bow
    }
}

impl Posed<'_> {
    /// Whether no point of the tool is nearer to the surface than a level, here and on the way, by bounds made from a contact. If
    /// not, there may be one or the bounds are too weak.
    pub(in crate::clearance) fn clears(&self, level: f64, contact: &Contact) -> bool {
        if let Some(half) = self.half_by_plane(level, contact)
            && self.keeps_off(&half, level, contact)
        {
            return true;
        }
        let Some((sharp, steepness, towards)) = self.bound_from(level, contact) else { return false };
        let at_centers = self.tool.profile.arc + level;
        let has_balls = self.tool.profile.arc > 0.0 && at_centers > 0.0;
        let balls = || if has_balls { self.bound(at_centers, steepness, &towards) } else { None };
        self.keeps(&sharp, &balls, &towards)
            || self.way.is_some() && self.keeps_by_halves(&sharp, balls().as_ref(), &towards)
    }

    /// Whether functions are nowhere below their targets on pieces of the way: what of the tool is lowest at one end of it is not what is at the
    /// other, which shorter ones tell apart. Where they are near the target is where the contact is, at the beginning.
    fn keeps_by_halves(&self, sharp: &Bound, balls: Option<&Bound>, towards: &Vec3) -> bool {
        let mut length = 1.0;
        for _ in 0..MOST_HALVINGS {
            length *= 0.5;
            let piece = |from: f64| {
                let of = |bound: &Bound| bound.on_piece(from, length);
                self.keeps(&of(sharp), &|| balls.map(of), towards)
            };
            if !piece(length) {
                return false;
            }
            if piece(0.0) {
                return true;
            }
        }
        false
    }

    /// Whether functions are nowhere below their targets on the way of the tool: one for points of it, and one for the centres of the balls of its
    /// corner.
    fn keeps(&self, sharp: &Bound, balls: &dyn Fn() -> Option<Bound>, towards: &Vec3) -> bool {
        let profile = &self.tool.profile;
        let slants = &self.slants(sharp);
        let floor = |circle: &ProfilePoint| (*circle, self.floor(sharp, circle, towards));
        let ends = [floor(&profile.lower), floor(&profile.upper)];
        let corner = if profile.arc > 0.0 {
            let keep = |balls: Bound| match profile.is_barrel() {
                true => balls.keeps(self.floor_at_ball(&balls, towards)),
                false => balls.keeps(self.floor(&balls, &profile.center, towards)),
            };
            let by_balls = || balls().is_some_and(keep);
            let by_arcs = || self.arcs((sharp, slants), ends, towards);
            if self.faces_with_corner(towards) {
                // Balls that are all in the tool tell of a way what there is to tell of the corner.
                let tells = || sharp.way.is_none() || !holds_balls(self.tool);
                by_balls() || tells() && by_arcs()
            } else {
                by_arcs() || by_balls()
            }
        } else {
            sharp.keeps(ends[0].1)
        };
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        corner
            && if profile.lower.height > 0.0 {
                self.flank((sharp, slants), [floor(&tip), ends[0]], towards)
            } else {
                self.bottom(sharp, ends[0])
            }
            && (profile.top.height <= profile.upper.height
                || self.flank((sharp, slants), [ends[1], floor(&profile.top)], towards))
    }

    /// Whether the corner has the normal of the contact, and so the contact: the function for its balls then is as low as they are near.
    fn faces_with_corner(&self, towards: &Vec3) -> bool {
        let profile = &self.tool.profile;
        let lean = self.axis.dot(towards) * profile.arc;
        let down = |p: &ProfilePoint| profile.center.height - p.height;
        lean <= down(&profile.lower) + ROUNDING * profile.arc
            && lean >= down(&profile.upper) - ROUNDING * profile.arc
    }

    /// Half the slope of F at a point of the surface.
    pub(super) fn steepness(&self, point: &Vec3) -> f64 {
        self.form.stationary(&self.form.to_principal(point), 0.0).gradient.norm()
    }

    /// The function for a distance by the steepness of F at a contact, that steepness, and the direction in which the contact is
    /// left.
    pub(super) fn bound_from(&self, level: f64, contact: &Contact) -> Option<(Bound, f64, Vec3)> {
        let steepness = self.steepness(&contact.surface);
        let towards = self.form.direction_to_principal(&contact.gradient);
        if steepness <= 0.0 || steepness.is_nan() {
            return None;
        }
        Some((self.bound(level, steepness, &towards)?, steepness, towards))
    }

    /// How a function bends along straight lines of the tool.
    pub(super) fn slants(&self, bound: &Bound) -> Slants {
        let [uu, vv, uv] = bound.across;
        let along = bound.function.square.component_mul(&self.axis);
        Slants {
            upright: along.dot(&self.axis),
            tilt: length(self.across.each_ref().map(|u| along.dot(u))),
            sideways: 0.5 * (uu + vv) + length([0.5 * (uu - vv), uv]),
        }
    }

    /// The function for a distance that points must keep; for a depth, F for the tool shifted out by it.
    pub(super) fn bound(&self, distance: f64, steepness: f64, towards: &Vec3) -> Option<Bound> {
        let least = distance.max(0.0);
        let function = self.form.distance_bound(self.side, least / steepness)?;
        let [u, v] = &self.across;
        Some(Bound {
            across: [function.form(u, u), function.form(v, v), function.form(u, v)],
            tip: self.tip + towards * (least - distance),
            way: self.way,
            target: least * steepness,
            bow: self.way.map_or(0.0, |way| function.form(&way, &way).max(0.0)),
            function,
        })
    }

    /// Whether the corner keeps a distance, where its whole balls stand out from the tool: patches along the tangents at both
    /// ends of stretches of its arc have the arc behind them. An end that is the contact itself is no obstacle to that.
    pub(super) fn arcs(
        &self,
        (bound, slants): (&Bound, &Slants),
        ends: [Circled; 2],
        towards: &Vec3,
    ) -> bool {
        let ProfilePoint { radius, height } = self.tool.profile.center;
        let arc = self.tool.profile.arc;
        // A circle from the centre of the arc, along the sum of the ways to both ends of a stretch.
        let at = |along: [f64; 2], share: f64| {
            let circle =
                ProfilePoint { radius: radius + share * along[0], height: height + share * along[1] };
            (circle, self.floor(bound, &circle, towards))
        };
        // Circles of the arc itself are to keep it, however short the stretches are.
        let keep = |circles: &[Circled]| circles.iter().all(|(_, floor)| bound.keeps(*floor));
        if !keep(&ends) {
            return false;
        }
        let mut open = Vec::new();
        let mut stretch = Some(ends);
        let mut left = if bound.way.is_some() { MAX_ARCS_ON_WAY } else { MAX_ARCS };
        while let Some(ends) = stretch {
            if left == 0 {
                return false;
            }
            left -= 1;
            let [from, to] = ends.map(|(circle, _)| [circle.radius - radius, circle.height - height]);
            let sum = [from[0] + to[0], from[1] + to[1]];
            let apart = (from[0] * to[0] + from[1] * to[1]) / (arc * arc);
            let meeting = at(sum, 1.0 / (1.0 + apart));
            if ends.iter().all(|end| self.flank((bound, slants), [*end, meeting], towards)) {
                stretch = open.pop();
                continue;
            }
            let between = at(sum, arc / length(sum));
            if !keep(&[between]) {
                return false;
            }
            open.push([between, ends[1]]);
            stretch = Some([ends[0], between]);
        }
        true
    }

    /// A lower bound of a function over a circle about the axis, at both ends of the way.
    pub(super) fn floor(&self, bound: &Bound, circle: &ProfilePoint, towards: &Vec3) -> Floor {
        let here = self.floor_at(&bound.tip, bound, circle, towards);
        match bound.way {
            Some(way) if here >= bound.target => {
                [here, self.floor_at(&(bound.tip + way), bound, circle, towards)]
            }
            _ => [here; 2],
        }
    }

    /// The value of a function at the centre of the ball of a barrel's corner that is at the azimuth of the contact, at both ends of the
    /// way: that one ball holds all of the corner.
    fn floor_at_ball(&self, bound: &Bound, towards: &Vec3) -> Floor {
        let ProfilePoint { radius, height } = self.tool.profile.center;
        let facing = -(towards - self.axis * self.axis.dot(towards));
        let facing = facing.try_normalize(0.0).unwrap_or(self.across[0]);
        let center = bound.tip + self.axis * height + facing * radius;
        let here = bound.function.at(&center);
        [here, bound.way.map_or(here, |way| bound.function.at(&(center + way)))]
    }

    fn floor_at(&self, tip: &Vec3, bound: &Bound, circle: &ProfilePoint, towards: &Vec3) -> f64 {
        #[cfg(test)]
        FLOORS.set(FLOORS.get() + 1);
        let center = tip + self.axis * circle.height;
        let middle = bound.function.at(&center);
        let rho = circle.radius;
        if rho == 0.0 {
            return middle;
        }
        let slope = bound.function.half_gradient(&center);
        let [u, v] = &self.across;
        let [uu, vv, uv] = bound.across;
        let waves = Waves {
            constant: middle + 0.5 * rho * rho * (uu + vv),
            first: [2.0 * rho * slope.dot(u), 2.0 * rho * slope.dot(v)],
            second: [0.5 * rho * rho * (uu - vv), rho * rho * uv],
        };
        let coarse = waves.coarse_floor();
        if coarse >= bound.ample() { coarse } else { waves.floor([-towards.dot(u), -towards.dot(v)]) }
    }

    /// Whether a function is nowhere on the flat bottom below its target: not on its edge, and inside there is a least value
    /// only where the function is bowl-shaped. That the edge keeps its distance as part of the corner is not enough, for
    /// this function may be lower there than the one that shows it.
    pub(super) fn bottom(&self, bound: &Bound, (edge, floor): Circled) -> bool {
        let [uu, vv, uv] = bound.across;
        let determinant = uu * vv - uv * uv;
        let radius = edge.radius;
        if radius == 0.0 {
            // It is the edge, and the corner's.
            return true;
        }
        if !bound.keeps(floor) {
            return false;
        }
        if determinant <= 0.0 || uu + vv <= 0.0 {
            return true;
        }
        let inside = |tip: &Vec3, on_edge: f64| {
            let slope = bound.function.half_gradient(tip);
            let (a, b) = (slope.dot(&self.across[0]), slope.dot(&self.across[1]));
            let (x, y) = ((uv * b - vv * a) / determinant, (uv * a - uu * b) / determinant);
            if length([x, y]) >= radius { on_edge } else { bound.function.at(tip) + a * x + b * y }
        };
        let here = inside(&bound.tip, floor[0]);
        bound.keeps([here, bound.way.map_or(here, |way| inside(&(bound.tip + way), floor[1]))])
    }

    /// Whether a function is nowhere below its target on the patch between two circles. Along each straight line of the
    /// patch it is a parabola whose second derivative is known.
    pub(super) fn flank(
        &self,
        (bound, slants): (&Bound, &Slants),
        [(low, first), (high, last)]: [Circled; 2],
        towards: &Vec3,
    ) -> bool {
        let (rise, spread) = (high.height - low.height, high.radius - low.radius);
        let bend = slants.bend(rise, spread);
        let at = |t: f64| ProfilePoint { radius: low.radius + t * spread, height: low.height + t * rise };
        let floor = |t: f64| self.floor(bound, &at(t), towards);
        if !(bound.keeps(first) && bound.keeps(last)) {
            return false;
        }
        let between = |start: Floor, end: Floor, bend: f64| {
            let here = least_between(start[0], end[0], bend);
            [here, if bound.way.is_some() { least_between(start[1], end[1], bend) } else { here }]
        };
        let mut open = Vec::new();
        let mut part = Some((0.0, first, 1.0, last));
        let mut count = 0;
        while let Some((from, start, to, end)) = part {
            if bound.keeps(between(start, end, bend * (to - from) * (to - from))) {
                part = open.pop();
            } else {
                count += 1;
                let middle = 0.5 * (from + to);
                let value = floor(middle);
                if count > MAX_PARTS || !bound.keeps(value) {
                    return false;
                }
                open.push((middle, value, to, end));
                part = Some((from, start, middle, value));
            }
        }
        true
    }
}

/// Least value of a parabola between the values at both ends of [0, 1], given half its second derivative.
fn least_between(start: f64, end: f64, bend: f64) -> f64 {
    let ends = start.min(end);
    if bend <= 0.0 {
        return ends;
    }
    let t = 0.5 * (start - end + bend) / bend;
    if t > 0.0 && t < 1.0 { start + (end - start - bend * (1.0 - t)) * t } else { ends }
}

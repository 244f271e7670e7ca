//! Contact with tabulated cylinders, ruled and polyconic surfaces from the last contact near by.
//!
//! Newton's method moves the azimuth on a circle of the tool and the place of the surface at once. What it finds is the
//! contact if the tool about it lies in a ball that is known to be steady: there the distance falls below its tangent by no
//! more than a sphere's does, and circles of the tool have closed bounds. The rest of the flank is far away, as is
//! shown once for many positions.

mod around;
mod zone;

use apt_geometry::{
    Vec3,
    surface::{Chart, Place, Steady, Surface},
};

pub(super) use self::around::Around;
use super::{
    Contact, Tool,
    certify::{Certificate, Face, Proof, certify},
    memory::Memory,
    patch::flank_from,
    search::FAN_SLACK,
    tool::Piece,
    waves::{length, turned},
};

/// Bound of Newton's method: without convergence the general search takes over.
const MAX_ITERATIONS: u32 = 12;
/// A step below this share of the sizes is the last one: what is left is of the order of its square.
const NEARLY: f64 = 1e-7;
/// Largest azimuth step, radians.
const LARGEST_STEP: f64 = 0.5;
/// Shares of the size of the tool and of the coordinates that are rounding of a distance.
const ROUNDING: f64 = 1e-12;
const COORDINATES: f64 = 1e-14;
/// Share of the greatest possible bend of the distance along a circle that is rounding.
const NO_BEND: f64 = 1e-12;
/// The same on the flat bottom: below it a bend is too weak to be followed.
const FLAT: f64 = 1e-9;
/// Distance from the axis, in radii of a flat bottom, beyond which contact is not looked for on it.
const BESIDE: f64 = 3.0;
/// Sizes of a steady ball that are tried: how far the tool may move in it, and how much of the flank it holds above the
/// corner; in radii of the tool.
const BALLS: [[f64; 2]; 6] =
    [[0.8, f64::INFINITY], [0.8, 1.0], [0.8, 0.3], [0.3, 0.3], [0.1, 0.1], [0.03, 0.05]];
/// Share of the distance that the tool may move in a ball by which it lies ahead.
const AHEAD: f64 = 0.75;
/// Sizes of balls for a single point.
const POINT_BALLS: [f64; 4] = [2.0, 0.5, 0.1, 0.02];
/// Way, in radii of the tool, after which a ball is tried for again.
const PATIENCE: f64 = 0.1;
/// Radius, as a share of its height, that a thin tool counts with.
const SLENDER: f64 = 0.05;
/// Shares of the radius by which the flank is first shown to be farther away than contact, and then less.
const FAR: [f64; 3] = [0.5, 0.1, 0.02];
/// How much deeper than at first the tool may come to lie in a steady ball.
const DEEPER: f64 = 1.2;
/// Bound of the stretches of the corner's arc that are looked at, and half the widest one (radians): the tangents at its ends meet
/// near by.
const MAX_ARCS: u32 = 24;
const WIDEST_ARC: f64 = 0.8;
/// Bound of the balls that cover a flank, and the shortest stretch, in radii of the tool, that one of them covers.
const MAX_COVER: u32 = 40;
const SHORTEST: f64 = 0.1;

/// A contact near by with what is known about it.
#[derive(Debug, Clone)]
pub(crate) struct Near {
    side: f64,
    start: Start,
    /// The surface's point at the last contact.
    surface: Vec3,
    zone: Result<Zone, Vec3>,
    far: Option<Far>,
    /// Where that was not shown.
    doubtful: Option<Vec3>,
}

/// Where Newton's method begins.
#[derive(Debug, Clone, Copy)]
struct Start {
    /// Index of the circle or the flat bottom among the pieces of the tool; `None` for the tool end.
    piece: Option<usize>,
    /// Cosine and sine of the azimuth; coordinates across the axis on the flat bottom.
    direction: [f64; 2],
    place: Place,
}

/// A steady ball, and the height up to which the tool is to lie in it.
#[derive(Debug, Clone, Copy)]
struct Zone {
    center: Vec3,
    radius: f64,
    /// Greatest distance from the surface for which it is steady.
    depth: f64,
    top: f64,
    /// Which of the sizes it has.
    size: usize,
    steady: Steady,
}

/// The flank above a height keeps a distance.
#[derive(Debug, Clone, Copy)]
struct Far {
    tip: Vec3,
    axis: Vec3,
    from: f64,
    level: f64,
}

/// A circle of balls about the tool axis; a point for radius 0.
#[derive(Debug, Clone, Copy)]
struct Circle {
    radius: f64,
    height: f64,
    ball: f64,
}

/// What Newton's method found.
struct Touch {
    contact: Contact,
    /// The point of the circle.
    center: Vec3,
    circle: Circle,
    start: Start,
}

/// What following the last contact has found.
pub(super) enum Followed {
    /// The contact, and how much nearer another point may be.
    Proven(Contact, f64),
    /// Contact of a piece of the tool, perhaps not the nearest.
    Likely(usize, Contact),
    /// Nothing.
    Lost,
}

/// The contact near the last one.
pub(super) fn contact(tool: &Tool, surface: &Surface, side: f64, tip: &Vec3, memory: &Memory) -> Followed {
    let Ok(mut memory) = memory.near.try_borrow_mut() else { return Followed::Lost };
    if !surface.has_charts() {
        return Followed::Lost;
    }
    let pose = Pose { tool, surface, side, tip };
    let known = match memory.as_mut().filter(|known| known.side == side) {
        Some(known) => known,
        None => match pose.first() {
            Some(first) => memory.insert(first),
            None => return Followed::Lost,
        },
    };
    let Some(found) = known.touch(&pose) else { return Followed::Lost };
    let slack = pose.slack();
    if known.proves(&pose, &found, slack) {
        (known.start, known.surface) = (found.start, found.contact.surface);
        return Followed::Proven(found.contact, slack);
    }
    found.start.piece.map_or(Followed::Lost, |piece| Followed::Likely(piece, found.contact))
}

/// Keeps a contact of the tool.
pub(super) fn remember(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: &Memory,
    contact: &Contact,
) {
    let Ok(mut memory) = memory.near.try_borrow_mut() else { return };
    let pose = Pose { tool, surface, side, tip };
    let Some(piece) = pose.circle_towards(&contact.gradient) else { return };
    let Some(circle) = pose.circle(Some(piece)) else { return };
    let Some(place) = surface.place(&(contact.tool + contact.gradient * circle.ball)) else { return };
    let start = Start { piece: Some(piece), direction: pose.facing(&contact.gradient), place };
    match memory.as_mut().filter(|known| known.side == side) {
        Some(known) => (known.start, known.surface) = (start, contact.surface),
        None => *memory = Some(Near::new(side, start, contact.surface)),
    }
}

/// The foot of the tool end itself with its signed distance, as a contact.
pub(super) fn foot(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: &Memory,
) -> Option<Contact> {
    if !surface.has_charts() {
        return None;
    }
    let mut memory = memory.near.try_borrow_mut().ok()?;
    let pose = Pose { tool, surface, side, tip };
    let known = match memory.as_mut().filter(|known| known.side == side) {
        Some(known) => known,
        None => {
            let start = Start { piece: None, direction: [1.0, 0.0], place: surface.place(tip)? };
            memory.insert(Near::new(side, start, *tip))
        }
    };
    match pose.touch(&known.start) {
        Some(found) if known.is_steady(&pose, &found) => {
            (known.start, known.surface) = (found.start, found.contact.surface);
            Some(found.contact)
        }
        _ => {
            known.start.place = surface.place(tip)?;
            None
        }
    }
}

impl Near {
    /// A contact about which nothing is known.
    fn new(side: f64, start: Start, surface: Vec3) -> Self {
        let zone = Err(Vec3::repeat(f64::INFINITY));
        Self { side, start, surface, zone, far: None, doubtful: None }
    }

    /// A contact on the last piece of the tool or on the one that faces the surface.
    fn touch(&self, pose: &Pose<'_>) -> Option<Touch> {
        let first = pose.touch(&self.start);
        match first {
            Some(found) if pose.is_apt(&found) => Some(found),
            other => {
                let start = pose.instead(&self.start, other.as_ref())?;
                pose.touch(&start).filter(|found| pose.is_apt(found))
            }
        }
    }

    /// Whether no point of the tool is nearer than the contact by more than a slack.
    fn proves(&mut self, pose: &Pose<'_>, found: &Touch, slack: f64) -> bool {
        if !self.is_steady(pose, found) {
            return false;
        }
        let Ok(zone) = self.zone else { return false };
        pose.keeps(&found.contact, found.circle.ball, &zone, found.contact.clearance - slack)
            && (zone.top >= pose.tool.profile.top.height || self.is_alone(pose, found, zone.top, slack))
    }

    /// Whether the tool about a contact, and the contact, are within a steady ball.
    fn is_steady(&mut self, pose: &Pose<'_>, found: &Touch) -> bool {
        let kept = self.zone.as_ref().is_ok_and(|zone| pose.is_in(zone, found));
        if !kept {
            let again = match &self.zone {
                Ok(_) => true,
                Err(tried) => (pose.tip - tried).norm() > PATIENCE * pose.scale(),
            };
            if again {
                self.zone = pose.zone(found, self.zone.as_ref().ok()).ok_or(*pose.tip);
            }
        }
        let Ok(zone) = &self.zone else { return false };
        pose.is_in(zone, found) && found.contact.clearance + found.circle.ball >= -zone.steady.beyond
    }

    /// Whether the flank above a height is no nearer than the contact.
    fn is_alone(&mut self, pose: &Pose<'_>, found: &Touch, from: f64, slack: f64) -> bool {
        let level = found.contact.clearance - slack;
        if self.far.is_some_and(|far| far.from == from && far.keeps(pose, level)) {
            return true;
        }
        if self.doubtful.is_some_and(|tried| (pose.tip - tried).norm() <= PATIENCE * pose.scale()) {
            return false;
        }
        let face = Face { surface: pose.surface, side: pose.side };
        for share in FAR {
            let level = level + share * pose.scale();
            let mut proof = Proof::of(vec![flank_from(pose.tool, from)]);
            if pose.is_off(from, level)
                || certify(face, pose.tool, pose.tip, level, &mut proof, None) == Certificate::Holds
            {
                self.far = Some(Far { tip: *pose.tip, axis: pose.tool.axis, from, level });
                self.doubtful = None;
                return true;
            }
        }
        self.doubtful = Some(*pose.tip);
        false
    }
}

impl Far {
    /// Whether the flank keeps a level also in another position: its points move no farther than the end does and the turn
    /// of the axis takes the farthest of them.
    fn keeps(&self, pose: &Pose<'_>, level: f64) -> bool {
        let profile = &pose.tool.profile;
        let reach = profile.top.height.hypot(pose.tool.radius());
        let moved = (pose.tip - self.tip).norm() + reach * (pose.tool.axis - self.axis).norm();
        self.level - moved >= level
    }
}

/// How the nearest place of a surface follows a motion of a point.
struct Follow {
    first: [Vec3; 2],
    /// Inverse of half the second derivatives of the squared distance by the place.
    inverse: [f64; 3],
}

impl Follow {
    /// For a point at an offset from a place that is its nearest one, or nearly; `None` if it is not the nearest around.
    fn new(chart: &Chart, offset: &Vec3) -> Option<Self> {
        let ([u, v], [uu, uv, vv]) = (chart.first, chart.second);
        let a = u.norm_squared() - offset.dot(&uu);
        let b = u.dot(&v) - offset.dot(&uv);
        let c = v.norm_squared() - offset.dot(&vv);
        let determinant = a * c - b * b;
        let inverse = [c, -b, a].map(|x| x / determinant);
        (determinant > 0.0 && a > 0.0).then_some(Self { first: [u, v], inverse })
    }

    fn step(&self, way: &Vec3) -> [f64; 2] {
        let [x, y] = self.first.map(|first| first.dot(way));
        let [xx, xy, yy] = self.inverse;
        [xx * x + xy * y, xy * x + yy * y]
    }
}

/// A normal of any length to a side, and how it changes with the place.
fn normal_changes(chart: &Chart, side: f64) -> (Vec3, [Vec3; 2]) {
    let ([u, v], [uu, uv, vv]) = (chart.first, chart.second);
    let sense = chart.sense * side;
    (u.cross(&v) * sense, [uu.cross(&v) + u.cross(&uv), uv.cross(&v) + u.cross(&vv)].map(|c| c * sense))
}

/// Newton's step to the least value of a function of two coordinates, along the directions in which it bends. `scale` is a
/// bend that is not small. `None` where the function bends downward.
fn valley([xx, xy, yy]: [f64; 3], slope: [f64; 2], scale: f64) -> Option<[f64; 2]> {
    let (mean, half) = (0.5 * (xx + yy), length([0.5 * (xx - yy), xy]));
    // The direction of the greater bend.
    let (sin, cos) = (0.5 * xy.atan2(0.5 * (xx - yy))).sin_cos();
    let mut step = [0.0; 2];
    for (bend, [x, y]) in [(mean + half, [cos, sin]), (mean - half, [-sin, cos])] {
        let fall = slope[0] * x + slope[1] * y;
        if bend > FLAT * scale {
            step = [step[0] - fall / bend * x, step[1] - fall / bend * y];
        } else if bend < -FLAT * scale {
            return None;
        }
    }
    Some(step)
}

/// A tool in a position beside a surface.
#[derive(Clone, Copy)]
struct Pose<'a> {
    tool: &'a Tool,
    surface: &'a Surface,
    side: f64,
    tip: &'a Vec3,
}

impl Pose<'_> {
    /// Rounding of a distance.
    fn slack(&self) -> f64 {
        ROUNDING * (self.tool.radius() + self.tool.profile.top.height) + COORDINATES * self.tip.amax()
    }

    /// The length that sizes of balls are measured by.
    fn scale(&self) -> f64 {
        let height = SLENDER * self.tool.profile.top.height;
        let scale = self.tool.radius().max(height);
        if scale > 0.0 { scale } else { 1.0 }
    }

    /// Where contact may be, seen from the corner of the tool.
    fn first(&self) -> Option<Near> {
        let middle = self.tip + self.tool.axis * self.tool.profile.center.height;
        let foot = self.surface.foot(&middle);
        let gradient = foot.normal * self.side;
        let (piece, place) = (Some(self.circle_towards(&gradient)?), self.surface.place(&middle)?);
        let start = Start { piece, direction: self.facing(&gradient), place };
        Some(Near::new(self.side, start, foot.point))
    }

    fn circle(&self, piece: Option<usize>) -> Option<Circle> {
        let Some(piece) = piece else { return Some(Circle { radius: 0.0, height: 0.0, ball: 0.0 }) };
        match self.tool.pieces.get(piece)? {
            &Piece::Ring { radius, height, ball, .. } => Some(Circle { radius, height, ball }),
            _ => None,
        }
    }

    /// The circle of the tool that a surface with a normal touches first.
    fn circle_towards(&self, gradient: &Vec3) -> Option<usize> {
        let profile = &self.tool.profile;
        let (along, across, _) = self.tool.split(gradient);
        let polar = across.atan2(along);
        let point = profile.support(across, -along).1;
        let round = profile.arc > 0.0 && polar >= profile.fan[0] && polar <= profile.fan[1];
        self.tool.pieces.iter().position(|piece| match piece {
            Piece::Ring { fan: Some(_), .. } => round,
            Piece::Ring { radius, height, .. } => {
                !round && *radius == point.radius && *height == point.height
            }
            _ => false,
        })
    }

    /// Azimuth of the side of the tool that faces a surface with a normal.
    fn facing(&self, gradient: &Vec3) -> [f64; 2] {
        let flat = self.tool.across.map(|across| -gradient.dot(&across));
        let size = length(flat);
        if size > 0.0 { flat.map(|x| x / size) } else { [1.0, 0.0] }
    }

    /// Whether a contact is one of the tool: the corner has it within its fan, and a flat bottom inside.
    fn is_apt(&self, touch: &Touch) -> bool {
        match touch.start.piece.and_then(|piece| self.tool.pieces.get(piece)) {
            Some(Piece::Ring { radius, fan, .. }) => {
                let polar = touch.contact.gradient.dot(&self.tool.axis).clamp(-1.0, 1.0).acos();
                (*radius <= 0.0 || self.faces(touch))
                    && fan.is_none_or(|[least, greatest]| {
                        polar >= least - FAN_SLACK && polar <= greatest + FAN_SLACK
                    })
            }
            Some(Piece::Disc { radius }) => length(touch.start.direction) <= *radius,
            _ => true,
        }
    }

    /// Whether a point of a circle is on the side of the tool that faces the surface.
    fn faces(&self, touch: &Touch) -> bool {
        let outward = touch.center - self.tip;
        let shares = self.tool.across.map(|a| a.dot(&outward) * a.dot(&touch.contact.gradient));
        shares[0] + shares[1] <= 0.0
    }

    /// Where to look instead of a piece of the tool that has no contact.
    fn instead(&self, start: &Start, found: Option<&Touch>) -> Option<Start> {
        let pieces = &self.tool.pieces;
        let lower = self.tool.profile.lower;
        let last = found.map_or(*start, |found| found.start);
        if let Piece::Disc { .. } = pieces.get(start.piece?)? {
            let reach = length(last.direction);
            let round = self.tool.profile.arc > 0.0;
            let piece = pieces.iter().position(|piece| match piece {
                Piece::Ring { fan: Some(_), .. } => round,
                Piece::Ring { radius, height, .. } => {
                    !round && *radius == lower.radius && *height == lower.height
                }
                _ => false,
            });
            return (reach > 0.0).then(|| Start {
                piece,
                direction: last.direction.map(|x| x / reach),
                ..last
            });
        }
        match found {
            Some(found) if self.faces(found) => {
                let gradient = &found.contact.gradient;
                let piece = Some(self.circle_towards(gradient)?);
                Some(Start { piece, direction: self.facing(gradient), ..last })
            }
            _ => {
                let disc = pieces.iter().position(|piece| matches!(piece, Piece::Disc { .. }))?;
                Some(Start { piece: Some(disc), direction: last.direction.map(|x| x * lower.radius), ..last })
            }
        }
    }

    /// The stationary distance of a piece of the tool near a start.
    fn touch(&self, start: &Start) -> Option<Touch> {
        if let Some(Piece::Disc { radius }) = start.piece.and_then(|piece| self.tool.pieces.get(piece)) {
            return self.touch_bottom(start, *radius);
        }
        let circle = self.circle(start.piece)?;
        let Tool { axis, across, .. } = self.tool;
        let base = self.tip + axis * circle.height;
        let radial = |[c, s]: [f64; 2]| across[0] * c + across[1] * s;
        let Start { mut direction, mut place, .. } = *start;
        let resolution = NEARLY * self.scale();
        for _ in 0..MAX_ITERATIONS {
            let outward = radial(direction) * circle.radius;
            let onward = radial([-direction[1], direction[0]]) * circle.radius;
            let center = base + outward;
            let chart = self.surface.chart(&place)?;
            let offset = center - chart.point;
            let follow = Follow::new(&chart, &offset)?;
            let mut step = follow.step(&offset);
            let mut turn = 0.0;
            if circle.radius > 0.0 {
                let (normal, change) = normal_changes(&chart, self.side);
                let along = |x: [f64; 2]| change[0].dot(&onward) * x[0] + change[1].dot(&onward) * x[1];
                let drift = follow.step(&onward);
                let bend = along(drift) - normal.dot(&outward);
                let slope = normal.dot(&onward) + along(step);
                if bend > NO_BEND * normal.norm() * circle.radius {
                    turn = (-slope / bend).clamp(-LARGEST_STEP, LARGEST_STEP);
                    step = [step[0] + drift[0] * turn, step[1] + drift[1] * turn];
                    direction = turned(direction, turn);
                } else if slope.abs() > NEARLY * normal.norm() * circle.radius {
                    // On a hill: the valley is where the tool faces the surface.
                    direction = self.facing(&normal);
                    let way = follow.step(&(radial(direction) * circle.radius - outward));
                    step = [step[0] + way[0], step[1] + way[1]];
                    turn = 1.0;
                }
            }
            let last = place;
            place = self.surface.shifted(&last, step)?;
            let moved =
                (chart.first[0] * step[0] + chart.first[1] * step[1]).norm() + turn.abs() * circle.radius;
            if moved <= resolution {
                let start = Start { piece: start.piece, direction, place };
                let chart = self.surface.chart_beside(&place, (&last, &chart), step)?;
                return self.made(circle, base + radial(direction) * circle.radius, start, &chart);
            }
            if moved.is_nan() {
                return None;
            }
        }
        None
    }

    /// The place of the flat bottom, or of its plane beside it, where the distance is stationary.
    fn touch_bottom(&self, start: &Start, radius: f64) -> Option<Touch> {
        let [x, y] = &self.tool.across;
        let Start { direction: mut at, mut place, .. } = *start;
        let resolution = NEARLY * self.scale();
        for _ in 0..MAX_ITERATIONS {
            let chart = self.surface.chart(&place)?;
            let offset = self.tip + x * at[0] + y * at[1] - chart.point;
            let follow = Follow::new(&chart, &offset)?;
            let (normal, change) = normal_changes(&chart, self.side);
            let rest = follow.step(&offset);
            let drift = [follow.step(x), follow.step(y)];
            let along = |way: &Vec3, by: [f64; 2]| change[0].dot(way) * by[0] + change[1].dot(way) * by[1];
            let slope = [normal.dot(x) + along(x, rest), normal.dot(y) + along(y, rest)];
            let mixed = 0.5 * (along(x, drift[1]) + along(y, drift[0]));
            let bends = [along(x, drift[0]), mixed, along(y, drift[1])];
            let step = valley(bends, slope, normal.norm() / radius)?;
            let share = (radius / length(step)).min(1.0);
            let step = if share.is_nan() { step } else { step.map(|s| s * share) };
            at = [at[0] + step[0], at[1] + step[1]];
            let by: [f64; 2] =
                std::array::from_fn(|k| rest[k] + drift[0][k] * step[0] + drift[1][k] * step[1]);
            place = self.surface.shifted(&place, by)?;
            let moved = (chart.first[0] * by[0] + chart.first[1] * by[1]).norm() + length(step);
            if moved <= resolution || length(at) > BESIDE * radius {
                let center = self.tip + x * at[0] + y * at[1];
                let start = Start { piece: start.piece, direction: at, place };
                let chart = self.surface.chart(&place)?;
                return self.made(Circle { radius: 0.0, height: 0.0, ball: 0.0 }, center, start, &chart);
            }
            if moved.is_nan() {
                return None;
            }
        }
        None
    }

    fn made(&self, circle: Circle, center: Vec3, start: Start, chart: &Chart) -> Option<Touch> {
        let normal = chart.first[0].cross(&chart.first[1]).try_normalize(0.0)? * chart.sense;
        let distance = (center - chart.point).dot(&normal) - chart.thickness;
        let gradient = normal * self.side;
        let contact = Contact {
            clearance: self.side * distance - circle.ball,
            gradient,
            tool: center - gradient * circle.ball,
            surface: center - normal * distance,
        };
        Some(Touch { contact, center, circle, start })
    }
}

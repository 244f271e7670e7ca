//! Quadrics, cylinders and cones touched by a circle of the tool: contact and proof in the principal coordinates of the
//! surface.
//!
//! Contact on an edge or on the corner (a circle of balls) is found by Newton's method for azimuth and multiplier of
//! the nearest point at once, from the last contact near by. That it is the nearest of the whole tool is shown by
//! tangent planes for convex solids, and for all others by quadratic functions below the squared distance, which have
//! closed bounds over whole circles and patches of the tool.

mod floor;
mod halves;
mod patch;

use std::borrow::Cow;

use apt_geometry::{
    Vec3,
    cutter::ProfilePoint,
    surface::{PrincipalQuadric, Stationary, Surface},
};

#[cfg(test)]
pub(crate) use self::floor::FLOORS;
use super::{
    Contact, Shape, Tool,
    memory::{Memory, Place},
    open_top::is_entered,
    round::Round,
    search::MISSED,
    shape,
    tool::{Circle, Piece},
    waves::turned,
};

#[cfg(test)]
thread_local! {
    /// Steps of Newton's method to contacts that this thread has made.
    pub(crate) static STEPS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Bound of Newton's method: without convergence the general search takes over.
const MAX_ITERATIONS: u32 = 12;
/// A last step below this, in radians and as a share of the radii of curvature, ends it: what is left is its square, and
/// the clearance errs by the square of that.
const NEARLY: f64 = 1e-5;
/// Rounding of a cosine.
const ROUNDING: f64 = 1e-12;
/// Largest azimuth step, radians.
const LARGEST_STEP: f64 = 0.5;
/// Share of the way to a pole of the multiplier that one step may go.
const TO_POLE: f64 = 0.9;
/// Gap between contact and tangent plane, relative to the sizes, that is rounding.
const GAP: f64 = 1e-13;
/// Depth of a cut, as a share of the radii of tool and solid, up to which it has one way out.
const SLIGHT: f64 = 0.05;
/// Shares of the size of the tool by which another point of it may be nearer: what rounding leaves, which is less than the depth of a
/// place beside a limit of the band must be known to, and what a search leaves.
const SLACKS: [f64; 2] = [1e-12, MISSED];

/// Tool and surface in the principal coordinates of the surface.
pub(super) struct Posed<'a> {
    form: Cow<'a, PrincipalQuadric>,
    tool: &'a Tool<'a>,
    side: f64,
    tip: Vec3,
    axis: Vec3,
    across: [Vec3; 2],
    /// The straight way from here to another tool end, on all of which bounds are to hold.
    way: Option<Vec3>,
}

/// A contact on a circle.
pub(super) struct Touch {
    pub(super) contact: Contact,
    /// Cosine of the angle between tool axis and surface normal.
    pub(super) lean: f64,
    /// Where to begin the next time.
    pub(super) start: Start,
}

/// Where the search on a circle begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    /// Cosine and sine of the azimuth.
    pub(super) direction: [f64; 2],
    /// The multiplier of the nearest point, if it is known.
    pub(super) multiplier: Option<f64>,
}

/// The contact on the part of the tool where the last one was, or on the one before from which it jumped, if it is proven; and
/// how much nearer another point may be.
pub(super) fn contact(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: &Memory,
) -> Option<(Contact, f64)> {
    let (last, other) = memory.places(tool, side, tip)?;
    // Large, and so not moved out of where it was made.
    let Some(scene) = &Scene::new(tool, surface, side, tip) else { return None };
    let near = |place: &Place| scene.touch(tool.pieces.get(place.piece)?, &place.point, &place.start(tool));
    let (there, elsewhere) = (near(&last), other.as_ref().and_then(near));
    let (place, touch) = match (&there, &other, &elsewhere) {
        (Some(there), Some(other), Some(elsewhere)) => {
            let farther = elsewhere.contact.clearance - there.contact.clearance;
            if farther >= 0.0 {
                memory.note_farther(tip, farther);
            }
            if farther < 0.0 { (other, elsewhere) } else { (&last, there) }
        }
        (Some(there), ..) => (&last, there),
        (None, Some(other), Some(elsewhere)) => (other, elsewhere),
        (None, ..) => return None,
    };
    scene.proven(place.piece, touch, Some(memory))
}

/// The contact on whichever part of the tool it is, if that is proven; and how much nearer another point may be.
pub(super) fn contact_anywhere(
    tool: &Tool,
    surface: &Surface,
    side: f64,
    tip: &Vec3,
    memory: Option<&Memory>,
) -> Option<(Contact, f64)> {
    let scene = Scene::new(tool, surface, side, tip)?;
    let foot = surface.foot(&(tip + tool.axis * tool.profile.corner_height()));
    let radial = tool.split(&(foot.normal * -side)).2;
    let direction = [radial.dot(&tool.across[0]), radial.dot(&tool.across[1])];
    let start = Start { direction, multiplier: None };
    let is_circle = |piece: &Piece| matches!(piece, Piece::Ring { .. });
    let pieces = || tool.pieces.iter().enumerate();
    let mut found: Vec<(usize, Touch)> = pieces()
        .filter(|(_, piece)| is_circle(piece))
        .filter_map(|(index, piece)| Some((index, scene.touch(piece, &Vec3::zeros(), &start)?)))
        .collect();
    // Contact inside a patch is looked for from every circle.
    let circles = found.len();
    for (index, piece) in pieces().filter(|(_, piece)| !is_circle(piece)) {
        for circle in 0..circles {
            let from = found.get(circle).map(|(_, from)| (from.contact.tool - tip, from.start));
            let touch = from.and_then(|(last, start)| scene.touch(piece, &last, &start));
            found.extend(touch.map(|touch| (index, touch)));
        }
    }
    if found.is_empty() {
        found = scene.on_either_half();
    }
    let (piece, touch) =
        found.iter().min_by(|(_, a), (_, b)| a.contact.clearance.total_cmp(&b.contact.clearance))?;
    if let Means::Round(round) = &scene.means
        && touch.contact.clearance < -SLIGHT * tool.radius().min(round.width())
    {
        // Far in, there may be a shorter way out elsewhere.
        return None;
    }
    if let Some(proven) = scene.proven(*piece, touch, memory) {
        return Some(proven);
    }
    let (piece, touch) = scene.on_the_other_half(touch)?;
    scene.proven(piece, &touch, memory)
}

/// Tool and surface, as contacts on circles are looked for.
struct Scene<'a> {
    tool: &'a Tool<'a>,
    surface: &'a Surface,
    side: f64,
    tip: &'a Vec3,
    means: Means<'a>,
}

/// How contacts are found and proven.
enum Means<'a> {
    /// The tool outside a cylinder or cone.
    Round(Round<'a>),
    /// The tool outside any other convex solid.
    Convex(Posed<'a>),
    /// Anything else.
    General(Posed<'a>),
}

impl<'a> Scene<'a> {
    /// `None` for surfaces that are no quadrics.
    fn new(tool: &'a Tool<'a>, surface: &'a Surface, side: f64, tip: &'a Vec3) -> Option<Self> {
        let scene = |means: Means<'a>| Self { tool, surface, side, tip, means };
        let convex = shape(surface, side) == Shape::Convex;
        match Round::new(surface) {
            Some(round) if convex => Some(scene(Means::Round(round))),
            _ if convex => Some(scene(Means::Convex(Posed::new(tool, surface, side, tip)?))),
            _ => Some(scene(Means::General(Posed::new(tool, surface, side, tip)?))),
        }
    }

    /// The contact on a piece of the tool, near the last one (from the tool end) and a start, if it is a way out.
    fn touch(&self, piece: &Piece, last: &Vec3, start: &Start) -> Option<Touch> {
        let touch = match (piece, &self.means) {
            (&Piece::Ring { radius, height, ball, fan }, _) => {
                self.touch_circle(&Circle { radius, height, ball }, fan.is_some(), start)?
            }
            (&Piece::Frustum { radius, height }, Means::Round(round)) => {
                round.touch_line(self.tool, self.tip, [radius, height], start.direction)?
            }
            (_, Means::Round(_)) => return None,
            (_, Means::Convex(posed) | Means::General(posed)) => posed.touch_patch(piece, last, start)?,
        };
        is_way_out(self.tool, self.surface, &touch.contact).then_some(touch)
    }

    /// The contact on a circle; on the corner its normal must be one of the corner's own.
    fn touch_circle(&self, circle: &Circle, is_corner: bool, start: &Start) -> Option<Touch> {
        let touch = match &self.means {
            Means::Convex(posed) | Means::General(posed) if circle.radius == 0.0 => {
                posed.touch_on_axis(circle, start).or_else(|| self.touch_on_axis(circle))?
            }
            _ if circle.radius == 0.0 => self.touch_on_axis(circle)?,
            Means::Round(round) => round.touch(self.tool, self.tip, circle, start.direction)?,
            Means::Convex(posed) | Means::General(posed) => posed.touch(circle, start)?,
        };
        if is_corner {
            // Cosines of the polar angles, from straight down, between which the corner has its normals.
            let down = |p: &ProfilePoint| (circle.height - p.height) / circle.ball;
            let profile = &self.tool.profile;
            if touch.lean > down(&profile.lower) + ROUNDING || touch.lean < down(&profile.upper) - ROUNDING {
                return None;
            }
        }
        Some(touch)
    }

    /// The contact of a ball about a point of the axis.
    fn touch_on_axis(&self, circle: &Circle) -> Option<Touch> {
        let center = self.tip + self.tool.axis * circle.height;
        let foot = self.surface.foot(&center);
        let (distance, gradient) = (self.side * foot.distance, foot.normal * self.side);
        let contact = Contact {
            clearance: distance - circle.ball,
            gradient,
            tool: center - gradient * circle.ball,
            surface: foot.point,
        };
        let (direction, lean) = on_axis(self.tool, &contact);
        let start = Start { direction, multiplier: None };
        (circle.ball <= 0.0 || distance > 0.0).then_some(Touch { contact, lean, start })
    }

    /// The contact, if no other point of the tool is nearer but for what is told.
    fn proven(&self, piece: usize, touch: &Touch, memory: Option<&Memory>) -> Option<(Contact, f64)> {
        let Self { tool, side, tip, .. } = *self;
        let Touch { contact, start, .. } = *touch;
        let missed = match &self.means {
            // Also on the corner: the ball may face the surface from inside the tool, above its flat bottom.
            Means::Round(_) | Means::Convex(_) if touches_by_plane(tool, &contact, tip) => 0.0,
            Means::Round(_) => return None,
            Means::Convex(_) if !is_entered(tool, self.surface, side, [tip, tip]) => return None,
            Means::Convex(posed) | Means::General(posed) => {
                let size = tool.radius() + tool.profile.top.height;
                let keeps = |slack: &f64| posed.clears(contact.clearance - slack, &contact);
                SLACKS.map(|share| share * size).into_iter().find(keeps)?
            }
        };
        if let Some(memory) = memory {
            let point = contact.tool - tip;
            memory.remember(tool, side, tip, Place { piece, point, start: Some(start) });
        }
        Some((contact, missed))
    }
}

/// Whether a contact with a cone is one with this nappe (F has the other one too), and not one where the tool cuts in near
/// the vertex: there another way out may be shorter.
pub(super) fn is_way_out(tool: &Tool, surface: &Surface, contact: &Contact) -> bool {
    let Surface::Cone(cone) = surface else { return true };
    let foot = contact.surface - cone.vertex;
    foot.dot(&cone.axis) > 0.0 && (contact.clearance > 0.0 || foot.norm() > tool.radius())
}

/// The azimuth at which a contact on the axis leaves it, should it do so (cosine, sine), and the cosine of the angle between tool axis and surface
/// normal.
fn on_axis(tool: &Tool, contact: &Contact) -> ([f64; 2], f64) {
    let (along, _, radial) = tool.split(&-contact.gradient);
    ([0, 1].map(|k| radial.dot(&tool.across[k])), -along)
}

/// Whether the tangent plane at a contact has the whole tool on one side, a convex solid being on the other: two convex
/// bodies are nearest where their normals match.
fn touches_by_plane(tool: &Tool, contact: &Contact, tip: &Vec3) -> bool {
    let size = tool.radius() + tool.profile.top.height + (tip - contact.surface).norm();
    above_plane(tool, contact, tip) >= contact.clearance - GAP * size
}

/// Distance of the tool from the tangent plane at a contact.
fn above_plane(tool: &Tool, contact: &Contact, tip: &Vec3) -> f64 {
    let (along, across, _) = tool.split(&contact.gradient);
    contact.gradient.dot(&(tip - contact.surface)) - tool.profile.support(across, -along).0
}

impl<'a> Posed<'a> {
    /// `None` for surfaces that are no quadrics.
    pub(super) fn new(tool: &'a Tool<'a>, surface: &'a Surface, side: f64, tip: &Vec3) -> Option<Self> {
        let form = surface.principal_quadric()?;
        let axis = form.direction_to_principal(&tool.axis);
        let across = [0, 1].map(|k| form.direction_to_principal(&tool.across[k]));
        let tip = form.to_principal(tip);
        Some(Self { form, tool, side, tip, axis, across, way: None })
    }

    /// The same on the straight way from here to another tool end.
    pub(super) fn on_the_way_to(self, end: &Vec3) -> Self {
        let way = self.form.to_principal(end) - self.tip;
        Self { way: Some(way), ..self }
    }

    /// The contact of a circle of balls near a place of it: where the nearest point of the surface is stationary.
    fn touch(&self, circle: &Circle, start: &Start) -> Option<Touch> {
        let &Circle { radius, height, ball } = circle;
        let squares = *self.form.squares();
        let center = self.tip + self.axis * height;
        let mut direction = start.direction;
        let mut multiplier = self.first_multiplier(start, || center + self.radial(direction) * radius);
        for _ in 0..MAX_ITERATIONS {
            let outward = self.radial(direction) * radius;
            let onward = self.radial([-direction[1], direction[0]]) * radius;
            let at = self.stationary(&(center + outward), multiplier);
            if at.stretch.min() <= 0.0 {
                return None;
            }
            let (g, k) = (at.gradient, at.stretch);
            let bent = squares.component_mul(&k);
            // Slope along the circle and F, with their derivatives by azimuth and multiplier.
            let slope = g.dot(&onward);
            let (slope_turn, slope_grow) = (
                bent.component_mul(&onward).dot(&onward) - g.dot(&outward),
                -bent.component_mul(&g).dot(&onward),
            );
            let (value_turn, value_grow) =
                (2.0 * k.component_mul(&g).dot(&onward), -2.0 * k.component_mul(&g).dot(&g));
            let determinant = slope_turn * value_grow - slope_grow * value_turn;
            let turn = (slope_grow * at.value - slope * value_grow) / determinant;
            let grow = (value_turn * slope - slope_turn * at.value) / determinant;
            if !(turn.is_finite() && grow.is_finite()) {
                return None;
            }
            let near = turn.abs() <= NEARLY && grow.abs() * bent.amax() <= NEARLY;
            direction = turned(direction, turn.clamp(-LARGEST_STEP, LARGEST_STEP));
            multiplier = self.limited(multiplier, multiplier + grow);
            if near {
                // A least distance, not a greatest one.
                let curvature = slope_turn - slope_grow * value_turn / value_grow;
                let outside = ball <= 0.0 || self.side * multiplier > 0.0;
                return (self.side * curvature > 0.0 && outside).then(|| {
                    self.made(center + self.radial(direction) * radius, direction, multiplier, ball)
                });
            }
        }
        None
    }

    /// The contact of a ball about a point of the axis, from where it was last: between the poles the multiplier has one value for which the
    /// nearest point is on the surface. `None` where it is hard to find, or there is none.
    fn touch_on_axis(&self, circle: &Circle, start: &Start) -> Option<Touch> {
        let &Circle { height, ball, .. } = circle;
        let center = self.tip + self.axis * height;
        let mut multiplier = self.first_multiplier(start, || center);
        for _ in 0..MAX_ITERATIONS {
            let at = self.stationary(&center, multiplier);
            if at.stretch.min() <= 0.0 {
                return None;
            }
            let bent = at.stretch.component_mul(&at.gradient);
            let grow = at.value / (2.0 * bent.dot(&at.gradient));
            if !grow.is_finite() {
                return None;
            }
            let is_near = grow.abs() * self.form.squares().component_mul(&at.stretch).amax() <= NEARLY;
            multiplier = self.limited(multiplier, multiplier + grow);
            if is_near {
                let outside = ball <= 0.0 || self.side * multiplier > 0.0;
                return outside.then(|| self.made_on_axis(center, multiplier, ball));
            }
        }
        None
    }

    /// The contact of a ball about a point of the axis; the azimuth is where it goes from there, should it leave the axis.
    fn made_on_axis(&self, center: Vec3, multiplier: f64, ball: f64) -> Touch {
        let touch = self.made(center, [0.0; 2], multiplier, ball);
        let start = Start { direction: on_axis(self.tool, &touch.contact).0, ..touch.start };
        Touch { start, ..touch }
    }

    /// The multiplier with which a search begins: the last one, or by the first step of Newton's method from the place itself.
    fn first_multiplier(&self, start: &Start, place: impl FnOnce() -> Vec3) -> f64 {
        let first = start.multiplier.unwrap_or_else(|| {
            let here = self.form.stationary(&place(), 0.0);
            here.value / (2.0 * here.gradient.norm_squared())
        });
        self.limited(0.0, first)
    }

    /// The stationary point for a place on the tool, at a step to a contact.
    fn stationary(&self, place: &Vec3, multiplier: f64) -> Stationary {
        #[cfg(test)]
        STEPS.set(STEPS.get() + 1);
        self.form.stationary(place, multiplier)
    }

    fn radial(&self, [cosine, sine]: [f64; 2]) -> Vec3 {
        self.across[0] * cosine + self.across[1] * sine
    }

    fn made(&self, place: Vec3, direction: [f64; 2], multiplier: f64, ball: f64) -> Touch {
        let at = self.form.stationary(&place, multiplier);
        let length = at.gradient.norm();
        let normal = at.gradient * (self.side / length);
        // What is left of F is the last bit of the distance.
        let distance = self.side * (multiplier * length + 0.5 * at.value / length);
        let contact = Contact {
            clearance: distance - ball,
            gradient: self.form.direction_from_principal(&normal),
            tool: self.form.from_principal(&(place - normal * ball)),
            surface: self.form.from_principal(&(place - normal * distance)),
        };
        let start = Start { direction, multiplier: Some(multiplier) };
        Touch { contact, lean: normal.dot(&self.axis), start }
    }

    /// A multiplier that stays between the poles.
    fn limited(&self, from: f64, to: f64) -> f64 {
        let mut next = to;
        for a in self.form.squares().iter() {
            if 1.0 + next * a <= (1.0 - TO_POLE) * (1.0 + from * a) {
                next = from + TO_POLE * (-1.0 / a - from);
            }
        }
        next
    }
}

//! Contacts where patches meet at an angle: the ball turns over the edge of a ridge, and leaves one side of a valley for
//! the other. There the first contact is found by going down the line by what is free, which the checker proves.

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    parametric::{Edge, SculpturedSurface},
};

use super::{Contact, NoContact, Place, RollingBall};
use crate::{
    check::{Obstacle, Question, check},
    tool::{Pose, Tool},
};

/// Most steps down the line.
const MOST_STEPS: usize = 400;
/// Distance from the surface, as a share of the size of the work, at which the ball has arrived.
const ARRIVED: f64 = 1e-7;
/// How exactly distances are computed on the way, as a share of the last one.
const DISTANCE_SHARE: f64 = 0.05;
/// How deep another part of the surface may be in a ball that touches one, as a share of the ball: more is a second
/// contact that comes first.
const SECOND_CONTACT: f64 = 1e-6;
/// Local parameters so near to an edge belong to it.
const AT_EDGE: f64 = 1e-2;
/// Most Newton steps for the contact with an edge.
const MOST_EDGE_STEPS: usize = 40;
/// Residual of that, as a share of the ball.
const EDGE_RESIDUAL: f64 = 1e-12;
/// How far the polished contact may be from where the ball arrived, as a share of the ball.
const SAME_CONTACT: f64 = 1e-2;

impl RollingBall<'_> {
    /// The contact near a place: by Newton's method, and where patches meet at an angle the first one down the line.
    ///
    /// # Errors
    /// [`NoContact`] as [`RollingBall::contact_from`].
    pub fn contact_on(&self, obstacle: &Obstacle, start: Place) -> Result<Contact, NoContact> {
        let near = self.contact_from(obstacle.surface(), start);
        if !obstacle.is_creased() || self.radius <= 0.0 {
            return near;
        }
        match near {
            Ok(contact) if contact.overshoot() > 0.0 || !self.is_preceded(obstacle, &contact) => Ok(contact),
            near => match (self.first_down_the_line(obstacle), near) {
                (Some(first), _) => Ok(first),
                (None, near) => near,
            },
        }
    }

    /// Where the ball is when its centre is so far along the line. It is a hemisphere towards the surface.
    fn pose(&self, along: f64) -> Pose {
        let center = self.origin - self.shift + self.direction * along;
        Pose { end: center + self.direction * self.radius, axis: -self.direction }
    }

    fn tool(&self) -> Tool {
        let cutter = Cutter {
            diameter: 2.0 * self.radius,
            corner_radius: self.radius,
            corner_offset: 0.0,
            corner_height: self.radius,
            alpha: 0.0,
            beta: 0.0,
            height: self.radius,
        };
        Tool::new(&cutter, 0.0)
    }

    /// Whether something else of the surface is in the ball at a contact.
    fn is_preceded(&self, obstacle: &Obstacle, contact: &Contact) -> bool {
        let threshold = SECOND_CONTACT * self.radius;
        let question = Question { threshold, gap: threshold, patience: self.patience };
        let obstacles = std::slice::from_ref(obstacle);
        check(&self.tool(), &self.pose(contact.along_line), obstacles, &question).worst.is_some()
    }

    /// The first contact of the ball on its way down the line, made exact; `None` where the line passes the surface by or
    /// the contact lies at its outer boundary.
    fn first_down_the_line(&self, obstacle: &Obstacle) -> Option<Contact> {
        let bounds = obstacle.tree().root().and_then(|root| obstacle.tree().node(root))?.bounds;
        let (middle, half) = ((bounds.center() - self.origin).dot(&self.direction), bounds.half());
        let reach = self.direction.abs().dot(&half) + self.radius + self.shift.norm();
        let size = half.norm() + self.radius;
        let (tool, obstacles) = (self.tool(), std::slice::from_ref(obstacle));
        let mut along = middle - reach;
        let mut distance = size;
        for _ in 0..MOST_STEPS {
            let gap = (DISTANCE_SHARE * distance).max(0.1 * ARRIVED * size);
            let question = Question { threshold: f64::MIN, gap, patience: self.patience };
            let hit = check(&tool, &self.pose(along), obstacles, &question).worst?;
            // The surface may be nearer by the gap.
            distance = (-hit.depth - gap).max(0.0);
            if distance <= ARRIVED * size {
                let place = Place { patch: hit.patch, parameters: hit.parameters };
                return self.exact(obstacle.surface(), place, along);
            }
            along += distance;
            if along > middle + reach {
                return None;
            }
        }
        None
    }

    /// The exact contact near a place where the ball has arrived: inside of a patch, or on an edge.
    fn exact(&self, surface: &SculpturedSurface, place: Place, along: f64) -> Option<Contact> {
        let same = |contact: &Contact| (contact.along_line - along).abs() <= SAME_CONTACT * self.radius;
        let [u, v] = place.parameters;
        let edges = [(Edge::LowU, u), (Edge::HighU, 1.0 - u), (Edge::LowV, v), (Edge::HighV, 1.0 - v)];
        let creased = |edge: Edge| {
            let next = surface
                .neighbours
                .get(place.patch)
                .and_then(|edges| edges.get(edge.number()).copied().flatten());
            next.is_some_and(|next| !next.smooth)
        };
        for (edge, _) in edges.into_iter().filter(|(edge, inside)| *inside <= AT_EDGE && creased(*edge)) {
            let start = match edge {
                Edge::LowU | Edge::HighU => v,
                Edge::LowV | Edge::HighV => u,
            };
            let found = self.edge_contact(surface, place.patch, edge, start, along).filter(same);
            if let Some(contact) = found {
                return Some(contact);
            }
        }
        self.contact_from(surface, place).ok().filter(same)
    }

    /// The contact with an edge: the centre on the line, at the distance of the radius from the edge and across it. `None`
    /// where the normal is none of those between the patches.
    fn edge_contact(
        &self,
        surface: &SculpturedSurface,
        patch: usize,
        edge: Edge,
        mut t: f64,
        mut along: f64,
    ) -> Option<Contact> {
        let control = surface.patches.get(patch)?;
        let square = self.radius * self.radius;
        for _ in 0..MOST_EDGE_STEPS {
            let [u, v] = edge.parameters(t);
            let at = control.evaluate(u, v);
            let (first, second) = match edge {
                Edge::LowU | Edge::HighU => (at.dv, at.dvv),
                Edge::LowV | Edge::HighV => (at.du, at.duu),
            };
            let from = self.origin - self.shift + self.direction * along - at.position;
            let (f, g) = (from.norm_squared() - square, from.dot(&first));
            let pace = first.norm();
            if f.abs() <= EDGE_RESIDUAL * square && g.abs() <= EDGE_RESIDUAL * self.radius * pace {
                let normal = from / self.radius;
                let place = Place { patch, parameters: [u, v] };
                let contact = Contact { place, at, normal, along_line: along, on_crease: true };
                return self.is_between(surface, &contact, edge).then_some(contact);
            }
            let (f_along, f_t) = (2.0 * from.dot(&self.direction), -2.0 * g);
            let (g_along, g_t) = (self.direction.dot(&first), from.dot(&second) - pace * pace);
            let determinant = f_along * g_t - f_t * g_along;
            if determinant.abs() <= f64::MIN_POSITIVE {
                return None;
            }
            along += (f_t * g - g_t * f) / determinant;
            t = (t + (g_along * f - f_along * g) / determinant).clamp(0.0, 1.0);
        }
        None
    }

    /// Whether the patches on both sides of an edge fall away from the ball.
    fn is_between(&self, surface: &SculpturedSurface, contact: &Contact, edge: Edge) -> bool {
        let inward = |edge: Edge, du: Vec3, dv: Vec3| match edge {
            Edge::LowU => du,
            Edge::HighU => -du,
            Edge::LowV => dv,
            Edge::HighV => -dv,
        };
        let falls = |step: Vec3| contact.normal.dot(&step) <= SECOND_CONTACT * step.norm();
        let [u, v] = contact.place.parameters;
        let next = surface
            .neighbours
            .get(contact.place.patch)
            .and_then(|edges| edges.get(edge.number()).copied().flatten());
        let beyond = next.and_then(|next| {
            let along = match edge {
                Edge::LowU | Edge::HighU => v,
                Edge::LowV | Edge::HighV => u,
            };
            let [u, v] = next.edge.parameters(if next.reversed { 1.0 - along } else { along });
            let at = surface.patches.get(next.patch)?.evaluate(u, v);
            Some(inward(next.edge, at.du, at.dv))
        });
        falls(inward(edge, contact.at.du, contact.at.dv)) && beyond.is_some_and(falls)
    }
}

//! The contact of the corner with the part surface: a ball that rolls down the projection line of a guide point
//! (sculptured surfaces reference 4.2).

mod crease;

use apt_geometry::{
    Vec3,
    parametric::{Edge, PatchPoint, SculpturedSurface},
    patience::Patience,
};

use crate::{check::Obstacle, curvature::Curvature, tool::perpendicular};

/// Most Newton steps of one search.
const MOST_STEPS: usize = 60;
/// Most halvings of a Newton step.
const MOST_HALVINGS: usize = 8;
/// Most patches crossed by one step.
const MOST_CROSSINGS: usize = 16;
/// Greatest Newton step in a parameter: half a patch.
const GREATEST_STEP: f64 = 0.5;
/// Distance of ball centre and line that is none, as a share of the size of patch and ball.
const RESIDUAL: f64 = 1e-12;
/// Size of the determinant, as a share of its factors, below which the search has no direction.
const SINGULAR: f64 = 1e-10;
/// Local parameters from which searches start in each patch, in both directions.
const STARTS: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];
/// Share of the way to the middle of its patch by which a search leaves a pole, where a parameter leads nowhere.
const INWARD: f64 = 1e-3;
/// A contact so far outside of a patch, in its parameters, lies on the extension of the surface.
const OUTSIDE: f64 = 1e-9;
/// What a search from one place counts in units of work.
const WORK_OF_SEARCH: u32 = 16;
/// How many patches are tried when the line passes all of them by.
const NEAREST_PATCHES: usize = 4;

/// A place of a surface: a patch and local parameters, which lie outside of 0 to 1 on the extension of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Index of the patch.
    pub patch: usize,
    /// Local parameters.
    pub parameters: [f64; 2],
}

/// The contact of the ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Where on the surface.
    pub place: Place,
    /// The point of contact with its derivatives.
    pub at: PatchPoint,
    /// Unit normal towards the tool.
    pub normal: Vec3,
    /// How far the ball centre is along the projection line.
    pub along_line: f64,
    /// The ball touches an edge where patches meet at an angle: the normal is one of those between theirs.
    pub on_crease: bool,
}

/// No contact was found.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the ball centre stays {distance} from the projection line")]
pub struct NoContact {
    /// Least distance of the ball centre from the line; infinite where there is no surface.
    pub distance: f64,
}

/// A ball and the line that it keeps to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingBall<'a> {
    /// Radius, stock included.
    pub radius: f64,
    /// A point of the line.
    pub origin: Vec3,
    /// Unit direction of the line.
    pub direction: Vec3,
    /// +1 where ∂u×∂v points to the tool, else −1.
    pub side: f64,
    /// What keeps to the line is the centre of the ball moved by this: the tool end stands below the centre.
    pub shift: Vec3,
    /// How long contacts may be looked for.
    pub patience: Patience<'a>,
}

impl Contact {
    /// Both fundamental forms here.
    pub fn curvature(&self) -> Curvature {
        Curvature::new(&self.at, &self.normal)
    }

    /// How far outside of its patch it lies, in local parameters.
    pub fn overshoot(&self) -> f64 {
        self.place.parameters.iter().map(|p| (-p).max(p - 1.0).max(0.0)).fold(0.0, f64::max)
    }
}

/// One evaluation of the offset surface.
struct Offset {
    at: PatchPoint,
    normal: Vec3,
    /// What keeps to the line.
    center: Vec3,
    by_u: Vec3,
    by_v: Vec3,
}

impl RollingBall<'_> {
    fn offset(&self, surface: &SculpturedSurface, place: &Place) -> Option<Offset> {
        let patch = surface.patches.get(place.patch)?;
        let [u, v] = place.parameters;
        let at = patch.extended(u, v);
        let direction = at
            .regular_normal()
            .unwrap_or_else(|| patch.normal(u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)).direction);
        let normal = (direction * self.side).try_normalize(0.0)?;
        let [turn_u, turn_v] = Curvature::new(&at, &normal).normal_derivatives();
        Some(Offset {
            at,
            normal,
            center: at.position + normal * self.radius + self.shift,
            by_u: at.du + turn_u * self.radius,
            by_v: at.dv + turn_v * self.radius,
        })
    }

    /// The contact that Newton's method finds from a place.
    ///
    /// # Errors
    /// [`NoContact`] with the least distance reached.
    pub fn contact_from(&self, surface: &SculpturedSurface, start: Place) -> Result<Contact, NoContact> {
        let first = perpendicular(&self.direction);
        let second = self.direction.cross(&first);
        let residual = |offset: &Offset| {
            let from = offset.center - self.origin;
            [from.dot(&first), from.dot(&second)]
        };
        let mut place = settled(surface, start);
        let mut distance = f64::INFINITY;
        let mut left_pole = false;
        let mut known = None;
        for _ in 0..MOST_STEPS {
            let here = known.take().or_else(|| self.offset(surface, &place)).ok_or(NoContact { distance })?;
            let f = residual(&here);
            distance = f[0].hypot(f[1]);
            let size = here.at.du.norm().max(here.at.dv.norm()) + self.radius;
            if distance <= RESIDUAL * size.max(here.center.norm()) {
                let along_line = (here.center - self.origin).dot(&self.direction);
                return Ok(Contact { place, at: here.at, normal: here.normal, along_line, on_crease: false });
            }
            let (a, b) = (here.by_u.dot(&first), here.by_v.dot(&first));
            let (c, d) = (here.by_u.dot(&second), here.by_v.dot(&second));
            let determinant = a * d - b * c;
            let regular = determinant.abs() > SINGULAR * here.at.du.norm() * here.at.dv.norm();
            if !regular && !left_pole && here.at.regular_normal().is_none() {
                left_pole = true;
                place.parameters = place.parameters.map(|p| p + INWARD * (0.5 - p));
                continue;
            }
            if !regular {
                return Err(NoContact { distance });
            }
            let step = [(b * f[1] - d * f[0]) / determinant, (c * f[0] - a * f[1]) / determinant];
            let long = step[0].abs().max(step[1].abs());
            let mut share = if long > GREATEST_STEP { GREATEST_STEP / long } else { 1.0 };
            for _ in 0..MOST_HALVINGS {
                let [u, v] = place.parameters;
                let parameters = [u + share * step[0], v + share * step[1]];
                let trial = settled(surface, Place { patch: place.patch, parameters });
                known = self.offset(surface, &trial).filter(|offset| {
                    let g = residual(offset);
                    g[0].hypot(g[1]) < distance
                });
                if known.is_some() {
                    place = trial;
                    break;
                }
                share *= 0.5;
            }
            if known.is_none() {
                return Err(NoContact { distance });
            }
        }
        Err(NoContact { distance })
    }

    /// The first contact of a ball that comes down the line from far away: inside the surface before its extension, from
    /// outside before from behind, least way first.
    ///
    /// # Errors
    /// [`NoContact`] where no patch gives one, and where the search is given up.
    pub fn first_contact(&self, obstacle: &Obstacle) -> Result<Contact, NoContact> {
        let surface = obstacle.surface();
        let first = perpendicular(&self.direction);
        let second = self.direction.cross(&first);
        let mut patches = obstacle.tree().patches_where(|bounds| {
            let from = bounds.center() - self.origin;
            let reach = self.radius + self.shift.norm();
            [first, second].iter().all(|e| from.dot(e).abs() <= e.abs().dot(&bounds.half()) + reach)
        });
        if patches.is_empty() {
            patches = self.nearest_patches(surface);
        }
        let mut best: Option<(f64, bool, Contact)> = None;
        let mut distance = f64::INFINITY;
        for patch in patches {
            for u in STARTS {
                for v in STARTS {
                    if self.patience.ends_after(WORK_OF_SEARCH) {
                        return Err(NoContact { distance });
                    }
                    match self.contact_from(surface, Place { patch, parameters: [u, v] }) {
                        Ok(contact) => {
                            let overshoot = contact.overshoot();
                            let outside = if overshoot > OUTSIDE { overshoot } else { 0.0 };
                            let behind = contact.normal.dot(&self.direction) >= 0.0;
                            let found = (outside, behind, contact);
                            if best.as_ref().is_none_or(|best| before(&found, best)) {
                                best = Some(found);
                            }
                        }
                        Err(none) => distance = distance.min(none.distance),
                    }
                }
            }
        }
        best.map(|(_, _, contact)| contact).ok_or(NoContact { distance })
    }

    /// The patches whose middles are nearest to the line.
    fn nearest_patches(&self, surface: &SculpturedSurface) -> Vec<usize> {
        let away = |index: usize| {
            surface.patches.get(index).map_or(f64::INFINITY, |patch| {
                let from = patch.evaluate(0.5, 0.5).position - self.origin;
                (from - self.direction * from.dot(&self.direction)).norm()
            })
        };
        let mut order: Vec<(f64, usize)> =
            (0..surface.patches.len()).map(|index| (away(index), index)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        order.into_iter().take(NEAREST_PATCHES).map(|(_, index)| index).collect()
    }
}

fn before(a: &(f64, bool, Contact), b: &(f64, bool, Contact)) -> bool {
    let order = a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.along_line.total_cmp(&b.2.along_line));
    order == std::cmp::Ordering::Less
}

/// The same place in the patch where it belongs: beyond an edge with a neighbour it lies in that.
pub(crate) fn settled(surface: &SculpturedSurface, mut place: Place) -> Place {
    for _ in 0..MOST_CROSSINGS {
        let [u, v] = place.parameters;
        let crossed = if u < 0.0 {
            Some((Edge::LowU, -u, v))
        } else if u > 1.0 {
            Some((Edge::HighU, u - 1.0, v))
        } else if v < 0.0 {
            Some((Edge::LowV, -v, u))
        } else if v > 1.0 {
            Some((Edge::HighV, v - 1.0, u))
        } else {
            None
        };
        let Some((edge, beyond, along)) = crossed else { break };
        let Some(next) = neighbour(surface, place.patch, edge, beyond, along).or_else(|| {
            // At a corner the other parameter may lead on.
            let other = match edge {
                Edge::LowU | Edge::HighU if v < 0.0 => Some((Edge::LowV, -v)),
                Edge::LowU | Edge::HighU if v > 1.0 => Some((Edge::HighV, v - 1.0)),
                _ => None,
            };
            other.and_then(|(edge, beyond)| neighbour(surface, place.patch, edge, beyond, u))
        }) else {
            break;
        };
        place = next;
    }
    place
}

/// The place `beyond` an edge, at `along` it.
fn neighbour(
    surface: &SculpturedSurface,
    patch: usize,
    edge: Edge,
    beyond: f64,
    along: f64,
) -> Option<Place> {
    let known = surface.neighbours.get(patch).and_then(|edges| edges.get(edge.number()).copied().flatten());
    if let Some(next) = known {
        let along = if next.reversed { 1.0 - along } else { along };
        let parameters = match next.edge {
            Edge::LowU => [beyond, along],
            Edge::HighU => [1.0 - beyond, along],
            Edge::LowV => [along, beyond],
            Edge::HighV => [along, 1.0 - beyond],
        };
        return Some(Place { patch: next.patch, parameters });
    }
    // A grid knows its neighbours without being told.
    let (columns, rows) = surface.grid?;
    let (column, row) = (patch % columns.max(1), patch / columns.max(1));
    let (patch, parameters) = match edge {
        Edge::LowU if column > 0 => (patch - 1, [1.0 - beyond, along]),
        Edge::HighU if column + 1 < columns => (patch + 1, [beyond, along]),
        Edge::LowV if row > 0 => (patch - columns, [along, 1.0 - beyond]),
        Edge::HighV if row + 1 < rows => (patch + columns, [along, beyond]),
        _ => return None,
    };
    Some(Place { patch, parameters })
}

//! Clearance of the whole tool to a surface in a role, from the canonical form: the signed distance of the tool end to the
//! boundary of solid ⊕ (−tool) (arelem reference 5.2), positive when separated on the role's side.

use apt_geometry::{
    Vec3,
    canonical::{self, Geometry},
    patience::Patience,
};

use crate::sequence::ToolPosition;

use super::{
    VerifyError, halves,
    pencil::Pencil,
    poly_conic::ConicStrips,
    quadric::{Convexity, PrincipalQuadric},
    quadric_clearance,
    ruled::RuledStrips,
    ruling::Ruling,
    ruling_clearance::{self, Ruled},
    sculptured::SculpturedStrips,
    span::Bend,
    survey::Passage,
    tool::{Profile, Tool},
};

/// A surface prepared for the verifier.
#[derive(Debug, Clone)]
pub(super) enum Surface {
    /// Unit normal and distance.
    Plane(Vec3, f64),
    /// Centre and radius.
    Sphere(Vec3, f64),
    /// Cylinder or cone.
    Pencil(Box<Pencil>),
    /// Quadric with principal axes.
    Quadric(Box<PrincipalQuadric>),
    /// Tabulated cylinder, ruled, polyconic or sculptured surface.
    Ruled(Box<Ruled>),
}

/// How the clearance varies along a straight move with a fixed tool axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// Linear.
    Linear,
    /// Convex: the tool is outside a convex solid.
    Convex,
    /// Concave: the tool is inside a convex hollow.
    Concave,
    /// Nothing known beyond Lipschitz 1.
    Free,
}

impl Convexity {
    /// How the clearance from a quadric of this convexity varies along straight moves.
    pub(super) fn shape(self, side: f64) -> Shape {
        match (self, side > 0.0) {
            (Self::Inner, true) | (Self::Outer, false) => Shape::Convex,
            (Self::Inner | Self::InnerPair, false) | (Self::Outer | Self::OuterPair, true) => Shape::Concave,
            _ => Shape::Free,
        }
    }
}

/// A clearance with its unit gradient (the surface normal at the contact, towards the tool) and a bound of its error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    pub(super) value: f64,
    pub(super) normal: Vec3,
    pub(super) error: f64,
    /// A place of the tool, from its end, that touches first with that normal, where one is told.
    pub(super) place: Option<Vec3>,
}

impl Reading {
    /// One that does not tell where the tool touches.
    pub(super) fn new(value: f64, normal: Vec3, error: f64) -> Self {
        Self { value, normal, error, place: None }
    }
}

fn unit(v: &Vec3) -> Option<Vec3> {
    let size = v.norm();
    (size > 0.0 && size.is_finite()).then(|| v / size)
}

impl Surface {
    /// As accurate as it can be.
    #[cfg(test)]
    pub(super) fn of(geometry: &Geometry) -> Result<Self, VerifyError> {
        Self::within(geometry, 0.0, Patience::default())
    }

    /// The surface itself, or a model that need not be closer to it than `accuracy`; a model is not finished once `patience` is over.
    ///
    /// # Errors
    /// [`VerifyError::Unsupported`] for geometry the verifier has no model of, [`VerifyError::Degenerate`] for a form without a surface.
    pub(super) fn within(
        geometry: &Geometry,
        accuracy: f64,
        patience: Patience<'_>,
    ) -> Result<Self, VerifyError> {
        let degenerate = || VerifyError::Degenerate { kind: geometry.kind() };
        let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
        match geometry {
            Geometry::Line(plane) | Geometry::Plane(plane) => {
                let normal = unit(&plane.normal).ok_or_else(degenerate)?;
                let distance = plane.distance / plane.normal.norm();
                if !distance.is_finite() {
                    return Err(degenerate());
                }
                Ok(Self::Plane(normal, distance))
            }
            Geometry::Circle(c) | Geometry::Cylinder(c) => {
                let axis = unit(&c.axis).ok_or_else(degenerate)?;
                let radius = c.radius.abs();
                if !(finite(&c.point) && radius.is_finite() && radius > 0.0) {
                    return Err(degenerate());
                }
                Ok(Self::Pencil(Box::new(Pencil::new(c.point, axis, 1.0, radius))))
            }
            Geometry::Cone(c) => {
                let axis = unit(&c.axis).ok_or_else(degenerate)?;
                if !(finite(&c.vertex) && c.cosine > 0.0 && c.cosine < 1.0) {
                    return Err(degenerate());
                }
                Ok(Self::Pencil(Box::new(Pencil::new(c.vertex, axis, c.cosine, 0.0))))
            }
            Geometry::Sphere(s) => {
                if !(finite(&s.center) && s.radius.is_finite()) {
                    return Err(degenerate());
                }
                Ok(Self::Sphere(s.center, s.radius.abs()))
            }
            Geometry::Ellipse(q)
            | Geometry::Hyperbola(q)
            | Geometry::GeneralConic(q)
            | Geometry::LoftConic(q)
            | Geometry::Quadric(q) => Self::of_quadric(q).ok_or_else(degenerate),
            Geometry::TabulatedCylinder(surface) => {
                let ruling = Ruling::of(surface).ok_or_else(degenerate)?;
                Ok(Self::Ruled(Box::new(Ruled::Parallel(ruling))))
            }
            Geometry::RuledSurface(surface) => {
                let strips = RuledStrips::of(surface, accuracy, patience).ok_or_else(degenerate)?;
                Ok(Self::Ruled(Box::new(Ruled::Joining(Box::new(strips)))))
            }
            Geometry::PolyConic(values) => {
                let strips = ConicStrips::of(values, accuracy, patience).ok_or_else(degenerate)?;
                Ok(Self::Ruled(Box::new(Ruled::Conics(Box::new(strips)))))
            }
            Geometry::Sculptured(surface) => {
                let strips = SculpturedStrips::of(surface, accuracy, patience).ok_or_else(degenerate)?;
                Ok(Self::Ruled(Box::new(Ruled::Sculptured(Box::new(strips)))))
            }
            other => Err(VerifyError::Unsupported { kind: other.kind() }),
        }
    }

    fn of_quadric(quadric: &canonical::Quadric) -> Option<Self> {
        PrincipalQuadric::of(quadric).map(|q| Self::Quadric(Box::new(q)))
    }

    /// A length that says how large the surface is, for round-off guards.
    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Plane(_, distance) => distance.abs(),
            Self::Sphere(center, radius) => center.norm() + radius,
            Self::Pencil(pencil) => pencil.origin.norm() + pencil.radius,
            Self::Quadric(_) => 0.0,
            Self::Ruled(surface) => surface.size(),
        }
    }

    /// How far the model of the surface may be off it.
    pub(super) fn error(&self) -> f64 {
        match self {
            Self::Ruled(surface) => surface.error(),
            _ => 0.0,
        }
    }

    /// Signed distance of a point along the natural normal, with all the time in the world.
    #[cfg(test)]
    pub(super) fn point_distance(&self, x: &Vec3) -> Option<(f64, Vec3)> {
        self.distance(x, Patience::default()).map(|found| (found.value, found.normal))
    }

    /// Signed distance of a point along the natural normal, and that distance's unit gradient. None where there is none, or
    /// when it is given up.
    fn distance(&self, x: &Vec3, patience: Patience<'_>) -> Option<Reading> {
        let (value, normal) = match self {
            Self::Plane(normal, distance) => (normal.dot(x) - distance, *normal),
            Self::Sphere(center, radius) => {
                let w = x - center;
                let size = w.norm();
                (size - radius, if size > 0.0 { w / size } else { Vec3::z() })
            }
            Self::Pencil(pencil) => pencil.point_distance(x),
            Self::Quadric(quadric) => quadric.distance(x).map(|d| (d.distance, d.normal))?,
            Self::Ruled(surface) => return ruling_clearance::point(surface, x, patience),
        };
        Some(Reading::new(value, normal, 0.0))
    }

    /// The greatest curvature with which it bends away from a tool on a side, at places nearer to the tool than `reach`; what is
    /// less than `enough` need not be told apart. None where there is no bound.
    fn hill(&self, side: f64, tip: &Vec3, tool: &Tool<'_>, [reach, enough]: [f64; 2]) -> Option<f64> {
        let is_hollow = side < 0.0;
        let found = match self {
            Self::Plane(..) => 0.0,
            Self::Sphere(..) | Self::Pencil(_) if is_hollow => 0.0,
            Self::Sphere(_, radius) => 1.0 / radius,
            Self::Pencil(pencil) => pencil.curvature(tip, tool, reach)?,
            Self::Quadric(quadric) => {
                let line = [*tip, tip + tool.axis * tool.profile.top_height()];
                quadric.hill_along(side, line, [tool.profile.widest(), reach], enough)?
            }
            Self::Ruled(_) => return None,
        };
        found.is_finite().then_some(found)
    }

    /// How the clearance on a side varies along straight moves.
    pub(super) fn shape(&self, side: f64) -> Shape {
        let outside = side > 0.0;
        match self {
            Self::Plane(..) => Shape::Linear,
            Self::Sphere(..) | Self::Pencil(_) => {
                if outside {
                    Shape::Convex
                } else {
                    Shape::Concave
                }
            }
            Self::Quadric(quadric) => quadric.convexity.shape(side),
            Self::Ruled(_) => Shape::Free,
        }
    }
}

/// Clearance of a tool to one surface on one side.
#[derive(Debug, Clone)]
pub(super) struct Clearance<'a> {
    pub(super) surface: &'a Surface,
    pub(super) profile: &'a Profile,
    /// How far the profile is above the tool end, along the axis.
    pub(super) raise: f64,
    /// +1 or −1, with regard to the natural normal.
    pub(super) side: f64,
    /// Stock added to the surface.
    pub(super) thickness: f64,
    /// How deep in that the tool may be: the inner width of the band.
    pub(super) allowed: f64,
    /// Who is asked before each reading, and while it is made.
    pub(super) patience: Patience<'a>,
}

impl<'a> Clearance<'a> {
    /// Of a tool without stock, with all the time in the world.
    #[cfg(test)]
    pub(super) fn new(surface: &'a Surface, profile: &'a Profile, side: f64) -> Self {
        Self {
            surface,
            profile,
            raise: 0.0,
            side,
            thickness: 0.0,
            allowed: 0.0,
            patience: Patience::default(),
        }
    }

    fn tool(&self, axis: Vec3) -> Tool<'a> {
        let depth = (-self.thickness).max(0.0) + self.allowed;
        Tool { profile: self.profile, axis, patience: self.patience, depth }
    }

    pub(super) fn shape(&self) -> Shape {
        self.surface.shape(self.side)
    }

    /// Whether readings are searched for, so that they cost much more than to remember them.
    pub(super) fn is_searched_for(&self) -> bool {
        matches!(self.surface, Surface::Ruled(_))
    }

    /// How the clearance varies along a straight move with a fixed axis.
    pub(super) fn shape_along(&self, ends: [&Vec3; 2], axis: &Vec3) -> Shape {
        match self.surface {
            Surface::Quadric(quadric) => {
                let tool = self.tool(*axis);
                let [from, to] = ends.map(|tip| tip + axis * self.raise);
                quadric_clearance::shape(quadric, self.side, [&from, &to], &tool)
            }
            _ => self.shape(),
        }
    }

    /// Where the surface is two convex bodies and the tool beside one of them on a straight move with a fixed axis, by the readings
    /// at both ends: what these may be too great by.
    pub(super) fn beside_one_body(&self, tips: [&Vec3; 2], ends: [&Reading; 2], axis: &Vec3) -> Option<f64> {
        let Surface::Quadric(quadric) = self.surface else { return None };
        if self.profile.is_point() {
            return None;
        }
        let [from, to] = tips.map(|tip| tip + axis * self.raise);
        let [first, last] = ends.map(|end| Reading { value: end.value + self.thickness, ..*end });
        halves::beside_one(quadric, self.side, [(&from, &first), (&to, &last)], &self.tool(*axis))
    }

    /// A distance from the tool end beyond which there is nothing of the tool.
    pub(super) fn reach(&self) -> f64 {
        self.profile.reach() + self.raise.abs()
    }

    /// How its slope can grow on a vector, where no place of the tool moves farther than `travel`, from the readings at both
    /// ends; None where that is not known. Growth of less than `enough` need not be told apart.
    pub(super) fn bend_along(
        &self,
        [from, to]: [&ToolPosition; 2],
        ends: [&Reading; 2],
        [travel, enough]: [f64; 2],
    ) -> Option<Bend> {
        let tool = self.tool(from.axis);
        let tips = [from, to].map(|p| p.tip + p.axis * self.raise);
        if let Surface::Ruled(surface) = self.surface {
            let surface =
                if self.profile.is_point() { surface } else { surface.met_from(self.side, self.patience) };
            return surface.bend(self.side, [&tips[0], &tips[1]], &tool, ends, self.thickness, travel);
        }
        let values = ends.map(|end| end.value + self.thickness);
        let [least, most] = [values[0].min(values[1]), values[0].abs().max(values[1].abs())];
        let depth = (0.5 * travel - least).max(0.0);
        let hill = self.surface.hill(self.side, &tips[0], &tool, [most + 1.5 * travel, enough])?;
        Bend::over(hill, depth)
    }

    /// How fast its slope grows on a vector, by the parameter from 0 to 1 and as closely as is enough: from the position half way, the way and
    /// how far the axis turns, and between which values it is. None where that is
    /// not known any closer.
    pub(super) fn bend_on(
        &self,
        middle: &ToolPosition,
        (way, round): (Vec3, Vec3),
        values: [f64; 2],
        is_enough: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        let Surface::Ruled(surface) = self.surface else { return None };
        let surface =
            if self.profile.is_point() { surface } else { surface.met_from(self.side, self.patience) };
        let tool = self.tool(middle.axis);
        let tip = middle.tip + middle.axis * self.raise;
        let values = values.map(|value| value + self.thickness);
        surface.bend_on(
            self.side,
            &Passage { tool: &tool, tip, raise: self.raise, way, round, values },
            is_enough,
        )
    }

    /// The clearance with the tool end at `tip` and the axis `axis`; None where no distance exists (a surface without real
    /// points, or a position that is not finite), or when it is given up.
    pub(super) fn at(&self, tip: &Vec3, axis: &Vec3) -> Option<Reading> {
        if self.patience.is_over() {
            return None;
        }
        let mut reading = self.bare(&(tip + axis * self.raise), axis)?;
        reading.value -= self.thickness;
        reading.place = reading.place.map(|place| place + axis * self.raise);
        (reading.value.is_finite() && reading.error.is_finite()).then_some(reading)
    }

    fn bare(&self, tip: &Vec3, axis: &Vec3) -> Option<Reading> {
        let tool = self.tool(*axis);
        if self.profile.is_point() {
            let Reading { value, normal, error, .. } = self.surface.distance(tip, self.patience)?;
            return Some(Reading::new(self.side * value, normal * self.side, error));
        }
        match self.surface {
            Surface::Plane(normal, distance) => {
                let n = normal * self.side;
                let value = n.dot(tip) - self.side * distance - tool.support(&-n).0;
                Some(Reading::new(value, n, 0.0))
            }
            Surface::Sphere(center, radius) => Some(self.sphere(tip, &tool, center, *radius)),
            Surface::Pencil(pencil) => {
                let found =
                    if self.side > 0.0 { pencil.outside(tip, &tool) } else { pencil.inside(tip, &tool) };
                Some(Reading::new(found.value, found.normal, found.error))
            }
            Surface::Ruled(surface) => {
                ruling_clearance::at(surface.met_from(self.side, self.patience), self.side, tip, &tool)
            }
            Surface::Quadric(quadric) => quadric_clearance::at(quadric, self.side, tip, &tool),
        }
    }

    fn sphere(&self, tip: &Vec3, tool: &Tool<'_>, center: &Vec3, radius: f64) -> Reading {
        let w = center - tip;
        let outside = self.side > 0.0;
        let (distance, q) = if outside { tool.signed_distance(&w) } else { tool.farthest(&w) };
        let from_center = q - w;
        let size = from_center.norm();
        let direction = if size > 0.0 { from_center / size } else { tool.axis };
        if outside {
            let normal = if distance < 0.0 { -direction } else { direction };
            Reading::new(distance - radius, normal, 0.0)
        } else {
            Reading::new(radius - distance, -direction, 0.0)
        }
    }
}

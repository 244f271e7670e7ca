//! A surface in its role while a motion is computed: the gauge that measures it and the band it must stay in.

use apt_geometry::{
    Vec3,
    motion::{NamedSurface, PerRole, Relation},
    surface::{Surface, SurfaceError},
};

use crate::{
    clearance::{Gauge, Memory, Shape},
    error::{MotionFailure, RoleName},
    section2::{StartUpRule, State},
    sequence::Role,
};

/// Share of the band kept free between a vertex and the limit it aims at, so that rounding never leaves the band.
/// It costs half its size in step length.
pub(crate) const GUARD: f64 = 1e-3;
/// Place in the band, from the limit that the sag goes to, of the ends of motions on curved surfaces: between the
/// nominal position and the limit at which vertices lie.
const REST: f64 = 0.75;
/// Share of the squared curvatures above which twice their negative product makes a saddle.
const SADDLE: f64 = 1e-6;
/// Curvature, times the size of the coordinates, below which a surface is straight.
const STRAIGHT: f64 = 1e-7;
/// Rounding of a clearance, relative to the size of the coordinates: the slack of all band tests.
pub(crate) const ROUNDING: f64 = 1e-12;

/// A role with everything needed to compute with it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Working {
    pub(crate) name: RoleName,
    pub(crate) named: NamedSurface,
    pub(crate) relation: Relation,
    pub(crate) gauge: Gauge,
    pub(crate) inside: f64,
    pub(crate) outside: f64,
    pub(crate) shape: Shape,
    /// Mean curvature near the tool, turned to its side: where the ends lie when the shape does not tell.
    pub(crate) lean: f64,
    /// The peer that the part program is written for leaves convex stretches of this surface on the inner side of the
    /// band: APT4 does so on tabulated cylinders.
    inner: bool,
}

/// How a path bends against a role's surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bend {
    Straight,
    Convex,
    Concave,
}

impl Working {
    /// A role from the modal state; the side is set later. ON is the only relation that measures the tool end.
    pub(crate) fn new(
        state: &State,
        name: RoleName,
        named: &NamedSurface,
        relation: Relation,
        on: bool,
    ) -> Result<Self, MotionFailure> {
        let surface = surface(name, named)?;
        let pick = |values: &PerRole| match name {
            RoleName::Part => values.part,
            RoleName::Drive => values.drive,
            RoleName::Check(index) => values.check[index.min(1)],
        };
        let (inside, outside) = (pick(&state.inside), pick(&state.outside));
        if !(inside >= 0.0 && outside >= 0.0 && (inside + outside).is_finite()) {
            return Err(MotionFailure::NoTolerance { role: name, inside, outside });
        }
        let thickness = if on { 0.0 } else { pick(&state.thickness) };
        let disk = state.disk.filter(|of| match name {
            RoleName::Part => of.part,
            RoleName::Drive => !of.part,
            RoleName::Check(_) => false,
        });
        let disk = disk.filter(|_| !on).map(|of| of.disk);
        let gauge = Gauge { surface, on, side: 1.0, thickness, disk, memory: Memory::default() };
        let shape = gauge.shape();
        let inner = state.start_up == StartUpRule::Apt4 && matches!(gauge.surface, Surface::Tabulated(_));
        Ok(Self { name, named: named.clone(), relation, gauge, inside, outside, shape, lean: 0.0, inner })
    }

    pub(crate) fn set_side(&mut self, side: f64) {
        self.gauge.side = side;
        self.shape = self.gauge.shape();
    }

    /// Notes how the surface bends near a position; the side must be set. On a saddle the way decides, which is not known
    /// yet.
    pub(crate) fn look_from(&mut self, tip: &Vec3) {
        if self.shape == Shape::General {
            let foot = self.gauge.surface.foot(tip).point;
            let hessian = self.gauge.surface.foot_and_hessian(&foot).1;
            let (mean, square) = (hessian.trace(), hessian.norm_squared());
            // Twice the Gaussian curvature.
            let saddle = mean * mean - square < -SADDLE * square;
            self.lean = if saddle { 0.0 } else { self.leaning(mean, &foot) };
        }
    }

    /// Notes how the surface bends along a direction near a position. ON keeps the bend of the start: its band belongs
    /// to the side that the motion began on.
    pub(crate) fn look_along(&mut self, tip: &Vec3, direction: &Vec3) {
        if self.shape == Shape::General && !self.gauge.on {
            let foot = self.gauge.surface.foot(tip).point;
            let hessian = self.gauge.surface.foot_and_hessian(&foot).1;
            self.lean = self.leaning(direction.dot(&(hessian * direction)), &foot);
        }
    }

    /// Curvature turned to the tool's side; none where it is rounding.
    fn leaning(&self, curvature: f64, place: &Vec3) -> f64 {
        let straight = curvature.abs() * (1.0 + place.norm()) <= STRAIGHT;
        if straight { 0.0 } else { self.gauge.side * curvature }
    }

    /// The clearance changes with a turning axis too, unless the tool end alone counts.
    pub(crate) fn turn_freely(&mut self, tip: &Vec3) {
        if !self.gauge.on {
            self.shape = Shape::General;
            self.look_from(tip);
        }
    }

    /// Width of the band.
    pub(crate) fn band(&self) -> f64 {
        self.inside + self.outside
    }

    /// Where the ends of a motion lie: exactly on planes; on curved surfaces inside the band on the side away from the
    /// sag, because the end of one motion is where the vectors of the next begin.
    pub(crate) fn rest(&self) -> f64 {
        let share = match self.shape {
            Shape::Flat => return 0.0,
            Shape::Convex => REST,
            Shape::Concave => 1.0 - REST,
            Shape::General if self.lean > 0.0 && self.inner => 1.0 - REST,
            Shape::General if self.lean > 0.0 => REST,
            Shape::General if self.lean < 0.0 => 1.0 - REST,
            Shape::General => 0.5,
        };
        share * self.band() - self.inside
    }

    /// Where the vertices between cut vectors lie: at the limit opposite to the sag.
    pub(crate) fn vertex(&self, bend: Bend) -> f64 {
        match bend {
            Bend::Straight => self.rest(),
            Bend::Convex => self.outside - GUARD * self.band(),
            Bend::Concave => -self.inside + GUARD * self.band(),
        }
    }

    pub(crate) fn holds(&self, clearance: f64, size: f64) -> bool {
        clearance >= -self.inside - ROUNDING * size && clearance <= self.outside + ROUNDING * size
    }

    pub(crate) fn role(&self) -> Role {
        Role {
            surface: self.named.clone(),
            relation: self.relation,
            side: self.gauge.side,
            inside_tolerance: self.inside,
            outside_tolerance: self.outside,
            thickness: self.gauge.thickness,
            disk: self.gauge.disk,
        }
    }
}

/// The surface of a role.
pub(crate) fn surface(role: RoleName, named: &NamedSurface) -> Result<Surface, MotionFailure> {
    Surface::from_geometry(&named.geometry).map_err(|error| match error {
        SurfaceError::Unsupported { kind } => MotionFailure::SurfaceUnsupported { role, kind },
        SurfaceError::Degenerate { kind } => MotionFailure::SurfaceDegenerate { role, kind },
    })
}

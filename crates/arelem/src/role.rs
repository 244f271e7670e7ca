//! A surface in its role while a motion is computed: the gauge that measures it and the band it must stay in.

use apt_geometry::{
    Vec3,
    canonical::{Cylinder, Geometry, Plane, Sphere},
    motion::{DriveSide, NamedSurface, PartSide, PerRole, Relation},
    patience::Patience,
    surface::{Surface, SurfaceError},
};

use crate::{
    clearance::{Gauge, Memory, Shape},
    error::{MotionFailure, MotionWarning, RoleName},
    section2::{StartUpRule, State},
    sequence::{Role, ToolPosition},
};

/// Share of the band kept free between a vertex and the limit it aims at, so that rounding never leaves the band.
/// It costs half its size in step length.
pub(crate) const GUARD: f64 = 1e-3;
/// Place in the band, from the limit that the sag goes to, of the ends of motions on curved surfaces: between the
/// nominal position and the limit at which vertices lie.
const REST: f64 = 0.75;
/// The same on sculptured surfaces, where the APT4 peer is at 0.8 to 1.0 of OUTTOL above the surface however that bends:
/// as near to that as leaves room for the sag. On convex, concave and other stretches.
const REST_ABOVE: [f64; 3] = [0.85, 0.6, 0.75];
/// The same for sculptured check surfaces, TO and PAST which that peer stops as far on the inner side.
const REST_AT_CHECK: f64 = 0.25;
/// Distance from a surface, relative to the coordinates, at which a tool end is on it and has no side.
const ON_SURFACE: f64 = 1e-9;
/// Sine of the angle between a normal and the tool axis up to which a flat bottom touches as a whole: rounding of a surface's
/// nearest point.
const ALONG: f64 = 1e-9;
/// Share of the squared curvatures above which twice their negative product makes a saddle.
const SADDLE: f64 = 1e-6;
/// Curvature, times the size of the coordinates, below which a surface is straight.
const STRAIGHT: f64 = 1e-7;
/// Least step along a vector in looking for a check surface, as a share of its band.
pub(crate) const LEAST_STEP: f64 = 0.02;
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
    seat: Seat,
}

/// Where in the band the ends of motions lie, apart from how the surface bends: the APT4 peer has its own places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Seat {
    /// Away from the sag.
    Usual,
    /// Convex stretches of tabulated cylinders on the inner side.
    Inner,
    /// Sculptured surfaces on the outer side.
    Above,
    /// Sculptured check surfaces on the inner side.
    AtCheck,
}

impl Seat {
    fn of(state: &State, name: RoleName, surface: &Surface) -> Self {
        match (state.start_up, surface, name) {
            (StartUpRule::Apt4, Surface::Tabulated(_), _) => Self::Inner,
            (StartUpRule::Apt4, Surface::Sculptured(_), RoleName::Check(_)) => Self::AtCheck,
            (StartUpRule::Apt4, Surface::Sculptured(_), _) => Self::Above,
            _ => Self::Usual,
        }
    }
}

/// How a path bends against a role's surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bend {
    Straight,
    Convex,
    Concave,
}

/// An error where a negative THICK of a check surface is more than the tool is wide (language reference 6.8): a tool that is to stop TO the surface would
/// be past where it stops PAST it. A surface that the tool keeps to has one such place.
fn undercut(state: &State, role: RoleName, thickness: f64) -> Result<(), MotionFailure> {
    let Some(cutter) = state.cutter.filter(|_| state.disk.is_none()) else { return Ok(()) };
    let radius = cutter.profile().greatest_radius();
    if -thickness > radius {
        return Err(MotionFailure::UndercutTooDeep { role, thickness, radius });
    }
    Ok(())
}

/// Warnings where a negative THICK of a surface that a motion follows is more than the tool is wide, and what touches is round:
/// beyond that the reference gives no meaning to it (6.8), though there is a path. A flat bottom may go as deep as it is told.
/// `reached` is where the motion led, if it did. Notes that it was told, so that it is told once.
pub(crate) fn deep_undercuts(
    state: &mut State,
    reached: &[ToolPosition],
    patience: Patience<'_>,
) -> Vec<MotionWarning> {
    let Some(cutter) = state.cutter.filter(|_| state.disk.is_none()) else { return Vec::new() };
    let radius = cutter.profile().greatest_radius();
    let is_round = |role, thickness: f64| {
        -thickness > radius && !(role == RoleName::Part && stands_on_part(state, reached, patience))
    };
    let roles = [
        (RoleName::Part, state.thickness.part, state.part_side == PartSide::On),
        (RoleName::Drive, state.thickness.drive, state.drive_side == DriveSide::On),
    ];
    let doubted = roles.map(|(role, thickness, on)| !on && is_round(role, thickness));
    let mut warnings = Vec::new();
    for (((role, thickness, _), doubted), told) in
        roles.into_iter().zip(doubted).zip(&mut state.undercut_told)
    {
        if doubted && !*told {
            *told = true;
            warnings.push(MotionWarning::DeepUndercut { role, thickness, radius });
        }
    }
    warnings
}

/// Whether it is a flat bottom that touches the part surface where the tool is and in the places it reaches: the normal of the
/// surface is the tool axis there.
fn stands_on_part(state: &State, reached: &[ToolPosition], patience: Patience<'_>) -> bool {
    let bottom = state.cutter.map(|cutter| cutter.profile().lower);
    if !bottom.is_some_and(|bottom| bottom.radius > 0.0 && bottom.height <= ROUNDING * bottom.radius) {
        return false;
    }
    let Ok(part) = Surface::from_geometry_until(&state.part.geometry, patience) else { return false };
    let start = state.tip.map(|tip| ToolPosition { tip, axis: state.axis });
    start.iter().chain(reached).all(|place| part.foot(&place.tip).normal.cross(&place.axis).norm() <= ALONG)
}

impl Working {
    /// A role from the modal state; the side is set later. ON is the only relation that measures the tool end.
    pub(crate) fn new(
        state: &State,
        name: RoleName,
        named: &NamedSurface,
        relation: Relation,
        on: bool,
        patience: Patience<'_>,
    ) -> Result<Self, MotionFailure> {
        let pick = |values: &PerRole| match name {
            RoleName::Part => values.part,
            RoleName::Drive => values.drive,
            RoleName::Check(index) => values.check[index.min(1)],
        };
        let (inside, outside) = (pick(&state.inside), pick(&state.outside));
        if !(inside >= 0.0 && outside >= 0.0 && (inside + outside).is_finite()) {
            return Err(MotionFailure::NoTolerance { role: name, inside, outside });
        }
        let stock = pick(&state.thickness);
        if let (RoleName::Check(_), false) = (name, on) {
            undercut(state, name, stock)?;
        }
        let named = match state.start_up {
            rule if on && stock != 0.0 && rule.on_takes_stock(named.geometry.kind()) => {
                moved(named, stock, state.tip.as_ref(), patience)
            }
            _ => named.clone(),
        };
        let surface = surface(name, &named, patience)?;
        let thickness = if on { 0.0 } else { stock };
        let disk = state.disk.filter(|of| match name {
            RoleName::Part => of.part,
            RoleName::Drive => !of.part,
            RoleName::Check(_) => false,
        });
        let disk = disk.filter(|_| !on).map(|of| of.disk);
        let gauge = Gauge { surface, on, side: 1.0, thickness, disk, memory: Memory::default() };
        let shape = gauge.shape();
        let seat = Seat::of(state, name, &gauge.surface);
        Ok(Self { name, named, relation, gauge, inside, outside, shape, lean: 0.0, seat })
    }

    /// The role in a start-up, where a check surface is one like the others.
    pub(crate) fn at_start(mut self) -> Self {
        if self.seat == Seat::AtCheck {
            self.seat = Seat::Above;
        }
        self
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
            Shape::General if self.seat == Seat::AtCheck && self.gauge.on => 0.5,
            Shape::General if self.seat == Seat::AtCheck => REST_AT_CHECK,
            Shape::General if self.seat == Seat::Above => {
                let [convex, concave, other] = REST_ABOVE;
                if self.lean > 0.0 {
                    convex
                } else if self.lean < 0.0 {
                    concave
                } else {
                    other
                }
            }
            Shape::General if self.lean > 0.0 && self.seat == Seat::Inner => 1.0 - REST,
            Shape::General if self.lean > 0.0 => REST,
            Shape::General if self.lean < 0.0 => 1.0 - REST,
            Shape::General => 0.5,
        };
        share * self.band() - self.inside
    }

    /// Where the ends of a motion may lie: exactly on planes; on curved surfaces anywhere in the band but for what is kept
    /// free of rounding.
    pub(crate) fn room(&self) -> [f64; 2] {
        if self.shape == Shape::Flat { [0.0; 2] } else { self.whole_room() }
    }

    /// The band but for what is kept free of rounding, of planes, too.
    pub(crate) fn whole_room(&self) -> [f64; 2] {
        let guard = GUARD * self.band();
        [guard - self.inside, self.outside - guard]
    }

    /// Where the vertices between cut vectors lie: at the limit opposite to the sag.
    pub(crate) fn vertex(&self, bend: Bend) -> f64 {
        match bend {
            Bend::Straight => self.rest(),
            Bend::Convex => self.outside - GUARD * self.band(),
            Bend::Concave => -self.inside + GUARD * self.band(),
        }
    }

    /// How far a clearance is out of the band; negative in it.
    pub(crate) fn beyond(&self, clearance: f64) -> f64 {
        (-self.inside - clearance).max(clearance - self.outside)
    }

    pub(crate) fn holds(&self, clearance: f64, size: f64) -> bool {
        clearance >= -self.inside - ROUNDING * size && clearance <= self.outside + ROUNDING * size
    }

    /// How far a tool may be in a check surface, or out of it again, and count as if it only touched it: no farther than a step along a vector may overlook,
    /// so that of such places it hangs on the steps whether they are seen.
    pub(crate) fn touch_limit(&self) -> f64 {
        LEAST_STEP * self.band()
    }

    /// Whether a tool that begins a motion with such a clearance, stock left out, may be taken to stand in the position that this
    /// check surface gives: in the band, which for ON is as wide on both sides. Out of it a position ahead is met.
    pub(crate) fn is_there(&self, clearance: f64, size: f64) -> bool {
        let wider = self.inside.max(self.outside);
        if self.gauge.on { clearance.abs() <= wider + ROUNDING * size } else { self.holds(clearance, size) }
    }

    /// Whether a tool that is so far from where it just touches may be taken to do so.
    pub(crate) fn is_as_near(&self, distance: f64, size: f64) -> bool {
        distance <= self.inside.max(self.outside) + ROUNDING * size
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

/// A plane, line, circle, cylinder or sphere moved by stock towards the tool end; from a tool end that is on it, or not known,
/// against its natural normal. Other surfaces stay: ON measures them without stock.
fn moved(named: &NamedSurface, stock: f64, tip: Option<&Vec3>, patience: Patience<'_>) -> NamedSurface {
    let towards = |surface: &Geometry| {
        let distance = Surface::from_geometry_until(surface, patience)
            .ok()
            .zip(tip)
            .map_or(0.0, |(surface, tip)| surface.signed_distance(tip));
        let on = ON_SURFACE * (1.0 + tip.map_or(0.0, |tip| tip.norm()));
        if distance > on { stock } else { -stock }
    };
    let by = towards(&named.geometry);
    let plane = |plane: &Plane| Plane { distance: plane.distance + by * plane.normal.norm(), ..*plane };
    let round = |cylinder: &Cylinder| Cylinder { radius: (cylinder.radius.abs() + by).abs(), ..*cylinder };
    let geometry = match &named.geometry {
        Geometry::Plane(given) => Geometry::Plane(plane(given)),
        Geometry::Line(given) => Geometry::Line(plane(given)),
        Geometry::Circle(given) => Geometry::Circle(round(given)),
        Geometry::Cylinder(given) => Geometry::Cylinder(round(given)),
        Geometry::Sphere(given) => {
            Geometry::Sphere(Sphere { radius: (given.radius.abs() + by).abs(), ..*given })
        }
        other => other.clone(),
    };
    NamedSurface { name: named.name.clone(), geometry }
}

/// The surface of a role.
pub(crate) fn surface(
    role: RoleName,
    named: &NamedSurface,
    patience: Patience<'_>,
) -> Result<Surface, MotionFailure> {
    Surface::from_geometry_until(&named.geometry, patience).map_err(|error| match error {
        SurfaceError::Unsupported { kind } => MotionFailure::SurfaceUnsupported { role, kind },
        SurfaceError::Degenerate { kind } => MotionFailure::SurfaceDegenerate { role, kind },
        SurfaceError::GivenUp => MotionFailure::Cancelled,
    })
}

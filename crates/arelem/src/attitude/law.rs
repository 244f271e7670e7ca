//! The law that an axis follows: angles to the normal of the controlling surface.

use apt_geometry::{
    Vec3,
    cutter::ProfilePoint,
    motion::{AxisAngle, AxisTangency, ToolAxis},
    surface::{Surface, perpendicular},
};

use nalgebra::Matrix3;

use crate::{clearance::Tool, error::AxisFailure, role::Working};

mod rate;
mod settled;

/// |cos| between axis and normal above which an axis ON a surface keeps to its side of it.
const LEAST_COSINE: f64 = 0.05;
/// Sine between two directions below which they span no plane.
const SAME_DIRECTION: f64 = 1e-6;
/// Sine of the angle between drive normal and four-axis plane below which alpha is a lead angle.
const LEAD_SINE: f64 = 1e-3;
/// Distance, relative to the size of the coordinates, within which a point is the vertex of a cone.
const ON_VERTEX: f64 = 1e-12;
/// Share of the way by which an axis that fans goes on turning before and behind it, for trials beyond the end.
const BEYOND: f64 = 0.5;
/// What a place of a surface that an axis is made of counts in units of work.
const WORK_OF_NORMAL: u32 = 8;
/// Angles below this (radians) are zero.
const ZERO_ANGLE: f64 = 1e-12;

#[cfg(test)]
thread_local! {
    /// Normals of surfaces that axes were made of, on this thread.
    pub(crate) static NORMALS: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// A surface whose normal counts, with the sign that turns the natural normal.
#[derive(Debug, Clone)]
struct Directed {
    surface: Surface,
    sign: f64,
    /// From a place to where the normal is taken: along the axis of a cone that the tool stands outside of, a little way
    /// out. Elsewhere the normal there is the same; about the vertex it turns evenly from one side of the cone to the
    /// other, for a tool anywhere in the band.
    lift: Vec3,
}

impl Directed {
    fn new(role: &Working, sign: f64) -> Self {
        let lift = match &role.gauge.surface {
            Surface::Cone(cone) if sign > 0.0 => cone.axis * (-role.band() / cone.sine),
            _ => Vec3::zeros(),
        };
        Self { surface: role.gauge.surface.clone(), sign, lift }
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        #[cfg(test)]
        NORMALS.set(NORMALS.get() + 1);
        self.surface.foot(&(p + self.lift)).normal * self.sign
    }

    /// True where the nearest point is the vertex of a cone, for a tool inside of it: the normal jumps there.
    fn at_vertex(&self, p: &Vec3) -> bool {
        let Surface::Cone(cone) = &self.surface else { return false };
        let foot = self.surface.foot(p).point;
        self.sign < 0.0 && (foot - cone.vertex).norm() <= ON_VERTEX * (1.0 + cone.vertex.norm())
    }

    /// The normal, and its derivatives by the coordinates as columns.
    fn bend(&self, p: &Vec3) -> Bent {
        #[cfg(test)]
        NORMALS.set(NORMALS.get() + 1);
        let (foot, hessian) = self.surface.foot_and_hessian(&(p + self.lift));
        (foot.normal * self.sign, hessian * self.sign)
    }
}

/// How the axis stands to the normal.
#[derive(Debug, Clone, Copy)]
enum Mode {
    Normal,
    /// Towards the other surface's normal by an angle with this cosine and sine.
    Tilted {
        cosine: f64,
        sine: f64,
    },
    /// Along the rulings of the controlling surface, in their own sense (+1) or against it (−1).
    Parallel {
        sense: f64,
    },
    /// Along the controlling surface as it is at a height above the tool end: in the plane across a unit vector, or across
    /// the line of motion; in one of the two senses.
    Tangent {
        height: f64,
        vector: Option<Vec3>,
        sense: f64,
    },
    /// From one axis to another about a unit vector, evenly with the way along a straight line.
    Fan {
        from: Vec3,
        about: Vec3,
        angle: f64,
        origin: Vec3,
        /// Direction of the line divided by its length.
        line: Vec3,
    },
    /// In the plane across a unit vector, turned about that vector by an angle with this cosine and sine; where the angle leads, in which sense
    /// of that turn motion goes.
    Across {
        vector: Vec3,
        cosine: f64,
        sine: f64,
        leads: Option<f64>,
    },
    /// Components along the normal, along the direction of motion, towards the other surface's normal; the sense of
    /// the direction of motion against the product of the two normals.
    Lead {
        along: f64,
        ahead: f64,
        aside: f64,
        sense: f64,
    },
}

/// A normal, and its derivatives by the coordinates as columns.
type Bent = (Vec3, Matrix3<f64>);

/// How a tool stands: its axis, the normal that this stands to, and that of the other surface where it counts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Standing {
    pub(crate) axis: Vec3,
    base: Bent,
    other: Option<Bent>,
}

/// The axis as a function of the tool end.
#[derive(Debug, Clone)]
pub(crate) struct Law {
    base: Directed,
    other: Option<Directed>,
    mode: Mode,
}

impl Law {
    /// The law of a mode for a motion at `tip` towards `ahead`, for a tool with its present axis. `None` for a fixed axis.
    ///
    /// The axis points to the side where the tool is; where the tool end is ON the controlling surface, to the side
    /// where the axis is. A positive angle tilts it towards the side where the tool is of the other surface, or along
    /// that surface's own normal if the tool end is ON it.
    pub(crate) fn new(
        mode: &ToolAxis,
        part: Option<&Working>,
        drive: Option<&Working>,
        (tool, tip, ahead): (&Tool, &Vec3, &Vec3),
    ) -> Result<Option<Self>, AxisFailure> {
        let controlled_by_part = match mode {
            ToolAxis::Fixed(_) | ToolAxis::Keep => return Ok(None),
            ToolAxis::Tangent { .. } => false,
            ToolAxis::Normal { part } | ToolAxis::Parallel { part } | ToolAxis::AtAngle { part, .. } => *part,
        };
        let (base, other) = if controlled_by_part { (part, drive) } else { (drive, part) };
        let base = base.ok_or(AxisFailure::NoSurface)?;
        let cosine = base.gauge.surface.foot(tip).normal.dot(&tool.axis);
        let sign =
            if base.gauge.on && cosine.abs() > LEAST_COSINE { cosine.signum() } else { base.gauge.side };
        let base = Directed::new(base, sign);
        let other = other.map(|role| Directed::new(role, if role.gauge.on { 1.0 } else { role.gauge.side }));
        let mut law = Self { base, other, mode: Mode::Normal };
        if let ToolAxis::AtAngle { angle, mode, .. } = mode {
            law.mode = law.angles(*angle, mode, tip, ahead)?;
        }
        if let ToolAxis::Parallel { .. } = mode {
            // The rulings have two senses: the axis keeps to the one in which it points.
            let cosine = law.ruling(tip)?.dot(&tool.axis);
            if cosine.abs() <= SAME_DIRECTION {
                return Err(AxisFailure::SignUnresolved);
            }
            law.mode = Mode::Parallel { sense: cosine.signum() };
        }
        if let ToolAxis::Tangent { height, mode } = mode {
            let vector = match mode {
                AxisTangency::PerpendicularTo(vector) => {
                    Some(vector.try_normalize(0.0).ok_or(AxisFailure::NoPlane)?)
                }
                AxisTangency::Across | AxisTangency::Fan => None,
            };
            law.mode = Mode::Tangent { height: *height, vector, sense: 1.0 };
            // Both senses are tangent: the axis keeps to the one in which it points.
            let place = tip + tool.axis * *height;
            let cosine = law
                .towards(&law.base.normal(&place), tip, law.others(tip).as_ref().map(|(normal, _)| normal))?
                .dot(&tool.axis);
            if cosine.abs() <= SAME_DIRECTION {
                return Err(AxisFailure::SignUnresolved);
            }
            law.mode = Mode::Tangent { height: *height, vector, sense: cosine.signum() };
        }
        Ok(Some(law))
    }

    /// The law of an axis that turns evenly from one position to another: by the share of the straight way between both
    /// that the tool end has made.
    pub(crate) fn fan(
        &self,
        (from, origin): (&Vec3, &Vec3),
        (to, end): (&Vec3, &Vec3),
    ) -> Result<Self, AxisFailure> {
        let way = end - origin;
        let square = way.norm_squared();
        let across = from.cross(to);
        let angle = across.norm().atan2(from.dot(to));
        let about = across.try_normalize(0.0).unwrap_or_else(|| perpendicular(from));
        if square <= 0.0 || angle >= std::f64::consts::PI - SAME_DIRECTION {
            return Err(AxisFailure::SignUnresolved);
        }
        let mode = Mode::Fan { from: *from, about, angle, origin: *origin, line: way / square };
        Ok(Self { mode, ..self.clone() })
    }

    fn angles(&self, angle: f64, mode: &AxisAngle, tip: &Vec3, ahead: &Vec3) -> Result<Mode, AxisFailure> {
        let (sine, cosine) = angle.sin_cos();
        Ok(match mode {
            AxisAngle::Plain if angle.abs() <= ZERO_ANGLE => Mode::Normal,
            AxisAngle::Plain => Mode::Tilted { cosine, sine },
            AxisAngle::PerpendicularTo(vector) => {
                let vector = vector.try_normalize(0.0).ok_or(AxisFailure::NoPlane)?;
                let flat = in_plane(&self.base.normal(tip), &vector)?;
                let turning = vector.cross(&flat);
                let aside = self.other.as_ref().map_or(0.0, |other| other.normal(tip).dot(&turning));
                // Where the drive surface lies across the plane alpha leads (+) or lags.
                let (towards, leads) = match aside {
                    aside if aside.abs() > LEAD_SINE => (aside, None),
                    _ if angle.abs() <= ZERO_ANGLE => (0.0, None),
                    _ => {
                        let forward = leading(&turning, ahead)?;
                        (forward, Some(forward.signum()))
                    }
                };
                Mode::Across { vector, cosine, sine: if towards < 0.0 { -sine } else { sine }, leads }
            }
            AxisAngle::Lead(lead) => {
                let rest = 1.0 - cosine * cosine - lead.sin() * lead.sin();
                if rest < -ZERO_ANGLE {
                    return Err(AxisFailure::ImpossibleAngles { alpha: angle, beta: *lead });
                }
                let (tangent, _) = frame(
                    &self.base.normal(tip),
                    self.other.as_ref().map(|other| other.normal(tip)).as_ref(),
                )?;
                let forward = if *lead == 0.0 { 0.0 } else { leading(&tangent, ahead)? };
                let aside = rest.max(0.0).sqrt().copysign(angle);
                Mode::Lead {
                    along: cosine,
                    ahead: lead.sin(),
                    aside,
                    sense: if forward < 0.0 { -1.0 } else { 1.0 },
                }
            }
        })
    }

    /// The ruling of the controlling surface nearest to a point, as a unit vector.
    fn ruling(&self, p: &Vec3) -> Result<Vec3, AxisFailure> {
        let Surface::Ruled(sheet) = &self.base.surface else { return Err(AxisFailure::NotRuled) };
        sheet.ruling(p).ok_or(AxisFailure::NoNormal)
    }

    /// True if every surface that counts is a plane.
    pub(crate) fn is_constant(&self) -> bool {
        let plane = |directed: &Directed| matches!(directed.surface, Surface::Plane(_));
        let alone = match self.mode {
            Mode::Fan { .. } => return false,
            Mode::Normal | Mode::Across { .. } | Mode::Tangent { vector: Some(_), .. } => true,
            _ => false,
        };
        plane(&self.base) && (alone || self.other.as_ref().is_some_and(plane))
    }

    /// Whether the axis leads along one direction and lags along another, so that it would have to jump where the path turns from the one to the other.
    pub(crate) fn jumps_between(&self, tip: &Vec3, before: &Vec3, beyond: &Vec3) -> bool {
        let Mode::Lead { ahead, .. } = self.mode else { return false };
        if ahead.abs() <= ZERO_ANGLE {
            return false;
        }
        let other = self.others(tip);
        let beside = other.as_ref().map(|(normal, _)| normal);
        frame(&self.base.normal(tip), beside)
            .is_ok_and(|(tangent, _)| tangent.dot(before) * tangent.dot(beyond) < 0.0)
    }

    /// The cosine between a line of motion and the direction in which the axis leads, or against which it lags; none where it does neither.
    pub(crate) fn leads_along(&self, tip: &Vec3, line: &Vec3) -> Option<f64> {
        let normal = || self.base.normal(tip);
        let ahead = match self.mode {
            Mode::Lead { ahead, sense, .. } if ahead.abs() > ZERO_ANGLE => {
                let other = self.others(tip);
                frame(&normal(), other.as_ref().map(|(normal, _)| normal)).ok()?.0 * sense
            }
            Mode::Across { vector, leads: Some(sense), .. } => {
                vector.cross(&in_plane(&normal(), &vector).ok()?) * sense
            }
            _ => return None,
        };
        Some(ahead.dot(line))
    }

    /// The same law with the angle that it tilts by, or leads by, to the other side; none where that hangs on no place.
    pub(crate) fn to_other_side(&self) -> Option<Self> {
        let mode = match self.mode {
            Mode::Across { vector, cosine, sine, leads } if sine.abs() > ZERO_ANGLE => {
                Mode::Across { vector, cosine, sine: -sine, leads: leads.map(|sense| -sense) }
            }
            Mode::Lead { along, ahead, aside, sense } if ahead.abs() > ZERO_ANGLE => {
                Mode::Lead { along, ahead, aside, sense: -sense }
            }
            _ => return None,
        };
        Some(Self { mode, ..self.clone() })
    }

    /// The unit axis of a tool with its end at `tip`.
    pub(crate) fn axis(&self, tool: &Tool, tip: &Vec3) -> Result<Vec3, AxisFailure> {
        self.standing(tool, tip).map(|standing| standing.axis)
    }

    /// How a tool stands with its end at `tip`.
    pub(crate) fn standing(&self, tool: &Tool, tip: &Vec3) -> Result<Standing, AxisFailure> {
        go_on(tool)?;
        if let Mode::Parallel { .. } | Mode::Fan { .. } = self.mode {
            let base = (Vec3::zeros(), Matrix3::zeros());
            return Ok(Standing { axis: self.towards(&base.0, tip, None)?, base, other: None });
        }
        if matches!(self.mode, Mode::Normal) {
            let base = self.base.bend(tip);
            let axis = self.towards(&base.0, tip, None)?;
            let is_vertex = self.base.at_vertex(tip);
            return if is_vertex {
                Err(AxisFailure::Vertex)
            } else {
                Ok(Standing { axis, base, other: None })
            };
        }
        let other = self.others(tip);
        let beside = other.as_ref().map(|(normal, _)| normal);
        let base = self.settled(tool, tip, beside)?;
        let axis = self.towards(&base.0, tip, beside)?;
        let is_vertex = self.base.at_vertex(&self.place(tool, tip, &axis, &base.0));
        if is_vertex { Err(AxisFailure::Vertex) } else { Ok(Standing { axis, base, other }) }
    }

    /// The place at which the controlling surface ends, if that is where a tool with its end at `tip` has its normal. Where the axis does not settle, which
    /// it may not there, it is the normal at the tool end that tells the place.
    pub(crate) fn end_at(&self, tool: &Tool, tip: &Vec3) -> Option<Vec3> {
        let surface = &self.base.surface;
        if !surface.has_ends() || matches!(self.mode, Mode::Fan { .. }) {
            return None;
        }
        let place = match self.mode {
            Mode::Normal | Mode::Parallel { .. } => *tip,
            _ => {
                let (axis, normal) = match self.standing(tool, tip) {
                    Ok(standing) => (standing.axis, standing.base.0),
                    Err(_) => {
                        let (normal, other) = (self.base.normal(tip), self.others(tip));
                        let beside = other.as_ref().map(|(normal, _)| normal);
                        (self.towards(&normal, tip, beside).ok()?, normal)
                    }
                };
                self.place(tool, tip, &axis, &normal)
            }
        };
        surface.ends_at(&place).then(|| surface.foot(&place).point)
    }

    /// The normal of the other surface beside a place, where the axis depends on it.
    fn others(&self, tip: &Vec3) -> Option<Bent> {
        let counts =
            matches!(self.mode, Mode::Tilted { .. } | Mode::Lead { .. } | Mode::Tangent { vector: None, .. });
        self.other.as_ref().filter(|_| counts).map(|other| other.bend(tip))
    }

    /// Where the normal is taken that a tool with an axis stands on.
    fn place(&self, tool: &Tool, tip: &Vec3, axis: &Vec3, normal: &Vec3) -> Vec3 {
        match self.mode {
            Mode::Tangent { height, .. } => tip + axis * height,
            _ => corner(tool, tip, axis, normal),
        }
    }

    /// The axis that stands to a normal, and to that of the other surface where this counts.
    fn towards(&self, normal: &Vec3, tip: &Vec3, other: Option<&Vec3>) -> Result<Vec3, AxisFailure> {
        let axis = match self.mode {
            Mode::Normal => *normal,
            Mode::Parallel { sense } => self.ruling(tip)? * sense,
            Mode::Tangent { vector: Some(vector), sense, .. } => {
                normal.cross(&vector).try_normalize(SAME_DIRECTION).ok_or(AxisFailure::NoPlane)? * sense
            }
            Mode::Tangent { vector: None, sense, .. } => frame(normal, other)?.1 * sense,
            Mode::Fan { from, about, angle, origin, line } => {
                let share = share_of(&line, &(tip - origin));
                let (sin, cos) = (angle * share).sin_cos();
                from * cos + about.cross(&from) * sin
            }
            Mode::Tilted { cosine, sine } => {
                let (_, aside) = frame(normal, other)?;
                normal * cosine + aside * sine
            }
            Mode::Across { vector, cosine, sine, .. } => {
                let flat = in_plane(normal, &vector)?;
                flat * cosine + vector.cross(&flat) * sine
            }
            Mode::Lead { along, ahead, aside, sense } => {
                let (tangent, across) = frame(normal, other)?;
                normal * along + tangent * (ahead * sense) + across * aside
            }
        };
        axis.try_normalize(0.0).ok_or(AxisFailure::NoNormal)
    }

    /// The share of its way that a fan has turned by; none where it does not go on turning.
    fn share_of_fan(&self, tip: &Vec3) -> Option<f64> {
        let Mode::Fan { origin, line, .. } = self.mode else { return None };
        let way = tip - origin;
        let share = share_of(&line, &way);
        (share == line.dot(&way)).then_some(share)
    }
}

/// Counts a place of a surface.
///
/// # Errors
/// [`AxisFailure::NotSettled`] where the axis is given up with it.
fn go_on(tool: &Tool) -> Result<(), AxisFailure> {
    if tool.patience.ends_after(WORK_OF_NORMAL) {
        return Err(AxisFailure::NotSettled { change: f64::INFINITY });
    }
    Ok(())
}

/// The share of its way at which a fan stands, for trials beyond its ends, too.
fn share_of(line: &Vec3, way: &Vec3) -> f64 {
    line.dot(way).clamp(-BEYOND, 1.0 + BEYOND)
}

/// Unit vectors across the normal: along the line of motion and towards the other surface's normal.
fn frame(normal: &Vec3, other: Option<&Vec3>) -> Result<(Vec3, Vec3), AxisFailure> {
    let other = other.ok_or(AxisFailure::NoSurface)?;
    let tangent = normal.cross(other).try_normalize(SAME_DIRECTION).ok_or(AxisFailure::SignUnresolved)?;
    Ok((tangent, tangent.cross(normal)))
}

/// Component of a move along a unit vector.
///
/// # Errors
/// [`AxisFailure::SignUnresolved`] where the move goes across it, so that its sign would be that of rounding.
fn leading(direction: &Vec3, ahead: &Vec3) -> Result<f64, AxisFailure> {
    let along = direction.dot(ahead);
    if along.abs() > SAME_DIRECTION * ahead.norm() { Ok(along) } else { Err(AxisFailure::SignUnresolved) }
}

/// The part of a normal in the plane across a unit vector, as a unit vector.
fn in_plane(normal: &Vec3, vector: &Vec3) -> Result<Vec3, AxisFailure> {
    (normal - vector * normal.dot(vector)).try_normalize(SAME_DIRECTION).ok_or(AxisFailure::NoPlane)
}

/// A circle of the tool about its axis, and how far beyond it along the normal contact is.
struct Touched {
    circle: ProfilePoint,
    arc: f64,
}

/// Where a surface with a normal touches a tool: about the centre of its corner, where contact lies on the same normal. That of a barrel is
/// beyond the axis, perhaps farther than the surface has one nearest place: there it is the place itself of its arc, or the end of
/// that, or the tip.
fn touched(tool: &Tool, axis: &Vec3, normal: &Vec3) -> Touched {
    let profile = &tool.profile;
    if !profile.is_barrel() {
        return Touched { circle: profile.center, arc: 0.0 };
    }
    let along = normal.dot(axis);
    let polar = (normal - axis * along).norm().atan2(along);
    let [first, last] = profile.fan;
    let is_arc = polar >= first && polar <= last;
    let circle = match polar {
        _ if is_arc => profile.center,
        polar if polar > last => profile.upper,
        polar if polar >= profile.bottom_angle() => profile.lower,
        _ => ProfilePoint { radius: 0.0, height: 0.0 },
    };
    Touched { circle, arc: if is_arc { profile.arc } else { 0.0 } }
}

/// The point of the corner circle that faces a surface with this normal: contact lies on the same normal.
fn corner(tool: &Tool, tip: &Vec3, axis: &Vec3, normal: &Vec3) -> Vec3 {
    let Touched { circle, arc } = touched(tool, axis, normal);
    let radial = (normal - axis * normal.dot(axis)).try_normalize(SAME_DIRECTION).unwrap_or_else(Vec3::zeros);
    tip + axis * circle.height - radial * circle.radius - normal * arc
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{ground, y};

    #[test]
    fn an_axis_leads_along_its_surfaces_in_one_sense() {
        let directed = |geometry| {
            let surface = Surface::from_geometry(geometry).expect("a surface");
            Directed { surface, sign: 1.0, lift: Vec3::zeros() }
        };
        let (base, other) = (directed(&ground()), Some(directed(&y(0.0))));
        let law = Law { base, other, mode: Mode::Normal };
        let along = |mode| {
            let law = Law { mode, ..law.clone() };
            let cosine = |law: &Law| law.leads_along(&Vec3::zeros(), &Vec3::x());
            (cosine(&law), law.to_other_side().as_ref().and_then(cosine))
        };
        let lead = |ahead| Mode::Lead { along: 0.9, ahead, aside: 0.1, sense: -1.0 };
        let across = |leads| Mode::Across { vector: Vec3::y(), cosine: 0.8, sine: 0.6, leads };
        assert_eq!(along(lead(0.1)), (Some(1.0), Some(-1.0)));
        assert_eq!(along(across(Some(1.0))), (Some(1.0), Some(-1.0)));
        for of_no_direction in [Mode::Normal, lead(0.0), across(None)] {
            assert_eq!(along(of_no_direction), (None, None));
        }
    }
}

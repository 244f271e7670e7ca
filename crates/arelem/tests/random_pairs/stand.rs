//! How an axis that follows a surface stands at a tool end: the law, told anew from nearest points and angles alone.

use std::f64::consts::TAU;

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    cutter::Cutter,
    motion::{AxisAngle, AxisTangency, Relation, ToolAxis},
    surface::Surface,
};
use arelem::sequence::{Role, ToolPosition};

use crate::case::{self, Placed};

/// Steps in which axis and contact are looked for together.
const ROUNDS: u32 = 100;
/// A change of the axis below this ends them.
const SETTLED: f64 = 1e-15;
/// A change that is left after all of them, above which there is no axis.
const UNSETTLED: f64 = 1e-6;
/// Places around the corner between which the contact is closed in, and how often.
const AROUND: [u32; 2] = [64, 4096];
const HALVINGS: u32 = 60;
/// Share of the way by which an axis that fans goes on turning before its begin and behind its end.
const BEYOND: f64 = 0.5;
/// How far off an axis that fans may be where it ends, which is told to within a billionth of the coordinates, or so far that it leads the
/// top of the tool off by such a share of the band, in which motions end now here, now there.
const AT_END: f64 = 1e-7;
const AMISS: f64 = 0.01;
/// How far off an axis certainly follows its law.
const CERTAIN: f64 = 1e-10;
/// How many times the depth of the band the vertex of a cone may be away for an axis that turns about it.
const ABOUT_VERTEX: f64 = 3.0;
/// Sine between the other surface and the plane across a vector up to which an angle leads or lags.
const LEAST_ASIDE: f64 = 1e-3;

/// A surface whose normal counts.
struct Guide {
    surface: Surface,
    sign: f64,
}

impl Guide {
    fn new(geometry: &Geometry, sign: f64) -> Self {
        Self { surface: Surface::from_geometry(geometry).expect("a surface"), sign }
    }

    /// The surface that guides the axis: on the side where the tool is, where the end is ON it where the axis is.
    fn base(geometry: &Geometry, (relation, side): (Relation, f64), at: &ToolPosition) -> Self {
        let natural = Self::new(geometry, 1.0);
        let along_axis = natural.normal(&at.tip).dot(&at.axis).signum();
        Self { sign: if relation == Relation::On { along_axis } else { side }, ..natural }
    }

    /// The surface towards which a positive angle tilts: to the side where the tool is, along its own normal for ON.
    fn other(geometry: &Geometry, (relation, side): (Relation, f64)) -> Self {
        Self::new(geometry, if relation == Relation::On { 1.0 } else { side })
    }

    /// Whether the vertex of a cone is the nearest place, or hardly farther than it: across a band along the axis of the cone the normal
    /// may turn there from one side of the cone to the other.
    fn is_about_vertex(&self, p: &Vec3, band: f64) -> bool {
        match &self.surface {
            Surface::Cone(cone) => {
                (self.surface.foot(p).point - cone.vertex).norm() * cone.sine <= ABOUT_VERTEX * band
            }
            _ => false,
        }
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        self.surface.foot(p).normal * self.sign
    }

    /// The straight line of a ruled surface through the place nearest to a point.
    fn ruling(&self, p: &Vec3) -> Vec3 {
        let place = self.surface.place(p).expect("a ruled surface");
        self.surface.chart(&place).expect("a chart").first[1].normalize()
    }
}

/// An axis as a function of the tool end.
pub(crate) struct Stand {
    mode: ToolAxis,
    base: Guide,
    other: Guide,
    cutter: Cutter,
    sense: f64,
}

impl Stand {
    /// Of a motion between a part and a drive surface that begins at a position; None where the axis follows neither.
    pub(crate) fn of_motion(
        mode: &ToolAxis,
        (part, drive): (&Role, &Role),
        cutter: &Cutter,
        (at, forward): (&ToolPosition, &Vec3),
    ) -> Option<Self> {
        let role = |role: &Role| (role.surface.geometry.clone(), role.relation, role.side);
        Self::new(mode, [role(part), role(drive)], cutter, (at, forward))
    }

    /// The same of surfaces as they are laid.
    pub(crate) fn of_case(
        mode: &ToolAxis,
        (part, drive): (&Placed, &Placed),
        cutter: &Cutter,
        (at, forward): (&ToolPosition, &Vec3),
    ) -> Option<Self> {
        let role = |placed: &Placed| (case::surface(placed).geometry, placed.relation, placed.side);
        Self::new(mode, [role(part), role(drive)], cutter, (at, forward))
    }

    fn new(
        mode: &ToolAxis,
        [part, drive]: [(Geometry, Relation, f64); 2],
        cutter: &Cutter,
        (at, forward): (&ToolPosition, &Vec3),
    ) -> Option<Self> {
        let part_guides = match mode {
            ToolAxis::Normal { part } | ToolAxis::AtAngle { part, .. } | ToolAxis::Parallel { part } => *part,
            ToolAxis::Tangent { .. } => false,
            ToolAxis::Fixed(_) | ToolAxis::Keep => return None,
        };
        let (base, other) = if part_guides { (part, drive) } else { (drive, part) };
        let base = Guide::base(&base.0, (base.1, base.2), at);
        let other = Guide::other(&other.0, (other.1, other.2));
        let sense = sense(mode, (&base, &other), &at.tip, forward);
        let stand = Self { mode: *mode, base, other, cutter: *cutter, sense };
        Some(Self { sense: stand.sense_of(at).unwrap_or(sense), ..stand })
    }

    /// The sense of what has two along the guiding surface: the one in which the axis points where the motion begins.
    fn sense_of(&self, at: &ToolPosition) -> Option<f64> {
        let line = match self.mode {
            ToolAxis::Parallel { .. } => self.base.ruling(&at.tip),
            ToolAxis::Tangent { height, .. } => self.lying(&at.tip, &(at.tip + at.axis * height)),
            _ => return None,
        };
        Some(line.dot(&at.axis).signum() * self.sense)
    }

    /// The axis along the guiding surface as it is beside a place.
    fn lying(&self, tip: &Vec3, place: &Vec3) -> Vec3 {
        let normal = self.base.normal(place);
        let line = match self.mode {
            ToolAxis::Tangent { mode: AxisTangency::PerpendicularTo(vector), .. } => normal.cross(&vector),
            _ => normal.cross(&self.other.normal(tip)).cross(&normal),
        };
        line.normalize() * self.sense
    }

    /// The axis at a tool end, found from the normal there.
    pub(crate) fn axis(&self, tip: &Vec3) -> Option<Vec3> {
        match self.mode {
            ToolAxis::AtAngle { .. } => {
                let (axis, change) = self.settled(tip);
                (change <= UNSETTLED).then_some(axis)
            }
            ToolAxis::Parallel { .. } => Some(self.base.ruling(tip) * self.sense),
            ToolAxis::Tangent { mode: AxisTangency::Fan, .. } => None,
            ToolAxis::Tangent { height, .. } => {
                let mut axis = self.lying(tip, tip);
                let mut change = f64::INFINITY;
                for _ in 0..ROUNDS {
                    let next = self.lying(tip, &(tip + axis * height));
                    change = (next - axis).norm();
                    axis = next;
                    if change <= SETTLED {
                        break;
                    }
                }
                (change <= UNSETTLED).then_some(axis)
            }
            _ => Some(self.base.normal(tip)),
        }
    }

    /// The cosine between a line of motion and the direction in which the axis leads or against which it lags; none where it does neither.
    pub(crate) fn leads_along(&self, tip: &Vec3, line: &Vec3) -> Option<f64> {
        let (normal, aside) = (self.base.normal(tip), self.other.normal(tip));
        match self.mode {
            ToolAxis::AtAngle { mode: AxisAngle::Lead(lead), .. } if lead != 0.0 => {
                Some(self.sense * normal.cross(&aside).normalize().dot(line))
            }
            ToolAxis::AtAngle { mode: AxisAngle::PerpendicularTo(vector), angle, .. } if angle != 0.0 => {
                let turning = turning_about(&vector.normalize(), &normal);
                (aside.dot(&turning).abs() <= LEAST_ASIDE).then(|| self.sense * turning.dot(line))
            }
            _ => None,
        }
    }

    /// Whether a position is so near to the vertex of a cone that the tool may turn about it, at its end or at the height that guides it.
    pub(crate) fn is_about_vertex(&self, at: &ToolPosition, band: f64) -> bool {
        let height = if let ToolAxis::Tangent { height, .. } = self.mode { height } else { 0.0 };
        [at.tip, at.tip + at.axis * height]
            .iter()
            .any(|place| self.base.is_about_vertex(place, band) || self.other.is_about_vertex(place, band))
    }

    /// How far the axis of a position is from what the law asks for.
    pub(crate) fn off(&self, ToolPosition { tip, axis }: &ToolPosition) -> f64 {
        match self.mode {
            ToolAxis::AtAngle { .. } => {}
            ToolAxis::Parallel { .. } => return (axis - self.base.ruling(tip) * self.sense).norm(),
            ToolAxis::Tangent { height, .. } => {
                return (axis - self.lying(tip, &(tip + axis * height))).norm();
            }
            _ => return (axis - self.base.normal(tip)).norm(),
        }
        let aside = self.other.normal(tip);
        let off = |normal: Vec3| (self.asked(&normal, &aside) - axis).norm();
        let least = |around: u32| {
            self.normals_at_corner((tip, axis), around).into_iter().map(off).fold(f64::INFINITY, f64::min)
        };
        // Two of them may be close together.
        let first = least(AROUND[0]);
        if first <= CERTAIN { first } else { first.min(least(AROUND[1])) }
    }

    /// Where an axis does not turn evenly, with the straight way, from where it begins to what it is along the guiding surface at the end.
    pub(crate) fn off_fan(
        &self,
        start: &ToolPosition,
        points: &[ToolPosition],
        (exact, band): (f64, f64),
    ) -> Option<String> {
        let last = points.last()?;
        let off = self.off(last);
        let reach = 0.5 * self.cutter.diameter + self.cutter.height;
        let is_told = !self.is_about_vertex(last, band);
        if is_told && off > AT_END && off * reach > AMISS * band {
            return Some(format!("axis off by {off:e} at the end, {last:?}"));
        }
        let way = last.tip - start.tip;
        let turn = start.axis.cross(&last.axis);
        let (about, angle) = (turn.normalize(), turn.norm().atan2(start.axis.dot(&last.axis)));
        points.iter().find_map(|point| {
            let share = (point.tip - start.tip).dot(&way) / way.norm_squared();
            let turned = angle * share.clamp(-BEYOND, 1.0 + BEYOND);
            let asked = start.axis * turned.cos() + about.cross(&start.axis) * turned.sin();
            let off = (asked - point.axis).norm();
            (angle > exact && off > exact).then(|| format!("axis off by {off:e} at {point:?}"))
        })
    }

    /// Normals of the guiding surface in whose direction, seen from the axis, the corner is where they are taken. On a surface that bends
    /// more than the corner does there may be several.
    fn normals_at_corner(&self, (tip, axis): (&Vec3, &Vec3), around: u32) -> Vec<Vec3> {
        let (center, radius) = (tip + axis * self.cutter.corner_height, self.cutter.corner_offset.max(0.0));
        let across = apt_geometry::surface::perpendicular(axis);
        let normal = |turn: f64| {
            let (sin, cos) = turn.sin_cos();
            let (radial, along) =
                (across * cos + axis.cross(&across) * sin, axis.cross(&across) * cos - across * sin);
            let normal = self.base.normal(&(center + radial * radius));
            (normal, normal.dot(&along), normal.dot(&radial))
        };
        if radius == 0.0 {
            return vec![normal(0.0).0];
        }
        let at = |k: u32| TAU * f64::from(k) / f64::from(around);
        let mut found = Vec::new();
        for k in 0..around {
            let (mut low, mut high) = (at(k), at(k + 1));
            let sign = normal(low).1 > 0.0;
            if (normal(high).1 > 0.0) == sign {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if (normal(middle).1 > 0.0) == sign { low = middle } else { high = middle }
            }
            found.push(normal(low));
        }
        let faces = |(_, _, outward): &(Vec3, f64, f64)| *outward <= 0.0;
        found.into_iter().filter(faces).map(|(normal, ..)| normal).collect()
    }

    /// The angles hold at the contact, which moves with the axis: both are looked for together, from the normal at the tool end. The axis,
    /// and its last change.
    fn settled(&self, tip: &Vec3) -> (Vec3, f64) {
        let aside = self.other.normal(tip);
        let mut normal = self.base.normal(tip);
        let mut axis = self.asked(&normal, &aside);
        let mut change = f64::INFINITY;
        for _ in 0..ROUNDS {
            let radial = (normal - axis * normal.dot(&axis)).try_normalize(1e-6).unwrap_or_else(Vec3::zeros);
            let corner = axis * self.cutter.corner_height - radial * self.cutter.corner_offset.max(0.0);
            normal = self.base.normal(&(tip + corner));
            let next = self.asked(&normal, &aside);
            change = (next - axis).norm();
            axis = next;
            if change <= SETTLED {
                break;
            }
        }
        (axis, change)
    }

    /// The axis that the angles ask for with a normal of the guiding surface.
    fn asked(&self, normal: &Vec3, aside: &Vec3) -> Vec3 {
        let ToolAxis::AtAngle { angle, mode, .. } = &self.mode else { return *normal };
        let tangent = normal.cross(aside).normalize();
        let across = tangent.cross(normal);
        let (sine, cosine) = angle.sin_cos();
        match mode {
            AxisAngle::Plain => normal * cosine + across * sine,
            AxisAngle::Lead(lead) => {
                let rest = (1.0 - cosine * cosine - lead.sin().powi(2)).max(0.0).sqrt().copysign(*angle);
                normal * cosine + tangent * (self.sense * lead.sin()) + across * rest
            }
            AxisAngle::PerpendicularTo(vector) => {
                let vector = vector.normalize();
                let flat = (normal - vector * normal.dot(&vector)).normalize();
                flat * cosine + vector.cross(&flat) * (self.sense * sine)
            }
        }
    }
}

/// The sense that the angles have all along a motion: of the lead against the product of both normals, and of the turn about a vector,
/// towards the side of the other surface, or ahead where that lies across.
fn sense(mode: &ToolAxis, (base, other): (&Guide, &Guide), tip: &Vec3, forward: &Vec3) -> f64 {
    let (normal, aside) = (base.normal(tip), other.normal(tip));
    match mode {
        ToolAxis::AtAngle { mode: AxisAngle::Lead(_), .. } => normal.cross(&aside).dot(forward).signum(),
        ToolAxis::AtAngle { mode: AxisAngle::PerpendicularTo(vector), .. } => {
            let turning = turning_about(&vector.normalize(), &normal);
            let towards = aside.dot(&turning);
            if towards.abs() > LEAST_ASIDE { towards.signum() } else { forward.dot(&turning).signum() }
        }
        _ => 1.0,
    }
}

/// The direction in which a normal goes, in the plane across a unit vector, that turns about it.
fn turning_about(vector: &Vec3, normal: &Vec3) -> Vec3 {
    vector.cross(&(normal - vector * normal.dot(vector)).normalize())
}

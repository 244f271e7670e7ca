//! Clearance to cylinders and cones with the tool outside, whatever the angle between the axes: the greatest support
//! distance over the one-parameter family of surface normals (arelem reference 5.2). The function is unimodal where it
//! matters, and its derivative is read off the support point.

use std::f64::consts::{PI, TAU};

use apt_geometry::{
    Vec3,
    canonical::Cylinder,
    cutter::ProfilePoint,
    surface::{ConeForm, Surface, perpendicular},
};

use super::{Contact, Tool, closed_form::ball_outside};

/// Scan points over the family of normals.
const SCAN: usize = 16;
/// Bound of the bracketed iteration: bisection alone reaches rounding within it.
const MAX_ITERATIONS: u32 = 60;
/// Width of the bracket, radians, that is rounding.
const RESOLUTION: f64 = 1e-15;
/// Width of a bracket about a kink, radians, whose normals are the same but for rounding.
const KINK_RESOLUTION: f64 = 1e-11;
/// Share of the bracket beyond a kink at which its other side is looked at.
const BEYOND: f64 = 1e-3;
/// Slope, relative to the size of the lengths, that is rounding; the greatest distance is found as well as that too.
const SLOPE_RESOLUTION: f64 = 1e-14;

/// Surface normals `n(φ) = fixed + (cos φ · a + sin φ · b)`, with support `n·origin + level` of the solid.
struct Family {
    fixed: Vec3,
    a: Vec3,
    b: Vec3,
    origin: Vec3,
    level: f64,
}

impl Family {
    fn normal(&self, angle: f64) -> (Vec3, Vec3) {
        let (sin, cos) = angle.sin_cos();
        (self.fixed + self.a * cos + self.b * sin, self.b * cos - self.a * sin)
    }

    /// Angles between which the distance is smooth and has one hump: a scan, the normals across the straight lines of the
    /// profile, at which contact jumps from one end of the line to the other, and those nearest to the tool axis.
    fn angles(&self, tool: &Tool) -> Vec<f64> {
        let step = TAU / SCAN as f64;
        let mut angles: Vec<f64> = (0..SCAN).map(|k| step * k as f64).collect();
        let [middle, a, b] = [self.fixed, self.a, self.b].map(|v| v.dot(&tool.axis));
        let (swing, towards) = (a.hypot(b), b.atan2(a));
        let profile = &tool.profile;
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let lines = [(tip, profile.lower), (profile.upper, profile.top)];
        let across = lines.into_iter().filter_map(|(from, to)| {
            let (out, up) = (to.radius - from.radius, to.height - from.height);
            // Cosine of the angle between tool axis and inward normal.
            let turn = ((out / out.hypot(up) - middle) / swing).acos();
            turn.is_finite().then_some(turn)
        });
        for turn in across.flat_map(|turn| [turn, -turn]).chain([0.0, PI]) {
            angles.push((towards + turn).rem_euclid(TAU));
        }
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        angles
    }

    /// Support distance, its derivative, the normal and the tool's contact point.
    fn sample(&self, tool: &Tool, tip: &Vec3, angle: f64) -> (f64, f64, Vec3, Vec3) {
        let (normal, turned) = self.normal(angle);
        let (along, across, radial) = tool.split(&normal);
        let (support, point) = tool.profile.support(across, -along);
        let w = tip - self.origin;
        let contact = tool.axis * point.height - radial * point.radius;
        (normal.dot(&w) - self.level - support, turned.dot(&(w + contact)), normal, tip + contact)
    }
}

/// The clearance for the tool outside a cylinder or cone.
pub(super) fn contact(tool: &Tool, surface: &Surface, side: f64, tip: &Vec3) -> Option<Contact> {
    if side < 0.0 {
        return None;
    }
    match surface {
        Surface::Cylinder(cylinder) => Some(outside_cylinder(tool, cylinder, tip)),
        Surface::Cone(cone) => Some(outside_cone(tool, cone, tip)),
        _ => None,
    }
}

fn outside_cylinder(tool: &Tool, cylinder: &Cylinder, tip: &Vec3) -> Contact {
    let a = perpendicular(&cylinder.axis);
    let b = cylinder.axis.cross(&a);
    let family = Family { fixed: Vec3::zeros(), a, b, origin: cylinder.point, level: cylinder.radius };
    greatest(tool, &family, tip)
}

fn outside_cone(tool: &Tool, cone: &ConeForm, tip: &Vec3) -> Contact {
    let a = perpendicular(&cone.axis) * cone.cosine;
    let b = cone.axis.cross(&a);
    let family = Family { fixed: -cone.axis * cone.sine, a, b, origin: cone.vertex, level: 0.0 };
    about_vertex(tool, cone, tip, greatest(tool, &family, tip))
}

/// The contact of a tool outside a cone, given the greatest of the distances by the planes that touch it along a ruling.
/// Behind the vertex the normals of the vertex's own fan are nearer: then the vertex is the solid.
pub(super) fn about_vertex(tool: &Tool, cone: &ConeForm, tip: &Vec3, side: Contact) -> Contact {
    let vertex = ball_outside(tool, &cone.vertex, 0.0, tip);
    let in_fan = |normal: &Vec3| normal.dot(&cone.axis) <= -cone.sine;
    let mut best = side;
    if in_fan(&vertex.gradient) && vertex.clearance > best.clearance {
        best = vertex;
    }
    if best.clearance < 0.0 {
        // The tool cuts the vertex off: the way out through each face counts, not only the shortest.
        let toward = tool.split(&(cone.vertex - tip)).2;
        let (sa, ca) = tool.profile.bottom_angle().max(tool.cutter.alpha).sin_cos();
        let (sb, cb) = tool.cutter.beta.sin_cos();
        let corner = tip + tool.axis * tool.profile.center.height + toward * tool.profile.center.radius;
        let through_corner = (corner - cone.vertex).try_normalize(0.0).unwrap_or(tool.axis);
        let faces = [tool.axis * ca - toward * sa, tool.axis * sb - toward * cb, -tool.axis, through_corner];
        for normal in faces {
            let depth = normal.dot(&(tip - cone.vertex)) - support(tool, &normal);
            if in_fan(&normal) && depth > best.clearance {
                let contact = cone.vertex + normal * depth;
                best = Contact { clearance: depth, gradient: normal, tool: contact, surface: cone.vertex };
            }
        }
    }
    best
}

/// Support of the tool against a normal.
fn support(tool: &Tool, normal: &Vec3) -> f64 {
    let (along, across, _) = tool.split(normal);
    tool.profile.support(across, -along).0
}

fn greatest(tool: &Tool, family: &Family, tip: &Vec3) -> Contact {
    let ends: Vec<End> =
        family.angles(tool).into_iter().map(|angle| End::at(tool, family, tip, angle)).collect();
    let size = tool.radius() + tool.cutter.height + (tip - family.origin).norm();
    let resolution = SLOPE_RESOLUTION * size;
    let around = ends.first().map(|first| End { angle: first.angle + TAU, ..*first });
    let mut best: Option<End> = None;
    for (low, high) in ends.iter().zip(ends.iter().skip(1).chain(&around)) {
        // Where it rises at first and falls at last there is a greatest distance in between. A slight cut has several
        // candidates; the one with the greatest distance is the way out.
        if low.slope > 0.0 && high.slope < 0.0 {
            let found = refine(tool, family, tip, [*low, *high], [size, resolution]);
            if best.is_none_or(|best| found.value > best.value) {
                best = Some(found);
            }
        }
    }
    for end in &ends {
        // At a kink the slope is that of either side.
        if best.is_none_or(|best| end.value > best.value + resolution) {
            best = Some(*end);
        }
    }
    let angle = best.map_or(0.0, |best| best.angle);
    let (clearance, slope, normal, contact) = family.sample(tool, tip, angle);
    let contact = if slope.abs() <= resolution {
        contact
    } else {
        between(tool, family, tip, angle).unwrap_or(contact)
    };
    Contact { clearance, gradient: normal, tool: contact, surface: contact - normal * clearance }
}

/// The contact where a straight edge of the tool lies along the solid: of its two ends, which the normals on either side
/// see, the place at which the distance is greatest. How the clearance changes while the tool turns depends on it.
fn between(tool: &Tool, family: &Family, tip: &Vec3, angle: f64) -> Option<Vec3> {
    let [before, after] = [-KINK_RESOLUTION, KINK_RESOLUTION].map(|by| family.sample(tool, tip, angle + by));
    let (rising, falling) = (before.1, after.1);
    (rising > 0.0 && falling < 0.0).then(|| before.3 + (after.3 - before.3) * (rising / (rising - falling)))
}

/// A place of the bracket: angle, distance there, and its derivative.
#[derive(Clone, Copy)]
struct End {
    angle: f64,
    value: f64,
    slope: f64,
}

impl End {
    fn at(tool: &Tool, family: &Family, tip: &Vec3, angle: f64) -> Self {
        let (value, slope, ..) = family.sample(tool, tip, angle);
        Self { angle, value, slope }
    }

    /// Where the tangents at two ends meet, and how high: the distance between them is no greater.
    fn meeting(&self, other: &Self) -> Option<(f64, f64)> {
        let rise = self.slope - other.slope;
        if rise <= 0.0 {
            return None;
        }
        let angle = (other.value - self.value + self.slope * self.angle - other.slope * other.angle) / rise;
        Some((angle, self.value + self.slope * (angle - self.angle)))
    }
}

/// The greatest distance in a bracket, lengths being of a size and slopes below a resolution being rounding.
fn refine(tool: &Tool, family: &Family, tip: &Vec3, bracket: [End; 2], [size, resolution]: [f64; 2]) -> End {
    let [mut low, mut high] = bracket;
    // Slopes for the Illinois rule: an end that stays twice is weighed half, so that both ends move.
    let (mut weight_low, mut weight_high) = (low.slope, high.slope);
    let (mut here, mut last) = (if high.value > low.value { high } else { low }, 0.0);
    let mut best = here;
    for iteration in 0..MAX_ITERATIONS {
        let narrow = high.angle - low.angle <= RESOLUTION * (1.0 + here.angle.abs());
        if here.slope.abs() <= resolution {
            // About a smooth greatest distance the distance tells less than the slope.
            best = here;
            break;
        }
        if here.value > best.value {
            best = here;
        }
        if narrow {
            break;
        }
        if here.slope > 0.0 {
            (low, weight_low) = (here, here.slope);
            weight_high *= if last > 0.0 { 0.5 } else { 1.0 };
        } else {
            (high, weight_high) = (here, here.slope);
            weight_low *= if last < 0.0 { 0.5 } else { 1.0 };
        }
        last = here.slope;
        let (reach, middle) = (high.angle - low.angle, 0.5 * (low.angle + high.angle));
        // At the kinks that straight edges of the tool make the slope is never small, but the tangents of the two ends
        // meet there, as far as the stretches between are straight.
        let meeting = low.meeting(&high);
        let sag = size * reach * reach;
        let is_found = meeting.is_some_and(|(_, bound)| bound + sag - best.value <= resolution);
        if is_found && reach <= KINK_RESOLUTION {
            break;
        }
        let kink = meeting.map_or(middle, |(angle, _)| angle);
        let next = match iteration % 4 {
            2 => kink,
            // Just beyond, so that the farther end comes near too.
            3 if kink - low.angle < high.angle - kink => kink + (kink - low.angle).max(BEYOND * reach),
            3 => kink - (high.angle - kink).max(BEYOND * reach),
            _ => low.angle + reach * weight_low / (weight_low - weight_high),
        };
        let next = if next > low.angle && next < high.angle { next } else { middle };
        if next == here.angle {
            break;
        }
        here = End::at(tool, family, tip, next);
    }
    best
}

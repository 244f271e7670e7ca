//! Clearance to cylinders and cones with the tool outside, whatever the angle between the axes: the greatest support
//! distance over the one-parameter family of surface normals (arelem reference 5.2). The function is unimodal where it
//! matters, and its derivative is read off the support point.

use apt_geometry::{
    Vec3,
    canonical::Cylinder,
    surface::{ConeForm, Surface, perpendicular},
};

use super::{Contact, Tool, closed_form::ball_outside};

/// Scan points over the family of normals.
const SCAN: usize = 16;
/// Bound of the bracketed iteration: bisection alone reaches rounding within it.
const MAX_ITERATIONS: u32 = 60;
/// Width of the bracket, radians, that is rounding.
const RESOLUTION: f64 = 1e-15;

/// Slope, relative to the size of the lengths, that is rounding.
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
    let side = greatest(tool, &family, tip);
    // Behind the vertex the normals of the vertex's own fan are nearer: then the vertex is the solid.
    let vertex = ball_outside(tool, &cone.vertex, 0.0, tip);
    let in_fan = |normal: &Vec3| normal.dot(&cone.axis) <= -cone.sine;
    let mut best = side;
    if in_fan(&vertex.gradient) && vertex.clearance > best.clearance {
        best = vertex;
    }
    if best.clearance < 0.0 {
        // The tool cuts the vertex off: the way out through each face counts, not only the shortest.
        let toward = tool.split(&(cone.vertex - tip)).2;
        let (sa, ca) = tool.cutter.alpha.sin_cos();
        let (sb, cb) = tool.cutter.beta.sin_cos();
        let corner = tip + tool.axis * tool.profile.center.height + toward * tool.profile.center.radius;
        let through_corner = (corner - cone.vertex).try_normalize(0.0).unwrap_or(tool.axis);
        for normal in [tool.axis * ca - toward * sa, tool.axis * sb - toward * cb, through_corner] {
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
    let step = std::f64::consts::TAU / SCAN as f64;
    let values: [f64; SCAN] = std::array::from_fn(|k| family.sample(tool, tip, step * k as f64).0);
    let mut best: Option<Contact> = None;
    for k in 0..SCAN {
        // A slight cut has several candidates; the one with the greatest distance is the way out.
        if values[k] >= values[(k + 1) % SCAN] && values[k] > values[(k + SCAN - 1) % SCAN] {
            let contact = refine(tool, family, tip, step * k as f64, step);
            if best.is_none_or(|found| contact.clearance > found.clearance) {
                best = Some(contact);
            }
        }
    }
    best.unwrap_or_else(|| refine(tool, family, tip, 0.0, step))
}

/// The greatest distance near a scan point.
fn refine(tool: &Tool, family: &Family, tip: &Vec3, start: f64, step: f64) -> Contact {
    let (mut low, mut high) = (start - step, start + step);
    let (mut slope_low, mut slope_high) = (family.sample(tool, tip, low).1, family.sample(tool, tip, high).1);
    let resolution = SLOPE_RESOLUTION * (tool.radius() + (tip - family.origin).norm());
    let (mut angle, mut last) = (start, 0.0);
    for iteration in 0..MAX_ITERATIONS {
        let slope = family.sample(tool, tip, angle).1;
        if slope.abs() <= resolution || high - low <= RESOLUTION * (1.0 + angle.abs()) {
            break;
        }
        // The Illinois rule: an end that stays twice is weighed half, so that both ends move.
        if slope > 0.0 {
            (low, slope_low) = (angle, slope);
            slope_high *= if last > 0.0 { 0.5 } else { 1.0 };
        } else {
            (high, slope_high) = (angle, slope);
            slope_low *= if last < 0.0 { 0.5 } else { 1.0 };
        }
        last = slope;
        // Every fourth step bisects, for the kinks of straight tool edges.
        let secant = low + (high - low) * slope_low / (slope_low - slope_high);
        let next =
            if iteration % 4 != 3 && secant > low && secant < high { secant } else { 0.5 * (low + high) };
        if next == angle {
            break;
        }
        angle = next;
    }
    let (clearance, _, normal, contact) = family.sample(tool, tip, angle);
    Contact { clearance, gradient: normal, tool: contact, surface: contact - normal * clearance }
}

//! Lower bounds of the distance from a surface over arcs about the tool axis, from one place where it is known.
//!
//! With `bend` a bound of the second derivatives downward, the distance at `place + y` is at least
//! `distance + gradient·y − bend·|y|²/2`, and more by what is spared along a direction in which it bends less. On a circle about
//! the axis `|y|²` is linear in the direction of the radius, so that the least of this over an arc has a closed form. Along straight
//! lines it is concave: of a polygon that is turned about the axis its corners tell all. Where contact is that place, and the circle curves more than the surface, the bound
//! is as high as the contact itself over an arc of finite length.

use std::f64::consts::{FRAC_PI_2, PI};

use apt_geometry::{Vec3, surface::Surface};

use super::Tool;

/// A place with its distance from a surface on the tool's side, and the gradient of that.
#[derive(Debug, Clone, Copy)]
pub(super) struct Base {
    pub(super) place: Vec3,
    pub(super) distance: f64,
    pub(super) gradient: Vec3,
}

/// Part of a circle about the tool axis: `half` a range of azimuth about a middle one, π for all of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    pub(super) radius: f64,
    pub(super) height: f64,
    pub(super) azimuth: f64,
    pub(super) half: f64,
}

/// How the distance may bend about a base: a bound downward, and a direction in which it bends less.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub(super) bend: f64,
    pub(super) straight: Option<Straight>,
}

/// A unit direction in which the distance bends less, and by how much: along the generator of a surface not at all.
#[derive(Debug, Clone, Copy)]
pub(super) struct Straight {
    pub(super) along: Vec3,
    pub(super) spared: f64,
}

impl Course {
    /// Beside a surface with a generator, or with none.
    pub(super) fn along_generator(bend: f64, generator: Option<Vec3>) -> Self {
        Self { bend, straight: generator.map(|along| Straight { along, spared: bend }) }
    }
}

impl Base {
    /// At a place.
    pub(super) fn at(surface: &Surface, side: f64, place: Vec3) -> Self {
        let foot = surface.foot(&place);
        Self { place, distance: side * foot.distance, gradient: foot.normal * side }
    }

    /// No point of an arc is nearer to the surface.
    pub(super) fn least(&self, tool: &Tool, tip: &Vec3, course: Course, arc: Arc) -> f64 {
        let Course { bend, straight } = course;
        let Arc { radius, height, azimuth, half } = arc;
        let w = tip + tool.axis * height - self.place;
        let mut level =
            self.distance + self.gradient.dot(&w) - 0.5 * bend * (w.norm_squared() + radius * radius);
        let mut slope = (self.gradient - w * bend) * radius;
        if let Some(Straight { along, spared }) = straight {
            let way = along.dot(&w);
            let (constant, turned) = self.square_along(tool, tip, &along, arc);
            level += 0.5 * spared * (way * way + radius * radius * constant);
            slope += (along * way + turned * (0.5 * radius)) * (spared * radius);
        }
        let (sin, cos) = azimuth.sin_cos();
        let radial = tool.across[0] * cos + tool.across[1] * sin;
        level + least_cosine(slope.dot(&radial), slope.dot(&tool.axis.cross(&radial)), half)
    }

    /// For a unit radius e the square of its part along a direction is at least the constant and the product of e and the vector,
    /// equal to it at the azimuth of the base, or in the middle of the arc for a base on the axis, up to terms of third
    /// order: those are bounded over the arc.
    fn square_along(&self, tool: &Tool, tip: &Vec3, direction: &Vec3, arc: Arc) -> (f64, Vec3) {
        let [x, y] = tool.across.map(|across| across.dot(&(self.place - tip)));
        let (sin, cos) = arc.azimuth.sin_cos();
        let away = x.hypot(y);
        let (anchor, middle) =
            if away > 0.0 { ([x / away, y / away], [cos, sin]) } else { ([cos, sin], [cos, sin]) };
        let apart = (anchor[0] * middle[0] + anchor[1] * middle[1]).clamp(-1.0, 1.0).acos();
        let widest = (apart + arc.half).min(PI);
        let e = tool.across[0] * anchor[0] + tool.across[1] * anchor[1];
        let t = tool.axis.cross(&e);
        // (a cos ψ + b sin ψ)² = a² + 2ab sin ψ + (b² − a²) sin²ψ − 2ab sin ψ (1 − cos ψ), with sin²ψ between two multiples of
        // 1 − cos ψ.
        let (a, b) = (direction.dot(&e), direction.dot(&t));
        let square = b * b - a * a;
        let rise = square * if square > 0.0 { 1.0 + widest.cos() } else { 2.0 };
        let third = 2.0 * (a * b).abs() * widest.min(FRAC_PI_2).sin();
        let rise = rise - third;
        (a * a + rise, e * -rise + t * (2.0 * a * b))
    }
}

/// What the distance is expanded about: the contact, and the centre of the corner at its azimuth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bases {
    pub(super) contact: Base,
    pub(super) core: Option<Base>,
}

impl Bases {
    /// About a point of the tool.
    pub(super) fn about(tool: &Tool, tip: &Vec3, (surface, side): (&Surface, f64), point: &Vec3) -> Self {
        let has_balls = tool.profile.arc > 0.0 && !tool.profile.is_barrel();
        let core = has_balls.then(|| {
            let radial = tool.split(&(point - tip)).2;
            let center = &tool.profile.center;
            Base::at(surface, side, tip + tool.axis * center.height + radial * center.radius)
        });
        Self { contact: Base::at(surface, side, *point), core }
    }
}

/// The least value of `a cos ψ + b sin ψ` for |ψ| up to `half`.
fn least_cosine(a: f64, b: f64, half: f64) -> f64 {
    let lowest = (-b).atan2(-a).abs();
    if lowest <= half { -a.hypot(b) } else { a * half.cos() - b.abs() * half.sin() }
}

#[cfg(test)]
mod tests {
    use apt_geometry::{
        canonical::{Cylinder, Geometry, Sphere},
        cutter::Cutter,
    };
    use proptest::prelude::*;

    use super::*;

    fn surfaces() -> [(Surface, Option<Vec3>); 2] {
        let axis = Vec3::new(0.3, 1.0, -0.2).normalize();
        let round = [
            Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 2.0 }),
            Geometry::Cylinder(Cylinder { point: Vec3::zeros(), axis, radius: 2.0 }),
        ];
        let [sphere, cylinder] = round.map(|g| Surface::from_geometry(&g).expect("a surface"));
        [(sphere, None), (cylinder, Some(axis))]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// Inside of a sphere and a cylinder, where the distance bends downward by no more than the reciprocal of what is
        /// left of the radius, no point of an arc is below the bound, and one that is close has a bound that is close.
        #[test]
        fn no_point_of_an_arc_is_below_its_bound(
            which in 0usize..2, tip in prop::array::uniform3(-0.3..0.3f64), place in prop::array::uniform3(-0.4..0.4f64),
            radius in 0.0..0.5f64, height in 0.0..0.5f64, azimuth in -3.0..3.0f64, half in 0.01..std::f64::consts::PI,
        ) {
            let (surface, generator) = &surfaces()[which];
            let tool = Tool::new(Cutter::from_numbers(&[1.0], 1.0).expect("a cutter"), Vec3::z());
            let (tip, place) = (Vec3::from(tip), Vec3::from(place) + Vec3::x() * 0.7);
            let base = Base::at(surface, -1.0, place);
            // Nothing in question is nearer to the centre or the axis than this.
            let point = |a: f64| tip + Vec3::z() * height + (tool.across[0] * a.cos() + tool.across[1] * a.sin()) * radius;
            let depth = |p: &Vec3| 2.0 + surface.signed_distance(p);
            let points: Vec<Vec3> = (0..=60).map(|k| point(azimuth + half * (f64::from(k) / 30.0 - 1.0))).collect();
            let ways = points.iter().flat_map(|p| (0..=10).map(move |k| place + (p - place) * (0.1 * f64::from(k))));
            let nearest = ways.map(|p| depth(&p)).fold(f64::INFINITY, f64::min);
            prop_assume!(nearest > 0.05);
            let course = Course::along_generator(1.0 / (0.9 * nearest), *generator);
            let bound = base.least(&tool, &tip, course, Arc { radius, height, azimuth, half });
            for p in &points {
                let distance = -surface.signed_distance(p);
                prop_assert!(distance >= bound - 1e-12, "{distance} {bound}");
            }
            let close = base.least(&tool, &place, course, Arc { radius: 1e-4, height: 0.0, azimuth, half });
            prop_assert!(close >= base.distance - 1.1e-4);
        }
    }
}

//! The tool as a convex solid of revolution: depth of points, and where it stands when it touches a surface.

use apt_geometry::{
    Vec3,
    cutter::{Cutter, Profile, ProfilePoint},
};
use serde::{Deserialize, Serialize};

/// Sine of the angle to the axis below which a contact normal has no direction across the axis.
const ALONG_AXIS_SINE: f64 = 1e-9;
/// Slack of the greatest polar angle at which a tool can touch, radians: normals come from differences of large numbers.
const POLAR_SLACK: f64 = 1e-9;

/// Where a tool is and how it leans.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// The tool end.
    pub end: Vec3,
    /// Unit vector from the end up the shank.
    pub axis: Vec3,
}

/// The depth of a point in the tool.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// Distance to the surface of the tool, positive inside.
    pub value: f64,
    /// A direction of length 1 such that the depth anywhere is at most `value` plus the step along it.
    pub ascent: Vec3,
}

/// The arc of the corner beside a point, in the plane through the tool axis and the point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Round {
    /// Depth of the point.
    pub(crate) depth: f64,
    /// Distance of the point from the centre of the arc.
    pub(crate) distance: f64,
    /// Unit vector from that centre to the point.
    pub(crate) normal: Vec3,
    /// Unit vector across that in the plane, outward where the normal points down the axis.
    pub(crate) across: Vec3,
    /// Unit vector out of the plane.
    pub(crate) out: Vec3,
    /// Sine and cosine of the angle of the normal from straight down.
    pub(crate) polar: [f64; 2],
    /// Distance of the centre from the axis.
    pub(crate) ring: f64,
    /// Sine and cosine of those angles of the arc's first and last normal.
    pub(crate) fan: [[f64; 2]; 2],
}

impl Round {
    /// Whether the centre of the arc is on the axis: the corner is part of a ball.
    #[inline]
    pub(crate) fn is_sphere(&self) -> bool {
        self.ring == 0.0
    }
}

/// A contact that no place of the tool can make.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the normal leans {polar} rad from the tool axis, the tool touches up to {greatest} rad")]
pub struct NoPlaceOnTool {
    /// Angle between the normal and the axis, radians.
    pub polar: f64,
    /// The greatest such angle at which the tool touches, radians.
    pub greatest: f64,
}

/// The solid of a cutter, grown by the stock that is to stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tool {
    profile: Profile,
    faces: [Face; 3],
    /// Sine and cosine of the polar angles of the arc's first and last normal.
    fan: [[f64; 2]; 2],
    /// Half angle between axis and upper line, radians.
    upper_lean: f64,
    /// Stock added all around, negative to bite.
    stock: f64,
}

/// A straight part of the profile: outward normal and the value of it along the part.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Face {
    radial: f64,
    axial: f64,
    offset: f64,
}

impl Tool {
    /// The tool of a cutter, with `stock` (THICK) all around.
    pub fn new(cutter: &Cutter, stock: f64) -> Self {
        let profile = cutter.profile();
        let (sa, ca) = cutter.alpha.sin_cos();
        let (sb, cb) = cutter.beta.sin_cos();
        let face = |radial: f64, axial: f64, at: ProfilePoint| Face {
            radial,
            axial,
            offset: radial * at.radius + axial * at.height,
        };
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let faces = [face(sa, -ca, tip), face(cb, -sb, profile.upper), face(0.0, 1.0, profile.top)];
        let fan = profile.fan.map(|angle| <[f64; 2]>::from(angle.sin_cos()));
        Self { profile, faces, fan, upper_lean: cutter.beta, stock }
    }

    /// The same tool with other stock.
    pub fn with_stock(&self, stock: f64) -> Self {
        Self { stock, ..*self }
    }

    /// Stock all around.
    pub fn stock(&self) -> f64 {
        self.stock
    }

    /// Radius of the corner arc; zero for a sharp corner.
    pub fn corner_radius(&self) -> f64 {
        self.profile.arc
    }

    /// Distance of the corner centre (or of the sharp corner) from the axis.
    pub fn corner_offset(&self) -> f64 {
        self.profile.center.radius
    }

    /// Height of the corner centre above the tool end.
    pub fn corner_height(&self) -> f64 {
        self.profile.center.height
    }

    /// Greatest distance of a point of the tool from its end.
    pub fn reach(&self) -> f64 {
        let corner = |at: ProfilePoint| at.radius.hypot(at.height);
        corner(self.profile.top).max(corner(self.profile.upper)).max(corner(self.profile.lower))
            + self.stock.max(0.0)
    }

    /// The depth of a point (sculptured surfaces reference 3.A). Concave in the point, with slope at most 1.
    #[inline]
    pub fn depth(&self, pose: &Pose, point: &Vec3) -> Depth {
        let from_end = point - pose.end;
        let height = from_end.dot(&pose.axis);
        let across = from_end - pose.axis * height;
        let radius = across.norm();
        let outward = if radius > 0.0 { across / radius } else { perpendicular(&pose.axis) };
        let (distance, radial, axial) = self.signed_distance(radius, height);
        Depth { value: self.stock - distance, ascent: -(outward * radial + pose.axis * axial) }
    }

    /// The depth behind each of the lower, upper and top face alone, continued without end. Each is concave and never
    /// less than [`Tool::depth`]; near the places where two faces are equally near, two of them bound it closely.
    pub fn depths_behind_faces(&self, pose: &Pose, point: &Vec3) -> [Depth; 3] {
        let from_end = point - pose.end;
        let height = from_end.dot(&pose.axis);
        let across = from_end - pose.axis * height;
        let radius = across.norm();
        let outward = if radius > 0.0 { across / radius } else { perpendicular(&pose.axis) };
        self.faces.map(|face| Depth {
            value: self.stock + face.offset - face.radial * radius - face.axial * height,
            ascent: -(outward * face.radial + pose.axis * face.axial),
        })
    }

    /// The arc of the corner, where a point is beside it.
    #[inline]
    pub(crate) fn round(&self, pose: &Pose, point: &Vec3) -> Option<Round> {
        let Profile { center, arc, .. } = self.profile;
        if arc <= 0.0 {
            return None;
        }
        let from_end = point - pose.end;
        let height = from_end.dot(&pose.axis);
        let across = from_end - pose.axis * height;
        let radius = across.norm();
        let outward = if radius > 0.0 { across / radius } else { perpendicular(&pose.axis) };
        let (x, z) = (radius - center.radius, height - center.height);
        let distance = (x * x + z * z).sqrt();
        if distance <= 0.0 {
            return None;
        }
        let (sine, cosine) = (x / distance, -z / distance);
        Some(Round {
            depth: self.stock + arc - distance,
            distance,
            normal: outward * sine - pose.axis * cosine,
            across: outward * cosine + pose.axis * sine,
            out: outward.cross(&pose.axis),
            polar: [sine, cosine],
            ring: center.radius,
            fan: self.fan,
        })
    }

    /// Signed distance from the profile, positive outside, with its gradient.
    #[inline]
    fn signed_distance(&self, radius: f64, height: f64) -> (f64, f64, f64) {
        let mut inside = (f64::NEG_INFINITY, 0.0, 1.0);
        for face in &self.faces {
            let value = face.radial * radius + face.axial * height - face.offset;
            if value > inside.0 {
                inside = (value, face.radial, face.axial);
            }
        }
        if let Some(arc) = self.arc_distance(radius, height) {
            // Beside the arc nothing of the outline is as near to what is outside.
            if arc.0 > 0.0 {
                return arc;
            }
            if arc.0 > inside.0 {
                inside = arc;
            }
        }
        if inside.0 <= 0.0 {
            return inside;
        }
        let Profile { lower, upper, top, .. } = self.profile;
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let axis_top = ProfilePoint { radius: 0.0, height: top.height };
        let mut best = (f64::INFINITY, inside.1, inside.2);
        for (a, b) in [(tip, lower), (upper, top), (top, axis_top)] {
            let (dx, dz) = (b.radius - a.radius, b.height - a.height);
            let square = dx * dx + dz * dz;
            let along = (radius - a.radius) * dx + (height - a.height) * dz;
            let t = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
            let (x, z) = (radius - a.radius - t * dx, height - a.height - t * dz);
            let distance = (x * x + z * z).sqrt();
            if distance < best.0 {
                // On the profile itself the face says the direction.
                best = if distance > f64::MIN_POSITIVE {
                    (distance, x / distance, z / distance)
                } else {
                    (0.0, inside.1, inside.2)
                };
            }
        }
        best
    }

    /// Signed distance from the corner arc for a point within its fan of normals.
    #[inline]
    fn arc_distance(&self, radius: f64, height: f64) -> Option<(f64, f64, f64)> {
        let Profile { center, arc, .. } = self.profile;
        if arc <= 0.0 {
            return None;
        }
        let (x, z) = (radius - center.radius, height - center.height);
        // The fan is less than half a turn wide.
        let [[first_sine, first_cosine], [last_sine, last_cosine]] = self.fan;
        if x * first_cosine + z * first_sine < 0.0 || x * last_cosine + z * last_sine > 0.0 {
            return None;
        }
        let distance = (x * x + z * z).sqrt();
        (distance > 0.0).then(|| (distance - arc, x / distance, z / distance))
    }

    /// The tool end when the tool touches the point `contact`, of a surface whose unit normal towards the tool is
    /// `normal`, at the distance `offset` from it (stock and tolerance). All parts of the profile take part: lines,
    /// corner arc and the vertices between them. `sideways` settles where a flat bottom touches: the direction from the
    /// contact to the axis, used only where the normal lies along the axis.
    ///
    /// # Errors
    /// [`NoPlaceOnTool`] where the surface hangs over.
    pub fn end_at_contact(
        &self,
        contact: &Vec3,
        normal: &Vec3,
        axis: &Vec3,
        offset: f64,
        sideways: &Vec3,
    ) -> Result<Vec3, NoPlaceOnTool> {
        let along = normal.dot(axis);
        let across = normal - axis * along;
        let sine = across.norm();
        let greatest = std::f64::consts::FRAC_PI_2 - self.upper_lean;
        let polar = sine.atan2(along);
        if polar > greatest + POLAR_SLACK {
            return Err(NoPlaceOnTool { polar, greatest });
        }
        let (place, towards_axis) = if sine <= ALONG_AXIS_SINE {
            let flat = sideways - axis * sideways.dot(axis);
            let lower = self.profile.lower;
            // On a pointed bottom the tip touches, on a flat one its rim.
            let place =
                if self.faces[0].radial > 0.0 { ProfilePoint { radius: 0.0, height: 0.0 } } else { lower };
            (place, flat.try_normalize(0.0).unwrap_or_else(|| perpendicular(axis)))
        } else {
            // A line of the profile along the surface touches all along; the vertex nearer to the knee stands for it.
            (self.profile.support(sine, -along).1, across / sine)
        };
        Ok(contact + normal * offset + towards_axis * place.radius - axis * place.height)
    }

    /// Distance of the tool from the plane through `point` with the unit normal `normal` towards the tool, negative
    /// where the tool reaches through it. Stock is not counted.
    pub fn gap_to_plane(&self, pose: &Pose, point: &Vec3, normal: &Vec3) -> f64 {
        let along = normal.dot(&pose.axis);
        let sine = (normal - pose.axis * along).norm();
        (pose.end - point).dot(normal) - self.profile.support(sine, -along).0
    }
}

/// A unit vector across `axis`, the same for the same axis.
pub fn perpendicular(axis: &Vec3) -> Vec3 {
    let other = if axis.x.abs() <= axis.y.abs() && axis.x.abs() <= axis.z.abs() {
        Vec3::x()
    } else if axis.y.abs() <= axis.z.abs() {
        Vec3::y()
    } else {
        Vec3::z()
    };
    axis.cross(&other).normalize()
}

#[cfg(test)]
mod tests {
    use apt_geometry::cutter::Cutter;
    use proptest::prelude::*;

    use super::*;

    /// The closed form of reference 3.A for simple cutters.
    fn closed_form(big: f64, r: f64, length: f64, radius: f64, h: f64) -> f64 {
        let e = big - r;
        if radius > e && h < r {
            r - (radius - e).hypot(r - h)
        } else if radius <= big && (0.0..=length).contains(&h) {
            (big - radius).min(h).min(length - h)
        } else {
            -(radius - big).max(0.0).hypot((-h).max(h - length).max(0.0))
        }
    }

    fn simple(big: f64, r: f64, length: f64) -> Tool {
        let numbers = [2.0 * big, r, big - r, r, 0.0, 0.0, length];
        Tool::new(&Cutter::from_numbers(&numbers, 1.0).unwrap(), 0.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn depth_is_the_closed_form(
            big in 1.0..5.0, part in 0.0..1.0f64, x in -8.0..8.0, y in -8.0..8.0, z in -4.0..25.0,
        ) {
            let r = if part < 0.1 { 0.0 } else { part * big };
            let tool = simple(big, r, 20.0);
            let pose = Pose { end: Vec3::zeros(), axis: Vec3::z() };
            let found = tool.depth(&pose, &Vec3::new(x, y, z)).value;
            let expected = closed_form(big, r, 20.0, x.hypot(y), z);
            prop_assert!((found - expected).abs() < 1e-9, "{found} against {expected}");
        }

        #[test]
        fn the_ascent_bounds_the_depth_everywhere(
            numbers in prop::sample::select(vec![
                vec![6.0], vec![6.0, 3.0], vec![6.0, 1.0], vec![1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0],
            ]),
            p in prop::array::uniform3(-6.0..6.0f64), q in prop::array::uniform3(-6.0..6.0f64),
            lean in prop::array::uniform2(-1.0..1.0f64),
        ) {
            let tool = Tool::new(&Cutter::from_numbers(&numbers, 1.0).unwrap(), 0.1);
            let pose = Pose { end: Vec3::new(0.3, -0.2, 0.1), axis: Vec3::new(lean[0], lean[1], 1.0).normalize() };
            let (p, q) = (Vec3::from(p), Vec3::from(q));
            let (at_p, at_q) = (tool.depth(&pose, &p), tool.depth(&pose, &q));
            prop_assert!(at_q.value <= at_p.value + at_p.ascent.dot(&(q - p)) + 1e-9);
            prop_assert!((at_p.ascent.norm() - 1.0).abs() < 1e-9);
        }

        #[test]
        fn a_tool_placed_at_a_contact_touches_it(
            numbers in prop::sample::select(vec![
                vec![6.0], vec![6.0, 3.0], vec![6.0, 1.0], vec![1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0],
                vec![2.0, 0.0, 0.0, 0.0, 20.0, 0.0, 5.0],
            ]),
            n in prop::array::uniform2(-3.0..3.0f64), lean in prop::array::uniform2(-0.3..0.3f64), offset in 0.0..0.2f64,
        ) {
            let tool = Tool::new(&Cutter::from_numbers(&numbers, 1.0).unwrap(), 0.0);
            let normal = Vec3::new(n[0], n[1], 1.0).normalize();
            let axis = Vec3::new(lean[0], lean[1], 1.0).normalize();
            let contact = Vec3::new(1.0, 2.0, 3.0);
            if let Ok(end) = tool.end_at_contact(&contact, &normal, &axis, offset, &Vec3::x()) {
                let pose = Pose { end, axis };
                prop_assert!((tool.depth(&pose, &contact).value + offset).abs() < 1e-9);
                // Nothing of the tool is nearer to the tangent plane.
                prop_assert!((tool.gap_to_plane(&pose, &contact, &normal) - offset).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_wall_that_hangs_over_has_no_place_on_the_tool() {
        let error = simple(3.0, 1.0, 20.0)
            .end_at_contact(
                &Vec3::zeros(),
                &Vec3::new(1.0, 0.0, -0.2).normalize(),
                &Vec3::z(),
                0.0,
                &Vec3::x(),
            )
            .unwrap_err();
        assert!(error.polar > error.greatest);
    }

    #[test]
    fn a_flat_bottom_touches_with_its_rim_on_the_side_given() {
        let end = simple(3.0, 1.0, 20.0)
            .end_at_contact(&Vec3::zeros(), &Vec3::z(), &Vec3::z(), 0.5, &Vec3::new(-1.0, 0.0, 0.0))
            .unwrap();
        assert!((end - Vec3::new(-2.0, 0.0, 0.5)).norm() < 1e-12);
    }
}

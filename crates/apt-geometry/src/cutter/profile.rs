//! The profile of a cutter in the half-plane (ρ, z): ρ from the tool axis, z above the tool end.

use super::Cutter;

/// Distance from the profile, relative to its size, up to which a point is on it.
const NEARLY_ON: f64 = 1e-7;

/// A point of the profile: distance from the axis and height above the tool end, program units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// Distance from the tool axis.
    pub radius: f64,
    /// Height above the tool end.
    pub height: f64,
}

/// Where the corner circle meets the two lines of the profile.
#[derive(Debug, Clone, Copy)]
pub(super) struct CornerLines {
    /// Distance of the corner centre from the lower line, positive inside the body.
    pub(super) lower_distance: f64,
    /// Distance from the tip, along the lower line, of the outer crossing.
    pub(super) lower_along: f64,
    /// Distance of the corner centre from the upper line, positive inside the body.
    pub(super) upper_distance: f64,
    /// Distance from the knee, along the upper line, of the lower crossing.
    pub(super) upper_along: f64,
}

/// The convex profile: tip, lower edge `A`, corner arc, upper edge `B`, top edge (arelem reference 1.3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// End of the lower line (`Aₚ`).
    pub lower: ProfilePoint,
    /// Start of the upper line (`Bₚ`).
    pub upper: ProfilePoint,
    /// End of the upper line.
    pub top: ProfilePoint,
    /// Centre of the corner arc; meaningful when `arc` is positive.
    pub center: ProfilePoint,
    /// Radius of the corner arc; zero for a sharp corner.
    pub arc: f64,
    /// Polar angles of the arc's outward normals from straight down, at `lower` and at `upper`, radians.
    pub fan: [f64; 2],
}

/// Of a corner arc that reaches the axis above the tip (APT III 415), the polar angle of its normal where the straight line from the
/// tip touches it: the support function counts the tip, so that the body is the least convex one that has tip and arc. `None` where
/// the tip is not outside of the circle.
fn tangent_from_tip(center: ProfilePoint, arc: f64) -> Option<f64> {
    // The line has the normal (sin θ, −cos θ) for which the circle goes as far as the tip: e sin θ − f cos θ + r = 0.
    let away = center.radius.hypot(center.height);
    (away > arc).then(|| (-center.radius).atan2(center.height) + (arc / away).acos())
}

impl Profile {
    pub(super) fn corner_lines(cutter: &Cutter) -> CornerLines {
        let (sa, ca) = cutter.alpha.sin_cos();
        let (sb, cb) = cutter.beta.sin_cos();
        let Cutter { corner_radius: r, corner_offset: e, corner_height: f, .. } = *cutter;
        let (kx, kz) = (cutter.radius(), cutter.knee_height());
        let lower_distance = f * ca - e * sa;
        let upper_distance = (kx - e) * cb + (f - kz) * sb;
        // A tangent arc may miss the line by rounding: the root is then zero.
        let chord = |distance: f64| (r * r - distance * distance).max(0.0).sqrt();
        CornerLines {
            lower_distance,
            lower_along: e * ca + f * sa + chord(lower_distance),
            upper_distance,
            upper_along: (e - kx) * sb + (f - kz) * cb - chord(upper_distance),
        }
    }

    pub(super) fn new(cutter: &Cutter) -> Self {
        let (sa, ca) = cutter.alpha.sin_cos();
        let (sb, cb) = cutter.beta.sin_cos();
        let (e, f, r) = (cutter.corner_offset, cutter.corner_height, cutter.corner_radius);
        let knee = ProfilePoint { radius: cutter.radius(), height: cutter.knee_height() };
        let top = ProfilePoint { radius: cutter.top_radius(), height: cutter.height.max(knee.height) };
        let sharp = r <= 0.0 || (e - knee.radius).hypot(f - knee.height) <= r * (1.0 - 1e-12);
        if sharp {
            let normal = cutter.alpha;
            return Self { lower: knee, upper: knee, top, center: knee, arc: 0.0, fan: [normal, normal] };
        }
        let lines = Self::corner_lines(cutter);
        let along_up = lines.upper_along.max(0.0);
        let upper = ProfilePoint { radius: knee.radius + along_up * sb, height: knee.height + along_up * cb };
        let upper = if upper.height > top.height { top } else { upper };
        let polar = |p: ProfilePoint| (p.radius - e).atan2(f - p.height);
        let last = polar(upper);
        let center = ProfilePoint { radius: e, height: f };
        let reaches_axis = lines.lower_along < 0.0 && e < 0.0;
        if reaches_axis && let Some(first) = tangent_from_tip(center, r) {
            if first >= last {
                let normal = upper.height.atan2(upper.radius);
                return Self { lower: upper, upper, top, center: upper, arc: 0.0, fan: [normal, normal] };
            }
            let (sin, cos) = first.sin_cos();
            let lower = ProfilePoint { radius: e + r * sin, height: f - r * cos };
            return Self { lower, upper, top, center, arc: r, fan: [first, last] };
        }
        let along_low = lines.lower_along.max(0.0);
        let lower = ProfilePoint { radius: along_low * ca, height: along_low * sa };
        Self { lower, upper, top, center, arc: r, fan: [polar(lower), last] }
    }

    /// Whether the centre of the corner arc is beyond the axis: a barrel or a lens. The corner is then no ring of balls that the body
    /// holds. It is what all these balls have in common: each of them holds all of the corner.
    pub fn is_barrel(&self) -> bool {
        self.arc > 0.0 && self.center.radius < 0.0
    }

    /// Where the tangents at both ends of the corner arc meet: the arc lies in the triangle of that place and its ends. The centre where
    /// there is no arc.
    pub fn beyond_corner(&self) -> ProfilePoint {
        let [first, last] = self.fan;
        let (sin, cos) = (0.5 * (first + last)).sin_cos();
        let away = self.arc / (0.5 * (last - first)).cos();
        ProfilePoint { radius: self.center.radius + away * sin, height: self.center.height - away * cos }
    }

    /// About how high contact with the corner is seen from on the axis: as the centre of its arc, or as the arc of a barrel, whose
    /// centre may be anywhere.
    pub fn corner_height(&self) -> f64 {
        if self.is_barrel() { 0.5 * (self.lower.height + self.upper.height) } else { self.center.height }
    }

    /// The angle of the lower line from the plane across the axis, radians: greater than that of the cutter where its arc reaches the axis.
    pub fn bottom_angle(&self) -> f64 {
        self.lower.height.atan2(self.lower.radius)
    }

    /// Support function `max (s ρ + c z)` over the profile, for `s ≥ 0`, and the point that attains it.
    pub fn support(&self, s: f64, c: f64) -> (f64, ProfilePoint) {
        let mut best = (0.0, ProfilePoint { radius: 0.0, height: 0.0 });
        for point in [self.lower, self.upper, self.top, ProfilePoint { radius: 0.0, height: self.top.height }]
        {
            let value = s * point.radius + c * point.height;
            if value > best.0 {
                best = (value, point);
            }
        }
        let norm = (s * s + c * c).sqrt();
        if self.arc > 0.0 && norm > 0.0 && self.is_in_fan(s, c) {
            let value = s * self.center.radius + c * self.center.height + self.arc * norm;
            if value > best.0 {
                let radius = self.center.radius + self.arc * s / norm;
                let height = self.center.height + self.arc * c / norm;
                best = (value, ProfilePoint { radius, height });
            }
        }
        best
    }

    /// True if a direction is one of the arc's outward normals: between those to its ends, which are less than half a turn
    /// apart.
    fn is_in_fan(&self, s: f64, c: f64) -> bool {
        let to = |end: &ProfilePoint| (end.radius - self.center.radius, end.height - self.center.height);
        let ((ls, lc), (us, uc)) = (to(&self.lower), to(&self.upper));
        ls * c - lc * s >= 0.0 && s * uc - c * us >= 0.0 && s * (ls + us) + c * (lc + uc) > 0.0
    }

    /// Greatest distance of the profile from the tool axis.
    pub fn greatest_radius(&self) -> f64 {
        self.support(1.0, 0.0).0
    }

    /// Signed distance of the point (ρ, z), ρ ≥ 0, from the solid tool (positive outside) and its nearest point on
    /// the profile.
    pub fn distance(&self, radius: f64, height: f64) -> (f64, ProfilePoint) {
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let axis_top = ProfilePoint { radius: 0.0, height: self.top.height };
        let mut best = (f64::INFINITY, tip);
        let mut take = |point: ProfilePoint| {
            let (x, z) = (radius - point.radius, height - point.height);
            let square = x * x + z * z;
            if square < best.0 {
                best = (square, point);
            }
        };
        // Neither a disk nor a line has an inside.
        let mut inside = self.top.height > 0.0 && self.upper.radius.max(self.top.radius) > 0.0;
        for (a, b) in [(tip, self.lower), (self.upper, self.top), (self.top, axis_top)] {
            let (dx, dz) = (b.radius - a.radius, b.height - a.height);
            let square = dx * dx + dz * dz;
            if square <= 0.0 {
                take(a);
                continue;
            }
            let t = ((radius - a.radius) * dx + (height - a.height) * dz) / square;
            let t01 = t.clamp(0.0, 1.0);
            take(ProfilePoint { radius: a.radius + t01 * dx, height: a.height + t01 * dz });
            // Outward normal of a counter-clockwise edge is (dz, -dx).
            inside &= (radius - a.radius) * dz - (height - a.height) * dx <= 0.0;
        }
        if self.arc > 0.0 {
            let (x, z) = (radius - self.center.radius, height - self.center.height);
            let rho = (x * x + z * z).sqrt();
            if self.is_in_fan(x, z) {
                let k = self.arc / rho;
                take(ProfilePoint { radius: self.center.radius + k * x, height: self.center.height + k * z });
            }
            // Beyond the chord of the arc, the arc decides.
            let (dx, dz) = (self.upper.radius - self.lower.radius, self.upper.height - self.lower.height);
            if (radius - self.lower.radius) * dz - (height - self.lower.height) * dx > 0.0 {
                inside &= rho <= self.arc;
            }
        }
        let distance = best.0.sqrt();
        (if inside { -distance } else { distance }, best.1)
    }

    /// Whether a place so far from the profile is beside it, in a direction that is more than rounding.
    pub fn is_beside(&self, distance: f64) -> bool {
        distance.abs() > NEARLY_ON * (self.greatest_radius() + self.top.height)
    }

    /// Signed distance of the point (ρ, z), ρ ≥ 0, from the solid tool (positive outside), and a unit direction in which it grows
    /// by no less than along any straight line: the convex function of the distance is nowhere below its tangent there.
    pub fn outward(&self, radius: f64, height: f64) -> (f64, [f64; 2]) {
        let (distance, nearest) = self.distance(radius, height);
        let away = [radius - nearest.radius, height - nearest.height];
        let length = away[0].hypot(away[1]);
        if self.is_beside(length) {
            let sense = distance.signum() / length;
            return (distance, away.map(|x| x * sense));
        }
        // On the boundary the piece that the point is farthest out from tells the direction.
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let axis_top = ProfilePoint { radius: 0.0, height: self.top.height };
        let mut best = (f64::NEG_INFINITY, [0.0, -1.0]);
        for (a, b) in [(tip, self.lower), (self.upper, self.top), (self.top, axis_top)] {
            let (dx, dz) = (b.radius - a.radius, b.height - a.height);
            let size = dx.hypot(dz);
            let out = ((radius - a.radius) * dz - (height - a.height) * dx) / size;
            if size > 0.0 && out > best.0 {
                best = (out, [dz / size, -dx / size]);
            }
        }
        let (x, z) = (radius - self.center.radius, height - self.center.height);
        let rho = x.hypot(z);
        if self.arc > 0.0 && rho - self.arc > best.0 && self.is_in_fan(x, z) {
            best = (rho - self.arc, [x / rho, z / rho]);
        }
        // Off a corner it is farther out along the way from that than beyond either piece; a way that rounding turns leaves less.
        if distance > 0.0 && length > 0.0 {
            let way = away.map(|x| x / length);
            let beyond = way[0] * radius + way[1] * height - self.support(way[0].abs(), way[1]).0;
            if beyond > best.0 {
                best = (beyond, way);
            }
        }
        (distance, best.1)
    }

    /// Greatest distance of the point (ρ, z), ρ ≥ 0, from the solid tool and the farthest profile point; that point
    /// lies on the other side of the axis, so its radius is returned as a positive number measured there.
    pub fn greatest_distance(&self, radius: f64, height: f64) -> (f64, ProfilePoint) {
        let mut best = (0.0, ProfilePoint { radius: 0.0, height: 0.0 });
        let mut take = |point: ProfilePoint| {
            let (x, z) = (radius + point.radius, height - point.height);
            let square = x * x + z * z;
            if square > best.0 {
                best = (square, point);
            }
        };
        take(ProfilePoint { radius: 0.0, height: 0.0 });
        take(self.lower);
        take(self.upper);
        take(self.top);
        if self.arc > 0.0 {
            let (x, z) = (self.center.radius + radius, self.center.height - height);
            if self.is_in_fan(x, z) {
                let k = self.arc / (x * x + z * z).sqrt();
                take(ProfilePoint { radius: self.center.radius + k * x, height: self.center.height + k * z });
            }
        }
        (best.0.sqrt(), best.1)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn cutter(numbers: &[f64]) -> Cutter {
        Cutter::from_numbers(numbers, 1.0).expect("legal cutter")
    }

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-9, "found {found}, expected {expected}");
    }

    #[test]
    fn w14_w15_seven_parameter_profile() {
        let profile = cutter(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0]).profile();
        near(profile.lower.radius, 0.454976356);
        near(profile.lower.height, 0.080224607);
        near(profile.upper.radius, 0.505839572);
        near(profile.upper.height, 0.154910100);
        near(profile.top.radius, 0.667264021);
        near(profile.top.height, 2.0);
        near(profile.fan[0].sin(), 0.666540565);
        near(-profile.fan[0].cos(), -0.745468762);
        near(profile.fan[1].sin(), 0.937811049);
        near(-profile.fan[1].cos(), -0.347146131);
    }

    #[test]
    fn w16_bull_nose() {
        let profile = cutter(&[1.0, 0.125]).profile();
        near(profile.lower.radius, 0.375);
        near(profile.lower.height, 0.0);
        near(profile.upper.radius, 0.5);
        near(profile.upper.height, 0.125);
    }

    /// What is on the axis below the tool or above it is outside of it, also of a tool that is nothing but its axis.
    #[test]
    fn what_is_on_the_axis_beyond_either_end_is_outside() {
        let line = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.5];
        let point = [0.0];
        let drill = [1.0, 0.0, 0.5, 0.5, 45.0, 0.0, 2.5];
        let needle = [0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 2.5];
        for numbers in [&line[..], &point, &drill, &needle, &[1.0, 0.5], &[1.0, 0.0]] {
            let profile = cutter(numbers).profile();
            for beyond in [0.5, 7.0] {
                near(profile.distance(0.0, -beyond).0, beyond);
                near(profile.distance(0.0, profile.top.height + beyond).0, beyond);
            }
        }
    }

    #[test]
    fn w17_plane_heights() {
        let profile = cutter(&[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0]).profile();
        for (slope, expected) in [(0.05, 0.0), (0.3, 0.056268300), (1.0, 0.375165043), (3.0, 1.362608615)] {
            // Plane z = -k x: unit normal (k, 0, 1)/√(1+k²); height = H(s, -c)/c.
            let norm = f64::hypot(1.0, slope);
            let height = profile.support(slope / norm, -1.0 / norm).0 * norm;
            near(height, expected);
        }
    }

    /// A body that passes a place with its corner, as near as rounding hardly tells, would else seem to be as deep as it is beyond the
    /// corner's pieces.
    #[test]
    fn just_off_a_corner_the_distance_grows_away_from_it() {
        let profile = cutter(&[1.0, 0.125, 0.375, 0.125, 0.0, 0.0, 2.0]).profile();
        let ProfilePoint { radius, height } = profile.top;
        let (distance, [wide, high]) = profile.outward(radius + 3e-8, height + 4e-8);
        assert!((distance - 5e-8).abs() < 1e-14, "{distance}");
        assert!((wide - 0.6).abs() < 1e-6 && (high - 0.8).abs() < 1e-6, "{wide} {high}");
        for (beside, square) in [([radius + 5e-8, 1.0], [1.0, 0.0]), ([0.2, height + 5e-8], [0.0, 1.0])] {
            assert_eq!(profile.outward(beside[0], beside[1]).1, square);
        }
    }

    /// A corner with its centre beyond the axis, and one whose arc reaches the axis above the tip.
    const BARREL: [f64; 7] = [1.0, 3.0, -2.5, 1.5, 0.0, 0.0, 3.0];
    const TO_THE_AXIS: [f64; 7] = [1.0, 3.0, -2.5, 2.9, 0.0, 0.0, 4.0];

    #[test]
    fn an_arc_that_reaches_the_axis_is_touched_from_the_tip() {
        let profile = cutter(&TO_THE_AXIS).profile();
        // Square to the radius there, and on the circle.
        let ProfilePoint { radius, height } = profile.lower;
        near(radius * (radius + 2.5) + height * (height - 2.9), 0.0);
        near((radius + 2.5).hypot(height - 2.9), 3.0);
        assert!(profile.is_barrel() && (profile.bottom_angle() - profile.fan[0]).abs() < 1e-12);
        // Where the flank begins before that the tip sees none of the arc.
        let hidden = cutter(&[1.0, 3.0, -2.4, 2.9, 0.0, 0.0, 6.0]).profile();
        assert!(
            hidden.arc == 0.0 && hidden.lower == hidden.upper && hidden.lower.radius == 0.5,
            "{hidden:?}"
        );
    }

    fn dense(profile: &Profile) -> Vec<ProfilePoint> {
        let tip = ProfilePoint { radius: 0.0, height: 0.0 };
        let mut points = vec![tip, profile.lower, profile.upper, profile.top];
        for k in 0..=200 {
            let t = f64::from(k) / 200.0;
            points.push(ProfilePoint { radius: t * profile.lower.radius, height: t * profile.lower.height });
            points.push(ProfilePoint {
                radius: profile.upper.radius + t * (profile.top.radius - profile.upper.radius),
                height: profile.upper.height + t * (profile.top.height - profile.upper.height),
            });
            if profile.arc > 0.0 {
                let polar = profile.fan[0] + t * (profile.fan[1] - profile.fan[0]);
                points.push(ProfilePoint {
                    radius: profile.center.radius + profile.arc * polar.sin(),
                    height: profile.center.height - profile.arc * polar.cos(),
                });
            }
        }
        points
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn support_bounds_the_dense_profile(polar in 0.0..std::f64::consts::PI, which in 0usize..6) {
            let shapes: [&[f64]; 6] = [
                &[1.0],
                &[1.0, 0.125],
                &[1.0, 0.5],
                &[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0],
                &BARREL,
                &TO_THE_AXIS,
            ];
            let profile = cutter(shapes[which]).profile();
            let (s, c) = (polar.sin(), -polar.cos());
            let (value, point) = profile.support(s, c);
            let sampled = dense(&profile).iter().map(|p| s * p.radius + c * p.height).fold(f64::MIN, f64::max);
            prop_assert!(value >= sampled - 1e-12);
            prop_assert!((s * point.radius + c * point.height - value).abs() < 1e-12);
        }

        #[test]
        fn distances_match_the_dense_profile(radius in 0.0..3.0, height in -1.5..1.9, which in 0usize..5) {
            let shapes: [&[f64]; 5] = [
                &[1.0, 0.125, 0.375, 0.125, 0.0, 0.0, 2.0],
                &[1.0, 0.5],
                &[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0],
                &BARREL,
                &TO_THE_AXIS,
            ];
            let profile = cutter(shapes[which]).profile();
            let (value, _) = profile.distance(radius, height);
            let points = dense(&profile);
            let nearest = points.iter().map(|p| (radius - p.radius).hypot(height - p.height)).fold(f64::MAX, f64::min);
            if value > 0.0 {
                prop_assert!((nearest - value).abs() < 0.02, "{value} against {nearest}");
            } else {
                prop_assert!(-value <= nearest + 1e-9);
            }
            let farthest = points.iter().map(|p| (radius + p.radius).hypot(height - p.height)).fold(0.0, f64::max);
            prop_assert!((profile.greatest_distance(radius, height).0 - farthest).abs() < 1e-4);
        }
    }
}

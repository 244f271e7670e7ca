//! The verifier's own model of the seven-parameter cutter: a convex body of revolution, derived here from the seven
//! numbers alone (arelem reference 1.3).
//!
//! The meridian is tip – lower line – corner arc – upper line – top, in the half-plane (ρ, z) of distance from the axis
//! and height above the tool end. The disc at the top closes the body where inside and outside are told apart; nothing
//! touches it (arelem reference 1.3).

use apt_geometry::{Vec3, cutter::Cutter, patience::Patience};

use super::VerifyError;

/// How far, relative to the cutter's size, a corner circle may miss a line it should touch: APT III accepts
/// corner centres written with five decimals (language reference 6.7).
const TANGENCY_SLACK: f64 = 1e-5;
/// How far from the tool axis a place is, relative to its distance from the tool end, where rounding leaves nothing of its direction from
/// the axis, and where it leaves something of the axis in it.
const ON_AXIS: f64 = 1e-14;
const NEAR_AXIS: f64 = 1e-3;
/// Share of the cutter's size that is rounding of where its lines are.
const ROUNDING: f64 = 1e-14;
/// Sine of the angle to a plane below which a straight piece lies along it: what is known of a direction to a surface.
const SQUARE: f64 = 1e-9;

/// A point of the meridian half-plane: distance from the axis, height above the tool end.
pub(super) type Meridian = [f64; 2];

/// The meridian of a cutter.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Profile {
    /// Where the lower line meets the corner arc.
    lower: Meridian,
    /// Where the corner arc meets the upper line.
    upper: Meridian,
    /// Where the upper line ends.
    top: Meridian,
    /// Centre of the corner arc.
    center: Meridian,
    /// Radius of the corner arc; zero if there is no arc (then `lower == upper`).
    radius: f64,
}

fn sub(a: Meridian, b: Meridian) -> Meridian {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Meridian, b: Meridian) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: Meridian, b: Meridian) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// The point of segment `a`–`b` nearest to `p`.
fn nearest_on_segment(p: Meridian, a: Meridian, b: Meridian) -> Meridian {
    let along = sub(b, a);
    let length = dot(along, along);
    let t = if length > 0.0 { (dot(sub(p, a), along) / length).clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + t * along[0], a[1] + t * along[1]]
}

impl Profile {
    /// The meridian of the seven numbers.
    ///
    /// # Errors
    /// [`VerifyError::Cutter`] when the numbers are not finite or describe no convex body.
    pub(super) fn of(cutter: &Cutter) -> Result<Self, VerifyError> {
        let Cutter { diameter, corner_radius: r, corner_offset: e, corner_height: f, alpha, beta, height } =
            *cutter;
        // The centre of the corner may be beyond the axis, and then it is as high as one likes.
        let (sizes, middle) = ([diameter, r, alpha, beta, height], [e, f]);
        let half = std::f64::consts::FRAC_PI_2;
        let are_finite = sizes.iter().chain(&middle).all(|x| x.is_finite());
        if !are_finite || sizes.iter().any(|x| *x < 0.0) || alpha + beta >= half {
            return Err(VerifyError::Cutter);
        }
        let slack = TANGENCY_SLACK * diameter.max(height).max(r);
        let along_lower = [alpha.cos(), alpha.sin()];
        let along_upper = [beta.sin(), beta.cos()];
        let knee = [diameter / 2.0, diameter / 2.0 * alpha.tan()];
        let top = [knee[0] + (height - knee[1]).max(0.0) * beta.tan(), height.max(knee[1])];
        let center = [e, f];
        let from_knee = sub(center, knee);
        if r <= 0.0 || dot(from_knee, from_knee).sqrt() < r - slack {
            return Ok(Self { lower: knee, upper: knee, top, center: knee, radius: 0.0 });
        }
        // Squared half chords that the corner circle cuts out of the two lines.
        let lower_half = r * r - cross(along_lower, center).powi(2);
        let upper_half = r * r - cross(along_upper, from_knee).powi(2);
        if lower_half < -2.0 * r * slack || upper_half < -2.0 * r * slack {
            return Err(VerifyError::Cutter);
        }
        let s = dot(center, along_lower) + lower_half.max(0.0).sqrt();
        let t = dot(from_knee, along_upper) - upper_half.max(0.0).sqrt();
        let upper = [knee[0] + t * along_upper[0], knee[1] + t * along_upper[1]];
        let lower = match Self::touched_from_tip(center, r).filter(|_| s < 0.0 && e < 0.0) {
            Some(touched) if cross(sub(touched, center), sub(upper, center)) > 0.0 => touched,
            // The tip sees none of the arc before its end.
            Some(_) => return Ok(Self { lower: upper, upper, top, center: upper, radius: 0.0 }),
            None => [s.max(0.0) * along_lower[0], s.max(0.0) * along_lower[1]],
        };
        let is_in_order = cross(sub(lower, center), sub(upper, center)) >= -r * slack;
        let is_between = s <= knee[0] / alpha.cos() + slack && t >= -slack;
        if !(is_in_order && is_between && f >= knee[1] - slack && upper[1] <= top[1] + slack) {
            return Err(VerifyError::Cutter);
        }
        Ok(Self { lower, upper, top, center, radius: r })
    }

    /// Where the straight line from the tip touches a corner circle that passes over it: an arc that reaches the axis above the tip has
    /// that line below it in the least convex body that has both. None where the tip is not outside of the circle.
    fn touched_from_tip(center: Meridian, radius: f64) -> Option<Meridian> {
        let away = dot(center, center);
        let length = (away - radius * radius).sqrt();
        let [e, f] = center;
        (length > 0.0).then(|| [length * e + radius * f, length * f - radius * e].map(|x| x * length / away))
    }

    /// The tool end alone, for ON relations.
    pub(super) fn tool_end() -> Self {
        Self { lower: [0.0; 2], upper: [0.0; 2], top: [0.0; 2], center: [0.0; 2], radius: 0.0 }
    }

    /// A disk across the axis about the tool end.
    ///
    /// # Errors
    /// [`VerifyError::Cutter`] when the radius is negative or not finite.
    pub(super) fn disk(radius: f64) -> Result<Self, VerifyError> {
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(VerifyError::Cutter);
        }
        let rim = [radius, 0.0];
        Ok(Self { lower: rim, upper: rim, top: rim, center: rim, radius: 0.0 })
    }

    /// True for the profile of a single point.
    pub(super) fn is_point(&self) -> bool {
        self.top == [0.0; 2] && self.lower == [0.0; 2] && self.radius <= 0.0
    }

    /// Greatest distance of the body from its axis.
    pub(super) fn widest(&self) -> f64 {
        self.support([1.0, 0.0]).0
    }

    /// The body up to a height above the corner.
    pub(super) fn below(&self, height: f64) -> Self {
        let share = (height - self.upper[1]) / (self.top[1] - self.upper[1]);
        if !(share > 0.0 && share < 1.0) {
            return self.clone();
        }
        let top = [self.upper[0] + share * (self.top[0] - self.upper[0]), height];
        Self { top, ..self.clone() }
    }

    /// Height of the top above the tool end.
    pub(super) fn top_height(&self) -> f64 {
        self.top[1]
    }

    /// Greatest distance of a point of the body from the tool end.
    pub(super) fn reach(&self) -> f64 {
        self.farthest([0.0, 0.0]).0
    }

    /// Vertices of the meridian that are edges of the body: lower and upper end of the corner arc, and the top.
    pub(super) fn edges(&self) -> [Meridian; 3] {
        [self.lower, self.upper, self.top]
    }

    /// Straight parts of the meridian that touch surfaces: all but the closing disc at the top.
    pub(super) fn lines(&self) -> [(Meridian, Meridian); 2] {
        [([0.0; 2], self.lower), (self.upper, self.top)]
    }

    /// The straight parts of the closed body.
    pub(super) fn closed_lines(&self) -> [(Meridian, Meridian); 3] {
        let [lower, upper] = self.lines();
        [lower, upper, ([0.0, self.top[1]], self.top)]
    }

    /// Radius of the disc at the top of a tool with a height: a surface may reach through it without being touched.
    pub(super) fn open_top(&self) -> Option<f64> {
        (self.top[1] > 0.0 && self.top[0] > 0.0).then_some(self.top[0])
    }

    /// Centre and radius of the corner arc, if there is one. In front of the axis the body holds the balls about the ring of such centres, or
    /// as much of them as its lines leave, and they hold the arc all round. Beyond the axis, of a barrel, the arc all round is what
    /// those balls have in common: each single one holds all of it.
    pub(super) fn corner(&self) -> Option<(Meridian, f64)> {
        (self.radius > 0.0).then_some((self.center, self.radius))
    }

    /// Whether the corner arc has this direction (unit, ρ ≥ 0 side) among its outward normals.
    pub(super) fn fan_holds(&self, direction: Meridian) -> bool {
        let (first, last) = (sub(self.lower, self.center), sub(self.upper, self.center));
        // Round-off of the arc ends, relative to the radius.
        let slack = -1e-12 * self.radius;
        self.radius > 0.0 && cross(first, direction) >= slack && cross(direction, last) >= slack
    }

    /// Support: greatest `direction·p` over the meridian for a direction with ρ-part ≥ 0, and the point that has it.
    pub(super) fn support(&self, direction: Meridian) -> (f64, Meridian) {
        let (value, place, _) = self.support_on(direction);
        (value, place)
    }

    /// The same with whether the place is on the corner arc.
    pub(super) fn support_on(&self, direction: Meridian) -> (f64, Meridian, bool) {
        let mut best = (0.0, [0.0; 2], false);
        for vertex in self.edges() {
            let value = dot(direction, vertex);
            if value > best.0 {
                best = (value, vertex, false);
            }
        }
        if self.fan_holds(direction) {
            let size = dot(direction, direction).sqrt();
            let value = dot(direction, self.center) + self.radius * size;
            if value > best.0 {
                let k = self.radius / size;
                let place = [self.center[0] + k * direction[0], self.center[1] + k * direction[1]];
                best = (value, place, true);
            }
        }
        best
    }

    /// Radius of a ball that the body holds and that touches it at a place of the corner arc with this unit normal: no greater than that of
    /// the arc, nor, as the body bends round its axis, than what is between the place and the axis along the normal, and no farther
    /// out than the straight parts allow.
    fn ball_within(&self, place: Meridian, normal: Meridian) -> f64 {
        let round = if self.center[0] < 0.0 { place[0] / normal[0] } else { self.radius };
        let [lower, upper] = self.lines().map(|(a, b)| (a, [b[1] - a[1], a[0] - b[0]]));
        [lower, upper, (self.top, [0.0, 1.0])].into_iter().fold(round, |ball, (at, face)| {
            let size = dot(face, face).sqrt();
            let room = dot(face, sub(at, place)) / size + ROUNDING * (self.radius + self.top[1]);
            // From the place inward by the ball, and from there outward by it.
            let reach = 1.0 - dot(face, normal) / size;
            if size > 0.0 && reach * ball > room { (room / reach).max(0.0) } else { ball }
        })
    }

    /// Signed distance of a point of the half-plane (ρ ≥ 0) to the body, negative inside, and the nearest boundary point.
    pub(super) fn signed_distance(&self, p: Meridian) -> (f64, Meridian) {
        let mut square = (f64::INFINITY, [0.0; 2]);
        for (a, b) in self.closed_lines() {
            let q = nearest_on_segment(p, a, b);
            let d = sub(p, q);
            let distance = dot(d, d);
            if distance < square.0 {
                square = (distance, q);
            }
        }
        let mut best = (square.0.sqrt(), square.1);
        if self.radius > 0.0 {
            let d = sub(p, self.center);
            let size = dot(d, d).sqrt();
            let apart = (size - self.radius).abs();
            if size > 0.0 && apart < best.0 && self.fan_holds([d[0] / size, d[1] / size]) {
                let k = self.radius / size;
                best = (apart, [self.center[0] + k * d[0], self.center[1] + k * d[1]]);
            }
        }
        if self.contains(p) { (-best.0, best.1) } else { best }
    }

    fn contains(&self, p: Meridian) -> bool {
        let left_of = |a: Meridian, b: Meridian| cross(sub(b, a), sub(p, a)) >= 0.0;
        if self.is_point() || p[1] > self.top[1] || p[1] < 0.0 {
            return false;
        }
        let lower_ok = self.lower[0] <= 0.0 || left_of([0.0; 2], self.lower);
        let upper_ok = self.top == self.upper || left_of(self.upper, self.top);
        if !lower_ok || !upper_ok || p[0] > self.widest() {
            return false;
        }
        if self.radius > 0.0 && !left_of(self.lower, self.upper) {
            let d = sub(p, self.center);
            return dot(d, d).sqrt() <= self.radius;
        }
        true
    }

    /// Directions, of any length, of the outward normals of the straight parts, and of the corner arc at a place across from it, which
    /// may be beyond the axis.
    fn faces_at(&self, p: Meridian) -> [Option<Meridian>; 3] {
        let [lower, upper] = self.lines().map(|(a, b)| Some([b[1] - a[1], a[0] - b[0]]));
        let from = sub(p, self.center);
        [lower, upper, self.fan_holds(from).then_some(from)]
    }

    /// Greatest distance from a point at azimuth 0 (ρ ≥ 0) to a point of the body, and that body point with ρ counted
    /// towards azimuth 0 (so it is ≤ 0: the far side).
    pub(super) fn farthest(&self, p: Meridian) -> (f64, Meridian) {
        let mirrored = [-p[0], p[1]];
        let mut best = (dot(p, p).sqrt(), [0.0; 2]);
        let mut offer = |q: Meridian| {
            let d = sub(q, mirrored);
            let distance = dot(d, d).sqrt();
            if distance > best.0 {
                best = (distance, q);
            }
        };
        self.edges().into_iter().for_each(&mut offer);
        if self.radius > 0.0 {
            let d = sub(self.center, mirrored);
            let size = dot(d, d).sqrt();
            if size > 0.0 && self.fan_holds([d[0] / size, d[1] / size]) {
                let k = self.radius / size;
                offer([self.center[0] + k * d[0], self.center[1] + k * d[1]]);
            }
        }
        (best.0, [-best.1[0], best.1[1]])
    }
}

/// How far a body goes in a direction, and how that changes as the direction turns.
#[derive(Debug, Clone, Copy)]
pub(super) struct TurningSupport {
    /// Greatest product of a place with the direction.
    pub(super) value: f64,
    /// The body holds a ball about this place, perhaps without radius, that goes as far.
    pub(super) center: Vec3,
    pub(super) ball: f64,
    /// How fast the place that goes farthest moves the way that the direction turns.
    pub(super) swing: f64,
}

/// A cutter with its axis in space; points are relative to the tool end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tool<'a> {
    /// The meridian.
    pub(super) profile: &'a Profile,
    /// Unit tool axis.
    pub(super) axis: Vec3,
    /// Who is asked while it is measured.
    pub(super) patience: Patience<'a>,
    /// How deep it is meant to be in a surface: stock below zero, and the band.
    pub(super) depth: f64,
}

#[cfg(test)]
thread_local! {
    /// Distances of points, and parts of surfaces, that this thread has looked at: one takes up to a microsecond.
    pub(crate) static WORK: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Counts a piece of work for the tests that say how much of it lies between two questions whether to go on.
pub(super) fn count_work() {
    #[cfg(test)]
    WORK.set(WORK.get() + 1);
}

/// Some unit vector perpendicular to a unit vector.
pub(super) fn perpendicular(axis: &Vec3) -> Vec3 {
    let least = if axis.x.abs() <= axis.y.abs() && axis.x.abs() <= axis.z.abs() {
        Vec3::x()
    } else if axis.y.abs() <= axis.z.abs() {
        Vec3::y()
    } else {
        Vec3::z()
    };
    let side = least - axis * axis.dot(&least);
    side / side.norm()
}

impl<'a> Tool<'a> {
    /// A cutter with a unit axis, measured with all the time in the world.
    #[cfg(test)]
    pub(super) fn new(profile: &'a Profile, axis: Vec3) -> Self {
        Self { profile, axis, patience: Patience::default(), depth: 0.0 }
    }

    /// The same place of the axis with another meridian.
    pub(super) fn with<'b>(&self, profile: &'b Profile) -> Tool<'b>
    where
        'a: 'b,
    {
        Tool { profile, ..*self }
    }

    /// Distance from the axis, height, and the unit radial direction of a vector from the tool end.
    pub(super) fn split(&self, w: &Vec3) -> (Meridian, Vec3) {
        let z = w.dot(&self.axis);
        let radial = w - self.axis * z;
        let rho = radial.norm();
        let away = w.norm();
        let out = if rho > NEAR_AXIS * away {
            radial / rho
        } else if rho > ON_AXIS * away {
            // What rounding leaves of the axis is no longer little beside what leads away from it.
            let out = radial / rho;
            let out = out - self.axis * self.axis.dot(&out);
            out / out.norm()
        } else {
            perpendicular(&self.axis)
        };
        ([rho, z], out)
    }

    /// A ball that holds the body with its end at a place: its centre and radius.
    pub(super) fn ball_about(&self, tip: &Vec3) -> (Vec3, f64) {
        let half = 0.5 * self.profile.top_height();
        (tip + self.axis * half, half.hypot(self.profile.widest()))
    }

    /// Greatest `n·p` over the body, and the point that has it.
    pub(super) fn support(&self, n: &Vec3) -> (f64, Vec3) {
        let (direction, out) = self.split(n);
        let (value, p) = self.profile.support(direction);
        (value, out * p[0] + self.axis * p[1])
    }

    /// The places that go farthest in a direction `n` by as much, the lowest and the highest of them: those at both ends of a straight piece square to it.
    pub(super) fn supports(&self, n: &Vec3) -> [Vec3; 2] {
        let (direction, out) = self.split(n);
        let (value, p) = self.profile.support(direction);
        let level = value - SQUARE * self.profile.reach() * dot(direction, direction).sqrt();
        let mut ends = [p; 2];
        for vertex in self.profile.edges() {
            if dot(direction, vertex) >= level {
                let [low, high] = ends.map(|end| end[1]);
                ends = if vertex[1] < low {
                    [vertex, ends[1]]
                } else if vertex[1] > high {
                    [ends[0], vertex]
                } else {
                    ends
                };
            }
        }
        ends.map(|p| out * p[0] + self.axis * p[1])
    }

    /// Where the body goes farthest in a unit direction `n`, and how that changes as it turns along a unit vector across.
    pub(super) fn turning_support(&self, n: &Vec3, along: &Vec3) -> TurningSupport {
        let (direction, out) = self.split(n);
        let (value, place, is_round) = self.profile.support_on(direction);
        let round = self.axis.cross(&out).dot(along);
        // The place that is touched goes round the axis with the radius of its circle, on the corner with that of the ring of centres, beyond
        // the axis the other way, and on the arc besides.
        let (rho, arc, ball) = if is_round {
            (self.profile.center[0], self.profile.radius, self.profile.ball_within(place, direction))
        } else {
            (place[0], 0.0, 0.0)
        };
        let swing = if rho != 0.0 && direction[0] > 0.0 { rho * round * round / direction[0] } else { 0.0 };
        let center = out * place[0] + self.axis * place[1] - n * ball;
        TurningSupport { value, center, ball, swing: swing + arc }
    }

    /// Signed distance of a point to the body (negative inside) and the nearest boundary point.
    pub(super) fn signed_distance(&self, w: &Vec3) -> (f64, Vec3) {
        let (p, out) = self.split(w);
        let (distance, q) = self.profile.signed_distance(p);
        (distance, out * q[0] + self.axis * q[1])
    }

    /// Signed distance of a point to the body, negative inside.
    pub(super) fn distance(&self, w: &Vec3) -> f64 {
        let height = w.dot(&self.axis);
        let from_axis = (w - self.axis * height).norm();
        self.profile.signed_distance([from_axis, height]).0
    }

    /// A direction without its part round the axis at the azimuth of a point (from the tool end): what an outward normal of
    /// the body there can be. None on the axis, or if nothing is left.
    pub(super) fn without_azimuth(&self, w: &Vec3, direction: &Vec3) -> Option<Vec3> {
        let round = self.axis.cross(w).try_normalize(0.0)?;
        (direction - round * round.dot(direction)).try_normalize(0.0)
    }

    /// An outward normal of the body turned round the axis to where a direction leads away from that: what it is beside another place
    /// that is as high up. None where the direction is along the axis.
    pub(super) fn turned_to(&self, outward: &Vec3, direction: &Vec3) -> Option<Vec3> {
        let up = self.axis.dot(outward);
        let radial = (direction - self.axis * self.axis.dot(direction)).try_normalize(0.0)?;
        Some(radial * (1.0 - up * up).max(0.0).sqrt() + self.axis * up)
    }

    /// Greatest distance from a point to a point of the body, and that body point.
    pub(super) fn farthest(&self, w: &Vec3) -> (f64, Vec3) {
        let (p, out) = self.split(w);
        let (distance, q) = self.profile.farthest(p);
        (distance, out * q[0] + self.axis * q[1])
    }

    /// Outward directions of the body, unit, among which is each that is stationary in how far a point (from the tool end)
    /// stands out over the body in it: away from edges and corner, and across the straight parts.
    pub(super) fn outward_at(&self, w: &Vec3) -> impl Iterator<Item = Vec3> {
        let (p, out) = self.split(w);
        let straight = self.profile.closed_lines().map(|(a, b)| [b[1] - a[1], a[0] - b[0]]);
        let round = self.knots().map(|q| sub(p, q));
        let ends = [[0.0, 1.0], [0.0, -1.0]];
        // The corner of a barrel faces a place from behind the axis, too: its centre there is on this side.
        let [e, f] = self.profile.center;
        let behind = (e < 0.0).then_some([p[0] + e, p[1] - f]);
        self.directions(straight.into_iter().chain(round).chain(ends).chain(behind), out)
    }

    /// The outward normals of the body's faces before and behind a point (from the tool end), seen from the axis, and of its top: those
    /// of straight parts, and of the corner arc where the point is across from it.
    pub(super) fn faces_about(&self, w: &Vec3) -> impl Iterator<Item = Vec3> {
        let ([rho, height], out) = self.split(w);
        let before = self.profile.faces_at([rho, height]);
        let behind = self.profile.faces_at([-rho, height]).map(|face| face.map(|m| [-m[0], m[1]]));
        let all = before.into_iter().chain(behind).flatten();
        self.directions(all.chain([[0.0, 1.0]]), out)
    }

    /// Unit directions from a point (from the tool end) among which is each to a place of the body that is farther than those
    /// beside it.
    pub(super) fn away_from(&self, w: &Vec3) -> impl Iterator<Item = Vec3> {
        let (p, out) = self.split(w);
        let both = self.knots().into_iter().flat_map(move |q| [sub(q, p), sub([-q[0], q[1]], p)]);
        self.directions(both, out)
    }

    /// Tool end, edges and centre of the corner arc.
    fn knots(&self) -> [Meridian; 5] {
        let [lower, upper, top] = self.profile.edges();
        [[0.0; 2], lower, upper, top, self.profile.center]
    }

    fn directions(&self, meridians: impl Iterator<Item = Meridian>, out: Vec3) -> impl Iterator<Item = Vec3> {
        let axis = self.axis;
        meridians.filter_map(move |m| {
            let size = dot(m, m).sqrt();
            (size > 0.0).then(|| (out * m[0] + axis * m[1]) / size)
        })
    }
}

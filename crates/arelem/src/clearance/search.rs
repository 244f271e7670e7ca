//! Clearance to any surface with a signed distance: the least distance over all pieces of the tool's boundary. Each
//! circle is scanned and every promising valley refined by Newton's method with the surface's curvature; the bottom
//! and the conical patches are looked into where their edges say that contact lies further inside.

mod along_axis;
mod on_edge;
mod patches;

pub(super) use self::along_axis::Courses;

use apt_geometry::{
    Vec3,
    surface::{Foot, Surface},
};
use nalgebra::{Matrix2, Matrix3, Vector2};

use super::{
    Contact, Enough, Shape, Tool,
    certify::{Certificate, Effort, Face, Proof, certify},
    crease::Beside,
    floor::Bases,
    memory::{ByParts, Memory, Place},
    open_top::is_entered,
    quadric::Posed,
    shape,
    tool::{Curve, Piece, Spot},
};

/// Scan points on a circle.
const SCAN: usize = 12;
/// Bound of the Newton iterations; they are bracketed or damped.
const MAX_ITERATIONS: u32 = 40;
/// An azimuth step below this (radians) ends the refinement: the clearance then errs by its square.
const ANGLE_RESOLUTION: f64 = 1e-10;
/// Bound of the searches after the first one, each from a point that was found nearer.
const MAX_RESTARTS: u32 = 12;
/// How many of these lead to what is nearest as a rule. Where they do not it is hard to find.
const FEW_RESTARTS: u32 = 2;
/// What the search may miss, as a share of the tool's size. Proofs of tolerance look for more.
pub(super) const MISSED: f64 = 1e-9;
/// How far, relative to sizes and coordinates, a distance may be from what was found near by to be the same.
const SAME: f64 = 1e-11;
/// What a foot that is looked for counts in units of work.
const WORK_OF_FOOT: u32 = 16;
/// Slack of the fan of contact normals of the corner torus, radians.
pub(super) const FAN_SLACK: f64 = 1e-9;

#[cfg(test)]
thread_local! {
    /// How often this thread has looked everywhere for a contact of which nothing is proven.
    pub(crate) static LOOKS_EVERYWHERE: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// The best contact so far.
struct Best {
    value: f64,
    contact: Option<Contact>,
    /// The piece it is on.
    piece: usize,
}

impl Best {
    fn take(&mut self, piece: usize, value: f64, contact: impl FnOnce() -> Contact) {
        if value < self.value || self.contact.is_none() {
            self.value = value;
            self.contact = Some(contact());
            self.piece = piece;
        }
    }
}

struct Search<'a> {
    tool: &'a Tool<'a>,
    surface: &'a Surface,
    side: f64,
    tip: &'a Vec3,
    best: Best,
    /// The piece looked at.
    piece: usize,
}

/// The clearance on one side, for any surface; and how much nearer than the contact another point of the tool may be.
pub(super) fn contact(
    tool: &Tool,
    face: Face<'_>,
    tip: &Vec3,
    (memory, likely): (Option<&Memory>, Option<(usize, Contact)>),
    enough: Enough,
) -> (Contact, f64) {
    if tool.patience.ends_after(WORK_OF_FOOT) {
        return (at_end(face, tip), f64::INFINITY);
    }
    let Face { surface, side } = face;
    let best = Best { value: f64::INFINITY, contact: None, piece: 0 };
    let mut search = Search { tool, surface, side, tip, best, piece: 0 };
    // Two convex bodies need no proof: what is nearest around is nearest of all.
    let unique = shape(surface, side) == Shape::Convex && !is_entered(tool, surface, side, [tip, tip]);
    let place = if unique { None } else { memory.and_then(|m| m.place(tool, side)) };
    if let Some((piece, contact)) = likely.filter(|_| !unique) {
        search.take_likely(piece, &contact);
    }
    if let Some(place) = place.filter(|_| search.best.contact.is_none()) {
        search.descend(&place.point, Some(place.piece));
    }
    if search.best.contact.is_none() {
        search.scan();
    }
    let guessed = place.is_some() || likely.is_some();

    let shown = if unique { Shown::Nearest } else { search.complete(memory, enough) };
    let is_asked = search.best.value >= enough.lowest;
    if guessed && is_asked && matches!(shown, Shown::Nothing) && !tool.patience.was_over() {
        // Nothing proves the contact near the last one: look everywhere.
        search.scan();
    }
    let Some(contact) = search.best.contact else {
        return (at_end(face, tip), f64::INFINITY);
    };
    if let (Some(memory), Shown::Within(_)) = (memory, &shown) {
        let place = Place { piece: search.best.piece, point: contact.tool - tip, start: None };
        memory.remember(tool, side, tip, place);
    }
    let missed = match shown {
        Shown::Nearest => 0.0,
        Shown::Within(missed) => missed,
        Shown::Nothing => f64::INFINITY,
    };
    (contact, missed)
}

/// Whether balls about the axis show that no point of the tool is below a level, where a flank lies along the surface at a point of it.
pub(super) fn lies_above(
    tool: &Tool,
    face: Face<'_>,
    (tip, point): (&Vec3, &Vec3),
    level: f64,
    memory: &Memory,
) -> bool {
    let Face { surface, side } = face;
    let foot = surface.foot(point);
    let clearance = side * foot.distance;
    let contact = Contact { clearance, gradient: foot.normal * side, tool: *point, surface: foot.point };
    let best = Best { value: clearance, contact: Some(contact), piece: 0 };
    let search = Search { tool, surface, side, tip, best, piece: 0 };
    search.certified_along_axis(level, &memory.courses) == Certificate::Holds
}

/// The contact that the search finds everywhere; nothing is proven of it. At an edge of the surface it is exactly there.
pub(super) fn found(tool: &Tool, face: Face<'_>, tip: &Vec3) -> Contact {
    #[cfg(test)]
    LOOKS_EVERYWHERE.set(LOOKS_EVERYWHERE.get() + 1);
    let Face { surface, side } = face;
    let best = Best { value: f64::INFINITY, contact: None, piece: 0 };
    let mut search = Search { tool, surface, side, tip, best, piece: 0 };
    search.scan();
    if let Some(touch) = search.touch_of_crease() {
        search.takes_crease(touch, MISSED * (tool.radius() + tool.profile.top.height));
    }
    search.best.contact.unwrap_or_else(|| at_end(face, tip))
}

/// The contact of the tool end.
fn at_end(Face { surface, side }: Face<'_>, tip: &Vec3) -> Contact {
    let foot = surface.foot(tip);
    Contact { clearance: side * foot.distance, gradient: foot.normal * side, tool: *tip, surface: foot.point }
}

/// What is proven of a contact.
enum Shown {
    /// It is the nearest.
    Nearest,
    /// No other is nearer by more than this.
    Within(f64),
    /// Nothing.
    Nothing,
}

impl Search<'_> {
    /// Looks everywhere.
    fn scan(&mut self) {
        let tool = self.tool;
        for (k, piece) in tool.pieces.iter().enumerate() {
            self.piece = k;
            match *piece {
                Piece::Ring { radius, height, ball, fan } => self.ring(radius, height, ball, fan),
                Piece::Disc { radius } => self.disc(radius),
                Piece::Frustum { radius, height } => self.frustum(radius, height),
                Piece::Bulge { center, arc, fan } => self.bulge(&Curve::Arc { center, arc, fan }),
            }
        }
    }

    /// Takes a contact that was found near by, if that is where it is on the surface.
    fn take_likely(&mut self, piece: usize, contact: &Contact) {
        let foot = self.surface.foot(&contact.tool);
        let size = self.tool.radius() + self.tool.profile.top.height + self.tip.amax();
        if (self.side * foot.distance - contact.clearance).abs() <= SAME * size {
            self.best.take(piece, contact.clearance, || *contact);
        }
    }

    /// Looks for places that are nearer than the nearest found, until there are none that matter.
    fn complete(&mut self, memory: Option<&Memory>, enough: Enough) -> Shown {
        let proof = memory.map(|memory| memory.proof(self.tool, self.side, self.tip));
        let mut proof = proof.unwrap_or_else(|| Proof::of_tool(self.tool));
        let known = memory.map_or_else(ByParts::default, Memory::by_parts);
        let fresh = Courses::default();
        let courses = memory.map_or(&fresh, |memory| &memory.courses);
        let (shown, by_parts) = self.complete_with(&mut proof, known, courses, enough);
        if let Some(memory) = memory {
            memory.keep_proof(self.side, proof);
            memory.show_by_parts(by_parts);
        }
        shown
    }

    /// Also what is known of how parts of the surface show it, which are tried first, after few patches of the tool, or after all.
    fn complete_with(
        &mut self,
        proof: &mut Proof,
        mut by_parts: ByParts,
        courses: &Courses,
        enough: Enough,
    ) -> (Shown, ByParts) {
        let closest = MISSED * (self.tool.radius() + self.tool.profile.top.height);
        let posed = Posed::new(self.tool, self.surface, self.side, self.tip);
        let mut slack = closest;
        for restart in 0..MAX_RESTARTS {
            let is_hard = restart >= FEW_RESTARTS;
            let asked = if is_hard {
                enough.slack_of_hard(self.best.value)
            } else {
                enough.slack_of(self.best.value)
            };
            slack = closest.max(asked);
            if self.tool.patience.was_over() {
                break;
            }
            let level = self.best.value - slack;
            if let Some(posed) = &posed
                && let Some(contact) = &self.best.contact
                && posed.clears(level, contact)
            {
                return (Shown::Within(slack), by_parts);
            }
            if self.is_on_crease(slack) {
                return (Shown::Within(slack), by_parts);
            }
            if self.best.value < enough.lowest {
                break;
            }
            // Parts of the surface that showed the last contact mostly show the next one, with hardly any that are new.
            let is_asked = by_parts.showed();
            if is_asked && self.is_clear(level) {
                return (Shown::Within(slack), by_parts);
            }
            let (found, known) = match self.certified_along_axis(level, courses) {
                Certificate::Undecided => self.certified(level, proof, by_parts, is_asked),
                Certificate::Holds if is_asked => (Certificate::Holds, by_parts.in_vain()),
                found => (found, by_parts),
            };
            by_parts = known;
            match found {
                Certificate::Lower(point) => {
                    self.best.take(self.best.piece, point.clearance, || point);
                    self.descend(&(point.tool - self.tip), None);
                }
                Certificate::Holds => return (Shown::Within(slack), by_parts),
                Certificate::Undecided if !is_asked && self.is_clear(level) => {
                    return (Shown::Within(slack), ByParts::Needed);
                }
                Certificate::Undecided => break,
            }
        }
        let shown = if self.takes_way_past_end(slack) { Shown::Within(slack) } else { Shown::Nothing };
        (shown, by_parts.without())
    }

    /// Whether no point of the tool is nearer than a level: by patches of it, but by parts of the surface where few of those do not decide and
    /// these may take less, unless they have been asked in vain. Also what is then known of them.
    fn certified(
        &self,
        level: f64,
        proof: &mut Proof,
        by_parts: ByParts,
        is_asked: bool,
    ) -> (Certificate, ByParts) {
        let Self { tool, surface, side, tip, .. } = *self;
        let face = Face { surface, side };
        let contact = self.best.contact;
        let bases = contact.map(|contact| Bases::about(tool, tip, (surface, side), &contact.tool));
        let mut certified = |effort| certify(face, tool, tip, level, proof, bases.as_ref(), effort);
        let shown = |found, then| if found == Certificate::Holds { (found, then) } else { (found, by_parts) };
        if is_asked {
            return shown(certified(Effort::All), by_parts.in_vain());
        }
        // A tool that is a line has stretches for patches, not so many of them.
        if !surface.has_charts() || tool.radius() <= 0.0 || !by_parts.is_worthwhile() {
            return shown(certified(Effort::All), by_parts.without());
        }
        match certified(Effort::Few) {
            Certificate::Undecided if self.is_clear(level) => (Certificate::Holds, ByParts::Cheaper),
            Certificate::Undecided => (certified(Effort::All), by_parts.in_vain()),
            found => shown(found, by_parts.without()),
        }
    }

    /// Whether parts of the surface show that none is nearer to the tool than a level.
    fn is_clear(&self, level: f64) -> bool {
        let Self { tool, surface, side, tip, .. } = *self;
        let has_parts = surface.has_charts();
        has_parts
            && self
                .best
                .contact
                .is_some_and(|contact| Beside { tool, surface, side, tip }.clears(&contact, level))
    }

    /// The valleys near a point of the tool, given from its end, on one piece or all of them.
    fn descend(&mut self, point: &Vec3, only: Option<usize>) {
        let (along, across, radial) = self.tool.split(point);
        let azimuth = radial.dot(&self.tool.across[1]).atan2(radial.dot(&self.tool.across[0]));
        let step = std::f64::consts::TAU / SCAN as f64;
        let tool = self.tool;
        for (k, piece) in tool.pieces.iter().enumerate() {
            if only.is_some_and(|only| only != k) {
                continue;
            }
            self.piece = k;
            match *piece {
                Piece::Ring { radius, height, ball, fan } => {
                    let azimuth =
                        if radius > 0.0 { self.refine(radius, height, azimuth, step) } else { azimuth };
                    let p = self.point(radius, height, azimuth);
                    let foot = self.surface.foot(&p);
                    self.take_in_fan(&p, &foot, ball, fan);
                }
                Piece::Disc { radius } => {
                    let start = Vector2::new(point.dot(&tool.across[0]), point.dot(&tool.across[1]));
                    self.inside_disc(radius, start * (radius / across.max(radius)));
                }
                Piece::Frustum { .. } | Piece::Bulge { .. } => {
                    if let Some(curve) = piece.curve() {
                        let share = curve.share_at([across, along]);
                        self.inside_patch(&curve, Vector2::new(share, azimuth));
                    }
                }
            }
        }
    }

    /// Counts a foot; whether the search is given up with it: what has been found is then left as it is.
    fn is_given_up(&self) -> bool {
        self.tool.patience.ends_after(WORK_OF_FOOT)
    }

    fn point(&self, radius: f64, height: f64, azimuth: f64) -> Vec3 {
        self.tip + self.tool.axis * height + self.direction(azimuth) * radius
    }

    fn direction(&self, azimuth: f64) -> Vec3 {
        let (sin, cos) = azimuth.sin_cos();
        self.tool.across[0] * cos + self.tool.across[1] * sin
    }

    fn contact_at(&self, p: &Vec3, foot: &Foot, ball: f64) -> Contact {
        let gradient = foot.normal * self.side;
        Contact {
            clearance: self.side * foot.distance - ball,
            gradient,
            tool: p - gradient * ball,
            surface: foot.point,
        }
    }

    fn take(&mut self, p: &Vec3, foot: &Foot, ball: f64) {
        let contact = self.contact_at(p, foot, ball);
        self.best.take(self.piece, contact.clearance, || contact);
    }

    fn ring(&mut self, radius: f64, height: f64, ball: f64, fan: Option<[f64; 2]>) {
        if radius.abs() <= f64::EPSILON * (ball + height.abs()) {
            let p = self.point(0.0, height, 0.0);
            let foot = self.surface.foot(&p);
            self.take_in_fan(&p, &foot, ball, fan);
            return;
        }
        let step = std::f64::consts::TAU / SCAN as f64;
        let mut values = [0.0; SCAN];
        for (k, value) in values.iter_mut().enumerate() {
            if self.is_given_up() {
                return;
            }
            let p = self.point(radius, height, step * k as f64);
            *value = self.side * self.surface.signed_distance(&p) - ball;
        }
        let mut order: [usize; SCAN] = std::array::from_fn(|k| k);
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        for k in order {
            // Between two scan points the distance cannot fall by more than half the arc between them.
            if values[k] - 0.5 * step * radius.abs() >= self.best.value {
                break;
            }
            let (before, after) = (values[(k + SCAN - 1) % SCAN], values[(k + 1) % SCAN]);
            if values[k] <= before && values[k] <= after {
                let azimuth = self.refine(radius, height, step * k as f64, step);
                let p = self.point(radius, height, azimuth);
                let foot = self.surface.foot(&p);
                self.take_in_fan(&p, &foot, ball, fan);
            }
        }
    }

    fn take_in_fan(&mut self, p: &Vec3, foot: &Foot, ball: f64, fan: Option<[f64; 2]>) {
        if let Some([least, greatest]) = fan {
            // Polar angle, from straight down, of the tool's outward normal at contact.
            let down = (foot.normal.dot(&self.tool.axis) * self.side).clamp(-1.0, 1.0);
            let polar = down.acos();
            if polar < least - FAN_SLACK || polar > greatest + FAN_SLACK {
                return;
            }
        }
        self.take(p, foot, ball);
    }

    /// The azimuth of the valley near a scan point, by Newton's method between its neighbours.
    fn refine(&self, radius: f64, height: f64, azimuth: f64, step: f64) -> f64 {
        let (mut low, mut high) = (azimuth - step, azimuth + step);
        let mut x = azimuth;
        for _ in 0..MAX_ITERATIONS {
            if self.is_given_up() {
                return x;
            }
            let radial = self.direction(x);
            let tangent = self.tool.axis.cross(&radial);
            let p = self.tip + self.tool.axis * height + radial * radius;
            let (foot, hessian) = self.surface.foot_and_hessian(&p);
            let slope = self.side * radius * foot.normal.dot(&tangent);
            let bend =
                self.side * radius * (radius * tangent.dot(&(hessian * tangent)) - foot.normal.dot(&radial));
            if slope > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let newton = x - slope / bend;
            let next = if bend > 0.0 && newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - x).abs() <= ANGLE_RESOLUTION {
                return next;
            }
            x = next;
        }
        x
    }

    /// The flat bottom: contact in its interior where the distance falls from the edge inward.
    fn disc(&mut self, radius: f64) {
        let start = match self.best.contact {
            Some(contact) if contact.gradient.dot(&(contact.tool - self.tip)) > 0.0 => {
                contact.tool - self.tip
            }
            Some(_) => {
                let foot = self.surface.foot(self.tip);
                if self.side * foot.distance >= self.best.value {
                    return;
                }
                Vec3::zeros()
            }
            None => Vec3::zeros(),
        };
        self.inside_disc(
            radius,
            Vector2::new(start.dot(&self.tool.across[0]), start.dot(&self.tool.across[1])),
        );
    }

    fn inside_disc(&mut self, radius: f64, start: Vector2<f64>) {
        // A contact on the top edge may lie beyond the bottom.
        let mut q = start * (radius / start.norm().max(radius));
        let mut last = (f64::INFINITY, q);
        for _ in 0..MAX_ITERATIONS {
            if self.is_given_up() {
                return;
            }
            let p = self.tip + self.tool.across[0] * q.x + self.tool.across[1] * q.y;
            let (foot, hessian) = self.surface.foot_and_hessian(&p);
            let value = self.side * foot.distance;
            if value > last.0 && (q - last.1).norm() > ANGLE_RESOLUTION * radius {
                // Too far: half the step.
                q = 0.5 * (q + last.1);
                continue;
            }
            last = (value, q);
            self.take(&p, &foot, 0.0);
            let (x, y) = (self.tool.across[0], self.tool.across[1]);
            let gradient = Vector2::new(foot.normal.dot(&x), foot.normal.dot(&y)) * self.side;
            let bend = reduced(&hessian, &x, &y) * self.side;
            let mut next = q + descent(&bend, &gradient, radius);
            if next.norm() > radius {
                next *= radius / next.norm();
            }
            if (next - q).norm() <= ANGLE_RESOLUTION * radius {
                return;
            }
            q = next;
        }
    }

    /// Contact in the interior of what a piece of the profile sweeps about the axis, from a share along that and an azimuth.
    fn inside_patch(&mut self, curve: &Curve, start: Vector2<f64>) {
        let mut q = start;
        let mut last = (f64::INFINITY, q);
        for _ in 0..MAX_ITERATIONS {
            if self.is_given_up() {
                return;
            }
            let Spot { place: [rho, height], way: [spread, rise], bend: [widening, climbing] } =
                curve.at(q.x);
            if rho <= 0.0 {
                // The tip has every azimuth: the one that faces the surface leads down, if any does.
                let tip = self.point(0.0, height, 0.0);
                let towards = self.surface.foot(&tip).normal * -self.side;
                q.y = towards.dot(&self.tool.across[1]).atan2(towards.dot(&self.tool.across[0]));
            }
            let radial = self.direction(q.y);
            let tangent = self.tool.axis.cross(&radial);
            let p = self.tip + self.tool.axis * height + radial * rho;
            let (foot, hessian) = self.surface.foot_and_hessian(&p);
            let value = self.side * foot.distance;
            if value > last.0 && (q - last.1).norm() > ANGLE_RESOLUTION {
                q = 0.5 * (q + last.1);
                continue;
            }
            last = (value, q);
            self.take(&p, &foot, 0.0);
            let line = self.tool.axis * rise + radial * spread;
            let around = tangent * rho;
            let n = foot.normal * self.side;
            let gradient = Vector2::new(n.dot(&line), n.dot(&around));
            let mixed = n.dot(&tangent) * spread;
            let turned = -n.dot(&radial) * rho;
            let curving = n.dot(&(radial * widening + self.tool.axis * climbing));
            let bend =
                reduced(&hessian, &line, &around) * self.side + Matrix2::new(curving, mixed, mixed, turned);
            let step = descent(&bend, &gradient, 1.0);
            let next = Vector2::new((q.x + step.x).clamp(0.0, 1.0), q.y + step.y.clamp(-0.5, 0.5));
            if (next - q).norm() <= ANGLE_RESOLUTION {
                return;
            }
            q = next;
        }
    }
}

/// A quadratic form on two directions.
fn reduced(hessian: &Matrix3<f64>, a: &Vec3, b: &Vec3) -> Matrix2<f64> {
    let (ha, hb) = (hessian * a, hessian * b);
    let ab = a.dot(&hb);
    Matrix2::new(a.dot(&ha), ab, ab, b.dot(&hb))
}

/// Newton step towards a minimum: negative and zero curvatures are replaced so that it always descends.
fn descent(bend: &Matrix2<f64>, gradient: &Vector2<f64>, reach: f64) -> Vector2<f64> {
    let scale = bend.amax().max(gradient.norm() / reach);
    if scale <= 0.0 {
        return Vector2::zeros();
    }
    let eigen = bend.symmetric_eigen();
    let mut step = Vector2::zeros();
    for i in 0..2 {
        let direction: Vector2<f64> = eigen.eigenvectors.column(i).into();
        let curvature = eigen.eigenvalues[i].abs().max(1e-9 * scale);
        let length = -gradient.dot(&direction) / curvature;
        step += direction * length.clamp(-reach, reach);
    }
    step
}

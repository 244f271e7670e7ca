//! Positioning on one, two or three surfaces (CENTR, CENTR2, GAUSS): Newton's method on the clearances with their
//! analytic gradients, taking the shortest correction when there are fewer than three surfaces.

#[cfg(test)]
mod tests;

use std::cell::Cell;

use apt_geometry::Vec3;
use nalgebra::Matrix3;

use crate::{
    attitude::Attitude,
    clearance::{Contact, Gauge, Tool},
};

/// Bound of the iteration.
const MAX_ITERATIONS: u32 = 60;
/// How many places of a correction, each half as far as the one before, may have no axis: nearer ones lead but up to the edge of what has.
const MOST_WITHOUT_AXIS: u32 = 3;
/// How often a correction that makes things worse is halved.
const MAX_HALVINGS: u32 = 10;
/// The same for one of many tries: one that is to help less leads nowhere soon.
const FEW_HALVINGS: u32 = 3;
/// Residual, relative to the size of the coordinates, at which the iteration ends.
const RESOLUTION: f64 = 1e-13;
/// Residual, relative to the size of the coordinates, that is good enough when rounding stops further progress.
const ACCEPTABLE: f64 = 1e-10;
/// Determinant of unit normals below which they are dependent.
const DEPENDENT: f64 = 1e-10;
/// Share of the residual that is left by a correction which hardly helps.
const HARDLY: f64 = 0.5;
/// Damping of the normal equations when the normals are dependent.
const DAMPING: f64 = 1e-6;

/// One condition on the position.
#[derive(Clone, Copy)]
pub(crate) enum Condition<'a> {
    /// The clearance of a gauge has this value.
    Clearance(&'a Gauge, f64),
    /// The same, of a clearance that is found without proof, as [`Gauge::contact_passing`].
    Passing(&'a Gauge, f64),
    /// The clearance of a gauge has a value between these two.
    Between(&'a Gauge, [f64; 2]),
    /// The tool end lies on the plane with this unit normal and distance.
    Plane(Vec3, f64),
}

impl Condition<'_> {
    /// The same of what is found without proof.
    pub(crate) fn passing(&self) -> Self {
        match *self {
            Self::Clearance(gauge, wanted) => Self::Passing(gauge, wanted),
            other => other,
        }
    }
}

/// A position that satisfies all conditions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solution {
    pub(crate) tip: Vec3,
    /// Corrections made.
    pub(crate) corrections: u32,
    /// The contacts there, for conditions on clearances.
    pub(crate) contacts: [Option<Contact>; 3],
}

/// What was left when no position was found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unsolved {
    /// Greatest residual.
    pub(crate) residual: f64,
    /// Index of its condition.
    pub(crate) row: usize,
    /// Best position.
    pub(crate) tip: Vec3,
    pub(crate) iterations: u32,
}

/// How contacts are found on the way to a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manner {
    /// Each is the nearest.
    Proven,
    /// Where the last one leads: another may be nearer.
    Followed,
}

/// Residuals and their gradients.
#[derive(Clone, Copy)]
struct Rows {
    residual: [f64; 3],
    normal: [Vec3; 3],
    count: usize,
}

impl Rows {
    const NONE: Self = Self { residual: [0.0; 3], normal: [Vec3::new(0.0, 0.0, 0.0); 3], count: 0 };

    fn greatest(&self) -> (f64, usize) {
        let mut best = (0.0, 0);
        for (k, r) in self.residual[..self.count].iter().enumerate() {
            if r.abs() > best.0 || r.is_nan() {
                best = (r.abs(), k);
            }
        }
        best
    }
}

/// A place on the way to a position. It is large, and there are many: it is filled where it is, not passed on.
struct Place {
    tip: Vec3,
    rows: Rows,
    contacts: [Option<Contact>; 3],
    /// Whether every contact that is to be the nearest is known to be it.
    is_proven: bool,
}

impl Place {
    const NONE: Self =
        Self { tip: Vec3::new(0.0, 0.0, 0.0), rows: Rows::NONE, contacts: [None; 3], is_proven: true };

    /// The solution that it is after so many corrections.
    fn solution(&self, corrections: u32) -> Solution {
        Solution { tip: self.tip, corrections, contacts: self.contacts }
    }
}

/// Size of the coordinates around a position: what rounding is measured against.
pub(crate) fn size(tool: &Tool, tip: &Vec3) -> f64 {
    tip.amax() + tool.cutter.height + tool.radius()
}

/// Finds the position nearest to `start`, in the sense of successive shortest corrections.
pub(crate) fn solve(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
) -> Result<Solution, Unsolved> {
    solve_within(attitude, conditions, start, MAX_ITERATIONS)
}

/// As [`solve`], with at most so many corrections.
pub(crate) fn solve_within(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    corrections: u32,
) -> Result<Solution, Unsolved> {
    let effort = Effort { corrections, halvings: MAX_HALVINGS, turns: 1, is_one_of_many: false };
    solve_unless(attitude, conditions, start, effort, &|_| false)
}

/// As [`solve_within`] with the nearest contacts all the way: from a position it finds that position, whatever was looked at before.
pub(crate) fn solve_proven_within(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    corrections: u32,
) -> Result<Solution, Unsolved> {
    let effort = Effort { corrections, halvings: MAX_HALVINGS, turns: 0, is_one_of_many: false };
    solve_unless(attitude, conditions, start, effort, &|_| false)
}

/// The same unless the way leads farther from the start than this.
pub(crate) fn solve_proven_near(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    corrections: u32,
    farthest: f64,
) -> Result<Solution, Unsolved> {
    let effort = Effort { corrections, halvings: MAX_HALVINGS, turns: 0, is_one_of_many: false };
    solve_unless(attitude, conditions, start, effort, &|tip| (tip - start).norm() > farthest)
}

/// As [`solve_within`] for one of many tries: where the last contacts lead nowhere, and the nearest ones are the same there, these are not followed on
/// the way.
pub(crate) fn try_within(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    corrections: u32,
) -> Result<Solution, Unsolved> {
    let effort = Effort { corrections, halvings: FEW_HALVINGS, turns: 1, is_one_of_many: true };
    solve_unless(attitude, conditions, start, effort, &|_| false)
}

/// What a search for a position may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    pub(crate) corrections: u32,
    /// How often one that makes things worse is halved.
    pub(crate) halvings: u32,
    /// How often contacts are followed, each time from where the last ones have led, before it is proven on the way that they are the nearest: if never,
    /// what has been looked at before does not matter.
    pub(crate) turns: u32,
    /// Whether it may end where the nearest contacts may not have led.
    pub(crate) is_one_of_many: bool,
}

/// As [`solve`] with so much effort; it is given up where it comes to a place that is in vain.
///
/// Corrections are made with the contacts where the last ones lead. That they are the nearest is proven where these have led, and only if
/// that is wrong it is proven on the way, too.
pub(crate) fn solve_unless(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    effort: Effort,
    is_in_vain: &dyn Fn(&Vec3) -> bool,
) -> Result<Solution, Unsolved> {
    let search = Search { attitude, conditions, effort, is_in_vain, is_proven: Cell::new(true) };
    let (mut here, mut next) = (Place::NONE, Place::NONE);
    let (mut from, mut made) = (*start, 0);
    for turn in 1..=effort.turns {
        let mut way = Way { here: &mut here, next: &mut next };
        let (found, is_proven) = search.newton(&from, &mut way, Manner::Followed);
        let place = way.here;
        match found {
            // A failure is one of the way from the start.
            Err(unsolved) if is_proven && turn == 1 => return Err(unsolved),
            Ok(corrections) => made += corrections,
            Err(unsolved) if turn == 1 && effort.is_one_of_many && search.is_known_at(&unsolved) => {
                return Err(unsolved);
            }
            Err(_) => break,
        }
        if is_proven {
            return Ok(place.solution(made));
        }
        from = place.tip;
        search.evaluate(&from, Manner::Proven, &mut here);
        let is_another = here.rows.greatest().0 > ACCEPTABLE * size(attitude.tool(), &from);
        // What is nearer there is followed in turn.
        if is_another && turn < effort.turns {
            continue;
        }
        let mut way = Way { here: &mut here, next: &mut next };
        if let (Ok(corrections), _) = search.newton_with(&mut way, Manner::Proven) {
            return Ok(way.here.solution(made + corrections));
        }
        break;
    }
    let mut way = Way { here: &mut here, next: &mut next };
    match search.newton(start, &mut way, Manner::Proven).0 {
        Ok(corrections) => Ok(way.here.solution(corrections)),
        Err(unsolved) => Err(unsolved),
    }
}

/// The place that a search has come to, and room for the next one.
struct Way<'a> {
    here: &'a mut Place,
    next: &'a mut Place,
}

/// A search for a position.
struct Search<'a> {
    attitude: &'a Attitude<'a>,
    conditions: &'a [Condition<'a>],
    effort: Effort,
    is_in_vain: &'a dyn Fn(&Vec3) -> bool,
    /// Whether all contacts so far were known to be the nearest.
    is_proven: Cell<bool>,
}

impl Search<'_> {
    /// With how many corrections Newton's method comes to a solution from a start, and whether contacts that need not be the nearest have no part in it.
    fn newton(&self, start: &Vec3, way: &mut Way<'_>, manner: Manner) -> (Result<u32, Unsolved>, bool) {
        self.evaluate(start, manner, way.here);
        self.newton_with(way, manner)
    }

    /// The same from where it is known what it is like.
    fn newton_with(&self, way: &mut Way<'_>, manner: Manner) -> (Result<u32, Unsolved>, bool) {
        let Self { attitude, effort: Effort { corrections, halvings, .. }, is_in_vain, .. } = *self;
        let unsolved = |unsolved: Unsolved| (Err(unsolved), manner == Manner::Proven || self.is_proven.get());
        for iteration in 0..corrections {
            let Place { tip, ref rows, is_proven, .. } = *way.here;
            let (worst, row) = rows.greatest();
            let scale = size(attitude.tool(), &tip);
            if worst <= RESOLUTION * scale {
                // What was on the way does not matter where the end is proven.
                return (Ok(iteration), is_proven);
            }
            if is_in_vain(&tip) {
                return unsolved(Unsolved { residual: worst, row, tip, iterations: iteration });
            }
            if !self.corrected(way, (halvings, manner)) {
                if worst <= ACCEPTABLE * scale {
                    return (Ok(iteration), is_proven);
                }
                return unsolved(Unsolved { residual: worst, row, tip, iterations: iteration + 1 });
            }
            std::mem::swap(&mut way.here, &mut way.next);
        }
        let Place { tip, ref rows, is_proven, .. } = *way.here;
        let (residual, row) = rows.greatest();
        if residual <= ACCEPTABLE * size(attitude.tool(), &tip) {
            return (Ok(corrections), is_proven);
        }
        unsolved(Unsolved { residual, row, tip, iterations: corrections })
    }

    /// Whether a correction leads on: to the next place.
    fn corrected(&self, Way { here, next }: &mut Way<'_>, bounds: (u32, Manner)) -> bool {
        let (_, manner) = bounds;
        let step = correction(&here.rows);
        let is_improved = self.improve(here, &step, bounds, next);
        if self.between_contacts(here, &step, is_improved, manner, next) {
            return true;
        }
        // What has room in its band need not stay where it is in that.
        let Some(wrong) = self.wrong_alone(&here.rows) else { return false };
        let step = correction(&wrong);
        if self.improve(here, &step, bounds, next) {
            return true;
        }
        let both = self.with_contact_ahead(wrong, &here.tip, &step, manner);
        both.is_some_and(|both| self.improve(here, &correction(&both), bounds, next))
    }

    /// Whether the next place is better: what a correction has led to, if it has, or, where that hardly helped, what leads to the contact before it and
    /// to the one after it at once, if that does help: a tool that lies between two walls would be led from one to the other and back.
    fn between_contacts(
        &self,
        here: &Place,
        step: &Vec3,
        is_improved: bool,
        manner: Manner,
        next: &mut Place,
    ) -> bool {
        let worst = here.rows.greatest().0;
        let left = if is_improved { next.rows.greatest().0 } else { worst };
        if left < HARDLY * worst {
            return is_improved;
        }
        let Some(both) = self.with_contact_ahead(here.rows, &here.tip, step, manner) else {
            return is_improved;
        };
        let mut between = Place::NONE;
        self.evaluate(&(here.tip + correction(&both)), manner, &mut between);
        if between.rows.greatest().0 < HARDLY * left {
            *next = between;
            return true;
        }
        is_improved
    }

    /// Whether the step or one of its halves reduces the greatest residual: the first that does leads to the next place.
    fn improve(
        &self,
        here: &Place,
        step: &Vec3,
        (halvings, manner): (u32, Manner),
        next: &mut Place,
    ) -> bool {
        let (worst, _) = here.rows.greatest();
        let mut share = 1.0;
        let mut without_axis = 0;
        for _ in 0..=halvings {
            self.evaluate(&(here.tip + step * share), manner, next);
            let left = next.rows.greatest().0;
            if left < worst {
                return true;
            }
            without_axis += u32::from(left.is_nan());
            if without_axis > MOST_WITHOUT_AXIS {
                return false;
            }
            share *= 0.5;
        }
        false
    }

    /// The rows without those that are between their limits; `None` if there are no such.
    fn wrong_alone(&self, rows: &Rows) -> Option<Rows> {
        let mut wrong = Rows { count: 0, ..*rows };
        for (k, condition) in self.conditions.iter().take(rows.count).enumerate() {
            if matches!(condition, Condition::Between(..)) && rows.residual[k] == 0.0 {
                continue;
            }
            wrong.residual[wrong.count] = rows.residual[k];
            wrong.normal[wrong.count] = rows.normal[k];
            wrong.count += 1;
        }
        (wrong.count > 0 && wrong.count < rows.count).then_some(wrong)
    }

    /// The rows and one more for the contact that the worst of them has after a step which makes it no better: there another part of the tool
    /// comes nearer, and what leads away from both is the way.
    fn with_contact_ahead(&self, mut wrong: Rows, tip: &Vec3, step: &Vec3, manner: Manner) -> Option<Rows> {
        if wrong.count >= wrong.residual.len() {
            return None;
        }
        let mut place = Place::NONE;
        self.evaluate(&(tip + step), manner, &mut place);
        let ahead = &place.rows;
        let (_, row) = ahead.greatest();
        let (residual, normal) = (ahead.residual[row] - ahead.normal[row].dot(step), ahead.normal[row]);
        (wrong.residual[wrong.count], wrong.normal[wrong.count]) = (residual, normal);
        wrong.count += 1;
        residual.is_finite().then_some(wrong)
    }

    /// Whether what is left where a search ended is left of the nearest contacts there.
    fn is_known_at(&self, &Unsolved { residual, ref tip, .. }: &Unsolved) -> bool {
        let mut place = Place::NONE;
        self.evaluate(tip, Manner::Proven, &mut place);
        let nearest = place.rows.greatest().0;
        (nearest - residual).abs() <= ACCEPTABLE * size(self.attitude.tool(), tip)
    }

    fn evaluate(&self, tip: &Vec3, manner: Manner, place: &mut Place) {
        evaluate(self.attitude, self.conditions, tip, manner, place);
        self.is_proven.set(self.is_proven.get() && place.is_proven);
    }
}

/// Where a number of corrections lead, each made in full whether it helps or not; the last place that has coordinates.
pub(crate) fn corrected(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    corrections: u32,
) -> Vec3 {
    let (mut tip, mut place) = (*start, Place::NONE);
    for _ in 0..corrections {
        evaluate(attitude, conditions, &tip, Manner::Proven, &mut place);
        let next = tip + correction(&place.rows);
        if !next.iter().all(|x| x.is_finite()) {
            break;
        }
        tip = next;
    }
    tip
}

/// What it is like at a place. Where the axis is not determined, where dependent normals lead nowhere, and once the tool's patience is
/// over, the residuals are not numbers, and no step goes there.
fn evaluate(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    tip: &Vec3,
    manner: Manner,
    place: &mut Place,
) {
    let count = conditions.len().min(3);
    let is_place =
        [tip.x, tip.y, tip.z].iter().all(|x| x.is_finite()) && !attitude.tool().patience.was_over();
    let nowhere = || {
        let rows = Rows { residual: [f64::NAN; 3], count, ..Rows::NONE };
        Place { tip: *tip, rows, ..Place::NONE }
    };
    if !is_place {
        *place = nowhere();
        return;
    }
    let Ok(posture) = &attitude.posture(tip) else {
        *place = nowhere();
        return;
    };
    (place.tip, place.rows.count, place.is_proven) = (*tip, count, true);
    for (k, condition) in conditions.iter().take(count).enumerate() {
        let (gauge, [least, greatest], is_passed) = match *condition {
            Condition::Clearance(gauge, wanted) => (gauge, [wanted; 2], false),
            Condition::Passing(gauge, wanted) => (gauge, [wanted; 2], true),
            Condition::Between(gauge, limits) => (gauge, limits, false),
            Condition::Plane(normal, distance) => {
                (place.rows.residual[k], place.rows.normal[k]) = (normal.dot(tip) - distance, normal);
                place.contacts[k] = None;
                continue;
            }
        };
        let (contact, is_known) = match (manner, is_passed) {
            (Manner::Proven, false) => (posture.contact(gauge, tip), true),
            (Manner::Proven, true) => (posture.contact_passing(gauge, tip), true),
            (Manner::Followed, false) => posture.contact_followed(gauge, tip),
            (Manner::Followed, true) => posture.contact_passing_followed(gauge, tip),
        };
        // What lies between counts as it is.
        place.rows.residual[k] = contact.clearance - contact.clearance.max(least).min(greatest);
        place.rows.normal[k] = contact.gradient;
        place.contacts[k] = Some(contact);
        place.is_proven &= is_known;
    }
}

/// The shortest correction for two residuals with their gradients.
pub(crate) fn correction_of_two(residual: [f64; 2], normal: [Vec3; 2]) -> Vec3 {
    let ([ra, rb], [a, b]) = (residual, normal);
    correction(&Rows { residual: [ra, rb, 0.0], normal: [a, b, Vec3::zeros()], count: 2 })
}

/// The correction for three residuals with their gradients.
pub(crate) fn correction_of_three(residual: [f64; 3], normal: [Vec3; 3]) -> Vec3 {
    correction(&Rows { residual, normal, count: 3 })
}

/// `X = −Nᵀ (N Nᵀ)⁻¹ r`, damped when the normals are dependent.
fn correction(rows: &Rows) -> Vec3 {
    let [a, b, c] = rows.normal;
    let [ra, rb, rc] = rows.residual;
    match rows.count {
        0 => Vec3::zeros(),
        1 => -a * (ra / a.norm_squared()),
        2 => {
            let (aa, ab, bb) = (a.norm_squared(), a.dot(&b), b.norm_squared());
            let damping = if aa * bb - ab * ab < DEPENDENT * aa * bb { DAMPING } else { 0.0 };
            let (aa, bb) = (aa + damping, bb + damping);
            let determinant = aa * bb - ab * ab;
            if determinant == 0.0 {
                return -a * ra;
            }
            // By the inverse of the Gram matrix.
            let (by_a, by_b, mixed) = (bb / determinant, aa / determinant, -ab / determinant);
            -(a * (by_a * ra + mixed * rb) + b * (mixed * ra + by_b * rb))
        }
        _ => {
            // Cramer's rule with the sine of the solid angle as determinant.
            let determinant = a.dot(&b.cross(&c));
            if determinant.abs() > DEPENDENT {
                return -(b.cross(&c) * ra + c.cross(&a) * rb + a.cross(&b) * rc) / determinant;
            }
            let normals = Matrix3::from_rows(&[a.transpose(), b.transpose(), c.transpose()]);
            let gram = normals * normals.transpose() + Matrix3::identity() * DAMPING;
            match gram.try_inverse() {
                Some(inverse) => -(normals.transpose() * (inverse * Vec3::new(ra, rb, rc))),
                None => -a * ra,
            }
        }
    }
}

//! Positioning on one, two or three surfaces (CENTR, CENTR2, GAUSS): Newton's method on the clearances with their
//! analytic gradients, taking the shortest correction when there are fewer than three surfaces.

#[cfg(test)]
mod tests;

use std::cell::Cell;

use apt_geometry::Vec3;
use nalgebra::{Matrix2, Matrix3, Vector2};

use crate::{
    attitude::Attitude,
    clearance::{Contact, Gauge, Tool},
};

/// Bound of the iteration.
const MAX_ITERATIONS: u32 = 60;
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

#[derive(Clone, Copy)]
struct Rows {
    residual: [f64; 3],
    normal: [Vec3; 3],
    contacts: [Option<Contact>; 3],
    count: usize,
    /// Whether every contact that is to be the nearest is known to be it.
    is_proven: bool,
}

impl Rows {
    const NONE: Self = Self {
        residual: [0.0; 3],
        normal: [Vec3::new(0.0, 0.0, 0.0); 3],
        contacts: [None; 3],
        count: 0,
        is_proven: true,
    };

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

/// The same for one of many tries: where the last contacts lead nowhere, and the nearest ones are the same there, these are not followed on
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
    /// How often contacts are followed, each time from where the last ones have led, before it is proven on the way that they are the nearest.
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
    let (mut from, mut made) = (*start, 0);
    for turn in 1..=effort.turns.max(1) {
        let (found, is_proven) = search.newton(&from, Manner::Followed);
        let solution = match found {
            // A failure is one of the way from the start.
            _ if is_proven && turn == 1 => return found,
            Ok(solution) => solution,
            Err(unsolved) if turn == 1 && effort.is_one_of_many && search.is_known_at(&unsolved) => {
                return found;
            }
            Err(_) => break,
        };
        made += solution.corrections;
        if is_proven {
            return Ok(Solution { corrections: made, ..solution });
        }
        from = solution.tip;
        let nearest = search.evaluate(&from, Manner::Proven);
        let is_another = nearest.greatest().0 > ACCEPTABLE * size(attitude.tool(), &from);
        // What is nearer there is followed in turn.
        if is_another && turn < effort.turns {
            continue;
        }
        if let (Ok(proven), _) = search.newton_with(&from, nearest, Manner::Proven) {
            return Ok(Solution { corrections: made + proven.corrections, ..proven });
        }
        break;
    }
    search.newton(start, Manner::Proven).0
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
    /// What Newton's method finds, and whether contacts that need not be the nearest have no part in it.
    fn newton(&self, start: &Vec3, manner: Manner) -> (Result<Solution, Unsolved>, bool) {
        self.newton_with(start, self.evaluate(start, manner), manner)
    }

    /// The same from what the start is like.
    fn newton_with(
        &self,
        start: &Vec3,
        mut rows: Rows,
        manner: Manner,
    ) -> (Result<Solution, Unsolved>, bool) {
        let Self { attitude, effort: Effort { corrections, halvings, .. }, is_in_vain, .. } = *self;
        let unsolved = |unsolved: Unsolved| (Err(unsolved), manner == Manner::Proven || self.is_proven.get());
        let mut tip = *start;
        for iteration in 0..corrections {
            let (worst, row) = rows.greatest();
            let scale = size(attitude.tool(), &tip);
            let solution = Solution { tip, corrections: iteration, contacts: rows.contacts };
            if worst <= RESOLUTION * scale {
                // What was on the way does not matter where the end is proven.
                return (Ok(solution), rows.is_proven);
            }
            if is_in_vain(&tip) {
                return unsolved(Unsolved { residual: worst, row, tip, iterations: iteration });
            }
            let step = correction(&rows);
            let bounds = (halvings, manner);
            let improved = self.improve((&tip, &rows), &step, bounds);
            let improved = self.between_contacts((&tip, &rows), &step, improved, manner).or_else(|| {
                // What has room in its band need not stay where it is in that.
                let wrong = self.wrong_alone(&rows)?;
                let step = correction(&wrong);
                self.improve((&tip, &rows), &step, bounds).or_else(|| {
                    let both = self.with_contact_ahead(wrong, &tip, &step, manner)?;
                    self.improve((&tip, &rows), &correction(&both), bounds)
                })
            });
            let Some((next, next_rows)) = improved else {
                if worst <= ACCEPTABLE * scale {
                    return (Ok(solution), rows.is_proven);
                }
                return unsolved(Unsolved { residual: worst, row, tip, iterations: iteration + 1 });
            };
            (tip, rows) = (next, next_rows);
        }
        let (residual, row) = rows.greatest();
        if residual <= ACCEPTABLE * size(attitude.tool(), &tip) {
            return (Ok(Solution { tip, corrections, contacts: rows.contacts }), rows.is_proven);
        }
        unsolved(Unsolved { residual, row, tip, iterations: corrections })
    }

    /// What a correction has led to, or, where that hardly helped, what leads to the contact before it and to the one after it at once, if that does
    /// help: a tool that lies between two walls would be led from one to the other and back.
    fn between_contacts(
        &self,
        (tip, rows): (&Vec3, &Rows),
        step: &Vec3,
        improved: Option<(Vec3, Rows)>,
        manner: Manner,
    ) -> Option<(Vec3, Rows)> {
        let left = improved.map_or(rows.greatest().0, |(_, next)| next.greatest().0);
        if left < HARDLY * rows.greatest().0 {
            return improved;
        }
        let both = self.with_contact_ahead(*rows, tip, step, manner);
        let between = both.and_then(|both| {
            let next = tip + correction(&both);
            let next_rows = self.evaluate(&next, manner);
            (next_rows.greatest().0 < HARDLY * left).then_some((next, next_rows))
        });
        between.or(improved)
    }

    /// The first of the step and its halves that reduces the greatest residual.
    fn improve(
        &self,
        (tip, rows): (&Vec3, &Rows),
        step: &Vec3,
        (halvings, manner): (u32, Manner),
    ) -> Option<(Vec3, Rows)> {
        let (worst, _) = rows.greatest();
        let mut share = 1.0;
        for _ in 0..=halvings {
            let next = tip + step * share;
            let next_rows = self.evaluate(&next, manner);
            if next_rows.greatest().0 < worst {
                return Some((next, next_rows));
            }
            share *= 0.5;
        }
        None
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
        let ahead = self.evaluate(&(tip + step), manner);
        let (_, row) = ahead.greatest();
        let (residual, normal) = (ahead.residual[row] - ahead.normal[row].dot(step), ahead.normal[row]);
        (wrong.residual[wrong.count], wrong.normal[wrong.count]) = (residual, normal);
        wrong.count += 1;
        residual.is_finite().then_some(wrong)
    }

    /// Whether what is left where a search ended is left of the nearest contacts there.
    fn is_known_at(&self, &Unsolved { residual, ref tip, .. }: &Unsolved) -> bool {
        let nearest = self.evaluate(tip, Manner::Proven).greatest().0;
        (nearest - residual).abs() <= ACCEPTABLE * size(self.attitude.tool(), tip)
    }

    fn evaluate(&self, tip: &Vec3, manner: Manner) -> Rows {
        let rows = evaluate(self.attitude, self.conditions, tip, manner);
        self.is_proven.set(self.is_proven.get() && rows.is_proven);
        rows
    }
}

/// Where a number of corrections lead, each made in full whether it helps or not; the last place that has coordinates.
pub(crate) fn corrected(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    corrections: u32,
) -> Vec3 {
    let mut tip = *start;
    for _ in 0..corrections {
        let next = tip + correction(&evaluate(attitude, conditions, &tip, Manner::Proven));
        if !next.iter().all(|x| x.is_finite()) {
            break;
        }
        tip = next;
    }
    tip
}

/// Residuals and their gradients. Where the axis is not determined, where dependent normals lead nowhere, and once the tool's patience is
/// over, the residuals are not numbers, and no step goes there.
fn evaluate(attitude: &Attitude, conditions: &[Condition<'_>], tip: &Vec3, manner: Manner) -> Rows {
    let mut rows = Rows { count: conditions.len().min(3), ..Rows::NONE };
    let is_place = tip.iter().all(|x| x.is_finite()) && !attitude.tool().patience.was_over();
    let Some(posture) = is_place.then(|| attitude.posture(tip).ok()).flatten() else {
        rows.residual = [f64::NAN; 3];
        return rows;
    };
    let contact = |gauge: &Gauge| match manner {
        Manner::Proven => (posture.contact(gauge, tip), true),
        Manner::Followed => posture.contact_followed(gauge, tip),
    };
    for (k, condition) in conditions.iter().take(3).enumerate() {
        (rows.residual[k], rows.normal[k]) = match condition {
            Condition::Clearance(gauge, target) => {
                let (contact, is_proven) = contact(gauge);
                rows.is_proven &= is_proven;
                rows.contacts[k] = Some(contact);
                (contact.clearance - target, contact.gradient)
            }
            Condition::Passing(gauge, target) => {
                let (contact, is_found) = match manner {
                    Manner::Proven => (posture.contact_passing(gauge, tip), true),
                    Manner::Followed => posture.contact_passing_followed(gauge, tip),
                };
                rows.is_proven &= is_found;
                rows.contacts[k] = Some(contact);
                (contact.clearance - target, contact.gradient)
            }
            Condition::Between(gauge, [least, greatest]) => {
                let (contact, is_proven) = contact(gauge);
                rows.is_proven &= is_proven;
                rows.contacts[k] = Some(contact);
                // What lies between counts as it is.
                (contact.clearance - contact.clearance.max(*least).min(*greatest), contact.gradient)
            }
            Condition::Plane(normal, distance) => (normal.dot(tip) - distance, *normal),
        };
    }
    rows
}

/// The shortest correction for two residuals with their gradients.
pub(crate) fn correction_of_two(residual: [f64; 2], normal: [Vec3; 2]) -> Vec3 {
    let ([ra, rb], [a, b]) = (residual, normal);
    correction(&Rows { residual: [ra, rb, 0.0], normal: [a, b, Vec3::zeros()], count: 2, ..Rows::NONE })
}

/// The correction for three residuals with their gradients.
pub(crate) fn correction_of_three(residual: [f64; 3], normal: [Vec3; 3]) -> Vec3 {
    correction(&Rows { residual, normal, count: 3, ..Rows::NONE })
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
            let gram = Matrix2::new(aa + damping, ab, ab, bb + damping);
            match gram.try_inverse() {
                Some(inverse) => {
                    let x = inverse * Vector2::new(ra, rb);
                    -(a * x.x + b * x.y)
                }
                None => -a * ra,
            }
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

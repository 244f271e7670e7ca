//! Positioning on one, two or three surfaces (CENTR, CENTR2, GAUSS): Newton's method on the clearances with their
//! analytic gradients, taking the shortest correction when there are fewer than three surfaces.

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
/// Residual, relative to the size of the coordinates, at which the iteration ends.
const RESOLUTION: f64 = 1e-13;
/// Residual, relative to the size of the coordinates, that is good enough when rounding stops further progress.
const ACCEPTABLE: f64 = 1e-10;
/// Determinant of unit normals below which they are dependent.
const DEPENDENT: f64 = 1e-10;
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

#[derive(Clone, Copy)]
struct Rows {
    residual: [f64; 3],
    normal: [Vec3; 3],
    contacts: [Option<Contact>; 3],
    count: usize,
}

impl Rows {
    const NONE: Self =
        Self { residual: [0.0; 3], normal: [Vec3::new(0.0, 0.0, 0.0); 3], contacts: [None; 3], count: 0 };

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
    let effort = Effort { corrections, halvings: MAX_HALVINGS };
    solve_unless(attitude, conditions, start, effort, &|_| false)
}

/// What a search for a position may take.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    pub(crate) corrections: u32,
    /// How often one that makes things worse is halved.
    pub(crate) halvings: u32,
}

/// As [`solve`] with so much effort; it is given up where it comes to a place that is in vain.
pub(crate) fn solve_unless(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    start: &Vec3,
    Effort { corrections, halvings }: Effort,
    is_in_vain: &dyn Fn(&Vec3) -> bool,
) -> Result<Solution, Unsolved> {
    let mut tip = *start;
    let mut rows = evaluate(attitude, conditions, &tip);
    for iteration in 0..corrections {
        let (worst, row) = rows.greatest();
        let scale = size(attitude.tool(), &tip);
        if worst <= RESOLUTION * scale {
            return Ok(Solution { tip, corrections: iteration, contacts: rows.contacts });
        }
        if is_in_vain(&tip) {
            return Err(Unsolved { residual: worst, row, tip, iterations: iteration });
        }
        let step = correction(&rows);
        let Some((next, next_rows)) = improve(attitude, conditions, (&tip, &rows), &step, halvings) else {
            return if worst <= ACCEPTABLE * scale {
                Ok(Solution { tip, corrections: iteration, contacts: rows.contacts })
            } else {
                Err(Unsolved { residual: worst, row, tip, iterations: iteration + 1 })
            };
        };
        tip = next;
        rows = next_rows;
    }
    let (residual, row) = rows.greatest();
    if residual <= ACCEPTABLE * size(attitude.tool(), &tip) {
        return Ok(Solution { tip, corrections, contacts: rows.contacts });
    }
    Err(Unsolved { residual, row, tip, iterations: corrections })
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
        let next = tip + correction(&evaluate(attitude, conditions, &tip));
        if !next.iter().all(|x| x.is_finite()) {
            break;
        }
        tip = next;
    }
    tip
}

/// The first of the step and its halves that reduces the greatest residual.
fn improve(
    attitude: &Attitude,
    conditions: &[Condition<'_>],
    (tip, rows): (&Vec3, &Rows),
    step: &Vec3,
    halvings: u32,
) -> Option<(Vec3, Rows)> {
    let (worst, _) = rows.greatest();
    let mut share = 1.0;
    for _ in 0..=halvings {
        let next = tip + step * share;
        let next_rows = evaluate(attitude, conditions, &next);
        if next_rows.greatest().0 < worst {
            return Some((next, next_rows));
        }
        share *= 0.5;
    }
    None
}

/// Residuals and their gradients. Where the axis is not determined, and where dependent normals lead nowhere, the residuals are not
/// numbers, and no step goes there.
fn evaluate(attitude: &Attitude, conditions: &[Condition<'_>], tip: &Vec3) -> Rows {
    let mut rows = Rows { count: conditions.len().min(3), ..Rows::NONE };
    let is_place = tip.iter().all(|x| x.is_finite());
    let Some(posture) = is_place.then(|| attitude.posture(tip).ok()).flatten() else {
        rows.residual = [f64::NAN; 3];
        return rows;
    };
    for (k, condition) in conditions.iter().take(3).enumerate() {
        (rows.residual[k], rows.normal[k]) = match condition {
            Condition::Clearance(gauge, target) => {
                let contact = posture.contact(gauge, tip);
                rows.contacts[k] = Some(contact);
                (contact.clearance - target, contact.gradient)
            }
            Condition::Passing(gauge, target) => {
                let contact = posture.contact_passing(gauge, tip);
                rows.contacts[k] = Some(contact);
                (contact.clearance - target, contact.gradient)
            }
            Condition::Between(gauge, [least, greatest]) => {
                let contact = posture.contact(gauge, tip);
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

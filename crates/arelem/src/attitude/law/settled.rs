//! The normal at the contact of a tool whose axis stands to it: each moves the other.

use std::f64::consts::TAU;

use apt_geometry::{Vec3, surface::perpendicular};
use nalgebra::{Matrix2, Matrix3, Vector2};

use super::{Bent, Law, go_on};
use crate::{clearance::Tool, error::AxisFailure};

/// Bound of the iteration for the normal at the contact.
const MAX_ITERATIONS: u32 = 40;
/// How often it begins at the place of the corner circle that is nearest to the surface, and azimuths of that circle that are looked at.
const STARTS: u32 = 4;
const AZIMUTHS: u32 = 24;
/// A change of the normal below this ends it.
const RESOLUTION: f64 = 1e-15;
/// The change that may be left: nearest points of polyconic surfaces are known to about a tenth of it.
const ACCEPTABLE: f64 = 1e-8;
/// The change that rounding of nearest points may leave, where Newton's method has led.
const ROUNDED: f64 = 1e-12;
/// Ratio of a change to the one before above which the iteration is slow.
const SLOW: f64 = 0.2;
/// Difference of unit vectors by which Newton's method tells how they are led on: the root of the error of the normals.
const DIFFERENCE: f64 = 1e-6;
/// The longest step of Newton's method (radians): what bends more than that is not foretold.
const LONGEST_STEP: f64 = 0.3;
/// How often one that does not lead nearer is halved.
const HALVINGS: u32 = 6;
/// How near to a place from which Newton's method led no nearer, relative to what was wrong there, another one is the same.
const SAME_PLACE: f64 = 0.1;

impl Law {
    /// The normal at the contact, which moves with the axis that stands on it: from that at the tool end, and where that does not settle, as beside a
    /// corner circle that lies nearly along the surface, from that at the place of the circle which is nearest to the surface, as long as that leads to
    /// other places from which nothing leads nearer than those before.
    pub(super) fn settled(&self, tool: &Tool, tip: &Vec3, other: Option<&Vec3>) -> Result<Bent, AxisFailure> {
        let mut in_vain = Vec::new();
        let mut start = self.base.normal(tip);
        let mut found = self.settled_from(start, &mut in_vain, (tool, tip, other));
        for _ in 0..STARTS {
            if !matches!(found, Err(AxisFailure::NotSettled { change }) if change.is_finite()) {
                break;
            }
            start = self.normal_nearest(tool, tip, &self.towards(&start, tip, other)?)?;
            let known = in_vain.len();
            found = self.settled_from(start, &mut in_vain, (tool, tip, other)).or(found);
            if found.is_err() && in_vain.len() == known {
                break;
            }
        }
        found
    }

    /// The normal at the place of the corner circle that is nearest to the surface, about.
    fn normal_nearest(&self, tool: &Tool, tip: &Vec3, axis: &Vec3) -> Result<Vec3, AxisFailure> {
        let first = perpendicular(axis);
        let second = axis.cross(&first);
        let mut nearest = (f64::INFINITY, Vec3::zeros());
        for k in 0..AZIMUTHS {
            go_on(tool)?;
            let (sin, cos) = (TAU * f64::from(k) / f64::from(AZIMUTHS)).sin_cos();
            let facing = first * cos + second * sin;
            let place = self.place(tool, tip, axis, &facing);
            let distance = self.base.sign * self.base.surface.signed_distance(&place);
            if distance < nearest.0 {
                nearest = (distance, place);
            }
        }
        Ok(self.base.normal(&nearest.1))
    }

    /// The same from one normal on: each is taken where Newton's method leads; where that does not
    /// come nearer, where the last one leads as long as that comes nearer fast, and then where Newton's method with differences does. Where this leads no
    /// nearer from a place from which it led no nearer before, the iteration would go round.
    fn settled_from(
        &self,
        start: Vec3,
        in_vain: &mut Vec<(Vec3, f64)>,
        (tool, tip, other): (&Tool, &Vec3, Option<&Vec3>),
    ) -> Result<Bent, AxisFailure> {
        let led = |from: Vec3| -> Result<Led, AxisFailure> {
            go_on(tool)?;
            let axis = self.towards(&from, tip, other)?;
            let (to, bend) = self.base.bend(&self.place(tool, tip, &axis, &from));
            Ok(Led { from, to, change: (to - from).norm(), axis, bend })
        };
        let mut here = led(start)?;
        let mut is_slow = false;
        for _ in 0..MAX_ITERATIONS {
            if here.change <= RESOLUTION {
                return Ok((here.to, here.bend));
            }
            let foretold = self.foretold(tool, (&here.from, &here.to, &here.bend), (&here.axis, other));
            if let Some(next) = foretold.and_then(|normal| led(normal).ok())
                && next.change <= SLOW * here.change
            {
                here = next;
                continue;
            }
            if here.change <= ROUNDED {
                return Ok((here.to, here.bend));
            }
            let nearer = if is_slow { here.nearer(&led)? } else { None };
            if nearer.is_none() && is_slow && here.change <= ACCEPTABLE {
                return Ok((here.to, here.bend));
            }
            if nearer.is_none() && is_slow {
                let (from, change) = (here.from, here.change);
                if in_vain.iter().any(|(place, wrong)| (from - place).norm() <= SAME_PLACE * wrong) {
                    break;
                }
                in_vain.push((from, change));
            }
            let next = nearer.map_or_else(|| led(here.to), Ok)?;
            is_slow |= next.change > SLOW * here.change;
            here = next;
        }
        if here.change <= ACCEPTABLE {
            Ok((here.to, here.bend))
        } else {
            Err(AxisFailure::NotSettled { change: here.change })
        }
    }
}

/// A normal, and where the law leads it: the axis that stands to it, and the normal with its derivatives that the surface has where a tool
/// with that axis stands.
#[derive(Debug, Clone, Copy)]
struct Led {
    from: Vec3,
    to: Vec3,
    change: f64,
    axis: Vec3,
    bend: Matrix3<f64>,
}

impl Led {
    /// One that is changed less, the first on the way of a step of Newton's method and shares of it, if there is one.
    fn nearer(&self, map: &dyn Fn(Vec3) -> Result<Self, AxisFailure>) -> Result<Option<Self>, AxisFailure> {
        let first = perpendicular(&self.from);
        let frame = [first, self.from.cross(&first)];
        let flat = |led: &Self| {
            let change = led.to - led.from;
            Vector2::new(change.dot(&frame[0]), change.dot(&frame[1]))
        };
        let change = flat(self);
        let mut columns = [Vector2::zeros(); 2];
        for (column, direction) in columns.iter_mut().zip(&frame) {
            let beside = map((self.from + direction * DIFFERENCE).normalize())?;
            *column = (flat(&beside) - change) / DIFFERENCE;
        }
        let Some(inverse) = Matrix2::from_columns(&columns).try_inverse() else { return Ok(None) };
        let step = -(inverse * change);
        let mut share = (LONGEST_STEP / step.norm()).min(1.0);
        for _ in 0..=HALVINGS {
            let at = self.from + (frame[0] * step.x + frame[1] * step.y) * share;
            let found = map(at.normalize())?;
            if found.change < self.change {
                return Ok(Some(found));
            }
            share *= 0.5;
        }
        Ok(None)
    }
}

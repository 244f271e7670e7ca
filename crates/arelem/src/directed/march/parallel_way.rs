//! Straight ways on which the path is parallel to a check surface: along the extension of a tabulated cylinder that lies in the line to
//! which that is tangent, or above the line on which a bar and the part surface touch.

use apt_geometry::patience::Patience;

use super::{Vertex, tangency::Sides};
use crate::{clearance::Gauge, directed::Prepared, error::MotionFailure};

/// Sine of the angle between path and check surface up to which they may be meant to be parallel: what the decimals of a slope leave.
const NEARLY: f64 = 1e-4;
/// How much that sine, or the direction of the path, changes on a way by rounding.
const STEADY: f64 = 1e-9;
/// How far a way leads on at least, relative to the size of the coordinates: where a curve begins to bend with its third derivative alone, the
/// sine is rounding for a third of that.
const LEAST: f64 = 1e-4;
/// The longest step along a way as far as there may be surfaces, and how far that is, relative to the size of the coordinates.
const STEP: f64 = 0.02;
const SURFACES: f64 = 4.0;
/// A way that goes on so far, relative to the size of the coordinates, has no end.
const ENDLESS: f64 = 1e5;
/// Bound of the bisection of the last step.
const MAX_HALVINGS: u32 = 60;

/// Such a way, from a place on it.
pub(super) struct ParallelWay<'a> {
    prepared: &'a Prepared<'a>,
    /// Of the check surface, on the side on which the tool is nearer to it.
    gauge: &'a Gauge,
    patience: Patience<'a>,
    origin: Vertex,
    slope: f64,
}

/// How far a way leads back and ahead from a place on it; `None` where it has no end.
pub(super) struct Reach {
    pub(super) back: Option<f64>,
    pub(super) ahead: Option<f64>,
}

impl<'a> ParallelWay<'a> {
    /// The way that leads on from a place where the check surface's clearance changes at this rate.
    pub(super) fn from(
        prepared: &'a Prepared<'a>,
        check: &'a Sides,
        (place, slope): (&Vertex, f64),
        patience: Patience<'a>,
    ) -> Result<Option<Self>, MotionFailure> {
        if slope.abs() > NEARLY {
            return Ok(None);
        }
        let Some(origin) = Vertex::settled(prepared, &place.tip, &place.tangent) else { return Ok(None) };
        let (contact, side) = check.nearer(prepared, &origin.tip)?;
        let slope = (contact.gradient * side).dot(&origin.tangent);
        let way = Self { prepared, gauge: check.on(side), patience, origin, slope };
        Ok(way.is_on(LEAST * prepared.size).then_some(way))
    }

    /// A place on it, on the path at rest.
    pub(super) fn at(&self, x: f64) -> Result<Vertex, MotionFailure> {
        Vertex::at(self.prepared, self.origin.tip + self.origin.tangent * x, &self.origin.tangent)
    }

    /// Whether it leads to a place. Without a tool axis there is none.
    fn is_on(&self, x: f64) -> bool {
        let (Ok(there), size) = (self.at(x), self.prepared.size) else { return false };
        let Ok(posture) = self.prepared.attitude.posture(&there.tip) else { return false };
        // Far away the coordinates themselves are rounded.
        let rounding = STEADY * (1.0 + x.abs() / size);
        let is_straight = (there.tangent - self.origin.tangent).norm() <= rounding;
        let slope = || {
            let contact = posture.contact(self.gauge, &there.tip);
            (contact.gradient * self.gauge.side).dot(&there.tangent)
        };
        is_straight && (slope() - self.slope).abs() <= rounding
    }

    /// How far it leads.
    pub(super) fn reach(&self) -> Result<Reach, MotionFailure> {
        Ok(Reach { back: self.reach_towards(-1.0)?, ahead: self.reach_towards(1.0)? })
    }

    fn reach_towards(&self, sense: f64) -> Result<Option<f64>, MotionFailure> {
        let size = self.prepared.size;
        let (mut on, mut step) = (0.0, LEAST * size);
        while on < ENDLESS * size {
            self.ask()?;
            if !self.is_on(sense * (on + step)) {
                return self.last_on(sense, [on, on + step]).map(Some);
            }
            on += step;
            let is_beyond = on > SURFACES * size;
            step = if is_beyond { 2.0 * step } else { (2.0 * step).min(STEP * size) };
        }
        Ok(None)
    }

    /// Where it ends between a place on it and one that is not.
    fn last_on(&self, sense: f64, [mut on, mut beyond]: [f64; 2]) -> Result<f64, MotionFailure> {
        for _ in 0..MAX_HALVINGS {
            self.ask()?;
            let middle = 0.5 * (on + beyond);
            if middle <= on || middle >= beyond {
                break;
            }
            if self.is_on(sense * middle) {
                on = middle;
            } else {
                beyond = middle;
            }
        }
        Ok(on)
    }

    /// Whether to go on.
    fn ask(&self) -> Result<(), MotionFailure> {
        if self.patience.is_over() { Err(MotionFailure::Cancelled) } else { Ok(()) }
    }

    /// The rate at which the clearance of the check surface changes on it.
    pub(super) fn slope(&self) -> f64 {
        self.slope
    }
}

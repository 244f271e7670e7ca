//! Progress towards the check surfaces: a path that leaves them behind on a straight course does not come back, and need not
//! run out of points before that is said.

use super::Vertex;

/// How far the path must have gone since its nearest approach, relative to the size of the coordinates.
const FAR: f64 = 50.0;
/// Greatest turn, radians, over that way for the course to count as straight: a closed path would have to be longer than six
/// thousand times the way.
const STRAIGHT: f64 = 1e-3;

/// What has happened since the nearest approach to a check surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Progress {
    nearest: f64,
    receded: f64,
    turned: f64,
}

impl Progress {
    pub(super) fn new() -> Self {
        Self { nearest: f64::INFINITY, receded: 0.0, turned: 0.0 }
    }

    /// Takes note of a cut vector, after which the nearest approach is `nearest`; true if no check surface lies ahead.
    pub(super) fn is_lost(&mut self, nearest: f64, from: &Vertex, to: &Vertex, size: f64) -> bool {
        if nearest < self.nearest {
            *self = Self { nearest, receded: 0.0, turned: 0.0 };
            return false;
        }
        self.receded += (to.tip - from.tip).norm();
        self.turned += from.tangent.cross(&to.tangent).norm().atan2(from.tangent.dot(&to.tangent));
        nearest.is_finite() && self.receded > FAR * (size + nearest) && self.turned < STRAIGHT
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::motion::{MotionCommand, Relation, Turn};

    use crate::{
        error::MotionFailure,
        tests::{Program, circle, cylinder, motion, plane, v},
    };

    /// A ball on a cylinder along x, on its way towards −x or +x.
    fn on_the_back() -> Program {
        let mut p = Program::new();
        p.cutter(&[0.5, 0.25]).from(0.0, 0.0, 3.0);
        let (back, middle) = (cylinder(v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), 1.0), plane(0.0, 1.0, 0.0, 0.0));
        p.go(&[(Relation::On, &middle), (Relation::To, &back), (Relation::On, &plane(1.0, 0.0, 0.0, 0.0))]);
        p.indirv(1.0, 0.0, 0.0);
        p
    }

    #[test]
    fn a_check_surface_left_behind_is_never_met() {
        let middle = plane(0.0, 1.0, 0.0, 0.0);
        let mut p = on_the_back();
        let behind = motion(Turn::Forward, &middle, &[(Relation::To, 1, &plane(1.0, 0.0, 0.0, -5.0))]);
        let failure = p.attempt(&behind).expect_err("it lies behind");
        let MotionFailure::NeverMet { check: 0, nearest, at, .. } = failure else { panic!("{failure:?}") };
        assert!((nearest - 4.75).abs() < 1e-9 && at.x.abs() < 1e-6, "{nearest} at {at:?}");
    }

    #[test]
    fn a_check_surface_far_ahead_is_met() {
        let middle = plane(0.0, 1.0, 0.0, 0.0);
        let mut p = on_the_back();
        p.drive(Turn::Forward, &middle, Relation::To, &plane(1.0, 0.0, 0.0, 2000.0)).verified();
        assert!((p.tip().x - 1999.75).abs() < 1e-6, "{:?}", p.tip());
    }

    #[test]
    fn a_large_circle_comes_back() {
        // The path leaves the check surface for 60,000 units before it comes round.
        let (ring, floor) = (circle(0.0, 0.0, 20_000.0), plane(0.0, 0.0, 1.0, 0.0));
        let mut p = Program::new();
        p.tolerance(0.0, 5.0).cutter(&[0.5, 0.25]).from(20_100.0, 5.0, 0.0);
        p.run(&MotionCommand::ForceIteration(true)).run(&MotionCommand::MaximumStep(1e5));
        p.go(&[(Relation::To, &ring), (Relation::To, &floor)]);
        p.side(apt_geometry::motion::DriveSide::Left);
        p.drive(Turn::Left, &ring, Relation::On, &plane(0.0, 1.0, 0.0, 100.0));
        assert!((p.tip().y - 100.0).abs() < 5.1, "{:?}", p.tip());
        assert!(p.last().points.len() > 20, "all the way round: {}", p.last().points.len());
    }
}

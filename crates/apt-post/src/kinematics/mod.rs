//! Rotary axes: which angles point the tool along an axis of the part, and where the slides stand then.
//!
//! A machine is a chain from the part to the tool. Angles have the sign of ISO 841: positive is the turn of the tool relative to
//! the part about the positive axis, so that a table turns the other way.

pub(crate) mod divide;
mod follow;
pub(crate) mod plan;
mod solve;
#[cfg(test)]
mod tests;

use apt_geometry::{Vec3, canonical::matrix::sine_cosine_degrees};

/// Angles of both rotary axes, degrees, ISO sign (tool relative to part), part side first. A machine with one rotary axis has
/// a second one that is held at 0.
pub(crate) type Angles = [f64; 2];

/// What a rotary axis turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Carried {
    /// The table, and the part on it.
    Table,
    /// The head, and the tool in it.
    Head,
}

/// A rotary axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rotary {
    /// Direction of the axis while all angles are 0; a unit vector.
    pub vector: Vec3,
    /// What it turns.
    pub carried: Carried,
    /// Least and greatest angle, degrees; infinite where it turns without end. Equal where it is held.
    pub limits: [f64; 2],
    /// A place on it while all angles are 0, tape units; counts for tables only.
    pub center: Vec3,
    /// Sign of the angle that is preferred: 1 or −1.
    pub prefer: Option<f64>,
}

impl Rotary {
    /// Whether it cannot turn.
    fn is_held(&self) -> bool {
        self.limits[0] >= self.limits[1]
    }

    /// The angle within the limits that is nearest.
    fn held_within(&self, angle: f64) -> f64 {
        angle.min(self.limits[1]).max(self.limits[0])
    }

    /// The turn of the tool relative to the part.
    fn turn(&self, degrees: f64) -> Mat3 {
        Mat3::about(&self.vector, degrees)
    }
}

/// The rotary axes of a machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kinematics {
    /// Both axes, the one nearest to the part first.
    pub axes: [Rotary; 2],
    /// From the axes of the head to the tool end, tape units.
    pub pivot: f64,
    /// Radians: a tool axis this near to the first rotary axis is along it, which is the pole.
    pub dead_cone: f64,
    /// Whether the tape tells slides; otherwise the control follows the tool end itself.
    pub slides: bool,
}

impl Kinematics {
    /// Direction of the tool in the part.
    pub(crate) fn axis(&self, angles: Angles) -> Vec3 {
        self.axes[0].turn(angles[0]) * (self.axes[1].turn(angles[1]) * Vec3::z())
    }

    /// Words of the tape from places of the part while the rotary axes stand so.
    pub(crate) fn frame(&self, angles: Angles) -> Frame {
        if !self.slides {
            return Frame {
                rotation: Mat3::IDENTITY,
                translation: Vec3::zeros(),
                spindle: self.axis(angles),
            };
        }
        let mut rotation = Mat3::IDENTITY;
        let mut translation = Vec3::zeros();
        let mut head = Mat3::IDENTITY;
        for (rotary, angle) in self.axes.iter().zip(angles) {
            match rotary.carried {
                Carried::Table => {
                    let back = rotary.turn(-angle);
                    rotation = back * rotation;
                    translation = back * (translation - rotary.center) + rotary.center;
                }
                Carried::Head => head = head * rotary.turn(angle),
            }
        }
        let spindle = head * Vec3::z();
        Frame { rotation, translation: translation + (spindle - Vec3::z()) * self.pivot, spindle }
    }
}

/// Words of the tape from places of the part: word = rotation · place + translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// How the tables turn the part.
    pub rotation: Mat3,
    /// Where they and the head take the origin of the part.
    pub translation: Vec3,
    /// Direction of the tool in the frame of the words.
    pub spindle: Vec3,
}

impl Frame {
    /// The words of the tape at a place of the part.
    pub(crate) fn place(&self, part: Vec3) -> Vec3 {
        self.rotation * part + self.translation
    }

    /// The place of the part at words of the tape.
    pub(crate) fn part(&self, word: Vec3) -> Vec3 {
        self.rotation.transposed() * (word - self.translation)
    }
}

/// A turn about the origin, as an orthogonal matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Mat3 {
    /// The images of the three coordinate directions.
    columns: [Vec3; 3],
}

impl Mat3 {
    /// No turn.
    pub(crate) const IDENTITY: Mat3 =
        Mat3 { columns: [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)] };

    /// The turn about a unit vector by the right-hand rule; exact at multiples of 90 degrees about coordinate directions.
    pub(crate) fn about(unit: &Vec3, degrees: f64) -> Mat3 {
        let (sine, cosine) = sine_cosine_degrees(degrees);
        let image =
            |of: Vec3| of * cosine + unit.cross(&of) * sine + *unit * (unit.dot(&of) * (1.0 - cosine));
        Mat3 { columns: Mat3::IDENTITY.columns.map(image) }
    }

    /// The turn back.
    pub(crate) fn transposed(&self) -> Mat3 {
        let [x, y, z] = self.columns;
        Mat3 { columns: [Vec3::new(x.x, y.x, z.x), Vec3::new(x.y, y.y, z.y), Vec3::new(x.z, y.z, z.z)] }
    }
}

impl std::ops::Mul<Vec3> for Mat3 {
    type Output = Vec3;

    fn mul(self, of: Vec3) -> Vec3 {
        let [x, y, z] = self.columns;
        x * of.x + y * of.y + z * of.z
    }
}

impl std::ops::Mul for Mat3 {
    type Output = Mat3;

    fn mul(self, first: Mat3) -> Mat3 {
        Mat3 { columns: first.columns.map(|column| self * column) }
    }
}

/// Angle between two directions, radians; as exact for small angles as for others.
pub(crate) fn angle_between(a: &Vec3, b: &Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

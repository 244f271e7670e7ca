//! Balls that no place of a surface lies in: what they tell of distances holds beside ends and creases, too, where nothing bounds how the
//! distance bends.
//!
//! The distance of a place from a surface is no less than that of another place, less the way between them. From a middle far off,
//! straight above a foot, that loses little for places beside the foot: `|y|²/2r` at a distance of `y` and a height of `r`, where a bound
//! of the distance alone loses `|y|`.

use apt_geometry::Vec3;

use super::{certify::Face, floor::Base};

/// A ball without a place of the surface, on the tool's side of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Empty {
    middle: Vec3,
    radius: f64,
}

impl Empty {
    /// The greatest about a place so far above a base, along its gradient.
    pub(super) fn above(face: Face<'_>, base: &Base, height: f64) -> Self {
        let middle = base.place + base.gradient * height;
        Self { middle, radius: face.side * face.surface.foot(&middle).distance }
    }

    /// What it tells of the distance about a place in it: how much it is there at least, how that grows, and how it bends downward.
    pub(super) fn about(&self, place: &Vec3) -> Option<(Base, f64)> {
        let way = self.middle - place;
        let away = way.norm();
        (away > 0.0).then(|| {
            let base = Base { place: *place, distance: self.radius - away, gradient: way / away };
            (base, away.recip())
        })
    }
}

#[cfg(test)]
mod tests {
    use apt_geometry::{
        canonical::{Geometry, Sphere},
        surface::Surface,
    };
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Of a hollow sphere, beside whose foot the distance falls.
        #[test]
        fn no_place_is_nearer_than_an_empty_ball_tells(
            start in 0.1..2.9f64, height in 0.1..5.0f64, off in proptest::array::uniform3(-0.5..0.5f64), onward in 0.0..1.0f64,
        ) {
            let sphere = Sphere { center: Vec3::zeros(), radius: 3.0 };
            let surface = Surface::from_geometry(&Geometry::Sphere(sphere)).expect("surface");
            let face = Face { surface: &surface, side: -1.0 };
            let base = Base::at(&surface, face.side, Vec3::x() * start);
            let empty = Empty::above(face, &base, height);
            let place = base.place + base.gradient * (onward * height) + Vec3::from(off);
            let (about, bend) = empty.about(&place).expect("a place beside the middle");
            for step in [Vec3::zeros(), Vec3::from(off).yzx(), Vec3::from(off).zxy() * 3.0] {
                let least = about.distance + about.gradient.dot(&step) - 0.5 * bend * step.norm_squared();
                prop_assert!(3.0 - (place + step).norm() >= least - 1e-12);
            }
        }
    }
}

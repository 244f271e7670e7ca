//! Whether the curves of a RLDSRF can be found on their surfaces (language reference 4.16). The definition itself takes any
//! points; a curve is what the direction across the chord meets of the surface.

use crate::canonical::{RuledCurve, RuledEnd, RuledSurface};
use crate::surface::{RootSelection, Surface};

/// Distance of an end point from its surface, relative to the chord, that is more than the decimals of its numbers.
const LEAST_MISFIT: f64 = 1e-3;

/// What is wrong with a curve of a ruled surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RuledFault {
    /// The direction across does not meet the surface from the middle of the chord: there is no curve.
    NotMet {
        /// Which curve, from 1.
        curve: usize,
    },
    /// The end points do not lie on the surface; the curve runs past them.
    OffSurface {
        /// Which curve, from 1.
        curve: usize,
        /// Distances of the first and the second end point from the surface, in part-program units.
        distances: [f64; 2],
    },
}

/// The faults of the curves, in order. Surfaces that are none, from CANON, are left out.
pub fn ruled_faults(surface: &RuledSurface) -> Vec<RuledFault> {
    let Some((first, end)) = surface.curves() else { return Vec::new() };
    let second = match end {
        RuledEnd::Curve(second) => Some(second),
        RuledEnd::Apex(_) => None,
    };
    let curves = [Some(first), second];
    curves.iter().enumerate().filter_map(|(index, curve)| fault(curve.as_ref()?, index + 1)).collect()
}

fn fault(of: &RuledCurve<'_>, curve: usize) -> Option<RuledFault> {
    let surface = Surface::from_geometry(of.surface).ok()?;
    let chord = of.end - of.start;
    let middle = of.start + chord * 0.5;
    if surface.directed_distance(&middle, &of.across, RootSelection::AheadElseNearest).is_err() {
        return Some(RuledFault::NotMet { curve });
    }
    let distances = [of.start, of.end].map(|point| surface.foot(&point).distance.abs());
    let off = distances.iter().any(|distance| *distance > LEAST_MISFIT * chord.norm());
    off.then_some(RuledFault::OffSurface { curve, distances })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::canonical::{Geometry, Plane, Sphere};

    fn ruled(surface: Geometry, ends: [Vec3; 2], across: Vec3) -> RuledSurface {
        let [start, end] = ends.map(Geometry::Point);
        RuledSurface {
            parts: vec![surface, start, end, Geometry::Vector(across), Geometry::Point(Vec3::zeros())],
        }
    }

    #[test]
    fn points_off_a_surface_and_directions_past_it_are_faults() {
        let floor = || Geometry::Plane(Plane { normal: Vec3::z(), distance: 1.0 });
        let ends = |z: f64| [Vec3::new(0.0, 0.0, z), Vec3::new(4.0, 0.0, z)];
        assert_eq!(ruled_faults(&ruled(floor(), ends(1.0), Vec3::z())), []);
        assert_eq!(ruled_faults(&ruled(floor(), ends(1.003), Vec3::z())), []);
        let distances = [0.5, 0.5];
        let off = RuledFault::OffSurface { curve: 1, distances };
        assert_eq!(ruled_faults(&ruled(floor(), ends(1.5), Vec3::z())), [off]);
        let past = [RuledFault::NotMet { curve: 1 }];
        assert_eq!(ruled_faults(&ruled(floor(), ends(1.5), Vec3::y())), past);
        let ball = Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 1.0 });
        assert_eq!(ruled_faults(&ruled(ball, ends(9.0), Vec3::y())), past);
        assert_eq!(ruled_faults(&RuledSurface { parts: Vec::new() }), []);
    }

    #[test]
    fn a_chord_through_a_diameter_is_none() {
        let ball = Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 1.0 });
        let ends = [Vec3::new(-1.000_001, 0.0, 0.0), Vec3::new(1.000_001, 0.0, 0.0)];
        assert_eq!(ruled_faults(&ruled(ball, ends, Vec3::z())), []);
    }
}

//! Definitions that are accepted although they are hardly meant (language reference 9.5).

use apt_geometry::{
    canonical::Geometry,
    definition::{self, Argument, Modifier},
};
use apt_syntax::TextRange;
use smol_str::SmolStr;

use crate::{evaluator::Evaluator, finding::FindingKind};

/// By how much the length of a direction given by CANON may differ from 1: numbers with four decimals stay below it.
const UNIT_LENGTH_TOLERANCE: f64 = 1e-4;

impl Evaluator<'_> {
    /// Warns of a word that chooses nothing, of a count, a radius, a half axis and an angle that is not positive, of a quadric without coefficients, and of
    /// a direction given by CANON that is no unit vector.
    pub(super) fn report_doubtful_geometry(
        &mut self,
        geometry: &Geometry,
        arguments: &[Argument],
        range: TextRange,
    ) {
        let value = doubtful_value(geometry, arguments);
        if let Some(value) = value {
            let statement = SmolStr::new_static(geometry.kind().word());
            self.report(FindingKind::Doubtful { statement, value }, range);
        }
        if let Some(word) = definition::idle_selector(geometry.kind(), arguments) {
            self.report(FindingKind::IdleSelector { word: SmolStr::new_static(word.word()) }, range);
        }
        if arguments.first() == Some(&Argument::Modifier(Modifier::Canon))
            && let Some((length, normalised)) = unit_values(geometry)
        {
            let kind = geometry.kind();
            self.report(FindingKind::NotNormalised { kind, length, normalised }, range);
        }
    }
}

/// A number of the definition, or of what it gives, that is accepted although nothing can be made of it.
fn doubtful_value(geometry: &Geometry, arguments: &[Argument]) -> Option<f64> {
    let given = |index: usize| match arguments.get(index) {
        Some(Argument::Scalar(value)) => Some(*value),
        _ => None,
    };
    let by_canon = arguments.contains(&Argument::Modifier(Modifier::Canon));
    let not_positive = |value: f64| value <= 0.0;
    match geometry {
        // After INCR an increment stands last.
        Geometry::Pattern(_) if !arguments.contains(&Argument::Modifier(Modifier::Increment)) => {
            given(arguments.len().checked_sub(1)?).map(f64::trunc).filter(|count| *count < 1.0)
        }
        Geometry::Circle(round) | Geometry::Cylinder(round) => {
            Some(round.radius).filter(|r| not_positive(*r))
        }
        Geometry::Sphere(sphere) => Some(sphere.radius).filter(|r| not_positive(*r)),
        Geometry::Cone(_) if !by_canon => given(2).filter(|degrees| not_positive(*degrees)),
        Geometry::Ellipse(_) | Geometry::Hyperbola(_) if !by_canon => {
            [given(2)?, given(3)?].into_iter().find(|axis| not_positive(*axis))
        }
        Geometry::Quadric(quadric) | Geometry::GeneralConic(quadric) => {
            // The constant alone, the fourth number, makes no surface.
            let mut terms = quadric.coefficients.iter().enumerate().filter(|(index, _)| *index != 3);
            terms.all(|(_, value)| *value == 0.0).then_some(0.0)
        }
        _ => None,
    }
}

/// The length of the direction, where it should be 1 and is not, and the canonical values with a unit direction: none
/// if there is no direction at all.
fn unit_values(geometry: &Geometry) -> Option<(f64, Vec<f64>)> {
    // Where the direction stands among the values, and whether a distance along it follows.
    let (first, distance) = match geometry {
        Geometry::Line(_) | Geometry::Plane(_) => (0, Some(3)),
        Geometry::Circle(_) | Geometry::Cylinder(_) | Geometry::Cone(_) => (3, None),
        _ => return None,
    };
    let mut values = geometry.canonical_values();
    let length = values.get(first..first + 3)?.iter().fold(0.0_f64, |sum, part| sum.hypot(*part));
    if !length.is_finite() || (length - 1.0).abs() <= UNIT_LENGTH_TOLERANCE {
        return None;
    }
    if length == 0.0 {
        return Some((length, Vec::new()));
    }
    for index in (first..first + 3).chain(distance) {
        if let Some(value) = values.get_mut(index) {
            *value /= length;
        }
    }
    Some((length, values))
}

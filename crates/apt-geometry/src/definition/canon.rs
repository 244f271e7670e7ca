//! CANON forms (language reference 4.18): canonical values as they are, or a copy with some of them replaced.

use super::choice::ZERO_COMPONENT;
use super::{Argument, DefinitionError, Impossible, Modifier};
use crate::canonical::{Geometry, GeometryKind, Plane};

/// APT III: no form of the type begins like this.
const NO_CANON: u16 = 1000;

/// `TYPE/CANON,v1,…,vn` or `TYPE/surface,CANON,v1,…`.
pub(super) fn define(kind: GeometryKind, arguments: &[Argument]) -> Result<Geometry, DefinitionError> {
    match arguments {
        [Argument::Modifier(Modifier::Canon), values @ ..] => build(kind, values),
        [Argument::Geometry(source), Argument::Modifier(Modifier::Canon), values @ ..] => {
            copy(kind, source, values)
        }
        _ => Err(DefinitionError::UnknownFormat { kind }),
    }
}

fn build(kind: GeometryKind, arguments: &[Argument]) -> Result<Geometry, DefinitionError> {
    if matches!(kind, GeometryKind::RuledSurface | GeometryKind::Pattern) {
        return Err(DefinitionError::Special { number: NO_CANON, position: Some(0) });
    }
    let mut values = Vec::with_capacity(arguments.len());
    for (index, argument) in arguments.iter().enumerate() {
        match argument {
            Argument::Scalar(value) => values.push(*value),
            // One past the word CANON.
            _ => return Err(DefinitionError::Special { number: 83, position: Some(index + 1) }),
        }
    }
    // LINE is stored with its four numbers; so the count is that of the type everywhere.
    Ok(Geometry::from_canonical(kind, &values)?)
}

/// The values given replace those of the source; empty positions keep theirs. The result is normalised and tested
/// where APT III does so.
fn copy(kind: GeometryKind, source: &Geometry, arguments: &[Argument]) -> Result<Geometry, DefinitionError> {
    if source.kind() != kind {
        return Err(DefinitionError::CanonicalKind { expected: kind, found: source.kind() });
    }
    if matches!(kind, GeometryKind::RuledSurface | GeometryKind::Pattern) {
        return Err(DefinitionError::Special { number: NO_CANON, position: Some(1) });
    }
    let mut values = source.canonical_values();
    if arguments.len() > values.len() {
        return Err(DefinitionError::CanonicalCount { expected: values.len(), found: arguments.len() });
    }
    for (index, (value, argument)) in values.iter_mut().zip(arguments).enumerate() {
        match argument {
            Argument::Scalar(replacement) => *value = *replacement,
            Argument::Empty => {}
            // The source and the word CANON come first.
            _ => return Err(DefinitionError::Special { number: 83, position: Some(index + 2) }),
        }
    }
    Ok(normalised(Geometry::from_canonical(kind, &values)?)?)
}

fn normalised(geometry: Geometry) -> Result<Geometry, Impossible> {
    let plane = |plane: Plane| {
        if plane.normal.amax() <= ZERO_COMPONENT {
            return Err(Impossible::ZeroVector);
        }
        Plane::from_equation(plane.normal.x, plane.normal.y, plane.normal.z, plane.distance)
            .ok_or(Impossible::ZeroVector)
    };
    let positive = |value: f64| if value > 0.0 { Ok(value) } else { Err(Impossible::NotPositive { value }) };
    Ok(match geometry {
        Geometry::Line(line) => Geometry::Line(plane(line)?),
        Geometry::Plane(value) => Geometry::Plane(plane(value)?),
        Geometry::Circle(mut circle) => {
            circle.axis = circle.axis.try_normalize(ZERO_COMPONENT).ok_or(Impossible::ZeroVector)?;
            positive(circle.radius)?;
            Geometry::Circle(circle)
        }
        Geometry::Cylinder(mut cylinder) => {
            cylinder.axis = cylinder.axis.try_normalize(ZERO_COMPONENT).ok_or(Impossible::ZeroVector)?;
            positive(cylinder.radius)?;
            Geometry::Cylinder(cylinder)
        }
        Geometry::Sphere(sphere) => {
            positive(sphere.radius)?;
            Geometry::Sphere(sphere)
        }
        other => other,
    })
}

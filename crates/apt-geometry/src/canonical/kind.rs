//! The type words of definitions.

use super::GeometryKind;

/// Every kind with its word, the number that APT III adds to 3000 for its surface code, and the count of canonical
/// values where that is fixed (language reference 3.3).
const KINDS: [(GeometryKind, &str, u16, Option<usize>); 23] = [
    (GeometryKind::Point, "POINT", 1, Some(3)),
    (GeometryKind::Line, "LINE", 2, Some(4)),
    (GeometryKind::Plane, "PLANE", 3, Some(4)),
    (GeometryKind::Circle, "CIRCLE", 4, Some(7)),
    (GeometryKind::Cylinder, "CYLNDR", 5, Some(7)),
    (GeometryKind::Ellipse, "ELLIPS", 6, Some(10)),
    (GeometryKind::Hyperbola, "HYPERB", 7, Some(10)),
    (GeometryKind::Cone, "CONE", 8, Some(7)),
    (GeometryKind::GeneralConic, "GCONIC", 9, Some(10)),
    (GeometryKind::LoftConic, "LCONIC", 10, Some(10)),
    (GeometryKind::Vector, "VECTOR", 11, Some(3)),
    (GeometryKind::Matrix, "MATRIX", 12, Some(12)),
    (GeometryKind::Sphere, "SPHERE", 13, Some(4)),
    (GeometryKind::Quadric, "QADRIC", 14, Some(10)),
    (GeometryKind::PolyConic, "POLCON", 15, Some(79)),
    (GeometryKind::Loft, "LOFT", 16, Some(8)),
    (GeometryKind::TabulatedCylinder, "TABCYL", 50, None),
    (GeometryKind::RuledSurface, "RLDSRF", 53, None),
    (GeometryKind::Pattern, "PATERN", 18, None),
    (GeometryKind::Mesh, "MESH", 51, None),
    (GeometryKind::ElementSurface, "ELMSRF", 54, None),
    (GeometryKind::Sculptured, "SSURF", 29, None),
    (GeometryKind::SpaceCurve, "SCURV", 30, None),
];

impl GeometryKind {
    /// Every kind, in the order of the APT III type numbers (the large surfaces last).
    pub fn all() -> impl Iterator<Item = GeometryKind> {
        KINDS.iter().map(|entry| entry.0)
    }

    /// The kind that a type word names, in upper case.
    pub fn from_word(word: &str) -> Option<GeometryKind> {
        KINDS.iter().find(|entry| entry.1 == word).map(|entry| entry.0)
    }

    /// The type word of the language.
    pub fn word(self) -> &'static str {
        self.entry().map_or("", |entry| entry.1)
    }

    /// The surface code that CL files carry for this type: 3000 plus the type number.
    pub fn surface_code(self) -> u16 {
        3000 + self.entry().map_or(0, |entry| entry.2)
    }

    /// How many canonical values the type has; `None` where the number depends on the data.
    pub fn canonical_count(self) -> Option<usize> {
        self.entry().and_then(|entry| entry.3)
    }

    /// Whether the type can be a part, drive or check surface.
    pub fn is_surface(self) -> bool {
        !matches!(
            self,
            GeometryKind::Point
                | GeometryKind::Vector
                | GeometryKind::Matrix
                | GeometryKind::Pattern
                | GeometryKind::SpaceCurve
        )
    }

    fn entry(self) -> Option<&'static (GeometryKind, &'static str, u16, Option<usize>)> {
        KINDS.iter().find(|entry| entry.0 == self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_names_its_kind() {
        for kind in GeometryKind::all() {
            assert!(!kind.word().is_empty());
            assert_eq!(GeometryKind::from_word(kind.word()), Some(kind));
            assert!(kind.surface_code() > 3000);
        }
        assert_eq!(GeometryKind::all().count(), 23);
        assert_eq!(GeometryKind::from_word("GOTO"), None);
    }
}

//! Canonical forms in words: what each number means.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, GeometryKind},
    parametric::{CurveArc, FlowKind, Patch, SculpturedSurface},
};
use apt_program::symbols::Value;

/// A name's value in canonical form.
#[derive(Debug, Clone, PartialEq)]
pub struct CanonicalForm {
    /// The name, with its subscript.
    pub name: String,
    /// The type word, or `SCALAR`.
    pub kind: String,
    /// The numbers; none for a pattern and a ruled surface.
    pub canonical: Vec<f64>,
    /// What each number means.
    pub meaning: Vec<String>,
    /// One line that says what it is.
    pub text: String,
}

impl CanonicalForm {
    /// The canonical form of a value.
    pub fn new(name: &str, value: &Value) -> Self {
        let (kind, canonical, meaning, text) = match value {
            Value::Scalar(scalar) => ("SCALAR", vec![*scalar], vec!["value".to_owned()], number(*scalar)),
            Value::Geometry(geometry) => {
                let values = geometry.canonical_values();
                let meaning = meaning(geometry.kind(), values.len());
                (geometry.kind().word(), values, meaning, sentence(geometry))
            }
        };
        Self { name: name.to_owned(), kind: kind.to_owned(), canonical, meaning, text }
    }

    /// A hover of the form.
    pub fn markdown(&self) -> String {
        if self.kind == "SCALAR" {
            return format!("```apt\n{}={}\n```\nscalar", self.name, self.text);
        }
        let mut markdown = format!("```apt\n{}={}\n```\n{}\n", self.name, self.kind, self.text);
        /// Longer forms would fill the screen and say nothing.
        const GREATEST_TABLE: usize = 12;
        if !self.canonical.is_empty() && self.canonical.len() <= GREATEST_TABLE {
            markdown.push_str("\n| | canonical |\n|---|---|\n");
            for (value, meaning) in self.canonical.iter().zip(&self.meaning) {
                markdown.push_str(&format!("| {meaning} | {} |\n", number(*value)));
            }
        }
        markdown
    }
}

/// A number as a part programmer reads it: nine significant digits, no trailing zeros.
pub fn number(value: f64) -> String {
    let value = value + 0.0;
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    /// Significant digits shown.
    const DIGITS: i32 = 9;
    let magnitude = value.abs().log10().floor() as i32;
    if !(-6..15).contains(&magnitude) {
        let text = format!("{value:.*e}", DIGITS as usize - 1);
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", digits.trim_end_matches('0').trim_end_matches('.'));
    }
    let decimals = (DIGITS - 1 - magnitude).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

fn meaning(kind: GeometryKind, count: usize) -> Vec<String> {
    let names: &[&str] = match kind {
        GeometryKind::Point => &["x", "y", "z"],
        GeometryKind::Vector => &["i", "j", "k"],
        GeometryKind::Line | GeometryKind::Plane => {
            &["a (unit normal x)", "b (unit normal y)", "c (unit normal z)", "d (distance from the origin)"]
        }
        GeometryKind::Circle => &["centre x", "centre y", "centre z", "axis i", "axis j", "axis k", "radius"],
        GeometryKind::Cylinder => {
            &["axis point x", "axis point y", "axis point z", "axis i", "axis j", "axis k", "radius"]
        }
        GeometryKind::Sphere => &["centre x", "centre y", "centre z", "radius"],
        GeometryKind::Cone => {
            &["vertex x", "vertex y", "vertex z", "axis i", "axis j", "axis k", "cosine of the half angle"]
        }
        GeometryKind::Ellipse
        | GeometryKind::Hyperbola
        | GeometryKind::GeneralConic
        | GeometryKind::LoftConic
        | GeometryKind::Quadric => &[
            "A (x²)", "B (y²)", "C (z²)", "D (1)", "F (2yz)", "G (2xz)", "H (2xy)", "P (2x)", "Q (2y)",
            "R (2z)",
        ],
        GeometryKind::Matrix => &[
            "a11",
            "a12",
            "a13",
            "a14 (shift x)",
            "a21",
            "a22",
            "a23",
            "a24 (shift y)",
            "a31",
            "a32",
            "a33",
            "a34 (shift z)",
        ],
        _ => &[],
    };
    (0..count)
        .map(|index| names.get(index).map_or_else(|| format!("{}", index + 1), |name| (*name).to_owned()))
        .collect()
}

pub(super) fn triple(vector: &apt_geometry::Vec3) -> String {
    format!("({}, {}, {})", number(vector.x), number(vector.y), number(vector.z))
}

fn sentence(geometry: &Geometry) -> String {
    match geometry {
        Geometry::Point(point) => format!("point {}", triple(point)),
        Geometry::Vector(vector) => format!("vector {} of length {}", triple(vector), number(vector.norm())),
        Geometry::Line(line) => {
            let angle = (-line.normal.x).atan2(line.normal.y).to_degrees();
            format!("line {}, at {}° to the x axis", plane(line), number(angle.rem_euclid(180.0)))
        }
        Geometry::Plane(one) => format!("plane {}", plane(one)),
        Geometry::Circle(circle) => {
            format!(
                "circle of radius {} about ({}, {})",
                number(circle.radius),
                number(circle.point.x),
                number(circle.point.y)
            )
        }
        Geometry::Cylinder(one) => format!(
            "cylinder of radius {} about the axis through {} along {}",
            number(one.radius),
            triple(&one.point),
            triple(&one.axis)
        ),
        Geometry::Sphere(sphere) => {
            format!("sphere of radius {} about {}", number(sphere.radius), triple(&sphere.center))
        }
        Geometry::Cone(cone) => format!(
            "cone with vertex {}, opening along {}, half angle {}°",
            triple(&cone.vertex),
            triple(&cone.axis),
            number(cone.cosine.clamp(-1.0, 1.0).acos().to_degrees())
        ),
        Geometry::Ellipse(_) => "ellipse (a cylinder parallel to z)".to_owned(),
        Geometry::Hyperbola(_) => "hyperbola (a cylinder parallel to z)".to_owned(),
        Geometry::GeneralConic(_) | Geometry::LoftConic(_) => "conic (a cylinder parallel to z)".to_owned(),
        Geometry::Quadric(_) => "quadric Ax²+By²+Cz²+D+2Fyz+2Gxz+2Hxy+2Px+2Qy+2Rz = 0".to_owned(),
        Geometry::Matrix(_) => "matrix, by rows; the fourth column is the shift".to_owned(),
        Geometry::TabulatedCylinder(cylinder) => {
            format!(
                "tabulated cylinder of {} intervals, the first and last being its extensions",
                cylinder.intervals.len()
            )
        }
        Geometry::PolyConic(_) => "polyconic surface".to_owned(),
        Geometry::Loft(_) | Geometry::Mesh(_) | Geometry::ElementSurface(_) => {
            "surface of a single installation".to_owned()
        }
        Geometry::RuledSurface(surface) => {
            format!("ruled surface made from {} entities", surface.parts.len())
        }
        Geometry::Pattern(pattern) => format!("pattern of {} points", pattern.points.len()),
        Geometry::Sculptured(surface) => {
            let [u, v] = surface.extent();
            let arrangement = surface.grid.map_or(String::new(), |_| format!(", {u} by {v}"));
            let points = surface.patches.iter().flat_map(Patch::points).flatten();
            let count = surface.count();
            let patches =
                if count == 1 { "1 patch".to_owned() } else { format!("{count} patches{arrangement}") };
            format!("sculptured surface of {patches}, inside {}{}", within(points), measures(surface))
        }
        Geometry::SpaceCurve(curve) => {
            let points = curve.arcs.iter().flat_map(CurveArc::points);
            let ends = [curve.evaluate_global(0.0), curve.evaluate_global(curve.extent())];
            let ends = match ends {
                [Some(first), Some(last)] => {
                    format!(", from {} to {}", triple(&first.position), triple(&last.position))
                }
                _ => String::new(),
            };
            let measure = FlowKind::Arc { tolerance: 0.0 };
            let length: f64 = curve.arcs.iter().map(|arc| measure.amount(arc, 0.0, 1.0)).sum();
            let arcs =
                if curve.count() == 1 { "1 arc".to_owned() } else { format!("{} arcs", curve.count()) };
            format!("space curve of {arcs}, {} long{ends}, inside {}", number(length), within(points))
        }
    }
}

/// Area and curvatures of a surface, of large ones nothing: a hover does not wait.
fn measures(surface: &SculpturedSurface) -> String {
    /// The most patches that are measured.
    const GREATEST_COUNT: usize = 100;
    if surface.patches.len() > GREATEST_COUNT {
        return String::new();
    }
    /// Part of the greatest curvature, or of one over the size of the surface, below which a curvature is rounding.
    const ROUNDING: f64 = 1e-12;
    let curvatures = surface.curvature_range().map(|range| {
        let [least, greatest] = range.map(|place| place.curvature);
        let rounding = ROUNDING * least.abs().max(greatest.abs()).max(surface.size().recip());
        let [least, greatest] =
            [least, greatest].map(|value| number(if value.abs() <= rounding { 0.0 } else { value }));
        format!(", curvature {least} … {greatest} (positive where it is hollow on the side of its sign word)")
    });
    format!(", area {}{}", number(surface.area()), curvatures.unwrap_or_default())
}

/// The box of points, in words.
fn within(points: impl Iterator<Item = Vec3>) -> String {
    let (low, high) = points
        .fold((Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)), |(low, high), point| {
            (low.inf(&point), high.sup(&point))
        });
    format!("{} … {}", triple(&low), triple(&high))
}

pub(super) fn plane(plane: &apt_geometry::canonical::Plane) -> String {
    let mut text = String::new();
    for (coefficient, axis) in plane.normal.iter().zip(["x", "y", "z"]) {
        if *coefficient == 0.0 {
            continue;
        }
        let sign = match (text.is_empty(), *coefficient < 0.0) {
            (true, true) => "−",
            (true, false) => "",
            (false, true) => " − ",
            (false, false) => " + ",
        };
        text.push_str(sign);
        if (coefficient.abs() - 1.0).abs() > 1e-15 {
            text.push_str(&number(coefficient.abs()));
            text.push('·');
        }
        text.push_str(axis);
    }
    format!("{text} = {}", number(plane.distance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_true() {
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(number(-2.5), "-2.5");
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(123456.0), "123456");
        assert_eq!(number(1e-9), "1e-9");
        assert_eq!(number(-8.881784197001252e-16), "-8.8817842e-16");
        assert_eq!(number(100.0), "100");
    }

    #[test]
    fn a_plane_reads_as_an_equation() {
        let normal = apt_geometry::Vec3::new(0.6, 0.0, -0.8);
        assert_eq!(plane(&apt_geometry::canonical::Plane { normal, distance: 2.0 }), "0.6·x − 0.8·z = 2");
        let normal = apt_geometry::Vec3::new(0.0, -1.0, 0.0);
        assert_eq!(plane(&apt_geometry::canonical::Plane { normal, distance: 0.5 }), "−y = 0.5");
    }
}

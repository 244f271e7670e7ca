//! Functions of geometry: lengths, distances, angles and canonical numbers (language reference 2.6 and 10.4).
//!
//! APT III takes few types. APT4 looks at canonical numbers: it computes with the first three, which are the place of a point
//! and of what has a centre, and the normal of a line or plane.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Plane},
};
use apt_syntax::TextRange;
use smol_str::SmolStr;

use super::Item;
use crate::{
    evaluator::Evaluator,
    finding::{ControlFinding, FindingKind, Severity},
};

/// Lines and planes count as parallel up to this sine (language reference 2.6).
const PARALLEL_SINE: f64 = 1e-8;
/// The same in APT4, as what the cosine lacks of 1.
const APT4_PARALLEL_COSINE: f64 = 1e-6;
/// A point this near to the centre has no direction from it, in part-program units (language reference 2.6).
const CENTER_DISTANCE: f64 = 1e-6;
/// Squared length below which a vector has no direction in APT4.
const APT4_SHORTEST_SQUARE: f64 = 1e-12;
/// APT4: CLDATF without CL data.
const APT4_NO_CL_DATA: u16 = 93;

/// What APT4 sees in the first three canonical numbers.
#[derive(Clone, Copy)]
enum Leading {
    /// A place: a point, or a centre, a vertex, a point of an axis.
    Place(Vec3),
    /// The normal of a line or plane.
    Normal(Plane),
    /// A vector.
    Vector(Vec3),
}

impl Leading {
    fn of(geometry: &Geometry) -> Option<Leading> {
        Some(match geometry {
            Geometry::Point(place) => Leading::Place(*place),
            Geometry::Circle(round) | Geometry::Cylinder(round) => Leading::Place(round.point),
            Geometry::Sphere(sphere) => Leading::Place(sphere.center),
            Geometry::Cone(cone) => Leading::Place(cone.vertex),
            Geometry::Line(plane) | Geometry::Plane(plane) => Leading::Normal(*plane),
            Geometry::Vector(vector) => Leading::Vector(*vector),
            _ => return None,
        })
    }

    fn numbers(self) -> Vec3 {
        match self {
            Leading::Place(numbers) | Leading::Vector(numbers) => numbers,
            Leading::Normal(plane) => plane.normal,
        }
    }
}

impl Evaluator<'_> {
    /// CLDATF: numbers of the cutter locations, which Section 1 does not have.
    pub(super) fn location_data(&mut self, name: &'static str, range: TextRange) -> Option<f64> {
        self.without_result(name, APT4_NO_CL_DATA, range);
        None
    }

    /// Reports a function whose result does not exist.
    fn without_result(&mut self, name: &'static str, number: u16, range: TextRange) {
        let mut finding = self.finding(
            FindingKind::Control(ControlFinding::RoutineNotAvailable { name: SmolStr::new_static(name) }),
            range,
        );
        finding.severity = Severity::Error;
        finding.number = Some(number);
        self.add(finding);
    }

    /// DOTF of two vectors or points.
    pub(super) fn scalar_product(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        if let [a, b] = items
            && !self.is_apt4()
        {
            self.refuse_mixed("DOTF", a, b, range)?;
        }
        let [a, b] = self.directions::<2>("DOTF", items, range)?;
        Some(a.dot(&b))
    }

    /// Reports two arguments of different types where they must be of one; nothing if they are.
    fn refuse_mixed(&mut self, name: &'static str, a: &Item, b: &Item, range: TextRange) -> Option<()> {
        let (Some(first), Some(second)) =
            (a.geometry().map(Geometry::kind), b.geometry().map(Geometry::kind))
        else {
            return Some(());
        };
        if first == second {
            return Some(());
        }
        let function = SmolStr::new_static(name);
        self.report(FindingKind::FunctionMixed { function, first, second }, range);
        None
    }

    /// SPATF: the triple product.
    pub(super) fn triple_product(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [a, b, c] = self.directions::<3>("SPATF", items, range)?;
        Some(a.dot(&b.cross(&c)))
    }

    /// LNTHF of a vector or point.
    pub(super) fn length(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [a] = self.directions::<1>("LNTHF", items, range)?;
        Some(a.norm())
    }

    /// ANGLF and ANGLB, in radians: the direction of a point seen from the centre of a circle.
    pub(super) fn angle(&mut self, name: &'static str, items: &[Item], range: TextRange) -> Option<f64> {
        let [first, second] = self.pair(name, items, range)?;
        if self.is_apt4() {
            return Some(self.angle_between(name, [first, second], range).unwrap_or(0.0));
        }
        match (first.geometry(), second.geometry()) {
            (Some(Geometry::Circle(circle)), Some(Geometry::Point(point))) => {
                let way = point - circle.point;
                self.heading(&way, CENTER_DISTANCE, range)
            }
            _ => self.wrong_kind(name, first, second),
        }
    }

    /// APT4: between vectors and normals their angle, between places the direction from the first to the second. Nothing,
    /// where there is no angle, which has been reported.
    fn angle_between(&mut self, name: &'static str, items: [&Item; 2], range: TextRange) -> Option<f64> {
        let [first, second] = items.map(|item| item.geometry().and_then(Leading::of));
        match (first, second) {
            (Some(Leading::Place(from)), Some(Leading::Place(to))) => self.heading(&(to - from), 0.0, range),
            (
                Some(a @ (Leading::Normal(_) | Leading::Vector(_))),
                Some(b @ (Leading::Normal(_) | Leading::Vector(_))),
            ) => {
                let (a, b) = (a.numbers(), b.numbers());
                let square = a.norm_squared().min(b.norm_squared());
                if square < APT4_SHORTEST_SQUARE {
                    let function = SmolStr::new_static(name);
                    self.report(FindingKind::FunctionDomain { function, value: square.sqrt() }, range);
                    return None;
                }
                Some(a.cross(&b).norm().atan2(a.dot(&b)))
            }
            _ => self.wrong_kind(name, items[0], items[1]),
        }
    }

    /// Direction of a way in the xy-plane, from 0 to a full turn.
    fn heading(&mut self, way: &Vec3, shortest: f64, range: TextRange) -> Option<f64> {
        if way.x.hypot(way.y) <= shortest {
            self.report(FindingKind::AngleOfCenter, range);
            return None;
        }
        let angle = way.y.atan2(way.x);
        Some(if angle < 0.0 { angle + std::f64::consts::TAU } else { angle })
    }

    /// DISTF of parallel lines or planes; in APT4 also from a place.
    pub(super) fn distance(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [first, second] = self.pair("DISTF", items, range)?;
        if self.is_apt4() {
            return self.distance_between([first, second], range);
        }
        match (first.geometry(), second.geometry()) {
            (Some(Geometry::Line(a)), Some(Geometry::Line(b)))
            | (Some(Geometry::Plane(a)), Some(Geometry::Plane(b))) => {
                let scale = a.normal.norm() * b.normal.norm();
                let sine = a.normal.cross(&b.normal).norm() / scale;
                if sine.is_nan() || sine > PARALLEL_SINE {
                    self.report(FindingKind::NotParallel { sine }, range);
                    return None;
                }
                let sign = a.normal.dot(&b.normal).signum();
                Some((a.distance / a.normal.norm() - sign * b.distance / b.normal.norm()).abs())
            }
            (Some(Geometry::Line(_)), Some(Geometry::Plane(_)))
            | (Some(Geometry::Plane(_)), Some(Geometry::Line(_))) => {
                self.refuse_mixed("DISTF", first, second, range)?;
                None
            }
            _ => self.wrong_kind("DISTF", first, second),
        }
    }

    /// APT4: the distance of two places, the signed distance of a place from a line or plane, on the side of its normal
    /// positive, and the distance of parallel lines or planes.
    fn distance_between(&mut self, items: [&Item; 2], range: TextRange) -> Option<f64> {
        let [first, second] = items.map(|item| item.geometry().and_then(Leading::of));
        match (first, second) {
            (Some(Leading::Place(a)), Some(Leading::Place(b))) => Some((a - b).norm()),
            (Some(Leading::Place(place)), Some(Leading::Normal(plane)))
            | (Some(Leading::Normal(plane)), Some(Leading::Place(place))) => {
                Some(plane.signed_distance(&place))
            }
            (Some(Leading::Normal(a)), Some(Leading::Normal(b))) => {
                let cosine = a.normal.dot(&b.normal);
                if (cosine.abs() - 1.0).abs() > APT4_PARALLEL_COSINE || cosine.is_nan() {
                    let sine = a.normal.cross(&b.normal).norm();
                    self.report(FindingKind::NotParallel { sine }, range);
                    return None;
                }
                Some((a.distance - cosine * b.distance).abs())
            }
            _ => self.wrong_kind("DISTF", items[0], items[1]),
        }
    }

    /// NUMF of a pattern.
    pub(super) fn pattern_count(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [item] = items else {
            self.report_count("NUMF", 1, items.len(), range);
            return None;
        };
        let Some((_, pattern)) = item.pattern() else {
            self.wrong_kind("NUMF", item, item);
            return self.is_apt4().then_some(0.0);
        };
        #[expect(clippy::cast_precision_loss, reason = "patterns are far smaller than 2^53 points")]
        Some(pattern.points.len() as f64)
    }

    /// CANF(n,geometry) or CANF(geometry,n): the n-th canonical number.
    pub(super) fn canonical_number(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [first, second] = self.pair("CANF", items, range)?;
        let (number, geometry) = match (first.scalar(), second.geometry()) {
            (Some(number), Some(geometry)) => (number, geometry),
            _ => match (second.scalar(), first.geometry()) {
                (Some(number), Some(geometry)) => (number, geometry),
                _ => return self.wrong_kind("CANF", first, second),
            },
        };
        if self.is_apt4() && geometry.kind().canonical_count().is_none() {
            return self.wrong_kind("CANF", second, first);
        }
        let values = geometry.canonical_values();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a negative index saturates"
        )]
        let value = (number >= 1.0).then(|| values.get(number as usize - 1).copied()).flatten();
        if value.is_none() {
            let finding =
                FindingKind::FunctionDomain { function: SmolStr::new_static("CANF"), value: number };
            self.report(finding, range);
        }
        value
    }

    /// Exactly N vectors or points; in APT4 whatever leads with three numbers that are one.
    fn directions<const N: usize>(
        &mut self,
        name: &'static str,
        items: &[Item],
        range: TextRange,
    ) -> Option<[Vec3; N]> {
        if items.len() != N {
            self.report_count(name, N, items.len(), range);
            return None;
        }
        let mut directions = [Vec3::zeros(); N];
        for (direction, item) in directions.iter_mut().zip(items) {
            let leading = item.geometry().and_then(Leading::of);
            let taken = self.is_apt4() || item.vector().is_some() || item.point().is_some();
            let Some(leading) = leading.filter(|_| taken) else {
                return self.wrong_kind(name, item, item).map(|_| directions);
            };
            *direction = leading.numbers();
        }
        Some(directions)
    }
}

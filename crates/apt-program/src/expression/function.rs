//! The functions of the language (reference 2.6 and 10.4). Angles are in degrees at the language's edge.

use apt_geometry::{Vec3, canonical::Geometry};
use apt_syntax::{
    TextRange,
    statement::{Argument, WordUse},
};
use smol_str::SmolStr;

use super::{Item, Operand};
use crate::{
    evaluator::Evaluator,
    finding::{FindingKind, Severity},
};

/// Lines and planes count as parallel up to this sine (language reference 2.6).
const PARALLEL_SINE: f64 = 1e-8;

/// A point this near to the centre has no direction from it, in part-program units (language reference 2.6).
const CENTER_DISTANCE: f64 = 1e-6;

/// APT4: PARMF without an intersection before it, CLDATF without CL data.
const APT4_NO_INTERSECTION: u16 = 42;
const APT4_NO_CL_DATA: u16 = 93;

/// A function of one number.
type OneNumber = fn(f64) -> Option<f64>;

/// The functions of one number, with their domains.
const ONE_NUMBER: &[(&str, OneNumber)] = &[
    ("ABSF", |x| Some(x.abs())),
    ("EXPF", |x| Some(x.exp())),
    ("LOGF", |x| (x > 0.0).then(|| x.ln())),
    ("LOG10F", |x| (x > 0.0).then(|| x.log10())),
    ("SINF", |x| Some(degrees_sine(x))),
    ("COSF", |x| Some(degrees_sine(90.0 - x))),
    ("TANF", |x| ratio(degrees_sine(x), degrees_sine(90.0 - x))),
    ("COTANF", |x| ratio(degrees_sine(90.0 - x), degrees_sine(x))),
    ("ATANF", |x| Some(x.atan().to_degrees())),
    ("ARSINF", |x| (x.abs() <= 1.0).then(|| x.asin().to_degrees())),
    ("ARCOSF", |x| (x.abs() <= 1.0).then(|| x.acos().to_degrees())),
    ("SINB", |x| Some(x.sin())),
    ("COSB", |x| Some(x.cos())),
    ("TANB", |x| Some(x.tan())),
    ("COTANB", |x| ratio(x.cos(), x.sin())),
    ("ARSINB", |x| (x.abs() <= 1.0).then(|| x.asin())),
    ("ARCOSB", |x| (x.abs() <= 1.0).then(|| x.acos())),
    ("ATANB", |x| Some(x.atan())),
    ("SINHF", |x| Some(x.sinh())),
    ("COSHF", |x| Some(x.cosh())),
    ("TANHF", |x| Some(x.tanh())),
    ("INTF", |x| Some(x.trunc())),
];

/// Sine of an angle in degrees, exact at multiples of 90.
pub(crate) fn degrees_sine(degrees: f64) -> f64 {
    let turned = degrees % 360.0;
    if turned % 90.0 == 0.0 {
        return match (turned / 90.0) as i8 {
            1 | -3 => 1.0,
            -1 | 3 => -1.0,
            _ => 0.0,
        };
    }
    turned.to_radians().sin()
}

/// The value with which APT4 goes on after an argument outside the domain: the logarithm of the absolute value, and 0
/// for the inverse functions.
fn apt4_substitute(name: &str, value: f64, compute: OneNumber) -> Option<f64> {
    match name {
        "LOGF" | "LOG10F" => compute(value.abs()),
        "ARSINF" | "ARCOSF" | "ARSINB" | "ARCOSB" => Some(0.0),
        _ => None,
    }
}

/// A quotient, if its denominator is not zero.
fn ratio(numerator: f64, denominator: f64) -> Option<f64> {
    (denominator != 0.0).then(|| numerator / denominator)
}

impl Evaluator<'_> {
    /// The value of a function.
    pub(crate) fn function(
        &mut self,
        function: &WordUse,
        arguments: &[Argument],
        range: TextRange,
    ) -> Option<f64> {
        self.refuse_inclusive(arguments)?;
        let items = self.operands(arguments)?;
        let name = function.word.spelling;
        let value = match name {
            "SQRTF" => self.square_root(&items, range)?,
            "ATAN2F" => self.two_numbers(name, &items, range, |y, x| Some(y.atan2(x).to_degrees()))?,
            "ATAN2B" => self.two_numbers(name, &items, range, |y, x| Some(y.atan2(x)))?,
            "MODF" => self.two_numbers(name, &items, range, |a, b| (b != 0.0).then(|| a % b))?,
            "SIGNF" => self.two_numbers(name, &items, range, |a, b| Some(a.abs().copysign(b)))?,
            "MINF" => self.selection(name, &items, range, f64::min)?,
            "MAXF" => self.selection(name, &items, range, f64::max)?,
            "DOTF" => self.scalar_product(&items, range)?,
            "SPATF" => self.triple_product(&items, range)?,
            "LNTHF" => self.length(&items, range)?,
            "ANGLF" => self.angle(name, &items, range)?.to_degrees(),
            "ANGLB" => self.angle(name, &items, range)?,
            "DISTF" => self.distance(&items, range)?,
            "NUMF" => self.pattern_count(&items, range)?,
            "CANF" => self.canonical_number(&items, range)?,
            "PARMF" | "CLDATF" => return self.not_available(name, range),
            _ => self.one_number(name, &items, range)?,
        };
        self.finite(value, range)
    }

    /// A function of one number from the table.
    fn one_number(&mut self, name: &'static str, items: &[Item], range: TextRange) -> Option<f64> {
        let Some((_, compute)) = ONE_NUMBER.iter().find(|(word, _)| *word == name) else {
            self.report(FindingKind::NotReserved { name: SmolStr::new_static(name) }, range);
            return None;
        };
        let value = self.numbers::<1>(name, items, range)?[0];
        let result = compute(value);
        if result.is_none() {
            self.report(FindingKind::FunctionDomain { function: SmolStr::new_static(name), value }, range);
            if self.is_apt4() {
                return apt4_substitute(name, value, *compute);
            }
        }
        result
    }

    /// Functions of results that are not kept: the parameters of the last intersection, the CL file.
    fn not_available(&mut self, name: &'static str, range: TextRange) -> Option<f64> {
        let mut finding =
            self.finding(FindingKind::RoutineNotAvailable { name: SmolStr::new_static(name) }, range);
        finding.severity = Severity::Error;
        finding.number = Some(if name == "PARMF" { APT4_NO_INTERSECTION } else { APT4_NO_CL_DATA });
        self.add(finding);
        None
    }

    /// SQRTF: of a negative number the root of the absolute value, with a finding.
    fn square_root(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let value = self.numbers::<1>("SQRTF", items, range)?[0];
        if value < 0.0 {
            self.report(FindingKind::NegativeRoot { value }, range);
        }
        Some(value.abs().sqrt())
    }

    /// A function of two numbers.
    fn two_numbers(
        &mut self,
        name: &'static str,
        items: &[Item],
        range: TextRange,
        compute: fn(f64, f64) -> Option<f64>,
    ) -> Option<f64> {
        let [first, second] = self.numbers::<2>(name, items, range)?;
        let result = compute(first, second);
        if result.is_none() {
            let finding = FindingKind::FunctionDomain { function: SmolStr::new_static(name), value: second };
            self.report(finding, range);
        }
        result
    }

    /// MINF and MAXF.
    fn selection(
        &mut self,
        name: &'static str,
        items: &[Item],
        range: TextRange,
        choose: fn(f64, f64) -> f64,
    ) -> Option<f64> {
        if items.is_empty() {
            self.report_count(name, 1, 0, range);
            return None;
        }
        let numbers = self.all_numbers(name, items)?;
        numbers.into_iter().reduce(choose)
    }

    /// DOTF of two vectors or points.
    fn scalar_product(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
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
    fn triple_product(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [a, b, c] = self.directions::<3>("SPATF", items, range)?;
        Some(a.dot(&b.cross(&c)))
    }

    /// LNTHF of a vector or point.
    fn length(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [a] = self.directions::<1>("LNTHF", items, range)?;
        Some(a.norm())
    }

    /// ANGLF and ANGLB, in radians: the direction of a point seen from the centre of a circle, or, in APT4, the angle
    /// between vectors, lines or planes.
    fn angle(&mut self, name: &'static str, items: &[Item], range: TextRange) -> Option<f64> {
        let [first, second] = self.pair(name, items, range)?;
        match (first.geometry(), second.geometry()) {
            (Some(Geometry::Circle(circle)), Some(Geometry::Point(point))) => {
                let way = point - circle.point;
                if way.x.hypot(way.y) <= CENTER_DISTANCE {
                    self.report(FindingKind::AngleOfCenter, range);
                    return None;
                }
                let angle = way.y.atan2(way.x);
                Some(if angle < 0.0 { angle + std::f64::consts::TAU } else { angle })
            }
            (Some(left), Some(right)) if self.is_apt4() => {
                let (Some(a), Some(b)) = (direction_of(left), direction_of(right)) else {
                    return self.wrong_kind(name, first, second);
                };
                Some(a.cross(&b).norm().atan2(a.dot(&b)))
            }
            _ => self.wrong_kind(name, first, second),
        }
    }

    /// DISTF of parallel lines or planes; in APT4 also from a point.
    fn distance(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [first, second] = self.pair("DISTF", items, range)?;
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
            (Some(Geometry::Point(a)), Some(Geometry::Point(b))) if self.is_apt4() => Some((a - b).norm()),
            (Some(Geometry::Point(point)), Some(Geometry::Line(plane) | Geometry::Plane(plane)))
            | (Some(Geometry::Line(plane) | Geometry::Plane(plane)), Some(Geometry::Point(point)))
                if self.is_apt4() =>
            {
                Some(plane.signed_distance(point).abs())
            }
            (Some(Geometry::Line(_)), Some(Geometry::Plane(_)))
            | (Some(Geometry::Plane(_)), Some(Geometry::Line(_))) => {
                self.refuse_mixed("DISTF", first, second, range)?;
                None
            }
            _ => self.wrong_kind("DISTF", first, second),
        }
    }

    /// NUMF of a pattern.
    fn pattern_count(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [item] = items else {
            self.report_count("NUMF", 1, items.len(), range);
            return None;
        };
        let Some((_, pattern)) = item.pattern() else {
            return self.wrong_kind("NUMF", item, item);
        };
        #[expect(clippy::cast_precision_loss, reason = "patterns are far smaller than 2^53 points")]
        Some(pattern.points.len() as f64)
    }

    /// CANF(n,geometry) or CANF(geometry,n): the n-th canonical number.
    fn canonical_number(&mut self, items: &[Item], range: TextRange) -> Option<f64> {
        let [first, second] = self.pair("CANF", items, range)?;
        let (number, geometry) = match (first.scalar(), second.geometry()) {
            (Some(number), Some(geometry)) => (number, geometry),
            _ => match (second.scalar(), first.geometry()) {
                (Some(number), Some(geometry)) => (number, geometry),
                _ => return self.wrong_kind("CANF", first, second),
            },
        };
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

    /// Exactly N numbers.
    fn numbers<const N: usize>(
        &mut self,
        name: &'static str,
        items: &[Item],
        range: TextRange,
    ) -> Option<[f64; N]> {
        if items.len() != N {
            self.report_count(name, N, items.len(), range);
            return None;
        }
        self.all_numbers(name, items)?.try_into().ok()
    }

    /// All operands as numbers.
    fn all_numbers(&mut self, name: &'static str, items: &[Item]) -> Option<Vec<f64>> {
        if let Some(wrong) = items.iter().find(|item| item.scalar().is_none()) {
            return self.wrong_kind(name, wrong, wrong).map(|_| Vec::new());
        }
        Some(items.iter().filter_map(Item::scalar).collect())
    }

    /// Exactly N vectors or points.
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
            match item.vector().or_else(|| item.point()) {
                Some(value) => *direction = value,
                None => return self.wrong_kind(name, item, item).map(|_| directions),
            }
        }
        Some(directions)
    }

    /// Exactly two operands.
    fn pair<'b>(&mut self, name: &'static str, items: &'b [Item], range: TextRange) -> Option<[&'b Item; 2]> {
        if let [first, second] = items {
            return Some([first, second]);
        }
        self.report_count(name, 2, items.len(), range);
        None
    }

    /// Reports a wrong number of arguments.
    fn report_count(&mut self, name: &'static str, expected: usize, found: usize, range: TextRange) {
        let function = SmolStr::new_static(name);
        self.report(FindingKind::FunctionCount { function, expected, found }, range);
    }

    /// Reports an argument of the wrong kind: the second, unless that is a number where the first is not right either.
    fn wrong_kind(&mut self, name: &'static str, first: &Item, second: &Item) -> Option<f64> {
        let item = if matches!(first.operand, Operand::Geometry { .. }) { second } else { first };
        let finding = FindingKind::FunctionKind { function: SmolStr::new_static(name), found: item.found() };
        self.report(finding, item.range);
        None
    }
}

/// The direction that ANGLF compares: of a vector or point itself, of a line along it, of a plane its normal.
fn direction_of(geometry: &Geometry) -> Option<Vec3> {
    match geometry {
        Geometry::Vector(vector) | Geometry::Point(vector) => Some(*vector),
        Geometry::Line(plane) => Some(plane.line_direction()),
        Geometry::Plane(plane) => Some(plane.normal),
        _ => None,
    }
}

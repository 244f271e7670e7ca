//! The functions of the language (reference 2.6 and 10.4). Angles are in degrees at the language's edge. Those of geometry
//! are in [`super::measure`].

use apt_geometry::canonical::Geometry;
use apt_syntax::{
    TextRange,
    statement::{Argument, WordUse},
};
use smol_str::SmolStr;

use super::{Item, Operand};
use crate::{evaluator::Evaluator, finding::FindingKind};

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
fn degrees_sine(degrees: f64) -> f64 {
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

/// Whether the first argument is a space curve or a sculptured surface.
fn is_parametric(items: &[Item]) -> bool {
    let first = items.first().and_then(Item::geometry);
    matches!(first, Some(Geometry::SpaceCurve(_) | Geometry::Sculptured(_)))
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
        let name = function.word.spelling;
        if name == "PARMF" {
            return self.intersection_parameter(arguments, range);
        }
        let items = self.operands(arguments)?;
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
            "NUMF" if is_parametric(&items) => self.parametric_count(&items, range)?,
            "NUMF" => self.pattern_count(&items, range)?,
            "CANF" => self.canonical_number(&items, range)?,
            "CLDATF" => return self.location_data(name, range),
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

    /// Exactly two operands.
    pub(super) fn pair<'b>(
        &mut self,
        name: &'static str,
        items: &'b [Item],
        range: TextRange,
    ) -> Option<[&'b Item; 2]> {
        if let [first, second] = items {
            return Some([first, second]);
        }
        self.report_count(name, 2, items.len(), range);
        None
    }

    /// Reports a wrong number of arguments.
    pub(super) fn report_count(
        &mut self,
        name: &'static str,
        expected: usize,
        found: usize,
        range: TextRange,
    ) {
        let function = SmolStr::new_static(name);
        self.report(FindingKind::FunctionCount { function, expected, found }, range);
    }

    /// Reports an argument of the wrong kind: the second, unless that is a number where the first is not right either.
    pub(super) fn wrong_kind(&mut self, name: &'static str, first: &Item, second: &Item) -> Option<f64> {
        let item = if matches!(first.operand, Operand::Geometry { .. }) { second } else { first };
        let finding = FindingKind::FunctionKind { function: SmolStr::new_static(name), found: item.found() };
        self.report(finding, item.range);
        None
    }
}

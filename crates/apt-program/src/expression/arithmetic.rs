//! Values of expressions. The shape of the tree decides precedence; it comes from the parser of the dialect.

use apt_syntax::{
    TextRange,
    statement::{Expression, Operator},
};

use super::Resolved;
use crate::{evaluator::Evaluator, finding::FindingKind};

/// How near to a whole number an exponent counts as whole (language reference 2.5).
const WHOLE_EXPONENT_TOLERANCE: f64 = 1e-6;

/// Exponents up to this size are computed by repeated multiplication.
const GREATEST_INTEGER_POWER: f64 = 1024.0;

impl Evaluator<'_> {
    /// The value of an expression; nothing if that is not possible, which has then been reported.
    pub(crate) fn scalar(&mut self, expression: &Expression) -> Option<f64> {
        match expression {
            Expression::Number { value, .. } => Some(*value),
            Expression::Reference(reference) => match self.resolve(reference)? {
                Resolved::Scalar(value) => Some(value),
                Resolved::Geometry { name, stored } => {
                    let kind = stored.geometry.kind();
                    self.report(FindingKind::GeometryAsScalar { name, kind }, reference.range);
                    None
                }
            },
            Expression::Sign { negative, operand, .. } => {
                self.scalar(operand).map(|value| if *negative { -value } else { value })
            }
            Expression::Power { base, exponent, range } => {
                let base = self.scalar(base);
                let exponent = self.scalar(exponent);
                self.raised(base?, exponent?, *range)
            }
            Expression::Chain { first, rest, .. } => self.chain(first, rest),
            Expression::Call { function, arguments, range } => self.function(function, arguments, *range),
            Expression::Assign { target, value, .. } => {
                let number = self.scalar(value);
                self.assign_scalar(target, number);
                number
            }
            Expression::Parenthesised { inner, .. } => self.scalar(inner),
        }
    }

    /// Operators of one rank, from left to right. Every operand is evaluated, so that mistakes in all of them are seen.
    fn chain(&mut self, first: &Expression, rest: &[(Operator, Expression)]) -> Option<f64> {
        let mut value = self.scalar(first);
        for (operator, operand) in rest {
            let right = self.scalar(operand);
            let range = first.range().cover(operand.range());
            value = match (value, right) {
                (Some(left), Some(right)) => self.binary(*operator, left, right, range),
                _ => None,
            };
        }
        value
    }

    /// `base ** exponent`.
    fn raised(&mut self, base: f64, exponent: f64, range: TextRange) -> Option<f64> {
        match power(base, exponent) {
            Ok(value) => self.finite(value, range),
            Err(kind) => {
                self.report(kind, range);
                None
            }
        }
    }

    /// `left operator right`.
    fn binary(&mut self, operator: Operator, left: f64, right: f64, range: TextRange) -> Option<f64> {
        let value = match operator {
            Operator::Add => left + right,
            Operator::Subtract => left - right,
            Operator::Multiply => left * right,
            Operator::Divide if right == 0.0 => {
                self.report(FindingKind::DivisionByZero, range);
                return None;
            }
            Operator::Divide => left / right,
        };
        self.finite(value, range)
    }

    /// The value, if it is a finite number.
    pub(crate) fn finite(&mut self, value: f64, range: TextRange) -> Option<f64> {
        if value.is_finite() {
            return Some(value);
        }
        self.report(FindingKind::NotFinite, range);
        None
    }
}

/// `base ** exponent`: whole exponents take any base, others only a base that is not negative.
fn power(base: f64, exponent: f64) -> Result<f64, FindingKind> {
    let whole = exponent.round();
    if (exponent - whole).abs() <= WHOLE_EXPONENT_TOLERANCE {
        if base == 0.0 && whole < 0.0 {
            return Err(FindingKind::DivisionByZero);
        }
        if whole.abs() <= GREATEST_INTEGER_POWER {
            #[expect(clippy::cast_possible_truncation, reason = "bounded just above")]
            return Ok(base.powi(whole as i32));
        }
        return Ok(base.powf(whole));
    }
    if base < 0.0 {
        return Err(FindingKind::NegativePower { base, exponent });
    }
    if base == 0.0 && exponent < 0.0 {
        return Err(FindingKind::DivisionByZero);
    }
    Ok(base.powf(exponent))
}

//! Logical conditions (dialects that have them). AND binds tighter than OR; the tree says so.

use apt_syntax::statement::{Condition, RelationOperator};

use crate::evaluator::Evaluator;

impl Evaluator<'_> {
    /// The truth of a condition; nothing if an operand has no value.
    ///
    /// Both sides of AND and OR are always evaluated, so that mistakes in either are seen.
    pub(crate) fn condition(&mut self, condition: &Condition) -> Option<bool> {
        match condition {
            Condition::Relation { operator, left, right } => {
                let left = self.scalar(left);
                let right = self.scalar(right);
                Some(holds(*operator, left?, right?))
            }
            Condition::Not(inner) => self.condition(inner).map(|holds| !holds),
            Condition::And(left, right) => {
                let left = self.condition(left);
                let right = self.condition(right);
                Some(left? && right?)
            }
            Condition::Or(left, right) => {
                let left = self.condition(left);
                let right = self.condition(right);
                Some(left? || right?)
            }
        }
    }
}

/// Comparison is exact, as in APT4.
fn holds(operator: RelationOperator, left: f64, right: f64) -> bool {
    match operator {
        RelationOperator::Eq => left == right,
        RelationOperator::Ne => left != right,
        RelationOperator::Lt => left < right,
        RelationOperator::Le => left <= right,
        RelationOperator::Gt => left > right,
        RelationOperator::Ge => left >= right,
    }
}

//! Loops that do not end: what is said of them, and what is kept of what they did.

use apt_syntax::{
    ParsedStatement, SyntaxTree, TextRange,
    statement::{Argument, Body, Clause, Condition, Expression, Part},
};
use smol_str::SmolStr;

use super::Activation;
use crate::{
    evaluator::{Evaluator, Region},
    finding::{ControlFinding, FindingKind, RelatedKind},
    symbols::{Meaning, Value},
};

/// Records of an endless loop that are kept: enough to see what it did.
const RECORDS_KEPT_OF_ENDLESS_LOOP: usize = 10_000;

impl Evaluator<'_> {
    /// Reports where the budget went: the loop or macro, and what changed in its last turn.
    pub(super) fn report_endless(&mut self, activation: &Activation<'_>, index: usize, turn_start: usize) {
        let changing = self.changing_names(turn_start);
        let unchanged = self.unchanged_names(&self.deciding_names(activation), &changing);
        let finding = FindingKind::Control(ControlFinding::Endless {
            statements: self.budget.granted,
            changing,
            unchanged,
        });
        let kind = if activation.region == Region::Macro { RelatedKind::Macro } else { RelatedKind::Loop };
        let mut origin = self.origin(activation.frame.range);
        origin.isn = activation.frame.isn;
        origin.frame = activation.frame.parent.clone();
        origin.source = activation.frame.source.clone();
        let statement = activation.block.statements.get(index);
        let part = statement.and_then(|statement| statement.statement.parts.first());
        let range = part.map_or(TextRange::default(), |part| part.range);
        self.report_related(finding, range, vec![(kind, origin)]);
        self.state.exhausted = self.state.exhausted.saturating_add(1);
        self.output.records.truncate(RECORDS_KEPT_OF_ENDLESS_LOOP);
        self.output.listing.truncate(self.output.listing.len().min(RECORDS_KEPT_OF_ENDLESS_LOOP));
        self.output.definitions.truncate(RECORDS_KEPT_OF_ENDLESS_LOOP);
        if self.pending.as_ref().is_some_and(|pending| pending.record >= self.output.records.len()) {
            self.pending = None;
        }
        if activation.block.moves() {
            self.gap(range);
        }
    }

    /// Names whose values differ from the value they had before the last turn.
    fn changing_names(&self, turn_start: usize) -> Vec<SmolStr> {
        let all = &self.output.definitions;
        let before = || (0..turn_start.min(all.len())).rev().filter_map(|at| all.get(at));
        let turn = (turn_start..all.len()).filter_map(|at| all.get(at));
        let mut names: Vec<SmolStr> = turn
            .filter(|event| matches!(event.value, Value::Scalar(_)))
            .filter(|event| {
                let earlier = before().find(|other| other.name == event.name);
                earlier.is_none_or(|earlier| earlier.value != event.value)
            })
            .map(|event| event.name.clone())
            .collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// The numbers among some names that are not among the changing ones.
    fn unchanged_names(&self, names: &[SmolStr], changing: &[SmolStr]) -> Vec<SmolStr> {
        let is_number = |name: &SmolStr| {
            matches!(self.state.symbol(name).map(|symbol| &symbol.meaning), Some(Meaning::Scalar(_)))
        };
        names.iter().filter(|name| !changing.contains(name) && is_number(name)).cloned().collect()
    }

    /// The names that the conditions in a block are made of, sorted.
    fn deciding_names(&self, activation: &Activation<'_>) -> Vec<SmolStr> {
        let substituted = activation
            .block
            .statements
            .iter()
            .map(|original| activation.bindings.apply(original, &self.dialect));
        sorted(substituted.flat_map(|statement| condition_names(&statement)).collect())
    }

    /// Reports that the statements of the top level are executed again and again; the last was the one at `index`. Only what
    /// happened since the last checkpoint is known, some hundred statements.
    pub(crate) fn report_endless_program(&mut self, tree: &SyntaxTree, index: usize) {
        let recent = &self.output.definitions;
        let last_two = |name: &SmolStr| {
            let mut values =
                recent.iter().rev().filter(|event| event.name == *name).map(|event| &event.value);
            (values.next(), values.next())
        };
        let numbers = recent.iter().filter(|event| matches!(event.value, Value::Scalar(_)));
        let assigned = sorted(numbers.map(|event| event.name.clone()).collect());
        let changing: Vec<SmolStr> = assigned
            .into_iter()
            .filter(|name| matches!(last_two(name), (Some(a), Some(b)) if a != b))
            .collect();
        let here = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let (low, high) = recent
            .iter()
            .map(|event| event.origin.isn)
            .fold((here, here), |(low, high), isn| (low.min(isn), high.max(isn)));
        // The condition may stand right before the first or behind the last assignment.
        let around = (low as usize).saturating_sub(2)..(high as usize).saturating_add(1);
        let statements =
            around.filter(|at| *at < tree.statement_count()).map(|at| tree.statement(at).parsed());
        let deciding = sorted(statements.flat_map(|statement| condition_names(&statement)).collect());
        let unchanged = self.unchanged_names(&deciding, &changing);
        let part = tree.statement(index).parsed().statement.parts.first().map(|part| part.range);
        let finding = FindingKind::Control(ControlFinding::Endless {
            statements: self.options.statement_budget,
            changing,
            unchanged,
        });
        self.report(finding, part.unwrap_or_default());
    }
}

/// Names in order, each once.
fn sorted(mut names: Vec<SmolStr>) -> Vec<SmolStr> {
    names.sort_unstable();
    names.dedup();
    names
}

/// The names in the conditions of a statement.
fn condition_names(statement: &ParsedStatement) -> Vec<SmolStr> {
    let mut names = Vec::new();
    statement.statement.parts.iter().for_each(|part| names_of_part(part, &mut names));
    names
}

fn names_of_part(part: &Part, names: &mut Vec<SmolStr>) {
    match &part.body {
        Body::ArithmeticIf { condition, .. } => names_of_expression(condition, names),
        Body::LogicalIf { condition, then, .. } => {
            names_of_condition(condition, names);
            then.iter().for_each(|part| names_of_part(part, names));
        }
        Body::Clause { clause: Clause::If(condition) | Clause::ElseIf(condition), .. } => {
            names_of_condition(condition, names);
        }
        _ => {}
    }
}

fn names_of_condition(condition: &Condition, names: &mut Vec<SmolStr>) {
    match condition {
        Condition::Relation { left, right, .. } => {
            names_of_expression(left, names);
            names_of_expression(right, names);
        }
        Condition::Not(inner) => names_of_condition(inner, names),
        Condition::And(left, right) | Condition::Or(left, right) => {
            names_of_condition(left, names);
            names_of_condition(right, names);
        }
    }
}

fn names_of_expression(expression: &Expression, names: &mut Vec<SmolStr>) {
    match expression {
        Expression::Number { .. } => {}
        Expression::Reference(reference) => {
            names.push(reference.name.text.clone());
            if let Some(subscript) = &reference.subscript {
                names_of_expression(subscript, names);
            }
        }
        Expression::Sign { operand: inner, .. }
        | Expression::Parenthesised { inner, .. }
        | Expression::Assign { value: inner, .. } => names_of_expression(inner, names),
        Expression::Power { base, exponent, .. } => {
            names_of_expression(base, names);
            names_of_expression(exponent, names);
        }
        Expression::Chain { first, rest, .. } => {
            names_of_expression(first, names);
            rest.iter().for_each(|(_, operand)| names_of_expression(operand, names));
        }
        Expression::Call { arguments, .. } => {
            for argument in arguments {
                if let Argument::Expression(expression) = argument {
                    names_of_expression(expression, names);
                }
            }
        }
    }
}

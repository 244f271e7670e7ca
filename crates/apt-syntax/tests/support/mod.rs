//! Shared by the tests: statements as short text.

#![allow(dead_code, reason = "every test file uses its part")]

use apt_syntax::statement::{
    Argument, Body, Clause, Condition, Definition, Expression, MacroParameter, Operator, Part, Reference,
    Statement,
};
use apt_syntax::{Dialect, DialectName, ParsedStatement, SyntaxTree};

/// The only statement of a text.
pub(crate) fn parse(text: &str, dialect: DialectName) -> ParsedStatement {
    let tree = SyntaxTree::parse(text, Dialect::named(dialect));
    assert_eq!(tree.statement_count(), 1, "{text:?}");
    tree.statement(0).parsed().as_ref().clone()
}

/// A statement as nested lists: words in upper case as they are, structure in lower case.
pub(crate) fn short(text: &str, dialect: DialectName) -> String {
    let parsed = parse(text, dialect);
    let mut out = statement(&parsed.statement);
    for error in &parsed.errors {
        out += &format!(" !{:?}", error.kind);
    }
    out
}

fn statement(statement: &Statement) -> String {
    let label = statement.label.as_ref().map(|label| format!("{}) ", label.text)).unwrap_or_default();
    let parts: Vec<String> = statement.parts.iter().map(part).collect();
    format!("{label}{}", parts.join(" ; "))
}

fn part(part: &Part) -> String {
    match &part.body {
        Body::Text { word, text, .. } => format!("(text {} {text:?})", word.word.spelling),
        Body::Assignment { target, value } => format!("(let {} {})", reference(target), expression(value)),
        Body::Definition { target, definition: body } => {
            format!("(define {} {})", reference(target), definition(body))
        }
        Body::Macro { name, parameters, .. } => format!("(macro {}{})", name.text, variables(parameters)),
        Body::Call { name, arguments, section, .. } => {
            let section = section.map(|section| format!(" {}", section.word.spelling)).unwrap_or_default();
            format!("(call {}{section}{})", name.text, variables(arguments))
        }
        Body::ArithmeticIf { condition, labels, .. } => {
            let labels: Vec<&str> = labels.iter().map(|label| label.text.as_str()).collect();
            format!("(if {} {})", expression(condition), labels.join(" "))
        }
        Body::LogicalIf { condition: when, then, .. } => {
            let then: Vec<String> = then.iter().map(self::part).collect();
            format!("(when {} {})", condition(when), then.join(" ; "))
        }
        Body::Clause { word, clause } => match clause {
            Clause::If(when) | Clause::ElseIf(when) => {
                format!("({} {})", word.word.spelling, condition(when))
            }
            Clause::Else | Clause::End => format!("({})", word.word.spelling),
        },
        Body::Do { label, index, bounds, .. } => {
            let bounds: Vec<String> = bounds.iter().map(expression).collect();
            format!("(do {} {} {})", label.text, reference(index), bounds.join(" "))
        }
        Body::Jump { word, label } => format!("({} {})", word.word.spelling, label.text),
        Body::Major { word, slash, arguments: list } => {
            format!("({}{}{})", word.word.spelling, if *slash { "/" } else { "" }, arguments(list))
        }
        Body::UnknownMajor { name, slash, arguments: list } => {
            format!("(?{}{}{})", name.text, if *slash { "/" } else { "" }, arguments(list))
        }
        Body::Obtain { kind, arguments: list, .. } => {
            format!("(obtain {}{})", kind.word.spelling, arguments(list))
        }
        Body::Error => "(error)".to_owned(),
    }
}

fn variables(list: &[MacroParameter]) -> String {
    list.iter()
        .map(|parameter| {
            let value = parameter.value.as_ref().map(|value| {
                let pieces: Vec<&str> = value.iter().map(|element| element.text.as_str()).collect();
                format!("={}", pieces.concat())
            });
            format!(" {}{}", parameter.name.text, value.unwrap_or_default())
        })
        .collect()
}

fn arguments(list: &[Argument]) -> String {
    list.iter().map(|item| format!(" {}", argument(item))).collect()
}

fn argument(item: &Argument) -> String {
    match item {
        Argument::Empty(_) => "_".to_owned(),
        Argument::Expression(value) => expression(value),
        Argument::Word(word) => format!("'{}", word.word.spelling),
        Argument::Nested { target, definition: body, .. } => {
            let target = target.as_ref().map(|target| format!("{}=", reference(target))).unwrap_or_default();
            format!("[{target}{}]", definition(body))
        }
        Argument::Point { coordinates, .. } => format!("[{}]", arguments(coordinates).trim_start()),
        Argument::Inclusive { name, first, last, step, .. } => {
            let show =
                |value: &Option<Expression>, none: &str| value.as_ref().map_or(none.to_owned(), expression);
            let step = step
                .as_ref()
                .map(|(up, step)| format!(" {}{}", if *up { "+" } else { "-" }, expression(step)))
                .unwrap_or_default();
            format!("{}<{}..{}{step}>", name.text, show(first, "1"), show(last, "ALL"))
        }
        Argument::Text { text, .. } => format!("{text:?}"),
    }
}

fn definition(body: &Definition) -> String {
    format!("{}{}", body.kind.word.spelling, arguments(&body.arguments))
}

fn reference(target: &Reference) -> String {
    match &target.subscript {
        Some(subscript) => format!("{}<{}>", target.name.text, expression(subscript)),
        None => target.name.text.to_string(),
    }
}

fn expression(value: &Expression) -> String {
    match value {
        Expression::Number { value, .. } => value.to_string(),
        Expression::Reference(target) => reference(target),
        Expression::Sign { negative, operand, .. } => {
            format!("({} {})", if *negative { "neg" } else { "pos" }, expression(operand))
        }
        Expression::Power { base, exponent, .. } => {
            format!("(** {} {})", expression(base), expression(exponent))
        }
        Expression::Chain { first, rest, .. } => {
            rest.iter().fold(expression(first), |left, (operator, right)| {
                let operator = match operator {
                    Operator::Add => "+",
                    Operator::Subtract => "-",
                    Operator::Multiply => "*",
                    Operator::Divide => "/",
                };
                format!("({operator} {left} {})", expression(right))
            })
        }
        Expression::Call { function, arguments: list, .. } => {
            format!("({}{})", function.word.spelling, arguments(list))
        }
        Expression::Assign { target, value, .. } => {
            format!("(set {} {})", reference(target), expression(value))
        }
        Expression::Parenthesised { inner, .. } => expression(inner),
    }
}

fn condition(when: &Condition) -> String {
    match when {
        Condition::Relation { operator, left, right } => {
            format!("({operator:?} {} {})", expression(left), expression(right))
        }
        Condition::And(left, right) => format!("(and {} {})", condition(left), condition(right)),
        Condition::Not(inner) => format!("(not {})", condition(inner)),
        Condition::Or(left, right) => format!("(or {} {})", condition(left), condition(right)),
    }
}

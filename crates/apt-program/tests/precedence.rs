//! Random expressions, written with as few parentheses as the rules of a dialect need, have the value of their tree
//! (language reference 2.5 and 10.4).

use apt_program::{Options, Value, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree};
use proptest::prelude::*;

#[derive(Debug, Clone)]
enum Tree {
    Number(u8),
    Minus(Box<Tree>),
    Two(char, Box<Tree>, Box<Tree>),
}

/// `^` stands for `**`.
fn tree() -> impl Strategy<Value = Tree> {
    let leaf = (0_u8..5).prop_map(Tree::Number);
    leaf.prop_recursive(4, 24, 2, |inner| {
        prop_oneof![
            1 => inner.clone().prop_map(|operand| Tree::Minus(Box::new(operand))),
            4 => (prop::sample::select(vec!['+', '-', '*', '/', '^']), inner.clone(), inner)
                .prop_map(|(operator, left, right)| Tree::Two(operator, Box::new(left), Box::new(right))),
        ]
    })
}

/// The value; nothing where a step has none or is too large to compare.
fn value(tree: &Tree) -> Option<f64> {
    let value = match tree {
        Tree::Number(number) => f64::from(*number),
        Tree::Minus(operand) => -value(operand)?,
        Tree::Two(operator, left, right) => {
            let (left, right) = (value(left)?, value(right)?);
            match operator {
                '+' => left + right,
                '-' => left - right,
                '*' => left * right,
                '/' => left / right,
                _ if left < 0.0 && right.fract() != 0.0 => return None,
                _ => left.powf(right),
            }
        }
    };
    (value.is_finite() && value.abs() < 1e12).then_some(value)
}

/// How tight a tree binds: sum 1, product 2, then power and sign in the order of the dialect, operand 5.
fn level(tree: &Tree, apt4: bool) -> u8 {
    match (tree, apt4) {
        (Tree::Number(_), _) => 5,
        (Tree::Minus(_), true) | (Tree::Two('^', ..), false) => 3,
        (Tree::Minus(_), false) | (Tree::Two('^', ..), true) => 4,
        (Tree::Two('+' | '-', ..), _) => 1,
        (Tree::Two(..), _) => 2,
    }
}

/// The expression where at least `least` is needed.
fn written(tree: &Tree, least: u8, apt4: bool) -> String {
    if level(tree, apt4) < least {
        return format!("({})", written(tree, 1, apt4));
    }
    match tree {
        Tree::Number(number) => number.to_string(),
        // APT III takes one sign before an operand, APT4 any number of them before a power.
        Tree::Minus(operand) => format!("-{}", written(operand, if apt4 { 3 } else { 5 }, apt4)),
        Tree::Two('^', base, exponent) if apt4 => {
            // From the left; an exponent is an operand with its signs.
            format!("{}**{}", written(base, 4, apt4), signed_operand(exponent))
        }
        Tree::Two('^', base, exponent) => {
            format!("{}**{}", written(base, 4, apt4), written(exponent, 3, apt4))
        }
        Tree::Two(operator, left, right) => {
            let own = level(tree, apt4);
            format!("{}{operator}{}", written(left, own, apt4), written(right, own + 1, apt4))
        }
    }
}

fn signed_operand(tree: &Tree) -> String {
    match tree {
        Tree::Minus(operand) => format!("-{}", signed_operand(operand)),
        other => written(other, 5, true),
    }
}

fn evaluated(text: &str, dialect: DialectName) -> Option<f64> {
    // Every line of its own record, so that no column rule cuts it.
    let lines: Vec<String> =
        text.as_bytes().chunks(60).map(|piece| String::from_utf8_lossy(piece).into_owned()).collect();
    let tree = SyntaxTree::parse(&format!("X={}\nFINI\n", lines.join("$\n")), Dialect::named(dialect));
    let program = evaluate(&tree, &Options::default(), &|| false);
    program.symbols().into_iter().find_map(|(name, value)| match value {
        Value::Scalar(number) if name == "X" => Some(number),
        _ => None,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn expressions_have_the_value_of_their_tree(tree in tree()) {
        let Some(expected) = value(&tree) else { return Ok(()) };
        for (dialect, apt4) in [(DialectName::Free, false), (DialectName::Apt3, false), (DialectName::Apt4, true)] {
            let text = written(&tree, 1, apt4);
            let found = evaluated(&text, dialect);
            let near = found.is_some_and(|found| (found - expected).abs() <= 1e-9 * expected.abs().max(1.0));
            prop_assert!(near, "{} {}: {:?}, not {}", dialect, text, found, expected);
        }
    }
}

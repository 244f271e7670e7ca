//! Splits one CL statement into its major word and arguments.

use smol_str::SmolStr;

use crate::record::ClWord;

/// A statement as word and arguments.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shape {
    /// Nothing on the line.
    Blank,
    /// `WORD` or `WORD/arguments`.
    Major {
        /// Upper case.
        word: SmolStr,
        /// Arguments; an omitted one is an empty word.
        arguments: Vec<ClWord>,
    },
    /// Numbers only: more positions for the last GOTO.
    Numbers(Vec<f64>),
    /// `name = ...`: a definition, which CL text cannot hold.
    Definition(SmolStr),
    /// Nothing of these.
    Unreadable,
}

/// The statement that begins an operation of NX; its names are spelled as in the part file.
pub(crate) const TOOL_PATH: &str = "TOOL PATH";

pub(crate) fn shape(text: &str) -> Shape {
    let text = text.trim();
    if text.is_empty() {
        return Shape::Blank;
    }
    let (head, tail) = match text.split_once('/') {
        Some((head, tail)) => (head.trim(), Some(tail)),
        None => (text, None),
    };
    if let Some((name, _)) = head.split_once('=') {
        return Shape::Definition(name.trim().to_ascii_uppercase().into());
    }
    if head.split_whitespace().eq(TOOL_PATH.split(' ')) {
        return Shape::Major { word: TOOL_PATH.into(), arguments: names(tail.unwrap_or_default()) };
    }
    if is_word(head) {
        let arguments = tail.map(arguments).unwrap_or_default();
        return Shape::Major { word: head.to_ascii_uppercase().into(), arguments };
    }
    if tail.is_none() {
        let numbers: Option<Vec<f64>> = list(text).map(number).collect();
        if let Some(numbers) = numbers {
            return Shape::Numbers(numbers);
        }
    }
    Shape::Unreadable
}

/// A word that stands before another statement on its line, as in `RAPID,GOTO/1,2,3`, and that statement.
pub(crate) fn joined(text: &str) -> Option<(SmolStr, &str)> {
    let (word, behind) = text.split_once(',')?;
    let next = behind.split([',', '/']).next().unwrap_or_default();
    (is_word(word.trim()) && is_word(next.trim())).then(|| (word.trim().to_ascii_uppercase().into(), behind))
}

/// Letters, digits and what stands between them in names of later systems; 2DCALC begins with a digit and is no number.
fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphanumeric())
        && text.contains(|c: char| c.is_ascii_alphabetic())
        && number(text).is_none()
        && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'))
}

/// The items between commas; a comma at the very end ends the last item and does not open another.
pub(crate) fn list(text: &str) -> impl Iterator<Item = &str> {
    let text = text.trim();
    text.strip_suffix(',').unwrap_or(text).split(',').map(str::trim)
}

fn arguments(text: &str) -> Vec<ClWord> {
    if text.trim().is_empty() {
        return Vec::new();
    }
    list(text)
        .map(|item| match number(item) {
            Some(number) => ClWord::Number(number),
            None => ClWord::Word(spelled(item)),
        })
        .collect()
}

fn names(text: &str) -> Vec<ClWord> {
    list(text).map(|item| ClWord::Word(item.into())).collect()
}

/// A word in upper case, or quoted text without its quotes.
fn spelled(item: &str) -> SmolStr {
    match item.strip_prefix('\'').and_then(|rest| rest.strip_suffix('\'')) {
        Some(quoted) => quoted.into(),
        None => item.to_ascii_uppercase().into(),
    }
}

/// A finite number in the notations of CL files; spelled-out infinities and the like are words.
pub(crate) fn number(item: &str) -> Option<f64> {
    let digits = item.trim_start_matches(['+', '-']);
    if !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return None;
    }
    item.parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes() {
        let word = |text: &str| ClWord::Word(text.into());
        assert_eq!(shape("  "), Shape::Blank);
        assert_eq!(
            shape("TOOLNO / 1,, note"),
            Shape::Major {
                word: "TOOLNO".into(),
                arguments: vec![ClWord::Number(1.0), word(""), word("NOTE")]
            }
        );
        assert_eq!(shape("RAPID"), Shape::Major { word: "RAPID".into(), arguments: vec![] });
        assert_eq!(shape("1., -.5, 1.5E+00,"), Shape::Numbers(vec![1.0, -0.5, 1.5]));
        assert_eq!(shape("P1 = POINT/1,2,3"), Shape::Definition("P1".into()));
        assert_eq!(shape("1, x"), Shape::Unreadable);
        assert_eq!(
            shape("TOOL PATH/Mill_1,TOOL,D10"),
            Shape::Major {
                word: TOOL_PATH.into(),
                arguments: vec![word("Mill_1"), word("TOOL"), word("D10")]
            }
        );
        assert_eq!(shape("2DCALC"), Shape::Major { word: "2DCALC".into(), arguments: vec![] });
        assert_eq!(shape("1.5E5"), Shape::Numbers(vec![1.5e5]));
        assert_eq!(shape("15E5"), Shape::Numbers(vec![15e5]));
        assert_eq!(number("inf"), None);
        assert_eq!(number("1e999"), None);
    }
}

//! Finds the statements that may contain a name or word, without parsing the others.

use apt_geometry::patience::Patience;
use apt_syntax::tree::SyntaxTree;

use crate::Cancelled;

/// Statements whose text is looked through as one unit of work, in a microsecond or two.
const STATEMENTS_A_UNIT: usize = 8;

/// Indices of the statements whose text contains `word` (upper case), blanks and letter case ignored as the language
/// ignores them. A name may be split over a continuation, so `$` and line ends are passed over as well.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub(crate) fn statements_with(
    tree: &SyntaxTree,
    word: &str,
    patience: Patience<'_>,
) -> Result<Vec<usize>, Cancelled> {
    let mut found = Vec::new();
    for (done, view) in tree.statements().enumerate() {
        if patience.ends_among(done, STATEMENTS_A_UNIT) {
            return Err(Cancelled);
        }
        if contains(view.text().as_bytes(), word.as_bytes()) {
            found.push(view.index);
        }
    }
    Ok(found)
}

/// Whether a text contains a word, blanks, letter case and continuations ignored.
pub(crate) fn contains(text: &[u8], word: &[u8]) -> bool {
    let Some(&first) = word.first() else { return false };
    (0..text.len()).any(|at| text[at].to_ascii_uppercase() == first && starts_with(&text[at..], word))
}

fn starts_with(text: &[u8], word: &[u8]) -> bool {
    let mut rest = text.iter().filter(|byte| !matches!(byte, b' ' | b'\t' | b'$' | b'\r' | b'\n'));
    word.iter().all(|wanted| rest.next().is_some_and(|byte| byte.to_ascii_uppercase() == *wanted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_names_through_blanks_case_and_continuations() {
        assert!(contains(b"gofwd/ L 1", b"L1"));
        assert!(contains(b"AB$\nCD=1", b"ABCD"));
        assert!(!contains(b"LL2=1", b"L1"));
        assert!(contains(b"xLL1", b"L1"), "a second start inside the first is tried too");
    }
}

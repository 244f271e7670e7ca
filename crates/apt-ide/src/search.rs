//! Finds the statements that may contain a name or word, without parsing the others.

use apt_syntax::tree::SyntaxTree;

/// Indices of the statements whose text contains `word` (upper case), blanks and letter case ignored as the language
/// ignores them. A name may be split over a continuation, so `$` and line ends are passed over as well.
pub fn statements_with(tree: &SyntaxTree, word: &str) -> Vec<usize> {
    let word = word.as_bytes();
    tree.statements().filter(|view| contains(view.text().as_bytes(), word)).map(|view| view.index).collect()
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

//! Fewer edits with the same effect.

use std::cmp::Reverse;

use ropey::Rope;

use crate::analysis::TextEdit;

/// Joins neighbours until there are at most `most` edits; those go first between which the least text stays as it is, and
/// that text becomes part of the edit. The edits are in order of the text and without overlap, before and afterwards.
pub(crate) fn joined(rope: &Rope, edits: Vec<TextEdit>, most: usize) -> Vec<TextEdit> {
    let Some(too_many) = edits.len().checked_sub(most.max(1)).filter(|too_many| *too_many > 0) else {
        return edits;
    };
    let between = |(nth, pair): (usize, &[TextEdit])| match pair {
        [one, next] => (next.range.start.saturating_sub(one.range.end), Reverse(nth)),
        _ => (0, Reverse(nth)),
    };
    let mut gaps: Vec<_> = edits.windows(2).enumerate().map(between).collect();
    // The narrowest come first, of equal ones those farther on.
    gaps.select_nth_unstable(too_many - 1);
    let mut is_joined = vec![false; edits.len()];
    for (_, Reverse(nth)) in &gaps[..too_many] {
        is_joined[nth + 1] = true;
    }
    let mut joined: Vec<TextEdit> = Vec::with_capacity(most);
    for (edit, is_joined) in edits.into_iter().zip(is_joined) {
        match joined.last_mut() {
            Some(last) if is_joined => {
                rope.byte_slice(last.range.end..edit.range.start)
                    .chunks()
                    .for_each(|piece| last.text.push_str(piece));
                last.text.push_str(&edit.text);
                last.range.end = edit.range.end;
            }
            _ => joined.push(edit),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Formatting;

    /// Edits of single letters at these places.
    fn edits(places: &[usize]) -> Vec<TextEdit> {
        let edit = |at: &usize| TextEdit { range: *at..at + 1, text: "<>".repeat(at % 3) };
        places.iter().map(edit).collect()
    }

    #[test]
    fn joined_edits_have_the_same_effect() {
        let text = "PARTNO é\nP1 = POINT/1,2\nP2 = POINT/3,4\nFINI\n";
        let rope = Rope::from_str(text);
        let places = [0, 1, 3, 10, 11, 12, 20, 30, 33, 44];
        let applied =
            |edits: &[TextEdit]| Formatting { edits: edits.to_vec(), ..Formatting::default() }.applied(text);
        let wanted = applied(&edits(&places));
        for most in 0..12 {
            let fewer = joined(&rope, edits(&places), most);
            assert_eq!(fewer.len(), most.clamp(1, places.len()), "{most}");
            assert_eq!(applied(&fewer), wanted, "{most}");
            assert!(fewer.windows(2).all(|pair| pair[0].range.end <= pair[1].range.start), "{most}");
        }
        assert!(joined(&rope, Vec::new(), 3).is_empty());
    }

    #[test]
    fn edits_that_stand_close_together_are_joined_first() {
        let rope = Rope::from_str(&"x".repeat(100));
        let fewer = joined(&rope, edits(&[0, 2, 40, 43, 80]), 3);
        let ranges: Vec<_> = fewer.into_iter().map(|edit| edit.range).collect();
        assert_eq!(ranges, [0..3, 40..44, 80..81]);
    }
}

//! The smallest edits from one text to another.

use std::ops::Range;

/// A run of blanks and line ends, or of other characters.
struct Run {
    range: Range<usize>,
    blank: bool,
}

/// The edits that make `old` to `new`; ranges are bytes of `old`, moved by `offset`.
pub(super) fn between(old: &str, new: &str, offset: usize) -> Vec<(Range<usize>, String)> {
    let mut edits = Vec::new();
    if old != new && !blank_by_blank(old, new, offset, &mut edits) {
        edits.clear();
        trimmed(old, new, offset, &mut edits);
    }
    edits
}

/// One edit for what lies between the common beginning and the common end.
fn trimmed(old: &str, new: &str, offset: usize, edits: &mut Vec<(Range<usize>, String)>) {
    let head: usize = old
        .chars()
        .zip(new.chars())
        .take_while(|(a, b)| a == b)
        .map(|(character, _)| character.len_utf8())
        .sum();
    let (old_rest, new_rest) = (old.get(head..).unwrap_or(""), new.get(head..).unwrap_or(""));
    let tail: usize = old_rest
        .chars()
        .rev()
        .zip(new_rest.chars().rev())
        .take_while(|(a, b)| a == b)
        .map(|(character, _)| character.len_utf8())
        .sum();
    let insert = new_rest.get(..new_rest.len() - tail).unwrap_or("");
    if insert.is_empty() && old_rest.len() == tail {
        return;
    }
    edits.push((offset + head..offset + old.len() - tail, insert.to_owned()));
}

/// Edits for the blanks that differ and the letters that change their case; false if more than that differs.
fn blank_by_blank(old: &str, new: &str, offset: usize, edits: &mut Vec<(Range<usize>, String)>) -> bool {
    let (old_words, new_words) = (words(old), words(new));
    if old_words.len() != new_words.len() {
        return false;
    }
    let (mut old_end, mut new_end) = (0, 0);
    for (a, b) in old_words.iter().zip(&new_words) {
        let (before, after) = (old.get(a.clone()).unwrap_or(""), new.get(b.clone()).unwrap_or(""));
        if !before.eq_ignore_ascii_case(after) {
            return false;
        }
        let blanks = (old.get(old_end..a.start).unwrap_or(""), new.get(new_end..b.start).unwrap_or(""));
        trimmed(blanks.0, blanks.1, offset + old_end, edits);
        trimmed(before, after, offset + a.start, edits);
        (old_end, new_end) = (a.end, b.end);
    }
    let blanks = (old.get(old_end..).unwrap_or(""), new.get(new_end..).unwrap_or(""));
    trimmed(blanks.0, blanks.1, offset + old_end, edits);
    true
}

/// The pieces between blanks. A mark is a piece of its own, so that blanks that go away beside it make small edits.
fn words(text: &str) -> Vec<Range<usize>> {
    let mut words: Vec<Run> = Vec::new();
    for (start, character) in text.char_indices() {
        let end = start + character.len_utf8();
        let blank = character.is_whitespace();
        let word = character.is_alphanumeric() || !character.is_ascii();
        match words.last_mut() {
            Some(run) if run.range.end == start && run.blank == blank && word && run_is_word(text, run) => {
                run.range.end = end;
            }
            _ => words.push(Run { range: start..end, blank }),
        }
    }
    words.into_iter().filter(|run| !run.blank).map(|run| run.range).collect()
}

fn run_is_word(text: &str, run: &Run) -> bool {
    let last = text.get(run.range.clone()).and_then(|text| text.chars().next_back());
    last.is_some_and(|character| character.is_alphanumeric() || !character.is_ascii())
}

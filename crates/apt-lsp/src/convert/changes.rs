//! Changes of a document, in: the rope is brought up to date and the same edits are given in bytes.

use tower_lsp::ls_types::TextDocumentContentChangeEvent;

use super::TextIndex;
use crate::analysis::TextEdit;

/// Applies one change. A change without a range replaces everything.
pub(crate) fn apply(index: &mut TextIndex, change: TextDocumentContentChangeEvent) -> TextEdit {
    let range = match change.range {
        Some(range) => index.bytes(range),
        None => 0..index.rope.len_bytes(),
    };
    let start = index.rope.byte_to_char(range.start);
    let end = index.rope.byte_to_char(range.end);
    index.rope.remove(start..end);
    index.rope.insert(start, &change.text);
    TextEdit { range, text: change.text }
}

#[cfg(test)]
mod tests {
    use ropey::Rope;
    use tower_lsp::ls_types::{Position, Range};

    use super::super::Encoding;
    use super::*;

    fn change(range: Option<((u32, u32), (u32, u32))>, text: &str) -> TextDocumentContentChangeEvent {
        let position = |(line, character)| Position { line, character };
        TextDocumentContentChangeEvent {
            range: range.map(|(start, end)| Range { start: position(start), end: position(end) }),
            range_length: None,
            text: text.to_owned(),
        }
    }

    #[test]
    fn the_rope_and_the_byte_edits_agree() {
        let mut text = "$$ 😀\r\nP1=POINT/1,2\r\n".to_owned();
        let mut index = TextIndex { rope: Rope::from_str(&text), encoding: Encoding::Utf16 };
        let changes = [
            change(Some(((0, 5), (0, 5))), "é"),
            change(Some(((1, 0), (0, 3))), ""),
            change(Some(((0, 99), (9, 9))), "\nFINI"),
            change(None, "PARTNO"),
            change(Some(((0, 0), (0, 4))), "ü"),
        ];
        for change in changes {
            let edit = apply(&mut index, change);
            text.replace_range(edit.range, &edit.text);
            assert_eq!(index.rope.to_string(), text);
        }
        assert_eq!(text, "üNO");
    }
}

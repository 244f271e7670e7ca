//! Positions: line and character in the negotiated encoding, to and from byte offsets.

use std::ops;

use ropey::{Rope, RopeSlice};
use tower_lsp::ls_types::{Position, PositionEncodingKind, Range};

/// What the character of a position counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units: what every client understands.
    #[default]
    Utf16,
    /// Unicode scalar values.
    Utf32,
}

impl Encoding {
    /// The best encoding that the client offers; bytes cost us least.
    pub(crate) fn negotiate(offered: Option<&[PositionEncodingKind]>) -> Self {
        let offers = |kind: &PositionEncodingKind| offered.is_some_and(|list| list.contains(kind));
        if offers(&PositionEncodingKind::UTF8) {
            Self::Utf8
        } else if !offers(&PositionEncodingKind::UTF16) && offers(&PositionEncodingKind::UTF32) {
            Self::Utf32
        } else {
            Self::Utf16
        }
    }

    /// The length of a text.
    pub(crate) fn length(self, text: &str) -> usize {
        match self {
            Self::Utf8 => text.len(),
            _ if text.is_ascii() => text.len(),
            Self::Utf16 => text.encode_utf16().count(),
            Self::Utf32 => text.chars().count(),
        }
    }

    /// Its name in the protocol.
    pub(crate) fn kind(self) -> PositionEncodingKind {
        match self {
            Self::Utf8 => PositionEncodingKind::UTF8,
            Self::Utf16 => PositionEncodingKind::UTF16,
            Self::Utf32 => PositionEncodingKind::UTF32,
        }
    }
}

/// A text with the encoding in which its positions are told.
#[derive(Debug, Clone)]
pub(crate) struct TextIndex {
    /// The text.
    pub rope: Rope,
    /// How positions count characters.
    pub encoding: Encoding,
}

impl TextIndex {
    /// Byte offset of a position. Past the end of a line means its end, past the last line the end of
    /// the text, inside a character its beginning.
    pub(crate) fn offset(&self, position: Position) -> usize {
        let line = position.line as usize;
        if line >= self.rope.len_lines() {
            return self.rope.len_bytes();
        }
        let start = self.rope.line_to_byte(line);
        let content = line_content(self.rope.line(line));
        start + offset_in_line(content, position.character as usize, self.encoding)
    }

    /// Byte range of a range; the ends are put in order.
    pub(crate) fn bytes(&self, range: Range) -> ops::Range<usize> {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        start.min(end)..start.max(end)
    }

    /// Position of a byte offset. Past the end means the end, inside a character its beginning.
    pub(crate) fn position(&self, offset: usize) -> Position {
        Positions::of(self).position(offset)
    }

    /// Range of a byte range.
    pub(crate) fn range(&self, bytes: &ops::Range<usize>) -> Range {
        Positions::of(self).range(bytes)
    }
}

/// The positions of many offsets of a text: one that stands soon after the one before needs no search in the rope.
#[derive(Debug)]
pub(crate) struct Positions<'a> {
    index: &'a TextIndex,
    /// A line with the byte where it begins.
    line: usize,
    start: usize,
    /// A piece of the rope in which the line goes on, with the byte where the piece begins.
    piece: &'a str,
    begin: usize,
}

impl<'a> Positions<'a> {
    /// None is known yet.
    pub(crate) fn of(index: &'a TextIndex) -> Self {
        Self { index, line: 0, start: 0, piece: "", begin: 0 }
    }

    /// [`TextIndex::position`].
    pub(crate) fn position(&mut self, offset: usize) -> Position {
        self.in_piece(offset).unwrap_or_else(|| self.searched(offset))
    }

    /// [`TextIndex::range`].
    pub(crate) fn range(&mut self, bytes: &ops::Range<usize>) -> Range {
        let start = self.position(bytes.start);
        // What follows mostly stands inside: so a search for the end does not go there.
        let end = self.end_on_line(bytes, start);
        let end = end.unwrap_or_else(|| Self::of(self.index).position(bytes.end));
        Range { start, end }
    }

    /// Goes on through the piece, line by line.
    fn in_piece(&mut self, offset: usize) -> Option<Position> {
        let mut from = self.start.saturating_sub(self.begin);
        let to = offset.checked_sub(self.begin).filter(|to| *to < self.piece.len())?;
        let bytes = self.piece.as_bytes();
        let passed = bytes.get(from..to)?;
        let is_break = |at: usize| match bytes.get(at) {
            Some(b'\n') => true,
            Some(b'\r') => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        // Counted over all bytes first, which is quick; breaks of other kinds than these are rare.
        let mut breaks = passed.iter().filter(|byte| **byte == b'\n').count();
        if passed.contains(&b'\r') {
            breaks = (from..to).filter(|at| is_break(*at)).count();
        }
        if breaks > 0 {
            from = (from..to).rev().find(|at| is_break(*at))? + 1;
            (self.line, self.start) = (self.line + breaks, self.begin + from);
        }
        let before = (self.start >= self.begin).then(|| self.piece.get(from..to))??;
        Some(self.in_line(self.index.encoding.length(before)))
    }

    /// Goes to an offset by a search in the rope.
    fn searched(&mut self, offset: usize) -> Position {
        let rope = &self.index.rope;
        let offset = offset.min(rope.len_bytes());
        (self.piece, self.begin, ..) = rope.chunk_at_byte(offset);
        self.line = rope.byte_to_line(offset);
        self.start = rope.line_to_byte(self.line);
        let piece =
            self.start.checked_sub(self.begin).and_then(|from| self.piece.get(from..offset - self.begin));
        let count = piece.map(|before| self.index.encoding.length(before)).unwrap_or_else(|| {
            let slice = rope.line(self.line);
            let character = slice.byte_to_char(offset - self.start);
            match self.index.encoding {
                Encoding::Utf8 => slice.char_to_byte(character),
                Encoding::Utf16 => slice.char_to_utf16_cu(character),
                Encoding::Utf32 => character,
            }
        });
        self.in_line(count)
    }

    fn in_line(&self, character: usize) -> Position {
        Position { line: protocol_number(self.line), character: protocol_number(character) }
    }

    /// The end of a range with its start, if both stand on one line in the piece: then it needs no search.
    fn end_on_line(&self, bytes: &ops::Range<usize>, start: Position) -> Option<Position> {
        let from = bytes.start.checked_sub(self.begin)?;
        let text = self.piece.get(from..bytes.end.checked_sub(self.begin)?)?;
        let character = start.character.checked_add(protocol_number(self.index.encoding.length(text)))?;
        (!text.contains(['\n', '\r'])).then_some(Position { line: start.line, character })
    }
}

/// A number of the protocol, which has 32 bits at most.
pub(crate) fn protocol_number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// A line without its line break.
fn line_content(line: RopeSlice<'_>) -> RopeSlice<'_> {
    let mut end = line.len_chars();
    while end > 0 && matches!(line.get_char(end - 1), Some('\n' | '\r')) {
        end -= 1;
    }
    line.slice(..end)
}

fn offset_in_line(line: RopeSlice<'_>, count: usize, encoding: Encoding) -> usize {
    match encoding {
        Encoding::Utf8 if count >= line.len_bytes() => line.len_bytes(),
        Encoding::Utf8 => line.char_to_byte(line.byte_to_char(count)),
        Encoding::Utf16 if count >= line.len_utf16_cu() => line.len_bytes(),
        Encoding::Utf16 => line.char_to_byte(line.utf16_cu_to_char(count)),
        Encoding::Utf32 => line.char_to_byte(count.min(line.len_chars())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn index(text: &str, encoding: Encoding) -> TextIndex {
        TextIndex { rope: Rope::from_str(text), encoding }
    }

    fn at(line: u32, character: u32) -> Position {
        Position { line, character }
    }

    #[test]
    fn characters_are_counted_in_the_negotiated_encoding() {
        let text = "$$ é😀x\nP1";
        for (encoding, x) in [(Encoding::Utf8, 9), (Encoding::Utf16, 6), (Encoding::Utf32, 5)] {
            let index = index(text, encoding);
            let offset = text.find('x').unwrap();
            assert_eq!(index.position(offset), at(0, x), "{encoding:?}");
            assert_eq!(index.offset(at(0, x)), offset, "{encoding:?}");
        }
    }

    #[test]
    fn positions_inside_characters_and_past_ends_are_moved_to_real_places() {
        let text = "a😀b\r\nc";
        let index16 = index(text, Encoding::Utf16);
        assert_eq!(index16.offset(at(0, 2)), 1, "the middle of a surrogate pair is its beginning");
        assert_eq!(index16.offset(at(0, 99)), 6, "the end of a line is before its line break");
        assert_eq!(index16.offset(at(9, 0)), text.len());
        assert_eq!(index(text, Encoding::Utf8).offset(at(0, 3)), 1);
        assert_eq!(index16.position(3), at(0, 1), "an offset inside a character is its beginning");
        assert_eq!(index16.position(999), at(1, 1));
    }

    #[test]
    fn only_the_line_breaks_of_the_protocol_break_lines() {
        let text = "a\u{2028}b\u{c}c\rd\r\ne\nf\u{85}g";
        let index = index(text, Encoding::Utf16);
        assert_eq!(index.position(text.find('d').unwrap()), at(1, 0));
        assert_eq!(index.position(text.find('e').unwrap()), at(2, 0));
        assert_eq!(index.position(text.find('f').unwrap()), at(3, 0));
        assert_eq!(index.position(text.len()), at(3, 3));
    }

    #[test]
    fn every_character_boundary_survives_the_way_there_and_back() {
        let text = "PARTNO é\r\n$$ 😀😀\n\nC1=CIRCLE/0,0,1\r\u{feff}x";
        for encoding in [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32] {
            let index = index(text, encoding);
            for (offset, character) in text.char_indices() {
                if character == '\n' && text[..offset].ends_with('\r') {
                    continue; // Between CR and LF there is no position.
                }
                assert_eq!(index.offset(index.position(offset)), offset, "{encoding:?} at {offset}");
            }
        }
    }

    #[test]
    fn ranges_are_told_as_their_two_ends_are() {
        let mut text = "C1=CIRCLE/0 $$ é😀\r\nFINI\r\n\n".to_owned();
        text.push_str(&"P1=POINT/1,2 $$ 😀\n".repeat(200)); // Several pieces of a rope.
        for encoding in [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32] {
            let index = index(&text, encoding);
            for start in 0..=text.len() {
                for end in (start..text.len() + 3).step_by(7).take(6) {
                    let ends = Range { start: index.position(start), end: index.position(end) };
                    assert_eq!(index.range(&(start..end)), ends, "{encoding:?} {start}..{end}");
                }
            }
        }
    }

    #[test]
    fn positions_do_not_depend_on_those_before() {
        let mut text = "C1=CIRCLE/0 $$ é😀\r\nFINI\rX\r\n\n".to_owned();
        text.push_str(&"P1=POINT/1,2 $$ 😀\r\n".repeat(150));
        text.push_str(&"é".repeat(2_000)); // A line of several pieces.
        text.push_str(&"\n\nL1=LINE/P1,P2".repeat(150));
        for encoding in [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32] {
            let index = index(&text, encoding);
            for step in [1, 2, 17, 400, 4_003] {
                let (mut ahead, mut around) = (Positions::of(&index), Positions::of(&index));
                for offset in (0..text.len() + 3).step_by(step) {
                    let alone = index.position(offset);
                    assert_eq!(ahead.position(offset), alone, "{encoding:?} {offset}");
                    let other = offset * 7_919 % text.len();
                    assert_eq!(around.range(&(offset..other)).start, alone, "{encoding:?} {offset}");
                    assert_eq!(around.position(other), index.position(other), "{encoding:?} {other}");
                }
            }
        }
    }

    #[test]
    fn bytes_are_preferred_and_utf_16_is_what_is_left() {
        let kinds =
            |names: &[&'static str]| names.iter().map(|name| PositionEncodingKind::new(name)).collect();
        let negotiate = |names: &[&'static str]| {
            let list: Vec<_> = kinds(names);
            Encoding::negotiate(Some(&list))
        };
        assert_eq!(negotiate(&["utf-16", "utf-8"]), Encoding::Utf8);
        assert_eq!(negotiate(&["utf-32", "utf-16"]), Encoding::Utf16);
        assert_eq!(negotiate(&["utf-32"]), Encoding::Utf32);
        assert_eq!(negotiate(&["utf-7"]), Encoding::Utf16);
        assert_eq!(Encoding::negotiate(None), Encoding::Utf16);
    }
}

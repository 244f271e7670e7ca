//! Byte offsets to the zero-based line and UTF-16 character of the fixed interfaces.

use apt_geometry::patience::Patience;
use serde::Serialize;

use crate::Cancelled;

/// A zero-based line and a UTF-16 offset in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Position {
    /// Line, from 0.
    pub line: u32,
    /// UTF-16 code units from the start of the line.
    pub character: u32,
}

/// From one position up to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Range {
    /// First position.
    pub start: Position,
    /// Position after the last character.
    pub end: Position,
}

/// Bytes that are looked through for ends of lines as one unit of work, in some microseconds.
const BYTES_A_UNIT: usize = 1024;

/// The starts of the lines of a text.
#[derive(Debug, Clone)]
pub struct LineIndex {
    starts: Vec<usize>,
}

impl LineIndex {
    /// Finds the lines of a text; LF, CRLF and a lone CR end a line, as in the language server protocol.
    pub fn new(text: &str) -> Self {
        Self::found(text, Patience::default())
    }

    /// The same.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when who waits has given up before the end.
    pub fn until(text: &str, patience: Patience<'_>) -> Result<Self, Cancelled> {
        let index = Self::found(text, patience);
        if patience.was_over() { Err(Cancelled) } else { Ok(index) }
    }

    /// The lines up to the end, or to where who waits gives up.
    fn found(text: &str, patience: Patience<'_>) -> Self {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for (number, piece) in bytes.chunks(BYTES_A_UNIT).enumerate() {
            if patience.ends_after(1) {
                break;
            }
            let first = number * BYTES_A_UNIT;
            let ends = (first..)
                .zip(piece)
                .filter(|&(at, &byte)| byte == b'\n' || (byte == b'\r' && bytes.get(at + 1) != Some(&b'\n')));
            starts.extend(ends.map(|(at, _)| at + 1));
        }
        Self { starts }
    }

    /// The line on which an offset stands, from zero.
    pub fn line_of(&self, offset: usize) -> u32 {
        let line = self.starts.partition_point(|start| *start <= offset).saturating_sub(1);
        u32::try_from(line).unwrap_or(u32::MAX)
    }

    /// The position of a byte offset; offsets past the end or inside a character are moved back to the nearest place.
    pub fn position(&self, text: &str, offset: usize) -> Position {
        let mut offset = offset.min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.starts.partition_point(|&start| start <= offset).saturating_sub(1);
        let start = self.starts.get(line).copied().unwrap_or(0);
        let character = text[start..offset].encode_utf16().count();
        Position { line: line as u32, character: character as u32 }
    }

    /// The range between two byte offsets.
    pub fn range(&self, text: &str, bytes: std::ops::Range<usize>) -> Range {
        Range {
            start: self.position(text, bytes.start),
            end: self.position(text, bytes.end.max(bytes.start)),
        }
    }

    /// The byte range of a zero-based line, its line end included; `None` past the last line.
    pub fn line(&self, text: &str, line: u32) -> Option<std::ops::Range<usize>> {
        let start = *self.starts.get(line as usize)?;
        let end = self.starts.get(line as usize + 1).copied().unwrap_or(text.len());
        Some(start..end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_utf16_and_every_line_end() {
        let text = "a\r\né𝄞x\rz";
        let index = LineIndex::new(text);
        assert_eq!(index.position(text, 0), Position { line: 0, character: 0 });
        assert_eq!(index.position(text, 3), Position { line: 1, character: 0 });
        assert_eq!(index.position(text, 9), Position { line: 1, character: 3 }, "é is 1 unit, 𝄞 is 2");
        assert_eq!(index.position(text, 8), Position { line: 1, character: 1 }, "inside 𝄞 moves back");
        assert_eq!(index.position(text, 11), Position { line: 2, character: 0 });
        assert_eq!(index.position(text, 99), Position { line: 2, character: 1 });
        assert_eq!(index.line(text, 1), Some(3..11));
        assert_eq!(index.line(text, 3), None);
    }
}

//! The binary CL file of NCL and PostWorks.
//!
//! Blocks of a fixed length, of which the last word is empty; in them, without regard to their ends, little-endian records, each
//! with a header of four 16-bit integers (words with the header, class, subclass, statement number) and data words of eight bytes as
//! on the tape of APT III. The first record has the class 7400 and begins with the name of the part.

use smol_str::SmolStr;

use super::{
    CLASS_MODE, HEADER_OF_NCL, MODE_MULTAX, TEXT_CHARACTERS_PER_WORD, TapeContents, TapeReadError,
    WORD_BYTES, reader::Reader,
};
use crate::{codes::CodeTable, record::ClKind};

/// Bytes of a block, and how many of them are payload.
const BLOCK_BYTES: usize = 288;
const PAYLOAD_BYTES: usize = 280;
/// Bytes of the header of a record: one word.
const RECORD_HEADER_BYTES: usize = WORD_BYTES;
/// Words of the first record that hold the name of the part; date, time and the name of the writer follow.
const PART_NAME_WORDS: usize = 9;
/// The subclass of MULTAX, whose record has no data when it means ON.
const MODE_OF_NCL: i32 = 0;
/// Codes that NCL gives to other words than APT III.
const MAJOR_WORDS: [(&str, u16); 6] =
    [("GOHOME", 17), ("POSTN", 1024), ("ROTATE", 1066), ("LINTOL", 1067), ("PPTOL", 1068), ("POSITN", 1072)];
const MINOR_WORDS: [(&str, u16); 5] =
    [("LAST", 52), ("LINCIR", 95), ("BRKCHP", 288), ("INCHES", 303), ("MMPM", 315)];

/// Whether bytes begin like such a file.
pub fn is_ncl_file(bytes: &[u8]) -> bool {
    bytes.len() >= BLOCK_BYTES && bytes[2..4] == HEADER_OF_NCL.to_le_bytes()
}

/// Reads such a file; records of unknown classes are skipped with a note.
///
/// # Errors
/// Bytes that cannot be split into records; places are those in the payload of the blocks.
pub(super) fn read(bytes: &[u8], codes: &CodeTable) -> Result<TapeContents, TapeReadError> {
    let payload: Vec<u8> = bytes
        .chunks(BLOCK_BYTES)
        .flat_map(|block| &block[..block.len().min(PAYLOAD_BYTES)])
        .copied()
        .collect();
    let codes = codes_of_ncl(codes);
    let mut reader = Reader::new(&codes, 0);
    let mut offset = 0;
    let mut serial = 0;
    while let Some(header) = payload.get(offset..offset + RECORD_HEADER_BYTES) {
        let field = |at: usize| u16::from_le_bytes([header[at], header[at + 1]]);
        let (count, class, subclass, isn) = (field(0), field(2), field(4), field(6));
        // What is left of the last block is empty.
        if count == 0 {
            break;
        }
        let end = offset + usize::from(count) * WORD_BYTES;
        let Some(data) = payload.get(offset + RECORD_HEADER_BYTES..end) else {
            return Err(TapeReadError::BadLength { offset, count: i32::from(count) });
        };
        let (words, _) = data.as_chunks::<WORD_BYTES>();
        serial += 1;
        reader.at(serial, u32::from(isn));
        match (i32::from(class), i32::from(subclass)) {
            _ if class == HEADER_OF_NCL => reader.push(part_name(words)),
            (CLASS_MODE, MODE_OF_NCL) => reader.record(CLASS_MODE, MODE_MULTAX, words),
            (class, subclass) => reader.record(class, subclass, words),
        }
        offset = end;
    }
    Ok(reader.contents())
}

/// PARTNO, which has no record of its own.
fn part_name(words: &[[u8; WORD_BYTES]]) -> ClKind {
    let name = words[..words.len().min(PART_NAME_WORDS)].as_flattened();
    ClKind::Text {
        word: SmolStr::new_static("PARTNO"),
        code: super::TEXT_CODES
            .iter()
            .find(|(_, word)| *word == "PARTNO")
            .and_then(|(code, _)| u16::try_from(*code).ok()),
        text: String::from_utf8_lossy(name).trim().into(),
    }
}

/// The bytes of a text: six characters in each word where the other two are blank in all of them, eight otherwise.
pub(super) fn text_of(words: &[[u8; WORD_BYTES]]) -> Vec<u8> {
    let is_short =
        |word: &[u8; WORD_BYTES]| word[TEXT_CHARACTERS_PER_WORD..].iter().all(|byte| *byte == b' ');
    let characters = if words.iter().all(is_short) { TEXT_CHARACTERS_PER_WORD } else { WORD_BYTES };
    words.iter().flat_map(|word| &word[..characters]).copied().collect()
}

fn codes_of_ncl(codes: &CodeTable) -> CodeTable {
    let mut own = CodeTable::new();
    for (word, code) in MAJOR_WORDS {
        own.major(word, code);
    }
    for (word, code) in MINOR_WORDS {
        own.minor(word, code);
    }
    own.fill_up(codes);
    own
}

//! Data words of eight bytes, which carry no tag: what they are follows from bits and place.

use super::{TEXT_CHARACTERS_PER_WORD, WORD_BYTES};

/// Largest minor-word code.
const LARGEST_CODE: u32 = 4095;
const BLANK: u8 = b' ';

/// A data word.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum DataWord {
    /// An integer in the low half, 1 to 4095.
    Integer(u16),
    /// A double, zero included.
    Float(f64),
    /// Six characters and two blanks, trimmed.
    Text(String),
}

/// Bytes of an integer.
pub(super) fn integer(value: u32) -> [u8; WORD_BYTES] {
    u64::from(value).to_le_bytes()
}

/// Bytes of a float; a negative zero is written as zero.
pub(super) fn float(value: f64) -> [u8; WORD_BYTES] {
    (value + 0.0).to_le_bytes()
}

/// Bytes of a name: the first six characters, right-justified, and two blanks. No name is a zero word.
pub(super) fn name(text: &str) -> [u8; WORD_BYTES] {
    if text.is_empty() {
        return [0; WORD_BYTES];
    }
    let bytes = &text.as_bytes()[..text.len().min(TEXT_CHARACTERS_PER_WORD)];
    let mut word = [BLANK; WORD_BYTES];
    word[TEXT_CHARACTERS_PER_WORD - bytes.len()..TEXT_CHARACTERS_PER_WORD].copy_from_slice(bytes);
    word
}

/// What a data word most likely is. Text ends in two blanks, which as a float would be some 1e-154.
pub(super) fn classify(bytes: [u8; WORD_BYTES]) -> DataWord {
    let low = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    let high = u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]);
    match u16::try_from(low) {
        Ok(code) if high == 0 && code > 0 && low <= LARGEST_CODE => return DataWord::Integer(code),
        _ => {}
    }
    let printable = bytes.iter().all(|byte| (BLANK..0x7f).contains(byte));
    if printable && bytes[6] == BLANK && bytes[7] == BLANK {
        return DataWord::Text(String::from_utf8_lossy(&bytes).trim().to_owned());
    }
    DataWord::Float(f64::from_le_bytes(bytes))
}

/// A number from a word that holds one either as integer or as float.
pub(super) fn number(bytes: [u8; WORD_BYTES]) -> f64 {
    match classify(bytes) {
        DataWord::Integer(value) => f64::from(value),
        DataWord::Float(value) => value,
        DataWord::Text(_) => f64::from_le_bytes(bytes),
    }
}

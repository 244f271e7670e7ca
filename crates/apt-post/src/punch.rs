//! Punched tape: characters as rows of holes in EIA RS-244 (odd parity) or ISO 840 (even parity).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::{
    control::REPLACEMENT,
    finding::{PostFinding, PostFindingKind},
    tape::{Block, Tape},
};

/// The two tape codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Code {
    /// EIA RS-244, odd parity in track 5.
    Eia,
    /// ISO 840 / EIA RS-358, even parity in track 8.
    Iso,
}

impl Code {
    /// Its name, as people write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Eia => "EIA",
            Self::Iso => "ISO",
        }
    }
}

/// Characters to the inch of tape.
pub const CHARACTERS_PER_INCH: f64 = 10.0;
/// Blank rows before and after the data: 24 inches.
pub const LEADER_ROWS: usize = 240;

/// EIA end of block, end of record (rewind stop), and rows that are no data.
const EIA_END_OF_BLOCK: u8 = 0x80;
const EIA_END_OF_RECORD: u8 = 0x0b;
const EIA_DELETE: u8 = 0x7f;
const ISO_LINE_FEED: u8 = 0x0a;
const ISO_RETURN: u8 = 0x8d;
const ISO_DELETE: u8 = 0xff;
const BLANK: u8 = 0x00;
/// Track 8, the parity track of ISO.
const ISO_PARITY: u8 = 0x80;

/// EIA RS-244, track 1 in bit 0.
const EIA: [(char, u8); 50] = [
    ('0', 0x20),
    ('1', 0x01),
    ('2', 0x02),
    ('3', 0x13),
    ('4', 0x04),
    ('5', 0x15),
    ('6', 0x16),
    ('7', 0x07),
    ('8', 0x08),
    ('9', 0x19),
    ('A', 0x61),
    ('B', 0x62),
    ('C', 0x73),
    ('D', 0x64),
    ('E', 0x75),
    ('F', 0x76),
    ('G', 0x67),
    ('H', 0x68),
    ('I', 0x79),
    ('J', 0x51),
    ('K', 0x52),
    ('L', 0x43),
    ('M', 0x54),
    ('N', 0x45),
    ('O', 0x46),
    ('P', 0x57),
    ('Q', 0x58),
    ('R', 0x49),
    ('S', 0x32),
    ('T', 0x23),
    ('U', 0x34),
    ('V', 0x25),
    ('W', 0x26),
    ('X', 0x37),
    ('Y', 0x38),
    ('Z', 0x29),
    ('+', 0x70),
    ('-', 0x40),
    ('.', 0x6b),
    (',', 0x3b),
    ('/', 0x31),
    ('&', 0x0e),
    (' ', 0x10),
    ('\t', 0x3e),
    ('(', 0x1a),
    (')', 0x4a),
    ('\u{8}', 0x2a),
    ('\n', EIA_END_OF_BLOCK),
    ('%', EIA_END_OF_RECORD),
    ('\u{7f}', EIA_DELETE),
];

/// The characters of ISO 840.
const ISO: &str = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ+-.,/%:()=*# \n\t";

/// Why text cannot be punched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("line {}: {character:?} is not in the tape code", line + 1)]
pub struct PunchError {
    /// Zero-based line of the text.
    pub line: usize,
    /// The character that the code lacks.
    pub character: char,
}

/// Why an image cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// A row with the wrong parity.
    #[error("row {row}: {byte:#04x} has the wrong parity")]
    Parity {
        /// Row, from 0.
        row: usize,
        /// Its holes.
        byte: u8,
    },
    /// A row that is no character.
    #[error("row {row}: {byte:#04x} is no character")]
    Unknown {
        /// Row, from 0.
        row: usize,
        /// Its holes.
        byte: u8,
    },
}

/// The tape image of a text: leader, one byte per character with parity, trailer. Lower case is punched as upper case.
///
/// # Errors
/// The first character that the code lacks.
pub fn punch(text: &str, code: Code) -> Result<Vec<u8>, PunchError> {
    let mut image = vec![BLANK; LEADER_ROWS];
    for (line, block) in text.split_inclusive('\n').enumerate() {
        for character in block.chars().filter(|character| *character != '\r') {
            let row = row_in(block.trim_end(), character, code).ok_or(PunchError { line, character })?;
            image.push(row);
        }
    }
    image.resize(image.len() + LEADER_ROWS, BLANK);
    Ok(image)
}

/// Finds what keeps a tape from being punched: the characters of each block that the code lacks, each once. One that the
/// control lacks stands on the tape as another one; where that cannot be punched, the finding is of the one in the program,
/// and takes the place of [`PostFindingKind::Character`].
pub fn find_lacking(tape: &mut Tape, code: Code) {
    let mut replaced: BTreeMap<usize, Vec<char>> = BTreeMap::new();
    if row_of(REPLACEMENT, code).is_none() {
        tape.findings.retain(|finding| match finding.kind {
            PostFindingKind::Character { character } => {
                replaced.entry(finding.block).or_default().push(character);
                false
            }
            _ => true,
        });
    }
    for (index, block) in tape.blocks.iter().enumerate() {
        let replaced = replaced.get(&index).map_or(&[][..], Vec::as_slice);
        for character in lacking(block, replaced, code) {
            let (isn, source) = (block.isn, block.source);
            let kind = PostFindingKind::NotInTapeCode { character, code };
            tape.findings.push(PostFinding { isn, source, block: index, kind });
        }
    }
}

/// The characters of a block that a code lacks, each once; `replaced` are those in whose place [`REPLACEMENT`] stands.
fn lacking(block: &Block, replaced: &[char], code: Code) -> Vec<char> {
    let mut replacements = replaced.len();
    let mut lacking: Vec<char> = Vec::new();
    for character in replaced.iter().copied().chain(block.text.chars()) {
        if character == REPLACEMENT && replacements > 0 {
            replacements -= 1;
        } else if row_in(&block.text, character, code).is_none() && !lacking.contains(&character) {
            lacking.push(character);
        }
    }
    lacking
}

/// The text of a tape image; blank and deleted rows are passed over, parity is checked.
///
/// # Errors
/// The first row that is damaged.
pub fn decode(image: &[u8], code: Code) -> Result<String, DecodeError> {
    let mut text = String::new();
    for (row, &byte) in image.iter().enumerate() {
        let passed = match code {
            Code::Eia => matches!(byte, BLANK | EIA_DELETE),
            Code::Iso => matches!(byte, BLANK | ISO_DELETE | ISO_RETURN),
        };
        if passed {
            continue;
        }
        let odd = byte.count_ones() % 2 == 1;
        if odd != (code == Code::Eia) {
            return Err(DecodeError::Parity { row, byte });
        }
        text.push(character(byte, code).ok_or(DecodeError::Unknown { row, byte })?);
    }
    Ok(text)
}

/// Length of an image in inches of tape.
pub fn length_inches(image: &[u8]) -> f64 {
    image.len() as f64 / CHARACTERS_PER_INCH
}

/// Which code an image is punched in, by the first end of block in it.
pub fn recognise(image: &[u8]) -> Option<Code> {
    image.iter().find_map(|byte| match *byte {
        EIA_END_OF_BLOCK => Some(Code::Eia),
        ISO_LINE_FEED => Some(Code::Iso),
        _ => None,
    })
}

/// A row as people draw it: tracks 8 to 4, the sprocket hole, tracks 3 to 1.
pub fn row_picture(byte: u8) -> String {
    let track = |bit: u8| if byte >> bit & 1 == 1 { 'O' } else { '.' };
    let mut picture: String = (3..8).rev().map(track).collect();
    picture.push('o');
    picture.extend((0..3).rev().map(track));
    picture
}

/// The row of a character. Lower case is punched as upper case.
fn row_of(character: char, code: Code) -> Option<u8> {
    encode(character.to_ascii_uppercase(), code)
}

/// The row of a character of a block. The `%` of EIA is the end of the record and stands alone; in a text the control would
/// stop reading there.
fn row_in(block: &str, character: char, code: Code) -> Option<u8> {
    let row = row_of(character, code)?;
    (code != Code::Eia || row != EIA_END_OF_RECORD || block.len() == character.len_utf8()).then_some(row)
}

fn encode(character: char, code: Code) -> Option<u8> {
    match code {
        Code::Eia => EIA.iter().find(|(known, _)| *known == character).map(|(_, row)| *row),
        Code::Iso => {
            let known = ISO.contains(character);
            let ascii = u8::try_from(character).ok().filter(|_| known)?;
            Some(if ascii.count_ones() % 2 == 1 { ascii | ISO_PARITY } else { ascii })
        }
    }
}

fn character(byte: u8, code: Code) -> Option<char> {
    match code {
        Code::Eia => EIA.iter().find(|(_, row)| *row == byte).map(|(character, _)| *character),
        Code::Iso => Some(char::from(byte & !ISO_PARITY)).filter(|character| ISO.contains(*character)),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn data(text: &str, code: Code) -> Vec<u8> {
        let image = punch(text, code).unwrap();
        image[LEADER_ROWS..image.len() - LEADER_ROWS].to_vec()
    }

    #[test]
    fn a_block_in_both_codes() {
        let block = "N20G1Z-2500F50\n";
        let eia = [0x45, 0x02, 0x20, 0x67, 0x01, 0x29, 0x40, 0x02, 0x15, 0x20, 0x20, 0x76, 0x15, 0x20, 0x80];
        let iso = [0x4e, 0xb2, 0x30, 0x47, 0xb1, 0x5a, 0x2d, 0xb2, 0x35, 0x30, 0x30, 0xc6, 0x35, 0x30, 0x0a];
        assert_eq!(data(block, Code::Eia), eia);
        assert_eq!(data(block, Code::Iso), iso);
        assert_eq!(recognise(&eia), Some(Code::Eia));
        assert_eq!(recognise(&iso), Some(Code::Iso));
    }

    #[test]
    fn pictures_of_rows() {
        assert_eq!(row_picture(0x45), ".O...oO.O");
        assert_eq!(row_picture(0x4e), ".O..OoOO.");
        assert_eq!(row_picture(0x02), ".....o.O.");
        assert_eq!(row_picture(0xb2), "O.OO.o.O.");
    }

    #[test]
    fn every_row_has_its_parity_and_is_unique() {
        let rows: std::collections::BTreeSet<u8> = EIA.iter().map(|(_, row)| *row).collect();
        assert_eq!(rows.len(), EIA.len());
        assert!(rows.iter().all(|row| row.count_ones() % 2 == 1));
        assert!(ISO.chars().all(|c| encode(c, Code::Iso).unwrap().count_ones().is_multiple_of(2)));
    }

    #[test]
    fn lacking_characters_and_damage_are_errors() {
        assert_eq!(punch("N1\n(A;B)", Code::Eia), Err(PunchError { line: 1, character: ';' }));
        assert_eq!(punch("%\nN1\n(50% A)", Code::Eia), Err(PunchError { line: 2, character: '%' }));
        assert!(punch("%\nN1\n(50% A)\n%\n", Code::Iso).is_ok() && punch("%\nN1\n%\n", Code::Eia).is_ok());
        assert_eq!(decode(&[0x03], Code::Eia), Err(DecodeError::Parity { row: 0, byte: 0x03 }));
        assert_eq!(decode(&[0xb3], Code::Iso), Err(DecodeError::Parity { row: 0, byte: 0xb3 }));
        assert_eq!(decode(&[0x00, 0xf8], Code::Eia), Err(DecodeError::Unknown { row: 1, byte: 0xf8 }));
        assert_eq!(length_inches(&[0; 77]), 7.7);
    }

    proptest! {
        #[test]
        fn punched_text_reads_back(text in "(%\n)?[0-9A-Z+\\-.,/() \n]{0,80}(\n%\n)?", eia in any::<bool>()) {
            let code = if eia { Code::Eia } else { Code::Iso };
            let image = punch(&text, code).unwrap();
            prop_assert_eq!(image.len(), text.len() + 2 * LEADER_ROWS);
            prop_assert_eq!(decode(&image, code).unwrap(), text);
        }

        #[test]
        fn one_damaged_hole_is_found(at in 0_usize..14, bit in 0_u8..8) {
            let mut image = data("N20G1Z-2500F50\n", Code::Iso);
            image[at] ^= 1 << bit;
            let error = decode(&image, Code::Iso);
            prop_assert!(error.is_err() || image[at] == ISO_DELETE || image[at] == BLANK);
        }
    }
}

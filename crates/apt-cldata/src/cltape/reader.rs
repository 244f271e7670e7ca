//! Reads the binary tape.

use apt_geometry::Vec3;
use smol_str::{SmolStr, format_smolstr};

use super::{
    CLASS_END, CLASS_MODE, CLASS_MOTION, CLASS_PARAMETER, CLASS_POSTPROCESSOR, CLASS_SEQUENCE, CLASS_SURFACE,
    DISPLAY_CODE, HEADER_BYTES, MODE_MULTAX, MODE_UNITS, MOTION_FROM, MOTION_GOTO, MOTION_MORE,
    MOTION_NAME_WORDS, PARAMETER_WORDS, SURFACE_DRIVE, SWITCH_WORDS, TEXT_CODES, TEXT_WORDS, WORD_BYTES, ncl,
    word::{DataWord, classify, number},
};
use crate::{
    codes::CodeTable,
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
};

/// Data words of a circle record.
const CIRCLE_WORDS: usize = 12;
/// Where name and numbers stand in it.
const CIRCLE_NAME: usize = 3;
const CIRCLE_NUMBERS: usize = 5;

/// What a tape holds.
#[derive(Debug, Clone, PartialEq)]
pub struct TapeContents {
    /// The records; `source` is `u32::MAX`.
    pub records: Vec<ClRecord>,
    /// What was left out or could not be named.
    pub notes: Vec<TapeNote>,
}

/// Something on a tape that has no counterpart in the records.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TapeNote {
    /// A record of a class that is not known; skipped.
    Skipped {
        /// Serial number on the tape.
        serial: i32,
        /// Class.
        class: i32,
        /// Subclass.
        subclass: i32,
    },
    /// A code without a word.
    UnknownCode {
        /// Serial number on the tape.
        serial: i32,
        /// The code.
        code: i32,
    },
    /// A record whose data words do not fit its class; skipped.
    WrongCount {
        /// Serial number on the tape.
        serial: i32,
        /// Data words it has.
        count: usize,
    },
}

/// Why bytes are no tape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TapeReadError {
    /// A record that says it is longer than the file, or of negative length.
    #[error("the record at byte {offset} has {count} data words, the file ends before")]
    BadLength {
        /// Where its header begins.
        offset: usize,
        /// The count in its header.
        count: i32,
    },
    /// The file ends inside a header.
    #[error("the file ends inside the header at byte {offset}")]
    Truncated {
        /// Where the header begins.
        offset: usize,
    },
}

/// Whether bytes begin like a tape: record 1, two data words, class 1000.
pub fn is_tape(bytes: &[u8]) -> bool {
    const START: [u8; 12] = [1, 0, 0, 0, 2, 0, 0, 0, 0xe8, 3, 0, 0];
    bytes.starts_with(&START)
}

/// Reads a tape of APT III, or a binary CL file of NCL; records of unknown classes are skipped with a note.
///
/// # Errors
/// Bytes that cannot be split into records.
pub fn read_tape(bytes: &[u8], codes: &CodeTable) -> Result<TapeContents, TapeReadError> {
    if ncl::is_ncl_file(bytes) {
        return ncl::read(bytes, codes);
    }
    let mut reader = Reader::new(codes, MOTION_NAME_WORDS);
    let mut offset = 0;
    // One filling byte may stand at the end.
    while bytes.len() - offset > 1 {
        let Some(header) = bytes.get(offset..offset + HEADER_BYTES) else {
            return Err(TapeReadError::Truncated { offset });
        };
        let field =
            |at: usize| i32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
        let (serial, count, class, subclass) = (field(0), field(4), field(8), field(12));
        let start = offset + HEADER_BYTES;
        let data = usize::try_from(count)
            .ok()
            .and_then(|count| count.checked_mul(WORD_BYTES))
            .and_then(|length| bytes.get(start..start.checked_add(length)?));
        let Some(data) = data else { return Err(TapeReadError::BadLength { offset, count }) };
        let words: Vec<[u8; WORD_BYTES]> = data
            .chunks_exact(WORD_BYTES)
            .map(|chunk| {
                let mut word = [0; WORD_BYTES];
                word.copy_from_slice(chunk);
                word
            })
            .collect();
        reader.at(serial, reader.isn);
        reader.record(class, subclass, &words);
        offset = start + data.len();
    }
    Ok(reader.contents())
}

/// Makes records of the data words of a file.
pub(super) struct Reader<'a> {
    codes: &'a CodeTable,
    /// Data words before the coordinates of a motion record.
    name_words: usize,
    isn: u32,
    multax: bool,
    /// The axis of the last position that has one: MULTAX/OFF leaves the tool as it stands.
    axis: Vec3,
    serial: i32,
    records: Vec<ClRecord>,
    notes: Vec<TapeNote>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(codes: &'a CodeTable, name_words: usize) -> Self {
        Self {
            codes,
            name_words,
            isn: 0,
            multax: false,
            axis: Vec3::z(),
            serial: 0,
            records: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The serial number and the statement number of the record that comes next.
    pub(super) fn at(&mut self, serial: i32, isn: u32) {
        (self.serial, self.isn) = (serial, isn);
    }

    /// What has been read.
    pub(super) fn contents(self) -> TapeContents {
        TapeContents { records: self.records, notes: self.notes }
    }

    pub(super) fn record(&mut self, class: i32, subclass: i32, words: &[[u8; WORD_BYTES]]) {
        match (class, subclass) {
            // The number of a CALL is negative.
            (CLASS_SEQUENCE, isn) => self.isn = isn.unsigned_abs(),
            (CLASS_POSTPROCESSOR, code) => self.postprocessor(code, words),
            (CLASS_SURFACE, SURFACE_DRIVE) => self.circle(words),
            (CLASS_MOTION, MOTION_FROM | MOTION_GOTO | MOTION_MORE) => self.motion(subclass, words),
            (CLASS_PARAMETER, _) => self.parameter(subclass, words),
            (CLASS_MODE, MODE_MULTAX) => {
                self.multax = words.first().is_none_or(|word| number(*word) != 0.0);
                self.push(ClKind::MultipleAxes(self.multax));
            }
            (CLASS_MODE, MODE_UNITS) => self.units(words),
            (CLASS_END, _) => self.push(ClKind::End),
            _ => self.notes.push(TapeNote::Skipped { serial: self.serial, class, subclass }),
        }
    }

    pub(super) fn push(&mut self, kind: ClKind) {
        self.records.push(ClRecord { isn: self.isn, source: u32::MAX, kind });
    }

    fn wrong_count(&mut self, count: usize) {
        self.notes.push(TapeNote::WrongCount { serial: self.serial, count });
    }

    fn postprocessor(&mut self, subclass: i32, words: &[[u8; WORD_BYTES]]) {
        let code = u16::try_from(subclass).ok();
        let display = Some(&DISPLAY_CODE).filter(|_| words.len() == TEXT_WORDS);
        if let Some((_, word)) = TEXT_CODES.iter().chain(display).find(|(known, _)| *known == subclass) {
            let text = String::from_utf8_lossy(&ncl::text_of(words)).trim().into();
            return self.push(ClKind::Text { word: (*word).into(), code, text });
        }
        let word = match code.and_then(|code| self.codes.major_word(code)) {
            Some(word) => word.clone(),
            None => {
                self.notes.push(TapeNote::UnknownCode { serial: self.serial, code: subclass });
                format_smolstr!("{subclass}")
            }
        };
        let arguments = words.iter().map(|word| self.argument(*word)).collect();
        self.push(ClKind::Postprocessor { word, code, arguments });
    }

    fn argument(&mut self, bytes: [u8; WORD_BYTES]) -> ClWord {
        match classify(bytes) {
            DataWord::Float(value) => ClWord::Number(value),
            DataWord::Text(text) => ClWord::Word(text.into()),
            DataWord::Integer(code) => match self.codes.minor_word(code) {
                Some(word) => ClWord::Word(word.clone()),
                None => {
                    self.notes.push(TapeNote::UnknownCode { serial: self.serial, code: i32::from(code) });
                    ClWord::Word(format_smolstr!("{code}"))
                }
            },
        }
    }

    fn circle(&mut self, words: &[[u8; WORD_BYTES]]) {
        if words.len() != CIRCLE_WORDS {
            return self.wrong_count(words.len());
        }
        let surface = surface_name(&words[CIRCLE_NAME..]);
        let numbers: Vec<f64> =
            words[CIRCLE_NUMBERS..].iter().map(|word| f64::from_le_bytes(*word)).collect();
        let [x, y, z, i, j, k, radius] = numbers[..] else { return };
        self.push(ClKind::Arc { surface, center: Vec3::new(x, y, z), axis: Vec3::new(i, j, k), radius });
    }

    fn motion(&mut self, subclass: i32, words: &[[u8; WORD_BYTES]]) {
        let per_point = if self.multax { 6 } else { 3 };
        let coordinates = words.len().saturating_sub(self.name_words);
        if words.len() < self.name_words || !coordinates.is_multiple_of(per_point) {
            return self.wrong_count(words.len());
        }
        let value = |word: &[u8; WORD_BYTES]| f64::from_le_bytes(*word);
        let mut points: Vec<ClPoint> = words[self.name_words..]
            .chunks_exact(per_point)
            .map(|words| {
                let at = |start: usize| {
                    Vec3::new(value(&words[start]), value(&words[start + 1]), value(&words[start + 2]))
                };
                let axis = if per_point == 6 { at(3) } else { self.axis };
                ClPoint { position: at(0), axis, with_axis: per_point == 6 }
            })
            .collect();
        self.axis = points.last().map_or(self.axis, |point| point.axis);
        if subclass == MOTION_MORE
            && let Some(ClRecord { kind: ClKind::Motion { points: before, .. }, .. }) =
                self.records.last_mut()
        {
            return before.append(&mut points);
        }
        self.push(ClKind::Motion {
            from: subclass == MOTION_FROM,
            surface: surface_name(&words[..self.name_words]),
            points,
        });
    }

    fn parameter(&mut self, subclass: i32, words: &[[u8; WORD_BYTES]]) {
        let code = [CLASS_PARAMETER as u16, u16::try_from(subclass).unwrap_or(u16::MAX)];
        let on = words.first().is_some_and(|word| number(*word) != 0.0);
        let switch =
            SWITCH_WORDS.iter().find(|(known, number, _)| *known == subclass && (*number != 0) == on);
        if let Some((_, _, word)) = switch {
            return self.push(ClKind::Control { word: (*word).into(), code, arguments: Vec::new() });
        }
        let arguments: Vec<ClWord> = words.iter().map(|word| self.argument(*word)).collect();
        let word = match PARAMETER_WORDS.iter().find(|(known, _)| *known == subclass) {
            Some((_, word)) => SmolStr::new(word),
            None => {
                self.notes.push(TapeNote::UnknownCode { serial: self.serial, code: subclass });
                format_smolstr!("{subclass}")
            }
        };
        self.push(ClKind::Control { word, code, arguments });
    }

    fn units(&mut self, words: &[[u8; WORD_BYTES]]) {
        let code = words.first().map_or(0.0, |word| number(*word)) as u16;
        match self.codes.minor_word(code).map(SmolStr::as_str) {
            Some("INCHES" | "INCH") => self.push(ClKind::Units(Units::Inches)),
            Some("MM") => self.push(ClKind::Units(Units::Millimeters)),
            _ => self.notes.push(TapeNote::UnknownCode { serial: self.serial, code: i32::from(code) }),
        }
    }
}

/// `NAME` or `NAME(3)` from the first two words.
fn surface_name(words: &[[u8; WORD_BYTES]]) -> SmolStr {
    let Some(DataWord::Text(name)) = words.first().map(|word| classify(*word)) else {
        return SmolStr::default();
    };
    match words.get(1).map_or(0.0, |word| number(*word)) {
        subscript if subscript >= 1.0 => format_smolstr!("{name}({subscript})"),
        _ => name.into(),
    }
}

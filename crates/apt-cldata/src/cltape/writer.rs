//! Writes the binary tape.

use apt_geometry::{
    Vec3,
    patience::{Patience, put_away},
};
use smol_str::SmolStr;

use super::{
    CIRCLE_COUNT, CIRCLE_TYPE, CLASS_END, CLASS_MODE, CLASS_MOTION, CLASS_PARAMETER, CLASS_POSTPROCESSOR,
    CLASS_SEQUENCE, CLASS_SURFACE, DISPLAY_CODE, MODE_MULTAX, MODE_UNITS, MOTION_COORDINATE_WORDS,
    MOTION_FROM, MOTION_GOTO, MOTION_MORE, SURFACE_DRIVE, SWITCH_WORDS, TEXT_CHARACTERS_PER_WORD, TEXT_CODES,
    TEXT_WORDS, WORD_BYTES, word,
};
use crate::{
    codes::CodeTable,
    record::{ClKind, ClPoint, ClRecord, ClWord, POSITIONS_A_UNIT, Units, ends_before},
};

/// Characters of text that a record holds: columns 7 to 72 of a card.
const TEXT_LENGTH: usize = TEXT_WORDS * TEXT_CHARACTERS_PER_WORD;

/// Why records cannot be written as a tape.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TapeWriteError {
    /// A word without an integer code.
    #[error("statement {isn}: {word} has no code")]
    NoCode {
        /// Statement number.
        isn: u32,
        /// The word.
        word: SmolStr,
    },
    /// UNITS with a unit that has no code.
    #[error(
        "statement {isn}: the tape has no code for UNITS/{unit}; leave the statement out for this tape, whose numbers are in \
         the unit of the program anyway, or write CL text"
    )]
    Unit {
        /// Statement number.
        isn: u32,
        /// The unit.
        unit: SmolStr,
    },
    /// The name of a post-processor that its data word does not hold.
    #[error(
        "statement {isn}: the post-processor {name} has more than the {TEXT_CHARACTERS_PER_WORD} characters that a name has on \
         the tape, or others than ASCII"
    )]
    MachineName {
        /// Statement number.
        isn: u32,
        /// The name.
        name: SmolStr,
    },
    /// Text that the 66 columns of a card do not hold.
    #[error("statement {isn}: {length} characters of text, {TEXT_LENGTH} fit")]
    TextTooLong {
        /// Statement number.
        isn: u32,
        /// Its length with the blank after the word.
        length: usize,
    },
    /// Text with a character that is not ASCII.
    #[error("statement {isn}: {character:?} is not in the character set")]
    Character {
        /// Statement number.
        isn: u32,
        /// The character.
        character: char,
    },
    /// More records or words than 32-bit numbers count.
    #[error("the tape is too long")]
    TooLong,
}

/// Writes records as a tape. Codes of words come from the records, and where those have none from `codes`.
///
/// # Errors
/// The first record that the format cannot hold.
pub fn write_tape(records: &[ClRecord], codes: &CodeTable) -> Result<Vec<u8>, TapeWriteError> {
    written(records, codes, Patience::default())
}

/// The same; `None` when who waits has given up before the end.
///
/// # Errors
///
/// As [`write_tape`].
pub fn write_tape_until(
    records: &[ClRecord],
    codes: &CodeTable,
    patience: Patience<'_>,
) -> Result<Option<Vec<u8>>, TapeWriteError> {
    let bytes = written(records, codes, patience)?;
    if patience.was_over() {
        let records = bytes.capacity() / WORD_BYTES;
        put_away(bytes, records);
        return Ok(None);
    }
    Ok(Some(bytes))
}

/// The tape up to the end, or to where who waits gives up.
pub(crate) fn written(
    records: &[ClRecord],
    codes: &CodeTable,
    patience: Patience<'_>,
) -> Result<Vec<u8>, TapeWriteError> {
    // What grows is copied as a whole, which nobody can interrupt.
    let bytes = Vec::with_capacity(most_bytes(records, patience));
    let mut writer = Writer { codes, bytes, serial: 0, multax: false };
    let mut statement = None;
    for (at, record) in records.iter().enumerate() {
        if ends_before(record.position_count(), patience) {
            break;
        }
        let this = (record.isn, record.source);
        if record.isn != 0 && statement != Some(this) {
            let isn = i32::try_from(record.isn).map_err(|_| TapeWriteError::TooLong)?;
            writer.put(CLASS_SEQUENCE, isn, &[[0; WORD_BYTES], [b' '; WORD_BYTES]])?;
        }
        statement = Some(this);
        if !writer.multax && tells_tilted_axis(&records[at..]) {
            writer.record(&ClRecord { kind: ClKind::MultipleAxes(true), ..*record })?;
        }
        writer.record(record)?;
    }
    Ok(writer.bytes)
}

/// Whether records begin with a motion, or with a circle and its motion, that tells a tool axis other than z. The tape has
/// axes only under MULTAX.
fn tells_tilted_axis(records: &[ClRecord]) -> bool {
    let points = match records {
        [ClRecord { kind: ClKind::Motion { points, .. }, .. }, ..]
        | [
            ClRecord { kind: ClKind::Arc { .. }, .. },
            ClRecord { kind: ClKind::Motion { points, .. }, .. },
            ..,
        ] => points,
        _ => return false,
    };
    points.iter().any(|point| point.with_axis && point.axis != Vec3::z())
}

/// Bytes that a tape of some records has at most; fewer where who waits gives up before the end.
fn most_bytes(records: &[ClRecord], patience: Patience<'_>) -> usize {
    /// The header of a record, four numbers of half a word.
    const HEADER_WORDS: usize = 2;
    /// With the header of a sequence number, which may stand before it, and its two words.
    const BEFORE_WORDS: usize = 2 * HEADER_WORDS + 2;
    /// Position and axis.
    const POINT_WORDS: usize = 6;
    /// MULTAX, which may have to be put before a motion.
    const MULTAX_WORDS: usize = HEADER_WORDS + 1;
    /// A surface before its figures, a circle with them.
    const CIRCLE_WORDS: usize = 12;
    let words = |record: &ClRecord| match &record.kind {
        ClKind::Motion { points, .. } => {
            let words = points.len() * POINT_WORDS;
            words + MULTAX_WORDS + (2 + HEADER_WORDS) * (1 + words / MOTION_COORDINATE_WORDS)
        }
        ClKind::Postprocessor { arguments, .. } => arguments.len(),
        // One for the number of a switch.
        ClKind::Control { arguments, .. } => arguments.len().max(1),
        ClKind::Text { .. } => TEXT_WORDS,
        ClKind::Arc { .. } => CIRCLE_WORDS,
        ClKind::MultipleAxes(_) | ClKind::Units(_) | ClKind::End => 1,
    };
    let pieces = records.chunks(POSITIONS_A_UNIT).take_while(|_| !patience.ends_after(1));
    pieces.flatten().map(|record| (BEFORE_WORDS + words(record)) * WORD_BYTES).sum()
}

struct Writer<'a> {
    codes: &'a CodeTable,
    bytes: Vec<u8>,
    serial: i32,
    multax: bool,
}

impl Writer<'_> {
    fn put(&mut self, class: i32, subclass: i32, words: &[[u8; WORD_BYTES]]) -> Result<(), TapeWriteError> {
        self.serial = self.serial.checked_add(1).ok_or(TapeWriteError::TooLong)?;
        let count = i32::try_from(words.len()).map_err(|_| TapeWriteError::TooLong)?;
        for header in [self.serial, count, class, subclass] {
            self.bytes.extend_from_slice(&header.to_le_bytes());
        }
        self.bytes.extend(words.iter().flatten());
        Ok(())
    }

    fn record(&mut self, record: &ClRecord) -> Result<(), TapeWriteError> {
        let isn = record.isn;
        match &record.kind {
            ClKind::Postprocessor { word, code, arguments } => {
                let subclass = self.major(isn, word, *code)?;
                let (name, rest) = machine_name(isn, word, arguments)?;
                let words: Vec<_> = name.into_iter().chain(self.words(isn, rest)?).collect();
                self.put(CLASS_POSTPROCESSOR, subclass, &words)
            }
            ClKind::Text { word, code, text } => {
                let known = TEXT_CODES
                    .iter()
                    .chain([&DISPLAY_CODE])
                    .find(|(_, name)| name == word)
                    .map(|(code, _)| *code);
                let subclass = match known {
                    Some(subclass) => subclass,
                    None => self.major(isn, word, *code)?,
                };
                let words = text_words(isn, text)?;
                self.put(CLASS_POSTPROCESSOR, subclass, &words)
            }
            ClKind::Arc { surface, center, axis, radius } => {
                let (name, subscript) = name_words(surface);
                let mut words = vec![
                    [0; WORD_BYTES],
                    word::integer(CIRCLE_TYPE),
                    word::integer(CIRCLE_COUNT),
                    name,
                    subscript,
                ];
                words.extend(center.iter().chain(axis.iter()).map(|value| word::float(*value)));
                words.push(word::float(*radius));
                self.put(CLASS_SURFACE, SURFACE_DRIVE, &words)
            }
            ClKind::Motion { from, surface, points } => self.motion(*from, surface, points),
            ClKind::Control { word, code: [class, subclass], arguments } => {
                let (class, subclass) = (i32::from(*class), i32::from(*subclass));
                let switch =
                    SWITCH_WORDS.iter().find(|(_, _, name)| class == CLASS_PARAMETER && name == word);
                let words = match switch {
                    Some((_, number, _)) => vec![word::integer(*number)],
                    None => self.words(isn, arguments)?,
                };
                self.put(class, subclass, &words)
            }
            ClKind::MultipleAxes(on) => {
                self.multax = *on;
                self.put(CLASS_MODE, MODE_MULTAX, &[word::integer(u32::from(*on))])
            }
            ClKind::Units(units) => {
                let name = match units {
                    Units::Inches => "INCHES",
                    Units::Millimeters => "MM",
                };
                let code = self.codes.minor_code(name);
                let code = code.ok_or_else(|| TapeWriteError::Unit { isn, unit: name.into() })?;
                self.put(CLASS_MODE, MODE_UNITS, &[word::integer(u32::from(code))])
            }
            ClKind::End => self.put(CLASS_END, 0, &[]),
        }
    }

    fn major(&self, isn: u32, word: &SmolStr, code: Option<u16>) -> Result<i32, TapeWriteError> {
        let code = code.or_else(|| self.codes.major_code(word));
        code.map(i32::from).ok_or_else(|| TapeWriteError::NoCode { isn, word: word.clone() })
    }

    fn words(&self, isn: u32, arguments: &[ClWord]) -> Result<Vec<[u8; WORD_BYTES]>, TapeWriteError> {
        let one = |argument: &ClWord| match argument {
            ClWord::Number(value) => Ok(word::float(*value)),
            ClWord::Word(text) if text.is_empty() => Ok([0; WORD_BYTES]),
            ClWord::Word(text) => match self.codes.minor_code(text) {
                Some(code) => Ok(word::integer(u32::from(code))),
                None => Err(TapeWriteError::NoCode { isn, word: text.clone() }),
            },
        };
        arguments.iter().map(one).collect()
    }

    /// A motion in pieces of at most 240 coordinates; the first is a FROM or GOTO, the others continue it.
    fn motion(&mut self, from: bool, surface: &str, points: &[ClPoint]) -> Result<(), TapeWriteError> {
        let (name, subscript) = name_words(surface);
        let per_point = if self.multax { 6 } else { 3 };
        let mut subclass = if from { MOTION_FROM } else { MOTION_GOTO };
        for piece in points.chunks(MOTION_COORDINATE_WORDS / per_point) {
            let mut words = vec![name, subscript];
            for point in piece {
                words.extend(point.position.iter().map(|value| word::float(*value)));
                if self.multax {
                    words.extend(point.axis.iter().map(|value| word::float(*value)));
                }
            }
            self.put(CLASS_MOTION, subclass, &words)?;
            subclass = MOTION_MORE;
        }
        Ok(())
    }
}

/// The name of a post-processor, which is no word and has no code, and the arguments behind it. A name that is too long is
/// an error: cut off it would name another one.
fn machine_name<'a>(isn: u32, word: &str, arguments: &'a [ClWord]) -> Result<NamedFirst<'a>, TapeWriteError> {
    match arguments {
        [ClWord::Word(name), rest @ ..] if word == "MACHIN" && !name.is_empty() => {
            if name.len() > TEXT_CHARACTERS_PER_WORD || !name.is_ascii() {
                return Err(TapeWriteError::MachineName { isn, name: name.clone() });
            }
            Ok((Some(word::name(name)), rest))
        }
        _ => Ok((None, arguments)),
    }
}

/// The data word of a name, and the arguments behind it.
type NamedFirst<'a> = (Option<[u8; WORD_BYTES]>, &'a [ClWord]);

/// `C1` or `C(3)` as name and subscript.
fn name_words(surface: &str) -> ([u8; WORD_BYTES], [u8; WORD_BYTES]) {
    let (name, subscript) = match surface.split_once('(') {
        Some((name, rest)) => (name, rest.trim_end_matches(')').trim().parse::<u32>().unwrap_or(0)),
        None => (surface, 0),
    };
    let ascii: String = name.trim().chars().filter(char::is_ascii).collect();
    (word::name(&ascii), word::integer(subscript))
}

fn text_words(isn: u32, text: &str) -> Result<Vec<[u8; WORD_BYTES]>, TapeWriteError> {
    if let Some(character) = text.chars().find(|c| !(' '..='~').contains(c)) {
        return Err(TapeWriteError::Character { isn, character });
    }
    let text = text.trim();
    let blank = if text.is_empty() { 0 } else { 1 };
    let length = text.len() + blank;
    if length > TEXT_LENGTH {
        return Err(TapeWriteError::TextTooLong { isn, length });
    }
    let mut characters = [b' '; TEXT_LENGTH];
    characters[blank..length].copy_from_slice(text.as_bytes());
    let pack = |piece: &[u8]| {
        let mut word = [b' '; WORD_BYTES];
        word[..piece.len()].copy_from_slice(piece);
        word
    };
    Ok(characters.chunks(TEXT_CHARACTERS_PER_WORD).map(pack).collect())
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn a_tape_takes_no_more_room_than_was_foreseen() {
        let point = ClPoint { position: Vec3::new(1.0, 2.0, 3.0), axis: Vec3::z(), with_axis: true };
        let motion =
            |count| ClKind::Motion { from: false, surface: "S(3)".into(), points: vec![point; count] };
        let word = |count| ClKind::Postprocessor {
            word: "FEDRAT".into(),
            code: Some(1009),
            arguments: vec![ClWord::Number(1.0); count],
        };
        let (center, axis) = (Vec3::zeros(), Vec3::z());
        let mut kinds = vec![
            ClKind::Text { word: "PARTNO".into(), code: Some(1045), text: "A PART".into() },
            ClKind::Arc { surface: "C1".into(), center, axis, radius: 1.0 },
            ClKind::Control {
                word: "CUTTER".into(),
                code: [6000, 6],
                arguments: vec![ClWord::Number(1.0); 7],
            },
            ClKind::Control { word: "DNTCUT".into(), code: [6000, 1], arguments: vec![] },
            ClKind::End,
        ];
        for multax in [false, true] {
            kinds.push(ClKind::MultipleAxes(multax));
            kinds.extend([0, 1, 39, 40, 41, 80, 81, 1_000].map(motion));
            kinds.extend([0, 1, 20].map(word));
        }
        let records: Vec<ClRecord> =
            (1..).zip(kinds).map(|(isn, kind)| ClRecord { isn, source: isn, kind }).collect();
        for count in 0..=records.len() {
            let records = &records[..count];
            let bytes = write_tape(records, &CodeTable::new()).expect("all have codes");
            let most = most_bytes(records, Patience::default());
            assert!(bytes.len() <= most, "{} bytes, {most} foreseen, of {:?}", bytes.len(), records.last());
        }
    }
}

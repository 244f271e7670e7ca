//! Writes a CL file in another dialect.
//!
//! Two steps: `translate` spells what is said in the words of the target (tools, cutters, cycles, the order of values and units, operations),
//! then the text writer or the writer of the tape lays it out. What the target cannot say stays as a remark, quoted behind `$$ |`, so that it
//! is a statement again when the file is converted back; where there are no remarks it is left out, and both are told ([`ConversionNote`]).
//! The path never changes by that: positions, tool axes and rapid moves are written in full, numbers to the last bit.

mod cycle;
mod tape;
mod translate;
mod words;

use apt_geometry::{
    Vec3,
    patience::{Patience, put_away},
};
use smol_str::SmolStr;

use crate::{
    cltape::TapeWriteError,
    codes::CodeTable,
    record::{ClKind, Units},
    text::{ClDialect, ClFile, ClText, dialects::Form, writer},
};

/// A file in the dialect that was asked for, and what is to be told of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// The file.
    pub file: ConvertedFile,
    /// What could not be said as it was, in order of the first place of each.
    pub notes: Vec<ConversionNote>,
}

/// A CL file to be stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ConvertedFile {
    /// Text.
    Text(String),
    /// A binary tape.
    Tape(Vec<u8>),
}

/// Something that the target says otherwise, or not at all.
#[derive(Debug, Clone, PartialEq)]
pub struct ConversionNote {
    /// Statement number of the first place.
    pub isn: u32,
    /// `source` of the record there; the line for CL text.
    pub source: u32,
    /// What.
    pub kind: ConversionNoteKind,
    /// How many places there are.
    pub times: usize,
}

/// What the target says otherwise.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConversionNoteKind {
    /// A statement of another system, kept as a remark.
    #[error("{word} is not of this dialect; it stands as a remark")]
    AsRemark {
        /// The word, with the part that is meant.
        word: SmolStr,
    },
    /// A record that the tape cannot hold.
    #[error("{word} is left out: {why}")]
    LeftOut {
        /// The word.
        word: SmolStr,
        /// Why.
        why: SmolStr,
    },
    /// Remarks, which the tape cannot hold.
    #[error("remarks are left out, a tape holds none")]
    RemarkLeftOut,
    /// A word whose parameters could not be understood.
    #[error("{word} is written with the parameters of the source, which mean what the source means by them")]
    Untranslated {
        /// The word, with the part that is meant.
        word: SmolStr,
    },
    /// A part of a statement that no record holds.
    #[error("{word} is written without what stands behind its radius")]
    Shortened {
        /// The word.
        word: SmolStr,
    },
    /// A cycle of a name that stands for another one in the target.
    #[error("CYCLE/{word} keeps its name, and the target drills otherwise by it")]
    OtherCycle {
        /// The name of the cycle.
        word: SmolStr,
    },
    /// A circle that is no arc, or none that the target can say: the positions stand alone.
    #[error("a circle is written by its positions alone")]
    PositionsAlone,
    /// An arc of which only the end is written.
    #[error("an arc is written by its end alone, up to {misfit} from the positions and chords of the source")]
    WithoutPositions {
        /// How far, as the arc is read back, in the unit of the file.
        misfit: f64,
    },
    /// MULTAX/ON was put before a position, since its tool axis would be lost.
    #[error("MULTAX/ON is added, for the tool axis")]
    AxisTold,
    /// UNITS was added, as the feed rates say it.
    #[error("UNITS/{} is added, as the feed rates say", unit_word(*units))]
    UnitsAdded {
        /// The unit.
        units: Units,
    },
    /// The target is to say its unit and nothing tells it.
    #[error("no unit is told, and this dialect is read with that of its system")]
    NoUnits,
}

/// UNITS and its word.
pub(crate) fn unit_word(units: Units) -> &'static str {
    match units {
        Units::Inches => "INCHES",
        Units::Millimeters => "MM",
    }
}

/// Writes a file in a dialect. `from` tells in whose words it is written; `codes` has the integer codes of words for the tape.
///
/// # Errors
/// [`TapeWriteError::TooLong`] when a tape has more records or words than it can count.
pub fn convert(
    file: &ClText,
    from: ClDialect,
    to: ClDialect,
    codes: &CodeTable,
) -> Result<Conversion, TapeWriteError> {
    converted(file.into(), from, to, codes, Patience::default())
}

/// The same; `None` when who waits has given up before the end.
///
/// # Errors
///
/// As [`convert`].
pub fn convert_until(
    file: ClFile<'_>,
    from: ClDialect,
    to: ClDialect,
    codes: &CodeTable,
    patience: Patience<'_>,
) -> Result<Option<Conversion>, TapeWriteError> {
    let conversion = converted(file, from, to, codes, patience)?;
    Ok((!patience.was_over()).then_some(conversion))
}

/// The file up to the end, or to where who waits gives up.
fn converted(
    file: ClFile<'_>,
    from: ClDialect,
    to: ClDialect,
    codes: &CodeTable,
    patience: Patience<'_>,
) -> Result<Conversion, TapeWriteError> {
    let mut notes = Notes::default();
    for shortened in file.shortened {
        notes.add((0, shortened.line), ConversionNoteKind::Shortened { word: shortened.word.clone() });
    }
    let items = translate::translate(file, Form::of(from), Form::of(to), &mut notes, patience);
    let file = match to {
        ClDialect::Cltape => ConvertedFile::Tape(tape::write(&items, codes, &mut notes, patience)?),
        _ => ConvertedFile::Text(writer::write(&items, Form::of(to), &mut notes, patience)),
    };
    let count = items.len();
    put_away(items, count);
    Ok(Conversion { file, notes: notes.0 })
}

/// One thing to be written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Item {
    pub(crate) isn: u32,
    pub(crate) source: u32,
    pub(crate) what: What,
}

impl Item {
    /// How many positions it holds.
    pub(crate) fn position_count(&self) -> usize {
        if let What::Record(kind) = &self.what { kind.position_count() } else { 0 }
    }
}

/// What is to be written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum What {
    Record(ClKind),
    /// What stands behind `$$`.
    Remark(String),
}

/// What stands before the text of a remark that quotes another dialect.
pub(crate) const QUOTATION: &str = " |";

/// Notes, each kind once.
#[derive(Debug, Default)]
pub(crate) struct Notes(Vec<ConversionNote>);

impl Notes {
    pub(crate) fn add(&mut self, (isn, source): (u32, u32), kind: ConversionNoteKind) {
        use ConversionNoteKind::WithoutPositions;
        for note in &mut self.0 {
            match (&mut note.kind, &kind) {
                (WithoutPositions { misfit }, WithoutPositions { misfit: other }) => {
                    *misfit = misfit.max(*other);
                }
                (known, new) if known == new => {}
                _ => continue,
            }
            note.times += 1;
            return;
        }
        self.0.push(ConversionNote { isn, source, kind, times: 1 });
    }
}

/// Whether two unit axes are written alike. A position without an axis takes over that of the one before, to the last bit.
pub(crate) fn same_axis(one: &Vec3, other: &Vec3) -> bool {
    one == other
}

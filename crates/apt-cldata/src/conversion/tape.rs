//! The binary tape as a target.

use std::collections::VecDeque;

use smol_str::{SmolStr, format_smolstr};

use super::{ConversionNoteKind as Kind, Item, Notes, What, same_axis};
use crate::{
    cltape::{TEXT_CHARACTERS_PER_WORD, TapeWriteError, write_tape, written},
    codes::CodeTable,
    record::{ClKind, ClRecord, ends_before},
};
use apt_geometry::{Vec3, patience::Patience};

/// Writes what the tape can hold, and tells what it cannot; less where who waits gives up before the end.
pub(super) fn write(
    items: &VecDeque<Item>,
    codes: &CodeTable,
    notes: &mut Notes,
    patience: Patience<'_>,
) -> Result<Vec<u8>, TapeWriteError> {
    let mut records: Vec<ClRecord> = Vec::with_capacity(items.len());
    let mut axes = AxisInForce { multax: false, axis: Vec3::z() };
    for item in items {
        if ends_before(item.position_count(), patience) {
            break;
        }
        let place = (item.isn, item.source);
        let kind = match &item.what {
            What::Record(kind) => kind,
            What::Remark(_) => {
                notes.add(place, Kind::RemarkLeftOut);
                continue;
            }
        };
        let record = |kind: ClKind| ClRecord { isn: item.isn, source: item.source, kind };
        match kind {
            ClKind::Motion { .. } | ClKind::Arc { .. } | ClKind::MultipleAxes(_) | ClKind::End => {
                if axes.takes(kind) {
                    notes.add(place, Kind::AxisTold);
                    // A circle stays with its positions.
                    let circle = matches!(records.last(), Some(ClRecord { kind: ClKind::Arc { .. }, .. }));
                    records.insert(records.len() - usize::from(circle), record(ClKind::MultipleAxes(true)));
                }
                records.push(record(kind.clone()));
            }
            _ => {
                let one = record(kind.clone());
                match write_tape(std::slice::from_ref(&one), codes) {
                    Ok(_) => records.push(one),
                    Err(error) => notes.add(place, left_out(kind, &error)),
                }
            }
        }
    }
    written(&records, codes, patience)
}

fn left_out(kind: &ClKind, error: &TapeWriteError) -> Kind {
    let word = match kind {
        ClKind::Postprocessor { word, .. } | ClKind::Text { word, .. } | ClKind::Control { word, .. } => {
            word.clone()
        }
        _ => SmolStr::new_static("UNITS"),
    };
    let why = match error {
        TapeWriteError::NoCode { word, .. } => format_smolstr!("{word} has no code on a tape"),
        TapeWriteError::Unit { unit, .. } => format_smolstr!("a tape has no code for {unit}"),
        TapeWriteError::MachineName { .. } => {
            format_smolstr!(
                "the name has more than {TEXT_CHARACTERS_PER_WORD} characters or others than ASCII"
            )
        }
        TapeWriteError::TextTooLong { length, .. } => {
            format_smolstr!("{length} characters of text are too many")
        }
        TapeWriteError::Character { character, .. } => {
            format_smolstr!("{character:?} is not in the character set of a tape")
        }
        TapeWriteError::TooLong => SmolStr::new_static("it is too long"),
    };
    Kind::LeftOut { word, why }
}

/// The tool axis that a reader of the tape has.
struct AxisInForce {
    multax: bool,
    axis: Vec3,
}

impl AxisInForce {
    /// Takes a record; whether MULTAX has to be put before it so that its tool axis stands on the tape.
    fn takes(&mut self, kind: &ClKind) -> bool {
        match kind {
            ClKind::MultipleAxes(on) => self.multax = *on,
            ClKind::Motion { points, .. } => {
                let changed = points.iter().any(|point| !same_axis(&point.axis, &self.axis));
                let added = changed && !self.multax;
                self.multax |= changed;
                if self.multax {
                    self.axis = points.last().map_or(self.axis, |point| point.axis);
                }
                return added;
            }
            _ => {}
        }
        false
    }
}

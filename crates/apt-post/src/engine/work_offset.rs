//! The work offset, in which the coordinates of the tape are meant: in force before the first motion, of whatever kind.

use super::Engine;

/// How far the control has been told of a work offset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WorkOffset {
    /// It has not.
    Due,
    /// That of the machine definition is on the tape, perhaps only in a block that may be skipped.
    Written {
        /// In such a block.
        optional: bool,
    },
    /// The program has chosen one by PREFUN or INSERT, which stays.
    Chosen,
}

impl Engine<'_> {
    /// Whether a code, or a word of a verbatim text, puts a work offset in force.
    pub(super) fn note_work_offset(&mut self, text: &str) {
        let offsets = &self.machine.codes.work_offsets;
        if text.split_whitespace().any(|word| offsets.iter().any(|code| code == word)) {
            self.work_offset = WorkOffset::Chosen;
        }
    }

    /// The code for the first block of a tool; empty where the program has chosen another one.
    pub(super) fn work_offset_code(&mut self) -> String {
        if self.work_offset == WorkOffset::Chosen {
            return String::new();
        }
        self.work_offset = WorkOffset::Written { optional: self.control.skip.is_some() };
        self.machine.codes.work_offsets.first().cloned().unwrap_or_default()
    }

    /// Brings the work offset in force before a motion that no template of a first motion makes.
    pub(super) fn work_offset_now(&mut self) {
        if self.work_offset != WorkOffset::Due {
            return;
        }
        let code = self.work_offset_code();
        if !code.is_empty() {
            self.control.code(&code);
        }
    }
}

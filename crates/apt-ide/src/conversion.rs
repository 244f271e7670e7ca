//! Between CL dialects: of a program, which is run first, or of a CL file, which is read.

use apt_cldata::{
    conversion::convert_until,
    text::{ClFile, detect},
};
use apt_geometry::{patience::Waiting, pieces::followed};
use apt_run::{catalogue, diagnostic::Diagnostic, go_on};
use apt_syntax::dialect::DialectName;

pub use apt_cldata::{
    conversion::ConvertedFile,
    text::{ClDialect, UnknownClDialect},
};

use crate::{
    Analysis, Cancel, Cancelled,
    tape::{code_table, system_of_binary},
};

/// A file in another dialect.
#[derive(Debug, Clone, PartialEq)]
pub struct Converted {
    /// The file.
    pub file: ConvertedFile,
    /// What it was made of.
    pub from: ClDialect,
    /// What was found in the program or CL file, and what the other dialect says otherwise.
    pub diagnostics: Vec<Diagnostic>,
}

/// Why a file cannot be converted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConversionError {
    /// A file that is no APT at all.
    #[error("this is {}, which is not read", .0.title())]
    NotRead(ClDialect),
    /// Bytes that are no tape.
    #[error(transparent)]
    TapeNotRead(#[from] apt_cldata::cltape::TapeReadError),
    /// The tape would be too long.
    #[error(transparent)]
    Tape(#[from] apt_cldata::cltape::TapeWriteError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Analysis {
    /// The program or CL file in a CL dialect. The text of a CL file (dialect `cl`) is read as it stands, and so is the binary `tape` of which
    /// this is the text form; any other program is run.
    ///
    /// # Errors
    ///
    /// [`ConversionError`] when the text is no APT, the tape would be too long, or `cancel` said so before the end.
    pub fn convert(
        &self,
        to: ClDialect,
        tape: Option<&[u8]>,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Converted, ConversionError> {
        let detected = detect(&self.text());
        if detected == Some(ClDialect::Nci) {
            return Err(ConversionError::NotRead(ClDialect::Nci));
        }
        let (source, from) = match (tape, self.document().dialect()) {
            (Some(bytes), _) => {
                (self.read_tape(bytes, cancel)??, system_of_binary(bytes).unwrap_or(ClDialect::Cltape))
            }
            (None, DialectName::Cl) => {
                let known = detected.filter(|dialect| ClDialect::ALL.contains(dialect));
                (self.read_cutter_locations(cancel)?, known.unwrap_or(ClDialect::Generic))
            }
            (None, _) => (self.run_to_cutter_locations(cancel, progress)?, ClDialect::PartProgram),
        };
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let file =
            ClFile { records: source.records.list(), remarks: &source.remarks, shortened: &source.shortened };
        let made = convert_until(file, from, to, &code_table(), patience)?.ok_or(Cancelled)?;
        let diagnostics = source.diagnostics;
        let (tree, settings) = (self.document().tree(), self.document().settings());
        let origins = source.records.origins();
        let told = catalogue::conversion_diagnostics(tree, &made.notes, origins, settings, patience)?;
        let diagnostics = followed(diagnostics, told, patience);
        go_on(patience, 0)?;
        Ok(Converted { file: made.file, from, diagnostics })
    }
}

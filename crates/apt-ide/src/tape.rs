//! The control tape: of a program, which is run first, or of the text of a CL file, which is read.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

use apt_cldata::{
    cltape::{TapeNote, TapeReadError},
    codes::CodeTable,
    record::ClRecord,
    text::{
        ClDialect, ClText, ReadError, Remark, Shortened, detect, read_with_remarks_until,
        write_text_with_lines_until,
    },
};
use apt_geometry::{
    patience::{Patience, Waiting, put_away},
    pieces::{Pieces, followed},
};
use apt_post::{MachineDefinition, PostOptions, Tape};
use apt_program::{
    Origin,
    record::{PostArgument, RecordKind},
};
use apt_run::{
    catalogue,
    diagnostic::Diagnostic,
    document::Level,
    go_on,
    pipeline::RunResult,
    settings::{Settings, Units},
};
use apt_syntax::{
    TextRange, TextSize,
    dialect::DialectName,
    vocabulary::{self, WordClass},
};

use apt_post::punch::find_lacking;
pub use apt_post::{
    MachineInfo,
    punch::{Code as TapeCode, PunchError, length_inches},
};

use crate::{Analysis, Cancel, Cancelled};

/// Why a tape cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TapeError {
    /// There is no machine of this name.
    #[error("there is no machine {name}; there are {}", known.join(", "))]
    UnknownMachine {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// The definition file of a machine cannot be used.
    #[error("{}: {why}", file.display())]
    Definition {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Why a binary CLTAPE cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ClTapeError {
    /// A record does not fit the tape.
    #[error(transparent)]
    Tape(#[from] apt_cldata::cltape::TapeWriteError),
    /// The run was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A control tape with everything found on the way to it.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlTape {
    /// The tape; its blocks name the statements they come from.
    pub tape: Tape,
    /// What was found in the program or CL file, and then by the post-processor.
    pub diagnostics: Vec<Diagnostic>,
    /// Of what it is made.
    records: Arc<Records>,
}

impl ControlTape {
    /// Where each block comes from, with the calls and turns that led there; `None` for a block that no statement has made.
    pub fn block_origins(&self) -> impl Iterator<Item = Option<&Origin>> {
        self.tape.blocks.iter().map(|block| self.records.origins().get(block.source as usize))
    }
}

/// Characters of text that a statement of a CL text file carries at most.
const CL_TEXT: usize = 80;

/// The ending of the names of definition files; what ends otherwise is the name of a machine that comes with the program.
pub const DEFINITION_ENDING: &str = ".toml";

/// A file larger than this is no definition of a machine (bytes).
const GREATEST_DEFINITION: u64 = 1 << 20;

/// The machines that come with the program.
pub fn machines() -> Vec<MachineInfo> {
    apt_post::machines()
}

/// The definition of a machine that comes with the program.
///
/// # Errors
///
/// [`TapeError::UnknownMachine`].
pub fn machine(name: &str) -> Result<MachineDefinition, TapeError> {
    apt_post::machine(name).map_err(|_| unknown_machine(name))
}

/// The text of that definition, to begin another one with.
///
/// # Errors
///
/// [`TapeError::UnknownMachine`].
pub fn definition_file(name: &str) -> Result<&'static str, TapeError> {
    apt_post::definition_file(name).map_err(|_| unknown_machine(name))
}

fn unknown_machine(name: &str) -> TapeError {
    let known = machines().into_iter().map(|machine| machine.name).collect();
    TapeError::UnknownMachine { name: name.to_owned(), known }
}

/// Reads the definition file of a machine.
fn machine_of_file(file: PathBuf) -> Result<MachineDefinition, TapeError> {
    let read = || {
        let length = fs::metadata(&file).map_err(|error| error.to_string())?.len();
        if length > GREATEST_DEFINITION {
            return Err(format!("larger than {GREATEST_DEFINITION} bytes"));
        }
        let text = fs::read_to_string(&file).map_err(|error| error.to_string())?;
        MachineDefinition::from_toml(&text).map_err(|error| error.to_string().trim_end().to_owned())
    };
    read().map_err(|why| TapeError::Definition { file, why })
}

/// The image of a tape as a punch makes it.
///
/// # Errors
///
/// The first character that the code lacks.
pub fn punch(tape: &Tape, code: TapeCode) -> Result<Vec<u8>, PunchError> {
    apt_post::punch::punch(&tape.text(), code)
}

/// CL records with their origins: those of a run, which are not copied, or of a file.
#[derive(Debug, Clone)]
pub(crate) enum Records {
    Run(Arc<RunResult>),
    Read { records: Vec<ClRecord>, origins: Vec<Origin> },
}

impl Records {
    pub(crate) fn list(&self) -> &[ClRecord] {
        match self {
            Self::Run(result) => &result.records,
            Self::Read { records, .. } => records,
        }
    }

    /// Where they come from; [`ClRecord::source`] is an index into it.
    pub(crate) fn origins(&self) -> &[Origin] {
        match self {
            Self::Run(result) => &result.origins,
            Self::Read { origins, .. } => origins,
        }
    }
}

impl PartialEq for Records {
    fn eq(&self, other: &Self) -> bool {
        self.list() == other.list() && self.origins() == other.origins()
    }
}

/// The records that a tape is made of.
pub(crate) struct Source {
    pub(crate) records: Arc<Records>,
    /// What only people read in CL text.
    pub(crate) remarks: Vec<Remark>,
    pub(crate) shortened: Vec<Shortened>,
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Source {
    /// What a run made, with what was found in the program.
    fn of_run(result: Arc<RunResult>, diagnostics: Vec<Diagnostic>) -> Self {
        let records = Arc::new(Records::Run(result));
        Self { records, remarks: Vec::new(), shortened: Vec::new(), diagnostics }
    }
}

impl Analysis {
    /// The control tape for a machine. The text of a CL file (dialect `cl`) is read as it stands; any other program
    /// is run.
    ///
    /// # Errors
    ///
    /// [`TapeError`] when there is no such machine or the run was cancelled.
    pub fn tape(
        &self,
        machine_name: &str,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<ControlTape, TapeError> {
        self.tape_in(machine_name, None, cancel, progress)
    }

    /// The same for a tape that is to be punched: what the code lacks is among what is found.
    ///
    /// # Errors
    ///
    /// [`TapeError`] when there is no such machine or the run was cancelled.
    pub fn tape_to_punch(
        &self,
        machine_name: &str,
        code: TapeCode,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<ControlTape, TapeError> {
        self.tape_in(machine_name, Some(code), cancel, progress)
    }

    fn tape_in(
        &self,
        machine_name: &str,
        code: Option<TapeCode>,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<ControlTape, TapeError> {
        let machine = self.machine(machine_name)?;
        let source = match self.document().dialect() {
            DialectName::Cl => self.read_cutter_locations(cancel)?,
            _ => self.run_to_cutter_locations(cancel, progress)?,
        };
        Ok(self.tape_of(source, &machine, code, cancel)?)
    }

    /// A machine that comes with the program, or the one of a definition file; where the path of the file is not whole it
    /// begins in the folder of the program.
    fn machine(&self, name: &str) -> Result<MachineDefinition, TapeError> {
        if !name.ends_with(DEFINITION_ENDING) {
            return machine(name);
        }
        let folder = self.document().surroundings().path.as_deref().and_then(Path::parent);
        machine_of_file(folder.unwrap_or(Path::new("")).join(name))
    }

    /// The machine that the first MACHIN of the program names, as it is written there; it may be one that is not known.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn machine_of_program(&self, cancel: Cancel<'_>) -> Result<Option<String>, Cancelled> {
        let program = self.program(cancel)?;
        let named = program.records().find_map(|record| match &record.kind {
            RecordKind::Postprocessor { word, arguments, .. } if word == "MACHIN" => arguments.first(),
            _ => None,
        });
        Ok(named.and_then(|name| match name {
            PostArgument::Text(name) => Some(name.to_string()),
            _ => None,
        }))
    }

    /// What a tape would lack: the statements of a CL file that say nothing to its reader, and what the post-processor finds
    /// for the machine of the settings, if they name one.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub(crate) fn tape_diagnostics(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Vec<Diagnostic>, Cancelled> {
        let settings = self.document().settings();
        let is_read = self.document().dialect() == DialectName::Cl;
        let Some(name) = settings.machine.as_deref() else {
            return if is_read { self.read_diagnostics(cancel) } else { Ok(Vec::new()) };
        };
        // What there is to say about a program itself is told anyway.
        let mut source = match is_read {
            true => self.read_cutter_locations(cancel)?,
            false => Source::of_run(self.result(cancel, progress)?, Vec::new()),
        };
        let no_machine = match self.machine(name) {
            Ok(machine) => return Ok(self.tape_of(source, &machine, None, cancel)?.diagnostics),
            Err(TapeError::Definition { file, why }) => {
                catalogue::unusable_machine(&file.display().to_string(), &why, settings)
            }
            Err(TapeError::UnknownMachine { known, .. }) => {
                catalogue::unknown_machine(name, &known, settings)
            }
            Err(TapeError::Cancelled(cancelled)) => return Err(cancelled),
        };
        source.diagnostics.extend(no_machine);
        Ok(source.diagnostics)
    }

    /// The tape of some records, and what was found besides what is known already; what a code lacks, too, where one is given.
    fn tape_of(
        &self,
        source: Source,
        machine: &MachineDefinition,
        code: Option<TapeCode>,
        cancel: Cancel<'_>,
    ) -> Result<ControlTape, Cancelled> {
        let settings = self.document().settings();
        let mut options = options(settings);
        if self.document().dialect() == DialectName::Cl {
            options.text_limit = CL_TEXT;
            options.deep_breaks_chips = self.deep_breaks_chips();
        }
        let (waiting, tree) = (Waiting::until(cancel), self.document().tree());
        let patience = waiting.patience();
        let mut tape = apt_post::post_until(source.records.list(), machine, &options, patience)
            .map_err(|apt_post::Cancelled| Cancelled)?;
        if let Some(code) = code {
            find_lacking(&mut tape, code);
        }
        let Source { records, diagnostics, .. } = source;
        let diagnostics = catalogue::tape_diagnostics(tree, &tape, records.origins(), settings, patience)
            .map(|told| followed(diagnostics, told, patience));
        match diagnostics {
            Ok(diagnostics) if !patience.was_over() => Ok(ControlTape { tape, diagnostics, records }),
            unfinished => {
                let parts = tape.blocks.len() + tape.findings.len();
                put_away((tape, unfinished), parts);
                Err(Cancelled)
            }
        }
    }

    /// Whether CYCLE/DEEP breaks chips in a CL file of this system.
    pub(crate) fn deep_breaks_chips(&self) -> bool {
        if self.document().dialect() != DialectName::Cl {
            return false;
        }
        let system = self.document().surroundings().binary.or_else(|| detect(&self.text()));
        system.and_then(ClDialect::deep_breaks_chips) == Some(true)
    }

    /// Runs the program to its CL records.
    pub(crate) fn run_to_cutter_locations(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Source, Cancelled> {
        let diagnostics = self.program_diagnostics(Level::Motion, cancel, progress)?;
        Ok(Source::of_run(self.result(cancel, progress)?, diagnostics))
    }

    /// What the reader tells of the text as CL text. It is read once for a version, and what was told is kept; the records are
    /// not, for they would double what an open file takes.
    fn read_diagnostics(&self, cancel: Cancel<'_>) -> Result<Vec<Diagnostic>, Cancelled> {
        if let Some(told) = self.read_findings.get() {
            return Ok(told.clone());
        }
        let text = self.text();
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let (read, errors) = read_with_remarks_until(&text, patience).ok_or(Cancelled)?;
        let records = read.records.len();
        put_away(read, records);
        let told = match errors.is_empty() {
            true => Vec::new(),
            false => self.read_errors(&errors, &self.origins_of_lines(&text, patience)?, patience)?,
        };
        Ok(self.read_findings.get_or_init(|| told).clone())
    }

    fn read_errors(
        &self,
        errors: &[ReadError],
        origins: &[Origin],
        patience: Patience<'_>,
    ) -> Result<Vec<Diagnostic>, Cancelled> {
        catalogue::read_diagnostics(errors, origins, self.document().settings(), patience)
    }

    /// Reads the text as CL text. Statements are numbered as the syntax numbers them, by the line they begin on.
    pub(crate) fn read_cutter_locations(&self, cancel: Cancel<'_>) -> Result<Source, Cancelled> {
        let text = self.text();
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let (read, errors) = read_with_remarks_until(&text, patience).ok_or(Cancelled)?;
        let ClText { mut records, remarks, shortened } = read;
        let origins = self.origins_of_lines(&text, patience)?;
        for (done, record) in records.iter_mut().enumerate() {
            if let Some(origin) = origins.get(record.source as usize) {
                record.isn = origin.isn;
            }
            go_on(patience, usize::from(done % RECORDS_A_UNIT == RECORDS_A_UNIT - 1))?;
        }
        let diagnostics = self.read_errors(&errors, &origins, patience)?;
        let records = Arc::new(Records::Read { records, origins });
        Ok(Source { records, remarks, shortened, diagnostics })
    }

    /// The records of a binary tape of which this is the text form ([`text_of_cl_tape`]): with their own statement numbers, surfaces and
    /// records of many positions, and the places of the text.
    pub(crate) fn read_tape(
        &self,
        bytes: &[u8],
        cancel: Cancel<'_>,
    ) -> Result<Result<Source, TapeReadError>, Cancelled> {
        let contents = match apt_cldata::cltape::read_tape(bytes, &code_table()) {
            Ok(contents) => contents,
            Err(error) => return Ok(Err(error)),
        };
        if cancel() {
            return Err(Cancelled);
        }
        let mut records = contents.records;
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let (_, lines) = write_text_with_lines_until(&records, patience).ok_or(Cancelled)?;
        for (record, line) in records.iter_mut().zip(lines) {
            record.source = line;
        }
        let remark = |note: &TapeNote| Remark { line: u32::MAX, text: note_text(note) };
        let remarks = contents.notes.iter().map(remark).collect();
        let origins = self.origins_of_lines(&self.text(), patience)?;
        let records = Arc::new(Records::Read { records, origins });
        Ok(Ok(Source { records, remarks, shortened: Vec::new(), diagnostics: Vec::new() }))
    }

    /// For every line of the text, the statement that it begins or goes on with.
    fn origins_of_lines(&self, text: &str, patience: Patience<'_>) -> Result<Vec<Origin>, Cancelled> {
        let tree = self.document().tree();
        let mut origins = Pieces::default();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            go_on(patience, 1)?;
            let view = tree.statement(tree.statement_at(TextSize::new(start)));
            let length = view.text().trim_end().len() as u32;
            let range = TextRange::new(TextSize::new(0), TextSize::new(length));
            origins.push(Origin::in_program(view.isn(), range));
            start += line.len() as u32;
        }
        Ok(origins.joined(patience))
    }

    /// The CL file as APT text (`GOTO/…`).
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn cl_text(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<String, Cancelled> {
        let result = self.result(cancel, progress)?;
        let waiting = Waiting::until(cancel);
        apt_cldata::text::write_text_until(&result.records, waiting.patience()).ok_or(Cancelled)
    }

    /// The CL file as the binary CLTAPE of APT III.
    ///
    /// # Errors
    ///
    /// [`ClTapeError`] when the run was cancelled or a record does not fit the tape.
    pub fn cl_tape(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Vec<u8>, ClTapeError> {
        let result = self.result(cancel, progress)?;
        let waiting = Waiting::until(cancel);
        let codes = code_table();
        let tape = apt_cldata::cltape::write_tape_until(&result.records, &codes, waiting.patience())?;
        Ok(tape.ok_or(Cancelled)?)
    }
}

/// Records that are counted as one unit of work where one is looked at in some ten nanoseconds.
const RECORDS_A_UNIT: usize = 16;

/// The unit of a program that does not say it is that of the settings.
fn options(settings: &Settings) -> PostOptions {
    let default_units = match settings.units {
        Units::Inch => apt_cldata::record::Units::Inches,
        Units::Mm => apt_cldata::record::Units::Millimeters,
    };
    PostOptions { default_units, ..PostOptions::default() }
}

/// What a binary CL file says, as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextOfBinary {
    /// A CL file that says the same.
    pub text: String,
    /// Whose binary file it was.
    pub system: ClDialect,
}

/// The text of a binary CL file. `None` for bytes that are none.
///
/// # Errors
///
/// Why bytes that begin like a tape cannot be read.
pub fn text_of_cl_tape(bytes: &[u8]) -> Option<Result<TextOfBinary, apt_cldata::cltape::TapeReadError>> {
    use apt_cldata::{cltape, text};
    let system = system_of_binary(bytes)?;
    let read = || {
        let contents = cltape::read_tape(bytes, &code_table())?;
        // What the tape has and CL text has not is told as remarks, so that nothing is lost in silence.
        let mut out = text::write_text(&contents.records);
        for note in &contents.notes {
            out.push_str(&format!("$${}\n", note_text(note)));
        }
        Ok(TextOfBinary { text: out, system })
    };
    Some(read())
}

/// Whose binary CL file bytes are.
pub(crate) fn system_of_binary(bytes: &[u8]) -> Option<ClDialect> {
    use apt_cldata::cltape;
    if cltape::is_ncl_file(bytes) {
        return Some(ClDialect::Ncl);
    }
    cltape::is_tape(bytes).then_some(ClDialect::Cltape)
}

/// A remark about what of a tape was not read.
fn note_text(note: &apt_cldata::cltape::TapeNote) -> String {
    use apt_cldata::cltape::TapeNote as Note;
    let what = match note {
        Note::Skipped { serial, class, subclass } => format!("RECORD {serial} OF CLASS {class} {subclass}"),
        Note::UnknownCode { serial, code } => format!("CODE {code} IN RECORD {serial}"),
        Note::WrongCount { serial, count } => format!("RECORD {serial} WITH {count} WORDS"),
    };
    format!(" NOT READ: {what}")
}

/// The codes of the vocabulary for binary CL records.
pub(crate) fn code_table() -> CodeTable {
    let mut table = CodeTable::new();
    for word in vocabulary::words() {
        let Some(code) = word.code else { continue };
        match word.class {
            WordClass::Postprocessor
            | WordClass::PostprocessorBare
            | WordClass::Text
            | WordClass::Transformation => {
                table.major(word.spelling, code);
            }
            WordClass::Minor => {
                table.minor(word.spelling, code);
            }
            _ => {}
        }
    }
    table
}

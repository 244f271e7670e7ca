//! Answers about one immutable version of a part program: plain data for editors and the command line.
//!
//! Offsets are bytes from the start of the text. Nothing here knows a protocol, a line number or a JSON shape of its
//! own; the run report comes from `apt-run` as it is.

pub mod action;
pub mod calls;
mod carry;
pub mod completion;
mod context;
pub mod conversion;
pub mod dialect;
pub mod difference;
pub mod expansion;
pub mod files;
pub mod folding;
mod forms;
pub mod hover;
pub mod inlay;
pub mod lens;
pub mod navigation;
pub mod outline;
pub mod picture;
pub mod regions;
pub mod run;
pub mod search;
mod selection;
pub mod signature;
pub mod tape;
pub mod tokens;
mod turn;

use std::{
    ops::Range,
    sync::{Arc, OnceLock},
};

use apt_geometry::patience::{Patience, Waiting};
use apt_program::Program;
use apt_run::catalogue;
use apt_run::pipeline::RunResult;
pub use apt_run::{
    Cancel, Cancelled,
    catalogue::{Worst, explain},
    diagnostic::{Diagnostic, Fix, Severity},
    document::{Document, Files, Level, OpenText, Surroundings, normalised},
    format,
    settings::Settings,
};
use apt_syntax::{TextRange, TextSize, tree::StatementView};

/// One version of a part program with what has been found out about it; cheap to clone.
#[derive(Debug, Clone)]
pub struct Analysis {
    document: Arc<Document>,
    marks: Arc<OnceLock<regions::Marks>>,
    regions: Arc<OnceLock<Vec<regions::Region>>>,
    files: Arc<OnceLock<Vec<files::ProgramFile>>>,
    evaluating: Arc<turn::Turn>,
    running: Arc<turn::Turn>,
    /// What the reader of CL files has told of the text.
    read_findings: Arc<OnceLock<Vec<Diagnostic>>>,
    /// The evaluation of the last version before this one that was evaluated.
    before: Option<Arc<Program>>,
}

impl Analysis {
    /// Parses a text; everything else is computed when asked for.
    pub fn new(text: &str, file: Option<String>, settings: &Arc<Settings>) -> Self {
        Self::of(Document::new(text, file, settings))
    }

    /// The same for a program that stands elsewhere than its name says, perhaps among files that are open in an editor.
    pub fn placed(
        text: &str,
        file: Option<String>,
        settings: &Arc<Settings>,
        surroundings: Surroundings,
    ) -> Self {
        Self::of(Document::placed(text, file, settings, surroundings))
    }

    /// The same version with all forgotten that depends on included files, for when one of them has changed.
    pub fn with_changed_files(&self) -> Self {
        let mut next = Self::of(self.document.with_changed_files());
        next.marks = Arc::clone(&self.marks);
        next.regions = Arc::clone(&self.regions);
        next.before = self.known_program().cloned();
        next
    }

    fn of(document: Document) -> Self {
        Self {
            document: Arc::new(document),
            marks: Arc::default(),
            regions: Arc::default(),
            files: Arc::default(),
            evaluating: Arc::default(),
            running: Arc::default(),
            read_findings: Arc::default(),
            before: None,
        }
    }

    /// The next version: `range` (bytes) replaced by `insert`. Only the touched statements are parsed again.
    pub fn edit(&self, range: Range<usize>, insert: &str) -> Self {
        let length = usize::from(self.document.tree().len());
        let range = range.start.min(length)..range.end.clamp(range.start.min(length), length);
        let mut next = Self::of(self.document.edit(range.clone(), insert));
        next.before = self.known_program().cloned();
        let new = Arc::clone(&next.document);
        let new = new.tree();
        // In another dialect other statements begin and end blocks.
        if let Some(marks) = self.marks.get()
            && new.dialect() == self.document.tree().dialect()
            && let Some(carried) = carry::Carried::between(self.document.tree(), new, &range, insert.len())
        {
            // The cell is fresh: nobody can have filled it.
            let _ = next.marks.set(marks.carried(&carried, new));
        }
        next
    }

    /// The program under analysis.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The whole text.
    pub fn text(&self) -> String {
        self.document.tree().text()
    }

    /// Macro bodies and loops.
    pub fn regions(&self) -> &[regions::Region] {
        let tree = self.document.tree();
        self.regions.get_or_init(|| self.marks().regions(tree))
    }

    /// The statements that open and close regions or put in files.
    fn marks(&self) -> &regions::Marks {
        self.marks.get_or_init(|| regions::Marks::of(self.document.tree()))
    }

    /// The same for somebody who waits.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when who waits has given up before the end.
    pub(crate) fn with_marks(&self, patience: Patience<'_>) -> Result<&regions::Marks, Cancelled> {
        if let Some(marks) = self.marks.get() {
            return Ok(marks);
        }
        let marks = regions::Marks::find(self.document.tree(), patience)?;
        Ok(self.marks.get_or_init(|| marks))
    }

    /// What is known of the program without any work: its evaluation, or that of the last version that has one.
    pub fn known_program(&self) -> Option<&Arc<Program>> {
        self.document.evaluated().or(self.before.as_ref())
    }

    /// Section 1. Whoever asks while it is computed waits for the result.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn program(&self, cancel: Cancel<'_>) -> Result<Arc<Program>, Cancelled> {
        if let Some(program) = self.document.evaluated() {
            return Ok(Arc::clone(program));
        }
        let _turn = self.evaluating.wait(cancel)?;
        self.document.program(cancel)
    }

    /// Sections 1 to 3. `progress` gets the number of records done and to do. Whoever asks while it is computed waits
    /// for the result.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn result(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Arc<RunResult>, Cancelled> {
        self.program(cancel)?;
        let _turn = self.running.wait(cancel)?;
        self.document.run(cancel, progress)
    }

    /// The statements in the order of their numbers, which begin with one; bytes of the text.
    pub fn statements(&self) -> Vec<std::ops::Range<usize>> {
        let tree = self.document().tree();
        let place = |view: StatementView| {
            let start = absolute(&view, TextRange::default()).start;
            start..start + view.text().len()
        };
        tree.statements().map(place).collect()
    }

    /// The diagnostics up to a level, in order of their place. Where the settings name a machine, the motion level holds
    /// also what its post-processor finds, as far as the program itself is without errors.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn diagnostics(
        &self,
        level: Level,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Vec<Diagnostic>, Cancelled> {
        let mut found = self.program_diagnostics(level, cancel, progress)?;
        let sound = found.iter().all(|one| one.severity != Severity::Error);
        if level == Level::Motion && sound {
            found.extend(self.tape_diagnostics(cancel, progress)?);
            found = catalogue::by_place(found, Waiting::until(cancel).patience())?;
        }
        Ok(found)
    }

    /// The gravest of [`Analysis::diagnostics`], at most `most`, and how many others there are.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn worst_diagnostics(
        &self,
        level: Level,
        most: usize,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Worst, Cancelled> {
        match level {
            Level::Section1 => drop(self.program(cancel)?),
            Level::Motion => drop(self.result(cancel, progress)?),
        }
        let mut worst = self.document.worst_diagnostics(level, most, cancel, progress)?;
        // Errors are the gravest: if there are any, some are among these.
        let sound = worst.diagnostics.iter().all(|one| one.severity != Severity::Error);
        if level == Level::Motion && sound {
            worst.diagnostics.extend(self.tape_diagnostics(cancel, progress)?);
            let left_out = worst.left_out;
            let found = catalogue::by_place(worst.diagnostics, Waiting::until(cancel).patience())?;
            worst = Worst::of(found, most);
            worst.left_out += left_out;
        }
        Ok(worst)
    }

    /// The diagnostics of the program alone, whatever machine it is meant for.
    pub(crate) fn program_diagnostics(
        &self,
        level: Level,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Vec<Diagnostic>, Cancelled> {
        match level {
            Level::Section1 => drop(self.program(cancel)?),
            Level::Motion => drop(self.result(cancel, progress)?),
        }
        self.document.diagnostics(level, cancel, progress)
    }

    /// The syntax tree as text.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn syntax_tree(&self, cancel: Cancel<'_>) -> Result<String, Cancelled> {
        self.document.tree().debug_tree_until(cancel).ok_or(Cancelled)
    }

    /// The statement at an offset and the offset relative to its start; `None` in an empty text.
    pub(crate) fn statement_at(&self, offset: usize) -> Option<(StatementView, TextSize)> {
        navigation::statement_at(self.document.tree(), offset)
    }
}

/// The absolute bytes of a range relative to a statement.
pub(crate) fn absolute(view: &StatementView, range: TextRange) -> Range<usize> {
    let start = usize::from(view.range().start());
    start + usize::from(range.start())..start + usize::from(range.end())
}

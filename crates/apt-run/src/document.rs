//! One part program with its settings: syntax at once, evaluation and run when asked for, each computed at most once.
//!
//! A document is an immutable version. [`Document::edit`] makes the next one, which restarts evaluation at the first
//! statement that changed and shares the memo of motions.

use std::{
    ops::Range,
    path::PathBuf,
    sync::{Arc, OnceLock},
};

use apt_cldata::text::ClDialect;
use apt_geometry::patience::{Aside, Waiting, put_away};
use apt_program::{Options, Program, evaluate};
use apt_syntax::{
    SyntaxTree, TextRange, TextSize,
    dialect::{BodyEvidence, Detection, DetectionReason, Dialect, DialectName, LINES_LOOKED_AT, detect_with},
};

use crate::{
    Cancel, Cancelled,
    basis::Basis,
    catalogue::{self, Judged, Worst},
    diagnostic::Diagnostic,
    include::FolderResolver,
    memo::MotionMemo,
    pipeline::{RunResult, run},
    report::{Report, ReportInput, report},
    settings::Settings,
};

pub use crate::include::{Files, OpenText, Surroundings, normalised};

/// How far diagnostics go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Section 1: syntax and evaluation.
    Section1,
    /// Sections 1 to 3: the motions are computed and verified.
    Motion,
}

/// Why a dialect is in force.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DialectReason {
    /// The settings name it.
    Setting,
    /// It is that of the text of binary files, such as those of this system.
    Binary(ClDialect),
    /// It was detected.
    Detected(DetectionReason),
}

/// One version of one part program.
#[derive(Debug)]
pub struct Document {
    tree: SyntaxTree,
    file: Option<String>,
    surroundings: Surroundings,
    settings: Arc<Settings>,
    dialect_reason: DialectReason,
    /// What speaks for the dialect in all of the text; none where it is not detected.
    body: Option<BodyEvidence>,
    memo: MotionMemo,
    /// The last version that was evaluated, with the edits since.
    basis: Option<Basis>,
    program: OnceLock<Arc<Program>>,
    result: OnceLock<Arc<RunResult>>,
}

/// How much one version of a program holds. What nobody has asked for yet, or what was cancelled, counts nothing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Holdings {
    /// Bytes of the text.
    pub bytes: usize,
    /// Statements.
    pub statements: usize,
    /// Records of Section 1.
    pub records: usize,
    /// Positions of the path, copies included.
    pub positions: usize,
    /// Motions in the memo that all versions of the program share.
    pub motions: usize,
}

impl Document {
    /// Parses a text. The dialect is that of the settings, else it is detected. The name of the file is its path.
    pub fn new(text: &str, file: Option<String>, settings: &Arc<Settings>) -> Self {
        let surroundings =
            Surroundings { path: file.as_deref().map(PathBuf::from), ..Surroundings::default() };
        Self::placed(text, file, settings, surroundings)
    }

    /// The same for a program that stands elsewhere than its name says, perhaps among files that are open in an editor.
    pub fn placed(
        text: &str,
        file: Option<String>,
        settings: &Arc<Settings>,
        surroundings: Surroundings,
    ) -> Self {
        let set = settings.dialect.as_deref().and_then(|name| name.parse::<DialectName>().ok());
        let mut body = None;
        let (name, dialect_reason) = match (set, surroundings.binary) {
            (Some(name), _) => (name, DialectReason::Setting),
            (None, Some(system)) => (DialectName::Cl, DialectReason::Binary(system)),
            (None, None) => {
                let evidence = *body.insert(BodyEvidence::of(text));
                let detection = detect_with(text, evidence, file.as_deref());
                (detection.name, DialectReason::Detected(detection.reason))
            }
        };
        Self {
            tree: SyntaxTree::parse(text, Dialect::named(name)),
            file,
            surroundings,
            settings: Arc::clone(settings),
            dialect_reason,
            body,
            memo: MotionMemo::default(),
            basis: None,
            program: OnceLock::new(),
            result: OnceLock::new(),
        }
    }

    /// The next version: `range` (bytes) replaced by `insert`.
    pub fn edit(&self, range: Range<usize>, insert: &str) -> Self {
        let range = TextRange::new(TextSize::new(range.start as u32), TextSize::new(range.end as u32));
        let (tree, change) = self.tree.edit(range, insert);
        let (body, dialect_reason) = match self.body {
            Some(body) => {
                let (body, detection) = self.detected_after(body, &tree, range);
                if detection.name != self.dialect() {
                    return self.read_in_another_dialect(&tree);
                }
                (Some(body), DialectReason::Detected(detection.reason))
            }
            None => (None, self.dialect_reason.clone()),
        };
        let basis = match self.program.get() {
            Some(program) => Some(Basis::of(&self.tree, program)),
            None => self.basis.clone(),
        };
        let basis = basis.map(|basis| basis.after(&tree, change));
        Self {
            tree,
            file: self.file.clone(),
            surroundings: self.surroundings.clone(),
            settings: Arc::clone(&self.settings),
            dialect_reason,
            body,
            memo: self.memo.clone(),
            basis,
            program: OnceLock::new(),
            result: OnceLock::new(),
        }
    }

    /// Which dialect the text is in after an edit has put something else in the place of a range.
    fn detected_after(
        &self,
        body: BodyEvidence,
        tree: &SyntaxTree,
        range: TextRange,
    ) -> (BodyEvidence, Detection) {
        let (start, end) = (line_start(&self.tree, range.start()), line_end(&self.tree, range.end()));
        let behind = self.tree.len() - end;
        let come = tree.slice(TextRange::new(start, (tree.len() - behind).max(start)));
        let body = body.after(&self.tree.slice(TextRange::new(start, end)), &come, || tree.text());
        (body, detect_with(&head_of(tree), body, self.file.as_deref()))
    }

    /// The same program with a text that speaks for another dialect than the one of before: nothing of what was known of the
    /// statements counts any more.
    fn read_in_another_dialect(&self, tree: &SyntaxTree) -> Self {
        let surroundings = self.surroundings.clone();
        let new = Self::placed(&tree.text(), self.file.clone(), &self.settings, surroundings);
        Self { memo: self.memo.clone(), ..new }
    }

    /// The syntax.
    pub fn tree(&self) -> &SyntaxTree {
        &self.tree
    }

    /// The file name, if there is one.
    pub fn file(&self) -> Option<&str> {
        self.file.as_deref()
    }

    /// The settings in force.
    pub fn settings(&self) -> &Arc<Settings> {
        &self.settings
    }

    /// The dialect in force.
    pub fn dialect(&self) -> DialectName {
        self.tree.dialect().name
    }

    /// Why this dialect is in force.
    pub fn dialect_reason(&self) -> &DialectReason {
        &self.dialect_reason
    }

    /// The memo of motions, shared by all versions.
    pub fn memo(&self) -> &MotionMemo {
        &self.memo
    }

    /// The evaluation, if it has been computed.
    pub fn evaluated(&self) -> Option<&Arc<Program>> {
        self.program.get()
    }

    /// How much is held of this version; nothing is computed for it.
    pub fn holdings(&self) -> Holdings {
        Holdings {
            bytes: self.tree.len().into(),
            statements: self.tree.statement_count(),
            records: self.program.get().map_or(0, |program| program.record_count()),
            positions: self.result.get().map_or(0, |result| result.totals().points),
            motions: self.memo.len(),
        }
    }

    /// Section 1.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn program(&self, cancel: Cancel<'_>) -> Result<Arc<Program>, Cancelled> {
        if let Some(program) = self.program.get() {
            return Ok(Arc::clone(program));
        }
        let options = self.options();
        let program = match &self.basis {
            Some(basis) => basis.evaluate(&self.tree, &options, &cancel),
            None => evaluate(&self.tree, &options, &cancel),
        };
        if !program.is_complete() {
            let statements = program.statistics().evaluated_statements;
            put_away(program, usize::try_from(statements).unwrap_or(usize::MAX));
            return Err(Cancelled);
        }
        Ok(Arc::clone(self.program.get_or_init(|| Arc::new(program))))
    }

    /// The settings as Section 1 takes them, with the folders that INCLUD searches.
    pub fn options(&self) -> Options {
        let dialect = self.tree.dialect();
        let resolver = FolderResolver::new(&self.surroundings, &self.settings.include, dialect);
        Options { include: Some(resolver), ..Options::from(&*self.settings) }
    }

    /// The same version with its evaluation forgotten: a file that it includes has changed.
    pub fn with_changed_files(&self) -> Self {
        Self {
            tree: self.tree.clone(),
            file: self.file.clone(),
            surroundings: self.surroundings.clone(),
            settings: Arc::clone(&self.settings),
            dialect_reason: self.dialect_reason.clone(),
            body: self.body,
            memo: self.memo.clone(),
            basis: None,
            program: OnceLock::new(),
            result: OnceLock::new(),
        }
    }

    /// Where the program stands.
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// Sections 1 to 3. `progress` gets the number of records done and to do.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn run(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Arc<RunResult>, Cancelled> {
        if let Some(result) = self.result.get() {
            return Ok(Arc::clone(result));
        }
        let program = self.program(cancel)?;
        let result = run(&self.tree, &program, &self.settings, &self.memo, cancel, progress)?;
        Ok(Arc::clone(self.result.get_or_init(|| Arc::new(result))))
    }

    /// The diagnostics up to a level, in order of their place.
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
        let program = self.program(cancel)?;
        let result = match level {
            Level::Section1 => None,
            Level::Motion => Some(self.run(cancel, progress)?),
        };
        let waiting = Waiting::until(cancel);
        catalogue::diagnostics(&self.judged(&program, result.as_deref()), waiting.patience())
    }

    /// The gravest diagnostics up to a level, at most `most`, in order of their place, and how many others there are.
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
        let program = self.program(cancel)?;
        let result = match level {
            Level::Section1 => None,
            Level::Motion => Some(self.run(cancel, progress)?),
        };
        let waiting = Waiting::until(cancel);
        catalogue::worst(&self.judged(&program, result.as_deref()), most, waiting.patience())
    }

    /// The report of a run, of the whole program or of some statements.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn report(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
        statements: Option<std::ops::RangeInclusive<u32>>,
    ) -> Result<Report, Cancelled> {
        let program = self.program(cancel)?;
        let result = self.run(cancel, progress)?;
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let judged = self.judged(&program, Some(&result));
        let diagnostics = Aside::from(catalogue::diagnostics(&judged, patience)?);
        let input = ReportInput {
            file: self.file.as_deref().unwrap_or("-"),
            text: &self.tree.text(),
            tree: &self.tree,
            program: &program,
            result: &result,
            diagnostics: &diagnostics,
            statements,
        };
        report(&input, patience)
    }

    fn judged<'a>(&'a self, program: &'a Program, result: Option<&'a RunResult>) -> Judged<'a> {
        Judged { tree: &self.tree, program, result, settings: &self.settings }
    }
}

impl From<&Settings> for Options {
    fn from(settings: &Settings) -> Self {
        Options {
            statement_budget: settings.budget.statements,
            macro_depth: settings.budget.macro_depth,
            ..Options::default()
        }
    }
}

/// Bytes among which the end of a line is looked for at first.
const USUAL_LINE: u32 = 256;

/// Where the line begins in which an offset lies.
fn line_start(tree: &SyntaxTree, offset: TextSize) -> TextSize {
    let offset = offset.min(tree.len());
    let mut width = USUAL_LINE;
    loop {
        let from = u32::from(offset).saturating_sub(width);
        let text = tree.slice(TextRange::new(from.into(), offset));
        match text.rfind('\n') {
            Some(end) => return offset - TextSize::of(&text[end + 1..]),
            None if from == 0 => return TextSize::new(0),
            None => width = width.saturating_mul(2),
        }
    }
}

/// Where the line ends in which an offset lies, behind the sign that ends it.
fn line_end(tree: &SyntaxTree, offset: TextSize) -> TextSize {
    let offset = offset.min(tree.len());
    let mut width = USUAL_LINE;
    loop {
        let to = TextSize::new(u32::from(offset).saturating_add(width)).min(tree.len());
        let text = tree.slice(TextRange::new(offset, to));
        match text.find('\n') {
            Some(end) => return offset + TextSize::of(&text[..=end]),
            None if to == tree.len() => return to,
            None => width = width.saturating_mul(2),
        }
    }
}

/// As many first statements as there are lines in what is looked at for the dialect.
pub(crate) fn head_of(tree: &SyntaxTree) -> String {
    let (mut text, mut lines) = (String::new(), 0);
    for view in tree.statements() {
        text.push_str(view.text());
        lines += view.text().lines().filter(|line| !line.trim().is_empty()).count();
        if lines >= LINES_LOOKED_AT {
            break;
        }
    }
    text
}

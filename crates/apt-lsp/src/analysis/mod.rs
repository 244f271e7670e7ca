//! The narrow door between the protocol side and the analysis of programs.
//!
//! Everything in this crate that needs to know something about APT asks a [`Document`]; everything a
//! document answers is plain data with byte offsets. Handlers convert in, call one method, convert out.

mod answer;
mod engine;
#[cfg(test)]
pub(crate) mod fake;

use std::cell::Cell;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tokio_util::sync::CancellationToken;

pub(crate) use self::answer::*;
pub(crate) use self::engine::Engine;
use crate::settings::Values;

/// What makes documents: the language as a whole.
pub(crate) trait Language: Send + Sync + 'static {
    /// Reads a program. Parsing happens here, evaluation when somebody asks. Settings that are wrong
    /// count as absent; [`Language::check_settings`] says what is wrong with them.
    fn open(
        &self,
        text: &str,
        file_name: Option<&str>,
        settings: &Values,
        surroundings: Surroundings,
    ) -> Arc<dyn Document>;

    /// Says what is wrong with settings, if something is.
    fn check_settings(&self, settings: &Values) -> Result<(), String>;

    /// The machines a tape can be made for.
    fn machines(&self) -> Vec<MachineInfo>;

    /// The definition file of one of them.
    fn machine_definition(&self, name: &str) -> Result<String, Refusal>;

    /// Whether there is a machine of this name, be it its own or one that programs give it.
    fn has_machine(&self, name: &str) -> bool;

    /// The program that bytes in a binary form say as text, or why they cannot be read; nothing for bytes of no form
    /// that is known.
    fn text_of_binary(&self, bytes: &[u8]) -> Option<Result<TextOfBinary, String>>;

    /// Where two paths differ.
    fn difference(
        &self,
        paths: [&ToolPath; 2],
        allowance: Allowance,
        control: &Control,
    ) -> Result<PathDifference, Refusal>;

    /// The page of a diagnostic code, as Markdown.
    fn explain(&self, code: &str) -> Option<String>;

    /// One line that says what a diagnostic code stands for.
    fn title(&self, code: &str) -> Option<String>;
}

/// One immutable version of one program. Offsets and ranges are bytes of its text.
pub(crate) trait Document: Send + Sync {
    /// The version after some edits, each relative to the text that the one before it left.
    fn edit(&self, edits: &[TextEdit]) -> Arc<dyn Document>;

    /// The same version with all forgotten that depends on included files, for when one of them has changed.
    fn with_changed_files(&self) -> Arc<dyn Document>;

    /// Whether a statement puts in another file, be it there or not.
    fn has_inclusions(&self) -> bool;

    /// The files that are put in, directly or by others.
    fn included_paths(&self) -> Vec<PathBuf>;

    /// The names of files in the text, with the files that they name.
    fn inclusions(&self) -> Vec<Inclusion>;

    /// What is found in an included file, as findings of that file.
    fn diagnostics_in(&self, file: &Path, level: Level, control: &Control) -> Answer<Vec<Diagnostic>>;

    /// The dialect in force, and why, in words for people.
    fn dialect(&self) -> String;

    /// How much is held of this version; nothing is computed for it.
    fn holdings(&self) -> Holdings;

    /// Everything found up to a level, ordered by place.
    fn diagnostics(&self, level: Level, control: &Control) -> Answer<Vec<Diagnostic>>;

    /// The gravest of what is found up to a level, ordered by place, at most `most` of them.
    fn worst_diagnostics(&self, level: Level, most: usize, control: &Control) -> Answer<Worst> {
        let mut diagnostics = self.diagnostics(level, control)?;
        let left_out = diagnostics.len().saturating_sub(most);
        diagnostics.truncate(most);
        Ok(Worst { diagnostics, left_out })
    }

    /// What stands at a place, explained.
    fn hover(&self, spot: Spot<'_>, control: &Control) -> Answer<Option<Hover>>;

    /// The values that the statements in a range of a file of the program compute; none is the program itself.
    fn inlays(&self, file: Option<&Path>, range: Range<usize>, control: &Control) -> Answer<Vec<Inlay>>;

    /// What can be selected around an offset, from the least to the whole.
    fn selections(&self, offset: usize) -> Vec<Range<usize>>;

    /// What could be written at an offset.
    fn completions(&self, offset: usize, control: &Control) -> Answer<Vec<Completion>>;

    /// The forms of what an offset is in the parameters of.
    fn signature_help(&self, offset: usize) -> Option<SignatureHelp>;

    /// Where the name at a place gets its meaning, in all files; the place in force there first.
    fn definitions(&self, spot: Spot<'_>, control: &Control) -> Answer<Vec<Located>>;

    /// Where the name at a place stands, in all files.
    fn references(&self, spot: Spot<'_>, control: &Control) -> Answer<Vec<Located>>;

    /// Where the name at an offset stands.
    fn occurrences(&self, offset: usize, control: &Control) -> Answer<Vec<Occurrence>>;

    /// The name at a place, if it is one that can be renamed.
    fn renamable(&self, spot: Spot<'_>) -> Option<Range<usize>>;

    /// The edits in all files that give the name at a place another spelling, all relative to this version.
    fn rename(&self, spot: Spot<'_>, new: &str, control: &Control)
    -> Result<Vec<(Located, String)>, Refusal>;

    /// The macro that is named at a place, or the program at its PARTNO.
    fn routine(&self, spot: Spot<'_>, control: &Control) -> Answer<Option<Routine>>;

    /// Who calls a macro.
    fn callers(&self, name: &str, control: &Control) -> Answer<Vec<Calls>>;

    /// Whom a macro calls, or for none the statements outside of all macros of a file (none is the program itself).
    fn callees(&self, name: Option<&str>, file: Option<&Path>, control: &Control) -> Answer<Vec<Calls>>;

    /// The outline.
    fn outline(&self, control: &Control) -> Answer<Vec<OutlineEntry>>;

    /// What can be folded away.
    fn folds(&self, control: &Control) -> Answer<Vec<Fold>>;

    /// The classes of words, in order; only those of statements that touch the range if one is given.
    fn tokens(&self, range: Option<Range<usize>>, control: &Control) -> Answer<Vec<Token>>;

    /// The places that can be run on their own.
    fn lenses(&self, control: &Control) -> Answer<Vec<Lens>>;

    /// What can be done about a range, of the kinds wanted; findings count up to a level.
    fn actions(
        &self,
        range: Range<usize>,
        wanted: &[ActionKind],
        level: Level,
        control: &Control,
    ) -> Answer<Vec<Action>>;

    /// The edits that give the program the style of its project; only those of statements that touch the range if one is
    /// given.
    fn format(&self, range: Option<Range<usize>>, control: &Control) -> Answer<Formatting>;

    /// The statements in the order of their numbers, which begin with one; bytes of the text.
    fn statements(&self) -> Vec<Range<usize>>;

    /// The syntax tree as indented text.
    fn syntax_tree(&self, control: &Control) -> Answer<String>;

    /// The program with macros and loops unrolled: all of it, or the one at an offset, `depth` levels deep.
    fn expand(&self, at: Option<usize>, depth: Option<u32>, control: &Control) -> Answer<Expansion>;

    /// The canonical form of the geometry named or defined at an offset.
    fn canonical_form(&self, offset: usize, control: &Control) -> Answer<Option<CanonicalForm>>;

    /// Runs the program, or the statements that touch a range, and gives the report as JSON.
    fn run(&self, request: &RunRequest, control: &Control) -> Result<serde_json::Value, Refusal>;

    /// The machine that the program itself names by MACHIN; it may be one that is not known.
    fn machine_of_program(&self, control: &Control) -> Answer<Option<String>>;

    /// The tape for a machine, as JSON.
    fn tape(&self, machine: &str, control: &Control) -> Result<serde_json::Value, Refusal>;

    /// Everything found on the way to the tape of a machine: in the program, by the post-processor, and when it is to be
    /// punched in a code.
    fn tape_diagnostics(
        &self,
        machine: &str,
        punch: Option<TapeCode>,
        control: &Control,
    ) -> Result<Vec<Diagnostic>, Refusal>;

    /// The way of the tool, with everything found up to it.
    fn tool_path(&self, control: &Control) -> Answer<(ToolPath, Vec<Diagnostic>)>;

    /// The cutter locations in a CL dialect: of the binary tape of which this is the text, or of the document itself.
    fn convert(&self, to: ClDialect, tape: Option<&[u8]>, control: &Control) -> Result<Conversion, Refusal>;

    /// What the run produces, in a form that is written to a file.
    fn product(&self, product: &Product, control: &Control) -> Result<Vec<u8>, Refusal>;
}

/// How a long computation is stopped and how it tells how far it is.
#[derive(Clone)]
pub(crate) struct Control {
    token: CancellationToken,
    progress: Option<Arc<dyn Fn(Progress) + Send + Sync>>,
}

impl Control {
    /// Stopped by the token; silent.
    pub(crate) fn new(token: CancellationToken) -> Self {
        Self { token, progress: None }
    }

    /// Never stopped, silent.
    pub(crate) fn unlimited() -> Self {
        Self::new(CancellationToken::new())
    }

    /// The same, telling its progress to `report`.
    pub(crate) fn with_progress(mut self, report: impl Fn(Progress) + Send + Sync + 'static) -> Self {
        self.progress = Some(Arc::new(report));
        self
    }

    /// True when nobody wants the answer any more. Cheap enough to be asked per statement and per pass.
    pub(crate) fn is_cancelled(&self) -> bool {
        self.token.is_cancelled()
    }

    /// Counts the work of an answer that grows with the document.
    pub(crate) fn pace(&self) -> Pace<'_> {
        Pace { control: self, left: Cell::new(WORK_BETWEEN_QUESTIONS) }
    }

    /// Tells how far the work has come.
    pub(crate) fn report(&self, progress: Progress) {
        if let Some(report) = &self.progress {
            report(progress);
        }
    }
}

/// Things of an answer that are written between two questions, each in about a microsecond.
const WORK_BETWEEN_QUESTIONS: usize = 512;

/// Counts the things of an answer, and asks once in so many of them whether it is still wanted.
pub(crate) struct Pace<'a> {
    control: &'a Control,
    left: Cell<usize>,
}

impl Pace<'_> {
    /// Counts some things.
    ///
    /// # Errors
    ///
    /// [`Interrupted`] when nobody wants the answer any more.
    pub(crate) fn go_on(&self, things: usize) -> Result<(), Interrupted> {
        let left = self.left.get().saturating_sub(things);
        self.left.set(if left == 0 { WORK_BETWEEN_QUESTIONS } else { left });
        if left == 0 && self.control.is_cancelled() { Err(Interrupted) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_wants_no_answer_any_more_is_heard_soon_and_a_short_answer_is_given() {
        let token = CancellationToken::new();
        let control = Control::new(token.clone());
        let pace = control.pace();
        assert_eq!(pace.go_on(10 * WORK_BETWEEN_QUESTIONS), Ok(()));
        token.cancel();
        let given = (0..).take_while(|_| pace.go_on(1).is_ok()).count();
        assert_eq!(given + 1, WORK_BETWEEN_QUESTIONS);
        assert_eq!(control.pace().go_on(WORK_BETWEEN_QUESTIONS - 1), Ok(()));
    }
}

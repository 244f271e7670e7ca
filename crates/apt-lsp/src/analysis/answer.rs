//! What documents answer: plain data, public fields, no protocol types.

use std::ops::Range;

use thiserror::Error;

/// The answer to a question that can be interrupted.
pub(crate) type Answer<T> = Result<T, Interrupted>;

/// The work was stopped before it had an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the work was cancelled")]
pub(crate) struct Interrupted;

/// Why there is no run, tape or product.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(crate) enum Refusal {
    /// The work was stopped.
    #[error("the work was cancelled")]
    Interrupted,
    /// No machine of this name.
    #[error("there is no machine named `{name}`; known machines: {}", known.join(", "))]
    UnknownMachine {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// No machine was named, neither in the request nor in the settings.
    #[error("no machine is named; give one or set `machine` in apt-lsp.toml")]
    NoMachine,
    /// The program gives nothing to write.
    #[error("{0}")]
    Impossible(String),
}

impl From<Interrupted> for Refusal {
    fn from(Interrupted: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// How far the work has come.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Progress {
    /// Steps done.
    pub done: u64,
    /// Steps in all, if known.
    pub total: Option<u64>,
    /// What is being done.
    pub message: String,
}

/// One change of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TextEdit {
    /// What is replaced.
    pub range: Range<usize>,
    /// What stands there afterwards.
    pub text: String,
}

/// How deep the checks go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    /// Sections 0 and 1: syntax, names, geometry.
    Section1,
    /// Motion and its verification too.
    Motion,
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Severity {
    /// The program does not do what it says.
    Error,
    /// The program probably does not do what is meant.
    Warning,
    /// Worth knowing.
    Information,
    /// Could be better.
    Hint,
}

impl Severity {
    /// The name used in JSON.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Information => "information",
            Self::Hint => "hint",
        }
    }
}

/// One finding.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Diagnostic {
    /// The stable code, `APTnnnn`.
    pub code: String,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong, in words.
    pub message: String,
    /// What would help.
    pub hint: Option<String>,
    /// Internal statement number.
    pub isn: Option<u32>,
    /// The number of the APT III diagnostic.
    pub apt3: Option<u16>,
    /// Where.
    pub range: Range<usize>,
    /// The macro calls, loop turns and includes around it, innermost first.
    pub origin: Vec<OriginFrame>,
    /// Other places that have to do with it.
    pub related: Vec<Related>,
    /// The text has no effect, and can be shown faded.
    pub unnecessary: bool,
}

/// One level of macro call, loop turn or include.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub(crate) struct OriginFrame {
    /// `macro`, `loop` or `include`.
    pub kind: &'static str,
    /// Name of the macro or file; empty for a loop.
    pub name: String,
    /// Statement that calls or begins it.
    pub isn: u32,
    /// Which turn.
    pub turn: u32,
    /// Where the call or the beginning of the loop stands.
    #[serde(skip)]
    pub range: Option<Range<usize>>,
}

/// Another place that has to do with a finding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Related {
    /// Why it is shown.
    pub message: String,
    /// Where.
    pub range: Range<usize>,
}

/// An explanation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Hover {
    /// What is explained.
    pub range: Range<usize>,
    /// The explanation.
    pub markdown: String,
}

/// What a completion stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CompletionKind {
    /// A surface, point, vector or matrix of the program.
    Name,
    /// A number of the program.
    Scalar,
    /// A macro of the program.
    Macro,
    /// A modifier.
    Modifier,
    /// A type of geometry.
    Type,
    /// A function of arithmetic.
    Function,
    /// A word that begins a statement.
    Statement,
    /// A word for the post-processor.
    Postprocessor,
}

/// Something that could be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Completion {
    /// What is shown and written.
    pub label: String,
    /// What it is.
    pub kind: CompletionKind,
    /// One line about it; may be empty.
    pub detail: String,
    /// More, as Markdown; may be empty.
    pub documentation: String,
}

/// A place where a name stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Occurrence {
    /// Where.
    pub range: Range<usize>,
    /// True where the name gets a value.
    pub defines: bool,
}

/// What an entry of the outline stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum OutlineKind {
    /// The part, named by PARTNO.
    Part,
    /// A macro.
    Macro,
    /// A loop.
    Loop,
    /// A surface, point, vector or matrix.
    Geometry,
    /// A number.
    Scalar,
    /// A table of subscripted names.
    Array,
    /// A tool that is loaded.
    Tool,
}

/// An entry of the outline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct OutlineEntry {
    /// The name.
    pub name: String,
    /// One line about it; may be empty.
    pub detail: String,
    /// What it is.
    pub kind: OutlineKind,
    /// All of it.
    pub range: Range<usize>,
    /// Its name.
    pub focus: Range<usize>,
    /// What is inside.
    pub children: Vec<OutlineEntry>,
}

/// What a fold holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FoldKind {
    /// A macro or a loop.
    Region,
    /// Remarks.
    Comment,
    /// A statement over several lines.
    Statement,
}

/// Something that can be folded away.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fold {
    /// What it holds.
    pub kind: FoldKind,
    /// All of it.
    pub range: Range<usize>,
}

/// Class of a word, for colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TokenClass {
    /// A word that begins a statement.
    Keyword,
    /// A modifier.
    Modifier,
    /// A type of geometry.
    Type,
    /// A function of arithmetic.
    Function,
    /// A word for the post-processor.
    Postprocessor,
    /// The name of a macro.
    Macro,
    /// A parameter of a macro.
    Parameter,
    /// The name of a surface or a number.
    Variable,
    /// A label.
    Label,
    /// A number.
    Number,
    /// Raw text after PARTNO and the like, and quoted text.
    String,
    /// An operator or sign.
    Operator,
    /// A remark.
    Comment,
}

/// A word with its class.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Token {
    /// Where; may span lines.
    pub range: Range<usize>,
    /// Its class.
    pub class: TokenClass,
    /// True where the name gets its meaning.
    pub definition: bool,
}

/// A place that can be run on its own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lens {
    /// Where it is shown.
    pub range: Range<usize>,
    /// What it says.
    pub title: String,
    /// What is run; the whole program without one.
    pub run: Option<Range<usize>>,
}

/// A program with macros and loops unrolled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Expansion {
    /// The statements, one per line.
    pub text: String,
    /// Where each line comes from.
    pub origins: Vec<ExpandedLine>,
}

/// Where a line of an expansion comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ExpandedLine {
    /// Zero-based line of the expansion.
    pub line: u32,
    /// Statement number in the program.
    pub isn: u32,
    /// The statement in the program.
    pub range: Range<usize>,
    /// Macro calls and loop turns around it, innermost first.
    pub stack: Vec<OriginFrame>,
}

/// A canonical form.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CanonicalForm {
    /// Name of the surface; empty for a nested definition.
    pub name: String,
    /// Its type word.
    pub kind: String,
    /// The numbers.
    pub canonical: Vec<f64>,
    /// The numbers with their meaning.
    pub text: String,
}

/// What is to be run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct RunRequest {
    /// Only the statements that touch this range.
    pub range: Option<Range<usize>>,
    /// Machine of the tape.
    pub machine: Option<String>,
    /// With a scene for viewers.
    pub scene: bool,
}

/// What can be written to a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Product {
    /// CL text.
    ClText,
    /// The binary CLTAPE of APT III.
    Cltape,
    /// The tape of a machine, as text.
    Tape {
        /// The machine.
        machine: String,
    },
    /// A picture of the path.
    Picture(PictureKind),
}

/// Format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PictureKind {
    /// A stand-alone page.
    Html,
    /// A drawing.
    Svg,
}

/// A machine a tape can be made for.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub(crate) struct MachineInfo {
    /// Short name, for `--machine`.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Its control.
    pub control: String,
}

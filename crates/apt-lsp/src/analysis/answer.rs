//! What documents answer: plain data, public fields, no protocol types.
//!
//! Most of it is what `apt-ide` answers, under one roof here; only what carries places of other statements has a
//! form of its own, in which they are byte ranges.

use std::ops::Range;
use std::sync::Arc;

pub(crate) use apt_ide::action::ActionKind;
pub(crate) use apt_ide::calls::{Calls, Routine};
pub(crate) use apt_ide::completion::{Completion, CompletionKind};
pub(crate) use apt_ide::conversion::{ClDialect, ConvertedFile};
pub(crate) use apt_ide::difference::{
    Allowance, DifferentStretch, PathDifference, Statement, StretchKind, StretchSide, ToolPath, Units,
};
pub(crate) use apt_ide::files::Inclusion;
pub(crate) use apt_ide::folding::{Fold, FoldKind};
pub(crate) use apt_ide::hover::{CanonicalForm, Hover};
pub(crate) use apt_ide::inlay::Inlay;
pub(crate) use apt_ide::lens::Lens;
pub(crate) use apt_ide::navigation::{Located, Occurrence, Spot};
pub(crate) use apt_ide::outline::{OutlineEntry, OutlineKind};
pub(crate) use apt_ide::signature::{Signature, SignatureHelp};
pub(crate) use apt_ide::tape::{DEFINITION_ENDING, MachineInfo, TapeCode, TextOfBinary, length_inches};
pub(crate) use apt_ide::tokens::{Token, TokenClass};
pub(crate) use apt_ide::{Files, Fix, Level, Severity, Surroundings, normalised};
pub(crate) use apt_run::{diagnostic::SourceFile, document::Holdings};
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
    #[error("no machine is named; give one, set `machine` in apt-lsp.toml, or write MACHIN into the program")]
    NoMachine,
    /// What keeps it from being made is among the findings.
    #[error("it cannot be made; the findings say why")]
    Found,
    /// The program gives nothing to write.
    #[error("{0}")]
    Impossible(String),
}

impl From<Interrupted> for Refusal {
    fn from(Interrupted: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// A program or CL file in a CL dialect.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Conversion {
    /// The file.
    pub file: ConvertedFile,
    /// What it was made of.
    pub from: ClDialect,
    /// What was found in the program or file, and what the dialect says otherwise.
    pub diagnostics: Vec<Diagnostic>,
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

/// What formatting a program comes to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Formatting {
    /// The edits, in order of the text and without overlap.
    pub edits: Vec<TextEdit>,
    /// Statements that could not be given the style, and why.
    pub kept: Vec<(Range<usize>, String)>,
}

impl Formatting {
    /// The text with the edits.
    pub(crate) fn applied(&self, text: &str) -> String {
        let mut new = String::with_capacity(text.len());
        let mut end = 0;
        for edit in &self.edits {
            new.push_str(text.get(end..edit.range.start).unwrap_or(""));
            new.push_str(&edit.text);
            end = edit.range.end;
        }
        new.push_str(text.get(end..).unwrap_or(""));
        new
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
    /// Places in included files that have to do with it.
    pub elsewhere: Vec<Elsewhere>,
    /// The text has no effect, and can be shown faded.
    pub unnecessary: bool,
    /// Changes that settle it, the likeliest first.
    pub fixes: Vec<Fix>,
}

/// Something that can be done about a place.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Action {
    /// What it does, as a command.
    pub title: String,
    /// Its kind.
    pub kind: ActionKind,
    /// The edits, in order of the text and without overlap.
    pub edits: Vec<TextEdit>,
    /// Whether it is certainly what is wanted.
    pub preferred: bool,
    /// The finding that it settles.
    pub settles: Option<Diagnostic>,
}

/// The gravest findings of a program.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Worst {
    /// The findings, ordered by place.
    pub diagnostics: Vec<Diagnostic>,
    /// How many others there are.
    pub left_out: usize,
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

/// A place in an included file that has to do with a finding.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Elsewhere {
    /// Why it is shown.
    pub message: String,
    /// The file.
    pub source: Arc<SourceFile>,
    /// Where in it.
    pub range: Range<usize>,
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
    /// Whether a remark may stand behind the statement and not be part of it.
    pub room_behind: bool,
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
    /// With the story of each motion.
    pub story: bool,
}

/// What can be written to a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Product {
    /// CL text.
    ClText,
    /// The binary CLTAPE of APT III.
    Cltape,
    /// The tape of a machine: as text, or as the image that a punch makes of it.
    Tape {
        /// The machine.
        machine: String,
        /// The code of a punched image.
        punch: Option<TapeCode>,
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
    /// The drawing as pixels.
    Png,
}

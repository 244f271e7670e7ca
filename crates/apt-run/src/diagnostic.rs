//! Diagnostics as the user sees them: a stable code, words from the catalogue, a place and the way that led there.

use std::sync::Arc;

pub use apt_program::record::SourceFile;
use apt_program::record::{Frame, FrameKind, Origin};
use apt_syntax::SyntaxTree;
use serde::{Deserialize, Serialize};

/// How grave a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Severity {
    Hint,
    Information,
    Warning,
    Error,
}

/// The words of a finding, from the catalogue.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wording {
    /// Stable code, `APTnnnn`.
    pub code: &'static str,
    /// What is wrong, in one sentence.
    pub message: String,
    /// What would help.
    pub hint: Option<String>,
    /// The APT III diagnostic number, where one exists.
    pub apt3: Option<u16>,
}

/// A change of the program that settles a finding.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Fix {
    /// What it does, as a command: "Replace P9 by P8".
    pub title: String,
    /// The edits: bytes of the whole text, ascending, without overlap, and what takes their place.
    pub edits: Vec<(std::ops::Range<usize>, String)>,
    /// Whether it is certainly what was meant, so that an editor may apply it without a question.
    pub preferred: bool,
}

/// One finding about a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// The words.
    pub wording: Wording,
    /// How grave.
    pub severity: Severity,
    /// Where it is, with the macro calls and loop turns that led there.
    pub origin: Origin,
    /// Places that belong to it.
    pub related: Vec<(String, Origin)>,
    /// The place is code without effect: editors may fade it.
    pub unnecessary: bool,
    /// Changes that settle it, the likeliest first. They concern the text of the program itself, never an included file.
    pub fixes: Vec<Fix>,
}

/// One level of macro call, loop turn or inclusion, as the interfaces have it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct OriginStep {
    /// `macro`, `loop` or `include`.
    pub kind: &'static str,
    /// Name of the macro or file.
    pub name: String,
    /// ISN of the CALL or LOOPST.
    pub isn: u32,
    /// Which turn.
    pub turn: u32,
}

/// The frames of an origin, innermost first.
pub fn origin_steps(origin: &Origin) -> Vec<OriginStep> {
    let mut steps = Vec::new();
    let mut frame = origin.frame.as_deref();
    while let Some(step) = frame {
        let kind = match step.kind {
            FrameKind::Macro => "macro",
            FrameKind::Loop => "loop",
            FrameKind::Include => "include",
        };
        steps.push(OriginStep { kind, name: step.name.to_string(), isn: step.isn, turn: step.turn });
        frame = step.parent.as_deref();
    }
    steps
}

/// The byte range of an origin in the text of the program: for a place in an included file, that of the INCLUD or CALL
/// that led there.
pub fn absolute_range(tree: &SyntaxTree, origin: &Origin) -> std::ops::Range<usize> {
    let (isn, range) = origin.place_in_program();
    statement_range(tree, isn, range)
}

/// A place: bytes of an included file, or of the program itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// The included file; `None` for the program.
    pub source: Option<Arc<SourceFile>>,
    /// Bytes of its text.
    pub range: std::ops::Range<usize>,
}

impl Place {
    /// The place of an origin, in the file in which it stands.
    pub fn of(tree: &SyntaxTree, origin: &Origin) -> Self {
        let tree = origin.source.as_ref().map_or(tree, |source| &source.tree);
        Self { source: origin.source.clone(), range: statement_range(tree, origin.isn, origin.range) }
    }
}

/// The frames of an origin with the places of their statements in the text of the program, innermost first; those in
/// included files have none there.
pub fn frame_places(tree: &SyntaxTree, origin: &Origin) -> Vec<(OriginStep, Option<std::ops::Range<usize>>)> {
    let around = std::iter::successors(origin.frame.as_deref(), |frame| frame.parent.as_deref());
    let place = |frame: &Frame| frame.source.is_none().then(|| statement_range(tree, frame.isn, frame.range));
    origin_steps(origin).into_iter().zip(around.map(place)).collect()
}

/// The places that belong to a finding; of one in an included file the first is the place itself.
pub fn related_places(tree: &SyntaxTree, diagnostic: &Diagnostic) -> Vec<(String, Place)> {
    let own = diagnostic.origin.source.is_some();
    let own = own.then(|| ("in the included file, here".to_owned(), Place::of(tree, &diagnostic.origin)));
    let related = diagnostic.related.iter();
    own.into_iter().chain(related.map(|(text, origin)| (text.clone(), Place::of(tree, origin)))).collect()
}

/// The byte range of a place relative to the statement with this number.
pub fn statement_range(tree: &SyntaxTree, isn: u32, range: apt_syntax::TextRange) -> std::ops::Range<usize> {
    let count = tree.statement_count();
    if count == 0 {
        return 0..0;
    }
    let index = (isn.max(1) as usize - 1).min(count - 1);
    let whole = tree.statement(index).range();
    let start = usize::from(whole.start()) + usize::from(range.start());
    let end = usize::from(whole.start()) + usize::from(range.end());
    let limit = usize::from(whole.end());
    start.min(limit)..end.min(limit)
}

//! The one place where findings become words: stable codes, messages, hints, and a page for each code.
//!
//! Codes: 00xx lexical and syntactic, 01xx names and subscripts, 02xx arithmetic, 03xx definitions and operands,
//! 04xx labels, loops and macros, 05xx motion statements, 06xx the arithmetic element, 07xx path transformations,
//! 08xx post-processor statements and tape, 09xx the program as a whole, with 095x and 096x for lints. A code is never given a new meaning.

mod conversion;
mod cutter_locations;
mod definitions;
mod lint;
mod milling;
mod motion;
mod names;
mod pages;
mod pocket;
mod postprocessor;
mod program;
pub(crate) mod remedy;
mod sculptured;
mod story;
mod syntax;
mod tilt;

use std::cmp::Reverse;

use apt_cldata::{conversion::ConversionNote, text::ReadError};
use apt_geometry::{
    canonical::GeometryKind,
    patience::{Aside, Patience},
    pieces::sorted,
};
use apt_post::{PostFinding, Tape};
use apt_program::{
    Origin, Program,
    finding::{Finding, FindingKind, RelatedKind, Severity as ProgramSeverity},
};
use apt_syntax::{SyntaxTree, TextRange};
use smol_str::SmolStr;

pub use pages::{Page, explain, pages};
pub use story::lines as story_lines;

use crate::{
    Cancelled,
    allow::{Allowances, Idle},
    diagnostic::{Diagnostic, Fix, Severity, Wording},
    go_on,
    lint::{Lint, LintKind},
    pipeline::{RunFinding, RunResult},
    settings::Settings,
};

/// Code, message and hint, before the APT III number is added.
pub(crate) struct Text {
    code: &'static str,
    message: String,
    hint: Option<String>,
}

/// A text without a hint.
fn say(code: &'static str, message: impl Into<String>) -> Text {
    Text { code, message: message.into(), hint: None }
}

impl Text {
    /// Adds what would help.
    fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// Adds the hint if there is one.
    fn maybe(mut self, hint: Option<String>) -> Self {
        self.hint = hint.or(self.hint);
        self
    }
}

/// Findings for which fixes are looked for. Nobody reads more, and a file in another language has one in every line.
const MOST_FIXED: usize = 1_000;

/// What diagnostics are made from.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// The syntax of the program.
    pub tree: &'a SyntaxTree,
    /// Its evaluation.
    pub program: &'a Program,
    /// Its run, if it was run.
    pub result: Option<&'a RunResult>,
    /// The settings, of which the severities are.
    pub settings: &'a Settings,
}

/// All diagnostics of a program and perhaps its run, in order of their place, with the severities of the settings.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn diagnostics(judged: &Judged<'_>, patience: Patience<'_>) -> Result<Vec<Diagnostic>, Cancelled> {
    let mut list = Aside::from(Vec::new());
    for finding in judged.program.findings() {
        go_on(patience, 1)?;
        let mut diagnostic = of_program(judged.tree, finding);
        if list.len() < MOST_FIXED {
            diagnostic.fixes = crate::fix::of_finding(judged.tree, finding, judged.settings);
        }
        list.push(diagnostic);
    }
    let allowances = Allowances::of(judged.tree, patience)?;
    completed(list, judged, allowances, patience)
}

/// The gravest diagnostics of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// The diagnostics, in order of their place.
    pub diagnostics: Vec<Diagnostic>,
    /// How many others there are.
    pub left_out: usize,
}

impl Worst {
    /// The gravest of some diagnostics, at most `most`; of equally grave ones those that come first.
    pub fn of(mut diagnostics: Vec<Diagnostic>, most: usize) -> Self {
        let left_out = diagnostics.len().saturating_sub(most);
        if left_out > 0 {
            let mut numbered: Vec<(usize, Diagnostic)> = diagnostics.into_iter().enumerate().collect();
            numbered.sort_by_key(|(number, one)| (Reverse(one.severity), *number));
            numbered.truncate(most);
            numbered.sort_unstable_by_key(|(number, _)| *number);
            diagnostics = numbered.into_iter().map(|(_, one)| one).collect();
        }
        Self { diagnostics, left_out }
    }
}

/// What [`diagnostics`] finds, cut to the gravest: only these are put into words, as far as the others can be judged
/// without. Fixes for findings of Section 1 are left out: they are looked for when somebody asks what can be done.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn worst(judged: &Judged<'_>, most: usize, patience: Patience<'_>) -> Result<Worst, Cancelled> {
    let settings = judged.settings;
    let allowances = Allowances::of(judged.tree, patience)?;
    let mut findings: Vec<&Finding> = judged.program.findings().collect();
    let total = findings.len();
    // Settings and comments name codes, and words that become names are judged one with the other.
    let in_pairs = |finding: &&Finding| matches!(finding.kind, FindingKind::WordBecomesName { .. });
    if total > most && settings.severity.is_empty() && allowances.is_empty() && !findings.iter().any(in_pairs)
    {
        findings = gravest(&findings, most);
    }
    let unworded = total - findings.len();
    let mut list = Aside::from(Vec::with_capacity(findings.len()));
    for finding in findings {
        go_on(patience, 1)?;
        list.push(of_program(judged.tree, finding));
    }
    let mut worst = Worst::of(completed(list, judged, allowances, patience)?, most);
    worst.left_out += unworded;
    Ok(worst)
}

/// The gravest of more than `most` findings; of equally grave ones those that come first.
fn gravest<'a>(findings: &[&'a Finding], most: usize) -> Vec<&'a Finding> {
    let gravity = |(number, finding): (usize, &&Finding)| {
        let (isn, range) = finding.origin.place_in_program();
        (Reverse(finding.severity), isn, range.start(), number)
    };
    let mut numbered: Vec<_> = findings.iter().enumerate().map(gravity).collect();
    if most < numbered.len() {
        numbered.select_nth_unstable(most);
        numbered.truncate(most);
    }
    numbered.sort_unstable();
    numbered.into_iter().filter_map(|(.., number)| findings.get(number).copied()).collect()
}

/// The findings of Section 1 with all others, in order of their place.
fn completed(
    mut list: Aside<Diagnostic>,
    judged: &Judged<'_>,
    mut allowances: Allowances,
    patience: Patience<'_>,
) -> Result<Vec<Diagnostic>, Cancelled> {
    let Judged { tree, program, result, settings } = *judged;
    crate::lint::keep_shadowing(tree, &mut list, patience)?;
    for finding in result.into_iter().flat_map(|result| &result.findings) {
        go_on(patience, 1)?;
        list.push(of_run(tree, finding));
    }
    for lint in crate::lint::lint(tree, program, settings.units, patience)? {
        go_on(patience, 1)?;
        add_lint(&mut list, lint);
    }
    allowances.filter(&mut list);
    list.extend(allowances.idle(result.is_some()));
    in_order(list, settings, patience)
}

fn of_program(tree: &SyntaxTree, finding: &Finding) -> Diagnostic {
    let mut text = program::word(&finding.kind);
    if let FindingKind::Syntax(error) = &finding.kind
        && let Some(question) = similar(&crate::fix::words_like(tree.dialect(), error))
    {
        text.hint = Some(question);
    }
    if let Some(question) = crate::fix::operands_like(tree, finding).as_deref().and_then(similar) {
        text.hint = Some(question);
    }
    let severity = match finding.severity {
        ProgramSeverity::Hint => Severity::Hint,
        ProgramSeverity::Information => Severity::Information,
        ProgramSeverity::Warning => Severity::Warning,
        ProgramSeverity::Error => Severity::Error,
    };
    let related =
        finding.related.iter().map(|(kind, origin)| (related(*kind).to_owned(), origin.clone())).collect();
    Diagnostic {
        wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3: finding.number },
        severity,
        origin: finding.origin.clone(),
        related,
        unnecessary: program::is_unnecessary(&finding.kind),
        fixes: Vec::new(),
    }
}

/// What the engine says of a tool on the other side of its drive surface.
const OTHER_SIDE: &str = "APT0660";

/// Adds a lint, unless the computed motion says the same; then it only lends its fixes.
fn add_lint(list: &mut Vec<Diagnostic>, lint: Lint) {
    if matches!(lint.kind, LintKind::SideContradicted { .. }) {
        let is_same =
            |finding: &&mut Diagnostic| finding.wording.code == OTHER_SIDE && finding.origin == lint.origin;
        if let Some(finding) = list.iter_mut().find(is_same) {
            finding.fixes.extend(lint.fixes);
            return;
        }
    }
    list.push(of_lint(lint));
}

fn of_lint(lint: Lint) -> Diagnostic {
    let (text, severity) = lint::word(&lint.kind);
    let related = lint.other.map(|other| (other_place(&lint.kind).to_owned(), other));
    Diagnostic {
        wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3: None },
        severity,
        origin: lint.origin,
        related: related.into_iter().collect(),
        unnecessary: matches!(
            lint.kind,
            LintKind::DirectionReplaced | LintKind::Overwritten { .. } | LintKind::ModeReplaced { .. }
        ),
        fixes: lint.fixes,
    }
}

/// What the other place of a lint is to it.
fn other_place(kind: &LintKind) -> &'static str {
    match kind {
        LintKind::SideContradicted { .. } => "the side is said here",
        LintKind::ToolWithTwoCutters { .. } => "the tool has this cutter before",
        _ => "this one counts",
    }
}

/// The finding that a comment allows nothing.
pub(crate) fn idle_allowance(reason: Idle, code: &str, origin: Origin, fixes: Vec<Fix>) -> Diagnostic {
    let text = lint::idle(reason, code);
    Diagnostic {
        wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3: None },
        severity: Severity::Warning,
        origin,
        related: Vec::new(),
        unnecessary: reason == Idle::NothingFound,
        fixes,
    }
}

/// Whether a code is one of a conversion or of the post-processor, which only the making of a file or tape can find.
pub fn is_tape_code(code: &str) -> bool {
    let number = code.strip_prefix("APT").and_then(|digits| digits.parse::<u16>().ok());
    number.is_some_and(|number| (817..900).contains(&number))
}

fn of_run(tree: &SyntaxTree, finding: &RunFinding) -> Diagnostic {
    let (text, severity, apt3) = motion::word(&finding.kind);
    Diagnostic {
        wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3 },
        severity,
        origin: finding.origin.clone(),
        related: Vec::new(),
        unnecessary: false,
        fixes: crate::fix::of_run(tree, finding),
    }
}

/// The diagnostics of a tape, with the severities of the settings. `origins` is the table that the findings refer to.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn tape_diagnostics(
    tree: &SyntaxTree,
    tape: &Tape,
    origins: &[Origin],
    settings: &Settings,
    patience: Patience<'_>,
) -> Result<Vec<Diagnostic>, Cancelled> {
    let of_post = |finding: &PostFinding| {
        let (text, severity) = postprocessor::word(&finding.kind);
        let unknown = || Origin::in_program(finding.isn.max(1), TextRange::default());
        Diagnostic {
            wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3: None },
            severity,
            origin: origins.get(finding.source as usize).cloned().unwrap_or_else(unknown),
            related: Vec::new(),
            unnecessary: false,
            fixes: Vec::new(),
        }
    };
    let mut list = Aside::from(Vec::with_capacity(tape.findings.len()));
    for finding in &tape.findings {
        go_on(patience, 1)?;
        list.push(of_post(finding));
    }
    Allowances::of(tree, patience)?.filter(&mut list);
    in_order(list, settings, patience)
}

/// What the reader of a CL file says, with the severities of the settings. `origins` has the statement of every line.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn read_diagnostics(
    errors: &[ReadError],
    origins: &[Origin],
    settings: &Settings,
    patience: Patience<'_>,
) -> Result<Vec<Diagnostic>, Cancelled> {
    let of_line = |error: &ReadError| {
        let (text, severity) = cutter_locations::word(error);
        let unknown = || Origin::in_program(error.isn.max(1), TextRange::default());
        Diagnostic {
            wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3: None },
            severity,
            origin: origins.get(error.line as usize).cloned().unwrap_or_else(unknown),
            related: Vec::new(),
            unnecessary: false,
            fixes: Vec::new(),
        }
    };
    let mut list = Aside::from(Vec::with_capacity(errors.len()));
    for error in errors {
        go_on(patience, 1)?;
        list.push(of_line(error));
    }
    in_order(list, settings, patience)
}

/// What a conversion to another CL dialect tells, with the severities of the settings. `origins` is the table that the records refer to.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn conversion_diagnostics(
    tree: &SyntaxTree,
    notes: &[ConversionNote],
    origins: &[Origin],
    settings: &Settings,
    patience: Patience<'_>,
) -> Result<Vec<Diagnostic>, Cancelled> {
    let of_note = |note: &ConversionNote| {
        let (text, severity) = conversion::word(note);
        let unknown = || Origin::in_program(note.isn.max(1), TextRange::default());
        Diagnostic {
            wording: Wording { code: text.code, message: text.message, hint: text.hint, apt3: None },
            severity,
            origin: origins.get(note.source as usize).cloned().unwrap_or_else(unknown),
            related: Vec::new(),
            unnecessary: false,
            fixes: Vec::new(),
        }
    };
    let mut list = Aside::from(notes.iter().map(of_note).collect::<Vec<_>>());
    Allowances::of(tree, patience)?.filter(&mut list);
    in_order(list, settings, patience)
}

/// Applies the severities of the settings and sorts by place.
fn in_order(
    mut list: Aside<Diagnostic>,
    settings: &Settings,
    patience: Patience<'_>,
) -> Result<Vec<Diagnostic>, Cancelled> {
    let mut told = 0;
    for at in 0..list.len() {
        go_on(patience, 1)?;
        if list.get_mut(at).is_some_and(|diagnostic| set_severity(diagnostic, settings)) {
            list.swap(told, at);
            told += 1;
        }
    }
    while list.len() > told {
        go_on(patience, 1)?;
        list.pop();
    }
    by_place(list.taken(), patience)
}

/// Gives a diagnostic the severity of the settings; false if they want it left out.
fn set_severity(diagnostic: &mut Diagnostic, settings: &Settings) -> bool {
    match settings.severity.get(diagnostic.wording.code) {
        None => true,
        Some(setting) => setting.severity().map(|severity| diagnostic.severity = severity).is_some(),
    }
}

/// Sorts diagnostics by their place in the program; those of one place keep their order.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn by_place(list: Vec<Diagnostic>, patience: Patience<'_>) -> Result<Vec<Diagnostic>, Cancelled> {
    let mut list = Aside::from(list);
    // The places are sorted, not the diagnostics, which are much larger.
    let mut places = Vec::with_capacity(list.len());
    for (number, diagnostic) in list.iter().enumerate() {
        go_on(patience, 1)?;
        let (isn, range) = diagnostic.origin.place_in_program();
        let inside = diagnostic.origin.source.as_ref().map(|_| diagnostic.origin.isn);
        places.push(((isn, range.start(), inside), number));
    }
    if !places.is_sorted() {
        let places = sorted(places, Ord::cmp, patience);
        go_on(patience, 0)?;
        put_in_order(&mut list, places, patience)?;
    }
    Ok(list.taken())
}

/// Puts things in an order, which says last where each of them stands before. They change places: another list of so many would take
/// its time to be given back.
fn put_in_order<T, K>(
    list: &mut [T],
    mut order: Vec<(K, usize)>,
    patience: Patience<'_>,
) -> Result<(), Cancelled> {
    for first in 0..order.len() {
        let mut at = first;
        // What is in its place is said to stand there before.
        while let Some(from) = order.get_mut(at).map(|(_, from)| std::mem::replace(from, at)) {
            go_on(patience, 1)?;
            if from == first {
                break;
            }
            list.swap(at, from);
            at = from;
        }
    }
    Ok(())
}

/// What is told when the settings name a machine that nobody knows, with the severities of the settings.
pub fn unknown_machine(name: &str, known: &[String], settings: &Settings) -> Vec<Diagnostic> {
    let message = format!("the settings name the machine {name}, which is not known; no tape is checked");
    no_machine(message, format!("the machines are {}", known.join(", ")), settings)
}

/// What is told when the settings name a definition of a machine that cannot be used.
pub fn unusable_machine(file: &str, why: &str, settings: &Settings) -> Vec<Diagnostic> {
    let message = format!("the definition of the machine {file} cannot be used; no tape is checked");
    no_machine(message, why.to_owned(), settings)
}

fn no_machine(message: String, hint: String, settings: &Settings) -> Vec<Diagnostic> {
    let wording = Wording { code: "APT0894", message, hint: Some(hint), apt3: None };
    let mut diagnostic = Diagnostic {
        wording,
        severity: Severity::Warning,
        origin: Origin::in_program(1, TextRange::default()),
        related: Vec::new(),
        unnecessary: false,
        fixes: Vec::new(),
    };
    if set_severity(&mut diagnostic, settings) { vec![diagnostic] } else { Vec::new() }
}

fn related(kind: RelatedKind) -> &'static str {
    match kind {
        RelatedKind::Definition => "it is defined here",
        RelatedKind::Reservation => "it is reserved here",
        RelatedKind::Macro => "the macro is defined here",
        RelatedKind::Loop => "the loop begins here",
        RelatedKind::Label => "the label stands here",
        RelatedKind::Branch => "the last branch begins here",
        RelatedKind::WaitingMotion => "this motion waits for its check surface",
    }
}

/// "did you mean" for a misspelt name.
fn similar(names: &[SmolStr]) -> Option<String> {
    match names {
        [] => None,
        [one] => Some(format!("did you mean {one}?")),
        [first, .., last] if names.len() == 2 => Some(format!("did you mean {first} or {last}?")),
        _ => Some(format!("did you mean one of {}?", names.join(", "))),
    }
}

/// A type with its article: `a LINE`, `an ELLIPS`.
fn a_kind(kind: GeometryKind) -> String {
    let word = kind.word();
    let article = if word.starts_with(['A', 'E', 'I', 'O', 'U']) { "an" } else { "a" };
    format!("{article} {word}")
}

/// A number in a message: nine decimals at most, with an exponent where these would show little or nothing.
fn number(value: f64) -> String {
    // The sum turns -0 into 0.
    let value = value + 0.0;
    let text = format!("{value:.9}");
    let rounded = text.trim_end_matches('0').trim_end_matches('.');
    if value != 0.0 && (value.abs() < 1e-4 || value.abs() >= 1e12) {
        format!("{value:.6e}")
    } else {
        rounded.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_are_put_in_order_where_they_stand() {
        for count in [0, 1, 2, 7, 1_000_usize] {
            // Seven is prime to all of them but itself, where things stay.
            let order: Vec<((), usize)> = (0..count).map(|at| ((), at * 7 % count)).collect();
            let order = if count == 7 { (0..7).map(|at| ((), at)).collect() } else { order };
            let wanted: Vec<usize> = order.iter().map(|(_, from)| *from).collect();
            let mut list: Vec<usize> = (0..count).collect();
            assert_eq!(put_in_order(&mut list, order, Patience::default()), Ok(()));
            assert_eq!(list, wanted);
        }
    }

    #[test]
    fn numbers_are_written_as_people_write_them() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (2.0, "2"),
            (100.0, "100"),
            (-0.25, "-0.25"),
            (1.0 / 3.0, "0.333333333"),
            (0.000_01, "1.000000e-5"),
            (-0.000_1, "-0.0001"),
            (2e12, "2.000000e12"),
            (0.1 + 0.2, "0.3"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text, "{value:e}");
        }
    }

    #[test]
    fn types_get_their_article() {
        assert_eq!(a_kind(GeometryKind::Line), "a LINE");
        assert_eq!(a_kind(GeometryKind::Ellipse), "an ELLIPS");
        assert_eq!(a_kind(GeometryKind::TabulatedCylinder), "a TABCYL");
    }

    #[test]
    fn similar_names_are_offered_as_a_question() {
        let names = ["P1", "P2", "P3"].map(SmolStr::new_static);
        assert_eq!(similar(&[]), None);
        assert_eq!(similar(&names[..1]).as_deref(), Some("did you mean P1?"));
        assert_eq!(similar(&names[..2]).as_deref(), Some("did you mean P1 or P2?"));
        assert_eq!(similar(&names).as_deref(), Some("did you mean one of P1, P2, P3?"));
    }

    #[test]
    fn a_hint_gives_way_to_a_better_one_only() {
        let text = say("APT0101", "x").hint("general").maybe(None);
        assert_eq!(text.hint.as_deref(), Some("general"));
        let text = say("APT0101", "x").hint("general").maybe(Some("special".to_owned()));
        assert_eq!(text.hint.as_deref(), Some("special"));
    }
}

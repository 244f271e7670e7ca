//! Builds a [`Report`] from the values of the sections.

use std::{collections::BTreeMap, ops::RangeInclusive, path::PathBuf};

use apt_cldata::{
    record::{ClKind, ClPoint, ClRecord, ClWord, Units},
    totals::{Totals, totals_where},
};
use apt_geometry::{
    canonical::Geometry,
    patience::{Aside, Patience},
    regional::LiftDirection,
};
use apt_program::{Program, Value as SymbolValue, record::Origin};
use apt_sculptured::mill::{Encounter, Remedy};
use apt_syntax::{SyntaxTree, TextRange};
use arelem::verify::Extent;
use serde_json::{Map, Value, json};

use super::{
    ClEntry, DiagnosticReport, EditReport, FixReport, InterferenceEntry, ListingReport, MotionEntry,
    RelatedReport, RemedyEntry, Report, SourceReport, TotalsEntry,
};
use crate::{
    Cancelled,
    diagnostic::{Diagnostic, Fix, Severity, absolute_range, origin_steps, related_places, statement_range},
    go_on,
    pipeline::{Motion, RunResult, Suppressed},
    position::LineIndex,
};

/// What a report is made from.
pub struct ReportInput<'a> {
    /// File name of the program.
    pub file: &'a str,
    /// Its text.
    pub text: &'a str,
    /// Its syntax.
    pub tree: &'a SyntaxTree,
    /// Its evaluation.
    pub program: &'a Program,
    /// Its run.
    pub result: &'a RunResult,
    /// All diagnostics of Sections 1 to 3.
    pub diagnostics: &'a [Diagnostic],
    /// Only what statements with these numbers do, and what they call, is listed under `listing`, `cl`, `motions` and
    /// `interference` and summed up in `totals`; everything without. Diagnostics and symbols are those of the program, on
    /// which the rest depends.
    pub statements: Option<RangeInclusive<u32>>,
}

/// Whether something was done by statements with these numbers: by one of them itself, or by what one of them calls.
pub fn is_of(origin: &Origin, statements: Option<&RangeInclusive<u32>>) -> bool {
    statements.is_none_or(|range| origin.statements_in_program().any(|isn| range.contains(&isn)))
}

/// Finds where in the sources records come from; each included file is looked through once.
pub struct Sources<'a> {
    tree: &'a SyntaxTree,
    lines: &'a LineIndex,
    included: BTreeMap<PathBuf, LineIndex>,
}

impl<'a> Sources<'a> {
    /// For a program with these lines.
    pub fn new(tree: &'a SyntaxTree, lines: &'a LineIndex) -> Self {
        Self { tree, lines, included: BTreeMap::new() }
    }

    /// Where something comes from.
    pub fn of(&mut self, origin: &Origin) -> SourceReport {
        let begins = |tree| statement_range(tree, origin.isn, TextRange::default()).start;
        let (file, line) = match &origin.source {
            None => (None, self.lines.line_of(begins(self.tree))),
            Some(source) => {
                let index = || LineIndex::new(&source.tree.text());
                let lines = self.included.entry(source.path.clone()).or_insert_with(index);
                (Some(source.path.display().to_string()), lines.line_of(begins(&source.tree)))
            }
        };
        SourceReport { file, line: Some(line), origin: origin_steps(origin) }
    }

    /// Where a statement of the program stands that has left no more behind than its number.
    fn of_statement(&mut self, isn: u32) -> SourceReport {
        let known = (1..=self.tree.statement_count()).contains(&(isn as usize));
        if known { self.of(&Origin::in_program(isn, TextRange::default())) } else { SourceReport::default() }
    }
}

/// Builds the report.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub fn report(input: &ReportInput<'_>, patience: Patience<'_>) -> Result<Report, Cancelled> {
    let lines = LineIndex::until(input.text, patience)?;
    let statements = input.statements.as_ref();
    let wanted = |origin: &Origin| is_of(origin, statements);
    let mut sources = Sources::new(input.tree, &lines);
    let wanted_record = |record: &ClRecord| match input.result.origins.get(record.source as usize) {
        Some(origin) => wanted(origin),
        None => statements.is_none_or(|range| range.contains(&record.isn)),
    };
    // A list that grows is copied as a whole, which nobody can interrupt.
    let count = if statements.is_none() { input.result.records.len() } else { 0 };
    let mut cl = Aside::from(Vec::with_capacity(count));
    for record in &input.result.records {
        go_on(patience, 1)?;
        if !wanted_record(record) {
            continue;
        }
        let source = match input.result.origins.get(record.source as usize) {
            Some(origin) => sources.of(origin),
            None => sources.of_statement(record.isn),
        };
        cl.push(cl_entry(record, source));
    }
    let mut diagnostics = Aside::from(Vec::with_capacity(input.diagnostics.len()));
    for diagnostic in input.diagnostics {
        go_on(patience, 1)?;
        diagnostics.push(diagnostic_report(diagnostic, input.file, input.text, input.tree, &lines));
    }
    let mut motions = Aside::from(Vec::new());
    for motion in input.result.motions.iter().filter(|motion| wanted(&motion.origin)) {
        go_on(patience, 1)?;
        motions.push(motion_entry(motion, input.tree, sources.of(&motion.origin)));
    }
    let totals = totals_where(&input.result.records, wanted_record, patience).ok_or(Cancelled)?;
    let (symbols, listing) = (symbols(input.program, patience)?, listing(input, wanted, patience)?);
    Ok(Report {
        program: input.file.to_owned(),
        ok: input.diagnostics.iter().all(|diagnostic| diagnostic.severity != Severity::Error),
        dialect: input.tree.dialect().name.as_str().to_owned(),
        diagnostics: diagnostics.taken(),
        symbols,
        listing,
        cl: cl.taken(),
        motions: motions.taken(),
        interference: interference(input.result, wanted),
        totals: totals_entry(&totals),
    })
}

/// The interferences of the wanted statements.
fn interference(result: &RunResult, wanted: impl Fn(&Origin) -> bool) -> Vec<InterferenceEntry> {
    let milled = result.milled.iter().filter(|milling| wanted(&milling.origin));
    milled
        .flat_map(|milling| {
            let isn = milling.origin.place_in_program().0;
            milling.milled.encounters.iter().map(move |one| interference_entry(isn, one))
        })
        .collect()
}

fn interference_entry(isn: u32, encounter: &Encounter) -> InterferenceEntry {
    let remedy = match encounter.remedy {
        Remedy::None => None,
        Remedy::Avoided { tilt, lift, along, .. } => Some(RemedyEntry {
            result: "avoided",
            tilt: (tilt != 0.0).then(|| clean(tilt.to_degrees())),
            lift: (lift != 0.0).then_some(lift),
            along: (lift != 0.0).then_some(match along {
                LiftDirection::Axis => "axis",
                LiftDirection::PartNormal => "normal",
            }),
        }),
        Remedy::Failed(_) => Some(RemedyEntry { result: "failed", tilt: None, lift: None, along: None }),
    };
    InterferenceEntry {
        isn,
        surface: encounter.surface.clone(),
        te: encounter.pose.end.map(clean).into(),
        ta: encounter.pose.axis.map(clean).into(),
        depth: encounter.hit.depth,
        patch: encounter.hit.patch + 1,
        uv: encounter.hit.parameters.map(clean),
        remedy,
    }
}

/// What the wanted statements list: what the program prints and what DNTCUT/PRINT lists, each in its own order and the
/// two by the numbers of their statements.
fn listing(
    input: &ReportInput<'_>,
    wanted: impl Fn(&Origin) -> bool,
    patience: Patience<'_>,
) -> Result<Vec<ListingReport>, Cancelled> {
    let mut printed = input.program.listing().filter(|entry| wanted(&entry.origin)).peekable();
    let mut kept = input.result.suppressed.iter().filter(|one| wanted(&one.origin)).peekable();
    let mut listing = Vec::new();
    loop {
        let isn = |origin: &Origin| origin.place_in_program().0;
        let (first, second) =
            (printed.peek().map(|one| isn(&one.origin)), kept.peek().map(|one| isn(&one.origin)));
        let isn = match (first, second) {
            (None, None) => return Ok(listing),
            (Some(isn), None) => isn,
            (None, Some(isn)) => isn,
            (Some(first), Some(second)) => first.min(second),
        };
        let lines = if first == Some(isn) {
            printed.next().map(|entry| entry.lines())
        } else {
            kept.next().map(suppressed_lines)
        };
        let lines = lines.unwrap_or_default();
        go_on(patience, 1 + lines.len())?;
        listing.push(ListingReport { isn, lines });
    }
}

/// Positions that are not on the path, under a line that names what makes them.
fn suppressed_lines(suppressed: &Suppressed) -> Vec<String> {
    let Suppressed { name, points, .. } = suppressed;
    let name = if name.is_empty() { String::new() } else { format!(" {name}") };
    let head = format!("GOTO{name} NOT ON THE PATH {}", points.len());
    let line = |point: &ClPoint| {
        let axis = if point.with_axis { point.axis.as_slice() } else { &[] };
        let numbers = point.position.iter().chain(axis).map(|number| format!("{:.6}", clean(*number)));
        format!("  {}", numbers.collect::<Vec<_>>().join(" "))
    };
    std::iter::once(head).chain(points.iter().map(line)).collect()
}

/// A diagnostic with its places as lines and characters.
pub fn diagnostic_report(
    diagnostic: &Diagnostic,
    file: &str,
    text: &str,
    tree: &SyntaxTree,
    lines: &LineIndex,
) -> DiagnosticReport {
    let related = related_places(tree, diagnostic).into_iter().map(|(message, place)| match place.source {
        None => RelatedReport { message, file: file.to_owned(), range: lines.range(text, place.range) },
        Some(source) => {
            let (text, file) = (source.tree.text(), source.path.display().to_string());
            let range = LineIndex::new(&text).range(&text, place.range);
            RelatedReport { message, file, range }
        }
    });
    DiagnosticReport {
        code: diagnostic.wording.code.to_owned(),
        severity: diagnostic.severity,
        message: diagnostic.wording.message.clone(),
        isn: diagnostic.origin.place_in_program().0,
        apt3: diagnostic.wording.apt3,
        file: file.to_owned(),
        range: lines.range(text, absolute_range(tree, &diagnostic.origin)),
        origin: origin_steps(&diagnostic.origin),
        related: related.collect(),
        hint: diagnostic.wording.hint.clone(),
        fixes: diagnostic.fixes.iter().map(|fix| fix_report(fix, text, lines)).collect(),
    }
}

fn fix_report(fix: &Fix, text: &str, lines: &LineIndex) -> FixReport {
    let edit = |(range, insert): &(std::ops::Range<usize>, String)| EditReport {
        range: lines.range(text, range.clone()),
        text: insert.clone(),
    };
    FixReport {
        title: fix.title.clone(),
        preferred: fix.preferred,
        edits: fix.edits.iter().map(edit).collect(),
    }
}

/// A number for JSON: `-0.0` becomes `0.0`; what JSON cannot hold becomes null.
pub fn clean_number(number: f64) -> Value {
    json!(number + 0.0)
}

fn clean(number: f64) -> f64 {
    number + 0.0
}

fn symbols(program: &Program, patience: Patience<'_>) -> Result<Map<String, Value>, Cancelled> {
    let symbols = program.symbols_until(patience).ok_or(Cancelled)?;
    let mut map = Map::with_capacity(symbols.len());
    for (name, value) in symbols {
        go_on(patience, 1)?;
        let entry = match value {
            SymbolValue::Scalar(number) => json!({ "type": "SCALAR", "canonical": [clean_number(number)] }),
            SymbolValue::Geometry(geometry) => geometry_value(&geometry),
        };
        map.insert(name.to_string(), entry);
    }
    Ok(map)
}

/// Type and canonical values as the oracle corpus shows them: a pattern has none, a ruled surface shows its parts.
fn geometry_value(geometry: &Geometry) -> Value {
    let word = geometry.kind().word();
    match geometry {
        Geometry::Pattern(_) | Geometry::Sculptured(_) | Geometry::SpaceCurve(_) => {
            json!({ "type": word, "canonical": null })
        }
        Geometry::RuledSurface(surface) => {
            let parts: Vec<_> = surface.parts.iter().map(geometry_value).collect();
            json!({ "type": word, "canonical": null, "parts": parts })
        }
        _ => {
            let values: Vec<_> = geometry.canonical_values().into_iter().map(clean_number).collect();
            json!({ "type": word, "canonical": values })
        }
    }
}

fn cl_entry(record: &ClRecord, source: SourceReport) -> ClEntry {
    let SourceReport { file, line, origin } = source;
    let entry = |kind| ClEntry {
        isn: record.isn,
        file,
        line,
        origin,
        kind,
        surface: None,
        words: None,
        code: None,
        points: None,
    };
    match &record.kind {
        ClKind::Postprocessor { word, code, arguments } => ClEntry {
            words: Some(words(word, arguments)),
            code: code.map(|code| json!(code)),
            ..entry("postprocessor")
        },
        ClKind::Text { word, code, text } => ClEntry {
            words: Some(vec![json!(word), json!(text.trim())]),
            code: code.map(|code| json!(code)),
            ..entry("postprocessor")
        },
        ClKind::Arc { surface, center, axis, radius } => ClEntry {
            surface: name(surface),
            code: Some(json!([3000, 2])),
            words: Some(center.iter().chain(axis.iter()).chain([radius]).map(|&n| clean_number(n)).collect()),
            ..entry("other")
        },
        ClKind::Motion { from, surface, points } => {
            let point = |at: &apt_cldata::record::ClPoint| -> Vec<f64> {
                let axis = at.axis.iter().take(if at.with_axis { 3 } else { 0 });
                at.position.iter().chain(axis).map(|&n| clean(n)).collect()
            };
            ClEntry {
                surface: name(surface),
                points: Some(points.iter().map(point).collect()),
                ..entry(if *from { "from" } else { "go" })
            }
        }
        ClKind::Control { word, code, arguments } => {
            ClEntry { words: Some(words(word, arguments)), code: Some(json!(code)), ..entry("control") }
        }
        ClKind::MultipleAxes(on) => ClEntry {
            words: Some(vec![json!("MULTAX"), json!(if *on { "ON" } else { "OFF" })]),
            ..entry("mode")
        },
        ClKind::Units(units) => {
            let unit = match units {
                Units::Inches => "INCHES",
                Units::Millimeters => "MM",
            };
            ClEntry { words: Some(vec![json!("UNITS"), json!(unit)]), ..entry("mode") }
        }
        ClKind::End => entry("fini"),
    }
}

fn name(surface: &str) -> Option<String> {
    (!surface.is_empty()).then(|| surface.to_owned())
}

fn words(word: &str, arguments: &[ClWord]) -> Vec<Value> {
    let argument = |argument: &ClWord| match argument {
        ClWord::Number(number) => clean_number(*number),
        ClWord::Word(word) => json!(word),
    };
    std::iter::once(json!(word)).chain(arguments.iter().map(argument)).collect()
}

fn motion_entry(motion: &Motion, tree: &SyntaxTree, source: SourceReport) -> MotionEntry {
    let computed = &motion.computed;
    let (cut_vectors, minimum) = match &computed.execution.output {
        Some(arelem::section2::Output::Sequence(sequence)) => (sequence.points.len(), sequence.minimum),
        Some(arelem::section2::Output::Pocket(path)) => (path.positions().count(), None),
        _ => (0, None),
    };
    let evidence = computed.evidence.as_ref().and_then(|evidence| evidence.as_ref().ok());
    let SourceReport { file, line, origin } = source;
    MotionEntry {
        isn: motion.origin.place_in_program().0,
        file,
        line,
        origin,
        statement: statement_text(
            motion.origin.source.as_ref().map_or(tree, |source| &source.tree),
            motion.origin.isn,
        ),
        cut_vectors,
        minimum,
        part: evidence.and_then(|evidence| evidence.part).map(clean_extent),
        drive: evidence.and_then(|evidence| evidence.drive).map(clean_extent),
        check: evidence.and_then(|evidence| evidence.check).map(clean_extent),
        verified: evidence.is_some_and(|evidence| evidence.verified),
        seconds: computed.seconds,
    }
}

/// The statement as it was written, without comments; its continuations are joined.
fn statement_text(tree: &SyntaxTree, isn: u32) -> String {
    let index = (isn.max(1) - 1) as usize;
    if index >= tree.statement_count() {
        return String::new();
    }
    let view = tree.statement(index);
    let (parsed, source) = (view.parsed(), view.text());
    let mut text = String::new();
    let mut end = None;
    for element in &parsed.elements {
        let (from, to) = (usize::from(element.range.start()), usize::from(element.range.end()));
        let gap = end.and_then(|end| source.get(end..from)).unwrap_or("");
        match gap.bytes().all(|byte| matches!(byte, b' ' | b'\t')) {
            true => text.push_str(gap),
            false if text.ends_with([',', '/', '=']) => {}
            false => text.push(' '),
        }
        // An element may itself go on behind a continuation; its spelling has no such seam.
        let written = source.get(from..to).filter(|written| !written.contains(['\n', '$']));
        text.push_str(written.unwrap_or(&element.text));
        end = Some(to);
    }
    text
}

fn clean_extent(extent: Extent) -> Extent {
    let Extent { min, max, intol, outtol } = extent;
    Extent { min: clean(min), max: clean(max), intol: clean(intol), outtol: clean(outtol) }
}

fn totals_entry(totals: &Totals) -> TotalsEntry {
    TotalsEntry {
        points: totals.points,
        length: clean(totals.length),
        cut_length: clean(totals.cut_length),
        rapid_length: clean(totals.rapid_length),
        time_minutes: totals.time_minutes,
        bounds: totals.bounds.map(|bounds| bounds.map(|corner| corner.map(clean).into())),
    }
}

//! Answers of the analysis, out: plain data with byte offsets becomes protocol types.

use std::collections::HashMap;

use tower_lsp::ls_types::{self as lsp, Uri};

use super::{Places, Positions, TextIndex, Uris, written};
use crate::analysis::{
    Action, Completion, CompletionKind, Diagnostic, ExpandedLine, Expansion, Fold, FoldKind, Hover,
    Inclusion, Inlay, Lens, Occurrence, OriginFrame, OutlineEntry, OutlineKind, Signature, SignatureHelp,
    TextEdit,
};

/// Whether a finding, as the client has it, came with the motion.
pub(crate) fn is_of_motion(found: &lsp::Diagnostic) -> bool {
    let Some(lsp::NumberOrString::String(code)) = &found.code else { return false };
    // Sections 2 and 3 (codes 06xx and 07xx), and comments about their findings.
    ["APT06", "APT07", "APT096"].iter().any(|group| code.starts_with(group))
}

/// Tells at the top of a document how many findings are not shown.
pub(crate) fn left_out(count: usize) -> lsp::Diagnostic {
    lsp::Diagnostic {
        severity: Some(lsp::DiagnosticSeverity::INFORMATION),
        source: Some(written::SOURCE.to_owned()),
        message: format!("{count} more findings are not shown; `apt-lsp --check` lists all"),
        ..lsp::Diagnostic::default()
    }
}

/// The places that belong to a finding.
pub(super) fn related_information(
    places: &mut Places<'_>,
    found: &Diagnostic,
) -> Option<Vec<lsp::DiagnosticRelatedInformation>> {
    let mut all = Vec::new();
    let mut add = |source, range, message: String| {
        let location = places.location(source, range);
        all.extend(location.map(|location| lsp::DiagnosticRelatedInformation { location, message }));
    };
    for one in &found.elsewhere {
        add(Some(&one.source), &one.range, one.message.clone());
    }
    for related in &found.related {
        add(None, &related.range, related.message.clone());
    }
    for frame in &found.origin {
        if let Some(range) = &frame.range {
            add(None, range, frame_text(frame));
        }
    }
    (!all.is_empty()).then_some(all)
}

/// A macro call, loop turn or include in words.
pub(crate) fn frame_text(frame: &OriginFrame) -> String {
    let OriginFrame { kind, name, isn, turn, .. } = frame;
    let name = if name.is_empty() { String::new() } else { format!(" {name}") };
    match *kind {
        "loop" => format!("in turn {turn} of the loop{name} at statement {isn}"),
        "include" => format!("in the file{name} included at statement {isn}"),
        _ if *turn > 1 => format!("in turn {turn} of the macro{name} called at statement {isn}"),
        _ => format!("in the macro{name} called at statement {isn}"),
    }
}

/// An explanation.
pub(crate) fn hover(index: &TextIndex, found: Hover) -> lsp::Hover {
    lsp::Hover {
        range: Some(index.range(&found.range)),
        contents: lsp::HoverContents::Markup(markdown(found.markdown)),
    }
}

fn markdown(value: String) -> lsp::MarkupContent {
    lsp::MarkupContent { kind: lsp::MarkupKind::Markdown, value }
}

/// The forms at a place. Parameters are told as places in the form where the client can read that.
pub(crate) fn signature_help(found: SignatureHelp, offsets: bool) -> lsp::SignatureHelp {
    // Forms are ASCII, so that bytes are characters in every encoding.
    let number = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
    let parameter = |label: &str, range: std::ops::Range<usize>| lsp::ParameterInformation {
        label: if offsets {
            lsp::ParameterLabel::LabelOffsets([number(range.start), number(range.end)])
        } else {
            lsp::ParameterLabel::Simple(label.get(range).unwrap_or("").to_owned())
        },
        documentation: None,
    };
    let active = found.parameter.map(number);
    let signature = |one: Signature| lsp::SignatureInformation {
        parameters: Some(one.parameters.iter().map(|range| parameter(&one.label, range.clone())).collect()),
        documentation: Some(lsp::Documentation::MarkupContent(markdown(one.documentation))),
        label: one.label,
        active_parameter: None,
    };
    lsp::SignatureHelp {
        signatures: found.signatures.into_iter().map(signature).collect(),
        active_signature: Some(number(found.active)),
        active_parameter: active,
    }
}

/// Completions, in the order in which the analysis gives them, with places to fill in for a client that knows snippets.
pub(crate) fn completions(items: Vec<Completion>, snippets: bool) -> Vec<lsp::CompletionItem> {
    let filled = |text: String| (!text.is_empty()).then_some(text);
    let convert = |(nth, item): (usize, Completion)| lsp::CompletionItem {
        label: item.label,
        kind: Some(completion_kind(item.kind)),
        detail: filled(item.detail),
        documentation: filled(item.documentation)
            .map(|text| lsp::Documentation::MarkupContent(markdown(text))),
        sort_text: Some(format!("{nth:05}")),
        insert_text_format: item
            .snippet
            .as_ref()
            .filter(|_| snippets)
            .map(|_| lsp::InsertTextFormat::SNIPPET),
        insert_text: item.snippet.filter(|_| snippets),
        ..lsp::CompletionItem::default()
    };
    items.into_iter().enumerate().map(convert).collect()
}

fn completion_kind(kind: CompletionKind) -> lsp::CompletionItemKind {
    match kind {
        CompletionKind::Name => lsp::CompletionItemKind::VARIABLE,
        CompletionKind::Scalar => lsp::CompletionItemKind::VALUE,
        CompletionKind::Macro => lsp::CompletionItemKind::MODULE,
        CompletionKind::Modifier => lsp::CompletionItemKind::ENUM_MEMBER,
        CompletionKind::Type => lsp::CompletionItemKind::CLASS,
        CompletionKind::Function => lsp::CompletionItemKind::FUNCTION,
        CompletionKind::Statement => lsp::CompletionItemKind::KEYWORD,
        CompletionKind::Postprocessor => lsp::CompletionItemKind::EVENT,
    }
}

/// Changes of files, for a client that does not ask which version of each they are meant for.
pub(crate) fn plain_edit(changes: HashMap<Uri, Vec<lsp::TextEdit>>) -> lsp::WorkspaceEdit {
    lsp::WorkspaceEdit { changes: Some(changes), ..lsp::WorkspaceEdit::default() }
}

/// Changes of files with the version of each that they are meant for; a file that is not open has none.
pub(crate) fn versioned_edit(
    changes: impl IntoIterator<Item = (Uri, Option<i32>, Vec<lsp::TextEdit>)>,
) -> lsp::WorkspaceEdit {
    let of_file = |(uri, version, edits): (Uri, Option<i32>, Vec<lsp::TextEdit>)| lsp::TextDocumentEdit {
        text_document: lsp::OptionalVersionedTextDocumentIdentifier { uri, version },
        edits: edits.into_iter().map(lsp::OneOf::Left).collect(),
    };
    lsp::WorkspaceEdit {
        document_changes: Some(lsp::DocumentChanges::Edits(changes.into_iter().map(of_file).collect())),
        ..lsp::WorkspaceEdit::default()
    }
}

/// Something that can be done. `version` is that of the text, for a client that checks it before it applies edits.
pub(crate) fn action(index: &TextIndex, uri: &Uri, version: Option<i32>, found: Action) -> lsp::CodeAction {
    let edits: Vec<lsp::TextEdit> = found.edits.into_iter().map(|one| edit(index, one)).collect();
    let change = match version {
        Some(version) => versioned_edit([(uri.clone(), Some(version), edits)]),
        None => plain_edit(std::iter::once((uri.clone(), edits)).collect()),
    };
    lsp::CodeAction {
        title: found.title,
        kind: Some(lsp::CodeActionKind::new(found.kind.name())),
        diagnostics: found.settles.and_then(|finding| as_shown(index, uri, &finding)),
        edit: Some(change),
        is_preferred: found.preferred.then_some(true),
        ..lsp::CodeAction::default()
    }
}

/// A finding as the client has it. What has been written as one can be read as one.
fn as_shown(index: &TextIndex, uri: &Uri, found: &Diagnostic) -> Option<Vec<lsp::Diagnostic>> {
    let (mut out, uris) = (Vec::new(), Uris::default());
    written::diagnostic(&mut out, &mut Positions::of(index), &mut Places::new(uri, index, &uris), found);
    Some(vec![serde_json::from_slice(&out).ok()?])
}

/// The links to the files that a document includes; names of files that are not there are no links.
pub(crate) fn links(index: &TextIndex, uris: &Uris, found: Vec<Inclusion>) -> Vec<lsp::DocumentLink> {
    let link = |one: Inclusion| {
        let path = one.path?;
        Some(lsp::DocumentLink {
            range: index.range(&one.range),
            target: Some(uris.of(&path)?),
            tooltip: Some(path.display().to_string()),
            data: None,
        })
    };
    found.into_iter().filter_map(link).collect()
}

/// Values behind statements.
pub(crate) fn inlays(index: &TextIndex, found: Vec<Inlay>) -> Vec<lsp::InlayHint> {
    let convert = |one: Inlay| lsp::InlayHint {
        position: index.range(&(one.offset..one.offset)).start,
        label: lsp::InlayHintLabel::String(one.text),
        kind: None,
        text_edits: None,
        tooltip: Some(lsp::InlayHintTooltip::MarkupContent(markdown(one.tooltip))),
        padding_left: Some(true),
        padding_right: None,
        data: None,
    };
    found.into_iter().map(convert).collect()
}

/// What can be selected around a place; nothing around it selects nothing there.
pub(crate) fn selection(
    index: &TextIndex,
    offset: usize,
    found: &[std::ops::Range<usize>],
) -> lsp::SelectionRange {
    let around = |parent: Option<Box<lsp::SelectionRange>>, range: &std::ops::Range<usize>| {
        Some(Box::new(lsp::SelectionRange { range: index.range(range), parent }))
    };
    let nothing = || lsp::SelectionRange { range: index.range(&(offset..offset)), parent: None };
    found.iter().rev().fold(None, around).map_or_else(nothing, |least| *least)
}

/// The entries of an outline, at any depth, whose names contain a text in any letters.
pub(crate) fn symbols_named(
    index: &TextIndex,
    uri: &Uri,
    found: Vec<OutlineEntry>,
    wanted: &str,
) -> Vec<lsp::SymbolInformation> {
    let wanted = wanted.to_ascii_uppercase();
    let mut all = flat_symbols(index, uri, found);
    all.retain(|one| one.name.to_ascii_uppercase().contains(&wanted));
    all
}

/// An edit.
pub(crate) fn edit(index: &TextIndex, edit: TextEdit) -> lsp::TextEdit {
    lsp::TextEdit { range: index.range(&edit.range), new_text: edit.text }
}

/// A place of a name.
pub(crate) fn highlight(index: &TextIndex, found: &Occurrence) -> lsp::DocumentHighlight {
    let kind =
        if found.defines { lsp::DocumentHighlightKind::WRITE } else { lsp::DocumentHighlightKind::READ };
    lsp::DocumentHighlight { range: index.range(&found.range), kind: Some(kind) }
}

/// What an entry of the outline is to editors.
pub(super) fn symbol_kind(kind: OutlineKind) -> lsp::SymbolKind {
    match kind {
        OutlineKind::Part => lsp::SymbolKind::MODULE,
        OutlineKind::Macro => lsp::SymbolKind::FUNCTION,
        OutlineKind::Loop | OutlineKind::Branch => lsp::SymbolKind::NAMESPACE,
        OutlineKind::Geometry => lsp::SymbolKind::OBJECT,
        OutlineKind::Array => lsp::SymbolKind::ARRAY,
        OutlineKind::Scalar => lsp::SymbolKind::NUMBER,
        OutlineKind::Tool => lsp::SymbolKind::EVENT,
    }
}

/// The outline for a client that knows no nesting.
pub(crate) fn flat_symbols(
    index: &TextIndex,
    uri: &Uri,
    found: Vec<OutlineEntry>,
) -> Vec<lsp::SymbolInformation> {
    let mut flat = Vec::new();
    let mut rest: Vec<(Option<String>, OutlineEntry)> =
        found.into_iter().rev().map(|symbol| (None, symbol)).collect();
    while let Some((container_name, symbol)) = rest.pop() {
        let inside = symbol.children.into_iter().rev().map(|child| (Some(symbol.name.clone()), child));
        rest.extend(inside);
        #[expect(deprecated, reason = "the field has no default")]
        flat.push(lsp::SymbolInformation {
            name: symbol.name,
            kind: symbol_kind(symbol.kind),
            tags: None,
            deprecated: None,
            location: lsp::Location { uri: uri.clone(), range: index.range(&symbol.range) },
            container_name,
        });
    }
    flat
}

/// A fold; nothing if it lies on one line.
pub(crate) fn fold(index: &TextIndex, found: &Fold) -> Option<lsp::FoldingRange> {
    let range = index.range(&found.range);
    // A fold that ends at the beginning of a line ends with the line before it.
    let end_line = if range.end.character == 0 { range.end.line.checked_sub(1)? } else { range.end.line };
    let kind = match found.kind {
        FoldKind::Region | FoldKind::Statement => lsp::FoldingRangeKind::Region,
        FoldKind::Comment => lsp::FoldingRangeKind::Comment,
    };
    (end_line > range.start.line).then_some(lsp::FoldingRange {
        start_line: range.start.line,
        end_line,
        start_character: None,
        end_character: None,
        kind: Some(kind),
        collapsed_text: None,
    })
}

/// A lens that runs its part of the program.
pub(crate) fn lens(index: &TextIndex, uri: &Uri, found: Lens) -> lsp::CodeLens {
    let mut argument = serde_json::json!({ "uri": uri.as_str() });
    if let (Some(run), Some(fields)) = (&found.run, argument.as_object_mut()) {
        fields.insert("range".to_owned(), serde_json::json!(index.range(run)));
    }
    lsp::CodeLens {
        range: index.range(&found.range),
        command: Some(lsp::Command {
            title: found.title,
            command: "apt.runMotion".to_owned(),
            arguments: Some(vec![argument]),
        }),
        data: None,
    }
}

/// An expansion as the commands answer it.
pub(crate) fn expansion(index: &TextIndex, found: &Expansion) -> serde_json::Value {
    let origin = |line: &ExpandedLine| {
        serde_json::json!({
            "line": line.line,
            "isn": line.isn,
            "range": index.range(&line.range),
            "stack": line.stack,
        })
    };
    let origins: Vec<_> = found.origins.iter().map(origin).collect();
    serde_json::json!({ "text": found.text, "origins": origins })
}

#[cfg(test)]
mod tests {
    use ropey::Rope;

    use super::super::Encoding;
    use super::*;

    #[test]
    fn folds_end_before_the_line_that_only_begins() {
        let index = TextIndex { rope: Rope::from_str("a\nb\nc\n"), encoding: Encoding::Utf16 };
        let lines = |range| {
            let fold = fold(&index, &Fold { range, kind: FoldKind::Region })?;
            Some((fold.start_line, fold.end_line))
        };
        assert_eq!(lines(0..6), Some((0, 2)));
        assert_eq!(lines(0..5), Some((0, 2)));
        assert_eq!(lines(0..2), None);
        assert_eq!(lines(0..1), None);
    }

    #[test]
    fn flat_symbols_keep_order_and_container() {
        let symbol = |name: &str, children| OutlineEntry {
            name: name.to_owned(),
            detail: String::new(),
            kind: OutlineKind::Macro,
            range: 0..1,
            focus: 0..1,
            children,
        };
        let tree = vec![
            symbol("A", vec![symbol("B", Vec::new()), symbol("C", Vec::new())]),
            symbol("D", Vec::new()),
        ];
        let index = TextIndex { rope: Rope::from_str("a"), encoding: Encoding::Utf16 };
        let flat = flat_symbols(&index, &"file:///a.apt".parse().unwrap(), tree);
        let names: Vec<_> = flat.iter().map(|s| (s.name.as_str(), s.container_name.as_deref())).collect();
        assert_eq!(names, [("A", None), ("B", Some("A")), ("C", Some("A")), ("D", None)]);
    }

    #[test]
    fn frames_are_told_in_words() {
        let frame =
            |kind, name: &str, turn| OriginFrame { kind, name: name.into(), isn: 7, turn, range: None };
        assert_eq!(frame_text(&frame("loop", "", 3)), "in turn 3 of the loop at statement 7");
        assert_eq!(frame_text(&frame("macro", "M1", 1)), "in the macro M1 called at statement 7");
        assert_eq!(frame_text(&frame("macro", "M1", 3)), "in turn 3 of the macro M1 called at statement 7");
    }
}

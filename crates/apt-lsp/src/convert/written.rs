//! Findings and symbols, out as JSON text: there are thousands of them in an answer, and each as a value of the protocol
//! that is written afterwards costs ten times as much.

use serde::Serialize;
use tower_lsp::ls_types as lsp;

use super::outgoing::{related_information, symbol_kind};
use super::{Places, Positions, TextIndex};
use crate::analysis::{Answer, Diagnostic, OutlineEntry, Pace, Severity};

/// Who found it, as editors show it.
pub(crate) const SOURCE: &str = "apt";

/// Writes a finding. Hints become part of the message, since the protocol has no place for them; origins
/// and related places become related information.
pub(crate) fn diagnostic(
    out: &mut Vec<u8>,
    positions: &mut Positions<'_>,
    places: &mut Places<'_>,
    found: &Diagnostic,
) {
    out.extend_from_slice(b"{\"range\":");
    range(out, positions.range(&found.range));
    out.extend_from_slice(match found.severity {
        Severity::Error => b",\"severity\":1,\"code\":",
        Severity::Warning => b",\"severity\":2,\"code\":",
        Severity::Information => b",\"severity\":3,\"code\":",
        Severity::Hint => b",\"severity\":4,\"code\":",
    });
    value(out, &found.code);
    out.extend_from_slice(b",\"source\":");
    value(out, SOURCE);
    out.extend_from_slice(b",\"message\":");
    match &found.hint {
        Some(hint) => value(out, &format!("{}\nhelp: {hint}", found.message)),
        None => value(out, &found.message),
    }
    if let Some(related) = related_information(places, found) {
        out.extend_from_slice(b",\"relatedInformation\":");
        value(out, &related);
    }
    if found.unnecessary {
        out.extend_from_slice(b",\"tags\":");
        value(out, &[lsp::DiagnosticTag::UNNECESSARY]);
    }
    out.extend_from_slice(b",\"data\":{\"isn\":");
    value(out, &found.isn);
    out.extend_from_slice(b",\"apt3\":");
    value(out, &found.apt3);
    out.extend_from_slice(b",\"hint\":");
    value(out, &found.hint);
    out.extend_from_slice(b"}}");
}

/// What a symbol usually takes in an answer (bytes).
const USUAL_LENGTH: usize = 256;

/// Writes the entries of an outline with everything inside them, as a list.
///
/// # Errors
///
/// [`crate::analysis::Interrupted`] when nobody wants them any more.
pub(crate) fn symbols(
    out: &mut Vec<u8>,
    index: &TextIndex,
    outline: &[OutlineEntry],
    pace: &Pace<'_>,
) -> Answer<()> {
    out.reserve(outline.len() * USUAL_LENGTH);
    list_of_symbols(out, &mut Positions::of(index), outline, pace)
}

fn list_of_symbols(
    out: &mut Vec<u8>,
    positions: &mut Positions<'_>,
    outline: &[OutlineEntry],
    pace: &Pace<'_>,
) -> Answer<()> {
    let mut done = Ok(());
    list(out, outline, |out, entry| {
        if done.is_ok() {
            done = symbol(out, positions, entry, pace);
        }
    });
    done
}

fn symbol(
    out: &mut Vec<u8>,
    positions: &mut Positions<'_>,
    entry: &OutlineEntry,
    pace: &Pace<'_>,
) -> Answer<()> {
    pace.go_on(1)?;
    out.extend_from_slice(b"{\"name\":");
    // Clients reject an empty name.
    value(out, if entry.name.trim().is_empty() { "(no name)" } else { &entry.name });
    if !entry.detail.is_empty() {
        out.extend_from_slice(b",\"detail\":");
        value(out, &entry.detail);
    }
    out.extend_from_slice(b",\"kind\":");
    value(out, &symbol_kind(entry.kind));
    out.extend_from_slice(b",\"range\":");
    range(out, positions.range(&entry.range));
    out.extend_from_slice(b",\"selectionRange\":");
    range(out, positions.range(&entry.focus));
    if !entry.children.is_empty() {
        out.extend_from_slice(b",\"children\":");
        list_of_symbols(out, positions, &entry.children, pace)?;
    }
    out.push(b'}');
    Ok(())
}

/// Writes a list of things.
pub(crate) fn list<T>(
    out: &mut Vec<u8>,
    things: impl IntoIterator<Item = T>,
    mut write: impl FnMut(&mut Vec<u8>, T),
) {
    out.push(b'[');
    for (number, thing) in things.into_iter().enumerate() {
        if number > 0 {
            out.push(b',');
        }
        write(out, thing);
    }
    out.push(b']');
}

fn range(out: &mut Vec<u8>, range: lsp::Range) {
    for (before, position) in
        [(&b"{\"start\":{\"line\":"[..], range.start), (b"},\"end\":{\"line\":", range.end)]
    {
        out.extend_from_slice(before);
        value(out, &position.line);
        out.extend_from_slice(b",\"character\":");
        value(out, &position.character);
    }
    out.extend_from_slice(b"}}");
}

/// Writes a value of the protocol.
pub(crate) fn value(out: &mut Vec<u8>, value: &(impl Serialize + ?Sized)) {
    // Memory takes all bytes, and the values of the protocol have no keys but texts.
    let _ = serde_json::to_writer(out, value);
}

#[cfg(test)]
mod tests {
    use ropey::Rope;
    use serde_json::{Value, json};

    use super::super::{Encoding, Uris};
    use super::*;
    use crate::analysis::{Control, OriginFrame, OutlineKind, Related};

    fn index(text: &str) -> TextIndex {
        TextIndex { rope: Rope::from_str(text), encoding: Encoding::Utf16 }
    }

    fn written(found: &Diagnostic) -> Value {
        let index = index("P1=POINT/0,0\nP\"1\n");
        let uri = "file:///a.apt".parse().unwrap();
        let uris = Uris::default();
        let mut out = Vec::new();
        diagnostic(&mut out, &mut Positions::of(&index), &mut Places::new(&uri, &index, &uris), found);
        let protocol: lsp::Diagnostic = serde_json::from_slice(&out).unwrap();
        let value = serde_json::from_slice(&out).unwrap();
        assert_eq!(serde_json::to_value(protocol).unwrap(), value, "written as the protocol has it");
        value
    }

    #[test]
    fn findings_are_what_the_protocol_says() {
        let mut found = Diagnostic {
            code: "APT0101".to_owned(),
            severity: Severity::Error,
            message: "P\"1 is \\ not\tdefined".to_owned(),
            hint: None,
            isn: Some(2),
            apt3: None,
            range: 13..16,
            origin: Vec::new(),
            related: Vec::new(),
            elsewhere: Vec::new(),
            unnecessary: false,
            fixes: Vec::new(),
        };
        let place = |line, from, to| json!({ "start": { "line": line, "character": from }, "end": { "line": line, "character": to } });
        let plain = json!({
            "range": place(1, 0, 3), "severity": 1, "code": "APT0101", "source": "apt",
            "message": "P\"1 is \\ not\tdefined", "data": { "isn": 2, "apt3": null, "hint": null },
        });
        assert_eq!(written(&found), plain);
        found.severity = Severity::Hint;
        found.hint = Some("did you mean P1?".to_owned());
        found.unnecessary = true;
        found.apt3 = Some(7);
        found.related = vec![Related { message: "here".to_owned(), range: 0..2 }];
        let frame = OriginFrame { kind: "macro", name: "M".to_owned(), isn: 1, turn: 1, range: Some(0..12) };
        found.origin = vec![frame];
        let told = |range, message: &str| json!({ "location": { "uri": "file:///a.apt", "range": range }, "message": message });
        let full = json!({
            "range": place(1, 0, 3), "severity": 4, "code": "APT0101", "source": "apt",
            "message": "P\"1 is \\ not\tdefined\nhelp: did you mean P1?",
            "relatedInformation": [
                told(place(0, 0, 2), "here"),
                told(place(0, 0, 12), "in the macro M called at statement 1"),
            ],
            "tags": [1],
            "data": { "isn": 2, "apt3": 7, "hint": "did you mean P1?" },
        });
        assert_eq!(written(&found), full);
    }

    #[test]
    fn symbols_are_what_the_protocol_says() {
        let entry = |name: &str, detail: &str, range: std::ops::Range<usize>, children| OutlineEntry {
            name: name.to_owned(),
            detail: detail.to_owned(),
            kind: OutlineKind::Macro,
            focus: range.start..range.start + 1,
            range,
            children,
        };
        let inner = vec![entry("A\"", "", 5..8, Vec::new()), entry(" ", "POINT", 9..11, Vec::new())];
        let outline = [entry("M", "MACRO", 0..12, inner), entry("B", "", 14..15, Vec::new())];
        let mut out = Vec::new();
        symbols(&mut out, &index("M=MA\nA=1\nB=\nT\nX"), &outline, &Control::unlimited().pace()).unwrap();
        let symbols: Vec<lsp::DocumentSymbol> = serde_json::from_slice(&out).unwrap();
        let value: Value = serde_json::from_slice(&out).unwrap();
        assert_eq!(serde_json::to_value(&symbols).unwrap(), value, "written as the protocol has it");
        let place = |from: (u32, u32), to: (u32, u32)| lsp::Range {
            start: lsp::Position { line: from.0, character: from.1 },
            end: lsp::Position { line: to.0, character: to.1 },
        };
        assert_eq!(symbols[0].range, place((0, 0), (3, 0)));
        assert_eq!(symbols[0].selection_range, place((0, 0), (0, 1)));
        assert_eq!(symbols[0].detail.as_deref(), Some("MACRO"));
        assert_eq!(symbols[0].kind, lsp::SymbolKind::FUNCTION);
        let inner = symbols[0].children.as_ref().unwrap();
        assert_eq!((inner[0].name.as_str(), inner[0].range), ("A\"", place((1, 0), (1, 3))));
        assert_eq!((inner[1].name.as_str(), inner[1].detail.as_deref()), ("(no name)", Some("POINT")));
        assert_eq!((symbols[1].range, &symbols[1].children), (place((4, 0), (4, 1)), &None));
        let mut nothing = Vec::new();
        super::symbols(&mut nothing, &index(""), &[], &Control::unlimited().pace()).unwrap();
        assert_eq!(nothing, b"[]");
    }
}

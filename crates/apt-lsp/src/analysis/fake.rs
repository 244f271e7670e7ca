//! A toy language for the tests of the server: it can be slow, it can fail, and it says which text it saw.
//!
//! `BAD` is an error wherever it stands; `SLOW` makes motion and runs last until cancelled; `PANIC` panics.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use super::*;

/// The toy language, with what its documents have done.
#[derive(Default, Clone)]
pub(crate) struct FakeLanguage {
    /// Steps taken by slow work.
    pub steps: Arc<AtomicU64>,
    /// Slow works under way.
    pub running: Arc<AtomicU64>,
}

struct FakeDocument {
    text: String,
    language: FakeLanguage,
}

/// Slow work that nobody cancels ends here, so that a broken test ends too.
pub(crate) const SLOW_STEPS: u64 = 20_000;

impl Language for FakeLanguage {
    fn open(&self, text: &str, _: Option<&str>, _: &Values, _: Surroundings) -> Arc<dyn Document> {
        Arc::new(FakeDocument { text: text.to_owned(), language: self.clone() })
    }

    fn check_settings(&self, settings: &Values) -> Result<(), String> {
        match settings.keys().find(|key| *key != "dialect") {
            Some(key) => Err(format!("unknown setting `{key}`")),
            None => Ok(()),
        }
    }

    fn machines(&self) -> Vec<MachineInfo> {
        vec![MachineInfo { name: "toy".into(), title: "A toy".into(), control: "none".into() }]
    }

    fn machine_definition(&self, name: &str) -> Result<String, Refusal> {
        Engine.machine_definition(name)
    }

    fn has_machine(&self, name: &str) -> bool {
        self.machines().iter().any(|machine| machine.name == name)
    }

    fn text_of_binary(&self, _: &[u8]) -> Option<Result<TextOfBinary, String>> {
        None
    }

    fn difference(
        &self,
        paths: [&ToolPath; 2],
        allowance: Allowance,
        control: &Control,
    ) -> Result<PathDifference, Refusal> {
        Engine.difference(paths, allowance, control)
    }

    fn explain(&self, code: &str) -> Option<String> {
        (code == "APT0001").then(|| "# APT0001\n\nThe word BAD stands in the program.\n".to_owned())
    }

    fn title(&self, code: &str) -> Option<String> {
        (code == "APT0001").then(|| "the word BAD".to_owned())
    }
}

impl FakeDocument {
    fn word_at(&self, offset: usize) -> Option<Range<usize>> {
        let is_word = |character: char| character.is_alphanumeric();
        let start = self.text[..offset]
            .rfind(|c| !is_word(c))
            .map_or(0, |at| at + self.text[at..].chars().next().map_or(1, char::len_utf8));
        let end = self.text[offset..].find(|c| !is_word(c)).map_or(self.text.len(), |at| offset + at);
        (start < end).then_some(start..end)
    }

    fn places(&self, word: &str) -> Vec<Range<usize>> {
        self.text.match_indices(word).map(|(at, found)| at..at + found.len()).collect()
    }

    fn slow(&self, control: &Control) -> Answer<()> {
        assert!(!self.text.contains("PANIC"), "the toy language was asked to panic");
        if !self.text.contains("SLOW") {
            return Ok(());
        }
        self.language.running.fetch_add(1, Ordering::SeqCst);
        let mut outcome = Ok(());
        for done in 0..SLOW_STEPS {
            if control.is_cancelled() {
                outcome = Err(Interrupted);
                break;
            }
            control.report(Progress { done, total: Some(SLOW_STEPS), message: "working".into() });
            self.language.steps.fetch_add(1, Ordering::SeqCst);
            std::thread::sleep(Duration::from_millis(1));
        }
        self.language.running.fetch_sub(1, Ordering::SeqCst);
        outcome
    }
}

impl Document for FakeDocument {
    fn edit(&self, edits: &[TextEdit]) -> Arc<dyn Document> {
        let mut text = self.text.clone();
        for edit in edits {
            text.replace_range(edit.range.clone(), &edit.text);
        }
        Arc::new(Self { text, language: self.language.clone() })
    }

    fn dialect(&self) -> String {
        "toy".into()
    }

    fn holdings(&self) -> Holdings {
        Holdings { bytes: self.text.len(), statements: self.text.lines().count(), ..Holdings::default() }
    }

    fn diagnostics(&self, level: Level, control: &Control) -> Answer<Vec<Diagnostic>> {
        if level == Level::Motion {
            self.slow(control)?;
        }
        let finding = |range: Range<usize>| Diagnostic {
            code: "APT0001".into(),
            severity: Severity::Error,
            message: "BAD stands here".into(),
            hint: Some("remove it".into()),
            isn: Some(1),
            apt3: None,
            related: vec![Related { message: "the program begins here".into(), range: 0..0 }],
            elsewhere: Vec::new(),
            range,
            origin: Vec::new(),
            unnecessary: false,
            fixes: Vec::new(),
        };
        Ok(self.places("BAD").into_iter().map(finding).collect())
    }

    fn inlays(&self, _: Option<&Path>, range: Range<usize>, _: &Control) -> Answer<Vec<Inlay>> {
        let inlay =
            |place: Range<usize>| Inlay { offset: place.end, text: "= 1".into(), tooltip: "toy".into() };
        Ok(self.places("BAD").into_iter().filter(|place| range.contains(&place.start)).map(inlay).collect())
    }

    fn selections(&self, offset: usize) -> Vec<Range<usize>> {
        self.word_at(offset).into_iter().chain(std::iter::once(0..self.text.len())).collect()
    }

    fn hover(&self, spot: Spot<'_>, control: &Control) -> Answer<Option<Hover>> {
        let offset = spot.offset;
        if self.text.contains("SLOWHOVER") {
            self.slow(control)?;
        }
        assert!(!self.text.contains("PANIC"), "the toy language was asked to panic");
        let Some(range) = self.word_at(offset) else { return Ok(None) };
        let markdown = format!("{} of {} bytes", &self.text[range.clone()], self.text.len());
        Ok(Some(Hover { range, markdown }))
    }

    fn completions(&self, _: usize, _: &Control) -> Answer<Vec<Completion>> {
        Ok(vec![Completion {
            label: "GOLFT".into(),
            kind: CompletionKind::Statement,
            detail: "go left".into(),
            documentation: String::new(),
            snippet: Some("GOLFT/${1:ds}$0".into()),
        }])
    }

    fn signature_help(&self, offset: usize) -> Option<SignatureHelp> {
        let word = self.word_at(offset)?;
        let label = format!("{}/x,y", &self.text[word.clone()]);
        let parameters = vec![word.len() + 1..word.len() + 2, word.len() + 3..word.len() + 4];
        let signature = Signature { label, parameters, documentation: "toy".into() };
        Some(SignatureHelp { signatures: vec![signature], active: 0, parameter: Some(1) })
    }

    fn definitions(&self, spot: Spot<'_>, control: &Control) -> Answer<Vec<Located>> {
        Ok(self.references(spot, control)?.into_iter().take(1).collect())
    }

    fn references(&self, spot: Spot<'_>, control: &Control) -> Answer<Vec<Located>> {
        let located = |occurrence| Located { source: None, occurrence };
        Ok(self.occurrences(spot.offset, control)?.into_iter().map(located).collect())
    }

    fn with_changed_files(&self) -> Arc<dyn Document> {
        Arc::new(Self { text: self.text.clone(), language: self.language.clone() })
    }

    fn has_inclusions(&self) -> bool {
        false
    }

    fn included_paths(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn inclusions(&self) -> Vec<Inclusion> {
        let named = |range: Range<usize>| Inclusion {
            name: "BAD".into(),
            range,
            path: Some(PathBuf::from("/nowhere/bad.apt")),
        };
        self.places("BAD").into_iter().map(named).collect()
    }

    fn diagnostics_in(&self, _: &Path, level: Level, control: &Control) -> Answer<Vec<Diagnostic>> {
        self.diagnostics(level, control)
    }

    fn occurrences(&self, offset: usize, _: &Control) -> Answer<Vec<Occurrence>> {
        let Some(range) = self.word_at(offset) else { return Ok(Vec::new()) };
        let places = self.places(&self.text[range]).into_iter().enumerate();
        Ok(places.map(|(nth, range)| Occurrence { range, defines: nth == 0 }).collect())
    }

    fn renamable(&self, spot: Spot<'_>) -> Option<Range<usize>> {
        self.word_at(spot.offset)
    }

    fn rename(
        &self,
        spot: Spot<'_>,
        new: &str,
        control: &Control,
    ) -> Result<Vec<(Located, String)>, Refusal> {
        if new.is_empty() {
            return Err(Refusal::Impossible("a name has letters".into()));
        }
        Ok(self.references(spot, control)?.into_iter().map(|one| (one, new.to_owned())).collect())
    }

    fn machine_of_program(&self, _: &Control) -> Answer<Option<String>> {
        Ok(None)
    }

    fn routine(&self, _: Spot<'_>, _: &Control) -> Answer<Option<Routine>> {
        Ok(None)
    }

    fn callers(&self, _: &str, _: &Control) -> Answer<Vec<Calls>> {
        Ok(Vec::new())
    }

    fn callees(&self, _: Option<&str>, _: Option<&Path>, _: &Control) -> Answer<Vec<Calls>> {
        Ok(Vec::new())
    }

    fn outline(&self, _: &Control) -> Answer<Vec<OutlineEntry>> {
        Ok(vec![OutlineEntry {
            name: "PROGRAM".into(),
            detail: String::new(),
            kind: OutlineKind::Part,
            range: 0..self.text.len(),
            focus: 0..0,
            children: Vec::new(),
        }])
    }

    fn folds(&self, _: &Control) -> Answer<Vec<Fold>> {
        Ok(vec![Fold { range: 0..self.text.len(), kind: FoldKind::Region }])
    }

    fn tokens(&self, range: Option<Range<usize>>, _: &Control) -> Answer<Vec<Token>> {
        let wanted = |place: &Range<usize>| {
            range.as_ref().is_none_or(|range| place.start < range.end && place.end > range.start)
        };
        let token = |range| Token { range, class: TokenClass::Keyword, definition: false };
        Ok(self.places("BAD").into_iter().filter(wanted).map(token).collect())
    }

    fn lenses(&self, _: &Control) -> Answer<Vec<Lens>> {
        Ok(vec![Lens { range: 0..0, title: "Run motion".into(), run: None }])
    }

    fn actions(
        &self,
        range: Range<usize>,
        wanted: &[ActionKind],
        level: Level,
        control: &Control,
    ) -> Answer<Vec<Action>> {
        let found = self.diagnostics(level, control)?;
        let here =
            found.into_iter().filter(|one| one.range.start <= range.end && one.range.end >= range.start);
        let removal = |kind, finding: &Diagnostic| Action {
            title: "Remove BAD".to_owned(),
            kind,
            edits: vec![TextEdit { range: finding.range.clone(), text: String::new() }],
            preferred: true,
            settles: (kind == ActionKind::QuickFix).then(|| finding.clone()),
        };
        Ok(here
            .flat_map(|one| wanted.iter().map(move |kind| removal(*kind, &one)).collect::<Vec<_>>())
            .collect())
    }

    fn format(&self, range: Option<Range<usize>>, _: &Control) -> Answer<Formatting> {
        let wanted = |place: &Range<usize>| {
            range.as_ref().is_none_or(|range| place.start < range.end && place.end > range.start)
        };
        let loud = |range: Range<usize>| TextEdit { text: "BAD".to_owned(), range };
        let edits = self.places("bad").into_iter().filter(wanted).map(loud).collect();
        Ok(Formatting {
            edits,
            kept: self.places("odd").into_iter().map(|range| (range, "odd".to_owned())).collect(),
        })
    }

    fn statements(&self) -> Vec<Range<usize>> {
        Vec::new()
    }

    fn syntax_tree(&self, _: &Control) -> Answer<String> {
        Ok(self.text.clone())
    }

    fn expand(&self, _: Option<usize>, _: Option<u32>, _: &Control) -> Answer<Expansion> {
        let range = 0..self.text.lines().next().map_or(0, str::len);
        let origins = vec![ExpandedLine { line: 0, isn: 1, range, stack: Vec::new(), room_behind: true }];
        Ok(Expansion { text: self.text.clone(), origins })
    }

    fn canonical_form(&self, offset: usize, _: &Control) -> Answer<Option<CanonicalForm>> {
        let Some(range) = self.word_at(offset) else { return Ok(None) };
        let name = self.text[range].to_owned();
        Ok(Some(CanonicalForm {
            name,
            kind: "POINT".into(),
            canonical: vec![0.0; 3],
            meaning: ["x", "y", "z"].map(str::to_owned).to_vec(),
            text: "the origin".into(),
        }))
    }

    fn run(&self, request: &RunRequest, control: &Control) -> Result<serde_json::Value, Refusal> {
        self.slow(control)?;
        let part = request.range.clone().unwrap_or(0..self.text.len());
        Ok(serde_json::json!({ "ok": true, "ran": &self.text[part] }))
    }

    fn tape(&self, machine: &str, _: &Control) -> Result<serde_json::Value, Refusal> {
        match machine {
            "toy" => Ok(serde_json::json!({ "machine": "toy", "blocks": ["N10 M30"], "origin": [1] })),
            other => Err(Refusal::UnknownMachine { name: other.to_owned(), known: vec!["toy".into()] }),
        }
    }

    fn tape_diagnostics(
        &self,
        _: &str,
        _: Option<TapeCode>,
        control: &Control,
    ) -> Result<Vec<Diagnostic>, Refusal> {
        Ok(self.diagnostics(Level::Section1, control)?)
    }

    fn convert(&self, to: ClDialect, tape: Option<&[u8]>, control: &Control) -> Result<Conversion, Refusal> {
        let _ = (to, tape, control);
        Err(Refusal::Impossible("a fake has no cutter locations".to_owned()))
    }

    fn tool_path(&self, control: &Control) -> Answer<(ToolPath, Vec<Diagnostic>)> {
        Ok((ToolPath::default(), self.diagnostics(Level::Section1, control)?))
    }

    fn product(&self, _: &Product, _: &Control) -> Result<Vec<u8>, Refusal> {
        Ok(self.text.clone().into_bytes())
    }
}

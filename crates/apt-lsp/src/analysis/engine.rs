//! The real language: documents answered by `apt-ide`.
//!
//! Only conversions stand here: of cancellation and progress into the form that the analysis knows, and
//! of places with a statement into ranges of the text.

use std::iter::successors;
use std::ops::Range;
use std::sync::Arc;

use apt_ide::dialect::describe;
use apt_ide::{Analysis, Cancelled};
use apt_run::diagnostic as found;
use apt_run::document::DialectReason;
use apt_run::position::LineIndex;
use apt_run::report::diagnostic_report;
use apt_run::settings::Settings;
use serde::Deserialize;
use serde_json::{Value, json};

use super::*;

/// The language that `apt-ide` knows.
pub(crate) struct Engine;

struct Program(Analysis);

impl Language for Engine {
    fn open(&self, text: &str, file_name: Option<&str>, settings: &Values) -> Arc<dyn Document> {
        let settings = read_settings(settings).unwrap_or_default();
        Arc::new(Program(Analysis::new(text, file_name.map(str::to_owned), &Arc::new(settings))))
    }

    fn check_settings(&self, settings: &Values) -> Result<(), String> {
        let settings = Arc::new(read_settings(settings).map_err(|error| error.to_string())?);
        let empty = Analysis::new("", None, &settings);
        match &settings.dialect {
            Some(name) if *empty.document().dialect_reason() != DialectReason::Setting => {
                Err(format!("there is no dialect `{name}`"))
            }
            _ => Ok(()),
        }
    }

    fn machines(&self) -> Vec<MachineInfo> {
        apt_ide::tape::machines()
    }

    fn text_of_binary(&self, bytes: &[u8]) -> Option<Result<String, String>> {
        Some(apt_ide::tape::text_of_cl_tape(bytes)?.map_err(|error| error.to_string()))
    }

    fn explain(&self, code: &str) -> Option<String> {
        let page = apt_ide::explain(code)?;
        let sample =
            |title: &str, sample: &str| format!("\n{title}:\n\n```apt\n{}\n```\n", sample.trim_end());
        let mut text = format!("# {}: {}\n\n{}\n", page.code, page.title, page.text.trim());
        text.push_str(&sample("Wrong", &page.wrong));
        text.push_str(&sample("Right", &page.right));
        Some(text)
    }

    fn title(&self, code: &str) -> Option<String> {
        apt_ide::explain(code).map(|page| page.title.clone())
    }
}

fn read_settings(values: &Values) -> Result<Settings, serde_json::Error> {
    Settings::deserialize(&Value::Object(values.clone()))
}

impl From<Cancelled> for Interrupted {
    fn from(_: Cancelled) -> Self {
        Self
    }
}

impl From<Cancelled> for Refusal {
    fn from(_: Cancelled) -> Self {
        Self::Interrupted
    }
}

/// Lets the analysis ask whether to stop, and tell how far it is.
fn with<T>(
    control: &Control,
    message: &str,
    work: impl FnOnce(apt_run::Cancel<'_>, &mut dyn FnMut(usize, usize)) -> T,
) -> T {
    let cancel = || control.is_cancelled();
    let mut report = |done: usize, total: usize| {
        control.report(Progress {
            done: done as u64,
            total: Some(total as u64),
            message: message.to_owned(),
        });
    };
    work(&cancel, &mut report)
}

/// The frames of an origin with their places, both innermost first.
fn frames(steps: Vec<found::OriginStep>, places: Vec<Range<usize>>) -> Vec<OriginFrame> {
    let frame = |(step, place): (found::OriginStep, Range<usize>)| OriginFrame {
        kind: step.kind,
        name: step.name,
        isn: step.isn,
        turn: step.turn,
        range: Some(place),
    };
    steps.into_iter().zip(places).map(frame).collect()
}

impl Program {
    fn control_tape(&self, machine: &str, control: &Control) -> Result<apt_ide::tape::ControlTape, Refusal> {
        with(control, "making the tape", |cancel, progress| self.0.tape(machine, cancel, progress))
            .map_err(tape_refusal)
    }

    fn diagnostic(&self, one: &found::Diagnostic) -> Diagnostic {
        let tree = self.0.document().tree();
        let place = |isn, range| found::statement_range(tree, isn, range);
        let around = successors(one.origin.frame.as_deref(), |frame| frame.parent.as_deref());
        let places = around.map(|frame| place(frame.isn, frame.range)).collect();
        let related = one.related.iter().map(|(message, origin)| Related {
            message: message.clone(),
            range: place(origin.isn, origin.range),
        });
        Diagnostic {
            code: one.wording.code.to_owned(),
            severity: one.severity,
            message: one.wording.message.clone(),
            hint: one.wording.hint.clone(),
            isn: Some(one.origin.isn),
            apt3: one.wording.apt3,
            range: found::absolute_range(tree, &one.origin),
            origin: frames(found::origin_steps(&one.origin), places),
            related: related.collect(),
            unnecessary: one.unnecessary,
        }
    }
}

impl Document for Program {
    fn edit(&self, edits: &[TextEdit]) -> Arc<dyn Document> {
        let mut analysis = self.0.clone();
        for edit in edits {
            analysis = analysis.edit(edit.range.clone(), &edit.text);
        }
        Arc::new(Self(analysis))
    }

    fn dialect(&self) -> String {
        describe(self.0.document())
    }

    fn diagnostics(&self, level: Level, control: &Control) -> Answer<Vec<Diagnostic>> {
        let all = with(control, "checking", |cancel, progress| self.0.diagnostics(level, cancel, progress))?;
        Ok(all.iter().map(|one| self.diagnostic(one)).collect())
    }

    fn worst_diagnostics(&self, level: Level, most: usize, control: &Control) -> Answer<Worst> {
        let all = with(control, "checking", |cancel, progress| self.0.diagnostics(level, cancel, progress))?;
        let mut chosen: Vec<usize> = (0..all.len()).collect();
        if all.len() > most {
            chosen.sort_by_key(|&index| (std::cmp::Reverse(all[index].severity), index));
            chosen.truncate(most);
            chosen.sort_unstable();
        }
        let diagnostics: Vec<_> = chosen.into_iter().map(|index| self.diagnostic(&all[index])).collect();
        Ok(Worst { left_out: all.len() - diagnostics.len(), diagnostics })
    }

    fn hover(&self, offset: usize, control: &Control) -> Answer<Option<Hover>> {
        Ok(with(control, "", |cancel, _| self.0.hover(offset, cancel))?)
    }

    fn completions(&self, offset: usize) -> Vec<Completion> {
        self.0.completions(offset)
    }

    fn definitions(&self, offset: usize) -> Vec<Range<usize>> {
        self.0.definitions_at(offset)
    }

    fn occurrences(&self, offset: usize) -> Vec<Occurrence> {
        self.0.occurrences(offset)
    }

    fn renamable(&self, offset: usize) -> Option<Range<usize>> {
        self.0.name_at(offset).map(|name| name.range)
    }

    fn rename(&self, offset: usize, new: &str) -> Result<Vec<TextEdit>, Refusal> {
        let edits = self.0.rename(offset, new).map_err(|error| Refusal::Impossible(error.to_string()))?;
        Ok(edits.into_iter().map(|(range, text)| TextEdit { range, text }).collect())
    }

    fn outline(&self) -> Vec<OutlineEntry> {
        self.0.outline()
    }

    fn folds(&self) -> Vec<Fold> {
        self.0.folds()
    }

    fn tokens(&self, range: Option<Range<usize>>) -> Vec<Token> {
        self.0.tokens(range)
    }

    fn lenses(&self) -> Vec<Lens> {
        self.0.lenses()
    }

    fn syntax_tree(&self) -> String {
        self.0.syntax_tree()
    }

    fn expand(&self, at: Option<usize>, depth: Option<u32>, control: &Control) -> Answer<Expansion> {
        let expansion = with(control, "expanding", |cancel, _| self.0.expand(at, depth, cancel))?;
        let tree = self.0.document().tree();
        let place = |isn, range| found::statement_range(tree, isn, range);
        let lines = (0..).zip(&expansion.origins).map(|(line, origin)| {
            let around = successors(origin.frame.as_deref(), |frame| frame.parent.as_deref());
            let places = around.map(|frame| place(frame.isn, frame.range)).collect();
            ExpandedLine {
                line,
                isn: origin.isn,
                range: place(origin.isn, origin.range),
                stack: frames(found::origin_steps(origin), places),
            }
        });
        let origins = lines.collect();
        Ok(Expansion { text: expansion.text, origins })
    }

    fn canonical_form(&self, offset: usize, control: &Control) -> Answer<Option<CanonicalForm>> {
        Ok(with(control, "", |cancel, _| self.0.canonical_form(offset, cancel))?)
    }

    fn run(&self, request: &RunRequest, control: &Control) -> Result<Value, Refusal> {
        let report =
            with(control, "running", |cancel, progress| self.0.run(request.range.clone(), cancel, progress))?;
        let mut report = to_json(&report)?;
        let mut add = |key: &str, value: Value| {
            if let Some(fields) = report.as_object_mut() {
                fields.insert(key.to_owned(), value);
            }
        };
        if let Some(machine) = &request.machine {
            add("tape", self.tape(machine, control)?);
        }
        if request.scene {
            let scene = with(control, "drawing", |cancel, progress| self.0.scene(cancel, progress))?;
            add("scene", to_json(&scene)?);
        }
        if request.story {
            let range = request.range.clone();
            let stories = with(control, "telling", |cancel, progress| self.0.stories(range, cancel, progress))?;
            let motions = report["motions"].as_array_mut().into_iter().flatten();
            for (motion, story) in motions.zip(stories) {
                if let Some(fields) = motion.as_object_mut() {
                    fields.insert("story".to_owned(), json!(story));
                }
            }
        }
        Ok(report)
    }

    fn tape(&self, machine: &str, control: &Control) -> Result<Value, Refusal> {
        let made = self.control_tape(machine, control)?;
        let blocks: Vec<_> = made.tape.blocks.iter().map(|block| block.text.as_str()).collect();
        let origin: Vec<_> = made.tape.blocks.iter().map(|block| block.isn).collect();
        let (text, tree) = (self.0.text(), self.0.document().tree());
        let (file, lines) = (self.0.document().file().unwrap_or("-"), LineIndex::new(&text));
        let found: Vec<_> =
            made.diagnostics.iter().map(|one| diagnostic_report(one, file, &text, tree, &lines)).collect();
        Ok(json!({ "machine": machine, "blocks": blocks, "origin": origin, "diagnostics": to_json(&found)? }))
    }

    fn tape_diagnostics(&self, machine: &str, control: &Control) -> Result<Vec<Diagnostic>, Refusal> {
        let made = self.control_tape(machine, control)?;
        Ok(made.diagnostics.iter().map(|one| self.diagnostic(one)).collect())
    }

    fn product(&self, product: &Product, control: &Control) -> Result<Vec<u8>, Refusal> {
        with(control, "running", |cancel, progress| match product {
            Product::ClText => Ok(self.0.cl_text(cancel, progress)?.into_bytes()),
            Product::Cltape => self.0.cl_tape(cancel, progress).map_err(cl_tape_refusal),
            Product::Tape { machine, punch } => {
                let tape = self.0.tape(machine, cancel, progress).map_err(tape_refusal)?.tape;
                match punch {
                    None => Ok(tape.text().into_bytes()),
                    Some(code) => apt_ide::tape::punch(&tape, *code)
                        .map_err(|error| Refusal::Impossible(error.to_string())),
                }
            }
            Product::Picture(kind) => {
                let scene = self.0.scene(cancel, progress)?;
                match kind {
                    PictureKind::Html => Ok(apt_ide::picture::html(&scene).into_bytes()),
                    PictureKind::Svg => Ok(apt_ide::picture::svg(&scene).into_bytes()),
                    PictureKind::Png => {
                        apt_ide::picture::png(&scene).map_err(|error| Refusal::Impossible(error.to_string()))
                    }
                }
            }
        })
    }
}

fn to_json(value: &impl serde::Serialize) -> Result<Value, Refusal> {
    serde_json::to_value(value).map_err(|error| Refusal::Impossible(error.to_string()))
}

fn cl_tape_refusal(error: apt_ide::tape::ClTapeError) -> Refusal {
    use apt_ide::tape::ClTapeError;
    match error {
        ClTapeError::Tape(error) => Refusal::Impossible(error.to_string()),
        ClTapeError::Cancelled(_) => Refusal::Interrupted,
    }
}

fn tape_refusal(error: apt_ide::tape::TapeError) -> Refusal {
    use apt_ide::tape::TapeError;
    match error {
        TapeError::UnknownMachine { name, known } => Refusal::UnknownMachine { name, known },
        TapeError::Cancelled(_) => Refusal::Interrupted,
    }
}

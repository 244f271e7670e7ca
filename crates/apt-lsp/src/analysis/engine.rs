//! The real language: documents answered by `apt-ide`.
//!
//! Only conversions stand here: of cancellation and progress into the form that the analysis knows, and
//! of places with a statement into ranges of the text.

use std::ops::Range;
use std::sync::Arc;

use apt_ide::{Analysis, Cancelled};
use apt_run::catalogue::pages;
use apt_run::diagnostic as found;
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
        let settings = read_settings(settings).map_err(|error| error.to_string())?;
        settings.check().map_err(|error| error.to_string())
    }

    fn machines(&self) -> Vec<MachineInfo> {
        let machine = |machine: apt_ide::run::MachineInfo| MachineInfo {
            name: machine.name,
            title: machine.title,
            control: machine.control,
        };
        apt_ide::run::machines().into_iter().map(machine).collect()
    }

    fn explain(&self, code: &str) -> Option<String> {
        pages::explain(code).map(page_text)
    }

    fn title(&self, code: &str) -> Option<String> {
        pages::explain(code).map(|page| page.title.clone())
    }
}

fn read_settings(values: &Values) -> Result<Settings, serde_json::Error> {
    Settings::deserialize(&Value::Object(values.clone()))
}

fn page_text(page: &pages::Page) -> String {
    let sample = |title: &str, sample: &str| format!("\n{title}:\n\n```apt\n{}\n```\n", sample.trim_end());
    let mut text = format!("# {}: {}\n\n{}\n", page.code, page.title, page.text.trim());
    text.push_str(&sample("Wrong", &page.wrong));
    text.push_str(&sample("Right", &page.right));
    text
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
        control.report(Progress { done: done as u64, total: Some(total as u64), message: message.to_owned() });
    };
    work(&cancel, &mut report)
}

impl Program {
    fn frames(&self, origin: &apt_ide::Origin) -> Vec<OriginFrame> {
        let tree = self.0.document().tree();
        let mut frames = Vec::new();
        let mut next = origin.frame.as_deref();
        for step in found::origin_steps(origin) {
            let range = next.map(|frame| found::statement_range(tree, frame.isn, frame.range));
            frames.push(OriginFrame { kind: step.kind, name: step.name, isn: step.isn, turn: step.turn, range });
            next = next.and_then(|frame| frame.parent.as_deref());
        }
        frames
    }

    fn diagnostic(&self, one: &found::Diagnostic) -> Diagnostic {
        let tree = self.0.document().tree();
        let related = |(message, origin): &(String, apt_ide::Origin)| Related {
            message: message.clone(),
            range: found::absolute_range(tree, origin),
        };
        Diagnostic {
            code: one.wording.code.to_owned(),
            severity: match one.severity {
                found::Severity::Error => Severity::Error,
                found::Severity::Warning => Severity::Warning,
                found::Severity::Information => Severity::Information,
                found::Severity::Hint => Severity::Hint,
            },
            message: one.wording.message.clone(),
            hint: one.wording.hint.clone(),
            isn: Some(one.origin.isn),
            apt3: one.wording.apt3,
            range: found::absolute_range(tree, &one.origin),
            origin: self.frames(&one.origin),
            related: one.related.iter().map(related).collect(),
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
        self.0.document().detection().to_string()
    }

    fn diagnostics(&self, level: Level, control: &Control) -> Answer<Vec<Diagnostic>> {
        let level = match level {
            Level::Section1 => apt_ide::Level::Section1,
            Level::Motion => apt_ide::Level::Motion,
        };
        let all = with(control, "checking", |cancel, progress| self.0.document().diagnostics(level, cancel, progress))?;
        Ok(all.iter().map(|one| self.diagnostic(one)).collect())
    }

    fn hover(&self, offset: usize, control: &Control) -> Answer<Option<Hover>> {
        let hover = with(control, "", |cancel, _| self.0.hover(offset, cancel))?;
        Ok(hover.map(|hover| Hover { range: hover.range, markdown: hover.markdown }))
    }

    fn completions(&self, offset: usize) -> Vec<Completion> {
        use apt_ide::completion::CompletionKind as Kind;
        let convert = |one: apt_ide::completion::Completion| Completion {
            label: one.label,
            kind: match one.kind {
                Kind::Name => CompletionKind::Name,
                Kind::Scalar => CompletionKind::Scalar,
                Kind::Macro => CompletionKind::Macro,
                Kind::Modifier => CompletionKind::Modifier,
                Kind::Type => CompletionKind::Type,
                Kind::Function => CompletionKind::Function,
                Kind::Statement => CompletionKind::Statement,
                Kind::Postprocessor => CompletionKind::Postprocessor,
            },
            detail: one.detail,
            documentation: one.documentation,
        };
        self.0.completions(offset).into_iter().map(convert).collect()
    }

    fn definitions(&self, offset: usize) -> Vec<Range<usize>> {
        self.0.definitions_at(offset)
    }

    fn occurrences(&self, offset: usize) -> Vec<Occurrence> {
        let all = self.0.occurrences(offset).into_iter();
        all.map(|one| Occurrence { range: one.range, defines: one.defines }).collect()
    }

    fn renamable(&self, offset: usize) -> Option<Range<usize>> {
        self.0.name_at(offset).map(|name| name.range)
    }

    fn rename(&self, offset: usize, new: &str) -> Result<Vec<TextEdit>, Refusal> {
        let edits = self.0.rename(offset, new).map_err(|error| Refusal::Impossible(error.to_string()))?;
        Ok(edits.into_iter().map(|(range, text)| TextEdit { range, text }).collect())
    }

    fn outline(&self) -> Vec<OutlineEntry> {
        self.0.outline().into_iter().map(outline_entry).collect()
    }

    fn folds(&self) -> Vec<Fold> {
        use apt_ide::folding::FoldKind as Kind;
        let convert = |one: apt_ide::folding::Fold| Fold {
            kind: match one.kind {
                Kind::Region => FoldKind::Region,
                Kind::Comment => FoldKind::Comment,
                Kind::Statement => FoldKind::Statement,
            },
            range: one.range,
        };
        self.0.folds().into_iter().map(convert).collect()
    }

    fn tokens(&self, range: Option<Range<usize>>) -> Vec<Token> {
        let convert = |one: apt_ide::tokens::Token| Token {
            range: one.range,
            class: token_class(one.class),
            definition: one.definition,
        };
        self.0.tokens(range).into_iter().map(convert).collect()
    }

    fn lenses(&self) -> Vec<Lens> {
        let all = self.0.lenses().into_iter();
        all.map(|lens| Lens { range: lens.range, title: lens.title, run: lens.run }).collect()
    }

    fn syntax_tree(&self) -> String {
        self.0.syntax_tree()
    }

    fn expand(&self, at: Option<usize>, depth: Option<u32>, control: &Control) -> Answer<Expansion> {
        let expansion = with(control, "expanding", |cancel, _| self.0.expand(at, depth, cancel))?;
        let tree = self.0.document().tree();
        let line = |(line, origin): (u32, &apt_ide::Origin)| ExpandedLine {
            line,
            isn: origin.isn,
            range: found::absolute_range(tree, origin),
            stack: self.frames(origin),
        };
        Ok(Expansion { text: expansion.text, origins: (0..).zip(&expansion.origins).map(line).collect() })
    }

    fn canonical_form(&self, offset: usize, control: &Control) -> Answer<Option<CanonicalForm>> {
        let form = with(control, "", |cancel, _| self.0.canonical_form(offset, cancel))?;
        Ok(form.map(|form| CanonicalForm {
            name: form.name,
            kind: form.kind,
            canonical: form.canonical,
            text: form.text,
        }))
    }

    fn run(&self, request: &RunRequest, control: &Control) -> Result<Value, Refusal> {
        let report = with(control, "running", |cancel, progress| self.0.run(request.range.clone(), cancel, progress))?;
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
        Ok(report)
    }

    fn tape(&self, machine: &str, control: &Control) -> Result<Value, Refusal> {
        let tape = with(control, "making the tape", |cancel, progress| self.0.tape(machine, cancel, progress))
            .map_err(tape_refusal)?;
        let blocks: Vec<_> = tape.blocks.iter().map(|block| block.text.as_str()).collect();
        let origin: Vec<_> = tape.blocks.iter().map(|block| block.isn).collect();
        let findings: Vec<_> = tape.findings.iter().map(ToString::to_string).collect();
        Ok(json!({ "machine": machine, "blocks": blocks, "origin": origin, "findings": findings }))
    }

    fn product(&self, product: &Product, control: &Control) -> Result<Vec<u8>, Refusal> {
        with(control, "running", |cancel, progress| match product {
            Product::ClText => Ok(self.0.cl_text(cancel, progress)?.into_bytes()),
            Product::Cltape => self.0.cltape(cancel, progress).map_err(tape_refusal),
            Product::Tape { machine, punch: None } => {
                Ok(self.0.tape(machine, cancel, progress).map_err(tape_refusal)?.text().into_bytes())
            }
            Product::Tape { machine, punch: Some(code) } => {
                let code = match code {
                    PunchCode::Eia => apt_ide::run::PunchCode::Eia,
                    PunchCode::Iso => apt_ide::run::PunchCode::Iso,
                };
                self.0.punched(machine, code, cancel, progress).map_err(tape_refusal)
            }
            Product::Picture(kind) => {
                let scene = self.0.scene(cancel, progress)?;
                Ok(match kind {
                    PictureKind::Html => apt_ide::picture::html(&scene),
                    PictureKind::Svg => apt_ide::picture::svg(&scene),
                }
                .into_bytes())
            }
        })
    }
}

fn to_json(value: &impl serde::Serialize) -> Result<Value, Refusal> {
    serde_json::to_value(value).map_err(|error| Refusal::Impossible(error.to_string()))
}

fn tape_refusal(error: apt_ide::run::TapeError) -> Refusal {
    use apt_ide::run::TapeError;
    match error {
        TapeError::UnknownMachine { name, known } => Refusal::UnknownMachine { name, known },
        TapeError::Cancelled(_) => Refusal::Interrupted,
        other => Refusal::Impossible(other.to_string()),
    }
}

fn outline_entry(entry: apt_ide::outline::OutlineEntry) -> OutlineEntry {
    use apt_ide::outline::OutlineKind as Kind;
    OutlineEntry {
        name: entry.name,
        detail: entry.detail,
        kind: match entry.kind {
            Kind::Part => OutlineKind::Part,
            Kind::Macro => OutlineKind::Macro,
            Kind::Loop => OutlineKind::Loop,
            Kind::Geometry => OutlineKind::Geometry,
            Kind::Scalar => OutlineKind::Scalar,
            Kind::Array => OutlineKind::Array,
            Kind::Tool => OutlineKind::Tool,
        },
        range: entry.range,
        focus: entry.focus,
        children: entry.children.into_iter().map(outline_entry).collect(),
    }
}

fn token_class(class: apt_ide::tokens::TokenClass) -> TokenClass {
    use apt_ide::tokens::TokenClass as Class;
    match class {
        Class::Keyword => TokenClass::Keyword,
        Class::Modifier => TokenClass::Modifier,
        Class::Type => TokenClass::Type,
        Class::Function => TokenClass::Function,
        Class::Postprocessor => TokenClass::Postprocessor,
        Class::Macro => TokenClass::Macro,
        Class::Parameter => TokenClass::Parameter,
        Class::Variable => TokenClass::Variable,
        Class::Label => TokenClass::Label,
        Class::Number => TokenClass::Number,
        Class::String => TokenClass::String,
        Class::Operator => TokenClass::Operator,
        Class::Comment => TokenClass::Comment,
    }
}

//! The real language: documents answered by `apt-ide`.
//!
//! Only conversions stand here: of cancellation and progress into the form that the analysis knows, and
//! of places with a statement into ranges of the text.

use std::ops::Range;
use std::sync::Arc;

use apt_ide::dialect::{describe, names};
use apt_ide::format::{FormatOptions, Kept, Plan, format_range, plan};
use apt_ide::picture::Scene;
use apt_ide::{Analysis, Cancelled};
use apt_run::Waiting;
use apt_run::diagnostic as found;
use apt_run::document::DialectReason;
use apt_run::position::LineIndex;
use apt_run::report::{Report, Sources, diagnostic_report};
use apt_run::settings::Settings;
use serde::Deserialize;
use serde_json::{Value, json};

use super::*;

/// The language that `apt-ide` knows.
pub(crate) struct Engine;

struct Program(Analysis);

impl Language for Engine {
    fn open(
        &self,
        text: &str,
        file_name: Option<&str>,
        settings: &Values,
        surroundings: Surroundings,
    ) -> Arc<dyn Document> {
        let settings = Arc::new(read_settings(settings).unwrap_or_default());
        let name = file_name.map(str::to_owned);
        Arc::new(Program(Analysis::placed(text, name, &settings, surroundings)))
    }

    fn check_settings(&self, settings: &Values) -> Result<(), String> {
        let settings = Arc::new(read_settings(settings).map_err(|error| error.to_string())?);
        let empty = Analysis::new("", None, &settings);
        match &settings.dialect {
            Some(name) if *empty.document().dialect_reason() != DialectReason::Setting => {
                Err(format!("there is no dialect `{name}`; there are {}", names().join(", ")))
            }
            _ => match settings
                .severity
                .keys()
                .find(|code| apt_ide::explain(code).is_none_or(|page| page.code != **code))
            {
                Some(code) => Err(format!("severity: there is no diagnostic `{code}`")),
                None => Ok(()),
            },
        }
    }

    fn machines(&self) -> Vec<MachineInfo> {
        apt_ide::tape::machines()
    }

    fn machine_definition(&self, name: &str) -> Result<String, Refusal> {
        apt_ide::tape::definition_file(name).map(str::to_owned).map_err(tape_refusal)
    }

    fn has_machine(&self, name: &str) -> bool {
        apt_ide::tape::machine(name).is_ok()
    }

    fn text_of_binary(&self, bytes: &[u8]) -> Option<Result<TextOfBinary, String>> {
        Some(apt_ide::tape::text_of_cl_tape(bytes)?.map_err(|error| error.to_string()))
    }

    fn difference(
        &self,
        paths: [&ToolPath; 2],
        allowance: Allowance,
        control: &Control,
    ) -> Result<PathDifference, Refusal> {
        use apt_ide::difference::{DifferenceError, difference};
        difference(paths, allowance, &|| control.is_cancelled()).map_err(|error| match error {
            DifferenceError::TooFar => Refusal::Impossible(error.to_string()),
            DifferenceError::Cancelled(_) => Refusal::Interrupted,
        })
    }

    fn explain(&self, code: &str) -> Option<String> {
        let page = apt_ide::explain(code)?;
        let sample =
            |title: &str, sample: &str| format!("\n{title}:\n\n```apt\n{}\n```\n", sample.trim_end());
        let mut text = format!("# {}: {}\n\n{}\n", page.code, page.title, page.text.trim());
        if let Some(machine) = &page.machine {
            text += &format!("\nThe tapes of the samples are for {machine}.\n");
        }
        text.push_str(&sample("Wrong", &page.wrong));
        text.push_str(&sample("Right", &page.right));
        Some(text)
    }

    fn title(&self, code: &str) -> Option<String> {
        apt_ide::explain(code).map(|page| page.title.clone())
    }
}

fn read_settings(values: &Values) -> Result<Settings, serde_json::Error> {
    let mut settings = Settings::deserialize(&Value::Object(values.clone()))?;
    // Codes are known in capitals, however they are written.
    settings.severity =
        settings.severity.into_iter().map(|(code, one)| (code.to_ascii_uppercase(), one)).collect();
    Ok(settings)
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

/// The frames of an origin, innermost first.
fn frames(places: Vec<(found::OriginStep, Option<Range<usize>>)>) -> Vec<OriginFrame> {
    let frame = |(step, range): (found::OriginStep, Option<Range<usize>>)| OriginFrame {
        kind: step.kind,
        name: step.name,
        isn: step.isn,
        turn: step.turn,
        range,
    };
    places.into_iter().map(frame).collect()
}

impl Program {
    fn control_tape(&self, machine: &str, control: &Control) -> Result<apt_ide::tape::ControlTape, Refusal> {
        with(control, "making the tape", |cancel, progress| self.0.tape(machine, cancel, progress))
            .map_err(tape_refusal)
    }

    fn diagnostic(&self, one: found::Diagnostic) -> Diagnostic {
        let tree = self.0.document().tree();
        let (mut related, mut elsewhere) = (Vec::new(), Vec::new());
        for (message, place) in found::related_places(tree, &one) {
            match place.source {
                None => related.push(Related { message, range: place.range }),
                Some(source) => elsewhere.push(Elsewhere { message, source, range: place.range }),
            }
        }
        Diagnostic {
            code: one.wording.code.to_owned(),
            severity: one.severity,
            message: one.wording.message,
            hint: one.wording.hint,
            isn: Some(one.origin.place_in_program().0),
            apt3: one.wording.apt3,
            range: found::absolute_range(tree, &one.origin),
            origin: frames(found::frame_places(tree, &one.origin)),
            related,
            elsewhere,
            unnecessary: one.unnecessary,
            fixes: one.fixes,
        }
    }
}

impl Program {
    /// A finding in an included file as a finding of that file.
    fn diagnostic_inside(&self, one: &found::Diagnostic) -> Diagnostic {
        let tree = self.0.document().tree();
        let place = found::Place::of(tree, &one.origin);
        let own = |(message, other): (String, found::Place)| {
            let beside = other.source == place.source && other.range != place.range;
            beside.then_some(Related { message, range: other.range })
        };
        Diagnostic {
            related: found::related_places(tree, one).into_iter().filter_map(own).collect(),
            elsewhere: Vec::new(),
            isn: Some(one.origin.isn),
            range: place.range.clone(),
            origin: Vec::new(),
            fixes: Vec::new(),
            ..self.diagnostic(one.clone())
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

    fn with_changed_files(&self) -> Arc<dyn Document> {
        Arc::new(Self(self.0.with_changed_files()))
    }

    fn holdings(&self) -> Holdings {
        self.0.document().holdings()
    }

    fn has_inclusions(&self) -> bool {
        self.0.has_inclusions()
    }

    fn included_paths(&self) -> Vec<PathBuf> {
        self.0.included_paths()
    }

    fn inclusions(&self) -> Vec<Inclusion> {
        self.0.inclusions()
    }

    fn diagnostics_in(&self, file: &Path, level: Level, control: &Control) -> Answer<Vec<Diagnostic>> {
        let all = with(control, "checking", |cancel, progress| self.0.diagnostics(level, cancel, progress))?;
        let stands =
            |one: &&found::Diagnostic| one.origin.source.as_ref().is_some_and(|source| source.path == file);
        let mut inside: Vec<_> = all.iter().filter(stands).map(|one| self.diagnostic_inside(one)).collect();
        inside.sort_by_key(|one| one.range.start);
        inside.dedup_by(|one, other| one.range == other.range && one.code == other.code);
        Ok(inside)
    }

    fn dialect(&self) -> String {
        describe(self.0.document())
    }

    fn diagnostics(&self, level: Level, control: &Control) -> Answer<Vec<Diagnostic>> {
        let all = with(control, "checking", |cancel, progress| self.0.diagnostics(level, cancel, progress))?;
        Ok(all.into_iter().map(|one| self.diagnostic(one)).collect())
    }

    fn worst_diagnostics(&self, level: Level, most: usize, control: &Control) -> Answer<Worst> {
        let worst = with(control, "checking", |cancel, progress| {
            self.0.worst_diagnostics(level, most, cancel, progress)
        })?;
        let diagnostics = worst.diagnostics.into_iter().map(|one| self.diagnostic(one)).collect();
        Ok(Worst { diagnostics, left_out: worst.left_out })
    }

    fn hover(&self, spot: Spot<'_>, control: &Control) -> Answer<Option<Hover>> {
        Ok(with(control, "", |cancel, _| self.0.hover_at(spot, cancel))?)
    }

    fn inlays(&self, file: Option<&Path>, range: Range<usize>, control: &Control) -> Answer<Vec<Inlay>> {
        Ok(with(control, "", |cancel, _| self.0.inlays_in(file, range, cancel))?)
    }

    fn selections(&self, offset: usize) -> Vec<Range<usize>> {
        self.0.selections(offset)
    }

    fn completions(&self, offset: usize, control: &Control) -> Answer<Vec<Completion>> {
        Ok(with(control, "", |cancel, _| self.0.completions(offset, cancel))?)
    }

    fn signature_help(&self, offset: usize) -> Option<SignatureHelp> {
        self.0.signature_help(offset)
    }

    fn definitions(&self, spot: Spot<'_>, control: &Control) -> Answer<Vec<Located>> {
        Ok(with(control, "", |cancel, _| self.0.definitions_everywhere(spot, cancel))?)
    }

    fn references(&self, spot: Spot<'_>, control: &Control) -> Answer<Vec<Located>> {
        Ok(with(control, "", |cancel, _| self.0.occurrences_everywhere(spot, cancel))?)
    }

    fn occurrences(&self, offset: usize, control: &Control) -> Answer<Vec<Occurrence>> {
        Ok(with(control, "", |cancel, _| self.0.occurrences(offset, cancel))?)
    }

    fn renamable(&self, spot: Spot<'_>) -> Option<Range<usize>> {
        self.0.name_at_spot(spot).map(|name| name.range)
    }

    fn rename(
        &self,
        spot: Spot<'_>,
        new: &str,
        control: &Control,
    ) -> Result<Vec<(Located, String)>, Refusal> {
        use apt_ide::navigation::RenameError;
        with(control, "", |cancel, _| self.0.rename_everywhere(spot, new, cancel)).map_err(
            |error| match error {
                RenameError::Cancelled(_) => Refusal::Interrupted,
                other => Refusal::Impossible(other.to_string()),
            },
        )
    }

    fn routine(&self, spot: Spot<'_>, control: &Control) -> Answer<Option<Routine>> {
        Ok(with(control, "", |cancel, _| self.0.routine_at(spot, cancel))?)
    }

    fn callers(&self, name: &str, control: &Control) -> Answer<Vec<Calls>> {
        Ok(with(control, "", |cancel, _| self.0.callers(name, cancel))?)
    }

    fn callees(&self, name: Option<&str>, file: Option<&Path>, control: &Control) -> Answer<Vec<Calls>> {
        Ok(with(control, "", |cancel, _| self.0.callees(name, file, cancel))?)
    }

    fn outline(&self, control: &Control) -> Answer<Vec<OutlineEntry>> {
        Ok(with(control, "", |cancel, _| self.0.outline(cancel))?)
    }

    fn folds(&self, control: &Control) -> Answer<Vec<Fold>> {
        Ok(with(control, "", |cancel, _| self.0.folds(cancel))?)
    }

    fn tokens(&self, range: Option<Range<usize>>, control: &Control) -> Answer<Vec<Token>> {
        Ok(with(control, "", |cancel, _| self.0.tokens(range, cancel))?)
    }

    fn lenses(&self, control: &Control) -> Answer<Vec<Lens>> {
        Ok(with(control, "", |cancel, _| self.0.lenses(cancel))?)
    }

    fn actions(
        &self,
        range: Range<usize>,
        wanted: &[ActionKind],
        level: Level,
        control: &Control,
    ) -> Answer<Vec<Action>> {
        let found = with(control, "checking", |cancel, progress| {
            self.0.actions(range, wanted, level, cancel, progress)
        })?;
        let action = |one: apt_ide::action::Action| Action {
            title: one.title,
            kind: one.kind,
            edits: one.edits.into_iter().map(|(range, text)| TextEdit { range, text }).collect(),
            preferred: one.preferred,
            settles: one.settles.map(|finding| self.diagnostic(finding)),
        };
        Ok(found.into_iter().map(action).collect())
    }

    fn format(&self, range: Option<Range<usize>>, control: &Control) -> Answer<Formatting> {
        let (document, tree) = (self.0.document(), self.0.document().tree());
        let options = FormatOptions::with(&tree.dialect(), &document.settings().format);
        let plan = with(control, "", |cancel, _| {
            let waiting = Waiting::until(cancel);
            let patience = waiting.patience();
            match range {
                Some(range) => format_range(tree, range, &options, patience)
                    .map(|edits| Plan { edits, kept: Vec::new() }),
                None => plan(tree, &options, patience),
            }
        })?;
        let kept = |kept: &Kept| {
            let view = tree.statement(kept.statement);
            (Range::<usize>::from(view.range()), kept.reason.to_string())
        };
        Ok(Formatting {
            kept: plan.kept.iter().map(kept).collect(),
            edits: plan.edits.into_iter().map(|(range, text)| TextEdit { range, text }).collect(),
        })
    }

    fn statements(&self) -> Vec<Range<usize>> {
        self.0.statements()
    }

    fn syntax_tree(&self, control: &Control) -> Answer<String> {
        Ok(self.0.syntax_tree(&|| control.is_cancelled())?)
    }

    fn expand(&self, at: Option<usize>, depth: Option<u32>, control: &Control) -> Answer<Expansion> {
        let expansion = with(control, "expanding", |cancel, _| self.0.expand(at, depth, cancel))?;
        let tree = self.0.document().tree();
        let placed = expansion.lines.iter().zip(&expansion.room_behind).zip(&expansion.origins);
        let pace = control.pace();
        let mut origins = Vec::with_capacity(expansion.origins.len());
        for ((line, room_behind), origin) in placed {
            pace.go_on(1)?;
            origins.push(ExpandedLine {
                room_behind: *room_behind,
                line: u32::try_from(*line).unwrap_or(u32::MAX),
                isn: origin.isn,
                range: found::absolute_range(tree, origin),
                stack: frames(found::frame_places(tree, origin)),
            });
        }
        Ok(Expansion { text: expansion.text, origins })
    }

    fn canonical_form(&self, offset: usize, control: &Control) -> Answer<Option<CanonicalForm>> {
        Ok(with(control, "", |cancel, _| self.0.canonical_form(offset, cancel))?)
    }

    fn run(&self, request: &RunRequest, control: &Control) -> Result<Value, Refusal> {
        let report =
            with(control, "running", |cancel, progress| self.0.run(request.range.clone(), cancel, progress))?;
        let pace = control.pace();
        let mut report = report_json(report, &pace)?;
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
            add("scene", scene_json(scene, &pace)?);
        }
        if request.story {
            let range = request.range.clone();
            let stories =
                with(control, "telling", |cancel, progress| self.0.stories(range, cancel, progress))?;
            let motions = report["motions"].as_array_mut().into_iter().flatten();
            for (motion, story) in motions.zip(stories) {
                if let Some(fields) = motion.as_object_mut() {
                    fields.insert("story".to_owned(), json!(story));
                }
            }
        }
        Ok(report)
    }

    fn machine_of_program(&self, control: &Control) -> Answer<Option<String>> {
        Ok(with(control, "reading", |cancel, _| self.0.machine_of_program(cancel))?)
    }

    fn tape(&self, machine: &str, control: &Control) -> Result<Value, Refusal> {
        let made = self.control_tape(machine, control)?;
        // Under its own name, whatever the program calls it.
        let machine = apt_ide::tape::machine(machine).map_or_else(|_| machine.to_owned(), |known| known.id);
        let pace = control.pace();
        let blocks = &made.tape.blocks;
        let (text, tree) = (self.0.text(), self.0.document().tree());
        let (file, lines) = (self.0.document().file().unwrap_or("-"), LineIndex::new(&text));
        let found = made.diagnostics.iter().map(|one| diagnostic_report(one, file, &text, tree, &lines));
        let mut places = Sources::new(tree, &lines);
        let sources =
            made.block_origins().map(|origin| origin.map(|origin| places.of(origin)).unwrap_or_default());
        let lists = [
            ("blocks", list_json(blocks.iter().map(|block| block.text.as_str()), &pace)?),
            ("origin", list_json(blocks.iter().map(|block| block.isn), &pace)?),
            ("sources", list_json(sources, &pace)?),
            ("diagnostics", list_json(found, &pace)?),
        ];
        Ok(with_lists(json!({ "machine": machine }), lists))
    }

    fn tape_diagnostics(
        &self,
        machine: &str,
        punch: Option<TapeCode>,
        control: &Control,
    ) -> Result<Vec<Diagnostic>, Refusal> {
        let made = with(control, "making the tape", |cancel, progress| match punch {
            None => self.0.tape(machine, cancel, progress),
            Some(code) => self.0.tape_to_punch(machine, code, cancel, progress),
        })
        .map_err(tape_refusal)?;
        Ok(made.diagnostics.into_iter().map(|one| self.diagnostic(one)).collect())
    }

    fn tool_path(&self, control: &Control) -> Answer<(ToolPath, Vec<Diagnostic>)> {
        let (path, found) = with(control, "running", |cancel, progress| self.0.tool_path(cancel, progress))?;
        Ok((path, found.into_iter().map(|one| self.diagnostic(one)).collect()))
    }

    fn convert(&self, to: ClDialect, tape: Option<&[u8]>, control: &Control) -> Result<Conversion, Refusal> {
        use apt_ide::conversion::ConversionError;
        let made = with(control, "converting", |cancel, progress| self.0.convert(to, tape, cancel, progress))
            .map_err(|error| match error {
                ConversionError::Cancelled(_) => Refusal::Interrupted,
                other => Refusal::Impossible(other.to_string()),
            })?;
        let diagnostics = made.diagnostics.into_iter().map(|one| self.diagnostic(one)).collect();
        Ok(Conversion { file: made.file, from: made.from, diagnostics })
    }

    fn product(&self, product: &Product, control: &Control) -> Result<Vec<u8>, Refusal> {
        with(control, "running", |cancel, progress| match product {
            Product::ClText => Ok(self.0.cl_text(cancel, progress)?.into_bytes()),
            Product::Cltape => self.0.cl_tape(cancel, progress).map_err(cl_tape_refusal),
            Product::Tape { machine, punch } => {
                let tape = self.0.tape(machine, cancel, progress).map_err(tape_refusal)?.tape;
                match punch {
                    None => Ok(tape.text().into_bytes()),
                    // The character that the code lacks is a finding of `tape_diagnostics`.
                    Some(code) => apt_ide::tape::punch(&tape, *code).map_err(|_| Refusal::Found),
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

/// A report as JSON; its lists, which grow with the path, item by item.
fn report_json(mut report: Report, pace: &Pace<'_>) -> Result<Value, Refusal> {
    let symbols = std::mem::take(&mut report.symbols);
    let (diagnostics, cl) = (std::mem::take(&mut report.diagnostics), std::mem::take(&mut report.cl));
    let motions = std::mem::take(&mut report.motions);
    let lists = [
        ("diagnostics", list_json(diagnostics, pace)?),
        ("symbols", Value::Object(symbols)),
        ("cl", list_json(cl, pace)?),
        ("motions", list_json(motions, pace)?),
    ];
    Ok(with_lists(to_json(&report)?, lists))
}

/// A scene as JSON; its pieces one by one.
fn scene_json(mut scene: Scene, pace: &Pace<'_>) -> Result<Value, Refusal> {
    let segments = std::mem::take(&mut scene.segments);
    let lists = [("segments", list_json(segments, pace)?)];
    Ok(with_lists(to_json(&scene)?, lists))
}

/// An object with lists in the places of those that were taken out.
fn with_lists<const N: usize>(mut object: Value, lists: [(&str, Value); N]) -> Value {
    if let Some(fields) = object.as_object_mut() {
        fields.extend(lists.map(|(key, list)| (key.to_owned(), list)));
    }
    object
}

fn list_json<T: serde::Serialize>(
    things: impl IntoIterator<Item = T>,
    pace: &Pace<'_>,
) -> Result<Value, Refusal> {
    let things = things.into_iter();
    let mut list = Vec::with_capacity(things.size_hint().0);
    for thing in things {
        pace.go_on(1)?;
        list.push(to_json(&thing)?);
    }
    Ok(Value::Array(list))
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
        TapeError::Definition { .. } => Refusal::Impossible(error.to_string()),
        TapeError::Cancelled(_) => Refusal::Interrupted,
    }
}

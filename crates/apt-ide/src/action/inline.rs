//! Macro calls and loops written out. What comes out is evaluated before it is offered: its records and values must be
//! those of before.

use apt_program::{Options, Program, RecordKind, Severity, Value, evaluate, remarks_of};
use apt_syntax::{SyntaxTree, statement::Body};

use super::{Action, ActionKind};
use crate::{Analysis, Cancel, Cancelled, format::applied, regions::RegionKind};

/// A program with more statements than this is not evaluated once more for an offer.
const MOST_STATEMENTS: usize = 5_000;

/// What is written out may have this many statements.
const MOST_LINES: usize = 1_000;

/// What a program means: its records without their places, and its values.
type Meaning = (Vec<(Option<String>, RecordKind)>, Vec<(String, Value)>);

impl Analysis {
    /// The CALL or the loop at an offset, written out.
    pub(super) fn written_out(&self, offset: usize, cancel: Cancel<'_>) -> Result<Option<Action>, Cancelled> {
        let Some((view, _)) = self.statement_at(offset) else { return Ok(None) };
        let tree = self.document().tree();
        if tree.statement_count() > MOST_STATEMENTS || tree.sequence_field() {
            return Ok(None);
        }
        let parsed = view.parsed();
        let [part] = parsed.statement.parts.as_slice() else { return Ok(None) };
        if parsed.statement.label.is_some() {
            return Ok(None);
        }
        let (title, last) = match &part.body {
            Body::Call { name, .. } => (format!("Write out the call of {}", name.text), view.index),
            Body::Major { word, .. } if word.word.spelling == "LOOPST" => {
                let region =
                    self.regions().iter().find(|one| one.kind == RegionKind::Loop && one.first == view.index);
                let Some(region) = region else { return Ok(None) };
                ("Write out the loop".to_owned(), region.last)
            }
            _ => return Ok(None),
        };
        let expansion = self.expand_with_remarks(offset, 1, cancel)?;
        if expansion.text.is_empty() || expansion.origins.len() > MOST_LINES {
            return Ok(None);
        }
        let range = usize::from(view.start)..usize::from(tree.statement(last).range().end());
        let line_end = if view.text().ends_with("\r\n") { "\r\n" } else { "\n" };
        // What is said beside the statement stands before what comes in its place.
        let said = remarks_of(&view).into_iter();
        let lines: Vec<String> = said.chain(expansion.text.lines().map(str::to_owned)).collect();
        let text = lines.into_iter().map(|line| line + line_end).collect();
        let edits = vec![(range, text)];
        let new = SyntaxTree::parse(&applied(&tree.text(), &edits), tree.dialect());
        let options = Options::from(&**self.document().settings());
        let after = evaluate(&new, &options, &cancel);
        let before = self.program(cancel)?;
        if !after.is_complete() {
            return Err(Cancelled);
        }
        let same = meaning(&before) == meaning(&after) && troubles(&before) >= troubles(&after);
        Ok(same.then_some(Action { title, kind: ActionKind::Inline, edits, preferred: false, settles: None }))
    }
}

/// How many findings a program has, but for hints: a variable that only the loop has used is used no more.
fn troubles(program: &Program) -> usize {
    program.findings().filter(|finding| finding.severity != Severity::Hint).count()
}

fn meaning(program: &Program) -> Meaning {
    let records =
        program.records().map(|record| (record.label.as_ref().map(ToString::to_string), record.kind.clone()));
    let symbols = program.symbols().into_iter().map(|(name, value)| (name.to_string(), value));
    (records.collect(), symbols.collect())
}

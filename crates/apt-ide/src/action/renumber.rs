//! Labels with other numbers: in steps, in the order of the text, with the jumps that lead to them.

use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Range,
};

use apt_geometry::{motion::MotionCommand, patience::Waiting};
use apt_program::{Options, Program, RecordKind, evaluate};
use apt_syntax::SyntaxTree;

use super::{Action, ActionKind};
use crate::{
    Analysis, Cancel, Cancelled,
    format::applied,
    navigation::{NumberedLabel, Scope},
};

/// A program with more statements than this is not evaluated once more for an offer.
const MOST_STATEMENTS: usize = 5_000;
/// The step between labels: room for nine more, as programs are numbered by hand.
const STEP: u32 = 10;
/// The greatest label: six digits.
const GREATEST: u32 = 999_999;

impl Analysis {
    /// The labels that are numbers with other numbers: those defined in a range, or all where the range is empty and
    /// touches one. Each other label keeps its number, and no new one is taken that a jump somewhere names.
    pub(super) fn renumbered(
        &self,
        range: &Range<usize>,
        cancel: Cancel<'_>,
    ) -> Result<Option<Action>, Cancelled> {
        let tree = self.document().tree();
        if tree.statement_count() > MOST_STATEMENTS || tree.sequence_field() {
            return Ok(None);
        }
        let labels = self.numbered_labels(Waiting::until(cancel).patience())?;
        let touches =
            |label: &&NumberedLabel| label.range.start <= range.end && label.range.end >= range.start;
        let all = range.is_empty();
        if all && !labels.iter().any(|label| touches(&label)) {
            return Ok(None);
        }
        let chosen: Vec<&NumberedLabel> =
            labels.iter().filter(|label| label.defines && (all || touches(label))).collect();
        let Some(new) = numbers(&labels, &chosen) else { return Ok(None) };
        let edits: Vec<_> = labels
            .iter()
            .filter_map(|label| {
                let number = new.get(&key(label))?;
                (*number != label.number).then(|| (label.range.clone(), number.to_string()))
            })
            .collect();
        if edits.is_empty() || !self.means_the_same(&edits, &new, cancel)? {
            return Ok(None);
        }
        let title = match (all, chosen.len()) {
            (true, _) => "Renumber all labels".to_owned(),
            (false, 1) => "Renumber the label".to_owned(),
            (false, count) => format!("Renumber {count} labels"),
        };
        Ok(Some(Action { title, kind: ActionKind::Renumber, edits, preferred: false, settles: None }))
    }

    /// Whether the program with other labels leaves as many records and findings and the same values. A label that a
    /// motion names for its check surface is not seen here as one: then there is no offer.
    fn means_the_same(
        &self,
        edits: &[(Range<usize>, String)],
        new: &BTreeMap<Key, u32>,
        cancel: Cancel<'_>,
    ) -> Result<bool, Cancelled> {
        let tree = self.document().tree();
        let before = self.program(cancel)?;
        if checks_name_one_of(&before, new) {
            return Ok(false);
        }
        let tree = SyntaxTree::parse(&applied(&tree.text(), edits), tree.dialect());
        let options = Options::from(&**self.document().settings());
        let after = evaluate(&tree, &options, &cancel);
        if !after.is_complete() {
            return Err(Cancelled);
        }
        Ok(before.symbols() == after.symbols()
            && before.record_count() == after.record_count()
            && before.findings().count() == after.findings().count())
    }
}

/// What a label is known by: its number, and where it means the same.
type Key = (u32, usize, Option<(usize, usize)>);

fn key(label: &NumberedLabel) -> Key {
    let Scope { file, statements } = label.scope;
    (label.number, file, statements)
}

/// The new numbers of the chosen labels; none if there are too many, or if one stands twice in its region.
fn numbers(labels: &[NumberedLabel], chosen: &[&NumberedLabel]) -> Option<BTreeMap<Key, u32>> {
    let keys: BTreeSet<Key> = chosen.iter().map(|label| key(label)).collect();
    if keys.len() != chosen.len() {
        return None;
    }
    let kept: BTreeSet<u32> =
        labels.iter().filter(|label| !keys.contains(&key(label))).map(|label| label.number).collect();
    let mut next = (STEP..=GREATEST).step_by(STEP as usize).filter(|number| !kept.contains(number));
    chosen.iter().map(|label| Some((key(label), next.next()?))).collect()
}

/// Whether a motion names one of these labels for a check surface.
fn checks_name_one_of(program: &Program, new: &BTreeMap<Key, u32>) -> bool {
    let named = |label: &str| {
        label.parse::<u32>().is_ok_and(|number| new.keys().any(|(changed, ..)| *changed == number))
    };
    program.records().any(|record| match &record.kind {
        RecordKind::Motion(command) => match &**command {
            MotionCommand::Drive { checks, .. } => {
                checks.iter().any(|check| check.label.as_deref().is_some_and(named))
            }
            _ => false,
        },
        _ => false,
    })
}

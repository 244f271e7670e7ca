//! What an editor can offer to do about a place: fixes of findings, comments that allow them, all certain fixes at once,
//! macro calls and loops written out, and labels with other numbers.

mod inline;
mod renumber;

#[cfg(test)]
mod tests;

use std::ops::Range;

use apt_run::{
    allow,
    diagnostic::{Diagnostic, Severity, absolute_range},
};

use crate::{Analysis, Cancel, Cancelled, Level, format::Edit};

/// The kind of an action, from which editors choose by menus and keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ActionKind {
    /// Settles one finding.
    QuickFix,
    /// Settles whatever can be settled surely.
    FixAll,
    /// Writes out what a CALL or a loop stands for.
    Inline,
    /// Gives labels other numbers.
    Renumber,
}

impl ActionKind {
    /// All kinds.
    pub const ALL: [ActionKind; 4] = [Self::QuickFix, Self::FixAll, Self::Inline, Self::Renumber];

    /// The name that editors know.
    pub fn name(self) -> &'static str {
        match self {
            Self::QuickFix => "quickfix",
            Self::FixAll => "source.fixAll.apt",
            Self::Inline => "refactor.inline",
            Self::Renumber => "refactor.rewrite.renumber",
        }
    }
}

/// Something that can be done.
#[derive(Debug, Clone, PartialEq)]
pub struct Action {
    /// What it does, as a command.
    pub title: String,
    /// Its kind.
    pub kind: ActionKind,
    /// The edits, in order of the text and without overlap.
    pub edits: Vec<Edit>,
    /// Whether it is certainly what is wanted.
    pub preferred: bool,
    /// The finding that it settles.
    pub settles: Option<Diagnostic>,
}

impl Analysis {
    /// What can be done about a range (bytes), of the kinds wanted. `level` says how far findings go.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn actions(
        &self,
        range: Range<usize>,
        wanted: &[ActionKind],
        level: Level,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Vec<Action>, Cancelled> {
        let mut actions = Vec::new();
        if wanted.contains(&ActionKind::QuickFix) || wanted.contains(&ActionKind::FixAll) {
            let found = self.diagnostics(level, cancel, progress)?;
            if wanted.contains(&ActionKind::QuickFix) {
                let touches = |finding: &&Diagnostic| {
                    let place = absolute_range(self.document().tree(), &finding.origin);
                    place.start <= range.end && place.end >= range.start
                };
                let here: Vec<&Diagnostic> = found.iter().filter(touches).collect();
                actions.extend(here.iter().flat_map(|finding| fixes(finding)));
                actions.extend(here.iter().flat_map(|finding| self.allowances(finding)));
            }
            if wanted.contains(&ActionKind::FixAll) {
                actions.extend(fix_all(&found));
            }
        }
        if wanted.contains(&ActionKind::Inline) {
            actions.extend(self.written_out(range.start, cancel)?);
        }
        if wanted.contains(&ActionKind::Renumber) {
            actions.extend(self.renumbered(&range, cancel)?);
        }
        Ok(actions)
    }

    /// Comments that allow a finding. Errors cannot be allowed.
    fn allowances(&self, finding: &Diagnostic) -> Vec<Action> {
        let tree = self.document().tree();
        let code = finding.wording.code;
        let index = (finding.origin.isn.max(1) - 1) as usize;
        if finding.severity == Severity::Error
            || finding.origin.source.is_some()
            || code == allow::ALLOWS_NOTHING
            || index >= tree.statement_count()
        {
            return Vec::new();
        }
        let view = tree.statement(index);
        let begins_line =
            index.checked_sub(1).is_none_or(|before| tree.statement(before).text().ends_with(['\n', '\r']));
        let line_end = if view.text().ends_with("\r\n") { "\r\n" } else { "\n" };
        let action = |title: String, at: usize, text: String| Action {
            title,
            kind: ActionKind::QuickFix,
            edits: vec![(at..at, text)],
            preferred: false,
            settles: Some(finding.clone()),
        };
        let mut actions = Vec::new();
        if begins_line {
            let text = view.text();
            let blanks = text.get(..text.len() - text.trim_start_matches([' ', '\t']).len()).unwrap_or("");
            let comment = format!("{blanks}{}{line_end}", allow::comment(allow::IN_STATEMENT, code));
            actions.push(action(format!("Allow {code} in this statement"), usize::from(view.start), comment));
        }
        // The comment on the first line may say the dialect; it stays the first.
        let top = tree.statements().find(|view| !view.text().contains(allow::ADDRESS));
        let comment = format!("{}{line_end}", allow::comment(allow::IN_PROGRAM, code));
        let at = top.map_or(0, |view| usize::from(view.start));
        actions.push(action(format!("Allow {code} in the whole program"), at, comment));
        actions
    }
}

fn fixes(finding: &Diagnostic) -> Vec<Action> {
    let action = |fix: &apt_run::diagnostic::Fix| Action {
        title: fix.title.clone(),
        kind: ActionKind::QuickFix,
        edits: fix.edits.clone(),
        preferred: fix.preferred,
        settles: Some(finding.clone()),
    };
    finding.fixes.iter().map(action).collect()
}

/// The first preferred fix of every finding, as far as they do not touch one another.
fn fix_all(found: &[Diagnostic]) -> Option<Action> {
    let mut fixes: Vec<&Vec<Edit>> = found
        .iter()
        .filter_map(|finding| finding.fixes.iter().find(|fix| fix.preferred))
        .map(|fix| &fix.edits)
        .collect();
    fixes.sort_by_key(|edits| edits.first().map_or(0, |(range, _)| range.start));
    fixes.dedup();
    let mut edits: Vec<Edit> = Vec::new();
    for fix in fixes {
        let start = fix.first().map_or(0, |(range, _)| range.start);
        // Two insertions at one place would have no order.
        if edits
            .last()
            .is_none_or(|(range, _)| range.end < start || (range.end == start && !range.is_empty()))
        {
            edits.extend(fix.iter().cloned());
        }
    }
    (!edits.is_empty()).then(|| Action {
        title: "Apply all certain fixes".to_owned(),
        kind: ActionKind::FixAll,
        edits,
        preferred: false,
        settles: None,
    })
}

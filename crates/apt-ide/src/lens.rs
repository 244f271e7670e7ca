//! Code lenses: where a run can be started from the text.

use std::ops::Range;

use apt_geometry::patience::Waiting;
use apt_run::go_on;
use apt_syntax::{statement::Body, vocabulary::WordClass};

use crate::{Analysis, Cancel, Cancelled};

/// A place to start a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lens {
    /// Where it is shown, bytes of the text.
    pub range: Range<usize>,
    /// What it says.
    pub title: String,
    /// What is run: a byte range, or the whole program.
    pub run: Option<Range<usize>>,
}

/// The most lenses of one program.
const GREATEST_LENSES: usize = 500;

impl Analysis {
    /// A lens on PARTNO (or the first statement with motion) for the program, and one on every start-up and macro call.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn lenses(&self, cancel: Cancel<'_>) -> Result<Vec<Lens>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        self.with_marks(patience)?;
        let tree = self.document().tree();
        let mut lenses = Vec::new();
        let mut program = None;
        for view in tree.statements() {
            if lenses.len() >= GREATEST_LENSES {
                break;
            }
            go_on(patience, 1)?;
            if !may_start(view.text()) {
                continue;
            }
            let parsed = view.parsed();
            let range = usize::from(view.range().start())..usize::from(view.range().end());
            for part in &parsed.statement.parts {
                let word = match &part.body {
                    Body::Text { word, .. } if word.word.spelling == "PARTNO" && program.is_none() => {
                        program = Some(range.clone());
                        continue;
                    }
                    Body::Major { word, .. } | Body::Call { word, .. } => word.word,
                    _ => continue,
                };
                let starts = matches!(word.spelling, "GO" | "CALL" | "OFFSET" | "POCKET");
                if word.class == WordClass::Motion && program.is_none() {
                    program = Some(range.clone());
                }
                if starts && !self.regions().iter().any(|region| region.contains(view.index)) {
                    let title = format!("Run {}", word.spelling);
                    lenses.push(Lens { range: range.clone(), title, run: Some(range.clone()) });
                }
            }
        }
        if let Some(range) = program {
            lenses.insert(0, Lens { range, title: "Run motion".to_owned(), run: None });
        }
        Ok(lenses)
    }
}

/// Only these statements can carry a lens; the rest need not be parsed.
fn may_start(text: &str) -> bool {
    let upper: String =
        text.chars().take(120).map(|c| c.to_ascii_uppercase()).filter(|c| *c != ' ').collect();
    ["PARTNO", "GO", "FROM", "CALL", "OFFSET", "POCKET"].iter().any(|word| upper.contains(word))
}

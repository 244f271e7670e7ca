//! Hovers of labels: where one stands, who jumps there, and whether it is reached.

use apt_geometry::patience::Waiting;
use apt_run::go_on;
use apt_syntax::{
    ParsedStatement,
    statement::{Body, Part},
};

use crate::{
    Analysis, Cancel, Cancelled,
    files::ProgramFile,
    navigation::{NameAt, Spot, statement_at},
};

/// More jumps than this would not be read.
const GREATEST_JUMPS: usize = 8;

impl Analysis {
    /// What is to be said about a label.
    pub(super) fn label_markdown(
        &self,
        spot: Spot<'_>,
        at: &NameAt,
        cancel: Cancel<'_>,
    ) -> Result<String, Cancelled> {
        let Some(file) = self.files().iter().find(|file| file.is(spot.file)) else {
            return Ok(format!("label `{}`", at.name));
        };
        // Labels belong to their file: all places are in this one.
        let places = self.occurrences_everywhere(spot, cancel)?;
        let own =
            places.iter().filter(|one| one.source.as_ref().map(|source| source.path.as_path()) == spot.file);
        let (mut standing, mut jumps) = (Vec::new(), Vec::new());
        for one in own {
            let Some((view, _)) = statement_at(&file.tree, one.occurrence.range.start) else { continue };
            if one.occurrence.defines { standing.push(view.isn()) } else { jumps.push(view.isn()) }
        }
        jumps.dedup();
        let mut text = match standing.as_slice() {
            [] => format!("label `{}`, which stands before no statement", at.name),
            [isn, ..] => format!("label `{}` of statement {isn}", at.name),
        };
        if let (None, Some(isn)) = (spot.file, standing.first()) {
            text.push_str(&self.reached(file, *isn, cancel)?);
        }
        match jumps.as_slice() {
            [] => text.push_str("\n\nnothing jumps here"),
            _ => text.push_str("\n\njumped to from:"),
        }
        for isn in jumps.iter().take(GREATEST_JUMPS) {
            let view = file.tree.statement((*isn as usize).saturating_sub(1));
            let word = view.parsed().statement.parts.iter().find_map(jumping_word);
            text.push_str(&format!(
                "\n- statement {isn}{}",
                word.map_or(String::new(), |word| format!(", {word}"))
            ));
        }
        if jumps.len() > GREATEST_JUMPS {
            text.push_str(&format!("\n- … {} more", jumps.len() - GREATEST_JUMPS));
        }
        Ok(text)
    }

    /// How often a statement of the program was executed, as far as it leaves something behind.
    fn reached(&self, file: &ProgramFile, isn: u32, cancel: Cancel<'_>) -> Result<String, Cancelled> {
        let parsed = file.tree.statement((isn as usize).saturating_sub(1)).parsed();
        if !leaves_something(&parsed) {
            return Ok(String::new());
        }
        let program = self.program(cancel)?;
        let definitions = program.definitions().map(|event| &event.origin);
        let origins = definitions.chain(program.records().map(|record| &record.origin));
        let mut times = 0_usize;
        let mut last = None;
        let waiting = Waiting::until(cancel);
        for origin in origins {
            go_on(waiting.patience(), 1)?;
            if origin.isn != isn || origin.source.is_some() {
                continue;
            }
            // The records of one execution stand together and have one place in loops and calls.
            if last != Some(&origin.frame) {
                times += 1;
            }
            last = Some(&origin.frame);
        }
        Ok(match times {
            0 => ", which is never reached".to_owned(),
            1 => ", which is reached once".to_owned(),
            _ => format!(", which is reached {times} times"),
        })
    }
}

/// Whether every execution of a statement leaves a value or a record.
fn leaves_something(parsed: &ParsedStatement) -> bool {
    parsed.statement.parts.iter().any(|part| match &part.body {
        Body::Assignment { .. } | Body::Definition { .. } => true,
        Body::Major { word, .. } => {
            matches!(
                word.word.spelling,
                "GOTO" | "FROM" | "GODLTA" | "GO" | "GOLFT" | "GORGT" | "GOFWD" | "GOBACK"
            )
        }
        _ => false,
    })
}

/// The word of a part that jumps.
fn jumping_word(part: &Part) -> Option<&'static str> {
    match &part.body {
        Body::ArithmeticIf { .. } | Body::LogicalIf { .. } => Some("IF"),
        Body::Jump { word, .. } | Body::Do { word, .. } => Some(word.word.spelling),
        Body::Major { word, .. } => Some(word.word.spelling),
        _ => None,
    }
}

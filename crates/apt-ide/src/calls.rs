//! Who calls whom: the macros of a program, and its files as those who call without being called.

use std::{ops::Range, path::Path, sync::Arc};

use apt_geometry::patience::Waiting;
use apt_program::SourceFile;
use apt_run::go_on;
use apt_syntax::{
    TextRange,
    statement::Body,
    tree::{StatementView, SyntaxTree},
};
use smol_str::SmolStr;

use crate::{
    Analysis, Cancel, Cancelled, absolute,
    files::ProgramFile,
    navigation::{Spot, statement_at},
    regions::{Region, RegionKind},
    search::statements_with,
};

/// A macro, or the statements of a file outside of all macros.
#[derive(Debug, Clone, PartialEq)]
pub struct Routine {
    /// Name of the macro; `None` for the file.
    pub name: Option<SmolStr>,
    /// The included file in which it stands; `None` for the program itself.
    pub source: Option<Arc<SourceFile>>,
    /// What it is, for people: the header of a macro, or that it is a program.
    pub detail: String,
    /// From its first statement to its last, bytes of the text of its file.
    pub range: Range<usize>,
    /// Its name, or the first statement of the file.
    pub selection: Range<usize>,
}

/// The CALLs between two routines, of which one was asked about.
#[derive(Debug, Clone, PartialEq)]
pub struct Calls {
    /// The other one.
    pub routine: Routine,
    /// The file in which the CALLs stand, that of who calls; `None` for the program itself.
    pub source: Option<Arc<SourceFile>>,
    /// The names in the CALLs, bytes of its text.
    pub places: Vec<Range<usize>>,
}

/// A CALL.
struct Found {
    name: SmolStr,
    statement: usize,
    place: Range<usize>,
}

impl Analysis {
    /// The macro that is named at a place, or the program at its PARTNO.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn routine_at(&self, spot: Spot<'_>, cancel: Cancel<'_>) -> Result<Option<Routine>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let files = self.with_files(waiting.patience())?;
        if let Some(at) = self.name_at_spot(spot).filter(|at| !at.label)
            && let Some(found) = self.macro_named(&at.name)
        {
            return Ok(Some(found));
        }
        let file = files.iter().find(|file| file.is(spot.file));
        let is_part = |body: &Body| matches!(body, Body::Text { word, .. } if word.word.spelling == "PARTNO");
        Ok(file
            .filter(|file| {
                let at = statement_at(&file.tree, spot.offset);
                at.is_some_and(|(view, _)| {
                    view.parsed().statement.parts.iter().any(|part| is_part(&part.body))
                })
            })
            .map(whole))
    }

    /// Who calls a macro, in order of the files.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn callers(&self, name: &str, cancel: Cancel<'_>) -> Result<Vec<Calls>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let mut callers: Vec<Calls> = Vec::new();
        for file in self.with_files(patience)? {
            let statements = statements_with(&file.tree, name, patience)?;
            for call in calls(&file.tree, statements).filter(|call| call.name == name) {
                go_on(patience, 1)?;
                let around =
                    |region: &&Region| region.kind == RegionKind::Macro && region.contains(call.statement);
                let routine = match file.regions.iter().rfind(around) {
                    Some(region) => of_macro(file, region),
                    None => whole(file),
                };
                match callers.iter_mut().find(|known| known.routine == routine) {
                    Some(known) => known.places.push(call.place),
                    None => {
                        let source = file.source.clone();
                        callers.push(Calls { routine, source, places: vec![call.place] });
                    }
                }
            }
        }
        Ok(callers)
    }

    /// Whom a macro calls, or for none the statements of a file outside of all macros; in order of the CALLs. Macros that are
    /// nowhere are left out.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn callees(
        &self,
        name: Option<&str>,
        file: Option<&Path>,
        cancel: Cancel<'_>,
    ) -> Result<Vec<Calls>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let mut callees: Vec<Calls> = Vec::new();
        let is_named =
            |region: &Region| region.kind == RegionKind::Macro && Some(region.name.as_str()) == name;
        let found = self.with_files(patience)?.iter().find_map(|one| match name {
            Some(_) => Some((one, Some(one.regions.iter().find(|region| is_named(region))?))),
            None => one.is(file).then_some((one, None)),
        });
        let Some((file, region)) = found else { return Ok(callees) };
        let belongs = |statement: usize| match region {
            Some(region) => region.contains(statement),
            None => !file.regions.iter().any(|one| one.kind == RegionKind::Macro && one.contains(statement)),
        };
        for call in calls(&file.tree, statements_with(&file.tree, "CALL", patience)?) {
            go_on(patience, 1)?;
            if !belongs(call.statement) {
                continue;
            }
            let Some(routine) = self.macro_named(&call.name) else { continue };
            match callees.iter_mut().find(|known| known.routine == routine) {
                Some(known) => known.places.push(call.place),
                None => {
                    let source = file.source.clone();
                    callees.push(Calls { routine, source, places: vec![call.place] });
                }
            }
        }
        Ok(callees)
    }

    fn macro_named(&self, name: &str) -> Option<Routine> {
        self.files().iter().find_map(|file| {
            let is_named = |region: &&Region| region.kind == RegionKind::Macro && region.name == name;
            file.regions.iter().find(is_named).map(|region| of_macro(file, region))
        })
    }
}

/// The CALLs in some statements, in order.
fn calls(tree: &SyntaxTree, statements: Vec<usize>) -> impl Iterator<Item = Found> {
    statements.into_iter().flat_map(move |statement| {
        let view = tree.statement(statement);
        let mut found = Vec::new();
        for part in &view.parsed().statement.parts {
            if let Body::Call { name, .. } = &part.body {
                found.push(Found { name: name.text.clone(), statement, place: absolute(&view, name.range) });
            }
        }
        found
    })
}

fn of_macro(file: &ProgramFile, region: &Region) -> Routine {
    let (first, last) = (file.tree.statement(region.first), file.tree.statement(region.last));
    let name = first.parsed().statement.parts.iter().find_map(|part| match &part.body {
        Body::Macro { name, .. } => Some(name.range),
        _ => None,
    });
    Routine {
        name: Some(region.name.clone()),
        source: file.source.clone(),
        detail: format!("MACRO/{}", region.variables.join(",")),
        range: start_of(&first)..end_of(&last),
        selection: absolute(&first, name.unwrap_or_default()),
    }
}

fn whole(file: &ProgramFile) -> Routine {
    let first = (file.tree.statement_count() > 0).then(|| file.tree.statement(0));
    let end = first.as_ref().map_or(0, |first| start_of(first) + first.text().trim_end().len());
    Routine {
        name: None,
        source: file.source.clone(),
        detail: "program".to_owned(),
        range: 0..file.tree.text().len(),
        selection: 0..end,
    }
}

fn start_of(view: &StatementView) -> usize {
    absolute(view, TextRange::default()).start
}

fn end_of(view: &StatementView) -> usize {
    start_of(view) + view.text().trim_end().len()
}

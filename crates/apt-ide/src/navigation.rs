//! Definition, references, highlights and rename of names and labels.

use std::{ops::Range, path::Path, sync::Arc};

use apt_geometry::{
    patience::{Patience, Waiting},
    pieces::Pieces,
};
use apt_program::SourceFile;
use apt_run::go_on;
use apt_syntax::{
    ParsedStatement, SyntaxTree, TextSize,
    statement::{Argument, Body, Element, ElementKind},
    tree::StatementView,
};
use smol_str::SmolStr;

use crate::{
    Analysis, Cancel, Cancelled, absolute,
    files::{ProgramFile, names_of_files},
    regions::Region,
    search::statements_with,
};

/// What a name stands for at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NameAt {
    /// The spelling, upper case.
    pub name: SmolStr,
    /// Where it stands, bytes of the text.
    pub range: Range<usize>,
    /// Where the name means the same.
    pub scope: Scope,
    /// A statement label or a jump target.
    pub label: bool,
}

/// Where a name means the same: the whole program, or the statements of a macro body or loop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scope {
    /// The file in which it lies, by its number among the files of the program (0: the program itself); 0 if it is the
    /// whole program with all its files.
    pub file: usize,
    /// First and last statement; `None` for the whole program.
    pub statements: Option<(usize, usize)>,
}

/// One occurrence of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Occurrence {
    /// Where, bytes of the text.
    pub range: Range<usize>,
    /// It is given a value here.
    pub defines: bool,
}

/// A label, or a jump to one, that is a number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct NumberedLabel {
    /// Its value, by which labels are compared.
    pub(crate) number: u32,
    /// Where it stands, bytes of the text.
    pub(crate) range: Range<usize>,
    /// Where it means the same.
    pub(crate) scope: Scope,
    /// Whether it is the label, not a jump.
    pub(crate) defines: bool,
}

/// Why a rename is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RenameError {
    /// There is no name at this place.
    #[error("there is no name here")]
    NoName,
    /// The new name is a vocabulary word.
    #[error("{0} is a word of the language")]
    Word(SmolStr),
    /// The new name breaks the rules of the dialect.
    #[error("{name} is not a name: {greatest} letters and digits at most, with at least one letter")]
    NotAName {
        /// What was asked for.
        name: SmolStr,
        /// How many characters the dialect allows.
        greatest: usize,
    },
    /// The new name is in use where the old one is.
    #[error("{0} is in use already")]
    InUse(SmolStr),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A place in one of the files of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spot<'a> {
    /// The included file; `None` for the program itself.
    pub file: Option<&'a Path>,
    /// Bytes of its text.
    pub offset: usize,
}

/// An occurrence in one of the files of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// The included file; `None` for the program itself.
    pub source: Option<Arc<SourceFile>>,
    /// Where in it.
    pub occurrence: Occurrence,
}

impl Analysis {
    /// The name at an offset.
    pub fn name_at(&self, offset: usize) -> Option<NameAt> {
        Names(self.files()).at(0, offset)
    }

    /// The name at a place.
    pub fn name_at_spot(&self, spot: Spot<'_>) -> Option<NameAt> {
        Names(self.files()).at(self.file_index(spot.file)?, spot.offset)
    }

    /// All occurrences of the name at an offset in the text of the program, in order.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn occurrences(&self, offset: usize, cancel: Cancel<'_>) -> Result<Vec<Occurrence>, Cancelled> {
        let own = |one: Located| one.source.is_none().then_some(one.occurrence);
        let everywhere = self.occurrences_everywhere(Spot { file: None, offset }, cancel)?;
        Ok(everywhere.into_iter().filter_map(own).collect())
    }

    /// All occurrences of the name at a place, those of the program first, then file by file.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn occurrences_everywhere(
        &self,
        spot: Spot<'_>,
        cancel: Cancel<'_>,
    ) -> Result<Vec<Located>, Cancelled> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let names = Names(self.with_files(patience)?);
        let Some(at) = self.name_at_spot(spot) else { return Ok(Vec::new()) };
        names.occurrences(&at.name, at.label, &at.scope, patience)
    }

    /// Where the name at an offset gets its value: all places, the one in force at the offset first.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn definitions_at(&self, offset: usize, cancel: Cancel<'_>) -> Result<Vec<Range<usize>>, Cancelled> {
        let own = |one: Located| one.source.is_none().then_some(one.occurrence.range);
        let everywhere = self.definitions_everywhere(Spot { file: None, offset }, cancel)?;
        Ok(everywhere.into_iter().filter_map(own).collect())
    }

    /// Where the name at a place gets its value: all places, the one in force there first. The name of a file leads to
    /// the beginning of the file.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn definitions_everywhere(
        &self,
        spot: Spot<'_>,
        cancel: Cancel<'_>,
    ) -> Result<Vec<Located>, Cancelled> {
        self.with_files(Waiting::until(cancel).patience())?;
        if let Some(file) = self.included_at(spot) {
            let occurrence = Occurrence { range: 0..0, defines: true };
            return Ok(vec![Located { source: file.source.clone(), occurrence }]);
        }
        let mut places = self.occurrences_everywhere(spot, cancel)?;
        places.retain(|one| one.occurrence.defines);
        let here = |one: &Located| {
            one.source.as_ref().map(|source| source.path.as_path()) == spot.file
                && one.occurrence.range.start <= spot.offset
        };
        if let Some(before) = places.iter().rposition(here) {
            let in_force = places.remove(before);
            places.insert(0, in_force);
        }
        Ok(places)
    }

    /// The edits that rename the name at an offset in the text of the program.
    ///
    /// # Errors
    ///
    /// [`RenameError`] when there is no name, the new one cannot be used, or `cancel` said so before the end.
    pub fn rename(
        &self,
        offset: usize,
        new: &str,
        cancel: Cancel<'_>,
    ) -> Result<Vec<(Range<usize>, String)>, RenameError> {
        let waiting = Waiting::until(cancel);
        let everywhere = self.rename_everywhere(Spot { file: None, offset }, new, cancel)?;
        // A list that grows is copied as a whole, which nobody can interrupt.
        let mut own = Vec::with_capacity(everywhere.len());
        for (one, text) in everywhere {
            go_on(waiting.patience(), 1)?;
            own.extend(one.source.is_none().then_some((one.occurrence.range, text)));
        }
        Ok(own)
    }

    /// The edits of all files of the program that rename the name at a place.
    ///
    /// # Errors
    ///
    /// [`RenameError`] when there is no name, the new one cannot be used, or `cancel` said so before the end.
    pub fn rename_everywhere(
        &self,
        spot: Spot<'_>,
        new: &str,
        cancel: Cancel<'_>,
    ) -> Result<Vec<(Located, String)>, RenameError> {
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let names = Names(self.with_files(patience)?);
        let at = self.name_at_spot(spot).filter(|_| self.included_at(spot).is_none());
        let at = at.ok_or(RenameError::NoName)?;
        let wanted = SmolStr::new(new.trim().to_ascii_uppercase());
        let greatest = self.document().tree().dialect().name_length.map_or(usize::MAX, usize::from);
        let spelled = wanted.chars().all(|c| c.is_ascii_alphanumeric());
        let lettered = at.label || wanted.chars().any(|c| c.is_ascii_alphabetic());
        if wanted.is_empty() || !spelled || !lettered || wanted.len() > greatest {
            return Err(RenameError::NotAName { name: wanted, greatest });
        }
        if apt_syntax::vocabulary::lookup(&wanted).is_some() {
            return Err(RenameError::Word(wanted));
        }
        if wanted != at.name && !names.occurrences(&wanted, at.label, &at.scope, patience)?.is_empty() {
            return Err(RenameError::InUse(wanted));
        }
        let occurrences = names.occurrences(&at.name, at.label, &at.scope, patience)?;
        let mut edits = Vec::with_capacity(occurrences.len());
        for one in occurrences {
            go_on(patience, 1)?;
            edits.push((one, new.trim().to_owned()));
        }
        Ok(edits)
    }

    /// All labels and jump targets in the text of the program that are numbers, in order of the text.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when who waits has given up before the end.
    pub(crate) fn numbered_labels(&self, patience: Patience<'_>) -> Result<Vec<NumberedLabel>, Cancelled> {
        let names = Names(self.with_files(patience)?);
        let Some(own) = names.0.first() else { return Ok(Vec::new()) };
        let mut found = Vec::new();
        for view in own.tree.statements() {
            go_on(patience, 1)?;
            let parsed = view.parsed();
            for (at, element) in parsed.elements.iter().enumerate() {
                if element.kind != ElementKind::Number || !is_label(&parsed, at) {
                    continue;
                }
                let Ok(number) = element.text.parse::<u32>() else { continue };
                let scope = names.element_scope(0, view.index, &parsed, at, true);
                let (range, defines) = (absolute(&view, element.range), defines(&parsed, at));
                found.push(NumberedLabel { number, range, scope, defines });
            }
        }
        Ok(found)
    }

    fn file_index(&self, file: Option<&Path>) -> Option<usize> {
        self.files().iter().position(|one| one.is(file))
    }

    /// The file whose name stands at a place, in a statement that puts it in.
    fn included_at(&self, spot: Spot<'_>) -> Option<&ProgramFile> {
        let file = self.files().get(self.file_index(spot.file)?)?;
        let (view, relative) = statement_at(&file.tree, spot.offset)?;
        let parsed = view.parsed();
        let names = parsed.statement.parts.iter().flat_map(|part| names_of_files(&part.body));
        let (_, name) = names.into_iter().find(|(range, _)| range.contains_inclusive(relative))?;
        let source = self.document().options().include?.resolve(&name).ok()?;
        self.files().iter().find(|one| one.is(Some(&source.path)))
    }
}

/// The names in the files of a program.
struct Names<'a>(&'a [ProgramFile]);

impl Names<'_> {
    fn at(&self, file: usize, offset: usize) -> Option<NameAt> {
        let (view, relative) = statement_at(&self.0.get(file)?.tree, offset)?;
        let parsed = view.parsed();
        let index = parsed.elements.iter().position(|element| {
            matches!(element.kind, ElementKind::Name | ElementKind::Number)
                && element.range.contains_inclusive(relative)
        })?;
        let element = &parsed.elements[index];
        let label = is_label(&parsed, index);
        if element.kind == ElementKind::Number && !label || names_nothing(&parsed, index) {
            return None;
        }
        let scope = self.element_scope(file, view.index, &parsed, index, label);
        Some(NameAt { name: element.text.clone(), range: absolute(&view, element.range), scope, label })
    }

    fn occurrences(
        &self,
        name: &str,
        label: bool,
        scope: &Scope,
        patience: Patience<'_>,
    ) -> Result<Vec<Located>, Cancelled> {
        let mut found = Pieces::default();
        for (file, one) in self.0.iter().enumerate() {
            for index in statements_with(&one.tree, name, patience)? {
                go_on(patience, 1)?;
                let view = one.tree.statement(index);
                let parsed = view.parsed();
                for (at, element) in parsed.elements.iter().enumerate() {
                    let same = element.text == name && is_label(&parsed, at) == label;
                    if same
                        && (label || element.kind == ElementKind::Name)
                        && !names_nothing(&parsed, at)
                        && self.element_scope(file, index, &parsed, at, label) == *scope
                    {
                        let range = absolute(&view, element.range);
                        let occurrence = Occurrence { range, defines: defines(&parsed, at) };
                        found.push(Located { source: one.source.clone(), occurrence });
                    }
                }
            }
        }
        let found = found.joined(patience);
        go_on(patience, 0)?;
        Ok(found)
    }

    /// Where the name at an element means the same. In a CALL, what stands before `=` is a variable of the macro.
    fn element_scope(
        &self,
        file: usize,
        statement: usize,
        parsed: &ParsedStatement,
        index: usize,
        label: bool,
    ) -> Scope {
        let element = &parsed.elements[index];
        let called = parsed.statement.parts.iter().find_map(|part| match &part.body {
            Body::Call { name, arguments, .. } => {
                arguments.iter().any(|argument| argument.name.range == element.range).then_some(&name.text)
            }
            _ => None,
        });
        let region = called.and_then(|called| self.called(file, statement, called, &element.text));
        region.unwrap_or_else(|| self.scope(file, statement, &element.text, label))
    }

    /// The body of a macro with a variable that a statement calls: the last one before it in its file, else another one.
    fn called(&self, file: usize, statement: usize, name: &str, variable: &str) -> Option<Scope> {
        let named =
            |region: &&Region| region.name == name && region.variables.iter().any(|one| one == variable);
        let own = &self.0.get(file)?.regions;
        let before = own.iter().rfind(|region| named(region) && region.first < statement);
        let scope =
            |file: usize, region: &Region| Scope { file, statements: Some((region.first, region.last)) };
        if let Some(region) = before.or_else(|| own.iter().find(named)) {
            return Some(scope(file, region));
        }
        let mut others = self.0.iter().enumerate();
        others.find_map(|(index, other)| Some(scope(index, other.regions.iter().find(named)?)))
    }

    /// Labels are local to their loop or macro, or to their file; macro variables to their macro.
    fn scope(&self, file: usize, statement: usize, name: &str, label: bool) -> Scope {
        let regions = self.0.get(file).map_or(&[][..], |file| &file.regions);
        let innermost = |wanted: &dyn Fn(&Region) -> bool| {
            regions.iter().rfind(|region| region.contains(statement) && wanted(region))
        };
        let region = if label {
            innermost(&|region| region.first != statement || region.last != statement)
        } else {
            innermost(&|region| region.variables.iter().any(|variable| variable == name))
        };
        let statements = region.map(|region| (region.first, region.last));
        Scope { file: if label || statements.is_some() { file } else { 0 }, statements }
    }
}

/// The statement at an offset and the offset relative to its start; `None` in an empty text.
pub(crate) fn statement_at(tree: &SyntaxTree, offset: usize) -> Option<(StatementView, TextSize)> {
    if tree.statement_count() == 0 {
        return None;
    }
    let offset = TextSize::new(offset.min(usize::from(tree.len())) as u32);
    let view = tree.statement(tree.statement_at(offset));
    let relative = offset.checked_sub(view.range().start())?;
    Some((view, relative))
}

/// Whether an element is a statement label or a jump target.
fn is_label(parsed: &ParsedStatement, index: usize) -> bool {
    let range = parsed.elements[index].range;
    let statement = &parsed.statement;
    let target = |body: &Body| match body {
        Body::ArithmeticIf { labels, .. } => labels.iter().any(|label| label.range == range),
        Body::Jump { label, .. } | Body::Do { label, .. } => label.range == range,
        _ => false,
    };
    statement.label.as_ref().is_some_and(|label| label.range == range)
        || statement.parts.iter().any(|part| match &part.body {
            Body::LogicalIf { then, .. } => then.iter().any(|part| target(&part.body)),
            body => target(body),
        })
}

/// Whether the statement takes what is spelt like a name for a word, as the unit after UNITS, or for the machine of MACHIN.
fn names_nothing(parsed: &ParsedStatement, index: usize) -> bool {
    let range = parsed.elements[index].range;
    let in_body = |body: &Body| {
        let Body::Major { word, arguments, .. } = body else { return false };
        let is_word = |argument: &Argument| matches!(argument, Argument::Word(minor) if minor.range == range);
        let is_machine = word.word.spelling == "MACHIN"
            && arguments.first().is_some_and(|argument| argument.range() == range);
        word.range == range || is_machine || arguments.iter().any(is_word)
    };
    parsed.statement.parts.iter().any(|part| match &part.body {
        Body::LogicalIf { then, .. } => then.iter().any(|part| in_body(&part.body)),
        body => in_body(body),
    })
}

/// Whether the element at `index` is given a value by its statement: a label, a target of `=`, a macro variable of a
/// header, a name of OBTAIN or RESERV.
fn defines(parsed: &ParsedStatement, index: usize) -> bool {
    let element: &Element = &parsed.elements[index];
    let next = |at: usize| parsed.elements.get(at).map(|element| element.kind);
    if parsed.statement.label.as_ref().is_some_and(|label| label.range == element.range) {
        return true;
    }
    let in_part = |body: &Body| match body {
        Body::Macro { name, parameters, .. } => {
            name.range == element.range
                || parameters.iter().any(|parameter| parameter.name.range == element.range)
        }
        Body::Call { .. } => false,
        Body::Major { word, .. } if word.word.spelling == "RESERV" => true,
        Body::Obtain { .. } => {
            // The first name after the slash is the surface that is taken apart.
            let names = parsed.elements.iter().filter(|element| element.kind == ElementKind::Name);
            names.clone().count() > 0 && names.skip(1).any(|name| name.range == element.range)
        }
        Body::Assignment { target, .. } | Body::Definition { target, .. }
            if target.name.range == element.range =>
        {
            true
        }
        // A nested definition or assignment: `(NAME=…`, with an optional subscript.
        _ => {
            let mut at = index + 1;
            if next(at) == Some(ElementKind::LeftParenthesis) {
                let mut depth = 0_usize;
                while let Some(kind) = next(at) {
                    match kind {
                        ElementKind::LeftParenthesis => depth += 1,
                        ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                        _ => {}
                    }
                    at += 1;
                    if depth == 0 {
                        break;
                    }
                }
            }
            next(at) == Some(ElementKind::Equals)
        }
    };
    parsed.statement.parts.iter().any(|part| part.range.contains_range(element.range) && in_part(&part.body))
}

//! The files of a program: its own text, and those that INCLUD, LIBRY and READ/2 put in.
//!
//! They are found from the statements alone, so that definitions and links work while a program is being written.

use std::{
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use apt_geometry::patience::Patience;
use apt_program::SourceFile;
use apt_syntax::{
    SyntaxTree, TextRange,
    statement::{Argument, Body, Expression},
};
use smol_str::SmolStr;

use crate::{
    Analysis, Cancelled, absolute,
    regions::{Marks, Region},
};

/// Files of one program that are looked at; a circle of inclusions ends long before.
const MOST_FILES: usize = 256;

/// One file of a program.
#[derive(Debug, Clone)]
pub(crate) struct ProgramFile {
    /// The included file; `None` for the program itself.
    pub(crate) source: Option<Arc<SourceFile>>,
    /// Its statements.
    pub(crate) tree: SyntaxTree,
    /// Its macro bodies and loops.
    pub(crate) regions: Vec<Region>,
}

impl ProgramFile {
    /// Whether this is the file with this path, or the program for none.
    pub(crate) fn is(&self, path: Option<&Path>) -> bool {
        self.source.as_ref().map(|source| source.path.as_path()) == path
    }
}

/// The name of a file in a statement that puts it in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Inclusion {
    /// The name: bytes of the text.
    pub range: Range<usize>,
    /// Its spelling.
    pub name: SmolStr,
    /// Where the file is; nothing if it cannot be found.
    pub path: Option<PathBuf>,
}

impl Analysis {
    /// The files of the program, itself first.
    pub(crate) fn files(&self) -> &[ProgramFile] {
        self.files.get_or_init(|| {
            let tree = self.document().tree().clone();
            let program = ProgramFile { source: None, tree, regions: self.regions().to_vec() };
            let mut names = inclusions(self.marks(), &program.tree);
            let mut files = vec![program];
            let Some(resolver) = self.document().options().include else { return files };
            while let Some((_, name)) = names.pop() {
                let Ok(source) = resolver.resolve(&name) else { continue };
                let known = files.iter().any(|file| file.is(Some(&source.path)));
                if known || files.len() >= MOST_FILES || resolver.is_program(&source.path) {
                    continue;
                }
                let marks = Marks::of(&source.tree);
                names.extend(inclusions(&marks, &source.tree));
                let (tree, regions) = (source.tree.clone(), marks.regions(&source.tree));
                files.push(ProgramFile { source: Some(source), tree, regions });
            }
            files
        })
    }

    /// The same for somebody who waits.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when who waits has given up before the end.
    pub(crate) fn with_files(&self, patience: Patience<'_>) -> Result<&[ProgramFile], Cancelled> {
        self.with_marks(patience)?;
        Ok(self.files())
    }

    /// The names of files in the text of the program, with the files that they name.
    pub fn inclusions(&self) -> Vec<Inclusion> {
        let resolver = self.document().options().include;
        let path = |name: &str| Some(resolver.as_ref()?.resolve(name).ok()?.path.clone());
        inclusions(self.marks(), self.document().tree())
            .into_iter()
            .map(|(range, name)| Inclusion { range, path: path(&name), name })
            .collect()
    }

    /// The files that are put in, directly or by others.
    pub fn included_paths(&self) -> Vec<PathBuf> {
        self.files().iter().filter_map(|file| Some(file.source.as_ref()?.path.clone())).collect()
    }

    /// Whether a statement puts in a file, be it there or not.
    pub fn has_inclusions(&self) -> bool {
        self.marks().inclusions().next().is_some()
    }
}

/// The names of files in the statements that put them in, with their places in the text.
fn inclusions(marks: &Marks, tree: &SyntaxTree) -> Vec<(Range<usize>, SmolStr)> {
    let mut found = Vec::new();
    for index in marks.inclusions() {
        let view = tree.statement(index);
        for part in &view.parsed().statement.parts {
            let names = names_of_files(&part.body).into_iter();
            found.extend(names.map(|(range, name)| (absolute(&view, range), name)));
        }
    }
    found
}

/// The names of the files that a part of a statement puts in.
pub(crate) fn names_of_files(body: &Body) -> Vec<(TextRange, SmolStr)> {
    let Body::Major { word, arguments, .. } = body else { return Vec::new() };
    let wanted: &[Argument] = match (word.word.spelling, arguments.as_slice()) {
        ("INCLUD", [first, ..]) => std::slice::from_ref(first),
        ("LIBRY", names) => names,
        ("READ", [Argument::Expression(Expression::Number { value: 2.0, .. }), name, ..]) => {
            std::slice::from_ref(name)
        }
        _ => &[],
    };
    let name = |argument: &Argument| match argument {
        Argument::Text { text, range } => Some((*range, text.clone())),
        Argument::Expression(Expression::Reference(reference)) => {
            Some((reference.range, reference.name.text.clone()))
        }
        Argument::Word(word) => Some((word.range, SmolStr::new_static(word.word.spelling))),
        _ => None,
    };
    wanted.iter().filter_map(name).collect()
}

//! INCLUD: statements of another file in place of it.

use std::sync::Arc;

use apt_syntax::TextRange;
use smol_str::{SmolStr, format_smolstr};

use super::{Evaluator, Flow, step::TopLevel};
use crate::{
    finding::{ControlFinding, FindingKind},
    options::IncludeFailure,
    record::{FrameKind, SourceFile},
    statements::Major,
};

impl Evaluator<'_> {
    /// INCLUD: executes the statements of another file in place.
    pub(crate) fn include(&mut self, major: Major<'_>) -> Flow {
        match included_name(major) {
            Some(name) => self.include_file(&name, major.range),
            None => {
                self.wrong_count(major, major.arguments.len(), "a file name", 129);
                Flow::Next
            }
        }
    }

    /// Executes the statements of the file with this name. `range` is the statement part that asks for them.
    pub(crate) fn include_file(&mut self, name: &SmolStr, range: TextRange) -> Flow {
        match self.included_source(name, range) {
            Some(source) => self.execute_file(source, name, range),
            None => Flow::Next,
        }
    }

    /// Executes the statements of a file that has been found under a name.
    pub(crate) fn execute_file(&mut self, source: Arc<SourceFile>, name: &SmolStr, range: TextRange) -> Flow {
        let limit = self.options.macro_depth;
        if self.here.depth >= limit {
            self.report(
                FindingKind::Control(ControlFinding::MacroDepth { name: name.clone(), limit }),
                range,
            );
            return Flow::Abort;
        }
        let outer = self.here.clone();
        let frame = self.frame(FrameKind::Include, name.clone(), range);
        self.here.frame = Some(Arc::new(frame));
        self.here.depth += 1;
        let tree = source.tree.clone();
        self.here.source = Some(source);
        let mut top = TopLevel::new(&tree);
        let mut index = 0;
        let mut flow = Flow::Next;
        while index < tree.statement_count() && !self.state.ended {
            if self.budget.left == 0 || self.is_cancelled() {
                flow = Flow::Abort;
                break;
            }
            self.budget.left -= 1;
            index = self.step(&mut top, index).next;
        }
        self.here = outer;
        if self.state.ended { Flow::End } else { flow }
    }

    /// The file with this name; nothing when it cannot be included, which has been reported.
    pub(crate) fn included_source(&mut self, name: &SmolStr, range: TextRange) -> Option<Arc<SourceFile>> {
        self.asked_for_files = true;
        let resolved = match &self.options.include {
            Some(resolver) => resolver.resolve(name),
            None => Err(IncludeFailure::NotFound { searched: Vec::new() }),
        };
        let finding = match resolved {
            Ok(source) => match self.circle_through(&source) {
                None => return Some(source),
                Some(mut through) => {
                    through.push(name.clone());
                    FindingKind::Control(ControlFinding::IncludeCycle { name: name.clone(), through })
                }
            },
            Err(IncludeFailure::NotFound { searched }) => {
                FindingKind::Control(ControlFinding::IncludeNotFound { name: name.clone(), searched })
            }
            Err(IncludeFailure::Unreadable { path, reason }) => {
                FindingKind::Control(ControlFinding::IncludeUnreadable { path, reason })
            }
            Err(IncludeFailure::TooLarge { path, limit }) => {
                let reason = format_smolstr!("it is larger than {limit} bytes");
                FindingKind::Control(ControlFinding::IncludeUnreadable { path, reason })
            }
        };
        self.report(finding, range);
        None
    }

    /// The names of the inclusions from that of a file on to the place being executed, if it stands inside of the file.
    fn circle_through(&self, source: &Arc<SourceFile>) -> Option<Vec<SmolStr>> {
        let mut inside = self.here.source.clone();
        let mut through = Vec::new();
        let mut around = self.here.frame.as_deref();
        let is_program =
            self.options.include.as_ref().is_some_and(|resolver| resolver.is_program(&source.path));
        let mut circle = is_program.then_some(0);
        while let Some(frame) = around {
            if frame.kind == FrameKind::Include {
                through.push(frame.name.clone());
                if is_program || inside.as_ref() == Some(source) {
                    circle = Some(through.len());
                }
            }
            inside = frame.source.clone();
            around = frame.parent.as_deref();
        }
        through.truncate(circle?);
        through.reverse();
        Some(through)
    }
}

/// The name after INCLUD/.
fn included_name(major: Major<'_>) -> Option<SmolStr> {
    use apt_syntax::statement::{Argument, Expression};
    match major.arguments.first()? {
        Argument::Text { text, .. } => Some(text.clone()),
        Argument::Expression(Expression::Reference(reference)) => Some(reference.name.text.clone()),
        // A file may have the name of a word.
        Argument::Word(word) => Some(SmolStr::new_static(word.word.spelling)),
        _ => None,
    }
}

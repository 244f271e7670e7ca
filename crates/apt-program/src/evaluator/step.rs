//! The top level: one statement of a program or included file at a time, with the macro bodies and loop regions it opens.

use std::{collections::BTreeMap, sync::Arc};

use apt_syntax::{
    ParsedStatement, SyntaxTree, TextRange,
    statement::{Body, MacroParameter, Name},
};
use smol_str::SmolStr;

use super::{Budget, DataCards, Evaluator, Flow, Region, conditional::Conditional};
use crate::{
    blocks::{self, Activation, Bindings, Block, BranchFinder, DoHeader, DoLoop, normalised_label},
    finding::{ControlFinding, FindingKind, RelatedKind, Severity},
    record::{Frame, FrameKind, Origin, RecordKind},
    symbols::{Meaning, similar_names},
};

/// By how much each exhausted budget makes the next one smaller: so that many endless loops end soon.
const BUDGET_SHRINK: u64 = 16;
/// A budget never shrinks below so many statements, unless less was granted.
const LEAST_BUDGET: u64 = 2_000;

/// Statements of a file at the top level, with what jumps among them need.
pub(crate) struct TopLevel<'t> {
    /// The statements.
    pub(crate) tree: &'t SyntaxTree,
    /// DO loops that are open.
    pub(crate) do_loops: Vec<DoLoop>,
    /// The outermost IF over several statements that was begun last.
    pub(super) conditional: Option<Conditional>,
    /// The clause of it that decides next.
    pub(super) testing: Option<usize>,
    /// Where labels are; filled at the first jump.
    labels: Option<BTreeMap<SmolStr, usize>>,
}

/// Where a top-level step ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StepEnd {
    /// The statement to go on with; the number of statements at the end.
    pub(crate) next: usize,
    /// One more than the highest statement index that was read.
    pub(crate) read_to: usize,
    /// The lowest statement index that was read.
    pub(crate) read_from: usize,
}

impl<'t> TopLevel<'t> {
    /// The statements of a file.
    pub(crate) fn new(tree: &'t SyntaxTree) -> Self {
        Self { tree, do_loops: Vec::new(), conditional: None, testing: None, labels: None }
    }

    /// Whether the statement with this index can begin a stretch of its own: no loop and no IF is open there.
    pub(crate) fn is_settled(&self, index: usize) -> bool {
        self.do_loops.is_empty() && self.conditional.as_ref().is_none_or(|open| open.is_before(index))
    }

    /// The index of the statement that carries a label.
    fn label(&mut self, label: &str) -> Option<usize> {
        let labels = self.labels.get_or_insert_with(|| {
            let mut labels = BTreeMap::new();
            for index in 0..self.tree.statement_count() {
                if let Some(label) = &self.tree.statement(index).parsed().statement.label {
                    labels.entry(normalised_label(&label.text)).or_insert(index);
                }
            }
            labels
        });
        labels.get(&normalised_label(label)).copied()
    }
}

impl Evaluator<'_> {
    /// Executes the top-level statement at `index` and all that it opens. The cards that a READ in it takes are passed
    /// over.
    pub(crate) fn step(&mut self, top: &mut TopLevel<'_>, index: usize) -> StepEnd {
        let cards = DataCards { tree: Some(top.tree.clone()), next: index + 1 };
        let outer = std::mem::replace(&mut self.cards, cards);
        let mut end = self.top_level_statement(top, index);
        self.leave_do_loops(&mut top.do_loops, end.next);
        let cards = std::mem::replace(&mut self.cards, outer);
        if cards.next > index + 1 && end.next > index {
            end.next = end.next.max(cards.next);
        }
        end.read_to = end.read_to.max(cards.next.min(top.tree.statement_count()));
        end
    }

    /// Executes a top-level statement; the cards behind it are not passed over.
    fn top_level_statement(&mut self, top: &mut TopLevel<'_>, index: usize) -> StepEnd {
        let count = top.tree.statement_count();
        let past = |next: usize| StepEnd { next, read_to: next.min(count), read_from: index };
        let shrink = BUDGET_SHRINK.saturating_pow(self.state.exhausted);
        if self.here.depth == 0 && self.here.region == Region::Top {
            let granted = self.options.statement_budget;
            self.budget = Budget::new((granted / shrink).max(LEAST_BUDGET.min(granted)));
        }
        self.here.isn = u32::try_from(index + 1).unwrap_or(u32::MAX);
        self.here.label = None;
        let original = top.tree.statement(index).parsed();
        let statement = self.state.without_synonyms(&original, &self.dialect);
        if !self.may_repeat(top, index) {
            return past(count);
        }
        if let Some(part) = statement.statement.parts.first() {
            match &part.body {
                Body::Macro { name, parameters, .. } => {
                    return past(self.top_level_macro(top, index, &statement, (name, parameters)));
                }
                Body::Major { word, .. }
                    if word.word.spelling == "LOOPST" && !self.dialect.branch_anywhere =>
                {
                    return past(self.top_level_loop(top, index, &statement, part.range));
                }
                Body::Do { label, index: variable, bounds, .. } => {
                    self.open_statement(&statement);
                    let header = DoHeader { label, index: variable, bounds, range: part.range };
                    let end = top.label(&label.text);
                    let crosses = end.is_some_and(|end| self.crosses_branches(top.tree, index, end));
                    self.open_do_loop(&header, index + 1, (end, crosses), &mut top.do_loops);
                    // That a label is missing depends on every statement.
                    let read_to = end.filter(|end| *end > index).map_or(count, |end| end + 1);
                    return StepEnd { next: index + 1, read_to, read_from: index };
                }
                _ => {}
            }
        }
        if let Some(end) = self.top_level_clause(top, index, &statement) {
            return end;
        }
        let flow = self.statement(&statement);
        match flow {
            Flow::Next => match self.continue_do_loops(&statement, &mut top.do_loops) {
                Some(next) => StepEnd { next, read_to: index + 1, read_from: index.min(next) },
                None => past(index + 1),
            },
            Flow::Jump(label) => {
                if self.dialect.branch_anywhere && blocks::always_jumps(&statement) {
                    self.report_unreachable(top.tree, index);
                }
                self.top_level_jump(top, index, &label)
            }
            Flow::Abort | Flow::Leave => past(index + 1),
            Flow::End => {
                let read_to = self.report_after_end(top.tree, index);
                StepEnd { next: count, read_to, read_from: index }
            }
        }
    }

    /// A macro with its text. The index to go on with.
    fn top_level_macro(
        &mut self,
        top: &TopLevel<'_>,
        index: usize,
        header: &ParsedStatement,
        (name, parameters): (&Name, &[MacroParameter]),
    ) -> usize {
        self.open_statement(header);
        let range = header.statement.parts.first().map_or(name.range, |part| part.range);
        let (body, next) = self.gather(top, index, "TERMAC", Some(name), range);
        // A header with a mistake does not tell the variables: nothing can be said of the text.
        if header.is_broken() {
            return next;
        }
        self.report_missing_labels(&body, &|text| {
            parameters.iter().any(|parameter| parameter.name.text == text)
        });
        self.trace_macro(&name.text, header, &body);
        self.define_macro(name, parameters, body);
        next
    }

    /// LOOPST with its loop, which is executed. The index to go on with.
    fn top_level_loop(
        &mut self,
        top: &TopLevel<'_>,
        index: usize,
        header: &ParsedStatement,
        range: TextRange,
    ) -> usize {
        self.open_statement(header);
        let (mut block, next) = self.gather(top, index, "LOOPND", None, range);
        if let Some(label) = &header.statement.label {
            block.name_beginning(&label.text);
        }
        self.report_missing_labels(&block, &|_| false);
        self.trace_loop(header, &block);
        self.cards.next = next;
        let frame = self.frame(FrameKind::Loop, SmolStr::default(), range);
        let bindings = Bindings::default();
        self.run_block(&Activation { block: &block, bindings, region: Region::Loop, frame });
        next
    }

    /// Labels that no statement of a loop or macro carries: a warning, which becomes an error when a jump leads there.
    fn report_missing_labels(&mut self, block: &Block, is_variable: &dyn Fn(&str) -> bool) {
        for (isn, label) in block.missing_labels(is_variable) {
            let similar = similar_names(&label.text, block.labels());
            let here = std::mem::replace(&mut self.here.isn, isn);
            let kind =
                FindingKind::Control(ControlFinding::UnknownLabel { name: label.text.clone(), similar });
            let mut finding = self.finding(kind, label.range);
            finding.severity = Severity::Warning;
            self.add(finding);
            self.here.isn = here;
        }
    }

    /// A statement without label after one that always jumps is never reached.
    fn report_unreachable(&mut self, tree: &SyntaxTree, jump: usize) {
        let Some((index, next)) = next_statement(tree, jump) else { return };
        let Some(part) = next.statement.parts.first() else { return };
        if next.statement.label.is_none() && blocks::wants_to_be_reached(part) {
            let isn = u32::try_from(index + 1).unwrap_or(u32::MAX);
            self.report_at(isn, FindingKind::Unreachable, part.range);
        }
    }

    /// The first statement after FINI gets a finding. Returns one more than the highest statement index that was read.
    fn report_after_end(&mut self, tree: &SyntaxTree, end: usize) -> usize {
        if self.is_included() || self.is_cl() {
            return end + 1;
        }
        let Some((index, next)) = next_statement(tree, end) else { return tree.statement_count() };
        let range = next.statement.parts.first().map_or(TextRange::default(), |part| part.range);
        let isn = u32::try_from(index + 1).unwrap_or(u32::MAX);
        self.report_at(isn, FindingKind::AfterEnd, range);
        index + 1
    }

    /// Whether a statement that is executed at the top level is one of a file that the program includes.
    fn is_included(&self) -> bool {
        around(self.here.frame.as_deref()).any(|frame| frame.kind != FrameKind::Loop)
    }

    /// Counts statements executed again at the top level; gives up when there are too many.
    fn may_repeat(&mut self, top: &TopLevel<'_>, index: usize) -> bool {
        let may_go_back = self.dialect.branch_anywhere || !top.do_loops.is_empty();
        if self.is_included() || !may_go_back {
            return true;
        }
        if index >= self.state.reached {
            self.state.reached = index + 1;
            return true;
        }
        self.state.repeated += 1;
        if self.state.repeated <= self.options.statement_budget {
            return !(self.state.repeated.is_multiple_of(BUDGET_SHRINK * BUDGET_SHRINK)
                && self.is_cancelled());
        }
        self.report_endless_program(top.tree, index);
        false
    }

    /// Executes the parts of a statement.
    pub(crate) fn statement(&mut self, statement: &ParsedStatement) -> Flow {
        self.open_statement(statement);
        for part in &statement.statement.parts {
            let (line, transfers) = (self.traced_lines(), self.output.transfers.len());
            self.trace_part(statement, part);
            if matches!(part.body, Body::Error) && blocks::says_motion(&statement.elements) {
                self.gap(part.range);
            }
            let flow = self.execute_part(part);
            self.trace_transfers(line, transfers);
            match flow {
                Flow::Next => {}
                other => return other,
            }
        }
        Flow::Next
    }

    /// Syntax errors and the label.
    pub(crate) fn open_statement(&mut self, statement: &ParsedStatement) {
        for error in &statement.errors {
            self.report(FindingKind::Syntax(error.kind.clone()), error.range);
        }
        if let Some(name) = &statement.spoiled
            && self.look_up(&name.text).is_none()
        {
            let origin = self.origin(name.range);
            self.set_symbol(name.text.clone(), Meaning::Poisoned, origin);
        }
        if let Some(label) = &statement.statement.label {
            self.open_label(label);
        }
    }

    /// A label: at the top level it is a name of the program.
    fn open_label(&mut self, label: &Name) {
        let text = normalised_label(&label.text);
        self.here.label = Some(text.clone());
        if self.here.region != Region::Top {
            return;
        }
        if !self.state.open_checks.is_empty() {
            self.state.open_checks.remove(&text);
        }
        let origin = self.origin(label.range);
        let existing = self.look_up(&text).map(|symbol| (symbol.meaning.clone(), symbol.origin.clone()));
        match existing {
            None => self.set_symbol(text, Meaning::Label, origin),
            Some((Meaning::Label, first))
                if first.isn != origin.isn || beside_loops(&first) != beside_loops(&origin) =>
            {
                let related = vec![(RelatedKind::Label, first)];
                self.report_related(
                    FindingKind::Control(ControlFinding::DuplicateLabel { name: text }),
                    label.range,
                    related,
                );
            }
            Some((Meaning::Label | Meaning::Poisoned, _)) => {}
            Some((_, first)) => {
                let related = vec![(RelatedKind::Definition, first)];
                self.report_related(
                    FindingKind::Control(ControlFinding::LabelIsName { name: text }),
                    label.range,
                    related,
                );
            }
        }
    }

    /// Collects the statements up to and with the closing word. Returns them and the index to go on with.
    fn gather(
        &mut self,
        top: &TopLevel<'_>,
        header: usize,
        closing: &str,
        macro_name: Option<&Name>,
        range: TextRange,
    ) -> (Block, usize) {
        let count = top.tree.statement_count();
        let opened_at = self.here.isn;
        let mut block = Block::new(opened_at.saturating_add(1), self.here.source.clone());
        let mut branches = BranchFinder::default();
        let mut index = header + 1;
        while index < count {
            let view = top.tree.statement(index);
            let original = view.parsed();
            let statement = self.state.without_synonyms(&original, &self.dialect);
            let word = blocks::single_word(&statement);
            let foreign_macro = macro_name.is_some() && blocks::is_macro_header(&statement);
            if word == Some("FINI") || foreign_macro {
                self.settle_branches(&mut block, branches);
                self.report_unclosed(index, &statement, opened_at, macro_name, foreign_macro, range);
                return (block, index);
            }
            self.push_to_block(&mut block, index, original, view.content_hash());
            branches.statement(index - header - 1, &statement);
            index += 1;
            if word == Some(closing) {
                self.settle_branches(&mut block, branches);
                for (isn, range) in block.unreachable() {
                    self.report_at(isn, FindingKind::Unreachable, range);
                }
                return (block, index);
            }
        }
        let (finding, opened) = match macro_name {
            Some(name) => {
                let finding = ControlFinding::MacroNotClosed { name: name.text.clone() };
                (finding, (RelatedKind::Macro, self.origin(name.range)))
            }
            None => (ControlFinding::LoopNotClosed, (RelatedKind::Loop, self.origin(range))),
        };
        self.report(FindingKind::Control(finding), range);
        // A file ends before the program that includes it.
        if self.here.source.is_none() {
            self.state.open_region = Some(opened);
        }
        self.settle_branches(&mut block, branches);
        (block, count)
    }

    /// Gives a block its branches, and reports what is wrong with them and with the jumps among them.
    fn settle_branches(&mut self, block: &mut Block, branches: BranchFinder) {
        block.branches = branches.finish(block.statements.len());
        let statement = |index: usize| Some((block.isn(index), Arc::clone(block.statements.get(index)?)));
        self.report_clause_faults(&block.branches, &statement);
        for (isn, label) in block.jumps_into_branches() {
            self.report_jump_into_branch(isn, &label);
        }
    }

    /// Adds a statement to a block; a label twice in it is reported.
    fn push_to_block(&mut self, block: &mut Block, index: usize, statement: Arc<ParsedStatement>, hash: u64) {
        let label = statement.statement.label.clone();
        if !block.push(statement, hash)
            && let Some(label) = label
        {
            let isn = u32::try_from(index + 1).unwrap_or(u32::MAX);
            self.report_at(
                isn,
                FindingKind::Control(ControlFinding::DuplicateLabel { name: label.text.clone() }),
                label.range,
            );
        }
    }

    /// FINI, or another macro header, where the closing word is missing: reported there, with the opening as evidence.
    fn report_unclosed(
        &mut self,
        index: usize,
        statement: &ParsedStatement,
        opened_at: u32,
        macro_name: Option<&Name>,
        foreign_macro: bool,
        range: TextRange,
    ) {
        let opening = self.origin(macro_name.map_or(range, |name| name.range));
        let kind = if macro_name.is_some() { RelatedKind::Macro } else { RelatedKind::Loop };
        self.here.isn = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let at = statement.statement.parts.first().map_or(TextRange::default(), |part| part.range);
        let finding = if foreign_macro {
            FindingKind::Control(ControlFinding::MacroInRegion)
        } else {
            FindingKind::Control(ControlFinding::EndInRegion)
        };
        self.report_related(finding, at, vec![(kind, opening)]);
        self.here.isn = opened_at;
    }

    /// A jump at the top level: only some dialects have it.
    fn top_level_jump(&mut self, top: &mut TopLevel<'_>, index: usize, label: &Name) -> StepEnd {
        let count = top.tree.statement_count();
        if !self.dialect.branch_anywhere {
            self.report(FindingKind::Control(ControlFinding::JumpOutsideRegion), label.range);
            return StepEnd { next: index + 1, read_to: index + 1, read_from: index };
        }
        let target = top.label(&label.text);
        if target.is_none() {
            let labels = top.labels.iter().flat_map(BTreeMap::keys).map(SmolStr::as_str);
            let similar = similar_names(&label.text, labels);
            self.report(
                FindingKind::Control(ControlFinding::UnknownLabel { name: label.text.clone(), similar }),
                label.range,
            );
        }
        let mut next = target.unwrap_or(index + 1);
        if self.skips_check_label(top, index, next) {
            // Only Section 2 can know whether the statements between are reached: it makes the jump.
            let text = normalised_label(&label.text);
            let origin = self.origin(label.range);
            self.output.transfers.push((text.clone(), origin));
            self.emit(RecordKind::Transfer(text), label.range);
            next = index + 1;
        }
        // Where labels are depends on every statement.
        StepEnd { next, read_to: count, read_from: index.min(next) }
    }

    /// Whether a statement that a check surface may lead to stands between a jump and its target.
    fn skips_check_label(&self, top: &mut TopLevel<'_>, index: usize, next: usize) -> bool {
        self.state.open_checks.iter().any(|open| top.label(open).is_some_and(|at| at > index && at < next))
    }

    /// Whether the program has ended without FINI, reported at its last statement.
    pub(crate) fn close_program(&mut self, tree: &SyntaxTree) {
        if self.state.ended || self.is_cl() || tree.statement_count() == 0 {
            return;
        }
        let last = tree.statement_count() - 1;
        self.here.isn = u32::try_from(last + 1).unwrap_or(u32::MAX);
        let parsed = tree.statement(last).parsed();
        let range = parsed.statement.parts.first().map_or(TextRange::default(), |part| part.range);
        self.break_pending(FindingKind::ImpliedCheckOpen, range);
        // Where jumps are free, an endless program never comes to its FINI.
        let stands_somewhere = self.dialect.branch_anywhere
            && (0..=last).any(|at| blocks::single_word(&tree.statement(at).parsed()) == Some("FINI"));
        if !stands_somewhere {
            let open_region = self.state.open_region.clone();
            self.report_related(FindingKind::EndMissing, range, open_region.into_iter().collect());
        }
        self.emit(RecordKind::End, range);
        self.state.ended = true;
    }
}

/// The next statement that is not blank or a comment, with its index.
fn next_statement(tree: &SyntaxTree, index: usize) -> Option<(usize, Arc<ParsedStatement>)> {
    (index + 1..tree.statement_count())
        .map(|next| (next, tree.statement(next).parsed()))
        .find(|(_, next)| !next.statement.parts.is_empty())
}

/// A frame and those around it.
fn around(frame: Option<&Frame>) -> impl Iterator<Item = &Frame> {
    std::iter::successors(frame, |frame| frame.parent.as_deref())
}

/// The frame of an origin without the turns of loops.
fn beside_loops(origin: &Origin) -> Option<&Frame> {
    around(origin.frame.as_deref()).find(|frame| frame.kind != FrameKind::Loop)
}

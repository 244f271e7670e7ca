//! Execution of a block: statements in order, jumps inside it, and the bounds that make it end.

use std::sync::Arc;

use apt_syntax::{
    ParsedStatement, TextRange,
    statement::{Body, Expression, Name, Reference},
};
use smol_str::SmolStr;

use super::{Bindings, Block};
use crate::{
    evaluator::{Evaluator, Flow, Here, Region},
    finding::{ControlFinding, FindingKind},
    record::{Frame, FrameKind},
    symbols::similar_names,
};

/// How often cancellation is asked for, in statements.
const CANCEL_INTERVAL: u64 = 256;

/// A DO loop in execution (APT4).
#[derive(Debug, Clone)]
pub(crate) struct DoLoop {
    /// The label of its last statement.
    pub(crate) label: SmolStr,
    /// The index variable.
    pub(crate) index: Reference,
    /// The last value.
    pub(crate) last: f64,
    /// The step, not zero.
    pub(crate) step: f64,
    /// Index of the first statement of the body.
    pub(crate) body: usize,
    /// Index of the statement that carries the label.
    pub(crate) end: usize,
    /// Its turn, and the frame around it.
    pub(crate) frame: Frame,
}

/// A DO statement.
pub(crate) struct DoHeader<'s> {
    /// The label of the last statement of the loop.
    pub(crate) label: &'s Name,
    /// The index variable.
    pub(crate) index: &'s Reference,
    /// First, last and perhaps step.
    pub(crate) bounds: &'s [Expression],
    /// The whole.
    pub(crate) range: TextRange,
}

/// What a block is executed as.
pub(crate) struct Activation<'b> {
    /// The statements.
    pub(crate) block: &'b Block,
    /// Macro variables.
    pub(crate) bindings: Bindings,
    /// Loop or macro.
    pub(crate) region: Region,
    /// The frame of its first turn.
    pub(crate) frame: Frame,
}

impl Evaluator<'_> {
    /// Executes a block. Where control goes afterwards is `Next`, or `Abort` when everything is to stop.
    pub(crate) fn run_block(&mut self, activation: &Activation<'_>) -> Flow {
        let outer = self.here.clone();
        let depth = outer.depth + u32::from(activation.region == Region::Macro);
        self.here = Here {
            isn: activation.frame.isn,
            frame: Some(Arc::new(activation.frame.clone())),
            source: activation.block.source.clone(),
            label: None,
            region: activation.region,
            depth,
        };
        if self.trace.is_some() {
            let statements = activation.block.statements.iter();
            let substituted: Vec<_> =
                statements.map(|statement| activation.bindings.apply(statement, &self.dialect)).collect();
            self.enter_region(substituted.iter().map(|statement| &**statement));
        }
        // A jump of Section 2 can name them, and is told when they carry no motion.
        self.output.inner_labels.extend(activation.block.labels().map(SmolStr::new));
        let flow = self.run_statements(activation);
        self.leave_region();
        self.here = outer;
        match flow {
            Flow::Abort => Flow::Abort,
            _ => Flow::Next,
        }
    }

    /// The statements of a block, jump by jump.
    fn run_statements(&mut self, activation: &Activation<'_>) -> Flow {
        let block = activation.block;
        let errors_before = self.errors;
        let mut parsed: Vec<Option<Arc<ParsedStatement>>> = vec![None; block.statements.len()];
        let mut do_loops: Vec<DoLoop> = Vec::new();
        let mut testing: Option<usize> = None;
        let mut jumps_after_error = 0_u32;
        let mut turn_start = self.output.definitions.len();
        let mut index = 0;
        while let Some(original) = block.statements.get(index) {
            self.here.isn = block.isn(index);
            if let Some(flow) = self.spend_budget(activation, index, turn_start) {
                return flow;
            }
            self.trace_remarks(original, None);
            let statement = parsed[index].get_or_insert_with(|| {
                let substituted = activation.bindings.apply(original, &self.dialect);
                self.state.without_synonyms(&substituted, &self.dialect)
            });
            let statement = Arc::clone(statement);
            let target = if let Some(next) = self.block_clause(&statement, (block, index), &mut testing) {
                self.continue_do_loops(&statement, &mut do_loops).or(Some(next))
            } else {
                match self.block_statement(&statement, (block, index), &mut do_loops) {
                    Flow::Next => self.continue_do_loops(&statement, &mut do_loops),
                    Flow::Jump(label) => self.block_label(activation, index, &label),
                    other => return other,
                }
            };
            let next = target.unwrap_or(index + 1);
            self.leave_do_loops(&mut do_loops, next);
            if next <= index {
                if self.errors > errors_before {
                    jumps_after_error += 1;
                    if jumps_after_error > self.options.jumps_after_error {
                        return Flow::Leave;
                    }
                }
                turn_start = self.output.definitions.len();
                // A DO loop counts its turns itself.
                if do_loops.is_empty() {
                    self.next_turn();
                }
            }
            if next != index + 1 {
                self.trace_heading(block, next);
            }
            index = next;
        }
        Flow::Next
    }

    /// One statement of a block; DO opens a loop.
    fn block_statement(
        &mut self,
        statement: &ParsedStatement,
        (block, index): (&Block, usize),
        do_loops: &mut Vec<DoLoop>,
    ) -> Flow {
        self.here.label =
            statement.statement.label.as_ref().map(|label| super::normalised_label(&label.text));
        if let Some(part) = statement.statement.parts.first()
            && let Body::Do { label, index: variable, bounds, .. } = &part.body
        {
            let header = DoHeader { label, index: variable, bounds, range: part.range };
            let end = block.label(&label.text);
            let crosses = end.is_some_and(|end| !block.branches.same_branch(index, end));
            self.open_do_loop(&header, index + 1, (end, crosses), do_loops);
            return Flow::Next;
        }
        // The words that close the block are its last statement.
        if matches!(super::single_word(statement), Some("LOOPND" | "TERMAC"))
            && self.here.region != Region::Top
            && (self.here.region == Region::Macro) == (super::single_word(statement) == Some("TERMAC"))
        {
            if self.here.region == Region::Loop {
                // Those of TERMAC were told where the macro was defined.
                for error in &statement.errors {
                    self.report(FindingKind::Syntax(error.kind.clone()), error.range);
                }
            }
            return Flow::Next;
        }
        self.statement(statement)
    }

    /// Counts the statement; gives up when the budget is exhausted or the work is cancelled.
    fn spend_budget(&mut self, activation: &Activation<'_>, index: usize, turn_start: usize) -> Option<Flow> {
        if self.budget.left == 0 {
            self.report_endless(activation, index, turn_start);
            return Some(Flow::Abort);
        }
        self.budget.left -= 1;
        if self.budget.left.is_multiple_of(CANCEL_INTERVAL) && self.is_cancelled() {
            return Some(Flow::Abort);
        }
        None
    }

    /// A backward jump: the frame gets the next turn number.
    fn next_turn(&mut self) {
        if let Some(frame) = &self.here.frame {
            let mut next = (**frame).clone();
            next.turn = next.turn.saturating_add(1);
            self.here.frame = Some(Arc::new(next));
        }
    }

    /// The statement that a jump leads to, or a finding that the label is not in this block.
    fn block_label(&mut self, activation: &Activation<'_>, from: usize, label: &Name) -> Option<usize> {
        let found = activation.block.label(&label.text);
        if found.is_none() {
            let similar = similar_names(&label.text, activation.block.labels());
            self.report(
                FindingKind::Control(ControlFinding::UnknownLabel { name: label.text.clone(), similar }),
                label.range,
            );
        }
        if found.is_some_and(|found| !activation.block.branches.may_jump(from, found)) {
            self.report_jump_into_branch(self.here.isn, label);
            return None;
        }
        found
    }

    /// DO: sets the index to the first value and opens the loop of statements `body` to `end`, which is none where no
    /// statement carries the label. `crosses` tells that the end stands in another branch of an IF than the DO.
    pub(crate) fn open_do_loop(
        &mut self,
        header: &DoHeader<'_>,
        body: usize,
        (end, crosses): (Option<usize>, bool),
        do_loops: &mut Vec<DoLoop>,
    ) {
        let values: Vec<Option<f64>> = header.bounds.iter().map(|bound| self.scalar(bound)).collect();
        let (first, last, step) = match *values.as_slice() {
            [first, last] => (first, last, Some(1.0)),
            [first, last, step] => (first, last, step),
            _ => (None, None, None),
        };
        self.assign_scalar(header.index, first);
        if let Some(first) = first {
            self.trace_index(header.index, first);
        }
        self.leave_do_loops(do_loops, body);
        let label = super::normalised_label(&header.label.text);
        let Some(end) = end.filter(|end| *end >= body) else {
            let finding =
                FindingKind::Control(ControlFinding::UnknownLabel { name: label, similar: Vec::new() });
            return self.report(finding, header.label.range);
        };
        if crosses {
            return self.report(
                FindingKind::Control(ControlFinding::LoopCrossesBranch { label }),
                header.label.range,
            );
        }
        if let Some(outer) = do_loops.last().filter(|outer| outer.end < end) {
            let finding =
                FindingKind::Control(ControlFinding::LoopsCross { label, outer: outer.label.clone() });
            return self.report(finding, header.label.range);
        }
        if step == Some(0.0) {
            return self.report(FindingKind::Control(ControlFinding::ZeroStep), header.range);
        }
        if let (Some(_), Some(last), Some(step)) = (first, last, step) {
            let frame = self.frame(FrameKind::Loop, SmolStr::default(), header.range);
            self.here.frame = Some(Arc::new(frame.clone()));
            do_loops.push(DoLoop { label, index: header.index.clone(), last, step, body, end, frame });
        }
    }

    /// After the last statement of a DO loop: the next value, or out of the loop.
    pub(crate) fn continue_do_loops(
        &mut self,
        statement: &ParsedStatement,
        do_loops: &mut Vec<DoLoop>,
    ) -> Option<usize> {
        let label = super::normalised_label(&statement.statement.label.as_ref()?.text);
        while let Some(innermost) = do_loops.last() {
            if innermost.label != label {
                return None;
            }
            let innermost = innermost.clone();
            let crate::expression::Resolved::Scalar(value) = self.resolve(&innermost.index)? else {
                return None;
            };
            let next = value + innermost.step;
            let past = if innermost.step > 0.0 { next > innermost.last } else { next < innermost.last };
            if !past {
                self.assign_scalar(&innermost.index, Some(next));
                self.trace_index(&innermost.index, next);
                if let Some(open) = do_loops.last_mut() {
                    open.frame.turn = open.frame.turn.saturating_add(1);
                    self.here.frame = Some(Arc::new(open.frame.clone()));
                }
                return Some(innermost.body);
            }
            self.here.frame.clone_from(&innermost.frame.parent);
            do_loops.pop();
        }
        None
    }

    /// Forgets the loops that a statement stands outside of: a jump has left them.
    pub(crate) fn leave_do_loops(&mut self, do_loops: &mut Vec<DoLoop>, index: usize) {
        // A loop that is left is left with all that stand inside of it.
        let left = do_loops.iter().position(|open| !(open.body..=open.end).contains(&index));
        if let Some(outermost) = left.and_then(|left| do_loops.drain(left..).next()) {
            self.here.frame = outermost.frame.parent;
        }
    }

    /// A frame around the statement being executed.
    pub(crate) fn frame(&self, kind: FrameKind, name: SmolStr, range: TextRange) -> Frame {
        let (parent, source) = (self.here.frame.clone(), self.here.source.clone());
        Frame { kind, name, isn: self.here.isn, range, turn: 1, parent, source }
    }
}

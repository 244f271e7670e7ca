//! What each statement does.

mod declaration;
mod definition;
mod listing;
mod motion;
mod parameter;
mod pattern;
mod pocket;
mod postprocessor;
mod tool_axis;
mod transformation;

use apt_syntax::{
    TextRange,
    statement::{Argument, Body, Name, Part, WordUse},
    vocabulary::WordClass,
};
use smol_str::SmolStr;

use crate::{
    evaluator::{Evaluator, Flow, Region},
    expression::Items,
    finding::{Expected, FindingKind, Found},
    record::RecordKind,
};

/// A major word with its parameters.
#[derive(Clone, Copy)]
pub(crate) struct Major<'a> {
    /// The word.
    pub(crate) word: &'a WordUse,
    /// Whether a slash follows.
    pub(crate) slash: bool,
    /// The parameters.
    pub(crate) arguments: &'a [Argument],
    /// The whole part.
    pub(crate) range: TextRange,
}

impl Major<'_> {
    /// The spelling of the word.
    pub(crate) fn spelling(&self) -> &'static str {
        self.word.word.spelling
    }

    /// The word as evidence.
    pub(crate) fn name(&self) -> SmolStr {
        SmolStr::new_static(self.word.word.spelling)
    }
}

impl Evaluator<'_> {
    /// Executes one part of a statement. MACRO and LOOPST at the top level are handled before this.
    pub(crate) fn execute_part(&mut self, part: &Part) -> Flow {
        match &part.body {
            Body::Text { word, text, .. } => self.text_statement(word, text, part.range),
            Body::Assignment { target, value } => self.assignment(target, value),
            Body::Definition { target, definition } => self.definition(target, definition),
            Body::Macro { word, .. } => self.report(FindingKind::MacroInRegion, word.range),
            Body::Call { name, arguments, section, .. } => {
                return self.call(name, arguments, section.as_ref(), part.range);
            }
            Body::ArithmeticIf { condition, labels, .. } => {
                if let Some(value) = self.scalar(condition) {
                    let index = if value < 0.0 { 0 } else { 1 + usize::from(value > 0.0) };
                    return Flow::Jump(labels[index].clone());
                }
            }
            Body::LogicalIf { condition, then, .. } => {
                if self.condition(condition) == Some(true) {
                    return self.execute_part(then);
                }
            }
            Body::Do { word, .. } => {
                self.report(FindingKind::NotInDialect { word: SmolStr::new_static("DO") }, word.range);
            }
            Body::Jump { word, label } => return self.jump_statement(word, label, part.range),
            Body::Major { word, slash, arguments } => {
                return self.major(Major { word, slash: *slash, arguments, range: part.range });
            }
            Body::UnknownMajor { name, arguments, .. } => self.unknown_word(name, arguments, part.range),
            Body::Obtain { kind, arguments, word } => self.obtain(word, kind, arguments, part.range),
            Body::Error => {}
        }
        Flow::Next
    }

    /// JUMPTO and TRANTO.
    fn jump_statement(&mut self, word: &WordUse, label: &Name, range: TextRange) -> Flow {
        if word.word.spelling != "TRANTO" {
            return Flow::Jump(label.clone());
        }
        let text = crate::blocks::normalised_label(&label.text);
        let origin = self.origin(label.range);
        self.output.transfers.push((text.clone(), origin));
        self.emit(RecordKind::Transfer(text), range);
        Flow::Next
    }

    /// Any other major word.
    fn major(&mut self, major: Major<'_>) -> Flow {
        match major.spelling() {
            "GOTO" | "FROM" => self.go_to(major),
            "GODLTA" => self.go_delta(major),
            "GOLFT" | "GORGT" | "GOFWD" | "GOBACK" | "GOUP" | "GODOWN" => self.directed_motion(major),
            "GO" | "OFFSET" => self.start_up(major),
            "INDIRV" | "INDIRP" => self.indirect_direction(major),
            "SRFVCT" => self.surface_vectors(major),
            "TLLFT" | "TLRGT" | "TLON" | "TLNDON" | "TLONPS" | "TLOFPS" => self.tool_position(major),
            "PSIS" => self.part_surface(major),
            "POCKET" => self.pocket(major),
            "TLAXIS" => self.tool_axis(major),
            "CUTTER" => self.cutter(major),
            "INTOL" | "OUTTOL" | "TOLER" | "THICK" => self.per_role(major),
            "MAXDP" | "NUMPTS" => self.limit(major),
            "CUT" | "DNTCUT" | "2DCALC" | "3DCALC" | "NDTEST" | "AUTOPS" | "NOPS" | "MULTAX" | "GOUGCK" => {
                self.path_control(major);
            }
            "DMILL" | "BEVELS" => self.accepted_control(major),
            "ZSURF" => self.z_surface(major),
            "REFSYS" => self.reference_system(major),
            "CANON" => self.canon_switch(major),
            "RESERV" => self.reserve(major),
            "SYN" => self.synonyms(major),
            "TRACUT" => self.cut_transformation(major),
            "INDEX" => self.index(major),
            "COPY" => self.copy(major),
            "PRINT" | "PUNCH" | "READ" | "TITLES" => self.listing(major),
            "FINI" => return self.end(major),
            "LOOPST" => return self.loop_word_in_region(major, true),
            "LOOPND" => return self.loop_word_in_region(major, false),
            "TERMAC" => self.report(FindingKind::MacroEndAlone, major.word.range),
            "INCLUD" => return self.include(major),
            "MACHIN" => self.machine(major),
            "LIBRY" => self.library(major),
            _ => self.other_major(major),
        }
        Flow::Next
    }

    /// Words that are told apart by their class only.
    fn other_major(&mut self, major: Major<'_>) {
        match major.word.word.class {
            WordClass::SystemFlag => self.system_flag(major),
            WordClass::PostprocessorBare | WordClass::Postprocessor => self.postprocessor(major),
            _ if self.is_cl() => self.postprocessor(major),
            WordClass::Logic if major.spelling() == "CONTIN" => {}
            _ => self.report(FindingKind::NotInDialect { word: major.name() }, major.word.range),
        }
    }

    /// FINI.
    fn end(&mut self, major: Major<'_>) -> Flow {
        if self.here.region != Region::Top {
            self.report(FindingKind::EndInRegion, major.word.range);
            return Flow::Next;
        }
        self.break_pending(FindingKind::ImpliedCheckOpen, major.range);
        self.emit(RecordKind::End, major.range);
        self.state.ended = true;
        Flow::End
    }

    /// LOOPST and LOOPND where no loop can begin or end.
    fn loop_word_in_region(&mut self, major: Major<'_>, start: bool) -> Flow {
        if self.dialect.branch_anywhere {
            return Flow::Next;
        }
        let finding = match (self.here.region, start) {
            (Region::Macro, _) => FindingKind::LoopInMacro,
            (Region::Loop, true) => FindingKind::NestedLoop,
            (_, _) => FindingKind::LoopEndAlone,
        };
        self.report(finding, major.word.range);
        Flow::Next
    }

    /// Operands of a statement; an empty list is reported with this number and expectation.
    pub(crate) fn operands_of(
        &mut self,
        major: Major<'_>,
        expected: &'static str,
        number: u16,
    ) -> Option<Items> {
        let items = self.operands(major.arguments)?;
        if items.is_empty() {
            self.wrong_count(major, 0, expected, number);
            return None;
        }
        Some(items)
    }

    /// Reports a wrong number of operands.
    pub(crate) fn wrong_count(
        &mut self,
        major: Major<'_>,
        found: usize,
        expected: &'static str,
        number: u16,
    ) {
        let finding = FindingKind::OperandCount {
            statement: major.name(),
            found,
            expected: SmolStr::new_static(expected),
            number,
        };
        self.report(finding, major.range);
    }

    /// Reports an operand of the wrong kind.
    pub(crate) fn wrong_operand(
        &mut self,
        major: Major<'_>,
        expected: Expected,
        found: Found,
        number: u16,
        range: TextRange,
    ) {
        let finding = FindingKind::Operand { statement: major.name(), expected, found, number };
        self.report(finding, range);
    }

    /// All operands as numbers, or a finding with this number.
    pub(crate) fn scalars_of(&mut self, major: Major<'_>, items: &Items, number: u16) -> Option<Vec<f64>> {
        let mut values = Vec::with_capacity(items.len());
        for item in items {
            match item.scalar() {
                Some(value) => values.push(value),
                None => {
                    self.wrong_operand(major, Expected::Scalar, item.found(), number, item.range);
                    return None;
                }
            }
        }
        Some(values)
    }
}

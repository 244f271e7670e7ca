//! What each statement does.

mod declaration;
mod definition;
mod doubtful;
mod library;
mod listing;
mod motion;
mod parameter;
mod pattern;
mod pocket;
mod postprocessor;
mod sculptured;
mod system_flag;
mod tool_axis;
mod transformation;

use apt_syntax::{
    TextRange,
    statement::{Argument, Body, Expression, Name, Part, WordUse},
    vocabulary::WordClass,
};
use smol_str::SmolStr;

pub(crate) use library::segment;
pub(crate) use sculptured::RegionalState;

use crate::{
    evaluator::{Evaluator, Flow, Region},
    expression::Items,
    finding::{ControlFinding, Expected, FindingKind, Found},
    record::{Record, RecordKind},
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

/// APT III: the condition of an IF is no number (language reference 9.2).
const CONDITION_NOT_SCALAR: u16 = 402;

/// Whether a statement with this word moves the tool, or decides how it moves.
pub(crate) fn leaves_motion(word: &str) -> bool {
    matches!(
        word,
        "FROM"
            | "GOTO"
            | "GODLTA"
            | "GO"
            | "OFFSET"
            | "GOLFT"
            | "GORGT"
            | "GOFWD"
            | "GOBACK"
            | "GOUP"
            | "GODOWN"
            | "POCKET"
            | "SMIL"
            | "GOMILL"
            | "GCLEAR"
            | "PSIS"
            | "TLAXIS"
            | "CUTTER"
    )
}

impl Evaluator<'_> {
    /// Executes one part of a statement. MACRO and LOOPST at the top level are handled before this.
    pub(crate) fn execute_part(&mut self, part: &Part) -> Flow {
        match &part.body {
            Body::Text { word, text, .. } => self.text_statement(word, text, part.range),
            Body::Assignment { target, value } => self.assignment(target, value),
            Body::Definition { target, definition } => self.definition(target, definition),
            Body::Macro { word, .. } => {
                self.report(FindingKind::Control(ControlFinding::MacroInRegion), word.range);
            }
            Body::Call { name, arguments, section, .. } => {
                return self.call(name, arguments, section.as_ref(), part.range);
            }
            Body::ArithmeticIf { condition, labels, .. } => {
                if let Some(value) = self.deciding_value(condition) {
                    let index = if value < 0.0 { 0 } else { 1 + usize::from(value > 0.0) };
                    return Flow::Jump(labels[index].clone());
                }
            }
            Body::LogicalIf { condition, then, .. } => {
                return match self.condition(condition) {
                    Some(true) => self.conditional_parts(then),
                    Some(false) => Flow::Next,
                    None => {
                        let moves = |part: &Part| matches!(&part.body, Body::Major { word, .. } if leaves_motion(word.word.spelling));
                        if then.iter().any(moves) {
                            self.gap(part.range);
                        }
                        Flow::Next
                    }
                };
            }
            // Where the branches are is known before anything is executed: these belong to none.
            Body::Clause { word, .. } => {
                let word = SmolStr::new_static(word.word.spelling);
                self.report(FindingKind::Control(ControlFinding::ClauseWithoutIf { word }), part.range);
            }
            Body::Do { word, .. } => {
                self.report(
                    FindingKind::Control(ControlFinding::NotInDialect { word: SmolStr::new_static("DO") }),
                    word.range,
                );
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

    /// What a logical IF lets happen.
    fn conditional_parts(&mut self, parts: &[Part]) -> Flow {
        let elements = self.traced_elements();
        for part in parts {
            self.trace_conditional(part, &elements);
            match self.execute_part(part) {
                Flow::Next => {}
                other => return other,
            }
        }
        Flow::Next
    }

    /// The number that decides a branch; geometry by its name is told apart from geometry in an expression.
    fn deciding_value(&mut self, condition: &Expression) -> Option<f64> {
        let reference = Self::plain_reference(condition);
        let name = reference.filter(|reference| reference.subscript.is_none()).map(|one| &one.name.text);
        if let (Some(name), Some(reference)) = (name, reference)
            && let Found::Geometry(kind) = self.found_name(name)
        {
            let mut finding =
                self.finding(FindingKind::GeometryAsScalar { name: name.clone(), kind }, reference.range);
            if !self.is_apt4() {
                finding.number = Some(CONDITION_NOT_SCALAR);
            }
            self.add(finding);
            return None;
        }
        self.scalar(condition)
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

    /// Any other major word. Where a motion is missing because of an error, a gap takes its place.
    fn major(&mut self, major: Major<'_>) -> Flow {
        let records = self.output.records.len();
        let failures = self.errors + self.unknown_values;
        let flow = self.major_word(major);
        let failed = self.errors + self.unknown_values > failures;
        if failed && leaves_motion(major.spelling()) {
            let moves =
                |record: &Record| matches!(record.kind, RecordKind::Motion(_) | RecordKind::Regional(_));
            let new = &self.output.records;
            if !(records..new.len()).filter_map(|at| new.get(at)).any(moves) {
                self.gap(major.range);
            }
        }
        flow
    }

    /// Reports a statement that no macro can contain, whether the macro is called or not.
    pub(crate) fn refuse_in_macro(&mut self, part: &Part) {
        let Body::Major { word, slash, arguments } = &part.body else { return };
        let refused = match word.word.spelling {
            "LOOPST" | "LOOPND" | "RESERV" | "SYN" => true,
            "READ" => segment(arguments).is_some(),
            _ => false,
        };
        if refused {
            // In a macro these statements do nothing but say that they cannot stand there.
            let outer = std::mem::replace(&mut self.here.region, Region::Macro);
            self.major_word(Major { word, slash: *slash, arguments, range: part.range });
            self.here.region = outer;
        }
    }

    /// Notes that a motion is missing here.
    pub(crate) fn gap(&mut self, range: TextRange) {
        self.emit(RecordKind::Gap, range);
    }

    /// What a major word does.
    fn major_word(&mut self, major: Major<'_>) -> Flow {
        let counts = matches!(
            major.word.word.class,
            WordClass::Motion
                | WordClass::PathParameter
                | WordClass::PathControl
                | WordClass::ToolPosition
                | WordClass::Transformation
        );
        if counts && major.spelling() != "GOTO" && self.refuse_inclusive(major.arguments).is_none() {
            return Flow::Next;
        }
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
            "CUT" | "DNTCUT" | "2DCALC" | "3DCALC" | "NDTEST" | "AUTOPS" | "NOPS" | "MULTAX" => {
                self.path_control(major);
            }
            "GOUGCK" => self.gouge_check(major),
            "DMILL" | "BEVELS" => self.accepted_control(major),
            "SCON" => self.condition_statement(major),
            "SMIL" => self.regional_milling(major),
            "CHKSRF" => self.checked_surface(major),
            "AVCTRL" => self.avoidance_control(major),
            "GOMILL" | "GCLEAR" | "INTSEC" => self.undocumented_milling(major),
            "ZSURF" => self.z_surface(major),
            "REFSYS" => self.reference_system(major),
            "CANON" => self.canon_switch(major),
            "RESERV" => self.reserve(major),
            "SYN" => self.synonyms(major),
            // A CL file is what Section 3 has made: there they tell how its positions came about, and move nothing again.
            "TRACUT" | "INDEX" | "COPY" if self.is_cl() => self.postprocessor(major),
            "TRACUT" => self.cut_transformation(major),
            "INDEX" => self.index(major),
            "COPY" => self.copy(major),
            "PRINT" | "PUNCH" | "READ" | "TITLES" => return self.listing(major),
            "FINI" => return self.end(major),
            "LOOPST" => return self.loop_word_in_region(major, true),
            "LOOPND" => return self.loop_word_in_region(major, false),
            "TERMAC" => self.report(FindingKind::Control(ControlFinding::MacroEndAlone), major.word.range),
            "INCLUD" => return self.include(major),
            "MACHIN" => self.machine(major),
            "LIBRY" => return self.library(major),
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
            _ => self.report(
                FindingKind::Control(ControlFinding::NotInDialect { word: major.name() }),
                major.word.range,
            ),
        }
    }

    /// FINI.
    fn end(&mut self, major: Major<'_>) -> Flow {
        if self.here.region != Region::Top {
            self.report(FindingKind::Control(ControlFinding::EndInRegion), major.word.range);
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
            (Region::Macro, _) => FindingKind::Control(ControlFinding::LoopInMacro),
            (Region::Loop, true) => FindingKind::Control(ControlFinding::NestedLoop),
            (_, _) => FindingKind::Control(ControlFinding::LoopEndAlone),
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

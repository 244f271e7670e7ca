//! The statements executed, for an expansion.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use apt_geometry::pieces::Pieces;
use apt_syntax::{
    ParsedStatement, TextRange,
    statement::{Body, Element, ElementKind, Part, Reference},
};
use smol_str::{SmolStr, format_smolstr};

use super::{Evaluator, Region};
use crate::{
    blocks::{Block, is_target, normalised_label, splice},
    record::{Frame, Origin, SourceFile},
    statements::segment,
    symbols::Meaning,
};

/// Collects executed statements.
#[derive(Debug, Default)]
pub(crate) struct Trace {
    /// The statements in order of execution.
    pub(crate) lines: Pieces<TracedLine>,
    /// Only what the statement of the program with this number executes.
    pub(crate) at: Option<u32>,
    /// How many levels of calls, loops and inclusions are opened; what lies deeper stands as it is written.
    pub(crate) depth: Option<u32>,
    /// Names that the regions being executed assign to, the innermost last: their values are shown.
    varying: Vec<BTreeSet<SmolStr>>,
    /// Labels that stand before a line already.
    labels: BTreeSet<SmolStr>,
    /// The elements of the statement being executed.
    elements: Vec<Element>,
    /// What keeps the labels of loops and macros apart once they are unrolled.
    region_labels: RegionLabels,
    /// Whether statements of loops and macros that carry remarks are noted, too.
    with_remarks: bool,
}

/// Labels inside of loops and macros at which Section 2 may go on: each turn and each call has its own, so in an unrolled
/// program each needs a name of its own.
#[derive(Debug, Default)]
pub(crate) struct RegionLabels {
    /// How often each label stands in the program.
    labels: BTreeMap<SmolStr, u32>,
    /// All names of the program: no new label is one of them.
    names: BTreeSet<SmolStr>,
    /// The labels that statements still to come will carry, by how deep the call is and what they are called there.
    open: BTreeMap<(u32, SmolStr), SmolStr>,
    /// How many new labels have been made.
    made: u32,
}

impl RegionLabels {
    /// Looks at a statement of the program.
    pub(crate) fn statement(&mut self, statement: &ParsedStatement) {
        if let Some(label) = &statement.statement.label {
            let count = self.labels.entry(normalised_label(&label.text)).or_default();
            *count = count.saturating_add(1);
        }
        let names = statement.elements.iter().filter(|element| element.kind == ElementKind::Name);
        self.names.extend(names.map(|element| element.text.clone()));
    }

    /// What the label that a statement leads to is called in the unrolled program.
    fn open(&mut self, depth: u32, label: &SmolStr, emitted: &BTreeSet<SmolStr>) -> SmolStr {
        if let Some(name) = self.open.get(&(depth, label.clone())) {
            return name.clone();
        }
        let is_taken = emitted.contains(label) || self.labels.get(label).is_some_and(|count| *count > 1);
        let name = if is_taken { self.fresh() } else { label.clone() };
        self.open.insert((depth, label.clone()), name.clone());
        name
    }

    fn fresh(&mut self) -> SmolStr {
        // The program has finitely many names, so one of the next is free.
        loop {
            self.made = self.made.saturating_add(1);
            let name = format_smolstr!("ZL{:04}", self.made);
            if !self.names.contains(&name) || self.made == u32::MAX {
                return name;
            }
        }
    }
}

/// One executed statement, or one that stands as it is written.
#[derive(Debug, Clone)]
pub(crate) struct TracedLine {
    /// Its elements after substitution.
    pub(crate) elements: Vec<Element>,
    /// Where it comes from.
    pub(crate) origin: Origin,
    /// The macro whose definition it belongs to.
    pub(crate) definition_of: Option<SmolStr>,
    /// Whether it stands for the remarks of the statement alone. What the statement does has lines of its own.
    pub(crate) is_remark: bool,
}

impl Trace {
    /// A trace that keeps what is wanted.
    pub(crate) fn new(
        at: Option<u32>,
        depth: Option<u32>,
        with_remarks: bool,
        region_labels: RegionLabels,
    ) -> Self {
        Self { at, depth, with_remarks, region_labels, ..Self::default() }
    }

    /// How many levels a place lies inside of what is expanded; nothing if it does not belong to that.
    fn nesting(&self, isn: u32, source: Option<&Arc<SourceFile>>, frame: Option<&Frame>) -> Option<u32> {
        if self.at.is_some_and(|at| at == isn && source.is_none()) {
            return Some(0);
        }
        let mut nesting = 0;
        let mut around = frame;
        while let Some(frame) = around {
            nesting += 1;
            if self.at.is_some_and(|at| at == frame.isn && frame.source.is_none()) {
                return Some(nesting);
            }
            around = frame.parent.as_deref();
        }
        self.at.is_none().then_some(nesting)
    }

    fn varies(&self, name: &str) -> bool {
        self.varying.iter().any(|names| names.contains(name))
    }
}

impl Evaluator<'_> {
    /// How many levels the place being executed lies inside of what is expanded; nothing if no trace wants it.
    fn traced_nesting(&self) -> Option<u32> {
        let trace = self.trace.as_ref()?;
        let nesting = trace.nesting(self.here.isn, self.here.source.as_ref(), self.here.frame.as_deref())?;
        trace.depth.is_none_or(|depth| nesting <= depth).then_some(nesting)
    }

    /// Whether what a statement here opens stays closed.
    fn stays_closed(&self) -> bool {
        let depth = self.trace.as_ref().and_then(|trace| trace.depth);
        depth.is_some() && self.traced_nesting() == depth
    }

    /// Notes an executed part; jumps and the words that open and close regions leave no line.
    pub(crate) fn trace_part(&mut self, statement: &ParsedStatement, part: &Part) {
        let Some(trace) = &mut self.trace else { return };
        let labelled = matches!(
            statement.elements.get(1).map(|element| element.kind),
            Some(ElementKind::RightParenthesis)
        );
        let parts: &[Element] = match statement.elements.as_slice() {
            [_, _, rest @ ..] if labelled => rest,
            all => all,
        };
        trace.elements = if statement.statement.parts.len() == 1 {
            parts.to_vec()
        } else {
            parts.iter().filter(|element| part.range.contains_range(element.range)).cloned().collect()
        };
        let label = statement.elements.get(..2).filter(|_| labelled).map(<[_]>::to_vec);
        self.trace_body(part, label);
    }

    /// The elements of the part that is noted.
    pub(crate) fn traced_elements(&self) -> Vec<Element> {
        self.trace.as_ref().map(|trace| trace.elements.clone()).unwrap_or_default()
    }

    /// Notes a part, with these elements among others, that a logical IF lets happen.
    pub(crate) fn trace_conditional(&mut self, part: &Part, elements: &[Element]) {
        let Some(trace) = &mut self.trace else { return };
        let is_of_part = |element: &&Element| part.range.contains_range(element.range);
        trace.elements = elements.iter().filter(is_of_part).cloned().collect();
        self.trace_body(part, None);
    }

    /// Notes a part whose elements the trace holds.
    fn trace_body(&mut self, part: &Part, label: Option<Vec<Element>>) {
        if self.traced_nesting().is_none() || !self.leaves_line(&part.body) {
            return;
        }
        let mut elements = self.with_values(&part.body);
        let origin = self.origin(part.range);
        let (top, depth) = (self.here.region == Region::Top, self.here.depth);
        let Some(trace) = &mut self.trace else { return };
        // Section 2 may go on at a label of the top level. Inside of regions most labels served the jumps only.
        if let Some(mut label) = label
            && let Some(name) = label.first_mut()
        {
            let open = trace.region_labels.open.remove(&(depth, normalised_label(&name.text)));
            let stays = top || open.is_some();
            name.text = open.unwrap_or_else(|| name.text.clone());
            if stays && trace.labels.insert(name.text.clone()) {
                label.append(&mut elements);
                elements = label;
            }
        }
        trace.lines.push(TracedLine { elements, origin, definition_of: None, is_remark: false });
    }

    /// Notes that a statement of a loop or macro with remarks is executed, before what it does: a line of remarks does nothing,
    /// and jumps leave no other line.
    pub(crate) fn trace_remarks(&mut self, statement: &ParsedStatement, definition_of: Option<&SmolStr>) {
        let wanted = self.trace.as_ref().is_some_and(|trace| trace.with_remarks);
        let Some(first) = statement.comments.first().filter(|_| wanted) else { return };
        if self.traced_nesting().is_none() {
            return;
        }
        let origin = self.origin(*first);
        if let Some(trace) = &mut self.trace {
            let definition_of = definition_of.cloned();
            trace.lines.push(TracedLine { elements: Vec::new(), origin, definition_of, is_remark: true });
        }
    }

    /// Notes the lines of remarks right before a statement of a block that control jumps to: they are about it.
    pub(crate) fn trace_heading(&mut self, block: &Block, target: usize) {
        if !self.trace.as_ref().is_some_and(|trace| trace.with_remarks) {
            return;
        }
        let before = block.statements.get(..target).unwrap_or_default();
        let is_remark = |one: &&Arc<ParsedStatement>| one.elements.is_empty() && !one.comments.is_empty();
        let count = before.iter().rev().take_while(is_remark).count();
        for (index, statement) in before.iter().enumerate().skip(target.saturating_sub(count)) {
            self.here.isn = block.isn(index);
            self.trace_remarks(statement, None);
        }
    }

    /// How many lines there are.
    pub(crate) fn traced_lines(&self) -> usize {
        self.trace.as_ref().map_or(0, |trace| trace.lines.len())
    }

    /// Gives the labels that a statement of a loop or macro leads to the names that they have in the unrolled program. The
    /// statement made the line with this index, if any, and the transfers from `first` on.
    pub(crate) fn trace_transfers(&mut self, line: usize, first: usize) {
        if self.trace.is_none() || self.here.region == Region::Top {
            return;
        }
        let (depth, isn) = (self.here.depth, self.here.isn);
        let transfers = self.output.transfers.get(first..).unwrap_or_default();
        let own = transfers.iter().filter(|(_, origin)| origin.isn == isn && origin.frame == self.here.frame);
        let Some(trace) = &mut self.trace else { return };
        let Some(line) = trace.lines.get_mut(line) else { return };
        for (label, origin) in own {
            let name = trace.region_labels.open(depth, label, &trace.labels);
            let places = line.elements.iter_mut().filter(|element| element.range == origin.range);
            places.for_each(|element| element.text = name.clone());
        }
    }

    /// Whether a part stands in an expansion.
    fn leaves_line(&self, body: &Body) -> bool {
        match body {
            Body::Call { section, .. } => section.is_some() || self.stays_closed(),
            Body::ArithmeticIf { .. }
            | Body::LogicalIf { .. }
            | Body::Clause { .. }
            | Body::Do { .. }
            | Body::Macro { .. }
            | Body::Error => false,
            Body::Jump { word, .. } => word.word.spelling == "TRANTO",
            Body::Major { word, arguments, .. } => match word.word.spelling {
                "LOOPST" | "LOOPND" | "TERMAC" | "CONTIN" => false,
                "INCLUD" | "LIBRY" => self.stays_closed(),
                "READ" if segment(arguments).is_some() => self.stays_closed(),
                _ => true,
            },
            _ => true,
        }
    }

    /// The elements of the part with the values of the names that the regions around it assign to.
    fn with_values(&self, body: &Body) -> Vec<Element> {
        let Some(trace) = &self.trace else { return Vec::new() };
        let elements = &trace.elements;
        let takes_values = match body {
            Body::Assignment { .. } | Body::Definition { .. } | Body::Call { .. } => true,
            // These have names for operands, not their values.
            Body::Major { word, .. } => !matches!(
                word.word.spelling,
                "PRINT" | "PUNCH" | "READ" | "SYN" | "RESERV" | "INCLUD" | "LIBRY"
            ),
            _ => false,
        };
        if !takes_values || trace.varying.is_empty() {
            return elements.clone();
        }
        // A name that gets its value inside of the statement may have another one in each of its places.
        let assigned_inside = |name: &str| {
            let mut targets = (0..elements.len()).filter(|&index| is_target(elements, index));
            targets.any(|index| index > 0 && elements[index].text == name)
        };
        let kept_names = self.names_handed_over(body);
        let mut shown = Vec::with_capacity(elements.len());
        for (index, element) in elements.iter().enumerate() {
            let is_value = element.kind == ElementKind::Name
                && trace.varies(&element.text)
                && !is_target(elements, index)
                && !assigned_inside(&element.text)
                && !kept_names.contains(&element.text);
            let meaning = self.state.symbol(&element.text).map(|symbol| &symbol.meaning);
            match meaning {
                Some(Meaning::Scalar(value)) if is_value && value.is_finite() => {
                    let around = |index: Option<usize>| Some(elements.get(index?)?.kind);
                    let neighbours = (around(index.checked_sub(1)), around(index.checked_add(1)));
                    match number_elements(*value, element.range, self.dialect.number_digits) {
                        Some(number) => splice(&mut shown, element, &number, neighbours, false),
                        // The statement that gave it its value stands in the expansion too.
                        None => shown.push(element.clone()),
                    }
                }
                _ => shown.push(element.clone()),
            }
        }
        shown
    }

    /// Names in a CALL that the macro may assign to: they are handed over by name.
    fn names_handed_over(&self, body: &Body) -> BTreeSet<SmolStr> {
        let Body::Call { name, arguments, .. } = body else { return BTreeSet::new() };
        let definition = match self.state.symbol(&name.text).map(|symbol| &symbol.meaning) {
            Some(Meaning::Macro(definition)) => Some(definition),
            _ => None,
        };
        let by_name = |variable: &str| definition.is_none_or(|one| one.body.may_assign(variable));
        let handed = arguments.iter().filter(|argument| by_name(&argument.name.text));
        handed
            .filter_map(|argument| argument.value.as_ref())
            .flatten()
            .map(|element| element.text.clone())
            .collect()
    }

    /// The names that a region assigns to show their values until [`Evaluator::leave_region`].
    pub(crate) fn enter_region<'s>(&mut self, statements: impl Iterator<Item = &'s ParsedStatement>) {
        if self.trace.is_some() {
            self.enter_names(statements.flat_map(assigned_names).collect());
        }
    }

    /// The same of a region that assigns to these names.
    pub(crate) fn enter_names(&mut self, names: BTreeSet<SmolStr>) {
        if let Some(trace) = &mut self.trace {
            trace.varying.push(names);
        }
    }

    /// The region has been executed.
    pub(crate) fn leave_region(&mut self) {
        if let Some(trace) = &mut self.trace {
            trace.varying.pop();
        }
    }

    /// Notes a loop that stays closed, as it is written.
    pub(crate) fn trace_loop(&mut self, header: &ParsedStatement, block: &Block) {
        if self.stays_closed() {
            self.trace_written(header, block, None);
        }
    }

    /// Notes the definition of a macro, as it is written; it is needed where calls stay closed.
    pub(crate) fn trace_macro(&mut self, name: &SmolStr, header: &ParsedStatement, body: &Block) {
        let wanted = self.trace.as_ref().is_some_and(|trace| trace.depth.is_some() && trace.at.is_none());
        if wanted && self.traced_nesting().is_some() {
            self.trace_written(header, body, Some(name));
        }
    }

    fn trace_written(&mut self, header: &ParsedStatement, block: &Block, definition_of: Option<&SmolStr>) {
        let opened_at = self.here.isn;
        let statements = block.statements.iter().map(|statement| &**statement);
        for (offset, statement) in (0..).zip(std::iter::once(header).chain(statements)) {
            let (first, last) = (statement.statement.parts.first(), statement.statement.parts.last());
            self.here.isn = opened_at.saturating_add(offset);
            // What is said beside the header of a loop stands before it; a macro keeps what is said in it, too.
            self.trace_remarks(statement, definition_of);
            let Some((first, last)) = first.zip(last) else { continue };
            let origin = self.origin(TextRange::new(first.range.start(), last.range.end()));
            if let Some(trace) = &mut self.trace {
                let definition_of = definition_of.cloned();
                let elements = statement.elements.clone();
                trace.lines.push(TracedLine { elements, origin, definition_of, is_remark: false });
            }
        }
        self.here.isn = opened_at;
    }

    /// Notes that DO gives its index a value.
    pub(crate) fn trace_index(&mut self, index: &Reference, value: f64) {
        if index.subscript.is_some() || self.traced_nesting().is_none() || !value.is_finite() {
            return;
        }
        let placed = |kind, text: &str| Element { kind, text: SmolStr::new(text), range: index.range };
        let mut elements =
            vec![placed(ElementKind::Name, &index.name.text), placed(ElementKind::Equals, "=")];
        // The loop's statements count with this line: it must stand, with as many digits as it takes.
        elements.extend(number_elements(value, index.range, None).unwrap_or_default());
        let origin = self.origin(index.range);
        if let Some(trace) = &mut self.trace {
            trace.lines.push(TracedLine { elements, origin, definition_of: None, is_remark: false });
        }
    }
}

/// The names that a statement gives values to, and those that it hands to a macro.
pub(crate) fn assigned_names(statement: &ParsedStatement) -> Vec<SmolStr> {
    let elements = &statement.elements;
    let parts = statement.statement.parts.iter();
    let mut names: Vec<SmolStr> = parts
        .flat_map(|part| match &part.body {
            Body::Macro { .. } => Vec::new(),
            Body::Call { arguments, .. } => {
                let values = arguments.iter().filter_map(|argument| argument.value.as_deref());
                let alone = values.filter_map(|value| match value {
                    [one] if one.kind == ElementKind::Name => Some(one.text.clone()),
                    _ => None,
                });
                alone.collect()
            }
            Body::Do { index, .. } => vec![index.name.text.clone()],
            _ => {
                let inside = |index: &usize| part.range.contains_range(elements[*index].range);
                let targets = (0..elements.len())
                    .filter(inside)
                    .filter(|&index| elements[index].kind == ElementKind::Name && is_target(elements, index));
                targets.map(|index| elements[index].text.clone()).collect()
            }
        })
        .collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// A number as elements, exactly; nothing if that takes more significant digits than the dialect reads.
fn number_elements(value: f64, range: TextRange, digits: Option<u16>) -> Option<Vec<Element>> {
    /// Magnitudes between which a number is written without exponent.
    const PLAIN: std::ops::Range<f64> = 1e-5..1e15;
    let magnitude = value.abs();
    // An exponent is one behind a decimal point only (language reference 1.7).
    let text = if magnitude == 0.0 || PLAIN.contains(&magnitude) {
        format!("{magnitude}")
    } else {
        let text = format!("{magnitude:E}");
        if text.contains('.') { text } else { text.replace('E', ".E") }
    };
    let mantissa = text.split('E').next().unwrap_or_default();
    let written = mantissa.bytes().filter(u8::is_ascii_digit).skip_while(|digit| *digit == b'0').count();
    if digits.is_some_and(|most| written > usize::from(most)) {
        return None;
    }
    let number = Element { kind: ElementKind::Number, text: text.into(), range };
    let minus = Element { kind: ElementKind::Minus, text: SmolStr::new_static("-"), range };
    Some(if value < 0.0 { vec![minus, number] } else { vec![number] })
}

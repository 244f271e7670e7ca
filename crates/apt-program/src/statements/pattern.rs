//! GOTO a pattern, with its modifiers (language reference 6.2).

use apt_geometry::{
    Vec3,
    canonical::{Arrangement, Pattern},
    motion::MotionCommand,
};
use apt_syntax::TextRange;
use smol_str::SmolStr;

use super::Major;
use crate::{
    evaluator::Evaluator,
    expression::{Item, Operand},
    finding::FindingKind,
    record::{PostArgument, RecordKind},
};

/// Subclass of CYCLE on the CL file (language reference 3.5).
const CYCLE_CODE: u16 = 1054;
/// Codes of the minor words that AVOID writes (language reference 3.7).
const NOMORE_CODE: u16 = 53;
const ON_CODE: u16 = 71;

/// A mistake in the list, with its APT III number.
struct ListError {
    number: u16,
    value: Option<f64>,
    range: TextRange,
}

/// What happens at each point, in order of output.
struct Route {
    /// Indices of the points in definition order.
    order: Vec<usize>,
    /// Whether the point is visited.
    visited: Vec<bool>,
    /// How far the tool is lifted after the point.
    lift: Vec<Option<f64>>,
}

impl Evaluator<'_> {
    /// Writes the points of a pattern.
    pub(crate) fn go_to_pattern(
        &mut self,
        major: Major<'_>,
        name: &SmolStr,
        pattern: &Pattern,
        items: &[Item],
    ) {
        let route = match Route::read(pattern, items, major.range) {
            Ok(route) => route,
            Err(error) => {
                let points = pattern.points.len();
                let finding = FindingKind::PatternList { number: error.number, value: error.value, points };
                return self.report(finding, error.range);
            }
        };
        let visits: Vec<usize> = (0..route.order.len()).filter(|index| route.visited[*index]).collect();
        for (turn, index) in visits.iter().enumerate() {
            let Some(point) = pattern.points.get(route.order[*index]) else { continue };
            self.pattern_point(major, name, *point);
            let next = visits.get(turn + 1).and_then(|next| pattern.points.get(route.order[*next]));
            if let (Some(lift), Some(next)) = (route.lift[*index], next) {
                self.avoid(major, name, *point, *next, lift);
            }
        }
    }

    /// One point of the pattern.
    fn pattern_point(&mut self, major: Major<'_>, name: &SmolStr, position: Vec3) {
        let name = name.to_string();
        self.motion(MotionCommand::GoTo { position, axis: None, name }, major.range);
    }

    /// AVOID: out of the cycle, up, across, and the cycle again.
    fn avoid(&mut self, major: Major<'_>, name: &SmolStr, from: Vec3, to: Vec3, lift: f64) {
        let up = Vec3::new(0.0, 0.0, lift);
        self.cycle(major, "NOMORE", NOMORE_CODE);
        self.pattern_point(major, name, from + up);
        self.pattern_point(major, name, to + up);
        self.cycle(major, "ON", ON_CODE);
    }

    /// CYCLE with one word.
    fn cycle(&mut self, major: Major<'_>, word: &'static str, code: u16) {
        let arguments = vec![PostArgument::Word(SmolStr::new_static(word), code)];
        let cycle = SmolStr::new_static("CYCLE");
        self.emit(RecordKind::Postprocessor { word: cycle, code: CYCLE_CODE, arguments }, major.range);
    }
}

/// What a list of point numbers does.
#[derive(Clone, Copy, PartialEq)]
enum Operation {
    Omit,
    Retain,
    Avoid(f64),
}

impl Route {
    /// Reads the modifiers: INVERS, ZIGZAG, CONST, then OMIT or RETAIN, and AVOID.
    fn read(pattern: &Pattern, items: &[Item], whole: TextRange) -> Result<Route, ListError> {
        let mut reader = Reader { items, position: 0, whole };
        let (mut inverse, mut zigzag, mut constant) = (false, false, false);
        while let Some(word) = reader.peek_word() {
            let flag = match word {
                "INVERS" => &mut inverse,
                "ZIGZAG" => &mut zigzag,
                "CONST" => &mut constant,
                _ => break,
            };
            if *flag {
                return Err(reader.error(834, None));
            }
            *flag = true;
            reader.position += 1;
        }
        if zigzag && pattern.arrangement != Arrangement::Parallel {
            return Err(reader.error(835, None));
        }
        let order = output_order(pattern, inverse, zigzag);
        let count = order.len();
        let mut route = Route { visited: vec![true; count], lift: vec![None; count], order };
        // With ZIGZAG the points of a range lie in one column (language reference 6.2).
        let columns = zigzag.then_some(pattern.column.max(1));
        route.read_operations(&mut reader, constant, columns)?;
        Ok(route)
    }

    /// OMIT, RETAIN and AVOID with their numbers. All stand in the order of output: OMIT and AVOID speak of different
    /// points and so form one list, while RETAIN and AVOID may speak of the same.
    fn read_operations(
        &mut self,
        reader: &mut Reader<'_>,
        constant: bool,
        columns: Option<usize>,
    ) -> Result<(), ListError> {
        let (mut omits, mut retains) = (false, false);
        let mut last_retained: Option<usize> = None;
        let mut last_changed: Option<usize> = None;
        let mut retained = vec![false; self.order.len()];
        while reader.position < reader.items.len() {
            let operation = reader.operation()?;
            omits |= operation == Operation::Omit;
            retains |= operation == Operation::Retain;
            if omits && retains {
                return Err(reader.error(811, None));
            }
            let mut any = false;
            while let Some((first, last)) = reader.range()? {
                any = true;
                let first =
                    self.output_position(first, constant).ok_or_else(|| reader.error(812, Some(first)))?;
                let last =
                    self.output_position(last, constant).ok_or_else(|| reader.error(812, Some(last)))?;
                if columns.is_some_and(|column| self.order[first] / column != self.order[last] / column) {
                    return Err(reader.error(837, None));
                }
                let passed =
                    if operation == Operation::Retain { &mut last_retained } else { &mut last_changed };
                if first > last || passed.is_some_and(|passed| first <= passed) {
                    return Err(reader.error(838, None));
                }
                *passed = Some(last);
                match operation {
                    Operation::Omit => self.visited[first..=last].fill(false),
                    Operation::Retain => retained[first..=last].fill(true),
                    Operation::Avoid(lift) => self.lift[first..=last].fill(Some(lift)),
                }
            }
            if !any {
                return Err(reader.error(836, None));
            }
        }
        if retains {
            self.visited = retained;
        }
        let dropped = self.lift.iter().zip(&self.visited).any(|(lift, visited)| lift.is_some() && !visited);
        if dropped { Err(reader.error(838, None)) } else { Ok(()) }
    }

    /// The place in the output of a point number: the number itself, or with CONST a number of the definition.
    fn output_position(&self, number: f64, constant: bool) -> Option<usize> {
        if number < 1.0 {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive; saturates")]
        let index = number as usize - 1;
        if index >= self.order.len() {
            return None;
        }
        if constant { self.order.iter().position(|point| *point == index) } else { Some(index) }
    }
}

/// The order in which the points are written: ZIGZAG turns every other column round, INVERS the whole.
fn output_order(pattern: &Pattern, inverse: bool, zigzag: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..pattern.points.len()).collect();
    if zigzag {
        for (number, column) in order.chunks_mut(pattern.column.max(1)).enumerate() {
            if number % 2 == 1 {
                column.reverse();
            }
        }
    }
    if inverse {
        order.reverse();
    }
    order
}

/// Reads the operands after the pattern.
struct Reader<'a> {
    items: &'a [Item],
    position: usize,
    whole: TextRange,
}

impl Reader<'_> {
    /// The word that comes next.
    fn peek_word(&self) -> Option<&'static str> {
        self.items.get(self.position).and_then(Item::word)
    }

    /// A mistake at the present operand.
    fn error(&self, number: u16, value: Option<f64>) -> ListError {
        let item = self.items.get(self.position).or(self.items.last());
        ListError { number, value, range: item.map_or(self.whole, |item| item.range) }
    }

    /// OMIT, RETAIN or AVOID with its height.
    fn operation(&mut self) -> Result<Operation, ListError> {
        let Some(item) = self.items.get(self.position) else { return Err(self.error(836, None)) };
        let operation = match &item.operand {
            Operand::Word(word) => match word.spelling {
                "OMIT" => Operation::Omit,
                "RETAIN" => Operation::Retain,
                "AVOID" => {
                    self.position += 1;
                    let height = self.items.get(self.position).and_then(Item::scalar);
                    Operation::Avoid(height.ok_or_else(|| self.error(836, None))?)
                }
                "INVERS" | "ZIGZAG" | "CONST" => return Err(self.error(833, None)),
                _ => return Err(self.error(832, None)),
            },
            Operand::Scalar(value) => return Err(self.error(830, Some(*value))),
            _ => return Err(self.error(831, None)),
        };
        self.position += 1;
        Ok(operation)
    }

    /// `n` or `n,THRU,m`; nothing when the list of numbers ends.
    fn range(&mut self) -> Result<Option<(f64, f64)>, ListError> {
        let Some(first) = self.items.get(self.position).and_then(Item::scalar) else {
            return if self.peek_word() == Some("THRU") { Err(self.error(836, None)) } else { Ok(None) };
        };
        self.position += 1;
        if self.peek_word() != Some("THRU") {
            return Ok(Some((first.trunc(), first.trunc())));
        }
        self.position += 1;
        let last =
            self.items.get(self.position).and_then(Item::scalar).ok_or_else(|| self.error(836, None))?;
        self.position += 1;
        Ok(Some((first.trunc(), last.trunc())))
    }
}

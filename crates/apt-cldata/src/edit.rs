//! Section 3: TRACUT, INDEX and COPY over the CL records of Section 2, after VTLAXS ([`crate::tilt`]).
//!
//! A TRACUT replaces the one before (they do not multiply). A COPY repeats all records between its INDEX and the
//! INDEX/n,NOMORE or, without one, the COPY itself; the k-th copy carries k steps of the transform. A TRACUT that was
//! in force when INDEX was met acts on the copies last, a TRACUT given inside the range acts on its records first.

use std::collections::{BTreeMap, BTreeSet};

use apt_geometry::{
    Vec3,
    canonical::Matrix,
    copy::CopyStep,
    patience::{Patience, Waiting, put_away},
    pieces::Pieces,
};

use crate::{
    record::{ClKind, ClRecord, ClWord, looked_through},
    tilt::tilt,
};

mod error;
mod statement;

pub use error::{EditError, EditErrorKind};
use statement::{CopyOrder, index_statement, statement, transform_statement};

/// Deepest nesting of INDEX ... COPY.
pub const MAXIMUM_NESTING: usize = 3;
/// Most COPY statements that may name one INDEX.
pub const MAXIMUM_COPIES_PER_INDEX: usize = 3;
/// Most INDEX statements of a program in APT III: its table holds 80, and the end of the program takes one of them.
pub const MAXIMUM_INDEXES: usize = 79;
/// Most records that one edit may make, so that a slip in a count ends in a diagnostic and not in a full memory.
pub const MAXIMUM_RECORDS: usize = 4_000_000;
/// Positions that are transformed for one unit of work; a record is another.
const POINTS_A_UNIT: usize = 8;
/// Relative deviation from a similarity below which a circle is still a circle after a transform.
const SIMILARITY_FRACTION: f64 = 1e-6;
/// Subclasses of the edit statements themselves.
const TRACUT_CODE: u16 = 1038;
const INDEX_CODE: u16 = 1039;
const COPY_CODE: u16 = 1040;

/// One step of the stream that Section 2 hands to Section 3.
#[derive(Debug, Clone, PartialEq)]
pub enum EditItem {
    /// A CL record.
    Record(ClRecord),
    /// TRACUT/matrix, or TRACUT/NOMORE (`None`).
    Transform {
        /// The matrix.
        matrix: Option<Matrix>,
        /// Statement number.
        isn: u32,
        /// Origin, as in [`ClRecord::source`].
        source: u32,
    },
    /// INDEX/n, or INDEX/n,NOMORE.
    Index {
        /// Index number.
        number: i64,
        /// True for NOMORE.
        end: bool,
        /// Statement number.
        isn: u32,
        /// Origin.
        source: u32,
    },
    /// COPY.
    Copy {
        /// Index number.
        number: i64,
        /// What each copy adds.
        step: CopyStep,
        /// How many copies.
        count: u32,
        /// Statement number.
        isn: u32,
        /// Origin.
        source: u32,
    },
}

/// Executes the edit statements. The list comes back whole, also with errors: a faulty statement has no effect.
pub fn edit(items: Vec<EditItem>) -> (Vec<ClRecord>, Vec<EditError>) {
    edit_within(items, &EditLimits::default())
}

/// What an edit may come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EditLimits {
    /// Most INDEX statements of the program.
    pub indexes: usize,
    /// Most positions of the path, copies included.
    pub points: u64,
}

impl Default for EditLimits {
    /// No limits.
    fn default() -> Self {
        Self { indexes: usize::MAX, points: u64::MAX }
    }
}

/// Executes the edit statements of a program within limits.
pub fn edit_within(items: Vec<EditItem>, limits: &EditLimits) -> (Vec<ClRecord>, Vec<EditError>) {
    edited(items, limits, Patience::default())
}

/// The same while `cancel` says that it goes on; `None` once it has said otherwise.
pub fn edit_until(
    items: Vec<EditItem>,
    limits: &EditLimits,
    cancel: &dyn Fn() -> bool,
) -> Option<(Vec<ClRecord>, Vec<EditError>)> {
    let waiting = Waiting::until(cancel);
    let edited = edited(items, limits, waiting.patience());
    if waiting.has_given_up() {
        let records = edited.0.len();
        put_away(edited, records);
        return None;
    }
    Some(edited)
}

/// What comes of the edit statements; a part of it if they are given up.
fn edited(
    items: Vec<EditItem>,
    limits: &EditLimits,
    patience: Patience<'_>,
) -> (Vec<ClRecord>, Vec<EditError>) {
    // VTLAXS changes the path itself; TRACUT and COPY transform what it makes.
    let (items, errors) = tilt(items, patience);
    let spans = spans(&items, patience);
    let (levels, indexes) = (vec![Level::base()], BTreeSet::new());
    let points = looked_through(items.iter(), patience)
        .map(|item| if let EditItem::Record(record) = item { record.position_count() as u64 } else { 0 })
        .sum();
    let mut editor = Editor { levels, errors, made: 0, points, indexes, limits: *limits, patience };
    let count = items.len();
    let mut items = items.into_iter();
    for (at, item) in items.by_ref().enumerate() {
        if patience.ends_after(1) {
            break;
        }
        editor.item(item, spans.get(&at).copied());
    }
    put_away(items, count);
    editor.finish()
}

/// The COPY statements of a CL file that no INDEX before them belongs to. In a CL file they only tell how its positions
/// came about (CL and tape reference 3.5); so the same INDEX may stand there any number of times. Fewer where who waits gives up.
pub fn copies_without_index(items: &[EditItem], patience: Patience<'_>) -> Vec<EditError> {
    let mut indexes = BTreeSet::new();
    let mut errors = Vec::new();
    for item in looked_through(items.iter(), patience) {
        let EditItem::Record(record) = item else { continue };
        let ClKind::Postprocessor { code: Some(code @ (INDEX_CODE | COPY_CODE)), arguments, .. } =
            &record.kind
        else {
            continue;
        };
        let Some(ClWord::Number(number)) = arguments.first() else { continue };
        #[expect(clippy::cast_possible_truncation, reason = "saturates; index numbers are small")]
        let number = number.trunc() as i64;
        if *code == INDEX_CODE {
            indexes.insert(number);
        } else if !indexes.contains(&number) {
            let kind = EditErrorKind::CopyWithoutIndex { number };
            errors.push(EditError { isn: record.isn, source: record.source, kind });
        }
    }
    errors
}

/// What the whole stream says about the edit statement at a place in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Span {
    /// An INDEX that COPY statements name.
    Opens,
    /// A COPY of an open INDEX; the last one closes it.
    Copies { last: bool, ordinal: usize },
}

/// Pairs every COPY with the INDEX before it.
fn spans(items: &[EditItem], patience: Patience<'_>) -> BTreeMap<usize, Span> {
    let mut open: BTreeMap<i64, (usize, Vec<usize>)> = BTreeMap::new();
    let mut closed: Vec<(usize, Vec<usize>)> = Vec::new();
    for (at, item) in looked_through(items.iter().enumerate(), patience) {
        match item {
            EditItem::Index { number, end: false, .. } => {
                // The same number again before any COPY: the first range is still open, which `open_index` reports.
                let reopened = open.get(number).is_some_and(|(_, copies)| copies.is_empty());
                if !reopened && let Some(range) = open.insert(*number, (at, Vec::new())) {
                    closed.push(range);
                }
            }
            EditItem::Copy { number, .. } => {
                if let Some((_, copies)) = open.get_mut(number) {
                    copies.push(at);
                }
            }
            _ => {}
        }
    }
    closed.extend(open.into_values());
    let mut spans = BTreeMap::new();
    for (index, copies) in closed {
        let Some(last) = copies.last().copied() else { continue };
        spans.insert(index, Span::Opens);
        for (ordinal, at) in copies.into_iter().enumerate() {
            spans.insert(at, Span::Copies { last: at == last, ordinal });
        }
    }
    spans
}

/// A record in an open range. `outer` says that the TRACUT around the range still has to act on it.
#[derive(Debug, Clone)]
struct Held {
    record: ClRecord,
    outer: bool,
}

/// An open INDEX, or the program itself.
struct Level {
    /// Index number; none for the program.
    number: Option<i64>,
    /// What has been met in it.
    held: Pieces<Held>,
    /// Where INDEX/n,NOMORE stood, as a length of `held`.
    end: Option<usize>,
    /// The TRACUT given inside: none, NOMORE, or a matrix.
    transform: Option<Option<Matrix>>,
}

impl Level {
    fn base() -> Self {
        Level { number: None, held: Pieces::default(), end: None, transform: Some(None) }
    }

    fn index(number: i64) -> Self {
        Level { number: Some(number), held: Pieces::default(), end: None, transform: None }
    }
}

struct Editor<'a> {
    /// The program, then the open ranges from the outermost; never empty.
    levels: Vec<Level>,
    errors: Vec<EditError>,
    made: usize,
    /// Positions of the path, with the copies made so far.
    points: u64,
    /// The numbers of all INDEX statements met.
    indexes: BTreeSet<i64>,
    limits: EditLimits,
    patience: Patience<'a>,
}

impl Editor<'_> {
    fn item(&mut self, item: EditItem, span: Option<Span>) {
        match item {
            EditItem::Record(record) => self.push(record),
            EditItem::Transform { matrix, isn, source } => {
                self.push(transform_statement(matrix.as_ref(), isn, source));
                if let Some(level) = self.levels.last_mut() {
                    level.transform = Some(matrix);
                }
            }
            EditItem::Index { number, end: false, isn, source } => {
                self.open_index(number, span.is_some(), isn, source);
                self.push(index_statement(number, isn, source));
            }
            EditItem::Index { number, end: true, isn, source } => self.end_index(number, isn, source),
            EditItem::Copy { number, step, count, isn, source } => {
                self.copy(&CopyOrder { number, step, count, isn, source }, span);
            }
        }
    }

    fn error(&mut self, isn: u32, source: u32, kind: EditErrorKind) {
        self.errors.push(EditError { isn, source, kind });
    }

    /// Appends a record to the innermost range under the TRACUT given inside that range.
    fn push(&mut self, record: ClRecord) {
        let Some(level) = self.levels.last_mut() else { return };
        match level.transform {
            None => level.held.push(Held { record, outer: true }),
            Some(None) => level.held.push(Held { record, outer: false }),
            Some(Some(matrix)) => match transformed(&record, &matrix, self.patience) {
                Ok(Some(record)) => level.held.push(Held { record, outer: false }),
                Ok(None) => {}
                Err(kind) => self.errors.push(EditError { isn: record.isn, source: record.source, kind }),
            },
        }
    }

    fn open_index(&mut self, number: i64, copied: bool, isn: u32, source: u32) {
        if self.indexes.len() >= self.limits.indexes {
            let limit = self.limits.indexes;
            return self.error(isn, source, EditErrorKind::TooManyIndexes { limit });
        }
        // Also a number whose range has been copied is taken for the rest of the program.
        if !self.indexes.insert(number) {
            return self.error(isn, source, EditErrorKind::IndexReused { number });
        }
        if !copied {
            return;
        }
        let depth = self.levels.len();
        if depth > MAXIMUM_NESTING {
            return self.error(isn, source, EditErrorKind::NestedTooDeep { number, depth });
        }
        self.levels.push(Level::index(number));
    }

    fn end_index(&mut self, number: i64, isn: u32, source: u32) {
        let innermost = self.levels.last().and_then(|level| level.number);
        let open = self.levels.iter().any(|level| level.number == Some(number));
        match innermost {
            Some(inner) if inner == number => match self.levels.last_mut() {
                Some(level) if level.end.is_none() => level.end = Some(level.held.len()),
                _ => self.error(isn, source, EditErrorKind::EndWithoutIndex { number }),
            },
            Some(inner) if open => self.error(isn, source, EditErrorKind::Overlap { number, open: inner }),
            _ => self.error(isn, source, EditErrorKind::EndWithoutIndex { number }),
        }
        self.push(statement(
            "INDEX",
            INDEX_CODE,
            vec![ClWord::Number(number as f64), ClWord::Word("NOMORE".into())],
            isn,
            source,
        ));
    }

    fn copy(&mut self, order: &CopyOrder, span: Option<Span>) {
        let CopyOrder { number, isn, source, .. } = *order;
        match (self.levels.last().and_then(|level| level.number), span) {
            (Some(inner), Some(Span::Copies { last, ordinal })) if inner == number => {
                if ordinal >= MAXIMUM_COPIES_PER_INDEX {
                    self.error(isn, source, EditErrorKind::TooManyCopies { number });
                } else {
                    self.repeat(order);
                }
                self.push(order.statement());
                if last {
                    self.close();
                }
                return;
            }
            (Some(inner), _) if self.levels.iter().any(|level| level.number == Some(number)) => {
                self.error(isn, source, EditErrorKind::Overlap { number, open: inner });
            }
            // The INDEX was refused and has its own message.
            (_, Some(_)) => {}
            (_, None) => self.error(isn, source, EditErrorKind::CopyWithoutIndex { number }),
        }
        self.push(order.statement());
    }

    /// Appends the copies to the innermost range.
    fn repeat(&mut self, order: &CopyOrder) {
        let CopyOrder { number, step, count, isn, source } = *order;
        let matrix = step.matrix();
        let Some(level) = self.levels.last() else { return };
        let range = level.end.unwrap_or(level.held.len());
        let patience = self.patience;
        let original: Vec<Held> =
            level.held.iter().take(range).take_while(|_| !patience.ends_after(1)).cloned().collect();
        if count == 0 {
            return self.error(isn, source, EditErrorKind::ZeroCount { number });
        }
        let more = (original.len() + 1).saturating_mul(count as usize);
        if self.made.saturating_add(more) > MAXIMUM_RECORDS {
            return self.error(isn, source, EditErrorKind::TooManyRecords { number, limit: MAXIMUM_RECORDS });
        }
        let copied = original.iter().map(|held| held.record.position_count() as u64).sum::<u64>();
        let points = self.points.saturating_add(copied.saturating_mul(u64::from(count)));
        if points > self.limits.points {
            let limit = self.limits.points;
            return self.error(isn, source, EditErrorKind::TooManyPoints { number, limit });
        }
        self.made += more;
        self.points = points;
        let mut power = Matrix::identity();
        for _ in 0..count {
            if let Some(step) = &matrix {
                power = step.multiply(&power);
            }
            let mut copies = vec![Held { record: index_statement(number, isn, source), outer: true }];
            // The INDEX statement itself stands first in the range and is renewed under the number of the COPY.
            for held in original.iter().skip(1) {
                if self.patience.ends_after(1) {
                    return;
                }
                match transformed(&held.record, &power, self.patience) {
                    Ok(Some(record)) => copies.push(Held { record, outer: held.outer }),
                    Ok(None) => {}
                    Err(kind) => {
                        self.errors.push(EditError {
                            isn: held.record.isn,
                            source: held.record.source,
                            kind,
                        });
                    }
                }
            }
            if let Some(level) = self.levels.last_mut() {
                level.held.extend(copies);
            }
        }
    }

    /// Ends the innermost range: its records go to the range around it, under the TRACUT there.
    fn close(&mut self) {
        if self.levels.len() < 2 {
            return;
        }
        let Some(inner) = self.levels.pop() else { return };
        let count = inner.held.len();
        let mut all = inner.held.into_iter();
        let patience = self.patience;
        for held in all.by_ref().take_while(|_| !patience.ends_after(1)) {
            if held.outer {
                self.push(held.record);
            } else if let Some(level) = self.levels.last_mut() {
                level.held.push(held);
            }
        }
        put_away(all, count);
        if let (Some(level), Some(transform)) = (self.levels.last_mut(), inner.transform) {
            level.transform = Some(transform);
        }
    }

    fn finish(mut self) -> (Vec<ClRecord>, Vec<EditError>) {
        while self.levels.len() > 1 {
            self.close();
        }
        let held = self.levels.pop().map(|level| level.held).unwrap_or_default();
        (held.joined_as(|held| held.record, self.patience), self.errors)
    }
}

/// The record under a transform, or a part of it if that is given up; `None` for a circle that is no circle any more (its
/// chord points remain).
fn transformed(
    record: &ClRecord,
    matrix: &Matrix,
    patience: Patience<'_>,
) -> Result<Option<ClRecord>, EditErrorKind> {
    let kind = match &record.kind {
        ClKind::Arc { surface, center, axis, radius } => {
            let Some(scale) = matrix.uniform_scale(SIMILARITY_FRACTION) else { return Ok(None) };
            ClKind::Arc {
                surface: surface.clone(),
                center: transformed_position(center, matrix)?,
                axis: transformed_axis(axis, matrix)?,
                radius: radius * scale,
            }
        }
        ClKind::Motion { from, surface, points } => {
            let mut moved = points.clone();
            for points in moved.chunks_mut(POINTS_A_UNIT) {
                if patience.ends_after(1) {
                    break;
                }
                for point in points {
                    point.position = transformed_position(&point.position, matrix)?;
                    point.axis = transformed_axis(&point.axis, matrix)?;
                }
            }
            ClKind::Motion { from: *from, surface: surface.clone(), points: moved }
        }
        other => other.clone(),
    };
    Ok(Some(ClRecord { isn: record.isn, source: record.source, kind }))
}

fn transformed_position(position: &Vec3, matrix: &Matrix) -> Result<Vec3, EditErrorKind> {
    let moved = matrix.apply_point(position);
    if moved.iter().all(|value| value.is_finite()) {
        Ok(moved)
    } else {
        Err(EditErrorKind::NotFinite { position: (*position).into() })
    }
}

fn transformed_axis(axis: &Vec3, matrix: &Matrix) -> Result<Vec3, EditErrorKind> {
    let turned = matrix.apply_vector(axis);
    let length = turned.norm();
    if length > 0.0 && length.is_finite() {
        Ok(turned / length)
    } else {
        Err(EditErrorKind::AxisVanishes { axis: (*axis).into() })
    }
}

//! Fewer vectors where a motion has many more than it needs. The march makes each vector as long as it can be from where the one before it ends; where
//! the path bends to and fro, turns in corners or begins at the wrong limit of a band, that may take a vector more than if some of those
//! before had ended elsewhere. Stretches of vectors that fill less than one of them fewer are looked through again, with vertices on several levels of
//! the bands: of each level the farthest place to which one vector leads, then two, and so on, until one leads to where the path had come with a
//! vector more. From vertices to which they come on the way it is not looked again.

use std::ops::Range;

use apt_geometry::Vec3;

use super::{March, Vertex, first_stop, spared::hand_of, surface_end::just_ahead, tangency};
use crate::{
    attitude::Sweep,
    bound::{self, Bent},
    clearance::Shape,
    directed::{
        Prepared,
        stop::{Event, Watcher},
    },
    error::MotionFailure,
    role::{Bend, Working},
};

/// By how many vectors, as a share of those that it fills and besides, a motion has more than it needs without being looked through.
const MORE: f64 = 0.02;
const BESIDES: f64 = 2.0;
/// How many vectors make a stretch.
const LEAST_TOGETHER: usize = 2;
const MOST_TOGETHER: usize = 16;
/// Vertices from which it is looked in one go: the stretch that begins at the first of them has as many vectors more as there are others.
const MOST_STARTS: usize = 48;
/// What a stretch leaves at least of one vector fewer: vertices on levels of the bands fill less than the fullest vectors.
const ROOM: f64 = 0.05;
/// Columns of places along a stretch for each of its vectors.
const COLUMNS: usize = 12;
/// Bound of the vectors that are tried for each of a motion, some times what the march takes, for no more vectors than these, and for so many together.
const MOST_TRIED: u32 = 200;
const FEW: usize = 250;
const MOST_FOR_ONE: u32 = 4_000;
/// How often stretches are looked through that have changed.
const MOST_ROUNDS: u32 = 16;
/// Cosine between a vector and the way along the path in its place below which it leads another way (60°).
const LEAST_ONWARD: f64 = 0.5;
/// Share of MAXDP that a vector's length may be above it by rounding.
const ROUNDING: f64 = 1e-9;
/// Share by which what vectors fill may be read too great. A full one is read to fill a hundredth less than one, as bands are taken to be a fiftieth wider
/// for that.
const MISREAD: f64 = 0.01;
/// Vectors fewer than are needed along a path that others may need elsewhere in the bands: one of a stretch that just bends too much for one may be spared.
const ELSEWHERE: f64 = 1.0;

#[cfg(test)]
thread_local! {
    /// Vectors that this thread has tried in the place of others.
    pub(crate) static TRIED: std::cell::Cell<u64> = const { std::cell::Cell::new(0) };
}

/// Places on all levels beside one of the path as it was.
struct Column {
    /// The way to it along the stretch, the position there, and the direction of the vector.
    along: f64,
    old: Vec3,
    sense: Vec3,
    /// The place on each level, once it has been looked for.
    places: Vec<Option<Option<Vertex>>>,
}

/// A place to which vectors lead.
#[derive(Clone, Copy)]
struct Reached {
    vertex: Vertex,
    along: f64,
    old: Vec3,
    /// The level of the bands that it is on, or next to.
    level: usize,
    /// On which hand a vector to it keeps both surfaces: to a vertex that was in a corner of the path the one that led there may have kept them on the
    /// other one, for contact is told on the way out of it.
    hand: Option<f64>,
    /// Index of the one before.
    from: usize,
}

/// What is met along the vectors of a path.
#[derive(Debug, Clone, Copy)]
pub(super) enum Met {
    /// A stop, on a vector of some length (of the bands at least) behind which there are so many.
    Stop { check: usize, tip: Vec3, length: f64, ahead: usize },
    /// So many positions and tangencies, none of which stops the motion.
    Positions(usize),
}

impl Met {
    /// Whether the same is met as along another path, a stop no farther from that than its vector is long.
    pub(super) fn is_as(&self, other: &Self) -> bool {
        match (*self, *other) {
            (
                Self::Stop { check, tip, ahead, .. },
                Self::Stop { check: other, tip: place, length, ahead: behind },
            ) => check == other && ahead == behind && (tip - place).norm() <= length,
            (Self::Positions(met), Self::Positions(other)) => met == other,
            _ => false,
        }
    }
}

/// Vectors in whose place fewer are looked for.
struct Stretch {
    columns: Vec<Column>,
    /// Clearances of part and drive surface on each level.
    levels: Vec<[f64; 2]>,
    /// The vertices as they were.
    were: Vec<Reached>,
    /// What each of the vectors between them fills of one.
    fills: Vec<f64>,
    /// On which hand the path keeps both surfaces where it begins.
    hand: f64,
    /// How many vectors may still be tried.
    left: u32,
}

/// What comes of looking through a stretch.
enum Looked {
    /// So many vectors can be one fewer, with these positions between them.
    Fewer(usize, Vec<Vec3>),
    /// None are fewer of the first so many vectors; nor of as many of them from any vertex before another one.
    InVain { until: usize, before: usize },
}

impl March<'_> {
    /// Looks for fewer vectors if there are many more than a path needs, of which it is known with `bent` how it bends until near its end.
    pub(super) fn save_vectors(
        &mut self,
        start: &Vertex,
        path: &[Vec3],
        bent: &Bent,
    ) -> Result<(), MotionFailure> {
        if self.prepared.attitude.turns() || self.points.len() <= LEAST_TOGETHER {
            return Ok(());
        }
        let most = self.state.maximum_step;
        // Few motions are wasteful, and the others are not copied for it.
        let needed = f64::from(bound::needed(self.prepared, path, bent.clone(), most));
        if !self.is_wasteful(needed * (1.0 - MISREAD) - ELSEWHERE) {
            return Ok(());
        }
        let before = self.points.clone();
        let mut positions: Vec<Vec3> = std::iter::once(start.tip).chain(before.iter().copied()).collect();
        // In the bands there is room beside a vector for a way longer than MAXDP, but for no longer vector.
        let shares = positions.windows(2).map(|pair| (pair[1] - pair[0]).norm() / most);
        if !self.is_wasteful(shares.clone().sum()) {
            return Ok(());
        }
        let patience = self.stepper.patience();
        let fills = bound::fills(self.prepared, &positions, most, patience);
        let mut fills = fills.ok_or(MotionFailure::Cancelled)?;
        fills.iter_mut().zip(shares).for_each(|(fill, share)| *fill = fill.max(share));
        if !self.is_wasteful(fills.iter().sum::<f64>()) {
            return Ok(());
        }
        // Of several positions on a check surface each counts as the vectors meet it.
        let met = self.met_along(&positions)?;
        for searched in [fills.len(), fills.len() - 1] {
            self.save_among(start, &fills[..searched])?;
            positions.splice(1.., self.points.iter().copied());
            if self.met_along(&positions)?.is_as(&met) {
                break;
            }
            self.points.clone_from(&before);
        }
        Ok(())
    }

    /// Saves vectors among the first ones, which fill so much of one each.
    fn save_among(&mut self, start: &Vertex, fills: &[f64]) -> Result<(), MotionFailure> {
        let mut left = (MOST_TRIED * fills.len().min(FEW) as u32, vec![false; fills.len()]);
        let mut fills = fills.to_vec();
        for _ in 0..MOST_ROUNDS {
            if !self.save_apart(start, &mut fills, &mut left)? {
                break;
            }
        }
        Ok(())
    }

    /// Whether there are many more vectors than are needed. Before a tangency one less is: it is not known how far before its end another path may end.
    fn is_wasteful(&self, needed: f64) -> bool {
        let least = needed - if self.tangency.has_any() { 1.0 } else { 0.0 };
        self.points.len() as f64 > least * (1.0 + MORE) + BESIDES
    }

    /// What is met along vectors.
    pub(super) fn met_along(&self, positions: &[Vec3]) -> Result<Met, MotionFailure> {
        let mut watcher = Watcher::new(self.prepared, self.checks);
        let mut tangency = tangency::Watch::new(self.prepared, self.checks, self.stepper.patience());
        let axis = &self.prepared.tool.axis;
        for (k, pair) in positions.windows(2).enumerate() {
            if self.stepper.patience().is_over() {
                return Err(MotionFailure::Cancelled);
            }
            let sweep = Sweep::new(&self.prepared.tool, (&pair[0], axis), (&pair[1], axis));
            let stop = if tangency.has_any() {
                let way = pair[1] - pair[0];
                let [from, to] = [pair[0], pair[1]].map(|tip| Vertex::at(self.prepared, tip, &way));
                first_stop((&mut watcher, &mut tangency), &sweep, [&from?, &to?])?
            } else {
                watcher.scan(&sweep)
            };
            if let Some(Event { check, tip, .. }) = stop {
                let (length, ahead) = (sweep.length.max(just_ahead(self.prepared)), positions.len() - 2 - k);
                return Ok(Met::Stop { check, tip, length, ahead });
            }
        }
        Ok(Met::Positions(watcher.met + tangency.met))
    }

    /// Saves a vector in stretches that are apart, beginning with the one that leaves the most room; whether there was one. So many vectors may still be
    /// tried, and from some on there is none to save.
    fn save_apart(
        &mut self,
        start: &Vertex,
        fills: &mut Vec<f64>,
        (left, is_tried): &mut (u32, Vec<bool>),
    ) -> Result<bool, MotionFailure> {
        let mut is_changed = vec![false; fills.len()];
        let mut found = Vec::new();
        let starts = by_room(fills);
        let mut leaves_room = vec![false; fills.len()];
        starts.iter().for_each(|k| leaves_room[*k] = true);
        for k in starts {
            while *left > 0 && leaves_room[k] && !is_tried[k] && !is_changed[k] {
                let may_begin = |k: &usize| leaves_room[*k] && !is_tried[*k] && !is_changed[*k];
                // From the first of the vertices from which it is to be looked in turn vectors lead as far as from each of the others.
                let back = (0..k).rev().take(MOST_STARTS / 2).take_while(may_begin).count();
                let first = k - back;
                let together = (first..fills.len()).take(MOST_STARTS).take_while(may_begin);
                let ends: Vec<usize> = together.map(|k| end_from(k, &is_changed)).collect();
                let end = ends.last().copied().unwrap_or(first);
                if end - first < LEAST_TOGETHER {
                    is_tried[first] = true;
                    continue;
                }
                match self.fewer_from(start, first, &fills[first..end], left)? {
                    Looked::Fewer(count, between) => {
                        is_changed[first..first + count].fill(true);
                        found.push((first, count, between));
                    }
                    // From no vertex on the way to the end there are fewer.
                    Looked::InVain { until, .. } if first + until == fills.len() => {
                        is_tried[first..].fill(true);
                    }
                    Looked::InVain { until, before } => {
                        is_tried[first] = true;
                        let looked =
                            ends.iter().take(before).take_while(|end| **end <= first + until).count();
                        is_tried[first..first + looked].fill(true);
                    }
                }
            }
        }
        found.sort_by_key(|(k, ..)| std::cmp::Reverse(*k));
        let has_saved = !found.is_empty();
        for (k, count, between) in found {
            let share = fills[k..k + count].iter().sum::<f64>() / (count - 1) as f64;
            fills.splice(k..k + count, vec![share; count - 1]);
            is_tried.splice(k..k + count, vec![false; count - 1]);
            is_tried[k.saturating_sub(MOST_TOGETHER)..k].fill(false);
            self.points.splice(k..k + count - 1, between);
        }
        Ok(has_saved)
    }

    /// Whether of some vectors from vertex `k` on, which fill so much of one each, the first ones can be one fewer.
    fn fewer_from(
        &self,
        start: &Vertex,
        k: usize,
        fills: &[f64],
        left: &mut u32,
    ) -> Result<Looked, MotionFailure> {
        let old: Vec<Vec3> = (k..=k + fills.len()).map(|k| self.at(start, k)).collect();
        let Some(mut stretch) = self.stretch(&old, fills, *left)? else {
            return Ok(Looked::InVain { until: MOST_TOGETHER.min(fills.len()), before: 1 });
        };
        let had = stretch.left;
        let found = self.with_fewer(&mut stretch);
        *left -= had - stretch.left;
        found
    }

    /// The stretch between positions, of vectors that fill so much; `None` where it begins on no hand.
    fn stretch(&self, old: &[Vec3], fills: &[f64], left: u32) -> Result<Option<Stretch>, MotionFailure> {
        let [part, drive] = [&self.prepared.part, &self.prepared.drive].map(levels);
        let levels: Vec<[f64; 2]> =
            part.iter().flat_map(|part| drive.iter().map(move |drive| [*part, *drive])).collect();
        let (mut along, mut were) = (0.0, Vec::new());
        for (k, tip) in old.iter().enumerate() {
            let before = old[k.saturating_sub(1)];
            along += (tip - before).norm();
            let way = old[(k + 1).min(old.len() - 1)] - before;
            let vertex = Vertex::at(self.prepared, *tip, &way)?;
            let (hand, level) = (hand_of(&vertex, &(tip - before)), self.level_of(&levels, &vertex));
            were.push(Reached { vertex, along, old: *tip, level, hand, from: 0 });
        }
        let Some(hand) = hand_of(&were[0].vertex, &(old[1] - old[0])) else { return Ok(None) };
        let column = |pair: &[Reached], k: usize| {
            let (share, way) = (k as f64 / COLUMNS as f64, pair[1].old - pair[0].old);
            Column {
                along: pair[0].along + share * (pair[1].along - pair[0].along),
                old: pair[0].old + way * share,
                sense: way,
                places: vec![None; levels.len()],
            }
        };
        let columns =
            were.windows(2).flat_map(|pair| (0..COLUMNS).map(move |k| column(pair, k))).skip(1).collect();
        let together = fills.len().div_ceil(MOST_TOGETHER) as u32;
        let (fills, left) = (fills.to_vec(), left.min(MOST_FOR_ONE * together));
        Ok(Some(Stretch { columns, levels, were, fills, hand, left }))
    }

    /// The level that a vertex is on, or next to, in shares of the bands.
    fn level_of(&self, levels: &[[f64; 2]], vertex: &Vertex) -> usize {
        let Prepared { part, drive, .. } = self.prepared;
        let bands = [part.band(), drive.band()];
        let clearances = [vertex.part.clearance, vertex.drive.clearance];
        let away =
            |level: &[f64; 2]| -> f64 { (0..2).map(|k| (level[k] - clearances[k]).abs() / bands[k]).sum() };
        let nearest = levels.iter().enumerate().min_by(|(_, a), (_, b)| away(a).total_cmp(&away(b)));
        nearest.map_or(0, |(level, _)| level)
    }

    /// Whether vectors of a stretch can be one fewer: of the first ones, as few as may be.
    fn with_fewer(&self, stretch: &mut Stretch) -> Result<Looked, MotionFailure> {
        let mut reached = vec![stretch.were[0]];
        let mut latest = 0..1;
        let last = stretch.were.len() - 1;
        // Vectors lead farthest from where they begin farthest on: as long as they come to the vertices of the path, or beyond, on the levels of these, none
        // lead farther from there. Before which vertex it is so, and the vectors that are looked through for those.
        let (mut before, mut most) = (last, last);
        let mut until = 0;
        for count in LEAST_TOGETHER..=last {
            if self.stepper.patience().is_over() {
                return Err(MotionFailure::Cancelled);
            }
            if count > most {
                break;
            }
            let end = stretch.were[count];
            if let Some(mut k) = latest.clone().rev().find(|k| self.is_vector(stretch, &reached[*k], &end)) {
                let mut between = Vec::new();
                while k > 0 {
                    between.push(reached[k].vertex.tip);
                    k = reached[k].from;
                }
                between.reverse();
                return Ok(Looked::Fewer(count, between));
            }
            until = if stretch.left > 0 { count } else { count - 1 };
            let mut farthest = self.farthest_from(stretch, &reached, latest.clone());
            if farthest.is_empty() || stretch.left == 0 {
                before = before.min(count - 1);
                break;
            }
            let were = stretch.were[count - 1];
            let has_come = |place: &Reached| place.level == were.level && place.along >= were.along;
            if before == last && !farthest.iter().any(has_come) {
                before = count - 1;
                most = last.min(count - 2 + MOST_TOGETHER);
            }
            farthest.sort_by(|a, b| a.along.total_cmp(&b.along));
            if !self.has_room(stretch, farthest.last(), count - 1) {
                until = most;
                break;
            }
            latest = reached.len()..reached.len() + farthest.len();
            reached.extend(farthest);
        }
        Ok(Looked::InVain { until, before })
    }

    /// Whether what is left of a stretch behind the farthest place to which some vectors lead may be gone along in one vector fewer than it was, with those:
    /// no vector is more than full, as far as is read.
    fn has_room(&self, stretch: &Stretch, farthest: Option<&Reached>, vectors: usize) -> bool {
        let Some(farthest) = farthest else { return false };
        let Stretch { were, fills, .. } = stretch;
        let next = were.partition_point(|were| were.along <= farthest.along);
        let Some(to) = were.get(next) else { return true };
        let (share, to) = ((to.along - farthest.along) / (to.along - were[next - 1].along), to.vertex.tip);
        let most = self.state.maximum_step;
        // A vector need not be as full everywhere.
        let alone = bound::fills(self.prepared, &[farthest.vertex.tip, to], most, self.stepper.patience());
        let Some(alone) = alone.and_then(|fills| fills.first().copied()) else { return false };
        let mut filled = alone.min(share * fills[next - 1]);
        (next..were.len()).any(|count| {
            let has_room = count > vectors && filled * (1.0 - MISREAD) <= (count - 1 - vectors) as f64;
            filled += fills.get(count).copied().unwrap_or_default();
            has_room
        })
    }

    /// The farthest place of each level to which one vector leads from any of those that have been reached.
    fn farthest_from(
        &self,
        stretch: &mut Stretch,
        reached: &[Reached],
        latest: Range<usize>,
    ) -> Vec<Reached> {
        let mut found = Vec::new();
        for level in 0..stretch.levels.len() {
            let mut best = None;
            for from in latest.clone().rev() {
                best = self.farther(stretch, (from, &reached[from]), level, best);
            }
            found.extend(best.map(|(_, place)| place));
        }
        found
    }

    /// The farthest place on a level to which a vector leads from one, with its column, if that is farther than the one that is known. Vectors are
    /// taken to lead everywhere up to there.
    fn farther(
        &self,
        stretch: &mut Stretch,
        (from, reached): (usize, &Reached),
        level: usize,
        known: Option<(usize, Reached)>,
    ) -> Option<(usize, Reached)> {
        let here = stretch.columns.partition_point(|column| column.along <= reached.along);
        let end = stretch.columns.len();
        let (mut best, mut low) = (known, known.map_or(here, |(column, _)| column + 1));
        // A vector as long as those that were there, or else one that leads farther at all.
        let (mut high, mut step) = (end, if known.is_some() { 1 } else { COLUMNS });
        let mut at = low + step - 1;
        while low < high {
            at = at.clamp(low, high - 1);
            let place = self.place(stretch, (at, level));
            if let Some(place) = place.filter(|place| self.is_vector(stretch, reached, place)) {
                best = Some((at, Reached { from, ..place }));
                low = at + 1;
                step *= 2;
                at = if high == end { low + step - 1 } else { low + (high - low) / 2 };
            } else if known.is_some() && at == low && high == end {
                break;
            } else {
                high = at;
                at = low + (high - low) / 2;
            }
        }
        best
    }

    /// The place of a column on a level.
    fn place(&self, stretch: &mut Stretch, (column, level): (usize, usize)) -> Option<Reached> {
        let at = stretch.levels[level];
        let Column { along, old, sense, places } = &mut stretch.columns[column];
        let settled = || Vertex::settled_at(self.prepared, at, old, sense);
        let vertex = (*places[level].get_or_insert_with(settled))?;
        Some(Reached { vertex, along: *along, old: *old, level, hand: Some(stretch.hand), from: 0 })
    }

    /// Whether a vector from one place to another one leads onward and keeps the bands.
    fn is_vector(&self, stretch: &mut Stretch, from: &Reached, to: &Reached) -> bool {
        let (way, old) = (to.vertex.tip - from.vertex.tip, to.old - from.old);
        let length = way.norm();
        if stretch.left == 0
            || to.along <= from.along
            || length > self.state.maximum_step * (1.0 + ROUNDING)
            || way.dot(&old) <= LEAST_ONWARD * length * old.norm()
            || hand_of(&from.vertex, &way) != Some(stretch.hand)
            || hand_of(&to.vertex, &way) != to.hand
        {
            return false;
        }
        stretch.left -= 1;
        #[cfg(test)]
        TRIED.set(TRIED.get() + 1);
        self.is_in_middle(&from.vertex, &to.vertex) && self.stepper.proven(&from.vertex, &to.vertex)
    }

    /// Whether the middle of a vector is in both bands, which is told sooner than all of it.
    fn is_in_middle(&self, from: &Vertex, to: &Vertex) -> bool {
        let middle = Vertex::at(self.prepared, 0.5 * (from.tip + to.tip), &from.tangent);
        middle.is_ok_and(|vertex| {
            let [part, drive] = [&self.prepared.part, &self.prepared.drive];
            part.beyond(vertex.part.clearance) <= 0.0 && drive.beyond(vertex.drive.clearance) <= 0.0
        })
    }
}

/// Where the vectors end that may be looked through together from a vertex on: at one of those that have changed, or after as many as may be.
fn end_from(k: usize, is_changed: &[bool]) -> usize {
    k + is_changed[k..].iter().take(MOST_TOGETHER).take_while(|is_changed| !**is_changed).count()
}

/// The vectors with which stretches begin that leave room of one fewer, the most of it first.
fn by_room(fills: &[f64]) -> Vec<usize> {
    let room = |k: usize| {
        let mut filled = 0.0;
        let room = |(count, fill): (usize, &f64)| {
            filled += fill;
            (count >= LEAST_TOGETHER).then_some(count as f64 - 1.0 - filled)
        };
        (1..=MOST_TOGETHER).zip(&fills[k..]).filter_map(room).fold(f64::NEG_INFINITY, f64::max)
    };
    let mut rooms: Vec<(usize, f64)> =
        (0..fills.len()).map(|k| (k, room(k))).filter(|(_, room)| *room >= ROOM).collect();
    rooms.sort_by(|a, b| b.1.total_cmp(&a.1));
    rooms.into_iter().map(|(k, _)| k).collect()
}

/// The clearances of levels of a band.
fn levels(role: &Working) -> Vec<f64> {
    let limits = [Bend::Convex, Bend::Concave].map(|bend| role.vertex(bend));
    match role.shape {
        Shape::Flat => vec![role.rest()],
        _ => vec![limits[0], limits[1], 0.5 * (limits[0] + limits[1])],
    }
}

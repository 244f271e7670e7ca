//! A search for a path that uses the verifier's clearances alone: it decides whether a motion that the engine refuses has a
//! solution. Gradients are differences, steps are short, nothing is clever.

use std::cell::Cell;

use apt_geometry::{
    Vec3,
    cutter::Cutter,
    motion::{DriveSide, Relation},
};
use arelem::{
    error::RoleName,
    sequence::{CutSequence, Role, Stop, ToolPosition},
    verify::verify,
};

use crate::{
    case::{self, Case, Placed},
    ends::{self, ToldEnd},
};

/// Step of the differences, relative to the band.
const DIFFERENCE: f64 = 0.05;
/// Corrections for one position.
const CORRECTIONS: u32 = 25;
/// How near two starts are one, in bands.
const SAME_START: f64 = 100.0;
/// Steps to the place where the check surface was laid.
const STEPS_TO_STOP: f64 = 60.0;
/// How much shorter they are where a path is looked at again.
const FINER: f64 = 8.0;
/// The path is followed this many times as far as the check surface was laid.
const FAR: f64 = 3.0;
/// Cosine between the direction asked for and the path from which the direction is settled: two degrees from square.
pub(crate) const LEAST_FORWARD: f64 = 0.0349;
/// A path that has the opposite direction after so many steps has turned back.
const TURNING_BACK: usize = 4;
/// Steps after which a path from a corner shows whether it goes in the direction asked for, and cosine below which it was one.
const FIRST_STEPS: usize = 2;
const SAME_WAY: f64 = 0.9;
/// How near to where a motion is told to come to the end of a surface that end is looked for, in steps.
const BY_END: f64 = 2.0;
/// How far beside the place of a tangency a path may lead, in bands: out of a corner that is near the other way leads there.
const AT_PLACE: f64 = 5.0;
/// Cosine between the axes at both ends of a step below which the axis jumps in between.
const SAME_AXIS: f64 = 0.9;
/// Share of a step that is not taken by itself.
const SHORT: f64 = 1e-6;
/// How much farther from the tool than the surface its end may be, relative to the band, where the tool touches it.
const AT_END: f64 = 0.5;
/// A step is halved this often before the path counts as ended.
const HALVINGS: u32 = 6;

/// Whether the check surface is read too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Wanted {
    PathOnly,
    /// The plane that the start-up ends on, on the side on which it leaves the tool.
    First,
    /// The check surface, on this side.
    Stop(f64),
}

/// The axis at a tool end; None where there is none.
pub(crate) type AxisAt<'a> = &'a dyn Fn(&Vec3) -> Option<Vec3>;

/// Reads clearances of a case.
pub(crate) struct Reader<'a> {
    case: &'a Case,
    /// Where the axis is not that of the case all along.
    axis: Option<AxisAt<'a>>,
    cutter: Cutter,
    reads: Cell<u32>,
    asks: Cell<u32>,
}

/// What the search found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Found {
    /// The stop is reached, after a length of path.
    Path(f64),
    /// There is no start position.
    NoStart,
    /// The path ends, or leaves a band, after a length.
    Ends(f64),
    /// The check surface is not met.
    NotMet,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(case: &'a Case) -> Self {
        let cutter = Cutter::from_numbers(&case.cutter, 1.0).expect("a cutter");
        let budget = &case.budget;
        let [reads, asks] = [budget.reads, budget.asks_of_search].map(Cell::new);
        Self { case, axis: None, cutter, reads, asks }
    }

    /// Reads with an axis that depends on the tool end.
    pub(crate) fn turning(case: &'a Case, axis: AxisAt<'a>) -> Self {
        Self { axis: Some(axis), ..Self::new(case) }
    }

    fn axis(&self, tip: &Vec3) -> Option<Vec3> {
        self.axis.map_or(Some(self.case.axis), |axis| axis(tip))
    }

    /// The budget is used up: what the search finds then says nothing.
    pub(crate) fn is_spent(&self) -> bool {
        self.reads.get() == 0 || self.asks.get() == 0
    }

    fn spend(&self) -> bool {
        self.asks.set(self.asks.get().saturating_sub(1));
        self.is_spent()
    }

    fn role(&self, placed: &Placed, side: f64) -> Role {
        Role {
            surface: case::surface(placed),
            relation: if placed.relation == Relation::On { Relation::On } else { Relation::To },
            side,
            inside_tolerance: 1e3,
            outside_tolerance: 1e3,
            thickness: placed.thickness,
            disk: None,
        }
    }

    /// Clearances to part, drive and, if wanted, check surface at a place; None where there are none.
    pub(crate) fn read(&self, tip: &Vec3, wanted: Wanted) -> Option<[f64; 3]> {
        self.reads.set(self.reads.get().saturating_sub(1));
        if self.is_spent() {
            return None;
        }
        self.read_with(&self.cutter, tip, wanted)
    }

    fn read_with(&self, cutter: &Cutter, tip: &Vec3, wanted: Wanted) -> Option<[f64; 3]> {
        let Case { part, drive, first, stop, .. } = self.case;
        let place = ToolPosition { tip: *tip, axis: self.axis(tip)? };
        let check = match wanted {
            Wanted::PathOnly => None,
            Wanted::First => Some(self.role(first, first.side)),
            Wanted::Stop(side) => Some(self.role(stop, side)),
        };
        let sequence = CutSequence {
            start: place,
            points: vec![place],
            cutter: *cutter,
            part: Some(self.role(part, part.side)),
            drive: Some(self.role(drive, drive.side)),
            stop: check.map(|role| Stop { role, occurrence: 1, index: 0 }),
            drive_side: DriveSide::On,
            start_up: true,
            forward: Vec3::zeros(),
            maximum_step: 1e3,
            minimum: None,
        };
        let evidence = verify(&sequence, &|| self.spend()).ok()?;
        let check = evidence.check.map_or(0.0, |c| c.min);
        Some([evidence.part?.min, evidence.drive?.min, check])
    }

    fn band(&self) -> [f64; 2] {
        [-self.case.inside, self.case.outside]
    }

    /// How far a clearance is from the middle of the band, in halves of the band.
    fn miss(&self, clearance: f64) -> f64 {
        let [low, high] = self.band();
        (clearance - 0.5 * (low + high)) / (0.5 * (high - low))
    }

    fn rows(&self, tip: &Vec3, wanted: Wanted, guide: Option<(Vec3, f64)>) -> Option<[f64; 3]> {
        let [part, drive, check] = self.read(tip, wanted)?;
        let third = guide.map_or(self.miss(check), |(normal, distance)| {
            (normal.dot(tip) - distance) / (self.case.inside + self.case.outside)
        });
        Some([self.miss(part), self.miss(drive), third])
    }

    /// A position in all bands near a place: Newton's method with gradients from differences; the third condition is the
    /// check surface or a plane.
    fn settle(&self, from: &Vec3, wanted: Wanted, guide: Option<(Vec3, f64)>) -> Option<Vec3> {
        let step = DIFFERENCE * (self.case.inside + self.case.outside);
        let mut tip = *from;
        let mut rows = self.rows(&tip, wanted, guide)?;
        for _ in 0..CORRECTIONS {
            let worst = worst_of(&rows);
            if worst < 0.9 {
                return Some(tip);
            }
            let mut slopes = nalgebra::Matrix3::zeros();
            for k in 0..3 {
                let mut ahead = tip;
                ahead[k] += step;
                let moved = self.rows(&ahead, wanted, guide)?;
                for (row, (a, b)) in moved.iter().zip(&rows).enumerate() {
                    slopes[(row, k)] = (a - b) / step;
                }
            }
            let residual = Vec3::new(rows[0], rows[1], rows[2]);
            let full = slopes.lu().solve(&residual)?;
            let mut share = 1.0;
            let better = loop {
                let next = tip - full * share;
                if let Some(next_rows) = self.rows(&next, wanted, guide)
                    && worst_of(&next_rows) < worst
                {
                    break Some((next, next_rows));
                }
                share *= 0.5;
                if share < 1e-3 {
                    break None;
                }
            };
            (tip, rows) = better?;
        }
        (worst_of(&rows) < 1.0).then_some(tip)
    }

    /// A position where the start-up may end.
    fn start(&self) -> Option<Vec3> {
        let case = self.case;
        let is_tangent = matches!(case.stop.relation, Relation::TangentToDrive | Relation::TangentToPart);
        let is_laid = case.is_certain && self.axis.is_none();
        if is_laid && !is_tangent {
            return Some(case.place);
        }
        let entry = if is_laid { case.place - case.forward * case.reach } else { case.place };
        let mut places = if is_laid { vec![entry] } else { vec![case.from, entry] };
        for k in 0..27 {
            let [i, j, l] = [k % 3, k / 3 % 3, k / 9].map(|x| f64::from(x) - 1.0);
            places.push(entry + Vec3::new(i, j, l) * 0.6);
        }
        let mut behind: Vec<Vec3> = Vec::new();
        let same = SAME_START * (case.inside + case.outside);
        places.iter().filter_map(|place| self.settle(place, Wanted::First, None)).find(|tip| {
            let is_known = behind.iter().any(|known| (known - tip).norm() <= same);
            if !is_known && !self.is_behind(tip) && !self.is_behind_end(tip) {
                return true;
            }
            behind.push(*tip);
            false
        })
    }

    /// Whether points on the axis of the tool are on the other side of a surface: one that ends, behind which the tool touches it
    /// nowhere, or with another of its places.
    fn is_behind(&self, tip: &Vec3) -> bool {
        let Case { part, drive, inside, .. } = self.case;
        let Some(axis) = self.axis(tip) else { return true };
        let point = Cutter::from_numbers(&[0.0], 0.0).expect("a point");
        let height = self.cutter.height;
        [0.0, 0.5, 1.0].iter().any(|share| {
            let place = tip + axis * (share * height);
            let read = self.read_with(&point, &place, Wanted::PathOnly);
            let beyond = |(placed, value): (&Placed, f64)| placed.relation != Relation::On && value < -inside;
            read.is_none_or(|[on_part, on_drive, _]| {
                [(part, on_part), (drive, on_drive)].into_iter().any(beyond)
            })
        })
    }

    /// Whether the tool touches the end of a surface from behind: it is on no side of that.
    fn is_behind_end(&self, tip: &Vec3) -> bool {
        let Case { part, drive, .. } = self.case;
        let Some(axis) = self.axis(tip) else { return false };
        let Some([on_part, on_drive, _]) = self.read(tip, Wanted::PathOnly) else { return false };
        [(part, on_part), (drive, on_drive)].into_iter().any(|(placed, clearance)| {
            ends::is_from_behind(placed, (&self.cutter, &axis), tip, self.by_end(placed, clearance))
        })
    }

    /// How far from a tool with such a clearance an end is that it touches, and the band.
    fn by_end(&self, placed: &Placed, clearance: f64) -> [f64; 2] {
        let band = self.case.inside + self.case.outside;
        [clearance.abs() + placed.thickness + AT_END * band, band]
    }

    /// Unit tangent of the path in a sense.
    fn tangent(&self, tip: &Vec3, sense: &Vec3) -> Option<Vec3> {
        let step = DIFFERENCE * (self.case.inside + self.case.outside);
        let mut slopes = [Vec3::zeros(); 2];
        for k in 0..3 {
            let (mut ahead, mut behind) = (*tip, *tip);
            ahead[k] += step;
            behind[k] -= step;
            let (a, b) = (self.read(&ahead, Wanted::PathOnly)?, self.read(&behind, Wanted::PathOnly)?);
            for (role, slope) in slopes.iter_mut().enumerate() {
                slope[k] = a[role] - b[role];
            }
        }
        let tangent = slopes[0].cross(&slopes[1]).try_normalize(0.0)?;
        Some(if tangent.dot(sense) < 0.0 { -tangent } else { tangent })
    }

    /// The function whose sign tells on which side of the check surface the tool is.
    fn check(&self, tip: &Vec3) -> Option<f64> {
        let above = self.read(tip, Wanted::Stop(1.0))?[2];
        if self.case.stop.relation == Relation::On || above >= 0.0 {
            return Some(above);
        }
        Some(above.max(self.read(tip, Wanted::Stop(-1.0))?[2]))
    }

    /// Whether the path comes to the end of a surface where a motion is told so.
    fn is_over(&self, told: &ToldEnd, tip: &Vec3, sense: &Vec3) -> bool {
        let Case { part, drive, inside, outside, .. } = self.case;
        let Some(axis) = self.axis(tip) else { return false };
        let placed = if told.role == RoleName::Part { part } else { drive };
        let Some([on_part, on_drive, _]) = self.read(tip, Wanted::PathOnly) else { return false };
        let clearance = if told.role == RoleName::Part { on_part } else { on_drive };
        // A tool that is ON a surface leaves it with its end, where that is: from beside it, it is as far as it is thick.
        if placed.relation == Relation::On && sense.dot(&(told.tip - tip)) > inside + outside {
            return false;
        }
        let point = Cutter::from_numbers(&[0.0], 0.0).expect("a point");
        let guided = if placed.relation == Relation::On { &point } else { &self.cutter };
        ends::is_over(placed, (guided, &axis), tip, self.by_end(placed, clearance), sense)
    }

    /// Whether the motion from a start (or from where the search finds one) has a solution. The path ends where it leads over the end of
    /// a surface, as the motion was told. A path counts that is found in short steps, too: a long one may lead over a bend.
    pub(crate) fn search(&self, start: Option<Vec3>, told: Option<ToldEnd>) -> Found {
        let Some(tip) = start.or_else(|| self.start()) else { return Found::NoStart };
        let long = self.case.reach / STEPS_TO_STOP;
        match self.follow(tip, told, long) {
            Found::Path(_) => self.follow(tip, told, long / FINER),
            found => found,
        }
    }

    /// The direction asked for at a place, across the tool axis, and the line of motion in its sense; none where the motion cannot begin, as it
    /// points across the path.
    pub(crate) fn setting_out(&self, tip: &Vec3) -> Option<[Vec3; 2]> {
        let (forward, axis) = (self.case.forward, self.axis(tip)?);
        let wanted = (forward - axis * axis.dot(&forward)).try_normalize(1e-9)?;
        let line = self.tangent(tip, &wanted)?;
        (line.dot(&wanted).abs() > LEAST_FORWARD).then_some([wanted, line])
    }

    /// The same from a place in steps of a length.
    fn follow(&self, mut tip: Vec3, told: Option<ToldEnd>, long: f64) -> Found {
        let Some([wanted, mut sense]) = self.setting_out(&tip) else { return Found::Ends(0.0) };
        let stops_at_tangency =
            matches!(self.case.stop.relation, Relation::TangentToDrive | Relation::TangentToPart);
        let band = self.case.inside.max(self.case.outside);
        let mut length = 0.0;
        let mut events = Events::new(self.case, band);
        // No part of the tool moves farther than the tool end: so far the check surface need not be read again.
        let mut last: Option<(Vec3, f64)> = None;
        let mut senses = vec![sense; TURNING_BACK];
        while length < FAR * self.case.reach + 1.0 {
            // Where two walls close in, the other one leads back from where the tool came.
            if senses.last() != Some(&sense) {
                senses.push(sense);
            }
            // Where the tool begins in a corner, the tangent there is of neither wall.
            if senses.len() == TURNING_BACK + FIRST_STEPS
                && sense.dot(&senses[0]) < SAME_WAY
                && sense.dot(&wanted) <= LEAST_FORWARD
            {
                return Found::Ends(length);
            }
            if senses[senses.len() - TURNING_BACK].dot(&sense) < 0.0 {
                return events.at_end(length);
            }
            let by_end = told.filter(|told| (told.tip - tip).norm() <= BY_END * long);
            // The place itself is not passed over.
            let until = by_end.map(|told| sense.dot(&(told.tip - tip))).filter(|ahead| *ahead > SHORT * long);
            let step = until.map_or(long, |ahead| ahead.min(long));
            let is_over = by_end.is_some_and(|told| self.is_over(&told, &tip, &sense));
            if stops_at_tangency {
                // It was laid there.
                let rest = self.case.place - tip;
                if rest.norm() <= AT_PLACE * (self.case.inside + self.case.outside) {
                    return Found::Path(length);
                }
                let ahead = sense.dot(&rest);
                let is_aside = rest.norm() <= 1.5 * long && ahead <= SHORT * long;
                if is_over || is_aside {
                    return Found::Ends(length);
                }
                let step = if rest.norm() <= 1.5 * long { step.min(ahead) } else { step };
                let Some((next, next_sense)) = self.step(&tip, &sense, step) else {
                    return Found::Ends(length);
                };
                length += (next - tip).norm();
                (tip, sense) = (next, next_sense);
                continue;
            }
            // What any point of the tool has moved by since the check surface was read.
            let way = last.map_or(0.0, |(at, _)| (tip - at).norm() + self.swung(&at, &tip));
            let value = match last {
                Some((at, value)) if (tip - at).norm() + band < value.abs() => value,
                _ => {
                    let Some(value) = self.check(&tip) else { return Found::Ends(length) };
                    last = Some((tip, value));
                    value
                }
            };
            if let Some(at) = events.note(value, length, way) {
                return Found::Path(at);
            }
            if is_over {
                return events.at_end(length);
            }
            let Some((next, next_sense)) = self.step(&tip, &sense, step) else {
                return events.at_end(length);
            };
            length += (next - tip).norm();
            (tip, sense) = (next, next_sense);
        }
        Found::NotMet
    }

    /// How far the top of the tool swings out where its axis turns between two places.
    fn swung(&self, from: &Vec3, to: &Vec3) -> f64 {
        let turn = self.axis(from).zip(self.axis(to)).map_or(0.0, |(a, b)| (a - b).norm());
        turn * self.cutter.height
    }

    fn step(&self, tip: &Vec3, sense: &Vec3, long: f64) -> Option<(Vec3, Vec3)> {
        let mut length = long;
        for _ in 0..=HALVINGS {
            let goal = tip + sense * length;
            let guide = Some((*sense, sense.dot(&goal)));
            if let Some(next) = self.settle(&goal, Wanted::PathOnly, guide)
                && (next - tip).norm() < 3.0 * length
                && (next - tip).dot(sense) > 0.0
                && self.axis(&next)?.dot(&self.axis(tip)?) > SAME_AXIS
                && let Some(next_sense) = self.tangent(&next, &(next - tip))
            {
                return Some((next, next_sense));
            }
            length *= 0.5;
        }
        None
    }
}

fn worst_of(rows: &[f64; 3]) -> f64 {
    rows.iter().fold(0.0, |w: f64, r| if r.is_nan() { f64::INFINITY } else { w.max(r.abs()) })
}

/// The positions at a check surface that a path comes to.
struct Events<'a> {
    case: &'a Case,
    band: f64,
    /// Whether the tool is clear of it, since that was beyond doubt.
    is_clear: Option<bool>,
    met: u32,
    /// Where the path has come to the other state, which is not beyond doubt yet: it may only brush the band.
    brushed: Option<f64>,
    /// The last clearance.
    last: Option<f64>,
}

impl<'a> Events<'a> {
    fn new(case: &'a Case, band: f64) -> Self {
        Self { case, band, is_clear: None, met: 0, brushed: None, last: None }
    }

    /// Takes a clearance after a length of path, since the last of which no point of the tool has moved farther than a way; the length
    /// at the position asked for, once it is known to be one.
    ///
    /// No clearance changes by more than the tool moves. One that does leaps where the check surface ends beside the tool, beyond which its
    /// sign says nothing: that is no position.
    fn note(&mut self, value: f64, length: f64, way: f64) -> Option<f64> {
        let leaps = self.last.replace(value).is_some_and(|last| (value - last).abs() > way + self.band);
        let (now, is_certain) = (value > 0.0, value.abs() > self.band);
        let Some(before) = self.is_clear else {
            self.is_clear = is_certain.then_some(now);
            return None;
        };
        if before == now {
            self.brushed = None;
            return None;
        }
        if leaps {
            (self.is_clear, self.brushed) = (is_certain.then_some(now), None);
            return None;
        }
        let at = *self.brushed.get_or_insert(length);
        if !is_certain {
            return None;
        }
        let found = self.is_asked_for(before).then_some(at);
        self.met += u32::from(self.counts(before));
        (self.is_clear, self.brushed) = (Some(now), None);
        found
    }

    /// What is found where the path goes no farther.
    fn at_end(&self, length: f64) -> Found {
        let position = self.brushed.filter(|_| self.is_clear.is_some_and(|before| self.is_asked_for(before)));
        position.map_or(Found::Ends(length), Found::Path)
    }

    /// Whether the change out of a state is a position of the motion's label.
    fn counts(&self, was_clear: bool) -> bool {
        match self.case.stop.relation {
            Relation::To => was_clear,
            Relation::Past => !was_clear,
            _ => true,
        }
    }

    fn is_asked_for(&self, was_clear: bool) -> bool {
        self.counts(was_clear) && self.met + 1 >= self.case.stop.occurrence
    }
}

//! Replay of the stop condition: the last position must be the n-th event of its label (arelem reference 3, 5.4, 6.1).
//!
//! For TO and PAST the tool is *clear* of the check surface on either side or *in violation*; entering violation is a TO
//! position, leaving it a PAST position. For ON the tool end changes sides. What only brushes the tolerance band is
//! counted apart: a processor may or may not call it a position.

use apt_geometry::{motion::Relation, patience::Patience};

use crate::sequence::{CutSequence, Role, ToolPosition};

use super::clearance::{Clearance, Surface};
use super::span::{between, turning};
use super::tool::Profile;

/// Steps of the replay over the whole sequence; the shortest step is the path length divided by this.
const FINEST_STEPS: f64 = 20_000.0;
/// How far beyond the band, in bands, the tool must be for its state to be beyond doubt.
const CERTAIN: f64 = 1.5;

/// What is beyond doubt about the tool and the check surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// In the band since the start.
    Touching,
    /// Clear (TO, PAST) or on the positive side (ON).
    Clear,
    /// In violation (TO, PAST) or on the negative side (ON).
    Violating,
}

/// Events along the path before the last position.
#[derive(Debug, Default, Clone, Copy)]
struct Count {
    certain: u32,
    doubtful: u32,
}

/// Number of the position found, if it is not the one asked for.
pub(super) struct WrongEvent {
    /// The position, of its label, at which the sequence really stops; zero if it is none.
    pub(super) found: u32,
}

/// Replays the sequence against its check surface. None where there is no distance, or when it is given up.
pub(super) fn replay(
    sequence: &CutSequence,
    (role, occurrence): (&Role, u32),
    (surface, profile): (&Surface, &Profile),
    guard: f64,
    patience: Patience<'_>,
) -> Option<Result<(), WrongEvent>> {
    let band = CERTAIN * role.inside_tolerance.max(role.outside_tolerance) + guard;
    let on = role.relation == Relation::On;
    if !on && profile.widest() <= 2.0 * band {
        // A tool thinner than the band is never in violation beyond doubt.
        return Some(Ok(()));
    }
    let thickness = if on { 0.0 } else { role.thickness };
    // The cutter itself stops at check surfaces, whatever disk there is for the others.
    let allowed = role.inside_tolerance;
    let make = |side: f64| Clearance { surface, profile, raise: 0.0, side, thickness, allowed, patience };
    let (natural, opposite) = (make(1.0), make(-1.0));
    let measure = |p: &ToolPosition| -> Option<f64> {
        let first = natural.at(&p.tip, &p.axis)?.value;
        if on || first > band {
            return Some(first);
        }
        Some(first.max(opposite.at(&p.tip, &p.axis)?.value))
    };
    let zone = Zone { band, near: band + elsewhere(sequence) };
    let Walked { state, count, since } = walk(sequence, zone, &measure, role.relation)?;
    let end = measure(sequence.points.last()?)?;
    let before = match role.relation {
        Relation::To => State::Clear,
        Relation::Past => State::Violating,
        _ => state,
    };
    // A position is where the tool just touches the check surface (arelem reference 5.4), or is in the middle of its band, to which vertices are
    // moved as well: the path may go through the one level and only come near to the other.
    let levels = [0.0, 0.5 * (role.outside_tolerance - role.inside_tolerance)];
    let [low, high] = since;
    // Beyond the band, if not beyond doubt, the tool may be taken to have changed its state.
    let may_have_changed = match role.relation {
        // Or it came out past a level and goes in again.
        Relation::To => {
            high > role.outside_tolerance
                || end < high - guard && levels.iter().any(|level| high > level + guard)
        }
        // The other way round.
        Relation::Past => {
            low < -role.inside_tolerance
                || end > low + guard && levels.iter().any(|level| low < level - guard)
        }
        _ => false,
    };
    let arrives = state == before || state == State::Touching || may_have_changed;
    // The tool end may be back on a surface that it went through by less than the band.
    let is_back = match state {
        State::Clear => on && low < -guard,
        State::Violating => on && high > guard,
        State::Touching => false,
    };
    let doubtful = count.doubtful + u32::from(is_back);
    let asked = occurrence.max(1) - 1;
    if arrives && count.certain <= asked && asked <= count.certain + doubtful {
        return Some(Ok(()));
    }
    Some(Err(WrongEvent { found: if arrives { count.certain + 1 } else { 0 } }))
}

/// How far vectors may run elsewhere in the bands of part and drive surface.
fn elsewhere(sequence: &CutSequence) -> f64 {
    let roles = [&sequence.part, &sequence.drive].into_iter().flatten();
    roles.map(|role| role.inside_tolerance + role.outside_tolerance).sum()
}

/// What is beyond doubt about a clearance.
#[derive(Debug, Clone, Copy)]
struct Zone {
    /// Beyond it the state of the tool is.
    band: f64,
    /// Beyond it, too, that no other vectors along the path would touch.
    near: f64,
}

/// What a replay found.
struct Walked {
    /// At the last position.
    state: State,
    count: Count,
    /// Least and greatest clearance since that state was last beyond doubt.
    since: [f64; 2],
}

/// Follows the path with steps that cannot jump a change of state, and counts events.
fn walk(
    sequence: &CutSequence,
    Zone { band, near }: Zone,
    measure: &dyn Fn(&ToolPosition) -> Option<f64>,
    relation: Relation,
) -> Option<Walked> {
    let positions: Vec<ToolPosition> =
        std::iter::once(sequence.start).chain(sequence.points.iter().copied()).collect();
    let total: f64 = positions.windows(2).map(|w| (w[1].tip - w[0].tip).norm()).sum();
    let finest = (total / FINEST_STEPS).max(0.5 * band);
    let mut state = State::Touching;
    let mut brushed = false;
    // Since that state began the tool has been farther away than other vectors may be elsewhere.
    let mut away = false;
    let mut count = Count::default();
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let mut since = none;
    // Path length that is known to hold no change of state.
    let mut safe = 0.0;
    // The clearance before, and how far the tool end has come since.
    let mut last: Option<(f64, f64)> = None;
    for pair in positions.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let move_length = (to.tip - from.tip).norm();
        let turn = turning(&from, &to);
        // With a turning axis the tool moves more than its end; then every vector is looked at closely.
        let mut at = if turn > 0.0 { 0.0 } else { safe };
        while at < move_length {
            let t = at / move_length;
            let value = measure(&between(&from, &to, t)?)?;
            let seen = if value > band {
                Some(State::Clear)
            } else if value < -band {
                Some(State::Violating)
            } else {
                None
            };
            // No clearance changes by more than the way, but around the end of a surface its sign does.
            let leaps = last.is_some_and(|(before, way)| {
                (relation == Relation::On || turn <= 0.0) && (value - before).abs() > way + band
            });
            match seen {
                Some(next) if leaps => (state, brushed, since) = (next, false, none),
                // What comes near again is counted when it has gone away.
                Some(next) if next == state && value.abs() <= near => {
                    (brushed, since) = (brushed || away, none);
                }
                Some(next) => {
                    record(&mut count, relation, state, next, brushed);
                    (state, brushed, since) = (next, false, none);
                    away = value.abs() > near;
                }
                None => (brushed, since) = (true, [since[0].min(value), since[1].max(value)]),
            }
            let step = if turn > 0.0 { finest.max(move_length / 64.0) } else { finest };
            let ahead = (value.abs() - near).max(step);
            // In the band what the tool is least or most in the check surface may be at a vertex.
            let ahead = if seen.is_none() { ahead.min(move_length - at) } else { ahead };
            last = Some((value, ahead));
            at += ahead;
        }
        safe = at - move_length;
    }
    Some(Walked { state, count, since })
}

fn record(count: &mut Count, relation: Relation, from: State, to: State, brushed: bool) {
    let changes = from != to && from != State::Touching;
    let starts = from == State::Touching && brushed;
    match relation {
        Relation::On if changes => count.certain += 1,
        Relation::To if changes && to == State::Violating => count.certain += 1,
        Relation::Past if changes && to == State::Clear => count.certain += 1,
        // The tool end may have gone through and come back.
        Relation::On if brushed && from == to => count.doubtful += 2,
        _ if brushed && (from == to || starts) => count.doubtful += 1,
        _ => {}
    }
}

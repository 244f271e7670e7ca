//! A bend that changes little and is to one side fills the integral of √(κ/8τ), than which points tell hardly more.

use super::{
    super::readings::{MOST, Piece, Readings},
    room,
};

/// Ratio of bends up to which they are steady: the integral is then less than a hundredth from what points tell. Share of a vector that one
/// fills up to which it is straight.
const STEADY: f64 = 1.5;
const STRAIGHT: f64 = 1e-3;
/// Share of a vector up to which the slopes at the ends of a piece of it tell the bend, and its values too little of it.
const SHORT: f64 = 0.05;

/// How a vector bends from reading to reading.
pub(super) struct Turns<'a> {
    pub(super) readings: &'a Readings,
    pieces: [Turn; MOST - 1],
    count: usize,
}

/// What is between two readings: from where to where, what it fills if its bend is steady, and the bends at both ends, the lesser one first.
#[derive(Debug, Clone, Copy)]
struct Turn {
    from: f64,
    to: f64,
    full: f64,
    bends: [f64; 2],
}

impl Turn {
    const NONE: Self = Self { from: 0.0, to: 0.0, full: 0.0, bends: [0.0; 2] };
}

impl<'a> Turns<'a> {
    pub(super) fn of(readings: &'a Readings, band: [f64; 2]) -> Self {
        let mut turns = Self { readings, pieces: [Turn::NONE; MOST - 1], count: 0 };
        for piece in readings.pieces() {
            let (full, whole) = (share_of(&piece, band), piece.to.x - piece.from.x);
            let part = whole / readings.length();
            let bends = match part {
                // What the whole vector would fill with the bend of this piece.
                _ if full <= STRAIGHT * part => [0.0; 2],
                _ if part <= SHORT => [(piece.to.slope - piece.from.slope) / whole; 2],
                _ => {
                    let [a, b] = piece.bends();
                    [a.min(b), a.max(b)]
                }
            };
            let Some(told) = turns.pieces.get_mut(turns.count) else { break };
            *told = Turn { from: piece.from.x, to: piece.to.x, full, bends };
            turns.count += 1;
        }
        turns
    }
}

/// What is filled by such a bend.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Steady {
    pub(super) share: f64,
    /// The least and the greatest bend.
    bends: Option<[f64; 2]>,
}

impl Steady {
    /// The same with a vector between two of its places; `None` if it bends otherwise there.
    pub(super) fn with(self, along: &Turns<'_>, [begin, end]: [f64; 2]) -> Option<Self> {
        let Self { mut share, bends } = self;
        let [mut least, mut greatest] = bends.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        for turn in &along.pieces[..along.count] {
            let (from, to) = (turn.from.max(begin), turn.to.min(end));
            if to <= from {
                continue;
            }
            let whole = turn.to - turn.from;
            share += if to - from < whole { turn.full * (to - from) / whole } else { turn.full };
            least = least.min(turn.bends[0]);
            greatest = greatest.max(turn.bends[1]);
        }
        let (small, great) = (least.abs().min(greatest.abs()), least.abs().max(greatest.abs()));
        let is_steady = least * greatest >= 0.0 && great <= STEADY * small;
        is_steady.then_some(Self { share, bends: Some([least, greatest]) })
    }

    /// On which side of its points the window of a stretch that is full is: the second contact of the longest line is with the limit towards which the
    /// clearance bends.
    pub(super) fn side(&self) -> Option<f64> {
        self.bends.map(|[least, _]| if least >= 0.0 { -1.0 } else { 1.0 })
    }

    /// True if it does not bend away from where the window before it leads: what that is bounded by hinders no vector then.
    pub(super) fn agrees(&self, side: f64) -> bool {
        self.bends.is_none_or(|[least, greatest]| if side < 0.0 { least >= 0.0 } else { greatest <= 0.0 })
    }
}

/// What a piece fills if its bend is steady.
pub(super) fn share_of(piece: &Piece, band: [f64; 2]) -> f64 {
    room(band).map_or(0.0, |room| (piece.turning() / (8.0 * room)).sqrt())
}

//! A bend that changes little and is to one side fills the integral of √(κ/8τ), than which points tell hardly more.

use super::{
    super::readings::{Piece, Readings},
    room,
};

/// Ratio of bends up to which they are steady: the integral is then less than a hundredth from what points tell. Share of a vector that one
/// fills up to which it is straight.
const STEADY: f64 = 1.5;
const STRAIGHT: f64 = 1e-3;
/// Share of a vector up to which the slopes at the ends of a piece of it tell the bend, and its values too little of it.
const SHORT: f64 = 0.05;

/// What is filled by such a bend.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Steady {
    pub(super) share: f64,
    /// The least and the greatest bend.
    bends: Option<[f64; 2]>,
}

impl Steady {
    /// The same with a vector between two of its places; `None` if it bends otherwise there.
    pub(super) fn with(self, readings: &Readings, band: [f64; 2], [begin, end]: [f64; 2]) -> Option<Self> {
        let Self { mut share, bends } = self;
        let [mut least, mut greatest] = bends.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        for piece in readings.pieces() {
            let (from, to) = (piece.from.x.max(begin), piece.to.x.min(end));
            if to <= from {
                continue;
            }
            let full = share_of(&piece, band);
            let whole = piece.to.x - piece.from.x;
            share += if to - from < whole { full * (to - from) / whole } else { full };
            let part = whole / readings.length();
            // What the whole vector would fill with the bend of this piece.
            let as_whole = full / part;
            let bends = match part {
                _ if as_whole <= STRAIGHT => [0.0; 2],
                _ if part <= SHORT => [(piece.to.slope - piece.from.slope) / whole; 2],
                _ => piece.bends(),
            };
            least = least.min(bends[0].min(bends[1]));
            greatest = greatest.max(bends[0].max(bends[1]));
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

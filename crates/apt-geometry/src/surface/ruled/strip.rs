//! Strips of rulings, and trees of them. A strip lies in a plate about its middle ruling: along that and aside as far as it reaches, and as thick as
//! its rulings turn and its curves bend. Beside a surface that is nearly flat over a strip that tells its distance far closer than a ball about
//! the ruling does, so that few strips have to be looked at for the nearest place.

use super::{
    super::{
        part::{Later, Part, Summary},
        perpendicular,
    },
    RuledSheet, UNITS_A_PIECE,
    bounds::ranges,
};
use crate::{Vec3, patience::Patience};

/// Rounding of places, relative to the size of the surface.
const ROUNDING: f64 = 1e-13;

/// All rulings of a range of the parameter, between two shares along them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Strip {
    pub(super) piece: usize,
    pub(super) range: [f64; 2],
    pub(super) shares: [f64; 2],
    /// The middle ruling: a point and the way to its other end.
    pub(super) middle: [Vec3; 2],
    /// No point of the strip is farther from its middle ruling.
    pub(super) radius: f64,
    plate: Plate,
    /// The curvature of a leaf.
    pub(super) part: Later<Box<Part>>,
    /// That of all leaves below, once all of them are known.
    pub(super) summary: Later<Summary>,
}

/// What holds a strip: a box about its middle ruling.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plate {
    /// Unit directions: along the ruling, aside from it in the surface, and across both.
    frame: [Vec3; 3],
    /// How far it reaches along the ruling beyond both ends, aside of it to both sides, and above and below.
    beyond: f64,
    wide: f64,
    thick: f64,
    /// Length of the ruling.
    length: f64,
}

/// Where a piece of a strip is at one end of the middle ruling: the way from there to its middle, how far it reaches from that in some
/// directions, and besides.
struct Held {
    middle: Vec3,
    ways: [Vec3; 3],
    besides: f64,
}

impl Plate {
    const EMPTY: Self = Self {
        frame: [Vec3::new(0.0, 0.0, 0.0); 3],
        beyond: 0.0,
        wide: 0.0,
        thick: f64::NEG_INFINITY,
        length: 0.0,
    };

    /// About a ruling, with a direction that is to lie in it. Between the ends of the ruling places are between those there.
    fn holding(along: &Vec3, wanted: &Vec3, held: &[Held]) -> Self {
        let length = along.norm();
        let ruling = along.try_normalize(0.0).unwrap_or_else(Vec3::x);
        let aside = (wanted - ruling * wanted.dot(&ruling)).try_normalize(0.0);
        let aside = aside.unwrap_or_else(|| perpendicular(&ruling));
        let frame = [ruling, aside, ruling.cross(&aside)];
        let reach = |unit: &Vec3| {
            let far = |held: &Held| {
                let ways: f64 = held.ways.iter().map(|way| way.dot(unit).abs()).sum();
                held.middle.dot(unit).abs() + ways + held.besides
            };
            held.iter().map(far).fold(0.0, f64::max)
        };
        let [beyond, wide, thick] = frame.each_ref().map(reach);
        Self { frame, beyond, wide, thick, length }
    }

    /// How far a place is from it, by the way from the beginning of the ruling.
    fn distance(&self, way: &Vec3) -> f64 {
        let Self { frame: [ruling, aside, across], beyond, wide, thick, length } = self;
        let along = way.dot(ruling);
        let outside = [
            (-beyond - along).max(along - length - beyond),
            way.dot(aside).abs() - wide,
            way.dot(across).abs() - thick,
        ];
        Vec3::from(outside.map(|far| far.max(0.0))).norm()
    }

    /// How far it reaches from places of the ruling, in each direction of its frame.
    fn sides(&self) -> [Vec3; 3] {
        let [ruling, aside, across] = self.frame;
        [ruling * self.beyond, aside * self.wide, across * self.thick]
    }
}

impl Strip {
    fn empty(shares: [f64; 2]) -> Self {
        Self {
            piece: usize::MAX,
            range: [0.0; 2],
            shares,
            middle: [Vec3::zeros(); 2],
            radius: f64::NEG_INFINITY,
            plate: Plate::EMPTY,
            part: Later::new(),
            summary: Later::new(),
        }
    }

    /// No point of the strip is nearer than this.
    pub(super) fn bound(&self, p: &Vec3) -> f64 {
        self.plate.distance(&(p - self.middle[0]))
    }
}

impl RuledSheet {
    /// A heap-ordered tree over ranges; a leaf keeps its own range and piece. `None` where who waits gives up.
    pub(super) fn tree(
        &self,
        ranges: &[(usize, [f64; 2])],
        shares: [f64; 2],
        patience: Patience<'_>,
    ) -> Option<Vec<Strip>> {
        let leaves = ranges.len().next_power_of_two();
        let empty = Strip::empty(shares);
        let mut nodes = vec![empty.clone(); leaves - 1];
        for &(piece, range) in ranges {
            if patience.ends_after(UNITS_A_PIECE) {
                return None;
            }
            nodes.push(self.strip(piece, range, shares));
        }
        nodes.resize(2 * leaves - 1, empty);
        for node in (0..leaves - 1).rev() {
            if patience.ends_after(1) {
                return None;
            }
            if let (Some(a), Some(b)) = (nodes.get(2 * node + 1), nodes.get(2 * node + 2)) {
                nodes[node] = self.joined(a, b, shares);
            }
        }
        Some(nodes)
    }

    fn strip(&self, piece: usize, range: [f64; 2], shares: [f64; 2]) -> Strip {
        let (middle, half) = (0.5 * (range[0] + range[1]), 0.5 * (range[1] - range[0]));
        let [first, last] = shares.map(|v| self.jet(piece, middle, v));
        let along = last.point - first.point;
        let rounding = ROUNDING * self.size;
        let mut radius: f64 = 0.0;
        let mut held = Vec::with_capacity(2);
        if let Some(curves) = self.pieces.get(piece) {
            // Along a ruling distances from its place on the middle ruling are greatest at an end.
            for (v, jet) in shares.into_iter().zip([&first, &last]) {
                let [places, _, bent] = ranges(curves, middle, half, |e, f| e + (f - e) * v);
                radius = radius.max(places.farthest(&jet.point));
                held.push(Held {
                    middle: Vec3::zeros(),
                    ways: [jet.du * half, Vec3::zeros(), Vec3::zeros()],
                    besides: 0.5 * bent.length() * half * half + rounding,
                });
            }
        }
        let plate = Plate::holding(&along, &(first.du + last.du), &held);
        Strip {
            piece,
            range,
            middle: [first.point, along],
            radius: radius + rounding,
            plate,
            ..Strip::empty(shares)
        }
    }

    /// Two neighbouring strips about the ruling between them. Points at the same share of two rulings are farthest apart
    /// at an end.
    fn joined(&self, a: &Strip, b: &Strip, shares: [f64; 2]) -> Strip {
        if b.piece == usize::MAX {
            return a.clone();
        }
        let ends = shares.map(|v| self.jet(b.piece, b.range[0], v).point);
        let from = |strip: &Strip| {
            let [start, along] = strip.middle;
            [start - ends[0], start + along - ends[1]]
        };
        let reach = |strip: &Strip| {
            let [first, last] = from(strip).map(|way| way.norm());
            strip.radius + first.max(last)
        };
        let along = ends[1] - ends[0];
        let rounding = ROUNDING * self.size;
        let held = [a, b].map(|strip| {
            let ways = strip.plate.sides();
            from(strip).map(|middle| Held { middle, ways, besides: rounding })
        });
        let wanted = [a, b].map(|strip| strip.middle[0] * 2.0 + strip.middle[1]);
        Strip {
            piece: b.piece,
            range: [a.range[0], b.range[1]],
            middle: [ends[0], along],
            radius: reach(a).max(reach(b)),
            plate: Plate::holding(&along, &(wanted[1] - wanted[0]), held.as_flattened()),
            ..Strip::empty(shares)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Surface, sheet_tests};

    /// Every place of a strip is in its plate, at every node of the trees; and plates are thin.
    #[test]
    fn plates_hold_their_strips() {
        let (mut all, mut thinner) = (0, 0);
        for geometry in sheet_tests::sheets() {
            let Ok(Surface::Ruled(sheet)) = Surface::from_geometry(&geometry) else { continue };
            for strip in sheet.bands.iter().flatten().filter(|strip| strip.piece != usize::MAX) {
                all += 1;
                thinner += usize::from(strip.plate.thick < 0.1 * strip.radius);
                let share = |k: i32, [low, high]: [f64; 2]| low + (high - low) * f64::from(k) / 6.0;
                for (i, j) in (0..=6).flat_map(|i| (0..=6).map(move |j| (i, j))) {
                    let (t, v) = (share(i, strip.range), share(j, strip.shares));
                    let last = sheet.pieces.len() - 1;
                    let piece = sheet.pieces.partition_point(|piece| piece.from + piece.width < t).min(last);
                    let place = sheet.jet(piece, t, v).point;
                    let beyond = strip.bound(&place);
                    assert!(beyond <= 1e-12 * sheet.size, "{beyond:e} at {t}, {v} of {:?}", strip.range);
                }
            }
        }
        assert!(2 * thinner > all, "{thinner} of {all}");
    }
}

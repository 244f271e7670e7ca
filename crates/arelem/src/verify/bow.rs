//! How the slope of a clearance to a curve can grow along a straight move: by what the curve bends away from the tool.
//!
//! Where the side of the curve that the tool must not enter holds a circle of radius ρ beneath every contact, the clearance
//! d is at most the distance from that circle, and equal to it at the contact: its second derivative is at most 1/(ρ − d)
//! for a tool that has come in by d. Beneath a curve that stays within a third of a right angle from one direction, as far
//! as the tool can touch it, such a circle is as large as the radius of curvature. Corners add what they turn.

use super::{
    directrix::Piece,
    shadow::{Flat, Level, Shadow, left},
    span::Bend,
};

/// Cosine of the angle between the curve and the contact's tangent that the part in reach may have.
const ALONG: f64 = 0.5;
/// Angle of a corner, radians, above which the slope is not followed.
const SHARP: f64 = 0.05;
/// Angle of a corner, radians, that is rounding.
const ROUNDING: f64 = 1e-12;
/// Share of the radius of curvature that a tool may be too deep.
const DEEPEST: f64 = 0.5;
/// Parts that each piece of a curve is cut into.
const QUARTERS: [f64; 4] = [0.25, 1.0 / 3.0, 0.5, 1.0];

/// A part of a curve with bounds of its curvature.
#[derive(Debug, Clone)]
pub(super) struct Bow {
    piece: Piece,
    /// Greatest curvature to the left and to the right.
    curvature: [f64; 2],
}

/// A tool and how it moves past a curve.
pub(super) struct Passing<'a> {
    /// The tool at the start of the move.
    pub(super) shadow: &'a Shadow<'a>,
    /// Direction of the curve where the tool touches it at the start.
    pub(super) run: Flat,
    /// Whether the tool is on the left of the curve.
    pub(super) left: bool,
    /// Length of the move.
    pub(super) length: f64,
    /// The clearances at its ends.
    pub(super) values: [f64; 2],
}

fn split(c: &[Flat; 4], t: f64) -> [[Flat; 4]; 2] {
    let lerp = |a: &Flat, b: &Flat| a + (b - a) * t;
    let (ab, bc, cd) = (lerp(&c[0], &c[1]), lerp(&c[1], &c[2]), lerp(&c[2], &c[3]));
    let (abc, bcd) = (lerp(&ab, &bc), lerp(&bc, &cd));
    let all = lerp(&abc, &bcd);
    [[c[0], ab, abc, all], [all, bcd, cd, c[3]]]
}

/// Bounds of the curvature of a cubic to both sides: cross product of both derivatives over the cube of the speed. None
/// where the speed may vanish.
fn curvature(c: &[Flat; 4]) -> Option<[f64; 2]> {
    let chord = (c[3] - c[0]).try_normalize(0.0)?;
    let first = [c[1] - c[0], c[2] - c[1], c[3] - c[2]].map(|d| d * 3.0);
    let second = [first[1] - first[0], first[2] - first[1]].map(|d| d * 2.0);
    // The speed is at least its part along the chord, and across the chord that of the least slope.
    let advance = first.iter().map(|d| d.dot(&chord)).fold(f64::INFINITY, f64::min);
    let across = first.map(|d| chord.perp(&d));
    let same_sign = across.iter().all(|a| *a > 0.0) || across.iter().all(|a| *a < 0.0);
    let least = across.iter().map(|a| a.abs()).fold(f64::INFINITY, f64::min);
    let speed = advance.hypot(if same_sign { least } else { 0.0 });
    if advance <= 0.0 {
        return None;
    }
    // The product of a quadratic and a linear polynomial, by control values.
    let cross = |i: usize, j: usize| first[i].perp(&second[j]);
    let products = [
        cross(0, 0),
        (2.0 * cross(1, 0) + cross(0, 1)) / 3.0,
        (cross(2, 0) + 2.0 * cross(1, 1)) / 3.0,
        cross(2, 1),
    ];
    let most = |sense: f64| products.iter().map(|p| sense * p).fold(0.0, f64::max) / speed.powi(3);
    Some([most(1.0), most(-1.0)])
}

/// A cubic in parts.
pub(super) fn bows(control: &[Flat; 4]) -> Vec<Bow> {
    let mut rest = *control;
    QUARTERS
        .iter()
        .map(|t| {
            let [part, more] = split(&rest, *t);
            rest = more;
            let curvature = curvature(&part).unwrap_or([f64::INFINITY; 2]);
            Bow { piece: Piece::new(part, 0), curvature }
        })
        .collect()
}

impl Bow {
    /// A straight part.
    pub(super) fn straight(piece: Piece) -> Self {
        Self { piece, curvature: [0.0; 2] }
    }

    /// The same part in the other direction.
    pub(super) fn turned_round(self) -> Self {
        let Self { piece, curvature: [a, b] } = self;
        let [p, q, r, s] = *piece.control();
        Self { piece: Piece::new([s, r, q, p], 0), curvature: [b, a] }
    }

    pub(super) fn start(&self) -> Flat {
        self.piece.control()[0]
    }

    pub(super) fn end(&self) -> Flat {
        self.piece.control()[3]
    }

    fn edges(&self) -> [Flat; 3] {
        let [a, b, c, d] = self.piece.control();
        [b - a, c - b, d - c]
    }
}

impl Passing<'_> {
    /// How far the tool can be from what it touches during the move, and how deep in it.
    fn reach(&self) -> [f64; 2] {
        let [first, last] = self.values;
        let depth = (0.5 * self.length - first.min(last)).max(0.0);
        [first.max(last).max(0.0) + depth + 2.0 * self.length, depth]
    }

    /// The bound for a curve in connected parts; `ends` are places at which it stops. None where there is none.
    pub(super) fn bend<'b>(&self, bows: impl IntoIterator<Item = &'b Bow>, ends: &[Flat]) -> Option<Bend> {
        let [reach, depth] = self.reach();
        let natural = left(&self.run);
        let facing = self.shadow.level(if self.left { -natural } else { natural });
        let near = |bow: &Bow| {
            let over = |level: &Level| bow.piece.least_above(level) <= reach;
            over(&facing)
                && self.shadow.direction_to(bow.piece.middle()).is_none_or(|n| over(&self.shadow.level(n)))
        };
        if ends.iter().any(|end| facing.above(end) <= reach) {
            return None;
        }
        let mut bend = Bend { rate: 0.0, jumps: 0.0, corners: 0 };
        let mut before: Option<&Bow> = None;
        for bow in bows {
            if !near(bow) {
                before = None;
                continue;
            }
            let edges = bow.edges();
            if edges.iter().any(|e| e.dot(&self.run) < ALONG * e.norm()) {
                return None;
            }
            bend.rate = bend.rate.max(bow.curvature[usize::from(self.left)]);
            if let Some(before) = before {
                let (from, to) = (before.edges()[2], edges[0]);
                let turn = from.perp(&to) / (from.norm() * to.norm());
                let away = if self.left { -turn } else { turn };
                if away > SHARP {
                    return None;
                }
                bend.jumps += 2.0 * away.max(0.0);
                bend.corners += u32::from(away > ROUNDING);
            }
            before = Some(bow);
        }
        let deepest = bend.rate * (depth + self.length);
        if deepest.is_nan() || deepest > DEEPEST {
            return None;
        }
        bend.rate /= 1.0 - deepest;
        Some(bend)
    }
}

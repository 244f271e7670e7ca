//! Surfaces ruled by straight lines over piecewise cubic curves: the tabulated cylinder.

mod beyond;

use apt_geometry::{Vec3, canonical::TabulatedCylinder};

use self::beyond::{Beyond, closing};
use super::{
    bow::{Bow, Passing, bows},
    directrix::{self, Piece},
    shadow::{Flat, Shadow},
    span::Bend,
    strip::{Cubic, Touch, tangent},
    tool::Tool,
};

/// Cosine that two axes of a frame may have to each other: canonical forms are written with a few decimals.
const SKEW: f64 = 1e-5;
/// Halvings of a piece that a tool is deep in, until it is left behind.
const HALVINGS: u32 = 8;
/// Parameter next to the end of a piece that counts as the joint with its neighbour.
const JOINT: f64 = 1e-7;

/// A tabulated cylinder: its directrix as cubics in the plane through the origin across the rulings.
#[derive(Debug, Clone)]
pub(super) struct Ruling {
    curve: Vec<Cubic>,
    /// The same in its plane, across both unit vectors of the frame.
    flat: Vec<Piece>,
    frame: [Vec3; 2],
    bows: Vec<Bow>,
    /// Unit direction of the rulings.
    pub(super) axis: Vec3,
    /// Whether the end tangents meet when drawn out; then the curve closes there.
    closed: bool,
    /// Whether the curve goes on for ever along its end tangents.
    endless: [bool; 2],
    /// Greatest distance of the curve from the origin.
    pub(super) size: f64,
}

fn flat(frame: &[Vec3; 2], x: &Vec3) -> Flat {
    Flat::new(frame[0].dot(x), frame[1].dot(x))
}

impl Ruling {
    /// None if the canonical form describes no curve.
    pub(super) fn of(surface: &TabulatedCylinder) -> Option<Self> {
        let axes = surface.axes;
        let unit = axes.iter().all(|a| a.iter().all(|x| x.is_finite()) && (a.norm() - 1.0).abs() <= SKEW);
        let square = (0..3).all(|i| axes[i].dot(&axes[(i + 1) % 3]).abs() <= SKEW);
        if !unit || !square {
            return None;
        }
        let axis = axes[2] / axes[2].norm();
        let along = axes[0] - axis * axis.dot(&axes[0]);
        let frame = [along / along.norm(), axis.cross(&along) / along.norm()];
        let mut curve = Vec::with_capacity(surface.intervals.len() + 2);
        for (k, interval) in surface.intervals.iter().enumerate() {
            let end = surface.intervals.get(k + 1).map_or(surface.last, |next| [next.u, next.v]);
            // Nothing is between places that are the same: extensions that meet at once.
            if end != [interval.u, interval.v] {
                curve.push(cubic(&frame, [interval.u, interval.v], end, interval.a, interval.b)?);
            }
        }
        let in_plane = |curve: &[Cubic]| -> Vec<Piece> {
            let pieces = curve.iter().enumerate();
            pieces.map(|(k, c)| Piece::new(c.map(|p| flat(&frame, &p)), k)).collect()
        };
        if let Some(inner) = beyond::loop_within(&in_plane(&curve)) {
            curve = curve.drain(inner).collect();
        }
        let defined = in_plane(&curve);
        let (closed, endless) = match Beyond::of(&defined)? {
            Beyond::Nothing => (true, [false; 2]),
            Beyond::Tangents(endless) => (false, endless),
            Beyond::Meeting(meeting) => {
                let straight = |[from, to]: [Flat; 2]| -> Cubic {
                    [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(|t| {
                        let x = from + (to - from) * t;
                        frame[0] * x.x + frame[1] * x.y
                    })
                };
                let [before, after] = closing(meeting, &defined)?.map(|leg| leg.map(straight));
                curve = before.into_iter().chain(curve).chain(after).collect();
                (true, [false; 2])
            }
        };
        let size = curve.iter().flatten().map(|p| p.norm()).fold(0.0, f64::max);
        let flat = in_plane(&curve);
        let bows = flat.iter().flat_map(|piece| bows(piece.control())).collect();
        Some(Self { curve, flat, frame, bows, axis, closed, endless, size })
    }

    /// The pieces of the directrix in the plane through the origin.
    pub(super) fn pieces(&self) -> &[Cubic] {
        &self.curve
    }

    /// The place of the surface nearest to a tool, to within `resolution`; one deeper in it than `deep` ends the search.
    pub(super) fn nearest(&self, tip: &Vec3, tool: &Tool<'_>, resolution: f64, deep: f64) -> Option<Touch> {
        let shadow = Shadow::new(tool, &self.frame, tip);
        let rays: Vec<Piece> = self.rays(&shadow)?.into_iter().flatten().collect();
        let found = directrix::nearest([&self.flat, &rays], &shadow, resolution, deep)?;
        let [outward, place] = [found.level.normal, found.place].map(|x| self.lifted(&x));
        let height =
            self.axis.dot(&(tip + self.across(tip, tool, &outward, &(place - outward * found.value))));
        Some(Touch {
            value: found.value,
            gap: found.gap,
            outward,
            point: place + self.axis * height,
            piece: found.piece,
            along: found.along,
            across: 0.0,
        })
    }

    /// The place of a tool, seen from its end, that goes farthest in a direction and is seen along the rulings at a place, as near as may be: on a straight
    /// piece that lies square to the direction any other goes as far.
    fn across(&self, tip: &Vec3, tool: &Tool<'_>, outward: &Vec3, seen: &Vec3) -> Vec3 {
        let [low, high] = tool.supports(outward);
        let piece = high - low;
        let along = piece - self.axis * self.axis.dot(&piece);
        let square = along.norm_squared();
        // A piece along the rulings touches all along.
        if square <= 0.0 {
            return low;
        }
        low + piece * (along.dot(&(seen - tip - low)) / square).clamp(0.0, 1.0)
    }

    /// Whether a tool that is too deep leaves every place of the surface behind where it is led out by `depth` across the surface
    /// there: what is deep at two places is not as deep as both together.
    pub(super) fn is_left_behind(
        &self,
        side: f64,
        tip: &Vec3,
        tool: &Tool<'_>,
        [depth, resolution]: [f64; 2],
    ) -> Option<bool> {
        let shadow = Shadow::new(tool, &self.frame, tip);
        let rays: Vec<Piece> = self.rays(&shadow)?.into_iter().flatten().collect();
        let mut open: Vec<_> = self.flat.iter().chain(&rays).map(|piece| (piece.clone(), HALVINGS)).collect();
        while let Some((piece, halvings)) = open.pop() {
            let pieces = [std::slice::from_ref(&piece), &[]];
            let seen = |shadow: &Shadow<'_>| {
                let found = directrix::nearest(pieces, shadow, resolution, f64::INFINITY)?;
                Some((found.value >= found.gap, found.level.normal, piece.left_at(found.along)? * side))
            };
            let (is_clear, _, normal) = seen(&shadow)?;
            if is_clear {
                continue;
            }
            let (is_clear, outward, natural) =
                seen(&Shadow::new(tool, &self.frame, &(tip + self.lifted(&normal) * depth)))?;
            if is_clear && outward.dot(&natural) <= 0.0 {
                continue;
            }
            if halvings == 0 {
                return Some(false);
            }
            open.extend(piece.halves().map(|half| (half, halvings - 1)));
        }
        Some(true)
    }

    /// How the slope of the clearance can grow from a position of the tool on, where the surface's normal towards the tool is
    /// `normal`, and no place of the tool moves farther than `travel`; the clearances are without thickness. Of a straight
    /// move to another position only what is across the rulings counts.
    pub(super) fn bend(
        &self,
        side: f64,
        [from, to]: [&Vec3; 2],
        values: [f64; 2],
        normal: &Vec3,
        tool: &Tool<'_>,
        travel: f64,
    ) -> Option<Bend> {
        let shadow = Shadow::new(tool, &self.frame, from);
        let way = to - from;
        let along = way.norm();
        let is_straight = along >= travel;
        let length = if is_straight { flat(&self.frame, &way).norm() } else { travel };
        let share = if is_straight && length > 0.0 { length / along } else { 1.0 };
        let natural = flat(&self.frame, &(normal * side)).try_normalize(0.0)?;
        let run = Flat::new(natural.y, -natural.x);
        let passing = Passing { shadow: &shadow, run, left: side > 0.0, length, values };
        // Where the curve does not go on, it turns to any direction.
        let ends = [self.bows.first()?.start(), self.bows.last()?.end()];
        let stops: Vec<Flat> =
            ends.into_iter().zip(self.endless).filter(|end| !end.1).map(|end| end.0).collect();
        let [before, after] = self.rays(&shadow)?.map(|ray| ray.map(Bow::straight));
        let before = before.map(Bow::turned_round);
        let bend = passing.bend(before.iter().chain(&self.bows).chain(&after), &stops)?;
        Some(Bend { rate: bend.rate * share * share, jumps: bend.jumps * share, ..bend })
    }

    fn lifted(&self, x: &Flat) -> Vec3 {
        self.frame[0] * x.x + self.frame[1] * x.y
    }

    /// What the tangents at both ends go on with, farther than the tool can be concerned; none where the curve does not go on.
    fn rays(&self, shadow: &Shadow<'_>) -> Option<[Option<Piece>; 2]> {
        let (count, first, last) = (self.curve.len(), self.curve.first()?, self.curve.last()?);
        let ray = |from: Vec3, inner: Vec3, index: usize| {
            let [from, out] = [from, from - inner].map(|x| flat(&self.frame, &x));
            let length = 2.0 * ((from - shadow.middle).norm() + shadow.reach()) + out.norm();
            let step = out * (length / (3.0 * out.norm()));
            Piece::new([from, from + step, from + step * 2.0, from + step * 3.0], index)
        };
        let [before, after] = self.endless;
        Some([
            before.then(|| ray(first[0], first[1], count)),
            after.then(|| ray(last[3], last[2], count + 1)),
        ])
    }

    fn normal_at(&self, piece: usize, along: f64) -> Vec3 {
        let last = self.curve.len() - 1;
        let run = match piece {
            p if p <= last => tangent(&self.curve[p], along),
            p if p == last + 1 => self.curve[0][1] - self.curve[0][0],
            _ => self.curve[last][3] - self.curve[last][2],
        };
        let normal = self.axis.cross(&run);
        let size = normal.norm();
        if size > 0.0 { normal / size } else { normal }
    }

    /// The natural normal (−sin φ, cos φ) at a place; at a joint the middle between both sides. None at an end.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        let last = self.curve.len() - 1;
        let here = self.normal_at(touch.piece, touch.along);
        let (at_start, at_end) = (touch.along <= JOINT, touch.along >= 1.0 - JOINT);
        if touch.piece > last || !(at_start || at_end) {
            return Some(here);
        }
        let (is_first, is_last) = (at_start && touch.piece == 0, at_end && touch.piece == last);
        if !self.closed && (is_first || is_last) {
            let [before, after] = self.endless;
            return (if is_first { before } else { after }).then_some(here);
        }
        let count = self.curve.len();
        let beside = if at_start {
            self.normal_at((touch.piece + count - 1) % count, 1.0)
        } else {
            self.normal_at((touch.piece + 1) % count, 0.0)
        };
        let sum = here + beside;
        let size = sum.norm();
        Some(if size > 0.0 { sum / size } else { here })
    }
}

/// The cubic `v = s(s−L)(a(s+L)+b)` over the chord between two points, by its control points.
fn cubic(frame: &[Vec3; 2], start: [f64; 2], end: [f64; 2], a: f64, b: f64) -> Option<Cubic> {
    let lift = |p: [f64; 2]| frame[0] * p[0] + frame[1] * p[1];
    let (first, last) = (lift(start), lift(end));
    let chord = last - first;
    let length = chord.norm();
    if !(length > 0.0 && length.is_finite() && a.is_finite() && b.is_finite()) {
        return None;
    }
    let up = frame[0].cross(&frame[1]).cross(&(chord / length));
    let slopes = [-length * (a * length + b), length * (2.0 * a * length + b)];
    let third = length / 3.0;
    Some([
        first,
        first + chord / 3.0 + up * (slopes[0] * third),
        last - chord / 3.0 - up * (slopes[1] * third),
        last,
    ])
}

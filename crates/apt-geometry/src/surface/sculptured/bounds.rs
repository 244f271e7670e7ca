//! Bounds of the derivatives of a sculptured surface over parts of its patches: control points hold what they control, and
//! intervals what is computed from them.

use super::{
    super::{
        Foot,
        apart::Apart,
        interval::{Box3, Interval},
        part::{Cap, Count, Enclose, Enclosure, Rectangle, Survey},
        sheet::{Jet, Rest},
    },
    SculpturedSheet,
    tree::Node,
};
use crate::{
    Vec3,
    parametric::{Edge, Patch, Side},
};

/// Shares of a rectangle at a pole where it is looked at, from the pole on: first close to it, then all over.
const RING: f64 = 1e-5;
const SAMPLES: u32 = 6;
/// Length of the difference of normals around a pole up to which the surface is smooth there.
const SMOOTH_POLE: f64 = 1e-3;
/// How much more than at the samples the bounds of a cap are.
const MARGIN: f64 = 1.5;
/// Greatest turn of the normal of a cap, and product of its curvature and size.
const LEVEL: f64 = 0.35;

/// A homogeneous value in intervals: three coordinates and the weight.
type Range = [Interval; 4];
/// Homogeneous control points, or differences of them: rows that are in use are whole.
type Net<const ROWS: usize, const COLUMNS: usize> = [[[f64; 4]; COLUMNS]; ROWS];

/// One patch.
pub(super) struct Stretch<'a> {
    pub(super) sheet: &'a SculpturedSheet,
    pub(super) piece: usize,
}

/// The part of a patch over a rectangle.
fn cut(patch: &Patch, rectangle: &Rectangle) -> Patch {
    let shorten = |patch: Patch, [low, high]: [f64; 2], swap: bool| {
        let one = |patch: &Patch, at: f64| if swap { patch.cut_v(at) } else { patch.cut_u(at) };
        let upper = if low > 0.0 { one(&patch, low)[1] } else { patch };
        let share = (high - low) / (1.0 - low);
        if share < 1.0 { one(&upper, share)[0] } else { upper }
    };
    let along = shorten(*patch, rectangle.range(0), false);
    shorten(along, rectangle.range(1), true)
}

/// Differences of control points along the first index, of which there is one less.
fn differences<const R: usize, const LESS: usize, const C: usize>(net: &Net<R, C>) -> Net<LESS, C> {
    let mut apart = [[[0.0; 4]; C]; LESS];
    for (i, row) in apart.iter_mut().enumerate() {
        for (j, point) in row.iter_mut().enumerate() {
            for (k, x) in point.iter_mut().enumerate() {
                *x = net[i + 1][j][k] - net[i][j][k];
            }
        }
    }
    apart
}

/// The same along the second.
fn differences_across<const R: usize, const C: usize, const LESS: usize>(net: &Net<R, C>) -> Net<R, LESS> {
    let mut apart = [[[0.0; 4]; LESS]; R];
    for (i, row) in apart.iter_mut().enumerate() {
        for (j, point) in row.iter_mut().enumerate() {
            for (k, x) in point.iter_mut().enumerate() {
                *x = net[i][j + 1][k] - net[i][j][k];
            }
        }
    }
    apart
}

/// What a form with these control points, times a factor that is not negative, can be.
fn range<const R: usize, const C: usize>(net: &Net<R, C>, factor: f64) -> Range {
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for point in net.iter().flatten() {
        for k in 0..4 {
            // Not `min` and `max`: what is not a number is to be seen.
            low[k] = if point[k] >= low[k] { low[k] } else { point[k] };
            high[k] = if point[k] <= high[k] { high[k] } else { point[k] };
        }
    }
    std::array::from_fn(|k| Interval { low: low[k] * factor, high: high[k] * factor })
}

/// The quotient rule: `(A − Σ kᵢ·wᵢ·pᵢ)/w`, coordinate by coordinate.
fn quotient(value: &Range, less: &[(f64, Interval, &Box3)], weight: Interval) -> Box3 {
    Box3(std::array::from_fn(|k| {
        let sum =
            less.iter().fold(value[k], |sum, (factor, w, p)| sum - Interval::from(*factor) * *w * p.0[k]);
        sum / weight
    }))
}

/// Derivatives over a part of a patch.
struct Derivatives {
    duu: Box3,
    duv: Box3,
    dvv: Box3,
    /// Greatest distance of a control point from the middle.
    reach: f64,
}

/// Derivatives by the parameters of the whole patch; `middle` is the place in the middle of the rectangle.
fn derivatives(patch: &Patch, rectangle: &Rectangle, middle: &Vec3) -> Derivatives {
    let part = cut(patch, rectangle);
    let mut net = [[[0.0; 4]; 4]; 4];
    for (row, controls) in net.iter_mut().zip(&part.control) {
        for (point, c) in row.iter_mut().zip(controls) {
            // From the middle, so that intervals of places are small.
            *point = [c.x - c.w * middle.x, c.y - c.w * middle.y, c.z - c.w * middle.z, c.w];
        }
    }
    let [u, v] = rectangle.half.map(|half| 0.5 / half);
    let by_u: Net<3, 4> = differences(&net);
    let by_v: Net<4, 3> = differences_across(&net);
    let (value, au, av) = (range(&net, 1.0), range(&by_u, 3.0 * u), range(&by_v, 3.0 * v));
    let auu = range::<2, 4>(&differences(&by_u), 6.0 * u * u);
    let auv = range::<3, 3>(&differences_across(&by_u), 9.0 * u * v);
    let avv = range::<4, 2>(&differences_across(&by_v), 6.0 * v * v);
    let w = value[3];
    let place = quotient(&value, &[], w);
    let du = quotient(&au, &[(1.0, au[3], &place)], w);
    let dv = quotient(&av, &[(1.0, av[3], &place)], w);
    let duu = quotient(&auu, &[(2.0, au[3], &du), (1.0, auu[3], &place)], w);
    let duv = quotient(&auv, &[(1.0, au[3], &dv), (1.0, av[3], &du), (1.0, auv[3], &place)], w);
    let dvv = quotient(&avv, &[(2.0, av[3], &dv), (1.0, avv[3], &place)], w);
    let away = part.points().into_iter().flatten().map(|point| (point - middle).norm());
    Derivatives { duu, duv, dvv, reach: away.fold(0.0, f64::max) }
}

impl Stretch<'_> {
    /// The side of a rectangle whose halves turn less.
    pub(super) fn looser(&self, rectangle: &Rectangle) -> usize {
        let Enclosure { jet, duu, duv, dvv, .. } = self.enclose(rectangle);
        let (a, b) = (jet.du.norm().max(f64::MIN_POSITIVE), jet.dv.norm().max(f64::MIN_POSITIVE));
        let [hu, hv] = rectangle.half;
        let mixed = duv.length();
        let turns = [hu * (duu.length() / a + mixed / b), hv * (dvv.length() / b + mixed / a)];
        usize::from(turns[1] > turns[0])
    }
}

/// The sides of a rectangle of parameters that lie on edges of the patch.
fn touched(rectangle: &Rectangle) -> impl Iterator<Item = Edge> {
    let (u, v) = (rectangle.range(0), rectangle.range(1));
    let touched = [u[0] <= 0.0, u[1] >= 1.0, v[0] <= 0.0, v[1] >= 1.0];
    Edge::ALL.into_iter().zip(touched).filter_map(|(edge, touched)| touched.then_some(edge))
}

impl Stretch<'_> {
    /// The edge of the patch that is one point, if the rectangle touches it.
    fn pole(&self, rectangle: &Rectangle) -> Option<Edge> {
        let sides = &self.sheet.pieces.get(self.piece)?.sides;
        touched(rectangle).find(|edge| sides[edge.number()] == Side::Point)
    }

    /// Natural normal and curvatures, seen from the natural side and from the other, at shares of a rectangle.
    fn bent(&self, rectangle: &Rectangle, shares: [f64; 2]) -> Option<(Vec3, [f64; 2])> {
        let piece = self.sheet.pieces.get(self.piece)?;
        let at = [0, 1].map(|k: usize| {
            let [low, high] = rectangle.range(k);
            low + (high - low) * shares[k]
        });
        let jet: Jet = self.sheet.jet(self.piece, at);
        let normal = jet.natural(RING * RING * piece.patch.size())?;
        let shape = jet.hessian(&Foot { distance: 0.0, point: jet.point, normal }, Rest::Inside);
        let bends = shape.symmetric_eigenvalues();
        Some((normal, [bends.max(), -bends.min()]))
    }
}

impl Enclose for Stretch<'_> {
    fn parts(&self) -> &Count {
        &self.sheet.parts
    }

    fn has_pole(&self, rectangle: &Rectangle) -> bool {
        self.pole(rectangle).is_some()
    }

    /// About a pole the parameters have no frame. There the surface is looked at in many places; how far it may bend more
    /// between them is a margin, not a proof.
    fn cap(&self, rectangle: &Rectangle) -> Option<Cap> {
        let piece = self.sheet.pieces.get(self.piece)?;
        let pole = self.pole(rectangle)?;
        let share = |k: u32| f64::from(k) / f64::from(SAMPLES);
        // From the pole on, and along it.
        let place = |away: f64, along: f64| match pole {
            Edge::LowU => [away, along],
            Edge::HighU => [1.0 - away, along],
            Edge::LowV => [along, away],
            Edge::HighV => [along, 1.0 - away],
        };
        let (middle, _) = self.bent(rectangle, [0.5; 2])?;
        let (first, _) = self.bent(rectangle, place(RING, 0.0))?;
        let mut cap = Cap { curvature: [f64::NEG_INFINITY; 2], spread: 0.0 };
        for along in 0..=SAMPLES {
            let (ring, _) = self.bent(rectangle, place(RING, share(along)))?;
            if (ring - first).norm() > SMOOTH_POLE {
                return None;
            }
            for away in 1..=SAMPLES {
                let (normal, bends) = self.bent(rectangle, place(share(away), share(along)))?;
                cap.spread = cap.spread.max((normal - middle).norm());
                cap.curvature = [0, 1].map(|k: usize| cap.curvature[k].max(bends[k]));
            }
            cap.spread = cap.spread.max((ring - middle).norm());
        }
        let size = cap.curvature[0].abs().max(cap.curvature[1].abs());
        cap.curvature = cap.curvature.map(|bend| bend + (MARGIN - 1.0) * size);
        cap.spread *= MARGIN;
        let center = self.sheet.jet(self.piece, rectangle.middle).point;
        let reach = cut(&piece.patch, rectangle).points();
        let reach = reach.iter().flatten().map(|point| (point - center).norm()).fold(0.0, f64::max);
        (cap.spread <= LEVEL && MARGIN * size * reach <= LEVEL).then_some(cap)
    }

    fn middle_of(&self, rectangle: &Rectangle) -> Jet {
        self.sheet.jet(self.piece, rectangle.middle)
    }

    fn enclose(&self, rectangle: &Rectangle) -> Enclosure {
        let jet = self.middle_of(rectangle);
        let Some(piece) = self.sheet.pieces.get(self.piece) else { return Enclosure::unknown(jet) };
        let Derivatives { duu, duv, dvv, reach } = derivatives(&piece.patch, rectangle, &jet.point);
        let mut ends = false;
        let mut sharp = [false; 2];
        for edge in touched(rectangle) {
            match piece.sides[edge.number()] {
                Side::End => (ends, sharp) = (true, [true; 2]),
                Side::Joint { stands_out: [natural, other], .. } => {
                    sharp = [sharp[0] || natural, sharp[1] || other];
                }
                Side::Point => {}
            }
        }
        Enclosure { jet, duu, duv, dvv, reach, sharp, ends, split: false }
    }
}

impl SculpturedSheet {
    /// Whether all leaves keep off a body: the nearest first, after which others add nothing.
    pub(in super::super) fn keeps_apart(&self, asked: &mut Apart<'_>) -> bool {
        let look = |asked: &mut Apart<'_>, node: usize| {
            let (center, radius) = self.nodes.get(node)?.ball();
            Some((asked.ball(&center, radius), node))
        };
        let mut open: Vec<_> = look(asked, 0).into_iter().collect();
        while let Some((least, node)) = open.pop() {
            if asked.is_settled(least) {
                continue;
            }
            match self.nodes.get(node) {
                Some(Node::Fork { children, .. }) => {
                    let mut below = children.map(|child| look(asked, child));
                    if let [Some(a), Some(b)] = &below
                        && a.0 < b.0
                    {
                        below.reverse();
                    }
                    open.extend(below.into_iter().flatten());
                }
                Some(Node::Leaf(leaf)) => {
                    let stretch = Stretch { sheet: self, piece: leaf.piece };
                    if !leaf.part.keeps_apart(&stretch, asked, 0) {
                        return false;
                    }
                }
                None => return false,
            }
        }
        true
    }

    /// Answers a question about the curvature near a place.
    pub(in super::super) fn survey<'a>(&self, mut survey: Survey<'a>) -> Survey<'a> {
        let (center, reach) = (*survey.center(), survey.reach());
        let mut near = Vec::new();
        self.leaves_near(
            |node| node.bound(&center) > reach,
            |leaf| {
                near.push(leaf);
                true
            },
        );
        for leaf in near {
            leaf.part.survey(&Stretch { sheet: self, piece: leaf.piece }, &mut survey);
        }
        survey
    }
}

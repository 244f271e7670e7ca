//! Bounds of the derivatives of a ruled surface over its strips: those of the polynomials that its curves are.

use super::{
    super::{
        apart::Apart,
        interval::{Box3, Interval, shifted, taylor_ranges},
        part::{Count, Enclose, Enclosure, Part, Rectangle, Summary, Survey},
        sheet::Jet,
    },
    Piece, RuledSheet,
    strip::Strip,
};
use crate::Vec3;

/// Distance from the end of a range, relative to a piece, that is rounding.
const AT_END: f64 = 1e-9;
/// How far curves may be from being shifted copies of each other, relative to the surface.
const SHIFTED: f64 = 1e-10;
/// Nodes of a tree that wait to be looked at, usually.
const DEEP: usize = 32;
/// Length of the difference of two unit normals below which pieces join smoothly.
pub(super) const SMOOTH: f64 = 1e-7;

/// Places, first and second derivatives by the parameter of a combination of both curves, over all parameters within `half`
/// of a middle.
pub(super) fn ranges(
    piece: &Piece,
    middle: f64,
    half: f64,
    combine: impl Fn(&Vec3, &Vec3) -> Vec3,
) -> [Box3; 3] {
    let [e, f] = &piece.curves;
    let curve: [Vec3; 6] = std::array::from_fn(|k| combine(&e[k], &f[k]));
    let place = (middle - piece.from) / piece.width;
    let mut found = [Box3::zero(); 3];
    for i in 0..3 {
        let course = taylor_ranges(&shifted(&curve.map(|c| c[i]), place), half / piece.width);
        for (range, value) in found.iter_mut().zip(course) {
            range.0[i] = value;
        }
    }
    let [places, first, second] = found;
    let rate = 1.0 / piece.width;
    [places, first.scaled(rate), second.scaled(rate * rate)]
}

/// One piece of the curves with the rulings between them.
pub(super) struct Stretch<'a> {
    pub(super) sheet: &'a RuledSheet,
    pub(super) piece: usize,
}

impl Enclose for Stretch<'_> {
    fn parts(&self) -> &Count {
        &self.sheet.parts
    }

    fn middle_of(&self, Rectangle { middle: [t, v], .. }: &Rectangle) -> Jet {
        self.sheet.jet(self.piece, *t, *v)
    }

    fn enclose(&self, rectangle: &Rectangle) -> Enclosure {
        let Rectangle { middle: [t, v], half: [along, across] } = *rectangle;
        let jet = self.middle_of(rectangle);
        let Some(piece) = self.sheet.pieces.get(self.piece) else { return Enclosure::unknown(jet) };
        let [_, _, bent] = ranges(piece, t, along, |e, f| e + (f - e) * v);
        let [_, duv, turned] = ranges(piece, t, along, |e, f| f - e);
        let beside = Box3(turned.0.map(|x| Interval::about(0.0, across * x.magnitude())));
        let duu = bent.plus(&beside);
        // Along a ruling places are farthest from the middle at an end.
        let ends = rectangle.range(1).map(|end| {
            let [places, ..] = ranges(piece, t, along, |e, f| e + (f - e) * end);
            places.farthest(&jet.point)
        });
        let reach = ends[0].max(ends[1]);
        let ends = self.ends(piece, rectangle);
        let sharp = if ends { [true; 2] } else { self.sharp(piece, rectangle) };
        // Ends and joints lie at the sides of pieces alone.
        Enclosure { jet, duu, duv, dvv: Box3::zero(), reach, sharp, ends, split: false }
    }
}

impl Stretch<'_> {
    /// The bounds over a strip.
    fn part<'a>(&self, strip: &'a Strip) -> &'a Part {
        strip.part.get(|| Box::new(Part::new(self, Rectangle::between(strip.range, strip.shares))))
    }

    /// Whether the surface ends at a side of a rectangle.
    fn ends(&self, piece: &Piece, rectangle: &Rectangle) -> bool {
        let ([first, last], [low, high]) = (rectangle.range(0), rectangle.range(1));
        let [[from, to], [least, greatest]] = self.sheet.limits;
        let slack = AT_END * piece.width;
        low <= least + AT_END || high >= greatest - AT_END || first <= from + slack || last >= to - slack
    }

    /// Whether creases of the surface at the limits of a rectangle stand out to its sides.
    fn sharp(&self, piece: &Piece, rectangle: &Rectangle) -> [bool; 2] {
        let ([first, last], [low, high]) = (rectangle.range(0), rectangle.range(1));
        let slack = AT_END * piece.width;
        let mut sharp = [false; 2];
        let joints = [
            (first <= piece.from + slack).then(|| (self.piece.checked_sub(1), Some(self.piece), piece.from)),
            (last >= piece.from + piece.width - slack)
                .then(|| (Some(self.piece), Some(self.piece + 1), piece.from + piece.width)),
        ];
        for (before, after, t) in joints.into_iter().flatten() {
            for v in [low, 0.5 * (low + high), high] {
                let found = self.crease(before, after, t, v);
                sharp = [sharp[0] || found[0], sharp[1] || found[1]];
            }
        }
        sharp
    }

    /// Whether the surface stands out at a joint of two pieces; to both sides where it has no normal.
    fn crease(&self, before: Option<usize>, after: Option<usize>, t: f64, v: f64) -> [bool; 2] {
        let last = self.sheet.pieces.len();
        let known = |piece: Option<usize>| piece.filter(|k| *k < last).map(|k| self.sheet.jet(k, t, v));
        let (Some(before), Some(after)) = (known(before), known(after)) else { return [true; 2] };
        let normals = [&before, &after].map(|jet| jet.du.cross(&jet.dv).try_normalize(0.0));
        let [Some(a), Some(b)] = normals else { return [true; 2] };
        if (a - b).norm() <= SMOOTH {
            return [false; 2];
        }
        let turn = (after.du.normalize() - before.du.normalize()).dot(&(a + b));
        [turn <= 0.0, turn >= 0.0]
    }
}

impl RuledSheet {
    /// The direction of all rulings, if both curves are the same but for their place.
    pub(in super::super) fn common_ruling(&self) -> Option<Vec3> {
        let first = self.pieces.first()?;
        let way = first.curves[1][0] - first.curves[0][0];
        let same = self.pieces.iter().all(|piece| {
            let [e, f] = &piece.curves;
            let apart = |k: usize| f[k] - e[k] - if k == 0 { way } else { Vec3::zeros() };
            (0..6).all(|k| apart(k).norm() <= SHIFTED * self.size)
        });
        same.then_some(self.ruling)
    }

    /// Answers a question about the curvature near a place.
    pub(in super::super) fn survey<'a>(&self, mut survey: Survey<'a>) -> Survey<'a> {
        let mut open = Vec::with_capacity(DEEP);
        for nodes in self.bands.iter() {
            open.push(0usize);
            while let Some(node) = open.pop() {
                let Some(strip) = nodes.get(node).filter(|strip| strip.piece != usize::MAX) else { continue };
                survey.counts_node();
                let all = summary(nodes, node);
                if all.is_some_and(|all| survey.is_settled_by(all))
                    || strip.bound(survey.center()) > survey.reach()
                {
                    continue;
                }
                let [first, second] = [2 * node + 1, 2 * node + 2];
                if first < nodes.len() {
                    // What bends most first: much of the rest then adds nothing.
                    let bent = |k: usize| summary(nodes, k).map(|all| all.curvature(survey.side()));
                    let other = bent(first) < bent(second);
                    open.extend(if other { [first, second] } else { [second, first] });
                    continue;
                }
                let stretch = Stretch { sheet: self, piece: strip.piece };
                if strip.part.made().is_none() {
                    survey.counts_part();
                }
                stretch.part(strip).survey(&stretch, &mut survey);
            }
        }
        survey
    }

    /// Whether a strip keeps off a body.
    pub(super) fn strip_keeps_apart(&self, strip: &Strip, asked: &mut Apart<'_>) -> bool {
        let stretch = Stretch { sheet: self, piece: strip.piece };
        stretch.part(strip).keeps_apart(&stretch, asked, 0)
    }
}

/// The bounds over all strips below a node, as far as they have been asked for: each question makes those of one level more.
fn summary(nodes: &[Strip], node: usize) -> Option<&Summary> {
    let strip = nodes.get(node)?;
    if let Some(known) = strip.summary.made() {
        return Some(known);
    }
    let made = if 2 * node + 1 < nodes.len() {
        let known = |k: usize| nodes.get(k).filter(|strip| strip.piece != usize::MAX);
        let below = |k: usize| known(k).map(|strip| strip.summary.made());
        match (below(2 * node + 1), below(2 * node + 2)) {
            (Some(first), Some(second)) => first?.and(second?),
            (Some(one), None) | (None, Some(one)) => *one?,
            (None, None) => return None,
        }
    } else {
        Summary::of(strip.part.made()?)
    };
    Some(strip.summary.get(|| made))
}

#[cfg(test)]
mod tests {
    use super::super::super::{Body, Limit, Surface, sheet_tests};
    use crate::{Vec3, patience::Patience};

    /// What is nearly in contact with a surface is shown to be off it by pieces as small as a thousandth of the gap; they are not kept, and of
    /// few of them bounds are made.
    #[test]
    fn a_proof_beside_a_contact_makes_few_parts() {
        let surface = sheet_tests::surface(&sheet_tests::half_pipe());
        let Surface::Ruled(sheet) = &surface else { panic!("a ruled surface") };
        let foot = surface.foot(&Vec3::new(0.6, 0.9, 1.7));
        let side = foot.distance.signum();
        let center = foot.point + foot.normal * (side * 0.2);
        let away = |place: &Vec3| {
            let way = place - center;
            (way.norm() - 0.2, way.normalize())
        };
        let keeps = |wanted: f64| {
            let limit = Limit { looks: 3000, enough: wanted, patience: Patience::default() };
            surface.keeps_off_body(Body::new(&away), wanted, limit).is_some()
        };
        assert!(keeps(-1e-9) && !keeps(1e-9));
        assert!(sheet.parts.get() <= 60, "{} parts", sheet.parts.get());
    }
}

//! Sculptured surfaces as patches that are cubic both ways. A patch without weights is one; for the others cubics through four
//! places each way stand, and how far those are off is measured between them and counted as an error of every distance.

use apt_geometry::{
    Vec3,
    parametric::{self, ExtendedPatch, SculpturedSurface, Side},
};

use super::{
    patch::{Net, Patch, extent, jet, turned},
    ruled::{ERROR_BEND, through},
    strip::Touch,
    survey::Sheet,
};

/// How far a patch may be off, relative to the size of the surface.
const ACCURACY: f64 = 6e-9;
/// How much farther off it may be than at the places looked at, which lie near its worst ones.
const ALLOWANCE: f64 = 2.0;
/// Bound of the number of patches that stand for one with weights; where more were needed they are as accurate as so many can be.
const PATCHES: usize = 4096;
/// Share of the way to the middle at which the normal is taken where a place has none.
const INWARD: f64 = 1e-5;
/// How far curves may be from being shifted copies of each other, relative to the surface.
const SHIFTED: f64 = 1e-11;
/// Sine of the angle between two directions that are one.
const ONE_DIRECTION: f64 = 1e-10;
/// Sine of the angle between both directions of a patch that is rounding.
const SINGULAR: f64 = 1e-11;

/// A sculptured surface.
#[derive(Debug, Clone)]
pub(super) struct SculpturedStrips {
    pub(super) sheet: Sheet,
    /// Greatest distance from the origin of the surface without what goes on beyond it.
    pub(super) size: f64,
    /// How far a place of a patch may be off the surface.
    pub(super) error: f64,
    /// Direction along which all of it is the same curve, if there is one.
    pub(super) ruling: Option<Vec3>,
}

/// A net in place of a part of the surface, how far it is off, and which of its sides are sharp: low and high along, low and high
/// across.
struct Part {
    net: Net,
    off: f64,
    sharp: [bool; 4],
}

impl SculpturedStrips {
    /// None if there is nothing to measure.
    pub(super) fn of(surface: &SculpturedSurface) -> Option<Self> {
        let extent = surface.size();
        if !(surface.is_finite() && extent > 0.0 && extent.is_finite()) {
            return None;
        }
        let [low, high] = surface.bounds();
        let size = low.abs().sup(&high.abs()).norm();
        let mut parts = Vec::new();
        for patch in surface.extended() {
            cover(&patch, ACCURACY * extent, &mut parts);
        }
        let error = parts.iter().map(|part| part.off).fold(0.0, f64::max);
        let ruling = ruling(&parts, SHIFTED * extent);
        let patches: Vec<Patch> = parts.iter().map(patch).collect();
        let whole = !patches.is_empty() && error.is_finite() && size.is_finite();
        whole.then(|| Self { sheet: Sheet::new(patches, false), size, error, ruling })
    }

    /// The natural normal at a place of a patch.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        let patch = self.sheet.patches.get(touch.piece)?;
        let normal = |at: [f64; 2]| {
            let [_, along, across] = jet(&patch.net, at);
            let (a, b) = (along.norm(), across.norm());
            let normal = along.cross(&across);
            (normal.norm() > SINGULAR * a * b).then(|| normal.normalize())
        };
        let at = [touch.along, touch.across];
        normal(at).or_else(|| normal(at.map(|x| x + INWARD * (0.5 - x))))
    }

    /// Whether a place is as close, in parameters, to a side of its patch at which the surface has an edge.
    pub(super) fn is_sharp(&self, touch: &Touch, close: f64) -> bool {
        let [along, across] = [touch.along, touch.across];
        let at_side = [along, 1.0 - along, across, 1.0 - across].map(|apart| apart <= close);
        let sharp = |patch: &Patch| patch.edges.sides.iter().zip(at_side).any(|(edge, at)| *edge && at);
        self.sheet.patches.get(touch.piece).is_none_or(sharp)
    }
}

/// The direction that all parts have straight lines along, each part the same curve shifted.
fn ruling(parts: &[Part], close: f64) -> Option<Vec3> {
    let across = |net: &Net| -> Option<Vec3> {
        let steps = net.map(|row| row[0] - net[0][0]);
        let way = steps[3].try_normalize(close)?;
        let straight = steps.iter().all(|step| step.cross(&way).norm() <= close);
        let same = (0..4).all(|j| (0..4).all(|i| (net[j][i] - net[0][i] - steps[j]).norm() <= close));
        (straight && same).then_some(way)
    };
    let both = |part: &Part| [across(&part.net), across(&turned(&part.net))];
    both(parts.first()?).into_iter().flatten().find(|way| {
        let agrees = |other: Vec3| other.cross(way).norm() <= ONE_DIRECTION;
        parts.iter().all(|part| both(part).into_iter().flatten().any(agrees))
    })
}

fn patch(part: &Part) -> Patch {
    let mut patch = Patch::new(part.net);
    patch.edges.sides = part.sharp;
    let shortest = extent(&part.net).into_iter().fold(f64::INFINITY, f64::min);
    patch.slack = if part.off > 0.0 { ERROR_BEND * part.off / (shortest * shortest) } else { 0.0 };
    patch
}

/// The nets in place of a patch.
fn cover(given: &ExtendedPatch, accuracy: f64, parts: &mut Vec<Part>) {
    // Edges by their numbers: low and high along u, low and high along v.
    let sharp = given.sides.map(|side| side == Side::End || side.is_crease());
    if given.patch.is_polynomial() {
        parts.push(Part { net: turned(&given.patch.points()), off: 0.0, sharp });
        return;
    }
    let most = parts.len() + PATCHES;
    let mut open = vec![([[0.0, 1.0], [0.0, 1.0]], sharp)];
    while let Some((ranges, sharp)) = open.pop() {
        let (net, errors) = fit(&given.patch, ranges);
        let off = ALLOWANCE * (errors[0] + errors[1]);
        if off <= accuracy || parts.len() + open.len() >= most {
            parts.push(Part { net, off, sharp });
            continue;
        }
        let k = usize::from(errors[1] > errors[0]);
        let middle = 0.5 * (ranges[k][0] + ranges[k][1]);
        let (mut low, mut high) = ((ranges, sharp), (ranges, sharp));
        (low.0[k][1], high.0[k][0]) = (middle, middle);
        (low.1[2 * k + 1], high.1[2 * k]) = (false, false);
        open.extend([high, low]);
    }
}

/// The cubics through four places each way of a part of a patch, and how far they are off along and across.
fn fit(given: &parametric::Patch, [along, across]: [[f64; 2]; 2]) -> (Net, [f64; 2]) {
    let within = |[low, high]: [f64; 2], share: f64| low + (high - low) * share;
    let at = |u: f64, v: f64| given.evaluate(within(along, u), within(across, v)).position;
    let thirds = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let rows = thirds.map(|v| through(&thirds.map(|u| at(u, v))));
    let net = turned(&turned(&rows).map(|column| through(&column)));
    let off = |u: f64, v: f64| (at(u, v) - jet(&net, [u, v])[0]).norm();
    let mut errors = [0.0f64; 2];
    for between in [0.127, 0.5, 0.873] {
        for node in thirds {
            errors[0] = errors[0].max(off(between, node));
            errors[1] = errors[1].max(off(node, between));
        }
    }
    (net, errors)
}

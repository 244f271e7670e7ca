//! Sculptured surfaces as patches that are cubic both ways. A patch without weights is one; for the others cubics through four
//! places each way stand, and how far those are off at most counts as an error of every distance ([`misfit`]).

mod facing;
mod misfit;

use std::{
    cell::OnceCell,
    sync::{Arc, OnceLock},
};

use apt_geometry::{
    Vec3,
    canonical::{Made, Remembering},
    parametric::{self, Extended, ExtendedPatch, Flanged, SculpturedSurface, Side},
    patience::Patience,
};

use self::misfit::Misfit;
use super::{
    models::{Models, WORK_OF_PATCH},
    patch::{Net, Patch, jet, turned},
    ruled::through,
    ruling_clearance::Ruled,
    strip::Touch,
    survey::Sheet,
};

/// How far the finest model may be off, relative to the size of the surface; each coarser one is off so many times more.
const FINEST: f64 = 6e-9;
const COARSER: f64 = 8.0;
/// Number of the models.
const MODELS: usize = 6;
/// Bound of the number of patches that stand for one with weights; where more were needed they are as accurate as so many can be.
const PATCHES: usize = 4096;
/// Side, in parameters, of a part beside a pole that is not halved only because its bend has no bound.
const LEAST_SIDE: f64 = 1e-3;
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
    /// The definition and the model that it is one of, while it is not what is met from a side, and what that is.
    whole: Option<(Remembering<SculpturedSurface>, Arc<Model>)>,
    met: [OnceCell<Option<Box<Ruled>>>; 2],
}

/// What is the same for all motions.
#[derive(Debug)]
struct Model {
    cover: Cover,
    size: f64,
    ruling: Option<Vec3>,
    /// How far patches may be off, and those of the surface as it is met from either side, first that of the natural normal.
    accuracy: f64,
    met: [OnceLock<Cover>; 2],
}

/// Patches in place of a surface, and how far a place of one may be off it.
#[derive(Debug, Clone)]
struct Cover {
    patches: Arc<[Patch]>,
    error: f64,
}

/// A net in place of a part of the surface, how far it is off, how much more the part may bend, and which of its sides are
/// sharp: low and high along, low and high across.
struct Part {
    net: Net,
    off: f64,
    slack: f64,
    sharp: [bool; 4],
}

impl Made for Models<Model> {
    fn parts(&self) -> usize {
        let of = |cover: &Cover| cover.patches.len();
        self.sum(|model| of(&model.cover) + model.met.iter().filter_map(OnceLock::get).map(of).sum::<usize>())
    }
}

impl Model {
    /// None if there is nothing to measure, and once `patience` is over.
    fn of(surface: &Remembering<SculpturedSurface>, accuracy: f64, patience: Patience<'_>) -> Option<Self> {
        let extent = surface.size();
        if !(surface.is_finite() && extent > 0.0 && extent.is_finite()) {
            return None;
        }
        let [low, high] = surface.bounds();
        let size = low.abs().sup(&high.abs()).norm();
        let accuracy = accuracy * extent;
        let parts = covering(Extended::of(surface)?.patches(), accuracy, patience)?;
        let ruling = ruling(&parts, SHIFTED * extent);
        let cover = Cover::of(&parts);
        let whole = !parts.is_empty() && cover.error.is_finite() && size.is_finite();
        whole.then(|| Self { cover, size, ruling, accuracy, met: Default::default() })
    }

    /// The surface with what it is taken for behind its ends by a tool on a side.
    fn met_from(
        &self,
        surface: &Remembering<SculpturedSurface>,
        side: f64,
        patience: Patience<'_>,
    ) -> Option<Cover> {
        let kept = &self.met[usize::from(side < 0.0)];
        if let Some(cover) = kept.get() {
            return Some(cover.clone());
        }
        let parts = covering(Flanged::of(surface)?.patches(side), self.accuracy, patience)?;
        Some(kept.get_or_init(|| Cover::of(&parts)).clone())
    }
}

impl Cover {
    fn of(parts: &[Part]) -> Self {
        let error = parts.iter().map(|part| part.off).fold(0.0, f64::max);
        Self { patches: parts.iter().map(patch).collect(), error }
    }
}

/// The parts in place of patches; none once `patience` is over.
fn covering(patches: &[ExtendedPatch], accuracy: f64, patience: Patience<'_>) -> Option<Vec<Part>> {
    let mut parts = Vec::new();
    for patch in patches {
        cover(patch, (accuracy, patience), &mut parts)?;
    }
    Some(parts)
}

impl SculpturedStrips {
    /// A model of a surface that need not be closer to it than `accuracy`; none if there is nothing to measure, and once `patience` is over.
    pub(super) fn of(
        surface: &Remembering<SculpturedSurface>,
        accuracy: f64,
        patience: Patience<'_>,
    ) -> Option<Self> {
        // One of few, so that motions share it.
        let finer = (accuracy / (FINEST * surface.size())).log(COARSER).floor();
        let number = if finer > 0.0 { (finer as usize).min(MODELS - 1) } else { 0 };
        let models = surface.made(|_| Some(Models::default()))?;
        let relative = FINEST * COARSER.powi(number as i32);
        let model = models.within(relative, |relative| Model::of(surface, relative, patience))?;
        let sheet = Sheet::new(Arc::clone(&model.cover.patches), false);
        let (size, error, ruling) = (model.size, model.cover.error, model.ruling);
        let whole = Some((surface.clone(), model));
        Some(Self { sheet, size, error, ruling, whole, met: Default::default() })
    }

    /// The surface as a tool on a side meets it; none if that is itself, and once `patience` is over.
    pub(super) fn met_from(&self, side: f64, patience: Patience<'_>) -> Option<&Ruled> {
        let (surface, model) = self.whole.as_ref()?;
        let made = || {
            let Cover { patches, error } = model.met_from(surface, side, patience)?;
            let (sheet, size) = (Sheet::of_body(patches), self.size);
            let met = Self { sheet, size, error, ruling: self.ruling, whole: None, met: Default::default() };
            Some(Box::new(Ruled::Sculptured(Box::new(met))))
        };
        self.met[usize::from(side < 0.0)].get_or_init(made).as_deref()
    }

    /// The natural normal at a place of a patch.
    pub(super) fn natural(&self, touch: &Touch) -> Option<Vec3> {
        normal_at(&self.sheet.patches.get(touch.piece)?.net, [touch.along, touch.across])
    }

    /// Whether a place is as close, in parameters, to a side of its patch at which the surface has an edge.
    pub(super) fn is_sharp(&self, touch: &Touch, close: f64) -> bool {
        let [along, across] = [touch.along, touch.across];
        let at_side = [along, 1.0 - along, across, 1.0 - across].map(|apart| apart <= close);
        let sharp = |patch: &Patch| patch.edges.sides.iter().zip(at_side).any(|(edge, at)| *edge && at);
        self.sheet.patches.get(touch.piece).is_none_or(sharp)
    }
}

/// The unit normal, along × across, at a place of a net; where it has none that a little way inside.
fn normal_at(net: &Net, at: [f64; 2]) -> Option<Vec3> {
    let normal = |at: [f64; 2]| {
        let [_, along, across] = jet(net, at);
        let (a, b) = (along.norm(), across.norm());
        let normal = along.cross(&across);
        (normal.norm() > SINGULAR * a * b).then(|| normal.normalize())
    };
    normal(at).or_else(|| normal(at.map(|x| x + INWARD * (0.5 - x))))
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
    patch.slack = part.slack;
    patch
}

/// The nets in place of a patch.
fn cover(
    given: &ExtendedPatch,
    (accuracy, patience): (f64, Patience<'_>),
    parts: &mut Vec<Part>,
) -> Option<()> {
    // Edges by their numbers: low and high along u, low and high along v.
    let sharp = given.sides.map(|side| side == Side::End || side.is_crease());
    if given.patch.is_polynomial() {
        parts.push(Part { net: turned(&given.patch.points()), off: 0.0, slack: 0.0, sharp });
        return Some(());
    }
    let most = parts.len() + PATCHES;
    let mut open = vec![(given.patch, [1.0f64; 2], sharp)];
    while let Some((whole, sides, sharp)) = open.pop() {
        if patience.ends_after(WORK_OF_PATCH) {
            return None;
        }
        let net = fit(&whole);
        let misfit = Misfit::between(&whole, &net);
        let slack = misfit.slack(&net);
        let is_close = misfit.off <= accuracy;
        let is_done = is_close && (slack.is_finite() || sides[0].min(sides[1]) <= LEAST_SIDE);
        if is_done || parts.len() + open.len() >= most {
            parts.push(Part { net, off: misfit.off, slack, sharp });
            continue;
        }
        let k = usize::from(if is_close { turns_across(&net) } else { misfit.is_across() });
        let [first, last] = if k == 0 { whole.halved_u() } else { whole.halved_v() };
        let mut sides = sides;
        sides[k] *= 0.5;
        let (mut low, mut high) = (sharp, sharp);
        (low[2 * k + 1], high[2 * k]) = (false, false);
        open.extend([(last, sides, high), (first, sides, low)]);
    }
    Some(())
}

/// Whether the derivatives of a patch change more across it than along it.
fn turns_across(net: &Net) -> bool {
    let [_, along, across] = jet(net, [0.5; 2]);
    let changes = |places: [[f64; 2]; 2]| {
        let [[_, a, c], [_, b, d]] = places.map(|at| jet(net, at));
        (b - a).norm() / along.norm() + (d - c).norm() / across.norm()
    };
    changes([[0.5, 0.0], [0.5, 1.0]]) > changes([[0.0, 0.5], [1.0, 0.5]])
}

/// The cubics through four places each way.
fn fit(given: &parametric::Patch) -> Net {
    let thirds = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let rows = thirds.map(|v| through(&thirds.map(|u| given.evaluate(u, v).position)));
    turned(&turned(&rows).map(|column| through(&column)))
}

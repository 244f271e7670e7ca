//! What has been shown about a role's clearance and holds for later vectors, too.

use std::cell::Cell;

use apt_geometry::{Vec3, surface::Bend};

use crate::clearance::{
    Certificate, Contact, Gauge, Shape, Tool, Witness, has_closed_form, steady_bend, upward_bend,
};

/// How much farther a bound reaches than the stretch it is made for, so that the next ones need no new one.
const FORESIGHT: f64 = 3.0;
/// The same for quadrics and for surfaces with charts, whose bounds take long to make: at most as far as the tool is wide,
/// over which they change little.
const FORESIGHT_BY_QUADRIC: f64 = 16.0;
const FORESIGHT_BY_CHART: f64 = 24.0;
/// How many times as far as asked for a bound reaches, at least, that is made anew where it does not decide: more than the foresight.
const LOOSE: f64 = 32.0;
/// How many times the distance asked for it is told what of a tool is within it, and for which share of that it is told anew.
const WIDER: f64 = 2.0;
const MUCH_NEARER: f64 = 0.125;
/// Share by which a bound for a vector reaches beyond it, so that rounding does not keep its pieces out.
const BARELY: f64 = 1e-9;
/// Share of the length of a stretch of which the contacts at its ends told nothing up to which they are asked about another one near by: what
/// they leave open grows with its square.
const MUCH_SHORTER: f64 = 0.25;
/// How far from where there was no such bound none is asked for, relative to how far that was to reach.
const CRAMPED: f64 = 0.5;

/// Positions of the tool about one of them.
#[derive(Clone, Copy)]
pub(super) struct About<'a> {
    pub(super) tool: &'a Tool<'a>,
    pub(super) tip: &'a Vec3,
    /// No point of the tool within `reach` of its end strays farther than this from its place there.
    pub(super) spread: f64,
    /// No point of the tool that may be in contact there is farther from its end.
    pub(super) reach: f64,
    /// Points of the tool there that are likely to come into contact.
    pub(super) likely: [Vec3; 2],
}

impl About<'_> {
    /// No point within reach is farther than this from where it was with another tool end and axis: the shortest turn from axis to
    /// axis takes it along by no more than their distance for each unit of its own from the tool end.
    fn moved(&self, tip: &Vec3, axis: &Vec3) -> f64 {
        (self.tip - tip).norm() + self.reach * (self.tool.axis - axis).norm()
    }
}

/// A bound of the second derivatives of a clearance about a place.
#[derive(Debug, Clone, Copy)]
struct Bound {
    tip: Vec3,
    axis: Vec3,
    spread: f64,
    range: [f64; 2],
    bend: f64,
}

/// A region about a place over which there is no bound: nor is there over a greater one.
#[derive(Debug, Clone, Copy)]
struct Gap {
    tip: Vec3,
    axis: Vec3,
    spread: f64,
    range: [f64; 2],
}

impl Bound {
    /// Whether the bound holds about another place: no point of the tool strays farther from where it was when the bound was made.
    fn has(&self, place: &About<'_>, range: [f64; 2]) -> bool {
        place.moved(&self.tip, &self.axis) + place.spread <= self.spread
            && range[0] >= self.range[0]
            && range[1] <= self.range[1]
    }
}

impl Gap {
    fn lies_in(&self, place: &About<'_>, range: [f64; 2]) -> bool {
        place.moved(&self.tip, &self.axis) + self.spread <= place.spread
            && range[0] <= self.range[0]
            && range[1] >= self.range[1]
    }
}

/// At a place no point of the tool that is farther than `reach` from its end is within a distance of the surface.
#[derive(Debug, Clone, Copy)]
struct Reach {
    tip: Vec3,
    axis: Vec3,
    distance: f64,
    reach: f64,
}

/// A level that the clearance at a place is not below.
#[derive(Debug, Clone, Copy)]
struct Level {
    tip: Vec3,
    axis: Vec3,
    level: f64,
}

/// Results worth keeping from one vector to the next.
#[derive(Debug, Default)]
pub(crate) struct Ledger {
    /// The last one that was made where none held, and the last one made anew about a part of what that holds for.
    bounds: Cell<[Option<Bound>; 2]>,
    /// What the steady ball told of all of a vector, for its pieces.
    steady: Cell<Option<Bound>>,
    gap: Cell<Option<Gap>>,
    /// Where there was none that reaches farther than the stretch.
    cramped: Cell<Option<Vec3>>,
    /// Where a bound for all of the tool was of no use when one was last asked for.
    useless: Cell<Option<Vec3>>,
    /// Where the contacts at both ends of a stretch told nothing of it, and its length.
    silent: Cell<Option<(Vec3, f64)>>,
    /// What of the tool told last that there is none.
    witness: [Witness; 2],
    /// What of the tool was near by when that was last asked.
    reach: Cell<Option<Reach>>,
    /// The last two: where a vector begins and where it ends.
    levels: Cell<[Option<Level>; 2]>,
}

impl Ledger {
    /// Whether a bound for all of the tool, which serves many stretches, is to be asked for first: not where the last one near by was
    /// of no use.
    pub(super) fn expects_use(&self, tool: &Tool, tip: &Vec3) -> bool {
        self.useless.get().is_none_or(|last| (tip - last).norm() > tool.radius())
    }

    /// Notes of what use a bound was.
    pub(super) fn note_use(&self, tip: &Vec3, is_of_use: bool) {
        self.useless.set((!is_of_use).then_some(*tip));
    }

    /// Whether the contacts at both ends of a stretch about a place may tell that the tool is clear on it: not where the last ones near by did not.
    pub(super) fn expects_contacts(&self, tool: &Tool, tip: &Vec3, length: f64) -> bool {
        self.silent
            .get()
            .is_none_or(|(last, known)| (tip - last).norm() > tool.radius() || length <= MUCH_SHORTER * known)
    }

    /// Notes that they did not.
    pub(super) fn note_silence(&self, tip: &Vec3, length: f64) {
        self.silent.set(Some((*tip, length)));
    }

    /// No point of the tool that may be within a distance of the surface is farther than this from its end. It is told of a greater distance than
    /// asked for, and so for other positions about, too, but for much shorter distances.
    pub(super) fn reach_within(&self, gauge: &Gauge, tool: &Tool, tip: &Vec3, distance: f64) -> f64 {
        let (reach, distance) = (gauge.reach(tool), distance.max(0.0));
        let about = About { tool, tip, spread: 0.0, reach, likely: [*tip; 2] };
        let tells = |known: &Reach| {
            distance >= MUCH_NEARER * known.distance
                && distance + about.moved(&known.tip, &known.axis) <= known.distance
        };
        if let Some(known) = self.reach.get().filter(tells) {
            return known.reach;
        }
        let distance = WIDER * distance;
        let reach = gauge.reach_within(tool, tip, distance);
        self.reach.set(Some(Reach { tip: *tip, axis: tool.axis, distance, reach }));
        reach
    }

    /// The bound for stretches that are shorter by a ratio, if one is known without a search.
    pub(super) fn bend_of_shorter(
        gauge: &Gauge,
        place: &About<'_>,
        range: [f64; 2],
        ratio: f64,
    ) -> Option<f64> {
        let middle = 0.5 * (range[0] + range[1]);
        let range = range.map(|distance| middle + ratio * (distance - middle));
        steady_bend(gauge, place.tool, place.tip, ratio * place.spread, range)
    }

    /// The bound of [`Ledger::bend`], if one is known that holds there.
    pub(super) fn known_bend(&self, gauge: &Gauge, place: &About<'_>, range: [f64; 2]) -> Option<f64> {
        let known = self.bounds.get().into_iter().flatten().filter(|bound| bound.has(place, range));
        if let Some(bend) = known.map(|bound| bound.bend).min_by(f64::total_cmp) {
            return Some(bend);
        }
        let steady = self.steady.get().filter(|bound| bound.has(place, range)).map(|bound| bound.bend);
        steady.or_else(|| steady_bend(gauge, place.tool, place.tip, place.spread, range))
    }

    /// Keeps what a steady ball tells about a vector, for its pieces.
    pub(super) fn foresee(&self, gauge: &Gauge, place: &About<'_>, range: [f64; 2]) {
        if !gauge.surface.has_charts() {
            return;
        }
        let About { tool, tip, .. } = *place;
        let spread = place.spread * (1.0 + BARELY);
        let bend = steady_bend(gauge, tool, tip, spread, range);
        self.steady.set(bend.map(|bend| Bound { tip: *tip, axis: tool.axis, spread, range, bend }));
    }

    /// Whether all bounds that are known to hold about a place reach so much farther that one for that alone may be much less.
    pub(super) fn is_loose(&self, place: &About<'_>, range: [f64; 2]) -> bool {
        let known = self.bounds.get().into_iter().flatten().filter(|bound| bound.has(place, range));
        known
            .map(|bound| bound.spread)
            .min_by(f64::total_cmp)
            .is_some_and(|least| least > LOOSE * place.spread)
    }

    fn keep(&self, place: &About<'_>, bound: Bound) {
        let [wide, close] = self.bounds.get();
        let is_part = wide.is_some_and(|wide| wide.has(place, bound.range) && bound.spread < wide.spread);
        self.bounds.set(if is_part { [wide, Some(bound)] } else { [Some(bound), close] });
    }

    /// Bound of the second derivative of the clearance for all positions within `spread` of a place at which the
    /// distances of the points of contact are in `range`. There is none once the tool's patience is over; `None` where it is greater than
    /// what `is_of_use` takes.
    pub(super) fn bend(
        &self,
        gauge: &Gauge,
        place: &About<'_>,
        range: [f64; 2],
        is_of_use: &dyn Fn(f64) -> bool,
    ) -> Option<Bend> {
        let About { tool, tip, spread, .. } = *place;
        let nearby = if gauge.surface.has_charts() { FORESIGHT_BY_CHART } else { FORESIGHT_BY_QUADRIC };
        let ample = (FORESIGHT * spread).max((nearby * spread).min(tool.radius()));
        let mut found = Some(Bend::Unbounded);
        let is_cramped = self.cramped.get().is_some_and(|last| (tip - last).norm() <= CRAMPED * ample);
        let wide = (!is_cramped).then_some((ample, ample));
        for (spread, more) in wide.into_iter().chain([(spread, 0.0)]) {
            let range = [range[0] - more, range[1] + more];
            let gap = Gap { tip: *tip, axis: tool.axis, spread, range };
            if self.gap.get().is_some_and(|known| known.lies_in(&About { spread, ..*place }, range)) {
                continue;
            }
            found = upward_bend(
                gauge,
                tool,
                (tip, &place.likely, &self.witness[usize::from(more > 0.0)]),
                spread,
                range,
                is_of_use,
            );
            match found {
                // One that reaches farther may hold a place that bends much more.
                Some(Bend::AtMost(bend)) if more > 0.0 && !is_of_use(bend) => {}
                Some(Bend::AtMost(bend)) => {
                    self.keep(place, Bound { tip: *tip, axis: tool.axis, spread, range, bend });
                    return found;
                }
                Some(Bend::Unbounded) => self.gap.set(Some(gap)),
                None => {}
            }
            if more > 0.0 && found == Some(Bend::Unbounded) {
                self.cramped.set(Some(*tip));
            }
        }
        found
    }

    /// True if no part of the tool is nearer to the surface than a level; by the contact that was found there, if that is known.
    pub(super) fn certified(
        &self,
        gauge: &Gauge,
        tool: &Tool,
        (tip, found): (&Vec3, Option<&Contact>),
        level: f64,
    ) -> bool {
        if !doubtful(gauge, tool, tip) {
            return true;
        }
        let known = self.levels.get();
        if known.iter().flatten().any(|k| k.tip == *tip && k.axis == tool.axis && k.level >= level) {
            return true;
        }
        match gauge.certify(tool, (tip, found), level) {
            Certificate::Holds => {
                self.levels.set([Some(Level { tip: *tip, axis: tool.axis, level }), known[0]]);
                true
            }
            Certificate::Lower(_) | Certificate::Undecided => false,
        }
    }
}

/// True if the search for the contact may take one of several places that are each the nearest around: where tool and
/// solid are both convex, or the clearance has a closed form, it may not.
fn doubtful(gauge: &Gauge, tool: &Tool, tip: &Vec3) -> bool {
    !gauge.on
        && matches!(gauge.shape_along(tool, [tip, tip]), Shape::General | Shape::Concave)
        && !has_closed_form(gauge, tool, tip)
}

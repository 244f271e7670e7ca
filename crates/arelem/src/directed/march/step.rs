//! One cut vector: as long as its proof allows (ADELTA, DELTA). Vertices lie at the limit opposite to the sag, so that
//! the whole band serves the sag; the length is found by a secant on the sag, which grows with the square of it. Where the
//! path begins to bend the other way both limits are tried, and the vertex before may move back on its vector ([`window`]).

mod arriving;
mod at_corner;
mod attempt;
mod corner;
mod corridor;
mod exhaustive;
mod hand;
mod longest;
mod neck;
mod of_use;
mod overlong;
mod sag;
mod sharp_corner;
mod trend;
mod window;

use std::ops::{Deref, DerefMut};

use apt_geometry::{Vec3, patience::Patience};

use self::{arriving::Arrival, hand::Hand, neck::Through, overlong::Overlong, trend::Trend};
use super::{Prepared, Vertex};
use crate::{
    bound::{Readings, Record},
    clearance::{Contact, Shape},
    directed::proof::{self, Extremes, Ledger},
    error::MotionFailure,
    role::{Bend, GUARD, Working},
};

/// Length, relative to the size of the coordinates, below which a vector leads nowhere: well above the size below which a
/// reader of the path takes two positions for one.
const LEAST_VECTOR: f64 = 1e-8;
/// A vector whose length could grow by less than this share is long enough.
const LONG_ENOUGH: f64 = 1e-3;
/// Share of the band that the sag leaves: the less of it, the more places its proof takes.
const SPARED: f64 = 0.25 * GUARD;
/// Share of the predicted length that is tried.
const AIM: f64 = 0.9999;
/// Greatest growth of the length from one trial to the next.
const GREATEST_GROWTH: f64 = 4.0;
/// Ratio of the shortest vector that is too long to the longest that is proven at which no better one is looked for.
const NEARLY: f64 = 1.01;
/// How many times the width of the bands a vector may be long to round a corner of the path of up to a right angle.
const CORNER_BANDS: f64 = 20.0;
/// Shares of the way to the middle of the bands that a vector goes which does not keep its place in them.
const INWARD: [f64; 3] = [0.03, 0.1, 0.3];
/// How many times as long a vector off the limit of a band must be, and one that is not proven at the limit must seem to be, to take its place.
const EASED: f64 = 1.2;
/// A surface whose sag over the longest vector is below this share of its band counts as straight.
const STRAIGHT_SHARE: f64 = 0.02;
/// Length, relative to the size of the coordinates, over which curvature is first estimated.
const PROBE: f64 = 1e-4;

/// Where in the bands a vector ends.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Places {
    /// At the limits opposite to the sag.
    Limits,
    /// Where it begins.
    Level,
    /// Nearer to the middle of the bands by this share.
    Inward(f64),
    /// In the middle of the bands of these roles, at the limits of the others.
    Off([bool; 2]),
}

/// Computes vectors one after the other, remembering curvature.
pub(super) struct Stepper<'a> {
    prepared: &'a Prepared<'a>,
    maximum: f64,
    patience: Patience<'a>,
    /// How clearances are expected to bend along the next vector.
    trend: Trend,
    /// The vector found last.
    latest: Option<Trial>,
    /// The roles off whose limits it ended because nothing is proven beside them.
    off_limits: Option<[bool; 2]>,
    /// Where the path last turned on the spot, and its direction until then.
    turned: Option<(Vec3, Vec3)>,
    /// On which hand the path keeps both surfaces.
    hand: Hand,
    /// The hand that the next vector has to keep, out of such a corner.
    kept_hand: Option<Hand>,
    /// Where the path last turned by more than a right angle.
    turned_sharply: Option<Vec3>,
    /// Where the longest vector that leads straight on from there in the bands begins and ends.
    straight: Option<Box<[Vertex; 2]>>,
    /// The vertex in a corner that the last vector has led into, and such a vector from there.
    beyond_corner: Option<(Vec3, Box<[Vertex; 2]>)>,
    /// The neck that the last vector has led into.
    in_neck: Option<Through>,
    /// The last vector; zero before the first.
    last: Vec3,
    /// The last one longer than the bands are wide, after where it ends.
    came: Option<(Vec3, Vec3)>,
    /// Where the path came from farther off than it may turn on the spot.
    arrived: Option<Arrival>,
    /// What proofs leave for the next ones: part, drive.
    ledgers: [Ledger; 2],
    /// Length of the longest vector so far.
    longest: f64,
    /// How the path bends so far, for the least number of vectors.
    pub(super) record: Record,
}

/// A vector that has been tried. It goes through many hands, so what is told of it stays where it was written.
#[derive(Clone)]
struct Trial(Box<Tried>);

impl Deref for Trial {
    type Target = Tried;

    fn deref(&self) -> &Tried {
        &self.0
    }
}

impl DerefMut for Trial {
    fn deref_mut(&mut self) -> &mut Tried {
        &mut self.0
    }
}

/// What is told of a vector that has been tried.
#[derive(Clone)]
struct Tried {
    vertex: Vertex,
    length: f64,
    /// Second derivative of each clearance along the vector, on average.
    curvature: [f64; 2],
    /// The bends that tell at which limits it ends.
    bends: [Bend; 2],
    /// The bends at its start and at its end, where they count.
    at_start: [Option<Bend>; 2],
    at_end: [Option<Bend>; 2],
    /// What is to be expected of the next vector.
    next_curvature: [f64; 2],
    /// Factor by which the length could grow, below one if it must shrink.
    growth: f64,
    /// It ends where the path turns on the spot: what is to be expected of the next vector is not known.
    is_at_corner: bool,
    proven: bool,
    /// Of which role it is not proven.
    open: [bool; 2],
    /// A longer one that kept the bands as far as was seen, but was not proven to.
    unproven: Option<Unproven>,
    /// What has been read of both clearances along the vector.
    readings: [Readings; 2],
    culprit: usize,
    worst: f64,
}

impl Tried {
    /// Whether a clearance bounds its length.
    fn is_bounded(&self) -> bool {
        self.growth < GREATEST_GROWTH
    }
}

/// A vector that keeps the bands as far as is seen, of which that is not proven.
#[derive(Clone, Copy)]
struct Unproven {
    length: f64,
    /// For which roles.
    open: [bool; 2],
}

/// What the search for the longest vector begins with.
struct Guess {
    bends: [Bend; 2],
    curvature: [f64; 2],
    length: f64,
}

impl<'a> Stepper<'a> {
    pub(super) fn new(prepared: &'a Prepared<'a>, maximum: f64, patience: Patience<'a>) -> Self {
        Self {
            prepared,
            maximum,
            patience,
            trend: Trend::default(),
            latest: None,
            off_limits: None,
            turned: None,
            hand: Hand::setting_out(prepared),
            kept_hand: None,
            turned_sharply: None,
            straight: None,
            beyond_corner: None,
            in_neck: None,
            last: Vec3::zeros(),
            came: None,
            arrived: None,
            ledgers: Default::default(),
            longest: 0.0,
            record: Record::new(&prepared.tip, [&prepared.part, &prepared.drive], maximum),
        }
    }

    fn roles(&self) -> [&Working; 2] {
        [&self.prepared.part, &self.prepared.drive]
    }

    /// The next vertex, at most `cap` away. Where the path turns sharply because the tool comes to touch a surface at a second
    /// place, the tangent of the vertex becomes that of the path beyond.
    pub(super) fn advance(&mut self, here: &mut Vertex, cap: f64) -> Result<Vertex, MotionFailure> {
        self.latest = None;
        self.straight = None;
        if let Some((at, straight)) = self.beyond_corner.take() {
            self.straight = (at == here.tip).then_some(straight);
        }
        if let Some(next) = self.on_through_neck(here, cap)? {
            self.note(here, &next);
            return Ok(next);
        }
        self.hand.arrive(self.prepared, here);
        let (arrived, came, turned) = (self.last, *here, (self.turned, self.turned_sharply));
        let mut next = self.along_path(here, cap)?;
        if let Some(within) = self.enter_neck(&came, [&arrived, &next.tip], cap)? {
            (self.latest, self.straight, self.beyond_corner) = (None, None, None);
            (self.turned, self.turned_sharply) = turned;
            self.record_shortened(&came, &within);
            (*here, next) = (came, within);
        }
        self.note(here, &next);
        Ok(next)
    }

    /// The next vertex on the path.
    fn along_path(&mut self, here: &mut Vertex, cap: f64) -> Result<Vertex, MotionFailure> {
        if let Some(next) = self.beyond_sharply(here, cap)? {
            return Ok(next);
        }
        self.kept_hand = self.hand_between_corners(here);
        let found = self.along_tangent(here, cap);
        self.kept_hand = None;
        found
    }

    /// The next vertex along the tangent, through a corner or into one.
    fn along_tangent(&mut self, here: &mut Vertex, cap: f64) -> Result<Vertex, MotionFailure> {
        let failure = match self.onward(here, cap, Places::Limits) {
            Err(failure) if failure != MotionFailure::Cancelled => failure,
            Ok(next) => {
                let beyond = self.beyond_kink(here, &next, cap);
                return Ok(beyond.or_else(|| self.in_sharp_corner(here, cap)).unwrap_or(next));
            }
            cancelled => return cancelled,
        };
        let corner = self.corner_at(here);
        if let Some(next) = self.around(&corner, here, cap) {
            return Ok(next);
        }
        if let Some(next) = self.in_sharp_corner(here, cap) {
            return Ok(next);
        }
        if let Some(next) = self.around_sharply(&corner.places, here, cap)? {
            return Ok(next);
        }
        // Where the path bends tightly the way from one limit of the bands to the other is too steep: then level.
        self.trend.forget();
        let level = self.onward(here, cap, Places::Level);
        if matches!(level, Ok(_) | Err(MotionFailure::Cancelled)) {
            return level;
        }
        let next = self.anywhere_onward(&corner, here, cap)?;
        next.ok_or_else(|| corner.explained(self.prepared, here, failure))
    }

    /// Where the path has just turned by more than a right angle: a vector straight on, as far as the bands allow.
    pub(super) fn straight_on(&self) -> Option<&[Vertex; 2]> {
        self.straight.as_deref()
    }

    /// The next vertex in a sharp corner ahead of where the last vector from a place leads.
    fn in_sharp_corner(&mut self, here: &Vertex, cap: f64) -> Option<Vertex> {
        let latest = self.latest.take();
        let cap = cap.min(self.maximum);
        let Some(found) = self.towards_sharp_corner(here, cap, latest.as_ref()) else {
            self.latest = latest;
            return None;
        };
        self.follow(&here.tip, &found);
        Some(found.vertex)
    }

    fn bands(&self) -> f64 {
        self.prepared.part.band() + self.prepared.drive.band()
    }

    /// How long a vector may be to round a corner of the path.
    fn rounding(&self) -> f64 {
        CORNER_BANDS * self.bands()
    }

    /// The next vertex along the tangent, at most `cap` away.
    fn onward(&mut self, here: &Vertex, cap: f64, places: Places) -> Result<Vertex, MotionFailure> {
        // Beyond where the tool has turned to its law no vector turns it evenly any more.
        let cap = cap.min(self.maximum).min(self.prepared.attitude.way_to_law(&here.tip));
        let curvature = match self.trend.curvature() {
            Some(known) => known,
            None => self.probe(here)?,
        };
        let bends = self.bends(&curvature);
        let foretold = self.predict(here, &curvature, &bends);
        let length = foretold * self.trend.ratio();
        let guess = Guess { bends, curvature, length };
        let mut best = match places {
            Places::Level => self.level(here, cap, &guess)?,
            Places::Limits => self.about_limits(here, cap, &guess)?,
            _ => self.longest(here, cap, places, &guess)?,
        };
        self.trend.compare(foretold, best.length * best.growth * AIM);
        if places == Places::Limits
            && let Some(other) = self.at_the_other_limit(here, cap, &best)?
        {
            best = other;
        }
        self.follow(&here.tip, &best);
        let vertex = best.vertex;
        self.latest = Some(best);
        Ok(vertex)
    }

    /// A vector that ends at the limits opposite to its sags, or off one beside which nothing is proven if it is longer so: beside a limit a proof
    /// has no room, and the sag of a vector that hardly bends needs little of the band. So do the next ones, while other bands bound their length.
    fn about_limits(&mut self, here: &Vertex, cap: f64, guess: &Guess) -> Result<Trial, MotionFailure> {
        if let Some(open) = self.off_limits.take() {
            match self.longest(here, cap, Places::Off(open), guess) {
                Ok(found) if found.unproven.is_none() && !(found.is_bounded() && open[found.culprit]) => {
                    self.off_limits = Some(open);
                    return Ok(found);
                }
                Err(MotionFailure::Cancelled) => return Err(MotionFailure::Cancelled),
                _ => {}
            }
        }
        let best = self.longest(here, cap, Places::Limits, guess)?;
        let Some(Unproven { length, open }) =
            best.unproven.filter(|longer| longer.length > EASED * best.length)
        else {
            return Ok(best);
        };
        match self.longest(
            here,
            cap,
            Places::Off(open),
            &Guess { length, bends: guess.bends, curvature: guess.curvature },
        ) {
            Ok(eased) if eased.length > EASED * best.length => {
                self.off_limits = Some(open);
                Ok(eased)
            }
            Err(MotionFailure::Cancelled) => Err(MotionFailure::Cancelled),
            _ => Ok(best),
        }
    }

    /// A vector that keeps its place in the bands, or one that ends nearer to their middle if that is longer: at a limit there is hardly room
    /// for the sag.
    fn level(&self, here: &Vertex, cap: f64, guess: &Guess) -> Result<Trial, MotionFailure> {
        let mut best = self.longest(here, cap, Places::Level, guess);
        for share in INWARD {
            if matches!(best, Err(MotionFailure::Cancelled)) {
                break;
            }
            let inward = self.longest(here, cap, Places::Inward(share), guess);
            let is_better = match (&best, &inward) {
                (Ok(level), Ok(inward)) => inward.length > level.length,
                (level, inward) => level.is_err() && inward.is_ok(),
            };
            if is_better {
                best = inward;
            }
        }
        best
    }

    /// Goes on with a vector.
    fn follow(&mut self, from: &Vec3, found: &Trial) {
        self.trend.follow(found);
        if found.is_at_corner {
            self.trend.forget();
        }
        self.longest = self.longest.max(found.length);
        if !self.prepared.attitude.turns() {
            self.record.add((from, &found.vertex.tip), &found.readings);
        }
    }

    /// Notes what has been read along a vector; the least number of vectors is told while the axis keeps its direction.
    fn note_bend(&mut self, from: &Vec3, to: &Vec3, readings: [Readings; 2]) {
        if !self.prepared.attitude.turns() {
            self.record.add((from, to), &readings);
        }
    }

    /// A trial that was refused, and how far the clearance for which that is was out of its band.
    fn overlong(&self, length: f64, trial: &Trial) -> Overlong {
        let role = self.roles()[trial.culprit];
        let (deep, high) = (-role.inside - trial.worst, trial.worst - role.outside);
        Overlong { culprit: trial.culprit, is_deep: deep > high, length, beyond: deep.max(high) }
    }

    /// Who waits for the vectors.
    pub(super) fn patience(&self) -> Patience<'a> {
        self.patience
    }

    /// True if the straight move between two positions keeps both bands.
    pub(super) fn proven(&self, from: &Vertex, to: &Vertex) -> bool {
        self.extremes(from, to).iter().all(|e| e.proven)
    }

    fn extremes(&self, from: &Vertex, to: &Vertex) -> [Extremes; 2] {
        let Prepared { part, drive, size, .. } = self.prepared;
        let sweep = from.sweep(self.prepared, to);
        let [for_part, for_drive] = &self.ledgers;
        let over = |role, ledger, a, b| proof::extremes(&sweep, role, ledger, a, b, *size, self.patience);
        [
            over(part, for_part, (&from.tip, &from.part), (&to.tip, &to.part)),
            over(drive, for_drive, (&from.tip, &from.drive), (&to.tip, &to.drive)),
        ]
    }

    /// Whether the clearance of a role changes with the axis, too. Its gradient then follows the law of that, from which a vector, on
    /// which the tool turns evenly, is as far as from the path.
    fn is_turned(&self, role: usize) -> bool {
        self.prepared.attitude.turns() && !self.roles()[role].gauge.on
    }

    /// Curvature from the change of the slopes over a short way.
    fn probe(&self, here: &Vertex) -> Result<[f64; 2], MotionFailure> {
        let reach = PROBE * self.prepared.size;
        let ahead = Vertex::at(self.prepared, here.tip + here.tangent * reach, &here.tangent)?;
        let rate = |a: &Contact, b: &Contact| (b.gradient - a.gradient).dot(&here.tangent) / reach;
        Ok([rate(&here.part, &ahead.part), rate(&here.drive, &ahead.drive)])
    }

    fn bends(&self, curvature: &[f64; 2]) -> [Bend; 2] {
        let mut bends = [Bend::Straight; 2];
        for ((bend, role), k) in bends.iter_mut().zip(self.roles()).zip(curvature) {
            let sag = k.abs() * self.maximum * self.maximum / 8.0;
            *bend = match role.shape {
                _ if sag <= STRAIGHT_SHARE * role.band() => Bend::Straight,
                Shape::Flat => Bend::Straight,
                // Under a solid that reaches into the top of the tool the path may bend the other way.
                Shape::Convex if *k < 0.0 => Bend::Concave,
                Shape::Convex => Bend::Convex,
                Shape::Concave => Bend::Concave,
                Shape::General if *k > 0.0 => Bend::Convex,
                Shape::General => Bend::Concave,
            };
        }
        bends
    }

    /// Length at which a parabola of the known curvature fills the bands.
    fn predict(&self, here: &Vertex, curvature: &[f64; 2], bends: &[Bend; 2]) -> f64 {
        // A clearance that hardly bends along one vector may do so soon.
        let mut length =
            if self.longest > 0.0 { self.maximum.min(GREATEST_GROWTH * self.longest) } else { self.maximum };
        let clearances = [here.part.clearance, here.drive.clearance];
        for (((role, k), bend), clearance) in self.roles().iter().zip(curvature).zip(bends).zip(clearances) {
            let (at_start, at_end) = match bend {
                Bend::Straight => continue,
                Bend::Convex => (clearance + role.inside, role.vertex(*bend) + role.inside),
                Bend::Concave => (role.outside - clearance, role.outside - role.vertex(*bend)),
            };
            let spared = SPARED * role.band();
            let reach = |room: f64| (2.0 * (room - spared).max(0.0) / k.abs().max(f64::MIN_POSITIVE)).sqrt();
            length = length.min(reach(at_start) + reach(at_end));
        }
        length.max(1e-9 * self.prepared.size)
    }

    /// The clearances that a vector is to end with.
    fn targets(&self, here: &Vertex, bends: &[Bend; 2], places: Places) -> [f64; 2] {
        match places {
            Places::Limits => {
                let [part, drive] = self.roles();
                [limit(part, bends[0], here.part.clearance), limit(drive, bends[1], here.drive.clearance)]
            }
            Places::Level => [here.part.clearance, here.drive.clearance],
            Places::Inward(share) => {
                let inward = |role: &Working, clearance: f64| {
                    clearance + share * (0.5 * (role.outside - role.inside) - clearance)
                };
                let [part, drive] = self.roles();
                [inward(part, here.part.clearance), inward(drive, here.drive.clearance)]
            }
            Places::Off(open) => {
                let mut targets = self.targets(here, bends, Places::Limits);
                for ((target, role), is_open) in targets.iter_mut().zip(self.roles()).zip(open) {
                    if is_open {
                        *target = 0.5 * (role.outside - role.inside);
                    }
                }
                targets
            }
        }
    }
}

/// The clearance at which a vector ends that bends so and begins with a clearance. Where a surface that bends one way alone is straight along
/// the path a vertex at its limit stays there: how far it sees along what bends beyond depends on that, and no sag needs the room.
fn limit(role: &Working, bend: Bend, clearance: f64) -> f64 {
    let usual = role.vertex(bend);
    match (bend, role.shape) {
        (Bend::Straight, Shape::Convex) => clearance.min(role.vertex(Bend::Convex)).max(usual),
        (Bend::Straight, Shape::Concave) => clearance.max(role.vertex(Bend::Concave)).min(usual),
        _ => usual,
    }
}

/// The direction at the end of a vector of an arc over it that begins along the path.
fn along_arc(from: &Vertex, vector: &Vec3) -> Vec3 {
    vector * (2.0 * from.tangent.dot(vector) / vector.norm_squared()) - from.tangent
}

//! Helices that a control is told by their angle: turns that go on are one block.

use apt_geometry::Vec3;

use super::{Engine, motion::AXES};
use crate::{
    arc::{self, Arc},
    control::Word,
    machine::{ArcPlane, CENTERS, HELIX_ANGLE, RISES},
    words::FeedMode,
};

/// A helix whose block waits, as there may be more of it. Lengths in the unit of the tape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Helix {
    plane: ArcPlane,
    /// About the centre as the control reads it.
    arc: Arc,
    start: Vec3,
    end: Vec3,
    /// Signed angle from start to end, radians.
    sweep: f64,
    /// Whether it is not made of whole turns alone.
    partial: bool,
    /// Between which rises per radian every end of an arc in it is where it was told, within the last decimal.
    rises: [f64; 2],
    place: (u32, u32),
}

/// A place to which a control has come by an angle: that of the program but for the last decimals.
#[derive(Debug, Clone, Copy)]
pub(super) struct Led {
    told: Vec3,
    place: Vec3,
}

impl Engine<'_> {
    /// An arc by its angle to a rounded position: a helix of its own, or more of the one that waits.
    pub(super) fn helix_to(&mut self, end: Vec3, plane: ArcPlane, fitted: &Arc) {
        self.check_travel(end);
        self.check_cutting();
        let place = self.control.place;
        let joined = self.helix.and_then(|waiting| self.joined(&waiting, end, plane, fitted));
        if joined.is_none() {
            self.helix_now();
        }
        let Some(told) = self.position else { return };
        // From where the control is, so that the last decimals of many do not add up.
        let led = self.led_to.filter(|led| led.told == told && !self.is_told(told, plane));
        let start = led.map_or(told, |led| led.place);
        let helix = joined.unwrap_or_else(|| self.new_helix((start, end), plane, fitted));
        self.helix = Some(Helix { place, ..helix });
        self.position = Some(end);
    }

    /// A helix from where the tool is: about a centre that is as far from there as from the end, as the control reads it.
    fn new_helix(&self, (start, end): (Vec3, Vec3), plane: ArcPlane, fitted: &Arc) -> Helix {
        let [u, v, across] = arc::plane_axes(plane);
        let mut arc = *fitted;
        let near = [arc.center[u], arc.center[v]];
        let center = match arc.full_turn {
            true => near,
            false => arc::on_bisector([start[u], start[v]], [end[u], end[v]], near),
        };
        for (axis, value) in [u, v].into_iter().zip(center) {
            arc.center[axis] = self.control.rounded(CENTERS[axis], value);
        }
        let sweep = arc.sweep(&start, &end, plane);
        let partial = !arc.full_turn;
        let mut helix = Helix { plane, arc, start, end, sweep, partial, rises: [0.0; 2], place: (0, 0) };
        helix.rises = self.told_rises(&helix, across);
        helix
    }

    /// The helix that waits with the arc behind it, where that goes on as it does.
    fn joined(&self, first: &Helix, end: Vec3, plane: ArcPlane, fitted: &Arc) -> Option<Helix> {
        let [u, v, across] = arc::plane_axes(plane);
        let last = self.arc_limits(true).resolution;
        let is_same = |axis: usize| (first.arc.center[axis] - fitted.center[axis]).abs() <= last;
        let alike = first.plane == plane
            && first.arc.counterclockwise == fitted.counterclockwise
            && is_same(u)
            && is_same(v);
        // About the centre of the first, from place to place: what the last decimals are off does not add up.
        let about = Arc { center: first.arc.center, ..*fitted };
        let sweep = first.sweep + about.sweep(&first.end, &end, plane);
        let partial = first.partial || !fitted.full_turn;
        // The time of the program is that of one arc.
        let timed = self.feed.is_some_and(|feed| feed.mode == FeedMode::Inverse);
        let rise = (end[across] - first.start[across]) / sweep.abs();
        let even = (first.rises[0]..=first.rises[1]).contains(&rise);
        // As the control reads it: fifteen turns are no more than fifteen.
        let degrees = self.control.rounded(HELIX_ANGLE, sweep.to_degrees().abs());
        let fits = self.machine.arc.helix_degrees.is_some_and(|most| degrees <= most);
        if !alike || !even || timed || !fits {
            return None;
        }
        let joined = Helix { end, sweep, partial, ..*first };
        let [least, greatest] = self.told_rises(&joined, across);
        Some(Helix { rises: [first.rises[0].max(least), first.rises[1].min(greatest)], ..joined })
    }

    /// The rises per radian that lead to the end of a helix within the last decimal.
    fn told_rises(&self, helix: &Helix, across: usize) -> [f64; 2] {
        let off = self.arc_limits(true).resolution;
        let rise = helix.end[across] - helix.start[across];
        [(rise - off) / helix.sweep.abs(), (rise + off) / helix.sweep.abs()]
    }

    /// Makes the block of a helix that waits.
    pub(super) fn helix_now(&mut self) {
        let Some(helix) = self.helix.take() else { return };
        let here = std::mem::replace(&mut self.control.place, helix.place);
        let [u, v, across] = arc::plane_axes(helix.plane);
        let forced = |register, value| Word { register, value, force: true };
        let rise = helix.end[across] - helix.start[across];
        let radius = helix.arc.radius(&helix.start, helix.plane);
        let (feed_code, feed) = self.feed_words((helix.sweep * radius).hypot(rise));
        let mut words = self.center_words((&helix.arc, radius), &helix.start, helix.plane);
        words.extend([forced(HELIX_ANGLE, helix.sweep.to_degrees()), forced(RISES[across], rise)]);
        words.extend(feed);
        self.work_offset_now();
        self.center_now(&words);
        let codes = (self.plane_code(helix.plane), self.turn_code(&helix.arc));
        let machine = self.machine;
        self.cut_by(&machine.templates.helix, feed_code, codes, &words);
        self.control.hold(AXES[across], helix.end[across]);
        if helix.partial {
            // Where the angle leads is the end of the arc but for the last decimals.
            self.control.forget(&[AXES[u], AXES[v]]);
        }
        self.led_to = Some(Led { told: helix.end, place: helix.led_to() });
        self.control.place = here;
    }

    /// Whether the control holds a place in a plane as it was told it.
    pub(super) fn is_told(&self, place: Vec3, plane: ArcPlane) -> bool {
        let [u, v, _] = arc::plane_axes(plane);
        [u, v].into_iter().all(|axis| !self.control.changes(AXES[axis], place[axis]))
    }
}

impl Helix {
    /// Where the control comes to.
    fn led_to(&self) -> Vec3 {
        let [u, v, across] = arc::plane_axes(self.plane);
        let (sine, cosine) = if self.partial { self.sweep.sin_cos() } else { (0.0, 1.0) };
        let arm = self.start - self.arc.center;
        let mut place = self.arc.center;
        place[u] += arm[u] * cosine - arm[v] * sine;
        place[v] += arm[u] * sine + arm[v] * cosine;
        place[across] = self.end[across];
        place
    }
}

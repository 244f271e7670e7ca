//! Arcs of a run at feed rate: what they have to keep to, and their blocks.

use apt_geometry::Vec3;

use super::{
    Engine, Feed, RunPoint,
    blocks::Shape,
    motion::{AXES, DEFAULT_OUTTOL_MM},
};
use crate::{
    arc::{self, Arc, ArcLimits},
    control::{Values, Word},
    machine::{ArcCenter, ArcPlane, CENTERS, RADIUS},
};

/// How far the axis of a circle may lean from a machine axis, as the sine of the angle.
const PLANE_TOLERANCE: f64 = 1e-7;

impl<'a> Engine<'a> {
    pub(super) fn plane_code(&self, plane: ArcPlane) -> &'a str {
        let codes = &self.machine.codes;
        match plane {
            ArcPlane::Xy => &codes.plane_xy,
            ArcPlane::Zx => &codes.plane_zx,
            ArcPlane::Yz => &codes.plane_yz,
        }
    }

    /// The code of the sense of an arc.
    pub(super) fn turn_code(&self, arc: &Arc) -> &'a str {
        let codes = &self.machine.codes;
        if arc.counterclockwise { &codes.counterclockwise } else { &codes.clockwise }
    }
}

impl Engine<'_> {
    /// The planes in which a group may be an arc, and the centre that its circle record states.
    pub(super) fn planes(&self, points: &[RunPoint]) -> (Vec<ArcPlane>, Option<Vec3>) {
        // A control that compensates stays in the plane in which it does.
        let compensates = self.compensated || self.compensation.is_some();
        let possible = |plane: &ArcPlane| !compensates || *plane == ArcPlane::Xy;
        let possible: Vec<ArcPlane> = self.machine.arc.planes.iter().copied().filter(possible).collect();
        let circle = points.first().and_then(|point| point.circle).and_then(|index| self.circles.get(index));
        let Some(circle) = circle else {
            let planes = if self.fit_points { possible } else { Vec::new() };
            return (planes, None);
        };
        let (center, axis) = match &self.turning {
            Some(turning) => (turning.frame.place(circle.center), turning.frame.rotation * circle.axis),
            None => (circle.center, circle.axis),
        };
        let across = |plane: &ArcPlane| {
            let [u, v, _] = arc::plane_axes(*plane);
            axis[u].hypot(axis[v]) <= PLANE_TOLERANCE * axis.norm()
        };
        let planes: Vec<ArcPlane> = possible.into_iter().filter(across).collect();
        let center = (!planes.is_empty()).then_some(center);
        (planes, center)
    }

    pub(super) fn arc_limits(&self, vouched: bool) -> ArcLimits<'_> {
        let rules = &self.machine.arc;
        let own = self.arc_tolerance.unwrap_or_else(|| self.tape_length(rules.tolerance_mm));
        // A circle record comes from the arithmetic element, which has a tolerance also when the program states none.
        let band = match (self.intol, self.outtol) {
            (None, None) if vouched => self.tape_length(DEFAULT_OUTTOL_MM),
            (intol, outtol) => intol.unwrap_or(0.0) + outtol.unwrap_or(0.0),
        };
        let sweep = rules.split_degrees.to_radians();
        let register = self.machine.registers.get("X");
        let inch = self.control.units == apt_cldata::record::Units::Inches;
        ArcLimits {
            tolerance: if vouched { own + band } else { own },
            height_tolerance: own,
            chord_tolerance: band,
            least_radius: self.tape_length(rules.min_radius_mm),
            greatest_radius: self.tape_length(rules.max_radius_mm),
            sweep: if vouched { sweep } else { sweep.min(std::f64::consts::PI) },
            helix: rules.helix,
            resolution: register.map_or(f64::EPSILON, |register| register.format(inch).resolution()),
            least_points: rules.fit_least_points,
            patience: self.patience,
        }
    }

    /// An arc to a rounded position: of one block, or of as many as a control takes that is told no centre.
    pub(super) fn arc_to(&mut self, end: Vec3, plane: ArcPlane, fitted: &Arc) {
        let Some(start) = self.position else { return };
        let [_, _, across] = arc::plane_axes(plane);
        let by_angle = !self.machine.templates.helix.is_empty();
        if by_angle && start[across] != end[across] {
            return self.helix_to(end, plane, fitted);
        }
        self.helix_now();
        // From a place that the control has come to by an angle a whole turn has no end that can be told.
        if by_angle && fitted.full_turn && !self.is_told(start, plane) {
            return self.helix_to(end, plane, fitted);
        }
        let rules = &self.machine.arc;
        let inch = self.control.units == apt_cldata::record::Units::Inches;
        let radius = self.machine.registers.get(RADIUS).filter(|_| rules.center == ArcCenter::Radius);
        let ends = match radius {
            Some(register) => {
                let own = self.arc_tolerance.unwrap_or_else(|| self.tape_length(rules.tolerance_mm));
                let rounded = |place| self.rounded(place);
                fitted.told_by_radius((&start, &end), plane, (register.format(inch), own), &rounded)
            }
            None => vec![end],
        };
        let parts = ends.len();
        let arc = Arc { full_turn: fitted.full_turn && parts == 1, ..*fitted };
        for part in ends {
            self.part_of_arc(part, plane, (&arc, fitted.radius(&start, plane)), parts);
        }
    }

    /// One of so many equal parts of an arc with a radius, to a rounded position.
    fn part_of_arc(&mut self, end: Vec3, plane: ArcPlane, (arc, radius): (&Arc, f64), parts: usize) {
        let Some(start) = self.position else { return };
        self.work_offset_now();
        self.check_travel(end);
        self.check_cutting();
        let [u, v, w] = arc::plane_axes(plane);
        let (plane_code, turn) = (self.plane_code(plane), self.turn_code(arc));
        let forced = |register, value| Word { register, value, force: true };
        let mut words = vec![
            forced(AXES[u], end[u]),
            forced(AXES[v], end[v]),
            Word { register: AXES[w], value: end[w], force: false },
        ];
        words.extend(self.center_words((arc, radius), &start, plane));
        let sweep = arc.sweep(&start, &end, plane);
        let length = (sweep * radius).hypot(end[w] - start[w]);
        let (feed_code, mut feed) = self.feed_words(length);
        if let Some(word) = feed.as_mut().filter(|_| self.feed.is_some_and(Feed::is_time)) {
            // The time of the program is that of the whole arc.
            word.value = (word.value * parts as f64).min(self.control.greatest(word.register));
        }
        words.extend(feed);
        self.center_now(&words);
        self.cut(&[], feed_code, &Shape::Arc { plane: plane_code, turn }, &words);
        self.position = Some(end);
    }

    /// The words of the centre of an arc with a radius, or of that.
    pub(super) fn center_words(
        &self,
        (arc, radius): (&Arc, f64),
        start: &Vec3,
        plane: ArcPlane,
    ) -> Vec<Word> {
        let [u, v, _] = arc::plane_axes(plane);
        let forced = |register, value| Word { register, value, force: true };
        let from = match self.machine.arc.center {
            ArcCenter::Incremental => *start,
            ArcCenter::Absolute => Vec3::zeros(),
            ArcCenter::Radius => return vec![forced(RADIUS, radius)],
        };
        [u, v].map(|axis| forced(CENTERS[axis], arc.center[axis] - from[axis])).into()
    }

    /// Tells a control the centre among the words of an arc where it takes it in a block of its own, and has another one.
    pub(super) fn center_now(&mut self, words: &[Word]) {
        let machine = self.machine;
        let template = &machine.templates.arc_center;
        let mut centers = words.iter().filter(|word| CENTERS.contains(&word.register));
        if !template.is_empty() && centers.any(|word| self.control.changes(word.register, word.value)) {
            self.control.template(template, &Values::default().words(words));
        }
    }
}

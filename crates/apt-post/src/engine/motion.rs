//! Motion: rapid moves, and runs at feed rate with arcs fitted in.

use apt_cldata::record::{ClPoint, POSITIONS_A_UNIT};
use apt_geometry::Vec3;

use super::{Engine, Feed, RunPoint, blocks::Shape, turning::Way};
use crate::{
    arc,
    control::{FEEDS, Values, Word},
    finding::PostFindingKind,
    words::FeedMode,
};

/// The linear axes by coordinate.
pub(super) const AXES: [&str; 3] = ["X", "Y", "Z"];
/// OUTTOL of a program that states none: .0005 inch.
pub(super) const DEFAULT_OUTTOL_MM: f64 = 0.0127;

impl Engine<'_> {
    pub(super) fn motion(&mut self, from: bool, points: &[ClPoint]) {
        let circle = self.next_circle.take();
        let targets = self.targets(from, points);
        if from {
            self.flush();
            if !targets.is_empty() && std::mem::replace(&mut self.started, true) {
                self.find(PostFindingKind::Repeated { word: "FROM".into() });
            }
            // FROM says where the tool stands; the tape says nothing of it.
            if let Some(target) = targets.last() {
                self.stand_at(target);
            }
            return;
        }
        if self.ended && !targets.is_empty() {
            self.find(PostFindingKind::MotionAfterEnd);
            self.restart();
        }
        self.moved |= !targets.is_empty();
        if self.is_followed() {
            self.flush();
            self.follow();
        }
        if self.rapid.is_some() {
            self.flush();
            self.rapid = None;
            for target in &targets {
                if self.patience.ends_after(1) {
                    return;
                }
                self.leave_cycle();
                self.rapid_target(target);
            }
            self.rapid_axis = None;
        } else if self.cycle.is_some() {
            self.flush();
            if circle.is_some() {
                self.circle_in_cycle();
            }
            for target in &targets {
                if self.patience.ends_after(1) {
                    return;
                }
                self.hole_target(target);
            }
        } else if !self.leaves_out(targets.len()) {
            let place = self.control.place;
            for (done, target) in targets.iter().enumerate() {
                if self.patience.ends_among(done, POSITIONS_A_UNIT) {
                    return;
                }
                match self.way(target) {
                    Way::Straight(position) => self.run.push(RunPoint { position, place, circle }),
                    Way::Turning(angles) => self.cut_turning(target, angles),
                    Way::Back(back, to) => self.cut_turned_back(target, back, to),
                    Way::Nowhere => {}
                }
            }
        }
    }

    /// A position as the control reads it.
    pub(super) fn rounded(&self, position: Vec3) -> Vec3 {
        Vec3::new(
            self.control.rounded(AXES[0], position.x),
            self.control.rounded(AXES[1], position.y),
            self.control.rounded(AXES[2], position.z),
        )
    }

    /// Where the control follows the tool end itself, nobody knows here where the slides stand.
    pub(super) fn check_travel(&mut self, position: Vec3) {
        if self.turning.as_ref().is_some_and(|turning| !turning.kinematics.slides) {
            return;
        }
        for (name, value) in AXES.into_iter().zip(position.iter()) {
            self.check_axis(name, *value);
        }
    }

    fn check_axis(&mut self, name: &str, value: f64) {
        let Some(axis) = self.machine.axes.get(name) else { return };
        let [least, greatest] = axis.limits_mm.map(|limit| self.tape_length(limit));
        if !(least..=greatest).contains(&value) {
            self.find(PostFindingKind::AxisLimit { axis: name.into(), value, least, greatest });
        }
    }

    /// The words of a position, with those of rotary axes.
    pub(super) fn axis_words(&self, position: Vec3) -> Vec<Word> {
        let words = AXES.into_iter().zip(position.iter());
        let words = words.map(|(register, value)| Word { register, value: *value, force: false });
        words.chain(self.rotary_words()).collect()
    }

    /// A rapid move; the first one after a tool change goes to its place first and then down with the tool's length.
    pub(super) fn rapid_to(&mut self, position: Vec3) {
        self.check_travel(position);
        let machine = self.machine;
        let coolant = self.approach.take();
        if coolant.is_some() {
            self.turn_now();
        }
        if let Some(coolant) = coolant.as_ref().filter(|_| self.is_followed()) {
            // The length of a tool that leans is known to the control once it follows the tool end.
            self.follow();
            if !coolant.is_empty() {
                self.control.function(coolant);
            }
        }
        if let Some(coolant) = coolant.filter(|_| !self.is_followed()) {
            let values = Values::default()
                .text("work_offset", self.work_offset_code())
                .number("X", position.x)
                .number("Y", position.y)
                .number("Z", position.z)
                .number("H", f64::from(self.length_offset))
                .text("compensation", self.compensation_code.clone())
                .text("coolant", coolant);
            self.control.template(&machine.templates.first_xy, &values);
            self.control.template(&machine.templates.first_z, &values);
        } else {
            self.work_offset_now();
            for place in self.rapid_corner(position).into_iter().chain([position]) {
                let off = self.compensation_off(place);
                self.rapid_block(&off, &self.axis_words(place));
            }
        }
        self.skipped = false;
        self.position = Some(self.rounded(position));
    }

    /// The code of a compensation that waits to end, where a rapid moves in its plane. One that is to begin waits for the cut, which its approach is.
    fn compensation_off(&mut self, place: Vec3) -> Vec<String> {
        if self.compensated || !self.moves_in_plane(place) {
            return Vec::new();
        }
        let Some(codes) = self.compensation_codes() else { return Vec::new() };
        self.compensating = false;
        self.level_plane();
        codes
    }

    /// Whether a position is another one in the plane of holes and of cutter compensation.
    fn moves_in_plane(&self, position: Vec3) -> bool {
        self.control.changes(AXES[0], position.x) || self.control.changes(AXES[1], position.y)
    }

    /// Where a rapid turns, if one of its axes moves apart: that axis goes first when it goes up, and last when it goes
    /// down, so that the tool is over the part while it goes aside. None where nobody knows from where the tool comes.
    fn rapid_corner(&self, position: Vec3) -> Option<Vec3> {
        // Past the walls of a hole that leans no axis may move apart.
        let apart = self.rapid_axis.or(self.machine.rapid_axis).filter(|_| self.is_upright())?.index();
        let here = self.position.filter(|_| !self.skipped)?;
        let there = self.rounded(position);
        let aside = (0..AXES.len()).any(|axis| axis != apart && there[axis] != here[axis]);
        if !aside || there[apart] == here[apart] {
            return None;
        }
        let mut corner = if there[apart] > here[apart] { here } else { position };
        corner[apart] = position[apart].max(here[apart]);
        Some(corner)
    }

    /// A rapid move to a height where nobody knows from where: the axis of the spindle alone moves.
    pub(super) fn rapid_to_height(&mut self, height: f64) {
        self.check_axis(AXES[2], height);
        self.approach_now();
        let word = Word { register: AXES[2], value: height, force: true };
        self.rapid_block(&[], &[word]);
    }

    /// Makes blocks of the waiting run.
    pub(super) fn flush(&mut self) {
        let run = std::mem::take(&mut self.run).joined(self.patience);
        let here = self.control.place;
        let mut rest = run.as_slice();
        while let Some(first) = rest.first() {
            if self.patience.was_over() {
                return;
            }
            let count = self.group_length(rest, first.circle);
            let (group, others) = rest.split_at(count);
            self.group(group);
            rest = others;
        }
        self.helix_now();
        self.control.place = here;
    }

    /// How many points of a run lie on the circle of the first of them.
    fn group_length(&self, run: &[RunPoint], circle: Option<usize>) -> usize {
        let mut count = 0;
        for points in run.chunks(POSITIONS_A_UNIT) {
            let alike = points.iter().take_while(|point| point.circle == circle).count();
            count += alike;
            if alike < points.len() || self.patience.ends_after(1) {
                break;
            }
        }
        count
    }

    /// Where the tool stands, and points after it, as the control reads them. Without a start the first point is reached
    /// straight anyway. Fewer where who waits gives up.
    fn whole_run(&self, points: &[RunPoint]) -> Vec<Vec3> {
        let mut whole = Vec::with_capacity(1 + points.len());
        whole.extend(
            self.position.or(points.first().map(|point| point.position)).map(|start| self.rounded(start)),
        );
        for point in points {
            if self.patience.ends_after(1) {
                break;
            }
            whole.push(self.rounded(point.position));
        }
        whole
    }

    /// Points on one circle, or on none.
    fn group(&mut self, points: &[RunPoint]) {
        let whole = self.whole_run(points);
        let Some((_, positions)) = whole.split_first() else { return };
        let mut at = 0;
        let mut arcs = 0;
        let (planes, center) = self.planes(points);
        while let Some(point) = points.get(at) {
            if self.patience.ends_after(1) {
                return;
            }
            self.control.place = point.place;
            let unknown = self.position.is_none() || self.skipped;
            let straight = unknown || self.compensation.is_some() || self.approach.is_some();
            if !straight {
                let run = &whole[at..];
                let limits = self.arc_limits(center.is_some());
                let best = planes
                    .iter()
                    .filter_map(|plane| Some((*plane, arc::longest(run, *plane, center, &limits)?)))
                    .max_by_key(|(_, (count, _))| *count);
                if let Some((plane, (count, fitted))) = best {
                    self.control.place = points[at + count - 1].place;
                    self.arc_to(positions[at + count - 1], plane, &fitted);
                    at += count;
                    arcs += 1;
                    continue;
                }
            } else if self.compensation.is_some() && point.circle.is_some() {
                self.find(PostFindingKind::CompensationOnArc);
            }
            self.linear_to(positions[at]);
            at += 1;
        }
        self.report_chords(points, positions, center, arcs);
    }

    fn report_chords(&mut self, points: &[RunPoint], positions: &[Vec3], center: Option<Vec3>, arcs: usize) {
        let on_circle = points.first().is_some_and(|point| point.circle.is_some());
        if !on_circle || arcs > 0 || points.len() < 3 {
            return;
        }
        let Some(center) = center else { return self.find(PostFindingKind::ArcNotInPlane) };
        let limits = self.arc_limits(true);
        let planes = self.machine.arc.planes.clone();
        let deviation = planes
            .into_iter()
            .filter_map(|plane| arc::fit(positions, plane, Some(center), &limits).err())
            .fold(f64::INFINITY, f64::min);
        self.find(PostFindingKind::ArcAsChords { deviation });
    }

    /// What has to be in order before the tool cuts.
    pub(super) fn check_cutting(&mut self) {
        if self.feed.is_none() && !self.feed_reported {
            self.feed_reported = true;
            self.find(PostFindingKind::NoFeed);
        }
        self.check_tool();
    }

    /// Whether the tool that cuts, in a hole too, is there and turns.
    pub(super) fn check_tool(&mut self) {
        if !self.spindle.on && !self.spindle_reported {
            self.spindle_reported = true;
            self.find(PostFindingKind::SpindleOff);
        }
        if let Some(isn) = self.first_tool.take()
            && self.tool.is_none()
            && !self.machine.templates.tool_change.is_empty()
        {
            self.find(PostFindingKind::CuttingBeforeTool { isn });
        }
    }

    /// The feed as code and word of a block over a length.
    pub(super) fn feed_words(&mut self, length: f64) -> (Option<String>, Option<Word>) {
        let Some(Feed { mode, value, timed }) = self.feed else { return (None, None) };
        let codes = &self.machine.codes;
        let code = match mode {
            FeedMode::PerMinute => Some(codes.feed_per_minute.clone()),
            FeedMode::PerRevolution => codes.feed_per_revolution.clone(),
            FeedMode::Inverse => codes.feed_inverse.clone(),
        };
        let register = self.feed_register(mode);
        // A move that is too short for the time takes the shortest that the control can be told.
        let value = match timed && length > 0.0 {
            true => (value / length).min(self.control.greatest(register)),
            false => value,
        };
        if value > 0.0 && self.control.rounded(register, value) == 0.0 && !self.feed_reported {
            self.feed_reported = true;
            self.find(PostFindingKind::FeedNotPositive { value: 0.0 });
        }
        (code, Some(Word { register, value, force: mode == FeedMode::Inverse }))
    }

    /// The register of a feed in some mode: one of its own where the machine has that, since the numbers are of another
    /// size.
    pub(super) fn feed_register(&self, mode: FeedMode) -> &'static str {
        let own = match mode {
            FeedMode::PerMinute => FEEDS[0],
            FeedMode::PerRevolution => FEEDS[1],
            FeedMode::Inverse => FEEDS[2],
        };
        if self.machine.registers.contains_key(own) { own } else { FEEDS[0] }
    }

    /// Brings a feed mode into force; whether it was another one before, of which the control forgets the feed.
    pub(super) fn feed_mode(&mut self, code: &str) -> bool {
        let new = self.control.set_mode(code);
        if new {
            self.control.forget(&FEEDS);
        }
        new
    }

    /// Work offset, length offset and coolant that an approach by rapid would have brought.
    pub(super) fn approach_now(&mut self) {
        self.work_offset_now();
        self.turn_now();
        if let Some(coolant) = self.approach.take() {
            if self.is_followed() {
                self.follow();
            } else {
                let machine = self.machine;
                let values = Values::default().number("H", f64::from(self.length_offset));
                self.control.template(&machine.templates.length_offset, &values);
            }
            if !coolant.is_empty() {
                self.control.function(&coolant);
            }
        }
    }

    /// A straight move at feed rate to a rounded position.
    pub(super) fn linear_to(&mut self, position: Vec3) {
        self.helix_now();
        let moves =
            AXES.into_iter().zip(position.iter()).any(|(name, value)| self.control.changes(name, *value));
        if !moves {
            self.position = Some(position);
            return;
        }
        self.approach_now();
        self.check_travel(position);
        self.check_cutting();
        let length = self.position.map_or(0.0, |start| (position - start).norm());
        let (feed_code, feed) = self.feed_words(length);
        let before = if self.moves_in_plane(position) { self.compensation_codes() } else { None };
        if before.is_some() {
            self.compensating = self.compensated;
            self.level_plane();
        }
        let mut words = self.axis_words(position);
        words.extend(feed);
        self.cut(&before.unwrap_or_default(), feed_code, &Shape::Linear, &words);
        self.skipped = false;
        self.position = Some(position);
    }

    /// The plane of holes and of cutter compensation, where an arc has left another one.
    pub(super) fn level_plane(&mut self) {
        let machine = self.machine;
        if self.control.set_mode(&machine.codes.plane_xy) {
            self.control.code(&machine.codes.plane_xy);
        }
    }
}

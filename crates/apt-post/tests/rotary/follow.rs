//! The steps of a tape, followed along the positions of a program.

use apt_geometry::Vec3;

use super::{
    mill::{Joints, Mill},
    reader::Step,
};

/// Of a cut and of a rapid, in millimetres; and degrees by which the tool may lean aside: what the definitions say.
const TOLERANCE: f64 = 0.025;
const RAPID_TOLERANCE: f64 = 1.0;
const ASIDE: f64 = 0.1;
/// How far arcs may be off the points of a circle, millimetres.
const ROUND_TOLERANCE: f64 = 0.01;
/// At how many places a block is looked at.
const SAMPLES: u32 = 8;
/// What slides of linuxcnc-mill5 do at most, millimetres a minute.
const SLIDES: [f64; 3] = [10000.0, 10000.0, 8000.0];
/// Directions that are one, of CL data with nine decimals.
const SAME: f64 = 1e-8;

#[derive(Debug, Clone, Copy)]
pub(super) enum How {
    Rapid,
    Cut,
    Round {
        center: Vec3,
        radius: f64,
    },
    /// By rapids, but for the last step, which cuts.
    Drill,
    Anyhow,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Place {
    /// Tool end and direction on the part.
    Part(Vec3, Vec3),
    /// In the coordinates behind a statement that turned the axes to these angles.
    Turned { place: Vec3, angles: [f64; 2], with_table: bool },
    /// From here on nobody knows where the tool is.
    Nowhere,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    pub(super) how: How,
    pub(super) place: Place,
    /// How far the tape may be off it besides.
    pub(super) unsure: f64,
}

/// Tool end, direction and joints at the last goal.
type Here = Option<(Vec3, Vec3, Joints)>;

struct Follower<'a> {
    mill: &'a Mill,
    length: &'a dyn Fn(u32) -> f64,
    feeds: [f64; 2],
    here: Here,
    /// Whether that was come to by rapid.
    by_rapid: bool,
    /// The blocks of a cut so far.
    cut: Vec<&'a Step>,
    /// Where a cut was left, to turn an axis back.
    left: Option<Vec3>,
    was_left: bool,
}

pub(super) fn follow<'a>(
    mill: &'a Mill,
    steps: &'a [Step],
    goals: &[Goal],
    length: &'a dyn Fn(u32) -> f64,
    feeds: [f64; 2],
    turned_back: bool,
) -> Result<(), String> {
    let mut follower = Follower {
        mill,
        length,
        feeds,
        here: None,
        by_rapid: false,
        cut: Vec::new(),
        left: None,
        was_left: false,
    };
    let mut goals = goals.iter().peekable();
    for step in steps {
        let on = |error: String| format!("{error}\non {step:?}");
        follower.stays_within_limits(step).map_err(on)?;
        while goals.next_if(|goal| matches!(goal.place, Place::Nowhere)).is_some() {
            follower.here = None;
        }
        let Some(goal) = goals.peek().copied() else { break };
        follower.takes(step, goal, turned_back).map_err(on)?;
        if follower.left.is_some() {
            continue;
        }
        let mut round = matches!(goal.how, How::Round { .. }) && step.arc.is_some();
        if round {
            follower.passes(step, &mut goals).map_err(on)?;
        }
        let mut is_there = false;
        while let Some(goal) =
            goals.next_if(|goal| follower.is_at(step, goal) || (is_there && follower.stays(step, goal)))
        {
            if !round {
                follower.arrives(step, goal).map_err(on)?;
            }
            (round, is_there) = (false, true);
            let joints = step.end;
            follower.here = Some((follower.tip(step, &joints), mill.direction(&joints), joints));
            follower.by_rapid = step.rapid;
            follower.cut.clear();
            follower.was_left = false;
        }
    }
    match goals.find(|goal| !matches!(goal.place, Place::Nowhere)) {
        Some(goal) => Err(format!("not come to: {goal:?}")),
        None => Ok(()),
    }
}

fn ensure(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

/// How far a place is off a straight way.
fn off_way(place: Vec3, from: Vec3, to: Vec3) -> f64 {
    let way = to - from;
    let square = way.norm_squared();
    let along = if square > 0.0 { ((place - from).dot(&way) / square).clamp(0.0, 1.0) } else { 0.0 };
    (place - from - way * along).norm()
}

fn angle_between(a: &Vec3, b: &Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b)).to_degrees()
}

impl<'a> Follower<'a> {
    /// What the last decimals may take a place away.
    fn rounded(&self) -> f64 {
        // Three of the tape, and of the text of the program.
        1.1 * self.mill.last_decimal() + 2e-6
    }

    /// Degrees that the last decimals of two angles may turn the tool.
    fn turned(&self) -> f64 {
        1.1 * self.mill.last_of_angles()
    }

    fn tip(&self, step: &Step, joints: &Joints) -> Vec3 {
        self.mill.tip(joints, (self.length)(step.tool))
    }

    fn stays_within_limits(&self, step: &Step) -> Result<(), String> {
        for (axis, angle) in self.mill.axes.iter().zip(&step.end[3..]) {
            if let Some([least, greatest]) = axis.limits {
                ensure((least..=greatest).contains(angle), || {
                    format!("{} {angle} is beyond its end", axis.letter)
                })?;
            }
        }
        let upright = (self.mill.direction(&step.end) - Vec3::z()).norm() < 1e-4;
        ensure(!self.mill.follows || step.followed || upright || step.rapid, || {
            "a tool that leans is not followed".into()
        })
    }

    fn is_at(&self, step: &Step, goal: &Goal) -> bool {
        let goal_is_cut = matches!(goal.how, How::Cut | How::Round { .. } | How::Drill);
        (!goal_is_cut || !step.rapid) && self.ends_at(step, goal)
    }

    /// Whether a cut goes nowhere.
    fn stays(&self, step: &Step, goal: &Goal) -> bool {
        matches!(goal.how, How::Cut) && self.ends_at(step, goal)
    }

    fn ends_at(&self, step: &Step, goal: &Goal) -> bool {
        let joints = step.end;
        let tip = self.tip(step, &joints);
        match goal.place {
            Place::Part(place, axis) => {
                (tip - place).norm() <= self.rounded() + goal.unsure
                    && angle_between(&self.mill.direction(&joints), &axis) <= self.turned() + 1e-6
            }
            Place::Turned { place, angles, with_table } => {
                let place = if with_table { place } else { self.mill.off_machine(place, &joints) };
                let apart = |index: usize| {
                    let apart = joints[3 + index] - angles[index];
                    if self.mill.axes[index].wraps {
                        (apart + 180.0).rem_euclid(360.0) - 180.0
                    } else {
                        apart
                    }
                };
                (tip - place).norm() <= self.rounded() && (0..2).all(|index| apart(index).abs() < 1e-6)
            }
            Place::Nowhere => false,
        }
    }

    /// A block on the way to a goal.
    fn takes(&mut self, step: &'a Step, goal: &Goal, turned_back: bool) -> Result<(), String> {
        if let Some(left) = self.left {
            if !step.rapid {
                let off = (self.tip(step, &step.end) - left).norm();
                ensure(off <= self.rounded() * 2.0, || format!("{off} off where the cut was left"))?;
                self.left = None;
            }
            return Ok(());
        }
        match goal.how {
            How::Rapid => ensure(step.rapid, || format!("a cut on the way to {goal:?}"))?,
            // A rapid to where the tool is turns it in place.
            How::Cut if step.rapid && self.by_rapid && self.remains(step) => {
                self.here = self.here.map(|(tip, axis, _)| (tip, axis, step.end));
                return Ok(());
            }
            How::Cut if step.rapid && self.here.is_some() => {
                ensure(turned_back, || format!("a rapid on the way to {goal:?}"))?;
                self.left = step.start.map(|joints| self.tip(step, &joints));
                self.was_left = true;
                return Ok(());
            }
            How::Cut => self.cut.push(step),
            How::Drill if !step.rapid => {
                ensure(self.is_at(step, goal), || format!("a cut on the way to {goal:?}"))?;
                ensure((step.feed - self.feeds[1]).abs() < 0.1, || "feed of a hole".into())?;
            }
            _ => {}
        }
        self.keeps(step, goal)
    }

    /// Whether a block ends where the tool end is and as the tool stands.
    fn remains(&self, step: &Step) -> bool {
        self.here.is_some_and(|(tip, axis, _)| {
            (self.tip(step, &step.end) - tip).norm() <= 2.0 * self.rounded()
                && angle_between(&self.mill.direction(&step.end), &axis) <= self.turned() + 1e-6
        })
    }

    /// Whether a block keeps the way to a goal.
    fn keeps(&self, step: &Step, goal: &Goal) -> Result<(), String> {
        let (Some((from, axis, _)), Place::Part(to, wanted)) = (self.here, goal.place) else { return Ok(()) };
        let tolerance = match goal.how {
            How::Rapid if self.mill.linuxcnc => RAPID_TOLERANCE,
            How::Cut if self.mill.follows => 0.0,
            How::Cut => TOLERANCE,
            _ => return Ok(()),
        };
        let cuts = matches!(goal.how, How::Cut);
        for sample in 1..=SAMPLES {
            let joints = step.at(f64::from(sample) / f64::from(SAMPLES));
            let (tip, direction) = (self.tip(step, &joints), self.mill.direction(&joints));
            let off = off_way(tip, from, to);
            ensure(off <= tolerance * self.mill.unit() + 2.0 * self.rounded() + goal.unsure, || {
                format!("{off} off the way from {from:?} to {goal:?}")
            })?;
            let whole = angle_between(&axis, &wanted);
            let aside = ASIDE + 2.0 * self.turned();
            let across = axis.cross(&wanted);
            if cuts && across.norm() > 1e-5 {
                let leans = direction.dot(&across.normalize()).asin().to_degrees().abs();
                ensure(leans <= aside, || format!("{leans} degrees aside of {goal:?}"))?;
            }
            let beyond = angle_between(&axis, &direction).max(angle_between(&wanted, &direction)) - whole;
            ensure(!cuts || beyond <= aside, || format!("{beyond} degrees beyond {goal:?}"))?;
        }
        Ok(())
    }

    /// Goals that an arc passes, all but the one at its end.
    fn passes<'g>(
        &self,
        step: &Step,
        goals: &mut std::iter::Peekable<impl Iterator<Item = &'g Goal> + Clone>,
    ) -> Result<(), String> {
        let tolerance = ROUND_TOLERANCE * self.mill.unit();
        let samples: Vec<Vec3> =
            (0..=360).map(|share| self.tip(step, &step.at(f64::from(share) / 360.0))).collect();
        if let Some(Goal { how: How::Round { center, radius }, .. }) = goals.peek() {
            for place in &samples {
                let off = ((place - center).norm() - radius).abs();
                ensure(off <= tolerance, || format!("{off} off the circle"))?;
            }
        }
        // What an arc passes it passes in its order.
        let mut reached = 0;
        while let Some(goal) = goals.peek() {
            let Goal { how: How::Round { .. }, place: Place::Part(place, _), .. } = goal else {
                return Ok(());
            };
            let near = |at: usize| off_way(*place, samples[at], samples[at + 1]);
            let Some(next) = (reached..360).find(|at| near(*at) <= tolerance) else { return Ok(()) };
            reached = next;
            let last = next >= 358 && self.is_at(step, goal);
            if last {
                return Ok(());
            }
            goals.next();
        }
        Ok(())
    }

    /// What is so of a way that has been gone.
    fn arrives(&self, step: &Step, goal: &Goal) -> Result<(), String> {
        let (Some((from, axis, before)), How::Cut, Place::Part(to, wanted)) =
            (self.here, goal.how, goal.place)
        else {
            return Ok(());
        };
        if self.was_left {
            return Ok(());
        }
        self.takes_its_time((to - from).norm())?;
        let lasting = 2.0 * self.mill.last_of_angles();
        let turned: [f64; 2] = std::array::from_fn(|index| (step.end[3 + index] - before[3 + index]).abs());
        if (axis - wanted).norm() < SAME && (wanted - Vec3::z()).norm() > 1e-3 {
            ensure(turned.iter().all(|turned| *turned <= lasting), || {
                format!("turns by {turned:?} for nothing")
            })?;
        }
        let endless = self.mill.axes[0].limits.is_none();
        ensure(!endless || turned[0] <= self.mill.most_of_first() + 1.0, || format!("turns by {turned:?}"))
    }

    /// The times of the blocks of a cut are those of its length at its feed, or longer where an axis can turn or slide no faster.
    fn takes_its_time(&self, length: f64) -> Result<(), String> {
        let feed = self.feeds[0];
        let (mut time, mut least, mut unsure) = (0.0, 0.0, 2.0 * self.rounded() / feed);
        for step in &self.cut {
            if !step.inverse {
                return ensure((step.feed - feed).abs() < 0.1, || {
                    format!("F{} instead of {feed}", step.feed)
                });
            }
            let start = step.start.unwrap_or(step.end);
            let taken = |index: usize| {
                let way = (step.end[index] - start[index]).abs();
                match index.checked_sub(3) {
                    Some(axis) => way / self.mill.axes[axis].most,
                    None if self.mill.linuxcnc => way / (SLIDES[index] * self.mill.unit()),
                    None => 0.0,
                }
            };
            let fastest = (0..5).map(taken).fold(0.0, f64::max);
            let block = step.feed.recip();
            // Half of the last of four decimals.
            let rounding = 0.6e-4 * block * block;
            ensure(block + rounding >= fastest * (1.0 - 1e-6), || format!("too fast: {}", step.block))?;
            (time, least, unsure) = (time + block, least + fastest, unsure + rounding);
        }
        let stated = length / feed;
        ensure(time + unsure >= stated * (1.0 - 1e-5), || format!("{time} instead of {stated} minutes"))?;
        ensure(time - unsure <= (stated + least) * (1.0 + 1e-5), || {
            format!("{time} instead of {stated} minutes and {least}")
        })
    }
}

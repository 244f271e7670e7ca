//! One SMIL: what it needs, and what comes out.

mod avoid;
mod chord;
mod pass;
mod pattern;
mod station;
mod step;
mod way;

use apt_geometry::{
    canonical::Geometry,
    cutter::Cutter,
    motion::NamedSurface,
    patience::Waiting,
    regional::{LiftDirection, RegionalMilling},
};
use serde::{Deserialize, Serialize};

pub use avoid::NotAvoided;

use crate::{
    check::{Checker, Cost, Hit, Obstacle, Question},
    error::MillingError,
    guide::GuideElement,
    tool::{Pose, Tool},
};

/// Most locations of one SMIL (3553).
const MOST_LOCATIONS: usize = 200_000;
/// Longest path of one SMIL, in sizes of the part surface (3554).
const LONGEST_PATH: f64 = 1e6;
/// How exactly depths are computed, as a share of INTOL.
const DEPTH_SHARE: f64 = 1e-4;
/// How exactly depths are computed at best, as a share of the reach of the tool.
const DEPTH_PRECISION: f64 = 1e-9;

/// The modal data of Section 2 that take part, for the part surface; lengths in program units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The cutter, once defined.
    pub cutter: Option<Cutter>,
    /// INTOL: how far chords may cut into the material.
    pub inside: f64,
    /// OUTTOL: how much material may stay.
    pub outside: f64,
    /// MAXDP.
    pub maximum_step: f64,
}

/// A part of the output.
#[derive(Debug, Clone, PartialEq)]
pub enum Move {
    /// A feed rate to be written.
    Feed(f64),
    /// Tool locations.
    Locations(Vec<Pose>),
}

/// What was done about an interference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Remedy {
    /// Nothing: AVCTRL is off.
    None,
    /// The tool was tilted or lifted, or both, and is clear now.
    Avoided {
        /// Angle by which the axis was tilted, radians; zero if it was not.
        tilt: f64,
        /// Whether the tilt was in the plane of axis and feed (pitching) rather than across it (rolling).
        pitch: bool,
        /// How far the tool was lifted, program units; zero if it was not.
        lift: f64,
        /// Along what.
        along: LiftDirection,
        /// Where it is now.
        pose: Pose,
    },
    /// No remedy within the limits was found (3555): the location stays as it was.
    Failed(NotAvoided),
}

/// An interference that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Encounter {
    /// The tool before any remedy.
    pub pose: Pose,
    /// The deepest point.
    pub hit: Hit,
    /// Name of the surface.
    pub surface: String,
    /// What was done.
    pub remedy: Remedy,
}

/// What a SMIL gives, up to where it failed if it did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Milled {
    /// Locations and feeds in order.
    pub moves: Vec<Move>,
    /// Interferences in order.
    pub encounters: Vec<Encounter>,
    /// Cutting passes begun.
    pub passes: u32,
    /// Locations whose check ended without proof.
    pub unproved: u32,
    /// What the checks cost.
    pub cost: Cost,
    /// Why it stopped, if before its end.
    pub failure: Option<MillingError>,
}

impl Milled {
    /// All locations in order.
    pub fn locations(&self) -> impl DoubleEndedIterator<Item = &Pose> {
        self.moves.iter().flat_map(|part| match part {
            Move::Locations(poses) => poses.as_slice(),
            Move::Feed(_) => &[],
        })
    }
}

/// Everything a SMIL works with.
pub(crate) struct Job<'a> {
    command: &'a RegionalMilling,
    guide: GuideElement<'a>,
    part: Obstacle,
    /// The part surface and the surface of the guide are the same.
    part_is_guide: bool,
    /// Surfaces to be checked, with their names.
    checked: Vec<Obstacle>,
    names: Vec<String>,
    /// The tool without stock.
    tool: Tool,
    setting: Setting,
    /// Diagonal of the part surface's box.
    size: f64,
    waiting: Waiting<'a>,
}

/// Carries out a SMIL. `cancel` is asked at every location and during the checks; once it has said so no location is added.
pub fn mill(command: &RegionalMilling, setting: &Setting, cancel: &dyn Fn() -> bool) -> Milled {
    let mut milled = Milled::default();
    let outcome = Job::new(command, setting, cancel).and_then(|job| {
        let outcome = pattern::run(&job, &mut milled);
        // What a search that was given up did not find is no mistake of the program.
        job.was_cancelled().and(outcome)
    });
    milled.failure = outcome.err();
    milled
}

fn sculptured(named: &NamedSurface) -> Result<Obstacle, MillingError> {
    match &named.geometry {
        Geometry::Sculptured(surface) => Ok(Obstacle::new(surface.clone())),
        _ => Err(MillingError::NotSculptured { name: named.name.clone() }),
    }
}

impl<'a> Job<'a> {
    fn new(
        command: &'a RegionalMilling,
        setting: &Setting,
        cancel: &'a dyn Fn() -> bool,
    ) -> Result<Self, MillingError> {
        let cutter = setting.cutter.ok_or(MillingError::NoCutter)?;
        let guide = GuideElement::new(&command.guide)?;
        let part = sculptured(&command.part.surface)?;
        let part_is_guide = guide.surface().is_some_and(|surface| *surface == **part.surface());
        let (mut checked, mut names) = (Vec::new(), Vec::new());
        if command.checked.part {
            checked.push(part.clone());
            names.push(command.part.surface.name.clone());
        }
        for named in &command.checked.named {
            checked.push(sculptured(named)?);
            names.push(named.name.clone());
        }
        let size = part
            .tree()
            .root()
            .and_then(|root| part.tree().node(root))
            .map_or(0.0, |node| 2.0 * node.bounds.half().norm());
        let tool = Tool::new(&cutter, 0.0);
        Ok(Self {
            command,
            guide,
            part,
            part_is_guide,
            checked,
            names,
            tool,
            setting: *setting,
            size,
            waiting: Waiting::until(cancel),
        })
    }

    /// Stock that stays on the part surface.
    fn thickness(&self) -> f64 {
        self.command.part.thickness
    }

    fn question(&self) -> Question<'_> {
        let gap = (DEPTH_SHARE * self.setting.inside).max(DEPTH_PRECISION * self.tool.reach());
        Question { threshold: self.setting.inside, gap, patience: self.waiting.patience() }
    }

    /// Asks whether to go on.
    fn cancelled(&self) -> Result<(), MillingError> {
        if self.waiting.is_over() { Err(MillingError::Cancelled) } else { Ok(()) }
    }

    /// The same as far as it is known: what a search has left out that was given up is not to be told.
    fn was_cancelled(&self) -> Result<(), MillingError> {
        if self.waiting.has_given_up() { Err(MillingError::Cancelled) } else { Ok(()) }
    }
}

/// Collects the output and checks every location on its way.
pub(crate) struct Sink<'a> {
    milled: &'a mut Milled,
    checker: Checker<'a>,
    locations: usize,
    length: f64,
    last: Option<way::Stand>,
}

impl<'a> Sink<'a> {
    fn new(milled: &'a mut Milled, job: &'a Job<'_>) -> Self {
        let checker = Checker::new(job.tool.with_stock(job.thickness()), &job.checked);
        Self { milled, checker, locations: 0, length: 0.0, last: None }
    }

    /// A feed rate; zero writes none.
    fn feed(&mut self, feed: f64) {
        if feed != 0.0 {
            self.milled.moves.push(Move::Feed(feed));
        }
    }

    fn location(&mut self, job: &Job<'_>, stand: way::Stand) -> Result<(), MillingError> {
        let pose = stand.pose;
        self.locations += 1;
        self.length += self.last.map_or(0.0, |last| (pose.end - last.pose.end).norm());
        self.last = Some(stand);
        if self.locations > MOST_LOCATIONS {
            return Err(MillingError::TooManyLocations { most: MOST_LOCATIONS });
        }
        let most = LONGEST_PATH * job.size.max(job.tool.reach());
        if self.length > most {
            return Err(MillingError::TooLong { most });
        }
        match self.milled.moves.last_mut() {
            Some(Move::Locations(poses)) => poses.push(pose),
            _ => self.milled.moves.push(Move::Locations(vec![pose])),
        }
        Ok(())
    }
}

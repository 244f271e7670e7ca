//! Rotary axes: how the machine stands for each position, and the words of the tape because of it.

use std::collections::VecDeque;

use apt_cldata::record::{ClKind, ClPoint, ClRecord, ClWord, POSITIONS_A_UNIT};
use apt_geometry::{Vec3, patience::Patience};
use smol_str::SmolStr;

use super::Engine;
use crate::{
    finding::PostFindingKind,
    kinematics::{
        Angles, Carried, Frame, Kinematics, Rotary,
        divide::Tolerances,
        plan::{Unplanned, plan},
    },
    machine::{self, Coordinates, KinematicRules, MachineDefinition, Preference, ROTARY_NAMES},
};

/// Post-processor words behind which the machine stands elsewhere, so that nothing is planned over them.
const BREAKS: [&str; 11] =
    ["LOADTL", "LOAD", "TOOLNO", "TURRET", "UNLOAD", "GOHOME", "END", "REWIND", "ROTABL", "ROTHED", "ROTATE"];

/// Distance of unit vectors that are one direction with the six decimals that CL data have.
const SAME_AXIS: f64 = 1e-6;

/// A position, in the unit of the tape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    /// Tool end: in the part on a machine with rotary axes, else as the tape has it.
    pub(super) place: Vec3,
    /// Direction of the tool in the part.
    pub(super) axis: Vec3,
    /// How the rotary axes stand there; none on a machine without.
    step: Option<Step>,
}

/// How the tool comes to a position.
pub(super) enum Way {
    /// As it stands, to this place on the tape.
    Straight(Vec3),
    /// While axes turn to these angles, as the tape has them.
    Turning(Angles),
    /// After an axis has been turned back to the first angles, off the part.
    Back(Angles, Angles),
    /// Not at all, which has been told.
    Nowhere,
}

/// How the rotary axes come to a position.
#[derive(Debug, Clone, Copy)]
enum Step {
    /// They turn on the way to it.
    To(Angles),
    /// One of them is at its end: first they turn back, off the part, to the first angles, which point the tool as it stands.
    Back(Angles, Angles),
    /// No angles point the tool there.
    Unreachable,
    /// One of them would have to turn beyond its end.
    Beyond { which: usize, angle: f64 },
}

/// The rotary axes of a machine, and how they stand.
pub(super) struct Turning<'a> {
    pub(super) rules: &'a KinematicRules,
    pub(super) kinematics: Kinematics,
    /// Registers of the axes of the chain; a machine with one axis has no second.
    pub(super) names: [Option<&'static str>; 2],
    /// Which of them are told from 0 to 360.
    pub(super) wraps: [bool; 2],
    /// Degrees per minute.
    pub(super) most: [f64; 2],
    /// A millimetre on the tape.
    pub(super) unit: f64,
    /// How far the tool end may leave its way.
    pub(super) tolerance: f64,
    /// How far up the tool from its end the feed counts.
    pub(super) feed_point: f64,
    /// From the axes of the head to the nose of the spindle.
    pivot: f64,
    /// Angles as the tape has them, and what places are on the tape because of them.
    pub(super) angles: Angles,
    pub(super) frame: Frame,
    /// Direction of the tool in the part at the last position.
    pub(super) axis: Vec3,
    /// How they come to the positions of the stretch that is being made.
    plan: VecDeque<Step>,
    /// Whether the last motion was a rapid.
    after_rapid: bool,
    /// Angles by ROTABL and ROTHED, at which the coordinates of the program are those of the machine.
    held: Option<Held>,
    /// Whether the control follows the tool end, and whether it has to on the stretch that begins.
    pub(super) follows: bool,
    pub(super) to_follow: bool,
    /// From the nose of the spindle to the tool end, in the unit of the tape, once it is stated.
    tool_length: Option<f64>,
    length_reported: bool,
}

/// Rotary axes that a statement has turned.
#[derive(Debug, Clone, Copy)]
struct Held {
    /// To these angles.
    angles: Angles,
    /// Whether the coordinates of the program turn with the table.
    with_table: bool,
}

impl<'a> Turning<'a> {
    /// The rotary axes of a machine, all at 0; none where it has none. `unit` is a millimetre on the tape.
    pub(super) fn of(machine: &'a MachineDefinition, unit: f64) -> Option<Self> {
        let rules = machine.kinematics.as_ref()?;
        let mut axes = Vec::new();
        let (mut names, mut wraps, mut most) = ([None; 2], [false; 2], [f64::INFINITY; 2]);
        for (index, name) in rules.chain.iter().enumerate().take(2) {
            let axis = machine.rotary.get(name)?;
            names[index] = ROTARY_NAMES.into_iter().find(|known| known == name);
            (wraps[index], most[index]) = (axis.wraps, axis.most_degrees_per_minute);
            axes.push(Rotary {
                vector: axis.direction()?,
                carried: match axis.carried {
                    machine::Carried::Table => Carried::Table,
                    machine::Carried::Head => Carried::Head,
                },
                limits: axis.limits_degrees.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
                center: Vec3::from(axis.center_mm) * unit,
                prefer: rules.prefer.get(name).map(|preference| match preference {
                    Preference::Positive => 1.0,
                    Preference::Negative => -1.0,
                }),
            });
        }
        let first = *axes.first()?;
        let second = axes.get(1).copied().unwrap_or_else(|| fixed_across(&first));
        let kinematics = Kinematics {
            axes: [first, second],
            pivot: rules.pivot_mm * unit,
            dead_cone: rules.dead_cone_degrees.to_radians(),
            slides: rules.coordinates == Coordinates::Slides,
        };
        let angles = [0.0; 2];
        Some(Turning {
            rules,
            names,
            wraps,
            most,
            unit,
            tolerance: rules.tolerance_mm * unit,
            feed_point: 0.0,
            pivot: rules.pivot_mm * unit,
            angles,
            frame: kinematics.frame(angles),
            axis: kinematics.axis(angles),
            kinematics,
            plan: VecDeque::new(),
            after_rapid: false,
            held: None,
            follows: false,
            to_follow: false,
            tool_length: None,
            length_reported: false,
        })
    }

    /// What a move that is divided has to keep.
    pub(super) fn tolerances(&self) -> Tolerances {
        Tolerances {
            tip: self.tolerance,
            // A control that is told directions turns the tool along the great circle itself.
            axis: match self.rules.coordinates {
                Coordinates::Vector => std::f64::consts::PI,
                Coordinates::Slides | Coordinates::Tip => self.rules.axis_tolerance_degrees.to_radians(),
            },
            most: self.rules.most_parts,
        }
    }

    /// What a rapid has to keep, where it is divided: the tool end its way, and the tool what it likes.
    pub(super) fn rapid_tolerances(&self) -> Option<Tolerances> {
        let tip = self.rules.rapid_tolerance_mm.filter(|_| self.kinematics.slides)? * self.unit;
        Some(Tolerances { tip, axis: std::f64::consts::PI, most: self.rules.most_parts })
    }

    /// A place and a direction of the program as the part has them.
    fn in_part(&self, place: Vec3, axis: Option<Vec3>) -> (Vec3, Vec3) {
        let Some(held) = self.held else { return (place, axis.unwrap_or_else(Vec3::z)) };
        let standing = self.kinematics.axis(held.angles);
        if held.with_table {
            return (place, axis.unwrap_or(standing));
        }
        // What the table does with the part, also where the control follows the tool end.
        let table = Kinematics { slides: true, pivot: 0.0, ..self.kinematics }.frame(held.angles);
        let axis = axis.map_or(standing, |axis| table.rotation.transposed() * axis);
        (table.part(place), axis)
    }

    /// Stands at other angles.
    pub(super) fn turn(&mut self, axis: Vec3, angles: Angles) {
        (self.angles, self.axis) = (angles, axis);
        self.frame = self.kinematics.frame(angles);
    }

    /// Whether where the slides stand depends on the length of the tool, of which nothing is known; told once.
    pub(super) fn needs_length(&mut self, angles: Angles) -> bool {
        let leans =
            (0..2).any(|index| self.kinematics.axes[index].carried == Carried::Head && angles[index] != 0.0);
        let needed = self.kinematics.slides && leans && self.tool_length.is_none();
        needed && !std::mem::replace(&mut self.length_reported, true)
    }

    /// The length of the tool that a statement loads, on the tape.
    pub(super) fn load(&mut self, length: Option<f64>) {
        self.tool_length = length;
        self.length_reported = false;
        self.set_pivot(self.pivot);
    }

    /// The distance of the axes of the head from the nose of the spindle.
    pub(super) fn set_pivot(&mut self, pivot: f64) {
        self.pivot = pivot;
        self.kinematics.pivot = pivot + self.tool_length.unwrap_or(0.0);
        self.frame = self.kinematics.frame(self.angles);
    }

    /// Plans the positions of a stretch, from how the axes stand.
    fn plan(&mut self, axes: &[Vec3], patience: Patience<'_>) {
        let mut here = self.angles;
        let mut rest = axes;
        // A machine that need not turn does not, whatever it prefers.
        if axes.first().is_some_and(|axis| (axis - self.axis).norm() <= SAME_AXIS) {
            let indifferent = self.kinematics.axes.map(|axis| Rotary { prefer: None, ..axis });
            let indifferent = Kinematics { axes: indifferent, ..self.kinematics };
            if let Ok(angles) = plan(&indifferent, axes, here, patience) {
                return self.take(&angles, false);
            }
        }
        // Whether the first one is where the tool stands already, to be turned back there.
        let mut back = false;
        while !rest.is_empty() && !patience.ends_after(1) {
            let unplanned = match plan(&self.kinematics, rest, here, patience) {
                Ok(angles) => return self.take(&angles, back),
                Err(unplanned) => unplanned,
            };
            let (Unplanned::Unreachable { at } | Unplanned::Limit { at, .. }) = unplanned;
            // What comes before is known to be possible.
            let before = plan(&self.kinematics, &rest[..at], here, patience).unwrap_or_default();
            here = before.last().copied().unwrap_or(here);
            self.take(&before, back);
            match unplanned {
                Unplanned::Unreachable { .. } => {
                    self.plan.push_back(Step::Unreachable);
                    (rest, back) = (&rest[at + 1..], false);
                }
                // Each time it is turned back there has to be something gained.
                Unplanned::Limit { .. } if self.rules.retract_mm.is_some() && at > usize::from(back) => {
                    (rest, back) = (&rest[at - 1..], true);
                }
                Unplanned::Limit { which, angle, .. } => {
                    // Nothing is cut while the axis would be turned back.
                    let left = rest.len() - at;
                    self.plan.extend(std::iter::repeat_n(Step::Beyond { which, angle }, left));
                    return;
                }
            }
        }
    }

    /// Takes angles over, of which the first are those to which the axes are turned back.
    fn take(&mut self, angles: &[Angles], back: bool) {
        match angles {
            [turned, to, others @ ..] if back => {
                self.plan.push_back(Step::Back(*turned, *to));
                self.plan.extend(others.iter().map(|angles| Step::To(*angles)));
            }
            _ if back => {}
            _ => self.plan.extend(angles.iter().map(|angles| Step::To(*angles))),
        }
    }

    /// The angles to which a statement has turned the axes, if it has.
    pub(super) fn hold(&mut self, angles: Angles, with_table: bool) {
        let turned = angles != [0.0; 2];
        self.held = turned.then_some(Held { angles, with_table });
        self.plan.clear();
        self.turn(self.kinematics.axis(angles), angles);
    }
}

/// What stands for the second axis of a machine with one: held at 0, about a direction across the first.
fn fixed_across(first: &Rotary) -> Rotary {
    let least = first.vector.iamin();
    let aside = first.vector.cross(&Vec3::ith(least, 1.0));
    Rotary { vector: aside / aside.norm(), limits: [0.0, 0.0], prefer: None, ..*first }
}

impl Engine<'_> {
    /// The positions of a motion record: on a machine without rotary axes as far as the tool stands as the spindle does, with one finding for
    /// all motions in a row that it does not.
    pub(super) fn targets(&mut self, from: bool, points: &[ClPoint]) -> Vec<Target> {
        let mut targets = Vec::with_capacity(points.len());
        let (mut tilted, mut infinite) = (None, false);
        if !from {
            self.plan_ahead();
        }
        for (done, point) in points.iter().enumerate() {
            if self.patience.ends_among(done, POSITIONS_A_UNIT) {
                break;
            }
            let place = (point.position + self.shift) * self.scale;
            if !place.iter().all(|value| value.is_finite()) {
                infinite = true;
                continue;
            }
            match &mut self.turning {
                Some(turning) => {
                    let (place, axis) = turning.in_part(place, stated_axis(point));
                    let step = if from { None } else { turning.plan.pop_front() };
                    targets.push(Target { place, axis, step });
                }
                None if point.with_axis && leans(&point.axis) => tilted = tilted.or(Some(point.axis)),
                None => targets.push(Target { place, axis: point.axis, step: None }),
            }
        }
        if self.turning.is_none() {
            self.left_out(tilted.map(|axis| PostFindingKind::ToolAxis {
                i: axis.x,
                j: axis.y,
                k: axis.z,
                motions: 1,
            }));
        }
        if infinite {
            self.find(PostFindingKind::NotFinite);
        }
        targets
    }

    /// A place of the program as the part has it, in the unit of the tape, and a direction.
    pub(super) fn in_part(&self, place: Vec3, axis: Vec3) -> (Vec3, Vec3) {
        match &self.turning {
            Some(turning) => turning.in_part(place, Some(axis)),
            None => (place, axis),
        }
    }

    /// Where FROM says that the tool stands: with the rotary axes as the way from there wants them, where that says nothing of them.
    pub(super) fn stand_at(&mut self, target: &Target) {
        let ahead = self.records.get(self.at + 1..).unwrap_or_default();
        let planned = self.turning.as_ref().map(|turning| {
            let mut axes = vec![target.axis];
            axes.extend(stretch(ahead, turning, true, self.patience));
            let planned = plan(&turning.kinematics, &axes, turning.angles, self.patience).ok();
            let first = planned.and_then(|angles| angles.first().copied());
            let alone = || turning.kinematics.nearest(&target.axis, turning.angles);
            self.rounded_angles(first.or_else(alone).unwrap_or(turning.angles))
        });
        let mut position = target.place;
        if let Some((angles, turning)) = planned.zip(self.turning.as_mut()) {
            turning.turn(target.axis, angles);
            position = turning.frame.place(position);
        }
        self.position = Some(position);
    }

    /// Plans the stretch that begins with the motion record that is being made, unless it is in one already.
    fn plan_ahead(&mut self) {
        let (rapid, off) = (self.rapid.is_some(), self.position.is_none());
        let Some(turning) = self.turning.as_mut() else { return };
        // A rapid may lead out of the part; only what comes behind one is off it for certain.
        let is_off = rapid && (std::mem::replace(&mut turning.after_rapid, rapid) || off);
        if !turning.plan.is_empty() {
            return;
        }
        let ahead = self.records.get(self.at..).unwrap_or_default();
        let axes = stretch(ahead, turning, is_off, self.patience);
        turning.to_follow = axes.iter().any(leans) || turning.angles != [0.0; 2];
        turning.plan(&axes, self.patience);
    }
}

impl Engine<'_> {
    /// How the tool comes to a position; a finding where it does not.
    pub(super) fn way(&mut self, target: &Target) -> Way {
        let Some(turning) = &self.turning else { return Way::Straight(target.place) };
        let missing = match target.step {
            Some(Step::To(angles)) => {
                let angles = self.rounded_angles(angles);
                let stays = angles == turning.angles;
                let place = turning.frame.place(target.place);
                self.left_out(None);
                if !stays {
                    return Way::Turning(angles);
                }
                if let Some(turning) = &mut self.turning {
                    turning.axis = target.axis;
                }
                return Way::Straight(place);
            }
            Some(Step::Back(back, to)) => {
                let (back, to) = (self.rounded_angles(back), self.rounded_angles(to));
                self.left_out(None);
                return Way::Back(back, to);
            }
            Some(Step::Unreachable) => {
                let (i, j, k) = (target.axis.x, target.axis.y, target.axis.z);
                PostFindingKind::AxisUnreachable { i, j, k, positions: 1 }
            }
            Some(Step::Beyond { which, angle }) => {
                let [least, greatest] = turning.kinematics.axes[which].limits;
                let axis = SmolStr::new(turning.names[which].unwrap_or_default());
                PostFindingKind::RotaryLimit { axis, angle, least, greatest, positions: 1 }
            }
            // Who waits has given up.
            None => return Way::Nowhere,
        };
        self.left_out(Some(missing));
        Way::Nowhere
    }
}

/// The direction of the tool that a position states.
fn stated_axis(point: &ClPoint) -> Option<Vec3> {
    let length = point.axis.norm();
    (point.with_axis && length > 0.0 && length.is_finite()).then(|| point.axis / length)
}

/// Whether a tool axis is another one than that of an upright spindle.
pub(super) fn leans(axis: &Vec3) -> bool {
    axis.z <= 0.0 || axis.z < super::SPINDLE_AXIS_COSINE * axis.norm()
}

/// The tool axes of the positions from the first record on that are planned together: up to the next motion after a RAPID, or to what moves the
/// machine otherwise. Where the tool is off the part, the last rapid before a cut belongs to them, so that the machine turns on the one before it.
fn stretch(records: &[ClRecord], turning: &Turning<'_>, is_off: bool, patience: Patience<'_>) -> Vec<Vec3> {
    let mut axes = Vec::new();
    let mut rapid = false;
    // How many axes belong to the stretch if the rapid behind them is not the last one before a cut.
    let mut without_next: Option<usize> = None;
    let mut motions = 0;
    for record in records {
        if patience.ends_after(1) {
            break;
        }
        match &record.kind {
            ClKind::Motion { from: false, points, .. } => {
                if rapid && (!is_off || motions > 1) {
                    return axes.into_iter().take(without_next.unwrap_or(usize::MAX)).collect();
                }
                without_next = rapid.then_some(axes.len());
                let finite =
                    points.iter().filter(|point| point.position.iter().all(|value| value.is_finite()));
                axes.extend(finite.map(|point| turning.in_part(point.position, stated_axis(point)).1));
                (rapid, motions) = (false, motions + 1);
            }
            ClKind::Motion { .. } | ClKind::End => break,
            ClKind::Postprocessor { word, .. } if BREAKS.contains(&word.as_str()) => break,
            ClKind::Postprocessor { word, arguments, .. } if word == "RAPID" => {
                rapid = !arguments.iter().any(|item| matches!(item, ClWord::Word(word) if word == "OFF"));
            }
            _ => {}
        }
    }
    axes
}

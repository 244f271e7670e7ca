//! Rotary axes of a machine, and how its tape tells where the tool stands.

use std::collections::BTreeMap;

use apt_geometry::Vec3;
use serde::{Deserialize, Serialize};

use super::{MachineDefinition, MachineError};

/// Names that rotary axes may have, which are those of their registers.
pub(crate) const ROTARY_NAMES: [&str; 3] = ["A", "B", "C"];
/// The registers of a tool axis that is told as a vector.
pub(crate) const VECTOR_REGISTERS: [&str; 3] = ["VI", "VJ", "VK"];
/// Sine of the angle below which two rotary axes count as parallel: no machine has two so near to each other that point the tool anywhere.
const PARALLEL_SINE: f64 = 1e-3;

/// What a rotary axis turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Carried {
    /// The part.
    Table,
    /// The tool.
    Head,
}

/// A rotary axis. Its angle counts as the tool turns about the vector as seen from the part, also where it is the part that is turned.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotaryAxis {
    /// The direction about which it turns while all angles are 0, of any length.
    pub vector: [f64; 3],
    /// What it turns.
    pub carried: Carried,
    /// Least and greatest angle, degrees; none for an axis that turns without end.
    #[serde(default)]
    pub limits_degrees: Option<[f64; 2]>,
    /// A place of the axis seen from the work origin, millimetres. Axes of a head go through one place, from which `pivot_mm` counts.
    #[serde(default)]
    pub center_mm: [f64; 3],
    /// Whether the tape tells its angle from 0 to 360, to which the control turns it the shorter way; for an axis that turns without end.
    #[serde(default)]
    pub wraps: bool,
    /// How fast it turns at feed rate.
    pub most_degrees_per_minute: f64,
}

impl RotaryAxis {
    /// Its unit direction; none of a vector without a length.
    pub(crate) fn direction(&self) -> Option<Vec3> {
        let vector = Vec3::from(self.vector);
        let length = vector.norm();
        (length > 0.0 && length.is_finite()).then(|| vector / length)
    }
}

/// What the words of a block say of a tool that may lean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Coordinates {
    /// Where the slides and the rotary axes stand: the post-processor computes them, and divides moves on which axes turn.
    Slides,
    /// The tool end as the part has it, and the angles: the control follows the tool end.
    Tip,
    /// The tool end as the part has it, and the direction of the tool: the control finds the angles.
    Vector,
}

/// Which of two positions of the machine is taken where both are possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preference {
    /// A positive angle.
    #[serde(rename = "+")]
    Positive,
    /// A negative angle.
    #[serde(rename = "-")]
    Negative,
}

/// How the rotary axes go together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KinematicRules {
    /// One or two rotary axes, that nearest to the part first.
    pub chain: Vec<String>,
    /// What the words of a block say.
    pub coordinates: Coordinates,
    /// From the axes of the head to the nose of the spindle, millimetres. With `slides` the length of the tool, which LOADTL states, is added.
    #[serde(default)]
    pub pivot_mm: f64,
    /// Angles that are taken where there is a choice.
    #[serde(default)]
    pub prefer: BTreeMap<String, Preference>,
    /// How far the tool end may leave its straight way between two blocks on which axes turn, millimetres.
    pub tolerance_mm: f64,
    /// The same of rapids, which are not divided without it. Both count where the tape tells slides.
    #[serde(default)]
    pub rapid_tolerance_mm: Option<f64>,
    /// How far the tool may lean out of the plane in which it turns, degrees.
    pub axis_tolerance_degrees: f64,
    /// Most blocks into which a move is divided.
    pub most_parts: usize,
    /// A tool that leans by less than this from the first rotary axis stands along it, degrees.
    pub dead_cone_degrees: f64,
    /// A rotary axis that turns farther than this in one motion is told of, where the tool hardly turns.
    pub warn_degrees: f64,
    /// How far the tool goes out of the part along itself where a rotary axis comes to its end in the cut, to come back with that turned back, millimetres;
    /// without it what is behind that place is left out.
    #[serde(default)]
    pub retract_mm: Option<f64>,
}

impl MachineDefinition {
    /// Whether the rotary axes make a machine.
    ///
    /// # Errors
    /// A chain of more than two axes, or of some that are not there, are parallel, or carry the part behind the tool; codes and registers that are missing.
    pub(super) fn validate_rotary(&self) -> Result<(), MachineError> {
        let Some(rules) = &self.kinematics else {
            return match self.rotary.keys().next() {
                None => Ok(()),
                Some(axis) => Err(MachineError::NotInChain { axis: axis.clone() }),
            };
        };
        if !(1..=2).contains(&rules.chain.len()) {
            return Err(MachineError::ChainLength { axes: rules.chain.len() });
        }
        for axis in rules.chain.iter().chain(rules.prefer.keys()) {
            if !self.rotary.contains_key(axis) || !ROTARY_NAMES.contains(&axis.as_str()) {
                return Err(MachineError::UnknownRotaryAxis { axis: axis.clone() });
            }
        }
        if let Some(axis) = self.rotary.keys().find(|axis| !rules.chain.contains(axis)) {
            return Err(MachineError::NotInChain { axis: axis.clone() });
        }
        self.validate_chain(rules)?;
        let needed: Vec<&str> = match rules.coordinates {
            Coordinates::Slides | Coordinates::Tip => rules.chain.iter().map(String::as_str).collect(),
            Coordinates::Vector => VECTOR_REGISTERS.to_vec(),
        };
        if let Some(register) = needed.into_iter().find(|register| !self.registers.contains_key(*register)) {
            return Err(MachineError::MissingRegister { register: register.to_owned() });
        }
        if rules.coordinates == Coordinates::Slides && self.codes.feed_inverse.is_none() {
            return Err(MachineError::MissingCode { code: "codes.feed_inverse".to_owned() });
        }
        if rules.coordinates != Coordinates::Slides && self.templates.follow_on.is_empty() {
            return Err(MachineError::MissingCode { code: "templates.follow_on".to_owned() });
        }
        Ok(())
    }

    fn validate_chain(&self, rules: &KinematicRules) -> Result<(), MachineError> {
        let axes: Vec<(&String, &RotaryAxis)> =
            rules.chain.iter().filter_map(|name| Some((name, self.rotary.get(name)?))).collect();
        for (name, axis) in &axes {
            if axis.wraps && axis.limits_degrees.is_some() {
                return Err(MachineError::WrapsWithinLimits { axis: (*name).clone() });
            }
            let place = |what: &str| format!("rotary.{name}.{what}");
            if axis.direction().is_none() {
                return Err(MachineError::NotPositive { place: place("vector") });
            }
            if !(axis.most_degrees_per_minute > 0.0 && axis.most_degrees_per_minute.is_finite()) {
                return Err(MachineError::NotPositive { place: place("most_degrees_per_minute") });
            }
            if axis.center_mm.iter().any(|value| !value.is_finite()) {
                return Err(MachineError::NotPositive { place: place("center_mm") });
            }
        }
        let positive = [
            ("tolerance_mm", rules.tolerance_mm),
            ("axis_tolerance_degrees", rules.axis_tolerance_degrees),
            ("most_parts", rules.most_parts as f64),
            ("dead_cone_degrees", rules.dead_cone_degrees),
            ("warn_degrees", rules.warn_degrees),
            ("rapid_tolerance_mm", rules.rapid_tolerance_mm.unwrap_or(1.0)),
            ("retract_mm", rules.retract_mm.unwrap_or(1.0)),
            // A head may turn about the tool end itself.
            ("pivot_mm", rules.pivot_mm + 1.0),
        ];
        if let Some((name, _)) = positive.iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
            return Err(MachineError::NotPositive { place: format!("kinematics.{name}") });
        }
        if let [(first, rider), (second, carrier)] = axes[..] {
            let sine =
                rider.direction().zip(carrier.direction()).map(|(one, other)| one.cross(&other).norm());
            if first == second || sine.is_none_or(|sine| sine < PARALLEL_SINE) {
                return Err(MachineError::ParallelAxes { first: first.clone(), second: second.clone() });
            }
            if rider.carried == Carried::Head && carrier.carried == Carried::Table {
                return Err(MachineError::TableBehindHead { table: second.clone(), head: first.clone() });
            }
        }
        Ok(())
    }
}

//! What a definition has to be besides well formed.

use super::{
    ArcCenter, CENTERS, Coordinates, HELIX_ANGLE, MachineDefinition, MachineError, RADIUS, RISES, SCHEMA,
    VECTOR_REGISTERS,
};
use crate::{
    arc::plane_axes,
    template::{Piece, pieces},
};

/// The registers of the linear axes by coordinate.
const AXES: [&str; 3] = ["X", "Y", "Z"];

/// Registers that every mill needs.
const NEEDED: [&str; 9] = ["N", "X", "Y", "Z", "I", "J", "K", "F", "S"];

impl MachineDefinition {
    /// Whether everything that is named is there, and ranges are ranges.
    pub(super) fn validate(&self) -> Result<(), MachineError> {
        if self.schema != SCHEMA {
            return Err(MachineError::Schema { found: self.schema });
        }
        for register in NEEDED {
            if !self.registers.contains_key(register) {
                return Err(MachineError::MissingRegister { register: register.to_owned() });
            }
        }
        if self.arc.center == ArcCenter::Radius && !self.registers.contains_key(RADIUS) {
            return Err(MachineError::MissingRegister { register: RADIUS.to_owned() });
        }
        for register in &self.block.order {
            self.known("block.order", register)?;
        }
        for (place, template) in self.all_templates() {
            for name in crate::template::register_names(&template) {
                self.known(&place, &name)?;
            }
        }
        self.validate_rotary()?;
        self.validate_motion()?;
        let turns = self.rotary.iter().filter_map(|(name, axis)| Some((name, axis.limits_degrees?)));
        let turns = turns.map(|(name, limits)| (format!("rotary.{name}.limits_degrees"), limits));
        let axes = self.axes.iter().map(|(name, axis)| (format!("axes.{name}.limits_mm"), axis.limits_mm));
        let tools = self.limits.tools.map(|tools| tools.map(f64::from));
        // A magazine may hold one tool only: its range is tested as one from below the first.
        let tools = tools.map(|[first, last]| [first - 1.0, last]);
        let ranges = [
            ("limits.feed_mm", self.limits.feed_mm),
            ("limits.spindle", self.limits.spindle),
            ("limits.tools", tools),
        ];
        let ranges = ranges.into_iter().filter_map(|(place, range)| Some((place.to_owned(), range?)));
        let radii = ("arc".to_owned(), [self.arc.min_radius_mm, self.arc.max_radius_mm]);
        for (place, [least, greatest]) in axes.chain(turns).chain(ranges).chain([radii]) {
            // Written so that a NaN is refused too.
            if least.partial_cmp(&greatest) != Some(std::cmp::Ordering::Less) {
                let (least, greatest) = (least.to_string(), greatest.to_string());
                return Err(MachineError::Limits { place, least, greatest });
            }
        }
        Ok(())
    }

    /// Whether templates of motion tell all that a motion is.
    fn validate_motion(&self) -> Result<(), MachineError> {
        let t = &self.templates;
        let rotary: Vec<&str> = match &self.kinematics {
            None => Vec::new(),
            Some(rules) if rules.coordinates == Coordinates::Vector => VECTOR_REGISTERS.to_vec(),
            Some(rules) => rules.chain.iter().map(String::as_str).collect(),
        };
        let straight: Vec<&str> = AXES.into_iter().chain(rotary).collect();
        names("templates.linear", &t.linear, "", &straight)?;
        names("templates.rapid", &t.rapid, "", &straight)?;
        for plane in &self.arc.planes {
            let [u, v, across] = plane_axes(*plane);
            let centers = match self.arc.center {
                ArcCenter::Radius => vec![RADIUS],
                ArcCenter::Incremental | ArcCenter::Absolute => vec![CENTERS[u], CENTERS[v]],
            };
            let flat: Vec<&str> = [AXES[u], AXES[v]].into_iter().chain(centers.iter().copied()).collect();
            names("templates.arc", &t.arc, &t.arc_center, &flat)?;
            if self.arc.helix && t.helix.is_empty() {
                names("templates.arc", &t.arc, "", &[AXES[across]])?;
            }
            let turning: Vec<&str> = [HELIX_ANGLE, RISES[across]].into_iter().chain(centers).collect();
            names("templates.helix", &t.helix, &t.arc_center, &turning)?;
        }
        match self.arc.helix_degrees {
            Some(degrees) if !(degrees > 0.0 && degrees.is_finite()) => {
                Err(MachineError::NotPositive { place: "arc.helix_degrees".to_owned() })
            }
            _ => Ok(()),
        }
    }

    fn known(&self, place: &str, register: &str) -> Result<(), MachineError> {
        let computed = matches!(register, "ZR" | "ZI");
        if computed || self.registers.contains_key(register) {
            return Ok(());
        }
        Err(MachineError::UnknownRegister { place: place.to_owned(), register: register.to_owned() })
    }

    fn all_templates(&self) -> Vec<(String, String)> {
        let t = &self.templates;
        let mut all: Vec<(String, String)> = Vec::new();
        let lists = [
            ("program_start", &t.program_start),
            ("program_end", &t.program_end),
            ("trailer", &t.trailer),
            ("tool_change", &t.tool_change),
            ("home", &t.home),
            ("dwell", &t.dwell),
            ("follow_on", &t.follow_on),
            ("follow_off", &t.follow_off),
        ];
        for (name, list) in lists {
            all.extend(list.iter().map(|text| (format!("templates.{name}"), text.clone())));
        }
        let single = [
            ("tool_select", &t.tool_select),
            ("length_offset", &t.length_offset),
            ("first_xy", &t.first_xy),
            ("first_z", &t.first_z),
            ("spindle_on", &t.spindle_on),
            ("spindle_speed", &t.spindle_speed),
            ("function", &t.function),
            ("linear", &t.linear),
            ("rapid", &t.rapid),
            ("arc", &t.arc),
            ("arc_center", &t.arc_center),
            ("helix", &t.helix),
            ("message", &t.message),
            ("spindle_orient", &t.spindle_orient),
        ];
        all.extend(single.map(|(name, text)| (format!("templates.{name}"), text.clone())));
        for (name, cycle) in &self.cycles {
            let texts = [&cycle.pre, &cycle.on, &cycle.next].into_iter().flatten();
            let texts = texts.chain(&cycle.define).chain(&cycle.each);
            all.extend(texts.map(|text| (format!("cycles.{name}"), text.clone())));
        }
        all
    }
}

/// Whether a template, or the one of the block before it, names all that it has to tell; one that is not there need not.
fn names(place: &str, template: &str, before: &str, registers: &[&str]) -> Result<(), MachineError> {
    if template.is_empty() {
        return Ok(());
    }
    let named = |wanted: &str| {
        let mut all = before.split_whitespace().chain(template.split_whitespace()).flat_map(pieces);
        all.any(|piece| matches!(piece, Piece::Placeholder { name, .. } if name == wanted))
    };
    match registers.iter().find(|register| !named(register)) {
        None => Ok(()),
        Some(register) => {
            let (place, register) = (place.to_owned(), (*register).to_owned());
            Err(MachineError::TemplateLacks { place, register })
        }
    }
}

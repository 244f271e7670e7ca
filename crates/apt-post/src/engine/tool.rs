//! Tools, spindle, coolant, cutter compensation.

use apt_cldata::record::{ClKind, ClWord, Units};

use super::{Engine, MILLIMETERS_PER_INCH, PendingCompensation, Spindle, hole::Cycle};
use crate::{control::Values, finding::PostFindingKind, words::Arguments};

/// Largest tool number that is taken.
const LARGEST_TOOL: f64 = 99_999.0;
const INCHES_PER_FOOT: f64 = 12.0;
const MILLIMETERS_PER_METER: f64 = 1000.0;

/// Minor words of SPINDL, and those that stop it.
const SPINDLE_WORDS: [&str; 19] = [
    "RPM", "SFM", "SMM", "CLW", "CCLW", "ON", "OFF", "ORIENT", "LOCK", "MAXRPM", "LOW", "MEDIUM", "HIGH",
    "AUTO", "RANGE", "RADIUS", "DIAMTR", "BOTH", "NEUTRL",
];
const STOPS: [&str; 3] = ["OFF", "ORIENT", "LOCK"];
/// Words behind which another tool is in the spindle, or none.
const TOOL_WORDS: [&str; 5] = ["LOADTL", "LOAD", "TOOLNO", "TURRET", "UNLOAD"];

impl Engine<'_> {
    /// A tool or offset number.
    fn tool_number(&mut self, arguments: &Arguments<'_>, name: &str, value: f64) -> Option<u32> {
        if (0.0..=LARGEST_TOOL).contains(&value) && value.fract() == 0.0 {
            return Some(value as u32);
        }
        self.find(PostFindingKind::BadValue { word: arguments.word.clone(), argument: name.into(), value });
        None
    }

    /// Number 0 puts the tool away.
    fn check_magazine(&mut self, number: u32) {
        if let Some([least, greatest]) = self.machine.limits.tools
            && number != 0
            && !(least..=greatest).contains(&number)
        {
            self.find(PostFindingKind::ToolOutsideMagazine { number, least, greatest });
        }
    }

    /// LOADTL, LOAD/TOOL, TOOLNO, TURRET, UNLOAD.
    pub(super) fn load_tool(&mut self, arguments: &Arguments<'_>) {
        let unload = arguments.word == "UNLOAD";
        let number = if unload { Some(0.0) } else { arguments.number() };
        let Some(number) = number else { return self.find(arguments.missing("the tool number")) };
        let Some(number) = self.tool_number(arguments, "tool", number) else { return };
        let offset = ["OSETNO", "OFFSET", "ADJUST"].into_iter().find_map(|word| arguments.after(word));
        let offset = match offset {
            Some(offset) => self.tool_number(arguments, "offset", offset),
            None => Some(number),
        };
        let Some(offset) = offset else { return };
        self.left_on(arguments.word);
        self.end_cycle();
        self.unused();
        self.check_magazine(number);
        if self.compensated {
            self.find(PostFindingKind::CompensationLeftOn { word: arguments.word.clone() });
            // Told once.
            self.compensating = false;
        }
        if self.tool == Some(number) {
            self.find(PostFindingKind::SameTool { number });
        }
        let machine = self.machine;
        if self.spindle.on {
            self.find(PostFindingKind::ToolChangeWhile { what: "SPINDL".into() });
            self.control.function(&machine.codes.spindle_off);
            self.spindle.on = false;
        }
        // What has waited for a motion in vain is not on yet.
        if self.coolant && self.approach.is_none() {
            self.control.function(&machine.codes.coolant_off);
        }
        self.follow_no_more(false);
        let length = arguments.after("LENGTH").map(|length| length * self.scale);
        if let Some(turning) = &mut self.turning {
            turning.load(length);
        }
        let speed = if unload { None } else { self.speed_ahead() };
        let values = Values::default()
            .number("T", f64::from(number))
            .number("H", f64::from(offset))
            .optional("S", speed);
        self.control.templates(&machine.templates.tool_change, &values);
        self.tool = Some(number);
        self.length_offset = offset;
        // Where the machine goes to change a tool, the post-processor does not know.
        self.control.forget(&["X", "Y", "Z"]);
        self.position = None;
        // Coolant stays on until it is put off: it runs again where the new tool comes to the part.
        self.coolant &= !unload;
        let coolant = self.coolant_code.clone().filter(|_| self.coolant);
        self.approach = (!unload).then(|| coolant.unwrap_or_default());
    }

    /// SELCTL, SELECT/TOOL.
    pub(super) fn select_tool(&mut self, arguments: &Arguments<'_>) {
        let Some(number) = arguments.number() else { return self.find(arguments.missing("the tool number")) };
        let Some(number) = self.tool_number(arguments, "tool", number) else { return };
        self.check_magazine(number);
        let machine = self.machine;
        let values = Values::default().number("T", f64::from(number));
        self.control.template(&machine.templates.tool_select, &values);
    }

    pub(super) fn spindle_statement(&mut self, arguments: &Arguments<'_>) {
        if let Some(kind) = arguments.unknown(&SPINDLE_WORDS) {
            return self.find(kind);
        }
        self.spindle_reported = false;
        // A control that taps goes by the speed that the cycle began with.
        if self.cycle.as_ref().is_some_and(Cycle::taps) {
            self.leave_cycle();
        }
        let machine = self.machine;
        if arguments.has("OFF") {
            self.control.function(&machine.codes.spindle_off);
            self.spindle.on = false;
            return;
        }
        if arguments.has("ORIENT") || arguments.has("LOCK") {
            match &machine.codes.spindle_orient {
                Some(code) => self.control.function(code),
                None => self.find(PostFindingKind::NoCode {
                    word: arguments.word.clone(),
                    name: "spindle_orient".into(),
                }),
            }
            self.spindle.on = false;
            return;
        }
        for argument in ["LOW", "MEDIUM", "HIGH", "AUTO", "RANGE", "BOTH", "NEUTRL"] {
            if arguments.has(argument) {
                let word = arguments.word.clone();
                self.find(PostFindingKind::ArgumentNotUsed { word, argument: argument.into() });
            }
        }
        if arguments.has("MAXRPM") {
            self.spindle.maximum = arguments.after("MAXRPM").or(self.spindle.maximum);
            if arguments.numbers().count() == 1 {
                return;
            }
        }
        let Some(speed) = self.spindle_speed(arguments) else { return };
        let counterclockwise =
            if arguments.has("ON") { self.spindle.counterclockwise } else { arguments.has("CCLW") };
        self.spindle = Spindle { speed: Some(speed), counterclockwise, on: true, ..self.spindle };
        self.spindle_again();
    }

    /// Lets the spindle turn as it was last told to.
    pub(super) fn spindle_again(&mut self) {
        let machine = self.machine;
        let Spindle { speed: Some(speed), counterclockwise, on: true, .. } = self.spindle else { return };
        let direction = match counterclockwise {
            true => machine.codes.spindle_counterclockwise.clone(),
            false => machine.codes.spindle_clockwise.clone(),
        };
        let values = Values::default().number("S", speed).text("direction", direction);
        self.control.template(&machine.templates.spindle_speed, &values);
        self.control.template(&machine.templates.spindle_on, &values);
    }

    /// Revolutions per minute, within the machine's range.
    fn spindle_speed(&mut self, arguments: &Arguments<'_>) -> Option<f64> {
        let speed = match self.stated_speed(arguments, self.cutter_diameter) {
            Ok(speed) => speed,
            Err(kind) => {
                self.find(kind);
                return None;
            }
        };
        let [least, greatest] = self.speed_range(self.spindle.maximum);
        if !(least..=greatest).contains(&speed) {
            self.find(PostFindingKind::SpindleOutOfRange { value: speed, least, greatest });
        }
        Some(speed.clamp(least.min(greatest), greatest))
    }

    /// Least and greatest revolutions per minute.
    fn speed_range(&self, maximum: Option<f64>) -> [f64; 2] {
        let [least, greatest] = self.machine.limits.spindle.unwrap_or([0.0, f64::INFINITY]);
        [least, maximum.map_or(greatest, |maximum| maximum.min(greatest))]
    }

    /// Revolutions per minute that a statement asks for, with a cutter of some diameter.
    fn stated_speed(&self, arguments: &Arguments<'_>, diameter: Option<f64>) -> Result<f64, PostFindingKind> {
        let stated = arguments.items.iter().enumerate().find_map(|(at, item)| match item {
            ClWord::Number(number) => {
                let keyword = at.checked_sub(1).and_then(|before| arguments.items.get(before));
                let other = matches!(keyword, Some(ClWord::Word(word)) if matches!(word.as_str(), "MAXRPM" | "RANGE" | "RADIUS" | "DIAMTR"));
                (!other).then_some(*number)
            }
            ClWord::Word(_) => None,
        });
        let surface_speed = arguments.has("SFM") || arguments.has("SMM");
        let speed = match stated {
            None => self.spindle.speed.ok_or(PostFindingKind::NoSpindleSpeed)?,
            Some(value) if surface_speed => self.turns_at(arguments, value, diameter)?,
            Some(value) => value,
        };
        if speed <= 0.0 || speed.is_nan() {
            let word = arguments.word.clone();
            return Err(PostFindingKind::BadValue { word, argument: "speed".into(), value: speed });
        }
        Ok(speed)
    }

    /// Revolutions per minute at which the edge of a cutter goes so far in a minute.
    fn turns_at(
        &self,
        arguments: &Arguments<'_>,
        value: f64,
        diameter: Option<f64>,
    ) -> Result<f64, PostFindingKind> {
        let stated =
            arguments.after("DIAMTR").or_else(|| arguments.after("RADIUS").map(|radius| radius * 2.0));
        let diameter = stated.map(|diameter| diameter * self.scale).or(diameter);
        let diameter =
            diameter.filter(|diameter| *diameter > 0.0).ok_or(PostFindingKind::NoCutterDiameter)?;
        let millimeters = match self.control.units {
            Units::Inches => diameter * MILLIMETERS_PER_INCH,
            Units::Millimeters => diameter,
        };
        let per_minute = if arguments.has("SFM") {
            value * INCHES_PER_FOOT * MILLIMETERS_PER_INCH
        } else {
            value * MILLIMETERS_PER_METER
        };
        Ok(per_minute / (std::f64::consts::PI * millimeters))
    }

    /// The speed with which a control is told of a tool that has to be told of both at once: that of the statement between the
    /// tool and its first motion, or the one in force.
    fn speed_ahead(&self) -> Option<f64> {
        let templates = self.machine.templates.tool_change.iter();
        if !templates.flat_map(|text| crate::template::register_names(text)).any(|name| name == "S") {
            return None;
        }
        let mut diameter = self.cutter_diameter;
        let mut maximum = self.spindle.maximum;
        for record in self.records.get(self.at + 1..).unwrap_or_default() {
            if self.patience.ends_after(1) {
                break;
            }
            match &record.kind {
                ClKind::Motion { from: false, .. } | ClKind::End => break,
                ClKind::Postprocessor { word, .. } if TOOL_WORDS.contains(&word.as_str()) => break,
                ClKind::Control { word, arguments, .. } if word == "CUTTER" => {
                    diameter = (Arguments { word, items: arguments }).number().map(|d| d.abs() * self.scale);
                }
                ClKind::Postprocessor { word, arguments, .. } if word == "SPINDL" => {
                    let arguments = Arguments { word, items: arguments };
                    maximum = arguments.after("MAXRPM").or(maximum);
                    let stops = STOPS.iter().any(|stop| arguments.has(stop));
                    let only_maximum = arguments.has("MAXRPM") && arguments.numbers().count() == 1;
                    if stops || only_maximum || arguments.unknown(&SPINDLE_WORDS).is_some() {
                        continue;
                    }
                    let [least, greatest] = self.speed_range(maximum);
                    let speed = self.stated_speed(&arguments, diameter).ok()?;
                    return Some(speed.clamp(least.min(greatest), greatest));
                }
                _ => {}
            }
        }
        self.spindle.speed
    }

    pub(super) fn coolant_statement(&mut self, arguments: &Arguments<'_>) {
        let codes = &self.machine.codes;
        let kind = arguments.items.iter().find_map(|item| match item {
            ClWord::Word(word) => Some(word.to_ascii_uppercase()),
            ClWord::Number(_) => None,
        });
        let name = kind.as_deref().unwrap_or("ON");
        let code = match name {
            "OFF" => {
                self.approach = self.approach.take().map(|_| String::new());
                self.coolant = false;
                let code = codes.coolant_off.clone();
                return self.control.function(&code);
            }
            "ON" => self.coolant_code.clone().or_else(|| Some(codes.coolant_flood.clone())),
            "FLOOD" | "TAPKUL" | "TAP" => Some(codes.coolant_flood.clone()),
            "MIST" => codes.coolant_mist.clone(),
            "AIR" => codes.coolant_air.clone(),
            "THRU" => codes.coolant_through.clone(),
            other => {
                let argument = other.into();
                return self
                    .find(PostFindingKind::UnknownArgument { word: arguments.word.clone(), argument });
            }
        };
        let code = match code {
            Some(code) => code,
            None => {
                let argument = format!("{name} (flood instead)").into();
                self.find(PostFindingKind::ArgumentNotUsed { word: arguments.word.clone(), argument });
                codes.coolant_flood.clone()
            }
        };
        self.coolant_code = Some(code.clone());
        self.coolant = true;
        match &mut self.approach {
            Some(pending) => *pending = code,
            None => {
                if self.machine.rules.coolant_after_spindle && !self.spindle.on {
                    self.find(PostFindingKind::CoolantBeforeSpindle);
                }
                self.control.function(&code);
            }
        }
    }

    /// Coolant that still waits for a first Z that does not come.
    pub(super) fn coolant_now(&mut self) {
        if let Some(code) = self.approach.take().filter(|code| !code.is_empty()) {
            self.control.function(&code);
        }
    }

    pub(super) fn compensation_statement(&mut self, arguments: &Arguments<'_>) {
        const KNOWN: [&str; 5] = ["ON", "OFF", "LEFT", "RIGHT", "XYPLAN"];
        if let Some(kind) = arguments.unknown(&KNOWN) {
            return self.find(kind);
        }
        let codes = &self.machine.codes;
        let (code, name) = if arguments.has("OFF") {
            (&codes.compensation_off, "compensation_off")
        } else if arguments.has("LEFT") {
            (&codes.compensation_left, "compensation_left")
        } else if arguments.has("RIGHT") {
            (&codes.compensation_right, "compensation_right")
        } else {
            // ON announces; the side comes with a statement of its own.
            return;
        };
        let Some(code) = code.clone() else {
            return self.find(PostFindingKind::NoCode { word: arguments.word.clone(), name: name.into() });
        };
        let mut words = vec![code];
        if !arguments.has("OFF") {
            let number = arguments.number().or(self.tool.map(f64::from));
            let Some(number) = number else { return self.find(arguments.missing("the offset number")) };
            let Some(number) = self.tool_number(arguments, "offset", number) else { return };
            words.extend(self.control.number_text("D", f64::from(number)));
        }
        if let Some(pending) = self.compensation.take() {
            self.find_at(pending.place, PostFindingKind::CompensationUnused);
        }
        self.compensated = !arguments.has("OFF");
        self.compensation = Some(PendingCompensation { words, place: self.control.place });
    }
}

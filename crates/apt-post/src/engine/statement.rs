//! Post-processor words and texts.

use apt_cldata::record::{ClWord, Units};
use apt_geometry::Vec3;
use smol_str::SmolStr;

use super::{Engine, Feed, MILLIMETERS_PER_INCH, work_offset::WorkOffset};
use crate::{
    control::Values,
    finding::PostFindingKind,
    form::{self, Treatment},
    machine::LinearAxis,
    words::{Arguments, FeedMode, LengthUnit, feed_unit},
};

const SECONDS_PER_MINUTE: f64 = 60.0;
const MILLISECONDS_PER_SECOND: f64 = 1000.0;
/// The longest leader that makes sense on a tape: fifty feet.
const LONGEST_LEADER_INCHES: f64 = 600.0;
/// Levels of optional blocks: 1 to 9 have a digit.
const FIRST_SKIP_LEVEL: u32 = 1;
const LAST_SKIP_LEVEL: u32 = 9;
/// Largest M and G numbers that AUXFUN and PREFUN write.
const LARGEST_CODE: f64 = 999.9;

impl Engine<'_> {
    pub(super) fn text(&mut self, word: &SmolStr, text: &str) {
        let machine = self.machine;
        let length = text.trim().chars().count();
        if matches!(word.as_str(), "PARTNO" | "PPRINT" | "INSERT") && length > self.text_limit {
            let limit = self.text_limit;
            self.find(PostFindingKind::TextTooLong { word: word.clone(), length, limit });
        }
        match word.as_str() {
            // The first one stands at the start of the tape.
            "PARTNO" if !std::mem::replace(&mut self.named, true) => {}
            "PARTNO" => {
                self.find(PostFindingKind::Repeated { word: word.clone() });
                self.control.remark(&machine.block.comment, text);
            }
            "INSERT" => {
                self.note_work_offset(text);
                self.control.push_block(text.trim());
                // The text may have changed anything.
                self.control.forget_all();
                self.position = None;
            }
            "PPRINT" | "TPRINT" if self.messages_off => {}
            "PPRINT" | "TPRINT" | "DISPLY" => self.control.remark(&machine.templates.message, text),
            _ => {}
        }
    }

    pub(super) fn word(&mut self, word: &SmolStr, items: &[ClWord]) {
        let arguments = Arguments { word, items };
        if self.site_word(&arguments) {
            return;
        }
        for kind in form::check(&arguments) {
            self.find(kind);
        }
        let machine = self.machine;
        match word.as_str() {
            "RAPID" => self.rapid_statement(&arguments),
            "FEDRAT" => self.feed_statement(&arguments),
            "SPINDL" => self.spindle_statement(&arguments),
            "COOLNT" => self.coolant_statement(&arguments),
            "LOADTL" | "LOAD" | "TURRET" | "UNLOAD" => self.load_tool(&arguments),
            "TOOLNO" if !arguments.has("ADJUST") => self.load_tool(&arguments),
            "TOOLNO" | "OFSTNO" => self.offset_statement(&arguments),
            "SELCTL" | "SELECT" => self.select_tool(&arguments),
            "CUTCOM" => self.compensation_statement(&arguments),
            "CYCLE" => self.cycle_statement(&arguments),
            "DELAY" | "DWELL" => self.delay_statement(&arguments),
            "STOP" => self.control.code(&machine.codes.stop),
            "OPSTOP" | "ISTOP" => self.control.function(&machine.codes.optional_stop),
            "END" | "REWIND" => {
                self.unused();
                self.end_program();
            }
            "GOHOME" => self.home(),
            "CLEARP" | "CLRSRF" => self.clearance_statement(&arguments),
            "RETRCT" | "GOCLER" => self.retract(word),
            "PLUNGE" => self.plunge(&arguments),
            "ORIGIN" => self.shift_statement(&arguments, -1.0),
            "TRANS" => self.shift_statement(&arguments, 1.0),
            "DISPLY" => self.display_statement(&arguments),
            "SEQNO" => self.sequence_statement(&arguments),
            "OPSKIP" | "DELETE" => self.skip_statement(&arguments),
            "AUXFUN" => self.function(&arguments, "M"),
            "PREFUN" => self.function(&arguments, "G"),
            "MCHTOL" => match arguments.number() {
                Some(tolerance) if tolerance >= 0.0 => self.arc_tolerance = Some(tolerance * self.scale),
                _ => self.find(arguments.missing("the tolerance")),
            },
            "ARCSLP" | "SET" => self.fitting_statement(&arguments),
            "LEADER" => self.leader_statement(&arguments),
            "ROTABL" | "ROTHED" | "ROTATE" => self.rotary_statement(&arguments),
            "LINTOL" | "MAXDPM" | "PIVOTZ" => self.rotary_rule(&arguments),
            "MACHIN" if std::mem::replace(&mut self.machine_named, true) => {
                self.find(PostFindingKind::Repeated { word: word.clone() });
            }
            other => match form::treatment(other) {
                Some(Treatment::Silent | Treatment::OnTape) => {}
                Some(Treatment::NotSupported) => {
                    self.find(PostFindingKind::NotSupported { word: word.clone() });
                }
                None => self.find(PostFindingKind::UnknownWord { word: word.clone() }),
            },
        }
    }

    /// Words that the machine definition gives a meaning: `WORD/first` before `WORD`.
    fn site_word(&mut self, arguments: &Arguments<'_>) -> bool {
        let machine = self.machine;
        let texts = texts(arguments.items);
        let first = texts.first().map(|first| format!("{}/{first}", arguments.word));
        let template = first
            .and_then(|key| machine.words.get(&key))
            .or_else(|| machine.words.get(arguments.word.as_str()));
        let Some(template) = template else { return false };
        self.control.template(template, &Values::default().text("text", texts.join(",")));
        true
    }

    /// DISPLY: ON and OFF switch the texts of PPRINT on the tape, other words are a text of their own.
    fn display_statement(&mut self, arguments: &Arguments<'_>) {
        // A date would make another tape every day, and a mill has neither lamps nor number displays.
        if let Some(unused) = ["AUTO", "LIGHT", "NIXIE"].into_iter().find(|word| arguments.has(word)) {
            let word = arguments.word.clone();
            return self.find(PostFindingKind::ArgumentNotUsed { word, argument: unused.into() });
        }
        let machine = self.machine;
        match arguments.items {
            [] => self.find(arguments.missing("ON, OFF or a text")),
            [ClWord::Word(switch)] if switch == "ON" || switch == "OFF" => {
                self.messages_off = switch == "OFF";
            }
            items => self.control.remark(&machine.templates.message, &texts(items).join(" ")),
        }
    }

    fn rapid_statement(&mut self, arguments: &Arguments<'_>) {
        if arguments.has("OFF") {
            (self.rapid, self.rapid_axis) = (None, None);
            return;
        }
        if let Some(place) = self.rapid.replace(self.control.place) {
            self.find_at(place, PostFindingKind::RapidUnused);
        }
        let stated = [
            ("XAXIS", LinearAxis::X),
            ("YAXIS", LinearAxis::Y),
            ("ZAXIS", LinearAxis::Z),
            ("TOOL", LinearAxis::Z),
        ];
        self.rapid_axis = stated.into_iter().find(|(word, _)| arguments.has(word)).map(|(_, axis)| axis);
    }

    /// Reports a feed in the unit that the program does not use.
    pub(super) fn check_unit(&mut self, word: &SmolStr, unit: LengthUnit) {
        let other = match unit {
            LengthUnit::Inch => self.program_units != Units::Inches,
            LengthUnit::Millimeter => self.program_units != Units::Millimeters,
            LengthUnit::Program => false,
        };
        if other {
            self.find(PostFindingKind::UnitMismatch { word: word.clone() });
        }
    }

    fn feed_statement(&mut self, arguments: &Arguments<'_>) {
        let stated = arguments.items.iter().find_map(|item| match item {
            ClWord::Word(word) => feed_unit(word).map(|unit| (word.clone(), unit)),
            ClWord::Number(_) => None,
        });
        let timed = arguments.has("AUTO");
        let off = arguments.has("OFF");
        let known =
            ["IPM", "MMPM", "PERMIN", "IPR", "MMPR", "PERREV", "INVERS", "AUTO", "OFF", "MAXIPM", "LENGTH"];
        if let Some(kind) = arguments.unknown(&known) {
            return self.find(kind);
        }
        if self.feed_point(arguments) {
            return;
        }
        let (mode, unit) = match &stated {
            Some((word, (mode, unit))) => {
                self.check_unit(word, *unit);
                (*mode, *unit)
            }
            None => (FeedMode::PerMinute, LengthUnit::Program),
        };
        let codes = &self.machine.codes;
        let lacking = match mode {
            FeedMode::PerMinute => None,
            FeedMode::PerRevolution => codes.feed_per_revolution.is_none().then_some("feed_per_revolution"),
            FeedMode::Inverse => codes.feed_inverse.is_none().then_some("feed_inverse"),
        };
        if let Some(name) = lacking {
            return self.find(PostFindingKind::NoCode { word: arguments.word.clone(), name: name.into() });
        }
        if off && form::bare_numbers(arguments).is_empty() && self.feed.is_some_and(Feed::is_time) {
            self.feed = self.feed_before_times;
            return;
        }
        // The number after MAXIPM is the greatest feed, not the feed.
        let stated_value = form::bare_numbers(arguments).first().copied();
        let value = match (stated_value, self.feed) {
            (Some(value), _) if mode == FeedMode::Inverse && !timed => value,
            (Some(value), _) => value * self.unit_factor(unit),
            // INVERS,AUTO and INVERS,OFF keep the rate.
            (None, Some(feed)) if mode == FeedMode::Inverse => feed.value,
            (None, _) => return self.find(arguments.missing("the feed rate")),
        };
        if !(value > 0.0 && value.is_finite()) {
            return self.find(PostFindingKind::FeedNotPositive { value });
        }
        let mode = if off { FeedMode::PerMinute } else { mode };
        if mode == FeedMode::PerRevolution && self.spindle.speed.is_none() {
            self.find(PostFindingKind::FeedPerRevolutionWithoutSpindle);
        }
        self.check_feed_range(mode, value, arguments.after("MAXIPM"));
        self.feed_reported = false;
        let feed = Feed { mode, value, timed: timed && mode == FeedMode::Inverse };
        if feed.is_time() && !self.feed.is_some_and(Feed::is_time) {
            self.feed_before_times = self.feed;
        }
        self.feed = Some(feed);
    }

    /// Compares the feed per minute, which per revolution depends on the spindle, with the range of the machine and the
    /// greatest feed that the statement allows, in inches per minute.
    fn check_feed_range(&mut self, mode: FeedMode, value: f64, most: Option<f64>) {
        let per_minute = match mode {
            FeedMode::PerMinute => value,
            FeedMode::PerRevolution => match self.spindle.speed {
                Some(speed) => value * speed,
                None => return,
            },
            FeedMode::Inverse => return,
        };
        let range = self.machine.limits.feed_mm.map(|range| range.map(|limit| self.tape_length(limit)));
        let [least, greatest] = range.unwrap_or([0.0, f64::INFINITY]);
        let greatest = most.map_or(greatest, |most| greatest.min(most * self.unit_factor(LengthUnit::Inch)));
        if !(least..=greatest).contains(&per_minute) {
            self.find(PostFindingKind::FeedOutOfRange { value: per_minute, least, greatest });
        }
    }

    fn delay_statement(&mut self, arguments: &Arguments<'_>) {
        let Some(value) = arguments.number() else { return self.find(arguments.missing("the time")) };
        let seconds = match (arguments.has("REV"), self.spindle.speed) {
            (false, _) => value,
            (true, Some(speed)) if self.spindle.on && speed > 0.0 => value / speed * SECONDS_PER_MINUTE,
            (true, _) => return self.find(PostFindingKind::NoSpindleSpeed),
        };
        if !(seconds >= 0.0 && seconds.is_finite()) {
            let word = arguments.word.clone();
            return self.find(PostFindingKind::BadValue { word, argument: "time".into(), value });
        }
        let greatest = self.longest_dwell();
        self.within(arguments.word, "time", seconds, 0.0, greatest);
        self.dwell_block(seconds.min(greatest));
    }

    /// The longest dwell that the register of the control takes, in seconds.
    fn longest_dwell(&self) -> f64 {
        let Some(register) = self.machine.registers.get("P") else { return f64::INFINITY };
        let greatest = 10.0_f64.powi(i32::from(register.left)) - 1.0;
        if self.machine.templates.dwell_in_milliseconds {
            greatest / MILLISECONDS_PER_SECOND
        } else {
            greatest
        }
    }

    /// LEADER/n, a length of blank tape.
    fn leader_statement(&mut self, arguments: &Arguments<'_>) {
        let Some(length) = arguments.number() else { return self.find(arguments.missing("the length")) };
        let greatest = self.tape_length(LONGEST_LEADER_INCHES * MILLIMETERS_PER_INCH);
        self.within(arguments.word, "length", length * self.scale, 0.0, greatest);
    }

    /// Whether a value is within its range; a finding when it is not.
    pub(super) fn within(
        &mut self,
        word: &SmolStr,
        argument: &str,
        value: f64,
        least: f64,
        greatest: f64,
    ) -> bool {
        let within = (least..=greatest).contains(&value);
        if !within {
            let (word, argument) = (word.clone(), argument.into());
            self.find(PostFindingKind::ArgumentOutOfRange { word, argument, value, least, greatest });
        }
        within
    }

    fn offset_statement(&mut self, arguments: &Arguments<'_>) {
        if self.tool.is_none() {
            self.find(PostFindingKind::OffsetWithoutTool { word: arguments.word.clone() });
        }
        if arguments.has("OFF") {
            return match self.machine.codes.length_offset_off.clone() {
                Some(code) => self.control.code(&code),
                None => self.find(PostFindingKind::NoCode {
                    word: arguments.word.clone(),
                    name: "length_offset_off".into(),
                }),
            };
        }
        if arguments.has("MINUS") {
            let word = arguments.word.clone();
            self.find(PostFindingKind::ArgumentNotUsed { word, argument: "MINUS".into() });
        }
        // ADJUST,ON takes up the offset that was there.
        let again = arguments.has("ON").then_some(f64::from(self.length_offset));
        let Some(number) = arguments.after("ADJUST").or_else(|| arguments.number()).or(again) else {
            return self.find(arguments.missing("the offset number"));
        };
        if !(number >= 0.0 && number.fract() == 0.0 && number <= f64::from(u16::MAX)) {
            let word = arguments.word.clone();
            return self.find(PostFindingKind::BadValue { word, argument: "offset".into(), value: number });
        }
        self.length_offset = number as u32;
        if self.approach.is_none() {
            let machine = self.machine;
            self.control.template(&machine.templates.length_offset, &Values::default().number("H", number));
        }
    }

    fn home(&mut self) {
        self.end_cycle();
        self.coolant_now();
        let machine = self.machine;
        self.follow_no_more(false);
        self.home_blocks(&machine.templates.home, Values::default());
        self.control.forget(&["X", "Y", "Z"]);
        self.position = None;
    }

    fn clearance_statement(&mut self, arguments: &Arguments<'_>) {
        if let Some(argument) =
            ["YZPLAN", "ZXPLAN", "TOOL", "AVOID"].into_iter().find(|word| arguments.has(word))
        {
            let word = arguments.word.clone();
            return self.find(PostFindingKind::UnknownArgument { word, argument: argument.into() });
        }
        let numbers: Vec<f64> = arguments.numbers().collect();
        let known = ["XYPLAN", "NORMAL"];
        if let Some(unknown) = arguments.unknown(&known).filter(|_| numbers.is_empty()) {
            return self.find(unknown);
        }
        let height = match numbers[..] {
            [height] => Some(height),
            // A plane's canonical form that is level; what stands behind it has been told of.
            [i, j, k, distance, ..] if i == 0.0 && j == 0.0 && k != 0.0 => Some(distance / k),
            _ => None,
        };
        match height {
            Some(height) => self.clearance = Some((height + self.shift.z) * self.scale),
            None => self.find(arguments.missing("a level plane")),
        }
    }

    /// RETRCT and GOCLER. Behind GOHOME and INSERT nobody knows where the tool is; the height alone says enough then.
    fn retract(&mut self, word: &SmolStr) {
        let Some(height) = self.clearance else {
            return self.find(PostFindingKind::NoClearance { word: word.clone() });
        };
        self.leave_cycle();
        self.retracted_from = self.position.map(|here| self.height(&here));
        match self.position.map(|here| self.drawn_to(here, height)) {
            Some(Some(place)) => self.rapid_to(place),
            Some(None) => self.find(PostFindingKind::ClearanceNotReached { word: word.clone() }),
            None => self.rapid_to_height(height),
        }
    }

    fn plunge(&mut self, arguments: &Arguments<'_>) {
        let (Some(height), Some(here)) = (self.retracted_from.take(), self.position) else {
            return self.find(PostFindingKind::NoRetract);
        };
        let target = self.at_height(&here, height);
        if let Some(value) = arguments.number() {
            self.feed = Some(Feed { mode: FeedMode::PerMinute, value: value * self.scale, timed: false });
            self.linear_to(target);
        } else {
            self.rapid_to(target);
        }
    }

    /// ORIGIN is subtracted, TRANS is added.
    fn shift_statement(&mut self, arguments: &Arguments<'_>, sign: f64) {
        let numbers: Vec<f64> = arguments.numbers().collect();
        match numbers[..] {
            [x, y] => self.shift = Vec3::new(x, y, 0.0) * sign,
            [x, y, z] => self.shift = Vec3::new(x, y, z) * sign,
            _ => self.find(arguments.missing("three coordinates")),
        }
    }

    fn sequence_statement(&mut self, arguments: &Arguments<'_>) {
        if self.machine.block.sequence.every_line {
            return self.find(PostFindingKind::NotSupported { word: arguments.word.clone() });
        }
        if arguments.has("ON") || arguments.has("OFF") {
            self.control.numbering.on = arguments.has("ON");
            return;
        }
        let numbers = form::bare_numbers(arguments);
        let Some(start) = numbers.first().copied() else {
            return self.find(arguments.missing("the number"));
        };
        let greatest = f64::from(self.machine.block.sequence.max);
        if self.within(arguments.word, "number", start, 0.0, greatest) {
            let numbering = &mut self.control.numbering;
            numbering.on = true;
            (numbering.next, numbering.count) = (start as u32, 0);
        }
        if let Some(step) = arguments.after("INCR")
            && self.within(arguments.word, "INCR", step, 0.0, greatest)
        {
            self.control.numbering.step = step as u32;
        }
        if let Some(every) = numbers.get(1).copied()
            && self.within(arguments.word, "blocks between numbers", every, 1.0, greatest)
        {
            self.control.numbering.every = every as u32;
        }
    }

    fn skip_statement(&mut self, arguments: &Arguments<'_>) {
        // A cycle must not begin or end in a block that may be skipped and go on where none is.
        self.leave_cycle();
        self.skipped |= self.control.skip.is_some();
        if self.work_offset == (WorkOffset::Written { optional: true }) {
            self.work_offset = WorkOffset::Due;
        }
        self.control.skip = (!arguments.has("OFF")).then(|| self.skip_level(arguments));
        // A skipped block must not have been the only one that carried a modal word.
        self.control.forget_all();
    }

    /// The level of OPSKIP/ON,n: the first if the control has not as many.
    fn skip_level(&mut self, arguments: &Arguments<'_>) -> u32 {
        let Some(level) = arguments.number() else { return FIRST_SKIP_LEVEL };
        let (least, greatest) = (f64::from(FIRST_SKIP_LEVEL), f64::from(LAST_SKIP_LEVEL));
        if !self.within(arguments.word, "level", level, least, greatest) {
            return FIRST_SKIP_LEVEL;
        }
        let (level, levels) = (level as u32, self.machine.block.skip_levels);
        if level > levels {
            self.find(PostFindingKind::SkipLevel { level, levels });
            return FIRST_SKIP_LEVEL;
        }
        level
    }

    /// AUXFUN and PREFUN: an M or G code as it stands.
    fn function(&mut self, arguments: &Arguments<'_>, letter: &str) {
        if letter == "G" && !self.machine.registers.contains_key(letter) {
            return self.find(PostFindingKind::NotSupported { word: arguments.word.clone() });
        }
        match arguments.number() {
            Some(number) if (0.0..=LARGEST_CODE).contains(&number) => {
                let tenths = (number * 10.0).round() / 10.0;
                let code = format!("{letter}{tenths}");
                self.note_work_offset(&code);
                self.check_function(arguments.word, &code);
                self.control.function(&code);
            }
            Some(value) => {
                let word = arguments.word.clone();
                self.find(PostFindingKind::BadValue { word, argument: "number".into(), value });
            }
            None => self.find(arguments.missing("the number")),
        }
    }

    /// Reports a code that the post-processor writes itself and thinks it knows the state of.
    fn check_function(&mut self, word: &SmolStr, code: &str) {
        let machine = self.machine;
        let group = machine.groups.iter().find(|(_, codes)| codes.iter().any(|known| known == code));
        if let Some((group, _)) = group {
            let (word, code, group) = (word.clone(), code.into(), group.into());
            return self.find(PostFindingKind::FunctionInGroup { word, code, group });
        }
        let codes = &machine.codes;
        let coolant = [&codes.coolant_mist, &codes.coolant_air, &codes.coolant_through];
        let coolant = coolant.into_iter().flatten().chain([&codes.coolant_flood, &codes.coolant_off]);
        let spindle = [&codes.spindle_clockwise, &codes.spindle_counterclockwise, &codes.spindle_off];
        let owned = spindle
            .into_iter()
            .chain(&codes.spindle_orient)
            .map(|text| ("SPINDL", text))
            .chain(coolant.map(|text| ("COOLNT", text)))
            .chain([("STOP", &codes.stop), ("OPSTOP", &codes.optional_stop)])
            .chain(machine.templates.tool_change.iter().map(|text| ("LOADTL", text)))
            .chain(machine.templates.program_end.iter().map(|text| ("END", text)));
        let owner = owned.into_iter().find(|(_, text)| text.split_whitespace().any(|token| token == code));
        if let Some((owner, _)) = owner {
            let (word, code) = (word.clone(), code.into());
            self.find(PostFindingKind::FunctionOfWord { word, code, owner: owner.into() });
        }
    }

    /// ARCSLP/LINCIR,ON and SET/LINCIR, SET/LINEAR.
    fn fitting_statement(&mut self, arguments: &Arguments<'_>) {
        if arguments.has("LINCIR") {
            self.fit_points = !arguments.has("OFF");
        } else if arguments.has("LINEAR") {
            self.fit_points = false;
        } else {
            self.find(PostFindingKind::NotSupported { word: arguments.word.clone() });
        }
    }
}

/// Arguments as they are written.
fn texts(items: &[ClWord]) -> Vec<String> {
    let text = |item: &ClWord| match item {
        ClWord::Number(number) => number.to_string(),
        ClWord::Word(word) => word.to_string(),
    };
    items.iter().map(text).collect()
}

//! ROTABL, ROTHED and ROTATE: rotary axes that a program turns itself.

use apt_cldata::record::ClWord;
use smol_str::SmolStr;

use super::Engine;
use crate::{finding::PostFindingKind, form, kinematics::Carried, machine::ROTARY_NAMES, words::Arguments};

/// The words of the axes, in the order of their names.
const AXIS_WORDS: [&str; 3] = ["AAXIS", "BAXIS", "CAXIS"];
/// Minor words that are read, and those that say what is so anyway.
const KNOWN: [&str; 12] =
    ["AAXIS", "BAXIS", "CAXIS", "AXIS", "ATANGL", "INCR", "CLW", "CCLW", "ROTREF", "SAME", "NOW", "SHORT"];
const FULL_TURN: f64 = 360.0;

impl Engine<'_> {
    /// The statement: `ATANGL,a` is the angle to which an axis is turned, with INCR by which, as is a number alone. Behind it the coordinates of the
    /// program are those of the machine as it stands then; with ROTREF they turn with the table. Positions that state no axis keep the angle.
    pub(super) fn rotary_statement(&mut self, arguments: &Arguments<'_>) {
        let word = arguments.word.clone();
        let Some(which) = self.rotary_axis(arguments) else {
            return self.find(PostFindingKind::NoRotaryAxis { word });
        };
        if let Some(unknown) = arguments.unknown(&KNOWN) {
            return self.find(unknown);
        }
        let stated = arguments.after("ATANGL");
        let alone = form::bare_numbers(arguments).last().copied();
        let Some(value) = stated.or(alone).filter(|value| value.is_finite()) else {
            return self.find(arguments.missing("the angle"));
        };
        let Some(turning) = &self.turning else { return };
        let here = turning.angles[which];
        let step = stated.is_none() || arguments.has("INCR");
        let angle = match (step, arguments.has("CLW"), arguments.has("CCLW")) {
            (true, true, _) => here - value,
            (true, false, _) => here + value,
            (false, true, _) => here - (here - value).rem_euclid(FULL_TURN),
            (false, false, true) => here + (value - here).rem_euclid(FULL_TURN),
            (false, false, false) if arguments.has("SHORT") => {
                value + FULL_TURN * ((here - value) / FULL_TURN).round()
            }
            (false, false, false) => value,
        };
        let [least, greatest] = turning.kinematics.axes[which].limits;
        let mut angles = turning.angles;
        angles[which] = angle;
        if !self.within(arguments.word, "angle", angle, least, greatest) {
            return;
        }
        self.leave_cycle();
        self.follow_no_more(true);
        let angles = self.rounded_angles(angles);
        let with_table = arguments.has("ROTREF");
        let slides = self.turning.as_mut().is_some_and(|turning| {
            turning.hold(angles, with_table);
            turning.kinematics.slides
        });
        // The slides stay; where the tool end is then, a control that follows it knows, and the tape does not.
        self.position = self.position.filter(|_| slides);
        self.turn_now();
    }

    /// LINTOL, how far the tool end may leave its way; MAXDPM, how fast axes turn; PIVOTZ, how far they are from the nose of the spindle.
    pub(super) fn rotary_rule(&mut self, arguments: &Arguments<'_>) {
        let word = arguments.word.clone();
        let Some(turning) = &mut self.turning else {
            return self.find(PostFindingKind::NotSupported { word });
        };
        let unit = turning.unit;
        match (word.as_str(), arguments.number()) {
            ("LINTOL", None) if arguments.has("OFF") => turning.tolerance = f64::INFINITY,
            ("LINTOL", None) if arguments.has("ON") => turning.tolerance = turning.rules.tolerance_mm * unit,
            (_, None) => self.find(arguments.missing("the number")),
            (_, Some(value)) if !(value > 0.0 && value.is_finite()) => {
                self.find(PostFindingKind::BadValue { word, argument: "number".into(), value });
            }
            ("LINTOL", Some(tolerance)) => turning.tolerance = tolerance * self.scale,
            ("MAXDPM", Some(most)) => turning.most = turning.most.map(|own| own.min(most)),
            (_, Some(pivot)) => turning.set_pivot(pivot * self.scale),
        }
    }

    /// FEDRAT with LENGTH: how far up the tool the feed counts where axes turn. Whether the statement says nothing else.
    pub(super) fn feed_point(&mut self, arguments: &Arguments<'_>) -> bool {
        if !arguments.has("LENGTH") {
            return false;
        }
        let word = arguments.word.clone();
        match (&mut self.turning, arguments.after("LENGTH")) {
            (_, None) => self.find(arguments.missing("the length")),
            (_, Some(value)) if !(value >= 0.0 && value.is_finite()) => {
                self.find(PostFindingKind::BadValue { word, argument: "LENGTH".into(), value });
            }
            (None, _) => self.find(PostFindingKind::ArgumentNotUsed { word, argument: "LENGTH".into() }),
            (Some(turning), Some(length)) => turning.feed_point = length * self.scale,
        }
        form::bare_numbers(arguments).is_empty()
    }

    /// Index in the chain of the axis that a statement means: the one that it names, or the only one of the table (ROTABL) or the head (ROTHED).
    fn rotary_axis(&self, arguments: &Arguments<'_>) -> Option<usize> {
        let turning = self.turning.as_ref()?;
        let letter = |name: &str| AXIS_WORDS.iter().position(|word| *word == name);
        let named = arguments.items.iter().find_map(|item| match item {
            ClWord::Word(word) => letter(word.as_str()),
            ClWord::Number(_) => None,
        });
        let numbered = arguments.after("AXIS").and_then(|number| match number {
            1.0 => Some(0),
            2.0 => Some(1),
            3.0 => Some(2),
            _ => None,
        });
        let by_name =
            |name: SmolStr| turning.names.iter().position(|known| known.is_some_and(|known| known == name));
        if let Some(index) = named.or(numbered) {
            return by_name(ROTARY_NAMES[index].into());
        }
        let carried = if arguments.word == "ROTHED" { Carried::Head } else { Carried::Table };
        let mut meant = (0..2).filter(|index| {
            turning.names[*index].is_some() && turning.kinematics.axes[*index].carried == carried
        });
        match (meant.next(), meant.next()) {
            (Some(index), None) => Some(index),
            _ => None,
        }
    }
}

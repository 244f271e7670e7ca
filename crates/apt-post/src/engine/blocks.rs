//! Blocks of motion: codes and words in the order of the machine, or by its templates.

use super::Engine;
use crate::control::{Values, Word};

/// What a block of motion makes.
pub(super) enum Shape<'c> {
    /// A straight move at feed rate.
    Linear,
    /// An arc, by the codes of its plane and its sense.
    Arc { plane: &'c str, turn: &'c str },
}

impl Engine<'_> {
    /// A rapid block, with codes before its own.
    pub(super) fn rapid_block(&mut self, before: &[String], words: &[Word]) {
        let machine = self.machine;
        if machine.templates.rapid.is_empty() {
            self.control.motion(before, &[&machine.codes.rapid], words);
        } else {
            let values = self.motion_values(words, String::new());
            self.control.motion_template(&machine.templates.rapid, &values);
        }
    }

    /// A cutting block, with codes before its own; a new feed mode makes the control forget its feed rate.
    pub(super) fn cut(
        &mut self,
        before: &[String],
        feed_code: Option<String>,
        shape: &Shape<'_>,
        words: &[Word],
    ) {
        let machine = self.machine;
        let (template, codes) = match shape {
            Shape::Linear => (&machine.templates.linear, ("", "")),
            Shape::Arc { plane, turn } => (&machine.templates.arc, (*plane, *turn)),
        };
        if !template.is_empty() {
            return self.cut_by(template, feed_code, codes, words);
        }
        let mode = feed_code.filter(|code| self.feed_mode(code));
        let before: Vec<String> = before.iter().cloned().chain(mode).collect();
        match shape {
            Shape::Linear => self.control.motion(&before, &[&machine.codes.linear], words),
            Shape::Arc { plane, turn } => self.control.motion(&before, &[plane, turn], words),
        };
    }

    /// A cutting block by a template, with the codes of the plane and the sense of an arc.
    pub(super) fn cut_by(
        &mut self,
        template: &str,
        feed_code: Option<String>,
        (plane, turn): (&str, &str),
        words: &[Word],
    ) {
        let mode = feed_code.filter(|code| self.feed_mode(code));
        let plane = self.control.set_mode(plane).then(|| plane.to_owned());
        let codes: Vec<String> = mode.into_iter().chain(plane).collect();
        let values = self.motion_values(words, codes.join(" ")).text("turn", turn);
        self.control.motion_template(template, &values);
    }

    /// What the template of a block of motion has to say.
    fn motion_values(&self, words: &[Word], codes: String) -> Values {
        let values = Values::default().words(words).text("compensation", self.compensation_code.clone());
        values.text("codes", codes)
    }

    /// The codes of a compensation that waits, which are in force from now on.
    pub(super) fn compensation_codes(&mut self) -> Option<Vec<String>> {
        let pending = self.compensation.take()?;
        self.compensation_code = pending.words.join(" ");
        Some(pending.words)
    }
}

//! CHKSRF, AVCTRL and PRINT/AVPRT: what is checked, and how the tool gets out of an interference (sculptured surfaces
//! reference 1.6, 1.8 and 1.9).

use apt_geometry::{
    motion::NamedSurface,
    regional::{AvoidanceControl, LiftDirection, TiltControl},
};
use apt_syntax::statement::Argument;
use smol_str::SmolStr;

use super::{
    number,
    reader::{Read, Reader},
};
use crate::{
    evaluator::Evaluator,
    finding::{Expected, FindingKind, SculpturedFinding},
    statements::Major,
};

/// The greatest lift below this counts as none, in program units (sculptured surfaces reference 1.8).
const LEAST_LIMIT: f64 = 1e-6;

/// The surfaces that CHKSRF names.
enum Checked {
    Part,
    Named(NamedSurface),
}

/// What AVCTRL says.
enum Control {
    Switch(bool),
    Avoid(AvoidanceControl),
}

impl Evaluator<'_> {
    /// CHKSRF/{PS|ssurf},{ON|OFF}.
    pub(crate) fn checked_surface(&mut self, major: Major<'_>) {
        // The number of the operands is looked at first, so that a list with unknown names is one mistake.
        if major.arguments.len() != 2 {
            let reader = Reader::new(&[], major.range).numbered(number::CHECK_FORM);
            let misfit = reader.misfit(Expected::CheckedAndSwitch);
            return self.misfit(major, misfit);
        }
        let Some(items) = self.regional_operands(major, number::CHECK_FORM) else { return };
        let mut reader = Reader::new(&items, major.range).numbered(number::CHECK_FORM);
        let (checked, on) = match checked(&mut reader) {
            Ok(read) => read,
            Err(misfit) => return self.misfit(major, misfit),
        };
        let state = &mut self.regional_mut().checked;
        match checked {
            Checked::Part => state.part = on,
            Checked::Named(surface) => {
                state.named.retain(|known| known.name != surface.name || known.name.is_empty());
                if on {
                    state.named.push(surface);
                }
            }
        }
    }

    /// AVCTRL.
    pub(crate) fn avoidance_control(&mut self, major: Major<'_>) {
        let Some(items) = self.regional_operands(major, number::NO_FORM) else { return };
        let control = match control(&mut Reader::new(&items, major.range)) {
            Ok(control) => control,
            Err(misfit) => return self.misfit(major, misfit),
        };
        let lifts = items.iter().any(|item| matches!(item.word(), Some("NORMPS" | "AXIS")));
        if lifts && matches!(control, Control::Avoid(AvoidanceControl { limit: None, .. })) {
            self.report(FindingKind::Sculptured(SculpturedFinding::LiftWithoutLimit), major.range);
        }
        let state = &mut self.regional_mut().avoidance;
        match control {
            // What was given before stays as it is.
            Control::Switch(on) => state.enabled = on,
            Control::Avoid(avoidance) => *state = avoidance,
        }
    }

    /// GOUGCK/{ON|OFF}: the same switch for Section 2 and for regional milling.
    pub(crate) fn gouge_check(&mut self, major: Major<'_>) {
        if let [Argument::Word(switch)] = major.arguments
            && matches!(switch.word.spelling, "ON" | "OFF")
        {
            self.regional_mut().check_chords = switch.word.spelling == "ON";
        }
        self.path_control(major);
    }

    /// PRINT/AVPRT,{ON|OFF}, and its older spelling AVMSG; whether it was one of them.
    pub(in crate::statements) fn print_avoidance(&mut self, major: Major<'_>) -> bool {
        let [Argument::Word(word), Argument::Word(switch)] = major.arguments else { return false };
        let on = match switch.word.spelling {
            "ON" => true,
            "OFF" => false,
            _ => return false,
        };
        match word.word.spelling {
            "AVPRT" => {}
            "AVMSG" => {
                let (word_text, present) = (SmolStr::new_static("AVMSG"), SmolStr::new_static("AVPRT"));
                let finding =
                    FindingKind::Sculptured(SculpturedFinding::OlderSpelling { word: word_text, present });
                self.report_apt4(finding, number::PRINT_WORD, word.range);
            }
            _ => return false,
        }
        self.regional_mut().list_avoidance = on;
        true
    }
}

/// `{PS|ssurf},{ON|OFF}`.
fn checked(reader: &mut Reader<'_>) -> Read<(Checked, bool)> {
    let checked = if reader.eat("PS") {
        Checked::Part
    } else if reader.peek_word().is_some() {
        return Err(reader.misfit(Expected::CheckedAndSwitch));
    } else {
        Checked::Named(reader.surface()?)
    };
    let on = reader.word(&["ON", "OFF"])? == "ON";
    reader.end()?;
    Ok((checked, on))
}

/// `{ON|OFF}`, `CUTANG,CONST,g,RANGE,b1,b2[,{NORMPS|AXIS}[,LIMIT,dmax]]`, `{NORMPS|AXIS}[,LIMIT,dmax]`.
fn control(reader: &mut Reader<'_>) -> Read<Control> {
    if let Some(word @ ("ON" | "OFF")) = reader.peek_word() {
        reader.skip();
        reader.end()?;
        return Ok(Control::Switch(word == "ON"));
    }
    let tilt = if reader.eat("CUTANG") { Some(tilt(reader)?) } else { None };
    let lift = match (reader.peek_word(), tilt) {
        (Some(word @ ("NORMPS" | "AXIS")), _) => {
            reader.skip();
            Some(if word == "AXIS" { LiftDirection::Axis } else { LiftDirection::PartNormal })
        }
        (_, Some(_)) => None,
        (Some("LIMIT"), None) => return Err(reader.clone().numbered(number::SURPLUS).misfit(LIFT)),
        (_, None) => return Err(reader.misfit(LIFT)),
    };
    let limit = match lift {
        Some(_) if reader.eat("LIMIT") => {
            Some(reader.not_negative(None)?).filter(|limit| *limit >= LEAST_LIMIT)
        }
        _ => None,
    };
    reader.end()?;
    Ok(Control::Avoid(AvoidanceControl { enabled: true, tilt, lift: lift.unwrap_or_default(), limit }))
}

/// What AVCTRL begins with.
const LIFT: Expected = Expected::Words(&["ON", "OFF", "CUTANG", "NORMPS", "AXIS"]);

/// `CONST,g,RANGE,b1,b2`, in degrees.
fn tilt(reader: &mut Reader<'_>) -> Read<TiltControl> {
    reader.word(&["CONST"])?;
    let constant = reader.not_negative(None)?;
    reader.word(&["RANGE"])?;
    let (least, greatest) = reader.range(None)?;
    Ok(TiltControl {
        constant: constant.to_radians(),
        least: least.to_radians(),
        greatest: greatest.to_radians(),
    })
}

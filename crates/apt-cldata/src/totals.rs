//! Sums over a path: positions, lengths, time and extent.

use apt_geometry::{Vec3, patience::Patience};
use serde::{Deserialize, Serialize};

use crate::record::{ClKind, ClRecord, ClWord, Units};

/// Millimetres in an inch.
pub const MILLIMETERS_PER_INCH: f64 = 25.4;

/// What a path amounts to. Lengths are in the program's unit and run along the cut vectors.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Tool positions, FROM included.
    pub points: usize,
    /// Whole length, `cut_length + rapid_length`.
    pub length: f64,
    /// Length at feed rate.
    pub cut_length: f64,
    /// Length at rapid.
    pub rapid_length: f64,
    /// Minutes of cutting and of DELAY, without rapid moves (their rate belongs to a machine); `None` when something
    /// was cut without a known feed rate.
    pub time_minutes: Option<f64>,
    /// Least and greatest coordinates; `None` without positions.
    pub bounds: Option<[Vec3; 2]>,
}

/// Sums up a list of CL records.
pub fn totals(records: &[ClRecord]) -> Totals {
    sum(records, |_| true, Patience::default()).told()
}

/// Sums up those of a list of CL records that are counted. The others only set the scene: where the tool comes from, how
/// fast it feeds, and in which unit. `None` when who waits has given up before the end.
pub fn totals_where(
    records: &[ClRecord],
    is_counted: impl FnMut(&ClRecord) -> bool,
    patience: Patience<'_>,
) -> Option<Totals> {
    let sum = sum(records, is_counted, patience);
    (!patience.was_over()).then(|| sum.told())
}

/// The sum of the records up to the end, or to where who waits gives up.
fn sum(records: &[ClRecord], mut is_counted: impl FnMut(&ClRecord) -> bool, patience: Patience<'_>) -> Sum {
    let mut sum = Sum { time: Some(0.0), ..Sum::default() };
    for record in records {
        if patience.ends_after(1) {
            break;
        }
        sum.counts = is_counted(record);
        sum.record(&record.kind);
    }
    sum
}

/// How fast the tool feeds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Feed {
    PerMinute(f64),
    PerRevolution(f64),
    /// Moves per minute.
    Inverse(f64),
}

#[derive(Default)]
struct Sum {
    /// Whether the record at hand is counted.
    counts: bool,
    points: usize,
    cut_length: f64,
    rapid_length: f64,
    time: Option<f64>,
    bounds: Option<[Vec3; 2]>,
    position: Option<Vec3>,
    rapid: bool,
    feed: Option<Feed>,
    revolutions: Option<f64>,
    units: Option<Units>,
}

impl Sum {
    fn told(&self) -> Totals {
        Totals {
            points: self.points,
            length: self.cut_length + self.rapid_length,
            cut_length: self.cut_length,
            rapid_length: self.rapid_length,
            time_minutes: self.time,
            bounds: self.bounds,
        }
    }

    fn record(&mut self, kind: &ClKind) {
        match kind {
            ClKind::Units(units) => self.units = Some(*units),
            ClKind::Motion { from, points, .. } => {
                for point in points {
                    self.point(point.position, *from);
                }
                self.rapid &= *from;
            }
            ClKind::Postprocessor { word, arguments, .. } => self.word(word, arguments),
            _ => {}
        }
    }

    fn point(&mut self, position: Vec3, from: bool) {
        let start = self.position.replace(position);
        if !self.counts {
            return;
        }
        self.points += 1;
        let bounds = self.bounds.get_or_insert([position, position]);
        *bounds = [bounds[0].inf(&position), bounds[1].sup(&position)];
        let (Some(start), false) = (start, from) else { return };
        let length = (position - start).norm();
        if self.rapid {
            self.rapid_length += length;
            return;
        }
        self.cut_length += length;
        let minutes = if length > 0.0 { self.cut_minutes(length) } else { Some(0.0) };
        self.time = self.time.zip(minutes).map(|(sum, more)| sum + more);
    }

    fn cut_minutes(&self, length: f64) -> Option<f64> {
        let rate = match self.feed? {
            Feed::PerMinute(rate) => rate,
            Feed::PerRevolution(rate) => rate * self.revolutions?,
            Feed::Inverse(rate) => rate * length,
        };
        (rate > 0.0).then(|| length / rate)
    }

    fn word(&mut self, word: &str, arguments: &[ClWord]) {
        let number = arguments.iter().find_map(|argument| match argument {
            ClWord::Number(number) => Some(*number),
            ClWord::Word(_) => None,
        });
        let has = |wanted: &str| matches_word(arguments, wanted);
        match word {
            "RAPID" => self.rapid = !has("OFF"),
            "FEDRAT" => {
                if let Some(number) = number {
                    self.feed = Some(self.feed_of(number, &has));
                }
            }
            "SPINDL" if !has("SFM") && !has("SMM") && !has("MAXRPM") => {
                self.revolutions = number.or(self.revolutions);
            }
            "DELAY" | "DWELL" if self.counts => {
                let minutes = match number {
                    Some(turns) if has("REV") => self.revolutions.map(|rate| turns / rate),
                    Some(seconds) => Some(seconds / SECONDS_PER_MINUTE),
                    None => Some(0.0),
                };
                self.time = self.time.zip(minutes).map(|(sum, more)| sum + more);
            }
            _ => {}
        }
    }

    fn feed_of(&self, number: f64, has: &impl Fn(&str) -> bool) -> Feed {
        let metric = has("MMPM") || has("MMPR");
        let inch = has("IPM") || has("IPR");
        let factor = match self.units {
            Some(Units::Inches) if metric => MILLIMETERS_PER_INCH.recip(),
            Some(Units::Millimeters) if inch => MILLIMETERS_PER_INCH,
            _ => 1.0,
        };
        if has("INVERS") {
            Feed::Inverse(number)
        } else if has("IPR") || has("MMPR") || has("PERREV") {
            Feed::PerRevolution(number * factor)
        } else {
            Feed::PerMinute(number * factor)
        }
    }
}

/// Seconds in a minute.
const SECONDS_PER_MINUTE: f64 = 60.0;

fn matches_word(arguments: &[ClWord], wanted: &str) -> bool {
    arguments.iter().any(|argument| matches!(argument, ClWord::Word(word) if word == wanted))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::read_text;

    fn totals_of(text: &str) -> Totals {
        let (records, errors) = read_text(text);
        assert_eq!(errors, vec![]);
        totals(&records)
    }

    #[test]
    fn rapid_is_one_shot_and_feed_makes_time() {
        let sum = totals_of("FROM/0,0,0\nRAPID\nGOTO/3,4,0\nFEDRAT/20,IPM\nGOTO/3,4,-10\nDELAY/30\nFINI\n");
        assert_eq!(sum.points, 3);
        assert_eq!((sum.rapid_length, sum.cut_length, sum.length), (5.0, 10.0, 15.0));
        assert_eq!(sum.time_minutes, Some(1.0));
        assert_eq!(sum.bounds, Some([Vec3::new(0.0, 0.0, -10.0), Vec3::new(3.0, 4.0, 0.0)]));
    }

    #[test]
    fn no_feed_no_time() {
        assert_eq!(totals_of("FROM/0,0,0\nGOTO/1,0,0\n").time_minutes, None);
        assert_eq!(totals_of("FROM/0,0,0\nRAPID\nGOTO/1,0,0\n").time_minutes, Some(0.0));
    }

    #[test]
    fn units_and_modes_of_feed() {
        let inch = totals_of("UNITS/INCHES\nFROM/0,0,0\nFEDRAT/254,MMPM\nGOTO/10,0,0\n");
        assert!((inch.time_minutes.unwrap() - 1.0).abs() < 1e-12);
        let turn = totals_of("FROM/0,0,0\nSPINDL/100,CLW\nFEDRAT/.1,IPR\nGOTO/10,0,0\n");
        assert!((turn.time_minutes.unwrap() - 1.0).abs() < 1e-12);
        let inverse = totals_of("FROM/0,0,0\nFEDRAT/INVERS,4\nGOTO/10,0,0\n");
        assert!((inverse.time_minutes.unwrap() - 0.25).abs() < 1e-12);
    }
}

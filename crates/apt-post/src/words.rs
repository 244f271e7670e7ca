//! Reading the arguments of post-processor words: keywords may stand in any order.

use std::{iter::Peekable, slice};

use apt_cldata::{geometry::chamfer_depth, record::ClWord};
use smol_str::SmolStr;

use crate::finding::PostFindingKind;

/// The arguments of one statement.
pub(crate) struct Arguments<'a> {
    pub(crate) word: &'a SmolStr,
    pub(crate) items: &'a [ClWord],
}

impl Arguments<'_> {
    pub(crate) fn has(&self, wanted: &str) -> bool {
        self.items.iter().any(|item| matches!(item, ClWord::Word(word) if word == wanted))
    }

    /// The first number, wherever it stands.
    pub(crate) fn number(&self) -> Option<f64> {
        self.numbers().next()
    }

    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        self.items.iter().filter_map(|item| match item {
            ClWord::Number(number) => Some(*number),
            ClWord::Word(_) => None,
        })
    }

    /// The number right after a keyword; of a keyword that stands twice after the last.
    pub(crate) fn after(&self, wanted: &str) -> Option<f64> {
        let at = self.items.iter().rposition(|item| matches!(item, ClWord::Word(word) if word == wanted))?;
        match self.items.get(at + 1) {
            Some(ClWord::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// The keywords that are not among those known.
    pub(crate) fn unknown(&self, known: &[&str]) -> Option<PostFindingKind> {
        self.items.iter().find_map(|item| match item {
            ClWord::Word(argument) if !argument.is_empty() && !known.contains(&argument.as_str()) => {
                Some(PostFindingKind::UnknownArgument { word: self.word.clone(), argument: argument.clone() })
            }
            _ => None,
        })
    }

    pub(crate) fn missing(&self, missing: &str) -> PostFindingKind {
        PostFindingKind::MissingArgument { word: self.word.clone(), missing: missing.into() }
    }
}

/// What a feed rate counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FeedMode {
    PerMinute,
    PerRevolution,
    Inverse,
}

/// Unit in which a length is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LengthUnit {
    Program,
    Inch,
    Millimeter,
}

/// A unit word of FEDRAT and CYCLE.
pub(crate) fn feed_unit(word: &str) -> Option<(FeedMode, LengthUnit)> {
    Some(match word {
        "IPM" => (FeedMode::PerMinute, LengthUnit::Inch),
        "MMPM" => (FeedMode::PerMinute, LengthUnit::Millimeter),
        "PERMIN" => (FeedMode::PerMinute, LengthUnit::Program),
        "IPR" => (FeedMode::PerRevolution, LengthUnit::Inch),
        "MMPR" => (FeedMode::PerRevolution, LengthUnit::Millimeter),
        "PERREV" => (FeedMode::PerRevolution, LengthUnit::Program),
        "INVERS" => (FeedMode::Inverse, LengthUnit::Program),
        _ => return None,
    })
}

/// Types of cycle that the language has. Which of them a machine makes, its definition says.
const CYCLES: [&str; 22] = [
    "AUTO", "AVOID", "BORE", "BORE7", "BORE8", "BORE9", "BRKCHP", "CBORE", "CIRCUL", "CSINK", "DEEP",
    "DRILL", "FACE", "MILL", "REAM", "REVERS", "ROUGH", "SHIFT", "TAP", "THREAD", "THRU", "TURN",
];

/// What is wrong with a type of cycle that a machine does not make: there is no such type, or no code for it.
pub(crate) fn cycle_not_made(arguments: &Arguments<'_>, kind: &SmolStr) -> PostFindingKind {
    if CYCLES.contains(&kind.as_str()) {
        return PostFindingKind::CycleHasNoCode { cycle: kind.clone() };
    }
    PostFindingKind::UnknownArgument { word: arguments.word.clone(), argument: kind.clone() }
}

/// A feed in a CYCLE.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum CycleFeed {
    Rate(f64, FeedMode, LengthUnit),
    ThreadsPerInch(f64),
}

impl CycleFeed {
    /// Whether it tells how far the tool goes in a turn of the spindle.
    pub(crate) fn is_per_turn(self) -> bool {
        matches!(self, CycleFeed::ThreadsPerInch(_) | CycleFeed::Rate(_, FeedMode::PerRevolution, _))
    }
}

/// Where the tool goes between holes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Retract {
    /// To where it stood before the cycle.
    Initial,
    /// This far above the hole.
    Above(f64),
}

/// What a CYCLE statement says. Lengths in program units, down to the bottom positive.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct CycleOrder {
    pub(crate) kind: SmolStr,
    pub(crate) depth: Option<f64>,
    pub(crate) clearance: Option<f64>,
    pub(crate) retract: Retract,
    pub(crate) feed: Option<CycleFeed>,
    pub(crate) step: Option<f64>,
    /// Seconds, or revolutions when the second field is true.
    pub(crate) dwell: Option<(f64, bool)>,
    /// How far the tool steps aside at the bottom: the amount, or its parts along X and Y.
    pub(crate) shift: Option<(f64, Option<f64>)>,
    /// Where the spindle stops for it, in degrees.
    pub(crate) orientation: Option<f64>,
    /// How often each hole is made.
    pub(crate) times: Option<f64>,
}

/// Reads `CYCLE/type, ...` with couples in any order, and with the bare numbers of the CAM systems: depth, feed if the
/// unit follows it, clearance.
pub(crate) fn cycle_order(arguments: &Arguments<'_>) -> Result<CycleOrder, PostFindingKind> {
    let Some((ClWord::Word(kind), rest)) = arguments.items.split_first() else {
        return Err(arguments.missing("the kind of cycle"));
    };
    let mut order = CycleOrder::new(kind);
    let mut bare: Vec<f64> = Vec::new();
    let mut items: CycleItems<'_> = rest.iter().peekable();
    while let Some(item) = items.next() {
        let word = match item {
            ClWord::Number(number) => {
                bare.push(*number);
                continue;
            }
            ClWord::Word(word) => word,
        };
        if let Some((mode, unit)) = feed_unit(word) {
            // `depth, feed, UNIT` or `UNIT, feed`.
            let value = match bare.len() {
                2.. => bare.remove(1),
                _ => next_number(&mut items).ok_or_else(|| arguments.missing(word))?,
            };
            order.feed = Some(CycleFeed::Rate(value, mode, unit));
            continue;
        }
        match word.as_str() {
            "RTRCTO" | "RETURN" | "RETRCT" => {
                if let Some(number) = next_number(&mut items) {
                    order.retract = Retract::Above(number);
                }
            }
            "AUTO" | "ON" | "" => {}
            "REV" => {
                if let Some((_, revolutions)) = &mut order.dwell {
                    *revolutions = true;
                }
            }
            _ => order.couple(arguments, word, &mut items)?,
        }
    }
    let mut bare = bare.into_iter();
    if order.depth.is_none() {
        order.depth = bare.next();
    }
    if order.clearance.is_none() {
        order.clearance = bare.next();
    }
    Ok(order)
}

/// What is still to be read of a CYCLE.
type CycleItems<'a> = Peekable<slice::Iter<'a, ClWord>>;

/// The number that comes next, if one does.
fn next_number(items: &mut CycleItems<'_>) -> Option<f64> {
    let item = items.next_if(|item| matches!(item, ClWord::Number(_)))?;
    match item {
        ClWord::Number(number) => Some(*number),
        ClWord::Word(_) => None,
    }
}

impl CycleOrder {
    /// A cycle of which nothing but the kind is known.
    fn new(kind: &SmolStr) -> Self {
        Self {
            kind: kind.clone(),
            depth: None,
            clearance: None,
            retract: Retract::Initial,
            feed: None,
            step: None,
            dwell: None,
            shift: None,
            orientation: None,
            times: None,
        }
    }

    /// Takes a word with the numbers that belong to it.
    fn couple(
        &mut self,
        arguments: &Arguments<'_>,
        word: &SmolStr,
        items: &mut CycleItems<'_>,
    ) -> Result<(), PostFindingKind> {
        let number = |items: &mut CycleItems<'_>| next_number(items).ok_or_else(|| arguments.missing(word));
        match word.as_str() {
            "DEPTH" => self.depth = Some(number(items)?),
            // NX gives a signed offset, the others a depth.
            "FEDTO" => {
                let depth = number(items)?.abs();
                self.depth = Some(match next_number(items) {
                    None => depth,
                    Some(angle) => chamfer_depth(depth, angle).ok_or_else(|| PostFindingKind::BadValue {
                        word: arguments.word.clone(),
                        argument: "angle".into(),
                        value: angle,
                    })?,
                });
            }
            "RAPTO" | "CLEAR" => self.clearance = Some(number(items)?),
            "STEP" | "INCR" => self.step = Some(number(items)?),
            "DWELL" => self.dwell = Some((number(items)?, false)),
            "TPI" => self.feed = Some(CycleFeed::ThreadsPerInch(number(items)?)),
            "OFFSET" => self.shift = Some((number(items)?, next_number(items))),
            "ORIENT" => self.orientation = Some(number(items)?),
            "TIMES" | "REPEAT" => self.times = Some(number(items)?),
            _ => {
                return Err(PostFindingKind::UnknownArgument {
                    word: arguments.word.clone(),
                    argument: word.clone(),
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn order(items: &[&str]) -> Result<CycleOrder, PostFindingKind> {
        let items: Vec<ClWord> = items
            .iter()
            .map(|item| item.parse().map_or_else(|_| ClWord::Word((*item).into()), ClWord::Number))
            .collect();
        cycle_order(&Arguments { word: &"CYCLE".into(), items: &items })
    }

    #[test]
    fn five_spellings_of_one_hole() {
        let spellings: [&[&str]; 5] = [
            &["DRILL", "10.", "200.", "MMPM", "2."],
            &["DRILL", "RAPTO", "2.", "FEDTO", "-10.", "RTRCTO", "AUTO", "MMPM", "200."],
            &["DRILL", "DEPTH", "10.", "MMPM", "200.", "CLEAR", "2."],
            &["DRILL", "FEDTO", "10.", "MMPM", "200.", "RAPTO", "2."],
            &["DRILL", "10.", "MMPM", "200.", "2."],
        ];
        for items in spellings {
            let order = order(items).unwrap();
            assert_eq!((order.depth, order.clearance), (Some(10.0), Some(2.0)), "{items:?}");
            assert_eq!(order.feed, Some(CycleFeed::Rate(200.0, FeedMode::PerMinute, LengthUnit::Millimeter)));
            assert_eq!(order.retract, Retract::Initial);
        }
    }

    #[test]
    fn other_couples_and_mistakes() {
        let deep =
            order(&["DEEP", "DEPTH", "1.25", "STEP", ".25", "IPM", "5.", "CLEAR", ".1", "DWELL", "2", "REV"]);
        let deep = deep.unwrap();
        assert_eq!((deep.step, deep.dwell), (Some(0.25), Some((2.0, true))));
        let tap = order(&["TAP", "DEPTH", ".4", "TPI", "20", "RTRCTO", "1"]).unwrap();
        assert_eq!((tap.feed, tap.retract), (Some(CycleFeed::ThreadsPerInch(20.0)), Retract::Above(1.0)));
        assert!(matches!(order(&["DRILL", "DEPTH"]), Err(PostFindingKind::MissingArgument { .. })));
        assert!(matches!(order(&["DRILL", "SIDEWAYS", "1"]), Err(PostFindingKind::UnknownArgument { .. })));
        assert!(matches!(order(&[]), Err(PostFindingKind::MissingArgument { .. })));
    }
}

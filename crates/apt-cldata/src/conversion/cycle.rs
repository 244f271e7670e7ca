//! CYCLE in the words of another system.
//!
//! What a hole is – depth, clearance, feed rate, step and return – has a word of its own in one system, a synonym in the next, and no word but
//! a place in the third. The name of the cycle stays: what DEEP and THRU do on a machine is in the hands of its post-processor, and where
//! two systems are known to differ by it that is told.

use smol_str::SmolStr;

use crate::{
    geometry::chamfer_depth,
    record::ClWord,
    text::dialects::{CycleForm, CyclePart, Form},
};

use super::words::{is_word, word};

/// Units of the feed rate, and the pitch that stands in its place.
const FEEDS: [&str; 7] = ["IPM", "IPR", "MMPM", "MMPR", "PERMIN", "PERREV", "TPI"];
/// Cycles that go in steps: withdrawn from the hole after each, or lifted a little so that the chip breaks.
const STEPPED: [&str; 2] = ["DEEP", "THRU"];
/// The depth that may be stated by the diameter that a pointed tool has there, and the angle of its point.
const CHAMFER: &str = "FEDTO";
const DEPTHS: [&str; 2] = ["DEPTH", CHAMFER];
const CLEARANCES: [&str; 2] = ["CLEAR", "RAPTO"];
const STEPS: [&str; 2] = ["INCR", "STEP"];
const RETRACTS: [&str; 3] = ["RETURN", "RTRCTO", "RETRCT"];

/// A cycle with a hole.
#[derive(Debug, Default, Clone, PartialEq)]
struct Hole {
    depth: Option<f64>,
    /// Diameter and angle of a chamfer, of which the depth comes.
    chamfer: Option<(f64, f64)>,
    clearance: Option<f64>,
    /// Unit and value.
    feed: Option<(ClWord, f64)>,
    step: Vec<ClWord>,
    retract: Vec<ClWord>,
    rest: Vec<ClWord>,
}

/// The parameters of CYCLE in the words of another form. None where they cannot be understood, or the target has no word for one of them.
pub(super) fn translate(arguments: &[ClWord], from: &Form, to: &Form) -> Option<Vec<ClWord>> {
    let (name, list) = arguments.split_first()?;
    if !matches!(name, ClWord::Word(_)) {
        return None;
    }
    if list.is_empty() {
        return Some(arguments.to_vec());
    }
    let hole = read(list, &from.cycle)?;
    Some([vec![name.clone()], write(&hole, &to.cycle)?].concat())
}

/// The name of a cycle with steps that the two systems are known to drill otherwise.
pub(super) fn other_meaning(arguments: &[ClWord], from: &Form, to: &Form) -> Option<SmolStr> {
    let Some(ClWord::Word(name)) = arguments.first().filter(|name| is_word(name, &STEPPED)) else {
        return None;
    };
    let differ = matches!((from.cycle.deep, to.cycle.deep), (Some(one), Some(other)) if one != other);
    differ.then(|| name.clone())
}

fn read(mut list: &[ClWord], form: &CycleForm) -> Option<Hole> {
    let mut hole = Hole::default();
    // Numbers without a word: the depth, then the clearance.
    let mut bare: Vec<f64> = Vec::new();
    // In the form of HSM the clearance has its place and RAPTO is something else.
    let by_place = form.depth.is_empty();
    while let [first, more @ ..] = list {
        list = more;
        let value = match more {
            [ClWord::Number(value), ..] => Some(*value),
            _ => None,
        };
        let mut taken = 1;
        match (first, value) {
            (ClWord::Number(value), _) => {
                bare.push(*value);
                taken = 0;
            }
            // A second number without a word before it is the feed of the unit behind it, in the table of Creo too.
            (unit, _) if is_word(unit, &FEEDS) && bare.len() > 1 => {
                hole.feed = Some((unit.clone(), bare.pop()?));
                taken = 0;
            }
            (unit, Some(value)) if is_word(unit, &FEEDS) => hole.feed = Some((unit.clone(), value)),
            (depth, Some(diameter)) if is_chamfer(depth, more) => {
                taken = 2;
                let [_, ClWord::Number(angle), ..] = more else { return None };
                hole.chamfer = Some((diameter.abs(), *angle));
                // The sign of an offset is of the form, that of a depth is not.
                let depth = chamfer_depth(diameter.abs(), *angle)?;
                hole.depth = Some(if form.depth_signed { -depth } else { depth });
            }
            (depth, Some(value)) if is_word(depth, &DEPTHS) => hole.depth = Some(value),
            (clear, Some(value)) if is_word(clear, &CLEARANCES) && !by_place => hole.clearance = Some(value),
            (step, Some(_)) if is_word(step, &STEPS) => {
                taken = numbers_at_head(more);
                hole.step.extend_from_slice(&more[..taken]);
            }
            (back, _) if is_word(back, &RETRACTS) => {
                hole.retract.push(more.first()?.clone());
            }
            (other, _) => {
                taken = numbers_at_head(more);
                hole.rest.push(other.clone());
                hole.rest.extend_from_slice(&more[..taken]);
            }
        }
        list = list.get(taken..)?;
    }
    let mut bare = bare.into_iter();
    hole.depth = hole.depth.or_else(|| bare.next());
    hole.clearance = hole.clearance.or_else(|| bare.next());
    if bare.next().is_some() {
        return None;
    }
    if form.depth_signed {
        hole.depth = hole.depth.map(|depth| -depth);
    }
    Some(hole)
}

/// Whether a depth is that of a chamfer: `FEDTO,diameter,angle`.
fn is_chamfer(depth: &ClWord, behind: &[ClWord]) -> bool {
    is_word(depth, &[CHAMFER]) && numbers_at_head(behind) == 2
}

fn numbers_at_head(list: &[ClWord]) -> usize {
    list.iter().take_while(|one| matches!(one, ClWord::Number(_))).count()
}

fn write(hole: &Hole, form: &CycleForm) -> Option<Vec<ClWord>> {
    let couple = |name: &str, value: f64| {
        let name = (!name.is_empty()).then(|| word(name));
        name.into_iter().chain([ClWord::Number(value)]).collect::<Vec<ClWord>>()
    };
    // A number in its place is told from another by what stands before it.
    let by_place = form.depth.is_empty();
    // What is something else in the source must not be taken for a part of the hole.
    let parts = [form.depth, form.clearance, form.step, form.retract];
    if hole.rest.iter().any(|word| is_word(word, &parts)) {
        return None;
    }
    if by_place && (hole.depth.is_none() || hole.clearance.is_some() && hole.feed.is_none()) {
        return None;
    }
    let mut list = Vec::new();
    for part in form.order {
        match part {
            CyclePart::Depth => {
                let sign = if form.depth_signed { -1.0 } else { 1.0 };
                if let Some((diameter, angle)) =
                    hole.chamfer.filter(|_| form.depth == CHAMFER && !form.depth_signed)
                {
                    list.extend([word(CHAMFER), ClWord::Number(diameter), ClWord::Number(angle)]);
                    continue;
                }
                list.extend(hole.depth.iter().flat_map(|depth| couple(form.depth, sign * depth)));
            }
            CyclePart::Clearance => {
                list.extend(hole.clearance.iter().flat_map(|clear| couple(form.clearance, *clear)));
            }
            CyclePart::Feed => {
                if let Some((unit, value)) = &hole.feed {
                    let both = [unit.clone(), ClWord::Number(*value)];
                    list.extend(both);
                    if form.feed_value_first {
                        let last = list.len() - 1;
                        list.swap(last - 1, last);
                    }
                }
            }
            CyclePart::Step if !hole.step.is_empty() => {
                list.push(word(form.step));
                list.extend_from_slice(&hole.step);
            }
            CyclePart::Retract => {
                for height in &hole.retract {
                    list.extend([word(form.retract), height.clone()]);
                }
            }
            CyclePart::Step => {}
            CyclePart::Rest => list.extend_from_slice(&hole.rest),
        }
    }
    Some(list)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::ClKind;
    use crate::text::{ClDialect, read_text};

    fn arguments(text: &str) -> Vec<ClWord> {
        let (records, errors) = read_text(&format!("CYCLE/{text}\n"));
        assert_eq!(errors, vec![]);
        match records.into_iter().next().map(|record| record.kind) {
            Some(ClKind::Postprocessor { arguments, .. }) => arguments,
            other => panic!("{other:?}"),
        }
    }

    /// The hole of the reference in five spellings, each made of each.
    #[test]
    fn one_hole_in_five_spellings() {
        let spellings = [
            (ClDialect::Catia, "DRILL,10,200,MMPM,2"),
            (ClDialect::Nx, "DRILL,RAPTO,2,FEDTO,-10,MMPM,200"),
            (ClDialect::Creo, "DRILL,DEPTH,10,MMPM,200,CLEAR,2"),
            (ClDialect::Ncl, "DRILL,FEDTO,10,MMPM,200,RAPTO,2"),
            (ClDialect::Hsm, "DRILL,10,MMPM,200,2"),
        ];
        for (from, source) in spellings {
            for (to, wanted) in spellings {
                let made = translate(&arguments(source), Form::of(from), Form::of(to));
                assert_eq!(made, Some(arguments(wanted)), "{from:?} {to:?}");
            }
        }
    }

    #[test]
    fn steps_and_returns_have_synonyms_and_the_rest_stays() {
        let made = |text: &str, from, to| translate(&arguments(text), Form::of(from), Form::of(to));
        assert_eq!(
            made(
                "DEEP,FEDTO,.75,IPM,4.5,RAPTO,.1,STEP,.2,.1,RTRCTO,.3,DWELL,1",
                ClDialect::Ncl,
                ClDialect::Hsm
            ),
            Some(arguments("DEEP,.75,INCR,.2,.1,IPM,4.5,.1,RETURN,.3,DWELL,1"))
        );
        assert_eq!(made("OFF", ClDialect::Ncl, ClDialect::Hsm), Some(arguments("OFF")));
        // A chamfer is a depth where no word has both its numbers.
        let chamfer = "CSINK,FEDTO,10,90,MMPM,80,RAPTO,2";
        assert_eq!(made(chamfer, ClDialect::Ncl, ClDialect::Generic), Some(arguments(chamfer)));
        for (to, wanted) in [
            (ClDialect::Creo, "CSINK,DEPTH,5,MMPM,80,CLEAR,2"),
            (ClDialect::Nx, "CSINK,RAPTO,2,FEDTO,-5,MMPM,80"),
            (ClDialect::Hsm, "CSINK,5,MMPM,80,2"),
        ] {
            let rounded: Option<Vec<ClWord>> = made(chamfer, ClDialect::Ncl, to).map(|list| {
                let whole = |one: ClWord| match one {
                    ClWord::Number(value) => ClWord::Number((value * 1e9).round() / 1e9),
                    ClWord::Word(_) => one,
                };
                list.into_iter().map(whole).collect()
            });
            assert_eq!(rounded, Some(arguments(wanted)), "{to:?}");
        }
        assert_eq!(made("CSINK,FEDTO,10,180,MMPM,80,RAPTO,2", ClDialect::Ncl, ClDialect::Creo), None);
        // A tap without a feed rate has no place for its clearance there.
        assert_eq!(made("TAP,DEPTH,.4,CLEAR,.2", ClDialect::Creo, ClDialect::Hsm), None);
        // RAPTO is something else beside the clearance that has its place.
        let beside = "DRILL,1,IPM,8,.6,RAPTO,.4";
        assert_eq!(made(beside, ClDialect::Hsm, ClDialect::Ncl), None);
        let wanted = arguments("DRILL,DEPTH,1,IPM,8,CLEAR,.6,RAPTO,.4");
        assert_eq!(made(beside, ClDialect::Hsm, ClDialect::Creo), Some(wanted));
        let table = "DRILL,10,60,MMPM,3";
        for from in [ClDialect::Generic, ClDialect::Catia, ClDialect::Creo] {
            let wanted = arguments("DRILL,FEDTO,10,MMPM,60,RAPTO,3");
            assert_eq!(made(table, from, ClDialect::Ncl), Some(wanted), "{from:?}");
        }
        // Three numbers without a word between them are of a table that nobody knows.
        assert_eq!(made("DRILL,1,2,3", ClDialect::Hsm, ClDialect::Creo), None);
    }
}

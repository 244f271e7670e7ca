//! Words for regional milling of sculptured surfaces (codes 052x).

use apt_program::finding::{ConditionBlock, FindingKind as Kind};

use super::{Text, number, say};

pub(super) fn word(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::ConditionMissing { word, missing, spoiled, valid } => {
            condition_missing(word, missing, spoiled, valid)
        }
        Kind::NameOnly { word } => {
            say("APT0521", format!("only the name of {word} is public, not what it does"))
                .hint("SCON and SMIL mill regions of sculptured surfaces")
        }
        Kind::OlderSpelling { word, present } => {
            say("APT0522", format!("{word} is an older spelling of {present}"))
                .hint(format!("write {present}"))
        }
        Kind::GuideBeyond { name, parameter, low, high, extent } => {
            let guide = if name.is_empty() { "the guide element" } else { name.as_str() };
            say(
                "APT0523",
                format!(
                    "the range of {parameter}, {} to {}, reaches beyond {guide}",
                    number(*low),
                    number(*high)
                ),
            )
            .hint(format!("{parameter} runs from 0 to {} there", number(*extent)))
        }
        Kind::AvoidanceWithoutCheck => {
            say("APT0524", "AVCTRL is on, but no surface is checked, so that there is nothing to avoid")
                .hint("write CHKSRF/PS,ON before this statement, or AVCTRL/OFF")
        }
        Kind::LiftWithoutLimit => say("APT0525", "the lift has no limit of its own: MAXDP limits it")
            .hint("add LIMIT and the greatest lift"),
        Kind::RangeReversed { statement, low, high } => say(
            "APT0526",
            format!(
                "the limits of {statement} are in the wrong order: {} is above {}",
                number(*low),
                number(*high)
            ),
        )
        .hint("write the lower limit first"),
        _ => return None,
    })
}

fn condition_missing(
    word: &str,
    missing: &[ConditionBlock],
    spoiled: &[ConditionBlock],
    valid: &[ConditionBlock],
) -> Text {
    let names = |blocks: &[ConditionBlock]| {
        blocks.iter().map(|block| block.statement()).collect::<Vec<_>>().join(", ")
    };
    let mut hint =
        if spoiled.is_empty() { String::new() } else { format!("{} has a mistake; ", names(spoiled)) };
    let unset: Vec<&str> =
        missing.iter().filter(|block| !spoiled.contains(block)).map(|block| block.template()).collect();
    if !unset.is_empty() {
        hint.push_str(&format!("write {}; ", unset.join(" and ")));
    }
    hint.push_str(&match valid {
        [] => "no condition is valid here".to_owned(),
        valid => format!("valid here: {}", names(valid)),
    });
    say("APT0520", format!("SMIL/{word} needs {}", names(missing))).hint(hint)
}

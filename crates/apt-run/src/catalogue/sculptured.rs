//! Words for space curves and sculptured surfaces (codes 0317 to 0319) and for their regional milling (codes 052x).

use apt_geometry::definition::ParametricError as Error;
use apt_program::finding::{ConditionBlock, FindingKind as Kind, SculpturedFinding};

use super::{Text, a_kind, number, say};

pub(super) fn word(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::Sculptured(SculpturedFinding::Parametric { statement, error }) => match statement.as_str() {
            "POINT" | "VECTOR" | "PARMF" => {
                say("APT0318", format!("{statement} has no answer: {}", reason(error))).maybe(help(error))
            }
            _ => say("APT0317", format!("this {statement} does not exist: {}", reason(error)))
                .maybe(help(error)),
        },
        Kind::Sculptured(SculpturedFinding::ParametricDoubt { statement, error }) => {
            say("APT0319", format!("this {statement} is doubtful: {}", reason(error))).maybe(help(error))
        }
        Kind::Sculptured(SculpturedFinding::ConditionMissing { word, missing, spoiled, valid }) => {
            condition_missing(word, missing, spoiled, valid)
        }
        Kind::Sculptured(SculpturedFinding::NameOnly { word }) => {
            say("APT0521", format!("only the name of {word} is public, not what it does"))
                .hint("SCON and SMIL mill regions of sculptured surfaces")
        }
        Kind::Sculptured(SculpturedFinding::OlderSpelling { word, present }) => {
            say("APT0522", format!("{word} is an older spelling of {present}"))
                .hint(format!("write {present}"))
        }
        Kind::Sculptured(SculpturedFinding::GuideBeyond { name, parameter, low, high, extent }) => {
            let guide = if name.is_empty() { "the guide element" } else { name.as_str() };
            say(
                "APT0523",
                format!(
                    "the range of {parameter}, {} to {}, reaches beyond {guide}",
                    number(*low),
                    number(*high)
                ),
            )
            .hint(format!(
                "{parameter} runs from 0 to {} there, and passes end at its edges",
                number(*extent)
            ))
        }
        Kind::Sculptured(SculpturedFinding::AvoidanceWithoutCheck) => {
            say("APT0524", "AVCTRL is on, but no surface is checked, so that there is nothing to avoid")
                .hint("write CHKSRF/PS,ON before this statement, or AVCTRL/OFF")
        }
        Kind::Sculptured(SculpturedFinding::LiftWithoutLimit) => {
            say("APT0525", "the lift has no limit of its own: MAXDP limits it")
                .hint("add LIMIT and the greatest lift")
        }
        Kind::Sculptured(SculpturedFinding::RangeReversed { statement, low, high }) => say(
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

/// Why a space curve, a sculptured surface or a place on one does not exist, or is doubtful.
fn reason(error: &Error) -> String {
    match error {
        Error::TooFew { least, found } => format!("{found} are given where it takes at least {least}"),
        Error::TooManyConditions { greatest, found } => {
            format!("a conic is settled by {greatest} conditions, and there are {found}")
        }
        Error::Coincident { first, second } => format!("points {first} and {second} coincide"),
        Error::Collinear => "its points lie on one line".to_owned(),
        Error::NotPlanar { distance } => {
            format!("its data do not lie in one plane, {} is off", number(*distance))
        }
        Error::NoConicArc => "no conic arc runs through its data in their order".to_owned(),
        Error::ZeroVector => "a vector has no direction".to_owned(),
        Error::NotFinite => "a number is too large, or not a number".to_owned(),
        Error::OutOfRange { value, least, greatest } => {
            format!("{} does not lie between {} and {}", number(*value), number(*least), number(*greatest))
        }
        Error::NoFlow { curve } => format!("curve {curve} has no segments"),
        Error::SegmentCount { curve, expected, found } => {
            format!("curve {curve} has {found} segments and the first one {expected}")
        }
        Error::FlowWithoutSegments => "FLOW has no segments".to_owned(),
        Error::SegmentsWithoutFlow => "SEG has no flow".to_owned(),
        Error::RangeOrder { number } => format!("range {number} does not go on where the one before ends"),
        Error::FlowNotMonotone { number } => {
            format!("what range {number} of the flow measures does not grow all along the curve")
        }
        Error::AxisForm => "AXIS has a point and a vector".to_owned(),
        Error::RowLength { expected, rows } => {
            let told = rows.iter().enumerate().map(|(index, (row, found))| {
                let points = if index == 0 { " points" } else { "" };
                format!("row {row} has {found}{points}")
            });
            let told: Vec<String> = told.collect();
            format!("{} and the first one {expected}", told.join(", "))
        }
        Error::RowNotStraight { row } => {
            format!("row {row} is not straight in the plane over which its points are heights")
        }
        Error::Gap { curve, gap } => {
            format!("curve {curve} begins {} from the end of the one before", number(*gap))
        }
        Error::Apart { surface } => {
            format!("surface {surface} touches neither the first one nor any that hangs together with it")
        }
        Error::CrossGap { curve, gap } => {
            format!("cross curve {curve} ends {} from the boundary curves", number(*gap))
        }
        Error::LoosePatches { patches } => format!("its {patches} patches do not know of each other"),
        Error::Knots { degree, points } => {
            format!("its knots are not those of {points} control points of degree {degree}")
        }
        Error::Weight { weight } => format!("the weight {} is not positive", number(*weight)),
        Error::SingularMatrix => "the matrix of TRFORM has no inverse".to_owned(),
        Error::NoIntersection => "the curve does not meet what bounds it".to_owned(),
        Error::NotConvertible { kind } => format!("{} has no form in patches", a_kind(*kind)),
        Error::NoSuchPart { number: asked, count } => {
            format!("there is no number {}, there are {count}", number(*asked))
        }
        Error::NoPlace { miss } => format!("they do not meet, {} is missing", number(*miss)),
        Error::NoDirection => "the geometry has no such direction there".to_owned(),
        Error::MixedSigns => "the sign words of its pieces tell different sides of it".to_owned(),
        Error::NoPlaceYet => "no INTOF came before that has this parameter".to_owned(),
    }
}

/// What would help.
fn help(error: &Error) -> Option<String> {
    let text = match error {
        Error::NoFlow { .. } => "add FLOW and SEG to the curve, as in FLOW,PARAM,0,2,SEG,PARAM,0,2",
        Error::SegmentCount { .. } => "segments of the same number are joined: give all curves as many",
        Error::FlowWithoutSegments => "add SEG behind FLOW, as in SEG,PARAM,0,2",
        Error::SegmentsWithoutFlow => "write FLOW before SEG, as in FLOW,PARAM,0,2,SEG,PARAM,0,2",
        Error::RangeOrder { .. } => "ranges are numbers of arcs: 0 is the start of the first arc",
        Error::AxisForm => "give a vector alone, or two points",
        Error::RowNotStraight { .. } => "XYZ takes rows of any shape",
        Error::Gap { .. } => "the curve is made with the gap",
        Error::Apart { .. } => "the surface is made of pieces that know nothing of each other",
        Error::LoosePatches { .. } => "join surfaces of one patch by COMBIN",
        Error::Knots { degree, points } => {
            return Some(format!("they are {} numbers that do not fall", degree + points + 1));
        }
        Error::MixedSigns => {
            "pieces that meet have different words only where the parameters of one run about it the other way; pieces apart make surfaces of their own"
        }
        Error::NoSuchPart { .. } => "numbers begin at 1; 0 takes the parameters of the whole",
        Error::NoPlaceYet => "POINT/INTOF or VECTOR/INTOF of the curve or surface comes first",
        _ => return None,
    };
    Some(text.to_owned())
}

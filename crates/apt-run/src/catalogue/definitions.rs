//! Words for definitions and operands (codes 03xx).

use apt_geometry::{
    canonical::GeometryKind,
    definition::{DefinitionError, Impossible, RuledFault, formats},
};
use apt_program::finding::{Expected, FindingKind as Kind, Found};

use super::{Text, a_kind, names::found, number, say};

pub(super) fn word(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::Definition { kind, error } => definition(*kind, error),
        Kind::DefinitionWord { kind, word } => {
            say("APT0302", format!("the word {word} cannot stand in the definition of {}", a_kind(*kind)))
        }
        Kind::UnknownType { word } => say("APT0309", format!("{word} cannot be defined by this version"))
            .hint("it is a type of single installations, whose programs are not public"),
        Kind::Untransformable { kind } => {
            say("APT0310", format!("{} cannot be carried into this reference system", a_kind(*kind)))
        }
        Kind::UnnamedPattern => say("APT0311", "a nested pattern needs a name").hint("write (NAME=PATERN/…)"),
        Kind::VerticalZSurface => say("APT0312", "z cannot be found: the ZSURF plane is parallel to z"),
        Kind::Operand { statement, expected, found: what, .. } => {
            say("APT0320", format!("{statement} needs {} here, not {}", wanted(*expected), found(what)))
        }
        Kind::OperandCount { statement, found, expected, .. } => {
            let plural = if *found == 1 { "operand" } else { "operands" };
            say("APT0321", format!("{statement} cannot take {found} {plural}"))
                .hint(format!("it takes {expected}"))
        }
        Kind::OperandRange { statement, value, .. } => {
            let hint = match statement.as_str() {
                "SMIL" => "a pass starts inside the range that SCON/DS gives the guide",
                "TLAXIS" if *value == 0.0 => "a tool axis is a direction: not all of its components are zero",
                _ => "check the sign and the unit of the value",
            };
            say("APT0322", format!("{statement} cannot take the value {}", number(*value))).hint(hint)
        }
        Kind::Doubtful { statement, value } => {
            let text = say("APT0323", format!("{} is a doubtful value for {statement}", number(*value)));
            match statement.as_str() {
                "INTOL" | "OUTTOL" | "TOLER" => {
                    text.hint("a tolerance is a distance and has no sign; a negative one is taken as zero")
                }
                "PATERN" => text.hint("the pattern has its first point, or column, and no more"),
                "CIRCLE" | "CYLNDR" | "SPHERE" => {
                    text.hint("a radius is greater than zero; check the order of the numbers")
                }
                "CONE" => text.hint("the half angle lies between 0 and 90 degrees"),
                "ELLIPS" | "HYPERB" => text.hint("a half axis is longer than zero"),
                "SCON" => text.hint("so far from the normal the tool lies nearly along the surface"),
                "QADRIC" | "GCONIC" => text.hint("without x, y and z the equation describes no surface"),
                _ => text,
            }
        }
        Kind::NotNormalised { kind, length, normalised } => {
            let text = say(
                "APT0315",
                format!("the direction of {} has the length {}, not 1", a_kind(*kind), number(*length)),
            );
            if normalised.is_empty() {
                return Some(text.hint("three zeros are no direction"));
            }
            let values: Vec<String> = normalised.iter().map(|value| number(*value)).collect();
            text.hint(format!(
                "CANON stores the numbers as they are; write {}/CANON,{}",
                kind.word(),
                values.join(",")
            ))
        }
        Kind::ObtainType { name, expected, found } => {
            say("APT0330", format!("{name} is {}, not {}", a_kind(*found), a_kind(*expected)))
                .hint(format!("write OBTAIN,{}/{name},…", found.word()))
        }
        Kind::ObtainCount { kind, available, wanted } => {
            say("APT0331", format!("{} has {available} numbers, {wanted} are asked for", a_kind(*kind)))
        }
        Kind::ObtainLarge { kind } => {
            say("APT0332", format!("no numbers can be obtained from {}", a_kind(*kind)))
        }
        Kind::ReferenceSystem { found: Found::Geometry(GeometryKind::Matrix) } => {
            say("APT0333", "REFSYS needs a matrix with a name".to_owned())
                .hint("give it one here, as in REFSYS/(M1=MATRIX/…), or define it before")
        }
        Kind::ReferenceSystem { found: what } => {
            say("APT0333", format!("REFSYS needs a matrix, not {}", found(what)))
                .hint("REFSYS/NOMORE returns to the base system")
        }
        Kind::Corner { point, degrees, others } => {
            let more = match others {
                0 => String::new(),
                1 => ", and there is another one".to_owned(),
                others => format!(", and there are {others} others"),
            };
            say("APT0313", format!("the curve has a corner of {} degrees at point {point}{more}", number(*degrees)))
                .hint("check the order of the points and the slopes; SPLINE and TWOPT make no corners by themselves")
        }
        Kind::CurvatureJump { point, jump } => {
            say("APT0314", format!("the curvature of the spline jumps by {} at point {point}", number(*jump)))
                .hint("the points swing from side to side: give more of them, or use TWOPT")
        }
        Kind::IdleSelector { word } => {
            say("APT0324", format!("{word} does not choose: both intersections are equally far that way"))
                .hint("choose by the other coordinate")
        }
        Kind::RuledCurve { fault } => ruled_curve(fault),
        Kind::SingularMatrix => say("APT0334", "this matrix has no inverse and cannot be a reference system")
            .hint("its rows depend on each other; check for a row of zeros"),
        _ => return None,
    })
}

fn ruled_curve(fault: &RuledFault) -> Text {
    const ORDINALS: [&str; 2] = ["first", "second"];
    let ordinal = |curve: usize| ORDINALS.get(curve.saturating_sub(1)).copied().unwrap_or("next");
    match fault {
        RuledFault::NotMet { curve } => say(
            "APT0316",
            format!("the {} surface is not met along the direction across its chord", ordinal(*curve)),
        )
        .hint("the third point or the vector points from the chord to the curve; no motion can follow this surface"),
        RuledFault::OffSurface { curve, distances: [first, second] } => say(
            "APT0316",
            format!(
                "the end points of the {} curve are {} and {} away from its surface",
                ordinal(*curve),
                number(*first),
                number(*second)
            ),
        )
        .hint("the curve is what the direction across the chord meets of the surface, and runs past these points"),
    }
}

fn wanted(expected: Expected) -> String {
    let text = match expected {
        Expected::Words(words) => return one_of(words),
        Expected::Scalar => "a number",
        Expected::Surface => "a surface",
        Expected::Plane => "a plane",
        Expected::Point => "a point",
        Expected::Vector => "a vector",
        Expected::Matrix => "a matrix",
        Expected::MatrixOrNomore => "a matrix or NOMORE",
        Expected::PlaneOrNumbers => "a plane or its four numbers",
        Expected::Name => "a name",
        Expected::Label => "a label",
        Expected::Word => "a word",
        Expected::OnOrOff => "ON or OFF",
        Expected::ScalarOrWord => "a number or a word",
        Expected::Integer => "a whole number",
        Expected::Pattern => "a pattern",
        Expected::Nothing => "nothing",
        Expected::SculpturedSurface => "a sculptured surface",
        Expected::SculpturedElement => "a sculptured surface or a space curve",
        Expected::GuideSurface => "a guide surface",
        Expected::SpaceCurve => "a space curve",
        Expected::LineOrCircle => "a line or a circle",
        Expected::FeedsOrPlane => "four feed rates or a plane",
        Expected::DistanceVectorOrPlane => "a distance, a vector or a plane",
        Expected::CheckedAndSwitch => "PS or one sculptured surface, and ON or OFF",
    };
    text.to_owned()
}

/// `A`, `A or B`, `A, B or C`.
fn one_of(words: &[&str]) -> String {
    match words {
        [] => "nothing".to_owned(),
        [one] => format!("the word {one}"),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
    }
}

fn definition(kind: GeometryKind, error: &DefinitionError) -> Text {
    let type_word = kind.word();
    match error {
        DefinitionError::UnknownFormat { .. } => {
            let hint = match kind {
                GeometryKind::Loft => {
                    Some("single installations had its definition; CANON stores its eight numbers".to_owned())
                }
                GeometryKind::Mesh | GeometryKind::ElementSurface => {
                    Some("single installations had its definition; CANON stores its numbers".to_owned())
                }
                _ => forms(kind),
            };
            say("APT0301", format!("{type_word} has no form with these parameters")).maybe(hint)
        }
        DefinitionError::WrongModifier { found, expected, .. } => {
            let expected: Vec<_> = expected.iter().map(|modifier| modifier.word()).collect();
            let hint = (!expected.is_empty()).then(|| format!("one of {} is needed", expected.join(", ")));
            say("APT0303", format!("{} does not fit this form of {type_word}", found.word())).maybe(hint)
        }
        DefinitionError::Impossible { reason } => impossible(type_word, reason),
        DefinitionError::CanonicalCount { expected, found } => {
            say("APT0305", format!("the canonical form of {type_word} has {expected} numbers, not {found}"))
        }
        DefinitionError::CanonicalKind { expected, found } => {
            say("APT0306", format!("CANON copies {}, and this is {}", a_kind(*expected), a_kind(*found)))
        }
        DefinitionError::NotFinite { position } => {
            say("APT0307", format!("parameter {} is too large, or not a number", position + 1))
        }
        DefinitionError::Special { number, position } => {
            let place =
                position.map(|position| format!(" at parameter {}", position + 1)).unwrap_or_default();
            let rule = match number {
                83 => "each value of a canonical form must be a number",
                154 => "the pattern has no point with this number",
                701 => "the two end points of a curve are too close together",
                702 => "the third point or vector must not lie along the end points",
                801 => "only LINEAR patterns can be repeated by PARLEL",
                802 => "the pattern would have too many points",
                1000 => "it cannot be made from canonical values",
                1001 => "there are too few points for this kind of curve, or too many",
                _ => "a limit of this form is exceeded",
            };
            say("APT0308", format!("the definition of {type_word} breaks a rule{place}: {rule}"))
        }
    }
}

/// A few forms of a type, to choose from.
fn forms(kind: GeometryKind) -> Option<String> {
    /// More would not be read.
    const SHOWN: usize = 4;
    let mut lines: Vec<String> = Vec::new();
    for format in formats(kind) {
        let line = format.help.replace(';', ",");
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    if lines.len() > SHOWN {
        let more = lines.split_off(SHOWN).len();
        lines.push(format!("and {more} more {}", if more == 1 { "form" } else { "forms" }));
    }
    (!lines.is_empty()).then(|| format!("its forms are {}", lines.join("; ")))
}

fn impossible(type_word: &str, reason: &Impossible) -> Text {
    let why = match reason {
        Impossible::Coincident { distance } => {
            format!("two of its entities coincide (they are {} apart)", number(*distance))
        }
        Impossible::Collinear => "its points lie on one line".to_owned(),
        Impossible::Parallel => "its entities are parallel and do not meet".to_owned(),
        Impossible::ZeroVector => "a vector has no direction".to_owned(),
        Impossible::ZeroLength => "a length is zero".to_owned(),
        Impossible::NotPositive { value } => format!("{} is not positive", number(*value)),
        Impossible::NoIntersection { gap } => {
            format!("its entities do not meet: {} is missing", number(*gap))
        }
        Impossible::InsideCircle { distance, radius } => format!(
            "the point lies inside the circle ({} from the centre, the radius is {})",
            number(*distance),
            number(*radius)
        ),
        Impossible::CirclesTooNear { distance, needed } => format!(
            "the circles have no such tangent, for their centres are {} apart, and it takes at least {}",
            number(*distance),
            number(*needed)
        ),
        Impossible::RadiusTooSmall { radius, least } => {
            format!("the radius {} is too small, it must be at least {}", number(*radius), number(*least))
        }
        Impossible::RadiusTooLarge { radius, greatest } => {
            format!("the radius {} is too large, it must be at most {}", number(*radius), number(*greatest))
        }
        Impossible::Singular => "its conditions do not determine it".to_owned(),
        Impossible::NotReal => "it has no real points".to_owned(),
        Impossible::VerticalZSurface => "the ZSURF plane is parallel to z".to_owned(),
        Impossible::Undecided { word } => {
            format!("{} does not decide between its two solutions", word.word())
        }
        Impossible::AngleOutOfRange { degrees } => format!("the angle {}° is out of range", number(*degrees)),
    };
    say("APT0304", format!("this {type_word} does not exist: {why}")).maybe(other_word(reason))
}

/// Where a word does not decide: words that may, which are those of another axis.
fn other_word(reason: &Impossible) -> Option<String> {
    let Impossible::Undecided { word } = reason else { return None };
    let word = word.word();
    let other = |of_x: &'static str, of_y: &'static str| if word.contains('X') { of_y } else { of_x };
    let others = match word {
        _ if word.ends_with("LARGE") || word.ends_with("SMALL") => {
            other("XLARGE or XSMALL", "YLARGE or YSMALL")
        }
        _ if word.starts_with("POS") || word.starts_with("NEG") => other("POSX or NEGX", "POSY or NEGY"),
        _ => return None,
    };
    Some(format!("choose a word of another axis, as {others}"))
}

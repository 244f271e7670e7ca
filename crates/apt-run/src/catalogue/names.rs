//! Words for names, subscripts and arithmetic (codes 01xx and 02xx).

use apt_program::finding::{ControlFinding, FindingKind as Kind, Found};

use apt_syntax::vocabulary;

use super::{Text, a_kind, number, say, similar};

pub(super) fn word(kind: &Kind) -> Option<Text> {
    name(kind).or_else(|| subscript(kind)).or_else(|| arithmetic(kind))
}

/// What was found, for a message.
pub(super) fn found(found: &Found) -> String {
    match found {
        Found::Scalar => "a number".to_owned(),
        Found::Geometry(kind) => a_kind(*kind),
        Found::Word(word) => format!("the word {word}"),
        Found::Label => "a label".to_owned(),
        Found::Macro => "a macro".to_owned(),
        Found::Array => "an array without subscript".to_owned(),
        Found::Text => "text".to_owned(),
        Found::Nothing => "nothing".to_owned(),
    }
}

fn name(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::Undefined { name, similar: names } => say("APT0101", format!("{name} is not defined"))
            .hint("a name must be given a value before it is used, in the order of execution")
            .maybe(similar(names)),
        Kind::ListedUndefined { name, similar: names } => {
            say("APT0112", format!("{name} has no value to list")).maybe(similar(names))
        }
        Kind::UndefinedOption { statement, name, similar: words } => {
            let forms = vocabulary::lookup(statement).map_or(&[][..], |word| word.forms);
            say("APT0101", format!("{name} is not defined, and no word of {statement}"))
                .hint(format!("the forms are {}", forms.join(", ")))
                .maybe(similar(words))
        }
        Kind::LabelAsValue { name } => say("APT0102", format!("{name} is a label and has no value")),
        Kind::MacroAsValue { name } => say("APT0103", format!("{name} is a macro and has no value"))
            .hint(format!("a macro is run by CALL/{name}")),
        Kind::GeometryAsScalar { name, kind } => {
            let subject = if name.is_empty() { "this".to_owned() } else { name.to_string() };
            say("APT0104", format!("{subject} is {}, where a number is needed", a_kind(*kind)))
                .hint("OBTAIN takes the numbers out of a surface")
        }
        Kind::Redefined { name, kind } => say("APT0105", format!("{name} is already {}", a_kind(*kind)))
            .hint("CANON/ON allows redefinition; or choose another name"),
        Kind::RedefinedAsOtherKind { name, old, new } => {
            say("APT0106", format!("{name} is {} and cannot become {}", a_kind(*old), a_kind(*new)))
                .hint("choose another name")
        }
        Kind::GeometryToScalar { name, kind } => {
            say("APT0107", format!("{name} is {} and cannot hold a number", a_kind(*kind)))
                .hint("choose another name")
        }
        Kind::ScalarToGeometry { name } => {
            say("APT0108", format!("{name} holds a number and cannot become geometry"))
                .hint("choose another name")
        }
        Kind::NotAssignable { name, found: what } => {
            say("APT0109", format!("{name} cannot be given a value: it is {}", found(what)))
        }
        Kind::Unused { name } => say("APT0110", format!("{name} is never used")),
        Kind::WordBecomesName { name } => {
            say("APT0111", format!("from here on {name} is a name and no longer a word of the language"))
        }
        _ => return None,
    })
}

fn subscript(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::SubscriptRange { name, subscript, extent } => {
            say("APT0120", format!("the subscript {} of {name} is outside 1 to {extent}", number(*subscript)))
        }
        Kind::SubscriptMissing { name, extent } => {
            say("APT0121", format!("{name} is an array of {extent} and needs a subscript"))
                .hint(format!("write {name}(1)"))
        }
        Kind::NotReserved { name } => say("APT0122", format!("{name} is neither a function nor an array"))
            .hint(match apt_syntax::vocabulary::later_function(name) {
                Some(_) => format!(
                    "as a function {name} belongs to the dialects free and apt4: set `dialect = \"free\"` in \
                     apt-lsp.toml; an array is declared by RESERV/{name},n before it is used"
                ),
                None => format!("an array is declared by RESERV/{name},n before it is used"),
            }),
        Kind::MixedArray { name, holds_geometry } => {
            let holds = if *holds_geometry { "geometry" } else { "numbers" };
            say(
                "APT0123",
                format!("the array {name} holds {holds}; it cannot hold both numbers and geometry"),
            )
        }
        Kind::InclusiveForm { name } => {
            say("APT0124", format!("the inclusive subscript of {name} is badly formed"))
        }
        Kind::InclusiveNotHere { name } => {
            say("APT0125", format!("an inclusive subscript of {name} cannot stand here"))
                .hint("inclusive subscripts belong to definitions and to PRINT and PUNCH lists")
        }
        Kind::ReserveInRegion => {
            say("APT0126", "RESERV cannot stand in a loop or macro").hint("move it before the loop or macro")
        }
        Kind::ReserveForm => {
            say("APT0127", "RESERV takes pairs of a name and a number, all in the same order")
        }
        Kind::ReserveExtent { extent } => {
            say("APT0128", format!("an array cannot have {} elements", number(*extent)))
        }
        Kind::ReserveUsed { name } => {
            say("APT0129", format!("{name} is in use already and cannot be reserved"))
        }
        _ => return None,
    })
}

fn arithmetic(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::DivisionByZero => say("APT0201", "this divides by zero"),
        Kind::NegativePower { base, exponent } => say(
            "APT0202",
            format!("{} to the power {} is not a real number", number(*base), number(*exponent)),
        ),
        Kind::NotFinite => say("APT0203", "the result is too large, or not a number"),
        Kind::FunctionCount { function, expected, found } => {
            say("APT0204", format!("{function} takes {expected} arguments, not {found}"))
        }
        Kind::FunctionKind { function, found: what } => {
            say("APT0205", format!("{function} cannot take {}", found(what)))
        }
        Kind::FunctionMixed { function, first, second } => {
            say("APT0205", format!("{function} cannot take {} with {}", a_kind(*first), a_kind(*second)))
        }
        Kind::FunctionDomain { function, value } => {
            say("APT0206", format!("{function} of {} does not exist", number(*value)))
        }
        Kind::NegativeRoot { value } => {
            say("APT0207", format!("the square root of {} is not a real number", number(*value)))
        }
        Kind::NotParallel { sine } => {
            let angle = sine.abs().min(1.0).asin().to_degrees();
            say(
                "APT0208",
                format!("there is no distance: the surfaces are not parallel but at {}°", number(angle)),
            )
        }
        Kind::AngleOfCenter => say("APT0209", "there is no angle: the point is the centre of the circle"),
        Kind::Control(ControlFinding::ZeroStep) => say("APT0210", "the step of the DO loop is zero"),
        _ => return None,
    })
}

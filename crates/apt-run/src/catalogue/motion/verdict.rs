//! Words for what the verifier finds (codes 068x).

use arelem::verify::{Evidence, Rule, VerifyError};

use crate::catalogue::{Text, a_kind, number, say};

/// The words for a pocket whose only fault is what it leaves: the path does no harm, and APT III makes it too.
pub(super) fn uncleared(evidence: &Evidence) -> Option<Text> {
    let first = evidence.violations.first()?;
    let only = evidence.violations.iter().all(|violation| violation.rule == Rule::Cleared);
    only.then(|| {
        let left = number(first.value);
        say("APT0682", "a part of this pocket is not cleared")
            .hint(format!("{left} more than the effective radius is missing beside cut vector {}; a smaller offset or a greater effective radius clears it", first.vector + 1))
    })
}

/// The words for a motion that breaks a rule, with the first one that it breaks.
pub(super) fn unverified(evidence: &Evidence) -> Text {
    let text = say("APT0680", "the verifier did not confirm this motion");
    match evidence.violations.first() {
        None => text,
        Some(violation) => {
            let rule = match violation.rule {
                Rule::PartBand => "the part surface is out of tolerance",
                Rule::DriveBand => "the drive surface is out of tolerance",
                Rule::CheckBand => "the check surface is out of tolerance at the end",
                Rule::StopEvent => "the tool stopped at another position than asked for",
                Rule::Tangency => "the surfaces are not tangent where it stopped",
                Rule::Side => "the tool changes the side of a surface",
                Rule::Progress => "the tool moves back",
                Rule::StepLength => "a cut vector is longer than MAXDP",
                Rule::Cleared => "a part of the pocket is not cleared",
                #[expect(unreachable_patterns, reason = "a new rule of the verifier still gets a sentence")]
                _ => "a rule is broken",
            };
            text.hint(format!("{rule}: {} on cut vector {}", number(violation.value), violation.vector + 1))
        }
    }
}

/// The words for a motion that the verifier could not judge.
pub(super) fn not_judged(error: &VerifyError) -> Text {
    let why = match error {
        VerifyError::Cancelled => "the verification was cancelled".to_owned(),
        VerifyError::Unsupported { kind } => format!("it has no method for {}", a_kind(*kind)),
        VerifyError::Degenerate { kind } => {
            format!("the canonical form of {} describes no surface", a_kind(*kind))
        }
        VerifyError::Cutter => "the numbers of the cutter describe no convex tool".to_owned(),
        VerifyError::NotFinite => "a number of the path is too large, or not a number".to_owned(),
        VerifyError::NoDistance { vector } => {
            format!("no distance to a surface is found on cut vector {}", vector + 1)
        }
        VerifyError::Empty => "the path has no positions".to_owned(),
        VerifyError::Effort { limit } => format!("it gave up after {limit} steps"),
    };
    say("APT0681", "the verifier could not judge this motion").hint(why)
}

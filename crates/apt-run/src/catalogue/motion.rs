//! Words for the arithmetic element, its verifier and the path transformations (codes 06xx and 07xx).

mod cutter;
mod edit;
mod verdict;
mod warning;

use apt_cldata::edit::EditErrorKind;
use apt_geometry::{Vec3, canonical::GeometryKind, motion::Relation};
use arelem::error::{AxisFailure, Course, Iteration, MotionFailure as Failure, RoleName};

use super::{Text, a_kind, milling, number, pocket, remedy, say, tilt};
use crate::{diagnostic::Severity, pipeline::RunFindingKind};

/// Where the budget of positions is set.
const MORE_POINTS: &str = "the setting budget.points allows more";

/// The words, the severity and the APT III number of a finding of Sections 2 and 3.
pub(super) fn word(kind: &RunFindingKind) -> (Text, Severity, Option<u16>) {
    match kind {
        RunFindingKind::Milling(error) => milling::failure(error),
        RunFindingKind::Interference(found) => milling::interference(found),
        RunFindingKind::InterferenceNotProven { locations } => milling::not_proven(*locations),
        RunFindingKind::Failure { failure, remedies, .. } => {
            let text = failure_text(failure).maybe(remedy::hint(remedies));
            (text, Severity::Error, failure.apt3())
        }
        RunFindingKind::Warning(warning) => (warning::text(warning), Severity::Warning, warning.apt3()),
        RunFindingKind::Unverified(evidence) => match verdict::uncleared(evidence) {
            Some(text) => (text, Severity::Warning, None),
            None => (verdict::unverified(evidence), Severity::Error, None),
        },
        RunFindingKind::NotJudged(error) => (verdict::not_judged(error), Severity::Warning, error.apt3()),
        RunFindingKind::Skipped { statements, last } => {
            let what = match statements {
                1 => "this motion statement was".to_owned(),
                _ => format!("{statements} motion statements, up to statement {last}, were"),
            };
            let text = say("APT0690", format!("{what} not computed"))
                .hint("after an error motion goes on at a FROM, or where GOTO is followed by a statement that gives a direction");
            (text, Severity::Information, None)
        }
        RunFindingKind::TooManyPoints { limit } => {
            let text = say(
                "APT0717",
                format!("the path has more than {limit} positions; it ends before this statement"),
            )
            .hint(MORE_POINTS);
            (text, Severity::Error, None)
        }
        RunFindingKind::TransferPending { label } => {
            let text = say(
                "APT0691",
                format!("the program ends before the label {label}, where processing should go on"),
            );
            (text, Severity::Warning, Some(9))
        }
        RunFindingKind::AxisNotPutOut { angle } => (tilt::not_put_out(*angle), Severity::Warning, None),
        RunFindingKind::Edit(error) => {
            let severity = match error.kind {
                EditErrorKind::ZeroCount { .. } => Severity::Warning,
                _ => Severity::Error,
            };
            (edit::text(&error.kind), severity, error.apt3())
        }
    }
}

pub(super) fn role(role: RoleName) -> &'static str {
    match role {
        RoleName::Part => "part surface",
        RoleName::Drive => "drive surface",
        RoleName::Check(0) => "check surface",
        RoleName::Check(_) => "second check surface",
    }
}

pub(super) fn relation(relation: Relation) -> &'static str {
    match relation {
        Relation::To => "TO",
        Relation::On => "ON",
        Relation::Past => "PAST",
        Relation::TangentToDrive => "TANTO",
        Relation::TangentToPart => "PSTAN",
    }
}

/// Smallest coordinate that is shown as another number than zero, in program units: far below any tolerance.
const COORDINATE_SHOWN: f64 = 1e-9;

pub(super) fn place(at: &Vec3) -> String {
    // Rounding leaves traces of 1e-13 where a coordinate is meant to be zero.
    let coordinate = |value: f64| number(if value.abs() < COORDINATE_SHOWN { 0.0 } else { value });
    format!("({}, {}, {})", coordinate(at.x), coordinate(at.y), coordinate(at.z))
}

fn failure_text(failure: &Failure) -> Text {
    match failure {
        Failure::Cutter(error) => cutter::text(error),
        Failure::Pocket(failure) => pocket::text(failure),
        _ => setting(failure).or_else(|| start(failure)).unwrap_or_else(|| path(failure)),
    }
}

/// Why TLAXIS gives no axis at a place.
fn axis(cause: &AxisFailure, tip: &Vec3) -> Text {
    let degrees = |angle: &f64| number(angle.to_degrees());
    let what = match cause {
        AxisFailure::NotRuled => {
            "PARLEL follows the rulings of a RLDSRF, and the surface that it names is none".to_owned()
        }
        AxisFailure::ImpossibleAngles { alpha, beta } => format!(
            "no axis is at {} degrees to the normal and leads by {} degrees",
            degrees(alpha),
            degrees(beta)
        ),
        AxisFailure::NoPlane => {
            "the vector of ATANGL is normal to the surface that guides the axis".to_owned()
        }
        AxisFailure::NoNormal => "the surface that guides the axis has no normal here".to_owned(),
        AxisFailure::SignUnresolved => "to which side ATANGL tilts the axis is not settled here".to_owned(),
        AxisFailure::Vertex => {
            "in the vertex of a hollow cone the axis would have to turn on the spot".to_owned()
        }
        AxisFailure::NoSurface => "a surface that TLAXIS needs takes no part in this motion".to_owned(),
        AxisFailure::NotSettled { .. } => {
            "the surface that guides the axis is too hollow for this tool".to_owned()
        }
        AxisFailure::Leaps { angle } => {
            format!("the axis would have to turn by {} degrees on the spot", degrees(angle))
        }
        AxisFailure::SurfaceEnds { place: at } => {
            format!("the surface that guides the axis ends at {}", place(at))
        }
    };
    let hint = match cause {
        AxisFailure::ImpossibleAngles { .. } => {
            "an axis leads, by CUTANG or the second angle of ATANGL, by no more than it leans from the normal; TLAXIS/i,j,k fixes it"
        }
        _ => "TLAXIS/i,j,k fixes the axis",
    };
    say("APT0606", format!("{what}, with the tool end at {}", place(tip))).hint(hint)
}

/// Failures of what must be said before a motion.
fn setting(failure: &Failure) -> Option<Text> {
    Some(match failure {
        Failure::Cancelled => say("APT0600", "the computation was cancelled"),
        Failure::NotFinite => say("APT0601", "a number of this statement is too large, or not a number"),
        Failure::NoCutter { .. } => say("APT0602", "there is no cutter")
            .hint("give CUTTER/diameter before the first motion; CUTTER/0 is a line"),
        Failure::NoPosition => say("APT0603", "the tool has no position yet").hint("begin with FROM/x,y,z"),
        Failure::ZeroAxis => say("APT0604", "the tool axis has no length"),
        Failure::ZeroDirection { number } => {
            let what = match number {
                6 => "INDIRP names the point where the tool is",
                8 => "a vector of SRFVCT has no length",
                _ => "the vector of INDIRV has no length",
            };
            say("APT0605", what).hint("a direction needs a vector that is not zero")
        }
        Failure::AxisUndetermined { cause, tip } => axis(cause, tip),
        Failure::SurfaceUnsupported { role: name, kind } => {
            say("APT0608", format!("{} cannot be a {}", a_kind(*kind), role(*name)))
        }
        Failure::SurfaceDegenerate { role: name, kind: GeometryKind::RuledSurface } => say(
            "APT0609",
            format!(
                "a curve of the {}, a RLDSRF, does not reach from one end point to the other",
                role(*name)
            ),
        ),
        Failure::SurfaceDegenerate { role: name, kind } => say(
            "APT0609",
            format!(
                "the {} is {} without extent: its canonical form is degenerate",
                role(*name),
                a_kind(*kind)
            ),
        ),
        Failure::SurfaceCount { found } => say("APT0610", format!("{found} surfaces cannot be met at once")),
        Failure::NoPartWithSeveral { found } => {
            say("APT0611", format!("NOPS allows one surface in the next GO, and there are {found}"))
                .hint("leave out NOPS, or the surfaces behind the first")
        }
        Failure::NoTolerance { role: name, inside, outside } => say(
            "APT0612",
            format!(
                "INTOL {} and OUTTOL {} leave no tolerance for the {}",
                number(*inside),
                number(*outside),
                role(*name)
            ),
        )
        .hint("at least one of INTOL and OUTTOL must be positive"),
        Failure::UndercutTooDeep { role: name, thickness, radius } => say(
            "APT0613",
            format!(
                "THICK {} for the {} is more than the radius of the cutter, {}: TO and PAST would be exchanged",
                number(*thickness),
                role(*name),
                number(*radius)
            ),
        )
        .hint("values of THICK are for part, drive and check surface in this order, and the last one is repeated"),
        _ => return None,
    })
}

/// Failures of a start-up motion, or before the first cut vector.
fn start(failure: &Failure) -> Option<Text> {
    Some(match failure {
        Failure::SideUnknown { role: name, distance } => say(
            "APT0620",
            format!("the tool stands on the {} ({} away), so its side is not known", role(*name), number(*distance)),
        )
        .hint("say it by SRFVCT, INDIRV or INDIRP, or start from farther away"),
        Failure::NotReachedAlong { role: name, from, direction } => say(
            "APT0621",
            format!("from {} along {} the {} is not met", place(from), place(direction), role(*name)),
        )
        .hint("correct INDIRV or INDIRP"),
        Failure::NoPositionAlong { relation: wanted, from, direction, found, narrow } => {
            let what = format!(
                "from {} along {} there is no position {} the drive surface",
                place(from),
                place(direction),
                relation(*wanted)
            );
            say("APT0621", what).hint(match (narrow, found) {
                (Some([tool, circle]), _) => format!(
                    "the tool of radius {} does not fit into the circle of radius {}",
                    number(*tool),
                    number(*circle)
                ),
                (None, 0) => "correct INDIRV or INDIRP".to_owned(),
                (None, _) => "there is one behind the tool, or with TO and PAST exchanged".to_owned(),
            })
        }
        Failure::ParallelPlanes { roles: [one, other], apart } => say(
            "APT0624",
            format!(
                "the {} and the {} are parallel planes, {} apart, so there is no position at both",
                role(*one),
                role(*other),
                number(*apart)
            ),
        )
        .hint(match (one, other) {
            (RoleName::Drive, RoleName::Part) => "choose a drive surface that stands on the part surface",
            _ => "choose a check surface that cuts the others",
        }),
        Failure::OffsetWithoutDirection => {
            say("APT0622", "OFFSET needs a direction").hint("give INDIRV or INDIRP towards the drive surface before it")
        }
        Failure::PartNotReached => say("APT0623", "the part surface is not met along the tool axis").hint("check PSIS and AUTOPS"),
        Failure::StartUpDiverges { residual, role: name, tip, iterations } => say(
            "APT0624",
            format!(
                "no position was found in {iterations} steps: at {} the {} is still {} off",
                place(tip),
                role(*name),
                number(*residual)
            ),
        )
        .hint("start closer, or give a direction by INDIRV that leads to such a position"),
        Failure::BehindEnd { role: name, tip, place: at } => say(
            "APT0624",
            format!(
                "no position was found but those behind an end: at {} the tool would touch the end of the {} at {} from behind",
                place(tip),
                role(*name),
                place(at)
            ),
        )
        .hint("start closer, give a direction by INDIRV that leads to another position, or define a larger surface"),
        Failure::StartUpAmbiguous { places: [first, second] } => say(
            "APT0628",
            format!("the start-up has more than one answer: {} and {} are equally near", place(first), place(second)),
        )
        .hint("give a direction by INDIRV, or start nearer to one of them"),
        Failure::OutOfToleranceAtStart { role: name, clearance, inside, outside, contact } => say(
            "APT0625",
            format!(
                "at the start of the cut the tool is {} from the {}, and {} to {} is allowed",
                number(*clearance),
                role(*name),
                number(-inside),
                number(*outside)
            ),
        )
        .hint(format!(
            "the tool end is at {}, the nearest point of the surface at {}; the GO before must reach the relation that TLLFT, TLRGT, TLON, TLONPS or TLOFPS asks for",
            place(&contact.tip),
            place(&contact.surface)
        )),
        Failure::NoForwardDirection => {
            say("APT0626", "the tool has no forward direction yet").hint("give INDIRV/i,j,k before this statement")
        }
        Failure::DirectionUndetermined { angle, tangent, .. } => say(
            "APT0627",
            format!(
                "the direction word does not decide, for it points across the path: the path runs along {1}, and a right angle is only {0}° away",
                number(angle.to_degrees()),
                place(tangent)
            ),
        )
        .hint("use GOLFT, GORGT, GOFWD or GOBACK as the path turns, or give INDIRV"),
        _ => return None,
    })
}

/// A check surface that the tool, or some vectors alone, are in or out of again by too little to be told from a touch.
fn only_touched(wanted: Relation, at: &Vec3, depth: f64) -> Text {
    let side = match wanted {
        Relation::Past => "in it",
        Relation::On => "beyond it",
        _ => "out of it again",
    };
    let how_far =
        if depth > 0.0 { format!(", {side} by no more than {}", number(depth)) } else { String::new() };
    let words = format!(
        "the surface to stop at is never met {}: up to {} the tool only touches it{how_far}",
        relation(wanted),
        place(at)
    );
    say("APT0641", words).hint(
        "it is less than a fiftieth of the tolerances, or cut vectors alone are so far, beside the path that they follow; TO ends where a touch begins",
    )
}

/// Failures on the way.
fn path(failure: &Failure) -> Text {
    match failure {
        Failure::TangentSurfaces { tip } => say(
            "APT0640",
            format!("part and drive surface are tangent at {}, so there is no path between them", place(tip)),
        )
        .hint("choose a drive surface that stands on the part surface"),
        Failure::NeverMet { relation, is_touched: true, nearest, at, .. } => {
            only_touched(*relation, at, *nearest)
        }
        Failure::NeverMet { relation: wanted, nearest, at, is_there, turns_back, course, .. } => say(
            "APT0641",
            if *is_there {
                format!(
                    "the surface to stop at is never met {}: the tool is there at {}, but begins so, leaves the surface, gets around its end or only touches it",
                    relation(*wanted),
                    place(at)
                )
            } else {
                format!(
                    "the surface to stop at is never met: the nearest approach to {} is {} at {}",
                    relation(*wanted),
                    number(*nearest),
                    place(at)
                )
            },
        )
        .hint(match (course, turns_back) {
            (Course::Analytic, _) => "check the direction and the surface".to_owned(),
            (Course::Parallel, _) => "drive and check surface are parallel lines".to_owned(),
            (Course::Concentric, _) => "drive and check surface are circles about one centre".to_owned(),
            (Course::Closed { length }, _) => {
                format!("the path closes after {}: check the surface", number(*length))
            }
            (Course::Away { .. }, Some(corner)) => {
                format!(
                    "the path turns back at {}, where the tool comes to a second wall: is it too wide there?",
                    place(&corner.at)
                )
            }
            (Course::Away { travelled }, None) => {
                format!("it was followed for {}: check the direction and the surface", number(*travelled))
            }
        }),
        Failure::NoneAhead { relation: wanted, found, .. } => {
            let there = match found {
                0 => "there is no such position elsewhere".to_owned(),
                1 => "there is one position elsewhere".to_owned(),
                _ => format!("there are {found} positions elsewhere"),
            };
            say("APT0642", format!("ahead there is no position {} the surface to stop at", relation(*wanted)))
                .hint(format!("{there}; the direction may be wrong, or TO and PAST exchanged"))
        }
        Failure::NotTangent { gap, .. } => {
            let parallel = "where the path is parallel to the check surface";
            let words = if !gap.is_finite() {
                "ahead the path is nowhere parallel to the check surface, so that the tool cannot stop tangent to it".to_owned()
            } else if *gap < 0.0 {
                format!("{parallel} the tool does not touch it, but is {} deep in it", number(-gap))
            } else {
                format!("{parallel} the tool does not touch it, but is {} away from it", number(*gap))
            };
            say("APT0643", words)
        }
        .hint("use TO, ON or PAST"),
        Failure::TangentLines { .. } => {
            say("APT0644", "two lines cannot be tangent").hint("use TO, ON or PAST")
        }
        Failure::ParallelThroughout { .. } => say(
            "APT0652",
            "the path runs along the check surface from its beginning to its end, so that the tangency has no place on it",
        )
        .hint("use ON with a line or plane across the path"),
        Failure::ToolTooLarge { tool, circle } => say(
            "APT0645",
            format!(
                "the tool of radius {} does not fit into the circle of radius {}",
                number(*tool),
                number(*circle)
            ),
        ),
        Failure::TooManyPoints { limit, maximum_step, remaining, at } => say(
            "APT0646",
            format!(
                "after {limit} cut vectors the check surface is still {} away, at {}",
                number(*remaining),
                place(at)
            ),
        )
        .hint(match f64::from(*limit) * maximum_step {
            farthest if farthest < *remaining => format!(
                "MAXDP {} lets that many lead no farther than {}: MAXDP/n allows longer ones, NUMPTS/n more",
                number(*maximum_step),
                number(farthest)
            ),
            _ => "the check surface may lie the other way; NUMPTS/n allows more cut vectors".to_owned(),
        }),
        Failure::IterationLimit { iteration, limit, tip } => say(
            "APT0647",
            format!(
                "{} did not come to an end in {limit} steps at {}",
                iteration_name(*iteration),
                place(tip)
            ),
        )
        .hint("the surfaces may be nearly tangent here; start closer or loosen the tolerance"),
        Failure::NoAdmissibleVector { role: name, clearance, tip } => say(
            "APT0648",
            format!(
                "from {} no cut vector keeps the tolerance of the {}: the shortest tried is {} off",
                place(tip),
                role(*name),
                number(*clearance)
            ),
        )
        .hint("the tool may touch the surface at a second place, or the tolerance is too tight"),
        Failure::NoProgress { vectors, length, tip } => say(
            "APT0653",
            format!(
                "the path hardly goes on at {}: the last {vectors} cut vectors are no longer than {}",
                place(tip),
                number(*length)
            ),
        )
        .hint("a surface may end or fold there: stop earlier, give the other direction, or widen the tolerance"),
        Failure::SurfaceEnds { role: name, place: at, remaining, .. } => {
            let text =
                say("APT0649", format!("the path comes to the end of the {} at {}", role(*name), place(at)));
            match remaining {
                Some(distance) => text.hint(format!(
                    "the surface to stop at is still {} away: check the direction, stop earlier, or define a larger surface",
                    number(*distance)
                )),
                None => text.hint("check the direction, stop earlier, or define a larger surface"),
            }
        }
        other => say("APT0699", format!("{other}")),
    }
}

fn iteration_name(iteration: Iteration) -> &'static str {
    match iteration {
        Iteration::StartUp => "the search for the start-up position",
        Iteration::TwoSurfaces => "the search for a position on part and drive surface",
        Iteration::ThreeSurfaces => "the search for the position at the check surface",
        Iteration::StepLength => "the search for the length of a cut vector",
        Iteration::Stop => "the search for the check surface",
        Iteration::FinalVector => "the search for the last cut vector",
    }
}

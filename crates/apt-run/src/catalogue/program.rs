//! Words for labels, loops, macros, motion statements, post-processor statements and the program as a whole
//! (codes 04xx, 05xx, 08xx, 09xx), and the door to the other groups of Section 1.

use apt_program::finding::{ControlFinding, FindingKind as Kind, SynonymFault};
use smol_str::SmolStr;

use super::{Text, a_kind, definitions, names, number, say, sculptured, similar, syntax};

/// The words of a finding of Section 1.
pub(super) fn word(kind: &Kind) -> Text {
    if let Kind::Syntax(error) = kind {
        return syntax::word(error);
    }
    names::word(kind)
        .or_else(|| definitions::word(kind))
        .or_else(|| jump(kind))
        .or_else(|| macro_call(kind))
        .or_else(|| motion(kind))
        .or_else(|| sculptured::word(kind))
        .or_else(|| postprocessor(kind))
        .unwrap_or_else(|| whole(kind))
}

/// Whether a finding marks code without effect.
pub(super) fn is_unnecessary(kind: &Kind) -> bool {
    matches!(kind, Kind::Unused { .. } | Kind::AfterEnd | Kind::Unreachable)
}

fn jump(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::Control(ControlFinding::DuplicateLabel { name }) => {
            say("APT0401", format!("the label {name} stands twice in this part of the program"))
        }
        Kind::Control(ControlFinding::LabelIsName { name }) => {
            say("APT0402", format!("{name} is the name of something else and cannot be a label"))
        }
        Kind::Control(ControlFinding::UnknownLabel { name, similar: names }) => {
            say("APT0403", format!("there is no label {name} here"))
                .hint("write it, with a closing parenthesis, before the statement to go on with; a jump stays inside its loop or macro")
                .maybe(similar(names))
        }
        Kind::Control(ControlFinding::JumpOutsideRegion) => {
            say("APT0404", "IF and JUMPTO work inside loops and macros only")
                .hint("put the statements between LOOPST and LOOPND")
        }
        Kind::Control(ControlFinding::UnknownTransfer { name }) => {
            say("APT0405", format!("no statement of the path carries the label {name}"))
                .hint("put the label before a motion or post-processor statement")
        }
        Kind::Control(ControlFinding::NestedLoop) => say("APT0406", "LOOPST cannot stand inside a loop")
            .hint(
                "one pair of LOOPST and LOOPND may hold several counters, or put the inner loop into a macro",
            ),
        Kind::Control(ControlFinding::LoopEndAlone) => {
            say("APT0407", "LOOPND without LOOPST").hint("add LOOPST, or remove LOOPND")
        }
        Kind::Control(ControlFinding::LoopInMacro) => {
            say("APT0408", "LOOPST and LOOPND cannot stand in a macro")
                .hint("IF and JUMPTO work in a macro without them")
        }
        Kind::Control(ControlFinding::LoopNotClosed) => {
            say("APT0409", "this loop is never closed").hint("add LOOPND")
        }
        Kind::Control(ControlFinding::LoopsCross { label, outer }) => {
            say("APT0411", format!("the DO loop to {label} ends behind the loop to {outer} around it"))
                .hint(format!("put the statement {label}) before {outer}), or end both loops at one label"))
        }
        Kind::Control(ControlFinding::LoopCrossesBranch { label }) => say(
            "APT0439",
            format!("the DO loop to {label} begins in one branch of an IF and ends in another"),
        )
        .hint(format!("put the DO and the statement {label}) into the same branch")),
        Kind::Control(ControlFinding::ClauseWithoutIf { word }) => {
            say("APT0435", format!("{word} without an IF"))
                .hint(format!("IF(condition)THEN stands before it, on a line of its own; or remove {word}"))
        }
        Kind::Control(ControlFinding::ClauseAfterElse { word }) => {
            say("APT0436", format!("{word} behind the ELSE of the same IF"))
                .hint("ELSE opens the last branch: ELSEIF stands before it, ENDIF behind it")
        }
        Kind::Control(ControlFinding::BranchNotClosed) => {
            say("APT0437", "this IF is never closed").hint("add ENDIF")
        }
        Kind::Control(ControlFinding::JumpIntoBranch { name }) => {
            say("APT0438", format!("{name} stands in a branch of an IF that this jump does not come from"))
                .hint("a branch is entered through its IF only; jumps may lead out of it")
        }
        Kind::Control(ControlFinding::Endless { statements, changing, unchanged }) => {
            let what = match (unchanged.as_slice(), changing.as_slice()) {
                ([], []) => "no condition of the loop depends on a name that changes".to_owned(),
                ([], changing) => format!("{} changed in the last turn", changing.join(", ")),
                (unchanged, []) => format!(
                    "{} decides how the loop ends and did not change in the last turn",
                    unchanged.join(", ")
                ),
                (unchanged, changing) => format!(
                    "{} decides how the loop ends and did not change in the last turn; {} did",
                    unchanged.join(", "),
                    changing.join(", ")
                ),
            };
            say("APT0410", format!("{statements} statements were executed and no end is in sight"))
                .hint(format!("{what}; the setting budget.statements allows more"))
        }
        _ => return None,
    })
}

fn macro_call(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::Control(ControlFinding::MacroInRegion) => say("APT0420", "a macro cannot be defined inside a loop or another macro"),
        Kind::Control(ControlFinding::MacroNotClosed { name }) => {
            say("APT0421", format!("the macro {name} is never closed")).hint("add TERMAC")
        }
        Kind::Control(ControlFinding::MacroEndAlone) => say("APT0422", "TERMAC without MACRO")
            .hint("the statement that begins the macro may have a mistake"),
        Kind::Control(ControlFinding::EndInRegion) => {
            say("APT0423", "FINI stands inside a loop or macro").hint("TERMAC or LOOPND is missing before it")
        }
        Kind::Control(ControlFinding::MacroNameUsed { name }) => {
            say("APT0424", format!("{name} is in use already and cannot name a macro"))
        }
        Kind::Control(ControlFinding::MacroVariableCount { found, limit }) => {
            say("APT0425", format!("the macro has {found} variables; this dialect takes {limit}"))
        }
        Kind::Control(ControlFinding::MacroVariableTwice { name }) => {
            say("APT0426", format!("the macro variable {name} stands twice"))
        }
        Kind::Control(ControlFinding::UnknownMacro { name, similar: names }) => say("APT0427", format!("there is no macro {name}"))
            .hint("a macro must stand before its first CALL")
            .maybe(similar(names)),
        Kind::Control(ControlFinding::UnknownMacroVariable { name, parameter, known }) => {
            let hint = if known.is_empty() {
                "it has no variables".to_owned()
            } else {
                format!("it has {}", known.join(", "))
            };
            say("APT0428", format!("the macro {name} has no variable {parameter}")).hint(hint)
        }
        Kind::Control(ControlFinding::MacroVariableMissing { name, parameter }) => {
            say("APT0429", format!("{parameter} of the macro {name} has neither a value nor a default"))
                .hint(format!("add {parameter}=… to the CALL"))
        }
        Kind::Control(ControlFinding::MacroValueMissing { parameter }) => say("APT0430", format!("{parameter} needs = and a value")),
        Kind::Control(ControlFinding::MacroDepth { name, limit }) => {
            say("APT0433", format!("the CALL of {name} is nested deeper than {limit}"))
                .hint("the macro may call itself; the setting budget.macro-depth allows more")
        }
        Kind::Control(ControlFinding::RoutineNotAvailable { name }) => say("APT0434", format!("the routine {name} is not available")),
        Kind::SynonymPairs { found } => {
            let operands = if *found == 1 { "is 1 operand" } else { "are {} operands" };
            say(
                "APT0440",
                format!("SYN takes pairs, and there {}", operands.replace("{}", &found.to_string())),
            )
        }
        Kind::SynonymInRegion => say("APT0441", "SYN cannot stand in a loop or macro"),
        Kind::SynonymCount { limit } => say("APT0442", format!("there are more than {limit} synonyms")),
        Kind::SynonymKind { first, second, fault } => say(
            "APT0443",
            format!("SYN/{first},{second} does not pair a new name with a word of the language"),
        )
        .hint(match fault {
            SynonymFault::NoSymbol => "both are written as they are: a name, and the word that it shall stand for",
            SynonymFault::NotNew => "the new name is no word and not in use; the first pair fixes the order of all pairs",
            SynonymFault::NotWord => {
                "a word of the language other than SYN is renamed; the first pair fixes the order of all pairs"
            }
        }),
        _ => return None,
    })
}

fn motion(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::ModifierOnDrive { word } => {
            say("APT0501", format!("{word} cannot stand before the drive surface"))
                .hint("where the tool is relative to the drive surface is said by TLLFT, TLRGT or TLON")
        }
        Kind::ImpliedCheckVertical => {
            say("APT0502", "GOUP and GODOWN need their check surface in the statement")
                .hint("add the check surface after the drive surface")
        }
        Kind::ImpliedCheckBroken { word } => say(
            "APT0503",
            format!("{word} comes while a motion waits for its check surface"),
        )
        .hint(
            "the motion before takes the drive surface of the next motion as its check surface; write it out",
        ),
        Kind::ImpliedCheckOpen => say("APT0504", "FINI comes while a motion waits for its check surface")
            .hint("write the check surface in the last motion statement"),
        Kind::CheckLabelComputed => {
            say("APT0505", "a label is a name without a value, or a number as it stands: this is computed")
        }
        Kind::CheckLabels => say("APT0505", "two check surfaces need a label each, and none takes two")
            .hint("the form is GOLFT/ds,TO,cs1,label1,TO,cs2,label2"),
        Kind::SurfaceCount { found, limit } => {
            say("APT0506", format!("there are {found} surfaces; at most {limit} can stand here"))
        }
        Kind::RelationNotHere { word } => say("APT0507", format!("{word} cannot stand before this surface")),
        Kind::PatternList { number: apt3, value, points } => {
            let value = value.map(|value| format!(" {}", number(value))).unwrap_or_default();
            say("APT0508", format!("the operand{value} does not fit a pattern of {points} points")).hint(
                match apt3 {
                    812 => "it must be the number of one of its points",
                    811 => "OMIT and RETAIN exclude each other",
                    838 => "numbers must rise in the order of output",
                    835 => "ZIGZAG needs a PARLEL pattern",
                    _ => "the order is INVERS, ZIGZAG, CONST, then OMIT or RETAIN, and AVOID",
                },
            )
        }
        Kind::AxisDropped { word } => say("APT0511", format!("the axis of this {word} is dropped"))
            .hint("write MULTAX before it, so that tool axes count"),
        Kind::AxisUndocumented { word } => {
            let meaning = match word.as_str() {
                "NORMPS" | "NORMDS" => {
                    "the axis is kept along the normal, in planes across the vector; a number behind it has no meaning"
                }
                "PERPTO" => "the axis is kept along the drive surface and across the vector",
                "TANDS" => "the axis is kept along the drive surface, in planes across the motion",
                _ => "the axis turns evenly until it lies along the drive surface where the motion ends",
            };
            say("APT0512", format!("APT III does not document this form of TLAXIS/{word}"))
                .hint(format!("as in later systems, {meaning}"))
        }
        Kind::PocketNumbers => say("APT0509", "POCKET begins with eight numbers"),
        Kind::PocketPoints { found } => {
            say("APT0510", format!("POCKET takes 3 to 20 points behind its eight numbers, not {found}"))
        }
        _ => return None,
    })
}

fn postprocessor(kind: &Kind) -> Option<Text> {
    Some(match kind {
        Kind::PostGeometry { word, kind, .. } => {
            say("APT0801", format!("{word} cannot take {}", a_kind(*kind)))
        }
        Kind::PostBare { word } => say("APT0802", format!("{word} takes no parameters")),
        Kind::MachineName => say("APT0803", "MACHIN needs the name of a post-processor first"),
        Kind::MachineCount { limit } => {
            say("APT0804", format!("there are more than {limit} MACHIN statements"))
        }
        Kind::TransformForm { found } => {
            say("APT0701", format!("TRACUT needs a matrix or NOMORE, not {}", names::found(found)))
        }
        Kind::CopyCount { found, expected } => {
            say("APT0702", format!("the statement has {found} parameters where {expected} are needed"))
        }
        Kind::CopyOption { found } => {
            say("APT0703", format!("COPY needs SAME, TRANSL, XYROT or MODIFY, not {}", names::found(found)))
        }
        _ => return None,
    })
}

fn whole(kind: &Kind) -> Text {
    match kind {
        Kind::EndMissing => {
            say("APT0901", "the program does not end with FINI").hint("add FINI on a line of its own")
        }
        Kind::AfterEnd => say("APT0902", "statements after FINI are not executed"),
        Kind::Unreachable => say("APT0903", "this statement is never reached"),
        Kind::Control(ControlFinding::SegmentInRegion) => say("APT0913", "READ/2 cannot stand in a loop or macro").hint(
            "put the statements in before the loop or macro, or make them a macro of their own and call it",
        ),
        Kind::Control(ControlFinding::SegmentInSegment) => {
            say("APT0914", "the statements that READ/2 puts in cannot hold another READ/2")
                .hint("read both blocks in the program; the dialect free puts in blocks within blocks")
        }
        Kind::Control(ControlFinding::SystemMacroInSegment { name }) => say(
            "APT0915",
            format!("the statements that READ/2 puts in cannot hold the first CALL of {name}, a macro of the library"),
        )
        .hint("call the macro once before; the dialect free takes it anywhere"),
        Kind::MotionSkipped => say("APT0911", "no motion is computed, because PTONLY/1 says so")
            .hint("remove the statement to get the cutter path"),
        Kind::RestartNotAvailable { number } => say(
            "APT0912",
            format!("PTONLY/{number} goes on from the files of an earlier run, and none are kept"),
        )
        .hint(match number {
            2 => "the whole program is run; to use a CL file again, give that file to the command `post`",
            _ => "the whole program is run; leave out what is done by statements of the program",
        }),
        Kind::NoEffect { word } => say("APT0904", format!("{word} has no effect here")),
        Kind::Control(ControlFinding::NotInDialect { word }) => say("APT0905", format!("{word} is not supported in this dialect"))
            .hint("another dialect is set in apt-lsp.toml or by a first line `$$ apt-lsp: dialect=…`"),
        Kind::Control(ControlFinding::IncludeNotFound { name, searched }) => {
            let hint = match searched.as_slice() {
                [] => "the setting include lists the folders that are searched".to_owned(),
                folders => format!(
                    "searched: {}; the setting include names more folders",
                    folders.iter().map(SmolStr::as_str).collect::<Vec<_>>().join(", ")
                ),
            };
            say("APT0906", format!("{name} cannot be found")).hint(hint)
        }
        Kind::Control(ControlFinding::IncludeUnreadable { path, reason }) => {
            say("APT0907", format!("{path} cannot be included: {reason}"))
        }
        Kind::Control(ControlFinding::IncludeCycle { name, through }) => {
            let way = through.iter().map(SmolStr::as_str).collect::<Vec<_>>().join(" includes ");
            say("APT0908", format!("{name} would include itself")).hint(format!("the program includes {way}"))
        }
        Kind::Cards { fault } => say("APT0909", format!("READ/1 finds no dump behind it: {fault}")).hint(
            "PUNCH writes the cards; they stand behind the READ, the LOOPND or the CALL, and END is the last",
        ),
        Kind::CardSort { name } => say(
            "APT0910",
            format!("{name} is a number in one place and geometry in the other, and READ cannot change that"),
        )
        .hint("give another name in READ/1,name"),
        // The other groups have taken the rest.
        other => say("APT0999", format!("{other}")),
    }
}

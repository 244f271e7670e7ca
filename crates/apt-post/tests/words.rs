//! Every post-processor word of the language is on the tape or passed through, and neither in silence where it matters.

use apt_cldata::text::read_text;
use apt_post::{
    MachineDefinition, PostFindingKind, PostOptions, Severity, Tape, Treatment, machine, post, treatment,
};

/// The words of the language with parameters and without, and those of the CL dialects.
const WORDS: &str = "
    AIR ARCSLP ASLOPE AUXFUN CAMERA CHECK CLAMP CLEARP CLRSRF COOLNT CORNFD COUPLE CUTCOM CYCLE DELAY DELETE DISPLY
    DRAFT DWELL FEDRAT HEAD IFRO INTCOD LEADER LETTER LOADTL LPRINT MAGTAP MAXDPM MAXVEL MCHFIN MCHTOL MDEND MDWRIT
    MODE MOVETO OPSKIP ORIGIN OVPLOT PBS PITCH PIVOTZ PLABEL PLOT PLUNGE POSTN PPLOT PREFUN REGBRK REVERS REWIND
    ROTABL ROTHED SAFETY SELCTL SEQNO SLOWDN SPINDL THREAD TMARK TOOLNO TRANS TURRET VTLAXS WCORN
    END STOP OPSTOP ISTOP RAPID SWITCH RETRCT DRESS PICKUP UNLOAD PENUP PENDWN ZERO GOHOME RESET GOCLER DRAWLI PROBY
    PROBX ULOCKX LOCKX FACEML
    BREAK TPRINT LOAD SELECT SET OFSTNO LINTOL PPTOL SMOOTH PPFUN PALLET ALIGN ROTATE POSITN CHUCK TAILST SADDLE";

/// Statements that stand before the word under test, so that it has all it needs.
const BEFORE: &str = "UNITS/MM\nFROM/0,0,50\nLOADTL/1\nCUTTER/10\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\nCLEARP/40\nRAPID\nGOTO/0,0,10\n";

/// A statement of every word that is on the tape, in a form of the language, with what follows it, and text that the
/// tape then has and without the statement has not.
const ON_TAPE: &[(&str, &str, &str)] = &[
    ("ARCSLP/LINCIR,OFF", "", ""),
    ("AUXFUN/8", "", "M8"),
    ("CLEARP/XYPLAN,30", "RETRCT\n", "Z30."),
    ("CLRSRF/30", "RETRCT\n", "Z30."),
    ("COOLNT/MIST", "", "M7"),
    ("CUTCOM/LEFT,3", "GOTO/10,0,10\nCUTCOM/OFF\nGOTO/20,0,10\n", "G41"),
    ("CYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,2", "GOTO/10,0,0\nCYCLE/OFF\n", "G81"),
    ("DELAY/2", "", "G4 P2"),
    ("DELETE/ON", "GOTO/10,0,10\n", "/N"),
    ("DISPLY/HELLO", "", "(MSG,HELLO)"),
    ("DWELL/2", "", "G4 P2"),
    ("END", "", ""),
    ("FEDRAT/55,MMPM", "GOTO/10,0,10\n", "F55."),
    ("GOCLER", "", "Z40."),
    ("GOHOME", "", "G53"),
    ("ISTOP", "", "M1"),
    ("LOAD/TOOL,7", "", "T7"),
    ("LOADTL/7", "", "T7"),
    ("MCHTOL/.5", "", ""),
    ("OFSTNO/9", "GOTO/10,0,10\n", "H9"),
    ("OPSKIP/ON", "GOTO/10,0,10\n", "/N"),
    ("OPSTOP", "", "M1"),
    ("ORIGIN/5,0,0", "GOTO/10,0,10\n", "X5."),
    ("PREFUN/61", "", "G61"),
    // Still in the rapid mode of the move before, without a feed.
    ("RAPID", "GOTO/10,0,10\n", " X10.\n"),
    ("RETRCT", "PLUNGE\n", "Z40."),
    ("REWIND", "", ""),
    ("SELCTL/6", "", "T6"),
    ("SELECT/TOOL,6", "", "T6"),
    ("SEQNO/500,INCR,5", "GOTO/10,0,10\n", "N500"),
    ("SET/LINEAR", "", ""),
    ("SPINDL/777,CLW", "", "S777"),
    ("STOP", "", "M0"),
    ("TOOLNO/7", "", "T7"),
    ("TRANS/5,0,0", "GOTO/10,0,10\n", "X15."),
    ("TURRET/7", "", "T7"),
    ("UNLOAD/TOOL", "", "T0"),
];

fn mill() -> MachineDefinition {
    machine("linuxcnc-mill3").expect("a machine of the house")
}

fn tape_of(statements: &str) -> Tape {
    let (records, errors) = read_text(&format!("{BEFORE}{statements}FINI\n"));
    assert!(errors.is_empty(), "{statements}: {errors:?}");
    post(&records, &mill(), &PostOptions::default())
}

#[test]
fn every_word_of_the_language_has_its_treatment() {
    for word in WORDS.split_whitespace() {
        let found = treatment(word).unwrap_or_else(|| panic!("{word} is not known"));
        let unsupported = PostFindingKind::NotSupported { word: word.into() };
        let tape = tape_of(&format!("{word}/1\n"));
        let no_axis = PostFindingKind::NoRotaryAxis { word: word.into() };
        let says_so = tape.findings.iter().any(|one| one.kind == unsupported || one.kind == no_axis);
        // A word on the tape may have forms that this machine cannot carry out (ARCSLP, SET).
        let expected = found == Treatment::NotSupported || (says_so && found == Treatment::OnTape);
        assert_eq!(says_so, expected, "{word}: {:?}", tape.findings);
        assert!(
            !tape.findings.iter().any(|finding| matches!(finding.kind, PostFindingKind::UnknownWord { .. }))
        );
    }
}

#[test]
fn words_on_the_tape_do_what_they_say() {
    for (statement, after, text) in ON_TAPE {
        let word = statement.split('/').next().unwrap();
        assert_eq!(treatment(word), Some(Treatment::OnTape), "{word}");
        let (with, without) = (tape_of(&format!("{statement}\n{after}")), tape_of(""));
        assert!(with.is_ok(), "{statement}: {:?}", with.findings);
        assert!(with.text().contains(text), "{statement}: no {text} in\n{}", with.text());
        assert!(text.is_empty() || !without.text().contains(text), "{text} is there without {statement}");
    }
    // None is left out; PLUNGE stands after RETRCT, the texts are tested with the programs, what turns with the machines that do.
    for word in WORDS.split_whitespace().filter(|word| treatment(word) == Some(Treatment::OnTape)) {
        let tested = ON_TAPE.iter().any(|(statement, _, _)| statement.split('/').next() == Some(word));
        let turns = matches!(word, "LINTOL" | "MAXDPM" | "PIVOTZ" | "ROTABL" | "ROTATE" | "ROTHED");
        assert!(tested || turns || matches!(word, "PLUNGE" | "TPRINT"), "{word} has no test");
    }
}

#[test]
fn unknown_words_pass_through_with_a_note() {
    let tape = tape_of("CHIPCV/ON\n");
    let [finding] = tape.findings.as_slice() else { panic!("{:?}", tape.findings) };
    assert_eq!(finding.kind, PostFindingKind::UnknownWord { word: "CHIPCV".into() });
    assert_eq!(finding.kind.severity(), Severity::Information);
}

#[test]
fn arguments_are_checked_against_the_machine_in_use() {
    let greatest = 60_000.0;
    let cases: Vec<(&str, PostFindingKind)> = vec![
        ("LOADTL/150\n", PostFindingKind::ToolOutsideMagazine { number: 150, least: 1, greatest: 99 }),
        ("SELCTL/150\n", PostFindingKind::ToolOutsideMagazine { number: 150, least: 1, greatest: 99 }),
        ("SPINDL/70000,CLW\n", PostFindingKind::SpindleOutOfRange { value: 70_000.0, least: 1.0, greatest }),
        (
            "FEDRAT/2E5,MMPM\n",
            PostFindingKind::FeedOutOfRange { value: 200_000.0, least: 0.001, greatest: 100_000.0 },
        ),
        // Per revolution at 1000 turns a minute.
        (
            "FEDRAT/200,MMPR\n",
            PostFindingKind::FeedOutOfRange { value: 200_000.0, least: 0.001, greatest: 100_000.0 },
        ),
        (
            "FEDRAT/MMPR,1,MAXIPM,10\n",
            PostFindingKind::FeedOutOfRange { value: 1000.0, least: 0.001, greatest: 254.0 },
        ),
        (
            "COOLNT/THRU\n",
            PostFindingKind::ArgumentNotUsed {
                word: "COOLNT".into(),
                argument: "THRU (flood instead)".into(),
            },
        ),
        (
            "SPINDL/500,CLW,CCLW\n",
            PostFindingKind::ArgumentConflict {
                word: "SPINDL".into(),
                first: "CLW".into(),
                second: "CCLW".into(),
            },
        ),
        ("DELAY/1,2\n", PostFindingKind::ArgumentNotUsed { word: "DELAY".into(), argument: "2".into() }),
        ("MACHIN/MILL\nMACHIN/LATHE\n", PostFindingKind::Repeated { word: "MACHIN".into() }),
        (
            "CYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,2\nGOTO/1,0,0\nLOADTL/2\n",
            PostFindingKind::CycleLeftOn { cycle: "DRILL".into(), word: "LOADTL".into() },
        ),
        (
            "CUTCOM/RIGHT,1\nGOTO/9,0,0\nLOADTL/2\n",
            PostFindingKind::CompensationLeftOn { word: "LOADTL".into() },
        ),
        ("CUTCOM/RIGHT,1\nGOTO/9,0,0\n", PostFindingKind::CompensationLeftOn { word: "FINI".into() }),
        (
            "CUTCOM/LEFT,1\nGOTO/9,0,0\nCYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,2\nGOTO/1,0,0\nGOTO/2,0,0\nCYCLE/OFF\nCUTCOM/OFF\nGOTO/0,0,0\n",
            PostFindingKind::CompensationLeftOn { word: "CYCLE".into() },
        ),
        ("FROM/0,0,60\n", PostFindingKind::Repeated { word: "FROM".into() }),
        ("ROTABL/90\n", PostFindingKind::NoRotaryAxis { word: "ROTABL".into() }),
        ("ROTHED/ATANGL,90\n", PostFindingKind::NoRotaryAxis { word: "ROTHED".into() }),
        ("SPINDL/OFF\nCOOLNT/ON\n", PostFindingKind::CoolantBeforeSpindle),
        ("RAPID\nCYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,2\nGOTO/1,0,0\nCYCLE/OFF\n", PostFindingKind::RapidUnused),
        (
            "RAPID\nGOTO/5,0,0\nCYCLE/DRILL,DEPTH,5,MMPM,50,CLEAR,2\nCIRCLE/0,0,0,0,0,1,5\nGOTO/0,5,0\nCYCLE/OFF\n",
            PostFindingKind::CycleOnArc { cycle: "DRILL".into() },
        ),
    ];
    for (statements, kind) in cases {
        let tape = tape_of(statements);
        let found: Vec<_> = tape.findings.iter().filter(|finding| finding.kind == kind).collect();
        assert_eq!(found.len(), 1, "{statements}: {:?}", tape.findings);
        assert_eq!(kind.severity(), Severity::Warning, "{statements}");
    }
}

/// A statement, and the one finding about its argument.
fn only_finding(statements: &str) -> Option<PostFindingKind> {
    let tape = tape_of(statements);
    let [finding] = tape.findings.as_slice() else {
        assert!(tape.findings.is_empty(), "{statements}: {:?}", tape.findings);
        return None;
    };
    Some(finding.kind.clone())
}

#[test]
fn ranges_of_arguments_are_those_of_the_machine() {
    let outside = |word: &str, argument: &str, value: f64, least: f64, greatest: f64| {
        let (word, argument) = (word.into(), argument.into());
        Some(PostFindingKind::ArgumentOutOfRange { word, argument, value, least, greatest })
    };
    let most = 99_990.0;
    let cases = [
        ("SEQNO/100,INCR,5\n", None),
        ("SEQNO/100,INCR,5,3\n", None),
        ("SEQNO/-1\n", outside("SEQNO", "number", -1.0, 0.0, most)),
        ("SEQNO/100000\n", outside("SEQNO", "number", 100_000.0, 0.0, most)),
        ("SEQNO/1,INCR,-5\n", outside("SEQNO", "INCR", -5.0, 0.0, most)),
        ("SEQNO/1,INCR,5,0\n", outside("SEQNO", "blocks between numbers", 0.0, 1.0, most)),
        ("LEADER/500\n", None),
        ("LEADER/-1\n", outside("LEADER", "length", -1.0, 0.0, 15_240.0)),
        ("LEADER/15241\n", outside("LEADER", "length", 15_241.0, 0.0, 15_240.0)),
        ("DELAY/999999\n", None),
        ("DELAY/1000000\n", outside("DELAY", "time", 1e6, 0.0, 999_999.0)),
        ("OPSKIP/ON\nOPSKIP/OFF\n", None),
        ("OPSKIP/ON,1\nOPSKIP/OFF\n", None),
        ("OPSKIP/ON,10\n", outside("OPSKIP", "level", 10.0, 1.0, 9.0)),
        ("OPSKIP/ON,2\n", Some(PostFindingKind::SkipLevel { level: 2, levels: 1 })),
    ];
    for (statements, expected) in cases {
        assert_eq!(only_finding(statements), expected, "{statements}");
        assert!(tape_of(statements).is_ok(), "{statements}: the tape still runs");
    }
}

#[test]
fn sequence_numbers_follow_the_statement() {
    let numbers = |statement: &str| -> Vec<String> {
        let tape = tape_of(&format!("{statement}\nGOTO/10,0,10\nGOTO/20,0,10\nGOTO/30,5,10\nGOTO/40,0,10\n"));
        let text = tape.text();
        let lines =
            text.lines().filter(|line| ["X10.", "X20.", "X30.", "X40."].iter().any(|x| line.contains(x)));
        lines.map(|line| line.split(' ').next().unwrap().to_owned()).collect()
    };
    assert_eq!(numbers("SEQNO/500,INCR,5"), ["N500", "N505", "N510", "N515"]);
    assert_eq!(numbers("SEQNO/500,INCR,5,2"), ["N500", "X20.", "N505", "X40."]);
    assert_eq!(numbers("SEQNO/OFF")[0], "G1");
}

#[test]
fn levels_of_optional_blocks_are_those_of_the_control() {
    let text = format!("{BEFORE}OPSKIP/ON,3\nGOTO/10,0,10\nOPSKIP/OFF\nGOTO/20,0,10\nFINI\n");
    let (records, _) = read_text(&text);
    let post_for = |name: &str| post(&records, &machine(name).unwrap(), &PostOptions::default()).text();
    assert!(post_for("fanuc-mill3").contains("\n/3N"), "{}", post_for("fanuc-mill3"));
    assert!(post_for("linuxcnc-mill3").contains("\n/N") && !post_for("linuxcnc-mill3").contains("/3"));
}

#[test]
fn codes_that_the_post_processor_keeps_are_not_written_by_hand() {
    let group = |code: &str, group: &str| {
        let (code, group) = (code.into(), group.into());
        Some(PostFindingKind::FunctionInGroup { word: "PREFUN".into(), code, group })
    };
    let owner = |code: &str, owner: &str| {
        let (code, owner) = (code.into(), owner.into());
        Some(PostFindingKind::FunctionOfWord { word: "AUXFUN".into(), code, owner })
    };
    let cases = [
        ("PREFUN/61\n", None),
        ("PREFUN/64,NOW\n", None),
        ("PREFUN/91\n", group("G91", "distance")),
        ("PREFUN/33.1\n", group("G33.1", "motion")),
        ("PREFUN/20\n", group("G20", "unit")),
        ("AUXFUN/51\n", None),
        ("AUXFUN/3\n", owner("M3", "SPINDL")),
        ("AUXFUN/7\n", owner("M7", "COOLNT")),
        ("AUXFUN/6\n", owner("M6", "LOADTL")),
        ("AUXFUN/0\n", owner("M0", "STOP")),
        ("AUXFUN/2\n", owner("M2", "END")),
    ];
    for (statements, expected) in cases {
        assert_eq!(only_finding(statements), expected, "{statements}");
    }
}

#[test]
fn what_must_stand_before_what() {
    let findings = |text: &str| -> Vec<PostFindingKind> {
        let (records, errors) = read_text(text);
        assert!(errors.is_empty(), "{text}: {errors:?}");
        let tape = post(&records, &mill(), &PostOptions::default());
        tape.findings.into_iter().map(|finding| finding.kind).collect()
    };
    let start = "FROM/0,0,1\nSPINDL/500,CLW\nFEDRAT/5\n";
    let rest = "GOTO/1,0,0\nSPINDL/OFF\nFINI\n";
    // The tool that lies in the spindle may do the first part: then the program loads none before.
    assert_eq!(findings(&format!("{start}{rest}")), []);
    assert_eq!(findings(&format!("LOADTL/1\n{start}{rest}")), []);
    let late = findings(&format!("{start}GOTO/0,0,0\nSPINDL/OFF\nLOADTL/1\nSPINDL/500,CLW\n{rest}"));
    assert_eq!(late, [PostFindingKind::CuttingBeforeTool { isn: 6 }]);
    let hole =
        "RAPID\nGOTO/0,0,1\nCYCLE/DRILL,DEPTH,1,CLEAR,.1\nGOTO/0,0,0\nCYCLE/OFF\nSPINDL/OFF\nLOADTL/1\n";
    assert_eq!(
        findings(&format!("{start}{hole}SPINDL/500\n{rest}")),
        [PostFindingKind::CuttingBeforeTool { isn: 10 }]
    );
    let offset = findings(&format!("TOOLNO/ADJUST,3\n{start}{rest}"));
    assert_eq!(offset, [PostFindingKind::OffsetWithoutTool { word: "TOOLNO".into() }]);
    let off = findings(&format!("{start}CYCLE/OFF\n{rest}"));
    assert_eq!(off, [PostFindingKind::NothingOn { word: "CYCLE".into() }]);
    assert_eq!(off[0].severity(), Severity::Information);
    assert_eq!(findings(&format!("{start}CYCLE/NOMORE\n{rest}")), [], "patterns with AVOID say so");
    // The clearance of the cycle before holds on.
    let two = "RAPID\nGOTO/0,0,1\nCYCLE/DRILL,DEPTH,1,CLEAR,.1\nGOTO/0,0,0\nCYCLE/DRILL,DEPTH,.5\nGOTO/1,0,0\nCYCLE/OFF\n";
    assert_eq!(findings(&format!("{start}{two}SPINDL/OFF\nFINI\n")), []);
}

#[test]
fn the_length_offset_is_put_away_and_taken_up() {
    let tape = tape_of("TOOLNO/ADJUST,OFF\nTOOLNO/ADJUST,ON\nTOOLNO/ADJUST,7\n");
    assert_eq!(tape.findings, []);
    let text = tape.text();
    let at = |code: &str| text.find(code).unwrap_or_else(|| panic!("no {code} in\n{text}"));
    let off = text.rfind("G49").unwrap();
    assert!(off < text.rfind("G43 H1").unwrap() && text.rfind("G43 H1").unwrap() < at("G43 H7"), "{text}");
}

#[test]
fn texts_fit_on_a_card() {
    let line = |length: usize| format!("PPRINT {}\n", "A".repeat(length));
    assert_eq!(only_finding(&line(66)), None);
    assert_eq!(
        only_finding(&line(67)),
        Some(PostFindingKind::TextTooLong { word: "PPRINT".into(), length: 67, limit: 66 })
    );
    let (records, _) = read_text(&format!("{}FINI\n", line(67).replace("PPRINT", "PARTNO")));
    let kinds = |text_limit: usize| -> Vec<PostFindingKind> {
        let options = PostOptions { text_limit, ..PostOptions::default() };
        let tape = post(&records, &mill(), &options);
        tape.findings.into_iter().map(|finding| finding.kind).collect()
    };
    assert_eq!(kinds(80), []);
    assert_eq!(kinds(66), [PostFindingKind::TextTooLong { word: "PARTNO".into(), length: 67, limit: 66 }]);
}

#[test]
fn disply_switches_the_messages_of_the_tape() {
    let tape = tape_of("PPRINT ONE\nDISPLY/OFF\nPPRINT TWO\nDISPLY/THREE\nDISPLY/ON\nPPRINT FOUR\n");
    let text = tape.text();
    assert!(text.contains("(MSG,ONE)") && text.contains("(MSG,FOUR)"), "{text}");
    assert!(text.contains("(MSG,THREE)"), "a text of its own is no PPRINT: {text}");
    assert!(!text.contains("TWO"), "{text}");
    let text = tape_of("DISPLY/PUT ON THE CLAMP,  3 mm left\n").text();
    assert!(text.contains("(MSG,PUT ON THE CLAMP,  3 mm left)"), "{text}");
    let argument = |argument: &str| PostFindingKind::ArgumentNotUsed {
        word: "DISPLY".into(),
        argument: argument.into(),
    };
    assert_eq!(only_finding("DISPLY/AUTO\n"), Some(argument("AUTO")));
    assert_eq!(only_finding("DISPLY/NIXIE,3\n"), Some(argument("NIXIE")));
    let missing =
        PostFindingKind::MissingArgument { word: "DISPLY".into(), missing: "ON, OFF or a text".into() };
    assert_eq!(only_finding("DISPLY\n"), Some(missing));
}

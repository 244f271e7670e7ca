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
    post(&records, &mill(), &PostOptions::default(), &|| false).expect("nobody cancels")
}

#[test]
fn every_word_of_the_language_has_its_treatment() {
    for word in WORDS.split_whitespace() {
        let found = treatment(word).unwrap_or_else(|| panic!("{word} is not known"));
        let unsupported = PostFindingKind::NotSupported { word: word.into() };
        let tape = tape_of(&format!("{word}/1\n"));
        let says_so = tape.findings.iter().any(|finding| finding.kind == unsupported);
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
    // None is left out; PLUNGE stands after RETRCT, the texts are tested with the programs.
    for word in WORDS.split_whitespace().filter(|word| treatment(word) == Some(Treatment::OnTape)) {
        let tested = ON_TAPE.iter().any(|(statement, _, _)| statement.split('/').next() == Some(word));
        assert!(tested || matches!(word, "PLUNGE" | "TPRINT"), "{word} has no test");
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
        ("CUTCOM/RIGHT,1\nGOTO/9,0,0\nLOADTL/2\n", PostFindingKind::CompensationLeftOn),
    ];
    for (statements, kind) in cases {
        let tape = tape_of(statements);
        let found: Vec<_> = tape.findings.iter().filter(|finding| finding.kind == kind).collect();
        assert_eq!(found.len(), 1, "{statements}: {:?}", tape.findings);
        assert_eq!(kind.severity(), Severity::Warning, "{statements}");
    }
}

#[test]
fn a_tape_that_is_no_longer_wanted_is_not_made() {
    use std::sync::atomic::{AtomicUsize, Ordering};

    let mut text = BEFORE.to_owned();
    for step in 0..5_000 {
        text += &format!("GOTO/{step},{},0\n", step % 7);
    }
    let (records, _) = read_text(&text);
    let asked = AtomicUsize::new(0);
    let cancel = || asked.fetch_add(1, Ordering::Relaxed) >= 3;
    assert_eq!(post(&records, &mill(), &PostOptions::default(), &cancel), Err(apt_post::Cancelled));
    assert!(asked.load(Ordering::Relaxed) < 10, "the work went on after the answer");
}

//! Any bytes and any mistakes: a diagnostic with its place, never a panic, an endless run or a path that is no number.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::panic::{AssertUnwindSafe, catch_unwind};

use apt_ide::Analysis;
use apt_run::settings::{Budget, Settings};
use apt_tests::runs::{analysis, bounded, oracle_programs, path_of, read, report, title};
use proptest::prelude::*;
use serde_json::Value;

/// A program with a small budget, so that endless programs end soon.
fn limited(text: &str, dialect: &str) -> Analysis {
    let budget = Budget { statements: 20_000, points: 200_000, ..Budget::default() };
    let settings = Settings { dialect: Some(dialect.to_owned()), budget, ..Settings::default() };
    Analysis::new(text, Some("test.apt".to_owned()), &settings.into())
}

/// Runs a program and looks at everything that is said about it; the report if all is well.
fn survive(text: &str, dialect: &str) -> Result<Value, String> {
    let analysis = limited(text, dialect);
    let report = report(&analysis).map_err(|endless| format!("{endless:?}"))?;
    let statements = analysis.document().tree().statement_count() as u64;
    let lines = text.split('\n').count() as u64;
    for one in report["diagnostics"].as_array().into_iter().flatten() {
        let isn = one["isn"].as_u64().unwrap();
        if isn == 0 || isn > statements.max(1) {
            return Err(format!("no such statement: {one}"));
        }
        let (start, end) = (&one["range"]["start"], &one["range"]["end"]);
        let place = |place: &Value| (place["line"].as_u64().unwrap(), place["character"].as_u64().unwrap());
        // Lone carriage returns end lines too.
        let most = lines + text.matches('\r').count() as u64;
        if place(start) > place(end) || place(end).0 >= most {
            return Err(format!("no such place: {one}"));
        }
        let code = one["code"].as_str().unwrap();
        if apt_ide::explain(code).is_none() {
            return Err(format!("no page: {one}"));
        }
        if one["message"].as_str().unwrap().trim().is_empty() {
            return Err(format!("no words: {one}"));
        }
    }
    finite_path(&report)?;
    Ok(report)
}

/// A coordinate that is no number would be null in JSON.
fn finite_path(report: &Value) -> Result<(), String> {
    for entry in report["cl"].as_array().into_iter().flatten() {
        for point in entry["points"].as_array().into_iter().flatten() {
            if !point.as_array().unwrap().iter().all(|number| number.as_f64().is_some_and(f64::is_finite)) {
                return Err(format!("a position that is no number: {entry}"));
            }
        }
    }
    Ok(())
}

/// Answers for editors at an offset; whatever they are, they come.
fn ask_everything(text: &str, dialect: &str, offset: usize) {
    let analysis = limited(text, dialect);
    bounded(|cancel| analysis.hover(offset, cancel)).unwrap();
    bounded(|cancel| analysis.canonical_form(offset, cancel)).unwrap();
    bounded(|cancel| analysis.expand(Some(offset), None, cancel)).unwrap();
    bounded(|cancel| analysis.scene(cancel, &mut |_, _| {})).unwrap();
    let tape = bounded(|cancel| {
        analysis.tape("linuxcnc-mill3", cancel, &mut |_, _| {}).map_err(|_| apt_ide::Cancelled)
    });
    assert!(!tape.unwrap().tape.text().contains("NaN"));
    analysis.completions(offset, &|| false).unwrap();
    analysis.occurrences(offset, &|| false).unwrap();
    analysis.definitions_at(offset, &|| false).unwrap();
    let _ = analysis.rename(offset, "X9", &|| false);
    for fold in analysis.folds(&|| false).unwrap() {
        assert!(fold.range.start <= fold.range.end && fold.range.end <= text.len(), "{fold:?}");
    }
    for lens in analysis.lenses(&|| false).unwrap() {
        assert!(lens.range.start <= lens.range.end && lens.range.end <= text.len(), "{lens:?}");
    }
    for entry in analysis.outline(&|| false).unwrap() {
        assert!(entry.range.start <= entry.range.end && entry.range.end <= text.len(), "{entry:?}");
    }
    for token in analysis.tokens(None, &|| false).unwrap() {
        assert!(token.range.start < token.range.end && token.range.end <= text.len(), "{token:?}");
    }
}

fn diagnostics(text: &str) -> Vec<Value> {
    survive(text, "free").unwrap()["diagnostics"].as_array().unwrap().clone()
}

/// The first error is at this statement.
fn error_at(text: &str, isn: u64) {
    told_at(text, isn, "error");
}

/// The first finding of a severity is at this statement.
fn told_at(text: &str, isn: u64, severity: &str) {
    let found = diagnostics(text);
    let first = found.iter().find(|one| one["severity"] == severity);
    assert_eq!(first.map(|one| one["isn"].as_u64().unwrap()), Some(isn), "{text}\n{found:#?}");
}

#[test]
fn endless_programs_end_at_their_budget() {
    // Where the budget ended is where it is told; the loop is the place from which it came.
    let found = diagnostics("PARTNO\nLOOPST\nA)X=1\nJUMPTO/A\nLOOPND\nFINI\n");
    let told = found.iter().find(|one| one["code"] == "APT0410").unwrap();
    assert!([3, 4].contains(&told["isn"].as_u64().unwrap()), "{told}");
    assert_eq!((&told["origin"][0]["kind"], &told["origin"][0]["isn"]), (&"loop".into(), &2.into()));
    assert_eq!(told["related"][0]["range"]["start"]["line"], 1);
    for text in [
        "M=MACRO/X\nCALL/M,X=X\nTERMAC\nCALL/M,X=1\nFINI\n",
        "M=MACRO\nCALL/N\nTERMAC\nN=MACRO\nCALL/M\nTERMAC\nCALL/M\nFINI\n",
        "M=MACRO\nLOOPST\nA)X=1\nJUMPTO/A\nLOOPND\nTERMAC\nCALL/M\nCALL/M\nFINI\n",
        "FROM/0,0,0\nI=0\nLOOPST\nA)I=I+1\nGOTO/I,0,0\nIF(1)A,A,A\nLOOPND\nFINI\n",
    ] {
        let found = diagnostics(text);
        assert!(found.iter().any(|one| one["severity"] == "error"), "{text}\n{found:#?}");
    }
}

#[test]
fn arithmetic_without_a_value_is_a_mistake_at_its_statement() {
    for expression in [
        "1/0",
        "0/0",
        "LOGF(0)",
        "LOGF(-1)",
        "SQRTF(-1)",
        "1E300*1E300",
        "10**400",
        "1E999",
        "(-8)**.5",
        "EXPF(1000)",
        "0**(-1)",
        "-1E308-1E308",
    ] {
        error_at(&format!("PARTNO\nA=1\nX={expression}\nFROM/0,0,0\nFINI\n"), 3);
    }
    // A name without a value taints what uses it, but not the path.
    let report = survive("PARTNO\nX=1/0\nFROM/0,0,0\nGOTO/X,0,0\nGOTO/1,1,1\nFINI\n", "free").unwrap();
    assert_eq!(path_of(&report).last().unwrap().at, [1.0, 1.0, 1.0]);
}

#[test]
fn degenerate_geometry_is_a_mistake_at_its_statement() {
    for definition in [
        "LINE/1,1,1,1",
        "PLANE/0,0,0,1",
        "CYLNDR/0,0,0,0,0,0,1",
        "PLANE/(POINT/0,0,0),(POINT/1,1,1),(POINT/2,2,2)",
        "CONE/(POINT/0,0,0),(VECTOR/0,0,0),30",
        "POINT/INTOF,(LINE/0,0,1,0),(LINE/0,1,1,1)",
        "CIRCLE/(POINT/0,0),(POINT/1,0),(POINT/2,0)",
        "VECTOR/UNIT,(VECTOR/0,0,0)",
    ] {
        error_at(&format!("PARTNO\nG1={definition}\nFINI\n"), 2);
    }
    // APT III takes radii and axes that are not positive, and so do we, with a warning.
    for definition in [
        "CIRCLE/0,0,0",
        "CIRCLE/0,0,-1",
        "SPHERE/0,0,0,0",
        "SPHERE/0,0,0,-2",
        "ELLIPS/CENTER,(POINT/0,0),0,1,0",
    ] {
        told_at(&format!("PARTNO\nG1={definition}\nFINI\n"), 2, "warning");
    }
}

#[test]
fn motion_without_what_it_needs_is_a_mistake_at_its_statement() {
    let lines = "PARTNO\nL1=LINE/0,0,1,0\nL2=LINE/3,0,3,1\n";
    error_at(&format!("{lines}FROM/0,-2,0\nGO/TO,L1\nFINI\n"), 5);
    let contour = format!("{lines}CUTTER/.5\n");
    error_at(&format!("{contour}GO/TO,L1\nFINI\n"), 5);
    error_at(&format!("{contour}GOFWD/L1,PAST,L2\nFINI\n"), 5);
    error_at(&format!("{contour}GODLTA/1,0,0\nFINI\n"), 5);
    error_at(&format!("{contour}FROM/0,-2,0\nGO/TO,L9\nFINI\n"), 6);
    error_at(&format!("{contour}FROM/0,-2,0\nGO/TO,L1\nGORGT/L1\nFINI\n"), 8);
    // Statements that give no tolerance band, no tool or no room.
    for (severity, statements) in [
        ("error", "INTOL/0\nOUTTOL/0\n"),
        ("error", "CUTTER/-1\n"),
        ("error", "MAXDP/0\n"),
        ("error", "NUMPTS/0\n"),
        // It counts as zero, and OUTTOL is still there.
        ("warning", "INTOL/-1\n"),
    ] {
        let text = format!("{contour}{statements}FROM/0,-2,0\nGO/TO,L1\nTLRGT,GORGT/L1,PAST,L2\nFINI\n");
        let found = diagnostics(&text);
        assert!(found.iter().any(|one| one["severity"] == severity), "{statements}");
    }
}

#[test]
fn deep_nesting_ends_with_a_diagnostic() {
    for depth in [10, 1_000, 200_000] {
        for (open, inner, close) in [
            ("(", "1", ")"),
            ("(-", "1", ")"),
            ("SQRTF(", "1", ")"),
            ("(POINT/", "1,1", ")"),
            ("-", "1", ""),
            ("(", "", ""),
            (")", "", ""),
            ("A(", "1", ")"),
            ("1+(", "1", ")"),
            ("2**", "1", ""),
        ] {
            let text = format!("PARTNO\nX={}{inner}{}\nY=7\nFINI\n", open.repeat(depth), close.repeat(depth));
            let report = survive(&text, "free").unwrap_or_else(|wrong| panic!("{open} {depth}: {wrong}"));
            assert_eq!(report["symbols"]["Y"]["canonical"][0], 7.0, "{open} {depth}");
            if depth == 200_000 {
                let told = report["diagnostics"].as_array().unwrap();
                assert!(
                    told.iter().any(|one| one["isn"] == 2 && one["severity"] == "error"),
                    "{open}: {told:?}"
                );
            }
        }
    }
    let loops = format!("{}{}FINI\n", "LOOPST\n".repeat(5_000), "LOOPND\n".repeat(5_000));
    survive(&loops, "free").unwrap();
    let macros = format!("{}{}FINI\n", "M=MACRO\n".repeat(5_000), "TERMAC\n".repeat(5_000));
    survive(&macros, "free").unwrap();
    let chain: String = (0..5_000).map(|n| format!("M{n}=MACRO\nCALL/M{}\nTERMAC\n", n + 1)).collect();
    survive(&format!("{chain}CALL/M0\nFINI\n"), "free").unwrap();
}

#[test]
fn numbers_of_any_size_are_no_path_without_a_word() {
    for number in ["1E308", "-1E308", "1E-320", "1E16", "99999999999999999999999999999999999999999"] {
        for text in [
            format!("FROM/0,0,0\nGOTO/{number},0,0\nGODLTA/{number},{number},0\nFINI\n"),
            format!(
                "CUTTER/{number}\nC=CIRCLE/0,0,{number}\nFROM/9,0,0\nGO/TO,C\nTLLFT,GOLFT/C,ON,(LINE/YAXIS)\nFINI\n"
            ),
            format!("OUTTOL/{number}\nS=SPHERE/{number},0,0,2\nFROM/9,0,0\nGO/TO,S\nFINI\n"),
            format!(
                "L=LINE/0,0,{number},{number}\nP=POINT/INTOF,L,(LINE/YAXIS)\nQ=PLANE/{number},0,0,{number}\nFINI\n"
            ),
            format!("T=MATRIX/SCALE,{number}\nTRACUT/T\nFROM/1,1,1\nGOTO/{number},1,1\nFINI\n"),
            format!("INDEX/1\nFROM/0,0,0\nGOTO/1,1,1\nCOPY/1,SAME,{number}\nFINI\n"),
            format!("A=RESERV/{number}\nRESERV/B,{number}\nB({number})=1\nFINI\n"),
        ] {
            survive(&text, "free").unwrap_or_else(|wrong| panic!("{text}: {wrong}"));
        }
    }
}

/// Mutations of a program that leave most of it as it was.
fn mutations(text: &str) -> Vec<(String, String)> {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    let without =
        |index: usize| lines.iter().enumerate().filter(move |(at, _)| *at != index).map(|(_, line)| *line);
    let middle = text.floor_char_boundary(text.len() / 2);
    let mut list = vec![
        ("first half".to_owned(), text[..middle].to_owned()),
        ("second half".to_owned(), text[middle..].to_owned()),
        ("lines reversed".to_owned(), lines.iter().rev().copied().collect()),
        ("twice".to_owned(), text.repeat(2)),
        ("no commas".to_owned(), text.replace(',', " ")),
        ("numbers negated".to_owned(), text.replace(['/', ','], ",-")),
        ("zeros".to_owned(), text.replace(['1', '2', '3', '4', '5'], "0")),
        ("other senses".to_owned(), text.replace("LFT", "RGT").replace("PAST", "TO")),
        ("no line ends".to_owned(), text.replace('\n', "")),
        ("continued".to_owned(), text.replace('\n', "$\n")),
    ];
    for index in (1..lines.len()).step_by(3) {
        list.push((format!("without line {}", index + 1), without(index).collect()));
    }
    list
}

#[test]
fn every_oracle_program_survives_every_mutation() {
    let mut failures = Vec::new();
    let mut count = 0;
    for (dialect, path) in oracle_programs() {
        let text = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
        for (what, mutated) in mutations(&text) {
            count += 1;
            match catch_unwind(AssertUnwindSafe(|| survive(&mutated, dialect))) {
                Ok(Ok(_)) => {}
                Ok(Err(wrong)) => failures.push(format!("{} {what}: {wrong}", title(&path))),
                Err(_) => failures.push(format!("{} {what}: panic", title(&path))),
            }
        }
    }
    assert!(count > 3_000, "{count} programs");
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn every_oracle_program_answers_an_editor_everywhere() {
    for (dialect, path) in oracle_programs().into_iter().step_by(4) {
        let text = read(&path);
        let middle = text.floor_char_boundary(text.len() / 2);
        for offset in [0, middle, text.len(), text.len() + 7] {
            let asked = catch_unwind(AssertUnwindSafe(|| ask_everything(&text, dialect, offset)));
            assert!(asked.is_ok(), "{} at {offset}", title(&path));
        }
    }
}

fn some_program() -> impl Strategy<Value = (&'static str, String)> {
    let programs: Vec<_> = oracle_programs()
        .into_iter()
        .map(|(dialect, path)| (dialect, String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned()))
        .collect();
    prop::sample::select(programs)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_a_program_with_mistakes(bytes in prop::collection::vec(any::<u8>(), 0..2_000)) {
        let text = String::from_utf8_lossy(&bytes);
        for dialect in ["free", "apt3", "apt4", "cl"] {
            let report = survive(&text, dialect);
            prop_assert!(report.is_ok(), "{:?}", report);
        }
    }

    #[test]
    fn any_words_are_a_program_with_mistakes(
        words in prop::collection::vec(prop::sample::select(vec![
            "POINT", "LINE", "CIRCLE", "PLANE", "SPHERE", "CYLNDR", "CONE", "TABCYL", "MATRIX", "VECTOR", "PATERN", "GO", "GOLFT",
            "GOFWD", "GOTO", "GODLTA", "FROM", "TO", "ON", "PAST", "TANTO", "INTOF", "XLARGE", "PARLEL", "PERPTO", "CENTER", "RADIUS",
            "LOOPST", "LOOPND", "MACRO", "TERMAC", "CALL", "IF", "JUMPTO", "TRACUT", "COPY", "INDEX", "SAME", "LAST", "NOMORE", "REFSYS",
            "ZSURF", "CUTTER", "INTOL", "THICK", "POCKET", "SCALE", "TRANSL", "XYROT", "SQRTF", "CANON", "RESERV", "OBTAIN", "A", "B",
            "C1", "0", "1", "2.5", "-1", "1E9", "/", "/", ",", ",", "=", "=", "(", ")", "+", "*", "**", "\n", "\n", "\n", "$\n", "$$", ";",
        ]), 0..300),
    ) {
        let text = words.concat();
        let report = survive(&text, "free");
        prop_assert!(report.is_ok(), "{:?}\n{}", report, text);
    }

    #[test]
    fn mutated_programs_are_survived(
        (dialect, mut text) in some_program(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..8, "[ -~\n]{0,4}"), 1..6),
    ) {
        for (at, length, insert) in edits {
            let start = text.floor_char_boundary(at.index(text.len() + 1));
            let end = text.floor_char_boundary((start + length).min(text.len())).max(start);
            text.replace_range(start..end, &insert);
        }
        let report = survive(&text, dialect);
        prop_assert!(report.is_ok(), "{:?}\n{}", report, text);
        ask_everything(&text, dialect, text.len() / 3);
    }
}

#[test]
fn good_programs_are_good_with_a_small_budget_too() {
    let report = survive("PARTNO\nFROM/0,0,0\nGOTO/1,1,1\nFINI\n", "free").unwrap();
    assert_eq!(report["ok"], true);
    assert_eq!(apt_tests::runs::report(&analysis("FINI\n", "free")).unwrap()["ok"], true);
}

//! The JSON of a run has the shape that scripts and editors rely on.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::{collections::BTreeSet, sync::Arc};

use apt_run::{document::Document, settings::Settings};
use serde_json::{Value, json};

const PROGRAM: &str = "\
PARTNO SAMPLE
CUTTER/.5
OUTTOL/.001
C1=CIRCLE/0,0,2
L1=LINE/XAXIS
A=-0.
HOLE=MACRO/X
GOTO/X,P9,0
TERMAC
SPINDL/1000,CLW
MULTAX/ON
MULTAX/OFF
FROM/5,-.5,0
GO/TO,C1
TLLFT,GOLFT/C1,$
ON,L1
CALL/HOLE,X=1
FINI
";

fn report(text: &str, statements: Option<std::ops::RangeInclusive<u32>>) -> Value {
    let settings = Settings { dialect: Some("free".to_owned()), ..Settings::default() };
    let document = Document::new(text, Some("sample.apt".to_owned()), &Arc::new(settings));
    let report = document.report(&|| false, &mut |_, _| {}, statements).unwrap();
    serde_json::to_value(report).unwrap()
}

fn keys(value: &Value) -> BTreeSet<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn the_report_has_its_fixed_fields() {
    let value = report(PROGRAM, None);
    assert!(
        keys(&value)
            .is_superset(&["program", "ok", "diagnostics", "symbols", "cl", "motions", "totals"].into())
    );
    assert_eq!(value["program"], json!("sample.apt"));
    assert_eq!(value["ok"], json!(false));
    let totals = ["points", "length", "cut_length", "rapid_length", "time_minutes", "box"];
    assert_eq!(keys(&value["totals"]), totals.into());
    assert!(value["totals"]["box"][0].as_array().unwrap().len() == 3);
    assert_eq!(report("A=1\nFINI\n", None)["totals"]["box"], Value::Null, "no path, no box");
}

#[test]
fn what_the_program_lists_is_reported() {
    let value = report("A=2\nPRINT/3,A\nTITLES TOP\nFINI\n", None);
    let listing = json!([
        { "isn": 2, "lines": ["A SCALAR 1", "  2.000000"] },
        { "isn": 3, "lines": [" TOP"] },
    ]);
    assert_eq!(value["listing"], listing);
    assert_eq!(report("A=2\nPRINT/3,A\nTITLES TOP\nFINI\n", Some(3..=3))["listing"], json!([listing[1]]));
}

#[test]
fn the_numbers_of_a_loft_are_listed() {
    let value = report("S1=LOFT/CANON,1,2,3,4,5,6,7,8\nPRINT/3,S1\nFINI\n", None);
    let lines = json!([
        "S1 LOFT 8",
        "  1.000000 2.000000 3.000000 4.000000 5.000000 6.000000 7.000000",
        "  8.000000"
    ]);
    assert_eq!(value["listing"], json!([{ "isn": 2, "lines": lines }]));
}

#[test]
fn a_diagnostic_says_where_it_is_and_how_it_came_there() {
    let value = report(PROGRAM, None);
    let errors: Vec<&Value> = value["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|diagnostic| diagnostic["severity"] == "error")
        .collect();
    let [error] = errors.as_slice() else { panic!("{errors:?}") };
    let fields =
        ["code", "severity", "message", "isn", "apt3", "file", "range", "origin", "related", "hint", "fixes"];
    assert_eq!(keys(error), fields.into());
    assert_eq!(error["code"], "APT0101");
    assert_eq!(error["isn"], 8);
    assert_eq!(error["apt3"], 101);
    assert_eq!(error["file"], "sample.apt");
    let place = json!({ "start": { "line": 7, "character": 7 }, "end": { "line": 7, "character": 9 } });
    assert_eq!(error["range"], place);
    assert_eq!(error["origin"], json!([{ "kind": "macro", "name": "HOLE", "isn": 16, "turn": 1 }]));
}

#[test]
fn symbols_and_numbers_are_canonical() {
    let value = report(PROGRAM, None);
    assert_eq!(value["symbols"]["C1"]["type"], "CIRCLE");
    assert_eq!(value["symbols"]["C1"]["canonical"], json!([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0]));
    assert_eq!(value["symbols"]["A"]["canonical"], json!([0.0]));
    assert!(!value.to_string().contains("-0.0,") && !value.to_string().contains("-0.0]"), "{value}");
}

#[test]
fn cl_records_have_their_types() {
    let value = report(PROGRAM, None);
    let list = value["cl"].as_array().unwrap();
    let types: BTreeSet<&str> = list.iter().map(|entry| entry["type"].as_str().unwrap()).collect();
    assert_eq!(types, ["postprocessor", "control", "mode", "from", "go", "other", "fini"].into());
    for entry in list {
        let allowed = ["isn", "line", "type", "surface", "words", "code", "points"].into();
        assert!(keys(entry).is_subset(&allowed), "{entry}");
    }
    let spindle = list.iter().find(|entry| entry["words"][0] == "SPINDL").unwrap();
    assert_eq!(spindle["words"], json!(["SPINDL", 1000.0, "CLW"]));
    let cutter = list.iter().find(|entry| entry["words"][0] == "CUTTER").unwrap();
    assert_eq!((&cutter["type"], &cutter["code"]), (&json!("control"), &json!([6000, 6])));
    assert_eq!(list.last().unwrap()["type"], "fini");
}

#[test]
fn motions_are_proven_and_within_their_band() {
    let value = report(PROGRAM, None);
    let motions = value["motions"].as_array().unwrap();
    assert_eq!(motions.len(), 2, "GO and GOLFT");
    let motion = &motions[1];
    let fields = [
        "isn",
        "line",
        "statement",
        "cut_vectors",
        "minimum",
        "part",
        "drive",
        "check",
        "verified",
        "seconds",
    ];
    assert_eq!(keys(motion), fields.into());
    assert_eq!(motion["isn"], 15);
    assert_eq!(motion["statement"], "TLLFT,GOLFT/C1,ON,L1", "continued lines are joined");
    assert_eq!(motion["verified"], true);
    assert!(motion["cut_vectors"].as_u64().unwrap() >= motion["minimum"].as_u64().unwrap_or(1));
    let drive = &motion["drive"];
    assert_eq!(keys(drive), ["min", "max", "intol", "outtol"].into());
    let number = |name: &str| drive[name].as_f64().unwrap();
    assert!(number("min") >= -number("intol") - 1e-9 && number("max") <= number("outtol") + 1e-9, "{drive}");
}

#[test]
fn statements_are_told_as_they_were_written() {
    let text = "PARTNO S\nCUTTER/.5\nC1=CIRCLE/0,0,2\nFROM/5,-.5,0\n  Go / To, c1 $$ start\nTLLFT, GOLFT/C1,$ on\n   ON,(LINE/0,0,$\n\
                1,0)\nFINI\n";
    let value = report(text, None);
    let statements: Vec<_> = value["motions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|motion| motion["statement"].as_str().unwrap())
        .collect();
    assert_eq!(statements, ["Go / To, c1", "TLLFT, GOLFT/C1,ON,(LINE/0,0,1,0)"]);
}

#[test]
fn what_an_included_file_does_is_told_at_the_statement_that_includes_it() {
    let folder = std::env::temp_dir().join(format!("apt-run-report-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(
        folder.join("LIB.apt"),
        "$$ lib\n\n\nGOTO/1,2,3\nGOTO/NONE\nM1=MACRO\nGOTO/7,8,9\nTERMAC\n",
    )
    .unwrap();
    let settings = Settings { dialect: Some("free".to_owned()), ..Settings::default() };
    let file = folder.join("main.apt").display().to_string();
    let document = Document::new("INCLUD/LIB\nCALL/M1\nFINI\n", Some(file), &Arc::new(settings));
    let value = document.report(&|| false, &mut |_, _| {}, None).unwrap();
    let value = serde_json::to_value(value).unwrap();
    let isns: Vec<_> =
        value["cl"].as_array().unwrap().iter().map(|entry| entry["isn"].as_u64().unwrap()).collect();
    assert_eq!(isns, [1, 2, 3]);
    let error = &value["diagnostics"][0];
    assert_eq!((&error["isn"], &error["range"]["start"]["line"]), (&json!(1), &json!(0)));
    assert_eq!(error["origin"][0], json!({ "kind": "include", "name": "LIB", "isn": 1, "turn": 1 }));
    let related = &error["related"][0];
    assert!(related["file"].as_str().unwrap().ends_with("LIB.apt"), "{related}");
    assert_eq!(related["range"]["start"], json!({ "line": 4, "character": 5 }), "{error}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_range_of_statements_restricts_path_and_motions() {
    let value = report(PROGRAM, Some(14..=14));
    assert_eq!(value["motions"].as_array().unwrap().len(), 1);
    assert!(value["cl"].as_array().unwrap().iter().all(|entry| entry["isn"] == 14));
    assert!(!value["cl"].as_array().unwrap().is_empty());
    assert_eq!(keys(&value["symbols"]), keys(&report(PROGRAM, None)["symbols"]), "symbols stay");
}

#[test]
fn a_range_of_statements_holds_what_they_call() {
    let text = "PARTNO R\nM=MACRO/X\nRAPID,GOTO/X,0,0\nFEDRAT/10\nGOTO/X,5,0\nTERMAC\nFROM/0,0,0\nCALL/M,X=1\n\
        LOOPST\nI=2\nA)CALL/M,X=I\nI=I+1\nIF(I-4)A,B,B\nB)LOOPND\nFINI\n";
    let points = |from, to| {
        let value = report(text, Some(from..=to));
        let listed = value["cl"].as_array().unwrap().iter().filter_map(|entry| entry["points"].as_array());
        let listed = listed.flatten().map(|point| (point[0].as_f64(), point[1].as_f64())).collect::<Vec<_>>();
        assert_eq!(value["totals"]["points"], json!(listed.len()), "{from} to {to}");
        (listed, value["totals"].clone())
    };
    let at = |x: f64, y: f64| (Some(x), Some(y));
    // Its macro is written above it, the path is that of the CALL. It begins where the tool stood.
    let (called, totals) = points(8, 8);
    assert_eq!(called, [at(1.0, 0.0), at(1.0, 5.0)]);
    assert_eq!((&totals["rapid_length"], &totals["cut_length"]), (&json!(1.0), &json!(5.0)));
    assert_eq!((&totals["time_minutes"], &totals["box"][1]), (&json!(0.5), &json!([1.0, 5.0, 0.0])));
    // The turns of a loop belong to it, to its statements, and to the statements of the macro.
    let loops = [at(2.0, 0.0), at(2.0, 5.0), at(3.0, 0.0), at(3.0, 5.0)];
    assert_eq!(points(9, 9).0, loops);
    assert_eq!(points(11, 11).0, loops);
    assert_eq!(points(5, 5).0, [at(1.0, 5.0), at(2.0, 5.0), at(3.0, 5.0)]);
    assert_eq!(points(1, 6).1["points"], json!(6));
    assert_eq!(points(12, 12).1["box"], Value::Null);
}

#[test]
fn no_number_is_a_negative_zero() {
    let text = "CUTTER/.5,.25\nINTOL/.0001\nOUTTOL/.0001\nS1=SPHERE/0,0,0,5\nDS=PLANE/0,1,0,1\nFROM/-3,0,7\n\
        GO/ON,DS,TO,S1,ON,(PLANE/1,0,0,-2)\nTLON,GORGT/DS,ON,(PLANE/1,0,0,3)\nFINI\n";
    let value = report(text, None);
    assert_eq!(value["motions"].as_array().unwrap().len(), 2, "{value}");
    assert!(value["motions"][0]["drive"]["min"].is_number(), "{value}");
    assert!(!value.to_string().contains("-0.0,") && !value.to_string().contains("-0.0}"), "{value}");
}

#[test]
fn a_cl_file_tells_copies_and_does_not_make_them_again() {
    let run = |text: &str| {
        let settings = Settings { dialect: Some("cl".to_owned()), ..Settings::default() };
        let document = Document::new(text, Some("a.cl".to_owned()), &Arc::new(settings));
        let report = document.report(&|| false, &mut |_, _| {}, None).unwrap();
        serde_json::to_value(report).unwrap()
    };
    let value = run(
        "PARTNO C\nFROM/0,0,0\nTRACUT/1,0,0,0,0,1,0,0,0,0,1,5\nINDEX/1\nGOTO/1,0,5\nINDEX/1\nGOTO/2,0,5\n\
        COPY/1,MODIFY,1,0,0,1,0,1,0,0,0,0,1,0,1\nTRACUT/NOMORE\nGOTO/3,0,0\nFINI\n",
    );
    assert_eq!((&value["diagnostics"], &value["totals"]["points"]), (&json!([]), &json!(4)));
    let words: Vec<_> = value["cl"].as_array().unwrap().iter().map(|one| &one["words"][0]).collect();
    let edits = ["TRACUT", "INDEX", "INDEX", "COPY", "TRACUT"];
    assert_eq!(words.into_iter().filter(|word| edits.iter().any(|edit| *word == edit)).count(), 5);
    let value = run("FROM/0,0,0\nGOTO/1,0,5\nCOPY/1,SAME,2\nFINI\n");
    assert_eq!((&value["diagnostics"][0]["isn"], &value["totals"]["points"]), (&json!(3), &json!(2)));
}

#[test]
fn records_and_motions_tell_their_lines_calls_and_turns() {
    let text = "PARTNO R\nM=MACRO/X\nGOTO/X,$\n0,0\nTERMAC\nFROM/0,0,0\nLOOPST\nI=2\nA)CALL/M,X=I\nI=I+1\nIF(I-4)A,B,B\n\
        B)LOOPND\nFINI\n";
    let value = report(text, None);
    let moves: Vec<_> = value["cl"].as_array().unwrap().iter().filter(|one| one["type"] == "go").collect();
    assert_eq!(moves.iter().map(|one| &one["line"]).collect::<Vec<_>>(), [2, 2], "{value}");
    let called = json!({ "kind": "macro", "name": "M", "isn": 8, "turn": 1 });
    let turned = |turn| json!({ "kind": "loop", "name": "", "isn": 6, "turn": turn });
    assert_eq!(moves[0]["origin"], json!([called, turned(1)]));
    assert_eq!(moves[1]["origin"], json!([called, turned(2)]));
    let from = value["cl"].as_array().unwrap().iter().find(|one| one["type"] == "from").unwrap();
    assert_eq!((&from["line"], from.get("origin"), from.get("file")), (&json!(5), None, None));
    assert!(report(PROGRAM, None)["motions"].as_array().unwrap().iter().all(|one| one["line"].is_u64()));
}

#[test]
fn a_path_keeps_the_budget_of_positions() {
    let run = |text: &str, points: u64| {
        let mut settings = Settings { dialect: Some("free".to_owned()), ..Settings::default() };
        settings.budget.points = points;
        let document = Document::new(text, Some("a.apt".to_owned()), &Arc::new(settings));
        let report = document.report(&|| false, &mut |_, _| {}, None).unwrap();
        let told: Vec<_> = report.diagnostics.iter().map(|one| (one.code.clone(), one.isn)).collect();
        (told, report.totals.points)
    };
    let moves = "FROM/0,0,0\nGOTO/1,0,0\nGOTO/2,0,0\nGOTO/3,0,0\nFINI\n";
    assert_eq!(run(moves, 4), (vec![], 4));
    assert_eq!(run(moves, 2), (vec![("APT0717".to_owned(), 3)], 2), "told once, where it ends");
    let copies = "FROM/0,0,0\nINDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,1,0,0,3\nFINI\n";
    assert_eq!(run(copies, 5), (vec![], 5));
    assert_eq!(run(copies, 4), (vec![("APT0717".to_owned(), 4)], 2));
}

#[test]
fn a_cl_file_has_cutters_of_any_number_of_values() {
    let settings = Settings { dialect: Some("cl".to_owned()), ..Settings::default() };
    let text = "CUTTER/12,1,50\nCUTTER/10,2,3,2\nFROM/0,0,0\nGOTO/1,0,0\nFINI\n";
    let document = Document::new(text, Some("a.cl".to_owned()), &Arc::new(settings));
    let report = document.report(&|| false, &mut |_, _| {}, None).unwrap();
    let value = serde_json::to_value(report).unwrap();
    assert_eq!(value["diagnostics"], json!([]));
    assert_eq!(value["cl"][0]["words"], json!(["CUTTER", 12.0, 1.0, 50.0]));
    assert_eq!((&value["cl"][1]["type"], &value["cl"][1]["code"]), (&json!("control"), &json!([6000, 6])));
}

#[test]
fn words_of_a_finding_say_what_the_geometry_is() {
    let head = "CUTTER/10,2\nINTOL/.001\nOUTTOL/.001\nC1=PLANE/1,0,.3,20\nL1=LINE/XAXIS\n";
    let cases = [
        // Only left by the tool that begins ON it.
        (
            "PL=PLANE/0,0,1,0\nFROM/-40,-40,0\nINDIRV/1,1,0\nGO/ON,C1,TO,PL,TO,L1\nINDIRV/1,0,0\nTLLFT,GOFWD/L1,TO,C1\n",
            [
                "APT0641",
                "never met TO: the tool is there at (24.4880613",
                "begins so, leaves the surface",
                "PAST here ends",
            ],
        ),
        // On the uphill side the rim cuts whatever the place.
        (
            "PL=PLANE/.2,0,1,0\nGOUGCK/ON\nFROM/-40,-40,0\nINDIRV/1,1,0\nGO/ON,(LINE/-20,0,-20,9),ON,PL,TO,L1\n\
             INDIRV/1,0,0\nTLLFT,TLONPS,GOFWD/L1,ON,C1\n",
            ["APT0665", "deep into the part surface", "is ON the surface", "TLOFPS keeps all of it out"],
        ),
        // Vectors are in it by less than they may be elsewhere.
        (
            "CUTTER/2\nINTOL/.02\nOUTTOL/.01\nS=SPHERE/0,0,0,10\nFROM/0,-15,0\nINDIRV/0,1,0\nGO/TO,S,TO,(PLANE/0,0,1,0)\n\
             INDIRV/1,0,0\nTLRGT,GOFWD/S,PAST,(CIRCLE/16.99,0,5)\n",
            ["APT0641", "never met PAST: up to (10.99", "the tool only touches it", "TO here ends at"],
        ),
        // Ten across in a neck of nine.
        (
            "PL=PLANE/0,0,1,0\nH=HYPERB/CENTER,(POINT/0,0),4.5,9,0\nFROM/0,-20,0\nINDIRV/-1,0,0\n\
             GO/TO,H,TO,PL,ON,(LINE/0,-20,1,-20)\nINDIRV/0,1,0\nTLRGT,GOFWD/H,ON,(LINE/0,20,1,20)\n",
            ["APT0641", "never met", "the path turns back at (", "is it too wide there?"],
        ),
    ];
    for (program, [code, words @ ..]) in cases {
        let text = format!("{head}{program}FINI\n");
        let report = report(&text, None);
        let diagnostics = report["diagnostics"].as_array().unwrap();
        let finding = diagnostics.iter().find(|finding| finding["code"] == code);
        let finding = finding.unwrap_or_else(|| panic!("no {code}: {diagnostics:?}")).to_string();
        for part in words {
            assert!(finding.contains(part), "{part}: {finding}");
        }
    }
}

#[test]
fn a_missing_slash_is_told_as_such() {
    for (statement, form) in [
        ("JUMPTO", "JUMPTO/label"),
        ("JUMPTO,A", "JUMPTO/label"),
        ("TRANTO", "TRANTO/label"),
        ("DO", "DO/label,index=first,last,step"),
        ("OBTAIN,CIRCLE", "OBTAIN,CIRCLE/C1,X,Y"),
    ] {
        let report = report(&format!("{statement}\nFINI\n"), None);
        let first = &report["diagnostics"][0];
        assert_eq!(
            (&first["code"], &first["apt3"]),
            (&json!("APT0072"), &json!(155)),
            "{statement}: {first}"
        );
        assert!(first["hint"].as_str().unwrap().contains(form), "{statement}: {first}");
    }
    let report = report("OBTAIN\nFINI\n", None);
    assert_eq!(report["diagnostics"][0]["code"], json!("APT0063"), "{report}");
}

#[test]
fn dntcut_print_lists_the_points_that_it_keeps_from_the_path() {
    let text = "A=1\nPRINT/3,A\nCUTTER/.5\nFROM/0,0,5\nDNTCUT/PRINT\nGOTO/1,2,3\nDNTCUT\nGOTO/4,5,6\nCUT\n\
                PRINT/3,A\nMULTAX\nDNTCUT/PRINT\nP=POINT/1,1,1\nGOTO/P\nCUT\nGOTO/2,2,2\nFINI\n";
    let report = report(text, None);
    let scalar = json!(["A SCALAR 1", "  1.000000"]);
    let listing = json!([
        { "isn": 2, "lines": scalar },
        { "isn": 6, "lines": ["GOTO NOT ON THE PATH 1", "  1.000000 2.000000 3.000000"] },
        { "isn": 10, "lines": scalar },
        {
            "isn": 14,
            "lines": [
                "GOTO P NOT ON THE PATH 1",
                "  1.000000 1.000000 1.000000 0.000000 0.000000 1.000000"
            ]
        },
    ]);
    assert_eq!(report["listing"], listing);
    let points: Vec<&Value> = report["cl"].as_array().unwrap().iter().map(|one| &one["points"]).collect();
    assert!(!points.contains(&&json!([[1.0, 2.0, 3.0]])), "{points:?}");
}

#[test]
fn a_pocket_under_dntcut_print_is_listed_whole() {
    let text =
        "CUTTER/1\nFROM/5,3,2\nDNTCUT/PRINT\nPOCKET/.49,1,.8,5,10,8,1,1,0,0,0,8,0,0,8,5,0,0,5,0\nCUT\nFINI\n";
    let report = report(text, None);
    let lines = report["listing"][0]["lines"].as_array().unwrap();
    let head = lines[0].as_str().unwrap();
    assert_eq!(head, format!("GOTO POCKET NOT ON THE PATH {}", lines.len() - 1));
    assert!(lines.len() > 10, "{lines:?}");
}

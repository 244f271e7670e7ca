//! The same findings in every format.

use expect_test::expect;
use ropey::Rope;
use serde_json::{Value, json};

use super::super::program::Program;
use super::{Checked, Counts, github, human, json as json_report, outcome, sarif};
use crate::analysis::fake::FakeLanguage;
use crate::analysis::{Diagnostic, Fix, Language, OriginFrame, Related, Severity, Surroundings};
use crate::cli::Outcome;
use crate::convert::{Encoding, TextIndex};
use crate::settings::{Settings, Values};
use crate::source::TextForm;

const TEXT: &str = "PARTNO é😀\r\n$$ 😀 remark P1\r\n\tL1=LINE/P1,P9\r\nFINI";

fn checked(diagnostics: Vec<Diagnostic>) -> Vec<Checked> {
    let program = Program {
        name: "parts/a.apt".into(),
        index: TextIndex { rope: Rope::from_str(TEXT), encoding: Encoding::Utf16 },
        document: FakeLanguage::default().open(TEXT, None, &Values::new(), Surroundings::default()),
        settings: Settings::default(),
        form: Some(TextForm::Utf8),
        tape: None,
    };
    vec![Checked { program, diagnostics }]
}

fn place(text: &str) -> std::ops::Range<usize> {
    let at = TEXT.find(text).unwrap();
    at..at + text.len()
}

fn error() -> Diagnostic {
    Diagnostic {
        code: "APT0001".into(),
        severity: Severity::Error,
        message: "P9 has no value".into(),
        hint: Some("define P9 before this statement".into()),
        isn: Some(3),
        apt3: Some(5),
        range: place("P9"),
        origin: vec![OriginFrame {
            kind: "macro",
            name: "M".into(),
            isn: 9,
            turn: 1,
            range: Some(place("FINI")),
        }],
        related: vec![Related { message: "P1 is here".into(), range: place("P1") }],
        elsewhere: Vec::new(),
        unnecessary: false,
        fixes: vec![Fix {
            title: "Replace P9 by P1".into(),
            edits: vec![(place("P9"), "P1".into())],
            preferred: true,
        }],
    }
}

fn warning() -> Diagnostic {
    let range = TEXT.len()..TEXT.len();
    Diagnostic {
        severity: Severity::Warning,
        message: "the end".into(),
        hint: None,
        apt3: None,
        range,
        origin: Vec::new(),
        related: Vec::new(),
        elsewhere: Vec::new(),
        fixes: Vec::new(),
        ..error()
    }
}

#[test]
fn people_see_excerpts_carets_related_places_and_hints() {
    let text = human::text(&checked(vec![error(), warning()]));
    let plain = anstream::adapter::strip_str(&text).to_string();
    expect![[r#"
        error[APT0001]: P9 has no value
         --> parts/a.apt:3:13
          |
        3 |     L1=LINE/P1,P9
          |                ^^
          |
         ::: parts/a.apt:2:13
          |
        2 | $$ 😀 remark P1
          |              -- P1 is here
          |
          = note: in the macro M called at statement 9
          = note: APT III diagnostic 5
          = help: define P9 before this statement

        warning[APT0001]: the end
         --> parts/a.apt:4:5
          |
        4 | FINI
          |     ^

    "#]]
    .assert_eq(&plain);
}

#[test]
fn places_of_many_lines_and_endless_lines_are_shown_in_part() {
    let mut whole = warning();
    whole.range = 0..TEXT.len();
    let shown = human::text(&checked(vec![whole.clone()]));
    assert!(shown.contains("PARTNO") && shown.contains("FINI"), "{shown}");
    let long = format!("P1=POINT/1,2{}", ",3".repeat(5_000));
    let mut programs = checked(vec![whole]);
    programs[0].program.index.rope = Rope::from_str(&long);
    programs[0].diagnostics[0].range = 3..8;
    let plain = anstream::adapter::strip_str(&human::text(&programs)).to_string();
    assert!(plain.contains("parts/a.apt:1:4") && plain.len() < 500, "{plain}");
}

#[test]
fn json_has_every_field_of_the_interface() {
    let report: Value = serde_json::from_str(&json_report::text(&checked(vec![error(), warning()]))).unwrap();
    let range = |line: u32, from: u32, to: u32| json!({ "start": { "line": line, "character": from }, "end": { "line": line, "character": to } });
    assert_eq!(report["summary"], json!({ "errors": 1, "warnings": 1 }));
    assert_eq!(
        report["files"][0]["diagnostics"][0],
        json!({
            "code": "APT0001", "severity": "error", "message": "P9 has no value", "isn": 3, "apt3": 5,
            "file": "parts/a.apt", "range": range(2, 12, 14),
            "origin": [{ "kind": "macro", "name": "M", "isn": 9, "turn": 1 }],
            "related": [{ "message": "P1 is here", "file": "parts/a.apt", "range": range(1, 13, 15) }],
            "hint": "define P9 before this statement",
            "fixes": [{
                "title": "Replace P9 by P1", "preferred": true,
                "edits": [{ "range": range(2, 12, 14), "text": "P1" }],
            }],
        })
    );
    assert_eq!(report["files"][0]["diagnostics"][1]["hint"], Value::Null);
}

#[test]
fn github_gets_one_line_per_finding() {
    let text = github::text(&checked(vec![error(), warning()]));
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(
        lines[0],
        "::error file=parts/a.apt,line=3,endLine=3,col=13,endColumn=15,title=APT0001::\
         P9 has no value%0Ahelp: define P9 before this statement"
    );
    assert!(lines[1].starts_with("::warning file=parts/a.apt,line=4,endLine=4,col=5,"), "{}", lines[1]);
}

#[test]
fn sarif_has_rules_results_and_related_places() {
    let log = serde_json::to_value(sarif::log(&checked(vec![error(), warning()]), &FakeLanguage::default()))
        .unwrap();
    let run = &log["runs"][0];
    assert_eq!((&log["version"], run["results"].as_array().unwrap().len()), (&json!("2.1.0"), 2));
    let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
    assert_eq!((rules.len(), &rules[0]["id"]), (1, &json!("APT0001")));
    assert!(rules[0]["help"]["markdown"].as_str().unwrap().contains("BAD"));
    let result = &run["results"][0];
    assert_eq!((&result["level"], &result["ruleIndex"]), (&json!("error"), &json!(0)));
    assert_eq!(result["properties"], json!({ "isn": 3, "apt3": 5 }));
    let region = &result["locations"][0]["physicalLocation"]["region"];
    assert_eq!(*region, json!({ "startLine": 3, "startColumn": 13, "endLine": 3, "endColumn": 15 }));
    let related: Vec<_> = result["relatedLocations"]
        .as_array()
        .unwrap()
        .iter()
        .map(|place| &place["message"]["text"])
        .collect();
    assert_eq!(related, [&json!("P1 is here"), &json!("in the macro M called at statement 9")]);
    assert_eq!(run["results"][1]["relatedLocations"], Value::Null);
    let fix = &result["fixes"][0];
    assert_eq!(fix["description"]["text"], "Replace P9 by P1");
    let replacement = json!({
        "deletedRegion": { "startLine": 3, "startColumn": 13, "endLine": 3, "endColumn": 15 },
        "insertedContent": { "text": "P1" },
    });
    let change = json!({ "artifactLocation": { "uri": "parts/a.apt" }, "replacements": [replacement] });
    assert_eq!(fix["artifactChanges"], json!([change]));
    assert_eq!(run["results"][1]["fixes"], Value::Null);
}

#[test]
fn warnings_count_only_when_they_are_denied() {
    let warned = checked(vec![warning()]);
    assert_eq!(Counts::of(&warned), Counts { errors: 0, warnings: 1 });
    assert_eq!((outcome(&warned, false), outcome(&warned, true)), (Outcome::Clean, Outcome::Findings));
    assert_eq!(outcome(&checked(vec![error()]), false), Outcome::Findings);
}

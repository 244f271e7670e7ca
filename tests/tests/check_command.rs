//! `apt-lsp --check` over the corpus: the mistake at its statement, nothing about good programs, exit codes, SARIF.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::{
    path::{Path, PathBuf},
    process::Command,
    sync::OnceLock,
};

use apt_tests::{
    oracle::{GROUPS, dialect_of, programs},
    repository,
    runs::{examples, read, title},
};
use serde_json::Value;

/// Mistakes of which an earlier finding at another statement is told first, with the reason.
const OTHER_FIRST: [(&str, &str); 0] = [];

/// The binary, built once for this process; cargo knows when there is nothing to do.
fn binary() -> &'static Path {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    BINARY.get_or_init(|| {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let built = Command::new(cargo)
            .args(["build", "-p", "apt-lsp", "--message-format", "json", "--quiet"])
            // As this test itself was built: another profile would be built anew, and a slow one takes minutes here.
            .args((!cfg!(debug_assertions)).then_some("--release"))
            .current_dir(repository(""))
            .output()
            .unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        let messages = String::from_utf8_lossy(&built.stdout).into_owned();
        let executable = messages.lines().rev().find_map(|line| {
            let message: Value = serde_json::from_str(line).ok()?;
            message["executable"].as_str().map(PathBuf::from)
        });
        executable.expect("cargo says where the binary is")
    })
}

struct Checked {
    code: Option<i32>,
    output: String,
}

fn check(paths: &[PathBuf], options: &[&str]) -> Checked {
    let output = Command::new(binary()).arg("--check").args(paths).args(options).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        !String::from_utf8_lossy(&output.stderr).contains("panicked"),
        "{output:?}",
        output = output.stderr
    );
    Checked { code: output.status.code(), output: text }
}

fn expected(path: &Path) -> Value {
    serde_json::from_str(&read(&path.with_extension("json"))).unwrap()
}

/// A program that the processor of the corpus takes and that we are to take too.
fn is_good(path: &Path) -> bool {
    let expected = expected(path);
    // The oracle test holds this list to be exact.
    let listed = read(&repository("tests/oracle/not-passing.toml")).contains(&format!("\"{}\"", title(path)));
    !listed
        && expected["quirk"] != true
        && expected["ok"] == true
        && expected["diagnostics"].as_array().is_none_or(Vec::is_empty)
}

/// What is wrong with the findings about one program with a deliberate mistake.
fn wrong_about(path: &Path) -> Option<String> {
    let checked = check(&[path.to_owned()], &["--format", "json", "--dialect", "apt3"]);
    let report: Value = serde_json::from_str(&checked.output).unwrap();
    let expected = expected(path);
    let wanted = &expected["diagnostics"][0];
    let found = report["files"][0]["diagnostics"].as_array().unwrap();
    let grave = found.iter().filter(|one| one["severity"] == "error" || one["severity"] == "warning");
    let first = grave.clone().next();
    let exit = i32::from(expected["ok"] == false);
    let other_first = OTHER_FIRST.iter().any(|(name, _)| *name == title(path));
    if checked.code != Some(exit) {
        return Some(format!("exit code {:?}, expected {exit}", checked.code));
    }
    if first.is_none_or(|first| first["isn"] != wanted["isn"]) != other_first {
        return Some(format!("expected {} at {}, first is {first:?}", wanted["number"], wanted["isn"]));
    }
    let told = grave.clone().any(|one| one["isn"] == wanted["isn"] && one["apt3"] == wanted["number"]);
    (!told).then(|| format!("expected {} at {}, found {found:?}", wanted["number"], wanted["isn"]))
}

#[test]
fn every_mistake_is_told_first_and_at_its_statement() {
    let wrong: Vec<String> = programs("errors")
        .iter()
        .filter_map(|path| Some(format!("{}: {}", title(path), wrong_about(path)?)))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A program of the corpus that reserves a name which it does not use, and the hint about it.
const UNUSED_NAME: (&str, &str) = ("part-mesh-zigzag.apt", "D is never used");

fn is_of(finding: &Value, file: &str) -> bool {
    finding["file"].as_str().is_some_and(|path| path.ends_with(file))
}

#[test]
fn nothing_is_told_about_good_programs() {
    let mut count = 0;
    for dialect in ["free", "apt4"] {
        let groups = GROUPS.iter().filter(|group| dialect_of(group).as_str() == dialect);
        let mut paths: Vec<PathBuf> =
            groups.flat_map(|group| programs(group)).filter(|path| is_good(path)).collect();
        if dialect == "free" {
            paths.extend(examples());
        }
        count += paths.len();
        let checked = check(&paths, &["--format", "json", "--dialect", dialect, "--deny-warnings"]);
        let report: Value = serde_json::from_str(&checked.output).unwrap();
        let mut told: Vec<&Value> = report["files"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|file| file["diagnostics"].as_array().unwrap())
            .collect();
        if dialect == "apt4" {
            let before = told.len();
            told.retain(|one| !(is_of(one, UNUSED_NAME.0) && one["message"] == UNUSED_NAME.1));
            assert_eq!(before, told.len() + 1, "the name that is not used is told once");
        }
        assert_eq!(told, Vec::<&Value>::new());
        assert_eq!(report["files"].as_array().unwrap().len(), paths.len());
        assert_eq!((&report["summary"]["errors"], &report["summary"]["warnings"]), (&0.into(), &0.into()));
        assert_eq!(checked.code, Some(0));
    }
    assert!(count > 180, "{count} good programs");
}

#[test]
fn a_warning_is_a_finding_only_when_asked() {
    let warned: Vec<PathBuf> =
        programs("errors").into_iter().filter(|path| expected(path)["ok"] == true).collect();
    assert!(!warned.is_empty());
    for path in warned {
        let paths = [path];
        assert_eq!(check(&paths, &["--dialect", "apt3"]).code, Some(0));
        assert_eq!(check(&paths, &["--dialect", "apt3", "--deny-warnings"]).code, Some(1));
    }
    assert_eq!(check(&[repository("tests/oracle/no-such-program.apt")], &[]).code, Some(2));
}

fn schema() -> jsonschema::Validator {
    let text = read(&repository("tests/schema/sarif-2.1.0-subset.json"));
    jsonschema::validator_for(&serde_json::from_str(&text).unwrap()).unwrap()
}

#[test]
fn sarif_is_what_its_schema_says() {
    let schema = schema();
    for group in ["errors", "apt4-language", "geometry"] {
        let checked =
            check(&programs(group), &["--format", "sarif", "--dialect", dialect_of(group).as_str()]);
        let log: Value = serde_json::from_str(&checked.output).unwrap();
        let wrong: Vec<String> =
            schema.iter_errors(&log).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(wrong.is_empty(), "{group}: {}", wrong.join("\n"));
        let run = &log["runs"][0];
        let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
        for result in run["results"].as_array().unwrap() {
            let rule = &rules[result["ruleIndex"].as_u64().unwrap() as usize];
            assert_eq!(rule["id"], result["ruleId"]);
            let region = &result["locations"][0]["physicalLocation"]["region"];
            let place = |end: &str| {
                let number = |what: &str| region[format!("{end}{what}")].as_u64().unwrap();
                (number("Line"), number("Column"))
            };
            assert!(place("start") <= place("end"), "{result}");
        }
        if group == "errors" {
            assert!(run["results"].as_array().unwrap().len() >= 34);
        }
    }
}

#[test]
fn the_schema_refuses_what_the_standard_refuses() {
    let schema = schema();
    let checked = check(
        &[repository("tests/oracle/errors/undefined-symbol.apt")],
        &["--format", "sarif", "--dialect", "apt3"],
    );
    let log: Value = serde_json::from_str(&checked.output).unwrap();
    assert!(schema.is_valid(&log));
    let changes: [fn(&mut Value); 5] = [
        |log| log["version"] = "2.0.0".into(),
        |log| log["runs"][0]["tool"] = Value::Null,
        |log| log["runs"][0]["results"][0]["level"] = "fatal".into(),
        |log| {
            log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["region"]["startLine"] =
                0.into();
        },
        |log| log["runs"][0]["results"][0]["colour"] = "red".into(),
    ];
    for change in changes {
        let mut changed = log.clone();
        change(&mut changed);
        assert!(!schema.is_valid(&changed), "{changed}");
    }
}

//! Compares our reports with the oracle corpus, as `tests/oracle/README.md` says.

use std::{collections::BTreeMap, fmt::Write, path::Path};

use apt_syntax::dialect::DialectName;
use serde_json::Value;

use crate::{repository, run_report, sculptured};

/// Tolerance for canonical forms and point-to-point locations, relative to the size of the numbers.
const EXACT: f64 = 1e-6;
/// What is added to the tolerance band when end points of motions are compared, program units.
const MOTION_SLACK: f64 = 1e-5;
/// OUTTOL at the start of a program.
const DEFAULT_TOLERANCE: f64 = 0.0005;

/// The groups of the corpus.
pub const GROUPS: [&str; 11] = [
    "geometry",
    "language",
    "motion2d",
    "motion3d",
    "multaxis",
    "pocket",
    "errors",
    "apt4-language",
    "apt4-motion",
    "sculptured-geometry",
    "sculptured-motion",
];

/// The groups that a test of their own compares (`regional_milling`).
pub const MILLING_GROUPS: [&str; 2] = ["regional-milling", "interference"];

/// The dialect in which the programs of a group are written.
pub fn dialect_of(group: &str) -> DialectName {
    match group {
        "apt4-language"
        | "apt4-motion"
        | "sculptured-geometry"
        | "sculptured-motion"
        | "regional-milling"
        | "interference" => DialectName::Apt4,
        "errors" => DialectName::Apt3,
        _ => DialectName::Free,
    }
}

/// What is wrong with each program that does not pass, by `group/name`.
pub type Failures = BTreeMap<String, Vec<String>>;

/// Runs the whole corpus: a table for people and the failures.
pub fn run_corpus() -> (String, Failures) {
    let mut table = format!("{:<16}{:>8}{:>8}\n", "group", "passed", "of");
    let mut failures = Failures::new();
    for group in GROUPS {
        let (mut passed, mut count) = (0, 0);
        for path in programs(group) {
            count += 1;
            let problems = check(group, &path);
            if problems.is_empty() {
                passed += 1;
            } else {
                failures.insert(format!("{group}/{}", stem(&path)), problems);
            }
        }
        let _ = writeln!(table, "{group:<16}{passed:>8}{count:>8}");
    }
    (table, failures)
}

/// The programs of a group, in alphabetic order.
pub fn programs(group: &str) -> Vec<std::path::PathBuf> {
    let folder = repository("tests/oracle").join(group);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "apt"));
    paths.sort();
    paths
}

fn stem(path: &Path) -> String {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The problems of one program; empty when it passes.
pub fn check(group: &str, path: &Path) -> Vec<String> {
    let expected = std::fs::read_to_string(path.with_extension("json")).expect("every program has a result");
    let expected: Value = serde_json::from_str(&expected).expect("the result is JSON");
    let dialect = dialect_of(group).as_str();
    let ours = run_report(path, dialect);
    let mut problems = Vec::new();
    if let Some(quirk) = expected.get("quirk") {
        // Where the peer itself is wrong its result is no target; the true values are.
        true_values(quirk, &ours, &mut problems);
        return problems;
    }
    diagnostics(&expected, &ours, &mut problems);
    if expected["ok"].as_bool() == Some(true) {
        let by_flow = if group == "sculptured-geometry" { sculptured::flow_names(path) } else { Vec::new() };
        symbols(&expected, &ours, &by_flow, &mut problems);
        sculptured::check(path, dialect, &expected, &mut problems);
        locations(group, &expected, &ours, &mut problems);
        if dialect_of(group) != DialectName::Apt4 {
            names(&expected, &ours, &mut problems);
        }
        if group != "errors" {
            verification(&ours, &mut problems);
        }
    }
    problems
}

/// Good programs have no error and no warning; the first mistake of a bad one is reported at its statement.
fn diagnostics(expected: &Value, ours: &Value, problems: &mut Vec<String>) {
    let empty = Vec::new();
    let found = ours["diagnostics"].as_array().unwrap_or(&empty);
    let wanted = expected["diagnostics"].as_array().unwrap_or(&empty);
    if let Some(first) = wanted.first() {
        let hit = found.iter().any(|one| one["isn"] == first["isn"] && one["apt3"] == first["number"]);
        if !hit {
            let place = found.iter().map(|one| format!("{}@{}", one["apt3"], one["isn"])).collect::<Vec<_>>();
            problems.push(format!(
                "expected {}@{}, found {}",
                first["number"],
                first["isn"],
                place.join(" ")
            ));
        }
    } else if let Some(one) =
        found.iter().find(|one| one["severity"] == "error" || one["severity"] == "warning")
    {
        problems.push(format!("{} {} at {}: {}", one["severity"], one["code"], one["isn"], one["message"]));
    }
}

/// Names in `by_flow` carry the flow tolerance of the public system.
fn symbols(expected: &Value, ours: &Value, by_flow: &[String], problems: &mut Vec<String>) {
    let Some(wanted) = expected["symbols"].as_object() else { return };
    for (name, symbol) in wanted {
        let found = &ours["symbols"][name];
        if found.is_null() {
            problems.push(format!("symbol {name} is missing"));
        } else if found["type"] != symbol["type"] {
            problems.push(format!("symbol {name} is {}, expected {}", found["type"], symbol["type"]));
        } else if symbol["canonical"].is_array() {
            let conic =
                matches!(symbol["type"].as_str(), Some("ELLIPS" | "HYPERB" | "GCONIC" | "LCONIC" | "QADRIC"));
            let (mut a, mut b) = (numbers(&symbol["canonical"]), numbers(&found["canonical"]));
            if conic {
                normalise(&mut a);
                normalise(&mut b);
            }
            let tolerance = if by_flow.contains(name) { sculptured::FLOW } else { EXACT };
            if !close(&a, &b, tolerance) {
                problems.push(format!("symbol {name} is {b:?}, expected {a:?}"));
            }
        }
    }
}

/// The true values of symbols that the peer gets wrong.
fn true_values(quirk: &Value, ours: &Value, problems: &mut Vec<String>) {
    for (name, value) in quirk["true"].as_object().into_iter().flatten() {
        // `NAME_xy`: the first two coordinates of a point.
        if let Some((point, wanted)) = name.strip_suffix("_xy").zip(value.as_array()) {
            let wanted: Vec<f64> = wanted.iter().filter_map(Value::as_f64).collect();
            let found = numbers(&ours["symbols"][point]["canonical"]);
            if !close(&wanted, found.get(..2).unwrap_or_default(), EXACT) {
                problems.push(format!("symbol {point} is {found:?}, truly over {wanted:?}"));
            }
            continue;
        }
        let (Some(wanted), found) = (value.as_f64(), numbers(&ours["symbols"][name]["canonical"])) else {
            continue;
        };
        if !close(&[wanted], &found, EXACT) {
            problems.push(format!("symbol {name} is {found:?}, truly {wanted}"));
        }
    }
}

/// Divides by the coefficient with the largest magnitude.
fn normalise(values: &mut [f64]) {
    let largest = values.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
    if let Some(largest) = largest.filter(|largest| *largest != 0.0) {
        values.iter_mut().for_each(|value| *value /= largest);
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}

fn close(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance * a.abs().max(1.0))
}

struct Location {
    isn: u64,
    points: Vec<Vec<f64>>,
    tolerance: f64,
}

/// The tool positions of a report, statement by statement, with the tolerance in force.
fn motion_statements(report: &Value) -> Vec<Location> {
    let mut list: Vec<Location> = Vec::new();
    let (mut inside, mut outside) = (0.0_f64, DEFAULT_TOLERANCE);
    for entry in report["cl"].as_array().into_iter().flatten() {
        let greatest = || numbers(&entry["words"]).into_iter().fold(0.0, f64::max);
        match (entry["type"].as_str(), entry["words"][0].as_str()) {
            (Some("control"), Some("INTOL")) => inside = greatest(),
            (Some("control"), Some("OUTTOL")) => outside = greatest(),
            (Some("from" | "go"), _) => {
                let points = entry["points"].as_array().into_iter().flatten().map(numbers).collect();
                let isn = entry["isn"].as_u64().unwrap_or(0);
                list.push(Location { isn, points, tolerance: inside.max(outside) });
            }
            _ => {}
        }
    }
    list
}

fn locations(group: &str, expected: &Value, ours: &Value, problems: &mut Vec<String>) {
    let (wanted, found) = (motion_statements(expected), motion_statements(ours));
    let isns = |list: &[Location]| list.iter().map(|location| location.isn).collect::<Vec<_>>();
    if isns(&wanted) != isns(&found) {
        problems.push(format!("motion at statements {:?}, expected {:?}", isns(&found), isns(&wanted)));
        return;
    }
    for (wanted, found) in wanted.iter().zip(&found) {
        let tolerance = if group.starts_with("motion")
            || ["multaxis", "apt4-motion", "sculptured-motion"].contains(&group)
        {
            wanted.tolerance + MOTION_SLACK
        } else {
            EXACT
        };
        let pairs: Vec<_> = if wanted.points.len() == 1 || tolerance > EXACT {
            wanted.points.last().zip(found.points.last()).into_iter().collect()
        } else {
            if wanted.points.len() != found.points.len() {
                problems.push(format!("{} points at {}", found.points.len(), wanted.isn));
            }
            wanted.points.iter().zip(&found.points).collect()
        };
        for (a, b) in pairs {
            let off = a.len() != b.len() || distance(&a[..3], &b[..3]) > tolerance.max(EXACT * size(a));
            let off = off && !free_along_surfaces(ours, wanted.isn, &a[..3], &b[..3], wanted.tolerance);
            let turned = a.len() == 6 && b.len() == 6 && distance(&a[3..], &b[3..]) > tolerance.max(EXACT);
            if off || turned {
                problems.push(format!("at {} the tool is at {b:?}, expected {a:?}", wanted.isn));
            }
        }
    }
}

/// After what the positions of each statement are named, and the words of INDEX and COPY. APT4 writes no names.
fn names(expected: &Value, ours: &Value, problems: &mut Vec<String>) {
    let named = |report: &Value| -> Vec<(u64, String)> {
        let entries = report["cl"].as_array().into_iter().flatten();
        let moves = entries.filter(|entry| matches!(entry["type"].as_str(), Some("from" | "go")));
        moves
            .map(|entry| {
                let name = entry["surface"].as_str().unwrap_or_default();
                (entry["isn"].as_u64().unwrap_or(0), name.to_owned())
            })
            .collect()
    };
    let (wanted, found) = (named(expected), named(ours));
    if wanted != found {
        problems.push(format!("the positions are named {found:?}, expected {wanted:?}"));
    }
    let edits = |report: &Value| -> Vec<Value> {
        let entries = report["cl"].as_array().into_iter().flatten().map(|entry| &entry["words"]);
        let edits = entries.filter(|words| matches!(words[0].as_str(), Some("INDEX" | "COPY")));
        edits
            .map(|words| match words[2].as_str() {
                // The name of the matrix and its first numbers are one text there.
                Some("MODIFY") => words.as_array().into_iter().flatten().take(3).cloned().collect(),
                _ => words.clone(),
            })
            .collect()
    };
    let (wanted, found) = (edits(expected), edits(ours));
    if wanted != found {
        problems.push(format!("INDEX and COPY are {found:?}, expected {wanted:?}"));
    }
}

/// A start-up motion with fewer than three surfaces may end anywhere along them: its position is compared against the
/// surfaces, by the verifier, and against the point only roughly.
fn free_along_surfaces(ours: &Value, isn: u64, a: &[f64], b: &[f64], tolerance: f64) -> bool {
    /// How far along the surfaces the end may be, in tolerances.
    const ALONG: f64 = 5.0;
    let motion = ours["motions"].as_array().into_iter().flatten().find(|motion| motion["isn"] == isn);
    motion.is_some_and(|motion| {
        let start_up = motion["statement"].as_str().is_some_and(|text| text.starts_with("GO/"));
        let free = motion["part"].is_object() && motion["check"].is_null();
        start_up && free && motion["verified"] == true && distance(a, b) <= ALONG * tolerance
    })
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn size(values: &[f64]) -> f64 {
    values.iter().fold(1.0, |size: f64, value| size.max(value.abs()))
}

/// Every motion must be proven by the verifier.
fn verification(ours: &Value, problems: &mut Vec<String>) {
    for motion in ours["motions"].as_array().into_iter().flatten() {
        if motion["verified"].as_bool() != Some(true) {
            problems.push(format!("motion at {} is not verified: {motion}", motion["isn"]));
        }
    }
}

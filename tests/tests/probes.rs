//! The statement forms of sculptured surfaces that the public system was asked about: taken, or refused with the same
//! number.

use std::sync::Arc;

use apt_program::Value as SymbolValue;
use apt_run::{
    diagnostic::Severity,
    document::{Document, Level},
    settings::Settings,
};
use apt_tests::repository;
use serde_json::Value;

/// Statements that are not ours, with the reason.
const NOT_OURS: &[(&str, &str)] = &[
    ("REGION/1,IN", "a word of an area milling that the references do not describe"),
    ("GOLOFT/SS,UCONST,.5", "isoparametric lofting, which the references only name"),
];
/// How far a location may be from that of the public system: both lie in the band of INTOL and OUTTOL (.002 each), and the
/// tool touches a little beside where it would without it.
const LOCATION: f64 = 0.0045;
/// Printed values have six decimals.
const PRINTED: f64 = 1e-6;

fn strings(value: &Value) -> Vec<String> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter().filter_map(|one| one.as_str().map(str::to_owned)).collect()
}

fn document(lines: &[String]) -> Document {
    let settings = Arc::new(Settings { dialect: Some("apt4".to_owned()), ..Settings::default() });
    Document::new(&lines.join("\n"), Some("probe.apt".to_owned()), &settings)
}

/// What is wrong with one probe.
fn fault(base: &[String], scon: &[String], probe: &Value) -> Option<String> {
    let statements = strings(&probe["statements"]);
    let mut lines = base.to_vec();
    if probe["with_scon"] == true {
        lines.extend_from_slice(scon);
    }
    let before = lines.len() as u32;
    lines.extend(statements.iter().cloned());
    lines.push("FINI\n".to_owned());
    let document = document(&lines);
    let all = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).expect("not cancelled");
    let found: Vec<_> = all
        .iter()
        .filter(|one| one.severity >= Severity::Warning && one.origin.isn > before)
        .map(|one| (one.severity, one.wording.apt3, one.wording.code))
        .collect();
    if probe["accepted"] == true {
        // What has no number of the public system is told by us only.
        if found.iter().any(|(severity, number, _)| *severity == Severity::Error || number.is_some()) {
            return Some(format!("{found:?}, and it is taken"));
        }
        return printed_fault(&document, probe).or_else(|| milled_fault(&document, probe));
    }
    let wanted: Vec<u64> = probe["diagnostics"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default()
        .iter()
        .filter_map(|one| one[2].as_u64())
        .collect();
    let numbers: Vec<u64> = found.iter().filter_map(|(_, number, _)| number.map(u64::from)).collect();
    (numbers != wanted).then(|| format!("{found:?}, not {wanted:?}"))
}

/// What is wrong with the values that it prints.
fn printed_fault(document: &Document, probe: &Value) -> Option<String> {
    let program = document.program(&|| false).expect("not cancelled");
    let symbols = program.symbols();
    for one in probe["printed"].as_array().map(Vec::as_slice).unwrap_or_default() {
        let (name, wanted) = (one[0].as_str()?, &one[2]);
        let value = symbols.iter().find(|(known, _)| known == name).map(|(_, value)| value);
        let values = match value {
            Some(SymbolValue::Scalar(number)) => vec![*number],
            Some(SymbolValue::Geometry(geometry)) => geometry.canonical_values(),
            None => return Some(format!("{name} has no value")),
        };
        let wanted: Vec<f64> = wanted.as_array()?.iter().filter_map(Value::as_f64).collect();
        let same = values.len() == wanted.len()
            && values.iter().zip(&wanted).all(|(a, b)| (a - b).abs() <= PRINTED * b.abs().max(1.0));
        if !same {
            return Some(format!("{name} is {values:?}, not {wanted:?}"));
        }
    }
    None
}

/// What is wrong with the locations of its regional milling: the first one, and the last one of a single pass or position.
fn milled_fault(document: &Document, probe: &Value) -> Option<String> {
    let motions = probe["motions"].as_array()?;
    let milled = motions.iter().find(|motion| motion["verb"] == "SMIL" && motion["n"] != 0)?;
    let report = document.report(&|| false, &mut |_, _| {}, None).expect("not cancelled");
    let report = serde_json::to_value(report).expect("a report is JSON");
    let empty = Vec::new();
    let numbers = |point: &Value| -> Vec<f64> {
        point.as_array().unwrap_or(&empty).iter().take(3).filter_map(Value::as_f64).collect()
    };
    let points: Vec<Vec<f64>> = report["cl"]
        .as_array()
        .unwrap_or(&empty)
        .iter()
        .flat_map(|record| record["points"].as_array().unwrap_or(&empty).iter().map(numbers))
        .collect();
    let wanted = |name: &str| -> Vec<f64> {
        let list = milled[name].as_array().map(Vec::as_slice).unwrap_or_default();
        list.iter().take(3).filter_map(Value::as_f64).collect()
    };
    // Without the first location of a pass the next one is as far on as the tolerances allow.
    let skips = probe["statements"][0].as_str().is_some_and(|text| text.ends_with("PLUS,1"));
    let mut pairs = if skips { Vec::new() } else { vec![("first", points.first()?)] };
    if motions.len() == 1 {
        pairs.push(("last", points.last()?));
    }
    for (name, found) in pairs {
        let wanted = wanted(name);
        let off = found.iter().zip(&wanted).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        if off > LOCATION {
            return Some(format!("the {name} location is {found:?}, {off} from {wanted:?}"));
        }
    }
    None
}

#[test]
fn statement_forms_are_taken_and_refused_as_by_the_public_system() {
    let text = std::fs::read_to_string(repository("tests/oracle/probes.json")).expect("the probes are there");
    let file: Value = serde_json::from_str(&text).expect("the probes are JSON");
    let (base, scon) = (strings(&file["base"]), strings(&file["scon_block"]));
    let probes = file["probes"].as_array().expect("a list of probes");
    let mut faults = String::new();
    let mut asked = 0;
    for probe in probes {
        let statements = strings(&probe["statements"]).join(" / ");
        if NOT_OURS.iter().any(|(other, _)| *other == statements) {
            continue;
        }
        asked += 1;
        if let Some(fault) = fault(&base, &scon, probe) {
            faults.push_str(&format!("\n{statements}: {fault}"));
        }
    }
    assert!(faults.is_empty(), "{faults}");
    assert_eq!(asked + NOT_OURS.len(), probes.len());
}

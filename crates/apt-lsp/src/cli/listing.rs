//! The listing of a run for people, made from its report.

use std::fmt::Write as _;

use serde_json::Value;

/// Decimals of coordinates.
const DECIMALS: usize = 6;

/// Width of a coordinate.
const WIDTH: usize = 14;

/// The listing of a run, with the statements of its program as they are written, in the order of their numbers. Writing to a
/// string cannot fail, so results of `write!` are dropped.
pub(super) fn text(report: &Value, source: &[&str]) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "PROGRAM {}", words(&report["program"]));
    statements(&mut text, source);
    printed(&mut text, report);
    symbols(&mut text, report);
    motions(&mut text, report);
    records(&mut text, report);
    totals(&mut text, &report["totals"]);
    text
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn words(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), plain),
        Value::Null => "-".to_owned(),
        other => other.to_string(),
    }
}

/// A number without needless zeros.
pub(super) fn plain(number: f64) -> String {
    let text = format!("{number:.DECIMALS$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn numbers(values: &Value) -> String {
    list(values).iter().map(words).collect::<Vec<_>>().join(", ")
}

/// The statements with their numbers, by which all that follows names them; blank lines have numbers, too.
fn statements(text: &mut String, source: &[&str]) {
    if source.iter().all(|statement| statement.trim().is_empty()) {
        return;
    }
    text.push_str("\nSTATEMENTS\n");
    for (statement, isn) in source.iter().zip(1_usize..) {
        for (line, number) in statement.lines().zip([Some(isn)].into_iter().chain(std::iter::repeat(None))) {
            let number = number.map_or_else(String::new, |isn| isn.to_string());
            if !line.trim().is_empty() {
                let _ = writeln!(text, "  {number:>5}  {}", line.trim_end());
            }
        }
    }
}

/// What the program itself lists.
fn printed(text: &mut String, report: &Value) {
    let entries = list(&report["listing"]);
    if entries.is_empty() {
        return;
    }
    text.push_str("\nLISTING OF THE PROGRAM\n");
    for entry in entries {
        for line in list(&entry["lines"]) {
            let _ = writeln!(text, "  {:>5}  {}", words(&entry["isn"]), words(line));
        }
    }
}

fn symbols(text: &mut String, report: &Value) {
    let Some(symbols) = report["symbols"].as_object().filter(|symbols| !symbols.is_empty()) else { return };
    text.push_str("\nCANONICAL FORMS\n");
    for (name, symbol) in symbols {
        let _ =
            writeln!(text, "  {name:<12} {:<8} {}", words(&symbol["type"]), numbers(&symbol["canonical"]));
    }
}

/// A table with the columns as wide as their widest entry; the flags tell which are set to the right.
fn table(text: &mut String, header: &[(&str, bool)], rows: &[Vec<String>]) {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain([header[column].0.chars().count()]).max().unwrap_or_default()
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let head: Vec<String> = header.iter().map(|(name, _)| (*name).to_owned()).collect();
    for row in std::iter::once(&head).chain(rows) {
        let mut line = String::new();
        for ((cell, width), (_, right)) in row.iter().zip(&widths).zip(header) {
            let _ = if *right { write!(line, "  {cell:>width$}") } else { write!(line, "  {cell:<width$}") };
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
}

/// Longer statements are cut, so that the figures stay in sight (characters).
const LONGEST_STATEMENT: usize = 44;

fn motions(text: &mut String, report: &Value) {
    let motions = list(&report["motions"]);
    if motions.is_empty() {
        return;
    }
    text.push_str("\nMOTIONS\n");
    let header = [
        ("isn", true),
        ("statement", false),
        ("cut vectors", true),
        ("at least", true),
        ("ms", true),
        ("proof", false),
        ("part surface", false),
        ("drive surface", false),
        ("check surface", false),
    ];
    let row = |motion: &Value| {
        let milliseconds =
            motion["seconds"].as_f64().map_or_else(|| "-".to_owned(), |time| format!("{:.2}", time * 1e3));
        vec![
            words(&motion["isn"]),
            shortened(&words(&motion["statement"])),
            words(&motion["cut_vectors"]),
            words(&motion["minimum"]),
            milliseconds,
            if motion["verified"] == true { "verified" } else { "NOT VERIFIED" }.to_owned(),
            clearance(&motion["part"]),
            clearance(&motion["drive"]),
            clearance(&motion["check"]),
        ]
    };
    table(text, &header, &motions.iter().map(row).collect::<Vec<_>>());
    let sum: u64 = motions.iter().filter_map(|motion| motion["cut_vectors"].as_u64()).sum();
    let doubtful = motions.iter().filter(|motion| motion["verified"] != true).count();
    let proof = match doubtful {
        0 => "all verified".to_owned(),
        some => format!("{some} NOT VERIFIED"),
    };
    let _ =
        writeln!(text, "  {}, {}, {proof}", count(motions.len() as u64, "motion"), count(sum, "cut vector"));
    stories(text, motions);
}

/// How each motion was computed, where that was asked for.
fn stories(text: &mut String, motions: &[Value]) {
    for motion in motions.iter().filter(|motion| motion["story"].is_array()) {
        let _ = writeln!(text, "\n  {} {}", words(&motion["isn"]), words(&motion["statement"]));
        for line in list(&motion["story"]) {
            let _ = writeln!(text, "    {}", words(line));
        }
    }
}

fn count(number: u64, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn shortened(statement: &str) -> String {
    if statement.chars().count() <= LONGEST_STATEMENT {
        return statement.to_owned();
    }
    let kept: String = statement.chars().take(LONGEST_STATEMENT - 1).collect();
    format!("{kept}…")
}

/// The least and the greatest signed clearance over the whole of every cut vector.
fn clearance(extremes: &Value) -> String {
    let end = |end: &str| {
        let Some(value) = extremes[end].as_f64() else { return "-".to_owned() };
        let text = format!("{value:+.DECIMALS$}");
        // What the decimals do not show has no side.
        let is_zero = text.bytes().all(|byte| !matches!(byte, b'1'..=b'9'));
        if is_zero { text.replace('-', "+") } else { text }
    };
    if extremes.is_null() { "-".to_owned() } else { format!("{} … {}", end("min"), end("max")) }
}

fn records(text: &mut String, report: &Value) {
    let records = list(&report["cl"]);
    if records.is_empty() {
        return;
    }
    text.push_str("\nCUTTER LOCATIONS\n");
    for record in records {
        let kind = record["type"].as_str().unwrap_or_default();
        let what = match kind {
            "from" | "go" => {
                format!("{} {}", kind.to_uppercase(), record["surface"].as_str().unwrap_or_default())
            }
            "fini" => "FINI".to_owned(),
            // Geometry of a surface; its record has no word of its own.
            "other" => format!("{} {}", surface_title(record), numbers(&record["words"])).trim().to_owned(),
            _ => list(&record["words"]).iter().map(words).collect::<Vec<_>>().join(" "),
        };
        let _ = writeln!(text, "  {:>5}  {}", words(&record["isn"]), what.trim_end());
        for point in list(&record["points"]) {
            text.push_str("       ");
            for number in list(point) {
                let number = number.as_f64().unwrap_or(f64::NAN);
                let _ = write!(text, "{number:>WIDTH$.DECIMALS$}");
            }
            text.push('\n');
        }
    }
}

/// Class and subclass of the record that a circle or cylinder leaves before the motion along it.
const CIRCLE_RECORD: [u64; 2] = [3000, 2];

/// `CIRCLE C1 =` for the record of a surface.
fn surface_title(record: &Value) -> String {
    let class: Vec<u64> = list(&record["code"]).iter().filter_map(Value::as_u64).collect();
    let kind = if class == CIRCLE_RECORD { "CIRCLE" } else { "SURFACE" };
    match record["surface"].as_str() {
        Some(name) => format!("{kind} {name} ="),
        None => format!("{kind} ="),
    }
}

fn totals(text: &mut String, totals: &Value) {
    text.push_str("\nTOTALS\n");
    for (name, key) in [
        ("points", "points"),
        ("length", "length"),
        ("cutting", "cut_length"),
        ("rapid", "rapid_length"),
        ("minutes", "time_minutes"),
    ] {
        let _ = writeln!(text, "  {name:<8} {}", words(&totals[key]));
    }
    if let [least, greatest] = list(&totals["box"]) {
        let _ = writeln!(text, "  {:<8} {} to {}", "box", numbers(least), numbers(greatest));
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;
    use serde_json::json;

    #[test]
    fn a_listing_shows_forms_motions_points_and_totals() {
        let report = json!({
            "program": "A.apt",
            "symbols": { "C1": { "type": "CIRCLE", "canonical": [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.5] } },
            "motions": [{
                "isn": 4, "statement": "GOLFT/C1,PAST,L1", "cut_vectors": 2, "verified": true, "minimum": 2,
                "part": { "min": -0.0001, "max": 0.0005 }, "drive": null, "seconds": 0.00125,
            }, {
                "isn": 104, "statement": "GOLFT/(CIRCLE/CENTER,(POINT/1,2,3),RADIUS,4.5),PAST,L1",
                "cut_vectors": 1, "verified": false, "minimum": null,
                "check": { "min": -1.2e-16, "max": -0.0 },
            }],
            "cl": [
                { "isn": 2, "type": "postprocessor", "words": ["SPINDL", 800.0, "CLW"] },
                { "isn": 3, "type": "from", "points": [[0.0, 0.0, 1.0]] },
                { "isn": 4, "type": "go", "surface": "C1", "points": [[1.25, 0.0, 0.0], [-2.0, 0.0, 0.0]] },
                { "isn": 4, "type": "other", "surface": "C1", "code": [3000, 2], "words": [0.0, 1.5] },
                { "isn": 5, "type": "fini" },
            ],
            "listing": [{ "isn": 1, "lines": ["C1 CIRCLE 7", "  0.000000"] }],
            "totals": {
                "points": 3, "length": 5.5, "cut_length": 5.5, "rapid_length": 0.0, "time_minutes": null,
                "box": [[-2.0, 0.0, 0.0], [1.25, 0.0, 1.0]],
            },
        });
        let source = ["PARTNO A\n", "\n", "C1=CIRCLE/0,0,$ \r\n  2.5\r\n", "GOLFT/C1"];
        expect![[r#"
            PROGRAM A.apt

            STATEMENTS
                  1  PARTNO A
                  3  C1=CIRCLE/0,0,$
                       2.5
                  4  GOLFT/C1

            LISTING OF THE PROGRAM
                  1  C1 CIRCLE 7
                  1    0.000000

            CANONICAL FORMS
              C1           CIRCLE   0, 0, 0, 0, 0, 1, 2.5

            MOTIONS
              isn  statement                                     cut vectors  at least    ms  proof         part surface           drive surface  check surface
                4  GOLFT/C1,PAST,L1                                        2         2  1.25  verified      -0.000100 … +0.000500  -              -
              104  GOLFT/(CIRCLE/CENTER,(POINT/1,2,3),RADIUS,4…            1         -     -  NOT VERIFIED  -                      -              +0.000000 … +0.000000
              2 motions, 3 cut vectors, 1 NOT VERIFIED

            CUTTER LOCATIONS
                  2  SPINDL 800 CLW
                  3  FROM
                         0.000000      0.000000      1.000000
                  4  GO C1
                         1.250000      0.000000      0.000000
                        -2.000000      0.000000      0.000000
                  4  CIRCLE C1 = 0, 1.5
                  5  FINI

            TOTALS
              points   3
              length   5.5
              cutting  5.5
              rapid    0
              minutes  -
              box      -2, 0, 0 to 1.25, 0, 1
        "#]].assert_eq(&super::text(&report, &source));
    }

    #[test]
    fn a_report_with_holes_is_listed_too() {
        assert!(super::text(&json!({}), &[]).contains("TOTALS"));
        let holes = json!({ "cl": [{ "points": [[null]] }], "totals": { "box": [1] } });
        assert!(super::text(&holes, &["\n"]).contains("NaN"));
    }
}

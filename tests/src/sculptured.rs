//! Compares space curves and sculptured surfaces with the samples that the corpus lists of them.

use std::{path::Path, sync::Arc};

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    parametric::{ArcPoint, SculpturedSurface, SpaceCurve},
};
use apt_program::symbols::Value as Symbol;
use serde_json::Value;

/// Digits of curve samples, and of their directions.
const SAMPLE: f64 = 1e-4;
/// Digits of nodes and their normals.
const NODE: f64 = 2e-5;
/// How far flow of the public system is from the exact one, as a share of its length (its own tolerance factor).
pub const FLOW: f64 = 0.005;
/// Agreement of curvatures, which the public system lists with few digits.
const MEASURE: f64 = 2e-3;
/// Agreement of areas: those of the public system are estimates (of half a torus it lists 93 percent).
const AREA: f64 = 0.08;
/// Curvature below which a binormal is not listed to more than its sign.
const STRAIGHT: f64 = 0.02;

/// The geometry of the names of a program.
fn geometry(path: &Path, dialect: &str) -> Vec<(String, Arc<Geometry>)> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let settings =
        Arc::new(apt_run::settings::Settings { dialect: Some(dialect.to_owned()), ..Default::default() });
    let document = apt_run::document::Document::new(&text, None, &settings);
    let program = document.program(&|| false).expect("not cancelled");
    let mut found = Vec::new();
    for (name, value) in program.symbols() {
        if let Symbol::Geometry(geometry) = value {
            found.push((name.to_string(), geometry));
        }
    }
    found
}

/// What differs between the listed curves and surfaces and ours.
pub fn check(path: &Path, dialect: &str, expected: &Value, problems: &mut Vec<String>) {
    let ours = geometry(path, dialect);
    let of = |entry: &Value| {
        let name = entry["name"].as_str().unwrap_or_default();
        ours.iter().find(|(own, _)| own == name).map(|(_, geometry)| Arc::clone(geometry))
    };
    for entry in expected["curves"].as_array().into_iter().flatten() {
        match of(entry).as_deref() {
            Some(Geometry::SpaceCurve(found)) => curve(entry, found, problems),
            found => problems.push(format!("{} is {found:?}, not a space curve", entry["name"])),
        }
    }
    for entry in expected["surfaces"].as_array().into_iter().flatten() {
        match of(entry).as_deref() {
            Some(Geometry::Sculptured(found)) => surface(entry, found, problems),
            found => problems.push(format!("{} is {found:?}, not a sculptured surface", entry["name"])),
        }
    }
}

fn numbers(row: &Value) -> Vec<f64> {
    row.as_array().map(|list| list.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}

/// Whether two numbers are farther apart than that, or one of them is none.
fn differs(found: f64, listed: f64, tolerance: f64) -> bool {
    let apart = (found - listed).abs();
    apart.is_nan() || apart > tolerance
}

fn vector(row: &[f64], first: usize) -> Vec3 {
    Vec3::from_fn(|axis, _| row.get(first + axis).copied().unwrap_or(f64::NAN))
}

fn curve(entry: &Value, found: &SpaceCurve, problems: &mut Vec<String>) {
    let name = &entry["name"];
    let arcs = entry["arcs"].as_array().cloned().unwrap_or_default();
    if arcs.len() != found.arcs.len() {
        problems.push(format!("{name} has {} arcs, expected {}", found.arcs.len(), arcs.len()));
        return;
    }
    for (index, (rows, arc)) in arcs.iter().zip(&found.arcs).enumerate() {
        for row in rows.as_array().into_iter().flatten().map(numbers) {
            sample(&format!("{name} arc {}", index + 1), &row, &arc.evaluate(row[0]), problems);
        }
    }
    let Some(flow) = &found.flow else { return };
    let segments = entry["segments"].as_array().cloned().unwrap_or_default();
    if segments.len() != flow.segments.len() {
        problems.push(format!("{name} has {} segments, expected {}", flow.segments.len(), segments.len()));
        return;
    }
    for (index, rows) in segments.iter().enumerate() {
        for row in rows.as_array().into_iter().flatten().map(numbers) {
            let at = flow.arc_parameter(found, index, row[0]).and_then(|at| found.evaluate_global(at));
            let off = at.map_or(f64::NAN, |at| (at.position - vector(&row, 1)).norm());
            if off.is_nan() || off > FLOW * found.size() {
                problems.push(format!("{name} segment {} at {} is {off} off", index + 1, row[0]));
            }
        }
    }
    let ranges = entry["flow"].as_array().cloned().unwrap_or_default();
    for (index, range) in ranges.iter().enumerate() {
        let length = flow.amount(found, index as f64, index as f64 + 1.0);
        let listed = range["length"].as_f64().unwrap_or(f64::NAN);
        if differs(length, listed, FLOW * listed) {
            problems.push(format!("{name} has flow {length} over arc {}, expected {listed}", index + 1));
        }
    }
}

fn sample(place: &str, row: &[f64], at: &ArcPoint, problems: &mut Vec<String>) {
    let frame = at.frame();
    let size = row.iter().skip(1).take(3).fold(1.0, |size: f64, value| size.max(value.abs()));
    let curvature = row.get(10).copied().unwrap_or(f64::NAN);
    let bent = curvature > STRAIGHT;
    let checks = [
        ("place", (at.position - vector(row, 1)).norm() <= SAMPLE * size),
        ("tangent", (frame.tangent - vector(row, 4)).norm() <= 2.0 * SAMPLE),
        // A direction from two small derivatives has fewer digits the straighter the curve is.
        ("binormal", !bent || (frame.binormal - vector(row, 7)).norm() <= SAMPLE / curvature.min(0.1)),
        ("curvature", (frame.curvature - curvature).abs() <= MEASURE * curvature.max(1.0)),
    ];
    for (what, good) in checks {
        if !good {
            problems
                .push(format!("{place} at {}: {what} differs: {at:?} {frame:?}, expected {row:?}", row[0]));
        }
    }
}

fn surface(entry: &Value, found: &SculpturedSurface, problems: &mut Vec<String>) {
    let name = &entry["name"];
    let counts = [
        ("patches", found.count() as f64),
        ("splines", found.mesh.splines as f64),
        ("cross_splines", found.mesh.cross_splines as f64),
        ("normal_sign", found.side),
    ];
    for (what, value) in counts {
        if entry[what].as_f64() != Some(value) {
            problems.push(format!("{name} has {what} {value}, expected {}", entry[what]));
        }
    }
    // At a pole the public system may measure no patch (it lists patch 0), and misses a part of the area.
    let measured = entry["curvature_max"][2] != 0;
    let (area, listed) = (found.area(), entry["area"].as_f64().unwrap_or(f64::NAN));
    if measured && differs(area, listed, AREA * listed) {
        problems.push(format!("{name} has area {area}, expected {listed}"));
    }
    for row in entry["nodes"].as_array().into_iter().flatten().map(numbers) {
        let at = found.evaluate_global(row[0], row[1]).zip(found.normal_global(row[0], row[1]));
        let Some((at, normal)) = at else {
            problems.push(format!("{name} has no node {} {}", row[0], row[1]));
            continue;
        };
        let off = (at.position - vector(&row, 2)).norm();
        let turned = (normal.direction - vector(&row, 5)).norm();
        if off > NODE || turned > NODE {
            problems.push(format!("{name} node {} {} is off by {off}, turned by {turned}", row[0], row[1]));
        }
    }
    if measured {
        curvatures(entry, found, problems);
    }
}

/// The public system lists the greatest and the least curvature of the middles of the patches.
fn curvatures(entry: &Value, found: &SculpturedSurface, problems: &mut Vec<String>) {
    let [width, height] = found.extent();
    let middles = (0..height as usize).flat_map(|row| (0..width as usize).map(move |column| (column, row)));
    let values: Vec<_> = middles
        .filter_map(|(u, v)| found.evaluate_global(u as f64 + 0.5, v as f64 + 0.5)?.curvatures())
        .collect();
    let greatest = values.iter().map(|one| one.greatest).fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().map(|one| one.least).fold(f64::INFINITY, f64::min);
    for (what, value) in [("curvature_max", greatest), ("curvature_min", least)] {
        let listed = entry[what][0].as_f64().unwrap_or(f64::NAN);
        if differs(value, listed, MEASURE * listed.abs().max(0.1)) {
            problems.push(format!("{} has {what} {value}, expected {listed}", entry["name"]));
        }
    }
}

/// The names of a program that are places by flow.
pub fn flow_names(path: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    text.lines()
        .filter(|line| line.contains("INTOF") && line.contains(",FLOW,"))
        .filter_map(|line| Some(line.split_once('=')?.0.trim().to_owned()))
        .collect()
}

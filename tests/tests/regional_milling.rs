//! The oracle groups of regional milling and interference checking, as the README of the corpus says: locations in the
//! band, starts and ends of passes, steps over, depths of interferences by a dense search of our own.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use std::path::{Path, PathBuf};

use apt_tests::{
    oracle::programs,
    run_report,
    runs::{read, title},
};
use serde_json::Value;

type Point = [f64; 3];

/// How far the start and end of a pass may be from those of the public system, beyond the tolerance.
const SLACK: f64 = 1e-5;
/// Precision of the dense search, program units.
const DENSE: f64 = 1e-5;

/// The patch of the programs: sixteen points in rows along u.
struct Patch([[Point; 4]; 4]);

impl Patch {
    fn of(text: &str) -> Self {
        let mut rows = [[[0.0; 3]; 4]; 4];
        for line in text.lines().filter_map(|line| line.strip_prefix("P(")) {
            let (index, rest) = line.split_once(")=POINT/").unwrap();
            let index: usize = index.parse().unwrap();
            let numbers: Vec<f64> = rest.split(',').map(|number| number.parse().unwrap()).collect();
            rows[(index - 1) / 4][(index - 1) % 4] = [numbers[0], numbers[1], numbers[2]];
        }
        assert!(text.contains("S=SSURF/PATCH,POLYGN,PLUS,P(1,THRU,16)"));
        Self(rows)
    }

    fn at(&self, u: f64, v: f64) -> Point {
        let bernstein = |t: f64| {
            let s = 1.0 - t;
            [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
        };
        let (bu, bv) = (bernstein(u), bernstein(v));
        let sum =
            |k: usize| (0..4).map(|j| (0..4).map(|i| bu[i] * bv[j] * self.0[j][i][k]).sum::<f64>()).sum();
        [sum(0), sum(1), sum(2)]
    }
}

fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

fn distance(a: &Point, b: &Point) -> f64 {
    let way = minus(a, b);
    dot(&way, &way).sqrt()
}

/// A simple cutter: radius, corner radius, length.
struct Mill {
    radius: f64,
    corner: f64,
    length: f64,
}

impl Mill {
    fn of(report: &Value) -> Self {
        let entry = entries(report).find(|entry| entry["words"][0] == "CUTTER").unwrap();
        let numbers = numbers(&entry["words"]);
        Self {
            radius: 0.5 * numbers[0],
            corner: numbers.get(1).copied().unwrap_or(0.0),
            length: numbers.get(6).copied().unwrap_or(5.0),
        }
    }

    fn depth(&self, end: &Point, axis: &Point, point: &Point) -> f64 {
        let offset = minus(point, end);
        let h = dot(&offset, axis);
        let rho = (dot(&offset, &offset) - h * h).max(0.0).sqrt();
        let e = self.radius - self.corner;
        if rho > e && h < self.corner {
            let depth = self.corner - (rho - e).hypot(self.corner - h);
            if depth > 0.0 { depth.min(self.length - h) } else { depth }
        } else if rho <= self.radius && (0.0..=self.length).contains(&h) {
            (self.radius - rho).min(h).min(self.length - h)
        } else {
            -(rho - self.radius).max(0.0).hypot((-h).max(h - self.length).max(0.0))
        }
    }

    /// The greatest depth of a patch: a grid, then ever finer grids about the best places.
    fn deepest(&self, patch: &Patch, end: &Point, axis: &Point) -> f64 {
        const GRID: i32 = 40;
        let depth = |u: f64, v: f64| self.depth(end, axis, &patch.at(u, v));
        let mut starts = Vec::new();
        for i in 0..=GRID {
            for j in 0..=GRID {
                let (u, v) = (f64::from(i) / f64::from(GRID), f64::from(j) / f64::from(GRID));
                starts.push((depth(u, v), u, v));
            }
        }
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        let refined = starts.into_iter().take(2).map(|mut best| {
            let mut half = 1.0 / f64::from(GRID);
            while half > 1e-8 {
                let (_, u, v) = best;
                for i in -3..=3 {
                    for j in -3..=3 {
                        let near = |at: f64, n: i32| (at + half * f64::from(n) / 3.0).clamp(0.0, 1.0);
                        let (a, b) = (near(u, i), near(v, j));
                        let value = depth(a, b);
                        if value > best.0 {
                            best = (value, a, b);
                        }
                    }
                }
                half *= 0.6;
            }
            best.0
        });
        refined.fold(f64::NEG_INFINITY, f64::max)
    }
}

fn entries(report: &Value) -> impl Iterator<Item = &Value> {
    report["cl"].as_array().into_iter().flatten()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

fn point(numbers: &[f64]) -> Point {
    [numbers[0], numbers[1], numbers[2]]
}

/// A run of locations between feed rates.
struct Run {
    feed: f64,
    points: Vec<Vec<f64>>,
}

fn runs(report: &Value) -> Vec<Run> {
    let mut feed = 1.0;
    let mut runs = Vec::new();
    for entry in entries(report) {
        if entry["words"][0] == "FEDRAT" {
            feed = entry["words"][1].as_f64().unwrap();
        } else if entry["type"] == "go" {
            let points = entry["points"].as_array().into_iter().flatten().map(numbers).collect();
            runs.push(Run { feed, points });
        }
    }
    runs
}

fn band(report: &Value) -> (f64, f64) {
    let of = |word: &str| {
        let entry = entries(report).find(|entry| entry["words"][0] == word).unwrap();
        numbers(&entry["words"])[0]
    };
    (of("INTOL"), of("OUTTOL"))
}

fn axis(numbers: &[f64]) -> Point {
    if numbers.len() == 6 { [numbers[3], numbers[4], numbers[5]] } else { [0.0, 0.0, 1.0] }
}

fn expected(path: &Path) -> Value {
    serde_json::from_str(&read(&path.with_extension("json"))).unwrap()
}

struct Program {
    path: PathBuf,
    patch: Patch,
    expected: Value,
    ours: Value,
}

fn group(name: &str) -> Vec<Program> {
    let program = |path: PathBuf| Program {
        patch: Patch::of(&read(&path)),
        expected: expected(&path),
        ours: run_report(&path, "apt4"),
        path,
    };
    programs(name).into_iter().map(program).collect()
}

/// The first error, by statement and number.
fn first_error(diagnostics: &Value, number: &str) -> Option<(u64, u64)> {
    let errors = diagnostics.as_array().into_iter().flatten();
    let mut errors = errors.filter(|one| matches!(one["severity"].as_str(), Some("error" | "restart")));
    errors.next().and_then(|one| Some((one["isn"].as_u64()?, one[number].as_u64()?)))
}

/// The way along the surface of the guide between the starts of two passes, at most.
fn widest_step(program: &Program, ours: &[Run]) -> f64 {
    let starts: Vec<Point> =
        ours.iter().filter(|run| run.feed == 1.0).map(|run| point(&run.points[0])).collect();
    assert!(starts.len() > 1, "{}", title(&program.path));
    // Passes run along x: the lowest point of a step lies across them.
    starts.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()).fold(0.0, f64::max)
}

#[test]
fn regional_milling_is_in_the_band_and_covers_what_it_should() {
    let mut problems = Vec::new();
    let mut locations = 0;
    for program in group("regional-milling") {
        let name = title(&program.path);
        if program.expected["quirk"].is_object() {
            continue;
        }
        let told = program.ours["diagnostics"].as_array().unwrap();
        let told = told.iter().filter(|one| one["severity"] == "error" || one["severity"] == "warning");
        problems.extend(told.map(|one| format!("{name}: {}", one["message"])));
        let (mill, (inside, outside)) = (Mill::of(&program.ours), band(&program.ours));
        let (ours, theirs) = (runs(&program.ours), runs(&program.expected));
        let ends = |runs: &[Run]| {
            let all: Vec<Point> = runs.iter().flat_map(|run| &run.points).map(|at| point(at)).collect();
            (all[0], all[all.len() - 1])
        };
        let ((first, last), (their_first, their_last)) = (ends(&ours), ends(&theirs));
        let tolerance = inside.max(outside) + SLACK;
        // Where a first location is left out, the second depends on the step; npath counts differently there.
        if !name.ends_with("path-skip") && distance(&first, &their_first) > tolerance {
            problems.push(format!("{name}: starts at {first:?}, expected {their_first:?}"));
        }
        if !name.ends_with("zigzag-parametric-step") && distance(&last, &their_last) > tolerance {
            problems.push(format!("{name}: ends at {last:?}, expected {their_last:?}"));
        }
        let one_pass = ours.len() == 1;
        for at in ours.iter().flat_map(|run| &run.points) {
            locations += 1;
            if name.ends_with("path-ps-on") {
                continue;
            }
            let depth = mill.deepest(&program.patch, &point(at), &axis(at));
            let above = one_pass && !name.contains("posn") && depth < -outside - DENSE;
            if depth > inside + DENSE || above {
                problems.push(format!("{name}: depth {depth} at {at:?}"));
            }
        }
        let count = |runs: &[Run]| runs.iter().map(|run| run.points.len()).sum::<usize>();
        if one_pass && count(&ours) > count(&theirs) {
            problems.push(format!("{name}: {} locations, {} are enough", count(&ours), count(&theirs)));
        }
        for (ending, limit) in [("zigzag-fixed-step", 0.4), ("pickfd-clearance", 0.6)] {
            if name.ends_with(ending) && widest_step(&program, &ours) > limit {
                problems.push(format!("{name}: a step over of {}", widest_step(&program, &ours)));
            }
        }
    }
    assert!(locations > 300, "{locations}");
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn interferences_have_their_true_depth_and_are_avoided_with_less() {
    let mut problems = Vec::new();
    let mut found = 0;
    for program in group("interference") {
        let name = title(&program.path);
        let wanted = first_error(&program.expected["diagnostics"], "number");
        let got = first_error(&program.ours["diagnostics"], "apt3");
        if wanted != got {
            problems.push(format!("{name}: ends with {got:?}, expected {wanted:?}"));
        }
        let list = |report: &Value| report["interference"].as_array().cloned().unwrap_or_default();
        let (ours, theirs) = (list(&program.ours), list(&program.expected));
        if ours.is_empty() != theirs.is_empty() {
            problems.push(format!("{name}: {} interferences, expected {}", ours.len(), theirs.len()));
        }
        let (mill, (inside, _)) = (Mill::of(&program.ours), band(&program.ours));
        let deepest = |end: &Point, axis: &Point| mill.deepest(&program.patch, end, axis);
        for one in &ours {
            found += 1;
            let (end, along) = (point(&numbers(&one["te"])), point(&numbers(&one["ta"])));
            let (depth, dense) = (one["depth"].as_f64().unwrap(), deepest(&end, &along));
            // On ridges of the depth the dense search stops short: the point told must be as deep as told, and none deeper.
            let uv = numbers(&one["uv"]);
            let told = mill.depth(&end, &along, &program.patch.at(uv[0], uv[1]));
            if (depth - told).abs() > DENSE || dense > depth + DENSE {
                problems.push(format!("{name}: depth {depth}, there {told}, truly {dense}"));
            }
            if one["remedy"]["result"] == "failed" && !name.contains("lift-normal") {
                problems.push(format!("{name}: not avoided at {end:?}"));
            }
            // Where there is a lift along the axis alone, hardly less would do.
            if let (Some(lift), None) = (one["remedy"]["lift"].as_f64(), one["remedy"]["tilt"].as_f64()) {
                let less = 0.98 * lift - 0.01;
                let lower = std::array::from_fn(|k| end[k] + less * along[k]);
                if one["remedy"]["along"] == "axis" && less > 0.0 && deepest(&lower, &along) <= inside {
                    problems.push(format!("{name}: lifted by {lift}, {less} would do"));
                }
            }
        }
        // What is put out is clear wherever a remedy was found.
        let failed = ours.iter().any(|one| one["remedy"]["result"] != "avoided");
        if !failed && program.ours["ok"] == true {
            for at in runs(&program.ours).iter().flat_map(|run| &run.points) {
                let depth = deepest(&point(at), &axis(at));
                if depth > inside + DENSE {
                    problems.push(format!("{name}: still {depth} deep at {at:?}"));
                }
            }
        }
    }
    assert!(found > 20, "{found}");
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

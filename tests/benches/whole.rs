//! What users wait for: a whole program from text to report, one cut vector, a keystroke in a large file.

#![allow(missing_docs, reason = "benchmarks")]
#![allow(clippy::unwrap_used, reason = "a benchmark may stop at once")]

use apt_ide::Analysis;
use apt_tests::{
    repository,
    runs::{analysis, read},
};
use divan::{Bencher, counter::ItemsCount};

fn main() {
    divan::main();
}

const TYPICAL: [&str; 6] = [
    "tests/oracle/motion2d/circle-full-outside.apt",
    "tests/oracle/motion3d/sphere-ps-flat.apt",
    "tests/oracle/motion3d/cone-drive-flat.apt",
    "tests/oracle/motion3d/cylinder-cylinder.apt",
    "tests/oracle/motion3d/quadric-paraboloid-ps.apt",
    "examples/bearing-cover.apt",
];

fn run(analysis: &Analysis) -> usize {
    let report = analysis.run(None, &|| false, &mut |_, _| {}).unwrap();
    serde_json::to_string(&report).unwrap().len()
}

/// Text to JSON report, nothing known beforehand.
#[divan::bench(args = TYPICAL)]
fn program(bencher: Bencher<'_, '_>, path: &str) {
    let text = read(&repository(path));
    bencher.bench(|| run(&analysis(&text, "free")));
}

/// The motion of each program: what is timed is the whole run, items are cut vectors.
fn motion(bencher: Bencher<'_, '_>, text: &str) {
    let result = analysis(text, "free").document().run(&|| false, &mut |_, _| {}).unwrap();
    assert_eq!(result.findings.len(), 0, "only whole paths are measured");
    let vectors = result.totals().points;
    bencher
        .counter(ItemsCount::new(vectors))
        .bench(|| analysis(text, "free").document().run(&|| false, &mut |_, _| {}).unwrap());
}

#[divan::bench]
fn cut_vectors_round_a_circle(bencher: Bencher<'_, '_>) {
    motion(
        bencher,
        "NUMPTS/2000\nCUTTER/.5\nINTOL/.00001\nOUTTOL/.00001\nC1=CIRCLE/0,0,2\nL1=LINE/XAXIS\nFROM/5,0,1\nGO/TO,C1\n\
         TLLFT,GOLFT/C1,ON,2,INTOF,L1\nFINI\n",
    );
}

#[divan::bench]
fn cut_vectors_over_a_sphere(bencher: Bencher<'_, '_>) {
    motion(
        bencher,
        "CUTTER/.5,.25\nINTOL/.00001\nOUTTOL/.00001\nS=SPHERE/0,0,-2,2\nD=PLANE/0,1,0,.8\nFROM/-2,0,2\n\
         GO/ON,D,TO,S,ON,(PLANE/1,0,0,-1.2)\nINDIRV/1,0,0\nTLON,GOFWD/D,ON,(PLANE/1,0,0,1.2)\nFINI\n",
    );
}

#[divan::bench]
fn cut_vectors_round_a_cone_with_a_corner_cutter(bencher: Bencher<'_, '_>) {
    motion(
        bencher,
        "CUTTER/.5,.1\nINTOL/.00001\nOUTTOL/.00001\nCN=CONE/(POINT/0,0,4),(VECTOR/0,0,-1),30\nPS=PLANE/0,0,1,0\n\
         FROM/5,-.5,1\nGO/TO,CN,TO,PS\nTLRGT,GORGT/CN,ON,(PLANE/1,0,0,0)\nFINI\n",
    );
}

#[divan::bench]
fn cut_vectors_on_a_paraboloid(bencher: Bencher<'_, '_>) {
    motion(bencher, &read(&repository("tests/oracle/motion3d/quadric-paraboloid-ps.apt")));
}

fn cl_lines(count: usize) -> String {
    (0..count).map(|number| format!("GOTO/{}.125,{}.5,-3.0625\n", number % 977, number % 313)).collect()
}

/// Text to Section 1 of a CL file.
#[divan::bench(args = [10_000, 100_000, 1_000_000], sample_count = 5)]
fn open_cl(bencher: Bencher<'_, '_>, lines: usize) {
    let text = cl_lines(lines);
    bencher
        .counter(ItemsCount::new(lines))
        .bench(|| analysis(&text, "cl").document().program(&|| false).unwrap().record_count());
}

/// A keystroke in the middle: the edit and Section 1 after it.
#[divan::bench(args = [10_000, 100_000, 1_000_000], sample_count = 50)]
fn type_a_character(bencher: Bencher<'_, '_>, lines: usize) {
    let first = analysis(&cl_lines(lines), "cl");
    first.document().program(&|| false).unwrap();
    let at = usize::from(first.document().tree().statement(lines / 2).start) + 5;
    bencher.bench(|| {
        let edited = first.edit(at..at, "7");
        edited.document().program(&|| false).unwrap().statistics()
    });
}

/// A keystroke in a program with motions that it does not concern: edit, run and report.
#[divan::bench]
fn run_again_after_a_remark(bencher: Bencher<'_, '_>) {
    let first = analysis(&read(&repository("examples/bearing-cover.apt")), "free");
    run(&first);
    let at = first.text().find("$$ It shows").unwrap() + 3;
    bencher.bench(|| run(&first.edit(at..at, "x")));
}

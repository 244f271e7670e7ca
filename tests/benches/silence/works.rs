//! Works that users may cancel, larger than they meet them.

use std::fmt::Write;

use apt_geometry::patience::Waiting;
use apt_ide::{
    Analysis, Cancel, Level,
    conversion::ClDialect,
    format::{FormatOptions, plan},
};
use apt_tests::{oracle, repository, runs};

use super::clock::{Heard, listen};

/// Vertices of a pocket.
const VERTICES: usize = 20;

/// Steps of a work and what was heard of them.
pub(crate) type Steps = Vec<(&'static str, Heard)>;

/// A work to listen to.
pub(crate) type Work = fn() -> Steps;

/// All works by name.
pub(crate) fn all() -> [(&'static str, Work); 8] {
    [
        ("copies", || everything(&copies(300, 2_000), "free")),
        ("definitions", || everything(&definitions(20_000), "free")),
        ("listing", || everything(&listing(20_000), "free")),
        ("sums", || everything(&sums(100_000), "free")),
        ("loop", || everything(&turns(100_000), "free")),
        ("locations", || everything(&locations(100_000), "cl")),
        ("pockets", || everything(&pockets(40), "free")),
        ("oracle", programs),
    ]
}

/// A path of some positions, copied often.
fn copies(positions: usize, times: usize) -> String {
    let mut text = "FROM/0,0,0\nINDEX/1\n".to_owned();
    for number in 0..positions {
        let _ = writeln!(text, "GOTO/{},{},0", number % 17, number % 23);
    }
    let _ = writeln!(text, "COPY/1,TRANSL,0,1,0,{times}\nFINI");
    text
}

/// Points, lines and circles.
fn definitions(count: usize) -> String {
    let mut text = String::new();
    for number in 0..count {
        let (x, y) = (number % 977, number % 313);
        let _ = writeln!(text, "P{number}=POINT/{x}.125,{y}.5\nL{number}=LINE/P{number},ATANGL,30");
        let _ = writeln!(text, "C{number}=CIRCLE/CENTER,P{number},RADIUS,.5");
    }
    text + "FINI\n"
}

/// The same, and a list of all.
fn listing(count: usize) -> String {
    definitions(count).replace("FINI\n", "PRINT/3,ALL\nFINI\n")
}

/// Assignments that each need the one before.
fn sums(count: usize) -> String {
    "A=0\n".to_owned() + &"A=A+1\n".repeat(count) + "FINI\n"
}

/// A loop of three statements.
fn turns(count: usize) -> String {
    format!("LOOPST\nA=0\nM)A=A+1\nGOTO/A,0,0\nIF(A-{count})M,N,N\nN)B=A\nLOOPND\nFINI\n")
}

/// Pockets of as many vertices as a statement takes, each cleared in many passes; no two are alike, so that each is computed.
fn pockets(count: usize) -> String {
    let mut text = "CUTTER/.1\nFROM/0,0,2\n".to_owned();
    for number in 0..count {
        let _ = write!(text, "POCKET/.04,1,.8,5,10,8,1,1");
        for vertex in 0..VERTICES {
            let angle = std::f64::consts::TAU * vertex as f64 / VERTICES as f64;
            let radius = 10.0 + 0.1 * number as f64;
            let _ = write!(text, ",$\n{:.4},{:.4},0", radius * angle.cos(), radius * angle.sin());
        }
        text.push('\n');
    }
    text + "FINI\n"
}

/// Cutter locations as other systems write them.
fn locations(count: usize) -> String {
    let line = |number| format!("GOTO/{}.125,{}.5,-3.0625\n", number % 977, number % 313);
    (0..count).map(line).collect()
}

/// All that can be asked of a program.
fn everything(text: &str, dialect: &str) -> Steps {
    let analysis = runs::analysis(text, dialect);
    let silent = &mut |_, _| {};
    let mut steps = vec![("reading, which nobody cancels", listen(|_| runs::analysis(text, dialect)))];
    let mut note = |name, heard| steps.push((name, heard));
    note("Section 1", listen(|cancel| analysis.program(cancel)));
    note("findings", listen(|cancel| analysis.diagnostics(Level::Section1, cancel, silent)));
    note(
        "gravest findings",
        listen(|cancel| analysis.worst_diagnostics(Level::Section1, 1_000, cancel, silent)),
    );
    note("run", listen(|cancel| analysis.result(cancel, silent)));
    note("report", listen(|cancel| analysis.run(None, cancel, silent)));
    note("stories", listen(|cancel| analysis.stories(None, cancel, silent)));
    note("scene", listen(|cancel| analysis.scene(cancel, silent)));
    note("CL text", listen(|cancel| analysis.cl_text(cancel, silent)));
    note("CL tape", listen(|cancel| analysis.cl_tape(cancel, silent)));
    note("tape", listen(|cancel| analysis.tape("linuxcnc", cancel, silent)));
    note("another dialect", listen(|cancel| analysis.convert(ClDialect::Nx, None, cancel, silent)));
    note("tool path", listen(|cancel| analysis.tool_path(cancel, silent)));
    note("expansion", listen(|cancel| analysis.expand(None, None, cancel)));
    note("inlays", listen(|cancel| analysis.inlays(0..text.len(), cancel)));
    note("actions", listen(|cancel| analysis.actions(0..text.len(), &[], Level::Motion, cancel, silent)));
    steps.extend(of_text(&analysis));
    steps.extend(at_a_place(&analysis, text.find("A=").unwrap_or(0)));
    steps
}

/// What is asked at a place.
fn at_a_place(analysis: &Analysis, offset: usize) -> Steps {
    vec![
        ("occurrences", listen(|cancel| analysis.occurrences(offset, cancel))),
        ("definitions", listen(|cancel| analysis.definitions_at(offset, cancel))),
        ("rename", listen(|cancel| analysis.rename(offset, "ZZZ", cancel))),
        ("completion", listen(|cancel| analysis.completions(offset + 1, cancel))),
        ("hover", listen(|cancel| analysis.hover(offset, cancel))),
    ]
}

/// What is told of the text alone.
fn of_text(analysis: &Analysis) -> Steps {
    vec![
        ("outline", listen(|cancel| analysis.outline(cancel))),
        ("folds", listen(|cancel| analysis.folds(cancel))),
        ("tokens", listen(|cancel| analysis.tokens(None, cancel))),
        ("formatting", listen(|cancel| formatted(analysis, cancel))),
        ("lenses", listen(|cancel| analysis.lenses(cancel))),
    ]
}

fn formatted(analysis: &Analysis, cancel: Cancel<'_>) {
    let (tree, waiting) = (analysis.document().tree(), Waiting::until(cancel));
    let options = FormatOptions::with(&tree.dialect(), &analysis.document().settings().format);
    drop(plan(tree, &options, waiting.patience()));
}

/// Every program of the oracle and the examples, judged and shown.
fn programs() -> Steps {
    let mut steps = [
        ("Section 1", Heard::default()),
        ("run", Heard::default()),
        ("report", Heard::default()),
        ("scene", Heard::default()),
    ];
    let silent = &mut |_, _| {};
    let examples = std::fs::read_dir(repository("examples")).unwrap().map(|entry| entry.unwrap().path());
    let examples = examples.filter(|path| path.extension().is_some_and(|one| one == "apt"));
    let mut all: Vec<_> = examples.map(|path| (path, "free")).collect();
    for group in oracle::GROUPS.iter().chain(&oracle::MILLING_GROUPS) {
        let dialect = oracle::dialect_of(group).as_str();
        all.extend(oracle::programs(group).into_iter().map(|path| (path, dialect)));
    }
    for (path, dialect) in all {
        let analysis = runs::analysis(&runs::read(&path), dialect);
        let heard = [
            listen(|cancel| analysis.program(cancel)),
            listen(|cancel| analysis.result(cancel, silent)),
            listen(|cancel| analysis.run(None, cancel, silent)),
            listen(|cancel| analysis.scene(cancel, silent)),
        ];
        for (step, heard) in steps.iter_mut().zip(heard) {
            step.1 = step.1.and(heard);
        }
    }
    steps.to_vec()
}

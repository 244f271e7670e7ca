//! What users wait for: evaluation of a long CL file, of a loop, and after an edit.

use apt_program::{Options, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree, TextRange, TextSize};

fn main() {
    divan::main();
}

fn tree(text: &str) -> SyntaxTree {
    SyntaxTree::parse(text, Dialect::named(DialectName::Free))
}

fn points(lines: usize) -> String {
    let mut text = String::from("PARTNO POINTS\n");
    for line in 0..lines {
        text.push_str(&format!("GOTO/{line}.125,{}.5,-.25\n", line % 77));
    }
    text.push_str("FINI\n");
    text
}

#[divan::bench(args = [100_000])]
fn plain_points(bencher: divan::Bencher<'_, '_>, lines: usize) {
    let tree = tree(&points(lines));
    bencher
        .counter(divan::counter::ItemsCount::new(lines))
        .bench(|| evaluate(&tree, &Options::default(), &|| false));
}

/// Statements of every sort with names of their own, as in a long program: ten for each feature.
fn features(count: usize) -> String {
    let mut text = String::from("PARTNO FEATURES\nCANON/ON\n");
    for n in 0..count {
        text.push_str(&format!(
            "X{n}={n}*.25+SQRTF(2)\nP{n}=POINT/X{n},{n}\nQ{n}=POINT/(X{n}+3),4,1\nL{n}=LINE/P{n},Q{n}\n\
             C{n}=CIRCLE/CENTER,P{n},RADIUS,2.5\nI{n}=POINT/XLARGE,INTOF,L{n},C{n}\n\
             PL=PLANE/P{n},Q{n},(POINT/0,0,9)\nV=VECTOR/P{n},Q{n}\nGOTO/I{n}\nSPINDL/X{n},CLW\n"
        ));
    }
    text.push_str("FINI\n");
    text
}

#[divan::bench(args = [100_000])]
fn mixed_geometry(bencher: divan::Bencher<'_, '_>, statements: usize) {
    let tree = tree(&features(statements / 10));
    bencher
        .counter(divan::counter::ItemsCount::new(statements))
        .bench(|| evaluate(&tree, &Options::default(), &|| false));
}

#[divan::bench(args = [100_000])]
fn loop_turns(bencher: divan::Bencher<'_, '_>, turns: usize) {
    let text = format!("I=0\nLOOPST\nA)I=I+1\nGOTO/I,(I*2),0\nIF(I-{turns})A,Z,Z\nZ)LOOPND\nFINI\n");
    let tree = tree(&text);
    bencher
        .counter(divan::counter::ItemsCount::new(turns * 3))
        .bench(|| evaluate(&tree, &Options::default(), &|| false));
}

#[divan::bench(args = [100_000])]
fn edit_in_the_middle(bencher: divan::Bencher<'_, '_>, lines: usize) {
    let text = points(lines);
    let before = tree(&text);
    let program = evaluate(&before, &Options::default(), &|| false);
    let at = TextSize::new(u32::try_from(text.len() / 2).unwrap_or(0));
    let line = text[usize::from(at)..].find('\n').unwrap_or(0);
    let at = at + TextSize::new(u32::try_from(line).unwrap_or(0));
    let (after, change) = before.edit(TextRange::empty(at), "\nGOTO/1,2,3");
    bencher.bench(|| program.update(&after, &change, &Options::default(), &|| false));
}

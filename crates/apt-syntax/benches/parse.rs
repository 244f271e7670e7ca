//! What users wait for: opening a file, typing in a large one, reading what statements say.

#![allow(missing_docs, reason = "benchmarks")]

use apt_syntax::{Dialect, DialectName, SyntaxTree, TextRange, TextSize};
use divan::Bencher;

fn main() {
    divan::main();
}

fn cl_lines(count: usize) -> String {
    (0..count).map(|number| format!("GOTO/{}.125,{}.5,-3.0625\n", number % 977, number % 313)).collect()
}

#[divan::bench(args = [100_000, 1_000_000])]
fn open(bencher: Bencher<'_, '_>, lines: usize) {
    let text = cl_lines(lines);
    bencher.bench(|| SyntaxTree::parse(&text, Dialect::named(DialectName::Cl)));
}

#[divan::bench(args = [100_000])]
fn open_and_read(bencher: Bencher<'_, '_>, lines: usize) {
    let text = cl_lines(lines);
    bencher.bench(|| {
        let tree = SyntaxTree::parse(&text, Dialect::default());
        tree.statements().map(|view| view.parsed().elements.len()).sum::<usize>()
    });
}

#[divan::bench(args = [10_000, 1_000_000])]
fn type_a_character(bencher: Bencher<'_, '_>, lines: usize) {
    let text = cl_lines(lines);
    let tree = SyntaxTree::parse(&text, Dialect::named(DialectName::Free));
    let middle = tree.statement(lines / 2).start + TextSize::new(5);
    bencher.bench(|| {
        let (tree, change) = tree.edit(TextRange::empty(middle), "7");
        tree.statement(change.first).parsed()
    });
}

#[divan::bench]
fn ten_megabyte_line(bencher: Bencher<'_, '_>) {
    let text = "GOTO/".to_owned() + &"1.5,".repeat(2_500_000) + "2\n";
    bencher.bench(|| SyntaxTree::parse(&text, Dialect::default()).statement(0).parsed());
}

//! Evaluation after edits equals evaluation from scratch, and costs what the edit touches.

use apt_program::{Options, Program, evaluate};
use apt_syntax::{Dialect, DialectName, SyntaxTree, TextRange, TextSize};
use proptest::prelude::*;

fn parse(text: &str) -> SyntaxTree {
    SyntaxTree::parse(text, Dialect::named(DialectName::Free))
}

fn run(tree: &SyntaxTree) -> Program {
    evaluate(tree, &options(), &|| false)
}

/// Small budgets: random programs loop endlessly now and then.
fn options() -> Options {
    Options { statement_budget: 5_000, ..Options::default() }
}

fn assert_same(left: &Program, right: &Program, text: &str) {
    let records = |program: &Program| program.records().cloned().collect::<Vec<_>>();
    let findings = |program: &Program| program.findings().cloned().collect::<Vec<_>>();
    let definitions = |program: &Program| program.definitions().cloned().collect::<Vec<_>>();
    assert_eq!(records(left), records(right), "records of\n{text}");
    assert_eq!(definitions(left), definitions(right), "definitions of\n{text}");
    assert_eq!(findings(left), findings(right), "findings of\n{text}");
    assert_eq!(left.symbols(), right.symbols(), "symbols of\n{text}");
    assert_eq!(left.record_count(), right.record_count());
}

fn edited(
    tree: &SyntaxTree,
    start: usize,
    end: usize,
    insert: &str,
) -> (SyntaxTree, apt_syntax::StatementChange) {
    let size = |offset: usize| TextSize::new(u32::try_from(offset).expect("small"));
    tree.edit(TextRange::new(size(start), size(end)), insert)
}

fn long_program(lines: usize) -> String {
    let mut text = String::from("PARTNO LONG\nA=1\nP=POINT/1,2,3\n");
    for line in 0..lines {
        text.push_str(&format!("GOTO/{line},A,0\n"));
    }
    text.push_str("FINI\n");
    text
}

#[test]
fn an_edit_in_the_middle_evaluates_little() {
    let text = long_program(10_000);
    let tree = parse(&text);
    let program = run(&tree);
    assert_eq!(program.statistics().evaluated_statements, 10_004);
    let at = text.find("GOTO/5000,").expect("the line");
    let (tree, change) = edited(&tree, at + 5, at + 9, "7777");
    let updated = program.update(&tree, &change, &options(), &|| false);
    assert_same(&updated, &run(&tree), "an edited line");
    assert!(updated.statistics().evaluated_statements <= 256, "{:?}", updated.statistics());
    assert!(updated.statistics().reused_statements >= 9_700);
}

#[test]
fn an_edit_of_a_short_program_evaluates_a_small_part_of_it() {
    for lines in [200, 1_000, 2_000] {
        let text = long_program(lines);
        let tree = parse(&text);
        let program = run(&tree);
        let at = text.find(&format!("GOTO/{},", lines / 2)).expect("the line");
        let (tree, change) = edited(&tree, at + 5, at + 6, "7");
        let updated = program.update(&tree, &change, &options(), &|| false);
        assert_same(&updated, &run(&tree), "an edited line");
        let most = (lines as u64 / 16).max(32);
        assert!(updated.statistics().evaluated_statements <= most, "{lines}: {:?}", updated.statistics());
    }
}

#[test]
fn inserted_lines_move_the_rest() {
    let text = long_program(2_000);
    let tree = parse(&text);
    let program = run(&tree);
    let at = text.find("GOTO/500,").expect("the line");
    let (tree, change) = edited(&tree, at, at, "$$ one\nGOTO/9,9,9\n$$ three\n");
    let updated = program.update(&tree, &change, &options(), &|| false);
    assert_same(&updated, &run(&tree), "inserted lines");
    assert!(updated.statistics().evaluated_statements <= 260, "{:?}", updated.statistics());
    let last = updated.records().last().expect("records");
    assert_eq!(last.origin.isn, 2_007);
}

#[test]
fn an_if_that_is_being_written_costs_little_at_every_step() {
    let mut text = long_program(4_000);
    let mut tree = parse(&text);
    let mut program = run(&tree);
    let at = text.find("GOTO/2000,").expect("the line");
    let steps = [
        (0, "IF(A.EQ.2)THEN\n"),
        (15, "  GOTO/1,1,1\n"),
        (28, "ELSE\n"),
        (33, "  GOTO/2,2,2\n"),
        (46, "ENDIF\n"),
    ];
    for (offset, insert) in steps {
        let place = at + offset;
        let (next, change) = edited(&tree, place, place, insert);
        text.insert_str(place, insert);
        program = program.update(&next, &change, &options(), &|| false);
        tree = next;
        assert_eq!(tree.text(), text);
        assert_same(&program, &run(&tree), insert);
        assert!(program.statistics().evaluated_statements <= 512, "{insert}: {:?}", program.statistics());
    }
    assert!(!program.findings().any(|finding| finding.kind.to_string().contains("ENDIF")));
}

/// Names that begin and cease to be read, defined, and listed, one edit after the other.
#[test]
fn names_that_nobody_reads_are_known_after_every_edit() {
    let filler = |from: usize| (from..from + 400).map(|n| format!("GOTO/{n},0,0\n")).collect::<String>();
    let text = format!(
        "U=1\nV=2\nP=POINT/1,2\nQ=POINT/3,4\n{}GOTO/P\n{}GOTO/V,0,0\n$$ end\nFINI\n",
        filler(0),
        filler(1000)
    );
    let mut tree = parse(&text);
    let mut text = text;
    let mut program = run(&tree);
    let unused = |program: &Program| -> Vec<String> {
        let told = program.findings().filter_map(|finding| match &finding.kind {
            apt_program::FindingKind::Unused { name } => Some(name.to_string()),
            _ => None,
        });
        told.collect()
    };
    assert_eq!(unused(&program), ["U", "Q"]);
    for (old, new, expected) in [
        ("GOTO/P\n", "GOTO/Q\n", vec!["U", "P"]),
        ("GOTO/200,0", "GOTO/U,0", vec!["P"]),
        ("GOTO/U,0", "GOTO/201,0", vec!["U", "P"]),
        ("U=1", "W=1", vec!["W", "P"]),
        ("GOTO/V,0,0", "GOTO/7,0,0", vec!["W", "V", "P"]),
        ("GOTO/1005,0,0", "A=1005", vec!["W", "V", "P", "A"]),
        ("P=POINT/1,2\n", "P=POINT/1,W\n", vec!["V", "P", "A"]),
        ("GOTO/1100,0,0\n", "GOTO/1100,0,0\nGOTO/P\n", vec!["V", "A"]),
        ("$$ end", "PRINT/3,ALL", vec![]),
        ("PRINT/3,ALL", "$$ end", vec!["V", "A"]),
    ] {
        let at = text.find(old).expect("the place");
        let (next, change) = edited(&tree, at, at + old.len(), new);
        text.replace_range(at..at + old.len(), new);
        program = program.update(&next, &change, &options(), &|| false);
        tree = next;
        assert_same(&program, &run(&parse(&text)), &format!("{old} replaced by {new}"));
        assert_eq!(unused(&program), expected, "{old} replaced by {new}");
    }
}

/// Jumps back without end, up to the usual budget: what is compared with the evaluation before the edit is at each turn what
/// it is at the first one.
#[test]
fn an_edit_in_a_program_that_jumps_back_without_end_costs_what_an_evaluation_costs() {
    let text = "I=0\nA1)I=I+1\nA=I\nB=A\nC=B\nIF(-2)A1,A2,A2\nA2)GOTO/0,0,0\nFINI\n";
    let tree = SyntaxTree::parse(text, Dialect::named(DialectName::Apt4));
    let usual = Options::default();
    let program = evaluate(&tree, &usual, &|| false);
    let at = text.find("I+1").expect("the step") + 2;
    let (tree, change) = edited(&tree, at, at + 1, "2");
    let updated = program.update(&tree, &change, &usual, &|| false);
    let fresh = evaluate(&tree, &usual, &|| false);
    assert_eq!(updated.symbols(), fresh.symbols());
    assert_eq!(updated.record_count(), fresh.record_count());
    let findings = |program: &Program| program.findings().cloned().collect::<Vec<_>>();
    assert_eq!(findings(&updated), findings(&fresh));
}

#[test]
fn a_changed_value_reaches_everything_after_it() {
    let text = long_program(1_000);
    let tree = parse(&text);
    let program = run(&tree);
    let at = text.find("A=1").expect("the line");
    let (tree, change) = edited(&tree, at + 2, at + 3, "5");
    let updated = program.update(&tree, &change, &options(), &|| false);
    assert_same(&updated, &run(&tree), "a changed scalar");
    assert!(updated.statistics().evaluated_statements > 900);
}

#[test]
fn findings_of_a_loop_do_not_depend_on_where_checkpoints_are() {
    // The first turn finds Q not reserved, later turns find its element undefined at the same place.
    let filler = "A=1\n".repeat(12);
    let text = format!("T1)I=1\nGODLTA/Q(1)\n{filler}RESERV/Q,5\n{filler}I=0\n{filler}IF(I-3)T1,T2,T2\n");
    let tree = SyntaxTree::parse(&text, Dialect::named(DialectName::Apt4));
    let program = run(&tree);
    let at = text.find("I=0").expect("the line");
    let (tree, change) = edited(&tree, at, at, "");
    assert_same(&program.update(&tree, &change, &options(), &|| false), &run(&tree), &text);
}

/// Statements that random programs are made of.
const LINES: &[&str] = &[
    "A=1",
    "A=A+1",
    "B=A*2",
    "A=ZZ",
    "B=1/0",
    "P1=POINT/A,B",
    "P1=POINT/CANON,1,2,3",
    "P2=POINT/1,2,3",
    "L1=LINE/P1,P2",
    "L1=LINE/XAXIS",
    "L2=LINE/YAXIS",
    "C1=CIRCLE/0,0,A",
    "CANON/ON",
    "CANON/OFF",
    "GOTO/P1",
    "GOTO/A,B,3",
    "FROM/0,0",
    "GO/TO,L1",
    "TLLFT,GOLFT/L1",
    "GORGT/L2,TO,L1",
    "TLON,GOFWD/L2",
    "RAPID",
    "FEDRAT/A,IPM",
    "M1=MACRO/X,Y=2",
    "TERMAC",
    "X=X+Y",
    "GOTO/X,Y,0",
    "CALL/M1,X=A",
    "CALL/M1,X=3",
    "LOOPST",
    "LOOPND",
    "I=0",
    "T1)I=I+1",
    "IF(I-3)T1,T2,T2",
    "T2)B=I",
    "JUMPTO/T1",
    "RESERV/Q,5",
    "Q(A)=I",
    "Q(2)=P1",
    "GODLTA/Q(1)",
    "M2=MATRIX/TRANSL,A,0,0",
    "REFSYS/M2",
    "REFSYS/NOMORE",
    "ZSURF/0,0,1,A",
    "TRACUT/M2",
    "SYN/GG,GOTO",
    "GG/1,1,1",
    "OBTAIN,POINT/P1,PX,PY",
    "TRANTO/T2",
    "$$ a comment",
    "",
    "P=(",
    "FINI",
    "PPRINT HI",
    "GOLFT/L1,TO,L2,T1,TO,C1,T2",
    "INDEX/1",
    "COPY/1,SAME,2",
    "MULTAX",
    "PT1=PATERN/LINEAR,P1,P2,4",
    "GOTO/PT1,INVERS",
    "DO/T2,J=1,2",
    "IF(A.GT.1)JUMPTO/T2",
    "IF(A.GT.1)GOTO/A,1",
    "MULTAX/OFF",
    "GOTO/1,2,3,0,0,1",
    "TO=4",
    "LONGNAME=ACOSF(.5)",
    "PRINT/3,ALL",
    "CALL/M1",
];

fn line() -> impl Strategy<Value = &'static str> {
    prop::sample::select(LINES)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn update_equals_evaluation_from_scratch(
        lines in prop::collection::vec(line(), 1..60),
        repeat in 1_usize..8,
        dialect in prop::sample::select(&[DialectName::Free, DialectName::Apt4][..]),
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..3, prop::collection::vec(line(), 0..3)), 1..6),
    ) {
        let mut current: Vec<&str> = lines.iter().copied().cycle().take(lines.len() * repeat).collect();
        let mut tree = SyntaxTree::parse(&(current.join("\n") + "\n"), Dialect::named(dialect));
        let mut program = run(&tree);
        for (place, removed, inserted) in edits {
            let first = place.index(current.len().max(1)).min(current.len());
            let last = (first + removed).min(current.len());
            let offset = |index: usize| current[..index].iter().map(|line| line.len() + 1).sum::<usize>();
            let text: String = inserted.iter().map(|line| format!("{line}\n")).collect();
            let (new_tree, change) = edited(&tree, offset(first), offset(last), &text);
            current.splice(first..last, inserted);
            tree = new_tree;
            program = program.update(&tree, &change, &options(), &|| false);
            assert_same(&program, &run(&tree), &tree.text());
        }
    }

    #[test]
    fn mutated_programs_never_panic(
        lines in prop::collection::vec(line(), 1..40),
        cuts in prop::collection::vec((any::<prop::sample::Index>(), "[ -~]{0,3}"), 0..12),
        dialect in prop::sample::select(&DialectName::ALL[..]),
    ) {
        let mut text: Vec<char> = lines.join("\n").chars().collect();
        for (place, insert) in cuts {
            if !text.is_empty() {
                let at = place.index(text.len());
                text.splice(at..=at, insert.chars());
            }
        }
        let text: String = text.into_iter().collect();
        let tree = SyntaxTree::parse(&text, Dialect::named(dialect));
        let program = evaluate(&tree, &options(), &|| false);
        prop_assert!(program.is_complete());
        let expansion = apt_program::expand(&tree, &options(), None, None, &|| false);
        prop_assert!(expansion.lines.len() < 1_000_000);
    }
}

/// A program of `parts` parts with 500 statements each; each begins with a definition and ends with a use of it.
fn program_in_parts(parts: usize) -> String {
    let mut text = String::from("PARTNO PARTS\nA=1\n");
    for part in 0..parts {
        text.push_str(&format!("N{part}=POINT/{part},A\n"));
        (0..498).for_each(|line| text.push_str(&format!("GOTO/{line},{part},0\n")));
        text.push_str(&format!("GOTO/N{part}\n"));
    }
    text.push_str("GOTO/N0\nFINI\n");
    text
}

#[test]
fn only_what_uses_a_changed_name_is_evaluated_again() {
    let text = program_in_parts(20);
    let tree = parse(&text);
    let program = run(&tree);
    // N0 is used 500 statements behind and at the end; what is between is taken over.
    for (from, to) in
        [("N0=POINT/0", "N0=POINT/7"), ("N0=POINT", "N9=POINT"), ("N0=POINT", "$$ one\nN0=POINT")]
    {
        let at = text.find(from).expect("the line");
        let (tree, change) = edited(&tree, at, at + from.len(), to);
        let updated = program.update(&tree, &change, &options(), &|| false);
        assert_same(&updated, &run(&tree), to);
        assert!(updated.statistics().evaluated_statements <= 1_800, "{to}: {:?}", updated.statistics());
        // What was taken over is as good as new: an edit behind, and one that takes everything back.
        let again = tree.text().find("N15=POINT/15").expect("the line");
        let (tree, change) = edited(&tree, again, again + 3, "N16");
        let behind = updated.update(&tree, &change, &options(), &|| false);
        assert_same(&behind, &run(&tree), to);
        let (tree, change) = edited(&tree, 0, usize::from(tree.len()), &text);
        assert_same(&behind.update(&tree, &change, &options(), &|| false), &program, "taken back");
    }
}

#[test]
fn a_name_that_comes_and_goes_changes_suggestions_far_behind() {
    let text = program_in_parts(4).replace("GOTO/N3\n", "GOTO/N33\n");
    let tree = parse(&text);
    let program = run(&tree);
    let at = text.find("N0=POINT").expect("the line");
    let (tree, change) = edited(&tree, at, at + 2, "N34");
    let updated = program.update(&tree, &change, &options(), &|| false);
    assert_same(&updated, &run(&tree), "a name like the misspelt one");
}

/// Random statements far from each other.
fn sparse_program(lines: &[(usize, usize)]) -> String {
    let mut text = String::new();
    for (line, fillers) in lines {
        text.push_str(LINES[*line % LINES.len()]);
        text.push('\n');
        (0..*fillers).for_each(|number| text.push_str(&format!("SPINDL/{number}\n")));
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn edits_of_long_programs_one_after_the_other_equal_evaluation_from_scratch(
        lines in prop::collection::vec((0_usize..1_000, 0_usize..150), 4..24),
        edits in prop::collection::vec((0.0_f64..1.0, 0_usize..4, 0_usize..1_000), 1..6),
    ) {
        let mut tree = parse(&sparse_program(&lines));
        let mut program = run(&tree);
        for (place, removed, line) in edits {
            let count = tree.statement_count();
            let first = ((count as f64 * place) as usize).min(count.saturating_sub(1));
            let start = usize::from(tree.statement(first).range().start());
            let end = usize::from(tree.statement((first + removed).min(count)).range().start());
            let insert = if line % 5 == 0 { String::new() } else { format!("{}\n", LINES[line % LINES.len()]) };
            let (next, change) = edited(&tree, start, end, &insert);
            program = program.update(&next, &change, &options(), &|| false);
            tree = next;
            assert_same(&program, &run(&tree), &tree.text());
        }
    }
}

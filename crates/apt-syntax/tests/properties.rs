//! What holds for every input: lossless, no panic, edits like a fresh parse, one grammar for texts and elements.

use apt_syntax::{Dialect, DialectName, SyntaxTree, TextRange, TextSize, parse_elements};
use proptest::prelude::*;

const PIECES: [&str; 46] = [
    "A",
    "P1",
    "POINT",
    "GOTO",
    "/",
    ",",
    "=",
    "(",
    ")",
    "+",
    "-",
    "*",
    "**",
    ".",
    "5",
    "12.5",
    "E2",
    "$",
    "$$",
    "\n",
    "\r\n",
    "\r",
    " ",
    "\t",
    "PARTNO ",
    "\nPPRINT X$",
    "MACRO",
    "CALL/",
    "IF(",
    ".EQ.",
    "THRU",
    "ALL",
    "OBTAIN,",
    "FINI",
    "1)",
    ";",
    "'",
    "~\n",
    "é",
    "\u{1F600}",
    "$$-> X $\n",
    "N12 ,",
    "TOOL PATH/",
    "          00010\n",
    "RAPID,",
    "\n\n",
];

fn any_text() -> impl Strategy<Value = String> {
    let pieces = prop::collection::vec(prop::sample::select(PIECES.to_vec()), 0..60)
        .prop_map(|pieces| pieces.concat());
    let programs = (
        prop::sample::select(programs()),
        any::<prop::sample::Index>(),
        any::<prop::sample::Index>(),
        any::<String>(),
    )
        .prop_map(|(program, from, length, insert)| {
            let from = program.floor_char_boundary(from.index(program.len() + 1));
            let to = program.floor_char_boundary((from + length.index(20)).min(program.len())).max(from);
            format!("{}{insert}{}", &program[..from], &program[to..])
        });
    let cards = prop::collection::vec(("[A-Z0-9=/,$ ]{0,75}", "[0-9 ]{0,9}"), 0..8)
        .prop_map(|cards| cards.iter().map(|(text, field)| format!("{text:<72}{field}\n")).collect());
    let bytes = prop::collection::vec(any::<u8>(), 0..200)
        .prop_map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    prop_oneof![4 => pieces, 2 => programs, 1 => cards, 1 => any::<String>(), 1 => bytes]
}

fn programs() -> Vec<&'static str> {
    vec![
        include_str!("data/macro-nested-calls.apt"),
        include_str!("data/inclusive-subscripts.apt"),
        include_str!("data/apt4-logical-if-and-or.apt"),
        include_str!("data/catia-01.aptsource"),
        include_str!("data/ncl-01.as"),
    ]
}

fn any_dialect() -> impl Strategy<Value = Dialect> {
    (prop::sample::select(DialectName::ALL.to_vec()), any::<bool>()).prop_map(|(name, semicolon)| {
        let dialect = Dialect::named(name);
        Dialect { semicolon_separates: semicolon, ..dialect }
    })
}

/// All that a document says.
fn check_same(found: &SyntaxTree, expected: &SyntaxTree) {
    assert_eq!(found.text(), expected.text());
    assert_eq!(found.layout(), expected.layout());
    let starts = |tree: &SyntaxTree| tree.statements().map(|view| view.start).collect::<Vec<_>>();
    assert_eq!(starts(found), starts(expected));
    for (found, expected) in found.statements().zip(expected.statements()) {
        assert_eq!(found.text(), expected.text());
        assert_eq!(found.parsed(), expected.parsed());
        assert_eq!(found.content_hash(), expected.content_hash());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_text_is_kept(text in any_text(), dialect in any_dialect()) {
        let tree = SyntaxTree::parse(&text, dialect);
        prop_assert_eq!(tree.text(), text.as_str());
        prop_assert_eq!(tree.syntax().text().to_string(), text.as_str());
        let mut end = TextSize::new(0);
        for view in tree.statements() {
            prop_assert_eq!(view.range().start(), end);
            end = view.range().end();
            prop_assert_eq!(tree.statement_at(view.start), view.index);
            prop_assert_eq!(view.syntax().text().to_string(), view.text());
            let mut token_end = TextSize::new(0);
            for token in view.tokens() {
                prop_assert_eq!(token.range.start(), token_end);
                token_end = token.range.end();
            }
            prop_assert_eq!(token_end, TextSize::of(view.text()));
            let parsed = view.parsed();
            for error in &parsed.errors {
                prop_assert!(error.range.end() <= TextSize::of(view.text()), "{:?} in {:?}", error, view.text());
            }
            let lexical = parsed.errors.iter().any(|error| error.kind.apt3().is_none_or(|number| number <= 21));
            if !lexical {
                prop_assert_eq!(&parse_elements(&parsed.elements, &dialect).statement, &parsed.statement);
            }
        }
        prop_assert_eq!(end, tree.len());
    }

    #[test]
    fn edits_are_like_a_fresh_parse(
        text in any_text(),
        dialect in any_dialect(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>(), any_text()), 1..6),
    ) {
        let mut tree = SyntaxTree::parse(&text, dialect);
        for (from, length, insert) in edits {
            let before = tree.text();
            for view in tree.statements() {
                view.parsed();
            }
            let from = before.floor_char_boundary(from.index(before.len() + 1));
            let to = before.floor_char_boundary((from + length.index(30)).min(before.len())).max(from);
            let range = TextRange::new(TextSize::new(from as u32), TextSize::new(to as u32));
            let insert: String = insert.chars().take(40).collect();
            let (after, change) = tree.edit(range, &insert);
            let expected = format!("{}{insert}{}", &before[..from], &before[to..]);
            check_same(&after, &SyntaxTree::parse(&expected, dialect));
            // The change tells exactly which statements are other ones.
            prop_assert_eq!(tree.statement_count() - change.removed + change.inserted, after.statement_count());
            for index in 0..change.first {
                let (old, new) = (tree.statement(index), after.statement(index));
                prop_assert_eq!(old.text(), new.text());
            }
            let behind = tree.statement_count() - change.first - change.removed;
            for index in 1..=behind {
                let old = tree.statement(tree.statement_count() - index);
                let new = after.statement(after.statement_count() - index);
                prop_assert_eq!(old.text(), new.text());
            }
            tree = after;
        }
    }
}

#[test]
fn an_edit_in_a_long_file_touches_one_statement() {
    let line = "GOTO/1.0,2.0,3.0\n";
    let text = line.repeat(100_000);
    let tree = SyntaxTree::parse(&text, Dialect::named(DialectName::Free));
    assert_eq!(tree.statement_count(), 100_000);
    let at = TextSize::new((line.len() * 70_000 + 5) as u32);
    let (after, change) = tree.edit(TextRange::empty(at), "9");
    assert_eq!((change.first, change.removed, change.inserted), (70_000, 1, 1));
    assert!(change.scanned <= 1024, "{change:?}");
    assert_eq!(after.statement(70_000).text(), "GOTO/91.0,2.0,3.0\n");
    assert_eq!(after.statement_count(), 100_000);
}

#[test]
fn an_edit_keeps_what_was_parsed_of_other_statements() {
    let text = "A=1\nB=2\nC=3\nD=4\n".repeat(300);
    let tree = SyntaxTree::parse(&text, Dialect::default());
    let before: Vec<_> = tree.statements().map(|view| view.parsed()).collect();
    let (after, change) = tree.edit(TextRange::new(TextSize::new(2002), TextSize::new(2003)), "77");
    assert_eq!((change.removed, change.inserted), (1, 1));
    let kept = after
        .statements()
        .zip(&before)
        .filter(|(view, old)| std::sync::Arc::ptr_eq(&view.parsed(), old))
        .count();
    assert_eq!(kept, 1199, "all but the changed one are the same object");
}

#[test]
fn a_continuation_joins_statements_across_blocks() {
    let text = "A=1\n".repeat(1000);
    let tree = SyntaxTree::parse(&text, Dialect::default());
    let end_of_block = TextSize::new(256 * 4 - 1);
    let (joined, change) = tree.edit(TextRange::empty(end_of_block), "$");
    assert_eq!((change.first, change.removed, change.inserted), (255, 2, 1));
    assert_eq!(joined.statement(255).text(), "A=1$\nA=1\n");
    let (divided, change) = joined.edit(TextRange::at(end_of_block, TextSize::new(1)), "");
    assert_eq!((change.first, change.removed, change.inserted), (255, 1, 2));
    check_same(&divided, &tree);
}

#[test]
fn giving_a_deck_its_sequence_fields_rereads_it() {
    let card = |number: usize| format!("{:<72}{number:05}\n", "A=1");
    let deck: String = (0..30).map(card).collect();
    let tree = SyntaxTree::parse(&deck, Dialect::default());
    assert!(tree.sequence_field());
    let plain = format!("{:<80}X\n", "A=1").repeat(100);
    let (mixed, change) = tree.edit(TextRange::empty(TextSize::new(0)), &plain);
    assert!(!mixed.sequence_field());
    assert_eq!((change.first, change.removed, change.inserted), (0, 30, 130));
    check_same(&mixed, &SyntaxTree::parse(&(plain + &deck), Dialect::default()));
}

#[test]
fn hostile_statements_end_with_an_error() {
    let cases = [
        "A=".to_owned() + &"(".repeat(100_000) + &")".repeat(100_000),
        "A=".to_owned() + &"1**".repeat(100_000) + "1",
        "A=".to_owned() + &"-".repeat(100_000) + "1",
        "IF(A.EQ.1)".repeat(50_000) + "A=1",
        "A=".to_owned() + &"B(".repeat(1000) + "1" + &")".repeat(1000),
        "IF(".to_owned() + &".NOT.".repeat(50_000) + "A.EQ.1)A=1",
        "A=".to_owned() + &"A=".repeat(50_000) + "1",
        "#".repeat(200_000),
        "A=POINT/".to_owned() + &"(POINT/".repeat(500) + "1" + &")".repeat(500),
    ];
    for text in &cases {
        // Cards would cut these statements at column 72.
        for name in [DialectName::Free, DialectName::Apt4, DialectName::Cl] {
            let tree = SyntaxTree::parse(text, Dialect::named(name));
            let parsed = tree.statement(0).parsed();
            assert!(parsed.is_broken(), "{name} {:.40}", text);
            assert!(parsed.errors.len() <= 40);
            assert_eq!(tree.syntax().text().to_string(), *text);
        }
    }
}

#[test]
fn a_very_long_line_is_one_statement() {
    let text = "GOTO/".to_owned() + &"1.5,".repeat(250_000) + "2\n";
    let tree = SyntaxTree::parse(&text, Dialect::default());
    assert_eq!(tree.statement_count(), 1);
    assert_eq!(tree.statement(0).parsed().errors, []);
    assert_eq!(tree.statement(0).parsed().elements.len(), 2 + 500_001);
    // Operators of one rank do not nest.
    let sum = "A=".to_owned() + &"1+2*3-".repeat(100_000) + "1\n";
    let tree = SyntaxTree::parse(&sum, Dialect::default());
    assert_eq!(tree.statement(0).parsed().errors, []);
    assert_eq!(tree.syntax().text().to_string(), sum);
}

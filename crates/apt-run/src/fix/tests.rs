//! What each fix makes of a program, and that the finding is gone afterwards.

use std::sync::Arc;

use proptest::prelude::*;

use crate::{
    diagnostic::Diagnostic,
    document::{Document, Level},
    format::applied,
    settings::Settings,
};

fn diagnostics(text: &str, dialect: &str) -> Vec<Diagnostic> {
    let settings = Arc::new(Settings { dialect: Some(dialect.to_owned()), ..Settings::default() });
    let document = Document::new(text, None, &settings);
    document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap()
}

/// Each fix of the first finding with a code: title and text afterwards.
fn fixes(text: &str, code: &str) -> Vec<(String, String)> {
    let found = diagnostics(text, "apt3");
    let finding = found.iter().find(|one| one.wording.code == code);
    let finding = finding.unwrap_or_else(|| panic!("{code} is not found in {text:?}: {found:?}"));
    finding.fixes.iter().map(|fix| (fix.title.clone(), applied(text, &fix.edits))).collect()
}

#[test]
fn each_finding_has_its_fixes() {
    for (code, text, expected) in [
        (
            "APT0101",
            "PNT1=POINT/1,2\nGOTO/PNT2\nFINI\n",
            &[("Replace PNT2 by PNT1", "PNT1=POINT/1,2\nGOTO/PNT1\nFINI\n")][..],
        ),
        (
            "APT0427",
            "MAC1=MACRO/A\nGOTO/A,0,0\nTERMAC\nCALL/MAC2,A=1\nFINI\n",
            &[("Replace MAC2 by MAC1", "MAC1=MACRO/A\nGOTO/A,0,0\nTERMAC\nCALL/MAC1,A=1\nFINI\n")],
        ),
        (
            "APT0428",
            "M1=MACRO/VARA\nGOTO/VARA,0,0\nTERMAC\nCALL/M1,VARB=1\nFINI\n",
            &[("Replace VARB by VARA", "M1=MACRO/VARA\nGOTO/VARA,0,0\nTERMAC\nCALL/M1,VARA=1\nFINI\n")],
        ),
        ("APT0017", "GOTOO/1,2,3\nFINI\n", &[("Replace GOTOO by GOTO", "GOTO/1,2,3\nFINI\n")]),
        (
            "APT0110",
            "P1=POINT/1,2\nP2=POINT/3,4\nGOTO/P1\nFINI\n",
            &[("Remove the definition of P2", "P1=POINT/1,2\nGOTO/P1\nFINI\n")],
        ),
        (
            "APT0110",
            "GOTO/0,0,0\nP2=POINT/3,4 $$ why\nFINI\n",
            &[("Remove the definition of P2", "GOTO/0,0,0\n $$ why\nFINI\n")],
        ),
        ("APT0110", "GOTO/0,0,0\nP2=POINT/3,$ x\n4 $$ why\nFINI\n", &[]),
        // Only behind the slash of a word does a comma separate something.
        ("APT0040", "A=(2+3)(4+5)\nFINI\n", &[("Insert *", "A=(2+3)*(4+5)\nFINI\n")]),
        // A list takes no operators but in parentheses.
        ("APT0040", "GOTO/(2+3)(4+5),0\nFINI\n", &[("Insert a comma", "GOTO/(2+3),(4+5),0\nFINI\n")]),
        ("APT0040", "GOTO/1,(2(4+5)),0\nFINI\n", &[("Insert *", "GOTO/1,(2*(4+5)),0\nFINI\n")]),
        ("APT0040", "A=(2+3),(4+5)\nFINI\n", &[]),
        ("APT0901", "GOTO/1,2,3", &[("Add FINI", "GOTO/1,2,3\nFINI\n")]),
        ("APT0901", "GOTO/1,2,3\r\n", &[("Add FINI", "GOTO/1,2,3\r\nFINI\r\n")]),
        // FINI in an open loop or macro is wrong.
        ("APT0901", "LOOPST\nGOTO/0,0,0\n", &[]),
        ("APT0901", "M=MACRO/A\nGOTO/A,0,0\n", &[]),
        ("APT0901", "LOOPST\nGOTO/0,0,0\nLOOPND\n", &[("Add FINI", "LOOPST\nGOTO/0,0,0\nLOOPND\nFINI\n")]),
        (
            "APT0423",
            "M=MACRO/A\nGOTO/A,0,0\nFINI\n",
            &[("Add TERMAC before it", "M=MACRO/A\nGOTO/A,0,0\nTERMAC\nFINI\n")],
        ),
        ("APT0421", "M=MACRO/A\nGOTO/A,0,0\n", &[("Add TERMAC", "M=MACRO/A\nGOTO/A,0,0\nTERMAC\n")]),
        ("APT0409", "LOOPST\nGOTO/0,0,0\n", &[("Add LOOPND", "LOOPST\nGOTO/0,0,0\nLOOPND\n")]),
        ("APT0422", "GOTO/0,0,0\nTERMAC\nFINI\n", &[("Remove the statement", "GOTO/0,0,0\nFINI\n")]),
        (
            "APT0014",
            "P=POINT/1,2,\nGOTO/P\nFINI\n",
            &[("Remove the , at the end", "P=POINT/1,2\nGOTO/P\nFINI\n")],
        ),
        (
            "APT0015",
            "A=(1+2\nGOTO/A,0,0\nFINI\n",
            &[("Close it at the end of the statement", "A=(1+2)\nGOTO/A,0,0\nFINI\n")],
        ),
        ("APT0016", "A=1+2)\nGOTO/A,0,0\nFINI\n", &[("Remove the parenthesis", "A=1+2\nGOTO/A,0,0\nFINI\n")]),
        (
            "APT0105",
            "P=POINT/1,2\n  P=POINT/3,4\nGOTO/P\nFINI\n",
            &[("Allow P to be defined again", "P=POINT/1,2\n  CANON/ON\n  P=POINT/3,4\nGOTO/P\nFINI\n")],
        ),
    ] {
        let found = fixes(text, code);
        let expected: Vec<_> =
            expected.iter().map(|(title, new)| ((*title).to_owned(), (*new).to_owned())).collect();
        assert_eq!(found, expected, "{code} in {text:?}");
        for (_, new) in found {
            assert!(
                diagnostics(&new, "apt3").iter().all(|one| one.wording.code != code),
                "{code} stays in {new:?}"
            );
        }
    }
}

#[test]
fn a_word_that_becomes_a_name_gets_another_one_where_its_uses_are_sure() {
    let found = |text: &str| {
        let found = diagnostics(text, "apt4");
        found.into_iter().find(|one| one.wording.code == "APT0111").expect("a shadowed word")
    };
    let text = "P=POINT/1,2,3\nPOINT1=5\nPOINT=3\nGOTO/P\nGOTO/POINT,POI$ x\nNT1,POINT\nFINI\n";
    let [fix] = &found(text).fixes[..] else { panic!("one fix") };
    assert_eq!((&*fix.title, fix.preferred), ("Call it POINT2", false));
    let new = applied(text, &fix.edits);
    assert_eq!(new, "P=POINT/1,2,3\nPOINT1=5\nPOINT2=3\nGOTO/P\nGOTO/POINT2,POI$ x\nNT1,POINT2\nFINI\n");
    assert_eq!(diagnostics(&new, "apt4"), []);
    // What is executed in another order than it is written in may mean the word or the name.
    let jumping = "P=POINT/1,2,3\nPOINT=3\nIF(POINT.EQ.3)GOTO/P\nGOTO/POINT,0,0\nFINI\n";
    assert!(found(jumping).fixes.is_empty());
}

#[test]
fn a_name_that_resembles_several_has_a_fix_for_each_and_none_is_preferred() {
    let found =
        diagnostics("PNT1=POINT/1,2\nPNT2=POINT/3,4\nGOTO/PNT3\nGOTO/PNT1\nGOTO/PNT2\nFINI\n", "apt3");
    let fixes = &found[0].fixes;
    assert_eq!(
        fixes.iter().map(|fix| (&*fix.title, fix.preferred)).collect::<Vec<_>>(),
        [("Replace PNT3 by PNT1", false), ("Replace PNT3 by PNT2", false),]
    );
    let one = diagnostics("PNT1=POINT/1,2\nGOTO/PNT2\nFINI\n", "apt3");
    let misspelt = one.iter().find(|one| one.wording.code == "APT0101").unwrap();
    assert!(misspelt.fixes[0].preferred);
}

#[test]
fn what_a_macro_is_given_is_not_changed_in_its_body() {
    let text = "PNT1=POINT/1,2\nM=MACRO/A\nGOTO/A\nTERMAC\nCALL/M,A=PNT2\nGOTO/PNT1\nFINI\n";
    for finding in diagnostics(text, "apt3") {
        for fix in finding.fixes {
            assert!(applied(text, &fix.edits).contains("GOTO/A\n"), "{fix:?}");
        }
    }
}

fn piece() -> impl Strategy<Value = &'static str> {
    proptest::sample::select(vec![
        "PNT1=POINT/1,2\n",
        "GOTO/PNT2\n",
        "A=(1\n",
        "A=1)\n",
        "M=MACRO/A\n",
        "TERMAC\n",
        "LOOPST\n",
        "LOOPND\n",
        "FINI\n",
        "FINI",
        "CALL/M,B=1\n",
        "GOTOO/1\n",
        "P=POINT/1,2,\n",
        " $$ c\n",
        "$\n",
        "\r\n",
        "  PARTNO X\n",
        "X)",
        "DO/1,I=1,2\n",
        "FINI/1\n",
        "CUT/1\n",
        "B=\u{fc}\n",
        "1 2",
        ";",
        "A=1 2\n",
        ",",
    ])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn fixes_of_damaged_programs_can_be_applied(
        pieces in proptest::collection::vec(piece(), 0..20),
        dialect in proptest::sample::select(vec!["free", "apt3", "apt4"]),
    ) {
        let text = pieces.concat();
        for finding in diagnostics(&text, dialect) {
            for fix in &finding.fixes {
                let mut end = 0;
                prop_assert!(!fix.edits.is_empty() && !fix.title.is_empty());
                for (range, insert) in &fix.edits {
                    prop_assert!(end <= range.start && text.get(range.clone()).is_some_and(|old| old != insert), "{:?}", fix);
                    end = range.end;
                }
            }
        }
    }
}

/// The comment that names the dialect is written where it counts: in the place of the one that is there, and not at all where
/// the settings decide.
#[test]
fn the_dialect_is_set_where_it_counts() {
    let fixed = |text: &str, dialect: Option<&str>| {
        let settings = Settings { dialect: dialect.map(str::to_owned), ..Settings::default() };
        let document = Document::new(text, None, &Arc::new(settings));
        let found = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
        let finding = found.iter().find(|one| one.wording.code == "APT0905").expect("a foreign word");
        finding.fixes.iter().map(|fix| applied(text, &fix.edits)).collect::<Vec<_>>()
    };
    let program = "PARTNO A\nDO/5,I=1,3\nGOTO/I,0,0\n5)CONTIN\nFINI\n";
    let named = |name: &str| format!("$$ first\n$$ apt-lsp: dialect={name}, allow APT0955\n{program}");
    assert_eq!(fixed(&named("apt3"), None), [named("apt4")]);
    let cards = ["PARTNO A", "5)   CONTIN", "FINI"].iter().zip(1..);
    let deck: String = cards.map(|(text, number)| format!("{text:<72}{number:08}\n")).collect();
    assert_eq!(fixed(&deck, None), [format!("$$ apt-lsp: dialect=apt4\n{deck}")]);
    assert_eq!(fixed(program, Some("apt3")), [] as [String; 0], "the settings count for more");
}

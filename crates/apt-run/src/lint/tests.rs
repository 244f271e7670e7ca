//! A wrong and a right sample of every lint, through the same door as every finding.

use std::sync::Arc;

use apt_geometry::patience::Patience;

use crate::{
    diagnostic::{Diagnostic, absolute_range},
    document::{Document, Level},
    format::applied,
    settings::Settings,
};

const PAST_COLUMN_72: &str = "APT0951";
const MISSING_COMMA: &str = "APT0952";
const LOOSE_TOLERANCE: &str = "APT0953";
const TOLERANCE_MISSING: &str = "APT0954";
const FEED_MISSING: &str = "APT0955";
const THICKNESS_WITHOUT_EFFECT: &str = "APT0956";
const DIRECTION_WITHOUT_EFFECT: &str = "APT0957";
const CUTTER_AND_TOOL: &str = "APT0958";
const OTHER_SIDE: &str = "APT0959";
const ALLOWS_NOTHING: &str = "APT0960";
const OVERWRITTEN: &str = "APT0961";
const MODE_REPLACED: &str = "APT0962";

fn diagnostics(text: &str) -> (Document, Vec<Diagnostic>) {
    let settings = Arc::new(Settings { dialect: Some("free".to_owned()), ..Settings::default() });
    let document = Document::new(text, None, &settings);
    let mut found = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
    found.retain(|one| one.wording.code.starts_with("APT095") || one.wording.code.starts_with("APT096"));
    (document, found)
}

/// Code and text of the lints.
fn found(text: &str) -> Vec<(&'static str, &str)> {
    let (document, found) = diagnostics(text);
    found
        .into_iter()
        .map(|one| (one.wording.code, &text[absolute_range(document.tree(), &one.origin)]))
        .collect()
}

/// The text after the first fix of every lint.
fn fixed(text: &str) -> String {
    let fixes = diagnostics(text).1.into_iter().filter_map(|one| one.fixes.into_iter().next());
    applied(text, &fixes.flat_map(|fix| fix.edits).collect::<Vec<_>>())
}

const PART: &str = "L1=LINE/0,0,10,0\nL2=LINE/10,-5,10,5\nL3=LINE/0,-5,0,5\nPL=PLANE/0,0,1,0\nFROM/-2,-2,0\n";

#[test]
fn text_behind_column_72() {
    let long = format!("A=1{}\nFINI\n", "+1".repeat(40));
    assert_eq!(found(&long), [(PAST_COLUMN_72, "+1+1+1+1+1+")].map(|(code, _)| (code, &long[72..83])));
    let once = fixed(&long);
    assert!(once.lines().all(|line| line.len() <= 72), "{once}");
    assert_eq!(found(&once), []);
    assert_eq!(found(&format!("A=1 $$ {}\nFINI\n", "+1".repeat(40))), []);
    assert_eq!(found(&format!("PARTNO {}\nFINI\n", "+1".repeat(40))), []);
}

#[test]
fn blanks_where_a_comma_may_be_missing() {
    let text = "P=POINT/1 2,3\nPRINT/3,P\nFINI\n";
    assert_eq!(found(text), [(MISSING_COMMA, "1 2")]);
    assert_eq!(fixed(text), "P=POINT/1,2,3\nPRINT/3,P\nFINI\n");
    let text = "A=1\nB=2\nAB=3\nP=POINT/A B,2\nFINI\n";
    assert_eq!(found(text), [(MISSING_COMMA, "A B")]);
    assert_eq!(found("A=1 000\nP=POINT/1$\n2,3\nFINI\n"), []);
}

#[test]
fn tolerances_as_wide_as_the_cutter() {
    let part = |tolerance: &str| {
        format!("{PART}CUTTER/.5\n{tolerance}\nGO/TO,L1,TO,PL,TO,L3\nTLLFT,GORGT/L1,PAST,L2\nFINI\n")
    };
    assert_eq!(found(&part("INTOL/.5")), [(LOOSE_TOLERANCE, "INTOL/.5")]);
    assert_eq!(found(&part("OUTTOL/.01")), []);
}

#[test]
fn curved_part_surface_without_tolerances() {
    let part = |tolerance: &str| {
        format!(
            "S=SPHERE/0,0,0,5\nL1=PLANE/0,1,0,0\nL2=PLANE/1,0,0,3\nFROM/0,0,9\nCUTTER/.5,.25\n{tolerance}\n\
             GO/ON,L1,TO,S,ON,(PLANE/1,0,0,0)\nINDIRV/1,0,0\nTLON,GOFWD/L1,ON,L2\nFINI\n"
        )
    };
    assert_eq!(found(&part("INTOL/.001")), []);
    let text = part("$$");
    assert_eq!(found(&text), [(TOLERANCE_MISSING, "GOFWD/L1,ON,L2")]);
}

#[test]
fn cutting_without_a_feed() {
    let part = |machine: &str, feed: &str| {
        format!("{machine}\n{PART}CUTTER/.5\n{feed}\nGO/TO,L1,TO,PL,TO,L3\nTLLFT,GORGT/L1,PAST,L2\nFINI\n")
    };
    let text = part("MACHIN/X,1", "$$");
    assert_eq!(found(&text), [(FEED_MISSING, "GORGT/L1,PAST,L2")]);
    assert_eq!(found(&part("MACHIN/X,1", "FEDRAT/10")), []);
    assert_eq!(found(&part("$$", "$$")), [], "no machine, no feed");
}

#[test]
fn thickness_that_no_motion_feels() {
    let part = |side: &str, check: &str| {
        format!("{PART}CUTTER/.5\nTHICK/0,.1\nGO/ON,L1,TO,PL,ON,L3\n{side},GORGT/L1,{check},L2\nFINI\n")
    };
    assert_eq!(found(&part("TLON", "ON")), [(THICKNESS_WITHOUT_EFFECT, "THICK/0,.1")]);
    assert_eq!(found(&part("TLLFT", "ON")), []);
    assert_eq!(found(&part("TLON", "PAST")), [], "the last value holds for the check surface too");
}

#[test]
fn thickness_moves_what_the_tool_is_on_in_apt4() {
    let told = |dialect: &str, text: &str| {
        let settings = Arc::new(Settings { dialect: Some(dialect.to_owned()), ..Settings::default() });
        let document = Document::new(text, None, &settings);
        let found = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
        found.iter().filter(|one| one.wording.code == THICKNESS_WITHOUT_EFFECT).count()
    };
    let on = format!("{PART}CUTTER/.5\nTHICK/0,.1\nGO/ON,L1,TO,PL,ON,L3\nTLON,GORGT/L1,ON,L2\nFINI\n");
    assert_eq!([told("apt4", &on), told("apt3", &on)], [0, 1]);
    // What lies at a distance from a cone is none: ON it, stock is left out.
    let cone = "K=CONE/CANON,0,0,0,0,0,1,.5\n";
    let along =
        format!("{PART}{cone}CUTTER/.5\nTHICK/0,.1,0\nGO/ON,K,TO,PL,ON,L3\nTLON,GORGT/K,ON,L2\nFINI\n");
    assert_eq!(told("apt4", &along), 1);
}

#[test]
fn directions_one_after_the_other() {
    let part = |between: &str| {
        format!("{PART}CUTTER/.5\nINDIRV/1,0,0\n{between}\nINDIRV/0,1,0\nGO/TO,L1,TO,PL,TO,L3\nFINI\n")
    };
    assert_eq!(found(&part("$$")), [(DIRECTION_WITHOUT_EFFECT, "INDIRV/1,0,0")]);
    assert_eq!(found(&part("GO/TO,L3,TO,PL,TO,L1")), []);
}

#[test]
fn one_tool_with_two_cutters() {
    let part = |tool: &str| {
        format!("LOADTL/1\nCUTTER/.5\nFROM/0,0,0\nGOTO/1,1,1\nLOADTL/{tool}\nCUTTER/.25\nGOTO/2,2,2\nFINI\n")
    };
    assert_eq!(found(&part("1")), [(CUTTER_AND_TOOL, "CUTTER/.25")]);
    assert_eq!(found(&part("2")), []);
}

#[test]
fn sides_that_contradict_where_the_tool_stopped() {
    let part = |side: &str, relation: &str, next: &str| {
        format!(
            "{PART}CUTTER/.5\nGO/TO,L1,TO,PL,TO,L3\nTLRGT,GORGT/L1,{relation},L2\n{side},{next}/L2,PAST,L3\nFINI\n"
        )
    };
    let told = |side: &str, relation: &str, next: &str| !found(&part(side, relation, next)).is_empty();
    for (relation, next, right) in [
        ("TO", "GOLFT", "TLLFT"),
        ("TO", "GORGT", "TLRGT"),
        ("PAST", "GOLFT", "TLRGT"),
        ("PAST", "GORGT", "TLLFT"),
        ("ON", "GOLFT", "TLON"),
        ("ON", "GORGT", "TLON"),
    ] {
        for side in ["TLLFT", "TLRGT", "TLON"] {
            assert_eq!(told(side, relation, next), side != right, "{relation} {next} {side}");
        }
    }
    assert!(!told("TLLFT", "2,INTOF", "GORGT"), "which crossing it is decides where the tool is");
    assert!(!told("TLLFT", "TO", "GOFWD"), "tangent");
    let text = part("TLLFT", "TO", "GORGT");
    assert_eq!(found(&text), [(OTHER_SIDE, "GORGT/L2,PAST,L3")]);
    assert_eq!(fixed(&text), part("TLRGT", "TO", "GORGT"));
    let between = text.replace("TLLFT", "GODLTA/0,0,1\nTLLFT");
    assert_eq!(found(&between), [], "the tool has been moved away");
}

#[test]
fn values_that_are_overwritten_before_anything_reads_them() {
    assert_eq!(found("A=1\nA=2\nGOTO/A,0,0\nFINI\n"), [(OVERWRITTEN, "A")]);
    for read in
        ["B=A", "GOTO/A,0,0", "P=POINT/A,2", "CALL/M", "X)B=1", "LOOPST\nLOOPND", "IF(A)X,X,X", "B(A)=2"]
    {
        assert_eq!(found(&format!("A=1\n{read}\nA=2\nGOTO/A,0,0\nFINI\n")), [], "{read}");
    }
    assert_eq!(found("A=1\nA=A+1\nGOTO/A,0,0\nFINI\n"), []);
    assert_eq!(
        found("M=MACRO/A\nA=1\nA=2\nTERMAC\nCALL/M,A=B\nFINI\n"),
        [],
        "a variable may stand for any name"
    );
    assert_eq!(found("A=1\n$$ A\n\nB=1\nA=2\nGOTO/A,B,0\nFINI\n"), [(OVERWRITTEN, "A")]);
}

#[test]
fn modal_statements_that_are_replaced() {
    let part = |one: &str, between: &str, other: &str| {
        format!(
            "{PART}CUTTER/.5\n{one}\n{between}\n{other}\nGO/TO,L1,TO,PL,TO,L3\nTLLFT,GORGT/L1,PAST,L2\nFINI\n"
        )
    };
    for (one, other) in [
        ("INTOL/.01", "INTOL/.02"),
        ("INTOL/.01", "TOLER/.02"),
        ("MAXDP/1", "MAXDP/2"),
        ("DNTCUT", "DNTCUT"),
        ("CUT", "DNTCUT"),
        ("TLRGT", "TLON"),
        ("TLAXIS/0,0,1", "TLAXIS/0,1,1"),
    ] {
        let replaced = part(one, "$$", other);
        let told: Vec<_> = found(&replaced).into_iter().filter(|(_, text)| *text == one).collect();
        assert_eq!(told, [(MODE_REPLACED, one)]);
        assert_eq!(found(&part(one, "GOTO/1,2,3", other)).iter().filter(|(_, text)| *text == one).count(), 0);
    }
    assert_eq!(found(&part("DNTCUT", "$$", "CUT")), [], "CUT puts out the place where the tool is");
    assert_eq!(found(&part("TOLER/.01", "$$", "INTOL/.02")), [], "the outside tolerance still serves");
    let called = "M=MACRO/\nMAXDP/1\nTERMAC\nCALL/M\nMAXDP/2\nFROM/0,0,0\nGOTO/1,1,1\nFINI\n";
    assert_eq!(found(called), [], "a macro serves other places too");
    assert_eq!(found(&part("TLLFT,TLRGT", "$$", "PSIS/PL")), [], "two sides in one statement are APT0071");
}

#[test]
fn comments_allow_what_was_looked_at() {
    let comma = "P=POINT/1 2,3";
    let rest = "PRINT/3,P\nFINI\n";
    assert_eq!(found(&format!("{comma} $$ apt-lsp: allow APT0952\n{rest}")), []);
    assert_eq!(found(&format!("$$ apt-lsp: allow apt0952\n{comma}\n{rest}")), []);
    assert_eq!(found(&format!("$$ apt-lsp: allow APT0952\n\n$$ a point\n{comma}\n{rest}")), []);
    assert_eq!(found(&format!("$$ apt-lsp: allow-file APT0952\n{comma}\n{rest}")), []);
    assert_eq!(found(&format!("{comma}\n{rest}$$ apt-lsp: allow-file APT0952\n")), []);
}

#[test]
fn comments_that_allow_nothing_are_told() {
    let comma = "P=POINT/1 2,3";
    let rest = "PRINT/3,P\nFINI\n";
    let other = format!("{comma} $$ apt-lsp: allow APT0951\n{rest}");
    assert_eq!(found(&other), [(MISSING_COMMA, "1 2"), (ALLOWS_NOTHING, "APT0951")]);
    let both = format!("$$ apt-lsp: allow APT0951, APT0952\n{comma}\n{rest}");
    assert_eq!(found(&both), [(ALLOWS_NOTHING, "APT0951")]);
    assert_eq!(fixed(&both), format!("$$ apt-lsp: allow APT0952\n{comma}\n{rest}"));
    assert_eq!(found(&fixed(&both)), []);
    let unknown = format!("P=POINT/1,2,3 $$ apt-lsp: allow APT7777\n{rest}");
    assert_eq!(found(&unknown), [(ALLOWS_NOTHING, "APT7777")]);
    assert_eq!(fixed(&unknown), format!("P=POINT/1,2,3\n{rest}"));
    let alone = format!("$$ apt-lsp: allow-file APT0952\nP=POINT/1,2,3\n{rest}");
    assert_eq!(fixed(&alone), format!("P=POINT/1,2,3\n{rest}"));
    let error = "P=POINT/1,2,Q $$ apt-lsp: allow APT0101\nPRINT/3,P\nFINI\n";
    assert_eq!(found(error), [(ALLOWS_NOTHING, "APT0101")]);
    let motion = format!("$$ apt-lsp: allow APT0601\n{comma} $$ apt-lsp: allow APT0952 APT0820\n{rest}");
    assert_eq!(found(&motion), [], "neither the motion nor the tape has been looked at");
}

#[test]
fn many_long_statements_are_told_by_some() {
    let line = format!("A=1{}\n", "+1".repeat(40));
    let all = format!("{}GOTO/A,0,0\nFINI\n", (0..70).map(|_| format!("B=A\n{line}")).collect::<String>());
    let told = diagnostics(&format!("A=0\n{all}")).1;
    let long: Vec<_> = told.iter().filter(|one| one.wording.code == PAST_COLUMN_72).collect();
    assert_eq!(long.len(), 50);
    assert!(long[49].wording.message.contains("further"), "{:?}", long[49]);
}

/// Codes and texts of findings.
type Told = Vec<(&'static str, String)>;

/// The tool ends of each CL record.
type Path = Vec<Vec<Vec<f64>>>;

/// Codes and places of all findings except some, and the path.
fn others_and_path(text: &str, except: &str) -> (Told, Path) {
    let settings = Arc::new(Settings { dialect: Some("free".to_owned()), ..Settings::default() });
    let document = Document::new(text, None, &settings);
    let found = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    let report = document.report(&|| false, &mut |_, _| {}, None).unwrap();
    let others = found
        .iter()
        .filter(|one| one.wording.code != except)
        .map(|one| (one.wording.code, text[absolute_range(document.tree(), &one.origin)].to_owned()))
        .collect();
    (others, report.cl.into_iter().filter_map(|entry| entry.points).collect())
}

/// Applies one fix of the only finding with a code: the finding is gone and no other comes. The text is returned.
fn cured(text: &str, code: &str, which: usize, same_path: bool) -> String {
    let told = diagnostics(text).1;
    let [finding] = told.iter().filter(|one| one.wording.code == code).collect::<Vec<_>>()[..] else {
        panic!("{code} is not told once: {told:?}")
    };
    let fixed = applied(text, &finding.fixes[which].edits);
    assert!(found(&fixed).iter().all(|(other, _)| *other != code), "{code} stays in {fixed}");
    let (before, after) = (others_and_path(text, code), others_and_path(&fixed, code));
    assert_eq!(after.0, before.0, "other findings after the fix of {code}");
    if same_path {
        assert_eq!(after.1, before.1, "the path after the fix of {code}");
    }
    fixed
}

#[test]
fn every_mechanical_cure_cures_and_changes_nothing_else() {
    let drive = "GO/TO,L1,TO,PL,TO,L3\nTLLFT,GORGT/L1,PAST,L2\nFINI\n";
    let start = format!("{PART}CUTTER/.5\n");
    let with = |statements: &str| format!("{start}{statements}{drive}");
    let without = |statements: &str, gone: &str| with(&statements.replacen(gone, "", 1));
    for (code, statements, gone) in [
        (MODE_REPLACED, "INTOL/.01\nINTOL/.02\n", "INTOL/.01\n"),
        (MODE_REPLACED, "MAXDP/1 $$ why\nMAXDP/2\n", "MAXDP/1"),
        (MODE_REPLACED, "  DNTCUT\n  DNTCUT\n  CUT\n", "  DNTCUT\n"),
        (DIRECTION_WITHOUT_EFFECT, "INDIRV/1,0,0\nINDIRV/0,1,0\n", "INDIRV/1,0,0\n"),
        (OVERWRITTEN, "A=1\nA=2\nPRINT/3,A\n", "A=1\n"),
    ] {
        assert_eq!(cured(&with(statements), code, 0, true), without(statements, gone), "{statements}");
    }
    let on = "GO/ON,L1,TO,PL,ON,L3\nTLON,GORGT/L1,ON,L2\nFINI\n";
    let thick = |before: &str| format!("{start}{before}THICK/0,.1\n{on}");
    assert_eq!(cured(&thick(""), THICKNESS_WITHOUT_EFFECT, 0, true), format!("{start}{on}"));
    // A THICK before it would come back to life.
    let before = "THICK/.2\nGO/ON,L1,TO,PL,ON,L3\n";
    let expected = format!("{start}{before}THICK/0\n{on}");
    assert_eq!(cured(&thick(before), THICKNESS_WITHOUT_EFFECT, 0, true), expected);
    let tool = |second: &str| {
        format!("LOADTL/1\nCUTTER/.5,.1\nFROM/0,0,0\nGOTO/1,1,1\n{second}\nGOTO/2,2,2\nFINI\n")
    };
    assert_eq!(cured(&tool("CUTTER/.25 $$ x"), CUTTER_AND_TOOL, 0, true), tool("CUTTER/.5,.1 $$ x"));
    let long = format!("A=1{}\nPRINT/3,A\nFINI\n", "+1".repeat(40));
    assert!(cured(&long, PAST_COLUMN_72, 0, true).lines().all(|line| line.len() <= 72));
    let comma = |list: &str| format!("P=POINT/{list},3\nPRINT/3,P\nFINI\n");
    assert_eq!(cured(&comma("1 2"), MISSING_COMMA, 0, true), comma("1,2"));
    assert_eq!(cured("PRINT/3,(1 2)\nFINI\n", MISSING_COMMA, 1, true), "PRINT/3,(12)\nFINI\n");
    let side = |side: &str| {
        format!("{start}GO/TO,L1,TO,PL,TO,L3\nTLRGT,GORGT/L1,TO,L2\n{side},GORGT/L2,PAST,L3\nFINI\n")
    };
    assert_eq!(fixed(&side("TLLFT")), side("TLRGT"));
    assert_eq!(found(&side("TLRGT")), []);
}

#[test]
fn tolerances_and_feeds_that_are_known_cure() {
    let curved = |tolerances: &str| {
        format!(
            "S=SPHERE/0,0,0,5\nL1=PLANE/0,1,0,0\nL2=PLANE/1,0,0,3\nFROM/0,0,9\nCUTTER/.5,.25\n\
             GO/ON,L1,TO,S,ON,(PLANE/1,0,0,0)\nINDIRV/1,0,0\n{tolerances}TLON,GOFWD/L1,ON,L2\nFINI\n"
        )
    };
    let expected = curved("INTOL/0\nOUTTOL/0.0005\n");
    assert_eq!(cured(&curved(""), TOLERANCE_MISSING, 0, true), expected);
    let loose = |statement: &str| {
        format!("{PART}CUTTER/.5\n{statement} $$ x\nGO/TO,L1,TO,PL,TO,L3\nTLRGT,GORGT/L1,PAST,L2\nFINI\n")
    };
    for word in ["INTOL", "OUTTOL"] {
        let cure = cured(&loose(&format!("{word}/.5")), LOOSE_TOLERANCE, 0, false);
        assert_eq!(cure, loose(&format!("{word}/0.0005")));
    }
    assert_eq!(cured(&loose("TOLER/.5"), LOOSE_TOLERANCE, 0, false), loose("TOLER/0.0005"));
    let feed = |before: &str, after: &str| {
        format!(
            "MACHIN/X,1\n{PART}CUTTER/.5\nGO/TO,L1,TO,PL,TO,L3\n{before}TLLFT,GORGT/L1,PAST,L2\n{after}FINI\n"
        )
    };
    let later = "FEDRAT/12.5,IPM\nGODLTA/0,0,1\nFEDRAT/3\nGODLTA/0,0,1\n";
    assert_eq!(cured(&feed("", later), FEED_MISSING, 0, true), feed("FEDRAT/12.5,IPM\n", later));
    // Without one nobody knows it.
    let told = diagnostics(&feed("", "")).1;
    assert!(told.iter().any(|one| one.wording.code == FEED_MISSING && one.fixes.is_empty()), "{told:?}");
}

#[test]
fn the_tolerance_that_is_taken_goes_with_the_unit_of_the_settings() {
    let text = "S=SPHERE/0,0,0,5\nL1=PLANE/0,1,0,0\nL2=PLANE/1,0,0,3\nFROM/0,0,9\nCUTTER/.5,.25\n\
                GO/ON,L1,TO,S,ON,(PLANE/1,0,0,0)\nINDIRV/1,0,0\nTLON,GOFWD/L1,ON,L2\nFINI\n";
    let settings = Arc::new(Settings {
        dialect: Some("free".to_owned()),
        units: crate::settings::Units::Mm,
        ..Settings::default()
    });
    let document = Document::new(text, None, &settings);
    let found = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
    let one = found.iter().find(|one| one.wording.code == TOLERANCE_MISSING).unwrap();
    assert!(applied(text, &one.fixes[0].edits).contains("\nOUTTOL/0.0127\nTLON"), "{:?}", one.fixes);
}

#[test]
fn what_is_not_sure_has_no_cure() {
    let fixes = |text: &str, code: &str| -> usize {
        let told = diagnostics(text).1;
        let of_code: Vec<_> = told.iter().filter(|one| one.wording.code == code).collect();
        assert!(!of_code.is_empty(), "{code} in {text}");
        of_code.iter().map(|one| one.fixes.len()).sum()
    };
    // The label is a place to jump to, and the other part of the statement has an effect of its own.
    let label = "FROM/0,0,0\nX)MAXDP/1\nMAXDP/2\nGOTO/1,1,1\nIF(0)X,Y,Y\nY)FINI\n";
    assert_eq!(fixes(label, MODE_REPLACED), 0);
    let two = format!("{PART}CUTTER/.5\nTLRGT,PSIS/PL\nTLON\nGOTO/2,2,2\nFINI\n");
    assert_eq!(fixes(&two, MODE_REPLACED), 0);
}

#[test]
fn geometry_that_is_defined_again_is_left_to_its_own_findings() {
    let rest = "P=POINT/1,2\nP=POINT/3,4\nFROM/0,0,0\nGOTO/P\nFINI\n";
    assert_eq!(found(&format!("CANON/ON\n{rest}")), [], "somebody has allowed it on purpose");
    assert_eq!(found(rest), [], "the name keeps its first meaning, as another finding says");
}

#[test]
fn a_listing_of_all_names_reads_all_values() {
    let part = |between: &str| format!("A=1\n{between}A=2\nFROM/0,0,0\nGOTO/A,0,0\nFINI\n");
    assert_eq!(found(&part("PRINT/3,ALL\n")), []);
    assert_eq!(found(&part("PRINT/3,A\n")), []);
    assert_eq!(found(&part("")), [(OVERWRITTEN, "A")]);
}

#[test]
fn values_are_followed_over_any_number_of_statements() {
    let far = |between: &str| {
        let fill = "GODLTA/0,0,1\n".repeat(700);
        format!("FROM/0,0,0\nA=1\n{fill}{between}{fill}A=2\nGOTO/A,0,0\nFINI\n")
    };
    assert_eq!(found(&far("")), [(OVERWRITTEN, "A")]);
    for between in ["GOTO/A,0,0\n", "X)GOTO/1,1,1\n", "M=MACRO/\nTERMAC\n"] {
        assert_eq!(found(&far(between)), [], "{between}");
    }
    let many = format!("A=1\nA=2\n{}GOTO/A,0,0\nFINI\n", "GODLTA/0,0,1\n".repeat(60_000));
    assert_eq!(found(&many), [(OVERWRITTEN, "A")], "no program is too long");
}

#[test]
fn an_edit_reads_the_blocks_that_it_touches_and_no_others() {
    let mut text = String::from("FROM/0,0,0\n");
    for number in 0..5_000 {
        text.push_str(&format!("A{number}=1\nGODLTA/A{number},0,1\n"));
    }
    text.push_str("FINI\n");
    let settings = Arc::new(Settings { dialect: Some("free".to_owned()), ..Settings::default() });
    let notes = |document: &Document| -> Vec<Arc<super::notes::Notes>> {
        document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
        let made_here = |block: apt_syntax::tree::BlockView<'_>| super::notes::Notes::of(&block, usize::MAX);
        document.tree().blocks().map(made_here).collect()
    };
    let before = Document::new(&text, None, &settings);
    let known = notes(&before);
    assert!(known.len() > 30, "{} blocks", known.len());
    for (at, insert) in
        [(text.len() / 2, "\nB=1 2\n"), (40, "7"), (text.len() - 9, "$$ apt-lsp: allow APT0951\n")]
    {
        let after = before.edit(at..at, insert);
        let fresh = notes(&after);
        let is_known = |one: &&Arc<super::notes::Notes>| known.iter().any(|other| Arc::ptr_eq(one, other));
        assert!(fresh.iter().filter(is_known).count() + 2 >= known.len(), "{insert:?} at {at}");
        // What was kept says the same as what is found out anew.
        let anew = Document::new(&after.tree().text(), None, &settings);
        let found =
            |document: &Document| document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
        assert_eq!(found(&after), found(&anew), "{insert:?} at {at}");
    }
}

#[test]
fn a_macro_that_is_opened_far_above_hides_what_is_overwritten_below() {
    let text = |first: &str| {
        let fill = "GODLTA/0,0,1\n".repeat(600);
        format!("{first}\nFROM/0,0,0\n{fill}A=1\nA=2\n{fill}GOTO/A,0,0\nFINI\n")
    };
    let settings = Arc::new(Settings { dialect: Some("free".to_owned()), ..Settings::default() });
    let plain = Document::new(&text("$$"), None, &settings);
    let lints = |document: &Document| {
        let program = document.program(&|| false).unwrap();
        super::lint(document.tree(), &program, crate::settings::Units::Inch, Patience::default())
            .unwrap()
            .into_iter()
            .map(|one| one.kind)
            .collect::<Vec<_>>()
    };
    let overwritten = [super::LintKind::Overwritten { name: "A".into() }];
    assert_eq!(lints(&plain), overwritten);
    let open = plain.edit(0..2, "M=MACRO/");
    assert_eq!(lints(&open), []);
    let closed = open.edit(8..8, "\nTERMAC");
    assert_eq!(lints(&closed), overwritten);
}

/// The gravest diagnostics are those of the whole list, whether the others were put into words or not.
#[test]
fn the_gravest_are_those_of_the_whole_list() {
    let mut text = String::from("FROM/0,0,0\n");
    for number in 0..300 {
        text.push_str(&format!("U{number}=1\nGOTO/{number},0,0\n"));
        if number % 50 == 7 {
            text.push_str("GOTO/NONE,1,2\nINTOL/-1\n");
        }
    }
    text.push_str("FINI\n");
    for (comment, severity) in [("", ""), ("$$ apt-lsp: allow APT0110\nX=1\n", ""), ("", "APT0110")] {
        let severity = (!severity.is_empty())
            .then(|| (severity.to_owned(), crate::settings::SeveritySetting::Information));
        let settings = Arc::new(Settings {
            dialect: Some("free".to_owned()),
            severity: severity.into_iter().collect(),
            ..Settings::default()
        });
        let document = Document::new(&format!("{comment}{text}"), None, &settings);
        let mut all = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
        all.iter_mut().for_each(|one| one.fixes.clear());
        assert!(all.len() > 300);
        for most in [0, 1, 5, 20, 299, 1_000] {
            let mut worst =
                document.worst_diagnostics(Level::Motion, most, &|| false, &mut |_, _| {}).unwrap();
            worst.diagnostics.iter_mut().for_each(|one| one.fixes.clear());
            assert_eq!(worst, crate::catalogue::Worst::of(all.clone(), most), "{most} of {}", all.len());
            assert_eq!(worst.diagnostics.len() + worst.left_out, all.len());
        }
    }
}

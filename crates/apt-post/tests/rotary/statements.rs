//! Statements by which a program turns axes, and rules that it states for them.

use apt_post::{PostFindingKind, machine};
use expect_test::expect;

use super::{HEAD, LEANING, WIDE, changed, check, found, tape_for};

#[test]
fn tables_that_a_program_turns() {
    let mill = changed("linuxcnc-mill5", &WIDE).unwrap();
    let head = HEAD.replace("MULTAX\n", "");
    let text = format!(
        "{head}RAPID\nGOTO/10,0,50\nROTABL/CAXIS,ATANGL,90\nGOTO/10,5,0\nROTABL/CAXIS,ATANGL,90,INCR,CLW,ROTREF\nGOTO/20,5,0\n\
         ROTABL/CAXIS,ATANGL,90,ROTREF\nGOTO/20,5,0\nRAPID\nGOTO/0,0,60\nROTABL/AAXIS,ATANGL,30\nGOTO/0,0,10\n\
         ROTABL/CAXIS,ATANGL,10,CLW\nROTABL/CAXIS,ATANGL,10,CCLW\nFINI\n"
    );
    check(
        &mill,
        &text,
        &expect![[r#"
        N40 G0 A0. C0.
        N50 G0 X10. Y0.
        N60 G43 H1 Z50.
        N70 C90.
        N80 G1 Y5. Z0. F1000.
        N90 G0 C0.
        N100 G1 X20.
        N110 G0 C90.
        N120 G1 X5. Y-20.
        N130 G0 X0. Y0. Z60.
        N140 A30.
        N150 G1 Z10.
        N160 G0 C10.
        N170 M5
        N180 G53 G0 Z0.
        N190 G0 A0. C0.
        N200 M2
        %
    "#]],
    );
    for (statement, missing) in [
        ("ROTABL/ATANGL,90", "an axis: the table has two"),
        ("ROTHED/ATANGL,90", "a head"),
        ("ROTABL/BAXIS,ATANGL,90", "B"),
    ] {
        let kinds = found(&mill, &format!("{head}{statement}\nFINI\n"));
        assert!(matches!(kinds[..], [PostFindingKind::NoRotaryAxis { .. }]), "{missing}: {kinds:?}");
    }
    let beyond = found(&mill, &format!("{head}ROTABL/AAXIS,ATANGL,150\nFINI\n"));
    assert!(matches!(beyond[..], [PostFindingKind::ArgumentOutOfRange { .. }]), "{beyond:?}");
}

/// What the statements of rotary axes change: divisions, times, where the slides of a head stand.
#[test]
fn rules_that_a_program_states() {
    let mill = machine("linuxcnc-mill5").unwrap();
    let blocks = |statements: &str| -> Vec<String> {
        let tape = tape_for(&mill, &format!("{HEAD}{statements}{LEANING}"));
        assert!(tape.is_ok(), "{statements}: {:?}", tape.findings);
        tape.text().lines().filter(|line| line.contains('F')).map(str::to_owned).collect()
    };
    let coarse = blocks("LINTOL/1\n").len();
    assert!(coarse < blocks("").len() && blocks("").len() < blocks("LINTOL/.002\n").len());
    assert_eq!(blocks("LINTOL/.002\nLINTOL/ON\n"), blocks(""));
    // Without a tolerance for its end the tool still stays in the plane in which it turns.
    assert!(blocks("LINTOL/OFF\n").len() <= coarse);
    let times = |statements: &str| -> f64 {
        let feed = |block: &String| block.rsplit_once('F').unwrap().1.parse::<f64>().unwrap().recip();
        blocks(statements).iter().map(feed).sum()
    };
    // Of 50, 20 and 20 mm at 1000 a minute.
    assert!((times("") - 0.09).abs() < 1e-4, "{}", times(""));
    // 30, 90 and 45 degrees at 100 a minute.
    assert!((times("MAXDPM/100\n") - 1.65).abs() < 0.02, "{}", times("MAXDPM/100\n"));
    // A place 100 up the tool goes farther.
    assert!(times("FEDRAT/LENGTH,100\n") > 0.15, "{}", times("FEDRAT/LENGTH,100\n"));
    for statement in ["LINTOL/-1", "MAXDPM/0", "PIVOTZ/0"] {
        let kinds = found(&mill, &format!("{HEAD}{statement}\nFINI\n"));
        assert!(matches!(kinds[..], [PostFindingKind::BadValue { .. }]), "{statement}: {kinds:?}");
    }
    let three = machine("linuxcnc-mill3").unwrap();
    let kinds = found(&three, &format!("{HEAD}LINTOL/1\nFINI\n"));
    assert_eq!(kinds, [PostFindingKind::NotSupported { word: "LINTOL".into() }]);
    let kinds = found(&three, &format!("{HEAD}FEDRAT/LENGTH,5\nFINI\n"));
    let argument = "LENGTH".into();
    assert_eq!(kinds, [PostFindingKind::ArgumentNotUsed { word: "FEDRAT".into(), argument }]);
}

#[test]
fn heads_that_a_program_turns() {
    let mut changes = WIDE.to_vec();
    changes.push(("carried = \"table\"", "carried = \"head\""));
    changes.push((
        "vector = [0.0, 0.0, 1.0]\ncarried = \"head\"",
        "vector = [0.0, 0.0, 1.0]\ncarried = \"table\"",
    ));
    let mill = changed("linuxcnc-mill5", &changes).unwrap();
    let head = HEAD.replace("MULTAX\n", "").replace("LENGTH,0", "LENGTH,100");
    let text = format!(
        "{head}PIVOTZ/100\nRAPID\nGOTO/0,0,50\nROTHED/ATANGL,30\nGOTO/0,0,0\nROTABL/90,CCLW\nGOTO/10,0,0\nFINI\n"
    );
    check(
        &mill,
        &text,
        &expect![[r#"
        N40 G0 A0. C0.
        N50 G0 X0. Y0.
        N60 G43 H1 Z50.
        N70 A30.
        N80 G1 Y-100. Z-26.7949 F1000.
        N90 G0 C90.
        N100 G1 X10.
        N110 M5
        N120 G53 G0 Z0.
        N130 G0 A0. C0.
        N140 M2
        %
    "#]],
    );
}

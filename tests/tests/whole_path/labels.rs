//! Several check surfaces with labels, TRANTO and n INTOF, from the source text to the cutter locations.

use std::f64::consts::TAU;

use apt_tests::runs::{analysis, path_of, report};
use serde_json::Value;

/// Definitions of CS, a surface across the x axis at about x = 3, of every kind that a check surface may be.
const KINDS: [(&str, &str); 15] = [
    ("line", "CS=LINE/3,-9,3.2,9"),
    ("plane", "CS=PLANE/1,.1,.2,3"),
    ("circle", "CS=CIRCLE/5,0,2"),
    ("cylinder", "CS=CYLNDR/5,0,0,0,1,.3,2"),
    ("sphere", "CS=SPHERE/5,0,.1,2"),
    ("cone", "CS=CONE/(POINT/5,0,3),(VECTOR/0,0,-1),35"),
    ("ellipsoid", "CS=QADRIC/1,2,3,0,0,0,-10,0,0,21"),
    ("hyperboloid", "CS=QADRIC/1,-1,-1,0,0,0,0,0,0,-9"),
    ("ellipse", "CS=ELLIPS/CENTER,(POINT/5,0),2,1,20"),
    ("hyperbola", "CS=HYPERB/CENTER,(POINT/0,0),3,2,5"),
    ("general conic", "CS=GCONIC/0,0,.2,-1,0,3"),
    ("loft conic", "CS=LCONIC/3PT2SL,4,-2,-1,4,2,1,3,0"),
    ("tabulated cylinder", "CS=TABCYL/NOZ,SPLINE,3.3,-2,3,-1,2.9,0,3.1,1,3.4,2"),
    (
        "ruled surface",
        "LA=LINE/3,-4,3,4\nLB=LINE/4,-4,4,4\nVX=VECTOR/1,0,0\n\
         P1=POINT/3,-4,-2\nP2=POINT/3,4,-2\nP3=POINT/4,-4,3\nP4=POINT/4,4,3\nCS=RLDSRF/LA,P1,P2,VX,LB,P3,P4,VX",
    ),
    (
        "polyconic",
        "R=2.82842712\nCS=POLCON/CANON,1,0,0,-1,5,1,0,0,2.82842712,0,-1,0,0,0,3,3,\
         R,0,0,0,0,0,0,0,R,0,0,0,0,0,0,0,R,0,0,0,0,0,0,0,-R,0,0,0,0,0,0,0,\
         -R,0,0,0,0,0,0,0,R,0,0,0,0,0,0,0,.70710678,0,0,0,0,0,0,0,0,0,0,0,0,0,0",
    ),
];

const HEAD: &str = "CUTTER/.5\nINTOL/.001\nOUTTOL/.001\nL1=LINE/0,0,9,0\n";

/// The report of a program without errors, all motions proven.
fn ran(name: &str, text: &str) -> Value {
    let report = report(&analysis(text, "free")).unwrap();
    assert_eq!(report["ok"], true, "{name}: {}", report["diagnostics"]);
    for motion in report["motions"].as_array().unwrap() {
        assert_eq!(motion["verified"], true, "{name}: {motion}");
    }
    report
}

/// All tool ends of a program.
fn ends(report: &Value) -> Vec<[f64; 3]> {
    path_of(report).iter().map(|location| location.at).collect()
}

#[test]
fn the_surface_that_is_met_first_sends_the_program_to_its_label() {
    for (name, check) in KINDS {
        let program = |checks: &str| {
            format!(
                "{HEAD}{check}\nFAR=LINE/8,-9,8,9\nNEAR=LINE/1,-9,1,9\nFROM/0,0,1\nGO/ON,L1\nINDIRV/1,0,0\n\
                 TLON,GOFWD/L1,{checks}\nA2)GOTO/0,0,22\nA1)GOTO/0,0,11\nFINI\n"
            )
        };
        let first = ends(&ran(name, &program("TO,CS,A1,TO,FAR,A2")));
        let [.., stop, last] = first.as_slice() else { panic!("{name}: {first:?}") };
        assert_eq!(*last, [0.0, 0.0, 11.0], "{name}");
        assert!(stop[0] > 1.5 && stop[0] < 3.5 && stop[1].abs() < 0.002, "{name}: {stop:?}");
        assert!(!first.contains(&[0.0, 0.0, 22.0]), "{name}: the skipped statement moved the tool");
        // The order in which they are named is nothing to the path.
        assert_eq!(ends(&ran(name, &program("TO,FAR,A2,TO,CS,A1"))), first, "{name}");
        let near = ends(&ran(name, &program("TO,CS,A1,TO,NEAR,A2")));
        let [.., stop, after, last] = near.as_slice() else { panic!("{name}: {near:?}") };
        assert_eq!((*after, *last), ([0.0, 0.0, 22.0], [0.0, 0.0, 11.0]), "{name}");
        assert!((stop[0] - 0.75).abs() < 0.002, "{name}: {stop:?}");
    }
}

#[test]
fn positions_are_counted_over_several_turns_of_a_closed_path() {
    for (name, check) in KINDS {
        let of = |count: u32| {
            let text = format!(
                "{HEAD}NUMPTS/2000\nC1=CIRCLE/3,0,2\n{check}\nFROM/0,0,1\nGO/ON,C1\nINDIRV/0,1,0\n\
                 TLON,GOFWD/C1,ON,{count},INTOF,CS\nFINI\n"
            );
            let path = ends(&ran(name, &text));
            let cut = &path[1..];
            let length: f64 = cut
                .windows(2)
                .map(|pair| (0..3).map(|k| (pair[1][k] - pair[0][k]).powi(2)).sum::<f64>().sqrt())
                .sum();
            (cut[cut.len() - 1], length)
        };
        let positions: Vec<([f64; 3], f64)> = (1..=5).map(of).collect();
        let apart = |a: usize, b: usize| {
            (0..3).map(|k| (positions[a].0[k] - positions[b].0[k]).powi(2)).sum::<f64>().sqrt()
        };
        assert!(apart(0, 1) > 1.0, "{name}: {positions:?}");
        for (one, later) in [(0, 2), (1, 3), (2, 4)] {
            assert!(apart(one, later) < 0.02, "{name}: {positions:?}");
            let turn = positions[later].1 - positions[one].1;
            assert!((turn - 2.0 * TAU).abs() < 0.03, "{name}: {turn} between {one} and {later}");
        }
    }
}

/// Beyond the end of a surface the sign of the distance says nothing: where it changes there is no position.
#[test]
fn a_surface_that_ends_beside_the_tool_end_is_not_met_by_getting_around_it() {
    let above = KINDS[14].1.replace("0,3,3,", "0,-3,3,");
    for (drive, start, motion) in
        [("L1", "INDIRV/1,0,0", "GOFWD/L1"), ("C1", "INDIRV/0,1,0\nNUMPTS/2000", "GOFWD/C1")]
    {
        let text = format!(
            "{HEAD}C1=CIRCLE/3,0,2\n{above}\nFROM/0,0,1\nGO/ON,{drive}\n{start}\nTLON,{motion},ON,CS\nFINI\n"
        );
        let report = report(&analysis(&text, "free")).unwrap();
        let findings = report["diagnostics"].as_array().unwrap();
        let errors: Vec<_> = findings.iter().filter(|finding| finding["severity"] == "error").collect();
        assert_eq!(errors.len(), 1, "{drive}: {errors:?}");
        let message = errors[0]["message"].as_str().unwrap();
        assert_eq!(errors[0]["code"], "APT0641", "{drive}: {message}");
        assert!(message.contains("nearest approach to ON is 4.25"), "{drive}: {message}");
        let told = findings.iter().find(|finding| finding["code"] == "APT0666").expect("where it ends");
        assert!(told["message"].as_str().unwrap().contains(", 4.25), beside the tool"), "{drive}: {told}");
    }
}

#[test]
fn tranto_goes_on_at_its_label_and_executes_definitions_between() {
    let report = ran(
        "TRANTO",
        "FROM/0,0,0\nGOTO/1,0,0\nTRANTO/ON1\nGOTO/2,0,0\nP1=POINT/5,6,7\nON1)GOTO/P1\nGOTO/3,0,0\nFINI\n",
    );
    assert_eq!(ends(&report), [[0.0; 3], [1.0, 0.0, 0.0], [5.0, 6.0, 7.0], [3.0, 0.0, 0.0]]);
}

#[test]
fn a_macro_has_its_own_labels_at_every_call() {
    let report = ran(
        "macro",
        &format!(
            "{HEAD}L2=LINE/5,-9,5,9\nL3=LINE/6,-9,6,9\nM1=MACRO/H\n\
             TLON,GOFWD/L1,TO,L2,A1,TO,L3,A2\nA2)GOTO/0,0,22\nA1)GOTO/0,0,H\nTERMAC\n\
             FROM/0,0,1\nGO/ON,L1\nINDIRV/1,0,0\nCALL/M1,H=2\nGOTO/0,0,1\nGO/ON,L1\nINDIRV/1,0,0\nCALL/M1,H=3\nFINI\n"
        ),
    );
    let heights: Vec<f64> = ends(&report).iter().map(|at| at[2]).filter(|z| *z > 1.5).collect();
    assert_eq!(heights, [2.0, 3.0]);
}

#[test]
fn labels_that_are_missing_or_twice_are_told() {
    let drive = format!("{HEAD}L2=LINE/5,-9,5,9\nL3=LINE/6,-9,6,9\nFROM/0,0,1\nGO/ON,L1\nINDIRV/1,0,0\n");
    let motion = "TLON,GOFWD/L1,TO,L2,A1,TO,L3,A2\n";
    for (name, text, code, apt3) in [
        ("missing", format!("{drive}{motion}A1)GOTO/0,0,1\nFINI\n"), "APT0403", 406),
        (
            "twice",
            format!("{drive}{motion}A1)GOTO/0,0,1\nA2)GOTO/0,0,2\nA1)GOTO/0,0,3\nFINI\n"),
            "APT0401",
            6,
        ),
        ("TRANTO to nowhere", "FROM/0,0,0\nTRANTO/A9\nGOTO/0,0,1\nFINI\n".to_owned(), "APT0403", 406),
    ] {
        let report = report(&analysis(&text, "free")).unwrap();
        let told = report["diagnostics"].as_array().unwrap();
        let hit = told.iter().find(|one| one["severity"] == "error");
        let Some(hit) = hit else { panic!("{name}: {told:?}") };
        assert_eq!((&hit["code"], &hit["apt3"]), (&code.into(), &apt3.into()), "{name}: {told:?}");
    }
}

//! Programs with sculptured surfaces beyond the corpus: what a part programmer would find wrong in the result.

#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

use apt_tests::run_text;
use serde_json::Value;

/// Excess over a limit that is rounding, as a share of it.
const ROUNDING: f64 = 1e-9;

fn report(text: &str) -> Value {
    run_text(text, "program.apt", "apt4")
}

/// Numbers of all errors and warnings, in order; 0 where a finding has none.
fn numbers(report: &Value) -> Vec<u64> {
    let findings = report["diagnostics"].as_array().unwrap().iter();
    findings
        .filter(|finding| finding["severity"] != "hint")
        .map(|finding| finding["apt3"].as_u64().unwrap_or(0))
        .collect()
}

/// The numbers of a symbol.
fn symbol(report: &Value, name: &str) -> Vec<f64> {
    let values = report["symbols"][name]["canonical"].as_array().unwrap_or_else(|| panic!("{name}"));
    values.iter().map(|value| value.as_f64().unwrap()).collect()
}

fn assert_near(report: &Value, name: &str, expected: &[f64]) {
    let found = symbol(report, name);
    let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(near && found.len() == expected.len(), "{name}: {found:?}, expected {expected:?}");
}

/// All tool ends.
fn ends(report: &Value) -> Vec<[f64; 3]> {
    let entries = report["cl"].as_array().unwrap().iter();
    let points =
        entries.filter(|entry| entry["type"] == "go").flat_map(|entry| entry["points"].as_array().unwrap());
    points.map(|point| std::array::from_fn(|axis| point[axis].as_f64().unwrap())).collect()
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// A ridge of constant section along y, 6 by 6.
const RIDGE: &str = "\
P1=POINT/0,0,0
P2=POINT/3,0,1
P3=POINT/6,0,0
Q1=POINT/0,6,0
Q2=POINT/3,6,1
Q3=POINT/6,6,0
S=SSURF/SMESH,XYZ,SPLINE,P1,P2,P3,SPLINE,Q1,Q2,Q3
";

#[test]
fn no_move_along_a_pass_is_longer_than_maxdp() {
    // On top of the ridge the contact goes from one side of the flat bottom to the other.
    for (cutter, axis) in [("2", "(VECTOR/0,0,1)"), ("2,.2", "(VECTOR/0,0,1)"), ("1,.5", "NORMDS")] {
        let text = format!(
            "PARTNO MAXDP\nMULTAX\nCUTTER/{cutter}\nINTOL/.01\nOUTTOL/.01\nMAXDP/.3\n{RIDGE}\
             SCON/DS,S,PARAM,.2,1.8,.2,.8,AT,(VECTOR/0,0,-1)\nSCON/PS,TO,S,PLUS,0\nSCON/AXIS,{axis}\n\
             SMIL/PATH,DS,PARAM,.2,.5,TANSPL,PLUS\nFINI\n"
        );
        let report = report(&text);
        assert_eq!(numbers(&report), [0; 0], "{cutter}");
        let ends = ends(&report);
        for pair in ends.windows(2) {
            let way = distance(&pair[0], &pair[1]);
            assert!(way <= 0.3 * (1.0 + ROUNDING), "CUTTER/{cutter}: {way}");
        }
        assert!(ends.len() < 40, "CUTTER/{cutter}: {}", ends.len());
    }
}

#[test]
fn a_pass_with_its_axis_from_the_part_begins_on_a_surface_that_stands_upright() {
    // The ridge turned so that its normal is along x: the vertical axis of the first drop is far from that of the pass.
    for (start, sense) in [(0.2, "PLUS"), (1.8, "MINUS")] {
        let text = format!(
            "PARTNO UPRIGHT\nMULTAX\nCUTTER/.8,.4\nINTOL/.001\nOUTTOL/.001\nMAXDP/1\n{RIDGE}\
             U=SSURF/COMBIN,S,TRFORM,(MATRIX/ZXROT,90)\n\
             SCON/DS,U,PARAM,.2,1.8,.2,.8,ON,(VECTOR/-1,0,0)\nSCON/PS,TO,U,PLUS,0\n\
             SCON/AXIS,ATANGL,PS,3,CUTANG,4\nSMIL/PATH,DS,PARAM,{start},.5,TANSPL,{sense}\nFINI\n"
        );
        let report = report(&text);
        assert_eq!(numbers(&report), [0; 0], "{sense}: {}", report["diagnostics"]);
        let entries = report["cl"].as_array().unwrap();
        let first = &entries.iter().find(|entry| entry["type"] == "go").unwrap()["points"][0];
        // The axis leans by the angles of the statement from the normal, which is near x.
        assert!(first[3].as_f64().unwrap() > 0.8, "{sense}: {first}");
    }
}

/// Three quarters of a circle about the origin, from (5, 0) to (0, -5).
const WIDE: &str = "SCURV/CURSEG,(POINT/5,0,0),(POINT/0,5,0),(POINT/0,-5,0)";

#[test]
fn curseg_is_one_arc_however_far_it_turns() {
    let report = report(&format!(
        "PARTNO WIDE\nC={WIDE}\nN=NUMF(C)\nQ0=POINT/INTOF,C,PARAM,0\nQ1=POINT/INTOF,C,PARAM,.5\n\
         Q2=POINT/INTOF,C,PARAM,1\nT2=VECTOR/INTOF,C,PARAM,1,1,TANSPL,UNIT\nQ3=POINT/INTOF,C,PARAM,1,-1\n\
         Q4=POINT/INTOF,(LINE/-9,0,9,0),C,(POINT/-5,0,0)\nX4=PARMF(TVAL)\nA4=PARMF(SVAL)\nG4=PARMF(C)\n\
         Q5=POINT/INTOF,C,PARAM,X4,1\n\
         S=SSURF/RULED,C,AXIS,(VECTOR/0,0,1)\nM=NUMF(S)\nQ6=POINT/INTOF,S,PARAM,1,.5,1\n\
         R=SSURF/REVOLV,C,AXIS,(POINT/9,0,0),(VECTOR/0,1,0),CCLW,0,90\nK=NUMF(R)\n\
         J=SCURV/COMBIN,C,(SCURV/CURSEG,(POINT/0,-5,0),(POINT/5,-5,0))\nL=NUMF(J)\n\
         Q7=POINT/INTOF,J,PARAM,.5\nQ8=POINT/INTOF,J,PARAM,.5,2\nFINI\n"
    ));
    assert_eq!(numbers(&report), [0; 0], "{}", report["diagnostics"]);
    let crown = -(12.5_f64).sqrt();
    for (name, expected) in [("N", 1.0), ("M", 1.0), ("K", 1.0), ("L", 2.0), ("A4", 1.0)] {
        assert_near(&report, name, &[expected]);
    }
    for (name, expected) in [
        ("Q0", [5.0, 0.0, 0.0]),
        ("Q1", [crown, -crown, 0.0]),
        ("Q2", [0.0, -5.0, 0.0]),
        ("T2", [1.0, 0.0, 0.0]),
        ("Q3", [0.0, -5.0, 0.0]),
        ("Q4", [-5.0, 0.0, 0.0]),
        ("Q5", [-5.0, 0.0, 0.0]),
        ("Q6", [0.0, -5.0, 0.0]),
        ("Q7", [crown, -crown, 0.0]),
        ("Q8", [2.5, -5.0, 0.0]),
    ] {
        assert_near(&report, name, &expected);
    }
    assert_eq!(symbol(&report, "X4"), symbol(&report, "G4"));
}

#[test]
fn a_flow_along_a_wide_arc_reaches_its_end() {
    for (kind, layout) in [("ARC", "LENGTH"), ("PARAM", "PARAM"), ("ARC", "PARAM")] {
        let tail = format!("FLOW,{kind},0,1,SEG,{layout},0,1");
        let report = report(&format!(
            "PARTNO WIDE\nC={WIDE},{tail}\nD=SCURV/COMBIN,C,TRFORM,(MATRIX/TRANSL,0,0,4)\n\
             S=SSURF/GENCUR,C,D\nQ1=POINT/INTOF,C,FLOW,.5\nQ2=POINT/INTOF,C,FLOW,1\nM=NUMF(S)\n\
             Q3=POINT/INTOF,S,PARAM,.5,.5,1\nQ4=POINT/INTOF,S,PARAM,1,1,1\nFINI\n"
        ));
        assert_eq!(numbers(&report), [0; 0], "{tail}: {}", report["diagnostics"]);
        let crown = -(12.5_f64).sqrt();
        assert_near(&report, "M", &[1.0]);
        assert_near(&report, "Q1", &[crown, -crown, 0.0]);
        assert_near(&report, "Q2", &[0.0, -5.0, 0.0]);
        assert_near(&report, "Q4", &[0.0, -5.0, 4.0]);
        let middle = symbol(&report, "Q3");
        assert!((middle[0].hypot(middle[1]) - 5.0).abs() < 1e-4 && (middle[0] + middle[1]).abs() < 1e-4);
    }
}

/// What FLOW,PARAM measures is the parameter that the language numbers, of which each arc has 1.
#[test]
fn a_flow_by_parameter_counts_a_wide_arc_as_one() {
    for last in ["3,-4,0", "-4,3,0"] {
        let report = report(&format!(
            "PARTNO FLOW\nA=SCURV/CURSEG,(POINT/5,0,0),(POINT/0,5,0),(POINT/{last})\n\
             B=SCURV/SPLINE,(POINT/{last}),(POINT/-9,-4,0)\n\
             C=SCURV/COMBIN,A,B,FLOW,PARAM,0,2,SEG,LENGTH,0,2\n\
             P=POINT/INTOF,C,FLOW,.5,1\nQ=POINT/INTOF,C,PARAM,.5,1\nR=POINT/INTOF,C,FLOW,.25,1\nFINI\n"
        ));
        let expected: Vec<f64> = last.split(',').map(|x| x.parse().unwrap()).collect();
        assert_near(&report, "P", &expected);
        assert_near(&report, "R", &symbol(&report, "Q"));
    }
}

#[test]
fn a_wide_arc_guides_from_its_first_to_its_last_point() {
    let report = report(&format!(
        "PARTNO WIDE\nCUTTER/.5,.25\nINTOL/.002\nOUTTOL/.002\nMAXDP/1\nC={WIDE}\n\
         S=SSURF/FROM,(PLANE/0,0,1,-1),-9,9,-9,9\nSCON/DS,C,PARAM,0,1,ON,(VECTOR/0,0,-1)\nSCON/PS,TO,S,PLUS,0\n\
         SCON/AXIS,(VECTOR/0,0,1)\nSMIL/PATH,DS,PARAM,0,0,TANSPL,PLUS\nFINI\n"
    ));
    assert_eq!(numbers(&report), [0; 0], "{}", report["diagnostics"]);
    let ends = ends(&report);
    assert!(distance(ends.first().unwrap(), &[5.0, 0.0, -1.0]) < 1e-9);
    assert!(distance(ends.last().unwrap(), &[0.0, -5.0, -1.0]) < 1e-9);
}

#[test]
fn a_pass_begins_at_a_pole_and_ends_at_one() {
    for (start, sense) in [(0, "PLUS"), (1, "MINUS")] {
        let report = report(&format!(
            "PARTNO POLES\nMULTAX\nCUTTER/1,.5\nINTOL/.002\nOUTTOL/.002\nMAXDP/2\n\
             C=SCURV/CURSEG,(POINT/0,0,-5),(POINT/5,0,0),(POINT/0,0,5)\n\
             S=SSURF/REVOLV,C,AXIS,(POINT/0,0,0),(VECTOR/0,0,1),CCLW,0,360\n\
             SCON/DS,S,PARAM,0,1,0,3,AT,NORMAL\nSCON/PS,TO,S,MINUS,0\nSCON/AXIS,NORMDS,MINUS\n\
             SMIL/PATH,DS,PARAM,{start},.5,TANSPL,{sense}\nFINI\n"
        ));
        assert_eq!(numbers(&report), [0; 0], "{sense}: {}", report["diagnostics"]);
        let ends = ends(&report);
        let (bottom, top) = ([0.0, 0.0, -5.0], [0.0, 0.0, 5.0]);
        let [first, last] = if start == 0 { [bottom, top] } else { [top, bottom] };
        assert!(distance(ends.first().unwrap(), &first) < 0.003, "{sense}: {:?}", ends.first());
        assert!(distance(ends.last().unwrap(), &last) < 0.003, "{sense}: {:?}", ends.last());
    }
}

/// PLUS and MINUS tell the natural normal by the parameters of their own patch: of two that join, with parameters that run the other way about
/// the second, the second has the other word. Two words that tell different sides are an error.
#[test]
fn sign_words_of_patches_may_differ_where_their_parameters_turn() {
    let data = |forward: bool| {
        let place = |x: usize, y: usize| format!(",(POINT/{x},{y},{})", (3 - x % 3) * (x % 3));
        let rows = (0..4).flat_map(|row| (0..4).map(move |column| (column, row)));
        let first: String = rows.clone().map(|(x, y)| place(x, y)).collect();
        let second: String = rows.map(|(x, y)| place(if forward { 3 + x } else { 6 - x }, y)).collect();
        [first, second]
    };
    let made = |forward: bool, words: [&str; 2]| {
        let [first, second] = data(forward);
        let whole = format!("S=SSURF/PATCH,POLYGN,{}{first},{}{second}\n", words[0], words[1]);
        let pieces = format!(
            "A=SSURF/PATCH,POLYGN,{}{first}\nB=SSURF/PATCH,POLYGN,{}{second}\nS=SSURF/COMBIN,A,B\n",
            words[0], words[1]
        );
        [whole, pieces].map(|text| report(&format!("PARTNO WORDS\n{text}N=NUMF(S)\nFINI\n")))
    };
    for (forward, words) in [
        (true, ["PLUS", "PLUS"]),
        (false, ["PLUS", "MINUS"]),
        (false, ["MINUS", "PLUS"]),
        (false, ["PLUS", "PLUS"]),
    ] {
        for report in made(forward, words) {
            assert_eq!(numbers(&report), [0; 0], "{words:?}: {}", report["diagnostics"]);
            assert_near(&report, "N", &[2.0]);
        }
    }
    for report in made(true, ["PLUS", "MINUS"]) {
        let findings = report["diagnostics"].as_array().unwrap();
        let error = findings.iter().find(|finding| finding["severity"] == "error").unwrap();
        let message = error["message"].as_str().unwrap();
        assert!(message.contains("tell different sides"), "{message}");
    }
}

/// The edge of the sphere at a pole is one point, and so is a pass along it.
#[test]
fn a_pass_along_a_pole_is_one_location() {
    let program = |axis: &str, command: &str| {
        report(&format!(
            "PARTNO POLES\nMULTAX\nCUTTER/1,.5\nINTOL/.002\nOUTTOL/.002\nMAXDP/2\n\
             C=SCURV/CURSEG,(POINT/0,0,-5),(POINT/5,0,0),(POINT/0,0,5)\n\
             S=SSURF/REVOLV,C,AXIS,(POINT/0,0,0),(VECTOR/0,0,1),CCLW,0,360\n\
             SCON/DS,S,PARAM,0,1,0,3,AT,NORMAL\nSCON/PS,TO,S,MINUS,0\nSCON/AXIS,{axis}\n\
             SCON/FEED,1,2,3,4\nSCON/STEPOV,0,2,0,0\n{command}\nFINI\n"
        ))
    };
    for (u, z) in [(0, -5.0), (1, 5.0)] {
        for axis in ["NORMDS,MINUS".to_owned(), format!("(VECTOR/0,0,{})", 2 * u - 1)] {
            let report = program(&axis, &format!("SMIL/PATH,DS,PARAM,{u},0,CRSSPL,PLUS"));
            assert_eq!(numbers(&report), [0; 0], "{axis}: {}", report["diagnostics"]);
            let ends = ends(&report);
            assert_eq!(ends.len(), 1, "{axis}: {ends:?}");
            assert!(distance(&ends[0], &[0.0, 0.0, z]) < 0.003, "{axis}: {ends:?}");
        }
    }
    // From pole to pole, with an axis that leans forward by an angle at both as everywhere.
    for (axis, lean) in [("NORMDS,MINUS", 0.0), ("ATANGL,PS,0,CUTANG,10", 10f64)] {
        let report = program(axis, "SMIL/ZIGZAG,DS,PARAM,0,0,CRSSPL,PLUS,STEPOV,PLUS");
        assert_eq!(numbers(&report), [0; 0], "{axis}: {}", report["diagnostics"]);
        let ends = ends(&report);
        let most = 0.003 + lean.to_radians();
        for (end, z) in [(ends.first(), -5.0), (ends.last(), 5.0)] {
            let end = end.unwrap();
            assert!(distance(end, &[0.0, 0.0, z]) < most, "{axis}: {end:?}");
        }
    }
}

/// The message of the only error.
fn the_error(text: &str) -> String {
    let report = report(text);
    let findings = report["diagnostics"].as_array().unwrap();
    let errors: Vec<&Value> = findings.iter().filter(|finding| finding["severity"] == "error").collect();
    assert_eq!(errors.len(), 1, "{text}: {errors:?}");
    errors[0]["message"].as_str().unwrap().to_owned()
}

#[test]
fn a_point_takes_each_qualifier_once_and_only_those_of_its_curve() {
    for (form, word) in [
        ("SCURV/CURSEG,P,WEIGHT,.5,Q", "WEIGHT"),
        ("SCURV/CURSEG,P,Q,LIMIT,.5", "LIMIT"),
        ("SCURV/SPLINE,P,TANSPL,V,TANSPL,V,Q", "TANSPL"),
        ("SCURV/SPLINE,P,NORMAL,V,CRSSPL,V,NORMAL,V,Q", "NORMAL"),
        ("SCURV/SPLINE,WEIGHT,.5,WEIGHT,.4,P,Q", "WEIGHT"),
        ("SSURF/SMESH,XYZ,SPLINE,P,CRSSPL,V,CRSSPL,V,Q,SPLINE,R,Q", "CRSSPL"),
    ] {
        let text = format!(
            "PARTNO T\nP=POINT/0,0,0\nQ=POINT/4,1,0\nR=POINT/0,3,0\nV=VECTOR/1,1,2\nC={form}\nFINI\n"
        );
        let message = the_error(&text);
        assert!(message.ends_with(&format!("not the word {word}")), "{form}: {message}");
    }
}

#[test]
fn every_row_of_another_length_is_told() {
    let message = the_error(
        "PARTNO T\nP=POINT/0,0,0\nQ=POINT/4,1,0\nR=POINT/0,3,0\nU=POINT/4,4,0\nW=POINT/8,0,0\n\
         S=SSURF/SMESH,XYZ,SPLINE,P,Q,W,SPLINE,R,U,SPLINE,P,Q,W,SPLINE,P,Q,W,U\nFINI\n",
    );
    assert!(message.ends_with("row 2 has 2 points, row 4 has 4 and the first one 3"), "{message}");
}

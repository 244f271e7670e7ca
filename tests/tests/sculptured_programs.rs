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
    let findings = report["diagnostics"].as_array().unwrap();
    findings.iter().map(|finding| finding["apt3"].as_u64().unwrap_or(0)).collect()
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

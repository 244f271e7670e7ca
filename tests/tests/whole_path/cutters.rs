//! The seven parameters of CUTTER, from the source text: what is wrong with them, and that every legal shape cuts.

use apt_tests::runs::{analysis, report};
use serde_json::Value;

fn told(cutter: &str) -> (Value, Vec<(u64, String)>) {
    let text = format!(
        "CUTTER/{cutter}\nOUTTOL/.001\nPS=SPHERE/0,0,-9,9\nDS=PLANE/0,1,.1,0\nFROM/-3,2,4\n\
         GO/TO,DS,TO,PS,ON,(PLANE/1,0,0,-1)\nINDIRV/1,0,0\nTLLFT,GOFWD/DS,ON,(PLANE/1,0,0,1)\nFINI\n"
    );
    let report = report(&analysis(&text, "free")).unwrap();
    let numbers = report["diagnostics"].as_array().unwrap().iter().filter_map(|one| {
        Some((one["apt3"].as_u64()?, one["severity"].as_str().unwrap_or_default().to_owned()))
    });
    let numbers = numbers.collect();
    (report, numbers)
}

#[test]
fn every_wrong_parameter_has_its_number() {
    for (cutter, number, severity) in [
        ("-1", 401, "error"),
        ("1,0,0,0,0,0,-2", 402, "error"),
        ("1,0,0,0,60,30,2", 403, "error"),
        ("1,0,0,0,-5,0,2", 404, "error"),
        ("1,0,.5,.1,45,0,.2", 405, "error"),
        ("1,0,0,0,0,-5,2", 406, "error"),
        ("1,-.1", 407, "error"),
        ("1,.1,.4,.05,30,0,2", 408, "error"),
        ("0.5,.1,.4,.1,0,10,3", 410, "error"),
        ("1,.1,.1,.1,0,0,3", 411, "error"),
        ("4,1,1,1,0,0,.5", 412, "error"),
        ("1,.6,-.1,.6,0,0,3", 415, "warning"),
        ("1,.6", 417, "error"),
    ] {
        let (report, numbers) = told(cutter);
        let hit = numbers.iter().find(|(found, _)| (400..420).contains(found));
        assert_eq!(hit, Some(&(number, severity.to_owned())), "CUTTER/{cutter}: {}", report["diagnostics"]);
        // Without a cutter nothing moves; after a warning it does.
        let moved = report["motions"].as_array().unwrap().len();
        assert_eq!(moved > 0, severity == "warning", "CUTTER/{cutter}: {}", report["diagnostics"]);
    }
}

#[test]
fn every_legal_shape_cuts_within_its_tolerances() {
    for cutter in [
        "0.5",
        "0.5,.25",
        "0.5,.1",
        "0",
        "0,0,0,0,0,0,2",
        "0,0,0,0,0,0,.001",
        "1,0,.5,0,0,10,2",
        "1,.1875,.33,.22,10,5,2",
        "0.5,0,.25,.150215,31,0,2",
        "1,.2,.3,.2,0,0,4",
    ] {
        let (report, _) = told(cutter);
        assert_eq!(report["ok"], true, "CUTTER/{cutter}: {}", report["diagnostics"]);
        for motion in report["motions"].as_array().unwrap() {
            assert_eq!(motion["verified"], true, "CUTTER/{cutter}: {motion}");
        }
    }
}

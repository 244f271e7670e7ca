//! What regional milling means to the lints: it moves the tool, cuts a curved surface and brings its own feeds.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::sync::Arc;

use apt_run::{
    document::{Document, Level},
    format::applied,
    settings::Settings,
};

const SURFACE: &str = "\
VZ=VECTOR/0,0,1
VM=VECTOR/0,0,-1
A1=POINT/0,0,0
A2=POINT/2,0,0
B1=POINT/0,2,0
B2=POINT/2,2,0
S1=SSURF/SMESH,XYZ,SPLINE,A1,A2,SPLINE,B1,B2
SCON/DS,S1,PARAM,0,1,0,1,ON,VM
SCON/PS,TO,S1,PLUS,0
SCON/AXIS,VZ
";

/// The program after the only fix of a finding.
fn fixed(text: &str, code: &str) -> String {
    let settings = Arc::new(Settings { dialect: Some("apt4".to_owned()), ..Settings::default() });
    let text = format!("{SURFACE}{text}FINI\n");
    let document = Document::new(&text, Some("part.apt".to_owned()), &settings);
    let all = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
    let finding = all.iter().find(|one| one.wording.code == code).unwrap();
    assert_eq!(finding.fixes.len(), 1, "{:?}", finding.fixes);
    let fixed = applied(&text, &finding.fixes[0].edits);
    fixed.strip_prefix(SURFACE).unwrap().strip_suffix("FINI\n").unwrap().to_owned()
}

/// The codes of a program behind the surface and its conditions.
fn codes(text: &str) -> Vec<&'static str> {
    let settings = Arc::new(Settings { dialect: Some("apt4".to_owned()), ..Settings::default() });
    let document = Document::new(&format!("{SURFACE}{text}FINI\n"), Some("part.apt".to_owned()), &settings);
    let all = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    all.iter().map(|one| one.wording.code).collect()
}

const PATH: &str = "SMIL/PATH,DS,PARAM,0,.5,TANSPL,PLUS\n";
const PASSES: &str =
    "SCON/FEED,5,6,7,8\nSCON/STEPOV,0,1,0,2\nSMIL/ZIGZAG,DS,PARAM,0,.2,TANSPL,PLUS,STEPOV,PLUS\n";

#[test]
fn modal_statements_between_passes_have_served() {
    let set = "CUTTER/.5,.25\nINTOL/.002\nOUTTOL/.002\nMAXDP/1\n";
    let again = "CUTTER/.4,.2\nINTOL/.003\nOUTTOL/.003\nMAXDP/2\n";
    assert_eq!(codes(&format!("{set}{PATH}{again}{PATH}")), Vec::<&str>::new());
    assert_eq!(codes(&format!("{set}CUTTER/.4,.2\n{PATH}")), ["APT0962"]);
}

#[test]
fn a_pass_without_tolerances_or_feed_is_told() {
    let tools = "CUTTER/.5,.25\nINTOL/.002\nOUTTOL/.002\n";
    assert_eq!(codes(&format!("CUTTER/.5,.25\n{PATH}")), ["APT0954"]);
    assert_eq!(codes(&format!("MACHIN/MACH1,1\n{tools}{PATH}")), ["APT0955"]);
    assert_eq!(codes(&format!("MACHIN/MACH1,1\n{tools}FEDRAT/5\n{PATH}")), Vec::<&str>::new());
    assert_eq!(codes(&format!("MACHIN/MACH1,1\n{tools}{PASSES}")), Vec::<&str>::new());
}

#[test]
fn older_spellings_and_missing_checks_have_their_fix() {
    assert_eq!(fixed("PRINT/AVMSG,ON\n", "APT0522"), "PRINT/AVPRT,ON\n");
    let older = PATH.replace("PATH", "CUT");
    assert_eq!(fixed(&older, "APT0522"), PATH);
    let unchecked = format!("AVCTRL/AXIS,LIMIT,1\n{PATH}");
    let checked = format!("AVCTRL/AXIS,LIMIT,1\nCHKSRF/PS,ON\n{PATH}");
    assert_eq!(fixed(&unchecked, "APT0524"), checked);
    assert_eq!(codes(&format!("CUTTER/.5,.25\nINTOL/.01\nOUTTOL/.01\n{checked}")), Vec::<&str>::new());
}

#[test]
fn a_start_outside_of_the_guide_says_where_the_range_is_given() {
    let settings = Arc::new(Settings { dialect: Some("apt4".to_owned()), ..Settings::default() });
    let text = format!("{SURFACE}CUTTER/.5,.25\nSMIL/PATH,DS,PARAM,2,.5,TANSPL,PLUS\nFINI\n");
    let document = Document::new(&text, Some("part.apt".to_owned()), &settings);
    let all = document.diagnostics(Level::Section1, &|| false, &mut |_, _| {}).unwrap();
    let finding = all.iter().find(|one| one.wording.code == "APT0322").unwrap();
    assert_eq!(finding.wording.apt3, Some(3563));
    assert!(finding.wording.hint.as_deref().unwrap().contains("SCON/DS"), "{:?}", finding.wording.hint);
}

//! Statements thrown together from their words: whatever it is, it is taken or told.

use apt_program::Severity;

use super::{CONDITIONS, regional, run};

/// Operands to throw together.
const OPERANDS: &[&str] = &[
    "A1",
    "A2",
    "B1",
    "B2",
    "D1",
    "VZ",
    "VN",
    "PLT",
    "L1",
    "M1",
    "K1",
    "K2",
    "KF",
    "SS",
    "0",
    "1",
    "-1",
    ".5",
    "1E30",
    "16",
    "PARAM",
    "FLOW",
    "TANSPL",
    "CRSSPL",
    "NORMAL",
    "UNIT",
    "PLUS",
    "MINUS",
    "SPLINE",
    "AXIS",
    "DS",
    "PS",
    "TO",
    "ON",
    "AT",
    "XYZ",
    "XYPLAN",
    "CROSS",
    "TRFORM",
    "SEG",
    "LENGTH",
    "ARC",
    "CHORD",
    "ANGLE",
    "WEIGHT",
    "LIMIT",
    "STEPOV",
    "FEED",
    "INIT",
    "ALL",
    "CLW",
    "CCLW",
    "POLYGN",
    "PNTVEC",
    "PNTSON",
    "DEGREE",
    "KNOTS",
    "PTS",
    "INCR",
    "NORMDS",
    "NORMPS",
    "ATANGL",
    "CUTANG",
    "CONST",
    "RANGE",
    "POSX",
    "NEGY",
    "INTOF",
    "(1,2,3)",
    "(VECTOR/0,1,0)",
    "UVAL",
    "PATCH",
];

/// What statements begin with.
const HEADS: &[&str] = &[
    "S=SSURF/GENCUR,",
    "S=SSURF/RULED,",
    "S=SSURF/REVOLV,",
    "S=SSURF/SMESH,XYZ,SPLINE,",
    "S=SSURF/PATCH,POLYGN,PLUS,",
    "S=SSURF/TRANSL,",
    "S=SSURF/COMBIN,",
    "S=SSURF/NURBS,",
    "S=SSURF/FROM,",
    "S=SSURF/CANON,",
    "C=SCURV/SPLINE,",
    "C=SCURV/CURSEG,",
    "C=SCURV/COMBIN,",
    "C=SCURV/SEG,",
    "C=SCURV/NURBS,",
    "C=SCURV/CANON,",
    "Q=POINT/INTOF,",
    "Q=VECTOR/INTOF,",
    "SCON/DS,",
    "SCON/PS,",
    "SCON/AXIS,",
    "SCON/FEED,",
    "SCON/STEPOV,",
    "SCON/",
    "SMIL/POSN,DS,PARAM,",
    "SMIL/PATH,DS,PARAM,",
    "SMIL/ZIGZAG,DS,PARAM,",
    "SMIL/",
    "CHKSRF/",
    "AVCTRL/",
    "AVCTRL/CUTANG,",
    "X=1\nPRINT/",
];

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(128))]

    #[test]
    fn whatever_is_thrown_together_is_taken_or_told(
        head in 0..HEADS.len(),
        operands in proptest::collection::vec(0..OPERANDS.len(), 1..12),
    ) {
        let operands: Vec<&str> = operands.into_iter().map(|index| OPERANDS[index]).collect();
        let text = format!("{CONDITIONS}{}{}\nCHKSRF/PS,ON\nSMIL/PATH,DS,PARAM,.2,.2,TANSPL,PLUS", HEADS[head], operands.join(","));
        let program = run(&text);
        // Either the command has its conditions, or something is said about why not.
        let told = program.findings().any(|finding| finding.severity == Severity::Error);
        proptest::prop_assert!(told || regional(&program).iter().any(|one| one.checked.part), "{text}");
    }
}

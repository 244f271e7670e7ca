//! Definitions that give nothing: each has its number and says why.

use super::session;

/// A statement, the APT III number that it gives, and a word of the evidence.
const ERRORS: &[(&str, u16, &str)] = &[
    ("POINT/1", 1000, "UnknownFormat"),
    ("POINT/1,2,3,4,5", 1000, "UnknownFormat"),
    ("LINE/1,2", 1000, "UnknownFormat"),
    ("LINE/(1,2),C2", 1000, "UnknownFormat"),
    ("VECTOR/(1,2,3)", 1000, "UnknownFormat"),
    ("POLCON/1,2", 1000, "UnknownFormat"),
    ("POINT/ZLARGE,INTOF,L0,C2", 1003, "XLarge"),
    ("LINE/PARLEL,L0,RIGHT,2", 1003, "position: 2"),
    ("LINE/(1,2),PARLEL,C2", 1000, "UnknownFormat"),
    ("LINE/ZAXIS", 1003, "position: 0"),
    ("LINE/PARLEL,L0,ZLARGE,1", 1003, "position: 2"),
    ("LINE/(9,9),LARGE,TANTO,C2", 1003, "position: 1"),
    ("CIRCLE/YLARGE,LX,XSMALL,LARGE,C5,RADIUS,1", 1003, "position: 3"),
    ("MATRIX/XLARGE,90", 1003, "XyRotation"),
    ("VECTOR/PERPTO,PLX,POSZ", 1005, "Undecided"),
    ("POINT/INTOF,LX,(LINE/0,1,5,1)", 1005, "Parallel"),
    ("POINT/XLARGE,INTOF,LX,(CIRCLE/0,3,1)", 1005, "gap: 2.0"),
    ("POINT/YLARGE,INTOF,LX,C5", 1005, "Undecided"),
    ("POINT/XLARGE,INTOF,CA,CB", 1005, "NoIntersection"),
    ("POINT/XLARGE,INTOF,CA,C2", 1005, "Coincident"),
    ("POINT/XLARGE,INTOF,(LINE/0,9,1,9),E1", 1005, "NoIntersection"),
    ("POINT/INTOF,PLX,PLX,PLZ", 1005, "Singular"),
    ("POINT/PA,5", 154, "position: Some(1)"),
    ("POINT/PA,0", 154, "position: Some(1)"),
    ("LINE/1,2,1,2", 1005, "Coincident"),
    ("LINE/(1,0),LEFT,TANTO,C2", 1005, "InsideCircle"),
    ("LINE/LEFT,TANTO,CC,RIGHT,TANTO,C5", 1005, "CirclesTooNear"),
    ("LINE/INTOF,PLX,PLY", 1005, "Parallel"),
    ("LINE/INTOF,PLX,PLX", 1005, "Parallel"),
    ("LINE/PARLEL,LX,XLARGE,1", 1005, "Undecided"),
    ("PLANE/0,0,0,1", 1005, "ZeroVector"),
    ("PLANE/(0,0,0),(1,1,1),(2,2,2)", 1005, "Collinear"),
    ("PLANE/PERPTO,PLZ,(0,0,0),(0,0,1)", 1005, "Parallel"),
    ("PLANE/(0,0,0),PERPTO,PLX,PLX", 1005, "Parallel"),
    ("PLANE/(0,0,0),PERPTO,(VECTOR/0,0,0)", 1005, "ZeroVector"),
    ("CIRCLE/(0,0),(1,1),(3,3)", 1005, "Collinear"),
    ("CIRCLE/YLARGE,LX,YLARGE,LX,RADIUS,1", 1005, "Parallel"),
    ("CIRCLE/TANTO,LX,XLARGE,(0,3),RADIUS,1", 1005, "RadiusTooSmall { radius: 1.0, least: 1.5 }"),
    ("CIRCLE/YLARGE,OUT,CA,OUT,CB,RADIUS,.5", 1005, "RadiusTooSmall"),
    ("CYLNDR/0,0,0,0,0,0,1", 1005, "ZeroVector"),
    ("CONE/(0,0,0),VX,90", 1005, "AngleOutOfRange"),
    ("SPHERE/(0,0,0),(1,0,0),(0,1,0),(1,1,0)", 1005, "Singular"),
    ("LCONIC/5PT,0,0,1,1,2,2,3,3,4,4", 1005, "Collinear"),
    ("LCONIC/5PT,0,0,0,0,2,2,3,4,4,4", 1005, "Coincident"),
    ("VECTOR/UNIT,0,0,0", 1005, "ZeroVector"),
    ("MATRIX/(0,0,0),VX,VX", 1005, "Parallel"),
    ("MATRIX/INVERS,(MATRIX/SCALE,0)", 1005, "Singular"),
    ("TABCYL/NOZ,SPLINE,0,0,1,1", 1001, "Special"),
    ("TABCYL/NOZ,FOURPT,0,0,1,1,2,2", 1001, "Special"),
    ("TABCYL/NOZ,SPLINE,0,0,0,0,1,1", 1005, "Coincident"),
    ("TABCYL/XYZ,PTSLOP,VZ,0,0,0,1,1,1", 1000, "UnknownFormat"),
    ("PATERN/LINEAR,(0,0)", 800, "UnknownFormat"),
    ("PATERN/LINEAR,(0,0),VX,1000000000", 802, "Special"),
    ("PATERN/PARLEL,(PATERN/RANDOM,PA),VX,2", 801, "Special"),
    ("RLDSRF/PLZ,(0,0,3),(0,0,3.001),VY,(2,5,5)", 701, "Special"),
    ("RLDSRF/PLZ,(0,0,3),(4,0,3),VX,(2,5,5)", 702, "Special"),
    ("RLDSRF/PLZ,(0,0,3),(4,0,3),(2,0,3),(2,5,5)", 702, "Special"),
    ("RLDSRF/PLZ,(0,0,3)", 1002, "UnknownFormat"),
    ("POINT/CANON,1,2", 84, "expected: 3"),
    ("CIRCLE/C2,CANON,1,2,3,4,5,6,7,8", 84, "expected: 7"),
    ("CIRCLE/L0,CANON,1", 80, "found: Line"),
    ("CIRCLE/CANON,1,2,,0,0,1,4", 83, "Special"),
    ("CIRCLE/C2,CANON,LX", 83, "Special"),
    ("CIRCLE/C2,CANON,,,,,,,0", 1005, "NotPositive"),
    ("RLDSRF/CANON,1", 1000, "Special"),
    ("PATERN/CANON,1,1,1,0,0,0", 1000, "Special"),
    ("PATERN/PA,CANON,3", 1000, "Special"),
    ("CIRCLE/TANTO,LX,XLARGE,(0,1),RADIUS,-1", 1005, "NotPositive"),
    ("CONE/(0,0,0),VX,-90", 1005, "AngleOutOfRange"),
    ("PATERN/ARC,C2,0,CCLW,INCR,10,INCR,10", 800, "UnknownFormat"),
];

#[test]
fn impossible_and_malformed_definitions_say_why() {
    let session = session();
    for (body, number, evidence) in ERRORS {
        let error = session.body(body).expect_err(body);
        let text = format!("{error:?}");
        assert_eq!(error.apt3(), Some(*number), "{body}: {text}");
        assert!(text.contains(evidence), "{body}: {text} does not show {evidence}");
    }
}

#[test]
fn a_vertical_z_surface_gives_no_z() {
    let mut session = session();
    session.run("ZSURF/1,0,0,5").expect("a plane");
    let error = session.body("POINT/1,2").expect_err("no z");
    assert!(format!("{error:?}").contains("VerticalZSurface"));
    session.run("ZSURF/0,0,2,5").expect("a plane");
    assert_eq!(session.body("POINT/1,2").expect("a point").canonical_values(), [1.0, 2.0, 2.5]);
}

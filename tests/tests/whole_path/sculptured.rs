//! Sculptured surfaces of every form of SSURF as part, drive and check surface, from the source text to proven cut vectors.

use std::fmt::Write as _;

use apt_tests::runs::{analysis, report};

/// Heights of the sixteen points P of a hill, over x = 0, 2, 4, 6 and y = 0, 1.5, 3, 4.5.
const HEIGHTS: [[f64; 4]; 4] =
    [[0.0, 0.5, 0.8, 0.2], [0.3, 1.4, 1.1, 0.4], [0.2, 1.2, 1.6, 0.5], [0.1, 0.6, 0.7, 0.0]];

/// Curves over it: CA, CB and CD along x at the beginning, in the middle and at the end of y, CC along y.
const CURVES: &str = "CA=SCURV/SPLINE,(POINT/0,0,.2),(POINT/3,0,1.2),(POINT/6,0,.3)\n\
    CC=SCURV/SPLINE,(POINT/0,0,.2),(POINT/0,2.25,.6),(POINT/0,4.5,.1)\n\
    SA=SCURV/SPLINE,(POINT/0,0,.2),(POINT/3,0,1.2),(POINT/6,0,.3),$\n  FLOW,PARAM,0,2,SEG,PARAM,0,1,PARAM,1,2\n\
    SB=SCURV/SPLINE,(POINT/0,2,.4),(POINT/3,2,1.6),(POINT/6,2,.2),$\n  FLOW,PARAM,0,2,SEG,PARAM,0,1,PARAM,1,2\n\
    SD=SCURV/SPLINE,(POINT/0,4,.1),(POINT/3,4,.8),(POINT/6,4,.5),$\n  FLOW,PARAM,0,2,SEG,PARAM,0,1,PARAM,1,2\n\
    CT=SCURV/SPLINE,(POINT/.38,0,.12),(POINT/.21,2.25,.48),$\n  (POINT/.34,4.5,.21)\n\
    S1=SSURF/PATCH,POLYGN,PLUS,P(1,THRU,16)\n";

/// Definitions of the part surface S.
const FORMS: [(&str, &str); 19] = [
    ("control points", "S=SSURF/PATCH,POLYGN,PLUS,P(1,THRU,16)"),
    ("control points, other side", "S=SSURF/PATCH,POLYGN,MINUS,P(1,THRU,16)"),
    ("points on the patch", "S=SSURF/PATCH,PNTSON,PLUS,P(1,THRU,16)"),
    (
        "points, tangents and twists",
        "V0=VECTOR/0,0,0\nS=SSURF/PATCH,PNTVEC,PLUS,(POINT/0,0,0),(POINT/6,0,.3),$\n\
         (VECTOR/6,0,3),(VECTOR/6,0,-2),(POINT/0,4.5,.2),(POINT/6,4.5,0),$\n\
         (VECTOR/6,0,2),(VECTOR/6,0,-2),(VECTOR/0,4.5,2),(VECTOR/0,4.5,1),V0,V0,$\n\
         (VECTOR/0,4.5,-1),(VECTOR/0,4.5,-1),V0,V0",
    ),
    (
        "mesh",
        "S=SSURF/SMESH,XYZ,SPLINE,P(1,THRU,4),SPLINE,P(5,THRU,8),$\n\
         SPLINE,P(9,THRU,12),SPLINE,P(13,THRU,16)",
    ),
    (
        "mesh with tangents",
        "VT=VECTOR/1,0,.3\nS=SSURF/SMESH,XYZ,SPLINE,P(1),TANSPL,VT,P(2),P(3),P(4),$\n\
         SPLINE,P(5),TANSPL,VT,P(6),P(7),P(8),$\n\
         SPLINE,P(9),TANSPL,VT,P(10),P(11),P(12)",
    ),
    (
        "mesh over a plane",
        "S=SSURF/SMESH,XYPLAN,SPLINE,P(1,THRU,4),SPLINE,P(5,THRU,8),$\n\
         SPLINE,P(9,THRU,12),SPLINE,P(13,THRU,16)",
    ),
    ("mesh, by its other name", "S=SSURF/GMESH,XYZ,SPLINE,P(1,THRU,4),SPLINE,P(9,THRU,12)"),
    ("two curves", "S=SSURF/GENCUR,SA,SD"),
    ("three curves", "S=SSURF/GENCUR,SA,SB,SD"),
    ("rulings along a vector", "S=SSURF/RULED,CA,AXIS,(VECTOR/.3,4.5,.4)"),
    ("rulings between points", "S=SSURF/RULED,CA,AXIS,(POINT/0,0,.5),(POINT/.2,4.5,.7)"),
    ("surface of revolution", "S=SSURF/REVOLV,CT,AXIS,(POINT/3,0,-5.5),(VECTOR/0,1,0),CCLW,0,50"),
    ("curve along a curve", "S=SSURF/TRANSL,CA,CROSS,CC"),
    (
        "patches side by side",
        "S2=SSURF/PATCH,POLYGN,PLUS,(POINT/0,-4.5,.1),(POINT/2,-4.5,.3),$\n\
         (POINT/4,-4.5,.6),(POINT/6,-4.5,0),(POINT/0,-3,.2),(POINT/2,-3,.1),$\n\
         (POINT/4,-3,.7),(POINT/6,-3,.1),(POINT/0,-1.5,-.3),(POINT/2,-1.5,-.4),$\n\
         (POINT/4,-1.5,.5),(POINT/6,-1.5,0),P(1,THRU,4)\nS=SSURF/COMBIN,S1,S2",
    ),
    ("a transformed copy", "S=SSURF/COMBIN,S1,TRFORM,(MATRIX/TRANSL,.1,.05,.1)"),
    (
        "B-spline with weights",
        "S=SSURF/NURBS,DEGREE,3,3,KNOTS,0,0,0,0,1,1,1,1,KNOTS,0,0,0,0,1,1,1,1,$\n\
         PTS,P(1,THRU,16),WEIGHT,1,1.2,.9,1,1,1.5,1.3,1,1,1.1,1.4,1,1,1,.9,1",
    ),
    ("piece of a cylinder", "S=SSURF/FROM,(CYLNDR/3,0,-5,0,1,0,6),0,360,0,4.5"),
    (
        "ridge",
        "S2=SSURF/RULED,(SCURV/CURSEG,(POINT/0,0,.3),(POINT/3,0,.9)),AXIS,$\n(VECTOR/0,4.5,0)\n\
         S3=SSURF/RULED,(SCURV/CURSEG,(POINT/3,0,.9),(POINT/6,0,.3)),AXIS,$\n(VECTOR/0,4.5,0)\n\
         S=SSURF/COMBIN,S2,S3",
    ),
];

/// Cutter, how the part surface is met at the start, and the words of the motion.
const WAYS: [(&str, &str, &str); 3] =
    [(".5,.25", "TO", "TLON"), (".5,.25", "ON", "TLONPS,TLON"), (".5", "ON", "TLONPS,TLON")];

/// A cutter, tolerances, and the hill S.
fn hill(form: &str, cutter: &str) -> String {
    let mut text = format!("CUTTER/{cutter}\nINTOL/.002\nOUTTOL/.002\nRESERV/P,16\n");
    for (k, height) in HEIGHTS.iter().flatten().enumerate() {
        let (x, y) = (2 * (k % 4), 1.5 * (k / 4) as f64);
        writeln!(text, "P({})=POINT/{x},{y},{height}", k + 1).unwrap();
    }
    text + CURVES + form
}

fn program(form: &str, (cutter, start, motion): (&str, &str, &str)) -> String {
    hill(form, cutter)
        + "\nK1=PLANE/0,1,0,2\nK2=PLANE/1,0,0,1\nK3=PLANE/1,0,0,5\nFROM/1,2,6\nPSIS/S\nGO/ON,K1,"
        + start
        + ",S,ON,K2\nINDIRV/1,0,0\n"
        + motion
        + ",GOFWD/K1,ON,K3\nFINI\n"
}

/// Runs a program without errors, all of whose motions are proven; returns how many are.
fn proven(name: &str, text: &str) -> usize {
    let report = report(&analysis(text, "apt4")).unwrap();
    assert_eq!(report["ok"], true, "{name}: {}", report["diagnostics"]);
    let motions = report["motions"].as_array().unwrap();
    assert!(motions.iter().all(|motion| motion["verified"] != false), "{name}: {motions:?}");
    motions.iter().filter(|motion| motion["verified"] == true).count()
}

#[test]
fn every_form_is_a_part_surface() {
    let mut count = 0;
    for (name, form) in FORMS {
        for way in WAYS {
            count += proven(&format!("{name}, {way:?}"), &program(form, way));
        }
    }
    // A start and a motion each.
    assert_eq!(count, 2 * FORMS.len() * WAYS.len());
}

/// A tool that ends below the upper end of the hill stood on edge, W, which faces the tool that comes along y; and motions
/// along it, up to it and past it.
const SHORT: &str = ".5,.25,0,.25,0,0,.5";
const STOOD: &str = "\nW=SSURF/COMBIN,S,TRFORM,(MATRIX/YZROT,90)\nPZ=PLANE/0,0,1,1.2\nDL=PLANE/1,-.2,0,3.2\n\
    K2=PLANE/1,0,0,1\nK3=PLANE/1,0,0,5\n";
const ROLES: [(&str, &str); 8] = [
    ("right of it", "FROM/1,-4,2\nGO/TO,W,TO,PZ,ON,K2\nINDIRV/1,0,0\nTLRGT,GOFWD/W,ON,K3"),
    ("left of it", "FROM/1,4,2\nGO/TO,W,TO,PZ,ON,K2\nINDIRV/1,0,0\nTLLFT,GOFWD/W,ON,K3"),
    ("past it and along", "FROM/1,-4,2\nGO/PAST,W,TO,PZ,ON,K2\nINDIRV/1,0,0\nTLLFT,GOFWD/W,ON,K3"),
    ("on it", "FROM/1,-4,2\nGO/ON,W,TO,PZ,ON,K2\nINDIRV/1,0,0\nTLON,GOFWD/W,ON,K3"),
    ("to it", "FROM/3,-4,2\nGO/ON,DL,TO,PZ,ON,(PLANE/0,1,0,-4)\nINDIRV/0,1,0\nTLON,GOFWD/DL,TO,W"),
    ("stop on it", "FROM/3,-4,2\nGO/ON,DL,TO,PZ,ON,(PLANE/0,1,0,-4)\nINDIRV/0,1,0\nTLON,GOFWD/DL,ON,W"),
    ("past it", "FROM/3,-4,2\nGO/ON,DL,TO,PZ,ON,(PLANE/0,1,0,-4)\nINDIRV/0,1,0\nTLON,GOFWD/DL,PAST,W"),
    ("from behind", "FROM/3,3,2\nGO/ON,DL,TO,PZ,ON,(PLANE/0,1,0,3)\nINDIRV/0,-1,0\nTLON,GOFWD/DL,TO,W"),
];

#[test]
fn every_form_is_a_drive_and_a_check_surface() {
    let mut count = 0;
    for (name, form) in FORMS {
        for (role, motions) in ROLES {
            let text = hill(form, SHORT) + STOOD + motions + "\nFINI\n";
            count += proven(&format!("{name}, {role}"), &text);
        }
    }
    assert_eq!(count, 2 * FORMS.len() * ROLES.len());
}

/// A tool that is higher than the hill stood on edge, and where the hill leans or bulges touches the end of it.
const HIGH: &str = ".5,.25,0,.25,0,0,12";
const HIGH_ROLES: [&str; 4] = ["right of it", "left of it", "to it", "past it"];
/// Left of it the tool touches many parts of the model that stands for weights, which takes minutes (docs/arelem.md).
const SLOW: (&str, &str) = ("B-spline with weights", "left of it");

#[test]
fn a_tool_may_be_higher_than_a_wall_of_any_form() {
    let mut count = 0;
    for (name, form) in FORMS {
        let is_tried = |role: &str| HIGH_ROLES.contains(&role) && (name, role) != SLOW;
        for (role, motions) in ROLES.into_iter().filter(|(role, _)| is_tried(role)) {
            let text = hill(form, HIGH) + STOOD + motions + "\nFINI\n";
            count += proven(&format!("{name}, {role}"), &text);
        }
    }
    assert_eq!(count, 2 * (FORMS.len() * HIGH_ROLES.len() - 1));
}

#[test]
fn the_axis_follows_the_normal_of_part_and_drive_surface() {
    for words in ["NORMPS", "NORMDS"] {
        let text = program(FORMS[0].1, WAYS[0]).replace("PSIS/S", &format!("MULTAX\nTLAXIS/{words}\nPSIS/S"));
        assert_eq!(proven(words, &text), 2, "{words}");
    }
}

/// A wall over a curve, and motions that meet it.
const WALL: &str = "CUTTER/.5\nINTOL/.001\nOUTTOL/.001\n\
    C=SCURV/SPLINE,(POINT/0,0,0),(POINT/3,1,0),(POINT/6,0,0)\nW=SSURF/RULED,C,AXIS,(VECTOR/0,0,1)\n";
const MEETINGS: [(&str, &str); 3] = [
    (
        "labels",
        "L1=LINE/(3,9),(3,-9)\nFAR=LINE/0,-5,9,-5\nFROM/3,5,0\nGO/ON,L1\nINDIRV/0,-1,0\n\
         TLON,GOFWD/L1,TO,W,A1,TO,FAR,A2\nA2)GOTO/0,0,22\nA1)GOTO/0,0,11\nFINI\n",
    ),
    (
        "second position",
        "L1=LINE/0,.5,6,.5\nFROM/-3,.5,0\nGO/ON,L1\nINDIRV/1,0,0\nTLON,GOFWD/L1,ON,2,INTOF,W\n\
         GOTO/0,0,11\nFINI\n",
    ),
    (
        "tangency",
        "L1=LINE/0,1,6,1\nFROM/0,5,0\nGO/TO,L1\nINDIRV/1,0,0\nTLLFT,GOFWD/L1,TANTO,W\nGOTO/0,0,11\nFINI\n",
    ),
];

#[test]
fn a_wall_is_met_at_labels_at_its_second_position_and_tangentially() {
    for (name, meeting) in MEETINGS {
        assert_eq!(proven(name, &format!("{WALL}{meeting}")), 2, "{name}");
    }
}

/// A sheet and a wall, S and W, that leave planes along which they begin, and go on straight before that.
const FILLETS: &str = "INTOL/.002\nOUTTOL/.002\nC=SCURV/CURSEG,(POINT/0,0,0),TANSPL,(VECTOR/1,0,0),(POINT/4,0,2)\n\
    S=SSURF/RULED,C,AXIS,(VECTOR/0,6,0)\nD=SCURV/CURSEG,(POINT/0,0,0),TANSPL,(VECTOR/1,0,0),(POINT/4,2,0)\n\
    W=SSURF/RULED,D,AXIS,(VECTOR/0,0,4)\nPL=PLANE/0,0,1,0\nDL=PLANE/0,1,0,3\nDW=PLANE/0,1,0,0\n\
    PX=PLANE/1,0,0,3\nPM=PLANE/1,0,0,-3\n";
const TANGENT: [(&str, &[&str], &str); 5] = [
    (
        "from a plane onto the sheet",
        &["1,.5", "1,.2", "1"],
        "FROM/-4,3,5\nGO/ON,DL,TO,PL,ON,PM\nINDIRV/1,0,0\nTLON,GOFWD/DL,PSTAN,S\nPSIS/S\nGOFWD/DL,ON,PX",
    ),
    (
        "from the sheet onto a plane",
        &["1,.5", "1,.2"],
        "FROM/3,3,5\nPSIS/S\nGO/ON,DL,TO,S,ON,PX\nINDIRV/-1,0,0\nTLON,GOFWD/DL,PSTAN,PL\nPSIS/PL\nGOFWD/DL,ON,PM",
    ),
    (
        "from a plane onto the wall, which leads away",
        &["1,.5", "1,.2", "1"],
        "FROM/-4,-3,1\nPSIS/PL\nGO/TO,DW,TO,PL,ON,PM\nINDIRV/1,0,0\nTLRGT,GOFWD/DW,TANTO,W\nGOFWD/W,ON,PX",
    ),
    (
        "from a plane onto the wall, which comes nearer",
        &["1,.5", "1,.2", "1"],
        "FROM/-4,3,1\nPSIS/PL\nGO/TO,DW,TO,PL,ON,PM\nINDIRV/1,0,0\nTLLFT,GOFWD/DW,TANTO,W\nGOFWD/W,ON,PX",
    ),
    (
        "from the wall onto a plane",
        &["1,.5", "1,.2", "1"],
        "FROM/3,-2,1\nPSIS/PL\nGO/TO,W,TO,PL,ON,PX\nINDIRV/-1,0,0\nTLLFT,GOFWD/W,TANTO,DW\nGOFWD/DW,ON,PM",
    ),
];

/// PSTAN and TANTO, also where both surfaces are one along a way; with cutters that leave the one before it ends.
#[test]
fn a_tool_goes_over_from_a_surface_onto_one_that_is_tangent_to_it() {
    for (name, cutters, motions) in TANGENT {
        for cutter in cutters {
            let text = format!("CUTTER/{cutter}\n{FILLETS}{motions}\nFINI\n");
            assert_eq!(proven(&format!("{cutter}, {name}"), &text), 3, "{cutter}, {name}");
        }
    }
}

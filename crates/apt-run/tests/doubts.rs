//! What the arithmetic element carries out and yet doubts: a direction that nobody gave, undercuts deeper than the
//! cutter's radius, and a tool that turns unseen.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::sync::Arc;

use apt_run::{
    document::{Document, Level},
    settings::Settings,
};

/// The codes of what is found, with the numbers of the statements.
fn codes(text: &str) -> Vec<(&'static str, u32)> {
    let document = Document::new(text, Some("sample.apt".to_owned()), &Arc::new(Settings::default()));
    let found = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    found.iter().map(|one| (one.wording.code, one.origin.isn)).collect()
}

/// FROM leaves the forward direction undefined (language reference 6.2): APT III takes the origin for the previous
/// position, which means nothing unless the programmer wants it so.
#[test]
fn a_direction_that_comes_from_the_origin_is_told() {
    let after = |placing: &str, motion: &str| {
        codes(&format!(
            "CUTTER/.5\nL1=LINE/0,0,10,0\nL2=LINE/10,-5,10,5\n{placing}\n{motion}/L1,TO,L2\nFINI\n"
        ))
    };
    let told = [("APT0668", 5)];
    for motion in ["TLLFT,GOFWD", "TLRGT,GOBACK"] {
        assert_eq!(after("FROM/5,.25,0", motion).first(), Some(&told[0]), "{motion}");
    }
    // Behind a move along the tool axis it is the same one, and programs are written for it.
    assert_eq!(after("FROM/5,.25,3\nGODLTA/-3", "TLLFT,GOFWD"), []);
    for placing in [
        "FROM/5,.25,0\nINDIRV/1,0,0",
        "FROM/5,.25,0\nINDIRP/6,.25,0",
        "FROM/5,4,0\nGOTO/4,4,0\nGOTO/5,.25,0",
        "FROM/5,4,0\nGOTO/4,.25,0\nGODLTA/1,0,0",
        "FROM/5,.25,3\nGODLTA/.6,0,-3",
    ] {
        assert_eq!(after(placing, "TLLFT,GOFWD"), [], "{placing}");
    }
    let two = "TLLFT,GOFWD/L1,ON,L2\nGORGT/L2,TO,L1";
    assert_eq!(
        codes(&format!(
            "CUTTER/.5\nL1=LINE/0,0,10,0\nL2=LINE/10,-5,10,5\nFROM/5,.25,0\nINDIRV/1,0,0\n{two}\nFINI\n"
        ))
        .iter()
        .filter(|(code, _)| *code == "APT0668")
        .count(),
        0
    );
}

/// An undercut is no deeper than the cutter's radius (language reference 6.8). Of part and drive surface the path is
/// defined beyond that, too; it is told once for each THICK and cutter.
#[test]
fn an_undercut_of_part_or_drive_surface_deeper_than_the_radius_is_told_once() {
    let with = |thick: &str, modes: &str| {
        codes(&format!(
            "CUTTER/.5,.25\nL1=LINE/XAXIS\nL2=LINE/5,0,5,9\nL3=LINE/0,4,9,4\nPL1=PLANE/0,0,1,0\nTHICK/{thick}\n\
             FROM/0,-2,3\nGO/TO,L1,TO,PL1\n{modes}GORGT/L1,ON,L2\nTLON,GOLFT/L2,ON,L3\nFINI\n"
        ))
    };
    assert_eq!(with("-.3,0,0", "TLRGT,TLOFPS,"), [("APT0669", 9)]);
    assert_eq!(with("0,-.3,0", "TLRGT,TLOFPS,").iter().filter(|one| one.0 == "APT0669").count(), 1);
    assert_eq!(with("-.25,-.25,0", "TLRGT,TLOFPS,"), []);
    let ignored: Vec<_> =
        with("-.3,0,0", "TLRGT,TLONPS,").into_iter().filter(|one| one.0 == "APT0669").collect();
    assert_eq!(ignored, [], "ON does not count stock");
}

/// What is round cannot go deeper than its radius; a flat bottom can, where it touches: on a part surface that lies across the
/// tool axis. Where the part surface leans, the edge touches, and beside the drive surface the side does.
#[test]
fn a_flat_bottom_undercuts_a_part_surface_across_the_axis_as_deep_as_told() {
    let told = |cutter: &str, part: &str, axis: &str, thick: &str| {
        let text = format!(
            "CUTTER/{cutter}\nL1=LINE/XAXIS\nL2=LINE/5,0,5,9\nPS={part}\n{axis}\nTHICK/{thick}\n\
             FROM/0,-.25,-.3\nINDIRV/1,0,0\nPSIS/PS\nTLRGT,TLOFPS,GOFWD/L1,ON,L2\nFINI\n"
        );
        codes(&text).into_iter().filter(|(code, _)| *code == "APT0669").collect::<Vec<_>>()
    };
    let (level, leaning, up) = ("PLANE/0,0,1,0", "PLANE/0,.6,.8,0", "TLAXIS/0,0,1");
    let doubted = [("APT0669", 10)];
    for flat in [".5", ".5,.1", ".5,.2"] {
        assert_eq!(told(flat, level, up, "-.3,0"), [], "{flat}");
        assert_eq!(told(flat, leaning, up, "-.3,0"), doubted, "{flat} on a plane that leans");
        assert_eq!(told(flat, level, up, "0,-.3"), doubted, "{flat} beside the drive surface");
        assert_eq!(
            told(flat, "CYLNDR/0,-.25,-2,1,0,0,2", up, "-.3,0"),
            [],
            "{flat} along the highest ruling"
        );
        assert_eq!(
            told(flat, "CYLNDR/0,0,-2,1,0,0,2", up, "-.3,0"),
            doubted,
            "{flat} beside the highest ruling"
        );
    }
    for round in [".5,.25", ".5,0,0,0,10,0,1"] {
        assert_eq!(told(round, level, up, "-.3,0"), doubted, "{round}");
        assert_eq!(told(round, level, up, "-.2,0"), [], "{round}");
    }
}

/// Without MULTAX positions have no axis (language reference 6.9), whatever the tool does.
#[test]
fn a_tool_that_turns_without_multax_is_told_once_for_each_law() {
    let turning = |before: &str, laws: &[&str]| {
        let mut text = format!("CUTTER/.5\nSP=SPHERE/0,0,0,5\nPL=PLANE/0,1,0,0\n{before}\n");
        for law in laws {
            text += &format!(
                "FROM/0,0,7\nTLAXIS/{law}\nGO/ON,PL,TO,SP,ON,(PLANE/1,0,0,0)\nINDIRV/1,0,0\n\
                 TLON,GOFWD/PL,ON,(PLANE/1,0,0,1)\nGOFWD/PL,ON,(PLANE/1,0,0,2)\n"
            );
        }
        let told = codes(&(text + "FINI\n")).into_iter().filter(|(code, _)| *code == "APT0728");
        told.map(|(_, isn)| isn).collect::<Vec<_>>()
    };
    assert_eq!(turning("", &["NORMPS"]), [9]);
    assert_eq!(turning("", &["NORMPS", "ATANGL,1,5"]), [9, 15]);
    assert_eq!(turning("MULTAX/OFF", &["NORMPS"]), [9]);
    for (before, law) in
        [("", "0,0,1"), ("", "0,.1,1"), ("MULTAX", "NORMPS"), ("MULTAX/ON", "NORMPS"), ("DNTCUT", "NORMPS")]
    {
        assert!(turning(before, &[law]).is_empty(), "{before} {law}");
    }
}

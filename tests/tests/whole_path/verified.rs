//! Every motion of every good program is proven to lie within its tolerances.

use apt_tests::runs::{analysis, examples, oracle_programs, path_of, read, report, title};
use serde_json::Value;

/// Rounding of a clearance, program units.
const ROUNDING: f64 = 1e-9;

/// What is wrong with the extremes of one role.
fn outside(motion: &Value, role: &str) -> Option<String> {
    let extent = motion[role].as_object()?;
    let number = |key: &str| extent[key].as_f64().unwrap();
    let within = -number("intol") - ROUNDING <= number("min") && number("max") <= number("outtol") + ROUNDING;
    (!within).then(|| format!("{} {role}: {extent:?}", motion["isn"]))
}

#[test]
fn all_motions_are_verified_inside_their_band() {
    let mut wrong = Vec::new();
    let (mut motions, mut vectors) = (0, 0);
    let oracle = oracle_programs().into_iter().filter(|(dialect, _)| *dialect != "apt3");
    let examples = examples().into_iter().map(|path| ("free", path));
    for (dialect, path) in oracle.chain(examples) {
        let report = report(&analysis(&read(&path), dialect)).unwrap();
        for motion in report["motions"].as_array().unwrap() {
            motions += 1;
            vectors += motion["cut_vectors"].as_u64().unwrap();
            let mut told: Vec<String> =
                ["part", "drive", "check"].iter().filter_map(|role| outside(motion, role)).collect();
            if motion["verified"] != true {
                told.push(format!("{} is not verified", motion["isn"]));
            }
            wrong.extend(told.into_iter().map(|what| format!("{} at {what}", title(&path))));
        }
    }
    println!("{motions} motions with {vectors} cut vectors");
    assert!(motions > 200, "{motions} motions");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_cut_vector_on_a_curve_is_longer_than_maxdp() {
    let circle = "CUTTER/50\nINTOL/.1\nOUTTOL/.2\nC1=CIRCLE/0,0,200\nFROM/500,0,0\nGO/TO,C1\nTLLFT,GOLFT/C1,ON,(LINE/YAXIS)\n";
    let sphere = "CUTTER/50,25\nINTOL/.1\nOUTTOL/.2\nS=SPHERE/0,0,-200,200\nD=PLANE/0,1,0,0\nFROM/-300,0,100\n\
                  GO/ON,D,TO,S,ON,(PLANE/1,0,0,-100)\nINDIRV/1,0,0\nTLON,GOFWD/D,ON,(PLANE/1,0,0,100)\n";
    for program in [circle, sphere] {
        for (longest, statement) in [(10.0, ""), (7.0, "MAXDP/7\n"), (3.0, "MAXDP/3\n"), (40.0, "MAXDP/40\n")]
        {
            let report = report(&analysis(&format!("{statement}{program}FINI\n"), "free")).unwrap();
            assert_eq!(report["ok"], true, "{statement}{program}{}", report["diagnostics"]);
            let isn = report["motions"].as_array().unwrap().last().unwrap()["isn"].as_u64().unwrap();
            let path = path_of(&report);
            let first = path.iter().position(|location| location.isn == isn).unwrap();
            for pair in path[first - 1..].windows(2) {
                let squares = (0..3).map(|axis| (pair[0].at[axis] - pair[1].at[axis]).powi(2));
                let length = squares.sum::<f64>().sqrt();
                assert!(length <= longest + ROUNDING, "{length} with {statement}{program}");
            }
        }
    }
}

#[test]
fn a_ruled_surface_is_what_its_directions_find_whatever_its_points() {
    let program = |ends: [&str; 4]| {
        let [a, b, c, d] = ends;
        format!(
            "CUTTER/.5,.25\nINTOL/.001\nOUTTOL/.001\nA=PLANE/0,0,1,0\nB=CYLNDR/3,0,-4,0,1,0,6\nV=VECTOR/0,0,1\n\
             R=RLDSRF/A,(0,0,{a}),(6,0,{b}),V,B,(0,4,{c}),(6,4,{d}),V\n\
             S=PLANE/0,1,0,2\nFROM/1,2,4\nGO/ON,S,TO,R,ON,(PLANE/1,0,0,1)\nTLON,GORGT/S,ON,(PLANE/1,0,0,5)\nFINI\n"
        )
    };
    let end = (36.0_f64 - 9.0).sqrt() - 4.0;
    let end = end.to_string();
    let on = report(&analysis(&program(["0", "0", &end, &end]), "free")).unwrap();
    let off = report(&analysis(&program(["-.5", "1.5", "1", ".25"]), "free")).unwrap();
    for (report, warnings) in [(&on, 0), (&off, 2)] {
        assert_eq!(report["ok"], true, "{}", report["diagnostics"]);
        let told = report["diagnostics"].as_array().unwrap().iter().filter(|told| told["code"] == "APT0316");
        assert_eq!(told.count(), warnings, "{}", report["diagnostics"]);
        assert!(report["motions"].as_array().unwrap().iter().all(|motion| motion["verified"] == true));
    }
    let (on, off) = (path_of(&on), path_of(&off));
    assert_eq!(on.len(), off.len());
    for (one, other) in on.iter().zip(&off) {
        assert!(
            (0..3).all(|axis| (one.at[axis] - other.at[axis]).abs() < 1e-6),
            "{:?} {:?}",
            one.at,
            other.at
        );
    }
}

#[test]
fn a_contour_along_a_conic_through_rounded_points_of_a_parabola_is_proven() {
    let program = |side: &str, start: &str, lean: &str| {
        format!(
            "CUTTER/10\nINTOL/.001\nOUTTOL/.001\n{lean}\
             C1=LCONIC/5PT,(-30,27.272727273),(-13,5.121212121),(2,.121212121),(21,13.363636364),(35,37.121212121)\n\
             FROM/{start},10\nINDIRV/1,0,0\nGO/TO,(LINE/-25,0,-25,50),TO,(PLANE/0,0,1,0),TO,C1\n\
             INDIRV/1,0,0\n{side},GOFWD/C1,PAST,(LINE/30,0,30,50)\nFINI\n"
        )
    };
    for (side, start) in [("TLRGT", "-40,0"), ("TLLFT", "-28,60")] {
        for lean in ["", "TLAXIS/.1,.2,1\n"] {
            let report = report(&analysis(&program(side, start, lean), "free")).unwrap();
            assert_eq!(report["ok"], true, "{side} {lean}{}", report["diagnostics"]);
            let motion = report["motions"].as_array().unwrap().last().unwrap();
            assert_eq!(motion["verified"], true, "{motion}");
            let end = path_of(&report).last().unwrap().at;
            assert!(end[0] > 30.0, "{end:?}");
        }
    }
}

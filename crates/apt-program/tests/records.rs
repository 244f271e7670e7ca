//! What statements leave behind: the records for Sections 2 to 4.

mod support;

use apt_geometry::motion::{Delta, Direction, DriveSide, MotionCommand, Relation, ToolAxis};
use apt_program::{Program, RecordKind, Severity, record::PostArgument};
use apt_syntax::DialectName;
use support::{problems, run_whole};

fn run(text: &str) -> Program {
    let program = run_whole(&format!("{text}\nFINI\n"), DialectName::Free);
    let serious: Vec<_> =
        program.findings().filter(|finding| finding.severity >= Severity::Warning).collect();
    assert!(serious.is_empty(), "{text}\n{serious:?}");
    program
}

/// The records in short: `isn:what`.
fn short(program: &Program) -> Vec<String> {
    program.records().map(|record| format!("{}:{}", record.origin.isn, kind(&record.kind))).collect()
}

fn kind(kind: &RecordKind) -> String {
    match kind {
        RecordKind::Motion(command) => motion(command),
        RecordKind::Postprocessor { word, arguments, .. } => {
            let arguments: Vec<String> = arguments.iter().map(argument).collect();
            format!("{word}/{}", arguments.join(","))
        }
        RecordKind::Text { word, text, .. } => format!("{word}{text}"),
        RecordKind::Transfer(label) => format!("TRANTO/{label}"),
        RecordKind::End => "FINI".into(),
        other => format!("{other:?}"),
    }
}

fn argument(argument: &PostArgument) -> String {
    match argument {
        PostArgument::Number(value) => value.to_string(),
        PostArgument::Word(word, code) => format!("{word}={code}"),
        PostArgument::Text(text) => text.to_string(),
        PostArgument::Geometry(geometry) => geometry.kind().word().into(),
    }
}

fn motion(command: &MotionCommand) -> String {
    match command {
        MotionCommand::From { position: p, axis, name } => {
            format!("FROM {name} {},{},{} {}", p.x, p.y, p.z, axis.is_some())
        }
        MotionCommand::GoTo { position: p, axis, name } => {
            format!("GOTO {name} {},{},{} {}", p.x, p.y, p.z, axis.is_some())
        }
        MotionCommand::GoDelta { delta: Delta::Vector(v, None), name } => {
            format!("GODLTA {name} {},{},{}", v.x, v.y, v.z)
        }
        MotionCommand::Drive { turn, drive, checks } => {
            let checks: Vec<String> = checks
                .iter()
                .map(|c| {
                    format!(
                        "{:?} {} {} {}",
                        c.relation,
                        c.occurrence,
                        c.surface.name,
                        c.label.as_deref().unwrap_or("-")
                    )
                })
                .collect();
            format!("{turn:?} {} [{}]", drive.name, checks.join("; "))
        }
        MotionCommand::Start(surfaces) => {
            let surfaces: Vec<String> =
                surfaces.iter().map(|s| format!("{:?} {}", s.relation, s.surface.name)).collect();
            format!("GO {}", surfaces.join("; "))
        }
        other => format!("{other:?}"),
    }
}

fn assert_records(text: &str, expected: &[&str]) {
    let mut found = short(&run(text));
    assert_eq!(found.pop().as_deref().map(|last| last.ends_with(":FINI")), Some(true));
    assert_eq!(found, expected, "{text}");
}

#[test]
fn positions_are_read_by_counting() {
    assert_records("FROM/1,2", &["1:FROM  1,2,0 false"]);
    assert_records("ZSURF/0,0,1,4\nGOTO/1,2", &["2:GOTO  1,2,4 false"]);
    assert_records("P=POINT/1,2,3\nGOTO/P,20", &["2:FEDRAT/20", "2:GOTO P 1,2,3 false"]);
    assert_records("GOTO/1,2,3,20", &["1:FEDRAT/20", "1:GOTO  1,2,3 false"]);
    assert_records("GOTO/1,2,3,0,0,1", &["1:GOTO  1,2,3 true"]);
    assert_records("V=VECTOR/0,0,1\nGOTO/(POINT/1,2,3),V,9", &["2:FEDRAT/9", "2:GOTO  1,2,3 true"]);
    assert_records("GOTO/(1,2)", &["1:GOTO  1,2,0 false"]);
    let delta = run("GODLTA/-.5,7");
    let kinds: Vec<_> = delta.records().map(|record| record.kind.clone()).collect();
    let along = MotionCommand::GoDelta { delta: Delta::AlongAxis(-0.5), name: String::new() };
    assert_eq!(kinds[1], RecordKind::Motion(Box::new(along)));
    assert_records("V=VECTOR/0,0,2\nGODLTA/V", &["2:GODLTA V 0,0,2"]);
    assert_records("V=VECTOR/0,0,2\nGODLTA/V,9", &["2:FEDRAT/9", "2:GODLTA V 0,0,2"]);
    assert_records("GODLTA/(VECTOR/0,0,2)", &["1:GODLTA  0,0,2"]);
    assert_records("GODLTA/0,0,2", &["1:GODLTA  0,0,2"]);
}

#[test]
fn patterns_visit_their_points() {
    let head = "P=PATERN/LINEAR,(0,0),(4,0),5\n";
    let xs = |text: &str| -> Vec<String> {
        short(&run(&format!("{head}{text}"))).into_iter().filter(|line| !line.ends_with("FINI")).collect()
    };
    assert_eq!(xs("GOTO/P,OMIT,2,THRU,4"), ["2:GOTO P 0,0,0 false", "2:GOTO P 4,0,0 false"]);
    assert_eq!(xs("GOTO/P,INVERS,RETAIN,1,3"), ["2:GOTO P 4,0,0 false", "2:GOTO P 2,0,0 false"]);
    assert_eq!(xs("GOTO/P,INVERS,CONST,RETAIN,5,3"), ["2:GOTO P 4,0,0 false", "2:GOTO P 2,0,0 false"]);
    assert_eq!(
        xs("GOTO/P,RETAIN,1,2,AVOID,9,1"),
        [
            "2:GOTO P 0,0,0 false",
            "2:CYCLE/NOMORE=53",
            "2:GOTO P 0,0,9 false",
            "2:GOTO P 1,0,9 false",
            "2:CYCLE/ON=71",
            "2:GOTO P 1,0,0 false"
        ]
    );
}

#[test]
fn zigzag_undoes_the_serpentine() {
    let text = "A=PATERN/LINEAR,(0,0),(2,0),3\nB=PATERN/PARLEL,A,(VECTOR/0,1,0),2\nGOTO/B,ZIGZAG";
    let found = short(&run(text));
    let expected: Vec<String> = ["0,0", "1,0", "2,0", "0,1", "1,1", "2,1"]
        .iter()
        .map(|xy| format!("3:GOTO B {xy},0 false"))
        .chain(["4:FINI".to_owned()])
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn implied_check_surfaces_come_from_the_next_motion() {
    let head = "L1=LINE/XAXIS\nL2=LINE/YAXIS\n";
    assert_records(
        &format!("{head}TLLFT,GOLFT/L1\nCOOLNT/ON\nGORGT/L2,ON,L1"),
        &["3:DriveSide(Left)", "3:Left L1 [Past 1 L2 -]", "4:COOLNT/ON=71", "5:Right L2 [On 1 L1 -]"],
    );
    assert_records(
        &format!("{head}TLON,GOLFT/L1\nTLLFT,GOFWD/L2,TO,L1"),
        &[
            "3:DriveSide(On)",
            "3:Left L1 [TangentToDrive 1 L2 -]",
            "4:DriveSide(Left)",
            "4:Forward L2 [To 1 L1 -]",
        ],
    );
}

#[test]
fn directed_motions_take_checks_labels_and_feeds() {
    let head = "L1=LINE/XAXIS\nL2=LINE/YAXIS\nC1=CIRCLE/0,0,2\n";
    assert_records(&format!("{head}GOLFT/L1,ON,2,INTOF,C1,15"), &["4:FEDRAT/15", "4:Left L1 [On 2 C1 -]"]);
    assert_records(
        &format!("{head}GOLFT/L1,TO,C1,A1,PAST,L2,07\nA1)GOTO/1,1,1\n7)GOTO/2,2,2"),
        &["4:Left L1 [To 1 C1 A1; Past 1 L2 7]", "5:GOTO  1,1,1 false", "6:GOTO  2,2,2 false"],
    );
    assert_records(&format!("{head}GO/TO,L1,L2,PAST,C1,5"), &["4:FEDRAT/5", "4:GO To L1; To L2; Past C1"]);
}

#[test]
fn tolerances_repeat_and_toler_is_two_records() {
    let program = run("INTOL/.1,.2\nTOLER/.01\nTHICK/1,2,3");
    let commands: Vec<String> = short(&program);
    assert!(commands[0].contains("part: 0.1, drive: 0.2, check: [0.2, 0.2]"), "{commands:?}");
    assert!(commands[1].starts_with("2:OutsideTolerance") && commands[2].starts_with("2:InsideTolerance"));
    assert!(commands[3].contains("part: 1.0, drive: 2.0, check: [3.0, 3.0]"), "{commands:?}");
}

#[test]
fn directions_have_roles_and_axes_are_unit() {
    let program = run("V=VECTOR/0,3,4\nINDIRV/,,V\nTLAXIS/V\nTLAXIS/ATANGL,1,-15,CUTANG,90");
    let kinds: Vec<MotionCommand> = program
        .records()
        .filter_map(|record| match &record.kind {
            RecordKind::Motion(command) => Some((**command).clone()),
            _ => None,
        })
        .collect();
    let MotionCommand::Direction([None, None, Some(Direction::Vector(vector))]) = &kinds[0] else {
        panic!("{kinds:?}")
    };
    assert_eq!(vector.y, 3.0);
    let MotionCommand::ToolAxis(ToolAxis::Fixed(axis)) = &kinds[1] else { panic!("{kinds:?}") };
    assert!((axis.z - 0.8).abs() < 1e-15);
    assert!(matches!(kinds[2], MotionCommand::ToolAxis(ToolAxis::AtAngle { part: true, .. })));
}

#[test]
fn macros_replace_tokens() {
    let text = "M=MACRO/T,V,R,N=1\nQ=T/R,N\nV/Q\nR=R+N\nTERMAC\nZ=4\nCALL/M,T=POINT,V=GOTO,R=Z,N=-2";
    let program = run(text);
    assert_eq!(short(&program)[0], "3:GOTO Q 4,-2,0 false");
    let z = program.symbols().into_iter().find(|(name, _)| name == "Z").map(|(_, value)| value);
    assert_eq!(z, Some(apt_program::Value::Scalar(2.0)));
    let first = program.records().next().expect("a record");
    assert_eq!(first.origin.frame.as_ref().map(|frame| (frame.name.as_str(), frame.isn)), Some(("M", 7)));
}

#[test]
fn reference_systems_carry_what_is_used_under_another() {
    let text = "M=MATRIX/TRANSL,5,5,0\nREFSYS/M\nP=POINT/1,2,3\nGOTO/P\nREFSYS/NOMORE\nGOTO/P";
    let found = short(&run(text));
    assert_eq!(found[..2], ["4:GOTO P 1,2,3 false", "6:GOTO P 6,7,3 false"]);
}

#[test]
fn free_jumps_and_do_loops_of_apt4() {
    let text = "S=0\n10)S=S+1\nIF(S-3)10,20,20\n20)IF(S.EQ.3)GOTO/S,0,0\nFINI\n";
    let program = run_whole(text, DialectName::Apt4);
    let errors: Vec<_> = program.findings().filter(|finding| finding.severity == Severity::Error).collect();
    assert!(errors.is_empty(), "{errors:?}");
    assert_eq!(short(&program), ["4:GOTO  3,0,0 false", "5:FINI"]);
}

#[test]
fn drive_side_is_remembered_when_the_motion_is_held() {
    let program = run("L1=LINE/XAXIS\nL2=LINE/YAXIS\nTLRGT\nGOFWD/L1\nGOLFT/L2,TO,L1");
    let found = short(&program);
    assert_eq!(found[0], format!("3:DriveSide({:?})", DriveSide::Right));
    assert_eq!(found[1], format!("4:Forward L1 [{:?} 1 L2 -]", Relation::Past));
}

#[test]
fn words_of_later_systems_stand_in_their_statements_unless_they_are_names() {
    assert_eq!(short(&run("CYCLE/DRILL,DEPTH,2,CLEAR,.1"))[0], "1:CYCLE/DRILL=163,DEPTH=0,2,CLEAR=0,0.1");
    assert_eq!(short(&run("DEPTH=7\nCYCLE/DRILL,DEPTH,2"))[0], "2:CYCLE/DRILL=163,7,2");
    for (text, dialect) in
        [("SPINDL/DEPTH\nFINI\n", DialectName::Free), ("CYCLE/DRILL,DEPTH,2\nFINI\n", DialectName::Apt3)]
    {
        let program = run_whole(text, dialect);
        let numbers: Vec<_> = program.findings().map(|finding| finding.number).collect();
        assert_eq!(numbers, [Some(101)], "{text}");
    }
}

#[test]
fn arcs_and_curves_of_cutter_location_files_pass_through_with_their_forms_checked() {
    let told = |statement: &str| {
        let program = run_whole(&format!("FROM/0,0,0\n{statement}\nFINI\n"), DialectName::Cl);
        let passed = program.records().any(|record| {
            matches!(&record.kind, RecordKind::Postprocessor { word, .. } if statement.starts_with(word.as_str()))
        });
        (passed, problems(&program).len())
    };
    for good in [
        "ARCDAT/0,0,0,0,0,1,10",
        "ARCMOV/CLW,1,2,3",
        "ARCMOV/CCLW,1,2,3,90",
        "MOVNRB/ON,3,4,1,0,1",
        "MOVNRB/1,0,0,1,1",
        "MOVNRB/NEXT",
        "MOVNRB/OFF",
    ] {
        assert_eq!(told(good), (true, 0), "{good}");
    }
    for wrong in [
        "ARCDAT/0,0,0,0,0,1",
        "ARCDAT/CLW,0,0,0,0,0,1,1",
        "ARCMOV/1,2,3",
        "ARCMOV/CLW,1,2",
        "ARCMOV/LEFT,1,2,3",
        "MOVNRB/4,1",
        "MOVNRB/LEFT",
    ] {
        assert_eq!(told(wrong), (false, 1), "{wrong}");
    }
}

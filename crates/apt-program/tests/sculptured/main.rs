//! Space curves, sculptured surfaces and the statements of regional milling: forms, numbers, conditions and records.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may stop at once")]

mod any_statement;

use apt_geometry::{
    Vec3,
    canonical::Geometry,
    regional::{
        AxisCondition, AxisReference, FeedDirection, Guide, GuideContact, LiftDirection, PartRelation,
        Projection, RegionalCommand, RegionalMilling, Retract, Sense, StepoverRule,
    },
};
use apt_program::{
    Finding, FindingKind, Options, Program, RecordKind, SculpturedFinding, Severity, Value, evaluate,
    finding::ConditionBlock,
};
use apt_syntax::{Dialect, DialectName, SyntaxTree};

/// A curved surface, curves and directions to work with.
const BASE: &str = "\
A1=POINT/0,0,0
A2=POINT/1,0,.2
A3=POINT/2,0,0
B1=POINT/0,2,.1
B2=POINT/1,2,.4
B3=POINT/2,2,.1
D1=POINT/0,4,0
D2=POINT/1,4,.2
D3=POINT/2,4,0
VZ=VECTOR/0,0,1
VM=VECTOR/0,0,-1
VX=VECTOR/1,0,0
VY=VECTOR/0,1,0
VN=VECTOR/0,0,0
PLT=PLANE/0,0,1,3
L1=LINE/0,0,4,0
M1=MATRIX/TRANSL,0,0,1
K1=SCURV/SPLINE,A1,A2,A3
K2=SCURV/SPLINE,B1,B2,B3
K3=SCURV/SPLINE,A1,B1,D1
KF=SCURV/SPLINE,A1,A2,A3,FLOW,PARAM,0,2,SEG,PARAM,0,2
KG=SCURV/SPLINE,B1,B2,B3,FLOW,PARAM,0,2,SEG,PARAM,0,2
SS=SSURF/SMESH,XYZ,SPLINE,A1,A2,A3,SPLINE,B1,B2,B3,SPLINE,D1,D2,D3
";

/// All conditions that a SMIL can need.
const CONDITIONS: &str = "\
SCON/DS,SS,PARAM,.2,1.8,.2,1.8,ON,VM
SCON/PS,TO,SS,PLUS,0
SCON/AXIS,VZ,PLUS
SCON/FEED,1,2,3,4
SCON/FEED,PLT
SCON/STEPOV,.02,1,.5,0
";

fn run(text: &str) -> Program {
    let tree = SyntaxTree::parse(&format!("{BASE}{text}\nFINI\n"), Dialect::named(DialectName::Apt4));
    evaluate(&tree, &Options::default(), &|| false)
}

/// Warnings and errors behind the base: statement, counted from its end, and number.
fn problems(program: &Program) -> Vec<(u32, Option<u16>)> {
    let base = BASE.lines().count() as u32;
    let serious = program.findings().filter(|finding| finding.severity >= Severity::Warning);
    serious.map(|finding: &Finding| (finding.origin.isn - base, finding.number)).collect()
}

fn regional(program: &Program) -> Vec<RegionalMilling> {
    let kinds = program.records().map(|record| record.kind.clone());
    kinds
        .filter_map(|kind| match kind {
            RecordKind::Regional(milling) => Some(*milling),
            _ => None,
        })
        .collect()
}

fn value(program: &Program, name: &str) -> Value {
    let symbols = program.symbols();
    let found = symbols.iter().find(|(known, _)| known == name);
    found.unwrap_or_else(|| panic!("{name} has no value")).1.clone()
}

fn geometry(program: &Program, name: &str) -> Geometry {
    match value(program, name) {
        Value::Geometry(geometry) => (*geometry).clone(),
        Value::Scalar(number) => panic!("{name} is {number}"),
    }
}

fn point(program: &Program, name: &str) -> Vec3 {
    match geometry(program, name) {
        Geometry::Point(at) | Geometry::Vector(at) => at,
        other => panic!("{name} is {other:?}"),
    }
}

fn scalar(program: &Program, name: &str) -> f64 {
    match value(program, name) {
        Value::Scalar(number) => number,
        Value::Geometry(geometry) => panic!("{name} is {geometry:?}"),
    }
}

#[test]
fn the_base_is_good() {
    assert_eq!(problems(&run("")), []);
    assert_eq!(problems(&run(CONDITIONS)), []);
}

/// Statements without mistake.
const GOOD: &[&str] = &[
    // SCURV.
    "C=SCURV/CURSEG,A1,A2",
    "C=SCURV/CURSEG,A1,TANSPL,VZ,A3",
    "C=SCURV/SPLINE,A1,TANSPL,VX,CRSSPL,VY,A2,A3,TANSPL,VX",
    "C=SCURV/SPLINE,A1,CRSSPL,VY,A2,A3",
    "C=SCURV/SPLINE,WEIGHT,.5,LIMIT,.1,A1,A2,WEIGHT,1,A3",
    "C=SCURV/COMBIN,K1",
    "C=SCURV/COMBIN,K1,TRFORM,M1",
    "C=SCURV/SEG,L1,(LINE/1,-1,1,1),POSX,(LINE/3,-1,3,1),POSX",
    "C=SCURV/SPLINE,A1,A2,A3,FLOW,ARC,0,2,.001,SEG,LENGTH,0,2",
    "C=SCURV/SPLINE,A1,A2,A3,FLOW,ARC,0,1,PARAM,1,2,SEG,LENGTH,0,1,PARAM,1,2",
    "C=SCURV/SPLINE,A1,A2,A3,FLOW,CHORD,0,2,VX,SEG,LENGTH,0,2",
    "C=SCURV/SPLINE,A1,A2,A3,FLOW,CHORD,0,2,A1,A3,SEG,LENGTH,0,2,TRFORM,M1",
    "C=SCURV/NURBS,DEGREE,3,KNOTS,0,0,0,0,1,1,1,1,PTS,A1,A2,B2,B3",
    "C=SCURV/NURBS,DEGREE,2,KNOTS,0,0,0,1,1,1,PTS,A1,A2,A3,WEIGHT,1,.7,1",
    "RESERV/Q,3\nQ(1)=A1\nQ(2)=A2\nQ(3)=A3\nC=SCURV/SPLINE,Q(1,THRU,3)",
    "C=SCURV/SPLINE,(0,0,0),(1,0,0),(POINT/2,1,0)",
    // SSURF.
    "S=SSURF/RULED,K1,AXIS,VY",
    "S=SSURF/RULED,K1,AXIS,A1,B1",
    "S=SSURF/REVOLV,K1,AXIS,A1,A3,CLW,0,90",
    "S=SSURF/REVOLV,K1,AXIS,A1,VX,CCLW,0,360",
    "S=SSURF/YZROT,K1,CROSS,K3",
    "S=SSURF/TRANSL,K1,CROSS,K3",
    "S=SSURF/GENCUR,KF,KG",
    "S=SSURF/SMESH,XYZ,SPLINE,A1,A2,A3,SPLINE,B1,B2,B3,TRFORM,M1",
    "S=SSURF/GMESH,XYZ,SPLINE,A1,A2,A3,SPLINE,B1,B2,B3",
    "S=SSURF/COMBIN,SS",
    "S=SSURF/COMBIN,SS,TRFORM,M1",
    "S=SSURF/FROM,(PLANE/0,0,1,2),0,1,0,1",
    "S=SSURF/REVOLV,(SCURV/SPLINE,A1,A2,A3),AXIS,A1,A3,CCLW,0,90",
    // Places.
    "Q=POINT/INTOF,SS,PARAM,.5,.5,1",
    "Q=POINT/INTOF,K1,PARAM,.5",
    "Q=POINT/INTOF,K1,PARAM,1.5,0",
    "Q=VECTOR/INTOF,K1,PARAM,.5,1,NORMAL,UNIT",
    "Q=VECTOR/INTOF,K1,PARAM,.25,TANSPL",
    "Q=POINT/INTOF,SS,(POINT/1,1,5),VM",
    "Q=POINT/INTOF,KF,FLOW,.5",
    "Q=POINT/INTOF,(PLANE/1,0,0,1),K1,A1",
    "Q=NUMF(SS,PATCH)",
    // Conditions.
    "SCON/INIT,DS",
    "SCON/INIT,AXIS",
    "SCON/INIT,DS,PS",
    "SCON/DS,SS,PARAM,0,1,0,1,ON,NORMAL",
    "SCON/DS,SS,PARAM,0,1,0,1,AT,(VECTOR/0,0,-1)",
    "SCON/DS,K1,PARAM,0,1,AT,CRSSPL",
    "SCON/DS,K1,PARAM,0,1,ON,VM",
    "SCON/PS,ON,SS,MINUS,.1",
    "SCON/PS,TO,SS,PLUS,-.1",
    "SCON/AXIS,VZ",
    "SCON/AXIS,VZ,MINUS",
    "SCON/AXIS,NORMDS",
    "SCON/AXIS,NORMDS,MINUS",
    "SCON/AXIS,ATANGL,DS,5,CUTANG,3",
    "SCON/AXIS,ATANGL,PS,-5,CUTANG,-3",
    "SCON/FEED,0,0,0,0",
    "SCON/FEED,(PLANE/0,0,1,9)",
    "SCON/STEPOV,0,-.3,0,0",
    // Checks.
    "CHKSRF/PS,ON",
    "CHKSRF/PS,OFF",
    "CHKSRF/SS,ON",
    "GOUGCK/ON",
    "GOUGCK/OFF",
    "AVCTRL/ON",
    "AVCTRL/OFF",
    "AVCTRL/AXIS,LIMIT,2",
    "AVCTRL/CUTANG,CONST,1,RANGE,0,20",
    "AVCTRL/CUTANG,CONST,1,RANGE,0,20,AXIS,LIMIT,1",
    "PRINT/AVPRT,ON",
    "PRINT/AVPRT,OFF",
];

#[test]
fn weight_and_limit_before_a_row_of_a_mesh_are_those_of_all_its_points() {
    let program = run("R=SSURF/SMESH,XYZ,SPLINE,WEIGHT,.3,LIMIT,.05,A1,A2,WEIGHT,.9,A3,SPLINE,B1,B2,B3\n\
         S=SSURF/SMESH,XYZ,SPLINE,A1,WEIGHT,.3,LIMIT,.05,A2,WEIGHT,.9,LIMIT,.05,$\n\
         A3,LIMIT,.05,WEIGHT,.3,SPLINE,B1,B2,B3\n\
         T=SSURF/SMESH,XYZ,SPLINE,A1,A2,A3,SPLINE,B1,B2,B3");
    assert_eq!(problems(&program), []);
    assert!(geometry(&program, "R") == geometry(&program, "S"));
    assert!(geometry(&program, "R") != geometry(&program, "T"));
}

#[test]
fn good_statements_have_no_finding() {
    let mut faults = String::new();
    for text in GOOD {
        let program = run(text);
        let found: Vec<_> = program.findings().filter(|one| one.severity >= Severity::Warning).collect();
        if !found.is_empty() {
            faults.push_str(&format!("\n{text}: {:?} {:?}", found[0].number, found[0].kind));
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

/// Statements with the number of their mistake.
const MISTAKES: &[(&str, u16)] = &[
    ("S=SSURF/RULED,K1,AXIS,A1,VY", 5007),
    ("S=SSURF/TRANSL,K1,K3", 1233),
    ("S=SSURF/GENCUR,K1,K2", 5029),
    ("S=SSURF/GENCUR,K1,K2,TRFORM,M1", 5029),
    ("S=SSURF/REVOLV,K1,AXIS,A1,A3,0,90", 1224),
    ("S=SSURF/SMESH,SPLINE,A1,A2,A3,SPLINE,B1,B2,B3", 1225),
    ("S=SSURF/SMESH,ZXPLAN,SPLINE,A1,A2,A3,SPLINE,B1,B2,B3", 5300),
    ("S=SSURF/FETCH,A1", 1007),
    ("S=SSURF/RULED,A1,AXIS,VY", 2001),
    ("S=SSURF/COMBIN,SS,TRFORM,VZ", 2001),
    ("S=SSURF/COMBIN,SS,5", 2021),
    ("S=SSURF/PATCH,POLYGN,PLUS,A1,A2,A3", 2001),
    ("C=SCURV/SPLINE,A1,A2,A3,FLOW,PARAM,0,2", 5515),
    ("C=SCURV/SPLINE,A1,A2,A3,SEG,PARAM,0,2", 1007),
    ("C=SCURV/SPLINE,A1,TANSPL,A2,A3", 2001),
    ("C=SCURV/COMBIN,A1", 2001),
    ("Q=POINT/INTOF,SS,PARAM,.5,.5", 2001),
    ("Q=VECTOR/INTOF,SS,PARAM,.5,.5,1", 2001),
    ("X=PARMF(UVAL)", 42),
    ("SCON/DS,SS,PARAM,0,1,0,1,ON,VM,.1", 2021),
    ("SCON/DS,SS,PARAM,1.8,.2,.2,1.8,ON,VM", 3523),
    ("SCON/DS,SS,PARAM,0,1,0,1,ON,VN", 3523),
    ("SCON/DS,A1,PARAM,0,1,ON,VM", 2001),
    ("SCON/PS,TO,SS,PLUS", 3521),
    ("SCON/PS,SS,TO,PLUS,.1", 2001),
    ("SCON/AXIS,NORMPS,PLUS", 2001),
    ("SCON/AXIS,VN", 3523),
    ("SCON/AXIS,ATANGL,DS,5,CUTANG,LEAD,3", 3521),
    ("SCON/AXIS,ATANGL,DS,95,CUTANG,3", 3523),
    ("SCON/AXIS,ATANGL,PS,5", 2001),
    ("SCON/FEED,1,2,3", 2001),
    ("SCON/FEED,-1,2,3,4", 3523),
    ("SCON/FEED,A1", 3522),
    ("SCON/STEPOV,.1,1,0", 2001),
    ("SCON/STEPOV,-.1,1,0,0", 3523),
    ("SCON/CLRPLN,PLT", 2001),
    ("SCON/INIT,FEED,XYZ", 3521),
    ("CHKSRF/ON", 2055),
    ("CHKSRF/OFF", 2055),
    ("CHKSRF/SS,S2,ON", 2055),
    ("CHKSRF/TO,ON", 2055),
    ("AVCTRL/LIMIT,1", 2021),
    ("AVCTRL/CUTANG,CONST,1,AXIS", 2001),
    ("AVCTRL/XYZ", 2001),
    ("PRINT/AVMSG,ON", 2031),
    ("SMIL/POSN,DS,PARAM,.2,.2", 2001),
    ("SMIL/LOOK,DS,PARAM,.2,.2", 2001),
    ("SMIL/PATH,DS,PARAM,.2,.2,TANSPL,PLUS", 3565),
    ("GOMILL/1,2", 1007),
    ("GCLEAR", 1007),
    ("INTSEC/SS", 1007),
];

#[test]
fn mistakes_have_the_numbers_of_the_public_system() {
    let mut faults = String::new();
    for (text, number) in MISTAKES {
        let program = run(text);
        let found: Vec<_> = problems(&program).into_iter().map(|(_, number)| number).collect();
        if found != [Some(*number)] {
            let kinds: Vec<_> = program.findings().map(|one| &one.kind).collect();
            faults.push_str(&format!("\n{text}: {found:?}, not {number}: {kinds:?}"));
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

#[test]
fn a_command_carries_all_that_its_conditions_say() {
    let program = run(&format!(
        "{CONDITIONS}SCON/PS,ON,SS,MINUS,.25\nSCON/AXIS,ATANGL,PS,10,CUTANG,-5\nCHKSRF/PS,ON\nGOUGCK/ON\n\
         AVCTRL/CUTANG,CONST,1,RANGE,-10,20,NORMPS,LIMIT,3\nPRINT/AVPRT,ON\n\
         SMIL/PICKFD,DS,PARAM,.2,.4,CRSSPL,MINUS,STEPOV,PLUS,1"
    ));
    let millings = regional(&program);
    let [milling] = millings.as_slice() else { panic!("{:?}", problems(&program)) };
    let RegionalCommand::Pickfeed { region, clearance } = milling.command else { panic!("{milling:?}") };
    assert_eq!(region.pass.start, [0.2, 0.4]);
    assert_eq!(region.pass.direction, FeedDirection::CrossSpline);
    assert_eq!(
        (region.pass.sense, region.stepover_sense, region.pass.skip),
        (Sense::Minus, Sense::Plus, true)
    );
    assert_eq!(
        (region.feed.cutting, region.feed.stepover, region.feed.plunge, region.feed.rapid),
        (1.0, 2.0, 3.0, 4.0)
    );
    assert_eq!(region.stepover.rule(), StepoverRule::Scallop { height: 0.02, limit: Some(1.0) });
    assert_eq!((region.stepover.lift, region.stepover.passes), (0.5, None));
    assert_eq!(clearance.distance, 3.0);
    assert_eq!((milling.part.relation, milling.part.side), (PartRelation::On, Sense::Minus));
    assert_eq!((milling.part.thickness, milling.part.surface.name.as_str()), (0.25, "SS"));
    assert_eq!(milling.guide.contact, GuideContact::On);
    assert_eq!(milling.guide.projection, Projection::Vector(Vec3::new(0.0, 0.0, -1.0)));
    let Guide::Surface { surface, u, v } = &milling.guide.guide else { panic!("{:?}", milling.guide) };
    assert_eq!((surface.name.as_str(), u.low, u.high, v.low, v.high), ("SS", 0.2, 1.8, 0.2, 1.8));
    let AxisCondition::AtAngle { reference, across, lead } = milling.axis else {
        panic!("{:?}", milling.axis)
    };
    assert_eq!(reference, AxisReference::Part);
    assert!((across.to_degrees() - 10.0).abs() < 1e-12 && (lead.to_degrees() + 5.0).abs() < 1e-12);
    assert!(milling.checked.part && milling.checked.named.is_empty());
    assert!(milling.check_chords && milling.list_avoidance && milling.avoidance.enabled);
    assert_eq!((milling.avoidance.lift, milling.avoidance.limit), (LiftDirection::PartNormal, Some(3.0)));
    let tilt = milling.avoidance.tilt.unwrap();
    assert!((tilt.constant.to_degrees() - 1.0).abs() < 1e-12);
    assert!(
        (tilt.least.to_degrees() + 10.0).abs() < 1e-12 && (tilt.greatest.to_degrees() - 20.0).abs() < 1e-12
    );
}

#[test]
fn conditions_hold_until_they_are_given_again() {
    let program = run(&format!(
        "{CONDITIONS}SMIL/PATH,DS,PARAM,.2,.2,TANSPL,PLUS\nSCON/AXIS,VZ,MINUS\nAVCTRL/ON\n\
         SMIL/POSN,DS,PARAM,.2,.2,INCR,1\nSMIL/POSN,DS,PARAM,.2,.2,INCR,VZ\nSMIL/POSN,DS,PARAM,.2,.2,INCR,PLT"
    ));
    let millings = regional(&program);
    assert_eq!(millings.len(), 4, "{:?}", problems(&program));
    assert_eq!(millings[0].axis, AxisCondition::Fixed(Vec3::new(0.0, 0.0, 1.0)));
    assert_eq!(millings[1].axis, AxisCondition::Fixed(Vec3::new(0.0, 0.0, -1.0)));
    assert!(!millings[0].avoidance.enabled && millings[1].avoidance.enabled);
    let retracts: Vec<_> = millings[1..]
        .iter()
        .map(|milling| match milling.command {
            RegionalCommand::Position { retract, .. } => retract,
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(retracts[0], Retract::Distance(1.0));
    assert_eq!(retracts[1], Retract::Vector(Vec3::new(0.0, 0.0, 1.0)));
    assert!(matches!(retracts[2], Retract::Plane(plane) if plane.distance == 3.0));
    // AVCTRL is on and nothing is checked: the three commands behind it say so.
    let warned = program
        .findings()
        .filter(|one| one.kind == FindingKind::Sculptured(SculpturedFinding::AvoidanceWithoutCheck))
        .count();
    assert_eq!(warned, 3);
}

/// What a command finds missing.
fn missing(program: &Program) -> (Vec<ConditionBlock>, Vec<ConditionBlock>, Vec<ConditionBlock>) {
    let found = program.findings().find_map(|finding| match &finding.kind {
        FindingKind::Sculptured(SculpturedFinding::ConditionMissing { missing, spoiled, valid, .. }) => {
            Some((missing.clone(), spoiled.clone(), valid.clone()))
        }
        _ => None,
    });
    found.unwrap_or_else(|| panic!("{:?}", problems(program)))
}

#[test]
fn a_block_is_valid_after_a_statement_without_mistake_only() {
    use ConditionBlock::{Axis, Clearance, Feed, Guide, Part, Stepover};
    let path = "SMIL/PATH,DS,PARAM,.2,.2,TANSPL,PLUS";
    let region = "SMIL/ZIGZAG,DS,PARAM,.2,.2,TANSPL,PLUS,STEPOV,PLUS";
    let program = run(&format!("SCON/PS,TO,SS,PLUS,0\n{path}"));
    assert_eq!(missing(&program), (vec![Guide, Axis], vec![], vec![Part]));
    let program = run(&format!("{CONDITIONS}SCON/AXIS,VN\n{path}"));
    assert_eq!(missing(&program), (vec![Axis], vec![Axis], vec![Guide, Part, Feed, Clearance, Stepover]));
    let program = run(&format!("{CONDITIONS}SCON/AXIS,UNKNWN\n{path}"));
    assert_eq!(missing(&program).1, [Axis], "an operand without value spoils the block");
    let program = run(&format!("{CONDITIONS}SCON/INIT,ALL\n{region}"));
    assert_eq!(missing(&program), (vec![Guide, Part, Axis, Feed, Stepover], vec![], vec![]));
    let program =
        run(&format!("{CONDITIONS}SCON/INIT,FEED\nSCON/FEED,1,2,3,4\nSMIL/PICKFD{}", &region[11..]));
    assert_eq!(missing(&program).0, [Clearance]);
    let gaps = program.records().filter(|record| record.kind == RecordKind::Gap).count();
    assert_eq!(gaps, 1, "a motion is missing here");
}

#[test]
fn a_pass_starts_inside_the_range_of_its_guide() {
    let smil = |u: &str, v: &str| format!("{CONDITIONS}SMIL/PATH,DS,PARAM,{u},{v},TANSPL,PLUS");
    for (u, v) in [(".1", ".2"), (".2", ".1"), ("1.9", ".2"), (".2", "1.81")] {
        let program = run(&smil(u, v));
        assert!(problems(&program).contains(&(7, Some(3563))), "{u},{v}: {:?}", problems(&program));
        assert!(regional(&program).is_empty());
    }
    for (u, v) in [(".2", ".2"), ("1.8", "1.8"), ("1", "1")] {
        assert_eq!(regional(&run(&smil(u, v))).len(), 1, "{u},{v}");
    }
    // Across a curve there is no range, and nothing to step to.
    let curve = format!("{CONDITIONS}SCON/DS,K1,PARAM,.2,1.8,ON,VM\nSMIL/");
    assert_eq!(regional(&run(&format!("{curve}PATH,DS,PARAM,.2,99,TANSPL,PLUS"))).len(), 1);
    let refused = run(&format!("{curve}ZIGZAG,DS,PARAM,.2,0,TANSPL,PLUS,STEPOV,PLUS"));
    assert!(problems(&refused).contains(&(8, Some(3567))), "{:?}", problems(&refused));
    let refused = run(&format!("{curve}PATH,DS,PARAM,.2,0,CRSSPL,PLUS"));
    assert!(problems(&refused).contains(&(8, Some(3561))), "{:?}", problems(&refused));
}

#[test]
fn checked_surfaces_are_switched_one_by_one() {
    let smil = "SMIL/PATH,DS,PARAM,.2,.2,TANSPL,PLUS";
    let program = run(&format!(
        "{CONDITIONS}S2=SSURF/COMBIN,SS,TRFORM,M1\nCHKSRF/SS,ON\nCHKSRF/S2,ON\nCHKSRF/SS,ON\n{smil}\n\
         CHKSRF/SS,OFF\nCHKSRF/PS,ON\n{smil}"
    ));
    let millings = regional(&program);
    let names = |milling: &RegionalMilling| {
        milling.checked.named.iter().map(|surface| surface.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&millings[0]), ["S2", "SS"]);
    assert_eq!(names(&millings[1]), ["S2"]);
    assert!(!millings[0].checked.part && millings[1].checked.part);
}

#[test]
fn doubtful_conditions_are_told() {
    let kind = |text: &str| {
        let program = run(text);
        let mut warned = program.findings().filter(|one| one.severity == Severity::Warning);
        warned.next().map(|one| one.kind.clone())
    };
    assert!(matches!(
        kind("SCON/DS,SS,PARAM,0,2.5,0,2,ON,VM"),
        Some(FindingKind::Sculptured(SculpturedFinding::GuideBeyond { parameter: 'u', extent, .. })) if extent == 2.0
    ));
    assert!(matches!(
        kind("SCON/DS,SS,PARAM,0,2,-.5,2,ON,VM"),
        Some(FindingKind::Sculptured(SculpturedFinding::GuideBeyond { parameter: 'v', .. }))
    ));
    assert!(matches!(
        kind("SCON/DS,K1,PARAM,0,3,ON,VM"),
        Some(FindingKind::Sculptured(SculpturedFinding::GuideBeyond { parameter: 'u', .. }))
    ));
    assert!(matches!(kind("SCON/AXIS,ATANGL,DS,0,CUTANG,-85"), Some(FindingKind::Doubtful { .. })));
    assert_eq!(kind("AVCTRL/NORMPS"), Some(FindingKind::Sculptured(SculpturedFinding::LiftWithoutLimit)));
    let older = kind(&format!("{CONDITIONS}SMIL/CUT,DS,PARAM,.2,.2,TANSPL,PLUS"));
    assert!(
        matches!(older, Some(FindingKind::Sculptured(SculpturedFinding::OlderSpelling { .. }))),
        "{older:?}"
    );
}

#[test]
fn places_have_the_parameters_that_were_asked_for() {
    let program = run("Q1=POINT/INTOF,SS,PARAM,1.25,.75,0\nU1=PARMF(UVAL)\nV1=PARMF(VVAL)\nP1=PARMF(PVAL)\n\
         U2=PARMF(SS,UPARAM)\nV2=PARMF(SS,VPARAM)\nP2=PARMF(SS,PATCH)\n\
         Q2=POINT/INTOF,K1,PARAM,.5,2\nT1=PARMF(TVAL)\nS1=PARMF(SVAL)\nT2=PARMF(K1)\nT3=PARMF(K1,PARAM)\n\
         N1=NUMF(SS)\nN2=NUMF(SS,SPLINE)\nN3=NUMF(SS,CRSSPL)\nN4=NUMF(K1,ARC)\nN5=NUMF(KF,SEG)\nN6=NUMF(K1)");
    assert_eq!(problems(&program), []);
    for (name, expected) in [
        ("U1", 0.25),
        ("V1", 0.75),
        ("P1", 2.0),
        ("U2", 1.25),
        ("V2", 0.75),
        ("P2", 2.0),
        ("T1", 0.5),
        ("S1", 2.0),
        ("T2", 1.5),
        ("T3", 1.5),
        ("N1", 4.0),
        ("N2", 3.0),
        ("N3", 3.0),
        ("N4", 2.0),
        ("N5", 1.0),
        ("N6", 2.0),
    ] {
        assert!((scalar(&program, name) - expected).abs() < 1e-12, "{name} is {}", scalar(&program, name));
    }
}

#[test]
fn places_lie_where_their_definition_says() {
    let program = run("Q1=POINT/INTOF,SS,(POINT/1,1,5),VM\nQ2=POINT/INTOF,(PLANE/1,0,0,1.5),K1,A1\n\
         Q3=POINT/INTOF,SS,PARAM,0,0,1\nV1=VECTOR/INTOF,SS,PARAM,1,1,0,NORMAL,UNIT\n\
         Q4=POINT/INTOF,SS,B2\nQ5=POINT/INTOF,SS,(POINT/.5,.5,-3),(POINT/.5,.5,3)");
    assert_eq!(problems(&program), []);
    let q1 = point(&program, "Q1");
    assert!((q1.x - 1.0).abs() < 1e-9 && (q1.y - 1.0).abs() < 1e-9, "{q1}");
    assert!((point(&program, "Q2").x - 1.5).abs() < 1e-9);
    assert!(point(&program, "Q3").norm() < 1e-12);
    assert!((point(&program, "V1").norm() - 1.0).abs() < 1e-12);
    assert!((point(&program, "Q4") - Vec3::new(1.0, 2.0, 0.4)).norm() < 1e-9);
    let q5 = point(&program, "Q5");
    assert!((q5.x - 0.5).abs() < 1e-9 && (q5.y - 0.5).abs() < 1e-9, "{q5}");
}

#[test]
fn results_follow_the_reference_system() {
    // Seen from a system that is shifted up by one, the surface and its points lie one lower.
    let program =
        run("REFSYS/M1\nQ1=POINT/INTOF,SS,PARAM,1,1,0\nREFSYS/NOMORE\nQ2=POINT/INTOF,SS,PARAM,1,1,0\n\
         D=DISTF(Q1,Q2)");
    assert_eq!(problems(&program), []);
    assert!(scalar(&program, "D").abs() < 1e-12);
}

#[test]
fn a_surface_survives_its_canonical_form_redefinition_and_macros() {
    let program = run("S1=SSURF/COMBIN,SS\nS1=SSURF/COMBIN,SS");
    assert_eq!(problems(&program), [(2, Some(50))]);
    let program = run("CANON/ON\nS1=SSURF/COMBIN,SS\nS1=SSURF/COMBIN,SS,TRFORM,M1");
    assert_eq!(problems(&program), []);
    let program = run("S1=SSURF/COMBIN,SS\nS1=5");
    assert_eq!(problems(&program), [(2, Some(1012))]);
    let program =
        run("MM=MACRO/CV,RES\nRES=SSURF/RULED,CV,AXIS,VY\nTERMAC\nCALL/MM,CV=K1,RES=SX\nN=NUMF(SX)");
    assert_eq!(problems(&program), []);
    assert_eq!(scalar(&program, "N"), 2.0);
}

#[test]
fn canonical_numbers_make_the_same_curve_and_surface() {
    for name in ["K1", "KF", "SS"] {
        let program = run("");
        let original = geometry(&program, name);
        let numbers: Vec<String> =
            original.canonical_values().iter().map(|value| format!("{value:?}")).collect();
        let word = original.kind().word();
        // Statements hold so many elements only: the numbers of a surface go on many cards.
        let mut text = format!("CN={word}/CANON");
        for chunk in numbers.chunks(3) {
            text.push_str(&format!(",{}$\n", chunk.join(",")));
        }
        let text = text.trim_end_matches("$\n").replace("e-", "E-");
        let program = run(&text);
        assert_eq!(problems(&program), [], "{text}");
        assert_eq!(geometry(&program, "CN"), original, "{name}");
    }
}

#[test]
fn an_edit_of_a_condition_reaches_the_commands_behind_it() {
    let text = format!(
        "{BASE}{CONDITIONS}{}SMIL/PATH,DS,PARAM,.2,.2,TANSPL,PLUS\nQ=POINT/INTOF,K1,PARAM,.5\n{}T=PARMF(TVAL)\nFINI\n",
        "X=1\n".repeat(300),
        "Y=1\n".repeat(300)
    );
    let tree = SyntaxTree::parse(&text, Dialect::named(DialectName::Apt4));
    let program = evaluate(&tree, &Options::default(), &|| false);
    assert_eq!(regional(&program)[0].axis, AxisCondition::Fixed(Vec3::new(0.0, 0.0, 1.0)));
    let change = |old: &str, new: &str| {
        let at = u32::try_from(text.find(old).unwrap()).unwrap();
        let range = apt_syntax::TextRange::new(at.into(), (at + u32::try_from(old.len()).unwrap()).into());
        let (tree, change) = tree.edit(range, new);
        program.update(&tree, &change, &Options::default(), &|| false)
    };
    let turned = change("SCON/AXIS,VZ,PLUS", "SCON/AXIS,VX,MINUS");
    assert_eq!(regional(&turned)[0].axis, AxisCondition::Fixed(Vec3::new(-1.0, 0.0, 0.0)));
    let moved = change("INTOF,K1,PARAM,.5", "INTOF,K1,PARAM,.25");
    assert_eq!((scalar(&program, "T"), scalar(&moved, "T")), (0.5, 0.25));
}

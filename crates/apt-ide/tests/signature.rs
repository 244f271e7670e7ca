//! Signature help: which form, and which parameter of it.

#![allow(
    clippy::unwrap_used,
    clippy::needless_pass_by_value,
    reason = "tests fail where something is missing, and say what they expect in place"
)]

mod support;

use apt_syntax::vocabulary::{WordClass, words};

use support::{analysis, marked, never};

const NAMES: &str =
    "P1=POINT/1,2\nL1=LINE/P1,ATANGL,30\nC1=CIRCLE/0,0,5\nA=2\nM1=MACRO/DX,DY=2,F=-3\nTERMAC\n";

/// The active form with the active parameter in quotes.
fn active(text: &str) -> String {
    let (analysis, offset) = marked(&format!("{NAMES}{text}\nFINI\n"));
    analysis.program(&never).unwrap();
    let Some(help) = analysis.signature_help(offset) else { return "nothing".to_owned() };
    let form = &help.signatures[help.active];
    match help.parameter {
        None => form.label.clone(),
        Some(parameter) => {
            let range = form.parameters[parameter].clone();
            format!(
                "{}<{}>{}",
                &form.label[..range.start],
                &form.label[range.clone()],
                &form.label[range.end..]
            )
        }
    }
}

#[test]
fn the_form_follows_what_has_been_typed() {
    for (text, expected) in [
        ("X=CIRCLE/$0", "CIRCLE/<x>,y,r"),
        ("X=CIRCLE/1,2,$0", "CIRCLE/x,y,<r>"),
        ("X=CIRCLE/1,2,3,$0", "CIRCLE/x,y,z,<r>"),
        ("X=CIRCLE/CENTER,$0", "CIRCLE/CENTER,<point>,RADIUS,r"),
        ("X=CIRCLE/CENTER,P1,TA$0", "CIRCLE/CENTER,point,<TANTO>,line"),
        ("X=CIRCLE/CENTER,P1,TANTO,$0", "CIRCLE/CENTER,point,TANTO,<line>"),
        ("X=LINE/P1,$0", "LINE/point,<point>"),
        ("X=LINE/P1,P$01", "LINE/point,<point>"),
        ("X=LINE/P1,PAR$0", "LINE/point,<PARLEL>,line"),
        ("X=LINE/(POINT/1,2),PARLEL,$0", "LINE/point,PARLEL,<line>"),
        ("X=LINE/(POINT/1,$0", "POINT/x,<y>"),
        ("X=LINE/(P9=POINT/1,$0", "POINT/x,<y>"),
        ("X=SINF($0", "SINF(<x>)"),
        ("X=2/SINF(30)+ATAN2F(1,$0", "ATAN2F(y,<x>)"),
        ("GOLFT/C1,$0", "GOLFT/ds,[{<TO>|ON|PAST|TANTO|DSTAN|PSTAN},][n,INTOF,]cs[,feed]"),
        ("GOLFT/C1,PAST,$0", "GOLFT/ds,[{TO|ON|PAST|TANTO|DSTAN|PSTAN},][<n>,INTOF,]cs[,feed]"),
        ("TLLFT,GOLFT/C1,PAST,2,$0", "GOLFT/ds,[{TO|ON|PAST|TANTO|DSTAN|PSTAN},][n,<INTOF>,]cs[,feed]"),
        ("GOLFT/C1,L1,$0", "GOLFT/ds,[{TO|ON|PAST|TANTO|DSTAN|PSTAN},][n,INTOF,]cs[,<feed>]"),
        ("SPINDL/800,$0", "SPINDL/rpm[,<CLW>|CCLW] | OFF,..."),
        ("CALL/M1,$0", "CALL/M1,<DX>,DY=2,F=-3"),
        ("CALL/M1,DX=1,$0", "CALL/M1,DX,<DY=2>,F=-3"),
        ("CALL/M1,F=1,DX=$0", "CALL/M1,<DX>,DY=2,F=-3"),
        ("CALL/M1,DX=1,F$0", "CALL/M1,DX,DY=2,<F=-3>"),
        ("PARTNO A,$0", "nothing"),
        ("A=2,$0", "nothing"),
        ("X=A/$0", "nothing"),
        ("$$ GOTO/$0", "nothing"),
    ] {
        assert_eq!(active(text), expected, "{text}");
    }
}

#[test]
fn every_word_with_parameters_has_its_forms() {
    let mut without = Vec::new();
    for word in words() {
        let open = match word.class {
            WordClass::Minor | WordClass::Text | WordClass::PostprocessorBare | WordClass::ToolPosition => {
                continue;
            }
            WordClass::Function => "(",
            _ => "/",
        };
        let has = word.forms.iter().any(|form| form.starts_with(&format!("{}{open}", word.spelling)));
        let text = match word.class {
            WordClass::GeometricType | WordClass::Function => format!("X={}{open}", word.spelling),
            _ => format!("{}{open}", word.spelling),
        };
        let dialect = word.dialects.first().map(|dialect| dialect.as_str().to_owned());
        let settings = std::sync::Arc::new(apt_ide::Settings { dialect, ..Default::default() });
        let program = apt_ide::Analysis::new(&format!("{text}\n"), None, &settings);
        let help = program.signature_help(text.len());
        if has {
            let help = help.unwrap_or_else(|| panic!("{} has no signature", word.spelling));
            assert!(help.signatures[0].label.starts_with(word.spelling), "{help:?}");
            assert_eq!(help.signatures[0].documentation, word.help);
        } else if help.is_none() {
            without.push(word.spelling);
        }
    }
    assert!(without.len() < 60, "{without:?}");
}

#[test]
fn typing_never_waits_for_an_evaluation() {
    let program = analysis("X=LINE/P1,\n");
    let help = program.signature_help(10).unwrap();
    assert_eq!((help.signatures.len() > 10, help.parameter.is_some()), (true, true));
    assert!(program.document().evaluated().is_none(), "it was evaluated");
}

/// What APT4 has of curves, surfaces and milling to type with.
const SCULPTURED: &str = "$$ apt-lsp: dialect=apt4\nP1=POINT/0,0,0\nP2=POINT/2,0,0\nP3=POINT/2,2,0\nV1=VECTOR/0,0,1\n\
    CV=SCURV/SPLINE,P1,P2,P3\nSS=SSURF/RULED,CV,AXIS,V1\nPL=PLANE/0,0,1,5\nMA=MATRIX/TRANSL,1,0,0\n";

#[test]
fn the_forms_of_sculptured_statements_follow_what_has_been_typed() {
    for (text, expected) in [
        ("X=SSURF/RULED,$0", "SSURF/RULED,<scurv>,AXIS,{vector|point,point}"),
        ("X=SSURF/RULED,CV,AXIS,$0", "SSURF/RULED,scurv,AXIS,{<vector>|point,point}"),
        (
            "X=SSURF/REVOLV,CV,AXIS,P1,V1,$0",
            "SSURF/REVOLV,scurv,AXIS,point,{point|vector},{<CLW>|CCLW},a1,a2",
        ),
        ("X=POINT/INTOF,SS,PARAM,.5,.5,$0", "POINT/INTOF,ssurf,PARAM,u,v,<k>"),
        ("SCON/$0", "SCON/<INIT>,{ALL|DS|PS|FEED|STEPOV|AXIS}"),
        ("SCON/DS,SS,PARAM,0,$0", "SCON/DS,ssurf,PARAM,ulo,<uhi>,vlo,vhi,{AT|ON},{NORMAL|vector}"),
        ("SCON/DS,CV,PARAM,0,1,ON,$0", "SCON/DS,scurv,PARAM,ulo,uhi,{AT|ON},{<CRSSPL>|vector}"),
        ("SCON/FEED,PL$0", "SCON/FEED,<plane>"),
        ("SCON/AXIS,ATANGL,PS,5,CUTANG,$0", "SCON/AXIS,ATANGL,{DS|PS},alpha,CUTANG,<beta>"),
        ("SMIL/POSN,DS,PARAM,0,0,INCR,$0", "SMIL/POSN,DS,PARAM,u,v,INCR,{<d>|vector|plane}"),
        (
            "SMIL/ZIGZAG,DS,PARAM,0,0,TANSPL,PLUS,$0",
            "SMIL/ZIGZAG,DS,PARAM,u,v,{TANSPL|CRSSPL},{PLUS|MINUS},<STEPOV>,{PLUS|MINUS}[,skip]",
        ),
        (
            "AVCTRL/CUTANG,CONST,1,RANGE,$0",
            "AVCTRL/CUTANG,CONST,g,RANGE,<b1>,b2[,{NORMPS|AXIS}[,LIMIT,dmax]]",
        ),
        ("CHKSRF/SS,$0", "CHKSRF/{PS|ssurf},{<ON>|OFF}"),
        ("X=PARMF(SS,$0", "PARMF(ssurf[,{<UPARAM>|VPARAM|PATCH}])"),
    ] {
        let (analysis, offset) = marked(&format!("{SCULPTURED}{text}\nFINI\n"));
        analysis.program(&never).unwrap();
        let help = analysis.signature_help(offset).unwrap_or_else(|| panic!("nothing at {text}"));
        let form = &help.signatures[help.active];
        let range = help.parameter.map(|parameter| form.parameters[parameter].clone());
        let range = range.unwrap_or_else(|| panic!("no parameter at {text}: {}", form.label));
        let shown = format!(
            "{}<{}>{}",
            &form.label[..range.start],
            &form.label[range.clone()],
            &form.label[range.end..]
        );
        assert_eq!(shown, expected, "{text}");
    }
}

#[test]
fn other_dialects_do_not_show_the_forms_of_sculptured_surfaces() {
    let (analysis, offset) = marked("$$ apt-lsp: dialect=apt3\nP1=POINT/$0\nFINI\n");
    let forms = analysis.signature_help(offset).unwrap().signatures;
    assert!(forms.len() > 10 && forms.iter().all(|form| !form.label.contains("ssurf")), "{forms:?}");
}

//! Expansions, runs of parts, tapes, CL files, pictures.

#![allow(
    clippy::unwrap_used,
    clippy::needless_pass_by_value,
    reason = "tests fail where something is missing, and say what they expect in place"
)]

mod support;

use apt_ide::{Cancelled, Level, picture, tape};
use expect_test::{Expect, expect};

use support::{analysis, marked, never, silent};

const NESTED: &str = "\
M1=MACRO/X
GOTO/X,0,0
CALL/M2,Y=X
TERMAC
M2=MACRO/Y
GODLTA/0,Y,0
TERMAC
FROM/0,0,0
CALL/M1,X=5
LOOPST
A=1
B) GODLTA/0,0,A
A=A+1
IF(A-2)B,B,C
C) LOOPND
FINI
";

fn check_expansion(text: &str, depth: Option<u32>, expected: Expect) {
    let (analysis, offset) = if text.contains("$0") { marked(text) } else { (analysis(text), usize::MAX) };
    let at = text.contains("$0").then_some(offset);
    let expansion = analysis.expand(at, depth, &never).unwrap();
    assert_eq!(expansion.text.lines().count(), expansion.origins.len());
    let mut shown = String::new();
    for (line, origin) in expansion.text.lines().zip(&expansion.origins) {
        let frames = apt_run::diagnostic::origin_steps(origin);
        let stack: Vec<String> =
            frames.iter().map(|frame| format!("{}{}#{}", frame.kind, frame.name, frame.turn)).collect();
        shown.push_str(format!("{:<2} {line:<18} {}", origin.isn, stack.join(" < ")).trim_end());
        shown.push('\n');
    }
    expected.assert_eq(&shown);
}

#[test]
fn macros_and_loops_are_unrolled() {
    check_expansion(
        NESTED,
        None,
        expect![[r#"
            8  FROM/0,0,0
            2  GOTO/5,0,0         macroM1#1
            6  GODLTA/0,5,0       macroM2#1 < macroM1#1
            11 A=1                loop#1
            12 GODLTA/0,0,1       loop#1
            13 A=1+1              loop#1
            12 GODLTA/0,0,2       loop#2
            13 A=2+1              loop#2
            16 FINI
        "#]],
    );
}

#[test]
fn an_expansion_can_be_of_one_statement_and_of_some_levels() {
    check_expansion(
        &NESTED.replace("CALL/M1,X", "CA$0LL/M1,X"),
        None,
        expect![[r#"
            2  GOTO/5,0,0         macroM1#1
            6  GODLTA/0,5,0       macroM2#1 < macroM1#1
        "#]],
    );
    let whole = analysis(NESTED);
    let deepest = |depth| {
        let origins = whole.expand(None, depth, &never).unwrap().origins;
        origins.iter().map(|origin| apt_run::diagnostic::origin_steps(origin).len()).max()
    };
    assert_eq!((deepest(Some(0)), deepest(Some(1)), deepest(None)), (Some(0), Some(1), Some(2)));
}

#[test]
fn what_is_longer_than_a_card_goes_on_in_the_next() {
    let points: Vec<String> = (0..16).map(|at| format!("{at}.125,{}.375", at % 3)).collect();
    let text = format!(
        "$$ apt-lsp: dialect=apt3\nA=1\nT=TABCYL/NOZ,SPLINE,{}$\n,{}\nGOTO/A,A,A\nFINI\n",
        points[..7].join(","),
        points[7..].join(",$\n"),
    );
    let expansion = analysis(&text).expand(None, None, &never).unwrap();
    let lines: Vec<&str> = expansion.text.lines().collect();
    assert!(lines.iter().all(|line| line.len() <= 72), "{}", expansion.text);
    assert_eq!(expansion.lines.len(), expansion.origins.len());
    let begins: Vec<String> = expansion.lines.iter().map(|at| lines[*at].chars().take(4).collect()).collect();
    assert_eq!(begins, ["A=1", "T=TA", "GOTO", "FINI"]);
    let symbols = |text: &str| {
        let analysis = analysis(text);
        analysis.run(None, &never, &mut silent).unwrap().symbols
    };
    let expanded = format!("$$ apt-lsp: dialect=apt3\n{}", expansion.text);
    assert_eq!(symbols(&expanded), symbols(&text));
    assert!(!symbols(&text).is_empty());
}

#[test]
fn a_run_of_a_range_reports_its_statements() {
    let text = "PARTNO R\nFROM/0,0,0\nGOTO/1,0,0\nGOTO/2,0,0\nFINI\n";
    let program = analysis(text);
    let at = text.find("GOTO/2").unwrap();
    let part = program.run(Some(at..at + 3), &never, &mut silent).unwrap();
    assert_eq!(part.cl.iter().map(|entry| entry.isn).collect::<Vec<_>>(), [4]);
    let whole = program.run(None, &never, &mut silent).unwrap();
    assert_eq!(whole.totals.points, 3);
    assert_eq!(program.run(None, &|| true, &mut silent).err(), None, "what is known needs no work");
    assert_eq!(analysis(text).run(None, &|| true, &mut silent).err(), Some(Cancelled));
}

#[test]
fn many_who_ask_share_one_computation() {
    let text =
        "CUTTER/1\nC1=CIRCLE/0,0,5\nL1=LINE/0,0,1,0\nFROM/8,-3,0\nGO/TO,C1\nTLRGT,GOLFT/C1,PAST,L1\nFINI\n";
    let program = analysis(text);
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| program.diagnostics(Level::Motion, &never, &mut silent).unwrap());
        }
    });
    let counters = program.document().memo().counters();
    assert_eq!((counters.computed, counters.reused), (2, 0), "{counters:?}");
}

#[test]
fn a_cl_file_is_posted_as_it_stands() {
    let text = "$$ apt-lsp: dialect=cl\nPARTNO/CL\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/10\nGOTO/0,0,1\nGOTO/1,$\n0,0\nnonsense here\nGOTO/2,0,0\nFINI\n";
    let program = analysis(text);
    let made = program.tape("linuxcnc-mill3", &never, &mut silent).unwrap();
    let block = made.tape.blocks.iter().find(|block| block.text.contains("X2")).unwrap();
    assert_eq!(block.isn, 9, "statements are numbered as in the text: {made:?}");
    let found: Vec<_> = made.diagnostics.iter().map(|one| (one.wording.code, one.origin.isn)).collect();
    assert!(found.contains(&("APT0810", 8)), "{found:?}");
}

#[test]
fn a_cl_tape_is_the_text_it_was_made_from() {
    let program = analysis("PARTNO T\nUNITS/INCHES\nSPINDL/1000,CLW\nFROM/0,0,1\nGOTO/1,2.125,1\nFINI\n");
    let bytes = program.cl_tape(&never, &mut silent).unwrap();
    let text = tape::text_of_cl_tape(&bytes).unwrap().unwrap().text;
    let direct = program.cl_text(&never, &mut silent).unwrap();
    let positions = |text: &str| {
        text.lines()
            .filter(|line| line.contains("GOTO") || line.contains("FROM"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(positions(&text), positions(&direct));
    assert!(tape::text_of_cl_tape(b"PARTNO T\n").is_none());
    assert!(tape::text_of_cl_tape(&bytes[..bytes.len() - 7]).unwrap().is_err());
}

#[test]
fn a_tape_is_punched_in_both_codes() {
    let program = analysis("PARTNO T\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/10\nFROM/0,0,1\nGOTO/1,2,1\nFINI\n");
    let tape = program.tape("fanuc-mill3", &never, &mut silent).unwrap().tape;
    for code in [tape::TapeCode::Eia, tape::TapeCode::Iso] {
        match tape::punch(&tape, code) {
            Ok(image) => assert_eq!(apt_post::punch::decode(&image, code).unwrap(), tape.text()),
            Err(error) => assert!(tape.text().contains(error.character), "{error}"),
        }
    }
}

#[test]
fn an_unknown_machine_is_told_with_those_there_are() {
    let error = analysis("FINI\n").tape("nonsense", &never, &mut silent).unwrap_err();
    assert!(error.to_string().contains("linuxcnc-mill3"), "{error}");
}

#[test]
fn a_picture_is_made_of_pixels_without_any_font() {
    let program = analysis("FROM/0,0,0\nGOTO/1,0,0\nGOTO/1,1,0\nFINI\n");
    let scene = program.scene(&never, &mut silent).unwrap();
    let image = picture::png(&scene).unwrap();
    assert!(image.starts_with(b"\x89PNG\r\n\x1a\n"));
    assert!(image.len() > 5_000, "{} bytes are an empty picture", image.len());
}

#[test]
fn the_machine_of_the_settings_is_asked_as_one_types() {
    use apt_ide::{Analysis, Level, Settings};

    let found = |machine: Option<&str>, level: Level, text: &str| -> Vec<(u32, &'static str)> {
        let settings = Settings { machine: machine.map(str::to_owned), ..Settings::default() };
        let analysis = Analysis::new(text, Some("part.apt".to_owned()), &std::sync::Arc::new(settings));
        let list = analysis.diagnostics(level, &never, &mut silent).unwrap();
        list.iter().map(|one| (one.origin.isn, one.wording.code)).collect()
    };
    let mill = Some("haas-mill3");
    let text = "FROM/0,0,1\nLOADTL/21\nSPINDL/99999,CLW\nFEDRAT/5\nGOTO/1,0,0\nGOTO/1,0,0,5,5\nFINI\n";
    let sound = text.replace("GOTO/1,0,0,5,5\n", "ROTABL/90\n");
    assert_eq!(found(None, Level::Motion, &sound), []);
    assert_eq!(found(mill, Level::Section1, &sound), []);
    assert_eq!(found(mill, Level::Motion, &sound), [(2, "APT0862"), (3, "APT0831"), (6, "APT0893")]);
    // The path of a program with an error is not the one that is meant.
    assert!(found(mill, Level::Motion, text).iter().all(|(_, code)| !code.starts_with("APT08")));
    assert_eq!(found(Some("mill-of-mine"), Level::Motion, &sound), [(1, "APT0894")]);
    // A CL file, and settings that make an error of a word that nobody knows.
    let mut settings = Settings { machine: mill.map(str::to_owned), ..Settings::default() };
    settings.dialect = Some("cl".to_owned());
    settings.severity.insert("APT0850".to_owned(), apt_run::settings::SeveritySetting::Error);
    let text = "FROM/0,0,1\nLOADTL/1\nCHIPCV/ON\nFINI\n";
    let analysis = Analysis::new(text, Some("part.cl".to_owned()), &std::sync::Arc::new(settings));
    let list = analysis.diagnostics(Level::Motion, &never, &mut silent).unwrap();
    let list: Vec<_> = list.iter().map(|one| (one.origin.isn, one.wording.code, one.severity)).collect();
    assert_eq!(list, [(3, "APT0850", apt_ide::Severity::Error)]);
}

/// What another dialect says otherwise stands at the statement of the program that leads there, macros and all.
#[test]
fn a_program_in_the_words_of_another_system() {
    use apt_ide::conversion::{ClDialect, ConvertedFile};
    let text = "M1=MACRO/X\nFEDRAT/X,MMPM\nTERMAC\nFROM/0,0,1\nCALL/M1,X=80\nGOTO/1,2,3\nFINI\n";
    let program = analysis(text);
    let made = program.convert(ClDialect::Creo, None, &never, &mut silent).unwrap();
    let ConvertedFile::Text(written) = &made.file else { panic!("{:?}", made.file) };
    expect![[r#"
        $$*         Pro/CLfile  Version
        UNITS / MM
        FROM / 0.0000000000, 0.0000000000, 1.0000000000
        FEDRAT / 80.000000, MMPM
        GOTO / 1.0000000000, 2.0000000000, 3.0000000000
        FINI
    "#]]
    .assert_eq(written);
    let told: Vec<(&str, u32)> =
        made.diagnostics.iter().map(|one| (one.wording.code, one.origin.place_in_program().0)).collect();
    assert_eq!(told, [("APT0819", 4)]);
    assert_eq!(made.from, ClDialect::PartProgram);
    assert!(
        program.convert(ClDialect::Nx, None, &|| true, &mut silent).is_ok(),
        "what is known needs no work"
    );
    let cancelled = analysis(text).convert(ClDialect::Nx, None, &|| true, &mut silent);
    assert!(
        matches!(cancelled, Err(apt_ide::conversion::ConversionError::Cancelled(Cancelled))),
        "{cancelled:?}"
    );
}

//! CL files on the command line, as text and binary.

mod support;

use support::Folder;

const CL: &str = "PARTNO/CL\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/10\nGOTO/0,0,1\nGOTO/1,0,0\nFINI\n";

/// Bytes of the header of a record of the tape of APT III, and of a data word.
const HEADER: usize = 16;
const WORD: usize = 8;
/// The classes of the tape that a file of NCL has otherwise: statement numbers stand in its headers, and motions have no name.
const STATEMENT: u16 = 1000;
const MOTION: u16 = 5000;
const NAME_WORDS: usize = 2;

/// A tape of APT III as NCL would write it: shorter headers, in blocks of which the last word is empty.
#[expect(clippy::unwrap_used, reason = "a failure here is the failure of a test")]
fn as_of_ncl(tape: &[u8]) -> Vec<u8> {
    let mut payload = [2_u16, 7400, 0, 0].map(u16::to_le_bytes).as_flattened().to_vec();
    payload.extend(b"DRILLING");
    let mut rest = tape;
    while rest.len() > 1 {
        let field = |at: usize| u16::from_le_bytes([rest[at], rest[at + 1]]);
        let (count, class, subclass) = (usize::from(field(4)), field(8), field(12));
        let (data, behind) = rest[HEADER..].split_at(count * WORD);
        let data = if class == MOTION { &data[NAME_WORDS * WORD..] } else { data };
        if class != STATEMENT {
            let words = u16::try_from(data.len() / WORD + 1).unwrap();
            payload.extend([words, class, subclass, 1].map(u16::to_le_bytes).as_flattened());
            payload.extend(data);
        }
        rest = behind;
    }
    let block = |part: &[u8]| {
        let mut block = part.to_vec();
        block.resize(288, 0);
        block
    };
    payload.chunks(280).flat_map(block).collect()
}

#[test]
fn cl_files_and_binary_tapes_are_posted_as_they_stand() {
    let folder = Folder::new("cl");
    folder.write("good.cls", CL);
    folder.write("bad.cls", CL.replace("GOTO/1,0,0", "GOTO/1,0"));
    let ran = folder.run(&["post", "good.cls", "--machine", "linuxcnc-mill3"]);
    assert!(ran.code == 0 && ran.stdout.contains("X1"), "{ran:?}");
    assert!(ran.stderr.contains("dialect cl (the file name ends with .cls)"), "{ran:?}");
    let bad = folder.run(&["post", "bad.cls", "--machine", "linuxcnc-mill3"]);
    assert!(bad.code == 1 && bad.stderr.contains("APT0813") && bad.stderr.contains("bad.cls:6:"), "{bad:?}");
    assert_eq!(folder.run(&["run", "good.cls", "--format", "cltape", "-o", "good.tap"]).code, 0);
    let tape = folder.run(&["post", "good.tap", "--machine", "linuxcnc-mill3"]);
    assert!(tape.stderr.contains("good.tap: dialect cl (a binary CLTAPE of APT III)"), "{tape:?}");
    assert_eq!((tape.code, tape.stdout), (0, ran.stdout));
}

/// What the reader of CL text cannot make a record of is missing on the tape: it is told before one is made.
#[test]
fn statements_that_say_nothing_to_the_reader_are_told_by_the_check() {
    let folder = Folder::new("cl-check");
    for (line, code) in [
        ("GOTO/1,2", "APT0813"),
        ("HELLO WORLD", "APT0810"),
        ("UNITS/FURLONG", "APT0810"),
        ("GOTO/0,0,0,0,0,2", "APT0815"),
        ("CIRCLE/0,0,0,0,0,0,1", "APT0816"),
    ] {
        folder.write("odd.cl", CL.replace("GOTO/1,0,0", line));
        for machine in ["", "machine = \"linuxcnc-mill3\"\n", "machine = \"none\"\n"] {
            folder.write("apt-lsp.toml", machine);
            let checked = folder.run(&["--check", "odd.cl"]);
            assert_eq!(checked.stdout.matches(code).count(), 1, "{line} {machine:?}: {checked:?}");
            let listed = folder.run(&["run", "odd.cl"]);
            assert_eq!(listed.stderr.matches(code).count(), 1, "{line} {machine:?}: {listed:?}");
        }
    }
    folder.write("apt-lsp.toml", "");
    folder.write("good.cl", CL.replace("GOTO/1,0,0", "RAPID,GOTO/1,0,0"));
    let checked = folder.run(&["--check", "--deny-warnings", "good.cl"]);
    assert!(checked.code == 0 && checked.stdout.is_empty(), "{checked:?}");
}

/// In files of NCL DEEP breaks chips, in those of Creo it withdraws the drill.
#[test]
fn deep_holes_are_drilled_as_the_system_of_the_file_means_them() {
    let folder = Folder::new("deep");
    folder.write(
        "ncl.cl",
        "N1    , UNITS/ MM\nN2    , RAPID\nN3    , GOTO/ 0., 0., 50.\n\
         N4    , CYCLE/ DEEP, FEDTO, 10., MMPM, 80., RAPTO, 2., STEP, 3.\nN5    , GOTO/ 1., 0., 0.\nN6    , CYCLE/ OFF\nN7    , FINI\n",
    );
    folder.write(
        "creo.cl",
        "$$*         Pro/CLfile  Version\nUNITS / MM\nRAPID\nGOTO / 0., 0., 50.\n\
         CYCLE / DEEP, DEPTH, 10., STEP, 3., MMPM, 80., CLEAR, 2.\nGOTO / 1., 0., 0.\nCYCLE / OFF\nFINI\n",
    );
    let told = |file: &str| folder.run(&["post", file, "--machine", "haas-mill3"]).stdout;
    for (file, code) in [("ncl.cl", "G73"), ("creo.cl", "G83")] {
        assert!(told(file).contains(&format!("{code} X1.")), "{file}: {}", told(file));
    }
    // The same in binary files.
    let inches = "RAPID\nGOTO/0,0,2\nCYCLE/DEEP,.4,IPM,8,.1,STEP,.1\nGOTO/1,0,0\nCYCLE/OFF\nFINI\n";
    folder.write("drill.cls", inches);
    assert_eq!(folder.run(&["run", "drill.cls", "--format", "cltape", "-o", "apt.tap"]).code, 0);
    let tape = std::fs::read(folder.0.join("apt.tap")).unwrap();
    folder.write("ncl.tap", as_of_ncl(&tape));
    // Whatever the programs beside it are written in.
    folder.write("apt-lsp.toml", "dialect = \"apt3\"\n");
    for (file, code) in [("ncl.tap", "G73"), ("apt.tap", "G83")] {
        assert!(told(file).contains(&format!("{code} X1.")), "{file}: {}", told(file));
    }
}

#[test]
fn a_binary_file_of_ncl_is_read() {
    let folder = Folder::new("ncl-binary");
    let bytes = include_bytes!("../../apt-cldata/tests/data/ncl-03.tap");
    std::fs::write(folder.0.join("arc.cl"), bytes).unwrap();
    assert_eq!(folder.run(&["--check", "."]).code, 0);
    let text = folder.run(&["run", "arc.cl", "--format", "cl"]);
    assert!(text.stdout.starts_with("PARTNO SAMPLE\nMACHIN/PWORKS,12.0\nMULTAX/ON\n"), "{text:?}");
    assert!(text.code == 0 && text.stderr.contains("arc.cl: dialect cl (a binary file of NCL)"), "{text:?}");
    let tape = folder.run(&["post", "arc.cl", "--machine", "linuxcnc-mill3"]);
    assert!(tape.code == 0 && tape.stdout.matches("\nN").count() > 40, "{tape:?}");
    assert_eq!(folder.run(&["convert", "arc.cl", "--to", "ncl", "-o", "arc.as"]).code, 0);
    assert_eq!(folder.run(&["diff", "arc.cl", "arc.as"]).code, 0);
}

#[test]
fn the_tape_of_a_program_is_that_of_apt_iii_byte_for_byte() {
    let folder = Folder::new("cltape");
    folder.write("sample.apt", include_bytes!("../../apt-cldata/tests/data/cltape-01.apt"));
    assert_eq!(folder.run(&["run", "sample.apt", "--format", "cltape", "-o", "sample.tap"]).code, 0);
    let sample = include_bytes!("../../apt-cldata/tests/data/cltape-01.tap");
    // One filling byte stands at the end of the sample.
    assert!(std::fs::read(folder.0.join("sample.tap")).unwrap() == sample[..sample.len() - 1]);
    let listing = folder.run(&["run", "sample.apt"]).stdout;
    let sections = ["PROGRAM", "STATEMENTS", "CANONICAL FORMS", "CUTTER LOCATIONS", "TOTALS"];
    let found =
        sections.map(|section| listing.find(section).unwrap_or_else(|| panic!("{section}: {listing}")));
    assert!(found.is_sorted() && listing.contains("     15        GO/TO,C1,TO,P1\n"), "{listing}");
}

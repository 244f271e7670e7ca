//! `convert`: files of every system through the binary, in every dialect, compared with their sources by `diff`.
#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

mod support;

use support::{Folder, run_in};

/// The dialects with endings that their files have.
const DIALECTS: [(&str, &str); 7] = [
    ("cl", "cl"),
    ("cltape", "cltape"),
    ("catia", "aptsource"),
    ("creo", "ncl"),
    ("hsm", "apt"),
    ("ncl", "as"),
    ("nx", "cls"),
];

macro_rules! corpus {
    ($($name:literal),+ $(,)?) => {
        [$(($name, include_bytes!(concat!("../../apt-cldata/tests/data/", $name)).as_slice())),+]
    };
}

/// Real files: CL text of every system, a part program and its binary tape.
const CORPUS: [(&str, &[u8]); 18] = corpus![
    "aptcl-01.cl",
    "aptcl-02.cl",
    "aptcl-03.cl",
    "catia-01.aptsource",
    "catia-02.aptsource",
    "catia-03.aptsource",
    "creo-01.ncl.1",
    "creo-02.ncl.1",
    "creo-03.ncl.1",
    "hsm-01.apt",
    "hsm-02.apt",
    "ncl-01.as",
    "ncl-02.as",
    "nx-01.cls",
    "nx-02.cls",
    "nx-03.cls",
    "cltape-01.apt",
    "cltape-01.tap",
];

/// How far arcs without inner positions are from the source, as it was told.
fn told_misfit(stderr: &str) -> Option<f64> {
    let (_, rest) = stderr.split_once("by its end alone, up to ")?;
    rest.split_whitespace().next()?.parse().ok()
}

#[test]
fn every_file_in_every_dialect_is_the_path_of_its_source() {
    let folder = Folder::new("convert-corpus");
    for (name, bytes) in CORPUS {
        folder.write(name, bytes);
        for (dialect, ending) in DIALECTS {
            let output = format!("{name}.{dialect}.{ending}");
            let ran = folder.run(&["convert", name, "--to", dialect, "-o", &output]);
            assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{name} {dialect}: {}", ran.stderr);
            let tolerance = told_misfit(&ran.stderr).map(|misfit| (misfit * 1.01).to_string());
            let mut arguments = vec!["diff", name, &output];
            arguments.extend(tolerance.iter().flat_map(|value| ["--tolerance", value.as_str()]));
            let compared = folder.run(&arguments);
            assert_eq!(compared.code, 0, "{name} {dialect}: {compared:?}\n{}", ran.stderr);
            assert!(!compared.stderr.contains("error["), "{name} {dialect}: {}", compared.stderr);
            // Twice the same.
            let first = std::fs::read(folder.0.join(&output)).unwrap();
            folder.run(&["convert", name, "--to", dialect, "-o", "again"]);
            assert_eq!(std::fs::read(folder.0.join("again")).unwrap(), first, "{name} {dialect}");
        }
    }
}

#[test]
fn standard_input_is_converted_to_standard_output() {
    let source = "TOOL PATH/SLOT,TOOL,D6\nFEDRAT/MMPM,100.0\nGOTO/1.0,2.0,3.0\nEND-OF-PATH\n";
    let ran = run_in(std::path::Path::new("."), &["convert", "-", "--to", "creo"], source.as_bytes());
    assert_eq!(ran.code, 0, "{ran:?}");
    assert_eq!(
        ran.stdout,
        "$$*         Pro/CLfile  Version\n$$ |TOOL PATH/SLOT,TOOL,D6\nUNITS / MM\nFEDRAT / 100.000000, MMPM\n\
         GOTO / 1.0000000000, 2.0000000000, 3.0000000000\n$$ |END-OF-PATH\nFINI\n"
    );
    for told in [
        "from Siemens NX CLSF to Creo",
        "<stdin>:1:1",
        "APT0817",
        "TOOL PATH is not of this dialect",
        "APT0819",
    ] {
        assert!(ran.stderr.contains(told), "{told}: {}", ran.stderr);
    }
    // A statement that stands as a remark is a warning, and a finding for those who say so.
    let denied = run_in(
        std::path::Path::new("."),
        &["convert", "-", "--to", "creo", "--deny-warnings"],
        source.as_bytes(),
    );
    assert_eq!((denied.code, denied.stdout), (1, ran.stdout.clone()));
    // Back again it is what it was.
    let back = run_in(std::path::Path::new("."), &["convert", "-", "--to", "nx"], ran.stdout.as_bytes());
    let words: Vec<&str> = back.stdout.lines().filter(|line| !line.starts_with("$$")).collect();
    assert_eq!(
        words,
        [
            "TOOL PATH/SLOT,TOOL,D6",
            "UNITS/MM",
            "FEDRAT/MMPM,100.0000",
            "GOTO/1.0000,2.0000,3.0000",
            "END-OF-PATH"
        ]
    );
}

#[test]
fn a_program_is_run_and_its_cl_text_is_that_of_run() {
    let folder = Folder::new("convert-program");
    folder.write(
        "arc.apt",
        "PARTNO ARC\nUNITS/MM\nINTOL/.001\nOUTTOL/.001\nCUTTER/10\nC1=CIRCLE/40,40,20\nL2=LINE/40,0,40,100\n\
         P1=PLANE/0,0,1,0\nFROM/0,40,0\nGO/TO,C1,TO,P1,ON,(LINE/0,40,100,40)\nTLLFT,GOLFT/C1,ON,L2\nGOTO/0,0,50\nFINI\n",
    );
    let run = folder.run(&["run", "arc.apt", "--format", "cl", "-o", "run.cl"]);
    assert_eq!(run.code, 0, "{run:?}");
    let converted = folder.run(&["convert", "arc.apt", "--to", "cl"]);
    assert_eq!(converted.code, 0, "{converted:?}");
    assert_eq!(converted.stdout, std::fs::read_to_string(folder.0.join("run.cl")).unwrap());
    // The tool goes about the circle at the distance of its radius, and that is the arc of the other systems.
    let nx = folder.run(&["convert", "arc.apt", "--to", "nx"]);
    let circle = nx.stdout.lines().find(|line| line.starts_with("CIRCLE/")).unwrap();
    let numbers: Vec<f64> = circle[7..].split(',').map(|number| number.parse().unwrap()).collect();
    assert_eq!(numbers[..6], [40.0, 40.0, 0.0, 0.0, 0.0, -1.0], "{circle}");
    assert!((numbers[6] - 25.0).abs() < 2e-3, "{circle}");
    // Off by the tolerance at most, and read back with a position every five degrees.
    let misfit = told_misfit(&nx.stderr).unwrap();
    assert!(misfit > 1e-3 && misfit < 2e-3 + 25.0 * (1.0 - 2.5_f64.to_radians().cos()), "{}", nx.stderr);
}

#[test]
fn an_unknown_dialect_is_answered_with_those_that_there_are() {
    let folder = Folder::new("convert-names");
    folder.write("a.cl", "GOTO/1,2,3\nFINI\n");
    let ran = folder.run(&["convert", "a.cl", "--to", "fanuc"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    let help = folder.run(&["convert", "--help"]).stdout;
    for (dialect, _) in DIALECTS {
        assert!(ran.stderr.contains(dialect), "{dialect}: {}", ran.stderr);
        assert!(help.contains(&format!("- {dialect}:")), "{dialect}: {help}");
    }
    assert!(help.contains("Siemens NX CLSF"), "{help}");
}

#[test]
fn what_cannot_be_read_is_told_with_its_place() {
    let folder = Folder::new("convert-broken");
    folder.write("broken.cls", "TOOL PATH/A,TOOL,B\nGOTO/1,2\nGOTO/1,2,3\nEND-OF-PATH\n");
    let ran = folder.run(&["convert", "broken.cls", "--to", "cl"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.stderr.contains("APT0813") && ran.stderr.contains("broken.cls:2:1"), "{}", ran.stderr);
    assert!(ran.stdout.contains("GOTO/1.0,2.0,3.0\n"), "what can be read is written: {}", ran.stdout);
    folder.write("a.nci", "1050\n0 0 0\n1001\n1 2 3\n0\n0 1. 2. 3. -2. 0\n");
    let ran = folder.run(&["convert", "a.nci", "--to", "cl"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("Mastercam NCI, which is not read"), "{}", ran.stderr);
    // A tape that ends within a record.
    let tape = include_bytes!("../../apt-cldata/tests/data/cltape-01.tap");
    folder.write("cut.tap", &tape[..300]);
    let ran = folder.run(&["convert", "cut.tap", "--to", "cl"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("cut.tap") && ran.stderr.contains("byte"), "{}", ran.stderr);
}

/// A tape is read as it is: with its statement numbers and surfaces, which its text form does not have.
#[test]
fn a_tape_is_the_same_tape() {
    let folder = Folder::new("convert-tape");
    let tape = include_bytes!("../../apt-cldata/tests/data/cltape-01.tap");
    folder.write("a.tap", tape);
    let ran = folder.run(&["convert", "a.tap", "--to", "cltape", "-o", "b.tap"]);
    assert_eq!(ran.code, 0, "{ran:?}");
    // One filling byte stands at the end of the sample.
    assert_eq!(std::fs::read(folder.0.join("b.tap")).unwrap(), tape[..tape.len() - 1]);
    let rows = folder.run(&["convert", "a.tap", "--to", "ncl"]);
    assert!(rows.stdout.contains("N16   , GOTO/"), "the statement number of the tape: {}", rows.stdout);
    // A binary file of NCL that ends inside its first record.
    let mut other = vec![0; 288];
    other[..4].copy_from_slice(&[36, 0, 0xe8, 0x1c]);
    folder.write("c.cl", other);
    let ran = folder.run(&["convert", "c.cl", "--to", "cl"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("the record at byte 0 has 36 data words"), "{}", ran.stderr);
}

#[test]
fn latin_1_stays_latin_1() {
    let folder = Folder::new("convert-latin");
    folder.write("a.aptsource", b"$$ CATIA APT VERSION 1.0\nPARTNO PI\xc8CE\nGOTO  / 1.0,2.0,3.0\nFINI\n");
    let ran = folder.run(&["convert", "a.aptsource", "--to", "hsm", "-o", "a.apt"]);
    assert_eq!(ran.code, 0, "{ran:?}");
    let bytes = std::fs::read(folder.0.join("a.apt")).unwrap();
    assert!(bytes.windows(5).any(|part| part == b"PI\xc8CE"), "{}", String::from_utf8_lossy(&bytes));
}

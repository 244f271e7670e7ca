//! `apt-lsp fmt`: in place, as a check, from standard input; and the settings that it obeys.

#![allow(clippy::unwrap_used, reason = "a failure here is the failure of a test")]

mod support;

use support::{Folder, run_in};

const UGLY: &str = "partno x\n p1 = point / 1 , 2 $$ first\nGOTO/P1 $$ second\nfini\n";
const NEAT: &str = "partno x\nP1=POINT/1,2 $$ first\nGOTO/P1      $$ second\nFINI\n";

fn read(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.0.join(name)).unwrap()
}

#[test]
fn files_are_formatted_in_place_and_a_check_changes_nothing() {
    let folder = Folder::new("fmt-place");
    folder.write("parts/ugly.apt", UGLY);
    folder.write("parts/neat.apt", NEAT);
    let checked = folder.run(&["fmt", "--check", "parts"]);
    assert_eq!(checked.code, 1, "{checked:?}");
    assert_eq!(checked.stdout.trim(), "parts/ugly.apt");
    assert_eq!(read(&folder, "parts/ugly.apt"), UGLY);

    let formatted = folder.run(&["fmt", "parts"]);
    assert_eq!((formatted.code, formatted.stdout.as_str()), (0, ""), "{formatted:?}");
    assert!(formatted.stderr.contains("ugly.apt: formatted") && !formatted.stderr.contains("neat.apt"));
    assert_eq!((&*read(&folder, "parts/ugly.apt"), &*read(&folder, "parts/neat.apt")), (NEAT, NEAT));
    let again = folder.run(&["fmt", "--check", "parts"]);
    assert_eq!((again.code, again.stdout.as_str()), (0, ""), "{again:?}");
}

#[test]
fn standard_input_is_formatted_to_standard_output() {
    let ran = run_in(std::path::Path::new("."), &["fmt", "-"], UGLY.as_bytes());
    assert_eq!((ran.code, ran.stdout.as_str()), (0, NEAT), "{ran:?}");
    let ran = run_in(std::path::Path::new("."), &["fmt", "--check", "-"], UGLY.as_bytes());
    assert_eq!((ran.code, ran.stdout.trim()), (1, "<stdin>"), "{ran:?}");
}

#[test]
fn what_cannot_be_used_is_told() {
    let folder = Folder::new("fmt-unusable");
    folder.write("a.apt", NEAT);
    for arguments in [&["fmt"][..], &["fmt", "nothing.apt"], &["fmt", "a.apt", "--dialect", "nonsense"]] {
        let ran = folder.run(arguments);
        assert!(ran.code == 2 && !ran.stderr.is_empty(), "{arguments:?}: {ran:?}");
    }
    folder.write("apt-lsp.toml", "[format]\nwrap = 2\n");
    let ran = folder.run(&["fmt", "a.apt"]);
    assert!(ran.code == 2 && ran.stderr.contains("wrap at column 2; at least 20"), "{ran:?}");
}

#[test]
fn the_project_file_sets_the_style() {
    let folder = Folder::new("fmt-style");
    folder.write(
        "apt-lsp.toml",
        "[format]\nletter-case = \"keep\"\nindent = 2\nwrap = 24\nalign-comments = false\n",
    );
    folder.write(
        "a.apt",
        "m1=macro/x\na=x\ntermac\ncall/m1,x=1 $$ b\np=point/1.25,2.25,3.25,4.25,5.25\nfini\n",
    );
    let ran = folder.run(&["fmt", "a.apt"]);
    assert_eq!(ran.code, 0, "{ran:?}");
    let expected =
        "m1=macro/x\n  a=x\ntermac\ncall/m1,x=1 $$ b\np=point/1.25,2.25,3.25,$\n     4.25,5.25\nfini\n";
    assert_eq!(read(&folder, "a.apt"), expected);
}

#[test]
fn the_bytes_of_a_file_keep_their_form() {
    let folder = Folder::new("fmt-bytes");
    let path = folder.0.join("a.apt");
    for (before, after) in [
        (&b"GOTO / 1,2,3 $$ \xe9\r\nFINI\r\n"[..], &b"GOTO/1,2,3 $$ \xe9\r\nFINI\r\n"[..]),
        (b"\xef\xbb\xbfGOTO / 1,2,3\nFINI\n", b"\xef\xbb\xbfGOTO/1,2,3\nFINI\n"),
    ] {
        std::fs::write(&path, before).unwrap();
        assert_eq!(folder.run(&["fmt", "a.apt"]).code, 0);
        assert_eq!(std::fs::read(&path).unwrap(), after);
    }
}

#[test]
fn marks_keep_a_part_as_it_is() {
    let folder = Folder::new("fmt-marks");
    let text = "A = 1\n$$ apt-lsp: format off\nB = 2\n$$ apt-lsp: format on\nC = A + B\nGOTO / A,B,C\nFINI\n";
    folder.write("a.apt", text);
    assert_eq!(folder.run(&["fmt", "a.apt"]).code, 0);
    assert_eq!(
        read(&folder, "a.apt"),
        text.replace("A = 1", "A=1").replace("C = A", "C=A").replace("GOTO / ", "GOTO/")
    );
}

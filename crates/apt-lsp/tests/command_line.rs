//! The real binary as a command: exit codes, formats, what goes to which stream.

mod support;

use serde_json::Value;

use support::{Folder, run, run_in};

const GOOD: &str = "PARTNO GOOD\nFROM/0,0,1\nGOTO/1,0,1\nGOTO/1,2,1\nFINI\n";
const BAD: &str = "PARTNO BAD\n$$ é😀\nP1=POINT/1,2\nL1=LINE/P1,P9\nFROM/0,0,0\nGOTO/P1\nFINI\n";

#[test]
fn exit_codes_tell_clean_findings_and_unusable() {
    let folder = Folder::new("codes");
    folder.write("good.apt", GOOD);
    folder.write("bad.apt", BAD);
    folder.write("doubted.apt", GOOD.replace("GOTO/1,0,1", "GOTO/1 0,0,1"));
    for (arguments, code) in [
        (&["--check", "good.apt"][..], 0),
        (&["check", "good.apt"], 0),
        (&["--check", "bad.apt"], 1),
        (&["--check", "good.apt", "bad.apt"], 1),
        (&["check", "."], 1),
        (&["check", "no-such-file.apt"], 2),
        (&["check", "bad.apt", "no-such-file.apt"], 2),
        (&["check"], 2),
        (&["--check"], 2),
        (&["--check", "--no-motion", "good.apt"], 0),
        (&["--check", "--format", "json", "bad.apt", "--no-motion", "good.apt"], 1),
        (&["--no-motion", "--check", "good.apt"], 0),
        (&["--check", "--no-motion"], 2),
        (&["good.apt"], 2),
        (&["--no-such-option"], 2),
        (&["no-such-command"], 2),
        (&["--stdio", "--check", "good.apt"], 2),
        (&["--stdio", "run", "good.apt"], 2),
        (&["run", "good.apt"], 0),
        (&["run", "bad.apt"], 1),
        (&["run", "no-such-file.apt"], 2),
        (&["run", "good.apt", "--format", "nonsense"], 2),
        (&["run", "good.apt", "--dialect", "nonsense"], 2),
        (&["post", "good.apt", "--machine", "nonsense"], 2),
        (&["post", "good.apt"], 2),
        (&["expand", "good.apt", "--at", "0"], 2),
        (&["expand", "good.apt", "--at", "99"], 2),
        (&["expand", "bad.apt"], 1),
        (&["expand", "doubted.apt"], 0),
        (&["expand", "doubted.apt", "--deny-warnings"], 1),
        (&["view", "doubted.apt", "-o", "picture.svg"], 0),
        (&["view", "doubted.apt", "-o", "picture.svg", "--deny-warnings"], 1),
        (&["diff", "doubted.apt", "doubted.apt"], 0),
        (&["diff", "doubted.apt", "doubted.apt", "--deny-warnings"], 1),
        (&["view", "good.apt", "-o", "picture.gif"], 2),
        (&["view", "bad.apt", "-o", "picture.svg"], 1),
        (&["explain", "APT9999"], 2),
        (&["diff", "good.apt", "good.apt"], 0),
        (&["diff", "good.apt", "bad.apt"], 1),
        (&["diff", "bad.apt", "bad.apt"], 1),
        (&["diff", "good.apt"], 2),
        (&["diff", "-", "-"], 2),
        (&["diff", "good.apt", "no-such-file.apt"], 2),
        (&["diff", "good.apt", "good.apt", "--tolerance", "0"], 2),
        (&["convert", "good.apt", "--to", "cl"], 0),
        (&["convert", "bad.apt", "--to", "cl"], 1),
        (&["convert", "good.apt"], 2),
        (&["convert", "good.apt", "--to", "nonsense"], 2),
        (&["convert", "no-such-file.apt", "--to", "nx"], 2),
        (&["--help"], 0),
        (&["--version"], 0),
    ] {
        let ran = folder.run(arguments);
        assert_eq!(ran.code, code, "{arguments:?}: {ran:?}");
        if code == 2 {
            assert!(!ran.stderr.is_empty(), "{arguments:?} says nothing");
        }
    }
}

#[test]
fn an_option_that_would_do_nothing_is_refused() {
    let folder = Folder::new("misplaced");
    folder.write("good.apt", GOOD);
    for (arguments, says) in [
        (
            &["--dialect", "apt4", "run", "good.apt"][..],
            "`--dialect` stands behind the command: `apt-lsp run --dialect …`",
        ),
        (
            &["--format", "json", "check", "good.apt"],
            "`--format` stands behind the command: `apt-lsp check --format …`",
        ),
        (&["--severity", "APT0951=off", "tree", "good.apt"], "`--severity` stands behind the command"),
        (&["--no-motion", "explain", "APT0951"], "`--no-motion` does not go with `explain`"),
        (&["--stdio", "--dialect", "apt4"], "`--dialect` goes with `--check` or a command"),
        (&["--deny-warnings"], "`--deny-warnings` goes with `--check` or a command"),
    ] {
        let ran = folder.run(arguments);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{arguments:?}: {ran:?}");
        assert!(ran.stderr.contains(says), "{arguments:?}: {}", ran.stderr);
    }
}

#[test]
fn people_get_excerpts_and_a_count() {
    let folder = Folder::new("human");
    folder.write("bad.apt", BAD);
    let ran = folder.run(&["--check", "bad.apt"]);
    assert!(ran.stdout.contains("--> bad.apt:4:"), "{}", ran.stdout);
    assert!(ran.stdout.contains("L1=LINE/P1,P9"), "{}", ran.stdout);
    assert!(ran.stdout.contains('^') && ran.stdout.contains("error[APT"), "{}", ran.stdout);
    assert!(!ran.stdout.contains('\u{1b}'), "colours in a pipe");
    assert!(ran.stderr.contains("1 error, ") && ran.stderr.contains("dialect"), "{}", ran.stderr);
    let coloured = folder.run(&["--check", "bad.apt", "--color", "always"]);
    assert!(coloured.stdout.contains('\u{1b}'), "no colours though asked for");
}

#[test]
fn json_tells_places_in_utf_16() {
    let folder = Folder::new("json");
    folder.write("bad.apt", BAD);
    folder.write("good.apt", GOOD);
    let ran = folder.run(&["--check", "good.apt", "bad.apt", "--format", "json"]);
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(report["summary"]["errors"], 1);
    assert_eq!(
        (&report["files"][0]["file"], &report["files"][1]["file"]),
        (&"good.apt".into(), &"bad.apt".into())
    );
    let found = report["files"][1]["diagnostics"].as_array().unwrap();
    let error = found.iter().find(|found| found["severity"] == "error").unwrap();
    assert_eq!((&error["isn"], &error["range"]["start"]["line"]), (&4.into(), &3.into()));
    for key in ["code", "message", "apt3", "file", "origin", "related", "hint"] {
        assert!(error.get(key).is_some(), "{key} is missing in {error}");
    }
}

#[test]
fn sarif_and_github_name_the_same_place() {
    let folder = Folder::new("sarif");
    folder.write("a b/bad.apt", BAD);
    let ran = folder.run(&["check", "a b", "--format", "sarif"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    let log: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(log["version"], "2.1.0");
    let run = &log["runs"][0];
    let driver = &run["tool"]["driver"];
    assert_eq!((&driver["name"], &run["columnKind"]), (&"apt-lsp".into(), &"utf16CodeUnits".into()));
    let results = run["results"].as_array().unwrap();
    let result = results.iter().find(|result| result["level"] == "error").unwrap();
    let place = &result["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "a%20b/bad.apt");
    assert_eq!(place["region"]["startLine"], 4);
    let rule = result["ruleIndex"].as_u64().unwrap() as usize;
    assert_eq!(driver["rules"][rule]["id"], result["ruleId"]);

    let ran = folder.run(&["check", "a b", "--format", "github"]);
    assert!(
        ran.stdout.starts_with("::") && ran.stdout.contains("::error file=a b/bad.apt,line=4,"),
        "{}",
        ran.stdout
    );
}

#[test]
fn standard_input_is_a_program_too() {
    let ran = run_in(std::path::Path::new("."), &["--check", "-", "--format", "json"], BAD.as_bytes());
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!((ran.code, &report["files"][0]["file"]), (1, &"<stdin>".into()));
    let ran = run_in(std::path::Path::new("."), &["run", "-", "--format", "json"], GOOD.as_bytes());
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!((ran.code, &report["ok"], &report["totals"]["points"]), (0, &true.into(), &3.into()));
}

#[test]
fn any_bytes_are_checked_without_a_fault() {
    let folder = Folder::new("bytes");
    folder.write("latin.apt", b"PARTNO \xe9\nFROM/0,0,0\nFINI\n");
    folder.write(
        "noise.apt",
        (0..4096_u32).map(|n| (n.wrapping_mul(2_654_435_761) >> 13) as u8).collect::<Vec<_>>(),
    );
    folder.write("empty.apt", "");
    let ran = folder.run(&["check", "latin.apt"]);
    assert!(ran.stderr.contains("Latin-1"), "{ran:?}");
    assert!([0, 1].contains(&folder.run(&["check", "noise.apt"]).code));
    assert!([0, 1].contains(&folder.run(&["check", "empty.apt"]).code));
}

#[test]
fn a_run_is_listed_for_people_and_for_programs() {
    let folder = Folder::new("run");
    folder.write("good.apt", GOOD);
    let ran = folder.run(&["run", "good.apt"]);
    for part in ["PROGRAM good.apt", "CUTTER LOCATIONS", "TOTALS"] {
        assert!(ran.stdout.contains(part), "{part} is missing in {}", ran.stdout);
    }
    let ran = folder.run(&["run", "good.apt", "--format", "cl"]);
    assert!(ran.stdout.contains("GOTO") && ran.stdout.contains("FINI"), "{ran:?}");
    folder.run(&["run", "good.apt", "-o", "out.cl"]);
    assert_eq!(std::fs::read_to_string(folder.0.join("out.cl")).unwrap(), ran.stdout);
    assert_eq!(folder.run(&["run", "good.apt", "--format", "cltape", "-o", "out.bin"]).code, 0);
    let (plain, dash) = (
        folder.run(&["run", "good.apt", "--format", "cl"]),
        folder.run(&["run", "good.apt", "--format", "cl", "-o", "-"]),
    );
    assert_eq!((dash.code, dash.stdout), (0, plain.stdout), "`-` is standard output");
    assert!(!folder.0.join("-").exists());
    assert!(std::fs::read(folder.0.join("out.bin")).unwrap().len() > 100);
    let ran = folder.run(&["run", "good.apt", "-o", "out.json"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""));
    let report: Value = serde_json::from_slice(&std::fs::read(folder.0.join("out.json")).unwrap()).unwrap();
    assert_eq!(report["program"], "good.apt");
}

/// Of NX and Creo files each position may have its axis without MULTAX. The tape of APT III has axes only under it.
#[test]
fn a_run_of_a_cl_file_keeps_the_tool_axes_that_it_tells() {
    let folder = Folder::new("axes");
    let text = "FROM/0,0,9\nGOTO/1,2,3,0,.6,.8\nGOTO/2,2,3\nGODLTA/5\nGOTO/3,2,3,0,0,1\nFINI\n";
    folder.write("tilted.cl", text);
    let ran = folder.run(&["run", "tilted.cl", "--format", "json"]);
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    let told: Vec<usize> = report["cl"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|entry| Some(entry["points"][0].as_array()?.len()))
        .collect();
    assert_eq!(told, [3, 6, 3, 3, 6]);
    for name in ["again.cl", "again.cltape"] {
        assert_eq!(folder.run(&["run", "tilted.cl", "-o", name]).code, 0);
        let same = folder.run(&["diff", "--dialect", "cl", "tilted.cl", name]);
        assert_eq!(same.code, 0, "{name}: {same:?}");
    }
}

#[test]
fn findings_go_to_the_file_that_was_named() {
    let folder = Folder::new("findings-to-a-file");
    folder.write("bad.apt", BAD);
    let shown = folder.run(&["run", "bad.apt", "--format", "sarif"]).stdout;
    for arguments in [&["-o", "out.sarif"][..], &["--format", "sarif", "-o", "out.log"]] {
        let ran = folder.run(&[&["run", "bad.apt"], arguments].concat());
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
        let name = arguments[arguments.len() - 1];
        assert_eq!(std::fs::read_to_string(folder.0.join(name)).unwrap(), shown);
    }
    let shown = folder.run(&["run", "bad.apt", "--format", "github"]).stdout;
    let ran = folder.run(&["run", "bad.apt", "--format", "github", "-o", "out.txt"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    assert_eq!(std::fs::read_to_string(folder.0.join("out.txt")).unwrap(), shown);
    assert_eq!(folder.run(&["run", "bad.apt", "-o", "no-such-folder/out.sarif"]).code, 2);
}

#[test]
fn a_project_file_is_found_and_a_broken_one_is_told() {
    let folder = Folder::new("project");
    folder.write("parts/good.apt", GOOD);
    folder.write("apt-lsp.toml", "dialect = \"apt3\"\n");
    let ran = folder.run(&["check", "parts/good.apt"]);
    assert!(ran.stderr.contains("apt3"), "{ran:?}");
    let ran = folder.run(&["check", "parts/good.apt", "--dialect", "free"]);
    assert!(ran.stderr.contains("free"), "{ran:?}");
    folder.write("apt-lsp.toml", "dialekt = \"apt3\"\n");
    let ran = folder.run(&["check", "parts/good.apt"]);
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("apt-lsp.toml") && ran.stderr.contains("dialekt"), "{ran:?}");
    for code in ["APT9999", "110", "unused"] {
        folder.write("apt-lsp.toml", format!("[severity]\n{code} = \"off\"\n"));
        let ran = folder.run(&["check", "parts/good.apt"]);
        assert!(ran.code == 2 && ran.stderr.contains("severity: there is no diagnostic"), "{code}: {ran:?}");
    }
    folder.write("apt-lsp.toml", "[severity]\napt0101 = \"off\"\n[budget]\npoints = 2\n");
    let ran = folder.run(&["check", "parts/good.apt"]);
    assert!(ran.code == 1 && ran.stdout.contains("error[APT0717]"), "{ran:?}");
}

#[cfg(unix)]
#[test]
fn a_reader_who_has_seen_enough_is_no_fault() {
    use std::process::{Command, Stdio};

    let folder = Folder::new("pipe");
    folder.write("bad.apt", format!("{BAD}{}", "Q=UNKNWN\n".repeat(20_000)));
    let mut process = Command::new(env!("CARGO_BIN_EXE_apt-lsp"))
        .args(["check", "bad.apt"])
        .current_dir(&folder.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(process.stdout.take());
    let output = process.wait_with_output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(!told.contains("panicked"), "{told}");
}

/// A file is written whole or not at all, wherever the disk is full.
#[cfg(unix)]
#[test]
fn what_cannot_be_written_whole_leaves_the_old_file() {
    let folder = Folder::new("full");
    let long = GOOD.replace("FINI", &format!("{}FINI", "GOTO/1,2,3\n".repeat(1000)));
    folder.write("long.apt", long);
    let limited = |name: &str| {
        let script = format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" run long.apt --format cl -o {name}");
        let output = std::process::Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_apt-lsp")])
            .current_dir(&folder.0)
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && told.contains(&format!("{name}: ")), "{told}");
    };
    folder.write("old.cl", "OLD\n");
    std::os::unix::fs::symlink("old.cl", folder.0.join("link.cl")).unwrap();
    for name in ["old.cl", "link.cl", "new.cl"] {
        limited(name);
        assert_eq!(std::fs::read_to_string(folder.0.join("old.cl")).unwrap(), "OLD\n", "{name}");
    }
    let names = std::fs::read_dir(&folder.0).unwrap().map(|one| one.unwrap().file_name());
    let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["link.cl", "long.apt", "old.cl"], "nothing is left beside them");
    assert_eq!(folder.run(&["run", "long.apt", "--format", "cl", "-o", "link.cl"]).code, 0);
    assert!(std::fs::read_to_string(folder.0.join("old.cl")).unwrap().ends_with("FINI\n"));
    assert!(std::fs::symlink_metadata(folder.0.join("link.cl")).unwrap().is_symlink());
    let ran = folder.run(&["run", "long.apt", "--format", "cl", "-o", "nowhere/out.cl"]);
    assert!(ran.code == 2 && ran.stderr.contains("nowhere/out.cl: "), "{ran:?}");
}

#[test]
fn tapes_trees_expansions_and_pictures_are_written() {
    let folder = Folder::new("products");
    folder.write("good.apt", GOOD);
    folder.write(
        "loop.apt",
        "PARTNO LOOP\nPPRINT TWICE AS FAR\nM1=MACRO/A\nGOTO/A,0,0\nTERMAC\nFROM/0,0,0\nCALL/M1,A=7\nFINI\n",
    );
    let machines = folder.run(&["machines"]).stdout;
    let machine = machines.split_whitespace().next().unwrap();
    let ran = folder.run(&["post", "good.apt", "--machine", machine]);
    assert!(ran.stdout.contains("X1"), "{ran:?}");
    let ran = folder.run(&["tree", "good.apt"]);
    assert!(ran.code == 0 && ran.stdout.contains("GOTO"), "{ran:?}");
    let ran = folder.run(&["expand", "loop.apt"]);
    assert!(ran.stdout.contains("GOTO/7,0,0") && ran.stdout.contains("in the macro M1"), "{ran:?}");
    // What is printed says the same as the program, its free texts too.
    folder.write("expanded.apt", &ran.stdout);
    let locations = |name: &str| folder.run(&["run", name, "--format", "cl"]).stdout;
    assert_eq!(locations("expanded.apt"), locations("loop.apt"));
    for (name, beginning) in [("out.svg", "<svg"), ("out.html", "<!")] {
        let ran = folder.run(&["view", "good.apt", "-o", name]);
        assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{ran:?}");
        let picture = std::fs::read_to_string(folder.0.join(name)).unwrap();
        assert!(picture.contains(beginning), "{name}");
    }
    let ran = folder.run(&["explain", "apt0101"]);
    assert!(ran.stdout.contains("APT0101") && ran.stdout.contains("Wrong"), "{ran:?}");
}

#[test]
fn machines_and_pages_are_printed() {
    let list = run(&["machines"]);
    assert_eq!(list.code, 0);
    assert!(!list.stdout.is_empty());
    assert_eq!(run(&["post", "--list-machines"]).stdout, list.stdout);
}

#[test]
fn tapes_are_punched_and_pictures_are_images() {
    let folder = Folder::new("punch");
    folder.write("good.apt", GOOD);
    for (code, parity) in [("eia", 1), ("iso", 0)] {
        let name = format!("{code}.tape");
        let ran = folder.run(&["post", "good.apt", "--machine", "fanuc-mill3", "--punch", code, "-o", &name]);
        assert!(ran.code < 2 && ran.stdout.is_empty(), "{ran:?}");
        let image = std::fs::read(folder.0.join(&name)).unwrap();
        // Ten characters make an inch.
        let feet = format!("{:.3} ft", image.len() as f64 / 120.0);
        assert!(ran.stderr.contains(&format!("good.apt: {feet} (")), "{feet}: {ran:?}");
        let rows: Vec<u8> = image.into_iter().filter(|row| *row != 0).collect();
        assert!(rows.len() > 20, "{code}: {} rows", rows.len());
        assert!(rows.iter().all(|row| row.count_ones() % 2 == parity), "{code}");
    }
    assert_eq!(folder.run(&["post", "good.apt", "--machine", "fanuc-mill3", "--punch", "morse"]).code, 2);
    // What the code lacks is found where the program says it, and nothing is written.
    folder.write("odd.apt", GOOD.replace("FINI", "PPRINT READY; A=1\nFINI"));
    for (code, found) in [("eia", vec!["';'", "'='"]), ("iso", vec!["';'"])] {
        let ran =
            folder.run(&["post", "odd.apt", "--machine", "fanuc-mill3", "--punch", code, "-o", "odd.tape"]);
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{ran:?}");
        assert_eq!(ran.stderr.matches("error[APT0898]").count(), found.len(), "{ran:?}");
        assert!(found.iter().all(|character| ran.stderr.contains(&format!("{character} is not in the"))));
        assert!(ran.stderr.contains("PPRINT READY") && ran.stderr.contains("help"), "{ran:?}");
        assert!(!folder.0.join("odd.tape").exists(), "{code}");
    }
    // A character that the control lacks, too, is told once, as what keeps the tape from being punched.
    // In EIA the % is the end of the record, which no text can hold.
    let ran = |text: &str, code: &str| {
        folder.write("odd.apt", GOOD.replace("FINI", &format!("{text}\nFINI")));
        folder.run(&["post", "odd.apt", "--machine", "fanuc-mill3", "--punch", code, "-o", "odd.tape"])
    };
    assert!(ran("PPRINT 50% FEED", "eia").stderr.contains("error[APT0898]: '%' is not in the EIA"));
    assert!(!ran("PPRINT 50% FEED", "iso").stderr.contains("APT0898"));
    for (text, told) in [("PPRINT BORE Ø 5", vec!["'Ø'"]), ("PPRINT Ø ØK?", vec!["'Ø'", "'?'"])] {
        folder.write("odd.apt", GOOD.replace("FINI", &format!("{text}\nFINI")));
        let plain = folder.run(&["post", "odd.apt", "--machine", "fanuc-mill3"]);
        assert!(plain.stderr.contains("warning[APT0890]: 'Ø'"), "{plain:?}");
        let ran = folder.run(&["post", "odd.apt", "--machine", "fanuc-mill3", "--punch", "eia"]);
        assert_eq!((ran.code, ran.stderr.matches("APT0890").count()), (1, 0), "{ran:?}");
        assert_eq!(ran.stderr.matches("error[APT0898]").count(), told.len(), "{ran:?}");
        assert!(
            told.iter().all(|one| ran.stderr.contains(&format!("APT0898]: {one} is not in the EIA"))),
            "{ran:?}"
        );
    }
    assert_eq!(folder.run(&["view", "good.apt", "-o", "path.png"]).code, 0);
    assert!(std::fs::read(folder.0.join("path.png")).unwrap().starts_with(b"\x89PNG"));
}

/// Every kind of lint can be set for one code in the project file, on the command line and in comments for a statement
/// and for the program.
#[test]
fn lints_are_set_per_code_per_line_and_per_file() {
    let twice = "P=POINT/1 2,3\nQ=POINT/4 5,6\nFROM/P\nGOTO/Q\nFINI\n";
    let told = |folder: &Folder, arguments: &[&str]| {
        let ran =
            folder.run(&[&["check", "a.apt", "--format", "json", "--dialect", "free"], arguments].concat());
        let report: Value =
            serde_json::from_str(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {ran:?}"));
        let of_code = |one: &&Value| one["code"] == "APT0952";
        let found = report["files"][0]["diagnostics"].as_array().unwrap().iter();
        let found =
            found.filter(of_code).map(|one| (one["isn"].as_u64().unwrap(), one["severity"].to_string()));
        (found.collect::<Vec<_>>(), ran.code)
    };
    let level = |isn: u64, severity: &str| (isn, format!("{severity:?}"));
    let both = |severity: &str| vec![level(1, severity), level(2, severity)];

    let folder = Folder::new("lint-settings");
    folder.write("a.apt", twice);
    assert_eq!(told(&folder, &[]), (both("warning"), 0));
    // On the command line.
    for (setting, found, code) in [
        ("APT0952=off", Vec::new(), 0),
        ("apt0952=hint", both("hint"), 0),
        ("APT0952=information", both("information"), 0),
        ("APT0952=error", both("error"), 1),
    ] {
        assert_eq!(told(&folder, &["--severity", setting]), (found, code), "{setting}");
    }
    let two = ["--severity", "APT0951=off", "--severity", "APT0952=off"];
    assert_eq!(told(&folder, &two), (Vec::new(), 0));
    for wrong in ["APT0952", "APT0952=loud", "APT9999=off", "=off"] {
        let ran = folder.run(&["check", "a.apt", "--severity", wrong]);
        assert!(ran.code == 2 && !ran.stderr.is_empty(), "{wrong}: {ran:?}");
    }
    // In the project file; what is typed wins.
    folder.write("apt-lsp.toml", "[severity]\nAPT0952 = \"off\"\n");
    assert_eq!(told(&folder, &[]), (Vec::new(), 0));
    assert_eq!(told(&folder, &["--severity", "APT0952=warning"]), (both("warning"), 0));
    folder.write("apt-lsp.toml", "[severity]\nAPT0952 = \"error\"\n");
    assert_eq!(told(&folder, &[]), (both("error"), 1));
    folder.write("apt-lsp.toml", "");
    // Per statement and per file.
    folder.write("a.apt", twice.replacen("2,3", "2,3 $$ apt-lsp: allow APT0952", 1));
    assert_eq!(told(&folder, &[]), (vec![level(2, "warning")], 0));
    folder.write("a.apt", format!("$$ apt-lsp: allow APT0952\n{twice}"));
    assert_eq!(told(&folder, &[]), (vec![level(3, "warning")], 0));
    folder.write("a.apt", format!("{twice}$$ apt-lsp: allow-file APT0952\n"));
    assert_eq!(told(&folder, &[]), (Vec::new(), 0));
}

/// A program, its CL text, its binary tape and the same with other vectors are one path; a place that is moved is told with its lines.
#[test]
fn paths_are_compared_whatever_they_are_written_in() {
    let folder = Folder::new("diff");
    folder.write(
        "old.apt",
        "PARTNO OLD\nUNITS/MM\nFROM/0,0,1\nRAPID,GOTO/0,0,0\nGOTO/10,0,0\nGOTO/10,10,0\nFINI\n",
    );
    folder.write(
        "new.apt",
        "PARTNO NEW\nUNITS/MM\n$$ in two\nFROM/0,0,1\nRAPID,GOTO/0,0,0\nGOTO/4,0,0\nGOTO/10,0,0\nGOTO/10,10,0\nFINI\n",
    );
    folder.write(
        "inches.cl",
        "UNITS/INCHES\nFROM/0,0,.0393700787\nRAPID\nGOTO/0,0,0\nGOTO/.393700787,0,0\nGOTO/.393700787,.4,0\n",
    );
    folder.write("good.apt", GOOD);
    for (program, output) in [("old.apt", "old.cl"), ("good.apt", "good.cltape")] {
        let ran = folder.run(&["run", program, "-o", output]);
        assert_eq!(ran.code, 0, "{ran:?}");
    }
    for (one, other) in
        [("old.apt", "old.apt"), ("old.apt", "new.apt"), ("old.cl", "new.apt"), ("good.cltape", "good.apt")]
    {
        let ran = folder.run(&["diff", one, other]);
        assert_eq!(ran.code, 0, "{one} {other}: {ran:?}");
        assert!(ran.stdout.contains("no difference"), "{ran:?}");
    }
    let ran = folder.run(&["diff", "old.apt", "inches.cl", "--tolerance", ".01"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    assert_eq!(
        ran.stdout,
        "A old.apt: 4 places, 21 long\nB inches.cl: 4 places, 21.16 long\n\n1. up to 0.16 apart, at (10, 10.16, 0)\n   \
         A stays at (10, 10, 0) (line 6)\n   \
         B from (10, 10.01, 0) (line 6) to (10, 10.16, 0) (line 6), 0.15 long\n\n\
         1 stretch differs, by up to 0.16 (tolerance 0.01)\n"
    );
    assert!(ran.stderr.contains("inches.cl is in inches; compared in mm"), "{ran:?}");
    let ran = folder.run(&["diff", "old.apt", "inches.cl", "--tolerance", ".01", "--format", "json"]);
    let told: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!((ran.code, &told["same"], &told["a"]["units"]), (1, &Value::Bool(false), &Value::from("mm")));
    let difference = &told["differences"][0];
    assert_eq!(difference["kind"], "places");
    assert!((difference["apart"].as_f64().expect("a number") - 0.16).abs() < 1e-3, "{difference}");
    assert_eq!(difference["b"]["to"]["range"]["start"]["line"], 5, "{difference}");
    assert_eq!(difference["a"]["to"]["isn"], 6, "{difference}");
    let ran = folder.run(&["diff", "old.apt", "inches.cl", "--tolerance", ".2"]);
    assert_eq!(ran.code, 0, "{ran:?}");
}

/// What a CL file has and the reader does not know leaves a gap, which is no agreement.
#[test]
fn what_is_not_read_of_a_path_is_told() {
    let folder = Folder::new("diff-gap");
    folder.write("a.cl", "FROM/0,0,0\nGOTO/1,0,0\nGOFWD/(CIRCLE/0,0,1),ON,(LINE/0,0,0,1)\nFINI\n");
    let ran = folder.run(&["diff", "a.cl", "a.cl", "--dialect", "cl"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.stdout.contains("no difference") && ran.stderr.contains("GOFWD"), "{ran:?}");
}

/// Places whose distances overflow are no agreement either.
#[test]
fn a_path_that_cannot_be_measured_is_told() {
    let folder = Folder::new("diff-far");
    folder.write("near.cl", "FROM/0,0,0\nGOTO/1,1,2\n");
    folder.write("far.cl", "FROM/0,0,0\nGOTO/1E300,0,0\nGOTO/1,1,2\n");
    let ran = folder.run(&["diff", "far.cl", "near.cl"]);
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{ran:?}");
    assert!(ran.stderr.contains("too far away"), "{ran:?}");
}

/// A program of which a tape can be made.
const FED: &str =
    "PARTNO GOOD\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/10\nFROM/0,0,1\nGOTO/1,0,1\nGOTO/1,2,1\nFINI\n";

#[test]
fn every_call_that_reads_a_program_says_its_dialect() {
    let folder = Folder::new("dialects");
    folder.write("good.apt", FED);
    for call in [
        &["--check", "good.apt"][..],
        &["run", "good.apt"],
        &["post", "good.apt", "--machine", "fanuc-mill3"],
        &["expand", "good.apt"],
        &["fmt", "--check", "good.apt"],
        &["fmt", "good.apt"],
        &["view", "good.apt", "-o", "out.svg"],
        &["diff", "good.apt", "good.apt"],
        &["convert", "good.apt", "--to", "nx"],
        &["tree", "good.apt"],
    ] {
        let ran = folder.run(call);
        assert!(ran.code == 0 && ran.stderr.contains("good.apt: dialect free"), "{call:?}: {ran:?}");
        let set = folder.run(&[call, &["--dialect", "apt4"]].concat());
        assert!(set.stderr.contains("good.apt: dialect apt4 (as set)"), "{call:?}: {set:?}");
        let unknown = folder.run(&[call, &["--dialect", "apt5"]].concat());
        let told = "there is no dialect `apt5`; there are free, apt3, apt4, cl";
        assert!(unknown.code == 2 && unknown.stderr.contains(told), "{call:?}: {unknown:?}");
    }
}

#[test]
fn folders_hold_files_of_every_system_and_none_is_checked_twice() {
    let folder = Folder::new("endings");
    for name in ["parts/a.apt", "parts/op.ncl.1", "parts/op.ncl.12", "parts/old.CLS"] {
        folder.write(name, GOOD);
    }
    for name in ["parts/readme.txt", "parts/a.apt.1", "parts/libx.so.1"] {
        folder.write(name, BAD);
    }
    let checked = folder.run(&["check", "parts", "--format", "json", "parts/a.apt"]);
    let report: Value = serde_json::from_str(&checked.stdout).unwrap();
    let files: Vec<_> =
        report["files"].as_array().unwrap().iter().map(|one| one["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["parts/a.apt", "parts/old.CLS", "parts/op.ncl.1", "parts/op.ncl.12"], "{checked:?}");
}

#[test]
fn a_program_names_its_machine() {
    let folder = Folder::new("machin");
    let named = |name: &str| FED.replace("FROM", &format!("MACHIN/{name},1\nFROM"));
    folder.write("named.apt", named("FANUC"));
    let made = folder.run(&["post", "named.apt"]);
    assert!(made.code == 0 && made.stdout.starts_with("%\nO1\n"), "{made:?}");
    // What is typed, and then what the project says, counts more.
    let typed = folder.run(&["post", "named.apt", "--machine", "linuxcnc-mill3"]);
    assert!(typed.code == 0 && !typed.stdout.contains("O1"), "{typed:?}");
    folder.write("apt-lsp.toml", "machine = \"linuxcnc-mill3\"\n");
    assert_eq!(folder.run(&["post", "named.apt"]).stdout, typed.stdout);
    let other = Folder::new("machin-other");
    other.write("other.apt", named("CINCY"));
    let unknown = other.run(&["post", "other.apt"]);
    assert!(unknown.code == 2 && unknown.stderr.contains("there is no machine named `CINCY`"), "{unknown:?}");
    assert_eq!(other.run(&["--check", "other.apt"]).code, 0, "a tape is nobody's wish there");
}

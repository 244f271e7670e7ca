//! What the control holds from block to block: feed modes and planes, cycles and the height that they go back to.

use apt_cldata::text::read_text;
use apt_post::{
    MachineDefinition, PostFindingKind, PostOptions, Severity, Tape, definition_file, machine, post,
};

/// Statements that stand before those under test.
const BEFORE: &str = "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\n";
/// The machines that are bundled.
const MACHINES: [&str; 3] = ["fanuc-mill3", "haas-mill3", "linuxcnc-mill3"];

fn tape_of(name: &str, statements: &str) -> Tape {
    tape_after(BEFORE, name, statements)
}

fn tape_after(before: &str, name: &str, statements: &str) -> Tape {
    let (records, errors) = read_text(&format!("{before}{statements}FINI\n"));
    assert_eq!(errors, vec![]);
    let machine = machine(name).unwrap_or_else(|error| panic!("{error}"));
    post(&records, &machine, &PostOptions::default())
}

/// The blocks without sequence numbers, with the mark of an optional block.
fn blocks(name: &str, statements: &str) -> Vec<String> {
    blocks_after(BEFORE, name, statements)
}

fn blocks_after(before: &str, name: &str, statements: &str) -> Vec<String> {
    let tape = tape_after(before, name, statements);
    assert!(tape.is_ok(), "{:?}\n{}", tape.findings, tape.text());
    let bare = |line: &str| {
        let words = line.split(' ').filter(|word| !word.trim_start_matches('/').starts_with('N'));
        let mark = if line.starts_with('/') { "/" } else { "" };
        format!("{mark}{}", words.collect::<Vec<&str>>().join(" "))
    };
    tape.text().lines().map(bare).collect()
}

fn at(blocks: &[String], text: &str) -> usize {
    let found = blocks.iter().position(|block| block.contains(text));
    found.unwrap_or_else(|| panic!("no {text} in {blocks:#?}"))
}

#[test]
fn feeds_per_revolution_and_inverse_times_keep_their_digits() {
    let statements = "RAPID\nGOTO/0,0,5\nFEDRAT/.15,MMPR\nGOTO/10,0,5\nFEDRAT/.04,MMPR\nGOTO/20,0,5\n\
                      FEDRAT/4,INVERS,AUTO\nGOTO/20,200,5\nFEDRAT/99.96,MMPM\nGOTO/20,0,5\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        for (block, feed) in [("X10.", "F.15"), ("X20.", "F.04"), ("Y200.", "F.02")] {
            let found = &blocks[at(&blocks, block)];
            assert!(found.ends_with(feed), "{name}: {found}");
        }
        assert!(blocks[at(&blocks, "G94 Y0.")].contains(" F"), "{name}: {blocks:#?}");
    }
}

#[test]
fn a_code_that_is_empty_is_not_written() {
    let text = definition_file("fanuc-mill3").unwrap_or_else(|error| panic!("{error}"));
    let text = text
        .replace("coolant_off = \"M9\"", "coolant_off = \"\"")
        .replace("plane_xy = \"G17\"", "plane_xy = \"\"");
    let machine = MachineDefinition::from_toml(&text).unwrap_or_else(|error| panic!("{error}"));
    let program = format!(
        "{BEFORE}RAPID\nGOTO/0,0,5\nCOOLNT/ON\nCYCLE/DRILL,DEPTH,5,RAPTO,3,MMPM,100\nGOTO/1,0,0\nCYCLE/OFF\nCOOLNT/OFF\nFINI\n"
    );
    let tape = post(&read_text(&program).0, &machine, &PostOptions::default());
    assert!(
        tape.text().lines().all(|line| line.len() > "N100 ".len() || line == "%" || line == "O1"),
        "{}",
        tape.text()
    );
}

#[test]
fn a_move_too_short_for_its_inverse_time_takes_the_shortest_that_there_is() {
    let statements = "RAPID\nGOTO/0,0,5\nFEDRAT/5000,INVERS,AUTO\nGOTO/.001,0,5\nGOTO/10,0,5\n";
    for (name, feed) in MACHINES.into_iter().zip(["F99999.9999", "F99999.9999", "F999999.9999"]) {
        let blocks = blocks(name, statements);
        assert!(blocks[at(&blocks, "X.001")].ends_with(feed), "{name}: {blocks:#?}");
    }
}

#[test]
fn a_feed_that_the_control_would_read_as_zero_is_told() {
    let tape = tape_of("fanuc-mill3", "RAPID\nGOTO/0,0,5\nFEDRAT/.001,INVERS,AUTO\nGOTO/100,0,5\n");
    let zero = |kind: &PostFindingKind| matches!(kind, PostFindingKind::FeedNotPositive { .. });
    assert!(tape.findings.iter().any(|finding| zero(&finding.kind)), "{}", tape.text());
}

#[test]
fn a_cycle_feeds_per_minute_whatever_was_before() {
    let statements = "RAPID\nGOTO/0,0,50\nFEDRAT/.15,MMPR\nGOTO/10,0,40\nCYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\n\
                      GOTO/10,0,0\nGOTO/20,0,0\nCYCLE/OFF\nGOTO/30,0,50\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        let (mode, hole, after) = (at(&blocks, "G94"), at(&blocks, "G81"), at(&blocks, "X30."));
        let mode = blocks[mode + 1..].iter().position(|block| block.contains("G94")).map(|n| n + mode + 1);
        assert!(mode.is_some_and(|mode| mode <= hole), "{name}: {blocks:#?}");
        assert!(blocks[hole].ends_with("F100."), "{name}: {}", blocks[hole]);
        assert!(
            blocks[after].contains("G95") && blocks[after].ends_with("F.15"),
            "{name}: {}",
            blocks[after]
        );
    }
}

#[test]
fn a_cycle_without_a_feed_takes_the_one_in_force_at_the_hole() {
    let statements = "RAPID\nGOTO/0,0,50\nCYCLE/DRILL,DEPTH,10,RAPTO,3\nFEDRAT/150,MMPM\nGOTO/10,0,0\nGOTO/20,0,0\n\
                      FEDRAT/.05,MMPR\nGOTO/30,0,0\nGOTO/40,0,0\nCYCLE/OFF\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        for (hole, feed) in [("X10.", Some("F150.")), ("X20.", None), ("X30.", Some("F50.")), ("X40.", None)]
        {
            let block = &blocks[at(&blocks, hole)];
            let written = block.split(' ').find(|word| word.starts_with('F'));
            assert_eq!(written, feed, "{name}: {block}");
        }
    }
}

#[test]
fn optional_blocks_are_not_the_only_ones_to_open_or_close_a_cycle() {
    let cycle = "RAPID\nGOTO/0,0,50\nCYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\n";
    let opened = format!("{cycle}OPSKIP/ON\nGOTO/10,0,0\nOPSKIP/OFF\nGOTO/20,0,0\nCYCLE/OFF\n");
    let closed =
        format!("{cycle}GOTO/10,0,0\nGOTO/20,0,0\nOPSKIP/ON\nCYCLE/OFF\nOPSKIP/OFF\nRAPID\nGOTO/0,0,50\n");
    for name in MACHINES {
        let opened = blocks(name, &opened);
        assert!(opened[at(&opened, "X20.")].contains("G81"), "{name}: {opened:#?}");
        let closed = blocks(name, &closed);
        assert!(closed.iter().any(|block| block == "G80"), "{name}: {closed:#?}");
    }
}

#[test]
fn an_arc_does_not_begin_where_optional_blocks_may_have_left_the_tool() {
    // Its centre is told from its start: the first chord is straight and ends where the tool is known to be.
    let statements = "FEDRAT/100,MMPM\nRAPID\nGOTO/0,0,0\nOPSKIP/ON\nGOTO/5,0,0\nOPSKIP/OFF\nCIRCLE/0,0,0,0,0,1,5\n\
                      GOTO/4.619398,1.913417,0\nGOTO/3.535534,3.535534,0\nGOTO/1.913417,4.619398,0\nGOTO/0,5,0\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        let first = at(&blocks, "X4.619");
        assert!(blocks[first].contains("G1"), "{name}: {blocks:#?}");
        assert!(blocks[first + 1].contains("G3"), "{name}: {blocks:#?}");
    }
}

#[test]
fn arcs_in_other_planes_are_chords_while_the_control_compensates() {
    let statements = "FEDRAT/100,MMPM\nRAPID\nGOTO/0,0,0\nCUTCOM/LEFT,1\nGOTO/5,0,0\nCIRCLE/0,0,0,0,1,0,5\n\
                      GOTO/4.619398,0,1.913417\nGOTO/3.535534,0,3.535534\nGOTO/0,0,5\nCUTCOM/OFF\nGOTO/0,20,5\n";
    for name in MACHINES {
        let tape = tape_of(name, statements);
        assert!(!tape.text().contains("G18"), "{name}: {}", tape.text());
        let told = |kind: &PostFindingKind| matches!(kind, PostFindingKind::ArcNotInPlane);
        assert!(tape.findings.iter().any(|finding| told(&finding.kind)), "{name}: {:?}", tape.findings);
    }
}

#[test]
fn holes_of_a_cycle_that_cannot_be_made_are_no_motions() {
    // Neither a type that the machine does not know nor one with a mistake, also behind one that is sound.
    for cycle in [
        "CYCLE/CIRCUL,DEPTH,10,RAPTO,3,MMPM,100\n",
        "CYCLE/DRILL,RAPTO,3,MMPM,100\n",
        "CYCLE/DRILL,DEPTH,-10,RAPTO,3,MMPM,100\n",
        "CYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\nGOTO/10,0,0\nCYCLE/DRILL,DEPTH,10,FOO,3\n",
    ] {
        let statements =
            format!("RAPID\nGOTO/0,0,50\n{cycle}GOTO/20,0,0\nGOTO/30,0,0\nCYCLE/OFF\nRAPID\nGOTO/40,0,50\n");
        for name in MACHINES {
            let tape = tape_of(name, &statements);
            assert!(
                !tape.text().contains("X20.") && !tape.text().contains("X30."),
                "{name}: {}",
                tape.text()
            );
            assert!(tape.text().contains("X40."), "{name}: {}", tape.text());
            let told: Vec<_> = tape.findings.iter().map(|finding| &finding.kind).collect();
            assert!(told.contains(&&PostFindingKind::HolesLeftOut { holes: 2 }), "{name}: {told:?}");
        }
    }
}

#[test]
fn a_cycle_word_without_holes_leaves_no_motion_out() {
    let sound = "CYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\n";
    for (statements, is_drilled) in [
        ("CYCLE/AUTO,OFF\nFEDRAT/90\nGOTO/20,0,0\n".to_owned(), false),
        ("CYCLE/MILL,DEPTH,10,RAPTO,3,MMPM,100\nFEDRAT/90\nGOTO/20,0,0\n".to_owned(), false),
        (format!("{sound}GOTO/10,0,0\nCYCLE/AVOID,5\nGOTO/20,0,0\nCYCLE/OFF\n"), true),
    ] {
        for name in MACHINES {
            let tape = tape_of(name, &format!("RAPID\nGOTO/0,0,50\n{statements}"));
            let text = tape.text();
            let hole = text.lines().find(|line| line.contains("X20.")).unwrap();
            assert_eq!(!hole.contains("Z0."), is_drilled, "{name}: {text}");
        }
    }
}

#[test]
fn a_cycle_is_not_resumed_behind_one_that_cannot_be_made() {
    let statements = "RAPID\nGOTO/0,0,50\nCYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\nGOTO/10,0,0\nCYCLE/CIRCUL,DEPTH,3,RAPTO,3,MMPM,9\n\
                      GOTO/20,0,0\nCYCLE/OFF\nCYCLE/ON\nGOTO/30,0,0\nCYCLE/OFF\n";
    for name in MACHINES {
        let tape = tape_of(name, statements);
        assert!(!tape.text().contains("X20.") && !tape.text().contains("X30."), "{name}: {}", tape.text());
    }
}

#[test]
fn a_hole_above_the_tool_lets_it_rise_before_it_goes_there() {
    // The control goes back to where it stood when the cycle began, and that must be where the next hole begins.
    let statements = "RAPID\nGOTO/0,0,3\nCYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\nGOTO/10,0,0\nGOTO/20,0,20\n\
                      GOTO/30,0,0\nCYCLE/OFF\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        let high = at(&blocks, "X20.");
        assert_eq!(blocks[high - 2..high], ["G80", "G0 Z23."], "{name}: {blocks:#?}");
        assert!(blocks[at(&blocks, "X30.")].starts_with("G98"), "{name}: {blocks:#?}");
    }
}

#[test]
fn compensation_is_in_the_plane_of_the_cut_also_after_an_arc_in_another() {
    let statements = "RAPID\nGOTO/5,0,0\nFEDRAT/150,MMPM\nCIRCLE/0,0,0,0,1,0,5\nGOTO/3.535534,0,3.535534\n\
                      GOTO/0,0,5\nCUTCOM/LEFT,1\nGOTO/0,20,5\nGOTO/20,20,5\nCUTCOM/OFF\nGOTO/30,30,5\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        let (arc, on) = (at(&blocks, "G18"), at(&blocks, "G41"));
        assert!(blocks[arc..=on].iter().any(|block| block.contains("G17")), "{name}: {blocks:#?}");
    }
}

/// END resets the control and may leave it in G91: what comes after it begins anew, and has an end of its own.
#[test]
fn a_motion_after_end_begins_anew() {
    let path = "RAPID\nGOTO/1,2,30\nFEDRAT/100\nGOTO/1,2,3\n";
    for name in MACHINES {
        let end = blocks(name, &format!("{path}END\n"));
        let again = blocks(name, &format!("{path}END\nSPINDL/1000,CLW\nGOTO/5,2,3\n"));
        assert!(
            tape_of(name, &format!("{path}END\nSPINDL/1000,CLW\nGOTO/5,2,3\n"))
                .findings
                .iter()
                .any(|found| found.kind == PostFindingKind::MotionAfterEnd)
        );
        let closing = end.len() - 1;
        assert_eq!(again[..closing], end[..closing], "{name}");
        let after = &again[closing..];
        assert!(after[1].starts_with("G17 ") && after[1].contains("G90"), "{name}: {after:?}");
        // The work offset is in force again: from the first block, or from one of its own.
        let offset = at(after, "G54");
        assert!((1..=2).contains(&offset), "{name}: {after:?}");
        let motion = offset.max(1) + 1;
        assert_eq!(after[motion], "G1 X5. Y2. Z3. F100.", "{name}: {after:?}");
        let last = at(&end, "M5");
        assert_eq!(after[motion + 1..], end[last..], "{name}");
    }
}

/// FINI is the end of the file, in `run` as on the tape.
#[test]
fn nothing_stands_behind_fini() {
    for name in MACHINES {
        let path = "RAPID\nGOTO/1,2,30\n";
        let tape = tape_of(name, &format!("{path}FINI\nCOOLNT/ON\nGOTO/5,2,3\nGOTO/6,2,3\n"));
        assert_eq!(tape.text(), tape_of(name, path).text(), "{name}");
        let after = tape.findings.iter().filter(|found| found.kind == PostFindingKind::AfterFini);
        assert_eq!(after.map(|found| found.isn).collect::<Vec<_>>(), [7], "{name}");
    }
}

/// The number of FEDRAT/INVERS is no feed per minute.
#[test]
fn behind_inverse_times_the_feed_before_them_is_in_force() {
    let path = "RAPID\nGOTO/0,0,3\nFEDRAT/100\nGOTO/1,0,3\nFEDRAT/INVERS,8\nGOTO/2,0,3\nFEDRAT/INVERS,9\nGOTO/3,0,3\nFEDRAT/INVERS,OFF\nGOTO/4,0,3\n";
    for name in MACHINES {
        let blocks = blocks(name, path);
        let block = &blocks[at(&blocks, " X4.")];
        assert!(block.starts_with("G94 ") && block.ends_with(" F100."), "{name}: {block}");
    }
}

/// HSM files begin with MODE/MILL; a mill has nothing to do for it.
#[test]
fn a_mill_mills() {
    for name in MACHINES {
        let path = "RAPID\nGOTO/0,0,3\n";
        let tape = tape_of(name, &format!("MODE/MILL\n{path}"));
        assert_eq!((tape.text(), tape.findings), (tape_of(name, path).text(), vec![]), "{name}");
        let turned = tape_of(name, &format!("MODE/TURN\n{path}"));
        assert!(matches!(turned.findings[0].kind, PostFindingKind::NotSupported { .. }), "{name}");
    }
}

#[test]
fn the_work_offset_stands_before_the_first_motion_of_any_kind() {
    let motions = [
        "FEDRAT/100\nGOTO/10,0,5\n",
        "RAPID\nGOTO/10,0,5\n",
        "FROM/0,0,5\nCYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,100\nGOTO/10,0,0\nCYCLE/OFF\n",
        "FROM/0,0,5\nCLEARP/50\nRETRCT\nRAPID\nGOTO/10,0,5\n",
    ];
    for name in MACHINES {
        for before in [BEFORE, "UNITS/MM\nSPINDL/1000,CLW\n"] {
            for motion in motions {
                let blocks = blocks_after(before, name, motion);
                let offset = at(&blocks, "G54");
                let moves = |block: &String| ["X", "Y", "Z"].iter().any(|axis| block.contains(axis));
                let first = blocks.iter().position(moves);
                assert!(first.is_some_and(|first| offset <= first), "{name}: {motion}: {blocks:#?}");
                assert_eq!(
                    blocks.iter().filter(|block| block.contains("G54")).count(),
                    1,
                    "{name}: {blocks:#?}"
                );
            }
        }
    }
}

#[test]
fn a_work_offset_of_the_program_stays() {
    for name in MACHINES {
        for motion in ["FEDRAT/100\nGOTO/10,0,5\n", "RAPID\nGOTO/10,0,5\n"] {
            let tape = tape_of(name, &format!("PREFUN/55\n{motion}"));
            assert!(
                tape.findings.iter().all(|one| one.kind.severity() != Severity::Error),
                "{:?}",
                tape.findings
            );
            let text = tape.text();
            let own = text.find("G55").unwrap_or_else(|| panic!("{text}"));
            assert!(!text[own..].contains("G54"), "{name}: {text}");
        }
    }
}

#[test]
fn a_tool_whose_place_is_not_known_still_goes_to_the_clearance_plane() {
    for name in MACHINES {
        for word in ["GOCLER", "RETRCT"] {
            for lost in ["GOHOME\n", "INSERT M60\n"] {
                let blocks = blocks(
                    name,
                    &format!("CLEARP/50\nFEDRAT/100\nRAPID\nGOTO/10,0,5\n{lost}{word}\nGOTO/20,0,5\n"),
                );
                let up = &blocks[at(&blocks, "Z50.")];
                assert!(["Z50.", "G0 Z50."].contains(&up.as_str()), "{name}: {word}: {blocks:#?}");
            }
        }
    }
}

#[test]
fn a_chamfer_is_as_deep_as_its_diameter_and_angle_make_it() {
    let hole = |depth: &str| {
        format!(
            "FEDRAT/100\nRAPID\nGOTO/0,0,50\nCYCLE/CSINK,{depth},MMPM,50,RAPTO,2,DWELL,1\nGOTO/10,10,0\nCYCLE/OFF\n"
        )
    };
    for name in MACHINES {
        for (depth, bottom) in [("FEDTO,8,90", "Z-4."), ("FEDTO,8", "Z-8."), ("FEDTO,-8", "Z-8.")] {
            let blocks = blocks(name, &hole(depth));
            let found = &blocks[at(&blocks, "G82")];
            assert!(found.split(' ').any(|word| word == bottom), "{name}: {depth}: {found}");
        }
        let tape = tape_of(name, &hole("FEDTO,8,180"));
        let wrong =
            PostFindingKind::BadValue { word: "CYCLE".into(), argument: "angle".into(), value: 180.0 };
        assert!(tape.findings.iter().any(|found| found.kind == wrong), "{:?}", tape.findings);
    }
}

#[test]
fn coolant_that_is_on_runs_for_the_next_tool_too() {
    let first =
        "SPINDL/900,CLW\nCOOLNT/ON\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,5\nGOTO/1,0,5\nSPINDL/OFF\nLOADTL/2\n";
    for name in MACHINES {
        let on = |coolant: &str, end: &str| {
            let statements = format!("{first}{coolant}SPINDL/900,CLW\n{end}");
            let blocks = blocks_after("UNITS/MM\nLOADTL/1\n", name, &statements);
            let second = blocks[at(&blocks, "T2 M6")..].to_vec();
            let count = |code: &str| second.iter().filter(|block| block.ends_with(code)).count();
            (count("M8"), count("M7"), count("M9"))
        };
        let motions = "RAPID\nGOTO/0,0,5\nGOTO/1,0,5\n";
        assert_eq!(on("", motions), (1, 0, 1), "{name}: it stays until it is changed");
        assert_eq!(on("COOLNT/ON\n", motions), (1, 0, 1), "{name}");
        assert_eq!(on("COOLNT/OFF\n", motions).0, 0, "{name}");
        assert_eq!(on("", "END\n").0, 0, "{name}: without a motion nobody needs it");
    }
}

#[test]
fn a_stated_circle_is_made_of_arcs_up_to_its_end() {
    for name in MACHINES {
        for radius in [1.7, 4.62, 41.325] {
            for (sweep, from) in (0..24).map(|step| (f64::from(step % 4 + 1) * 90.0, f64::from(step) * 0.7)) {
                let place = |angle: f64| {
                    let (sine, cosine) = angle.sin_cos();
                    format!(
                        "GOTO/{:.7},{:.7},0\n",
                        1.234_567_8 + radius * cosine,
                        2.345_678_9 + radius * sine
                    )
                };
                let end = if sweep == 360.0 { place(from) } else { place(from + sweep.to_radians()) };
                let statements = format!(
                    "FEDRAT/100,MMPM\nRAPID\n{}MOVARC/1.2345678,2.3456789,0,0,0,1,{radius},ANGLE,{sweep}\n{end}",
                    place(from)
                );
                let blocks = blocks(name, &statements);
                let arcs = &blocks[at(&blocks, "G3 ")..at(&blocks, "M5")];
                assert!(!arcs.iter().any(|block| block.contains("G1 ")), "{name} {statements} {arcs:#?}");
            }
        }
    }
}

/// A rapid aside is a motion in the plane of the compensation: it ends there, and not with the next cut or never.
#[test]
fn compensation_ends_on_a_rapid() {
    let statements = "FEDRAT/100,MMPM\nRAPID\nGOTO/0,0,5\nCUTCOM/LEFT,1\nGOTO/0,20,5\nGOTO/20,20,5\nCUTCOM/OFF\n\
                      RAPID\nGOTO/40,0,30\nGOTO/50,0,5\n";
    for name in MACHINES {
        let blocks = blocks(name, statements);
        let off = blocks.iter().position(|block| block.starts_with("G40 ") && block.contains(" X40"));
        let off = off.unwrap_or_else(|| panic!("{name}: {blocks:#?}"));
        // Up first where the axes do not arrive together.
        let up = at(&blocks, "Z30");
        assert!(up == off || up + 1 == off && !blocks[up].contains('X'), "{name}: {blocks:#?}");
        assert!(tape_of(name, statements).findings.is_empty(), "{name}");
    }
}

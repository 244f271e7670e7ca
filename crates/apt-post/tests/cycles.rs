//! CYCLE: which blocks each type of cycle and each couple becomes, on every machine.

use apt_cldata::text::read_text;
use apt_post::{MachineDefinition, PostFindingKind, PostOptions, Tape, machine, post};

const MACHINES: [&str; 3] = ["fanuc-mill3", "haas-mill3", "linuxcnc-mill3"];

fn tape_of(name: &str, direction: &str, statements: &str) -> Tape {
    let text = format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/600,{direction}\nRAPID\nGOTO/0,0,50\n{statements}CYCLE/OFF\nRAPID\nGOTO/0,0,50\nFINI\n"
    );
    let (records, errors) = read_text(&text);
    assert_eq!(errors, vec![]);
    let machine = machine(name).unwrap_or_else(|error| panic!("{error}"));
    post(&records, &machine, &PostOptions::default())
}

fn told(tape: &Tape) -> Vec<&PostFindingKind> {
    tape.findings.iter().map(|finding| &finding.kind).collect()
}

/// The blocks of the holes, without sequence numbers.
fn holes_of(name: &str, direction: &str, statements: &str) -> Vec<String> {
    let tape = tape_of(name, direction, statements);
    assert!(tape.is_ok(), "{name}: {:?}\n{}", tape.findings, tape.text());
    let bare = |line: &str| line.split_once(' ').map_or(line, |(_, rest)| rest).to_owned();
    let blocks: Vec<String> = tape.text().lines().map(bare).collect();
    let start = blocks.iter().position(|block| block.starts_with("G43")).map_or(0, |at| at + 1);
    blocks[start..].iter().take_while(|block| *block != "G80" && !block.starts_with("X0.")).cloned().collect()
}

#[test]
fn boring_by_hand_and_with_a_dwell_has_a_code_where_the_control_has_one() {
    let cycle =
        |kind: &str| format!("CYCLE/{kind},DEPTH,10,RAPTO,3,MMPM,60,DWELL,1\nGOTO/10,0,0\nGOTO/20,0,0\n");
    for (name, pause) in [("fanuc-mill3", "P1000"), ("haas-mill3", "P1.")] {
        for (kind, code) in [("BORE7", "G87"), ("BORE8", "G88"), ("BORE9", "G89")] {
            let first = format!("G98 {code} X10. Y0. Z-10. R3. {pause} F60.");
            assert_eq!(holes_of(name, "CLW", &cycle(kind)), [&first, "X20."], "{name} {kind}");
        }
    }
    // LinuxCNC lets nobody take a tool out by hand: the holes are left out, and it is said why.
    for kind in ["BORE7", "BORE8"] {
        let tape = tape_of("linuxcnc-mill3", "CLW", &cycle(kind));
        let no_code = PostFindingKind::CycleHasNoCode { cycle: kind.into() };
        assert_eq!(told(&tape), [&no_code, &PostFindingKind::HolesLeftOut { holes: 2 }]);
        assert!(!tape.text().contains("X10."), "{}", tape.text());
    }
}

#[test]
fn a_left_hand_tap_has_its_own_code() {
    let cycle = "CYCLE/REVERS,DEPTH,10,RAPTO,3,MMPR,1\nGOTO/10,0,0\nGOTO/20,0,0\n";
    let tap = "G98 G74 X10. Y0. Z-10. R3. F600.";
    assert_eq!(holes_of("fanuc-mill3", "CCLW", cycle), ["M29 S600", tap, "X20."]);
    assert_eq!(holes_of("haas-mill3", "CCLW", cycle), [tap, "X20."]);
    assert_eq!(holes_of("linuxcnc-mill3", "CCLW", cycle), [tap, "X20."]);
}

#[test]
fn a_tap_against_its_thread_is_told() {
    for name in MACHINES {
        for (kind, direction, wrong) in
            [("REVERS", "CLW", true), ("REVERS", "CCLW", false), ("TAP", "CLW", false), ("TAP", "CCLW", true)]
        {
            let tape =
                tape_of(name, direction, &format!("CYCLE/{kind},DEPTH,10,RAPTO,3,MMPR,1\nGOTO/10,0,0\n"));
            let kind = PostFindingKind::TapDirection { cycle: kind.into() };
            assert_eq!(told(&tape).contains(&&kind), wrong, "{name} {direction}: {:?}", told(&tape));
        }
    }
}

#[test]
fn fine_boring_steps_aside_before_it_comes_out() {
    let cycle = "CYCLE/SHIFT,DEPTH,10,RAPTO,3,MMPM,60,OFFSET,.5,DWELL,1\nGOTO/10,0,0\nGOTO/20,0,0\n";
    let first = "G98 G76 X10. Y0. Z-10. R3. Q.5 P1000 F60.";
    assert_eq!(holes_of("fanuc-mill3", "CLW", cycle), [first, "X20."]);
    assert_eq!(holes_of("haas-mill3", "CLW", cycle), [&first.replace("P1000", "P1."), "X20."]);
    // G76 of LinuxCNC cuts threads.
    let hole = |x: &str, aside: &str| {
        let blocks = ["X", "Z3.", "G1 Z-10. F60.", "G4 P1.", "M19 R0", "G0 X", "Z50.", "X", "S600 M3"];
        let mut blocks: Vec<String> = blocks.map(str::to_owned).into();
        blocks[0] += x;
        blocks[5] += aside;
        blocks[7] += x;
        blocks
    };
    let mut expected = hole("10.", "10.5");
    let mut second = hole("20.", "20.5");
    second[2] = "G1 Z-10.".to_owned();
    expected.append(&mut second);
    assert_eq!(holes_of("linuxcnc-mill3", "CLW", cycle), expected);
    let turned = "CYCLE/SHIFT,DEPTH,10,RAPTO,3,MMPM,60,OFFSET,-.3,.4,ORIENT,90\nGOTO/10,0,0\n";
    let expected = ["X10.", "Z3.", "G1 Z-10. F60.", "M19 R90.", "G0 X9.7 Y.4", "Z50.", "X10. Y0.", "S600 M3"];
    assert_eq!(holes_of("linuxcnc-mill3", "CLW", turned), expected);
    for name in MACHINES {
        let without = tape_of(name, "CLW", "CYCLE/SHIFT,DEPTH,10,RAPTO,3,MMPM,60\nGOTO/10,0,0\n");
        let missing = PostFindingKind::MissingArgument { word: "CYCLE".into(), missing: "OFFSET".into() };
        assert!(told(&without).contains(&&missing), "{name}: {:?}", told(&without));
        assert!(!without.text().contains("X10."), "{name}: {}", without.text());
    }
}

#[test]
fn what_a_control_does_not_take_of_a_cycle_is_told() {
    let unused =
        |argument: &str| PostFindingKind::ArgumentNotUsed { word: "CYCLE".into(), argument: argument.into() };
    for (name, couples, argument) in [
        ("fanuc-mill3", "SHIFT,DEPTH,10,OFFSET,.5,ORIENT,90", "ORIENT"),
        ("fanuc-mill3", "SHIFT,DEPTH,10,OFFSET,.3,.4", "the direction of OFFSET"),
        ("haas-mill3", "DRILL,DEPTH,10,OFFSET,.5", "OFFSET"),
        ("linuxcnc-mill3", "DRILL,DEPTH,10,ORIENT,90", "ORIENT"),
    ] {
        let tape = tape_of(name, "CLW", &format!("CYCLE/{couples},RAPTO,3,MMPM,60\nGOTO/10,0,0\n"));
        assert_eq!(told(&tape), [&unused(argument)], "{name} {couples}");
    }
    // The amount is what is left of a direction.
    let holes =
        holes_of("fanuc-mill3", "CLW", "CYCLE/SHIFT,DEPTH,10,OFFSET,.3,.4,RAPTO,3,MMPM,60\nGOTO/10,0,0\n");
    assert_eq!(holes, ["G98 G76 X10. Y0. Z-10. R3. Q.5 P0 F60."]);
}

#[test]
fn a_hole_that_is_made_several_times_is() {
    for couple in ["TIMES", "REPEAT"] {
        let cycle = format!("CYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,60,{couple},3\nGOTO/10,0,0\nGOTO/20,0,0\n");
        for (name, letter) in [("fanuc-mill3", "K"), ("haas-mill3", "L"), ("linuxcnc-mill3", "L")] {
            let first = format!("G98 G81 X10. Y0. Z-10. R3. F60. {letter}3");
            assert_eq!(holes_of(name, "CLW", &cycle), [first, format!("X20. {letter}3")], "{name}");
        }
    }
    // Where the cycle is made of moves, so is each turn.
    let shift = "CYCLE/SHIFT,DEPTH,10,RAPTO,3,MMPM,60,OFFSET,.5,TIMES,2\nGOTO/10,0,0\n";
    let turns = holes_of("linuxcnc-mill3", "CLW", shift);
    assert_eq!(turns.iter().filter(|block| block.contains("M19")).count(), 2, "{turns:#?}");
    let tap = "CYCLE/TAP,DEPTH,10,RAPTO,3,MMPR,1,TIMES,2\nGOTO/10,0,0\n";
    let turns = holes_of("linuxcnc-mill3", "CLW", tap);
    assert_eq!(turns.iter().filter(|block| block.contains("G33.1")).count(), 2, "{turns:#?}");
    for times in ["0", "-1", "1.5"] {
        let tape = tape_of(
            "fanuc-mill3",
            "CLW",
            &format!("CYCLE/DRILL,DEPTH,10,RAPTO,3,MMPM,60,TIMES,{times}\nGOTO/10,0,0\n"),
        );
        assert!(
            told(&tape).iter().any(
                |kind| matches!(kind, PostFindingKind::BadValue { argument, .. } if argument == "TIMES")
            ),
            "{times}: {:?}",
            told(&tape)
        );
    }
}

#[test]
fn a_type_that_no_machine_makes_is_told_as_such() {
    for name in MACHINES {
        for (kind, known) in
            [("CIRCUL", true), ("MILL", true), ("AVOID", true), ("AUTO", true), ("BROACH", false)]
        {
            let tape = tape_of(name, "CLW", &format!("CYCLE/{kind},DEPTH,10,RAPTO,3,MMPM,60\n"));
            let expected = match known {
                true => PostFindingKind::CycleHasNoCode { cycle: kind.into() },
                false => PostFindingKind::UnknownArgument { word: "CYCLE".into(), argument: kind.into() },
            };
            assert_eq!(told(&tape).first(), Some(&&expected), "{name}");
        }
    }
}

#[test]
fn the_sign_of_a_bare_number_counts() {
    for (cycle, value) in [("DRILL,-10,60,MMPM,3", -10.0), ("DRILL,0,60,MMPM,3", 0.0)] {
        let tape = tape_of("fanuc-mill3", "CLW", &format!("CYCLE/{cycle}\nGOTO/10,0,0\n"));
        let bad = PostFindingKind::BadValue { word: "CYCLE".into(), argument: "DEPTH".into(), value };
        assert!(told(&tape).contains(&&bad), "{cycle}: {:?}", told(&tape));
    }
    for (couple, value) in [("RAPTO", -3.0), ("DWELL", -1.0), ("STEP", -2.0), ("STEP", 0.0)] {
        let cycle = format!("CYCLE/DEEP,DEPTH,10,MMPM,60,RAPTO,3,STEP,2,{couple},{value}\nGOTO/10,0,0\n");
        let tape = tape_of("fanuc-mill3", "CLW", &cycle);
        let bad = PostFindingKind::BadValue { word: "CYCLE".into(), argument: couple.into(), value };
        assert!(told(&tape).contains(&&bad), "{cycle}: {:?}", told(&tape));
    }
    let tape = tape_of("fanuc-mill3", "CLW", "CYCLE/DRILL,10,-60,MMPM,3\nGOTO/10,0,0\n");
    assert!(told(&tape).contains(&&PostFindingKind::FeedNotPositive { value: -60.0 }), "{:?}", told(&tape));
    // The offset of NX is signed.
    let holes = holes_of("fanuc-mill3", "CLW", "CYCLE/DRILL,FEDTO,-10,RAPTO,3,MMPM,60\nGOTO/10,0,0\n");
    assert_eq!(holes, ["G98 G81 X10. Y0. Z-10. R3. F60."]);
}

#[test]
fn a_cycle_that_cannot_be_made_is_left_on_like_any_other() {
    for name in MACHINES {
        for (end, word) in [("SPINDL/OFF\nLOADTL/2\n", "LOADTL"), ("FINI\n", "FINI")] {
            let text = format!(
                "UNITS/MM\nLOADTL/1\nSPINDL/600,CLW\nRAPID\nGOTO/0,0,50\nCYCLE/CIRCUL,DEPTH,10,RAPTO,3,MMPM,60\nGOTO/10,0,0\n{end}"
            );
            let (records, _) = read_text(&text);
            let machine = machine(name).unwrap_or_else(|error| panic!("{error}"));
            let tape = post(&records, &machine, &PostOptions::default());
            let left_on = PostFindingKind::CycleLeftOn { cycle: "CIRCUL".into(), word: word.into() };
            assert!(told(&tape).contains(&&left_on), "{name} {word}: {:?}", told(&tape));
            assert!(
                told(&tape).contains(&&PostFindingKind::HolesLeftOut { holes: 1 }),
                "{name}: {:?}",
                told(&tape)
            );
        }
    }
}

#[test]
fn a_boring_tool_stands_still_on_its_way_out_of_moves() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/machines/linuxcnc-mill3.toml");
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{error}"));
    let text = text.replace("[cycles.bore]", "[cycles.bore-of-another-kind]");
    let machine = MachineDefinition::from_toml(&text).unwrap_or_else(|error| panic!("{error}"));
    let (records, _) = read_text(
        "UNITS/MM\nLOADTL/1\nSPINDL/600,CLW\nRAPID\nGOTO/0,0,50\nCYCLE/BORE,DEPTH,10,RAPTO,3,MMPM,60\nGOTO/10,0,0\nFINI\n",
    );
    let tape = post(&records, &machine, &PostOptions::default()).text();
    assert!(tape.contains("N80 G1 Z-10. F60.\nN90 M5\nN100 G0 Z50.\nN110 S600 M3\n"), "{tape}");
}

#[test]
fn deep_drills_as_the_system_of_the_file_means_it() {
    let (records, _) = read_text(
        "UNITS/MM\nLOADTL/1\nSPINDL/600,CLW\nRAPID\nGOTO/0,0,50\nCYCLE/DEEP,DEPTH,10,STEP,3,RAPTO,3,MMPM,60\nGOTO/10,0,0\n\
         CYCLE/THRU,DEPTH,10,STEP,3,RAPTO,3,MMPM,60\nGOTO/20,0,0\nFINI\n",
    );
    for name in MACHINES {
        let machine = machine(name).unwrap_or_else(|error| panic!("{error}"));
        let text = |deep_breaks_chips| {
            let options = PostOptions { deep_breaks_chips, ..PostOptions::default() };
            post(&records, &machine, &options).text()
        };
        assert!(text(true).contains("G73 X10.") && text(true).contains("G83 X20."), "{}", text(true));
        assert!(text(false).contains("G83 X10.") && text(false).contains("G83 X20."), "{}", text(false));
    }
}

/// All blocks of a tape without sequence numbers, from the first hole on.
fn all_blocks(name: &str, statements: &str) -> Vec<String> {
    let tape = tape_of(name, "CLW", statements);
    assert_eq!(told(&tape), Vec::<&PostFindingKind>::new(), "{name}\n{}", tape.text());
    let text = tape.text();
    text.lines().filter_map(|line| line.split_once(' ')).map(|(_, rest)| rest.to_owned()).collect()
}

/// A thread has one pitch: where the spindle turns faster from one hole to the next the feed does, too, and the control is told both anew out of the cycle.
#[test]
fn a_tap_keeps_its_pitch_when_the_spindle_changes_its_speed() {
    for feed in ["MMPM,900", "MMPR,1.5", "TPI,16.93333333333333"] {
        let statements = format!(
            "CYCLE/TAP,DEPTH,10,RAPTO,3,{feed}\nGOTO/10,0,0\nSPINDL/800,CLW\nGOTO/20,0,0\nGOTO/30,0,0\n"
        );
        for (name, pre) in [("fanuc-mill3", Some("M29 S800")), ("haas-mill3", None)] {
            let blocks = all_blocks(name, &statements);
            let faster = blocks.iter().position(|block| block == "S800 M3");
            let faster = faster.unwrap_or_else(|| panic!("{name}: {blocks:#?}"));
            assert!(
                blocks[faster - 2].contains("G84 X10.") && blocks[faster - 2].contains("F900."),
                "{name}: {blocks:#?}"
            );
            assert_eq!(blocks[faster - 1], "G80", "{name}: {blocks:#?}");
            let next: Vec<&str> = blocks[faster + 1..].iter().map(String::as_str).collect();
            let next = match pre {
                Some(pre) => next.strip_prefix(&[pre]),
                None => Some(next.as_slice()),
            };
            let Some([tapped, after, ..]) = next else { panic!("{name}: {blocks:#?}") };
            assert!(tapped.contains("G84 X20.") && tapped.ends_with("F1200."), "{name}: {blocks:#?}");
            assert_eq!(*after, "X30.", "{name}: {blocks:#?}");
        }
        let taps = all_blocks("linuxcnc-mill3", &statements);
        let taps: Vec<&String> = taps.iter().filter(|block| block.contains("G33.1")).collect();
        assert!(taps.len() == 3 && taps.iter().all(|block| block.ends_with("K1.5")), "{taps:?}");
    }
}

/// What a cycle goes in a revolution it goes at every speed.
#[test]
fn a_feed_per_revolution_of_a_cycle_follows_the_spindle() {
    let statements =
        "CYCLE/DRILL,DEPTH,10,RAPTO,3,MMPR,.1\nGOTO/10,0,0\nSPINDL/800,CLW\nGOTO/20,0,0\nGOTO/30,0,0\n";
    for name in MACHINES {
        let blocks = all_blocks(name, statements);
        for (hole, feed) in [("X10.", Some("F60.")), ("X20.", Some("F80.")), ("X30.", None)] {
            let block = blocks.iter().find(|block| {
                block.split(' ').any(|word| word == hole || word == hole.trim_end_matches('.'))
            });
            let block = block.unwrap_or_else(|| panic!("{name}: no {hole} in {blocks:#?}"));
            let written = block.split(' ').find(|word| word.starts_with('F'));
            assert_eq!(
                written.map(|feed| feed.trim_end_matches('.')),
                feed.map(|feed| feed.trim_end_matches('.')),
                "{name}: {block}"
            );
        }
    }
}

//! `run --explain-motion`: the story of each motion, for people and in JSON, and only when asked for.

mod support;

use serde_json::Value;

use support::Folder;

const PROGRAM: &str = "PARTNO STORY\nCUTTER/.5\nL1=LINE/0,0,1,0\nL2=LINE/6,0,6,1\nFROM/2,2,0\nGO/TO,L1\n\
                       TLLFT,GOLFT/L1,TO,L2\nGOTO/0,0,9\nFINI\n";

#[test]
fn people_read_how_each_motion_was_computed() {
    let folder = Folder::new("story-human");
    folder.write("story.apt", PROGRAM);
    let plain = folder.run(&["run", "story.apt"]);
    assert!(!plain.stdout.contains("computed in closed form"), "{plain:?}");
    let told = folder.run(&["run", "story.apt", "--explain-motion"]);
    assert_eq!(told.code, 0, "{told:?}");
    for line in [
        "7 TLLFT,GOLFT/L1,TO,L2",
        "motion computed in closed form",
        "drive surface L1: a LINE",
        "vector 1 ends TO the check surface (length 3.75)",
    ] {
        assert!(told.stdout.contains(line), "no {line:?} in {}", told.stdout);
    }
}

#[test]
fn json_has_the_story_with_its_motion_only_when_asked_for() {
    let folder = Folder::new("story-json");
    folder.write("story.apt", PROGRAM);
    let motions = |arguments: &[&str]| -> Vec<Value> {
        let ran = folder.run(arguments);
        let report: Value = serde_json::from_str(&ran.stdout).expect("JSON");
        report["motions"].as_array().expect("motions").clone()
    };
    let plain = motions(&["run", "story.apt", "--format", "json"]);
    assert!(plain.iter().all(|motion| motion.get("story").is_none()), "{plain:?}");
    let told = motions(&["run", "story.apt", "--format", "json", "--explain-motion"]);
    let ends: Vec<&str> = told
        .iter()
        .map(|motion| {
            motion["story"].as_array().and_then(|lines| lines.last()).and_then(Value::as_str).expect("a line")
        })
        .collect();
    assert_eq!(
        ends,
        [
            "vector 1 ends at the start-up position (length 1.75)",
            "vector 1 ends TO the check surface (length 3.75)"
        ]
    );
}

//! Runs a tape through the stand-alone interpreter of LinuxCNC and reads its canonical calls.

mod follow;
pub(crate) mod rotary;

use std::{
    path::PathBuf,
    process::Command,
    sync::atomic::{AtomicU32, Ordering},
};

pub(crate) use follow::{TOLERANCE, follow, near};

/// A canonical call that says something about the path.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Call {
    Traverse([f64; 3]),
    Feed([f64; 3]),
    /// End, centre in the plane (the third coordinate is meaningless), turns with sign, third axis.
    Arc {
        end: [f64; 3],
        center: [f64; 3],
        turns: i32,
        axis: usize,
    },
    FeedRate(f64),
    Tap([f64; 3]),
    Dwell(f64),
    SpindleClockwise,
    SpindleOff,
    Flood,
    Tool(i32),
    End,
}

/// Runs a tape to its end.
///
/// # Panics
/// Without the interpreter, and when it refuses the tape.
pub(crate) fn interpret(tape: &str, tools: &[u32]) -> Vec<Call> {
    let output = run(tape, tools);
    let calls = calls(&output);
    assert_eq!(calls.last(), Some(&Call::End), "the interpreter stopped:\n{output}\n{tape}");
    calls
}

/// What the interpreter prints.
pub(crate) fn run(tape: &str, tools: &[u32]) -> String {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder =
        PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("rs274-{}-{number}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let table: String = tools.iter().map(|tool| format!("T{tool} P{tool} Z0 D0.25\n")).collect();
    // The parameter file is rewritten by every run, so each starts from an empty one.
    std::fs::write(folder.join("tool.tbl"), table).unwrap();
    std::fs::write(folder.join("rs274.var"), "").unwrap();
    std::fs::write(folder.join("tape.ngc"), tape).unwrap();
    let result = Command::new("rs274")
        .current_dir(&folder)
        // The interpreter shares its tool table through a file in the home folder; runs side by side would mix theirs.
        .env("HOME", &folder)
        .args(["-t", "tool.tbl", "-v", "rs274.var", "-g", "tape.ngc"])
        .output()
        .unwrap_or_else(|error| {
            panic!(
                "cannot start `rs274` ({error}): install the Debian package linuxcnc-uspace, which brings it"
            )
        });
    std::fs::remove_dir_all(&folder).unwrap();
    String::from_utf8_lossy(&result.stdout).into_owned() + &String::from_utf8_lossy(&result.stderr)
}

fn calls(output: &str) -> Vec<Call> {
    let mut plane = 2;
    let mut found = Vec::new();
    for line in output.lines() {
        // ` 22 N40    STRAIGHT_TRAVERSE(-1.0000, 0.0000, ...)`
        let Some((head, rest)) = line.split_once('(') else { continue };
        let Some(name) = head.split_whitespace().last() else { continue };
        let rest = rest.trim_end().trim_end_matches(')');
        let numbers: Vec<f64> = rest.split([',', ' ']).filter_map(|text| text.trim().parse().ok()).collect();
        match name {
            "SELECT_PLANE" => {
                plane = match rest {
                    "CANON_PLANE_XY" => 2,
                    "CANON_PLANE_XZ" => 1,
                    "CANON_PLANE_YZ" => 0,
                    other => panic!("plane {other}"),
                };
            }
            "STRAIGHT_TRAVERSE" => found.push(Call::Traverse([numbers[0], numbers[1], numbers[2]])),
            "STRAIGHT_FEED" => found.push(Call::Feed([numbers[0], numbers[1], numbers[2]])),
            "ARC_FEED" => {
                let (u, v) = ((plane + 1) % 3, (plane + 2) % 3);
                let (mut end, mut center) = ([0.0; 3], [0.0; 3]);
                (end[u], end[v], end[plane]) = (numbers[0], numbers[1], numbers[5]);
                (center[u], center[v]) = (numbers[2], numbers[3]);
                found.push(Call::Arc { end, center, turns: numbers[4] as i32, axis: plane });
            }
            "SET_FEED_RATE" if numbers[0] > 0.0 => found.push(Call::FeedRate(numbers[0])),
            "RIGID_TAP" => found.push(Call::Tap([numbers[0], numbers[1], numbers[2]])),
            "DWELL" => found.push(Call::Dwell(numbers[0])),
            "START_SPINDLE_CLOCKWISE" => found.push(Call::SpindleClockwise),
            "STOP_SPINDLE_TURNING" => found.push(Call::SpindleOff),
            "FLOOD_ON" => found.push(Call::Flood),
            "CHANGE_TOOL" => found.push(Call::Tool(numbers[0] as i32)),
            "PROGRAM_END" => found.push(Call::End),
            _ => {}
        }
    }
    found
}

//! The real binary as a server over its standard streams.

mod support;

use serde_json::{Value, json};

use support::Server;

const URI: &str = "file:///nowhere/part.apt";

const PART: &str = "\
PARTNO BURST
P1=POINT/1,2,0
L1=LINE/P1,ATANGL,30
C1=CIRCLE/0,0,5
FINI
";

#[test]
fn the_server_introduces_itself_and_ends_in_order() {
    let mut server = Server::start(&[]);
    let answer = server.ask("initialize", json!({ "processId": null, "capabilities": {} })).unwrap();
    assert_eq!(answer["serverInfo"]["name"], "apt-lsp");
    assert_eq!(answer["capabilities"]["textDocumentSync"], json!({ "openClose": true, "change": 2 }));
    server.tell("initialized", json!({}));
    assert_eq!(server.ask("shutdown", Value::Null), Ok(Value::Null));
    server.tell("exit", Value::Null);
    assert_eq!(server.ended().code(), Some(0));
}

#[test]
fn exit_without_shutdown_and_the_end_of_input_end_the_process() {
    let mut server = Server::initialized(&json!({}));
    server.tell("exit", Value::Null);
    assert_eq!(server.ended().code(), Some(1));

    let mut server = Server::initialized(&json!({}));
    server.open(URI, PART);
    server.close_input();
    assert_eq!(server.ended().code(), Some(1));

    let mut server = Server::initialized(&json!({}));
    server.ask("shutdown", Value::Null).unwrap();
    server.close_input();
    assert_eq!(server.ended().code(), Some(0));

    let mut silent = Server::start(&["--stdio"]);
    silent.close_input();
    assert_eq!(silent.ended().code(), Some(1));
}

#[cfg(unix)]
#[test]
fn the_server_does_not_outlive_its_editor() {
    let mut editor = std::process::Command::new("sleep").arg("600").spawn().unwrap();
    let mut server = Server::start(&["--stdio"]);
    server.ask("initialize", json!({ "processId": editor.id(), "capabilities": {} })).unwrap();
    server.tell("initialized", json!({}));
    editor.kill().unwrap();
    editor.wait().unwrap();
    assert_eq!(server.ended().code(), Some(1));
}

#[test]
fn two_hundred_edits_with_hovers_between_end_with_the_same_text_and_no_stale_answer() {
    let mut server = Server::initialized(&json!({}));
    server.open(URI, PART);
    let mut text = PART.to_owned();
    let mut hovers = Vec::new();
    for turn in 0..200_usize {
        // The first coordinate of P1 gets a new value each time; every fifth turn the line moves down.
        let line = text.lines().position(|line| line.starts_with("P1=")).unwrap();
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let from = "P1=POINT/".len();
        let to = from + text[start + from..].find(',').unwrap();
        let value = format!("{}", 1000 + turn);
        text.replace_range(start + from..start + to, &value);
        server.change(URI, 2 * turn as i64 + 2, line, from, to, &value);
        let mut line = line;
        if turn % 5 == 0 {
            text.insert_str(start, "$$ 😀 remark\n");
            server.change(URI, 2 * turn as i64 + 3, line, 0, 0, "$$ 😀 remark\n");
            line += 1;
        }
        hovers.push((server.begin_hover(URI, line, 1), value));
    }
    for (hover, value) in hovers {
        match server.answer(hover) {
            Ok(answer) => {
                let told = answer["contents"]["value"].as_str().unwrap();
                assert!(told.contains(&value), "{told:?} does not tell {value}");
            }
            // An answer that a newer edit has overtaken may be refused, but never be wrong.
            Err(error) => assert_eq!(error["code"], -32801, "{error}"),
        }
    }
    server.open("file:///nowhere/fresh.apt", &text);
    assert_eq!(server.tree(URI), server.tree("file:///nowhere/fresh.apt"));
    let last = server.begin_hover(URI, text.lines().position(|line| line.starts_with("P1=")).unwrap(), 1);
    let last = server.answer(last).unwrap();
    assert!(last["contents"]["value"].as_str().unwrap().contains("1199"), "{last}");
}

#[test]
fn mistakes_are_pushed_with_their_version_and_go_when_they_are_mended() {
    let mut server = Server::initialized(&json!({}));
    server.open(URI, "PARTNO X\nP1=POINT/1,2\nL1=LINE/P1,P9\nFINI\n");
    let pushed = |version: i64| {
        move |message: &Value| {
            message["method"] == "textDocument/publishDiagnostics" && message["params"]["version"] == version
        }
    };
    let errors = |message: &Value| {
        let all = message["params"]["diagnostics"].as_array().unwrap();
        all.iter().filter(|found| found["severity"] == 1).cloned().collect::<Vec<_>>()
    };
    let found = errors(&server.wait(pushed(1)));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0]["range"]["start"]["line"], 2);
    assert!(found[0]["code"].as_str().unwrap().starts_with("APT"), "{found:?}");
    server.change(URI, 2, 2, 11, 13, "(POINT/3,4)");
    let mended = server.wait(pushed(2));
    assert_eq!(errors(&mended), Vec::<Value>::new());
}

#[test]
fn broken_messages_do_not_end_the_server() {
    let mut server = Server::initialized(&json!({}));
    server.open(URI, PART);
    for broken in ["Content-Length: 5\r\n\r\n{oops", "garbage\r\n\r\n", "Content-Length: 2\r\n\r\n[]"] {
        server.write(broken.as_bytes());
        let answer = server.wait(|message| message["id"].is_null() && message.get("error").is_some());
        assert!(answer["error"]["code"].as_i64().unwrap() < 0);
    }
    assert!(!server.tree(URI).is_empty());
}

#[test]
fn a_run_reports_points_and_a_range_restricts_it() {
    let mut server = Server::initialized(&json!({}));
    server.open(URI, "PARTNO RUN\nFROM/0,0,1\nGOTO/1,0,1\nGOTO/1,2,1\nFINI\n");
    let whole = server.ask("apt/runMotion", json!({ "uri": URI })).unwrap();
    assert_eq!(whole["ok"], true, "{whole}");
    assert_eq!(whole["totals"]["points"], 3);
    let range = json!({ "start": { "line": 3, "character": 0 }, "end": { "line": 3, "character": 4 } });
    let params = json!({ "command": "apt.runMotion", "arguments": [{ "uri": URI, "range": range }] });
    let part = server.ask("workspace/executeCommand", params).unwrap();
    let motions: Vec<_> =
        part["cl"].as_array().unwrap().iter().filter(|record| record["type"] == "go").cloned().collect();
    assert_eq!(motions.len(), 1, "{part}");
    assert_eq!(motions[0]["isn"], 4);
}

#[test]
fn a_file_that_is_not_open_can_be_run() {
    let folder = support::Folder::new("run-closed");
    let path = folder.write("a.apt", "PARTNO RUN\nFROM/0,0,1\nGOTO/1,0,1\nFINI\n");
    let mut server = Server::initialized(&json!({}));
    let uri = format!("file://{}", path.display());
    let report = server.ask("apt/runMotion", json!({ "uri": uri })).unwrap();
    assert_eq!(report["totals"]["points"], 2);
    assert_eq!(
        server.ask("apt/runMotion", json!({ "uri": "file:///no/such.apt" })).unwrap_err()["code"],
        -32602
    );
}

/// What counts for a file that is open counts for one that is not: the settings of the editor and the texts of open files;
/// and its bytes are read as the command line reads them.
#[test]
fn a_file_that_is_not_open_is_read_as_an_open_one_and_as_by_the_command_line() {
    let folder = support::Folder::new("run-as-open");
    let path = folder.write("a.apt", "PARTNO RUN\nUNITS/MM\nFROM/0,0,1\nINCLUD/WAY\nFINI\n");
    let uri = |path: &std::path::Path| format!("file://{}", path.display());
    let way = folder.write("WAY.apt", "GOTO/1,0,1\n");
    let mut server = Server::start(&["--stdio"]);
    let options = json!({ "machine": "linuxcnc-mill3" });
    server.ask("initialize", json!({ "capabilities": {}, "initializationOptions": options })).unwrap();
    server.tell("initialized", json!({}));
    server.open(&uri(&way), "GOTO/1,0,1\nGOTO/2,0,1\n");
    let report = server.ask("apt/runMotion", json!({ "uri": uri(&path) })).unwrap();
    assert_eq!(report["totals"]["points"], 3, "the text of the open file counts: {report}");
    assert_eq!(report["tape"]["machine"], "linuxcnc-mill3", "{report}");

    let latin = folder.write("latin.apt", b"PARTNO \xe9\nFROM/0,0,1\nFINI\n");
    let report = server.ask("apt/runMotion", json!({ "uri": uri(&latin) })).unwrap();
    assert_eq!(report["cl"][0]["words"][1], "\u{e9}", "{report}");

    folder.write("b.apt", "PARTNO TAPE\nFROM/0,0,1\nGOTO/1,0,1\nFINI\n");
    let made = folder.run(&["run", "b.apt", "--format", "cltape", "-o", "a.tap"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let tape = folder.0.join("a.tap");
    let tree = server.ask("apt/syntaxTree", json!({ "uri": uri(&tape) })).unwrap();
    let told = folder.run(&["tree", "a.tap"]).stdout;
    assert_eq!(tree["text"].as_str().unwrap().trim_end(), told.trim_end());
    let report = server.ask("apt/runMotion", json!({ "uri": uri(&tape) })).unwrap();
    assert_eq!((&report["ok"], &report["totals"]["points"]), (&json!(true), &json!(2)), "{report}");
}

#[test]
fn an_endless_program_does_not_hold_up_the_server_and_can_be_cancelled() {
    let mut server = Server::initialized(&json!({ "textDocument": { "diagnostic": {} } }));
    server.open(URI, "PARTNO LOOP\nLOOPST\nA) B=1\nJUMPTO/A\nLOOPND\nFINI\n");
    let run = server.begin("apt/runMotion", json!({ "uri": URI }));
    server.tell("$/cancelRequest", json!({ "id": run }));
    match server.answer(run) {
        Err(error) => assert_eq!(error["code"], -32800),
        // Its budget may have ended it before the cancel was read.
        Ok(report) => assert_eq!(report["ok"], false, "{report}"),
    }
    assert!(!server.tree(URI).is_empty());
}

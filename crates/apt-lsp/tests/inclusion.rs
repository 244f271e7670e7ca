//! Programs of two files, through the protocol and on the command line.

#![allow(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

mod support;

use serde_json::{Value, json};

use support::{Folder, Server};

const PROGRAM: &str = "\
PARTNO TWO FILES
INCLUD/LIB
CUTTER/1
FROM/0,0,SAFE
CALL/HOLE,PX=1
CALL/HOLE,PX=SAFE,DP=NONE
FINI
";

const LIBRARY: &str = "\
$$ a library
SAFE=5
HOLE=MACRO/PX,DP=2
GOTO/PX,0,SAFE
GODLTA/-DP
TERMAC
";

/// A folder with a program, a library and a project file that names the folder of the library.
struct Project {
    folder: Folder,
    program: String,
    library: String,
}

impl Project {
    fn new(name: &str) -> Self {
        let folder = Folder::new(name);
        folder.write("apt-lsp.toml", "include = [\"lib\"]\n");
        let uri =
            |path: std::path::PathBuf| format!("file://{}", std::fs::canonicalize(path).unwrap().display());
        let program = uri(folder.write("parts/main.apt", PROGRAM));
        let library = uri(folder.write("lib/lib.apt", LIBRARY));
        Self { folder, program, library }
    }

    fn server(&self, capabilities: &Value) -> Server {
        let mut server = Server::initialized(capabilities);
        server.open(&self.program, PROGRAM);
        server
    }
}

fn place(uri: &str, line: usize, character: usize) -> Value {
    json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": character } })
}

/// File and line of each location, in order.
fn lines(locations: &Value) -> Vec<(String, u64)> {
    let file = |uri: &Value| uri.as_str().unwrap().rsplit('/').next().unwrap().to_owned();
    let all = locations.as_array().unwrap().iter();
    all.map(|one| (file(&one["uri"]), one["range"]["start"]["line"].as_u64().unwrap())).collect()
}

fn pushed(server: &mut Server, uri: &str, wanted: impl Fn(&[Value]) -> bool) -> Vec<Value> {
    let message = server.wait(|message| {
        message["method"] == "textDocument/publishDiagnostics"
            && message["params"]["uri"] == uri
            && wanted(message["params"]["diagnostics"].as_array().unwrap())
    });
    message["params"]["diagnostics"].as_array().unwrap().clone()
}

#[test]
fn names_lead_from_one_file_to_the_other() {
    let project = Project::new("names");
    let mut server = project.server(&json!({}));
    for also_open in [false, true] {
        if also_open {
            server.open(&project.library, LIBRARY);
        }
        let (main, lib) = ("main.apt".to_owned(), "lib.apt".to_owned());
        let mut ask = |method: &str, params: Value| server.ask(method, params).unwrap();
        let definition = ask("textDocument/definition", place(&project.program, 4, 6));
        assert_eq!(lines(&definition), [(lib.clone(), 2)], "the macro");
        let definition = ask("textDocument/definition", place(&project.program, 3, 10));
        assert_eq!(lines(&definition), [(lib.clone(), 1)], "the number");
        let definition = ask("textDocument/definition", place(&project.program, 4, 11));
        assert_eq!(lines(&definition), [(lib.clone(), 2)], "the variable of the macro");
        let definition = ask("textDocument/definition", place(&project.program, 1, 8));
        assert_eq!(lines(&definition), [(lib.clone(), 0)], "the file");
        let mut question = place(&project.program, 3, 10);
        question["context"] = json!({ "includeDeclaration": true });
        let references = ask("textDocument/references", question);
        let expected = [(main.clone(), 3), (main.clone(), 5), (lib.clone(), 1), (lib.clone(), 3)];
        assert_eq!(lines(&references), expected);
        let mut question = place(&project.program, 4, 6);
        question["newName"] = json!("DRILL1");
        let edits = ask("textDocument/rename", question);
        assert_eq!(edits["changes"][&project.program].as_array().unwrap().len(), 2, "{edits}");
        assert_eq!(edits["changes"][&project.library].as_array().unwrap().len(), 1, "{edits}");
        let links = ask("textDocument/documentLink", json!({ "textDocument": { "uri": project.program } }));
        assert_eq!(
            (&links[0]["target"], &links[0]["range"]["start"]["line"]),
            (&json!(project.library), &json!(1))
        );
        let hover = ask("textDocument/hover", place(&project.program, 4, 6));
        assert!(hover["contents"]["value"].as_str().unwrap().contains("HOLE=MACRO/PX,DP"), "{hover}");
        let hover = ask("textDocument/hover", place(&project.program, 3, 10));
        assert!(hover["contents"]["value"].as_str().unwrap().contains("SAFE=5"), "{hover}");
        let help = ask("textDocument/signatureHelp", place(&project.program, 4, 11));
        assert_eq!(help["signatures"][0]["label"], "CALL/HOLE,PX,DP=2");
    }
    // From the library to the program that includes it.
    let hover = server.ask("textDocument/hover", place(&project.library, 3, 5)).unwrap();
    let value = hover["contents"]["value"].as_str().unwrap();
    assert!(
        value.contains("variable `PX` of macro `HOLE`") && value.contains("`SAFE` at statement 6"),
        "{value}"
    );
    let mut question = place(&project.library, 1, 1);
    question["context"] = json!({ "includeDeclaration": false });
    let references = server.ask("textDocument/references", question).unwrap();
    assert_eq!(references.as_array().unwrap().len(), 3, "{references}");
    let mut question = place(&project.library, 2, 1);
    question["newName"] = json!("DRILL1");
    let edits = server.ask("textDocument/rename", question).unwrap();
    assert_eq!(edits["changes"].as_object().unwrap().len(), 2, "{edits}");
}

#[test]
fn a_client_that_checks_versions_gets_them_with_a_new_name() {
    let project = Project::new("versions");
    let mut server =
        project.server(&json!({ "workspace": { "workspaceEdit": { "documentChanges": true } } }));
    let mut question = place(&project.program, 4, 6);
    question["newName"] = json!("DRILL1");
    let of_files = |server: &mut Server| {
        let edits = server.ask("textDocument/rename", question.clone()).unwrap();
        assert!(edits.get("changes").is_none(), "{edits}");
        let all = edits["documentChanges"].as_array().unwrap().iter();
        all.map(|one| (one["textDocument"].clone(), one["edits"].as_array().unwrap().len()))
            .collect::<Vec<_>>()
    };
    let program = (json!({ "uri": project.program, "version": 1 }), 2);
    let closed = (json!({ "uri": project.library, "version": null }), 1);
    assert_eq!(of_files(&mut server), [closed, program.clone()]);
    server.open(&project.library, LIBRARY);
    server.change(&project.library, 7, 0, 3, 3, " new");
    let open = (json!({ "uri": project.library, "version": 7 }), 1);
    assert_eq!(of_files(&mut server), [open, program]);
}

#[test]
fn findings_stand_at_the_call_and_in_the_included_file() {
    let project = Project::new("findings");
    let mut server = project.server(&json!({}));
    let found = pushed(&mut server, &project.program, |found| !found.is_empty());
    let inside =
        found.iter().find(|one| one["range"]["start"]["line"] == 5).unwrap_or_else(|| panic!("{found:?}"));
    let related = &inside["relatedInformation"][0]["location"];
    assert_eq!((&related["uri"], &related["range"]["start"]["line"]), (&json!(project.library), &json!(4)));
    // The library alone is no program; what is found in it is what the program finds.
    server.open(&project.library, LIBRARY);
    let found = pushed(&mut server, &project.library, |found| !found.is_empty());
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0]["range"]["start"]["line"], 4);
    // The program is judged again when the library changes, and the library when the program changes.
    server.change(&project.library, 2, 4, 0, 11, "GODLTA/0,0,1");
    let found = pushed(&mut server, &project.program, <[Value]>::is_empty);
    assert_eq!(found, Vec::<Value>::new());
    pushed(&mut server, &project.library, <[Value]>::is_empty);
    server.change(&project.library, 3, 1, 0, 6, "$$");
    let found = pushed(&mut server, &project.program, |found| found.len() > 1);
    assert!(found.iter().any(|one| one["range"]["start"]["line"] == 3), "SAFE is gone: {found:?}");
    // Without the open library its text on the disk counts again.
    server.tell("textDocument/didClose", json!({ "textDocument": { "uri": project.library } }));
    let found = pushed(&mut server, &project.program, |found| found.len() == 1);
    assert_eq!(found[0]["range"]["start"]["line"], 5);
}

#[test]
fn a_client_that_pulls_gets_the_same() {
    let project = Project::new("pulled");
    let mut server = project.server(&json!({ "textDocument": { "diagnostic": {} } }));
    server.open(&project.library, LIBRARY);
    let pull = |uri: &str| json!({ "textDocument": { "uri": uri } });
    let program = server.ask("textDocument/diagnostic", pull(&project.program)).unwrap();
    let library = server.ask("textDocument/diagnostic", pull(&project.library)).unwrap();
    assert_eq!(library["items"].as_array().unwrap().len(), 1, "{library}");
    server.change(&project.library, 2, 4, 0, 11, "GODLTA/0,0,1");
    let mut again = pull(&project.program);
    again["previousResultId"] = program["resultId"].clone();
    let again = server.ask("textDocument/diagnostic", again).unwrap();
    assert_eq!((&again["kind"], &again["items"]), (&json!("full"), &json!([])));
}

#[test]
fn the_command_line_names_the_included_file() {
    let project = Project::new("lines");
    let ran = project.folder.run(&["--check", "--format", "json", "parts/main.apt"]);
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    let found = &report["files"][0]["diagnostics"][0];
    assert_eq!(found["range"]["start"]["line"], 5, "{found}");
    let related = &found["related"][0];
    assert!(related["file"].as_str().unwrap().ends_with("lib/lib.apt"), "{found}");
    assert_eq!(related["range"]["start"]["line"], 4);
    let ran = project.folder.run(&["--check", "parts/main.apt"]);
    assert!(ran.stdout.contains("lib/lib.apt:5:"), "{}", ran.stdout);
    let ran = project.folder.run(&["--check", "--format", "sarif", "parts/main.apt"]);
    assert!(ran.stdout.contains("lib/lib.apt"), "{}", ran.stdout);
    let ran = project.folder.run(&["expand", "parts/main.apt"]);
    assert!(
        ran.stdout.contains("GOTO/1,0,SAFE") && ran.stdout.contains("in the macro HOLE"),
        "{}",
        ran.stdout
    );
}

#[test]
fn circles_and_missing_files_are_said_clearly() {
    let folder = Folder::new("circles");
    folder.write("main.apt", "INCLUD/ONE\nINCLUD/GONE\nFINI\n");
    folder.write("one.apt", "INCLUD/TWO\n");
    folder.write("two.apt", "INCLUD/ONE\n");
    let ran = folder.run(&["check", "main.apt", "--format", "json"]);
    assert_eq!(ran.code, 1, "{ran:?}");
    let report: Value = serde_json::from_str(&ran.stdout).unwrap();
    let found = report["files"][0]["diagnostics"].as_array().unwrap();
    let codes: Vec<_> = found.iter().map(|one| one["code"].as_str().unwrap()).collect();
    assert_eq!(codes, ["APT0908", "APT0906"], "{found:?}");
    assert!(found[0]["hint"].as_str().unwrap().contains("ONE includes TWO includes ONE"), "{}", found[0]);
    assert!(found[1]["hint"].as_str().unwrap().contains("searched: "), "{}", found[1]);
}

#[test]
fn an_open_included_file_shows_what_its_program_computes() {
    let project = Project::new("computed");
    let library = "SAFE=2+3\nHOLE=MACRO/PX,DP=2\nGOTO/PX,0,SAFE\nGODLTA/-DP\nTERMAC\n";
    project.folder.write("lib/lib.apt", library);
    let mut server = Server::initialized(&json!({}));
    let program = PROGRAM.replace("NONE", "1");
    server.open(&project.program, &program);
    server.open(&project.library, library);
    let hover = server.ask("textDocument/hover", place(&project.library, 2, 1)).unwrap();
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(text.contains("`GOTO/1,0,5`") && text.contains("`GOTO/5,0,5`"), "{text}");
    let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 5, "character": 0 } });
    let question = json!({ "textDocument": { "uri": project.library }, "range": whole });
    let hints = server.ask("textDocument/inlayHint", question).unwrap();
    assert_eq!((&hints[0]["position"]["line"], &hints[0]["label"]), (&json!(0), &json!("= 5")), "{hints}");
    let question = json!({ "textDocument": { "uri": project.library } });
    let lenses = server.ask("textDocument/codeLens", question).unwrap();
    assert_eq!(lenses.as_array().unwrap().len(), 1, "{lenses}");
    assert_eq!(lenses[0]["command"]["arguments"][0]["uri"], project.program, "{lenses}");
}

#[test]
fn symbols_of_included_files_and_of_the_project_are_found() {
    let project = Project::new("symbols");
    project
        .folder
        .write("parts/other.apt", "PARTNO OTHER\nHOLES=PATERN/LINEAR,(POINT/0,0),(POINT/5,0),4\nFINI\n");
    project.folder.write("parts/notes.txt", "HOLE=NO PROGRAM\n");
    let mut server = project.server(&json!({}));
    let mut named = |query: &str| -> Vec<(String, String)> {
        let found = server.ask("workspace/symbol", json!({ "query": query })).unwrap();
        let name = |one: &Value| one["name"].as_str().unwrap().to_owned();
        let file =
            |one: &Value| one["location"]["uri"].as_str().unwrap().rsplit('/').next().unwrap().to_owned();
        found.as_array().unwrap().iter().map(|one| (name(one), file(one))).collect()
    };
    let pair = |name: &str, file: &str| (name.to_owned(), file.to_owned());
    assert_eq!(named("hole"), [pair("HOLE", "lib.apt"), pair("HOLES", "other.apt")]);
    assert_eq!(named("safe"), [pair("SAFE", "lib.apt")]);
    assert_eq!(named("two files"), [pair("TWO FILES", "main.apt")]);
    // An open file is there once, with the text of the editor.
    server.open(&project.library, "DRILL=MACRO/X\nTERMAC\n");
    let found = server.ask("workspace/symbol", json!({ "query": "HOLE" })).unwrap();
    assert_eq!(found.as_array().unwrap().len(), 1, "{found}");
}

#[test]
fn included_files_are_watched_and_read_again() {
    let project = Project::new("watched");
    let watches = json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } });
    let mut server = project.server(&watches);
    let registration = server.wait(|message| {
        message["method"] == "client/registerCapability"
            && message["params"]["registrations"][0]["id"] == "apt-lsp/included-files"
    });
    let watchers = &registration["params"]["registrations"][0]["registerOptions"]["watchers"];
    assert_eq!(*watchers, json!([{ "globPattern": "**/lib.apt" }]));
    server.send(&json!({ "jsonrpc": "2.0", "id": registration["id"], "result": null }));
    let found = pushed(&mut server, &project.program, |found| !found.is_empty());
    assert_eq!(found[0]["range"]["start"]["line"], 5, "{found:?}");
    // Another program changes the file on the disk.
    project.folder.write("lib/lib.apt", LIBRARY.replace("-DP", "0,0,1"));
    let change = json!({ "changes": [{ "uri": project.library, "type": 2 }] });
    server.tell("workspace/didChangeWatchedFiles", change);
    pushed(&mut server, &project.program, <[Value]>::is_empty);
    // Without the statement nothing is left to be watched.
    server.change(&project.program, 2, 1, 0, 10, "$$");
    let forgotten = server.wait(|message| message["method"] == "client/unregisterCapability");
    assert_eq!(forgotten["params"]["unregisterations"][0]["id"], "apt-lsp/included-files");
}

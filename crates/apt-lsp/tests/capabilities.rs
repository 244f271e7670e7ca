//! Every capability that the server announces, asked for over the standard streams of the real binary.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "tests fail where something is missing, and tell times"
)]

mod support;

use std::collections::BTreeSet;
use std::time::Instant;

use serde_json::{Value, json};

use support::Server;

const URI: &str = "file:///nowhere/part.apt";

const PART: &str = "\
PARTNO ALL
$$ one
$$ two
P1=POINT/1,2,0
M1=MACRO/DX,DY=2
GODLTA/DX,DY,0
TERMAC
FROM/P1
CALL/M1,DX=3
GOTO/5,5,5
FINI
";

fn place(line: usize, character: usize) -> Value {
    json!({ "textDocument": { "uri": URI }, "position": { "line": line, "character": character } })
}

fn whole() -> Value {
    json!({ "textDocument": { "uri": URI } })
}

fn lines(places: &Value) -> Vec<u64> {
    let all = places.as_array().unwrap().iter();
    all.map(|one| one["range"]["start"]["line"].as_u64().unwrap()).collect()
}

/// One question for each announced provider, with a check of its answer.
type Probe = (&'static str, fn(&mut Server));

const PROBES: [Probe; 24] = [
    ("textDocumentSync", |server| {
        server.change(URI, 2, 9, 5, 6, "7");
        assert!(server.tree(URI).contains("\"7\""));
    }),
    ("hoverProvider", |server| {
        let answer = server.ask("textDocument/hover", place(3, 1)).unwrap();
        assert!(answer["contents"]["value"].as_str().unwrap().contains("point (1, 2, 0)"), "{answer}");
    }),
    ("completionProvider", |server| {
        let answer = server.ask("textDocument/completion", place(8, 5)).unwrap();
        let labels: Vec<_> = answer.as_array().unwrap().iter().map(|item| item["label"].clone()).collect();
        assert_eq!(labels, ["M1"]);
    }),
    ("signatureHelpProvider", |server| {
        let answer = server.ask("textDocument/signatureHelp", place(3, 11)).unwrap();
        let active = &answer["signatures"][answer["activeSignature"].as_u64().unwrap() as usize];
        assert_eq!((&active["label"], &answer["activeParameter"]), (&json!("POINT/x,y"), &json!(1)));
        assert_eq!(active["parameters"][1]["label"], "y");
        let answer = server.ask("textDocument/signatureHelp", place(8, 11)).unwrap();
        assert_eq!(answer["signatures"][0]["label"], "CALL/M1,DX,DY=2");
        assert_eq!(server.ask("textDocument/signatureHelp", place(1, 3)).unwrap(), Value::Null);
    }),
    ("definitionProvider", |server| {
        assert_eq!(lines(&server.ask("textDocument/definition", place(7, 6)).unwrap()), [3]);
    }),
    ("declarationProvider", |server| {
        assert_eq!(lines(&server.ask("textDocument/declaration", place(7, 6)).unwrap()), [3]);
    }),
    ("callHierarchyProvider", |server| {
        let items = server.ask("textDocument/prepareCallHierarchy", place(8, 6)).unwrap();
        let macro_item = &items[0];
        assert_eq!((&macro_item["name"], &macro_item["kind"]), (&json!("M1"), &json!(12)));
        assert_eq!(macro_item["selectionRange"]["start"], json!({ "line": 4, "character": 0 }));
        let item = json!({ "item": macro_item });
        let callers = server.ask("callHierarchy/incomingCalls", item.clone()).unwrap();
        assert_eq!(callers[0]["fromRanges"][0]["start"], json!({ "line": 8, "character": 5 }));
        assert_eq!((&callers[0]["from"]["kind"], &callers[0]["from"]["uri"]), (&json!(2), &json!(URI)));
        assert_eq!(server.ask("callHierarchy/outgoingCalls", item).unwrap(), json!([]));
        let callees =
            server.ask("callHierarchy/outgoingCalls", json!({ "item": callers[0]["from"] })).unwrap();
        assert_eq!((&callees[0]["to"], callees.as_array().map(Vec::len)), (macro_item, Some(1)));
        assert_eq!(server.ask("textDocument/prepareCallHierarchy", place(3, 1)).unwrap(), Value::Null);
    }),
    ("referencesProvider", |server| {
        let mut params = place(7, 6);
        params["context"] = json!({ "includeDeclaration": true });
        assert_eq!(lines(&server.ask("textDocument/references", params.clone()).unwrap()), [3, 7]);
        params["context"] = json!({ "includeDeclaration": false });
        assert_eq!(lines(&server.ask("textDocument/references", params).unwrap()), [7]);
    }),
    ("documentHighlightProvider", |server| {
        let answer = server.ask("textDocument/documentHighlight", place(5, 8)).unwrap();
        assert_eq!(lines(&answer), [4, 5, 8]);
    }),
    ("workspaceSymbolProvider", |server| {
        let answer = server.ask("workspace/symbol", json!({ "query": "p1" })).unwrap();
        let names: Vec<_> = answer.as_array().unwrap().iter().map(|one| one["name"].clone()).collect();
        assert!(names.contains(&json!("P1")) && !names.contains(&json!("M1")), "{answer}");
    }),
    ("selectionRangeProvider", |server| {
        let mut params = whole();
        params["positions"] = json!([{ "line": 3, "character": 10 }]);
        let answer = server.ask("textDocument/selectionRange", params).unwrap();
        assert_eq!(answer[0]["range"]["start"]["character"], 9);
        assert_eq!(answer[0]["parent"]["range"]["start"]["character"], 9);
        assert_eq!(answer[0]["parent"]["parent"]["range"]["start"]["character"], 3);
    }),
    ("inlayHintProvider", |server| {
        let uri = "file:///nowhere/values.apt";
        server.open(uri, "A=2\nB=A*3\nFINI\n");
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 2, "character": 0 } });
        let answer =
            server.ask("textDocument/inlayHint", json!({ "textDocument": { "uri": uri }, "range": range }));
        let answer = answer.unwrap();
        assert_eq!((&answer[0]["label"], &answer[0]["position"]["line"]), (&json!("= 6"), &json!(1)));
    }),
    ("documentLinkProvider", |server| {
        // The files of other programs are in the tests of inclusions.
        assert_eq!(server.ask("textDocument/documentLink", whole()).unwrap(), json!([]));
    }),
    ("documentSymbolProvider", |server| {
        let answer = server.ask("textDocument/documentSymbol", whole()).unwrap();
        let names: Vec<_> = answer.as_array().unwrap().iter().map(|one| one["name"].clone()).collect();
        assert_eq!(names, ["ALL", "P1", "M1"]);
    }),
    ("codeLensProvider", |server| {
        let answer = server.ask("textDocument/codeLens", whole()).unwrap();
        assert_eq!(lines(&answer), [0, 8]);
        assert_eq!(answer[0]["command"]["command"], "apt.runMotion");
    }),
    ("renameProvider", |server| {
        let range = server.ask("textDocument/prepareRename", place(5, 8)).unwrap();
        assert_eq!(range["start"]["character"], 7);
        let mut params = place(5, 8);
        params["newName"] = json!("SHIFT1");
        let answer = server.ask("textDocument/rename", params.clone()).unwrap();
        assert_eq!(lines(&answer["changes"][URI]), [4, 5, 8]);
        params["newName"] = json!("GOTO");
        assert_eq!(server.ask("textDocument/rename", params).unwrap_err()["code"], -32803);
    }),
    ("codeActionProvider", |server| {
        let uri = "file:///nowhere/misspelt.apt";
        server.open(uri, "PNT1=POINT/1,2\nGOTO/PNT2");
        let place = json!({ "start": { "line": 1, "character": 6 }, "end": { "line": 1, "character": 6 } });
        let mut params =
            json!({ "textDocument": { "uri": uri }, "range": place, "context": { "diagnostics": [] } });
        let actions = server.ask("textDocument/codeAction", params.clone()).unwrap();
        let titles: Vec<_> = actions.as_array().unwrap().iter().map(|one| one["title"].clone()).collect();
        assert_eq!(titles[..2], ["Add FINI", "Replace PNT2 by PNT1"]);
        assert_eq!(titles[2], "Allow APT0901 in this statement");
        assert_eq!(actions[1]["edit"]["changes"][uri][0]["newText"], "PNT1");
        params["context"]["only"] = json!(["source.fixAll.apt"]);
        let all = server.ask("textDocument/codeAction", params).unwrap();
        assert_eq!(all[0]["edit"]["changes"][uri].as_array().unwrap().len(), 2, "{all}");
        let uri = "file:///nowhere/call.apt";
        server.open(uri, "M=MACRO/A\nGOTO/A,0,0\nTERMAC\nCALL/M,A=1\nFINI\n");
        let place = json!({ "start": { "line": 3, "character": 0 }, "end": { "line": 3, "character": 0 } });
        let params = json!({
            "textDocument": { "uri": uri }, "range": place,
            "context": { "diagnostics": [], "only": ["refactor.inline"] },
        });
        let actions = server.ask("textDocument/codeAction", params).unwrap();
        assert_eq!(actions[0]["edit"]["changes"][uri][0]["newText"], "GOTO/1,0,0\n");
    }),
    ("documentFormattingProvider", |server| {
        let uri = "file:///nowhere/style.apt";
        server.open(uri, "p1 = point/1,2\nGOTO/P1\nFINI\n");
        let mut params =
            json!({ "textDocument": { "uri": uri }, "options": { "tabSize": 8, "insertSpaces": true } });
        let edits = server.ask("textDocument/formatting", params.clone()).unwrap();
        assert_eq!(lines(&edits), [0, 0, 0, 0]);
        assert_eq!(edits[0]["newText"], "P");
        params["range"] =
            json!({ "start": { "line": 1, "character": 0 }, "end": { "line": 2, "character": 0 } });
        assert_eq!(server.ask("textDocument/rangeFormatting", params).unwrap(), json!([]));
    }),
    ("documentRangeFormattingProvider", |server| {
        let uri = "file:///nowhere/style.apt";
        let mut params =
            json!({ "textDocument": { "uri": uri }, "options": { "tabSize": 8, "insertSpaces": true } });
        params["range"] =
            json!({ "start": { "line": 0, "character": 3 }, "end": { "line": 0, "character": 4 } });
        let edits = server.ask("textDocument/rangeFormatting", params).unwrap();
        assert_eq!(lines(&edits), [0, 0, 0, 0]);
    }),
    ("foldingRangeProvider", |server| {
        let answer = server.ask("textDocument/foldingRange", whole()).unwrap();
        let folds: Vec<_> = answer
            .as_array()
            .unwrap()
            .iter()
            .map(|one| (one["startLine"].as_u64(), one["endLine"].as_u64()))
            .collect();
        assert_eq!(folds, [(Some(1), Some(2)), (Some(4), Some(6))]);
    }),
    ("semanticTokensProvider", |server| {
        let full = server.ask("textDocument/semanticTokens/full", whole()).unwrap();
        assert!(full["data"].as_array().unwrap().len() > 5 * 20);
        let mut params = whole();
        params["previousResultId"] = full["resultId"].clone();
        let delta = server.ask("textDocument/semanticTokens/full/delta", params).unwrap();
        assert_eq!(delta["edits"], json!([]));
        let mut params = whole();
        params["range"] =
            json!({ "start": { "line": 3, "character": 0 }, "end": { "line": 3, "character": 5 } });
        let part = server.ask("textDocument/semanticTokens/range", params).unwrap();
        assert_eq!(part["data"][0], 3, "the first token is on line 3: {part}");
    }),
    ("diagnosticProvider", |server| {
        let answer = server.ask("textDocument/diagnostic", whole()).unwrap();
        assert_eq!((&answer["kind"], &answer["items"]), (&json!("full"), &json!([])));
        let mut params = whole();
        params["previousResultId"] = answer["resultId"].clone();
        assert_eq!(server.ask("textDocument/diagnostic", params).unwrap()["kind"], "unchanged");
    }),
    ("executeCommandProvider", |server| {
        let mut ask = |command: &str, argument: Value| {
            let params = json!({ "command": command, "arguments": [argument] });
            server.ask("workspace/executeCommand", params).unwrap()
        };
        let run = ask("apt.runMotion", json!({ "uri": URI, "machine": "linuxcnc-mill3", "scene": true }));
        assert_eq!((&run["ok"], &run["totals"]["points"]), (&json!(true), &json!(3)));
        assert_eq!(
            run["tape"]["blocks"].as_array().unwrap().len(),
            run["tape"]["origin"].as_array().unwrap().len()
        );
        assert_eq!(run["scene"]["segments"].as_array().unwrap().len(), 2);
        let expansion = ask("apt.expand", json!({ "uri": URI }));
        assert!(expansion["text"].as_str().unwrap().contains("GODLTA/3,2,0"), "{expansion}");
        let position = json!({ "line": 3, "character": 1 });
        let form = ask("apt.canonicalForm", json!({ "uri": URI, "position": position }));
        assert_eq!((&form["name"], &form["canonical"]), (&json!("P1"), &json!([1.0, 2.0, 0.0])));
        let tape = ask("apt.post", json!({ "uri": URI, "machine": "linuxcnc-mill3" }));
        assert_eq!(tape["blocks"], run["tape"]["blocks"]);
        assert!(ask("apt.syntaxTree", json!({ "uri": URI }))["text"].as_str().unwrap().contains("PARTNO"));
        assert!(
            ask("apt.machines", json!({}))
                .as_array()
                .unwrap()
                .iter()
                .any(|one| one["name"] == "linuxcnc-mill3")
        );
        let status = ask("apt.status", json!({}));
        let documents = status["documents"].as_array().unwrap();
        let held = documents.iter().find(|one| one["uri"] == URI).unwrap();
        assert_eq!((&held["uri"], &held["positions"]), (&json!(URI), &json!(3)), "{status}");
        assert!(held["statements"].as_u64() > Some(3) && held["records"].as_u64() > Some(3), "{status}");
        if cfg!(target_os = "linux") {
            let of = |key: &str| status["memory"][key].as_u64().unwrap();
            assert!(of("resident") > 1 << 20 && of("peak") >= of("resident"), "{status}");
        }
    }),
    ("positionEncoding", |server| {
        server.open("file:///nowhere/wide.apt", "PPRINT 😀\nP1=POINT/1,2\nPPRINT 😀\nFINI\n");
        let params = json!({ "textDocument": { "uri": "file:///nowhere/wide.apt" } });
        let tokens = server.ask("textDocument/semanticTokens/full", params).unwrap();
        let lengths: Vec<_> =
            tokens["data"].as_array().unwrap().chunks(5).map(|one| one[2].clone()).collect();
        assert!(lengths.contains(&json!(5)), "` 😀` is five bytes in UTF-8: {lengths:?}");
    }),
];

#[test]
fn everything_announced_is_answered() {
    let client = json!({
        "general": { "positionEncodings": ["utf-8", "utf-16"] },
        "textDocument": {
            "diagnostic": {},
            "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
            "rename": { "prepareSupport": true },
            "codeAction": { "codeActionLiteralSupport": { "codeActionKind": { "valueSet": ["quickfix"] } } },
        },
    });
    let mut server = Server::start(&[]);
    let answer = server.ask("initialize", json!({ "processId": null, "capabilities": client })).unwrap();
    server.tell("initialized", json!({}));
    let announced: BTreeSet<_> = answer["capabilities"].as_object().unwrap().keys().cloned().collect();
    let probed: BTreeSet<_> = PROBES.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(announced, probed, "each announced capability has a probe, and no other");
    server.open(URI, PART);
    for (_, probe) in PROBES {
        probe(&mut server);
    }
}

/// Starts a run, waits until it is under way, cancels it, and tells what came of it.
fn cancelled(program: &str, under_way: impl Fn(&Value) -> bool) -> Result<Value, Value> {
    // A client that pulls, so that nothing else computes.
    let mut server = Server::initialized(&json!({ "textDocument": { "diagnostic": {} } }));
    server.open(URI, program);
    let run = server.begin("apt/runMotion", json!({ "uri": URI, "workDoneToken": "run" }));
    server.wait(|message| message["method"] == "$/progress" && under_way(&message["params"]["value"]));
    let asked = Instant::now();
    server.tell("$/cancelRequest", json!({ "id": run }));
    let answer = server.answer(run);
    // For the reader of the output; a busy machine must not fail the test.
    eprintln!("answered {:?} after the cancel", asked.elapsed());
    assert!(!server.tree(URI).is_empty(), "the server goes on");
    answer
}

#[test]
fn a_cancel_stops_a_long_evaluation() {
    let program = "PARTNO LOOP\nLOOPST\nA) B=1\nJUMPTO/A\nLOOPND\nFINI\n";
    let answer = cancelled(program, |progress| progress["kind"] == "begin");
    assert_eq!(answer.unwrap_err()["code"], -32800);
}

#[test]
fn a_cancel_stops_a_long_motion() {
    // Every turn moves along another section of the ball: nothing can be taken from the memo.
    let program = "\
PARTNO BALL
INTOL/.00001
OUTTOL/.00001
CUTTER/.5,.25
DOME=SPHERE/0,0,0,2
Y=-1
LOOPST
A) CUT=PLANE/0,1,0,Y
FROM/-3,Y,0
GO/ON,CUT,TO,DOME,ON,(PLANE/1,0,0,-1.2)
INDIRV/1,0,0
TLON,GOFWD/CUT,ON,(PLANE/1,0,0,1.2)
Y=Y+.0001
IF(Y-1)A,B,B
B) LOOPND
FINI
";
    let answer = cancelled(program, |progress| {
        progress["percentage"].as_u64().is_some_and(|done| done < 50) || progress["kind"] == "report"
    });
    assert_eq!(answer.unwrap_err()["code"], -32800);
}

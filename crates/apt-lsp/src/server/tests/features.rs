//! Everything that is announced, asked for once.

use serde_json::{Value, json};

use super::conversation::{Conversation, URI, at, document};

#[tokio::test(flavor = "multi_thread")]
async fn findings_are_pushed_and_taken_back() {
    let mut talk = Conversation::about("GOOD BAD\n").await;
    let params = talk.wait_for("textDocument/publishDiagnostics").await["params"].clone();
    let found = &params["diagnostics"][0];
    assert_eq!(
        (&found["code"], &found["source"], &found["severity"]),
        (&json!("APT0001"), &json!("apt"), &json!(1))
    );
    assert_eq!(found["message"], "BAD stands here\nhelp: remove it");
    assert_eq!(found["range"]["end"], json!({ "line": 0, "character": 8 }));
    assert_eq!(found["relatedInformation"][0]["location"]["uri"], URI);
    talk.tell("textDocument/didClose", document()).await;
    let params = talk.wait_for("textDocument/publishDiagnostics").await["params"].clone();
    assert_eq!(params["diagnostics"], json!([]));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_client_that_pulls_is_not_pushed_to() {
    let mut talk = Conversation::with(json!({ "textDocument": { "diagnostic": {} } })).await;
    talk.open("BAD\n").await;
    let pull = |previous: Value| json!({ "textDocument": { "uri": URI }, "previousResultId": previous });
    let first = talk.ask("textDocument/diagnostic", pull(Value::Null)).await.unwrap();
    assert_eq!((&first["kind"], first["items"].as_array().unwrap().len()), (&json!("full"), 1));
    let again = talk.ask("textDocument/diagnostic", pull(first["resultId"].clone())).await.unwrap();
    assert_eq!(again, json!({ "kind": "unchanged", "resultId": first["resultId"] }));
    talk.change(2, 0, 0, 0, "BAD ").await;
    let third = talk.ask("textDocument/diagnostic", pull(first["resultId"].clone())).await.unwrap();
    assert_eq!((&third["kind"], third["items"].as_array().unwrap().len()), (&json!("full"), 2));
    assert_eq!(talk.unwanted("textDocument/publishDiagnostics"), 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_pull_of_an_old_version_asks_to_be_repeated() {
    let mut talk = Conversation::with(json!({ "textDocument": { "diagnostic": {} } })).await;
    talk.open("SLOW\n").await;
    let pull = talk.begin("textDocument/diagnostic", document()).await;
    talk.until_running(1).await;
    talk.change(2, 0, 0, 4, "").await;
    let error = talk.answer(pull).await.unwrap_err();
    assert_eq!((&error["code"], &error["data"]), (&json!(-32802), &json!({ "retriggerRequest": true })));
}

#[tokio::test(flavor = "multi_thread")]
async fn questions_about_places_are_answered() {
    let mut talk = Conversation::about("P1 X P1\nP1\n").await;
    let range = |line: u32, from: u32, to: u32| json!({ "start": { "line": line, "character": from }, "end": { "line": line, "character": to } });
    let place = |line, from, to| json!({ "uri": URI, "range": range(line, from, to) });

    let hover = talk.ask_at("textDocument/hover", 1, 1).await.unwrap();
    assert_eq!(hover["contents"], json!({ "kind": "markdown", "value": "P1 of 11 bytes" }));
    assert_eq!(hover["range"], range(1, 0, 2));
    let completions = talk.ask_at("textDocument/completion", 1, 1).await.unwrap();
    assert_eq!((&completions[0]["label"], &completions[0]["kind"]), (&json!("GOLFT"), &json!(14)));
    assert_eq!(completions[0].get("insertText"), None, "this client knows no snippets");
    let help = talk.ask_at("textDocument/signatureHelp", 1, 1).await.unwrap();
    assert_eq!((&help["activeSignature"], &help["activeParameter"]), (&json!(0), &json!(1)));
    assert_eq!(help["signatures"][0]["parameters"], json!([{ "label": "x" }, { "label": "y" }]));
    let definition = talk.ask_at("textDocument/definition", 1, 1).await.unwrap();
    assert_eq!(definition, json!([place(0, 0, 2)]));
    let mut question = at(1, 1);
    question["context"] = json!({ "includeDeclaration": false });
    let references = talk.ask("textDocument/references", question.clone()).await.unwrap();
    assert_eq!(references, json!([place(0, 5, 7), place(1, 0, 2)]));
    question["context"] = json!({ "includeDeclaration": true });
    assert_eq!(talk.ask("textDocument/references", question).await.unwrap().as_array().unwrap().len(), 3);
    let highlights = talk.ask_at("textDocument/documentHighlight", 0, 0).await.unwrap();
    assert_eq!(highlights[0], json!({ "range": range(0, 0, 2), "kind": 3 }));
    assert_eq!(talk.ask_at("textDocument/prepareRename", 0, 0).await.unwrap(), range(0, 0, 2));
    let mut question = at(0, 0);
    question["newName"] = json!("Q1");
    let renamed = talk.ask("textDocument/rename", question.clone()).await.unwrap();
    assert_eq!(renamed["changes"][URI][2], json!({ "range": range(1, 0, 2), "newText": "Q1" }));
    question["newName"] = json!("");
    assert_eq!(talk.ask("textDocument/rename", question).await.unwrap_err()["code"], -32803);
}

#[tokio::test(flavor = "multi_thread")]
async fn clients_that_can_get_snippets_and_places_of_parameters() {
    let mut talk = Conversation::with(json!({ "textDocument": {
        "completion": { "completionItem": { "snippetSupport": true } },
        "signatureHelp": { "signatureInformation": { "parameterInformation": { "labelOffsetSupport": true } } },
    } }))
    .await;
    talk.open("P1\n").await;
    let completions = talk.ask_at("textDocument/completion", 0, 1).await.unwrap();
    assert_eq!(completions[0]["insertText"], "GOLFT/${1:ds}$0");
    assert_eq!(completions[0]["insertTextFormat"], 2);
    let help = talk.ask_at("textDocument/signatureHelp", 0, 1).await.unwrap();
    assert_eq!(help["signatures"][0]["parameters"][1], json!({ "label": [5, 6] }));
}

#[tokio::test(flavor = "multi_thread")]
async fn questions_about_the_whole_document_are_answered() {
    let mut talk = Conversation::about("P1\nBAD\n").await;
    let symbols = talk.ask("textDocument/documentSymbol", document()).await.unwrap();
    assert_eq!((&symbols[0]["name"], &symbols[0]["location"]["uri"]), (&json!("PROGRAM"), &json!(URI)));
    let folds = talk.ask("textDocument/foldingRange", document()).await.unwrap();
    assert_eq!((&folds[0]["startLine"], &folds[0]["endLine"]), (&json!(0), &json!(1)));
    let lenses = talk.ask("textDocument/codeLens", document()).await.unwrap();
    assert_eq!(lenses[0]["command"]["command"], "apt.runMotion");
    assert_eq!(lenses[0]["command"]["arguments"], json!([{ "uri": URI }]));

    let mut nested = Conversation::with(
        json!({ "textDocument": { "documentSymbol": { "hierarchicalDocumentSymbolSupport": true } } }),
    )
    .await;
    nested.open("P1\n").await;
    let symbols = nested.ask("textDocument/documentSymbol", document()).await.unwrap();
    assert_eq!(symbols[0]["selectionRange"]["start"], json!({ "line": 0, "character": 0 }));
}

#[tokio::test(flavor = "multi_thread")]
async fn findings_are_settled_by_actions_for_the_version_they_are_about() {
    let literals = json!({ "codeActionLiteralSupport": { "codeActionKind": { "valueSet": [] } } });
    let mut talk = Conversation::with(json!({
        "textDocument": { "codeAction": literals },
        "workspace": { "workspaceEdit": { "documentChanges": true } },
    }))
    .await;
    talk.open("GOOD\nBAD\n").await;
    let pushed = talk.wait_for("textDocument/publishDiagnostics").await["params"]["diagnostics"].clone();
    let place = json!({ "start": { "line": 1, "character": 1 }, "end": { "line": 1, "character": 1 } });
    let mut question = document();
    question["range"] = place;
    question["context"] = json!({ "diagnostics": pushed });
    let actions = talk.ask("textDocument/codeAction", question.clone()).await.unwrap();
    assert_eq!(
        actions.as_array().unwrap().len(),
        3,
        "a quick fix, what is written out, other labels: {actions}"
    );
    let fix = &actions[0];
    assert_eq!(
        (&fix["title"], &fix["kind"], &fix["isPreferred"]),
        (&json!("Remove BAD"), &json!("quickfix"), &json!(true))
    );
    assert_eq!(fix["diagnostics"], pushed, "the finding is told as it was pushed");
    let change = &fix["edit"]["documentChanges"][0];
    assert_eq!(change["textDocument"], json!({ "uri": URI, "version": 1 }));
    let range = json!({ "start": { "line": 1, "character": 0 }, "end": { "line": 1, "character": 3 } });
    assert_eq!(change["edits"], json!([{ "range": range, "newText": "" }]));

    for (only, kinds) in [
        ("quickfix", &["quickfix"][..]),
        ("source", &["source.fixAll.apt"]),
        ("source.fixAll", &["source.fixAll.apt"]),
        ("source.organizeImports", &[]),
        ("refactor", &["refactor.inline", "refactor.rewrite.renumber"]),
        ("refact", &[]),
    ] {
        question["context"]["only"] = json!([only]);
        let actions = talk.ask("textDocument/codeAction", question.clone()).await.unwrap();
        let found: Vec<_> = actions.as_array().unwrap().iter().map(|one| one["kind"].clone()).collect();
        assert_eq!(found, kinds, "{only}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_document_is_formatted_whole_and_in_part() {
    let mut talk = Conversation::about("bad\nP1 bad\nbad\n").await;
    let options = json!({ "tabSize": 4, "insertSpaces": true });
    let mut question = document();
    question["options"] = options;
    let edits = talk.ask("textDocument/formatting", question.clone()).await.unwrap();
    assert_eq!(edits.as_array().unwrap().len(), 3);
    let second = json!({ "start": { "line": 1, "character": 3 }, "end": { "line": 1, "character": 6 } });
    assert_eq!(edits[1], json!({ "range": second, "newText": "BAD" }));
    question["range"] =
        json!({ "start": { "line": 1, "character": 0 }, "end": { "line": 2, "character": 0 } });
    let edits = talk.ask("textDocument/rangeFormatting", question).await.unwrap();
    assert_eq!(edits, json!([{ "range": second, "newText": "BAD" }]));
}

#[tokio::test(flavor = "multi_thread")]
async fn tokens_come_whole_in_part_and_as_difference() {
    let mut talk = Conversation::about("BAD\nP1\nBAD\n").await;
    let full = talk.ask("textDocument/semanticTokens/full", document()).await.unwrap();
    assert_eq!(full["data"], json!([0, 0, 3, 0, 0, 2, 0, 3, 0, 0]));
    let mut question = document();
    question["range"] =
        json!({ "start": { "line": 1, "character": 0 }, "end": { "line": 3, "character": 0 } });
    let part = talk.ask("textDocument/semanticTokens/range", question).await.unwrap();
    assert_eq!(part["data"], json!([2, 0, 3, 0, 0]));
    talk.change(2, 1, 0, 2, "BAD").await;
    let mut question = document();
    question["previousResultId"] = full["resultId"].clone();
    let delta = talk.ask("textDocument/semanticTokens/full/delta", question.clone()).await.unwrap();
    assert_eq!(
        delta["edits"],
        json!([{ "start": 5, "deleteCount": 5, "data": [1, 0, 3, 0, 0, 1, 0, 3, 0, 0] }])
    );
    question["previousResultId"] = json!("unknown");
    let whole = talk.ask("textDocument/semanticTokens/full/delta", question).await.unwrap();
    assert_eq!(whole["data"].as_array().unwrap().len(), 15);
}

#[tokio::test(flavor = "multi_thread")]
async fn every_command_is_a_request_too_and_answers_the_same() {
    let mut talk = Conversation::about("P1 P2\nX\n").await;
    let range = json!({ "start": { "line": 0, "character": 3 }, "end": { "line": 0, "character": 5 } });
    let position = json!({ "line": 0, "character": 1 });
    let cases = [
        ("runMotion", json!({ "uri": URI }), json!({ "ok": true, "ran": "P1 P2\nX\n" })),
        (
            "runMotion",
            json!({ "uri": URI, "range": range, "scene": true }),
            json!({ "ok": true, "ran": "P2" }),
        ),
        (
            "canonicalForm",
            json!({ "uri": URI, "position": position }),
            json!({ "name": "P1", "type": "POINT", "canonical": [0.0, 0.0, 0.0], "text": "the origin" }),
        ),
        (
            "post",
            json!({ "uri": URI, "machine": "toy" }),
            json!({ "machine": "toy", "blocks": ["N10 M30"], "origin": [1] }),
        ),
        ("syntaxTree", json!({ "uri": URI }), json!({ "text": "P1 P2\nX\n" })),
        ("machines", json!({}), json!([{ "name": "toy", "title": "A toy", "control": "none" }])),
        (
            "expand",
            json!({ "uri": URI, "depth": 1 }),
            json!({
                "text": "P1 P2\nX\n",
                "origins": [{
                    "line": 0, "isn": 1, "stack": [],
                    "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 5 } },
                }],
            }),
        ),
    ];
    for (name, argument, expected) in cases {
        let answer = talk.ask(&format!("apt/{name}"), argument.clone()).await.unwrap();
        assert_eq!(answer, expected, "{name}");
        let params = json!({ "command": format!("apt.{name}"), "arguments": [argument] });
        assert_eq!(talk.ask("workspace/executeCommand", params).await.unwrap(), expected, "{name}");
    }
    let refused = talk.ask("apt/post", json!({ "uri": URI, "machine": "none" })).await.unwrap_err();
    assert_eq!(refused["code"], -32803);
    assert!(refused["message"].as_str().unwrap().contains("toy"), "{refused}");
    assert_eq!(talk.ask("apt/post", json!({ "uri": URI })).await.unwrap_err()["code"], -32803);
    // Memory is another one each time; what is held of the documents is not.
    let held = json!([{
        "uri": URI, "version": 1, "dialect": "toy", "lines": 3, "bytes": 8,
        "statements": 2, "records": 0, "positions": 0, "motions": 0,
    }]);
    assert_eq!(talk.ask("apt/status", json!({})).await.unwrap()["documents"], held);
    let params = json!({ "command": "apt.status", "arguments": [{}] });
    assert_eq!(talk.ask("workspace/executeCommand", params).await.unwrap()["documents"], held);
    let announced = talk.capabilities["executeCommandProvider"]["commands"].as_array().unwrap();
    assert_eq!(announced.len(), 7);
}

#[tokio::test(flavor = "multi_thread")]
async fn requested_progress_is_shown_and_its_button_ends_the_run() {
    let mut talk = Conversation::about("SLOW\n").await;
    let params =
        json!({ "command": "apt.runMotion", "arguments": [{ "uri": URI }], "workDoneToken": "mine" });
    let run = talk.begin("workspace/executeCommand", params).await;
    let kinds = ["begin", "report"];
    for kind in kinds {
        let progress = talk.wait_for("$/progress").await["params"].clone();
        assert_eq!((&progress["token"], &progress["value"]["kind"]), (&json!("mine"), &json!(kind)));
        assert_eq!(progress["value"]["cancellable"], true);
    }
    talk.tell("window/workDoneProgress/cancel", json!({ "token": "mine" })).await;
    assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32800);
    loop {
        if talk.wait_for("$/progress").await["params"]["value"]["kind"] == "end" {
            break;
        }
    }
}

/// The button of a display may be pressed before the server has looked at the document.
#[tokio::test(flavor = "multi_thread")]
async fn work_whose_progress_is_cancelled_before_it_begins_is_ended() {
    let mut talk = Conversation::about("SLOW\n").await;
    for token in ["one", "two", "three", "four"] {
        let run = talk.begin("apt/runMotion", json!({ "uri": URI, "workDoneToken": token })).await;
        talk.tell("window/workDoneProgress/cancel", json!({ "token": token })).await;
        assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32800, "{token}");
        for kind in ["begin", "end"] {
            let told = talk
                .wait(|one| one["method"] == "$/progress" && one["params"]["value"]["kind"] == kind)
                .await;
            assert_eq!(told["params"]["token"], token);
        }
    }
}

/// A client that has agreed to a display waits for its begin and its end, even where the work is over by then.
#[tokio::test(flavor = "multi_thread")]
async fn offered_progress_that_comes_too_late_begins_and_ends() {
    let mut talk = Conversation::with(
        json!({ "window": { "workDoneProgress": true }, "textDocument": { "diagnostic": {} } }),
    )
    .await;
    talk.open("SLOW\n").await;
    let run = talk.begin("apt/runMotion", json!({ "uri": URI })).await;
    let request = talk.wait_for("window/workDoneProgress/create").await;
    talk.tell("window/workDoneProgress/cancel", json!({ "token": request["params"]["token"] })).await;
    assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32800);
    talk.send(json!({ "jsonrpc": "2.0", "id": request["id"], "result": null })).await;
    let mut kinds = Vec::new();
    while kinds.last() != Some(&json!("end")) {
        let told = talk.wait_for("$/progress").await["params"].clone();
        assert_eq!(told["token"], request["params"]["token"]);
        kinds.push(told["value"]["kind"].clone());
    }
    assert_eq!(kinds[0], "begin");
}

#[tokio::test(flavor = "multi_thread")]
async fn every_command_about_a_document_shows_the_progress_that_was_asked_for() {
    let mut talk = Conversation::about("BAD\n").await;
    let place = json!({ "line": 0, "character": 0 });
    for command in ["runMotion", "expand", "canonicalForm", "post", "syntaxTree"] {
        for method in [format!("apt/{command}"), "workspace/executeCommand".to_owned()] {
            let mut argument = json!({ "uri": URI, "position": place, "machine": "toy" });
            let params = if method.starts_with("apt/") {
                argument["workDoneToken"] = json!(method);
                argument
            } else {
                let name = format!("apt.{command}");
                json!({ "command": name, "arguments": [argument], "workDoneToken": method })
            };
            // The toy language does not do all of them.
            let _ = talk.ask(&method, params).await;
            // The token is good until the answer comes, not longer.
            assert_eq!(talk.unwanted("$/progress"), 2, "{command}");
            for kind in ["begin", "end"] {
                let told = talk.wait_for("$/progress").await["params"].clone();
                let (token, told) = (told["token"].clone(), told["value"]["kind"].clone());
                assert_eq!((token, told), (json!(method), json!(kind)), "{command}");
            }
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn offered_progress_begins_only_when_the_client_agrees() {
    let mut talk = Conversation::with(
        json!({ "window": { "workDoneProgress": true }, "textDocument": { "diagnostic": {} } }),
    )
    .await;
    talk.open("SLOW\n").await;
    let run = talk.begin("apt/runMotion", json!({ "uri": URI })).await;
    let request = talk.wait_for("window/workDoneProgress/create").await;
    assert_eq!(talk.unwanted("$/progress"), 0);
    talk.send(json!({ "jsonrpc": "2.0", "id": request["id"], "result": null })).await;
    let progress = talk.wait_for("$/progress").await["params"].clone();
    assert_eq!(
        (&progress["token"], &progress["value"]["kind"]),
        (&request["params"]["token"], &json!("begin"))
    );
    talk.cancel(run).await;
    assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32800);
}

#[tokio::test(flavor = "multi_thread")]
async fn wrong_settings_are_named_and_settings_can_be_asked_for() {
    let mut talk = Conversation::with(json!({
        "workspace": { "configuration": true, "diagnostics": { "refreshSupport": true } },
        "textDocument": { "diagnostic": {} },
    }))
    .await;
    talk.open("BAD\n").await;
    // Who has told no settings is asked for them at once, and again when they have changed.
    let first = talk.wait_for("workspace/configuration").await;
    let nothing = json!({ "jsonrpc": "2.0", "id": first["id"], "result": [null] });
    talk.send(nothing).await;
    talk.tell("workspace/didChangeConfiguration", json!({ "settings": null })).await;
    let request = talk.wait_for("workspace/configuration").await;
    assert_eq!(request["params"]["items"][0]["section"], "apt");
    let answer = json!({ "jsonrpc": "2.0", "id": request["id"], "result": [{ "machine": "x" }] });
    talk.send(answer).await;
    let shown = talk.wait_for("window/showMessage").await;
    assert!(shown["params"]["message"].as_str().unwrap().contains("machine"), "{shown}");
    talk.tell("workspace/didChangeConfiguration", json!({ "settings": { "apt": { "dialect": "apt3" } } }))
        .await;
    talk.wait_for("workspace/diagnostic/refresh").await;
    // A setting that nobody knows is told once, and those beside it count.
    let settings = json!({ "settings": { "apt": { "dialect": "free", "dialekt": "apt4" } } });
    talk.tell("workspace/didChangeConfiguration", settings).await;
    let shown = talk.wait_for("window/showMessage").await;
    assert!(shown["params"]["message"].as_str().unwrap().contains("`dialekt`"), "{shown}");
    talk.wait_for("workspace/diagnostic/refresh").await;
}

#[tokio::test(flavor = "multi_thread")]
async fn project_files_are_watched_by_clients_that_can() {
    let capabilities = json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } });
    let mut talk = Conversation::with(capabilities).await;
    let request = talk.wait_for("client/registerCapability").await;
    let registration = &request["params"]["registrations"][0];
    assert_eq!(registration["method"], "workspace/didChangeWatchedFiles");
    assert_eq!(registration["registerOptions"]["watchers"][0]["globPattern"], "**/apt-lsp.toml");
    talk.send(json!({ "jsonrpc": "2.0", "id": request["id"], "result": null })).await;
    talk.open("X\n").await;
    talk.tell("workspace/didChangeWatchedFiles", json!({ "changes": [] })).await;
    assert_eq!(talk.text().await, "X\n");
}

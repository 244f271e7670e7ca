//! What no message and no fault can do: end the conversation, or leave a request without an answer.

use std::sync::atomic::Ordering;

use serde_json::{Value, json};

use super::super::Ending;
use super::conversation::{Conversation, URI, at, document, until};
use crate::analysis::fake::SLOW_STEPS;

#[tokio::test(flavor = "multi_thread")]
async fn broken_messages_are_answered_and_the_conversation_goes_on() {
    let mut talk = Conversation::about("BAD\n").await;
    let broken = [
        "Content-Length: 4\r\n\r\n{\"a\"",
        "Content-Length: 2\r\n\r\n[]",
        "Content-Length: 3\r\n\r\n\u{e9}x",
        "Content-Length: nonsense\r\n\r\n",
        "Content-Length: 47\r\n\r\n{\"jsonrpc\":\"2.0\",\"method\":\"x\",\"params\":\"\\ud800\"}",
    ];
    for message in broken {
        talk.write(message.as_bytes()).await;
        let answer = talk.wait(|message| message["id"].is_null() && message.get("error").is_some()).await;
        let code = answer["error"]["code"].as_i64().unwrap();
        assert!([-32700, -32600].contains(&code), "{message}: {answer}");
    }
    assert_eq!(talk.text().await, "BAD\n");
}

#[tokio::test(flavor = "multi_thread")]
async fn a_panic_is_the_end_of_one_request_only() {
    let mut talk = Conversation::about("BAD\n").await;
    talk.change(2, 0, 0, 0, "PANIC ").await;
    let error = talk.ask_at("textDocument/hover", 0, 1).await.unwrap_err();
    assert_eq!(error["code"], -32603);
    assert!(error["message"].as_str().unwrap().contains("hover"), "{error}");
    talk.change(3, 0, 0, 6, "").await;
    assert_eq!(talk.ask_at("textDocument/hover", 0, 1).await.unwrap()["contents"]["value"], "BAD of 4 bytes");
}

#[tokio::test(flavor = "multi_thread")]
async fn requests_about_unknown_documents_and_commands_are_answered() {
    let mut talk = Conversation::with(json!({ "textDocument": { "diagnostic": {} } })).await;
    for method in [
        "textDocument/hover",
        "textDocument/completion",
        "textDocument/definition",
        "textDocument/documentHighlight",
        "textDocument/documentSymbol",
        "textDocument/foldingRange",
        "textDocument/codeLens",
        "textDocument/semanticTokens/full",
        "textDocument/diagnostic",
    ] {
        assert_eq!(talk.ask(method, at(0, 0)).await.unwrap_err()["code"], -32602, "{method}");
    }
    let command = |command: &str, arguments: Value| json!({ "command": command, "arguments": arguments });
    for (name, arguments) in [
        ("apt.unknown", json!([{}])),
        ("apt.runMotion", json!([])),
        ("apt.runMotion", json!([{ "uri": 7 }])),
        ("apt.runMotion", json!([{ "uri": "untitled:nowhere" }])),
        ("apt.canonicalForm", json!([{ "uri": URI }])),
    ] {
        let answer = talk.ask("workspace/executeCommand", command(name, arguments.clone())).await;
        assert_eq!(answer.unwrap_err()["code"], -32602, "{name} {arguments}");
    }
    assert_eq!(talk.ask("no/such/method", json!({})).await.unwrap_err()["code"], -32601);
    talk.change(5, 0, 0, 0, "x").await;
    talk.tell("textDocument/didClose", document()).await;
    assert_eq!(talk.ask("apt/machines", json!({})).await.unwrap()[0]["name"], "toy");
}

#[tokio::test(flavor = "multi_thread")]
async fn messages_at_the_wrong_time_are_refused() {
    let mut talk = Conversation::silent();
    assert_eq!(talk.ask("textDocument/hover", at(0, 0)).await.unwrap_err()["code"], -32002);
    talk.ask("initialize", json!({ "capabilities": {} })).await.unwrap();
    assert_eq!(talk.ask("initialize", json!({ "capabilities": {} })).await.unwrap_err()["code"], -32600);
    talk.ask("shutdown", Value::Null).await.unwrap();
    assert_eq!(talk.ask("textDocument/hover", at(0, 0)).await.unwrap_err()["code"], -32600);
    talk.tell("exit", Value::Null).await;
    assert_eq!(talk.ended().await, Ending::Orderly);
}

#[tokio::test(flavor = "multi_thread")]
async fn the_end_of_input_ends_the_server_and_its_work() {
    let mut talk = Conversation::with(json!({ "textDocument": { "diagnostic": {} } })).await;
    talk.open("SLOW\n").await;
    talk.begin("apt/runMotion", json!({ "uri": URI })).await;
    talk.until_running(1).await;
    let language = talk.language.clone();
    assert_eq!(talk.end().await, Ending::Abrupt);
    until(&language, |language| language.running.load(Ordering::SeqCst) == 0).await;
    assert!(language.steps.load(Ordering::SeqCst) < SLOW_STEPS, "the run went on to its end");
    assert_eq!(Conversation::silent().end().await, Ending::Abrupt);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_large_message_and_hundreds_of_requests_at_once_are_answered() {
    let text = "P1 = POINT/1,2,3  $$ 😀\n".repeat(20_000);
    let mut talk = Conversation::about(&text).await;
    let mut hovers = Vec::new();
    for line in 0..300 {
        hovers.push(talk.begin("textDocument/hover", at(line * 50, 0)).await);
    }
    let expected = format!("P1 of {} bytes", text.len());
    for hover in hovers {
        assert_eq!(talk.answer(hover).await.unwrap()["contents"]["value"], expected.as_str());
    }
    assert!(talk.text().await == text, "the text has changed on its way");
}

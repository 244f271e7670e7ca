//! The client's side of a conversation in memory.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use serde_json::{Value, json};
use tokio::io::{AsyncBufReadExt, AsyncReadExt, AsyncWriteExt, BufReader, DuplexStream, ReadHalf, WriteHalf};
use tokio::task::JoinHandle;

use super::super::framing::{Waiting, write_frame};
use super::super::{Ending, serve};
use crate::analysis::fake::FakeLanguage;

/// A test that waits longer has failed; it says nothing about speed.
const PATIENCE: Duration = Duration::from_secs(60);

/// The document that most tests talk about.
pub(super) const URI: &str = "file:///part.apt";

async fn write_frames(mut waiting: Waiting, mut output: WriteHalf<DuplexStream>) {
    while let Some(body) = waiting.recv().await {
        if write_frame(&mut output, &body).await.is_err() {
            return;
        }
    }
}

/// A conversation with a server.
pub(super) struct Conversation {
    input: BufReader<ReadHalf<DuplexStream>>,
    output: WriteHalf<DuplexStream>,
    server: JoinHandle<Ending>,
    /// The toy language behind the server.
    pub language: FakeLanguage,
    /// What came while something else was waited for.
    waiting: VecDeque<Value>,
    requests: i64,
    /// What the server answered to `initialize`.
    pub capabilities: Value,
}

impl Conversation {
    /// A conversation before its first word.
    pub(super) fn silent() -> Self {
        let (here, there) = tokio::io::duplex(1 << 16);
        let language = FakeLanguage::default();
        let (there_in, there_out) = tokio::io::split(there);
        let writer = |waiting| tokio::spawn(write_frames(waiting, there_out));
        let server = tokio::spawn(serve(there_in, writer, Arc::new(language.clone())));
        let (input, output) = tokio::io::split(here);
        Self {
            input: BufReader::new(input),
            output,
            server,
            language,
            waiting: VecDeque::new(),
            requests: 0,
            capabilities: Value::Null,
        }
    }

    /// A conversation with a client that can do this.
    pub(super) async fn with(capabilities: Value) -> Self {
        let mut talk = Self::silent();
        let answer = talk.ask("initialize", json!({ "capabilities": capabilities })).await.unwrap();
        talk.capabilities = answer["capabilities"].clone();
        talk.tell("initialized", json!({})).await;
        talk
    }

    /// A conversation with a client that can do nothing special, about a document.
    pub(super) async fn about(text: &str) -> Self {
        let mut talk = Self::with(json!({})).await;
        talk.open(text).await;
        talk
    }

    pub(super) async fn open(&mut self, text: &str) {
        let document = json!({ "uri": URI, "languageId": "apt", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document })).await;
    }

    /// Replaces a piece of line `line`.
    pub(super) async fn change(&mut self, version: i64, line: u32, from: u32, to: u32, text: &str) {
        let range =
            json!({ "start": { "line": line, "character": from }, "end": { "line": line, "character": to } });
        self.changes(version, json!([{ "range": range, "text": text }])).await;
    }

    pub(super) async fn changes(&mut self, version: i64, changes: Value) {
        let document = json!({ "uri": URI, "version": version });
        self.tell("textDocument/didChange", json!({ "textDocument": document, "contentChanges": changes }))
            .await;
    }

    /// What the server thinks the text is.
    pub(super) async fn text(&mut self) -> String {
        let answer = self.ask("apt/syntaxTree", json!({ "uri": URI })).await.unwrap();
        answer["text"].as_str().unwrap().to_owned()
    }

    pub(super) async fn write(&mut self, bytes: &[u8]) {
        self.output.write_all(bytes).await.unwrap();
    }

    pub(super) async fn send(&mut self, message: Value) {
        let body = message.to_string();
        self.write(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes()).await;
    }

    pub(super) async fn tell(&mut self, method: &str, params: Value) {
        self.send(json!({ "jsonrpc": "2.0", "method": method, "params": params })).await;
    }

    /// Sends a request without waiting for its answer.
    pub(super) async fn begin(&mut self, method: &str, params: Value) -> i64 {
        self.requests += 1;
        let id = self.requests;
        self.send(json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params })).await;
        id
    }

    /// The answer to a request.
    pub(super) async fn answer(&mut self, id: i64) -> Result<Value, Value> {
        let answer = self.wait(|message| message["id"] == id && message.get("method").is_none()).await;
        match answer.get("error") {
            Some(error) => Err(error.clone()),
            None => Ok(answer["result"].clone()),
        }
    }

    pub(super) async fn ask(&mut self, method: &str, params: Value) -> Result<Value, Value> {
        let id = self.begin(method, params).await;
        self.answer(id).await
    }

    /// The same, about a place in the document.
    pub(super) async fn ask_at(&mut self, method: &str, line: u32, character: u32) -> Result<Value, Value> {
        self.ask(method, at(line, character)).await
    }

    pub(super) async fn cancel(&mut self, id: i64) {
        self.tell("$/cancelRequest", json!({ "id": id })).await;
    }

    /// The first message that is wanted; others wait for those who want them.
    pub(super) async fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        if let Some(at) = self.waiting.iter().position(&wanted) {
            return self.waiting.remove(at).unwrap();
        }
        loop {
            let message = self.read().await.expect("the server has ended the conversation");
            if wanted(&message) {
                return message;
            }
            self.waiting.push_back(message);
        }
    }

    pub(super) async fn wait_for(&mut self, method: &str) -> Value {
        self.wait(|message| message["method"] == method).await
    }

    /// What has come already and nobody wanted.
    pub(super) fn unwanted(&self, method: &str) -> usize {
        self.waiting.iter().filter(|message| message["method"] == method).count()
    }

    async fn read(&mut self) -> Option<Value> {
        let read = async {
            let mut length = 0;
            loop {
                let mut line = String::new();
                if self.input.read_line(&mut line).await.unwrap() == 0 {
                    return None;
                }
                match line.trim() {
                    "" => break,
                    header => length = header.strip_prefix("Content-Length: ").unwrap().parse().unwrap(),
                }
            }
            let mut body = vec![0; length];
            self.input.read_exact(&mut body).await.unwrap();
            Some(serde_json::from_slice(&body).unwrap())
        };
        tokio::time::timeout(PATIENCE, read).await.expect("the server says nothing")
    }

    /// Waits until so many slow works are under way.
    pub(super) async fn until_running(&self, works: u64) {
        until(&self.language, |language| language.running.load(Ordering::SeqCst) == works).await;
    }

    /// Closes the client's end and waits for the server to end.
    pub(super) async fn end(mut self) -> Ending {
        self.output.shutdown().await.unwrap();
        self.ended().await
    }

    /// Waits for the server to end by itself.
    pub(super) async fn ended(self) -> Ending {
        tokio::time::timeout(PATIENCE, self.server).await.expect("the server does not end").unwrap()
    }
}

/// A place in the document.
pub(super) fn at(line: u32, character: u32) -> Value {
    json!({ "textDocument": { "uri": URI }, "position": { "line": line, "character": character } })
}

/// The document.
pub(super) fn document() -> Value {
    json!({ "textDocument": { "uri": URI } })
}

/// Waits until the toy language has come to something.
pub(super) async fn until(language: &FakeLanguage, reached: impl Fn(&FakeLanguage) -> bool) {
    let wait = async {
        while !reached(language) {
            tokio::time::sleep(Duration::from_millis(1)).await;
        }
    };
    tokio::time::timeout(PATIENCE, wait).await.expect("it never comes");
}

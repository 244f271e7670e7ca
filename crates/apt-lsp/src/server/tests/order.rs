//! Edits in order, answers from the text that was asked about, nothing stale.

use serde_json::{Value, json};

use super::conversation::{Conversation, URI, at};

/// A small generator of numbers, so that the burst is the same on every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % limit as u64) as usize
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_burst_of_edits_with_hovers_between_ends_with_the_same_text_and_no_stale_answer() {
    let mut text = "PARTNO burst\nP1 = POINT/1,2\nBAD\n".to_owned();
    let mut talk = Conversation::about(&text).await;
    let mut numbers = Numbers(7);
    let mut expected = Vec::new();
    for version in 2..202 {
        let line = numbers.below(text.split('\n').count());
        let length = text.split('\n').nth(line).unwrap().len();
        let (from, to) = (numbers.below(length + 1), numbers.below(length + 1));
        let (from, to) = (from.min(to), from.max(to));
        let insert = ["", "X", "1,2", "\nQ", "BAD "][numbers.below(5)];
        let start: usize = text.split('\n').take(line).map(|line| line.len() + 1).sum();
        text.replace_range(start + from..start + to, insert);
        talk.change(version, line as u32, from as u32, to as u32, insert).await;
        let hover = talk.begin("textDocument/hover", at(0, 2)).await;
        expected.push((hover, text.len(), text.clone()));
    }
    for (hover, length, text) in expected {
        let answer = talk.answer(hover).await.unwrap();
        let Some(told) = answer["contents"]["value"].as_str() else {
            let line = text.split('\n').next().unwrap().as_bytes();
            let word = |at: usize| line.get(at).is_some_and(u8::is_ascii_alphanumeric);
            assert!(!word(2) && !word(1), "no hover on a word of {text:?}");
            continue;
        };
        assert!(told.ends_with(&format!(" of {length} bytes")), "{told} instead of {length}");
    }
    assert_eq!(talk.text().await, text);
}

#[tokio::test(flavor = "multi_thread")]
async fn pushed_findings_name_their_version_and_the_last_ones_are_of_the_last_version() {
    let mut talk = Conversation::about("BAD\n").await;
    for version in 2..50 {
        talk.change(version, 0, 0, 0, "BAD ").await;
    }
    let mut seen = 0;
    loop {
        let params = talk.wait_for("textDocument/publishDiagnostics").await["params"].clone();
        let version = params["version"].as_i64().unwrap();
        assert!(version > seen, "version {version} after {seen}");
        assert_eq!(params["diagnostics"].as_array().unwrap().len() as i64, version, "one BAD per version");
        seen = version;
        if version == 49 {
            break;
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn an_edit_cancels_the_work_of_the_old_version() {
    let mut talk = Conversation::about("SLOW BAD\n").await;
    talk.until_running(1).await;
    let run = talk.begin("apt/runMotion", json!({ "uri": URI })).await;
    talk.until_running(2).await;
    talk.change(2, 0, 0, 4, "FAST").await;
    assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32801);
    talk.until_running(0).await;
    let pushed = |version: i64| {
        move |message: &Value| {
            message["method"] == "textDocument/publishDiagnostics" && message["params"]["version"] == version
        }
    };
    let params = talk.wait(pushed(2)).await["params"].clone();
    assert_eq!(params["diagnostics"][0]["range"]["start"]["character"], 5);
}

#[tokio::test(flavor = "multi_thread")]
async fn findings_of_slow_motion_do_not_hold_up_the_others() {
    let mut talk = Conversation::about("SLOW BAD\n").await;
    let params = talk.wait_for("textDocument/publishDiagnostics").await["params"].clone();
    assert_eq!((params["version"].as_i64(), params["diagnostics"].as_array().unwrap().len()), (Some(1), 1));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_cancelled_run_is_answered_at_once_and_stops_within_a_few_steps() {
    let mut talk = Conversation::with(json!({ "textDocument": { "diagnostic": {} } })).await;
    talk.open("SLOW\n").await;
    let run = talk.begin("apt/runMotion", json!({ "uri": URI })).await;
    talk.until_running(1).await;
    let before = talk.language.steps.load(std::sync::atomic::Ordering::SeqCst);
    talk.cancel(run).await;
    assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32800);
    talk.until_running(0).await;
    let steps = talk.language.steps.load(std::sync::atomic::Ordering::SeqCst) - before;
    // A step of the toy takes a millisecond; the run would take 20,000.
    assert!(steps < 2_000, "{steps} steps after the cancel");
}

#[tokio::test(flavor = "multi_thread")]
async fn cheap_answers_do_not_wait_for_slow_work() {
    let mut talk = Conversation::with(json!({ "textDocument": { "diagnostic": {} } })).await;
    talk.open("SLOW\n").await;
    let mut runs = Vec::new();
    for _ in 0..20 {
        runs.push(talk.begin("apt/runMotion", json!({ "uri": URI })).await);
    }
    talk.until_running(20).await;
    assert_eq!(
        talk.ask_at("textDocument/hover", 0, 0).await.unwrap()["contents"]["value"],
        "SLOW of 5 bytes"
    );
    for run in &runs {
        talk.cancel(*run).await;
    }
    for run in runs {
        assert_eq!(talk.answer(run).await.unwrap_err()["code"], -32800);
    }
    talk.until_running(0).await;
}

#[tokio::test(flavor = "multi_thread")]
async fn old_versions_are_dropped_and_gaps_are_no_loss() {
    let mut talk = Conversation::about("A\n").await;
    talk.change(7, 0, 1, 1, "B").await;
    talk.change(7, 0, 1, 1, "same version").await;
    talk.change(3, 0, 1, 1, "older version").await;
    talk.change(8, 0, 2, 2, "C").await;
    assert_eq!(talk.text().await, "ABC\n");
    for _ in 0..2 {
        let log = talk.wait_for("window/logMessage").await;
        assert!(log["params"]["message"].as_str().unwrap().contains("after version 7"), "{log}");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn several_changes_in_one_message_follow_each_other() {
    let mut talk = Conversation::about("P1=POINT/1,2\r\n$$ 😀 é\r\n").await;
    let range = |from: (u32, u32), to: (u32, u32)| json!({ "start": { "line": from.0, "character": from.1 }, "end": { "line": to.0, "character": to.1 } });
    talk.changes(
        2,
        json!([
            { "range": range((1, 5), (1, 6)), "text": "x" },
            { "range": range((0, 0), (0, 2)), "text": "PT" },
            { "range": range((1, 3), (1, 5)), "text": "" },
            { "range": range((9, 9), (9, 9)), "text": "FINI" },
        ]),
    )
    .await;
    assert_eq!(talk.text().await, "PT=POINT/1,2\r\n$$ xé\r\nFINI");
    talk.changes(3, json!([{ "text": "PARTNO new" }, { "range": range((0, 6), (0, 6)), "text": " brand" }]))
        .await;
    assert_eq!(talk.text().await, "PARTNO brand new");
}

#[tokio::test(flavor = "multi_thread")]
async fn positions_are_told_in_the_negotiated_encoding() {
    for (offered, name, column) in
        [(json!([]), "utf-16", 6), (json!(["utf-32"]), "utf-32", 5), (json!(["utf-16", "utf-8"]), "utf-8", 9)]
    {
        let mut talk = Conversation::with(json!({ "general": { "positionEncodings": offered } })).await;
        assert_eq!(talk.capabilities["positionEncoding"], name);
        talk.open("é 😀 \u{20}BAD 😀").await;
        let params = talk.wait_for("textDocument/publishDiagnostics").await["params"].clone();
        let range = &params["diagnostics"][0]["range"];
        assert_eq!(range["start"]["character"], column, "{name}");
        talk.change(2, 0, column, column + 3, "GOOD").await;
        assert_eq!(talk.text().await, "é 😀 \u{20}GOOD 😀", "{name}");
    }
}

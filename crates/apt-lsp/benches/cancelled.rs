//! How long who cancels a long work of the server waits for its answer: the real binary over its standard streams, from the message to the
//! answer. How long the work goes on behind it tells the benchmark `silence`.

#![allow(missing_docs, reason = "a benchmark")]
#![allow(clippy::unwrap_used, reason = "a benchmark may stop at once")]

#[path = "../tests/support/mod.rs"]
mod support;

use std::{fmt::Write as _, sync::Mutex, time::Duration};

use divan::Bencher;
use serde_json::{Value, json};
use support::Server;

fn main() {
    divan::main();
}

const URI: &str = "file:///bench/long.apt";

/// How long a work goes on before it is cancelled: from the first of it to well into it.
const GOES_ON_MS: [u64; 5] = [20, 50, 100, 200, 400];

/// What the protocol calls a request that was cancelled.
const CANCELLED: i64 = -32800;

/// A position in each of 100,000 turns.
fn turns() -> String {
    "PARTNO TURNS\nCUTTER/.5\nFROM/0,0,0\nLOOPST\nI=0\nA) I=I+1\nGOTO/(I/10),(I/7),1\nIF(I-100000) A,B,B\nB) CONTIN\nLOOPND\nFINI\n"
        .to_owned()
}

/// 300 positions, 2,000 times.
fn copies() -> String {
    let mut text = "PARTNO COPIES\nCUTTER/.5\nFROM/0,0,0\nINDEX/1\n".to_owned();
    for position in 0..300 {
        let _ = writeln!(text, "GOTO/{},{},1", position % 17, position % 13);
    }
    text + "COPY/1,TRANSL,1,0,0,2000\nFINI\n"
}

/// A pass over a saddle in bands of a hundred-thousandth, 40 times.
fn passes() -> String {
    let mut text =
        "PARTNO PASSES\nNUMPTS/100000\nCUTTER/.5,.1\nTOLER/.00001\nPS=QADRIC/1,-1,0,0,0,0,0,0,-1,0\n"
            .to_owned();
    for pass in 0..40 {
        let _ = writeln!(
            text,
            "FROM/-3,{y},9\nINDIRV/0,0,-1\nGO/ON,(PLANE/1,0,0,-2),TO,PS,ON,(PLANE/0,1,0,{y})\nINDIRV/1,0,0\n\
             TLON,GOFWD/(PLANE/0,1,0,{y}),ON,(PLANE/1,0,0,2)",
            y = f64::from(pass) / 50.
        );
    }
    text + "FINI\n"
}

fn cancel(bencher: Bencher<'_, '_>, text: &str, method: &str, parameters: &Value) {
    let mut server = Server::initialized(&json!({}));
    server.open(URI, text);
    let server = Mutex::new((server, 1));
    let mut parameters = parameters.clone();
    parameters["uri"] = json!(URI);
    bencher
        .with_inputs(|| {
            let (server, version) = &mut *server.lock().unwrap();
            *version += 1;
            // A changed name of the part, so that nothing is known of the work beforehand.
            server.change(URI, *version, 0, 7, 8, &(*version % 10).to_string());
            let request = server.begin(method, parameters.clone());
            let goes_on = GOES_ON_MS[usize::try_from(*version).unwrap() % GOES_ON_MS.len()];
            std::thread::sleep(Duration::from_millis(goes_on));
            request
        })
        .bench_values(|request| {
            let (server, _) = &mut *server.lock().unwrap();
            server.tell("$/cancelRequest", json!({ "id": request }));
            if let Err(error) = server.answer(request) {
                assert_eq!(error["code"], CANCELLED);
            }
        });
}

#[divan::bench(sample_size = 1, sample_count = 50)]
fn run_of_turns(bencher: Bencher<'_, '_>) {
    cancel(bencher, &turns(), "apt/runMotion", &json!({}));
}

#[divan::bench(sample_size = 1, sample_count = 50)]
fn run_of_copies(bencher: Bencher<'_, '_>) {
    cancel(bencher, &copies(), "apt/runMotion", &json!({}));
}

#[divan::bench(sample_size = 1, sample_count = 50)]
fn run_of_passes(bencher: Bencher<'_, '_>) {
    cancel(bencher, &passes(), "apt/runMotion", &json!({}));
}

#[divan::bench(sample_size = 1, sample_count = 50)]
fn expansion_of_turns(bencher: Bencher<'_, '_>) {
    cancel(bencher, &turns(), "apt/expand", &json!({}));
}

#[divan::bench(sample_size = 1, sample_count = 50)]
fn control_tape_of_copies(bencher: Bencher<'_, '_>) {
    cancel(bencher, &copies(), "apt/post", &json!({ "machine": "linuxcnc-mill3" }));
}

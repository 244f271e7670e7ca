//! What the server takes of memory while somebody works on a program.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test may stop at once")]

mod support;

use std::fmt::Write as _;

use serde_json::json;
use support::Server;

const URI: &str = "file:///parts/thousand-lines.apt";

/// The most that a program of 1,000 lines may ever have taken, MiB, with optimised code.
const MOST: u64 = 30;
/// The same without the pages of the program file, which are several times as many where the code is not optimised.
const MOST_WITHOUT_CODE: u64 = 16;

/// Points, lines, calls of a macro and positions, of which every seventh is a mistake.
fn program() -> String {
    let mut text =
        "PARTNO MEMORY\nCUTTER/10,1\nINTOL/.01\nOUTTOL/.01\nP0=POINT/0,0,0\nM0=MACRO/DX=1,DY=2\nGODLTA/DX,DY,0\nTERMAC\nFROM/P0\n"
            .to_owned();
    for number in 0..165 {
        let (x, y) = (number % 30, 7 * number % 20);
        let _ = write!(
            text,
            "A{number}=POINT/{x},{y},1\nB{number}=POINT/{y},{x},2.5\nL{number}=LINE/A{number},B{number}\n\
             CALL/M0,DX={x}\nGOTO/A{number}\nSPINDL/{}\n",
            if number % 7 == 0 { "NONAME".to_owned() } else { (1000 + number).to_string() }
        );
    }
    text + "FINI\n"
}

#[test]
fn a_program_of_a_thousand_lines_takes_little_memory_of_the_server() {
    let mut server = Server::initialized(&json!({}));
    server.open(URI, &program());
    let findings = |version: i64| {
        move |message: &serde_json::Value| {
            message["method"] == "textDocument/publishDiagnostics" && message["params"]["version"] == version
        }
    };
    assert_ne!(server.wait(findings(1))["params"]["diagnostics"], json!([]));
    for version in 2..40_i64 {
        let line = usize::try_from(20 * version).unwrap();
        server.change(URI, version, line, 0, 0, if version % 2 == 0 { "9" } else { "" });
        server.wait(findings(version));
    }
    let document = json!({ "textDocument": { "uri": URI } });
    for method in ["documentSymbol", "foldingRange", "semanticTokens/full", "codeLens"] {
        server.ask(&format!("textDocument/{method}"), document.clone()).unwrap();
    }
    assert_eq!(server.ask("apt/runMotion", json!({ "uri": URI })).unwrap()["ok"], false);
    let [most, code] = server.most_resident();
    assert!(most - code <= MOST_WITHOUT_CODE << 20, "{} kB, {} of code", most >> 10, code >> 10);
    if !cfg!(debug_assertions) {
        assert!(most <= MOST << 20, "{} kB", most >> 10);
    }
}

//! What the editors' packages say of the server's settings.

use std::collections::BTreeSet;

use apt_tests::repository;

/// Settings of the extension itself: where the server is, and what is logged of it.
const OF_THE_EXTENSION: [&str; 2] = ["server.path", "trace.server"];

fn read(path: &str) -> String {
    std::fs::read_to_string(repository(path)).expect("the file is there")
}

/// The words in quotation marks of a list that begins with `beginning`.
fn listed(text: &str, beginning: &str, quote: char) -> BTreeSet<String> {
    let (_, rest) = text.split_once(beginning).unwrap_or_else(|| panic!("there is no {beginning}"));
    let (list, _) = rest.split_once(']').expect("the list ends");
    list.split(quote).skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn every_setting_of_the_server_is_one_of_visual_studio_code_and_reaches_the_server() {
    let source = read("crates/apt-lsp/src/settings.rs");
    let mut of_server = listed(&source, "const KEYS: [&str; 8] =\n    [", '"');
    of_server.insert("motion".to_owned());
    let package: serde_json::Value =
        serde_json::from_str(&read("editors/vscode/package.json")).expect("the package is JSON");
    let offered: BTreeSet<String> = package["contributes"]["configuration"]["properties"]
        .as_object()
        .expect("there are settings")
        .keys()
        .map(|key| key.strip_prefix("apt.").expect("all settings are under `apt.`").to_owned())
        .filter(|key| !OF_THE_EXTENSION.contains(&key.as_str()))
        .collect();
    assert_eq!(offered, of_server);
    let sent = listed(&read("editors/vscode/src/session.ts"), "const SERVER_SETTINGS = [", '\'');
    assert_eq!(sent, of_server);
}

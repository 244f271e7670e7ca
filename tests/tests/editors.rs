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

/// All keys of the settings of a program, those in tables with the name of the table.
fn keys_of_settings() -> BTreeSet<String> {
    let settings = serde_json::to_value(apt_run::settings::Settings::default()).expect("settings are data");
    let mut keys = BTreeSet::new();
    for (key, value) in settings.as_object().expect("a table") {
        match value.as_object().filter(|table| !table.is_empty()) {
            Some(table) => keys.extend(table.keys().map(|inner| format!("{key}.{inner}"))),
            None => _ = keys.insert(key.clone()),
        }
    }
    keys
}

/// `macro-depth` as editors write it.
fn camel_case(key: &str) -> String {
    let mut words = key.split('-');
    let first = words.next().unwrap_or_default().to_owned();
    words.fold(first, |name, word| {
        let (initial, rest) = word.split_at(word.len().min(1));
        name + &initial.to_ascii_uppercase() + rest
    })
}

#[test]
fn the_sample_of_a_project_file_has_every_key_and_can_be_read() {
    let page = read("docs/lints-and-style.md");
    let (_, section) = page.split_once("## The project file").expect("there is a section");
    let (_, sample) = section.split_once("```toml\n").expect("there is a sample");
    let (sample, _) = sample.split_once("```").expect("the sample ends");
    // The server keeps `motion`, which is no setting of the program.
    let of_program: String =
        sample.split_inclusive('\n').filter(|line| !line.starts_with("motion")).collect();
    assert_ne!(of_program, sample, "motion is told, too");
    let settings = apt_run::settings::parse_project_file(&of_program).expect("the sample can be read");
    let usual = apt_run::settings::Settings::default();
    assert_eq!(settings.budget, usual.budget, "the budget is the usual one");
    for key in keys_of_settings() {
        let (table, name) = key.split_once('.').unwrap_or(("", &key));
        let beginning = if table.is_empty() { String::new() } else { format!("[{table}]\n") };
        let place = of_program.find(&beginning).unwrap_or_else(|| panic!("there is no [{table}]"));
        let told = of_program[place..]
            .lines()
            .any(|line| line.starts_with(&format!("{name} =")) || line == format!("[{name}]"));
        assert!(told, "{key} is not told");
    }
}

#[test]
fn the_tables_of_settings_have_all_keys_in_visual_studio_code() {
    let package: serde_json::Value =
        serde_json::from_str(&read("editors/vscode/package.json")).expect("the package is JSON");
    let offered = &package["contributes"]["configuration"]["properties"];
    for table in ["format", "budget"] {
        let keys = keys_of_settings();
        let expected: BTreeSet<String> = keys
            .iter()
            .filter_map(|key| key.strip_prefix(table)?.strip_prefix('.'))
            .map(camel_case)
            .collect();
        let told = offered[format!("apt.{table}")]["properties"].as_object();
        let told: BTreeSet<String> =
            told.into_iter().flat_map(|properties| properties.keys().cloned()).collect();
        assert_eq!(told, expected, "{table}");
    }
}

/// The endings of file names by which the editors know programs stand in what they tell their users.
#[test]
fn the_endings_of_programs_are_told() {
    let package: serde_json::Value =
        serde_json::from_str(&read("editors/vscode/package.json")).expect("the package is JSON");
    let page = read("editors/vscode/README.md");
    for ending in package["contributes"]["languages"][0]["extensions"].as_array().expect("there are endings")
    {
        let ending = ending.as_str().expect("an ending is text");
        assert!(page.contains(&format!("`{ending}`")), "{ending} in the page of Visual Studio Code");
    }
    let source = read("editors/nvim/lua/apt/filetype.lua");
    let page = read("editors/nvim/doc/apt.txt");
    let lists = ["local CERTAIN = {", "local SHARED = {"];
    let endings = lists.iter().flat_map(|list| {
        let (_, rest) = source.split_once(list).unwrap_or_else(|| panic!("there is no {list}"));
        let (list, _) = rest.split_once('}').expect("the list ends");
        list.split('\'').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
    });
    for ending in endings {
        let told = page.split([' ', ',', '\n']).any(|word| word == format!(".{ending}"));
        assert!(told, ".{ending} in the help of Neovim");
    }
}

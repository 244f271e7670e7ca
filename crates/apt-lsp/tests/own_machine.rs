//! A machine of one's own: a definition file that begins as a copy of a bundled one.

mod support;

use serde_json::json;

use support::{Folder, Server, run};

const PROGRAM: &str = "PARTNO OWN\nLOADTL/7\nSPINDL/1000,CLW\nFEDRAT/10\nGOTO/1,0,1\nFINI\n";

/// A bundled definition with a magazine of five tools and an ending of its own.
fn definition() -> String {
    let printed = run(&["machines", "fanuc-mill3"]);
    assert_eq!(printed.code, 0, "{printed:?}");
    let own = printed.stdout.replace("tools = [1, 24]", "tools = [1, 5]").replace("\"M30\"", "\"M2\"");
    assert!(own.contains("tools = [1, 5]") && own.contains("\"M2\"") && own != printed.stdout, "{own}");
    own
}

#[test]
fn a_definition_is_printed_to_begin_with() {
    assert!(run(&["machines", "haas-mill3"]).stdout.contains("id = \"haas-mill3\""));
    assert_eq!(run(&["machines", "HAAS"]).stdout, run(&["machines", "haas-mill3"]).stdout);
    let unknown = run(&["machines", "nonsense"]);
    assert!(unknown.code == 2 && unknown.stdout.is_empty(), "{unknown:?}");
    assert!(unknown.stderr.contains("there is no machine named `nonsense`"), "{unknown:?}");
}

/// What is typed stands beside the shell, what the project says beside the project file, as the folders of `include` do.
#[test]
fn a_definition_file_is_a_machine() {
    let folder = Folder::new("own-machine");
    folder.write("parts/own.apt", PROGRAM);
    folder.write("shop/mill.toml", definition());
    let typed = folder.run(&["post", "parts/own.apt", "--machine", "shop/mill.toml"]);
    assert!(typed.code == 0 && typed.stdout.contains("M2\n") && !typed.stdout.contains("M30"), "{typed:?}");
    assert!(typed.stderr.contains("APT0862"), "the magazine has five tools: {typed:?}");
    folder.write("apt-lsp.toml", "machine = \"shop/mill.toml\"\n");
    assert_eq!(folder.run(&["post", "parts/own.apt"]).stdout, typed.stdout);
    let checked = folder.run(&["--check", "parts/own.apt"]);
    assert!(checked.stdout.contains("APT0862"), "{checked:?}");
}

#[test]
fn a_definition_that_cannot_be_used_is_told() {
    let folder = Folder::new("no-machine");
    folder.write("own.apt", PROGRAM);
    folder.write("broken.toml", "schema = 1\nid = 3\n");
    folder.write("apt-lsp.toml", "machine = \"broken.toml\"\n");
    for (name, why) in [("none.toml", "none.toml"), ("broken.toml", "line 2")] {
        let ran = folder.run(&["post", "own.apt", "--machine", name]);
        assert!(ran.code == 2 && ran.stdout.is_empty() && ran.stderr.contains(why), "{name}: {ran:?}");
    }
    let checked = folder.run(&["--check", "own.apt"]);
    assert!(checked.stdout.contains("APT0894") && checked.stdout.contains("broken.toml"), "{checked:?}");
}

/// The settings of an editor know no folder: what they name stands beside the program.
#[test]
fn an_editor_names_a_definition_beside_the_program() {
    let folder = Folder::new("editor-machine");
    let program = std::fs::canonicalize(folder.write("own.apt", PROGRAM)).unwrap();
    folder.write("mill.toml", definition());
    let uri = format!("file://{}", program.display());
    let mut server = Server::initialized(&json!({}));
    server.open(&uri, PROGRAM);
    let argument = json!({ "uri": uri, "machine": "mill.toml" });
    let call = json!({ "command": "apt.post", "arguments": [argument] });
    let tape = server.ask("workspace/executeCommand", call).unwrap();
    let blocks = tape["blocks"].to_string();
    assert!(blocks.contains("M2\"") && !blocks.contains("M30"), "{tape}");
}

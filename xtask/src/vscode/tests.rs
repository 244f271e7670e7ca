//! Tests of the extension: its grammar, inside the real extension host, and clicked through in a browser.

use std::path::Path;

use super::{host, install_modules, npm_run, package};
use crate::failure::{Failure, FileContext, Outcome};
use crate::layout;
use crate::process::{Call, TestCount, find_program};

/// Seconds after which a test program is stopped: each takes half a minute on two idle cores, and a hang must not
/// stop CI.
const LIMIT_SECONDS: &str = "420";

/// Runs all tests of the extension with the server binary `server`.
pub(crate) fn run(server: &Path, count: &mut TestCount) -> Outcome {
    let chromium = std::env::var_os("CHROMIUM").map(Into::into).or_else(|| find_program("chromium"));
    let chromium = chromium.ok_or_else(|| Failure::Missing {
        what: "chromium".to_owned(),
        remedy: "run `cargo xtask setup`".to_owned(),
    })?;
    install_modules()?;
    let results = layout::work().join("vscode-test");
    if results.exists() {
        std::fs::remove_dir_all(&results).on("remove", &results)?;
    }
    std::fs::create_dir_all(&results).on("create", &results)?;
    let vsix = results.join("apt.vsix");
    package::with_server(server, &vsix)?;
    npm_run("bundle-tests")?;
    let host = host::install()?;
    let script = |name: &str| {
        Call::new("timeout")
            .args([LIMIT_SECONDS.as_ref(), host.node.as_os_str()])
            .args([layout::vscode().join("test").join(name)])
            .folder(layout::vscode())
            .env("APT_LSP", server)
            .env("APT_VSIX", &vsix)
            .env("APT_RESULTS", &results)
            .env("APT_HOST_NODE", &host.node)
            .env("APT_HOST_ENTRY", &host.entry)
            .env("APT_HOST_SERVER", &host.server)
            .env("CHROMIUM", &chromium)
    };
    // All three run, whatever one of them says: one run shall tell everything.
    let outcomes = [
        script("grammar.mjs").run_counting(count),
        script("in-host.mjs").run_counting(count),
        script("clicks.mjs").run_counting(count),
    ];
    println!("screenshots and logs: {}", results.display());
    outcomes.into_iter().collect()
}

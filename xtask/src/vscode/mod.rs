//! The VS Code extension: its package and its tests in the real workbench.

pub(crate) mod host;
pub(crate) mod package;
pub(crate) mod tests;

use crate::failure::Outcome;
use crate::layout;
use crate::process::Call;

/// Switches of every npm call: no install scripts (they would fetch programs), no questions, no noise.
const NPM_SWITCHES: &[&str] = &["--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"];

/// Installs exactly what the lock file of the extension names, unless that has been done.
fn install_modules() -> Outcome {
    let folder = layout::vscode();
    let lock = folder.join("package-lock.json");
    let installed = folder.join("node_modules/.package-lock.json");
    let newer = |a: &std::path::Path, b: &std::path::Path| {
        let time = |p: &std::path::Path| p.metadata().and_then(|m| m.modified()).ok();
        matches!((time(a), time(b)), (Some(a), Some(b)) if a >= b)
    };
    if newer(&installed, &lock) {
        return Ok(());
    }
    Call::new("npm").args(["ci"]).args(NPM_SWITCHES).folder(folder).run()
}

/// Runs a script of the extension's `package.json`.
fn npm_run(script: &str) -> Outcome {
    Call::new("npm").args(["run", "--silent", script]).folder(layout::vscode()).run()
}

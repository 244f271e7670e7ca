//! The package of the extension, with the release binary of the server in it.

use std::path::Path;

use super::{install_modules, npm_run};
use crate::failure::{FileContext, Outcome};
use crate::layout;
use crate::process::Call;

/// Builds server and extension and writes the package to `output`.
pub(crate) fn run(output: &Path) -> Outcome {
    Call::new("cargo")
        .args(["build", "--release", "--locked", "--package", "apt-lsp"])
        .folder(layout::root())
        .run()?;
    install_modules()?;
    with_server(&layout::server("release"), output)
}

/// Writes a package with the binary `server` in it.
pub(super) fn with_server(server: &Path, output: &Path) -> Outcome {
    let folder = layout::vscode().join("server");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).on("remove", &folder)?;
    }
    std::fs::create_dir_all(&folder).on("create", &folder)?;
    let bundled = folder.join(format!("apt-lsp{}", std::env::consts::EXE_SUFFIX));
    std::fs::copy(server, &bundled).on("copy", server)?;
    npm_run("check")?;
    npm_run("bundle")?;
    if let Some(parent) = output.parent() {
        std::fs::create_dir_all(parent).on("create", parent)?;
    }
    Call::new(layout::vscode().join("node_modules/.bin/vsce"))
        .args(["package", "--no-dependencies", "--allow-missing-repository", "--out"])
        .args([output])
        .folder(layout::vscode())
        .run()?;
    println!("packaged {}", output.display());
    Ok(())
}

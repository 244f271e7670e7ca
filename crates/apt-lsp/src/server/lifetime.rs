//! When the process ends: after a panic of the server itself, and when its parent is gone.

use std::io::Write as _;
use std::time::Duration;

/// Exit code after a panic, as Rust programs have it.
pub(super) const EXIT_AFTER_PANIC: i32 = 101;

/// How often the parent is looked for. Closed standard input tells it sooner in nearly every case.
const PARENT_CHECK: Duration = Duration::from_secs(2);

/// Writes a line to standard error. There is nobody to tell if that fails.
pub(super) fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "apt-lsp: {text}");
}

/// Panics are told on standard error with their place; the work that panicked answers with an error.
pub(super) fn report_panics() {
    std::panic::set_hook(Box::new(|information| complain(&format!("internal fault: {information}"))));
}

/// Ends the process when the parent has ended without closing our input.
pub(super) fn watch_parent(process: i32) {
    if process <= 0 {
        return;
    }
    tokio::spawn(async move {
        while is_alive(process) {
            tokio::time::sleep(PARENT_CHECK).await;
        }
        complain("the editor is gone");
        std::process::exit(1);
    });
}

/// True if the process exists, or if that cannot be known here.
fn is_alive(process: i32) -> bool {
    if cfg!(target_os = "linux") {
        std::path::Path::new("/proc").join(process.to_string()).exists()
    } else if cfg!(unix) {
        let asked = std::process::Command::new("kill").arg("-0").arg(process.to_string()).output();
        asked.is_ok_and(|answer| answer.status.success())
    } else {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn living_and_dead_processes_are_told_apart() {
        assert!(is_alive(i32::try_from(std::process::id()).unwrap()));
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let id = i32::try_from(child.id()).unwrap();
        child.wait().unwrap();
        assert!(!is_alive(id));
    }
}

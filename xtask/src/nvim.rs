//! Tests of the Neovim plugin in the real Neovim.

use std::path::{Path, PathBuf};

use crate::failure::{FileContext, Outcome};
use crate::layout;
use crate::process::{Call, TestCount};

/// Seconds after which a test program is stopped: each takes about three; a hang must not stop CI.
const LIMIT_SECONDS: &str = "240";

/// Runs the plugin's tests in each of `programs` with the server binary `server`.
pub(crate) fn run(programs: &[PathBuf], server: &Path, count: &mut TestCount) -> Outcome {
    for program in programs {
        // Own folders, so that no configuration, history or log of the user is read or written.
        let home = layout::work().join("nvim-test");
        if home.exists() {
            std::fs::remove_dir_all(&home).on("remove", &home)?;
        }
        std::fs::create_dir_all(&home).on("create", &home)?;
        let plugin = layout::nvim();
        let test = |call: Call| {
            let mut call = call
                .folder(&home)
                .env("APT_LSP", server)
                .env("APT_TEST_FOLDER", plugin.join("test"))
                .env("APT_TEST_HOME", &home)
                .env("NVIM", program);
            for variable in ["XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"] {
                call = call.env(variable, home.join(variable));
            }
            call
        };
        let headless = Call::new("timeout")
            .args([LIMIT_SECONDS.as_ref(), program.as_os_str()])
            .args(["--headless", "--clean", "-n", "-i", "NONE", "--cmd"])
            .args([format!("set runtimepath^={}", plugin.display())])
            .args(["-c".to_owned(), format!("luafile {}", plugin.join("test/run.lua").display())]);
        let screen = Call::new("timeout").args([LIMIT_SECONDS]).args([plugin.join("test/screen.sh")]);
        // Both run, whatever the first one says: one run shall tell everything.
        let outcomes = [test(headless).run_counting(count), test(screen).run_counting(count)];
        outcomes.into_iter().collect::<Outcome>()?;
    }
    Ok(())
}

//! What the server holds, for whoever asks where the memory goes: the process as the system sees it, and of each open
//! document how much there is of what memory is spent on.

use serde_json::{Value, json};
use tower_lsp::jsonrpc::Result;

use super::{backend::Backend, job};

/// `apt.status`: the version of the server, its memory, and what it holds of the open documents. Nothing is computed
/// for it.
pub(super) async fn status(server: &Backend) -> Result<Value> {
    let open = job::snapshots(server.events()).await?;
    let documents: Vec<Value> = open
        .iter()
        .map(|snapshot| {
            let held = snapshot.document.holdings();
            json!({
                "uri": snapshot.uri.as_str(),
                "version": snapshot.version,
                "dialect": snapshot.document.dialect(),
                "lines": snapshot.index.rope.len_lines(),
                "bytes": held.bytes,
                "statements": held.statements,
                "records": held.records,
                "positions": held.positions,
                "motions": held.motions,
            })
        })
        .collect();
    Ok(json!({ "version": env!("CARGO_PKG_VERSION"), "memory": memory(), "documents": documents }))
}

/// The memory of the process in bytes, now and at its greatest; null where the system does not tell it this way.
fn memory() -> Value {
    let Ok(status) = std::fs::read_to_string("/proc/self/status") else { return Value::Null };
    json!({ "resident": kilobytes(&status, "VmRSS:"), "peak": kilobytes(&status, "VmHWM:") })
}

/// The bytes that a line `KEY 123 kB` tells.
fn kilobytes(status: &str, key: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix(key))?;
    line.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::kilobytes;

    #[test]
    fn a_line_of_the_system_tells_bytes() {
        let status = "Name:\tapt-lsp\nVmHWM:\t   20480 kB\nVmRSS:\t 10240 kB\n";
        assert_eq!(kilobytes(status, "VmRSS:"), Some(10 << 20));
        assert_eq!(kilobytes(status, "VmHWM:"), Some(20 << 20));
        assert_eq!(kilobytes(status, "VmSwap:"), None);
        assert_eq!(kilobytes("VmRSS: many kB", "VmRSS:"), None);
    }
}

//! Pushed findings: at once if there was quiet, or nothing to do, and else after a moment of quiet.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until, timeout};
use tower_lsp::ls_types::Uri;

use super::documents::{Event, Snapshot};
use super::job::{self, Events};
use crate::analysis::{Answer, Control, Interrupted, Level};
use crate::convert::{Places, Positions, outgoing, written};

/// Quiet after which a changed document is checked.
const QUIET: Duration = Duration::from_millis(40);

/// How long the findings of syntax and geometry wait for those of motion. In most programs motion is
/// done by then, and findings appear once instead of flickering.
const MOTION_GRACE: Duration = Duration::from_millis(50);

/// A document that has changed.
#[derive(Debug)]
pub(super) struct Touched(pub Uri);

/// Watches for quiet and starts checks. Ends with the owner of the documents.
pub(super) async fn watch(mut touched: mpsc::UnboundedReceiver<Touched>, events: Events) {
    let mut due: BTreeMap<Uri, Instant> = BTreeMap::new();
    let mut last_touched: BTreeMap<Uri, Instant> = BTreeMap::new();
    // The last check of each document, and whether it has told all that there was to tell.
    let mut checks: BTreeMap<Uri, Arc<AtomicBool>> = BTreeMap::new();
    loop {
        let next = due.values().min().copied();
        let quiet_over = async {
            match next {
                Some(at) => sleep_until(at).await,
                None => std::future::pending().await,
            }
        };
        let ready: Vec<Uri> = tokio::select! {
            message = touched.recv() => {
                let Some(Touched(uri)) = message else { return };
                let now = Instant::now();
                let was = last_touched.insert(uri.clone(), now);
                checks.retain(|_, told| !told.load(Ordering::Acquire));
                let done = !checks.contains_key(&uri) && !due.contains_key(&uri);
                last_touched.retain(|_, at| now - *at < QUIET);
                if done || was.is_none_or(|was| now - was >= QUIET) {
                    // Not by way of the timer, which counts whole milliseconds.
                    vec![uri]
                } else {
                    due.insert(uri, now + QUIET);
                    Vec::new()
                }
            }
            () = quiet_over => {
                let now = Instant::now();
                due.iter().filter(|(_, at)| **at <= now).map(|(uri, _)| uri.clone()).collect()
            }
        };
        for uri in ready {
            due.remove(&uri);
            let told = Arc::new(AtomicBool::new(false));
            checks.insert(uri.clone(), Arc::clone(&told));
            let check = check(uri, events.clone());
            tokio::spawn(async move { told.store(check.await, Ordering::Release) });
        }
    }
}

/// Checks a document, and gives the findings to the owner, who knows whether they still matter. Tells whether the check
/// came to its end.
async fn check(uri: Uri, events: Events) -> bool {
    let Ok(snapshot) = job::snapshot(&events, uri.clone()).await else { return false };
    let revision = snapshot.revision;
    let give = |message| {
        let _ = events.send(Event::Found { uri: uri.clone(), revision, message });
    };
    let mut motion = None;
    if wants_motion(&snapshot) {
        let mut work = Box::pin(findings_of(snapshot.clone(), Level::Motion));
        match timeout(MOTION_GRACE, &mut work).await {
            Ok(Ok(message)) => {
                give(message);
                return true;
            }
            Ok(_) => {} // Cancelled or broken: what Section 1 finds is still worth telling.
            Err(_) => motion = Some(work),
        }
    }
    let mut told = false;
    if let Ok(message) = findings_of(snapshot, Level::Section1).await {
        give(message);
        told = true;
    }
    match motion {
        None => told,
        Some(work) => match work.await {
            Ok(message) => {
                give(message);
                true
            }
            Err(_) => false,
        },
    }
}

/// The message that tells the findings of a snapshot.
async fn findings_of(snapshot: Snapshot, level: Level) -> tower_lsp::jsonrpc::Result<Vec<u8>> {
    job::on_snapshot("diagnostics", snapshot, move |snapshot, control| {
        let mut message = begun(&snapshot.uri);
        write_findings(&mut message, snapshot, level, control)?;
        message.extend_from_slice(b",\"version\":");
        written::value(&mut message, &snapshot.version);
        message.extend_from_slice(b"}}");
        Ok::<_, Interrupted>(message)
    })
    .await
}

/// The message that a document has no findings any more.
pub(super) fn none(uri: &Uri) -> Vec<u8> {
    let mut message = begun(uri);
    message.extend_from_slice(b"[]}}");
    message
}

/// The message that tells findings, up to these.
fn begun(uri: &Uri) -> Vec<u8> {
    let method = "\"method\":\"textDocument/publishDiagnostics\"";
    let mut message = format!("{{\"jsonrpc\":\"2.0\",{method},\"params\":{{\"uri\":").into_bytes();
    written::value(&mut message, uri);
    message.extend_from_slice(b",\"diagnostics\":");
    message
}

/// True if the findings of motion are wanted.
pub(super) fn wants_motion(snapshot: &Snapshot) -> bool {
    snapshot.settings.motion.unwrap_or(true)
}

/// The findings of an included file: what the programs that include it find in it. By itself it is no program.
fn write_findings_inside(
    out: &mut Vec<u8>,
    snapshot: &Snapshot,
    path: &Path,
    level: Level,
    control: &Control,
) -> Answer<()> {
    let mut shown: Vec<Vec<u8>> = Vec::new();
    let (mut positions, mut places) =
        (Positions::of(&snapshot.index), Places::new(&snapshot.uri, &snapshot.index, &snapshot.uris));
    for program in &snapshot.includers {
        for found in program.document.diagnostics_in(path, level, control)? {
            let mut one = Vec::new();
            written::diagnostic(&mut one, &mut positions, &mut places, &found);
            if !shown.contains(&one) && shown.len() < MOST_SHOWN {
                shown.push(one);
            }
        }
    }
    written::list(out, &shown, |out, one| out.extend_from_slice(one));
    Ok(())
}

/// Findings shown of one document. Nobody reads more, and editors show no more.
const MOST_SHOWN: usize = 1_000;

/// What a finding usually takes in a message (bytes).
const USUAL_LENGTH: usize = 256;

/// Writes the findings of a snapshot as a list: the gravest, and how many there are besides.
pub(super) fn write_findings(
    out: &mut Vec<u8>,
    snapshot: &Snapshot,
    level: Level,
    control: &Control,
) -> Answer<()> {
    if let Some(path) = snapshot.included_path() {
        return write_findings_inside(out, snapshot, &path, level, control);
    }
    let found = snapshot.document.worst_diagnostics(level, MOST_SHOWN, control)?;
    let (mut positions, mut places) = (Positions::of(&snapshot.index), snapshot.places());
    let left_out = (found.left_out > 0).then(|| outgoing::left_out(found.left_out));
    let shown = found.diagnostics.iter().map(Some).chain(left_out.is_some().then_some(None));
    out.reserve(found.diagnostics.len() * USUAL_LENGTH);
    written::list(out, shown, |out, one| match one {
        Some(one) => written::diagnostic(out, &mut positions, &mut places, one),
        None => written::value(out, &left_out),
    });
    Ok(())
}

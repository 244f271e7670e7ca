//! Pushed findings: at once if there was quiet, or nothing to do, and else after a moment of quiet.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until, timeout};
use tower_lsp::ls_types::{self as lsp, Uri};

use super::documents::{Event, Snapshot};
use super::job::{self, Events};
use crate::analysis::{Answer, Control, Level};
use crate::convert::{Places, outgoing};

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
        tokio::select! {
            message = touched.recv() => {
                let Some(Touched(uri)) = message else { return };
                let now = Instant::now();
                let was = last_touched.insert(uri.clone(), now);
                checks.retain(|_, told| !told.load(Ordering::Acquire));
                let done = !checks.contains_key(&uri) && !due.contains_key(&uri);
                let idle = done || was.is_none_or(|was| now - was >= QUIET);
                due.insert(uri, if idle { now } else { now + QUIET });
                last_touched.retain(|_, at| now - *at < QUIET);
            }
            () = quiet_over => {
                let now = Instant::now();
                let ready: Vec<Uri> = due.iter().filter(|(_, at)| **at <= now).map(|(uri, _)| uri.clone()).collect();
                for uri in ready {
                    due.remove(&uri);
                    let told = Arc::new(AtomicBool::new(false));
                    checks.insert(uri.clone(), Arc::clone(&told));
                    let check = check(uri, events.clone());
                    tokio::spawn(async move { told.store(check.await, Ordering::Release) });
                }
            }
        }
    }
}

/// Checks a document, and gives the findings to the owner, who knows whether they still matter. Tells whether the check
/// came to its end.
async fn check(uri: Uri, events: Events) -> bool {
    let Ok(snapshot) = job::snapshot(&events, uri.clone()).await else { return false };
    let revision = snapshot.revision;
    let give = |diagnostics| {
        let _ = events.send(Event::Found { uri: uri.clone(), revision, diagnostics });
    };
    let mut motion = None;
    if wants_motion(&snapshot) {
        let mut work = tokio::spawn(findings_of(snapshot.clone(), Level::Motion));
        match timeout(MOTION_GRACE, &mut work).await {
            Ok(Ok(Ok(diagnostics))) => {
                give(diagnostics);
                return true;
            }
            Ok(_) => {} // Cancelled or broken: what Section 1 finds is still worth telling.
            Err(_) => motion = Some(work),
        }
    }
    let mut told = false;
    if let Ok(diagnostics) = findings_of(snapshot, Level::Section1).await {
        give(diagnostics);
        told = true;
    }
    match motion {
        None => told,
        Some(work) => match work.await {
            Ok(Ok(diagnostics)) => {
                give(diagnostics);
                true
            }
            _ => false,
        },
    }
}

async fn findings_of(snapshot: Snapshot, level: Level) -> tower_lsp::jsonrpc::Result<Vec<lsp::Diagnostic>> {
    job::on_snapshot("diagnostics", snapshot, move |snapshot, control| findings(snapshot, level, control))
        .await
}

/// True if the findings of motion are wanted.
pub(super) fn wants_motion(snapshot: &Snapshot) -> bool {
    snapshot.settings.motion.unwrap_or(true)
}

/// The findings of an included file: what the programs that include it find in it. By itself it is no program.
fn findings_inside(
    snapshot: &Snapshot,
    path: &Path,
    level: Level,
    control: &Control,
) -> Answer<Vec<lsp::Diagnostic>> {
    let mut shown: Vec<lsp::Diagnostic> = Vec::new();
    let mut places = Places::new(&snapshot.uri, &snapshot.index, &snapshot.uris);
    for program in &snapshot.includers {
        for found in program.document.diagnostics_in(path, level, control)? {
            let found = outgoing::diagnostic(&snapshot.index, &mut places, &found);
            if !shown.contains(&found) && shown.len() < MOST_SHOWN {
                shown.push(found);
            }
        }
    }
    Ok(shown)
}

/// Findings shown of one document. Nobody reads more, and editors show no more.
const MOST_SHOWN: usize = 1_000;

/// The findings of a snapshot: the gravest, and how many there are besides.
pub(super) fn findings(snapshot: &Snapshot, level: Level, control: &Control) -> Answer<Vec<lsp::Diagnostic>> {
    if let Some(path) = snapshot.included_path() {
        return findings_inside(snapshot, &path, level, control);
    }
    let found = snapshot.document.worst_diagnostics(level, MOST_SHOWN, control)?;
    let mut places = snapshot.places();
    let convert = |found| outgoing::diagnostic(&snapshot.index, &mut places, found);
    let mut shown: Vec<_> = found.diagnostics.iter().map(convert).collect();
    if found.left_out > 0 {
        shown.push(outgoing::left_out(found.left_out));
    }
    Ok(shown)
}

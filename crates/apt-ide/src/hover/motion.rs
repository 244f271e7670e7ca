//! What a motion statement gave, in a hover.

use std::path::Path;

use apt_cldata::record::ClKind;
use apt_program::Origin;
use apt_run::{Waiting, catalogue::story_lines, go_on, pipeline::RunResult};
use arelem::{
    section2::Output,
    sequence::PocketPath,
    story::Story,
    verify::{Evidence, Extent},
};

use super::number;
use crate::{Analysis, Cancel, Cancelled};

/// Positions shown; the rest is counted.
const POSITIONS_SHOWN: usize = 4;
/// Lines of the story about the ends of cut vectors that are shown; the last ones tell how the motion ended.
const ENDS_SHOWN: usize = 3;

impl Analysis {
    /// The result of the motion statement with this number, of the program or of an included file; empty if it gave
    /// none.
    pub(super) fn motion_markdown(
        &self,
        isn: u32,
        file: Option<&Path>,
        cancel: Cancel<'_>,
    ) -> Result<String, Cancelled> {
        let result = self.result(cancel, &mut |_, _| {})?;
        let here = |origin: &Origin| {
            origin.isn == isn && origin.source.as_ref().map(|source| source.path.as_path()) == file
        };
        let mut turns = result.motions.iter().filter(|motion| here(&motion.origin));
        let count = turns.clone().count();
        let Some(motion) = turns.next_back() else { return points(&result, here, cancel) };
        let evidence = motion.computed.evidence.as_ref().and_then(|evidence| evidence.as_ref().ok());
        let times = if count > 1 { format!(", the last of {count} times") } else { String::new() };
        let mut text = String::new();
        let positions: Vec<_> = match &motion.computed.execution.output {
            Some(Output::Sequence(sequence)) => {
                let vectors = counted(sequence.points.len(), "cut vector");
                text.push_str(&format!("**{vectors}**"));
                if let Some(minimum) = sequence.minimum.filter(|minimum| *minimum > 1) {
                    text.push_str(&format!(" (no fewer than {minimum} are possible)"));
                }
                sequence.points.iter().collect()
            }
            Some(Output::Pocket(path)) => {
                text.push_str(&passes(path));
                path.positions().collect()
            }
            Some(Output::Position(position)) => vec![position],
            Some(Output::Ignored) | None => return points(&result, here, cancel),
        };
        text.push_str(&times);
        text.push_str(&verdict(evidence));
        let story = motion.computed.story(cancel);
        if cancel() {
            return Err(Cancelled);
        }
        text.push_str(&story.as_ref().map(short).unwrap_or_default());
        list(&mut text, positions.iter().map(|position| position.tip.into()), positions.len());
        Ok(text)
    }
}

/// The story without the surfaces, which the table shows: the route, and how the last vectors end.
fn short(story: &Story) -> String {
    let lines = story_lines(story);
    let route = lines.first();
    let ends = lines.iter().skip(2 + story.surfaces.len());
    let count = ends.len();
    let mut told: Vec<&String> =
        route.into_iter().chain(ends.skip(count.saturating_sub(ENDS_SHOWN))).collect();
    told.dedup();
    let items: Vec<_> = told.iter().map(|line| format!("- {line}\n")).collect();
    format!("{}\n", items.concat())
}

/// How many positions each pass of a pocket has, and at which feed.
fn passes(path: &PocketPath) -> String {
    let names = ["plunge", "general passes", "finishing pass"];
    let rows = names.iter().zip(&path.passes).filter(|(_, pass)| !pass.points.is_empty());
    let rows: Vec<_> = rows
        .map(|(name, pass)| {
            format!("{name}: {} at feed {}", counted(pass.points.len(), "position"), number(pass.feed))
        })
        .collect();
    format!("**pocket**, {}", rows.join("; "))
}

/// What the verifier says, with the clearances where it measured them.
fn verdict(evidence: Option<&Evidence>) -> String {
    let Some(evidence) = evidence else { return "\n\n".to_owned() };
    let mut text = if evidence.verified { " — verified\n\n" } else { " — **not verified**\n\n" }.to_owned();
    let rows = [("part", evidence.part), ("drive", evidence.drive), ("check", evidence.check)];
    if rows.iter().any(|(_, extent)| extent.is_some()) {
        text.push_str("| surface | clearance | allowed |\n|---|---|---|\n");
        for (role, extent) in rows {
            text.push_str(&extent.map(|extent| row(role, &extent)).unwrap_or_default());
        }
        text.push('\n');
    }
    text
}

/// The positions that a statement leaves on the CL file, for one that the arithmetic element need not compute.
fn points(
    result: &RunResult,
    here: impl Fn(&Origin) -> bool,
    cancel: Cancel<'_>,
) -> Result<String, Cancelled> {
    let waiting = Waiting::until(cancel);
    let (mut shown, mut count): (Vec<[f64; 3]>, usize) = (Vec::new(), 0);
    for record in &result.records {
        go_on(waiting.patience(), 1)?;
        if let ClKind::Motion { points, .. } = &record.kind
            && result.origins.get(record.source as usize).is_some_and(&here)
        {
            let more = points.iter().take(POSITIONS_SHOWN - shown.len());
            shown.extend(more.map(|point| <[f64; 3]>::from(point.position)));
            count += points.len();
        }
    }
    if count == 0 {
        return Ok(String::new());
    }
    let mut text = format!("**{}**\n\n", counted(count, "position"));
    list(&mut text, shown.into_iter(), count);
    Ok(text)
}

/// The first positions, and how many there are besides.
fn list(text: &mut String, positions: impl Iterator<Item = [f64; 3]>, count: usize) {
    for [x, y, z] in positions.take(POSITIONS_SHOWN) {
        text.push_str(&format!("`GOTO/{},{},{}`  \n", number(x), number(y), number(z)));
    }
    if count > POSITIONS_SHOWN {
        text.push_str(&format!("… {} more  \n", count - POSITIONS_SHOWN));
    }
    text.push_str("\n---\n");
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// What part of its band a clearance has to be to be shown: below, it is a rounding error of the figures that are shown.
const SHOWN_PART_OF_BAND: f64 = 1e-9;

fn row(role: &str, extent: &Extent) -> String {
    let band = extent.intol.abs() + extent.outtol.abs();
    let measured = |value: f64| number(if value.abs() <= SHOWN_PART_OF_BAND * band { 0.0 } else { value });
    format!(
        "| {role} | {} … {} | {} … {} |\n",
        measured(extent.min),
        measured(extent.max),
        number(-extent.intol),
        number(extent.outtol)
    )
}

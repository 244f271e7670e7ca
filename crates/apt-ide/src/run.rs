//! Run motion: the report of a run and the scene for viewers.

use std::ops::Range;

use apt_cldata::record::{ClKind, ClRecord, POSITIONS_A_UNIT, positions};
use apt_geometry::{
    motion::MotionCommand,
    patience::{Aside, Patience, Waiting},
    regional::Guide,
};
use apt_program::record::RecordKind;
use apt_run::{
    catalogue::story_lines,
    go_on,
    pipeline::{Motion, RunResult},
    report::{Report, is_of},
};
use arelem::section2::Output;
use rustc_hash::FxHashSet;

use crate::{
    Analysis, Cancel, Cancelled,
    picture::{Scene, SceneSurface, Segment, SegmentKind},
};

impl Analysis {
    /// Runs the program and reports it, or only what the statements that a byte range touches do and call.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn run(
        &self,
        range: Option<Range<usize>>,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Report, Cancelled> {
        let statements = range.and_then(|range| self.statements_of(range));
        self.result(cancel, progress)?;
        self.document().report(cancel, progress, statements)
    }

    /// The stories of the motions in the report of a run, in its order: how each was computed and why each cut vector ends
    /// where it does. A motion without surfaces has an empty story.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn stories(
        &self,
        range: Option<Range<usize>>,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Vec<Vec<String>>, Cancelled> {
        let statements = range.and_then(|range| self.statements_of(range));
        let result = self.result(cancel, progress)?;
        let wanted = |motion: &&Motion| is_of(&motion.origin, statements.as_ref());
        let mut stories = Vec::new();
        for motion in result.motions.iter().filter(wanted) {
            let story = motion.computed.story(cancel);
            if cancel() {
                return Err(Cancelled);
            }
            stories.push(story.map_or_else(Vec::new, |story| story_lines(&story)));
        }
        Ok(stories)
    }

    /// The numbers of the statements that a byte range touches.
    fn statements_of(&self, range: Range<usize>) -> Option<std::ops::RangeInclusive<u32>> {
        let (first, _) = self.statement_at(range.start)?;
        let (last, _) = self.statement_at(range.end.max(range.start + 1) - 1)?;
        Some(first.isn()..=last.isn())
    }

    /// The path and the surfaces for a picture.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when `cancel` said so before the end.
    pub fn scene(
        &self,
        cancel: Cancel<'_>,
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Scene, Cancelled> {
        let result = self.result(cancel, progress)?;
        let program = self.program(cancel)?;
        let waiting = Waiting::until(cancel);
        let patience = waiting.patience();
        let mut surfaces = Vec::new();
        let mut cutter_diameter = None;
        for record in program.records() {
            // Each surface is looked for among those that are known.
            go_on(patience, 1 + surfaces.len())?;
            let command = match &record.kind {
                RecordKind::Motion(command) => command,
                RecordKind::Regional(milling) => {
                    add(&mut surfaces, &milling.part.surface, "part");
                    let (Guide::Surface { surface: guide, .. } | Guide::Curve { curve: guide, .. }) =
                        &milling.guide.guide;
                    add(&mut surfaces, guide, "drive");
                    milling.checked.named.iter().for_each(|surface| add(&mut surfaces, surface, "check"));
                    continue;
                }
                _ => continue,
            };
            match &**command {
                MotionCommand::Cutter(numbers) => {
                    cutter_diameter = numbers.first().copied().or(cutter_diameter);
                }
                MotionCommand::Start(list) | MotionCommand::Offset(list) => {
                    for (role, start) in ["drive", "part", "check"].iter().zip(list) {
                        add(&mut surfaces, &start.surface, role);
                    }
                }
                MotionCommand::PartSurface(surface) => add(&mut surfaces, surface, "part"),
                MotionCommand::Drive { drive, checks, .. } => {
                    add(&mut surfaces, drive, "drive");
                    checks.iter().for_each(|check| add(&mut surfaces, &check.surface, "check"));
                }
                _ => {}
            }
        }
        let title = self.document().file().unwrap_or("program").to_owned();
        Ok(Scene {
            title: part_name(&result, patience)?.unwrap_or(title),
            segments: segments(&result, patience)?,
            surfaces,
            units: None,
            cutter_diameter,
        })
    }
}

fn part_name(result: &RunResult, patience: Patience<'_>) -> Result<Option<String>, Cancelled> {
    let name = |record: &ClRecord| match &record.kind {
        ClKind::Text { word, text, .. } if word == "PARTNO" && !text.trim().is_empty() => {
            Some(text.trim().to_owned())
        }
        _ => None,
    };
    for records in result.records.chunks(POSITIONS_A_UNIT) {
        go_on(patience, 1)?;
        if let Some(name) = records.iter().find_map(name) {
            return Ok(Some(name));
        }
    }
    Ok(None)
}

fn add(surfaces: &mut Vec<SceneSurface>, surface: &apt_geometry::motion::NamedSurface, role: &str) {
    let known = surfaces.iter().any(|one| one.name == surface.name && one.geometry == surface.geometry);
    if !known {
        let (name, geometry) = (surface.name.clone(), surface.geometry.clone());
        surfaces.push(SceneSurface { name, geometry, role: role.to_owned() });
    }
}

/// The straight pieces of a path; a path without FROM begins at its first point.
fn segments(result: &RunResult, patience: Patience<'_>) -> Result<Vec<Segment>, Cancelled> {
    let starts: FxHashSet<u32> =
        result.motions.iter().filter(|motion| is_start_up(motion)).map(|m| m.origin.isn).collect();
    // A list that grows is copied as a whole, which nobody can interrupt.
    let mut segments = Aside::from(Vec::with_capacity(positions(&result.records, patience)));
    let mut at: Option<[f64; 3]> = None;
    let mut rapid = false;
    for record in &result.records {
        go_on(patience, 1)?;
        match &record.kind {
            ClKind::Postprocessor { word, .. } if word == "RAPID" => rapid = true,
            ClKind::Motion { from, points, .. } => {
                for (done, point) in points.iter().enumerate() {
                    go_on(patience, usize::from(done % POSITIONS_A_UNIT == POSITIONS_A_UNIT - 1))?;
                    let to: [f64; 3] = point.position.into();
                    if let (Some(start), false) = (at, *from) {
                        let kind = match (rapid, starts.contains(&record.isn)) {
                            (true, _) => SegmentKind::Rapid,
                            (false, true) => SegmentKind::Start,
                            (false, false) => SegmentKind::Feed,
                        };
                        segments.push(Segment { from: start, to, kind, isn: record.isn });
                    }
                    at = Some(to);
                }
                rapid &= *from;
            }
            _ => {}
        }
    }
    Ok(segments.taken())
}

fn is_start_up(motion: &Motion) -> bool {
    matches!(&motion.computed.execution.output, Some(Output::Sequence(sequence)) if sequence.start_up)
}

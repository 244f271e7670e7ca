//! The report of a run: the shape of `run --format json` (and of `apt.runMotion`), for machines and editors.

mod build;

use serde::Serialize;
use serde_json::{Map, Value};

use crate::{
    diagnostic::{OriginStep, Severity},
    position::Range,
};

pub use build::{ReportInput, Sources, clean_number, diagnostic_report, is_of, report};

/// The result of a run.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// File name of the program.
    pub program: String,
    /// No diagnostic is an error.
    pub ok: bool,
    /// The dialect in force.
    pub dialect: String,
    /// All diagnostics, in order of their place.
    pub diagnostics: Vec<DiagnosticReport>,
    /// Final value of every symbol, `NAME` or `NAME(3)`, in alphabetic order.
    pub symbols: Map<String, Value>,
    /// What PRINT, PUNCH, TITLES and REMARK list, in order of execution.
    pub listing: Vec<ListingReport>,
    /// The final CL records.
    pub cl: Vec<ClEntry>,
    /// What each motion statement gave.
    pub motions: Vec<MotionEntry>,
    /// Interferences that regional milling met, in order of execution; left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub interference: Vec<InterferenceEntry>,
    /// Sums over the path.
    pub totals: TotalsEntry,
}

/// A checked surface that reaches into the tool at a location.
#[derive(Debug, Clone, Serialize)]
pub struct InterferenceEntry {
    /// Statement number of the SMIL.
    pub isn: u32,
    /// The surface.
    pub surface: String,
    /// Tool end before any remedy.
    pub te: [f64; 3],
    /// Unit tool axis before any remedy.
    pub ta: [f64; 3],
    /// Depth of the deepest point, program units.
    pub depth: f64,
    /// Number of its patch, from 1.
    pub patch: usize,
    /// Its local parameters.
    pub uv: [f64; 2],
    /// What was done, if AVCTRL is on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<RemedyEntry>,
}

/// What was done about an interference.
#[derive(Debug, Clone, Serialize)]
pub struct RemedyEntry {
    /// `avoided` or `failed`.
    pub result: &'static str,
    /// Angle by which the axis was tilted, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt: Option<f64>,
    /// How far the tool was lifted, program units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lift: Option<f64>,
    /// Along what: `axis` or `normal`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub along: Option<&'static str>,
}

/// One diagnostic.
#[derive(Debug, Clone, Serialize)]
pub struct DiagnosticReport {
    /// Stable code.
    pub code: String,
    /// How grave.
    pub severity: Severity,
    /// What is wrong.
    pub message: String,
    /// Statement number.
    pub isn: u32,
    /// The APT III number, if there is one.
    pub apt3: Option<u16>,
    /// The file.
    pub file: String,
    /// The place.
    pub range: Range,
    /// Macro calls and loop turns, innermost first.
    pub origin: Vec<OriginStep>,
    /// Places that belong to it.
    pub related: Vec<RelatedReport>,
    /// What would help.
    pub hint: Option<String>,
    /// Changes that settle it, the likeliest first.
    pub fixes: Vec<FixReport>,
}

/// A change of the program that settles a diagnostic.
#[derive(Debug, Clone, Serialize)]
pub struct FixReport {
    /// What it does.
    pub title: String,
    /// Whether it is certainly what was meant.
    pub preferred: bool,
    /// The edits, in order of the text and without overlap.
    pub edits: Vec<EditReport>,
}

/// A place and what takes its place.
#[derive(Debug, Clone, Serialize)]
pub struct EditReport {
    /// What is replaced.
    pub range: Range,
    /// By what.
    pub text: String,
}

/// A place that belongs to a diagnostic.
#[derive(Debug, Clone, Serialize)]
pub struct RelatedReport {
    /// What is there.
    pub message: String,
    /// The file.
    pub file: String,
    /// The place.
    pub range: Range,
}

/// What one execution of a statement lists.
#[derive(Debug, Clone, Serialize)]
pub struct ListingReport {
    /// Statement number.
    pub isn: u32,
    /// The lines; a form feed is a new page.
    pub lines: Vec<String>,
}

/// Where in the sources something comes from, and by which calls and turns. Entries have these fields for themselves: a flattened
/// field would make a map of unknown size of each, which takes half as much memory again.
#[derive(Debug, Clone, Default, Serialize)]
pub struct SourceReport {
    /// The included file in which the statement stands; left out for the program itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The line of that file on which the statement begins, from zero; left out where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// Macro calls, loop turns and inclusions, innermost first; left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub origin: Vec<OriginStep>,
}

/// One CL record group.
#[derive(Debug, Clone, Serialize)]
pub struct ClEntry {
    /// Statement number.
    pub isn: u32,
    /// The included file in which the statement stands; left out for the program itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The line of that file on which the statement begins, from zero; left out where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// Macro calls, loop turns and inclusions, innermost first; left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub origin: Vec<OriginStep>,
    /// `from`, `go`, `postprocessor`, `control`, `mode`, `fini` or `other`.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Drive surface or point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<String>,
    /// The word and its parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub words: Option<Vec<Value>>,
    /// Class and subclass, or the code of a post-processor word.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code: Option<Value>,
    /// Tool ends, with the axis while MULTAX is in effect.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<Vec<f64>>>,
}

/// What one motion statement gave.
#[derive(Debug, Clone, Serialize)]
pub struct MotionEntry {
    /// Statement number.
    pub isn: u32,
    /// The included file in which the statement stands; left out for the program itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The line of that file on which the statement begins, from zero; left out where it is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// Macro calls, loop turns and inclusions, innermost first; left out if there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub origin: Vec<OriginStep>,
    /// The statement as written, without comments.
    pub statement: String,
    /// How many cut vectors.
    pub cut_vectors: usize,
    /// The number that no sequence within tolerance can beat, where known.
    pub minimum: Option<u32>,
    /// Extreme clearances to the part surface.
    pub part: Option<arelem::verify::Extent>,
    /// Extreme clearances to the drive surface.
    pub drive: Option<arelem::verify::Extent>,
    /// Clearance to the check surface at the end.
    pub check: Option<arelem::verify::Extent>,
    /// The independent verifier has proven the motion.
    pub verified: bool,
    /// Time of engine and verifier, seconds.
    pub seconds: f64,
}

/// Sums over the path.
#[derive(Debug, Clone, Serialize)]
pub struct TotalsEntry {
    /// Number of tool positions.
    pub points: usize,
    /// Length of the path, program units.
    pub length: f64,
    /// Length travelled at feed.
    pub cut_length: f64,
    /// Length travelled at rapid.
    pub rapid_length: f64,
    /// Time at the programmed feeds, minutes; `null` where a feed is missing.
    pub time_minutes: Option<f64>,
    /// Least and greatest coordinates of the tool end; `null` for an empty path.
    #[serde(rename = "box")]
    pub bounds: Option<[[f64; 3]; 2]>,
}

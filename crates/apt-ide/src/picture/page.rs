//! The page with the viewer: data, style and script in one file.

use serde::Serialize;

use super::{
    Scene, SegmentKind,
    drawing::{self, escape, is_finite},
    projection::{Bounds, Point},
};

const STYLE: &str = include_str!("viewer.css");
const SCRIPT: &str = include_str!("viewer.js");
const BODY: &str = include_str!("viewer.html");

/// Consecutive pieces of one statement and one kind.
#[derive(Serialize)]
struct Stretch {
    kind: SegmentKind,
    isn: u32,
    points: Vec<Point>,
}

#[derive(Serialize)]
struct Surface<'a> {
    name: &'a str,
    role: &'static str,
    lines: Vec<Vec<Point>>,
}

/// What the viewer is given.
#[derive(Serialize)]
struct Data<'a> {
    title: &'a str,
    summary: String,
    units: &'a str,
    low: Point,
    high: Point,
    path: Vec<Stretch>,
    surfaces: Vec<Surface<'a>>,
}

/// The page.
pub(super) fn build(scene: &Scene) -> String {
    let bounds = drawing::bounds(scene);
    let surfaces = match &bounds {
        Some(bounds) => scene
            .surfaces
            .iter()
            .zip(drawing::wires(scene, bounds))
            .map(|(s, w)| Surface { name: &s.name, role: w.class, lines: w.lines })
            .collect(),
        None => Vec::new(),
    };
    let Bounds { low, high } = bounds.unwrap_or(Bounds { low: [-1.0; 3], high: [1.0; 3] });
    let data = Data {
        title: &scene.title,
        summary: drawing::summary(scene),
        units: scene.units.as_deref().unwrap_or(""),
        low,
        high,
        path: stretches(scene),
        surfaces,
    };
    // Only numbers that are finite and plain text are in the data, which serde_json always can write.
    let json =
        serde_json::to_string(&data).unwrap_or_else(|error| format!("{{\"error\":\"{}\"}}", error.line()));
    let json = json.replace('<', "\\u003c").replace('\u{2028}', "\\u2028").replace('\u{2029}', "\\u2029");
    let title = escape(&scene.title);
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\
         <title>{title}</title><style>{STYLE}</style></head><body>{BODY}\
         <script id=\"data\" type=\"application/json\">{json}</script><script>{SCRIPT}</script></body></html>\n"
    )
}

fn stretches(scene: &Scene) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    for segment in scene.segments.iter().filter(|s| is_finite(s)) {
        match stretches.last_mut() {
            Some(s)
                if s.kind == segment.kind
                    && s.isn == segment.isn
                    && s.points.last() == Some(&segment.from) =>
            {
                s.points.push(segment.to);
            }
            _ => stretches.push(Stretch {
                kind: segment.kind,
                isn: segment.isn,
                points: vec![segment.from, segment.to],
            }),
        }
    }
    stretches
}

//! The drawing: heading, four views, legend.

use std::fmt::Write as _;

use super::{
    Scene, Segment,
    panel::{Panel, Run, Wire},
    projection::{Bounds, Point, VIEWS},
    wireframe,
};

/// Width of the drawing and of the space round a view, pixels.
const WIDTH: f64 = 1200.0;
const GAP: f64 = 16.0;
/// Height of the heading and of a view.
const HEADING: f64 = 70.0;
const VIEW_HEIGHT: f64 = 410.0;
/// Height of a row of the legend.
const ROW: f64 = 26.0;
/// Surfaces named in the legend.
const MOST_NAMES: usize = 24;

/// Colours as plain classes, so that renderers without style variables show them too.
const STYLE: &str = include_str!("drawing.css");

/// Everything outside the language of XML is replaced.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Whether all six coordinates can be shown.
pub(super) fn is_finite(segment: &Segment) -> bool {
    segment.from.iter().chain(&segment.to).all(|x| x.is_finite() && x.abs() < 1e30)
}

/// Consecutive pieces of one kind as polylines.
pub(super) fn runs(scene: &Scene) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for segment in scene.segments.iter().filter(|s| is_finite(s)) {
        match runs.last_mut() {
            Some(run) if run.kind == segment.kind && run.points.last() == Some(&segment.from) => {
                run.points.push(segment.to);
            }
            _ => runs.push(Run { kind: segment.kind, points: vec![segment.from, segment.to] }),
        }
    }
    runs
}

/// The box that is shown: the path and some room for the surfaces.
pub(super) fn bounds(scene: &Scene) -> Option<Bounds> {
    let ends = scene.segments.iter().filter(|s| is_finite(s)).flat_map(|s| [s.from, s.to]);
    let tight = Bounds::of(ends)?;
    let tool = scene.cutter_diameter.filter(|d| d.is_finite() && *d > 0.0).unwrap_or(0.0);
    let diagonal = tight.diagonal();
    // A path that is a point gets a surrounding of the tool's size, or of one unit.
    let room = if diagonal > 0.0 {
        0.04 * diagonal
    } else if tool > 0.0 {
        tool
    } else {
        1.0
    };
    Some(tight.grown(room.max(1.2 * tool.min(diagonal))))
}

/// The class of a role.
pub(super) fn role_class(role: &str) -> &'static str {
    match role {
        "part" => "part",
        "drive" => "drive",
        _ => "check",
    }
}

/// The lines of all surfaces.
pub(super) fn wires(scene: &Scene, bounds: &Bounds) -> Vec<Wire> {
    scene
        .surfaces
        .iter()
        .map(|s| Wire { class: role_class(&s.role), lines: wireframe::lines(&s.geometry, bounds) })
        .collect()
}

/// Length of all pieces.
pub(super) fn length(scene: &Scene) -> f64 {
    let distance = |a: Point, b: Point| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    scene.segments.iter().filter(|s| is_finite(s)).map(|s| distance(s.from, s.to)).sum()
}

/// A short number for the heading.
fn short(value: f64) -> String {
    let digits = (3.0 - value.abs().max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// What the path consists of, in a line.
pub(super) fn summary(scene: &Scene) -> String {
    let units = scene.units.as_deref().map(|u| format!(" {u}")).unwrap_or_default();
    let count = scene.segments.len();
    let mut text =
        format!("{count} move{} · path {}{units}", if count == 1 { "" } else { "s" }, short(length(scene)));
    if let Some(b) = Bounds::of(scene.segments.iter().filter(|s| is_finite(s)).flat_map(|s| [s.from, s.to])) {
        let size = [0, 1, 2].map(|i| short(b.high[i] - b.low[i]));
        let _ = write!(text, " · extent {} × {} × {}{units}", size[0], size[1], size[2]);
    }
    if let Some(d) = scene.cutter_diameter {
        let _ = write!(text, " · cutter ⌀ {}{units}", short(d));
    }
    text
}

/// The whole drawing.
pub(super) fn draw(scene: &Scene) -> String {
    let mut legend = String::new();
    let foot = HEADING + 2.0 * (VIEW_HEIGHT + GAP) + 10.0;
    let rows = draw_legend(scene, &mut legend, foot);
    let height = foot + rows * ROW + 6.0;
    let title = escape(&scene.title);
    let mut out = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img" aria-label="Tool path of {title}"><title>{title}</title><style>{STYLE}</style><rect class="back" width="{WIDTH}" height="{height}"/>"#
    );
    let _ = write!(
        out,
        r#"<text class="title" x="{GAP}" y="34">{title}</text><text class="summary" x="{GAP}" y="56">{}</text>"#,
        escape(&summary(scene))
    );
    let width = (WIDTH - 3.0 * GAP) / 2.0;
    let runs = runs(scene);
    let units = scene.units.as_deref().map(|u| format!(" {}", escape(u))).unwrap_or_default();
    let shown = bounds(scene);
    let wires = shown.map(|b| wires(scene, &b)).unwrap_or_default();
    for (k, view) in VIEWS.into_iter().enumerate() {
        let frame = [
            GAP + (width + GAP) * (k % 2) as f64,
            HEADING + (VIEW_HEIGHT + GAP) * (k / 2) as f64,
            width,
            VIEW_HEIGHT,
        ];
        match &shown {
            Some(bounds) => Panel::new(view, frame, bounds).draw(&mut out, k, &wires, &runs, &units),
            None => empty(&mut out, view.name, frame),
        }
    }
    out.push_str(&legend);
    out.push_str("</svg>\n");
    out
}

fn empty(out: &mut String, name: &str, [x, y, w, h]: [f64; 4]) {
    let _ = write!(
        out,
        r#"<rect class="panel" x="{x}" y="{y}" width="{w}" height="{h}" rx="8"/><text class="name" x="{}" y="{}">{name}</text><text class="summary" x="{}" y="{}" text-anchor="middle">no motion</text>"#,
        x + 14.0,
        y + 24.0,
        x + w / 2.0,
        y + h / 2.0
    );
}

/// The legend; gives the number of rows it takes.
fn draw_legend(scene: &Scene, out: &mut String, top: f64) -> f64 {
    let mut rows = 1.0;
    let mut x = GAP;
    let mut entry = |out: &mut String, sample: &dyn Fn(f64, f64) -> String, text: &str| {
        // Wide enough for the usual sans-serif at 13 pixels.
        let width = 44.0 + 7.6 * text.chars().count() as f64;
        if x + width > WIDTH - GAP {
            x = GAP;
            rows += 1.0;
        }
        let y = top + ROW * (rows - 0.5);
        let _ = write!(
            out,
            r#"{}<text class="entry" x="{:.1}" y="{:.1}">{}</text>"#,
            sample(x, y),
            x + 34.0,
            y + 4.5,
            escape(text)
        );
        x += width;
    };
    let line = |class: &'static str| {
        move |x: f64, y: f64| format!(r#"<path class="{class}" d="M{x:.1} {y:.1}h26"/>"#)
    };
    for (class, text) in [("path feed", "feed"), ("path rapid", "rapid"), ("path start", "start-up")] {
        entry(out, &line(class), text);
    }
    entry(
        out,
        &|x, y| format!(r#"<circle class="begin" cx="{:.1}" cy="{y:.1}" r="4.5"/>"#, x + 13.0),
        "begin",
    );
    entry(
        out,
        &|x, y| format!(r#"<rect class="end" x="{:.1}" y="{:.1}" width="8" height="8"/>"#, x + 9.0, y - 4.0),
        "end",
    );
    for (role, title) in [("part", "part surface"), ("drive", "drive surface"), ("check", "check surface")] {
        let mut named: Vec<&str> = Vec::new();
        for surface in scene.surfaces.iter().filter(|surface| role_class(&surface.role) == role) {
            // A name that a loop or macro defines again and again stands once.
            if !named.contains(&surface.name.as_str()) {
                named.push(&surface.name);
            }
        }
        if named.is_empty() {
            continue;
        }
        let names: Vec<&str> = named.iter().copied().filter(|n| !n.is_empty()).take(MOST_NAMES).collect();
        let more = if named.len() > MOST_NAMES { " …" } else { "" };
        let text =
            if names.is_empty() { title.to_owned() } else { format!("{title} {}{more}", names.join(", ")) };
        let class = match role {
            "part" => "surface key part",
            "drive" => "surface key drive",
            _ => "surface key check",
        };
        entry(out, &line(class), &text);
    }
    rows
}

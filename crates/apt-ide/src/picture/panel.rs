//! One view of the drawing: grid, surfaces, path, scale.

use std::fmt::Write as _;

use rustc_hash::FxHashSet;

use super::{
    SegmentKind,
    projection::{Bounds, Point, View, label, round_step},
};

/// Distance in pixels below which a point is not worth drawing.
const FINEST: f64 = 0.4;
/// Pieces drawn per view; with more of them the grid they are rounded to is made coarser.
const MOST_PIECES: usize = 40_000;
/// Free pixels between the frame and what is drawn: for the numbers to the left and below, and elsewhere.
const MARGIN: [f64; 4] = [52.0, 40.0, 22.0, 40.0];
/// Pixels between two lines of the grid, at least.
const GRID: f64 = 56.0;

/// Consecutive pieces of one kind.
pub(super) struct Run {
    pub(super) kind: SegmentKind,
    pub(super) points: Vec<Point>,
}

/// Lines of a surface with the class that colours them.
pub(super) struct Wire {
    pub(super) class: &'static str,
    pub(super) lines: Vec<Vec<Point>>,
}

/// A rectangle of the drawing in pixels with the view it shows.
pub(super) struct Panel {
    view: View,
    frame: [f64; 4],
    scale: f64,
    /// Flat coordinates of the middle.
    middle: [f64; 2],
    /// Pixel coordinates of the middle.
    center: [f64; 2],
}

/// The class of a kind of motion.
pub(super) fn class(kind: SegmentKind) -> &'static str {
    match kind {
        SegmentKind::Rapid => "rapid",
        SegmentKind::Feed => "feed",
        SegmentKind::Start => "start",
    }
}

impl Panel {
    /// A panel in the rectangle x, y, width, height that shows the whole box.
    pub(super) fn new(view: View, frame: [f64; 4], bounds: &Bounds) -> Self {
        let flat = bounds.corners().map(|c| view.flat(c));
        let fold = |i: usize, f: fn(f64, f64) -> f64, x: f64| flat.iter().map(|p| p[i]).fold(x, f);
        let low = [0, 1].map(|i| fold(i, f64::min, f64::INFINITY));
        let high = [0, 1].map(|i| fold(i, f64::max, f64::NEG_INFINITY));
        let room = [frame[2] - MARGIN[0] - MARGIN[2], frame[3] - MARGIN[1] - MARGIN[3]];
        let scale = [0, 1]
            .iter()
            .map(|i| room[*i] / (high[*i] - low[*i]).max(f64::MIN_POSITIVE))
            .fold(f64::INFINITY, f64::min);
        Self {
            view,
            frame,
            scale,
            middle: [0, 1].map(|i| 0.5 * (low[i] + high[i])),
            center: [frame[0] + MARGIN[0] + 0.5 * room[0], frame[1] + MARGIN[1] + 0.5 * room[1]],
        }
    }

    fn pixel(&self, p: Point) -> [f64; 2] {
        let flat = self.view.flat(p);
        [
            self.center[0] + (flat[0] - self.middle[0]) * self.scale,
            self.center[1] - (flat[1] - self.middle[1]) * self.scale,
        ]
    }

    /// Draws the panel.
    pub(super) fn draw(&self, out: &mut String, id: usize, wires: &[Wire], runs: &[Run], units: &str) {
        let [x, y, w, h] = self.frame;
        let _ = write!(
            out,
            r#"<clipPath id="c{id}"><rect x="{x}" y="{y}" width="{w}" height="{h}" rx="8"/></clipPath>"#
        );
        let _ = write!(out, r#"<rect class="panel" x="{x}" y="{y}" width="{w}" height="{h}" rx="8"/>"#);
        let _ = write!(out, r#"<g clip-path="url(#c{id})">"#);
        if let Some(axes) = self.view.axes {
            self.grid(out, axes);
        }
        for wire in wires {
            self.polylines(out, &format!("surface {}", wire.class), &wire.lines.iter().map(Vec::as_slice));
        }
        for kind in [SegmentKind::Rapid, SegmentKind::Start, SegmentKind::Feed] {
            let lines = runs.iter().filter(|r| r.kind == kind).map(|r| r.points.as_slice());
            self.polylines(out, &format!("path {}", class(kind)), &lines);
        }
        self.arrows(out, runs);
        self.ends(out, runs);
        out.push_str("</g>");
        if self.view.axes.is_none() {
            self.triad(out);
        }
        let axes = self.view.axes.map(|[a, b]| format!(" · {a}{b}")).unwrap_or_default();
        let _ = write!(
            out,
            r#"<text class="name" x="{}" y="{}">{}{axes}</text>"#,
            x + 14.0,
            y + 24.0,
            self.view.name
        );
        self.scale_bar(out, units);
    }

    /// Lines at round coordinates with their numbers.
    fn grid(&self, out: &mut String, axes: [&str; 2]) {
        let [x, y, w, h] = self.frame;
        let step = round_step(GRID / self.scale);
        if !step.is_finite() || step <= 0.0 {
            return;
        }
        let (left, bottom) = (x + MARGIN[0] - 14.0, y + h - MARGIN[3] + 14.0);
        for (axis, name) in axes.iter().enumerate() {
            let (low, high) = if axis == 0 {
                (
                    self.middle[0] + (left - self.center[0]) / self.scale,
                    self.middle[0] + (x + w - self.center[0]) / self.scale,
                )
            } else {
                (
                    self.middle[1] - (bottom - self.center[1]) / self.scale,
                    self.middle[1] + (self.center[1] - y - 34.0) / self.scale,
                )
            };
            let first = (low / step).ceil();
            let count = ((high / step).floor() - first).clamp(-1.0, 200.0) as i32;
            for k in 0..=count {
                let value = (first + f64::from(k)) * step;
                let zero = if value.abs() < 1e-6 * step { " zero" } else { "" };
                let text = label(value, step);
                if axis == 0 {
                    let px = self.center[0] + (value - self.middle[0]) * self.scale;
                    let _ =
                        write!(out, r#"<path class="grid{zero}" d="M{px:.1} {:.1}V{bottom:.1}"/>"#, y + 34.0);
                    if px < x + w - 30.0 {
                        let _ = write!(
                            out,
                            r#"<text class="tick" x="{px:.1}" y="{:.1}" text-anchor="middle">{text}</text>"#,
                            bottom + 14.0
                        );
                    }
                } else {
                    let py = self.center[1] - (value - self.middle[1]) * self.scale;
                    let _ = write!(out, r#"<path class="grid{zero}" d="M{left:.1} {py:.1}H{:.1}"/>"#, x + w);
                    let _ = write!(
                        out,
                        r#"<text class="tick" x="{:.1}" y="{:.1}" text-anchor="end">{text}</text>"#,
                        left - 5.0,
                        py + 3.5
                    );
                }
            }
            let (tx, ty) = if axis == 0 { (x + w - 14.0, bottom + 14.0) } else { (left - 8.0, y + 46.0) };
            let _ =
                write!(out, r#"<text class="axis" x="{tx:.1}" y="{ty:.1}" text-anchor="end">{name}</text>"#);
        }
    }

    /// Polylines as one path element: points that would not be seen apart are left out, and so are pieces drawn before.
    fn polylines<'a>(
        &self,
        out: &mut String,
        class: &str,
        lines: &(impl Iterator<Item = &'a [Point]> + Clone),
    ) {
        let mut grain = FINEST;
        let mut data = String::new();
        for _ in 0..8 {
            data.clear();
            let mut known: FxHashSet<[i64; 4]> = FxHashSet::default();
            for line in lines.clone() {
                self.polyline(&mut data, line, grain, &mut known);
            }
            if known.len() <= MOST_PIECES {
                break;
            }
            grain *= 2.0;
        }
        if !data.is_empty() {
            let _ = write!(out, r#"<path class="{class}" d="{}"/>"#, data.trim_end());
        }
    }

    fn polyline(&self, data: &mut String, line: &[Point], grain: f64, known: &mut FxHashSet<[i64; 4]>) {
        let cell = |p: [f64; 2]| p.map(|x| (x / grain).round() as i64);
        let mut pen: Option<[i64; 2]> = None;
        let mut previous: Option<[f64; 2]> = None;
        for p in line {
            let at = self.pixel(*p);
            let Some(last) = previous else {
                previous = Some(at);
                continue;
            };
            let (a, b) = (cell(last), cell(at));
            if a == b {
                continue;
            }
            let key = if a <= b { [a[0], a[1], b[0], b[1]] } else { [b[0], b[1], a[0], a[1]] };
            if known.insert(key) {
                if pen != Some(a) {
                    let _ = write!(data, "M{:.1} {:.1}", last[0], last[1]);
                }
                let _ = write!(data, "L{:.1} {:.1}", at[0], at[1]);
                pen = Some(b);
            } else {
                pen = None;
            }
            previous = Some(at);
        }
    }

    /// A few arrow heads along the path.
    fn arrows(&self, out: &mut String, runs: &[Run]) {
        let spacing = 0.5 * self.frame[2];
        let mut since = 0.6 * spacing;
        let mut drawn = 0;
        for run in runs {
            for pair in run.points.windows(2) {
                let (a, b) = (self.pixel(pair[0]), self.pixel(pair[1]));
                let d = [b[0] - a[0], b[1] - a[1]];
                let length = d[0].hypot(d[1]);
                since += length;
                if since < spacing || length < 0.5 || drawn >= 24 {
                    continue;
                }
                since = 0.0;
                drawn += 1;
                let (m, u) = ([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])], [d[0] / length, d[1] / length]);
                let corner = |s: f64, t: f64| [m[0] + s * u[0] - t * u[1], m[1] + s * u[1] + t * u[0]];
                let [p, q, r] = [corner(5.5, 0.0), corner(-4.5, 4.0), corner(-4.5, -4.0)];
                let _ = write!(
                    out,
                    r#"<path class="arrow {}" d="M{:.1} {:.1}L{:.1} {:.1}L{:.1} {:.1}Z"/>"#,
                    class(run.kind),
                    p[0],
                    p[1],
                    q[0],
                    q[1],
                    r[0],
                    r[1]
                );
            }
        }
    }

    /// Where the path begins and ends.
    fn ends(&self, out: &mut String, runs: &[Run]) {
        if let Some(p) = runs.first().and_then(|r| r.points.first()) {
            let [x, y] = self.pixel(*p);
            let _ = write!(out, r#"<circle class="begin" cx="{x:.1}" cy="{y:.1}" r="4.5"/>"#);
        }
        if let Some(p) = runs.last().and_then(|r| r.points.last()) {
            let [x, y] = self.pixel(*p);
            let _ = write!(
                out,
                r#"<rect class="end" x="{:.1}" y="{:.1}" width="8" height="8"/>"#,
                x - 4.0,
                y - 4.0
            );
        }
    }

    /// The three axes of the isometric view.
    fn triad(&self, out: &mut String) {
        let origin = [self.frame[0] + 44.0, self.frame[1] + self.frame[3] - 40.0];
        for (name, direction) in [("X", [1.0, 0.0, 0.0]), ("Y", [0.0, 1.0, 0.0]), ("Z", [0.0, 0.0, 1.0])] {
            let flat = self.view.flat(direction);
            let tip = [origin[0] + 30.0 * flat[0], origin[1] - 30.0 * flat[1]];
            let text = [origin[0] + 41.0 * flat[0], origin[1] - 41.0 * flat[1] + 4.0];
            let _ = write!(
                out,
                r#"<path class="triad" d="M{:.1} {:.1}L{:.1} {:.1}"/><text class="axis" x="{:.1}" y="{:.1}" text-anchor="middle">{name}</text>"#,
                origin[0], origin[1], tip[0], tip[1], text[0], text[1]
            );
        }
    }

    fn scale_bar(&self, out: &mut String, units: &str) {
        let length = round_step(60.0 / self.scale);
        let pixels = length * self.scale;
        if !pixels.is_finite() {
            return;
        }
        let (x, y) = (self.frame[0] + self.frame[2] - 16.0, self.frame[1] + 20.0);
        let _ = write!(
            out,
            r#"<path class="bar" d="M{:.1} {:.1}v5h{pixels:.1}v-5"/><text class="tick" x="{:.1}" y="{:.1}" text-anchor="end">{}{units}</text>"#,
            x - pixels,
            y - 4.0,
            x - pixels - 6.0,
            y + 2.0,
            label(length, length)
        );
    }
}

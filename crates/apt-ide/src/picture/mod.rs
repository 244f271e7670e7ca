//! Pictures of a tool path: a drawing with three orthographic views and one isometric, and a page with a viewer.
//!
//! Both stand alone (no network, no fonts of their own) and follow a dark or light surrounding where the program that
//! shows them can. Positions that are not finite are left out.

mod drawing;
mod page;
mod panel;
mod pixels;
mod projection;
mod wireframe;

#[cfg(test)]
mod tests;

use serde::Serialize;

pub use pixels::PixelError;

/// All there is to show: the path of the tool end and the surfaces in use.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// What is shown, as a heading.
    pub title: String,
    /// The straight pieces of the path in order.
    pub segments: Vec<Segment>,
    /// The surfaces in use, each once.
    pub surfaces: Vec<SceneSurface>,
    /// The name of the length unit, if the program says it.
    pub units: Option<String>,
    /// Diameter of the (first) cutter, in part-program units.
    pub cutter_diameter: Option<f64>,
}

/// A straight piece of the path of the tool end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Segment {
    /// Where it begins, in part-program units.
    pub from: [f64; 3],
    /// Where it ends.
    pub to: [f64; 3],
    /// How the tool moves.
    pub kind: SegmentKind,
    /// Internal statement number of the statement that made it.
    pub isn: u32,
}

/// How the tool moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SegmentKind {
    /// At rapid traverse.
    Rapid,
    /// At feed rate.
    Feed,
    /// A start-up motion: from where the tool was to the surfaces.
    Start,
}

/// A surface in use.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneSurface {
    /// Its name in the program, empty if it has none.
    pub name: String,
    /// Its canonical form.
    pub geometry: apt_geometry::canonical::Geometry,
    /// The role it first has: `part`, `drive` or `check`.
    pub role: String,
}

/// The picture as a stand-alone SVG document: views along z, y and x and an isometric view.
pub fn svg(scene: &Scene) -> String {
    drawing::draw(scene)
}

/// The picture as a stand-alone page with a viewer that turns, moves and scales it and tells the statement of each piece.
pub fn html(scene: &Scene) -> String {
    page::build(scene)
}

/// The picture as a PNG image, twice the size of the drawing in pixels.
///
/// # Errors
///
/// [`PixelError`] when the image cannot be made.
pub fn png(scene: &Scene) -> Result<Vec<u8>, PixelError> {
    pixels::render(&svg(scene))
}

//! The drawing as pixels.

use std::sync::Arc;

use resvg::{
    tiny_skia::{Pixmap, Transform},
    usvg::{self, fontdb::Database},
};

/// Pixels per unit of the drawing: text stays sharp on dense screens.
const SCALE: f32 = 2.0;

/// Why a drawing cannot be made of pixels.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PixelError {
    /// The renderer does not take the drawing.
    #[error("the drawing cannot be rendered: {reason}")]
    Drawing {
        /// What it says.
        reason: String,
    },
    /// There is no memory for an image of this size.
    #[error("an image of {width} by {height} pixels cannot be made")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The image cannot be encoded.
    #[error("the image cannot be encoded: {reason}")]
    Encoding {
        /// What the encoder says.
        reason: String,
    },
}

/// Renders a drawing to PNG; its words are set in fonts of the system, and left out where there are none.
pub(super) fn render(svg: &str) -> Result<Vec<u8>, PixelError> {
    let mut fonts = Database::new();
    fonts.load_system_fonts();
    let options = usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options)
        .map_err(|error| PixelError::Drawing { reason: error.to_string() })?;
    let size = tree.size();
    // Whole pixels; a part of one at the edge counts.
    let (width, height) = ((size.width() * SCALE).ceil() as u32, (size.height() * SCALE).ceil() as u32);
    let mut image = Pixmap::new(width, height).ok_or(PixelError::Size { width, height })?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut image.as_mut());
    image.encode_png().map_err(|error| PixelError::Encoding { reason: error.to_string() })
}

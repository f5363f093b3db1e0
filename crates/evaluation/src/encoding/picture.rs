//! Encodes observations as images.

use crate::error::EvaluationError;
use crate::legend::Legend;
use engine::Observation;
use render::Style;

/// An image in PNG format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The PNG file's bytes.
    pub png: Vec<u8>,
    /// The image width in pixels.
    pub width: u32,
    /// The image height in pixels.
    pub height: u32,
}

/// Draws the observation with `cell` pixels per cell. A legend below the board shows the game's types, each
/// with its tile and name. The image is drawn from the observation rather than the state, so it shows no more
/// than the other encodings. The same arguments give identical bytes on every machine. Cost: O(pixels).
///
/// # Errors
/// Returns an error if the cells or the entire image would be too small or too large.
pub fn picture(observation: &Observation, legend: &Legend, cell: u32) -> Result<Picture, EvaluationError> {
    let style = Style { cell, caption: false, legend: true };
    let fault = |error| EvaluationError::Malformed(format!("cannot draw the image for the prompt: {error}"));
    let drawn = render::observed(legend.looks(), observation, &style).map_err(fault)?;
    let png = render::png(&drawn).map_err(fault)?;
    Ok(Picture { png, width: drawn.width(), height: drawn.height() })
}

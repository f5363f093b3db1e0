//! What is seen, as a picture.

use crate::error::EvaluationError;
use crate::legend::Legend;
use engine::Observation;
use render::Style;

/// A picture as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The bytes of the file.
    pub png: Vec<u8>,
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
}

/// The observation in cells of so many pixels, and below it the types of the game with their tiles and names. It is drawn
/// from the observation and not from the state, so that it tells no more than the other encodings do. The same arguments give
/// the same bytes on every machine. Cost: O(pixels).
///
/// # Errors
/// The cells, or the whole picture, would be too small or too large.
pub fn picture(observation: &Observation, legend: &Legend, cell: u32) -> Result<Picture, EvaluationError> {
    let style = Style { cell, caption: false, legend: true };
    let fault = |error| EvaluationError::Malformed(format!("no picture for the prompt: {error}"));
    let drawn = render::observed(legend.looks(), observation, &style).map_err(fault)?;
    let png = render::png(&drawn).map_err(fault)?;
    Ok(Picture { png, width: drawn.width(), height: drawn.height() })
}

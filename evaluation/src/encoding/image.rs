//! What is seen, as a picture.

use crate::error::EvaluationError;
use crate::legend::Legend;
use engine::Observation;
use render::Style;

/// A PNG of the observation, in cells of so many pixels, with the names of the types and their tiles below it if asked for.
/// It is drawn from the observation and not from the state, so that it tells no more than the other encodings do.
/// The same arguments give the same bytes on every machine. Cost: O(pixels).
///
/// # Errors
/// The cells, or the whole picture, would be too small or too large.
pub fn image(
    observation: &Observation,
    legend: &Legend,
    cell: u32,
    key: bool,
) -> Result<Vec<u8>, EvaluationError> {
    let style = Style { cell, caption: false, legend: key };
    let picture = render::observed(legend.looks(), observation, &style);
    let bytes = picture.and_then(|picture| render::png(&picture));
    bytes.map_err(|error| EvaluationError::Malformed(format!("no picture for the prompt: {error}")))
}

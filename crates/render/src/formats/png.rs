//! Images as PNG.

use super::pixels::Painter;
use crate::error::RenderError;
use crate::picture::Picture;

/// Encodes an image as a PNG file.
///
/// # Errors
///
/// Returns an error if the image is empty.
pub fn png(picture: &Picture) -> Result<Vec<u8>, RenderError> {
    let image = Painter::new().paint(picture)?;
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, image.width, image.height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::High);
    let mut writer = encoder.write_header()?;
    let data: Vec<u8> = image.pixels.iter().flat_map(|colour| colour.0).collect();
    writer.write_image_data(&data)?;
    writer.finish()?;
    Ok(bytes)
}

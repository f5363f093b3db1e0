//! Episodes as animated GIFs.
//!
//! All frames share one palette, which is created before the first frame is written. The palette contains the exact
//! colours of the tiles, followed by the blended colours of smooth edges. Blends that no palette entry resembles come
//! first, ordered by frequency. A frame contains only the rectangle that has changed.

use super::pixels::{Image, Painter};
use crate::caption;
use crate::error::RenderError;
use crate::looks::colour::Colour;
use crate::picture::Picture;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The number of colours in a palette, in addition to the entry [`UNCHANGED`].
const COLOURS: usize = 255;
/// The palette entry that leaves a pixel unchanged. Long runs of this entry compress well.
const UNCHANGED: u8 = 255;
/// The duration of the last frame, as a multiple of the other frames' duration.
const LAST: u16 = 12;

/// The palette is completed in successive passes over the blends. Each number is a squared distance. A pass adds only
/// blends that are further than this distance from every palette entry.
const APART: [u32; 3] = [1200, 300, 0];

/// An encoder that writes equally sized images as the frames of an endlessly repeating GIF.
pub struct Animation {
    painter: Painter,
    encoder: ::gif::Encoder<Vec<u8>>,
    palette: Vec<Colour>,
    /// The nearest palette entry for every colour seen so far.
    nearest: BTreeMap<Colour, u8>,
    /// The pixels of the last frame. Empty before the first frame.
    before: Vec<Colour>,
    /// The pixels of the last frame as indices into the palette.
    shown: Vec<u8>,
    /// The next frame to write. Each frame waits for its successor, because the last frame lasts longer. `None` before
    /// the first frame.
    pending: Option<::gif::Frame<'static>>,
    size: (u16, u16),
    /// The duration of a frame in hundredths of a second.
    delay: u16,
}

impl Animation {
    /// Starts an animation of images like `specimens`. The first specimen determines the size. A frame lasts
    /// `delay` hundredths of a second. Colours that no specimen contains are mapped to the nearest palette
    /// entry.
    ///
    /// # Errors
    ///
    /// Returns an error if the first image is empty or too large for a GIF.
    pub fn new(specimens: &[Picture], delay: u16) -> Result<Animation, RenderError> {
        let mut painter = Painter::new();
        let (width, height) = specimens.first().map_or((0, 0), |first| (first.width(), first.height()));
        let side =
            |length: u32| u16::try_from(length).map_err(|_| RenderError::TooLargeForGif { width, height });
        let size = (side(width)?, side(height)?);
        let palette = palette(specimens, &mut painter)?;
        let mut bytes: Vec<u8> = palette.iter().flat_map(|colour| colour.0).collect();
        bytes.resize(3 * (COLOURS + 1), 0);
        let mut encoder = ::gif::Encoder::new(Vec::new(), size.0, size.1, &bytes)?;
        encoder.set_repeat(::gif::Repeat::Infinite)?;
        let (nearest, before, shown) = (BTreeMap::new(), Vec::new(), Vec::new());
        Ok(Animation { painter, encoder, palette, nearest, before, shown, pending: None, size, delay })
    }

    /// Adds a frame.
    ///
    /// # Errors
    ///
    /// Returns an error if the image's size differs from the size of the first specimen (the first example image that
    /// was given).
    pub fn add(&mut self, picture: &Picture) -> Result<(), RenderError> {
        let image = self.painter.paint(picture)?;
        let (width, height) = (usize::from(self.size.0), usize::from(self.size.1));
        if (image.width as usize, image.height as usize) != (width, height) {
            return Err(RenderError::Frame { width: image.width, height: image.height });
        }
        let indices = self.indices(&image);
        let changed = changed(&self.shown, &indices, width);
        let [left, top, right, bottom] = changed;
        let first = self.shown.is_empty();
        let pixel = |at: usize| if first || indices[at] != self.shown[at] { indices[at] } else { UNCHANGED };
        let pixels = (top..bottom).flat_map(|row| (row * width + left..row * width + right).map(pixel));
        let frame = ::gif::Frame {
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            delay: self.delay,
            dispose: ::gif::DisposalMethod::Keep,
            transparent: (!first).then_some(UNCHANGED),
            buffer: Cow::Owned(pixels.collect()),
            ..::gif::Frame::default()
        };
        (self.before, self.shown) = (image.pixels, indices);
        match self.pending.replace(frame) {
            Some(before) => Ok(self.encoder.write_frame(&before)?),
            None => Ok(()),
        }
    }

    /// Returns the bytes of the GIF file.
    ///
    /// # Errors
    ///
    /// Returns an error if there is not enough memory.
    pub fn finish(mut self) -> Result<Vec<u8>, RenderError> {
        if let Some(mut last) = self.pending.take() {
            last.delay = self.delay.saturating_mul(LAST);
            self.encoder.write_frame(&last)?;
        }
        Ok(self.encoder.into_inner()?)
    }

    /// Returns the palette index of each pixel. Only changed pixels are looked up, because most pixels do not change.
    fn indices(&mut self, image: &Image) -> Vec<u8> {
        let Animation { palette, nearest, before, shown, .. } = self;
        let mut last = None;
        let mut index = |(at, &colour): (usize, &Colour)| {
            if before.get(at) == Some(&colour) {
                return shown[at];
            }
            if let Some((known, index)) = last
                && known == colour
            {
                return index;
            }
            let index = *nearest.entry(colour).or_insert_with(|| {
                let closest = (0..palette.len()).min_by_key(|&at| palette[at].distance(colour));
                closest.map_or(0, |at| at as u8)
            });
            last = Some((colour, index));
            index
        };
        image.pixels.iter().enumerate().map(&mut index).collect()
    }
}

/// Returns the palette: first the exact tile colours, then blends by their number of pixels in the specimens (the given
/// example images). Ties are broken by colour.
fn palette(specimens: &[Picture], painter: &mut Painter) -> Result<Vec<Colour>, RenderError> {
    let shapes = specimens.iter().flat_map(Picture::tiles).flat_map(|tile| &tile.shapes);
    let mut palette: Vec<Colour> = shapes.map(|shape| shape.colour).collect();
    // The specimens (the given example images) lack the background colours of outcomes, because none of them shows the
    // end of an episode.
    palette.extend(caption::ENDINGS.map(|(_, colour)| colour));
    palette.sort_unstable();
    palette.dedup();
    palette.truncate(COLOURS / 2);
    let mut counts: BTreeMap<Colour, u32> = BTreeMap::new();
    for specimen in specimens {
        for colour in painter.paint(specimen)?.pixels {
            *counts.entry(colour).or_default() += 1;
        }
    }
    let mut blends: Vec<(Colour, u32)> = counts.into_iter().collect();
    blends.retain(|(colour, _)| !palette.contains(colour));
    // The sort is stable, so equally frequent blends stay sorted by colour.
    blends.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    // Blends far from all entries come first, because many rare blends are better served by one entry in their midst.
    for apart in APART {
        for &(colour, _) in &blends {
            if palette.len() < COLOURS && palette.iter().all(|known| known.distance(colour) > apart) {
                palette.push(colour);
            }
        }
    }
    Ok(palette)
}

/// Returns the smallest rectangle (left, top, right, bottom) that contains all differences. If there are
/// none, returns a single pixel. For the first frame, returns the whole frame.
fn changed(before: &[u8], now: &[u8], width: usize) -> [usize; 4] {
    if before.len() != now.len() {
        return [0, 0, width, now.len() / width.max(1)];
    }
    let mut bounds: Option<[usize; 4]> = None;
    for (row, (old, new)) in before.chunks(width).zip(now.chunks(width)).enumerate() {
        let Some(first) = old.iter().zip(new).position(|(a, b)| a != b) else { continue };
        let last = old.iter().zip(new).rposition(|(a, b)| a != b).unwrap_or(first);
        let [left, top, right, _] = bounds.unwrap_or([first, row, last + 1, row]);
        bounds = Some([left.min(first), top, right.max(last + 1), row + 1]);
    }
    bounds.unwrap_or([0, 0, 1, 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_bounded_tightly() {
        let check = |now: [u8; 6], expect: [usize; 4]| assert_eq!(changed(&[0; 6], &now, 3), expect);
        check([0, 0, 0, 0, 0, 0], [0, 0, 1, 1]);
        check([0, 1, 0, 0, 0, 0], [1, 0, 2, 1]);
        check([0, 0, 1, 1, 0, 0], [0, 0, 3, 2]);
        assert_eq!(changed(&[], &[0; 6], 3), [0, 0, 3, 2]);
    }
}

//! Renders boards as images.

use engine::{Action, Game, State};
use render::{Animation, Image, Looks, Painter, Picture, RenderError, Style};
use std::cell::RefCell;

thread_local! {
    /// A painter that caches the tiles drawn by the current thread.
    static PAINTER: RefCell<Painter> = RefCell::new(Painter::new());
}

/// Draws a board without a caption or a legend, with cells of `cell` pixels.
pub(crate) fn pixels(looks: &Looks, state: &State, cell: u32) -> Result<Image, RenderError> {
    let picture = render::picture(looks, state, &Style::bare(cell))?;
    PAINTER.with_borrow_mut(|painter| painter.paint(&picture))
}

/// The maximum number of images from which an animation's palette is computed.
const SPECIMENS: usize = 32;

/// Renders an episode that starts at the given state as an animated GIF with one frame per tick. Each frame
/// lasts `delay` hundredths of a second.
pub(crate) fn animation(
    (game, looks): (&Game, &Looks),
    mut state: State,
    actions: &[Action],
    style: &Style,
    delay: u16,
) -> Result<Vec<u8>, RenderError> {
    let mut pictures: Vec<Picture> = vec![render::picture(looks, &state, style)?];
    for &action in actions {
        if state.is_over() {
            break;
        }
        game.step(&mut state, action);
        pictures.push(render::picture(looks, &state, style)?);
    }
    let step = pictures.len().div_ceil(SPECIMENS);
    let specimens: Vec<Picture> = pictures.iter().step_by(step).cloned().collect();
    let mut animation = Animation::new(&specimens, delay)?;
    pictures.iter().try_for_each(|picture| animation.add(picture))?;
    animation.finish()
}

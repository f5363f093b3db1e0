//! Pictures of boards as pixels.

use engine::State;
use render::{Image, Looks, Painter, RenderError, Style};
use std::cell::RefCell;

thread_local! {
    /// The tiles that this thread has drawn before.
    static PAINTER: RefCell<Painter> = RefCell::new(Painter::new());
}

/// Draws a board without caption and legend, in cells of this many pixels.
pub(crate) fn pixels(looks: &Looks, state: &State, cell: u32) -> Result<Image, RenderError> {
    let picture = render::picture(looks, state, &Style::bare(cell))?;
    PAINTER.with_borrow_mut(|painter| painter.paint(&picture))
}

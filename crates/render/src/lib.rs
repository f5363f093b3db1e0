//! Boards and episodes as text, PNG, SVG and GIF.
//!
//! A [`Picture`] is made of tiles; a tile is drawn from the role of a sprite type in the rules ([`Glyph`]), and only
//! then from the colour that the game gives it ([`docs/rendering.md`](../../../docs/rendering.md) shows them all). Both
//! back-ends, [`svg`] and [`png`], draw the same shapes. The same state gives the same bytes on every machine.
//!
//! ```
//! # use base as infinite_arcade_base;
//! # use engine as infinite_arcade_engine;
//! use infinite_arcade_base::Seed;
//! use infinite_arcade_engine::{Analysis, Game};
//! use infinite_arcade_render::{Looks, Style};
//!
//! let game = Game::from_source("
//! BasicGame
//!     SpriteSet
//!         goal > Door
//!         avatar > MovingAvatar
//!     LevelMapping
//!         g > goal
//!     InteractionSet
//!         goal avatar > killSprite
//!     TerminationSet
//!         SpriteCounter stype=goal win=True
//! ")?;
//! let state = game.start(&game.level("A g")?, Seed::from_text("example"));
//! let analysis = Analysis::of(&game);
//! let picture = infinite_arcade_render::picture(&Looks::of(&analysis), &state, &Style::bare(24))?;
//! assert_eq!((picture.width(), picture.height()), (72, 24));
//! assert!(infinite_arcade_render::svg(&picture).starts_with("<svg"));
//! assert!(infinite_arcade_render::png(&picture)?.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod art;
mod board;
mod caption;
mod colour;
mod error;
mod figure;
mod gif;
mod glyph;
mod legend;
mod letters;
mod look;
mod observed;
mod picture;
mod pixels;
mod png;
mod prospects;
mod shape;
mod sheet;
mod svg;
mod symbols;
mod text;

pub use board::{MAX_CELL, MAX_PIXELS, MIN_CELL, Style, picture};
pub use caption::holdings;
pub use colour::Colour;
pub use error::RenderError;
pub use figure::{Form, Mood};
pub use gif::Animation;
pub use glyph::Glyph;
pub use look::{Look, Looks};
pub use observed::observed;
pub use picture::{Picture, Place, Stamp, Tile, sprite_tile};
pub use pixels::{Image, Painter};
pub use png::png;
pub use shape::{Outline, Paint, Point, Segment, Shape};
pub use sheet::{figures, gallery, sheet};
pub use svg::{escaped, svg, svg_tile};
pub use symbols::{EMPTY, Symbols};
pub use text::{rows, text};

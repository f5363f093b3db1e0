//! Boards and episodes as text, PNG, SVG and GIF.
//!
//! A [`Picture`] consists of tiles. A tile's drawing depends on the sprite type's role in the rules
//! ([`Glyph`]) and on its colour in the game
//! ([`docs/reference/rendering.md`](../../../docs/reference/rendering.md) shows all tiles). Both back-ends,
//! [`svg`] and [`png`], draw the same shapes. The same state yields identical bytes on every machine.
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

mod board;
mod caption;
mod error;
mod formats;
mod legend;
mod looks;
mod observed;
mod picture;
mod sheet;
mod style;

pub use board::picture;
pub use caption::holdings;
pub use error::RenderError;
pub use formats::gif::Animation;
pub use formats::pixels::{Image, Painter};
pub use formats::png::png;
pub use formats::svg::{escaped, svg, svg_tile};
pub use formats::symbols::{EMPTY, Symbols};
pub use formats::text::{rows, text};
pub use looks::colour::Colour;
pub use looks::figure::{Form, Mood};
pub use looks::glyph::Glyph;
pub use looks::look::{Look, Looks};
pub use looks::shape::{Outline, Paint, Point, Segment, Shape};
pub use observed::observed;
pub use picture::{Picture, Place, Stamp, Tile, sprite_tile};
pub use sheet::{figures, gallery, sheet};
pub use style::{MAX_CELL, MAX_PIXELS, MIN_CELL, Style};

//! The server of `arcade studio`: games on a page of this machine, to write, check, play, browse and judge them.
//!
//! A [`Workspace`] is what was opened; a [`Studio`] answers questions about it; a [`Server`] lets a page on this machine, and nobody
//! else, ask them ([who can ask](../../../docs/studio.md#security)). Work that takes long arrives line by line and ends when the page
//! leaves.

mod answers;
mod api;
mod compiled;
mod files;
mod frames;
mod gallery;
mod guard;
pub mod judging;
mod lines;
mod positions;
mod refusal;
mod running;
mod server;
mod sessions;
mod studio;
mod templates;
mod verdict;
mod workspace;

pub use files::NamedText;
pub use gallery::{Gallery, GalleryError};
pub use server::{Server, Stop};
pub use studio::Studio;
pub use templates::{TEMPLATES, Template};
pub use workspace::{GameEntry, Kind, Place, WitnessEntry, Workspace};

//! The server of `arcade studio`, which is a web page on this machine for writing, checking, playing, browsing and
//! judging games.
//!
//! A [`Workspace`] contains the opened games. A [`Studio`] answers requests about a workspace. A [`Server`] lets only a
//! page on this machine send these requests ([who can ask](../../../docs/reference/studio-server.md#security)). Long
//! work arrives line by line and ends when the page leaves.

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

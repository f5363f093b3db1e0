//! The server behind `arcade studio`: a local web page for writing, checking, playing, browsing and judging
//! games.
//!
//! A [`Workspace`] contains the opened games. A [`Studio`] handles requests about a workspace. A [`Server`]
//! accepts these requests only from a page on this machine
//! ([details](../../../docs/reference/studio-server.md#security)). Results of long-running work are sent line
//! by line, and the work ends when the page is closed.

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

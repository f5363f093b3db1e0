//! Players that answer through files, such as people, chat windows and arbitrary programs
//! (`docs/how-to/mailbox.md`).
//!
//! [`Mailbox`] is the evaluation's side of the folder, and [`MailboxPlayer`] plays an episode through it.
//! [`Desk`] is the player's side, which lists open prompts and delivers answers. Every file is complete when
//! it appears, because it is written under a different name and then renamed. A resumed evaluation depends
//! only on the log of the episode.

mod desk;
mod files;
mod folder;
mod player;

pub use desk::{Delivery, Desk, OpenPrompt, View};
pub use files::{Address, MAX_ANSWER, PromptFile};
pub use folder::{Finished, Mailbox, Notices};
pub use player::{EpisodeResult, MailboxPlayer};

/// The version of the files in a mailbox. It is raised whenever a reader of older files could misread newer
/// files.
pub const MAILBOX_FORMAT: u32 = 1;

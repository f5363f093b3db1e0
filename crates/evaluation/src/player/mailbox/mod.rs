//! Players that answer through files: people, chat windows and programs of any kind (`docs/how-to/mailbox.md`).
//!
//! [`Mailbox`] is the evaluation's side of the folder, and [`MailboxPlayer`] plays an episode through it. [`Desk`] is
//! the other side, which lists open prompts and delivers answers. Files appear complete, by renaming, and the log of
//! the episode is the only record that a resumed evaluation depends on.

mod desk;
mod files;
mod folder;
mod player;

pub use desk::{Delivery, Desk, OpenPrompt, View};
pub use files::{Address, MAX_ANSWER, PromptFile};
pub use folder::{Finished, Mailbox, Notices};
pub use player::{EpisodeResult, MailboxPlayer};

/// The version of the files in a mailbox, which is raised when a reader of older files could misread newer ones.
pub const MAILBOX_FORMAT: u32 = 1;

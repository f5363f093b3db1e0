//! Players that answer through files: people, chat windows and arbitrary programs (`docs/how-to/mailbox.md`).
//!
//! [`Mailbox`] is the evaluation's side of the folder, and [`MailboxPlayer`] plays an episode through it.
//! [`Desk`] is the player's side, which lists open prompts and delivers answers. Files are written under a
//! temporary name and then renamed, so every file is complete when it appears. When an evaluation is resumed,
//! only the episodes' logs matter, not the files in the mailbox.

mod desk;
mod files;
mod folder;
mod player;

pub use desk::{Delivery, Desk, OpenPrompt, View};
pub use files::{Address, MAX_ANSWER, PromptFile};
pub use folder::{Finished, Mailbox, Notices};
pub use player::{EpisodeResult, MailboxPlayer};

/// The version of the mailbox file format. It is incremented whenever programs that read older files might
/// misread newer ones.
pub const MAILBOX_FORMAT: u32 = 1;

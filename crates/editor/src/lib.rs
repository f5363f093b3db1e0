//! Editor features for VGDL games and levels: problems with fixes, hover texts, completions and renaming.
//!
//! Every function accepts incomplete text that does not compile. Positions are byte offsets into the text,
//! and [`positions`] converts them to the units that editors use. The same text always yields the same
//! result. [`lsp`] is a language server based on these functions.

mod complete;
mod format;
mod hover;
mod in_words;
pub mod lsp;
mod navigate;
mod outline;
mod pages;
pub mod positions;
mod problems;
mod rename;
mod values;
mod words;

pub use complete::{Completion, Item, ItemKind, complete};
pub use engine::{Edit, Fix, Severity, Span};
pub use format::format;
pub use hover::{Hover, hover, level_hover};
pub use in_words::{Source, colours, help, in_words, one_in_words};
pub use navigate::{definition, level_definition, references};
pub use outline::{Entry, EntryKind, outline};
pub use pages::{introduction, page, summary};
pub use problems::{LevelRules, Problem, applied, level_problems, problems};
pub use rename::{RenameError, renamable, rename, rename_in_level};
pub use values::COLORS;

//! The state of the parser.

use crate::diagnostic::Diagnostic;
use crate::syntax::description::Description;

/// The state of the parser. The methods that read lines are in `lines.rs`, those that read tokens in `tokens.rs`.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) description: Description,
    pub(super) problems: Vec<Diagnostic>,
    /// `true` if the lines of the SpriteSet are indented in columns; deviating lines have been reported.
    pub(super) columns: bool,
}

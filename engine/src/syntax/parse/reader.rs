//! The state of the parser.

use crate::diagnostic::Diagnostic;
use crate::syntax::description::Description;

/// The state of the parser. The methods that read lines are in `lines.rs`, and those that read tokens are in
/// `tokens.rs`.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) description: Description,
    pub(super) problems: Vec<Diagnostic>,
    /// `true` if the lines of the SpriteSet are indented in columns; then deviating lines are already reported.
    pub(super) columns: bool,
}

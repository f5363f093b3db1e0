//! The state of the parser.

use crate::diagnostic::Diagnostic;
use crate::syntax::description::Description;

/// The state of the parser. The methods that read lines are in `lines.rs`, and the methods that read tokens
/// are in `tokens.rs`.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) description: Description,
    pub(super) problems: Vec<Diagnostic>,
    /// `true` if the lines of the SpriteSet are indented in columns. Deviating lines are already reported in
    /// that case.
    pub(super) columns: bool,
}
